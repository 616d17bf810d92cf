"""A track: its longitudinal level over distance, made from a spectrum or measured.

Symbols: x, distance along the track (m); w(x), level (m, up); step h and n samples
w_j = w(x_0 + j h); Omega_k = 2πk/(n h), angular wavenumbers (rad/m) of the Fourier series over the
n samples, dOmega = 2π/(n h) apart; S(Omega), one-sided density (m²/(rad/m)) of
:mod:`railride.spectra`.

Between samples w is the quintic spline through them: with eight samples per wavelength it is right
to 1.4e-5 of the r.m.s. and its slope to 6e-5, with four to 0.2 % and 0.4 % (a cubic spline: 8e-4
and 3e-3; 2 % and 4 %).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, inf, isfinite, log2, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.spectra import FloatArray, Spectrum, check_band, check_speed
from railride.spectra import spectrum as named_spectrum

HIGHEST_HZ = 80.0  # the end of the whole-body vibration band of ISO 2631-1
SAMPLES_PER_WAVELENGTH = 8  # of a track made for a ride
RESOLVED_SAMPLES = 4  # per wavelength below which the spline no longer follows the level
MOST_POINTS = 50_000_000  # 400 MB of level; a longer synthetic track is a slip of the units
TAPER = 50.0  # m


@dataclass(frozen=True, eq=False)
class Track:
    """Level samples w_j = w(x_0 + j h) on a uniform grid.

    ``distance0``: x_0, m; ``step``: h, m; ``level``: w_j, shape (n,), m (kept as a read-only copy).
    ``name`` and ``source``: what to call it and where it comes from. ``band``: the shortest and
    longest wavelength (m) it holds, where that is known to be limited. ``remarks``: what its user
    must know. ``lead_in``: whether it goes on before its first sample, level and at rest.

    Raises InputError for fewer than 4 samples, a step that is not above zero, and NaN or infinity.

    >>> track = Track(0.0, 0.5, np.array([0.0, 0.001, 0.003, 0.002, 0.0]))
    >>> track.length
    2.0
    """

    distance0: float
    step: float
    level: FloatArray
    name: str = "track"
    source: str = ""
    band: tuple[float, float] | None = None
    remarks: tuple[str, ...] = ()
    lead_in: bool = False

    def __post_init__(self) -> None:
        """Copy the samples and check them."""
        level = np.array(self.level, dtype=np.float64)
        level.flags.writeable = False
        object.__setattr__(self, "level", level)
        where = f"track {self.name}"
        if level.ndim != 1 or level.size < 4:
            raise InputError(
                f"{where}: found level samples of shape {level.shape}; expected at least 4 in a row"
            )
        if not (isfinite(self.step) and self.step > 0.0):
            raise InputError(f"{where}: found a step of {self.step} m; expected one above zero")
        if not isfinite(self.distance0):
            raise InputError(f"{where}: found a first distance of {self.distance0} m")
        if not np.all(np.isfinite(level)):
            first = int(np.argmin(np.isfinite(level)))
            raise InputError(
                f"{where}: found a level of {level[first]} at sample {first}; expected finite ones"
            )
        if self.band is not None:
            check_band(self.band, f"{where}: band")

    @property
    def length(self) -> float:
        """Last less first distance, (n − 1) h, m."""
        return self.step * (self.level.size - 1)

    @property
    def end(self) -> float:
        """Distance of the last sample, m."""
        return self.distance0 + self.length

    @property
    def distance(self) -> FloatArray:
        """Distances of the samples x_0 + j h, shape (n,), m."""
        return self.distance0 + self.step * np.arange(self.level.size, dtype=np.float64)

    @cached_property
    def _knots(self) -> FloatArray:
        """Level w, dw/du and d²w/du² of the spline at the samples, (3, n), with u = (x − x_0)/h."""
        from scipy.interpolate import make_interp_spline

        u = np.arange(self.level.size, dtype=float)
        spline = make_interp_spline(u, self.level, k=5 if u.size > 5 else 3)
        return np.stack([self.level, *(spline.derivative(order)(u) for order in (1, 2))])

    def elevation(self, distance: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Level w (m) and its exact slope dw/dx (m/m) at any ``distance`` x (m, any shape).

        Both have the shape of x. Ahead of a lead-in (:meth:`with_taper`) the track is level: w is
        its first sample there and dw/dx zero.

        Raises InputError for a distance that is not finite or not on the track.

        >>> track = Track(0.0, 1.0, np.arange(8.0) ** 2)
        >>> w, slope = track.elevation([2.5, 3.0])
        >>> w.round(9).tolist(), slope.round(9).tolist()
        ([6.25, 9.0], [5.0, 6.0])
        """
        x = np.asarray(distance, dtype=np.float64)
        slack = 1e-9 * max(1.0, abs(self.distance0), abs(self.end))  # rounding of x = V t
        lowest = -inf if self.lead_in else self.distance0 - slack
        outside = ~(np.isfinite(x) & (x >= lowest) & (x <= self.end + slack))
        if np.any(outside):
            raise InputError(
                f"track {self.name}: found a distance of {x[outside].flat[0]:g} m; expected one on "
                f"the track, {self.distance0:g} to {self.end:g} m"
            )
        u = np.clip((x - self.distance0) / self.step, 0.0, self.level.size - 1.0)
        w, slope = _quintic(u, self._knots)
        slope /= self.step
        if self.lead_in:
            ahead = x <= self.distance0
            w, slope = np.where(ahead, self.level[0], w), np.where(ahead, 0.0, slope)
        return np.asarray(w), np.asarray(slope)

    def pieces(self) -> FloatArray:
        """Level (m), slope (m/m) and curvature (1/m) at the samples, shape (n, 3).

        Between two samples the track is the quintic that has all three at both.

        >>> Track(0.0, 0.5, np.arange(8.0) ** 2).pieces()[2].round(9).tolist()
        [4.0, 8.0, 8.0]
        """
        found = self._knots.T / self.step ** np.arange(3)
        if self.lead_in:
            found[0, 1:] = 0.0
        return found

    def with_taper(self, length: float = TAPER) -> Track:
        """Put a taper before the first sample, so that a vehicle can start on it at rest.

        w(x_0 − s) = w(x_0) − r(s/T) (w(x_0 + s) − w(x_0)),  r(p) = 1 − 10p³ + 15p⁴ − 6p⁵,

        ``length`` T in m (rounded up to whole steps): the track reflected oddly about its first
        point, which keeps level and slope there, faded out to a level stretch at w(x_0) whose
        slope and curvature are zero. Ahead of that it goes on level for any distance. A vehicle at
        rest on it is lifted uniformly by w(x_0), which strains nothing.

        Raises InputError for a length that is not above zero or longer than the track.
        """
        if not (isfinite(length) and 0.0 < length <= self.length * (1.0 + 1e-9)):
            raise InputError(
                f"track {self.name}: found a taper of {length:g} m on a track of {self.length:g} m;"
                " expected it above zero and no longer than the track, which it mirrors"
            )
        samples = min(_steps(length, self.step), self.level.size - 1)
        p = np.arange(1, samples + 1) / samples
        ramp = 1.0 - p**3 * (10.0 - 15.0 * p + 6.0 * p**2)
        before = self.level[0] - ramp * (self.level[1 : samples + 1] - self.level[0])
        remark = (
            f"{self.name} begins with a {samples * self.step:g} m taper put before its first "
            f"sample at {self.distance0:g} m: its own first metres mirrored and faded in"
        )
        return replace(
            self,
            distance0=self.distance0 - samples * self.step,
            level=np.concatenate([before[::-1], self.level]),
            lead_in=True,
            remarks=(*self.remarks, remark),
        )

    def reversed(self) -> Track:
        """The same track run from its end to its start: w(−x), from −x_n−1 to −x_0.

        Every sample keeps its distance but for the sign: twice reversed it is itself again.

        Raises InputError for a track with a lead-in, which can only be run one way.

        >>> back = Track(10.0, 0.5, np.array([0.0, 0.001, 0.003, 0.002])).reversed()
        >>> back.distance.tolist(), back.level.tolist()
        ([-11.5, -11.0, -10.5, -10.0], [0.002, 0.003, 0.001, 0.0])
        """
        if self.lead_in:
            raise InputError(
                f"track {self.name}: found a taper put before it; expected a track without "
                "(reverse it first)"
            )
        remark = (
            f"{self.name} is run from its end at {self.end:.10g} m to its start at "
            f"{self.distance0:.10g} m; distances have a minus sign"
        )
        return replace(
            self,
            distance0=-self.end,
            level=self.level[::-1],
            remarks=(*self.remarks, remark),
        )

    def rms(self) -> float:
        """R.m.s. of the level about its mean, m (the datum of a level is arbitrary)."""
        return float(np.std(self.level))

    def resolves(self, wavelength_low: float, wavelength_high: float) -> bool:
        """Whether the record is long and fine enough for a wavelength band (m).

        At least one longest wavelength long, at least two samples to the shortest.
        """
        return (
            2.0 * self.step <= wavelength_low * (1.0 + 1e-9)
            and self.length >= wavelength_high * (1.0 - 1e-9)
        )  # fmt: skip

    def covers(self, wavelength_low: float, wavelength_high: float) -> bool:
        """Whether the record resolves a wavelength band (m) and is not limited to another."""
        low, high = self.band or (0.0, inf)
        inside = low <= wavelength_low * (1.0 + 1e-9) and wavelength_high <= high * (1.0 + 1e-9)
        return inside and self.resolves(wavelength_low, wavelength_high)

    def band_rms(self, wavelength_low: float, wavelength_high: float) -> float:
        """R.m.s. of the part of the level with wavelengths in a band (m), m.

        From the cosine series (DCT-II) of the record less its straight line: mean square =
        Σ_k a_k²/2 with a_k at Omega_k = πk/(n h), each counted by the part of its cell
        Omega_k ± π/(2 n h) inside the band. The bands of a record add up to its mean square, all of
        it counts alike, and since the record goes on mirrored it has no jump at its ends that would
        leak into the short wavelengths (of the order of 2/(0.8 rad/m · length) of S there).

        Raises InputError for a band that is none, or that the record cannot resolve.

        >>> x = np.arange(0.0, 1000.0, 0.25)
        >>> wave = Track(0.0, 0.25, 0.001 * np.sin(2 * np.pi * x / 10.0))
        >>> round(1000 * wave.band_rms(3.0, 25.0), 2)  # 1/sqrt(2) mm
        0.71
        """
        from scipy.fft import dct
        from scipy.signal import detrend

        check_band((wavelength_low, wavelength_high), f"track {self.name}: wavelength band")
        if not self.resolves(wavelength_low, wavelength_high):
            raise InputError(
                f"track {self.name}: found {self.length:g} m in steps of {self.step:g} m; expected "
                f"at least {wavelength_high:g} m in steps of at most {wavelength_low / 2:g} m for "
                f"wavelengths of {wavelength_low:g} to {wavelength_high:g} m"
            )
        n = self.level.size
        squares = 2.0 * (dct(detrend(self.level), type=2) / (2.0 * n)) ** 2  # a_k²/2
        squares[0] = 0.0
        cell = pi / (n * self.step)
        edges = cell * (np.arange(n + 1) - 0.5)
        inside = np.clip(edges, 2.0 * pi / wavelength_high, 2.0 * pi / wavelength_low)
        return sqrt(float(squares @ np.diff(inside)) / cell)

    def psd(self, segment: float | None = None) -> tuple[FloatArray, FloatArray]:
        """Estimate S(Omega): wavenumbers (rad/m) and one-sided density (m²/(rad/m)).

        Welch's average over Hann-windowed, half overlapping segments of ``segment`` m, each less
        its straight line; by default an eighth of the track, but at least 200 m of it. Both have
        shape (segment samples // 2 + 1,).

        Raises InputError for a segment that is not on the track or has fewer than 4 samples.
        """
        from scipy.signal import welch

        if segment is None:
            segment = min(self.length, max(200.0, self.length / 8.0))
        if not 3.0 * self.step * (1 - 1e-9) <= segment <= self.length * (1 + 1e-9):
            raise InputError(
                f"track {self.name}: found a segment of {segment} m; expected "
                f"{3 * self.step:g} to {self.length:g} m"
            )
        count = min(_steps(segment, self.step) + 1, self.level.size)
        # A sampling "rate" of 2π/h samples per radian makes the density one over Omega.
        wavenumber, density = welch(
            self.level, fs=2.0 * pi / self.step, nperseg=count, detrend="linear"
        )
        return wavenumber, density


