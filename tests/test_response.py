"""The time response against closed forms, scipy.signal.lsim, control.forced_response and mpmath."""

from __future__ import annotations

import control
import mpmath
import numpy as np
import pytest
import scipy.linalg
import scipy.signal
from hypothesis import given, settings
from hypothesis import strategies as st

from railride import response
from railride.errors import InputError
from railride.response import first_order_hold, simulate


def oscillators(frequencies_hz, damping, rng):
    """Coupled oscillators: poles at the given frequencies, one damping ratio."""
    omega = 2 * np.pi * np.asarray(frequencies_hz)
    n = len(omega)
    shapes = np.linalg.qr(rng.normal(size=(n, n)))[0]
    stiffness = shapes @ np.diag(omega**2) @ shapes.T
    dampers = shapes @ np.diag(2 * damping * omega) @ shapes.T
    return np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -dampers]])


def random_stable(states, inputs, outputs, rng):
    A = rng.normal(size=(states, states))
    A -= np.eye(states) * (np.linalg.eigvals(A).real.max() + 0.2)
    return (
        A,
        rng.normal(size=(states, inputs)),
        rng.normal(size=(outputs, states)),
        rng.normal(size=(outputs, inputs)),
    )


def close(found, expected, tolerance=1e-9):
    """Every output equal to a fraction of its own largest value."""
    assert found.shape == expected.shape
    size = np.abs(expected).max(axis=-1, keepdims=True)
    assert np.all(np.abs(found - expected) <= tolerance * size)


# Against independent programs


@settings(max_examples=60, deadline=None)
@given(
    st.integers(1, 7),
    st.integers(1, 4),
    st.integers(1, 5),
    st.integers(2, 150),
    st.floats(1e-3, 2.0),
    st.integers(0, 2**31),
)
def test_equals_lsim_for_random_systems(states, inputs, outputs, samples, dt, seed):
    rng = np.random.default_rng(seed)
    A, B, C, D = random_stable(states, inputs, outputs, rng)
    u, x0 = rng.normal(size=(inputs, samples)), rng.normal(size=states)
    time = dt * np.arange(samples)
    _, y, x = scipy.signal.lsim((A, B, C, D), u.T, time, X0=x0, interp=True)
    result = simulate(A, B, C, D, u, dt, x0)
    close(result.outputs, y.reshape(samples, outputs).T)
    np.testing.assert_allclose(result.time, time, rtol=1e-15)
    size = np.abs(x).max()
    assert np.abs(result.final_state - x.reshape(samples, states)[-1]).max() <= 1e-9 * size


@pytest.mark.parametrize("damping", [0.1, 1e-3, 0.0])
def test_equals_forced_response_for_a_vehicle_sized_system(damping):
    rng = np.random.default_rng(5)
    A = oscillators(np.geomspace(1, 42, 9), damping, rng)
    B = np.vstack([np.zeros((9, 8)), rng.normal(size=(9, 8)) * ([1e3] * 4 + [10] * 4)])
    C = np.vstack([A[9:], np.eye(18)[:3]])
    D = np.vstack([B[9:], np.zeros((3, 8))])
    u = np.cumsum(rng.normal(size=(8, 12_345)), axis=1) * 1e-4
    time = 1e-3 * np.arange(u.shape[1])
    peer = control.forced_response(control.ss(A, B, C, D), time, u, squeeze=False)
    close(simulate(A, B, C, D, u, 1e-3).outputs, peer.outputs)
    close(simulate(A, B, C[:1], D[:1], u, 1e-3).outputs, peer.outputs[:1])


# Against closed forms


def test_free_mass_under_a_rising_force_through_several_chunks():
    """x'' = t + 1 from rest at 2 m: t^3/6 + t^2/2 + 2; no eigenvectors to diagonalise with."""
    samples = 2 * response.CHUNK + 77
    t = 0.01 * np.arange(samples)
    result = simulate(
        [[0, 1], [0, 0]], [[0], [1]], [[1, 0], [0, 1]], [[0], [0]], [t + 1], 0.01, [2, 0]
    )
    close(result.outputs, np.array([t**3 / 6 + t**2 / 2 + 2, t**2 / 2 + t]), 1e-10)


