"""Pictures of measured records: acceleration, comfort over time and the spectrum, axis by axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from railride.comfort.third_octaves import band_edges, third_octave_rms
from railride.errors import InputError
from railride.plots import canvas
from railride.scales import ISO_2631_1_ANNEX_C
from railride.spectra import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.comfort import AxisRating, RecordRating

_RESOLVED = 0.1  # Hz between the lines of the spectral density, where the record is long enough
_ROOM = 1.4  # of the largest value: the legend's place above it


def plot_record(rating: RecordRating, column: str | None = None, *, ax: Axes | None = None) -> Axes:
    """Draw an axis' acceleration, m/s², over time, s, weighted on top; gaps stay open.

    rating : of ``rate_record``. column : the axis, by its column; default the first.

    Raises InputError for a column that was not rated.
    """
    axis = _axis(rating, column)
    ax = canvas.axes_or_new(ax, 7.0, 2.8)
    found = axis.indices
    for pieces, colour, width, label in (
        (axis.axis.pieces, canvas.ACCELERATION, 0.8,
         f"{axis.axis.column}, r.m.s. {found.a_rms:.3g} m/s²"),
        (found.weighted, canvas.WEIGHTED, 0.6,
         f"{found.weighting} weighted, r.m.s. {found.a_wrms:.3g} m/s²"),
    ):  # fmt: skip
        _draw_pieces(ax, rating, pieces, colour, width, label)
    drawn = (*axis.axis.pieces, *found.weighted)
    low, high = min(float(p.min()) for p in drawn), max(float(p.max()) for p in drawn)
    reach = (high - low) or 1.0
    ax.set_ylim(low - 0.05 * reach, high + 0.3 * reach)  # above them the legend's place
    ax.set_ylabel("acceleration [m/s²]")
    _over_time(ax, rating)
    ax.legend(loc="upper right", ncols=2, framealpha=0.9, edgecolor="none", fontsize="small")
    return ax


def plot_running_rms(
    rating: RecordRating, column: str | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an axis' running r.m.s. over 1 s and its r.m.s. in blocks of 5 s, m/s², over time, s.

    The running r.m.s. begins where 1 s of the piece lies behind: before, its window is not full.

    rating : of ``rate_record``. column : the axis, by its column; default the first.

    Source: ISO 2631-1:1997, Eq (2), whose largest value is MTVV; EN 12299 (blocks).

    Raises InputError for a column that was not rated.
    """
    axis = _axis(rating, column)
    ax = canvas.axes_or_new(ax, 7.0, 2.8)
    found = axis.indices
    mtvv = "" if found.mtvv is None else f", MTVV {found.mtvv:.3g} m/s²"
    filling = math.ceil(rating.record.rate * (1 - 1e-12)) - 1  # samples whose window is not full
    _draw_pieces(ax, rating, axis.running, canvas.BODY, 0.8, f"running r.m.s., 1 s{mtvv}", filling)
    blocks = rating.blocks()
    start, value = blocks["start [s]"], blocks[f"{axis.axis.column} {found.weighting} [m/s^2]"]
    ax.hlines(value, start, start + 5.0, color=canvas.WEIGHTED, linewidth=2.2,
              label="r.m.s. of 5 s blocks")  # fmt: skip
    ax.axhline(found.a_wrms, color=canvas.TRACK, linewidth=0.9, linestyle="--",
               label=f"whole record, {found.a_wrms:.3g} m/s²")  # fmt: skip
    highest = max(found.a_wrms, *(float(piece.max()) for piece in axis.running))
    ax.set_ylim(0.0, _ROOM * (highest or 1.0))
    ax.set_ylabel(f"{found.weighting} weighted\nr.m.s. [m/s²]")
    _over_time(ax, rating)
    ax.legend(loc="upper right", ncols=3, framealpha=0.9, edgecolor="none", fontsize="small")
    return ax


