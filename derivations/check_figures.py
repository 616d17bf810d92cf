"""The figures of the paper check, drawn from the values that its claims compute."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from check_integration import sampled_gain
from check_results import MAP_KMH, over_speed
from check_values import beam
from paper import OUTPUT_STEP, SPEEDS_KMH, TABLE_1, TABLE_4, TRACK, coach

from railride import KMH, ride, stochastic_ride, weighting
from railride.plots import canvas
from railride.scales import EN_12299_CONTINUOUS, ISO_2631_1_ANNEX_C, PAPER_TABLE_3

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLUE, RED, GREEN, _, BLACK, *_ = canvas.LINES


def save_all(folder: Path) -> None:
    """Draw every figure into a folder."""
    folder.mkdir(exist_ok=True)
    for name, draw in FIGURES.items():
        canvas.save(draw(), folder / f"{name}.png")


def two_halves() -> Figure:
    """Eq (1)'s body and the free one, bent by the same angle."""
    figure = canvas.new_figure(7.5, 3.4)
    top, bottom = figure.subplots(2, 1, sharex=True, sharey=True)
    L, angle = TABLE_1["L"].value / 2, 0.09
    x = L * np.array([-1, 0, 1])
    held = L * angle * np.array([0, 1, 0])
    for ax, z, title in (
        (top, held, "as Eq (1) holds it: ends at height zero, 4.79 Hz"),
        (bottom, held - held.mean() * 1.5, "free in space: mass centre at rest, 9.59 Hz"),
    ):
        ax.plot(x, [0, 0, 0], color=canvas.REST, linewidth=5, solid_capstyle="round")
        ax.plot(x, z, color=BLUE, linewidth=5, solid_capstyle="round")
        ax.plot(0, z[1], "o", color="white", markeredgecolor=BLACK, markersize=9)
        centre = (z[0] + z[1]) / 2
        ax.plot(0, centre, "x", color=RED, markersize=9, markeredgewidth=2)
        ax.annotate("mass centre", (0, centre), (0.6, centre - 0.12), color=RED, va="center")
        ax.set_title(title, **canvas.TITLE)
        ax.set_yticks([])
        ax.spines[["left", "right", "top"]].set_visible(False)
    top.plot(x[[0, 2]], [-0.17, -0.17], "^", color=BLACK, markersize=9)
    top.set_ylim(-0.95, 1.35)
    bottom.set_xlabel("along the car body [m] (heights not to scale)")
    return figure


def weighting_sampled() -> Figure:
    """|W_k| with and without band limits, and of filters that run on samples of 0.02 s."""
    figure = canvas.new_figure(9.0, 3.6)
    left, right = figure.subplots(1, 2)
    full, printed = weighting("Wk"), weighting("Wk_paper")
    f = np.geomspace(0.05, 400, 600)
    left.loglog(f, np.abs(printed.response(f)), "--", color=RED, label="Eq (6), no band limits")
    left.loglog(f, np.abs(full.response(f)), color=BLUE, label="W$_k$ of ISO 2631-1")
    left.axvspan(4, 10, color=canvas.REST, alpha=0.35, linewidth=0, label="4–10 Hz")
    left.set_ylim(1e-2, 2)
    left.set_title("with and without band limits", **canvas.TITLE)
    f = np.linspace(0.5, 24.9, 500)
    right.plot(f, np.abs(full.response(f)), color=BLUE, label="W$_k$")
    right.plot(f, sampled_gain("bilinear", f), "--", color=RED, label="bilinear filter")
    right.plot(f, sampled_gain("first-order hold", f), "-.", color=GREEN, label="first-order hold")
    bending = TABLE_1["f_bending"].value
    right.axvline(bending, color=BLACK, linewidth=0.8, linestyle=":")
    right.annotate(f"bending, {bending:g} Hz", (bending, 0.05), (bending + 0.4, 0.05))
    right.set_ylim(0, 1.15)
    right.set_title("run on samples of 0.02 s", **canvas.TITLE)
    for ax in (left, right):
        ax.set_xlabel("frequency [Hz]")
        ax.set_ylabel("|W|")
        ax.legend(frameon=False, fontsize="small", loc="lower center" if ax is left else "best")
        canvas.tidy(ax)
    return figure


