"""``railride sensitivity``: which parameters matter, by exact gradients and by changes."""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.grouped import grouped
from railride.cli.options import FORMATS, Arguments, kmh
from railride.cli.progress import working
from railride.cli.reading import FileReading, chosen_track
from railride.cli.vehicle import VehicleChoice

if TYPE_CHECKING:
    from railride.sensitivities import Sensitivities

RIDE = "The ride"
ROUNDED = 5e-5  # of a table: less is nothing
ABREAST = 8  # modes beside one another in a table


@output.exits_cleanly
@grouped(reading=FileReading, choice=VehicleChoice)
def sensitivity(
    choice: VehicleChoice,
    reading: FileReading,
    speed: Annotated[
        list[str] | None,
        typer.Option(metavar="KMH", rich_help_panel=RIDE,
                     help="Speed in km/h; may be repeated. Default the paper's 145 and 200."),
    ] = None,
    track: options.TrackOption = "erri_low",
    at: Annotated[
        list[str] | None,
        typer.Option(metavar="X", rich_help_panel=RIDE,
                     help="Point of the floor, m forward of the middle; may be repeated."),
    ] = None,
    parameter: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", rich_help_panel=RIDE,
                     help="A parameter, such as k_2 or secondary_stiffness; may be repeated. "
                     "Default every one that enters. With k_theta among them the joints' "
                     "stiffness is held, else the bending frequency that calibrates it."),
    ] = None,
    change: Annotated[
        str,
        typer.Option(metavar="SHARE", rich_help_panel=RIDE,
                     help="By how much of its value each parameter is changed, too."),
    ] = "10 %",
    weighting: Annotated[
        str, typer.Option(metavar="NAME", rich_help_panel=RIDE, help="Frequency weighting.")
    ] = "Wk",
    extrapolate: options.ExtrapolateOption = False,
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Draw tornado plots into this PNG, PDF or SVG file."),
    ] = None,
    floor: options.FloorOption = "smooth",
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:  # fmt: skip
    """Which parameters matter: exact gradients of comfort, modes and static deflections.

    Example:  railride sensitivity --speed 200 --change "5 %" --plot tornado.png

    JSON: track, held, change, remarks;
    parameters: symbol, meaning, unit, value;
    cases: speed_kmh, position_m, a_wrms, parameters: symbol, gradient (m/s² per
    unit), relative (d ln a_wrms/d ln p), linear and effect (relative change of
    a_wrms with less and with more of it, by the gradient and found anew);
    modes: label, frequency_hz, damping_ratio, parameters: symbol, frequency and
    damping (gradients), frequency_relative, damping_relative;
    deflections: output, static (m), parameters: symbol, gradient, relative.
    CSV holds the cases.
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.choice("--floor", floor, options.FLOORS)
    speeds = [given.positive("--speed", text, "km/h") for text in speed or ("145", "200")]
    places = [given.number("--at", text, "m") for text in at or ("0",)]
    share = given.number("--change", change, "")
    if share is not None and not 0 < share < 1:
        given.faults.add("--change", repr(change), "a share above 0 and below 1",
                         'such as 0.1 or "10 %"')  # fmt: skip
    given.writes({"--output": to, "--plot": plot}, {"--vehicle": choice.vehicle, "--track": track})
    how = reading.of(given, track)
    with working("differentiating"):
        model = choice.model(given)
        from railride import sensitivities

        found = sensitivities.sensitivity(
            model, speeds, chosen_track(track, extrapolate, how), places, parameters=parameter,
            floor=floor, weight=weighting, change=share,
        )  # fmt: skip
        if plot is not None:
            from railride import plots

            plots.save(plots.plot_tornadoes(found), plot)
    remarks = [*model.vehicle.remarks, *model.remarks, *found.remarks]
    text = output.result(form, _document(found), _flat(found), lambda: _table(found), remarks)
    output.deliver(text, to, remarks, plot)


def _document(found: Sensitivities) -> dict[str, Any]:
    """The JSON document."""
    return {
        "track": found.track,
        "held": found.held or None,
        "change": found.change,
        "parameters": [
            {"symbol": p.symbol.name, "meaning": p.meaning, "unit": p.unit, "value": p.value}
            for p in found.parameters
        ],
        "cases": [_case(found, i, j) for i in range(len(found.speeds))
                  for j in range(len(found.positions))],
        "modes": [_mode(found, k) for k in range(len(found.roots.modes))],
        "deflections": [
            {"output": name, "static": value, "parameters": [
                {"symbol": p.symbol.name, "gradient": slope, "relative": slope * p.value / value}
                for p, slope in zip(found.parameters, slopes.tolist(), strict=True)]}
            for (name, value), slopes in zip(found.deflections.items(), found.deflection_slopes,
                                             strict=True)
        ],
    }  # fmt: skip


def _case(found: Sensitivities, i: int, j: int) -> dict[str, Any]:
    """One speed and point of the document."""
    return {
        "speed_kmh": kmh(found.speeds[i]),
        "position_m": found.positions[j],
        "a_wrms": found.a_wrms[i, j],
        "parameters": [
            {
                "symbol": p.symbol.name,
                "gradient": found.gradient[i, j, k],
                "relative": found.relative[i, j, k],
                "linear": found.linear_effects[i, j, k],
                "effect": found.effects[i, j, k],
            }
            for k, p in enumerate(found.parameters)
        ],
    }


def _mode(found: Sensitivities, m: int) -> dict[str, Any]:
    """One mode of the document."""
    modes, rows = found.roots, []
    f, zeta = modes.frequencies[m], modes.damping_ratios[m]
    for k, p in enumerate(found.parameters):
        df, dzeta = modes.frequency_slopes[m, k], modes.damping_slopes[m, k]
        rows.append({
            "symbol": p.symbol.name,
            "frequency": df,
            "damping": dzeta,
            "frequency_relative": df * p.value / f,
            "damping_relative": dzeta * p.value / zeta if zeta else None,
        })  # fmt: skip
    return {"label": modes.names[m], "frequency_hz": f, "damping_ratio": zeta, "parameters": rows}


def _flat(found: Sensitivities) -> list[dict[str, Any]]:
    """A row per case and parameter for CSV."""
    rows = []
    for case in _document(found)["cases"]:
        for p, row in zip(found.parameters, case.pop("parameters"), strict=True):
            linear, effect = row.pop("linear"), row.pop("effect")
            described = {"meaning": p.meaning, "unit": p.unit, "value": p.value}
            rows.append({**case, **row, **described, "linear_less": linear[0],
                         "linear_more": linear[1], "effect_less": effect[0],
                         "effect_more": effect[1]})  # fmt: skip
    return rows


def _table(found: Sensitivities) -> str:
    """A table for every case, the most important parameter first; then modes and deflections."""
    from railride.text import symbol

    share = f"{100 * found.change:g} %"
    columns = [("parameter", ""), ("", ""), ("value", ".6g"), ("unit", ""),
               ("d a_wrms/dp\n[m/s²/unit]", ".4g"), ("d ln a/\nd ln p", ".3f"),
               (f"{share} less:\nby gradient", "+.1%"), ("\nfound anew", "+.1%"),
               (f"{share} more:\nby gradient", "+.1%"), ("\nfound anew", "+.1%")]  # fmt: skip
    tables = []
    for case in range(found.a_wrms.size):
        i, j = divmod(case, len(found.positions))
        order = found.ranked(case)
        rows: list[Any] = []
        for k in [*order, *(k for k in range(len(found.parameters)) if k not in order)]:
            p = found.parameters[k]
            pairs = zip(found.linear_effects[i, j, k], found.effects[i, j, k], strict=True)
            rows.append(
                (
                    p.meaning,
                    symbol(p.symbol),
                    p.value,
                    p.unit,
                    found.gradient[i, j, k],
                    found.relative[i, j, k],
                    *(_shown(x) for pair in pairs for x in pair),
                )
            )
        title = (f"{found.vehicle} ({found.body}) over {found.track}, {found.floor} floor, "
                 f"{found.weighting} weighted\n{kmh(found.speeds[i]):g} km/h, "
                 f"{found.positions[j]:g} m: a_wrms {found.a_wrms[i, j]:.4f} m/s²")  # fmt: skip
        tables.append(output.table_text(title, columns, rows))
    held = f"\n  held while others change: the {found.held}\n" if found.held else ""
    return "\n".join([*tables, *_modes(found), _deflections(found)]) + held


def _shown(x: float) -> float | None:
    """None of what is not defined; what is nothing without a sign."""
    if isnan(x):
        return None
    return 0.0 if abs(x) < ROUNDED else float(x)


def _modes(found: Sensitivities) -> list[str]:
    """What each parameter does to frequencies and damping ratios, some modes abreast."""
    modes, tables = found.roots, []
    for name, letter, sizes, slopes in (
        ("Natural frequencies", "f", modes.frequencies, modes.frequency_slopes),
        ("Damping ratios", "ζ", modes.damping_ratios, modes.damping_slopes),
    ):
        unit = " [Hz]" if letter == "f" else ""
        for start in range(0, len(sizes), ABREAST):
            some = range(start, min(start + ABREAST, len(sizes)))
            heads = [modes.names[m].replace(", ", "\n") for m in some]
            columns = [(f"{head}\n{sizes[m]:.4g}{unit}", "+.3f")
                       for head, m in zip(heads, some, strict=True)]  # fmt: skip
            rows = _relative(found, [(sizes[m], slopes[m]) for m in some])
            tables.append(
                output.table_text(f"{name}: d ln {letter}/d ln p", [("", ""), *columns], rows)
            )
    return tables


def _deflections(found: Sensitivities) -> str:
    """What each parameter does to the static deflections."""
    pairs = list(zip(found.deflections.values(), found.deflection_slopes, strict=True))
    heads = [name.replace("_", " ").removesuffix(" deflection") for name in found.deflections]
    columns = [(f"{head}\n{1e3 * value:.1f} mm", "+.3f")
               for head, (value, _) in zip(heads, pairs, strict=True)]  # fmt: skip
    return output.table_text("Static deflections: d ln s/d ln p", [("", ""), *columns],
                             _relative(found, pairs))  # fmt: skip


def _relative(found: Sensitivities, pairs: Sequence[tuple[float, Any]]) -> list[Any]:
    """Rows of parameters: d ln y/d ln p for pairs of y and dy/dp."""
    from railride.text import symbol

    return [
        (symbol(p.symbol), *(_shown(slopes[k] * p.value / y) if y else None for y, slopes in pairs))
        for k, p in enumerate(found.parameters)
    ]  # fmt: skip
