r"""The outputs of a vehicle on a track as stationary processes.

.. math:: S_y(f) = |H(f)|^2 S_w(f), \qquad
          S_w(f) = \frac{2\pi}{V}\, S\!\left(\frac{2\pi f}{V}\right), \qquad
          \overline{y_W^2} = \int_{f_1}^{f_2} |W|^2 S_y \, df

with the one-sided spectrum S of the track, the response H of an output to it and a weighting W.

A mode without any damping has no stationary motion: a share of the integral in its line alone is
refused. A mode that has no part in an output has none in its integral, damped or not.

Source: D.E. Newland, Random Vibrations, Spectral and Wavelet Analysis, 3rd ed., Chapter 7.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.frequency import Triangular, triangular
from railride.numeric import Array, Matrices
from railride.spectra import Spectrum, check_speed
from railride.stochastic.fractions import eigen_forms
from railride.stochastic.gains import PLAIN, Gain
from railride.stochastic.quadrature import distances, gauss_errors, gauss_points, graded_panels

Complex = NDArray[np.complex128]

BAND_HZ = (0.05, 80.0)
UNDAMPED = 1e-10  # damping ratio below which a mode counts as undamped
LINE = 1e-8  # half the width of an undamped mode's line, of its frequency
_MOST_IN_LINE = 1e-6  # of the mean square
_PANELS_TOGETHER = 2000  # at a time: what the memory need not notice
_EPSILON = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Integrals:
    """Per panel, shape (gains, outputs, panels): ∫ |W|² S_y df and its estimated error.

    squares : ∫ (|W|² S_y)² df of the whole band, (gains, outputs).
    """

    edges: Array
    values: Array
    errors: Array
    squares: Array

    @property
    def mean_square(self) -> Array:
        """Of the whole band, (gains, outputs)."""
        return np.asarray(self.values.sum(axis=-1))

    @property
    def error(self) -> Array:
        """Estimated relative error of the mean square, (gains, outputs); 0 where that is 0."""
        return relative(self.errors.sum(axis=-1), self.mean_square)


@dataclass(frozen=True)
class Process:
    """Outputs of one vehicle at one speed over a track of a spectrum, between two frequencies.

    form : the vehicle in triangular form. rows, direct : of the outputs. into : the states from
    elevations, then from their rates. delays : of the wheelsets, s. speed : m/s. edges : of the
    gains : the weightings whose poles the panels respect. moved : pairs of an eigenvalue and how
    """

    form: Triangular
    rows: tuple[tuple[int, Complex], ...]
    direct: tuple[tuple[int, Array], ...]
    into: Complex
    delays: Array
    speed: float
    spectrum: Spectrum
    edges: Array
    gains: tuple[Gain, ...]
    moved: Complex | None = None

    @property
    def eigenvalues(self) -> Complex:
        """λ of the vehicle, rad/s."""
        return np.asarray(np.diagonal(self.form.T))

    def response(self, frequency: Array) -> Complex:
        """H at frequencies in Hz, shape (outputs, F)."""
        s = 2j * np.pi * frequency
        w = np.exp(-self.delays[:, np.newaxis] * s)
        x = self.form.states(s, self.into @ np.concatenate([w, s * w]))
        power = (1.0, s, -((2 * np.pi * frequency) ** 2))
        H = [rows @ w * power[p] for p, rows in self.direct]
        H += [rows @ x * power[p] for p, rows in self.rows]
        return np.asarray(sum(H[1:], start=H[0]))

    def elevation_density(self, frequency: Array) -> Array:
        """S_w at frequencies in Hz, m²/Hz."""
        per_hertz = 2 * np.pi / self.speed
        return np.asarray(per_hertz * self.spectrum.density(per_hertz * frequency))

    def pieces(self) -> Iterator[tuple[slice, Array, Array, Array]]:
        """Panels by turns: which, their points (F,), weights (F,) and lengths (P,)."""
        for start in range(0, len(self.edges) - 1, _PANELS_TOGETHER):
            some = self.edges[start : start + _PANELS_TOGETHER + 1]
            yield slice(start, start + len(some) - 1), *gauss_points(some), np.diff(some)

    def integrals(self) -> Integrals:
        """∫ |W|² S_y df on every panel, for every gain and output.

        Raises
        ------
        InputError : an undamped mode that takes part in an output.
        """
        undamped, per_panel = self.undamped(), self._rounding()
        parts: list[tuple[Array, Array]] = []
        squares: Array | float = 0.0
        in_line: Array | float = 0.0
        for which, f, df, length in self.pieces():
            H = self.response(f)
            S_y = (H.real**2 + H.imag**2) * self.elevation_density(f)
            S = np.stack([gain.power(f) * S_y for gain in self.gains])
            if undamped.size:
                near = np.abs(f - undamped[:, np.newaxis]) < LINE * f
                in_line += S @ (near * df).T
            squares += S**2 @ df
            by_panel = (*S.shape[:-1], length.size, -1)
            values = (S * df).reshape(by_panel).sum(axis=-1)
            errors = gauss_errors(S.reshape(by_panel), length) + values * per_panel[which]
            parts.append((values, errors))
        values, errors = (np.concatenate(part, axis=-1) for part in zip(*parts, strict=True))
        found = Integrals(self.edges, values, errors, np.asarray(squares))
        refuse_lines(undamped, np.asarray(in_line), found.mean_square)
        return found

    def undamped(self) -> Array:
        """Frequencies of undamped modes, Hz, each once."""
        roots = self.eigenvalues[self.eigenvalues.imag > 0]
        least = np.maximum(UNDAMPED * np.abs(roots), 10 * _EPSILON * np.abs(roots).max(initial=0.0))
        undamped = roots[-roots.real < least]
        return np.unique(undamped.imag / (2 * np.pi)) if undamped.size else np.zeros(0)

    def _rounding(self) -> Array:
        """Relative error of every panel's integral from the rounding of the poles beside it.

        Half the distance to a pole makes the integrand four times.
        """
        poles = self.eigenvalues / (2j * np.pi)
        moved = _EPSILON * np.abs(poles).max()
        near = poles[(poles.real >= 0) & (np.abs(poles.imag) < 0.1)]  # others: hardly moved
        away = np.minimum(distances(self.edges[:-1], self.edges[1:], near), 0.1)
        found = 2 * moved / np.maximum(away, moved)
        for root, far in () if self.moved is None else self.moved / (2 * np.pi):
            if not np.isfinite(far):
                return np.full(found.shape, np.inf)
            away = distances(self.edges[:-1], self.edges[1:], np.array([root / 1j]))
            found = np.maximum(found, 2 * far.real / np.maximum(away, far.real))
        return np.asarray(10 * _EPSILON + found)


def refuse_lines(undamped: Array, in_line: Array, mean_square: Array) -> None:
    """Refuse undamped modes (U,) that hold a share of a mean square: (..., U) of (...)."""
    if not undamped.size:
        return
    felt = in_line > _MOST_IN_LINE * mean_square[..., np.newaxis]
    found = undamped[felt.reshape(-1, undamped.size).any(axis=0)]
    if found.size:
        named = dict.fromkeys(f"{f:.4g}" for f in found)
        raise InputError(
            f"vehicle: found modes without damping ({', '.join(named)} Hz) that take part in the "
            "motion asked for: it never settles, and there is no stationary ride; expected a "
            f"damping ratio above {UNDAMPED:g} (give the dampers, or the body, a damping above 0)"
        )


def panel_edges(
    form: Triangular,
    delays: Array,
    speed: float,
    spectrum: Spectrum,
    gains: Sequence[Gain],
    band: tuple[float, float] = BAND_HZ,
    ends: Sequence[float] = (),
) -> Array:
    """Edges of the panels that suit a system, its track and its weightings over a band, Hz.

    They shrink towards the poles of all three, end where the spectrum breaks and at ``ends``, and
    follow the oscillation that the wheelsets' ``delays``, s, make.

    Raises
    ------
    InputError : a spectrum with nothing in the band; a speed too low to integrate.
    """
    low, high = covered_band(spectrum, speed, band)
    poles = np.concatenate([
        np.diagonal(form.T) / (2j * np.pi),
        speed * np.asarray(spectrum.poles, dtype=complex) / (2 * np.pi),
        *(gain.poles for gain in gains),
    ])  # fmt: skip
    poles = poles[poles.real >= 0]  # the others are their mirror images in the imaginary axis
    marks = np.concatenate([speed * np.asarray(spectrum.breakpoints) / (2 * np.pi), ends])
    marks = np.unique(marks[(marks > low) & (marks < high)])
    period = 1 / max(float(delays.max() - delays.min()), 1 / high)
    return graded_panels([low, *marks, high], poles, period)


def process(
    m: Matrices,
    rows: Mapping[str, Array],
    places: Sequence[float],
    speed: float,
    spectrum: Spectrum,
    gains: Sequence[Gain] = (PLAIN,),
    *,
    band: tuple[float, float] = BAND_HZ,
    ends: Sequence[float] = (),
    form: Triangular | None = None,
) -> Process:
    """Outputs as stationary processes, from matrices in hand.

    Parameters
    ----------
    m, rows : of one vehicle, ``VehicleModel.matrices`` and ``VehicleModel.output_rows``.
    places : of the wheelsets, m forward (``Vehicle.wheelset_positions``). speed : V, m/s, > 0.
    gains : weightings to integrate with. band : from and to, Hz. ends : where panels must end, Hz.
    form : of the vehicle, where it is in hand.

    Raises
    ------
    InputError : speed ≤ 0, an unstable vehicle, a spectrum with nothing in the band.
    """
    check_speed(speed)
    form = triangular(m) if form is None else form
    delays = (places[0] - np.asarray(places, dtype=float)) / speed
    edges = panel_edges(form, delays, speed, spectrum, gains, band, ends)
    forms = eigen_forms(m)
    return Process(
        form,
        tuple((p, rows[k] @ form.left) for p, k in enumerate("dva") if rows[k].any()),
        tuple((p, rows[k]) for p, k in enumerate(("w", "dw", "ddw")) if rows[k].any()),
        form.right @ np.hstack([m.K_w, m.C_w]),
        delays,
        speed,
        spectrum,
        edges,
        tuple(gains),
        np.stack([forms.poles[0], forms.moved[0].astype(complex)], axis=-1),
    )


def covered_band(
    spectrum: Spectrum, speed: float, band: tuple[float, float]
) -> tuple[float, float]:
    """The band, Hz, as far as the spectrum reaches at this speed.

    Raises
    ------
    InputError : a spectrum with nothing in the band.
    """
    low, high = band
    if spectrum.active_band is not None:
        shortest, longest = spectrum.active_band
        low, high = max(low, speed / longest), min(high, speed / shortest)
    if low >= high:
        raise InputError(f"spectrum {spectrum.name}: found nothing of it within {band[0]:.4g}-"
                         f"{band[1]:.4g} Hz at {3.6 * speed:g} km/h; expected wavelengths that a "
                         "ride feels (another speed or spectrum)")  # fmt: skip
    return low, high


def relative(error: Array, value: Array) -> Array:
    """Error over value, 0 where the value is 0."""
    return np.asarray(np.divide(error, value, out=np.zeros_like(value), where=value > 0))
