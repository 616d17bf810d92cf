"""Writing results: a table, one JSON document or CSV, to standard output or to a file."""

from __future__ import annotations

import functools
import io
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any, ParamSpec

import typer

from railride.errors import InputError

P = ParamSpec("P")


def exits_cleanly(command: Callable[P, None]) -> Callable[P, None]:
    """A command that says what is wrong with the input in one message and exits with 2."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            command(*args, **kwargs)
        except InputError as error:
            typer.echo(f"railride: {error}", err=True)
            raise typer.Exit(2) from None
        except BrokenPipeError:  # the reader, such as head, has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None

    return run


def check_output(path: str | None) -> None:
    """Refuse a file that cannot be written, before any work is done for it."""
    if path is None:
        return
    target = Path(path)
    if not path or target.is_dir():
        raise InputError(f"--output {path!r}: found a folder; expected the name of a file")
    if not target.parent.is_dir():
        raise InputError(f"--output {path!r}: found no folder {str(target.parent)!r}; expected one "
                         "that exists (make it first)")  # fmt: skip
    if not os.access(target.parent, os.W_OK):
        raise InputError(f"--output {path!r}: found a folder that cannot be written; expected one "
                         "that can (choose another)")  # fmt: skip


def check_folder(path: str | None, option: str) -> None:
    """Refuse a folder that neither exists and is writable, nor can be made."""
    if path is None:
        return
    target = Path(path)
    if target.exists() and not target.is_dir():
        raise InputError(f"{option} {path!r}: found a file; expected a folder")
    nearest = next(p for p in (target, *target.absolute().parents) if p.exists())
    if not nearest.is_dir() or not os.access(nearest, os.W_OK):
        raise InputError(f"{option} {path!r}: found a folder that cannot be written; expected one "
                         "that can (choose another)")  # fmt: skip


def write(text: str, path: str | None) -> None:
    """The result to standard output, or to a file as a whole."""
    text = text if text.endswith("\n") else text + "\n"
    if path is None:
        sys.stdout.write(text)
        sys.stdout.flush()
    else:
        from railride.files import write_text

        write_text(path, text)


def remark(remarks: Iterable[str]) -> None:
    """Remarks to standard error, each on its own."""
    for line in remarks:
        typer.echo(f"remark: {line}", err=True)


def json_text(document: Mapping[str, Any]) -> str:
    """One JSON document; numbers unrounded, what is not finite as null."""
    return json.dumps(_clean(document), ensure_ascii=False, allow_nan=False)


def csv_text(rows: Sequence[Mapping[str, Any]]) -> str:
    """Rows as CSV with a header."""
    import csv

    stream = io.StringIO()
    writer = csv.DictWriter(stream, fieldnames=list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: "" if v is None else v for key, v in row.items()} for row in rows)
    return stream.getvalue()


def table_text(
    title: str, columns: Sequence[tuple[str, str]], rows: Iterable[Sequence[Any]]
) -> str:
    """A table as text: columns as (heading, format), None as a dash."""
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(title=title, box=box.SIMPLE_HEAD, title_justify="left", title_style="bold",
                  pad_edge=False)  # fmt: skip
    for heading, spec in columns:
        table.add_column(heading, justify="left" if not spec else "right", overflow="fold")
    for row in rows:
        table.add_row(*(
            "-" if value is None else format(value, spec)
            for value, (_, spec) in zip(row, columns, strict=True)
        ))  # fmt: skip
    stream = io.StringIO()
    terminal = sys.stdout.isatty()
    console = Console(file=stream, width=None if terminal else 120, force_terminal=terminal,
                      highlight=False)  # fmt: skip
    console.print(table)
    return stream.getvalue()


def _clean(value: Any) -> Any:
    """Numpy's numbers and arrays as Python's; NaN and infinity as None."""
    if isinstance(value, Mapping):
        return {str(key): _clean(v) for key, v in value.items()}
    if hasattr(value, "tolist"):
        return _clean(value.tolist())
    if isinstance(value, list | tuple):
        return [_clean(v) for v in value]
    if isinstance(value, float) and not isfinite(value):
        return None
    return value
