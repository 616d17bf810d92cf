"""A Modelica package: the vehicle's equations as they stand on paper, its parameters with units.

The package, named after the vehicle, needs no library. It holds

- ``RealInput`` and ``RealOutput``, connectors that fit those of the Modelica Standard Library;
- ``Coach``: the parameters, the coordinates q with their rates dq and accelerations ddq, the inputs
  w_1 …, dw_1 …, f_1 …, the outputs, and one equation of second order for each coordinate (of first
  order for a coordinate without mass). Its states start at zero, the static equilibrium;
- with a track, ``Track``, ``Weighting`` and ``Ride`` (see ``railride.exports.modelica_ride``).

Names are written as ``railride.exports.names`` says.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from itertools import chain

import sympy as sp

from railride.exports import source
from railride.exports.content import Content, Quantity
from railride.exports.modelica import LONG, NAMES, declared, expression, indented, number, titled
from railride.exports.modelica_ride import ride
from railride.exports.setup import Setup

SHORT = 72  # an equation that stands on one line


def written(content: Content, setup: Setup | None = None) -> str:
    """The package's text; with a ``setup``, the ride over its track as well."""
    name = NAMES.written(content.name)
    lines = [
        "within ;",
        *titled("package", name, source.title(content)),
        *_head(content, () if setup is None else setup.remarks),
        *_CONNECTORS,
    ]
    lines += indented(coach(content))
    if setup is not None:
        lines += indented(ride(content, setup))
    return "\n".join([*lines, f"end {name};", ""])


def _head(content: Content, remarks: Iterable[str]) -> list[str]:
    """What the package is, as comments."""
    said = [
        *source.origin(content, remarks),
        ("SI units; x forward from the middle of the car body, z up, pitch positive nose-up; "
        "numbered from the front. Displacements count from static equilibrium."),
    ]  # fmt: skip
    return [f"  // {line}" for text in said for line in textwrap.wrap(text, 94)]


_CONNECTORS = """
  connector RealInput = input Real "Signal that comes in";
  connector RealOutput = output Real "Signal that goes out";
""".splitlines()


def coach(content: Content) -> list[str]:
    """The model ``Coach``."""
    equations = "M*der(der(q)) + C*der(q) + K*q = K_w*w + C_w*der(w) + B_f*f"
    return [
        "",
        f'model Coach "{equations}"',
        *indented([
            *_parameters(content),
            *_connectors(content),
            *_coordinates(content),
        ]),
        "equation",
        *indented([*_kinematics(content), *_motion(content), *_outputs(content)]),
        "end Coach;",
    ]  # fmt: skip


def _parameters(content: Content) -> list[str]:
    free, following, defined = source.parameters(content)
    note = [f"// {source.FOLLOWING}"] if following else []
    kind = "parameter Real"
    return [
        *chain(*(declared(kind, p, value=number(p.value)) for p in free)),
        *chain(*(declared(kind, p, value=expression(p.definition)) for p in defined)),
        *note,
        *chain(*(declared(kind, p, value=number(p.value)) for p in following)),
    ]


def _connectors(content: Content) -> list[str]:
    return [
        *chain(*(declared("RealInput", u) for u in content.inputs)),
        *chain(*(declared("RealOutput", y) for y in source.axes(content)["outputs"])),
    ]


def _coordinates(content: Content) -> list[str]:
    lines = []
    inertial = content.dynamics.inertial
    for q, own in zip(content.coordinates, inertial, strict=True):
        rate, second = Quantity(f"d{q.name}", f"{q.unit}/s", ""), Quantity(
            f"dd{q.name}", f"{q.unit}/s^2", "")  # fmt: skip
        start = "start = 0, fixed = true"
        lines += declared("Real", q, start)
        lines += declared("Real", rate, start if own else "")
        if own:
            lines += declared("Real", second)
    return lines


def _kinematics(content: Content) -> list[str]:
    lines = []
    for q, own in zip(content.coordinates, content.dynamics.inertial, strict=True):
        names = [NAMES.written(f"{d}{q.name}") for d in ("", "d", "dd")]
        lines.append(f"der({names[0]}) = {names[1]};")
        if own:
            lines.append(f"der({names[1]}) = {names[2]};")
    return lines


def _motion(content: Content) -> list[str]:
    """One equation for each coordinate: inertia, dampers, springs = track, actuators."""
    A = content.matrices
    q, w, f = content.coordinates, content.elevations, content.forces
    lines = []
    for i, own in enumerate(q):
        left = [_row(A["M"], i, q, "dd"), _row(A["C"], i, q, "d"), _row(A["K"], i, q)]
        right = [_row(A["K_w"], i, w), _row(A["C_w"], i, w, "d"), _row(A["B_f"], i, f)]
        lines += [f"// {own.name}: {own.meaning}", *_equation(left, right)]
    return lines


def _outputs(content: Content) -> list[str]:
    A = content.rows
    q, w, f = content.coordinates, content.elevations, content.forces
    lines = ["// Outputs"]
    for i, output in enumerate(content.outputs):
        right = [
            _row(A["Y_a"], i, q, "dd"), _row(A["Y_v"], i, q, "d"), _row(A["Y_d"], i, q),
            _row(A["Y_w"], i, w), _row(A["Y_dw"], i, w, "d"), _row(A["Y_f"], i, f),
        ]  # fmt: skip
        lines += _equation([[NAMES.written(output.name)]], right)
    return lines


def _row(A: sp.MatrixBase, i: int, of: Sequence[Quantity], dots: str = "") -> list[str]:
    """The terms of row i of A times the signals ``of``, or their rates."""
    return [
        _term(A[i, j], NAMES.written(f"{dots}{s.name}")) for j, s in enumerate(of) if A[i, j] != 0
    ]


def _term(coefficient: sp.Expr, signal: str) -> str:
    """``coefficient*signal``."""
    if coefficient in (1, -1):
        return signal if coefficient == 1 else f"-{signal}"
    text = expression(coefficient)
    return f"({text})*{signal}" if coefficient.is_Add else f"{text}*{signal}"


def _equation(left: Sequence[list[str]], right: Sequence[list[str]]) -> list[str]:
    """``left = right;``: on one line where it fits, else each group of terms on its own."""
    lines: list[str] = []
    for side, mark in ((left, ""), (right, "= ")):
        words = [word for terms in side for word in terms] or ["0"]
        groups = [terms for terms in side if terms] or [["0"]]
        for terms in groups:
            pieces = [part for term in terms for part in _parts(_signed(term, term is words[0]))]
            lead = mark if terms is groups[0] else ""
            lines += source.folded([lead + pieces[0].lstrip(), *pieces[1:]], LONG, "  ")
    lines[0] = lines[0].lstrip()
    whole = " ".join(line.strip() for line in lines) + ";"
    return [whole] if len(whole) <= SHORT else [*lines[:-1], f"{lines[-1]};"]


def _signed(term: str, first: bool) -> str:
    """A term with its sign before it, which only a sum's first one may go without."""
    if first:
        return term
    return f"- {term[1:]}" if term.startswith("-") else f"+ {term}"


def _parts(term: str) -> list[str]:
    """A term that follows others, cut where it is too long to stand on one line."""
    return [f" {term}"] if len(term) <= SHORT else source.terms(f" {term}")
