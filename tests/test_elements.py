"""The car body of beam elements, against closed forms and the beam's own differential equation."""

from __future__ import annotations

import sys
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from railride.bodies import reduction
from railride.bodies.element_modes import element_modes
from railride.bodies.elements import BeamElements
from railride.body_profile import BodyProfile, PointMass
from railride.errors import InputError

L, EI, MU = 24.0, 3e9, 1400.0
UNIFORM = BodyProfile((-L / 2, L / 2), (EI, EI), (MU, MU))
BETA_L = np.array([4.730040744862704, 7.853204624095838, 10.995607838001671,
                   14.137165491257464, 17.27875965739948])  # fmt: skip
CLOSED = BETA_L**2 / L**2 * np.sqrt(EI / MU) / (2 * np.pi)
SHEAR = {"shear_stiffness": (4e8, 4e8), "rotary_inertia": (900.0, 900.0)}
STEPPED = BodyProfile(
    (-12, -3, -3, 12), (1e9, 1e9, 4e9, 4e9), (1100, 1100, 1700, 1700),
    point_masses=(PointMass(3000, -7, 4000), PointMass(1500, 5)),
)  # fmt: skip
TAPERED = BodyProfile((-11, 1, 11), (4e9, 2e9, 3e9), (1800, 1300, 1600))


def misfit(profile, f):
    r"""Determinant that vanishes at the natural frequencies of the free beam, by its equations

    w' = ψ + Q/GA, ψ' = M/EI, M' = -ω²ρIψ - Q, Q' = -ω²μw, integrated from the free rear end.
    """
    omega2 = (2 * np.pi * f) ** 2

    def slope(x, y):
        w, psi, M, Q = y.reshape(4, 2)
        shear = 0 if profile.shear_stiffness is None else Q / profile.at("shear_stiffness", x)
        turning = 0 if profile.rotary_inertia is None else profile.at("rotary_inertia", x) * psi
        mu, bending = profile.at("mass_per_length", x), profile.at("bending_stiffness", x)
        return np.ravel([psi + shear, M / bending, -omega2 * turning - Q, -omega2 * mu * w])

    y = np.ravel([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [0.0, 0.0]])
    places = sorted({*profile.x, *(p.position for p in profile.point_masses)})
    for a, b in pairwise(places):
        inside = 1e-12 * (b - a)
        y = solve_ivp(slope, (a + inside, b - inside), y, "DOP853", rtol=1e-12, atol=1e-9).y[:, -1]
        for p in profile.point_masses:
            if p.position == b:
                y[4:6] -= omega2 * p.pitch_inertia * y[2:4]
                y[6:8] -= omega2 * p.mass * y[0:2]
    (a, b), (c, d) = y.reshape(4, 2)[2:]
    return a * d - b * c


def assert_solves(profile, frequencies, rtol=1e-7):
    for f in frequencies:
        exact = brentq(lambda f: misfit(profile, f), f * (1 - 1e-4), f * (1 + 1e-4), xtol=1e-10)
        assert f == pytest.approx(exact, rel=rtol)


def test_frequencies_converge_to_the_closed_form_at_fourth_order():
    ns = np.array([8, 16, 32, 64])
    errors = np.array([element_modes(UNIFORM, 3, elements=n).frequencies / CLOSED[:3] - 1
                       for n in ns])  # fmt: skip
    rates = np.log2(errors[:-1] / errors[1:])
    assert (errors > 0).all()
    np.testing.assert_allclose(rates[1:], 4.0, atol=0.05)
    # the Hermite beam's own leading error, (βh)⁴/720 of ω²
    np.testing.assert_allclose(errors[-1], (BETA_L[:3] / ns[-1]) ** 4 / 1440, rtol=0.01)


def test_five_frequencies_agree_with_the_beam_to_1e_6():
    np.testing.assert_allclose(element_modes(UNIFORM).frequencies[:5], CLOSED, rtol=1e-6)


def test_rounding_leaves_nine_digits_on_the_finest_mesh():
    found = element_modes(UNIFORM, 3, elements=2000).frequencies
    np.testing.assert_allclose(found, CLOSED[:3], rtol=1e-9)


