"""The derivation of the car body of two halves as a document, Eqs (1)-(4) named as in the paper.

It shows by its own derivation that Eq (4) and Table 1 contradict each other: with the ends held the
k_θ of Table 1 gives half the printed frequency, and with a free body the printed one.

Source: Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848, Section 2.3, Table 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi

import sympy as sp
from sympy import cos, sin

from railride.halfbody import PAPER_VALUES, L_h, half_body, k_theta, m_h, positions, theta
from railride.lagrange import Lagrangian, rate
from railride.linear import LinearModel, linearise, linearise_equations
from railride.markup import Block, Equation, Heading, Paragraph, Table, math, sum_lines
from railride.report import LAGRANGE, for_sympy, number, render

PRINTED_HZ = 9.6  # Table 1: first bending of the car body
SYSTEM = {False: "half-body", True: "half-body-free"}
MEANING = {
    m_h: ("mass of one half", "kg"),
    L_h: ("length of one half", "m"),
    k_theta: ("stiffness of the torsional spring", "N m/rad"),
}


def half_body_document(free: bool, form: str) -> str:
    """The derivation of the paper's car body of two halves as "markdown" or "latex".

    free: False for the paper's ends held at height zero, True for a body free in space.
    """
    return render(blocks(free, form), form)


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


def blocks(free: bool, form: str) -> list[Block]:
    """The document: of the paper's body, or of the free one."""
    own, other = Derivation(free), Derivation(not free)
    return [
        *_opening(free, form),
        *_positions(own),
        *_energies(own),
        *_equation(own),
        *_linear(own),
        *_numbers(own),
        *_comparison(own, other),
        *for_sympy(own.system, own.linear, equations=True,
                   omega_squared=str(own.omega_squared)),
    ]  # fmt: skip


def _opening(free: bool, form: str) -> list[Block]:
    body = "free in space" if free else "as the paper derives it"
    held = (
        "Here the body is free in space, where its mass centre stays at rest and both halves only "
        "rotate."
        if free
        else "The paper holds the front end of the body at the origin and lets its rear end slide "
        "along the $x$ axis: both ends stay at height zero."
    )
    twin = f"`railride derive --system {SYSTEM[not free]} --format {form}`"
    return [
        Heading(f"The car body of two halves, {body}", 1),
        Paragraph(f"Made by `railride derive --system {SYSTEM[free]} --format {form}`. Source: "
                  "Çati, Düzgün, Kracht, Appl. Sci. 2024, 14, 3848 (CC BY 4.0), Section 2.3; "
                  "numbers in brackets at the right are those of its equations"
                  + (", of which the free body's are the counterparts." if free else ".")),
        Paragraph(f"Two slender rods, each of mass $m_h$ and length $L_h$, are joined at a hinge "
                  rf"by a torsional spring $k_\theta$. {held} The other case is made by {twin}."),
    ]  # fmt: skip


def _positions(own: Derivation) -> list[Block]:
    r_F, r_R = positions(own.free)
    free = own.free
    points = [(name, f"${math(r[0])}$", f"${math(r[1])}$") for name, r in own.ends.items()]
    named = ((r"\vec r_F", r_F), (r"\vec r_R", r_R))
    lines = [rf"{name} & = {_vector(r)}" for name, r in named]
    rates = [rf"\dot{{{name[:-2]}}}{name[-2:]} & = {_vector(rate(r))}" for name, r in named]
    origin = "the mass centre" if free else "the front end"
    return [
        Heading("Coordinate"),
        Paragraph(rf"One coordinate, $q = (\theta)$: the front half is turned by $\theta$, the "
                  rf"rear half by $-\theta$, counted from the straight body. $x$ runs from the "
                  f"front to the rear, $z$ up, and the origin is {origin}. There are no inputs and "
                  "no forces: the body is alone."),
        Heading("Positions and velocities"),
        Paragraph(r"The middles of the halves, $\mathbf{i}$ along $x$ and $\mathbf{j}$ along $z$:"),
        Equation(rf"\begin{{aligned}} {lines[0]} \\ {lines[1]} \end{{aligned}}", _tag("1", free)),
        Paragraph("and with them"),
        Table(("point", "$x$", "$z$"), points),
        Paragraph(_momentum(own)),
        Paragraph("Velocities:"),
        Equation(rf"\begin{{aligned}} {rates[0]} \\ {rates[1]} \end{{aligned}}"),
    ]  # fmt: skip


def _momentum(own: Derivation) -> str:
    height = own.ends["mass centre"][1]
    if height == 0:
        return "The mass centre stays where it is: no force acts on the body from outside."
    momentum = sp.factor(2 * m_h * rate(height))
    return (f"The mass centre rises and falls, so that the body's vertical momentum is "
            f"${math(momentum)}$: the supports at the ends must push it, and a car body on soft "
            "springs has no such supports.")  # fmt: skip


def _energies(own: Derivation) -> list[Block]:
    T, V = sp.expand(own.system.kinetic), own.system.potential
    return [
        Heading("Energies"),
        Paragraph(r"With $I_h = \frac{1}{12} m_h L_h^2$ and the hinge opening by $2\theta$:"),
        Equation(r"T = \frac{1}{2} m_h \left(\dot{\vec r}_F \cdot \dot{\vec r}_F + \dot{\vec r}_R "
                 r"\cdot \dot{\vec r}_R\right) + 2 \cdot \frac{1}{2} I_h \dot\theta^2 = "
                 rf"{math(T)}", _tag("2", own.free)),
        Equation(rf"V = \frac{{1}}{{2}} k_\theta \left(2 \theta\right)^2 = {math(V)}",
                 _tag("2", own.free)),
        Paragraph("Nothing dissipates, $D = 0$, and no further force does work, "
                  r"$\delta W = 0$."),
    ]  # fmt: skip


