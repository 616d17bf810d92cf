"""Tornado plots: which parameter matters most to the comfort, and how far its gradient reaches."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.sensitivities import FELT
from railride.text import symbol

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.sensitivities import Sensitivities

MOST = 12  # parameters of one picture, the most important
_WIDE = 34  # letters of a parameter's name on one line
_ABREAST = 3  # cases beside one another
_BAR = 0.38  # of the distance of two parameters
_COLOURS = (canvas.BODY, canvas.BOGIE)  # less and more of a parameter
_HATCHES = ("", "//")


def plot_tornado(
    found: Sensitivities, case: int = 0, *, ax: Axes | None = None, most: int = MOST
) -> Axes:
    """Draw what less and more of each parameter do to the weighted r.m.s., the largest on top.

    Bars are values found anew; diamonds what the gradient says of the same change.

    found : of ``sensitivity``. case : which speed and point of the floor, from 0, speeds outer.
    most : parameters at most, the most important.

    Raises
    ------
    InputError : a case that there is not.
    """
    count = found.a_wrms.size
    if not 0 <= case < count:
        raise InputError(f"case: found {case}; expected 0 to {count - 1}, speeds outer, points of "
                         "the floor inner")  # fmt: skip
    some = _chosen(found, most, case)
    ax = canvas.axes_or_new(ax, 7.5, 1.8 + 0.4 * len(some))
    _draw(ax, found, case, some)
    ax.set_xlim(*_reach(found, [case], some))
    title = f"held: {found.held}" if found.held else None
    ax.legend(
        loc="lower right",
        fontsize="small",
        framealpha=0.9,
        edgecolor="none",
        title=title,
        title_fontsize="small",
        alignment="left",
    )  # below, where bars are short
    return ax


def plot_tornadoes(found: Sensitivities, *, most: int = MOST) -> Figure:
    """Draw a tornado for every speed and point of the floor, parameters in one order.

    found : of ``sensitivity``. most : parameters at most, the most important.
    """
    some, cases = _chosen(found, most), found.a_wrms.size
    down = -(-cases // _ABREAST)
    across = -(-cases // down)
    height = min(1.0 + down * (1.1 + 0.38 * len(some)), canvas.TALLEST)
    figure = canvas.new_figure(2.4 + 4.0 * across, height)
    grid = figure.subplots(down, across, squeeze=False, sharey=True)
    for case, ax in enumerate(grid.ravel()):
        if case >= cases:
            ax.set_axis_off()
            continue
        _draw(ax, found, case, some)
        ax.set_xlim(*_reach(found, range(cases), some))
        if case % across:
            ax.tick_params(labelleft=False)
    figure.legend(
        *grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3, frameon=False
    )
    held = f"; held: {found.held}" if found.held else ""
    figure.suptitle(f"{found.vehicle} ({found.body}) over {found.track}, {found.floor} floor, "
                    f"{found.weighting} weighted{held}", fontsize="medium")  # fmt: skip
    return figure


def _chosen(found: Sensitivities, most: int, case: int | None = None) -> list[int]:
    """The places of the parameters that are drawn, the most important last and so on top."""
    return found.ranked(case)[:most][::-1]


def _draw(ax: Axes, found: Sensitivities, case: int, some: list[int]) -> None:
    """Bars and diamonds of some parameters."""
    i, j = divmod(case, len(found.positions))
    effects, linear = (100 * of[i, j][some] for of in (found.effects, found.linear_effects))
    places = np.arange(len(some))
    for side, word in enumerate(("less", "more")):
        ax.barh(places + (0.5 - side) * _BAR, np.nan_to_num(effects[:, side]), _BAR,
                color=_COLOURS[side], hatch=_HATCHES[side], edgecolor="white", linewidth=0.6,
                label=f"{100 * found.change:g} % {word} of it")  # fmt: skip
    at = np.concatenate([places + _BAR / 2, places - _BAR / 2])
    ax.plot(linear.T.ravel(), at, "D", color="black", markerfacecolor="white", markersize=4,
            linestyle="none", label="by its gradient", zorder=4)  # fmt: skip
    ax.axvline(0, color="black", linewidth=0.8)
    ax.set_yticks(places, [_named(found, k) for k in some])
    ax.set_ylim(-0.7, len(some) - 0.3)
    ax.set_xlabel("change of a_wrms [%]")
    ax.set_title(_heading(found, case), **canvas.TITLE)
    canvas.tidy(ax)
    ax.grid(visible=False, axis="y")
    ax.tick_params(axis="y", length=0)


def _reach(found: Sensitivities, cases: Iterable[int], some: list[int]) -> tuple[float, float]:
    """Limits of the axis of changes, %, alike to both sides."""
    every = np.stack([found.effects, found.linear_effects]).reshape(2, -1, len(found.parameters), 2)
    largest = float(np.nanmax(np.abs(every[:, list(cases)][:, :, some])))
    return -115 * max(largest, FELT), 115 * max(largest, FELT)


def _named(found: Sensitivities, k: int) -> str:
    """A parameter's meaning and symbol, on as many lines as it takes."""
    p = found.parameters[k]
    return textwrap.fill(f"{p.meaning.partition(',')[0]}, {symbol(p.symbol)}", _WIDE)


def _heading(found: Sensitivities, case: int) -> str:
    i, j = divmod(case, len(found.positions))
    return (f"{3.6 * found.speeds[i]:g} km/h, x = {found.positions[j]:g} m: "
            f"a_wrms {found.a_wrms[i, j]:.3f} m/s²")  # fmt: skip
