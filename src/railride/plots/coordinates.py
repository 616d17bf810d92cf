"""Pictures of the coordinates: a vehicle's, its car body's alone, the paper's two halves.

Displacements are drawn large and heights not to scale; places along the track are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railride.bodies.segments import SegmentedBody
from railride.markup import math
from railride.plots import canvas
from railride.plots.sketches import (
    BACKED,
    actuator,
    arrow,
    axes_cross,
    bar,
    damper,
    dimension,
    label,
    level,
    sketch_axes,
    spiral,
    spring,
    turning,
)
from railride.spectra import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railride.vehicle import VehicleModel

_FLOOR, _BOGIE, _HEIGHT, _WHEEL = 5.6, 2.5, 1.7, 0.46
_FULL = 8  # segments that are all labelled; of more the first, the middle and the last


def plot_coordinates(model: VehicleModel, *, ax: Axes | None = None) -> Axes:
    """Draw a vehicle, displaced, with its coordinates, inputs, forces and lengths.

    model : of any body; the front is on the right, as x counts forward.
    """
    half = model.vehicle.body.length / 2
    ax = sketch_axes(ax, 11.0, 4.6)
    _rail(ax, model)
    for b in model.running_gear.bogies:
        _bogie(ax, model, b)
    for e, one in zip(model.carried.equipment, model.vehicle.equipment, strict=True):
        _hung(ax, model, e, one.position)
    _body(ax, model, _FLOOR)
    _lengths(ax, model)
    axes_cross(ax, (-half - 2.2, 0.6))
    ax.set(xlim=(-half - 3.2, half + 1.6), ylim=(-2.7, _FLOOR + _HEIGHT + 1.6))
    return ax


def plot_body_coordinates(model: VehicleModel, *, ax: Axes | None = None) -> Axes:
    """Draw the car body alone, displaced, with its coordinates.

    model : a vehicle with the body.
    """
    half = model.vehicle.body.length / 2
    ax = sketch_axes(ax, 11.0, 2.0)
    _body(ax, model, 0.0)
    dimension(ax, -half, half, -1.3, "L")
    axes_cross(ax, (-half - 2.9, 0.0))
    ax.set(xlim=(-half - 3.2, half + 1.6), ylim=(-1.7, _HEIGHT + 1.6))
    return ax


def plot_half_body(free: bool, *, ax: Axes | None = None) -> Axes:
    """Draw the paper's car body of two halves: its ends held at height zero, or ``free``."""
    ax = sketch_axes(ax, 9.0, 2.6)
    length, turn = 6.0, 0.30
    c, s = length * np.cos(turn), length * np.sin(turn)
    left, low = (-c, -s / 2) if free else (0.0, 0.0)
    x, z = left + np.array([0.0, c, 2 * c]), low + np.array([0.0, s, 0.0])
    level(ax, left - 0.8, left + 2 * c + 0.8, 0.0)
    for k in (0, 1):
        bar(ax, x[k : k + 2], z[k : k + 2], canvas.BODY)
        middle = (float(x[k : k + 2].mean()), float(z[k : k + 2].mean()))
        arrow(ax, (0.0, 0.0), middle, canvas.BOGIE)
        ax.plot(*middle, "o", color=canvas.BODY, markersize=6)
        name = r"\vec r_F" if k == 0 else r"\vec r_R"
        below = (0.62 * middle[0], 0.62 * middle[1] + (-0.45 if free else 0.4))
        beside = (0.8 * middle[0] - 0.2, 0.8 * middle[1] + 0.45)
        label(ax, beside if k == 0 and not free else below, name, color=canvas.BOGIE)
        label(ax, (middle[0], middle[1] + 0.6), "m_h, L_h", color=canvas.BODY)
    spiral(ax, (float(x[1]), float(z[1])))
    label(ax, (float(x[1]), float(z[1]) + 0.85), r"k_\theta")
    for end, sense in ((0, 1.0), (2, -1.0)):
        _angle(ax, (float(x[end]), float(z[end])), sense, turn)
        if not free:
            _support(ax, float(x[end]), slides=end == 2)
    ax.plot(x[[0, 2]], z[[0, 2]], "o", color=canvas.BODY, markersize=4)
    axes_cross(ax, (left - 3.2, 0.0))
    ax.plot(0.0, 0.0, "+", color=canvas.TRACK, markersize=9)
    label(ax, (0.0 if free else -0.45, -0.4 if free else 0.35), "O")
    ax.set(xlim=(left - 3.6, left + 2 * c + 1.2), ylim=(-1.4, 3.0))
    return ax


