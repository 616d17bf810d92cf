"""Third-octave bands of a stationary ride.

Each value is the integral over its band alone, an ideal filter, so that the squares of all add up
to the mean square from 0.0891 to 89.1 Hz.

Source: IEC 61260-1:2014, as :mod:`railride.comfort.third_octaves`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort.third_octaves import NUMBERS, band_edges, nominal_frequencies
from railride.quantities import several
from railride.spectra import Spectrum
from railride.stochastic.gains import PLAIN, weighted
from railride.stochastic.measured import track_spectrum
from railride.stochastic.process import process
from railride.stochastic.ride import floor_in_hand
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd


def third_octaves(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track,
    at: float | Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    **changes: ArrayLike,
) -> pd.DataFrame:
    """Third-octave r.m.s. values of the floor's acceleration, exact, one row per point and band.

    Parameters
    ----------
    speed : V in m/s, > 0. track : a spectrum or its name, a track or its file.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    weight : a weighting or its name.
    changes : parameter values in place of the vehicle's.

    Returns
    -------
    table : "position [m]", "band [Hz]" (nominal), "midband [Hz]", "a_rms [m/s^2]", "a_wrms
        [m/s^2]". What the track's spectrum does not hold is zero; ``table.attrs["remarks"]`` names
        it.

    Raises
    ------
    InputError : as :func:`stochastic_ride`.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> table = third_octaves(coach, 200 / 3.6, "erri_low")
    >>> float(table["band [Hz]"][table["a_wrms [m/s^2]"].idxmax()])
    10.0
    """
    import pandas as pd

    spectrum, remarks = track_spectrum(track, [speed])
    at, edges = several(at, "at", "m"), band_edges()
    gains = (PLAIN, weighted(weighting(weight)))
    m, rows = floor_in_hand(model, at, floor, changes)
    found = process(
        m, rows, model.wheelset_places(**changes).tolist(), speed, spectrum, gains,
        band=(float(edges[0]), float(edges[-1])), ends=edges.tolist(),
    ).integrals()  # fmt: skip
    middles = (found.edges[:-1] + found.edges[1:]) / 2
    inside = np.searchsorted(edges, middles) - 1 == np.arange(len(NUMBERS))[:, np.newaxis]
    a, a_w = np.sqrt(found.values @ inside.T.astype(float))
    table = pd.DataFrame({
        "position [m]": np.repeat(np.asarray(at, dtype=float), len(NUMBERS)),
        "band [Hz]": np.tile(nominal_frequencies(), len(at)),
        "midband [Hz]": np.tile(10.0 ** (np.array(NUMBERS) / 10), len(at)),
        "a_rms [m/s^2]": a.ravel(),
        "a_wrms [m/s^2]": a_w.ravel(),
    })  # fmt: skip
    table.attrs["remarks"] = remarks
    return table
