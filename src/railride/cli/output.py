"""Writing results: a table, one JSON document or CSV, to standard output or to a file.

The result alone goes to standard output; remarks, progress and messages go to standard error.
"""

from __future__ import annotations

import functools
import io
import json
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import zip_longest
from math import isfinite
from pathlib import Path
from typing import Any, ParamSpec

import typer

from railride.errors import Faults, InputError

P = ParamSpec("P")

PICTURES = {"--plot": (".png", ".pdf", ".svg"), "--animate": (".gif",)}  # kinds by the option
INTERRUPTED = 130  # as shells say it: 128 and the number of the signal
_TOO_MUCH = (
    "railride: found too little memory for what was asked; expected it to fit (a shorter track, a "
    "higher speed, a coarser step or fewer segments need less)"
)
_OURS = (
    "railride: this is a fault of the program, not of what you gave it. Please report it with the "
    "lines above and the command."
)


def exits_cleanly(command: Callable[P, None]) -> Callable[P, None]:
    """A command that ends with 0, or says in one message what is wrong and ends with 2.

    Only a fault of the program ends with 1, and shows where it happened.
    """

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> None:
        try:
            command(*args, **kwargs)
        except InputError as error:
            _stop(f"railride: {error}", 2)
        except BrokenPipeError:  # the reader, such as head, has seen enough
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(0) from None
        except KeyboardInterrupt as stopped:
            what = f": {stopped}" if str(stopped) else ""
            _stop(f"railride: interrupted{what}", INTERRUPTED)
        except MemoryError:
            _stop(_TOO_MUCH, 2)
        except Exception:  # noqa: BLE001 - shown in full, and the exit code says whose fault it is
            import traceback

            _stop(traceback.format_exc() + _OURS, 1)

    return run


def _stop(message: str, code: int) -> None:
    typer.echo(message, err=True)
    raise typer.Exit(code) from None


def check_output(faults: Faults, option: str, path: str | None) -> None:
    """Note a file that cannot be written, before any work is done for it."""
    if path is None:
        return
    where, target = f"{option} {path!r}", Path(path)
    try:
        if not path or target.is_dir():
            faults.add(where, "a folder" if path else "no name", "the name of a file",
                       "name the file to be written")  # fmt: skip
        elif target.exists() and not target.is_file():
            return  # a device or a pipe, which is written to as it is
        elif not target.resolve().parent.is_dir():
            faults.add(where, f"no folder {str(target.parent)!r}", "one that exists",
                       "make it first")  # fmt: skip
        elif not os.access(target.resolve().parent, os.W_OK):
            faults.add(where, "a folder that cannot be written", "one that can",
                       "choose another folder")  # fmt: skip
    except (OSError, ValueError, RuntimeError) as error:  # too long, a zero byte, links in a circle
        faults.add(where, _reason(error), "the name of a file", "choose another name")


def check_picture(faults: Faults, option: str, path: str | None) -> None:
    """Note a picture's file whose suffix asks for no kind that can be drawn."""
    suffix, suffixes = Path(path or "").suffix, PICTURES.get(option, ())
    if path is not None and suffixes and suffix.lower() not in suffixes:
        one_of = "one of " if len(suffixes) > 1 else ""
        faults.add(f"{option} {path!r}", f"the suffix {suffix!r}" if suffix else "no suffix",
                   one_of + ", ".join(suffixes), "it says which kind to draw")  # fmt: skip


