"""``railride export``: files, options, messages."""

from __future__ import annotations

import numpy as np
import pytest


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


@pytest.mark.parametrize(("arguments", "parts"), [
    ([], ["--to", "one of", "npz"]),
    (["--to", "excel"], ["--to", "'excel'", "one of", "matlab"]),
    (["--to", "npz"], ["--output", "nothing", "name of a file"]),
    (["--to", "npz", "--output", "no/such/x.npz"], ["--output", "no folder"]),
    (["--to", "npz", "--output", "x.npz", "--at", "0", "--signal", "f"], ["--at", "--signal"]),
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
