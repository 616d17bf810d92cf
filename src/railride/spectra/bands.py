"""Of a spectrum: the r.m.s. in a wavelength band, and what a wheel at a speed meets of it."""

from __future__ import annotations

from collections.abc import Callable
from math import pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from railride.spectra.density import FloatArray, Spectrum, check_band, check_speed

_PANEL = 0.3  # of ln Omega
_POINTS = 12


def band_rms(spectrum: Spectrum, wavelength_low: float, wavelength_high: float) -> float:
    """R.m.s. of the level in a wavelength band: √∫ S(Omega) dOmega, m.

    From 2π/``wavelength_high`` to 2π/``wavelength_low`` (m). Where the band reaches beyond the
    spectrum's own, the spectrum adds nothing there: :meth:`Spectrum.covers` says whether it does.

    By Gauss's rule over ln Omega, in panels of an eighth of a decade at most that end where the
    spectrum breaks: there a power law is an exponential, and the poles of the shipped spectra,
    on or left of the imaginary axis, lie at least π/2 off.

    Raises InputError where the wavelengths are no band.

    >>> from railride.spectra import D1, spectrum
    >>> round(1000 * band_rms(spectrum("erri_low"), *D1), 3)  # mm
    0.984
    """
    check_band((wavelength_low, wavelength_high), "wavelength band")
    low, high = spectrum.limits
    start, end = max(2.0 * pi / wavelength_high, low), min(2.0 * pi / wavelength_low, high)
    if start >= end:
        return 0.0
    marks = np.log([start, *(mark for mark in spectrum.breakpoints if start < mark < end), end])
    panels = np.ceil(np.diff(marks) / _PANEL).astype(int)
    edges = np.concatenate(
        [*(np.linspace(a, b, count, endpoint=False)
           for a, b, count in zip(marks, marks[1:], panels, strict=False)), marks[-1:]]
    )  # fmt: skip
    half = np.diff(edges)[:, np.newaxis] / 2.0
    points, weights = np.polynomial.legendre.leggauss(_POINTS)
    Omega = np.exp(edges[:-1, np.newaxis] + half * (1.0 + points))  # dOmega = Omega d(ln Omega)
    return sqrt(float(np.sum(half * weights * Omega * spectrum.density(Omega))))


def temporal(spectrum: Spectrum, speed: float) -> Callable[[ArrayLike], FloatArray]:
    """Spectrum of the level under a wheel at ``speed`` V: S(f) = 2π/V · S(Omega = 2πf/V).

    ``speed`` in m/s; the answer takes frequencies (Hz, any shape) and gives the one-sided density
    in m²/Hz. From S(f) df = S(Omega) dOmega with Omega = 2πf/V.

    Raises InputError unless the speed is finite and above zero.

    >>> from railride.spectra import spectrum
    >>> S = temporal(spectrum("erri_low"), 40.0)
    >>> float(S(4.0) * 40.0 / (2 * pi) / spectrum("erri_low").density(2 * pi / 10.0))
    1.0
    """
    check_speed(speed)
    per_hertz = 2.0 * pi / speed

    def density(frequency: ArrayLike) -> FloatArray:
        return per_hertz * spectrum.density(per_hertz * np.asarray(frequency, dtype=np.float64))

    return density


def covered_hz(band: tuple[float, float], speed: float) -> tuple[float, float]:
    """Frequencies f = V/wavelength (Hz) that a wavelength ``band`` (m) covers at ``speed`` (m/s).

    Raises InputError for a band or speed that is none.

    >>> from railride.spectra import D1
    >>> [round(f, 1) for f in covered_hz(D1, 145 / 3.6)]
    [1.6, 13.4]
    """
    check_band(band, "wavelength band")
    check_speed(speed)
    return speed / band[1], speed / band[0]


def coverage_remark(name: str, band: tuple[float, float] | None, *speeds: float) -> str | None:
    """Sentence naming the frequencies that a track or spectrum covers; None if it has no band.

    ``name``: of the track or spectrum; ``band``: its wavelengths, m; ``speeds``: m/s, of which
    the lowest and the highest are named (both ends of the band grow with the speed).

    >>> coverage_remark("sncf_good", (2.0, 40.0), 40.0)
    'sncf_good holds wavelengths of 2 to 40 m only: at 144 km/h 1 to 20 Hz; nothing outside'
    >>> coverage_remark("sncf_good", (2.0, 40.0), 40.0, 60.0, 80.0).split(": ")[1]
    'at 144 km/h 1 to 20 Hz, rising to 2 to 40 Hz at 288 km/h; nothing outside'
    """
    if band is None or not speeds:
        return None
    slow, fast = min(speeds), max(speeds)
    (low, high), (low_fast, high_fast) = covered_hz(band, slow), covered_hz(band, fast)
    rising = f", rising to {low_fast:.3g} to {high_fast:.3g} Hz at {fast * 3.6:.4g} km/h"
    return (
        f"{name} holds wavelengths of {band[0]:g} to {band[1]:g} m only: at {slow * 3.6:.4g} km/h "
        f"{low:.3g} to {high:.3g} Hz{rising if fast > slow else ''}; nothing outside"
    )
