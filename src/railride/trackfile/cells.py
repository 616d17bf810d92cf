"""What the text of a cell says: a number, or a kilometre and a metre."""

from __future__ import annotations

import re

from railride.tables import Column

_KM_AND_M = "km+m"
_PLACE = re.compile(r"(?:km)?\s*(\d{1,4})\s*\+\s*(\d{1,5}(?:[.,]\d*)?)(?:\s*m)?", re.IGNORECASE)
_JUDGED = 20  # cells


def is_number(cell: str) -> bool:
    """Whether a cell is a number by Python's rules (1_000 is none), NaN and infinity too.

    >>> is_number("1e999"), is_number("nan"), is_number("inv"), is_number("1_0")
    (True, True, False, False)
    """
    try:
        float(cell.replace("_", "x"))
    except ValueError:
        return False
    return True


def kilometre_and_metre(cell: str) -> tuple[float, float] | None:
    """Kilometre and metre of a location; None where it is none.

    >>> kilometre_and_metre("130+0100.25"), kilometre_and_metre("km 12+345,6 m")
    ((130.0, 100.25), (12.0, 345.6))
    """
    match = _PLACE.fullmatch(cell.strip())
    return (float(match[1]), float(match[2].replace(",", "."))) if match else None


def is_km_and_m(column: Column) -> bool:
    """Whether a column's cells are kilometre and metre: by its unit, or by most of the first."""
    if column.unit.replace(" ", "") == _KM_AND_M:
        return True
    first = column.cells[:_JUDGED] if column.bad.size else ()
    return 2 * sum(kilometre_and_metre(cell) is not None for cell in first) > len(first)
