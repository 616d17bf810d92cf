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
FINER = 32  # steps of the linear run within one


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
    "unlike": lambda: random_model(1, 3),
    "elastic mounts": _elastic_mounts,
}


@pytest.mark.parametrize("kind", ["beam", "elastic mounts"])
def test_a_small_track_is_linear(kind):
    """0.06 mm r.m.s.: what is left is the linear run's own step, 1/32 ms, squared."""
    model = MODELS[kind]()
    track = waves(model, 0.01)
    assert apart(nonlinear(model, track), linear(model, track)) < 5e-7


@pytest.mark.parametrize(
    ("kind", "scales", "at_100"),
    [("segments", (1, 10, 100), 0.0436), ("unlike", (100,), 0.00287)],
)
def test_two_nonlinear_programs_agree_where_the_linear_one_fails(kind, scales, at_100):
    """Tracks of 6, 60 and 600 mm r.m.s.; Exudyn's runs of two steps extrapolated to none.

    On a track turned upside down the vehicle moves upside down: the equations have no terms of the
    second order, and what the linear ones leave out grows as the third, relatively the second.
    """
    model = MODELS[kind]()
    own = linear(model, waves(model, 1))
    for scale in scales:
        track = waves(model, scale)
        found = nonlinear(model, track)
        coarse, fine = (exudyn(model, track, step) for step in (STEP, STEP / 2))
        assert apart((4 * fine[:, ::2] - coarse) / 3, found) < 1e-5
        assert apart(scale * own, found) == pytest.approx(at_100 * (scale / 100) ** 2, rel=0.02)


def test_a_rigid_vehicle_turns_by_sines():
    """Its only nonlinearity: the suspension feels l sin θ."""
    model = paper_coach(1)
    own = linear(model, waves(model, 1))
    errors = [apart(s * own, nonlinear(model, waves(model, s))) for s in (10, 100)]
    assert errors[0] < 2e-5
    assert errors[1] / errors[0] == pytest.approx(100, rel=0.02)


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


def test_a_bump_after_a_long_rest_is_met():
    """2 m of it after 200 m of level track: the same as at once, at every wheelset."""
    model = paper_coach(1)
    behind = waves(model, 1).behind

    def over(start):
        def under(t):
            p = np.clip((SPEED * (t - start) - np.array(behind)) / 2.0, 0.0, 1.0)
            w = 5e-3 * (4 * p * (1 - p)) ** 4
            dw = 5e-3 * 16 * (4 * p * (1 - p)) ** 3 * (1 - 2 * p) * SPEED / 2.0
            return w, dw

        return simulate_nonlinear(model, under, np.array([0.0, *(start + TIMES[::10])])).outputs

    at_once, later = over(1e-9), over(200.0 / SPEED)
    assert np.abs(at_once).max() > 0.1
    assert np.abs(later - at_once).max() < 1e-6 * np.abs(at_once).max()


LEVEL = np.zeros(4), np.zeros(4)


@pytest.mark.parametrize(("given", "said"), [
    ({"times": [0.0, 0.0]}, "times.*ascend"),
    ({"times": [0.0, np.nan]}, "times.*ascend"),
    ({"times": [0.0]}, "times.*ascend"),
    ({"times": "soon"}, "times: found 'soon'"),
    ({"x0": [0.0]}, "x0: found 1 numbers.*expected 12"),
    ({"x0": np.full(12, np.nan)}, "x0: found 12 numbers, 0 of them finite"),
    ({"outputs": "flor"}, "flor"),
    ({"track": "erri_low"}, "track: found 'erri_low'; expected a function of the time"),
    ({"track": lambda _: None}, r"track: found arrays of shapes \(\); expected w and dw, \(4,\)"),
    ({"track": lambda _: np.zeros((2, 3))}, r"track: found arrays of shapes \(3,\), \(3,\)"),
    ({"rtol": np.nan}, "rtol: found nan"),
    ({"atol": 0.0, "rtol": -1.0}, "rtol: found -1.0(.|\n)*atol: found 0.0"),
])  # fmt: skip
def test_what_cannot_be_run(given, said):
    arguments = {"track": lambda _: LEVEL, "times": [0.0, 1.0]} | given
    with pytest.raises(InputError, match=said):
        simulate_nonlinear(paper_coach(1), **arguments)


def test_a_track_that_is_none_is_told():
    high = np.full(4, np.inf)
    with pytest.raises(InputError, match="cannot be followed"):
        simulate_nonlinear(paper_coach(2), lambda _: (high, high), [0.0, 1.0])
