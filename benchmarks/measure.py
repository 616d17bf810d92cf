"""Timing of whole processes, and the conditions that both sides of a comparison run under."""

from __future__ import annotations

import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

Case = tuple[Callable[[Callable[[], None]], dict[str, Any]], int]
"""What measures, given what to call after each step, and the number of steps."""

ROOT = Path(__file__).resolve().parents[1]

ONE_THREAD = {
    f"{library}_NUM_THREADS": "1" for library in ("OPENBLAS", "OMP", "MKL", "BLIS", "NUMEXPR")
} | {"VECLIB_MAXIMUM_THREADS": "1"}
"""What keeps every usual BLAS to one thread, provided it is set before numpy is imported."""

PACKAGES = ("railride", "sympy", "numpy", "scipy", "control", "rumoca", "exudyn")


LIMIT = 600.0
"""s after which a process is ended: one that hangs must not keep the others from being measured."""


class MeasurementError(RuntimeError):
    """A process to be measured did not do its work."""


@dataclass(frozen=True)
class Usage:
    """What a process took: wall and CPU (user and system) in s, peak memory in bytes."""

    wall: float
    cpu: float
    peak: float
    output: str


def environment() -> dict[str, str]:
    """Of the processes that are measured: one thread, and byte code, as what is installed has."""
    paths = [str(ROOT / "src"), *filter(None, [os.environ.get("PYTHONPATH")])]
    found = {**os.environ, **ONE_THREAD, "PYTHONPATH": os.pathsep.join(paths)}
    found.pop("PYTHONDONTWRITEBYTECODE", None)
    return found


def run(*arguments: str) -> Usage:
    """Run ``python ARGUMENTS`` to its end, on one BLAS thread, and say what it took.

    This process must stay small: on Linux a child's peak memory starts from its parent's.

    Raises MeasurementError, with the end of what the process complained, if it fails.
    """
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as complaints:
        start = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, *arguments], env=environment(), stdout=output, stderr=complaints
        )
        too_late = threading.Timer(LIMIT, process.kill)
        too_late.start()
        _, status, used = os.wait4(process.pid, 0)
        too_late.cancel()
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        complaints.seek(0)
        if process.returncode != 0:
            end = complaints.read().decode(errors="replace").strip()[-800:]
            msg = f"python {' '.join(arguments)} ended with {process.returncode}: {end}"
            raise MeasurementError(msg)
        text = output.read().decode(errors="replace")
    unit = 1 if sys.platform == "darwin" else 1024
    return Usage(wall, used.ru_utime + used.ru_stime, float(used.ru_maxrss * unit), text)


def worker(file: str, name: str) -> dict[str, Any]:
    """What ``python FILE NAME`` measured inside itself, in a process of its own, and its ``peak``.

    That is the peak memory of the whole process, in bytes.
    """
    usage = run(file, name)
    result: dict[str, Any] = json.loads(usage.output)
    return result | {"peak": usage.peak}


def answer(workers: dict[str, Callable[[], dict[str, Any]]]) -> None:
    """Print as JSON what the worker measured that the command line names.

    Imports are not part of its times. The BLAS was set to one thread before this process started,
    and so before numpy is imported.
    """
    json.dump(workers[sys.argv[1]](), sys.stdout)


def timed(work: Callable[[], Any]) -> tuple[float, Any]:
    """Seconds of wall time, and the result."""
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def interleaved(
    sides: Sequence[Callable[[], Any]], rounds: int, step: Callable[[], None]
) -> list[list[Any]]:
    """Call A B A B …: one list of results per side. `step` is called after each round."""
    results: list[list[Any]] = [[] for _ in sides]
    for _ in range(rounds):
        for side, result in zip(sides, results, strict=True):
            result.append(side())
        step()
    return results


def median(values: Sequence[float]) -> float:
    """The middle one, which a busy moment of the machine does not move."""
    return statistics.median(values)


def machine() -> dict[str, Any]:
    """Where the numbers come from, to be stored beside them."""
    versions = {"python": platform.python_version()}
    for package in PACKAGES:
        try:
            versions[package] = metadata.version(package)
        except metadata.PackageNotFoundError:
            versions[package] = "from the checkout"
    return {
        "system": f"{platform.system()} {platform.machine()}",
        "processor": _processor(),
        "processors": os.cpu_count(),
        "blas_threads": 1,
        "versions": versions,
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor()
