"""What goes wrong because of what the user gave, said once and in full.

Every message names where, what was found, what was expected and how to mend it. All faults of one
source (a file, a call, a command line) are gathered and raised together.
"""

from __future__ import annotations

from dataclasses import dataclass


def shortened(text: str, longest: int = 60) -> str:
    """The beginning of a text that is longer than a message should hold.

    >>> shortened("3000 kg"), shortened("123456", longest=4)
    ('3000 kg', '1234…')
    """
    return text if len(text) <= longest else f"{text[:longest]}…"


class InputError(ValueError):
    """What the user gave cannot be used. The command line prints it and exits with 2."""


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong: ``where: found …; expected … (how to mend it)``.

    Where nothing is said to be expected, ``found`` is a message that says it all.
    """

    where: str
    found: str
    expected: str = ""
    mend: str = ""

    def __str__(self) -> str:
        if not self.expected:
            return f"{self.where}: {self.found}"
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
        # A name that no file can have may be very long.
        self.source = source if len(source) <= 500 else f"{source[:240]}…{source[-240:]}"
        self.found: list[Fault] = []

    def add(self, where: str, found: object, expected: str, mend: str = "") -> None:
        """Note one fault."""
        self.found.append(Fault(where, str(found), expected, mend))

    def include(self, where: str, error: InputError) -> None:
        """Note what was wrong with something else that is named at ``where``, a line for each."""
        self.found += [Fault(where, line) for line in str(error).splitlines()]

    def raise_if_any(self) -> None:
        """Raise all that was found as one :class:`InputError`; nothing if there is nothing."""
        if self.found:
            raise InputError("\n".join(f"{self.source}: {fault}" for fault in self.found))


class RowFaults:
    """Faults of single rows of a file: the first ten in full and the number of the others.

    >>> rows = RowFaults(Faults("ride.csv"))
    >>> rows.add(17, "z", "'abc'", "a number")
    >>> rows.close()
    >>> print(*rows.faults.found)
    row 17, column 'z': found 'abc'; expected a number
    """

    shown = 10

    def __init__(self, faults: Faults) -> None:
        self.faults = faults
        self.count = 0

    def add(self, row: int, column: str, found: str, expected: str, mend: str = "") -> None:
        """Note a fault of one cell, or of a row as a whole where ``column`` is empty."""
        self.count += 1
        if self.count <= self.shown:
            where = f"row {row}, column {column!r}" if column else f"row {row}"
            self.faults.add(where, found, expected, mend)

    def leave_out(self, count: int) -> None:
        """Count further faults that will not be shown."""
        self.count += max(count, 0)

    def close(self) -> None:
        """Say how many were left out."""
        if self.count > self.shown:
            self.faults.add("other rows", f"{self.count - self.shown} more such faults", "none")
