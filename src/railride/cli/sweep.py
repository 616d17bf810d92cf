"""``railride sweep``: every design of a study, into a folder of results."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import FORMATS, Arguments
from railride.cli.progress import counting

if TYPE_CHECKING:
    from railride.sweeps import SweepResult

WHERE = "Where it is evaluated"
MOST_WORKERS = 1000


@output.exits_cleanly
def sweep(
    study: Annotated[
        str,
        typer.Argument(metavar="STUDY", show_default=False,
                       help="A shipped study (sweep_grid, sweep_list, sweep_samples) or a TOML "
                       "file."),
    ],
    workers: Annotated[
        str | None,
        typer.Option(metavar="N", rich_help_panel=WHERE,
                     help="Processes of this machine; default one for each core."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", rich_help_panel=WHERE,
                     help="Dask scheduler, tcp://host:8786, whose cluster evaluates the designs "
                     "instead."),
    ] = None,
    replace: Annotated[
        bool,
        typer.Option("--replace", rich_help_panel=options.RESULT,
                     help="Throw away what the folder holds of another study, or of this one "
                     "before it was changed."),
    ] = False,
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Draw the weighted r.m.s. over the first two parameters into this PNG, "
                     "PDF or SVG file."),
    ] = None,
    form: options.FormatOption = "table",
    to: Annotated[
        str | None,
        typer.Option("--output", metavar="FOLDER", rich_help_panel=options.RESULT,
                     help="Folder of the results; default the study's name with _results."),
    ] = None,
) -> None:  # fmt: skip
    """Evaluate every design of a study; interrupted, the same command goes on where it stopped.

    Example:  railride sweep sweep_grid --output grid --plot grid.png
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    count = given.whole("--workers", workers, 1, MOST_WORKERS)
    if workers is not None and scheduler is not None:
        given.conflict("--workers", "--scheduler")
    folder = f"{Path(study).stem}_results" if to is None else to
    output.check_folder(given.faults, "--output", folder)
    given.writes({"--plot": plot}, {"STUDY": study})
    given.check()
    with counting("sweeping", "designs") as advance:
        from railride import sweeps

        found = sweeps.sweep(sweeps.read_sweep_study(study), folder, workers=count,
                             scheduler=scheduler, replace=replace, progress=advance)  # fmt: skip
    if plot is not None:
        from railride import plots

        figure = plots.canvas.new_figure(7.0, 4.2)
        plots.plot_sweep(found, ax=figure.add_subplot())
        plots.save(figure, plot)
    text = output.result(form, _document(found), _flat(found), lambda: _table(found),
                         found.remarks)  # fmt: skip
    output.deliver(text, None, found.remarks, plot)


def _document(found: SweepResult) -> dict[str, Any]:
    """The keys of JSON: where the results are, how many, and the best designs of each case."""
    return {
        "study": found.study,
        "folder": str(found.folder),
        "parts_format": found.form,
        "parts": found.count,
        "bytes": found.bytes,
        "designs": found.designs,
        "done": found.done,
        "new": found.new,
        "problems": found.problems,
        "parameters": list(found.parameters),
        "columns": list(found.columns),
        "best": [{"case": case, "designs": table.to_dict("records")}
                 for case, table in found.best.items()],
    }  # fmt: skip


def _flat(found: SweepResult) -> list[dict[str, Any]]:
    """CSV: a row for each of the best designs; one of the sweep itself where nothing is rated."""
    rows = [
        {"case": case, "rank": rank, **row, "value": row[case]}
        for case, table in found.best.items()
        for rank, row in enumerate(table.to_dict("records"), start=1)
    ]
    kept = ("case", "rank", "design", *found.parameters, "value")
    whole = {"study": found.study, "folder": str(found.folder), "designs": found.designs,
             "done": found.done, "problems": found.problems}  # fmt: skip
    return [{key: row[key] for key in kept} for row in rows] or [whole]


def _table(found: SweepResult) -> str:
    """What was done, and the best designs of each case."""
    from railride.sweeps.store import size

    kind = {"csv": "CSV", "parquet": "Parquet"}[found.form]
    kind += " part" if found.count == 1 else " parts"
    lines = [
        f"{found.study}: {found.done:,} of {found.designs:,} designs done, {found.new:,} now",
        f"{found.count:,} {kind} of {size(found.bytes)} in {found.folder}",
    ]
    tables = ["\n".join(lines) + "\n"]
    for case, table in found.best.items():
        if table.empty:
            continue
        heads = [name.replace(" [", "\n[") for name in found.parameters]
        columns = [("design", "d"), *((head, ".6g") for head in heads), ("a_wrms\n[m/s²]", ".4f")]
        rows = table[["design", *found.parameters, case]].itertuples(index=False)
        tables.append(output.table_text(f"Least {case}", columns, rows))
    return "\n".join(tables)