def check_folder(faults: Faults, option: str, path: str | None) -> None:
    """Note a folder that neither exists and is writable, nor can be made."""
    if path is None:
        return
    where, target = f"{option} {path!r}", Path(path)
    try:
        if not path or "\0" in path or (target.exists() and not target.is_dir()):
            found = "a zero byte" if "\0" in path else "a file"
            faults.add(where, found if path else "no name", "a folder", "name another")
            return
        nearest = next(p for p in (target, *target.absolute().parents) if p.exists())
        if not nearest.is_dir() or not os.access(nearest, os.W_OK):
            found = "a file" if not nearest.is_dir() else "a folder"
            faults.add(where, f"{found}, {str(nearest)!r}, in which nothing can be written",
                       "a folder that can be made and written", "choose another")  # fmt: skip
    except (OSError, ValueError) as error:
        faults.add(where, _reason(error), "the name of a folder", "choose another name")


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def write(text: str | bytes, path: str | None) -> None:
    """The result to standard output, or to a file as a whole or not at all; bytes to a file."""
    if isinstance(text, bytes):
        from railride.files import write_bytes

        write_bytes(str(path), text)
        return
    text = text if text.endswith("\n") else text + "\n"
    if path is not None:
        from railride.files import write_text

        write_text(path, text)
        return
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left is dropped
        raise InputError(f"standard output: found {_reason(error)}; expected that it can be "
                         "written (make room, or write to another place)") from None  # fmt: skip


def result(form: str, document: Mapping[str, Any], rows: Sequence[Mapping[str, Any]],
           table: Callable[[], str], remarks: Sequence[str]) -> str:  # fmt: skip
    """The result as text in the format asked for; the remarks are in the JSON as well."""
    if form == "json":
        return json_text({**document, "remarks": list(remarks)})
    return csv_text(rows) if form == "csv" else table()


def deliver(
    text: str | bytes, path: str | None, remarks: Iterable[str], *drawn: str | None
) -> None:
    """Write the result; then remarks and the pictures' files to standard error, a line for each."""
    write(text, path)
    for line in (*(f"remark: {said}" for said in remarks),
                 *(f"drawn: {picture}" for picture in drawn if picture is not None)):  # fmt: skip
        typer.echo(line, err=True)


def json_text(document: Mapping[str, Any]) -> str:
    """One JSON document; numbers unrounded, what is not finite as null.

    >>> json_text({"rms": 0.1, "crest": float("nan"), "modes": (1, 2)})
    '{"rms": 0.1, "crest": null, "modes": [1, 2]}'
    """
    return json.dumps(_clean(document), ensure_ascii=False, allow_nan=False)


def csv_text(rows: Sequence[Mapping[str, Any]]) -> str:
    """Rows as CSV with a header; what is undefined is an empty cell."""
    import csv

    stream = io.StringIO()
    writer = csv.DictWriter(stream, fieldnames=list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(_clean(row) for row in rows)  # None is written as nothing
    return stream.getvalue()


def table_text(
    title: str, columns: Sequence[tuple[str, str]], rows: Iterable[Sequence[Any]]
) -> str:
    """A table as text: columns as (heading, format), numbers to the right, None as a dash.

    It looks the same on a terminal and in a file.

    >>> print(table_text("Springs", [("where", ""), ("k [N/m]", ".3g")], [("primary", 5e6)]))
    Springs
    <BLANKLINE>
      where    k [N/m]
      ────────────────
      primary    5e+06
    <BLANKLINE>
    """
    specs = [spec for _, spec in columns]
    body = [
        [
            "-" if value is None else format(value, spec)
            for value, spec in zip(row, specs, strict=True)
        ]
        for row in rows
    ]
    heads = [list(line) for line in zip_longest(*(h.split("\n") for h, _ in columns), fillvalue="")]
    widths = [max(map(len, column)) for column in zip(*heads, *body, strict=True)]

    def line(cells: Sequence[str]) -> str:
        placed = (
            cell.rjust(width) if spec else cell.ljust(width)
            for cell, width, spec in zip(cells, widths, specs, strict=True)
        )
        return ("  " + "  ".join(placed)).rstrip()

    rule = "  " + "─" * (sum(widths) + 2 * (len(widths) - 1))
    return "\n".join([title, "", *map(line, heads), rule, *map(line, body)]) + "\n"


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
