"""How Modelica is written: names, units, numbers, expressions, declarations.

Source: Modelica Association, Modelica: A Unified Object-Oriented Language for Systems Modeling,
Language Specification 3.4: 2.3 (keywords), 3.7 (built-in operators), 19 (units).
"""

from __future__ import annotations

import re
from collections.abc import Iterable

import sympy as sp
from sympy.printing.str import StrPrinter

from railride.exports import source
from railride.exports.content import Quantity
from railride.exports.names import Names

NAMES = Names(
    frozenset(
        "algorithm and annotation block break class connect connector constant constrainedby der "
        "discrete each else elseif elsewhen encapsulated end enumeration equation expandable "
        "extends external false final flow for function if import impure in initial inner input "
        "loop model not operator or outer output package parameter partial protected public pure "
        "record redeclare replaceable return stream then true type when while within "
        "abs acos asin atan atan2 cardinality ceil change cos cosh cross delay diagonal div edge "
        "exp fill floor getInstanceName homotopy identity inStream integer linspace log log10 "
        "matrix max min mod ndims noEvent ones outerProduct pre product promote reinit rem sample "
        "scalar semiLinear sign sin sinh size skew smooth spatialDistribution sqrt String sum "
        "symmetric tan tanh terminal time transpose vector zeros "
        "Boolean Integer Real RealInput RealOutput".split()
    )
)
"""Modelica's keywords and built-in names, and the connectors of the package."""

LONG = source.WIDTH - 6  # what a line of a model may hold: it is in the package, and indented


def unit(own: str) -> str:
    """An SI unit as Modelica writes it.

    >>> unit("N m/rad"), unit("kg m^2"), unit("")
    ('N.m/rad', 'kg.m2', '1')
    """
    return own.replace(" ", ".").replace("^", "") or "1"


def number(value: float) -> str:
    """A number to its last digit."""
    return repr(float(value))


class _Printer(StrPrinter):
    """Expressions with ``^`` for powers, and numbers to their last digit."""

    def _print_Float(self, expr: sp.Float) -> str:
        return number(expr)

    def _print_Pi(self, expr: sp.Expr) -> str:
        return number(expr)


def expression(u: sp.Expr) -> str:
    """An expression, its symbols written as names.

    >>> k, L = sp.symbols("k_theta L")
    >>> expression(16 * k / L**2)
    '16*k_theta/L^2'
    """
    return printed(source.renamed(u, NAMES.written))


def printed(u: sp.Expr) -> str:
    """An expression whose symbols are Modelica's already."""
    return str(_Printer({"order": "none"}).doprint(u)).replace("**", "^")


def titled(kind: str, name: str, said: str) -> list[str]:
    """``kind name "said"``, what is said on a line of its own where it is too long."""
    first, *rest = source.folded([f"{kind} {name}", f" {quoted(said)}"], LONG)
    return [first, *(f"  {line}" for line in rest)]


def declared(kind: str, q: Quantity, modifiers: str = "", value: str = "") -> list[str]:
    """``kind name(modifiers, unit = "…") = value "meaning";``, cut where it is too long."""
    attributes = ", ".join(filter(None, [modifiers, f'unit = "{unit(q.unit)}"']))
    said = [f" {quoted(q.meaning)}"] if q.meaning else []
    head = f"{kind} {NAMES.written(q.name)}({attributes})"
    pieces = [head, *(source.terms(f" = {value}") if value else []), *said]
    first, *rest = source.folded([*pieces[:-1], f"{pieces[-1]};"], LONG)
    return [first, *(f"  {line}" for line in rest)]


def indented(lines: Iterable[str]) -> list[str]:
    """Lines within a package or model."""
    return [f"  {line}" if line else "" for line in lines]


def quoted(text: str) -> str:
    r"""A string of Modelica.

    >>> print(quoted('a "long" body'))
    "a \"long\" body"
    """
    escaped = re.sub(r"[\x00-\x1f]", " ", text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'