def _equation(own: Derivation) -> list[Block]:
    T, V = own.system.kinetic, own.system.potential
    momentum = sp.expand(T.diff(theta.dot))
    steps = {
        r"\frac{\partial T}{\partial \dot\theta}": momentum,
        r"\frac{d}{dt} \frac{\partial T}{\partial \dot\theta}": sp.collect(
            sp.expand(rate(momentum)), theta.ddot
        ),
        r"\frac{\partial T}{\partial \theta}": sp.expand(T.diff(theta)),
        r"\frac{\partial V}{\partial \theta}": V.diff(theta),
    }
    return [
        Heading("Lagrange's equation"),
        Equation(LAGRANGE),
        Paragraph("term by term:"),
        *(Equation(sum_lines(name, u)) for name, u in steps.items()),
        Paragraph("The equation of motion, nonlinear:"),
        Equation(f"{math(own.equation)} = 0", _tag("3", own.free)),
    ]


def _linear(own: Derivation) -> list[Block]:
    M, K = own.linear.M[0, 0], own.linear.K[0, 0]
    rest = own.equation.subs({theta: 0, theta.dot: 0, theta.ddot: 0})
    return [
        Heading("Linear equation of motion"),
        Paragraph(rf"At $\theta = 0$ and at rest the left-hand side is ${math(rest)}$: an "
                  "equilibrium. About it"),
        Equation(r"M \ddot q + C \dot q + K q = 0, \qquad "
                 rf"M = \begin{{bmatrix}} {math(M)} \end{{bmatrix}}, \quad C = \begin{{bmatrix}} "
                 rf"{math(own.linear.C[0, 0])} \end{{bmatrix}}, \quad "
                 rf"K = \begin{{bmatrix}} {math(K)} \end{{bmatrix}}"),
        Paragraph("($K_w$, $C_w$ and $B_f$ have no columns.) The matrices from the energies "
                  "directly and those from the nonlinear equation are the same. Divided by $M$:"),
        Equation(rf"\ddot\theta + {math(own.omega_squared)} \theta = 0", _tag("4", own.free)),
    ]  # fmt: skip


def _numbers(own: Derivation) -> list[Block]:
    rows = [
        (f"${math(s)}$", number(value), MEANING[s][1], MEANING[s][0])
        for s, value in PAPER_VALUES.items()
    ]
    mode = ("first bending", f"${math(own.omega_squared)}$", f"{own.frequency_hz:.3f}", "$0$")
    columns = ("mode", r"$\omega^2$", "frequency [Hz]", "damping ratio")
    return [
        Heading("Parameters"),
        Table(("symbol", "value", "unit", "meaning"), rows, figures=("value",)),
        Paragraph(r"Table 1 of the paper, whose $m_c$ and $L$ are those of both halves together."),
        Heading("Natural frequency and mode"),
        Table(columns, [mode], figures=columns[2:]),
        Paragraph(r"In the mode both halves turn by the same angle in opposite senses."),
    ]  # fmt: skip


def _comparison(own: Derivation, other: Derivation) -> list[Block]:
    held, free = (other, own) if own.free else (own, other)
    factor = sp.simplify(free.omega_squared / held.omega_squared)
    needed = sp.solve(held.omega_squared - (2 * pi * PRINTED_HZ) ** 2, k_theta)[0].subs(
        PAPER_VALUES
    )
    return [
        Heading("Against the print"),
        Paragraph(rf"The paper prints a first bending frequency of {PRINTED_HZ} Hz beside this "
                  r"$k_\theta$."),
        Table(
            ("body", r"$\omega^2$", "frequency [Hz]", "of the printed"),
            [(name, f"${math(d.omega_squared)}$", f"{d.frequency_hz:.3f}",
              f"{100 * d.frequency_hz / PRINTED_HZ:.1f} %")
             for name, d in (("ends held, the paper's Eq (4)", held), ("free", free))],
            figures=("frequency [Hz]", "of the printed"),
        ),
        Paragraph(f"Between the two lies a factor of {factor} in stiffness, {sp.sqrt(factor)} in "
                  "frequency. "
                  rf"Eq (4) would need $k_\theta$ = {number(float(needed), 4)} N m/rad for the "
                  "printed frequency; the printed stiffness belongs to the free body. Eq (4) and "
                  "Table 1 contradict each other, and railride builds its vehicles free."),
    ]  # fmt: skip


def _vector(r: sp.Matrix) -> str:
    """x i + z j, components that vanish left out."""
    parts: list[str] = []
    for component, unit in zip(r, (r"\mathbf{i}", r"\mathbf{j}"), strict=True):
        if component != 0:
            text = math(component)
            sign = "" if not parts else " " if text.startswith("-") else " + "
            parts.append(rf"{sign}{text} \thinspace {unit}")
    return "".join(parts)


def _tag(number: str, free: bool) -> str:
    return f"cf. {number}" if free else number
