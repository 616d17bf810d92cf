"""Vehicles on bodies of natural modes: what follows when parameters change, damping, comfort."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose

from railride.bodies import BodyModes, ModalBody, beam_modes
from railride.errors import InputError
from railride.modal import modes, undamped_frequencies
from railride.parameters import Load, load_vehicle
from railride.spectra import spectrum
from railride.stochastic import stochastic_ride
from railride.vehicle import VehicleModel, derive_vehicle

MATRICES = ("M", "C", "K", "K_w", "C_w", "B_f")
TIMOSHENKO = {"shear_stiffness": 4e8, "rotary_inertia": 2800.0}
KINDS = {"slender": {}, "shears": TIMOSHENKO}
every_kind = pytest.mark.parametrize("kind", KINDS)


def coach(**body):
    vehicle = load_vehicle("cati2024")
    return replace(vehicle, body=replace(vehicle.body, **body))


@cache
def beam(kind="slender", count=5, **body):
    return derive_vehicle(coach(**KINDS[kind], **body), body="beam", modes=count)


# Changed parameters


@every_kind
def test_changes_equal_a_vehicle_derived_with_them(kind):
    """Shapes follow the bogies, the length, and what the beam is made of."""
    vehicle = coach(**KINDS[kind])
    changed = replace(
        vehicle,
        body=replace(vehicle.body, mass=38e3, length=23.0, bending_frequency=8.0,
                     bending_damping=0.02),
        bogies=tuple(replace(b, position=np.sign(b.position) * 8.1) for b in vehicle.bogies),
    )  # fmt: skip
    changes = {"m_c": 38e3, "L": 23.0, "f_bending": 8.0, "zeta_bending": 0.02, "l_b": 8.1}
    if kind == "shears":
        other = {"shear_stiffness": 3e8, "rotary_inertia": 1500.0}
        changed = replace(changed, body=replace(changed.body, **other))
        changes |= other  # the keys of parameter files name their symbols
    here, there = beam(kind), derive_vehicle(changed, body="beam", modes=5)
    for name in MATRICES:
        expected = getattr(there.matrices(), name)
        assert_allclose(getattr(here.matrices(**changes), name), expected, rtol=1e-10,
                        atol=1e-12 * np.abs(expected).max())  # fmt: skip
    for at in (0.0, -7.7):
        floors = (model.output_rows([model.floor(at)], **given)["a"]
                  for model, given in ((here, changes), (there, {})))  # fmt: skip
        assert_allclose(*floors, atol=1e-10)
    assert_allclose(here.changed(**changes).bending_frequencies(), there.bending_frequencies(),
                    rtol=1e-12)  # fmt: skip


@every_kind
@pytest.mark.parametrize("changes", [{"m_c": 50e3}, {"L": 22.0}, {"k_1": 1e6}, {"l_b": 8.0},
                                     {"m_c": np.array([20e3, 60e3])},
                                     {"L": np.array([[20.0], [26.0]])}])  # fmt: skip
def test_a_calibrated_beam_keeps_its_bending_frequency(kind, changes):
    found = beam(kind).bending_frequencies(**changes)[..., 0]
    assert_allclose(found, 9.6, rtol=1e-12)


def test_a_beam_of_given_stiffness_follows_mass_and_length():
    """f ~ √(EI/(m L³))."""
    model = beam(bending_frequency=None, bending_stiffness=3e9)
    f = model.bending_frequencies()
    assert_allclose(model.bending_frequencies(m_c=17e3), f * np.sqrt(2), rtol=1e-12)
    assert_allclose(model.bending_frequencies(L=21.0), f * (24 / 21) ** 1.5, rtol=1e-12)
    assert_allclose(model.bending_frequencies(bending_stiffness=1.2e10), 2 * f, rtol=1e-12)


@every_kind
def test_lengths_as_an_array_equal_one_by_one(kind):
    lengths = np.array([21.0, 24.0, 26.0])
    many = beam(kind).matrices(L=lengths)
    for i, length in enumerate(lengths):
        one = beam(kind).matrices(L=length)
        for name in ("M", "C", "K", "B_f"):
            among = getattr(many, name)
            assert_allclose(among[i] if among.ndim == 3 else among, getattr(one, name), rtol=1e-10,
                            atol=1e-11 * np.abs(among).max())  # fmt: skip


def test_bogies_moved_off_the_body_are_refused():
    for changes in ({"l_b": 12.5}, {"L": 17.0}, {"l_b": [8.0, 12.1]}):
        with pytest.raises(InputError, match=r"bogie 1: found a position of .* on the body"):
            beam().matrices(**changes)


@every_kind
def test_a_floor_that_a_shorter_body_does_not_reach_is_refused(kind):
    model = beam(kind)
    ends = [model.floor(11.9)]
    model.output_rows(ends, L=23.8)
    with pytest.raises(InputError, match=r"floor at 11.9 m: found .* a body of 23 m"):
        model.output_rows(ends, L=23.0)


def test_what_the_modes_were_made_for_is_not_changed():
    vehicle = coach()
    model = VehicleModel(vehicle, ModalBody(vehicle.body, beam_modes(vehicle.body, 3)))
    assert_allclose(undamped_frequencies(model.matrices()),
                    undamped_frequencies(beam(count=3).matrices()), rtol=1e-12)  # fmt: skip
    with pytest.raises(InputError, match="radius of gyration"):
        model.matrices(r_c=5.0)
    with pytest.raises(InputError, match="'L'"):
        model.matrices(L=25.0)
    other = replace(vehicle.body, mass=30e3)
    with pytest.raises(InputError, match=r"mass: found 34000 kg; expected 30000 kg"):
        ModalBody(other, beam_modes(vehicle.body, 3))


def test_loads_on_shapes_with_kinks_are_integrated_between_them():
    """A shape of straight lines between -12, -3, 6 and 12 m: its squares are parabolas."""
    x, y = np.array([-12.0, -3.0, 6.0, 12.0]), np.array([1.5, -1.0, -0.8, 1.6])
    bent = BodyModes(
        34e3,
        0.0,
        1.632e6,
        24.0,
        [9.6],
        [0.0],
        lambda at: np.interp(at, x, y)[np.newaxis],
        "modes",
        knots=(-3.0, 6.0),
    )
    vehicle = replace(coach(), payload=(Load(5000.0, 11.0, -7.0),))
    M = VehicleModel(vehicle, ModalBody(vehicle.body, bent)).matrices().M
    ends = np.array([-7.0, -3.0, 6.0, 11.0])
    f = np.interp(ends, x, y)
    squares = np.diff(ends) * (f[1:] ** 2 + f[1:] * f[:-1] + f[:-1] ** 2) / 3
    assert M[2, 2] - 34e3 == pytest.approx(5000 * squares.sum() / 18, rel=1e-12)


# Structural damping


def ratios(model, **changes):
    values = model.values(**changes)
    return np.array([float(values[f"zeta_c{i}"]) for i in range(1, model.body.mode_count + 1)])


@every_kind
def test_the_ratio_of_the_first_mode_grows_with_frequency(kind):
    model = beam(kind, bending_damping=0.015)
    f = model.bending_frequencies()
    assert_allclose(ratios(model), 0.015 * f / 9.6, rtol=1e-12)
    assert_allclose(ratios(model, bending_damping=0.03), 0.03 * f / 9.6, rtol=1e-12)


@every_kind
def test_rayleighs_damping(kind):
    """ζ_i = α/(2ω_i) + β ω_i/2."""
    model = beam(kind, rayleigh_mass=0.7, rayleigh_stiffness=3e-4)
    omega = 2 * np.pi * model.bending_frequencies()
    assert_allclose(ratios(model), 0.35 / omega + 1.5e-4 * omega, rtol=1e-12)
    assert_allclose(ratios(model, rayleigh_mass=0.0), 1.5e-4 * omega, rtol=1e-12)


def test_ratios_one_by_one_and_the_last_for_the_rest():
    model = beam(mode_damping=(0.015, 0.02))
    assert_allclose(ratios(model), [0.015, 0.02, 0.02, 0.02, 0.02])
    assert any("modes 3 to 5 have the last" in remark for remark in model.remarks)
    assert not any("last" in remark for remark in beam(mode_damping=(0.01,) * 5).remarks)
    assert ratios(model, zeta_c2=0.05)[1] == 0.05


def test_a_damping_ratio_given_takes_the_place_of_all_others():
    for given in ({"rayleigh_stiffness": 1e-4}, {"mode_damping": (0.01,)}):
        model = derive_vehicle(coach(**given), body="beam", modes=3, bending_damping=0.02)
        assert_allclose(ratios(model), 0.02 * model.bending_frequencies() / 9.6, rtol=1e-12)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"bending_damping": 0.01, "rayleigh_mass": 0.1}, "together; expected one of them"),
        ({"mode_damping": (0.01,), "bending_damping": 0.01}, "together; expected one of them"),
        ({"mode_damping": (0.01, 1.0)}, r"mode_damping\[2\]: found 1; "),
        ({"mode_damping": ()}, "an empty list"),
        ({"mode_damping": (0.01, -0.2)}, r"mode_damping\[2\]: found -0.2"),
        ({"rayleigh_stiffness": -1e-4}, "rayleigh_stiffness: found"),
    ],
)
def test_damping_that_contradicts_itself_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        coach(**given)


def test_overdamped_modes_keep_their_names():
    """ζ_i = ζ f_i/f_1 passes 1: two real eigenvalues, whose product is ω²."""
    model = beam(count=16, bending_damping=0.02)
    found = modes(model)
    creeping = [m for m in found if m.label == "bending 16"]
    assert ratios(model)[-1] > 1
    assert [m.eigenvalue.imag for m in creeping] == [0, 0]
    omega = 2 * np.pi * model.bending_frequencies()[-1]
    assert np.prod([m.eigenvalue.real for m in creeping]) == pytest.approx(omega**2, rel=1e-2)


# Against bodies of segments


@pytest.mark.parametrize(
    ("segments", "printed"),
    [(4, ("-0.317", "-3.92", "-19.4")), (8, ("-0.011", "-0.107", "-0.521")),
     (10, ("-0.0042", "-0.037", "-0.171")), (20, ("-0.0002", "-0.0018", "-0.0074"))],
)  # fmt: skip
def test_segments_approach_the_beam(segments, printed):
    """Of one bending stiffness: the errors in % computed by two independent programs."""
    given = coach(bending_frequency=None, bending_stiffness=3e9, inertia="rods")
    found = derive_vehicle(given, segments).bending_frequencies()[:3]
    exact = derive_vehicle(given, body="beam", modes=3).bending_frequencies()
    for error, expected in zip(100 * (found / exact - 1), printed, strict=True):
        assert f"{error:.{len(expected.partition('.')[2])}f}" == expected


def test_the_vehicle_on_many_segments_has_the_beams_frequencies():
    """Fourth order, with k = EI/ℓ: at N = 40 the first nine are the beam's to 1e-5."""
    given = coach(bending_frequency=None, bending_stiffness=3.416e9, inertia="rods")
    segments = undamped_frequencies(derive_vehicle(given, 40).matrices())[:9]
    exact = undamped_frequencies(derive_vehicle(given, body="beam", modes=30).matrices())[:9]
    assert_allclose(segments, exact, rtol=1e-5)


