"""What the exports as source code share: expressions with the target's names, and lines of text."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence

import sympy as sp

from railride import __version__
from railride.exports.content import Content, ParameterValue, Quantity

WIDTH = 100
Places = list[tuple[int, int]]

FOLLOWING = "Calculated by railride from the others; here they stay unless they are changed."


def title(content: Content) -> str:
    """The vehicle, what its body is and what wrote the file, in letters that end no comment."""
    name = re.sub(r"[^\w .,()+-]", "_", content.name)
    return f"{name}: {content.model.body.phrase}, linear, by railride {__version__}."


def origin(content: Content, remarks: Iterable[str] = ()) -> list[str]:
    """Where the values are from and what the user should know, each on a line without breaks.

    remarks : more of these.
    """
    values = content.model.vehicle.source
    said = [f"Source of the values: {values}"] if values else []
    said += [f"Remark: {remark}" for remark in (*content.remarks, *remarks)]
    return [" ".join(re.sub(r"[\x00-\x1f\x7f]", " ", text).split()) for text in said]


def parameters(
    content: Content,
) -> tuple[list[ParameterValue], list[ParameterValue], list[ParameterValue]]:
    """Those that are independent, those that follow by an algorithm, those that others define."""
    free = [p for p in content.parameters if p.definition is None and not p.follows]
    following = [p for p in content.parameters if p.follows]
    defined = [p for p in content.parameters if p.definition is not None]
    return free, following, defined


def axes(content: Content) -> dict[str, Sequence[Quantity]]:
    """What stands along the axes of the matrices, in order."""
    return {
        "coordinates": content.coordinates,
        "elevations": content.elevations,
        "rates": content.rates,
        "forces": content.forces,
        "outputs": [Quantity(output.name, output.unit, "") for output in content.outputs],
    }


def renamed(expression: sp.Expr, name: Callable[[str], str]) -> sp.Expr:
    """The expression with its symbols called as ``name`` says."""
    return expression.xreplace({s: sp.Symbol(name(s.name)) for s in expression.free_symbols})


def entries(
    matrices: Mapping[str, sp.MatrixBase], name: Callable[[str], str]
) -> dict[str, dict[sp.Expr, Places]]:
    """Of each matrix the entries that are not zero, each once with all its places.

    >>> m = sp.Symbol("m")
    >>> entries({"M": sp.Matrix([[m, 0], [0, m]])}, lambda name: f"p->{name}")
    {'M': {p->m: [(0, 0), (1, 1)]}}
    """
    found: dict[str, dict[sp.Expr, Places]] = {}
    for matrix, A in matrices.items():
        own: dict[sp.Expr, Places] = found.setdefault(matrix, {})
        for place, entry in sorted(A.todok().items()):
            own.setdefault(renamed(entry, name), []).append(place)
    return found


def assignments(targets: Iterable[str], value: str, end: str = "") -> list[str]:
    """``a = b = value`` in indented lines that fit; all but the first take the first's value.

    >>> assignments(["M[0, 0]", "M[1, 1]"], "m/2")
    ['    M[0, 0] = M[1, 1] = m/2']
    """
    lines: list[str] = []
    line, first = "    ", ""
    for target in targets:
        if first and len(f"{line}{target} = {value}{end}") > WIDTH:
            lines += _assigned(line, value, end)
            line, value = "    ", first
        first = first or target
        line += f"{target} = "
    return [*lines, *_assigned(line, value, end)]


def _assigned(line: str, value: str, end: str) -> list[str]:
    """A line with its value, between brackets on lines of their own where it does not fit."""
    if len(f"{line}{value}{end}") <= WIDTH:
        return [f"{line}{value}{end}"]
    return [f"{line}(", *folded(terms(value), WIDTH, " " * 8), f"    ){end}"]


def terms(value: str) -> list[str]:
    """An expression cut before the operators of its sums and products, to be put on lines.

    >>> terms("2*a**2 - b*(c + 1e-3)")
    ['2', '*a**2', ' - b', '*(c', ' + 1e-3)']
    """
    return re.split(r"(?= [+-] )|(?<!\*)(?=\*(?!\*))", value)


def folded(pieces: Iterable[str], width: int, indent: str = "") -> list[str]:
    """Pieces of a text in indented lines of at most ``width`` characters, as far as they can be.

    >>> folded(["a", "*b", " + c"], 5)
    ['a*b', '+ c']
    """
    lines: list[str] = []
    for piece in pieces:
        if lines and len(lines[-1] + piece) <= width:
            lines[-1] += piece
        else:
            lines.append(indent + piece.lstrip())
    return lines
