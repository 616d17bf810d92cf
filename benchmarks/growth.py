"""How the work grows with the number of segments, to 128: exponents and peak memory."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

from coach import RATE, SPEED
from derivation import DERIVE
from entry import at_most, entry
from measure import Case, answer, interleaved, median, run, timed, worker

WORKS = ("ride", "a_wrms", "frequency")
LADDER = (4, 8, 16, 32, 64, 128)
ROUNDS = 3
SAMPLES = 24_829
FREQUENCIES = 10_000


def growth_derive(step: Callable[[], None]) -> dict[str, Any]:
    """How the CPU of ``python -m railride.derive --segments N`` grows, to N = 128.

    Less the CPU of N = 1, the start of the program. The exponent is that of N^x.
    """
    segments = (1, 16, 32, 64, 128)
    sides = [partial(run, *DERIVE, str(n)) for n in segments]
    sides[0]()
    runs = dict(zip(segments, interleaved(sides, ROUNDS, step), strict=True))
    start = median([r.cpu for r in runs[1]])
    cpu = {n: median([r.cpu for r in runs[n]]) - start for n in segments[1:]}
    peak = {n: max(r.peak for r in runs[n]) / 1e6 for n in segments}
    return entry(
        "growth-derive",
        cpu[128],
        cpu[16],
        rounds=ROUNDS,
        railride="python -m railride.derive --segments 128, CPU less that of --segments 1",
        peer="the same program with --segments 16, CPU less that of --segments 1",
        seconds={"derive": {str(n): value for n, value in cpu.items()}},
        exponents={"derive": exponent(cpu, 16, 128)},
        peak_memory_mb={"derive": {str(n): value for n, value in peak.items()}},
        targets=[
            at_most("exponent from N = 16 to 64", exponent(cpu, 16, 64), 1.6),
            at_most("peak memory at N = 64, MB", peak[64], 500),
        ],
    )


def growth_numbers(step: Callable[[], None]) -> dict[str, Any]:
    """How a ride, the exact a_wrms and a frequency response grow, the model in hand.

    Each in a process of its own, which the peak memory is of.
    """
    found: dict[str, dict[int, dict[str, Any]]] = {work: {} for work in WORKS}
    for n in LADDER:
        for work in WORKS:
            found[work][n] = worker(__file__, f"{work}-{n}")
        step()
    last = LADDER[-1]
    times = {work: {n: median(r["times"]) for n, r in of.items()} for work, of in found.items()}
    peaks = {work: {str(n): r["peak"] / 1e6 for n, r in of.items()} for work, of in found.items()}
    largest = max(peak[str(last)] for peak in peaks.values())
    return entry(
        "growth-numbers",
        times["ride"][last],
        times["ride"][16],
        rounds=5,
        railride=f"railride.simulate of 1 km at 1 kHz, N = {last}, wall time",
        peer="the same at N = 16",
        seconds={work: {str(n): value for n, value in t.items()} for work, t in times.items()},
        exponents={work: exponent(t, 16, last) for work, t in times.items()},
        peak_memory_mb=peaks,
        targets=[at_most(f"peak memory at N = {last}, MB", largest, 1000)],
    )


def exponent(of: dict[int, float], low: int, high: int) -> float:
    """x of N^x; not a number where nothing grows, whose logarithm would be that of noise."""
    if of[low] <= 0 or of[high] <= 0:
        return math.nan
    return math.log(of[high] / of[low]) / math.log(high / low)


def time_growth(work: str, segments: int, rounds: int = 5) -> dict[str, Any]:
    """Model in hand: a ride of 1 km at 1 kHz, the exact a_wrms, or 10,000 frequencies."""
    import numpy as np

    from railride.frequency import track_response
    from railride.response import simulate
    from railride.spectra import spectrum
    from railride.statespace import system_arrays
    from railride.stochastic import weighted_rms
    from railride.vehicle import derive_vehicle
    from railride.weightings import weighting

    model = derive_vehicle("cati2024", segments=segments, bending_damping=0.015)
    floor, f = [model.floor()], np.geomspace(0.2, 40.0, FREQUENCIES)
    s, m, rows = system_arrays(model, floor), model.matrices(), model.output_rows(floor)
    u = np.random.default_rng(1).standard_normal((8, SAMPLES))
    places, track, weight = model.vehicle.wheelset_positions, spectrum("erri_low"), weighting("Wk")
    works: dict[str, Callable[[], Any]] = {
        "ride": lambda: simulate(s.A, s.B[:, :8], s.C, s.D[:, :8], u, 1 / RATE),
        "a_wrms": lambda: weighted_rms(m, rows, places, SPEED, track, weight),
        "frequency": lambda: track_response(model, floor, SPEED, f),
    }
    works[work]()  # loads what is loaded once
    return {"times": [timed(works[work])[0] for _ in range(rounds)]}


CASES: dict[str, Case] = {
    "growth-derive": (growth_derive, ROUNDS),
    "growth-numbers": (growth_numbers, len(LADDER)),
}
WORKERS = {f"{work}-{n}": partial(time_growth, work, n) for work in WORKS for n in LADDER}

if __name__ == "__main__":
    answer(WORKERS)
