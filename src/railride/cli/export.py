"""``railride export``: the model in another tool's form."""

from __future__ import annotations

from typing import Annotated

import typer

from railride.cli import options, output
from railride.cli.options import Arguments
from railride.cli.progress import working
from railride.cli.vehicle import VehicleChoice, takes_vehicle
from railride.exports.targets import TARGETS

EXPORT = "The export"


@output.exits_cleanly
@takes_vehicle
def export(
    choice: VehicleChoice,
    target: Annotated[
        str | None,
        typer.Option(
            "--to",
            metavar="|".join(TARGETS),
            rich_help_panel=EXPORT,
            help="; ".join(f"{name}: {target.what}" for name, target in TARGETS.items()) + ".",
        ),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X",
            rich_help_panel=EXPORT,
            help="Point of the floor whose acceleration is an output, m forward of the middle; may "
            "be repeated. Default 0.",
        ),
    ] = None,
    signal: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            rich_help_panel=EXPORT,
            help="An output by name; may be repeated. Default the floor's acceleration at every "
            "--at and all others that do not feel the elevation's second rate.",
        ),
    ] = None,
    floor: options.FloorOption = "smooth",
    to: options.OutputOption = None,
) -> None:
    """Write the linear model in another tool's form.

    Example:  railride export --to matlab --segments 8 --output coach.mat
    """
    given = Arguments()
    if target is None:
        given.faults.add("--to", "nothing", f"one of {', '.join(TARGETS)}", "name the form")
    else:
        given.choice("--to", target, tuple(TARGETS))
    if to is None and target in TARGETS and not TARGETS[target].text:
        given.faults.add("--output", f"nothing, for --to {target}", "the name of a file",
                         "it is no text that a terminal shows")  # fmt: skip
    if at and signal:
        given.conflict("--at", "--signal")
    given.choice("--floor", floor, options.FLOORS)
    places = [given.number("--at", text, "m") for text in at or ("0",)]
    given.writes({"--output": to}, {"--vehicle": choice.vehicle})
    with working("exporting"):
        model = choice.model(given)
        from railride.exports.content import content_of
        from railride.exports.write import export_content

        content = content_of(model, signal, places, floor)
        written = export_content(content, str(target))
    output.deliver(written, to, [*model.vehicle.remarks, *model.remarks])
