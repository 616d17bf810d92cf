"""Pictures of frequency responses: magnitude and phase over frequency, with what explains them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.quantities import in_kmh

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.bodes import BodeResponse

_MARKS = {"bogie spacing": "v", "wheelbase": "D"}
_DEEPEST = 1e-5  # of the largest magnitude: what lies lower is a zero
_TOGETHER = 0.03  # of the axis: natural frequencies so close to one another share a label
_FEW = 40  # frequencies, each of which is shown as a point
_MOST_PHASES = 20_000  # of one line: more than a picture shows, and more than Agg always takes
_SOURCES = {
    "t": "from the track",
    "w": "from wheelset {}",
    "f": "from actuator {}",
}


def plot_bode(responses: Sequence[BodeResponse], *, figure: Figure | None = None) -> Figure:
    """Draw |H| and its phase over Hz, one line for each response, with a legend of what differs.

    Natural frequencies of all their vehicles are marked and named above. The geometric zeros stand
    as marks on the lower edge, in the colour of their line or, where all have them, in grey.

    responses : from :func:`railride.bodes.bode`, of several speeds, positions or vehicles, all of
    one unit. figure : an empty one to draw into, instead of a new one.

    Raises InputError for no response, and for responses of different units.
    """
    responses = tuple(responses)
    units = sorted({r.unit for r in responses})
    if len(units) != 1:
        raise InputError(f"responses: found {' and '.join(units) or 'none'}; expected at least one "
                         "response, and all of one unit (draw others by themselves)")  # fmt: skip
    figure = canvas.new_figure(8.5, 7.4) if figure is None else figure
    top, above, below = figure.subplots(3, 1, sharex=True, height_ratios=(0.9, 4, 2.2))
    names = _distinct(responses)
    for k, (r, name) in enumerate(zip(responses, names, strict=True)):
        look: dict[str, Any] = {**canvas.line_look(k), "linewidth": 1.3,
                                "marker": "." if r.frequency.size <= _FEW else None}  # fmt: skip
        above.plot(*canvas.outline(r.frequency, r.magnitude), **look, label=name or None)
        below.plot(*_broken(r.frequency, r.phase_deg), **look)
    _scales(above, below, responses)
    above.set_ylabel(f"magnitude [{units[0].replace('^2', '²')}]")
    below.set_ylabel("phase [°]")
    below.set_xlabel("frequency [Hz]")
    _mark_zeros(above, responses)
    _mark_modes(top, (above, below), responses)
    figure.suptitle(_common(responses), x=0.02, ha="left", fontsize="medium")
    handles, labels = above.get_legend_handles_labels()  # zeros were marked after the lines
    if labels:
        figure.legend(handles, labels, loc="outside lower center", frameon=False,
                      ncols=_abreast(labels), fontsize="small")  # fmt: skip
    return figure


def _abreast(labels: Sequence[str]) -> int:
    """How many columns of a legend fit side by side: at most three."""
    return max(1, min(3, len(labels), int(135 / (10 + max(map(len, labels))))))


def _scales(above: Axes, below: Axes, responses: Sequence[BodeResponse]) -> None:
    """Logarithms, limits that hold every line but no bottomless zero, and plain numbers."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    low = min(float(r.frequency[0]) for r in responses)
    high = max(float(r.frequency[-1]) for r in responses)
    for ax in (above, below):
        ax.set_xscale("log")
        if low < high:
            ax.set_xlim(low, high)
        canvas.tidy(ax)
        ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.xaxis.set_minor_formatter(FuncFormatter(lambda _, __: ""))
    largest = max(float(r.magnitude.max()) for r in responses)
    least = min(float(r.magnitude.min()) for r in responses)
    if largest > 0:
        above.set_yscale("log")
        above.set_ylim(max(least, _DEEPEST * largest) / 2.5, 2.0 * largest)
    below.set_ylim(-190, 190)
    below.set_yticks([-180, -90, 0, 90, 180])


