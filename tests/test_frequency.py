"""The response to the track against a direct solution, geometry and limits."""

from __future__ import annotations

import numpy as np
import pytest
from vehicles import mirrored, paper_coach, random_model

from railride.errors import InputError
from railride.frequency import solve_at, track_response, wheelset_delays
from railride.modal import modes
from railride.vehicle import derive_vehicle

V = 200 / 3.6


def directly(model, speed, frequency, at, derivative=2, **changes):
    """One linear solution per frequency, with the polygon's height as a row."""
    m = model.matrices(**changes)
    row = model.output_rows([model.floor(at, "polygon", 0)], **changes)["d"][0]
    x = np.array(model.vehicle.wheelset_positions)
    found = []
    for f in frequency:
        omega = 2 * np.pi * f
        e = np.exp(-1j * omega * (x[0] - x) / speed)
        q = np.linalg.solve(m.K - omega**2 * m.M + 1j * omega * m.C,
                            (m.K_w + 1j * omega * m.C_w) @ e)  # fmt: skip
        found.append((1j * omega) ** derivative * row @ q)
    return np.array(found)


@pytest.mark.parametrize("model", [paper_coach(1), paper_coach(2), paper_coach(8),
                                   random_model(0, 4), random_model(1, 3)],
                         ids=["N=1", "N=2", "N=8", "random 0", "random 1"])  # fmt: skip
@pytest.mark.parametrize("at", [0.0, 4.0])
def test_equal_to_solving_at_every_frequency(model, at):
    f = np.concatenate([np.geomspace(0.05, 80, 200), [m.frequency_hz for m in modes(model)]])
    found = track_response(model, [model.floor(at, "polygon")], V, f)[0]
    expected = directly(model, V, f, at)
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


def test_equal_for_changed_parameters_and_other_derivatives():
    model, f = paper_coach(4), np.array([0.3, 2.0, 11.0])
    for derivative in (0, 1, 2):
        found = track_response(model, [model.floor(1.0, "polygon", derivative)], V, f, k_2=5e5)[0]
        expected = directly(model, V, f, 1.0, derivative, k_2=5e5)
        np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_solution_with_repeated_poles():
    """Two equal bogies on a body that is too heavy to join them."""
    m = paper_coach(1).matrices(m_c=1e15, I_c=1e17)
    omega = np.array([5.0, 60.0])
    force = np.ones((6, 2), dtype=complex)
    found = solve_at(m, omega, force)
    for k, w in enumerate(omega):
        expected = np.linalg.solve(m.K - w**2 * m.M + 1j * w * m.C, force[:, k])
        assert np.abs(found[:, k] - expected).max() < 1e-9 * np.abs(expected).max()


def test_delays_are_distances_over_speed():
    np.testing.assert_allclose(wheelset_delays(paper_coach(2), 145 / 3.6),
                               np.array([0, 2.5, 17.5, 20.0]) * 3.6 / 145, rtol=1e-14)  # fmt: skip


ZEROS = [(k + 0.5) * V / distance for distance in (17.5, 2.5) for k in range(4)]


@pytest.mark.parametrize("segments", [1, 2, 4, 5])
def test_geometric_zeros_at_the_middle_of_a_symmetric_coach(segments):
    """Front and rear in opposition: (k + ½) V/(bogie spacing) and (k + ½) V/wheelbase."""
    model = paper_coach(segments)
    for floor in ("smooth", "polygon"):
        H = np.abs(track_response(model, [model.floor(0.0, floor, 0)], V, ZEROS))[0]
        around = np.abs(track_response(model, [model.floor(0.0, floor, 0)], V,
                                       np.array(ZEROS) * 1.03))[0]  # fmt: skip
        assert (1e-8 * around > H).all()


def test_the_first_zeros_at_200_kmh():
    assert f"{ZEROS[0]:.3f}" == "1.587"
    assert f"{ZEROS[4]:.2f}" == "11.11"


