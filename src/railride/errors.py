"""What goes wrong because of what the user gave, said once and in full.

Every message names where, what was found, what was expected and how to mend it. All faults of one
source (a file, a call, a command line) are gathered and raised together.
"""

from __future__ import annotations

from dataclasses import dataclass


class InputError(ValueError):
    """What the user gave cannot be used. The command line prints it and exits with 2."""


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong: ``where: found …; expected … (how to mend it)``."""

    where: str
    found: str
    expected: str
    mend: str = ""

    def __str__(self) -> str:
        mend = f" ({self.mend})" if self.mend else ""
        return f"{self.where}: found {self.found}; expected {self.expected}{mend}"


class Faults:
    """Gathers the faults of one source, to be raised as one :class:`InputError`.

    >>> faults = Faults("coach.toml")
    >>> faults.add("body.mass", "'-3 t'", "a mass above 0", "in kg or t")
    >>> faults.raise_if_any()
    Traceback (most recent call last):
    ...
    railride.errors.InputError: coach.toml: body.mass: found '-3 t'; expected a mass above 0 \
(in kg or t)
    """

    def __init__(self, source: str) -> None:
        self.source = source
        self.found: list[Fault] = []

    def add(self, where: str, found: object, expected: str, mend: str = "") -> None:
        """Note one fault."""
        self.found.append(Fault(where, str(found), expected, mend))

    def raise_if_any(self) -> None:
        """Raise all that was found as one :class:`InputError`; nothing if there is nothing."""
        if self.found:
            raise InputError("\n".join(f"{self.source}: {fault}" for fault in self.found))
