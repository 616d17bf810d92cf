r"""Derivations as documents: a vehicle's, and that of the paper's car body of two halves.

Each reads like a textbook's, from the coordinates over T, V and D to the linear equations

.. math:: M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f ,

and on to natural frequencies. Every equation and every figure is derived as the document is made;
at its end the same mathematics stands as text that sympy reads back.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import sympy as sp

from railride import markup, modal
from railride.lagrange import Coordinate, Lagrangian
from railride.linear import LinearModel
from railride.markup import (
    Block,
    Code,
    Equation,
    Heading,
    Paragraph,
    Table,
    aligned,
    math,
    sum_lines,
)
from railride.parameters import load_vehicle, shipped_vehicles
from railride.vehicle import VehicleModel

WIDEST = 110  # characters across a matrix that is shown whole
PRINTED_WHOLE = 64  # entries beyond which a matrix is listed instead
TOGETHER = 8  # equations in one block
RENDERERS = {"markdown": markup.markdown, "latex": markup.latex}


def render(blocks: Iterable[Block], form: str) -> str:
    """A document as text; ``form`` is "markdown" or "latex"."""
    return RENDERERS[form](blocks)


def vehicle_document(model: VehicleModel, form: str, nonlinear: bool = False) -> str:
    """The derivation of a vehicle's equations of motion.

    Parameters
    ----------
    form : "markdown" or "latex".
    nonlinear : with the nonlinear equations of motion.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> model = derive_vehicle(load_vehicle("cati2024"), segments=1)
    >>> print(vehicle_document(model, "markdown").splitlines()[0])
    # cati2024: a rigid car body on 2 bogies
    """
    system, linear = model.lagrangian, model.linear.map(sp.factor)
    blocks = [
        *_opening(model, form, nonlinear),
        *_coordinates(model),
        *_kinematics(system),
        *_energies(system),
        *(_nonlinear(system) if nonlinear else ()),
        *_linear(linear),
        *_parameters(model),
        *_modes(model),
        *for_sympy(system, linear, equations=nonlinear),
    ]
    return render(blocks, form)


def command(model: VehicleModel, form: str, nonlinear: bool = False) -> str:
    """The command line that makes the document; FILE stands for a vehicle that is not shipped."""
    name, body = model.vehicle.name, model.vehicle.body
    shipped = name in shipped_vehicles()
    words = [f"railride derive --vehicle {name if shipped else 'FILE'}"]
    words.append(model.body.options)
    given = load_vehicle(name).body if shipped else body
    stiffness = body.joint_stiffness  # the option gives one number; a list is the vehicle's own
    if isinstance(stiffness, float) and stiffness != given.joint_stiffness:
        words.append(f"--joint-stiffness {stiffness:.10g}")
    elif body.bending_frequency not in (None, given.bending_frequency):
        words.append(f"--bending-frequency {body.bending_frequency:.10g}")
    if body.bending_damping != given.bending_damping:
        words.append(f"--bending-damping {body.bending_damping:.10g}")
    return " ".join([*words, *(["--nonlinear"] if nonlinear else []), f"--format {form}"])


def _opening(model: VehicleModel, form: str, nonlinear: bool) -> list[Block]:
    bogies = len(model.vehicle.bogies)
    source = f" Source of the values: {model.vehicle.source}" if model.vehicle.source else ""
    remarks = [*model.vehicle.remarks, *model.remarks]
    return [
        Heading(
            f"{model.vehicle.name}: {model.body.phrase} on {bogies} bogie{'s' * (bogies != 1)}", 1
        ),
        Paragraph(f"Made by `{command(model, form, nonlinear)}`.{source}"),
        *(Paragraph(f"Remark: {remark}.") for remark in remarks),
    ]


MEANING = {
    "z_c": "height of the car body's mass centre",
    "theta_c": "pitch of the car body",
    "eta_": "how far the car body's bending mode {} is out, where its shape is 1",
    "z_e": "height of equipment {}",
    "z_b": "height of bogie {}'s mass centre",
    "theta_b": "pitch of bogie {}",
    "z_": "height of node {} of the car body",
}


def _meaning(name: str, last: int | None) -> str:
    head = name.rstrip("0123456789")
    number = name[len(head) :]
    text = MEANING.get(name) or MEANING.get(head, "coordinate of the car body").format(number)
    ends = {"z_0": ", its front end", f"z_{last}": ", its rear end"}
    return text + (ends.get(name, ", a hinge") if head == "z_" else "")


def _coordinates(model: VehicleModel) -> list[Block]:
    system = model.lagrangian
    n, own = len(system.coordinates), len(model.body.energies.coordinates)
    hung = len(model.carried.equipment)
    rows = [
        (f"${math(q)}$", _meaning(q.name, model.body.segments), "rad" if "theta" in q.name else "m")
        for q in system.coordinates
    ]
    return [
        Heading("Coordinates, inputs and forces"),
        Paragraph("$x$ points forward along the track from the middle of the car body, $z$ up; "
                  "pitch is positive nose-up. Everything counts from static equilibrium, where "
                  "preloads carry the weight, and is numbered from the front."),
        Table(("coordinate", "meaning", "unit"), rows),
        Paragraph(f"The car body has {own} coordinates{', each equipment 1' if hung else ''} and "
                  f"each bogie 2: {n} degrees of freedom."),
        Paragraph(f"Inputs: the track elevations ${_listed(system.inputs)}$ under the wheelsets, "
                  f"m, and their rates. Forces: ${_listed(system.forces)}$, N, one actuator to "
                  "each bogie, positive when it pushes body and bogie apart."),
    ]  # fmt: skip


def _kinematics(system: Lagrangian) -> list[Block]:
    groups = {
        "Pitch of the segments": "theta_",
        "Places of the segments' middles along the track (the car body's middle is held)": "x_",
        "Extensions of the equipment's mounts": "s_e",
        "Extensions of the secondary suspension": r"s_\d",
        "Extensions of the primary suspension": "p_",
    }
    blocks: list[Block] = [Heading("Kinematics")]
    for title, head in groups.items():
        named = {u: r for u, r in system.kinematics.items() if re.match(head, u.name)}
        if named:
            blocks += [Paragraph(f"{title}:"), *_definitions(named)]
    blocks.append(Paragraph("Their rates follow by the chain rule."))
    return blocks


def _definitions(named: Mapping[Coordinate, sp.Expr]) -> list[Block]:
    """``u = expression`` under each other, a few to a block."""
    ordered = sorted(named, key=lambda u: markup.natural(u.name))
    lines = [f"{math(u)} & = {math(named[u])}" for u in ordered]
    starts = range(0, len(lines), TOGETHER)
    return [Equation(aligned(lines[start : start + TOGETHER])) for start in starts]


def _energies(system: Lagrangian) -> list[Block]:
    blocks: list[Block] = [Heading("Energies and virtual work")]
    kinds = (("Kinetic energy", "T", system.kinetic), ("Potential energy", "V", system.potential),
             ("Rayleigh's dissipation function", "D", system.dissipation))  # fmt: skip
    for name, letter, expression in kinds:
        blocks += [Paragraph(f"{name}:"), Equation(sum_lines(letter, expression))]
    if system.virtual_work:
        work = " + ".join(rf"{math(F)} \delta {math(r)}" for F, r in system.virtual_work)
        blocks += [Paragraph("Virtual work of the forces:"), Equation(rf"\delta W = {work}")]
    blocks += [Paragraph("Lagrange's equations, one for each coordinate:"), Equation(LAGRANGE)]
    return blocks


LAGRANGE = (
    r"\frac{d}{dt} \frac{\partial T}{\partial \dot q_i} - \frac{\partial T}{\partial q_i}"
    r" + \frac{\partial V}{\partial q_i} + \frac{\partial D}{\partial \dot q_i} = Q_i"
)


def _nonlinear(system: Lagrangian) -> list[Block]:
    """The equations of motion, each equal to zero, with the segments' pitch angles named."""
    blocks: list[Block] = [Heading("Nonlinear equations of motion")]
    for q, equation in zip(system.coordinates, system.equations(), strict=True):
        named = sp.factor_terms(_named_angles(equation, system.kinematics))
        blocks += [Paragraph(f"For ${math(q)}$:"), Equation(sum_lines("0", named))]
    return blocks


