"""What a change of each parameter does to the weighted r.m.s.: values found anew, not gradients."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.numeric import Array
from railride.spectra import Spectrum
from railride.stochastic.ride import floor_in_hand, weighted_rms_of_many
from railride.vehicle import VehicleModel
from railride.weightings import Weighting


@dataclass(frozen=True)
class Ride:
    """What the weighted r.m.s. is of: speeds, m/s, a track, points of the floor, a weighting."""

    speeds: Sequence[float]
    spectrum: Spectrum
    at: Sequence[float]
    floor: str
    weight: Weighting
    band: tuple[float, float]


def changed_rms(
    model: VehicleModel, ride: Ride, designs: Sequence[Mapping[str, float]]
) -> tuple[Array, list[str]]:
    """a_wrms of changed vehicles, (designs, speeds, positions), and why any has no value.

    designs : their values of the same parameters. All at once where they have the same wheelset
    places; one that cannot be has NaN.
    """
    values = np.full((len(designs), len(ride.speeds), len(ride.at)), np.nan)
    problems = [""] * len(designs)
    groups: dict[tuple[float, ...], list[int]] = {}
    for k, design in enumerate(designs):
        try:
            places = tuple(model.wheelset_places(**design).tolist())
        except InputError as error:
            problems[k] = str(error)
        else:
            groups.setdefault(places, []).append(k)
    for places, members in groups.items():
        try:
            values[members] = _together(model, ride, [designs[k] for k in members], places)
        except InputError:  # of one of them
            for k in members:
                try:
                    values[k] = _together(model, ride, [designs[k]], places)[0]
                except InputError as error:
                    problems[k] = str(error)
    for k in np.flatnonzero(np.isnan(values).any(axis=(1, 2))).tolist():
        problems[k] = problems[k] or "it is unstable, or an undamped mode is felt"
    return values, problems


def _together(
    model: VehicleModel, ride: Ride, designs: Sequence[Mapping[str, float]],
    places: Sequence[float],
) -> Array:  # fmt: skip
    """a_wrms of vehicles with the same wheelset places."""
    changes: dict[str, ArrayLike] = {
        name: np.array([design[name] for design in designs]) for name in designs[0]
    }
    m, rows = floor_in_hand(model, ride.at, ride.floor, changes)
    rms, _ = weighted_rms_of_many(m, rows, places, ride.speeds, ride.spectrum, ride.weight,
                                  ride.band)  # fmt: skip
    return rms
