"""The paper's half-body: Eqs (1)-(4) of Çati, Düzgün, Kracht, Appl. Sci. 2024, 14, 3848."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

import railride as rr
from railride.halfbody import PAPER_VALUES, L_h, half_body, k_theta, m_h, positions, theta
from railride.linear import linearise


def test_equation_1_places_both_halves():
    front, rear = positions()
    assert front == sp.Matrix([L_h / 2 * sp.cos(theta), L_h / 2 * sp.sin(theta)])
    assert rear == sp.Matrix([3 * L_h / 2 * sp.cos(theta), L_h / 2 * sp.sin(theta)])


def test_equation_2_energies():
    system = half_body()
    T = m_h * L_h**2 * theta.dot**2 / 3 + m_h * L_h**2 * theta.dot**2 * sp.sin(theta) ** 2
    assert sp.simplify(system.kinetic - T) == 0
    assert sp.simplify(system.potential - 2 * k_theta * theta**2) == 0


def test_equation_3_as_printed():
    inertia = 2 * m_h * L_h**2 / 3 + 2 * m_h * L_h**2 * sp.sin(theta) ** 2
    centrifugal = 2 * m_h * L_h**2 * theta.dot**2 * sp.sin(theta) * sp.cos(theta)
    printed = inertia * theta.ddot + centrifugal + 4 * k_theta * theta
    assert sp.simplify(half_body().equations()[0] - printed) == 0


@pytest.mark.parametrize(("free", "factor"), [(False, 6), (True, 24)])
def test_equation_4_and_that_of_a_free_body(free, factor):
    linear = linearise(half_body(free))
    assert sp.simplify(linear.K[0] / linear.M[0] - factor * k_theta / (m_h * L_h**2)) == 0
    assert linear.C.nnz() == 0


@pytest.mark.parametrize(("free", "hertz"), [(False, "4.79"), (True, "9.586")])
def test_frequencies_with_the_papers_values(free, hertz):
    linear = linearise(half_body(free))
    omega = float(sp.sqrt(linear.K[0] / linear.M[0]).subs(PAPER_VALUES))
    digits = len(hertz.partition(".")[2])
    assert f"{omega / (2 * np.pi):.{digits}f}" == hertz


def test_it_takes_ten_lines_to_write_with_the_public_names():
    m, L, k = sp.symbols("m L k", positive=True)
    q = rr.Coordinate("q")
    front = sp.Matrix([L / 2 * sp.cos(q), L / 2 * sp.sin(q)])
    rear = sp.Matrix([3 * L / 2 * sp.cos(q), L / 2 * sp.sin(q)])
    v_f, v_r = rr.rate(front), rr.rate(rear)
    T = m * (v_f.dot(v_f) + v_r.dot(v_r)) / 2 + m * L**2 / 12 * q.dot**2
    V = k * (2 * q) ** 2 / 2
    system = rr.Lagrangian([q], T, V)
    linear = rr.linearise(system)
    assert sp.simplify(linear.K[0] / linear.M[0] - 6 * k / (m * L**2)) == 0
    printed = (2 * m * L**2 / 3 + 2 * m * L**2 * sp.sin(q) ** 2) * q.ddot
    printed += 2 * m * L**2 * q.dot**2 * sp.sin(q) * sp.cos(q) + 4 * k * q
    assert sp.simplify(system.equations()[0] - printed) == 0
