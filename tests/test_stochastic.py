"""The exact comfort value: published figures, scipy's quadrature, Lyapunov's equation."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest
import scipy.integrate
import scipy.linalg
from vehicles import paper_coach, random_model

from railride import stochastic
from railride.errors import InputError
from railride.frequency import track_response
from railride.modal import modes
from railride.parameters import load_vehicle
from railride.spectra import Spectrum, spectrum, temporal
from railride.stochastic import gauss_points, graded_panels, stochastic_ride
from railride.vehicle import derive_vehicle
from railride.weightings import weighting

KMH = 1 / 3.6
LOW = spectrum("erri_low")


def a_wrms(model, kmh, at=0.0, floor="polygon", **given):
    return float(stochastic_ride(model, kmh * KMH, LOW, [at], floor=floor, **given).a_wrms[0])


@pytest.mark.parametrize(
    ("segments", "changes", "printed"),
    [
        (2, {}, ("0.2475", "0.3275")),  # the paper's coach, confirmed by two programs
        (1, {}, ("0.0494", "0.0756")),
        (2, {"k_1": 1e7, "c_1": 60e3}, ("0.2086", "0.2670")),  # were the print "per bogie" …
        (2, {"k_2": 1.5e6, "c_2": 140e3}, ("0.2904", "0.3949")),  # … or "per side"
    ],
)
def test_weighted_rms_at_145_and_200_kmh(segments, changes, printed):
    """At the middle, polygon, ERRI B176 low, 0.05-80 Hz, full W_k, no joint damping."""
    found = [a_wrms(paper_coach(segments), kmh, **changes) for kmh in (145, 200)]
    assert [f"{a:.4f}" for a in found] == list(printed)


def test_structural_damping_is_not_negligible():
    """1.5 % in the first bending mode."""
    model = paper_coach(2, bending_damping=0.015)
    assert [f"{a_wrms(model, kmh):.4f}" for kmh in (145, 200)] == ["0.1535", "0.2192"]


def test_more_speed_is_not_always_less_comfort():
    found = {kmh: a_wrms(paper_coach(2), kmh) for kmh in (100, 145, 170)}
    assert f"{found[100]:.3f}" == "0.507"
    assert f"{found[145]:.4f}" == "0.2475"
    assert found[170] == pytest.approx(0.0965, abs=1e-4)


def test_equation_6_leaves_the_band_limits_out():
    """+0.04 % on the flexible body, +0.7 to 0.8 % on the rigid one."""
    paper = weighting("Wk_paper")
    for segments, lowest, highest in ((2, 0.035, 0.045), (1, 0.65, 0.85)):
        for kmh in (145, 200):
            model = paper_coach(segments)
            excess = 100 * (a_wrms(model, kmh, weight=paper) / a_wrms(model, kmh) - 1)
            assert lowest <= excess <= highest


BEAM = paper_coach(32)  # its smooth floor stands for the beam: N = 16 and 32 differ by 1e-4


@pytest.mark.parametrize(("segments", "percent"), [(2, "+39"), (3, "-17"), (4, "+14"), (8, "+3.6")])
def test_polygon_reading_converges_slowly(segments, percent):
    found = 100 * (a_wrms(paper_coach(segments), 145) / a_wrms(BEAM, 145, floor="smooth") - 1)
    assert f"{found:+.{1 if '.' in percent else 0}f}" == percent


@pytest.mark.parametrize(("segments", "tolerance"), [(4, 0.01), (8, 0.002)])
@pytest.mark.parametrize("kmh", [145, 200])
def test_smooth_reading_is_near_the_beam_at_the_middle(segments, tolerance, kmh):
    limit = a_wrms(BEAM, kmh, floor="smooth")
    assert a_wrms(paper_coach(segments), kmh, floor="smooth") == pytest.approx(limit, rel=tolerance)


@pytest.mark.parametrize("kmh", [145, 200])
def test_smooth_reading_off_the_middle_is_low_with_four_segments(kmh):
    limit = a_wrms(BEAM, kmh, 4.0, "smooth")
    error = 100 * (a_wrms(paper_coach(4), kmh, 4.0, "smooth") / limit - 1)
    assert -6.1 < error < -3.8


def test_the_beam_has_converged():
    for at in (0.0, 4.0):
        coarse, fine = (a_wrms(model, 145, at, "smooth") for model in (paper_coach(16), BEAM))
        assert coarse == pytest.approx(fine, rel=5e-4)


@pytest.mark.parametrize(
    ("model", "at"),
    [(paper_coach(4), 0.0), (paper_coach(4), 6.0), (random_model(0, 4), 2.0),
     (random_model(1, 1), -5.0)],
    ids=["middle", "off it", "random flexible", "random rigid"],
)  # fmt: skip
@pytest.mark.parametrize("name", ["erri_low", "fra_4", "sncf_good", "china_ballastless"])
def test_quadrature_has_converged(model, at, name, monkeypatch):
    """Off the middle bending 2 has a damping ratio of 2e-6; half the panels, twice the points."""
    wanted = spectrum(name)
    here = stochastic_ride(model, 40.0, wanted, [at])
    monkeypatch.setattr(stochastic, "REACH", 0.5)
    monkeypatch.setattr(stochastic, "GAUSS_POINTS", 28)
    there = stochastic_ride(model, 40.0, wanted, [at])
    for value in ("a_rms", "a_wrms", "wz", "variance_time"):
        np.testing.assert_allclose(getattr(here, value), getattr(there, value), rtol=1e-9)


@pytest.mark.parametrize("segments", [1, 4])
def test_integral_equals_scipys_with_the_resonances_named(segments):
    model = paper_coach(segments, bending_damping=0.01)
    V, W, S = 200 * KMH, weighting("Wk"), temporal(LOW, 200 * KMH)
    outputs = [model.floor(4.0, "polygon")]

    def integrand(f):
        H = track_response(model, outputs, V, [f])[0, 0]
        return float(abs(H * W.response(f)) ** 2 * S(f))

    marks = [0.05, *sorted(m.frequency_hz for m in modes(model)), 80.0]
    total = sum(
        scipy.integrate.quad(integrand, a, b, epsrel=1e-8, limit=100)[0]
        for a, b in itertools.pairwise(marks)
        if b - a > 1e-9
    )
    assert a_wrms(model, 200, 4.0) == pytest.approx(np.sqrt(total), rel=1e-7)


@pytest.mark.parametrize("zeta", [0.3, 0.01, 1e-4, 2e-6])
def test_panels_resolve_a_resonance_of_any_damping(zeta):
    """∫ df/|1 - (f/f_0)² + 2iζ f/f_0|² over all f: f_0 π/(4ζ), with what the ends leave out."""
    f_0 = 7.0
    poles = f_0 * np.array([1, -1]) * np.sqrt(1 - zeta**2) + 1j * f_0 * zeta
    f, df = gauss_points(graded_panels([1e-6, 1e5], poles, 1e4))
    found = df @ (1 / np.abs(1 - (f / f_0) ** 2 + 2j * zeta * f / f_0) ** 2)
    assert found + 1e-6 == pytest.approx(f_0 * np.pi / (4 * zeta), rel=1e-11)


def test_panels_are_no_longer_than_from_the_poles_nor_than_a_period():
    poles = np.array([3.0 + 0.01j, 40.0 + 5.0j])
    edges = graded_panels([0.05, 20.0, 80.0], poles, 2.0)
    assert edges[0] == 0.05
    assert edges[-1] == 80.0
    assert 20.0 in edges
    for a, b in itertools.pairwise(edges):
        nearest = np.clip(poles.real, a, b)
        assert b - a <= min(2.0, np.abs(poles - nearest).min()) * (1 + 1e-12)


def test_gauss_points_are_exact_for_polynomials():
    f, df = gauss_points(np.array([0.0, 0.3, 2.0]))
    assert df @ f**27 == pytest.approx(2.0**28 / 28, rel=1e-12)


def test_white_velocity_equals_lyapunovs_equation(monkeypatch):
    """S(Ω) ∝ 1/Ω² makes ẇ white; so fast that all wheelsets are as good as at one place.

    x = (q - u₀ w, q̇), x' = A x + B ẇ: its covariance solves A X + X Aᵀ + π c V B Bᵀ = 0, and the
    floor's acceleration is a row of A x, the dampers of the track acting on the bogies alone.
    """
    monkeypatch.setattr(stochastic, "BAND_HZ", (1e-6, 1e7))
    model, V, c = paper_coach(3, bending_damping=0.02), 1e12, 1e-19
    white = Spectrum("white velocity", "here", "m^2/(rad/m)", "one-sided", lambda O: c / O**2,  # noqa: E741
                     poles=(0j,))  # fmt: skip
    found = stochastic_ride(model, V, white, [0.0, 5.0], floor="smooth").a_rms
    m = model.matrices()
    n = len(m.M)
    A = np.block([[np.zeros((n, n)), np.eye(n)],
                  [-np.linalg.solve(m.M, m.K), -np.linalg.solve(m.M, m.C)]])  # fmt: skip
    B = np.concatenate([-m.lift, np.linalg.solve(m.M, m.C_w.sum(axis=1))])[:, np.newaxis]
    X = scipy.linalg.solve_continuous_lyapunov(A, -np.pi * c * V * B @ B.T)
    rows = model.output_rows([model.floor(x, derivative=0) for x in (0.0, 5.0)])["d"] @ A[n:]
    np.testing.assert_allclose(found, np.sqrt(np.diag(rows @ X @ rows.T)), rtol=1e-5)


def test_rms_grows_with_the_root_of_the_spectrum():
    high = stochastic_ride(paper_coach(2), 40.0, spectrum("erri_high"))
    low = stochastic_ride(paper_coach(2), 40.0, LOW)
    ratio = np.sqrt(1.080e-6 / 4.032e-7)
    np.testing.assert_allclose(high.a_wrms / low.a_wrms, ratio, rtol=1e-12)
    np.testing.assert_allclose(high.a_rms / low.a_rms, ratio, rtol=1e-12)
    np.testing.assert_allclose(high.wz / low.wz, ratio**0.3, rtol=1e-12)
    np.testing.assert_allclose(high.variance_time, low.variance_time, rtol=1e-12)


def test_weighting_takes_away():
    ride = stochastic_ride(paper_coach(4), 40.0, LOW, [0.0, 8.0])
    assert (ride.a_wrms < ride.a_rms * 1.06).all()  # W_k is at most 1.06
    assert ride.positions == (0.0, 8.0)


def test_a_symmetric_coach_at_mirrored_points_differs_by_its_running_direction_only():
    """Front and rear feel the same track later: with undamped suspensions they would be equal."""
    model = paper_coach(1)
    ahead, behind = (a_wrms(model, 145, at, c_1=300.0, c_2=700.0) for at in (5.0, -5.0))
    assert ahead == pytest.approx(behind, rel=0.02)
    assert ahead != behind


@pytest.mark.parametrize("kmh", [145, 200])
def test_scatter_of_one_kilometre(kmh):
    """A standard deviation of 13 to 14 % between runs over independent tracks."""
    ride = stochastic_ride(paper_coach(2), kmh * KMH, LOW, floor="polygon")
    relative = float(ride.standard_error(1000 / (kmh * KMH))[0] / ride.a_wrms[0])
    assert 0.125 < relative < 0.145
    quarter = float(ride.standard_error(250 / (kmh * KMH))[0] / ride.a_wrms[0])
    assert quarter == pytest.approx(2 * relative)


def test_scatter_is_that_of_the_weighted_spectrum():
    """½ √(∫ S² df / T)/∫ S df (Bendat and Piersol, Random Data, Eq 8.49), by Simpson's rule."""
    model, V, W = paper_coach(1), 40.0, weighting("Wk")
    ride = stochastic_ride(model, V, LOW)
    f = np.linspace(0.05, 80.0, 200_001)
    H = track_response(model, [model.floor()], V, f)[0]
    S = np.abs(H * W.response(f)) ** 2 * temporal(LOW, V)(f)
    square, fourth = (scipy.integrate.simpson(S**k, x=f) for k in (1, 2))
    assert float(ride.a_wrms[0]) == pytest.approx(np.sqrt(square), rel=1e-6)
    expected = 0.5 * np.sqrt(fourth / 25.0) / square
    assert float(ride.standard_error(25.0)[0] / ride.a_wrms[0]) == pytest.approx(expected, rel=1e-6)


