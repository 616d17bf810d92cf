"""Where the program's own data lie, and how a file is written whole or not at all."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

from railride.errors import Faults


def data_path(*parts: str) -> Path:
    """Path of a shipped data file: ``data/parts[0]/parts[1]/…``.

    An installed package carries its data inside itself (``railride/data``); in a checkout, and so
    in an editable install, they are the checkout's own top-level ``data``.

    parts: folder and file names below ``data``, such as ``"vehicles", "cati2024.toml"``.

    Raises FileNotFoundError where no such file is shipped: a fault of the program or of its
    installation, not of what the user gave.

    >>> data_path("units.txt").name
    'units.txt'
    """
    package = Path(__file__).resolve().parent
    for root in (package / "data", package.parents[1] / "data"):
        path = root.joinpath(*parts)
        if path.exists():
            return path
    missing = "/".join(("data", *parts))
    raise FileNotFoundError(f"{missing} is missing: railride is not completely installed")


def write_text(path: str | Path, text: str) -> None:
    """Write a text file as a whole or not at all: beside its place first, then renamed.

    path: the file to be written or replaced; its folder must exist.
    text: what is to stand in it, written as UTF-8 with line feeds.

    Raises InputError where the file cannot be written (no such folder, a folder in its place, no
    permission, a full disk); nothing half-written is left behind.
    """
    target = Path(path)
    faults = Faults(repr(str(path)))
    beside: str | None = None
    try:
        if target.is_dir():
            raise IsADirectoryError(0, "a folder of that name")
        handle, beside = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}.")
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        # mkstemp makes private files; an output has the permissions that any new file has.
        Path(beside).chmod(_usual_permissions(target))
        Path(beside).replace(target)
    except (OSError, ValueError) as error:
        if beside is not None:
            with contextlib.suppress(OSError):
                Path(beside).unlink()
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        faults.add(
            "output file", reason, "a file that can be written", "give another path or make room"
        )
    faults.raise_if_any()


def _usual_permissions(target: Path) -> int:
    """Return the permission bits of the file to be replaced, or of a new file under the umask."""
    if target.exists():
        return target.stat().st_mode & 0o777
    umask = os.umask(0)
    os.umask(umask)
    return 0o666 & ~umask
