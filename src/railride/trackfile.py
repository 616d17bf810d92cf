"""Track files: longitudinal level over distance as CSV, read with every fault named, and written.

A file has a header with a distance and a level column, the unit with each (``distance_m``,
``level [mm]``, ``level (mm)``); lines of its own before the header, lines that begin with ``#``,
blank lines and further columns are passed over. Comma, semicolon or tab separate; with the latter
two the decimal mark may be a comma. A row number is the line in the file, as an editor shows it.

The stages: bytes → text → header → numbers → a uniform grid → a :class:`~railride.track.Track`.
"""

from __future__ import annotations

import contextlib
import csv
import difflib
import io
import itertools
import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railride.errors import Faults
from railride.files import write_text
from railride.spectra import D1, D2, D3, FloatArray
from railride.track import Track

FEWEST_ROWS = 8
_SHOWN_FAULTS = 10
_HEADER_WITHIN = 200  # lines
_SEPARATORS = ("\t", ";", ",")
_METRES = {"m": 1.0, "km": 1000.0, "cm": 0.01, "mm": 0.001}
_NAMES = {
    "distance": ("distance", "chainage", "position"),
    "level": ("level", "longitudinal level"),
}
_BANDS = {"d1": D1, "d2": D2, "d3": D3}
_HEADING = re.compile(
    r"(?P<name>[a-z][a-z _]*?)(?:[ _](?P<band>d[123]))?"
    r"(?:\s*\[\s*(?P<square>[^\]]*?)\s*\]|\s*\(\s*(?P<round>[^)]*?)\s*\)|[ _](?P<bare>km|cm|mm|m))?"
)
_EXPECTED_HEADER = "a header line with distance_m and level_m, or another unit, as in level [mm]"
_CELLS = "decimal commas need ; between the cells"


@dataclass(frozen=True)
class _Column:
    """A column of the file: its place (0 first), heading, metres per unit, and wavelength band."""

    place: int
    heading: str
    metres: float
    band: tuple[float, float] | None


@dataclass(frozen=True)
class _Header:
    """The header line: its row, what separates its cells, how many there are, the two columns."""

    row: int
    separator: str
    width: int
    distance: _Column
    level: _Column


@dataclass(frozen=True)
class _Numbers:
    """Rows whose two numbers are good: line, count among all rows, distance and level (m)."""

    row: NDArray[np.int64]
    count: NDArray[np.int64]
    distance: FloatArray
    level: FloatArray


class _RowFaults:
    """Faults of single rows: the first ten in full and the number of the others."""

    def __init__(self, faults: Faults) -> None:
        self.faults = faults
        self.count = 0

    def add(self, row: int, column: str, found: str, expected: str, mend: str = "") -> None:
        """Note a fault of one cell, or of a row as a whole where ``column`` is empty."""
        self.count += 1
        if self.count <= _SHOWN_FAULTS:
            where = f"row {row}, column {column!r}" if column else f"row {row}"
            self.faults.add(where, found, expected, mend)

    def close(self) -> None:
        """Say how many were left out."""
        if self.count > _SHOWN_FAULTS:
            self.faults.add("other rows", f"{self.count - _SHOWN_FAULTS} more such faults", "none")


def read_track(path: str | Path) -> Track:
    """Read a measured track from a CSV file (see the module for its form).

    ``path``: the file. Distances rise evenly: what lies within 2 % of a step of an even grid, or
    within the last printed digit, counts as rounding; other unevenness, steps of half to one and a
    half times the median, is resampled by the spline through the samples, with a remark. A level
    headed D1, D2 or D3 (``level D1 [mm]``) gives the track that band. Further remarks: a level that
    looks a thousand times too large or too small, or lies far from zero.

    Raises InputError naming row and column: no such file, a folder, no text in UTF-8, empty; no
    header, columns missing, twice or without a unit; fewer than 8 rows; text, blank cells, NaN or
    infinity among the numbers; distances that fall, stand still or leave a gap; a level that
    departs by more than a metre from a straight line.
    """
    source = Path(path)
    faults = Faults(str(path))
    text = _read_text(source, faults)
    header = _find_header(text, faults)
    numbers = _read_numbers(text, header, faults)
    _check_level(numbers, header, faults)
    step, level, remarks = _on_even_grid(numbers.distance, numbers.level)
    remarks += _doubtful(step, level, header)
    return Track(
        distance0=float(numbers.distance[0]),
        step=step,
        level=level,
        name=source.name,
        source=str(path),
        band=header.level.band,
        remarks=tuple(f"{source.name}: {remark}" for remark in remarks),
    )


