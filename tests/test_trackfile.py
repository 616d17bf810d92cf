"""Track files: back to the last bit, every form that is promised, every fault by row and column."""

from __future__ import annotations

import re
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from railride.errors import InputError
from railride.spectra import D1, D2, spectrum, spectrum_names
from railride.track import Track, synthesise
from railride.trackfile import read_track, write_track
from railride.trackfile.limits import shown_band

X = np.arange(12) * 0.25
W = np.round(0.004 * np.sin(X) - 0.001 * X, 6)


def text(header="distance_m,level_m", x=X, w=W, sep=",", end="\n"):
    """A file as text: a header and one row per pair, row j of the numbers on line j + 2."""
    rows = [f"{a}{sep}{b}" for a, b in zip(x, w, strict=True)]
    return end.join([header, *rows]) + end


def with_line(row, line, base=None):
    """The good file with one line (1 the header) replaced."""
    lines = (base or text()).split("\n")
    lines[row - 1] = line
    return "\n".join(lines)


def without_line(row):
    lines = text().split("\n")
    del lines[row - 1]
    return "\n".join(lines)


@pytest.fixture
def read(tmp_path):
    """Read a file of the given content."""

    def reader(content):
        path = tmp_path / "line4.csv"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_track(path)

    return reader


@pytest.fixture
def fault(read):
    """Read a file that is wrong and give the message, which names the file in each line."""

    def reader(content):
        with pytest.raises(InputError) as caught:
            read(content)
        message = str(caught.value)
        assert all("line4.csv: " in line for line in message.split("\n"))
        return message

    return reader


@pytest.mark.parametrize("distance0", [0.0, -50.0, 12345.678, 1 / 3])
@pytest.mark.parametrize("step", [0.05, 0.0125, 0.1, 1 / 3, 0.3])
def test_what_is_written_reads_back_to_the_last_bit(tmp_path, distance0, step):
    level = synthesise(spectrum("erri_low"), 300 * step, step, 1).level
    track = Track(distance0, step, level)
    write_track(track, tmp_path / "track.csv")
    again = read_track(tmp_path / "track.csv")
    assert np.array_equal(again.level, track.level)
    assert again.step == pytest.approx(step, rel=1e-12)
    assert again.distance0 == distance0
    assert np.array_equal(again.distance, track.distance)
    assert again.remarks == ()
    first, second = (tmp_path / "track.csv").read_text().split("\n")[:2]
    assert first == "distance_m,level_m"
    assert second == f"{distance0!r},{float(level[0])!r}"


@given(
    level=arrays(np.float64, st.integers(8, 40), elements=st.floats(-0.1, 0.1)),
    step=st.floats(0.01, 5.0),
    distance0=st.floats(-1e6, 1e6),
)
def test_any_track_reads_back_to_the_last_bit(level, step, distance0):
    track = Track(distance0, step, level)
    with tempfile.TemporaryDirectory() as folder:
        write_track(track, Path(folder) / "track.csv")
        again = read_track(Path(folder) / "track.csv")
    assert np.array_equal(again.level, track.level)
    assert np.array_equal(again.distance, track.distance)
    # Distances of 1e6 m have 1e-10 m between them.
    assert again.step == pytest.approx(step, abs=1e-9)


@pytest.mark.parametrize("seed", range(5))
def test_distances_far_from_zero_read_back_to_the_last_bit(tmp_path, seed):
    rng = np.random.default_rng(seed)
    for _ in range(10):
        step = float(rng.choice([0.25, 0.2, 0.305, 0.1524, 1 / 3])) * (1 + 1e-4 * rng.normal())
        start = round(float(rng.uniform(0.0, 2e5)), 2)
        track = Track(start, step, 1e-5 * np.cumsum(rng.normal(size=int(rng.integers(200, 4000)))))
        write_track(track, tmp_path / "track.csv")
        again = read_track(tmp_path / "track.csv")
        assert np.array_equal(again.distance, track.distance)
        assert np.array_equal(again.level, track.level)


def test_a_round_step_comes_back_exactly(tmp_path):
    track = synthesise(spectrum("erri_low"), 1000.0, 0.05, 1)
    write_track(track, tmp_path / "track.csv")
    again = read_track(tmp_path / "track.csv")
    assert again.step == 0.05
    assert np.array_equal(again.distance, track.distance)
    assert again.elevation(123.456) == track.elevation(123.456)