def sampling() -> Figure:
    """One second of the flexible vehicle's acceleration at 145 km/h, exact and stored."""
    figure = canvas.new_figure(8.0, 3.2)
    ax = figure.add_subplot()
    speed = SPEEDS_KMH[0] * KMH
    record = ride(coach(), TRACK, [speed], seed=1, floor="polygon").cases[0].record
    fine, every = record.time, round(OUTPUT_STEP * 1000)
    begin = int(np.argmin(np.abs(fine))) + 5000
    inside = slice(begin, begin + 1001)
    stored = slice(begin, begin + 1001, every)
    ax.plot(fine[inside], record.acceleration[inside], color=BLUE, label="every 0.001 s")
    ax.plot(fine[stored], record.acceleration[stored], "o--", color=RED, markersize=4,
            linewidth=1, label="every 0.02 s, as stored")  # fmt: skip
    ax.set_xlim(fine[inside][0], fine[inside][-1])
    ax.set_xlabel("time [s]")
    ax.set_ylabel("floor acceleration [m/s²]")
    ax.set_title("flexible vehicle, 145 km/h, ERRI low, seed 1", **canvas.TITLE)
    ax.legend(frameon=False, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    canvas.tidy(ax)
    return figure


def speed() -> Figure:
    """Comfort over speed, and what two halves read over the beam."""
    figure = canvas.new_figure(8.5, 5.2)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    found = over_speed()
    for (name, value), look in zip(found.items(), ("-.", "-", "--"), strict=True):
        colour = {"rigid": GREEN, "two halves": BLUE, "beam": RED}[name]
        top.plot(MAP_KMH, value, look, color=colour, label=name)
    for v in (100.0, 145.0, 170.0, 200.0):
        top.plot(v, found["two halves"][_at(v)], "o", color=BLUE)
        top.annotate(f"{v:g}", (v, found["two halves"][_at(v)]), (0, 8), ha="center",
                     textcoords="offset points", fontsize="small")  # fmt: skip
    top.set_ylim(0, 0.7)
    top.set_ylabel("weighted acceleration [m/s²]")
    top.set_title("middle of the floor, ERRI low", **canvas.TITLE)
    top.legend(frameon=False, loc="upper center")
    bottom.plot(MAP_KMH, 100 * (found["two halves"] / found["beam"] - 1), color=BLUE)
    for row in TABLE_4:
        difference = 100 * (row.dymola / row.vampire - 1)
        bottom.plot(row.speed_kmh, difference, "s", color=BLACK)
    first = 100 * (TABLE_4[0].dymola / TABLE_4[0].vampire - 1)
    bottom.annotate("Table 4, DYMOLA over VAMPIRE", (142, first), ha="right", va="center")
    bottom.set_ylim(0, 50)
    bottom.set_ylabel("two halves\nover beam [%]")
    bottom.set_xlabel("speed [km/h]")
    bottom.set_xlim(MAP_KMH[0], 260)
    for ax in (top, bottom):
        canvas.tidy(ax)
    return figure


def _at(kmh: float) -> int:
    return int(np.argmin(np.abs(np.array(MAP_KMH) - kmh)))


def floor() -> Figure:
    """The hinge above the floor that it stands for, and the weighted acceleration along the car."""
    figure = canvas.new_figure(9.0, 3.6)
    left, right = figure.subplots(1, 2)
    half = TABLE_1["L"].value / 2
    x = np.linspace(-half, half, 241)
    polygon = np.interp(x, [-half, 0, half], [-1, 1, -1])
    lift = 2 / 6  # of the angle between the halves times ℓ/12, the ends at -1 and the hinge at 1
    xi = (np.abs(x) - half / 2) / half
    smooth = polygon - lift * (0.5 - xi) * (6 * xi**2 - 0.5)
    left.plot(x, polygon, color=BLUE, label="two halves")
    left.plot(x, smooth, "--", color=RED, label="smooth floor, same mean on each half")
    left.plot(0, 1, "o", color=BLUE)
    left.annotate("sensor", (0, 1), (1.2, 1.0), va="center")
    left.set_ylim(-1.2, 1.6)
    left.set_yticks([])
    left.set_xlabel("place on the floor [m]")
    left.set_title("what a hinge reads", **canvas.TITLE)
    left.legend(frameon=False, fontsize="small", loc="upper left")
    speed_ms = SPEEDS_KMH[0] * KMH
    places = np.linspace(-half, half, 49).tolist()
    for name, model, reading, look in (
        ("two halves", coach(), "polygon", {"color": BLUE}),
        ("beam", beam(), "smooth", {"color": RED, "linestyle": "--"}),
        ("rigid", coach(False), "polygon", {"color": GREEN, "linestyle": "-."}),
    ):
        along = stochastic_ride(model, speed_ms, TRACK, places, floor=reading).a_wrms
        right.plot(places, along, label=name, **look)
    right.set_ylim(bottom=0)
    right.set_xlabel("place on the floor [m]")
    right.set_ylabel("weighted acceleration [m/s²]")
    right.set_title("along the car, 145 km/h, ERRI low", **canvas.TITLE)
    right.legend(frameon=False, fontsize="small", loc="upper center")
    for ax in (left, right):
        canvas.tidy(ax)
    return figure


def levels() -> Figure:
    """Three scales as bars, and the values of Table 4."""
    figure = canvas.new_figure(9.0, 4.8)
    ax = figure.add_subplot()
    least, most = 0.1, 4.0
    ticks, names = [], []
    row = 0
    for scale in (PAPER_TABLE_3, EN_12299_CONTINUOUS, ISO_2631_1_ANNEX_C):
        ax.annotate(scale.name, (least * 1.02, row), va="center", fontweight="bold",
                    bbox={"color": "white", "pad": 1.5}, zorder=4)  # fmt: skip
        for entry, shade in zip(scale.classes, np.linspace(0.85, 0.45, len(scale.classes)),
                                strict=True):  # fmt: skip
            row += 1
            low, high = max(entry.low, least), min(entry.high, most)
            ax.barh(row, high - low, left=low, color=str(shade), height=0.8)
            ticks.append(row)
            names.append(entry.label)
        row += 2
    for printed in TABLE_4:
        colour = BLUE if printed.speed_kmh < 150 else RED
        for name, value, look in (("DYMOLA", printed.dymola, "-"),
                                  ("VAMPIRE", printed.vampire, ":")):  # fmt: skip
            ax.axvline(value, color=colour, linestyle=look, linewidth=1.4,
                       label=f"{name}, {printed.speed_kmh:g} km/h")  # fmt: skip
    ax.set_yticks(ticks, names)
    ax.set_ylim(row - 1.3, -0.8)
    ax.set_xscale("log")
    ax.set_xlim(least, most)
    marks = (0.1, 0.2, 0.3, 0.4, 0.6, 1.0, 2.0, 4.0)
    ax.set_xticks(marks, [f"{mark:g}" for mark in marks])
    ax.set_xticks([], minor=True)
    ax.set_xlabel("weighted r.m.s. acceleration [m/s²]")
    lines, labels = ax.get_legend_handles_labels()
    figure.legend(lines, labels, frameon=False, loc="outside upper center", ncol=4)
    canvas.tidy(ax)
    return figure


FIGURES = {
    "paper_check_halves": two_halves,
    "paper_check_weighting": weighting_sampled,
    "paper_check_sampling": sampling,
    "paper_check_speed": speed,
    "paper_check_floor": floor,
    "paper_check_levels": levels,
}
