"""Laws that every car body obeys, whatever it is made of: one battery for all of them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
import scipy.integrate
import scipy.linalg
from numpy.testing import assert_allclose
from outside_bodies import MASS as HULL
from outside_bodies import hull
from vehicles import mirrored, random_vehicle

from railride.bodies import BodyModes, ModalBody
from railride.bodies.matrices import BodyMatrices
from railride.bodies.outside import outside_modes
from railride.body_sources import Elements
from railride.modal import modes
from railride.parameters import (
    BodyProfile,
    CarBody,
    Equipment,
    Load,
    PointMass,
    Segment,
    load_vehicle,
)
from railride.vehicle import VehicleModel, derive_vehicle

MASS, LENGTH = 34e3, 24.0


def coach(**body):
    vehicle = load_vehicle("cati2024")
    return replace(vehicle, body=replace(vehicle.body, **{"bending_damping": 0.01} | body))


def lopsided_modes():
    """Modes of a body with a heavy front: polynomials, orthogonal in μ(x) = a (1 + x/L)."""
    points, weights = np.polynomial.legendre.leggauss(12)
    x, density = points * LENGTH / 2, MASS / LENGTH * (1 + points / 2)
    weights = weights * LENGTH / 2 * density
    powers = np.vander(points, 5, increasing=True).T
    products = (powers * weights) @ powers.T
    turned = np.linalg.inv(np.linalg.cholesky(products)) * np.sqrt(MASS)  # Gram and Schmidt
    centre = float((weights * x).sum() / MASS)

    def shapes(at):
        u = np.asarray(at, dtype=float) / (LENGTH / 2)
        return np.stack([np.polynomial.polynomial.polyval(u, row) for row in turned[2:]])

    motions = np.vstack([np.ones_like(x), x - centre, shapes(x)])
    inertia = float((weights * (x - centre) ** 2).sum())
    return BodyModes(MASS, centre, inertia, LENGTH, [9.0, 24.0, 47.0], [0.01, 0.02, 0.05], shapes,
                     "modes", products=(motions * weights) @ motions.T)  # fmt: skip


def given_modes(payload=()):
    found = lopsided_modes()
    vehicle = coach(mass_centre=found.mass_centre, pitch_inertia=found.pitch_inertia)
    return VehicleModel(replace(vehicle, payload=payload), ModalBody(vehicle.body, found))


def unlike(made, N, *, body=None, modes=None, **changes):
    own = CarBody.of(made, bending_damping=0.01, **changes)
    vehicle = replace(load_vehicle("cati2024"), body=own)
    return derive_vehicle(vehicle, N, body=body, modes=modes)


def of_matrices():
    """A body from outside: of the matrices of a beam that also moves sideways."""
    M, K, x, vertical = hull()
    given = BodyMatrices("hull", M * MASS / HULL, K * MASS / HULL, x, vertical)
    body = replace(coach().body, pitch_inertia=MASS * LENGTH**2 / 12)
    vehicle = replace(coach(), body=body)
    return VehicleModel(vehicle, ModalBody(body, outside_modes(given.point_modes(5), body)))


SEGMENTS = (Segment(5.0, 8e3, mass_centre=0.3), Segment(8.0, 11e3), Segment(11.0, 15e3, 130e3))
PROFILE = BodyProfile((-12, -7, -7, 12), (3e9, 2e9, 1e9, 3e9), (1500, 1300, 1200, 1600),
                      point_masses=(PointMass(900.0, -3.0, 200.0),))  # fmt: skip
TIMOSHENKO = {"shear_stiffness": 4e8, "rotary_inertia": 2800.0}
LOADS = (Load(6000.0), Load(2000.0, 11.0, 3.0), Load(900.0, -4.0, -4.0),
         Load(700.0, -1e-11, -2e-11))  # fmt: skip
BODIES = {
    "rigid": lambda: derive_vehicle(coach(), 1),
    "rods": lambda: derive_vehicle(coach(), 4),
    "halves": lambda: derive_vehicle(coach(), 2),
    "graded": lambda: derive_vehicle(coach(pitch_inertia=1.9e6, mass_centre=0.4), 5),
    "own segments": lambda: unlike(SEGMENTS, 3, joint_stiffness=(4e8, 3e8)),
    "profile": lambda: unlike(PROFILE, 6, bending_frequency=9.0),
    "cut profile": lambda: unlike(PROFILE, 4, cuts=(6.0, -1.0, -7.0)),
    "two frequencies": lambda: derive_vehicle(
        coach(bending_frequency=None, bending_frequencies=(9.6, 24.0)), 4
    ),
    "beam": lambda: derive_vehicle(coach(), body="beam", modes=6),
    "shear beam": lambda: derive_vehicle(coach(**TIMOSHENKO), body="beam", modes=6),
    "one mode": lambda: derive_vehicle(coach(), body="beam", modes=1),
    "given modes": given_modes,
    "random beam": lambda: derive_vehicle(random_vehicle(3, graded=False), body="beam", modes=4),
    "loaded": lambda: derive_vehicle(replace(coach(), payload=LOADS), 4),
    "loaded beam": lambda: derive_vehicle(replace(coach(), payload=LOADS), body="beam", modes=5),
}
HUNG = (Equipment(1500.0, 1.7, frequency=8.8, damping_ratio=0.12),
        Equipment(900.0, -8.0, stiffness=3e6, damping=2e3))  # fmt: skip
BODIES |= {
    "hung": lambda: derive_vehicle(replace(coach(), equipment=HUNG), 4),
    "hung beam": lambda: derive_vehicle(replace(coach(), equipment=HUNG), body="beam", modes=5),
}
BODIES["loaded modes"] = lambda: given_modes(LOADS)
ELEMENTS = {
    "elements": lambda: derive_vehicle(coach(), body="fe", modes=6),
    "shear elements": lambda: derive_vehicle(coach(**TIMOSHENKO), body="fe", modes=6),
    "profile of elements": lambda: unlike(PROFILE, None, body="fe", modes=5),
    "reduced elements": lambda: unlike(
        PROFILE, None, body="fe", modes=5, elements=Elements(40, (-8.75, 0.0, 8.75))
    ),
    "modes of matrices": of_matrices,
}
BODIES |= ELEMENTS
LOADED = {"loaded", "loaded beam", "loaded modes"}
SYMMETRIC = {"rigid", "rods", "halves", "two frequencies", "beam", "shear beam", "one mode",
             "elements", "shear elements"}  # fmt: skip


@cache
def model(name):
    return BODIES[name]()


def own(name):
    """How many of the coordinates are the body's."""
    return len(model(name).body.energies.coordinates)


