"""``railride modes``: natural frequencies, damping ratios and what moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from railride.cli import options, output
from railride.cli.options import FORMATS, Arguments, build_model
from railride.cli.progress import working

if TYPE_CHECKING:
    from railride.modal import Mode
    from railride.vehicle import VehicleModel

ABREAST = 7  # mode shapes beside one another in a table


@output.exits_cleanly
def modes(
    vehicle: options.VehicleOption = "cati2024",
    segments: options.SegmentsOption = None,
    body: options.BodyOption = None,
    bending_frequency: options.FrequencyOption = None,
    joint_stiffness: options.StiffnessOption = None,
    bending_damping: options.DampingOption = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Natural frequencies, damping ratios and labelled mode shapes.

    Example:  railride modes --segments 2
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    output.check_output(given.faults, "--output", to)
    given.separate({"--output": to}, {"--vehicle": vehicle})
    with working("deriving"):
        model = build_model(given, vehicle, segments, body, bending_frequency, joint_stiffness,
                            bending_damping)  # fmt: skip
        from railride import modal

        found = modal.modes(model)
        undamped = modal.undamped_frequencies(model.matrices())
    remarks = [*model.vehicle.remarks, *model.remarks]
    text = output.result(
        form,
        as_json(model, found, undamped),
        _flat(model, found),
        lambda: as_table(found, undamped) + "\n" + _shapes(model, found),
        remarks,
    )
    output.write(text, to)
    output.remark(remarks)


def as_json(model: VehicleModel, found: Sequence[Mode], undamped: Any) -> dict[str, Any]:
    """The keys ``modes`` and ``undamped_hz``; a shape is coordinate → [real, imaginary]."""
    names = [q.name for q in model.lagrangian.coordinates]
    rows = [
        {
            "frequency_hz": m.frequency_hz,
            "damping_ratio": m.damping_ratio,
            "label": m.label,
            "shape": {q: [x.real, x.imag] for q, x in zip(names, m.shape.tolist(), strict=True)},
        }
        for m in found
    ]
    return {"modes": rows, "undamped_hz": undamped}


def as_table(found: Sequence[Mode], undamped: Any) -> str:
    """Modes as a table, the undamped frequencies below."""
    import textwrap

    columns = [("", "d"), ("mode", ""), ("|λ|/2π [Hz]", ".4f"), ("damping ratio", ".4g"),
               ("energy share", ".0%")]  # fmt: skip
    rows = [
        (number, m.label, m.frequency_hz, m.damping_ratio, m.share)
        for number, m in enumerate(found, start=1)
    ]
    listed = textwrap.fill("  ".join(f"{f:.4f}" for f in undamped), 100, initial_indent="  ",
                           subsequent_indent="  ")  # fmt: skip
    table = output.table_text("Modes", columns, rows)
    return f"{table}\nUndamped, from K and M [Hz]:\n{listed}\n"


def _shapes(model: VehicleModel, found: Sequence[Mode]) -> str:
    """Size and phase of every coordinate in every mode, some modes abreast."""
    from cmath import phase
    from math import degrees

    from railride.text import symbol

    def entry(x: complex) -> str:
        angle = round(degrees(phase(x)))
        return "0" if abs(x) < 5e-4 else f"{abs(x):.3f} ∠{180 if angle == -180 else angle:4d}°"

    tables = []
    for first in range(0, len(found), ABREAST):
        some = range(first, min(first + ABREAST, len(found)))
        rows = [
            (symbol(q), *(entry(complex(found[k].shape[i])) for k in some))
            for i, q in enumerate(model.lagrangian.coordinates)
        ]
        title = "Mode shapes, the largest entry 1 (heights in m, angles in rad)"
        columns = [("", ""), *((str(k + 1), ">") for k in some)]
        tables.append(output.table_text(title if not first else "Mode shapes, continued",
                                        columns, rows))  # fmt: skip
    return "\n".join(tables)


def _flat(model: VehicleModel, found: Sequence[Mode]) -> list[dict[str, Any]]:
    """One row per mode for CSV, two columns for each coordinate of its shape."""
    rows = as_json(model, found, ())["modes"]
    for row in rows:
        for name, (real, imaginary) in row.pop("shape").items():
            row |= {f"{name}_re": real, f"{name}_im": imaginary}
    return rows  # type: ignore[no-any-return]
