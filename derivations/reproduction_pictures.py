"""The pictures of the reproduction: Figures 7 to 11 in the paper's layout, and what lies behind.

Nothing is computed here; colours and axes are those of :mod:`railride.plots`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from paper import OUTPUT_STEP, SPEEDS_KMH, TABLE_4
from reproduction_cases import Simulated, printed, printed_gap
from reproduction_errors import RATES
from reproduction_gap import DAMPING, Difference

from railride import Track, plot_track
from railride.numeric import Array
from railride.plots import canvas

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = {"DYMOLA": canvas.BODY, "VAMPIRE": canvas.BOGIE}
KINDS = {
    "body": ("o", canvas.BODY, "body and floor"),
    "damping": ("s", canvas.EQUIPMENT, "structural damping"),
    "vehicle": ("^", canvas.LINES[3], "reading of Table 1"),
    "numerics": ("D", "#000000", "numerics"),
}
ZOOM = 1.0  # s
LABEL = 3.5  # percentage points: closer points share a label


def figure_7(track: Track) -> Figure:
    """The track, as Figure 7."""
    figure = canvas.new_figure(11.0, 2.8)
    plot_track(track, ax=figure.add_subplot())
    return figure


def figure_of(pair: Sequence[Simulated]) -> Figure:
    """Both programs at one speed with one body, as Figures 8 to 11: all of it, and 1 s.

    The second is the one about DYMOLA's largest acceleration.
    """
    first = pair[0]
    figure = canvas.new_figure(11.0, 3.3)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(2, 1))
    peak = first.time[np.argmax(np.abs(first.acceleration))]
    start = float(np.clip(peak - ZOOM / 2, 0.0, first.time[-1] - ZOOM))
    for one, width in zip(pair, (1.8, 0.7), strict=True):
        of = "halves" if one.case.flexible and one.case.program == "DYMOLA" else "beam"
        label = f"as {one.case.program}: {of if one.case.flexible else 'rigid'}, "
        label += "BDF 1e-4" if one.case.program == "DYMOLA" else "Euler-Cromer 1 ms"
        for ax, dots in ((left, False), (right, True)):
            _line(ax, one, (1.2 if dots else 1.0) * width, label, dots=dots)
    left.set_xlim(0.0, first.time[-1])
    right.set_xlim(start, start + ZOOM)
    left.axvspan(start, start + ZOOM, color=canvas.REST, alpha=0.35, linewidth=0, zorder=0)
    largest = max(np.abs(one.acceleration).max() for one in pair)
    left.set_ylim(-1.1 * largest, 1.45 * largest)
    left.set_ylabel("acceleration [m/s²]")
    left.set_title(f"{first.case.body} body at {first.case.speed_kmh:g} km/h, middle of the floor",
                   **canvas.TITLE)  # fmt: skip
    right.set_title("1 s of it; dots: stored every 0.02 s", **canvas.TITLE)
    left.legend(loc="upper right", ncols=2, framealpha=0.9, edgecolor="none")
    for ax in (left, right):
        ax.set_xlabel("time [s]")
        canvas.tidy(ax)
    return figure


def _line(ax: Axes, one: Simulated, width: float, label: str, *, dots: bool) -> None:
    """One acceleration, with the samples that were stored."""
    colour = COLOURS[one.case.program]
    ax.plot(one.time, one.acceleration, color=colour, linewidth=width, label=label)
    if dots:
        step = round(OUTPUT_STEP / (one.time[1] - one.time[0]))
        ax.plot(
            one.time[::step],
            one.acceleration[::step],
            "o",
            color=colour,
            markersize=2 + 1.5 * width,
        )


def seeds_figure(runs: Mapping[tuple[str, float], Array], exact: Mapping[str, Array]) -> Figure:
    """How a_wrms falls over the kilometres: halves and beam, one speed each side.

    runs : (body, km/h) → a_wrms of every kilometre. exact : body → both exact values.
    """
    figure = canvas.new_figure(11.0, 3.8)
    axes = figure.subplots(1, 2, sharey=True)
    for k, (ax, speed) in enumerate(zip(axes, SPEEDS_KMH, strict=True)):
        for program, body in (("DYMOLA", "halves"), ("VAMPIRE", "beam")):
            colour, values = COLOURS[program], runs[body, speed]
            ax.hist(values, bins=np.arange(0.08, 0.50, 0.01), color=colour, alpha=0.35,
                    label=f"{body}, each of {values.size} km")  # fmt: skip
            ax.axvline(exact[body][k], color=colour, linewidth=1.6, label=f"{body}, exact")
            ax.axvline(printed(program)[k], color=colour, linewidth=1.6, linestyle=":",
                       label=f"{program}, printed")  # fmt: skip
        ax.set_title(f"{speed:g} km/h", **canvas.TITLE)
        ax.set_xlabel("a_wrms of one kilometre [m/s²]")
        ax.set_xlim(0.08, 0.50)
        canvas.tidy(ax)
    axes[0].set_ylabel("kilometres")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=6,
                  frameon=False, fontsize="small")  # fmt: skip
    return figure


def segments_figure(study: Mapping[str, Mapping[int, Array]], limit: Array) -> Figure:
    """a_wrms over the number of segments, relative to the beam, at both speeds.

    study : floor → segments → a_wrms at both speeds. limit : the beam's.
    """
    figure = canvas.new_figure(8.0, 4.2)
    ax = figure.add_subplot()
    for floor, marks in (("polygon", ("o-", "o--")), ("smooth", ("s-", "s--"))):
        numbers = list(study[floor])
        colour = canvas.BODY if floor == "polygon" else canvas.EQUIPMENT
        for k, (speed, mark) in enumerate(zip(SPEEDS_KMH, marks, strict=True)):
            ratio = np.array([study[floor][n][k] for n in numbers]) / limit[k]
            ax.plot(numbers, ratio, mark, color=colour, linewidth=1.2, markersize=4.5,
                    markerfacecolor="white" if k else colour,
                    label=f"{floor} floor, {speed:g} km/h")  # fmt: skip
    ax.axhline(1.0, color=canvas.TRACK, linewidth=0.8)
    for row, gap in zip(TABLE_4, printed_gap(), strict=True):
        ax.axhline(1 + gap, color=canvas.BOGIE, linewidth=1.0, linestyle=":")
        ax.annotate(f"DYMOLA/VAMPIRE as printed, {row.speed_kmh:g} km/h", (32, 1 + gap),
                    xytext=(0, 3), textcoords="offset points", ha="right", fontsize="small",
                    color=canvas.BOGIE)  # fmt: skip
    ax.set_xscale("log", base=2)
    ax.set_xticks(numbers, [str(n) for n in numbers])
    ax.set_xlabel("segments N")
    ax.set_ylabel("a_wrms relative to the beam")
    ax.legend(loc="upper right", bbox_to_anchor=(1.0, 0.97), frameon=False)
    canvas.tidy(ax)
    return figure


def damping_figure(study: Mapping[str, Array]) -> Figure:
    """a_wrms over the structural damping ratio, halves and beam, at both speeds.

    study : body → a_wrms (ratios, speeds).
    """
    figure = canvas.new_figure(8.0, 4.2)
    ax = figure.add_subplot()
    percent = 100 * np.array(DAMPING)
    for program, body in (("DYMOLA", "halves"), ("VAMPIRE", "beam")):
        for k, (speed, style) in enumerate(zip(SPEEDS_KMH, ("-", "--"), strict=True)):
            ax.plot(percent, study[body][:, k], style, marker="o", markersize=3.5,
                    color=COLOURS[program], label=f"{body}, {speed:g} km/h")  # fmt: skip
    ax.set_xlim(0.0, percent[-1])
    ax.set_ylim(0.0)
    ax.set_xlabel("structural damping ratio of the first bending mode [%]")
    ax.set_ylabel("weighted r.m.s. acceleration [m/s²]")
    ax.set_title("middle of the floor, ERRI low, exact", **canvas.TITLE)
    ax.legend(loc="upper right", frameon=False)
    canvas.tidy(ax)
    return figure


def gap_figure(
    alone: Sequence[Difference], grid: Mapping[tuple[float, float], Array], scatter: Array
) -> Figure:
    """Gaps at 145 and 200 km/h: of each difference alone; of halves and beam, each damped.

    grid : (damping of the halves, of the beam) → gap. scatter (kilometres, 2) : gaps of damped
    halves against the beam, kilometre by kilometre.
    """
    figure = canvas.new_figure(11.0, 5.2)
    left, right = figure.subplots(1, 2)
    _draw_alone(left, alone)
    _draw_damped(right, grid, scatter)
    for ax in (left, right):
        ax.plot(*(100 * printed_gap()), "*", color=canvas.WEIGHTED, markersize=15, zorder=5,
                markeredgecolor="white", label="as printed in Table 4")  # fmt: skip
        ax.axhline(0.0, color=canvas.TRACK, linewidth=0.8, zorder=1)
        ax.axvline(0.0, color=canvas.TRACK, linewidth=0.8, zorder=1)
        ax.set_xlabel("DYMOLA over VAMPIRE at 145 km/h [%]")
        ax.set_ylabel("at 200 km/h [%]")
        ax.legend(loc="upper left", framealpha=0.9, edgecolor="none", fontsize="small")
        canvas.tidy(ax)
    return figure


def _draw_alone(ax: Axes, alone: Sequence[Difference]) -> None:
    """A point for each difference, numbered as in the table; close ones share a label."""
    for kind, (mark, colour, label) in KINDS.items():
        points = 100 * np.array([one.gap for one in alone if one.kind == kind])
        ax.plot(*points.T, mark, color=colour, markersize=6, label=label)
    left = {number: 100 * one.gap for number, one in enumerate(alone, start=1)}
    while left:
        first = next(iter(left.values()))
        close = [n for n, gap in left.items() if np.abs(gap - first).max() < LABEL]
        place = (max(left[n][0] for n in close), first[1])
        ax.annotate(", ".join(map(str, close)), place, xytext=(6, 4), textcoords="offset points",
                    fontsize="small")  # fmt: skip
        left = {n: gap for n, gap in left.items() if n not in close}
    ax.set_title("one difference alone (numbers as in the table)", **canvas.TITLE)


def _draw_damped(ax: Axes, grid: Mapping[tuple[float, float], Array], scatter: Array) -> None:
    """Halves damped over a beam that is not, the reverse, both; and how one kilometre scatters."""
    ax.plot(*(100 * scatter.T), ".", color=canvas.REST, markersize=2.5, zorder=1,
            label="halves 0.5 %, beam 0 %: every kilometre")  # fmt: skip
    lines = {
        "halves damped by 0 to 2 %, beam not": (canvas.BODY, [(zeta, 0.0) for zeta in DAMPING]),
        "beam damped by 0 to 2 %, halves not": (canvas.BOGIE, [(0.0, zeta) for zeta in DAMPING]),
        "both alike": (canvas.EQUIPMENT, [(zeta, zeta) for zeta in DAMPING]),
    }
    for label, (colour, pairs) in lines.items():
        points = 100 * np.array([grid[pair] for pair in pairs])
        ax.plot(*points.T, "o-", color=colour, linewidth=1.2, markersize=3.5, label=label)
        for pair, point in list(zip(pairs, points, strict=True))[::2]:
            if label != "both alike" and max(pair) > 0:
                ax.annotate(f"{100 * max(pair):g} %", point, xytext=(5, -9),
                            textcoords="offset points", fontsize="small", color=colour,
                            annotation_clip=True)  # fmt: skip
    ax.set_xlim(-30.0, 80.0)
    ax.set_ylim(-25.0, 75.0)
    ax.set_title("two halves against a beam, with structural damping", **canvas.TITLE)


def integrators_figure(errors: Mapping[str, Mapping[str, Sequence[float]]]) -> Figure:
    """Errors over the step: sample by sample on the left, of a_wrms on the right.

    errors : "deviation" and "a_wrms" → integrator → relative errors, of the steps of the sweep.
    """
    figure = canvas.new_figure(11.0, 4.2)
    axes = figure.subplots(1, 2)
    titles = {"deviation": "sample by sample (r.m.s. of the difference)", "a_wrms": "of a_wrms"}
    for ax, (what, title) in zip(axes, titles.items(), strict=True):
        for k, (name, values) in enumerate(errors[what].items()):
            ax.plot(1000 / np.array(RATES), np.abs(values), marker="o", markersize=4,
                    label=name, **canvas.line_look(k))  # fmt: skip
        ax.set_xscale("log")
        ax.set_yscale("log")
        ax.set_xticks(1000 / np.array(RATES), [f"{1000 / rate:g}" for rate in RATES])
        ax.xaxis.set_minor_formatter("")
        ax.yaxis.set_major_formatter(lambda value, _: f"{100 * value:g} %")
        ax.axhline(1e-3, color=canvas.TRACK, linewidth=0.8, linestyle=":")
        ax.set_xlabel("step [ms]")
        ax.set_title(title, **canvas.TITLE)
        canvas.tidy(ax)
    axes[0].set_ylabel("error, relative to the exact response")
    axes[0].legend(loc="lower right", frameon=False, fontsize="small")
    return figure
