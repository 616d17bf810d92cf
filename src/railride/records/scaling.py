"""Units of a record: accelerations to m/s², times to s; "g" is gravity here, not the gram."""

from __future__ import annotations

import math
import re

from railride.errors import Faults
from railride.tables import Column
from railride.units import QuantityError, same_dimension, to_si

# How files write units, where the units library would read them otherwise or not at all.
_ACCELERATIONS = {
    **dict.fromkeys(("g", "G", "gn", "g0", "g₀", "gₙ", "gee", "g-force"), "g_n"),
    **dict.fromkeys(("mg", "mG", "milli-g", "millig", "mgn"), "mg_n"),
    **dict.fromkeys(("µg", "μg", "ug", "µG", "micro-g"), "µg_n"),
    **dict.fromkeys(
        ("ms2", "ms-2", "ms^-2", "ms⁻²", "mps2", "m/s/s", "m/sec2", "m/sec^2"), "m/s^2"
    ),
}
_EXPECTED = "a unit of acceleration: m/s², g or mg"
UNITS_OF_TIME = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds", "sek", "sekunden"), "s"),
    **dict.fromkeys(("ms", "msec", "millis", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("us", "µs", "μs", "usec", "microsecond", "microseconds", "micros"), "µs"),
    **dict.fromkeys(("ns", "nsec", "nanosecond", "nanoseconds", "nanos"), "ns"),
    **dict.fromkeys(("min", "minutes"), "min"),
    **dict.fromkeys(("h", "hours"), "h"),
}


def acceleration_factor(unit: str) -> float:
    """m/s² per ``unit``.

    unit: m/s², m/s^2, m/s2, g, mg, mm/s² …; or what the number 1 stands for, as in "20 m/s^2".

    Raises QuantityError where it is no unit of acceleration.

    >>> acceleration_factor("g"), acceleration_factor("m/s²"), acceleration_factor("2.5 mm/s2")
    (9.80665, 1.0, 0.0025)
    """
    text = unit.strip()
    number, plain = 1.0, text
    match = re.fullmatch(r"([+-]?\d+\.?\d*(?:[eE][+-]?\d+)?)\s*(\D.*)", text)
    if match:
        number, plain = float(match[1]), match[2]
    plain = _ACCELERATIONS.get(plain.replace(" ", ""), plain)
    try:
        factor = number * to_si(1.0, plain) if same_dimension(plain, "m/s^2") else 0.0
    except QuantityError as error:  # whose advice is of any dimension
        raise QuantityError(error.found, _EXPECTED) from None
    if factor == 0.0 or not math.isfinite(factor):
        raise QuantityError(f"the unit {unit!r}", _EXPECTED)
    return factor


def is_acceleration(column: Column) -> bool:
    """Whether a column has a unit of acceleration, or none.

    column: of a table.
    """
    try:
        return not column.unit or bool(acceleration_factor(column.unit))
    except QuantityError:
        return False


def factors(
    columns: tuple[Column, ...], unit: str | None, faults: Faults, remarks: list[str]
) -> list[float]:
    """m/s² per unit of each column: by ``unit``, or else its heading, or else 1 with a remark.

    columns: of accelerations.
    unit: of all of them, as the user gave it; None if not given.
    faults: for a unit that is none.
    remarks: for a heading that says otherwise than ``unit``, and for no unit at all.
    """
    found = []
    for column in columns:
        own, where = 0.0, f"column {column.heading!r}"
        try:
            own = acceleration_factor(column.unit) if column.unit else 0.0
        except QuantityError as error:
            if unit is None:
                faults.add(where, error.found, error.expected, "head it so, or give the unit")
        found.append(own)
    if unit is None:
        bare = [c.heading for c, own in zip(columns, found, strict=True) if not c.unit and not own]
        if bare:
            remarks.append(f"{', '.join(map(repr, bare))}: no unit is stated, m/s² is assumed")
        return [own or 1.0 for own in found]
    try:
        given = acceleration_factor(unit)
    except QuantityError as error:
        faults.add("unit", error.found, error.expected, error.mend)
        return [1.0 for _ in columns]
    others = [c.heading for c, own in zip(columns, found, strict=True) if own not in (0.0, given)]
    if others:
        remarks.append(f"{', '.join(map(repr, others))}: read in {unit}, as told, not as headed")
    return [given for _ in columns]


def time_unit(column: Column) -> str:
    """Unit of a time column as its heading tells: in brackets, or in its name; empty if not.

    column: of times.

    Raises QuantityError where the heading's unit is none of time.
    """
    if column.unit:
        unit = UNITS_OF_TIME.get(column.unit.strip().lower().strip("()"), "")
        if not unit and re.search(r"[A-Za-z°%]", column.unit):
            raise QuantityError(f"the unit {column.unit!r}", "a unit of time: s, ms, µs or ns")
        return unit
    words = re.findall(r"[^\W_]+", column.name.lower())
    return next(
        (UNITS_OF_TIME[word] for word in words if len(word) > 1 and word in UNITS_OF_TIME), ""
    )