def _angle(ax: Axes, at: tuple[float, float], sense: float, turn: float) -> None:
    """θ between the level and a half, at one of its ends."""
    x, z = at
    radius, sweep = 1.5, np.linspace(0.0, turn, 30)
    level(ax, x, x + sense * (radius + 0.6), z)
    ax.plot(x + sense * radius * np.cos(sweep), z + radius * np.sin(sweep), color=canvas.TRACK,
            linewidth=1.0)  # fmt: skip
    label(ax, (x + sense * (radius + 0.35), z + 0.3), r"\theta")


def _support(ax: Axes, x: float, *, slides: bool) -> None:
    """A pin that holds a point, or one on rollers."""
    ax.fill([x, x - 0.35, x + 0.35], [0.0, -0.55, -0.55], color=canvas.TRACK, alpha=0.5)
    if slides:
        ax.plot([x - 0.2, x + 0.2], [-0.68, -0.68], "o", color=canvas.TRACK, markersize=4)
    ground = -0.82 if slides else -0.55
    ax.plot([x - 0.7, x + 0.7], [ground, ground], color=canvas.TRACK, linewidth=1.4)


def _heights(model: VehicleModel, x: FloatArray) -> FloatArray:
    """How far the body is drawn from rest at x."""
    u = 2 * x / model.vehicle.body.length
    return 0.75 + 0.3 * u if model.body.segments == 1 else 0.5 + 0.25 * u + 0.75 * (1 - u**2)


def _held(model: VehicleModel, x: float) -> float:
    """The drawn height of the body's structure at x."""
    nodes = model.body.nodes
    return float(np.interp(x, nodes[::-1], _heights(model, nodes)[::-1]))


