"""Bodies of unlike segments: their matrices, places and joints, and the beam that they approach.

The matrices are assembled here by hand with numpy, the beam by Hermite's finite elements.
"""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from numpy.polynomial.legendre import leggauss
from scipy.linalg import eigh
from vehicles import random_vehicle

from railride.bodies import SegmentedBody
from railride.bodies.cuts import EqualCuts, OwnCuts
from railride.bodies.joints import compliances
from railride.bodies.segments import x as place_of
from railride.bodies.segments import z
from railride.errors import InputError
from railride.files import data_path
from railride.parameters import (
    BodyProfile,
    CarBody,
    Load,
    PointMass,
    Segment,
    load_vehicle,
    write_vehicle,
)
from railride.report import vehicle_document
from railride.vehicle import derive_vehicle

SEGMENTS = (
    Segment(3.1, 6200.0, mass_centre=0.4),
    Segment(6.4, 9000.0, 27e3, -0.7),
    Segment(5.0, 5500.0),
    Segment(7.2, 8800.0, 41e3),
    Segment(2.6, 4700.0, mass_centre=-0.3),
)
JOINTS = (4e8, 6e8, 5e8, 7e8)
UNLIKE = CarBody.of(SEGMENTS, joint_stiffness=JOINTS, bending_damping=0.01)
COACH = data_path("vehicles", "cati2024.toml").read_text(encoding="utf-8")
OWN = COACH[COACH.index('mass = "34000 kg"') : COACH.index("bending_frequency =")]

KNOTS = np.linspace(-12, 12, 97)
SMOOTH = BodyProfile(
    tuple(KNOTS),
    tuple(3e9 * (1 + 0.4 * np.cos(np.pi * KNOTS / 12) + 0.2 * KNOTS / 12)),
    tuple(1400 * (1 + 0.3 * (KNOTS / 12) ** 2 - 0.15 * KNOTS / 12)),
)
DOORS = BodyProfile(
    (-12, -9.3, -9.3, -8, -8, 8, 8, 9.3, 9.3, 12),
    (3e9, 3e9, 1e9, 1e9, 3e9, 3e9, 1e9, 1e9, 3e9, 3e9),
    (1800, 1600, 1300, 1300, 1300, 1300, 1300, 1300, 1600, 1800),
)


def numbers(body, N, **changes):
    """Every value of a segmented body's parameters, by symbol."""
    segmented = SegmentedBody(body, N)
    vehicle = replace(load_vehicle("cati2024"), body=body)
    return segmented, derive_vehicle(vehicle, N).values(**changes)


def turns(nodes):
    """θ_ahead - θ_behind of every joint by the heights of the nodes, from the front."""
    slopes = (np.eye(len(nodes))[:-1] - np.eye(len(nodes))[1:]) / -np.diff(nodes)[:, np.newaxis]
    return slopes[:-1] - slopes[1:]


# Masses and joints


def test_matrices_of_unlike_segments_are_those_of_their_masses_and_springs():
    body, values = numbers(UNLIKE, 5)
    nodes = UNLIKE.length / 2 - np.concatenate([[0], np.cumsum([s.length for s in SEGMENTS])])
    M = np.zeros((6, 6))
    for i, s in enumerate(SEGMENTS):
        e = s.mass_centre / s.length
        centre, turn = np.array([0.5 + e, 0.5 - e]), np.array([1.0, -1.0]) / s.length
        J = s.mass * s.length**2 / 12 if s.pitch_inertia is None else s.pitch_inertia
        M[i : i + 2, i : i + 2] += s.mass * np.outer(centre, centre) + J * np.outer(turn, turn)
    K = turns(nodes).T @ np.diag(JOINTS) @ turns(nodes)
    found = body.free_matrices(values)
    np.testing.assert_allclose(found["M"], M, rtol=1e-13, atol=1e-9)
    np.testing.assert_allclose(found["K"], K, rtol=1e-12, atol=1e-4)
    np.testing.assert_allclose(body.nodes, nodes, rtol=1e-14)
    rigid = np.array([np.ones(6), nodes])
    m, S, J = (rigid @ M @ rigid.T)[np.triu_indices(2)]
    assert (m, S / m, J - S**2 / m) == pytest.approx(
        (UNLIKE.mass, UNLIKE.mass_centre, UNLIKE.pitch_inertia), rel=1e-13
    )


