"""Exact derivatives, against Richardson's differences of values found in another way."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq
from vehicles import paper_coach, random_model

from railride.bodies import slender_beam
from railride.errors import InputError
from railride.firstorder import first_order
from railride.modal import modes
from railride.parameters import Equipment, Load, load_vehicle
from railride.sensitivities import (
    Derivatives,
    mean_squares_with_gradient,
    roots_with_gradient,
    sensitivity,
    static_deflections_with_gradient,
)
from railride.spectra import spectrum
from railride.stochastic import process, stochastic_ride
from railride.stochastic.extremes import low_pass
from railride.stochastic.gains import PLAIN, weighted
from railride.stochastic.ride import floor_in_hand
from railride.stochastic.squares import mean_squares
from railride.vehicle import derive_vehicle
from railride.weightings import weighting

KMH = 1 / 3.6
LOW = spectrum("erri_low")
W_K = weighted(weighting("Wk"))


def richardson(f, x, step):
    """df/dx, of sixth order, from central differences with steps h, h/2 and h/4 (Richardson)."""
    table = [(f(x + h) - f(x - h)) / (2 * h) for h in (step, step / 2, step / 4)]
    for order in (4, 16):
        table = [(order * b - a) / (order - 1) for a, b in itertools.pairwise(table)]
    return table[0]


def along(f, derivatives, name, **changes):
    """df/dp of a function of the changed values, by differences of relative step 2e-3."""
    here = float(derivatives.model.values(**changes)[name])
    return richardson(lambda x: f(**{**changes, name: x}), here, 2e-3 * abs(here) or 1e-3)


def closed_form(model, speed, gain, in_hand_at, **changes):
    """Mean squares of outputs by residues: no quadrature over the band, and no adjoint."""
    m, rows = in_hand_at(changes)
    places = wheelset_places(model, model.values(**changes))
    squares, errors = mean_squares(m, rows, places, [speed], LOW, (gain,))
    assert errors.max() < 1e-9
    return squares[0, 0, 0]


def wheelset_places(model, values):
    """Bogies' positions and wheelsets' on them, put together by hand."""
    found = []
    for b, bogie in enumerate(model.vehicle.bogies, start=1):
        for j, place in enumerate(bogie.wheelsets, start=1):
            at = _place(values, bogie.position, "l_b", f"x_b{b}")
            own = f"_b{b}" if f"l_w_b{b}" in values or f"x_w{j}_b{b}" in values else ""
            mirrored = next((k for k in (f"l_w{own}", f"l_w1{own}") if k in values), "")
            found.append(at + _place(values, place, mirrored, f"x_w{j}{own}"))
    return found


def _place(values, here, mirrored, single):
    if here == 0:
        return 0.0
    if single in values:
        return float(values[single])
    return np.copysign(float(values[mirrored]), here)


def heavy_coach():
    """Payload all along and in a point, equipment on mounts, dampers on elastic mounts, damped."""
    coach = load_vehicle("cati2024")
    bogies = tuple(replace(b, secondary_damper_stiffness=5e6, primary_damper_stiffness=k)
                   for b, k in zip(coach.bogies, (8e6, 9e6), strict=True))  # fmt: skip
    return replace(
        coach,
        body=replace(coach.body, bending_damping=0.012),
        bogies=bogies,
        payload=(Load(6e3), Load(800.0, front=3.0, rear=3.0)),
        equipment=(Equipment(mass=2500.0, position=1.5, frequency=7.0, damping_ratio=0.08),),
    )


@cache
def model_of(kind):
    heavy = heavy_coach()
    plain = replace(heavy, bogies=load_vehicle("cati2024").bogies)
    return {
        "rigid": lambda: paper_coach(1),
        "N = 2": lambda: paper_coach(2, bending_damping=0.01),
        "N = 4": lambda: paper_coach(4, bending_damping=0.01),
        "joint stiffness": lambda: derive_vehicle("cati2024", 3, joint_stiffness=4e8,
                                                  bending_damping=0.01),
        "beam": lambda: derive_vehicle("cati2024", body="beam", modes=3, bending_damping=0.01),
        "unsymmetrical": lambda: random_model(0, 4),
        "Maxwell": lambda: derive_vehicle(heavy, 2),
        "loaded": lambda: derive_vehicle(plain, 4),
        "loaded beam": lambda: derive_vehicle(plain, body="beam", modes=2),
        "shearing beam": lambda: derive_vehicle(bent(shear_stiffness=6e8, rotary_inertia=2e3),
                                                body="beam", modes=2),
        "finite elements": lambda: derive_vehicle("cati2024", body="fe", modes=2,
                                                  bending_damping=0.01),
        "two frequencies": lambda: derive_vehicle(
            bent(bending_frequency=None, bending_frequencies=(9.6, 25.0)), 4),
        "bending stiffness": lambda: derive_vehicle(
            bent(bending_frequency=None, bending_stiffness=1.4e9), 4),
    }[kind]()  # fmt: skip


def bent(**body):
    """The paper's coach with another car body, structurally damped."""
    coach = load_vehicle("cati2024")
    return replace(coach, body=replace(coach.body, bending_damping=0.01, **body))


