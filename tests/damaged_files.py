"""Damaged parameter, study and track files by the thousand, each given to a command.

    python tests/damaged_files.py --count 10000 --seed 1
    python tests/damaged_files.py --count 10000 --seed 1 --processes 300
    python tests/damaged_files.py --seed 1 --from 4711 --count 1

Each case depends on the seed and its index alone: what was interrupted goes on with --from, and one
that fails is tried again by its index. Its files are kept, with its command and what is wrong.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from damage_cases import ROOT, Case, Outcome, case, run_here, run_process
from damage_faults import faults


def keep(folder: Path, seed: int, case: Case, found: Outcome, wrong: list[str]) -> Path:
    """The files of a case that failed, and what is wrong with it."""
    place = folder / f"{seed}-{case.index}"
    place.mkdir(parents=True, exist_ok=True)
    for file, content in case.files.items():
        (place / file).write_bytes(content)
    again = f"python tests/damaged_files.py --seed {seed} --from {case.index} --count 1"
    told = [*wrong, "", f"{case.source.kind}, {case.damage}", case.line, again]
    (place / "what.txt").write_text("\n".join([*told, "", found.out[:5000], found.err[-5000:]]),
                                    encoding="utf-8")  # fmt: skip
    return place


def main() -> None:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn
    from rich.table import Table

    given = _arguments()
    console, counts, slowest, failed = Console(), Counter[tuple[str, Any]](), [], 0
    indices: Sequence[int] = range(given.start, given.start + given.count)
    run = run_here
    if given.processes:
        run, some = run_process, min(given.processes, given.count)
        indices = sorted(random.Random(given.seed).sample(indices, some))  # noqa: S311
    began = time.perf_counter()
    columns = (BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    with Progress(*columns, console=console) as bar:
        for index in bar.track(indices, description="damaged files"):
            one = case(given.seed, index)
            found = run(one.command, one.files)
            wrong = faults(one, found)
            counts[one.source.kind, found.code] += 1
            counts[one.source.kind, "same"] += one.same
            counts[one.source.kind, "wrong"] += bool(wrong)
            slowest = sorted([*slowest, (found.seconds, index)], reverse=True)[:5]
            if wrong:
                failed += 1
                place = keep(given.keep, given.seed, one, found, wrong)
                console.print(f"{index}: {'; '.join(wrong)}\n  {one.line}\n  {one.damage}\n"
                              f"  {place}", markup=False, highlight=False)  # fmt: skip
    took = time.perf_counter() - began
    table = Table("files", "exit 0", "exit 2", "other", "unchanged in meaning", "wrong")
    for kind in sorted({kind for kind, _ in counts}):
        codes = {key: n for (of, key), n in counts.items() if of == kind}
        other = sum(n for key, n in codes.items() if key not in (0, 2, "same", "wrong"))
        table.add_row(kind, *(str(codes.get(k, 0)) for k in (0, 2)), str(other),
                      *(str(codes.get(k, 0)) for k in ("same", "wrong")))  # fmt: skip
    console.print(table)
    console.print(f"{len(indices)} in {took:.0f} s, {len(indices) / took:.1f}/s; the slowest: "
                  + ", ".join(f"{index} ({s:.1f} s)" for s, index in slowest))  # fmt: skip
    sys.exit(1 if failed else 0)


def _arguments() -> argparse.Namespace:
    plain = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=plain)
    add = parser.add_argument
    add("--count", type=int, default=10_000, help="how many files")
    add("--seed", type=int, default=1)
    add("--from", type=int, default=0, dest="start", help="the first index")
    add("--processes", type=int, default=0, help="so many of them at random, each as a process")
    add(
        "--keep", type=Path, default=ROOT / "build" / "damaged", help="the files of those that fail"
    )
    return parser.parse_args()


if __name__ == "__main__":
    main()
