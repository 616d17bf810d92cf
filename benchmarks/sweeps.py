"""Sweeps: the cases, and what is timed inside processes of their own.

The paper's coach, N = 4, at the paper's two speeds over ERRI low, read at the floor's middle.
"""

from __future__ import annotations

import multiprocessing
import os
import resource
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from entry import at_least, at_most, entry
from measure import Case, answer, median, worker

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


def sweep(step: Callable[[], None]) -> dict[str, Any]:
    """A sweep of 40,000 designs in one and in two processes, between two busy loops."""
    found = worker(__file__, "sweep")
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
    found = worker(__file__, "million")
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


def time_sweep(rounds: int = 3) -> dict[str, Any]:
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


def time_million() -> dict[str, Any]:
    """10⁶ designs in one process for every core; the peak memory of each process."""
    with tempfile.TemporaryDirectory() as folder:
        found = swept(Path(folder, "million"), MANY_SWEPT, os.cpu_count() or 1)
    kilobytes = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    scale = 1 if sys.platform == "darwin" else 1024
    return {**found, "workers": os.cpu_count() or 1, "worker_peak": kilobytes * scale}


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


CASES: dict[str, Case] = {
    "sweep": (sweep, 1),
    "million": (million, 1),
}
WORKERS = {
    "sweep": time_sweep,
    "million": time_million,
}

if __name__ == "__main__":
    answer(WORKERS)
