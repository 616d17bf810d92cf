"""``railride map``: comfort along the car and over speed, exact."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.grouped import grouped
from railride.cli.options import FORMATS, Arguments
from railride.cli.progress import working
from railride.cli.reading import FileReading, chosen_track
from railride.cli.vehicle import VehicleChoice

if TYPE_CHECKING:
    import pandas as pd

MAP = "The map"
SPEEDS = {"--from": "10", "--to": "400", "--points": "196"}  # every 2 km/h: peaks are narrow
MOST_SPEEDS = 10_000
ABREAST, DOWN = 7, 40  # points of the floor and speeds that a table has room for
COLUMNS = {"speed_kmh": "speed [km/h]", "position_m": "position [m]", "a_rms": "a_rms [m/s^2]",
           "a_wrms": "a_wrms [m/s^2]", "wz": "Wz", "error": "error"}  # fmt: skip


@output.exits_cleanly
@grouped(reading=FileReading, choice=VehicleChoice)
def comfort_map(
    choice: VehicleChoice,
    reading: FileReading,
    speed: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KMH",
            rich_help_panel=MAP,
            help="Speed in km/h; may be repeated. Up to eight are drawn as curves along the car.",
        ),
    ] = None,
    lowest: Annotated[
        str | None,
        typer.Option("--from", metavar="KMH", rich_help_panel=MAP,
                     help="Or the lowest speed; default 10."),
    ] = None,
    highest: Annotated[
        str | None,
        typer.Option("--to", metavar="KMH", rich_help_panel=MAP,
                     help="The highest; default 400."),
    ] = None,
    points: Annotated[
        str | None,
        typer.Option(metavar="N", rich_help_panel=MAP,
                     help="How many speeds, evenly; default 196."),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X",
            rich_help_panel=MAP,
            help="Point of the floor, m forward of the middle; may be repeated. Default 49 from "
            "end to end; up to eight are drawn as curves over speed.",
        ),
    ] = None,
    track: options.TrackOption = "erri_low",
    weighting: Annotated[
        str, typer.Option(metavar="NAME", rich_help_panel=MAP, help="Frequency weighting.")
    ] = "Wk",
    extrapolate: options.ExtrapolateOption = False,
    plot: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            rich_help_panel=options.RESULT,
            help="Draw map or curves into this PNG, PDF or SVG file.",
        ),
    ] = None,
    floor: options.FloorOption = "smooth",
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:  # fmt: skip
    """Weighted r.m.s. along the car and over speed: exact values from the track's spectrum.

    Example:  railride map --from 40 --to 300 --points 66 --plot map.png
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.choice("--floor", floor, options.FLOORS)
    speeds = _speeds(given, speed, {"--from": lowest, "--to": highest, "--points": points})
    places = [given.number("--at", text, "m") for text in at] if at else None
    given.writes({"--output": to, "--plot": plot}, {"--vehicle": choice.vehicle, "--track": track})
    how = reading.of(given, track)
    with working("mapping") as advance:
        model = choice.model(given)
        from railride import stochastic

        found = stochastic.comfort_map(
            model, chosen_track(track, extrapolate, how), speeds, places, floor=floor,
            weight=weighting, progress=advance,
        )  # fmt: skip
        if plot is not None:
            from railride import plots

            plots.save(plots.plot_comfort(found), plot)
    remarks = [*model.vehicle.remarks, *model.remarks, *found.attrs["remarks"]]
    rows = found[list(COLUMNS.values())].set_axis(list(COLUMNS), axis=1).to_dict("records")
    title = f"{found.attrs['of']}, {found.attrs['weighting']} weighted"
    text = output.result(form, {"track": found.attrs["track"], "map": rows}, rows,
                         lambda: _table(found, title), remarks)  # fmt: skip
    output.deliver(text, to, remarks, plot)


def _speeds(given: Arguments, listed: list[str] | None, band: dict[str, str | None]) -> list[float]:
    """Speeds in m/s: those listed, or evenly over a range; faults are noted."""
    if listed:
        for option in (option for option, text in band.items() if text is not None):
            given.conflict("--speed", option)
        return [given.positive("--speed", text, "km/h") for text in listed]
    low, high, count = given.range_of(band, SPEEDS, "km/h", MOST_SPEEDS)
    if given.faults.found:
        return []
    import numpy as np

    return [float(v) for v in np.linspace(low, high, count)]


def _table(found: pd.DataFrame, title: str) -> str:
    """The weighted r.m.s.: a row per speed, a column per point, the ends included; not too many."""
    import numpy as np

    grid = found.pivot_table(index=COLUMNS["speed_kmh"], columns=COLUMNS["position_m"],
                             values=COLUMNS["a_wrms"])  # fmt: skip
    across = np.unique(np.linspace(0, grid.shape[1] - 1, ABREAST).round().astype(int))
    shown = grid.iloc[:: -(-grid.shape[0] // DOWN), across]
    columns = [("speed\n[km/h]", ".6g"), *((f"{x:.4g} m", ".4f") for x in shown.columns)]
    rows: list[Any] = [(v, *values) for v, values in zip(shown.index, shown.to_numpy(),
                                                         strict=True)]  # fmt: skip
    more = f" ({shown.size} of {grid.size} values: JSON, CSV and picture have all)"
    more = more if shown.size < grid.size else ""
    return output.table_text(f"{title}\na_wrms [m/s²]{more}", columns, rows)
