"""The nonlinear equations, integrated: against the linear model, and against Exudyn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from exudyn_peer import at_steps, coach_of
from smooth_tracks import Waves
from vehicles import paper_coach, random_model

from railride import KMH, InputError, derive_vehicle, load_vehicle, simulate, simulate_nonlinear
from railride.statespace import system_arrays

SPEED, STOP, STEP = 145 * KMH, 1.5, 1e-3
TIMES = STEP * np.arange(round(STOP / STEP) + 1)
FINER = 16  # steps of the linear run within one


def outputs(model):
    return [model.floor(x, "polygon") for x in (0.0, 5.0)]


def waves(model, scale):
    return Waves.under(model, SPEED, scale)


def nonlinear(model, track, **given):
    def under(t):
        w, dw = np.split(track.under_all(t), 2)
        return w, dw

    return simulate_nonlinear(model, under, TIMES, outputs(model), **given).outputs


def linear(model, track):
    s, step = system_arrays(model, outputs(model)), STEP / FINER
    u = track.under_all(step * np.arange((TIMES.size - 1) * FINER + 1))
    found = simulate(s.A, s.B[:, : len(u)], s.C, s.D[:, : len(u)], u, step)
    return found.outputs[:, ::FINER]


def exudyn(model, track, step):
    u = track.under_all(step * np.arange(round(STOP / step) + 1))
    return coach_of(model, at_steps(u, step)).run(STOP, step, (0.0, 5.0))[1]


def apart(one, other):
    return (np.abs(one - other).max(axis=1) / np.abs(other).max(axis=1)).max()


def _elastic_mounts():
    coach = load_vehicle("cati2024")
    mounts = {"primary_damper_stiffness": 2e6, "secondary_damper_stiffness": 12e6}
    coach = replace(coach, bogies=tuple(replace(b, **mounts) for b in coach.bogies))
    return derive_vehicle(coach, 1)


MODELS = {
    "rigid": lambda: paper_coach(1),
    "segments": lambda: paper_coach(2),
    "beam": lambda: derive_vehicle("cati2024", body="beam", modes=2),
    "unlike": lambda: random_model(2, 2),
    "elastic mounts": _elastic_mounts,
}


@pytest.mark.parametrize("kind", MODELS)
def test_a_small_track_is_linear(kind):
    """0.06 mm r.m.s.: what is left is the linear run's own step, 1/16 ms, squared."""
    model = MODELS[kind]()
    track = waves(model, 0.01)
    assert apart(nonlinear(model, track), linear(model, track)) < 1e-5


@pytest.mark.parametrize("model", [paper_coach(2), random_model(2, 3)],
                         ids=["paper's", "unlike"])  # fmt: skip
def test_two_nonlinear_programs_agree_where_the_linear_one_fails(model):
    """Tracks of 6 and 600 mm r.m.s.; Exudyn's runs of two steps extrapolated to none."""
    of_the_linear = []
    for scale in (1, 100):
        track = waves(model, scale)
        found = nonlinear(model, track)
        coarse, fine = (exudyn(model, track, step) for step in (STEP, STEP / 2))
        assert apart((4 * fine[:, ::2] - coarse) / 3, found) < 5e-5
        of_the_linear.append(apart(linear(model, track), found))
    assert of_the_linear[0] < 1e-5
    assert of_the_linear[1] > 1e-2


def test_a_rigid_vehicle_turns_by_sines():
    """Its only nonlinearity: the suspension feels l sin θ."""
    model = paper_coach(1)
    errors = [apart(linear(model, waves(model, s)), nonlinear(model, waves(model, s)))
              for s in (10, 100)]  # fmt: skip
    assert errors[1] / errors[0] == pytest.approx(100, rel=0.1)


def test_a_state_goes_on_from_where_it_was():
    model = paper_coach(1)
    track = waves(model, 1)

    def under(t):
        return np.split(track.under_all(t), 2)

    half = TIMES.size // 2
    whole = simulate_nonlinear(model, under, TIMES)
    first = simulate_nonlinear(model, under, TIMES[: half + 1])
    second = simulate_nonlinear(model, under, TIMES[half:], x0=first.final_state)
    scale = np.abs(whole.outputs).max()
    assert np.abs(second.outputs - whole.outputs[:, half:]).max() < 1e-7 * scale
    assert second.time[0] == 0.0


@pytest.mark.parametrize(("times", "given", "said"), [
    ([0.0, 0.0], {}, "ascend"),
    ([0.0, np.nan], {}, "ascend"),
    ([0.0], {}, "ascend"),
    ([0.0, 1.0], {"x0": [0.0]}, r"shape \(1,\); expected \(12,\)"),
    ([0.0, 1.0], {"outputs": "flor"}, "flor"),
])  # fmt: skip
def test_what_cannot_be_run(times, given, said):
    level = np.zeros(4)
    with pytest.raises(InputError, match=said):
        simulate_nonlinear(paper_coach(1), lambda _: (level, level), times, **given)


def test_a_track_that_is_none_is_told():
    high = np.array([1e9, 0.0, 0.0, 0.0])
    with pytest.raises(InputError, match="cannot be followed"):
        simulate_nonlinear(paper_coach(2), lambda t: (high * t * np.inf, high), [0.0, 1.0])