def rows(name, places, reading="polygon"):
    """Displacement of points of the body in its own coordinates: (points, coordinates)."""
    found = model(name).output_rows([model(name).floor(x, reading, 0) for x in places])["d"]
    return found[:, : own(name)]


every_body = pytest.mark.parametrize("name", BODIES)
PLACES = (-12.0, -8.75, -3.3, 0.0, 2.1, 4.0, 11.9)


@every_body
def test_matrices_are_symmetric_and_definite(name):
    m = model(name).matrices()
    for A in (m.M, m.C, m.K):
        assert_allclose(A, A.T, rtol=0, atol=1e-12 * np.abs(A).max())
        assert np.linalg.eigvalsh(A).min() > -1e-10 * np.abs(A).max()
    assert np.linalg.eigvalsh(m.M).min() > 0


@every_body
def test_rigid_motions_strain_nothing_and_are_straight_lines(name):
    body = model(name).body
    values, n = model(name).values(), own(name)
    A = body.free_matrices(values)
    lift, turn = model(name).lift[:n], model(name).pitch()[:n]
    places = [x for x in PLACES if abs(x) <= body.body.length / 2]
    for reading in ("polygon", "smooth", "spline"):
        H = rows(name, places, reading)
        assert_allclose(H @ lift, 1, rtol=1e-12)
        assert_allclose(H @ turn, places, atol=1e-11)
    for motion in (lift, turn):
        assert np.abs(A["K"] @ motion).max() <= 1e-12 * max(np.abs(A["K"]).max(), 1) * 12


