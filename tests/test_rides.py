"""Rides: time runs against scipy and against the exact stochastic value."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.signal
import scipy.stats
from vehicles import paper_coach, random_model

from railride.comfort import mtvv
from railride.errors import InputError
from railride.frequency import wheelset_delays
from railride.modal import modes
from railride.parameters import load_vehicle
from railride.rides import ride
from railride.spectra import spectrum
from railride.statespace import system_arrays
from railride.stochastic import measured_spectrum, stochastic_ride
from railride.timerun import run_in_time, time_run
from railride.track import Track, synthesise
from railride.trackfile import load_track
from railride.vehicle import derive_vehicle
from railride.weightings import apply_weighting, weighting

V = 200 / 3.6
WK = weighting("Wk")
LOW = spectrum("erri_low")


def run(model, track, speed=V, at=(0.0,), length=300.0, rate=1000.0, floor="smooth"):
    return time_run(model, speed, track, at, length=length, floor=floor, weight=WK, rate=rate)


def bump(centre, width=6.0, height=5e-3, length=900.0, step=0.05):
    x = step * np.arange(round(length / step) + 1)
    return Track(0.0, step, height * np.exp(-(((x - centre) / width) ** 2)), "bump")


# One run


@pytest.mark.parametrize(
    ("model", "at"),
    [(paper_coach(4), (0.0, 5.0)), (random_model(0, 2), (1.0,))],
    ids=["paper", "random"],
)
def test_acceleration_equals_scipys_lsim(model, at):
    """The same w and ẇ, linear between samples, at 1e-9 of the largest value."""
    track = replace(synthesise(spectrum("erri_low"), 900.0, 0.05, 3), distance0=-600.0)
    found = run(model, track, at=at)
    system = system_arrays(model, [model.floor(x) for x in at])
    x = track.end - 300.0 + V * (found.time - wheelset_delays(model, V)[:, np.newaxis])
    w, slope = track.elevation(x)
    u = np.vstack([w, V * slope, np.zeros((len(model.linear.forces), found.time.size))])
    m = model.matrices()
    rest = np.linalg.solve(m.K, m.K_w @ np.column_stack([w[:, 0], V * slope[:, 0]]))
    _, y, _ = scipy.signal.lsim((system.A, system.B, system.C, system.D), u.T,
                                found.time - found.time[0], X0=rest.T.ravel())  # fmt: skip
    y = y.reshape(found.time.size, -1).T
    assert np.abs(found.acceleration - y).max() < 1e-9 * np.abs(y).max()
    np.testing.assert_array_equal(found.elevation, w[0])


def test_wheelsets_meet_a_bump_at_their_own_time():
    """2.5 m at 145 km/h are 62.07 ms: no multiple of a sample, and not rounded to one."""
    model, speed = paper_coach(1), 145 / 3.6
    delays = wheelset_delays(model, speed)
    assert f"{1000 * delays[1]:.2f}" == "62.07"
    # Four runs with a bump that each time one wheelset alone meets within them are too many:
    # the response is the sum of four equal ones, each late by its wheelset's own delay.
    track = bump(600.0)
    found = run(model, track, speed, length=600.0, rate=997.0)
    system = system_arrays(model)
    t, centre = found.time, 600.0 - (track.end - 600.0)
    m, n = model.matrices(), 6
    total = np.zeros(t.size)
    for j, delay in enumerate(delays):
        s = speed * (t - delay) - centre
        w = 5e-3 * np.exp(-((s / 6.0) ** 2))
        dw = -2 * s / 36.0 * w * speed
        u = np.zeros((10, t.size))
        u[j], u[4 + j] = w, dw
        _, y, _ = scipy.signal.lsim((system.A, system.B, system.C, system.D), u.T, t - t[0])
        total += y.ravel()
    assert len(m.M) == n
    assert np.abs(found.acceleration[0] - total).max() < 1e-6 * np.abs(total).max()
    rounded = np.round(delays * 997.0) / 997.0
    assert np.abs(rounded - delays).max() * speed > 5e-3  # what rounding would have moved, m


def test_elevation_is_that_under_the_leading_wheelset():
    track = bump(700.0)
    found = run(paper_coach(1), track, length=300.0)
    t_top = found.time[np.argmax(found.elevation)]
    assert t_top == pytest.approx((700.0 - 600.0) / V, abs=1e-3)
    assert found.time[found.rated][0] == pytest.approx(0.0, abs=1e-12)
    assert found.time[-1] == pytest.approx(300.0 / V, abs=1e-3)


def test_nothing_moves_on_a_level_or_evenly_sloping_track():
    x = 0.1 * np.arange(9001)
    for level in (np.full_like(x, 0.02), 1e-3 * x):
        found = run(random_model(1, 4), Track(0.0, 0.1, level))
        assert np.abs(found.acceleration).max() < 1e-8


def test_half_the_step_changes_a_tenth_of_a_percent():
    model = paper_coach(2)
    coarse, fine = (
        ride(model, "erri_low", [V], length=500.0, rate=rate).cases[0].a_wrms
        for rate in (1000.0, 2000.0)
    )
    assert coarse == pytest.approx(fine, rel=1.5e-3)
    assert coarse != fine


def test_run_in_is_five_time_constants_of_the_slowest_mode_that_matters():
    for model in (paper_coach(1), paper_coach(4, bending_damping=0.01)):
        system = system_arrays(model)
        found, remark = run_in_time(model, system, V, WK)
        decays = [-m.eigenvalue.real for m in modes(model) if m.frequency_hz < 80]
        settling = 5 / np.array([*decays, *(-WK.poles().real)])
        assert remark is None
        assert found in [pytest.approx(s) for s in settling]
        assert found >= 5 / (-modes(model)[0].eigenvalue.real) * (1 - 1e-9)


def test_run_in_is_capped_where_bending_2_never_settles():
    """Off the middle, without structural damping: ζ of about 2e-6 at 25.5 Hz."""
    model = paper_coach(4)
    capped, remark = run_in_time(model, system_arrays(model, [model.floor(5.0)]), V, WK)
    assert capped == 10.0
    assert "25.5" in remark
    assert "10 s" in remark
    assert any("25.5" in r for r in ride(model, speeds=[V], at=[5.0], length=200.0).remarks)


# Tracks


def test_a_track_shorter_than_the_rated_length_is_refused():
    with pytest.raises(InputError, match=r"400 m.*500 m"):
        ride(paper_coach(1), bump(200.0, length=400.0), [V], length=500.0)


def test_a_measured_track_is_rated_over_its_last_metres_with_its_run_in():
    found = ride(paper_coach(1), bump(300.0), [V], length=400.0)
    (case,) = found.cases
    exact = stochastic_ride(paper_coach(1), V, measured_spectrum(bump(300.0)))
    assert case.a_wrms_exact == pytest.approx(float(exact.a_wrms[0]), rel=1e-12)
    assert any("Welch" in remark and "indicative" in remark for remark in found.remarks)
    assert case.record.time[0] < -1.0
    assert case.record.time[-1] == pytest.approx(400.0 / V, abs=1e-3)
    assert not any("taper" in remark for remark in found.remarks)


def test_a_measured_track_without_room_for_a_run_in_gets_a_taper_and_a_remark():
    level = synthesise(spectrum("erri_low"), 500.0, 0.1, 2).level
    found = ride(paper_coach(1), Track(0.0, 0.1, level, "yard"), [V], length=500.0)
    assert any("taper" in remark and "yard" in remark for remark in found.remarks)
    assert np.isfinite(found.cases[0].a_wrms)


def test_a_measured_track_tells_the_band_it_holds():
    track = replace(bump(300.0), band=(3.0, 25.0))
    remarks = ride(paper_coach(1), track, [145 / 3.6], length=300.0).remarks
    assert any("1.6" in remark and "13.4" in remark for remark in remarks)


def test_spectral_with_a_measured_track_uses_its_spectrum():
    track = synthesise(LOW, 3000.0, 0.25, 4)
    model = paper_coach(2)
    found = ride(model, replace(track, name="line"), [V], length=500.0, spectral=True)
    (case,) = found.cases
    exact = stochastic_ride(model, V, measured_spectrum(track))
    assert case.a_wrms == case.a_wrms_exact == pytest.approx(float(exact.a_wrms[0]), rel=1e-12)
    assert case.standard_error > 0
    assert case.record is None
    assert any("line: exact values estimated from a Welch spectrum" in r for r in found.remarks)
    assert any(
        "55.6 Hz; nothing outside" in remark for remark in found.remarks
    )  # 1 m to half a segment


def test_a_track_without_a_spectrum_has_no_exact_value():
    level = np.zeros(30)
    with pytest.raises(InputError, match="no spectrum"):
        ride(paper_coach(1), Track(0.0, 1.0, level[:12], "stub"), [V], spectral=True)
    coarse = Track(0.0, 5.0, np.sin(np.arange(30.0)), "coarse")
    found = ride(paper_coach(1), coarse, [0.5], length=100.0)
    assert found.cases[0].a_wrms_exact is None
    assert any("no exact value" in remark for remark in found.remarks)


def test_a_track_shorter_than_its_waves_is_trusted_nowhere():
    level = 1e-3 * np.sin(np.arange(12.0))
    track = Track(0.0, 0.25, level, "stub", band=(3.0, 25.0))
    remarks = ride(paper_coach(1), track, [10.0], length=2.0).remarks
    assert any("stub can be trusted at no frequency" in r for r in remarks)
    assert not any("trusted from" in r for r in remarks)
    whole = ride(paper_coach(1), bump(300.0), [10.0], length=400.0).remarks
    assert not any("at no frequency" in r for r in whole)


def test_one_seed_is_one_track_for_all_speeds_and_bodies():
    """The elevation over distance is the same, whatever runs over it."""
    shapes = []
    for model in (paper_coach(1), paper_coach(4)):
        for case in ride(model, speeds=[145 / 3.6, V], length=200.0, seed=5).cases:
            record = case.record
            x = case.speed * record.time[record.rated]
            shapes.append(np.interp(np.arange(5.0, 195.0, 0.5), x, record.elevation[record.rated]))
    scale = np.abs(shapes[0]).max()
    for other in shapes[1:]:
        assert np.abs(other - shapes[0]).max() < 2e-3 * scale
    other = ride(paper_coach(1), speeds=[V], length=200.0, seed=6).cases[0].record
    assert np.abs(other.elevation).max() != np.abs(shapes[0]).max()


def test_names_spectra_and_tracks_are_tracks(tmp_path):
    assert load_track("erri_low") is spectrum("erri_low")
    track = bump(300.0)
    assert load_track(track) is track
    with pytest.raises(InputError, match="erri_low"):
        load_track("erri_lo")
    with pytest.raises(InputError):
        load_track(tmp_path / "none.csv")


# Many runs


@pytest.mark.parametrize(
    ("segments", "damping", "at", "floor"),
    [(2, 0.0, 0.0, "polygon"), (4, 0.01, 5.0, "smooth")],
    ids=["middle", "off it"],
)
def test_mean_square_over_many_seeds_is_the_exact_value(segments, damping, at, floor):
    """40 runs of 1 km: the mean within 99.9 % of Student's t, the scatter of χ²."""
    model = paper_coach(segments, bending_damping=damping)
    exact = stochastic_ride(model, V, LOW, [at], floor=floor)
    squares = []
    for seed in range(1, 41):
        track = replace(synthesise(LOW, 1750.0, 0.05, seed), distance0=-750.0)
        (case,) = ride(model, track, [V], at=[at], floor=floor).cases
        squares.append(case.a_wrms**2)
    mean, deviation = np.mean(squares), np.std(squares, ddof=1)
    reach = scipy.stats.t.ppf(0.9995, len(squares) - 1) * deviation / np.sqrt(len(squares))
    assert abs(mean - exact.a_wrms[0] ** 2) < reach
    assert reach < 0.2 * exact.a_wrms[0] ** 2  # or it would show nothing
    # The standard error of a square is that of its root times twice the root.
    expected = 2 * exact.a_wrms[0] * exact.standard_error(1000.0 / V)[0]
    free = len(squares) - 1
    low, high = np.sqrt(scipy.stats.chi2.ppf([0.0005, 0.9995], free) / free)
    assert low < deviation / expected < high


