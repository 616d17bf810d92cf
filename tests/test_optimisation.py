"""Optimisation within limits: against grids, independent differences and other programs."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from vehicles import mirrored, paper_coach, random_vehicle

from railride import (
    InputError,
    derive_vehicle,
    load_vehicle,
    modes,
    optimise,
    output_statistics,
    spectrum,
    stochastic_ride,
    vehicle_with,
    weighting,
    write_vehicle,
)
from railride.designs.given import given_cases
from railride.optimisation import KINDS
from railride.optimisation.limits import limits_of
from railride.optimisation.measures import Measures
from railride.optimisation.search import MISSED, energies_of
from railride.optimisation.task import mode_labels, task_of
from railride.optimisation.variables import chosen_variables
from railride.sensitivities import Derivatives
from railride.stochastic.ride import floor_in_hand, weighted_rms_of_many
from railride.units import STANDARD_GRAVITY

PAPER = [145 / 3.6, 200 / 3.6]
SUSPENSION = {"k_2": (4e5, 12e5), "c_2": (2e4, 15e4), "c_1": (1e4, 1e5)}


def measures(model, parameters, kinds=(), speeds=PAPER, at=(0.0, 8.0)):
    cases = given_cases(model, "erri_low", speeds, at)
    return Measures(model, Derivatives(model, parameters), cases, frozenset(kinds))


def grid(model, changes, speeds, at):
    """a_wrms of many vehicles by the closed form: (vehicles, speeds, positions)."""
    m, rows = floor_in_hand(model, at, "smooth", changes)
    places = model.vehicle.wheelset_positions
    a, _ = weighted_rms_of_many(m, rows, places, speeds, spectrum("erri_low"), weighting("Wk"))
    return a


def rode(model, speeds=PAPER, at=(0.0,)):
    """a_wrms by the exact ride, speeds outer: (cases,)."""
    return np.concatenate([stochastic_ride(model, v, "erri_low", at).a_wrms for v in speeds])


def _ascending(x, y):
    return (x, y) if x[0] < x[-1] else (x[::-1], y[::-1])


def mean(values):
    return float(np.sqrt(np.mean(np.square(values))))


# Values and gradients of a design ------------------------------------------------------------


def test_values_are_those_of_the_programs_that_give_them_one_by_one():
    model = derive_vehicle("manchester", 1)
    kinds = {"secondary_travel", "primary_travel_rms", "wheel_load_variation", "damping_ratio",
             "secondary_static", "primary_static"}  # fmt: skip
    found = measures(model, ["c_2"], kinds).at({"c_2": 33e3})
    moved = model.changed(c_2=33e3)
    np.testing.assert_allclose(found["a_wrms"].value, rode(moved, at=(0.0, 8.0)), rtol=1e-9)
    tables = [output_statistics(moved, v, "erri_low").set_index("output") for v in PAPER]
    names = {"secondary_travel": ("secondary", "expected peak"),
             "primary_travel_rms": ("primary", "rms")}  # fmt: skip
    for kind, (start, column) in names.items():
        chosen = [t.loc[[n for n in t.index if n.startswith(start)], column] for t in tables]
        np.testing.assert_allclose(found[kind].value, np.concatenate(chosen), rtol=1e-9)
    loads = [t.loc[[n for n in t.index if n.startswith("wheel")], "rms"] for t in tables]
    body, bogie = model.vehicle.body, model.vehicle.bogies[0]
    weight = STANDARD_GRAVITY * (body.mass + 2 * bogie.mass + 4 * bogie.wheelset_mass) / 4
    variation = found["wheel_load_variation"].value
    np.testing.assert_allclose(variation, np.concatenate(loads) / weight, rtol=1e-9)
    pressed = STANDARD_GRAVITY * body.mass / 2 / bogie.secondary_stiffness
    np.testing.assert_allclose(found["secondary_static"].value, pressed, rtol=1e-9)
    for label in mode_labels(moved):
        least = min(mode.damping_ratio for mode in modes(moved) if mode.label == label)
        assert found["damping_ratio"].of_mode(label).value == pytest.approx([least], rel=1e-9)


@pytest.mark.parametrize("seed", [2, 7])
def test_gradients_are_those_of_richardsons_differences(seed):
    vehicle = random_vehicle(seed)
    bogies = tuple(replace(bogie, wheelset_mass=1500.0 + 100 * b)
                   for b, bogie in enumerate(vehicle.bogies))  # fmt: skip
    model = derive_vehicle(replace(vehicle, bogies=bogies), 2)
    kinds = set(KINDS)
    parameters = ["k_2_b1", "k_1_b1", "m_w_b1", "m_c"]
    made = measures(model, parameters, kinds, PAPER[1:], at=(1.0,))
    own = {name: float(model.values()[name]) for name in parameters}
    found = made.at(own)
    for k, name in enumerate(parameters):
        h = 2e-4 * abs(own[name])
        for kind, values in found.items():
            moved = {s: made.at({**own, name: own[name] + s * h})[kind].value
                     for s in (-2, -1, 1, 2)}  # fmt: skip
            slope = (8 * (moved[1] - moved[-1]) - (moved[2] - moved[-2])) / (12 * h)
            size = np.abs(values.value / own[name])
            within = {"rtol": 1e-6, "atol": 1e-7 * size.max()}
            np.testing.assert_allclose(values.gradient[:, k], slope, **within)


# Known optima --------------------------------------------------------------------------------


def test_one_parameter_is_found_where_a_fine_grid_has_it():
    model, c = derive_vehicle("ice3", 1), np.linspace(40e3, 46e3, 1201)
    a = grid(model, {"c_2": c}, PAPER, [0.0, 8.0]).reshape(c.size, -1)
    goal = np.sqrt(np.mean(a**2, axis=1))
    lowest = int(goal.argmin())
    around = slice(lowest - 300, lowest + 301)
    parabola = np.polynomial.Polynomial.fit(c[around], goal[around], 4)
    best = parabola.deriv().roots()
    best = float(min(best.real, key=lambda x: abs(x - c[lowest])))
    found = optimise(model, {"secondary_damping": (1e4, 1e5)}, PAPER, at=[0.0, 8.0])
    assert found.converged
    assert found.parameters == {"secondary_damping": pytest.approx(best, rel=2e-4)}
    assert found.a_wrms == pytest.approx(goal.min(), rel=1e-9)
    assert not any(change.at_bound for change in found.changes)


def test_weights_of_the_cases_count():
    model, c = derive_vehicle("ice3", 1), np.geomspace(1e4, 1e5, 2001)
    a = grid(model, {"c_2": c}, PAPER, [0.0, 8.0]).reshape(c.size, -1)
    weights = np.array([1.0, 0.0, 5.0, 0.5])
    goal = np.sqrt(a**2 @ weights / weights.sum())
    found = optimise(model, {"c_2": (1e4, 1e5)}, PAPER, at=[0.0, 8.0], weights=weights.tolist())
    assert found.parameters["c_2"] == pytest.approx(c[goal.argmin()], rel=2e-3)
    assert found.a_wrms == pytest.approx(goal.min(), rel=1e-6)


def test_the_worst_case_is_best_at_its_kink():
    model, c = derive_vehicle("manchester", 1), np.linspace(55e3, 70e3, 3001)
    speeds = [80 / 3.6, 95 / 3.6]
    a = grid(model, {"c_2": c}, speeds, [-10.0])[:, :, 0]
    found = optimise(model, {"c_2": (1e4, 2e5)}, speeds, at=-10.0, objective="worst")
    crossing = np.interp(0.0, *_ascending(a[:, 0] - a[:, 1], c))  # one falls, the other rises
    assert found.converged
    assert found.parameters["c_2"] == pytest.approx(crossing, rel=1e-6)
    assert found.cases_changed[0].after == pytest.approx(found.cases_changed[1].after, rel=1e-8)


def test_differential_evolution_finds_nothing_better():
    from scipy.optimize import differential_evolution

    model = derive_vehicle("ice3", 1)
    ranges = {"k_2": (3e5, 1e6), "c_2": (1e4, 1e5), "c_1": (5e3, 4e4)}
    least = {"heave": 0.25, "pitch": 0.2}

    def penalised(x):
        changes = dict(zip(ranges, np.exp(x), strict=True))
        moved = model.changed(**{name: float(value) for name, value in changes.items()})
        zeta = {mode.label: mode.damping_ratio for mode in modes(moved)}
        short = max(0.0, *(bound - zeta[label] for label, bound in least.items()))
        return mean(rode(moved)) + 10 * short

    bounds = np.log(list(ranges.values()))
    other = differential_evolution(penalised, bounds, seed=1, maxiter=25, popsize=8, tol=1e-10,
                                   polish=False)  # fmt: skip
    found = optimise(model, ranges, PAPER, limits={"damping_ratio": least})
    assert found.converged
    assert found.a_wrms <= other.fun * (1 + 1e-9)
    assert found.a_wrms == pytest.approx(other.fun, rel=2e-3)


# Limits --------------------------------------------------------------------------------------


def test_a_binding_limit_is_kept_and_is_worth_what_moving_it_gains():
    model, delta = paper_coach(2), 1e-3

    def best(travel, heave, static):
        limits = {"secondary_travel": travel, "damping_ratio": {"heave": heave},
                  "secondary_static": (None, static)}  # fmt: skip
        return optimise(model, SUSPENSION, PAPER, limits=limits)

    bounds = [0.012, 0.17, 0.24]
    found = best(*bounds)
    assert found.converged
    assert found.residual < 1e-6
    binding = [state.binds for state in found.limits]
    assert sum(binding) == 2  # two dampings and a stiffness, one of them at its bound
    for k, state in enumerate(found.limits):
        sign = 1 if state.limit.at_least else -1
        assert sign * (state.value / state.limit.bound - 1) > -1e-6
        moved = []
        for step in (-delta, delta):
            other = list(bounds)
            other[k] *= 1 + step
            moved.append(best(*other).a_wrms)
        slope = (moved[1] - moved[0]) / (2 * delta * bounds[k])
        assert state.worth == pytest.approx(slope, rel=1e-3, abs=1e-6 * found.a_wrms / bounds[k])


def test_the_optimality_conditions_hold_by_independent_differences():
    """Gradients of the ride and of its limits by differences; multipliers by least squares."""
    model = paper_coach(2)
    ranges = {"k_2": (4e5, 12e5), "c_2": (2e4, 15e4)}
    found = optimise(model, ranges, PAPER, limits={"secondary_travel": 0.010})
    at = dict(found.parameters)

    def felt(**changes):
        moved = model.changed(**changes)
        travel = output_statistics(moved, PAPER[1], "erri_low")["expected peak"][:4].max()
        return np.log([mean(rode(moved)), travel])

    def slope(name, h=1e-3):
        steps = [felt(**{**at, name: at[name] * np.exp(s * h)}) for s in (-1, 1)]
        return (steps[1] - steps[0]) / (2 * h)

    slopes = {name: slope(name) for name in ranges}
    free = [c.variable.name for c in found.changes if not c.at_bound]
    assert free == ["c_2"]
    (binding,) = found.limits
    multiplier = -slopes["c_2"][0] / slopes["c_2"][1]
    assert multiplier > 0
    assert binding.worth == pytest.approx(-multiplier * found.a_wrms / 0.010, rel=1e-4)
    bound = slopes["k_2"][0] + multiplier * slopes["k_2"][1]
    assert (bound > 0) == (found.changes[0].at_bound == "lower")


def test_limits_that_cannot_be_kept_are_named_with_the_least_they_are_missed_by():
    model = derive_vehicle("ice3", 1)
    c = np.geomspace(1e4, 1e5, 400)
    travels = [output_statistics(model, PAPER[1], "erri_low", ["secondary_2_deflection"],
                                 c_2=x)["expected peak"][0] for x in c]  # fmt: skip
    least = min(travels)
    limits = {"secondary_travel": least / 1.25, "secondary_static": (0.1, 0.4)}
    with pytest.raises(InputError) as raised:
        optimise(model, {"c_2": (1e4, 1e5)}, PAPER[1], limits=limits)
    text = str(raised.value)
    for word in (f"found {1e3 * least:.4g} mm at the best compromise", "200 km/h", "25.0",
                 f"at most {1e3 * least / 1.25:.4g} mm", "widen"):  # fmt: skip
        assert word in text
    assert "secondary_static" not in text


def test_a_limit_that_only_far_designs_keep_is_met():
    """The vehicle as it is misses both by far."""
    model = paper_coach(2)
    limits = {"damping_ratio": {"heave": 0.35}, "secondary_static": (0.19, 0.2)}
    found = optimise(model, SUSPENSION, PAPER, limits=limits)
    assert found.converged
    assert modes(found.model)[0].damping_ratio == pytest.approx(0.35, rel=1e-6)
    assert found.limits[0].before < found.limits[0].limit.bound


def test_wheel_loads_are_limited_where_the_wheelsets_masses_are_known():
    model = derive_vehicle("manchester", 1)
    ranges = {"k_1": (1.2e6, 5e6), "c_1": (2e3, 6e4)}
    free = optimise(model, ranges, PAPER, limits={"wheel_load_variation": 1.0})
    bound = 0.97 * free.limits[0].value
    found = optimise(model, ranges, PAPER, limits={"wheel_load_variation": bound})
    assert found.converged
    assert found.limits[0].binds
    assert found.a_wrms > free.a_wrms
    loads = output_statistics(found.model, PAPER[1], "erri_low").set_index("output")["rms"]
    body, bogie = model.vehicle.body, model.vehicle.bogies[0]
    weight = STANDARD_GRAVITY * (body.mass + 2 * bogie.mass + 4 * bogie.wheelset_mass) / 4
    largest = max(loads[name] for name in loads.index if name.startswith("wheel"))
    assert largest / weight == pytest.approx(bound, rel=1e-6)


# Vehicles ------------------------------------------------------------------------------------


def test_mirrored_vehicles_have_mirrored_limits():
    vehicle = random_vehicle(3)
    kinds = {"damping_ratio", "secondary_static"}
    one, other = derive_vehicle(vehicle, 2), derive_vehicle(mirrored(vehicle), 2)
    last = len(vehicle.bogies)
    found = measures(one, ["k_2_b1"], kinds).at({"k_2_b1": 5e5})
    turned = measures(other, [f"k_2_b{last}"], kinds).at({f"k_2_b{last}": 5e5})
    assert found["damping_ratio"].of == turned["damping_ratio"].of
    for kind, step in (("damping_ratio", 1), ("secondary_static", -1)):
        for part in ("value", "gradient"):
            a, b = (getattr(of[kind], part) for of in (found, turned))
            np.testing.assert_allclose(a, b[::step], rtol=1e-6, atol=1e-9 * np.abs(a).max())


@pytest.mark.parametrize("at", [[0.0], [3.0, -3.0]])
def test_a_beam_and_segments_lead_to_neighbouring_optima(at):
    ranges = {"k_2": (4e5, 12e5), "c_2": (2e4, 15e4)}
    limits = {"damping_ratio": {"heave": 0.15}}
    given = {"bending_damping": 0.015}
    beam = derive_vehicle("cati2024", body="beam", modes=3, **given)
    found = [optimise(model, ranges, PAPER, at=at, limits=limits)
             for model in (beam, derive_vehicle("cati2024", 8, **given))]  # fmt: skip
    assert all(one.converged for one in found)
    assert found[0].parameters == pytest.approx(found[1].parameters, rel=0.01)
    assert found[0].a_wrms == pytest.approx(found[1].a_wrms, rel=0.05)


def test_wheelsets_that_move_are_reached_by_the_track_where_they_are():
    """The wheelbase filters the bending mode: the optimum is the derived vehicle's own."""
    model = paper_coach(1)
    found = optimise(model, {"l_w": (1.0, 1.6), "l_b": (8.0, 9.5)}, PAPER)
    again = derive_vehicle(found.vehicle(), 1)
    assert mean(rode(again)) == pytest.approx(found.a_wrms, rel=1e-9)
    for name, step in (("l_w", 0.01), ("l_b", 0.05)):
        for sign in (-1, 1):
            value = found.parameters[name] + sign * step
            low, high = {"l_w": (1.0, 1.6), "l_b": (8.0, 9.5)}[name]
            if low <= value <= high:
                other = derive_vehicle(vehicle_with(found.model, **{name: value}), 1)
                assert mean(rode(other)) >= found.a_wrms * (1 - 1e-9)


