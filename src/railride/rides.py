r"""Rides: a vehicle over a track at some speeds, and what its passengers feel.

Beside the value of each run, which is a sample, stands the exact one of the track's spectrum.

Source: ISO 2631-1:1997 (rating of the floor's acceleration), as in Y. Çati, M. Düzgün, F.E. Kracht,
Appl. Sci. 2024, 14, 3848, Sections 3 and 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.comfort import ContinuousComfort, continuous_comfort_of, few_blocks, indices
from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.quantities import in_kmh, several
from railride.ridden import coverage, rated_section, ridden_track
from railride.scales import levels, paper_level, scale_remarks
from railride.spectra import Spectrum, check_speed, coverage_remark
from railride.stochastic import (
    MeasuredSpectrum,
    StochasticRide,
    stochastic_ride,
    track_spectrum,
)
from railride.timerun import Run, time_run
from railride.track import Track
from railride.trackfile import load_track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

PAPER_SPEEDS = (145 / 3.6, 200 / 3.6)  # m/s
RATE = 1000.0  # Hz; at 1 ms the straight line between samples costs 0.1 % in r.m.s.
FASTEST = 500 / 3.6  # m/s: above it a speed is hardly meant


@dataclass(frozen=True, eq=False)
class Record:
    """What the floor felt at one point: arrays (n,) over ``time``, s, zero where the rating begins.

    distance : m along the track, and elevation : m, of the leading wheelset. acceleration,
    weighted : m/s². rated : the samples that are rated.
    """

    time: Array
    distance: Array
    elevation: Array
    acceleration: Array
    weighted: Array
    rated: slice


@dataclass(frozen=True, eq=False)
class Case:
    """One speed and one point of the floor, rated. SI units; None where only a run would tell.

    standard_error : of a_wrms, for a run of this length over this spectrum; of an exact value from
    a measured track alone, for that track's length.
    a_wrms_error : estimated relative error of the exact value's integration.
    continuous : the 5 s values of EN 12299, of a rated section that holds one.
    body : the car body's kind; segments, modes : how many of them it has, None if it is not made
    of them. record : what is behind the values, None if they come from the spectrum alone.
    """

    speed: float
    position: float
    body: str
    segments: int | None
    a_rms: float
    a_wrms: float
    a_wrms_exact: float | None
    standard_error: float | None = None
    mtvv: float | None = None
    mtvv_exp: float | None = None
    vdv: float | None = None
    crest_factor: float | None = None
    wz: float | None = None
    continuous: ContinuousComfort | None = None
    record: Record | None = None
    modes: int | None = None
    a_wrms_error: float | None = None

    @property
    def level(self) -> str:
        """The class of Table 3 of the paper."""
        return paper_level(self.a_wrms)

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → the classes that fit."""
        over_time = self.continuous.levels if self.continuous else {}
        return {**levels(self.a_wrms, self.wz), **over_time}


@dataclass(frozen=True)
class RideResult:
    """All cases of a ride, speeds outer and positions inner, and what to know of them.

    body : the car body in a few words.
    """

    vehicle: str
    track: str
    floor: str
    weighting: str
    cases: tuple[Case, ...]
    remarks: tuple[str, ...] = ()
    length: float | None = None
    seed: int | None = None
    body: str = "car body"

    def _repr_html_(self) -> str:
        return str(self.table().to_html(index=False, float_format="%.4g"))

    def table(self) -> pd.DataFrame:
        """The cases as rows, the units in the column names."""
        import pandas as pd

        return pd.DataFrame(
            [
                {
                    "speed [km/h]": round(3.6 * case.speed, 9),
                    "position [m]": case.position,
                    "a_rms [m/s^2]": case.a_rms,
                    "a_wrms [m/s^2]": case.a_wrms,
                    "a_wrms exact [m/s^2]": case.a_wrms_exact,
                    "error of the exact": case.a_wrms_error,
                    "standard error [m/s^2]": case.standard_error,
                    "MTVV [m/s^2]": case.mtvv,
                    "MTVV exponential [m/s^2]": case.mtvv_exp,
                    "VDV [m/s^1.75]": case.vdv,
                    "crest factor": case.crest_factor,
                    "Wz": case.wz,
                    "6 a_z,P95": case.continuous.vertical_part if case.continuous else None,
                    "level": case.level,
                }
                for case in self.cases
            ]
        )


