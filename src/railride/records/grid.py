r"""An even rate from the times of a record's rows.

Row k of a piece is due at t₀ + k T. T is the common slope of the lines through all pieces by least
squares, each piece with its own t₀:

.. math:: T = \frac{\sum (k - \bar k)(t - \bar t)}{\sum (k - \bar k)^2}

A piece whose rows are due within 2 % of T, or within the last digit of its times, keeps its
samples. Another one is resampled by the quintic spline through them. Its error, the r.m.s. of a
sine's of unit amplitude over 1/√2, with times scattered evenly by ±5 % and ±20 % of T:

========== ====== ======
f / rate    ±5 %   ±20 %
========== ====== ======
0.1         6e-7   9e-6
0.25        3e-4   2.3e-3
0.4         1.5e-2 6.5e-2
========== ====== ======

The difference from the cubic spline, larger than the error itself, is told with the result.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from railride.records.clock import FloatArray

_EVEN = 0.02  # of a step: rounding up to here
_TOLD = 0.002  # of a step: nothing to speak of up to here
_SAME_RATE = 1e-3  # by which the rate of one piece may differ from that of all
_END = 1e-6  # of a step that the grid may lie beyond the first or last time
_BLOCK, _OVERLAP = 200_000, 100  # rows; a spline forgets 0.43 a row


@dataclass(frozen=True)
class EvenPieces:
    """Pieces at an even rate.

    rate: samples per second (Hz).
    starts: time of each piece's first sample (s).
    values: of each piece (axes, m).
    remarks: how uneven the times were, where that mattered.
    """

    rate: float
    starts: tuple[float, ...]
    values: tuple[FloatArray, ...]
    remarks: tuple[str, ...]


def at_even_rate(
    times: Sequence[FloatArray], values: Sequence[FloatArray], digit: float
) -> EvenPieces:
    """Bring pieces to one even rate, resampling those that are uneven.

    times: of each piece (n,), s, rising.
    values: of each piece (axes, n).
    digit: resolution of the times (s).
    """
    longest = max(t.size for t in times)
    rate = _plain(1 / _common_step(times), longest)
    step = 1 / rate
    departures = [_departure(t) / step for t in times]
    found, starts, off, differences = [], [], [], []
    for t, piece, departure in zip(times, values, departures, strict=True):
        tolerance = max(_EVEN, 0.51 * digit / step)
        drift = abs(_common_step([t]) / step - 1.0) * (t.size - 1)
        even = np.max(np.abs(departure)) <= tolerance
        if even and drift <= max(tolerance, _SAME_RATE * (t.size - 1)):
            starts.append(float(t[0]))
            found.append(piece)
            continue
        start, fine, difference = _resampled(t, piece, step)
        starts.append(start)
        found.append(fine)
        off.append(departure)
        differences.append(difference)
    remarks = []
    largest = max(float(np.max(np.abs(d))) for d in departures)
    if off:
        remarks.append(
            f"uneven sampling: the times are {_spread(off)} off an even grid; resampled at "
            f"{rate:.6g} Hz by a quintic spline, {100 * max(differences):.1g} % r.m.s. from a "
            "cubic one"
        )
    elif largest > max(_TOLD, 0.51 * digit / step):
        remarks.append(f"the times are {_spread(departures)} off an even grid, taken as rounding")
    return EvenPieces(rate, tuple(starts), tuple(found), tuple(remarks))


def _spread(departures: Sequence[FloatArray]) -> str:
    """Departures (of a step) as a text: ``up to 0.8 % of a step (0.2 % r.m.s.)``."""
    off = 100 * np.concatenate(departures)
    return f"up to {np.max(np.abs(off)):.2g} % of a step ({np.sqrt(np.mean(off**2)):.2g} % r.m.s.)"


def _common_step(times: Sequence[FloatArray]) -> float:
    """T of the lines through all pieces."""
    above, below = 0.0, 0.0
    for t in times:
        k = np.arange(t.size) - 0.5 * (t.size - 1)
        above += float(k @ (t - np.mean(t)))
        below += float(k @ k)
    return above / below


def _departure(t: FloatArray) -> FloatArray:
    """Times of a piece less those of its own line."""
    k = np.arange(t.size) - 0.5 * (t.size - 1)
    middle = t - np.mean(t)
    line: FloatArray = middle - k * (float(k @ middle) / float(k @ k))
    return line


def _resampled(t: FloatArray, values: FloatArray, step: float) -> tuple[float, FloatArray, float]:
    """Start, values on the even grid amid the times, and how far a cubic spline is from them."""
    from scipy.interpolate import make_interp_spline

    middle = float(np.mean(t))
    x = (t - middle) / step + 0.5 * (t.size - 1)
    grid = np.arange(np.ceil(x[0] - _END), np.floor(x[-1] + _END) + 1.0)
    start = middle + step * (float(grid[0]) - 0.5 * (t.size - 1))
    quintic, cubic = (np.empty((values.shape[0], grid.size)) for _ in range(2))
    for first in range(0, grid.size, _BLOCK):
        here = slice(first, min(first + _BLOCK, grid.size))
        a, b = np.searchsorted(x, (grid[here][0], grid[here][-1]))
        near = slice(max(int(a) - _OVERLAP, 0), int(b) + _OVERLAP)
        for degree, target in ((5, quintic), (3, cubic)):
            spline = make_interp_spline(x[near], values[:, near], k=degree, axis=1)
            target[:, here] = spline(np.clip(grid[here], x[0], x[-1]))
    spread = float(np.sqrt(np.mean(np.var(quintic, axis=1)))) or 1.0
    return start, quintic, float(np.sqrt(np.mean((quintic - cubic) ** 2))) / spread


def _plain(rate: float, n: int) -> float:
    """Return the rate with fewest digits that is off by less than 1 % of a step over n rows."""
    for digits in range(1, 16):
        plain = float(f"{rate:.{digits}g}")
        if abs(plain - rate) * n <= 0.01 * rate and abs(plain - rate) <= 1e-6 * rate:
            return plain
    return rate
