"""What is timed inside a process of its own: ``python workers.py NAME`` prints JSON.

Imports are not part of these times. The caller (see ``measure.py``) sets the BLAS to one thread
before this process starts, and so before numpy is imported.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

SEGMENTS_RIDE = 4
SEGMENTS_DERIVE = 8
SPEED = 145 / 3.6
"""m/s, the paper's slower run."""
FASTER = 200 / 3.6
MANY = 1000
"""Vehicles at once."""
RATE = 1000.0
"""Samples per second."""
LENGTH = 1000.0
"""m of track."""
RUN_IN = 250.0
"""m before it: 5/(ζω) of heave, ζ = 0.28 at 1 Hz, twice."""
SEGMENTS_FREQUENCY = 8
FREQUENCIES = 100_000
HOUR = 3_600_001
"""Rows of an hour's record, both ends in it."""
BAND = (0.05, 80.0)
"""Hz, what a ride is rated over."""


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds of wall time, and the result."""
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def ride(rounds: int = 15) -> dict[str, Any]:
    """`railride.response.simulate` and `control.forced_response`, same matrices, same input."""
    import control
    import numpy as np

    from railride.response import simulate

    A, B, C, D, delays = vehicle_state_space()
    samples = round(LENGTH / SPEED * RATE) + 1
    t = np.arange(samples) / RATE
    u = elevations_and_rates(t, delays)
    system = control.ss(A, B, C, D)
    own_times, peer_times, largest = [], [], 0.0
    for _ in range(rounds):
        own_time, own = timed(lambda: simulate(A, B, C, D, u, 1 / RATE).outputs)
        peer_time, peer = timed(
            lambda: control.forced_response(system, t, u, squeeze=False).outputs
        )
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


def vehicle_state_space() -> tuple[Any, Any, Any, Any, Any]:
    """A, B, C, D of the paper's coach, and how long after the first each wheelset arrives.

    Inputs w and w' of the four wheelsets, output the floor's acceleration over the middle.
    """
    import numpy as np

    from railride.parameters import load_vehicle
    from railride.statespace import system_arrays
    from railride.vehicle import derive_vehicle

    vehicle = load_vehicle("cati2024")
    s = system_arrays(derive_vehicle(vehicle, segments=SEGMENTS_RIDE))
    places = np.array(vehicle.wheelset_positions)
    track = slice(0, 2 * len(places))  # the actuators' forces follow, and stay zero
    return s.A, s.B[:, track], s.C, s.D[:, track], (places.max() - places) / SPEED


def elevations_and_rates(t: Any, delays: Any, waves: int = 300) -> Any:
    """A track of cosines, 2 to 80 m long and 1/1000 of that high, under every wheelset: w, w'."""
    import numpy as np

    rng = np.random.default_rng(2024)
    length = np.geomspace(2.0, 80.0, waves)
    omega = 2 * np.pi * SPEED / length
    height, phase = length / 1000 / np.sqrt(waves), rng.uniform(0, 2 * np.pi, waves)
    w, rate = np.zeros((2, len(delays), len(t)))
    for i, delay in enumerate(delays):
        for amplitude, turn, start in zip(height, omega, phase, strict=True):
            angle = turn * (t - delay) + start
            w[i] += amplitude * np.cos(angle)
            rate[i] -= amplitude * turn * np.sin(angle)
    return np.vstack([w, rate])


def frequency(rounds: int = 3) -> dict[str, Any]:
    """`track_response` and `control.frequency_response` at the same frequencies, same coach."""
    import control
    import numpy as np

    from railride.frequency import track_response, wheelset_delays
    from railride.parameters import load_vehicle
    from railride.statespace import system_arrays
    from railride.vehicle import derive_vehicle

    model = derive_vehicle(load_vehicle("cati2024"), segments=SEGMENTS_FREQUENCY)
    floor, f = [model.floor()], np.geomspace(*BAND, FREQUENCIES)
    delays, s = wheelset_delays(model, SPEED), system_arrays(model, floor)
    track = slice(0, 2 * delays.size)  # the actuators' forces follow, and stay zero
    system = control.ss(s.A, s.B[:, track], s.C, s.D[:, track])
    omega = 2 * np.pi * f

    def peer_response() -> Any:
        each = control.frequency_response(system, omega, squeeze=False).frdata[0]
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


def a_wrms(rounds: int = 9) -> dict[str, Any]:
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

    model = derive_vehicle(load_vehicle("cati2024"), segments=SEGMENTS_RIDE)
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


def comfort(rounds: int = 3) -> dict[str, Any]:
    """`railride.comfort.rate_record` of an hour of three axes: all indices, the table, the blocks.

    One sample more than the hour's number, whose prime factors suit no fast transform.
    """
    from railride.comfort import AccelerationRecord, Axis, rate_record

    axes = tuple(Axis(axis, axis, (noise(HOUR, seed),)) for seed, axis in enumerate("xyz"))
    record = AccelerationRecord("an hour", RATE, (0.0,), axes)
    times, found = [], None
    for _ in range(rounds):
        del found  # or its weighted records would be counted twice
        seconds, found = timed(lambda: rate_record(record))
        also, _ = timed(lambda result=found: (result.table(), result.blocks()))
        times.append(seconds + also)
    return {"own": times, "rows": HOUR, "a_wrms": found.axes[2].indices.a_wrms}


