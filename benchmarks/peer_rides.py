"""The same ride in programs that integrate step by step: rumoca's Modelica solver, and Exudyn."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from coach import LENGTH, RATE, SEGMENTS, SPEED, elevations_and_rates
from entry import at_least, at_most, entry
from measure import ROOT, Case, answer, median, timed, worker

FINER = 4
"""Exudyn's steps in one sample."""


def ride_modelica(step: Callable[[], None]) -> dict[str, Any]:
    """The exported Modelica model over the same samples, by rumoca's solver, compiled before."""
    found = worker(str(ROOT / "benchmarks" / "modelica_workers.py"), "ride")
    step()
    loose, tight = (key for key in found if isinstance(found[key], dict))
    own = median(found["own"])
    prepare = median(found[loose]["prepare"])
    peer = median(found[loose]["peer"]) - prepare
    return entry(
        "ride-rumoca",
        own,
        peer,
        rounds=len(found[loose]["peer"]),
        railride="railride.simulate, wall time",
        peer="rumoca's BDF solver on the exported model, the same samples as tables, relative "
        f"tolerance {loose}; wall time less that of its first step, compiled before",
        samples=found["samples"],
        compile_s=found["compile"],
        prepare_s=prepare,
        difference=found[loose]["difference"],
        tight_s=median(found[tight]["peer"]) - median(found[tight]["prepare"]),
        tight_tolerance=float(tight),
        tight_difference=found[tight]["difference"],
        targets=[
            at_least("times faster", peer / own, 10),
            at_most(
                "largest difference / largest value, tightly solved",
                found[tight]["difference"],
                1e-6,
            ),
        ],
    )


def ride_exudyn(step: Callable[[], None]) -> dict[str, Any]:
    """The same ride in Exudyn, a nonlinear multibody program."""
    found = worker(__file__, "exudyn")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "ride-exudyn",
        own,
        peer,
        rounds=len(found["peer"]),
        railride="railride.simulate, 1 kHz, wall time",
        peer="Exudyn, planar bodies and joints, generalised-alpha at steps of 0.25 ms, the track "
        "as forces from Python; wall time",
        difference=found["difference"],
        peak_memory_mb=found["peak"] / 1e6,
        targets=[at_least("times faster", peer / own, 15)],
    )


def time_exudyn(rounds: int = 2) -> dict[str, Any]:
    """The same ride in Exudyn, nonlinear, at steps of 1/4 ms, with railride's of the same samples.

    Its force elements ask for the track at every step, in Python.
    """
    sys.path.insert(0, str(ROOT / "tests"))
    import numpy as np
    from exudyn_peer import coach_of

    from railride.response import simulate
    from railride.statespace import system_arrays
    from railride.vehicle import derive_vehicle

    model = derive_vehicle("cati2024", segments=SEGMENTS)
    s = system_arrays(model, model.floor(0.0, "polygon"))
    places = model.wheelset_places()
    rate, count = FINER * RATE, len(places)
    t = np.arange(round(LENGTH / SPEED * rate) + 1) / rate
    u = elevations_and_rates(t, (places.max() - places) / SPEED)
    p = np.clip(t, 0.0, 1.0)
    fade, fading = p**3 * (10 - 15 * p + 6 * p**2), 30 * p**2 * (1 - p) ** 2
    u[count:] = fade * u[count:] + fading * u[:count]
    u[:count] *= fade
    both = np.stack([u[:count], u[count:]], axis=-1).tolist()
    last = t.size - 1
    A, B, C, D = s.A, s.B[:, : 2 * count], s.C, s.D[:, : 2 * count]
    expected = simulate(A, B, C, D, u[:, ::FINER], 1 / RATE).outputs[0]
    own_times, peer_times, difference = [], [], 0.0
    for _ in range(rounds):
        coach = coach_of(model, track=lambda j, now: both[j][min(round(now * rate), last)])
        peer_time, (_, peer) = timed(lambda c=coach: c.run(float(t[-1]), 1 / rate, [0.0]))
        own_time, _ = timed(lambda: simulate(A, B, C, D, u[:, ::FINER], 1 / RATE))
        own_times.append(own_time)
        peer_times.append(peer_time)
        difference = apart(peer[0, ::FINER], expected)
    return {"own": own_times, "peer": peer_times, "difference": difference}


def apart(one: Any, other: Any) -> float:
    """The largest difference over the largest value."""
    import numpy as np

    return float(np.abs(one - other).max() / np.abs(other).max())


CASES: dict[str, Case] = {
    "ride-rumoca": (ride_modelica, 1),
    "ride-exudyn": (ride_exudyn, 1),
}
WORKERS = {"exudyn": time_exudyn}

if __name__ == "__main__":
    answer(WORKERS)