def test_own_segments_that_are_equal_rods_make_the_equal_body():
    equal = load_vehicle("cati2024")
    rods = CarBody.of([Segment(6.0, 8500.0)] * 4, bending_frequency=9.6, bending_damping=0.02)
    same = derive_vehicle(replace(equal, body=rods), 4).matrices()
    other = derive_vehicle(equal, 4, bending_damping=0.02).matrices()
    for name in ("M", "C", "K"):
        A, B = getattr(same, name), getattr(other, name)
        np.testing.assert_allclose(A, B, rtol=0, atol=1e-12 * np.abs(B).max())


@pytest.mark.parametrize("cuts", [None, (8.0, 2.5, -1.0, -9.1)])
def test_a_profile_s_pieces_have_its_mass_where_it_is(cuts):
    profile = replace(DOORS, point_masses=(PointMass(900.0, 4.2, 500.0), PointMass(700.0, -11.0)))
    made = CarBody.of(profile, cuts=cuts)
    body, values = numbers(made, 5)
    nodes, M = body.nodes, np.zeros((6, 6))
    expected = [12.0, *cuts, -12.0] if cuts else np.linspace(12, -12, 6)
    np.testing.assert_allclose(nodes, expected, rtol=1e-13)

    def heights(x):
        return np.array([np.interp(x, nodes[::-1], row[::-1]) for row in np.eye(6)])

    ends = np.unique([*nodes, *profile.x])
    for (a, b), (p, w) in itertools.product(
        itertools.pairwise(ends), zip(*leggauss(4), strict=True)
    ):
        at = (a + b) / 2 + p * (b - a) / 2
        mass = profile.at("mass_per_length", at) * w * (b - a) / 2
        M += mass * np.outer(heights(at), heights(at))
    for point in profile.point_masses:
        M += point.mass * np.outer(heights(point.position), heights(point.position))
        i = int(np.sum(nodes > point.position)) - 1
        turn = (np.eye(6)[i] - np.eye(6)[i + 1]) / (nodes[i] - nodes[i + 1])
        M += point.pitch_inertia * np.outer(turn, turn)
    np.testing.assert_allclose(body.free_matrices(values)["M"], M, rtol=1e-12, atol=1e-8)


def test_a_payload_on_unlike_segments_is_where_it_is():
    loads = (Load(3000.0), Load(1500.0, front=9.0, rear=-3.0), Load(800.0, front=2.0, rear=2.0))
    vehicle = replace(load_vehicle("cati2024"), body=UNLIKE)
    empty = derive_vehicle(vehicle, 5)
    full = derive_vehicle(replace(vehicle, payload=loads), 5)
    nodes, added = empty.body.nodes, np.zeros((6, 6))

    def heights(x):
        return np.array([np.interp(x, nodes[::-1], row[::-1]) for row in np.eye(6)])

    for load in loads:
        half = UNLIKE.length / 2
        front, rear = (half, -half) if load.front is None else (load.front, load.rear)
        ends = np.unique(np.clip([front, rear, *nodes], rear, front))
        for a, b in itertools.pairwise(ends):
            for p, w in zip(*leggauss(3), strict=True):
                h = heights((a + b) / 2 + p * (b - a) / 2)
                added += load.mass / (front - rear) * w * (b - a) / 2 * np.outer(h, h)
        if front == rear:
            added += load.mass * np.outer(heights(front), heights(front))
    found = (full.matrices().M - empty.matrices().M)[:6, :6]
    np.testing.assert_allclose(found, added, rtol=1e-9, atol=1e-7)


@pytest.mark.parametrize("lengths", [(3.0, 5.0, 8.0, 4.0), (4.0, 6.0, 7.0, 3.0), (12.0, 5.0, 3.0)])
def test_segments_stay_in_line_about_the_body_s_middle(lengths):
    """The point of the body at its middle is held in x; (4, 6 | 7, 3) has a hinge there."""
    segments = [Segment(length, 1000.0 * length) for length in lengths]
    body = SegmentedBody(CarBody.of(segments, bending_frequency=10.0), len(lengths))
    heights = np.random.default_rng(4).uniform(-0.8, 0.8, len(lengths) + 1)
    values = {z(i): h for i, h in enumerate(heights)}
    values |= {p.symbol: p.value for p in body.parameters}
    found = {}
    for q, expression in body.energies.kinematics.items():
        found[q] = float(expression.subs(found).subs(values))
    reach = np.sqrt(np.square(lengths) - np.diff(heights) ** 2)  # along the track
    ends = np.concatenate([[0.0], np.cumsum(lengths)])
    middle = np.interp(ends[-1] / 2, ends, np.concatenate([[0.0], np.cumsum(reach)]))
    places = middle - (np.cumsum(reach) - reach / 2)
    np.testing.assert_allclose([found[place_of(i + 1)] for i in range(len(lengths))], places,
                               rtol=1e-12, atol=1e-12)  # fmt: skip


