"""The comparisons: what each one runs, and what it is meant to reach.

Every case returns one dictionary: `name`, `railride_s` and `peer_s` (medians, s), `ratio` (railride
over peer), what the two sides were, and `targets`, each a quantity with its value, its bound and
whether it is met.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Any

from measure import interleaved, median, run, worker

Case = Callable[[Callable[[], None]], dict[str, Any]]
DERIVE = ("-m", "railride.derive", "--segments")


def ride(step: Callable[[], None]) -> dict[str, Any]:
    """Time simulation of 1 km at 1 kHz, N = 4, both sides alternating in one process."""
    found = worker("ride")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "ride",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.response.simulate, wall time",
        peer="control.forced_response on the same matrices and input, wall time",
        samples=found["samples"],
        states=found["states"],
        inputs=found["inputs"],
        targets=[
            at_least("times faster", peer / own, 15),
            at_most("largest difference / largest value", found["difference"], 1e-9),
        ],
    )


def a_wrms(step: Callable[[], None]) -> dict[str, Any]:
    """The exact weighted r.m.s. of one vehicle at one speed, and of many at two, N = 4."""
    found = worker("a_wrms")
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


def derive_linearise(step: Callable[[], None]) -> dict[str, Any]:
    """Energies to linear matrices at N = 8, each run in a fresh process, imports not counted.

    The peer takes about a minute, so it is run twice only.
    """
    sides = (lambda: worker("derive-railride"), lambda: worker("derive-sympy"))
    own_runs, peer_runs = interleaved(sides, DERIVE_ROUNDS, step)
    own = median([r["seconds"] for r in own_runs])
    peer = median([r["seconds"] for r in peer_runs])
    difference = max(r["difference"] for r in peer_runs)
    return entry(
        "derive-linearise",
        own,
        peer,
        rounds=DERIVE_ROUNDS,
        railride="derive_vehicle(cati2024, segments=8).linear from scratch, wall time",
        peer="sympy LagrangesMethod, form_lagranges_equations, linearize; same energies, written "
        "out, without the rates of the inputs, which it refuses; wall time",
        targets=[
            at_least("times faster", peer / own, 100),
            at_most("largest difference / largest value, M C K K_w", difference, 1e-9),
        ],
    )


def derive_process(step: Callable[[], None]) -> dict[str, Any]:
    """CPU of the whole process ``python -m railride.derive --segments 4`` against a bare sympy."""
    sides = (lambda: run(*DERIVE, "4").cpu, lambda: run("-c", "import sympy").cpu)
    # Once unmeasured: the byte code is written, the files are in memory.
    interleaved(sides, 1, lambda: None)
    own, peer = (median(times) for times in interleaved(sides, PROCESS_ROUNDS, step))
    return entry(
        "derive-process",
        own,
        peer,
        rounds=PROCESS_ROUNDS,
        railride="python -m railride.derive --segments 4, CPU of the whole process",
        peer='python -c "import sympy", CPU of the whole process',
        targets=[at_most("ratio", own / peer, 3)],
    )


def derive_growth(step: Callable[[], None]) -> dict[str, Any]:
    """How the CPU of ``python -m railride.derive --segments N`` grows: N = 64 over N = 16.

    Both less the CPU of N = 1, the start of the program. The exponent is that of N^x between them.
    """
    segments = (1, 16, 32, 64)
    sides = [partial(run, *DERIVE, str(n)) for n in segments]
    sides[0]()
    runs = dict(zip(segments, interleaved(sides, GROWTH_ROUNDS, step), strict=True))
    cpu = {n: median([r.cpu for r in runs[n]]) for n in segments}
    peak = max(r.peak for r in runs[64]) / 1e6
    own, peer = cpu[64] - cpu[1], cpu[16] - cpu[1]
    # No growth to speak of is an exponent of nothing, not of a logarithm of noise.
    exponent = math.log(own / peer) / math.log(64 / 16) if own > 0 and peer > 0 else math.nan
    return entry(
        "derive-growth",
        own,
        peer,
        rounds=GROWTH_ROUNDS,
        railride="python -m railride.derive --segments 64, CPU less that of --segments 1",
        peer="the same program with --segments 16, CPU less that of --segments 1",
        cpu_s={str(n): cpu[n] for n in segments},
        peak_memory_mb=peak,
        targets=[
            at_most("exponent from N = 16 to 64", exponent, 1.6),
            at_most("peak memory at N = 64, MB", peak, 500),
        ],
    )


def frequency(step: Callable[[], None]) -> dict[str, Any]:
    """Frequency response at 100,000 frequencies, N = 8, one output, four wheelsets with delays."""
    found = worker("frequency")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "frequency",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.frequency.track_response, matrices from parameters included, wall time",
        peer="control.frequency_response (without slycot) on the state space with inputs w, w' of "
        "the four wheelsets, delays put in after; wall time",
        frequencies=found["frequencies"],
        states=found["states"],
        peer_difference=found["peer_difference"],
        targets=[
            at_least("times faster", peer / own, 20),
            at_most("largest difference from a direct solve / largest value",
                    found["difference"], 1e-9),
        ],
    )  # fmt: skip


def comfort(step: Callable[[], None]) -> dict[str, Any]:
    """All comfort indices of an hour of three axes at 1 kHz, once loaded, in one process."""
    found, other = worker("comfort"), worker("comfort-peer")
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
    found = worker("synthesise")
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


def designs(step: Callable[[], None]) -> dict[str, Any]:
    """Designs of the suspension at two speeds, N = 4, at once and in a plain loop."""
    found = worker("designs", STUDIES)
    step()
    own = median(found["own"]) / found["designs"]
    peer = median(found["peer"])
    return entry(
        "designs",
        own,
        peer,
        rounds=len(found["own"]),
        railride="evaluate_designs of 5000 suspensions, from parameters to the table of a_wrms at "
        "145 and 200 km/h, wall time of one design",
        peer="for each design and speed: build, control.forced_response of vehicle and weighting "
        "in series, 1 km at 1 kHz and 250 m of run-in, r.m.s.; wall time of one design",
        designs_a_second=1 / own,
        with_travel_and_modes_a_second=found["designs"] / median(found["all"]),
        measured_track_a_second=found["measured_designs"] / median(found["measured"]),
        peer_scatter=found["peer_ratio"],
        targets=[
            at_least("designs a second, at two speeds", 1 / own, 5000),
            at_least("times faster", peer / own, 800),
        ],
    )


def gradient(step: Callable[[], None]) -> dict[str, Any]:
    """a_wrms at two speeds with its gradient over 12 parameters, and alone, by quadrature."""
    found = worker("gradient", STUDIES)
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "gradient",
        own,
        peer,
        rounds=len(found["own"]),
        railride="Derivatives.at and mean_squares_with_gradient, 12 parameters, two speeds, wall "
        "time",
        peer="matrices and process().integrals(), the value alone by the same quadrature, wall "
        "time",
        parameters=found["parameters"],
        targets=[
            at_most("times the value's time", own / peer, 3),
            at_most("largest difference of the values, relative", found["difference"], 1e-12),
        ],
    )


def sweep(step: Callable[[], None]) -> dict[str, Any]:
    """A sweep of 40,000 designs in one and in two processes, between two busy loops."""
    found = worker("sweep", STUDIES)
    step()
    own, peer = median(found["both"]), median(found["alone"])
    loops = 2 * median(found["loop_alone"]) / median(found["loop_both"])
    return entry(
        "sweep",
        own,
        peer,
        rounds=len(found["both"]),
        railride="railride.sweep, two processes, from the first part on disk to the last",
        peer="the same with one process",
        designs=found["designs"],
        gain_of_busy_loops=loops,
        targets=[at_least("gain of two processes, of two busy loops'", peer / own / loops, 0.9)],
    )


def million(step: Callable[[], None]) -> dict[str, Any]:
    """10⁶ designs from the study file to Parquet, all processors."""
    found = worker("million", STUDIES)
    step()
    each = found["whole"] / found["designs"]
    return entry(
        "million",
        found["whole"],
        found["designs"] / 5000,
        rounds=1,
        railride="railride.sweep of 10⁶ samples, one process for each core, wall time of the whole",
        peer="the time that 5,000 designs a second would take",
        workers=found["workers"],
        bytes_a_design=found["bytes"] / found["designs"],
        hours_of_a_core_for_1e8=1e8 * each * found["workers"] / 3600,
        targets=[
            at_most("peak memory of the coordinator, MB", found["peak"] / 1e6, 1000),
            at_most("peak memory of a process, MB", found["worker_peak"] / 1e6, 1000),
        ],
    )


def optimise(step: Callable[[], None]) -> dict[str, Any]:
    """The best (k_2, c_2, c_1) of the paper's coach at two speeds, N = 4."""
    found = worker("optimise", STUDIES)
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "optimise",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.optimise, model in hand, derivatives prepared anew, wall time",
        peer="scipy.optimize.minimize by Powell's method on evaluate_designs, without gradients, "
        "wall time",
        a_wrms=found["a_wrms"],
        peer_a_wrms=found["peer_a_wrms"],
        targets=[
            at_most("time, s", own, 2),
            at_most("a_wrms over the peer's", found["a_wrms"] / found["peer_a_wrms"], 1.0001),
        ],
    )


