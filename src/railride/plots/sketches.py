"""What pictures of mechanical systems are drawn from: springs, dampers, arrows, dimensions.

Everything is in metres on axes of equal scale; an element stands between two points.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railride.plots import canvas
from railride.spectra import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Point = tuple[float, float]
_THIN: dict[str, Any] = {"color": canvas.TRACK, "linewidth": 0.9}
BACKED: dict[str, Any] = {"facecolor": "white", "linewidth": 0, "pad": 1}  # of a label on lines
_LABEL: dict[str, Any] = {"ha": "center", "va": "center", "fontsize": 10.5}


def sketch_axes(ax: Axes | None, width: float, height: float) -> Axes:
    """Axes without frame and ticks, both scales equal."""
    ax = canvas.axes_or_new(ax, width, height)
    ax.set_aspect("equal")
    ax.set_axis_off()
    return ax


def label(ax: Axes, at: Point, text: str, **look: Any) -> None:
    """A symbol, LaTeX without its dollars."""
    ax.text(*at, f"${text}$", **_LABEL | look)


def spring(ax: Axes, x: float, low: float, high: float) -> None:
    """A coil spring that stands upright."""
    turns, half = 5, 0.16
    inner = np.linspace(low + 0.2 * (high - low), high - 0.2 * (high - low), 2 * turns + 1)
    sides = half * np.array([0.0, *([1.0, -1.0] * turns)[: 2 * turns - 1], 0.0])
    ax.plot(x + np.array([0.0, *sides, 0.0]), [low, *inner, high], **_THIN)


def damper(ax: Axes, x: float, low: float, high: float) -> None:
    """A dashpot that stands upright."""
    half, reach = 0.16, high - low
    bottom, piston, top = low + 0.35 * reach, low + 0.55 * reach, low + 0.7 * reach
    ax.plot([x, x], [low, bottom], **_THIN)
    ax.plot(x + half * np.array([-1, -1, 1, 1]), [top, bottom, bottom, top], **_THIN)
    ax.plot([x - 0.8 * half, x + 0.8 * half], [piston, piston], **_THIN)
    ax.plot([x, x], [piston, high], **_THIN)


def actuator(ax: Axes, x: float, low: float, high: float) -> None:
    """A pair of forces that push apart."""
    middle = (low + high) / 2
    arrow(ax, (x, middle), (x, high), canvas.EQUIPMENT)
    arrow(ax, (x, middle), (x, low), canvas.EQUIPMENT)


def spiral(ax: Axes, at: Point) -> None:
    """A torsional spring about a hinge."""
    turn = np.linspace(0.0, 5 * np.pi, 120)
    radius = 0.14 + 0.36 * turn / turn[-1]
    ax.plot(at[0] + radius * np.cos(turn), at[1] + radius * np.sin(turn), **_THIN)


def arrow(ax: Axes, start: Point, end: Point, color: str = canvas.TRACK, **look: Any) -> None:
    """An arrow from one point to another."""
    properties = {"arrowstyle": "-|>", "color": color, "linewidth": 1.1, "shrinkA": 0,
                  "shrinkB": 0, "mutation_scale": 9} | look  # fmt: skip
    ax.annotate("", end, start, arrowprops=properties)


def turning(ax: Axes, at: Point, color: str, text: str, clockwise: bool = False) -> None:
    """A curved arrow for an angle, its symbol beside it."""
    x, z = at
    low, high = (x + 0.35, z - 0.3), (x + 0.35, z + 0.3)
    start, end, bend = (high, low, -0.5) if clockwise else (low, high, 0.5)
    arrow(ax, start, end, color, connectionstyle=f"arc3,rad={bend}")
    label(ax, (x - 0.1, z), text, color=color)


def dimension(ax: Axes, left: float, right: float, z: float, text: str) -> None:
    """A length between two places, with the lines that it is measured between."""
    arrow(ax, (left, z), (right, z), arrowstyle="<|-|>", linewidth=0.8)
    for x in (left, right):
        ax.plot([x, x], [z - 0.15, z + 0.15], **_THIN)
    label(ax, ((left + right) / 2, z), text, bbox=BACKED)


def level(ax: Axes, left: float, right: float, z: float) -> None:
    """Where something is at rest."""
    ax.plot([left, right], [z, z], color=canvas.REST, linewidth=1.0, linestyle="--", zorder=0)


def bar(ax: Axes, x: FloatArray, z: FloatArray, color: str, height: float = 0.0) -> None:
    """A rigid part along a line, with a body above it."""
    if height:
        ax.fill_between(x, z, z + height, color=color, alpha=0.15, linewidth=0)
    ax.plot(x, z, color=color, linewidth=2.6, solid_capstyle="round")


def axes_cross(ax: Axes, at: Point, names: tuple[str, str] = ("x", "z")) -> None:
    """The directions in which places count."""
    x, z = at
    arrow(ax, at, (x + 1.3, z))
    arrow(ax, at, (x, z + 1.3))
    label(ax, (x + 1.6, z), names[0])
    label(ax, (x, z + 1.65), names[1])
