"""Design studies, timed inside a process of their own: ``python study_workers.py NAME``.

As ``workers.py``, which see; these are the paper's coach, N = 4, at the paper's two speeds over
ERRI low, read at the floor's middle.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import resource
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from workers import FASTER, LENGTH, RATE, RUN_IN, SPEED, timed

SPEEDS = (SPEED, FASTER)
SUSPENSION = ("k_1", "c_1", "k_2", "c_2")
DESIGNS, MEASURED_DESIGNS, LOOPED = 5000, 100, 3
"""At once; of those over a measured track; and one by one, by the peer."""
TWELVE = (*SUSPENSION, "m_c", "m_b", "I_b", "L", "f_bending", "zeta_bending", "l_b", "l_w")
SWEPT, MANY_SWEPT = 40_000, 1_000_000
STUDY = """
vehicle = "cati2024"
[body]
segments = 4
[ride]
speeds = ["145 km/h", "200 km/h"]
[sweep]
kind = "samples"
number = {number}
chunk = 5000
[parameters]
k_1 = {{ distribution = "uniform", from = "2.5e6 N/m", to = "10e6 N/m" }}
c_1 = {{ distribution = "uniform", from = "15e3 N s/m", to = "60e3 N s/m" }}
k_2 = {{ distribution = "uniform", from = "375e3 N/m", to = "1500e3 N/m" }}
c_2 = {{ distribution = "uniform", from = "35e3 N s/m", to = "140e3 N s/m" }}
"""
OPTIMISED = {"k_2": (300e3, 1500e3), "c_2": (20e3, 200e3), "c_1": (10e3, 100e3)}


def coach() -> Any:
    """The paper's coach with its segments, derived."""
    from railride.vehicle import derive_vehicle

    model = derive_vehicle("cati2024", segments=4)
    model.matrices()
    return model


def random_designs(model: Any, count: int) -> dict[str, Any]:
    """Suspensions of half to twice the vehicle's."""
    import numpy as np

    rng, values = np.random.default_rng(1), model.values()
    return {name: values[name] * rng.uniform(0.5, 2.0, count) for name in SUSPENSION}


def designs(rounds: int = 5) -> dict[str, Any]:
    """Designs at once, and a plain loop: build, forced_response, weighting, r.m.s.

    The loop's ride is 1 km at 1 kHz after its run-in over one sample of the same spectrum.
    """
    import numpy as np

    from railride.designs import evaluate_designs
    from railride.spectra import spectrum
    from railride.track import synthesise

    model, track = coach(), spectrum("erri_low")
    many, few = random_designs(model, DESIGNS), random_designs(model, MEASURED_DESIGNS)
    loop = plain_loop(model, synthesise(track, RUN_IN + LENGTH + 50.0, 0.05, 1).with_taper(50.0))
    measured = synthesise(track, 2000.0, 0.25, 3)
    own_times, all_times, measured_times, peer_times, own, peer = [], [], [], [], None, []
    for _ in range(rounds):
        seconds, own = timed(lambda: evaluate_designs(model, many, track, SPEEDS).table())
        own_times.append(seconds)
        seconds, _ = timed(lambda: evaluate_designs(
            model, many, track, SPEEDS, results=("a_wrms", "travel", "modes")).table())  # fmt: skip
        all_times.append(seconds)
        seconds, _ = timed(lambda: evaluate_designs(model, few, measured, SPEEDS).table())
        measured_times.append(seconds)
        for k in range(LOOPED):
            chosen = {name: values[k] for name, values in many.items()}
            seconds, found = timed(lambda c=chosen: [loop(c, speed) for speed in SPEEDS])
            peer_times.append(seconds)
            peer.append(found)
    exact = own[[c for c in own if c.startswith("a_wrms")]].to_numpy()[:LOOPED]
    return {
        "own": own_times,
        "all": all_times,
        "measured": measured_times,
        "peer": peer_times,
        "designs": DESIGNS,
        "measured_designs": MEASURED_DESIGNS,
        "peer_ratio": float(np.abs(np.array(peer[:LOOPED]) / exact - 1).max()),
    }


def plain_loop(model: Any, line: Any) -> Any:
    """a_wrms of a design at a speed, by what a user of python-control would write."""
    import control
    import numpy as np

    from railride.statespace import state_space
    from railride.weightings import weighting

    places = np.array(model.vehicle.wheelset_positions)
    weight = control.ss(weighting("Wk").transfer_function())

    def a_wrms(design: dict[str, float], speed: float) -> float:
        felt = control.series(state_space(model.changed(**design)), weight)
        rated = round(LENGTH / speed * RATE)
        t = np.arange(round((RUN_IN + LENGTH) / speed * RATE) + 1) / RATE
        behind = places[0] - places[:, np.newaxis]
        w, slope = line.elevation(line.distance0 + speed * t - behind)
        forces = np.zeros((felt.ninputs - 2 * len(places), t.size))
        u = np.vstack([w - w[:, :1], speed * slope, forces])
        a_w = control.forced_response(felt, t, u, squeeze=False).outputs[0, -rated:]
        return float(np.sqrt(np.mean(a_w**2)))

    return a_wrms