def _broken(frequency: Any, phase: Any) -> tuple[Any, Any]:
    """The phase, thinned out, with a gap where it jumps by a turn, which is no line."""
    frequency, phase = (x[:: 1 + x.size // _MOST_PHASES] for x in (frequency, phase))
    jumps = np.flatnonzero(np.abs(np.diff(phase)) > 180) + 1
    return np.insert(frequency, jumps, np.nan), np.insert(phase, jumps, np.nan)


def _mark_zeros(ax: Axes, responses: Sequence[BodeResponse]) -> None:
    """The geometric zeros as marks on the lower edge, grey where all responses have them.

    Each kind stands once in the legend.
    """
    from matplotlib.transforms import blended_transform_factory

    where = blended_transform_factory(ax.transData, ax.transAxes)
    named: set[tuple[str, float]] = set()
    kinds = ({(r.speed, zeros.cause, zeros.distance) for zeros in r.zeros} for r in responses)
    shared = set.intersection(*kinds)
    for k, r in enumerate(responses):
        for zeros in r.zeros:
            inside = zeros.frequency[zeros.frequency >= r.frequency[0]]
            mark, key = _MARKS.get(zeros.cause, "o"), (zeros.cause, zeros.distance)
            style: dict[str, Any] = {"marker": mark, "linestyle": "none", "markersize": 4,
                                     "clip_on": False, "markerfacecolor": "white"}  # fmt: skip
            colour = canvas.TRACK if (r.speed, *key) in shared else canvas.line_look(k)["color"]
            height = np.full(inside.size, 0.0 if mark == "v" else 0.03)
            ax.plot(inside, height, transform=where, markeredgecolor=colour, **style)
            if inside.size and key not in named:
                named.add(key)
                (entry,) = ax.plot(
                    [], [], markeredgecolor=canvas.TRACK, **style,
                    label=f"zeros (k + ½)·V/{zeros.distance:g} m, {zeros.cause}",
                )  # fmt: skip
                entry.set_in_layout(False)  # of no extent, it would be looked for at 0, 0


def _mark_modes(top: Axes, others: Sequence[Axes], responses: Sequence[BodeResponse]) -> None:
    """Thin lines at the natural frequencies of the oscillating modes, named in axes on top."""
    top.axis("off")
    top.set_ylim(0, 1)
    found = {
        (m.frequency_hz, m.label)
        for r in responses
        for m in r.modes
        if m.eigenvalue.imag > 0 and r.frequency[0] <= m.frequency_hz <= r.frequency[-1]
    }
    low, high = others[0].get_xlim()
    near = (high / low) ** _TOGETHER
    groups: list[list[tuple[float, str]]] = []
    for mode in sorted(found):
        for ax in others:
            ax.axvline(mode[0], color=canvas.TRACK, linewidth=0.6, linestyle=":")
        if groups and mode[0] < near * groups[-1][0][0]:
            groups[-1].append(mode)
        else:
            groups.append([mode])
    for group in groups:
        name = ",\n".join(dict.fromkeys(label for _, label in group))
        (lowest, _), (highest, _) = group[0], group[-1]
        first, last = f"{lowest:.3g}", f"{highest:.3g}"
        hertz = f"{first if first == last else f'{first}–{last}'} Hz"
        text = top.text(float(np.sqrt(lowest * highest)), 0.0, f"{name}\n{hertz}", rotation=90,
                        ha="center", va="bottom", fontsize="x-small", linespacing=1.0,
                        color=canvas.TRACK)  # fmt: skip
        text.set_in_layout(False)


def _facts(r: BodeResponse) -> tuple[str, ...]:
    """What a response is of; what does not matter to it is empty."""
    on_floor, signal = r.position is not None, r.signal.replace("_", " ")
    return (
        r.vehicle,
        r.body,
        f"{signal.removeprefix('floor ')} of the {r.floor} floor" if on_floor else signal,
        _SOURCES[r.source[0]].format(r.source[2:]),
        "" if r.speed is None else in_kmh(r.speed),
        f"x = {r.position:g} m" if on_floor else "",
    )


def _distinct(responses: Sequence[BodeResponse]) -> list[str]:
    """What tells each response from the others."""
    columns = list(zip(*map(_facts, responses), strict=True))
    return [
        ", ".join(column[k] for column in columns if len(set(column)) > 1 and column[k])
        for k in range(len(responses))
    ]


def _common(responses: Sequence[BodeResponse]) -> str:
    """What all responses share."""
    columns = zip(*map(_facts, responses), strict=True)
    return ", ".join(column[0] for column in columns if len(set(column)) == 1 and column[0])
