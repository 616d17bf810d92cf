"""Named arrays, as MATLAB and HDF5 files hold them, as one table."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railride.errors import Faults
from railride.tables.table import Column, NumberTable

_RATES = frozenset(
    "fs rate samplerate samplingrate samplefrequency samplingfrequency sfreq fsamp".split()
)
_STEPS = frozenset("dt ts sampleinterval samplinginterval sampletime wfincrement".split())


@dataclass(frozen=True)
class Named:
    """An array of a file, or a text or number beside the data.

    name: its path in the file, parts joined by ``/``; an attribute is named by its own name.
    value: of any shape.
    unit: where the file states it.
    """

    name: str
    value: NDArray[Any]
    unit: str = ""


def table_of_arrays(path: Path, arrays: Iterable[Named]) -> NumberTable:
    """Make a table of the arrays of equal length; a scalar such as ``fs`` or ``dt`` gives the rate.

    path: of the file, for messages.
    arrays: all that it holds. A 2-D array is taken as columns along its longer side, and a record
        of fields as one column for each. Of several lengths the one with most columns counts, the
        longest of these; the others are left out with a remark.

    Raises InputError where there is no array of numbers.
    """
    faults, remarks = Faults(str(path)), []
    found = list(arrays)
    columns = [column for array in found for column in _columns(array)]
    if not columns:
        faults.add(
            "file",
            f"no array of numbers among {len(found)} variables",
            "arrays of one or two dimensions",
            "MATLAB's own table and timetable objects must be saved as arrays or a struct",
        )
        faults.raise_if_any()
    counts = Counter(column.numbers.size for column in columns)
    length = max(counts, key=lambda size: (counts[size], size))
    others = [c.heading for c in columns if c.numbers.size != length]
    if others:
        shown = ", ".join(map(repr, others[:5])) + (", …" if len(others) > 5 else "")
        remarks.append(f"{shown} differ in length from the {length} rows of the others: left out")
    rate = _rate(found, remarks)
    kept = tuple(column for column in columns if column.numbers.size == length)
    return NumberTable(str(path), kept, rate=rate, remarks=tuple(remarks))


def _columns(array: Named) -> Iterator[Column]:
    """Columns of an array; none of a scalar, a text, a cube."""
    value = array.value
    if value.dtype.names:
        for field in value.dtype.names:
            yield from _columns(Named(f"{array.name}/{field}", value[field]))
        return
    if value.dtype.kind not in "iufmMSUO" or value.size < 2 or value.ndim > 2:
        return
    if value.dtype.kind in "SO":
        value = _as_texts(value)
    lines = value.reshape(1, -1) if value.ndim == 1 or min(value.shape) == 1 else value
    if lines.shape[0] > lines.shape[1]:
        lines = lines.T
    for k, line in enumerate(lines, start=1):
        heading = array.name if len(lines) == 1 else f"{array.name}/{k}"
        yield Column.of(heading, line, array.unit)


def _as_texts(value: NDArray[Any]) -> NDArray[Any]:
    def text(item: Any) -> str:
        return item.decode("utf-8", "replace") if isinstance(item, bytes) else str(item)

    return np.array([text(item) for item in value.ravel()], dtype=object).reshape(value.shape)


def _rate(arrays: Iterable[Named], remarks: list[str]) -> float | None:
    """Sampling rate (Hz) that a scalar states; none where two differ, with a remark."""
    rates: dict[float, str] = {}
    for array in arrays:
        plain = re.sub(r"[\W_]|hz$", "", array.name.rpartition("/")[2].lower())
        if array.value.size != 1 or array.value.dtype.kind not in "iuf":
            continue
        number = float(array.value.ravel()[0])
        if plain in _STEPS and number > 0.0:
            number = 1.0 / number
        elif plain not in _RATES:
            continue
        if np.isfinite(number) and number > 0.0:
            rates.setdefault(number, array.name)
    if len(rates) > 1:
        stated = " and ".join(f"{name} {rate:.9g} Hz" for rate, name in rates.items())
        remarks.append(f"the file states several rates, {stated}: none is taken")
    return next(iter(rates)) if len(rates) == 1 else None
