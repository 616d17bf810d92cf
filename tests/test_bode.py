"""Bode studies: records, geometric zeros, the picture and the command."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from vehicles import paper_coach, random_model

from railride.bodes import bode, geometric_zeros
from railride.errors import InputError
from railride.frequency import frequency_response, track_response
from railride.plots import plot_bode, save
from railride.vehicle import derive_vehicle

V = 200 / 3.6


# records


def test_speeds_outer_positions_inner():
    model, f = paper_coach(2), [1.0, 2.0, 9.6]
    found = bode(model, [40.0, V], f, at=[0.0, 4.0], floor="polygon")
    assert [(r.speed, r.position) for r in found] == [(40.0, 0.0), (40.0, 4.0), (V, 0.0), (V, 4.0)]
    for r in found:
        H = track_response(model, [model.floor(r.position, "polygon")], r.speed, f)[0]
        assert_allclose(r.H, H, rtol=1e-12)
        assert_allclose(r.magnitude * np.exp(1j * np.radians(r.phase_deg)), H, rtol=1e-12)
        assert r.output.unit == "m/s^2"


def test_the_band_of_a_ride_unless_another_is_given():
    (found,) = bode(paper_coach(1), [V])
    assert (found.frequency[0], found.frequency[-1], found.frequency.size) == (0.2, 40.0, 2000)


def test_phases_lie_above_minus_180_and_reach_180():
    (found,) = bode(paper_coach(1), [V], [1.0, 2.0, 3.0, 4.0])
    turned = replace(found, H=np.array([complex(-1, -0.0), -1 + 0j, -1j, 0j]))
    assert_array_equal(turned.phase_deg, [180.0, 180.0, -90.0, np.nan])


def test_a_slow_wave_lifts_the_car_and_accelerates_it_half_a_turn_ahead():
    """z follows w with the way from the leading wheelset (10 m ahead), and z̈ = -ω² z."""
    f = [1e-3]
    (height,) = bode(paper_coach(4), [V], f, outputs="floor_displacement")
    (acceleration,) = bode(paper_coach(4), [V], f)
    assert_allclose(height.magnitude, 1.0, rtol=1e-4)
    assert_allclose(height.phase_deg, -360 * 1e-3 * 10 / V, rtol=1e-3)
    assert_allclose(acceleration.magnitude, (2e-3 * np.pi) ** 2, rtol=1e-4)
    assert_allclose(acceleration.phase_deg, 180 + height.phase_deg, rtol=1e-9)


def test_one_speed_and_one_point_need_no_list():
    (listed,) = bode(paper_coach(1), [V], [1.0], at=[3.0])
    (plain,) = bode(paper_coach(1), V, [1.0], at=3.0)
    assert_array_equal(plain.H, listed.H)


def test_a_point_may_be_asked_for_twice():
    first, second = bode(paper_coach(1), [V], [1.0], at=[0.0, 0.0])
    assert_array_equal(first.H, second.H)


def test_a_table_with_units():
    (found,) = bode(paper_coach(1), [V], [1.0, 2.0])
    assert list(found.table()) == ["frequency [Hz]", "magnitude [(m/s^2)/m]", "phase [deg]"]
    assert_array_equal(found.table()["magnitude [(m/s^2)/m]"], found.magnitude)


@pytest.mark.parametrize(
    ("speeds", "more", "message"),
    [
        ([], {}, "speeds: found none"),
        ("fast", {}, "speeds: found 'fast'; expected numbers, in m/s"),
        ([None], {}, "speed"),
        ([V], {"at": "middle"}, "at: found 'middle'; expected numbers, in m"),
        ([V, 0.0], {}, "speed"),
        ([V], {"at": []}, "at: found none"),
        ([V], {"at": [13.0]}, "off the body"),
        ([V], {"frequency": [2.0, 1.0]}, "ascending"),
        ([V], {"frequency": [0.0, 1.0]}, "above zero"),
        ([V], {"floor": "carpet"}, "smooth"),
        (None, {}, "speed: found none"),
        (
            [V],
            {"outputs": "bogie_3_acceleration"},
            "found 'bogie_3_acceleration'; expected one of floor_acceleration, floor_velocity, .*",
        ),
        ([V], {"source": ["track", "w_9"]}, "found 'w_9'; expected one of track, w_1, .*, f_2"),
        ([V], {"source": []}, "source: found none"),
        ([V], {"outputs": ()}, "outputs: found none"),
    ],
)
def test_bad_input_is_refused(speeds, more, message):
    with pytest.raises(InputError, match=message):
        bode(paper_coach(2), speeds, **more)


def test_sources_outer_then_speeds_outputs_and_points():
    model, f = paper_coach(2), [1.0, 9.6]
    found = bode(model, [40.0, V], f, at=[0.0, 4.0], source=["track", "w_3", "f_1"],
                 outputs=["floor_velocity", "bogie_2_acceleration"])  # fmt: skip
    moved = [(s, v) for s, v in (("track", 40.0), ("track", V), ("w_3", None), ("f_1", None))]
    felt = [("floor_velocity", 0.0), ("floor_velocity", 4.0), ("bogie_2_acceleration", None)]
    assert [(r.source, r.speed, r.signal, r.position) for r in found] == [
        (*m, *o) for m in moved for o in felt
    ]
    for r in found:
        output = r.signal if r.position is None else model.floor(r.position, derivative=1)
        H = frequency_response(model, output, f, speed=r.speed, source=r.source)
        assert_allclose(r.H, H.frdata[0, 0], rtol=1e-12)
        assert r.unit == ("(m/s)" if r.position is not None else "(m/s^2)") + (
            "/N" if r.source == "f_1" else "/m"
        )
        assert r.source == "track" or not r.zeros


# geometric zeros


@pytest.mark.parametrize("segments", [1, 4, 7])
def test_zeros_of_the_coach_at_200_kmh(segments):
    """1.587 Hz (17.5 m) and 11.11 Hz (2.5 m), and odd multiples of them."""
    spacing, wheelbase = geometric_zeros(paper_coach(segments), paper_coach(segments).floor(),
                                         V, 40.0)  # fmt: skip
    assert (spacing.cause, spacing.distance) == ("bogie spacing", 17.5)
    assert (wheelbase.cause, wheelbase.distance) == ("wheelbase", 2.5)
    assert_allclose(spacing.frequency, 1.5873015873 * np.arange(1, 26, 2), rtol=1e-9)
    assert_allclose(wheelbase.frequency, 11.1111111111 * np.array([1, 3]), rtol=1e-9)


def test_off_the_middle_only_the_wheelbase_cancels():
    model = paper_coach(4)
    assert [z.cause for z in geometric_zeros(model, model.floor(4.0), V, 40.0)] == ["wheelbase"]


def test_a_vehicle_that_is_not_symmetric_has_no_zeros_of_its_spacing():
    vehicle = paper_coach(4).vehicle
    body = replace(vehicle.body, mass_centre=0.02, inertia="graded")
    model = derive_vehicle(replace(vehicle, body=body), 4)
    assert [z.cause for z in geometric_zeros(model, model.floor(), V, 40.0)] == ["wheelbase"]
    assert geometric_zeros(random_model(0, 4), random_model(0, 4).floor(), V, 40.0) == ()


def test_what_feels_its_own_wheelset_has_no_zeros_and_nor_has_a_band_below_them():
    model = paper_coach(1)
    found = geometric_zeros(model, model.outputs["primary_1_deflection"], V, 40.0)
    assert found == ()  # the wheelset's own elevation is part of it
    assert geometric_zeros(model, model.floor(), V, 1.0) == ()


# the picture


def lines(ax):
    return [line for line in ax.lines if line.get_linestyle() not in {":", "None"}]


def test_lines_are_what_was_computed_and_told_apart():
    found = bode(paper_coach(4), [40.0, V], np.geomspace(0.2, 40, 300))
    figure = plot_bode(found)
    top, above, below = figure.axes
    for r, line in zip(found, lines(above), strict=True):
        assert_array_equal(line.get_xdata(), r.frequency)
        assert_array_equal(line.get_ydata(), r.magnitude)
    for r, line in zip(found, lines(below), strict=True):
        kept = np.isfinite(line.get_ydata())
        assert_array_equal(line.get_ydata()[kept], r.phase_deg)
        steps = np.abs(np.diff(line.get_ydata()))
        assert np.nanmax(steps) <= 180
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "144 km/h", "200 km/h", "zeros (k + ½)·V/17.5 m, bogie spacing",
        "zeros (k + ½)·V/2.5 m, wheelbase",
    ]  # fmt: skip
    assert figure.get_suptitle() == (
        "cati2024, 4 segments, acceleration of the smooth floor, from the track, x = 0 m"
    )
    assert above.get_ylabel() == "magnitude [(m/s²)/m]"
    assert (below.get_xlabel(), below.get_ylabel()) == ("frequency [Hz]", "phase [°]")
    assert (above.get_xscale(), above.get_yscale()) == ("log", "log")
    named = " ".join(text.get_text().replace("\n", " ") for text in top.texts)
    for part in ("heave 1.03 Hz", "pitch 1.31 Hz", "bending 1", "bending 2 25.5 Hz"):
        assert part in named


def test_natural_frequencies_and_zeros_stand_where_they_are():
    found = bode(paper_coach(4), [V], np.geomspace(0.2, 40, 300))
    _, above, _ = plot_bode(found).axes
    dotted = sorted({line.get_xdata()[0] for line in above.lines if line.get_linestyle() == ":"})
    natural = sorted({m.frequency_hz for m in found[0].modes
                      if m.eigenvalue.imag > 0 and m.frequency_hz < 40})  # fmt: skip
    assert_allclose(dotted, natural)
    marks = np.concatenate([line.get_xdata() for line in above.lines
                            if line.get_marker() in {"v", "D"}])  # fmt: skip
    assert_allclose(np.sort(marks), np.sort(np.concatenate([z.frequency for z in found[0].zeros])))


def test_several_bodies_in_one_picture(tmp_path):
    found = [bode(paper_coach(n), [V])[0] for n in (1, 2, 8)]
    figure = plot_bode(found)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names[:3] == ["rigid body", "2 segments", "8 segments"]
    save(figure, tmp_path / "bode.png")  # laid out, without a warning
    assert figure.axes[1].get_position().height > 0.4
    save(plot_bode(bode(paper_coach(1), [V], [1.0])), tmp_path / "one.png")
    save(
        plot_bode(bode(paper_coach(1), [V], [1.0, 3.0], outputs="floor_displacement")),
        tmp_path / "two.png",
    )


def test_modes_of_every_body_are_named():
    """Of a rigid body beside bending ones, the bending peak has its name."""
    found = [bode(paper_coach(n), [V], np.geomspace(0.2, 40, 50))[0] for n in (1, 2, 4, 8)]
    top, above, _ = plot_bode(found).axes
    named = " ".join(text.get_text().replace("\n", " ") for text in top.texts)
    for label in ("heave", "pitch", "bogie heave", "bending 1", "bogie pitch", "bending 2"):
        assert label in named
    dotted = {line.get_xdata()[0] for line in above.lines if line.get_linestyle() == ":"
              and np.ptp(line.get_xdata()) == 0}  # fmt: skip
    for r in found:
        assert {m.frequency_hz for m in r.modes
                if m.eigenvalue.imag > 0 and m.frequency_hz < 40} <= dotted  # fmt: skip


def test_eight_and_more_lines_look_different():
    found = bode(paper_coach(1), np.linspace(20.0, 80.0, 28), [1.0, 2.0, 3.0])
    _, above, below = plot_bode(found).axes
    for ax in (above, below):
        looks = {(line.get_color(), line.get_linestyle()) for line in ax.lines[:28]}
        assert len(looks) == 28


def test_zeros_that_all_have_are_grey_and_others_of_their_lines_colour():
    def colours(found):
        _, above, _ = plot_bode(found).axes
        marks = [line for line in above.lines if line.get_marker() in {"v", "D"}
                 and len(line.get_xdata())]  # fmt: skip
        return {mark.get_markeredgecolor() for mark in marks}

    f = np.geomspace(0.2, 40, 50)
    assert colours([bode(paper_coach(n), [V], f)[0] for n in (1, 2)]) == {"#4D4D4D"}
    assert colours(bode(paper_coach(1), [40.0, V], f)) == {"#0072B2", "#D55E00"}
    assert colours(bode(paper_coach(1), [V], f, at=[0.0, 4.0])) == {"#0072B2", "#4D4D4D"}


def test_pictures_of_nothing_or_of_two_units_are_refused():
    with pytest.raises(InputError, match="found none"):
        plot_bode([])
    pair = bode(paper_coach(1), [V], [1.0], outputs=["floor_acceleration", "floor_displacement"])
    with pytest.raises(InputError, match=r"\(m/s\^2\)/m and m/m"):
        plot_bode(pair)


def test_a_legend_of_long_names_stays_inside(tmp_path):
    found = bode(paper_coach(2), V, source=["track", "w_1", "w_2"],
                 outputs=["bogie_1_acceleration", "floor_acceleration"])  # fmt: skip
    figure = plot_bode(found)
    save(figure, tmp_path / "long.png")
    box = figure.legends[0].get_window_extent()
    assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1


# the command


@pytest.fixture
def run(run):
    return partial(run, "bode")


def test_json_as_promised(run):
    code, out, err = run("--speed", 145, "--speed", 200, "--at", 0, "--at", 4, "--frequencies",
                         "1,2, 9.6 Hz", "--segments", 2, "--floor", "polygon", "--format",
                         "json")  # fmt: skip
    assert code == 0, err
    document = json.loads(out, parse_constant=pytest.fail)
    rows = document["response"]
    assert list(rows[0]) == ["speed_kmh", "position_m", "frequency_hz", "magnitude", "phase_deg"]
    assert [(r["speed_kmh"], r["position_m"], r["frequency_hz"]) for r in rows] == [
        (v, x, f) for v in (145.0, 200.0) for x in (0.0, 4.0) for f in (1.0, 2.0, 9.6)
    ]
    model = paper_coach(2)
    for r in rows:
        H = track_response(model, [model.floor(r["position_m"], "polygon")], r["speed_kmh"] / 3.6,
                           [r["frequency_hz"]])[0, 0]  # fmt: skip
        assert_allclose(r["magnitude"] * np.exp(1j * np.radians(r["phase_deg"])), H, rtol=1e-9)
        assert -180 < r["phase_deg"] <= 180
    for remark in document["remarks"]:
        assert f"remark: {remark}\n" in err


def test_the_default_band(run):
    rows = json.loads(run("--format", "json")[1])["response"]
    assert len(rows) == 2000
    assert {(r["speed_kmh"], r["position_m"]) for r in rows} == {(200.0, 0.0)}
    assert (rows[0]["frequency_hz"], rows[-1]["frequency_hz"]) == (0.2, 40.0)
    ratios = np.diff(np.log([r["frequency_hz"] for r in rows]))
    assert_allclose(ratios, ratios[0], rtol=1e-9)


def test_a_band_of_ones_own_as_csv(run, tmp_path):
    target = tmp_path / "bode.csv"
    code, out, err = run("--from", 1, "--to", "0.1 kHz", "--points", 3, "--format", "csv",
                         "--output", target)  # fmt: skip
    assert (code, out) == (0, ""), err
    rows = list(csv.DictReader(io.StringIO(target.read_text(encoding="utf-8"))))
    assert_allclose([float(r["frequency_hz"]) for r in rows], [1, 10, 100])


def test_few_frequencies_are_listed_and_many_summed_up(run):
    listed = run("--frequencies", "1,2,9.6")[1]
    assert len([line for line in listed.splitlines() if line.startswith("     200")]) == 3
    assert "peak" not in listed
    summed = run()[1]
    peak = next(line for line in summed.splitlines() if line.endswith("peak") and " 9.5" in line)
    (found,) = bode(paper_coach(4), [V])
    assert f"{found.magnitude.max():.5g}" in peak
    assert "bogie spacing 17.5 m: 1.587, 4.762" in summed


def test_a_picture_on_request(run, tmp_path):
    target = tmp_path / "bode.svg"
    code, _, err = run("--plot", target, "--frequencies", "1,2,3")
    assert code == 0
    assert f"drawn: {target}\n" in err
    assert target.read_text(encoding="utf-8").startswith("<?xml")


def response(run, *options):
    code, out, err = run(*options, "--format", "json")
    assert code == 0, err
    return json.loads(out, parse_constant=pytest.fail)["response"], err


def test_bodies_side_by_side(run, tmp_path):
    target = tmp_path / "bode.svg"
    rows, _ = response(run, "--compare-segments", "1,2, 8", "--frequencies", "1,9.6", "--plot",
                       target)  # fmt: skip
    assert [(r["segments"], r["frequency_hz"]) for r in rows] == [
        (n, f) for n in (1, 2, 8) for f in (1.0, 9.6)
    ]
    assert list(rows[0])[-1] == "segments"
    for r in rows:
        model = paper_coach(r["segments"])
        H = track_response(model, [model.floor()], V, [r["frequency_hz"]])[0, 0]
        assert_allclose(r["magnitude"], abs(H), rtol=1e-9)
    out = run("--compare-segments", "1,2", "--frequencies", "1,9.6")[1]
    lines = [line.split() for line in out.splitlines() if "200" in line]
    assert [line[:2] for line in lines[:4]] == [
        ["rigid", "body"], ["rigid", "body"], ["2", "segments"], ["2", "segments"],
    ]  # fmt: skip
    assert "floor acceleration per track elevation" in out
    assert target.exists()


def test_other_sources_and_signals(run):
    rows, err = response(run, "--source", "f_2", "--source", "w_3", "--signal",
                         "secondary_1_deflection", "--signal", "floor_velocity", "--at", 3,
                         "--frequencies", "1,9.6", "--segments", 2)  # fmt: skip
    model = paper_coach(2)
    assert [(r["source"], r["output"], r["unit"]) for r in rows[::2]] == [
        ("f_2", "secondary_1_deflection", "m/N"), ("f_2", "floor_velocity", "(m/s)/N"),
        ("w_3", "secondary_1_deflection", "m/m"), ("w_3", "floor_velocity", "(m/s)/m"),
    ]  # fmt: skip
    for r in rows:
        assert r["speed_kmh"] is None
        on_floor = r["output"] == "floor_velocity"
        assert r["position_m"] == (3.0 if on_floor else None)
        output = model.floor(3.0, derivative=1) if on_floor else r["output"]
        H = frequency_response(model, output, [r["frequency_hz"]], source=r["source"]).frdata
        found = r["magnitude"] * np.exp(1j * np.radians(r["phase_deg"]))
        assert_allclose(found, H[0, 0, 0], rtol=1e-9)
    assert "changes nothing" not in err
    _, err = response(run, "--source", "f_2", "--signal", "bogie_1_acceleration", "--at", 3,
                      "--speed", 100, "--frequencies", "1")  # fmt: skip
    assert "remark: --speed changes nothing" in err
    assert "remark: --at changes nothing" in err


def test_a_table_of_several_sources_tells_them_apart(run):
    out = run("--source", "track", "--source", "f_1", "--frequencies", "1,2", "--segments", 1)[1]
    assert out.startswith("cati2024 (rigid body), smooth floor: floor acceleration\n")
    assert out.count("track elevation under the leading wheelset") == 2
    assert out.count("force of actuator 1") == 2
    assert "[SI]" in out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--source", "w_5"], "found 'w_5'; expected one of track, w_1, w_2, w_3, w_4, f_1, f_2"),
        (["--source", "track", "--source", "f_1", "--plot", "a.png"], "(m/s^2)/N and (m/s^2)/m"),
        (["--signal", "door"], "found 'door'; expected one of floor_acceleration, floor_velocity"),
        (["--compare-segments", "1,2", "--segments", "3"], "found --segments with it"),
        (["--compare-segments", "1,2", "--body", "rigid"], "found --body with it"),
        (["--compare-segments", "1,0"], "--compare-segments: found '0'"),
        (["--compare-segments", "2,2"], "each number once"),
        (["--compare-segments", ""], "--compare-segments: found ''"),
        (["--frequencies", "1,0"], "--frequencies: found '0'"),
        (["--frequencies", "-1"], "--frequencies: found '-1'"),
        (["--frequencies", "2,1"], "--frequencies: found 1 Hz after 2 Hz"),
        (["--frequencies", "2,2"], "--frequencies: found 2 Hz after 2 Hz"),
        (["--frequencies", "1,,2"], "--frequencies"),
        (["--frequencies", "1;2"], "--frequencies"),
        (["--frequencies", ""], "--frequencies"),
        (["--frequencies", "1,nan"], "--frequencies"),
        (["--frequencies", "1,2 m"], "--frequencies"),
        (["--frequencies", "1", "--from", "1"], "--from with it"),
        (["--frequencies", "1", "--points", "9"], "--points with it"),
        (["--from", "5", "--to", "5"], "--from: found 5 Hz"),
        (["--from", "50"], "and 40 Hz for --to"),
        (["--to", "inf"], "--to"),
        (["--from", "0"], "--from: found '0'"),
        (["--points", "1"], "--points: found '1'"),
        (["--points", "2.5"], "--points: found '2.5'"),
        (["--points", "100000000"], "--points"),
        (["--speed", "0"], "--speed: found '0'"),
        (["--at", "13"], "between -12 and 12"),
        (["--floor", "carpet"], "smooth, polygon"),
        (["--plot", "bode.doc"], ".png, .pdf, .svg"),
        (["--plot", "bode"], "no suffix"),
        (["--plot", "none/bode.png"], "no folder"),
        (["--plot", "x.png", "--output", "x.png"], "the file of"),
        (["--segments", "0", "--frequencies", "0"], "--segments"),
    ],
)
def test_bad_options_end_with_2(run, tmp_path, monkeypatch, options, message):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*options)
    assert (code, out) == (2, "")
    assert message in err
    assert "expected" in err
    assert "Traceback" not in err
    assert list(tmp_path.iterdir()) == []


def test_all_faults_of_a_command_are_told_together(run):
    err = run("--segments", "0", "--frequencies", "0", "--speed", "-3")[2]
    assert all(option in err for option in ("--segments", "--frequencies", "--speed"))
