"""What a car body's natural modes are computed from or read from: finite elements, or files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from railride.errors import Faults
from railride.quantities import LIST, checked_numbers, si
from railride.toml_tables import shown

MATRICES = ("mass_matrix", "stiffness_matrix", "coordinates")


@dataclass(frozen=True)
class Elements:
    """How a car body is cut into finite elements.

    number: at least so many; None: 128, or 6 for each mode. interfaces: m forward of the middle, at
    least two places where forces act or the floor is read, for a Craig–Bampton reduction to them;
    none: the natural modes of the elements themselves.

    Raises InputError for values that cannot be.
    """

    number: int | None = None
    interfaces: tuple[float, ...] = field(default=(), metadata=si("m", many=LIST))

    def __post_init__(self) -> None:
        faults = Faults("elements")
        checked_numbers(self, faults)
        faults.raise_if_any()


@dataclass(frozen=True)
class ModeFiles:
    """The files of a car body from outside; paths as texts.

    file: a table of natural modes (:mod:`railride.bodies.modes_file`); or matrices: an .npz file;
    or mass_matrix, stiffness_matrix and coordinates: a pair of .mtx files and a table
    (:mod:`railride.bodies.matrix_files`).
    mass_unit: of the matrices, default kg. length_unit: of x in an .npz file, default m.

    Raises InputError, with all faults at once, unless it is one of the three.

    >>> ModeFiles(matrices="coach.npz", mass_unit="t").paths
    {'matrices': 'coach.npz'}
    """

    file: str | None = None
    matrices: str | None = None
    mass_matrix: str | None = None
    stiffness_matrix: str | None = None
    coordinates: str | None = None
    mass_unit: str | None = None
    length_unit: str | None = None

    def __post_init__(self) -> None:
        faults = Faults("modes from outside")
        check_mode_files(vars(self), "", faults)
        faults.raise_if_any()

    @property
    def paths(self) -> dict[str, str]:
        """The files that are given, by the names of the fields."""
        return {name: value for name, value in vars(self).items()
                if value is not None and not name.endswith("_unit")}  # fmt: skip


def check_mode_files(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note files that do not belong together, and units of what has its own."""
    given = [item.name for item in fields(ModeFiles) if values.get(item.name) is not None]
    for name in given:
        if not isinstance(values[name], str) or not values[name].strip():
            faults.add(f"{prefix}{name}", shown(values[name]), "a text")
    files = [name for name in given if not name.endswith("_unit")]
    if files not in (["file"], ["matrices"], list(MATRICES)):
        faults.add(f"{prefix}file", f"{' and '.join(files) or 'no file'}",
                   f"file, or matrices, or {', '.join(MATRICES[:2])} and {MATRICES[2]}",
                   "a body comes from one source")  # fmt: skip
    for name, own in (("mass_unit", ("matrices", *MATRICES)), ("length_unit", ("matrices",))):
        if name in given and not set(files) & set(own):
            faults.add(f"{prefix}{name}", f"{values[name]!r} without {own[0]}", "no such unit",
                       "a table states its units in its headings")  # fmt: skip
