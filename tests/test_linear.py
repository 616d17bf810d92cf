"""The linear matrices: from the energies, from the nonlinear equations, from sympy, by hand."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
import sympy as sp
import sympy.physics.mechanics as me
from vehicles import identical, paper_coach

from railride.errors import InputError
from railride.lagrange import Coordinate, Force, Input, Lagrangian, rate
from railride.linear import MATRICES, linearise, linearise_equations, output_rows
from railride.parameters import load_vehicle
from railride.vehicle import derive_vehicle

m, k, c, g, R, Omega = sp.symbols("m k c g R Omega", positive=True)
z, theta, x = Coordinate("z"), Coordinate("theta"), Coordinate("x")
w = Input("w")


def assert_same(one, other):
    for name in MATRICES:
        assert one.matrices[name].shape == other.matrices[name].shape
        assert identical(one.matrices[name], other.matrices[name]), name


@pytest.mark.parametrize("segments", [1, 2, 3])
def test_both_ways_agree_for_the_vehicle(segments):
    model = paper_coach(segments)
    assert_same(model.linear, linearise_equations(model.lagrangian))


@pytest.mark.parametrize(("segments", "inertia"), [(1, "auto"), (2, "graded"), (2, "segments")])
def test_both_ways_agree_for_a_body_that_is_no_rod(segments, inertia):
    vehicle = load_vehicle("cati2024")
    offset = 0.0 if inertia == "segments" else 0.3
    vehicle = replace(vehicle, body=replace(vehicle.body, inertia=inertia, mass_centre=offset))
    model = derive_vehicle(vehicle, segments)
    assert_same(model.linear, linearise_equations(model.lagrangian))


def random_system(seed):
    """Three coordinates and all that a Lagrangian may hold, resting where all forces balance."""
    rng = random.Random(seed)  # noqa: S311
    q = [Coordinate(f"q_{i}") for i in range(1, 4)]
    inputs, forces = [Input("w_1"), Input("w_2")], [Force("f_1"), Force("f_2")]
    u, s = Coordinate("u"), Coordinate("s")
    p = list(sp.symbols("p_1:9", positive=True))

    def smooth():
        """A smooth function of one of the coordinates."""
        r = rng.choice(q)
        return rng.choice([sp.sin(r), sp.cos(2 * r), 1 + r**2, sp.exp(r / 2), r * rng.choice(q)])

    kinematics = {u: sp.sin(q[0] - inputs[0]) + q[1] * smooth(), s: u**2 + q[2] - inputs[1] + u}
    v = [sum(rng.randint(-2, 2) * r.dot * smooth() for r in q) + q[i].dot for i in range(3)]
    T = sum(p[i] * v[i] ** 2 for i in range(3)) / 2  # quadratic in the rates
    T += p[3] * smooth() * rng.choice(q).dot + p[4] * smooth() * u.dot  # gyroscopic
    T += p[5] * smooth() * smooth()  # centrifugal
    T += p[6] * smooth() * inputs[0].dot + p[7] * smooth() * inputs[1] * rng.choice(q).dot
    V = p[0] * s**2 + p[1] * (q[0] - inputs[1]) ** 2 * smooth() + p[2] * smooth()
    D = p[3] * s.dot**2 + p[4] * (u.dot - inputs[1].dot) ** 2 * smooth()
    D += p[5] * q[1].dot * inputs[0] * smooth()
    F = sp.Matrix([forces[0] * smooth() - p[6] * q[0].dot * smooth() + inputs[0].dot * q[1],
                   p[7] * q[1] + forces[1] * inputs[1].dot + p[1]])  # fmt: skip
    r = sp.Matrix([s + q[2] * smooth(), q[0] * q[1] + smooth()])
    work = [(F, r), (p[2] * q[2].dot + inputs[1] * smooth() + forces[1], q[0] + u)]
    at = {r: sp.Rational(rng.randint(-2, 2), 3) for r in q}
    system = Lagrangian(q, T, V, D, inputs, forces, work, kinematics, at)
    point = system.operating_point
    rest = {r.dot: 0 for r in (*q, *inputs)} | {r.ddot: 0 for r in (*q, *inputs)}
    left = system.equations().subs({**rest, **point})
    preload = -sum(e * r for e, r in zip(left, q, strict=True))
    return replace(system, potential=V + preload)


@pytest.mark.parametrize("seed", range(5))
def test_both_ways_agree_for_a_random_system_with_everything(seed):
    system = random_system(seed)
    assert_same(linearise(system), linearise_equations(system))


def test_the_random_systems_fill_every_matrix_and_are_not_symmetric():
    """Otherwise the test above would not see a term that is missing."""
    linear = linearise(random_system(0))
    assert all(A.nnz() for A in linear.matrices.values())
    assert not identical(linear.C, linear.C.T)
    assert not identical(linear.K, linear.K.T)


def test_equal_to_sympys_own_linearised_equations():
    """A cart with a pendulum that a spring holds aslant; no input rates, which sympy refuses."""
    q, p = me.dynamicsymbols("theta x")
    rest = {q: sp.pi / 6, p: sp.Rational(1, 2)}  # x = sin θ strains no spring

    def energies(angle, place, d_angle, d_place):
        T = c * d_place**2 / 2 + m * (d_place**2 + 2 * sp.cos(angle) * d_angle * d_place) / 2
        T += m * d_angle**2 / 2 + R * d_angle * angle * place
        V = k * (place - sp.sin(angle)) ** 2 / 2 + g * (angle - sp.pi / 6) ** 2
        return T, V

    T, V = energies(q, p, q.diff(), p.diff())
    method = me.LagrangesMethod(T - V, [q, p])
    method.form_lagranges_equations()
    at = rest | {s.diff(): 0 for s in (q, p)} | {s.diff().diff(): 0 for s in (q, p)}
    A = method.linearize(q_ind=[q, p], qd_ind=[q.diff(), p.diff()], op_point=at, A_and_B=True)[0]
    T, V = energies(theta, x, theta.dot, x.dot)
    ours = linearise(Lagrangian([theta, x], T, V, equilibrium={theta: rest[q], x: rest[p]}))
    inverse = sp.Matrix(ours.M).inv()
    assert ours.C.nnz()
    assert identical(sp.Matrix(A)[2:, :2], -inverse * ours.K)
    assert identical(sp.Matrix(A)[2:, 2:], -inverse * ours.C)


def test_bead_on_a_turning_hoop_off_its_lowest_point():
    """Rest at cos θ₀ = g/(R Ω²), stiffness m R² Ω² sin² θ₀: T depends on q alone as well."""
    T = m * R**2 * (theta.dot**2 + Omega**2 * sp.sin(theta) ** 2) / 2
    rest = sp.acos(g / (R * Omega**2))
    V = -m * g * R * sp.cos(theta)
    linear = linearise(Lagrangian([theta], T, V, equilibrium={theta: rest}))
    assert identical(linear.K[0], m * R**2 * Omega**2 * (1 - (g / (R * Omega**2)) ** 2))


def test_foucaults_pendulum_has_a_skew_gyroscopic_matrix():
    y = Coordinate("y")
    T = m * ((x.dot - Omega * y) ** 2 + (y.dot + Omega * x) ** 2) / 2
    linear = linearise(Lagrangian([x, y], T, k * (x**2 + y**2) / 2))
    assert sp.Matrix([[0, -2 * m * Omega], [2 * m * Omega, 0]]) == linear.C
    assert sp.Matrix([[k - m * Omega**2, 0], [0, k - m * Omega**2]]) == linear.K


def test_a_follower_force_gives_an_unsymmetric_stiffness():
    """Ziegler's column: two links, thrust P along the upper one (Bolotin 1963, Section 1.2)."""
    P, a = sp.symbols("P a", positive=True)
    one, two = Coordinate("theta_1"), Coordinate("theta_2")
    tip = a * sp.Matrix([sp.sin(one) + sp.sin(two), sp.cos(one) + sp.cos(two)])
    thrust = -P * sp.Matrix([sp.sin(two), sp.cos(two)])
    V = k * one**2 / 2 + k * (two - one) ** 2 / 2
    T = m * a**2 * (one.dot**2 + two.dot**2) / 2
    linear = linearise(Lagrangian([one, two], T, V, virtual_work=[(thrust, tip)]))
    assert identical(linear.K, sp.Matrix([[2 * k - P * a, P * a - k], [-k, k]]))


