"""The export as LaTeX: its equations read back as numbers, the derivation around them as it is."""

from __future__ import annotations

import json
import re
from functools import cache

import numpy as np
import pytest
import sympy as sp
from export_cases import content
from read_latex import equations, value

from railride.exports.write import export_content
from railride.report import vehicle_document

KINDS = pytest.mark.parametrize("kind", ["segments", "mounts", "beam"])


@cache
def text_of(kind):
    return export_content(content(kind), "latex")


def section(text, heading):
    """What stands below a heading."""
    return text.partition(f"\\section*{{{heading}}}\n")[2].partition("\\section*{")[0]


@KINDS
def test_the_outputs_read_back_give_their_matrices(kind):
    """y at any q̈, q̇, q, w, ẇ, f."""
    own = content(kind)
    found = [
        (left, right)
        for formula in re.findall(r"\\fitted\{(.*)\}\n\\\]", section(text_of(kind), "Outputs"))
        for left, right in equations(formula)
    ]
    assert [re.sub("[{}]", "", left) for left, _ in found] == [
        f"y_{i}" for i in range(1, len(own.outputs) + 1)
    ]
    q, w, f = own.linear.coordinates, own.linear.inputs, own.linear.forces
    axes = {"Y_a": [s.ddot for s in q], "Y_v": [s.dot for s in q], "Y_d": q, "Y_w": w,
            "Y_dw": [s.dot for s in w], "Y_f": f}  # fmt: skip
    signals = [s for of in axes.values() for s in of]
    drawn = np.random.default_rng(1).normal(size=len(signals))
    numbers = {s.name: number for s, number in zip(signals, drawn, strict=True)}
    expected = sum(own.numbers[name] @ [numbers[s.name] for s in of] for name, of in axes.items())
    numbers |= {p.name: p.value for p in own.parameters}
    read = [value(right, numbers) for _, right in found]
    assert read == pytest.approx(expected, rel=1e-9)


@KINDS
def test_the_derivation_is_that_of_derive(kind):
    """All of it but what made it, in its order."""
    document = vehicle_document(content(kind).model, "latex").replace("\n }\n}\n", "\n },\n")
    made, *others = (line for line in document.splitlines() if line.startswith("Made by"))
    assert not others
    exported = iter(text_of(kind).splitlines())
    assert all(line == made or line in exported for line in document.splitlines())


@KINDS
def test_a_program_reads_the_outputs(kind):
    own = content(kind)
    code = text_of(kind).partition("\\begin{lstlisting}\n")[2].partition("\n\\end{lstlisting}")[0]
    read, values = json.loads(code), {p.name: p.value for p in own.parameters}
    assert read["outputs"] == [output.name for output in own.outputs]
    for name, Y in own.rows.items():
        assert read[name].keys() == {f"{i},{j}" for i, j in Y.todok()}
        for place, entry in read[name].items():
            i, j = map(int, place.split(","))
            found = sp.sympify(entry, {symbol: sp.Symbol(symbol) for symbol in values})
            assert float(found.subs(values)) == pytest.approx(own.numbers[name][i, j], rel=1e-12)


def test_all_names_are_told():
    own, names = content("beam"), section(text_of("beam"), "Names")
    for quantity in (*own.coordinates, *own.elevations, *own.rates, *own.forces, *own.outputs):
        assert rf"\texttt{{{quantity.name}}}".replace("_", r"\_") in names
    for row in (r"$\dot w_1$ & \texttt{dw\_1} & m/s &", r"$f_1$ & \texttt{f\_1} & N &",
                r"$y_1$ & \texttt{floor\_acceleration} & m/s\textasciicircum{}2 &"):  # fmt: skip
        assert row in names
    values = section(text_of("beam"), "Outputs")
    assert "$-1.02582$ &  & shape of mode 1, floor at 2.5 m" in values