@pytest.mark.parametrize(
    ("kind", "kmh"),
    [("rigid", 200), ("N = 2", 145), ("N = 4", 145), ("N = 4", 200), ("joint stiffness", 200),
     ("beam", 200), ("unsymmetrical", 145), ("Maxwell", 145), ("loaded", 200),
     ("loaded beam", 145), ("shearing beam", 200), ("finite elements", 200),
     ("two frequencies", 145), ("bending stiffness", 145)],
)  # fmt: skip
def test_gradient_of_the_weighted_mean_square(kind, kmh):
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    at = [0.0, 5.0]
    J, dJ = mean_squares_with_gradient(here, here.floor(at), kmh * KMH, LOW, (W_K,))

    def value(**changes):
        return closed_form(model, kmh * KMH, W_K, lambda c: floor_in_hand(model, at, "smooth", c),
                           **changes)  # fmt: skip

    np.testing.assert_allclose(J[0, 0], value(), rtol=1e-9)
    for k, name in enumerate(derivatives.parameters):
        scale = J[0, 0] / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(dJ[0, 0, :, k] / scale, along(value, derivatives, name) / scale,
                                   rtol=1e-7, atol=2e-8, err_msg=name)  # fmt: skip


def eigenvalues_near(model, roots, **changes):
    """The eigenvalue of changed values nearest to each."""
    A = first_order(model.matrices(**changes)).A
    found = np.linalg.eigvals(A)
    return found[np.abs(found - np.asarray(roots)[:, np.newaxis]).argmin(axis=1)]


@pytest.mark.parametrize("kind", ["rigid", "N = 4", "joint stiffness", "beam", "unsymmetrical",
                                  "Maxwell", "loaded"])  # fmt: skip
def test_gradient_of_the_eigenvalues(kind):
    """Repeated ones too: a symmetric coach's parameters move both of its bogies alike."""
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    found = roots_with_gradient(here)
    assert found.names == tuple(", ".join(filter(None, (m.label, m.phase))) for m in modes(model))
    roots = found.eigenvalues
    for k, name in enumerate(derivatives.parameters):
        scale = np.abs(roots) / (abs(float(here.values[name])) or 1.0)
        expected = along(lambda **c: eigenvalues_near(model, roots, **c), derivatives, name)
        np.testing.assert_allclose(found.slopes[:, k] / scale, expected / scale, rtol=1e-7,
                                   atol=3e-9, err_msg=name)  # fmt: skip
        f = along(lambda **c: np.abs(eigenvalues_near(model, roots, **c)) / (2 * np.pi),
                  derivatives, name)  # fmt: skip
        np.testing.assert_allclose(found.frequency_slopes[:, k] / scale, f / scale, rtol=1e-7,
                                   atol=3e-9)  # fmt: skip
        zeta = along(lambda **c: _damping(eigenvalues_near(model, roots, **c)), derivatives, name)
        scale = 1 / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(found.damping_slopes[:, k] / scale, zeta / scale, rtol=1e-7,
                                   atol=3e-9)  # fmt: skip


def _damping(roots):
    return -roots.real / np.abs(roots)


