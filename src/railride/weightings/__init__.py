"""Frequency weightings of human vibration: as transfer functions, and on sampled records."""

from railride.weightings.filters import (
    ComplexArray,
    FloatArray,
    Weighting,
    weighting,
    weighting_names,
)
from railride.weightings.prediction import continued
from railride.weightings.sampled import apply_weighting, band_remark, checked_record, oversampled

__all__ = [
    "ComplexArray",
    "FloatArray",
    "Weighting",
    "apply_weighting",
    "band_remark",
    "checked_record",
    "continued",
    "oversampled",
    "weighting",
    "weighting_names",
]