def test_starts_find_the_better_of_two_valleys():
    model = paper_coach(2).changed(k_2=4e5, c_2=1e5)
    ranges = {"k_2": (4e5, 12e5), "c_2": (2e4, 2e5)}
    limits = {"secondary_travel": 0.008}
    one = optimise(model, ranges, PAPER[1], limits=limits)
    several = optimise(model, ranges, PAPER[1], limits=limits, starts=6)
    assert one.converged
    assert one.parameters["k_2"] == pytest.approx(4e5)
    assert several.parameters["k_2"] == pytest.approx(12e5)
    assert several.a_wrms < 0.98 * one.a_wrms
    assert any("other local optima are worse" in said for said in several.remarks)


def test_the_global_search_leaves_the_worse_valley_and_keeps_to_every_kind_of_limit():
    model = derive_vehicle("manchester", 1)
    ranges = {"k_1": (1.2e6, 5e6), "k_2": (4e5, 2e6), "c_2": (1e4, 2e5)}
    limits = {"secondary_travel": 0.01, "primary_travel_rms": 0.002, "wheel_load_variation": 0.05,
              "damping_ratio": {"heave": 0.2}, "secondary_static": (0.15, 0.3)}  # fmt: skip
    given = {"limits": limits, "objective": "worst"}
    found = optimise(model, ranges, PAPER, search="global", **given)
    several = optimise(model, ranges, PAPER, starts=4, **given)
    assert found.converged
    assert found.a_wrms == pytest.approx(several.a_wrms, rel=1e-6)
    assert any("differential evolution settled" in said for said in found.remarks)


