"""The exact comfort value: published figures, scipy's quadrature, Lyapunov's equation."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import scipy.integrate
import scipy.linalg
import scipy.signal
from vehicles import paper_coach, random_model

from railride import plots
from railride.comfort.third_octaves import band_edges
from railride.errors import InputError
from railride.frequency import track_response
from railride.modal import modes
from railride.parameters import load_vehicle
from railride.spectra import Spectrum, spectrum, temporal
from railride.stochastic import (
    comfort_map,
    expected_peak,
    measured_spectrum,
    mode_shares,
    output_statistics,
    process,
    quadrature,
    ride,
    stochastic_ride,
    third_octaves,
    weighted_rms,
)
from railride.stochastic.extremes import low_pass
from railride.stochastic.gains import PLAIN, sperling, weighted
from railride.stochastic.quadrature import gauss_points, graded_panels
from railride.stochastic.ride import floor_in_hand
from railride.track import Track, synthesise
from railride.trackfile import read_track, write_track
from railride.vehicle import derive_vehicle
from railride.weightings import weighting

KMH = 1 / 3.6
LOW = spectrum("erri_low")


def quadrature_of(model, speed, at, of=LOW):
    """The integrals of a ride's three values: unweighted, W_k, Sperling's."""
    m, rows = floor_in_hand(model, at, "smooth", {})
    gains = (PLAIN, weighted(weighting("Wk")), sperling())
    return process(m, rows, model.vehicle.wheelset_positions, speed, of, gains).integrals()


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
    here = quadrature_of(model, 40.0, [at], spectrum(name))
    monkeypatch.setattr(quadrature, "REACH", 0.5)
    monkeypatch.setattr(quadrature, "GAUSS_POINTS", 28)
    there = quadrature_of(model, 40.0, [at], spectrum(name))
    np.testing.assert_allclose(here.mean_square, there.mean_square, rtol=1e-9)
    np.testing.assert_allclose(here.squares, there.squares, rtol=1e-9)


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
        reach = quadrature.REACH * np.abs(poles - nearest).min() * (1 + 1e-9)
        assert b - a <= min(2.0, reach) * (1 + 1e-12)


def test_gauss_points_are_exact_for_polynomials():
    f, df = gauss_points(np.array([0.0, 0.3, 2.0]))
    assert df @ f**23 == pytest.approx(2.0**24 / 24, rel=1e-12)


def test_white_velocity_equals_lyapunovs_equation():
    """S(Ω) ∝ 1/Ω² makes ẇ white; so fast that all wheelsets are as good as at one place.

    x = (q - u₀ w, q̇), x' = A x + B ẇ: its covariance solves A X + X Aᵀ + π c V B Bᵀ = 0, and the
    floor's acceleration is a row of A x, the dampers of the track acting on the bogies alone.
    """
    model, V, c = paper_coach(3, bending_damping=0.02), 1e12, 1e-19
    white = Spectrum("white velocity", "here", "m^2/(rad/m)", "one-sided", lambda O: c / O**2,  # noqa: E741
                     poles=(0j,))  # fmt: skip
    found = stochastic_ride(model, V, white, [0.0, 5.0], band=(1e-6, 1e7)).a_rms
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


# The stated error


@pytest.mark.parametrize("speed", [10.0, 40.0, 100.0])
@pytest.mark.parametrize(("reach", "points"), [(1.5, 6), (1.5, 8), (3.0, 8), (6.0, 8), (8.0, 12)])
def test_the_stated_error_bounds_the_true_one(speed, reach, points, monkeypatch):
    """Rules that are too coarse, against one that is finer than need be."""
    model, at = paper_coach(4), [0.0, 6.0]
    monkeypatch.setattr(quadrature, "REACH", 0.5)
    monkeypatch.setattr(quadrature, "GAUSS_POINTS", 24)
    exact = quadrature_of(model, speed, at).mean_square
    monkeypatch.setattr(quadrature, "REACH", reach)
    monkeypatch.setattr(quadrature, "GAUSS_POINTS", points)
    coarse = quadrature_of(model, speed, at)
    assert (np.abs(coarse.mean_square / exact - 1) < coarse.error).all()


def test_the_stated_error_is_small():
    """The lightest mode, ζ = 2e-6, included."""
    for model, at in ((paper_coach(1), 5.0), (paper_coach(4), 6.0), (random_model(0, 4), 2.0)):
        for speed in (20.0, 55.0):
            ride = stochastic_ride(model, speed, LOW, [at])
            for error in (ride.a_rms_error, ride.a_wrms_error, ride.wz_error):
                assert error.max() < 1e-8
            assert not ride.remarks
            assert quadrature_of(model, speed, [at]).error.max() < 1e-7


def test_an_uncertain_value_is_remarked_on(monkeypatch):
    model, at = paper_coach(2), [0.0, 6.0]
    assert not stochastic_ride(model, 40.0, LOW, at).remarks
    monkeypatch.setattr(ride, "STATED", 1e-20)
    remarks = stochastic_ride(model, 40.0, LOW, at).remarks
    assert len(remarks) == 6
    assert "144 km/h, 6 m: the integral of a_wrms is uncertain by" in remarks[3]


def test_the_values_in_hand_are_those_of_the_ride():
    model = paper_coach(4)
    rows = model.output_rows([model.floor(x) for x in (0.0, 6.0)])
    found, error = weighted_rms(model.matrices(), rows, model.vehicle.wheelset_positions, 40.0,
                                LOW, weighting("Wk"))  # fmt: skip
    ride = stochastic_ride(model, 40.0, LOW, [0.0, 6.0])
    np.testing.assert_allclose(found, ride.a_wrms, rtol=1e-10)
    assert error.shape == (2,)


# Vehicles without damping


@pytest.mark.parametrize("segments", [1, 2, 8, 16])
def test_an_undamped_vehicle_has_no_stationary_ride(segments):
    for at in (0.0, 6.0):
        with pytest.raises(InputError, match=r"without damping.*stationary"):
            stochastic_ride(paper_coach(segments), 40.0, LOW, [at], c_1=0.0, c_2=0.0)


def test_an_undamped_mode_counts_where_it_is_felt_only():
    """Without c_1 nothing damps the bogies' pitch, which the body's springs do not feel."""
    model, without = paper_coach(2), {"c_1": 0.0}
    (pitch, _) = [m for m in modes(model, **without) if m.label == "bogie pitch"]
    assert pitch.damping_ratio < 1e-12
    ride = stochastic_ride(model, 40.0, LOW, [0.0, 6.0], **without)
    nearly = stochastic_ride(model, 40.0, LOW, [0.0, 6.0], c_1=1e-3)
    np.testing.assert_allclose(ride.a_wrms, nearly.a_wrms, rtol=1e-6)
    assert not ride.remarks
    with pytest.raises(InputError, match=r"without damping \(14.07 Hz\)"):
        output_statistics(model, 40.0, LOW, ["primary_1_deflection"], **without)


# Third octaves


@pytest.mark.parametrize(("model", "at"), [(paper_coach(4), 6.0), (random_model(1, 2), -3.0)])
def test_squares_of_third_octaves_add_up(model, at):
    table = third_octaves(model, 40.0, LOW, [0.0, at])
    edges = band_edges()
    whole = stochastic_ride(model, 40.0, LOW, [0.0, at], band=(edges[0], edges[-1]))
    squares = table.groupby("position [m]", sort=False)[["a_rms [m/s^2]", "a_wrms [m/s^2]"]].agg(
        lambda a: (a**2).sum()
    )
    np.testing.assert_allclose(squares["a_rms [m/s^2]"], whole.a_rms**2, rtol=1e-10)
    np.testing.assert_allclose(squares["a_wrms [m/s^2]"], whole.a_wrms**2, rtol=1e-10)


def test_third_octaves_are_those_of_iec_61260():
    table = third_octaves(paper_coach(1), 40.0, LOW)
    names = "0.1 0.125 0.16 0.2 0.25 0.315 0.4 0.5 0.63 0.8 1 1.25 1.6 2 2.5 3.15 4 5 6.3 8 10 12.5"
    names += " 16 20 25 31.5 40 50 63 80"
    assert table["band [Hz]"].tolist() == [float(name) for name in names.split()]
    middle = table["midband [Hz]"].to_numpy()
    # IEC 61260-1 Annex E: 10^(3n/30): 3.1623 Hz is called 3.15, 79.433 Hz is called 80.
    assert middle[15] == pytest.approx(3.1623, abs=5e-5)
    assert middle[-1] == pytest.approx(79.433, abs=5e-4)
    edges = band_edges()
    np.testing.assert_allclose(edges[1:] / edges[:-1], 10**0.1)
    np.testing.assert_allclose(np.sqrt(edges[1:] * edges[:-1]), middle)


def test_a_third_octave_is_the_integral_over_its_band():
    model, V = paper_coach(1), 40.0
    table = third_octaves(model, V, LOW).set_index("band [Hz]")
    f = np.linspace(10**0.95, 10**1.05, 20_001)
    H = track_response(model, [model.floor()], V, f)[0]
    square = scipy.integrate.simpson(np.abs(H) ** 2 * temporal(LOW, V)(f), x=f)
    assert table.loc[10.0, "a_rms [m/s^2]"] == pytest.approx(np.sqrt(square), rel=1e-6)


def test_third_octaves_outside_a_spectrums_band_are_zero_and_told():
    table = third_octaves(paper_coach(1), 40.0, spectrum("sncf_good")).set_index("band [Hz]")
    assert table.loc[0.5, "a_rms [m/s^2]"] == 0
    assert table.loc[5.0, "a_rms [m/s^2]"] > 0
    assert "1 to 20 Hz" in table.attrs["remarks"][0]


# Along the car and over speed


def test_a_map_holds_what_single_rides_give():
    model, at, speeds = paper_coach(4), [-11.0, 0.0, 4.0], [10 * KMH, 145 * KMH, 400 * KMH]
    table = comfort_map(model, LOW, speeds, at)
    assert table["speed [km/h]"].tolist() == [10.0] * 3 + [145.0] * 3 + [400.0] * 3
    assert table["position [m]"].tolist() == at * 3
    for k, speed in enumerate(speeds):
        ride = stochastic_ride(model, speed, LOW, at)
        rows = table.iloc[3 * k : 3 * k + 3]
        np.testing.assert_allclose(rows["a_wrms [m/s^2]"], ride.a_wrms, rtol=1e-9)
        np.testing.assert_allclose(rows["a_rms [m/s^2]"], ride.a_rms, rtol=1e-9)
        np.testing.assert_allclose(rows["Wz"], ride.wz, rtol=1e-9)


def test_a_map_covers_the_whole_floor_by_default():
    table = comfort_map(paper_coach(1), LOW, [40.0])
    assert len(table) == 49
    assert table["position [m]"].iloc[[0, -1]].tolist() == [-12.0, 12.0]
    with pytest.raises(InputError, match="no speeds"):
        comfort_map(paper_coach(1), LOW, [])


def test_a_map_over_a_spectrum_with_a_band_says_so_once():
    table = comfort_map(paper_coach(1), spectrum("sncf_good"), [20.0, 40.0, 80.0], [0.0])
    (said,) = table.attrs["remarks"]
    assert "at 72 km/h 0.5 to 10 Hz, rising to 2 to 40 Hz at 288 km/h" in said


def test_comfort_is_drawn_along_the_car_over_speed_and_as_a_map():
    table = comfort_map(paper_coach(2), LOW, [30.0, 40.0, 50.0], [-12.0, 0.0, 6.0, 12.0])
    along = plots.plot_comfort_along(table)
    assert len(along.get_lines()) == 3
    first = table[table["speed [km/h]"] == 108.0]
    np.testing.assert_allclose(along.get_lines()[0].get_ydata(), first["a_wrms [m/s^2]"])
    over = plots.plot_comfort_over_speed(table, value="Wz")
    assert len(over.get_lines()) == 4
    assert "W" in over.get_ylabel()
    drawn = plots.plot_comfort_map(table)
    assert "km/h" in drawn.get_xlabel()
    assert any("m/s²" in axes.get_ylabel() for axes in drawn.figure.axes)


def test_comfort_that_cannot_be_drawn_is_refused():
    table = comfort_map(paper_coach(1), LOW, [40.0], list(range(-8, 8)))
    with pytest.raises(InputError, match="at most 8"):
        plots.plot_comfort_over_speed(table)
    with pytest.raises(InputError, match="at least two"):
        plots.plot_comfort_map(table)
    with pytest.raises(InputError, match="a_wrms"):
        plots.plot_comfort_along(table, value="colour")


# Suspension travel, wheel load, peaks


def test_a_mass_on_one_spring_has_the_closed_form():
    """∫₀^∞ S_0 df/|1 - (f/f_0)² + 2iζ f/f_0|²: σ² = S_0 π f_0/(4ζ) and ν = f_0 (Newland, 7.3)."""
    f_0, zeta = 3.0, 0.05
    poles = f_0 * np.array([1, -1]) * np.sqrt(1 - zeta**2) + 1j * f_0 * zeta
    f, df = gauss_points(graded_panels([1e-6, 1e6], poles, 1e6))
    S = 1 / np.abs(1 - (f / f_0) ** 2 + 2j * zeta * f / f_0) ** 2
    m_0, m_2 = S @ df, (f**2 * S) @ df
    assert m_0 == pytest.approx(np.pi * f_0 / (4 * zeta), rel=1e-6)
    assert np.sqrt(m_2 / m_0) == pytest.approx(f_0, rel=1e-5)


def test_expected_peak_is_that_of_simulated_processes():
    """200 Gaussian runs of each spectrum; the formula is right to a few percent."""
    rng, duration, step = np.random.default_rng(7), 100.0, 0.01
    n = round(duration / step)
    f = np.fft.rfftfreq(n, step)
    for f_0, zeta in ((2.0, 0.05), (5.0, 0.3)):
        S = 1 / np.abs(1 - (f / f_0) ** 2 + 2j * zeta * f / f_0) ** 2 * (f > 0) * (f < 40)
        m_0, m_2 = S.sum() / duration, (f**2 * S).sum() / duration
        c = rng.standard_normal((200, f.size)) + 1j * rng.standard_normal((200, f.size))
        y = np.fft.irfft(c * np.sqrt(S / duration) * n / 2, n, axis=-1)
        assert np.mean(y**2) == pytest.approx(m_0, rel=0.05)
        peak = float(expected_peak(np.sqrt(m_0), np.sqrt(m_2 / m_0), duration))
        assert y.max(axis=-1).mean() == pytest.approx(peak, rel=0.04)


def test_too_few_crossings_have_no_expected_peak():
    assert np.isnan(expected_peak(1.0, 1.0, 9.0))
    table = output_statistics(paper_coach(1), 40.0, LOW, ["secondary_1_deflection"], duration=1.0)
    assert table["expected peak"].isna().all()


def test_travel_is_the_integral_of_its_spectrum():
    model, V = paper_coach(2), 40.0
    table = output_statistics(model, V, LOW).set_index("output")
    name = "secondary_2_deflection"
    f = np.geomspace(0.05, 80.0, 400_001)
    S = np.abs(track_response(model, [name], V, f)[0]) ** 2 * temporal(LOW, V)(f)
    m_0, m_2 = (scipy.integrate.simpson(f**k * S, x=f) for k in (0, 2))
    row = table.loc[name]
    assert row["rms"] == pytest.approx(np.sqrt(m_0), rel=1e-6)
    assert row["zero up-crossings [1/s]"] == pytest.approx(np.sqrt(m_2 / m_0), rel=1e-6)
    times = np.sqrt(2 * np.log(np.sqrt(m_2 / m_0) * 25.0))
    expected = np.sqrt(m_0) * (times + 0.5772156649 / times)
    assert row["expected peak"] == pytest.approx(expected, rel=1e-6)
    longer = output_statistics(model, V, LOW, [name], duration=250.0)["expected peak"][0]
    assert longer > row["expected peak"]


def test_wheel_load_is_taken_after_a_low_pass_of_20_hz():
    vehicle = load_vehicle("cati2024")
    bogies = tuple(replace(b, wheelset_mass=1500.0) for b in vehicle.bogies)
    model, V = derive_vehicle(replace(vehicle, bogies=bogies), 2), 40.0
    table = output_statistics(model, V, LOW).set_index("output")
    row = table.loc["wheel_load_1"]
    assert row["low-pass [Hz]"] == 20.0
    assert table["low-pass [Hz]"].notna().sum() == 4
    f = np.geomspace(0.05, 80.0, 400_001)
    H = track_response(model, ["wheel_load_1"], V, f)[0]
    b, a = scipy.signal.butter(4, 2 * np.pi * 20.0, analog=True)
    H *= scipy.signal.freqs(b, a, 2 * np.pi * f)[1]
    square = scipy.integrate.simpson(np.abs(H) ** 2 * temporal(LOW, V)(f), x=f)
    assert row["rms"] == pytest.approx(np.sqrt(square), rel=1e-6)
    narrower = output_statistics(model, V, LOW, ["wheel_load_1"], corner=10.0)["rms"][0]
    assert narrower < row["rms"]


def test_missing_wheel_loads_are_told_where_they_were_expected():
    vehicle = load_vehicle("cati2024")
    first = replace(vehicle.bogies[0], wheelset_mass=1500.0)
    half = derive_vehicle(replace(vehicle, bogies=(first, *vehicle.bogies[1:])), 1)
    (remark,) = output_statistics(half, 40.0, LOW).attrs["remarks"]
    assert remark.startswith("no wheel loads of bogie 2: ")
    assert "bogie.wheelset_mass" in remark
    assert output_statistics(half, 40.0, LOW, "wheel_load_1").attrs["remarks"] == []


def test_the_low_pass_is_butterworths():
    f = np.array([1.0, 20.0, 40.0])
    b, a = scipy.signal.butter(4, 2 * np.pi * 20.0, analog=True)
    expected = np.abs(scipy.signal.freqs(b, a, 2 * np.pi * f)[1]) ** 2
    np.testing.assert_allclose(low_pass(20.0).power(f), expected, rtol=1e-9)
    np.testing.assert_allclose((low_pass(20.0).poles / 20.0) ** 8, -1, rtol=1e-9)


@pytest.mark.parametrize("given", [
    {"distance": 10.0, "duration": 1.0}, {"distance": -5.0}, {"distance": "x"}, {"duration": "x"},
    {"corner": 0.0}, {"outputs": ["wheel_load_9"]},
])  # fmt: skip
def test_statistics_that_are_none_are_refused(given):
    with pytest.raises(InputError):
        output_statistics(paper_coach(1), 40.0, LOW, **given)


# Shares of the modes


@pytest.mark.parametrize(
    ("model", "at"),
    [(paper_coach(1), 5.0), (paper_coach(4), 6.0), (random_model(0, 4), 2.0)],
    ids=["rigid", "paper", "random"],
)
def test_shares_of_the_modes_add_up_to_one(model, at):
    table = mode_shares(model, 40.0, LOW, [0.0, at])
    sums = table.groupby("position [m]")["share"].sum()
    np.testing.assert_allclose(sums, 1.0, rtol=1e-9)
    assert not table.duplicated(["position [m]", "mode"]).any()


def test_a_symmetric_body_feels_no_pitch_at_the_middle():
    shares = mode_shares(paper_coach(4), 200 * KMH, LOW).set_index("mode")["share"]
    assert abs(shares["pitch"]) < 1e-9
    assert abs(shares["bending 2"]) < 1e-9
    assert shares["bending 1"] > 0.9  # 9.59 Hz, its second geometric maximum near 200 km/h


def test_modal_parts_are_the_vehicles_response():
    """One mode's share is ∫ Re(H_k* H) S W²: from residues taken at the pole, numerically."""
    model, V = paper_coach(2, bending_damping=0.01), 40.0
    table = mode_shares(model, V, LOW).set_index("mode")["share"]
    (mode,) = [m for m in modes(model) if m.label == "bending 1"]
    root, output = mode.eigenvalue, [model.floor()]
    m = model.matrices()
    places = np.array(model.vehicle.wheelset_positions)
    row = model.output_rows(output)["a"][0]
    f = np.linspace(0.05, 80.0, 100_001)
    s = 2j * np.pi * f
    w = np.exp(-np.outer((places[0] - places) / V, s))
    # K + λC + λ²M is singular at λ: its adjoint's null vectors give the residue, M, C, K symmetric.
    phi = mode.shape
    norm = phi @ (2 * root * m.M + m.C) @ phi
    force = m.K_w @ w + s * (m.C_w @ w)
    part = 0
    for r, v, n in ((root, phi, norm), (root.conjugate(), phi.conj(), norm.conjugate())):
        part = part + (row @ v) * r**2 * (v @ force) / n / (s - r)
    H = track_response(model, output, V, f)[0]
    S = temporal(LOW, V)(f) * np.abs(weighting("Wk").response(f)) ** 2
    share = scipy.integrate.simpson((part.conj() * H).real * S, x=f)
    share /= scipy.integrate.simpson(np.abs(H) ** 2 * S, x=f)
    assert table["bending 1"] == pytest.approx(share, rel=1e-4)


