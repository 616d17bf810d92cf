"""Records of quantities as tables of a TOML file, and columns of them from tables of numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import MISSING, Field
from typing import TYPE_CHECKING, Any

from railride.errors import Faults, RowFaults
from railride.quantities import EITHER, LIST
from railride.tables import Column, NumberTable
from railride.toml_tables import Table, expected_sign, toml_text
from railride.units import QuantityError, same_dimension, to_si

if TYPE_CHECKING:
    from _typeshed import DataclassInstance


def read_values(table: Table, items: Sequence[Field[Any]]) -> dict[str, Any]:
    """SI values of those fields that have a unit and stand in the table without fault."""
    values: dict[str, Any] = {}
    for item in items:
        if "unit" not in item.metadata:
            continue
        many = item.metadata["many"]
        several = many == LIST or (many == EITHER and table.holds_list(item.name))
        read = table.quantities if several else table.quantity
        value = read(item.name, item.metadata["unit"], item.metadata["sign"])
        if value is not None:
            values[item.name] = value
    return values


def note_all_missing(table: Table, items: Sequence[Field[Any]], faults: Faults) -> None:
    """Note every field without a default that does not stand in the table."""
    for item in items:
        if item.default is MISSING and item.name not in table:
            note_missing(table.key(item.name), item, faults)


def note_missing(where: str, item: Field[Any], faults: Faults) -> None:
    """Note that a field's key is missing."""
    unit = item.metadata["unit"]
    form = f'["number {unit}", …]' if item.metadata["many"] == LIST else f'"number {unit}"'
    faults.add(where, "nothing", f"{item.name} = {form}", "the key is missing")


def written(record: DataclassInstance, items: Sequence[Field[Any]]) -> list[str]:
    """``key = value`` for each text, whole number or quantity that is not the default."""
    lines = []
    for item in items:
        value = getattr(record, item.name)
        unit = item.metadata.get("unit")
        if value == item.default or not (unit is not None or isinstance(value, str | int)):
            continue
        if isinstance(value, str):
            text = toml_text(value)
        elif isinstance(value, tuple):
            text = f"[{', '.join(toml_text(f'{number!r} {unit}') for number in value)}]"
        else:
            text = toml_text(f"{value!r} {unit}") if unit else repr(value)
        lines.append(f"{item.name} = {text}")
    return lines


def read_column(
    table: NumberTable,
    column: Column,
    unit: str,
    sign: str,
    faults: Faults,
    rows: Sequence[int] | None = None,
) -> tuple[float, ...]:
    """Numbers of a column, SI, whose heading must name a unit of the kind of ``unit``.

    sign: "> 0", ">= 0", or "" for any. rows: those that are read, 0 first; None: all.
    """
    chosen = range(table.n) if rows is None else rows
    factor = unit_factor(column.unit, unit, f"column {column.heading!r}", faults)
    notes, bad, numbers = RowFaults(faults), set(column.bad.tolist()), []
    for i in chosen:
        value = float(column.numbers[i])
        expected = expected_sign(None if i in bad else value, sign)
        if expected:
            notes.add(table.row(i), column.heading, column.shown(i), expected)
        numbers.append(factor * value)
    notes.close()
    return tuple(numbers)


def unit_factor(given: str, unit: str, where: str, faults: Faults) -> float:
    """Factor to SI of a unit that must be of the kind of ``unit``; else 1, with a fault noted.

    where: what has it, for the message.
    """
    try:
        if same_dimension(given, unit):
            return to_si(1.0, given)
        found = f"the unit {given!r}" if given else "no unit"
        faults.add(where, found, f"one such as [{unit}]" if unit else "none")
    except QuantityError as error:
        faults.add(where, error.found, error.expected, error.mend)
    return 1.0
