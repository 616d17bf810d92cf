"""The sections ``[optimise]`` and ``[limits]`` of study files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from railride.designs.given import given_cases
from railride.errors import InputError
from railride.optimisation.limits import AT_LEAST, BETWEEN, KINDS, Limit, check_limits
from railride.optimisation.problem import GOALS
from railride.optimisation.task import (
    AGAINST,
    SEARCHES,
    Front,
    Task,
    mode_labels,
    task_of,
)
from railride.stochastic.extremes import DISTANCE
from railride.studies import Draft, Range, Study, read_study
from railride.toml_tables import Table


@dataclass(frozen=True)
class LimitsSection:
    """What ``[limits]`` says: the limits, and the distance over which peaks are expected, m."""

    limits: tuple[Limit, ...]
    distance: float


def read_task(name_or_path: str | Path) -> tuple[Study, Task]:
    """A study and the optimisation that it asks for.

    Raises
    ------
    InputError : everything that is wrong with the file at once.
    """
    study = read_study(name_or_path, {"limits": _read_limits, "optimise": _read_optimise})
    ride, limits = study.ride, study.settings["limits"]
    options, asked = study.settings["optimise"]
    ranges = {p.name: (p.spec.low, p.spec.high) for p in study.parameters
              if isinstance(p.spec, Range)}  # fmt: skip
    model = study.model()
    try:
        cases = given_cases(
            model, ride.tracks, ride.speeds, ride.positions, ride.floor, ride.weight
        )
        task = task_of(model, ranges, cases, distance=limits.distance, **options)
    except InputError as error:
        raise InputError(f"{study.path}: {error}") from None
    return study, replace(task, limits=limits.limits, front=asked)


def _read_optimise(table: Table, draft: Draft) -> tuple[dict[str, Any], Front | None]:
    """Options of the optimisation, and the front where one is asked for."""
    options: dict[str, Any] = {
        "objective": table.choice("objective", GOALS),
        "weights": table.quantities("weights", "", ">= 0"),
        "search": table.choice("search", SEARCHES),
        "starts": table.whole("starts"),
        "seed": table.whole("seed"),
    }
    asked = _read_front(table.table("pareto"), draft)
    table.finish()
    if not draft.parameters:
        table.faults.add("parameters", "none", "a table [parameters.NAME] with from and to")
    for p in draft.parameters:
        if not isinstance(p.spec, Range):
            found = "nothing" if p.spec is None else "no range"
            table.faults.add(f"parameters.{p.name}", found, "a range to choose from, from and to")
    return {name: value for name, value in options.items() if value is not None}, asked


def _read_front(table: Table | None, draft: Draft) -> Front | None:
    if table is None:
        return None
    usual = Front()
    against, points = table.choice("against", AGAINST), table.whole("points")
    table.finish()
    found = Front(against or usual.against, usual.points if points is None else points)
    if draft.model is not None:
        found.note_faults(draft.model, table.faults, table.where)
    return found


def _read_limits(table: Table, draft: Draft) -> LimitsSection:
    found: list[Limit] = []
    for name, kind in KINDS.items():
        content = table.content.get(name)
        if kind.side == BETWEEN:
            found += _read_range(table, name, kind.unit)
        elif isinstance(content, Mapping):
            found += _read_modes(table, name)
        else:
            value = table.quantity(name, kind.unit, "> 0")
            if value is not None:
                found.append(Limit(name, value, kind.side == AT_LEAST))
    distance = table.quantity("distance", "m", "> 0")
    table.finish()
    if draft.model is not None:
        check_limits(draft.model, found, mode_labels(draft.model), table.faults, "limits.")
    return LimitsSection(tuple(found), DISTANCE if distance is None else distance)


def _read_range(table: Table, name: str, unit: str) -> list[Limit]:
    """Limits of a table with ``from`` or ``to`` or both."""
    inner = table.table(name)
    if inner is None:
        return []
    ends = {True: inner.quantity("from", unit, "> 0"), False: inner.quantity("to", unit, "> 0")}
    if "from" not in inner and "to" not in inner:
        inner.fault("from", "neither from nor to", "one of them, or both")
    inner.finish()
    return [Limit(name, end, at_least) for at_least, end in ends.items() if end is not None]


def _read_modes(table: Table, name: str) -> list[Limit]:
    """Damping ratios by the modes' labels."""
    inner = table.table(name)
    if inner is None:
        return []
    if name != "damping_ratio":
        inner.faults.add(inner.where, "a table", f'one value, {name} = "number unit"')
        return []
    values = {label: inner.quantity(label, "", "> 0") for label in inner.content}
    return [Limit(name, value, True, label) for label, value in values.items() if value is not None]
