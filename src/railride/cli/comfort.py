"""``railride comfort``: rates a measured acceleration record."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import FORMATS, Arguments
from railride.cli.progress import working

if TYPE_CHECKING:
    from railride.comfort import AxisRating, RecordRating

RECORD, RATING = "The record", "The rating"
LISTED = 40  # blocks of a table; JSON and --blocks have all


@output.exits_cleanly
def comfort(
    file: Annotated[
        str,
        typer.Argument(metavar="FILE", help="The record: CSV in any dialect, Parquet, WAV, MATLAB "
                       ".mat or HDF5."),
    ],
    column: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", rich_help_panel=RECORD,
                     help="A column of accelerations; may be repeated. Default those that are "
                     "named after x, y or z."),
    ] = None,
    time_column: Annotated[
        str | None,
        typer.Option(metavar="NAME", rich_help_panel=RECORD,
                     help="The column of times: s, ms, ns since 1970 or ISO dates; default found "
                     "by its name."),
    ] = None,
    rate: Annotated[
        str | None,
        typer.Option(metavar="HZ", rich_help_panel=RECORD,
                     help="Samples a second, instead of a time column."),
    ] = None,
    unit: Annotated[
        str | None,
        typer.Option(metavar="UNIT", rich_help_panel=RECORD,
                     help="Of the accelerations: m/s², g or mg; default that of the heading, else "
                     "m/s²."),
    ] = None,
    detrend: Annotated[
        bool,
        typer.Option("--detrend", rich_help_panel=RECORD,
                     help="Take the mean out: gravity, or a sensor's offset."),
    ] = False,
    weighting: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", rich_help_panel=RATING,
                     help="Frequency weighting; repeats in the order of the columns. Default "
                     "that of the posture."),
    ] = None,
    posture: Annotated[
        str,
        typer.Option(metavar="NAME", rich_help_panel=RATING,
                     help="standing, seat, backrest, feet or recumbent: which factors the vector "
                     "sum has."),
    ] = "standing",
    blocks: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Write comfort over time, 5 s by 5 s, into this CSV file."),
    ] = None,
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Draw record, running r.m.s. and spectrum into this PNG, PDF or SVG "
                     "file."),
    ] = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:  # fmt: skip
    """Rate a measured acceleration record: every index, each scale under its own name.

    Example:  railride comfort floor.csv --column z --plot floor.png
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    hertz = given.positive("--rate", rate, "Hz")
    if rate is not None and time_column is not None:
        given.conflict("--rate", f"--time-column {time_column!r}")
    written = {"--output": to, "--blocks": blocks, "--plot": plot}
    given.writes(written, {"the record": file})
    given.check()
    with working("rating"):
        from railride.comfort import rate_record
        from railride.records import read_record

        record = read_record(file, column, time_column=time_column, rate=hertz, unit=unit,
                             detrend=detrend)  # fmt: skip
        found = rate_record(record, weightings=_weightings(weighting, len(record.axes)),
                            posture=posture)  # fmt: skip
    text = output.result(form, _document(found), [_flat(axis) for axis in found.axes],
                         lambda: _table(found), found.remarks)  # fmt: skip
    if blocks is not None:
        output.write(found.blocks().to_csv(index=False), blocks)
    if plot is not None:
        from railride import plots

        plots.save(plots.plot_record_rating(found), plot)
    output.deliver(text, to, found.remarks, plot)


def _weightings(given: list[str] | None, axes: int) -> list[str | None]:
    """One for each axis: those given, in the order of the columns, and the posture's for others."""
    named: list[str | None] = [*(given or [])]
    return named + [None] * (axes - len(named)) if given else []


def _document(found: RecordRating) -> dict[str, Any]:
    total = found.total
    return {
        "rate_hz": found.record.rate,
        "duration_s": found.record.duration,
        "axes": [_row(axis) for axis in found.axes],
        "total": None if total is None else {
            "a_v": total.value, "posture": total.posture.name, "factors": total.factors,
        },
        "n_mv": found.n_mv,
        "levels": found.levels,
        "blocks": found.blocks().to_dict("records"),
    }  # fmt: skip