def test_refuses_a_point_that_is_no_equilibrium():
    hanging = Lagrangian([z, x], m * (z.dot**2 + x.dot**2) / 2, k * z**2 / 2 + m * g * z + k * x**2)
    for way in (linearise, linearise_equations):
        with pytest.raises(InputError, match=r"no equilibrium.*along z: g\*m") as raised:
            way(hanging)
        assert "along x" not in str(raised.value)
    sagged = replace(hanging, equilibrium={z: -m * g / k})
    assert sp.Matrix([[k, 0], [0, 2 * k]]) == linearise(sagged).K


def test_refuses_a_force_that_leaves_the_point_out_of_balance():
    pushed = Lagrangian([z], m * z.dot**2 / 2, virtual_work=[(m * g, 2 * z)])
    with pytest.raises(InputError, match=r"along z: -2\*g\*m"):
        linearise(pushed)
    held = replace(pushed, potential=2 * m * g * z)
    assert linearise(held).K.nnz() == 0


@pytest.mark.parametrize("way", [linearise, linearise_equations])
def test_refuses_inputs_that_act_by_their_second_rate(way):
    carried = Lagrangian([z], m * (z.dot + w.dot) ** 2 / 2, k * z**2 / 2, inputs=[w])
    with pytest.raises(InputError, match="second rate"):
        way(carried)


