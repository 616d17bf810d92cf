"""Options that several commands share, and their values with units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.errors import Faults, InputError

if TYPE_CHECKING:
    from railride.vehicle import VehicleModel

BODIES = ("rigid", "segments")

BODY, RESULT = "The vehicle and its body", "The result"

VehicleOption = Annotated[
    str, typer.Option("--vehicle", metavar="NAME|FILE", rich_help_panel=BODY,
                      help="A shipped vehicle or a TOML parameter file.")]  # fmt: skip
SegmentsOption = Annotated[
    str | None, typer.Option("--segments", metavar="N", rich_help_panel=BODY,
                             help="Rigid segments of the car body; default 4, or 1 where no "
                             "bending is known.")]  # fmt: skip
BodyOption = Annotated[
    str | None, typer.Option("--body", metavar="|".join(BODIES), rich_help_panel=BODY,
                             help="The kind of car body.")]  # fmt: skip
FrequencyOption = Annotated[
    str | None, typer.Option("--bending-frequency", metavar="HZ", rich_help_panel=BODY,
                             help="Calibrate the joints to this free-free first bending "
                             "frequency.")]  # fmt: skip
StiffnessOption = Annotated[
    str | None, typer.Option("--joint-stiffness", metavar="VALUE", rich_help_panel=BODY,
                             help='Joint stiffness in N m/rad, or as "3.7e5 kN*m/rad".')]  # fmt: skip
DampingOption = Annotated[
    str | None, typer.Option("--bending-damping", metavar="ZETA", rich_help_panel=BODY,
                             help="Structural damping ratio of the first bending mode; "
                             "default the vehicle's.")]  # fmt: skip
FloorOption = Annotated[
    str, typer.Option("--floor", metavar="smooth|polygon", rich_help_panel=BODY,
                      help="Where the floor is: on the smooth line through the segments, or on "
                      "their polygon, as in the paper.")]  # fmt: skip
FormatOption = Annotated[
    str, typer.Option("--format", metavar="table|json|csv", rich_help_panel=RESULT,
                      help="How the result is written.")]  # fmt: skip
OutputOption = Annotated[
    str | None, typer.Option("--output", metavar="FILE", rich_help_panel=RESULT,
                             help="Write the result to this file instead.")]  # fmt: skip


class Arguments:
    """Turns texts of options into values; all that is wrong is raised together, once.

    >>> given = Arguments()
    >>> given.number("--speed", "145 km/h", "km/h") * 3.6
    145.0
    """

    def __init__(self) -> None:
        self.faults = Faults("command line")

    def number(self, option: str, text: str | None, unit: str) -> Any:
        """SI value of a number in ``unit`` or with a unit of its own; None stays None."""
        from railride.units import QuantityError, parse_number_or_quantity

        if text is None:
            return None
        try:
            return parse_number_or_quantity(text, unit)
        except QuantityError as error:
            self.faults.add(option, error.found, error.expected, error.mend)
            return None

    def numbers(self, option: str, texts: Sequence[str], unit: str) -> list[float]:
        """SI values of an option that may be repeated."""
        return [x for x in (self.number(option, text, unit) for text in texts) if x is not None]

    def whole(self, option: str, text: str | None, least: int = 0) -> Any:
        """A whole number of at least ``least``; None stays None."""
        if text is None:
            return None
        try:
            value = int(text)
        except ValueError:
            value = least - 1
        if value < least:
            self.faults.add(option, repr(text), f"a whole number of at least {least}")
            return None
        return value

    def choice(self, option: str, text: str, choices: Sequence[str]) -> str:
        """One of ``choices``."""
        if text not in choices:
            self.faults.add(option, repr(text), f"one of {', '.join(choices)}")
        return text

    def check(self) -> None:
        """Raise what was wrong, if anything."""
        self.faults.raise_if_any()


def build_model(
    given: Arguments, vehicle: str, segments: str | None, body: str | None,
    bending_frequency: str | None, joint_stiffness: str | None, bending_damping: str | None,
) -> VehicleModel:  # fmt: skip
    """The model that the body options describe.

    Raises
    ------
    InputError : faults of the options together with any noted in ``given``; of the vehicle's file.
    """
    N = given.whole("--segments", segments, least=1)
    frequency = given.number("--bending-frequency", bending_frequency, "Hz")
    stiffness = given.number("--joint-stiffness", joint_stiffness, "N m/rad")
    damping = given.number("--bending-damping", bending_damping, "")
    if body is not None:
        given.choice("--body", body, BODIES)
    if body == "rigid" and N is not None and N > 1:
        given.faults.add("--body rigid", f"--segments {N} with it", "one segment",
                         "leave one of the two out")  # fmt: skip
    for option, value in (("--bending-frequency", frequency), ("--joint-stiffness", stiffness)):
        if value is not None and value <= 0:
            given.faults.add(option, f"{value:g}", "a value above 0")
    if damping is not None and not 0 <= damping < 1:
        given.faults.add("--bending-damping", f"{damping:g}", "a ratio of at least 0 and below 1")
    if bending_frequency is not None and joint_stiffness is not None:
        given.faults.add("--bending-frequency", "--joint-stiffness with it", "one of the two",
                         "the other follows")  # fmt: skip
    given.check()
    from railride.parameters import load_vehicle
    from railride.vehicle import derive_vehicle

    found = load_vehicle(vehicle)
    if body == "rigid":
        N = 1
    model = derive_vehicle(found, N, bending_frequency=frequency, joint_stiffness=stiffness,
                           bending_damping=damping)  # fmt: skip
    if body == "segments" and model.body.kind == "rigid" and N is None:
        raise InputError(f"{found.name}: found no bending frequency, with --body segments; expected "
                         "one (give --bending-frequency or --joint-stiffness)")  # fmt: skip
    return model
