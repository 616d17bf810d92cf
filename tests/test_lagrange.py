"""The engine against textbook equations of motion and sympy's own LagrangesMethod."""

from __future__ import annotations

import copy
import pickle

import pytest
import sympy as sp
import sympy.physics.mechanics as me
from vehicles import identical

from railride.errors import InputError
from railride.lagrange import Coordinate, Force, Input, Lagrangian, Signal, rate, signals

m, k, c, g, R, Omega, M_0, ell = sp.symbols("m k c g R Omega M_0 ell", positive=True)
x, z, theta, phi = (Coordinate(name) for name in ("x", "z", "theta", "phi"))
w, v = Input("w"), Input("v")
f = Force("f")


def test_signals_carry_their_rates():
    assert z.dot == Coordinate("z_dot")
    assert z.ddot == z.dot.dot
    assert (z.order, z.dot.order, z.ddot.order) == (0, 1, 2)
    assert z.ddot.base == z
    assert isinstance(w.dot, Input)
    assert sp.latex(theta.dot) == r"\dot{\theta}"


def test_signals_of_different_kinds_are_different():
    assert Coordinate("a") != Input("a") != sp.Symbol("a", real=True)


@pytest.mark.parametrize("again", [copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s))])  # noqa: S301
def test_signals_survive_being_copied(again):
    u = sp.sin(z) * w.dot
    assert again(u) == u
    assert [type(s) for s in signals(again(u))] == [type(s) for s in signals(u)]


def test_rate_is_the_chain_rule():
    u = sp.Function("u")(z, w)
    assert identical(rate(u), u.diff(z) * z.dot + u.diff(w) * w.dot)
    assert identical(rate(rate(x * z)), x.ddot * z + 2 * x.dot * z.dot + x * z.ddot)
    assert rate(sp.Matrix([z, k])) == sp.Matrix([z.dot, 0])
    assert rate(k) == 0


def test_oscillator_on_a_moving_base():
    system = Lagrangian([z], m * z.dot**2 / 2, k * (z - w) ** 2 / 2, c * (z.dot - w.dot) ** 2 / 2,
                        inputs=[w])  # fmt: skip
    assert identical(system.equations()[0], m * z.ddot + c * (z.dot - w.dot) + k * (z - w))


def test_pendulum_on_a_cart():
    """Two coupled equations found in any mechanics text, with a force on the cart."""
    bob = sp.Matrix([x + ell * sp.sin(theta), -ell * sp.cos(theta)])
    T = M_0 * x.dot**2 / 2 + m * rate(bob).dot(rate(bob)) / 2
    system = Lagrangian([x, theta], T, m * g * bob[1], forces=[f], virtual_work=[(f, x)])
    cart = (M_0 + m) * x.ddot + m * ell * (sp.cos(theta) * theta.ddot
                                           - sp.sin(theta) * theta.dot**2) - f  # fmt: skip
    pendulum = m * ell**2 * theta.ddot + m * ell * sp.cos(theta) * x.ddot
    pendulum += m * g * ell * sp.sin(theta)
    assert identical(system.equations(), sp.Matrix([cart, pendulum]))


def test_bead_on_a_turning_hoop_feels_the_centrifugal_force():
    T = m * R**2 * (theta.dot**2 + Omega**2 * sp.sin(theta) ** 2) / 2
    system = Lagrangian([theta], T, -m * g * R * sp.cos(theta))
    expected = theta.ddot - Omega**2 * sp.sin(theta) * sp.cos(theta) + g / R * sp.sin(theta)
    assert identical(system.equations()[0], m * R**2 * expected)


def test_vector_force_by_virtual_work_is_its_components():
    place = sp.Matrix([ell * sp.cos(theta), ell * sp.sin(theta)])
    drag = -c * rate(place)
    system = Lagrangian([theta], m * ell**2 * theta.dot**2 / 2, virtual_work=[(drag, place)])
    assert identical(system.equations()[0], m * ell**2 * theta.ddot + c * ell**2 * theta.dot)


def test_follower_force_does_no_potential_work():
    """A thrust along a rod: Q_θ = F × lever, whatever the angle."""
    place = sp.Matrix([ell * sp.cos(theta), ell * sp.sin(theta)])
    thrust = f * sp.Matrix([-sp.sin(theta), sp.cos(theta)])
    system = Lagrangian([theta], m * theta.dot**2 / 2, forces=[f], virtual_work=[(thrust, place)])
    assert identical(system.equations()[0], m * theta.ddot - f * ell)


def test_kinematics_are_names_for_functions():
    p = Coordinate("p")
    direct = Lagrangian([theta], m * theta.dot**2 / 2, k * (ell * sp.sin(theta) - w) ** 2 / 2,
                        c * rate(ell * sp.sin(theta) - w) ** 2 / 2, inputs=[w])  # fmt: skip
    named = Lagrangian([theta], m * theta.dot**2 / 2, k * p**2 / 2, c * p.dot**2 / 2, inputs=[w],
                       kinematics={p: ell * sp.sin(theta) - w})  # fmt: skip
    assert identical(named.equations(), direct.equations())


