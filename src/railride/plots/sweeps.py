"""Pictures of sweeps: a result over one parameter, or over two as a map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.spectra import FloatArray
from railride.sweeps import SweepResult
from railride.sweeps.result import RATED
from railride.tables import split_heading
from railride.units import to_unit

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

MOST_POINTS = 200_000  # designs drawn one by one: more than any picture shows
_LARGER = {"N/m": "kN/m", "N s/m": "kN s/m", "N m/rad": "kN m/rad", "kg": "t", "N m^2": "MN m^2"}


def plot_sweep(
    result: SweepResult,
    *,
    over: str | tuple[str, str] | None = None,
    value: str | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw a result of a sweep over one parameter or two.

    Over two, a grid becomes a map, and other designs points in colours. Where further parameters
    vary, a map has the least value of each place, and what is drawn over one parameter is points.
    Axes are in kN/m, kN s/m, kN m/rad, MN m² and t where the table's columns are in SI units.

    result : of :func:`railride.sweep` or :func:`railride.read_sweep`. over : headings of one
    parameter or two; default the first two, or the only one. value : heading of what is drawn;
    default the first weighted r.m.s., or the first column.

    Raises InputError for headings that there are not, and where no design has a value.
    """
    chosen = [over] if isinstance(over, str) else list(over or result.parameters[:2])
    rated = [name for name in result.columns if name.startswith(RATED)]
    value = value or (rated or list(result.columns))[0]
    for heading, known in ((value, result.columns), *((h, result.parameters) for h in chosen)):
        if heading not in known:
            raise InputError(f"sweep: found {heading!r} asked for; expected one of "
                             f"{', '.join(known)}")  # fmt: skip
    if len(chosen) > 2:
        raise InputError(f"sweep: found {len(chosen)} parameters; expected one or two")
    table = result.table([*chosen, value]).dropna()
    if table.empty:
        raise InputError(f"sweep: found no design with a value of {value!r}; expected some")
    ax = canvas.axes_or_new(ax, 7.0, 4.2)
    draw = _over_one if len(chosen) == 1 else _over_two
    draw(ax, table, chosen, value)
    ax.set_title(f"{result.study}: {split_heading(value)[0]}", **canvas.TITLE)
    ax.set_xlabel(_label(chosen[0]))
    return ax


def _over_one(ax: Axes, table: pd.DataFrame, chosen: list[str], value: str) -> None:
    """A line where each value of the parameter stands once, else points."""
    ordered = table.sort_values(chosen[0])
    x = _scaled(ordered[chosen[0]], chosen[0])
    if ordered[chosen[0]].is_unique:
        ax.plot(x, ordered[value], color=canvas.WEIGHTED, linewidth=1.4,
                marker="o" if len(x) <= 60 else None, markersize=3)  # fmt: skip
    else:
        some = slice(None, None, -(-len(x) // MOST_POINTS))
        ax.plot(x[some], ordered[value].iloc[some], ".", color=canvas.WEIGHTED, markersize=2.5,
                markeredgewidth=0, rasterized=True)  # fmt: skip
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(_value_label(value))
    canvas.tidy(ax)


def _over_two(ax: Axes, table: pd.DataFrame, chosen: list[str], value: str) -> None:
    """A map of a grid, or points in colours."""
    mesh: Any
    label = _value_label(value)
    if _is_grid(table, chosen):
        grid = table.pivot_table(index=chosen[1], columns=chosen[0], values=value, aggfunc="min")
        x, y = _scaled(grid.columns, chosen[0]), _scaled(grid.index, chosen[1])
        z = grid.to_numpy()
        mesh = ax.pcolormesh(x, y, z, cmap="viridis", shading="gouraud", rasterized=True)
        canvas.contours(ax, x, y, z)
        label = f"least {label}" if len(table) > z.size else label
    else:
        some = table.iloc[:: -(-len(table) // MOST_POINTS)]
        x, y = (_scaled(some[name], name) for name in chosen)
        mesh = ax.scatter(x, y, c=some[value], s=9, cmap="viridis", linewidths=0,
                          rasterized=True)  # fmt: skip
    figure = ax.get_figure()
    if figure is not None:
        figure.colorbar(mesh, ax=ax, pad=0.02).set_label(label)
    ax.set_ylabel(_label(chosen[1]))
    ax.spines[["top", "right"]].set_visible(False)


def _is_grid(table: pd.DataFrame, chosen: list[str]) -> bool:
    """Whether there is a design at every combination of what two parameters take."""
    sides = [table[name].nunique() for name in chosen]
    return min(sides) > 1 and bool(len(table[chosen].drop_duplicates()) == sides[0] * sides[1])


def _unit(heading: str) -> str:
    """The unit in which people read it."""
    unit = split_heading(heading)[1]
    return _LARGER.get(unit, unit)


def _scaled(values: Any, heading: str) -> FloatArray:
    """A column in the unit in which people read it."""
    return np.asarray(to_unit(np.asarray(values, dtype=float), _unit(heading)))


def _label(heading: str) -> str:
    name, unit = split_heading(heading)[0], _unit(heading)
    if "_" in name and min(map(len, name.split("_"))) > 2:  # words, not a symbol
        name = name.replace("_", " ")
    return f"{name} [{_pretty(unit)}]" if unit else name


def _value_label(heading: str) -> str:
    """What is drawn; the case is in the title."""
    unit = split_heading(heading)[1]
    what = "weighted r.m.s. acceleration" if heading.startswith(RATED) else "value"
    return f"{what} [{_pretty(unit)}]" if unit else what


def _pretty(unit: str) -> str:
    return unit.replace("^2", "²")
