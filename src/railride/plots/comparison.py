"""Pictures of car bodies side by side: how their values converge."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from railride.plots import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.comparison import ComparedBody, Comparison

FAMILIES = {
    "segments": ("segments", "o-", canvas.BODY),
    "beam": ("beam", "s--", canvas.BOGIE),
    "fe": ("finite elements", "^:", canvas.TRACK),
    "rigid": ("rigid", "D", canvas.REST),
}
LEAST = 1e-9  # relative error: what is smaller is not drawn


def plot_convergence(found: Comparison, position: float = 0.0, *, ax: Axes | None = None) -> Axes:
    """Draw the error of the weighted r.m.s. at a point over the vehicle's degrees of freedom.

    The largest of all speeds, relative to the converged beam, on logarithmic axes; a line for each
    kind of body.

    found : of ``compare_bodies``. position : one of its points, m forward of the middle.
    """
    ax = canvas.axes_or_new(ax, 6.0, 4.0)
    j = int(np.argmin(np.abs(np.array(found.positions) - position)))
    _draw(ax, found, lambda one: float(np.abs(one.error[:, j]).max()))
    ax.set_ylabel("error of a_wrms")
    ax.set_title(_place(found.positions[j]), **canvas.TITLE)
    return ax


def plot_bending_convergence(found: Comparison, *, ax: Axes | None = None) -> Axes:
    """Draw the error of the free body's first bending frequencies over the degrees of freedom.

    The largest of the first three, of bodies that have them, relative to the converged beam. What
    has them to 1e-9, as other beams do, is not drawn.

    found : of ``compare_bodies``.
    """
    ax = canvas.axes_or_new(ax, 6.0, 4.0)

    exact = found.reference.free_hz

    def error(one: ComparedBody) -> float:
        """Of a body that has as many frequencies."""
        known = one.free_hz.size == exact.size
        return float(np.abs(one.free_hz / exact - 1).max()) if known else np.nan

    _draw(ax, found, error)
    ax.set_ylabel("error of the bending frequencies")
    ax.set_title("largest of the first three, free body", **canvas.TITLE)
    return ax


def plot_comparison(found: Comparison) -> Figure:
    """Draw the convergence at the middle, over a bogie and at an end, and of the frequencies.

    found : of ``compare_bodies``.
    """
    places = sorted({abs(x): x for x in reversed(found.positions)}.items())[:3]
    figure = canvas.new_figure(11.0, 8.0)
    axes = figure.subplots(2, 2, sharex=True).ravel()
    for ax, (_, x) in zip(axes, places, strict=False):
        plot_convergence(found, x, ax=ax)
    for ax in axes[len(places) : 3]:
        ax.set_axis_off()
    plot_bending_convergence(found, ax=axes[3])
    speeds = ", ".join(f"{3.6 * v:g}" for v in found.speeds)
    figure.suptitle(f"{found.vehicle} over {found.track} at {speeds} km/h, {found.floor} floor: "
                    f"errors against {found.reference.title}")  # fmt: skip
    return figure


def _draw(ax: Axes, found: Comparison, error: Callable[[ComparedBody], float]) -> None:
    """A line per kind of body over the degrees of freedom."""
    for kind, (name, style, colour) in FAMILIES.items():
        pairs = sorted((one.dof, error(one)) for one in found.bodies if one.body == kind)
        pairs = [(dof, value) for dof, value in pairs if value > LEAST]  # NaN neither
        if pairs:
            ax.plot(*zip(*pairs, strict=True), style, color=colour, label=name, markersize=5)
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.xaxis.set_major_formatter("{x:g}")
    ax.xaxis.set_minor_formatter("{x:g}")
    ax.yaxis.set_major_formatter(lambda value, _: f"{100 * value:.10g} %")
    ax.yaxis.set_minor_formatter("")
    ax.set_xlabel("degrees of freedom of the vehicle")
    if ax.lines:
        ax.legend(frameon=False, fontsize="small")
    canvas.tidy(ax)


def _place(x: float) -> str:
    return (
        "at the middle"
        if x == 0
        else f"{abs(x):g} m {'ahead of' if x > 0 else 'behind'} the middle"
    )
