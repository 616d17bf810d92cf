"""Track spectra: how much longitudinal level a track has at each wavenumber.

Symbols: Omega = 2π/wavelength, angular wavenumber (rad/m); n = 1/wavelength, wavenumber (1/m);
S(Omega), one-sided power spectral density of the level (m²/(rad/m)), so that

    mean square of the level = ∫₀^∞ S(Omega) dOmega.

Every spectrum is kept as its source prints it, with the unit and the sidedness printed there, and
is converted in one place, :meth:`Spectrum.density`: cycles against radians cost a factor 2π,
centimetres against metres 1e4, one- against two-sided 2.

Sources: as read from published compilations of the ERRI/ORE B176, FRA, SNCF and Chinese spectra;
each :class:`Spectrum` names its own.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf, isfinite, log, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError

FloatArray = NDArray[np.float64]

D1 = (3.0, 25.0)
"""Wavelength band D1 of EN 13848-1, m."""
D2 = (25.0, 70.0)
"""Wavelength band D2 of EN 13848-1, m."""
D3 = (70.0, 150.0)
"""Wavelength band D3 of EN 13848-1 for the longitudinal level, m."""

# Unit in print -> (what the formula's argument is per Omega, m²/(rad/m) per printed unit).
# A density over n becomes one over Omega by S(Omega) dOmega = S(n) dn, dn = dOmega/2π.
_UNITS = {
    "m^2/(rad/m)": (1.0, 1.0),
    "cm^2/(rad/m)": (1.0, 1e-4),
    "m^2/(1/m)": (1.0 / (2.0 * pi), 1.0 / (2.0 * pi)),
    "mm^2/(1/m)": (1.0 / (2.0 * pi), 1e-6 / (2.0 * pi)),
}
_SIDES = {"one-sided": 1.0, "two-sided": 2.0}
_EDGE = 1e-12  # a band's edges belong to it, whatever the rounding of 2π/wavelength


@dataclass(frozen=True)
class Spectrum:
    """S(Omega) = sides · scale · formula(argument · Omega) inside the band, zero outside it.

    ``formula``: density as printed, over the printed wavenumber, in the printed ``unit`` (a key of
    the conversion table) and ``sidedness`` ("one-sided" or "two-sided"); it takes arrays.
    ``band``: the shortest and the longest wavelength (m) it was stated for, or None.
    ``poles``: complex wavenumbers (rad/m) where the expression for Omega > 0 is singular, if it is
    rational: an integral over Omega has its fine detail near them. They come as ± pairs where the
    expression is rational in Omega² (only then may one integrate by residues).
    ``breakpoints``: wavenumbers (rad/m) between which it is smooth.
    ``extrapolate``: continue the formula beyond the band.

    Raises InputError for an unknown unit or sidedness, a band that is not one, a density that is
    not finite and positive over wavelengths from 0.1 to 1000 m, and a pole that is none.
    """

    name: str
    source: str
    unit: str
    sidedness: str
    formula: Callable[[NDArray[np.inexact]], NDArray[np.inexact]]
    band: tuple[float, float] | None = None
    poles: tuple[complex, ...] = ()
    breakpoints: tuple[float, ...] = ()
    extrapolate: bool = False

    def __post_init__(self) -> None:
        """Check the identities that every spectrum must meet."""
        for value, known, what in (
            (self.unit, _UNITS, "unit"),
            (self.sidedness, _SIDES, "sidedness"),
        ):
            if value not in known:
                raise InputError(
                    f"spectrum {self.name}: {what}: found {value!r}; expected one of "
                    + ", ".join(known)
                )
        if self.band is not None:
            check_band(self.band, f"spectrum {self.name}: band")
        probe = 2.0 * pi / np.geomspace(1000.0, 0.1, 81)
        if not np.all(np.isfinite(self._printed(probe)) & (self._printed(probe).real > 0.0)):
            raise InputError(
                f"spectrum {self.name}: found a density that is negative, zero or not finite "
                "between wavelengths of 0.1 and 1000 m; expected a positive one"
            )
        for pole in self.poles:
            # One part in a million beside a pole the density is far above its size on the axis.
            size = abs(pole) or 1.0
            beside = self._printed(np.array([pole + 1e-6j * size, pole + 1e-6 * size]))
            if not np.all(np.abs(beside) > 1e3 * np.abs(self._printed(np.array([size])))):
                raise InputError(f"spectrum {self.name}: {pole} rad/m is not a pole of its formula")

    def _printed(self, wavenumber: NDArray[np.inexact]) -> NDArray[np.inexact]:
        """One-sided density in m²/(rad/m), regardless of the band."""
        argument, scale = _UNITS[self.unit]
        with np.errstate(divide="ignore"):  # S ~ 1/Omega² is infinite at Omega = 0
            return _SIDES[self.sidedness] * scale * self.formula(wavenumber * argument)

    @property
    def limits(self) -> tuple[float, float]:
        """Lowest and highest wavenumber (rad/m) where the density is not zero; (0, inf) if all."""
        if self.band is None or self.extrapolate:
            return 0.0, inf
        return 2.0 * pi / self.band[1], 2.0 * pi / self.band[0]

    @property
    def active_band(self) -> tuple[float, float] | None:
        """Wavelengths (m) outside which the density is zero; None where it never is."""
        return None if self.extrapolate else self.band

    def density(self, wavenumber: ArrayLike) -> FloatArray:
        """One-sided power spectral density S(Omega), m²/(rad/m).

        ``wavenumber``: Omega ≥ 0, rad/m, any shape, which the answer has too. The edges of the
        band belong to it. Infinite at Omega = 0 for spectra that grow as 1/Omega².

        Raises InputError for wavenumbers that are negative or not finite.

        >>> float(spectrum("erri_high").density(2 * pi * 0.02)) * 2 * pi  # m²/(1/m), table 4.09e-4
        0.00040897...
        """
        Omega = np.asarray(wavenumber, dtype=np.float64)
        if not np.all(np.isfinite(Omega) & (Omega >= 0.0)):
            raise InputError(
                f"spectrum {self.name}: found a wavenumber that is negative or not finite; "
                "expected rad/m of a one-sided spectrum, 0 or more"
            )
        low, high = self.limits
        within = (low * (1.0 - _EDGE) <= Omega) & (high * (1.0 + _EDGE) >= Omega)
        return np.where(within, self._printed(Omega).real, 0.0)

    def extrapolated(self) -> Spectrum:
        """Continue the same formula beyond the band it was stated for."""
        return replace(self, extrapolate=True)

    def covers(self, wavelength_low: float, wavelength_high: float) -> bool:
        """Whether the whole wavelength band (m) lies inside the spectrum's own."""
        low, high = self.active_band or (0.0, inf)
        return low * (1 - _EDGE) <= wavelength_low and wavelength_high <= high * (1 + _EDGE)


