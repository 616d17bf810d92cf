"""The state space against the equations of motion, python-control and scipy."""

from __future__ import annotations

import control
import numpy as np
import pytest
import scipy.signal
from vehicles import paper_coach, random_model

from railride.errors import InputError
from railride.frequency import track_response, wheelset_delays
from railride.statespace import state_space, system_arrays


def test_names_and_shapes():
    plant = state_space(paper_coach(2))
    assert isinstance(plant, control.StateSpace)
    q = ["z_0", "z_1", "z_2", "z_b1", "theta_b1", "z_b2", "theta_b2"]
    assert plant.state_labels == [*q, *(f"d{name}" for name in q)]
    w = [f"w_{j}" for j in range(1, 5)]
    assert plant.input_labels == [*w, *(f"d{name}" for name in w), "f_1", "f_2"]
    assert plant.output_labels == ["floor_acceleration"]
    assert plant.name == "cati2024"


def test_outputs_on_request_keep_their_order_and_names():
    model = paper_coach(2)
    chosen = ["secondary_2_deflection", model.floor(-3.0, "polygon", 1), "bogie_1_acceleration",
              "primary_3_deflection", "floor_acceleration",
              model.floor(2.5, derivative=0)]  # fmt: skip
    plant = state_space(model, chosen)
    assert plant.output_labels == [
        "secondary_2_deflection", "floor_velocity_3m_behind_polygon", "bogie_1_acceleration",
        "primary_3_deflection", "floor_acceleration", "floor_displacement_2_5m_ahead",
    ]  # fmt: skip


def test_points_and_readings_of_the_floor_have_names_of_their_own():
    """Any point of the body, in both readings, side by side."""
    model = paper_coach(4)
    points = [model.floor(x, reading) for x in (0.0, 2.5, -2.5, 0.25, 2.05)
              for reading in ("smooth", "polygon")]  # fmt: skip
    plant = state_space(model, points)
    assert len(set(plant.output_labels)) == 10
    assert plant.noutputs == 10


@pytest.mark.parametrize(("seed", "segments"), [(0, 1), (1, 2), (2, 5)])
def test_transfer_functions_equal_those_of_the_equations_of_motion(seed, segments):
    """C (sI - A)⁻¹ B + D against s^k h (s² M + s C + K)⁻¹ [K_w, C_w, B_f], h the point's row."""
    model = random_model(seed, segments)
    m, s = model.matrices(), 2.3 + 11.0j
    points = [model.floor(x, "polygon", derivative) for x in (0.0, 4.0) for derivative in range(3)]
    plant = state_space(model, points)
    G = plant(s)
    rows = model.output_rows([model.floor(x, "polygon", 0) for x in (0.0, 4.0)])["d"]
    q = np.linalg.solve(s**2 * m.M + s * m.C + m.K, np.hstack([m.K_w, m.C_w, m.B_f]))
    expected = np.vstack([s**k * (row @ q) for row in rows for k in range(3)])
    np.testing.assert_allclose(G, expected, rtol=1e-8, atol=1e-10 * np.abs(expected).max())


def test_arrays_are_the_plants():
    model = paper_coach(3)
    arrays, plant = system_arrays(model), state_space(model)
    for name in "ABCD":
        np.testing.assert_array_equal(getattr(arrays, name), getattr(plant, name))
    n = len(model.linear.coordinates)
    np.testing.assert_array_equal(arrays.A[:n], np.eye(2 * n)[n:])


