"""The paper's eight cases: what stands for each program, and its values on ERRI low.

DYMOLA's flexible body is two halves with a hinge, read at the hinge (the polygon); VAMPIRE's is a
beam. Rigid, both are the same six equations. What is integrated as the programs did it runs over
one kilometre of seed 1; what is exact needs no run.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike
from paper import DASSL_TOLERANCE, SECTION, SPEEDS_KMH, TABLE_4, TRACK, Case, coach
from reproduction_integrators import Passage, bdf, euler_cromer, rated

from railride import KMH, Track, VehicleModel, derive_vehicle, spectrum, stochastic_ride
from railride.numeric import Array
from railride.rides import ridden_track

SEED = 1
PROGRAMS = ("DYMOLA", "VAMPIRE")
BEAM_MODES = 3  # more would make Euler-Cromer at 1 ms unstable, and change a_wrms by less than 1e-4

DAMPED = 0.005  # structural damping ratio that brings the halves nearest to DYMOLA over VAMPIRE


@cache
def bodies() -> dict[str, VehicleModel]:
    """The car bodies by their names: rigid, of two halves, those damped by 0.5 %, and the beam.

    >>> [len(model.lagrangian.coordinates) for model in bodies().values()]
    [6, 7, 7, 9]
    """
    return {
        "rigid": coach(flexible=False),
        "halves": coach(),
        "damped halves": coach().changed(zeta_bending=DAMPED),
        "beam": derive_vehicle("cati2024", body="beam", modes=BEAM_MODES),
    }


def body_of(case: Case) -> str:
    """The name of the body that stands for a case's.

    >>> from paper import CASES
    >>> [body_of(case) for case in CASES[:4]]
    ['rigid', 'rigid', 'halves', 'beam']
    """
    if not case.flexible:
        return "rigid"
    return "halves" if case.program == "DYMOLA" else "beam"


@cache
def road(seed: int = SEED) -> Track:
    """One kilometre of ERRI low, with run-in: the track of :func:`railride.ride`."""
    return ridden_track(spectrum(TRACK), [v * KMH for v in SPEEDS_KMH], SECTION, seed)


@cache
def passage(body: str, speed_kmh: float, seed: int = SEED) -> Passage:
    """A body on its way over the road of a seed."""
    return Passage(bodies()[body], speed_kmh * KMH, road(seed), SECTION)


def exact(
    model: VehicleModel, floor: str = "polygon", weight: str = "Wk", **changes: ArrayLike
) -> Array:
    """a_wrms, m/s², at both speeds, of the stationary ride over ERRI low.

    changes : parameters in place of the vehicle's.
    """
    rides = (stochastic_ride(model, v * KMH, TRACK, floor=floor, weight=weight, **changes)
             for v in SPEEDS_KMH)  # fmt: skip
    return np.array([float(ride.a_wrms[0]) for ride in rides])


@dataclass(frozen=True, eq=False)
class Simulated:
    """One case over the kilometre of seed 1, integrated as its program does it.

    time, acceleration (n,) : s and m/s², of the rated section at 1 ms. a_wrms : m/s².
    """

    case: Case
    time: Array
    acceleration: Array
    a_wrms: float


@cache
def simulated(case: Case) -> Simulated:
    """DYMOLA's cases by BDF at 1e-4, VAMPIRE's by Euler-Cromer at 1 ms."""
    way = passage(body_of(case), case.speed_kmh)
    if case.program == "DYMOLA":
        acceleration = bdf(way, rtol=DASSL_TOLERANCE, atol=DASSL_TOLERANCE)[0]
    else:
        acceleration = euler_cromer(way)
    time = way.times(1000.0)
    inside = time >= 0
    return Simulated(case, time[inside], acceleration[inside], rated(acceleration, way.before))


def printed(program: str) -> Array:
    """a_wrms of the flexible body, m/s², at both speeds, as Table 4 prints it.

    >>> printed("VAMPIRE").tolist()
    [0.191, 0.269]
    """
    return np.array([getattr(row, program.lower()) for row in TABLE_4])


def printed_gap() -> Array:
    """DYMOLA over VAMPIRE less one, at both speeds.

    >>> (100 * printed_gap()).round(1).tolist()
    [17.8, 8.9]
    """
    return printed("DYMOLA") / printed("VAMPIRE") - 1
