r"""Integrals over frequency of what is smooth but for its poles.

Panels shrink towards each pole as far as it is from the real axis (a mode of damping ratio 2e-6
included), and Gauss's rule converges geometrically on each. How fast, the Legendre coefficients
c_k of the integrand on a panel tell from the same points: where they decay as ρ^-k, the rule of n
points, exact up to the order 2n - 1, is wrong by the order of

.. math:: (b - a)\, |c_{2n}| \approx (b - a)\, |c_{n-1}|\, \rho^{-(n+1)},

ρ from the last few coefficients, or from the last and the largest: either may be misled by a zero.

Source: L.N. Trefethen, Approximation Theory and Approximation Practice, SIAM 2013, Theorem 19.3
(Gauss's rule beside a pole) and Chapter 8 (decay of the coefficients).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from math import hypot

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError
from railride.numeric import Array

GAUSS_POINTS = 12
REACH = 1.5  # longest panel, in distances from it to the nearest pole
TINY = 1e-12  # of the highest frequency: what lies so close to a pole on the axis is not resolved
MOST_PERIODS = 1e6  # of the integrand over the band: a speed of 0.006 km/h for a coach
SHARP = 1e-2  # of the longest panel: poles that are closer to the axis
_CAUTION = 8.0  # factor on the estimated error
_TAIL = 3  # coefficients that tell how fast they decay: even and odd ones are not alike


def graded_panels(ends: Sequence[float], poles: NDArray[np.complex128], period: float) -> Array:
    """Edges of panels that shrink towards poles.

    Parameters
    ----------
    ends : ascending; the integrand is smooth between two of them.
    poles : in the complex plane of f; each acts with its mirror image in the real axis.
    period : of the fastest oscillation of the integrand along f; no panel is longer.

    Returns
    -------
    array : ascending edges; every panel is at most :data:`REACH` times as long as it is away from
        the nearest pole.

    Raises
    ------
    InputError : an integrand that oscillates too often over the band to be integrated.
    """
    if not (ends[-1] - ends[0]) / period <= MOST_PERIODS:
        raise InputError(
            f"speed: found one so low that the wheelsets' delays of {1 / period:.3g} s turn the "
            f"response {(ends[-1] - ends[0]) / period:.1e} times over the band; expected at most "
            f"{MOST_PERIODS:.0e} (a higher speed)"
        )
    tiny = TINY * ends[-1]
    marks = np.sort(np.concatenate([ends, *_around_sharp(poles, ends, period, tiny)]))
    marks = np.concatenate([marks[:-1][np.diff(marks) > tiny / 2], marks[-1:]])
    length = np.diff(marks)
    pieces = np.ceil(length / period * (1 - 1e-12)).astype(int)
    number = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    start, step = np.repeat(marks[:-1], pieces), np.repeat(length / pieces, pieces)
    a, b = start + number * step, start + (number + 1) * step
    poles = poles[REACH * np.abs(poles.imag) < step.max()]  # no panel is too long for the others
    done: list[Array] = []
    while a.size:
        fits = b - a <= np.maximum(REACH * distances(a, b, poles) * (1 + 1e-9), tiny)
        done.append(a[fits])
        a, b = a[~fits], b[~fits]
        middle = (a + b) / 2
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    return np.concatenate([np.sort(np.concatenate(done)), ends[-1:]])


def _around_sharp(
    poles: NDArray[np.complex128], ends: Sequence[float], period: float, tiny: float
) -> list[list[float]]:
    """Edges on both sides of poles close to the axis, as far apart as the rule allows.

    Halving panels over and over would find such edges too, but more of them and more slowly.
    """
    found = []
    for pole in poles[np.abs(poles.imag) < SHARP * period].tolist():
        away = max(abs(pole.imag), tiny)
        offset, marks = REACH * away / 2, []
        while offset < period:
            marks += [x for x in (pole.real - offset, pole.real + offset) if ends[0] < x < ends[-1]]
            offset += REACH * hypot(offset, away)
        found.append(marks)
    return found


def distances(a: Array, b: Array, poles: NDArray[np.complex128]) -> Array:
    """How far each panel from a to b (P,) is from the nearest pole."""
    if not poles.size:
        return np.full(a.shape, np.inf)
    x, y = poles.real[:, np.newaxis], poles.imag[:, np.newaxis]
    beside = np.maximum(np.abs((a + b) / 2 - x) - (b - a) / 2, 0.0)
    return np.asarray(np.sqrt((beside * beside + y * y).min(axis=0)))


def gauss_points(edges: Array, points: int | None = None) -> tuple[Array, Array]:
    """Points and weights of Gauss's rule on every panel, each of shape (panels · points,).

    points : on every panel, default :data:`GAUSS_POINTS`.
    """
    x, w, _ = _rule(points or GAUSS_POINTS)
    half = np.diff(edges)[:, np.newaxis] / 2
    middle = (edges[:-1] + edges[1:])[:, np.newaxis] / 2
    return (middle + half * x).ravel(), (half * w).ravel()


def gauss_errors(values: Array, length: ArrayLike) -> Array:
    """Estimated error of Gauss's rule on every panel, shape (..., P).

    values : the integrand at each panel's points, (..., P, points). length : of the panels.
    """
    _, _, last = _rule(values.shape[-1])
    c = np.abs(values @ last)
    before, tail = c[..., :_TAIL].max(axis=-1), c[..., _TAIL:].max(axis=-1)
    largest, tiny = np.abs(values).max(axis=-1), np.finfo(float).tiny
    times = (values.shape[-1] + 1) / _TAIL
    lately = np.minimum(tail / np.maximum(before, tiny), 1.0) ** times
    overall = np.minimum(tail / np.maximum(largest, tiny), 1.0)
    return np.asarray(_CAUTION * np.asarray(length) * tail * np.minimum(lately, overall))


@lru_cache(maxsize=16)
def _rule(points: int) -> tuple[Array, Array, Array]:
    """Points and weights on [-1, 1]; values → the last Legendre coefficients, (points, 2 _TAIL)."""
    x, w = np.polynomial.legendre.leggauss(points)
    orders = np.arange(points)
    to_coefficients = np.polynomial.legendre.legvander(x, points - 1) * w[:, np.newaxis]
    to_coefficients = to_coefficients * (orders + 0.5)
    return x, w, to_coefficients[:, -2 * _TAIL :]
