"""Which columns of a table are accelerations, in which direction, and which one is the time."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from railride.comfort.record import AxisName
from railride.errors import Faults
from railride.records.scaling import UNITS_OF_TIME, is_acceleration
from railride.tables import Column, NumberTable

# Names of time columns, most telling first.
_TIMES = (
    "time", "t", "timestamp", "time stamp", "timestamps", "datetime", "date time", "times",
    "seconds elapsed", "elapsed time", "elapsed", "seconds", "relative time", "rel time",
    "unix time", "epoch", "clock", "zeit", "zeitstempel", "temps", "tempo", "tiempo", "tid", "aika",
    "x value", "index level 0", "date",
)  # fmt: skip
_DIRECTION = re.compile(
    r"(?:lin|linear)?(?:a|acc|accel|accelerometer|acceleration|gf|gforce)?"
    r"(?P<axis>[xyz])(?:a|acc|accel|acceleration|axis|achse)?"
)
_WORDS: dict[str, AxisName] = {
    "vertical": "z", "vertikal": "z", "verticale": "z", "vert": "z",
    "lateral": "y", "laterale": "y", "transverse": "y", "transversal": "y", "quer": "y",
    "longitudinal": "x", "longitudinale": "x", "längs": "x", "laengs": "x",
}  # fmt: skip
# Other sensors, whose x, y and z are no accelerations.
_OTHERS = re.compile(
    r"gyro|rotat|angular|mag(?:n|netic)?\b|magneto|quat|euler|^gravity|orient|gps|latitude|longitude"
    r"|displacement|velocity|speed|jerk|pitch|roll|yaw"
)


_NAME_THEM = "name them by --column, and the times by --time-column (columns=, time_column=)"


@dataclass(frozen=True)
class Choice:
    """The columns of accelerations with their directions, and the time's, if there is one."""

    columns: tuple[Column, ...]
    directions: tuple[AxisName | None, ...]
    clock: Column | None
    remarks: tuple[str, ...]


def choose(
    table: NumberTable, columns: Sequence[str], time_column: str | None, rate: float | None
) -> Choice:
    """Choose by name, or by what the headings tell.

    table: of the file.
    columns: headings or names of the accelerations; none: those whose headings have a direction
        (x, az, acc_y, Vertical, …), or the one column of numbers beside the time.
    time_column: heading or name of the times; None: the one called time, t, timestamp, … if any.
    rate: given instead of times (Hz); a time column that is there is then passed over.

    Raises InputError: no such column, twice, none that tells, two of the same direction.
    """
    faults, remarks = Faults(table.source), list[str]()
    named = [table.column(name) for name in columns]
    for column, count in Counter(named).items():
        if count > 1:
            faults.add(f"column {column.heading!r}", f"it is named {count} times", "each once")
    clock = table.column(time_column) if time_column is not None else _clock(table, named)
    if clock is not None and clock in named:
        faults.add(f"column {clock.heading!r}", "times", "an acceleration", "name another column")
    faults.raise_if_any()
    chosen = named or _found([c for c in table.columns if c is not clock], faults, remarks)
    directions = _directions(chosen, remarks)
    if clock is not None and rate is not None and time_column is None:
        remarks.append(f"the column {clock.heading!r} was not used: the rate is given")
        clock = None
    return Choice(tuple(chosen), tuple(directions), clock, tuple(remarks))


def _clock(table: NumberTable, named: Sequence[Column]) -> Column | None:
    """The column that is called time, by the most telling name."""
    for name in _TIMES:
        for column in table.find(name):
            if column not in named and _may_be_time(column):
                return column
    stamps = [c for c in table.columns if c.unit == "ns" and c not in named]
    return stamps[0] if stamps else None


def _may_be_time(column: Column) -> bool:
    unit = column.unit.strip().lower()
    return not unit or unit in UNITS_OF_TIME or not re.search(r"[a-z°%]", unit)


def _found(columns: list[Column], faults: Faults, remarks: list[str]) -> list[Column]:
    """Columns that tell a direction, each direction once; or else the only one of numbers."""
    numbers = [c for c in columns if c.numbers.dtype.kind == "i" or not np.all(np.isnan(c.numbers))]
    empty = [c.heading for c in columns if c not in numbers and direction(c) is not None]
    likely = [c for c in numbers if not _OTHERS.search(c.heading.lower()) and is_acceleration(c)]
    directed = [c for c in likely if direction(c) is not None]
    found = directed or (numbers if len(numbers) == 1 else likely if len(likely) == 1 else [])
    counts = Counter(direction(c) for c in directed)
    listed = ", ".join(repr(c.heading) for c in (numbers or columns)[:12])
    if not found:
        what = f"{len(numbers)} columns of numbers, {listed}" if numbers else "no column of numbers"
        faults.add(
            "columns",
            f"{what}{', none of which tells a direction' if numbers else ''}",
            "accelerations headed x, y, z, ax, acc_z, Vertical, …",
            _NAME_THEM,
        )
    elif any(count > 1 for count in counts.values()):
        several = [c.heading for c in directed if counts[direction(c)] > 1]
        faults.add(
            "columns",
            f"several columns for one direction: {', '.join(map(repr, several))}",
            "one for each",
            _NAME_THEM,
        )
    faults.raise_if_any()
    if empty:
        remarks.append(f"{', '.join(map(repr, empty))}: no number in the column, it was not used")
    others = [c.heading for c in numbers if c not in found and not _is_called_time(c)]
    if others:
        listed = ", ".join(map(repr, others[:5])) + (", …" if len(others) > 5 else "")
        remarks.append(f"columns of numbers that were not used: {listed}")
    return found


def _is_called_time(column: Column) -> bool:
    return " ".join(re.findall(r"[^\W_]+", column.end.lower())) in _TIMES


def direction(column: Column) -> AxisName | None:
    """Direction that a column's heading tells: x forward, y to the side, z up.

    column: its name is split into words; one of them must be x, az, accy, vertical or the like.
    """
    spaced = re.sub(r"(?<=[a-z]{2})(?=[A-Z])", " ", column.name)  # accelZ → accel Z
    found: set[AxisName] = set()
    for word in re.findall(r"[^\W_]+", spaced.lower()):
        match = _DIRECTION.fullmatch(word)
        if match:
            found.add(match["axis"])  # type: ignore[arg-type]
        elif word in _WORDS:
            found.add(_WORDS[word])
    return found.pop() if len(found) == 1 else None


def _directions(chosen: Sequence[Column], remarks: list[str]) -> list[AxisName | None]:
    """Directions by heading; a single column that tells none is taken as z, three as x, y, z."""
    found = [direction(column) for column in chosen]
    headings = ", ".join(repr(column.heading) for column in chosen)
    if found == [None]:
        remarks.append(f"{headings} tells no direction and is taken as z, vertical")
        return ["z"]
    if found == [None, None, None]:
        remarks.append(f"{headings} tell no directions and are taken as x, y and z in this order")
        return ["x", "y", "z"]
    return found
