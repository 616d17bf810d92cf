"""A progress bar on standard error, for who watches and has to wait."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import ProgressColumn, Task
    from rich.text import Text

PATIENCE = 1.0  # s without a sign of life
_MEMORY = 600.0  # s by which a rate is judged


@contextlib.contextmanager
def working(what: str) -> Iterator[Callable[[float], None]]:
    """Show a bar while the block runs; ``advance(fraction)`` moves it.

    Only where standard error is a terminal, and only once the block has taken a second.
    """
    with _bar(what, None) as advance:
        yield lambda fraction: advance(fraction, 1.0)


@contextlib.contextmanager
def counting(what: str, unit: str) -> Iterator[Callable[[float, float], None]]:
    """Show a bar with counts, rate and time left; ``advance(done, total)`` moves it.

    What is done at the first call counts towards the whole, but not towards the rate. Where and
    when it shows is as for :func:`working`.

    unit : of what is counted: "designs".
    """
    with _bar(what, unit) as advance:
        yield advance


@contextlib.contextmanager
def _bar(what: str, unit: str | None) -> Iterator[Callable[[float, float], None]]:
    if not sys.stderr.isatty():
        yield lambda _done, _total: None
        return
    from threading import Timer

    from rich.console import Console
    from rich.progress import Progress

    columns = () if unit is None else (*Progress.get_default_columns(), _counts(unit))
    bar = Progress(*columns, console=Console(stderr=True), transient=True,
                   speed_estimate_period=_MEMORY)  # fmt: skip
    task = bar.add_task(what, total=None)
    late = Timer(PATIENCE, bar.start)
    late.daemon = True
    late.start()
    try:
        yield lambda done, total: bar.update(task, total=total, completed=done)
    finally:
        late.cancel()
        late.join()
        bar.stop()


def _counts(unit: str) -> ProgressColumn:
    """How many of how many, and how many a second."""
    from rich.progress import ProgressColumn
    from rich.text import Text

    class Counts(ProgressColumn):
        """The rate is there once it is known."""

        def render(self, task: Task) -> Text:
            if task.total is None:
                return Text("")
            counts = f"{task.completed:,.0f} of {task.total:,.0f} {unit}"
            digits = 0 if (task.speed or 0) >= 100 else 1
            return Text(counts + (f", {task.speed:,.{digits}f} {unit}/s" if task.speed else ""))

    return Counts()
