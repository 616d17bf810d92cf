"""Acceleration records: every way in, every remark, and nothing bridged or silently wrong."""

from __future__ import annotations

import re

import h5py
import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from scipy.io import savemat, wavfile

from railride.errors import Faults, InputError, RowFaults
from railride.records import read_record
from railride.records.choice import direction
from railride.records.clock import read_clock
from railride.records.scaling import acceleration_factor
from railride.tables import Column, NumberTable
from railride.weightings import apply_weighting

RATE = 100.0
N = 600
T = np.arange(N) / RATE
NS = 1706120587153000700


def f(t, axis=0):
    """A ride's acceleration, m/s², smooth at the rate of the tests."""
    return 0.3 * np.sin(2 * np.pi * (1.1 + axis) * t + axis) + 0.2 * np.cos(2 * np.pi * 5.3 * t)


def csv(header="time,z", *columns, sep=","):
    columns = columns or (T, f(T))
    rows = zip(*(c.tolist() if isinstance(c, np.ndarray) else c for c in columns), strict=True)
    lines = [sep.join(c if isinstance(c, str) else repr(c) for c in row) for row in rows]
    return "\n".join([header, *lines]) + "\n"


def edited(changes, text=None):
    """The good file with some lines (1 the header) replaced, or left out where None."""
    lines = (text or csv()).split("\n")
    kept = [changes.get(row, line) for row, line in enumerate(lines, start=1)]
    return "\n".join(line for line in kept if line is not None)


@pytest.fixture
def read(tmp_path):
    def reader(content, name="ride.csv", **options):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_record(path, **options)

    return reader


@pytest.fixture
def fault(read):
    def reader(content, **options):
        with pytest.raises(InputError) as caught:
            read(content, **options)
        message = str(caught.value)
        assert all("ride.csv: " in line for line in message.split("\n"))
        return message

    return reader


def said(record, text):
    return [remark for remark in record.remarks if re.search(text, remark)]


NO_UNIT = "'z': no unit is stated, m/s² is assumed"


def test_samples_are_those_of_the_file_to_the_last_bit(read):
    record = read(csv())
    assert record.rate == RATE
    assert record.starts == (0.0,)
    assert record.name == "ride.csv"
    assert [(a.column, a.direction) for a in record.axes] == [("z", "z")]
    assert np.array_equal(record.axes[0].pieces[0], f(T))
    assert record.remarks == (NO_UNIT,)


# Columns and directions


@pytest.mark.parametrize(
    ("heading", "expected"),
    [
        ("z", "z"),
        ("X", "x"),
        ("ay", "y"),
        ("acc_z", "z"),
        ("accel z", "z"),
        ("z-axis", "z"),
        ("Acceleration x (m/s^2)", "x"),
        ("accelerometerAccelerationZ", "z"),
        ("LinearAccX", "x"),
        ("floor.az [g]", "z"),
        ("Vertical", "z"),
        ("Beschleunigung vertikal", "z"),
        ("seat lateral [m/s²]", "y"),
        ("gFz", "z"),
        ("acc", None),
        ("xz", None),
        ("x y", None),
        ("maximum", None),
    ],
)
def test_directions_by_heading(heading, expected):
    assert direction(Column.of(heading, np.zeros(3))) == expected


def test_axes_are_found_in_the_order_of_the_file(read):
    header = "time,Latitude x,z [m/s²],gyro_y,y [m/s²],rate,x [m/s²],z_pos [mm]"
    record = read(csv(header, T, T, f(T), T, f(T, 1), T, f(T, 2), T))
    assert [(a.column, a.direction) for a in record.axes] == [
        ("z [m/s²]", "z"),
        ("y [m/s²]", "y"),
        ("x [m/s²]", "x"),
    ]
    assert np.array_equal(record.axes[2].pieces[0], f(T, 2))
    left = "columns of numbers that were not used: 'Latitude x', 'gyro_y', 'rate', 'z_pos [mm]'"
    assert record.remarks == (left,)


