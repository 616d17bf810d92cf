"""Third-octave bands, and what a record holds in each.

Midband frequencies f_n = 10^(n/10) Hz, edges f_n · 10^(±1/20) (base ten); the bands are called by
their nominal frequencies, 0.1 to 80 Hz.

Source: IEC 61260-1:2014, 5.2 to 5.5 and Annex E (midband, edge and nominal frequencies).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort.averages import line_powers
from railride.weightings import FloatArray, checked_record

NUMBERS = range(-10, 20)  # n of the bands from 0.1 to 80 Hz
_NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def band_edges() -> FloatArray:
    """Edges of the third-octave bands, Hz, ascending: one more than there are bands.

    >>> band_edges()[[0, 1, -1]].round(4).tolist()
    [0.0891, 0.1122, 89.1251]
    """
    return np.asarray(10.0 ** ((np.arange(NUMBERS.start, NUMBERS.stop + 1) - 0.5) / 10))


def nominal_frequency(n: int) -> float:
    """What the band of midband frequency 10^(n/10) Hz is called.

    >>> [nominal_frequency(n) for n in (-10, 0, 5, 19)]
    [0.1, 1.0, 3.15, 80.0]
    """
    decade, within = divmod(n, 10)
    return round(_NOMINAL[within] * 10.0**decade, 6)


def nominal_frequencies() -> list[float]:
    """What the bands are called, ascending, Hz."""
    return [nominal_frequency(n) for n in NUMBERS]


def third_octave_rms(pieces: Sequence[ArrayLike], rate: float) -> FloatArray:
    """R.m.s. of a record in each band, shape (bands,): an ideal filter, the mean taken out.

    By Parseval's theorem from the record's own Fourier lines k/T, each spread evenly over its cell
    (k ± ½)/T, so that the squares of all bands add up to the mean square between their outer edges
    and a short record does not favour the bands that a line happens to fall into.

    ``pieces``: the stretches (n,) of one record, in its unit; their mean squares count by their
    lengths. ``rate``: samples a second, Hz. A band that reaches beyond fs/2, or that is
    narrower than the lines of the longest stretch are apart, is NaN: the record cannot tell.

    >>> tone = np.sin(2 * np.pi * 8.0 * np.arange(4000) / 200)
    >>> levels = third_octave_rms([tone], 200.0)
    >>> nominal_frequencies()[int(np.nanargmax(levels))], round(float(np.nanmax(levels)), 3)
    (8.0, 0.707)
    """
    edges, squares, total, longest = band_edges(), np.zeros(len(NUMBERS)), 0, 0
    for piece in pieces:
        values = checked_record(piece, rate)
        squares += values.size * _squares(values, rate, edges)
        total, longest = total + values.size, max(longest, values.size)
    levels = np.sqrt(squares / total)
    levels[(edges[1:] > rate / 2 * (1 + 1e-12)) | (np.diff(edges) < rate / longest)] = np.nan
    return levels


def _squares(values: FloatArray, rate: float, edges: FloatArray) -> FloatArray:
    """Mean square of a stretch in each band."""
    frequency, power = line_powers(values, rate)
    power[0] = 0.0  # the mean
    up_to = np.concatenate(([0.0], np.cumsum(power)))  # at the upper ends of the lines' cells
    half = frequency[1] / 2 if frequency.size > 1 else rate / 2
    cells = np.clip(np.append(frequency, frequency[-1] + 2 * half) - half, 0.0, rate / 2)
    return np.asarray(np.diff(np.interp(edges, cells, up_to)))
