"""The Modelica package, compiled and solved by rumoca: the model is the one it was made from."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from control import forced_response
from export_cases import changed, content, every_body, independent
from rumoca_peer import compiled, driven, simulated
from vehicles import paper_coach, random_vehicle

from railride import (
    KMH,
    InputError,
    Track,
    derive_vehicle,
    export_model,
    simulate,
    weighting,
)
from railride.exports.as_modelica import written
from railride.exports.content import content_of
from railride.exports.modelica import NAMES, unit
from railride.exports.setup import ride_setup
from railride.frequency import wheelset_delays
from railride.ridden import ridden_track
from railride.timerun import following, time_run
from railride.trackfile import load_track


def package(text):
    return re.search(r"^package (\w+)", text, re.MULTILINE)[1]


@every_body
def test_same_inputs_same_outputs(kind):
    """Every output of a run over 0.1 s of noise, linear between samples of 1 ms, to 1e-6.

    Of the vehicle, and with every parameter changed.
    """
    rng, dt, count = np.random.default_rng(7), 1e-3, 101
    size = {"m": 1e-4, "m/s": 1e-4, "N": 10.0}
    inputs = (*content(kind).elevations, *content(kind).rates, *content(kind).forces)
    u = {s.name: size[s.unit] * np.cumsum(rng.standard_normal(count)) for s in inputs}
    text = driven(written(content(kind)), u, dt)
    model = compiled(text, f"{package(text)}.Driven")
    for own in (content(kind), changed(kind)):
        values = {f"coach.{NAMES.written(n)}": value for n, value in independent(own).items()}
        _, found = simulated(model.with_params(**values), (count - 1) * dt, dt)
        s = own.system
        expected = simulate(s.A, s.B, s.C, s.D, np.array(list(u.values())), dt).outputs
        for output, y in zip(own.outputs, expected, strict=True):
            difference = found[f"coach.{NAMES.written(output.name)}"] - y
            assert np.abs(difference).max() < 1e-6 * np.abs(y).max(), output.name


@every_body
def test_names_units_and_meanings_are_those_of_the_model(kind):
    own = content(kind)
    text = written(own)
    model = compiled(text, f"{package(text)}.Coach")
    inputs = (*own.elevations, *own.rates, *own.forces)
    assert [NAMES.original(name) for name in model.inputs.names] == [u.name for u in inputs]
    assert [NAMES.original(name) for name in model.outputs.names] == [o.name for o in own.outputs]
    parameters = {NAMES.original(p.name): p for p in model.parameters}
    assert set(parameters) == {p.name for p in own.parameters}
    for p in own.parameters:
        assert parameters[p.name].unit == unit(p.unit)
        assert (parameters[p.name].description or "") == p.meaning
        if p.definition is None:
            assert parameters[p.name].value == p.value
    units = {q.name: unit(q.unit) for q in own.coordinates}
    states = {NAMES.original(name): name for name in model.states.names}
    assert all(model.states[states[name]].unit == of for name, of in units.items())


def test_any_name_of_a_vehicle_makes_a_package():
    vehicle = replace(random_vehicle(1), name='2nd "coach" \\ №1')
    text = written(content_of(derive_vehicle(vehicle, 2)))
    assert NAMES.original(package(text)) == vehicle.name
    assert compiled(text, f"{package(text)}.Coach").structure().is_balanced


def test_the_page_of_the_manual_shows_the_package():
    page = Path(__file__).parents[1] / "docs" / "exports.md"
    shown = re.search(r"```modelica\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)[1]
    lines = [line.strip() for line in written(content_of(paper_coach(2))).splitlines()]
    assert [line for line in shown.splitlines() if line.strip() not in lines] == []


def test_every_line_of_a_ride_fits(line):
    text = written(content("segments"), ride_setup(content("segments"), line, 40.0, length=10.0))
    assert max(len(line) for line in text.splitlines()) <= 100


def test_the_package_tells_what_was_done_to_the_track(line, tmp_path):
    file = tmp_path / "ride.mo"
    remarks = export_model(paper_coach(2), "modelica", file, track=line, speed=40.0, length=10.0)
    for said in ("three waves begins with a", "rated are the last 10 m of three waves",
                 "three waves can be trusted from"):  # fmt: skip
        assert any(said in remark for remark in remarks)
    text = re.sub(r"\n  // ", " ", file.read_text(encoding="utf-8"))
    assert all(f"Remark: {remark}" in text for remark in remarks)


def test_two_seconds_and_a_half_on_the_samples_of_a_track():
    """145 km/h over ERRI low, w and ẇ linear between samples of 1 ms, to 1e-6."""
    model, speed, dt = paper_coach(4), 145 * KMH, 1e-3
    own = content_of(model, at=[0.0, 5.0])
    road, times = ridden_track(load_track("erri_low"), [speed], 200.0, 3), dt * np.arange(2501)
    behind = speed * wheelset_delays(model, speed)
    w, slope = road.elevation(road.distance0 + 30.0 - behind[:, None] + speed * times)
    u = {q.name: z for q, z in zip(own.inputs, [*w, *(speed * slope)], strict=False)}
    idle = [f.name for f in own.forces]
    text = driven(written(own), u, dt, idle)
    _, found = simulated(compiled(text, f"{package(text)}.Driven"), times[-1], dt)
    s = own.system
    wheels = slice(0, 2 * len(own.elevations))
    expected = simulate(s.A, s.B[:, wheels], s.C, s.D[:, wheels], np.array(list(u.values())), dt)
    for output, y in zip(own.outputs, expected.outputs, strict=True):
        difference = found[f"coach.{NAMES.written(output.name)}"] - y
        assert np.abs(difference).max() < 1e-6 * np.abs(y).max(), output.name


@pytest.fixture(scope="module")
def line():
    x = np.arange(0.0, 60.0, 0.25)
    level = 1e-3 * (np.sin(0.9 * x) + 0.4 * np.sin(2.1 * x + 1.0) + 0.1 * np.cos(4.0 * x))
    return Track(10.0, 0.25, level, name="three waves")


def test_the_ride_is_railrides_own(line):
    """The whole set-up: acceleration, which differs by railride's own step squared, and a_wrms."""
    model, speed, length = derive_vehicle("cati2024", 2, bending_damping=0.02), 145 * KMH, 10.0
    setup = ride_setup(content_of(model, at=[0.0]), line, speed, length=length)
    text = written(content_of(model, "floor_acceleration"), setup)
    dt = 1e-3
    steps = int(setup.duration / dt)
    time, found = simulated(compiled(text, f"{package(text)}.Ride"), steps * dt, dt, rtol=1e-9)
    errors = []
    for rate in (4000.0, 16000.0):
        run = time_run(model, speed, line, [0.0], length=length, floor="smooth",
                       weight=weighting("Wk"), rate=rate)  # fmt: skip
        own = np.interp(time, run.time + setup.run_in / speed, run.acceleration[0])
        errors.append(np.abs(found["floor_acceleration"] - own).max() / np.abs(own).max())
    assert errors[1] < 2e-5
    assert errors[0] > 8 * errors[1]
    H = weighting("Wk").transfer_function()
    a_w = forced_response(H, run.time - run.time[0], run.acceleration[0]).outputs
    assert found["a_wrms"][-1] == pytest.approx(np.sqrt(np.mean(a_w[run.rated] ** 2)), rel=1e-4)


