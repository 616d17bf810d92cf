"""Chunks through an executor: a few in flight at a time, each one's results once.

A worker that dies takes the pool with it (``concurrent.futures``), and all that was in flight. The
chunks concerned are tried again one at a time in a new pool, so that the one that kills its worker
is told from those that only flew along; at the third time it is named.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from itertools import islice
from typing import Generic, TypeVar

from railride.errors import InputError

C = TypeVar("C")
R = TypeVar("R")

LOOK = 1.0  # s in which nothing lands, after which a check is made
MOST_DEATHS = 3  # of a worker that is alone with a chunk


class Flight(Generic[C, R]):
    """Chunks on their way.

    Parameters
    ----------
    start : makes an executor; again after a worker has died. None: none may take its place.
    executor : the first.
    send : hands a chunk to an executor.
    name : what a chunk is called in messages.
    window : how many chunks may be in flight.
    check : called while none lands; raises where none will.
    """

    def __init__(
        self,
        executor: Executor,
        start: Callable[[], Executor] | None,
        send: Callable[[Executor, C], Future[R]],
        name: Callable[[C], str],
        window: int,
        check: Callable[[], None] | None = None,
    ) -> None:
        self.executor = executor
        self._start, self._send, self._name, self._window = start, send, name, window
        self._check = check
        self._flying: dict[Future[R], C] = {}
        self._suspects: deque[C] = deque()
        self._deaths: dict[C, int] = {}

    def results(self, chunks: Iterable[C]) -> Iterator[tuple[C, R]]:
        """Each chunk with its result, in the order in which they come.

        Raises
        ------
        InputError : a chunk that kills its workers; an executor that breaks and has no other, or
            whose check fails.
        Exception : whatever the evaluation of a chunk raised.
        """
        left = iter(chunks)
        while self._fill(left):
            landed = self._landed()
            broken = False
            for future in landed:
                chunk = self._flying.pop(future)
                try:
                    result = future.result()
                except BrokenExecutor:
                    broken = True
                    self._suspect(chunk, alone=len(landed) == 1 and not self._flying)
                except CancelledError:
                    raise self._gone(chunk) from None
                except Exception as error:
                    if type(error).__name__ == "KilledWorker":  # as Dask has it, after some tries
                        raise self._deadly(chunk) from None
                    raise
                else:
                    self._deaths.pop(chunk, None)
                    yield chunk, result
            if broken:
                yield from self._recover()

    def cancel(self) -> None:
        """Give up what is in flight, as far as it has not begun."""
        for future in self._flying:
            future.cancel()

    def _landed(self) -> set[Future[R]]:
        """Those that have come back, at least one."""
        while True:
            patience = None if self._check is None else LOOK
            landed = wait(self._flying, patience, FIRST_COMPLETED).done
            if landed or self._check is None:
                return landed
            self._check()

    def _fill(self, left: Iterator[C]) -> bool:
        """Send chunks until enough are in flight, suspects one at a time; whether any is."""
        while self._suspects and not self._flying:
            self._try(self._suspects.popleft())
        if not self._deaths:
            for chunk in islice(left, self._window - len(self._flying)):
                self._try(chunk)
        return bool(self._flying) or (bool(self._suspects) and self._fill(left))

    def _try(self, chunk: C) -> None:
        try:
            self._flying[self._send(self.executor, chunk)] = chunk
        except BrokenExecutor:  # a worker died in the meantime
            self._suspect(chunk, alone=not self._flying)
            if not self._flying:  # else those in flight will tell
                self._renew()

    def _suspect(self, chunk: C, *, alone: bool) -> None:
        """Keep a chunk that came to nothing, to be tried again alone."""
        self._deaths[chunk] = self._deaths.get(chunk, 0) + alone
        if self._deaths[chunk] >= MOST_DEATHS:
            raise self._deadly(chunk)
        self._suspects.append(chunk)

    def _recover(self) -> Iterator[tuple[C, R]]:
        """What still came of those in flight; then a new pool."""
        for future, chunk in list(self._flying.items()):
            try:
                result = future.result()
            except BrokenExecutor:
                self._suspect(chunk, alone=False)
            else:
                yield chunk, result
        self._flying.clear()
        self._renew()

    def _renew(self) -> None:
        if self._start is None:
            raise InputError("executor: found that it broke (a worker died); expected one that "
                             "lasts (call again with a new one)")  # fmt: skip
        self.executor.shutdown(wait=False, cancel_futures=True)
        self.executor = self._start()

    def _deadly(self, chunk: C) -> InputError:
        return InputError(
            f"{self._name(chunk)}: found that worker after worker died on them; expected "
            "that they can be evaluated (too little memory? Take a smaller chunk)"
        )

    def _gone(self, chunk: C) -> InputError:
        return InputError(f"{self._name(chunk)}: found that the executor gave them up; expected "
                          "their results (did the scheduler end? Start it again)")  # fmt: skip