@cache
def felt(**body):
    """Exact a_wrms at the middle at 145 and 200 km/h on ERRI B176 low, m/s²."""
    floor = body.pop("floor", "smooth")
    model = derive_vehicle("cati2024", **body)
    track = spectrum("erri_low")
    return np.array([stochastic_ride(model, kmh / 3.6, track, floor=floor).a_wrms[0]
                     for kmh in (145, 200)])  # fmt: skip


def test_ten_modes_are_the_beam():
    assert_allclose(felt(body="beam"), felt(body="beam", modes=30), rtol=2e-4)


@pytest.mark.parametrize(("segments", "printed"), [(2, "+39"), (3, "-17"), (4, "+14"), (8, "+3.6")])
def test_polygons_over_and_under_read_the_beam(segments, printed):
    """At 145 km/h, in % of the beam limit; computed by two independent programs."""
    error = 100 * (felt(segments=segments, floor="polygon")[0] / felt(body="beam")[0] - 1)
    assert f"{error:+.{len(printed.partition('.')[2])}f}" == printed


@pytest.mark.parametrize(("segments", "within"), [(4, 0.01), (8, 0.002)])
def test_smooth_floors_are_the_beams_at_the_middle(segments, within):
    assert_allclose(felt(segments=segments), felt(body="beam"), rtol=within)


