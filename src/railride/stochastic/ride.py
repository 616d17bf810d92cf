r"""Comfort values of a stationary ride, from the spectrum alone.

.. math:: \overline{a_w^2} = \int_{f_1}^{f_2} |W(f)|^2\, |H(f)|^2\, S_w(f)\, df

A run of duration T is a sample. Of a Gaussian process of one-sided spectrum S_a, the mean square
over T scatters with the variance ∫ S_a² df / T, so that its root has the relative standard error
½ √(∫ S_a² df / T) / ∫ S_a df.

Source: D.E. Newland, Random Vibrations, Spectral and Wavelet Analysis, 3rd ed., Chapters 7 and 9;
J.S. Bendat, A.G. Piersol, Random Data, 4th ed., Eq 8.49 (variance).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort import wz_from_rms
from railride.numeric import Array, Matrices
from railride.quantities import several
from railride.spectra import Spectrum
from railride.stochastic.gains import PLAIN, sperling, weighted
from railride.stochastic.measured import track_spectrum
from railride.stochastic.process import BAND_HZ, process, relative
from railride.stochastic.squares import mean_squares
from railride.track import Track
from railride.vehicle import Output, VehicleModel
from railride.weightings import Weighting, weighting

STATED = 1e-6  # relative error above which a value is remarked on


@dataclass(frozen=True)
class StochasticRide:
    """What a stationary ride over a track of a spectrum comes to, arrays over positions.

    a_rms, a_wrms : m/s², the r.m.s. and weighted r.m.s. of the floor's acceleration, 0.05-80 Hz.
    wz : Sperling's ride index. variance_time : ∫ S² df/(∫ S df)² of the weighted spectrum, s.
    a_rms_error, a_wrms_error, wz_error : estimated relative errors of the integration, rounding of
    the poles included. remarks : which of them are above 1e-6, and what to know of the track.
    """

    positions: tuple[float, ...]
    a_rms: Array
    a_wrms: Array
    wz: Array
    variance_time: Array
    a_rms_error: Array
    a_wrms_error: Array
    wz_error: Array
    remarks: tuple[str, ...] = ()

    def standard_error(self, duration: float) -> Array:
        """Standard error of a_wrms over a run of ``duration`` seconds, m/s²."""
        return np.asarray(self.a_wrms * np.sqrt(self.variance_time / duration) / 2)


def stochastic_ride(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track,
    at: float | Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    band: tuple[float, float] = BAND_HZ,
    **changes: ArrayLike,
) -> StochasticRide:
    """Exact comfort values of a vehicle at a speed over a track.

    Parameters
    ----------
    speed : V in m/s, > 0. at : points of the floor, m forward of the body's middle.
    track : a spectrum or its name, a track or its file; of a measured track, the values are those
        of its spectrum (:func:`measured_spectrum`).
    floor : how the floor is read, "smooth" or "polygon". weight : a weighting or its name.
    band : from and to, Hz. changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : speed ≤ 0, a point off the body, an unstable vehicle, a mode without damping that
        is felt at one of the points, a track that cannot be read or has no spectrum, a spectrum
        with nothing in the band at this speed.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> ride = stochastic_ride(coach, 200 / 3.6, "erri_low", floor="polygon")
    >>> round(float(ride.a_wrms[0]), 3), bool(ride.a_wrms_error[0] < 1e-9)
    (0.328, True)
    """
    spectrum, said = track_spectrum(track, [speed])
    at = several(at, "at", "m")
    m, rows = floor_in_hand(model, at, floor, changes)
    gains = (PLAIN, weighted(weighting(weight)), sperling())
    places = model.wheelset_places(**changes).tolist()
    squares, errors = (of[0, 0] for of in mean_squares(m, rows, places, [speed], spectrum, gains,
                                                       band))  # fmt: skip
    scatter = process(m, rows, places, speed, spectrum, gains[1:2], band=band).integrals().squares
    (a, a_w, a_B), (a_error, w_error, B_error) = np.sqrt(squares), errors / 2
    wz_error = 0.3 * B_error
    said += [
        f"{3.6 * speed:.6g} km/h, {x:g} m: the integral of {name} is uncertain by {error[k]:.0e} of"
        " its value (a mode with next to no damping?)"
        for name, error in (("a_rms", a_error), ("a_wrms", w_error), ("W_z", wz_error))
        for k, x in enumerate(at)
        if error[k] > STATED
    ]
    return StochasticRide(
        positions=tuple(at),
        a_rms=a,
        a_wrms=a_w,
        wz=np.asarray(wz_from_rms(a_B)),
        variance_time=relative(scatter[0], squares[1] ** 2),
        a_rms_error=a_error,
        a_wrms_error=w_error,
        wz_error=wz_error,
        remarks=tuple(said),
    )


def weighted_rms(
    m: Matrices,
    rows: Mapping[str, Array],
    places: Sequence[float],
    speed: float,
    spectrum: Spectrum,
    weight: Weighting,
    band: tuple[float, float] = BAND_HZ,
) -> tuple[Array, Array]:
    """Weighted r.m.s. of outputs from matrices in hand; its estimated relative error: (outputs,).

    Arguments and errors as for :func:`railride.stochastic.process`. For sweeps: nothing is derived,
    looked up or named.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle, spectrum
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> rows = coach.output_rows([coach.floor(0.0, "polygon")])
    >>> a_w, _ = weighted_rms(coach.matrices(), rows, coach.vehicle.wheelset_positions, 200 / 3.6,
    ...                       spectrum("erri_low"), weighting("Wk"))
    >>> round(float(a_w[0]), 3)
    0.328
    """
    a_w, error = weighted_rms_of_many(m, rows, places, [speed], spectrum, weight, band)
    return a_w[0, 0], error[0, 0]


def weighted_rms_of_many(
    m: Matrices,
    rows: Mapping[str, Array],
    places: Sequence[float],
    speeds: Sequence[float],
    spectrum: Spectrum,
    weight: Weighting,
    band: tuple[float, float] = BAND_HZ,
) -> tuple[Array, Array]:
    """Weighted r.m.s. of outputs of many vehicles at several speeds; its estimated relative error.

    Arguments as for :func:`railride.stochastic.squares.mean_squares`; both results have the shape
    (vehicles, speeds, outputs). A vehicle that would be refused alone has NaN.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle, spectrum
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> rows = coach.output_rows([coach.floor(0.0, "polygon")])
    >>> softer_and_stiffer = coach.matrices(k_2=[600e3, 750e3, 900e3])
    >>> a_w, _ = weighted_rms_of_many(softer_and_stiffer, rows, coach.vehicle.wheelset_positions,
    ...                               [145 / 3.6, 200 / 3.6], spectrum("erri_low"), weighting("Wk"))
    >>> a_w.shape, a_w[1, :, 0].round(3).tolist()
    ((3, 2, 1), [0.247, 0.328])
    """
    gains = (weighted(weight),)
    squares, errors = mean_squares(m, rows, places, speeds, spectrum, gains, band)
    return np.sqrt(squares[:, :, 0]), errors[:, :, 0] / 2


def in_hand(
    model: VehicleModel, outputs: Sequence[Output], changes: Mapping[str, ArrayLike]
) -> tuple[Matrices, dict[str, Array]]:
    """Matrices and output rows as numbers."""
    return model.matrices(**changes), model.output_rows(outputs, **changes)


def floor_in_hand(
    model: VehicleModel, at: Sequence[float], floor: str, changes: Mapping[str, ArrayLike]
) -> tuple[Matrices, dict[str, Array]]:
    """Matrices, and the rows of the floor's acceleration at points, as numbers."""
    return model.matrices(**changes), floor_rows(model, at, floor, changes)


def floor_rows(
    model: VehicleModel, at: Sequence[float], floor: str, changes: Mapping[str, ArrayLike]
) -> dict[str, Array]:
    """The rows of the floor's acceleration at points, as numbers.

    The height is Y_d q, so that the acceleration is Y_d q̈: no need to differentiate it in symbols.
    """
    heights = [model.floor(float(x), floor, derivative=0) for x in at]
    rows = model.output_rows(heights, **changes)
    height, none = rows["d"], np.zeros_like(rows["d"])
    return {**rows, "a": height, "v": none, "d": none}