BANDS = {name: spectrum(name).active_band for name in spectrum_names()}


@pytest.mark.parametrize("name", BANDS)
@pytest.mark.parametrize(("length", "step"), [(999.9, 0.25), (2500.0, 0.3)])
def test_a_written_track_keeps_the_band_of_its_spectrum(tmp_path, name, length, step):
    for seed in (1, 2, 3):
        track = synthesise(name, length, step, seed)
        write_track(track, tmp_path / "track.csv")
        again = read_track(tmp_path / "track.csv")
        period = step * track.level.size
        short, long = BANDS[name] or (0.0, np.inf)
        if short <= 2 * step and long >= period:
            assert again.band is None
            assert again.remarks == ()
            continue
        assert again.band[0] == pytest.approx(max(short, 2 * step), rel=2 * short / period)
        assert again.band[1] == pytest.approx(min(long, period), rel=2 * long / period)
        assert again.covers(*D1) == track.covers(*D1)
        assert again.covers(*D2) == track.covers(*D2)
        assert "its spectrum is zero beyond them" in again.remarks[0]


def test_a_level_without_a_band_of_its_own_shows_none():
    x = np.arange(4000) * 0.25
    tones = np.sin(2 * np.pi * x / 10.0) + 0.3 * np.sin(2 * np.pi * x / 40.0)
    noise = np.random.default_rng(1).standard_normal(x.size)
    narrow = synthesise("sncf_poor", 1000.0, 0.25, 1).level
    for level in (tones, noise, np.zeros(x.size), narrow[:-7], np.round(narrow, 6)):
        assert shown_band(level, 0.25) is None


def test_a_file_that_cannot_be_written_is_a_fault_and_leaves_nothing(tmp_path):
    track = Track(0.0, 1.0, np.zeros(9))
    with pytest.raises(InputError, match="nowhere"):
        write_track(track, tmp_path / "nowhere" / "track.csv")
    with pytest.raises(InputError):
        write_track(track, tmp_path)
    assert list(tmp_path.iterdir()) == []


MILLIMETRES = [
    text("distance_m,level_mm", w=1000 * W),
    text("distance [m],level [mm]", w=1000 * W),
    text("Distance [m], Level (mm)", w=1000 * W),
    text("level_mm\tdistance_km", x=1000 * W, w=X / 1000, sep="\t"),
    text('"Distance (km)";"Longitudinal level [mm]"', x=X / 1000, w=1000 * W, sep=";"),
    text("chainage [m],level_cm", w=100 * W),
    text().encode("utf-16"),
    text("distance_m level_m", sep=" "),
    "\n".join(["distance;level", "m;mm", *(f"{x};{1000 * w}" for x, w in zip(X, W, strict=True))]),
    text("\ufeffdistance_m,level_m"),
    text(end="\r\n"),
    text(end="\r"),
    text() + "\n\n",
    text().rstrip("\n"),
    "# made by hand\n\n" + text() + "# the end\n",
    '"Running Date","22/11/2022 7:44:40 AM"\nRows,12\n' + text(),
    "Line;4\nSpeed [km/h];80\n" + text("distance_m;level_m", sep=";"),
    text('"distance_m","level_m"', [f'"{x}"' for x in X], [f'"{w}"' for w in W]),
    text("distance_m,level_m,", w=[f"{w}," for w in W]) + ",,\n,,\n",
    text("distance_m,level_m,note", w=[f'{w},"good, so far"' for w in W]),
    text(x=[f" {x} " for x in X], w=[f"{w:.9e}" for w in W]),
]


@pytest.mark.parametrize("content", MILLIMETRES, ids=range(len(MILLIMETRES)))
def test_forms_that_are_promised(read, content):
    track = read(content)
    assert track.distance0 == 0.0
    assert track.step == pytest.approx(0.25, rel=1e-12)
    assert_allclose(track.level, W, rtol=0, atol=1e-15)
    assert track.name == "line4.csv"
    assert track.remarks == ()


