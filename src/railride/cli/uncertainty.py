"""``railride uncertainty``: what is known of the comfort where parameters are not known exactly."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.options import FORMATS, Arguments
from railride.cli.progress import working

if TYPE_CHECKING:
    from railride.uncertainties import Estimate, Summary, Uncertainty


@output.exits_cleanly
def uncertainty(
    study: Annotated[
        str,
        typer.Argument(metavar="STUDY", help="A study file, or the name of a shipped one."),
    ],
    plot: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Draw distributions and indices into this PNG, PDF or SVG file."),
    ] = None,
    designs: Annotated[
        str | None,
        typer.Option(metavar="FILE", rich_help_panel=options.RESULT,
                     help="Write every design and its values into this CSV file."),
    ] = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:  # fmt: skip
    """Percentiles of the comfort, and which parameter the scatter comes from.

    The study's parameters have distributions, such as distribution = "normal", deviation = "5 %".

    Example:  railride uncertainty uncertainty --plot scatter.png

    JSON: title, method, seed, evaluated, failed (reason, designs), remarks;
    parameters: name, symbol, unit, meaning, distribution, nominal;
    quantities: name, unit, designs, nominal, mean, standard_deviation,
    percentiles (percent), classes (scale, class), and indices (parameter;
    first and total order). Each estimate is a value with low and high, the
    ends of its interval at 95 %.
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    written = {"--output": to, "--plot": plot, "--designs": designs}
    given.writes(written, {"STUDY": study})
    given.check()
    with working("sampling") as advance:
        from railride.studies import read_study
        from railride.uncertainties import read_uncertainty, study_uncertainty

        asked = read_study(study, {"uncertainty": read_uncertainty})
        found = study_uncertainty(asked, progress=advance)
        if plot is not None:
            from railride import plots

            plots.save(plots.plot_uncertainty_study(found), plot)
    remarks = [*asked.vehicle.remarks, *found.remarks]
    text = output.result(form, _document(found), _flat(found), lambda: _table(found), remarks)
    if designs is not None:
        output.write(found.samples().to_csv(index=False, lineterminator="\n"), designs)
    output.deliver(text, to, remarks, plot)
    if designs is not None:
        typer.echo(f"written: {designs}", err=True)


def _document(found: Uncertainty) -> dict[str, Any]:
    """The JSON document."""
    return {
        "title": found.title,
        "method": found.method,
        "seed": found.seed,
        "evaluated": found.evaluated,
        "failed": [{"reason": why, "designs": n} for why, n in found.failed.items()],
        "parameters": [vars(parameter) for parameter in found.parameters],
        "quantities": [_quantity(found, k) for k in range(len(found.summaries))],
    }


def _quantity(found: Uncertainty, k: int) -> dict[str, Any]:
    """One quantity of the document."""
    one, own = found.summaries[k], found.indices[k]
    names = [parameter.name for parameter in found.parameters]
    pairs = [] if own is None else zip(names, own.first, own.total, strict=True)
    return {
        "name": one.name,
        "unit": one.unit,
        "designs": one.count,
        "nominal": one.nominal,
        "mean": vars(one.mean),
        "standard_deviation": vars(one.deviation),
        "percentiles": [{"percent": p, **vars(at)} for p, at in one.percentiles.items()],
        "classes": [
            {"scale": scale, "class": label, **vars(share)}
            for scale, shares in one.classes.items()
            for label, share in shares.items()
        ],
        "indices": None if own is None else [
            {"parameter": name, "first": vars(first), "total": vars(total)}
            for name, first, total in pairs
        ],
    }  # fmt: skip


def _flat(found: Uncertainty) -> list[dict[str, Any]]:
    """CSV: a row per quantity; classes and indices in columns of their own, empty where none."""
    from railride.uncertainties.result import spread

    rows = [{"quantity": name, **row} for name, row in found.table().to_dict("index").items()]
    for row, one, own in zip(rows, found.summaries, found.indices, strict=True):
        for scale, shares in one.classes.items():
            for label, share in shares.items():
                row.update(spread(f"probability of {label} ({scale})", share))
        for order in ("first", "total") if own else ():
            for parameter, index in zip(found.parameters, getattr(own, order), strict=True):
                row.update(spread(f"{order}_order {parameter.name}", index))
    heads = list(dict.fromkeys(head for row in rows for head in row))
    return [{head: row.get(head) for head in heads} for row in rows]


def _table(found: Uncertainty) -> str:
    """The parameters; then of each quantity its scatter and its indices."""
    columns = [("parameter", ""), ("nominal", ".6g"), ("unit", ""), ("distribution (SI)", "")]
    rows: list[Any] = [(p.name, p.nominal, p.unit, p.distribution) for p in found.parameters]
    failed = sum(found.failed.values())
    title = (f"{found.title}: {len(found.designs)} designs by {found.method}, seed {found.seed}; "
             f"{found.evaluated} evaluated, {failed} of them without values")  # fmt: skip
    tables = [output.table_text(title, columns, rows)]
    for k in range(len(found.summaries)):
        tables += [_scatter(found.summaries[k]), _indices(found, k)]
    return "\n".join(table for table in tables if table)


def _scatter(one: Summary) -> str:
    """Mean, percentiles and probabilities of classes of one quantity."""
    from railride.units import headed

    nominal = "-" if isnan(one.nominal) else f"{one.nominal:#.4g}"
    rows = [("nominal design", nominal, "", ""), _row("mean", one.mean, "#.4g"),
            _row("standard deviation", one.deviation, "#.3g")]  # fmt: skip
    rows += [_row(f"{p:g} % of designs are below", at, "#.4g")
             for p, at in one.percentiles.items()]  # fmt: skip
    for scale, shares in one.classes.items():
        rows += [_row(f"probability of {label} ({scale}) [%]", share, ".2f", 100)
                 for label, share in shares.items() if share.value > 0]  # fmt: skip
    columns = [(headed(one.name, one.unit), ""), ("value", ">"),
               ("from", ">"), ("to, at 95 %", ">")]  # fmt: skip
    return output.table_text("Scatter", columns, rows)


def _indices(found: Uncertainty, k: int) -> str:
    """Sobol's indices of one quantity; nothing where it has none."""
    own = found.indices[k]
    if own is None:
        return ""
    ends = (("from", ">"), ("to, at 95 %", ">"))
    columns = [(found.summaries[k].name, ""), ("first order", ">"), *ends, ("total", ">"), *ends]
    rows = [
        (*_row(parameter.name, first, ".3f"), *_row("", total, ".3f")[1:])
        for parameter, first, total in zip(found.parameters, own.first, own.total, strict=True)
    ]
    return output.table_text("Share of the variance (Sobol's indices)", columns, rows)


def _row(name: str, estimate: Estimate, spec: str, factor: float = 1) -> tuple[str, ...]:
    """An estimate and the ends of its interval as cells; an end that is not known as a dash."""
    ends = (estimate.value, estimate.low, estimate.high)
    return (name, *("-" if isnan(x) else format(factor * x, spec) for x in ends))
