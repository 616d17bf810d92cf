"""What makes a record doubtful: saturated, stuck or dead sensors, gravity, a slip of the unit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from railride.comfort.record import Axis
from railride.records.clock import FloatArray
from railride.tables import Column, NumberTable
from railride.units import STANDARD_GRAVITY

_CLIPPED = 3  # equal samples in a row at the extreme
_STUCK = (20, 0.2)  # equal samples in a row, and seconds, elsewhere
# A peak's flat top of L equal samples in steps of q hides a height h ≤ q; a parabola through its
# ends falls by 8 h within L more samples on either side.
_HIDDEN = 1.5
_GLITCH = 20  # times the 99th percentile, in one sample whose neighbours have not a tenth of it


def sensor_remarks(
    table: NumberTable, column: Column, factor: float, seconds: FloatArray, rate: float
) -> list[str]:
    """Saturated and stuck stretches of one column, and whether it is dead.

    table: of the file.
    column: of accelerations.
    factor: m/s² per its unit.
    seconds: times of the rows (n,), s.
    rate: of the rows (Hz).
    """
    values = column.numbers.astype(np.float64)
    there = values[~np.isnan(values)]
    if there.size == 0:
        return []
    name = repr(column.heading)
    low, high = float(np.min(there)), float(np.max(there))
    if low == high:
        return [f"{name} is constant, {factor * low:.6g} m/s² throughout: a dead channel?"]
    first, lengths = _runs(values)
    quantum = _quantum(there)
    remarks = []
    for extreme, which in ((high, "largest"), (low, "smallest")):
        long = (values[first] == extreme) & (lengths >= _CLIPPED)
        ends = zip(np.flatnonzero(long).tolist(), first[long].tolist(), lengths[long].tolist(),
                   strict=True)  # fmt: skip
        places = [k for k, a, count in ends if _hides(values, a, count, quantum)]
        if places:
            where = _places(table, first, lengths, seconds, places)
            remarks.append(
                f"{name} seems saturated: at its {which} value, {factor * extreme:.6g} m/s², for "
                f"{_CLIPPED} samples or more in a row at {where}; the peaks that are cut off there "
                "are missing in the result"
            )
    still = (lengths >= max(_STUCK[0], _STUCK[1] * rate)) & (values[first] != low)
    still &= (values[first] != high) & (float(np.std(there)) > 20 * quantum)
    if np.any(still):
        places = np.flatnonzero(still).tolist()
        value = factor * values[first[places[0]]]
        remarks.append(
            f"{name} does not move, first at {value:.6g} m/s², at "
            f"{_places(table, first, lengths, seconds, places)}: a dropout?"
        )
    spikes = _glitches(values, there)
    if spikes.size:
        i = int(spikes[0])
        remarks.append(
            f"{name} has {spikes.size} single samples far from all others, the first in row "
            f"{table.row(i)} (t = {seconds[i]:.6g} s), {factor * values[i]:.4g} m/s²: glitches?"
        )
    return remarks


def _glitches(values: FloatArray, there: FloatArray) -> NDArray[np.int64]:
    """Places of samples that no neighbour leads up to."""
    middle = float(np.median(there))
    away = np.abs(values - middle)
    far = np.flatnonzero(away > _GLITCH * float(np.percentile(np.abs(there - middle), 99)))
    beside = np.pad(np.nan_to_num(away), 1)
    lonely = np.maximum(beside[far], beside[far + 2]) < 0.1 * away[far]
    return np.asarray(far[lonely & (beside[far + 1] > 0.0)])


def _runs(values: FloatArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First places and lengths of stretches of equal values."""
    edges = np.concatenate([[0], np.flatnonzero(values[1:] != values[:-1]) + 1, [values.size]])
    return edges[:-1], np.diff(edges)


def _quantum(values: FloatArray) -> float:
    """Least difference of two values: the digit of the converter, or of the print."""
    steps = np.diff(np.unique(values[:200_000]))
    return float(np.min(steps)) if steps.size else 0.0


