"""``railride bode``: the frequency response from the track to the floor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import FORMATS, Arguments, kmh
from railride.cli.progress import working
from railride.cli.vehicle import VehicleChoice, takes_vehicle

if TYPE_CHECKING:
    from railride.bodes import BodeResponse

RESPONSE = "The response"
BAND = {"--from": "0.2", "--to": "40", "--points": "2000"}
MOST_POINTS = 1_000_000
LISTED = 40  # frequencies: more are summed up in the table by their peaks and dips
PROMINENT = 1.5  # how far a peak stands out from what surrounds it, as a ratio


@output.exits_cleanly
@takes_vehicle
def bode(
    choice: VehicleChoice,
    speed: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KMH",
            rich_help_panel=RESPONSE,
            help="Speed in km/h; may be repeated. Default 200.",
        ),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X",
            rich_help_panel=RESPONSE,
            help="Point of the floor, m forward of the middle; may be repeated.",
        ),
    ] = None,
    frequencies: Annotated[
        str | None,
        typer.Option(
            metavar='"HZ,HZ,…"',
            rich_help_panel=RESPONSE,
            help="Frequencies in Hz, ascending, with commas between them.",
        ),
    ] = None,
    lowest: Annotated[
        str | None,
        typer.Option(
            "--from",
            metavar="HZ",
            rich_help_panel=RESPONSE,
            help="Or the lowest frequency; default 0.2.",
        ),
    ] = None,
    highest: Annotated[
        str | None,
        typer.Option(
            "--to", metavar="HZ", rich_help_panel=RESPONSE, help="The highest; default 40."
        ),
    ] = None,
    points: Annotated[
        str | None,
        typer.Option(
            metavar="N",
            rich_help_panel=RESPONSE,
            help="How many in between, evenly over the logarithm; default 2000.",
        ),
    ] = None,
    plot: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            rich_help_panel=options.RESULT,
            help="Draw magnitude and phase into this PNG, PDF or SVG file.",
        ),
    ] = None,
    floor: options.FloorOption = "smooth",
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Frequency response of the floor's acceleration to the track, wheelsets with exact delays.

    Example:  railride bode --speed 145 --speed 200 --plot bode.png
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.choice("--floor", floor, ("smooth", "polygon"))
    speeds = [given.positive("--speed", text, "km/h") for text in speed or ("200",)]
    places = [given.number("--at", text, "m") for text in at or ("0",)]
    f = _frequencies(given, frequencies, {"--from": lowest, "--to": highest, "--points": points})
    output.check_output(given.faults, "--output", to)
    output.check_output(given.faults, "--plot", plot)
    output.check_picture(given.faults, "--plot", plot)
    given.separate({"--output": to, "--plot": plot}, {"--vehicle": choice.vehicle})
    with working("responding"):
        model = choice.model(given)
        from railride import bodes

        found = bodes.bode(model, speeds, f, at=places, floor=floor)
        if plot is not None:
            from railride import plots

            plots.save(plots.plot_bode(found), plot)
    remarks = [*model.vehicle.remarks, *model.remarks]
    rows = [] if form == "table" else _rows(found)
    text = output.result(form, {"response": rows}, rows, lambda: _table(found), remarks)
    output.write(text, to)
    output.remark(remarks)
    if plot is not None:
        typer.echo(f"drawn: {plot}", err=True)


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


def _rows(found: Sequence[BodeResponse]) -> list[dict[str, Any]]:
    return [
        {
            "speed_kmh": kmh(r.speed),
            "position_m": r.position,
            "frequency_hz": f,
            "magnitude": magnitude,
            "phase_deg": phase,
        }
        for r in found
        for f, magnitude, phase in zip(
            r.frequency.tolist(), r.magnitude.tolist(), r.phase_deg.tolist(), strict=True
        )
    ]


def _table(found: Sequence[BodeResponse]) -> str:
    """Every frequency if they are few, else the peaks and dips; the geometric zeros below."""
    first = found[0]
    f = first.frequency
    listed = f.size <= LISTED
    title = (f"{first.vehicle} ({first.body}), {first.floor} floor: floor acceleration per track "
             "elevation under the leading wheelset")  # fmt: skip
    if not listed:
        title += f"\nPeaks and dips among {f.size} frequencies, {f[0]:.6g} to {f[-1]:.6g} Hz"
    columns = [
        ("speed\n[km/h]", ".6g"), ("at\n[m]", ".6g"), ("frequency\n[Hz]", ".6g"),
        ("|H|\n[(m/s²)/m]", ".5g"), ("phase\n[°]", ".1f"),
    ]  # fmt: skip
    rows: list[tuple[Any, ...]] = []
    for r in found:
        kinds = dict.fromkeys(range(f.size), "") if listed else _extremes(r.magnitude)
        rows += [
            (kmh(r.speed), r.position, f[k], r.magnitude[k], r.phase_deg[k], kind)
            for k, kind in sorted(kinds.items())
        ]
    columns, rows = (columns, [row[:-1] for row in rows]) if listed else (
        [*columns, ("", "")], rows)  # fmt: skip
    return output.table_text(title, columns, rows) + _zeros(found)


def _extremes(magnitude: Any) -> dict[int, str]:
    """Places of the maxima and minima that stand out in the logarithm, and the ends."""
    import numpy as np
    from scipy.signal import find_peaks

    level = np.log(np.maximum(magnitude, np.finfo(float).tiny))
    found = {0: "", magnitude.size - 1: ""}
    for sign, kind in ((1, "peak"), (-1, "dip")):
        places, _ = find_peaks(sign * level, prominence=np.log(PROMINENT))
        found |= dict.fromkeys(places.tolist(), kind)
    return found


def _zeros(found: Sequence[BodeResponse]) -> str:
    """The geometric zeros, in words; nothing if there are none."""
    lines = []
    for r in found:
        for zeros in r.zeros:
            some = ", ".join(f"{f:.4g}" for f in zeros.frequency[:8])
            more = ", …" if zeros.frequency.size > 8 else ""
            lines.append(f"  {kmh(r.speed):g} km/h, {r.position:g} m, {zeros.cause} "
                         f"{zeros.distance:g} m: {some}{more} Hz")  # fmt: skip
    return "\nZeros at (k + ½)·V/distance:\n" + "\n".join(lines) + "\n" if lines else ""
