"""``railride comfort`` from file to table: against tones of known weighted value; its promises."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

from railride.weightings import weighting

# ISO 2631-1:1997, Table 3, W_k × 1000 at nominal third-octave frequencies, Hz.
WK = {0.5: 418, 0.8: 477, 1.0: 482, 1.6: 494, 2.0: 531, 3.15: 804, 4.0: 967, 5.0: 1039, 8.0: 1036,
      12.5: 902, 16.0: 768, 20.0: 636, 31.5: 405, 40.0: 314, 50.0: 246, 63.0: 186,
      80.0: 132}  # fmt: skip


@pytest.fixture
def rated(run):
    """The JSON of a record that must be rated."""

    def call(*arguments):
        code, out, err = run("comfort", *arguments, "--format", "json")
        assert code == 0, err
        document = json.loads(out, parse_constant=pytest.fail)
        assert [f"remark: {said}" for said in document["remarks"]] == err.splitlines()
        return document

    return call


def tones(rate, frequencies, seconds):
    """Tones that rise from rest over 5 s and go on, one column each, with their time."""
    t = np.arange(round(seconds * rate)) / rate
    rise = np.sin(np.pi / 2 * np.minimum(t / 5.0, 1.0)) ** 2
    columns = {f"a_{f:g}": rise * np.sin(2 * np.pi * f * t + 0.3) for f in frequencies}
    return {"time_s": t, **columns}


def write_csv(path, columns):
    rows = np.column_stack(list(columns.values()))
    np.savetxt(path, rows, delimiter=",", header=",".join(columns), comments="", fmt="%.9g")


@pytest.mark.parametrize("rate", [100, 200, 250, 1000, 10_000])
def test_tones_in_third_octaves_through_the_whole_command(rated, tmp_path, rate):
    """Blocks of 5 s, away from the start, have the table's value to 1 % up to 0.4·fs."""
    frequencies = [f for f in WK if f <= min(80.0, 0.4 * rate)]
    if rate == 10_000:
        frequencies = [1.0, 8.0, 31.5, 80.0]
    file = tmp_path / "tones.csv"
    write_csv(file, tones(rate, frequencies, 25))
    columns = [option for f in frequencies for option in ("--column", f"a_{f:g}")]
    found = rated(file, *columns)
    assert found["rate_hz"] == pytest.approx(rate, rel=1e-9)
    assert found["duration_s"] == pytest.approx(25.0, rel=1e-9)
    for f in frequencies:
        values = [block[f"a_{f:g} Wk [m/s^2]"] for block in found["blocks"]]
        # The computed filter is within 0.3 % of the table's rounded figures.
        assert values[2:4] == pytest.approx([WK[f] / 1000 / np.sqrt(2)] * 2, rel=0.01), f
    axes = {axis["column"]: axis for axis in found["axes"]}
    assert all(axis["weighting"] == "Wk" for axis in axes.values())
    said = [remark for remark in found["remarks"] if f"sampled at {rate} Hz" in remark]
    assert bool(said) == (rate < 200)


def test_three_axes_their_sum_and_their_scales(rated, tmp_path):
    rate, t = 200, np.arange(400 * 200) / 200
    a = {"x": 0.2, "y": 0.3, "z": 0.5}
    tone = np.sin(2 * np.pi * 2.0 * t)
    file = tmp_path / "floor.csv"
    write_csv(file, {"t [s]": t, **{f"{n} [m/s²]": size * tone for n, size in a.items()}})
    found = rated(file)
    assert [axis["direction"] for axis in found["axes"]] == ["x", "y", "z"]
    assert [axis["weighting"] for axis in found["axes"]] == ["Wd", "Wd", "Wk"]
    gain = {n: abs(weighting(w).response(2.0)) for n, w in (("x", "Wd"), ("y", "Wd"), ("z", "Wk"))}
    expected = {n: size * gain[n] / np.sqrt(2) for n, size in a.items()}
    for axis in found["axes"]:
        assert axis["a_wrms"] == pytest.approx(expected[axis["direction"]], rel=2e-3)
        assert axis["a_rms"] == pytest.approx(a[axis["direction"]] / np.sqrt(2), rel=1e-3)
    # ISO 2631-1 Eq (10), standing; N_MV of a steady tone is 6 times the sum of its r.m.s. values.
    assert found["total"]["a_v"] == pytest.approx(np.hypot(*[np.hypot(*list(expected.values())[:2]),
                                                             expected["z"]]), rel=2e-3)  # fmt: skip
    assert found["total"]["posture"] == "standing"
    vertical = a["z"] * abs(weighting("Wb_en12299").response(2.0)) / np.sqrt(2)
    steady = 6 * np.sqrt(expected["x"] ** 2 + expected["y"] ** 2 + vertical**2)
    assert found["n_mv"] == pytest.approx(steady, rel=3e-3)
    assert {"EN 12299 mean comfort", "UIC 513"} <= set(found["levels"])
    assert "ISO 2631-1 Annex C" in found["axes"][2]["levels"]
    assert len(found["blocks"]) == 80
    feet = rated(file, "--posture", "feet")
    assert [axis["weighting"] for axis in feet["axes"]] == ["Wk"] * 3
    assert feet["total"]["factors"] == {"x": 0.25, "y": 0.25, "z": 0.4}
    assert rate / found["rate_hz"] == pytest.approx(1.0)


