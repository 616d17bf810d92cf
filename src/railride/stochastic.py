r"""The exact stochastic ride: mean squares from spectra, without a time run.

.. math:: \overline{a_w^2} = \int_{f_1}^{f_2} |W(f)|^2\, |H(f)|^2\, S_w(f)\, df, \qquad
          S_w(f) = \frac{2\pi}{V}\, S\!\left(\frac{2\pi f}{V}\right)

with the one-sided spectrum S of the track, the vehicle's response H to it and a weighting W. The
integrand is smooth but for its poles; panels shrink towards each pole as far as it is from the real
axis (a mode of damping ratio 2e-6 included), and Gauss's rule converges geometrically on each.

A run of duration T is a sample. Of a Gaussian process of one-sided spectrum S_a, the mean square
over T scatters with the variance ∫ S_a² df / T, so that its root has the relative standard error
½ √(∫ S_a² df / T) / ∫ S_a df.

Source: D.E. Newland, Random Vibrations, Spectral and Wavelet Analysis, 3rd ed., Chapters 7 and 9;
J.S. Bendat, A.G. Piersol, Random Data, 4th ed., Eq 8.49 (variance); L.N. Trefethen, Approximation
Theory and Approximation Practice, Theorem 19.3 (Gauss's rule beside a pole).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.comfort import sperling_weighting, wz_from_rms
from railride.errors import InputError
from railride.frequency import track_response, wheelset_delays
from railride.modal import eigen, refuse_unstable
from railride.numeric import Array
from railride.spectra import Spectrum, check_speed, temporal
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

BAND_HZ = (0.05, 80.0)
GAUSS_POINTS = 14
REACH = 1.0  # longest panel, in distances from it to the nearest pole


@dataclass(frozen=True)
class StochasticRide:
    """What a stationary ride over a track of a spectrum comes to, arrays over positions.

    a_rms, a_wrms : m/s², the r.m.s. and weighted r.m.s. of the floor's acceleration, 0.05-80 Hz.
    wz : Sperling's ride index. variance_time : ∫ S² df/(∫ S df)² of the weighted spectrum, s.
    """

    positions: tuple[float, ...]
    a_rms: Array
    a_wrms: Array
    wz: Array
    variance_time: Array

    def standard_error(self, duration: float) -> Array:
        """Standard error of a_wrms over a run of ``duration`` seconds, m/s²."""
        return np.asarray(self.a_wrms * np.sqrt(self.variance_time / duration) / 2)


def stochastic_ride(
    model: VehicleModel,
    speed: float,
    spectrum: Spectrum,
    at: Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: Weighting | None = None,
    **changes: ArrayLike,
) -> StochasticRide:
    """Exact comfort values of a vehicle at a speed over a track of a spectrum.

    Parameters
    ----------
    speed : V in m/s, > 0. at : points of the floor, m forward of the body's middle.
    floor : how the floor is read, "smooth" or "polygon". weight : default W_k.

    Raises
    ------
    InputError : speed ≤ 0, a point off the body, an unstable vehicle, a spectrum with nothing in
        0.05-80 Hz at this speed.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle, spectrum
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> ride = stochastic_ride(coach, 200 / 3.6, spectrum("erri_low"), floor="polygon")
    >>> round(float(ride.a_wrms[0]), 3)
    0.328
    """
    check_speed(speed)
    weight = weighting("Wk") if weight is None else weight
    outputs = [model.floor(x, floor) for x in at]
    eigenvalues, _ = eigen(model.matrices(**changes))
    refuse_unstable(eigenvalues)
    low, high = _band(spectrum, speed)
    poles = [eigenvalues, weight.poles(), 1j * speed * np.asarray(spectrum.poles, dtype=complex)]
    longest_delay = float(wheelset_delays(model, speed).max())
    breaks = speed * np.asarray(spectrum.breakpoints) / (2 * np.pi)
    ends = [low, *breaks[(breaks > low) & (breaks < high)], high]
    edges = graded_panels(ends, np.concatenate(poles) / (2j * np.pi), 1 / longest_delay)
    f, df = gauss_points(edges)
    H = track_response(model, outputs, speed, f, **changes)
    S_a = np.abs(H) ** 2 * temporal(spectrum, speed)(f)
    S_aw = S_a * np.abs(weight.response(f)) ** 2
    mean_square = S_aw @ df
    a_B = np.sqrt((S_a * sperling_weighting(f) ** 2) @ df)
    return StochasticRide(
        positions=tuple(at),
        a_rms=np.sqrt(S_a @ df),
        a_wrms=np.sqrt(mean_square),
        wz=np.asarray(wz_from_rms(a_B)),
        variance_time=(S_aw**2 @ df) / mean_square**2,
    )


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
    """
    done: list[Array] = []
    a, b = np.array(ends[:-1]), np.array(ends[1:])
    while a.size:
        nearest = np.clip(poles.real[:, np.newaxis], a, b)
        away = np.abs(poles[:, np.newaxis] - nearest).min(axis=0)
        tiny = 1e-12 * ends[-1]  # a pole on the axis: what lies so close to it is below rounding
        fits = (b - a <= np.maximum(REACH * away, tiny)) & (b - a <= period)
        done.append(b[fits])
        a, b = a[~fits], b[~fits]
        middle = (a + b) / 2
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    return np.concatenate([ends[:1], np.sort(np.concatenate(done))])


def gauss_points(edges: Array) -> tuple[Array, Array]:
    """Points and weights of Gauss's rule on every panel, each of shape (panels · points,)."""
    x, w = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    half = np.diff(edges)[:, np.newaxis] / 2
    middle = (edges[:-1] + edges[1:])[:, np.newaxis] / 2
    return (middle + half * x).ravel(), (half * w).ravel()


def _band(spectrum: Spectrum, speed: float) -> tuple[float, float]:
    """0.05-80 Hz, as far as the spectrum reaches at this speed."""
    low, high = BAND_HZ
    if spectrum.active_band is not None:
        shortest, longest = spectrum.active_band
        low, high = max(low, speed / longest), min(high, speed / shortest)
    if low >= high:
        raise InputError(f"spectrum {spectrum.name}: found nothing of it within {BAND_HZ[0]:g}-"
                         f"{BAND_HZ[1]:g} Hz at {3.6 * speed:g} km/h; expected wavelengths that a "
                         "ride feels (another speed or spectrum)")  # fmt: skip
    return low, high