# Stiffness from EI(x)


def beam_hz(profile, elements=120):
    """Free-free bending frequencies of the beam itself, by Hermite's cubic elements."""
    ends = np.unique([*np.linspace(profile.x[0], profile.x[-1], elements + 1), *profile.x])
    K, M = np.zeros((2, 2 * len(ends), 2 * len(ends)))
    p, w = leggauss(5)
    s = (1 + p) / 2
    for e, (a, b) in enumerate(itertools.pairwise(ends)):
        h = b - a
        N = np.array([1 - 3 * s**2 + 2 * s**3, h * (s - 2 * s**2 + s**3),
                      3 * s**2 - 2 * s**3, h * (s**3 - s**2)])  # fmt: skip
        B = np.array([12 * s - 6, h * (6 * s - 4), 6 - 12 * s, h * (6 * s - 2)]) / h**2
        here = slice(2 * e, 2 * e + 4)
        K[here, here] += (B * profile.at("bending_stiffness", a + h * s) * w * h / 2) @ B.T
        M[here, here] += (N * profile.at("mass_per_length", a + h * s) * w * h / 2) @ N.T
    return np.sqrt(eigh(K, M, eigvals_only=True, subset_by_index=[2, 4])) / (2 * np.pi)


def chain_hz(profile, N):
    """Those of a chain of N segments."""
    body, values = numbers(CarBody.of(profile), N)
    return body.bending_frequencies(values)[:3]


def test_the_elements_here_meet_the_closed_form_of_the_uniform_beam():
    """βL = 4.730041, 7.853205, 10.995608."""
    uniform = BodyProfile((-12, 12), (3e9, 3e9), (1400, 1400))
    beta = np.array([4.730040744862704, 7.853204624095838, 10.995607838001671]) / 24
    exact = beta**2 * np.sqrt(3e9 / 1400) / (2 * np.pi)
    np.testing.assert_allclose(beam_hz(uniform), exact, rtol=2e-6)


@pytest.mark.parametrize("profile", [SMOOTH, DOORS])
def test_segments_of_a_profile_converge_with_the_fourth_order(profile):
    """Whether EI(x) is smooth or jumps: springs in series between the middles have order 2."""
    exact = beam_hz(profile)
    errors = np.array([100 * np.abs(chain_hz(profile, N) / exact - 1) for N in (8, 16, 32)])
    assert (errors[0] < [0.15, 0.5, 1.5]).all()
    assert (errors[-1] < [0.001, 0.005, 0.01]).all()
    assert (np.log2(errors[1] / errors[2]) > 3.7).all()


def test_joints_of_a_uniform_beam_are_EI_over_ell():
    uniform = BodyProfile((-12, 0.7, 12), (3e9,) * 3, (1400,) * 3)
    for N in (2, 3, 4, 7, 30):
        nodes = np.linspace(12, -12, N + 1)
        np.testing.assert_allclose(compliances(uniform, nodes), 24 / N / 3e9, rtol=1e-13)


def test_frequencies_scale_the_joints_of_a_profile_and_of_a_list():
    for made, N in ((CarBody.of(DOORS), 6), (replace(UNLIKE, bending_damping=0.0), 5)):
        body, values = numbers(made, N)
        k = [float(values[f"k_theta_{j}"]) for j in range(1, N)]
        _, calibrated = numbers(replace(made, bending_frequency=9.6), N)
        ratio = [float(calibrated[f"k_theta_{j}"]) for j in range(1, N)] / np.array(k)
        np.testing.assert_allclose(ratio, ratio[0], rtol=1e-12)
        assert body.bending_frequencies(calibrated)[0] == pytest.approx(9.6, rel=1e-12)


def test_structural_damping_of_unlike_joints_is_that_of_the_first_mode():
    body, values = numbers(UNLIKE, 5)
    c = np.array([float(values[f"c_theta_{j}"]) for j in range(1, 5)])
    np.testing.assert_allclose(c / JOINTS, (c / JOINTS)[0], rtol=1e-13)
    omega = 2 * np.pi * body.bending_frequencies(values)[0]
    assert c[0] == pytest.approx(2 * 0.01 * JOINTS[0] / omega, rel=1e-12)