@pytest.mark.parametrize("sep", [";", "\t"])
def test_decimal_commas(read, sep):
    comma = [[str(v).replace(".", ",") for v in values] for values in (X, W)]
    assert_allclose(read(text(f"distance_m{sep}level_m", *comma, sep=sep)).level, W, atol=1e-15)
    quoted = [[f'"{v}"' for v in values] for values in comma]
    assert_allclose(read(text(f"distance_m{sep}level_m", *quoted, sep=sep)).level, W, atol=1e-15)


@pytest.mark.parametrize("heading", ["level D1 [mm]", "level_d1_mm", "Level D1 (mm)"])
def test_a_band_in_the_heading_is_kept(read, heading):
    track = read(text(f"distance_m,{heading}", w=1000 * W))
    assert track.band == D1
    assert_allclose(track.level, W, atol=1e-15)


ONE_FAULT = [
    (with_line(5, "0.75,abc"), "row 5, column 'level_m': found 'abc'; expected a number"),
    (with_line(5, "x,0.001"), "row 5, column 'distance_m': found 'x'"),
    (with_line(5, "0.75,"), "row 5, column 'level_m': found a blank cell"),
    (with_line(5, ",0.001"), "row 5, column 'distance_m': found a blank cell"),
    (with_line(5, "0.75,nan"), "row 5, column 'level_m': found 'nan'; expected a finite number"),
    (with_line(5, "0.75,-inf"), "row 5, column 'level_m': found '-inf'; expected a finite"),
    (with_line(5, "0.75,1e999"), "row 5, column 'level_m': found '1e999'; expected a finite"),
    (with_line(5, "0.75,1_0"), "row 5, column 'level_m': found '1_0'"),
    (with_line(5, '0.75,"0,001"'), "row 5, column 'level_m': found '0,001'; .*decimal commas"),
    (with_line(5, "0.75"), "row 5: found 1 cells; expected 2"),
    (with_line(5, "0,75,0,001"), "row 5: found 4 cells; expected 2 .*decimal commas"),
    (with_line(5, "0.5,0.001"), "row 5, .*'distance_m': found 0.5 after 0.5, the same distance"),
    (without_line(5), "row 5, column 'distance_m': found 1 after 0.5, a gap; .*0.25"),
    (text(x=0 * X), "row 3, .*the same distance"),
    (text(x=X[:7], w=W[:7]), "below row 1: found 7 rows of numbers; expected at least 8"),
    ("distance_m,level_m\n", "row 1 and below: found no row of numbers"),
    ("", "an empty file"),
    (" \n\r\n", "an empty file"),
    ("\ufeff", "an empty file"),
    (text().split("\n", 1)[1], "row 1: found no header"),
    ("# note\n" + text().split("\n", 1)[1], "row 2: found no header"),
    (text("distance_m,level"), "row 1, column 'level': found no unit; expected one of m, km"),
    (text("distance_m,level [inch]"), "row 1, column 'level .inch.': found the unit 'inch'"),
    (text("distance,level_m"), "row 1, column 'distance': found no unit"),
    (text("distance_m,lvel_m"), "row 1: found no level column among .*is it 'lvel_m'"),
    (text("distnce [m],level_m"), "row 1: found no distance column among .*is it 'distnce .m.'"),
    (text("distance_m,level_m,level_mm", w=[f"{w},0" for w in W]), "several level columns"),
    (b"\x89PNG\r\n\x00\x00", "row 2, byte 6 of the file: found a zero byte"),
    (text("distance_m,level_m,Höhe").encode("latin-1"), "row 1: found 3 cells in the header"),
    (with_line(5, "0.75,0.001 é").encode("latin-1"), "row 5, column 'level_m': found '0.001 é'"),
    (with_line(5, "0.75,0.001 é").encode() + b"\xff", "byte .* found 0xff, which is not UTF-8"),
    ('"Ru\n', "row 1: found a quote that is not closed"),
    (with_line(5, "0.75,inv"), "row 5, column 'level_m': found 'inv'; .*--fill 0.25"),
    (text(w=[0.001] * 5 + [1e300] + [0.001] * 6), "row 7, column 'level_m': found '1e[+]300'"),
    (text(x=1e-300 * X), "row 2, column 'distance_m': found rows 2.5e-301 m apart"),
    (text(x=1e6 * X), "row 2, column 'distance_m': found rows 2.5e[+]05 m apart"),
    (text(w=3000 * W), "row .*, column 'level_m': found a level .* m off .*millimetres"),
    (text("distance_m;level_m", w=["0,5"] * 6 + ["1.234,5"] * 6, sep=";"), "'1.234,5'"),
]