def check_band(band: tuple[float, float], where: str) -> None:
    """Raise InputError unless ``band`` is two wavelengths (m), 0 < shortest < longest."""
    low, high = band
    if not (isfinite(low) and isfinite(high) and 0.0 < low < high):
        raise InputError(
            f"{where}: found {low} to {high} m; expected two wavelengths, the shorter first, "
            "both finite and above zero"
        )


def check_speed(speed: float) -> None:
    """Raise InputError unless ``speed`` (m/s) is finite and above zero."""
    if not (isfinite(speed) and speed > 0.0):
        raise InputError(f"speed: found {speed} m/s; expected a finite speed above zero")


def _erri(name: str, Av: float) -> Spectrum:
    """S(Omega) = Av Oc²/((Omega² + Or²)(Omega² + Oc²)), Av in m² rad/m."""
    Or, Oc = 0.0206, 0.8246
    return Spectrum(
        name=name,
        source=f"ERRI/ORE B176, {name.removeprefix('erri_')} level",
        unit="m^2/(rad/m)",
        sidedness="one-sided",
        formula=lambda O: Av * Oc**2 / ((O**2 + Or**2) * (O**2 + Oc**2)),  # noqa: E741
        poles=(1j * Or, -1j * Or, 1j * Oc, -1j * Oc),
    )


def _fra(track_class: int, Av: float) -> Spectrum:
    """S(Omega) = k Av Oc²/(Omega² (Omega² + Oc²)), Av in cm² rad/m, k = 0.25."""
    k, Oc = 0.25, 0.8245
    return Spectrum(
        name=f"fra_{track_class}",
        source=f"FRA (Federal Railroad Administration), track class {track_class}",
        unit="cm^2/(rad/m)",
        sidedness="one-sided",
        formula=lambda O: k * Av * Oc**2 / (O**2 * (O**2 + Oc**2)),  # noqa: E741
        poles=(0j, 1j * Oc, -1j * Oc),
    )


def _sncf(name: str, A: float) -> Spectrum:
    """S(n) = 308e-6 A/(1 + n/0.0489)³, m²/(1/m), wavelengths of 2 to 40 m."""
    n0 = 0.0489
    return Spectrum(
        name=name,
        source=f"SNCF, {name.removeprefix('sncf_')} track",
        unit="m^2/(1/m)",
        sidedness="one-sided",
        formula=lambda n: 308e-6 * A / (1.0 + n / n0) ** 3,
        band=(2.0, 40.0),
        poles=(complex(-2.0 * pi * n0),),
    )


