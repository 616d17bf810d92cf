"""The options of the vehicle and its body, which several commands share as one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from railride.cli.grouped import grouped
from railride.cli.options import BODY, Arguments
from railride.errors import InputError

if TYPE_CHECKING:
    from railride.parameters import Vehicle
    from railride.vehicle import VehicleModel

BODIES = ("rigid", "segments", "beam", "fe")
MODAL = ("beam", "fe")  # those that are made of modes
DEFAULT = "cati2024"
MOST_SEGMENTS = 1000  # derived in minutes; more is a slip of the keys
MOST_MODES = 100  # likewise

VehicleOption = Annotated[
    str, typer.Option("--vehicle", metavar="NAME|FILE", rich_help_panel=BODY,
                      help="A shipped vehicle or a TOML parameter file.")]  # fmt: skip
SegmentsOption = Annotated[
    str | None, typer.Option("--segments", metavar="N", rich_help_panel=BODY,
                             help="Rigid segments of the car body; default 4, or 1 where no "
                             "bending is known.")]  # fmt: skip
BodyOption = Annotated[
    str | None, typer.Option("--body", metavar="|".join(BODIES), rich_help_panel=BODY,
                             help="The kind of car body; default segments, or fe of "
                             "a vehicle with modes from outside.")]  # fmt: skip
ModesOption = Annotated[
    str | None, typer.Option("--modes", metavar="N", rich_help_panel=BODY,
                             help="Bending modes of a beam or finite elements; "
                             "default 10.")]  # fmt: skip
FrequencyOption = Annotated[
    str | None, typer.Option("--bending-frequency", metavar="HZ", rich_help_panel=BODY,
                             help="Calibrate the body to this free-free first bending "
                             "frequency.")]  # fmt: skip
StiffnessOption = Annotated[
    str | None, typer.Option("--joint-stiffness", metavar="VALUE", rich_help_panel=BODY,
                             help="Joint stiffness in N m/rad, or as '3.7e5 kN*m/rad'.")
]  # fmt: skip
DampingOption = Annotated[
    str | None, typer.Option("--bending-damping", metavar="ZETA", rich_help_panel=BODY,
                             help="Structural damping ratio of the first bending mode; "
                             "default the vehicle's.")]  # fmt: skip


@dataclass(frozen=True)
class VehicleChoice:
    """Texts of the options that say which vehicle is meant, and how its body is made."""

    vehicle: VehicleOption = DEFAULT
    segments: SegmentsOption = None
    body: BodyOption = None
    modes: ModesOption = None
    bending_frequency: FrequencyOption = None
    joint_stiffness: StiffnessOption = None
    bending_damping: DampingOption = None

    def given(self) -> list[str]:
        """Names of the options that are not left at their defaults."""
        return [f"--{name.replace('_', '-')}" for name, value in vars(self).items()
                if value != getattr(type(self), name)]  # fmt: skip

    def model(self, given: Arguments) -> VehicleModel:
        """The model that the options describe.

        Raises
        ------
        InputError : faults of the options together with any noted in ``given``; of the file.
        """
        N = given.whole("--segments", self.segments, 1, MOST_SEGMENTS)
        frequency = given.positive("--bending-frequency", self.bending_frequency, "Hz")
        stiffness = given.positive("--joint-stiffness", self.joint_stiffness, "N m/rad")
        damping = given.number("--bending-damping", self.bending_damping, "")
        if self.body is not None:
            given.choice("--body", self.body, BODIES)
        self._check_kind(given)
        modes = given.whole("--modes", self.modes, 1, MOST_MODES)
        if self.body == "rigid" and N is not None and N > 1:
            given.faults.add("--body rigid", f"--segments {N} with it", "one segment",
                             "leave one of the two out")  # fmt: skip
        if damping is not None and not 0 <= damping < 1:
            given.faults.add("--bending-damping", repr(self.bending_damping), "a ratio of at "
                             "least 0 and below 1", 'such as 0.015 or "1.5 %"')  # fmt: skip
        if self.bending_frequency is not None and self.joint_stiffness is not None:
            given.conflict("--bending-frequency", "--joint-stiffness",
                           "leave one of the two out: it follows from the other")  # fmt: skip
        given.check()
        from railride.parameters import load_vehicle

        found = load_vehicle(self.vehicle)
        if frequency is None and stiffness is None:
            _refuse_unknown_bending(found, N, self.body)
        from railride.vehicle import derive_vehicle

        return derive_vehicle(found, N, body=self.body, modes=modes, bending_frequency=frequency,
                              joint_stiffness=stiffness, bending_damping=damping)  # fmt: skip

    def _check_kind(self, given: Arguments) -> None:
        """Note options that do not belong to the kind of body."""
        if self.body in MODAL:
            kind = f"--body {self.body}"
            if self.segments is not None:
                given.conflict("--segments", kind, "--modes says how fine it is")
            if self.joint_stiffness is not None:
                given.conflict("--joint-stiffness", kind, "give --bending-frequency")
        elif self.modes is not None:
            given.faults.add("--modes", f"--body {self.body} with it" if self.body else "no --body "
                             "with it", "a body that is made of modes",
                             "such as --body beam")  # fmt: skip


takes_vehicle = grouped(choice=VehicleChoice)
"""A command whose argument ``choice`` is made of the vehicle's options."""


def _refuse_unknown_bending(found: Vehicle, N: int | None, body: str | None) -> None:
    """Several segments need a stiffness between them."""
    if found.body.bends or (body in (None, "fe") and found.body.mode_files is not None):
        return
    if (N or 1) > 1 or (N is None and body not in (None, "rigid")):
        asked = f"--segments {N}" if N else f"--body {body}"
        give = "--bending-frequency" + ("" if body in MODAL else " or --joint-stiffness")
        raise InputError(f"vehicle {found.name}: found {asked} for a car body whose bending is not "
                         f"known; expected its stiffness (give {give}, or take one segment: the "
                         "rigid body)")  # fmt: skip
