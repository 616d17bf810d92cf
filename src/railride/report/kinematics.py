"""The first part of a derivation: coordinates, their picture, positions, named quantities."""

from __future__ import annotations

import re

import sympy as sp

from railride.markup import Block, Figure, Heading, Paragraph, Table, math
from railride.report.document import Subject, definitions, listed, stacked
from railride.running_gear import bogie_heave

MEANING = {
    "z_c": "height of the car body's mass centre",
    "theta_c": "pitch of the car body",
    "eta_": "how far the car body's bending mode {} is out, where its shape is 1",
    "z_e": "height of equipment {}",
    "z_b": "height of bogie {}'s mass centre",
    "theta_b": "pitch of bogie {}",
    "d_s": "stroke of the secondary damper over bogie {}, whose mount is elastic",
    "d_p": "stroke of the primary damper over wheelset {}, whose mount is elastic",
    "z_": "height of node {} of the car body",
}
NAMED = {
    "Pitch of the segments": "theta_",
    "Places of the segments' middles along the track (the car body's middle is held)": "x_",
    "Extensions of the equipment's mounts": "s_e",
    "Extensions of the secondary suspension": r"s_\d",
    "Extensions of the primary suspension": "p_",
}
AXES = (
    "$x$ points forward along the track from the middle of the car body, $z$ up; pitch is positive "
    "nose-up, and what there are several of is numbered from the front. "
)


def coordinates(subject: Subject) -> list[Block]:
    """The coordinates and what they mean, inputs and forces."""
    system, segments = subject.system, subject.model.body.segments
    rows = [(f"${math(q)}$", *meaning_and_unit(q, segments)) for q in system.coordinates]
    return [
        Heading("Coordinates" if subject.alone else "Coordinates, inputs and forces"),
        Paragraph(AXES + _counted(subject)),
        *_figure(subject),
        Table(("coordinate", "meaning", "unit"), rows),
        *(_alone(subject) if subject.alone else _degrees(subject)),
    ]


def meaning_and_unit(q: sp.Symbol, segments: int | None) -> tuple[str, str]:
    """What a coordinate of a vehicle means, and its unit; segments : of the car body, if it has.

    >>> meaning_and_unit(sp.Symbol("z_0"), segments=4)
    ('height of node 0 of the car body, its front end', 'm')
    """
    name = str(q.name)
    head = name.rstrip("0123456789")
    number = name[len(head) :]
    text = MEANING.get(name) or MEANING.get(head, "coordinate of the car body").format(number)
    ends = {"z_0": ", its front end", f"z_{segments}": ", its rear end"}
    text += ends.get(name, ", a hinge") if head == "z_" else ""
    return text, "rad" if "theta" in name else "m"


def _counted(subject: Subject) -> str:
    if subject.alone:
        return "Heights count from the body at rest, where it is straight."
    return "Everything counts from static equilibrium, where preloads carry the weight."


def _figure(subject: Subject) -> list[Block]:
    if not subject.figure:
        return []
    what = "The car body, free," if subject.alone else "The vehicle"
    shows = "its coordinates" if subject.alone else "its coordinates and inputs"
    return [Figure(subject.figure, f"{what} and {shows}; heights are not to scale.")]


def _alone(subject: Subject) -> list[Block]:
    n = len(subject.system.coordinates)
    return [
        Paragraph(f"{n} degrees of freedom: heave and pitch of the straight body, and "
                  f"{n - 2} of bending. There are no inputs and no forces: nothing holds the body.")
    ]  # fmt: skip


def _degrees(subject: Subject) -> list[Block]:
    system, model = subject.system, subject.model
    own, hung = len(model.body.energies.coordinates), len(model.carried.equipment)
    strokes = len(model.running_gear.strokes)
    each = ", each equipment 1" * bool(hung) + ", each damper on an elastic mount 1" * bool(strokes)
    return [
        Paragraph(f"The car body has {own} coordinates{each} and "
                  f"each bogie 2: {len(system.coordinates)} degrees of freedom."),
        Paragraph(f"Inputs: the track elevations ${listed(system.inputs)}$ under the wheelsets, "
                  f"m, and their rates. Forces: ${listed(system.forces)}$, N, one actuator to "
                  "each bogie, positive when it pushes body and bogie apart."),
    ]  # fmt: skip


def positions(subject: Subject) -> list[Block]:
    """Position vectors of what has mass, and the named quantities of the energies."""
    blocks: list[Block] = [Heading("Positions and deflections")]
    vectors = _vectors(subject)
    if vectors:
        what = "the segments' middles" if subject.model.body.segments != 1 else "the mass centres"
        both = f"{what} and of the bogies" * (not subject.alone) or what
        blocks += [
            Paragraph(rf"Position vectors of {both}, $\mathbf{{i}}$ along $x$ and $\mathbf{{j}}$ "
                      "along $z$:"),
            *stacked([[rf"{name} & = {_vector(r)}"] for name, r in vectors.items()]),
        ]  # fmt: skip
    for title, head in NAMED.items():
        found = subject.system.kinematics.items()
        named = {u: r for u, r in found if re.match(head, u.name)}
        if named:
            blocks += [Paragraph(f"{title}:"), *definitions(named)]
    if subject.system.kinematics:
        blocks.append(Paragraph("Their rates follow by the chain rule."))
    return blocks


def _vectors(subject: Subject) -> dict[str, tuple[sp.Expr, sp.Expr]]:
    """Places (x, z) by the position vector's symbol."""
    model = subject.model
    found = {rf"\vec r_{_braced(name)}": r for name, r in model.body.positions.items()}
    if not subject.alone and found:
        gear = model.running_gear
        found |= {rf"\vec r_{{b{b}}}": (gear.place(b).x, bogie_heave(b)) for b in gear.bogies}
    return found


def _braced(index: str) -> str:
    return index if len(index) == 1 else f"{{{index}}}"


def _vector(r: tuple[sp.Expr, sp.Expr]) -> str:
    """x i + z j, components that vanish left out."""
    parts: list[str] = []
    for component, unit in zip(r, (r"\mathbf{i}", r"\mathbf{j}"), strict=True):
        if component != 0:
            whole = sp.factor_terms(component) if component.is_Add else component
            text = math(whole)
            sign = "" if not parts else " " if text.startswith("-") else " + "
            parts.append(rf"{sign}{text} \thinspace {unit}")
    return "".join(parts)