def test_kinematics_may_use_those_before_them():
    a, b = Coordinate("a"), Coordinate("b")
    system = Lagrangian([z], m * b.dot**2 / 2, kinematics={a: z**2, b: a + z})
    assert identical(system.equations()[0], m * (2 * z + 1) * ((2 * z + 1) * z.ddot
                                                               + 2 * z.dot**2))  # fmt: skip


def spatial_pendulum():
    """Three dimensions: a mass on a spring in spherical coordinates."""
    r = Coordinate("r")
    place = r * sp.Matrix([sp.sin(theta) * sp.cos(phi), sp.sin(theta) * sp.sin(phi),
                           -sp.cos(theta)])  # fmt: skip
    T = sp.simplify(m * rate(place).dot(rate(place)) / 2)
    return [r, theta, phi], T, m * g * place[2] + k * (r - ell) ** 2 / 2


def test_nonlinear_equations_equal_those_of_sympy():
    q, T, V = spatial_pendulum()
    functions = [me.dynamicsymbols(s.name) for s in q]
    to_peer = {s.dot: u.diff() for s, u in zip(q, functions, strict=True)}
    to_peer |= dict(zip(q, functions, strict=True))
    method = me.LagrangesMethod((T - V).xreplace(to_peer), functions)
    method.form_lagranges_equations()
    back = {u.diff().diff(): s.ddot for s, u in zip(q, functions, strict=True)}
    back |= {u.diff(): s.dot for s, u in zip(q, functions, strict=True)}
    ours = Lagrangian(q, T, V).equations()
    peers = method.eom.subs(back).subs(dict(zip(functions, q, strict=True)))
    assert identical(ours, peers)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"coordinates": [z, z]}, ["z", "listed twice"]),
        ({"inputs": [w, w]}, ["w", "listed twice"]),
        ({"potential": k * (z - w) ** 2}, ["potential", "undeclared", "w", "inputs"]),
        ({"dissipation": c * (z.dot - w.dot) ** 2}, ["dissipation", "undeclared", "w"]),
        ({"virtual_work": [(f, z)]}, ["force 1", "signal f", "forces"]),
        ({"potential": k * z * sp.Symbol("t")}, ["potential", "time t", "Input"]),
        ({"kinematics": {x: z.dot}}, ["kinematics of x", "rate"]),
        ({"kinematics": {z: k * z}}, ["z", "listed twice"]),
    ],
)
def test_what_is_not_a_system_is_refused(given, words):
    arguments = {"coordinates": [z], "kinetic": m * z.dot**2 / 2} | given
    with pytest.raises(InputError) as raised:
        Lagrangian(**arguments)
    assert all(word in str(raised.value) for word in words), raised.value


def test_all_faults_are_told_at_once():
    with pytest.raises(InputError) as raised:
        Lagrangian([z, z], m * z.dot**2 / 2, k * (z - w) ** 2, c * x.dot**2)
    for word in ("listed twice", "signal w", "signal x"):
        assert word in str(raised.value)


def test_one_name_for_two_kinds_of_signal_is_refused():
    """Matrices and states go by name: the input z would be taken for the coordinate z."""
    with pytest.raises(InputError, match="z"):
        Lagrangian([z], m * z.dot**2 / 2, k * (z - Input("z")) ** 2, inputs=[Input("z")])


@pytest.mark.parametrize(
    "given",
    [
        {"kinetic": m * z.dot**2 / 2 + m * z * z.ddot},
        {"virtual_work": [(-M_0 * w.ddot, z)], "inputs": [w]},
        {"dissipation": c * z.dot * w.ddot, "inputs": [w]},
    ],
    ids=["coordinate in T", "input in a force", "input in D"],
)
def test_second_rates_in_energies_and_forces_are_refused(given):
    """Dropped without a word they would leave a wrong model."""
    with pytest.raises(InputError):
        Lagrangian(**{"coordinates": [z], "kinetic": m * z.dot**2 / 2} | given)


def test_an_equilibrium_of_what_is_no_coordinate_is_refused():
    with pytest.raises(InputError, match="x"):
        Lagrangian([z], m * z.dot**2 / 2, equilibrium={x: 1})


def test_signals_are_listed_by_name():
    assert signals(z * w + x.dot) == sorted([z, w, x.dot], key=lambda s: s.name)
    assert signals(k * sp.Symbol("z")) == []
    assert issubclass(Coordinate, Signal)


def test_a_system_displays_as_its_energies():
    shown = Lagrangian([z], m * z.dot**2 / 2, k * (z - w) ** 2 / 2, inputs=[w])._repr_latex_()
    assert r"T &= \frac{\dot{z}^{2} m}{2}" in shown or r"T &= \frac{m \dot{z}^{2}}{2}" in shown
    assert "V &=" in shown
    assert "D &=" not in shown
