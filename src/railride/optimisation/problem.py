r"""A design study as a problem of nonlinear optimisation.

.. math:: \min_u \ln g(u) \quad\text{subject to}\quad c_i(u) \ge 0, \quad 0 \le u_j \le 1

with the goal g, the root of the weighted mean of squares over all cases or the worst of them, and
the margins of the limits, relative:

.. math:: c = 1 - y/y_{max} \quad\text{or}\quad c = y/y_{min} - 1 .

The worst case has a kink where two cases are equally bad. It becomes a variable t of its own, of
which every case is a constraint (epigraph form), so that all gradients exist:

.. math:: \min_{u,t} t \quad\text{subject to}\quad t - \ln g_k(u) \ge 0 .

Source: J. Nocedal, S.J. Wright, Numerical Optimization, 2nd ed. 2006, Chapters 12 and 18.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from railride.errors import InputError
from railride.numeric import Array
from railride.optimisation.limits import Limit
from railride.optimisation.measures import COMFORT, Measures, Values
from railride.optimisation.variables import Variable, values_at

GOALS = ("mean", "worst")
_KEPT = 64  # evaluations: solvers ask for value and gradient, goal and margins, one by one


@dataclass(frozen=True, eq=False)
class Design:
    """A design: u (P,), its parameters by symbol, and its values with gradients by u."""

    u: Array
    parameters: Mapping[str, float]
    values: Mapping[str, Values]


@dataclass(eq=False)
class Evaluator:
    """Evaluates designs, each once.

    count : how many have been evaluated.
    """

    measures: Measures
    variables: tuple[Variable, ...]
    count: int = 0
    _kept: dict[bytes, Design] = field(default_factory=dict)

    def __call__(self, u: Array) -> Design:
        """The design at u.

        Raises
        ------
        InputError : one that cannot be evaluated, with its parameters.
        """
        u = np.clip(np.asarray(u, dtype=float), 0.0, 1.0)
        key = u.tobytes()
        if key not in self._kept:
            if len(self._kept) >= _KEPT:
                self._kept.pop(next(iter(self._kept)))
            self._kept[key] = self._evaluated(u)
            self.count += 1
        return self._kept[key]

    def _evaluated(self, u: Array) -> Design:
        parameters = values_at(self.variables, u)
        slopes = np.array([v.slope(x) for v, x in zip(self.variables, u.tolist(), strict=True)])
        try:
            found = self.measures.at(parameters)
        except InputError as error:
            at = ", ".join(f"{name} = {value:.6g}" for name, value in parameters.items())
            raise InputError(f"at {at}: {error}") from None
        return Design(u, parameters, {kind: v.along(slopes) for kind, v in found.items()})


@dataclass(frozen=True, eq=False)
class Goal:
    """What is to be small: values of a kind, their weighted "mean" (of squares) or the "worst".

    weights : of the values, (m,); None for equal ones.
    """

    kind: str = COMFORT
    how: str = "mean"
    weights: Array | None = None

    def value(self, design: Design) -> float:
        """g, SI."""
        y = design.values[self.kind].value
        if self.how == "worst":
            return float(y.max())
        return float(np.sqrt(np.average(y**2, weights=self.weights)))

    def parts(self, design: Design) -> tuple[Array, Array]:
        """ln g (1,) and its gradient (1, P), or those of every case: (m,) and (m, P)."""
        y = design.values[self.kind]
        if self.how == "worst":
            return np.log(y.value), y.gradient / y.value[:, np.newaxis]
        weights = np.ones_like(y.value) if self.weights is None else self.weights
        part = weights * y.value
        gradient = part @ y.gradient / (part @ y.value)
        return np.log([self.value(design)]), gradient[np.newaxis]


@dataclass(frozen=True, eq=False)
class Problem:
    """A goal within limits."""

    evaluate: Evaluator
    goal: Goal
    limits: tuple[Limit, ...] = ()

    @property
    def size(self) -> int:
        """The number of variables, P."""
        return len(self.evaluate.variables)

    def margins(self, design: Design) -> tuple[Array, Array]:
        """c (k,) of all limits, one after the other, and their gradients (k, P)."""
        c, dc = [np.zeros(0)], [np.zeros((0, self.size))]
        for limit in self.limits:
            y = limited(limit, design)
            sign = 1.0 if limit.at_least else -1.0
            c.append(sign * (y.value / limit.bound - 1))
            dc.append(sign * y.gradient / limit.bound)
        return np.concatenate(c), np.concatenate(dc)

    def members(self, design: Design) -> list[slice]:
        """Which of the margins belong to each limit."""
        sizes = [len(limited(limit, design).value) for limit in self.limits]
        ends = np.cumsum([0, *sizes])
        return [slice(a, b) for a, b in zip(ends[:-1].tolist(), ends[1:].tolist(), strict=True)]

    def violation(self, design: Design) -> float:
        """By how much the worst limit is not kept, relative; 0 where all are."""
        return float(max(-self.margins(design)[0].min(initial=0.0), 0.0))


def limited(limit: Limit, design: Design) -> Values:
    """The values of a design that a limit is about."""
    y = design.values[limit.kind]
    return y.of_mode(limit.mode) if limit.mode else y


def worst_of(limit: Limit, design: Design) -> tuple[float, str]:
    """The value of a design that comes nearest to a limit, or misses it most; and what it is of."""
    y = limited(limit, design)
    worst = int(np.argmin(y.value) if limit.at_least else np.argmax(y.value))
    return float(y.value[worst]), y.of[worst]


def checked_weights(weights: Sequence[float] | None, goal: str, cases: int) -> Array | None:
    """Weights of the cases, (m,).

    Raises
    ------
    InputError : another number of them than there are cases; ones that are no numbers of at least
        0, or all 0; weights of the worst case; a goal that there is none of.
    """
    if goal not in GOALS:
        raise InputError(f"objective: found {goal!r}; expected one of {', '.join(GOALS)}")
    if weights is None:
        return None
    if goal == "worst":
        raise InputError("weights: found them with the worst case; expected none (they weigh the "
                         "squares of the mean)")  # fmt: skip
    try:
        found = np.asarray(weights, dtype=float)
    except (TypeError, ValueError):
        found = np.full(1, np.nan)
    if found.shape != (cases,) or not (np.isfinite(found) & (found >= 0)).all() or not found.any():
        raise InputError(f"weights: found {weights!r}; expected {cases} numbers of at least 0, not "
                         "all 0: one for every track, speed and position")  # fmt: skip
    return found
