"""What rumoca, a Modelica compiler, takes for a ride: ``python modelica_workers.py NAME``.

The exported model runs over the samples that ``railride.response.simulate`` has in
``workers.ride``, brought to it as tables.
"""

from __future__ import annotations

import json
import sys
from functools import partial
from pathlib import Path
from typing import Any

from workers import LENGTH, RATE, SEGMENTS_RIDE, SPEED, elevations_and_rates, timed

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
TOLERANCES = {"1e-3": 1e-6, "1e-6": 1e-9}
"""Of the solver, relative, for floor accelerations that differ by less than that from railride's.

The absolute ones are 1e-4 of them. The explicit solver is closer than "bdf" at the same tolerance,
in the same time.
"""


def ride(rounds: int = 3, length: float = LENGTH) -> dict[str, Any]:
    """1 km at 1 kHz; what rumoca takes to compile, to prepare a run and for all of a run, in s.

    It prepares the model anew for every run, so that the integration is the rest of ``peer``.
    """
    import numpy as np
    from rumoca_peer import compiled, driven, simulated

    from railride.exports.as_modelica import written
    from railride.exports.content import content_of
    from railride.frequency import wheelset_delays
    from railride.response import simulate
    from railride.vehicle import derive_vehicle

    model, dt = derive_vehicle("cati2024", SEGMENTS_RIDE), 1 / RATE
    content = content_of(model, "floor_acceleration")
    t = np.arange(round(length / SPEED * RATE) + 1) * dt
    u = elevations_and_rates(t, wheelset_delays(model, SPEED))
    names = [s.name for s in (*content.elevations, *content.rates)]
    samples = dict(zip(names, u, strict=True))
    text = driven(written(content), samples, dt, [f.name for f in content.forces])
    compiling, peer = timed(lambda: compiled(text, f"{content.name}.Driven"))
    s, track = content.system, slice(0, len(u))
    own, prepare = [], []
    found: dict[str, Any] = {"samples": len(t), "compile": compiling, "own": own}
    found |= {"prepare": prepare, "peer": {name: [] for name in TOLERANCES}, "difference": {}}
    for _ in range(rounds):
        seconds, y = timed(lambda: simulate(s.A, s.B[:, track], s.C, s.D[:, track], u, dt))
        own.append(seconds)
        prepare.append(timed(lambda: simulated(peer, dt, dt, solver="rk-like"))[0])
        for name, rtol in TOLERANCES.items():
            how = {"solver": "rk-like", "rtol": rtol, "atol": 1e-4 * rtol}
            seconds, (_, run) = timed(partial(simulated, peer, t[-1], dt, **how))
            found["peer"][name].append(seconds)
            error = np.abs(run["coach.floor_acceleration"] - y.outputs[0]).max()
            found["difference"][name] = float(error / np.abs(y.outputs[0]).max())
    return found


WORKERS = {"ride": ride}

if __name__ == "__main__":
    print(json.dumps(WORKERS[sys.argv[1]]()))
