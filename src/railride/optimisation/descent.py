r"""The gradient method: sequential quadratic programming, and how near its end is to an optimum.

At an optimum the gradient of the goal is balanced by those of the limits and bounds that bind
(Karush, Kuhn and Tucker),

.. math:: \nabla \ln g = \sum_i \lambda_i \nabla c_i + \sum_j \mu_j \nabla b_j, \qquad
          \lambda, \mu \ge 0,

b_j the distances from the bounds. The multipliers are the non-negative least-squares solution over
those that are active, whatever the solver thinks of them; what is left over is the residual, the
relative change of the goal that a variable could still gain over its whole range. A multiplier says
what a limit is worth: d ln g/d(ln y_max) = -λ.

Where limits cannot be kept, their largest violation s is made as small as can be,

.. math:: \min_{u,s} s \quad\text{subject to}\quad c_i(u) + s \ge 0, \quad s \ge 0 .

Source: J. Nocedal, S.J. Wright, Numerical Optimization, 2nd ed. 2006, Theorem 12.1 and Chapter 18;
D. Kraft, DFVLR-FB 88-28 (1988): the program, in scipy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from railride.numeric import Array
from railride.optimisation.problem import Design, Problem

FEASIBLE = 1e-6  # relative: a limit that is missed by less is kept
CONVERGED = 1e-4  # KKT residual: at worst, what is left to gain is of this order
ACTIVE = 1e-5  # relative margin below which a limit binds, or distance from a bound
ITERATIONS = 200
TOLERANCES = (1e-9, 1e-12)  # of ln g from step to step; the second where the first is too wide
_ON_BOUND = 1e-9  # of a range: what the method means by the bound itself
_EXACTLY = 1e3  # weight of the condition that the multipliers of the cases add up to 1


@dataclass(frozen=True, eq=False)
class Descent:
    """Where the gradient method came to.

    multipliers : λ of every margin, (k,). at_bounds : μ of the lower bounds, negative of the upper
    ones, (P,). residual : see the module. violation : relative, of the limit missed most.
    """

    design: Design
    goal: float
    multipliers: Array
    at_bounds: Array
    residual: float
    violation: float
    iterations: int

    @property
    def feasible(self) -> bool:
        """Whether all limits are kept."""
        return self.violation <= FEASIBLE

    @property
    def converged(self) -> bool:
        """Whether it is an optimum, as near as can be told."""
        return self.feasible and self.residual <= CONVERGED


def descend(
    problem: Problem, start: Array, progress: Callable[[], object] | None = None
) -> Descent:
    """Minimise from a start in the unit box.

    start : u, (P,). progress : called after every iteration.

    Raises
    ------
    InputError : a design on the way that cannot be evaluated.
    """
    found = _descended(problem, start, TOLERANCES[0], progress)
    if found.converged or not found.feasible:
        return found
    again = _descended(problem, found.design.u, TOLERANCES[1], progress)
    again = replace(again, iterations=found.iterations + again.iterations)
    return again if again.residual < found.residual else found


def _descended(
    problem: Problem, start: Array, tolerance: float, progress: Callable[[], object] | None
) -> Descent:
    """One run of the method; for the worst case over u and t."""
    epigraph = problem.goal.how == "worst"

    def parts(z: Array) -> tuple[Array, Array]:
        return problem.goal.parts(problem.evaluate(z[: problem.size]))

    def margins(z: Array) -> Array:
        return problem.margins(problem.evaluate(z[: problem.size]))[0]

    def margin_slopes(z: Array) -> Array:
        slopes = problem.margins(problem.evaluate(z[: problem.size]))[1]
        return _with_column(slopes, 0.0) if epigraph else slopes

    constraints: list[Constraint] = [(margins, margin_slopes)] if problem.limits else []
    if not epigraph:
        z, steps = _slsqp(
            lambda z: (parts(z)[0][0], parts(z)[1][0]), constraints, start, 0, tolerance, progress
        )
        return judged(problem, problem.evaluate(z), steps)
    constraints.append((lambda z: z[-1] - parts(z)[0], lambda z: _with_column(-parts(z)[1], 1.0)))
    first = np.append(start, parts(start)[0].max())
    rise = np.append(np.zeros(problem.size), 1.0)
    z, steps = _slsqp(lambda z: (z[-1], rise), constraints, first, 1, tolerance, progress)
    return judged(problem, problem.evaluate(z[:-1]), steps)


def least_violation(problem: Problem, start: Array) -> tuple[Design, int]:
    """The design whose limit missed most is missed least, from a start; and the iterations."""

    def margins(z: Array) -> Array:
        return np.asarray(problem.margins(problem.evaluate(z[:-1]))[0] + z[-1])

    def slopes(z: Array) -> Array:
        return _with_column(problem.margins(problem.evaluate(z[:-1]))[1], 1.0)

    first = np.append(start, problem.violation(problem.evaluate(start)))
    rise = np.append(np.zeros(problem.size), 1.0)
    z, steps = _slsqp(lambda z: (z[-1], rise), [(margins, slopes)], first, 1, TOLERANCES[0],
                      floor=0.0)  # fmt: skip
    return problem.evaluate(z[:-1]), steps


Fun = Callable[[Array], tuple[float, Array]]
Constraint = tuple[Callable[[Array], Array], Callable[[Array], Array]]


def _slsqp(
    fun: Fun, constraints: list[Constraint], start: Array, free: int, tolerance: float,
    progress: Callable[[], object] | None = None, floor: float = -np.inf,
) -> tuple[Array, int]:  # fmt: skip
    """scipy's SLSQP; ``free`` variables at the end are above ``floor`` only."""
    from scipy.optimize import Bounds, minimize

    inside = start.size - free
    low = np.append(np.zeros(inside), [floor] * free)
    high = np.append(np.ones(inside), [np.inf] * free)
    found = minimize(
        fun, start, jac=True, method="SLSQP", bounds=Bounds(low, high),
        constraints=[{"type": "ineq", "fun": f, "jac": df} for f, df in constraints],
        options={"ftol": tolerance, "maxiter": ITERATIONS},
        callback=None if progress is None else lambda _: progress(),
    )  # fmt: skip
    x = np.where(found.x - low < _ON_BOUND, low, found.x)
    return np.where(high - x < _ON_BOUND, high, x), int(found.nit)


