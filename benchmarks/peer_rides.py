"""The same ride in programs that integrate step by step: rumoca's Modelica solver, and Exudyn."""

from __future__ import annotations

import sys
from collections.abc import Callable
from functools import partial
from typing import Any

from coach import LENGTH, RATE, SEGMENTS, SPEED, coach, elevations_and_rates
from entry import at_least, at_most, entry
from measure import ROOT, Case, answer, median, timed, worker

FINER = 4
"""Exudyn's steps in one sample."""
TOLERANCES = (1e-6, 1e-9)
"""Of rumoca's explicit solver, the absolute ones 1e-4 of them: off by less than 1e-3 and 1e-6.

Its BDF solver is less close at the same tolerance, in the same time.
"""


def ride_modelica(step: Callable[[], None]) -> dict[str, Any]:
    """The exported Modelica model over the same samples, by rumoca's solver, compiled before."""
    found = worker(__file__, "rumoca")
    step()
    own, prepare = median(found["own"]), median(found["prepare"])
    (loose, runs), (tight, tight_runs) = found["peer"].items()
    peer = median(runs) - prepare
    return entry(
        "ride-rumoca",
        own,
        peer,
        rounds=len(runs),
        railride="railride.simulate, wall time",
        peer="rumoca's explicit solver on the exported model, the same samples as tables, relative "
        f"tolerance {loose}; wall time less that of its first step, compiled before",
        samples=found["samples"],
        compile_s=found["compile"],
        prepare_s=prepare,
        difference=found["difference"][loose],
        tight_s=median(tight_runs) - prepare,
        tight_tolerance=float(tight),
        tight_difference=found["difference"][tight],
        targets=[
            at_least("times faster", peer / own, 10),
            at_most(
                "largest difference / largest value, tightly solved",
                found["difference"][tight],
                1e-6,
            ),
        ],
    )


def time_rumoca(rounds: int = 1, length: float = LENGTH) -> dict[str, Any]:
    """What rumoca takes to compile, to prepare a run and for all of a run, and how far it is off.

    It prepares the model anew for every run, so that the integration is the rest of it.
    """
    sys.path.insert(0, str(ROOT / "tests"))
    import numpy as np
    from rumoca_peer import compiled, driven, simulated

    from railride.exports.as_modelica import written
    from railride.exports.content import content_of
    from railride.frequency import wheelset_delays
    from railride.response import simulate

    model, dt = coach(), 1 / RATE
    content = content_of(model, "floor_acceleration")
    t = np.arange(round(length / SPEED * RATE) + 1) * dt
    u = elevations_and_rates(t, wheelset_delays(model, SPEED))
    names = [s.name for s in (*content.elevations, *content.rates)]
    samples = dict(zip(names, u, strict=True))
    text = driven(written(content), samples, dt, [f.name for f in content.forces])
    compile_time, peer = timed(lambda: compiled(text, f"{content.name}.Driven"))
    s, track = content.system, slice(0, len(u))
    simulate(s.A, s.B[:, track], s.C, s.D[:, track], u[:, :2], dt)  # scipy is loaded
    own, prepare = [], []
    found: dict[str, Any] = {"samples": len(t), "compile": compile_time, "own": own}
    found |= {"prepare": prepare, "peer": {f"{r:g}": [] for r in TOLERANCES}, "difference": {}}
    for _ in range(rounds):
        seconds, y = timed(lambda: simulate(s.A, s.B[:, track], s.C, s.D[:, track], u, dt))
        own.append(seconds)
        prepare.append(timed(lambda: simulated(peer, dt, dt, solver="rk-like"))[0])
        for rtol in TOLERANCES:
            how = {"solver": "rk-like", "rtol": rtol, "atol": 1e-4 * rtol}
            seconds, (_, run) = timed(partial(simulated, peer, t[-1], dt, **how))
            found["peer"][f"{rtol:g}"].append(seconds)
            off = apart(run["coach.floor_acceleration"], y.outputs[0])
            found["difference"][f"{rtol:g}"] = off
    return found


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
WORKERS = {"exudyn": time_exudyn, "rumoca": time_rumoca}

if __name__ == "__main__":
    answer(WORKERS)