def _row(axis: AxisRating) -> dict[str, Any]:
    """The keys of one axis."""
    values, en = axis.indices, axis.continuous
    return {
        "column": axis.axis.column,
        "direction": axis.axis.direction,
        "weighting": values.weighting,
        "a_rms": values.a_rms,
        "a_wrms": values.a_wrms,
        "mtvv": values.mtvv,
        "mtvv_exp": values.mtvv_exp,
        "vdv": values.vdv,
        "crest_factor": values.crest_factor,
        "wz": values.wz,
        "level": axis.level,
        "levels": axis.levels,
        "en12299_weighting": en.weighting if en else None,
        "en12299_p95": en.p95 if en else None,
        "en12299_vertical_part": en.vertical_part if en else None,
        "en12299_shares": en.shares if en else None,
    }


def _flat(axis: AxisRating) -> dict[str, Any]:
    """One row of CSV."""
    row = _row(axis)
    row["levels"] = "; ".join(f"{scale}: {' or '.join(c)}" for scale, c in axis.levels.items())
    row["en12299_shares"] = "; ".join(
        f"{label}: {share:.4g}" for label, share in (row["en12299_shares"] or {}).items()
    )
    return row


def _table(found: RecordRating) -> str:
    """The indices, the classes of every scale, and comfort over time."""
    record = found.record
    pieces = "" if len(record.starts) == 1 else f" in {len(record.starts)} pieces"
    title = f"{record.name}: {record.duration:.5g} s{pieces} at {record.rate:.5g} Hz"
    columns = [
        ("column", ""), ("axis", ""), ("weighting", ""), ("a_rms\n[m/s²]", ".4f"),
        ("a_wrms\n[m/s²]", ".4f"), ("MTVV\n[m/s²]", ".3f"), ("MTVV exp.\n[m/s²]", ".3f"),
        ("VDV\n[m/s^1.75]", ".3f"), ("crest\nfactor", ".2f"), ("W_z", ".2f"),
        ("EN 12299\na_P95 [m/s²]", ".3f"), ("6 a_z,P95", ".2f"),
    ]  # fmt: skip
    rows: list[tuple[Any, ...]] = []
    for axis in found.axes:
        v, en = axis.indices, axis.continuous
        rows.append((
            axis.axis.column, axis.axis.direction or "-", v.weighting, v.a_rms, v.a_wrms, v.mtvv,
            v.mtvv_exp, v.vdv, v.crest_factor, v.wz, en.p95 if en else None,
            en.vertical_part if en else None,
        ))  # fmt: skip
    parts = [output.table_text(title, columns, rows)]
    if found.total is not None:
        factors = ", ".join(f"k_{a} = {k:g}" for a, k in found.total.factors.items())
        parts.append(f"Vibration total value (ISO 2631-1, {found.total.posture.name}, {factors}): "
                     f"{found.total.value:.4f} m/s²\n")  # fmt: skip
    if found.n_mv is not None:
        parts.append(f"Mean comfort N_MV (EN 12299): {found.n_mv:.2f}\n")
    return "\n".join([*parts, _classes(found), _over_time(found)])


def _classes(found: RecordRating) -> str:
    """A row for each axis and scale."""
    rows = [
        (axis.axis.column, scale, " or ".join(classes))
        for axis in found.axes
        for scale, classes in axis.levels.items()
    ]
    rows += [("together", scale, " or ".join(c)) for scale, c in found.levels.items()]
    return output.table_text(
        "Comfort by scale", [("column", ""), ("scale", ""), ("class", "")], rows
    )


def _over_time(found: RecordRating) -> str:
    """The blocks, as far as a table has room for them."""
    over_time = found.blocks()
    if over_time.empty:
        return ""
    shown = over_time.head(LISTED)
    more = len(over_time) - len(shown)
    title = "Comfort over time, blocks of 5 s"
    title += f": the first {LISTED}, {more} more in JSON and --blocks" if more else ""
    columns = [(name.replace(" [", "\n["), "" if shown[name].dtype.kind in "OUT" else ".4g")
               for name in shown]  # fmt: skip
    return output.table_text(title, columns, shown.itertuples(index=False))