def _named_angles(u: sp.Expr, kinematics: Mapping[Coordinate, sp.Expr]) -> sp.Expr:
    """The same expression with θ for arcsin s, and cos²θ for 1 - s²."""
    for angle, definition in kinematics.items():
        if not isinstance(definition, sp.asin):
            continue
        cosine_squared = sp.cos(definition) ** 2

        def is_power(e: sp.Expr, base: sp.Expr = cosine_squared) -> bool:
            return bool(e.is_Pow and e.base == base)

        def as_cosine(e: sp.Expr, angle: Coordinate = angle) -> sp.Expr:
            return sp.cos(angle) ** (2 * e.exp)

        u = u.replace(is_power, as_cosine).xreplace(
            {definition: angle, cosine_squared: sp.cos(angle) ** 2}
        )
    return u


def _linear(linear: LinearModel) -> list[Block]:
    columns = {"K_w": linear.inputs, "C_w": linear.inputs, "B_f": linear.forces}
    blocks: list[Block] = [
        Heading("Linear equations of motion"),
        Paragraph("At $q = 0$, $w = 0$, $f = 0$ every generalised force vanishes: the operating "
                  "point is an equilibrium, which is checked as the matrices are made. About it"),
        Equation(r"M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f"),
        Paragraph(rf"with $q = ({_listed(linear.coordinates)})$, "
                  rf"$w = ({_listed(linear.inputs)})$, $f = ({_listed(linear.forces)})$ and"),
    ]  # fmt: skip
    for name, A in linear.matrices.items():
        blocks += _matrix(name, A, linear.coordinates, columns.get(name, linear.coordinates))
    lift = (
        "A uniform lift of track and vehicle strains no spring and no damper: the numbers below "
        "meet $K u_0 = K_w 1$ and $C u_0 = C_w 1$, $u_0$ the coordinates of such a lift, or there "
        "would be no document."
    )
    return [*blocks, Paragraph(lift)]


