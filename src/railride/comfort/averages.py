"""Root mean squares: of a record, of a band of it, of its blocks, and of several together."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import Fault, InputError
from railride.weightings import FloatArray, checked_record

COMFORT_BAND = (0.05, 80.0)
"""Band of the unweighted r.m.s., Hz."""

BLOCK = 5.0
"""s: the blocks of EN 12299."""

_EXACT = 100_000
"""Samples up to which a spectrum is taken of exactly so many."""


def rms(record: ArrayLike) -> FloatArray:
    """a = √((1/T) ∫ a² dt): root mean square over the last axis, shape (...).

    Source: ISO 2631-1:1997, Eq (1).

    >>> float(rms([3.0, -3.0, 3.0, -3.0]))
    3.0
    """
    values = checked_record(record, 1.0)
    return np.asarray(np.sqrt(np.mean(values**2, axis=-1)))


def pooled_rms(levels: ArrayLike, durations: ArrayLike) -> float:
    """a = √(Σ T_i a_i² / Σ T_i): r.m.s. of stretches that last ``durations`` T_i (s), together.

    ``levels``: a_i, each the r.m.s. of one stretch, of the same shape (n,).

    >>> pooled_rms([3.0, 1.0], [1.0, 3.0]) == 3**0.5
    True
    """
    a, seconds = np.asarray(levels, dtype=np.float64), np.asarray(durations, dtype=np.float64)
    return math.sqrt(float(a**2 @ seconds) / float(seconds.sum()))


def line_powers(record: ArrayLike, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies k/T (Hz) and the mean square in each line (..., lines), by Parseval.

    A record of more than 100,000 samples whose number has large prime factors, which would take
    several times as long, is first led on at its mean by some thousandths of its length: the lines
    then lie a little closer and hold the same mean square in all.
    """
    from scipy import fft

    values = checked_record(record, rate)
    count = values.shape[-1]
    length = count if count <= _EXACT else fft.next_fast_len(count)
    mean = np.mean(values, axis=-1, keepdims=True)
    lines = fft.rfft(values - mean, length, axis=-1)
    power = lines.real**2
    power += lines.imag**2
    power[..., 1 : (length + 1) // 2] *= 2  # a line and its mirror image; 0 and fs/2 have none
    power /= length * count
    power[..., :1] = mean**2
    return np.asarray(fft.rfftfreq(length, 1 / rate)), power


def band_rms(
    record: ArrayLike, rate: float, low: float = COMFORT_BAND[0], high: float = COMFORT_BAND[1]
) -> FloatArray:
    """Root mean square of the content with low ≤ f ≤ high (Hz), shape (...).

    By Parseval's theorem from the record's own Fourier lines k/T, no window: exact for lines that
    fit the record, and the plain r.m.s. less the mean where the band holds everything. A line that
    does not fit leaks as 1/(f − f_0)², which between 0.05 and 80 Hz moves a ride's value by less
    than 0.1 %. A drift is a sawtooth to a Fourier series and does count (D/√12 for a drift of D
    over the record): take it out first.

    Raises :class:`InputError` unless 0 ≤ low < high.
    """
    if not 0 <= low < high:
        raise InputError(str(Fault("band", f"{low} to {high} Hz", "0 ≤ low < high")))
    return rms_of_lines(*line_powers(record, rate), low, high)


def rms_of_lines(
    frequency: FloatArray,
    power: FloatArray,
    low: float = COMFORT_BAND[0],
    high: float = COMFORT_BAND[1],
) -> FloatArray:
    """Root mean square of the lines of :func:`line_powers` with low ≤ f ≤ high (Hz)."""
    first, end = np.searchsorted(frequency, low), np.searchsorted(frequency, high, "right")
    return np.asarray(np.sqrt(np.sum(power[..., first:end], axis=-1)))


def block_rms(record: ArrayLike, rate: float, duration: float = BLOCK) -> FloatArray:
    """R.m.s. of consecutive whole blocks of ``duration`` s of a weighted record: (..., blocks).

    What is left at the end is not counted. Raises :class:`InputError` where not one block fits.
    Source: EN 12299 (5 s).
    """
    values = checked_record(record, rate)
    length = values.shape[-1] / rate
    blocks = math.floor(length / duration * (1 + 1e-12)) if duration > 0 else 0
    if blocks < 1 or duration * rate < 1:
        raise InputError(
            str(Fault("record", f"{length:.4g} s", f"at least one block of {duration:g} s"))
        )
    edges = np.rint(np.arange(blocks + 1) * duration * rate).astype(np.int64)
    pieces = [rms(values[..., a:b]) for a, b in itertools.pairwise(edges)]
    return np.stack(pieces, axis=-1)


def block_rms_of(
    pieces: Sequence[FloatArray], rate: float, duration: float = BLOCK
) -> list[FloatArray]:
    """:func:`block_rms` of each of several stretches (n,): each (blocks,), empty if none fits."""
    none: FloatArray = np.empty(0)
    fit = [piece.size / rate * (1 + 1e-12) >= duration for piece in pieces]
    return [
        block_rms(piece, rate, duration) if fits else none
        for piece, fits in zip(pieces, fit, strict=True)
    ]
