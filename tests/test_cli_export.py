"""``railride export``: files, options, messages."""

from __future__ import annotations

import numpy as np
import pytest

from railride.exports.targets import TARGETS


def test_a_file_with_the_chosen_outputs(run, tmp_path):
    file = tmp_path / "coach.npz"
    code, out, err = run("export", "--to", "npz", "--segments", "2", "--output", file,
                         "--signal", "secondary_1_deflection")  # fmt: skip
    assert (code, out) == (0, "")
    assert "remark: cati2024" in err
    assert np.load(file)["outputs"].tolist() == ["secondary_1_deflection"]


def test_points_of_the_floor(run, tmp_path):
    file = tmp_path / "coach.npz"
    assert run("export", "--to", "npz", "--output", file, "--at", "2.5", "--at", "0")[0] == 0
    outputs = np.load(file)["outputs"].tolist()
    assert outputs[:2] == ["floor_acceleration_2_5m_ahead", "floor_acceleration"]
    assert "primary_4_deflection" in outputs


def test_the_floors_signal_is_at_every_point_on_the_chosen_line(run, tmp_path):
    file = tmp_path / "coach.npz"
    code, *_ = run("export", "--to", "npz", "--output", file, "--signal", "secondary_1_deflection",
                   "--signal", "floor_acceleration", "--at", "2.5", "--at", "0",
                   "--floor", "polygon")  # fmt: skip
    assert code == 0
    assert np.load(file)["outputs"].tolist() == [
        "secondary_1_deflection",
        "floor_acceleration_2_5m_ahead_polygon",
        "floor_acceleration_polygon",
    ]


BEGINNINGS = {"modelica": b"within ;", "python": b'"""', "c": b"/*", "latex": b"\\document",
              "fmu": b"PK", "npz": b"PK", "matlab": b"MATLAB 5.0"}  # fmt: skip


@pytest.mark.parametrize("target", TARGETS)
def test_every_form_is_written(run, tmp_path, target):
    file = tmp_path / "coach"
    code, out, err = run("export", "--to", target, "--segments", "2", "--output", file)
    assert (code, out) == (0, "")
    assert "remark: cati2024" in err
    assert file.read_bytes().startswith(BEGINNINGS[target])


@pytest.mark.parametrize(("arguments", "parts"), [
    ([], ["--to", "one of", "npz"]),
    (["--to", "excel"], ["--to", "'excel'", "one of", "matlab"]),
    (["--to", "npz"], ["--output", "nothing", "name of a file"]),
    (["--to", "npz", "--output", "no/such/x.npz"], ["--output", "no folder"]),
    (["--to", "npz", "--output", "x.npz", "--at", "1", "--signal", "primary_1_deflection"],
     ["floor", "points of it, [1.0] m", "'floor_acceleration' among the outputs"]),
    (["--to", "c", "--output", "x.c", "--floor", "polygon", "--signal", "primary_1_deflection"],
     ["floor", "polygon", "'floor_acceleration' among the outputs"]),
    (["--to", "modelica", "--output", "x.mo", "--track", "erri_low", "--signal",
      "primary_1_deflection"], ["track", "'floor_acceleration' among them"]),
    (["--to", "npz", "--output", "x.npz", "--signal", "flor"], ["'flor'", "floor_acceleration"]),
    (["--to", "npz", "--output", "x.npz", "--at", "99"], ["99", "found", "expected"]),
    (["--to", "npz", "--output", "x.npz", "--vehicle", "ice3", "--signal", "wheel_load_1"],
     ["wheel_load_1", "found", "expected"]),
])  # fmt: skip
def test_what_cannot_be_exported(run, tmp_path, monkeypatch, arguments, parts):
    monkeypatch.chdir(tmp_path)
    code, out, err = run("export", *arguments)
    assert (code, out) == (2, "")
    assert err.count("railride: ") == 1
    for part in parts:
        assert part in err
    assert not list(tmp_path.iterdir())


def test_a_modelica_package_goes_to_the_terminal(run):
    code, out, err = run("export", "--to", "modelica", "--segments", "2")
    assert code == 0
    assert out.startswith("within ;\npackage cati2024 ")
    assert out.endswith("end cati2024;\n")
    assert "model Ride" not in out
    assert "remark: cati2024" in err


def test_a_modelica_package_with_the_track_inside(run, tmp_path):
    file = tmp_path / "ride.mo"
    code, out, _ = run("export", "--to", "modelica", "--segments", "2", "--track", "erri_low",
                       "--speed", "200", "--length", "50", "--output", file)  # fmt: skip
    assert (code, out) == (0, "")
    assert 'model Ride "cati2024 over erri_low' in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(("arguments", "parts"), [
    (["--to", "npz", "--output", "x.npz", "--track", "erri_low"], ["--track", "--to npz"]),
    (["--to", "modelica", "--seed", "3"], ["--seed", "no --track"]),
    (["--to", "modelica", "--step", "0.25"], ["--step", "no --track"]),
    (["--to", "modelica", "--track", "erri_lo"], ["erri_lo", "found", "expected"]),
    (["--to", "modelica", "--track", "erri_low", "--speed", "0"], ["--speed", "above 0"]),
])  # fmt: skip
def test_rides_that_cannot_be_exported(run, arguments, parts):
    code, out, err = run("export", *arguments)
    assert (code, out) == (2, "")
    for part in parts:
        assert part in err