def _matrix(
    name: str, A: sp.MatrixBase, rows: Sequence[sp.Symbol], columns: Sequence[sp.Symbol]
) -> list[Block]:
    """A matrix as such where it fits, else each value with its places."""
    if not A.todok():
        return [Equation(f"{name} = 0")]
    entries = [[math(e) for e in row] for row in A.tolist()]
    across = sum(max(map(markup.width, column)) + 2 for column in zip(*entries, strict=True))
    if len(A) <= PRINTED_WHOLE and across <= WIDEST:
        return [Equation(f"{name} = {math(A.as_explicit())}")]
    places: dict[sp.Expr, list[str]] = {}
    symmetric = name in ("M", "C", "K")
    for (i, j), e in sorted(A.todok().items()):
        if not symmetric or i <= j:
            places.setdefault(e, []).append(f"$({math(rows[i])}, {math(columns[j])})$")
    found = [(f"${math(e)}$", ", ".join(at)) for e, at in places.items()]
    kind = "symmetric, the upper triangle" if symmetric else "the entries"
    return [
        Paragraph(f"${name}$, {A.shape[0]} × {A.shape[1]}, {kind} by row and column, what is not "
                  "listed is zero:"),
        Table((f"entry of ${name}$", "places"), found),
    ]  # fmt: skip


def _parameters(model: VehicleModel) -> list[Block]:
    known = model.meanings
    rows = [
        (f"${math(sp.Symbol(name))}$", number(float(value)), *_words(known.get(name, ("", ""))))
        for name, value in model.values().items()
    ]
    defined = model.body.definitions
    between = (
        [Paragraph("Among them, defined by the others:"), *_definitions(defined)] if defined else []
    )
    return [
        Heading("Parameters"),
        Table(("symbol", "value", "unit", "meaning"), rows, figures=("value",)),
        *between,
    ]


def _words(meaning_unit: tuple[str, str]) -> tuple[str, str]:
    meaning, unit = meaning_unit
    return unit.replace("^2", "²"), meaning


def number(value: float, digits: int = 6) -> str:
    r"""A figure as mathematics.

    >>> number(3.7e8), number(-8.75), number(34000.0)
    ('$3.7 \\times 10^{8}$', '$-8.75$', '$34000$')
    """
    mantissa, _, exponent = f"{value:.{digits}g}".partition("e")
    return f"${mantissa} \\times 10^{{{int(exponent)}}}$" if exponent else f"${mantissa}$"


def _modes(model: VehicleModel) -> list[Block]:
    rows = [
        (
            mode.label,
            f"{mode.frequency_hz:.4f}",
            number(mode.damping_ratio, 4),
            f"{100 * mode.share:.0f} %",
        )
        for mode in modal.modes(model)
    ]
    undamped = ", ".join(f"{f:.4f}" for f in modal.undamped_frequencies(model.matrices()))
    columns = ("mode", "frequency [Hz]", "damping ratio", "energy share")
    return [
        Heading("Natural frequencies and modes"),
        Paragraph(r"From $(\lambda^2 M + \lambda C + K) \varphi = 0$: the frequency is "
                  r"$\vert\lambda\vert / 2\pi$, the damping ratio "
                  r"$-\mathrm{Re} \lambda / \vert\lambda\vert$; a mode is named after the free "
                  "motion that holds the given share of its kinetic energy."),
        Table(columns, rows, figures=columns[1:]),
        Paragraph(f"Undamped, from $K$ and $M$ alone: {undamped} Hz."),
    ]  # fmt: skip


def for_sympy(
    system: Lagrangian, linear: LinearModel, *, equations: bool, **more: Any
) -> list[Block]:
    """The same mathematics as JSON of sympy's own strings; of a matrix what is not zero."""
    document: dict[str, Any] = {
        "coordinates": [q.name for q in system.coordinates],
        "inputs": [w.name for w in system.inputs],
        "forces": [f.name for f in system.forces],
        "kinematics": {u.name: str(r) for u, r in system.kinematics.items()},
        "T": str(system.kinetic),
        "V": str(system.potential),
        "D": str(system.dissipation),
    }
    if equations:
        document["equations"] = [str(e) for e in system.equations()]
    for name, A in linear.matrices.items():
        document[name] = {f"{i},{j}": str(e) for (i, j), e in sorted(A.todok().items())}
    text = json.dumps(document | more, indent=1, ensure_ascii=False)
    return [
        Heading("For a program"),
        Paragraph("The same as expressions that sympy reads; `_dot` is a rate, a matrix is its "
                  "entries by row and column, counted from 0."),
        Code(text, "json"),
    ]  # fmt: skip


def _listed(symbols: Sequence[sp.Symbol]) -> str:
    return ", ".join(math(s) for s in symbols)
