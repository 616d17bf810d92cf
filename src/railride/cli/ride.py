"""``railride ride``: over a track, to a comfort value."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import Arguments, build_model

if TYPE_CHECKING:
    from railride.rides import Case, RideResult

FORMATS = ("table", "json", "csv")
RIDE = "The ride"

TrackOption = Annotated[
    str, typer.Option("--track", metavar="NAME|FILE", rich_help_panel=RIDE,
                      help="A track spectrum by name, or a CSV file with distance_m, level_m.")]  # fmt: skip


@output.exits_cleanly
def ride(
    speed: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KMH",
            rich_help_panel=RIDE,
            help="Speed in km/h; may be repeated. Default the paper's 145 and 200.",
        ),
    ] = None,
    track: TrackOption = "erri_low",
    length: Annotated[
        str,
        typer.Option(
            metavar="M", rich_help_panel=RIDE, help="The rated section; the run-in comes before it."
        ),
    ] = "1000",
    seed: Annotated[
        str, typer.Option(metavar="INT", rich_help_panel=RIDE, help="Of the synthetic track.")
    ] = "1",
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="X",
            rich_help_panel=RIDE,
            help="Point of the floor, m forward of the middle; may be repeated.",
        ),
    ] = None,
    spectral: Annotated[
        bool,
        typer.Option(
            "--spectral",
            rich_help_panel=RIDE,
            help="The exact stochastic value alone (0.05-80 Hz), without a run.",
        ),
    ] = False,
    weighting: Annotated[
        str,
        typer.Option(
            metavar="NAME",
            rich_help_panel=RIDE,
            help="Frequency weighting: Wk, or Wk_paper for the paper's Eq (6).",
        ),
    ] = "Wk",
    extrapolate: Annotated[
        bool,
        typer.Option(
            "--extrapolate",
            rich_help_panel=RIDE,
            help="Continue a spectrum beyond the band it was stated for.",
        ),
    ] = False,
    plots: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            rich_help_panel=options.RESULT,
            help="Draw track and accelerations into this folder.",
        ),
    ] = None,
    vehicle: options.VehicleOption = "cati2024",
    segments: options.SegmentsOption = None,
    body: options.BodyOption = None,
    bending_frequency: options.FrequencyOption = None,
    joint_stiffness: options.StiffnessOption = None,
    bending_damping: options.DampingOption = None,
    floor: options.FloorOption = "smooth",
    format: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Run over a track at each speed and rate the comfort.

    Example:  railride ride --speed 145 --speed 200 --at 0 --plots plots
    """  # fmt: skip
    given = Arguments()
    given.choice("--format", format, FORMATS)
    given.choice("--floor", floor, ("smooth", "polygon"))
    speeds = given.numbers("--speed", speed or ["145", "200"], "km/h")
    for value in speeds:
        if value <= 0:
            given.faults.add("--speed", f"{3.6 * value:g} km/h", "a speed above 0")
    places = given.numbers("--at", at or ["0"], "m")
    rated = given.number("--length", length, "m")
    if rated is not None and rated <= 0:
        given.faults.add("--length", f"{rated:g} m", "a length above 0")
    number = given.whole("--seed", seed)
    if spectral and plots is not None:
        given.faults.add("--plots", "--spectral with it", "a time run to draw",
                         "leave one of the two out")  # fmt: skip
    output.check_output(to)
    output.check_folder(plots, "--plots")
    model = build_model(given, vehicle, segments, body, bending_frequency, joint_stiffness,
                        bending_damping)  # fmt: skip
    from railride import rides, spectra

    source = rides.load_track(track)
    if extrapolate and isinstance(source, spectra.Spectrum):
        source = source.extrapolated()
    with _progress(len(speeds), hidden=spectral) as advance:
        result = rides.ride(
            model, source, speeds, at=places, length=rated, seed=number, floor=floor,
            weight=weighting, spectral=spectral, progress=advance,
        )  # fmt: skip
    remarks = list(result.remarks)
    if plots is not None:
        from railride import plots as drawing

        remarks.append("drawn: " + ", ".join(map(str, drawing.save_ride_plots(result, plots))))
    if format == "json":
        document = {"track": result.track, "cases": [_row(case) for case in result.cases]}
        text = output.json_text({**document, "remarks": remarks})
    elif format == "csv":
        text = output.csv_text([_flat(case) for case in result.cases])
    else:
        text = _table(result)
    if format != "json":
        output.remark(remarks)
    output.write(text, to)


def _row(case: Case) -> dict[str, Any]:
    return {
        "speed_kmh": 3.6 * case.speed,
        "position_m": case.position,
        "body": case.body,
        "segments": case.segments,
        "a_rms": case.a_rms,
        "a_wrms": case.a_wrms,
        "a_wrms_exact": case.a_wrms_exact,
        "standard_error": case.standard_error,
        "mtvv": case.mtvv,
        "vdv": case.vdv,
        "crest_factor": case.crest_factor,
        "wz": case.wz,
        "level": case.level,
        "levels": case.levels,
    }


def _flat(case: Case) -> dict[str, Any]:
    return {**_row(case), "levels": "; ".join(
        f"{scale}: {' or '.join(classes)}" for scale, classes in case.levels.items()
    )}  # fmt: skip


def _table(result: RideResult) -> str:
    columns = [
        ("speed\n[km/h]", "g"), ("at\n[m]", "g"), ("a_rms\n[m/s²]", ".4f"),
        ("a_wrms\n[m/s²]", ".4f"), ("exact\n[m/s²]", ".4f"), ("± std.\nerror", ".4f"),
        ("MTVV\n[m/s²]", ".3f"), ("VDV\n[m/s^1.75]", ".3f"), ("crest\nfactor", ".2f"),
        ("W_z", ".2f"), ("comfort (paper's Table 3)", ""),
    ]  # fmt: skip
    rows = [
        (round(3.6 * c.speed, 9), c.position, c.a_rms, c.a_wrms, c.a_wrms_exact, c.standard_error,
         c.mtvv, c.vdv, c.crest_factor, c.wz, c.level)
        for c in result.cases
    ]  # fmt: skip
    first = result.cases[0]
    body = "rigid body" if first.segments == 1 else f"{first.segments} segments"
    title = (f"{result.vehicle} ({body}) over {result.track}, {result.floor} floor, "
             f"{result.weighting} weighted")  # fmt: skip
    classes = [
        f"  {3.6 * c.speed:g} km/h, {c.position:g} m: "
        + "; ".join(f"{scale}: {' or '.join(found)}" for scale, found in c.levels.items())
        for c in result.cases
    ]
    return output.table_text(title, columns, rows) + "\n".join(classes) + "\n"


class _progress:  # noqa: N801 - used as a function
    """A progress bar on standard error where it is a terminal; ``advance(fraction)`` moves it."""

    def __init__(self, steps: int, hidden: bool) -> None:
        from rich.console import Console
        from rich.progress import Progress

        console = Console(stderr=True)
        self._bar = Progress(console=console, transient=True,
                             disable=hidden or steps < 1 or not console.is_terminal)  # fmt: skip
        self._task = self._bar.add_task("riding", total=1.0)

    def __enter__(self) -> Callable[[float], None]:
        self._bar.start()
        return lambda fraction: self._bar.update(self._task, completed=fraction)

    def __exit__(self, *_: object) -> None:
        self._bar.stop()
