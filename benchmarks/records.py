"""Long records and long tracks: cases, and what is timed in processes of their own."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from coach import RATE, noise
from entry import at_most, entry
from measure import Case, answer, median, timed, worker

HOUR = 3_600_001
"""Rows of an hour's record, both ends in it."""


def comfort(step: Callable[[], None]) -> dict[str, Any]:
    """All comfort indices of an hour of three axes at 1 kHz, once loaded, in one process."""
    found, other = worker(__file__, "comfort"), worker(__file__, "comfort-peer")
    step()
    own = median(found["own"])
    peer = median(other["peer"]) * found["rows"] / other["rows"]
    return entry(
        "comfort",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.comfort.rate_record, its table and its blocks; wall time",
        peer="the weighting alone: control.forced_response of W_d, W_d, W_k on a tenth of the "
        "records, its wall time times ten",
        rows=found["rows"],
        targets=[
            at_most("time, s", own, 5),
            at_most("peak memory of the process, MB", found["peak"] / 1e6, 1500),
        ],
    )


def synthesise(step: Callable[[], None]) -> dict[str, Any]:
    """1,000 km of track at 0.25 m: 4,000,001 samples, and the next prime number of them."""
    found = worker(__file__, "synthesise")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "synthesise",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.synthesise of 1,000 km at 0.25 m from erri_low, wall time",
        peer="numpy.fft.irfft of as many normal numbers: that transform alone, wall time",
        samples=found["samples"],
        prime_samples=found["prime_samples"],
        targets=[
            at_most("time, s", own, 3),
            at_most("time for a prime number of samples, s", median(found["prime"]), 3),
        ],
    )


def time_comfort(rounds: int = 3) -> dict[str, Any]:
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


def time_synthesise(rounds: int = 5) -> dict[str, Any]:
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


CASES: dict[str, Case] = {
    "comfort": (comfort, 1),
    "synthesise": (synthesise, 1),
}
WORKERS = {
    "comfort": time_comfort,
    "synthesise": time_synthesise,
    "comfort-peer": comfort_peer,
}

if __name__ == "__main__":
    answer(WORKERS)
