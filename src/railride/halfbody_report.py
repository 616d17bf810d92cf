"""The derivation of the car body of two halves as a document, Eqs (1)-(4) named as in the paper.

It shows by its own derivation that Eq (4) and Table 1 contradict each other: with the ends held the
k_θ of Table 1 gives half the printed frequency, and with a free body the printed one.

Source: Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848, Section 2.3, Table 1.
"""

from __future__ import annotations

from math import pi
from shlex import quote

import sympy as sp

from railride.halfbody import PAPER_VALUES, Derivation, L_h, k_theta, m_h, positions, theta
from railride.lagrange import rate
from railride.markup import (
    Block,
    Equation,
    Figure,
    Heading,
    Paragraph,
    Table,
    math,
    number,
    sum_lines,
)
from railride.preloads import g
from railride.report import LAGRANGE, for_sympy, render

N_theta = sp.Symbol("N_theta", real=True)

PRINTED_HZ = 9.6  # Table 1: first bending of the car body
SYSTEM = {False: "half-body", True: "half-body-free"}
MEANING = {
    m_h: ("mass of one half", "kg"),
    L_h: ("length of one half", "m"),
    k_theta: ("stiffness of the torsional spring", "N m/rad"),
}


def half_body_document(free: bool, form: str, figure: str = "", document: str = "") -> str:
    """The derivation of the paper's car body of two halves as "markdown" or "latex".

    free: False for the paper's ends held at height zero, True for a body free in space.
    figure: file name of a picture of the coordinate, to be shown.
    document: file name under which the document is kept, for the command that makes it.
    """
    return render(blocks(free, form, figure, document), form)


def blocks(free: bool, form: str, figure: str = "", document: str = "") -> list[Block]:
    """The document: of the paper's body, or of the free one."""
    own, other = Derivation(free), Derivation(not free)
    return [
        *_opening(free, form, document),
        *_coordinate(free, figure),
        *_positions(own),
        *_energies(own),
        *_equation(own),
        *_equilibrium(own),
        *_linear(own),
        *_numbers(own),
        *_comparison(own, other),
        *for_sympy(own.system, own.linear, equations=[str(e) for e in own.system.equations()],
                   omega_squared=str(own.omega_squared)),
    ]  # fmt: skip


def _opening(free: bool, form: str, document: str) -> list[Block]:
    body = "free in space" if free else "as the paper derives it"
    held = (
        "Here the body is free in space, where its mass centre stays at rest and both halves only "
        "rotate."
        if free
        else "The paper holds the front end of the body at the origin and lets its rear end slide "
        "along the $x$ axis: both ends stay at height zero."
    )
    kept = f" --output {quote(document)}" if document else ""
    twin = f"`railride derive --system {SYSTEM[not free]} --format {form}`"
    return [
        Heading(f"The car body of two halves, {body}", 1),
        Paragraph(f"Made by `railride derive --system {SYSTEM[free]} --format {form}{kept}`. "
                  "Source: Çati, Düzgün, Kracht, Appl. Sci. 2024, 14, 3848 (CC BY 4.0), Section "
                  "2.3; numbers in brackets at the right are those of its equations"
                  + (", of which the free body's are the counterparts." if free else ".")),
        Paragraph(f"Two slender rods, each of mass $m_h$ and length $L_h$, are joined at a hinge "
                  rf"by a torsional spring $k_\theta$. {held} The other case is made by {twin}."),
    ]  # fmt: skip


def _coordinate(free: bool, figure: str) -> list[Block]:
    origin = "the mass centre" if free else "the front end"
    shown = Figure(figure, f"The two halves, {'free' if free else 'their ends held'}: the front "
                   "one on the left, the coordinate, and the places of their middles.")  # fmt: skip
    return [
        Heading("Coordinate"),
        Paragraph(rf"One coordinate, $q = (\theta)$: the front half is turned by $\theta$, the "
                  rf"rear half by $-\theta$, counted from the straight body. $x$ runs from the "
                  f"front to the rear, $z$ up, and the origin is {origin}. There are no inputs and "
                  "no forces: the body is alone."),
        *([shown] if figure else []),
    ]  # fmt: skip


def _positions(own: Derivation) -> list[Block]:
    r_F, r_R = positions(own.free)
    free = own.free
    points = [(name, f"${math(r[0])}$", f"${math(r[1])}$") for name, r in own.ends.items()]
    named = ((r"\vec r_F", r_F), (r"\vec r_R", r_R))
    lines = [rf"{name} & = {_vector(r)}" for name, r in named]
    rates = [rf"\dot{{{name[:-2]}}}{name[-2:]} & = {_vector(rate(r))}" for name, r in named]
    return [
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


def _equilibrium(own: Derivation) -> list[Block]:
    r"""That θ = 0 is one, and what gravity would change: V_0 = m_h g (z_F + z_R) - N 2θ."""
    rest = own.equation.subs({theta: 0, theta.dot: 0, theta.ddot: 0})
    opening = 2 * theta
    weight = sp.factor(m_h * g * sum(r[1] for r in positions(own.free)))
    N = sp.solve((weight - N_theta * opening).diff(theta).subs(theta, 0), N_theta)[0]
    second = (weight - N * opening).diff(theta, 2).subs(theta, 0)
    told = (
        "Gravity does no work here: the mass centre stays."
        if weight == 0
        else rf"Gravity is left out of $V$: the spring carries it by a preload. With both, $V_0 = "
        rf"{math(weight)} - N_\theta \cdot 2 \theta$ has the derivative 0 at $\theta = 0$ if "
        rf"$N_\theta = {math(N)}$, and its second derivative there is ${math(second)}$: neither "
        "leaves a term in the linear equation."
    )
    return [
        Heading("Equilibrium"),
        Paragraph(rf"At $\theta = 0$ and at rest the left-hand side is ${math(rest)}$: the "
                  rf"generalised force $-\partial V / \partial \theta$ vanishes. {told}"),
    ]  # fmt: skip


def _linear(own: Derivation) -> list[Block]:
    M, K = own.linear.M[0, 0], own.linear.K[0, 0]
    return [
        Heading("Linear equation of motion"),
        Paragraph("About the equilibrium"),
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
        Paragraph(
            r"Table 1 of the paper, whose $m_c$ and $L$ are those of both halves together; $m_h$ "
            r"is the paper's $m_{c,h}$."
        ),
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