def test_uniform_shapes_are_the_beams():
    modes, x = element_modes(UNIFORM, 5), np.linspace(-L / 2, L / 2, 41)
    beta = BETA_L[:, np.newaxis] / L
    s = beta * (x + L / 2)
    sigma = (np.cosh(BETA_L) - np.cos(BETA_L)) / (np.sinh(BETA_L) - np.sin(BETA_L))
    sigma = sigma[:, np.newaxis]
    # mean square 1, as φ is scaled to the body's mass
    exact = np.cosh(s) + np.cos(s) - sigma * (np.sinh(s) + np.sin(s))
    slope = beta * (np.sinh(s) - np.sin(s) - sigma * (np.cosh(s) + np.cos(s)))
    sign = np.sign(modes.shapes(L / 2) * exact[:, -1])[:, np.newaxis]
    np.testing.assert_allclose(modes.shapes(x) * sign, exact, atol=5e-6)
    np.testing.assert_allclose(modes.slopes(x) * sign, slope, atol=2e-4)
    assert modes.shapes(x.reshape(1, 41)).shape == (5, 1, 41)


def test_a_mass_in_the_middle_by_its_transcendental_equation():
    """tan z + tanh z + Rz (1 + 1/(cosh z cos z)) = 0, z = βL/2, R = m/(μL): modes 1, 3, 5."""
    R = 0.4
    loaded = replace(UNIFORM, point_masses=(PointMass(R * MU * L, 0.0),))
    modes = element_modes(loaded, 5, elements=256)

    def equation(z):
        return (np.sin(z) * np.cosh(z) + np.sinh(z) * np.cos(z)
                + R * z * (np.cosh(z) * np.cos(z) + 1))  # fmt: skip

    free = BETA_L[::2] / 2
    z = np.array([brentq(equation, z - 1, z, xtol=1e-14) for z in free])
    exact = (2 * z) ** 2 / L**2 * np.sqrt(EI / MU) / (2 * np.pi)
    np.testing.assert_allclose(modes.frequencies[::2], exact, rtol=1e-7)
    np.testing.assert_allclose(modes.frequencies[1::2], CLOSED[1::2], rtol=1e-7)
    assert modes.mass == pytest.approx(MU * L * (1 + R), rel=1e-14)


@pytest.mark.parametrize(
    "profile",
    [
        STEPPED,
        TAPERED,
        replace(TAPERED, rotary_inertia=(2000.0, 1000.0, 1500.0)),
        replace(TAPERED, shear_stiffness=(4e8, 2e8, 3e8), rotary_inertia=(2000.0, 1000.0, 1500.0)),
        replace(STEPPED, shear_stiffness=(2e8, 2e8, 6e8, 6e8), rotary_inertia=(900,) * 4),
        replace(UNIFORM, **SHEAR),
    ],
    ids="stepped tapered Rayleigh tapered-Timoshenko stepped-Timoshenko Timoshenko".split(),
)
def test_beams_of_any_profile_solve_their_differential_equation(profile):
    assert_solves(profile, element_modes(profile, 4, elements=256).frequencies)


def test_shear_converges_at_fourth_order_and_does_not_lock():
    shearing = replace(UNIFORM, **SHEAR)
    f = np.array([element_modes(shearing, 3, elements=n).frequencies for n in (8, 16, 32, 64)])
    steps = np.diff(f, axis=0)
    np.testing.assert_allclose(np.log2(steps[:-1] / steps[1:])[-1], 4.0, atol=0.05)
    stiff = replace(UNIFORM, shear_stiffness=(1e17, 1e17))
    np.testing.assert_allclose(element_modes(stiff, 3, elements=32).frequencies,
                               element_modes(UNIFORM, 3, elements=32).frequencies,
                               rtol=1e-7)  # fmt: skip


@pytest.mark.parametrize("shear", [None, (1e8, 2e8, 1e8)])
def test_mass_and_inertia_are_exact_and_rigid_motions_strain_nothing(shear):
    masses = (PointMass(3000, -7, 4000), PointMass(1500, 5))
    profile = replace(TAPERED, shear_stiffness=shear, rotary_inertia=(2000.0, 1000.0, 1500.0),
                      point_masses=masses)  # fmt: skip
    beam = BeamElements(profile, 16)
    R = beam.rigid
    exact = np.diag([profile.mass, profile.pitch_inertia])
    np.testing.assert_allclose(R.T @ (beam.M @ R), exact, rtol=1e-12, atol=1e-8 * profile.mass)
    strain = beam.strain_roots(R)
    assert np.abs(strain).max() < 1e-10 * np.sqrt(np.abs(beam.K).max())
    for A in (beam.M, beam.K):
        assert np.abs(A - A.T).max() < 1e-12 * np.abs(A).max()


def test_short_elements_cost_no_digits():
    """A ramp of 3 mm, one element, to four times the stiffness; and such an element by itself."""
    ramp = replace(STEPPED, x=(-12, -3.0015, -2.9985, 12))
    assert_solves(ramp, element_modes(ramp, 4, elements=256).frequencies, rtol=5e-6)
    split = replace(UNIFORM, x=(-12, 3, 3.003, 12), bending_stiffness=(EI,) * 4,
                    mass_per_length=(MU,) * 4)  # fmt: skip
    np.testing.assert_allclose(element_modes(split, 5).frequencies, CLOSED, rtol=1e-6)


