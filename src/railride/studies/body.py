"""How a study's car body is made: the table ``[body]``."""

from __future__ import annotations

from dataclasses import dataclass

from railride.errors import InputError
from railride.parameters import Vehicle
from railride.toml_tables import Table
from railride.vehicle import VehicleModel, derive_vehicle

MOST_SEGMENTS = 1000  # derived in minutes; more is a slip of the keys


@dataclass(frozen=True)
class BodyOptions:
    """Arguments of :func:`railride.derive_vehicle` besides the vehicle, SI; None is its default."""

    segments: int | None = None
    body: str | None = None
    modes: int | None = None
    bending_frequency: float | None = None
    joint_stiffness: float | None = None
    bending_damping: float | None = None

    def model(self, vehicle: Vehicle) -> VehicleModel:
        """The vehicle's model with such a body.

        Raises
        ------
        InputError : as :func:`railride.derive_vehicle`.
        """
        return derive_vehicle(vehicle, **vars(self))


def read_body_options(table: Table) -> BodyOptions:
    """The options of the table; its faults are noted."""
    segments = table.whole("segments")
    if segments is not None and not 1 <= segments <= MOST_SEGMENTS:
        table.fault("segments", str(segments), f"a whole number from 1 to {MOST_SEGMENTS}")
        segments = None
    found = BodyOptions(
        segments=segments,
        body=table.text("kind"),
        modes=table.whole("modes"),
        bending_frequency=table.quantity("bending_frequency", "Hz", "> 0"),
        joint_stiffness=table.quantity("joint_stiffness", "N m/rad", "> 0"),
        bending_damping=table.quantity("bending_damping", "", ">= 0"),
    )
    table.finish()
    return found


def derived(options: BodyOptions, vehicle: Vehicle, table: Table) -> VehicleModel | None:
    """The model; None, with the faults noted, where it cannot be."""
    try:
        return options.model(vehicle)
    except InputError as error:
        table.faults.include("body", error)
        return None
