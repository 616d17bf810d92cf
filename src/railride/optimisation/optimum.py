"""What an optimisation comes to: what changed, what it gains, and which limits bind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from railride.changed_vehicle import vehicle_with
from railride.designs.given import Cases
from railride.optimisation.descent import ACTIVE
from railride.optimisation.limits import Limit
from railride.optimisation.pareto import ParetoFront
from railride.optimisation.variables import Variable
from railride.parameters import Vehicle
from railride.vehicle import VehicleModel

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Change:
    """One parameter: of what it was, ``variable.own``, to what it is, SI.

    place : from 0 at the lower bound to 1 at the upper one. worth : relative change of the goal
    where the bound on which it ends moves outwards by 1 % of itself; 0 inside.
    """

    variable: Variable
    value: float
    place: float
    worth: float

    @property
    def relative(self) -> float | None:
        """(to - from)/from; None from 0."""
        own = self.variable.own
        return self.value / own - 1 if own else None

    @property
    def at_bound(self) -> str:
        """Which bound it ends on: "lower", "upper" or none."""
        if self.place <= ACTIVE:
            return "lower"
        return "upper" if self.place >= 1 - ACTIVE else ""


@dataclass(frozen=True)
class CaseChange:
    """a_wrms of one case before and after, m/s²; speed in m/s, position in m."""

    track: str
    speed: float
    position: float
    before: float | None
    after: float


@dataclass(frozen=True)
class LimitState:
    """One limit at the optimum.

    before, value : of what comes nearest to it, SI; of : what that is. binds : whether it holds the
    optimum. worth : d(goal)/d(bound), m/s² per SI unit of the limit: what a unit of it is worth.
    """

    limit: Limit
    before: float | None
    value: float
    of: str
    binds: bool
    worth: float


@dataclass(frozen=True, eq=False)
class Optimum:
    """The best design that was found.

    model : with the parameters changed. cases : what it is ridden on. objective : "mean" or
    "worst". a_wrms, a_wrms_before : the goal, m/s². residual : of the optimality conditions, the
    relative change of the goal that a variable could still gain over its range. converged :
    whether that, and the limits, are as an optimum's. error : estimated relative error of a_wrms.
    iterations, evaluations : of the method, and of designs. front : against travel, where asked.
    """

    model: VehicleModel
    cases: Cases
    objective: str
    a_wrms: float
    a_wrms_before: float | None
    changes: tuple[Change, ...]
    cases_changed: tuple[CaseChange, ...]
    limits: tuple[LimitState, ...]
    residual: float
    converged: bool
    error: float
    iterations: int
    evaluations: int
    remarks: tuple[str, ...] = ()
    front: ParetoFront | None = None

    @property
    def parameters(self) -> Mapping[str, float]:
        """Value of every chosen parameter, SI, by the name under which it was chosen."""
        return {change.variable.name: change.value for change in self.changes}

    def vehicle(self) -> Vehicle:
        """The vehicle with the parameters changed, for a parameter file; a remark says which.

        Raises
        ------
        InputError : a parameter that no parameter file holds.
        """
        made = vehicle_with(self.model)
        moved = "; ".join(f"{c.variable.name} from {c.variable.own:.6g} to {c.value:.6g} "
                          f"{c.variable.unit}".rstrip() for c in self.changes)  # fmt: skip
        said = f"{made.name}: optimised, and no longer of its source: {moved}"
        return replace(made, name=f"{made.name}, optimised", remarks=(*made.remarks, said))

    def table(self) -> pd.DataFrame:
        """What changed: one row per parameter, SI."""
        import pandas as pd

        return pd.DataFrame(
            [
                {
                    "parameter": change.variable.name,
                    "meaning": change.variable.meaning,
                    "unit": change.variable.unit,
                    "from": change.variable.own,
                    "to": change.value,
                    "change": change.relative,
                    "lower bound": change.variable.lower,
                    "upper bound": change.variable.upper,
                    "at bound": change.at_bound,
                }
                for change in self.changes
            ]
        )

    def _repr_html_(self) -> str:
        return str(self.table().to_html(index=False, float_format="%.5g", na_rep=""))
