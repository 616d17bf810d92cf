"""Pictures of an optimum: comfort before and after, the limits, the parameters; and the front."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railride.plots import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.optimisation import LimitState, Optimum, ParetoFront

BEFORE, AFTER, BOUND = canvas.REST, canvas.BODY, canvas.WEIGHTED
THICK = 0.36  # of a bar, where every row has two


def plot_optimum(found: Optimum) -> Figure:
    """Draw an optimum: comfort by case, what of the limits is used, where the parameters went.

    found : of ``optimise``. A front that it has goes below.
    """
    sizes = [len(found.cases_changed), len(found.limits), len(found.changes)]
    panels = [(plot_optimum_comfort, sizes[0]), (plot_optimum_limits, sizes[1]),
              (plot_optimum_parameters, sizes[2])]  # fmt: skip
    panels = [(draw, size) for draw, size in panels if size]
    heights = [1.1 + 0.5 * size for _, size in panels]
    if found.front is not None:
        heights.append(4.0)
    figure = canvas.new_figure(7.5, sum(heights))
    axes = figure.subplots(len(heights), 1, gridspec_kw={"height_ratios": heights}, squeeze=False)
    for (draw, _), ax in zip(panels, axes[:, 0], strict=False):
        draw(found, ax=ax)
    if found.front is not None:
        plot_pareto(found.front, ax=axes[-1, 0])
    return figure


def plot_optimum_comfort(found: Optimum, *, ax: Axes | None = None) -> Axes:
    """Draw a_wrms of every case before and after, as bars.

    found : of ``optimise``.
    """
    ax = canvas.axes_or_new(ax, 7.5, 1.1 + 0.5 * len(found.cases_changed))
    cases = found.cases_changed
    names = [f"{c.track}, {3.6 * c.speed:.6g} km/h, {c.position:.6g} m" for c in cases]
    _pairs(ax, names, [c.before for c in cases], [c.after for c in cases])
    ax.set_xlabel("a_wrms [m/s²]")
    ax.set_title("comfort", **canvas.TITLE)
    return ax


def plot_optimum_limits(found: Optimum, *, ax: Axes | None = None) -> Axes:
    """Draw how much of every limit is used before and after; what binds is in bold.

    Of limits that are at most, the value over the bound; of those at least, the bound over the
    value: beyond 100 % a limit is not kept.

    found : of ``optimise``.
    """
    ax = canvas.axes_or_new(ax, 7.5, 1.1 + 0.5 * len(found.limits))
    names = [_limit_name(state) for state in found.limits]
    before = [None if state.before is None else _used(state, state.before)
              for state in found.limits]  # fmt: skip
    _pairs(ax, names, before, [_used(state, state.value) for state in found.limits])
    ax.axvline(100.0, color=BOUND, linewidth=1.2)
    for label, state in zip(ax.get_yticklabels(), found.limits, strict=True):
        label.set_fontweight("bold" if state.binds else "normal")
    ax.set_xlabel("of the limit used [%]")
    ax.set_title("limits, those that bind in bold", **canvas.TITLE)
    return ax


def plot_optimum_parameters(found: Optimum, *, ax: Axes | None = None) -> Axes:
    """Draw where every parameter went within its range, from the lower to the upper bound.

    Those whose bounds are above 0 by equal ratios, as the method sees them.

    found : of ``optimise``.
    """
    ax = canvas.axes_or_new(ax, 7.5, 1.1 + 0.5 * len(found.changes))
    for row, change in enumerate(found.changes):
        start = change.variable.place(change.variable.own)
        ax.plot([0, 1], [row, row], color="#E6E6E6", linewidth=6, solid_capstyle="round", zorder=1)
        ax.plot([start, change.place], [row, row], color=AFTER, linewidth=1.5, zorder=2)
        ax.plot(start, row, "o", color=BEFORE, markeredgecolor="k", zorder=3,
                label="before" if row == 0 else None)  # fmt: skip
        ax.plot(change.place, row, "D", color=AFTER, zorder=4, clip_on=False,
                label="after" if row == 0 else None)  # fmt: skip
        unit = change.variable.unit
        ax.annotate(
            f"{change.variable.own:.6g} → {change.value:.6g} {unit}".rstrip(),
            (0.5, row),
            (0, 8),
            textcoords="offset points",
            ha="center",
            fontsize="small",
        )
    ax.set_yticks(range(len(found.changes)), [c.variable.name for c in found.changes])
    ax.set_ylim(len(found.changes) - 0.5, -0.7)
    ax.set_xlim(-0.03, 1.03)
    ax.set_xticks([0, 1], ["lower bound", "upper bound"])
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small", frameon=False)
    ax.spines[["top", "right", "left"]].set_visible(False)
    ax.tick_params(left=False)
    ax.set_title("parameters within their ranges", **canvas.TITLE)
    return ax


def plot_pareto(front: ParetoFront, *, ax: Axes | None = None) -> Axes:
    """Draw a_wrms over travel: the front, and the vehicle as it is beside it.

    front : of ``pareto_front``, or ``Optimum.front``.
    """
    ax = canvas.axes_or_new(ax, 6.0, 4.0)
    times, unit = _scale(front.against)
    ax.plot(
        times * front.travel, front.a_wrms, "o-", color=AFTER, markersize=5, label="best designs"
    )
    if front.own is not None:
        ax.plot(times * front.own[0], front.own[1], "s", color=BEFORE, markeredgecolor="k",
                label="vehicle as it is")  # fmt: skip
    ax.set_xlabel(f"{front.against.replace('_', ' ').replace(' rms', ', r.m.s.')} [{unit}]")
    ax.set_ylabel("a_wrms [m/s²]")
    ax.set_title("comfort against travel", **canvas.TITLE)
    canvas.tidy(ax)
    ax.legend(frameon=False)
    return ax


def _pairs(
    ax: Axes, names: list[str], before: list[float | None], after: list[float | None] | list[float]
) -> None:
    """Two bars for every name, from the top; the value beside each."""
    rows = np.arange(len(names))
    for values, offset, color, label in (
        (before, -THICK / 2, BEFORE, "before"),
        (after, THICK / 2, AFTER, "after"),
    ):
        known = [np.nan if value is None else float(value) for value in values]
        bars = ax.barh(rows + offset, known, THICK, color=color, label=label)
        texts = ["" if np.isnan(value) else f"{value:.3g}" for value in known]
        ax.bar_label(bars, texts, padding=3, fontsize="small",
                     bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5})  # fmt: skip
    ax.set_yticks(rows, names)
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.margins(x=0.12)
    canvas.tidy(ax)
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize="small", frameon=False)


def _used(state: LimitState, value: float) -> float:
    """Share of a limit, %."""
    bound = state.limit.bound
    if state.limit.at_least:
        return 100 * bound / value if value > 0 else np.nan
    return 100 * value / bound


def _limit_name(state: LimitState) -> str:
    """A limit's name and bound: "secondary travel ≤ 30 mm"."""
    sign = "≥" if state.limit.at_least else "≤"
    times, unit = _scale(state.limit.kind)
    name = state.limit.name.replace("_", " ").replace(" rms", ", r.m.s.")
    return f"{name} {sign} {times * state.limit.bound:.4g} {unit}".rstrip()


def _scale(kind: str) -> tuple[float, str]:
    """Factor and unit in which values of a kind are read: mm for travel, else %."""
    from railride.optimisation import KINDS

    return (1e3, "mm") if KINDS[kind].unit == "m" else (100.0, "%")
