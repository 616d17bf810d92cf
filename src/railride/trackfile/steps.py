"""The step of which distances are multiples to the last bit, as those of a written track are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from railride.spectra import FloatArray

_ROUND = (6, 9, 12, 15)  # digits of steps that people choose
_MOST = 400  # floats tried between the bounds
_SAMPLE = 1000  # distances by which most of them are told to be wrong


def exact_step(distance: FloatArray) -> float | None:
    """A step h (m) with x_0 + j h = x_j in floating point for all ``distance`` x_j (n,), or None.

    Each x_j bounds it: |j h − (x_j − x_0)| is at most half a last digit of x_j and half one of j h.
    The roundest h comes first; where x_0 is large, many floats are as good.

    >>> exact_step(130_100.05 + 1 / 3 * np.arange(4000.0)) is not None
    True
    """
    count = np.arange(1.0, distance.size)
    off = distance[1:].astype(np.longdouble) - np.longdouble(distance[0])
    slack = (np.spacing(np.abs(distance[1:])) + np.spacing(np.abs(off.astype(np.float64)))) / 2
    low, high = np.max((off - slack) / count), np.min((off + slack) / count)
    if low > high:
        return None
    some = np.unique(np.linspace(0, distance.size - 1, _SAMPLE).astype(np.int64))
    for step in _candidates(float(low), float(high), float(distance[1] - distance[0])):
        if _fits(step, distance, some) and _fits(step, distance, np.arange(distance.size)):
            return step
    return None


def _candidates(low: float, high: float, first: float) -> Iterator[float]:
    """Steps within the bounds: round ones, the first itself, then from the middle outwards."""
    middle = (low + high) / 2
    yield from (float(f"{middle:.{digits}g}") for digits in _ROUND)
    yield first
    up = down = middle
    for _ in range(_MOST // 2):
        yield up
        yield down
        up, down = float(np.nextafter(up, np.inf)), float(np.nextafter(down, 0.0))
        if down < low and up > high:
            return


def _fits(step: float, distance: FloatArray, places: NDArray[np.int64]) -> bool:
    """Whether the distances at some places are what a track of that step has there."""
    return bool(np.array_equal(distance[0] + step * places, distance[places]))