def _quintic(u: FloatArray, knots: FloatArray) -> tuple[FloatArray, FloatArray]:
    """w and dw/du at u by the quintic that has level, slope and curvature of both knots beside it.

    knots (3, n) : these, at u = 0, 1, …

    Source: E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
    Springer 1993, II.6 (Hermite interpolation).
    """
    i = np.minimum(u.astype(np.int64), knots.shape[1] - 2)
    r = u - i
    w_0, d_0, c_0 = (values[i] for values in knots)
    w_1, d_1, c_1 = (values[i + 1] for values in knots)
    rise = w_1 - w_0
    a_2 = c_0 / 2
    a_3 = 10 * rise - 6 * d_0 - 4 * d_1 - (3 * c_0 - c_1) / 2
    a_4 = -15 * rise + 8 * d_0 + 7 * d_1 + (3 * c_0 - 2 * c_1) / 2
    a_5 = 6 * rise - 3 * (d_0 + d_1) - (c_0 - c_1) / 2
    w = w_0 + r * (d_0 + r * (a_2 + r * (a_3 + r * (a_4 + r * a_5))))
    return w, d_0 + r * (2 * a_2 + r * (3 * a_3 + r * (4 * a_4 + r * 5 * a_5)))


def _steps(length: float, step: float) -> int:
    """Whole steps that cover a length; a ratio that is whole but for rounding is whole."""
    ratio = length / step
    nearest = round(ratio)
    return nearest if abs(ratio - nearest) <= 1e-9 * max(1.0, ratio) else ceil(ratio)