def test_the_exact_value_stands_beside_the_runs():
    model = paper_coach(4)
    for case in ride(model, speeds=[145 / 3.6, V], at=[0.0, 3.0], length=500.0).cases:
        exact = stochastic_ride(model, case.speed, LOW, [case.position])
        assert case.a_wrms_exact == pytest.approx(float(exact.a_wrms[0]), rel=1e-12)
        error = float(exact.standard_error(500.0 / case.speed)[0])
        assert case.standard_error == pytest.approx(error, rel=2e-3)  # to a sample of time


def test_a_table_has_the_error_of_the_exact_values():
    result = ride(paper_coach(2), "erri_low", [V], length=200.0)
    assert result.table()["error of the exact"].tolist() == [result.cases[0].a_wrms_error]
    assert 0 < result.cases[0].a_wrms_error < 1e-6


def test_one_seed_is_repeated_exactly_and_another_differs():
    one, again, other = (
        ride(paper_coach(2), speeds=[V], length=300.0, seed=seed).cases[0].a_wrms
        for seed in (1, 1, 2)
    )
    assert one == again
    assert one != other


# Results


def test_cases_run_over_speeds_then_positions():
    found = ride(paper_coach(2), speeds=[40.0, 50.0], at=[0.0, 3.0, -3.0], length=200.0)
    assert [(c.speed, c.position) for c in found.cases] == [
        (40.0, 0.0), (40.0, 3.0), (40.0, -3.0), (50.0, 0.0), (50.0, 3.0), (50.0, -3.0),
    ]  # fmt: skip
    assert {c.body for c in found.cases} == {"segments"}
    table = found.table()
    assert len(table) == 6
    assert table["speed [km/h]"].tolist() == [144.0] * 3 + [180.0] * 3
    assert table["a_wrms [m/s^2]"].tolist() == [c.a_wrms for c in found.cases]
    alone = ride(paper_coach(2), speeds=[50.0], at=[3.0], length=200.0).cases[0]
    assert found.cases[4].a_wrms == pytest.approx(alone.a_wrms, rel=1e-6)


