"""A Python module that needs numpy alone: the matrices as functions of the parameters.

``PARAMETERS`` (name → value) and ``COORDINATES``, ``ELEVATIONS``, ``RATES``, ``FORCES``,
``INPUTS``, ``OUTPUTS`` and ``STATES`` (name → unit) stand in order, meanings as comments. The
function ``matrices(**parameters)`` gives M, C, K, K_w, C_w, B_f, Y_a, Y_v, Y_d, Y_w, Y_dw and Y_f
by name, ``state_space(**parameters)`` A, B, C and D of x' = A x + B u, y = C x + D u with
u = (w, ẇ, f), the states as in ``railride.firstorder``. Parameters that others define
(``DEFINED``) follow them unless they are given; those that railride calculates by an algorithm stay
as they were at the export.
"""

from __future__ import annotations

import json
import keyword
import textwrap
from collections.abc import Sequence

import numpy as np
import sympy as sp
from sympy.printing.pycode import PythonCodePrinter

from railride.exports import arrays, source
from railride.exports.content import Content, Quantity
from railride.exports.names import Names

NAMES = Names(
    frozenset(keyword.kwlist)
    | frozenset("math np p parameters unknown M C K K_w C_w B_f Y_a Y_v Y_d Y_w Y_dw Y_f".split())
)
"""Python's keywords, and the words of the function in which the parameters are variables."""


class _Printer(PythonCodePrinter):
    """Floating numbers to their last digit."""

    def _print_Float(self, number: sp.Float) -> str:
        return repr(float(number))


def written(content: Content) -> str:
    """The module's text."""
    lines = [*_records(content), *_matrices(content), *_state_space(content)]
    imports = ["import math", ""] if any("math." in line for line in lines) else []
    head = _HEAD.format(title=source.title(content))
    said = [line for text in source.origin(content) for line in _comment(text, "")]
    return "\n".join([head, *said, *imports, "import numpy as np", "", *lines])


_HEAD = '''"""{title}

    M q'' + C q' + K q = K_w w + C_w w' + B_f f
    y = Y_a q'' + Y_v q' + Y_d q + Y_w w + Y_dw w' + Y_f f

q are the COORDINATES, counted from static equilibrium; w the ELEVATIONS of the track under the
wheelsets, w' their RATES, f the FORCES of the actuators; y the OUTPUTS. SI units; numbered from
the front, x forward from the middle of the car body, z up, pitch positive nose-up.

Needs numpy. Parameters change by name: matrices(k_2=6e5), state_space(k_2=6e5).
"""
'''


def _records(content: Content) -> list[str]:
    """The parameters' values, then every axis of the matrices."""
    free, following, defined = source.parameters(content)
    names = arrays.names(content)
    states = zip(names["states"], names["state_units"], strict=True)
    note = [f"    # {source.FOLLOWING}"] if following else []
    lines = [
        "PARAMETERS = {",
        *(line for p in free for line in _lines(p.name, p.value, p.unit, p.meaning)),
        *note,
        *(line for p in following for line in _lines(p.name, p.value, p.unit, p.meaning)),
        "}",
        "# Those that the others define, in matrices(), unless they are given.",
    ]
    axes: dict[str, Sequence[Quantity]] = {
        "defined": defined,
        **source.axes(content),
        "states": [Quantity(name, unit, "") for name, unit in states],
    }
    for title, quantities in axes.items():
        own = [line for q in quantities for line in _lines(q.name, q.unit, q.meaning)]
        head = f"{title.upper()} = {{"
        lines += [head, *own, "}"] if own else [f"{head}}}"]
    return [*lines, "INPUTS = {**ELEVATIONS, **RATES, **FORCES}", ""]


def _lines(name: str, value: object, *said: str) -> list[str]:
    """``"name": value,  # said``, what is said before it where it does not fit beside."""
    entry, comment = f"    {json.dumps(name)}: {json.dumps(value)},", ", ".join(filter(None, said))
    beside = f"{entry}  # {comment}" if comment else entry
    return [beside] if len(beside) <= source.WIDTH else [*_comment(comment, "    "), entry]


