"""One matrix as a reader sees it: whole, as a sum over its parameters, or by its diagonals."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import reduce

import sympy as sp

from railride.markup import (
    LINE,
    Block,
    Equation,
    Paragraph,
    Table,
    aligned,
    continued,
    math,
    width,
)

WIDEST = 80  # characters across a matrix that is shown whole
PRINTED_WHOLE = 64  # entries beyond which it is not


def fits(A: sp.MatrixBase) -> bool:
    """Whether a matrix can be shown whole."""
    if not A.todok():
        return True
    columns = zip(*([math(e) for e in row] for row in A.tolist()), strict=True)
    across = sum(max(map(width, column)) + 2 for column in columns)
    return len(A) <= PRINTED_WHOLE and across <= WIDEST


def whole(name: str, A: sp.MatrixBase) -> Equation:
    """``A = [ … ]``, or ``A = 0``."""
    return Equation(f"{name} = {math(A.as_explicit())}" if A.todok() else f"{name} = 0")


def told(name: str, A: sp.MatrixBase) -> list[Block]:
    """A matrix as a sum over its parameters, each what is common times what is left."""
    if not A.todok():
        return [Equation(f"{name} = 0")]
    parts = _by_parameter(A)
    if all(fits(rest) for _, rest in parts):
        terms = [
            f"{math(c) if c != 1 else ''} {math(rest.as_explicit())}".strip() for c, rest in parts
        ]
        return [Equation(aligned(continued(name, terms)))]
    return [block for part in parts for block in _diagonals(name, *part)]


def _by_parameter(A: sp.MatrixBase) -> list[tuple[sp.Expr, sp.MatrixBase]]:
    """Pairs (factor, rest) whose products add up to A."""
    symbols = sorted((s for s in A.free_symbols if s.name[0] in "mkcIJ"), key=lambda s: s.name)
    parts = {p: A.applyfunc(lambda e, p=p: sp.cancel(e.diff(p))) for p in symbols}
    parts = {p: rest for p, rest in parts.items() if rest.todok()}
    left = A - sum((p * rest for p, rest in parts.items()), sp.zeros(*A.shape))
    if A.atoms(sp.Float) or any(sp.simplify(e) != 0 for e in left):
        return [(sp.S.One, A)]
    return [common(p, rest) for p, rest in parts.items()]


def common(p: sp.Expr, A: sp.MatrixBase) -> tuple[sp.Expr, sp.MatrixBase]:
    """p A as a factor and a matrix whose entries have nothing in common."""
    above, below = zip(*(sp.fraction(sp.together(e)) for e in A.todok().values()), strict=True)
    denominator = reduce(sp.lcm, below)
    numerators = [sp.cancel(a * denominator / b) for a, b in zip(above, below, strict=True)]
    factor = reduce(sp.gcd, numerators) / denominator
    return p * factor, A.applyfunc(lambda e: sp.factor(sp.cancel(e / factor)))


def _diagonals(name: str, factor: sp.Expr, A: sp.MatrixBase) -> list[Block]:
    """A large matrix by its diagonals, equal neighbours counted."""
    symmetric = A.is_symmetric()
    rows = []
    for d in range(0 if symmetric else 1 - A.rows, A.cols):
        along = [A[i, i + d] for i in range(max(0, -d), min(A.rows, A.cols - d))]
        if any(along):
            rows.append((f"{d}", _runs(along)))
    head = f"${math(factor)}$ times" if factor != 1 else ""
    mirrored = ", symmetric" if symmetric else ""
    return [
        Paragraph(f"${name}$ has, {A.rows} × {A.cols}{mirrored}, {head} along its diagonals, from "
                  "the front, and zero elsewhere:"),
        Table(("diagonal", f"entries of ${name}$"), rows, figures=("diagonal",)),
    ]  # fmt: skip


def side_by_side(blocks: Sequence[Block]) -> list[Block]:
    """The same blocks, short equations that follow each other on one line."""
    found: list[Block] = []
    for block in blocks:
        last = found[-1] if found else None
        if isinstance(block, Equation) and isinstance(last, Equation):
            both = rf"{last.latex}, \qquad {block.latex}"
            if "aligned" not in both and _wide(both) <= LINE:
                found[-1] = Equation(both)
                continue
        found.append(block)
    return found


def _wide(latex: str) -> int:
    """About how many characters wide mathematics with matrices is."""
    inner = re.compile(r"\\begin\{bmatrix\}((?:(?!\\begin).)*?)\\end\{bmatrix\}")

    def longest(match: re.Match[str]) -> str:
        rows = (row.replace("&", "xxx") for row in match.group(1).split(r"\\"))
        return f"[x{max(rows, key=width)}x]"

    return width(inner.sub(longest, latex.replace(r"\qquad", "xxxx")))


def _runs(entries: Sequence[sp.Expr]) -> str:
    """Entries in a row, ``$6$ (17 times)`` for equal neighbours."""
    found: list[tuple[sp.Expr, int]] = []
    for e in entries:
        if found and found[-1][0] == e:
            found[-1] = (e, found[-1][1] + 1)
        else:
            found.append((e, 1))
    return ", ".join(f"${math(e)}$" + (f" ({n} times)" if n > 1 else "") for e, n in found)


def shown(name: str, A: sp.MatrixBase) -> list[Block]:
    """Whole where it fits, else told in parts."""
    return [whole(name, A)] if fits(A) else told(name, A)
