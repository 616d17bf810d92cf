"""One writer for a folder: a lock that the system takes back from a process that dies."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from railride.errors import InputError

NAME = ".lock"
_HELD = (errno.EACCES, errno.EAGAIN, errno.EDEADLK, errno.EWOULDBLOCK)


@contextlib.contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold the folder while the block runs.

    The file stays where it is, and is nobody's once its holder has ended, however that was.

    Raises
    ------
    InputError : another process holds it; the folder cannot be written or locked.
    """
    try:
        stream = (folder / NAME).open("a+b", buffering=0)
    except OSError as error:
        raise _cannot(folder, error) from None
    with stream:
        try:
            _take(stream.fileno())
        except OSError as error:
            if error.errno not in _HELD:
                raise _cannot(folder, error) from None
            stream.seek(0)
            holder = stream.read(100).decode(errors="replace").strip()
            raise InputError(
                f"{str(folder)!r}: found another sweep that writes into it"
                + (f" (process {holder})" if holder else "")
                + "; expected one at a time (wait for it, or give another folder)"
            ) from None
        with contextlib.suppress(OSError):  # a full disk: it is but for the message
            stream.truncate(0)
            stream.write(f"{os.getpid()}\n".encode())
        yield


def _cannot(folder: Path, error: OSError) -> InputError:
    return InputError(f"{str(folder)!r}: found {error.strerror or error}; expected a folder that "
                      "can be written and locked (choose another)")  # fmt: skip


if sys.platform == "win32":  # pragma: no cover

    def _take(handle: int) -> None:
        import msvcrt

        os.lseek(handle, 1 << 20, os.SEEK_SET)  # beyond what others read
        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)

else:

    def _take(handle: int) -> None:
        import fcntl

        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
