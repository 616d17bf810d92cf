"""Joint stiffnesses calibrated to several bending frequencies.

Frequencies are computed again by scipy from matrices assembled here, and the least change is found
again by scipy's general optimiser.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import NonlinearConstraint, minimize
from test_segments import UNLIKE, turns

from railride.bodies import SegmentedBody
from railride.errors import InputError
from railride.parameters import CarBody, load_vehicle
from railride.vehicle import derive_vehicle

COACH = load_vehicle("cati2024")


def rods(N, mass=34e3, length=24.0):
    """M of a free chain of equal rods by its nodes' heights, and the joints' turns."""
    M = np.zeros((N + 1, N + 1))
    for i in range(N):
        M[i : i + 2, i : i + 2] += mass / N * np.array([[2, 1], [1, 2]]) / 6
    return M, turns(np.linspace(length / 2, -length / 2, N + 1))


def hz(M, G, k):
    """Natural frequencies of the chain other than zero."""
    return np.sqrt(eigh(G.T @ np.diag(k) @ G, M, eigvals_only=True)[2:]) / (2 * np.pi)


def calibrated(N, frequencies, **changes):
    """The paper's coach of N segments with these bending frequencies, and its joints."""
    body = replace(COACH.body, bending_frequency=None, bending_frequencies=frequencies, **changes)
    model = derive_vehicle(replace(COACH, body=body), N)
    values = model.values()
    return model, np.array([values[f"k_theta_{j}"] for j in range(1, N)])


@pytest.mark.parametrize(
    ("N", "frequencies"),
    [(4, (9.6,)), (4, (9.6, 26.463)), (4, (9.6, 17.0)), (4, (9.6, 60.0)), (5, (8.0, 21.0)),
     (8, (9.6, 26.463, 51.877)), (8, (9.0, 28.0, 50.0, 90.0)), (16, (9.6, 24.0, 47.0))],
)  # fmt: skip
def test_given_frequencies_are_met(N, frequencies):
    model, k = calibrated(N, frequencies)
    found = hz(*rods(N), k)[: len(frequencies)]
    np.testing.assert_allclose(found, frequencies, rtol=1e-10)
    np.testing.assert_allclose(model.bending_frequencies()[: len(found)], frequencies, rtol=1e-10)
    np.testing.assert_allclose(k, k[::-1], rtol=1e-9)  # a symmetric body stays symmetric


@pytest.mark.parametrize(
    ("N", "frequencies"), [(5, (9.6, 24.0)), (6, (9.6, 27.0)), (7, (9.6, 30.0))]
)
def test_the_stiffnesses_change_as_little_as_can_be(N, frequencies):
    """The shortest ln(k/k⁰) that meets the frequencies, k⁰ meeting the first."""
    _, k = calibrated(N, frequencies)
    M, G = rods(N)
    begun = np.ones(N - 1) * (frequencies[0] / hz(M, G, np.ones(N - 1))[0]) ** 2
    met = NonlinearConstraint(lambda p: np.log(hz(M, G, begun * np.exp(p))[:2]),
                              np.log(frequencies), np.log(frequencies))  # fmt: skip
    rng = np.random.default_rng(N)
    best = min(
        (minimize(lambda p: p @ p, rng.normal(0, 0.1, N - 1), jac=lambda p: 2 * p, method="SLSQP",
                  constraints=met, options={"ftol": 1e-14, "maxiter": 500}) for _ in range(3)),
        key=lambda found: found.fun,
    )  # fmt: skip
    own = np.log(k / begun)
    assert own @ own == pytest.approx(best.fun, rel=1e-5)
    np.testing.assert_allclose(own, best.x, atol=2e-4)


def test_one_frequency_in_a_list_scales_all_joints_alike():
    _, k = calibrated(4, (9.6,))
    expected = float(derive_vehicle(COACH, 4).values()["k_theta"])
    np.testing.assert_allclose(k, expected, rtol=1e-12)


def test_unlike_segments_are_calibrated_from_their_own_joints():
    body = replace(UNLIKE, bending_frequencies=(9.0, 25.0))
    segmented = SegmentedBody(body, 5)
    model = derive_vehicle(replace(COACH, body=body), 5)
    np.testing.assert_allclose(segmented.bending_frequencies(model.values())[:2], (9.0, 25.0),
                               rtol=1e-10)  # fmt: skip


def test_changed_masses_and_frequencies_are_calibrated_anew_and_together():
    model, _ = calibrated(4, (9.6, 25.0), bending_damping=0.02)
    values = model.values(m_c=[30e3, 34e3, 38e3], f_bending_2=[[24.0], [26.0]])
    assert values["k_theta_2"].shape == (2, 3)
    found = model.bending_frequencies(m_c=[30e3, 34e3, 38e3], f_bending_2=[[24.0], [26.0]])
    np.testing.assert_allclose(found[..., 0], 9.6, rtol=1e-10)
    np.testing.assert_allclose(found[..., 1], [[24.0] * 3, [26.0] * 3], rtol=1e-10)
    ratio = values["c_theta_1"] / values["k_theta_1"]
    np.testing.assert_allclose(ratio, 2 * 0.02 / (2 * np.pi * 9.6), rtol=1e-12)


def test_more_frequencies_than_joints_are_refused():
    with pytest.raises(InputError, match=r"found 2 for 2 segments; expected 1 at most"):
        calibrated(2, (9.6, 24.0))


def test_frequencies_that_no_joints_give_are_refused_with_what_was_reached():
    """Three joints that stay symmetric have two stiffnesses: not three frequencies."""
    with pytest.raises(InputError, match=r"9.6 Hz, 26.46 Hz, 51.88 Hz, which 3 joints cannot have"):
        calibrated(4, (9.6, 26.463, 51.877))
    # With the middle joint rigid f_2/f_1 is the least, 1.6903.
    calibrated(4, (10.0, 17.0))
    with pytest.raises(InputError, match=r"found 10 Hz, 16.8 Hz.*nearer to 10 Hz, 16.9"):
        calibrated(4, (10.0, 16.8))


def test_a_rigid_body_has_no_joints_to_calibrate():
    body = CarBody(34e3, 1.632e6, 24.0, bending_frequencies=(9.6, 24.0))
    assert derive_vehicle(replace(COACH, body=body), 1).bending_frequencies().size == 0
