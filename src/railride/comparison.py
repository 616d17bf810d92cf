"""Car bodies side by side: one vehicle over one track, with every way to make its body.

Each is measured against the converged beam, one of so many modes that more would change nothing; of
a body that no uniform beam is, against finite elements of as many, its modes from outside, or the
finest segments. What cannot be made of a vehicle is left out, with the reason.

Source: the question of Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848, Section 1: how
accurate assembled rigid bodies are beside a free-free beam and finite elements, and at what cost.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.bodies.choice import KINDS, MODAL
from railride.errors import InputError
from railride.modal import modes
from railride.numeric import Array
from railride.parameters import Vehicle, load_vehicle
from railride.ridden import ridden_track
from railride.rides import PAPER_SPEEDS, RATE
from railride.spectra import Spectrum
from railride.stochastic import stochastic_ride, track_spectrum
from railride.timerun import time_run
from railride.track import Track
from railride.trackfile import load_track
from railride.vehicle import VehicleModel, derive_vehicle
from railride.weightings import weighting

if TYPE_CHECKING:
    import pandas as pd

SEGMENTS = (1, 2, 3, 4, 6, 8, 16)
MODES = (1, 2, 3, 5, 10)
CONVERGED = 30  # modes of the beam that all are measured against
FINEST = 32  # segments, where neither a beam nor finite elements can be made
SHOWN = 3  # bending frequencies
Make = dict[str, Any]  # arguments of derive_vehicle that say which body is made
RUN = 1000.0  # m, of the run that is timed


@dataclass(frozen=True, eq=False)
class ComparedBody:
    """One body under the vehicle: what it has, gives and costs.

    body : its kind. segments, modes : as many as it is made of, None of another kind.
    dof : coordinates of the vehicle. free_hz (≤ 3,) : first bending frequencies of the body free in
    space, vehicle_hz (≤ 3,) : on its suspension, |λ|/2π. a_wrms (speeds, positions) : m/s², exact.
    error : relative to the converged beam. derive_s, simulate_s : s, to derive it and to run it
    over a kilometre at the first speed. remarks : of the model and of its exact values.
    """

    body: str
    segments: int | None
    modes: int | None
    dof: int
    free_hz: Array
    vehicle_hz: Array
    a_wrms: Array
    error: Array
    derive_s: float
    simulate_s: float
    remarks: tuple[str, ...] = ()

    @property
    def title(self) -> str:
        """What it is, in a few words."""
        if self.body == "rigid":
            return "rigid"
        modes = f"{self.modes} mode" + ("s" if self.modes != 1 else "")
        return f"{self.segments} segments" if self.segments else f"{self.body}, {modes}"


@dataclass(frozen=True, eq=False)
class Comparison:
    """All bodies of a comparison, at ``speeds`` (m/s) and ``positions`` (m), and the reference."""

    vehicle: str
    track: str
    floor: str
    speeds: tuple[float, ...]
    positions: tuple[float, ...]
    bodies: tuple[ComparedBody, ...]
    reference: ComparedBody
    remarks: tuple[str, ...] = ()

    def table(self) -> pd.DataFrame:
        """One row per body, speed and position; the units in the column names."""
        import pandas as pd

        return pd.DataFrame(
            [
                {
                    "body": one.title,
                    "degrees of freedom": one.dof,
                    **{f"bending {k + 1} [Hz]": _entry(one.free_hz, k) for k in range(SHOWN)},
                    **{f"bending {k + 1} on suspension [Hz]": _entry(one.vehicle_hz, k)
                       for k in range(SHOWN)},
                    "speed [km/h]": round(3.6 * speed, 9),
                    "position [m]": x,
                    "a_wrms [m/s^2]": one.a_wrms[i, j],
                    "error": one.error[i, j],
                    "derive [s]": one.derive_s,
                    "simulate [s]": one.simulate_s,
                }
                for one in self.bodies
                for i, speed in enumerate(self.speeds)
                for j, x in enumerate(self.positions)
            ]
        )  # fmt: skip

    def _repr_html_(self) -> str:
        return str(self.table().to_html(index=False, float_format="%.4g", na_rep=""))


def compare_bodies(
    vehicle: Vehicle | str | Path,
    track: str | Path | Spectrum | Track = "erri_low",
    speeds: Sequence[float] = PAPER_SPEEDS,
    *,
    at: Sequence[float] | None = None,
    segments: Sequence[int] = SEGMENTS,
    beams: Sequence[int] = MODES,
    elements: Sequence[int] = (),
    floor: str = "smooth",
    bending_frequency: float | None = None,
    bending_damping: float | None = None,
    progress: Callable[[float], Any] | None = None,
) -> Comparison:
    """Compare car bodies of one vehicle: frequencies, exact comfort values, cost.

    Parameters
    ----------
    vehicle : the parameters, or the name of a shipped vehicle or a file.
    track : a spectrum or its name, or a measured track or its file (its Welch spectrum).
    speeds : m/s, each > 0. at : points of the floor, m forward of the middle; default the middle,
        over every bogie, and both ends.
    segments : numbers of rigid segments, 1 for the rigid body. beams, elements : numbers of modes
        of beams and of finite-element bodies.
    floor : "smooth", "polygon" or "spline". bending_frequency : Hz, bending_damping : a ratio, in
        place of the vehicle's. progress : called with the fraction done.

    Raises
    ------
    InputError : as :func:`stochastic_ride`; no body at all that can be made of the vehicle.

    Examples
    --------
    >>> found = compare_bodies("cati2024", at=[0.0], segments=[4, 8], beams=[10])
    >>> [one.title for one in found.bodies]
    ['4 segments', '8 segments', 'beam, 10 modes']
    >>> bool((abs(found.bodies[0].error) < 0.01).all())
    True
    """
    vehicle = vehicle if isinstance(vehicle, Vehicle) else load_vehicle(vehicle)
    makes: list[Make] = [
        *({"segments": n} for n in segments),
        *({"body": "beam", "modes": n} for n in beams),
        *({"body": "fe", "modes": n} for n in elements),
    ]
    if not makes or not speeds:
        raise InputError("compare: found no bodies or no speeds; expected at least one of each")
    places = tuple(_usual_places(vehicle) if at is None else map(float, at))
    source = load_track(track)
    spectrum, said = track_spectrum(source)
    road = ridden_track(source, speeds, RUN, 1)
    damping = {"bending_damping": bending_damping}
    reference, model = _reference(vehicle, bending_frequency, damping)
    if vehicle.body.mode_files is not None:  # others are compared at its own first frequency
        bending_frequency = float(model.bending_frequencies()[0])
    found = [_felt(model, reference, spectrum, speeds, places, floor, road)]
    remarks = [*said, *found[0].remarks]
    for number, make in enumerate(makes, start=1):
        try:
            derived, model = _made(vehicle, make, bending_frequency, damping)
        except InputError as fault:
            remarks.append(f"left out: {_named(make)}: {fault}")
        else:
            found.append(_felt(model, derived, spectrum, speeds, places, floor, road, found[0]))
            remarks += found[-1].remarks
        if progress is not None:
            progress(number / len(makes))
    if len(found) == 1:
        raise InputError("compare: found no body that can be made of it:\n" + "\n".join(remarks))
    return Comparison(vehicle.name, source.name, floor, tuple(speeds), places, tuple(found[1:]),
                      found[0], tuple(_once(remarks)))  # fmt: skip


def _made(
    vehicle: Vehicle, make: Make, frequency: float | None, damping: dict[str, Any]
) -> tuple[float, VehicleModel]:
    """A vehicle derived and turned into numbers, and how many seconds that took."""
    started = perf_counter()
    own = _own_frequency(vehicle, make, frequency)
    model = derive_vehicle(vehicle, **make, bending_frequency=own, **damping)
    model.matrices()
    return perf_counter() - started, model


def _own_frequency(vehicle: Vehicle, make: Make, frequency: float | None) -> float | None:
    """What is to be given to a body in place of the vehicle's bending frequencies.

    Rigid bodies and modes from outside take none; of several frequencies, which segments meet,
    beams and finite elements take the first.
    """
    several = vehicle.body.bending_frequencies
    if make.get("segments") == 1 or (
        make.get("body") == "fe" and vehicle.body.mode_files is not None
    ):
        return None
    if frequency is None and several and make.get("body") in MODAL:
        return several[0]
    return frequency


def _reference(
    vehicle: Vehicle, frequency: float | None, damping: dict[str, Any]
) -> tuple[float, VehicleModel]:
    """What all are measured against: the first of these that can be made.

    A body from outside as it is; a beam; finite elements; the finest segments.

    Raises InputError with what is wrong with each where none can be.
    """
    usual: list[Make] = [
        {"body": "beam", "modes": CONVERGED},
        {"body": "fe", "modes": CONVERGED},
        {"segments": FINEST},
        {"body": "segments"},
    ]
    own: list[Make] = [{"body": "fe"}] if vehicle.body.mode_files is not None else []
    faults = []
    for make in [*own, *usual]:
        try:
            return _made(vehicle, make, frequency, damping)
        except InputError as fault:
            faults.append(f"{_named(make)}: {fault}")
    raise InputError(
        f"{vehicle.name}: found no flexible body to compare with; expected one that can be made "
        "(give --bending-frequency where none is known):\n" + "\n".join(faults)
    )


def _named(make: Make) -> str:
    """A body that was to be made, in a few words."""
    if "modes" in make:
        return f"{make['body']} of {make['modes']} modes"
    return f"{make['segments']} segments" if "segments" in make else f"body {make['body']}"


def _once(remarks: Sequence[str]) -> list[str]:
    """Remarks that say the same of other numbers of segments, said of the first alone."""
    said = {re.sub(r"\b\d+ ", "", remark): remark for remark in reversed(remarks)}
    return list(said.values())[::-1]


def available_elements(counts: Sequence[int]) -> tuple[int, ...]:
    """Numbers of modes of finite-element bodies to compare: none where their library is missing.

    counts : those that are wanted.
    """
    from importlib.util import find_spec

    return tuple(counts) if "fe" in KINDS and find_spec("skfem") else ()


def _usual_places(vehicle: Vehicle) -> list[float]:
    """The middle, over every bogie, and both ends."""
    half = vehicle.body.length / 2
    return [0.0, *(bogie.position for bogie in vehicle.bogies), half, -half]


def _felt(
    model: VehicleModel, derived: float, spectrum: Spectrum, speeds: Sequence[float],
    places: Sequence[float], floor: str, road: Track, reference: ComparedBody | None = None,
) -> ComparedBody:  # fmt: skip
    """What a body gives, against the reference, which is measured against itself."""
    values = [stochastic_ride(model, v, spectrum, places, floor=floor) for v in speeds]
    a_wrms = np.array([value.a_wrms for value in values])
    named = {mode.label: mode.frequency_hz for mode in modes(model)}
    bending = [named[f"bending {k}"] for k in range(1, SHOWN + 1) if f"bending {k}" in named]
    return ComparedBody(
        model.body.kind,
        model.body.segments,
        model.body.mode_count,
        len(model.lagrangian.coordinates),
        model.bending_frequencies()[:SHOWN],
        np.array(bending),
        a_wrms,
        a_wrms / (a_wrms if reference is None else reference.a_wrms) - 1,
        derived,
        _run_time(model, road, speeds[0], places, floor),
        (*model.vehicle.remarks, *model.remarks, *(said for v in values for said in v.remarks)),
    )


def _run_time(
    model: VehicleModel, road: Track, speed: float, places: Sequence[float], floor: str
) -> float:
    """Seconds that one run over a kilometre takes, all points of the floor at once.

    The second one: the first turns the outputs into functions, once for all runs.
    """
    for _ in range(2):
        started = perf_counter()
        time_run(model, speed, road, places, length=min(RUN, road.length), floor=floor,
                 weight=weighting("Wk"), rate=RATE)  # fmt: skip
    return perf_counter() - started


def _entry(values: Array, k: int) -> float | None:
    return float(values[k]) if k < len(values) else None
