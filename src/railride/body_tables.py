"""The car body in parameter files: the table ``[body]`` and those of what it has along its length.

``[body.profile]`` has a list for each column of :class:`BodyProfile`, and a table
``[[body.profile.point_masses]]`` for each mass. With a profile, mass, mass centre, pitch inertia
and length may be left out: they follow.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from railride.body_profile import BodyProfile, PointMass, check_profile
from railride.car_body import CarBody, check_body, rigid_values
from railride.errors import Faults
from railride.record_tables import note_all_missing, read_values, written
from railride.toml_tables import Table


def read_body(top: Table, faults: Faults) -> dict[str, Any]:
    """Values of ``[body]``; what is missing or faulty is left out and noted."""
    table = top.table("body")
    if table is None:
        faults.add("[body]", "no such table", "the car body's mass, pitch_inertia, length, …")
        return {}
    values = read_values(table, fields(CarBody))
    inertia = table.text("inertia")
    if inertia is not None:
        values["inertia"] = inertia
    described = table.table("profile")
    profile = None if described is None else _read_profile(described, faults)
    table.finish()
    if described is None:
        note_all_missing(table, fields(CarBody), faults)
    if profile is not None:
        values["profile"] = profile
    check_body(values, table.key(""), faults)
    return values if profile is None else values | rigid_values(profile)


def _read_profile(table: Table, faults: Faults) -> BodyProfile | None:
    """The profile of ``[body.profile]``; None, with the faults noted, where it is not whole."""
    before = len(faults.found)
    values = read_values(table, fields(BodyProfile))
    values["point_masses"] = [_read_point(point, faults) for point in table.tables("point_masses")]
    table.finish()
    note_all_missing(table, fields(BodyProfile), faults)
    check_profile(values, table.key(""), faults)
    if len(faults.found) > before:
        return None
    points = tuple(PointMass(**point) for point in values.pop("point_masses"))
    return BodyProfile(**values, point_masses=points)


def _read_point(table: Table, faults: Faults) -> dict[str, Any]:
    """Values of one of ``[[body.profile.point_masses]]``."""
    point = read_values(table, fields(PointMass))
    table.finish()
    note_all_missing(table, fields(PointMass), faults)
    return point


def body_lines(body: CarBody) -> list[str]:
    """The tables that read back as ``body``."""
    lines = ["[body]", *written(body, fields(CarBody))]
    if body.profile is not None:
        lines += ["", "[body.profile]", *written(body.profile, fields(BodyProfile))]
        for point in body.profile.point_masses:
            lines += ["", "[[body.profile.point_masses]]", *written(point, fields(PointMass))]
    return lines