def test_what_the_global_search_compares_is_what_the_gradient_method_has():
    """Limits missed count above every goal, by the worst of them; those kept not at all."""
    model = derive_vehicle("manchester", 1)
    ranges = {"k_1": (1.2e6, 5e6), "c_2": (1e4, 2e5)}
    limits = {"secondary_travel": 0.012, "primary_travel": 0.004, "wheel_load_variation": 0.045,
              "damping_ratio": {"heave": 0.15}, "primary_static": (0.02, 0.07)}  # fmt: skip
    problem = task_of(model, ranges, given_cases(model, "erri_low", PAPER), limits=limits).problem()
    u = np.array([[0.1, 0.5, 0.9, 0.3], [0.2, 0.6, 0.95, 0.7]])
    found = energies_of(problem, u)
    designs = [problem.evaluate(place) for place in u.T]
    missed = np.array([problem.violation(design) for design in designs])
    goals = np.log([problem.goal.value(design) for design in designs])
    np.testing.assert_allclose((found - MISSED)[missed > 0], missed[missed > 0], rtol=1e-8)
    np.testing.assert_allclose(found[missed == 0], goals[missed == 0], rtol=1e-8)
    assert 0 < np.count_nonzero(missed) < 4


# The result ----------------------------------------------------------------------------------


