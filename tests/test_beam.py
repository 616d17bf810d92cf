"""Free-free uniform beams: against closed forms, published tables and each other's limits."""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
import scipy.optimize
from numpy.testing import assert_allclose

from railride.bodies import BeamBody, beam_modes, slender_beam
from railride.bodies.shear_beam import shear_beam, stiffness_for
from railride.bodies.uniform_beam import UniformBeam
from railride.errors import InputError
from railride.parameters import BodyProfile, CarBody

COACH = CarBody(34e3, 34e3 * 48, 24.0, bending_frequency=9.6)
POINTS, WEIGHTS = np.polynomial.legendre.leggauss(240)  # on [-1, 1]


# Euler-Bernoulli


def test_roots_are_those_of_the_frequency_equation():
    """cos β cosh β = 1, bracketed and solved by scipy; the first three as printed."""
    found = slender_beam.roots(60)
    assert [f"{b:.6f}" for b in found[:3]] == ["4.730041", "7.853205", "10.995608"]
    for i, beta in enumerate(found, start=1):
        exact = scipy.optimize.brentq(lambda b: np.cos(b) - 1 / np.cosh(b), i * np.pi + 1,
                                      (i + 1) * np.pi, xtol=1e-14)  # fmt: skip
        assert beta == pytest.approx(exact, rel=1e-14)


@pytest.mark.parametrize("count", [3, 30, 60])
def test_modes_are_orthogonal_to_one_another_and_to_rigid_motions(count):
    phi = slender_beam.shapes(count, POINTS / 2)
    motions = np.vstack([np.ones_like(POINTS), np.sqrt(3) * POINTS, phi])
    products = (motions * WEIGHTS / 2) @ motions.T
    assert_allclose(products, np.eye(count + 2), rtol=0, atol=1e-12)


def test_shapes_are_those_of_the_textbook():
    """Blevins, Table 8-1: cosh λy + cos λy - σ (sinh λy + sin λy) from one end, with printed σ."""
    y = np.linspace(0, 1, 41)
    for i, (lam, sigma) in enumerate([(4.73004074, 0.982502215), (7.85320462, 1.000777312),
                                      (10.9956079, 0.999966450)]):  # fmt: skip
        printed = (np.cosh(lam * y) + np.cos(lam * y)
                   - sigma * (np.sinh(lam * y) + np.sin(lam * y)))  # fmt: skip
        found = slender_beam.shapes(3, 0.5 - y)[i]
        assert_allclose(found, printed, atol=2e-4)  # what nine digits of σ leave of sinh 11


def test_shapes_of_very_many_modes_stay_finite_and_end_at_two():
    ends = slender_beam.shapes(500, np.array([0.5, -0.5]))
    assert_allclose(np.abs(ends), 2, rtol=1e-9)
    assert np.isfinite(slender_beam.shapes(500, np.linspace(-0.5, 0.5, 99))).all()


@pytest.mark.parametrize("count", [6, 30])
def test_slopes_are_the_shapes_derivatives(count):
    """By the polynomial through 240 Gauss points, which differentiates to rounding."""
    through = np.polynomial.legendre.legfit(POINTS, slender_beam.shapes(count, POINTS / 2).T, 120)
    slopes = slender_beam.slopes(count, POINTS / 2)
    found = 2 * np.polynomial.legendre.legval(POINTS, np.polynomial.legendre.legder(through))
    assert_allclose(found, slopes, atol=1e-8 * np.abs(slopes).max())


def test_the_shape_solves_the_beams_equation_and_no_moment_or_shear_is_left_at_the_ends():
    """EI φ'''' = μ ω² φ and φ'' = φ''' = 0 at ±L/2."""
    beta = slender_beam.roots(5)
    fit = np.polynomial.legendre.Legendre.fit
    for b, shape in zip(beta, slender_beam.shapes(5, POINTS / 2), strict=True):
        through = fit(POINTS, shape, 40, domain=[-1, 1])
        inner = np.linspace(-0.9, 0.9, 19)
        assert_allclose(16 * through.deriv(4)(inner), b**4 * through(inner), atol=1e-5 * b**4)
        for order in (2, 3):
            assert_allclose(2**order * through.deriv(order)(np.array([-1, 1])) / b**order, 0,
                            atol=1e-7)  # fmt: skip


# Timoshenko