def test_two_equal_bogies_pitch_as_one_alone_does():
    """I_b θ̈ + 2 l_w² c_1 θ̇ + 2 l_w² k_1 θ = 0, twice: 14.07 Hz."""
    derivatives = Derivatives(paper_coach(1))
    found = roots_with_gradient(derivatives.at())
    pitch = [k for k, name in enumerate(found.names) if name.startswith("bogie pitch")]
    np.testing.assert_allclose(found.frequencies[pitch], 14.0674, atol=5e-5)
    f, zeta = found.frequencies[pitch[0]], 1.25**2 * 30e3 / np.sqrt(2e3 * 2 * 1.25**2 * 5e6)
    np.testing.assert_allclose(found.damping_ratios[pitch], zeta, rtol=1e-12)
    by_hand = {  # d ln f/d ln p, d ln ζ/d ln p
        "k_1": (0.5, -0.5), "c_1": (0.0, 1.0), "I_b": (-0.5, -0.5), "l_w": (1.0, 1.0),
        "m_b": (0.0, 0.0), "k_2": (0.0, 0.0), "l_b": (0.0, 0.0),
    }  # fmt: skip
    values = derivatives.at().values
    for name, (of_f, of_zeta) in by_hand.items():
        k = derivatives.parameters.index(name)
        p = float(values[name])
        np.testing.assert_allclose(found.frequency_slopes[pitch, k] * p / f, of_f, atol=1e-9)
        np.testing.assert_allclose(found.damping_slopes[pitch, k] * p / zeta, of_zeta, atol=1e-9)


def test_a_repeated_eigenvalue_splits_as_one_bogie_alone_is_changed():
    """Of two bogies made equal, one pitches faster with its own stiffness, the other stays."""
    coach = load_vehicle("cati2024")
    first, second = coach.bogies
    unequal = replace(coach, bogies=(replace(first, primary_stiffness=5.1e6), second))
    model = derive_vehicle(unequal, 1)
    found = roots_with_gradient(Derivatives(model, ["k_1_b1"]).at(k_1_b1=5e6))
    pitch = [k for k, name in enumerate(found.names) if name.startswith("bogie pitch")]
    relative = found.frequency_slopes[pitch, 0] * 5e6 / found.frequencies[pitch]
    np.testing.assert_allclose(relative, [0.0, 0.5], atol=1e-9)


def test_static_deflections_of_a_rigid_coach_by_hand():
    """s = -m_c g/2k_2 and p = -(m_c/2 + m_b) g/2k_1."""
    derivatives = Derivatives(paper_coach(1), ["m_c", "m_b", "k_1", "k_2", "c_2", "l_b"])
    found, slopes = static_deflections_with_gradient(derivatives.at())
    s, p = -34e3 * 9.80665 / 1.5e6, -20e3 * 9.80665 / 1e7
    assert list(found)[:3] == ["secondary_1_deflection", "primary_1_deflection",
                               "primary_2_deflection"]  # fmt: skip
    np.testing.assert_allclose(list(found.values()), [s, p, p] * 2, rtol=1e-12)
    of_s = [s / 34e3, 0.0, 0.0, -s / 750e3, 0.0, 0.0]
    of_p = [p / 40e3, p / 20e3, -p / 5e6, 0.0, 0.0, 0.0]
    np.testing.assert_allclose(slopes, [of_s, of_p, of_p] * 2, rtol=1e-10, atol=1e-15)


