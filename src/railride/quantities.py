"""Records of quantities: each field says its unit and what its numbers must be, and is checked.

And the numbers that a caller gives, checked likewise.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import Field, fields
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any

from railride.errors import Faults, InputError
from railride.toml_tables import expected_sign, finite_number, shown

if TYPE_CHECKING:
    from _typeshed import DataclassInstance
    from numpy.typing import ArrayLike

ONE, LIST, EITHER = "one", "list", "either"


def si(unit: str, sign: str = "", many: str = ONE) -> dict[str, str]:
    """Metadata of a dataclass field: its SI unit, its sign, and how many numbers it holds.

    sign: "> 0", ">= 0", or "" for any. many: one number, a list of them, or either.
    """
    return {"unit": unit, "sign": sign, "many": many}


def quantity_fields(record: type[DataclassInstance]) -> list[Field[Any]]:
    """The fields of a record that hold quantities."""
    return [item for item in fields(record) if "unit" in item.metadata]


def is_list(value: object) -> bool:
    """Whether ``value`` is a sequence of values: a text is none."""
    return isinstance(value, Sequence) and not isinstance(value, str)


def checked_numbers(record: DataclassInstance, faults: Faults) -> dict[str, Any]:
    """Make the numbers of ``record`` floats; return the good ones, noting the faults of others."""
    good: dict[str, Any] = {}
    for item in quantity_fields(type(record)):
        value = getattr(record, item.name)
        if value is None and item.default is None:
            continue
        unit, sign, many = (item.metadata[key] for key in ("unit", "sign", "many"))
        several = many == LIST or (many == EITHER and is_list(value))
        if several and not is_list(value):
            faults.add(item.name, shown(value), f"a sequence of numbers, {unit}")
            continue
        numbers = tuple(finite_number(x) for x in (value if several else (value,)))
        wrong = [(i, expected_sign(x, sign)) for i, x in enumerate(numbers)]
        for i, expected in wrong:
            if expected:
                where, found = (
                    (f"{item.name}[{i + 1}]", value[i]) if several else (item.name, value)
                )
                faults.add(where, shown(found), f"{expected} {unit}".rstrip())
        if not any(expected for _, expected in wrong):
            good[item.name] = numbers if several else numbers[0]
            object.__setattr__(record, item.name, good[item.name])
    return good


def check_number(faults: Faults, where: str, value: object, sign: str = "", unit: str = "") -> None:
    r"""Note an argument that is no finite number of its sign: "> 0", ">= 0", or "" for any.

    >>> faults = Faults("skyhook")
    >>> check_number(faults, "gain", "a", "> 0", "N s/m")
    >>> check_number(faults, "bandwidth", -3.0, "> 0", "Hz")
    >>> print(*faults.found, sep="\n")
    gain: found 'a'; expected a positive number (in N s/m)
    bandwidth: found -3.0 Hz; expected a positive number
    """
    expected = expected_sign(finite_number(value), sign)
    if not expected:
        return
    if isinstance(value, Real):
        faults.add(where, f"{value} {unit}".rstrip(), expected)
    else:
        faults.add(where, repr(value), expected, f"in {unit}" if unit else "")


def check_whole(value: object, where: str, least: int) -> None:
    """Refuse, by an InputError that names ``where``, what is no whole number of at least that.

    >>> check_whole(2, "workers", least=1)
    >>> check_whole(1.5, "workers", least=1)
    Traceback (most recent call last):
    ...
    railride.errors.InputError: workers: found 1.5; expected a whole number, at least 1
    """
    if not isinstance(value, Integral) or isinstance(value, bool) or value < least:
        raise InputError(f"{where}: found {value!r}; expected a whole number, at least {least}")


def names(values: object, where: str) -> list[Any]:
    """One name, or several and at least one, as a list; InputError that names ``where`` otherwise.

    >>> names("track", "source"), names(("w_1", "w_2"), "source")
    (['track'], ['w_1', 'w_2'])
    """
    found = [values] if isinstance(values, str) else values
    if not isinstance(found, Iterable) or not (listed := list(found)):
        what = "none" if isinstance(found, Iterable) else repr(values)
        raise InputError(f"{where}: found {what}; expected at least one name")
    return listed


def several(values: ArrayLike, where: str, unit: str = "SI units") -> list[float]:
    """One number or several as a list.

    Raises InputError, naming the argument ``where``, for what are no numbers.

    >>> several(40.0, "speeds"), several([40.0, 50.0], "speeds")
    ([40.0], [40.0, 50.0])
    """
    import numpy as np

    try:
        if values is None:  # to numpy, not a number
            raise TypeError
        return [float(value) for value in np.atleast_1d(np.asarray(values, dtype=float))]
    except (TypeError, ValueError):
        raise InputError(f"{where}: found {values!r}; expected numbers, in {unit}") from None


def in_kmh(speed: float) -> str:
    """A speed in m/s for people.

    >>> in_kmh(145 / 3.6)
    '145 km/h'
    """
    return f"{3.6 * speed:.6g} km/h"
