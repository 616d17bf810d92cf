"""From a file to a track: its columns, their metres, an even grid, and all that is doubtful."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from railride.errors import Faults, InputError, RowFaults
from railride.spectra import FloatArray, Spectrum, holds_spectrum, is_file, spectrum, spectrum_of
from railride.tables import NumberTable, read_table
from railride.track import Track
from railride.trackfile.columns import Asked, Chosen, choose
from railride.trackfile.headings import BANDS
from railride.trackfile.levels import check_departure, doubts, levels_of
from railride.trackfile.limits import shown_band
from railride.trackfile.locations import locations
from railride.trackfile.spacing import Spacing, on_even_grid, spaced, stepped

FEWEST_ROWS = 8


def read_track(
    path: str | Path,
    *,
    distance: str | None = None,
    level: str | Sequence[str] = (),
    distance_unit: str | None = None,
    level_unit: str | None = None,
    step: float | None = None,
    fill: float = 0.0,
    reverse: bool = False,
) -> Track:
    """Read a measured track from text, Parquet, WAV, MATLAB or HDF5 (:mod:`railride.tables`).

    ``path``: the file. ``distance``: heading of its distances, in metres or kilometres or as
    kilometre and metre (``130+0100.25``); ``level``: heading of the longitudinal level, or those of
    the two rails, whose mean is taken. Part of a heading will do. Both are found by themselves
    where the headings are known ones, left and right too; chord offsets (versines) are told apart
    and refused. ``distance_unit``, ``level_unit``: where the headings have none (``"mm"``).
    ``step``: m, from row to row, in place of the distances but the first. ``fill``: m, the longest
    dropout (blank, ``inv``, zeros) to be bridged; none by default. ``reverse``: run it from its end
    to its start (:meth:`railride.track.Track.reversed`).

    Distances that fall throughout are run as they were recorded, with a minus sign. Small
    unevenness counts as rounding, steps of half to one and a half times the median are resampled by
    a spline. A level headed D1, D2 or D3 gives the track that band, and so does a level whose
    spectrum is zero beyond one, as that of a track made from a spectrum. The track's ``remarks``
    tell of all this, of dropouts and spikes that are kept, counters of kilometres that were set
    right, and a level that looks a thousand times too large or too small, or lies far from zero.

    Raises InputError naming row and column: what :func:`railride.tables.read_table` raises; columns
    missing, several or without a unit; fewer than 8 rows; text, blank cells, NaN or infinity among
    the numbers; distances that turn back, stand still or leave a gap; a level that departs by more
    than a metre from a straight line.
    """
    asked = Asked(distance, level, distance_unit, level_unit, step, fill, reverse)
    return _track(read_table(path), asked)


def load_track(track: str | Path | Spectrum | Track, **reading: Any) -> Spectrum | Track:
    """A spectrum by its name or file, or a measured track by its file; what is one stays as it is.

    ``track``: the columns of a file say whether it holds a spectrum or a track. ``reading``: how a
    track file is to be read, as in :func:`read_track`.

    Raises InputError for a name that is no spectrum's, a file that cannot be used, and ``reading``
    for what is no track file.
    """
    found: Spectrum | Track
    if isinstance(track, Spectrum | Track):
        found = track
    elif not isinstance(track, str | Path):
        raise InputError(f"track: found {track!r}; expected the name of a spectrum, a file, a "
                         "Spectrum or a Track")  # fmt: skip
    elif is_file(track):
        table = read_table(track)
        if not holds_spectrum(table):
            return _track(table, Asked(**reading))
        found = spectrum_of(table)
    else:
        found = spectrum(track)
    if reading:
        raise InputError(
            f"track {found.name}: found {', '.join(reading)} for it; expected that for the file of "
            "a measured track alone (leave it out)"
        )
    return found


def _track(table: NumberTable, asked: Asked) -> Track:
    """The track that a table holds."""
    faults = Faults(table.source)
    if holds_spectrum(table) and not asked.levels:
        faults.add("columns", "a spectrum, densities over wavenumbers or wavelengths",
                   "a level over distance", "to make a track from it, --spectrum FILE")  # fmt: skip
        faults.raise_if_any()
    chosen, bad = choose(table, asked, faults), RowFaults(faults)
    spacing = _spacing(table, chosen, asked, bad)
    usual, remarks = spacing.usual or 1.0, [*table.remarks, *chosen.remarks, *spacing.remarks]
    sides = []
    for column, metres in zip(chosen.levels, chosen.level_metres, strict=True):
        side, said = levels_of(table, column, metres, usual, asked.fill, bad)
        sides.append(side)
        remarks += said
    bad.close()
    if bad.count == 0 and table.n < FEWEST_ROWS:
        below = f"below row {table.header_row}" if table.header_row else "rows"
        faults.add(below, f"{table.n} rows of numbers", f"at least {FEWEST_ROWS}")
    faults.raise_if_any()
    level = sides[0] if len(sides) == 1 else np.asarray(np.mean(sides, axis=0))
    check_departure(table, chosen.levels[0], level, faults)
    step, even, said = asked.step, level, []
    if step is None:
        step, even, said = on_even_grid(table, spacing.distance, level)
    band, on_band = _band(chosen, even, step)
    remarks += [*said, *doubts(table, chosen.levels[0], level, step), *on_band]
    name = Path(table.source).name
    found = Track(
        distance0=float(spacing.distance[0]),
        step=step,
        level=even,
        name=name,
        source=table.source,
        band=band,
        remarks=tuple(f"{name}: {remark}" for remark in remarks),
    )
    return found.reversed() if asked.reverse else found


def _spacing(table: NumberTable, chosen: Chosen, asked: Asked, bad: RowFaults) -> Spacing:
    """Where the rows are: by their distances, or as far apart as the user says."""
    column = chosen.distance
    found = None if column is None else locations(table, column, chosen.distance_metres, bad)
    if asked.step is not None or found is None or column is None:
        return stepped(table, found, column, asked.step or 1.0)
    return spaced(table, found, column, bad)


def _band(
    chosen: Chosen, level: FloatArray, step: float
) -> tuple[tuple[float, float] | None, list[str]]:
    """The band that the heading names, or else that the level shows, and a remark on it."""
    if chosen.band in BANDS:
        return BANDS[chosen.band], []
    if chosen.band:
        return None, [
            f"which wavelengths the band {chosen.band} holds is not known: others are missing"
        ]
    shown = shown_band(level, step)
    if shown is None:
        return None, []
    low, high = shown
    remark = f"only wavelengths of {low:.4g} to {high:.4g} m: its spectrum is zero beyond them"
    return shown, [f"the level holds {remark}"]
