"""Which model a car body gets: its kind, and of how many segments or modes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from railride.bodies.base import BodyModel
from railride.bodies.beam import MODES, BeamBody
from railride.bodies.rigid import RigidBody
from railride.bodies.segments import SegmentedBody
from railride.errors import Faults
from railride.parameters import CarBody

KINDS = ("rigid", "segments", "beam", "fe")
MODAL = ("beam", "fe")  # those that are made of modes
SEGMENTS = 4  # unless the user says otherwise
MOST_MODES = 100  # of a car body: the highest is then at some 40 kHz


def body_model(
    body: CarBody,
    kind: str | None = None,
    segments: int | None = None,
    modes: int | None = None,
    attachments: Sequence[float] = (),
) -> BodyModel:
    """The model of a car body.

    Parameters
    ----------
    kind : one of :data:`KINDS`; default: fe for modes from outside, else segments, or rigid where
        no bending is known.
    segments : N ≥ 1 rigid segments; 1 is the rigid body. Default 4.
    modes : how many bending modes a beam or finite elements have. Default 10, or all that a table
        from outside holds.
    attachments : places (m) at which modes from outside must be known.

    Raises
    ------
    InputError : another kind; numbers that are none or do not belong to the kind; a body of which
        it cannot be made.
    """
    faults = Faults("body")
    if kind is not None and kind not in KINDS:
        faults.add("kind", repr(kind), f"one of {', '.join(KINDS)}")
    _check_number("segments", segments, None, faults)
    _check_number("modes", modes, MOST_MODES, faults)
    faults.raise_if_any()
    if kind is None and segments is None and body.mode_files is not None:
        kind = "fe"
    if modes is not None and kind not in MODAL:
        faults.add("modes", f"{modes} of a body that is not made of them",
                   f"body {' or '.join(MODAL)} with it")  # fmt: skip
    if segments is not None and kind in MODAL:
        faults.add("segments", f"{segments} with body {kind}", "modes, of which it is made")
    if kind == "rigid" and segments not in (None, 1):
        faults.add("segments", f"{segments} with body rigid", "1")
    faults.raise_if_any()
    if kind == "beam":
        return BeamBody.of(body, MODES if modes is None else int(modes))
    if kind == "fe":  # what few need is loaded when it is
        from railride.bodies.fe import fe_body

        return fe_body(body, None if modes is None else int(modes), attachments)
    count = segments
    if count is None:
        own = SEGMENTS if body.joints is None else body.joints + 1
        count = own if kind == "segments" or (kind is None and body.bends) else 1
    return RigidBody(body) if count == 1 else SegmentedBody(body, int(count))


def _check_number(name: str, value: Any, most: int | None, faults: Faults) -> None:
    if value is None:
        return
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < 1 or (most is not None and value > most):
        limit = f"from 1 to {most}" if most else "of at least 1"
        faults.add(name, repr(value), f"a whole number {limit}")