def ride(
    model: VehicleModel,
    track: str | Path | Spectrum | Track = "erri_low",
    speeds: float | Sequence[float] = PAPER_SPEEDS,
    *,
    at: float | Sequence[float] = (0.0,),
    length: float = 1000.0,
    seed: int = 1,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    rate: float = RATE,
    spectral: bool = False,
    progress: Callable[[float], Any] | None = None,
) -> RideResult:
    """Run a vehicle over a track at each speed, and rate the floor's acceleration.

    Parameters
    ----------
    track : the name of a spectrum, a track file, a :class:`Spectrum` or a :class:`Track`.
    speeds : m/s, one or several, each > 0. at : points of the floor, m forward of the body's
        middle.
    length : m, the rated section; with a file, its last metres. seed : of a synthetic track.
    floor : "smooth" or "polygon". weight : a weighting or its name. rate : samples a second.
    spectral : the exact stochastic values alone, without a time run; of a measured track, those of
        the spectrum that is estimated from the whole of it.
    progress : called with the fraction done.

    Raises
    ------
    InputError : anything of this out of its range, all faults together; a track that is shorter
        than ``length``; an unstable vehicle; ``spectral`` with a track too short for a spectrum, or
        with a vehicle that has no stationary ride.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> model = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> ride(model, "erri_low", [200 / 3.6], floor="polygon", spectral=True).cases[0].level
    'medium'
    """
    speeds, at = several(speeds, "ride: speeds", "m/s"), several(at, "ride: at", "m")
    _check_arguments(model, speeds, at, length, rate)
    source, weighted_by = load_track(track), weighting(weight)
    road = None if spectral else ridden_track(source, speeds, length, seed)
    cases: list[Case] = []
    of, said = exact_spectrum(source, needed=spectral)
    section = [] if spectral else rated_section(source, length)
    remarks = [*model.vehicle.remarks, *model.remarks, *section, *said]
    for number, speed in enumerate(speeds, start=1):
        exact, said = _exact(model, speed, of, at, floor, weighted_by, needed=spectral)
        remarks += said
        remarks += coverage(source if road is not None or of is None else of, speed)
        if speed > FASTEST:
            remarks.append(f"{in_kmh(speed)} is faster than trains run: is the speed in m/s?")
        if road is None:
            cases += _exact_cases(model, speed, exact, of)
        else:
            run = time_run(
                model, speed, road, at, length=length, floor=floor, weight=weighted_by, rate=rate
            )
            remarks += (f"{in_kmh(speed)}: {said}" for said in run.remarks)
            new, said = _rate(model, run, at, exact, weighted_by, rate)
            cases += new
            remarks += said
        if progress is not None:
            progress(number / len(speeds))
    remarks += few_blocks([case.continuous for case in cases])
    remarks += scale_remarks([weighted_by.name], [case.level for case in cases])
    return RideResult(
        model.vehicle.name,
        source.name,
        floor,
        weighted_by.name,
        tuple(cases),
        tuple(dict.fromkeys(remarks)),
        None if spectral else length,
        seed if road is not None and road is not source else None,
        model.body.title,
    )


def exact_spectrum(
    source: Spectrum | Track, *, needed: bool = True
) -> tuple[Spectrum | None, list[str]]:
    """As :func:`railride.stochastic.track_spectrum`; none where it cannot be and is not ``needed``.

    Raises
    ------
    InputError : a measured track from which no spectrum can be estimated, where it is needed.
    """
    try:
        return track_spectrum(source)
    except InputError as fault:
        if needed:
            raise
        return None, [*source.remarks, f"no exact value: {fault}"]


