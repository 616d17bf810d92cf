"""Reads TOML files whose values carry units, and gathers all that is wrong with one of them.

``read_toml`` gives the file's content or one clear reason why there is none; a ``Table`` then
takes values out by key, noting faults as it goes, and at the end whatever key nobody asked for.
"""

from __future__ import annotations

import difflib
import json
import math
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from pathlib import Path
from typing import Any

from railride.errors import Faults, shortened
from railride.units import QuantityError, parse_quantity

# A parameter or study file has some kilobytes; what is larger is something else.
_MOST_BYTES = 1_000_000

# What a quantity of a vehicle or study may come to, in SI units.
_LARGEST = 1e40

# Keys that explain a table to its reader and are no parameters.
_COMMENTARY = ("note", "notes", "source")


def read_toml(path: Path, faults: Faults) -> dict[str, Any]:
    """Content of the TOML file at ``path``; empty, with a fault noted, if it cannot be read.

    path: the file, in UTF-8 with or without a byte order mark.
    faults: gathers a missing or unreadable file, a folder, an empty or huge file, another
    encoding, and a syntax error with its line and column.
    """
    text = _read_text(path, faults)
    if text is None:
        return {}
    if not text.strip():
        faults.add("file", "an empty file", "TOML tables with the parameters")
        return {}
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        faults.add("file", f"a TOML syntax error, {error}", 'lines such as key = "number unit"')
    except (RecursionError, ValueError):
        # Thousands of nested brackets, or of digits.
        faults.add("file", "TOML that nests too deep or is too long", "plain tables and values")
    return {}


def file_table(path: Path, schema: int) -> Table:
    """The whole of the TOML file at ``path``, with the faults found in it from now on.

    path: as for :func:`read_toml`. schema: of the files that this version reads, should a key ever
    change its meaning; another one that the file names is noted.

    Raises InputError where there is nothing to be read.
    """
    faults = Faults(str(path))
    content = read_toml(path, faults)
    faults.raise_if_any()
    top = Table(content, "", faults)
    found = top.whole("schema")
    if found not in (None, schema):
        faults.add("schema", str(found), f"{schema}, the form that this version reads")
    return top


def _read_text(path: Path, faults: Faults) -> str | None:
    """Text of the file, or None with a fault noted."""
    try:
        if path.is_dir():
            faults.add("file", "a folder", "a TOML file", "name the file inside it")
            return None
        with path.open("rb") as stream:
            content = stream.read(_MOST_BYTES + 1)
    except FileNotFoundError:
        faults.add("file", "no such file", "a TOML file", "check the path")
        return None
    except OSError as error:
        faults.add("file", error.strerror or str(error), "a file that can be read")
        return None
    except ValueError:
        faults.add("file", "a name that no file can have", "the path of a TOML file")
        return None
    if len(content) > _MOST_BYTES:
        faults.add("file", f"more than {_MOST_BYTES:,} bytes", "a TOML file of some kilobytes")
        return None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        faults.add(
            "file",
            f"another encoding (byte 0x{content[error.start]:02x} in line {line})",
            "UTF-8",
            "save it as UTF-8",
        )
        return None


