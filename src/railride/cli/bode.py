"""``railride bode``: frequency responses from the track, a wheelset or an actuator."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output, responses
from railride.cli.options import FORMATS, Arguments
from railride.cli.progress import working
from railride.cli.vehicle import MOST_SEGMENTS, VehicleChoice, takes_vehicle

if TYPE_CHECKING:
    from railride.bodes import BodeResponse

RESPONSE = "The response"
BAND = {"--from": "0.2", "--to": "40", "--points": "2000"}
MOST_POINTS = 1_000_000
TRACK, FLOOR = "track", "floor_acceleration"

SpeedOption = Annotated[
    list[str] | None, typer.Option("--speed", metavar="KMH", rich_help_panel=RESPONSE,
                                   help="Speed in km/h; may be repeated. Default 200.")
]  # fmt: skip
AtOption = Annotated[
    list[str] | None, typer.Option("--at", metavar="X", rich_help_panel=RESPONSE,
                                   help="Point of the floor, m forward of the middle; may be "
                                   "repeated.")]  # fmt: skip
SourceOption = Annotated[
    list[str] | None, typer.Option("--source", metavar="NAME", rich_help_panel=RESPONSE,
                                   help="What moves: track (default; all wheelsets, with exact "
                                   "delays), one wheelset w_1 …, or an actuator f_1 …; may be "
                                   "repeated.")]  # fmt: skip
SignalOption = Annotated[
    list[str] | None, typer.Option("--signal", metavar="NAME", rich_help_panel=RESPONSE,
                                   help="What responds: floor_acceleration (default), "
                                   "secondary_1_deflection or another output, which a wrong name "
                                   "lists; may be repeated.")]  # fmt: skip
CompareOption = Annotated[
    str | None, typer.Option("--compare-segments", metavar='"N,N,…"', rich_help_panel=RESPONSE,
                             help="Several numbers of segments, side by side.")]  # fmt: skip
FrequenciesOption = Annotated[
    str | None, typer.Option("--frequencies", metavar='"HZ,HZ,…"', rich_help_panel=RESPONSE,
                             help="Frequencies in Hz, ascending, with commas between them.")
]  # fmt: skip
FromOption = Annotated[
    str | None, typer.Option("--from", metavar="HZ", rich_help_panel=RESPONSE,
                             help="Or the lowest frequency; default 0.2.")]  # fmt: skip
ToOption = Annotated[
    str | None, typer.Option("--to", metavar="HZ", rich_help_panel=RESPONSE,
                             help="The highest; default 40.")]  # fmt: skip
PointsOption = Annotated[
    str | None, typer.Option("--points", metavar="N", rich_help_panel=RESPONSE,
                             help="How many in between, evenly over the logarithm; default "
                             "2000.")]  # fmt: skip
PlotOption = Annotated[
    str | None, typer.Option("--plot", metavar="FILE", rich_help_panel=options.RESULT,
                             help="Draw magnitude and phase into this PNG, PDF or SVG file.")
]  # fmt: skip


@output.exits_cleanly
@takes_vehicle
def bode(
    choice: VehicleChoice,
    speed: SpeedOption = None,
    at: AtOption = None,
    source: SourceOption = None,
    signal: SignalOption = None,
    compare: CompareOption = None,
    frequencies: FrequenciesOption = None,
    lowest: FromOption = None,
    highest: ToOption = None,
    points: PointsOption = None,
    plot: PlotOption = None,
    floor: options.FloorOption = "smooth",
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Frequency response of the floor's acceleration to the track, wheelsets with exact delays.

    Example:  railride bode --speed 145 --speed 200 --plot bode.png

    From an actuator:  railride bode --source f_1 --signal secondary_1_deflection
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.choice("--floor", floor, options.FLOORS)
    speeds = [given.positive("--speed", text, "km/h") for text in speed or ("200",)]
    places = [given.number("--at", text, "m") for text in at or ("0",)]
    f = _frequencies(given, frequencies, {"--from": lowest, "--to": highest, "--points": points})
    choices = _compared(given, choice, compare)
    given.writes({"--output": to, "--plot": plot}, {"--vehicle": choice.vehicle})
    found: list[tuple[int | None, BodeResponse]] = []
    remarks: list[str] = []
    with working("responding"):
        for one in choices:
            model = one.model(given)
            from railride import bodes

            some = bodes.bode(model, speeds, f, at=places, floor=floor, source=source or TRACK,
                              outputs=signal or FLOOR)  # fmt: skip
            found += [(model.body.segments, response) for response in some]
            remarks += [*model.vehicle.remarks, *model.remarks]
        if plot is not None:
            from railride import plots

            plots.save(plots.plot_bode([response for _, response in found]), plot)
    remarks = [*dict.fromkeys(remarks), *_idle(found, {"--speed": speed, "--at": at})]
    asked = {"segments": compare, "source": source, "output": signal, "unit": source or signal}
    rows = [] if form == "table" else responses.rows(found, [k for k, v in asked.items() if v])
    text = output.result(form, {"response": rows}, rows, lambda: responses.table(found), remarks)
    output.deliver(text, to, remarks, plot)


def _compared(given: Arguments, choice: VehicleChoice, compare: str | None) -> list[VehicleChoice]:
    """The vehicle, or one for each number of segments; faults are noted."""
    if compare is None:
        return [choice]
    for option in ("--segments", "--body"):
        if option in choice.given():
            given.conflict("--compare-segments", option)
    numbers = [text.strip() for text in compare.split(",")]
    whole = [given.whole("--compare-segments", text, 1, MOST_SEGMENTS) for text in numbers]
    if len(set(whole)) < len(whole) and None not in whole:
        given.faults.add("--compare-segments", repr(compare), "each number once")
    return [replace(choice, segments=text) for text in numbers]


def _idle(
    found: Sequence[tuple[int | None, BodeResponse]], given: dict[str, list[str] | None]
) -> list[str]:
    """Remarks on options that change nothing."""
    remarks = []
    if given["--speed"] and all(r.speed is None for _, r in found):
        remarks.append("--speed changes nothing: a single wheelset or actuator stays in its place")
    if given["--at"] and all(r.position is None for _, r in found):
        remarks.append("--at changes nothing: no signal of the floor is asked for")
    return remarks


def _frequencies(given: Arguments, listed: str | None, band: dict[str, str | None]) -> Any:
    """Frequencies in Hz as an array: those listed, or a band; faults are noted."""
    if listed is not None:
        for option in (option for option, text in band.items() if text is not None):
            given.conflict("--frequencies", option)
        values = [given.positive("--frequencies", part, "Hz") for part in listed.split(",")]
        for k in range(1, len(values)):
            if None not in values[k - 1 : k + 1] and values[k] <= values[k - 1]:
                given.faults.add("--frequencies", f"{values[k]:g} Hz after {values[k - 1]:g} Hz",
                                 "them in ascending order, each once")  # fmt: skip
        return values
    low, high, count = given.range_of(band, BAND, "Hz", MOST_POINTS)
    if given.faults.found:
        return None
    import numpy as np

    return np.geomspace(low, high, count)