def test_a_stretch_without_mass_is_taken():
    light = BodyProfile((-12, -6, -6, 6, 6, 12), (EI,) * 6, (MU, MU, 0, 0, MU, MU))
    assert_solves(light, element_modes(light, 2, elements=128).frequencies)


def test_modes_that_lanczos_misses_are_looked_for_again(monkeypatch):
    whole = reduction._by_lanczos

    def careless(M, K, count):
        squares, modes = whole(M, K, count)
        kept = np.argsort(squares)[np.arange(count) != 2] if count < 20 else slice(None)
        return squares[kept], modes[:, kept]

    exact = element_modes(STEPPED, 4).frequencies
    monkeypatch.setattr(reduction, "_by_lanczos", careless)
    np.testing.assert_allclose(element_modes(STEPPED, 4).frequencies, exact, rtol=1e-10)


@pytest.mark.parametrize("elements", [20, 128])
@pytest.mark.parametrize("ends", [(EI, 1e30 * EI), (1e-25 * EI, 1e-25 * EI)])
def test_a_body_of_which_no_modes_can_be_computed_is_refused(ends, elements):
    profile = BodyProfile((-12, -5, 12), (ends[0], *ends), (MU, MU, MU))
    with pytest.raises(InputError, match="no natural modes can be computed; expected"):
        element_modes(profile, 2, elements=elements)


def test_craig_bampton_nears_the_elements_from_above():
    full = element_modes(STEPPED, 4).frequencies
    last = np.full(4, np.inf)
    for count in (4, 6, 10, 20):
        reduced = element_modes(STEPPED, count, interfaces=(-8.75, 0, 8.75))
        found = reduced.frequencies[:4]
        assert reduced.count == count
        assert (found > full * (1 - 1e-9)).all()
        assert (found < last * (1 + 1e-9)).all()
        last = found
    np.testing.assert_allclose(last, full, rtol=1e-4)


def test_craig_bampton_bends_exactly_under_static_forces_on_its_interfaces():
    """1 N down in the middle, ½ N up at ±a: (2a)³/(48 EI), where truncated modes stay below."""
    a = 8.75
    exact = (2 * a) ** 3 / (48 * EI)

    def yielding(modes):
        along = modes.shapes([-a, 0.0, a]) @ [0.5, -1.0, 0.5]
        return np.sum(along**2 / (modes.mass * (2 * np.pi * modes.frequencies) ** 2))

    reduced = element_modes(UNIFORM, 6, interfaces=(-a, 0, a))
    assert yielding(reduced) / exact == pytest.approx(1, rel=1e-9)
    assert yielding(element_modes(UNIFORM, 6)) < exact * (1 - 1e-3)


def test_craig_bampton_says_which_frequencies_hold():
    (remark,) = element_modes(UNIFORM, 6, interfaces=(-8.75, 8.75)).remarks
    full, reduced = (element_modes(UNIFORM, 6, interfaces=i) for i in ((), (-8.75, 8.75)))
    held = int(np.argmin(reduced.frequencies / full.frequencies - 1 < 1e-3))
    assert f"the first {held} of 6" in remark
    assert element_modes(UNIFORM, 6).remarks == ()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"count": 0}, "modes: found 0; expected a whole number"),
        ({"count": 10, "elements": 19}, "elements: found 19; expected a whole number from 20"),
        ({"count": 4, "elements": 10**6}, "elements: found 1000000"),
        ({"interfaces": (-8.75, 12.5)}, "found 12.5 m, a point off the body"),
        ({"interfaces": (1.0,)}, "at least two"),
        ({"interfaces": (1.0, 1.0005)}, "each at its own place"),
        ({"count": 1, "interfaces": (-8, -4, 4, 8)}, "interfaces: found 4 with 1 modes"),
    ],
)
def test_numbers_that_do_not_fit_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        element_modes(UNIFORM, **given)


def test_places_too_near_to_one_another_are_refused():
    near = replace(STEPPED, point_masses=(PointMass(100, -3.0007),))
    with pytest.raises(
        InputError, match=r"-3\.0007 m and -3 m; expected places at least 0\.0024 m"
    ):
        element_modes(near)


def test_without_scikit_fem_its_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "skfem", None)
    with pytest.raises(InputError, match=r"scikit-fem.*railride\[fe\]"):
        element_modes(UNIFORM)
