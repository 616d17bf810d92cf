r"""Rides: a vehicle over a track at a speed, and what its passengers feel.

The wheelsets follow the rail, w_j(t) = w(x_0 + V t - l_j) with w read at each wheelset's own place,
and the response to elevations and rates that are linear between samples is exact. A run-in comes
before the rated section, at least 5/(ζω) of the slowest mode that matters for the result.

Source: ISO 2631-1:1997 (rating of the floor's acceleration), as in Y. Çati, M. Düzgün, F.E. Kracht,
Appl. Sci. 2024, 14, 3848, Sections 3 and 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.comfort import ComfortIndices, indices
from railride.errors import Faults, InputError
from railride.frequency import wheelset_delays
from railride.modal import eigen, refuse_unstable
from railride.numeric import Array
from railride.response import simulate
from railride.scales import levels, paper_level
from railride.spectra import Spectrum, check_speed, coverage_remark, spectrum, temporal
from railride.statespace import System, system_arrays
from railride.stochastic import BAND_HZ, StochasticRide, stochastic_ride
from railride.track import Track, recommended_step, resolved_band_hz, synthesise
from railride.trackfile import read_track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, apply_weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

PAPER_SPEEDS = (145 / 3.6, 200 / 3.6)  # m/s
RATE = 1000.0  # Hz; at 1 ms the straight line between samples costs 0.1 % in r.m.s.
TIME_CONSTANTS = 5  # of the slowest mode that matters, before the rated section
LONGEST_RUN_IN = 10.0  # s
MATTERS = 1e-3  # of the weighted mean square: a mode with less may still be ringing
TRACK_BEFORE = 1250.0  # m of synthetic track before the rated section: one track for all speeds


@dataclass(frozen=True, eq=False)
class Case:
    """One speed and one point of the floor, rated. SI units; None where only a run would tell.

    run : the record behind the values, None if they come from the spectrum alone.
    """

    speed: float
    position: float
    body: str
    segments: int
    a_rms: float
    a_wrms: float
    a_wrms_exact: float | None
    standard_error: float | None
    mtvv: float | None
    vdv: float | None
    crest_factor: float | None
    wz: float | None
    run: Run | None = None

    @property
    def level(self) -> str:
        """The class of Table 3 of the paper."""
        return paper_level(self.a_wrms)

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → the classes that fit."""
        return levels(self.a_wrms, self.wz)


@dataclass(frozen=True, eq=False)
class Run:
    """One time run at one point: arrays (n,) over ``time``, s, zero where the rated section begins.

    elevation : m, under the leading wheelset. acceleration, weighted : m/s², of the floor.
    rated : the samples that are rated.
    """

    time: Array
    elevation: Array
    acceleration: Array
    weighted: Array
    rated: slice


@dataclass(frozen=True)
class RideResult:
    """All cases of a ride, speeds outer and positions inner, and what to know of them."""

    vehicle: str
    track: str
    floor: str
    weighting: str
    cases: tuple[Case, ...]
    remarks: tuple[str, ...] = ()

    def table(self) -> pd.DataFrame:
        """The cases as rows, the units in the column names."""
        import pandas as pd

        return pd.DataFrame([
            {
                "speed [km/h]": 3.6 * case.speed,
                "position [m]": case.position,
                "a_rms [m/s^2]": case.a_rms,
                "a_wrms [m/s^2]": case.a_wrms,
                "a_wrms exact [m/s^2]": case.a_wrms_exact,
                "standard error [m/s^2]": case.standard_error,
                "MTVV [m/s^2]": case.mtvv,
                "VDV [m/s^1.75]": case.vdv,
                "crest factor": case.crest_factor,
                "Wz": case.wz,
                "level": case.level,
            }
            for case in self.cases
        ])  # fmt: skip


