"""The exact stochastic ride: mean squares from spectra, without a time run.

quadrature (panels that shrink towards poles) → gains (weightings as rational functions) → process
(outputs of the vehicle as stationary processes); fractions (vehicles in partial fractions) →
contour (the path that closes a band) → residues (mean squares in closed form) → squares (by either
way) → ride (comfort values), bands (third octaves), maps (along the car, over speed), extremes
(suspension travel, wheel load), shares (which mode it comes from); and measured (the spectrum of a
track that was measured).
"""

from railride.stochastic.bands import third_octaves
from railride.stochastic.extremes import (
    Extreme,
    expected_peak,
    extremes,
    missing_loads,
    output_statistics,
)
from railride.stochastic.gains import Gain
from railride.stochastic.maps import comfort_map
from railride.stochastic.measured import (
    MeasuredSpectrum,
    measured_spectrum,
    spectrum_fits,
    track_spectrum,
)
from railride.stochastic.process import BAND_HZ, Process, process
from railride.stochastic.ride import (
    StochasticRide,
    stochastic_ride,
    weighted_rms,
    weighted_rms_of_many,
)
from railride.stochastic.shares import mode_shares

__all__ = [
    "BAND_HZ",
    "Extreme",
    "Gain",
    "MeasuredSpectrum",
    "Process",
    "StochasticRide",
    "comfort_map",
    "expected_peak",
    "extremes",
    "measured_spectrum",
    "missing_loads",
    "mode_shares",
    "output_statistics",
    "process",
    "spectrum_fits",
    "stochastic_ride",
    "third_octaves",
    "track_spectrum",
    "weighted_rms",
    "weighted_rms_of_many",
]
