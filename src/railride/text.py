"""Mathematics as plain text for a terminal: Greek letters, dots for rates."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence

import sympy as sp
from sympy.printing.str import StrPrinter

from railride.lagrange import Coordinate, Lagrangian, Signal
from railride.linear import LinearModel

DOTS = {0: "", 1: "\N{COMBINING DOT ABOVE}", 2: "\N{COMBINING DIAERESIS}"}
GREEK = {"theta": "θ", "zeta": "ζ", "mu": "μ", "ell": "ℓ", "eta": "η", "phi": "φ", "kappa": "κ",
         "rho": "ρ", "alpha": "α", "beta": "β"}  # fmt: skip
WIDTH = 100


class TextPrinter(StrPrinter):
    """sympy's text with ``θ̇_1`` for ``theta_1_dot`` and ``L²`` for ``L**2``."""

    def _as_ordered_terms(self, expr: sp.Expr, order: str | None = None) -> list[sp.Expr]:
        """What is positive first: ``z_0 - z_1``, not ``-z_1 + z_0``."""
        del order
        return sorted(expr.args, key=lambda term: bool(term.could_extract_minus_sign()))

    def _print_Symbol(self, expr: sp.Symbol) -> str:
        return symbol(expr)

    def _print_Pi(self, expr: sp.Expr) -> str:
        del expr
        return "π"

    _print_Signal = _print_Coordinate = _print_Input = _print_Force = _print_Symbol  # noqa: N815


def symbol(s: sp.Symbol) -> str:
    """A symbol as text: ``k_θ``, ``z̈_b1``."""
    order = s.order if isinstance(s, Signal) else 0
    head, *rest = (s.base if order else s).name.split("_")
    rest = [GREEK.get(part, part) for part in rest]
    return "_".join([GREEK.get(head, head) + DOTS.get(order, DOTS[2]), *rest])


def expression(u: sp.Expr) -> str:
    """An expression on one line."""
    text = str(TextPrinter({"order": "none"}).doprint(u))
    for power, sign in (("2", "²"), ("3", "³"), ("4", "⁴"), ("5", "⁵")):
        text = re.sub(rf"\*\*{power}(?![0-9.])", sign, text)
    return text.replace("*", "·").replace("··", "^")


def wrapped(head: str, u: sp.Expr) -> str:
    """``head = term + term …``, terms in the order of the signals in them, lines of 100."""
    first, *rest = (expression(term) for term in sorted(sp.Add.make_args(u), key=_by_signals))
    lines = [f"  {head} = {first}"]
    for term in rest:
        signed = f" - {term[1:]}" if term.startswith("-") else f" + {term}"
        if len(lines[-1]) + len(signed) > WIDTH:
            lines.append(" " * (len(head) + 3))
        lines[-1] += signed
    return "\n".join(lines)


def energies(system: Lagrangian) -> str:
    """Coordinates, inputs, kinematics, T, V and D."""
    lines = [_listed("coordinates", system.coordinates)]
    if system.inputs:
        lines.append(_listed("inputs", system.inputs))
    if system.forces:
        lines.append(_listed("forces", system.forces))
    lines += [wrapped(symbol(name), u) for name, u in system.kinematics.items()]
    lines += [wrapped("T", system.kinetic), wrapped("V", system.potential)]
    lines += [wrapped("D", system.dissipation)] if system.dissipation != 0 else []
    if system.virtual_work:
        work = " + ".join(f"{expression(F)} δ{expression(r)}" for F, r in system.virtual_work)
        lines.append(f"  δW = {work}")
    return "\n".join(lines)


def matrices(linear: LinearModel) -> str:
    """The entries of every matrix that are not zero; of symmetric ones the upper triangle."""
    blocks = ["  M q̈ + C q̇ + K q = K_w w + C_w ẇ + B_f f"]
    columns = {"K_w": linear.inputs, "C_w": linear.inputs, "B_f": linear.forces}
    for name, A in linear.matrices.items():
        across = columns.get(name, linear.coordinates)
        entries = sorted(A.todok().items())
        symmetric = name not in columns and all(A[j, i] == e for (i, j), e in entries)
        shown = [((i, j), e) for (i, j), e in entries if not symmetric or i <= j]
        size = f"{A.shape[0]} × {A.shape[1]}" + (", symmetric" if symmetric and entries else "")
        blocks.append(f"  {name} ({size})" + ("" if entries else " = 0"))
        texts: dict[sp.Expr, str] = {}
        for (i, j), e in shown:
            texts.setdefault(e, expression(e))
            place = f"{symbol(linear.coordinates[i])}, {symbol(across[j])}"
            blocks.append(f"    {place:<{_pad(place, 14)}}{texts[e]}")
    return "\n".join(blocks)


def equations(system: Lagrangian) -> str:
    """The nonlinear equations of motion, one for each coordinate."""
    pairs = zip(system.coordinates, system.equations(), strict=True)
    return "\n".join(f"  {symbol(q)}:  {expression(e)} = 0" for q, e in pairs)


def _by_signals(term: sp.Expr) -> list[tuple[str, int]]:
    """Sorting key: names and numbers of the signals, z_2 before z_10."""
    names = sorted(s.name for s in term.free_symbols if isinstance(s, Signal))
    found = [re.match(r"(.*?)(\d*)(_dot|$)", name) for name in names]
    return [(m.group(1), int(m.group(2) or 0)) for m in found if m]


def _listed(name: str, symbols: Sequence[Coordinate] | Iterable[sp.Symbol]) -> str:
    text = f"  {name}: " + ", ".join(symbol(s) for s in symbols)
    return textwrap.fill(text, WIDTH, subsequent_indent="    ")


def _pad(text: str, width: int) -> int:
    """Width that shows as ``width`` columns: combining dots take none."""
    return width + sum(text.count(dot) for dot in DOTS.values() if dot)
