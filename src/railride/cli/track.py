"""``railride track``: makes, reads, checks and describes tracks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import Arguments

if TYPE_CHECKING:
    from railride.track import Track

FORMATS = ("table", "json", "csv")
MAKE = "A synthetic track"


@output.exits_cleanly
def track(
    file: Annotated[
        str | None, typer.Argument(metavar="[FILE]", help="A measured track to read and describe.")
    ] = None,
    spectrum: Annotated[
        str | None,
        typer.Option(
            metavar="NAME",
            rich_help_panel=MAKE,
            help="Make a track from this spectrum; default erri_low.",
        ),
    ] = None,
    length: Annotated[
        str | None, typer.Option(metavar="M", rich_help_panel=MAKE, help="Default 1000.")
    ] = None,
    step: Annotated[
        str | None, typer.Option(metavar="M", rich_help_panel=MAKE, help="Default 0.25.")
    ] = None,
    seed: Annotated[
        str | None, typer.Option(metavar="INT", rich_help_panel=MAKE, help="Default 1.")
    ] = None,
    extrapolate: Annotated[
        bool,
        typer.Option(
            "--extrapolate",
            rich_help_panel=MAKE,
            help="Continue the spectrum beyond the band it was stated for.",
        ),
    ] = False,
    write: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            rich_help_panel=options.RESULT,
            help="Write the track itself as CSV: distance_m,level_m.",
        ),
    ] = None,
    plot: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            rich_help_panel=options.RESULT,
            help="Draw level and spectrum into this file (.png, .pdf, .svg).",
        ),
    ] = None,
    format: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Make a track from a spectrum, or read one, and describe it.

    ``--format csv`` gives the track itself; the other formats describe it.

    Example:  railride track --spectrum erri_high --length 2000 --seed 7 --write track.csv
    """  # fmt: skip
    given = Arguments()
    given.choice("--format", format, FORMATS)
    making = {"--spectrum": spectrum, "--length": length, "--step": step, "--seed": seed}
    for option, value in making.items():
        if file is not None and value is not None:
            given.faults.add(option, f"a file, {file!r}, with it", "one of the two",
                             "leave one of the two out")  # fmt: skip
    metres, step_m = (given.number(o, making[o], "m") for o in ("--length", "--step"))
    number = given.whole("--seed", seed)
    for option, value in (("--length", metres), ("--step", step_m)):
        if value is not None and value <= 0:
            given.faults.add(option, f"{value:g} m", "one above 0")
    given.check()
    for path in (to, write, plot):
        output.check_output(path)
    from railride.spectra import spectrum as named
    from railride.track import synthesise
    from railride.trackfile import read_track, track_text

    if file is not None:
        found, source = read_track(file), None
    else:
        source = named(spectrum or "erri_low")
        source = source.extrapolated() if extrapolate else source
        found = synthesise(
            source, metres or 1000.0, step_m or 0.25, 1 if number is None else number
        )
    if write is not None:
        output.write(track_text(found), write)
    if plot is not None:
        from railride import plots

        plots.save(plots.plot_track_overview(found, source), plot)
    text = track_text(found) if format == "csv" else _described(found, format)
    if format != "json":
        output.remark(found.remarks)
    output.write(text, to)


def _described(found: Track, format: str) -> str:
    from railride.spectra import D1, D2

    rows: dict[str, Any] = {
        "length_m": found.length,
        "step_m": found.step,
        "rms_mm": 1000 * found.rms(),
        "d1_rms_mm": 1000 * found.band_rms(*D1) if found.covers(*D1) else None,
        "d2_rms_mm": 1000 * found.band_rms(*D2) if found.covers(*D2) else None,
    }
    if format == "json":
        return output.json_text({**rows, "remarks": found.remarks})
    names = {
        "length_m": "length [m]", "step_m": "step [m]", "rms_mm": "r.m.s. [mm]",
        "d1_rms_mm": "r.m.s. in D1, 3-25 m [mm]", "d2_rms_mm": "r.m.s. in D2, 25-70 m [mm]",
    }  # fmt: skip
    return output.table_text(f"Track {found.name}", [("", ""), ("value", ".4g")],
                             [(names[key], value) for key, value in rows.items()])  # fmt: skip
