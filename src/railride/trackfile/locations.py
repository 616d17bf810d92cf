"""Metres along the track from what stands in a file: numbers with a unit, or kilometre and metre.

A location such as ``130+0100.25`` or ``km 12+345.6`` is 1000 times the kilometre and the metre.
Kilometres between two stones are not all 1000 m long, and a counter is set right at a stone or a
balise, while the car goes on to sample evenly. Where the kilometre changes, or the location goes
back by less than 10 m within one, the rows are therefore taken to be as far apart as elsewhere,
which a remark says; any other step that is none is left for :mod:`railride.trackfile.spacing`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railride.errors import RowFaults
from railride.spectra import FloatArray
from railride.tables import Column, NumberTable
from railride.trackfile.cells import is_km_and_m, is_number, kilometre_and_metre

_LONGEST_RESET = 10.0  # m, by which a location goes back where a counter was set right
_LONGEST_KILOMETRE = 100.0  # m, by which a kilometre is longer or shorter than 1000 m
_SHOWN = 3


@dataclass(frozen=True)
class Locations:
    """``distance``, m, shape (n,), NaN where a row has none; what is printed before it ``scale``.

    ``remarks``: on counters set right.
    """

    distance: FloatArray
    scale: float
    remarks: tuple[str, ...] = ()


def locations(table: NumberTable, column: Column, metres: float, bad: RowFaults) -> Locations:
    """Distances of the rows; ``metres`` in one unit of a ``column`` of numbers.

    What is no number or no location is noted in ``bad``.
    """
    if not is_km_and_m(column):
        for i in column.bad.tolist():
            bad.add(table.row(i), column.heading, column.shown(i),
                    "a finite number" if is_number(column.cells[i]) else "a number",
                    "" if column.cells[i] else "fill it, or cut the record there")  # fmt: skip
        return Locations(np.asarray(column.numbers * metres, dtype=np.float64), metres)
    found = [kilometre_and_metre(cell) for cell in column.cells]
    for i in [i for i, pair in enumerate(found) if pair is None]:
        bad.add(table.row(i), column.heading, column.shown(i),
                "kilometre and metre, as in 130+0100.25")  # fmt: skip
    kilometre, metre = np.array([pair or (np.nan, np.nan) for pair in found]).T
    return _counted_on(table, column, kilometre, metre)


def _counted_on(
    table: NumberTable, column: Column, kilometre: FloatArray, metre: FloatArray
) -> Locations:
    """Distances that go on evenly where the kilometre changes or a counter was set right."""
    distance = 1000.0 * kilometre + metre
    steps, changed = np.diff(distance), np.diff(kilometre)
    way = -1.0 if np.sum(steps < 0.0) > np.sum(steps > 0.0) else 1.0
    ahead = way * steps
    if np.any(np.isnan(distance)) or not np.any(ahead > 0.0):
        return Locations(distance, 1.0)
    usual = float(np.median(ahead[ahead > 0.0]))
    odd = np.abs(ahead - usual) > 0.5 * usual
    stones = odd & (np.abs(changed) == 1.0) & (np.abs(ahead - usual) <= _LONGEST_KILOMETRE)
    resets = odd & (changed == 0.0) & (ahead < 0.0) & (ahead > -_LONGEST_RESET)
    remarks = _on_resets(table, column, np.flatnonzero(resets).tolist(), usual)
    if np.any(stones):
        first = int(np.flatnonzero(stones)[0]) + 1
        remarks.append(
            f"{np.sum(stones)} kilometres are not 1000 m long, the first before row "
            f"{table.row(first)} ({column.cells[first - 1]} to {column.cells[first]}): the rows "
            f"are taken to be {usual:g} m apart there as elsewhere"
        )
    if not remarks:
        return Locations(distance, 1.0)
    steps = np.where(stones | resets, way * usual, steps)
    distance = distance[0] + np.concatenate([[0.0], np.cumsum(steps)])
    return Locations(distance, 1.0, tuple(remarks))


def _on_resets(table: NumberTable, column: Column, places: list[int], usual: float) -> list[str]:
    """Remarks on the rows where a location goes back."""
    remarks = [
        f"{table.where(i + 1, column)}: the location goes back from {column.cells[i]} to "
        f"{column.cells[i + 1]}; taken for a counter set right, the rows being {usual:g} m apart "
        "there as elsewhere (if the car went back, cut the file there)"
        for i in places[:_SHOWN]
    ]
    if len(places) > _SHOWN:
        remarks.append(f"the location goes back in {len(places) - _SHOWN} more rows, likewise")
    return remarks