def test_one_oscillator_driving_its_equal_is_defective_and_grows_as_t_sin_t():
    """a'' + w^2 a = 0 from a = 1; b'' + w^2 b = a: b = t sin(w t)/(2 w)."""
    w = 9.0
    A = [[0, 1, 0, 0], [-(w**2), 0, 0, 0], [0, 0, 0, 1], [1, 0, -(w**2), 0]]
    samples = 20_000
    result = simulate(
        A, np.zeros((4, 1)), [[0, 0, 1, 0]], [[0]], np.zeros((1, samples)), 1e-3, [1, 0, 0, 0]
    )
    t = result.time
    close(result.outputs, np.array([t * np.sin(w * t) / (2 * w)]), 1e-10)


@pytest.mark.parametrize("apart", [0.0, 1e-13, 1e-9, 1e-5])
def test_two_bogies_equal_or_nearly_so(apart):
    """Each x'' + 2 z w x' + w^2 x = w^2: 1 - exp(-z w t) (cos w_d t + z w/w_d sin w_d t)."""
    damping, omega = 0.37, np.array([60.0, 60.0 * (1 + apart)])
    A = np.zeros((4, 4))
    A[:2, 2:] = np.eye(2)
    A[2:, :2], A[2:, 2:] = -np.diag(omega**2), -np.diag(2 * damping * omega)
    turn = scipy.linalg.block_diag(*2 * [np.array([[0.6, -0.8], [0.8, 0.6]])])
    B = np.vstack([np.zeros((2, 1)), omega[:, None] ** 2])
    C = np.eye(2, 4)
    step = np.ones((1, 1500))
    result = simulate(turn @ A @ turn.T, turn @ B, C @ turn.T, np.zeros((2, 1)), step, 1e-3)
    t, w = result.time, omega[:, None]
    free = w * np.sqrt(1 - damping**2)
    expected = 1 - np.exp(-damping * w * t) * (
        np.cos(free * t) + damping * w / free * np.sin(free * t)
    )
    close(result.outputs, expected, 1e-11)


@pytest.mark.parametrize("pole", [0.0, 1e-9, 1e-3, 1.0, 100.0, 1e4, 1e7])
def test_one_pole_under_a_ramp(pole):
    """x' = -a x + t: (a t - 1 + exp(-a t))/a^2, written without the cancellation."""
    t = 1e-3 * np.arange(500)
    result = simulate([[-pole]], [[1]], [[1]], [[0]], [t], 1e-3)
    a, expected = mpmath.mpf(pole), []
    with mpmath.workdps(60):
        for time in t:
            s = mpmath.mpf(time)
            exact = (a * s - 1 + mpmath.exp(-a * s)) / a**2 if pole else s**2 / 2
            expected.append(float(exact))
    close(result.outputs, np.array([expected]), 1e-12)


def test_state_scales_far_apart():
    """Poles from 0 to 1e4 rad/s, states in units up to 1e12 apart, inputs 1e14: each exact.

    The reference is the series of the matrix exponential with 60 digits.
    """
    rng = np.random.default_rng(8)
    poles = scipy.linalg.block_diag(
        [[0, 1], [0, 0]], [[-0.2, 8], [-8, -0.2]], [[-1e4]], [[-30, 1], [0, -30]]
    )
    n = len(poles)
    turn = np.linalg.qr(rng.normal(size=(n, n)))[0]
    unit = 10.0 ** rng.permutation(np.linspace(-6, 6, n))
    A = (turn @ poles @ turn.T) * unit[:, None] / unit
    B = rng.normal(size=(n, 3)) * unit[:, None] * [1e-6, 1, 1e8]
    found = first_order_hold(A, B, 1e-3)
    with mpmath.workdps(60):
        augmented = mpmath.zeros(n + 6)
        augmented[:n, :n] = mpmath.matrix(A.tolist()) * mpmath.mpf("1e-3")
        augmented[:n, n : n + 3] = mpmath.matrix(B.tolist()) * mpmath.mpf("1e-3")
        for i in range(3):
            augmented[n + i, n + 3 + i] = 1
        exact = mpmath.expm(augmented)
        exact = np.array(exact.tolist(), dtype=object).astype(float)
    E, both, F1 = exact[:n, :n], exact[:n, n : n + 3], exact[:n, n + 3 :]
    columns = np.array([1e-6, 1, 1e8])
    assert np.abs((found[0] - E) / unit[:, None] * unit).max() < 1e-14
    assert np.abs((found[1] - (both - F1)) / unit[:, None] / columns).max() < 5e-18
    assert np.abs((found[2] - F1) / unit[:, None] / columns).max() < 5e-18


