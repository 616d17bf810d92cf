"""The export as an FMU: checked and stepped by FMPy, compared with the equations integrated."""

from __future__ import annotations

import sys
from functools import cache

import fmpy
import numpy as np
import pytest
from export_cases import changed, content, independent
from fmpy.fmi2 import FMU2Slave
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.signal import lsim

from railride.errors import InputError
from railride.exports.fmu_slave import exponential
from railride.exports.write import export_content
from railride.statespace import system_arrays

KINDS = ("mounts", "beam")
DURATION = 1.5


@pytest.fixture(scope="module")
def fmu(tmp_path_factory):
    """FMUs by the kind of their vehicle, each made once."""
    folder = tmp_path_factory.mktemp("fmu")

    @cache
    def made(kind):
        file = folder / f"{kind}.fmu"
        file.write_bytes(export_content(content(kind), "fmu"))
        return str(file)

    return made


def smooth(t):
    """w and ẇ of a track that begins smoothly, at t (...): 1.3 Hz and 9 Hz, 1 mm and 0.3 mm."""
    s = np.clip(t, 0, None)
    fade, rise = 1 - np.exp(-((4 * s) ** 3)), 192 * s**2 * np.exp(-((4 * s) ** 3))
    a, b = 2 * np.pi * 1.3, 2 * np.pi * 9.0
    w = 1e-3 * np.sin(a * s) + 3e-4 * np.cos(b * s)
    return fade * w, rise * w + fade * (1e-3 * a * np.cos(a * s) - 3e-4 * b * np.sin(b * s))


def inputs(own, t):
    """u = (w, ẇ, f), (inputs, ...), at times t (...): each wheelset 50 ms behind, steady forces."""
    each = [smooth(t - 0.05 * j) for j in range(len(own.elevations))]
    force = [np.full_like(t, 50.0) for _ in own.forces]
    return np.array([*(w for w, _ in each), *(dw for _, dw in each), *force])


def simulated(file, own, t, u, **given):
    """The outputs (outputs, times) that FMPy finds, stepping from time to time."""
    kinds = [("time", float), *((name, float) for name in own.system.inputs)]
    signals = np.array(list(zip(t, *u, strict=True)), dtype=kinds)
    found = fmpy.simulate_fmu(file, stop_time=t[-1], output_interval=t[1], input=signals,
                              output=list(own.system.outputs), **given)  # fmt: skip
    assert np.allclose(found["time"], t)
    return np.array([found[name] for name in own.system.outputs])


def test_parameters_of_no_vehicle_are_told(fmu):
    said = []
    with pytest.raises(fmpy.fmi1.FMICallException):
        fmpy.simulate_fmu(fmu("mounts"), start_values={"m_b": 0.0}, debug_logging=True,
                          logger=lambda *log: said.append(str(log[-1])))  # fmt: skip
    assert "found m_b = 0.0, of which no equations can be formed" in " ".join(said)


def integrated(own, t):
    """The same by an integrator of high order at tight tolerance."""
    s = own.system
    solution = solve_ivp(lambda at, x: s.A @ x + s.B @ inputs(own, at), (0, t[-1]),
                         np.zeros(len(s.A)), "DOP853", t, rtol=1e-9, atol=1e-13)  # fmt: skip
    return s.C @ solution.y + s.D @ inputs(own, t)


def errors(file, own, step, **given):
    """Root mean square of the difference over that of each output, by its name."""
    t = np.arange(0, DURATION + step / 2, step)
    found, expected = simulated(file, own, t, inputs(own, t), **given), integrated(own, t)
    relative = np.linalg.norm(found - expected, axis=1) / np.linalg.norm(expected, axis=1)
    return dict(zip(own.system.outputs, relative, strict=True))


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_valid_and_says_names_units_and_meanings(fmu, kind):
    assert validate_fmu(fmu(kind)) == []
    description, own = fmpy.read_model_description(fmu(kind)), content(kind)
    assert description.coSimulation.modelIdentifier == "cati2024"
    of = {v.name: v for v in description.modelVariables}
    assert {n: float(v.start) for n, v in of.items() if v.causality == "parameter"} == (
        pytest.approx(independent(own), rel=1e-15)
    )
    for causality in ("input", "output"):
        names = [v.name for v in description.modelVariables if v.causality == causality]
        assert names == list(getattr(own.system, f"{causality}s"))
    assert (of["k_2"].unit, of["k_2"].description) == ("N/m", "secondary stiffness per bogie")
    assert (of["dtheta_b1"].unit, of["w_1"].unit) == ("rad/s", "m")
    unit = next(u for u in description.unitDefinitions if u.name == "N/m").baseUnit
    assert (unit.kg, unit.m, unit.s, unit.factor) == (1, 0, -2, 1.0)


