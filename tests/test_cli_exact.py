"""What the command line gives from the spectrum: the map, third octaves, the modes' shares."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pandas as pd
import pytest

import railride as rr
from railride.stochastic import maps

COACH = ("--segments", "2", "--floor", "polygon")


def document(run, *arguments):
    """The JSON of a command that must succeed."""
    code, out, err = run(*arguments, "--format", "json")
    assert code == 0, err
    return json.loads(out, parse_constant=pytest.fail)


def test_the_map_holds_the_published_values_and_the_order_of_cases(run):
    found = document(run, "map", *COACH, "--speed", "145", "--speed", "200", "--at", "0", "--at", 3)
    assert found["track"] == "erri_low"
    assert [(c["speed_kmh"], c["position_m"]) for c in found["map"]] == [
        (145.0, 0.0), (145.0, 3.0), (200.0, 0.0), (200.0, 3.0)]  # fmt: skip
    assert round(found["map"][0]["a_wrms"], 4) == 0.2475  # exact integral by independent programs
    assert round(found["map"][2]["a_wrms"], 4) == 0.3275
    assert all(case["error"] < 1e-6 for case in found["map"])


def test_the_map_is_what_ride_says_at_each_speed(run):
    options = (*COACH, "--at", "0", "--at", "-8.75", "--track", "fra_6")
    here = document(run, "map", *options, "--from", "100", "--to", "160", "--points", "3")["map"]
    speeds = [option for v in (100, 130, 160) for option in ("--speed", v)]
    there = document(run, "ride", "--spectral", *options, *speeds)["cases"]
    for key in ("speed_kmh", "position_m", "a_rms", "a_wrms", "wz"):
        assert [c[key] for c in here] == pytest.approx([c[key] for c in there], rel=1e-9), key


def test_the_map_as_csv_and_as_a_table_of_bounded_size(run):
    code, out, _ = run("map", "--segments", 1, "--from", 100, "--to", 200, "--points", 81,
                       "--format", "csv")  # fmt: skip
    rows = list(csv.DictReader(io.StringIO(out)))
    assert code == 0
    assert len(rows) == 81 * 49
    assert {row["position_m"] for row in rows} >= {"-12.0", "0.0", "12.0"}
    code, out, _ = run("map", "--segments", 1, "--from", 100, "--to", 200, "--points", 81)
    assert code == 0
    assert "JSON, CSV and picture have all" in out
    lines = out.splitlines()
    below = lines[next(k for k, line in enumerate(lines) if "───" in line) + 1 :]
    assert len(below) == 27  # every third speed
    assert float(below[1].split()[1]) == pytest.approx(float(rows[3 * 49]["a_wrms"]), abs=5e-5)


@pytest.mark.parametrize("options", [
    ("--speed", 145, "--speed", 200),
    ("--at", 0, "--at", 8.75, "--points", 9),
    ("--points", 4),
])  # fmt: skip
def test_map_and_curves_are_drawn(run, tmp_path, options):
    picture = tmp_path / "map.png"
    code, _, err = run("map", "--segments", 1, *options, "--plot", picture)
    assert code == 0, err
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert f"drawn: {picture}" in err


def test_the_command_maps_the_speeds_that_python_does(run):
    found = document(run, "map", "--segments", 1, "--at", 0)["map"]
    assert [case["speed_kmh"] for case in found] == pytest.approx([3.6 * v for v in maps.SPEEDS])
    assert len(found) == 196


def test_pictures_say_what_they_are_of():
    coach = rr.derive_vehicle(rr.load_vehicle("cati2024"), segments=2)
    table = rr.comfort_map(coach, rr.spectrum("fra_6"), np.linspace(30, 60, 12), floor="polygon")
    over = "cati2024 (2 segments) over fra_6, polygon floor"
    assert rr.plot_comfort_map(table).get_title(loc="left") == f"{over}, Wk weighted"
    assert rr.plot_comfort_map(table, value="Wz").get_title(loc="left") == over
    middle = table[table["position [m]"] == 0.0]
    assert rr.plot_comfort_over_speed(middle).get_title(loc="left") == f"{over}, Wk weighted, 0 m"


def test_lines_of_equal_value_follow_the_spline_and_are_edged():
    """Of z = x y² they pass where it has their value, between the points as well."""
    x, y = np.linspace(10.0, 100.0, 7), np.linspace(-12.0, 12.0, 5)
    table = pd.DataFrame([{"speed [km/h]": v, "position [m]": p, "a_wrms [m/s^2]": v * p * p}
                          for v in x for p in y])  # fmt: skip
    ax = rr.plot_comfort_map(table)
    (lines,) = (drawn for drawn in ax.collections if hasattr(drawn, "levels"))
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        if len(path.vertices):
            v, p = path.vertices.T
            assert v * p * p == pytest.approx(level, abs=0.02 * 14400)
    assert lines.get_path_effects()
    assert all(label.get_path_effects() for label in lines.labelTexts)


def test_which_picture_suits_a_table():
    coach = rr.derive_vehicle(rr.load_vehicle("cati2024"), segments=1)
    table = rr.comfort_map(coach, rr.spectrum("erri_low"), [40.0, 50.0, 60.0])
    along = rr.plot_comfort(table).axes[0]
    assert "position" in along.get_xlabel()
    assert [len(line.get_xdata()) for line in along.get_lines()] == [49, 49, 49]
    few = table[table["position [m]"].isin([0.0, 12.0])]
    over = rr.plot_comfort(few[few["position [m]"] == 0.0]).axes[0]
    assert over.get_xlabel() == "speed [km/h]"
    many = rr.comfort_map(coach, rr.spectrum("erri_low"), [30.0 + k for k in range(9)])
    assert "speed" in rr.plot_comfort(many).axes[0].get_xlabel()
    assert len(rr.plot_comfort(many).axes) == 2  # the map and its scale


def test_third_octaves_add_up_to_the_ride(run):
    found = document(run, "ride", "--spectral", "--bands", *COACH, "--speed", 145, "--at", 0)
    bands = found["third_octaves"]
    assert [row["band_hz"] for row in bands][:3] == [0.1, 0.125, 0.16]
    assert bands[-1]["band_hz"] == 80.0
    total = sum(row["a_wrms"] ** 2 for row in bands)
    # 0.0891 to 89.1 Hz against 0.05 to 80 Hz: what differs is far from any mode.
    assert total == pytest.approx(found["cases"][0]["a_wrms"] ** 2, rel=1e-4)


def test_shares_of_the_modes_add_up_to_one_in_json(run):
    found = document(run, "ride", "--spectral", "--shares", *COACH, "--speed", 200, "--at", 0,
                     "--at", 8)  # fmt: skip
    rows = found["mode_shares"]
    for place in (0.0, 8.0):
        shares = {r["mode"]: r["share"] for r in rows if r["position_m"] == place}
        assert sum(shares.values()) == pytest.approx(1.0, rel=1e-9)
        assert max(shares, key=shares.get) == ("bending 1" if place == 0.0 else "bogie heave")


def test_tables_of_all_details_and_the_remark_on_csv(run):
    details = ("--travel", "--bands", "--shares")
    code, out, _ = run("ride", "--spectral", *COACH, "--speed", 145, *details)
    assert code == 0
    for title in ("Suspension travel", "Third octaves", "Shares of the modes", "bending 1"):
        assert title in out
    code, out, err = run("ride", "--spectral", *COACH, "--speed", 145, *details, "--format", "csv")
    assert code == 0
    assert len(out.splitlines()) == 2
    for option in details:
        assert f"{option} changes nothing in csv" in err


@pytest.mark.parametrize(("options", "words"), [
    (("--speed", "145", "--from", "10"), ("--speed", "--from", "one of the two")),
    (("--from", "200", "--to", "100"), ("--from", "200", "below that of --to")),
    (("--points", "1"), ("--points", "whole number from 2")),
    (("--speed", "0"), ("--speed", "above 0")),
    (("--speed", "nan"), ("--speed",)),
    (("--at", "13", "--speed", "145"), ("13", "12")),
    (("--weighting", "Wx"), ("Wx", "Wk")),
    (("--track", "erri"), ("erri", "erri_low")),
    (("--plot", "map.jpg"), ("map.jpg", ".png")),
    (("--floor", "bent"), ("bent", "smooth")),
])  # fmt: skip
def test_bad_options_of_the_map(run, options, words):
    code, out, err = run("map", "--segments", 1, *options)
    assert (code, out) == (2, "")
    assert err.count("railride: ") == 1
    for word in (*words, "found", "expected"):
        assert word in err
