"""Section 2.3 of the paper, Eqs (1) to (4), equation by equation and claim by claim."""

from __future__ import annotations

from functools import cache
from math import pi

import sympy as sp
from check_values import Pair, base, beam, change, comfort_table, percent, shown, values
from claims import FAILS, FOLLOWS, Claim, claim, columns, figure
from paper import TABLE_1, coach

from railride.halfbody import PAPER_VALUES, L_h, half_body, k_theta, m_h, positions, theta
from railride.halfbody_report import Derivation
from railride.lagrange import Coordinate, Lagrangian, rate
from railride.linear import LinearModel, linearise
from railride.markup import Equation, Table, math

GRAVITY = 9.81
DAMPING = (0.0, 0.005, 0.01, 0.015, 0.02)
BAND_HZ = (8.0, 9.0, 9.6, 10.0, 11.0, 12.0)


def claims() -> list[Claim]:
    """The claims in their order."""
    return [one_coordinate(), position_vectors(), energies(), equation_of_motion(), linear(),
            joint_stiffness(), torsional_damper(), structural_damping()]  # fmt: skip


@cache
def symmetric_body() -> Lagrangian:
    """Two halves turned by ±θ, the hinge at height z: all that symmetry about the hinge leaves."""
    z = Coordinate("z")
    middle = sp.Matrix([L_h / 2 * sp.cos(theta), z - L_h / 2 * sp.sin(theta)])
    v = rate(middle)
    T = m_h * v.dot(v) + m_h * L_h**2 / 12 * theta.dot**2
    return Lagrangian([z, theta], sp.simplify(T), 2 * k_theta * theta**2)


def squares(model: LinearModel) -> list[sp.Expr]:
    """The ω² of a small undamped system."""
    omega2 = sp.Symbol("omega2")
    return sorted(sp.solve((model.K - omega2 * model.M).det(), omega2), key=str)


def one_coordinate() -> Claim:
    """Symmetry leaves two coordinates."""
    found = linearise(symmetric_body())
    constraint = sp.Matrix([L_h, 1])  # z = L_h θ
    held = sp.simplify((constraint.T * found.M * constraint)[0])
    inertia = sp.expand(half_body().kinetic).coeff(theta.dot, 2).subs(theta, 0) * 2
    same = sp.simplify(held - inertia) == 0
    listed = ", ".join(f"${math(sp.factor(s))}$" for s in squares(found))
    return claim(
        "One coordinate because of the symmetry",
        "Section 2.3",
        "one generalized coordinate, θ, was assumed because of the symmetry in the longitudinal "
        "direction",
        "symmetry leaves the one coordinate θ",
        FAILS,
        "see [[Joint stiffness from the bending frequency]]",
        r"Symmetry about the hinge makes the halves turn by $\theta$ and $-\theta$. It says "
        r"nothing of the height $z$ of the hinge, which is a second coordinate:",
        Equation(f"T = {math(sp.expand(symmetric_body().kinetic))}"),
        Equation(rf"M = {math(found.M.applyfunc(sp.factor))}, \qquad K = {math(found.K)}"),
        rf"Its two $\omega^2$ are {listed}: a uniform lift, and the bending of the free body. The "
        r"paper arrives at one coordinate by a further constraint, $z = L_h \sin\theta$, which "
        rf"holds the ends at height zero; put in here it leaves the inertia ${math(held)}$, "
        f"{'that' if same else 'not that'} of Eq (4). That constraint is a support, not a "
        "symmetry.",
    )


def position_vectors() -> Claim:
    """Eq (1)."""
    momentum = sp.factor(m_h * (rate(positions()[0]) + rate(positions()[1]))[1])
    ends = {name: r[1] for name, r in Derivation(False).ends.items()}
    rows = [(name, f"${math(height)}$") for name, height in ends.items()]
    return claim(
        "Position vectors",
        "Eq (1), Section 2.3",
        "The position vectors of the front and rear car body halves were calculated as follows",
        "Eq (1) describes the car body in bending",
        FAILS,
        "see [[Joint stiffness from the bending frequency]]",
        "As vectors they are right for a body whose ends stay at height zero and whose rear end "
        "slides. Heights that follow from them:",
        Table(("point", "height"), rows),
        rf"The vertical momentum is then ${math(momentum)}$, not zero: in its bending mode the "
        "whole body would be pushed up and down by supports at its ends. A body free in space, "
        "or on springs much softer than itself, keeps its mass centre at rest. The two shapes, "
        "and what Section 2.1 says of horizontal guides, are different bodies:",
        figure("paper_check_halves", "The two halves as Eq (1) holds them, and free in space"),
    )