def test_the_parameter_file_reads_back_and_rides_the_same(tmp_path):
    found = optimise(paper_coach(2), SUSPENSION, PAPER, limits={"secondary_static": (0.1, 0.26)})
    write_vehicle(found.vehicle(), tmp_path / "best.toml")
    vehicle = load_vehicle(tmp_path / "best.toml")
    assert vehicle.bogies[0].secondary_stiffness == found.parameters["k_2"]
    assert "no longer of its source" in vehicle.remarks[-1]
    assert mean(rode(derive_vehicle(vehicle, 2))) == pytest.approx(found.a_wrms, rel=1e-9)
    assert found.error < 1e-9
    before = mean(rode(paper_coach(2)))
    assert found.a_wrms_before == pytest.approx(before, rel=1e-9)
    table = found.table()
    assert list(table["from"]) == [750e3, 70e3, 30e3]
    assert table["change"][0] == pytest.approx(found.parameters["k_2"] / 750e3 - 1)


def test_what_ends_on_a_bound_has_its_value_to_the_last_bit():
    ranges, limits = SUSPENSION | {"c_1": (1e4, 6e4)}, {"damping_ratio": {"heave": 0.15}}
    found = optimise(paper_coach(2), ranges, PAPER, limits=limits)
    assert [change.at_bound for change in found.changes] == ["lower", "", "upper"]
    assert found.parameters["k_2"] == 4e5
    assert found.parameters["c_1"] == 6e4


