"""``railride track`` and ``ride`` over measured tracks and over spectra from files."""

from __future__ import annotations

import json

import numpy as np
import pytest

from railride.spectra import spectrum, spectrum_names
from railride.track import synthesise

X = np.arange(2400) * 0.25
LEVEL = 1000 * synthesise("sncf_good", X[-1], 0.25, 3).level  # mm


@pytest.fixture
def result(run):
    """Run a command that must succeed: its JSON document."""

    def call(*arguments):
        code, out, err = run(*arguments, "--format", "json")
        assert code == 0, err
        return json.loads(out, parse_constant=pytest.fail)

    return call


@pytest.fixture
def refused(run):
    """Run a command that must be refused: its message."""

    def call(*arguments):
        code, out, err = run(*arguments)
        assert (code, out) == (2, ""), err
        assert err.count("railride: ") == 1
        return err

    return call


@pytest.fixture
def car(tmp_path):
    """A file with two rails in two bands, at kilometre and metre."""
    head = "Location [km+m],Left level D1 [mm],Right level D1 [mm],Level D2 left [mm],Versine [mm]"
    rows = [f"12+{x:07.2f},{w - 1},{w + 1},{2 * w},0" for x, w in zip(X, LEVEL, strict=True)]
    (tmp_path / "car.csv").write_text("\n".join([head, *rows]) + "\n")
    return tmp_path / "car.csv"


@pytest.fixture
def own(tmp_path):
    """A file with a spectrum: sncf_good, 10 to 40 m."""
    wavelength = np.geomspace(10.0, 40.0, 50)
    density = spectrum("sncf_good").density(2 * np.pi / wavelength)
    rows = [f"{a},{b}" for a, b in zip(wavelength, density, strict=True)]
    text = "wavelength [m],one-sided density [m^2/(rad/m)]\n" + "\n".join(rows) + "\n"
    (tmp_path / "own.csv").write_text(text)
    return tmp_path / "own.csv"


def test_a_measured_track_is_compared_with_every_standard_spectrum(result, car):
    found = result("track", car)
    assert found["best_spectrum"] == "sncf_good"
    assert {row["spectrum"] for row in found["spectra"]} == set(spectrum_names())
    best = found["spectra"][0]
    assert set(best) == {
        "spectrum", "misfit_db", "level_ratio", "wavelengths_m", "third_octaves"
    }  # fmt: skip
    assert best["misfit_db"] < 1.5
    assert best["level_ratio"] == pytest.approx(1.0, abs=0.1)
    assert found["d1_rms_mm"] > 0
    assert found["d2_rms_mm"] is None  # filtered to D1


def test_a_written_track_has_no_value_where_its_spectrum_had_none(result, tmp_path):
    made = result("track", "--spectrum", "sncf_poor", "--write", str(tmp_path / "s.csv"))
    read = result("track", str(tmp_path / "s.csv"))
    assert made["d2_rms_mm"] is None
    assert read["d2_rms_mm"] is None
    assert read["d1_rms_mm"] == made["d1_rms_mm"]
    assert any("of wavelengths 1.99" in remark for remark in read["remarks"])


def test_the_table_shows_the_best_fit_first(run, car):
    code, out, err = run("track", car)
    assert code == 0, err
    below = out.split("best fit first")[1]
    assert below.index("sncf_good") < below.index("erri_low")
    assert "D1 was read; D2 are there too" in err


