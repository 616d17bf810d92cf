r"""Suspension travel, wheel load and other outputs of a stationary ride: r.m.s. and expected peak.

.. math:: \nu = \sqrt{m_2/m_0}, \quad m_k = \int f^k S_y\, df, \qquad
          E[\max_T y] = \sigma_y \left(\sqrt{2 \ln \nu T} + \frac{0.5772}{\sqrt{2 \ln \nu T}}\right)

ν is the rate of zero up-crossings and T the duration; the peak is the expected largest value to one
side (extension, say), and by symmetry to the other. Upcrossings of a high level come as a Poisson
process; with few of them (νT < 10) the formula is not to be trusted.

Wheel loads are taken after a Butterworth low-pass of fourth order, -3 dB at 20 Hz (24 dB per
octave): above it the track and the wheelset on it, which are rigid here, decide.

Source: D.E. Cartwright, M.S. Longuet-Higgins, Proc. R. Soc. A 237 (1956) 212-232; A.G. Davenport,
Proc. Inst. Civ. Eng. 28 (1964) 187-196; S.O. Rice, Bell Syst. Tech. J. 23-24 (1944-45). 20 Hz:
EN 14363 (vertical wheel force Q).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.quantities import check_number
from railride.spectra import Spectrum
from railride.statespace import chosen_outputs
from railride.stochastic.gains import PLAIN, Gain
from railride.stochastic.measured import track_spectrum
from railride.stochastic.process import BAND_HZ, process, relative
from railride.stochastic.ride import in_hand
from railride.track import Track
from railride.vehicle import Output, VehicleModel

if TYPE_CHECKING:
    import pandas as pd

DISTANCE = 1000.0  # m, over which a peak is expected
EULER = 0.5772156649015329
LOW_PASS_HZ, LOW_PASS_ORDER = 20.0, 4
FEW_CROSSINGS = 10.0


@dataclass(frozen=True)
class Extreme:
    """One output of a stationary ride over a duration, SI units.

    rms : σ_y. crossings : ν, zero up-crossings a second. peak : E[max y], None with few crossings.
    low_pass : Hz, None where none was used. error : estimated relative error of the r.m.s.
    """

    name: str
    unit: str
    rms: float
    crossings: float
    peak: float | None
    low_pass: float | None
    error: float


def expected_peak(rms: ArrayLike, crossings: ArrayLike, duration: ArrayLike) -> Array:
    """E[max y] over a duration T, s: σ (√(2 ln νT) + 0.5772/√(2 ln νT)); NaN where νT < 10.

    rms : σ. crossings : ν, zero up-crossings a second.

    >>> round(float(expected_peak(1.0, 10.0, 100.0)), 3)
    3.872
    """
    times = np.asarray(crossings, dtype=float) * np.asarray(duration, dtype=float)
    enough = times >= FEW_CROSSINGS
    root = np.sqrt(2 * np.log(np.where(enough, times, np.e)))
    return np.asarray(np.where(enough, np.asarray(rms) * (root + EULER / root), np.nan))


def low_pass(corner: float, order: int = LOW_PASS_ORDER) -> Gain:
    """|W(f)|² = 1/(1 + (f/f_c)^2n): Butterworth, -3 dB at the corner f_c, Hz."""
    roots = corner**2 * np.exp(1j * np.pi * (2 * np.arange(order) + 1) / order)
    return Gain(corner ** (2 * order), (), tuple(roots.tolist()))


def moment(gain: Gain, order: int) -> Gain:
    """|W(f)|² f^k, k even, whose integral is the spectral moment m_k."""
    return gain * Gain(1.0, (0.0,) * (order // 2))


def extremes(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track,
    outputs: Output | str | Sequence[Output | str] | None = None,
    *,
    distance: float | None = None,
    duration: float | None = None,
    corner: float = LOW_PASS_HZ,
    band: tuple[float, float] = BAND_HZ,
    **changes: ArrayLike,
) -> list[Extreme]:
    """R.m.s. and expected peak of outputs; arguments and errors as :func:`output_statistics`."""
    spectrum, _ = track_spectrum(track, [speed])
    T = _duration(speed, distance, duration)
    if outputs is None:
        outputs = [name for name in model.outputs if "deflection" in name or "load" in name]
    chosen = chosen_outputs(model, outputs)
    faults = Faults("outputs")
    check_number(faults, "corner", corner, "> 0", "Hz")
    faults.raise_if_any()
    m, rows = in_hand(model, chosen, changes)
    gains = tuple(moment(gain, k) for gain in (PLAIN, low_pass(corner)) for k in (0, 2))
    places = model.wheelset_places(**changes).tolist()
    found = process(m, rows, places, speed, spectrum, gains, band=band).integrals()
    squares, errors = found.mean_square, found.error
    result = []
    for k, output in enumerate(chosen):
        first = 2 if output.name.startswith("wheel_load") else 0
        m_0, m_2 = squares[first, k], squares[first + 1, k]
        sigma, crossings = np.sqrt(m_0), np.sqrt(relative(m_2[np.newaxis], m_0[np.newaxis])[0])
        peak = float(expected_peak(sigma, crossings, T))
        result.append(
            Extreme(
                output.name,
                output.unit,
                float(sigma),
                float(crossings),
                None if np.isnan(peak) else peak,
                corner if first else None,
                float(errors[first, k] / 2),
            )
        )
    return result


def output_statistics(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track,
    outputs: Output | str | Sequence[Output | str] | None = None,
    *,
    distance: float | None = None,
    duration: float | None = None,
    corner: float = LOW_PASS_HZ,
    band: tuple[float, float] = BAND_HZ,
    **changes: ArrayLike,
) -> pd.DataFrame:
    """R.m.s. and expected peak of outputs of a stationary ride, one row each.

    Parameters
    ----------
    speed : V in m/s, > 0. track : a spectrum or its name, a track or its file.
    outputs : one or several, or their names; default every suspension deflection and wheel load.
    distance, duration : m or s over which the peak is expected, one of them; default 1000 m.
    corner : Hz, of the low-pass that wheel loads are taken after. band : from and to, Hz.
    changes : parameter values in place of the vehicle's.

    Returns
    -------
    table : "output", "unit", "rms" and "expected peak" in that unit, "zero up-crossings [1/s]",
        "low-pass [Hz]" (none where none was used), "error" (of the r.m.s., relative, estimated);
        ``table.attrs["remarks"]`` says where wheel loads are missing, and what to know of the
        track.

    Raises
    ------
    InputError : as :func:`stochastic_ride`; an output that does not exist; both or neither usable
        of distance and duration.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> table = output_statistics(coach, 200 / 3.6, "erri_low")
    >>> list(table["output"][:2]), bool((table["expected peak"] > 2 * table["rms"]).all())
    (['secondary_1_deflection', 'primary_1_deflection'], True)
    """
    import pandas as pd

    spectrum, remarks = track_spectrum(track, [speed])
    found = extremes(model, speed, spectrum, outputs, distance=distance, duration=duration,
                     corner=corner, band=band, **changes)  # fmt: skip
    table = pd.DataFrame(
        [
            {
                "output": one.name,
                "unit": one.unit,
                "rms": one.rms,
                "expected peak": one.peak,
                "zero up-crossings [1/s]": one.crossings,
                "low-pass [Hz]": one.low_pass,
                "error": one.error,
            }
            for one in found
        ]
    )
    table.attrs["remarks"] = remarks + (missing_loads(model) if outputs is None else [])
    return table


def missing_loads(model: VehicleModel) -> list[str]:
    """A remark on the bogies without wheel loads, if there are any, and on what gives them.

    >>> from railride import derive_vehicle, load_vehicle
    >>> [said.partition(":")[0] for said in missing_loads(derive_vehicle("cati2024", 1))]
    ['no wheel loads']
    """
    bogies = model.vehicle.bogies
    bare = [str(b) for b, bogie in enumerate(bogies, start=1) if bogie.wheelset_mass is None]
    if not bare:
        return []
    some = "" if len(bare) == len(bogies) else f" of bogie {' and '.join(bare)}"
    why = "the wheelsets' mass is not known (give bogie.wheelset_mass in the vehicle's file)"
    return [f"no wheel loads{some}: {why}"]


def _duration(speed: float, distance: float | None, duration: float | None) -> float:
    """T in s; a distance takes as long as the vehicle needs for it."""
    if distance is not None and duration is not None:
        raise InputError("peak: found both a distance and a duration; expected one of them")
    faults = Faults("peak")
    distance = DISTANCE if distance is None else distance
    check_number(faults, "distance", distance, "> 0", "m")
    if duration is not None:
        check_number(faults, "duration", duration, "> 0", "s")
    faults.raise_if_any()
    return float(distance / speed if duration is None else duration)