def determinant(b_squared, r2, s2, *, odd):
    """Huang's frequency equation of free ends, for modes odd or even about the middle.

    On the whole length: b² = μ ω² L⁴/EI, r² = ρI/(μ L²), s² = EI/(κGA L²). No moment and no shear
    force of w = A cos βξ + B cosh αξ, or of the sines, at ξ = ½; α may be imaginary.
    """
    root = np.sqrt(b_squared**2 * (r2 - s2) ** 2 + 4 * b_squared)
    beta = np.sqrt((b_squared * (r2 + s2) + root) / 2)
    alpha = np.sqrt(complex((root - b_squared * (r2 + s2)) / 2))
    near, far = s2 * b_squared - beta**2, alpha**2 + s2 * b_squared
    cosh, sinh = np.cosh(alpha / 2), np.sinh(alpha / 2) / alpha
    if odd:
        return float((near * np.sin(beta / 2) * cosh
                      + far * alpha**2 * sinh * np.cos(beta / 2) / beta).real)  # fmt: skip
    return float((near * np.cos(beta / 2) * sinh - far * cosh * np.sin(beta / 2) / beta).real)


# Slender, like a coach, and so thick that shear waves and the second spectrum come in.
RATIOS = [(0.0, 0.01), (0.003, 0.0), (0.002, 0.01), (0.01, 0.03), (0.02, 0.2)]


@pytest.mark.parametrize(("r2", "s2"), RATIOS)
def test_frequencies_are_all_the_roots_of_the_frequency_equation(r2, s2):
    """Every root up to the twelfth, found by bracketing it on a fine grid, and no other."""
    found = 16 * shear_beam(4 * r2, 4 * s2, 12).eigenvalues
    grid = np.linspace(5.0, np.sqrt(found[-1]) * 1.001, 20_001) ** 2
    roots = []
    for odd in (False, True):
        values = np.array([determinant(b, r2, s2, odd=odd) for b in grid])
        for k in np.flatnonzero(values[:-1] * values[1:] < 0):
            equation = partial(determinant, r2=r2, s2=s2, odd=odd)
            roots.append(scipy.optimize.brentq(equation, grid[k], grid[k + 1], xtol=1e-9))
    assert_allclose(np.sort(roots), found, rtol=1e-10)


@pytest.mark.parametrize(
    ("thickness", "printed"),
    [(0.005, "4.72982"), (0.01, "4.72918"), (0.02, "4.72659"), (0.05, "4.70873"),
     (0.1, "4.64849")],
)  # fmt: skip
def test_first_frequency_of_rectangular_beams(thickness, printed):
    """βL of J. Lee, W.W. Schultz, J. Sound Vib. 269 (2004) 609-621: ν = 0.3, κ = 5/6, by h/L."""
    r2 = thickness**2 / 12
    (found,) = 2 * shear_beam(4 * r2, 4 * r2 * 2 * 1.3 / (5 / 6), 1).eigenvalues ** 0.25
    assert f"{found:.5f}" == printed


@pytest.mark.parametrize("count", [5, 30])
def test_a_beam_that_neither_shears_nor_turns_is_eulers(count):
    beam = shear_beam(0.0, 0.0, count)
    assert_allclose(2 * beam.eigenvalues**0.25, slender_beam.roots(count), rtol=1e-12)
    assert_allclose(beam.shapes(POINTS), slender_beam.shapes(count, POINTS / 2), atol=1e-8)


def test_the_slender_limit_is_reached_with_the_first_power_of_the_flexibility():
    gaps = [1 - shear_beam(0.0, s2, 3).eigenvalues * 16 / slender_beam.roots(3) ** 4
            for s2 in (1e-4, 1e-5, 1e-6)]  # fmt: skip
    assert_allclose(np.log10(np.divide(gaps[0], gaps[1])), 1, atol=0.01)
    assert_allclose(np.log10(np.divide(gaps[1], gaps[2])), 1, atol=0.001)


@pytest.mark.parametrize("s2", [0.0, 0.01, 0.3])
def test_modes_that_shear_are_orthogonal(s2):
    phi = shear_beam(0.0, s2, 30).shapes(POINTS)
    motions = np.vstack([np.ones_like(POINTS), np.sqrt(3) * POINTS, phi])
    assert_allclose((motions * WEIGHTS / 2) @ motions.T, np.eye(32), rtol=0, atol=1e-12)


@pytest.mark.parametrize("r2", [0.001, 0.02])
def test_modes_with_rotary_inertia_are_orthogonal_with_it(r2):
    """Without shear ψ = w': ∫(w w + r² w' w') du, and with w = 1 and w = u."""
    beam = shear_beam(r2, 0.0, 30)
    w = np.vstack([np.ones_like(POINTS), POINTS, beam.shapes(POINTS)])
    turn = np.vstack([np.zeros_like(POINTS), np.ones_like(POINTS), beam.slopes(POINTS)])
    products = (w * WEIGHTS / 2) @ w.T + r2 * (turn * WEIGHTS / 2) @ turn.T
    own = np.sqrt(np.diagonal(products))
    assert_allclose(products / np.outer(own, own), np.eye(32), rtol=0, atol=1e-12)
    assert_allclose(own[2:], 1, rtol=1e-12)


