"""The equations of motion in parts are Lagrange's, whatever the system."""

import numpy as np
import pytest
import sympy as sp
from vehicles import paper_coach, random_vehicle

from railride import derive_vehicle
from railride.lagrange import Coordinate, Force, Input, Lagrangian, rate
from railride.resultants import resultants

MODELS = {
    "rigid": lambda: paper_coach(1),
    "two halves": lambda: paper_coach(2),
    "odd": lambda: paper_coach(3),
    "graded": lambda: derive_vehicle(random_vehicle(1), 3),
    "beam": lambda: derive_vehicle("cati2024", body="beam", modes=2),
}


def at_random(system, seed=0):
    """A state at random, small so that every angle is one, and the names that follow from it."""
    rng = np.random.default_rng(seed)
    values = {}
    for s in (*system.coordinates, *system.inputs, *system.forces):
        for k, signal in enumerate((s, s.dot, s.ddot)):
            values[signal] = sp.Float(rng.uniform(-0.1, 0.1) * 3**k)
    for u, definition in system.kinematics.items():
        for name, e in ((u, definition), (u.dot, rate(definition)),
                        (u.ddot, rate(rate(definition)))):  # fmt: skip
            values[name] = e.xreplace(values)
    return values


@pytest.mark.parametrize("kind", MODELS)
def test_parts_add_up_to_lagranges_equations(kind):
    """The sums of resultants, against the equations with every name put in beforehand."""
    system = MODELS[kind]().lagrangian
    symbols = set().union(*(u.free_symbols for u in system.equations()))
    rng = np.random.default_rng(7)
    parameters = {s: sp.Float(rng.uniform(2, 3)) for s in sorted(symbols, key=str)
                  if not hasattr(s, "order")}  # fmt: skip
    parameters |= {s: sp.Float(20.0) for s in parameters if s.name == "L"}
    whole = system.equations().xreplace(parameters)
    parts = resultants(system)
    values = {s: e.xreplace(parameters) for s, e in at_random(system).items()}
    plain = {s: v for s, v in values.items() if s.base not in system.kinematics}
    values = {s: v.xreplace(plain) for s, v in values.items()}
    for q, equation in zip(system.coordinates, whole, strict=True):
        expected = float(equation.xreplace(plain))
        found = float(parts.equation(q).xreplace(parameters).xreplace(values))
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-9), q


def test_a_lever_by_hand():
    """m L² θ̈ cos²θ - m L² θ̇² sin θ cos θ + k L² sin θ cos θ of a mass at height L sin θ."""
    m, k, L = sp.symbols("m k L", positive=True)
    theta, z = Coordinate("theta"), Coordinate("z")
    lever = Lagrangian([theta], m * z.dot**2 / 2, k * z**2 / 2, kinematics={z: L * sp.sin(theta)})
    parts = resultants(lever)
    assert parts.terms(theta) == [(z, L * sp.cos(theta))]
    z_ddot = L * theta.ddot * sp.cos(theta) - L * theta.dot**2 * sp.sin(theta)
    by_hand = L * sp.cos(theta) * (m * z_ddot + k * L * sp.sin(theta))
    put_in = parts.equation(theta).xreplace({z.ddot: z_ddot, z: L * sp.sin(theta)})
    assert sp.simplify(put_in - by_hand) == 0
    assert sp.simplify(lever.equations()[0] - by_hand) == 0


def test_what_moves_a_segment_has_no_arcsine_left():
    parts = resultants(paper_coach(4).lagrangian)
    for factor in parts.moved.values():
        assert not factor.has(sp.asin)
        assert all(not e.is_Pow or e.exp.is_integer for e in sp.preorder_traversal(factor))


def test_forces_and_inputs_are_in_the_resultants():
    k = sp.Symbol("k", positive=True)
    z, s, w, f = Coordinate("z"), Coordinate("s"), Input("w"), Force("f")
    held = Lagrangian([z], z.dot**2 / 2, k * s**2 / 2, inputs=[w], forces=[f],
                      virtual_work=[(f, s)], kinematics={s: z - w})  # fmt: skip
    parts = resultants(held)
    assert parts.of[s] == k * s - f
    assert parts.equation(z) == z.ddot + k * s - f