def ride(
    model: VehicleModel,
    track: str | Path | Spectrum | Track = "erri_low",
    speeds: Sequence[float] = PAPER_SPEEDS,
    *,
    at: Sequence[float] = (0.0,),
    length: float = 1000.0,
    seed: int = 1,
    floor: str = "smooth",
    weight: str = "Wk",
    rate: float = RATE,
    spectral: bool = False,
    progress: Callable[[float], Any] | None = None,
) -> RideResult:
    """Run a vehicle over a track at each speed, and rate the floor's acceleration.

    Parameters
    ----------
    track : the name of a spectrum, a track file, a :class:`Spectrum` or a :class:`Track`.
    speeds : m/s, each > 0. at : points of the floor, m forward of the body's middle.
    length : m, the rated section; with a file, its last metres. seed : of a synthetic track.
    floor : "smooth" or "polygon". weight : a weighting's name. rate : samples a second.
    spectral : the exact stochastic values alone, without a time run.
    progress : called with the fraction done.

    Raises
    ------
    InputError : anything of this out of its range, all faults together; a track that is shorter
        than ``length``; an unstable vehicle; ``spectral`` with a measured track.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> model = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> ride(model, "erri_low", [200 / 3.6], floor="polygon", spectral=True).cases[0].level
    'medium'
    """
    _check_arguments(speeds, at, length, rate)
    source = load_track(track)
    weighted_by = weighting(weight)
    remarks = [*model.vehicle.remarks, *model.remarks]
    known = source if isinstance(source, Spectrum) else None
    exact: list[StochasticRide | None] = []
    for speed in speeds:
        if known is not None:
            remarks.append(coverage_remark(known.name, known.active_band, speed) or "")
            value = stochastic_ride(model, speed, known, at, floor=floor, weight=weighted_by)
        exact.append(value if known is not None else None)
    cases: list[Case] = []
    if spectral:
        if known is None:
            raise InputError(f"track {source.name}: found a measured track with the exact stochastic "
                             "value asked for; expected a spectrum (leave --spectral out, or name "
                             "a spectrum)")  # fmt: skip
        for speed, e in zip(speeds, exact, strict=True):
            cases += _spectral_cases(model, speed, e)
    else:
        road = source if isinstance(source, Track) else _synthetic(source, speeds, length, seed)
        for number, (speed, e) in enumerate(zip(speeds, exact, strict=True)):
            new, said = _run_cases(model, speed, road, at, length, floor, weighted_by, rate, e)
            cases += new
            remarks += said
            if progress is not None:
                progress((number + 1) / len(speeds))
    remarks = list(dict.fromkeys(remark for remark in remarks if remark))
    return RideResult(model.vehicle.name, source.name, floor, weight, tuple(cases), tuple(remarks))


def load_track(track: str | Path | Spectrum | Track) -> Spectrum | Track:
    """A spectrum by its name or a measured track by its file; what is one already, as it is."""
    if isinstance(track, Spectrum | Track):
        return track
    path = Path(track)
    is_file = isinstance(track, Path) or path.exists() or path.suffix or len(path.parts) > 1
    return read_track(path) if is_file else spectrum(str(track))


def run_in_time(
    model: VehicleModel, system: System, speed: float, weight: Weighting
) -> tuple[float, str | None]:
    """Run-in in s that lets what matters settle, and a remark if it cannot.

    A mode matters if it holds more than 1e-3 of the weighted mean square of an output over a
    typical track, by its residue r at λ: |r|² |W|² S_w / (2 |Re λ|).
    """
    roots, vectors = eigen(model.matrices())
    n, wheelsets = len(system.states) // 2, len(model.linear.inputs)
    c = np.hstack([system.C[:, :n], system.C[:, n:]]) @ vectors
    b = np.linalg.lstsq(vectors, system.B[:, : 2 * wheelsets].astype(complex), rcond=None)[0]
    e = np.exp(-np.outer(1j * roots.imag, wheelset_delays(model, speed)))
    residue = np.abs(c * np.sum((b[:, :wheelsets] + roots[:, None] * b[:, wheelsets:]) * e, axis=1))
    f, decay = np.abs(roots) / (2 * np.pi), np.maximum(-roots.real, 1e-12 * np.abs(roots))
    felt = (f >= BAND_HZ[0]) & (f <= BAND_HZ[1])
    S = np.zeros_like(f)
    S[felt] = temporal(spectrum("erri_low"), speed)(f[felt])
    power = residue**2 * np.abs(weight.response(f)) ** 2 * S / (2 * decay)
    matters = (power > MATTERS * power.sum(axis=1, keepdims=True)).any(axis=0)
    slowest = int(np.argmin(np.where(matters, decay, np.inf)))
    settling = np.append(-weight.poles().real, decay[slowest])
    needed = float(TIME_CONSTANTS / settling.min())
    if needed <= LONGEST_RUN_IN:
        return needed, None
    return LONGEST_RUN_IN, (
        f"the mode at {f[slowest]:.2f} Hz has a damping ratio of only "
        f"{decay[slowest] / abs(roots[slowest]):.1e} and would take {needed:.3g} s to settle; the "
        f"run-in is {LONGEST_RUN_IN:g} s, so that the run's value may differ from the exact one by "
        "more than its standard error"
    )


def _spectral_cases(model: VehicleModel, speed: float, exact: StochasticRide | None) -> list[Case]:
    if exact is None:
        return []
    return [
        Case(speed, x, model.body.kind, model.body.segments, float(exact.a_rms[k]),
             float(exact.a_wrms[k]), float(exact.a_wrms[k]), None, None, None, None,
             float(exact.wz[k]))
        for k, x in enumerate(exact.positions)
    ]  # fmt: skip


