r"""The path that closes a band of frequencies: along a ray to infinity.

Let F(s) be real on the real axis, with a density Re F on the imaginary one, and fall towards
infinity to its right. Then, with ω = 2πf,

.. math:: \int_{f_1}^{f_2} \mathrm{Re}\, F(i\omega)\, df = -\frac{1}{2} \sum_q \mathrm{Res}_q\, F
          - \frac{1}{2\pi}\, \mathrm{Im} \int_{i\omega_2}^{\infty} F\, ds
          - \int_0^{f_1} \mathrm{Re}\, F(i\omega)\, df

over the poles q to the right that lie below the ray from iω_2 and above its mirror image. Those of
higher modes, however lightly damped, lie beyond and are left out as they are. What the ray and the
lowest frequencies hold is little, and Gauss's rule takes it on panels that shrink towards poles.
Where Φ is infinite at rest, as of elevations that grow without end, a quarter of a circle leads
from ω_1 to iω_1 about that, in place of the axis, and poles within it are left out too.

Here F = K Φ, K of the vehicle (:mod:`railride.stochastic.residues`) and Φ, even in s, of spectrum
and weighting.

Source: H.M. James, N.B. Nichols, R.S. Phillips, Theory of Servomechanisms, McGraw-Hill 1947,
Chapter 7 (mean squares by residues); D. Huybrechs, S. Vandewalle, SIAM J. Numer. Anal. 44 (2006)
1026-1048 (the path that leaves an oscillation behind).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railride.numeric import Array
from railride.stochastic.gains import Complex, Gain
from railride.stochastic.quadrature import REACH, distances, gauss_points, graded_panels

POINTS = 10  # on every panel
RAY = 1 + 1j  # direction: away from the weightings' poles, below those of higher modes
FALLING = (0.8, 6.0)  # the ray's panels, iω_2 + ω_2 RAY y: y of the last, from one to the next
LEVEL = (4.8, 3.0)  # where F falls as slowly as may be, and what its lags leave is felt more
_DECAY = 3.0  # of the longest lag's exponential, over the shortest panel
_ON = 1e-9  # of its size: a pole so near to the path is on it
_NONE = np.zeros(0, dtype=complex)


@dataclass(frozen=True, eq=False)
class Contour:
    """Where K is needed for one speed, and with what it counts.

    densities : Φ of every gain. corner : ω_2.
    points : s (N,), poles of Φ first, then those on panels. weights : (gains, N, 1); what is not
    the vehicle's poles' is Re Σ weights · K. along, low : edges of the panels of the ray, u with s
    = iω_2 + ω_2 RAY u/(1 - u), and of those from 0 to f_1, Hz, or about 0, rad. df : of the points
    on panels. inner : ω_1 where the path leads about 0, else 0.
    """

    densities: tuple[Gain, ...]
    corner: float
    points: Complex
    weights: Complex
    along: Array
    low: Array
    df: Array
    inner: float

    def density(self, s: Complex) -> Complex:
        """Φ of every gain, (gains, ...)."""
        return _density(self.densities, s)

    def holds(self, q: Complex) -> NDArray[np.bool_]:
        """Whether poles to the right of the axis are enclosed by the path and its mirror image."""
        return _enclosed(q, self.corner, self.inner)

    def touches(self, q: Complex) -> NDArray[np.bool_]:
        """Whether poles are on the path, so that there is no telling on which side."""
        on_ray = np.abs(np.abs(q.imag) - RAY.imag * q.real - self.corner) < _ON * self.corner
        return np.asarray(on_ray | (np.abs(np.abs(q) - self.inner) < _ON * self.inner))

    def resolves(self, q: Complex) -> bool:
        """Whether panels are short enough beside these poles of K."""
        beside = (self.along, _along(q, self.corner)), (self.low, _low(q, self.inner))
        for edges, poles in beside:
            away = distances(edges[:-1], edges[1:], poles)
            if (np.diff(edges) > REACH * away * (1 + 1e-9)).any():
                return False
        return True

    @property
    def lengths(self) -> Array:
        """Of the panels."""
        return np.concatenate([np.diff(self.along), np.diff(self.low)])


def contour(
    densities: tuple[Gain, ...],
    lag: float,
    band: tuple[float, float],
    q: Complex,
    panels: tuple[float, float] = FALLING,
) -> Contour:
    """The contour of a band, Hz, whose panels shrink towards the poles q of K where they must.

    lag : from the first wheelset to the last, s. panels : of the ray, :data:`FALLING`, or
    :data:`LEVEL` where F falls as s⁻² only.
    """
    usual = _usual(densities, lag, band, panels)
    return usual if usual.resolves(q) else _contour(densities, lag, band, q, panels)


@lru_cache(maxsize=64)
def _usual(
    densities: tuple[Gain, ...],
    lag: float,
    band: tuple[float, float],
    panels: tuple[float, float],
) -> Contour:
    """The contour that most vehicles share, its panels shrinking towards the poles of Φ alone."""
    return _contour(densities, lag, band, _NONE, panels)


def _contour(
    densities: tuple[Gain, ...],
    lag: float,
    band: tuple[float, float],
    q: Complex,
    panels: tuple[float, float],
) -> Contour:
    """The contour with panels that shrink towards the poles of Φ and q, and to the longest lag."""
    corner = 2 * np.pi * band[1]
    of_Phi = 2j * np.pi * np.concatenate([density.poles for density in densities])
    q = np.concatenate([q, of_Phi, -of_Phi, of_Phi.conj(), -of_Phi.conj()])
    far = [panels[0]]
    while far[-1] * corner * lag > _DECAY:
        far.append(far[-1] / panels[1])
    ends = [0.0, *(y / (1 + y) for y in reversed(far)), 1.0]
    along = graded_panels(ends, _along(q, corner), 1.0)
    u, du = gauss_points(along, POINTS)
    ray = corner * (1j + RAY * u / (1 - u))
    low, period = np.zeros(1), 1 / max(lag, 1 / band[0]) if band[0] > 0 else 0.0
    inner = 2 * np.pi * band[0] if any(0 in density.square_poles for density in densities) else 0.0
    if inner:
        low = graded_panels([0.0, np.pi / 2], _low(q, inner), period / band[0])
    elif period:
        low = graded_panels([0.0, band[0]], _low(q, inner), period)
    f, df = gauss_points(low, POINTS)
    axis = inner * np.exp(1j * f) if inner else 2j * np.pi * f
    on_axis = -_density(densities, axis) * df * (axis / (2 * np.pi) if inner else 1.0)
    own, weights = _poles(densities, corner, inner)
    on_ray = 0.5j / np.pi * corner * RAY * du / (1 - u) ** 2 * _density(densities, ray)
    return Contour(
        densities,
        corner,
        np.concatenate([own, ray, axis]),
        np.hstack([weights, on_ray, on_axis])[..., np.newaxis],
        along,
        low,
        np.concatenate([du, df]),
        inner,
    )


def _enclosed(q: Complex, corner: float, inner: float) -> NDArray[np.bool_]:
    """Whether q is below the ray, above its mirror image, and beyond the circle about 0."""
    within = np.abs(q.imag) < corner + RAY.imag * q.real
    return np.asarray(within & (np.abs(q) > inner) if inner else within)


def _low(q: Complex, inner: float) -> Complex:
    """Poles as frequencies along the axis, Hz, or as angles along the circle, rad."""
    return np.asarray(-1j * np.log(q[q != 0] / inner) if inner else q / 2j / np.pi)


def _along(q: Complex, corner: float) -> Complex:
    """Poles as u along the ray, which they are beside."""
    y = (q / corner - 1j) / RAY
    return np.asarray(y[y != -1] / (1 + y[y != -1]))


def _density(densities: Sequence[Gain], s: NDArray[Any]) -> Complex:
    x = s * s / (-4 * np.pi**2)
    return np.stack([density.at(x) for density in densities])


def _poles(densities: Sequence[Gain], corner: float, inner: float) -> tuple[Complex, Complex]:
    """Φ's poles s with Re s > 0 and 0 ≤ Im s that are enclosed, (M,); their weights, (gains, M).

    Of those above the real axis, the conjugate has the same share. The residue in s is -2π²/s times
    that in x = -s²/4π².
    """
    found, weights = [], []
    for number, density in enumerate(densities):
        b = np.array(density.square_poles, dtype=complex)
        s = 2j * np.pi * np.sqrt(b)
        s = np.where(s.real < 0, -s, s)
        top = Gain(density.factor, density.square_zeros).at(b)
        residue = top / np.prod(b[:, np.newaxis] - b + np.eye(b.size), axis=1)
        weight = np.pi**2 * residue / s * np.where(s.imag > 0, 2, 1)
        weight[s.real <= 0] = np.nan  # on the path itself: no value at all
        below = (s.imag >= 0) & _enclosed(s, corner, inner)
        rows = np.zeros((len(densities), below.sum()), dtype=complex)
        rows[number] = weight[below]
        found.append(s[below])
        weights.append(rows)
    return np.concatenate(found), np.hstack(weights)
