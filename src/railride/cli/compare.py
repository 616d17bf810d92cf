"""``railride compare``: all car bodies side by side for one vehicle and track."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli import vehicle as bodies
from railride.cli.grouped import grouped
from railride.cli.options import FORMATS, Arguments, kmh
from railride.cli.progress import working
from railride.cli.reading import FileReading, chosen_track

if TYPE_CHECKING:
    from railride.comparison import ComparedBody, Comparison

COMPARED = "The bodies"


@output.exits_cleanly
@grouped(reading=FileReading)
def compare(
    reading: FileReading,
    segments: Annotated[
        list[str] | None,
        typer.Option(metavar="N", rich_help_panel=COMPARED,
                     help="Rigid segments; may be repeated. Default 1, 2, 3, 4, 6, 8 and 16."),
    ] = None,
    modes: Annotated[
        list[str] | None,
        typer.Option(metavar="N", rich_help_panel=COMPARED,
                     help="Modes of a beam, and of a body of finite elements where their library "
                     "is there; may be repeated. Default 1, 2, 3, 5 and 10."),
    ] = None,
    vehicle: bodies.VehicleOption = bodies.DEFAULT,
    bending_frequency: bodies.FrequencyOption = None,
    bending_damping: bodies.DampingOption = None,
    speed: Annotated[
        list[str] | None,
        typer.Option(metavar="KMH", rich_help_panel=options.TRACK,
                     help="Speed in km/h; may be repeated. Default the paper's 145 and 200."),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(metavar="X", rich_help_panel=options.TRACK,
                     help="Point of the floor, m forward of the middle; may be repeated. Default "
                     "the middle, over the bogies and the ends."),
    ] = None,
    track: options.TrackOption = "erri_low",
    extrapolate: options.ExtrapolateOption = False,
    floor: options.FloorOption = "smooth",
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Draw the errors over the degrees of freedom into this PNG, PDF or SVG "
                     "file."),
    ] = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:  # fmt: skip
    """Compare car bodies: segments, beams and finite elements against the converged beam.

    Example:  railride compare --segments 2 --segments 4 --segments 8 --plot bodies.png
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.choice("--floor", floor, options.FLOORS)
    cut = [given.whole("--segments", n, 1, bodies.MOST_SEGMENTS) for n in segments or ()]
    bent = [given.whole("--modes", n, 1, bodies.MOST_MODES) for n in modes or ()]
    frequency = given.positive("--bending-frequency", bending_frequency, "Hz")
    damping = given.number("--bending-damping", bending_damping, "")
    speeds = [given.positive("--speed", text, "km/h") for text in speed or ("145", "200")]
    places = [given.number("--at", text, "m") for text in at] if at else None
    given.writes({"--output": to, "--plot": plot}, {"--vehicle": vehicle, "--track": track})
    how = reading.of(given, track)
    given.check()
    with working("comparing") as advance:
        from railride import comparison

        usual = segments is None and modes is None
        chosen = {} if usual else {"segments": cut, "beams": bent}
        found = comparison.compare_bodies(
            vehicle, chosen_track(track, extrapolate, how), speeds, at=places, floor=floor,
            elements=comparison.available_elements(comparison.MODES if usual else bent),
            bending_frequency=frequency, bending_damping=damping, progress=advance, **chosen,
        )  # fmt: skip
    rows = [_row(found, one) for one in found.bodies]
    text = output.result(form, {"track": found.track, "reference": _row(found, found.reference),
                                "bodies": rows}, _flat(found), lambda: _table(found),
                         found.remarks)  # fmt: skip
    if plot is not None:
        from railride import plots

        plots.save(plots.plot_comparison(found), plot)
    output.deliver(text, to, found.remarks, plot)


def _row(found: Comparison, one: ComparedBody) -> dict[str, Any]:
    """The keys of one body: a_wrms and error of the first case, and all cases."""
    return {
        "body": one.body,
        "segments": one.segments,
        "modes": one.modes,
        "dof": one.dof,
        "bending_hz": one.free_hz,
        "bending_on_suspension_hz": one.vehicle_hz,
        "a_wrms": one.a_wrms[0, 0],
        "error": one.error[0, 0],
        "derive_s": one.derive_s,
        "simulate_s": one.simulate_s,
        "cases": [
            {"speed_kmh": kmh(v), "position_m": x, "a_wrms": one.a_wrms[i, j],
             "error": one.error[i, j]}
            for i, v in enumerate(found.speeds)
            for j, x in enumerate(found.positions)
        ],
    }  # fmt: skip


def _flat(found: Comparison) -> list[dict[str, Any]]:
    """CSV: a row per body and case."""
    rows = []
    for one in found.bodies:
        row = _row(found, one)
        bending = {f"bending_{k}_hz": f for k, f in enumerate(_three(one.free_hz), start=1)}
        kept = {key: row[key] for key in ("body", "segments", "modes", "dof")}
        rows += [{**kept, **bending, **case, "derive_s": one.derive_s,
                  "simulate_s": one.simulate_s} for case in row["cases"]]  # fmt: skip
    return rows


def _table(found: Comparison) -> str:
    """Frequencies and cost of every body, then a_wrms with its error for every speed."""
    columns = [
        ("body", ""), ("degrees of\nfreedom", "d"),
        *((f"bending {k}\n[Hz]", ".3f") for k in (1, 2, 3)),
        *((f"on suspension\n{k} [Hz]", ".3f") for k in (1, 2, 3)), ("derive\n[ms]", ".0f"),
        ("1 km run\n[ms]", ".1f"),
    ]  # fmt: skip
    shown = [found.reference, *found.bodies]
    rows = [(one.title, one.dof, *_three(one.free_hz), *_three(one.vehicle_hz), 1e3 * one.derive_s,
             1e3 * one.simulate_s) for one in shown]  # fmt: skip
    title = f"{found.vehicle}: car bodies, first what they are measured against"
    tables = [output.table_text(title, columns, rows)]
    for i, v in enumerate(found.speeds):
        heads = [("body", ""), *((f"{x:g} m", ">") for x in found.positions)]
        cells = [(one.title, *(f"{a:.4f} {100 * e:+7.2f} %" for a, e in
                               zip(one.a_wrms[i], one.error[i], strict=True)))
                 for one in shown]  # fmt: skip
        tables.append(output.table_text(
            f"{kmh(v):g} km/h over {found.track}, {found.floor} floor: a_wrms [m/s²], and its "
            f"error against {found.reference.title}", heads, cells))  # fmt: skip
    return "\n".join(tables)


def _three(values: Any) -> list[Any]:
    """The first three, None for those that there are not."""
    return [*values, None, None, None][:3]