# Measured tracks


@pytest.fixture(scope="module")
def sources(tmp_path_factory):
    """Tracks of every kind, each with the spectrum that exact values should come from."""
    road = synthesise(spectrum("erri_low"), 2000.0, 0.25, seed=3)
    file = tmp_path_factory.mktemp("tracks") / "road.csv"
    write_track(road, file)
    return {"name": ("sncf_good", spectrum("sncf_good")), "spectrum": (LOW, LOW),
            "track": (road, measured_spectrum(road)),
            "file": (file, measured_spectrum(read_track(file))),
            "text": (str(file), measured_spectrum(read_track(file)))}  # fmt: skip


@pytest.mark.parametrize("kind", ["name", "spectrum", "track", "file", "text"])
def test_any_kind_of_track_will_do(sources, kind):
    model, (track, expected) = paper_coach(2), sources[kind]

    def all_of(source):
        return [
            pd.DataFrame({"a_wrms": stochastic_ride(model, 40.0, source).a_wrms}),
            third_octaves(model, 40.0, source), mode_shares(model, 40.0, source),
            output_statistics(model, 40.0, source), comfort_map(model, source, 40.0, 0.0),
        ]  # fmt: skip

    for found, wanted in zip(all_of(track), all_of(expected), strict=True):
        pd.testing.assert_frame_equal(found, wanted)
    remarks = stochastic_ride(model, 40.0, track).remarks
    said = {"name": ["sncf_good holds wavelengths of 2 to 40 m"], "spectrum": []}
    for words in said.get(kind, ["exact values estimated from a Welch spectrum"]):
        assert any(words in remark for remark in remarks)
        for table in all_of(track)[1:]:
            assert any(words in remark for remark in table.attrs["remarks"])