class Table:
    """One table of a TOML file, from which values are taken by key.

    content: what stands there, as TOML gave it; anything but a table is a fault.
    where: the table's name in messages, such as ``"bogies[1]"``; empty for the whole file.
    faults: gathers what is wrong.
    """

    def __init__(self, content: object, where: str, faults: Faults) -> None:
        self.where = where
        self.faults = faults
        self.content: Mapping[str, Any] = {}
        self._asked: list[str] = []
        if isinstance(content, Mapping):
            self.content = content
        else:
            faults.add(where, shown(content), f"a table [{where}]")

    def key(self, name: str) -> str:
        """Full name of a key in messages: ``body.mass``; of a very long one its beginning."""
        name = shortened(name)
        return f"{self.where}.{name}" if self.where else name

    def __contains__(self, name: str) -> bool:
        return name in self.content

    def holds_list(self, name: str) -> bool:
        """Whether a list stands under the key."""
        return isinstance(self.content.get(name), list)

    def _take(self, name: str) -> Any:
        self._asked.append(name)
        return self.content.get(name)

    def fault(self, name: str, found: str, expected: str, mend: str = "") -> None:
        """Note what is wrong under a key."""
        self.faults.add(self.key(name), found, expected, mend)

    def quantity(self, name: str, unit: str, sign: str = "") -> float | None:
        """SI value of ``name = "number unit"``; None if it is absent or faulty.

        sign: "> 0", ">= 0", or "" for any. A dimensionless value (``unit`` empty) may also be a
        plain TOML number.
        """
        value = self._take(name)
        return None if value is None else self._parse(name, value, unit, sign)

    def quantities(self, name: str, unit: str, sign: str = "") -> tuple[float, ...] | None:
        """SI values of ``name = ["number unit", …]``; None if it is absent or faulty."""
        value = self._take(name)
        if value is None:
            return None
        if not isinstance(value, list):
            example = f'["1.25 {unit}", "-1.25 {unit}"]'
            self.fault(name, shown(value), f"a list such as {example}")
            return None
        found = [self._parse(f"{name}[{i}]", item, unit, sign) for i, item in enumerate(value, 1)]
        known = tuple(item for item in found if item is not None)
        return known if len(known) == len(found) else None

    def _parse(self, name: str, value: object, unit: str, sign: str) -> float | None:
        # A number without quotation marks is read as if it had them: fine where it needs no unit.
        number = isinstance(value, int | float) and not isinstance(value, bool)
        try:
            si = parse_quantity(repr(value) if number else value, unit)
        except QuantityError as error:
            self.fault(name, error.found, error.expected, error.mend)
            return None
        expected = expected_sign(si, sign)
        if expected:
            self.fault(name, shown(value), expected)
            return None
        return si

    def text(self, name: str) -> str | None:
        """Text of a key; None if it is absent or faulty."""
        value = self._take(name)
        if value is None or isinstance(value, str):
            return value
        self.fault(name, shown(value), 'a text in quotation marks, "…"')
        return None

    def texts(self, name: str) -> tuple[str, ...]:
        """Texts of a list of them; empty if it is absent or faulty."""
        value = self._take(name)
        if value is None:
            return ()
        if isinstance(value, list) and all(isinstance(item, str) for item in value):
            return tuple(value)
        self.fault(name, shown(value), 'a list of texts, ["…", "…"]')
        return ()

    def whole(self, name: str) -> int | None:
        """Whole number of a key; None if it is absent or faulty."""
        value = self._take(name)
        if value is None or (isinstance(value, int) and not isinstance(value, bool)):
            return value
        self.fault(name, shown(value), "a whole number")
        return None

    def flag(self, name: str) -> bool | None:
        """Truth value of a key; None if it is absent or faulty."""
        value = self._take(name)
        if value is None or isinstance(value, bool):
            return value
        self.fault(name, shown(value), "true or false, without quotation marks")
        return None

    def choice(self, name: str, choices: Sequence[str]) -> str | None:
        """One of some texts; None if it is absent or faulty."""
        value = self.text(name)
        return value if value is None or self._is_one(name, value, choices) else None

    def choices(self, name: str, choices: Sequence[str]) -> tuple[str, ...]:
        """Texts of a list of them, each one of some; empty if it is absent or faulty."""
        found = self.texts(name)
        fit = [self._is_one(f"{name}[{i}]", text, choices) for i, text in enumerate(found, 1)]
        return found if all(fit) else ()

    def _is_one(self, name: str, value: str, choices: Sequence[str]) -> bool:
        if value not in choices:
            near = difflib.get_close_matches(value, choices, n=1)
            mend = f"did you mean {near[0]}?" if near else ""
            self.fault(name, shown(value), f"one of {', '.join(choices)}", mend)
        return value in choices

    def missing(self, name: str, form: str, mend: str = "the key is missing") -> None:
        """Note that a key that must be there is not; nothing where it is.

        form: how it is written, such as ``name = "number unit"``.
        """
        if name not in self.content:
            self.fault(name, "nothing", form, mend)

    def table(self, name: str) -> Table | None:
        """Table ``[name]`` inside this one; None if it is absent."""
        value = self._take(name)
        return None if value is None else Table(value, self.key(name), self.faults)

    def tables(self, name: str) -> tuple[Table, ...]:
        """Tables ``[[name]]``; empty if there are none."""
        value = self._take(name)
        if value is None:
            return ()
        if not isinstance(value, list):
            self.fault(name, shown(value), f"a list of tables, each headed [[{name}]]")
            return ()
        return tuple(
            Table(item, f"{self.key(name)}[{i}]", self.faults) for i, item in enumerate(value, 1)
        )

    def finish(self) -> None:
        """Check the commentary, and note every key that nobody asked for as unknown."""
        for name in ("note", "source"):
            self.text(name)
        parameters = [name for name in self._asked if name not in _COMMENTARY]
        notes = self._take("notes")
        if notes is not None:
            comments = Table(notes, self.key("notes"), self.faults)
            for name in comments.content:
                comments.text(name)
            comments.unknown(parameters)
        self.unknown(self._asked, parameters)

    def unknown(self, known: Iterable[str], proposed: Sequence[str] | None = None) -> None:
        """Note each key that is not ``known``, with the near ones among them."""
        known = list(dict.fromkeys(known))
        listed = list(dict.fromkeys(proposed or known))
        for name in self.content:
            if name not in known:
                near = difflib.get_close_matches(name, known, n=2, cutoff=0.5)
                mend = f"did you mean {' or '.join(near)}?" if near else ""
                self.fault(name, "a key that is not known", f"one of {', '.join(listed)}", mend)


def finite_number(value: object) -> float | None:
    """Return ``value`` as a float; None if it is no number (True is none) or not finite.

    A number is also an array of numpy without an axis: what a calculation with arrays comes to.
    """
    if getattr(value, "shape", None) == () and hasattr(value, "item"):
        value = value.item()
    if not isinstance(value, Real) or isinstance(value, bool):
        return None
    try:
        number = float(value)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None


def expected_sign(value: float | None, sign: str) -> str:
    """Return what was expected of a value that is none, not of the ``sign`` asked for, or enormous.

    >>> expected_sign(-3.0, "> 0"), expected_sign(0.0, ">= 0"), expected_sign(None, "")
    ('a positive number', '', 'a finite number')
    >>> expected_sign(-1e300, "")
    'a number of a size from 1e-40 to 1e+40'
    """
    if sign == "> 0" and (value is None or value <= 0):
        return "a positive number"
    if sign == ">= 0" and (value is None or value < 0):
        return "a number of at least 0"
    if value is None:
        return "a finite number"
    # Products and quotients of a few others would be no numbers any more.
    fits = abs(value) <= _LARGEST and (sign != "> 0" or value >= 1 / _LARGEST)
    return "" if fits else f"a number of a size from {1 / _LARGEST:g} to {_LARGEST:g}"


def shown(value: object) -> str:
    """Return a TOML value for a message, short and by its kind."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, bool):
        return str(value).lower()
    return shortened(repr(value))


def toml_text(text: str) -> str:
    r"""Return ``text`` as a TOML basic string.

    >>> toml_text('the "paper", Table 1')
    '"the \\"paper\\", Table 1"'
    """
    # JSON's escapes are TOML's, save for the one control character that JSON leaves raw.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