def test_joints_may_be_given_one_by_one_and_changed():
    made = replace(UNLIKE, bending_damping=0.0, joint_damping=(1e4, 2e4, 3e4, 4e4))
    model = derive_vehicle(replace(load_vehicle("cati2024"), body=made), 5)
    before, after = model.matrices(), model.matrices(k_theta_2=7e8, c_theta_3=0.0)
    G = turns(model.body.nodes)
    dK, dC = (after.K - before.K)[:6, :6], (after.C - before.C)[:6, :6]
    np.testing.assert_allclose(dK, 1e8 * np.outer(G[1], G[1]), rtol=1e-6, atol=1e-2)
    np.testing.assert_allclose(dC, -3e4 * np.outer(G[2], G[2]), rtol=1e-6, atol=1e-6)


def test_rayleigh_s_beta_damps_the_joints_in_proportion():
    _, values = numbers(replace(UNLIKE, bending_damping=0.0, rayleigh_stiffness=4e-4), 5)
    for j, k in enumerate(JOINTS, start=1):
        assert float(values[f"c_theta_{j}"]) == pytest.approx(4e-4 * k, rel=1e-14)


@pytest.mark.parametrize("damping", [{"rayleigh_mass": 0.1}, {"mode_damping": (0.01, 0.02)}])
def test_damping_that_joints_cannot_have_is_refused(damping):
    with pytest.raises(InputError, match=f"{next(iter(damping))}: found it with segments, whose"):
        SegmentedBody(replace(UNLIKE, bending_damping=0.0, **damping), 5)


def test_what_became_of_given_stiffnesses_is_remarked_on():
    body, values = numbers(CarBody.of(DOORS), 6)
    assert body.remarks == ()
    factor = (9.6 / float(body.bending_frequencies(values)[0])) ** 2
    (remark,) = SegmentedBody(CarBody.of(DOORS, bending_frequency=9.6), 6).remarks
    assert remark.startswith(f"the profile's bending stiffness taken {factor:.4g} times")
    listed = replace(UNLIKE, bending_frequencies=(9.0, 25.0))
    (remark,) = SegmentedBody(listed, 5).remarks
    assert "the joint stiffnesses taken 0.6" in remark
    shears = replace(DOORS, shear_stiffness=(4e8,) * 10)
    assert "do not shear" in SegmentedBody(CarBody.of(shears), 4).remarks[0]


# In a vehicle


def test_a_body_s_own_segments_are_the_default():
    vehicle = replace(load_vehicle("cati2024"), body=UNLIKE)
    assert derive_vehicle(vehicle).body.segments == 5
    assert derive_vehicle(vehicle, body="segments").body.segments == 5
    assert derive_vehicle(vehicle, 1).body.segments == 1
    cut = CarBody.of(DOORS, cuts=(3.0, -3.0))
    assert derive_vehicle(replace(vehicle, body=cut)).body.segments == 3
    assert derive_vehicle(replace(vehicle, body=CarBody.of(DOORS))).body.segments == 4


def test_a_beam_of_joints_is_refused():
    vehicle = replace(load_vehicle("cati2024"), body=replace(UNLIKE, joint_damping=JOINTS,
                                                             bending_damping=0.0))  # fmt: skip
    with pytest.raises(InputError) as refused:
        derive_vehicle(vehicle, body="beam")
    for words in ("found a joint_stiffness", "body.joint_damping: found",
                  "segments: found rigid segments; expected a uniform beam"):  # fmt: skip
        assert words in str(refused.value)


@pytest.mark.parametrize("form", ["markdown", "latex"])
def test_unlike_segments_are_written_out(form):
    short = CarBody.of(SEGMENTS[:4], joint_stiffness=JOINTS[:3])
    model = derive_vehicle(replace(load_vehicle("cati2024"), body=short))
    text = str(vehicle_document(model, form))
    for expected in (r"\ell_1", "length of segment 4", r"k_{\theta, 3}", "joint stiffness 3"):
        assert expected in text


# Cuts


