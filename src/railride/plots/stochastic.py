"""Pictures of exact comfort values: along the car, over speed, and both as a map.

The table is that of ``comfort_map``: "speed [km/h]", "position [m]", "a_wrms [m/s^2]" and others.
Its ``attrs`` say what it is of, which becomes the title.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.spectra import FloatArray

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SPEED, PLACE = "speed [km/h]", "position [m]"
VALUES = {
    "a_wrms [m/s^2]": "weighted r.m.s. acceleration [m/s²]",
    "a_rms [m/s^2]": "r.m.s. acceleration [m/s²]",
    "Wz": "Sperling's ride index W$_z$",
}
WEIGHTED = "a_wrms [m/s^2]"
MOST_LINES = 8  # that colours still tell apart


def plot_comfort_along(
    table: pd.DataFrame, *, value: str = WEIGHTED, ax: Axes | None = None
) -> Axes:
    """Draw a comfort value along the car, one line per speed (at most eight).

    table : of ``comfort_map``. value : the column to draw.

    Raises InputError for a table without such a column, or with more than eight speeds.
    """
    ax = _lines(table, value, across=PLACE, per=SPEED, ax=ax, unit="km/h")
    ax.set_xlabel("position on the floor, forward of the middle [m]")
    return ax


def plot_comfort_over_speed(
    table: pd.DataFrame, *, value: str = WEIGHTED, ax: Axes | None = None
) -> Axes:
    """Draw a comfort value over speed, one line per point of the floor (at most eight).

    table : of ``comfort_map``. value : the column to draw.

    Raises InputError for a table without such a column, or with more than eight points.
    """
    ax = _lines(table, value, across=SPEED, per=PLACE, ax=ax, unit="m")
    ax.set_xlabel("speed [km/h]")
    return ax


def plot_comfort_map(table: pd.DataFrame, *, value: str = WEIGHTED, ax: Axes | None = None) -> Axes:
    """Draw a comfort value over speed and along the car, as colours with lines of equal value.

    table : of ``comfort_map``. value : the column to draw.

    Raises InputError for a table without such a column, or with fewer than two speeds or points.
    """
    _check(table, value)
    grid = table.pivot_table(index=PLACE, columns=SPEED, values=value)
    if min(grid.shape) < 2:
        raise InputError(f"comfort map: found {grid.shape[1]} speeds and {grid.shape[0]} points; "
                         "expected at least two of each for a map")  # fmt: skip
    speeds, places, z = grid.columns.to_numpy(), grid.index.to_numpy(), grid.to_numpy()
    ax = canvas.axes_or_new(ax, 7.5, 4.2)
    mesh = ax.pcolormesh(speeds, places, z, cmap="viridis", shading="gouraud", rasterized=True)
    figure = ax.get_figure()
    if figure is not None:
        bar = figure.colorbar(mesh, ax=ax, pad=0.02)
        bar.set_label(VALUES[value])
    canvas.contours(ax, speeds, places, z)
    ax.set_title(_title(table, value), **canvas.TITLE)
    ax.set_xlabel("speed [km/h]")
    ax.set_ylabel("position on the floor,\nforward of the middle [m]")
    ax.spines[["top", "right"]].set_visible(False)
    return ax


def _title(table: pd.DataFrame, value: str, *more: str) -> str:
    """What the table is of, as far as it says so."""
    weighting = table.attrs.get("weighting", "")
    weighted = f"{weighting} weighted" if weighting and value == WEIGHTED else ""
    return ", ".join(filter(None, (table.attrs.get("of", ""), weighted, *more)))


def plot_comfort(table: pd.DataFrame, *, value: str = WEIGHTED) -> Figure:
    """Draw a comfort value as suits the table: curves where there are few, else the map.

    Up to eight speeds give curves along the car, else up to eight points curves over speed.

    table : of ``comfort_map``. value : the column to draw.

    Raises InputError for a table without such a column.
    """
    _check(table, value)
    figure = canvas.new_figure(7.5, 4.2)
    ax = figure.add_subplot()
    if table[SPEED].nunique() <= MOST_LINES and table[PLACE].nunique() > 1:
        plot_comfort_along(table, value=value, ax=ax)
    elif table[PLACE].nunique() <= MOST_LINES:
        plot_comfort_over_speed(table, value=value, ax=ax)
    else:
        plot_comfort_map(table, value=value, ax=ax)
    return figure


def _lines(
    table: pd.DataFrame, value: str, *, across: str, per: str, ax: Axes | None, unit: str
) -> Axes:
    """One line per value of a column, told apart by colour from dark to light."""
    from matplotlib import colormaps

    _check(table, value)
    keys: FloatArray = np.unique(table[per].to_numpy(dtype=float))
    if keys.size > MOST_LINES:
        raise InputError(
            f"comfort: found {keys.size} values of {per}, more lines than one can tell apart; "
            f"expected at most {MOST_LINES} (choose some, or draw the map)"
        )
    ax = canvas.axes_or_new(ax, 7.0, 3.6)
    shades = colormaps["viridis"](np.linspace(0.0, 0.85, keys.size))
    styles = ("-", "--", "-.", ":")
    for k, (key, colour) in enumerate(zip(keys, shades, strict=True)):
        own = table[table[per] == key].sort_values(across)
        mark = "o" if len(own) == 1 else None
        ax.plot(own[across], own[value], color=colour, linewidth=1.4, marker=mark,
                linestyle=styles[k % 4], label=f"{key:g} {unit}")  # fmt: skip
    x = table[across].to_numpy(dtype=float)
    if np.ptp(x):
        ax.set_xlim(x.min(), x.max())
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(VALUES[value])
    if keys.size > 1:
        title = "speed" if per == SPEED else "position"
        ax.legend(title=title, frameon=False, fontsize="small", loc="center left",
                  bbox_to_anchor=(1.0, 0.5))  # fmt: skip
    single = f"{keys[0]:g} {unit}" if keys.size == 1 else ""
    ax.set_title(_title(table, value, single), **canvas.TITLE)
    canvas.tidy(ax)
    return ax


def _check(table: pd.DataFrame, value: str) -> None:
    missing = [name for name in (SPEED, PLACE, value) if name not in table]
    if value not in VALUES or missing:
        raise InputError(
            f"comfort: found the columns {', '.join(map(str, table.columns))} and {value!r} asked "
            f"for; expected a table of comfort_map and one of {', '.join(VALUES)}"
        )
