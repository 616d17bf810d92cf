"""Time runs and exact values of one vehicle: cases, and what is timed in processes of their own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from coach import (
    FASTER,
    LENGTH,
    RATE,
    RUN_IN,
    SEGMENTS,
    SPEED,
    elevations_and_rates,
    vehicle_state_space,
)
from entry import at_least, at_most, entry
from measure import Case, answer, median, timed, worker

PEERS = {"control": "control.forced_response", "scipy": "scipy.signal.lsim"}
MANY = 1000
"""Vehicles at once."""


def ride(name: str, what: str, step: Callable[[], None]) -> dict[str, Any]:
    """Time simulation of 1 km at 1 kHz, N = 4, both sides alternating in one process."""
    found = worker(__file__, f"ride-{name}")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        f"ride-{name}",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.simulate, wall time",
        peer=f"{what} on the same matrices and input, wall time",
        samples=found["samples"],
        states=found["states"],
        inputs=found["inputs"],
        difference=found["difference"],
        peak_memory_mb=found["peak"] / 1e6,
        targets=[
            at_least("times faster", peer / own, 15),
            at_most("largest difference / largest value", found["difference"], 1e-9),
        ],
    )


def a_wrms(step: Callable[[], None]) -> dict[str, Any]:
    """The exact weighted r.m.s. of one vehicle at one speed, and of many at two, N = 4."""
    found = worker(__file__, "a_wrms")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    many = found["vehicles"] / median(found["many"])
    return entry(
        "a_wrms",
        own,
        peer,
        rounds=len(found["peer"]),
        railride="railride.stochastic.weighted_rms, matrices in hand, wall time; of many vehicles, "
        "weighted_rms_of_many, 1000 at once at 145 and 200 km/h",
        peer="control.forced_response of vehicle and weighting in series, 1 km at 1 kHz and "
        "250 m of run-in, wall time",
        a_wrms=found["a_wrms"],
        peer_a_wrms=found["peer_a_wrms"],
        samples=found["samples"],
        targets=[
            at_most("time, ms", 1e3 * own, 2),
            at_least("times faster", peer / own, 100),
            at_least("vehicles a second, at two speeds", many, 5000),
            at_most("relative error of the integral, stated", found["error"], 1e-6),
        ],
    )


def time_ride(name: str, rounds: int = 15) -> dict[str, Any]:
    """`railride.simulate` and the peer: same matrices, same input."""
    import control
    import numpy as np
    import scipy.signal

    from railride.response import simulate

    A, B, C, D, delays = vehicle_state_space()
    samples = round(LENGTH / SPEED * RATE) + 1
    t = np.arange(samples) / RATE
    u = elevations_and_rates(t, delays)
    system = control.ss(A, B, C, D)
    peers: dict[str, Callable[[], Any]] = {
        "control": lambda: control.forced_response(system, t, u, squeeze=False).outputs[0],
        "scipy": lambda: scipy.signal.lsim((A, B, C, D), u.T, t)[1],
    }
    own_times, peer_times, largest = [], [], 0.0
    for _ in range(rounds):
        own_time, own = timed(lambda: simulate(A, B, C, D, u, 1 / RATE).outputs[0])
        peer_time, peer = timed(peers[name])
        own_times.append(own_time)
        peer_times.append(peer_time)
        largest = max(largest, float(np.abs(own - peer).max() / np.abs(peer).max()))
    return {
        "own": own_times,
        "peer": peer_times,
        "difference": largest,
        "samples": samples,
        "states": len(A),
        "inputs": len(u),
    }


def time_a_wrms(rounds: int = 9) -> dict[str, Any]:
    """The exact a_wrms from matrices in hand, and a ride by `control.forced_response`, weighted.

    The peer's ride is 1 km at 1 kHz, after its run-in, over one sample of the same track spectrum,
    the weighting in series with the vehicle; its value scatters by about 14 %. Beside them, many
    vehicles at once at two speeds.
    """
    import control
    import numpy as np

    from railride.parameters import load_vehicle
    from railride.spectra import spectrum
    from railride.statespace import state_space
    from railride.stochastic import weighted_rms, weighted_rms_of_many
    from railride.track import synthesise
    from railride.vehicle import derive_vehicle
    from railride.weightings import weighting

    model = derive_vehicle(load_vehicle("cati2024"), segments=SEGMENTS)
    places, weight, track = model.vehicle.wheelset_positions, weighting("Wk"), spectrum("erri_low")
    m, rows = model.matrices(), model.output_rows([model.floor()])
    plant = state_space(model)
    felt = control.series(plant, control.ss(weight.transfer_function()))
    rated = round(LENGTH / SPEED * RATE)
    samples = round((RUN_IN + LENGTH) / SPEED * RATE) + 1
    t = np.arange(samples) / RATE
    line = synthesise(track, RUN_IN + LENGTH + 50.0, 0.05, 1).with_taper(50.0)
    behind = places[0] - np.array(places)[:, np.newaxis]
    w, slope = line.elevation(line.distance0 + SPEED * t - behind)
    u = np.vstack(
        [w - w[:, :1], SPEED * slope, np.zeros((plant.ninputs - 2 * len(places), t.size))]
    )
    rng = np.random.default_rng(1)
    designs = model.matrices(**{name: value * rng.uniform(0.5, 2.0, MANY)
                                for name, value in model.values().items()
                                if name in ("k_1", "c_1", "k_2", "c_2")})  # fmt: skip
    own_times, peer_times, many_times = [], [], []
    for _ in range(rounds):
        seconds, _ = timed(
            lambda: weighted_rms_of_many(designs, rows, places, (SPEED, FASTER), track, weight)
        )
        many_times.append(seconds)
        for _ in range(20):
            seconds, (own, error) = timed(
                lambda: weighted_rms(m, rows, places, SPEED, track, weight)
            )
            own_times.append(seconds)
        seconds, peer = timed(lambda: control.forced_response(felt, t, u, squeeze=False).outputs)
        peer_times.append(seconds)
    return {
        "own": own_times,
        "peer": peer_times,
        "many": many_times,
        "vehicles": MANY,
        "a_wrms": float(own[0]),
        "error": float(error[0]),
        "peer_a_wrms": float(np.sqrt(np.mean(peer[0, -rated:] ** 2))),
        "samples": t.size,
    }


CASES: dict[str, Case] = {
    **{f"ride-{name}": (partial(ride, name, what), 1) for name, what in PEERS.items()},
    "a_wrms": (a_wrms, 1),
}
WORKERS = {
    **{f"ride-{name}": partial(time_ride, name) for name in PEERS},
    "a_wrms": time_a_wrms,
}

if __name__ == "__main__":
    answer(WORKERS)