def test_places_on_equal_and_own_cuts_agree():
    equal, own = EqualCuts(24.0, 5), OwnCuts.of([4.8] * 5)
    values = {sp.Symbol("L", positive=True): 24.0}
    values |= {p.symbol: p.value for p in own.parameters}
    for at in (12.0, 7.2, 7.1, 0.0, -2.4, -12.0):
        assert equal.segment_at(at) == own.segment_at(at)
    for i in range(1, 6):
        for name in ("ell", "node", "middle"):
            found = [float(getattr(cuts, name)(i).subs(values)) for cuts in (equal, own)]
            assert found[0] == pytest.approx(found[1], abs=1e-12)
        along = [float(cuts.along(i, sp.Float(1.3)).subs(values)) for cuts in (equal, own)]
        assert along[0] == pytest.approx(along[1], abs=1e-12)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_random_vehicle_on_a_profile_is_reciprocal_and_held(seed):
    """Matrices check themselves when made: symmetric, M positive definite, a lift without force."""
    vehicle = random_vehicle(seed)
    half = vehicle.body.length / 2
    profile = BodyProfile((-half, 0.1, half), (2e9, 4e9, 3e9), (1200, 1500, 1700))
    model = derive_vehicle(replace(vehicle, body=CarBody.of(profile, bending_damping=0.02)), 6)
    A = model.matrices()
    pitch = model.pitch()
    own = slice(0, 7)
    assert np.abs(model.free_body_stiffness() @ pitch[own]).max() < 1e-9 * np.abs(A.K).max()


# What is refused


@pytest.mark.parametrize(
    ("changes", "N", "message"),
    [
        ({}, 4, r"segments: found 4; expected 5, as the car body's tables \[\[segments\]\] have"),
        ({"segments": (), "joint_stiffness": JOINTS}, 3, "found 3; expected 5, as .* joints"),
        ({"segments": (), "profile": DOORS, "cuts": (1.0, -2.0), "joint_stiffness": None}, 4,
         "found 4; expected 3, as the car body's cuts have"),
        ({"segments": (), "joint_stiffness": None, "profile": replace(
            DOORS, mass_per_length=(0, 0, 0, 0, 0, 1300, 1300, 0, 0, 0)), "cuts": (-8.5,)}, 2,
         "body.profile: found 0 kg with a pitch inertia of 0 kg m.2 on segment 2, from -8.5"),
        ({"segments": (), "joint_stiffness": None, "profile": BodyProfile(
            (-12, -6.1, -6.1, -6, -6, 12), (9e9, 9e9, 1e4, 1e4, 9e9, 9e9), (1400,) * 6),
          "cuts": (6, 0, -3)}, 4, "bending_stiffness: found it so low near the joint at"),
    ],
)  # fmt: skip
def test_a_body_refuses_segments_that_it_cannot_have(changes, N, message):
    values = {"bending_damping": 0.01} | changes
    if "profile" in changes:
        made = CarBody.of(changes["profile"], cuts=changes["cuts"])
    elif "segments" in changes:
        made = CarBody(34e3, 1.632e6, 24.0, joint_stiffness=values["joint_stiffness"])
    else:
        made = UNLIKE
    with pytest.raises(InputError, match=message):
        SegmentedBody(made, N)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"length": 24.0}, "length: found 24 m; expected 24.3 m, that of the segments together"),
        ({"mass": 34e3}, "mass: found 34000 kg; expected 34200 kg, that of the segments together"),
        (
            {"joint_stiffness": (4e8, 5e8)},
            "joint_stiffness: found 2 values; expected 4, one for each",
        ),
        ({"joint_stiffness": (4e8, -5e8, 1e8, 1e8)}, r"joint_stiffness\[2\]: found -5"),
        ({"joint_damping": (1.0,), "bending_damping": 0.0}, "joint_damping: found 1 values; exp"),
        ({"inertia": "rods"}, "inertia: found 'rods' with a mass distribution"),
        ({"profile": DOORS}, "profile: found a profile and segments together"),
        ({"cuts": (1.0,)}, "cuts: found cuts of a body without a profile"),
        ({"segments": (3,)}, "segments: found .*; expected a sequence of Segment"),
        ({"bending_frequencies": ()}, "bending_frequencies: found none; expected one or several"),
        ({"bending_frequencies": (9.0, 8.0)}, r"bending_frequencies\[2\]: found 8 Hz after 9 Hz"),
        ({"bending_frequencies": (9.0,), "bending_frequency": 9.0}, "together; expected one of"),
        ({"bending_stiffness": 3e9}, "joint_stiffness and bending_stiffness together"),
    ],
)
def test_a_body_of_segments_refuses_what_does_not_fit(changes, message):
    with pytest.raises(InputError, match=f"car body: {message}|{message}"):
        replace(UNLIKE, **changes)