def _with_column(slopes: Array, value: float) -> Array:
    return np.asarray(np.hstack([slopes, np.full((len(slopes), 1), value)]))


def judged(problem: Problem, design: Design, iterations: int) -> Descent:
    """A design as where the method came to: its multipliers and residual."""
    multipliers, at_bounds, residual = kkt(problem, design)
    return Descent(design, problem.goal.value(design), multipliers, at_bounds, residual,
                   problem.violation(design), iterations)  # fmt: skip


def kkt(problem: Problem, design: Design) -> tuple[Array, Array, float]:
    """Multipliers of the margins (k,) and of the bounds (P,), and the residual."""
    from scipy.optimize import nnls

    goals, goal_slopes = problem.goal.parts(design)
    c, dc = problem.margins(design)
    worst, active = goals >= goals.max() - ACTIVE, c <= ACTIVE
    low, high = design.u <= ACTIVE, design.u >= 1 - ACTIVE
    sides = np.eye(problem.size)
    columns = [-goal_slopes[worst], dc[active], sides[low], -sides[high]]
    sums = [np.full(int(worst.sum()), _EXACTLY), np.zeros(sum(map(len, columns[1:])))]
    A = np.vstack([np.vstack(columns).T, np.concatenate(sums)])
    found, _ = nnls(A, np.append(np.zeros(problem.size), _EXACTLY))
    found = found / found[: int(worst.sum())].sum()
    left = A[:-1] @ found
    shares = np.split(found, np.cumsum([len(of) for of in columns[:-1]]))
    multipliers, at_bounds = np.zeros_like(c), np.zeros(problem.size)
    multipliers[active] = shares[1]
    at_bounds[low], at_bounds[high] = shares[2], -shares[3]
    return multipliers, at_bounds, float(np.abs(left).max())
