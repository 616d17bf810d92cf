"""How a text file is laid out: separator, decimal mark, header, units line, first row of numbers.

All is judged from a sample of lines, blank and comment lines left out: the first ones, where header
and metadata are, and others spread over the whole file.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from railride.errors import Faults, shortened
from railride.tables.separators import cells_or_none, find_separator
from railride.tables.table import DECIMAL_COMMA, DECIMAL_POINT, is_missing

_LONGEST_HEADING = 200  # that is looked into and told in messages
_COMMENT = re.compile(r"\s*(?:#|%|//)+\s*")
# Units of a line of its own that data/units.txt does not hold.
_OTHER_UNITS = frozenset("g V mV A mA °C bar ‰ - – # counts".split())
DECIMAL_COMMAS = "decimal commas need ; between the cells"
UNCLOSED = "a quote that is not closed, or not at the cell's end"

Line = tuple[int, str]  # its number, 1 first, and its text


@dataclass(frozen=True)
class Dialect:
    """Layout of a text file.

    separator: tab, semicolon, comma, or a blank for runs of blanks and tabs.
    comma: whether the decimal mark is a comma.
    headings, units: of the columns, cut at 200 characters; ``units`` is empty where no line of
        units follows the header, and ``headings`` are the columns' numbers where there is none.
    header_row: line of the header; 0 where there is none.
    first_row: line from which on the rows are numbers.
    """

    separator: str
    comma: bool
    headings: tuple[str, ...]
    units: tuple[str, ...]
    header_row: int
    first_row: int

    @property
    def number(self) -> re.Pattern[str]:
        """What a cell must match as a whole to be a number."""
        return DECIMAL_COMMA if self.comma else DECIMAL_POINT


def find_dialect(head: Sequence[Line], spread: Sequence[Line], comments: Sequence[Line],
                 faults: Faults) -> Dialect:  # fmt: skip
    """Work out the layout.

    head: the first lines that are neither blank nor comments; at least one.
    spread: others, from all over the file.
    comments: the comment lines before and among ``head``; the last before the numbers is the header
        where no other line is and it has as many cells as the rows.
    faults: of the file; raised where there are no numbers, or the header does not fit the rows.
    """
    texts = [text for _, text in (*head, *spread)]
    separator = find_separator(texts)
    rows = [cells_or_none(text, separator) for text in texts]
    if not any(rows):
        faults.add(f"row {head[0][0]}", UNCLOSED, "pairs of quotes", "mend that row")
        faults.raise_if_any()
    comma = _decimal_comma([cells for cells in rows if cells])
    width = Counter(len(cells) for cells in rows if cells).most_common(1)[0][0]
    whole = [cells for cells in rows if cells and len(cells) == width]
    number = DECIMAL_COMMA if comma else DECIMAL_POINT
    numeric = [j for j in range(width) if 2 * sum(_is(number, r[j]) for r in whole) >= len(whole)]
    numeric = numeric or [j for j in range(width) if any(_is(number, r[j]) for r in whole[-1:])]
    filled = max(
        (j + 1 for j in range(width) if 2 * sum(bool(r[j]) for r in whole) > len(whole)), default=1
    )
    layout = _Layout(separator, comma, width, tuple(numeric), filled)
    return layout.dialect([(row, text) for row, text in head], comments, faults)


@dataclass(frozen=True)
class _Layout:
    """What the rows look like, before the header is known.

    width: cells of most rows.
    numeric: the columns of numbers.
    filled: columns up to the last that is not blank in most rows; the others may go unnamed.
    """

    separator: str
    comma: bool
    width: int
    numeric: tuple[int, ...]
    filled: int

    @property
    def number(self) -> re.Pattern[str]:
        return DECIMAL_COMMA if self.comma else DECIMAL_POINT

    def dialect(self, head: list[Line], comments: Sequence[Line], faults: Faults) -> Dialect:
        """Find the header among the lines before the first row of numbers."""
        split = [(row, cells_or_none(text, self.separator) or [text]) for row, text in head]
        first = self._first_data([cells for _, cells in split])
        if first == len(split):
            faults.add(f"row {head[0][0]} and below", "no row of numbers", "a table of numbers")
            faults.raise_if_any()
        names = [k for k in range(first) if self._fits(split[k][1])]
        while (
            len(names) > 1 and names[-2] == names[-1] - 1 and self._has_number(split[names[-1]][1])
        ):
            names.pop()  # a damaged first row
        if not names:
            return self._without_header(split, first, comments, faults)
        last = names[-1]
        units: tuple[str, ...] = ()
        if len(names) > 1 and names[-2] == last - 1 and _are_units(split[last][1]):
            last, units = last - 1, tuple(cell.strip("[]()") for cell in split[last][1])
        start = last + 1 + bool(units)
        headings = self._headings(split[last][1])
        return self._made(headings, units, split[last][0], split[start][0])

    def _first_data(self, lines: Sequence[list[str]]) -> int:
        """Place of the first row; one beyond the last line where there is none.

        Half a row, such as "Line; 4", is metadata where a header comes before the first whole row.
        """
        data = [k for k, cells in enumerate(lines) if self._is_data(cells)]
        whole = next((k for k in data if self._is_whole(lines[k])), 0)
        heads = [k for k in range(whole) if k not in data and self._is_header(lines[k])]
        return next((k for k in data if not heads or k > heads[-1]), len(lines))

    def _is_whole(self, cells: list[str]) -> bool:
        """Whether a row has a number, or says that there is none, in every column of numbers."""
        return len(cells) >= self.width and all(
            _is(self.number, cells[j]) or is_missing(cells[j]) for j in self.numeric
        )

    def _is_header(self, cells: list[str]) -> bool:
        """Whether a line has a text in every column of numbers."""
        return self._fits(cells) and not any(
            _is(self.number, cells[j]) or is_missing(cells[j])
            for j in self.numeric
            if j < len(cells)
        )

    def _made(
        self, headings: Sequence[str], units: tuple[str, ...], header_row: int, first_row: int
    ) -> Dialect:
        units = (*units, *[""] * len(headings))[: len(headings)] if units else ()
        cut = partial(shortened, longest=_LONGEST_HEADING)
        return Dialect(self.separator, self.comma, tuple(map(cut, headings)),
                       tuple(map(cut, units)), header_row, first_row)  # fmt: skip

    def _is_data(self, cells: list[str]) -> bool:
        """Whether a line is a row: half of the columns of numbers have one, or all cells are."""
        if len(cells) != self.width:
            return len(cells) > 1 and all(_is(self.number, cell) for cell in cells)
        found = sum(_is(self.number, cells[j]) for j in self.numeric)
        return found > 0 and 2 * found >= len(self.numeric)

    def _has_number(self, cells: list[str]) -> bool:
        return any(_is(self.number, cells[j]) for j in self.numeric if j < len(cells))

    def _fits(self, cells: list[str]) -> bool:
        """Whether a line may be the header: as many cells as the rows, a blank end aside.

        LabVIEW heads a column "Comment" that has no cells.
        """
        if len(cells) == self.width + 1 and cells[-1].lower() in ("", "comment"):
            return True
        return self.filled <= len(cells) <= self.width

    def _headings(self, cells: list[str]) -> list[str]:
        """Headings of the header line: numbers for those left blank, none for those at its end."""
        named = max((j for j, cell in enumerate(cells, start=1) if cell), default=1)
        cells = cells[: min(max(named, self.filled), self.width)]
        return [cell or str(j) for j, cell in enumerate(cells, start=1)]

    def _without_header(
        self, split: list[tuple[int, list[str]]], first: int, comments: Sequence[Line],
        faults: Faults,
    ) -> Dialect:  # fmt: skip
        """No line before the numbers has as many cells: a commented header, or none."""
        row = split[first][0]
        for at, text in reversed([c for c in comments if c[0] < row]):
            bare = _COMMENT.sub("", text, count=1)
            cells = cells_or_none(bare, self.separator) or []
            if self._fits(cells) and not self._is_data(cells):
                return self._made(self._headings(cells), (), at, row)
        before = split[first - 1] if first else (0, [""])
        width = self.filled
        if first and len(before[1]) == 1 and width == 2 and self._one_column(split[first:]):
            layout = _Layout(";", True, 1, (0,), 1)
            return layout._made(before[1], (), before[0], row)
        if cells_or_none(before[1][0], self.separator) is None:
            faults.add(f"row {before[0]}", UNCLOSED, "pairs of quotes", "mend the header")
        elif len(before[1]) > 1:
            faults.add(
                f"row {before[0]}",
                f"{len(before[1])} cells in the header",
                f"{width}, as many as in row {row}",
                DECIMAL_COMMAS if self.separator == "," else "head every column",
            )
        elif self.separator == "," and self._looks_like_commas(split[first:]):
            faults.add(
                f"row {row}",
                "whole numbers that look like the two halves of decimal commas, and no header",
                "cells that can be told apart",
                DECIMAL_COMMAS,
            )
        faults.raise_if_any()
        return self._made([str(j) for j in range(1, width + 1)], (), 0, row)

    def _one_column(self, rows: list[tuple[int, list[str]]]) -> bool:
        """Whether comma-separated rows are one column with decimal commas under one heading."""
        return self.separator == "," and all(
            len(cells) == 2 and re.fullmatch(r"[+-]?\d+", cells[0]) and cells[1].isdecimal()
            for _, cells in rows
        )

    def _looks_like_commas(self, rows: list[tuple[int, list[str]]]) -> bool:
        """Whether each second cell is digits only, some beginning with a nought: 0,05 not 0.05."""
        seconds = [cell for _, cells in rows for cell in cells[1::2]]
        return (
            self.width % 2 == 0
            and not any("." in cell for _, cells in rows for cell in cells)
            and all(cell.isdecimal() for cell in seconds)
            and any(len(cell) > 1 and cell[0] == "0" for cell in seconds)
        )


def _is(number: re.Pattern[str], cell: str) -> bool:
    return number.fullmatch(cell) is not None


def _decimal_comma(rows: Sequence[list[str]]) -> bool:
    """Whether most numbers with a mark have a comma; in quotes, where commas separate."""
    numbers = [
        cell
        for cells in rows
        for cell in cells
        if _is(DECIMAL_COMMA, cell) or _is(DECIMAL_POINT, cell)
    ]
    return sum("," in cell for cell in numbers) > sum("." in cell for cell in numbers)


def _are_units(cells: list[str]) -> bool:
    """Whether a line below the header holds units only."""
    from railride.units import QuantityError, same_dimension

    def known(text: str) -> bool:
        try:
            return text in _OTHER_UNITS or same_dimension(text, text)
        except QuantityError:
            return False

    texts = [cell.strip("[]() ") for cell in cells if cell]
    return (
        bool(texts)
        and 2 * sum(known(text) for text in texts) >= len(texts)
        and all(len(text) <= 10 and not _is(DECIMAL_POINT, text) for text in texts)
    )