def _exact(
    model: VehicleModel, speed: float, of: Spectrum | None, at: Sequence[float], floor: str,
    weight: Weighting, *, needed: bool,
) -> tuple[StochasticRide | None, list[str]]:  # fmt: skip
    """The exact values at a speed, and remarks; a measured track may hold nothing a ride feels."""
    if of is None:
        return None, []
    try:
        found = stochastic_ride(model, speed, of, at, floor=floor, weight=weight)
    except InputError as fault:
        if needed or not isinstance(of, MeasuredSpectrum):
            raise
        return None, [f"no exact value: {fault}"]
    if not isinstance(of, MeasuredSpectrum) or needed:
        return found, list(found.remarks)
    shortest, longest = of.wavelengths
    low, high = speed / longest, speed / shortest
    covered = coverage_remark(of.name, of.active_band, speed)  # the run itself holds more
    remarks = [said for said in found.remarks if said != covered]
    held = f"{max(low, 0.05):.2g} to {min(high, 80.0):.3g} Hz"
    return found, [*remarks, f"{in_kmh(speed)}: the exact value of {of.name} holds {held}"]


def _rate(
    model: VehicleModel, run: Run, at: Sequence[float], exact: StochasticRide | None,
    weight: Weighting, rate: float,
) -> tuple[list[Case], list[str]]:  # fmt: skip
    """Rate one run at every position."""
    cases, remarks = [], []
    for k, x in enumerate(at):
        acceleration, rated = run.acceleration[k], run.rated
        found = indices(acceleration, rate, weight, section=rated, before=0.0)
        remarks += [f"{in_kmh(run.speed)}, {x:g} m: {said}" for said in found.remarks]
        (weighted,) = found.weighted
        over_time = continuous_comfort_of(found, acceleration, rate, "z", section=rated, before=0.0)
        cases.append(
            Case(
                run.speed,
                x,
                model.body.kind,
                model.body.segments,
                found.a_rms,
                found.a_wrms,
                None if exact is None else float(exact.a_wrms[k]),
                None if exact is None else float(exact.standard_error(found.duration)[k]),
                found.mtvv,
                found.mtvv_exp,
                found.vdv,
                found.crest_factor,
                found.wz,
                over_time,
                Record(run.time, run.distance, run.elevation, acceleration, weighted, rated),
                model.body.mode_count,
                None if exact is None else float(exact.a_wrms_error[k]),
            )
        )
    return cases, remarks


def _exact_cases(
    model: VehicleModel, speed: float, exact: StochasticRide | None, of: Spectrum | None
) -> list[Case]:
    """The exact values alone; those of a measured track have a standard error of their own."""
    if exact is None:
        return []
    kind, segments, count = model.body.kind, model.body.segments, model.body.mode_count
    errors: list[float | None] = [None] * len(exact.positions)
    if isinstance(of, MeasuredSpectrum):
        errors = list(map(float, exact.standard_error(of.effective_length / speed)))
    values = zip(exact.positions, exact.a_rms, exact.a_wrms, exact.a_wrms_error, errors, exact.wz,
                 strict=True)  # fmt: skip
    return [
        Case(
            speed,
            x,
            kind,
            segments,
            float(a),
            float(a_w),
            float(a_w),
            error,
            wz=float(wz),
            modes=count,
            a_wrms_error=float(integrated),
        )
        for x, a, a_w, integrated, error, wz in values
    ]


def _check_arguments(
    model: VehicleModel, speeds: Sequence[float], at: Sequence[float], length: float, rate: float
) -> None:
    if not isinstance(model, VehicleModel):
        raise InputError(
            f"ride: found {type(model).__name__} for the model; expected what derive_vehicle gives"
        )
    faults = Faults("ride")
    for values, name in ((speeds, "speeds"), (at, "at")):
        if not len(values):
            faults.add(name, "none", "at least one")
    for speed in speeds:
        try:
            check_speed(speed)
        except InputError:
            faults.add("speed", in_kmh(speed), "a finite speed above 0")
    for value, name, unit in ((length, "length", "m"), (rate, "rate", "Hz")):
        if not (np.isfinite(value) and value > 0):
            faults.add(name, f"{value:g} {unit}", "a finite one above 0")
    faults.raise_if_any()
