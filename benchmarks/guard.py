"""Guard against growing work: ``python benchmarks/guard.py [--keep]`` counts instructions.

Seconds differ between machines and moments; the instructions of the same work hardly do. All works
run in one process under valgrind's callgrind, each between two calls of a C function that nothing
else calls, at which callgrind writes what it has counted. They are compared with those kept in
``instructions.json``: as counts where the libraries are the same, else as ratios to what scipy's
and python-control's ways of doing the same take. What has grown by more than a tenth is told, and
the exit code is 1. ``--keep`` keeps the new counts.

Source: valgrind's manual, Callgrind, --dump-before.
"""

from __future__ import annotations

import argparse
import ctypes
import importlib
import json
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from coach import RATE, SPEED, coach, elevations_and_rates, vehicle_state_space
from measure import ROOT, environment, machine, run
from rich.console import Console
from rich.table import Table

KEPT = ROOT / "benchmarks" / "instructions.json"
MARK = "srand48_r"
"""A function of the C library that no work calls; on entering it callgrind writes its counts."""
GROWN = 1.1
"""Two counts of the same differ by one in a thousand, even while the machine does other work."""
PEER_OF = {
    work: "frequency, control" if work == "frequency" else "ride, scipy"
    for work in ("import", "derive", "ride", "frequency", "a_wrms", "designs", "comfort")
}
"""What a work is measured in where the libraries differ."""


def works() -> dict[str, Callable[[], Any]]:
    """Each work by its name, everything loaded and derived that is not part of it."""
    import control
    import numpy as np
    import scipy.signal

    from railride.designs import evaluate_designs
    from railride.frequency import track_response
    from railride.response import simulate
    from railride.rides import ride
    from railride.spectra import spectrum
    from railride.stochastic import weighted_rms
    from railride.vehicle import derive_vehicle
    from railride.weightings import weighting

    A, B, C, D, delays = vehicle_state_space()
    t = np.arange(10_000) / RATE
    u = elevations_and_rates(t, delays, waves=20)
    model = coach()
    rows, m = model.output_rows([model.floor()]), model.matrices()
    f = np.geomspace(0.2, 40.0, 2000)
    plant, omega = control.ss(A, B, C, D), 2 * np.pi * f
    places, track, weight = model.vehicle.wheelset_positions, spectrum("erri_low"), weighting("Wk")
    softer = {"k_2": np.linspace(4e5, 12e5, 200)}
    return {
        "derive": lambda: derive_vehicle("cati2024", segments=3).matrices(),
        "ride": lambda: simulate(A, B, C, D, u, 1 / RATE),
        "ride, scipy": lambda: scipy.signal.lsim((A, B, C, D), u.T, t),
        "frequency": lambda: track_response(model, [model.floor()], SPEED, f),
        "frequency, control": lambda: control.frequency_response(plant, omega, squeeze=False),
        "a_wrms": lambda: weighted_rms(m, rows, places, SPEED, track, weight),
        "designs": lambda: evaluate_designs(model, softer, "erri_low", [SPEED]),
        "comfort": lambda: ride(model, "erri_low", [SPEED], length=200.0),
    }


def worked() -> list[str]:
    """Do every work between two marks, and give their names: this is what callgrind watches.

    The import is the program's start; the others are done once before, for what they load and keep.
    """
    mark = ctypes.CDLL(None).srand48
    mark(0)
    importlib.import_module("railride.cli")
    mark(0)
    found = works()
    for work in found.values():
        work()
        mark(0)
        work()
        mark(0)
    return ["import", *found]


def counted() -> dict[str, int]:
    """Instructions of every work.

    Raises SystemExit where valgrind is not installed or the works fail.
    """
    valgrind = shutil.which("valgrind")
    if valgrind is None:
        sys.exit("guard: found no valgrind; expected it installed: it counts the instructions")
    run("-c", "import railride.cli")  # its byte code is there, as where it is installed
    own = environment() | {"PYTHONHASHSEED": "0", "OPENBLAS_CORETYPE": "Haswell"}
    with tempfile.TemporaryDirectory() as folder:
        command = [valgrind, "--tool=callgrind", f"--dump-before={MARK}",
                   f"--callgrind-out-file={folder}/out", sys.executable, __file__,
                   "--work"]  # fmt: skip
        done = subprocess.run(command, env=own, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(f"guard: the works ended with {done.returncode}: {done.stderr[-800:]}")
        parts = sorted(Path(folder).glob("out.*"), key=lambda path: int(path.suffix[1:]))
        totals = [int(re.findall(r"^totals: (\d+)", path.read_text(), re.MULTILINE)[0])
                  for path in parts]  # fmt: skip
    names = json.loads(done.stdout)
    return dict(zip(names, totals[1::2], strict=True))


def compared(now: dict[str, int], kept: dict[str, Any]) -> list[tuple[str, float, float, float]]:
    """Of every work of railride: what is compared, kept and now, and how much it has grown."""
    alike = kept["versions"] == _libraries()
    rows = []
    for name, peer in PEER_OF.items():
        unit, old = (1, 1) if alike else (now[peer], kept["instructions"][peer])
        before, after = kept["instructions"][name] / old, now[name] / unit
        rows.append((name if alike else f"{name} / {peer}", before, after, after / before))
    return rows


def _libraries() -> dict[str, str]:
    """Versions of Python and of all that the works call."""
    return {name: of for name, of in machine()["versions"].items() if name != "railride"}


def main(arguments: list[str] | None = None) -> int:
    """Count, compare, and keep if asked."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("--keep", action="store_true", help="keep the new counts")
    parser.add_argument("--work", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.work:
        json.dump(worked(), sys.stdout)
        return 0
    console = Console()
    with Console(stderr=True).status("counting instructions, a minute or two"):
        now = counted()
    if options.keep:
        text = json.dumps({"instructions": now, "versions": _libraries()}, indent=2)
        KEPT.write_text(text + "\n", encoding="utf-8")
        return 0
    rows = compared(now, json.loads(KEPT.read_text(encoding="utf-8")))
    shown = Table("work", "kept", "now", "times", title="instructions")
    for name, before, after, times in rows:
        shown.add_row(name, f"{before:.4g}", f"{after:.4g}", f"{times:.3f}",
                      style="red" if times > GROWN else None)  # fmt: skip
    console.print(shown)
    return int(any(times > GROWN for *_, times in rows))


if __name__ == "__main__":
    sys.exit(main())
