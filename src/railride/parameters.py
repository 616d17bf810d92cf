"""Parameter files: a vehicle from TOML, with a unit on every value, and back.

A file has the top-level keys ``name``, ``source`` and ``remarks``; a table ``[body]``; a table
``[bogie]`` of what all bogies share; one table ``[[bogies]]`` for each, from the front, with its
``position`` and whatever differs; and a table ``[[payload]]`` for each load and ``[[equipment]]``
for each mass on elastic mounts under the floor, if any. The keys are the fields of
:class:`CarBody`, :class:`Bogie`, :class:`Load` and :class:`Equipment`, the values
``"number unit"``. Any table may explain itself: ``note`` and ``source`` are texts, ``notes`` a
table of texts by key.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any

from railride.body_profile import BodyProfile, PointMass
from railride.body_segments import Segment
from railride.body_sources import Elements, ModeFiles
from railride.body_tables import body_lines, read_body
from railride.car_body import CarBody
from railride.errors import Faults
from railride.files import shipped_names, shipped_or_file, write_text
from railride.record_tables import note_all_missing, note_missing, read_values, written
from railride.toml_tables import Table, file_table, toml_text
from railride.vehicle_data import (
    Bogie,
    Equipment,
    Load,
    Vehicle,
    check_arrangement,
    check_equipment,
    check_hung,
    check_load,
    check_mounts,
    check_payload,
    check_texts,
    check_wheelsets,
)

__all__ = [
    "BodyProfile",
    "Bogie",
    "CarBody",
    "Elements",
    "Equipment",
    "Load",
    "ModeFiles",
    "PointMass",
    "Segment",
    "Vehicle",
    "load_vehicle",
    "shipped_vehicles",
    "to_toml",
    "write_vehicle",
]

_SCHEMA = 1


def shipped_vehicles() -> tuple[str, ...]:
    """Names of the parameter sets that come with the program.

    >>> shipped_vehicles()
    ('cati2024', 'ice3', 'manchester', 'shinkansen_s300')
    """
    return shipped_names("vehicle")


def load_vehicle(name_or_path: str | Path) -> Vehicle:
    """Vehicle of a shipped parameter set, or of a TOML file.

    name_or_path: a name of :func:`shipped_vehicles`, or the path of a file.

    Raises InputError with all that is wrong with the file at once: keys that are missing, unknown
    or misspelt, values without a unit or of another dimension, parts that do not fit together.
    ``data/vehicles/cati2024.toml`` is an example to follow.

    >>> load_vehicle("cati2024").bogies[0].primary_stiffness
    5000000.0
    """
    return _read_vehicle(shipped_or_file(name_or_path, "vehicle"))


def _read_vehicle(path: Path) -> Vehicle:
    """Vehicle of a parameter file: every fault in it is noted before any is raised."""
    top = file_table(path, _SCHEMA)
    faults = top.faults
    name, source, remarks = top.text("name"), top.text("source"), top.texts("remarks")
    check_texts(path.stem if name is None else name, source or "", remarks, faults)
    body = read_body(top, path.parent, faults)
    bogies = _read_bogies(top, faults)
    payload = _read_each(top, "payload", Load, check_load, faults)
    equipment = _read_each(top, "equipment", Equipment, check_equipment, faults)
    top.finish()
    check_arrangement(body, bogies, faults)
    check_payload(body, payload, faults)
    check_hung(body, equipment, faults)
    faults.raise_if_any()
    return Vehicle(
        name=path.stem if name is None else name,
        body=CarBody(**body),
        bogies=tuple(Bogie(**bogie) for bogie in bogies),
        source=source or "",
        remarks=remarks,
        payload=tuple(Load(**load) for load in payload),
        equipment=tuple(Equipment(**one) for one in equipment),
    )


def _read_bogies(top: Table, faults: Faults) -> list[dict[str, Any]]:
    """Values of each of ``[[bogies]]``, those of ``[bogie]`` where it has none of its own."""
    all_of_them = fields(Bogie)
    shared_fields = [item for item in all_of_them if item.name != "position"]
    common = top.table("bogie")
    shared: dict[str, Any] = {}
    if common is not None:
        shared = read_values(common, shared_fields)
        common.finish()
        check_wheelsets(shared, "bogie.", faults)
    bogies = []
    tables = top.tables("bogies")
    for table in tables:
        own = read_values(table, all_of_them)
        table.finish()
        check_wheelsets(own, table.key(""), faults)
        check_mounts(shared | own, table.key(""), faults)
        bogies.append(shared | own)
    for item in all_of_them:
        if item.default is not MISSING or (common is not None and item.name in common):
            continue
        without = [table.key(item.name) for table in tables if item.name not in table]
        if without and len(without) == len(tables) and item.name != "position":
            without = [f"bogie.{item.name}"]  # once for all
        for where in without:
            note_missing(where, item, faults)
    return bogies


def _read_each(
    top: Table,
    name: str,
    record: type[Load | Equipment],
    check: Callable[[Mapping[str, Any], str, Faults], None],
    faults: Faults,
) -> list[dict[str, Any]]:
    """Values of each of the tables ``[[name]]``."""
    found = []
    for table in top.tables(name):
        values = read_values(table, fields(record))
        table.finish()
        note_all_missing(table, fields(record), faults)
        check(values, table.key(""), faults)
        found.append(values)
    return found


def to_toml(vehicle: Vehicle) -> str:
    """Text of a parameter file that reads back as an equal vehicle, in SI units.

    >>> print(to_toml(load_vehicle("cati2024")).split("[bogie]")[1].splitlines()[1])
    mass = "3000.0 kg"
    """
    lines = [f"name = {toml_text(vehicle.name)}", f"source = {toml_text(vehicle.source)}"]
    lines += ["remarks = [", *(f"    {toml_text(remark)}," for remark in vehicle.remarks), "]"]
    lines += [f"schema = {_SCHEMA}", "", *body_lines(vehicle.body)]
    first, *others = vehicle.bogies
    shared = [
        item
        for item in fields(Bogie)
        if item.name != "position"
        and all(getattr(bogie, item.name) == getattr(first, item.name) for bogie in others)
    ]
    lines += ["", "[bogie]", *written(first, shared)]
    own = [item for item in fields(Bogie) if item not in shared]
    for bogie in vehicle.bogies:
        lines += ["", "[[bogies]]", *written(bogie, own)]
    for load in vehicle.payload:
        lines += ["", "[[payload]]", *written(load, fields(Load))]
    for one in vehicle.equipment:
        lines += ["", "[[equipment]]", *written(one, fields(Equipment))]
    return "\n".join(lines) + "\n"


def write_vehicle(vehicle: Vehicle, path: str | Path) -> None:
    """Write ``vehicle`` as a parameter file, whole or not at all.

    path: the file to be written or replaced.

    Raises InputError where it cannot be written.
    """
    write_text(path, to_toml(vehicle))
