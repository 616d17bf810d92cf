"""Exudyn, a nonlinear multibody program, against the linear model."""

from __future__ import annotations

import numpy as np
import pytest
from exudyn_peer import coach_of
from smooth_tracks import Waves
from vehicles import density, paper_coach, random_model

from railride import KMH, load_vehicle, simulate
from railride.modal import eigen, undamped_frequencies
from railride.statespace import system_arrays

SPEED = 145 * KMH
BEHIND = (0.0, 2.5, 17.5, 20.0)
FLOOR = (0.0, 5.0)  # m forward of the middle
STOP = 2.0  # s


def linear(model, track, step):
    """Accelerations of the floor's polygon, (points, samples), by the linear model."""
    s = system_arrays(model, [model.floor(x, "polygon") for x in FLOOR])
    t = step * np.arange(round(STOP / step) + 1)
    u = track.under_all(t)
    return simulate(s.A, s.B[:, : len(u)], s.C, s.D[:, : len(u)], u, step).outputs


def apart(one, other):
    """Largest difference over the largest value, at each point."""
    return np.abs(one - other).max(axis=1) / np.abs(other).max(axis=1)


CASES = [("the paper's", N) for N in (1, 2, 3, 4, 8)] + [("unlike", 3), ("unlike", 4)]


def pair(kind, segments):
    """The model, and the same vehicle in Exudyn."""
    if kind == "unlike":
        model = random_model(2, segments)
        return model, coach_of(model, density(model.vehicle.body))
    return paper_coach(segments), coach_of(paper_coach(segments))


@pytest.mark.parametrize(("kind", "segments"), CASES)
def test_natural_frequencies(kind, segments):
    """All of them to 1e-6; here the two programs agree to rounding."""
    model, other = pair(kind, segments)
    own, other = undamped_frequencies(model.matrices()), other.frequencies()
    assert len(other) == len(own)
    assert np.abs(other / own - 1).max() < 1e-9


@pytest.mark.parametrize(("kind", "segments"), [("the paper's", 4), ("unlike", 4)])
def test_damped_eigenvalues(kind, segments):
    model, other = pair(kind, segments)
    own, _ = eigen(model.matrices())
    own = np.array(sorted(own[own.imag >= 0], key=abs))
    other = other.eigenvalues()
    assert np.abs(other - own).max() < 1e-9 * np.abs(own).max()


def test_unlike_vehicles_are_told_apart():
    """The comparison would see a stiffness that is 1e-5 off."""
    model = paper_coach(2)
    changed = undamped_frequencies(model.matrices(k_2=750e3 * 1.00001))
    other = coach_of(model).frequencies()
    assert np.abs(other / changed - 1).max() > 1e-6


def test_a_ride_converges_to_railrides_with_the_square_of_the_step():
    """Floor accelerations at a step of 0.25 ms to 1e-3; half the step, a quarter of the error."""
    model, track = paper_coach(2), Waves(SPEED, BEHIND)
    fine = linear(model, track, 0.125e-3 / 4)
    errors = []
    for step in (1e-3, 0.5e-3, 0.25e-3):
        _, found = coach_of(model, track=track).run(STOP, step, FLOOR)
        own = fine[:, :: round(step / (0.125e-3 / 4))]
        errors.append(apart(found, own))
    assert errors[-1].max() < 1e-3
    rms = np.sqrt((found**2).mean(axis=1) / (own**2).mean(axis=1))
    assert np.abs(rms - 1).max() < 1e-3
    ratios = np.array(errors[:-1]) / errors[1:]
    assert ratios.min() > 3.2
    assert ratios.max() < 4.5


@pytest.mark.parametrize(("segments", "at_100"), [(2, 0.032), (3, 0.0093)])
def test_where_linearisation_ends(segments, at_100):
    """Its error grows with the square of the track: 1e-6, 1e-4 and 1e-2 at 6, 60 and 600 mm r.m.s.

    All rides are Exudyn's with one step, divided by the track's scale; next to none, a hundredth of
    the track, is linear. With two segments the error is three times that of three: the middle is
    a hinge, and turns of its two sides do not cancel.
    """
    model = paper_coach(segments)
    of = {}
    for scale in (0.01, 1, 10, 100):
        track = Waves(SPEED, BEHIND, scale)
        of[scale] = coach_of(model, track=track).run(STOP, 2e-3, FLOOR)[1] / scale
    errors = {scale: apart(of[scale], of[0.01]).max() for scale in (1, 10, 100)}
    assert errors[1] < 1e-5
    assert errors[10] / errors[1] == pytest.approx(100, rel=0.05)
    assert errors[100] / errors[10] == pytest.approx(100, rel=0.05)
    assert errors[100] == pytest.approx(at_100, rel=0.1)


def test_the_shipped_coach_is_the_one_compared():
    assert load_vehicle("cati2024").wheelset_positions == tuple(10.0 - np.array(BEHIND))