def test_tracks_that_are_none_are_refused_in_words(tmp_path):
    for track in ("erri", tmp_path / "none.csv"):
        with pytest.raises(InputError, match=r"erri|none\.csv"):
            stochastic_ride(paper_coach(1), 40.0, track)
    with pytest.raises(InputError, match="speed: found 'fast'; expected a finite speed above zero"):
        stochastic_ride(paper_coach(1), "fast", LOW)
    with pytest.raises(InputError, match="found 'Wx'"):
        stochastic_ride(paper_coach(1), 40.0, LOW, weight="Wx")
    for track in (None, 5):
        with pytest.raises(InputError, match=f"track: found {track!r}; expected the name of a spe"):
            stochastic_ride(paper_coach(1), 40.0, track)
    with pytest.raises(InputError, match="found None; expected one of"):
        stochastic_ride(paper_coach(1), 40.0, LOW, weight=None)
    with pytest.raises(InputError, match="at: found 'x'"):
        third_octaves(paper_coach(1), 40.0, LOW, "x")


def test_a_measured_spectrum_recovers_the_value_within_its_uncertainty():
    """30 km of erri_low: a standard error of 2.6 %."""
    model, V = paper_coach(2), 200 * KMH
    for seed in (1, 2):
        measured = measured_spectrum(synthesise(LOW, 30_000.0, 0.25, seed))
        found = stochastic_ride(model, V, measured, floor="polygon")
        low, high = V / measured.band[1], V / measured.band[0]
        exact = stochastic_ride(model, V, LOW, floor="polygon", band=(low, high))
        error = found.standard_error(measured.effective_length / V)
        assert (error < 0.035 * exact.a_wrms).all()
        assert (np.abs(found.a_wrms - exact.a_wrms) < 3 * error).all()
        assert (found.a_wrms_error < 1e-6).all()