STUDIES = "study_workers.py"
DERIVE_ROUNDS, PROCESS_ROUNDS, GROWTH_ROUNDS = 2, 7, 3

CASES: dict[str, tuple[Case, int]] = {
    "ride": (ride, 1),
    "a_wrms": (a_wrms, 1),
    "derive-linearise": (derive_linearise, DERIVE_ROUNDS),
    "derive-process": (derive_process, PROCESS_ROUNDS),
    "derive-growth": (derive_growth, GROWTH_ROUNDS),
    "frequency": (frequency, 1),
    "comfort": (comfort, 1),
    "synthesise": (synthesise, 1),
    "designs": (designs, 1),
    "gradient": (gradient, 1),
    "sweep": (sweep, 1),
    "million": (million, 1),
    "optimise": (optimise, 1),
}
"""Name to the case and the number of its steps."""


def entry(
    name: str, own_s: float, peer_s: float, /, *, targets: list[dict[str, Any]], **more: Any
) -> dict[str, Any]:
    """One object of results.json."""
    return {
        "name": name,
        "railride_s": own_s,
        "peer_s": peer_s,
        "ratio": own_s / peer_s,
        "met": all(target["met"] for target in targets),
        "targets": targets,
        **more,
    }


def at_least(quantity: str, value: float, bound: float) -> dict[str, Any]:
    """A target that is met from `bound` upwards."""
    return {"quantity": quantity, "value": value, "at_least": bound, "met": value >= bound}


def at_most(quantity: str, value: float, bound: float) -> dict[str, Any]:
    """A target that is met up to `bound`."""
    return {"quantity": quantity, "value": value, "at_most": bound, "met": value <= bound}
