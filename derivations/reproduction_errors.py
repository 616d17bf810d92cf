"""Errors of the integrators and of what is stored, each against the exact response.

The exact response is the first-order hold at 1/16 ms, whose own error is below 1e-5: see
:func:`step_sweep`, where it falls with the square of the step.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
from paper import DASSL_TOLERANCE, SPEEDS_KMH
from reproduction_cases import SEED, passage
from reproduction_integrators import (
    Passage,
    bdf,
    deviation,
    euler_cromer,
    first_order_hold,
    rated,
    stored,
    vode,
    weighted_at_50_hz,
)

from railride.numeric import Array

FINEST = 16_000.0  # Hz, of the exact response
RATES = (250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0)  # Hz, of the step sweep
TOLERANCES = (1e-2, 1e-3, 1e-4)
CONVERGED = 1e-3  # relative error of a_wrms
SEEDS = range(1, 9)  # kilometres over which errors of integration are averaged
PROCESSES = 2

Solver = Callable[[Passage], Array]
AS_THE_PAPER: dict[str, Solver] = {
    "first-order hold, 1 ms": first_order_hold,
    "Euler-Cromer, 1 ms": euler_cromer,
    "BDF, rtol = atol = 1e-4": lambda way: bdf(way, DASSL_TOLERANCE, DASSL_TOLERANCE)[0],
    "VODE's BDF, rtol = atol = 1e-4": lambda way: vode(way, DASSL_TOLERANCE, DASSL_TOLERANCE),
}
CAREFUL: dict[str, Solver] = {
    "BDF, rtol 1e-4, atol 1e-6": lambda way: bdf(way, DASSL_TOLERANCE, DASSL_TOLERANCE / 100)[0],
    "VODE's BDF, rtol 1e-4, atol 1e-6": lambda way: vode(way, DASSL_TOLERANCE,
                                                         DASSL_TOLERANCE / 100),
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Exact:
    """The exact response: stored (n,) at 0.02 s with the run-in, m/s², and a_wrms, m/s²."""

    stored: Array
    a_wrms: float


@cache
def exact_response(body: str, speed_kmh: float, seed: int = SEED) -> Exact:
    """Of a body over the kilometre of a seed."""
    way = passage(body, speed_kmh, seed)
    found = first_order_hold(way, FINEST)
    return Exact(stored(found, FINEST), rated(found, way.before, FINEST))


def error_of(solver: Solver, body: str, speed_kmh: float, seed: int = SEED) -> float:
    """Relative error of a_wrms."""
    way = passage(body, speed_kmh, seed)
    return rated(solver(way), way.before) / exact_response(body, speed_kmh, seed).a_wrms - 1


def _errors(case: tuple[str, float, int]) -> dict[str, float]:
    careful = case[0] != "rigid" and case[2] == SEED
    solvers = AS_THE_PAPER | (CAREFUL if careful else {})
    return {name: error_of(solver, *case) for name, solver in solvers.items()}


@cache
def integrator_errors() -> dict[tuple[str, float], dict[str, Array]]:
    """(body, km/h) → integrator → relative errors of a_wrms (kilometres,), in two processes."""
    pairs = list(product(("rigid", "halves"), SPEEDS_KMH))
    cases = [(*pair, seed) for pair in pairs for seed in SEEDS]
    with ProcessPoolExecutor(PROCESSES) as pool:
        found = dict(zip(cases, pool.map(_errors, cases), strict=True))
    return {
        pair: {
            name: np.array([found[*pair, s][name] for s in SEEDS if name in found[*pair, s]])
            for name in (*AS_THE_PAPER, *CAREFUL)
        }
        for pair in pairs
    }


@cache
def step_sweep(
    body: str, speed_kmh: float, rates: tuple[float, ...] = RATES
) -> dict[str, dict[str, list[float]]]:
    """Error measure → integrator → relative errors at steps of 1/rate.

    "deviation": r.m.s. of the difference at the stored samples, over the r.m.s. itself; "a_wrms".
    """
    way, exact = passage(body, speed_kmh), exact_response(body, speed_kmh)
    found: dict[str, dict[str, list[float]]] = {"deviation": {}, "a_wrms": {}}
    for name, solver in (("first-order hold", first_order_hold), ("Euler-Cromer", euler_cromer)):
        records = [solver(way, rate) for rate in rates]
        found["deviation"][name] = [
            deviation(stored(record, rate), exact.stored, way.before)
            for record, rate in zip(records, rates, strict=True)
        ]
        found["a_wrms"][name] = [
            rated(record, way.before, rate) / exact.a_wrms - 1
            for record, rate in zip(records, rates, strict=True)
        ]
    return found


def converged_step(errors: Sequence[float], rates: Sequence[float] = RATES) -> float | None:
    """The largest step, s, from which on all finer ones keep a_wrms within 0.1 %.

    >>> converged_step([0.5, 2e-3, 5e-4, 1e-4], [250, 500, 1000, 2000])
    0.001
    """
    step = None
    for error, rate in sorted(zip(errors, rates, strict=True), key=lambda pair: -pair[1]):
        if abs(error) > CONVERGED:
            break
        step = 1 / rate
    return step


def tolerance_sweep(body: str, speed_kmh: float) -> list[tuple[float, float, float, int]]:
    """Rtol, error of a_wrms, mean step of the solver in s, calls of x'; atol = rtol/100."""
    way, exact = passage(body, speed_kmh), exact_response(body, speed_kmh)
    found = []
    for rtol in TOLERANCES:
        acceleration, calls = bdf(way, rtol, rtol / 100)
        error = rated(acceleration, way.before) / exact.a_wrms - 1
        found.append((rtol, error, (way.before + way.duration) / calls, calls))
    return found


@cache
def storing_errors() -> dict[tuple[str, float], Mapping[str, float]]:
    """(body, km/h) → way of weighting at 50 Hz → relative error of a_wrms, kilometre of seed 1."""
    found = {}
    for body, speed in product(("rigid", "halves", "beam"), SPEEDS_KMH):
        way, exact = passage(body, speed), exact_response(body, speed)
        values = weighted_at_50_hz(exact.stored, way.before)
        found[body, speed] = {name: value / exact.a_wrms - 1 for name, value in values.items()}
    return found
