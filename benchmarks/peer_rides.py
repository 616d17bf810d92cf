"""The same ride in programs that integrate step by step: rumoca's Modelica solver, and Exudyn.

Both run over the smooth track of the tests, 1 km at 145 km/h, at their cheapest setting that is off
by less than 1e-3 of the largest acceleration. So is railride at 1 kHz, by 2e-4: its inputs are
linear between samples.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

from coach import LENGTH, RATE, SPEED, coach
from entry import at_least, at_most, entry
from measure import ROOT, Case, answer, median, timed, worker

SOLVER = {"solver": "bdf", "rtol": 1e-5, "atol": 1e-9}
"""rumoca's. It copies a table at every call, and tables of samples would take it twenty times as
long.
"""
STEP = 0.25e-3
"""Exudyn's, s."""


def ride_modelica(step: Callable[[], None]) -> dict[str, Any]:
    """The exported Modelica model on the same track, by rumoca's solver, compiled before."""
    return beside(
        "rumoca",
        "rumoca's simulate of the exported Coach, the track's 40 waves in a Modelica "
        f"function, {SOLVER}, output at 1 kHz; wall time, compiled before",
        least=10,
        step=step,
    )


def ride_exudyn(step: Callable[[], None]) -> dict[str, Any]:
    """The same ride in Exudyn, a nonlinear multibody program."""
    return beside(
        "exudyn",
        "Exudyn, planar bodies and joints, generalised-alpha at steps of "
        f"{1e3 * STEP:g} ms, the track as forces from Python; wall time with assembly",
        least=15,
        step=step,
    )


def beside(name: str, what: str, least: float, step: Callable[[], None]) -> dict[str, Any]:
    """What the worker of that name found of railride and ``what``, ``least`` times as slow."""
    found = worker(__file__, name)
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        f"ride-{name}",
        own,
        peer,
        rounds=len(found["peer"]),
        railride="railride.simulate, 1 kHz, wall time",
        peer=what,
        error=found["error"],
        own_error=found["own_error"],
        peak_memory_mb=found["peak"] / 1e6,
        **found["more"],
        targets=[
            at_least("times faster", peer / own, least),
            at_most("largest error of the peer / largest value", found["error"], 1e-3),
            at_most("largest error / largest value", found["own_error"], 1e-3),
        ],
    )


class Kilometre:
    """The coach on the track, read at the middle of the polygon through its segments' ends."""

    stop = round(LENGTH / SPEED * RATE) / RATE
    """s, a whole number of samples."""

    def __init__(self) -> None:
        from smooth_tracks import Waves

        from railride.statespace import system_arrays

        self.model = coach()
        self.floor = self.model.floor(0.0, "polygon")
        self.track = Waves.under(self.model, SPEED)
        s = system_arrays(self.model, self.floor)
        driven = slice(0, 2 * len(self.track.behind))  # the actuators' forces stay zero
        self.system = s.A, s.B[:, driven], s.C, s.D[:, driven]

    def inputs(self, step: float) -> Any:
        """Elevations and rates under the wheelsets, at steps in s."""
        import numpy as np

        return self.track.under_all(step * np.arange(round(self.stop / step) + 1))

    def beside(self, peer: Callable[[], Any], rounds: int, finer: int = 16) -> dict[str, Any]:
        """Times of railride and of the peer by turns; how far each is from railride far finer."""
        from railride.response import simulate

        def own(u: Any, step: float) -> Any:
            return simulate(*self.system, u, step).outputs[0]

        dt = 1 / RATE
        fine, u = own(self.inputs(dt / finer), dt / finer)[::finer], self.inputs(dt)
        own_times, peer_times, mine, other = [], [], fine, fine
        for _ in range(rounds):
            seconds, mine = timed(lambda: own(u, dt))
            own_times.append(seconds)
            seconds, other = timed(peer)
            peer_times.append(seconds)
        return {
            "own": own_times,
            "peer": peer_times,
            "own_error": apart(mine, fine),
            "error": apart(other, fine),
        }


def time_rumoca(rounds: int = 5) -> dict[str, Any]:
    """`simulate` and rumoca's.

    It prepares the model anew for every run: what a run over one sample takes.
    """
    from rumoca_peer import compiled, simulated

    from railride.exports.as_modelica import written
    from railride.exports.content import content_of

    ridden, dt = Kilometre(), 1 / RATE
    content = content_of(ridden.model, ridden.floor)
    text = driven(written(content), content, ridden.track)
    compiling, peer = timed(lambda: compiled(text, f"{content.name}.Driven"))
    prepare, _ = timed(lambda: simulated(peer, dt, dt, **SOLVER))
    floor = f"coach.{content.outputs[0].name}"
    found = ridden.beside(lambda: simulated(peer, ridden.stop, dt, **SOLVER)[1][floor], rounds)
    return found | {"more": {"compile_s": compiling, "prepare_s": prepare}}


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


def time_exudyn(rounds: int = 3) -> dict[str, Any]:
    """`simulate` and Exudyn, whose force elements ask for the track at every step, in Python.

    Once more on a level track, for which they ask nothing.
    """
    from exudyn_peer import at_steps, coach_of

    ridden = Kilometre()
    track = at_steps(ridden.inputs(STEP), STEP)

    def run(track: Any) -> Any:
        _, (found,) = coach_of(ridden.model, track).run(ridden.stop, STEP, [0.0])
        return found[:: round(1 / RATE / STEP)]

    found = ridden.beside(lambda: run(track), rounds)
    return found | {"more": {"level_s": timed(lambda: run(None))[0]}}


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
    sys.path.insert(0, str(ROOT / "tests"))
    answer(WORKERS)
