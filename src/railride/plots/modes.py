"""Pictures of mode shapes: the car body as a polygon, the bogies below it."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.spectra import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.modal import Mode
    from railride.parameters import Vehicle
    from railride.vehicle import VehicleModel

MOST_MODES = 15  # mode shapes in one picture
_TWO_COLUMNS = 8  # of mode shapes as many fit into two columns
_NAMED = 8  # of those that are left out
# A drawing's own heights: the largest displacement is 1.
_RAIL, _BOGIE, _HUNG, _FLOOR, _HEIGHT = 0.0, 1.6, 2.9, 3.8, 1.6


@dataclass(frozen=True)
class ModeShape:
    """Where the floor's nodes and the bogies go in a mode; the largest displacement is 1.

    nodes : x, m, shape (N + 1,), from the front; jointed : they are those of segments.
    floor : displacement there. heave, pitch : of each bogie, shape (bogies,), the pitch per m.
    equipment : displacement of each under the floor.
    """

    nodes: FloatArray
    floor: FloatArray
    heave: FloatArray
    pitch: FloatArray
    equipment: FloatArray
    jointed: bool = True


def mode_shape(model: VehicleModel, mode: Mode, turned: complex = 1.0) -> ModeShape:
    """Vertical displacements Re(d e/d_max): at e = 1 the instant when the largest is largest.

    d = Y φ with the model's own rows Y of displacement, the polygon at its nodes, and
    z_b + θ_b l on the bogies, l forward of the bogie's centre, above the wheelsets.

    turned : e, by which the mode has turned and decayed since, e^{λt}.
    """
    vehicle, bogies = model.vehicle, len(model.vehicle.bogies)
    nodes = model.body.nodes
    rows = model.output_rows([model.floor(x, "polygon", 0) for x in nodes.tolist()])["d"]
    floor = rows @ mode.shape
    names = [q.name for q in model.lagrangian.coordinates]
    hung = np.array([mode.shape[names.index(q.name)] for q in model.carried.coordinates])
    # The strokes of dampers on elastic mounts come after the bogies.
    first = names.index("z_b1")
    heave, pitch = mode.shape[first : first + 2 * bogies].reshape(bogies, 2).T
    above = [heave[b] + pitch[b] * np.array([0.0, *bogie.wheelsets])
             for b, bogie in enumerate(vehicle.bogies)]  # fmt: skip
    every = np.concatenate([floor, *above, hung])
    size = np.abs(every)
    largest = every[np.argmax(size > (1 - 1e-6) * size.max())]  # of equals the foremost: nose up
    floor, heave, pitch, hung = (np.real(part * (turned / largest))
                                 for part in (floor, heave, pitch, hung))  # fmt: skip
    return ModeShape(nodes, floor, heave, pitch, hung, model.body.segments is not None)


def plot_modes(
    model: VehicleModel, modes: Sequence[Mode] | None = None, *, count: int = MOST_MODES
) -> Figure:
    """Draw mode shapes, each at the instant of its largest displacement; what is left out is named.

    modes : of the model, :func:`railride.modal.modes`. If they are not given, those that oscillate
    are drawn: a real eigenvalue creeps back and has no shape that goes to and fro.
    count : how many of them to draw, from the lowest natural frequency up.

    Raises InputError for a count below 1, and for modes of another model.
    """
    drawn, left = chosen_modes(model, modes, count)
    columns = min(3 if len(drawn) > _TWO_COLUMNS else 2, len(drawn))
    rows = -(-len(drawn) // columns)
    figure = canvas.new_figure(5.2 * columns, 2.0 * rows + 0.8)
    grid = figure.subplots(rows, columns, squeeze=False, sharex=True, sharey=True)
    for ax, mode in zip(grid.flat, drawn, strict=False):
        draw(ax, model.vehicle, mode_shape(model, mode))
        ax.set_title(title(mode), **canvas.TITLE)
    for ax in grid.flat[len(drawn) :]:
        ax.remove()
    for ax in grid.flat[max(0, len(drawn) - columns) : len(drawn)]:
        ax.tick_params(labelbottom=True)
        ax.set_xlabel("x, forward of the body's middle [m]")
    handles, labels = grid.flat[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=min(len(labels), 2 * columns),
                  frameon=False)  # fmt: skip
    if left:
        note = textwrap.fill(left_out(left), 62 * columns)
        figure.supxlabel(note, fontsize="small", x=0.01, ha="left", color=canvas.TRACK)
    return figure


def chosen_modes(
    model: VehicleModel, modes: Sequence[Mode] | None = None, count: int = MOST_MODES
) -> tuple[list[Mode], list[Mode]]:
    """The modes that :func:`plot_modes` draws, and those of the model that it leaves out.

    Of a vehicle that only creeps, all are drawn as far as they go. Of modes that were asked for,
    only those beyond ``count`` are left out. Raises as :func:`plot_modes`.
    """
    from railride.modal import modes as find

    if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < 1:
        raise InputError(f"count: found {count!r}; expected a whole number of at least 1")
    every = list(find(model) if modes is None else modes)
    refuse_others(model, every)
    wanted = every
    if modes is None:
        wanted = [mode for mode in every if mode.eigenvalue.imag > 0] or every
    drawn = wanted[:count]
    return drawn, [mode for mode in every if not any(mode is one for one in drawn)]


def left_out(modes: Sequence[Mode]) -> str:
    """A sentence that names the modes which are not drawn.

    >>> from railride import derive_vehicle, load_vehicle
    >>> from railride.modal import modes
    >>> left_out(modes(derive_vehicle(load_vehicle("cati2024"), 2))[:2])
    'not drawn: heave (1.028 Hz), pitch (1.311 Hz)'
    """
    pairs = [mode for mode in modes if mode.eigenvalue.imag > 0]
    named = [f"{_named(mode)} ({mode.frequency_hz:.4g} Hz)" for mode in pairs[:_NAMED]]
    if len(pairs) > _NAMED:
        named.append(f"{len(pairs) - _NAMED} more up to {pairs[-1].frequency_hz:.4g} Hz")
    creeping = Counter(mode.label for mode in modes if not mode.eigenvalue.imag > 0)
    if creeping:
        listed = ", ".join(f"{n} × {label}" if n > 1 else label for label, n in creeping.items())
        named.append(f"real eigenvalues ({listed})")
    return f"not drawn: {', '.join(named)}"


def title(mode: Mode) -> str:
    """What a mode is called in a picture: label, bogies' phase, frequency and damping ratio."""
    return f"{_named(mode)}: {mode.frequency_hz:.3f} Hz, ζ = {mode.damping_ratio:.2g}"