def test_measured_spectra_scatter_as_they_say():
    """100 tracks of 2 km: mean within its own scatter, deviation that of the effective length."""
    model, V = paper_coach(1), 200 * KMH
    values, said = [], []
    for seed in range(100):
        measured = measured_spectrum(synthesise(LOW, 2000.0, 0.5, seed))
        ride = stochastic_ride(model, V, measured)
        values.append(float(ride.a_wrms[0]) ** 2)
        said.append(float(ride.standard_error(measured.effective_length / V)[0]))
    band = (V / measured.band[1], V / measured.band[0])
    exact = stochastic_ride(model, V, LOW, band=band)
    mean, deviation = np.mean(values), np.std(values, ddof=1)
    assert abs(mean - exact.a_wrms[0] ** 2) < 3.3 * deviation / 10 + 0.01 * mean
    assert np.mean(said) * 2 * exact.a_wrms[0] == pytest.approx(deviation, rel=0.3)


def test_a_measured_spectrum_lies_on_welchs_lines_and_names_its_band():
    track = synthesise(LOW, 2000.0, 0.25, 3)
    measured = measured_spectrum(track)
    wavenumber, density = track.psd(250.0)
    inside = (wavenumber > 2 * np.pi / measured.band[1]) & (wavenumber < 2 * np.pi / 1.0)
    np.testing.assert_allclose(measured.density(wavenumber[inside]), density[inside], rtol=1e-9)
    assert measured.density(2 * np.pi / 0.9) == 0
    assert measured.segments == 14
    assert "14 segments of 250.25 m" in measured.remark
    assert "indicative" not in measured.remark
    short = measured_spectrum(synthesise(LOW, 150.0, 0.25, 3))
    assert "indicative" in short.remark
    limited = measured_spectrum(replace(track, band=(3.0, 25.0)))
    assert limited.band == (3.0, 25.0)


def test_a_track_too_short_for_a_spectrum_is_refused():
    with pytest.raises(InputError, match="no spectrum"):
        measured_spectrum(Track(0.0, 0.25, np.arange(9.0), "stub"))


@pytest.mark.parametrize("speed", [1e-300, 1e-4])
def test_a_speed_too_low_to_integrate_is_refused(speed):
    with pytest.raises(InputError, match="speed"):
        stochastic_ride(paper_coach(1), speed, spectrum("erri_low"))
