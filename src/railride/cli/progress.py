"""A progress bar on standard error, for who watches and has to wait."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Callable, Iterator

PATIENCE = 1.0  # s without a sign of life


@contextlib.contextmanager
def working(what: str) -> Iterator[Callable[[float], None]]:
    """Show a bar while the block runs; ``advance(fraction)`` moves it.

    Only where standard error is a terminal, and only once the block has taken a second.
    """
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from threading import Timer

    from rich.console import Console
    from rich.progress import Progress

    bar = Progress(console=Console(stderr=True), transient=True)
    task = bar.add_task(what, total=None)
    late = Timer(PATIENCE, bar.start)
    late.daemon = True
    late.start()
    try:
        yield lambda fraction: bar.update(task, total=1.0, completed=fraction)
    finally:
        late.cancel()
        late.join()
        bar.stop()
