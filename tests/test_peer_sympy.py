"""sympy's LagrangesMethod on the vehicle's energies: the same equations, the same matrices."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols
from vehicles import paper_coach, random_model

MODELS = {
    "1": lambda: paper_coach(1),
    "2": lambda: paper_coach(2),
    "unlike, 2": lambda: random_model(3, 2),
}


class Peer:
    """The same energies, written for LagrangesMethod: functions of time and their derivatives.

    Dampers are forces, -∂D/∂q̇, on points that move as the coordinates do. Its ``linearize``
    refuses rates of inputs, for which the track is at rest.
    """

    def __init__(self, model, *, moving):
        system = model.lagrangian.written_out
        signals = (*system.coordinates, *system.inputs)
        of_time = {s: dynamicsymbols(s.name) for s in signals}
        self.table = dict(of_time)
        for s, u in of_time.items():
            self.table[s.dot] = u.diff() if moving or s in system.coordinates else sp.S.Zero
        self.q = [of_time[s] for s in system.coordinates]
        self.back = {u: s for s, u in of_time.items()}
        self.back |= {u.diff(): s.dot for s, u in of_time.items()}
        self.back |= {of_time[s].diff().diff(): s.ddot for s in system.coordinates}
        frame = ReferenceFrame("N")
        forces = []
        for s in system.coordinates:
            point = Point(f"P_{s.name}")
            point.set_vel(frame, self.table[s.dot] * frame.x)
            forces.append((point, -system.dissipation.diff(s.dot).xreplace(self.table) * frame.x))
        lagrangian = (system.kinetic - system.potential).xreplace(self.table)
        self.method = LagrangesMethod(lagrangian, self.q, forcelist=forces, frame=frame)

    def equations(self):
        """Its equations of motion in the signals of railride."""
        found = self.method.form_lagranges_equations()
        derivatives_first = sorted(self.back, key=lambda u: -u.count(sp.Derivative))
        for u in derivatives_first:
            found = found.xreplace({u: self.back[u]})
        return found


@pytest.mark.parametrize("kind", ["1", "unlike, 2"])
def test_nonlinear_equations_are_the_same(kind):
    """At random motions of any size, track and actuators, to 25 digits."""
    model = MODELS[kind]()
    rest = dict.fromkeys(model.lagrangian.forces, 0)
    own = model.lagrangian.equations().xreplace(rest)
    other = Peer(model, moving=True).equations()
    rng = np.random.default_rng(5)
    symbols = sorted(own.free_symbols | other.free_symbols, key=lambda s: s.name)
    at = {s: sp.Rational(int(rng.integers(1, 999)), 1000) for s in symbols}
    for a, b in zip(own, other, strict=True):
        here, there = (sp.N(e.xreplace(at), 40) for e in (a, b))
        assert abs(here - there) <= sp.Float("1e-25") * (1 + abs(here))


@pytest.mark.parametrize("kind", ["1", "2"])
def test_linear_matrices_are_the_same(kind):
    """Its ``linearize`` at rest: M, C, K and K_w as numbers."""
    model = MODELS[kind]()
    peer = Peer(model, moving=False)
    peer.method.form_lagranges_equations()
    at_rest = {x: 0 for u in peer.q for x in (u, u.diff(), u.diff().diff())}
    found = peer.method.linearize(q_ind=peer.q, qd_ind=[u.diff() for u in peer.q],
                                  op_point=at_rest)  # fmt: skip
    mass, state, inputs, order = found
    values = {name: float(value) for name, value in model.values().items()}

    def numbers(matrix):
        by_name = {s: values[s.name] for s in matrix.free_symbols if s.name in values}
        still = dict.fromkeys(matrix.atoms(sp.core.function.AppliedUndef), 0)
        return np.array(matrix.xreplace(by_name).xreplace(still).tolist(), dtype=float)

    own, n = model.matrices(), len(peer.q)
    A = numbers(state)[n:]
    columns = [[u.func.__name__ for u in order].index(s.name) for s in model.lagrangian.inputs]
    for a, b in ((numbers(mass)[n:, n:], own.M), (-A[:, :n], own.K), (-A[:, n:], own.C),
                 (numbers(inputs)[n:][:, columns], own.K_w)):  # fmt: skip
        assert np.abs(a - b).max() < 1e-12 * np.abs(b).max()
