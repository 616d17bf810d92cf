"""A problem solved from one start or several, or the limits that cannot be kept named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.optimisation.descent import FEASIBLE, Descent, descend, judged, least_violation
from railride.optimisation.limits import Limit
from railride.optimisation.problem import Design, Problem, worst_of

SPARE = 6  # further points from which limits are tried to be kept, where all starts miss them
SAME = 1e-4  # relative: goals that differ by less are those of one optimum
PATIENCE = 0.85  # of what is left to do, after an iteration: how many there will be is not known

Progress = Callable[[float], object]


@dataclass(frozen=True, eq=False)
class Solved:
    """The best of what was found from the starts; iterations and remarks of all of them."""

    best: Descent
    iterations: int
    remarks: tuple[str, ...] = ()


def own_place(problem: Problem) -> Array:
    """u of the vehicle as it is, within the bounds: (P,)."""
    return np.array([variable.place(variable.own) for variable in problem.evaluate.variables])


def further_starts(size: int, number: int, seed: int) -> Array:
    """Points of Sobol's sequence in the unit box, scrambled by the seed: (number, size)."""
    from scipy.stats import qmc

    if number == 0:
        return np.zeros((0, size))
    drawn = qmc.Sobol(size, seed=seed).random_base2(int(np.ceil(np.log2(number))))
    return np.asarray(drawn[:number])


def solve(problem: Problem, starts: Sequence[Array], progress: Progress | None = None) -> Solved:
    """The best optimum that the gradient method finds from the starts.

    A start that does not keep to the limits is moved to where the one missed most is missed least;
    where that is not enough for any of them, so are some further points.

    Raises
    ------
    InputError : limits that cannot be kept from any of them: which, and by how much; a design that
        cannot be evaluated, where every start meets one.
    """
    found: list[Descent] = []
    missed: list[Design] = []
    faults: list[InputError] = []
    spare = list(further_starts(problem.size, SPARE, 0))
    queue = list(starts)
    steps = 0
    while queue:
        done = len(found) + len(missed) + len(faults)
        advance = _advance(progress, min(done, len(starts) - 1), len(starts))
        try:
            design, more = _kept(problem, queue.pop(0))
            steps += more
            if problem.violation(design) > FEASIBLE:
                missed.append(design)
            else:
                found.append(_best_from(problem, design, advance))
        except InputError as fault:
            faults.append(fault)
        if not (queue or found) and missed and spare:
            queue = [spare.pop(0)]
    if missed and not found:
        refuse_infeasible(problem, min(missed, key=problem.violation), len(missed))
    if not found:
        raise faults[0]
    best = min(found, key=lambda one: one.goal)
    steps += sum(one.iterations for one in found)
    return Solved(best, steps, tuple(_said(found, len(missed), faults)))


def _kept(problem: Problem, start: Array) -> tuple[Design, int]:
    """The start where it keeps to the limits, else what misses them least; and the iterations."""
    design = problem.evaluate(start)
    if problem.violation(design) <= FEASIBLE:
        return design, 0
    return least_violation(problem, start)


def _best_from(problem: Problem, design: Design, advance: Callable[[], object] | None) -> Descent:
    """The optimum from a design that keeps to the limits; at worst that itself."""
    one = descend(problem, design.u, advance)
    return one if one.feasible else judged(problem, design, one.iterations)


def _advance(progress: Progress | None, done: int, total: int) -> Callable[[], object] | None:
    """Counts iterations of one of several starts."""
    if progress is None:
        return None
    left = 1.0

    def advance() -> None:
        nonlocal left
        left *= PATIENCE
        progress((done + 1 - left) / total)

    return advance


def _said(found: list[Descent], missed: int, faults: list[InputError]) -> list[str]:
    """Remarks on what the starts came to."""
    said = []
    starts = len(found) + missed + len(faults)
    best = min(one.goal for one in found)
    if starts > 1:
        as_good = sum(one.goal <= best * (1 + SAME) for one in found)
        others = {round(np.log(one.goal) / SAME) for one in found if one.goal > best * (1 + SAME)}
        worse = f"; {len(others)} other local optima are worse" if others else ""
        said.append(f"{as_good} of {starts} starts came to this optimum{worse}")
    if missed:
        said.append(f"from {missed} of {starts} starts no design was found that keeps to the "
                    "limits")  # fmt: skip
    said += [f"a start was given up: {fault}" for fault in faults]
    return said


def refuse_infeasible(problem: Problem, design: Design, starts: int) -> None:
    """Raise what limits the best compromise does not keep, and by how much."""
    faults = Faults("limits")
    for limit in problem.limits:
        value, of = worst_of(limit, design)
        off = (1 if limit.at_least else -1) * (1 - value / limit.bound)
        if off > FEASIBLE / 2:
            found = f"{shown(limit, value)} at the best compromise ({of}), {off:.2%} off"
            faults.add(limit.name, found, f"{limit.side} {shown(limit, limit.bound)}")
    at = ", ".join(f"{v.name} = {design.parameters[v.symbol]:.4g} {v.unit}".rstrip()
                   for v in problem.evaluate.variables)  # fmt: skip
    tried = f"{starts} start{'s' * (starts > 1)}"
    faults.add("together", f"no design that keeps to all of them, from {tried}; the worst of them "
               f"is missed least at {at}", "limits that can be kept", "widen these limits or the "
               "ranges of the parameters")  # fmt: skip
    faults.raise_if_any()


def shown(limit: Limit, value: float) -> str:
    """A value in the unit in which it is read: mm, or a ratio as it is."""
    return f"{1e3 * value:.4g} mm" if limit.unit == "m" else f"{value:.4g}"
