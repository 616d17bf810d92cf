"""``railride ride``: over a track, to a comfort value."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.exact import integrated
from railride.cli.grouped import grouped
from railride.cli.options import FORMATS, Arguments, kmh
from railride.cli.progress import working
from railride.cli.reading import FileReading, chosen_track
from railride.cli.vehicle import VehicleChoice

if TYPE_CHECKING:
    from railride.cli.exact import Detail
    from railride.rides import Case, RideResult
    from railride.spectra import Spectrum
    from railride.track import Track
    from railride.vehicle import VehicleModel

RIDE = "The ride"


@output.exits_cleanly
@grouped(reading=FileReading, choice=VehicleChoice)
def ride(
    choice: VehicleChoice,
    reading: FileReading,
    speed: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KMH",
            rich_help_panel=RIDE,
            help="Speed in km/h; may be repeated. Default the paper's 145 and 200.",
        ),
    ] = None,
    track: options.TrackOption = "erri_low",
    length: Annotated[
        str | None,
        typer.Option(
            metavar="M",
            rich_help_panel=RIDE,
            help="The rated section; the run-in comes before it. Default 1000.",
        ),
    ] = None,
    seed: Annotated[
        str | None,
        typer.Option(
            metavar="INT", rich_help_panel=RIDE, help="Of the synthetic track. Default 1."
        ),
    ] = None,
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
    travel: Annotated[
        bool,
        typer.Option(
            "--travel",
            rich_help_panel=RIDE,
            help="Add the r.m.s. and expected peak, over --length, of suspension travel and (where "
            "the wheelset's mass is known) wheel load: exact, from the spectrum.",
        ),
    ] = False,
    bands: Annotated[
        bool,
        typer.Option(
            "--bands",
            rich_help_panel=RIDE,
            help="Add the third-octave values of the floor's acceleration: exact, from the "
            "spectrum.",
        ),
    ] = False,
    shares: Annotated[
        bool,
        typer.Option(
            "--shares",
            rich_help_panel=RIDE,
            help="Add the share of every mode in the weighted mean square: exact, from the "
            "spectrum.",
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
    extrapolate: options.ExtrapolateOption = False,
    plots: Annotated[
        str | None,
        typer.Option(
            metavar="DIR",
            rich_help_panel=options.RESULT,
            help="Draw track and accelerations into this folder.",
        ),
    ] = None,
    floor: options.FloorOption = "smooth",
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Run over a track at each speed and rate the comfort.

    Example:  railride ride --speed 145 --speed 200 --at 0 --plots plots
    """
    given = Arguments()
    asked = [name for name, wanted in (("travel", travel), ("bands", bands), ("shares", shares))
             if wanted]  # fmt: skip
    given.choice("--format", form, FORMATS)
    given.choice("--floor", floor, options.FLOORS)
    speeds = [given.positive("--speed", text, "km/h") for text in speed or ("145", "200")]
    places = [given.number("--at", text, "m") for text in at or ("0",)]
    rated = given.positive("--length", length, "m")
    number = given.whole("--seed", seed, 0, options.LARGEST_SEED)
    if spectral and plots is not None:
        given.conflict("--plots", "--spectral", "leave one of the two out: only a run can be drawn")
    output.check_folder(given.faults, "--plots", plots)
    given.writes({"--output": to}, {"--vehicle": choice.vehicle, "--track": track})
    how = reading.of(given, track)
    with working("riding") as advance:
        model = choice.model(given)
        from railride import rides

        source = chosen_track(track, extrapolate, how)
        idle = _idle(source, spectral, {"--length": length, "--seed": seed}, extrapolate,
                     travel)  # fmt: skip
        found = rides.ride(
            model, source, speeds, at=places,
            length=1000.0 if rated is None else rated, seed=1 if number is None else number,
            floor=floor, weight=weighting, spectral=spectral, progress=advance,
        )  # fmt: skip
        details = _details(asked, model, source, speeds, places, rated, floor, weighting)
        drawn = None if plots is None else _draw(found, plots)
    remarks = [*found.remarks, *idle, *(said for detail in details for said in detail.remarks)]
    if form == "csv":
        remarks += [f"--{name} changes nothing in csv, which holds one table: take json or table"
                    for name in asked]  # fmt: skip
    text = output.result(
        form,
        {"track": found.track, "cases": [_row(case) for case in found.cases],
         **{detail.key: detail.rows for detail in details}},
        [_flat(case) for case in found.cases],
        lambda: "\n".join([_table(found), *(detail.table for detail in details)]),
        remarks,
    )  # fmt: skip
    output.deliver(text, to, remarks, drawn)


