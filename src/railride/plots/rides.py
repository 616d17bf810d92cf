"""Pictures of rides: the floor's acceleration over time, whole and for one second of it.

Source: as Figures 7 to 11 of Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from railride.errors import InputError
from railride.plots import canvas
from railride.plots.tracks import plot_track
from railride.track import Track

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railride.rides import Case, Record, RideResult

ZOOM = 1.0  # s
_ROOM = 0.35  # of the largest value, above it: the legend's place


def plot_acceleration(
    case: Case, *, ax: Axes | None = None, zoom: tuple[float, float] | None = None
) -> Axes:
    """Draw the floor's acceleration, m/s², over the rated section's time, s, weighted on top.

    case : with its record. zoom : from and to, s from where the rating begins, drawn alone.

    Raises InputError for a case without a record (``spectral``), and for a zoom that is none or
    holds fewer than two samples of the rated section.
    """
    _record_of(case)
    if zoom is not None:
        _check_zoom(case, zoom)
    ax = canvas.axes_or_new(ax, 7.0, 2.8)
    _draw_lines(case, ax, zoom)
    ax.set_title(_heading(case), **canvas.TITLE)
    ax.legend(loc="upper right", ncols=2, framealpha=0.9, edgecolor="none")
    return ax


def plot_ride(result: RideResult) -> Figure:
    """Draw every case in a row: its whole rated section, and 1 s about its largest weighted value.

    Raises InputError for a ride without a time run (``spectral``).
    """
    rows = len(result.cases)
    figure = canvas.new_figure(11.0, min(2.7 * rows + 0.4, canvas.TALLEST))
    pairs = figure.subplots(rows, 2, squeeze=False, sharey="row", width_ratios=(2, 1))
    for case, (left, right) in zip(result.cases, pairs, strict=True):
        _draw_case(case, left, right)
    figure.suptitle(
        f"{result.vehicle} ({result.body}) over {result.track}, {result.floor} floor, "
        f"{result.weighting} weighted"
    )
    return figure


def save_ride_plots(result: RideResult, folder: str | Path) -> list[Path]:
    """Draw track.png, a picture of each case and ride.png into a folder, made if need be.

    The cases' names tell speed and place: ``acceleration_145kmh_0m.png``. Returns the paths.

    Raises InputError where the folder cannot be made or written, and without a time run.
    """
    folder = Path(folder)
    track = track_of(result)
    figures: dict[str, Callable[[], Figure]] = {
        "track.png": partial(_track_figure, track),
    }
    for case in result.cases:
        name = f"acceleration_{_plain(3.6 * case.speed)}kmh_{_plain(case.position)}m.png"
        figures[name] = partial(_case_figure, case)
    figures["ride.png"] = partial(plot_ride, result)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise InputError(
            f"{str(folder)!r}: found that the folder cannot be made ({reason}); expected one that "
            "can (give another)"
        ) from None
    for name, draw in figures.items():
        canvas.save(draw(), folder / name)
    return [folder / name for name in figures]


def track_of(result: RideResult) -> Track:
    """The rated section's level as it was under the leading wheelset, of the first case.

    All cases run over the same track; distance is the track's own.
    """
    case = result.cases[0]
    record = _record_of(case)
    distance, level = record.distance[record.rated], record.elevation[record.rated]
    return Track(float(distance[0]), float(distance[1] - distance[0]), level, name=result.track)


def zoom_around_peak(case: Case, duration: float = ZOOM) -> tuple[float, float]:
    """From and to (s) of the ``duration`` about the largest weighted acceleration.

    Inside the rated section, which it is as a whole where that is shorter.
    """
    record = _record_of(case)
    time = record.time[record.rated]
    first, last = float(time[0]), float(time[-1])
    peak = float(time[np.argmax(np.abs(record.weighted[record.rated]))])
    start = max(first, min(peak - duration / 2, last - duration))
    return start, min(start + duration, last)


def _track_figure(track: Track) -> Figure:
    """The level alone, in a figure of its own."""
    figure = canvas.new_figure(7.0, 2.8)
    plot_track(track, ax=figure.add_subplot())
    return figure


def _case_figure(case: Case) -> Figure:
    """One case, whole and for one second, in a figure of its own."""
    figure = canvas.new_figure(11.0, 3.1)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(2, 1))
    _draw_case(case, left, right)
    return figure


def _draw_case(case: Case, left: Axes, right: Axes) -> None:
    """The whole rated section on the left, a second of it on the right; a scale for both."""
    zoom = zoom_around_peak(case)
    _draw_lines(case, right, zoom)  # the same lines as on the left, whose legend holds for both
    right.set_ylabel("")
    right.set_title(f"{zoom[1] - zoom[0]:.3g} s about the largest weighted", **canvas.TITLE)
    plot_acceleration(case, ax=left)  # last: the shared scale is the whole section's
    left.axvspan(*zoom, color=canvas.REST, alpha=0.35, linewidth=0, zorder=0)


def _draw_lines(case: Case, ax: Axes, zoom: tuple[float, float] | None) -> None:
    """Both accelerations and what belongs to the axes, the legend's place left free."""
    record = _record_of(case)
    time = record.time[record.rated]
    start, end = zoom or (float(time[0]), float(time[-1]))
    inside = (start <= time) & (time <= end)
    largest, width = 0.0, 1.4 if zoom else 0.9
    for values, colour, part, label in (
        (record.acceleration, canvas.ACCELERATION, 1.0, f"floor, r.m.s. {case.a_rms:.3f} m/s²"),
        (record.weighted, canvas.WEIGHTED, 0.6, f"weighted, r.m.s. {case.a_wrms:.3f} m/s²"),
    ):
        drawn = values[record.rated][inside]
        largest = max(largest, float(np.abs(drawn).max()))
        ax.plot(*canvas.outline(time[inside], drawn), color=colour, linewidth=part * width,
                label=label)  # fmt: skip
    ax.set_xlim(start, end)
    ax.set_ylim(-1.08 * (largest or 1.0), (1.08 + _ROOM) * (largest or 1.0))
    ax.set_xlabel("time [s]")
    ax.set_ylabel("acceleration [m/s²]")
    canvas.tidy(ax)


def _heading(case: Case) -> str:
    """Speed, place, and the weighted r.m.s. of the run beside the exact one."""
    text = f"{3.6 * case.speed:g} km/h, x = {case.position:g} m: a_wrms {case.a_wrms:.3f} m/s²"
    if case.a_wrms_exact is None:
        return text
    spread = "" if case.standard_error is None else f", one run ± {case.standard_error:.3f}"
    return f"{text} (exact {case.a_wrms_exact:.3f}{spread})"


def _record_of(case: Case) -> Record:
    if case.record is None:
        raise InputError(
            f"{3.6 * case.speed:g} km/h, {case.position:g} m: found values from the spectrum alone;"
            " expected a time run to draw (ride without spectral)"
        )
    return case.record


def _check_zoom(case: Case, zoom: tuple[float, float]) -> None:
    record = _record_of(case)
    time, (start, end) = record.time[record.rated], zoom
    if np.count_nonzero((start <= time) & (time <= end)) < 2 or not np.isfinite(end - start):
        raise InputError(
            f"zoom: found {start:g} to {end:g} s; expected two times, the earlier first, with at "
            f"least two samples between them in the rated section, {time[0]:g} to {time[-1]:.6g} s"
        )


def _plain(value: float) -> str:
    """A number for a file's name: no exponent, no needless digits, never -0."""
    return f"{round(value, 6) + 0.0:.6f}".rstrip("0").rstrip(".")
