"""Laws that hold for every vehicle that there can be, from its matrices to its comfort."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st
from hypothesis.strategies import floats, integers
from numpy.testing import assert_allclose
from strategies import in_units, vehicles
from vehicles import mirrored

from railride.firstorder import first_order
from railride.frequency import responses
from railride.modal import modes, undamped_frequencies
from railride.parameters import write_vehicle
from railride.response import simulate
from railride.rides import ride
from railride.spectra import spectrum, temporal
from railride.statespace import system_arrays
from railride.stochastic import stochastic_ride
from railride.track import synthesise
from railride.vehicle import derive_vehicle
from railride.weightings import weighting

few = settings(max_examples=6, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
random_vehicles = given(vehicles())
FREQUENCIES = np.array([0.31, 1.7, 6.3, 17.9, 39.0])
SPEEDS = floats(20, 70)


def derived(drawn):
    vehicle, options = drawn
    return derive_vehicle(vehicle, **options)


def half_length(model):
    return model.vehicle.body.length / 2


def size(A):
    return np.abs(A).max(initial=1e-300)


# Matrices


@few
@random_vehicles
def test_matrices_have_the_form_of_masses_springs_and_dampers(drawn):
    model = derived(drawn)
    m = model.matrices()
    inertial = m.inertial
    for A in (m.M, m.C, m.K):
        assert_allclose(A, A.T, rtol=0, atol=1e-12 * size(A))
        scale = np.sqrt(np.maximum(np.diag(A), 1e-300))
        assert np.linalg.eigvalsh(A / np.outer(scale, scale)).min() > -1e-10
    assert np.linalg.eigvalsh(m.M[np.ix_(inertial, inertial)]).min() > 0
    vehicle = model.vehicle
    parts = (vehicle.body, *vehicle.bogies, *vehicle.payload, *vehicle.equipment)
    assert m.lift @ m.M @ m.lift == pytest.approx(sum(part.mass for part in parts), rel=1e-9)
    places = np.array(vehicle.wheelset_positions)
    for A, A_w in ((m.K, m.K_w), (m.C, m.C_w)):
        for motion, under in ((m.lift, np.ones_like(places)), (model.pitch(), places)):
            assert np.abs(A @ motion - A_w @ under).max() < 1e-9 * size(A) * size(under)


@few
@given(vehicles(), st.tuples(floats(0.2, 5), floats(0.2, 5), floats(0.2, 5)), SPEEDS)
def test_units_of_mass_length_and_time_change_nothing(drawn, units, speed):
    """In units that are μ, λ and τ times as large; the response, 1/s², is 1/τ⁻² times as large."""
    (vehicle, options), (_, metre, second) = drawn, units
    here = derive_vehicle(vehicle, **options)
    there = derive_vehicle(in_units(vehicle, units), **options)
    x = 0.3 * half_length(here)
    H = responses(here, here.floor(x), ["track"], FREQUENCIES, speed=speed)[0, 0]
    other = responses(there, there.floor(x / metre), ["track"], FREQUENCIES * second,
                      speed=speed * second / metre)[0, 0]  # fmt: skip
    assert_allclose(other / second**2, H, rtol=0, atol=1e-7 * size(H))


# Modes


@few
@random_vehicles
def test_modes_solve_the_equations_of_motion(drawn):
    model = derived(drawn)
    m, found = model.matrices(), modes(model)
    for mode in found:
        s, shape = mode.eigenvalue, mode.shape
        assert s.real < 0
        terms = (s**2 * m.M @ shape, s * m.C @ shape, m.K @ shape)
        assert np.abs(sum(terms)).max() < 1e-6 * max(size(term) for term in terms)
        assert mode.frequency_hz == pytest.approx(abs(s) / (2 * np.pi))
        assert mode.damping_ratio == pytest.approx(-s.real / abs(s))
        assert 0 < mode.damping_ratio <= 1
        assert 0 <= mode.share <= 1 + 1e-9
    frequencies = [mode.frequency_hz for mode in found]
    assert frequencies == sorted(frequencies)
    states = sum(1 if mode.eigenvalue.imag == 0 else 2 for mode in found)
    assert states == 2 * np.count_nonzero(m.inertial) + np.count_nonzero(~m.inertial)
    if m.inertial.all():  # the trace of x' = A x
        total = sum(
            (1 if mode.eigenvalue.imag == 0 else 2) * mode.eigenvalue.real for mode in found
        )
        assert total == pytest.approx(-np.trace(np.linalg.solve(m.M, m.C)), rel=1e-7)


@few
@given(vehicles(damped=False))
def test_without_dampers_modes_are_those_of_mass_and_stiffness(drawn):
    model = derived(drawn)
    m, found = model.matrices(), modes(model)
    assert not m.C.any()
    squares = scipy.linalg.eigh(m.K, m.M, eigvals_only=True)
    expected = np.sqrt(squares) / (2 * np.pi)
    assert len(found) == len(expected)
    assert_allclose([mode.frequency_hz for mode in found], expected, rtol=1e-7)
    assert_allclose(undamped_frequencies(m), expected, rtol=1e-9)
    assert max(abs(mode.damping_ratio) for mode in found) < 1e-6


# Frequency response


@few
@given(vehicles(), SPEEDS, floats(-1, 1))
def test_the_response_solves_the_equations_of_motion(drawn, speed, place):
    """By a dense solve of every frequency; towards 0 Hz vehicle and track move as one."""
    model = derived(drawn)
    x, m = place * half_length(model), model.matrices()
    places = np.array(model.vehicle.wheelset_positions)
    row = model.output_rows([model.floor(x, derivative=0)])["d"][0]
    height, acceleration = responses(
        model, [model.floor(x, derivative=0), model.floor(x)], ["track"], FREQUENCIES, speed=speed
    )[:, 0]
    for k, s in enumerate(2j * np.pi * FREQUENCIES):
        w = np.exp(-s * (places[0] - places) / speed)
        q = np.linalg.solve(m.K + s * m.C + s**2 * m.M, (m.K_w + s * m.C_w) @ w)
        scale = np.abs(row) @ np.abs(q)
        assert abs(height[k] - row @ q) < 1e-8 * scale
        assert abs(acceleration[k] - s**2 * (row @ q)) < 1e-8 * scale * abs(s) ** 2
    f = 1e-5
    (still,) = responses(model, model.floor(x), ["track"], [f], speed=speed)[0, 0]
    assert still / (2j * np.pi * f) ** 2 == pytest.approx(1, abs=1e-3)


@few
@given(vehicles(), floats(-1, 1), floats(-1, 1))
def test_the_mirror_image_moves_as_the_vehicle_does(drawn, place, force):
    """Each wheelset and actuator moves a point as its mirror image moves the point's."""
    vehicle, options = drawn
    here, there = (derive_vehicle(v, **options) for v in (vehicle, mirrored(vehicle)))
    x = place * half_length(here)
    sources = [s.name for s in (*here.lagrangian.inputs, *here.lagrangian.forces)]
    wheelsets, bogies = len(here.lagrangian.inputs), len(vehicle.bogies)
    turned = [*range(wheelsets)[::-1], *(wheelsets + b for b in range(bogies)[::-1])]
    H = responses(here, here.floor(x), sources, FREQUENCIES)[0]
    other = responses(there, there.floor(-x), sources, FREQUENCIES)[0][turned]
    for of in (slice(None, wheelsets), slice(wheelsets, None)):
        assert_allclose(other[of], H[of], rtol=0, atol=1e-6 * size(H[of]))
    # A force at a moves b as much as the same force at b moves a.
    m, points = here.matrices(), [x, force * half_length(here)]
    rows = here.output_rows([here.floor(p, "polygon", 0) for p in points])["d"]
    s = 2j * np.pi * 3.0
    moved = rows @ np.linalg.solve(m.K + s * m.C + s**2 * m.M, rows.T)
    assert abs(moved[0, 1] - moved[1, 0]) < 1e-9 * size(moved)


