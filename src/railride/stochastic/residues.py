r"""Mean squares over rational spectra in closed form, of many vehicles at once.

With the delays τ_i of the wheelsets and their responses g_i (:mod:`railride.stochastic.fractions`),

.. math:: \Big|\sum_i e^{-i\omega\tau_i} g_i\Big|^2 = \mathrm{Re}\, K(i\omega), \qquad
          K(s) = \sum_{\tau_i \ge \tau_j} c_{ij}\, e^{-s(\tau_i - \tau_j)} g_i(s)\, g_j(-s),
          \qquad c_{ii} = 1, \quad c_{ij} = 2,

so that every lag falls to the right of the imaginary axis, where K has the poles -p_k of g_j(-s):
the residue there is that of K with -r_jk in place of g_j(-s). With Φ(s), |s^p|² |W|² S_w on the
axis, the mean square is an integral as :mod:`railride.stochastic.contour` closes it.

The error stated is that of the rule on the contour's panels, of rounding in the sums, of the poles,
as far as rounding moves them, and of the fractions, checked at the resonances of the modes that
count most.

Source: D.E. Newland, Random Vibrations, Spectral and Wavelet Analysis, 3rd ed., Appendix 1 (mean
squares of rational spectra), with the delays and the band added.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from railride.numeric import Array, Matrices
from railride.spectra import Spectrum
from railride.stochastic.contour import FALLING, LEVEL, POINTS, Contour, contour
from railride.stochastic.fractions import (
    EigenForms,
    PartialFractions,
    eigen_forms,
    partial_fractions,
)
from railride.stochastic.gains import Complex, Gain, rational
from railride.stochastic.process import UNDAMPED, covered_band
from railride.stochastic.quadrature import gauss_errors

CHECKED = 4  # modes of each vehicle at whose resonances its fractions are checked
_CAUTION = 4.0  # factor on what the check finds
_TOGETHER = 64  # vehicles at a time: what the processor keeps close by
_EPSILON = float(np.finfo(float).eps)


def residue_squares(
    m: Matrices,
    rows: Mapping[str, Array],
    places: ArrayLike,
    speeds: Sequence[float],
    spectrum: Spectrum,
    gains: Sequence[Gain],
    band: tuple[float, float],
    forms: EigenForms | None = None,
) -> tuple[Array, Array] | None:
    """Mean squares and their estimated relative errors, (vehicles, speeds, gains, outputs).

    Arguments as for :func:`railride.stochastic.squares.mean_squares`. The error is infinite or NaN
    where there is no trustworthy value: a mode without damping, or one that grows.

    Returns
    -------
    squares, errors : None where the spectrum is not rational, a density does not fall towards
        infinity, or ``places`` are in no order.
    """
    places = np.asarray(places, dtype=float)
    tracks = [rational(spectrum, V) for V in speeds]
    if None in tracks or (np.diff(places) > 0).any():
        return None
    with np.errstate(all="ignore"):  # what comes of it is not finite, and not trusted
        g = partial_fractions(forms or eigen_forms(m), rows)
        densities = [_densities(S_w, g.power, tuple(gains)) for S_w in tracks if S_w is not None]
        growth = g.direct.shape[1]
        fall = min(len(Phi.square_poles) - len(Phi.square_zeros) for Phi in densities[0]) - growth
        if fall < 0:  # F falls as s^(-2 fall - 2)
            return None
        bands = [covered_band(spectrum, V, band) for V in speeds]
        ray, found = FALLING if fall else LEVEL, []
        for start in range(0, len(g.poles), _TOGETHER):
            some = g[start : start + _TOGETHER]
            q = np.concatenate([some.poles, -some.poles], axis=None)
            q = q[q.imag >= 0]  # beside the path
            ahead = -np.diff(places[start : start + _TOGETHER] if places.ndim > 1 else places)
            gaps = [ahead[..., np.newaxis, :] / V for V in speeds]
            lags = [_longest(gap) for gap in gaps]
            paths = [contour(*of, q, ray) for of in zip(densities, lags, bands, strict=True)]
            found.append(_squares(some, gaps, paths))
    squares, errors = zip(*found, strict=True)
    return np.concatenate(squares), np.concatenate(errors)


@lru_cache(maxsize=64)
def _densities(S_w: Gain, power: int, gains: tuple[Gain, ...]) -> tuple[Gain, ...]:
    """Φ of every gain."""
    motion = Gain((4 * np.pi**2) ** power, (0.0,) * power)
    return tuple(S_w * motion * gain for gain in gains)


def _longest(gaps: Array) -> float:
    """The longest of the lags of wheelsets (..., wheelsets - 1), s; of many, as good as that."""
    lag = float(gaps.sum(axis=-1).max())
    if gaps.ndim < 3 or not lag:
        return lag
    digit = 10 ** (np.floor(np.log10(lag)) - 1)  # few contours for many lags
    return float(np.ceil(lag / digit) * digit)


def _squares(
    g: PartialFractions, gaps: Sequence[Array], paths: Sequence[Contour]
) -> tuple[Array, Array]:
    """Mean squares and relative errors, (D, speeds, gains, outputs).

    gaps : delays from one wheelset to the next, s, (1, wheelsets - 1) or (D, 1, wheelsets - 1).
    """
    mirrored = g.response(-g.poles)
    each = [_integrals(g, mirrored, *of) for of in zip(gaps, paths, strict=True)]
    squares, errors, shares = (np.stack(part, axis=1) for part in zip(*each, strict=True))
    largest = (shares / np.abs(squares)[..., np.newaxis, :]).max(axis=(1, 2, 4))
    largest[g.poles.imag < 0] = 0.0  # as large as their conjugates
    vehicle, checked = np.arange(len(largest))[:, np.newaxis], np.argsort(-largest)[:, :CHECKED]
    off = g.mismatch(1j * np.abs(g.poles[vehicle, checked]))  # of g: twice of its square
    shares = shares[vehicle, :, :, checked]  # (D, modes, speeds, gains, outputs), of one of a pair
    errors += 4 * _CAUTION * (shares * off[:, :, np.newaxis, np.newaxis]).sum(axis=1)
    errors /= np.abs(squares)
    for path in paths:
        errors[path.touches(-g.poles).any(axis=-1)] = np.inf
    errors[(-g.poles.real <= UNDAMPED * np.abs(g.poles)).any(axis=-1)] = np.inf
    return squares, errors


def _integrals(
    g: PartialFractions, mirrored: Complex, gaps: Array, path: Contour
) -> tuple[Array, Array, Array]:
    """Mean squares, their errors but for those of g, (D, gains, outputs), and the poles' shares.

    mirrored : g at -p. Shares : their absolute values, (D, gains, s, outputs).
    """
    s, N = path.points, path.points.size
    there = g.response(np.concatenate([s, -s]))
    K = _pairs(there[:, :N], there[:, N:], np.exp(-s[:, np.newaxis] * gaps))
    parts = (path.weights * K[:, np.newaxis]).real
    K = _pairs(mirrored, g.apart(g.residues), np.exp(g.poles[..., np.newaxis] * gaps))
    half = 0.5 * path.holds(-g.poles) * path.density(g.poles)
    shares = np.moveaxis(half, 0, 1)[..., np.newaxis] * K[:, np.newaxis]
    size, lengths = np.abs(shares), path.lengths
    on_panels = np.moveaxis(parts[:, :, -path.df.size :], 2, 3) / path.df
    by_panel = on_panels.reshape(*on_panels.shape[:-1], lengths.size, POINTS)
    errors = gauss_errors(by_panel, lengths).sum(axis=-1)
    errors += 10 * _EPSILON * np.abs(parts).sum(axis=2)
    moved = 10 * _EPSILON + _CAUTION * g.moved / np.abs(g.poles.real)
    errors += np.einsum("dgso,ds->dgo", size, moved)
    return parts.sum(axis=2) + shares.sum(axis=2).real, errors, size


def _pairs(later: Complex, earlier: Complex, lag: Complex) -> Complex:
    """Σ c_ij e^{-s(τ_i - τ_j)} later_i earlier_j over τ_i ≥ τ_j, (D, N, outputs).

    later, earlier : (D, N, outputs, wheelsets). lag : e^{-s(τ_i - τ_{i-1})}, (..., N, wheelsets -
    1), by which what the wheelsets ahead excite is carried on to the next.
    """
    lag, carried = lag[..., np.newaxis, :], earlier[..., 0]
    total = later[..., 0] * carried
    for i in range(1, earlier.shape[-1]):
        carried = carried * lag[..., i - 1]
        total += later[..., i] * (earlier[..., i] + 2 * carried)
        carried += earlier[..., i]
    return total
