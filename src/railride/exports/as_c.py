"""C99 source, one file that needs math.h alone: the matrices as functions of the parameters.

With NAME the vehicle's name, ``NAME_parameters`` is a structure of the parameters,
``NAME_defaults`` holds their values, and ``NAME_follow`` sets those that others define.
``NAME_matrices`` fills M, C, K, K_w, C_w and B_f, ``NAME_outputs`` Y_a, Y_v, Y_d, Y_w, Y_dw and
Y_f. The sizes are macros, ``NAME_COORDINATES``, ``NAME_ELEVATIONS``, ``NAME_RATES``,
``NAME_FORCES``, ``NAME_OUTPUTS`` and ``NAME_PARAMETERS`` with NAME in capitals; the arrays of texts
``NAME_coordinate_names`` and so on tell what stands along the axes, ``NAME_parameter_names`` the
members of the structure in their order. There is no state space: it takes a solver for M.
"""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Mapping
from itertools import chain

import sympy as sp
from sympy.printing.c import C99CodePrinter, reserved_words, reserved_words_c99

from railride.exports import source
from railride.exports.content import Content, Quantity
from railride.exports.names import Names

NAMES = Names(frozenset(reserved_words) | frozenset(reserved_words_c99))
"""C's keywords."""

_HEAD = """/* {title}
{said} *
 *     M q'' + C q' + K q = K_w w + C_w w' + B_f f
 *     y = Y_a q'' + Y_v q' + Y_d q + Y_w w + Y_dw w' + Y_f f
 *
 * q are the coordinates, counted from static equilibrium; w the elevations of the track under the
 * wheelsets, w' their rates, f the forces of the actuators; y the outputs. SI units; numbered from
 * the front, x forward from the middle of the car body, z up, pitch positive nose-up.
 *
 *     {name}_parameters p = {name}_defaults;
 *     p.NAME = ...;
 *     {name}_follow(&p); // what the changed parameters define
 *     {name}_matrices(&p, M, C, K, K_w, C_w, B_f);
 */
#include <math.h>

#ifndef M_PI // is not part of C99
#define M_PI 3.14159265358979323846
#endif

static void {name}_zero(double *a, int count)
{{
    while (count-- > 0)
        *a++ = 0.0;
}}
"""


def written(content: Content) -> str:
    """The file's text."""
    name = NAMES.written(content.name)
    return "\n".join([
        _HEAD.format(title=source.title(content), said=_origin(content), name=name),
        *_axes(content, name),
        *_parameters(content, name),
        *_function("matrices", content.linear.matrices, name),
        *_function("outputs", content.rows, name),
    ])  # fmt: skip


def _origin(content: Content) -> str:
    """Lines of the comment at the head, in which none begins or ends."""
    texts = [re.sub(r"(?<=\*)(?=/)|(?<=/)(?=\*)", " ", text) for text in source.origin(content)]
    return "".join(f" * {line}\n" for text in texts for line in textwrap.wrap(text, 94))


def _axes(content: Content, name: str) -> list[str]:
    """Sizes and names along every axis."""
    axes = {**source.axes(content), "parameters": [*chain(*source.parameters(content))]}
    lines = [f"#define {name.upper()}_{axis.upper()} {len(axes[axis])}" for axis in axes]
    for axis, quantities in axes.items():
        size = f"{name.upper()}_{axis.upper()}"
        lines += ["", f"const char *const {name}_{axis[:-1]}_names[{size}] = {{"]
        lines += [f"    {json.dumps(q.name)}, // {_said(q)}" for q in quantities]
        lines.append("};")
    return lines


def _parameters(content: Content, name: str) -> list[str]:
    """The structure, its values, and the function that sets those that others define."""
    free, following, defined = source.parameters(content)
    member = NAMES.written
    lines = ["", "typedef struct {"]
    for group, note in ((free, ""), (following, source.FOLLOWING), (defined, _FOLLOWED)):
        lines += [f"    // {note}"] if group and note else []
        lines += [f"    double {member(p.name)}; // {_said(p)}" for p in group]
    lines += [f"}} {name}_parameters;", "", f"const {name}_parameters {name}_defaults = {{"]
    lines += [f"    .{member(p.name)} = {p.value!r}," for p in content.parameters]
    lines += ["};", "", f"void {name}_follow({name}_parameters *p)", "{"]
    for p in defined:
        value = _PRINTER.doprint(source.renamed(p.definition, _member))
        lines += source.assignments([_member(p.name)], value, ";")
    return [*lines, *([] if defined else ["    (void)p;"]), "}"]


_FOLLOWED = "Defined by the others: the function below sets them."


def _function(kind: str, matrices: Mapping[str, sp.MatrixBase], name: str) -> list[str]:
    """A function that fills matrices, what their entries have in common taken out of them."""
    of = {title: tuple(f"{name.upper()}_{axis}" for axis in _along(title)) for title in matrices}
    arguments = [f"double {title}[{rows}][{columns}]" for title, (rows, columns) in of.items()]
    entries = source.entries(matrices, _member)
    values = [value for own in entries.values() for value in own]
    parts, values = sp.cse(values, sp.numbered_symbols("t"), order="none")
    left = iter(values)
    head = [f"void {name}_{kind}(const {name}_parameters *p", *arguments]
    lines = ["", ",\n    ".join(head) + ")", "{"]
    for part, value in parts:
        lines += source.assignments([f"const double {part}"], _PRINTER.doprint(value), ";")
    if not any(value.free_symbols for value in values):
        lines.append("    (void)p;")
    for title, own in entries.items():
        lines += [f"    {name}_zero(&{title}[0][0], {' * '.join(of[title])});"]
        for places, value in zip(own.values(), left, strict=False):
            targets = [f"{title}[{i}][{j}]" for i, j in places]
            lines += source.assignments(targets, _PRINTER.doprint(value), ";")
    return [*lines, "}"]


_PRINTER = C99CodePrinter()


def _along(title: str) -> tuple[str, str]:
    """The axes of a matrix."""
    across = {"w": "ELEVATIONS", "f": "FORCES"}.get(title[-1], "COORDINATES")
    return "OUTPUTS" if title.startswith("Y") else "COORDINATES", across


def _member(name: str) -> str:
    return f"p->{NAMES.written(name)}"


def _said(quantity: Quantity) -> str:
    return ", ".join(filter(None, (quantity.unit, quantity.meaning)))
