"""The middle of a derivation: energies, and Lagrange's equations, nonlinear."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from railride.bodies.segments import SegmentedBody
from railride.lagrange import Coordinate, Signal
from railride.markup import (
    Block,
    Equation,
    Heading,
    Paragraph,
    aligned,
    continued,
    grouped_lines,
    math,
    natural,
    summands,
)
from railride.report.document import LAGRANGE, Subject, stacked
from railride.resultants import Resultants


def energies(subject: Subject) -> list[Block]:
    """T, V, D and δW."""
    system, order = subject.system, list(subject.values)
    kinds = (("Kinetic energy", "T", system.kinetic), ("Potential energy", "V", system.potential),
             ("Rayleigh's dissipation function", "D", system.dissipation))  # fmt: skip
    blocks: list[Block] = [Heading("Energies and virtual work"), *_each_segment(subject)]
    for name, letter, u in kinds:
        blocks += [Paragraph(f"{name}:"), Equation(grouped_lines(letter, u, order))]
    if system.virtual_work:
        work = " + ".join(rf"{math(F)} \delta {math(r)}" for F, r in system.virtual_work)
        blocks += [Paragraph("Virtual work of the forces:"), Equation(rf"\delta W = {work}")]
    else:
        blocks.append(Paragraph(r"No further force does work, $\delta W = 0$."))
    said = r"Lagrange's equations, one for each coordinate, $\delta W = \sum_i Q_i \delta q_i$:"
    return [*blocks, Paragraph(said), Equation(LAGRANGE)]


def _each_segment(subject: Subject) -> list[Block]:
    """Mass, length and inertia of the segments, where all are alike."""
    body = subject.model.body
    if not isinstance(body, SegmentedBody):
        return []
    segments = range(1, body.number + 1)
    kinds = {(*body.masses.moments(i), body.cuts.ell(i)) for i in segments}
    m, S, J, length = next(iter(kinds))
    if len(kinds) > 1 or S != 0:
        return []
    return [Paragraph(f"Each segment has the mass ${math(m)}$, the length ${math(length)}$ and, "
                      f"about its middle, the pitch inertia ${math(J)}$: the kinetic energy is "
                      r"that of $\dot{\vec r}_i$ and $\dot\theta_i$.")]  # fmt: skip


def nonlinear(subject: Subject, parts: Resultants) -> list[Block]:
    """The equations of motion: each resultant once, then one short sum for each coordinate."""
    blocks: list[Block] = [
        Heading("Nonlinear equations of motion"),
        Paragraph("The energies are written in named quantities $u$: coordinates, and functions "
                  "of them. With the resultant of each, taken as if it were a coordinate itself,"),
        Equation(r"R_u = \frac{d}{dt} \frac{\partial T}{\partial \dot u} - \frac{\partial T}"
                 r"{\partial u} + \frac{\partial V}{\partial u} + \frac{\partial D}{\partial "
                 r"\dot u} - \sum_k f_k \frac{\partial s_k}{\partial u}" if subject.system.forces
                 else r"R_u = \frac{d}{dt} \frac{\partial T}{\partial \dot u} - \frac{\partial T}"
                 r"{\partial u} + \frac{\partial V}{\partial u} + \frac{\partial D}{\partial "
                 r"\dot u}"),
        Paragraph("the chain rule makes of Lagrange's equations, without any approximation,"),
        Equation(r"0 = R_{q_i} + \sum_u R_u \frac{d u}{d q_i}"),
        Paragraph("The resultants:"),
        *(block for kind in _by_kind(parts.of) for block in stacked(
            [continued(resultant_symbol(u), summands(_collected(parts.of[u]))) for u in kind])),
        Paragraph("The equations of motion, one for each coordinate:"),
    ]  # fmt: skip
    for q in subject.system.coordinates:
        blocks += [Paragraph(f"For ${math(q)}$:"), Equation(aligned(_summed(parts, q)))]
    return blocks


def resultant_symbol(u: Coordinate) -> str:
    """R with the quantity below it."""
    return f"R_{{{math(u)}}}"


def _summed(parts: Resultants, q: Coordinate) -> list[str]:
    """``0 = R_q + R_u du/dq + …``."""
    place = sp.Symbol("xR")  # sorted behind parameters and lengths, before functions
    terms = [
        math(factor * place).replace(place.name, resultant_symbol(u))
        for u, factor in parts.terms(q)
    ]
    return continued("0", terms)


def _collected(u: sp.Expr) -> sp.Expr:
    """A sum by its masses, stiffnesses and dampings: c (2 θ̇_2 - θ̇_1 - θ̇_3)."""
    by = [s for s in u.free_symbols if not isinstance(s, Signal) and s.name[0] in "mkcIJN"]
    terms = sp.Add.make_args(sp.collect(sp.expand(u), by))
    return sp.Add(*(sp.factor_terms(term) for term in terms))


def _by_kind(quantities: Iterable[Coordinate]) -> list[list[Coordinate]]:
    """Quantities whose names begin alike together, each kind in its order: z_0, z_1 …"""
    kinds: dict[str, list[Coordinate]] = {}
    for u in quantities:
        kinds.setdefault(u.name.rstrip("0123456789"), []).append(u)
    return [sorted(kind, key=lambda u: natural(u.name)) for kind in kinds.values()]