def test_record_holds_what_is_rated():
    case = ride(paper_coach(2), speeds=[V], length=400.0).cases[0]
    record = case.record
    rated = record.weighted[record.rated]
    assert np.sqrt(np.mean(rated**2)) == pytest.approx(case.a_wrms, rel=2e-3)
    felt = record.acceleration[record.rated]
    assert np.sqrt(np.mean(felt**2)) == pytest.approx(case.a_rms, rel=2e-2)
    assert record.time.shape == record.elevation.shape == record.weighted.shape


def test_a_ride_has_the_values_of_en_12299_on_its_floor():
    """Blocks of 5 s of the record weighted W_b of EN 12299, whatever the ride's own weighting."""
    found = ride(paper_coach(2), speeds=[V, 3 * V], length=1000.0)
    case, fast = found.cases
    record = case.record
    felt = apply_weighting("Wb_en12299", record.acceleration, 1000.0, before=0.0)[record.rated]
    expected = np.sqrt(np.mean(felt[:15_000].reshape(3, 5000) ** 2, axis=1))
    np.testing.assert_allclose(case.continuous.blocks, expected, rtol=1e-9)
    part = case.continuous.vertical_part
    assert part == pytest.approx(6 * np.percentile(expected, 95), rel=1e-9)
    named = {"EN 12299 continuous comfort", "EN 12299 mean comfort, vertical part",
             "UIC 513, vertical part"}  # fmt: skip
    assert named < set(case.levels)
    assert fast.continuous.blocks.size == 1
    assert sum("EN 12299: 1 to 3 blocks of 5 s" in remark for remark in found.remarks) == 1
    short = ride(paper_coach(2), speeds=[V], length=200.0).cases[0]
    assert short.continuous is None
    assert not named & set(short.levels)


