"""A table of numbers: columns with their headings, units, numbers and texts; places by row."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railride.errors import Fault, InputError, shortened

Numbers = NDArray[np.float64] | NDArray[np.int64]

# What a cell must match as a whole to be a number; Python's own 1_000 is none.
DECIMAL_POINT = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
DECIMAL_COMMA = re.compile(r"[+-]?(?:\d+(?:,\d*)?|,\d+)(?:[eE][+-]?\d+)?", re.ASCII)

# Texts by which programs say that there is no number; compared in lower case. "inv" (invalid) is
# that of track geometry cars.
_MISSING = frozenset(
    "nan -nan nat na n/a #n/a #na <na> null none nil inv invalid missing - -- --- ? . *".split()
)

# Units that a heading may end in without brackets, and how the units library reads them.
_BARE_UNITS = {
    **{unit: unit for unit in "km m cm mm µm um s ms us µs ns min h g mg Hz kHz".split()},
    **dict.fromkeys("m/s2 m/s^2 m/s² m/s**2 m_s2 ms2 mps2 ms-2 m_per_s2".split(), "m/s^2"),
}
_BRACKETS = re.compile(r"(?P<name>.*?)[\s_,]*(?:\[(?P<square>[^\[\]]*)\]|\((?P<round>[^()]*)\))")
_ALTERNATIVES = "|".join(sorted(map(re.escape, _BARE_UNITS), key=len, reverse=True))
_BARE = re.compile(rf"(?P<name>.*?\w)(?:_|,\s*|\s+in\s+|\s*/\s*|\s+)(?P<unit>{_ALTERNATIVES})")


def split_heading(heading: str) -> tuple[str, str]:
    """Name and unit (empty where there is none) of a column's heading.

    heading: as it stands in the file; the unit in brackets at its end, or a common one after an
        underscore, a blank, a comma, a stroke or "in".

    >>> split_heading("level_mm"), split_heading("acc_z (g)"), split_heading("z [m/s²]")
    (('level', 'mm'), ('acc_z', 'g'), ('z', 'm/s²'))
    >>> split_heading("Zeit in s"), split_heading("seconds_elapsed"), split_heading("az_ms2")
    (('Zeit', 's'), ('seconds_elapsed', ''), ('az', 'm/s^2'))
    """
    text = heading.strip()
    match = _BRACKETS.fullmatch(text)
    if match and match["name"]:
        return match["name"].strip(), (match["square"] or match["round"] or "").strip()
    match = _BARE.fullmatch(text)
    return (match["name"].strip(), _BARE_UNITS[match["unit"]]) if match else (text, "")


def is_missing(cell: str) -> bool:
    """Whether a cell says that there is no number: blank, NaN, NA, null, inv, a dash and the like.

    cell: its text as in the file.

    >>> [is_missing(cell) for cell in ("", " NaN", "inv", "abc", "inf")]
    [True, True, True, False, False]
    """
    text = cell.strip().lower()
    return not text or text in _MISSING


def numbers_of(values: NDArray[Any], number: re.Pattern[str] = DECIMAL_POINT) -> Numbers:
    """Numbers of cells of any kind (n,): int64 where all are whole, or float64 with NaN for others.

    values: numbers, times, times of day (as int64 ns, since 1970), texts, or a mixture; truth
        values are no numbers.
    number: what a text must match to be one.

    >>> numbers_of(np.array(["1.5", "inf", "1_0", ""], dtype=object))
    array([1.5, nan, nan, nan])
    """
    kind = values.dtype.kind
    if kind == "i":
        return values.astype(np.int64)
    if kind in "mM":
        whole = values.astype(f"{kind}8[ns]").view(np.int64)
        missing = np.isnat(values)
        return np.where(missing, np.nan, whole) if missing.any() else whole
    if kind in "fu":
        numbers = values.astype(np.float64)
    else:
        texts = ("" if isinstance(v, bool) else str(v).strip() for v in values.tolist())
        found = (float(t.replace(",", ".")) if number.fullmatch(t) else np.nan for t in texts)
        numbers = np.fromiter(found, np.float64, values.size)
    return np.where(np.isfinite(numbers), numbers, np.nan)


@dataclass(frozen=True, eq=False)
class Column:
    """A column: numbers (n,), NaN where a cell is no finite number, and the texts it was read from.

    heading: its text in the file, or its number from "1" where the file has no header.
    name, unit: the heading's two parts (:func:`split_heading`); unit is empty where there is none.
    numbers: int64 where all cells are whole numbers (time stamps in ns keep every digit), float64
        otherwise.
    read_cells: gives the texts of all cells when they are asked for.
    """

    heading: str
    name: str
    unit: str
    numbers: Numbers
    read_cells: Callable[[], Sequence[str]]

    @classmethod
    def of(cls, heading: str, values: NDArray[Any], unit: str = "") -> Column:
        """Column of a binary file; times of day and spans of time are in ns.

        heading: its name in the file, which may have the unit with it.
        values: its cells (n,).
        unit: where the file states it apart from the name.
        """
        name, own = split_heading(heading)
        unit = "ns" if values.dtype.kind in "mM" else own or unit

        def read_cells() -> list[str]:
            texts = values.astype(str) if values.dtype.kind in "mM" else values
            return ["" if v is None else str(v).strip() for v in texts.tolist()]

        return cls(heading, name, unit, numbers_of(values), read_cells)

    @property
    def end(self) -> str:
        """The name's last part, where it is a path of structs or groups: ``run/time`` is a time."""
        return self.name.rpartition("/")[2]

    @cached_property
    def cells(self) -> Sequence[str]:
        """The texts of all cells (n,), without quotes and outer blanks; read when first used."""
        return self.read_cells()

    @cached_property
    def bad(self) -> NDArray[np.int64]:
        """Places (0 first) of the cells that are no finite numbers, as their ``cells`` show."""
        if self.numbers.dtype.kind == "i":
            return np.zeros(0, dtype=np.int64)
        return np.flatnonzero(np.isnan(self.numbers))

    def shown(self, i: int) -> str:
        """Cell ``i`` as a message shows it: in quotes, cut where it is long."""
        cell = self.cells[i]
        return repr(shortened(cell, 40)) if cell else "a blank cell"