def _idle(
    source: Spectrum | Track, spectral: bool, given: dict[str, str | None], extrapolate: bool,
    travel: bool,
) -> list[str]:  # fmt: skip
    """Remarks on options that change nothing."""
    from railride.spectra import Spectrum

    made = isinstance(source, Spectrum)
    why = "without a run" if spectral else "on a measured track"
    idle = [o for o, text in given.items() if text is not None and (spectral or not made)]
    idle = [o for o in idle if spectral or o != "--length"]
    idle = [o for o in idle if not travel or o != "--length"]
    remarks = [f"{option} changes nothing {why}" for option in idle]
    if extrapolate and not (isinstance(source, Spectrum) and source.band):
        remarks.append(f"--extrapolate changes nothing: {source.name} has no spectrum with a band")
    return remarks


def _details(asked: Sequence[str], model: VehicleModel, source: Spectrum | Track,
             speeds: list[float], places: list[float], length: float | None, floor: str,
             weighting: str) -> list[Detail]:  # fmt: skip
    """What else was asked for, from the track's spectrum; nothing where it has none."""
    from railride.cli import exact
    from railride.rides import exact_spectrum

    if not asked:
        return []
    spectrum, _ = exact_spectrum(source)
    if spectrum is None:
        return []
    given = exact.Asked(model, spectrum, speeds, places, floor, weighting,
                        1000.0 if length is None else length)  # fmt: skip
    return [getattr(exact, name)(given) for name in asked]


def _draw(found: RideResult, folder: str) -> str:
    """Draw into the folder; the names of the files."""
    from railride import plots

    return ", ".join(map(str, plots.save_ride_plots(found, folder)))


def _row(case: Case) -> dict[str, Any]:
    en = case.continuous
    return {
        "speed_kmh": kmh(case.speed),
        "position_m": case.position,
        "body": case.body,
        "segments": case.segments,
        "modes": case.modes,
        "a_rms": case.a_rms,
        "a_wrms": case.a_wrms,
        "a_wrms_exact": case.a_wrms_exact,
        "a_wrms_error": case.a_wrms_error,
        "standard_error": case.standard_error,
        "mtvv": case.mtvv,
        "mtvv_exp": case.mtvv_exp,
        "vdv": case.vdv,
        "crest_factor": case.crest_factor,
        "wz": case.wz,
        "en12299_vertical_part": None if en is None else en.vertical_part,
        "en12299_blocks": 0 if en is None else en.blocks.size,
        "en12299_continuous": {} if en is None else en.shares,
        "level": case.level,
        "levels": case.levels,
    }


def _flat(case: Case) -> dict[str, Any]:
    row = _row(case)
    row["en12299_continuous"] = "; ".join(
        f"{label}: {share:.3g}" for label, share in row["en12299_continuous"].items()
    )
    row["levels"] = "; ".join(
        f"{scale}: {' or '.join(classes)}" for scale, classes in case.levels.items()
    )
    return row


def _table(result: RideResult) -> str:
    """The values, and below them the classes of every scale."""
    columns = [
        ("speed\n[km/h]", ".6g"), ("at\n[m]", ".6g"), ("a_rms\n[m/s²]", ".4f"),
        ("a_wrms\n[m/s²]", ".4f"), ("exact\n[m/s²]", ".4f"), ("± std.\nerror", ".4f"),
        ("MTVV\n[m/s²]", ".3f"), ("VDV\n[m/s^1.75]", ".3f"), ("crest\nfactor", ".2f"),
        ("W_z", ".2f"), ("comfort\n(paper's Table 3)", ""),
    ]  # fmt: skip
    rows = [
        (kmh(c.speed), c.position, c.a_rms, c.a_wrms, c.a_wrms_exact, c.standard_error,
         c.mtvv, c.vdv, c.crest_factor, c.wz, c.level)
        for c in result.cases
    ]  # fmt: skip
    title = (f"{result.vehicle} ({result.body}) over {result.track}, {result.floor} floor, "
             f"{result.weighting} weighted")  # fmt: skip
    scales = [*columns[:2], ("scale", ""), ("classes", "")]
    classes = [
        (kmh(c.speed), c.position, scale, " or ".join(found))
        for c in result.cases
        for scale, found in c.levels.items()
    ]
    errors = [c.a_wrms_error for c in result.cases if c.a_wrms_error is not None]
    values = output.table_text(title, columns, rows) + integrated(errors)
    return values + "\n" + output.table_text("Comfort by scale", scales, classes)