def _china_ballastless() -> Spectrum:
    """S(n) = A/n^k, mm²/(1/m), with A and k piecewise, wavelengths of 2 to 200 m."""
    edges = (0.0187, 0.0474, 0.1533)
    A = np.array([1.0544e-5, 3.5588e-3, 1.9784e-2, 3.9488e-4])
    k = np.array([3.3891, 1.9271, 1.3643, 3.4516])

    def formula(n: NDArray[np.inexact]) -> NDArray[np.inexact]:
        piece = np.searchsorted(edges, np.real(n), side="right")
        return np.asarray(A[piece] / n ** k[piece])

    return Spectrum(
        name="china_ballastless",
        source="Chinese high-speed ballastless track spectrum",
        unit="mm^2/(1/m)",
        sidedness="one-sided",
        formula=formula,
        band=(2.0, 200.0),
        breakpoints=tuple(2.0 * pi * edge for edge in edges),
    )


_FRA_AV = (1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339)  # cm² rad/m, classes 1 to 6
_SHIPPED = {
    shipped.name: shipped
    for shipped in (
        _erri("erri_low", 4.032e-7),
        _erri("erri_high", 1.080e-6),
        *(_fra(number, Av) for number, Av in enumerate(_FRA_AV, start=1)),
        _sncf("sncf_good", 0.509),
        _sncf("sncf_poor", 1.790),
        _china_ballastless(),
    )
}


def spectrum_names() -> tuple[str, ...]:
    """Names of the shipped spectra.

    >>> spectrum_names()[:2]
    ('erri_low', 'erri_high')
    """
    return tuple(_SHIPPED)


def spectrum(name: str | Spectrum) -> Spectrum:
    """Look a shipped spectrum up by its ``name``; what is a spectrum already stays as it is.

    Raises InputError for a name that there is not, listing those there are, the nearest first.

    >>> spectrum("erri_low").source
    'ERRI/ORE B176, low level'
    """
    if isinstance(name, Spectrum):
        return name
    if name in _SHIPPED:
        return _SHIPPED[name]
    near = difflib.get_close_matches(name.lower(), _SHIPPED, n=3, cutoff=0.5)
    names = [*near, *(other for other in _SHIPPED if other not in near)]
    raise InputError(
        f"track spectrum: found {name!r}; expected one of {', '.join(names)}"
        + (f" (did you mean {near[0]!r}?)" if near else "")
    )


def band_rms(spectrum: Spectrum, wavelength_low: float, wavelength_high: float) -> float:
    """R.m.s. of the level in a wavelength band: √∫ S(Omega) dOmega, m.

    From 2π/``wavelength_high`` to 2π/``wavelength_low`` (m). Where the band reaches beyond the
    spectrum's own, the spectrum adds nothing there: :meth:`Spectrum.covers` says whether it does.

    Raises InputError where the wavelengths are no band.

    >>> round(1000 * band_rms(spectrum("erri_low"), *D1), 3)  # mm
    0.984
    """
    from scipy.integrate import quad

    check_band((wavelength_low, wavelength_high), "wavelength band")
    low, high = spectrum.limits
    start, end = max(2.0 * pi / wavelength_high, low), min(2.0 * pi / wavelength_low, high)
    if start >= end:
        return 0.0
    marks = [start, *(mark for mark in spectrum.breakpoints if start < mark < end), end]

    def integrand(log_wavenumber: float) -> float:
        Omega = np.exp(log_wavenumber)  # dOmega = Omega d(log Omega)
        return float(Omega * spectrum.density(Omega))

    square = 0.0
    for a, b in pairwise(marks):
        square += quad(integrand, log(a), log(b), epsabs=0.0, epsrel=1e-11)[0]
    return sqrt(square)


def temporal(spectrum: Spectrum, speed: float) -> Callable[[ArrayLike], FloatArray]:
    """Spectrum of the level under a wheel at ``speed`` V: S(f) = 2π/V · S(Omega = 2πf/V).

    ``speed`` in m/s; the answer takes frequencies (Hz, any shape) and gives the one-sided density
    in m²/Hz. From S(f) df = S(Omega) dOmega with Omega = 2πf/V.

    Raises InputError unless the speed is finite and above zero.

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

    >>> [round(f, 1) for f in covered_hz(D1, 145 / 3.6)]
    [1.6, 13.4]
    """
    check_band(band, "wavelength band")
    check_speed(speed)
    return speed / band[1], speed / band[0]


def coverage_remark(name: str, band: tuple[float, float] | None, speed: float) -> str | None:
    """Sentence naming the frequencies that a track or spectrum covers; None if it has no band.

    ``name``: of the track or spectrum; ``band``: its wavelengths, m; ``speed``: m/s.

    >>> coverage_remark("sncf_good", (2.0, 40.0), 40.0)
    'sncf_good holds wavelengths of 2 to 40 m only: at 144 km/h 1 to 20 Hz; nothing outside'
    """
    if band is None:
        return None
    low, high = covered_hz(band, speed)
    return (
        f"{name} holds wavelengths of {band[0]:g} to {band[1]:g} m only: at {speed * 3.6:.4g} km/h "
        f"{low:.3g} to {high:.3g} Hz; nothing outside"
    )