def gradient(rounds: int = 60) -> dict[str, Any]:
    """a_wrms by quadrature, and with its gradient over twelve parameters; both from values on."""
    import numpy as np

    from railride.sensitivities import Derivatives, mean_squares_with_gradient
    from railride.spectra import spectrum
    from railride.stochastic import process
    from railride.stochastic.gains import weighted
    from railride.stochastic.ride import floor_rows
    from railride.weightings import weighting

    model, track = coach(), spectrum("erri_low")
    gains, places = (weighted(weighting("Wk")),), model.vehicle.wheelset_positions
    derivatives = Derivatives(model, TWELVE)

    def value() -> Any:
        m, rows = model.matrices(), floor_rows(model, [0.0], "smooth", {})
        return [process(m, rows, places, V, track, gains).integrals().mean_square for V in SPEEDS]

    def with_gradient() -> Any:
        at = derivatives.at()
        return mean_squares_with_gradient(at, at.floor([0.0]), SPEEDS, track, gains)

    own_times, peer_times = [], []
    for _ in range(rounds):
        seconds, (J, dJ) = timed(with_gradient)
        own_times.append(seconds)
        seconds, alone = timed(value)
        peer_times.append(seconds)
    return {
        "own": own_times,
        "peer": peer_times,
        "parameters": dJ.shape[-1],
        "difference": float(np.abs(J.ravel() / np.ravel(alone) - 1).max()),
    }


def sweep(rounds: int = 3) -> dict[str, Any]:
    """A sweep in one process and in two, and what two busy loops gain beside each other."""
    alone, both, loop_alone, loop_both = [], [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(rounds):
            loop_alone.append(busy_loops(1))
            loop_both.append(busy_loops(2))
            for workers, times in ((1, alone), (2, both)):
                place = Path(folder, f"{number}-{workers}")
                times.append(swept(place, SWEPT, workers)["seconds"])
    return {
        "alone": alone,
        "both": both,
        "loop_alone": loop_alone,
        "loop_both": loop_both,
        "designs": SWEPT,
    }


def swept(folder: Path, number: int, workers: int) -> dict[str, Any]:
    """Sweep so many samples into a folder, from study file to parts on disk.

    seconds : that all of it would take at the rate between the first part of the last process
    and the end, in which no process starts any more.
    """
    import railride as rr

    folder.mkdir()
    study = folder / "study.toml"
    study.write_text(STUDY.format(number=number), encoding="utf-8")
    done: list[tuple[float, int]] = []
    begun = time.perf_counter()
    found = rr.sweep(
        study,
        folder / "parts",
        workers=workers,
        progress=lambda ready, _: done.append((time.perf_counter(), ready)),
    )
    whole = time.perf_counter() - begun
    settled = [(at, ready) for at, ready in done if ready][workers - 1 :]
    (first, had), (last, has) = settled[0], settled[-1]
    size = sum(path.stat().st_size for path in (folder / "parts").rglob("*") if path.is_file())
    return {
        "whole": whole,
        "seconds": (last - first) / (has - had) * number,
        "designs": found.done,
        "bytes": size,
    }


def busy_loops(count: int) -> float:
    """Wall time of so many processes that each turn one loop of numpy's small matrices."""
    context = multiprocessing.get_context("spawn")
    ready, start = context.Barrier(count + 1), context.Barrier(count + 1)
    processes = [context.Process(target=turn, args=(ready, start)) for _ in range(count)]
    for process in processes:
        process.start()
    ready.wait()
    begun = time.perf_counter()
    start.wait()
    for process in processes:
        process.join()
    return time.perf_counter() - begun


def turn(ready: Any, start: Any) -> None:
    """One busy loop, of the kind that a sweep is: eigenvalues of many small matrices."""
    import numpy as np

    A = np.random.default_rng(0).standard_normal((2000, 18, 18))
    np.linalg.eig(A)
    ready.wait()
    start.wait()
    for _ in range(20):
        np.linalg.eig(A)


def million() -> dict[str, Any]:
    """10⁶ designs in one process for every core; the peak memory of each process."""
    with tempfile.TemporaryDirectory() as folder:
        found = swept(Path(folder, "million"), MANY_SWEPT, os.cpu_count() or 1)
    kilobytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    scale = 1 if sys.platform == "darwin" else 1024
    return {**found, "workers": os.cpu_count() or 1, "worker_peak": kilobytes * scale}


def optimise(rounds: int = 5) -> dict[str, Any]:
    """The best (k_2, c_2, c_1) of the paper's coach: by exact gradients, and by a search without.

    Every round begins with a model that was just derived.
    """
    from scipy.optimize import minimize

    import railride as rr
    from railride.designs import evaluate_designs

    times, found = [], None
    for _ in range(rounds):
        model = coach()
        seconds, found = timed(lambda m=model: rr.optimise(m, OPTIMISED, SPEEDS))
        times.append(seconds)
    model = coach()
    start = {name: float(model.values()[name]) for name in OPTIMISED}

    def objective(scaled: Any) -> float:
        given = {name: [x * start[name]] for name, x in zip(start, scaled, strict=True)}
        return float((evaluate_designs(model, given, "erri_low", SPEEDS).a_wrms ** 2).mean())

    bounds = [(low / start[name], high / start[name]) for name, (low, high) in OPTIMISED.items()]
    peer, by = timed(lambda: minimize(objective, [1.0] * 3, bounds=bounds, method="Powell"))
    return {
        "own": times,
        "peer": [peer],
        "a_wrms": float(found.a_wrms),
        "peer_a_wrms": float(by.fun**0.5),
    }


WORKERS = {
    "designs": designs,
    "gradient": gradient,
    "sweep": sweep,
    "million": million,
    "optimise": optimise,
}

if __name__ == "__main__":
    json.dump(WORKERS[sys.argv[1]](), sys.stdout)
