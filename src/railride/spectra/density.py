"""What a track spectrum is: a density with its unit and sidedness, the band it holds and its poles.

Every spectrum is kept as its source prints it and is converted in one place,
:meth:`Spectrum.density`: cycles against radians cost a factor 2π, centimetres against metres 1e4,
one- against two-sided 2. The symbols are those of :mod:`railride.spectra`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, isfinite, pi

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
STEEPEST = 0.02  # r.m.s. slope that no railway has: they have about 0.001
FLATTEST = 1e-5  # m, r.m.s. level that none has
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
    ``extrapolate``: continue the formula beyond the band. ``remarks``: what its user must know.
    Those of the package can be pickled: to go to other processes.

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
    remarks: tuple[str, ...] = ()

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

        >>> from railride.spectra import spectrum
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
    try:
        good = isfinite(speed) and speed > 0.0
    except (TypeError, ValueError):
        raise InputError(
            f"speed: found {speed!r}; expected a finite speed above zero, in m/s"
        ) from None
    if not good:
        raise InputError(f"speed: found {speed} m/s; expected a finite speed above zero")


def unit_doubts(level: float, slope: float, column: str) -> list[str]:
    """Remarks on a level that a slip of the unit would explain.

    ``level``: its r.m.s., m; ``slope``: the r.m.s. of its slope, m/m; ``column``: what it was read
    from.

    >>> unit_doubts(1e-6, 1e-6, "level_mm")
    ["the r.m.s. level is only 0.001 mm: is the unit of 'level_mm' right?"]
    """
    remarks = []
    if slope > STEEPEST:
        remarks.append(
            f"the r.m.s. slope is {slope:.2g}, far above any railway's (about 0.001): is the "
            f"unit of {column!r} right?"
        )
    if 0.0 < level < FLATTEST:
        remarks.append(
            f"the r.m.s. level is only {1000 * level:.2g} mm: is the unit of {column!r} right?"
        )
    return remarks