def test_axes_by_name_in_the_order_given(read):
    text = csv("time,a1,b1,a2 [g]", T, f(T), f(T, 1), f(T, 2))
    record = read(text, columns=["a2", "b1"])
    assert [(a.column, a.direction) for a in record.axes] == [("a2 [g]", None), ("b1", None)]
    assert_allclose(record.axes[0].pieces[0], 9.80665 * f(T, 2), rtol=1e-15)
    assert [a.direction for a in read(text, columns=["a1", "b1", "a2"]).axes] == ["x", "y", "z"]
    one = read(text, columns="b1")
    assert one.axes[0].direction == "z"
    assert said(one, "'b1' tells no direction and is taken as z")


def test_an_axis_without_a_number_is_told(read):
    record = read(csv("time,x,z [g]", T, [""] * N, f(T)))
    assert [a.direction for a in record.axes] == ["z"]
    assert record.remarks == ("'x': no number in the column, it was not used",)


def test_the_only_column_beside_the_time_is_taken_as_z(read):
    record = read(csv("t,floor"))
    assert record.axes[0].direction == "z"
    assert said(record, "'floor' tells no direction and is taken as z, vertical")
    assert read(csv().split("\n", 1)[1], time_column="1").rate == RATE


@pytest.mark.parametrize(
    ("header", "options", "message"),
    [
        ("time,a,b", {}, "2 columns of numbers, 'a', 'b', none of which tells a direction"),
        ("time,z1,b", {"columns": "z"}, "column 'z': found no such column; .*is it 'z1'"),
        ("time,az,z", {}, "several columns for one direction: 'az', 'z'"),
        ("time,z,b", {"columns": ["z", "z"]}, "'z': found it is named 2 times"),
        ("time,z,b", {"columns": ["time"], "time_column": "time"}, "'time': found times"),
        ("time,z,b", {"time_column": "tme"}, "column 'tme': found no such column"),
        ("time,z [V],b", {"columns": ["z"]}, "'z .V.': found 'V' is no unit"),
        ("time,z [mm],b", {"columns": ["z"]}, "the unit 'mm'; expected a unit of acceleration"),
        ("time [m],z,b", {"time_column": "time"}, "the unit 'm'; expected a unit of time"),
        ("time,z,b", {"unit": "kN"}, "unit: found the unit 'kN'"),
        ("time,z,b", {"unit": "furlong"}, "expected a unit of acceleration: m/s², g or mg$"),
        ("time,a,b", {}, r"name them by --column, .* --time-column \(columns=, time_column=\)"),
        ("a,z,b", {}, r"by --time-column \(time_column=\), or give --rate HZ \(rate=\)"),
        ("time,z,b", {"unit": "0 g"}, "unit: found the unit '0 g'"),
        ("a,z,b", {}, "neither a time column nor a rate"),
        ("time,z,b", {"rate": 100.0, "time_column": "time"}, "both a rate, 100 Hz, and a time"),
        ("time,z,b", {"rate": 0.0}, "rate: found 0 Hz"),
        ("time,z,b", {"rate": float("nan")}, "rate: found nan Hz"),
    ],
)
def test_what_cannot_be_chosen(fault, header, options, message):
    found = fault(csv(header, T, f(T), f(T, 1)), **options)
    assert re.search(message, found), found


def test_all_faults_of_a_file_come_together(fault):
    message = fault(edited({7: "0.05,abc", 9: "0.05,1", 11: "soon,1"}, csv("time,z [kN]")))
    for part in ("'z [kN]': ", "row 7, ", "row 9, column 'time'", "row 11, column 'time'"):
        assert part in message


# Time