@pytest.mark.parametrize(("seed", "segments"), [(0, 1), (1, 4)])
def test_elevations_alone_give_the_same_frequency_response(seed, segments):
    model = random_model(seed, segments)
    chosen = [model.floor(0.0), model.floor(3.0, "polygon", 0), model.floor(3.0, derivative=1),
              "secondary_1_deflection"]  # fmt: skip
    rates, elevation = (state_space(model, chosen, inputs=kind) for kind in ("rates", "elevation"))
    k = len(model.linear.inputs)
    assert elevation.input_labels == [*rates.input_labels[:k], *rates.input_labels[2 * k :]]
    speeds = elevation.state_labels[rates.nstates // 2 :]
    assert all(name.endswith("_less_track") for name in speeds)
    for omega in (0.7, 9.0, 60.0, 400.0):
        both, one = rates(1j * omega), elevation(1j * omega)
        w = both[:, :k] + 1j * omega * both[:, k : 2 * k]
        size = np.abs(w).max(axis=1, keepdims=True)
        np.testing.assert_allclose(one[:, :k] / size, w / size, atol=1e-8)
        np.testing.assert_allclose(one[:, k:], both[:, 2 * k :], rtol=1e-7, atol=1e-12)


def test_elevations_alone_give_the_same_time_response():
    """Started at x_2 = -M⁻¹ C_w w(0); a jump of the track would be an impulse otherwise."""
    model, dt = paper_coach(2), 1e-4
    t = np.arange(0, 1.0, dt)
    delays = wheelset_delays(model, 50.0)[:, None]
    at = t - delays
    w, dw = 2e-3 + 1e-3 * np.cos(20 * at), -0.02 * np.sin(20 * at)
    still = np.zeros((2, t.size))
    rates, elevation = (system_arrays(model, inputs=kind) for kind in ("rates", "elevation"))
    m, n = model.matrices(), len(model.linear.coordinates)
    x0 = np.concatenate([m.lift * 2e-3, np.zeros(n)])
    x0_w = x0 - np.concatenate([np.zeros(n), np.linalg.solve(m.M, m.C_w @ w[:, 0])])
    _, y, _ = scipy.signal.lsim((rates.A, rates.B, rates.C, rates.D),
                                np.vstack([w, dw, still]).T, t, x0)  # fmt: skip
    _, y_w, _ = scipy.signal.lsim((elevation.A, elevation.B, elevation.C, elevation.D),
                                  np.vstack([w, still]).T, t, x0_w)  # fmt: skip
    # Both are exact for inputs linear between samples; w and ẇ cannot both be.
    assert np.abs(y - y_w).max() < 2e-6 * np.abs(y).max()
    _, wrong, _ = scipy.signal.lsim((elevation.A, elevation.B, elevation.C, elevation.D),
                                    np.vstack([w, still]).T, t, x0)  # fmt: skip
    assert np.abs(y - wrong).max() > 0.05 * np.abs(y).max()


def test_elevations_alone_are_refused_for_outputs_that_feel_the_rate():
    with pytest.raises(InputError, match=r"bogie_1_acceleration.*rate.*primary dampers.*rates"):
        state_space(paper_coach(2), ["floor_acceleration", "bogie_1_acceleration"],
                    inputs="elevation")  # fmt: skip
    plant = state_space(paper_coach(2), ["bogie_1_acceleration"], inputs="elevation", c_1=0.0)
    assert plant.noutputs == 1


def test_unknown_outputs_are_refused_with_those_there_are():
    with pytest.raises(InputError) as raised:
        state_space(paper_coach(2), ["bogie_3_acceleration"])
    for name in ("'bogie_3_acceleration'", "floor_acceleration", "bogie_2_acceleration",
                 "primary_4_deflection", "model.floor"):  # fmt: skip
        assert name in str(raised.value)
    with pytest.raises(InputError, match="rates, elevation"):
        state_space(paper_coach(2), inputs="both")
    with pytest.raises(InputError, match="one vehicle at a time"):
        state_space(paper_coach(2), k_2=[1e5, 2e5])


def test_changes_reach_the_plant():
    model = paper_coach(2)
    one, other = state_space(model, k_2=5e5), state_space(model)
    assert one.poles().shape == other.poles().shape
    assert not np.allclose(one.A, other.A)
    m, n = model.matrices(k_2=5e5), 7
    np.testing.assert_allclose(one.A[n:, :n], -np.linalg.solve(m.M, m.K), rtol=1e-9, atol=1e-6)


def test_actuators_push_the_body_up_and_the_bogie_down():
    """f_1 alone on free masses: at high frequency m_b z̈_b1 → -f."""
    plant = state_space(paper_coach(1), ["bogie_1_acceleration", "floor_acceleration"])
    D = plant.D[:, plant.input_labels.index("f_1")]
    np.testing.assert_allclose(D, [-1 / 3000, 1 / 34000], rtol=1e-12)


def test_all_wheelsets_together_are_the_track_response():
    model, V, f = paper_coach(4), 40.0, 3.3
    plant = state_space(model)
    s, k = 2j * np.pi * f, 4
    e = np.exp(-s * wheelset_delays(model, V))
    G = plant(s)
    expected = (G[:, :k] @ e + s * (G[:, k : 2 * k] @ e))[0]
    found = track_response(model, [model.floor()], V, [f])[0, 0]
    assert found == pytest.approx(expected, rel=1e-9)
