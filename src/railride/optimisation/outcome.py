"""From a solved problem to what a reader wants to know of it."""

from __future__ import annotations

import numpy as np

from railride.optimisation.cases import cases_named
from railride.optimisation.descent import CONVERGED, Descent
from railride.optimisation.measures import COMFORT
from railride.optimisation.optimum import CaseChange, Change, LimitState, Optimum
from railride.optimisation.problem import Design, Problem, worst_of
from railride.optimisation.solve import Solved
from railride.stochastic.ride import STATED

BINDS = 1e-6  # multiplier: a limit that is worth less to the goal does not hold it
BENDING = ("f_", "EI", "k_theta", "c_theta", "zeta_", "alpha_R", "beta_R")  # what is held, or damps
NO_EFFECT = 1e-12  # relative change of everything over a parameter's whole range


def outcome(problem: Problem, solved: Solved, own: Design | None) -> Optimum:
    """The optimum of a problem beside the vehicle as it is; None where that has no ride."""
    best, measures = solved.best, problem.evaluate.measures
    exact, errors = measures.exact(dict(best.design.parameters))
    remarks = [
        *measures.model.vehicle.remarks, *measures.model.remarks, *measures.cases.remarks,
        *solved.remarks, *_doubts(best, exact, errors), *_notes(problem, best, own),
    ]  # fmt: skip
    return Optimum(
        model=measures.model.changed(**best.design.parameters),
        cases=measures.cases,
        objective=problem.goal.how,
        a_wrms=best.goal,
        a_wrms_before=None if own is None else problem.goal.value(own),
        changes=_changes(problem, best),
        cases_changed=_cases(problem, best, own),
        limits=_limits(problem, best, own),
        residual=best.residual,
        converged=best.converged,
        error=float(errors.max()),
        iterations=solved.iterations,
        evaluations=problem.evaluate.count,
        remarks=tuple(dict.fromkeys(remarks)),
    )


def _changes(problem: Problem, best: Descent) -> tuple[Change, ...]:
    found = []
    for k, variable in enumerate(problem.evaluate.variables):
        u, value = float(best.design.u[k]), best.design.parameters[variable.symbol]
        step = 0.01 * abs(value) / variable.slope(u)
        found.append(Change(variable, value, u, -abs(float(best.at_bounds[k])) * step))
    return tuple(found)


def _cases(problem: Problem, best: Descent, own: Design | None) -> tuple[CaseChange, ...]:
    after = best.design.values[COMFORT].value.tolist()
    before = [None] * len(after) if own is None else own.values[COMFORT].value.tolist()
    named = cases_named(problem.evaluate.measures.cases)
    return tuple(CaseChange(*case, *values)
                 for case, *values in zip(named, before, after, strict=True))  # fmt: skip


def _limits(problem: Problem, best: Descent, own: Design | None) -> tuple[LimitState, ...]:
    found = []
    for limit, members in zip(problem.limits, problem.members(best.design), strict=True):
        value, of = worst_of(limit, best.design)
        multiplier = float(best.multipliers[members].sum())
        sign = 1.0 if limit.at_least else -1.0
        found.append(
            LimitState(limit, None if own is None else worst_of(limit, own)[0], value, of,
                       multiplier > BINDS, sign * multiplier * best.goal / limit.bound)
        )  # fmt: skip
    return tuple(found)


def _doubts(best: Descent, exact: np.ndarray, errors: np.ndarray) -> list[str]:
    """What of the result is not to be trusted as it stands."""
    said = []
    if not best.converged:
        said.append(
            "the method did not converge: the residual of the optimality conditions is "
            f"{best.residual:.1e} (at most {CONVERGED:g} at an optimum): some parameter may still "
            "gain about that share of a_wrms over its range (take more starts)"
        )
    found = best.design.values[COMFORT]
    off = np.abs(found.value / exact - 1)
    for k, named in enumerate(found.of):
        if max(errors[k], off[k]) > STATED:
            said.append(f"{named}: the integral of a_wrms is uncertain by "
                        f"{max(errors[k], off[k]):.0e} of its value (a mode with next to no "
                        "damping?)")  # fmt: skip
    return said


def _notes(problem: Problem, best: Descent, own: Design | None) -> list[str]:
    """What a reader may want to do something about."""
    said = []
    if own is None:
        said.append("the vehicle as it is has no stationary ride: there is nothing to compare with")
    tangent = problem.evaluate.measures.derivatives.at(**best.design.parameters)
    of_body = {p.symbol.name for p in tangent.derivatives.model.body.parameters}
    moved = [name for name in of_body & set(best.design.parameters) if not name.startswith(BENDING)]
    if tangent.held and moved:
        said.append(f"the car body's {tangent.held} is held while its other parameters change")
    if tangent.by_differences:
        said.append(f"gradients through {', '.join(tangent.by_differences)} are differences of "
                    "eighth order, not formulas")  # fmt: skip
    slopes = np.vstack([values.gradient for values in best.design.values.values()])
    for k, variable in enumerate(problem.evaluate.variables):
        if np.abs(slopes[:, k]).max() < NO_EFFECT:
            said.append(f"{variable.name} changes nothing in this study")
        elif not variable.lower <= variable.own <= variable.upper:
            said.append(f"{variable.name}: the vehicle's own {variable.own:g} {variable.unit} is "
                        f"not in the range, {variable.lower:g} to {variable.upper:g}")  # fmt: skip
        if abs(best.at_bounds[k]) > BINDS:
            side = "lower" if best.at_bounds[k] > 0 else "upper"
            said.append(f"{variable.name} ends at its {side} bound, "
                        f"{best.design.parameters[variable.symbol]:.6g} {variable.unit}".rstrip()
                        + ": a wider range would give more comfort")  # fmt: skip
    return said
