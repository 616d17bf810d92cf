"""The Modelica package, compiled and solved by rumoca: the model is the one it was made from."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from control import forced_response
from rumoca_peer import compiled, driven, simulated
from vehicles import paper_coach, random_model, random_vehicle

from railride import (
    KMH,
    InputError,
    Track,
    derive_vehicle,
    export_model,
    load_vehicle,
    simulate,
    weighting,
)
from railride.exports.as_modelica import NAMES, unit, written
from railride.exports.content import content_of
from railride.exports.setup import ride_setup
from railride.timerun import time_run


def _elastic_mounts():
    coach = load_vehicle("cati2024")
    mounts = {"primary_damper_stiffness": 2e6, "secondary_damper_stiffness": 12e6}
    return replace(coach, bogies=tuple(replace(b, **mounts) for b in coach.bogies))


MODELS = {
    "rigid": lambda: paper_coach(1),
    "segments": lambda: paper_coach(4),
    "beam": lambda: derive_vehicle("cati2024", body="beam", modes=2, bending_damping=0.015),
    "unlike": lambda: random_model(3, 3),
    "elastic mounts": lambda: derive_vehicle(_elastic_mounts(), 2),
}


def package(text):
    return re.search(r"^package (\w+)", text, re.MULTILINE)[1]


@pytest.mark.parametrize("kind", MODELS)
def test_same_inputs_same_outputs(kind):
    """Every output of a run over 0.2 s of noise, linear between samples of 1 ms, to 1e-6."""
    model = MODELS[kind]()
    content = content_of(model)
    rng, dt, count = np.random.default_rng(7), 1e-3, 201
    names = [s.name for s in (*content.elevations, *content.rates)]
    u = {name: 1e-4 * np.cumsum(rng.standard_normal(count)) for name in names}
    for name in names:
        u[name] -= u[name][0]
    text = driven(written(content), u, dt, [f.name for f in content.forces])
    _, found = simulated(compiled(text, f"{package(text)}.Driven"), (count - 1) * dt, dt)
    s, samples = content.system, np.array(list(u.values()))
    expected = simulate(s.A, s.B[:, : len(u)], s.C, s.D[:, : len(u)], samples, dt).outputs
    for output, own in zip(content.outputs, expected, strict=True):
        difference = found[f"coach.{NAMES.written(output.name)}"] - own
        assert np.abs(difference).max() < 1e-6 * np.abs(own).max(), output.name


def test_a_changed_parameter_changes_the_model():
    content = content_of(paper_coach(2), "floor_acceleration")
    dt, count = 1e-3, 101
    u = {name: np.zeros(count) for name in ("w_1", "w_2", "w_3", "w_4")}
    u |= {f"d{name}": np.full(count, 0.01) for name in u}
    text = driven(written(content), u, dt, ["f_1", "f_2"])
    model = compiled(text, f"{package(text)}.Driven").with_params(**{"coach.k_2": 6e5})
    _, found = simulated(model, (count - 1) * dt, dt)
    s = content_of(paper_coach(2).changed(k_2=6e5), "floor_acceleration").system
    own = simulate(s.A, s.B[:, :8], s.C, s.D[:, :8], np.array(list(u.values())), dt).outputs[0]
    assert np.abs(found["coach.floor_acceleration"] - own).max() < 1e-6 * np.abs(own).max()


@pytest.mark.parametrize("kind", MODELS)
def test_names_units_and_meanings_are_those_of_the_model(kind):
    content = content_of(MODELS[kind]())
    text = written(content)
    model = compiled(text, f"{package(text)}.Coach")
    inputs = (*content.elevations, *content.rates, *content.forces)
    assert [NAMES.original(name) for name in model.inputs.names] == [u.name for u in inputs]
    assert [NAMES.original(name) for name in model.outputs.names] == [
        o.name for o in content.outputs
    ]
    parameters = {NAMES.original(p.name): p for p in model.parameters}
    assert set(parameters) == {p.name for p in content.parameters}
    for own in content.parameters:
        assert parameters[own.name].unit == unit(own.unit)
        assert (parameters[own.name].description or "") == own.meaning
        if own.definition is None:
            assert parameters[own.name].value == own.value
    units = {q.name: unit(q.unit) for q in content.coordinates}
    states = {NAMES.original(name): name for name in model.states.names}
    assert all(model.states[states[name]].unit == of for name, of in units.items())


def test_any_name_of_a_vehicle_makes_a_package():
    vehicle = replace(random_vehicle(1), name='2nd "coach" \\ №1')
    text = written(content_of(derive_vehicle(vehicle, 2)))
    assert NAMES.original(package(text)) == vehicle.name
    assert compiled(text, f"{package(text)}.Coach").structure().is_balanced


def test_every_line_fits():
    text = written(content_of(MODELS["unlike"]()))
    assert max(len(line) for line in text.splitlines()) <= 120


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
    assert found["a_wrms"][-1] == pytest.approx(np.sqrt(np.mean(a_w[run.rated] ** 2)), rel=1e-3)


def test_the_file_of_a_ride(line, tmp_path):
    model, file = paper_coach(2), tmp_path / "ride.mo"
    export_model(model, "modelica", file, track=line, speed=200 * KMH, length=10.0)
    text = file.read_text(encoding="utf-8")
    ride = compiled(text, f"{package(text)}.Ride")
    assert {p.name: p.value for p in ride.parameters}["V"] == 200 * KMH
    with pytest.raises(InputError, match="only 'modelica' holds a ride"):
        export_model(model, "npz", tmp_path / "ride.npz", track=line)
