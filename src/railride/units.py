"""Quantities with units at the program's boundary: the only place where Pint is used.

Inside railride every number is a float in SI units. A text such as ``"5000 kN/m"`` becomes one on
the way in (parameter files, command line, CSV headers), and a float becomes a number in the
reader's unit on the way out (tables, plots). The units are those of ``data/units.txt``; products
are written with ``*``, ``·`` or a space, powers as ``m^2``, ``m**2``, ``m2`` or ``m²``.

Angles: the radian (and the cycle of Hz) may be left away, so that ``"3.7e8 N m"`` is a torsional
stiffness in N m/rad, but it is never added, so that ``"60 rad/s"`` is not 60 Hz.
"""

from __future__ import annotations

import difflib
import math
import re
from functools import lru_cache
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from railride.errors import InputError, shortened
from railride.files import data_path

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from pint import UnitRegistry

Number = TypeVar("Number", float, "NDArray[np.float64]")

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of free fall g_n, m/s²: 3rd General Conference on Weights and Measures."""

# Longer texts are no quantities, and are not worth a parser's time.
_LONGEST = 80

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)

# A unit is a product of named factors with powers of one digit, in at most one level of brackets.
# Whatever passes is harmless to Pint's parser: no numbers but a leading 1, no power of a power.
_NAME = r"[A-Za-zµμ][A-Za-zµμ_]*"
_FACTOR = rf"(?:1|{_NAME}(?:\*\*-?[1-9])?)"
_TIMES = r"(?: ?[*/] ?| )"
_GROUP = rf"(?:{_FACTOR}|\( ?{_FACTOR}(?:{_TIMES}{_FACTOR})* ?\))"
_UNIT = re.compile(rf"{_GROUP}(?:{_TIMES}{_GROUP})*")

_SUPERSCRIPTS = str.maketrans("⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹", "-+0123456789")
_SIGNS = str.maketrans({"·": "*", "⋅": "*", "•": "*", "×": "*", "−": "-", "∕": "/"})

# What a message proposes for a unit that is not known.
_COMMON = tuple(
    "m mm µm cm km s ms min h kg g t N kN MN Pa MPa GPa J kJ W kW Hz kHz rad mrad deg g_n %".split()
)

# What a dimension is called, by a unit that has it; the first that fits names it.
_KINDS = (
    ("m", "a length"),
    ("kg", "a mass"),
    ("s", "a time"),
    ("m/s", "a speed"),
    ("m/s^2", "an acceleration"),
    ("N", "a force"),
    ("Pa", "a pressure"),
    ("Hz", "a frequency"),
    ("rad", "an angle"),
    ("rad/s", "an angular speed"),
    ("N/m", "a stiffness"),
    ("N s/m", "a damping"),
    ("kg m^2", "a moment of inertia"),
    ("N m/rad", "a torsional stiffness"),
    ("N m s/rad", "a torsional damping"),
    ("N m^2", "a bending stiffness"),
    ("", "a plain number"),
)


class QuantityError(InputError):
    """A text that is not the quantity asked for: what was ``found`` and what was ``expected``.

    The caller, who knows the file and the key, adds them to its ``Faults`` with ``mend``.
    """

    def __init__(self, found: str, expected: str, mend: str = "") -> None:
        hint = f" ({mend})" if mend else ""
        super().__init__(f"found {found}; expected {expected}{hint}")
        self.found = found
        self.expected = expected
        self.mend = mend


def parse_quantity(text: object, unit: str) -> float:
    """SI value of ``"number unit"``, whose dimension must be that of ``unit``.

    text: a decimal number and a unit, such as ``"5000 kN/m"``; where a plain number is expected
    (``unit`` empty), the number alone or in per cent.
    unit: any unit of the dimension expected, such as ``"N/m"``; ``""`` for a plain number. The
    result is in SI units, whatever multiple ``unit`` names.

    Raises QuantityError for what is not a number and a unit, not finite, a unit that is not known
    or of another dimension, and for none at all.

    >>> parse_quantity("5000 kN/m", "N/m")
    5000000.0
    >>> parse_quantity("1.7e6 kg⋅m²", "kg m^2")
    1700000.0
    >>> parse_quantity("3.7e5 kN·m", "N m/rad")
    370000000.0
    >>> parse_quantity("34000 N/m", "kg")
    Traceback (most recent call last):
    ...
    railride.units.QuantityError: found '34000 N/m' (a stiffness); expected a mass, as "number kg"
    """
    number, given = _split(text, unit)
    if not given and unit:
        raise QuantityError(
            f"{_shown(text)} without a unit",
            _asked_for(unit),
            f'write the unit, as in "{number:g} {unit}"',
        )
    return _in_si(text, number, given, unit)


def parse_number_or_quantity(text: str, unit: str) -> float:
    """SI value of a number, taken to be in ``unit``, or of a number with its own unit.

    text: ``"145"`` or ``"40.3 m/s"``, as typed on a command line.
    unit: the unit of a plain number, such as ``"km/h"``; ``""`` where it has none.

    Raises QuantityError as :func:`parse_quantity` does, save that the unit may be left away.

    >>> parse_number_or_quantity("3.7e8", "N m/rad")
    370000000.0
    >>> parse_number_or_quantity("36", "km/h"), parse_number_or_quantity("10 m/s", "km/h")
    (10.0, 10.0)
    """
    number, given = _split(text, unit)
    return _in_si(text, number, given or unit, unit)


def to_unit(value: Number, unit: str) -> Number:
    """Return ``value`` (a number or an array, SI) as a multiple of ``unit``: for tables and plots.

    >>> to_unit(5e6, "kN/m")
    5000.0
    """
    return value / _scale(unit)[0]


def to_si(value: Number, unit: str) -> Number:
    """Return ``value`` (a number or an array, in ``unit``) in SI units: for columns of a file.

    >>> to_si(2.5, "mm")
    0.0025
    """
    return value * _scale(unit)[0]


def headed(name: str, unit: str) -> str:
    """The heading of a column: the unit in brackets, where there is one.

    >>> headed("a_wrms", "m/s^2"), headed("damping ratio", "")
    ('a_wrms [m/s^2]', 'damping ratio')
    """
    return f"{name} [{unit}]" if unit else name


def same_dimension(unit: str, other: str) -> bool:
    """Whether a value in ``unit`` can stand where ``other`` is asked for.

    >>> same_dimension("mm", "m"), same_dimension("kg", "N/m"), same_dimension("rad/s", "Hz")
    (True, False, False)

    Raises QuantityError where one of the two is no unit that is known.
    """
    found, expected = _scale(unit)[1], _scale(other)[1]
    return found in (expected, _without_angle(expected))


def base_units(unit: str) -> dict[str, int]:
    """Exponents of kg, m, s and rad, those that are not 0; of 1 Hz those of 1/s.

    >>> base_units("N s/m")
    {'kg': 1, 's': -1}

    Raises QuantityError for what is no unit that is known.
    """
    symbols = {"[mass]": "kg", "[length]": "m", "[time]": "s", "[angle]": "rad"}
    return {symbols[name]: power for name, power in _scale(unit)[1] if name in symbols}


def _split(text: object, unit: str) -> tuple[float, str]:
    """Split ``text`` into a finite number and a normalised unit text, which may be empty."""
    if not isinstance(text, str):
        raise QuantityError(f"{_shown(text)}, not a text", _asked_for(unit))
    if len(text) > _LONGEST:
        raise QuantityError(f"{len(text)} characters, {_shown(text)}", _asked_for(unit))
    plain = " ".join(text.translate(_SIGNS).split())
    match = _NUMBER.match(plain)
    if match is None:
        raise QuantityError(_shown(text) if plain else "an empty text", _asked_for(unit))
    number = float(match.group())
    if not math.isfinite(number):
        raise QuantityError(f"{_shown(text)}, which is not finite", _asked_for(unit))
    rest = plain[match.end() :].strip()
    if re.match(r"[\d.,_'](?! ?/)", rest):  # but "9.6 1/s" is a number and a unit
        raise QuantityError(
            _shown(text),
            _asked_for(unit),
            "write the number with a decimal point and without separators between thousands",
        )
    return number, rest


def _in_si(text: object, number: float, given: str, unit: str) -> float:
    """``number`` times the factor of ``given`` to SI, once the dimensions agree."""
    try:
        factor, dimension = _scale(given)
        fits = same_dimension(given, unit)
    except QuantityError as error:
        raise QuantityError(
            f"{_shown(text)}, where {error.found}", _asked_for(unit), error.mend
        ) from None
    if not fits:
        raise QuantityError(f"{_shown(text)} ({_kind(dimension)})", _asked_for(unit))
    value = number * factor
    if not math.isfinite(value):
        raise QuantityError(f"{_shown(text)}, which is not finite in SI units", _asked_for(unit))
    return value


def _asked_for(unit: str) -> str:
    """Say what a quantity in ``unit`` is: 'a mass, as "number kg"'."""
    form = f'"number {unit}"' if unit else '"0.015" or "1.5 %"'
    return f"{_kind(_scale(unit)[1])}, as {form}"


def _kind(dimension: tuple[tuple[str, int], ...]) -> str:
    for unit, name in _KINDS:
        if _scale(unit)[1] == dimension:
            return name
    return "a quantity of another kind"


def _shown(value: object) -> str:
    return shortened(repr(value))


def _without_angle(dimension: tuple[tuple[str, int], ...]) -> tuple[tuple[str, int], ...]:
    return tuple(item for item in dimension if item[0] not in ("[angle]", "[cycle]"))


@lru_cache(maxsize=256)
def _scale(unit: str) -> tuple[float, tuple[tuple[str, int], ...]]:
    """Factor to SI and dimension ((name, power), …, sorted) of a unit text."""
    text = _normalised(unit)
    if not text:
        return 1.0, ()
    if len(text) > _LONGEST or not _UNIT.fullmatch(text):
        raise QuantityError(f"{_shown(unit)} is no unit", "a unit such as kN/m or kg m^2")
    registry = _registry()
    # One at a time, so that the message names the one that is not known.
    for name in re.findall(_NAME, text):
        if not _is_unit(name, registry):
            raise QuantityError(
                f"{name!r} is no unit that is known", "a unit such as kN/m or kg m^2", _near(name)
            )
    try:
        root = registry.Quantity(1.0, registry.parse_units(text)).to_root_units()
    except (OverflowError, ZeroDivisionError):
        raise QuantityError(f"{_shown(unit)} is out of range", "a unit such as kN/m") from None
    dimension: dict[str, Any] = dict(root.dimensionality)
    return float(root.magnitude), tuple(sorted((k, int(v)) for k, v in dimension.items()))


def _normalised(unit: str) -> str:
    """Return the unit text as Pint reads it: ``*``, ``/``, ``**``, one space at a time."""
    text = re.sub(r"[⁻⁺⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda m: f"**{m.group().translate(_SUPERSCRIPTS)}", unit)
    text = text.translate(_SIGNS).replace("^", "**").replace("%", "percent").replace("°", "deg")
    text = re.sub(r" ?\*\* ?", "**", " ".join(text.split()))
    return re.sub(rf"({_NAME})(-?\d)(?!\d)", r"\1**\2", text)  # m2 and s-1 of CSV headers


def _near(name: str) -> str:
    same = [unit for unit in _COMMON if unit.lower() == name.lower()]
    near = same or difflib.get_close_matches(name, _COMMON, n=2, cutoff=0.5)
    return f"did you mean {' or '.join(near)}?" if near else f"known are {', '.join(_COMMON)}"


def _is_unit(name: str, registry: UnitRegistry[Any]) -> bool:
    try:
        return name in registry
    except ValueError:  # Pint reads nan as a number
        return False


@lru_cache(maxsize=1)
def _registry() -> UnitRegistry[Any]:
    from pint import UnitRegistry

    return UnitRegistry(data_path("units.txt"), cache_folder=None)