# Rides


@few
@given(vehicles(), SPEEDS, floats(1, 6), floats(0, 2 * np.pi))
def test_over_a_wave_the_time_response_is_the_frequency_response(drawn, speed, f, phase):
    """From the steady state, q = Re(q̂ e^{iωt}), which it never leaves."""
    model = derived(drawn)
    at = [model.floor(0.0), model.floor(0.7 * half_length(model))]
    m, system = model.matrices(), system_arrays(model, at)
    places, s, time = (
        np.array(model.vehicle.wheelset_positions),
        2j * np.pi * f,
        np.arange(2001) / 1e3,
    )
    w = np.exp(1j * phase - s * (places[0] - places) / speed)
    q = np.linalg.solve(m.K + s * m.C + s**2 * m.M, (m.K_w + s * m.C_w) @ w)
    wave = np.real(np.concatenate([w, s * w])[:, np.newaxis] * np.exp(s * time))
    x0 = first_order(m).state(q.real, (s * q).real)
    found = simulate(system.A, system.B[:, : len(wave)], system.C, system.D[:, : len(wave)], wave,
                     1e-3, x0).outputs  # fmt: skip
    H = responses(model, at, ["track"], [f], speed=speed)[:, 0]
    expected = np.real(H * np.exp(1j * phase + s * time))
    # A straight line from sample to sample is off by (ω dt)²/8, felt more by higher modes.
    assert_allclose(found, expected, rtol=0, atol=3 * size(expected) * abs(s * 1e-3) ** 2)


