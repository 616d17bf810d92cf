"""Names in another tool's form, and back: one to one.

A name is written with the letters, digits and underscores that every target allows:

- any other character is written as ``_u`` and its code point in hexadecimal and ``_``
  (``coach-2`` is ``coach_u2d_2``), and so is an underscore that would begin such a group;
- a name that does not begin with a letter, or begins with ``x_``, is preceded by ``x_``
  (``2nd`` is ``x_2nd``);
- a word that the target keeps for itself, or a name that ends in an underscore, is followed by
  one (``lambda`` is ``lambda_`` in Python).
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from railride.errors import InputError

_FORBIDDEN = re.compile(r"[^A-Za-z0-9_]|_(?=u[0-9a-f]+(?:_|[^A-Za-z0-9]))")
_GROUP = re.compile(r"_u([0-9a-f]+)_")
_LED = re.compile(r"(?![A-Za-z])|x_")


@dataclass(frozen=True)
class Names:
    """How names are written in one target.

    reserved : words that the target keeps for itself, and those that an export uses in its text.
    longest : the most characters of a name; None if there is no bound.

    >>> python = Names(frozenset({"lambda"}))
    >>> python.written("lambda"), python.written("coach 2"), python.written("x_1")
    ('lambda_', 'coach_u20_2', 'x_x_1')
    >>> python.original(python.written("2nd coach_"))
    '2nd coach_'
    """

    reserved: frozenset[str]
    longest: int | None = None

    def written(self, name: str) -> str:
        """The name as the target has it.

        Raises
        ------
        InputError : a name that would be longer than the target allows; an empty one.
        """
        if not name:
            raise InputError("name: found an empty one; expected one to be written")
        found = _FORBIDDEN.sub(lambda match: f"_u{ord(match[0]):x}_", name)
        found = f"x_{found}" if _LED.match(found) else found
        found = f"{found}_" if found in self.reserved or found.endswith("_") else found
        if self.longest is not None and len(found) > self.longest:
            raise InputError(f"name {name!r}: found {len(found)} characters as {found!r}; expected "
                             f"at most {self.longest} (a shorter name)")  # fmt: skip
        return found

    def original(self, written: str) -> str:
        """The name that is written so."""
        name = written.removesuffix("_").removeprefix("x_")
        return _GROUP.sub(lambda match: chr(int(match[1], 16)), name)
