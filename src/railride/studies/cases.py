"""What is ridden in a study: the table ``[ride]``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from railride.bodies.base import FLOORS
from railride.designs import RESULTS
from railride.errors import InputError
from railride.files import there
from railride.spectra import Spectrum, is_file, spectrum_names
from railride.toml_tables import Table
from railride.track import Track
from railride.trackfile import load_track
from railride.weightings import weighting

T = TypeVar("T")


@dataclass(frozen=True)
class RideCases:
    """Every track at every speed (m/s), the floor felt at every position (m forward of the middle).

    floor : how it is read. weight : the weighting's name. results : names of what is asked for.
    files : the file of each track; None for a spectrum that ships with the program.
    """

    tracks: tuple[Spectrum | Track, ...]
    speeds: tuple[float, ...]
    positions: tuple[float, ...] = (0.0,)
    floor: str = "smooth"
    weight: str = "Wk"
    results: tuple[str, ...] = ("a_wrms",)
    files: tuple[Path | None, ...] = (None,)


def read_ride(table: Table, folder: Path) -> RideCases | None:
    """The cases of the table; None, with the faults noted, where they cannot be made.

    folder : from which files of tracks are named.
    """
    before = len(table.faults.found)
    table.missing("speeds", 'speeds = ["number km/h", …]')
    speeds = _each_once(table, "speeds", table.quantities("speeds", "km/h", "> 0"))
    positions = _each_once(table, "positions", table.quantities("positions", "m"), (0.0,))
    names = _each_once(table, "tracks", table.texts("tracks"), ("erri_low",))
    results = _each_once(table, "results", table.choices("results", RESULTS), ("a_wrms",))
    floor = table.choice("floor", FLOORS) or "smooth"
    weight = table.text("weighting") or "Wk"
    try:
        weighting(weight)
    except InputError as error:
        table.faults.include(table.key("weighting"), error)
    extrapolate = table.flag("extrapolate") or False
    tracks, files = _read_tracks(table, names, folder, extrapolate)
    table.finish()
    if len(table.faults.found) > before:
        return None
    return RideCases(tracks, speeds, positions, floor, weight, results, files)


def _each_once(
    table: Table, name: str, values: tuple[T, ...] | None, default: tuple[T, ...] = ()
) -> tuple[T, ...]:
    """The values of a list, none of them twice; ``default`` where it is absent."""
    if name not in table:
        return default
    if table.content[name] == []:
        table.fault(name, "an empty list", "at least one value")
    for place, value in enumerate(values or ()):
        if value in (values or ())[:place]:
            text = table.content[name][place]
            table.fault(f"{name}[{place + 1}]", f"{text!r} again", "each value once")
    return values or default


def _read_tracks(
    table: Table, names: Sequence[str], folder: Path, extrapolate: bool
) -> tuple[tuple[Spectrum | Track, ...], tuple[Path | None, ...]]:
    """Tracks by name or file, and their files."""
    tracks: list[Spectrum | Track] = []
    files: list[Path | None] = []
    for place, name in enumerate(names, start=1):
        path = folder / name
        shipped = name in spectrum_names() or not (is_file(name) or there(path))
        try:
            source = load_track(name if shipped else path)
        except InputError as error:
            table.faults.include(table.key(f"tracks[{place}]"), error)
            continue
        if extrapolate and isinstance(source, Spectrum):
            source = source.extrapolated()
        tracks.append(source)
        files.append(None if shipped else path)
    return tuple(tracks), tuple(files)
