"""Many designs of a vehicle at once: arrays of parameters in, arrays of exact values out.

given (parameters and cases, checked) → batches (matrices of the designs that can be) → evaluate
(their values) → values (the arrays, as a table or a data set).
"""

from railride.designs.evaluate import evaluate_designs
from railride.designs.given import RESULTS
from railride.designs.values import DesignValues

__all__ = ["RESULTS", "DesignValues", "evaluate_designs"]
