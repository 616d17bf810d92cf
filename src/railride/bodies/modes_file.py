"""Natural modes of a car body from a table: a column for each mode, a row for each point.

::

    x [m],              mode 1, mode 2
    frequency [Hz],     9.6,    25.8
    modal_mass [t],     8.5,    8.6
    damping_ratio,      0.015,  0.02
    -12.0,              1.0,    -1.0
    -11.5,              0.88,   -0.78
    …

The rows that are not points are named in the column x, in any order; ``damping_ratio`` may be left
out. Shapes are heights in any scale, upward, and rigid motions may be among the modes. A column
``point_mass [kg]``, blank in the named rows, shares the body's mass among the points.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railride.bodies.point_modes import PointModes
from railride.errors import Faults
from railride.record_tables import read_column, unit_factor
from railride.tables import Column, NumberTable, read_table, split_heading

ROWS = {"frequency": "Hz", "modal_mass": "kg", "damping_ratio": ""}
NEEDED = ("frequency", "modal_mass")


def read_modes(path: str | Path) -> PointModes:
    """Natural modes from a table, in CSV or another format of numbers.

    Parameters
    ----------
    path : of the file.

    Raises
    ------
    InputError : with all faults at once: columns or rows that are missing, doubled, without a unit
        or with one of another kind; cells that are no numbers; what :class:`PointModes` refuses.
    """
    table = read_table(path)
    faults = Faults(table.source)
    place, masses, modes = _columns(table, faults)
    named, factors = _named_rows(table, place, faults)
    points = np.setdiff1d(np.arange(table.n), place.bad)
    x = np.array(read_column(table, place, "m", "", faults, points.tolist()))
    own = [np.array(read_column(table, c, "kg", ">= 0", faults, points.tolist())) for c in masses]
    rows = [*points.tolist(), *named.values()]
    numbers = np.array([read_column(table, c, "", "", faults, rows) for c in modes])
    faults.raise_if_any()
    order = np.argsort(x, kind="stable")
    given = dict(zip(named, numbers[:, points.size :].T * factors, strict=True))
    return PointModes(
        table.source, x[order], given["frequency"], given["modal_mass"], numbers[:, order],
        given.get("damping_ratio"), own[0][order] if own else None, table.remarks,
    )  # fmt: skip


def _columns(table: NumberTable, faults: Faults) -> tuple[Column, list[Column], list[Column]]:
    """The column x, which also names the rows that are no points; of point masses; of modes."""
    places, masses = table.find("x"), table.find("point_mass")
    if len(places) != 1 or len(masses) > 1:
        faults.add("header", f"{len(places)} columns x and {len(masses)} columns point_mass",
                   "one headed x [m], and at most one point_mass [kg]",
                   "head the modes by names, such as mode 1, not by numbers")  # fmt: skip
        faults.raise_if_any()
    modes = [column for column in table.columns if column not in (*places, *masses)]
    if not modes:
        faults.add("header", "no column besides x", "one for each mode")
    return places[0], list(masses), modes


def _named_rows(
    table: NumberTable, place: Column, faults: Faults
) -> tuple[dict[str, int], NDArray[np.float64]]:
    """Which row holds the frequencies, the modal masses and so on, and its factor to SI, (·, 1)."""
    found: dict[str, int] = {}
    factors = []
    for i in place.bad.tolist():
        heading, unit = split_heading(place.cells[i])
        name, where = "_".join(heading.lower().split()), table.where(i, place)
        if name not in ROWS or name in found:
            shown = place.shown(i) + " a second time" * (name in found)
            faults.add(where, shown, f"the place of a point, or one of {', '.join(ROWS)}")
            continue
        found[name] = i
        factors.append(unit_factor(unit, ROWS[name], where, faults))
    for name in NEEDED:
        if name not in found:
            faults.add(f"column {place.heading!r}", f"no row {name}",
                       f"one named {name} [{ROWS[name]}]")  # fmt: skip
    return found, np.array(factors)[:, np.newaxis]
