r"""The front between comfort and travel: how much of one buys how much of the other.

.. math:: \min_u g(u) \quad\text{subject to}\quad y(u) \le \epsilon

for ε from the least travel that the limits allow to that of the most comfortable design. Each
problem starts from the optimum of the one before, once in either direction; of the two answers the
better is kept. What another design beats in both is left out.

Source: Y.Y. Haimes, L.S. Lasdon, D.A. Wismer, IEEE Trans. SMC 1 (1971) 296-297 (the ε-constraint).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from railride.numeric import Array
from railride.optimisation.descent import Descent, descend
from railride.optimisation.limits import KINDS, Limit
from railride.optimisation.problem import Design, Goal, Problem
from railride.optimisation.solve import Progress, solve
from railride.optimisation.variables import Variable
from railride.units import headed

if TYPE_CHECKING:
    import pandas as pd

INSIDE = 1e-3  # of the range of travel, from its end: there the limit leaves room to move
NO_CONFLICT = 1e-6  # relative: a range of travel that is none


@dataclass(frozen=True, eq=False)
class ParetoFront:
    """Designs none of which is beaten in both, by travel ascending.

    against : the kind of travel, one of the limits' that are at most. parameters : (points, P), SI,
    of ``variables``. travel : (points,), SI, the largest over suspensions and cases. a_wrms :
    (points,), m/s². residuals : (points,), of the optimality of each. own : travel and a_wrms of
    the vehicle as it is; None where it has none.
    """

    variables: tuple[Variable, ...]
    against: str
    parameters: Array
    travel: Array
    a_wrms: Array
    residuals: Array
    own: tuple[float, float] | None = None
    remarks: tuple[str, ...] = ()

    def table(self) -> pd.DataFrame:
        """One row per design; the units in the column names."""
        import pandas as pd

        named = {headed(v.name, v.unit): self.parameters[:, k]
                 for k, v in enumerate(self.variables)}  # fmt: skip
        travel = headed(self.against, KINDS[self.against].unit)
        return pd.DataFrame({travel: self.travel, "a_wrms [m/s^2]": self.a_wrms, **named,
                             "KKT residual": self.residuals})  # fmt: skip

    def _repr_html_(self) -> str:
        return str(self.table().to_html(index=False, float_format="%.4g"))


def front(
    problem: Problem, against: str, points: int, starts: Sequence[Array],
    own: tuple[float, float] | None, progress: Progress | None = None,
) -> ParetoFront:  # fmt: skip
    """The front of a problem's goal against a kind of travel.

    points : how many are tried, 2 at least. starts : of the gradient method, for the two ends.

    Raises
    ------
    InputError : as :func:`railride.optimisation.solve.solve`.
    """
    travel = Goal(against, "worst")
    total = 2 * points

    def done(number: int) -> Progress | None:
        return None if progress is None else lambda part: progress((number + part) / total)

    easy = solve(problem, starts, done(0)).best
    least = solve(Problem(problem.evaluate, travel, problem.limits), [easy.design.u, *starts],
                  done(1)).best  # fmt: skip
    low, high = least.goal, travel.value(easy.design)
    remarks = []
    found = [easy]
    if high - low <= NO_CONFLICT * high:
        remarks.append(f"the most comfortable design has the least {against} as well: there is "
                       "nothing to choose")  # fmt: skip
    else:
        bounds = high - (high - low) * np.linspace(0, 1 - INSIDE, points)[1:]
        limits = [(*problem.limits, Limit(against, bound)) for bound in bounds.tolist()]
        tightened = [Problem(problem.evaluate, problem.goal, each) for each in limits]
        down = _chain(tightened, easy.design, 2, done)
        up = _chain(tightened[::-1], down[-1].design, points + 1, done)[::-1]
        found += [_better(a, b) for a, b in zip(down, up, strict=True)]
        lost = sum(not one.feasible for one in found)
        if lost:
            remarks.append(f"{lost} of {points} points of the front were not found: the gradient "
                           "method did not keep to their limit")  # fmt: skip
    kept = _undominated([one for one in found if one.feasible], travel)
    doubtful = sum(not one.converged for one in kept)
    if doubtful:
        remarks.append(f"{doubtful} of {len(kept)} points of the front are not converged: their "
                       "KKT residual says how far they may be from it")  # fmt: skip
    variables = problem.evaluate.variables
    return ParetoFront(
        variables, against,
        np.array([[one.design.parameters[v.symbol] for v in variables] for one in kept]),
        np.array([travel.value(one.design) for one in kept]),
        np.array([one.goal for one in kept]),
        np.array([one.residual for one in kept]),
        own, tuple(remarks),
    )  # fmt: skip


def _chain(
    problems: Sequence[Problem], start: Design, number: int, done: Callable[[int], Progress | None]
) -> list[Descent]:
    """Optima of problems one after the other, each from that before."""
    found, design = [], start
    for k, problem in enumerate(problems):
        one = descend(problem, design.u)
        if one.feasible:
            design = one.design
        found.append(one)
        advance = done(number + k)
        if advance is not None:
            advance(1.0)
    return found


def _better(a: Descent, b: Descent) -> Descent:
    return min(a, b, key=lambda one: (not one.feasible, one.goal))


def _undominated(found: Sequence[Descent], travel: Goal) -> list[Descent]:
    """Those that are more comfortable than all of less travel, by travel ascending."""
    kept: list[Descent] = []
    for one in sorted(found, key=lambda one: (travel.value(one.design), one.goal)):
        if not kept or one.goal < kept[-1].goal:
            kept.append(one)
    return kept