def recommended_step(slowest_speed: float) -> float:
    """Step (m) fine enough for 80 Hz at ``slowest_speed`` V (m/s), in samples of a wavelength.

    h = 0.05 m / 2^max(0, ⌈log₂(0.05 m · 8 · 80 Hz / V)⌉): at least eight samples to the wavelength
    V/80 Hz; halved from 5 cm, so that it is a round number and few speeds have a step of their own.

    Raises InputError unless the speed is finite and above zero.

    >>> recommended_step(145 / 3.6), recommended_step(100 / 3.6)
    (0.05, 0.025)
    """
    check_speed(slowest_speed)
    halvings = ceil(log2(0.05 * SAMPLES_PER_WAVELENGTH * HIGHEST_HZ / slowest_speed) - 1e-12)
    return float(0.05 / 2.0 ** max(0, halvings))


def resolved_band_hz(track: Track, speed: float) -> tuple[float, float]:
    """Lowest and highest frequency (Hz) that ``track`` can excite truly at ``speed`` V (m/s).

    f = V/wavelength, from the track's length (or the longest wavelength of its band) to four
    samples (or the shortest of its band).

    Raises InputError unless the speed is finite and above zero.

    >>> resolved_band_hz(Track(0.0, 0.25, np.zeros(4001)), 40.0)
    (0.04, 40.0)
    """
    check_speed(speed)
    low, high = track.band or (0.0, inf)
    longest, shortest = min(track.length, high), max(RESOLVED_SAMPLES * track.step, low)
    return speed / longest, speed / shortest