@pytest.mark.parametrize("kind", ["N = 4", "unsymmetrical", "Maxwell", "loaded beam"])
def test_static_deflections_carry_the_weight_and_have_its_gradient(kind):
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    found, slopes = static_deflections_with_gradient(here)
    gear, names = model.running_gear, list(found)
    springs = {f"secondary_{b}_deflection": gear.symbol("secondary_stiffness", b).name
               for b in gear.bogies}  # fmt: skip
    carried = sum(-float(here.values[k]) * found[name] for name, k in springs.items())
    on_wheels = sum(-float(here.values[gear.symbol("primary_stiffness", b).name])
                    * found[f"primary_{j}_deflection"]
                    for b in gear.bogies for j, _ in gear.levers(b))  # fmt: skip
    bogies = sum(bogie.mass for bogie in model.vehicle.bogies)
    assert on_wheels - carried == pytest.approx(9.80665 * bogies, rel=1e-9)
    load = sum(one.mass for one in (*model.vehicle.payload, *model.vehicle.equipment))
    assert carried == pytest.approx(9.80665 * (model.vehicle.body.mass + load), rel=1e-9)

    def at_rest(**changes):
        m = model.matrices(**changes)
        rows = model.output_rows([model.outputs[name] for name in names], **changes)
        return rows["d"] @ np.linalg.solve(m.K, -9.80665 * m.M @ m.lift)

    for k, name in enumerate(derivatives.parameters):
        scale = np.max(np.abs(list(found.values()))) / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(slopes[:, k] / scale, along(at_rest, derivatives, name) / scale,
                                   rtol=1e-7, atol=1e-9, err_msg=name)  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "gain", "chosen"),
    [("N = 4", PLAIN, ["secondary_1_deflection", "primary_2_deflection"]),
     ("Maxwell", W_K, ["bogie_2_acceleration", "equipment_1_acceleration"]),
     ("wheels", low_pass(20.0), ["wheel_load_1", "wheel_load_4"]),
     ("Maxwell wheels", low_pass(20.0), ["wheel_load_2"])],
    ids=["travel", "accelerations", "wheel loads", "wheel loads, Maxwell"],
)  # fmt: skip
def test_gradient_of_other_outputs(kind, gain, chosen):
    """What feels the track at once, by w, ẇ and ẅ, too; the values by quadrature alone."""
    if kind.endswith("wheels"):
        coach = heavy_coach() if "Maxwell" in kind else load_vehicle("cati2024")
        bogies = tuple(replace(b, wheelset_mass=1500.0) for b in coach.bogies)
        model = derive_vehicle(replace(coach, bogies=bogies), 2, bending_damping=0.01)
    else:
        model = model_of(kind)
    outputs = [model.outputs[name] for name in chosen]
    own = [p.symbol.name for p in model.parameters]
    derivatives = Derivatives(model, own)
    here = derivatives.at()
    J, dJ = mean_squares_with_gradient(here, here.rows(outputs), 40.0, LOW, (PLAIN, gain))

    def value(**changes):
        m, rows = model.matrices(**changes), model.output_rows(outputs, **changes)
        places = wheelset_places(model, model.values(**changes))
        return process(m, rows, places, 40.0, LOW, (PLAIN, gain)).integrals().mean_square

    np.testing.assert_allclose(J[0], value(), rtol=1e-12)
    for k, name in enumerate(own):
        scale = J[0] / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(dJ[0, :, :, k] / scale, along(value, derivatives, name) / scale,
                                   rtol=1e-7, atol=2e-8, err_msg=name)  # fmt: skip


def test_cut_panels_change_nothing_but_the_last_digits():
    here = Derivatives(model_of("N = 4")).at()
    (J, dJ), (there, dthere) = (
        mean_squares_with_gradient(here, here.floor([0.0, 5.0]), [40.0, 50.0], LOW, (W_K,),
                                   refined=k) for k in (1, 3)
    )  # fmt: skip
    np.testing.assert_allclose(J, there, rtol=1e-10)
    np.testing.assert_allclose(dJ, dthere, rtol=1e-8, atol=1e-10 * np.abs(dJ).max())


def test_what_is_held():
    """The bending frequency where it calibrates the body, or the joints' stiffness if given.

    Being among the parameters gives it.
    """
    for kind, held in (("rigid", ""), ("N = 4", "bending frequency"), ("beam", "bending frequency"),
                       ("joint stiffness", "joint stiffness"),
                       ("two frequencies", "bending frequencies"),
                       ("finite elements", "bending frequencies"),
                       ("bending stiffness", "bending stiffness")):  # fmt: skip
        assert Derivatives(model_of(kind), ["m_c"]).at().held == held, kind
    model = model_of("N = 4")
    k_theta = float(model.values()["k_theta"])
    follows = Derivatives(model, ["m_c"]).at()
    given = Derivatives(model, ["m_c"]).at(k_theta=k_theta)
    among = Derivatives(model, ["m_c", "joint_stiffness"]).at()
    overridden = Derivatives(model.changed(k_theta=k_theta), ["m_c"]).at()
    assert follows.slopes["k_theta"] == pytest.approx(k_theta / 34e3, rel=1e-12)
    for held in (given, among, overridden):
        assert held.held == "joint stiffness"
        assert held.slopes["k_theta"][0] == 0
        np.testing.assert_allclose(held.dm["K"][0], 0, atol=1e-9)
    assert among.slopes["k_theta"].tolist() == [0, 1]
    assert follows.by_differences == ()
    assert Derivatives(model_of("two frequencies")).at().by_differences != ()