def _named(mode: Mode) -> str:
    return f"{mode.label}, {mode.phase}" if mode.phase else mode.label


def refuse_others(model: VehicleModel, modes: Sequence[Mode]) -> None:
    """Raise InputError for no modes, and for modes of another model."""
    size = len(model.lagrangian.coordinates)
    if not modes or any(mode.shape.size != size for mode in modes):
        raise InputError(f"modes: found {'none' if not modes else 'shapes of another size'}; "
                         f"expected modes of this model, of {size} coordinates")  # fmt: skip


def draw(ax: Axes, vehicle: Vehicle, shape: ModeShape) -> None:
    """The vehicle at rest as dashed lines, displaced in colour, its suspension as thin lines."""
    rest: dict[str, Any] = {"color": canvas.REST, "linewidth": 1.0, "linestyle": "--"}
    floor = _FLOOR + shape.floor
    ax.plot(shape.nodes[[0, -1]], [_FLOOR, _FLOOR], **rest, label="at rest")
    ax.fill_between(shape.nodes, floor, floor + _HEIGHT, color=canvas.BODY, alpha=0.15, linewidth=0)
    joints: dict[str, Any] = {"label": "car body"}
    if shape.jointed:
        joints = {"label": "car body, nodes of its segments", "marker": "o", "markersize": 3}
    ax.plot(shape.nodes, floor, color=canvas.BODY, linewidth=1.6, **joints)
    for b, bogie in enumerate(vehicle.bogies):
        x, heave, pitch = bogie.position, shape.heave[b], shape.pitch[b]
        ends = np.array([min(0.0, *bogie.wheelsets), max(0.0, *bogie.wheelsets)])
        ax.plot(x + ends, [_BOGIE, _BOGIE], **rest)
        held = float(np.interp(x, shape.nodes[::-1], floor[::-1]))
        _suspension(ax, x, _BOGIE + heave, held)
        for lever in bogie.wheelsets:
            _suspension(ax, x + lever, _RAIL, _BOGIE + heave + pitch * lever)
        ax.plot(x + ends, _BOGIE + heave + pitch * ends, color=canvas.BOGIE, linewidth=2.4,
                label="bogies" if b == 0 else None)  # fmt: skip
    for e, (one, heave) in enumerate(zip(vehicle.equipment, shape.equipment, strict=True)):
        held = float(np.interp(one.position, shape.nodes[::-1], floor[::-1]))
        _suspension(ax, one.position, _HUNG + heave, held)
        ax.plot(one.position, _HUNG + heave, color=canvas.EQUIPMENT, marker="s", markersize=6,
                linestyle="", label="equipment" if e == 0 else None)  # fmt: skip
    ax.axhline(_RAIL, color=canvas.TRACK, linewidth=1.5, label="rail")
    ax.set_ylim(_RAIL - 0.2, _FLOOR + _HEIGHT + 1.2)
    ax.set_yticks([])
    ax.spines[["top", "right", "left"]].set_visible(False)


def _suspension(ax: Axes, x: float, low: float, high: float) -> None:
    ax.plot([x, x], [low, high], color=canvas.TRACK, linewidth=0.7, linestyle=":", marker=None)