@every_body
def test_a_turn_of_the_whole_vehicle_strains_nothing(name):
    found = model(name)
    m, turn = found.matrices(), found.pitch()
    w = np.array(found.vehicle.wheelset_positions)
    for A, A_w in ((m.K, m.K_w), (m.C, m.C_w)):
        for motion, under in ((turn, w), (m.lift, np.ones_like(w))):
            left = np.abs(A @ motion - A_w @ under).max()
            assert left < 1e-12 * np.abs(A).max() * np.abs(motion).max()


@every_body
def test_total_mass_mass_centre_and_inertia_are_right(name):
    """Of the empty body: what the vehicle says, a uniform body's inertia where it is one."""
    found, n = model(name), own(name)
    M = found.body.free_matrices(found.values())["M"]
    lift, turn = found.lift[:n], found.pitch()[:n]
    body = found.vehicle.body
    assert lift @ M @ lift == pytest.approx(body.mass, rel=1e-12)
    assert lift @ M @ turn == pytest.approx(body.mass * body.mass_centre, abs=1e-8 * body.mass)
    about = turn @ M @ turn - body.mass * body.mass_centre**2
    uniform = body.mass * body.length**2 / 12
    given = ["rigid", "graded", "given modes", "loaded modes", "own segments", "profile",
             "cut profile", "profile of elements", "reduced elements"]  # fmt: skip
    shearing = dict.fromkeys(("shear beam", "shear elements"), uniform + 2800.0 * body.length)
    expected = dict.fromkeys(given, body.pitch_inertia) | shearing
    assert about == pytest.approx(expected.get(name, uniform), rel=1e-11)


@pytest.mark.parametrize("name", sorted(LOADED))
def test_a_load_adds_its_mass_its_place_and_its_inertia(name):
    """By numerical integration over each load."""
    found, n = model(name), own(name)
    M = found.matrices().M[:n, :n] - found.body.free_matrices(found.values())["M"]
    lift, turn = found.lift[:n], found.pitch()[:n]
    for a, b, power in ((lift, lift, 0), (lift, turn, 1), (turn, turn, 2)):
        assert a @ M @ b == pytest.approx(sum(moment(load, power) for load in LOADS), rel=1e-11)


def moment(load, power):
    front, rear = (12.0, -12.0) if load.front is None else (load.front, load.rear)
    if front == rear:
        return load.mass * front**power
    integral, _ = scipy.integrate.quad(lambda x: x**power, rear, front)
    return load.mass * integral / (front - rear)


@pytest.mark.parametrize("name", sorted(LOADED))
def test_a_load_is_carried_where_it_lies(name):
    """Its kinetic energy in any motion is that of its parts, in any pair of motions."""
    found, n = model(name), own(name)
    M = found.matrices().M[:n, :n] - found.body.free_matrices(found.values())["M"]
    expected = np.zeros_like(M)
    for load in LOADS:
        front, rear = (12.0, -12.0) if load.front is None else (load.front, load.rear)
        points, weights = np.polynomial.legendre.leggauss(16)
        ends = [rear, *(x for x in (-6.0, 0.0, 6.0) if rear < x < front), front]  # at the hinges
        for a, b in pairwise(ends):
            H = rows(name, (a + (b - a) * (points + 1) / 2).tolist())
            share = load.mass * ((b - a) / (front - rear) if front > rear else 1.0)
            expected += share / 2 * (H.T * weights) @ H
    assert_allclose(M, expected, rtol=0, atol=1e-10 * np.abs(expected).max())


@every_body
def test_energy_decays(name):
    m = model(name).matrices()
    n = len(m.M)
    A = np.block([[np.zeros((n, n)), np.eye(n)],
                  [-np.linalg.solve(m.M, m.K), -np.linalg.solve(m.M, m.C)]])  # fmt: skip
    assert np.linalg.eigvals(A).real.max() < 0


@every_body
def test_receptances_are_reciprocal(name):
    """A force at a moves b as much as the same force at b moves a."""
    found = model(name)
    m = found.matrices()
    H = found.output_rows([found.floor(x, "polygon", 0) for x in (-8.0, 1.0, 6.5)])["d"]
    for omega in (3.0, 20.0, 61.0):
        moved = H @ np.linalg.solve(m.K + 1j * omega * m.C - omega**2 * m.M, H.T)
        assert_allclose(moved, moved.T, rtol=1e-8)