def test_the_ride_at_another_speed_on_other_springs():
    """Parameters of the set-up: from the same place the same track is passed faster."""
    model, count, dt = paper_coach(2), 2001, 2.5e-4
    x = np.arange(0.0, 450.0, 0.25)
    line = Track(0.0, 0.25, 1e-3 * np.sin(0.9 * x) + 2e-3 * np.sin(0.3 * x))
    setup = ride_setup(content_of(model), line, 145 * KMH, length=10.0)
    text = written(content_of(model, "floor_acceleration"), setup)
    ride = compiled(text, f"{package(text)}.Ride").with_params(**{"V": 50.0, "coach.k_2": 6e5})
    stop = (count - 1) * dt
    _, found = simulated(ride, stop, dt, rtol=1e-9)
    softer = model.changed(k_2=6e5)
    w, slope = line.elevation(setup.start - setup.behind[:, None] + 50.0 * np.arange(count) * dt)
    s, u = content_of(softer, "floor_acceleration").system, np.vstack([w, 50.0 * slope])
    start = np.concatenate(following(model.matrices(), u[:4, 0], u[4:, 0]))
    own = simulate(s.A, s.B[:, :8], s.C, s.D[:, :8], u, dt, x0=start).outputs[0]
    assert np.abs(found["floor_acceleration"] - own).max() < 1e-5 * np.abs(own).max()


def test_the_file_of_a_ride(line, tmp_path):
    model, file = paper_coach(2), tmp_path / "ride.mo"
    export_model(model, "modelica", file, track=line, speed=200 * KMH, length=10.0)
    text = file.read_text(encoding="utf-8")
    ride = compiled(text, f"{package(text)}.Ride")
    assert {p.name: p.value for p in ride.parameters}["V"] == 200 * KMH
    with pytest.raises(InputError, match="only 'modelica' holds a ride"):
        export_model(model, "npz", tmp_path / "ride.npz", track=line)
