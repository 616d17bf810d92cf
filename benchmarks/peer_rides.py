"""The same ride in programs that integrate step by step: rumoca's Modelica solver, and Exudyn."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from coach import LENGTH, RATE, SEGMENTS, SPEED, coach, elevations_and_rates
from entry import at_least, at_most, entry
from measure import ROOT, Case, answer, median, timed, worker

FINER = 4
"""Exudyn's steps in one sample."""
SOLVER = {"solver": "bdf", "rtol": 1e-5, "atol": 1e-9}
"""rumoca's: as close to the exact response as railride is at 1 kHz, 2e-4 of the largest value.

It copies a table at every call, and tables of samples would take it twenty times as long.
"""


def ride_modelica(step: Callable[[], None]) -> dict[str, Any]:
    """The exported Modelica model on the same track, by rumoca's solver, compiled before."""
    found = worker(__file__, "rumoca")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "ride-rumoca",
        own,
        peer,
        rounds=len(found["peer"]),
        railride="railride.simulate, 1 kHz, wall time",
        peer="rumoca's simulate of the exported Coach, the track's 40 waves in a Modelica "
        f"function, {SOLVER}, output at 1 kHz; wall time, compiled before",
        compile_s=found["compile"],
        prepare_s=found["prepare"],
        error=found["error"],
        own_error=found["own_error"],
        targets=[
            at_least("times faster", peer / own, 10),
            at_most("largest error of the peer / largest value", found["error"], 1e-3),
            at_most("largest error / largest value", found["own_error"], 1e-3),
        ],
    )


def time_rumoca(rounds: int = 5) -> dict[str, Any]:
    """`simulate` and rumoca's, and how far either is from `simulate` at a 16th of the step.

    It prepares the model anew for every run: what a run over one sample takes.
    """
    sys.path.insert(0, str(ROOT / "tests"))
    import numpy as np
    from rumoca_peer import compiled, simulated
    from smooth_tracks import Waves

    from railride.exports.as_modelica import written
    from railride.exports.content import content_of
    from railride.response import simulate

    model, dt = coach(), 1 / RATE
    content = content_of(model, "floor_acceleration")
    places = model.wheelset_places()
    track = Waves(SPEED, tuple((places.max() - places).tolist()))
    s, of, stop = content.system, slice(0, 2 * len(places)), round(LENGTH / SPEED * RATE) * dt

    def samples(step: float) -> Any:
        return track.under_all(step * np.arange(round(stop / step) + 1))

    def own(u: Any, step: float) -> Any:
        return simulate(s.A, s.B[:, of], s.C, s.D[:, of], u, step).outputs[0]

    text = driven(written(content), content, track)
    compile_time, peer = timed(lambda: compiled(text, f"{content.name}.Driven"))
    fine, u = own(samples(dt / 16), dt / 16)[::16], samples(dt)
    prepare, _ = timed(lambda: simulated(peer, dt, dt, **SOLVER))
    own_times, peer_times, a, other = [], [], fine, fine
    for _ in range(rounds):
        seconds, a = timed(lambda: own(u, dt))
        own_times.append(seconds)
        seconds, (_, run) = timed(lambda: simulated(peer, stop, dt, **SOLVER))
        peer_times.append(seconds)
        other = run["coach.floor_acceleration"]
    found = {"own": own_times, "peer": peer_times, "compile": compile_time, "prepare": prepare}
    return found | {"error": apart(other, fine), "own_error": apart(a, fine)}


def driven(text: str, content: Any, track: Any) -> str:
    """The exported package with the track as a function, and the coach upon it."""
    height, turn, phase = ("{" + ", ".join(map(repr, z.tolist())) + "}" for z in track.waves)
    count = len(track.waves[0])
    wheelsets = "\n".join(
        f"    (coach.w_{j}, coach.dw_{j}) = track(time - {behind / track.speed!r});"
        for j, behind in enumerate(track.behind, 1)
    )
    forces = "\n".join(f"    coach.{force.name} = 0;" for force in content.forces)
    added = f"""  function track
    input Real t;
    output Real w;
    output Real dw;
  protected
    constant Real a[{count}] = {height};
    constant Real omega[{count}] = {turn};
    constant Real phase[{count}] = {phase};
    Real p;
    Real faded;
    Real level;
    Real rate;
  algorithm
    level := 0;
    rate := 0;
    for k in 1:{count} loop
      level := level + a[k]*sin(omega[k]*t + phase[k]);
      rate := rate + a[k]*omega[k]*cos(omega[k]*t + phase[k]);
    end for;
    p := min(max(t, 0), 1);
    faded := p^3*(10 - 15*p + 6*p^2);
    w := faded*level;
    dw := faded*rate + 30*p^2*(1 - p)^2*level;
  end track;
  model Driven
    Coach coach;
  equation
{wheelsets}
{forces}
  end Driven;
"""
    end = f"end {content.name};"
    return f"{text.rstrip().removesuffix(end)}{added}{end}\n"


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
