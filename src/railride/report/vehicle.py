"""The derivation of a vehicle's equations of motion, or of its car body's alone."""

from __future__ import annotations

from collections.abc import Sequence
from shlex import quote
from typing import Any

from railride.markup import Block, Heading, Paragraph
from railride.parameters import load_vehicle, shipped_vehicles
from railride.report import dynamics, equilibrium, kinematics, numbers, structure
from railride.report.document import Subject, for_sympy, render, repeatable
from railride.resultants import resultants
from railride.vehicle import VehicleModel


def vehicle_document(
    model: VehicleModel, form: str, nonlinear: bool = False, *, alone: bool = False,
    figure: str = "", document: str = "",
) -> str:  # fmt: skip
    """The derivation of a vehicle's equations of motion.

    Parameters
    ----------
    form : "markdown" or "latex".
    nonlinear : with the nonlinear equations of motion.
    alone : of the car body alone, free in space.
    figure : file name of a picture of the coordinates, to be shown.
    document : file name under which the document is kept, for the command that makes it.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> model = derive_vehicle(load_vehicle("cati2024"), segments=1)
    >>> print(vehicle_document(model, "markdown").splitlines()[0])
    # cati2024: a rigid car body on 2 bogies
    """
    subject = Subject(model, alone, form, nonlinear, figure, document)
    return render(vehicle_blocks(subject, f"Made by `{command(subject)}`."), form)


@repeatable()
def vehicle_blocks(
    subject: Subject, made: str, behind: Sequence[Block] = (), **more: Any
) -> list[Block]:
    """The same in blocks.

    made : what made it, a sentence. behind : blocks that follow the linear equations. more : to be
    told to a program as well.
    """
    blocks = [
        *_opening(subject, made),
        *kinematics.coordinates(subject),
        *kinematics.positions(subject),
        *dynamics.energies(subject),
    ]
    if subject.nonlinear:
        parts = resultants(subject.system)
        blocks += dynamics.nonlinear(subject, parts)
        more |= {"resultants": {u.name: str(R) for u, R in parts.of.items()},
                 "derivatives": {f"{u.name}, {q.name}": str(e)
                                 for (u, q), e in parts.moved.items()}}  # fmt: skip
    return [
        *blocks,
        *equilibrium.equilibrium(subject),
        *structure.linear(subject),
        *behind,
        *numbers.parameters(subject),
        *numbers.modes(subject),
        *for_sympy(subject.system, subject.linear, **more),
    ]


def command(subject: Subject) -> str:
    """The command line that makes the document; FILE stands for a vehicle that is not shipped."""
    model = subject.model
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
    words += ["--system body"] * subject.alone + ["--nonlinear"] * subject.nonlinear
    kept = f" --output {quote(subject.document)}" if subject.document else ""
    return " ".join(words) + f" --format {subject.form}{kept}"


def _opening(subject: Subject, made: str) -> list[Block]:
    model = subject.model
    bogies = len(model.vehicle.bogies)
    source = f" Source of the values: {model.vehicle.source}" if model.vehicle.source else ""
    on = "alone and free" if subject.alone else f"on {bogies} bogie{'s' * (bogies != 1)}"
    remarks = model.remarks if subject.alone else [*model.vehicle.remarks, *model.remarks]
    return [
        Heading(f"{model.vehicle.name}: {model.body.phrase}{',' * subject.alone} {on}", 1),
        Paragraph(f"{made}{source}"),
        *(Paragraph(f"Remark: {remark}.") for remark in remarks),
    ]