def _comment(text: str, indent: str) -> list[str]:
    return textwrap.wrap(text, source.WIDTH, initial_indent=f"{indent}# ",
                         subsequent_indent=f"{indent}#   ", break_long_words=False,
                         break_on_hyphens=False)  # fmt: skip


def _matrices(content: Content) -> list[str]:
    """The function ``matrices``."""
    show, name = _Printer({"fully_qualified_modules": True}).doprint, NAMES.written
    free, following, defined = source.parameters(content)
    lines = _MATRICES.split("\n")
    lines += [f"    {name(p.name)} = p[{json.dumps(p.name)}]" for p in (*free, *following)]
    for p in defined:
        value = show(source.renamed(p.definition, name))
        own = f"p.get({json.dumps(p.name)}, {value})"
        lines += source.assignments([name(p.name)], own)
    for matrix, values in source.entries(content.matrices, name).items():
        lines += ["", f"    {matrix} = np.zeros({content.matrices[matrix].shape})"]
        for value, places in values.items():
            targets = [f"{matrix}[{i}, {j}]" for i, j in places]
            lines += source.assignments(targets, show(value))
    named = " ".join(f'"{matrix}": {matrix},' for matrix in content.matrices)
    result = [f"        {line}" for line in textwrap.wrap(named, 80)]
    return [*lines, "", "    return {", *result, "    }", ""]


_MATRICES = '''
def matrices(**parameters):
    """M, C, K, K_w, C_w, B_f, and Y_a, Y_v, Y_d, Y_w, Y_dw, Y_f of the outputs, by name."""
    unknown = [name for name in parameters if name not in {**PARAMETERS, **DEFINED}]
    if unknown:
        raise TypeError(f"unknown parameters: {', '.join(unknown)}")
    p = {**PARAMETERS, **parameters}'''


def _state_space(content: Content) -> list[str]:
    """The function ``state_space``; coordinates without mass are states without rates."""
    inertial = content.dynamics.inertial
    own, rest = (np.flatnonzero(chosen).tolist() for chosen in (inertial, ~inertial))
    return [_STATE_SPACE.format(own=own, rest=rest, massless=_MASSLESS if rest else "")]


_STATE_SPACE = '''
def state_space(**parameters):
    """A, B, C and D of x' = A x + B u, y = C x + D u with x the STATES, u the INPUTS."""
    m = matrices(**parameters)
    F = np.hstack([m["K_w"], m["C_w"], m["B_f"]])  # M q'' + C q' + K q = F u
    own, rest = {own}, {rest}  # coordinates with mass and without
    n, s = len(COORDINATES), len(STATES)
    q_x, v_x, a_x = np.zeros((3, n, s))  # q = q_x x, q' = v_x x + v_u u, q'' = a_x x + a_u u
    v_u, a_u = np.zeros((2, n, len(INPUTS)))
    q_x[own + rest, np.arange(n)] = 1
    v_x[own, np.arange(n, s)] = 1
{massless}    M = m["M"][np.ix_(own, own)]
    a_x[own] = np.linalg.solve(M, -m["C"][own] @ v_x - m["K"][own] @ q_x)
    a_u[own] = np.linalg.solve(M, F[own] - m["C"][own] @ v_u)
    A = np.vstack([v_x[own + rest], a_x[own]])
    B = np.vstack([v_u[own + rest], a_u[own]])
    C = m["Y_a"] @ a_x + m["Y_v"] @ v_x + m["Y_d"] @ q_x
    D = np.hstack([m["Y_w"], m["Y_dw"], m["Y_f"]]) + m["Y_a"] @ a_u + m["Y_v"] @ v_u
    return A, B, C, D
'''

_MASSLESS = """    C_rest = m["C"][np.ix_(rest, rest)]
    v_x[rest] = np.linalg.solve(C_rest, -m["C"][rest] @ v_x - m["K"][rest] @ q_x)
    v_u[rest] = np.linalg.solve(C_rest, F[rest])
"""