def track_text(track: Track) -> str:
    """``track`` as CSV with the columns ``distance_m,level_m``, one row per sample.

    Every number is written so that it reads back to the last bit.
    """
    pairs = zip(track.distance.tolist(), track.level.tolist(), strict=True)
    rows = "".join(f"{distance!r},{level!r}\n" for distance, level in pairs)
    return "distance_m,level_m\n" + rows


def write_track(track: Track, path: str | Path) -> None:
    """Write :func:`track_text` of ``track`` to ``path``. The file is whole or not there.

    Raises InputError where ``path`` cannot be written.
    """
    write_text(path, track_text(track))


def _read_text(path: Path, faults: Faults) -> str:
    """Read the whole file as UTF-8, with or without a byte order mark."""
    data, text = b"", ""
    try:
        data = path.read_bytes()
    except IsADirectoryError:
        faults.add("track file", "a folder", "a CSV file", "name the file in it")
    except FileNotFoundError:
        faults.add("track file", "no such file", "a CSV file", "check the path")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        faults.add("track file", f"it cannot be read: {reason}", "a readable CSV file")
    faults.raise_if_any()
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        faults.add("byte 0", "text in UTF-16", "text in UTF-8", "save it as CSV UTF-8")
    elif b"\0" in data:
        at = f"byte {data.index(0)}"
        faults.add(at, "a zero byte: this is not text", "a CSV file", "export it as CSV")
    faults.raise_if_any()
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        row = len(re.findall(rb"\r\n|\r|\n", data[: error.start])) + 1
        faults.add(
            f"row {row}, byte {error.start} of the file",
            f"0x{data[error.start]:02x}, which is not UTF-8",
            "text in UTF-8",
            "save it as CSV UTF-8; it may be Latin-1 or Windows-1252",
        )
    else:
        if not text.strip():
            faults.add("track file", "an empty file", _EXPECTED_HEADER)
    faults.raise_if_any()
    return text


def _lines(text: str) -> Iterator[tuple[int, str]]:
    """Line numbers (1 first) and lines that are neither blank nor comments."""
    for row, line in enumerate(io.StringIO(text, newline=None), start=1):
        if line.strip() and not line.lstrip().startswith("#"):
            yield row, line.rstrip("\n")


def _cells(line: str, separator: str) -> list[str]:
    """Cells of one line, without quotes and outer blanks."""
    cells = line.split(separator)
    if '"' in line:  # the plain split is far quicker and most files have no quotes
        with contextlib.suppress(csv.Error):  # a cell beyond csv's largest size
            cells = next(csv.reader([line], delimiter=separator, skipinitialspace=True))
    return [cell.strip() for cell in cells]


def _find_header(text: str, faults: Faults) -> _Header:
    """Find the line that names most of the two columns, and of those the one with most cells."""
    best, score = (1, ",", [""]), (-1, 0)
    for row, line in itertools.islice(_lines(text), _HEADER_WITHIN):
        if any(_all_numbers(_cells(line, separator)) for separator in _SEPARATORS):
            break
        for separator in _SEPARATORS:
            cells = _cells(line, separator)
            named = sum(bool(_matching(cells, role)) for role in _NAMES)
            if (named, len(cells)) > score:
                best, score = (row, separator, cells), (named, len(cells))
        if score[0] == len(_NAMES):
            break
    row, separator, cells = best
    if score[0] < 0:
        first = next(_lines(text), (1, ""))[0]
        faults.add(
            f"row {first}",
            "no header, so that columns and units are not known",
            _EXPECTED_HEADER,
            "put that line before the numbers",
        )
    elif score[0] < len(_NAMES):
        _report_missing(row, cells, faults)
    faults.raise_if_any()
    columns = {role: _column(row, cells, role, faults) for role in _NAMES}
    return _Header(row, separator, len(cells), columns["distance"], columns["level"])


def _report_missing(row: int, cells: list[str], faults: Faults) -> None:
    """Note which of the two columns a header lacks, and the headings nearest to it."""
    listed = ", ".join(repr(cell) for cell in cells[:8])
    if len(cells) > 8:
        listed += f" and {len(cells) - 8} more"
    bare = {re.split(r"\s*[\[(]|_(?:km|cm|mm|m)$", cell.lower())[0]: cell for cell in cells}
    for role, names in _NAMES.items():
        if _matching(cells, role):
            continue
        example = "km" if role == "distance" else "mm"
        near = dict.fromkeys(
            bare[key]
            for name in names
            for key in difflib.get_close_matches(name, bare, n=2, cutoff=0.7)
        )
        faults.add(
            f"row {row}",
            f"no {role} column among {listed}",
            f"one headed {role}_m, or with another unit, as in {role} [{example}]",
            (f"is it {' or '.join(map(repr, near))}? " if near else "")
            + f"rename the heading of the {role}",
        )


