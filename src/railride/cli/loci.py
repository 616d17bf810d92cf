"""What ``railride modes --vary`` does: modes followed over a parameter, as text and picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from railride.cli import output
from railride.cli.options import Arguments

if TYPE_CHECKING:
    import pandas as pd

    from railride.vehicle import VehicleModel

BRANCHES_ABREAST = 5


def values(
    model: VehicleModel, name: str, first: str | None, last: str | None, count: int, *, log: bool
) -> dict[str, Any]:
    """The parameter and its values, SI: texts in its own unit."""
    import numpy as np

    from railride.loci import described

    symbol, unit, _ = described(model, name)
    given = Arguments()
    low, high = given.number("--from", first, unit), given.number("--to", last, unit)
    if None not in (low, high) and low >= high:
        given.faults.add("--from", f"{low:g}, and {high:g} for --to, in {unit or 'its own unit'}",
                         "a value below that of --to")  # fmt: skip
    elif low is not None and log and low <= 0:
        given.faults.add("--log", f"{low:g} {unit} for --from", "values above 0")
    given.check()
    return {symbol: (np.geomspace if log else np.linspace)(low, high, count)}


def result(model: VehicleModel, form: str, varied: dict[str, Any], plot: str | None) -> str:
    """The locus as text; its picture is drawn."""
    from railride.loci import mode_locus

    locus = mode_locus(model, **varied)
    if plot is not None:
        from railride import plots

        plots.save(plots.plot_loci(locus), plot)
    rows = [] if form == "table" else locus.to_dict("records")
    name = locus.attrs["parameter"]
    document = {"parameter": name, "unit": locus.attrs["unit"], "locus": rows}
    return output.result(form, document, rows, lambda: _table(locus),
                         [*model.vehicle.remarks, *model.remarks])  # fmt: skip


def _table(locus: pd.DataFrame) -> str:
    """Frequency and damping ratio of every branch at every value, some branches abreast."""
    name, unit = locus.attrs["parameter"], locus.attrs["unit"]
    values = locus[name].unique().tolist()
    branches = dict(list(locus.groupby("branch")))
    tables = []
    for start in range(0, len(branches), BRANCHES_ABREAST):
        some = dict(list(branches.items())[start : start + BRANCHES_ABREAST])
        columns = [(f"{name}\n[{unit}]" if unit else name, ".6g")]
        cells = []
        for number, rows in some.items():
            labels = list(dict.fromkeys(rows["label"]))
            columns.append((f"{number} {labels[0]}" + (" …" if labels[1:] else ""), ">"))
            entries = zip(rows["frequency_hz"], rows["damping_ratio"], strict=True)
            cells.append(dict(zip(rows[name], (f"{f:.4f} {z:7.4f}" for f, z in entries),
                                  strict=True)))  # fmt: skip
        listed = [(value, *(cell.get(value, "–") for cell in cells)) for value in values]
        title = f"Modes over {name}: |λ|/2π [Hz] and damping ratio of each branch"
        tables.append(output.table_text(title if not start else "Modes, continued", columns,
                                        listed))  # fmt: skip
    return "\n".join(tables)
