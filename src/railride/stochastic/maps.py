"""Comfort along the car and over speed, exact: one solution of the vehicle for all its points.

Source: as :mod:`railride.stochastic.ride`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort import wz_from_rms
from railride.errors import InputError
from railride.numeric import Array
from railride.quantities import several
from railride.spectra import Spectrum
from railride.stochastic.gains import PLAIN, sperling, weighted
from railride.stochastic.measured import track_spectrum
from railride.stochastic.ride import STATED, floor_in_hand
from railride.stochastic.squares import mean_squares
from railride.track import Track
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
    track: str | Path | Spectrum | Track,
    speeds: float | Sequence[float] = SPEEDS,
    at: float | Sequence[float] | None = None,
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    progress: Callable[[float], Any] | None = None,
    **changes: ArrayLike,
) -> pd.DataFrame:
    """Exact comfort values for every speed (outer) and point of the floor (inner).

    Parameters
    ----------
    track : a spectrum or its name, a track or its file.
    speeds : m/s, each > 0; default 10 to 400 km/h in steps of 2.
    at : points of the floor, m forward of the body's middle; default 49 from end to end.
    floor : "smooth" or "polygon". weight : a weighting or its name.
    progress : called with the fraction done.
    changes : parameter values in place of the vehicle's.

    Returns
    -------
    table : "speed [km/h]", "position [m]", "a_rms [m/s^2]", "a_wrms [m/s^2]", "Wz", and "error",
        the estimated relative error of a_wrms; ``table.attrs``: "remarks", what to know of it, and
        what it is "of", over which "track", under which "weighting".

    Raises
    ------
    InputError : as :func:`stochastic_ride`; no speeds or points at all.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> comfort_map(coach, "erri_low", [40.0, 50.0], [0.0, 5.0, 10.0]).shape
    (6, 6)
    """
    import pandas as pd

    speeds = several(speeds, "speeds", "m/s")
    places = along_the_car(model).tolist() if at is None else several(at, "at", "m")
    if not speeds or not places:
        raise InputError("comfort map: found no speeds or no points; expected at least one of each")
    spectrum, remarks = track_spectrum(track, speeds)
    weight = weighting(weight)
    m, rows = floor_in_hand(model, places, floor, changes)
    wheelsets = model.wheelset_places(**changes)
    gains, parts = (PLAIN, weighted(weight), sperling()), []
    for number, speed in enumerate(speeds, start=1):
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
        if progress is not None:
            progress(number / len(speeds))
    table = pd.concat(parts, ignore_index=True)
    if (table["error"] > STATED).any():
        remarks.append(f"relative errors of a_wrms reach {table['error'].max():.0e}")
    over = f"{model.vehicle.name} ({model.body.title}) over {spectrum.name}, {floor} floor"
    table.attrs |= {"of": over, "track": spectrum.name, "weighting": weight.name}
    table.attrs["remarks"] = list(dict.fromkeys(remarks))
    return table
