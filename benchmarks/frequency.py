"""Frequency response: the case, and what is timed inside a process of its own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from coach import SPEED
from entry import at_least, at_most, entry
from measure import Case, answer, median, timed, worker

SEGMENTS = 8
FREQUENCIES = 100_000
BAND = (0.05, 80.0)
"""Hz, what a ride is rated over."""


def frequency(name: str, peer_named: str, bound: float, step: Callable[[], None]) -> dict[str, Any]:
    """Frequency response at 100,000 frequencies, N = 8, one output, four wheelsets with delays."""
    found = worker(__file__, name)
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        name,
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.frequency.track_response, matrices from parameters included, wall time",
        peer=f"{peer_named} on the state space with inputs w, w' of the four wheelsets, delays put "
        "in after; wall time",
        frequencies=found["frequencies"],
        states=found["states"],
        peer_difference=found["peer_difference"],
        targets=[
            at_least("times faster", peer / own, bound),
            at_most("largest difference from a direct solve / largest value",
                    found["difference"], 1e-9),
        ],
    )  # fmt: skip


def time_frequency(name: str, rounds: int = 3) -> dict[str, Any]:
    """`track_response` and the peer at the same frequencies, same coach."""
    import control
    import numpy as np
    from scipy import signal

    from railride.frequency import track_response, wheelset_delays
    from railride.parameters import load_vehicle
    from railride.statespace import system_arrays
    from railride.vehicle import derive_vehicle

    model = derive_vehicle(load_vehicle("cati2024"), segments=SEGMENTS)
    floor, f = [model.floor()], np.geomspace(*BAND, FREQUENCIES)
    delays, s = wheelset_delays(model, SPEED), system_arrays(model, floor)
    track = slice(0, 2 * delays.size)  # the actuators' forces follow, and stay zero
    system = control.ss(s.A, s.B[:, track], s.C, s.D[:, track])
    single = [(s.A, s.B[:, [i]], s.C, s.D[:, [i]]) for i in range(2 * delays.size)]
    omega = 2 * np.pi * f

    peers: dict[str, Callable[[], Any]] = {
        "frequency": lambda: control.frequency_response(system, omega, squeeze=False).frdata[0],
        "frequency-scipy": lambda: np.array([signal.freqresp(one, omega)[1] for one in single]),
    }

    def peer_response() -> Any:
        each = peers[name]()
        e = np.exp(-1j * np.outer(delays, omega))
        return (each * np.vstack([e, 1j * omega * e])).sum(axis=0)

    track_response(model, floor, SPEED, f[:2])  # the outputs' rows are derived
    own_times, peer_times = [], []
    for _ in range(rounds):
        own_time, own = timed(lambda: track_response(model, floor, SPEED, f)[0])
        peer_time, peer = timed(peer_response)
        own_times.append(own_time)
        peer_times.append(peer_time)
    direct = solved_directly(model, floor, delays, omega)
    largest = np.abs(direct).max()
    return {
        "own": own_times,
        "peer": peer_times,
        "difference": float(np.abs(own - direct).max() / largest),
        "peer_difference": float(np.abs(peer - direct).max() / largest),
        "frequencies": f.size,
        "states": len(s.A),
    }


def solved_directly(model: Any, outputs: Any, delays: Any, omega: Any) -> Any:
    """(K - ω² M + iω C) q = (K_w + iω C_w) e by LAPACK at every ω; the acceleration's row of it."""
    import numpy as np

    m, row = model.matrices(), model.output_rows(outputs)["a"][0]
    found = np.empty(omega.size, dtype=complex)
    for start in range(0, omega.size, 5000):
        w = omega[start : start + 5000, np.newaxis, np.newaxis]
        e = np.exp(-1j * w * delays[:, np.newaxis])
        q = np.linalg.solve(m.K - w**2 * m.M + 1j * w * m.C, (m.K_w + 1j * w * m.C_w) @ e)
        found[start : start + 5000] = -(w[:, 0, 0] ** 2) * (row @ q[:, :, 0].T)
    return found


PEERS = {
    "frequency": ("control.frequency_response, without slycot,", 20.0),
    "frequency-scipy": ("scipy.signal.freqresp, one input at a time,", 2.0),
}
"""Case to its peer, and how many times faster railride is meant to be."""
CASES: dict[str, Case] = {
    name: (partial(frequency, name, *peer), 1) for name, peer in PEERS.items()
}
WORKERS = {name: partial(time_frequency, name) for name in PEERS}

if __name__ == "__main__":
    answer(WORKERS)
