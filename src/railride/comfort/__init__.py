"""Comfort indices of acceleration records.

Records are arrays (..., n), m/s², time last, at ``rate`` Hz; sample i stands for the time from
(i − ½)/rate to (i + ½)/rate, so that a record lasts T = n/rate. Each index is taken over the whole
of what it is given: to rate a section, weight the whole record first and give the section.
"""

from railride.comfort.advice import shock_remarks
from railride.comfort.averages import COMFORT_BAND, band_rms, block_rms, pooled_rms, rms
from railride.comfort.dose import pooled_vdv, vdv
from railride.comfort.en12299 import (
    ContinuousComfort,
    continuous_comfort,
    continuous_comfort_of,
    few_blocks,
    mean_comfort_levels,
    n_mv,
)
from railride.comfort.indices import ComfortIndices, indices
from railride.comfort.peaks import crest_factor, oversample
from railride.comfort.rating import AxisRating, RecordRating, rate_record
from railride.comfort.record import AccelerationRecord, Axis
from railride.comfort.running import mtvv, running_rms
from railride.comfort.sperling import Direction, sperling_weighting, sperling_wz, wz_from_rms
from railride.comfort.total import POSTURES, Posture, VibrationTotal, vector_sum, vibration_total

__all__ = [
    "COMFORT_BAND",
    "POSTURES",
    "AccelerationRecord",
    "Axis",
    "AxisRating",
    "ComfortIndices",
    "ContinuousComfort",
    "Direction",
    "Posture",
    "RecordRating",
    "VibrationTotal",
    "band_rms",
    "block_rms",
    "continuous_comfort",
    "continuous_comfort_of",
    "crest_factor",
    "few_blocks",
    "indices",
    "mean_comfort_levels",
    "mtvv",
    "n_mv",
    "oversample",
    "pooled_rms",
    "pooled_vdv",
    "rate_record",
    "rms",
    "running_rms",
    "shock_remarks",
    "sperling_weighting",
    "sperling_wz",
    "vdv",
    "vector_sum",
    "vibration_total",
    "wz_from_rms",
]