def test_a_spectrum_counts_within_its_band_only():
    """S over 2 to 40 m; at 40 m/s 1 to 20 Hz: the rest adds nothing."""
    good, V = spectrum("sncf_good"), 40.0
    inside = float(stochastic_ride(paper_coach(2), V, good).a_rms[0])
    f = np.linspace(1.0, 20.0, 400_001)
    H = track_response(paper_coach(2), [paper_coach(2).floor()], V, f)[0]
    power = scipy.integrate.simpson(np.abs(H) ** 2 * temporal(good, V)(f), x=f)
    assert inside == pytest.approx(np.sqrt(power), rel=1e-6)
    wider = float(stochastic_ride(paper_coach(2), V, good.extrapolated()).a_rms[0])
    assert wider > inside


def test_a_spectrum_out_of_reach_is_refused():
    with pytest.raises(InputError, match=r"sncf_good.*km/h"):
        stochastic_ride(paper_coach(1), 0.05, spectrum("sncf_good"))


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan])
def test_speeds_that_are_none_are_refused(speed):
    with pytest.raises(InputError, match="speed"):
        stochastic_ride(paper_coach(1), speed, LOW)


def test_unstable_vehicles_and_points_off_the_body_are_refused():
    with pytest.raises(InputError, match="unstable"):
        stochastic_ride(paper_coach(2), 40.0, LOW, c_2=-5e3)
    with pytest.raises(InputError, match="position"):
        stochastic_ride(paper_coach(2), 40.0, LOW, [13.0])


def test_many_segments_stay_exact():
    """N = 48: poles up to thousands of hertz do no harm."""
    found = a_wrms(paper_coach(48), 145, floor="smooth")
    assert found == pytest.approx(a_wrms(BEAM, 145, floor="smooth"), rel=1e-4)


def test_the_bogies_own_damping_of_the_body_is_its_reading():
    """A vehicle with its own file gives what the same numbers changed by hand give."""
    vehicle = load_vehicle("cati2024")
    bogies = tuple(replace(b, secondary_damping=40e3) for b in vehicle.bogies)
    softer = replace(vehicle, bogies=bogies)
    assert a_wrms(derive_vehicle(softer, 2), 145) == pytest.approx(
        a_wrms(paper_coach(2), 145, c_2=40e3), rel=1e-12
    )
