"""Text files of numbers: in bulk by pandas' C reader, row by row only where something is wrong.

The stages: bytes → lines (blank and comment lines aside) → dialect → rows of the right width →
numbers, in blocks of rows so that an hour at 1 kHz takes little more memory than its file. A row
number is the line in the file, as an editor shows it; a cell's quotes close on its own line.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from railride.errors import Faults, RowFaults
from railride.tables.dialect import DECIMAL_COMMAS, UNCLOSED, Dialect, find_dialect
from railride.tables.encoding import read_utf8
from railride.tables.separators import split_cells
from railride.tables.table import Column, Numbers, NumberTable, numbers_of, split_heading

if TYPE_CHECKING:
    import pandas as pd

_HEAD = 400  # lines in which header and first numbers are looked for
_SPREAD = 400  # further lines by which the layout is judged
_BLOCK = 200_000  # rows read at a time
_EXTRA = 4  # blank cells that may follow the last column
_NEWLINE, _QUOTE = ord("\n"), ord('"')


def read_text(path: Path) -> NumberTable:
    """Read a text file into columns (see the package).

    path: an existing file. Separator (tab, semicolon, comma, blanks), decimal mark, header, comment
        lines (``#``, ``%``, ``//``), metadata before and units below the header are recognised.

    Rows of blank cells at the end are passed over, elsewhere they are rows without numbers; so is a
    blank line among the numbers of a single column.

    Raises InputError naming row and byte: not text, no rows of numbers, a header that does not fit,
    rows too short or too long, quotes that are not closed.
    """
    faults = Faults(str(path))
    data, remarks = read_utf8(path)
    ended = data.endswith(b"\n")
    lines = _Lines.of(data if ended else data + b"\n")
    dialect = _dialect(lines, faults)
    body = _body(lines, dialect)
    bad = RowFaults(faults)
    body = _whole_rows(body, bad)
    width = len(dialect.headings)
    columns = _read_numbers(body, bad)
    bad.close()
    faults.raise_if_any()
    if not ended and _looks_cut(body):
        row = int(body.lines.row[-1])
        remarks.append(f"the file ends within row {row}, whose last number seems to be cut off")
    if dialect.header_row == 0:
        remarks.append(f"there is no header: the columns are named 1 to {width}")
    return NumberTable(
        str(path),
        tuple(_column(body, j, columns[j]) for j in range(width)),
        remarks=tuple(remarks),
        rows=body.lines.row,
        header_row=dialect.header_row,
    )


@dataclass(frozen=True)
class _Lines:
    """Some lines of the text: first byte, end (its line feed), and number, 1 first."""

    data: bytes
    start: NDArray[np.int64]
    end: NDArray[np.int64]
    row: NDArray[np.int64]

    @classmethod
    def of(cls, data: bytes) -> _Lines:
        end = np.flatnonzero(np.frombuffer(data, np.uint8) == _NEWLINE)
        start = np.concatenate([[0], end[:-1] + 1])
        return cls(data, start, end, np.arange(1, end.size + 1))

    def __getitem__(self, which: Any) -> _Lines:
        return _Lines(self.data, self.start[which], self.end[which], self.row[which])

    def text(self, i: int) -> str:
        return self.data[self.start[i] : self.end[i]].decode("utf-8")

    def numbered(self, places: Any) -> list[tuple[int, str]]:
        return [(int(self.row[i]), self.text(i)) for i in places]

    def joined(self) -> bytes:
        """The lines' bytes, one after the other."""
        breaks = np.flatnonzero(np.diff(self.row) > 1) + 1
        edges = [0, *breaks.tolist(), self.row.size]
        runs = ((self.start[a], self.end[b - 1] + 1) for a, b in pairwise(edges) if b > a)
        return b"".join(self.data[a:b] for a, b in runs)

    def kinds(self) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """Which lines are blank and which are comments, by their first character."""
        bytes_ = np.frombuffer(self.data, np.uint8)
        first = self.start.copy()
        while np.any(outer := np.isin(bytes_[first], (ord(" "), ord("\t")))):
            first[outer] += 1
        character = bytes_[first]
        strokes = character == ord("/")
        strokes[strokes] = bytes_[first[strokes] + 1] == ord("/")
        return character == _NEWLINE, strokes | np.isin(character, (ord("#"), ord("%")))


@dataclass(frozen=True)
class _Body:
    """The rows of numbers: their lines and the file's layout."""

    lines: _Lines
    dialect: Dialect

    def blocks(self) -> Iterator[_Lines]:
        for a in range(0, self.lines.row.size, _BLOCK):
            yield self.lines[a : a + _BLOCK]

    def frame(self, lines: _Lines, **options: Any) -> pd.DataFrame:
        """Cells of some rows as a table, as wide as the widest of them."""
        import pandas as pd

        separator = self.dialect.separator
        width = int(_count_cells(lines, separator).max(initial=1))
        return pd.read_csv(
            BytesIO(lines.joined()),
            sep=r"\s+" if separator == " " else separator,
            decimal="," if self.dialect.comma else ".",
            header=None,
            names=range(width),
            index_col=False,
            skipinitialspace=True,
            skip_blank_lines=False,
            low_memory=False,
            **exactly(pd.__version__),
            **options,
        )


def exactly(version: str) -> dict[str, Any]:
    """Option by which pandas reads a number to its last bit; from 3.1 on it does so unasked."""
    older = tuple(int(part) for part in version.split(".")[:2]) < (3, 1)
    return {"float_precision": "round_trip"} if older else {}


def _dialect(lines: _Lines, faults: Faults) -> Dialect:
    """Find the layout from the first lines and others spread over the file."""
    blank, comment = lines[: 4 * _HEAD].kinds()
    head = np.flatnonzero(~blank & ~comment)[:_HEAD]
    if head.size == 0:
        head = np.flatnonzero(~np.logical_or(*lines.kinds()))[:_HEAD]
    if head.size == 0:
        faults.add("file", "comments and blank lines only", "a table of numbers")
        faults.raise_if_any()
    rest = np.unique(np.linspace(head[-1] + 1, lines.row.size - 1, _SPREAD).astype(int))
    rest = rest[(rest > head[-1]) & (rest < lines.row.size)]
    spread = rest[~np.logical_or(*lines[rest].kinds())]
    remarks = np.flatnonzero(comment)
    return find_dialect(
        lines.numbered(head), lines.numbered(spread), lines.numbered(remarks), faults
    )


def _body(lines: _Lines, dialect: Dialect) -> _Body:
    """Lines from the first row of numbers to the last row that has anything in it."""
    lines = lines[dialect.first_row - 1 :]
    blank, comment = lines.kinds()
    single = len(dialect.headings) == 1  # where a blank line is a blank cell
    lines = lines[~comment] if single else lines[~(blank | comment)]
    size = lines.row.size
    nothing = dialect.separator + ' "\t'
    while size > 1 and not lines.text(size - 1).strip(nothing):
        size -= 1
    return _Body(lines[:size], dialect)


def _whole_rows(body: _Body, bad: RowFaults) -> _Body:
    """Keep the rows that have as many cells as the header; note the others."""
    width = len(body.dialect.headings)
    kept = []
    for lines in body.blocks():
        counts = _count_cells(lines, body.dialect.separator)
        right = (counts >= width) & (counts <= width + _EXTRA)
        if width == 1:
            right |= counts == 0
        wrong = np.flatnonzero(~right)
        for i in wrong[: bad.shown].tolist():
            _report_width(lines, i, int(counts[i]), body.dialect, bad)
        bad.leave_out(wrong.size - bad.shown)
        kept.append(right)
    return _Body(body.lines[np.concatenate(kept)], body.dialect)


def _report_width(lines: _Lines, i: int, count: int, dialect: Dialect, bad: RowFaults) -> None:
    """Note a row of the wrong number of cells, or with a quote that is not closed."""
    row, width = int(lines.row[i]), len(dialect.headings)
    if count < 0:
        bad.add(row, "", UNCLOSED, "pairs of quotes")
        return
    as_in = "as in the header" if dialect.header_row else "as elsewhere"
    mend = DECIMAL_COMMAS if dialect.separator == "," and count > width else "mend that row"
    bad.add(row, "", f"{count} cells", f"{width} {as_in}", mend)


def _count_cells(lines: _Lines, separator: str) -> NDArray[np.int64]:
    """Cells of each line, −1 where its quotes are not closed."""
    a, b = int(lines.start[0]), int(lines.end[-1]) + 1
    text = np.frombuffer(lines.data, np.uint8, b - a, a)
    if separator == " ":
        gap = (text == ord(" ")) | (text == ord("\t")) | (text == _NEWLINE)
        marks = np.flatnonzero(~gap & np.concatenate([[True], gap[:-1]]))
    else:
        marks = np.flatnonzero(text == ord(separator))
    first, end = np.searchsorted(marks, lines.start - a), np.searchsorted(marks, lines.end - a)
    counts: NDArray[np.int64] = (end - first) + (separator != " ")
    quotes = np.flatnonzero(text == _QUOTE)
    quoted = np.searchsorted(quotes, lines.end - a) > np.searchsorted(quotes, lines.start - a)
    for i in np.flatnonzero(quoted).tolist():
        try:
            counts[i] = len(split_cells(lines.text(i), separator))
        except csv.Error:
            counts[i] = -1
    return counts


def _looks_cut(body: _Body) -> bool:
    """Whether the last cell is shorter, or has fewer decimals, than those above it."""
    mark = "," if body.dialect.comma else "."
    lines = body.lines[-1000:]
    texts = (lines.text(i) for i in range(lines.row.size))
    *above, last = [split_cells(text, body.dialect.separator)[-1:] or [""] for text in texts]
    least = min((len(cell) for [cell] in above), default=0)
    decimals = min((len(cell.partition(mark)[2]) for [cell] in above), default=0)
    return len(last[0]) < least or len(last[0].partition(mark)[2]) < decimals


def _read_numbers(body: _Body, bad: RowFaults) -> list[Numbers]:
    """Numbers of each column; rows with something beyond the last column are noted."""
    width = len(body.dialect.headings)
    parts: list[list[Numbers]] = [[] for _ in range(width)]
    for lines in body.blocks():
        frame = body.frame(lines)
        for i in np.flatnonzero(frame.iloc[:, width:].notna().any(axis=1)).tolist():
            cells = split_cells(lines.text(i), body.dialect.separator)
            _report_width(lines, i, len(cells), body.dialect, bad)
        for j in range(width):
            parts[j].append(_numbers(frame.iloc[:, j], body.dialect.number))
    return [_joined(part) for part in parts]


def _joined(parts: list[Numbers]) -> Numbers:
    """Blocks of a column; whole numbers remain so where all blocks have nothing else."""
    joined: Any = np.concatenate(parts) if parts else np.zeros(0)
    return cast("Numbers", joined)


def _numbers(cells: pd.Series[Any], number: re.Pattern[str]) -> Numbers:
    """One column's numbers as pandas read them, or cell by cell where some are none."""
    return numbers_of(cells.to_numpy(dtype=None if cells.dtype.kind in "iuf" else object), number)


def _column(body: _Body, j: int, numbers: Numbers) -> Column:
    dialect = body.dialect
    heading = dialect.headings[j]
    name, unit = split_heading(heading)
    below = dialect.units[j] if dialect.units else ""

    def read_cells() -> list[str]:
        options = {"usecols": [j], "dtype": object, "na_filter": False}
        frames = (body.frame(lines, **options) for lines in body.blocks())
        return [cell.strip() for frame in frames for cell in frame.iloc[:, 0]]

    return Column(heading, name, unit or below, numbers, read_cells)
