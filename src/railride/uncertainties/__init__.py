"""What parameters that are not known exactly make of the comfort of a ride.

estimates (mean, percentiles, classes, with their intervals), indices (Sobol's: where the scatter is
from) → result → propagation (through any function) → ride (through the vehicle) → study (as a study
file asks for it).
"""

from railride.uncertainties.estimates import Estimate, Summary, summary
from railride.uncertainties.indices import Indices
from railride.uncertainties.propagation import propagate
from railride.uncertainties.result import Uncertain, Uncertainty
from railride.uncertainties.ride import uncertainty
from railride.uncertainties.study import UncertaintySettings, read_uncertainty, study_uncertainty

__all__ = [
    "Estimate",
    "Indices",
    "Summary",
    "Uncertain",
    "Uncertainty",
    "UncertaintySettings",
    "propagate",
    "read_uncertainty",
    "study_uncertainty",
    "summary",
    "uncertainty",
]