# Choosing


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"body": "plate"}, "kind: found 'plate'; expected one of rigid, segments, beam"),
        ({"body": "beam", "segments": 4}, "segments: found 4 with body beam"),
        ({"modes": 4}, "modes: found 4 of a body that is not made of them"),
        ({"body": "rigid", "segments": 2}, "segments: found 2 with body rigid"),
        ({"body": "beam", "modes": 0}, "modes: found 0; expected a whole number from 1"),
        ({"body": "beam", "modes": 2.5}, "modes: found 2.5; expected a whole number"),
        ({"body": "beam", "joint_stiffness": 3e8}, "joint_stiffness of 3e\\+08"),
    ],
)
def test_bodies_that_cannot_be_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        derive_vehicle("cati2024", **given)


def test_kinds_have_their_defaults():
    assert derive_vehicle("cati2024", body="segments").body.segments == 4
    assert derive_vehicle("cati2024", body="rigid").body.segments == 1
    assert derive_vehicle("cati2024", body="beam").body.mode_count == 10
    assert derive_vehicle("cati2024", body="beam").body.segments is None


# On the command line


def test_the_beam_on_the_command_line(run):
    code, out, _ = run("derive", "--body", "beam", "--modes", "3", "--format", "json")
    found = json.loads(out)
    assert (code, found["body"], found["segments"], found["body_modes"]) == (0, "beam", None, 3)
    assert found["joint_stiffness"] is None
    assert found["coordinates"][:5] == ["z_c", "theta_c", "eta_1", "eta_2", "eta_3"]
    assert_allclose(found["M"], beam(count=3).matrices().M, rtol=1e-12)
    code, out, _ = run("ride", "--body", "beam", "--spectral", "--format", "json")
    case = json.loads(out)["cases"][0]
    assert (case["body"], case["segments"], case["modes"]) == ("beam", None, 10)
    assert case["a_wrms"] == pytest.approx(felt(body="beam")[0], rel=1e-9)


