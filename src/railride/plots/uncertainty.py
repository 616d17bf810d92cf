"""Pictures of what uncertain parameters make of a ride."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.scales import SCALES
from railride.units import to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.uncertainties import Summary, Uncertain, Uncertainty

MOST = 6  # quantities of one picture
BINS = 40
_READ = {"m": "mm", "N": "kN"}  # units in which they are read
_BAR = 0.38  # of the distance of two parameters


def plot_uncertainty(
    found: Uncertainty, quantity: str | int = 0, *, ax: Axes | None = None
) -> Axes:
    """Draw how often each value of a quantity occurs, its percentiles and the nominal value.

    Percentiles carry their 95 % interval as a band. Where comfort classes are known, their limits
    stand behind and how probable each of them is above.

    found : of ``uncertainty``. quantity : its name, or its number from 0.
    """
    ax = canvas.axes_or_new(ax, 7.0, 4.0)
    k = found.place(quantity)
    one, unit = found.summaries[k], _READ.get(found.summaries[k].unit, found.summaries[k].unit)
    x = to_unit(found.values[np.isfinite(found.values[:, k]), k], unit)
    share = np.full(x.size, 100 / x.size)
    ax.hist(x, bins=min(BINS, max(5, x.size // 25)), weights=share, color=canvas.ACCELERATION,
            label=f"{x.size} designs")  # fmt: skip
    _draw_classes(ax, one)
    for place, (p, at) in enumerate(one.percentiles.items()):
        look = canvas.line_look(place + 1)
        value, low, high = (to_unit(end, unit) for end in (at.value, at.low, at.high))
        ax.axvline(value, linewidth=1.3, label=f"{p:g} %: {value:#.3g}", **look)
        if np.isfinite([low, high]).all():
            ax.axvspan(low, high, color=look["color"], alpha=0.15, linewidth=0)
    if np.isfinite(one.nominal):
        nominal = to_unit(one.nominal, unit)
        ax.plot(nominal, 0, "k^", markersize=8, clip_on=False, zorder=5,
                label=f"nominal: {nominal:#.3g}")  # fmt: skip
    ax.locator_params(axis="x", nbins=7)
    ax.set_xlabel(f"{one.name} [{unit.replace('^2', '²')}]" if unit else one.name)
    ax.set_ylabel("designs [%]")
    ax.legend(frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    canvas.tidy(ax)
    ax.grid(visible=False, axis="x")
    return ax


def plot_sobol_indices(
    found: Uncertainty, quantity: str | int = 0, *, ax: Axes | None = None
) -> Axes:
    """Draw Sobol's indices of a quantity with their 95 % intervals, the largest parameter on top.

    found : of ``uncertainty``. quantity : its name, or its number from 0.

    Raises
    ------
    InputError : a quantity without indices.
    """
    k = found.place(quantity)
    own = found.indices[k]
    if own is None:
        raise InputError(
            f"Sobol's indices: found none of {found.summaries[k].name}; expected some (either they "
            "were not asked for, or the parameters do not move it at all)"
        )
    ax = canvas.axes_or_new(ax, 7.0, 1.2 + 0.45 * len(found.parameters))
    places = sorted(range(len(found.parameters)), key=lambda i: own.total[i].value)
    bars = (("first order", own.first, _BAR / 2, canvas.BODY, ""),
            ("total", own.total, -_BAR / 2, canvas.ACCELERATION, "//"))  # fmt: skip
    for name, estimates, shift, colour, hatch in bars:
        values = np.array([estimates[i].value for i in places])
        ends = np.array([[estimates[i].low, estimates[i].high] for i in places]).T
        ax.barh(np.arange(len(places)) + shift, values, _BAR, color=colour, hatch=hatch,
                edgecolor="white", linewidth=0, label=name, xerr=np.abs(ends - values),
                error_kw={"elinewidth": 1.0, "capsize": 2.5, "ecolor": "#333333"})  # fmt: skip
    ax.set_yticks(range(len(places)), [_called(found.parameters[i]) for i in places])
    ax.set_xlabel("share of the variance")
    ax.set_title(found.summaries[k].name, **canvas.TITLE)
    ax.set_xlim(left=min(0.0, *(one.low for one in (*own.first, *own.total))))
    ax.legend(frameon=False, fontsize="small", loc="lower right")
    canvas.tidy(ax)
    ax.grid(visible=False, axis="y")
    return ax


def plot_uncertainty_study(found: Uncertainty) -> Figure:
    """Draw the first six quantities of a study, one below the other, their indices beside them.

    found : of ``uncertainty``.
    """
    shown = min(MOST, len(found.summaries))
    columns = 2 if any(one is not None for one in found.indices[:shown]) else 1
    high = max(3.4, 1.2 + 0.45 * len(found.parameters))
    figure = canvas.new_figure(6.5 * columns, high * shown)
    axes = figure.subplots(shown, columns, squeeze=False)
    for k in range(shown):
        plot_uncertainty(found, k, ax=axes[k, 0])
        if columns == 2 and found.indices[k] is None:
            axes[k, 1].set_axis_off()
        elif columns == 2:
            plot_sobol_indices(found, k, ax=axes[k, 1])
    left = len(found.summaries) - shown
    figure.suptitle(found.title + (f" ({left} more quantities not shown)" if left else ""))
    return figure


def _draw_classes(ax: Axes, one: Summary) -> None:
    """The limits of the first scale that rates the quantity, and the share of each class."""
    scale = next((s for s in SCALES if s.name in one.classes), None)
    if scale is None:
        return
    low, high = ax.get_xlim()
    for entry in scale.classes:
        left, right = max(entry.low, low), min(entry.high, high)
        share = one.classes[scale.name][entry.label]
        if left >= right:
            continue
        if low < entry.low:
            ax.axvline(entry.low, color=canvas.REST, linewidth=0.8, zorder=0)
        if right - left > 0.12 * (high - low):
            ax.annotate(f"{entry.label}\n{100 * share.value:.2f} %", ((left + right) / 2, 1.01),
                        xycoords=("data", "axes fraction"), ha="center", va="bottom",
                        fontsize="small", color=canvas.TRACK)  # fmt: skip
    ax.set_xlim(low, high)


def _called(parameter: Uncertain) -> str:
    """A parameter's name; what only a symbol names, by its meaning too."""
    if parameter.name != parameter.symbol or not parameter.meaning:
        return parameter.name
    return f"{parameter.meaning} {parameter.symbol}"