def _column(row: int, cells: list[str], role: str, faults: Faults) -> _Column:
    """Read a column's unit and band from its heading; note it if it is there twice."""
    places = _matching(cells, role)
    heading = cells[places[0]]
    if len(places) > 1:
        twice = " and ".join(repr(cells[place]) for place in places)
        faults.add(f"row {row}", f"several {role} columns: {twice}", "one", "rename the others")
    match = _HEADING.fullmatch(heading.lower())
    parts = match.groupdict() if match else {}
    unit = parts.get("square") or parts.get("round") or parts.get("bare") or ""
    if unit not in _METRES:
        faults.add(
            f"row {row}, column {heading!r}",
            f"the unit {unit!r}" if unit else "no unit",
            f"one of {', '.join(_METRES)}, as in {role}_m or {role} [mm]",
        )
    band = _BANDS.get(parts.get("band") or "")
    return _Column(places[0], heading, _METRES.get(unit, 1.0), band)


def _matching(cells: list[str], role: str) -> list[int]:
    """Places of the cells whose name, without unit and band, is one of a role's names."""
    matches = ((place, _HEADING.fullmatch(cell.lower())) for place, cell in enumerate(cells))
    return [
        place
        for place, match in matches
        if match and " ".join(match["name"].replace("_", " ").split()) in _NAMES[role]
    ]


def _all_numbers(cells: list[str]) -> bool:
    """Whether a line is a row of numbers (with decimal point or comma): two cells or more."""
    numbers = [cell for cell in cells if cell]
    return len(numbers) > 1 and all(_number(cell.replace(",", ".")) is not None for cell in numbers)


def _number(cell: str) -> float | None:
    """Convert a cell; None where it is no number (Python's 1_000 is none)."""
    try:
        return None if "_" in cell else float(cell)
    except ValueError:
        return None


def _data_rows(text: str, header: _Header) -> Iterator[tuple[int, list[str]]]:
    """Row numbers and cells below the header, without comments and rows with nothing in them."""
    for row, line in _lines(text):
        if row > header.row:
            cells = _cells(line, header.separator)
            if any(cells):
                yield row, cells


def _decimal_comma(text: str, header: _Header) -> bool:
    """Whether the first mark met in the two columns is a comma; never in comma-separated files."""
    if header.separator == ",":
        return False
    for _, cells in _data_rows(text, header):
        for column in (header.distance, header.level):
            cell = cells[column.place] if column.place < len(cells) else ""
            if "," in cell or "." in cell:
                return "." not in cell
    return False


def _read_numbers(text: str, header: _Header, faults: Faults) -> _Numbers:
    """Read the two columns and check that the distances rise by even steps."""
    bad = _RowFaults(faults)
    comma = _decimal_comma(text, header)
    columns = (header.distance, header.level)
    width = 1 + max(column.place for column in columns)
    rows, counts, values = array("q"), array("q"), (array("d"), array("d"))
    for count, (row, cells) in enumerate(_data_rows(text, header)):
        if len(cells) < width or any(cells[header.width :]):
            bad.add(row, "", f"{len(cells)} cells", f"{header.width} as in the header", _CELLS)
            continue
        pair = [_cell(cells[column.place], comma, row, column, bad) for column in columns]
        if pair[0] is not None and pair[1] is not None:
            rows.append(row)
            counts.append(count)
            values[0].append(pair[0])
            values[1].append(pair[1])
    numbers = _Numbers(*(np.array(column) for column in (rows, counts, *values)))
    _check_distances(numbers, header, bad)
    bad.close()
    if bad.count == 0 and len(rows) < FEWEST_ROWS:
        found = f"{len(rows)} rows of numbers"
        faults.add(f"below row {header.row}", found, f"at least {FEWEST_ROWS}")
    faults.raise_if_any()
    return numbers


def _cell(text: str, comma: bool, row: int, column: _Column, bad: _RowFaults) -> float | None:
    """Convert one cell to metres; note what is wrong with it."""
    if comma:  # a point is then a thousands mark, if anything
        number = None if "." in text else _number(text.replace(",", ".", 1))
    else:
        number = _number(text)
    if number is not None and isfinite(number):
        return number * column.metres
    shown = repr(text if len(text) <= 40 else text[:40] + "…")
    if not text:
        bad.add(row, column.heading, "a blank cell", "a number", "fill it, or cut the record there")
    elif number is not None:
        bad.add(row, column.heading, shown, "a finite number", "cut the record there")
    elif "," in text:
        bad.add(row, column.heading, shown, "a number", "decimal commas: throughout, and ; between")
    else:
        bad.add(row, column.heading, shown, "a number")
    return None