@few
@given(vehicles(), SPEEDS, floats(-1, 1), integers(0, 2**32 - 1), floats(0.1, 10))
def test_indices_of_a_ride_keep_their_bounds(drawn, speed, place, seed, times):
    """Twice the track is twice the ride; no mean is above its peak; the run is one sample."""
    model = derived(drawn)
    x = place * half_length(model)
    track = synthesise("erri_low", 16 * speed + 1500, 0.25, seed)
    rides = [ride(model, road, speed, at=x, length=16.0001 * speed)
             for road in (track, replace(track, level=times * track.level))]  # fmt: skip
    one, other = (found.cases[0] for found in rides)
    for name, power in {"a_rms": 1, "a_wrms": 1, "mtvv": 1, "mtvv_exp": 1, "vdv": 1,
                        "crest_factor": 0, "wz": 0.3}.items():  # fmt: skip
        here, there = getattr(one, name), getattr(other, name)
        assert math.isfinite(here)
        assert there == pytest.approx(here * times**power, rel=1e-7), name
    assert abs(one.a_wrms - one.a_wrms_exact) < 4 * one.standard_error
    gain = np.abs(weighting("Wk").response(np.geomspace(0.05, 80, 500))).max()
    samples = np.sqrt(np.mean(one.record.acceleration[one.record.rated] ** 2))
    assert one.a_rms <= samples * 1.02  # what is beyond 0.05 to 80 Hz is not in it
    assert one.a_wrms <= gain * samples * 1.02
    peak, seconds = one.crest_factor * one.a_wrms, 16.0
    assert one.crest_factor >= 1
    # Sixteen windows of a second fill the section: none is above the largest.
    assert one.a_wrms * (1 - 1e-3) <= one.mtvv <= peak * (1 + 1e-9)
    mean = seconds**0.25 * one.a_wrms
    assert mean * (1 - 1e-3) <= one.vdv <= mean * np.sqrt(one.crest_factor) * (1 + 1e-3)
    thresholds = (0.2, 0.3, 0.4, 0.6)  # the paper's Table 3
    words = (
        "very comfortable",
        "comfortable",
        "medium",
        "little comfortable",
        "fairly comfortable",
    )
    assert one.level == words[sum(one.a_wrms >= limit for limit in thresholds)]


@few
@given(vehicles(), SPEEDS, floats(-1, 1))
def test_the_exact_value_is_the_integral_over_the_response(drawn, speed, place):
    """By Gauss's rule on pieces that shrink towards every natural frequency, down to ζf."""
    model = derived(drawn)
    x = place * half_length(model)
    found = stochastic_ride(model, speed, "erri_low", [x])
    edges = [np.geomspace(0.05, 80, 200)]
    for mode in modes(model):
        width = max(mode.damping_ratio, 1e-7) * 2.0 ** np.arange(-1, 25)
        edges += [mode.frequency_hz * (1 + width), mode.frequency_hz * (1 - width)]
    edges = np.unique(np.clip(np.concatenate(edges), 0.05, 80))
    points, weights = np.polynomial.legendre.leggauss(8)
    half = np.diff(edges)[:, np.newaxis] / 2
    f = (edges[:-1, np.newaxis] + half * (1 + points)).ravel()
    H = responses(model, model.floor(x), ["track"], f, speed=speed)[0, 0]
    density = np.abs(H) ** 2 * temporal(spectrum("erri_low"), speed)(f)
    gain = np.abs(weighting("Wk").response(f))
    for value, power in ((found.a_rms, 1.0), (found.a_wrms, gain**2)):
        expected = np.sqrt((density * power) @ (half * weights).ravel())
        assert float(value[0]) == pytest.approx(expected, rel=1e-5)
    assert float(found.a_wrms[0]) <= gain.max() * float(found.a_rms[0])


# Commands


@settings(few, max_examples=3)
@given(vehicles(), SPEEDS)
def test_commands_give_finite_numbers_and_those_of_the_calls(tmp_path_factory, drawn, speed):
    vehicle, options = drawn
    folder = tmp_path_factory.mktemp("command")
    write_vehicle(vehicle, folder / "vehicle.toml")
    model = derive_vehicle(vehicle, **options)
    words = [word for name, value in options.items() for word in (f"--{name}", value)]

    def call(command, *more):
        return answer(folder, command, "--vehicle", folder / "vehicle.toml", *words, *more)

    found = call("modes")
    assert [m["frequency_hz"] for m in found["modes"]] == pytest.approx(
        [m.frequency_hz for m in modes(model)]
    )
    np.testing.assert_array_equal(call("derive")["K"], model.matrices().K)
    kmh = repr(3.6 * speed)
    listed = call("bode", "--speed", kmh, "--frequencies", "0.5,3,9.6")["response"]
    H = responses(model, model.floor(), ["track"], [0.5, 3, 9.6], speed=float(kmh) / 3.6)[0, 0]
    assert [one["magnitude"] for one in listed] == pytest.approx(np.abs(H), rel=1e-9)
    assert all(-180 < one["phase_deg"] <= 180 for one in listed)
    (case,) = call("ride", "--speed", kmh, "--spectral")["cases"]
    exact = stochastic_ride(model, float(kmh) / 3.6, "erri_low")
    assert case["a_wrms"] == pytest.approx(float(exact.a_wrms[0]), rel=1e-9)


def answer(folder, *arguments):
    """The JSON of a command, refused where it holds what is no number."""
    from railride.cli import main

    def refuse(constant):
        raise AssertionError(constant)

    place = folder / "result.json"
    with pytest.raises(SystemExit) as stopped:
        main([str(a) for a in (*arguments, "--format", "json", "--output", place)])
    assert not stopped.value.code
    return json.loads(place.read_text(encoding="utf-8"), parse_constant=refuse)
