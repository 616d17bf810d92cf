"""What all pictures have in common: colours, new figures, and how they become files."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.files import write_bytes
from railride.spectra import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# One colour for one thing in every picture, told apart by the colour-blind and in grey print.
# Source: M. Okabe, K. Ito, Color Universal Design, 2008.
TRACK = "#4D4D4D"
ACCELERATION = "#56B4E9"
WEIGHTED = "#B34700"
SPECTRUM = "#D55E00"
BODY = "#0072B2"
BOGIE = "#D55E00"
EQUIPMENT = "#009E73"
REST = "#BBBBBB"

# Lines to be told apart, by colour and in grey print: the style shifts on every round of colours.
LINES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#56B4E9", "#E69F00")
STYLES = ("-", "--", "-.", ":")
MARKS = "sD^vPXo"

TITLE: dict[str, Any] = {"loc": "left", "fontsize": "medium"}
DPI = 150
TALLEST = 200.0  # in: beyond about 430 there are more pixels than Agg can draw
# Metadata that would differ from one run, or one version of matplotlib, to the next.
_METADATA: dict[str, dict[str, None]] = {
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
    "svg": {"Date": None, "Creator": None},
}
_FINER = 4  # times: the grid that lines of equal value are drawn on
_MOST_POINTS = 50_000  # of one line: more than any picture shows, and more than Agg always takes


def new_figure(width: float, height: float) -> Figure:
    """An empty figure of ``width`` × ``height`` in, that keeps its labels apart and inside."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")


def axes_or_new(ax: Axes | None, width: float, height: float) -> Axes:
    """The axes given, or the only ones of a new figure of ``width`` × ``height`` in."""
    return new_figure(width, height).add_subplot() if ax is None else ax


def tidy(ax: Axes) -> None:
    """Light grid, no box, and ticks that show their numbers whole."""
    ax.grid(visible=True, color="#E6E6E6", linewidth=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def line_look(k: int) -> dict[str, Any]:
    """Colour and style of line k, from 0: 28 of them differ.

    >>> line_look(0) == line_look(28), line_look(0) == line_look(7)
    (True, False)
    """
    turn, place = divmod(k, len(LINES))
    return {"color": LINES[place], "linestyle": STYLES[(place + turn) % len(STYLES)]}


def mark_look(k: int) -> dict[str, Any]:
    """Colour and mark of point k, from 0: 49 of them differ."""
    turn, place = divmod(k, len(LINES))
    return {"color": LINES[place], "marker": MARKS[(place + turn) % len(MARKS)]}


def outline(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
    """A line with at most 50,000 points that looks like y over x: least and largest of each piece.

    x, y : shape (n,), x ascending. A line that is short enough comes back as it is.

    >>> x = np.arange(200_000.0)
    >>> [part.size for part in outline(x, np.sin(x))]
    [50000, 50000]
    """
    if y.size <= _MOST_POINTS:
        return x, y
    starts = np.linspace(0, y.size, _MOST_POINTS // 2, endpoint=False).astype(int)
    low, high = np.minimum.reduceat(y, starts), np.maximum.reduceat(y, starts)
    drawn = np.column_stack([low, high]).ravel()
    return np.repeat(x[starts], 2), drawn


def contours(ax: Axes, x: FloatArray, y: FloatArray, z: FloatArray) -> None:
    """Lines of equal value of the cubic spline through all points: white, edged, labelled."""
    from matplotlib.patheffects import withStroke
    from scipy.interpolate import RectBivariateSpline

    orders = {"kx": min(3, y.size - 1), "ky": min(3, x.size - 1)}
    spline = RectBivariateSpline(y, x, z, **orders)
    fine = [np.interp(np.arange(_FINER * (v.size - 1) + 1) / _FINER, np.arange(v.size), v)
            for v in (x, y)]  # fmt: skip
    lines = ax.contour(*fine, spline(fine[1], fine[0]), levels=6, colors="white", linewidths=0.7)
    lines.set_path_effects([withStroke(linewidth=1.5, foreground="#00000080")])
    for label in ax.clabel(lines, fontsize="x-small", fmt="%.3g"):
        label.set_path_effects([withStroke(linewidth=1.5, foreground="#202020")])


def picture_format(path: str | Path) -> str:
    """The format that the suffix of a file's name asks for: "png", "pdf" or "svg".

    Raises InputError for any other suffix, naming these.

    >>> picture_format("track.PNG")
    'png'
    """
    suffix = Path(path).suffix
    if suffix.lower().removeprefix(".") not in _METADATA:
        found = f"the suffix {suffix!r}" if suffix else "no suffix"
        raise InputError(
            f"{str(path)!r}: found {found}; expected one of {', '.join('.' + f for f in _METADATA)}"
            " (it says which kind of picture to write)"
        )
    return suffix.lower().removeprefix(".")


def save(drawn: Figure | Axes, path: str | Path) -> None:
    """Write a figure to a PNG, PDF or SVG file, as a whole or not at all; 150 dots per inch.

    drawn : the figure, or axes in it.

    The same figure gives the same bytes on every run.

    Raises InputError for another suffix, and where the file cannot be written.
    """
    from matplotlib import rc_context
    from matplotlib.axes import Axes

    kind = picture_format(path)
    options: dict[str, Any] = {"format": kind, "dpi": DPI, "metadata": _METADATA[kind]}
    content = BytesIO()
    # An SVG's inner names are random unless salted, which only this setting can do; it is put back.
    with rc_context({"svg.hashsalt": "railride"}):
        figure = drawn.get_figure(root=True) if isinstance(drawn, Axes) else drawn
        if figure is not None:
            figure.savefig(content, **options)
    write_bytes(path, content.getvalue())
