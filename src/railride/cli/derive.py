"""``railride derive``: the equations of motion, from the energies to numbers."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.modes import as_json, as_table
from railride.cli.options import Arguments
from railride.cli.progress import working
from railride.cli.vehicle import VehicleChoice, takes_vehicle

if TYPE_CHECKING:
    from railride.linear import LinearModel
    from railride.vehicle import VehicleModel

FORMATS = (*options.FORMATS, "markdown", "latex")
SYSTEMS = ("vehicle", "body", "half-body", "half-body-free")
DOCUMENTS = {"markdown": ".svg", "latex": ".pdf"}  # and the kind of picture that they can show
SYMBOLIC = ("M", "C", "K", "K_w", "C_w")


@output.exits_cleanly
@takes_vehicle
def derive(
    choice: VehicleChoice,
    system: Annotated[
        str,
        typer.Option(
            metavar="|".join(SYSTEMS),
            rich_help_panel=options.BODY,
            help="Derive this: the vehicle; its car body alone, free; or the paper's car body "
            "of two halves with its ends held, or free (all but the vehicle as markdown or "
            "latex).",
        ),
    ] = "vehicle",
    nonlinear: Annotated[
        bool,
        typer.Option(
            "--nonlinear",
            rich_help_panel=options.RESULT,
            help="Add the nonlinear equations of motion.",
        ),
    ] = False,
    form: Annotated[
        str,
        typer.Option(
            "--format",
            metavar="|".join(FORMATS),
            rich_help_panel=options.RESULT,
            help="How the result is written.",
        ),
    ] = "table",
    to: options.OutputOption = None,
) -> None:
    """Derive and linearise: coordinates, energies, equations, matrices, natural frequencies.

    Example:  railride derive --segments 4

    As a document, with a picture beside it:  railride derive --format markdown --output coach.md
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.choice("--system", system, SYSTEMS)
    if nonlinear and form == "csv":
        given.faults.add("--nonlinear", "--format csv with it", "a format that holds equations: "
                         "table, json, markdown or latex")  # fmt: skip
    if system != "vehicle" and form not in DOCUMENTS:
        given.faults.add(f"--system {system}", f"--format {form}", "markdown or latex")
    picture = _picture(form, to)
    given.writes({"--output": to, "--output, its picture": picture},
                 {"--vehicle": choice.vehicle})  # fmt: skip
    if system.startswith("half-body"):
        _write_half_body(given, system, form, nonlinear, choice.given(), to, picture)
        return
    with working("deriving"):
        model = choice.model(given)
        remarks = [*model.vehicle.remarks, *model.remarks]
        alone = system == "body"
        text = (
            _as_document(model, form, nonlinear, alone, to, picture)
            if form in DOCUMENTS
            else _as_text(model, form, nonlinear, remarks)
        )
    output.deliver(text, to, remarks)


def _picture(form: str, to: str | None) -> str | None:
    """The file of a document's picture, beside it: vehicle.md has vehicle_coordinates.svg.

    None for a document that goes to standard output or into a pipe, and so has no place.
    """
    if (
        form not in DOCUMENTS
        or not to
        or "\0" in to
        or (Path(to).exists() and not Path(to).is_file())
    ):
        return None
    return str(Path(to).with_name(f"{Path(to).stem}_coordinates{DOCUMENTS[form]}"))


def _name(path: str | None) -> str:
    """A file's own name; none for no file."""
    return "" if path is None else Path(path).name


def _as_document(model: VehicleModel, form: str, nonlinear: bool, alone: bool, to: str | None,
                 picture: str | None) -> str:  # fmt: skip
    """The derivation as a document; its picture is drawn beside it."""
    from railride import report

    text = report.vehicle_document(model, form, nonlinear, alone=alone, figure=_name(picture),
                                   document=_name(to) if picture else "")  # fmt: skip
    if picture is not None:
        from railride import plots

        draw = plots.plot_body_coordinates if alone else plots.plot_coordinates
        plots.save(draw(model), picture)
    return str(text)