def test_symbols_and_parameters_give_the_numbers(run):
    """Substituting ``parameters`` in ``symbolic``: shapes and frequencies are among them."""
    import sympy as sp

    _, out, _ = run("derive", "--body", "beam", "--modes", "2", "--format", "json")
    found = json.loads(out)
    for name in ("M", "C", "K", "K_w", "C_w"):
        for row, numbers in zip(found["symbolic"][name], found[name], strict=True):
            for text, number in zip(row, numbers, strict=True):
                names = {n: sp.Symbol(n) for n in found["parameters"]}
                value = sp.sympify(text, locals=names).subs(
                    {names[n]: v for n, v in found["parameters"].items()}
                )
                assert float(value) == pytest.approx(number, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--body", "beam", "--segments", "4"), "--segments: found --body beam with it"),
        (("--body", "beam", "--joint-stiffness", "3e8"), "--joint-stiffness: found --body beam"),
        (("--modes", "4"), "--modes: found no --body with it"),
        (("--body", "segments", "--modes", "4"), "--modes: found --body segments with it"),
        (("--body", "beam", "--modes", "many"), "--modes: found 'many'"),
        (("--body", "beam", "--vehicle", "manchester"), "found --body beam for a car body"),
    ],
)
def test_options_that_do_not_go_with_the_beam_are_refused(run, options, words):
    code, out, err = run("modes", *options)
    assert (code, out) == (2, "")
    assert words in err


@pytest.mark.parametrize("form", ["table", "markdown", "latex", "csv"])
def test_the_beams_derivation_is_written_in_every_form(run, form):
    code, out, _ = run("derive", "--body", "beam", "--modes", "2", "--format", form)
    assert code == 0
    assert "Pi" not in out
    if form == "markdown":
        assert "--body beam --modes 2" in out