def test_no_zeros_at_whole_multiples():
    """Front and rear in step: nothing cancels."""
    model, whole = paper_coach(4), np.array([V / 17.5, 2 * V / 17.5, V / 2.5])
    height = [model.floor(0.0, derivative=0)]
    H = np.abs(track_response(model, height, V, whole))[0]
    beside = np.abs(track_response(model, height, V, whole * 1.05))[0]
    assert (0.5 * beside < H).all()


def test_off_the_middle_the_bogie_spacing_leaves_dips_only():
    """Pitch and bending 2 fill the zeros of the middle; those of the wheelbase stay."""
    model = paper_coach(4)
    height, spacing, wheelbase = [model.floor(4.0, derivative=0)], ZEROS[:3], ZEROS[4:]
    assert (np.abs(track_response(model, height, V, spacing)) > 0.03).all()
    assert (np.abs(track_response(model, height, V, wheelbase)) < 1e-12).all()


@pytest.mark.parametrize("segments", [1, 4])
@pytest.mark.parametrize("at", [-6.0, 0.0, 6.0])
def test_slow_waves_are_followed(segments, at):
    """Long waves: z(t) = w(x + V t), and the acceleration is -ω² of it."""
    model, f = random_model(1, segments), np.array([1e-4, 1e-3])
    omega = 2 * np.pi * f
    ahead = (at - model.vehicle.wheelset_positions[0]) / V
    for floor in ("smooth", "polygon"):
        H = track_response(model, [model.floor(at, floor), model.floor(at, floor, 0)], V, f)
        np.testing.assert_allclose(H[1] * np.exp(-1j * omega * ahead), 1.0, atol=2e-4)
        np.testing.assert_allclose(H[0], -(omega**2) * H[1], rtol=1e-9)


def test_the_suspension_isolates_above_its_frequencies():
    model = paper_coach(4)
    H = np.abs(track_response(model, [model.floor(0.0, derivative=0)], V, [200.0, 400.0]))[0]
    assert H.max() < 1e-2


@pytest.mark.parametrize("seed", range(3))
def test_a_mirrored_vehicle_answers_mirrored(seed):
    """Wheelset by wheelset, mirrored points answer alike."""
    model = random_model(seed, 4)
    other = derive_vehicle(mirrored(model.vehicle), 4)
    omega = 2 * np.pi * 7.7
    sides = []
    for one, at in ((model, 5.0), (other, -5.0)):
        m = one.matrices()
        row = one.output_rows([one.floor(at, "smooth", 0)])["d"][0]
        sides.append(row @ np.linalg.solve(m.K - omega**2 * m.M + 1j * omega * m.C,
                                           m.K_w + 1j * omega * m.C_w))  # fmt: skip
    np.testing.assert_allclose(sides[0], sides[1][::-1], rtol=1e-7)


def test_a_symmetric_coach_feels_the_same_before_and_behind_a_symmetric_track():
    """Track waves in phase under mirrored wheelsets move mirrored points alike."""
    m = paper_coach(4).matrices()
    model, omega = paper_coach(4), 2 * np.pi * 9.0
    rows = model.output_rows([model.floor(x, derivative=0) for x in (6.5, -6.5)])["d"]
    H = rows @ np.linalg.solve(m.K - omega**2 * m.M + 1j * omega * m.C, m.K_w + 1j * omega * m.C_w)
    np.testing.assert_allclose(H[0], H[1][::-1], rtol=1e-9)


@pytest.mark.parametrize("speed", [0.0, -40.0, np.nan, np.inf])
def test_speeds_that_are_none_are_refused(speed):
    with pytest.raises(InputError, match="speed"):
        track_response(paper_coach(1), [paper_coach(1).floor()], speed, [1.0])


def test_shapes():
    model = paper_coach(2)
    named = [model.outputs["bogie_1_acceleration"], model.outputs["primary_2_deflection"]]
    outputs = [model.floor(), *named]
    H = track_response(model, outputs, V, np.linspace(1, 5, 7))
    assert H.shape == (3, 7)
    assert np.iscomplexobj(H)


def test_primary_deflection_vanishes_on_a_slow_wave():
    model = paper_coach(2)
    H = track_response(model, [model.outputs["primary_3_deflection"]], V, [1e-3])
    assert np.abs(H).max() < 1e-4
