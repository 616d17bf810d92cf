"""The response to the track against a direct solution, geometry and limits."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest
from vehicles import assemble, mirrored, paper_coach, random_model

from railride.errors import InputError
from railride.frequency import (
    frequency_response,
    responses,
    track_response,
    triangular,
    wheelset_delays,
)
from railride.lagrange import rate
from railride.modal import modes
from railride.running_gear import primary_deflection
from railride.statespace import state_space
from railride.vehicle import Output, derive_vehicle

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


def in_40_digits(model, speed, f, at):
    """The same with mpmath, from the same matrices."""
    m, x = model.matrices(), model.vehicle.wheelset_positions
    row = model.output_rows([model.floor(at, "polygon", 0)])["d"][0]
    with mpmath.workdps(40):
        s = 2j * mpmath.pi * mpmath.mpf(f)
        A = s**2 * mpmath.matrix(m.M) + s * mpmath.matrix(m.C) + mpmath.matrix(m.K)
        delays = [(mpmath.mpf(x[0]) - mpmath.mpf(place)) / mpmath.mpf(speed) for place in x]
        w = mpmath.matrix([mpmath.exp(-s * delay) for delay in delays])
        q = mpmath.lu_solve(A, (mpmath.matrix(m.K_w) + s * mpmath.matrix(m.C_w)) * w)
        return complex(s**2 * (mpmath.matrix([row.tolist()]) * q)[0])


def test_beside_a_pole_with_next_to_no_damping():
    """Bending 2 of the paper's coach (damping ratio 2e-6), where it moves most."""
    model = paper_coach(4)
    mode = next(m for m in modes(model) if m.label == "bending 2")
    line = mode.eigenvalue.imag / (2 * np.pi)
    for f in line * (1 + mode.damping_ratio * np.array([0.0, 1.0, -30.0, 3000.0])):
        found = track_response(model, [model.floor(12.0, "polygon")], V, [f])[0, 0]
        assert abs(found / in_40_digits(model, V, f, 12.0) - 1) < 1e-10


def test_on_the_line_of_an_undamped_mode_there_is_no_response():
    model = paper_coach(4).changed(c_1=0.0, c_2=0.0)
    for mode in modes(model):
        f = mode.frequency_hz
        with pytest.raises(InputError, match=rf"found {f:.6g} Hz, where a mode without damping"):
            frequency_response(model, frequency=[0.5, f], speed=V)
        beside = f * (1 + 1e-6)
        found = track_response(model, [model.floor(3.0, "polygon")], V, [beside])[0, 0]
        assert abs(found / in_40_digits(model, V, beside, 3.0) - 1) < 1e-8


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
    found = triangular(m).solve(omega, force)
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


# single sources, names, python-control


def by_hand(model, f):
    """The car body's height at 4 m to every w and f, from matrices assembled without energies."""
    values = model.values()
    m = assemble(model.vehicle, model.body.segments, *(float(values[k]) for k in
                                                       ("k_theta", "c_theta")))  # fmt: skip
    omega = 2 * np.pi * f
    columns = np.hstack([m.K_w + 1j * omega * m.C_w, m.B_f])
    return m.height(4.0) @ np.linalg.solve(m.K - omega**2 * m.M + 1j * omega * m.C, columns)


@pytest.mark.parametrize("seed", range(3))
def test_every_single_source_against_matrices_assembled_by_hand(seed):
    model = random_model(seed, 3)
    sources = [s.name for s in (*model.lagrangian.inputs, *model.lagrangian.forces)]
    f = np.array([0.7, 3.3, 9.1, 30.0])
    found = responses(model, [model.floor(4.0, "polygon", 0)], sources, f)[0]
    expected = np.array([by_hand(model, x) for x in f]).T
    scale = np.abs(expected).max(axis=1, keepdims=True)
    assert (np.abs(found - expected) < 1e-9 * scale).all()


