r"""A document as a list of blocks, written as Markdown that a code host renders, or as LaTeX.

Text in a block may hold ``$mathematics$`` and ```code```; the two renderers below turn a list of
blocks into one file each, the same bytes on every machine. Mathematics is written so that no
Markdown reader takes part of it for its own: one line to an equation, no line that begins with a
sign, no ``*``, no underscore after a bracket.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter

from railride.lagrange import Signal

GREEK = ("theta", "zeta", "mu", "ell", "eta", "phi", "kappa", "rho", "alpha", "beta")
BRACED = r"\{([^{}]*(?:\{[^{}]*\}[^{}]*)*)\}"  # with at most one pair inside
LINE = 78  # characters of mathematics that fit on a line, commands counted as one


@dataclass(frozen=True)
class Heading:
    """A heading; level 1 is the title."""

    text: str
    level: int = 2


@dataclass(frozen=True)
class Paragraph:
    """Running text."""

    text: str


@dataclass(frozen=True)
class Equation:
    """Displayed mathematics in LaTeX, with a number in brackets if it has one."""

    latex: str
    number: str = ""


@dataclass(frozen=True)
class Table:
    """Columns by their headings, and rows of text; figures stand to the right."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    figures: Sequence[str] = ()


@dataclass(frozen=True)
class Code:
    """Text to be read by a program."""

    text: str
    language: str = ""


Block = Heading | Paragraph | Equation | Table | Code


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
    return -order, negative, term.count_ops() if found else 0, names, str(term)


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
        r"(\\(?:sin|cos|arcsin)(?:\^\w)?) *\{(\\theta(?:_\w|_\{\w+\})?)\}", r"\1 \2", latex
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
    terms = [math(term) for term in sorted(sp.Add.make_args(expression), key=_term_key)]
    signed = [t if t.startswith("- ") else f"+ {t}" for t in terms]
    signed[0] = terms[0]
    lines = [""]
    for term in signed:
        if lines[-1] and width(lines[-1]) + width(term) > LINE:
            lines.append("")
        lines[-1] = f"{lines[-1]} {term}".strip()
    return aligned(
        [f"{left} & {equals} {lines[0]}", *(rf"& \quad {{}} {more}" for more in lines[1:])]
    )


def aligned(lines: Sequence[str]) -> str:
    """Lines of an equation under each other, ``&`` where they align."""
    if len(lines) == 1:
        return lines[0].replace("& ", "", 1)
    return r"\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}"


def markdown(blocks: Iterable[Block]) -> str:
    """GitHub's Markdown, with mathematics between dollars."""
    return "\n\n".join(_markdown(block) for block in blocks) + "\n"


def _markdown(block: Block) -> str:
    match block:
        case Heading(text, level):
            return f"{'#' * level} {text}"
        case Paragraph(text):
            return text
        case Equation(latex, number):
            mark = rf" \qquad \text{{({number})}}" if number else ""
            return f"$$\n{latex}{mark}\n$$"
        case Code(text, language):
            return f"```{language}\n{text}\n```"
        case Table(columns, rows, figures):
            marks = ["---:" if column in figures else "---" for column in columns]
            lines = [columns, marks, *rows]
            return "\n".join(f"| {' | '.join(line)} |" for line in lines)


PREAMBLE = r"""\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage[a4paper, margin=25mm]{geometry}
\usepackage{amsmath}
\usepackage{graphicx}
\usepackage{longtable}
\setcounter{MaxMatrixCols}{99}
% A wide formula is made as small as the line is wide.
\newcommand{\fitted}[1]{\resizebox{\ifdim\width>0.9\linewidth 0.9\linewidth\else\width\fi}{!}%
  {$\displaystyle #1$}}
"""


def latex(blocks: Iterable[Block]) -> str:
    """An article that LaTeX compiles."""
    title, *rest = blocks
    if not isinstance(title, Heading) or title.level != 1:
        raise ValueError("a document begins with its title")
    head = f"{PREAMBLE}\\title{{{_latex_text(title.text)}}}\n\\author{{}}\n\\date{{}}\n"
    body = "\n\n".join(_latex(block) for block in rest)
    return f"{head}\\begin{{document}}\n\\maketitle\n\n{body}\n\n\\end{{document}}\n"


def _latex(block: Block) -> str:
    match block:
        case Heading(text, level):
            return "\\" + "sub" * (level - 2) + f"section*{{{_latex_text(text)}}}"
        case Paragraph(text):
            return _latex_text(text)
        case Equation(mathematics, number):
            mark = rf" \tag{{{number}}}" if number else ""
            return f"\\[\n\\fitted{{{mathematics}}}{mark}\n\\]"
        case Code(text, _):
            return f"{{\\footnotesize\n\\begin{{verbatim}}\n{text}\n\\end{{verbatim}}}}"
        case Table(columns, rows, figures):
            return _latex_table(columns, rows, figures)


def _latex_table(
    columns: Sequence[str], rows: Sequence[Sequence[str]], figures: Sequence[str]
) -> str:
    """A table that may go over pages; the last column takes what it needs of the line."""
    marks = ["r" if column in figures else "l" for column in columns]
    if marks[-1] == "l":
        marks[-1] = r"p{0.45\linewidth}"
    lines = [" & ".join(_latex_text(cell) for cell in line) + r" \\" for line in (columns, *rows)]
    inner = "\n".join([lines[0] + r" \hline \endhead", *lines[1:]])
    return f"\\begin{{longtable}}{{{''.join(marks)}}}\n{inner}\n\\end{{longtable}}"


def _latex_text(text: str) -> str:
    """Running text: mathematics as it is, code in a typewriter face, the rest escaped."""
    parts = re.split(r"(\$[^$]+\$|`[^`]+`|\*\*[^*]+\*\*)", text)
    return "".join(_latex_span(part) for part in parts)


def _latex_span(part: str) -> str:
    if part.startswith("$"):
        return part
    if part.startswith("`"):
        return rf"\texttt{{{_escaped(part[1:-1]).replace('--', '-{}-')}}}"
    if part.startswith("**"):
        return rf"\textbf{{{_escaped(part[2:-2])}}}"
    return _escaped(part)


def _escaped(text: str) -> str:
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return re.sub(r"[\\~^&%#_{}$]", lambda m: special.get(m.group(), "\\" + m.group()), text)
