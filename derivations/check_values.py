r"""Comfort values of the paper's vehicle under any reading, all in one way.

Exact stochastic integral over 0.05-80 Hz on ERRI B176 low, full W_k, middle of the floor, polygon
reading, unless another is asked for; m/s², at 145 and 200 km/h.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np
from paper import SEEDS, SPEEDS_KMH, TRACK, coach

from railride import KMH, VehicleModel, derive_vehicle, ride, spectrum, weighting
from railride.markup import Table
from railride.stochastic import Process, process, weighted_rms_of_many

Array = np.ndarray[Any, np.dtype[Any]]
Pair = tuple[float, float]

RUNS = 12


def values(
    model: VehicleModel, *, floor: str = "polygon", weight: str = "Wk", at: float = 0.0,
    band: tuple[float, float] = (0.05, 80.0), **changes: float,
) -> Pair:  # fmt: skip
    """a_wrms at the paper's two speeds."""
    rows = model.output_rows([model.floor(at, floor)], **changes)
    a_w, _ = weighted_rms_of_many(
        model.matrices(**changes), rows, model.vehicle.wheelset_positions,
        [v * KMH for v in SPEEDS_KMH], spectrum(TRACK), weighting(weight), band,
    )  # fmt: skip
    return float(a_w[0, 0, 0]), float(a_w[0, 1, 0])


@cache
def base(flexible: bool) -> Pair:
    """The values that all others are compared with."""
    return values(coach(flexible))


@cache
def beam(modes: int = 10, damping: float = 0.0) -> VehicleModel:
    """The paper's vehicle with a free-free Euler-Bernoulli beam of the same 9.6 Hz for a body."""
    return derive_vehicle("cati2024", body="beam", modes=modes, bending_damping=damping)


def shown(pair: Pair) -> str:
    """As "0.2475 / 0.3275"."""
    return " / ".join(f"{value:.4f}" for value in pair)


def percent(value: float, digits: int = 1) -> str:
    """A fraction as "+39.1 %"; "0.0 %" has no sign."""
    text = f"{100 * value:+.{digits}f} %"
    return text[1:] if float(text[:-2]) == 0 else text.replace("-", "−")


def change(pair: Pair, flexible: bool = True) -> str:
    """A pair, and how far it is from the base: "0.1319 / 0.1779 (−47 % / −46 %)"."""
    moved = (percent(a / b - 1, 0) for a, b in zip(pair, base(flexible), strict=True))
    return f"{shown(pair)} ({' / '.join(moved)})"


def comfort_table(readings: Mapping[str, tuple[Pair | None, Pair | None]]) -> Table:
    """Reading → a_wrms of the rigid and of the flexible vehicle, as a table."""
    heads = ("rigid 145", "rigid 200", "flexible 145", "flexible 200")
    rows = [
        (name, *(cell for pair in pairs for cell in _cells(pair)))
        for name, pairs in readings.items()
    ]
    return Table(("a_wrms [m/s²]", *heads), rows, figures=heads)


def _cells(pair: Pair | None) -> tuple[str, str]:
    if pair is None:
        return "–", "–"
    return f"{pair[0]:.4f}", f"{pair[1]:.4f}"


def both(**changes: float) -> tuple[Pair, Pair]:
    """The rigid and the flexible vehicle with other parameters."""
    return values(coach(False), **changes), values(coach(), **changes)


def floor_process(model: VehicleModel, speed: float) -> Process:
    """The floor's acceleration at the middle as a stationary process; ``speed`` in m/s."""
    rows = model.output_rows([model.floor(0.0, "polygon")])
    places = model.vehicle.wheelset_positions
    return process(model.matrices(), rows, places, speed, spectrum(TRACK))


def mean_square(of: Process, power: Callable[[Array], Array]) -> float:
    """∫ power(f) S_a(f) df over the band of a process."""
    total = 0.0
    for _, f, df, _ in of.pieces():
        S = np.abs(of.response(f)[0]) ** 2 * of.elevation_density(f)
        total += float(np.sum(power(f) * S * df))
    return total


@cache
def runs(flexible: bool, seeds: int = RUNS) -> tuple[Array, Array]:
    """a_wrms and crest factor of time runs over 1 km: each (seeds, speeds)."""
    found = [
        ride(coach(flexible), TRACK, [v * KMH for v in SPEEDS_KMH], seed=seed, floor="polygon")
        for seed in SEEDS[:seeds]
    ]
    a_w = np.array([[case.a_wrms for case in one.cases] for one in found])
    return a_w, np.array([[case.crest_factor for case in one.cases] for one in found])
