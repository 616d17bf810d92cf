"""Which character parts the cells of a text file, and its lines into cells."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence

from railride.tables.table import DECIMAL_COMMA, DECIMAL_POINT, is_missing

_SEPARATORS = ("\t", ";", ",", " ")
_DATE = r"\d{1,4}[./-]\d{1,2}[./-]\d{1,4}"
_CLOCK = r"\d{1,2}(?::\d{2}){1,2}(?:[.,]\d*)?(?:Z|[+-]\d{2}:?\d{2}| ?[AP]M)?"
_PLACE_OR_TIME = re.compile(rf"\d+\+\d+(?:[.,]\d*)?|{_DATE}|(?:{_DATE}[ T]+)?{_CLOCK}", re.ASCII)


def split_cells(line: str, separator: str) -> list[str]:
    """Cells of one line, without quotes and outer blanks.

    line: without its end.
    separator: of :class:`Dialect`.

    Raises csv.Error for quotes that are not closed on the line, or closed before the cell ends.

    >>> split_cells('1.5, "Oxford, W" ,2', ",")
    ['1.5', 'Oxford, W', '2']
    """
    if '"' not in line:  # far quicker, and most files have no quotes
        return [c.strip() for c in line.split(separator)] if separator != " " else line.split()
    if separator == " ":
        line = line.strip().replace("\t", " ")
    line = re.sub(rf'" +(?={re.escape(separator)}|$)', '"', line) if separator != " " else line
    cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True))
    return [cell.strip() for cell in cells]


def cells_or_none(line: str, separator: str) -> list[str] | None:
    """Cells of one line, or None where its quotes are not closed; see :func:`split_cells`.

    line, separator: as there.
    """
    try:
        return split_cells(line, separator)
    except csv.Error:
        return None


def find_separator(lines: Sequence[str]) -> str:
    """The separator that makes most numbers; where tabs do, a blank is one within a cell.

    lines: header, metadata and rows.
    """
    scores = {separator: _score(lines, separator) for separator in _SEPARATORS}
    found, even = scores["\t"]
    if even and found > 0:
        del scores[" "]
    return max(scores, key=lambda separator: scores[separator])


def _score(lines: Sequence[str], separator: str) -> tuple[int, bool]:
    """How well a separator makes numbers: cells that are some, less those that are text.

    Times and locations count as numbers, and texts of their own (a date, a name of a line) cost
    nothing where most lines have as many cells; texts with numbers in them were split wrongly.
    Second, to decide between equals, whether most lines do.
    """
    split = [cells_or_none(line, separator) or [line] for line in lines]
    width, count = Counter(len(cells) for cells in split).most_common(1)[0]
    even = width > 1 and 2 * count > len(split)
    score = 0
    for cells in split:
        spared = even and len(cells) == width
        for cell in cells:
            if _counts(cell):
                score += 1
            elif not is_missing(cell):
                score -= not spared or any(map(_counts, re.split(r"[\t;, ]+", cell)))
    return score, even


def _counts(cell: str) -> bool:
    """Whether a cell is a number, a date, a time of day, or a kilometre and a metre."""
    return any(kind.fullmatch(cell) for kind in (DECIMAL_POINT, DECIMAL_COMMA, _PLACE_OR_TIME))