def test_a_ride_is_weighted_once_and_rated_by_its_record():
    case = ride(paper_coach(2), speeds=[V], length=400.0, weight="Wb").cases[0]
    expected = apply_weighting("Wb", case.record.acceleration, 1000.0, before=0.0)
    np.testing.assert_allclose(case.record.weighted, expected, atol=1e-12)
    rated = expected[case.record.rated]
    assert case.mtvv_exp == pytest.approx(float(mtvv(rated, 1000.0, kind="exponential")), rel=1e-9)


def test_spectral_gives_the_exact_value_alone():
    found = ride(paper_coach(2), speeds=[145 / 3.6, V], floor="polygon", spectral=True)
    assert [f"{c.a_wrms:.4f}" for c in found.cases] == ["0.2475", "0.3275"]
    assert all(c.record is None and c.mtvv is None and c.vdv is None for c in found.cases)
    assert all(c.a_wrms == c.a_wrms_exact for c in found.cases)


def test_levels_of_the_papers_table_3():
    """Below 0.2, 0.3 and 0.4 m/s²."""
    found = ride(paper_coach(2), speeds=[145 / 3.6, V], floor="polygon", spectral=True)
    rigid = ride(paper_coach(1), speeds=[V], spectral=True).cases[0]
    assert len({found.cases[0].level, found.cases[1].level, rigid.level}) == 3
    assert found.cases[0].levels