def test_columns_units_direction_and_dropouts_have_options(result, refused, car, tmp_path):
    left = result("track", car, "--level-column", "Level D2 left")
    both = result(
        "track", car, "--level-column", "Right level D1", "--level-column", "Left level D1"
    )
    assert left["rms_mm"] == pytest.approx(2 * both["rms_mm"], rel=1e-9)
    assert result("track", car, "--reverse")["rms_mm"] == pytest.approx(both["rms_mm"], rel=1e-9)
    twice = result("track", car, "--step", "0.5")
    assert (twice["step_m"], twice["length_m"]) == (0.5, 1199.5)
    bare = tmp_path / "bare.csv"
    rows = [f"{x},{w}" for x, w in zip(X, LEVEL, strict=True)]
    rows[40:44] = [f"{x}," for x in X[40:44]]
    bare.write_text("s,w\n" + "\n".join(rows) + "\n")
    assert "no distance column" in refused("track", bare)
    named = ("--distance-column", "s", "--distance-unit", "m", "--level-column", "w",
             "--level-unit", "mm")  # fmt: skip
    assert "row 42, column 'w': found a blank cell" in refused("track", bare, *named)
    filled = result("track", bare, *named, "--fill", "1")
    assert filled["length_m"] == X[-1]
    assert any("1 m without a level, bridged" in said for said in filled["remarks"])
    assert "versine" in refused("track", car, "--level-column", "Versine")


def test_a_ride_reads_tracks_with_the_same_options(result, refused, car):
    given = ("ride", "--track", car, "--length", "200", "--speed", "100", "--segments", "1")
    one = result(*given, "--level-column", "Left level D1")
    two = result(*given)
    # The same but for the datum, which changes nothing.
    assert one["cases"][0]["a_wrms"] == pytest.approx(two["cases"][0]["a_wrms"], rel=1e-6)
    assert any("D1 was read" in said for said in two["remarks"])
    back = result(*given, "--reverse")
    assert any("to its start" in said for said in back["remarks"])
    assert back["cases"][0]["a_wrms"] != two["cases"][0]["a_wrms"]
    assert "--level-column" in refused("ride", "--level-column", "x")
    assert "--fill" in refused("ride", "--track", car, "--fill", "-1")
    assert "--step" in refused("map", "--track", car, "--step", "nan")


def test_a_spectrum_from_a_file_is_one_wherever_a_name_is(result, refused, own, car):
    made = result("track", "--spectrum", own, "--length", "2000", "--step", "0.5")
    assert made["best_spectrum"] == "sncf_good"
    shipped = result("track", "--spectrum", "sncf_good", "--length", "2000", "--step", "0.5")
    assert made["rms_mm"] < shipped["rms_mm"]
    given = ("--spectral", "--speed", "200", "--segments", "1")
    narrow = result("ride", "--track", own, *given)
    wide = result("ride", "--track", "sncf_good", *given)
    assert 0 < narrow["cases"][0]["a_wrms_exact"] < wide["cases"][0]["a_wrms_exact"]
    assert any("own.csv holds wavelengths of 10 to 40 m only" in r for r in narrow["remarks"])
    more = result("ride", "--track", own, *given, "--extrapolate")
    assert more["cases"][0]["a_wrms_exact"] > narrow["cases"][0]["a_wrms_exact"]
    assert "a spectrum, densities" in refused("track", own)
    assert "no columns of a density" in refused("track", "--spectrum", car)
    assert "level for it" in refused("ride", "--track", own, "--level-column", "x")


def test_what_is_not_stated_of_a_spectrum_is_remarked_on(result, own):
    own.write_text(own.read_text().replace("one-sided ", ""))
    for command in (("track", "--spectrum", own), ("ride", "--track", own, "--spectral",
                                                   "--segments", "1")):  # fmt: skip
        assert any("taken to be one-sided" in said for said in result(*command)["remarks"])


def test_a_level_line_has_no_spectrum_to_compare(result, tmp_path):
    (tmp_path / "flat.csv").write_text("distance_m,level_m\n" + "".join(f"{x},0\n" for x in X))
    found = result("track", tmp_path / "flat.csv")
    assert found["best_spectrum"] is None
    assert found["spectra"] == []
    assert any("is level" in said for said in found["remarks"])


def test_the_options_of_a_file_need_one(refused):
    assert "name the file of a measured track" in refused("track", "--reverse")
    many = [part for name in "abc" for part in ("--level-column", name)]
    assert "3 of them" in refused("track", "car.csv", *many)
