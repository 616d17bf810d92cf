"""What a parameter of a study takes: a range, or values one by one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from railride.numeric import Array
from railride.toml_tables import Table

SPACINGS = ("linear", "log")
MOST_POINTS = 1_000_000  # of one parameter


@dataclass(frozen=True)
class Range:
    """From ``low`` to ``high``, SI, low < high; in ``points`` values where it is stepped through.

    spacing : "linear", equal steps; or "log", equal ratios.

    >>> Range(1.0, 100.0, points=3, spacing="log").values().tolist()
    [1.0, 10.0, 100.0]
    """

    low: float
    high: float
    points: int | None = None
    spacing: str = "linear"

    def values(self) -> Array:
        """Its values, both ends among them: shape (points,)."""
        spaced = np.geomspace if self.spacing == "log" else np.linspace
        return np.asarray(spaced(self.low, self.high, self.points or 2), dtype=float)


@dataclass(frozen=True)
class Listed:
    """Values one by one, SI, in the order given; no two are the same."""

    listed: tuple[float, ...]

    def values(self) -> Array:
        """The values, shape (points,)."""
        return np.array(self.listed)


def read_range(table: Table, unit: str, sign: str) -> Range | None:
    """The range of a table with ``from``, ``to`` and, if given, ``points`` and ``spacing``.

    Faults: an end that is missing, a range that is empty or reversed, fewer than two points, equal
    ratios from 0 or less.
    """
    for name in ("from", "to"):
        table.missing(name, f'{name} = "{f"number {unit}".strip()}"')
    low, high = table.quantity("from", unit, sign), table.quantity("to", unit, sign)
    points, spacing = table.whole("points"), table.choice("spacing", SPACINGS) or "linear"
    if points is not None and not 2 <= points <= MOST_POINTS:
        table.fault("points", str(points), f"a whole number from 2 to {MOST_POINTS:,}")
        points = None  # no such many are made
    if low is None or high is None:
        return None
    if low >= high:
        how = "an empty range" if low == high else "a range that runs backwards"
        ends = f"from {table.content['from']!r} to {table.content['to']!r}"
        mend = "give a single value in [body] or the vehicle" if low == high else "swap the two"
        table.fault("from", f"{how}, {ends}", "a value below that of to", mend)
        spacing = "linear"  # which has values whatever the ends are
    elif spacing == "log" and low <= 0:
        table.fault("from", repr(table.content["from"]), "a value above 0 for equal ratios",
                    'or take spacing = "linear"')  # fmt: skip
        spacing = "linear"
    return Range(low, high, points, spacing)


def read_listed(table: Table, unit: str, sign: str) -> Listed | None:
    """The values of a table with ``values``; none, or one that stands twice, are faults."""
    values = table.quantities("values", unit, sign)
    if values is None:
        return None
    if not values:
        table.fault("values", "an empty list", "at least one value")
    again = {value for value in values if values.count(value) > 1} if len(values) < 1000 else set()
    if again:
        place = max(i for i, value in enumerate(values, start=1) if value in again)
        text = table.content["values"][place - 1]
        table.fault(f"values[{place}]", f"{text!r}, which stands there before", "each value once")
    return Listed(values)