def test_the_vehicles_remarks_go_with_the_result():
    model = paper_coach(1, bending_frequency=9.0)
    found = ride(model, speeds=[V], spectral=True)
    assert set(model.vehicle.remarks) <= set(found.remarks)
    assert set(model.remarks) <= set(found.remarks)
    assert len(set(found.remarks)) == len(found.remarks)


def test_a_spectrum_with_a_band_tells_what_it_covers():
    found = ride(paper_coach(2), "sncf_good", [40.0], length=200.0)
    assert any("1 to 20 Hz" in remark for remark in found.remarks)


def test_progress_ends_at_one():
    told = []
    ride(paper_coach(1), speeds=[40.0, 50.0], length=200.0, progress=told.append)
    assert told == sorted(told)
    assert told[-1] == 1.0


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"speeds": [0.0]}, ["speed", "0 km/h"]),
        ({"speeds": [-10.0]}, ["speed", "-36 km/h"]),
        ({"speeds": [np.nan]}, ["speed"]),
        ({"speeds": []}, ["speeds", "at least one"]),
        ({"at": []}, ["at", "at least one"]),
        ({"at": [13.0]}, ["position 13 m"]),
        ({"length": 0.0}, ["length"]),
        ({"length": np.inf}, ["length"]),
        ({"rate": -1.0}, ["rate"]),
        ({"seed": -1}, ["seed"]),
        ({"seed": 1.5}, ["seed"]),
        ({"floor": "carpet"}, ["floor", "smooth"]),
        ({"weight": "Wz"}, ["Wz", "Wk"]),
        ({"track": "erri"}, ["erri_low"]),
    ],
    ids=lambda v: str(v) if isinstance(v, dict) else "",
)
def test_bad_arguments_are_refused(given, words):
    with pytest.raises(InputError) as raised:
        ride(paper_coach(1), **{"speeds": [V], "length": 100.0} | given)
    assert all(word in str(raised.value) for word in words), raised.value


def test_all_bad_numbers_are_told_together():
    with pytest.raises(InputError) as raised:
        ride(paper_coach(1), speeds=[-1.0], length=-5.0, rate=0.0)
    assert len(str(raised.value).splitlines()) == 3


def test_an_unstable_vehicle_is_refused():
    model = paper_coach(2)
    with pytest.raises(InputError, match="unstable"):
        run_in_time(_Growing(), system_arrays(model), V, WK)


class _Growing:
    """A model whose suspension feeds energy in."""

    def matrices(self):
        return paper_coach(2).matrices(c_2=-5e3)


def test_a_changed_model_rides_as_the_changed_vehicle_does():
    """Nothing is derived again, and the value is that of a file with the other stiffness."""
    coach = load_vehicle("cati2024")
    soft = tuple(replace(bogie, secondary_stiffness=6e5) for bogie in coach.bogies)
    derived, base = derive_vehicle(replace(coach, bogies=soft), 2), derive_vehicle(coach, 2)
    changed = base.changed(secondary_stiffness=6e5)
    values = [ride(model, speeds=40.0).cases[0].a_wrms for model in (derived, changed)]
    assert values[0] == pytest.approx(values[1], rel=1e-12)
    assert changed.linear is base.linear
    with pytest.raises(InputError, match="secondary_stiffness"):
        changed.changed(secondary_stifness=1.0)


def test_remarks_name_the_rated_section_and_what_a_coarse_track_misses(tmp_path):
    x = np.arange(0, 1500.1, 5.0)
    track = Track(0.0, 5.0, 1e-3 * np.sin(x / 9), name="coarse.csv")
    said = " | ".join(ride(derive_vehicle(load_vehicle("cati2024"), 1), track, 40.0).remarks)
    assert "500 to 1500 m of 1500 m" in said
    assert "2 Hz only" in said


@pytest.mark.parametrize("speeds", ["fast", [[1, 2], [3]], object()])
def test_speeds_that_are_no_numbers_are_refused(speeds):
    with pytest.raises(InputError, match="speeds"):
        ride(derive_vehicle(load_vehicle("cati2024"), 1), speeds=speeds)
