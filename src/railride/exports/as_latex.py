"""A LaTeX article: the derivation of ``railride derive``, the outputs' equations, and all names."""

from __future__ import annotations

import sympy as sp

from railride import __version__, report
from railride.exports.content import Content
from railride.markup import (
    Block,
    Heading,
    Paragraph,
    Table,
    continued,
    math,
    number,
    summands,
)

_LAW = r"y = Y_a \ddot q + Y_v \dot q + Y_d q + Y_w w + Y_{dw} \dot w + Y_f f"


@report.repeatable()
def written(content: Content) -> str:
    """The article's text."""
    subject = report.Subject(content.model, alone=False, form="latex")
    names = [output.name for output in content.outputs]
    blocks = report.vehicle_blocks(
        subject,
        f"Exported by railride {__version__}.",
        [*_outputs(content, set(subject.values)), *_names(content)],
        outputs=names,
        **report.entries(content.rows),
    )
    return report.render(blocks, subject.form)


def _outputs(content: Content, known: set[str]) -> list[Block]:
    """Every output by the signals, and parameters that stand in them alone."""
    q, w = content.linear.coordinates, content.linear.inputs
    signals = [*(s.ddot for s in q), *(s.dot for s in q), *q, *w, *(s.dot for s in w)]
    signals += content.linear.forces
    rows = sp.Matrix.hstack(*(Y.as_explicit() for Y in content.rows.values()))
    lines = []
    for i in range(rows.rows):
        terms = [
            _factored(rows[i, j]) * signal for j, signal in enumerate(signals) if rows[i, j] != 0
        ]
        lines.append(continued(_y(i), [text for term in terms for text in summands(term)]))
    values = [
        (f"${math(sp.Symbol(p.name))}$", number(p.value), p.unit, p.meaning)
        for p in content.parameters
        if p.name not in known
    ]
    columns = ("symbol", "value", "unit", "meaning")
    blocks: list[Block] = [
        Heading("Outputs"),
        Paragraph(f"Counted from their values at equilibrium, the outputs are ${_LAW}$:"),
        *report.stacked(lines),
    ]
    if values:
        blocks += [Paragraph("with"), Table(columns, values, figures=("value",))]
    return blocks


def _factored(entry: sp.Expr) -> sp.Expr:
    """2.5 m forward as 5/2, so that what is common stands out."""
    return sp.factor(sp.nsimplify(entry, rational=True))


def _y(i: int) -> str:
    return f"y_{{{i + 1}}}" if i > 8 else f"y_{i + 1}"


def _names(content: Content) -> list[Block]:
    """What the program calls the signals."""
    linear = content.linear
    quantities = (*content.coordinates, *content.inputs)
    symbols = [*linear.coordinates, *linear.inputs, *(w.dot for w in linear.inputs), *linear.forces]
    rows = [
        (f"${math(symbol)}$", f"`{quantity.name}`", quantity.unit, quantity.meaning)
        for symbol, quantity in zip(symbols, quantities, strict=True)
    ]
    rows += [
        (f"${_y(i)}$", f"`{output.name}`", output.unit, f"${output.latex}$")
        for i, output in enumerate(content.outputs)
    ]
    return [
        Heading("Names"),
        Paragraph("In programs and files the signals are called"),
        Table(("symbol", "name", "unit", "meaning"), rows),
    ]
