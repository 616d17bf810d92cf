"""sympy's expressions as LaTeX that reads as on paper, long sums broken into lines."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter

from railride.lagrange import Signal

GREEK = ("theta", "zeta", "mu", "ell", "eta", "phi", "kappa", "rho", "alpha", "beta")
BRACED = r"\{([^{}]*(?:\{[^{}]*\}[^{}]*)*)\}"  # with at most one pair inside
LINE = 74  # characters of mathematics that fit on a line, commands counted as one


class Printer(LatexPrinter):
    r"""sympy's LaTeX as on paper: ½ m_h L_h² θ̇² with parameters first, rates before positions.

    >>> from railride.lagrange import Coordinate
    >>> m, L, theta = sp.Symbol("m_h"), sp.Symbol("L_h"), Coordinate("theta")
    >>> math(m * L**2 * theta.dot**2 * sp.sin(theta) / 2)
    '\\frac{1}{2} m_h L_h^2 \\dot\\theta^2 \\sin \\theta'
    """

    printmethod = ""  # a Signal's own form, with one wide dot over name and index, is for notebooks

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        del style
        order = expr.order if isinstance(expr, Signal) else 0
        head, *index = (expr.base if order else expr).name.split("_")
        letter = f"\\{head}" if head in GREEK else head
        dots = f"\\{'d' * order}ot" + ("" if letter.startswith("\\") else " ") if order else ""
        return dots + letter + (f"_{{{_index(index)}}}" if index else "")

    def _print_Pi(self, expr: sp.Expr) -> str:
        del expr
        return r"\pi"

    _print_Signal = _print_Coordinate = _print_Input = _print_Force = _print_Symbol  # noqa: N815

    def _print_Mul(self, expr: sp.Expr) -> str:
        coefficient, rest = expr.as_coeff_Mul(rational=True)
        if not coefficient.is_Rational:
            return str(super()._print_Mul(expr))
        above, below = (sp.Mul.make_args(part) for part in sp.fraction(rest))
        sign, p, q = "- " if coefficient < 0 else "", abs(coefficient.p), coefficient.q
        if all(factor == 1 for factor in below):
            head = rf"\frac{{{p}}}{{{q}}} " if q != 1 else f"{p} " if p != 1 else ""
            return f"{sign}{head}{self._product(above, alone=False)}"
        return rf"{sign}\frac{{{self._times(p, above)}}}{{{self._times(q, below)}}}"

    def _times(self, number: int, factors: Sequence[sp.Expr]) -> str:
        if all(factor == 1 for factor in factors):
            return str(number)
        product = self._product(factors, alone=number == 1)
        return product if number == 1 else f"{number} {product}"

    def _product(self, factors: Sequence[sp.Expr], *, alone: bool) -> str:
        ordered = sorted((f for f in factors if f != 1), key=_factor_key)
        bare = alone and len(ordered) == 1
        return " ".join(
            rf"\left({self._print(f)}\right)" if f.is_Add and not bare else self._print(f)
            for f in ordered
        )

    def _as_ordered_terms(self, expr: sp.Expr, order: str | None = None) -> list[sp.Expr]:
        del order
        return sorted(sp.Add.make_args(expr), key=_term_key)


def _index(parts: Sequence[str]) -> str:
    return ", ".join(
        rf"\{part}" if part in GREEK else
        rf"\mathrm{{{part}}}" if part.isalpha() and len(part) > 1 else part
        for part in parts
    )  # fmt: skip


def natural(name: str) -> tuple[tuple[str, int], ...]:
    """Sorting key of a name: z_2 before z_10."""
    return tuple((word, int(digits or 0)) for word, digits in re.findall(r"(\D+)(\d*)", name))


def _factor_key(factor: sp.Expr) -> tuple[Any, ...]:
    """Parameters (lengths last), coordinates and rates, functions, sums, second rates."""
    base = factor.as_base_exp()[0]
    if base == sp.pi:
        return -1, False, (), ""
    if not base.is_Symbol:
        return (3 if base.is_Add else 2), isinstance(base, sp.cos), (), str(base)
    if isinstance(base, Signal):
        return (4 if base.order == 2 else 1), False, natural(base.name), ""
    return 0, base.name[0] in "Llxe", natural(base.name), ""


def _term_key(term: sp.Expr) -> tuple[Any, ...]:
    """Highest rates first, then what is added, then short terms before long ones, then by name."""
    symbols = sorted(term.free_symbols, key=lambda s: natural(s.name))
    found = [s for s in symbols if isinstance(s, Signal)]
    order = max((s.order for s in found), default=0)
    negative = term.as_coeff_Mul()[0].is_negative or False
    names = [natural(s.base.name) for s in found] or [natural(s.name) for s in symbols]
    plain = not found or term.as_coeff_Mul()[1].is_Symbol
    return -order, negative, 0 if plain else term.count_ops(), names, str(term)


def math(expression: Any) -> str:
    """An expression or a matrix in LaTeX."""
    settings = {"fold_func_brackets": True, "inv_trig_style": "full", "mat_str": "bmatrix",
                "mat_delim": ""}  # fmt: skip
    return tidy(Printer(settings).doprint(expression))


def tidy(latex: str) -> str:
    r"""Without brackets about one character: ``L_h^2`` for ``L_{h}^{2}``.

    >>> tidy(r"L_{h}^{2} \\\frac{1}{2} \sin^{2} {\theta}")
    'L_h^2 \\\\ \\frac{1}{2} \\sin^2 \\theta'
    """
    latex = re.sub(r"([_^])\{(\w|\\theta)\}", r"\1\2", latex)
    latex = re.sub(
        r"(\\(?:sin|cos|tan|arcsin)(?:\^\w)?) *\{(\\theta(?:_\w|_\{\w+\})?)\}", r"\1 \2", latex
    )
    latex = latex.replace("\\\\", "\\\\ ")
    return re.sub(r" +", " ", latex).strip()


def width(latex: str) -> int:
    """About how many characters wide mathematics is on paper."""
    while True:
        shorter = re.sub(rf"\\frac{BRACED}{BRACED}", lambda m: max(m.groups(), key=len), latex)
        if shorter == latex:
            break
        latex = shorter
    return len(
        re.sub(r"\\left|\\right|\\d+ot|\\mathrm|[{}_^ ]", "", re.sub(r"\\[a-z]+", "x", latex))
    )


def sum_lines(left: str, expression: sp.Expr, equals: str = "=") -> str:
    """``left = term + term …``, broken into lines where it is long."""
    return aligned(continued(left, summands(expression), equals))


def summands(expression: sp.Expr) -> list[str]:
    """The terms of a sum in LaTeX, in the order in which they are written."""
    return [math(term) for term in sorted(sp.Add.make_args(expression), key=_term_key)]


def grouped_lines(left: str, expression: sp.Expr, order: Sequence[str] = ()) -> str:
    r"""As :func:`sum_lines`, what has the same parameters before it in one bracket.

    order : names of parameters; what has one that comes early is written early.

    >>> from railride.lagrange import Coordinate
    >>> k, z, y = sp.Symbol("k"), Coordinate("z"), Coordinate("y")
    >>> grouped_lines("V", k * (y / 2 + z / 2) ** 2 / 2 + k * z**2 / 8)
    'V = \\frac{1}{8} k \\left(z^2 + \\left(y + z\\right)^2\\right)'
    """
    groups: dict[sp.Expr, list[sp.Expr]] = {}
    for term in sp.Add.make_args(expression):
        for part in _unfolded(term):
            varying = [s for s in part.free_symbols if isinstance(s, Signal)]
            factor, rest = sp.factor_terms(part).as_independent(*varying, as_Add=False)
            groups.setdefault(factor, []).append(rest)
    ranks = {name: rank for rank, name in enumerate(order)}

    def key(factor: sp.Expr) -> tuple[Any, ...]:
        names = [s.name for s in factor.free_symbols]
        return min((ranks.get(n, len(ranks)) for n in names), default=0), len(names), str(factor)

    terms = []
    for factor in sorted(groups, key=key):
        parts = sorted(groups[factor], key=_term_key)
        together = " + ".join(math(part) for part in parts)
        if len(parts) > 1 and width(together) < LINE - width(math(factor)):
            terms.append(rf"{math(factor)} \left({together}\right)")
        else:
            terms += [math(factor * part) for part in parts]
    return aligned(continued(left, terms))


def _unfolded(term: sp.Expr) -> Sequence[sp.Expr]:
    """m (ẋ² + ż²) as m ẋ² and m ż²; N (θ_1 - θ_2), a sum of signals alone, stays."""
    sums = [f for f in sp.Mul.make_args(term) if f.is_Add]
    if all(part.as_coeff_Mul()[1].is_Symbol for f in sums for part in f.args):
        return (term,)
    return tuple(sp.Add.make_args(sp.expand_mul(term, deep=False)))


def continued(left: str, terms: Sequence[str], equals: str = "=") -> list[str]:
    """The lines of ``left = term + term …``, terms as LaTeX, ``&`` where they align."""
    signed = [t if t.startswith("- ") else f"+ {t}" for t in terms]
    signed[0] = terms[0]
    lines = [""]
    for term in signed:
        if lines[-1] and width(lines[-1]) + width(term) > LINE:
            lines.append("")
        lines[-1] = f"{lines[-1]} {term}".strip()
    return [f"{left} & {equals} {lines[0]}", *(rf"& \quad {{}} {more}" for more in lines[1:])]


def aligned(lines: Sequence[str]) -> str:
    """Lines of an equation under each other, ``&`` where they align."""
    if len(lines) == 1:
        return lines[0].replace("& ", "", 1)
    return r"\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}"


def number(value: float, digits: int = 6) -> str:
    r"""A figure as mathematics.

    >>> number(3.7e8), number(-8.75), number(34000.0)
    ('$3.7 \\times 10^{8}$', '$-8.75$', '$34000$')
    """
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    return f"${mantissa} \\times 10^{{{int(exponent)}}}$" if exponent else f"${mantissa}$"