@dataclass(frozen=True, eq=False)
class NumberTable:
    """Columns of equal length n from one file.

    source: the file, as messages name it.
    rate: samples per second (Hz), where the file itself states it.
    remarks: what the user must know about how the file was read.
    rows: line of each row in a text file as an editor counts (n,); None where the rows are records
        of their own, counted from 1.
    header_row: line of the header in a text file; 0 where there is none.
    """

    source: str
    columns: tuple[Column, ...]
    rate: float | None = None
    remarks: tuple[str, ...] = ()
    rows: NDArray[np.int64] | None = None
    header_row: int = 0

    @property
    def n(self) -> int:
        """Number of rows."""
        return int(self.columns[0].numbers.size) if self.columns else 0

    def row(self, i: int) -> int:
        """Row ``i`` (0 first) as the user counts it."""
        return i + 1 if self.rows is None else int(self.rows[i])

    def where(self, i: int, column: Column) -> str:
        """Place of a cell for a message: ``row 17, column 'z'``."""
        return f"row {self.row(i)}, column {column.heading!r}"

    def find(self, *names: str) -> tuple[Column, ...]:
        """Columns whose heading or name is one of ``names``, case, ``_`` and ``.`` aside, in order.

        names: such as ``"time"``, ``"acc z"``; matched as a whole. Where there is none, the end of
            a path (of a struct or a group) will do, if no other path ends so.
        """
        wanted = {_plain(name) for name in names}
        found = tuple(c for c in self.columns if {_plain(c.heading), _plain(c.name)} & wanted)
        ends = [found[0] for end, found in self._ends.items() if end in wanted and len(found) == 1]
        return found or tuple(c for c in self.columns if c in ends)

    @cached_property
    def _ends(self) -> dict[str, list[Column]]:
        """Last part of a path → the columns that have it; none in texts, which have no paths."""
        ends: dict[str, list[Column]] = {}
        for column in self.columns if self.rows is None else ():
            if "/" in column.heading:
                ends.setdefault(_plain(column.end), []).append(column)
        return ends

    def column(self, name: str) -> Column:
        """The one column with that heading, or else with that name (see :meth:`find`).

        name: as the user gave it.

        Raises InputError where there is none, with the nearest headings, or more than one.
        """
        found = [c for c in self.columns if c.heading == name] or list(self.find(name))
        found = found or self._ends.get(_plain(name), [])
        if len(found) == 1:
            return found[0]
        where, headings = f"column {name!r}", [c.heading for c in self.columns]
        if found:
            twice = f"{len(found)} columns of that name"
            shown = " or ".join(repr(c.heading) for c in found[:4])
            paths = len({c.heading for c in found}) > 1
            mend = f"give it in full: {shown}" if paths else "give the others another heading"
            fault = Fault(where, twice, "one", mend)
        else:
            listed = ", ".join(map(repr, headings[:12]))
            listed += f" and {len(headings) - 12} more" if len(headings) > 12 else ""
            near = nearest(name, headings)
            mend = f"is it {' or '.join(map(repr, near))}?" if near else ""
            fault = Fault(where, "no such column", f"one of {listed}", mend)
        raise InputError(f"{self.source}: {fault}")


def nearest(name: str, headings: Sequence[str]) -> list[str]:
    """The two headings most like ``name``, if any is: for messages.

    name: what was looked for.
    headings: of the file.
    """
    plain = {_plain(h): h for h in reversed(headings)}
    plain |= {_plain(split_heading(h)[0]): h for h in reversed(headings)}
    near = difflib.get_close_matches(_plain(name), plain, n=3, cutoff=0.6)
    return list(dict.fromkeys(plain[key] for key in near))[:2]


def _plain(name: str) -> str:
    """In lower case, letters and digits only, single blanks between."""
    return " ".join(re.findall(r"\w+", name.lower().replace("_", " ")))
