"""Parameters of a vehicle chosen for comfort, within limits of travel, damping and load.

cases (what is ridden), variables (what may change), limits (what must be kept) → measures (values
of a design and their gradients) → problem (as an optimiser sees it) → descent (the gradient method)
→ search (globally, before it), solve (from several starts; which limits cannot be kept), pareto
(the front against travel) → outcome, optimum (what changed and what binds) → task (all of it) →
calls, study (how it is asked for, in Python and in a file).
"""

from railride.optimisation.calls import optimise, pareto_front
from railride.optimisation.limits import KINDS, Limit
from railride.optimisation.optimum import CaseChange, Change, LimitState, Optimum
from railride.optimisation.pareto import ParetoFront
from railride.optimisation.study import read_task
from railride.optimisation.task import Task

__all__ = [
    "KINDS",
    "CaseChange",
    "Change",
    "Limit",
    "LimitState",
    "Optimum",
    "ParetoFront",
    "Task",
    "optimise",
    "pareto_front",
    "read_task",
]