def _write_half_body(
    given: Arguments, system: str, form: str, nonlinear: bool, needless: Sequence[str],
    to: str | None, picture: str | None,
) -> None:  # fmt: skip
    """The paper's two halves, which have symbols only and no vehicle."""
    for option in needless:
        given.conflict(option, f"--system {system}")
    if nonlinear:
        given.faults.add("--nonlinear", f"--system {system} with it", "one of the two",
                         "its document has the nonlinear equations as it is")  # fmt: skip
    given.check()
    from railride.halfbody_report import half_body_document

    free = system == "half-body-free"
    text = half_body_document(free, form, _name(picture), _name(to) if picture else "")
    if picture is not None:
        from railride import plots

        plots.save(plots.plot_half_body(free), picture)
    output.write(text, to)


def _as_text(model: VehicleModel, form: str, nonlinear: bool, remarks: list[str]) -> str:
    import sympy as sp

    linear = model.linear.map(sp.together)  # reads best, and is far quicker than factor
    if form == "json":
        return output.json_text({**_as_json(model, linear, nonlinear), "remarks": remarks})
    if form == "csv":
        return _as_csv(model, linear)
    return _as_table(model, linear, nonlinear)


def _as_json(model: VehicleModel, linear: LinearModel, nonlinear: bool) -> dict[str, Any]:
    from railride import modal

    values, numbers = model.values(), model.matrices()
    string = cache(str)  # most entries stand in a matrix several times
    document = {
        "body": model.body.kind,
        "segments": model.body.segments,
        "body_modes": model.body.mode_count,
        "coordinates": [q.name for q in linear.coordinates],
        "parameters": {name: float(value) for name, value in values.items()},
        "joint_stiffness": float(values["k_theta"]) if "k_theta" in values else None,
        **{name: getattr(numbers, name) for name in SYMBOLIC},
        "symbolic": {
            name: [[string(e) for e in row] for row in linear.matrices[name].tolist()]
            for name in SYMBOLIC
        },
        **as_json(model, modal.modes(model), modal.undamped_frequencies(numbers)),
    }
    if nonlinear:
        document["nonlinear"] = [str(e) for e in model.lagrangian.equations()]
    return document


def _as_csv(model: VehicleModel, linear: LinearModel) -> str:
    numbers = model.matrices()
    across = {"K_w": linear.inputs, "C_w": linear.inputs, "B_f": linear.forces}
    return output.csv_text([
        {
            "matrix": name,
            "row": linear.coordinates[i].name,
            "column": across.get(name, linear.coordinates)[j].name,
            "value": float(getattr(numbers, name)[i, j]),
            "symbolic": str(e),
        }
        for name, A in linear.matrices.items()
        for (i, j), e in sorted(A.todok().items())
    ])  # fmt: skip


def _as_table(model: VehicleModel, linear: LinearModel, nonlinear: bool) -> str:
    from railride import modal, text

    values = model.values()
    meanings = {name: said for name, said in model.meanings.items() if any(said)}
    dependent = ("follows from the others", "")
    columns = [("symbol", ""), ("value", ".6g"), ("unit", ""), ("meaning", "")]
    rows = [
        (text.symbol(_symbol(name)), float(value), *reversed(meanings.get(name, dependent)))
        for name, value in values.items()
    ]
    degrees = f"{len(linear.coordinates)} degrees of freedom"
    parts = [
        f"{model.vehicle.name}: {model.body.phrase}, {degrees}",
        output.table_text("Parameters", columns, rows).rstrip(),
        "Energies\n\n" + text.energies(model.lagrangian),
    ]
    if nonlinear:
        parts.append("Nonlinear equations of motion\n\n" + text.equations(model.lagrangian))
    parts.append("Linear equations of motion\n\n" + text.matrices(linear))
    found = modal.modes(model), modal.undamped_frequencies(model.matrices())
    parts.append(as_table(*found))
    return "\n\n".join(parts)


def _symbol(name: str) -> Any:
    from sympy import Symbol

    return Symbol(name)
