r"""One time run: a vehicle over a track at a speed, from rest or run in, to floor accelerations.

The wheelsets follow the rail, w_j(t) = w(x_0 + V t - l_j) with w read at each wheelset's own place,
and the response to elevations and rates that are linear between samples is exact. A run-in comes
before the rated section, at least 5/(ζω) of the slowest mode that matters for the result.

Source: D.E. Newland, Mechanical Vibration Analysis and Computation, 1989, Chapter 8 (residues).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from railride.errors import InputError
from railride.firstorder import first_order
from railride.frequency import wheelset_delays
from railride.modal import eigen, refuse_unstable
from railride.numeric import Array, Matrices
from railride.response import simulate
from railride.spectra import spectrum, temporal
from railride.statespace import System, system_arrays
from railride.stochastic import BAND_HZ
from railride.track import TAPER, Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting

TIME_CONSTANTS = 5  # of the slowest mode that matters, before the rated section
LONGEST_RUN_IN = 10.0  # s
MOST_SAMPLES = 1e7  # of one run: 0.6 GB of elevations and rates
MATTERS = 1e-3  # of the weighted mean square: a mode with less may still be ringing


@dataclass(frozen=True, eq=False)
class Run:
    """Floor accelerations of one run; ``time`` (n,), s, is zero where the rated section begins.

    speed : m/s. distance (n,) : m along the track, and elevation (n,) : m, of the leading wheelset.
    acceleration (positions, n) :
    m/s². rated : the samples that are rated. remarks : what to know of the run.
    """

    speed: float
    time: Array
    distance: Array
    elevation: Array
    acceleration: Array
    rated: slice
    remarks: tuple[str, ...] = ()


def time_run(
    model: VehicleModel,
    speed: float,
    track: Track,
    at: Sequence[float],
    *,
    length: float,
    floor: str,
    weight: Weighting,
    rate: float,
) -> Run:
    """Run over the last ``length`` metres of a track, after a run-in as far as it has one.

    Parameters
    ----------
    speed : V in m/s. at : points of the floor, m forward of the body's middle. length : m.
    floor : "smooth" or "polygon". weight : says which modes matter. rate : samples a second.

    Raises
    ------
    InputError : an unstable vehicle; a track shorter than ``length``.
    """
    system = system_arrays(model, [model.floor(x, floor) for x in at])
    settling, remark = run_in_time(model, system, speed, weight)
    remarks = [remark] if remark else []
    track, before = with_run_in(model, speed, track, length, speed * settling)
    if before < speed * settling * (1 - 1e-9):
        remarks.append(
            f"{track.remarks[-1]}; that leaves {before:.0f} m of run-in, {settling:.1f} s would "
            f"need {speed * settling:.0f} m: the rated section begins before the ride has settled"
        )
    start = track.end - length
    samples = (before + length) / speed * rate
    if samples > MOST_SAMPLES:
        raise InputError(
            f"ride: found {samples:.2g} samples, {length:g} m at {3.6 * speed:g} km/h and {rate:g} "
            f"a second; expected at most {MOST_SAMPLES:.0e} (a shorter length or another speed)"
        )
    first, last = -int(np.floor(before / speed * rate)), int(np.floor(length / speed * rate))
    time = np.arange(first, last + 1) / rate
    delays = wheelset_delays(model, speed)
    distance = start + speed * time
    w, slope = track.elevation(distance - speed * delays[:, np.newaxis])
    u = np.vstack([w, speed * slope])
    passive = slice(0, len(u))  # the actuators rest
    m = model.matrices()
    at_rest = following(m, w[:, 0], speed * slope[:, 0])
    response = simulate(
        system.A, system.B[:, passive], system.C, system.D[:, passive], u, 1 / rate,
        x0=first_order(m).state(*at_rest),
    )  # fmt: skip
    return Run(
        speed, time, distance, w[0], response.outputs, slice(-first, time.size), tuple(remarks)
    )


def following(m: Matrices, w: Array, dw: Array) -> tuple[Array, Array]:
    r"""Coordinates and rates (n,) of a vehicle that follows the track without inertia or dampers.

    .. math:: K q = K_w w, \qquad K \dot q = K_w \dot w
    """
    q, dq = np.linalg.solve(m.K, m.K_w @ np.stack([w, dw], axis=-1)).T
    return q, dq


def run_in_time(
    model: VehicleModel, system: System, speed: float, weight: Weighting
) -> tuple[float, str | None]:
    """Run-in in s that lets what matters settle, and a remark if it cannot.

    A mode matters if it holds more than 1e-3 of the weighted mean square of an output over a
    typical track, by its residue r at λ: |r|² |W|² S_w / (2 |Re λ|). The weighting settles too.

    Raises
    ------
    InputError : an unstable vehicle.
    """
    roots, vectors = eigen(model.matrices())
    refuse_unstable(roots)
    wheelsets = len(model.linear.inputs)
    c = system.C @ vectors
    b = np.linalg.lstsq(vectors, system.B[:, : 2 * wheelsets].astype(complex), rcond=None)[0]
    e = np.exp(-1j * np.outer(roots.imag, wheelset_delays(model, speed)))
    s = roots[:, np.newaxis]
    residue = np.abs(c * np.sum((b[:, :wheelsets] + s * b[:, wheelsets:]) * e, axis=1))
    f, decay = np.abs(roots) / (2 * np.pi), np.maximum(-roots.real, 1e-12 * np.abs(roots))
    felt = (f >= BAND_HZ[0]) & (f <= BAND_HZ[1])
    S = np.where(felt, temporal(spectrum("erri_low"), speed)(f), 0.0)
    power = residue**2 * np.abs(weight.response(f)) ** 2 * S / (2 * decay)
    matters = (power > MATTERS * power.sum(axis=1, keepdims=True)).any(axis=0)
    slowest = int(np.argmin(np.where(matters, decay, np.inf)))
    settling = float(TIME_CONSTANTS / min(*(-weight.poles().real), decay[slowest]))
    if settling <= LONGEST_RUN_IN:
        return settling, None
    zeta = decay[slowest] / np.abs(roots[slowest])
    return LONGEST_RUN_IN, (
        f"the mode at {f[slowest]:.2f} Hz has a damping ratio of {zeta:.1e} and would take "
        f"{settling:.3g} s to settle; the run-in is {LONGEST_RUN_IN:g} s, so that the run's value "
        "may differ from the exact one by more than its standard error"
    )


def with_run_in(
    model: VehicleModel, speed: float, track: Track, length: float, wanted: float
) -> tuple[Track, float]:
    """The track, with a taper before it if it needs one, and the metres of run-in it gives."""
    slack = 1e-9 * track.length
    start = track.end - length
    if start < track.distance0 - slack:
        raise InputError(
            f"track {track.name}: found {track.length:g} m of track; expected at least the "
            f"{length:g} m to be rated (rate a shorter --length)"
        )
    behind = speed * float(wheelset_delays(model, speed).max())
    if start - wanted - behind >= track.distance0 - slack:
        return track, wanted
    track = track.with_taper(min(TAPER, track.length))
    return track, min(wanted, start - track.distance0)