@pytest.mark.parametrize("kind", KINDS)
def test_a_smooth_track_leaves_an_error_of_second_order(fmu, kind):
    coarse, fine = (errors(fmu(kind), content(kind), step) for step in (2e-3, 1e-3))
    k = len(content(kind).elevations)
    direct = content(kind).system.D[:, k : 2 * k].any(axis=1)  # ẇ of the step's beginning is known
    for (name, error), first in zip(fine.items(), direct, strict=True):
        order = np.log2(coarse[name] / error)
        assert order == pytest.approx(1 if first else 2, abs=0.1), name
    assert max(error for name, error in fine.items() if name.startswith("floor")) < 5e-4


def test_with_other_parameters(fmu):
    """All of them changed, among them those that railride calculates from others."""
    start = independent(changed("beam"))
    fine = errors(fmu("beam"), changed("beam"), 1e-3, start_values=start)
    assert fine["floor_acceleration"] < 5e-4
    assert errors(fmu("beam"), changed("beam"), 1e-3)["floor_acceleration"] > 5e-3


@pytest.mark.parametrize("kind", KINDS)
def test_a_track_of_straight_lines_is_followed_exactly(fmu, kind):
    """Straight from time to time, the rates those of the lines that follow; any step."""
    own = content(kind)
    for step in (1e-3, 2e-2):
        t = np.arange(0, 60 * step, step)
        u = inputs(own, t)
        k = len(own.elevations)
        u[k : 2 * k, :-1] = np.diff(u[:k], axis=1) / step
        exact = system_arrays(own.model, own.model.floor(), "elevation")
        _, expected, _ = lsim(
            (exact.A, exact.B, exact.C, exact.D), np.delete(u, range(k, 2 * k), 0).T, t
        )
        found = simulated(fmu(kind), own, t, u)[0]
        assert np.abs(found - expected)[1:].max() < 1e-9 * np.abs(expected).max()


@pytest.fixture
def instances(fmu, tmp_path):
    """Two instances side by side, and the value references by name."""
    description = fmpy.read_model_description(fmu("beam"))
    folder = fmpy.extract(fmu("beam"), str(tmp_path))
    identifier = description.coSimulation.modelIdentifier
    made = [FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=identifier,
                      instanceName=name) for name in ("one", "other")]  # fmt: skip
    for one in made:
        one.instantiate()
        one.setupExperiment(startTime=0.0)
        one.enterInitializationMode()
        one.exitInitializationMode()
    yield (*made, {v.name: v.valueReference for v in description.modelVariables})
    for one in made:
        one.terminate()
        one.freeInstance()


def test_states_are_kept_and_given_back(instances):
    one, other, of = instances
    shown = [of["z_b1"], of["dz_b1"], of["floor_acceleration"], of["k_2"], of["w_1"]]
    one.setReal([of["w_1"], of["dw_1"], of["k_2"]], [1e-3, 0.02, 6e5])
    assert other.getReal(shown) == [0.0, 0.0, 0.0, 7.5e5, 0.0]
    one.doStep(0.0, 0.01)
    state, then = one.getFMUstate(), one.getReal(shown)
    one.doStep(0.01, 0.01)
    later = one.getReal(shown)
    assert later[0] != then[0] != 0.0
    one.setFMUstate(state)
    assert one.getReal(shown) == then
    other.setFMUstate(other.deSerializeFMUstate(one.serializeFMUstate(state)))
    other.doStep(0.01, 0.01)
    assert other.getReal(shown) == later
    one.reset()
    assert one.getReal(shown) == [0.0, 0.0, 0.0, 7.5e5, 0.0]


def test_outputs_feel_inputs_that_are_set_after_a_step(instances):
    """Until then the elevations go on at their rates."""
    one, _, of = instances
    one.setReal([of["dw_1"]], [0.02])
    one.doStep(0.0, 0.01)
    bogie, deflection = [of["z_b1"], of["theta_b1"]], [of["primary_1_deflection"]]
    for w in (2e-4, 1e-3):
        z, theta = one.getReal(bogie)
        assert one.getReal(deflection) == pytest.approx([z + 1.25 * theta - w], rel=1e-12)
        one.setReal([of["w_1"]], [1e-3])


@pytest.mark.parametrize("size", [1e-3, 1.0, 40.0])
def test_the_matrix_exponential(size):
    A = size * np.random.default_rng(1).standard_normal((12, 12)) / np.sqrt(12)
    expected = expm(A)
    assert np.abs(exponential(A) - expected).max() <= 1e-13 * (1 + size) * np.abs(expected).max()


def test_nothing_is_left_of_the_making():
    path, modules = list(sys.path), set(sys.modules)
    export_content(content("rigid"), "fmu")
    assert sys.path == path
    assert not [name for name in set(sys.modules) - modules if name.startswith("cati2024")]


def test_without_the_library(monkeypatch):
    monkeypatch.setitem(sys.modules, "pythonfmu", None)
    with pytest.raises(InputError, match=r"pythonfmu; expected .*railride\[fmu\]"):
        export_content(content("rigid"), "fmu")
