"""The static equilibrium: generalised forces that vanish, weight, and preloads that carry it."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from railride.jets import Jets
from railride.markup import (
    Block,
    Equation,
    Heading,
    Paragraph,
    Table,
    continued,
    grouped_lines,
    math,
    summands,
)
from railride.preloads import Preloads
from railride.report.document import Subject, listed, stacked
from railride.units import STANDARD_GRAVITY

SOLVED = 16  # static forces that are told by formulas; more are numbers


def equilibrium(subject: Subject) -> list[Block]:
    """That the system rests at q = 0, and what carries its weight there."""
    system = subject.system
    point = ", ".join(f"{s} = 0" for s in ("q", "w", "f")[: 1 if subject.alone else 3])
    jets = Jets(system.operating_point, system.kinematics)
    dV, dT = jets.gradient(system.potential), jets.gradient(system.kinetic)
    zeros = ", ".join(math(dV.get(q, 0) - dT.get(q, 0)) for q in system.coordinates)
    blocks: list[Block] = [
        Heading("Equilibrium"),
        Paragraph(f"At ${point}$ and at rest every spring is at ease and every damper still. There "
                  r"the generalised forces $-\partial V / \partial q$ vanish, one for each "
                  "coordinate:"),
        Equation(rf"\frac{{\partial V}}{{\partial q}} \bigg\vert_{{q = 0}} = ({zeros})"),
    ]  # fmt: skip
    return blocks + (_floating() if subject.alone else _weight(subject))


def _floating() -> list[Block]:
    return [Paragraph("It is an equilibrium. Gravity moves every part of a body that nothing "
                      "holds alike, strains no joint, and is left out.")]  # fmt: skip


def _weight(subject: Subject) -> list[Block]:
    static = Preloads(subject.system, subject.lift)
    if static.curvature:
        raise ArithmeticError(f"preloads: they would stiffen by {static.curvature}")
    balances = [
        continued(rf"{math(q)} : \quad 0", summands(sp.collect(force, list(static.elements))))
        for q, force in static.forces.items()
    ]
    return [
        Paragraph("It is an equilibrium, which is checked again as the matrices are made. "
                  "Gravity is not forgotten: displacements count from where the springs carry the "
                  "weight. Each holds a preload $N$ there, positive in compression, and the "
                  "potential energy has besides $V$ the part"),
        Equation(grouped_lines("V_0", static.potential, list(subject.values))),
        Paragraph("with $g$ the acceleration of free fall. Its generalised forces "
                  r"$-\partial V_0 / \partial q$ vanish at $q = 0$, which is one equation for each "
                  "coordinate:"),
        *stacked(balances),
        *_preloads(subject, static),
        Paragraph("All second derivatives of $V_0$ vanish at $q = 0$: heights are linear in the "
                  "coordinates or odd in an angle, and the suspensions act vertically. So neither "
                  "weight nor preloads leave a term in the linear equations, and $V_0$ is left "
                  "out."),
    ]  # fmt: skip


def _preloads(subject: Subject, static: Preloads) -> list[Block]:
    """The preloads as a table: formulas where statics tells them, and numbers."""
    formulas = static.solution if len(static.elements) <= SOLVED else {}
    known = dict.fromkeys(formulas.values())
    values = static.values(subject.values)
    rows: list[tuple[str, ...]] = []
    for formula in known:  # what is equal in one row
        names = [N for N, value in formulas.items() if value == formula]
        rows.append((f"${listed(names)}$", f"${math(formula)}$", *_told(static, names[0], values)))
    rows += [
        (f"${math(N)}$", *([""] if formulas else []), *_told(static, N, values))
        for N in static.elements if N not in formulas
    ]  # fmt: skip
    few = "" if formulas else " (the least in squares, where statics alone does not tell them)"
    columns = ("preload", *(["formula"] if formulas else []), "value", "unit")
    joints = "a joint's is a moment; " * any(map(is_angle, static.elements.values()))
    return [
        Paragraph(f"They are{few}, with $g$ = {STANDARD_GRAVITY} m/s² ({joints}to the primary "
                  "suspension's the weight of the wheelset comes on the rail):"),
        Table(columns, rows, figures=("value",)),
    ]  # fmt: skip


def _told(static: Preloads, N: sp.Symbol, values: Mapping[str, float]) -> tuple[str, str]:
    """A preload's value and its unit."""
    unit = "kN m" if is_angle(static.elements[N]) else "kN"
    return f"{values[N.name] / 1e3:.2f}", unit


def is_angle(deflection: sp.Expr) -> bool:
    """Whether a deflection is the turn of a joint."""
    return all(s.name.startswith("theta_") for s in deflection.free_symbols)
