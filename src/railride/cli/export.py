"""``railride export``: the model in another tool's form."""

from __future__ import annotations

from typing import Annotated

import typer

from railride.cli import options, output
from railride.cli.grouped import grouped
from railride.cli.options import Arguments
from railride.cli.progress import working
from railride.cli.reading import FileReading, chosen_track
from railride.cli.vehicle import VehicleChoice
from railride.exports.targets import TARGETS

EXPORT = "The export"


@output.exits_cleanly
@grouped(reading=FileReading, choice=VehicleChoice)
def export(
    choice: VehicleChoice,
    reading: FileReading,
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
            help="An output by name, floor_acceleration for that at every --at; may be repeated. "
            "Default this and all others that do not feel the elevation's second rate.",
        ),
    ] = None,
    track: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            rich_help_panel=options.TRACK,
            help="With --to modelica: the ride over this track as well, a spectrum by name or the "
            "file of one or of a measured track, with the weighting Wk.",
        ),
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option(
            metavar="KMH", rich_help_panel=options.TRACK, help="Of the ride, km/h. Default 145."
        ),
    ] = None,
    length: Annotated[
        str | None,
        typer.Option(
            metavar="M",
            rich_help_panel=options.TRACK,
            help="The rated section; the run-in comes before it. Default 1000.",
        ),
    ] = None,
    seed: Annotated[
        str | None,
        typer.Option(
            metavar="INT", rich_help_panel=options.TRACK, help="Of the synthetic track. Default 1."
        ),
    ] = None,
    extrapolate: options.ExtrapolateOption = False,
    floor: options.FloorOption = "smooth",
    to: options.OutputOption = None,
) -> None:
    """Write the linear model in another tool's form.

    Example:  railride export --to modelica --segments 4 --output coach.mo

    With the ride over a track:  railride export --to modelica --track erri_low --output ride.mo
    """
    given = Arguments()
    if target is None:
        given.faults.add("--to", "nothing", f"one of {', '.join(TARGETS)}", "name the form")
    else:
        given.choice("--to", target, tuple(TARGETS))
    if to is None and target in TARGETS and not TARGETS[target].text:
        given.faults.add("--output", f"nothing, for --to {target}", "the name of a file",
                         "it is no text that a terminal shows")  # fmt: skip
    given.choice("--floor", floor, options.FLOORS)
    places = [given.number("--at", text, "m") for text in at or ("0",)]
    _check_ride(given, target, track, {"--speed": speed, "--length": length, "--seed": seed,
                                       "--extrapolate": extrapolate or None}, reading)  # fmt: skip
    ride = {
        "speed": given.positive("--speed", speed, "km/h"),
        "length": given.positive("--length", length, "m"),
        "seed": given.whole("--seed", seed, 0, options.LARGEST_SEED),
    }
    given.writes({"--output": to}, {"--vehicle": choice.vehicle, "--track": track})
    how = {} if track is None else reading.of(given, track)
    with working("exporting"):
        model = choice.model(given)
        source = None if track is None else chosen_track(track, extrapolate, how)
        from railride.exports.write import exported

        written, remarks = exported(model, str(target), signal, places, floor, source, **ride)
    output.deliver(written, to, list(remarks))


def _check_ride(
    given: Arguments, target: str | None, track: str | None, ride: dict[str, object],
    reading: FileReading,
) -> None:  # fmt: skip
    """Note options of a ride without one, and a ride in a form that holds none."""
    if track is not None and target in TARGETS and target != "modelica":
        given.conflict("--track", f"--to {target}", "only --to modelica holds a track")
    if track is None:
        asked = [option for option, value in ride.items() if value is not None]
        asked += reading.options() + ["--step"] * (reading.step is not None)
        for option in asked[:1]:
            given.conflict(option, "no --track", "name the track, such as --track erri_low")
