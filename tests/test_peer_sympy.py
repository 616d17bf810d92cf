"""sympy's LagrangesMethod on the vehicle's energies: the same equations, the same matrices."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols
from vehicles import paper_coach, random_model

MODELS = {
    "rigid": lambda: paper_coach(1),
    "segments": lambda: paper_coach(2),
    "unlike": lambda: random_model(1, 2),
}


class Peer:
    """The same energies, parameters put in, as functions of time and their derivatives.

    ``LagrangesMethod`` knows no dissipation: dampers, like actuators, are forces on points that
    move as the coordinates do. Its ``linearize`` refuses derivatives of inputs: ẇ is an input of
    its own, which nothing differentiates in time.
    """

    def __init__(self, model):
        system = model.lagrangian.written_out
        self.values = {name: sp.Rational(float(u)) for name, u in model.values().items()}
        inputs = (*system.inputs, *(w.dot for w in system.inputs), *system.forces)
        self.of_time = {s: dynamicsymbols(s.name) for s in (*system.coordinates, *inputs)}
        self.of_time |= {s.dot: self.of_time[s].diff() for s in system.coordinates}
        self.of_time |= {s.ddot: self.of_time[s.dot].diff() for s in system.coordinates}
        self.q = [self.of_time[s] for s in system.coordinates]
        frame = ReferenceFrame("N")
        forces = []
        for s in system.coordinates:
            point = Point(f"P_{s.name}")
            point.set_vel(frame, self.of_time[s.dot] * frame.x)
            work = sp.Add(*(F * r.diff(s) for F, r in system.virtual_work))
            forces.append((point, self._put_in(work - system.dissipation.diff(s.dot)) * frame.x))
        lagrangian = self._put_in(system.kinetic - system.potential)
        self.method = LagrangesMethod(lagrangian, self.q, forcelist=forces, frame=frame)
        self.found = self.method.form_lagranges_equations()

    def in_numbers(self, expression):
        """The same with every parameter's value, exactly."""
        known = {s: self.values[s.name] for s in expression.free_symbols if s.name in self.values}
        return expression.xreplace(known)

    def _put_in(self, expression):
        return self.in_numbers(expression).xreplace(self.of_time)

    def equations(self):
        """Its equations of motion in the signals of railride."""
        return self.found.xreplace({u: s for s, u in self.of_time.items()})

    def linear(self):
        """M, [K, C] and the inputs' columns at rest, by the names of the inputs."""
        rates = [u.diff() for u in self.q]
        at_rest = dict.fromkeys([*self.q, *rates, *(u.diff() for u in rates)], 0)
        mass, state, inputs, order = self.method.linearize(
            q_ind=self.q, qd_ind=rates, op_point=at_rest
        )
        n = len(self.q)
        M, S, B = (
            np.array(m[n:, :].subs(dict.fromkeys(order, 0)).tolist(), dtype=float)
            for m in (mass, state, inputs)
        )
        return M[:, n:], -S, dict(zip((u.func.__name__ for u in order), B.T, strict=True))


@cache
def peer(kind):
    return Peer(MODELS[kind]())


@pytest.mark.parametrize("kind", MODELS)
def test_nonlinear_equations_are_the_same(kind):
    """At random motions of any size, track and actuators, to 25 digits."""
    own = peer(kind).in_numbers(MODELS[kind]().lagrangian.equations())
    other = peer(kind).equations()
    rng = np.random.default_rng(5)
    symbols = sorted(own.free_symbols | other.free_symbols, key=lambda s: s.name)
    at = {s: sp.Rational(int(rng.integers(1, 999)), 1000) for s in symbols}
    for a, b in zip(own, other, strict=True):
        here, there = (sp.N(e.xreplace(at), 40) for e in (a, b))
        assert abs(here - there) <= sp.Float("1e-25") * (1 + abs(here))


@pytest.mark.parametrize("kind", ["rigid", "segments"])
def test_linear_matrices_are_the_same(kind):
    """Its ``linearize`` at rest: M, C, K and the columns of track, its rates and actuators."""
    model, n = MODELS[kind](), len(peer(kind).q)
    M, S, inputs = peer(kind).linear()
    own, system = model.matrices(), model.lagrangian
    pairs = [(M, own.M), (S[:, :n], own.K), (S[:, n:], own.C)]
    for signals, columns in ((system.inputs, own.K_w), ([w.dot for w in system.inputs], own.C_w),
                             (system.forces, own.B_f)):  # fmt: skip
        pairs.append((np.transpose([inputs[s.name] for s in signals]), columns))
    for found, expected in pairs:
        assert np.abs(found - expected).max() < 1e-14 * np.abs(expected).max()
