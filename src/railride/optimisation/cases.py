"""What is ridden while a vehicle is optimised: tracks, speeds and points of the floor."""

from __future__ import annotations

from railride.designs.given import Cases
from railride.quantities import in_kmh
from railride.spectra import Spectrum


def runs(cases: Cases) -> list[tuple[Spectrum, float]]:
    """Every track with every speed."""
    return [(track, speed) for track in cases.tracks for speed in cases.speeds]


def cases_named(cases: Cases) -> list[tuple[str, float, float]]:
    """Every case: the track's name, speed and position."""
    return [(track.name, speed, x) for track, speed in runs(cases) for x in cases.positions]


def run_name(track: Spectrum, speed: float) -> str:
    """A run in a few words: "erri_low, 145 km/h"."""
    return f"{track.name}, {in_kmh(speed)}"
