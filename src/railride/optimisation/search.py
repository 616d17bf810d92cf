r"""The global search: differential evolution over designs that are evaluated many at a time.

A population of designs is mixed and mutated over generations; one that keeps to the limits beats
every one that does not, of two that do the more comfortable, of two that do not the one that misses
the limits by less. It finds the valley; the gradient method goes down to its floor.

Source: R. Storn, K. Price, J. Global Optim. 11 (1997) 341-359; K. Deb, Comput. Methods Appl. Mech.
Engrg. 186 (2000) 311-338 (the comparison, Section 3).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from railride.designs import DesignValues, evaluate_designs
from railride.numeric import Array
from railride.optimisation.limits import Limit
from railride.optimisation.problem import Problem
from railride.optimisation.solve import Progress
from railride.units import STANDARD_GRAVITY
from railride.vehicle import VehicleModel

POPULATION = 12  # designs for every parameter
GENERATIONS = 80
SETTLED = 1e-3  # spread of the population's goals, ln a_wrms, at which it stops
MISSED, IMPOSSIBLE = 1e3, 1e6  # above every goal: limits missed; no values at all
RESULTS = {
    "secondary_travel": "travel",
    "primary_travel": "travel",
    "secondary_travel_rms": "travel",
    "primary_travel_rms": "travel",
    "damping_ratio": "modes",
    "secondary_static": "static",
    "primary_static": "static",
    "wheel_load_variation": "wheel_loads",
}


def searched(problem: Problem, seed: int, progress: Progress | None = None) -> tuple[Array, str]:
    """The best place that differential evolution finds, u (P,), and a remark on the search.

    Expected peaks are those over a kilometre here, whatever the distance of the problem is.

    problem : with the limits. seed : of the population. progress : called with the fraction done.
    """
    from scipy.optimize import differential_evolution

    generation, count = 0, 0

    def energies(u: Array) -> Array:
        nonlocal count
        count += u.shape[1]
        return energies_of(problem, u)

    def advance(*_: object, **__: object) -> None:
        nonlocal generation
        generation += 1
        if progress is not None:
            progress(min(generation / GENERATIONS, 1.0))

    found = differential_evolution(
        energies, [(0.0, 1.0)] * problem.size, vectorized=True, updating="deferred", init="sobol",
        popsize=POPULATION, maxiter=GENERATIONS, tol=0.0, atol=SETTLED, rng=seed, polish=False,
        callback=advance,
    )  # fmt: skip
    how = "settled" if found.success else "was ended, unsettled,"
    said = f"differential evolution {how} after {count} designs in {found.nit} generations"
    return np.asarray(found.x), said


def energies_of(problem: Problem, u: Array) -> Array:
    """What is to be least, of designs at u (P, D): ln g, or above it where limits are missed."""
    measures = problem.evaluate.measures
    designs = {
        v.symbol: np.array([v.value(x) for x in row])
        for v, row in zip(problem.evaluate.variables, u.tolist(), strict=True)
    }
    results = {"a_wrms"} | {RESULTS[limit.kind] for limit in problem.limits}
    if "wheel_loads" in results:
        results.add("static")
    cases = measures.cases
    found = evaluate_designs(measures.model, designs, list(cases.tracks), cases.speeds,
                             cases.positions, floor=cases.floor, weight=cases.weight,
                             results=sorted(results))  # fmt: skip
    goal = _goals(problem, found)
    missed = np.zeros_like(goal)
    for limit in problem.limits:
        value = _limited(limit, found, measures.model, designs)
        off = value / limit.bound - 1
        missed = np.maximum(missed, -off if limit.at_least else off)
    energy = np.where(missed > 0, MISSED + missed, np.log(goal))
    return np.where(np.isfinite(energy), energy, IMPOSSIBLE)


def _goals(problem: Problem, found: DesignValues) -> Array:
    a = _known(found.a_wrms).reshape(len(found), -1)
    if problem.goal.how == "worst":
        return np.asarray(a.max(axis=1))
    return np.asarray(np.sqrt(np.average(a**2, axis=1, weights=problem.goal.weights)))


def _limited(
    limit: Limit, found: DesignValues, model: VehicleModel, designs: Mapping[str, Array]
) -> Array:
    """The value of every design that comes nearest to a limit: (D,)."""
    level = limit.kind.partition("_")[0]
    chosen = [k for k, name in enumerate(found.suspensions) if name.startswith(level)]
    if limit.kind == "damping_ratio":
        labels = [name.partition(",")[0] for name in found.modes]
        chosen = [k for k, label in enumerate(labels) if limit.mode in ("", label)]
        values = _known(found.damping_ratio)[:, chosen]
    elif limit.kind.endswith("static"):
        values = -_known(found.static_deflection)[:, chosen]
    elif limit.kind == "wheel_load_variation":
        loads = _known(found.load_rms)
        values = loads / _static_loads(found, model, designs)[:, np.newaxis, np.newaxis]
    else:
        travel = found.travel_rms if limit.kind.endswith("rms") else found.travel_peak
        values = _known(travel)[..., chosen]
    values = values.reshape(len(found), -1)
    return np.asarray(values.min(axis=1) if limit.at_least else values.max(axis=1))


def _static_loads(found: DesignValues, model: VehicleModel, designs: Mapping[str, Array]) -> Array:
    """Q_0 of every wheelset of every design: (D, wheelsets)."""
    gear, values = model.running_gear, model.values(**designs)
    primary = [k for k, name in enumerate(found.suspensions) if name.startswith("primary")]
    pressed = -_known(found.static_deflection)[:, primary]
    loads = np.zeros_like(pressed)
    for b in gear.bogies:
        k_1, m_w = (values[gear.symbol(name, b).name]
                    for name in ("primary_stiffness", "wheelset_mass"))  # fmt: skip
        for j, _ in gear.levers(b):
            loads[:, j - 1] = m_w * STANDARD_GRAVITY + k_1 * pressed[:, j - 1]
    return loads


def _known(values: Any) -> Array:
    """Values that were asked for."""
    return np.asarray(values, dtype=float)
