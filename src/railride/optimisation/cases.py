"""What is ridden while a vehicle is optimised: tracks, speeds and points of the floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from railride.errors import InputError
from railride.quantities import several
from railride.spectra import Spectrum
from railride.stochastic import track_spectrum
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

Source = str | Path | Spectrum | Track


@dataclass(frozen=True)
class Cases:
    """Every track at every speed (m/s), felt at every position (m): in this order.

    floor : how it is read. weight : of the floor's acceleration. remarks : of the tracks.
    """

    tracks: tuple[Spectrum, ...]
    speeds: tuple[float, ...]
    positions: tuple[float, ...]
    floor: str
    weight: Weighting
    remarks: tuple[str, ...] = ()

    @classmethod
    def of(
        cls, model: VehicleModel, tracks: Source | Sequence[Source],
        speeds: float | Sequence[float], at: float | Sequence[float] = (0.0,),
        floor: str = "smooth", weight: str | Weighting = "Wk",
    ) -> Cases:  # fmt: skip
        """Cases as a call gives them, one or several of each.

        Raises
        ------
        InputError : a track that has no spectrum; a speed ≤ 0; a point off the body; another floor
            or weighting than there are; none of something.
        """
        sources = [tracks] if isinstance(tracks, str | Path | Spectrum | Track) else list(tracks)
        speeds, positions = several(speeds, "speeds", "m/s"), several(at, "at", "m")
        for name, given in (("track", sources), ("speeds", speeds), ("at", positions)):
            if not given:
                raise InputError(f"{name}: found none; expected at least one")
        for x in positions:
            model.floor(x, floor)
        found = [track_spectrum(source, speeds) for source in sources]
        said = [remark for _, remarks in found for remark in remarks]
        return cls(tuple(spectrum for spectrum, _ in found), tuple(speeds), tuple(positions), floor,
                   weighting(weight), tuple(dict.fromkeys(said)))  # fmt: skip

    @property
    def runs(self) -> list[tuple[Spectrum, float]]:
        """Every track with every speed."""
        return [(track, speed) for track in self.tracks for speed in self.speeds]

    @property
    def named(self) -> list[tuple[str, float, float]]:
        """Every case: the track's name, speed and position."""
        return [(track.name, speed, x) for track, speed in self.runs for x in self.positions]


def run_name(track: Spectrum, speed: float) -> str:
    """A run in a few words: "erri_low, 145 km/h"."""
    return f"{track.name}, {3.6 * speed:.6g} km/h"
