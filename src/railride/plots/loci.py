"""Pictures of modes over a parameter: root loci in the s-plane, and damping ratios."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.plots import canvas

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# One look for one label, told apart in grey print too. Source: as in railride.plots.canvas.
_LOOKS = {
    "heave": ("#0072B2", "-"),
    "pitch": ("#56B4E9", "--"),
    "bogie heave": ("#D55E00", "-"),
    "bogie pitch": ("#E69F00", "--"),
    "damper": ("#4D4D4D", ":"),
}
_BENDING = ("#009E73", "#CC79A7", "#000000")
_BENDING_STYLES = ("-", "--", "-.", ":")
_RATIOS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7)  # lines of constant damping
_KILO = 1e4  # of newtons: from here on kilonewtons read better


def plot_root_locus(locus: pd.DataFrame, *, ax: Axes | None = None) -> Axes:
    """Draw the eigenvalues' ways in the s-plane, in Hz, from × at the first value to ● at the last.

    The colour says what moves; a way whose label changes changes its colour. Thin rays are of
    constant damping ratio. The picture shows where modes oscillate; real eigenvalues farther to
    the left are outside it.

    locus : of :func:`railride.loci.mode_locus`.

    Raises InputError for a table without its columns.
    """
    name = _parameter(locus)
    ax = canvas.axes_or_new(ax, 7.5, 6.0)
    for label, rows in _runs(locus, name):
        ax.plot(rows["real"] / (2 * np.pi), rows["imag"] / (2 * np.pi), **_look(label),
                label=_once(ax, label))  # fmt: skip
    _limits(ax, locus)
    factor, unit = _shown(locus, name)
    for value, mark in ((locus[name].min(), "x"), (locus[name].max(), "o")):
        end = locus[locus[name] == value]
        x, y = end["real"] / (2 * np.pi), end["imag"] / (2 * np.pi)
        inside = x >= ax.get_xlim()[0]
        ax.plot(x[inside], y[inside], linestyle="none", marker=mark, markersize=5, clip_on=False,
                color=canvas.TRACK, markerfacecolor="none", zorder=3,
                label=f"{name} = {value / factor:g} {unit}".rstrip())  # fmt: skip
    _rays(ax)
    ax.set_xlabel("Re λ/2π [Hz]")
    ax.set_ylabel("Im λ/2π [Hz]")
    canvas.tidy(ax)
    ax.spines[["right"]].set_visible(True)  # the imaginary axis: beyond it is no stable vehicle
    ax.legend(loc="best", fontsize="small")
    return ax


def plot_damping(locus: pd.DataFrame, *, ax: Axes | None = None) -> Axes:
    """Draw the modes' damping ratios over the parameter, one colour for each label.

    The parameter has a logarithmic scale where its values are spaced so.

    locus : of :func:`railride.loci.mode_locus`.

    Raises InputError for a table without its columns.
    """
    name = _parameter(locus)
    ax = canvas.axes_or_new(ax, 7.5, 5.0)
    factor, unit = _shown(locus, name)
    for label, rows in _runs(locus, name):
        ax.plot(rows[name] / factor, rows["damping_ratio"], **_look(label), label=_once(ax, label))
    values = np.unique(locus[name])
    if values[0] > 0 and values.size > 2:
        ratios, steps = np.diff(np.log(values)), np.diff(values)
        if np.ptp(ratios) / ratios.mean() < np.ptp(steps) / steps.mean():
            ax.set_xscale("log")
    ax.set_xlim(values[0] / factor, values[-1] / factor)
    ax.set_ylim(0, 1.1 * float(locus["damping_ratio"].max()) or 1.0)
    meaning = locus.attrs.get("meaning", "")
    ax.set_xlabel(", ".join(filter(None, (meaning, name))) + (f" [{unit}]" if unit else ""))
    ax.set_ylabel("damping ratio")
    canvas.tidy(ax)
    ax.legend(loc="best", fontsize="small")
    return ax


def plot_loci(locus: pd.DataFrame) -> Figure:
    """Draw the root locus and the damping ratios beside each other, with one legend."""
    figure = canvas.new_figure(12.0, 5.6)
    left, right = figure.subplots(1, 2)
    plot_root_locus(locus, ax=left)
    plot_damping(locus, ax=right)
    for ax in (left, right):
        ax.get_legend().remove()
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(6, len(labels)),
                  frameon=False, fontsize="small")  # fmt: skip
    return figure


def _parameter(locus: pd.DataFrame) -> str:
    """The name of the parameter, the first column."""
    needed = {"damping_ratio", "real", "imag", "label", "branch"}
    missing = sorted(needed - set(locus.columns))
    if missing or not len(locus):
        found = f"no {', '.join(missing)}" if missing else "no rows"
        raise InputError(f"locus: found {found}; expected a table of mode_locus")
    return str(locus.attrs.get("parameter", locus.columns[0]))


def _runs(locus: pd.DataFrame, name: str) -> list[tuple[str, pd.DataFrame]]:
    """Pieces of one branch and one label, each up to the next piece's first point."""
    pieces = []
    values = np.unique(locus[name])
    for _, rows in locus.groupby("branch", sort=True):
        rows = rows.sort_values(name)  # noqa: PLW2901
        place = np.searchsorted(values, rows[name])
        label = rows["label"].to_numpy()
        gap = np.diff(place) > 1  # reals that met, were a pair and parted again
        starts = [0, *(np.flatnonzero(gap | (label[1:] != label[:-1])) + 1), len(rows)]
        for start, stop in itertools.pairwise(starts):
            joined = stop < len(rows) and not gap[stop - 1]
            pieces.append((str(label[start]), rows.iloc[start : stop + joined]))
    return pieces