def test_refuses_what_is_not_smooth():
    with pytest.raises(InputError, match="not smooth"):
        linearise(Lagrangian([z], m * z.dot**2 / 2, k * abs(z)))


def test_columns_keep_the_order_of_the_inputs():
    """w_10 comes after w_2, as listed."""
    inputs = [Input(f"w_{j}") for j in range(1, 12)]
    stiffness = sp.symbols("k_1:12")
    V = sp.Add(*(k_j * (z - w_j) ** 2 / 2 for k_j, w_j in zip(stiffness, inputs, strict=True)))
    linear = linearise(Lagrangian([z], m * z.dot**2 / 2, V, inputs=inputs))
    assert tuple(linear.K_w) == stiffness
    assert linear.inputs == tuple(inputs)


def test_outputs_are_linear_in_what_they_feel():
    """About θ₀ = π/3: p = R sin θ - w, p̈ = R cos θ₀ θ̈, and a sensor that feels all but ẅ."""
    p, f = Coordinate("p"), Force("f")
    everything = 3 * theta.ddot * sp.cos(theta) + 5 * p.dot + c * f - 7 * w.dot + theta**2
    system = Lagrangian(
        [theta], m * theta.dot**2 / 2, k * (p + R * sp.sqrt(3) * (w - 1) / 2) ** 2 / 2, inputs=[w],
        forces=[f], virtual_work=[(f, theta)], kinematics={p: R * sp.sin(theta) - w},
        equilibrium={theta: sp.pi / 3}, outputs={"p": p, "all": everything},
    )  # fmt: skip
    half = sp.Rational(1, 2)
    rows = output_rows(system)
    assert rows["d"] == sp.Matrix([R * half, 2 * sp.pi / 3])
    assert rows["v"] == sp.Matrix([0, 5 * R * half])
    assert rows["a"] == sp.Matrix([0, 3 * half])
    assert rows["w"] == sp.Matrix([-1, 0])
    assert rows["dw"] == sp.Matrix([0, -12])
    assert rows["f"] == sp.Matrix([0, c])
    other = output_rows(system, {"rate": rate(rate(R * sp.sin(theta)))})
    assert other["a"] == sp.Matrix([R * half])


def test_outputs_that_cannot_be_are_refused():
    system = Lagrangian([theta], m * theta.dot**2 / 2, k * (theta - w) ** 2, inputs=[w])
    for output, word in ((theta + z, "z"), (abs(theta), "not smooth"), (theta.ddot.dot, "rate")):
        with pytest.raises(InputError, match=word):
            output_rows(system, {"sensor": output})


def test_outputs_may_feel_the_second_rate_of_an_input():
    """As a wheel load does; whoever cannot have it (the state space) refuses it."""
    system = Lagrangian([theta], m * theta.dot**2 / 2, k * (theta - w) ** 2, inputs=[w])
    assert output_rows(system, {"load": m * w.ddot - k * theta})["ddw"] == sp.Matrix([m])


def test_parameters_are_those_of_the_matrices():
    linear = paper_coach(2).linear
    found = {s.name for s in linear.parameters}
    assert found == set("m_c L k_theta c_theta m_b I_b k_1 c_1 k_2 c_2 l_b l_w".split())


def test_map_treats_every_entry():
    linear = paper_coach(1).linear.map(lambda e: 2 * e)
    assert identical(linear.M, 2 * paper_coach(1).linear.M)


def test_the_model_displays_as_mathematics():
    text = paper_coach(1).linear._repr_latex_()
    assert text.startswith(r"$\displaystyle")
    assert r"\ddot{\theta}_{c}" in text
    assert "=" in text