@pytest.mark.parametrize("name", sorted(SYMMETRIC))
def test_a_symmetric_body_moves_as_its_mirror_image(name):
    """A force at x moves y as one at -x moves -y."""
    found = model(name)
    m = found.matrices()
    places = [-11.0, -5.0, 0.0, 5.0, 11.0]
    for reading in ("polygon", "smooth"):
        H = found.output_rows([found.floor(x, reading, 0) for x in places])["d"]
        for omega in (3.0, 61.0, 170.0):
            moved = H @ np.linalg.solve(m.K + 1j * omega * m.C - omega**2 * m.M, H.T)
            assert_allclose(moved, moved[::-1, ::-1], rtol=0, atol=1e-9 * np.abs(moved).max())


def test_a_vehicle_on_a_beam_and_its_mirror_image_have_the_same_modes():
    vehicle = random_vehicle(5, graded=False)
    here = modes(derive_vehicle(vehicle, body="beam", modes=4))
    there = modes(derive_vehicle(mirrored(vehicle), body="beam", modes=4))
    assert [m.label for m in here] == [m.label for m in there]
    assert_allclose([m.frequency_hz for m in here], [m.frequency_hz for m in there], rtol=1e-9)


@every_body
def test_free_frequencies_and_damping_are_those_of_the_body(name):
    """On springs that hardly hold it, the vehicle's body has them: ζ_i = ζ f_i/f_1."""
    found, n = model(name), own(name)
    A = found.body.free_matrices(found.values())
    squares = scipy.linalg.eigvalsh(A["K"], A["M"])[2:]
    f = found.bending_frequencies()
    assert f.shape == (n - 2,)
    assert_allclose(np.sqrt(np.maximum(squares, 0)) / (2 * np.pi), f, rtol=1e-7)
    if n == 2 or name in LOADED:
        return
    soft = {p.symbol.name: (1.0 if "k_2" in p.symbol.name else 0.0) for p in found.parameters
            if p.symbol.name.startswith(("k_2", "c_2", "c_e", "zeta_e"))}  # fmt: skip
    m = found.matrices(**soft)
    C, M = m.C[:n, :n], m.M[:n, :n]
    shapes = scipy.linalg.eigh(A["K"], M)[1][:, 2:]
    expected = {"given modes": [0.01, 0.02, 0.05]}.get(
        name, found.vehicle.body.bending_damping * f / f[0]
    )
    assert_allclose(shapes.T @ C @ shapes, np.diag(4 * np.pi * f * expected), rtol=1e-6,
                    atol=1e-6 * np.abs(C).max() / MASS)  # fmt: skip


@every_body
def test_modes_are_named_each_once(name):
    found = modes(model(name))
    labels = [m.label for m in found if not m.label.startswith(("bogie", "equipment"))]
    bending = [f"bending {i}" for i in range(1, own(name) - 1)]
    assert sorted(labels) == sorted(["heave", "pitch", *bending])


@every_body
def test_floors_of_smooth_bodies_agree_however_they_are_read(name):
    found = model(name)
    if found.body.segments not in (None, 1):
        return
    here, there = (found.output_rows([found.floor(x, reading, 0) for x in PLACES[1:-1]])["d"]
                   for reading in ("polygon", "smooth"))  # fmt: skip
    assert_allclose(here, there, atol=1e-14)


@every_body
def test_arrays_of_parameters_equal_one_by_one(name):
    """Masses, and positions of the first bogies, over one another's axes."""
    found = model(name)
    (place,) = (p for p in found.parameters if p.symbol.name in ("l_b", "x_b1"))
    of = next(p for p in found.parameters if p.unit == "kg")  # m_c, or that of the first segment
    name_of, mass = of.symbol.name, of.value * np.array([[0.99], [1.0], [1.02]])
    where = place.value + np.array([0.0, 0.25])
    many = found.matrices(**{name_of: mass, place.symbol.name: where})
    for i, j in np.ndindex(3, 2):
        one = found.matrices(**{name_of: mass[i, 0], place.symbol.name: where[j]})
        for matrix in ("M", "C", "K", "B_f"):
            among = getattr(many, matrix)
            among = among[i, j] if among.ndim == 4 else among
            assert_allclose(among, getattr(one, matrix), rtol=1e-10,
                            atol=1e-12 * np.abs(among).max())  # fmt: skip