def test_columns_weightings_and_units_in_their_order(rated, tmp_path):
    t = np.arange(4000) / 200
    g = 9.80665
    file = tmp_path / "sensor.txt"
    write_csv(file, {"down": np.sin(2 * np.pi * 4 * t) + 1.0, "side": 0.1 * np.cos(9 * t)})
    found = rated(file, "--rate", "200 Hz", "--column", "side", "--column", "down", "--unit", "g",
                  "--weighting", "Wd", "--weighting", "Wk", "--detrend")  # fmt: skip
    assert [(a["column"], a["weighting"]) for a in found["axes"]] == [
        ("side", "Wd"),
        ("down", "Wk"),
    ]
    wk = abs(weighting("Wk").response(4.0))
    assert found["axes"][1]["a_wrms"] == pytest.approx(g * wk / np.sqrt(2), rel=0.02)


def test_table_csv_blocks_and_picture(run, tmp_path):
    t = np.arange(6000) / 200
    file, picture, over_time = (tmp_path / n for n in ("z.csv", "z.png", "blocks.csv"))
    write_csv(file, {"time_s": t, "z": np.sin(2 * np.pi * 5 * t)})
    code, out, err = run("comfort", file, "--plot", picture, "--blocks", over_time)
    assert code == 0, err
    for words in ("z.csv: 30 s at 200 Hz", "a_wrms", "Comfort by scale", "Comfort over time",
                  "Sperling Wz"):  # fmt: skip
        assert words in out
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert f"drawn: {picture}" in err
    blocks = list(csv.DictReader(io.StringIO(over_time.read_text(encoding="utf-8"))))
    assert [float(block["start [s]"]) for block in blocks] == [0, 5, 10, 15, 20, 25]
    code, out, _ = run("comfort", file, "--format", "csv")
    (row,) = csv.DictReader(io.StringIO(out))
    assert float(row["a_wrms"]) == pytest.approx(abs(weighting("Wk").response(5.0)) / 2**0.5,
                                                 rel=0.01)  # fmt: skip
    assert "ISO 2631-1 Annex C: fairly uncomfortable" in row["levels"]


def test_many_blocks_are_listed_in_part(run, tmp_path):
    t = np.arange(300 * 100) / 100
    write_csv(tmp_path / "z.csv", {"time_s": t, "z": np.sin(2 * np.pi * 5 * t)})
    code, out, _ = run("comfort", tmp_path / "z.csv")
    assert code == 0
    assert "the first 40, 20 more in JSON and --blocks" in out


@pytest.mark.parametrize(("options", "words"), [
    (["--rate", "100", "--time-column", "time_s"], ["--rate", "--time-column"]),
    (["--rate", "0"], ["--rate", "above 0"]),
    (["--weighting", "Wx"], ["Wx", "Wk"]),
    (["--weighting", "Wk", "--weighting", "Wd"], ["2", "1 axes"]),
    (["--posture", "lying"], ["lying", "recumbent"]),
    (["--unit", "furlong"], ["furlong"]),
    (["--column", "w"], ["w", "z"]),
    (["--plot", "z.bmp"], ["z.bmp", ".png"]),
    (["--output", "z.csv"], ["z.csv"]),
])  # fmt: skip
def test_bad_options(run, tmp_path, monkeypatch, options, words):
    monkeypatch.chdir(tmp_path)
    t = np.arange(2000) / 100
    write_csv(tmp_path / "z.csv", {"time_s": t, "z": np.sin(t)})
    before = (tmp_path / "z.csv").read_bytes()
    code, out, err = run("comfort", "z.csv", *options)
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    for word in (*words, "found", "expected"):
        assert word in err
    assert (tmp_path / "z.csv").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["z.csv"]
