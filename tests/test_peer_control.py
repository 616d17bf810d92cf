"""python-control and scipy.signal put the whole chain together: track, vehicle, weighting."""

from __future__ import annotations

from dataclasses import replace

import control
import numpy as np
import pytest
from scipy import signal
from vehicles import paper_coach, random_model

from railride.frequency import track_response, wheelset_delays
from railride.modal import modes
from railride.rides import ride
from railride.spectra import Spectrum
from railride.statespace import state_space, system_arrays
from railride.stochastic import stochastic_ride
from railride.timerun import following, time_run
from railride.track import synthesise
from railride.weightings import weighting

V = 40.0
UNLIKE = [random_model(1, 3), random_model(4, 2)]
COACHES = pytest.mark.parametrize("model", [paper_coach(4), UNLIKE[0]], ids=["paper", "unlike"])


def wk():
    """W_k of ISO 2631-1 with its band limits, from the figures of ISO 8041-1."""
    w1, w2, w3, w5, w6 = (2 * np.pi * f for f in (0.4, 100, 12.5, 2.37, 3.35))
    factors = (
        signal.butter(2, w1, "highpass", analog=True),
        signal.butter(2, w2, analog=True),
        ([1 / w3, 1], [1 / w3**2, 1 / (0.63 * w3), 1]),
        ([1, w5 / 0.91, w5**2], [1, w6 / 0.91, w6**2]),
    )
    return control.series(*(control.ss(control.tf(*factor)) for factor in factors))


def of_the_track(model, *outputs):
    """The vehicle from w and ẇ under the wheelsets alone."""
    plant = state_space(model, outputs or None)
    n = 2 * len(model.linear.inputs)
    return control.ss(plant.A, plant.B[:, :n], plant.C, plant.D[:, :n])


def test_wk():
    f = np.geomspace(0.01, 500, 300)
    np.testing.assert_allclose(weighting("Wk").response(f), wk()(2j * np.pi * f), rtol=1e-11)


@COACHES
def test_modes_are_controls_poles(model):
    """``control.damp``: those with Im λ > 0, down to a damping ratio of 2e-6."""
    turn, damping, poles = control.damp(state_space(model), doprint=False)
    upper = np.flatnonzero(poles.imag > 0)
    upper = upper[np.argsort(turn[upper])]
    found = modes(model)
    frequencies = [mode.frequency_hz for mode in found]
    np.testing.assert_allclose(frequencies, turn[upper] / (2 * np.pi), rtol=1e-9)
    ratios = [mode.damping_ratio for mode in found]
    np.testing.assert_allclose(ratios, damping[upper], rtol=1e-9, atol=1e-11)


@pytest.mark.filterwarnings("ignore:Badly conditioned filter coefficients")
@COACHES
def test_track_response_is_scipys(model):
    """``scipy.signal.freqresp`` of every wheelset's w and ẇ, delayed by hand."""
    point = model.floor(3.0)
    s = system_arrays(model, point)
    omega = 2 * np.pi * np.geomspace(0.05, 80, 100)

    def channel(j):
        return signal.freqresp((s.A, s.B[:, [j]], s.C, s.D[:, [j]]), omega)[1]

    delays = wheelset_delays(model, V)
    expected = sum(
        np.exp(-1j * omega * delay) * (channel(j) + 1j * omega * channel(len(delays) + j))
        for j, delay in enumerate(delays)
    )
    found = track_response(model, [point], V, omega / (2 * np.pi))[0]
    assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max()


@COACHES
def test_a_ride_is_controls_forced_response(model):
    """a_wrms of vehicle and weighting in series, over the same samples of w and ẇ."""
    track = replace(synthesise("erri_low", 900.0, 0.05, 3), distance0=-600.0)
    run = time_run(model, V, track, [0.0], length=300.0, floor="smooth", weight=weighting("Wk"),
                   rate=1000.0)  # fmt: skip
    w, slope = track.elevation(run.distance - V * wheelset_delays(model, V)[:, np.newaxis])
    chain = control.series(of_the_track(model), wk())
    start = np.concatenate(following(model.matrices(), w[:, 0], V * slope[:, 0]))
    a_w = control.forced_response(
        chain, run.time - run.time[0], np.vstack([w, V * slope]), squeeze=False,
        X0=np.concatenate([start, np.zeros(chain.nstates - start.size)]),
    ).outputs[0, run.rated]  # fmt: skip
    (case,) = ride(model, track, V, length=300.0).cases
    assert case.a_wrms == pytest.approx(np.sqrt(np.mean(a_w**2)), rel=1e-9)


@pytest.mark.parametrize("model", UNLIKE, ids=["2 bogies", "3 bogies"])
@pytest.mark.parametrize("at", [0.0, 5.0])
def test_mean_squares_are_controls_h2_norm(model, at):
    """White noise through a shaping filter, vehicle and weighting: ``control.norm`` of the chain.

    S(Ω) = c/((Ω² + a²)(Ω² + b²)) is the noise's through F = √(πcV³)/((s + aV)(s + bV)), the track
    passed so fast that all wheelsets are as good as at one place.
    """
    fast, c = 1e12, 1e-39
    a, b = 2 * np.pi * np.array([0.3, 15.0]) / fast
    shaped = Spectrum("two poles", "here", "m^2/(rad/m)", "one-sided",
                      lambda O: c / ((O**2 + a**2) * (O**2 + b**2)),  # noqa: E741
                      poles=(1j * a, -1j * a, 1j * b, -1j * b))  # fmt: skip
    found = stochastic_ride(model, fast, shaped, at, band=(1e-6, 1e6))
    size = np.sqrt(np.pi * c * fast**3)
    F = control.ss([[0, 1], [-a * b * fast**2, -(a + b) * fast]], [[0], [1]], size * np.eye(2),
                   np.zeros((2, 1)))  # fmt: skip
    everywhere = np.repeat(np.eye(2), len(model.linear.inputs), axis=0)
    felt = control.series(F, everywhere, of_the_track(model, model.floor(at)))
    assert found.a_rms[0] == pytest.approx(control.norm(felt, 2), rel=1e-8)
    assert found.a_wrms[0] == pytest.approx(control.norm(control.series(felt, wk()), 2), rel=1e-8)
