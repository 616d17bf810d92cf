"""``railride derive``: the equations of motion, from the energies to numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.modes import as_json, as_table
from railride.cli.options import Arguments, build_model

if TYPE_CHECKING:
    from railride.linear import LinearModel
    from railride.vehicle import VehicleModel

FORMATS = ("table", "json", "csv", "markdown", "latex")
SYSTEMS = ("vehicle", "half-body", "half-body-free")
SYMBOLIC = ("M", "C", "K", "K_w", "C_w")


@output.exits_cleanly
def derive(
    vehicle: options.VehicleOption = "cati2024",
    segments: options.SegmentsOption = None,
    body: options.BodyOption = None,
    bending_frequency: options.FrequencyOption = None,
    joint_stiffness: options.StiffnessOption = None,
    bending_damping: options.DampingOption = None,
    system: Annotated[
        str,
        typer.Option(
            metavar="|".join(SYSTEMS),
            rich_help_panel=options.BODY,
            help="Derive this: the vehicle, or the paper's car body of two halves with its "
            "ends held, or free (as markdown or latex).",
        ),
    ] = "vehicle",
    nonlinear: Annotated[
        bool, typer.Option("--nonlinear", help="Add the nonlinear equations of motion.")
    ] = False,
    format: Annotated[
        str,
        typer.Option(
            metavar="|".join(FORMATS),
            rich_help_panel=options.RESULT,
            help="How the result is written.",
        ),
    ] = "table",
    to: options.OutputOption = None,
) -> None:
    """Derive and linearise: coordinates, energies, equations, matrices, natural frequencies.

    Example:  railride derive --segments 4
    """  # fmt: skip
    given = Arguments()
    given.choice("--format", format, FORMATS)
    given.choice("--system", system, SYSTEMS)
    if system.startswith("half-body") and format not in ("markdown", "latex"):
        given.faults.add(f"--system {system}", f"--format {format}", "markdown or latex")
    output.check_output(to)
    if system.startswith("half-body"):
        given.check()
        from railride import report

        output.write(report.half_body_document(system == "half-body-free", format), to)
        return
    model = build_model(given, vehicle, segments, body, bending_frequency, joint_stiffness,
                        bending_damping)  # fmt: skip
    remarks = [*model.vehicle.remarks, *model.remarks]
    if format != "json":
        output.remark(remarks)
    output.write(_as_text(model, format, nonlinear, remarks), to)


def _as_text(model: VehicleModel, format: str, nonlinear: bool, remarks: list[str]) -> str:
    import sympy as sp

    if format in ("markdown", "latex"):
        from railride import report

        return report.vehicle_document(model, format, nonlinear=nonlinear)
    linear = model.linear.map(sp.factor)
    if format == "json":
        return output.json_text({**_as_json(model, linear, nonlinear), "remarks": remarks})
    if format == "csv":
        return _as_csv(model, linear)
    return _as_table(model, linear, nonlinear)


def _as_json(model: VehicleModel, linear: LinearModel, nonlinear: bool) -> dict[str, Any]:
    from railride import modal

    values, numbers = model.values(), model.matrices()
    written: dict[sp_Expr, str] = {}

    def string(e: sp_Expr) -> str:
        return written.setdefault(e, str(e)) if e not in written else written[e]

    document = {
        "segments": model.body.segments,
        "coordinates": [q.name for q in linear.coordinates],
        "parameters": {name: float(value) for name, value in values.items()},
        "joint_stiffness": float(values["k_theta"]) if "k_theta" in values else None,
        **{name: getattr(numbers, name) for name in SYMBOLIC},
        "symbolic": {
            name: [[string(e) for e in row] for row in linear.matrices[name].tolist()]
            for name in SYMBOLIC
        },
        **as_json(modal.modes(model), modal.undamped_frequencies(numbers)),
    }
    if nonlinear:
        document["nonlinear"] = [str(e) for e in model.lagrangian.equations()]
    return document


sp_Expr = Any  # noqa: N816 - sympy is loaded when it is needed


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
    units = {p.symbol.name: (p.meaning, p.unit) for p in model.parameters}
    units |= {"k_theta": ("joint stiffness", "N m/rad"), "c_theta": ("joint damping", "N m s/rad")}
    columns = [("symbol", ""), ("value", ".6g"), ("unit", ""), ("meaning", "")]
    rows = [
        (text.symbol(_symbol(name)), float(value), *reversed(units.get(name, ("", ""))))
        for name, value in values.items()
    ]
    parts = [
        f"{model.vehicle.name}: {_count(model.body.segments)}, "
        f"{len(linear.coordinates)} degrees of freedom",
        output.table_text("Parameters", columns, rows).rstrip(),
        "Energies\n" + text.energies(model.lagrangian),
    ]
    if nonlinear:
        parts.append("Nonlinear equations of motion\n" + text.equations(model.lagrangian))
    parts.append("Linear equations of motion\n" + text.matrices(linear))
    found = modal.modes(model), modal.undamped_frequencies(model.matrices())
    parts.append(as_table(*found))
    return "\n\n".join(parts)


def _count(segments: int) -> str:
    return "a rigid car body" if segments == 1 else f"a car body of {segments} rigid segments"


def _symbol(name: str) -> Any:
    from sympy import Symbol

    return Symbol(name)