def _look(label: str) -> dict[str, Any]:
    """Colour and line of a label."""
    colour, style = _LOOKS.get(label, ("", ""))
    if not colour:
        number = int(label.removeprefix("bending ")) - 1  # no other label is left
        colour = _BENDING[number % len(_BENDING)]
        style = _BENDING_STYLES[number // len(_BENDING) % len(_BENDING_STYLES)]
    return {"color": colour, "linestyle": style, "linewidth": 1.5}


def _once(ax: Axes, label: str) -> str | None:
    """The label where it is not in the legend yet."""
    return None if label in ax.get_legend_handles_labels()[1] else label


def _shown(locus: pd.DataFrame, name: str) -> tuple[float, str]:
    """What a number of the parameter is divided by for the reader, and the unit then."""
    unit = str(locus.attrs.get("unit", ""))
    if unit.startswith("N") and locus[name].abs().max() >= _KILO:
        return 1e3, f"k{unit}"
    return 1.0, unit


def _limits(ax: Axes, locus: pd.DataFrame) -> None:
    """Where modes oscillate; all of it where none does."""
    pairs = locus[locus["imag"] > 0]
    shown = pairs if len(pairs) else locus
    left = float(shown["real"].min()) / (2 * np.pi)
    top = float(shown["imag"].max()) / (2 * np.pi)
    ax.set_xlim(1.1 * left if left else -1.0, 0.0)
    ax.set_ylim(0.0, 1.08 * top if top else 1.0)


def _rays(ax: Axes) -> None:
    """Thin lines of constant damping ratio from the origin, with their ratio."""
    left, top = ax.get_xlim()[0], ax.get_ylim()[1]
    for ratio in _RATIOS:
        slope = np.sqrt(1 - ratio**2) / ratio
        x = max(left, -top / slope)
        if -slope * x < 0.06 * top:  # too flat to be told from the axis
            continue
        ax.plot([0, x], [0, -slope * x], color="#CCCCCC", linewidth=0.7, zorder=0)
        aligned = ("center", 0) if x > left else ("left", 3)
        ax.annotate(f"ζ = {ratio:g}", (x, -slope * x), fontsize="x-small", color="#808080",
                    annotation_clip=False, xytext=(aligned[1], 2), textcoords="offset points",
                    ha=aligned[0], va="bottom")  # fmt: skip
