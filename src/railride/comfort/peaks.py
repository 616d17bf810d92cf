"""Peaks between the samples, and the crest factor."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort.averages import rms
from railride.weightings import FloatArray, checked_record, continued, oversampled

PEAK_RATE = 2000.0
"""Least rate (Hz) at which peaks are read: an 80 Hz peak is then at most 0.8 % low."""

_BEYOND = 128
"""Samples by which a record is continued beyond its ends."""


def oversampling(rate: float, least_rate: float = PEAK_RATE) -> int:
    """m, the smallest whole number with m · ``rate`` ≥ ``least_rate`` (both Hz).

    >>> oversampling(200.0), oversampling(2000.0), oversampling(10_000.0)
    (10, 1, 1)
    """
    return max(1, math.ceil(least_rate / rate * (1 - 1e-12)))


def oversample(record: ArrayLike, rate: float, least_rate: float = PEAK_RATE) -> FloatArray:
    """The band-limited signal through the samples, at m·rate ≥ least_rate.

    From the first sample to the last, shape (..., m(n − 1) + 1): every m-th value is the record's.
    m is the smallest whole number that will do (m = 1 gives the record itself). Beyond its ends the
    record goes on as its own spectrum predicts (:mod:`railride.weightings.prediction`).
    """
    values = checked_record(record, rate)
    times = oversampling(rate, least_rate)
    if times == 1:
        return values
    from scipy import fft

    count = values.shape[-1]
    finer = (count - 1) * times + 1
    fine = np.empty((*values.shape[:-1], finer))
    length = 2 * fft.next_fast_len(_BEYOND + (count + 1) // 2, real=True)
    for row, target in zip(values.reshape(-1, count), fine.reshape(-1, finer), strict=True):
        level, extended = float(np.mean(row)), np.zeros(length)
        swing = extended[_BEYOND : _BEYOND + count]
        np.subtract(row, level, out=swing)
        extended[:_BEYOND] = continued(swing[::-1], rate, _BEYOND)[::-1]
        extended[_BEYOND + count :][:_BEYOND] = continued(swing, rate, _BEYOND)
        dense = oversampled(fft.rfft(extended, overwrite_x=True), length, times)
        np.add(dense[_BEYOND * times :][:finer], level, out=target)
    return fine


def peak(fine: FloatArray) -> FloatArray:
    """Largest |a| over the last axis, shape (...), of what :func:`oversample` gives."""
    return np.asarray(np.maximum(np.max(fine, axis=-1), -np.min(fine, axis=-1)))


def crest_factor(record: ArrayLike, rate: float) -> FloatArray:
    """Largest |a_w| over the r.m.s. of a weighted record, shape (...); NaN where it is all zero.

    The peak is that of the band-limited signal through the samples (:func:`oversample`).
    Source: ISO 2631-1:1997, 6.2.1.
    """
    values = checked_record(record, rate)
    largest, level = peak(oversample(values, rate)), rms(values)
    return np.asarray(np.divide(largest, level, out=np.full_like(largest, np.nan), where=level > 0))
