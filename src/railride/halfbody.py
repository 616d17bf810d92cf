r"""The paper's car body of two halves on one torsional spring, as it derives it, and free in space.

Çati, Düzgün, Kracht (Appl. Sci. 2024, 14, 3848), Eqs (1)-(4), hold the front end of the body at the
origin and let its rear end slide along the x axis: both ends stay at height zero, and

.. math:: \ddot\theta + \frac{6 k_\theta}{m_h L_h^2}\theta = 0 .

A free body keeps its mass centre at rest instead, both halves only rotate about their own middles,

.. math:: \ddot\theta + \frac{24 k_\theta}{m_h L_h^2}\theta = 0 ,

and it is this one with which the paper's k_θ and its 9.6 Hz agree.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import sympy as sp
from sympy import Matrix, Rational, cos, sin

from railride.lagrange import Coordinate, Lagrangian, rate
from railride.linear import LinearModel, linearise, linearise_equations

m_h, L_h, k_theta = sp.symbols("m_h L_h k_theta", positive=True)
theta = Coordinate("theta")

PAPER_VALUES = {m_h: 17_000.0, L_h: 12.0, k_theta: 3.7e8}  # kg, m, N m/rad: Table 1, halved


def positions(free: bool = False) -> tuple[sp.Matrix, sp.Matrix]:
    """Places (x, z) of the middles of the front and the rear half; Eq (1) unless ``free``.

    Free, the origin is the mass centre, about which the halves lie to the left and to the right.
    """
    if free:
        x, z = L_h / 2 * cos(theta), sp.S.Zero
        return Matrix([-x, z]), Matrix([x, z])
    r_F = Matrix([L_h / 2 * cos(theta), L_h / 2 * sin(theta)])
    r_R = Matrix([3 * L_h / 2 * cos(theta), L_h / 2 * sin(theta)])
    return r_F, r_R


def half_body(free: bool = False) -> Lagrangian:
    """Two rods of mass m_h and length L_h that turn by ±θ, joined by a torsional spring: Eq (2).

    Parameters
    ----------
    free : False for the paper's ends held at height zero, True for a body free in space.

    Examples
    --------
    >>> half_body().equations()[0].coeff(theta.dot, 2).factor()
    2*L_h**2*m_h*sin(theta)*cos(theta)
    """
    I_h = m_h * L_h**2 / 12
    v_F, v_R = (rate(r) for r in positions(free))
    T = m_h * (v_F.dot(v_F) + v_R.dot(v_R)) / 2 + 2 * Rational(1, 2) * I_h * theta.dot**2
    V = k_theta * (2 * theta) ** 2 / 2
    return Lagrangian([theta], sp.simplify(T), V)


@dataclass(frozen=True)
class Derivation:
    """One reading of the two halves, and all that follows from it."""

    free: bool

    @cached_property
    def system(self) -> Lagrangian:
        """The energies."""
        return half_body(self.free)

    @cached_property
    def equation(self) -> sp.Expr:
        """The nonlinear equation of motion, left-hand side, ordered by the second rate."""
        return sp.collect(sp.expand(self.system.equations()[0]), theta.ddot)

    @cached_property
    def linear(self) -> LinearModel:
        """M and K, from the energies; the nonlinear equation must give the same.

        Raises
        ------
        ArithmeticError : they differ.
        """
        linear, check = linearise(self.system), linearise_equations(self.system)
        for name, A in linear.matrices.items():
            if sp.simplify(A - check.matrices[name]).todok():
                raise ArithmeticError(f"{name}: the two ways to linearise differ")
        return linear.map(sp.factor)

    @property
    def omega_squared(self) -> sp.Expr:
        """ω² = K/M."""
        return sp.factor(self.linear.K[0, 0] / self.linear.M[0, 0])

    @property
    def frequency_hz(self) -> float:
        """The natural frequency with the paper's values."""
        return float(sp.sqrt(self.omega_squared.subs(PAPER_VALUES))) / (2 * pi)

    @property
    def ends(self) -> dict[str, sp.Matrix]:
        """Points of the body: the ends, the hinge and the mass centre."""
        front, rear = positions(self.free)
        along_front = L_h / 2 * sp.Matrix([cos(theta), sin(theta)])
        along_rear = L_h / 2 * sp.Matrix([cos(theta), -sin(theta)])
        points = {
            "front end": front - along_front,
            "hinge": front + along_front,
            "rear end": rear + along_rear,
            "mass centre": (front + rear) / 2,
        }
        return {name: sp.simplify(r) for name, r in points.items()}