def test_what_ends_on_a_bound_or_changes_nothing_is_said():
    model = derive_vehicle("manchester", 1)
    ranges = {"k_2": (5e5, 8e5), "m_w": (1e3, 2e3)}
    found = optimise(model, ranges, PAPER)
    assert found.changes[0].at_bound == "lower"
    assert found.changes[0].worth < 0
    for said in ("k_2 ends at its lower bound", "is not in the range", "m_w changes nothing"):
        assert any(said in remark for remark in found.remarks)


def test_progress_goes_up_to_its_end():
    done = []
    optimise(paper_coach(1), {"c_2": (2e4, 1e5)}, PAPER, starts=3, progress=done.append)
    assert all(0 <= a <= b <= 1 for a, b in pairwise(done))
    assert len(done) > 3


# What is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"parameters": {}}, ["none", "at least one parameter"]),
        ({"parameters": {"secondary_stifness": (1, 2), "k_1": (2e6, 1e6)}},
         ["did you mean secondary_stiffness", "reversed range"]),
        ({"parameters": {"k_2": (4e5, 4e5)}}, ["an empty range"]),
        ({"parameters": {"k_2": (0.0, 4e5)}}, ["above 0"]),
        ({"parameters": {"k_2": 4e5}}, ["two finite numbers"]),
        ({"parameters": {"k_2": (4e5, 5e5), "secondary_stiffness": (4e5, 5e5)}}, ["k_2 again"]),
        ({"limits": {"secondary_travl": 0.01}}, ["did you mean secondary_travel"]),
        ({"limits": {"secondary_travel": -1.0}}, ["above 0 m"]),
        ({"limits": {"damping_ratio": {"heav": 0.1}}}, ["no such mode", "did you mean heave"]),
        ({"limits": {"damping_ratio": 1.5}}, ["a ratio below 1"]),
        ({"limits": {"secondary_static": (0.3, 0.2)}}, ["neither empty nor reversed"]),
        ({"limits": {"secondary_static": 0.3}}, ["two bounds"]),
        ({"limits": {"wheel_load_variation": 0.1}}, ["bogie.wheelset_mass"]),
        ({"objective": "least"}, ["one of mean, worst"]),
        ({"weights": [1.0]}, ["2 numbers"]),
        ({"weights": [1.0, 1.0], "objective": "worst"}, ["expected none"]),
        ({"search": "random"}, ["one of gradient, global"]),
        ({"starts": 0}, ["a whole number from 1"]),
        ({"distance": -5.0}, ["distance"]),
        ({"distance": 20.0, "limits": {"secondary_travel": 0.01}}, ["crosses", "longer distance"]),
        ({"speeds": []}, ["speeds"]),
        ({"speeds": None}, ["speeds: found None"]),
        ({"parameters": None}, ["found None", "lower and upper bound"]),
        ({"parameters": {"k_2": 3.0}}, ["k_2: found 3.0"]),
        ({"limits": 3}, ["limits", "found 3", "kind → bound"]),
        ({"weights": "x"}, ["weights: found 'x'"]),
        ({"track": 3}, ["tracks: found 3"]),
        ({"at": [13.0]}, ["off the body"]),
        ({"parameters": {"c_1": (0.0, 1e4), "c_2": (0.0, 1e4)}, "model": "undamped"},
         ["at c_1 = 0", "without damping"]),
    ],
)  # fmt: skip
def test_bad_input_is_told(arguments, words):
    given = {"parameters": {"k_2": (4e5, 12e5)}, "speeds": PAPER} | arguments
    model = paper_coach(1)
    if given.pop("model", None):
        model = model.changed(c_1=0.0, c_2=0.0)
    with pytest.raises(InputError) as raised:
        optimise(model, given.pop("parameters"), given.pop("speeds"), **given)
    for word in words:
        assert word in str(raised.value)


def test_variables_are_what_they_say():
    model = paper_coach(1)
    k, x = chosen_variables(model, {"secondary_stiffness": (4e5, 16e5), "c_2": (0.0, 1e5)})
    assert k.value(0.5) == pytest.approx(8e5)
    assert x.value(0.25) == 25e3
    for variable in (k, x):
        for u in (0.1, 0.7):
            slope = (variable.value(u + 1e-6) - variable.value(u - 1e-6)) / 2e-6
            assert variable.slope(u) == pytest.approx(slope, rel=1e-8)
            assert variable.place(variable.value(u)) == pytest.approx(u)


def test_limits_of_both_sides_are_two():
    model = paper_coach(1)
    found = limits_of(model, {"secondary_static": (0.1, 0.3), "damping_ratio": 0.1},
                      mode_labels(model))  # fmt: skip
    assert [(one.side, one.bound) for one in found] == [
        ("at least", 0.1), ("at most", 0.3), ("at least", 0.1),
    ]  # fmt: skip
