"""Measure railride against its peers: ``python benchmarks/run.py [CASE ...]``.

Prints a table and writes ``results.json`` beside this file, and from it the README's table and its
picture; cases that are not run keep what was last measured of them. Progress goes to standard
error. The exit code is 1 if a case could not be measured; a target that is missed is shown and is
no failure of the measurement.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import report
from cases import CASES
from measure import machine
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

RESULTS = Path(__file__).with_name("results.json")


def main(arguments: list[str] | None = None) -> int:
    """Run the named cases, or all."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("case", nargs="*", help=f"any of {', '.join(CASES)}; all if none is named")
    parser.add_argument("--output", type=Path, default=RESULTS, help="where the JSON goes")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.case if name not in CASES]
    if unknown:
        parser.error(f"found the case {unknown[0]!r}; expected any of {', '.join(CASES)}")
    names = [name for name in CASES if not options.case or name in options.case]
    console = Console(stderr=True)
    measured = measure(names, console, partial(keep, options.output))
    if options.output == RESULTS:
        report.main()
    width = None if sys.stdout.isatty() else 140
    Console(width=width).print(table([measured[name] for name in names if name in measured]))
    return 0 if len(measured) == len(names) else 1


def measure(
    names: list[str], console: Console, keep: Callable[[dict[str, Any]], None]
) -> dict[str, dict[str, Any]]:
    """Each case's entry by its name, kept at once; what cannot be measured is told and left out."""
    where, measured = machine(), {}
    columns = (TextColumn("{task.description:<18}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console) as progress:
        for name in names:
            case, steps = CASES[name]
            task = progress.add_task(name, total=steps)
            begun = time.perf_counter()
            try:
                measured[name] = case(partial(progress.advance, task)) | {"machine": where}
            except Exception as error:  # noqa: BLE001  the other cases are measured all the same
                console.print(f"{name}: not measured: {error}", markup=False, style="red")
            else:
                keep(measured[name])
                took = time.perf_counter() - begun
                console.print(f"{name}: measured in {took:.0f} s", highlight=False)
    return measured


def table(entries: list[dict[str, Any]]) -> Table:
    """One row per target."""
    result = Table(
        "case", "railride s", "peer s", "ratio", "target", "bound", "found", "met",
        title="railride and its peers, one BLAS thread, medians",
    )  # fmt: skip
    for column in result.columns[1:4]:
        column.justify = "right"
    for entry in entries:
        times = [f"{entry[key]:.4g}" for key in ("railride_s", "peer_s", "ratio")]
        head = [entry["name"], *times]
        for target in entry["targets"]:
            bound = f"≥ {target['at_least']:g}" if "at_least" in target else (
                f"≤ {target['at_most']:g}")  # fmt: skip
            met = "yes" if target["met"] else "[red]no[/red]"
            result.add_row(*head, target["quantity"], bound, f"{target['value']:.3g}", met)
            head = [""] * 4
    return result


def keep(path: Path, measured: dict[str, Any]) -> None:
    """Put an entry among those that the file holds, in the order of the cases."""
    results = earlier(path) | {measured["name"]: measured}
    write(path, [results[name] for name in CASES if name in results])


def earlier(path: Path) -> dict[str, dict[str, Any]]:
    """What the file holds already, by name; nothing if there is none that can be read."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
        return {entry["name"]: entry for entry in entries}
    except (OSError, ValueError, TypeError, KeyError):
        return {}


def write(path: Path, entries: list[dict[str, Any]]) -> None:
    """The whole file or nothing: written beside, then renamed. NaN is written as null."""
    text = json.dumps(_finite(entries), indent=2, ensure_ascii=False, allow_nan=False)
    beside = path.with_name(f".{path.name}.{os.getpid()}")
    beside.write_text(text + "\n", encoding="utf-8")
    beside.replace(path)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and value != value else value  # noqa: PLR0124


if __name__ == "__main__":
    sys.exit(main())
