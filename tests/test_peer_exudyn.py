"""Exudyn, a nonlinear multibody program, against the linear model."""

from __future__ import annotations

import numpy as np
import pytest
from exudyn_peer import at_steps, coach_of
from smooth_tracks import Waves
from vehicles import paper_coach, random_model

from railride import KMH, simulate
from railride.modal import eigen, undamped_frequencies
from railride.statespace import system_arrays

SPEED = 145 * KMH
FLOOR = (0.0, 5.0)  # m forward of the middle
STOP = 2.0  # s
FINEST = 1 / 32_000  # s, of the linear rides


def linear(model, track):
    """Accelerations of the floor's polygon, (points, samples), by the linear model."""
    s = system_arrays(model, [model.floor(x, "polygon") for x in FLOOR])
    u = track.under_all(FINEST * np.arange(round(STOP / FINEST) + 1))
    return simulate(s.A, s.B[:, : len(u)], s.C, s.D[:, : len(u)], u, FINEST).outputs


def nonlinear(model, track, step):
    """The same by Exudyn."""
    u = track.under_all(step * np.arange(round(STOP / step) + 1))
    return coach_of(model, at_steps(u, step)).run(STOP, step, FLOOR)[1]


def apart(one, other):
    """At each point the largest difference over the largest value, and the same in r.m.s."""
    difference = one - other
    largest = np.abs(difference).max(axis=1) / np.abs(other).max(axis=1)
    return np.array([largest, np.sqrt((difference**2).mean(axis=1) / (other**2).mean(axis=1))])


CASES = [("the paper's", N) for N in (1, 2, 3, 4, 8)] + [("unlike", 3), ("unlike", 4)]


def model_of(kind, segments):
    """The paper's coach; or three bogies of three kinds under a graded body."""
    return random_model(2, segments) if kind == "unlike" else paper_coach(segments)


@pytest.mark.parametrize(("kind", "segments"), CASES)
def test_natural_frequencies(kind, segments):
    """All of them to 1e-6; here the two programs agree to rounding."""
    model = model_of(kind, segments)
    own, other = undamped_frequencies(model.matrices()), coach_of(model).frequencies()
    assert len(other) == len(own)
    assert np.abs(other / own - 1).max() < 1e-9


@pytest.mark.parametrize(("kind", "segments"), CASES)
def test_damped_eigenvalues(kind, segments):
    model = model_of(kind, segments)
    own, _ = eigen(model.matrices())
    own = np.array(sorted(own[own.imag >= 0], key=abs))
    other = coach_of(model).eigenvalues()
    assert len(other) == len(own)
    assert np.abs(other - own).max() < 1e-9 * np.abs(own).max()


def test_unlike_vehicles_are_told_apart():
    """The comparison would see a stiffness that is 1e-5 off."""
    model = paper_coach(2)
    changed = undamped_frequencies(model.matrices(k_2=750e3 * 1.00001))
    other = coach_of(model).frequencies()
    assert np.abs(other / changed - 1).max() > 1e-6


@pytest.mark.parametrize(("kind", "segments"), CASES)
def test_a_ride_converges_to_railrides_with_the_square_of_the_step(kind, segments):
    """Floor accelerations at a step of 0.25 ms to 1e-3; half the step, a quarter of the error."""
    model = model_of(kind, segments)
    track = Waves.under(model, SPEED)
    own = linear(model, track)
    coarse, fine = (
        apart(nonlinear(model, track, step), own[:, :: round(step / FINEST)])
        for step in (0.5e-3, 0.25e-3)
    )
    assert fine.max() < 1e-3
    order = np.log2(coarse / fine)
    assert order == pytest.approx(np.full(order.shape, 2.0), abs=0.05)


@pytest.mark.parametrize(
    ("kind", "segments", "at_100"),
    [("the paper's", 2, 0.032), ("the paper's", 3, 0.0093), ("unlike", 3, 0.040)],
)
def test_where_linearisation_ends(kind, segments, at_100):
    """Its error grows with the square of the track: 1e-6, 1e-4 and 1e-2 at 6, 60 and 600 mm r.m.s.

    What is up or down is the same to a vehicle without weight: its equations hold with the signs
    of all heights, angles and elevations turned. So they have no terms of the second order, and
    those of the third are relative to the first as the square of the track.

    All rides are Exudyn's with one step, divided by the track's scale; next to none, a hundredth of
    the track, is linear. Most of the error is the inertia of segments that the turning of others
    moves along the track. It comes by the bending, which two segments have too much of at the
    middle, a hinge, and three too little.
    """
    model = model_of(kind, segments)
    of = {
        scale: nonlinear(model, Waves.under(model, SPEED, scale), 2e-3) / scale
        for scale in (0.01, 1, 10, 100)
    }
    errors = {scale: apart(of[scale], of[0.01])[0].max() for scale in (1, 10, 100)}
    assert errors[10] / errors[1] == pytest.approx(100, rel=0.01)
    assert errors[100] / errors[10] == pytest.approx(100, rel=0.1)
    assert errors[100] == pytest.approx(at_100, rel=0.02)


def test_only_the_lever_arms_of_a_rigid_vehicle_are_not_linear():
    """At the middle of a symmetric one they cancel, and it is linear on any track."""
    model = paper_coach(1)
    small, large = (
        nonlinear(model, Waves.under(model, SPEED, scale), 2e-3) / scale for scale in (1, 100)
    )
    middle, ahead = apart(large, small)[0]
    assert middle < 1e-9
    assert 1e-3 < ahead < 2e-3


def test_a_track_known_at_the_steps_is_not_read_between_them():
    track = at_steps([[0.0, 1.0], [2.0, 3.0]], 1e-3)
    assert track(0, 1e-3) == [1.0, 3.0]
    with pytest.raises(ValueError, match="whole steps"):
        track(0, 0.5e-3)
