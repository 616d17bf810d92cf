"""Static forces against statics by hand: weights, levers and the bending moment of a beam."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from vehicles import paper_coach, random_vehicle

from railride import derive_vehicle, load_vehicle
from railride.lagrange import Coordinate, Lagrangian
from railride.parameters import Equipment
from railride.preloads import Preloads, g
from railride.units import STANDARD_GRAVITY


def static(model):
    pairs = zip(model.lagrangian.coordinates, model.lift.tolist(), strict=True)
    return Preloads(model.lagrangian, {q: u for q, u in pairs if u})


def weights(model):
    """Weight of the body, and of each bogie, N."""
    vehicle = model.vehicle
    return (STANDARD_GRAVITY * vehicle.body.mass,
            [STANDARD_GRAVITY * b.mass for b in vehicle.bogies])  # fmt: skip


@pytest.mark.parametrize("segments", [1, 2, 4, 5])
def test_a_symmetric_coach(segments):
    model = paper_coach(segments)
    found = static(model).values(model.values())
    body, bogies = weights(model)
    for b in (1, 2):
        assert found[f"N_s{b}"] == pytest.approx(body / 2, rel=1e-9)
    for j in (1, 2, 3, 4):
        assert found[f"N_p{j}"] == pytest.approx((body / 2 + bogies[0]) / 2, rel=1e-9)
    # V_0 = -N (θ_j - θ_{j+1}) is the work of the bending moment of what hangs ahead of the joint.
    L, l_b, N = 24.0, 8.75, segments
    for j in range(1, segments):
        ahead = j * L / N
        lever = ahead - (L / 2 - l_b)
        moment = body * j / N * ahead / 2 - body / 2 * max(lever, 0.0)
        assert found[f"N_theta_{j}"] == pytest.approx(moment, rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_any_coach_stands_on_its_springs(seed):
    """All its weight on the rails, and its moment about the middle carried."""
    model = derive_vehicle(random_vehicle(seed), 3)
    found = static(model).values(model.values())
    body, bogies = weights(model)
    vehicle = model.vehicle
    primary = [found[f"N_p{j}"] for j in range(1, len(vehicle.wheelset_positions) + 1)]
    assert sum(primary) == pytest.approx(body + sum(bogies), rel=1e-9)
    moment = np.dot(primary, vehicle.wheelset_positions)
    carried = sum(w * b.position for w, b in zip(bogies, vehicle.bogies, strict=True))
    assert moment == pytest.approx(body * vehicle.body.mass_centre + carried, rel=1e-7, abs=1.0)


def test_formulas_give_the_numbers():
    for segments in (1, 2, 4):
        model = paper_coach(segments)
        found, values = static(model), model.values()
        numbers = {s: float(values[s.name]) for e in found.solution.values()
                   for s in e.free_symbols - {g}} | {g: STANDARD_GRAVITY}  # fmt: skip
        for N, formula in found.solution.items():
            assert float(formula.subs(numbers)) == pytest.approx(found.values(values)[N.name])


def test_gravity_and_preloads_add_no_stiffness():
    hung = (Equipment(2000.0, 2.0, frequency=8.0, damping_ratio=0.1),)
    models = [paper_coach(4), derive_vehicle(random_vehicle(2), 3),
              derive_vehicle(replace(load_vehicle("cati2024"), equipment=hung), 2)]  # fmt: skip
    for model in models:
        assert static(model).curvature == {}


def test_a_preload_that_stiffens_is_seen():
    """A spring whose deflection is curved: its preload does change the stiffness."""
    m, k, L = sp.symbols("m k L", positive=True)
    theta, s = Coordinate("theta"), Coordinate("s")
    pendulum = Lagrangian([theta], m * L**2 * theta.dot**2 / 2, k * s**2 / 2,
                          kinematics={s: L * theta + L * theta**2 / 2})  # fmt: skip
    found = Preloads(pendulum, {theta: 1})
    assert list(found.curvature) == [(theta, theta)]


def test_equipment_hangs_on_its_mounts():
    hung = (Equipment(2000.0, 2.0, frequency=8.0, damping_ratio=0.1),)
    model = derive_vehicle(replace(load_vehicle("cati2024"), equipment=hung), 1)
    found = static(model).values(model.values())
    assert found["N_se1"] == pytest.approx(-2000.0 * STANDARD_GRAVITY)  # stretched
    assert found["N_s1"] + found["N_s2"] == pytest.approx(36_000.0 * STANDARD_GRAVITY)
    assert found["N_s1"] > found["N_s2"]