TIMES = {
    "seconds": ("time", [repr(t) for t in T.tolist()], ""),
    "seconds elapsed": ("seconds_elapsed", [f"{t + 12.5:.6f}" for t in T], ""),
    "ms": ("Time (ms)", [f"{1000 * t:.0f}" for t in T], ""),
    "µs": ("time_us", [f"{1e6 * t:.0f}" for t in T], ""),
    "h": ("t [h]", [repr(t / 3600) for t in T.tolist()], ""),
    "ns since 1970": ("time", [str(NS + 10**7 * k) for k in range(N)], "ns since 1970: from 2024"),
    "µs since 1970": ("t", [str(NS // 1000 + 10**4 * k) for k in range(N)], "µs since 1970"),
    "ms since 1970": ("time", [str(NS // 10**6 + 10 * k) for k in range(N)], "ms since 1970"),
    "s since 1970": ("timestamp", [f"{1706120587.15 + k / 100:.2f}" for k in range(N)], "s since"),
    "bare ms": ("time", [str(10 * k) for k in range(N)], "taken as ms, which makes 100 Hz"),
    "ISO": ("time", [f"2024-01-24T18:23:{7 + t:06.3f}Z" for t in T], ""),
    "ISO, blank and comma": ("date", [f"2024-01-24 18:23:{7 + t:06.3f}".replace(".", ",")
                                      for t in T], ""),
    "German": ("Zeit", [f"24.01.2024 18:23:{7 + t:06.3f}" for t in T], ""),
    "one day in any form": ("time", [f"1/24/2024 18:23:{7 + t:06.3f}" for t in T], ""),
    "time of day": ("clock", [f"18:23:{7 + t:06.3f}" for t in T], ""),
    "min:s": ("time", [f"23:{7 + t:06.3f}" for t in T], ""),
}  # fmt: skip


@pytest.mark.parametrize("name", TIMES)
def test_forms_of_time(read, name):
    heading, times, remark = TIMES[name]
    record = read(csv(f"{heading};z [m/s^2]", times, f(T), sep=";"))
    assert record.rate == RATE
    assert np.array_equal(record.axes[0].pieces[0], f(T))
    assert len(record.remarks) == bool(remark)
    assert all(remark in text for text in record.remarks)


def test_midnight(read):
    def text(t):
        return f"{int(t / 3600) % 24:02d}:{int(t / 60) % 60:02d}:{t % 60:06.3f}"

    clock = read(csv("time;z", [text(86397.0 + t) for t in T], f(T), sep=";"))
    day = [f"2024-02-{28 + (t >= 3):02d} {text(86397.0 + t)}" for t in T]
    for record in (clock, read(csv("time;z", day, f(T), sep=";"))):
        assert record.lengths == (N,)
        assert record.rate == RATE


def test_nanoseconds_beside_blanks_keep_every_digit():
    """As floats the stamps would be up to 128 ns off."""
    stamps = [str(NS + 1000 * k) for k in range(8)]
    stamps[5] = ""
    column = Column.of("time", np.array(stamps, dtype=object))
    clock = read_clock(NumberTable("a", (column,)), column, RowFaults(Faults("a")))
    expected = np.arange(8) * 1e-6
    expected[5] = np.nan
    assert_allclose(clock.seconds, expected, rtol=1e-15)
    assert clock.digit == pytest.approx(1e-6)


def test_short_stretches_are_refused_when_nothing_else_is_there(fault):
    message = fault(edited({row: f"{(row - 2) / 100!r}," for row in range(50, 600, 50)}))
    assert "12 pieces between gaps, of 51 rows at most; expected one of 1 s" in message


def test_a_rate_instead_of_times(read):
    record = read(csv("z [g]", f(T)), rate=250.0)
    assert record.rate == 250.0
    assert record.duration == N / 250
    assert record.remarks == ()
    other = read(csv("time,z"), rate=50.0)
    assert other.rate == 50.0
    assert said(other, "the column 'time' was not used: the rate is given")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({9: "0.05,0.1"}, "row 9, column 'time': found 0.05 after 0.06, a fall"),
        ({9: "0.06,0.1"}, "row 9, .*the same time again; .*keep one of the rows"),
        ({9: "abc,0.1"}, "row 9, column 'time': found 'abc'; expected a time"),
        ({9: "inf,0.1"}, "row 9, column 'time': found 'inf'; expected a time"),
        ({9: "0.07,abc"}, "row 9, column 'z': found 'abc'; expected a finite number"),
        ({9: "0.07,inf"}, "row 9, column 'z': found 'inf'; expected a finite number"),
        ({9: "0.07,1e999"}, "row 9, column 'z': found '1e999'"),
        ({9: "0.07,1_0"}, "row 9, column 'z': found '1_0'"),
        ({9: '0.07,"0,1"'}, "row 9, column 'z': found '0,1'; .*decimal commas"),
        ({9: "0.07"}, "row 9: found 1 cells"),
    ],
)
def test_a_fault_is_named_by_row_and_column(fault, changes, message):
    found = fault(edited(changes))
    assert re.search(message, found), found


def test_times_that_fall_throughout_or_have_too_few_digits(fault):
    assert "row 3, column 'time': found times that fall throughout" in fault(
        csv("time,z", T[::-1], f(T))
    )
    rough = fault(csv("time,z", [f"{t:.0f}" for t in T], f(T)))
    assert "the times have too few digits: give the rate instead (--rate)" in rough
    assert len(rough.split("\n")) == 11
    dates = ["yesterday" if k == 4 else f"2024-01-24T18:23:{7 + t:06.3f}" for k, t in enumerate(T)]
    assert "row 6, column 'time': found 'yesterday'" in fault(csv("time,z", dates, f(T)))


def test_rows_of_the_same_rounded_time_are_not_advised_away(fault, read):
    """1024 Hz with times to the ms: every 43rd time is there twice, and both rows are samples."""
    rounded = csv("time,z", [f"{k / 1024:.3f}" for k in range(N)], f(T))
    found = fault(rounded)
    assert "if the times are rounded to 0.001 s, give the rate instead (--rate)" in found
    assert read(rounded, rate=1024.0).lengths == (N,)
    twice = np.insert(T, 5, T[4])
    assert "keep one of the rows" in fault(
        csv("time,z", [f"{t + 0.0013:.4f}" for t in twice], f(twice))
    )


def test_a_unit_of_time_that_cannot_be_told_is_asked_for(fault):
    assert "steps of 70 and no unit" in fault(csv("time,z", 70 * np.arange(N), f(T)))


def test_too_few_rows(fault):
    assert "7 rows of numbers; expected at least 8" in fault(csv("time,z", T[:7], f(T[:7])))


# Gaps


def test_blank_cells_and_jumps_end_a_piece(read):
    changes = {row: f"{T[row - 2]},{cell}" for row, cell in
               zip(range(202, 206), ("", "NaN", "null", "inv"), strict=True)}  # fmt: skip
    record = read(edited({**changes, 402: None, 403: None}))
    assert record.starts == pytest.approx((0.0, 2.04, 4.02), abs=1e-12)
    assert record.lengths == (200, 196, 198)
    for start, piece in zip(record.starts, record.axes[0].pieces, strict=True):
        assert_allclose(piece, f(start + np.arange(piece.size) / RATE), atol=1e-12)
    assert record.remarks[1:] == (
        "a gap of 0.04 s at 1.99 s: rows 202 to 205 (4) without a number",
        "a gap of 0.02 s at 3.99 s: the time jumps at row 402",
    )


def test_a_blank_in_one_axis_is_a_gap_of_all(read):
    text = csv("time,z,y", T, f(T), f(T, 1))
    record = read(edited({302: f"{T[300]},,{f(T[300], 1)}"}, text))
    assert record.lengths == (300, 299)
    assert [piece.size for piece in record.axes[1].pieces] == [300, 299]
    assert said(record, "a gap of 0.01 s at 2.99 s: row 302 without a number")


def test_a_row_without_a_time_is_a_gap(read):
    record = read(edited({302: ",0.1"}))
    assert record.lengths == (300, 299)
    assert said(record, "row 302 without a number")


def test_gaps_with_a_rate_keep_their_length(read):
    values = [repr(v) for v in f(T).tolist()]
    values[300:310] = [""] * 10
    record = read(csv("z,b", values, T), rate=RATE, columns="z")
    assert record.starts == (0.0, 3.1)


def test_blanks_at_the_ends_are_cut_off(read):
    record = read(edited({2: "0.0,", 3: "0.01,NA", 601: "5.99,"}))
    assert record.lengths == (597,)
    assert said(record, r"rows 2 to 3 \(2\) at the start")
    assert said(record, "row 601 at the end")


def test_short_pieces_are_left_out_and_many_gaps_are_counted(read):
    changes = {row: f"{T[row - 2]}," for row in range(402, 482, 10)}
    record = read(edited(changes))
    assert record.lengths == (400, 129)
    assert said(record, "7 pieces between gaps, 0.63 s together, are shorter than 1 s and left out")
    assert said(record, "3 more gaps, 0.03 s together")
    assert len(said(record, "^a gap of")) == 5


# Uneven sampling


def test_times_within_two_per_cent_of_a_step_keep_the_samples(read):
    jitter = np.random.default_rng(3).uniform(-0.018, 0.018, N) / RATE
    jitter[[0, -1]] = 0.0
    record = read(csv("time,z [m/s^2]", T + jitter, f(T)))
    assert np.array_equal(record.axes[0].pieces[0], f(T))
    assert re.fullmatch(
        r"the times are up to 1.9 % of a step \(1 % r.m.s.\) off an even grid, taken as rounding",
        record.remarks[0],
    )


def test_times_rounded_to_their_last_digit_keep_the_samples(read):
    t = np.arange(N) / 300.0
    record = read(csv("time,z [g]", [f"{x:.3f}" for x in t], f(t)))
    assert record.rate == pytest.approx(300.0, rel=1e-5)
    assert record.lengths == (N,)
    assert record.remarks == ()


def test_rounding_to_a_digit_near_the_step_is_told_from_dropped_samples(read):
    """700 Hz in whole ms: steps of 1 and 2 ms. 1000 Hz in whole ms: steps of 2 ms are gaps."""
    t = np.arange(3000)
    coarse = read(csv("time [ms],z [g]", np.round(t / 0.7).astype(int), f(t / 700)))
    assert coarse.rate == pytest.approx(700.0, rel=1e-5)
    assert (coarse.lengths, coarse.remarks) == ((3000,), ())
    kept = np.delete(t, 1500)
    dropped = read(csv("time [ms],z [g]", kept, f(kept / 1000)))
    assert dropped.lengths == (1500, 1499)
    assert said(dropped, "a gap of 0.001 s at 1.499 s: the time jumps at row 1502")


@pytest.mark.parametrize(("scatter", "worst"), [(0.05, [6e-7, 3e-4, 1.5e-2]),
                                                (0.2, [9e-6, 2.3e-3, 6.5e-2])])  # fmt: skip
def test_uneven_times_are_resampled_within_the_error_that_is_stated(read, scatter, worst):
    """The table in railride.records.grid, to a fifth: sines at 0.1, 0.25 and 0.4 of the rate."""
    n = 4000
    jitter = np.random.default_rng(5).uniform(-scatter, scatter, n)
    jitter[[0, -1]] = -scatter, scatter  # so that the even grid lies within the times
    t = (np.arange(n) + jitter) / RATE
    for share, expected in zip((0.1, 0.25, 0.4), worst, strict=True):
        frequency = share * RATE
        record = read(csv("time,z [m/s^2]", t, np.sin(2 * np.pi * frequency * t)))
        assert said(record, f"uneven sampling: the times are up to {100 * scatter:.2g}.* of a step")
        exact = np.sin(
            2 * np.pi * frequency * (t[0] + record.starts[0] + np.arange(n) / record.rate)
        )
        error = (record.axes[0].pieces[0] - exact)[50:-50]
        found = np.sqrt(2 * np.mean(error**2))
        if share < 0.4:
            assert found == pytest.approx(expected, rel=0.2)
        stated = float(re.search(r"([\d.e+-]+) % r.m.s. from a cubic", record.remarks[0])[1]) / 100
        assert found < stated


def test_resampling_in_blocks_leaves_no_seam(read, monkeypatch):
    t = T + 0.3 * np.sin(np.arange(N)) / RATE
    whole = read(csv("time,z", t, f(t)))
    monkeypatch.setattr("railride.records.grid._BLOCK", 97)
    parts = read(csv("time,z", t, f(t)))
    assert_allclose(parts.axes[0].pieces[0], whole.axes[0].pieces[0], rtol=0, atol=1e-13)


def test_pieces_of_uneven_times_keep_their_places(read):
    t = T + 0.1 * np.sin(np.arange(N)) / RATE
    rows = [[x, v] for x, v in zip(t.tolist(), f(t).tolist(), strict=True)]
    del rows[300:320]
    record = read(csv("time,z", *zip(*rows, strict=True)))
    assert len(record.starts) == 2
    for start, piece in zip(record.starts, record.axes[0].pieces, strict=True):
        assert_allclose(piece, f(start + np.arange(piece.size) / record.rate), atol=2e-5)


# Units


@pytest.mark.parametrize(
    ("unit", "factor"),
    [
        ("m/s²", 1.0),
        ("m/s^2", 1.0),
        ("m/s2", 1.0),
        ("m s^-2", 1.0),
        ("ms-2", 1.0),
        ("mm/s²", 1e-3),
        ("g", 9.80665),
        ("mg", 9.80665e-3),
        ("µg", 9.80665e-6),
        ("G", 9.80665),
    ],
)
def test_units_of_acceleration(read, unit, factor):
    assert acceleration_factor(unit) == pytest.approx(factor, rel=1e-15)
    for record in (read(csv(f"time,z [{unit}]")), read(csv("time,z"), unit=unit)):
        assert_allclose(record.axes[0].pieces[0], factor * f(T), rtol=1e-14)
        assert not said(record, "no unit")


def test_a_unit_with_a_number_and_one_against_the_heading(read):
    record = read(csv("time,z [g]"), unit="2.5 m/s^2")
    assert_allclose(record.axes[0].pieces[0], 2.5 * f(T), rtol=1e-15)
    assert said(record, r"'z \[g\]': read in 2.5 m/s\^2, as told, not as headed")


def test_a_line_of_units_below_the_header(read):
    record = read("time,z\nms,mg\n" + csv("", 10 * np.arange(N), 1000 * f(T)).lstrip())
    assert record.rate == RATE
    assert_allclose(record.axes[0].pieces[0], 9.80665 * f(T), rtol=1e-14)


# Doubts


def test_gravity_is_noticed_and_removed_on_request(read):
    text = csv("time,z [m/s²]", T, f(T) + 9.81)
    kept, removed = read(text), read(text, detrend=True)
    assert said(kept, "gravity is in the record, mostly in 'z .*detrending removes it")
    assert said(removed, "gravity is in the record, .*it is removed with the mean")
    assert_allclose(kept.axes[0].pieces[0] - np.mean(f(T) + 9.81), removed.axes[0].pieces[0])
    assert abs(np.mean(removed.axes[0].pieces[0])) < 1e-14


def test_one_mean_is_removed_from_all_pieces(read):
    record = read(edited({302: f"{T[300]},"}, csv("time,z", T, f(T) + T)), detrend=True)
    first, second = record.axes[0].pieces
    assert np.mean(first) < -1.0
    assert np.mean(second) > 1.0


def test_a_tilted_sensor_s_gravity_is_noticed(read):
    parts = [f(T, k) + 9.81 * share for k, share in enumerate((0.6, 0.8))]
    assert said(read(csv("time,x,z", T, *parts)), "gravity is in the record, mostly in 'z'")


@pytest.mark.parametrize(
    ("values", "unit", "remark"),
    [
        (0.05 * f(T) + 1.0, "m/s²", "the mean is 1.0.* which is gravity in g: is that"),
        (f(T) + 1000.0, "m/s²", "the mean is 1000 .* gravity in mg: is that"),
        (f(T) + 9.81, "g", "the mean is 9.8.* gravity in m/s²: is that"),
        (0.1 * f(T) + 1.0, "mg", "the mean is 1.0.* gravity in g: is that"),
        (300 * f(T), "m/s²", "far above any vehicle's"),
        (0.001 * f(T), "m/s²", "as of a vehicle at rest"),
        (0.1 * f(T) + 2.0, "m/s²", "has an offset, its mean is 2.00"),
    ],
)
def test_slips_of_the_unit_are_remarked(read, values, unit, remark):
    assert said(read(csv(f"time,z [{unit}]", T, values)), remark)
    assert read(csv("time,z [m/s²]")).remarks == ()


def test_a_rate_that_cannot_be_is_remarked(read):
    assert said(read(csv("time [h],z")), "is the unit of time right")


def test_saturation_is_told_and_left_as_it_is(read):
    a = 4 * f(T)
    clipped = np.clip(np.round(a, 3), -1.0, 1.5)
    record = read(csv("time,z [m/s²]", T, clipped))
    assert np.array_equal(record.axes[0].pieces[0], clipped)
    top, bottom = record.remarks
    runs = re.split("0+", "".join("1" if v == 1.5 else "0" for v in clipped))
    long = [len(run) for run in runs if len(run) >= 3]
    first = "".join("1" if v == 1.5 else "0" for v in clipped).index("111")
    assert "at its largest value, 1.5 m/s², for 3 samples or more in a row" in top
    assert f"at {len(long)} places ({sum(long)} samples), first in rows {first + 2} to " in top
    assert f"(t = {first / 100:g} s)" in top
    assert "at its smallest value, -1 m/s²" in bottom


@pytest.mark.parametrize("steps", [10, 100, 1000])
def test_the_flat_tops_of_a_coarse_converter_are_no_saturation(read, steps):
    """A slow sine in few steps stays at its highest step for many samples."""
    for frequency in (0.2, 0.7, 3.0):
        values = np.round(steps * np.sin(2 * np.pi * frequency * T)) / steps
        assert not said(read(csv("time,z [m/s²]", T, values)), "saturated")


def test_saturation_in_counts_of_a_converter(read):
    counts = np.clip(np.round(3000 * np.sin(2 * np.pi * 3 * T)), -2048, 2047).astype(int)
    record = read(csv("time,z", T, counts), unit="0.001 g")
    assert said(record, "largest value, 20.07")
    assert said(record, "smallest value, -20.08")


def test_dead_and_stuck_channels_are_told(read):
    assert said(read(csv("time,z", T, np.full(N, 0.25))), "is constant, 0.25 m/s² throughout")
    stuck = f(T)
    stuck[200:230] = 0.0
    record = read(csv("time,z", T, stuck))
    assert said(
        record, r"does not move, first at 0 m/s², .* rows 202 to 231 \(t = 2 s\): a dropout"
    )


def test_a_glitch_is_told_and_a_shock_is_not(read):
    values = f(T)
    values[[100, 400]] = -99.0, 99.0
    record = read(csv("time,z [m/s²]", T, values))
    assert said(
        record, r"2 single samples far from all others, the first in row 102 \(t = 1 s\), -99 m"
    )
    shock = f(T) + 60 * np.exp(-(((T - 3.0) / 0.02) ** 2))
    assert read(csv("time,z [m/s²]", T, shock)).remarks == ()


def test_a_last_number_that_is_cut_off_is_told(read):
    whole = "time,z\n" + "".join(f"{t:.2f},{v:.5f}\n" for t, v in zip(T, f(T), strict=True))
    assert not said(read(whole), "cut off")
    assert not said(read(whole[:-1]), "cut off")
    assert said(read(whole[:-2]), "the file ends within row 601, whose last number seems to be cut")
    assert said(read(whole[:-6]), "within row 601")


# Formats


def test_every_format_gives_the_same_record(tmp_path):
    z, y = f(T), f(T, 1)
    pd.DataFrame(
        {"time": pd.date_range("2024-01-01", periods=N, freq="10ms"), "y [g]": y, "z [g]": z}
    ).to_parquet(tmp_path / "a.parquet", index=False)
    savemat(tmp_path / "a.mat", {"t": T, "rec": {"y": y, "z": z}})
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["fs"] = RATE
        for name, values in (("acc/y", y), ("acc/z", z)):
            file.create_dataset(name, data=values).attrs["unit"] = "g"
    wavfile.write(tmp_path / "a.wav", int(RATE), np.stack([y, z], 1))
    wav = {"columns": ["1", "2"], "unit": "g"}
    for name, options in {
        "a.parquet": {},
        "a.mat": {"unit": "g"},
        "a.h5": {},
        "a.wav": wav,
    }.items():
        record = read_record(tmp_path / name, **options)
        assert record.rate == RATE
        assert record.lengths == (N,)
        for axis, values in zip(record.axes, (y, z), strict=True):
            assert_allclose(axis.pieces[0], 9.80665 * values, rtol=1e-15)
            assert axis.direction == (None if name == "a.wav" else axis.column.split(" ")[0][-1])
        assert record.remarks == ()


def test_columns_of_a_struct_or_a_group_are_found_by_the_end_of_their_path(tmp_path):
    savemat(tmp_path / "a.mat", {"data": {"time": T, "az": f(T)}})
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["run1/time"], file["run1/az"] = T, f(T)
    for name in ("a.mat", "a.h5"):
        for columns in ((), ("az",)):
            record = read_record(tmp_path / name, columns=columns, unit="g")
            assert record.rate == pytest.approx(RATE)
            (axis,) = record.axes
            assert (axis.column.split("/")[1], axis.direction) == ("az", "z")
            assert record.remarks == ()


def test_a_rate_against_the_one_of_the_file_is_told(tmp_path):
    wavfile.write(tmp_path / "a.wav", 100, f(T))
    record = read_record(tmp_path / "a.wav", rate=200.0, unit="m/s^2")
    assert record.rate == 200.0
    assert said(record, "the rate is 200 Hz as told; the file itself states 100 Hz")


def test_gaps_in_binary_files_are_records_counted_from_1(tmp_path):
    z = f(T)
    z[300] = np.nan
    pd.DataFrame({"time": T, "z [g]": z}).to_parquet(tmp_path / "a.parquet")
    assert said(read_record(tmp_path / "a.parquet"), "row 301 without a number")
    z[310] = np.inf
    pd.DataFrame({"time": T, "z [g]": z}).to_parquet(tmp_path / "a.parquet")
    with pytest.raises(InputError, match=r"row 311, column 'z \[g\]': found 'inf'"):
        read_record(tmp_path / "a.parquet")


def phone_recording(n=8000, rate=51.16):
    """A file in the form of a phone app's: stamps in ns with a step in the clock now and then."""
    steps = np.where(np.arange(n) % 50 == 7, 19_553_800, 19_546_200)
    stamps = NS + np.concatenate([[0], np.cumsum(steps[:-1])])
    t = (stamps - NS) * 1e-9
    z = 0.2 * np.sin(2 * np.pi * 6.0 * t) + 0.1 * np.sin(2 * np.pi * 1.5 * t)
    rows = zip(stamps.tolist(), (t + 0.183).tolist(), z.tolist(), f(t, 1), f(t, 2), strict=True)
    return t, "time,seconds_elapsed,z,y,x\n" + "".join(
        ",".join(map(str, row)) + "\n" for row in rows
    )


def test_a_phone_recording(read):
    t, text = phone_recording()
    record = read(text)
    assert record.rate == pytest.approx((t.size - 1) / t[-1], rel=1e-6)
    assert [a.direction for a in record.axes] == ["z", "y", "x"]
    assert record.remarks == (
        "'z', 'y', 'x': no unit is stated, m/s² is assumed",
        "'time' is taken as ns since 1970: from 2024-01-24 18:23 UTC",
    )
    weighted = apply_weighting("Wk", record.axes[0].pieces[0], record.rate)
    # ISO 2631-1, Table 3: W_k is 1.061 at 6.3 Hz and 0.963 at 5 Hz, 0.494 at 1.6 Hz.
    expected = np.sqrt((0.2 * 1.055) ** 2 + (0.1 * 0.495) ** 2) / np.sqrt(2)
    assert np.sqrt(np.mean(weighted[500:-500] ** 2)) == pytest.approx(expected, rel=0.01)