def test_the_track_is_its_wheelsets_one_after_another():
    model, f = random_model(1, 4), np.geomspace(0.2, 40, 50)
    wheelsets = [w.name for w in model.lagrangian.inputs]
    each = responses(model, None, wheelsets, f)[0]
    e = np.exp(-2j * np.pi * np.outer(wheelset_delays(model, V), f))
    np.testing.assert_allclose(track_response(model, [model.floor()], V, f)[0], (each * e).sum(0),
                               rtol=1e-9)  # fmt: skip


@pytest.mark.parametrize("segments", [1, 4])
@pytest.mark.parametrize("seed", range(3))
def test_receptances_are_reciprocal(seed, segments):
    """A force between body and bogie 1 extends suspension b as a force there extends 1."""
    model = random_model(seed, segments)
    bogies = range(1, len(model.vehicle.bogies) + 1)
    G = responses(model, [f"secondary_{b}_deflection" for b in bogies],
                  [f"f_{b}" for b in bogies], np.geomspace(0.1, 80, 40))  # fmt: skip
    assert np.abs(G - G.swapaxes(0, 1)).max() < 1e-12 * np.abs(G).max()
    assert np.abs(G[0, 1]).max() > 1e-3 * np.abs(G).max()


def test_an_actuator_on_a_rigid_coach_moves_masses_alone_at_high_frequency():
    """z̈ over the middle per force on bogie 1 tends to 1/m_c, and the bogie's to -1/m_b."""
    model = paper_coach(1)
    found = responses(model, [model.floor(), model.outputs["bogie_1_acceleration"]], ["f_1"], [1e5])
    np.testing.assert_allclose(found[:, 0, 0], [1 / 34000, -1 / 3000], rtol=1e-3)


def test_what_is_felt_directly():
    """Rates are iω times what they are rates of; an input's own second rate, and a force itself."""
    model, f = paper_coach(2), np.array([0.5, 7.0, 40.0])
    s = 2j * np.pi * f
    extension = primary_deflection(1)
    w, force = model.lagrangian.inputs[0], model.lagrangian.forces[1]
    outputs = [Output(f"x{k}", expression, "", "") for k, expression in
               enumerate([extension, rate(extension), w.ddot, force])]  # fmt: skip
    H = responses(model, outputs, ["w_1", "f_2"], f)
    np.testing.assert_allclose(H[1], s * H[0], rtol=1e-9)
    np.testing.assert_allclose(H[2], [s**2, 0 * s], rtol=1e-12)
    np.testing.assert_allclose(H[3], [0 * s, 1 + 0 * s], rtol=1e-12)


def test_many_frequencies_are_the_same_as_few():
    """Worked off in pieces: what stands at a border is as right as the rest."""
    model, f = paper_coach(2), np.geomspace(0.1, 80, 2501)
    some = [0, 1, 999, 1000, 1001, 1999, 2000, 2500]
    floor = [model.floor(0.0, "polygon")]
    every = track_response(model, floor, V, f)[0]
    assert (
        np.abs(every[some] - directly(model, V, f[some], 0.0)) < 1e-9 * np.abs(every)[some]
    ).all()


def test_as_python_control_has_it():
    """The state space at the same frequencies, delays put in by hand."""
    model, f = paper_coach(4), np.array([0.5, 2.0, 9.6, 21.0])
    response = frequency_response(model, ["floor_acceleration", "bogie_1_acceleration"], f, speed=V)
    assert response.input_labels == ["track"]
    assert response.output_labels == ["floor_acceleration", "bogie_1_acceleration"]
    np.testing.assert_allclose(response.omega, 2 * np.pi * f)
    plant = state_space(model, ["floor_acceleration", "bogie_1_acceleration"])
    s = 2j * np.pi * f
    e = np.exp(-np.outer(wheelset_delays(model, V), s))
    expected = np.einsum("kjf,jf->kf", plant(s)[:, :8], np.vstack([e, s * e]))
    np.testing.assert_allclose(response.frdata[:, 0], expected, rtol=1e-9)


