"""A Dask cluster as an executor."""

from __future__ import annotations

import asyncio
import contextlib
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from typing import TYPE_CHECKING, Any

from railride import __version__
from railride.errors import InputError
from railride.sweeps.worker import version

if TYPE_CHECKING:
    from distributed import Client

PATIENCE = 5  # s, for a scheduler that does not answer, and for its first worker
LONGEST = 60  # s, for a worker to load the program
ALONE = 60  # s without any worker, after which no other is waited for


@contextlib.contextmanager
def cluster(address: str) -> Iterator[tuple[Executor, int, Callable[[], None]]]:
    """An executor of the cluster of a Dask scheduler, and how many tasks it works on at a time.

    And a check, to be called while nothing comes: InputError when all workers are gone for good.

    address : as the scheduler prints it, ``tcp://host:8786``.

    Raises
    ------
    InputError : Dask is not installed; no scheduler answers; it has no workers; they have another
        version of the program, or none.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InputError("--scheduler: found no library for it; expected Dask "
                         "(pip install 'railride[distributed]')") from None  # fmt: skip
    where = f"--scheduler {address!r}"
    _check_answer(address, where)
    with Client(address, timeout=PATIENCE, set_as_default=False) as client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise InputError(f"{where}: found a scheduler without workers; expected at least one "
                             f"(start it: dask worker {address})") from None  # fmt: skip
        _check_program(client, where)
        tasks = sum(client.nthreads().values())
        yield client.get_executor(pure=False), tasks, _Watch(client, where).check


class _Watch:
    """Waits for a worker to come back, but not for ever."""

    def __init__(self, client: Client, where: str) -> None:
        self._client, self._where = client, where
        self._since: float | None = None  # when there was none for the first time

    def check(self) -> None:
        """Raise :class:`InputError` where there has been no worker for :data:`ALONE`."""
        if self._client.nthreads():
            self._since = None
            return
        now = time.monotonic()
        self._since = now if self._since is None else self._since
        if now - self._since >= ALONE:
            raise InputError(f"{self._where}: found no worker for {ALONE:g} s (all have ended); "
                             "expected at least one (start it again)")  # fmt: skip


def _check_program(client: Client, where: str) -> None:
    """Refuse a cluster that cannot run this program: its scheduler, or one of its workers."""
    try:  # a worker that is asked says what it misses; one that is sent a task only ends
        found = client.run(version)
        client.submit(version, pure=False).result(timeout=LONGEST)
    except Exception as error:  # noqa: BLE001 - whatever the other side misses
        reason = " ".join(str(error).split())[:120]
        raise InputError(
            f"{where}: found a cluster that cannot run railride ({reason}); expected railride "
            f"{__version__} to be installed for its scheduler and each of its workers"
        ) from None
    others = {name: of for name, of in found.items() if of != __version__}
    for name, other in others.items():
        raise InputError(f"{where}: found railride {other} on {name}; expected {__version__}, as "
                         "here (install the same everywhere)")  # fmt: skip


def _check_answer(address: str, where: str) -> None:
    """Refuse an address at which no scheduler answers: a client would wait for it for ever."""
    from distributed import rpc

    async def ask() -> Any:
        async with rpc(address, timeout=PATIENCE) as other:
            return await asyncio.wait_for(other.identity(), PATIENCE)

    try:
        with ThreadPoolExecutor(1) as thread:  # whoever calls may have an event loop of its own
            found = thread.submit(asyncio.run, ask()).result()
    except Exception as error:  # noqa: BLE001 - whatever speaks there may say anything
        reason = " ".join(str(error).split())[:120] or f"none within {PATIENCE} s"
        raise InputError(
            f"{where}: found no answer ({reason}); expected the address of a Dask scheduler that "
            "is running, tcp://host:8786 (dask scheduler prints it)"
        ) from None
    kind = found.get("type") if isinstance(found, dict) else None
    if kind != "Scheduler":
        raise InputError(f"{where}: found a {kind or 'program of another kind'}; expected a Dask "
                         "scheduler (give its address, not a worker's)")  # fmt: skip
