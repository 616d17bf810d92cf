"""An optimisation that is fully described, and how it is carried out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from railride.changed_vehicle import vehicle_with
from railride.designs.given import Cases
from railride.errors import Faults, InputError
from railride.modal import modes
from railride.numeric import Array
from railride.optimisation.cases import cases_named
from railride.optimisation.limits import TRAVELS, Limit, limits_of
from railride.optimisation.measures import COMFORT, Measures
from railride.optimisation.optimum import Optimum
from railride.optimisation.outcome import outcome
from railride.optimisation.pareto import front
from railride.optimisation.problem import Design, Evaluator, Goal, Problem, checked_weights
from railride.optimisation.search import searched
from railride.optimisation.solve import Progress, further_starts, own_place, solve
from railride.optimisation.variables import Ranges, Variable, chosen_variables
from railride.quantities import check_number
from railride.sensitivities import Derivatives
from railride.stochastic import missing_loads
from railride.stochastic.extremes import DISTANCE
from railride.vehicle import VehicleModel

SEARCHES = ("gradient", "global")
AGAINST = (*TRAVELS, "wheel_load_variation")
MOST_STARTS, MOST_POINTS = 1000, 200
NUDGE = 1e-6  # of a range
ENDS = 0.2  # of the work, where a front comes after it
SEARCHED = 0.9  # of the work up to the optimum, where it is searched for


@dataclass(frozen=True)
class Front:
    """A front that is asked for: against which limit's kind, and of how many points."""

    against: str = "secondary_travel"
    points: int = 11

    def note_faults(self, model: VehicleModel, faults: Faults, where: str = "pareto") -> None:
        """Note what cannot be."""
        if self.against not in AGAINST:
            faults.add(f"{where}.against", repr(self.against), f"one of {', '.join(AGAINST)}")
        elif self.against == "wheel_load_variation" and missing_loads(model):
            faults.add(f"{where}.against", "wheel loads of unknown wheelset mass", "masses",
                       "give bogie.wheelset_mass in the vehicle's file")  # fmt: skip
        _note_number(self.points, f"{where}.points", 2, MOST_POINTS, faults)


@dataclass(frozen=True, eq=False)
class Task:
    """An optimisation that is fully described; see :func:`optimise` for what its parts mean."""

    model: VehicleModel
    variables: tuple[Variable, ...]
    cases: Cases
    limits: tuple[Limit, ...]
    objective: str
    weights: Array | None
    search: str
    starts: int
    seed: int
    distance: float
    front: Front | None = None

    def problem(self) -> Problem:
        """The problem as the methods see it."""
        kinds = {limit.kind for limit in self.limits}
        kinds |= set() if self.front is None else {self.front.against}
        derivatives = Derivatives(self.model, [v.symbol for v in self.variables])
        measures = Measures(self.model, derivatives, self.cases, frozenset(kinds), self.distance)
        evaluator = Evaluator(measures, self.variables)
        return Problem(evaluator, Goal(COMFORT, self.objective, self.weights), self.limits)

    def run(self, progress: Progress | None = None) -> Optimum:
        """The optimum, and the front where it is asked for; raises as :func:`optimise`."""
        problem = self.problem()
        starts = self._starts(problem)
        own = self._own(problem)
        ends = ENDS if self.front else 1.0
        said = []
        begun = 0.0
        if self.search == "global":
            begun = SEARCHED * ends
            best, remark = searched(problem, self.seed, _part(progress, 0.0, begun))
            starts, said = [best, *starts], [remark]
        solved = solve(problem, starts, _part(progress, begun, ends))
        found = outcome(problem, replace(solved, remarks=(*said, *solved.remarks)), own)
        if self.front is None:
            return found
        against, starts = self.front.against, [solved.best.design.u, *starts]
        beside = (None if own is None
                  else (Goal(against, "worst").value(own), problem.goal.value(own)))  # fmt: skip
        made = front(problem, against, self.front.points, starts, beside,
                     _part(progress, ENDS, 1.0))  # fmt: skip
        return replace(found, front=made, evaluations=problem.evaluate.count,
                       remarks=(*found.remarks, *made.remarks))  # fmt: skip

    def check_vehicle(self) -> None:
        """Raise :class:`InputError` where what is chosen cannot be written into a parameter file.

        Tried with the parameters a little off the vehicle's own.
        """
        off = {v.symbol: v.value(min(v.place(v.own) + NUDGE, 1.0) - NUDGE / 2)
               for v in self.variables}  # fmt: skip
        vehicle_with(self.model, **off)

    def _starts(self, problem: Problem) -> list[Array]:
        """The vehicle as it is, and points all over the ranges."""
        return [own_place(problem), *further_starts(problem.size, self.starts - 1, self.seed)]

    def _own(self, problem: Problem) -> Design | None:
        """The vehicle as it is; None where it has no stationary ride."""
        values = {v.symbol: v.own for v in self.variables}
        try:
            found = problem.evaluate.measures.at(values)
        except InputError:
            return None
        return Design(own_place(problem), values, found)


def task_of(
    model: VehicleModel,
    parameters: Ranges,
    cases: Cases,
    *,
    limits: Mapping[str, Any] | None = None,
    objective: str = "mean",
    weights: Sequence[float] | None = None,
    search: str = "gradient",
    starts: int = 1,
    seed: int = 0,
    distance: float = DISTANCE,
) -> Task:
    """What :func:`optimise` is asked for, checked."""
    faults = Faults("optimisation")
    if search not in SEARCHES:
        faults.add("search", repr(search), f"one of {', '.join(SEARCHES)}")
    _note_number(starts, "starts", 1, MOST_STARTS, faults)
    _note_number(seed, "seed", 0, 2**32 - 1, faults)
    check_number(faults, "distance", distance, "> 0", "m")
    faults.raise_if_any()
    return Task(
        model, chosen_variables(model, parameters), cases,
        limits_of(model, limits or {}, mode_labels(model)), objective,
        checked_weights(weights, objective, len(cases_named(cases))), search, starts, seed,
        float(distance),
    )  # fmt: skip


def mode_labels(model: VehicleModel) -> tuple[str, ...]:
    """The labels of the vehicle's modes, each once."""
    return tuple(dict.fromkeys(mode.label for mode in modes(model)))


def _part(progress: Progress | None, start: float, end: float) -> Progress | None:
    """Progress of a part of the work."""
    if progress is None:
        return None
    return lambda part: progress(start + (end - start) * part)


def _note_number(value: object, name: str, least: int, most: int, faults: Faults) -> None:
    whole = isinstance(value, int) and not isinstance(value, bool)
    if not whole or not least <= value <= most:  # type: ignore[operator]
        faults.add(name, repr(value), f"a whole number from {least} to {most}")
