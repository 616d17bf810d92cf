"""Mathematics as plain text."""

from __future__ import annotations

import unicodedata

import pytest
import sympy as sp
from vehicles import paper_coach

from railride import text
from railride.halfbody import half_body
from railride.lagrange import Coordinate, Input, Lagrangian

k, m = sp.symbols("k m", positive=True)
z, theta = Coordinate("z_b1"), Coordinate("theta_1")


@pytest.mark.parametrize(
    ("s", "written"),
    [
        (sp.Symbol("k_theta"), "k_θ"),
        (sp.Symbol("c_1"), "c_1"),
        (sp.Symbol("mu_0"), "μ_0"),
        (z, "z_b1"),
        (z.dot, "z\N{COMBINING DOT ABOVE}_b1"),
        (z.ddot, "z\N{COMBINING DIAERESIS}_b1"),
        (theta.dot, "θ\N{COMBINING DOT ABOVE}_1"),
        (Input("w_12"), "w_12"),
    ],
)
def test_symbols(s, written):
    assert text.symbol(s) == written


@pytest.mark.parametrize(
    ("u", "written"),
    [
        (k * m**2, "k·m²"),
        (sp.Symbol("L") ** 5 / 3, "L⁵/3"),
        (k ** sp.Rational(5, 2), "k^(5/2)"),
        (k**12, "k^12"),
        (sp.Symbol("z_2_dot") if False else k * z.dot**2 / 2, "k·z\N{COMBINING DOT ABOVE}_b1²/2"),
    ],
)
def test_expressions(u, written):
    assert text.expression(u) == written


def test_expressions_read_back_to_what_they_say():
    """Every power, product and sum survives: undone, the text is the expression again."""
    u = (k + 2 * m) ** 3 * sp.sqrt(m) / (7 * k**4) - m**23 + k**25
    written = text.expression(u)
    for sign, power in (("²", "**2"), ("³", "**3"), ("⁴", "**4"), ("⁵", "**5"), ("^", "**"),
                        ("·", "*")):  # fmt: skip
        written = written.replace(sign, power)
    assert sp.simplify(sp.sympify(written, {"k": k, "m": m}) - u) == 0


def test_energies_show_everything_that_goes_in():
    shown = text.energies(paper_coach(2).lagrangian)
    for part in ("coordinates:", "inputs:", "forces:", "T = ", "V = ", "D = ", "δW = ", "asin"):
        assert part in shown
    assert all(_width(line) <= 110 for line in shown.splitlines())


def _width(line):
    return sum(not unicodedata.combining(c) for c in line)


def test_matrices_show_every_entry_that_is_not_zero():
    linear = paper_coach(2).linear
    shown = text.matrices(linear)
    lines = [line for line in shown.splitlines() if line.startswith("    ")]
    upper = sum(
        sum(i <= j for i, j in A.todok()) if name in {"M", "C", "K"} else len(A.todok())
        for name, A in linear.matrices.items()
    )
    assert len(lines) == upper
    assert "M (7 × 7, symmetric)" in shown
    assert "K_w (7 × 4)" in shown


def test_matrices_without_entries_are_zero():
    system = Lagrangian([z], m * z.dot**2 / 2, k * z**2 / 2)
    from railride.linear import linearise

    assert "C (1 × 1) = 0" in text.matrices(linearise(system))


def test_equations_are_one_for_each_coordinate():
    shown = text.equations(half_body())
    assert shown.strip().startswith("θ:")
    assert shown.strip().endswith("= 0")
    assert len(shown.splitlines()) == 1


def test_nothing_of_python_is_left():
    shown = text.energies(paper_coach(4).lagrangian) + text.matrices(paper_coach(4).linear)
    assert "**" not in shown
    assert "*" not in shown
    assert "_dot" not in shown
    assert "theta" not in shown
