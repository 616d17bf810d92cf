"""Study files: read as a whole, all that is wrong with one of them told together.

The file's keys are those of ``docs/study-files.md``. What ``[sweep]``, ``[optimise]``, ``[limits]``
and ``[uncertainty]`` say is read by who needs it: each hands a reader of its section to
:func:`read_study`, so that its faults are told with all others.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from railride.errors import InputError
from railride.files import shipped_names, shipped_or_file, there
from railride.parameters import Vehicle, load_vehicle, shipped_vehicles
from railride.studies.body import derived, read_body_options
from railride.studies.cases import RideCases, read_ride
from railride.studies.parameters import Names, StudyParameter, read_parameters
from railride.studies.study import Study
from railride.toml_tables import Table, file_table
from railride.vehicle import VehicleModel

SECTIONS = ("sweep", "optimise", "limits", "uncertainty")
_SCHEMA = 1


@dataclass(frozen=True)
class Draft:
    """What of a study file is known when its sections are read; None for what is faulty.

    folder : from which the file names others. names : looks further parameters up.
    """

    folder: Path
    model: VehicleModel | None
    names: Names | None
    ride: RideCases | None
    parameters: tuple[StudyParameter, ...]


SectionReader = Callable[[Table, Draft], Any]


def shipped_studies() -> tuple[str, ...]:
    """Names of the studies that come with the program, to be run and to be copied.

    >>> "sweep_grid" in shipped_studies()
    True
    """
    return shipped_names("study")


def read_study(
    name_or_path: str | Path, readers: Mapping[str, SectionReader] | None = None
) -> Study:
    """A study from its file.

    Parameters
    ----------
    name_or_path : a name of :func:`shipped_studies`, or the path of a TOML file.
    readers : section → what makes something of its table, to be found in ``Study.settings``. It
        notes faults in the table and calls ``table.finish()``; an absent section is an empty table.
        Sections that nobody asks for are left unread.

    Raises
    ------
    InputError : everything that is wrong with the file at once: keys that are missing, unknown or
        misspelt, values without a unit or of another dimension, parameters that the vehicle does
        not have, ranges that are empty or reversed; a vehicle or track that cannot be used.

    Examples
    --------
    >>> study = read_study("sweep_grid")
    >>> [parameter.heading for parameter in study.parameters]
    ['secondary_stiffness [N/m]', 'secondary_damping [N s/m]']
    """
    path = shipped_or_file(name_or_path, "study")
    top = file_table(path, _SCHEMA)
    faults = top.faults
    name = top.text("name") or path.stem
    vehicle = _read_vehicle(top, path.parent)
    body = read_body_options(top.table("body") or Table({}, "body", faults))
    ride = read_ride(top.table("ride") or Table({}, "ride", faults), path.parent)
    model = None if vehicle is None else derived(body, vehicle, top)
    if model is not None and ride is not None:
        _check_positions(model, ride, top)
    draft = _draft(path.parent, model, ride, top)
    settings = _read_sections(top, draft, readers or {})
    top.finish()
    faults.raise_if_any()
    if vehicle is None or ride is None:  # not without a fault
        raise InputError(f"{path}: nothing to study")
    study = Study(name, path, vehicle, body, ride, draft.parameters, settings)
    study.__dict__["_model"] = model
    return study


def _read_vehicle(top: Table, folder: Path) -> Vehicle | None:
    """The vehicle, by its name or its file beside the study's; None with the faults noted."""
    top.missing("vehicle", 'vehicle = "cati2024", or another shipped one or a file')
    text = top.text("vehicle")
    if text is None:
        return None
    try:
        beside = folder / text
        return load_vehicle(text if text in shipped_vehicles() or not there(beside) else beside)
    except InputError as error:
        top.faults.include("vehicle", error)
        return None


def _check_positions(model: VehicleModel, ride: RideCases, top: Table) -> None:
    """Note points that are not on the car body."""
    for place, x in enumerate(ride.positions, start=1):
        try:
            model.floor(x, ride.floor, derivative=0)
        except InputError as error:
            top.faults.include(f"ride.positions[{place}]", error)


def _draft(folder: Path, model: VehicleModel | None, ride: RideCases | None, top: Table) -> Draft:
    """What is known so far, the parameters read."""
    tables = top.table("parameters") or Table({}, "parameters", top.faults)
    each = {key: Table(content, tables.key(key), top.faults)
            for key, content in tables.content.items()}  # fmt: skip
    names = None if model is None else Names(model)
    found = () if names is None else read_parameters(each, names)
    return Draft(folder, model, names, ride, found)


def _read_sections(
    top: Table, draft: Draft, readers: Mapping[str, SectionReader]
) -> dict[str, Any]:
    """What the readers make of their sections."""
    settings = {}
    for name in SECTIONS:
        table = top.table(name) or Table({}, name, top.faults)
        if name in readers:
            settings[name] = readers[name](table, draft)
    return settings