def _check_distances(numbers: _Numbers, header: _Header, bad: _RowFaults) -> None:
    """Note distances that fall, stand still, leave a gap or crowd, from one row to the next."""
    neighbours = np.diff(numbers.count) == 1  # not across a row that has a fault of its own
    steps = np.diff(numbers.distance)
    forward = steps[neighbours & (steps > 0.0)]
    if not np.any(neighbours):
        return
    heading = header.distance.heading
    if forward.size == 0 and np.all(steps < 0.0):
        row = int(numbers.row[1])
        bad.add(row, heading, "distances that fall throughout", "rising ones", "reverse them")
        return
    median = float(np.median(forward)) if forward.size else 0.0
    wrong = neighbours & ((steps < 0.5 * median) | (steps > 1.5 * median) | (steps <= 0.0))
    metres = header.distance.metres
    for place in np.flatnonzero(wrong).tolist():
        step = float(steps[place])
        before, here = (numbers.distance[place : place + 2] / metres).tolist()
        found = f"{here:.12g} after {before:.12g}"
        if step == 0.0:
            found, mend = found + ", the same distance again", "keep one of the two rows"
        elif step < 0.0:
            found, mend = found + ", a fall", "sort the rows by distance"
        elif step > median:
            found, mend = found + ", a gap", "cut the record there or fill the gap"
        else:
            found, mend = found + ", a short step", "resample the record evenly"
        usual = f"a step near {median / metres:.6g}, as elsewhere" if median else "a rise"
        bad.add(int(numbers.row[place + 1]), heading, found, usual, mend)


def _check_level(numbers: _Numbers, header: _Header, faults: Faults) -> None:
    """Refuse a level that departs by more than a metre from a straight line: no railway does."""
    from scipy.signal import detrend

    departure = np.abs(detrend(numbers.level))
    place = int(np.argmax(departure))
    if departure[place] > 1.0:
        faults.add(
            f"row {numbers.row[place]}, column {header.level.heading!r}",
            f"a level {departure[place]:.3g} m off the straight line through the record",
            "irregularities of millimetres, 1 m at most",
            "if the numbers are millimetres, head the column level_mm",
        )
    faults.raise_if_any()


def _on_even_grid(distance: FloatArray, level: FloatArray) -> tuple[float, FloatArray, list[str]]:
    """Step (m) and levels of the even grid that the distances are, or are resampled to."""
    n = distance.size
    mean = float(distance[-1] - distance[0]) / (n - 1)
    places = np.arange(n)
    # The step of a written file comes back only if its distances do, to the last bit.
    for step in (*(float(f"{mean:.{digits}g}") for digits in (6, 9, 12, 15)), mean):
        if np.array_equal(distance[0] + step * places, distance):
            return step, level, []
    departure = float(np.max(np.abs(distance[0] + mean * places - distance)))
    if departure <= max(0.02 * mean, 0.51 * _printed_digit(distance)):
        return mean, level, []

    from scipy.interpolate import make_interp_spline

    spline = make_interp_spline((distance - distance[0]) / mean, level, k=5)
    low, high = np.min(np.diff(distance)), np.max(np.diff(distance))
    return (
        mean,
        np.asarray(spline(places)),
        [f"uneven steps of {low:.4g} to {high:.4g} m were resampled to {mean:.6g} m by a spline"],
    )


def _printed_digit(distance: FloatArray) -> float:
    """Last decimal place (m) that the distances have in print; 0 where there is none by 1e-4 m."""
    for digit in (0.1, 0.01, 0.001, 1e-4):
        counts = distance / digit
        if np.all(np.abs(counts - np.round(counts)) < 1e-5):
            return digit
    return 0.0


def _doubtful(step: float, level: FloatArray, header: _Header) -> list[str]:
    """Remarks on levels that a slip of the unit would explain."""
    remarks = []
    rms, steepness = float(np.std(level)), float(np.std(np.diff(level))) / step
    if steepness > 0.02:
        remarks.append(
            f"the r.m.s. slope is {steepness:.2g}, far above any railway's (about 0.001): is the "
            f"unit of {header.level.heading!r} right?"
        )
    if 0.0 < rms < 1e-5:
        remarks.append(
            f"the r.m.s. level is only {1000 * rms:.2g} mm: is the unit of "
            f"{header.level.heading!r} right?"
        )
    mean = float(np.mean(level))
    if abs(mean) > 1.0:
        remarks.append(
            f"the level lies about {mean:.3g} m from zero; kept, as it changes no acceleration"
        )
    return remarks
