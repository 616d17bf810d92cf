"""What parameters that are not known exactly make of the comfort of a ride.

estimates (mean, percentiles, classes, with their intervals), indices (Sobol's: where the scatter is
from) → result → propagation (through any function).
"""

from railride.uncertainty.estimates import Estimate, Summary, summary
from railride.uncertainty.indices import Indices
from railride.uncertainty.propagation import propagate
from railride.uncertainty.result import Uncertain, Uncertainty

__all__ = [
    "Estimate",
    "Indices",
    "Summary",
    "Uncertain",
    "Uncertainty",
    "propagate",
    "summary",
]
