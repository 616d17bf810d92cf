"""What designs are evaluated, and over which rides: taken from the caller, and checked."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.numeric import Array
from railride.quantities import names, several
from railride.spectra import Spectrum
from railride.stochastic import track_spectrum
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

T = TypeVar("T", bound=Hashable)

RESULTS = ("a_wrms", "a_rms", "wz", "travel", "wheel_loads", "modes", "static")
Tracks = str | Path | Spectrum | Track


@dataclass(frozen=True)
class Cases:
    """Every track at every speed (m/s), the floor felt at every position (m forward of the middle).

    remarks : what to know of the tracks.
    """

    tracks: tuple[Spectrum, ...]
    speeds: tuple[float, ...]
    positions: tuple[float, ...]
    floor: str
    weight: Weighting
    results: tuple[str, ...]
    remarks: tuple[str, ...]


def given_cases(
    model: VehicleModel,
    tracks: Tracks | Sequence[Tracks],
    speeds: ArrayLike,
    at: ArrayLike = (0.0,),
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    results: str | Sequence[str] = ("a_wrms",),
) -> Cases:
    """The cases; arguments and errors as for :func:`railride.designs.evaluate_designs`."""
    wanted = _each_once(names(results, "results"), "results")
    unknown = [name for name in wanted if name not in RESULTS]
    if unknown:
        raise InputError(f"results: found {', '.join(map(repr, unknown))}; expected some of "
                         f"{', '.join(RESULTS)}")  # fmt: skip
    V = _each_once(several(speeds, "speeds", "m/s"), "speeds")
    places = _each_once(several(at, "at", "m"), "at")
    for x in places:
        model.floor(x, floor, derivative=0)
    if isinstance(tracks, str | Path | Spectrum | Track):
        listed = [tracks]
    else:
        listed = names(tracks, "tracks")
    found = [track_spectrum(track, V) for track in listed]
    _each_once([spectrum.name for spectrum, _ in found], "tracks")
    said = dict.fromkeys(remark for _, remarks in found for remark in remarks)
    spectra = tuple(spectrum for spectrum, _ in found)
    return Cases(spectra, V, places, floor, weighting(weight), wanted, tuple(said))


def given_designs(
    model: VehicleModel, designs: Mapping[str, ArrayLike] | pd.DataFrame
) -> dict[str, Array]:
    """Values (D,) by the names as they were given.

    Raises
    ------
    InputError : a name that the model does not have, or two for one parameter; values that are no
        numbers, in no list, of different lengths; no designs at all.
    """
    if not hasattr(designs, "items"):
        raise InputError(f"designs: found {type(designs).__name__}; expected a table or dictionary "
                         "of parameters' names and values")  # fmt: skip
    given = {str(name): _numbers(str(name), values) for name, values in designs.items()}
    symbols: dict[str, str] = {}
    for name in given:
        symbol = model.symbol_of(name)
        if symbol in symbols:
            raise InputError(f"designs: found both {symbols[symbol]} and {name}; expected one of "
                             f"them, they are both {symbol}")  # fmt: skip
        symbols[symbol] = name
    lengths = {name: values.size for name, values in given.items() if values.ndim}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{count} of {name}" for name, count in lengths.items())
        raise InputError(f"designs: found {listed}; expected as many of each")
    count = max(lengths.values(), default=1)
    if not count:
        raise InputError("designs: found none; expected at least one")
    return {name: np.broadcast_to(values, (count,)) for name, values in given.items()}


def _numbers(name: str, values: ArrayLike) -> Array:
    try:
        found = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"designs: found {values!r} for {name}; expected numbers in SI units"
        ) from None
    if found.ndim > 1:
        raise InputError(f"designs: found an array of shape {found.shape} for {name}; expected a "
                         "list, one number for each design")  # fmt: skip
    return found


def _each_once(values: Sequence[T], where: str) -> tuple[T, ...]:
    twice = list(dict.fromkeys(value for value in values if values.count(value) > 1))
    if twice or not values:
        found = f"{', '.join(map(str, twice))} twice" if twice else "none"
        raise InputError(f"{where}: found {found}; expected at least one, and each once")
    return tuple(values)
