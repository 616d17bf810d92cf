"""Where a record is whole and where not: pieces of rows between gaps, none of them bridged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.records.clock import FloatArray
from railride.tables import NumberTable

GAP = 1.5  # steps from one row to the next: more is a dropped sample, less an uneven step
_SHOWN = 5


@dataclass(frozen=True)
class Rows:
    """Contiguous stretches of rows, each [first[k], stop[k])."""

    first: NDArray[np.int64]
    stop: NDArray[np.int64]

    @property
    def lengths(self) -> NDArray[np.int64]:
        """Rows of each."""
        return self.stop - self.first

    def slices(self) -> list[slice]:
        """Of arrays of rows."""
        return [slice(a, b) for a, b in zip(self.first.tolist(), self.stop.tolist(), strict=True)]


def scatter(seconds: FloatArray, digit: float) -> float:
    """How far rounding may put a time off (s): the times' resolution, where it is felt as such.

    seconds: of the rows (n,), NaN where unknown.
    digit: what all times are multiples of (s).

    Times such as 0.01, 0.02, 0.03 s are multiples of their step, but are not rounded to it: two
    steps at once are then a dropped sample. They are rounded where steps of one digit more or less
    are common, or, if rare, so even that a line goes through all times.
    """
    there = np.flatnonzero(np.isfinite(seconds))
    steps = np.diff(seconds[there])
    if steps.size == 0 or digit <= 0.3 * float(np.median(steps)):
        return digit
    odd = int(np.count_nonzero(np.abs(steps - np.median(steps)) > 0.5 * digit))
    if 10 * odd > steps.size:
        return digit
    line = np.polynomial.Polynomial.fit(there, seconds[there], 1)
    off = float(np.max(np.abs(seconds[there] - line(there))))
    return digit if odd >= 5 and off <= 0.51 * digit else 0.0


def usual_step(seconds: FloatArray, digit: float) -> float:
    """Typical time from one row to the next (s): the mean of those that are no gaps.

    seconds: of the rows (n,), NaN where unknown.
    digit: resolution (s) of the times, by which steps may scatter.
    """
    steps = np.diff(seconds)
    steps = steps[np.isfinite(steps)]
    if steps.size == 0:
        return 0.0
    return float(np.mean(steps[steps <= GAP * np.median(steps) + digit]))


def split(present: NDArray[np.bool_], seconds: FloatArray, step: float, digit: float) -> Rows:
    """Stretches of rows that have all their numbers and follow one another in time.

    present: rows (n,) that have them.
    seconds: times (n,).
    step: the usual one (s).
    digit: resolution of the times (s).
    """
    jump = np.diff(seconds) > GAP * step + digit
    joined = present[1:] & present[:-1] & ~jump
    first = np.flatnonzero(present & ~np.concatenate([[False], joined]))
    stop = np.flatnonzero(present & ~np.concatenate([joined, [False]])) + 1
    return Rows(first, stop)


def gap_remarks(
    table: NumberTable, rows: Rows, bad: NDArray[np.bool_], seconds: FloatArray, step: float
) -> list[str]:
    """What is missing, where, and for how long: the first gaps one by one, then their number.

    table: of the file.
    rows: the stretches that are there.
    bad: rows (n,) without a number or without a time.
    seconds: times (n,), NaN where unknown.
    step: the usual one (s).
    """
    remarks = []
    n = bad.size
    if rows.first[0] > 0:
        remarks.append(
            f"{_rows(table, 0, int(rows.first[0]))} at the start without a number: cut off"
        )
    if rows.stop[-1] < n:
        remarks.append(
            f"{_rows(table, int(rows.stop[-1]), n)} at the end without a number: cut off"
        )
    before, after = rows.stop[:-1], rows.first[1:]
    lost = seconds[after] - seconds[before - 1] - step
    for a, b, duration in list(zip(before.tolist(), after.tolist(), lost.tolist(), strict=True))[
        :_SHOWN
    ]:
        at = f"{duration:.4g} s at {seconds[a - 1]:.6g} s"
        if b > a:
            remarks.append(f"a gap of {at}: {_rows(table, a, b)} without a number")
        else:
            remarks.append(f"a gap of {at}: the time jumps at row {table.row(b)}")
    if before.size > _SHOWN:
        others = float(np.sum(lost[_SHOWN:]))
        remarks.append(f"{before.size - _SHOWN} more gaps, {others:.4g} s together")
    return remarks


def _rows(table: NumberTable, first: int, stop: int) -> str:
    """``row 17`` or ``rows 17 to 19 (3)``."""
    if stop - first == 1:
        return f"row {table.row(first)}"
    return f"rows {table.row(first)} to {table.row(stop - 1)} ({stop - first})"