def comfort_peer() -> dict[str, Any]:
    """The weighting alone of a tenth of the same records by `control.forced_response`."""
    import control
    import numpy as np

    from railride.weightings import weighting

    rows = HOUR // 10
    t, total = np.arange(rows) / RATE, 0.0
    for seed, name in enumerate(("Wd", "Wd", "Wk")):
        system = control.ss(weighting(name).transfer_function())
        record = noise(HOUR, seed)[:rows]
        seconds, _ = timed(lambda s=system, a=record: control.forced_response(s, t, a))
        total += seconds
    return {"peer": [total], "rows": rows}


def noise(count: int, seed: int) -> Any:
    """Random acceleration, about 1 m/s², most of it below 16 Hz."""
    import numpy as np
    from scipy import signal

    white = np.random.default_rng(seed).standard_normal(count)
    return signal.lfilter([0.3], [1.0, -0.9], white)


def derive_railride() -> dict[str, Any]:
    """From the parameters of the vehicle to its linear matrices in symbols."""
    from railride.parameters import load_vehicle
    from railride.vehicle import derive_vehicle

    vehicle = load_vehicle("cati2024")
    seconds, _ = timed(lambda: derive_vehicle(vehicle, segments=SEGMENTS_DERIVE).linear)
    return {"seconds": seconds}


def derive_sympy() -> dict[str, Any]:
    """sympy's LagrangesMethod with linearize on the same energies; the matrices compared after.

    It refuses rates of inputs, so the dissipation function is that of a track at rest (w' = 0),
    and C_w is not among the matrices it gives.
    """
    from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

    from railride.parameters import load_vehicle
    from railride.vehicle import derive_vehicle

    model = derive_vehicle(load_vehicle("cati2024"), segments=SEGMENTS_DERIVE)
    system = model.lagrangian.written_out
    function = {s: dynamicsymbols(s.name) for s in (*system.coordinates, *system.inputs)}
    table: dict[Any, Any] = dict(function)
    for s, of_time in function.items():
        table[s.dot] = of_time.diff() if s in system.coordinates else 0
    q = [function[s] for s in system.coordinates]
    # The energies are prepared outside the time: the peer starts from them, written for it.
    kinetic, potential = system.kinetic.xreplace(table), system.potential.xreplace(table)
    frame = ReferenceFrame("N")
    loads = []
    for s in system.coordinates:
        point = Point(f"P_{s.name}")
        point.set_vel(frame, table[s.dot] * frame.x)
        loads.append((point, -system.dissipation.diff(s.dot).xreplace(table) * frame.x))

    def work() -> Any:
        method = LagrangesMethod(kinetic - potential, q, forcelist=loads, frame=frame)
        method.form_lagranges_equations()
        rest = {x: 0 for s in q for x in (s, s.diff(), s.diff().diff())}
        return method.linearize(q_ind=q, qd_ind=[x.diff() for x in q], op_point=rest)

    seconds, linear = timed(work)
    return {"seconds": seconds, "difference": _largest_difference(model, linear)}


def _largest_difference(model: Any, linear: Any) -> float:
    """Between M, C, K, K_w of the two, as numbers, as a fraction of each matrix's largest."""
    import numpy as np
    import sympy as sp

    values = {name: float(value) for name, value in model.values().items()}
    mass, state, inputs, order = linear

    def number(matrix: Any) -> Any:
        by_name = {s: values[s.name] for s in matrix.free_symbols if s.name in values}
        at_rest = dict.fromkeys(matrix.atoms(sp.core.function.AppliedUndef), 0)
        return np.array(matrix.xreplace(by_name).xreplace(at_rest).tolist(), dtype=float)

    m, n = model.matrices(), len(model.lagrangian.coordinates)
    names = [s.func.__name__ for s in order]
    columns = [names.index(s.name) for s in model.lagrangian.inputs]
    A = number(state)[n:]
    pairs = [
        (number(mass)[n:, n:], m.M),
        (-A[:, :n], m.K),
        (-A[:, n:], m.C),
        (number(inputs)[n:][:, columns], m.K_w),
    ]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


def synthesise(rounds: int = 5) -> dict[str, Any]:
    """`railride.synthesise` of 1,000 km, and of a prime number of samples, the worst for an FFT."""
    import numpy as np

    from railride.track import synthesise

    step, prime = 0.25, 4_000_037
    own_times, prime_times, peer_times, samples = [], [], [], 0
    for seed in range(rounds):
        own_time, own = timed(lambda seed=seed: synthesise("erri_low", 1e6, step, seed))
        prime_time, _ = timed(
            lambda seed=seed: synthesise("erri_low", (prime - 1) * step, step, seed)
        )
        samples = own.level.size
        normal = np.random.RandomState(seed).standard_normal(samples + 1).view(np.complex128)
        peer_time, _ = timed(lambda c=normal, n=samples: np.fft.irfft(c, n))
        own_times.append(own_time)
        prime_times.append(prime_time)
        peer_times.append(peer_time)
    return {
        "own": own_times,
        "prime": prime_times,
        "peer": peer_times,
        "samples": samples,
        "prime_samples": prime,
    }


WORKERS = {
    "ride": ride,
    "a_wrms": a_wrms,
    "frequency": frequency,
    "comfort": comfort,
    "comfort-peer": comfort_peer,
    "synthesise": synthesise,
    "derive-railride": derive_railride,
    "derive-sympy": derive_sympy,
}

if __name__ == "__main__":
    json.dump(WORKERS[sys.argv[1]](), sys.stdout)