def test_derivatives_at_the_end_of_a_beam_keep_to_the_side_that_there_is():
    """A shorter beam has no floor at 12 m: differences of Timoshenko's shapes go one way."""
    model = model_of("shearing beam")
    rows = Derivatives(model, ["L", "l_b"]).at().floor([12.0])
    longer = [model.output_rows([model.floor(12.0, derivative=0)], L=24.0 + h)["d"]
              for h in np.arange(5) * 1e-3]  # fmt: skip
    slope = np.array([-25 / 12, 4, -3, 4 / 3, -1 / 4]) @ np.array(longer)[:, 0] / 1e-3
    np.testing.assert_allclose(rows.slopes["a"][0, 0], slope, rtol=1e-6, atol=1e-9)
    assert rows.by_differences


def test_parameters_that_cannot_change_are_left_out_or_refused():
    model = model_of("finite elements")
    assert "r_c" not in Derivatives(model).parameters
    with pytest.raises(InputError, match="found another radius of gyration"):
        Derivatives(model, ["m_c", "r_c"])


@pytest.mark.parametrize(
    ("parameters", "message"),
    [(["k_3"], "found 'k_3'.*did you mean"), (["k_2", "secondary_stiffness"], "found k_2 twice"),
     ([], "found none"), (3, "parameters: found 3"), ([3], "found '?3")],
)  # fmt: skip
def test_wrong_parameters(parameters, message):
    with pytest.raises(InputError, match=message):
        Derivatives(paper_coach(1), parameters)


def test_one_vehicle_and_some_speed_at_a_time():
    derivatives = Derivatives(paper_coach(1), ["k_2"])
    with pytest.raises(InputError, match="found arrays"):
        derivatives.at(c_2=[1e4, 2e4])
    here = derivatives.at()
    with pytest.raises(InputError, match="speeds: found none"):
        mean_squares_with_gradient(here, here.floor([0.0]), [], LOW)


def test_an_undamped_mode_that_is_felt_is_refused():
    here = Derivatives(paper_coach(1), ["k_2"]).at(c_2=0.0, c_1=0.0)
    with pytest.raises(InputError, match="without damping"):
        mean_squares_with_gradient(here, here.floor([0.0]), 40.0, LOW)


def test_an_undamped_mode_that_a_change_would_wake_is_refused():
    """Bogies at the nodes of bending 2 do not excite it: 4 m off the middle it has no part yet."""
    node = brentq(lambda x: float(slender_beam.shapes(2, x / 24)[1]), 8.0, 10.0, xtol=1e-14)
    model = derive_vehicle("cati2024", body="beam", modes=2)
    here = Derivatives(model, ["k_2", "l_b"]).at(l_b=node)
    middle, _ = mean_squares_with_gradient(here, here.floor([0.0]), 40.0, LOW)
    assert middle > 0
    with pytest.raises(InputError, match="as soon as l_b changes"):
        mean_squares_with_gradient(here, here.floor([4.0]), 40.0, LOW)
    still = Derivatives(model, ["k_2"]).at(l_b=node)
    J, dJ = mean_squares_with_gradient(still, still.floor([4.0]), 40.0, LOW)
    assert np.isfinite(dJ / J).all()


def test_critical_damping_has_no_derivative():
    """2 l_w² c_1 = 2 √(2 l_w² k_1 I_b) in the bogies' pitch: the eigenvalues leave with a root."""
    c_1 = np.sqrt(2 * 1.25**2 * 5e6 * 2e3) / 1.25**2
    found = roots_with_gradient(Derivatives(paper_coach(1), ["c_1", "k_2"]).at(c_1=c_1))
    lost = np.isnan(found.slopes).all(axis=1)
    assert lost.sum() >= 1
    assert {name.split(",")[0] for name, is_lost in zip(found.names, lost, strict=True)
            if is_lost} == {"bogie pitch"}  # fmt: skip
    assert np.isfinite(found.slopes[~lost]).all()


