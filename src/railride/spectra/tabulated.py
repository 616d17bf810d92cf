"""A user's own spectrum from a table of densities over wavenumber or wavelength.

Between its points ln S is linear over ln Omega: exact for a power law, which spectra of tracks are
piecewise or nearly so. Outside them the density is zero, as outside the band of any spectrum;
extrapolated, it goes on as the power law that fits the octave at that end best.

Units: those of the abscissa say what it is, ``rad/m`` the angular wavenumber Omega, ``1/m`` (or
``cycle/m``) the wavenumber n, a length the wavelength; those of the density say over which of the
two wavenumbers it is one, whichever the abscissa is: S(Omega) = S(n)/2π.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import log, pi

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import Faults
from railride.spectra.bands import band_rms
from railride.spectra.density import FloatArray, Spectrum, unit_doubts
from railride.units import QuantityError, same_dimension, to_si

ABSCISSAE = ("rad/m", "1/m", "m")
DENSITIES = ("m^2/(rad/m)", "m^2/(1/m)")
_STEEPEST_END = 8.0  # exponent beyond the table's ends, at most: no track's spectrum is steeper
_FEWEST = 2
# Beyond them a unit is wrong, and a square may be no number.
_LIMITS = {"abscissa": (1e-9, 1e9, "rad/m"), "density": (1e-60, 1e30, "m^2/(rad/m)")}

Place = Callable[[int, str], str]
"""Where the points stand: from their count (0 first) and "abscissa" or "density"."""


@dataclass(frozen=True)
class Points:
    """A table as given: ``abscissa`` and ``density``, shape (n,), with their units."""

    abscissa: FloatArray
    density: FloatArray
    abscissa_unit: str
    density_unit: str


def spectrum_from_table(
    abscissa: ArrayLike,
    density: ArrayLike,
    *,
    abscissa_unit: str = "rad/m",
    density_unit: str = "m^2/(rad/m)",
    sidedness: str | None = None,
    name: str = "table",
    source: str = "",
) -> Spectrum:
    """Spectrum through points: ln S linear over ln Omega between them, zero outside.

    ``abscissa``: wavenumbers or wavelengths, rising or falling, shape (n,), n ≥ 2. ``density``: S
    there, > 0, shape (n,). ``abscissa_unit``: of Omega (``rad/m``), of n (``1/m``) or of the
    wavelength (``m``). ``density_unit``: over Omega (``m^2/(rad/m)``) or over n (``m^2/(1/m)``).
    Other lengths do as well (``mm^2/(1/m)``). ``sidedness``: "one-sided" or "two-sided"; taken to
    be one-sided, with a remark, where it is not stated. ``name``, ``source``: of the spectrum.

    Raises InputError for units that are none of these, fewer than two points, points that are not
    finite and above zero, and an abscissa that neither rises nor falls throughout.

    >>> own = spectrum_from_table([2.0, 200.0], [1e-9, 1e-3], abscissa_unit="m")
    >>> round(1e6 * float(own.density(2 * pi / 20.0)), 9)  # a power law, S ~ wavelength³
    1.0
    """
    faults = Faults(f"spectrum {name}")
    points = Points(
        np.array(abscissa, dtype=np.float64), np.array(density, dtype=np.float64), abscissa_unit,
        density_unit,
    )  # fmt: skip
    if points.abscissa.ndim != 1 or points.abscissa.shape != points.density.shape:
        faults.add("points", f"shapes {points.abscissa.shape} and {points.density.shape}",
                   "as many densities as wavenumbers or wavelengths, in one row each")  # fmt: skip
    faults.raise_if_any()
    return tabulated(
        points, sidedness, name, source, faults, lambda j, column: f"point {j + 1}, {column}"
    )


def tabulated(
    points: Points, sidedness: str | None, name: str, source: str, faults: Faults, place: Place,
    said: Sequence[str] = (),
) -> Spectrum:  # fmt: skip
    """Make the spectrum of a table whose columns are of one length, or raise all its ``faults``.

    ``place`` says where a point stands in what the user gave, ``said`` what there is to remark
    already; the rest is as in :func:`spectrum_from_table`.
    """
    remarks = list(said)
    kind, scale = _kind(points.abscissa_unit, faults), _per_radian(points, faults)
    if kind != "m" and points.abscissa.size and points.abscissa[0] == 0.0:
        remarks.append(f"{place(0, 'abscissa')}: wavenumber 0 has no wavelength and is left out")
        place, points = _after_first(place), replace(
            points, abscissa=points.abscissa[1:], density=points.density[1:]
        )  # fmt: skip
    _check(points, faults, place)
    faults.raise_if_any()
    wavenumber, density = _angular(points, kind), scale * points.density
    _check_limits({"abscissa": wavenumber, "density": density}, points, faults, place)
    if sidedness is None:
        remarks.append(
            "whether the densities are one- or two-sided is not stated; taken to be one-sided "
            "(two-sided ones would be doubled)"
        )
    order = np.argsort(wavenumber)
    wavenumber, density = wavenumber[order], density[order]
    found = Spectrum(
        name=name,
        source=source or "a table",
        unit="m^2/(rad/m)",
        sidedness=sidedness or "one-sided",
        formula=_power_laws(wavenumber, density),
        band=(float(2 * pi / wavenumber[-1]), float(2 * pi / wavenumber[0])),
        breakpoints=tuple(wavenumber[1:-1].tolist()),
    )
    slope = replace(found, formula=lambda O: O**2 * found.formula(O))  # noqa: E741
    whole = found.band or (0.0, 0.0)
    remarks += unit_doubts(band_rms(found, *whole), band_rms(slope, *whole), points.density_unit)
    return replace(found, remarks=tuple(f"{name}: {remark}" for remark in remarks))


def _kind(unit: str, faults: Faults) -> str:
    """Which of :data:`ABSCISSAE` a unit is a multiple of."""
    try:
        for kind in ("1/m", "cycle/m", "rad/m", "m"):
            if same_dimension(unit, kind):
                return "1/m" if kind == "cycle/m" else kind
    except QuantityError:
        pass
    faults.add("unit of the wavenumber or wavelength", repr(unit), f"one of {', '.join(ABSCISSAE)}")
    return ""


def _per_radian(points: Points, faults: Faults) -> float:
    """m²/(rad/m) per unit of the density: S(Omega) dOmega = S(n) dn."""
    unit, over_n = points.density_unit, ("m^2/(1/m)", "m^2/(cycle/m)")
    mend = ""
    try:
        if any(same_dimension(unit, kind) for kind in over_n):
            # "m^3" leaves open which of the two it is, and they differ by a factor 2π.
            if "/(1/" in unit.replace(" ", "") or "cycle" in unit or points.abscissa_unit == "1/m":
                return float(to_si(1.0, unit)) / (2.0 * pi)
            mend = "over which wavenumber it is a density is a factor 2π"
        elif same_dimension(unit, "m^2/(rad/m)"):
            return float(to_si(1.0, unit))
    except QuantityError:
        pass
    faults.add("unit of the density", repr(unit), f"one of {', '.join(DENSITIES)}, mm^2/(1/m) …",
               mend)  # fmt: skip
    return 1.0


def _after_first(place: Place) -> Place:
    return lambda j, column: place(j + 1, column)


def _check(points: Points, faults: Faults, place: Place) -> None:
    """Note points that are none, and an abscissa that turns round."""
    for values, column in ((points.abscissa, "abscissa"), (points.density, "density")):
        for j in np.flatnonzero(~(np.isfinite(values) & (values > 0.0))).tolist():
            faults.add(place(j, column), f"{values[j]:g}", "a finite number above 0",
                       "leave points without a density out")  # fmt: skip
    if points.abscissa.size < _FEWEST:
        faults.add("points", f"{points.abscissa.size}", f"at least {_FEWEST}")
    if faults.found:
        return
    steps = np.diff(points.abscissa)
    rising = np.sum(steps > 0.0) >= np.sum(steps < 0.0)
    for j in np.flatnonzero(steps <= 0.0 if rising else steps >= 0.0).tolist():
        faults.add(place(j + 1, "abscissa"),
                   f"{points.abscissa[j + 1]:g} after {points.abscissa[j]:g}",
                   "a rise, as elsewhere" if rising else "a fall, as elsewhere",
                   "sort the points and keep one of those at the same place")  # fmt: skip


def _check_limits(
    si: Mapping[str, FloatArray], points: Points, faults: Faults, place: Place
) -> None:
    """Refuse points whose values in rad/m and m²/(rad/m) no track has."""
    for column, (low, high, unit) in _LIMITS.items():
        for j in np.flatnonzero((si[column] < low) | (si[column] > high)).tolist():
            given = f"{getattr(points, column)[j]:g} {getattr(points, f'{column}_unit')}"
            faults.add(place(j, column), given, f"{low:g} to {high:g} {unit}, as a track may have",
                       "is the unit right?")  # fmt: skip
    faults.raise_if_any()


@np.errstate(over="ignore")  # refused by its size
def _angular(points: Points, kind: str) -> FloatArray:
    """Omega, rad/m."""
    values = to_si(points.abscissa, points.abscissa_unit)
    return 2.0 * pi / values if kind == "m" else values * (2.0 * pi if kind == "1/m" else 1.0)


def _power_laws(
    wavenumber: FloatArray, density: FloatArray
) -> Callable[[NDArray[np.inexact]], FloatArray]:
    """S over Omega: power laws between the points and beyond them."""
    x, y = np.log(wavenumber), np.log(density)
    before, after = _end_exponent(x, y), _end_exponent(x[::-1], y[::-1])

    return partial(_between, x, y, (before, after))


def _between(
    x: FloatArray, y: FloatArray, ends: tuple[float, float], wavenumber: NDArray[np.inexact]
) -> FloatArray:
    """S over Omega from y = ln S at x = ln Omega, and the exponents of both ends."""
    at = np.log(np.maximum(np.real(wavenumber), 1e-300))
    beyond = ends[0] * np.minimum(at - x[0], 0.0) + ends[1] * np.maximum(at - x[-1], 0.0)
    return np.asarray(np.exp(np.minimum(np.interp(at, x, y) + beyond, 700.0)))


def _end_exponent(x: FloatArray, y: FloatArray) -> float:
    """Exponent of the power law that fits the first octave best, or the first two points."""
    count = max(2, int(np.sum(np.abs(x - x[0]) <= log(2.0) * (1.0 + 1e-9))))
    away, risen = x[:count] - np.mean(x[:count]), y[:count] - np.mean(y[:count])
    return float(np.clip(away @ risen / (away @ away), -_STEEPEST_END, _STEEPEST_END))
