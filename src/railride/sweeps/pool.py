"""Processes of this machine that evaluate designs, and end with the process that started them."""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing.connection import Connection, wait
from threading import Thread
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

# Libraries that would take a thread for each core in every worker.
_ONE_THREAD = dict.fromkeys(
    ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"), "1"
)


class InProcess(Executor):
    """Evaluates at once, in this process: for a few designs, and to compare with."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """The future of a call, which is already past."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - whoever asks for the result gets it
            future.set_exception(error)
        return future


class LocalPool(Executor):
    """``workers`` new processes, which leave the keyboard's interrupt to the one that starts them.

    Each holds the end of a pipe, and leaves when the other end closes: when this process has had
    enough, or is no more, however it ended.
    """

    def __init__(self, workers: int) -> None:
        context = multiprocessing.get_context("spawn")
        theirs, self._line = context.Pipe(duplex=False)
        self._pool = ProcessPoolExecutor(workers, context, _begin, (theirs,))
        self._theirs = theirs

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """The future of a call; it may start a process."""
        with _bequeathed():
            return self._pool.submit(fn, *args, **kwargs)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes: those at work too, where nobody waits for them."""
        if not wait:
            self._line.close()
        self._pool.shutdown(wait=True, cancel_futures=cancel_futures)
        self._line.close()
        self._theirs.close()


def _begin(line: Connection) -> None:
    """What a worker does first."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_leave_with, args=(line,), daemon=True).start()


def _leave_with(line: Connection) -> None:
    """Wait for the other end of the line to close, and end this process."""
    wait([line])
    os._exit(0)


@contextlib.contextmanager
def _bequeathed() -> Iterator[None]:
    """What processes started meanwhile inherit: one thread, and no interrupt before they begin."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    mask: Any = None
    if hasattr(signal, "pthread_sigmask"):
        mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    os.environ.update(_ONE_THREAD)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
        if mask is not None:
            signal.pthread_sigmask(signal.SIG_SETMASK, mask)