@pytest.mark.parametrize(("content", "message"), ONE_FAULT, ids=range(len(ONE_FAULT)))
def test_a_fault_is_named_by_row_and_column(fault, content, message):
    found = fault(content)
    assert re.search(message, found), found


def test_row_numbers_count_every_line_of_the_file(fault):
    base = "# a comment\n\nRunning date,today\n" + text()
    lines = base.split("\n")
    lines[8] = "x,y"
    lines.insert(6, "# another")
    assert "row 10, column 'distance_m': found 'x'" in fault("\r\n".join(lines))


def test_falling_distances_are_named_where_they_fall(fault):
    swapped = X.copy()
    swapped[[4, 5]] = swapped[[5, 4]]
    message = fault(text(x=swapped))
    assert "row 7, column 'distance_m': found 1 after 1.25, a fall" in message
    assert "sort" in message


def test_all_faults_of_a_file_come_together(fault):
    content = with_line(4, "0.5,abc", with_line(9, "1.75,nan", text("distance_m,level")))
    content = with_line(13, "2.5,1", content)
    message = fault(content)
    for part in ("no unit", "row 4, ", "row 9, ", "row 13, column 'distance_m': found 2.5 after"):
        assert part in message
    # The rows around a bad one are no gap.
    assert len(message.split("\n")) == 4


def test_many_faults_are_cut_at_ten_and_counted(fault):
    message = fault(text(w=["x"] * 12))
    assert len(message.split("\n")) == 11
    assert "2 more such faults" in message


def test_distances_are_shown_in_the_file_s_own_unit(fault):
    x = X / 1000
    x[6:] += 0.0005
    message = fault(text("distance_km,level_m", x=x))
    assert "row 8, column 'distance_km': found 0.002 after 0.00125, a gap" in message


def test_rounded_distances_are_an_even_grid(read):
    """0.25 m to one place, 1/3 m to two, and sums that drift in the last bits."""
    for x, step in (
        ([f"{v:.1f}" for v in np.arange(40) * 0.25 + 1e-9], 0.25),
        ([f"{v:.2f}" for v in np.arange(40) / 3], 1 / 3),
        (np.cumsum(np.full(40, 0.1)), 0.1),
    ):
        track = read(text(x=x, w=0.001 * np.sin(np.arange(40.0))))
        assert track.step == pytest.approx(step, rel=0.01)
        assert np.array_equal(track.level, 0.001 * np.sin(np.arange(40.0)))
        assert track.remarks == ()


def test_uneven_steps_are_resampled_with_a_remark(read):
    x = np.cumsum(0.25 * (1 + 0.2 * np.sin(np.arange(200.0) / 9)))
    track = read(text(x=x, w=0.003 * np.sin(x / 2)))
    low, high = np.argmin(np.diff(x)) + 3, np.argmax(np.diff(x)) + 3  # as an editor counts
    assert f"uneven steps of 0.2 to 0.3 m (before rows {low} and {high}) were" in track.remarks[0]
    assert track.distance[[0, -1]] == pytest.approx([x[0], x[-1]])
    assert_allclose(track.level, 0.003 * np.sin(track.distance / 2), rtol=0, atol=1e-8)


def test_slips_of_the_unit_are_remarked(read):
    assert "slope" in read(text(w=100 * W)).remarks[0]
    assert "only" in read(text("distance_m,level_mm")).remarks[0]
    assert "from zero" in read(text(w=W + 130.0)).remarks[0]
    assert read(text(w=0 * W)).remarks == ()


def test_what_is_not_a_file_is_a_fault(tmp_path):
    with pytest.raises(InputError, match="a folder"):
        read_track(tmp_path)
    with pytest.raises(InputError, match=r"no such file.*check the path"):
        read_track(tmp_path / "missing.csv")
    with pytest.raises(InputError):
        read_track(str(tmp_path / "a\0b.csv"))