def plot_record_spectrum(
    rating: RecordRating, column: str | None = None, *, ax: Axes | None = None
) -> Axes:
    """Draw an axis' third-octave r.m.s., m/s², unweighted and weighted, over frequency, Hz.

    Behind them the root of the spectral density, m/s²/√Hz, by Welch's method. What the record
    cannot tell, above half its rate and below what its length resolves, is left out.

    rating : of ``rate_record``. column : the axis, by its column; default the first.

    Raises InputError for a column that was not rated.
    """
    axis = _axis(rating, column)
    ax = canvas.axes_or_new(ax, 7.0, 4.0)
    edges, rate = band_edges(), rating.record.rate
    frequency, density = _density(axis.axis.pieces, rate)
    ax.plot(frequency, np.sqrt(density), color=canvas.REST, linewidth=0.8,
            label="density [m/s²/√Hz]")  # fmt: skip
    levels = []
    for pieces, colour, width, label in (
        (axis.axis.pieces, canvas.ACCELERATION, 2.2, "third octaves"),
        (axis.indices.weighted, canvas.WEIGHTED, 1.4, f"{axis.indices.weighting} weighted"),
    ):
        level = third_octave_rms(pieces, rate)
        ax.stairs(level, edges, color=colour, linewidth=width, label=label, baseline=None)
        levels.append(level)
    ax.set_xscale("log")
    known = np.concatenate(levels)
    known = known[np.isfinite(known) & (known > 0)]
    if known.size:  # a record that is all zero has nothing to show
        ax.set_yscale("log")
        ax.set_ylim(max(known.min(), 1e-4 * known.max()) / 2, 4 * known.max())
    ax.set_xlim(edges[0], edges[-1])
    ax.xaxis.set_major_formatter("{x:g}")
    ax.set_xlabel("frequency [Hz]")
    ax.set_ylabel("r.m.s. per band [m/s²]")
    ax.legend(loc="upper left", framealpha=0.9, edgecolor="none", fontsize="small", ncols=3)
    canvas.tidy(ax)
    return ax


def plot_record_rating(rating: RecordRating) -> Figure:
    """Draw every axis in a row: the record over the running r.m.s., the spectrum beside them.

    rating : of ``rate_record``.
    """
    rows = len(rating.axes)
    figure = canvas.new_figure(13.0, 4.2 * rows + 0.4)
    figures = figure.subfigures(rows, 1, squeeze=False)
    for own, axis in zip(figures[:, 0], rating.axes, strict=True):
        places = own.subplot_mosaic([["record", "spectrum"], ["running", "spectrum"]],
                                    width_ratios=(3, 2))  # fmt: skip
        column = axis.axis.column
        plot_record(rating, column, ax=places["record"])
        plot_running_rms(rating, column, ax=places["running"])
        plot_record_spectrum(rating, column, ax=places["spectrum"])
        places["record"].set_xlabel("")
        named = f"{column} ({axis.axis.direction})" if axis.axis.direction not in (None, column) \
            else column  # fmt: skip
        scale = ISO_2631_1_ANNEX_C.name
        places["record"].set_title(
            f"{named}: a_wrms {axis.indices.a_wrms:.3g} m/s², {scale}: "
            f"{' or '.join(axis.levels[scale])}",
            **canvas.TITLE,
        )
        places["spectrum"].set_title("spectrum", **canvas.TITLE)
    figure.suptitle(f"{rating.record.name}: {rating.duration:.4g} s at {rating.record.rate:.5g} Hz")
    return figure


def _axis(rating: RecordRating, column: str | None) -> AxisRating:
    """The axis of a column."""
    for axis in rating.axes:
        if column is None or axis.axis.column == column:
            return axis
    known = ", ".join(axis.axis.column for axis in rating.axes)
    raise InputError(f"{rating.record.name}: column: found {column!r}; expected one of {known}")


def _draw_pieces(
    ax: Axes, rating: RecordRating, pieces: Sequence[FloatArray], colour: str, width: float,
    label: str, left_out: int = 0,
) -> None:  # fmt: skip
    """One line per piece, so that nothing is drawn over a gap; some first samples are left out."""
    for number, (start, piece) in enumerate(zip(rating.record.starts, pieces, strict=True)):
        time = start + np.arange(piece.size) / rating.record.rate
        ax.plot(*canvas.outline(time[left_out:], piece[left_out:]), color=colour, linewidth=width,
                label=label if number == 0 else "_")  # fmt: skip


def _over_time(ax: Axes, rating: RecordRating) -> None:
    record = rating.record
    ends = [s + n / record.rate for s, n in zip(record.starts, record.lengths, strict=True)]
    ax.set_xlim(record.starts[0], ends[-1])
    ax.set_xlabel("time [s]")
    canvas.tidy(ax)


def _density(pieces: Sequence[FloatArray], rate: float) -> tuple[FloatArray, FloatArray]:
    """Welch's one-sided density of pieces, each by its length; without what is at 0 Hz."""
    from scipy.signal import welch

    longest = max(piece.size for piece in pieces)
    segment = min(longest, round(rate / _RESOLVED))
    parts = [welch(p, rate, nperseg=segment) for p in pieces if p.size >= segment]
    sizes = [p.size for p in pieces if p.size >= segment]
    density = np.average([part[1] for part in parts], axis=0, weights=sizes)
    return parts[0][0][1:], density[1:]
