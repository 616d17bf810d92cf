"""Comfort along the car and over speed, exact: one solution of the vehicle for all its points.

Source: as :mod:`railride.stochastic.ride`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort import wz_from_rms
from railride.errors import InputError
from railride.numeric import Array
from railride.spectra import Spectrum, coverage_remark
from railride.stochastic.gains import PLAIN, sperling, weighted
from railride.stochastic.ride import STATED, floor_in_hand
from railride.stochastic.squares import mean_squares
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

SPEEDS = tuple(v / 3.6 for v in range(10, 401, 2))  # m/s
POINTS = 49


def along_the_car(model: VehicleModel, points: int = POINTS) -> Array:
    """Points of the floor from the rear end to the front, m forward of the body's middle."""
    half = model.vehicle.body.length / 2
    return np.linspace(-half, half, points)


def comfort_map(
    model: VehicleModel,
    spectrum: Spectrum,
    speeds: Sequence[float] = SPEEDS,
    at: Sequence[float] | None = None,
    *,
    floor: str = "smooth",
    weight: Weighting | None = None,
    progress: Callable[[float], Any] | None = None,
    **changes: ArrayLike,
) -> pd.DataFrame:
    """Exact comfort values for every speed (outer) and point of the floor (inner).

    Parameters
    ----------
    spectrum : of the track. speeds : m/s, each > 0; default 10 to 400 km/h in steps of 2.
    at : points of the floor, m forward of the body's middle; default 49 from end to end.
    floor : "smooth" or "polygon". weight : default W_k. progress : called with the fraction done.
    changes : parameter values in place of the vehicle's.

    Returns
    -------
    table : "speed [km/h]", "position [m]", "a_rms [m/s^2]", "a_wrms [m/s^2]", "Wz", and "error",
        the estimated relative error of a_wrms; ``table.attrs``: "remarks", what to know of it, and
        what it is "of", under which "weighting".

    Raises
    ------
    InputError : as :func:`stochastic_ride`; no speeds or points at all.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle, spectrum
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> comfort_map(coach, spectrum("erri_low"), [40.0, 50.0], [0.0, 5.0, 10.0]).shape
    (6, 6)
    """
    import pandas as pd

    places = along_the_car(model) if at is None else np.asarray(at, dtype=float)
    if not len(speeds) or not places.size:
        raise InputError("comfort map: found no speeds or no points; expected at least one of each")
    m, rows = floor_in_hand(model, places.tolist(), floor, changes)
    gains = (PLAIN, weighted(weight or weighting("Wk")), sperling())
    parts, remarks = [], []
    for number, speed in enumerate(speeds, start=1):
        wheelsets = model.vehicle.wheelset_positions
        squares, errors = mean_squares(m, rows, wheelsets, [speed], spectrum, gains)
        a, a_w, a_B = np.sqrt(squares[0, 0])
        parts.append(
            pd.DataFrame({
                "speed [km/h]": round(3.6 * speed, 9),
                "position [m]": places,
                "a_rms [m/s^2]": a,
                "a_wrms [m/s^2]": a_w,
                "Wz": wz_from_rms(a_B),
                "error": errors[0, 0, 1] / 2,
            })
        )  # fmt: skip
        remarks.append(coverage_remark(spectrum.name, spectrum.active_band, speed))
        if progress is not None:
            progress(number / len(speeds))
    table = pd.concat(parts, ignore_index=True)
    if (table["error"] > STATED).any():
        remarks.append(f"relative errors of a_wrms reach {table['error'].max():.0e}")
    over = f"{model.vehicle.name} ({model.body.title}) over {spectrum.name}, {floor} floor"
    table.attrs |= {"of": over, "weighting": (weight or weighting("Wk")).name}
    table.attrs["remarks"] = list(dict.fromkeys(r for r in remarks if r))
    return table
