"""``railride modes``: natural frequencies, damping ratios and what moves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from railride.cli import options, output
from railride.cli.options import Arguments, build_model

if TYPE_CHECKING:
    from railride.modal import Mode

FORMATS = ("table", "json", "csv")


@output.exits_cleanly
def modes(
    vehicle: options.VehicleOption = "cati2024",
    segments: options.SegmentsOption = None,
    body: options.BodyOption = None,
    bending_frequency: options.FrequencyOption = None,
    joint_stiffness: options.StiffnessOption = None,
    bending_damping: options.DampingOption = None,
    format: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Natural frequencies, damping ratios and labelled mode shapes.

    Example:  railride modes --segments 2
    """
    given = Arguments()
    given.choice("--format", format, FORMATS)
    output.check_output(to)
    model = build_model(given, vehicle, segments, body, bending_frequency, joint_stiffness,
                        bending_damping)  # fmt: skip
    from railride import modal

    found = modal.modes(model)
    undamped = modal.undamped_frequencies(model.matrices())
    remarks = [*model.vehicle.remarks, *model.remarks]
    if format == "json":
        text = output.json_text({**as_json(found, undamped), "remarks": remarks})
    elif format == "csv":
        text = output.csv_text(as_json(found, undamped)["modes"])
    else:
        text = as_table(found, undamped)
    if format != "json":
        output.remark(remarks)
    output.write(text, to)


def as_json(found: Sequence[Mode], undamped: Any) -> dict[str, Any]:
    """The keys ``modes`` and ``undamped_hz``."""
    rows = [
        {"frequency_hz": m.frequency_hz, "damping_ratio": m.damping_ratio, "label": m.label}
        for m in found
    ]
    return {"modes": rows, "undamped_hz": undamped}


def as_table(found: Sequence[Mode], undamped: Any) -> str:
    """Modes as a table, the undamped frequencies below."""
    columns = [
        ("mode", ""),
        ("|λ|/2π [Hz]", ".4f"),
        ("damping ratio", ".4g"),
        ("energy share", ".0%"),
    ]
    rows = [(m.label, m.frequency_hz, m.damping_ratio, m.share) for m in found]
    listed = "  ".join(f"{f:.4f}" for f in undamped)
    return output.table_text("Modes", columns, rows) + f"Undamped, from K and M [Hz]:\n  {listed}\n"