def _hides(values: FloatArray, first: int, length: int, quantum: float) -> bool:
    """Whether a flat top is more than the rounding of a peak: what lies around it falls steeply."""
    around = [values[i] for i in (first - length, first + 2 * length - 1) if 0 <= i < values.size]
    falls = [abs(float(v) - float(values[first])) for v in around if not np.isnan(v)]
    return bool(falls) and min(falls) > 8 * _HIDDEN * quantum


def _places(
    table: NumberTable, first: NDArray[np.int64], lengths: NDArray[np.int64], seconds: FloatArray,
    places: list[int],
) -> str:  # fmt: skip
    """``3 places (11 samples), first in rows 20 to 23 (t = 0.19 s)``."""
    a = int(first[places[0]])
    b = a + int(lengths[places[0]]) - 1
    samples = int(np.sum(lengths[places]))
    many = f"{len(places)} places" if len(places) > 1 else "one place"
    return (
        f"{many} ({samples} samples), first in rows {table.row(a)} to {table.row(b)} "
        f"(t = {seconds[a]:.6g} s)"
    )


def level_remarks(
    axes: tuple[Axis, ...], scale: Sequence[float], rate: float, detrended: bool
) -> list[str]:
    """Gravity in the record, and numbers that another unit would explain.

    axes: before anything is removed from them, m/s².
    scale: m/s² per unit of each column in the file.
    rate: of their samples (Hz).
    detrended: whether the mean will be removed.
    """
    means = {axis.column: float(np.mean(np.concatenate(axis.pieces))) for axis in axes}
    spreads = {axis.column: float(np.std(np.concatenate(axis.pieces))) for axis in axes}
    remarks = _gravity(means, spreads, scale, detrended)
    for column, spread in spreads.items():
        if spread > 50.0:
            remarks.append(f"{column!r} has a standard deviation of {spread:.3g} m/s², far above "
                           "any vehicle's: is its unit right (mg, counts)?")  # fmt: skip
        elif 0.0 < spread < 0.002:
            remarks.append(f"{column!r} has a standard deviation of only {spread:.2g} m/s², as of "
                           "a vehicle at rest: is its unit right (g)?")  # fmt: skip
    if not 10.0 <= rate <= 1e5:
        remarks.append(f"the rate is {rate:.4g} Hz: is the unit of time right?")
    return remarks


def _gravity(
    means: dict[str, float], spreads: dict[str, float], scale: Sequence[float], detrended: bool
) -> list[str]:
    """Gravity or another offset in the means, or what gravity would be in another unit."""
    total = float(np.hypot.reduce(list(means.values())))
    largest = max(means, key=lambda column: abs(means[column]))
    does = "it is removed with the mean" if detrended else "detrending removes it"
    if 0.95 < total / STANDARD_GRAVITY < 1.05:
        mean = means[largest]
        return [f"gravity is in the record, mostly in {largest!r} (mean {mean:.4g} m/s²): {does}"]
    steady = abs(means[largest]) > 3 * spreads[largest]
    for unit, one, factor in (
        ("m/s²", STANDARD_GRAVITY, 1.0),
        ("g", 1.0, STANDARD_GRAVITY),
        ("mg", 1000.0, STANDARD_GRAVITY / 1000),
    ):
        others = all(abs(f / factor - 1.0) > 0.01 for f in scale)
        if steady and others and 0.95 < total / scale[0] / one < 1.05:
            written = f"the mean is {total / scale[0]:.4g} as written in the file"
            return [f"{written}, which is gravity in {unit}: is that the unit?"]
    return [f"{column!r} has an offset, its mean is {mean:.4g} m/s²: {does}"
            for column, mean in means.items()
            if abs(mean) > 0.5 and abs(mean) > 3 * spreads[column]]  # fmt: skip