def test_free_decay_is_the_matrix_exponential():
    rng = np.random.default_rng(3)
    A = oscillators([1.0, 9.6, 9.6, 30.0], 0.02, rng)
    x0 = rng.normal(size=8)
    result = simulate(
        A, np.zeros((8, 0)), np.eye(8), np.zeros((8, 0)), np.zeros((0, 901)), 0.01, x0
    )
    for k in (0, 1, 37, 512, 900):
        np.testing.assert_allclose(
            result.outputs[:, k], scipy.linalg.expm(A * 0.01 * k) @ x0, rtol=0, atol=1e-10
        )


def test_a_finer_step_through_the_same_straight_lines_changes_nothing():
    rng = np.random.default_rng(4)
    A, B, C, D = random_stable(6, 2, 2, rng)
    u = rng.normal(size=(2, 90))
    fine = np.stack([np.interp(np.arange(0, 89.01, 0.2), np.arange(90), row) for row in u])
    close(
        simulate(A, B, C, D, fine, 0.06).outputs[:, ::5],
        simulate(A, B, C, D, u, 0.3).outputs,
        1e-11,
    )


# Blocks, shapes, chunks


@pytest.mark.parametrize("samples", [1, 2, 3, 7, 8, 9, 64, 257, 1031])
def test_the_lengths_of_block_group_and_chunk_change_nothing(monkeypatch, samples):
    rng = np.random.default_rng(samples)
    A, B, C, D = random_stable(5, 3, 2, rng)
    u, x0 = rng.normal(size=(3, samples)), rng.normal(size=5)
    E, F0, F1 = first_order_hold(A, B, 0.05)
    x, outputs = x0, [C @ x0 + D @ u[:, 0]]
    for k in range(1, samples):
        x = E @ x + F0 @ u[:, k - 1] + F1 @ u[:, k]
        outputs.append(C @ x + D @ u[:, k])
    expected = np.array(outputs).T
    lengths = [(1, 2, 5), (1, 8, 10**6), (3, 3, 10), (8, 8, 64), (16, 4, 1), (64, 8, 99)]
    for p, group, chunk in lengths:
        monkeypatch.setattr(response, "_block_length", lambda *_, p=p: p)
        monkeypatch.setattr(response, "GROUP", group)
        monkeypatch.setattr(response, "CHUNK", chunk)
        result = simulate(A, B, C, D, u, 0.05, x0)
        close(result.outputs, expected, 1e-11)
        np.testing.assert_allclose(result.final_state, x, rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("samples", [1, 2, 5, 100])
@pytest.mark.parametrize(("inputs", "outputs"), [(1, 1), (8, 12), (3, 0), (0, 2)])
def test_shapes_are_never_squeezed(samples, inputs, outputs):
    A, B, C, D = random_stable(4, inputs, outputs, np.random.default_rng(1))
    result = simulate(A, B, C, D, np.ones((inputs, samples)), 0.1)
    assert result.outputs.shape == (outputs, samples)
    assert result.time.shape == (samples,)
    assert result.final_state.shape == (4,)


def test_a_gain_without_states():
    u = np.array([[1.0, 2, 3], [4, 5, 6]])
    none = np.zeros
    result = simulate(none((0, 0)), none((0, 2)), none((1, 0)), [[2, -1]], u, 0.1)
    np.testing.assert_array_equal(result.outputs, [[-2, -1, 0]])


def test_no_input_from_rest_stays_at_rest():
    A, B, C, D = random_stable(4, 2, 2, np.random.default_rng(2))
    assert not simulate(A, B, C, D, np.zeros((2, 1000)), 0.1).outputs.any()


def test_a_run_goes_on_from_its_final_state():
    rng = np.random.default_rng(6)
    A, B, C, D = random_stable(5, 2, 3, rng)
    u = rng.normal(size=(2, 500))
    whole = simulate(A, B, C, D, u, 0.1)
    first = simulate(A, B, C, D, u[:, :201], 0.1)
    second = simulate(A, B, C, D, u[:, 200:], 0.1, first.final_state)
    close(np.hstack([first.outputs, second.outputs[:, 1:]]), whole.outputs, 1e-12)
    np.testing.assert_allclose(second.final_state, whole.final_state, rtol=1e-11)


def test_the_arguments_are_left_as_they_were():
    rng = np.random.default_rng(7)
    given = [*random_stable(3, 2, 1, rng), rng.normal(size=(2, 50))]
    before = [array.copy() for array in given]
    simulate(*given, 0.1, np.ones(3))
    for array, copy in zip(given, before, strict=True):
        np.testing.assert_array_equal(array, copy)


def test_progress_rises_to_one():
    heard = []
    simulate(
        [[-1]], [[1]], [[1]], [[0]], np.ones((1, 3 * response.CHUNK)), 0.1, progress=heard.append
    )
    assert len(heard) >= 3
    assert heard == sorted(heard)
    assert heard[-1] == 1.0


# What is refused


def test_growth_beyond_numbers_names_the_unstable_model():
    for samples in (2000, 100_000):
        with pytest.raises(InputError, match=r"beyond numbers.*unstable"):
            simulate([[500.0]], [[1]], [[1]], [[0]], np.ones((1, samples)), 0.01)
    with pytest.raises(InputError, match="unstable"):
        simulate([[500.0]], [[1]], np.ones((0, 1)), np.ones((0, 1)), np.ones((1, 2000)), 0.01)
    with pytest.raises(InputError, match="unstable"):  # the state, at 1e174, is still a number
        simulate([[100.0]], [[0]], [[1e200]], [[0]], np.zeros((1, 401)), 0.01, [1.0])
    with pytest.raises(InputError, match="unstable"):
        simulate([[1e300]], [[1]], [[1]], [[0]], np.ones((1, 3)), 1e300)


def test_a_finite_response_of_an_unstable_model_is_given():
    result = simulate([[1.0]], [[0]], [[1]], [[0]], np.zeros((1, 101)), 0.1, [1.0])
    np.testing.assert_allclose(result.outputs, np.exp(result.time)[None], rtol=1e-12)


def test_all_that_does_not_fit_is_told_at_once():
    with pytest.raises(InputError) as caught:
        simulate(
            np.eye(3), np.ones((2, 1)), np.ones((1, 2)), np.ones((2, 1)), np.ones((2, 5)), -1, [1.0]
        )
    message = str(caught.value)
    for part in ("A: found shape (3, 3); expected (2, 2)", "D: found", "u: found", "dt: found"):
        assert part in message
    assert "x0: found shape (1,)" in message
    with pytest.raises(InputError, match="u: found shape"):
        simulate([[-1]], [[1]], [[1]], [[0]], np.ones(5), 0.1)
    with pytest.raises(InputError, match="no samples"):
        simulate([[-1]], [[1]], [[1]], [[0]], np.ones((1, 0)), 0.1)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_number_that_is_none_is_named_with_its_place(bad):
    u = np.ones((2, 9))
    u[1, 4] = bad
    with pytest.raises(InputError, match=r"u\[1, 4\]: found (nan|inf)"):
        simulate([[-1]], [[1, 1]], [[1]], [[0, 0]], u, 0.1)
    with pytest.raises(InputError, match="dt"):
        simulate([[-1]], [[1, 1]], [[1]], [[0, 0]], np.ones((2, 9)), bad)
