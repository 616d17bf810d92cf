"""Levels of the rows in metres, and what is doubtful about them: dropouts, spikes, units.

A dropout is a run of cells without a number (blank, ``inv``), or of exact zeros that is longer than
3 rows and than twice the longest run of any other value: rounding repeats every value alike. A
spike is one sample that lies far off the line between its neighbours: its second difference is 12
times what is usual (by the median), and those beside it are half of it and contrary.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from railride.errors import Faults, RowFaults
from railride.spectra import FloatArray, unit_doubts
from railride.tables import Column, NumberTable, is_missing
from railride.trackfile.cells import is_number

_LEAST_ZEROS = 4  # rows
_SPIKE, _LEAST_SPIKE = 12.0, 5e-4  # times the usual second difference; m
_HIGHEST = 1e5  # m: what lies higher is no track, and its square may be no number
_SHOWN = 3

Runs = NDArray[np.int64]  # first place and the place after the last, shape (runs, 2)


def levels_of(
    table: NumberTable, column: Column, metres: float, step: float, fill: float, bad: RowFaults
) -> tuple[FloatArray, list[str]]:
    """Levels of a column, m, and remarks; dropouts of up to ``fill`` m are bridged.

    ``metres``: in one unit of the column; ``step``: from row to row, m. Cells that are no number or
    no level, and dropouts without a number that are not bridged, are noted in ``bad``.
    """
    with np.errstate(over="ignore"):
        level = np.asarray(column.numbers * metres, dtype=np.float64)
    for i in np.flatnonzero(np.abs(level) > _HIGHEST).tolist():
        bad.add(table.row(i), column.heading, column.shown(i), "irregularities of millimetres",
                "is the unit right?")  # fmt: skip
    blank = np.zeros(table.n, dtype=bool)
    for i in column.bad.tolist():
        if is_missing(column.cells[i]):
            blank[i] = True
        else:
            _report_cell(table, column, i, bad)
    holes, zeros = _runs(blank), _zero_runs(level)
    most = int(fill / step * (1.0 + 1e-9))

    def short(runs: Runs) -> NDArray[np.bool_]:  # and with something to bridge it from
        inside = (runs[:, 0] > 0) & (runs[:, 1] < table.n)
        return inside & (runs[:, 1] - runs[:, 0] <= most)

    for first, end in holes[~short(holes)].tolist():
        _report_hole(table, column, first, end, step, bad)
    bridged = np.concatenate([holes[short(holes)], zeros[short(zeros)]])
    kept = zeros[~short(zeros)]
    remarks = _on_runs(table, column, kept, step, "exactly zero, a dropout? kept as they are")
    remarks += _on_runs(table, column, bridged, step, "without a level, bridged as --fill asks")
    return _bridge(level, bridged), remarks


def _report_cell(table: NumberTable, column: Column, i: int, bad: RowFaults) -> None:
    """Note a cell that is something else than a finite number."""
    cell, expected, mend = column.cells[i], "a number", ""
    if is_number(cell):
        expected, mend = "a finite number", "cut the record there"
    elif "," in cell:
        mend = "decimal commas: throughout, and ; between"
    bad.add(table.row(i), column.heading, column.shown(i), expected, mend)


def _report_hole(
    table: NumberTable, column: Column, first: int, end: int, step: float, bad: RowFaults
) -> None:
    """Note a dropout without a number."""
    count, found = end - first, column.shown(first)
    blank = not column.cells[first]
    mend = f"fill it, cut the record there, or bridge it with --fill {count * step:.6g}"
    if count > 1:
        found = f"{found} and no number as far as row {table.row(end - 1)}, {count * step:.6g} m"
    bad.add(table.row(first), column.heading, found,
            "a number" if blank else "a finite number", mend)  # fmt: skip


def _on_runs(table: NumberTable, column: Column, runs: Runs, step: float, what: str) -> list[str]:
    """Remarks on dropouts, with place and length: the longest in full."""
    longest = runs[np.argsort(-np.diff(runs)[:, 0], kind="stable")]
    remarks = [
        f"rows {table.row(first)} to {table.row(end - 1)}, column {column.heading!r}: "
        f"{(end - first) * step:.6g} m {what}"
        for first, end in longest[:_SHOWN].tolist()
    ]
    if len(longest) > _SHOWN:
        total = float(np.sum(np.diff(longest[_SHOWN:]))) * step
        remarks.append(
            f"column {column.heading!r}: {len(longest) - _SHOWN} more such places, {total:.6g} m "
            "in all"
        )
    return remarks


def _runs(true: NDArray[np.bool_]) -> Runs:
    """First and past-the-last places of the runs of True."""
    edges = np.diff(np.concatenate([[False], true, [False]]).astype(np.int8))
    return np.column_stack([np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)])


def _zero_runs(level: FloatArray) -> Runs:
    """Runs of exact zeros that rounding does not explain; none where all is zero."""
    zeros = _runs(level == 0.0)
    same = _runs((np.diff(level) == 0.0) & (level[1:] != 0.0))
    longest = 1 + int(np.max(np.diff(same), initial=0))
    least = max(_LEAST_ZEROS, 2 * longest + 1)
    return zeros[np.diff(zeros)[:, 0] >= least] if np.any(level != 0.0) else zeros[:0]


def _bridge(level: FloatArray, runs: Runs) -> FloatArray:
    """Put the shape-preserving cubic through what is around each run in its place."""
    if not len(runs):
        return level
    from scipy.interpolate import PchipInterpolator

    inside = np.zeros(level.size, dtype=bool)
    for first, end in runs.tolist():
        inside[first:end] = True
    good = np.flatnonzero(~inside & np.isfinite(level))
    places, filled = np.flatnonzero(inside), level.copy()
    if good.size >= 2:
        filled[places] = PchipInterpolator(good, level[good], extrapolate=False)(places)
    return filled


def check_departure(table: NumberTable, column: Column, level: FloatArray, faults: Faults) -> None:
    """Refuse a level that departs by more than a metre from a straight line: no railway does."""
    from scipy.signal import detrend

    departure = np.abs(detrend(level))
    i = int(np.argmax(departure))
    if not departure[i] <= 1.0:
        faults.add(
            table.where(i, column),
            f"a level {departure[i]:.3g} m off the straight line through the record",
            "irregularities of millimetres, 1 m at most",
            "if the numbers are millimetres, head the column level_mm or give --level-unit mm",
        )
    faults.raise_if_any()


def doubts(table: NumberTable, column: Column, level: FloatArray, step: float) -> list[str]:
    """Remarks on spikes, and on levels that a slip of the unit would explain."""
    rms, slope = float(np.std(level)), float(np.std(np.diff(level))) / step
    remarks = [*_on_spikes(table, column, level), *unit_doubts(rms, slope, column.heading)]
    mean = float(np.mean(level))
    if abs(mean) > 1.0:
        remarks.append(
            f"the level lies about {mean:.3g} m from zero; kept, as it changes no acceleration"
        )
    return remarks


def _on_spikes(table: NumberTable, column: Column, level: FloatArray) -> list[str]:
    """A remark on single samples far off their neighbours."""
    off = level[1:-1] - (level[:-2] + level[2:]) / 2.0
    usual = float(np.median(np.abs(off))) / 0.6745  # of a Gaussian: its standard deviation
    here, beside = off[1:-1], np.minimum(-off[:-2] * np.sign(off[1:-1]),
                                         -off[2:] * np.sign(off[1:-1]))  # fmt: skip
    spikes = np.flatnonzero(
        (np.abs(here) > max(_SPIKE * usual, _LEAST_SPIKE)) & (beside > 0.3 * np.abs(here))
    )
    if not spikes.size:
        return []
    worst = int(spikes[np.argmax(np.abs(here[spikes]))])
    said = "a sample far off its neighbours"
    if spikes.size > 1:
        said = f"{spikes.size} samples far off their neighbours, the worst"
    where = table.where(worst + 2, column)
    return [f"{where}: {said} by {1000.0 * here[worst]:.3g} mm: a spike? kept as it is"]