def test_arrays_of_beams_equal_one_by_one():
    r2, s2 = np.array([[0.001], [0.02]]), np.array([0.0, 0.01, 0.1])
    many = shear_beam(r2, s2, 4)
    for i, j in np.ndindex(2, 3):
        one = shear_beam(r2[i, 0], s2[j], 4)
        assert_allclose(many.eigenvalues[i, j], one.eigenvalues, rtol=1e-12)
        assert_allclose(many.shapes(0.3)[:, i, j], one.shapes(0.3), atol=1e-10)


# Calibration


@pytest.mark.parametrize("rotary", [0.0, 2800.0])
@pytest.mark.parametrize("shear", [3e8, 1e9, 1e12])
def test_the_bending_stiffness_gives_the_frequency(shear, rotary):
    stiffness = stiffness_for(np.array(9.6), np.array(34e3 / 24), np.array(24.0),
                              np.array(shear), np.array(rotary))  # fmt: skip
    beam = UniformBeam(2, 34e3, 24.0, bending_stiffness=stiffness, shear_stiffness=shear,
                       rotary_inertia=rotary)  # fmt: skip
    assert beam.frequencies[0] == pytest.approx(9.6, rel=1e-12)
    slender = UniformBeam(2, 34e3, 24.0, frequency=9.6)
    assert stiffness > slender.stiffness * (1 - 1e-3)
    assert beam.frequencies[1] < slender.frequencies[1]


def test_a_frequency_beyond_what_shear_allows_is_refused():
    """However stiff in bending: κGA w'' = -μ ω² w, free of moments only, has √(κGA/μ)/L."""
    mass, length, shear = 34e3, 24.0, 4e7
    highest = np.sqrt(shear / (mass / length)) / length
    body = CarBody(mass, mass * length**2 / 12, length, bending_frequency=0.9 * highest,
                   shear_stiffness=shear)  # fmt: skip
    assert beam_modes(body, 2).frequencies[0] == pytest.approx(0.9 * highest, rel=1e-9)
    with pytest.raises(InputError, match=r"first bending frequency of .* Hz with a shear stiffn"):
        beam_modes(CarBody(mass, mass * length**2 / 12, length, bending_frequency=1.1 * highest,
                           shear_stiffness=shear), 2)  # fmt: skip


def test_frequencies_from_a_bending_stiffness():
    """f = β²/(2π) √(EI/(m L³)), by hand."""
    body = CarBody(30e3, 30e3 * 400 / 12, 20.0, bending_stiffness=8e8)
    expected = 4.730040744862704**2 / (2 * np.pi) * np.sqrt(8e8 / (30e3 * 20.0**3))
    assert beam_modes(body, 1).frequencies[0] == pytest.approx(expected, rel=1e-12)


# What a uniform beam cannot be made of


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"bending_frequency": None}, "found nothing of its bending"),
        ({"bending_frequency": None, "joint_stiffness": 3.7e8}, r"joint_stiffness of 3\.7e\+08"),
        ({"joint_damping": 1e5}, "joint_damping"),
        ({"mass_centre": 0.3}, "mass_centre: found 0.3 m"),
        ({"profile": BodyProfile((-12, 12), (3e9, 3e9), (34e3 / 24, 34e3 / 24))}, "profile"),
    ],
)
def test_a_body_that_is_no_uniform_beam_is_refused(changes, words):
    fields = {"mass": 34e3, "pitch_inertia": 34e3 * 48, "length": 24.0, "bending_frequency": 9.6}
    with pytest.raises(InputError, match=words):
        BeamBody.of(CarBody(**fields | changes), 4)


def test_another_pitch_inertia_than_the_beams_is_told():
    (said,) = beam_modes(CarBody(34e3, 1.7e6, 24.0, bending_frequency=9.6), 1).remarks
    assert "1.7e+06" in said
    assert "1.632e+06" in said
    rotary = (1.7e6 - 34e3 * 48) / 24
    shear = CarBody(34e3, 1.7e6, 24.0, bending_frequency=9.6, rotary_inertia=rotary)
    assert beam_modes(shear, 1).remarks == ()
    assert beam_modes(shear, 1).pitch_inertia == pytest.approx(1.7e6)
