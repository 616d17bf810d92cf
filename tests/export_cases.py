"""Vehicles of every kind of body to export, and the same with every parameter changed."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from vehicles import random_vehicle

from railride.exports.content import content_of
from railride.parameters import Equipment, Load, load_vehicle
from railride.running_gear import actuator, primary_deflection, secondary_deflection
from railride.vehicle import Output, derive_vehicle

COACH = load_vehicle("cati2024")
MOUNTED = replace(COACH, bogies=tuple(
    replace(b, primary_damper_stiffness=2e6, secondary_damper_stiffness=12e6)
    for b in COACH.bogies
))  # fmt: skip
HUNG = Equipment(1500.0, 1.7, frequency=8.8, damping_ratio=0.12)
CARRIED = replace(COACH, payload=(Load(3000.0), Load(1000.0, 5.0, 2.0)), equipment=(HUNG,))
BODIES = {
    "rigid": (COACH, {"segments": 1}),
    "segments": (random_vehicle(3), {"segments": 3}),
    "mounts": (MOUNTED, {"segments": 2}),
    "beam": (CARRIED, {"body": "beam", "modes": 2, "bending_damping": 0.01}),
    "fe": (COACH, {"body": "fe", "modes": 2}),
}
every_body = pytest.mark.parametrize("kind", BODIES)


@cache
def content(kind):
    """The content of an export, with outputs that feel rates and forces too."""
    vehicle, body = BODIES[kind]
    found = content_of(derive_vehicle(vehicle, **body), at=[0.0, 2.5])
    model = found.model
    more = [Output(f"{d.name}_rate", d.dot, "m/s", "") for d in model.running_gear.strokes]
    more += [Output("primary_1_rate", primary_deflection(1).dot, "m/s", "")]
    more += [Output("pushed_deflection", secondary_deflection(1) + 1e-6 * actuator(1), "m", "")]
    return replace(found, outputs=(*found.outputs, model.floor(1.0, derivative=1), *more))


@cache
def changed(kind):
    """The same with every parameter changed that may change, by up to a per cent each."""
    own = {p.symbol.name: p.value for p in content(kind).model.parameters}
    fixed = "L", "e_c", "I_c", "r_c"  # with them the mass may find no distribution
    changes = {name: value * (1 + 0.01 * np.sin(k + 1)) for k, (name, value)
               in enumerate(own.items()) if name not in fixed}  # fmt: skip
    return replace(content(kind), model=content(kind).model.changed(**changes))


def independent(own):
    """The values of all parameters but those that others define."""
    return {p.name: p.value for p in own.parameters if p.definition is None}


def close(found, expected):
    """Within 1e-12 of the largest entry."""
    scale = np.abs(expected).max(initial=0.0)
    return (
        found.shape == expected.shape and np.abs(found - expected).max(initial=0) <= 1e-12 * scale
    )
