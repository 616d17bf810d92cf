"""What is known of parameters that are not known exactly, and samples of them.

kinds (the distributions) → reading (from tables of a study file) → limits (values that a model
cannot have) → sampling (designs by number: Sobol's sequence, Latin hypercubes, random numbers).
"""

from railride.distributions.kinds import KINDS, Distribution, Quantiles
from railride.distributions.limits import note_impossible
from railride.distributions.reading import read_distribution
from railride.distributions.sampling import METHODS, refuse_sampling, sample

__all__ = [
    "KINDS",
    "METHODS",
    "Distribution",
    "Quantiles",
    "note_impossible",
    "read_distribution",
    "refuse_sampling",
    "sample",
]
