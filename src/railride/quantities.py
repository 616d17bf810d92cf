"""Records of quantities: each field says its unit and what its numbers must be, and is checked."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, fields
from typing import TYPE_CHECKING, Any

from railride.errors import Faults
from railride.toml_tables import expected_sign, finite_number, shown

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

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