def _body(ax: Axes, model: VehicleModel, floor: float) -> None:
    nodes, body = model.body.nodes, model.body
    z = floor + _heights(model, nodes)
    level(ax, nodes[-1] - 0.6, nodes[0] + 0.6, floor)
    for i in range(len(nodes) - 1):
        bar(ax, nodes[i : i + 2][::-1], z[i : i + 2][::-1], canvas.BODY, _HEIGHT)
    if body.segments in (None, 1):
        _rigid(ax, model, floor)
        return
    N = len(nodes) - 1
    ax.plot(nodes, z, "o", color=canvas.BODY, markerfacecolor="white", markersize=5)
    shown = range(N + 1) if N <= _FULL else (0, N // 2, N)
    for i in shown:
        arrow(ax, (nodes[i], floor), (nodes[i], z[i]), canvas.BODY)
        side = 0.45 if i < N else -0.45
        label(ax, (nodes[i] + side, floor + 0.3), f"z_{{{i}}}", color=canvas.BODY)
    for i in range(1, N + 1):
        if N <= _FULL or i in (1, N):
            at = (float(nodes[i - 1 : i + 1].mean()), float(z[i - 1 : i + 1].mean()) + 0.85)
            turning(ax, at, canvas.BODY, rf"\theta_{{{i}}}")
    for j in range(1, N):
        if N <= _FULL:
            spiral(ax, (nodes[j], z[j]))
    if isinstance(body, SegmentedBody):
        first = 1 if N <= _FULL else N // 2
        k, c = body.joints.stiffness[first - 1], body.joints.damping[first - 1]
        label(ax, (nodes[first], z[first] + 0.85), rf"{math(k)},\, {math(c)}")


def _rigid(ax: Axes, model: VehicleModel, floor: float) -> None:
    """The coordinates of a body whose motion counts from its mass centre."""
    x = model.vehicle.body.mass_centre
    top = floor + _held(model, x)
    arrow(ax, (x, floor), (x, top), canvas.BODY)
    label(ax, (x + 0.5, floor + 0.35), "z_c", color=canvas.BODY)
    turning(ax, (x, top + 0.85), canvas.BODY, r"\theta_c")
    if model.body.segments is None:
        label(ax, (model.body.nodes[0] - 1.2, floor + 0.2), r"\eta_1,\, \eta_2,\, \ldots",
              color=canvas.BODY)  # fmt: skip


def _frame(b: int) -> tuple[float, float]:
    """How far bogie b is drawn from rest: heave, and pitch per m."""
    return 0.5, 0.10 if b % 2 else -0.06


def _elevation(x: float | FloatArray) -> float | FloatArray:
    return 0.42 + 0.2 * np.sin(1.1 * np.asarray(x) + 0.6)


def _rail(ax: Axes, model: VehicleModel) -> None:
    half = model.vehicle.body.length / 2
    x = np.linspace(-half - 0.6, half + 0.6, 400)
    ax.plot(x, _elevation(x), color=canvas.TRACK, linewidth=1.6)
    level(ax, x[0], x[-1], 0.0)


def _bogie(ax: Axes, model: VehicleModel, b: int) -> None:
    bogie, gear = model.vehicle.bogies[b - 1], model.running_gear
    heave, pitch = _frame(b)
    ends = np.array([min(0.0, *bogie.wheelsets) - 0.5, max(0.0, *bogie.wheelsets) + 0.5])
    x, frame = bogie.position, _BOGIE + heave
    level(ax, x + ends[0] - 0.7, x + ends[1] + 0.7, _BOGIE)
    bar(ax, x + ends, frame + pitch * ends, canvas.BOGIE)
    arrow(ax, (x, _BOGIE), (x, frame), canvas.BOGIE)
    label(ax, (x + 0.45, _BOGIE - 0.3), f"z_{{b{b}}}", color=canvas.BOGIE, bbox=BACKED)
    outer = ends[1] if x >= 0 else ends[0]
    turning(ax, (x + outer + (0.45 if x >= 0 else -0.75), frame + 0.35), canvas.BOGIE,
            rf"\theta_{{b{b}}}")  # fmt: skip
    stiffness, damping = (
        math(gear.symbol(f"secondary_{name}", b)) for name in ("stiffness", "damping")
    )
    for draw, shift in ((spring, -1.0), (damper, 0.0), (actuator, 0.7)):
        draw(ax, x + shift, frame + pitch * shift, _FLOOR + _held(model, x + shift))
    middle = (frame + _FLOOR) / 2 + 0.2
    label(ax, (x - 1.3, middle), rf"{stiffness},\, {damping}", ha="right")
    label(ax, (x + 1.05, middle), f"f_{{{b}}}")
    for j, _ in gear.levers(b):
        _wheelset(ax, model, b, j)


def _wheelset(ax: Axes, model: VehicleModel, b: int, j: int) -> None:
    bogie = model.vehicle.bogies[b - 1]
    number = [k for k, _ in model.running_gear.levers(b)].index(j)
    lever = bogie.wheelsets[number]
    heave, pitch = _frame(b)
    x, w = bogie.position + lever, float(_elevation(bogie.position + lever))
    axle, top = w + _WHEEL, _BOGIE + heave + pitch * lever
    turn = np.linspace(0, 2 * np.pi, 60)
    ax.plot(x + _WHEEL * np.cos(turn), axle + _WHEEL * np.sin(turn), color=canvas.TRACK,
            linewidth=1.2)  # fmt: skip
    spring(ax, x - 0.22, axle, top)
    damper(ax, x + 0.22, axle, top)
    arrow(ax, (x, 0.0), (x, w), canvas.SPECTRUM)
    label(ax, (x, -0.32), f"w_{{{j}}}", color=canvas.SPECTRUM)
    if number == 0:
        gear = model.running_gear
        text = ",\\, ".join(math(gear.symbol(f"primary_{name}", b))
                            for name in ("stiffness", "damping"))  # fmt: skip
        label(ax, (x + 0.5, (axle + top) / 2 + 0.1), text, ha="left")


def _hung(ax: Axes, model: VehicleModel, e: int, x: float) -> None:
    low, high = _FLOOR - 1.3, _FLOOR + _held(model, x)
    spring(ax, x - 0.2, low, high)
    damper(ax, x + 0.2, low, high)
    bar(ax, np.array([x - 0.6, x + 0.6]), np.array([low, low]), canvas.EQUIPMENT)
    label(ax, (x, low - 0.4), f"z_{{e{e}}}", color=canvas.EQUIPMENT)


def _lengths(ax: Axes, model: VehicleModel) -> None:
    gear, vehicle = model.running_gear, model.vehicle
    half, front = vehicle.body.length / 2, vehicle.bogies[0]
    for (_, lever), x in list(zip(gear.levers(1), front.wheelsets, strict=True))[:1]:
        if x:
            dimension(ax, front.position, front.position + x, -0.95, math(abs(lever)))
    for b, bogie in zip(gear.bogies, vehicle.bogies, strict=True):
        if bogie.position and b in (1, len(vehicle.bogies)):
            name = math(abs(gear.place(b).x))
            left, right = sorted((0.0, bogie.position))
            dimension(ax, left, right, -1.6, name)
    dimension(ax, -half, half, -2.3, "L")
