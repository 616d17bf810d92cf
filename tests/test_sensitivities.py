"""Exact derivatives, against Richardson's differences of values found in another way."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from vehicles import paper_coach, random_model

from railride.parameters import Equipment, Load, load_vehicle
from railride.sensitivities import Derivatives, mean_squares_with_gradient
from railride.spectra import spectrum
from railride.stochastic.gains import weighted
from railride.stochastic.ride import floor_in_hand
from railride.stochastic.squares import mean_squares
from railride.vehicle import derive_vehicle
from railride.weightings import weighting

KMH = 1 / 3.6
LOW = spectrum("erri_low")
W_K = weighted(weighting("Wk"))


def richardson(f, x, step):
    """df/dx, of sixth order, from central differences with steps h, h/2 and h/4 (Richardson)."""
    table = [(f(x + h) - f(x - h)) / (2 * h) for h in (step, step / 2, step / 4)]
    for order in (4, 16):
        table = [(order * b - a) / (order - 1) for a, b in itertools.pairwise(table)]
    return table[0]


def along(f, derivatives, name, **changes):
    """df/dp of a function of the changed values, by differences of relative step 2e-3."""
    here = float(derivatives.model.values(**changes)[name])
    return richardson(lambda x: f(**{**changes, name: x}), here, 2e-3 * abs(here) or 1e-3)


def closed_form(model, speed, gain, in_hand_at, **changes):
    """Mean squares of outputs by residues: no quadrature over the band, and no adjoint."""
    m, rows = in_hand_at(changes)
    places = wheelset_places(model, model.values(**changes))
    squares, errors = mean_squares(m, rows, places, [speed], LOW, (gain,))
    assert errors.max() < 1e-9
    return squares[0, 0, 0]


def wheelset_places(model, values):
    """Bogies' positions and wheelsets' on them, put together by hand."""
    found = []
    for b, bogie in enumerate(model.vehicle.bogies, start=1):
        for j, place in enumerate(bogie.wheelsets, start=1):
            at = _place(values, bogie.position, "l_b", f"x_b{b}")
            own = f"_b{b}" if f"l_w_b{b}" in values or f"x_w{j}_b{b}" in values else ""
            mirrored = next((k for k in (f"l_w{own}", f"l_w1{own}") if k in values), "")
            found.append(at + _place(values, place, mirrored, f"x_w{j}{own}"))
    return found


def _place(values, here, mirrored, single):
    if here == 0:
        return 0.0
    if single in values:
        return float(values[single])
    return np.copysign(float(values[mirrored]), here)


def heavy_coach():
    """Payload all along and in a point, equipment on mounts, dampers on elastic mounts, damped."""
    coach = load_vehicle("cati2024")
    bogies = tuple(replace(b, secondary_damper_stiffness=5e6, primary_damper_stiffness=8e6)
                   for b in coach.bogies)  # fmt: skip
    return replace(
        coach,
        body=replace(coach.body, bending_damping=0.012),
        bogies=bogies,
        payload=(Load(6e3), Load(800.0, front=3.0, rear=3.0)),
        equipment=(Equipment(mass=2500.0, position=1.5, frequency=7.0, damping_ratio=0.08),),
    )


@cache
def model_of(kind):
    heavy = heavy_coach()
    plain = replace(heavy, bogies=load_vehicle("cati2024").bogies)
    return {
        "rigid": lambda: paper_coach(1),
        "N = 2": lambda: paper_coach(2, bending_damping=0.01),
        "N = 4": lambda: paper_coach(4, bending_damping=0.01),
        "joint stiffness": lambda: derive_vehicle("cati2024", 3, joint_stiffness=4e8,
                                                  bending_damping=0.01),
        "beam": lambda: derive_vehicle("cati2024", body="beam", modes=3, bending_damping=0.01),
        "unsymmetrical": lambda: random_model(0, 4),
        "Maxwell": lambda: derive_vehicle(heavy, 2),
        "loaded": lambda: derive_vehicle(plain, 4),
        "loaded beam": lambda: derive_vehicle(plain, body="beam", modes=2),
    }[kind]()  # fmt: skip


@pytest.mark.parametrize(
    "kind",
    [
        "rigid",
        "N = 2",
        "N = 4",
        "joint stiffness",
        "beam",
        "unsymmetrical",
        "Maxwell",
        "loaded",
        "loaded beam",
    ],
)
@pytest.mark.parametrize("kmh", [145, 200])
def test_gradient_of_the_weighted_mean_square(kind, kmh):
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    at = [0.0, 5.0]
    J, dJ = mean_squares_with_gradient(here, here.floor(at), kmh * KMH, LOW, (W_K,))

    def value(**changes):
        return closed_form(model, kmh * KMH, W_K, lambda c: floor_in_hand(model, at, "smooth", c),
                           **changes)  # fmt: skip

    np.testing.assert_allclose(J[0, 0], value(), rtol=1e-9)
    for k, name in enumerate(derivatives.parameters):
        scale = J[0, 0] / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(dJ[0, 0, :, k] / scale, along(value, derivatives, name) / scale,
                                   rtol=1e-7, atol=2e-8, err_msg=name)  # fmt: skip
