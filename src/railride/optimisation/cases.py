"""What is ridden while a vehicle is optimised: tracks, speeds and points of the floor."""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from railride.designs.given import Cases, Tracks, given_cases
from railride.spectra import Spectrum
from railride.vehicle import VehicleModel
from railride.weightings import Weighting


def cases_of(
    model: VehicleModel, tracks: Tracks | Sequence[Tracks], speeds: ArrayLike,
    at: ArrayLike = (0.0,), floor: str = "smooth", weight: str | Weighting = "Wk",
) -> Cases:  # fmt: skip
    """The cases of a call, their points on the model's body.

    Raises
    ------
    InputError : a track that has no spectrum; a speed ≤ 0; a point off the body; another floor or
        weighting than there are; none of something, or one twice.
    """
    cases = given_cases(tracks, speeds, at, floor, weight, ("a_wrms",))
    for x in cases.positions:
        model.floor(x, floor, derivative=0)
    return cases


def runs(cases: Cases) -> list[tuple[Spectrum, float]]:
    """Every track with every speed."""
    return [(track, speed) for track in cases.tracks for speed in cases.speeds]


def cases_named(cases: Cases) -> list[tuple[str, float, float]]:
    """Every case: the track's name, speed and position."""
    return [(track.name, speed, x) for track, speed in runs(cases) for x in cases.positions]


def run_name(track: Spectrum, speed: float) -> str:
    """A run in a few words: "erri_low, 145 km/h"."""
    return f"{track.name}, {3.6 * speed:.6g} km/h"
