"""Which columns of a table are the track: by their headings, or as the user picks them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import isfinite

from railride.errors import Faults, InputError
from railride.tables import Column, NumberTable
from railride.trackfile.cells import is_km_and_m
from railride.trackfile.headings import meaning
from railride.trackfile.spacing import STEPS
from railride.units import QuantityError, same_dimension, to_si

EXPECTED_HEADER = "a header line with distance_m and level_m, or another unit, as in level [mm]"
UNITS = "m, km, cm, mm"
_DEFAULT_BAND = "D1"
_NOT_LEVELS = {
    "chord": "a chord offset (versine), which passes a wave by 0 to 2 times, depending on its "
    "length",
    "statistic": "a standard deviation over some length of track",
}


@dataclass(frozen=True)
class Asked:
    """What a user says of a file; see :func:`railride.trackfile.read_track`.

    Raises InputError for a step or filling that is none, and for more than two levels.
    """

    distance: str | None = None
    level: str | Sequence[str] = ()
    distance_unit: str | None = None
    level_unit: str | None = None
    step: float | None = None
    fill: float = 0.0
    reverse: bool = False

    @property
    def levels(self) -> tuple[str, ...]:
        """What was asked for as levels, none where they are to be found."""
        return (self.level,) if isinstance(self.level, str) else tuple(self.level)

    def __post_init__(self) -> None:
        """Check the values."""
        low, high = STEPS
        if self.step is not None and not low <= self.step <= high:
            raise InputError(f"track step: found {self.step} m; expected {low:g} to {high:g} m")
        if not (isfinite(self.fill) and self.fill >= 0.0):
            raise InputError(
                f"track fill: found {self.fill} m; expected the longest dropout to be bridged, 0 "
                "or more"
            )
        if len(self.levels) > 2:
            raise InputError(
                f"track level: found {len(self.levels)} columns; expected one, or those of the "
                "left and the right rail"
            )


@dataclass(frozen=True)
class Chosen:
    """The columns of a track: ``metres`` each is how many one of its units is; none for km+m.

    ``levels``: one, or those of the two rails. ``band``: "D1" and so on, or "".
    """

    distance: Column | None
    distance_metres: float
    levels: tuple[Column, ...]
    level_metres: tuple[float, ...]
    band: str = ""
    remarks: list[str] = field(default_factory=list)


def choose(table: NumberTable, asked: Asked, faults: Faults) -> Chosen:
    """Choose the columns of a track and their units; what is missing goes into ``faults``.

    Raises InputError where a column that is needed cannot be found.
    """
    distance = _distance(table, asked, faults)
    levels, band, remarks = _levels(table, asked, faults)
    faults.raise_if_any()
    scale = 1.0 if distance is None else _metres(
        table, distance, asked.distance_unit, "distance", faults
    )  # fmt: skip
    scales = tuple(_metres(table, c, asked.level_unit, "level", faults) for c in levels)
    return Chosen(distance, scale, levels, scales, band, remarks)


def _distance(table: NumberTable, asked: Asked, faults: Faults) -> Column | None:
    """The column of the distances; none where there is none and the step is given."""
    if asked.distance is not None:
        found = picked(table, asked.distance)
    else:
        found = [c for c in table.columns if meaning(c.name).kind == "distance"]
        if not found and asked.step is None:
            _report_missing(table, "distance", faults)
    if len(found) > 1:
        _report_several(table, found, "distance", faults)
    return found[0] if found else None


def _levels(
    table: NumberTable, asked: Asked, faults: Faults
) -> tuple[tuple[Column, ...], str, list[str]]:
    """The column or columns of the level, their band, and remarks on what was left out."""
    remarks: list[str] = []
    if asked.levels:
        found = _picked_levels(table, asked, faults)
        bands = list(dict.fromkeys(meaning(column.name).band for column in found))
        if len(bands) > 1:
            shown = " and ".join(band or "none" for band in bands)
            faults.add("the levels", f"the bands {shown}", "one band for both rails")
        return tuple(found), bands[0], remarks
    by_band: dict[str, list[Column]] = {}
    for column in table.columns:
        said = meaning(column.name)
        if said.kind == "level":
            by_band.setdefault(said.band, []).append(column)
    if not by_band:
        _report_missing(table, "level", faults)
        return (), "", remarks
    band = next((b for b in ("", _DEFAULT_BAND) if b in by_band), next(iter(by_band)))
    found = by_band[band]
    if len(found) > 1 and not _are_rails(found):
        _report_several(table, found, "level", faults)
    if len(by_band) > 1:
        named = {b: b or "that of all wavelengths" for b in by_band}
        others = ", ".join(named[b] for b in by_band if b != band)
        remarks.append(f"of the levels, {named[band]} was read; {others} are there too "
                       "(--level-column picks another)")  # fmt: skip
    if len(found) == 1 and meaning(found[0].name).rail:
        remarks.append(f"the level of one rail alone was found: {found[0].heading!r}")
    return tuple(found), band, remarks


def _picked_levels(table: NumberTable, asked: Asked, faults: Faults) -> list[Column]:
    """The columns that the user picked as levels; what is none of a level is a fault."""
    found = [column for text in asked.levels for column in picked(table, text)]
    for column in found:
        kind = meaning(column.name).kind
        if kind in _NOT_LEVELS:
            faults.add(place(table, column), _NOT_LEVELS[kind], "the longitudinal level",
                       "choose another column")  # fmt: skip
    if not faults.found and len(found) > len(asked.levels) and not _are_rails(found):
        _report_several(table, found, "level", faults)
    return found


def picked(table: NumberTable, text: str) -> list[Column]:
    """Columns that a user means by ``text``: of that heading or name, or with all its words.

    Raises InputError where there are none.
    """
    exact = [c for c in table.columns if c.heading == text] or list(table.find(text))
    if exact:
        return exact
    words, own = set(_words(text)), meaning(text).kind
    near = [c for c in table.columns if words and words <= set(_words(c.name))]
    near = [c for c in near if meaning(c.name).kind not in _NOT_LEVELS.keys() - {own}]
    return near or [table.column(text)]


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W_]+", text.lower())


def _are_rails(found: Sequence[Column]) -> bool:
    """Whether two columns are those of the left and the right rail."""
    return sorted(meaning(c.name).rail for c in found) == ["left", "right"]


def place(table: NumberTable, column: Column) -> str:
    """Where a heading stands."""
    return f"{head(table)}, column {column.heading!r}"


def head(table: NumberTable) -> str:
    """Where the headings stand."""
    return f"row {table.header_row}" if table.header_row else "columns"


def _report_several(table: NumberTable, found: Sequence[Column], role: str, faults: Faults) -> None:
    """Note columns of which only one, or a left and a right one, can be meant."""
    shown = " and ".join(repr(c.heading) for c in found[:4])
    more = f" and {len(found) - 4} more" if len(found) > 4 else ""
    expected = "one, or a left and a right one" if role == "level" else "one"
    faults.add(head(table), f"several {role} columns: {shown}{more}", expected,
               f"name it with --{role}-column, or rename the others")  # fmt: skip


def _report_missing(table: NumberTable, role: str, faults: Faults) -> None:
    """Note that a column is not there, and the headings nearest to it."""
    from railride.tables.table import nearest

    headings = [c.heading for c in table.columns]
    if headings == [str(j) for j in range(1, len(headings) + 1)]:
        if not any("header" in fault.found for fault in faults.found):
            faults.add(f"row {table.row(0)}", "no header, so that columns and units are not known",
                       EXPECTED_HEADER, "put that line before the numbers, or name columns and "
                       "units with --distance-column 1 and so on")  # fmt: skip
        return
    listed = ", ".join(map(repr, headings[:8]))
    listed += f" and {len(headings) - 8} more" if len(headings) > 8 else ""
    near, mend = nearest(role, headings), ""
    chord = next((c for c in table.columns if meaning(c.name).kind == "chord"), None)
    if chord is not None and role == "level":
        mend = f"{chord.heading!r} is {_NOT_LEVELS['chord']}; "
    elif near:
        mend = f"is it {' or '.join(map(repr, near))}? "
    example = "km" if role == "distance" else "mm"
    faults.add(head(table), f"no {role} column among {listed}",
               f"one headed {role}_m, or with another unit, as in {role} [{example}]",
               f"{mend}rename its heading, or name it with --{role}-column")  # fmt: skip


def _unit_alone(column: Column) -> str:
    """The unit that a heading is and nothing else, such as ``km`` for a distance."""
    return column.end if column.end in (*UNITS.split(", "), "kilometre", "kilometer") else ""


def _metres(
    table: NumberTable, column: Column, given: str | None, role: str, faults: Faults
) -> float:
    """How many metres a column's unit is; 1 for kilometres and metres, which are texts."""
    unit = given or column.unit or _unit_alone(column)
    if role == "distance" and is_km_and_m(column):
        return 1.0
    try:
        if unit and same_dimension(unit, "m"):
            return float(to_si(1.0, unit))
    except QuantityError:
        pass
    faults.add(
        place(table, column),
        f"the unit {unit!r}" if unit else "no unit",
        f"one of {UNITS}, as in {role}_m or {role} [mm]",
        f"or give it with --{role}-unit",
    )
    return 1.0