@pytest.mark.parametrize("cuts", [(), (13.0,), (1.0, 1.0), (-2.0, 3.0), (12.0,)])
def test_cuts_off_the_body_or_out_of_order_are_refused(cuts):
    with pytest.raises(InputError, match=r"cuts: found .*; expected places on the body, from"):
        CarBody.of(DOORS, cuts=cuts)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((0.0, 1e3), "length: found 0.0; expected a positive number m"),
        ((3.0, -1.0), "mass: found -1.0; expected a positive number kg"),
        ((3.0, 1e3, 0.0), r"pitch_inertia: found 0.0; expected a positive number kg m\^2"),
        ((3.0, 1e3, None, 1.6), "mass_centre: found 1.6 m; expected a place on the segment"),
    ],
)
def test_a_segment_refuses_what_no_segment_has(values, message):
    with pytest.raises(InputError, match=f"segment: {message}"):
        Segment(*values)


def test_lengths_of_own_segments_do_not_change():
    model = derive_vehicle(replace(load_vehicle("cati2024"), body=UNLIKE), 5)
    assert model.matrices(ell_2=6.4, m_2=[8e3, 9e3]).M.shape == (2, 10, 10)
    with pytest.raises(InputError, match=r"ell_2: found 6.5 m; expected 6.4 m.*derive the changed"):
        model.matrices(ell_2=6.5)


def test_a_bogie_stays_on_its_own_segment():
    model = derive_vehicle(replace(load_vehicle("cati2024"), body=UNLIKE), 5)
    assert model.matrices(l_b=[8.0, 9.0]).K.shape[0] == 2
    with pytest.raises(InputError, match="found it on another segment than segment 2"):
        model.matrices(l_b=9.1)


# In parameter files

TABLES = """
joint_stiffness = ["4e8 N m/rad", "4e8 N m/rad"]
[[segments]]
length = "7 m"
mass = "10 t"
mass_centre = "0.5 m"
[[segments]]
length = "10 m"
mass = "14 t"
pitch_inertia = "130e3 kg m^2"
[[segments]]
length = "7 m"
mass = "10 t"
"""
BENDING = (
    'bending_frequency = "9.6 Hz"            # free-free, first bending; calibrates the joints'
)


def coach_of(tmp_path, tables):
    """A parameter file with these tables in the place of the body's own values."""
    text = COACH.replace(OWN, "").replace(BENDING, "")
    joints, rest = tables.split("[[", 1)
    text = text.replace("[body]\n", f"[body]\n{joints}") + "[[" + rest
    path = tmp_path / "coach.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_segments_stand_in_tables_of_their_own(tmp_path):
    body = load_vehicle(coach_of(tmp_path, TABLES)).body
    assert body.segments == (Segment(7, 10e3, mass_centre=0.5), Segment(10, 14e3, 130e3),
                             Segment(7, 10e3))  # fmt: skip
    assert body.joint_stiffness == (4e8, 4e8)
    assert (body.mass, body.length, body.mass_centre) == (34e3, 24.0, pytest.approx(5 / 34))


def test_faults_of_segments_are_named_by_table_and_key(tmp_path):
    wrong = TABLES.replace('"10 m"', '"-10 m"').replace("130e3 kg m^2", "130e3 kg m")
    wrong = wrong.replace('mass_centre = "0.5 m"', 'mass_centre = "4 m"')
    with pytest.raises(InputError) as caught:
        load_vehicle(coach_of(tmp_path, wrong))
    for expected in (
        "segments[2].length: found '-10 m'; expected a positive number",
        "segments[2].pitch_inertia: found '130e3 kg m'",
        "segments[1].mass_centre: found 4 m; expected a place on the segment, at most 3.5 m",
    ):
        assert expected in str(caught.value)


def test_lengths_that_do_not_add_up_are_refused_with_their_sum(tmp_path):
    wrong = 'length = "24.5 m"' + TABLES
    with pytest.raises(
        InputError, match=r"body.length: found 24.5 m; expected 24 m, that of the se"
    ):
        load_vehicle(coach_of(tmp_path, wrong))


@pytest.mark.parametrize(
    "body",
    [
        UNLIKE,
        CarBody.of(DOORS, cuts=(3.0, -3.0), bending_frequencies=(9.6, 24.0)),
        CarBody(34e3, 1.632e6, 24.0, joint_stiffness=(3e8, 4e8, 3e8), joint_damping=(1e3, 0, 2e3)),
    ],
)
def test_bodies_are_written_so_that_they_read_back_equal(tmp_path, body):
    path = tmp_path / "coach.toml"
    vehicle = replace(load_vehicle("cati2024"), body=body)
    write_vehicle(vehicle, path)
    assert load_vehicle(path) == vehicle
