"""Options that several commands share, each group of them as one argument of the command."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any

Command = Callable[..., None]


def grouped(**groups: type) -> Callable[[Command], Command]:
    """A command whose arguments of these names are records made of options of their own.

    groups: name of the argument → dataclass, whose fields are typer's options. They are listed
        where the last two options, of every command the result's, begin.
    """
    fields = {name: inspect.signature(g, eval_str=True).parameters for name, g in groups.items()}

    def decorate(command: Command) -> Command:
        @functools.wraps(command)
        def run(**values: Any) -> None:
            records = {
                name: group(**{field: values.pop(field) for field in fields[name]})
                for name, group in groups.items()
            }
            command(**records, **values)

        own = inspect.signature(command, eval_str=True)
        shown = [p for name, p in own.parameters.items() if name not in groups]
        shown[-2:-2] = [field for name in groups for field in fields[name].values()]
        setattr(run, "__signature__", own.replace(parameters=shown))  # noqa: B010
        run.__annotations__ = {p.name: p.annotation for p in shown}
        return run

    return decorate
