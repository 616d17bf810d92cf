r"""How a record would go on beyond its ends: linear prediction.

A filter needs to know what came before the first sample. Nothing at all, or a mirror image, makes a
transient there that can be larger than the record; a continuation of the record by its own
spectrum makes next to none for tones and a small one for noise::

    x_n = −Σ a_k x_(n−k),   k = 1 … p,

with the coefficients of Burg's method, which needs no window and is stable.

Source: J.P. Burg, Maximum Entropy Spectral Analysis, Stanford 1975; S.M. Kay, Modern Spectral
Estimation, 1988, Section 7.6; I. Kauppinen and K. Roth, Audio signal extrapolation, DAFx 2002.
"""

from __future__ import annotations

import math

import numpy as np

from railride.weightings.filters import FloatArray

ORDER = 64
"""p, coefficients: up to 32 tones."""

KNOWN = 10.0
"""s next to the end that the coefficients are found from: four periods of 0.4 Hz."""

FINEST = 1000.0
"""Hz: a faster record is predicted by means over more than one sample, as p samples of it would
hold no period of what it is rated for."""

_FLOOR = 1e-20
"""Of the mean square: what is left of a record that is fully predicted is rounding."""


def continued(swing: FloatArray, rate: float, count: int) -> FloatArray:
    """What follows a record about zero at ``rate`` Hz, led to zero over its second half: (count,).

    ``swing`` (n,), n ≥ 1. For what came before, give the record backwards.

    >>> whole = np.sin(0.3 * np.arange(250))
    >>> bool(np.allclose(continued(whole[:200], 100.0, 100)[:50], whole[200:], atol=1e-4))
    True
    """
    step = max(1, math.floor(rate / FINEST))
    known = swing[-max(math.ceil(KNOWN * rate), step) :]
    blocks = known.size // step
    means = known[known.size - blocks * step :].reshape(blocks, step).mean(axis=1)
    onward = predicted(means, count // step + 2)
    if step > 1:  # between the middles of the blocks, from the last known one on
        middles = (np.arange(-1, onward.size) + 0.5) * step - 0.5
        last = means[-1] if blocks else 0.0
        onward = np.interp(np.arange(count), middles, np.concatenate(([last], onward)))
    # Beyond what a record may swing to between its samples, rounding has got the better of it.
    most = 2 * float(np.max(np.abs(known)))
    return np.clip(onward[:count], -most, most) * _fade(count)


def predicted(row: FloatArray, count: int) -> FloatArray:
    """The next ``count`` values of ``row`` (n,) by linear prediction of order min(p, n/3)."""
    from scipy import signal

    coefficients = _burg(row, min(ORDER, row.size // 3))
    if coefficients.size == 1:
        return np.zeros(count)
    state = signal.lfiltic([1.0], coefficients, row[: -coefficients.size : -1])
    onward, _ = signal.lfilter([1.0], coefficients, np.zeros(count), zi=state)
    return np.asarray(onward, dtype=np.float64)


def _burg(row: FloatArray, order: int) -> FloatArray:
    """1, a_1 … a_p: both ways along the row, the least mean square of what is not predicted."""
    coefficients: FloatArray = np.ones(1)
    forward, backward = row[1:], row[:-1]
    floor = _FLOOR * float(row @ row)
    for _ in range(order):
        power = float(forward @ forward + backward @ backward)
        if power <= floor:
            break
        reflection = -2 * float(forward @ backward) / power
        padded = np.append(coefficients, 0.0)
        coefficients = padded + reflection * padded[::-1]
        forward, backward = (
            (forward + reflection * backward)[1:],
            (backward + reflection * forward)[:-1],
        )
    return coefficients


def _fade(count: int) -> FloatArray:
    """One over the first half, then a raised cosine to just above zero, shape (count,)."""
    place = (np.arange(1, count + 1) / (count + 1) - 0.5).clip(min=0.0)
    return 0.5 + 0.5 * np.cos(2 * np.pi * place)
