"""Pictures of active suspensions: where in frequency a design helps, and what travel it costs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railride.errors import InputError
from railride.plots import canvas

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

_DEEPEST = 1e-4  # of the largest value: what lies lower is a zero
_COMFORT, _TRAVEL = "a_wrms at ", "travel r.m.s. bogie "


def plot_loop_spectra(spectra: pd.DataFrame, *, ax: Axes | None = None) -> Axes:
    """Draw the root of each design's spectrum, m/s²/√Hz, over frequency, Hz, both logarithmic.

    spectra : of :func:`railride.active.loop_spectra`, the passive vehicle first.

    Raises InputError where there is nothing in it.
    """
    from matplotlib.ticker import FuncFormatter, LogLocator

    if spectra.empty:
        raise InputError("spectra: found none; expected at least one design and frequency")
    ax = canvas.axes_or_new(ax, 7.5, 4.2)
    frequency = spectra.index.to_numpy(dtype=float)
    for k, name in enumerate(spectra.columns):
        look = canvas.line_look(k - 1) if k else {"color": canvas.TRACK}  # the passive one in grey
        values = np.sqrt(spectra[name].to_numpy(dtype=float))
        ax.plot(*canvas.outline(frequency, values), **look, linewidth=1.3, label=str(name))
    largest, least = (float(np.sqrt(x)) for x in (spectra.max().max(), spectra.min().min()))
    ax.set_xscale("log")
    if frequency[0] < frequency[-1]:
        ax.set_xlim(frequency[0], frequency[-1])
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    ax.xaxis.set_minor_formatter(FuncFormatter(lambda _, __: ""))
    ax.set_yscale("log")
    ax.set_ylim(max(least, _DEEPEST * largest) / 1.5, 1.5 * largest)
    ax.set_xlabel("frequency [Hz]")
    ax.set_ylabel("weighted floor acceleration [m/s²/√Hz]")
    canvas.tidy(ax)
    ax.legend(framealpha=0.9, edgecolor="none")
    return ax


def plot_loops(table: pd.DataFrame, *, ax: Axes | None = None) -> Axes:
    """Draw each design as a point: comfort, m/s², over suspension travel, mm, the r.m.s. of both.

    Comfort is that of the first position, travel that of the bogie that has most.

    table : of :func:`railride.active.rate_loops`.

    Raises InputError for a table without these columns or without a row.
    """
    comfort = [name for name in table.columns if name.startswith(_COMFORT)]
    travel = [name for name in table.columns if name.startswith(_TRAVEL)]
    if not comfort or not travel or table.empty:
        raise InputError(f"table: found the columns {', '.join(map(str, table.columns)) or 'none'}"
                         f"; expected {_COMFORT}… and {_TRAVEL}…, as of rate_loops")  # fmt: skip
    ax = canvas.axes_or_new(ax, 5.5, 4.2)
    most = 1e3 * table[travel].max(axis=1)
    for k, name in enumerate(table.index):
        look = canvas.mark_look(k - 1) if k else {"color": canvas.TRACK, "marker": "o"}
        ax.plot(most[name], table.loc[name, comfort[0]], **look, linestyle="none", markersize=7,
                label=str(name))  # fmt: skip
    ax.set_xlim(0, 1.15 * float(most.max()))
    ax.set_ylim(0, 1.15 * float(table[comfort[0]].max()))
    ax.set_xlabel("suspension travel, r.m.s. [mm]")
    ax.set_ylabel(comfort[0].replace(" [m/s^2]", " [m/s²]"))
    canvas.tidy(ax)
    ax.legend(framealpha=0.9, edgecolor="none")
    return ax
