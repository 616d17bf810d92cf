"""Sperling's ride index W_z."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort.averages import line_powers
from railride.errors import Fault, InputError
from railride.weightings import FloatArray

Direction = Literal["vertical", "lateral"]


def sperling_weighting(frequency: ArrayLike, direction: Direction = "vertical") -> FloatArray:
    """Sperling's comfort weighting at ``frequency`` (Hz), of the same shape::

        B(f) = 0.588 √( (1.911 f² + (0.25 f²)²) / ((1 − 0.277 f²)² + (1.563 f − 0.0368 f³)²) )

    lateral × 1.25. Never W_k. Source: Sperling and Betzhold 1956; Garg and Dukkipati, Dynamics of
    Railway Vehicle Systems, 1984 (which rounds the lateral 0.735 to 0.737).

    >>> round(float(sperling_weighting(5.0)), 3)
    0.813
    """
    if direction not in ("vertical", "lateral"):
        raise InputError(str(Fault("direction", repr(direction), "'vertical' or 'lateral'")))
    square = np.asarray(frequency, dtype=np.float64) ** 2
    above = square * (1.911 + 0.25**2 * square)
    below = (1 - 0.277 * square) ** 2 + square * (1.563 - 0.0368 * square) ** 2
    factor = 0.588 * (1.25 if direction == "lateral" else 1.0)
    return np.asarray(factor * np.sqrt(above / below))


def wz_from_rms(weighted_rms: ArrayLike) -> FloatArray:
    """W_z = 4.42 a_B^0.3, a_B the r.m.s. (m/s²) after :func:`sperling_weighting`.

    The form for a whole spectrum. The sum of tenth powers over single lines, ΣW_zi^10, depends on
    the length of the record and is for single harmonics. Source: as there.
    """
    return np.asarray(4.42 * np.asarray(weighted_rms, dtype=np.float64) ** 0.3)


def sperling_rms(
    frequency: FloatArray, power: FloatArray, direction: Direction = "vertical"
) -> FloatArray:
    """a_B, m/s², shape (...): a_B² = Σ B(f_k)² · (mean square at f_k), from ``line_powers``.

    B(0) = 0, so the mean does not count.
    """
    return np.asarray(np.sqrt(power @ sperling_weighting(frequency, direction) ** 2))


def sperling_wz(record: ArrayLike, rate: float, direction: Direction = "vertical") -> FloatArray:
    """Sperling's W_z of an unweighted record at ``rate`` Hz, shape (...).

    Over the record's own Fourier lines, as :func:`railride.comfort.band_rms`.
    """
    return wz_from_rms(sperling_rms(*line_powers(record, rate), direction))
