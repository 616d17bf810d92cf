"""Where the program's own data lie, files by name, and how one is written whole or not at all."""

from __future__ import annotations

import contextlib
import difflib
import errno
import os
import tempfile
from pathlib import Path

from railride.errors import Fault, Faults, InputError

_FOLDERS = {"vehicle": "vehicles", "study": "studies"}  # below ``data``
_MOST_LINKS = 40  # in a row, as Linux has it: beyond it they lead round in a circle


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


def there(path: str | Path) -> bool:
    r"""Whether there is such a file or folder; False, too, for what is no path at all.

    >>> there(data_path("units.txt")), there("no\0path")
    (True, False)
    """
    return os.path.exists(path)  # noqa: PTH110


def shipped_names(kind: str) -> tuple[str, ...]:
    """Names of the TOML files of a kind that come with the program, ``data/KINDs/NAME.toml``.

    kind: "vehicle" or "study".
    """
    return tuple(sorted(path.stem for path in data_path(_FOLDERS[kind]).glob("*.toml")))


def shipped_or_file(name_or_path: str | Path, kind: str) -> Path:
    """Path of a TOML file: one that ships with the program, by its name, or the user's own.

    name_or_path: a name of :func:`shipped_names`, or a path. kind: "vehicle" or "study".

    Raises InputError for what is neither, with the near names.

    >>> shipped_or_file("cati2024", "vehicle").name
    'cati2024.toml'
    """
    text, shipped = str(name_or_path), shipped_names(kind)
    if text in shipped:
        return data_path(_FOLDERS[kind], f"{text}.toml")
    if there(text):
        return Path(text)
    near = difflib.get_close_matches(text.removesuffix(".toml"), shipped, n=1)
    fault = Fault(
        f"{kind} {text!r}" if len(text) <= 60 else f"{kind} {text[:50]!r}…",
        f"neither a shipped {kind} nor a file",
        f"one of {', '.join(shipped)}, or the path of a TOML file",
        f"did you mean {near[0]}?" if near else "check the spelling and the folder",
    )
    raise InputError(str(fault))


def write_text(path: str | Path, text: str) -> None:
    """Write a text file as :func:`write_bytes` does, as UTF-8 with line feeds."""
    try:
        content = text.encode("utf-8")
    except UnicodeEncodeError as error:
        raise InputError(
            f"{str(path)!r}: output file: found text that UTF-8 cannot hold, {error.reason}; "
            "expected characters (a name with a damaged letter?)"
        ) from None
    write_bytes(path, content)


def write_bytes(path: str | Path, content: bytes) -> None:
    """Write a file as a whole or not at all: beside its place first, then renamed.

    path: the file to be written or replaced; its folder must exist. The file behind a symbolic link
        is replaced and the link stays; a device, a pipe or an open stream such as ``/dev/stdout``
        has nothing to replace and is written to as it is.
    content: what is to stand in it.

    Raises InputError where the file cannot be written (no such folder, a folder in its place, no
    permission, a full disk); nothing half-written is left behind, after an interruption neither.
    """
    faults = Faults(repr(str(path)))
    try:
        target = _behind_links(Path(path))
        if target.is_dir():
            raise IsADirectoryError(0, "a folder of that name")
        if _is_stream(target):
            with target.open("ab") as stream:
                stream.write(content)
        else:
            _replace(target, content)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        faults.add(
            "output file", reason, "a file that can be written", "give another path or make room"
        )
    faults.raise_if_any()


def _replace(target: Path, content: bytes) -> None:
    """Write a new file beside ``target`` and give it that name once it is complete."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}.")
    beside = Path(name)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
        # mkstemp makes private files; an output has the permissions that any new file has.
        beside.chmod(_usual_permissions(target))
        beside.replace(target)
    except BaseException:  # Ctrl-C too
        with contextlib.suppress(OSError):
            beside.unlink()
        raise


def _behind_links(target: Path) -> Path:
    """Follow symbolic links, but not those by which the system names an open stream."""
    for _ in range(_MOST_LINKS):
        if _names_stream(target) or not target.is_symlink():
            return target
        target = target.parent / target.readlink()
    raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))


def _names_stream(target: Path) -> bool:
    return target.absolute().as_posix().startswith(("/dev/std", "/dev/fd/", "/proc/"))


def _is_stream(target: Path) -> bool:
    """Whether it is something else than a file of its own."""
    return target.exists() and (_names_stream(target) or not target.is_file())


def _usual_permissions(target: Path) -> int:
    """Return the permission bits of the file to be replaced, or of a new file under the umask."""
    if target.exists():
        return target.stat().st_mode & 0o777
    umask = os.umask(0)
    os.umask(umask)
    return 0o666 & ~umask