def _run_cases(
    model: VehicleModel, speed: float, track: Track, at: Sequence[float], length: float,
    floor: str, weight: Weighting, rate: float, exact: StochasticRide | None,
) -> tuple[list[Case], list[str]]:  # fmt: skip
    """Run once and rate every position."""
    system = system_arrays(model, [model.floor(x, floor) for x in at])
    refuse_unstable(np.linalg.eigvals(system.A).astype(complex))
    settling, remark = run_in_time(model, system, speed, weight)
    remarks = [remark or ""]
    start = track.end - length
    if start < track.distance0 - 1e-9 * track.length:
        raise InputError(f"track {track.name}: found {track.length:g} m of track; expected at least "
                         f"the {length:g} m to be rated (rate a shorter --length)")  # fmt: skip
    before = speed * settling
    reach = before + speed * float(wheelset_delays(model, speed).max())
    if start - reach < track.distance0 - 1e-9 * track.length and not track.lead_in:
        track = track.with_taper(min(50.0, track.length))
        before = min(before, start - track.distance0)
        remarks.append(f"{track.remarks[-1]}; the run-in at {3.6 * speed:g} km/h is {before:.0f} m, "
                       "so that its rated section may begin before the ride has settled")  # fmt: skip
    if exact is None:
        low, high = resolved_band_hz(track, speed)
        remarks.append(f"{track.name} covers {low:.2g} to {high:.3g} Hz at {3.6 * speed:g} km/h; the "
                       "values hold nothing outside")  # fmt: skip
    time, elevation, acceleration, rated = _run(
        model, system, speed, track, start, before, length, rate
    )
    cases = []
    for k, x in enumerate(at):
        found = indices(acceleration[k], rate, weight, section=rated, before=0.0)
        remarks += found.remarks
        weighted = apply_weighting(weight, acceleration[k], rate, before=0.0)
        run = Run(time, elevation, acceleration[k], weighted, rated)
        cases.append(_run_case(model, speed, x, found, run, exact, k))
    return cases, remarks


def _run(
    model: VehicleModel, system: System, speed: float, track: Track, start: float, before: float,
    length: float, rate: float,
) -> tuple[Array, Array, Array, slice]:  # fmt: skip
    """Time, elevation under the leading wheelset, accelerations (positions, n), rated samples."""
    first, last = -int(np.floor(before / speed * rate)), int(np.floor(length / speed * rate))
    time = np.arange(first, last + 1) / rate
    leading = start + speed * time
    behind = speed * wheelset_delays(model, speed)
    w, slope = track.elevation(leading - behind[:, np.newaxis])
    forces = np.zeros((len(model.linear.forces), time.size))
    m = model.matrices()
    at_rest = np.linalg.solve(m.K, m.K_w @ np.column_stack([w[:, 0], speed * slope[:, 0]]))
    u = np.vstack([w, speed * slope, forces])
    response = simulate(system.A, system.B, system.C, system.D, u, 1 / rate, x0=at_rest.T.ravel())
    return time, w[0], response.outputs, slice(-first, time.size)


def _run_case(
    model: VehicleModel, speed: float, x: float, found: ComfortIndices, run: Run,
    exact: StochasticRide | None, k: int,
) -> Case:  # fmt: skip
    duration = found.duration
    return Case(
        speed, x, model.body.kind, model.body.segments, found.a_rms, found.a_wrms,
        None if exact is None else float(exact.a_wrms[k]),
        None if exact is None else float(exact.standard_error(duration)[k]),
        found.mtvv, found.vdv, found.crest_factor, found.wz, run,
    )  # fmt: skip


def _synthetic(source: Spectrum, speeds: Sequence[float], length: float, seed: int) -> Track:
    """The rated section and enough before it for any of the speeds' run-ins: one track for all."""
    longest = LONGEST_RUN_IN * max(speeds) + 50.0
    before = max(TRACK_BEFORE, 250.0 * np.ceil(longest / 250.0))
    track = synthesise(source, length + before, recommended_step(min(speeds)), seed)
    return replace(track, distance0=-before)


def _check_arguments(
    speeds: Sequence[float], at: Sequence[float], length: float, rate: float
) -> None:
    faults = Faults("ride")
    for values, name in ((speeds, "speeds"), (at, "at")):
        if not len(values):
            faults.add(name, "none", "at least one")
    for speed in speeds:
        try:
            check_speed(speed)
        except InputError:
            faults.add("speed", f"{3.6 * speed:g} km/h", "a finite speed above 0")
    for value, name, unit in ((length, "length", "m"), (rate, "rate", "Hz")):
        if not (np.isfinite(value) and value > 0):
            faults.add(name, f"{value:g} {unit}", "a finite one above 0")
    faults.raise_if_any()