def test_sensitivities_beside_rides_of_changed_vehicles():
    model = model_of("N = 2")
    found = sensitivity(model, [40.0, 50.0], "erri_low", [0.0, 4.0], change=0.05)
    assert found.a_wrms.shape == (2, 2)
    names = [p.symbol.name for p in found.parameters]
    for i, speed in enumerate(found.speeds):
        ride = stochastic_ride(model, speed, "erri_low", [0.0, 4.0])
        np.testing.assert_allclose(found.a_wrms[i], ride.a_wrms, rtol=1e-9)
        for name, share in (("k_1", 1.05), ("m_c", 0.95)):
            p = float(model.values()[name]) * share
            changed = stochastic_ride(model, speed, "erri_low", [0.0, 4.0], **{name: p}).a_wrms
            np.testing.assert_allclose(found.changed[i, :, names.index(name), int(share > 1)],
                                       changed, rtol=1e-9)  # fmt: skip
    l_w = names.index("l_w")  # moves the wheelsets, and so their delays
    m, rows = floor_in_hand(model, [0.0], "smooth", {"l_w": 1.05 * 1.25})
    places = wheelset_places(model, model.values(l_w=1.05 * 1.25))
    square, _ = mean_squares(m, rows, places, [40.0], LOW, (W_K,))
    assert found.changed[0, 0, l_w, 1] == pytest.approx(np.sqrt(square[0, 0, 0, 0]), rel=1e-9)


def test_gradients_are_the_limit_of_small_changes():
    found = sensitivity(model_of("N = 2"), 50.0, "erri_low", change=1e-4)
    middle = (found.effects[..., 1] - found.effects[..., 0]) / 2
    np.testing.assert_allclose(middle, found.linear_effects[..., 1], rtol=1e-4, atol=1e-8)
    table = found.table()
    assert len(table) == len(found.parameters)
    k_2 = table.set_index("symbol").loc["k_2"]
    assert k_2["relative"] == pytest.approx(k_2["gradient"] * k_2["value"] / k_2["a_wrms [m/s^2]"])
    modes_of = found.mode_table()
    assert len(modes_of) == len(found.parameters) * len(found.roots.modes)


def test_what_a_change_makes_impossible_is_told_and_the_others_have_values():
    """A beam 10 % shorter has no bogies 11 m from its middle."""
    coach = load_vehicle("cati2024")
    long = replace(coach, bogies=tuple(replace(b, position=np.copysign(11.0, b.position))
                                       for b in coach.bogies))  # fmt: skip
    found = sensitivity(derive_vehicle(long, body="beam", modes=1, bending_damping=0.01), 40.0,
                        "erri_low", parameters=["L", "k_2"])  # fmt: skip
    assert np.isnan(found.changed[0, 0]).tolist() == [[True, False], [False, False]]
    assert any(said.startswith("L -10 %: no value: bogie 1") for said in found.remarks)


def test_remarks_of_sensitivities():
    coach = load_vehicle("cati2024")
    front, rear = coach.bogies
    hinged = replace(coach, bogies=(replace(front, position=6.0), rear))
    found = sensitivity(derive_vehicle(hinged, 4), 40.0, "erri_low",
                        parameters=["x_b1", "zeta_bending"])  # fmt: skip
    said = "\n".join(found.remarks)
    assert "bogie 1 stands at a hinge" in said
    assert "zeta_bending is 0" in said
    both = derive_vehicle(replace(hinged, bogies=(hinged.bogies[0], replace(rear, position=-6.0))),
                          4)  # fmt: skip
    found = sensitivity(both, 40.0, "erri_low")
    assert "l_b" not in [p.symbol.name for p in found.parameters]
    assert any(said.startswith("l_b is left out: bogie") for said in found.remarks)
    shearing = sensitivity(model_of("shearing beam"), 40.0, "erri_low", parameters=["m_c"])
    assert "by differences of eighth order" in "\n".join(shearing.remarks)


@pytest.mark.parametrize("change", [0.0, -0.1, 1.0, float("nan"), "a"])
def test_wrong_changes(change):
    with pytest.raises(InputError, match="change: found"):
        sensitivity(paper_coach(1), 40.0, "erri_low", change=change)
