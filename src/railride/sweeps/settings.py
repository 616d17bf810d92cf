"""The table ``[sweep]`` of a study file: which designs, in what parts, in which files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from pathlib import Path

import numpy as np

from railride.distributions import METHODS, Distribution, refuse_sampling
from railride.errors import Faults, InputError
from railride.files import there
from railride.record_tables import read_column
from railride.studies import Draft, Listed, Range, Study, StudyParameter, read_study
from railride.sweeps.plan import MOST, DesignList, Grid, Plan, Samples
from railride.tables import Column, NumberTable, read_table
from railride.toml_tables import Table

KINDS = ("grid", "list", "samples")
FORMS = ("parquet", "csv")
LEAST_CHUNK, MOST_CHUNK, CHUNKS = 1000, 10_000, 100
LARGEST_CHUNK = 1_000_000  # designs: more would not fit into a worker's memory
NUMBERING = ("design", "number", "nr", "no")  # columns of a list that are no parameters


@dataclass(frozen=True)
class SweepSettings:
    """What ``[sweep]`` says: the designs, how many in a part, and its form; None for either."""

    plan: Plan
    chunk: int
    form: str | None = None


def read_sweep_study(name_or_path: str | Path) -> Study:
    """A study with its ``[sweep]`` read, as ``settings["sweep"]``.

    name_or_path : as for :func:`railride.read_study`.

    Raises
    ------
    InputError : everything that is wrong with the file at once, and with the list of designs.
    """
    return read_study(name_or_path, {"sweep": read_sweep})


def read_sweep(table: Table, draft: Draft) -> SweepSettings | None:
    """The settings; None, with the faults noted, where they cannot be."""
    before = len(table.faults.found)
    table.missing("kind", 'kind = "grid", "list" or "samples"')
    kind = table.choice("kind", KINDS)
    chunk = table.whole("chunk")
    if chunk is not None and not 1 <= chunk <= LARGEST_CHUNK:
        table.fault("chunk", str(chunk), f"a whole number from 1 to {LARGEST_CHUNK:,}")
    form = table.choice("format", FORMS)
    readers = {"grid": _read_grid, "list": _read_list, "samples": _read_samples}
    plan = readers[kind](table, draft) if kind else None
    if kind:
        table.finish()
    if plan is None or len(table.faults.found) > before:
        return None
    usual = max(LEAST_CHUNK, min(MOST_CHUNK, -(-plan.total // CHUNKS)))
    return SweepSettings(plan, usual if chunk is None else chunk, form)


def _check_specs(table: Table, draft: Draft, kinds: tuple[type, ...], expected: str) -> None:
    """Note parameters that take something else, and that there are none."""
    if not draft.parameters and draft.names is not None and not table.faults.found:
        table.faults.add("parameters", "none", "a table [parameters.NAME] for each that is varied")
    for p in draft.parameters:
        where = f"parameters.{p.name}"
        if p.spec is None:
            said = any(fault.where.startswith(where) for fault in table.faults.found)
            if not said:
                table.faults.add(where, "nothing", expected)
        elif not isinstance(p.spec, kinds):
            found = "a distribution" if isinstance(p.spec, Distribution) else "a range or values"
            table.faults.add(where, found, expected)


def _read_grid(table: Table, draft: Draft) -> Plan | None:
    _check_specs(table, draft, (Range, Listed), "from, to and points, or values")
    for p in draft.parameters:
        where = f"parameters.{p.name}.points"
        said = any(fault.where == where for fault in table.faults.found)
        if isinstance(p.spec, Range) and p.spec.points is None and not said:
            table.faults.add(where, "nothing", "points = 11, or so",
                             "a grid takes a number of values")  # fmt: skip
    total = prod(len(p.spec.values()) for p in draft.parameters
                 if isinstance(p.spec, Range | Listed))  # fmt: skip
    if total > MOST:
        table.faults.add("parameters", f"{total:.3g} combinations", f"at most {MOST:.0g}")
    return Grid(draft.parameters)


def _read_samples(table: Table, draft: Draft) -> Plan | None:
    _check_specs(table, draft, (Distribution,), 'distribution = "normal", or another one')
    table.missing("number", "number = 10000, or so")
    number, seed = table.whole("number"), table.whole("seed")
    method = table.choice("method", METHODS) or "sobol"
    if number is None:
        return None
    wrong = Faults("")
    refuse_sampling(wrong, len(draft.parameters), number, method, 0 if seed is None else seed)
    for fault in wrong.found:
        table.fault(fault.where, fault.found, fault.expected, fault.mend)
    if number == 0:
        table.fault("number", "0", "at least one design")
    return Samples(draft.parameters, number, method, 0 if seed is None else seed)


def _read_list(table: Table, draft: Draft) -> Plan | None:
    for p in draft.parameters:
        table.faults.add(f"parameters.{p.name}", "a table of a parameter",
                         "none: the columns of the list say it all", "leave it out")  # fmt: skip
    table.missing("file", 'file = "designs.csv", a table of designs')
    name = table.text("file")
    if name is None or draft.names is None:
        return None
    path = draft.folder / name if there(draft.folder / name) else Path(name)
    try:
        return designs_of(read_table(path), draft, path)
    except InputError as error:
        table.faults.include(table.key("file"), error)
        return None


def designs_of(numbers: NumberTable, draft: Draft, path: Path) -> DesignList:
    """The designs of a table of columns headed ``secondary_stiffness [kN/m]``, one in each row.

    Raises
    ------
    InputError : columns that are no parameters, or the same one; units of another dimension; cells
        that are no numbers, or none that the parameter can have; no rows.
    """
    faults = Faults(numbers.source)
    found: list[tuple[StudyParameter, Sequence[float]]] = []
    for column in numbers.columns:
        if column.name.lower() not in NUMBERING and draft.names is not None:
            found += _read_parameter(numbers, column, draft, faults)
    if not found and not faults.found:
        faults.add("file", "no columns of parameters", "columns such as 'k_2 [kN/m]'")
    if numbers.n == 0:
        faults.add("file", "no rows", "a design in each row")
    faults.raise_if_any()
    values = np.array([values for _, values in found], dtype=float).T
    return DesignList(tuple(parameter for parameter, _ in found), values, path)


def _read_parameter(
    numbers: NumberTable, column: Column, draft: Draft, faults: Faults
) -> list[tuple[StudyParameter, Sequence[float]]]:
    """The parameter of a column with its values; nothing, with a fault noted, if it is none."""
    if draft.names is None:
        return []
    try:
        parameter = draft.names.parameter(column.name)
    except InputError as error:
        faults.include(f"column {column.heading!r}", error)
        return []
    sign = draft.names.sign(parameter)
    return [(parameter, read_column(numbers, column, parameter.unit, sign, faults))]
