"""Car bodies: beams, distributions of mass and the reading of the floor."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from vehicles import density, paper_coach, random_model

from railride.bodies import RigidBody, SegmentedBody
from railride.errors import InputError
from railride.parameters import CarBody, load_vehicle
from railride.vehicle import derive_vehicle

MASS, LENGTH, EI = 30e3, 20.0, 8e8
BEAM = CarBody(mass=MASS, pitch_inertia=MASS * LENGTH**2 / 12, length=LENGTH, bending_stiffness=EI)
# Free-free Euler-Bernoulli beam: cosh βL cos βL = 1, printed as 4.730041, 7.853205, 10.995608.
BETA_L = np.array([4.730040744862704, 7.853204624095838, 10.995607838001671])
EULER_HZ = BETA_L**2 / (2 * np.pi) * np.sqrt(EI * LENGTH / MASS) / LENGTH**2


def coach(**body):
    vehicle = load_vehicle("cati2024")
    return replace(vehicle, body=replace(vehicle.body, **body))


def beam_error(segments):
    """Relative error of the first bending frequencies of the free chain, in %."""
    bogies = load_vehicle("cati2024").bogies
    model = derive_vehicle(replace(load_vehicle("cati2024"), body=BEAM, bogies=bogies), segments)
    found = model.bending_frequencies()[:3]
    return 100 * (found / EULER_HZ[: len(found)] - 1)


@pytest.mark.parametrize(
    ("segments", "printed"),
    [
        (4, ("-0.317", "-3.92", "-19.4")),
        (8, ("-0.011", "-0.107", "-0.521")),
        (10, ("-0.0042", "-0.037", "-0.171")),
        (20, ("-0.0002", "-0.0018", "-0.0074")),
    ],
)
def test_chain_of_segments_approaches_the_beam(segments, printed):
    """k = EI/ℓ, rod segments: the errors computed by two independent programs."""
    for found, expected in zip(beam_error(segments), printed, strict=True):
        assert f"{found:.{len(expected.partition('.')[2])}f}" == expected


def test_the_chain_converges_with_the_fourth_order_from_below():
    errors = np.array([beam_error(segments) for segments in (8, 16, 32)])
    assert (errors < 0).all()
    away = np.abs(np.log2(errors[:-1] / errors[1:]) - 4)  # of the order found from 4
    assert (away[1] < away[0]).all()
    assert (away[1] < [0.1, 0.2, 0.25]).all()


@pytest.mark.parametrize(("inertia", "hertz"), [("rods", "9.586"), ("segments", "8.87")])
def test_two_halves_with_the_papers_joint(inertia, hertz):
    model = derive_vehicle(coach(inertia=inertia), 2, joint_stiffness=3.7e8)
    found = float(model.bending_frequencies()[0])
    assert f"{found:.{len(hertz.partition('.')[2])}f}" == hertz


def total_moments(model):
    """Mass, first moment and pitch inertia about the mass centre, from M of the free body."""
    own = model.body.segments + 1
    M = model.matrices().M[:own, :own]
    lift, x = np.ones(own), np.linspace(0.5, -0.5, own) * model.vehicle.body.length
    mass, first = lift @ M @ lift, lift @ M @ x
    return mass, first / mass, x @ M @ x - first**2 / mass


@pytest.mark.parametrize("segments", [2, 3, 4, 5, 8, 16])
@pytest.mark.parametrize("offset", [0.0, 0.7])
@pytest.mark.parametrize("ratio", [0.8, 1.0, 1.25])
def test_graded_mass_keeps_mass_centre_and_inertia(segments, offset, ratio):
    inertia = ratio * 34e3 * 24**2 / 12
    body = {"pitch_inertia": inertia, "mass_centre": offset, "inertia": "graded"}
    found = total_moments(derive_vehicle(coach(**body), segments))
    np.testing.assert_allclose(found, (34e3, offset, inertia), rtol=1e-11, atol=1e-10)


@pytest.mark.parametrize("segments", [2, 3, 7])
def test_graded_mass_is_the_parabola_with_the_three_moments(segments):
    model = random_model(5, segments)
    values, mu = model.values(), density(model.vehicle.body)
    found = [float(values[f"mu_{i}"]) for i in range(3)]
    np.testing.assert_allclose(found, mu.coef, rtol=1e-9)


@pytest.mark.parametrize("segments", [2, 3])
def test_own_inertia_makes_up_the_whole(segments):
    found = total_moments(derive_vehicle(coach(inertia="segments"), segments))
    np.testing.assert_allclose(found, (34e3, 0.0, 1.7e6), rtol=1e-12, atol=1e-10)


def test_rods_are_chosen_within_five_per_cent():
    rod = 34e3 * 24**2 / 12
    for ratio, offset, expected in [
        (1 / 1.04, 0.0, "rods"), (1 / 0.96, 0.0, "rods"), (1 / 1.06, 0.0, "graded"),
        (1 / 0.94, 0.0, "graded"), (1.0, 0.1, "graded"),
    ]:  # fmt: skip
        body = coach(pitch_inertia=ratio * rod, mass_centre=offset).body
        assert SegmentedBody(body, 4).inertia == expected


def test_own_inertia_is_refused_where_it_is_not_positive():
    ice3 = load_vehicle("ice3")
    body = replace(ice3.body, inertia="segments", bending_frequency=10.0)
    SegmentedBody(body, 2)
    for segments in (3, 4, 16):
        with pytest.raises(InputError, match=r"body\.inertia.*positive pitch inertia"):
            SegmentedBody(body, segments)


@pytest.mark.parametrize(("ratio", "offset"), [(0.3, 0.0), (1.9, 0.0), (0.6, 3.5)])
def test_a_graded_mass_that_would_be_negative_is_refused(ratio, offset):
    body = coach(pitch_inertia=ratio * 34e3 * 24**2 / 12, mass_centre=offset,
                 inertia="graded").body  # fmt: skip
    assert density(body).linspace(201, [-12, 12])[1].min() < 0
    with pytest.raises(InputError, match=r"pitch_inertia.*kg/m"):
        SegmentedBody(body, 4)


def test_graded_mass_is_refused_exactly_where_it_turns_negative():
    rng = np.random.default_rng(3)
    verdicts = []
    for _ in range(200):
        body = coach(pitch_inertia=rng.uniform(0.3, 2.0) * 34e3 * 48,
                     mass_centre=rng.uniform(-3, 3), inertia="graded").body  # fmt: skip
        lowest = density(body).linspace(20001, [-12, 12])[1].min()
        if abs(lowest) < 1.0:
            continue
        verdicts.append(lowest > 0)
        try:
            SegmentedBody(body, 3)
        except InputError:
            assert lowest < 0
        else:
            assert lowest > 0
    assert 20 < sum(verdicts) < len(verdicts) - 20


@pytest.mark.parametrize("inertia", ["rods", "segments"])
def test_equal_masses_are_refused_with_the_mass_centre_off_the_middle(inertia):
    """Equal segments have their mass centre at the middle: 0.5 m would be dropped in silence."""
    with pytest.raises(InputError, match=r"mass centre|mass_centre"):
        SegmentedBody(coach(inertia=inertia, mass_centre=0.5).body, 2)


def test_a_body_of_unknown_bending_is_rigid():
    manchester = load_vehicle("manchester")
    assert isinstance(derive_vehicle(manchester).body, RigidBody)
    with pytest.raises(InputError, match="bending"):
        derive_vehicle(manchester, 4)
    assert derive_vehicle(manchester, 4, bending_frequency=10.0).body.segments == 4


# The floor


def bent(model, kappa):
    """Node heights of the polygon whose joints all turn by κ ℓ, chosen free of lift and pitch."""
    N = model.body.segments
    x = np.linspace(0.5, -0.5, N + 1) * model.vehicle.body.length
    z = np.zeros(len(model.linear.coordinates))
    z[: N + 1] = kappa * x**2 / 2
    return z


def read(model, z, at, floor):
    row = model.output_rows([model.floor(at, floor, derivative=0)])["d"][0]
    return float(row @ z)


@pytest.mark.parametrize("segments", [2, 3, 4, 7])
def test_polygon_is_straight_between_its_nodes(segments):
    model = paper_coach(segments)
    nodes = np.linspace(12, -12, segments + 1)
    z = np.zeros(len(model.linear.coordinates))
    z[: segments + 1] = np.random.default_rng(segments).normal(size=segments + 1)
    for at in np.linspace(-12, 12, 41):
        expected = np.interp(at, nodes[::-1], z[: segments + 1][::-1])
        assert read(model, z, at, "polygon") == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("segments", [3, 4, 8])
def test_smooth_floor_has_the_polygons_mean_and_the_joints_curvature(segments):
    """z = polygon + κ ℓ² (ξ²/2 - 1/24), κ linear between the hinges and zero at the free ends."""
    model, ell = paper_coach(segments), 24 / segments
    z = np.zeros(len(model.linear.coordinates))
    z[: segments + 1] = np.random.default_rng(segments).normal(size=segments + 1)
    nodes = np.linspace(12, -12, segments + 1)
    slope = -np.diff(z[: segments + 1]) / ell  # θ_1 … θ_N
    kappa = np.concatenate([[0.0], -np.diff(slope) / ell, [0.0]])  # (θ_ahead - θ_behind)/ℓ
    for i in range(segments):
        middle = (nodes[i] + nodes[i + 1]) / 2
        for xi in (-0.49, -0.2, 0.0, 0.31, 0.49):
            at = middle + xi * ell
            local = np.interp(at, [nodes[i + 1], nodes[i]], [kappa[i + 1], kappa[i]])
            expected = read(model, z, at, "polygon") + local * ell**2 * (xi**2 / 2 - 1 / 24)
            assert read(model, z, at, "smooth") == pytest.approx(expected, abs=1e-9)


def test_smooth_floor_of_a_bow_is_the_bow():
    """Where the curvature is the same all around, floor and parabola differ by the means alone."""
    model, kappa = paper_coach(8), 1e-3
    z = bent(model, kappa)
    for at in np.linspace(-5.9, 5.9, 25):
        means = kappa * 3.0**2 / 12  # the polygon's mean over a segment less the parabola's
        assert read(model, z, at, "smooth") - kappa * at**2 / 2 == pytest.approx(means, abs=1e-12)


@pytest.mark.parametrize("segments", [2, 4, 5])
def test_smooth_floor_is_continuous_across_a_hinge(segments):
    model = paper_coach(segments)
    z = np.zeros(len(model.linear.coordinates))
    z[: segments + 1] = np.random.default_rng(9).normal(size=segments + 1)
    for hinge in np.linspace(12, -12, segments + 1)[1:-1]:
        here = read(model, z, hinge, "smooth")
        for beside in (-1e-7, 1e-7):
            assert read(model, z, hinge + beside, "smooth") == pytest.approx(here, abs=1e-5)


def test_both_readings_agree_on_a_rigid_body():
    model = paper_coach(1)
    assert model.floor(3.0, "smooth").expression == model.floor(3.0, "polygon").expression


@pytest.mark.parametrize("segments", [1, 4])
def test_points_off_the_body_and_other_readings_are_refused(segments):
    model = paper_coach(segments)
    model.floor(12.0)
    model.floor(-12.0)
    for at in ("x", None, np.nan):
        with pytest.raises(InputError, match=rf"position {at!r}( m)?: found a point off the body"):
            model.floor(at)
    for at in (12.1, -12.1, np.nan, np.inf):
        with pytest.raises(InputError, match=r"position .*-12 and 12"):
            model.floor(at)
    with pytest.raises(InputError, match="smooth, polygon"):
        model.floor(0.0, "mean")
    with pytest.raises(InputError, match="0, 1 or 2"):
        model.floor(0.0, derivative=3)