def synthesise(source: str | Spectrum, length: float, step: float, seed: int) -> Track:
    """Draw a track from ``source``, a spectrum or its name: one sample of a Gaussian process.

    w_j = Σ_k Re(c_k e^{i Omega_k j h}),  c_k = √(S(Omega_k) dOmega) (a_k + i b_k),

    a_k, b_k independent standard normal, k = 1 … n/2, so the mean square is Σ S(Omega_k) dOmega on
    average and scatters as a record of that length does. The n samples cover 0 to ``length`` (m) in
    steps of ``step`` (m), a length that is no whole number of steps being rounded up. The period of
    the series is n h: nothing repeats within the track, and the plain periodogram of its samples
    has the spectrum as its mean, without leakage.

    ``seed``: whole, 0 to 2³² − 1. The same spectrum, length, step and seed give the same track
    everywhere: the normal numbers come from the generator that numpy keeps frozen (NEP 19),
    a_1, b_1, a_2, b_2 and so on from the longest wavelength down.

    Raises InputError for a length, step or seed that is none, fewer than 4 or more than 50 million
    samples, and a spectrum with no wavelength between two steps and the length.
    """
    from scipy.fft import irfft

    spectrum = named_spectrum(source)
    n = _points(length, step)
    check_seed(seed)
    spacing = 2.0 * pi / (n * step)
    root_power = np.sqrt(spectrum.density(spacing * np.arange(1, n // 2 + 1)) * spacing)
    if not np.any(root_power):
        raise InputError(
            f"spectrum {spectrum.name}: found no wavelength of it between {2 * step:g} m (two "
            f"steps) and {length:g} m; expected some of its band {spectrum.active_band} m there "
            "(choose a smaller step or a greater length)"
        )
    normal = np.random.RandomState(seed).standard_normal(2 * root_power.size)
    coefficients = np.zeros(n // 2 + 1, dtype=np.complex128)
    coefficients[1:] = 0.5 * n * root_power * normal.view(np.complex128)
    if n % 2 == 0:  # the last one is its own mirror image: real, and counted once
        coefficients[-1] = 2.0 * coefficients[-1].real
    return Track(
        distance0=0.0,
        step=step,
        level=irfft(coefficients, n),
        name=spectrum.name,
        source=f"{spectrum.source}; seed {seed}" + (", extrapolated" * spectrum.extrapolate),
        band=spectrum.active_band,
        remarks=spectrum.remarks,
    )


def _points(length: float, step: float) -> int:
    """Count the samples from 0 to ``length`` inclusive; InputError if that cannot be."""
    for value, what in ((length, "length"), (step, "step")):
        if not (isfinite(value) and value > 0.0):
            raise InputError(f"track {what}: found {value} m; expected a finite one above zero")
    if not 3.0 <= length / step * (1 + 1e-9) < MOST_POINTS:
        raise InputError(
            f"track: found a length of {length:g} m in steps of {step:g} m, {length / step:.3g} "
            f"of them; expected 3 to {MOST_POINTS:,} steps"
        )
    return _steps(length, step) + 1


def check_seed(seed: object) -> None:
    """Raise InputError unless ``seed`` is a whole number from 0 to 2³² − 1."""
    if isinstance(seed, int | np.integer) and not isinstance(seed, bool) and 0 <= seed < 2**32:
        return
    raise InputError(f"seed: found {seed!r}; expected a whole number, 0 to {2**32 - 1}")
