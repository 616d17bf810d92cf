"""From the distances of the rows to an even grid: faults, a step, and what had to be resampled."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from railride.errors import RowFaults
from railride.spectra import FloatArray
from railride.tables import Column, NumberTable
from railride.trackfile.locations import Locations
from railride.trackfile.steps import exact_step

STEPS = 1e-4, 1e3  # m, from row to row: what is finer or coarser is no record of a track
_OR_STEP = "or give the distance from row to row with --step"


@dataclass(frozen=True)
class Spacing:
    """``distance`` of the rows, m, rising, shape (n,); ``usual`` step, m; ``falling`` in the file.

    In a file whose distances fall the track is run as it was recorded: the distances are those of
    the file with a minus sign.
    """

    distance: FloatArray
    usual: float
    falling: bool = False
    remarks: tuple[str, ...] = ()


def stepped(table: NumberTable, found: Locations | None, column: Column | None,
            step: float) -> Spacing:  # fmt: skip
    """Rows ``step`` (m) apart from the first location on, whatever the others are."""
    count = np.arange(table.n, dtype=np.float64)
    if found is None or column is None or not np.isfinite(found.distance[0]):
        return Spacing(step * count, step)
    steps = np.diff(found.distance)
    usual = float(np.median(np.abs(steps[np.isfinite(steps)]))) if table.n > 1 else step
    own = "" if abs(usual - step) <= 0.02 * step else f", by which the rows are {usual:g} m apart"
    remark = (
        f"the rows are taken to be {step:g} m apart, as asked; of the locations in "
        f"{column.heading!r}{own}, only the first counts"
    )
    return Spacing(found.distance[0] + step * count, step, remarks=(remark,))


def spaced(table: NumberTable, found: Locations, column: Column, bad: RowFaults) -> Spacing:
    """Rows where their distances are.

    Steps that no track has, turn back, stand still, leave a gap or crowd are noted in ``bad``.
    """
    distance = found.distance
    steps = np.diff(distance)
    whole = np.isfinite(steps)  # not across a row that has a fault of its own
    falling = int(np.sum(steps < 0.0)) > int(np.sum(steps > 0.0))
    ahead = -steps if falling else steps
    forward = ahead[whole & (ahead > 0.0)]
    usual = float(np.median(forward)) if forward.size else 0.0
    wrong = whole & ((ahead < 0.5 * usual) | (ahead > 1.5 * usual) | (ahead <= 0.0))
    if forward.size and not STEPS[0] <= usual <= STEPS[1]:
        bad.add(table.row(0), column.heading, f"rows {usual:.3g} m apart",
                f"rows {STEPS[0]:g} to {STEPS[1]:g} m apart", "is the unit right?")  # fmt: skip
    for i in np.flatnonzero(wrong).tolist():
        _report(table, found, column, i, float(ahead[i]), usual, falling, bad)
    spacing = Spacing(distance, usual, remarks=found.remarks)
    if not falling:
        return spacing
    remark = (
        f"the distances in {column.heading!r} fall: the track is run as it was recorded, towards "
        "falling distances, and they are given a minus sign (--reverse runs it the other way)"
    )
    return replace(spacing, distance=-distance, falling=True, remarks=(*found.remarks, remark))


def _report(
    table: NumberTable, found: Locations, column: Column, i: int, ahead: float, usual: float,
    falling: bool, bad: RowFaults,
) -> None:  # fmt: skip
    """Note the step from row ``i`` to the next, which is none."""
    before, here = (found.distance[i : i + 2] / found.scale).tolist()
    said = f"{here:.12g} after {before:.12g}"
    if ahead == 0.0:
        said, mend = said + ", the same distance again", f"keep one of the two rows, {_OR_STEP}"
    elif ahead < 0.0:
        turn = "a rise" if falling else "a fall"
        said, mend = f"{said}, {turn}", f"sort the rows by distance, {_OR_STEP}"
    elif ahead > usual:
        said, mend = said + ", a gap", f"cut the record there or fill the gap, {_OR_STEP}"
    else:
        said, mend = said + ", a short step", f"resample the record evenly, {_OR_STEP}"
    as_elsewhere = f"a step near {usual / found.scale:.6g}, as elsewhere" if usual else "a rise"
    bad.add(table.row(i + 1), column.heading, said, as_elsewhere, mend)


def on_even_grid(
    table: NumberTable, distance: FloatArray, level: FloatArray
) -> tuple[float, FloatArray, list[str]]:
    """Step (m) and levels of the even grid that the distances are, or are resampled to.

    What lies within 2 % of a step of an even grid, or within the last printed digit, counts as
    rounding; other unevenness is resampled by the quintic spline through the samples, with a
    remark.
    """
    n = distance.size
    mean = float(distance[-1] - distance[0]) / (n - 1)
    places = np.arange(n)
    step = exact_step(distance)
    if step is not None:
        return step, level, []
    departure = float(np.max(np.abs(distance[0] + mean * places - distance)))
    if departure <= max(0.02 * mean, 0.51 * _printed_digit(distance)):
        return mean, level, []

    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline((distance - distance[0]) / mean, level, k=5)
    steps = np.diff(distance)
    rows = [table.row(int(place) + 1) for place in (np.argmin(steps), np.argmax(steps))]
    remark = (
        f"uneven steps of {np.min(steps):.4g} to {np.max(steps):.4g} m (before rows {rows[0]} and "
        f"{rows[1]}) were resampled to {mean:.6g} m by a spline"
    )
    return mean, np.asarray(spline(places)), [remark]


def _printed_digit(distance: FloatArray) -> float:
    """Last decimal place (m) that the distances have in print; 0 where there is none by 1e-4 m."""
    for digit in (0.1, 0.01, 0.001, 1e-4):
        counts = distance / digit
        if np.all(np.abs(counts - np.round(counts)) < 1e-5):
            return digit
    return 0.0