def gravity_share() -> float:
    """Relative change of Eq (4)'s ω² if the weight, left out of V, is put in."""
    weight = m_h * GRAVITY * L_h * sp.sin(theta)  # both middles at (L_h/2) sin θ
    system = half_body()
    V = system.potential + weight
    rest = sp.nsolve(V.diff(theta).subs(PAPER_VALUES), theta, 0)
    inertia = system.kinetic.diff(theta.dot, 2).subs(theta, rest)
    with_weight = (V.diff(theta, 2).subs(theta, rest) / inertia).subs(PAPER_VALUES)
    return float(with_weight / Derivation(False).omega_squared.subs(PAPER_VALUES)) - 1


def energies() -> Claim:
    """Eq (2)."""
    system = half_body()
    T = m_h * L_h**2 * theta.dot**2
    printed = T / 3 + T * sp.sin(theta) ** 2
    same = sp.simplify(system.kinetic - printed) == 0
    return claim(
        "Kinetic and potential energy",
        "Eq (2), Section 2.3",
        "Due to the symmetry, a rotation of θ caused a 2θ change in potential energy in total",
        "T and V of Eq (2) follow from Eq (1)",
        FOLLOWS if same else FAILS,
        "none",
        "From Eq (1), with rods:",
        Equation(f"T = {math(sp.expand(system.kinetic))}, \\qquad V = {math(system.potential)}"),
        "Both are as printed. (It is the angle of the spring that changes by 2θ, not the energy.) "
        "The weight is left out of V; at the static sag of Table 1's values it would change "
        rf"$\omega^2$ by {percent(gravity_share(), 4)}, and may be. The moment of inertia "
        r"$m_{c,h} L_h^2/12$ is not Table 1's ([[Pitch inertia of the car body]]), and "
        r"$m_{c,h}$ and $L_h$ are explained by their index alone.",
    )


def equation_of_motion() -> Claim:
    """Eq (3)."""
    found = Derivation(False).equation
    inertia = m_h * L_h**2
    printed = (2 * inertia / 3 + 2 * inertia * sp.sin(theta) ** 2) * theta.ddot
    printed += 2 * inertia * theta.dot**2 * sp.sin(theta) * sp.cos(theta) + 4 * k_theta * theta
    same = sp.simplify(found - printed) == 0
    return claim(
        "Nonlinear equation of motion",
        "Eq (3), Section 2.3",
        "Substituting the energy terms into the Lagrangian formulation yields the following "
        "equation of motion",
        "Eq (3) follows from Eq (2)",
        FOLLOWS if same else FAILS,
        "none",
        r"$\frac{d}{dt} \frac{\partial T}{\partial \dot\theta} - "
        r"\frac{\partial T}{\partial \theta} + \frac{\partial V}{\partial \theta}$, derived:",
        Equation(f"{math(found)} = 0"),
        "as printed.",
    )


def linear() -> Claim:
    """Eq (4)."""
    found = Derivation(False).omega_squared
    same = sp.simplify(found - 6 * k_theta / (m_h * L_h**2)) == 0
    return claim(
        "Linear equation of motion",
        "Eq (4), Section 2.3",
        "the linearized equation of motion became, in implicit form, as follows",
        "Eq (4) follows from Eq (3)",
        FOLLOWS if same else FAILS,
        "none by itself; see [[Joint stiffness from the bending frequency]]",
        Equation(rf"\ddot\theta + {math(found)} \theta = 0"),
        "as printed.",
    )


@cache
def joint_readings() -> dict[str, tuple[float, float]]:
    """Body → its first bending frequency in Hz on Table 1's k_θ, and the k_θ that 9.6 Hz needs."""
    target = (2 * pi * TABLE_1["f_bending"].value) ** 2
    found = {}
    for name, free in (("ends held, Eq (4)", False), ("free in space", True)):
        omega2 = Derivation(free).omega_squared
        needed = sp.solve(omega2 - target, k_theta)[0].subs(PAPER_VALUES)
        found[name] = (Derivation(free).frequency_hz, float(needed))
    return found


