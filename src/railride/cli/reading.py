"""The options that say how the file of a measured track is to be read."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli.options import TRACK, Arguments

if TYPE_CHECKING:
    from railride.spectra import Spectrum
    from railride.track import Track

DistanceOption = Annotated[
    str | None, typer.Option("--distance-column", metavar="NAME", rich_help_panel=TRACK,
                             help="Of a file: the column of the distances, by its heading or a "
                             "part of it.")]  # fmt: skip
LevelOption = Annotated[
    list[str] | None,
    typer.Option("--level-column", metavar="NAME", rich_help_panel=TRACK,
                 help="Of a file: the column of the longitudinal level; twice for the left and the "
                 "right rail, whose mean is taken.")]  # fmt: skip
DistanceUnitOption = Annotated[
    str | None, typer.Option("--distance-unit", metavar="UNIT", rich_help_panel=TRACK,
                             help="Where the heading has none: m, km.")]  # fmt: skip
LevelUnitOption = Annotated[
    str | None, typer.Option("--level-unit", metavar="UNIT", rich_help_panel=TRACK,
                             help="Where the heading has none: mm, cm, m.")]  # fmt: skip
FillOption = Annotated[
    str | None, typer.Option("--fill", metavar="M", rich_help_panel=TRACK,
                             help="Of a file: bridge dropouts of up to so many metres.")
]  # fmt: skip
ReverseOption = Annotated[
    bool, typer.Option("--reverse", rich_help_panel=TRACK,
                       help="Of a file: run the track from its end to its start.")]  # fmt: skip
StepOption = Annotated[
    str | None, typer.Option("--step", metavar="M", rich_help_panel=TRACK,
                             help="Of a file: from row to row, in place of its distances.")
]  # fmt: skip


@dataclass(frozen=True)
class Reading:
    """How the file of a track is to be read; the step of the rows is an option of its own."""

    distance_column: DistanceOption = None
    level_column: LevelOption = None
    distance_unit: DistanceUnitOption = None
    level_unit: LevelUnitOption = None
    fill: FillOption = None
    reverse: ReverseOption = False

    def options(self) -> list[str]:
        """Names of the options that were given."""
        return [f"--{name.replace('_', '-')}" for name, value in vars(self).items() if value]

    def arguments(self, given: Arguments, step: str | None = None) -> dict[str, Any]:
        """What was given as arguments of :func:`railride.read_track`; faults go into ``given``."""
        fill = given.number("--fill", self.fill, "m")
        if fill is not None and fill < 0.0:
            given.faults.add("--fill", repr(self.fill), "a length of 0 or more, in m or with its "
                             "unit")  # fmt: skip
        if self.level_column is not None and len(self.level_column) > 2:
            given.faults.add("--level-column", f"{len(self.level_column)} of them", "one, or those "
                             "of the left and the right rail")  # fmt: skip
        values = {
            "distance": self.distance_column,
            "level": self.level_column,
            "distance_unit": self.distance_unit,
            "level_unit": self.level_unit,
            "step": given.positive("--step", step, "m"),
            "fill": fill,
            "reverse": self.reverse,
        }
        return {name: value for name, value in values.items() if value}


@dataclass(frozen=True)
class FileReading(Reading):
    """How the file of a track is to be read, where no other option says a step."""

    step: StepOption = None

    def of(self, given: Arguments, track: str) -> dict[str, Any]:
        """What was given for ``track``, the name of a spectrum or of a file."""
        from railride.spectra import is_file

        if self.options() and not is_file(track):
            given.conflict(self.options()[0], f"the spectrum {track!r}",
                           "it is for the file of a measured track")  # fmt: skip
        return self.arguments(given, self.step)


def chosen_track(track: str, extrapolate: bool, reading: dict[str, Any]) -> Spectrum | Track:
    """The track by its name or file; a spectrum continued beyond its band where that is asked."""
    from railride.spectra import Spectrum
    from railride.trackfile import load_track

    source = load_track(track, **reading)
    return source.extrapolated() if extrapolate and isinstance(source, Spectrum) else source
