r"""Lagrange's equations by the chain rule: what acts along each named quantity, and what moves it.

Energies are written in named functions u(q, w) of the coordinates, such as the angle of a segment
or the extension of a spring. With the resultant of each, taken as if u were a coordinate itself,

.. math:: R_u = \frac{d}{dt}\frac{\partial T}{\partial\dot u} - \frac{\partial T}{\partial u}
          + \frac{\partial V}{\partial u} + \frac{\partial D}{\partial\dot u}
          - \sum_k F_k \frac{\partial r_k}{\partial u} ,

the equation of motion for the coordinate q_i is, without any approximation,

.. math:: 0 = R_{q_i} + \sum_u R_u \frac{du}{dq_i} ,

since ∂u̇/∂q̇ = ∂u/∂q and d/dt(∂u/∂q) = ∂u̇/∂q. Nothing is put in, and the equations stay as short
as on paper, however many segments there are.

Source: H. Goldstein, Classical Mechanics, 2nd ed., Section 1-4 (Eqs 1-46 to 1-51).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from railride.lagrange import Coordinate, Lagrangian, rate


@dataclass(frozen=True)
class Resultants:
    """The equations of motion in parts.

    of : R by quantity, coordinates first, then the names; those that vanish are left out.
    moved : du/dq by the pair (u, q), where it does not vanish.
    """

    system: Lagrangian
    of: Mapping[Coordinate, sp.Expr]
    moved: Mapping[tuple[Coordinate, Coordinate], sp.Expr]

    def terms(self, q: Coordinate) -> list[tuple[Coordinate, sp.Expr]]:
        """Pairs (u, factor): the equation of motion for q is 0 = Σ R_u · factor."""
        own = [(q, sp.S.One)] if q in self.of else []
        names = (u for u in self.system.kinematics if u in self.of and (u, q) in self.moved)
        return own + [(u, self.moved[u, q]) for u in names]

    def equation(self, q: Coordinate) -> sp.Expr:
        """The left-hand side of the equation for q, in the named quantities and their rates."""
        return sp.Add(*(self.of[u] * factor for u, factor in self.terms(q)))


def resultants(system: Lagrangian) -> Resultants:
    """The equations of motion of a system in parts, exact and nonlinear.

    Examples
    --------
    >>> k, L, m = sp.symbols("k L m", positive=True)
    >>> theta, s = Coordinate("theta"), Coordinate("s")
    >>> lever = Lagrangian([theta], m * s.dot**2 / 2, k * s**2 / 2, kinematics={s: L*sp.sin(theta)})
    >>> parts = resultants(lever)
    >>> parts.of[s], parts.terms(theta)
    (k*s + m*s_dot_dot, [(s, L*cos(theta))])
    """
    found = {u: _resultant(system, u) for u in (*system.coordinates, *system.kinematics)}
    return Resultants(system, {u: R for u, R in found.items() if R != 0}, _moved(system))


def _resultant(system: Lagrangian, u: Coordinate) -> sp.Expr:
    T, V, D = system.kinetic, system.potential, system.dissipation
    R = (
        rate(T.diff(u.dot)) - T.diff(u) + V.diff(u) + D.diff(u.dot)
        - sp.Add(*(F * r.diff(u) for F, r in system.virtual_work))
    )  # fmt: skip
    return sp.Add(*(sp.factor_terms(term) for term in sp.Add.make_args(R)))


def _moved(system: Lagrangian) -> dict[tuple[Coordinate, Coordinate], sp.Expr]:
    """du/dq of every name by the chain rule, each name by those before it."""
    moved: dict[tuple[Coordinate, Coordinate], sp.Expr] = {}
    for u, definition in system.kinematics.items():
        inner = [v for v in system.kinematics if v in definition.free_symbols]
        for q in system.coordinates:
            steps = [definition.diff(q), *(definition.diff(v) * moved[v, q]
                                           for v in inner if (v, q) in moved)]  # fmt: skip
            total = _as_angles(sp.Add(*steps), system.kinematics)
            if total != 0:
                moved[u, q] = total
    return moved


def _as_angles(u: sp.Expr, kinematics: Mapping[Coordinate, sp.Expr]) -> sp.Expr:
    """The same with 1/cos θ for 1/√(1 - s²) where θ = arcsin s, and tan θ for sin θ/cos θ."""
    for angle, definition in kinematics.items():
        if not isinstance(definition, sp.asin) or not u.has(angle, *definition.free_symbols):
            continue
        square = sp.cos(definition) ** 2

        def is_power(e: sp.Expr, square: sp.Expr = square) -> bool:
            return bool(e.is_Pow and e.base == square)

        def as_cosine(e: sp.Expr, angle: Coordinate = angle) -> sp.Expr:
            return sp.cos(angle) ** (2 * e.exp)

        u = u.replace(is_power, as_cosine)
        if u.has(1 / sp.cos(angle)):
            u = sp.expand(u).xreplace({sp.sin(angle): sp.tan(angle) * sp.cos(angle)})
    return u