def joint_stiffness() -> Claim:
    """Finding: Eq (4) and Table 1 contradict each other by a factor 4."""
    held, free = joint_readings().values()
    factor = sp.simplify(Derivation(True).omega_squared / Derivation(False).omega_squared)
    readings: dict[str, tuple[Pair | None, Pair | None]] = {
        "free, tuned to 9.6 Hz (railride's)": (None, base(True)),
        "free, Table 1's stiffness": (None, values(coach(), k_theta=TABLE_1["k_theta"].value)),
        "stiffness from Eq (4) for 9.6 Hz, in a free vehicle": (
            None, values(coach(), k_theta=held[1])),
        "a free body of the frequency that Eq (4) gives": (
            None, values(coach(), f_bending=held[0])),
    }  # fmt: skip
    stiff, as_printed = list(readings.values())[2][1], list(readings.values())[1][1]
    hz = float(coach().changed(k_theta=held[1]).bending_frequencies()[0])
    return claim(
        "Joint stiffness from the bending frequency",
        "Section 2.3 against Table 1",
        "The first bending frequency of the car body was used to determine the stiffness of the "
        "torsion spring in the flexible rail vehicle model",
        "Eq (4) gives Table 1's stiffness for 9.6 Hz",
        FAILS,
        f"Table 1's stiffness {shown(as_printed)}; Eq (4)'s {shown(stiff)}, flexible",
        Table(
            **columns(
                "two halves", r"$\omega^2$", "with Table 1's stiffness [Hz]",
                "stiffness for 9.6 Hz [N m/rad]",
            ),
            rows=[
                (name, f"${math(Derivation(is_free).omega_squared)}$", f"{f:.3f}",
                 f"{k / 1e8:.3f} × 10⁸")
                for is_free, (name, (f, k)) in enumerate(joint_readings().items())
            ],
        ),
        rf"Between the two lies a factor of {factor} in stiffness, {sp.sqrt(factor)} in frequency. "
        rf"Table 1 prints {TABLE_1['k_theta'].value / 1e8:g} × 10⁸ N m/rad, "
        f"with which Eq (4) gives {held[0]:.2f} Hz and a free body {free[0]:.3f} Hz. So Table 1 "
        "agrees with the free body, which the paper does not derive, and Eq (4) contradicts it. A "
        rf"vehicle with the stiffness that Eq (4) asks for would bend at {hz:.1f} Hz.",
        comfort_table(readings),
        "Both derivations in full: [ends held](half_body.md), [free](half_body_free.md).",
    )  # fmt: skip


def torsional_damper() -> Claim:
    """2.1 promises a coefficient that 2.3 does not give."""
    return claim(
        "The torsional damper",
        "Section 2.1 against Section 2.3",
        "The torsional spring and torsional damper coefficients connecting the half car bodies "
        "were calculated using the method explained in Section 2.3",
        "Section 2.3 gives the damper's coefficient",
        FAILS,
        "that of [[Structural damping]]",
        "Section 2.3 calculates a stiffness only; of the damping it says that it “was quite "
        "complex to determine” and “was neglected”. Figure 4 and Section 2.1 show a damper, Table "
        "1 has no value for it. railride takes zero, as Section 2.3 says.",
    )


@cache
def damped() -> dict[float, tuple[Pair, Pair]]:
    """Structural damping ratio → a_wrms of two halves and of the beam."""
    return {z: (values(coach(), zeta_bending=z), values(beam(damping=z))) for z in DAMPING}


@cache
def lost_to_damping(ratio: float = 0.015) -> dict[float, Pair]:
    """Bending frequency in Hz → what structural damping leaves of a_wrms, as a fraction."""
    found = {}
    for f in BAND_HZ:
        without, with_it = (
            values(coach(), f_bending=f, zeta_bending=zeta) for zeta in (0.0, ratio)
        )
        found[f] = (with_it[0] / without[0], with_it[1] / without[1])
    return found


def own_damping() -> float:
    """Damping ratio of the bending mode from the suspension alone."""
    from railride import modes

    return next(m.damping_ratio for m in modes(coach()) if m.label.startswith("bending"))


def structural_damping() -> Claim:
    """Finding: the largest unknown; and the claim on 8-12 Hz."""
    table = damped()
    much = table[0.015][0]
    heads = ("two halves, 145", "two halves, 200", "beam, 145", "beam, 200")
    rows = [
        (f"{100 * z:g} %", *(f"{x:.4f}" for pair in pairs for x in pair))
        for z, pairs in table.items()
    ]
    kept = [
        (f"{f:g} Hz", *(percent(x - 1, 0) for x in pair)) for f, pair in lost_to_damping().items()
    ]
    return claim(
        "Structural damping",
        "Section 2.3",
        "for rail vehicle car bodies, whose natural frequency is between 8–12 Hz, the structural "
        "damping is negligible, according to a previous study",
        "structural damping is negligible from 8 to 12 Hz",
        FAILS,
        f"1.5 %: flexible {change(much)}",
        f"The suspension alone gives the bending mode a damping ratio of {own_damping():.4f}. What "
        "is as small as that is doubled by one per cent of structural damping, and the resonance "
        "is what the comfort value consists of:",
        Table(**columns("structural damping", *heads), rows=rows),
        "What 1.5 % takes off the flexible value, by the body's bending frequency:",
        Table(**columns("first bending", "145 km/h", "200 km/h"), rows=kept),
        "Where the wheelsets filter the bending out it matters little, elsewhere it takes a third "
        "and more. No other value that the paper leaves out weighs as much. Its own value is "
        "not printed for VAMPIRE's beam either.",
    )
