"""``railride modes``: natural frequencies, damping ratios and what moves, over a parameter too."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import loci, options, output
from railride.cli.options import FORMATS, Arguments
from railride.cli.progress import working
from railride.cli.vehicle import VehicleChoice, takes_vehicle
from railride.errors import InputError

if TYPE_CHECKING:
    from railride.modal import Mode
    from railride.vehicle import VehicleModel

ABREAST = 7  # mode shapes beside one another in a table
LOCUS, PICTURES = "Over a parameter", "Pictures"
MOST_POINTS, MOST_SHAPES = 5000, 60

VaryOption = Annotated[
    str | None, typer.Option("--vary", metavar="NAME", rich_help_panel=LOCUS,
                             help="Follow the modes over this parameter, such as c_2, instead.")
]  # fmt: skip
FromOption = Annotated[
    str | None, typer.Option("--from", metavar="VALUE", rich_help_panel=LOCUS,
                             help="Its first value, in SI units or as '10 kN*s/m'.")]  # fmt: skip
ToOption = Annotated[
    str | None, typer.Option("--to", metavar="VALUE", rich_help_panel=LOCUS,
                             help="Its last value.")]  # fmt: skip
PointsOption = Annotated[
    str | None, typer.Option("--points", metavar="N", rich_help_panel=LOCUS,
                             help="How many values, the two included; default 60.")]  # fmt: skip
LogOption = Annotated[
    bool, typer.Option("--log", rich_help_panel=LOCUS,
                       help="Space them evenly over the logarithm.")]  # fmt: skip
PlotOption = Annotated[
    str | None, typer.Option("--plot", metavar="FILE", rich_help_panel=PICTURES,
                             help="Draw the mode shapes, or with --vary root locus and damping, "
                             "into this PNG, PDF or SVG file.")]  # fmt: skip
AnimateOption = Annotated[
    str | None, typer.Option("--animate", metavar="FILE.gif", rich_help_panel=PICTURES,
                             help="Write one mode in motion as a GIF.")]  # fmt: skip
CountOption = Annotated[
    str | None, typer.Option("--count", metavar="N", rich_help_panel=PICTURES,
                             help="How many mode shapes to draw, the lowest; default 15 of those "
                             "that oscillate.")]  # fmt: skip
ModeOption = Annotated[
    str | None, typer.Option("--mode", metavar="N|LABEL", rich_help_panel=PICTURES,
                             help="Which mode: its number in the table, or its label; default 1 "
                             "to animate, all of the lowest to draw.")]  # fmt: skip


@output.exits_cleanly
@takes_vehicle
def modes(
    choice: VehicleChoice,
    vary: VaryOption = None,
    first: FromOption = None,
    last: ToOption = None,
    points: PointsOption = None,
    log: LogOption = False,
    plot: PlotOption = None,
    animate: AnimateOption = None,
    mode: ModeOption = None,
    shapes: CountOption = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Natural frequencies, damping ratios and labelled mode shapes.

    Example:  railride modes --segments 2

    Over a parameter:  railride modes --vary c_2 --from "10 kN*s/m" --to "200 kN*s/m"
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    given.writes(
        {"--output": to, "--plot": plot, "--animate": animate}, {"--vehicle": choice.vehicle}
    )
    _check_together(given, vary, {"--from": first, "--to": last, "--points": points,
                                  "--log": log or None}, animate, plot, mode, shapes)  # fmt: skip
    count = given.whole("--points", points or "60", 2, MOST_POINTS)
    drawn = given.whole("--count", shapes, 1, MOST_SHAPES)
    with working("deriving"):
        model = choice.model(given)
        remarks = [*model.vehicle.remarks, *model.remarks]
        if vary is not None:
            varied = loci.values(model, vary, first, last, count, log=log)
            text = loci.result(model, form, varied, plot)
        else:
            text = _modes(model, form, plot, animate, mode, drawn, remarks)
    output.deliver(text, to, remarks, plot, animate)


def _check_together(
    given: Arguments, vary: str | None, locus: dict[str, Any], animate: str | None,
    plot: str | None, mode: str | None, shapes: str | None,
) -> None:  # fmt: skip
    """Note options that lack the one they belong to, or have no business with it."""
    if shapes is not None and plot is None:
        given.faults.add("--count", "no --plot with it", "a picture to draw",
                         "such as --plot modes.png")  # fmt: skip
    if shapes is not None and mode is not None:
        given.conflict("--count", "--mode")
    if vary is None:
        for option in (option for option, value in locus.items() if value is not None):
            given.faults.add(option, "no --vary with it", "a parameter to vary",
                             "such as --vary c_2")  # fmt: skip
        if mode is not None and animate is None and plot is None:
            given.faults.add("--mode", "neither --plot nor --animate with it", "a picture to draw",
                             "such as --animate mode.gif")  # fmt: skip
        return
    for option in ("--from", "--to"):
        if locus[option] is None:
            given.faults.add("--vary", f"no {option} with it", "the range to vary it over",
                             'such as --from "10 kN*s/m" --to "200 kN*s/m"')  # fmt: skip
    for option, text in (("--animate", animate), ("--mode", mode), ("--count", shapes)):
        if text is not None:
            given.conflict("--vary", option)


def _modes(
    model: VehicleModel, form: str, plot: str | None, animate: str | None, mode: str | None,
    count: int | None, remarks: list[str],
) -> str:  # fmt: skip
    """The modes as text; pictures are drawn, and what they leave out is remarked on."""
    from railride import modal

    found = modal.modes(model)
    undamped = modal.undamped_frequencies(model.matrices())
    chosen = None if mode is None else [_chosen(found, mode)]
    if plot is not None or animate is not None:
        from railride import plots

        if plot is not None:
            many = plots.MOST_MODES if count is None else count
            plots.save(plots.plot_modes(model, chosen, count=many), plot)
            _, left = plots.chosen_modes(model, chosen, many)
            remarks += [f"--plot: {plots.left_out(left)}"] if left else []
        if animate is not None:
            plots.animate_mode(model, (chosen or found)[0], animate)
    return output.result(
        form,
        as_json(model, found, undamped),
        _flat(model, found),
        lambda: as_table(found, undamped) + "\n" + _shapes(model, found),
        remarks,
    )


def _chosen(found: Sequence[Mode], text: str) -> Mode:
    """The mode of a number in the table, or the only one of a label, its phase added if need be."""
    given = Arguments()
    if text.strip().isdecimal():
        number = given.whole("--mode", text.strip(), 1, len(found))
        given.check()
        return found[int(number) - 1]
    wanted = " ".join(text.lower().replace(",", " ").split())
    named = [(k, m) for k, m in enumerate(found, start=1)
             if wanted in {m.label, f"{m.label} {m.phase}"}]  # fmt: skip
    if len(named) == 1:
        return named[0][1]
    listed = ", ".join(
        f"{k} ({_named(m)}, {m.frequency_hz:.4g} Hz)" for k, m in named or enumerate(found, start=1)
    )
    what = f"{text!r}, of which there are {len(named)}" if named else repr(text)
    raise InputError(f"command line: --mode: found {what}; expected one of {listed} (its number)")


def as_json(model: VehicleModel, found: Sequence[Mode], undamped: Any) -> dict[str, Any]:
    """The keys ``modes`` and ``undamped_hz``; a shape is coordinate → [real, imaginary]."""
    names = [q.name for q in model.lagrangian.coordinates]
    rows = [
        {
            "frequency_hz": m.frequency_hz,
            "damping_ratio": m.damping_ratio,
            "label": m.label,
            "share": m.share,
            "phase": m.phase or None,
            "shape": {q: [x.real, x.imag] for q, x in zip(names, m.shape.tolist(), strict=True)},
        }
        for m in found
    ]
    return {"modes": rows, "undamped_hz": undamped}


def _named(mode: Mode) -> str:
    return f"{mode.label}, {mode.phase}" if mode.phase else mode.label


def as_table(found: Sequence[Mode], undamped: Any) -> str:
    """Modes as a table, the undamped frequencies below."""
    import textwrap

    columns = [("", "d"), ("mode", ""), ("|λ|/2π [Hz]", ".4f"), ("damping ratio", ".4g"),
               ("energy share", ".0%")]  # fmt: skip
    rows = [
        (number, _named(m), m.frequency_hz, m.damping_ratio, m.share)
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
