"""The car body in parameter files: the table ``[body]`` and those of what it has along its length.

``[body.profile]`` has a list for each column of :class:`BodyProfile`, or names a ``file`` of these
columns, headed ``x [m]``, ``bending_stiffness [N m^2]`` and so on; and there is a table
``[[body.profile.point_masses]]`` for each mass. A table ``[[segments]]`` is one segment, from the
front. With a profile or with segments, mass, mass centre, pitch inertia and length may be left out:
they follow. ``[body.elements]`` and ``[body.modes]`` have the keys of :class:`Elements` and
:class:`ModeFiles`; files lie beside the parameter file.
"""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Any

from railride.body_checks import check_body, rigid_values
from railride.body_profile import BodyProfile, PointMass, check_profile
from railride.body_segments import Segment, check_segment
from railride.body_sources import Elements, ModeFiles, check_mode_files
from railride.car_body import CarBody
from railride.errors import Faults
from railride.quantities import quantity_fields
from railride.record_tables import note_all_missing, read_column, read_values, written
from railride.tables import NumberTable, read_table
from railride.toml_tables import Table


def read_body(top: Table, folder: Path, faults: Faults) -> dict[str, Any]:
    """Values of ``[body]``; what is missing or faulty is left out and noted.

    folder: in which a file of a profile is looked for.
    """
    table = top.table("body")
    if table is None:
        faults.add("[body]", "no such table", "the car body's mass, pitch_inertia, length, …")
        return {}
    values = read_values(table, fields(CarBody))
    inertia = table.text("inertia")
    if inertia is not None:
        values["inertia"] = inertia
    described, rows = table.table("profile"), top.tables("segments")
    profile = None if described is None else _read_profile(described, folder, faults)
    values |= _read_sources(table, folder, faults)
    table.finish()
    if described is None and not rows:
        note_all_missing(table, fields(CarBody), faults)
    if profile is not None:
        values["profile"] = profile
    before = len(faults.found)
    segments = [_read_segment(row, faults) for row in rows]
    if len(faults.found) == before:
        values["segments"] = tuple(Segment(**segment) for segment in segments)
    check_body(values, table.key(""), faults)
    return values | rigid_values(values)


def _read_sources(table: Table, folder: Path, faults: Faults) -> dict[str, Any]:
    """The finite elements, and the files of a body from outside."""
    found: dict[str, Any] = {}
    elements, files = table.table("elements"), table.table("modes")
    if elements is not None:
        number = elements.whole("number")
        values = read_values(elements, fields(Elements))
        elements.finish()
        found["elements"] = Elements(number, **values)
    if files is not None:
        before = len(faults.found)
        texts = {item.name: files.text(item.name) for item in fields(ModeFiles)}
        files.finish()
        check_mode_files(texts, files.key(""), faults)
        if len(faults.found) == before:
            paths = {name: str((folder / path).resolve())
                     for name, path in ModeFiles(**texts).paths.items()}  # fmt: skip
            found["mode_files"] = ModeFiles(**texts | paths)
    return found


def _read_profile(table: Table, folder: Path, faults: Faults) -> BodyProfile | None:
    """The profile of ``[body.profile]``; None, with the faults noted, where it is not whole."""
    before = len(faults.found)
    values, name = read_values(table, fields(BodyProfile)), table.text("file")
    points = [_read_point(point, faults) for point in table.tables("point_masses")]
    table.finish()
    if name is None:
        note_all_missing(table, fields(BodyProfile), faults)
    elif values:
        faults.add(table.key("file"), f"a file and {', '.join(values)} with it", "one of the two")
    else:
        values = _read_columns(read_table(folder / name))
    check_profile(values | {"point_masses": points}, table.key(""), faults)
    if len(faults.found) > before:
        return None
    return BodyProfile(**values, point_masses=tuple(PointMass(**point) for point in points))


def _read_columns(table: NumberTable) -> dict[str, tuple[float, ...]]:
    """Columns of a profile from a file, SI."""
    faults = Faults(table.source)
    values: dict[str, tuple[float, ...]] = {}
    items = quantity_fields(BodyProfile)
    names = ", ".join(item.name for item in items)
    for item in items:
        found = table.find(item.name)
        if len(found) > 1:
            faults.add("header", f"{item.name} twice", "one column of each")
        elif found:
            unit, sign = item.metadata["unit"], item.metadata["sign"]
            values[item.name] = read_column(table, found[0], unit, sign, faults)
        elif item.default is not None:
            unit = item.metadata["unit"]
            faults.add("header", f"no column {item.name}", f"one headed {item.name} [{unit}]")
    known = {column.heading for name in values for column in table.find(name)}
    for column in table.columns:
        if column.heading not in known:
            faults.add(f"column {column.heading!r}", "a name that is not known", f"one of {names}")
    faults.raise_if_any()
    return values


def _read_point(table: Table, faults: Faults) -> dict[str, Any]:
    """Values of one of ``[[body.profile.point_masses]]``."""
    point = read_values(table, fields(PointMass))
    table.finish()
    note_all_missing(table, fields(PointMass), faults)
    return point


def _read_segment(table: Table, faults: Faults) -> dict[str, Any]:
    """Values of one of ``[[segments]]``."""
    segment = read_values(table, fields(Segment))
    table.finish()
    note_all_missing(table, fields(Segment), faults)
    check_segment(segment, table.key(""), faults)
    return segment


def body_lines(body: CarBody) -> list[str]:
    """The tables that read back as ``body``."""
    lines = ["[body]", *written(body, fields(CarBody))]
    if body.profile is not None:
        lines += ["", "[body.profile]", *written(body.profile, fields(BodyProfile))]
        for point in body.profile.point_masses:
            lines += ["", "[[body.profile.point_masses]]", *written(point, fields(PointMass))]
    if body.elements is not None:
        lines += ["", "[body.elements]", *written(body.elements, fields(Elements))]
    if body.mode_files is not None:
        lines += ["", "[body.modes]", *written(body.mode_files, fields(ModeFiles))]
    for segment in body.segments:
        lines += ["", "[[segments]]", *written(segment, fields(Segment))]
    return lines
