"""Third-octave bands of a stationary ride.

Midband frequencies f_n = 10^(n/10) Hz, edges f_n · 10^(±1/20) (base ten); the bands are called by
their nominal frequencies, 0.1 to 80 Hz. Each value is the integral over its band alone, an ideal
filter, so that the squares of all add up to the mean square from 0.0891 to 89.1 Hz.

Source: IEC 61260-1:2014, 5.2 to 5.5 and Annex E (midband, edge and nominal frequencies).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.numeric import Array
from railride.spectra import Spectrum, coverage_remark
from railride.stochastic.process import PLAIN, process, weighted
from railride.stochastic.ride import floor_in_hand
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

NUMBERS = range(-10, 20)  # n of the bands from 0.1 to 80 Hz
_NOMINAL = (1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0)


def band_edges() -> Array:
    """Edges of the third-octave bands, Hz, ascending: one more than there are bands.

    >>> band_edges()[[0, 1, -1]].round(4).tolist()
    [0.0891, 0.1122, 89.1251]
    """
    return np.asarray(10.0 ** ((np.arange(NUMBERS.start, NUMBERS.stop + 1) - 0.5) / 10))


def nominal_frequency(n: int) -> float:
    """What the band of midband frequency 10^(n/10) Hz is called.

    >>> [nominal_frequency(n) for n in (-10, 0, 5, 19)]
    [0.1, 1.0, 3.15, 80.0]
    """
    decade, within = divmod(n, 10)
    return round(_NOMINAL[within] * 10.0**decade, 6)


def third_octaves(
    model: VehicleModel,
    speed: float,
    spectrum: Spectrum,
    at: Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: Weighting | None = None,
    **changes: ArrayLike,
) -> pd.DataFrame:
    """Third-octave r.m.s. values of the floor's acceleration, exact, one row per point and band.

    Parameters
    ----------
    speed : V in m/s, > 0. spectrum : of the track. at : points of the floor, m forward of the
        body's middle. floor : "smooth" or "polygon". weight : default W_k.
    changes : parameter values in place of the vehicle's.

    Returns
    -------
    table : "position [m]", "band [Hz]" (nominal), "midband [Hz]", "a_rms [m/s^2]", "a_wrms
        [m/s^2]". What the spectrum does not hold is zero; ``table.attrs["remarks"]`` names it.

    Raises
    ------
    InputError : as :func:`stochastic_ride`.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle, spectrum
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> table = third_octaves(coach, 200 / 3.6, spectrum("erri_low"))
    >>> float(table["band [Hz]"][table["a_wrms [m/s^2]"].idxmax()])
    10.0
    """
    import pandas as pd

    edges = band_edges()
    gains = (PLAIN, weighted(weight or weighting("Wk")))
    m, rows = floor_in_hand(model, at, floor, changes)
    found = process(
        m, rows, model.vehicle.wheelset_positions, speed, spectrum, gains,
        band=(float(edges[0]), float(edges[-1])), ends=edges.tolist(),
    ).integrals()  # fmt: skip
    middles = (found.edges[:-1] + found.edges[1:]) / 2
    inside = np.searchsorted(edges, middles) - 1 == np.arange(len(NUMBERS))[:, np.newaxis]
    a, a_w = np.sqrt(found.values @ inside.T.astype(float))
    table = pd.DataFrame({
        "position [m]": np.repeat(np.asarray(at, dtype=float), len(NUMBERS)),
        "band [Hz]": np.tile([nominal_frequency(n) for n in NUMBERS], len(at)),
        "midband [Hz]": np.tile(10.0 ** (np.array(NUMBERS) / 10), len(at)),
        "a_rms [m/s^2]": a.ravel(),
        "a_wrms [m/s^2]": a_w.ravel(),
    })  # fmt: skip
    remark = coverage_remark(spectrum.name, spectrum.active_band, speed)
    table.attrs["remarks"] = [remark] if remark else []
    return table