def test_many_sources_and_outputs_keep_their_names():
    names = ["secondary_2_deflection", "bogie_1_acceleration"]
    response = frequency_response(paper_coach(2), names, [1.0, 3.0], speed=V,
                                  source=["w_2", "track", "f_1"])  # fmt: skip
    assert response.frdata.shape == (2, 3, 2)
    alone = frequency_response(paper_coach(2), names[:1], [1.0, 3.0], source="f_1")
    np.testing.assert_allclose(
        response["secondary_2_deflection", "f_1"].frdata, alone.frdata, rtol=1e-12
    )


def test_python_control_plots_it():
    import control
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    mpl.use("Agg")
    response = frequency_response(paper_coach(2), speed=V)
    assert response.omega.size == 2000
    drawn = control.bode_plot(response, Hz=True, dB=True)
    line = drawn.lines[0, 0][0]
    f = response.omega / (2 * np.pi)
    np.testing.assert_allclose(line.get_xdata(), f)
    np.testing.assert_allclose(line.get_ydata(), 20 * np.log10(np.abs(response.frdata[0, 0])))
    control.nichols_plot(response)
    plt.close("all")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"frequency": [1.0, 0.0]}, "0 Hz.*above zero"),
        ({"frequency": [-1.0]}, "-1 Hz.*above zero"),
        ({"frequency": [1.0, np.nan]}, "nan Hz"),
        ({"frequency": [1.0, np.inf]}, "inf Hz"),
        ({"frequency": []}, "expected a list of"),
        ({"frequency": [[1.0]]}, "shape"),
        ({"frequency": "fast"}, "expected numbers"),
        ({"frequency": [2.0, 1.0]}, "1 Hz after 2 Hz.*ascending"),
        ({"frequency": [2.0, 2.0]}, "2 Hz after 2 Hz.*each once"),
        ({"speed": 0.0}, "speed"),
        ({"speed": "fast"}, "speed: found 'fast'; expected a finite speed above zero"),
        ({"speed": None}, "speed: found none"),
        ({"source": "w_9"}, "found 'w_9'.*track, w_1, w_2, w_3, w_4, f_1, f_2"),
        ({"source": ["f_1", "f_1"]}, "source: found f_1, f_1.*none twice"),
        ({"source": []}, "source: found none"),
        ({"source": 3}, "source: found 3; expected at least one name"),
        ({"outputs": 5}, "outputs: found 5; expected at least one name"),
        ({"outputs": ["floor"]}, "found 'floor'.*floor_acceleration, bogie_1_acceleration"),
        ({"outputs": []}, "found none"),
        ({"c_2": -1e5}, "c_2|unstable"),
    ],
)
def test_bad_input_is_refused(given, message):
    arguments = {"frequency": [1.0, 2.0], "speed": V} | given
    with pytest.raises(InputError, match=message):
        frequency_response(paper_coach(2), **arguments)


def test_one_output_needs_no_list():
    model, name = paper_coach(2), "secondary_1_deflection"
    H = frequency_response(model, [name], [1.0, 2.0], speed=V)
    for one in (name, model.outputs[name]):
        found = frequency_response(model, one, [1.0, 2.0], speed=V)
        assert found.output_labels == H.output_labels
        np.testing.assert_array_equal(found.frdata, H.frdata)
        np.testing.assert_array_equal(track_response(model, one, V, [1.0, 2.0]), H.frdata[:, 0])
    assert state_space(model, name).output_labels == [name]
    with pytest.raises(InputError, match="found 'floor'"):
        frequency_response(model, "floor", [1.0], speed=V)


def test_an_unstable_vehicle_has_no_frequency_response():
    m = paper_coach(2).matrices()
    with pytest.raises(InputError, match="unstable"):
        triangular(replace(m, C=-0.1 * m.C, C_w=-0.1 * m.C_w))


def test_the_response_at_a_deep_zero_is_rounding_alone():
    """1.587 Hz of the paper's coach at 200 km/h: nothing passes to the middle, by 1e-10."""
    zero = V / 17.5 / 2
    for segments in (1, 4, 8):
        model = paper_coach(segments)
        H = np.abs(track_response(model, [model.floor()], V, [zero, 2 * zero]))[0]
        assert H[0] < 1e-9 * H[1]
