"""Times of a record's rows: seconds or fractions of them, since the start or 1970, or as texts."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from railride.errors import RowFaults
from railride.records.scaling import time_unit
from railride.tables import Column, NumberTable, is_missing
from railride.units import QuantityError, to_si

if TYPE_CHECKING:
    import pandas as pd

FloatArray = NDArray[np.float64]

_CLOCK = re.compile(r"(?:\d+ days? )?(?:\d{1,2}:)?\d{1,2}:\d{2}(?:\.\d+)?")
_DATED = re.compile(r"(?P<date>\d{1,4}[./-]\d{1,2}[./-]\d{1,4})[ T]+(?P<clock>\d.*)")
_DAY = 86_400 * 10**9  # ns
# Since 1970: the unit by the size of a stamp from 1973 on.
_SINCE_1970 = (("ns", 1e17), ("µs", 1e14), ("ms", 1e11), ("s", 1e8))
# A record that is rated has a rate like this (Hz); it tells what a column of bare numbers counts.
_USUAL_RATES = (10.0, 20_000.0)
_SLOWEST = 2.0
_LARGEST = 1e20
_MANY = 3  # times that are there twice: rounding makes more than one
_A_TIME = "a time, as in the other rows"


@dataclass(frozen=True)
class Clock:
    """Times of the rows.

    seconds: since the first row that has a time (n,); NaN where it has none.
    digit: the times' resolution (s): the last digit they are printed or stored with.
    remarks: how they were read.
    """

    seconds: FloatArray
    digit: float
    remarks: tuple[str, ...]


def read_clock(table: NumberTable, column: Column, bad: RowFaults) -> Clock:
    """Read a time column: numbers in a unit, or dates and times of day as texts.

    table: of the file.
    column: its times. Their unit is the heading's; without one, stamps since 1970 are told by their
        size, other numbers are seconds, unless that makes less than 2 Hz and one other unit a usual
        rate.
    bad: gathers the cells that are no times, times that fall or stand still, and an unknown unit.
    """
    if _are_texts(column):
        ticks, unit, remarks = _of_texts(table, column, bad), "ns", list[str]()
    else:
        for i in column.bad.tolist():
            if not is_missing(column.cells[i]):
                bad.add(table.row(i), column.heading, column.shown(i), _A_TIME)
        ticks = _without_huge(table, column, _exact(column), bad)
        unit, remarks = _unit(column, ticks, bad)
    there = np.flatnonzero(_present(ticks))
    if there.size == 0:
        return Clock(np.full(table.n, np.nan), 0.0, ())
    scale = to_si(1.0, unit)
    largest = float(np.max(np.abs(ticks[there]).astype(np.float64)))
    seconds = (ticks - ticks[there[0]]) * scale
    seconds[~_present(ticks)] = np.nan
    digit = scale * _digit(ticks[there], largest)
    _check_rising(table, column, seconds, digit, bad)
    return Clock(seconds, digit, tuple(remarks))


def _are_texts(column: Column) -> bool:
    """Whether most cells that are not blank are texts."""
    places = column.bad
    some = places[:: max(places.size // 100, 1)].tolist()
    texts = sum(not is_missing(column.cells[i]) for i in some)
    count = texts * places.size / max(len(some), 1)
    return texts > 0 and count >= column.numbers.size - places.size


def _present(ticks: NDArray[Any]) -> NDArray[np.bool_]:
    """Which rows have a time: whole numbers mark those that have none by their least one."""
    if ticks.dtype.kind == "i":
        return np.asarray(ticks != np.iinfo(np.int64).min)
    return np.asarray(~np.isnan(ticks))


def _exact(column: Column) -> NDArray[Any]:
    """The numbers; whole ones too long for a float, beside blanks, again from the texts."""
    numbers = column.numbers
    if numbers.dtype.kind == "i" or not np.nanmax(np.abs(numbers), initial=0.0) >= 2.0**53:
        return numbers
    none = int(np.iinfo(np.int64).min)
    whole = [int(c) if re.fullmatch(r"[+-]?\d{1,18}|\d{19}", c) else none for c in column.cells]
    found = [w for w in whole if w != none]
    if len(found) == numbers.size - column.bad.size and max(found) < 2**63:
        return np.array(whole, dtype=np.int64)
    return numbers


def _without_huge(
    table: NumberTable, column: Column, ticks: NDArray[Any], bad: RowFaults
) -> NDArray[Any]:
    """Note and leave out numbers beyond any time since 1970, in ns."""
    if ticks.dtype.kind == "i":
        return ticks
    huge = np.abs(ticks) > _LARGEST
    for i in np.flatnonzero(huge)[: bad.shown].tolist():
        bad.add(table.row(i), column.heading, column.shown(i), _A_TIME)
    return np.where(huge, np.nan, ticks)


def _unit(column: Column, ticks: NDArray[Any], bad: RowFaults) -> tuple[str, list[str]]:
    """Unit of the numbers, by heading, size, or the rate they make; and how it is known."""
    try:
        unit = time_unit(column)
    except QuantityError as error:
        bad.faults.add(f"column {column.heading!r}", error.found, error.expected, "head it so")
        return "s", []
    there = ticks[_present(ticks)]
    if unit or there.size < 2:
        return unit or "s", []
    first = float(there[0])
    for since, least in _SINCE_1970:
        if least <= first < 1000 * least:
            day = datetime.fromtimestamp(first * to_si(1.0, since), UTC)
            told = (
                f"{column.heading!r} is taken as {since} since 1970: from {day:%Y-%m-%d %H:%M} UTC"
            )
            return since, [told]
    steps = np.diff(there).astype(np.float64)
    step = float(np.median(steps[steps > 0.0])) if np.any(steps > 0.0) else 0.0
    if step * _SLOWEST <= 1.0:
        return "s", []
    low, high = _USUAL_RATES
    likely = [u for u in ("ms", "µs", "ns") if low <= 1.0 / (step * to_si(1.0, u)) <= high]
    if len(likely) == 1:
        rate = 1.0 / (step * to_si(1.0, likely[0]))
        return likely[0], [f"{column.heading!r} is taken as {likely[0]}, which makes {rate:.6g} Hz"]
    bad.faults.add(
        f"column {column.heading!r}",
        f"steps of {step:.6g} and no unit",
        "a unit of time that makes a record of some 100 Hz",
        f"head it {column.heading} [ms] or whatever the unit is",
    )
    return "s", []


def _digit(ticks: NDArray[Any], largest: float) -> float:
    """Resolution of the times, in their unit: what all are multiples of; 0 where nothing is."""
    if ticks.dtype.kind == "i":
        return float(np.gcd.reduce(ticks - ticks[0]))
    stored = float(np.spacing(largest))
    if largest >= 2.0**53:
        return stored
    if np.array_equal(ticks.astype(np.float32), ticks):
        stored = float(np.spacing(np.float32(largest)))
    for digit in (1.0, 0.1, 0.01, 0.001, 1e-4, 1e-5, 1e-6):
        counts = ticks / digit
        if np.all(np.abs(counts - np.round(counts)) < 1e-5 + 2.0 * np.spacing(np.abs(counts))):
            return max(digit, stored)
    return stored


def _of_texts(table: NumberTable, column: Column, bad: RowFaults) -> NDArray[np.int64]:
    """Dates and times of day in ns; a time of day that passes midnight goes on."""
    import pandas as pd

    cells = pd.Series([c.replace(",", ".").rstrip("Z") for c in column.cells], dtype=object)
    sample = next(c for c in cells if not is_missing(c))
    if _CLOCK.fullmatch(sample):
        times = _clock_times(cells)
        there = times != pd.NaT.value
        falls = np.diff(times[there], prepend=times[there][:1]) < -_DAY // 2
        times[there] += _DAY * np.cumsum(falls)
    elif _DATED.fullmatch(sample) and not re.match(r"\d{4}", sample):
        dated = cells.str.extract(_DATED)
        dates = dated["date"].fillna("")
        same = dates[dates != ""].nunique() == 1
        form = "%d.%m.%Y"  # which alone is certain; of other forms only the time of day counts
        days = None if same else pd.to_datetime(dates, format=form, errors="coerce")
        times = _clock_times(dated["clock"])
        if days is not None:
            since = days.astype("datetime64[ns]").to_numpy().view(np.int64)
            times = np.where(since == pd.NaT.value, since, times + since)
    else:
        stamps = pd.to_datetime(cells, format="ISO8601", utc=True, errors="coerce")
        times = stamps.dt.tz_localize(None).astype("datetime64[ns]").to_numpy().view(np.int64)
    for i in np.flatnonzero(times == pd.NaT.value).tolist():
        if not is_missing(column.cells[i]):
            bad.add(
                table.row(i),
                column.heading,
                column.shown(i),
                _A_TIME,
                "write dates as 2024-01-31T12:00:00.000",
            )
    return np.asarray(times, dtype=np.int64)


def _clock_times(cells: pd.Series[Any]) -> NDArray[np.int64]:
    """Times of day, or spans (h:min:s, or min:s), in ns; the least number where there is none."""
    import pandas as pd

    whole = cells.fillna("").str.replace(r"^(\d{1,2}:\d{2}(?:\.\d+)?)$", r"00:\1", regex=True)
    whole = whole.where(whole.str.fullmatch(_CLOCK.pattern), None)
    spans = pd.to_timedelta(whole, errors="coerce")
    return np.array(spans.astype("timedelta64[ns]").to_numpy().view(np.int64))


def _check_rising(
    table: NumberTable, column: Column, seconds: FloatArray, digit: float, bad: RowFaults
) -> None:
    """Note the rows at which the time falls or stands still; ``digit`` (s) is its resolution."""
    there = np.flatnonzero(~np.isnan(seconds))
    steps = np.diff(seconds[there])
    wrong = np.flatnonzero(steps <= 0.0)
    if wrong.size == 0:
        return
    if np.all(steps < 0.0) and steps.size > 1:
        row = table.row(int(there[1]))
        bad.add(
            row, column.heading, "times that fall throughout", "rising ones", "reverse the rows"
        )
        return
    still = np.count_nonzero(steps == 0.0)
    mend, rated = "keep one of the rows, or sort them by time", "give the rate instead (--rate)"
    if 4 * still > steps.size:
        mend = f"the times have too few digits: {rated}"
    elif still >= _MANY and 2 * digit * steps.size > float(np.sum(steps)):
        # Rounding to a digit near the step makes twins of rows that are none.
        mend = f"if the times are rounded to {digit:.3g} s, {rated}; keep one of two rows only if "
        mend += "it is there twice"
    for k in wrong[: bad.shown].tolist():
        before, here = (column.cells[int(i)] for i in there[k : k + 2])
        kind = "the same time again" if steps[k] == 0.0 else "a fall"
        found = f"{here} after {before}, {kind}"
        bad.add(table.row(int(there[k + 1])), column.heading, found, "rising times", mend)
    bad.leave_out(wrong.size - bad.shown)
