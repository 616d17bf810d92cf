"""The chunks of a sweep that are left, one by one from the plan through workers into the store."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from typing import Any

from railride.errors import InputError
from railride.numeric import Array
from railride.sweeps.flight import Flight
from railride.sweeps.plan import Plan
from railride.sweeps.store import Store, parts_in
from railride.sweeps.worker import Columns, Recipe, evaluate

Progress = Callable[[int, int], Any]


@dataclass
class Task:
    """What is left of a sweep, through an executor into the store.

    store, plan, recipe : where results go, which designs there are, how they are evaluated.
    done : chunks that have their parts. progress : see :func:`railride.sweep`.
    """

    store: Store
    plan: Plan
    recipe: Recipe
    done: set[int]
    progress: Progress | None

    def __post_init__(self) -> None:
        self.left = [chunk for chunk in range(self.store.chunks) if chunk not in self.done]
        self.new = 0
        self._before = sum(map(self._count, self.done))
        self._designs: dict[int, dict[str, Array]] = {}  # of the chunks in flight
        self._tell()

    def run(
        self,
        executor: Executor,
        start: Callable[[], Executor] | None,
        window: int,
        check: Callable[[], None] | None = None,
    ) -> None:
        """Evaluate what is left; a pool that was started here is ended.

        Arguments as for :class:`railride.sweeps.flight.Flight`.

        Raises
        ------
        InputError, KeyboardInterrupt : what stopped it, and how much is done.
        """
        flight = Flight(executor, start, self._send, self._name, window, check)
        finished = False
        try:
            for chunk, columns in flight.results(self.left):
                self._keep(chunk, columns)
            finished = True
        except KeyboardInterrupt:
            raise KeyboardInterrupt(self._so_far()) from None
        except InputError as error:
            raise InputError(f"{error}\n{self._so_far()}") from None
        finally:
            flight.cancel()
            if start is not None:
                flight.executor.shutdown(wait=finished, cancel_futures=True)

    def _send(self, executor: Executor, chunk: int) -> Future[Columns]:
        self._designs[chunk] = self.plan.designs(*self.store.span(chunk))
        return executor.submit(evaluate, self.recipe, self._designs[chunk])

    def _keep(self, chunk: int, columns: Columns) -> None:
        designs = self._designs.pop(chunk)
        parameters = {p.heading: designs[p.symbol] for p in self.plan.parameters}
        self.store.write(chunk, parameters | columns)
        self.new += self._count(chunk)
        self._tell()

    def _count(self, chunk: int) -> int:
        start, stop = self.store.span(chunk)
        return stop - start

    def _name(self, chunk: int) -> str:
        start, stop = self.store.span(chunk)
        return f"designs {start + 1} to {stop}"

    def _tell(self) -> None:
        if self.progress is not None:
            self.progress(self._before + self.new, self.store.of.designs)

    def _so_far(self) -> str:
        there = len(parts_in(self.store.folder))
        return (f"{there} of {self.store.chunks} parts are done and kept in "
                f"{str(self.store.folder)!r}; the same command goes on from there")  # fmt: skip
