"""``railride modes``: over a parameter, drawn and in motion."""

from __future__ import annotations

import csv
import io
import json
from functools import partial

import numpy as np
import pytest
from PIL import Image
from vehicles import paper_coach

from railride import plots
from railride.loci import mode_locus
from railride.modal import modes


@pytest.fixture
def run(run):
    return partial(run, "modes", "--segments", "2")


def size(path):
    with Image.open(path) as picture:
        return picture.size


RANGE = ("--vary", "c_2", "--from", "10 kN*s/m", "--to", "200 kN*s/m", "--points", "5")


def test_a_locus_is_the_same_in_every_form(run):
    expected = mode_locus(paper_coach(2), c_2=np.linspace(10e3, 200e3, 5))
    code, out, err = run(*RANGE, "--format", "json")
    assert code == 0, err
    document = json.loads(out)
    assert list(document) == ["parameter", "unit", "locus", "remarks"]
    assert (document["parameter"], document["unit"]) == ("c_2", "N s/m")
    assert document["locus"] == expected.to_dict("records")
    rows = list(csv.DictReader(io.StringIO(run(*RANGE, "--format", "csv")[1])))
    assert [float(row["frequency_hz"]) for row in rows] == expected["frequency_hz"].tolist()
    assert [row["label"] for row in rows] == expected["label"].tolist()


def test_the_table_of_a_locus_has_a_line_for_each_value(run):
    out = run(*RANGE)[1]
    lines = [line.split() for line in out.splitlines()]
    assert out.startswith("Modes over c_2: |λ|/2π [Hz] and damping ratio of each branch")
    first = next(line for line in lines if line[:1] == ["10000"])
    heave = modes(paper_coach(2), c_2=10e3)[0]
    assert first[1:3] == [f"{heave.frequency_hz:.4f}", f"{heave.damping_ratio:.4f}"]
    assert sum(line[:1] == ["200000"] for line in lines) == 2  # two blocks of branches
    assert "–" in out  # branches that begin where a pair became real
    assert max(map(len, out.splitlines())) <= 120


def test_spacing_and_keys_of_parameter_files(run):
    options = ("--vary", "secondary_damping", "--from", "1e3", "--to", "100 kN*s/m", "--points",
               "3", "--log", "--format", "json")  # fmt: skip
    rows = json.loads(run(*options)[1])["locus"]
    assert sorted({row["c_2"] for row in rows}) == pytest.approx([1e3, 1e4, 1e5])
    rows = json.loads(run(*RANGE[:-2], "--format", "json")[1])["locus"]
    assert len({row["c_2"] for row in rows}) == 60


def test_a_locus_is_drawn(run, tmp_path):
    code, out, err = run(*RANGE, "--plot", tmp_path / "locus.png")
    assert code == 0
    assert f"drawn: {tmp_path / 'locus.png'}" in err
    assert "Modes over" in out
    assert size(tmp_path / "locus.png") == (1800, 840)


def test_mode_shapes_are_drawn_and_one_is_animated(run, tmp_path):
    code, out, err = run("--plot", tmp_path / "all.png", "--animate", tmp_path / "1.gif")
    assert code == 0, err
    assert out.startswith("Modes\n")
    pictures = ("--plot", tmp_path / "one.png", "--animate", tmp_path / "5.gif")
    code, out, err = run(*pictures, "--mode", "Bending 1")
    assert code == 0, err
    assert size(tmp_path / "one.png")[1] < size(tmp_path / "all.png")[1] / 2
    plots.animate_mode(paper_coach(2), modes(paper_coach(2))[4], tmp_path / "same.gif")
    assert (tmp_path / "5.gif").read_bytes() == (tmp_path / "same.gif").read_bytes()
    assert (tmp_path / "5.gif").read_bytes() != (tmp_path / "1.gif").read_bytes()


def test_shapes_that_are_left_out_are_remarked_on(run, tmp_path):
    code, out, err = run("--plot", tmp_path / "a.png", "--count", 6, "--format", "json")
    assert code == 0, err
    remark = "--plot: not drawn: bogie pitch, anti-phase (14.07 Hz)"
    assert f"remark: {remark}\n" in err
    assert remark in json.loads(out)["remarks"]
    assert "not drawn" not in run("--plot", tmp_path / "a.png")[2]
    assert "not drawn" not in run("--plot", tmp_path / "a.png", "--mode", 1)[2]


def test_of_modes_with_one_label_the_phase_tells_which(run, tmp_path):
    code, _, err = run("--plot", tmp_path / "a.png", "--mode", "bogie heave")
    assert code == 2
    assert (
        "found 'bogie heave', of which there are 2; expected one of 3 (bogie heave, anti-phase"
        in err
    )
    for text in ("bogie heave, in phase", "bogie heave in phase", "4"):
        assert run("--plot", tmp_path / "a.svg", "--mode", text)[0] == 0
    assert "bogie heave, in phase" in run()[1]


def test_json_has_share_and_phase_beside_the_label(run):
    found = json.loads(run("--format", "json")[1])["modes"]
    pitching = [mode for mode in found if mode["label"] == "bogie pitch"]
    assert [mode["phase"] for mode in pitching] == ["in phase", "anti-phase"]
    assert found[0]["phase"] is None
    assert found[0]["share"] == pytest.approx(1, abs=0.01)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--vary", "c_2"), ("no --from with it", "no --to with it")),
        (("--from", "1", "--to", "2"), ("--from: found no --vary", "--to: found no --vary")),
        (("--points", "5"), ("--points: found no --vary",)),
        (("--log",), ("--log: found no --vary",)),
        ((*RANGE, "--animate", "a.gif"), ("--vary: found --animate with it",)),
        ((*RANGE, "--plot", "a.png", "--mode", "1"), ("--vary: found --mode with it",)),
        (("--count", "3"), ("--count: found no --plot with it",)),
        (("--plot", "a.png", "--count", "3", "--mode", "1"), ("--count: found --mode with it",)),
        (("--plot", "a.png", "--count", "0"), ("--count: found '0'; expected a whole number",)),
        ((*RANGE, "--plot", "a.png", "--count", "3"), ("--vary: found --count with it",)),
        (("--mode", "1"), ("--mode: found neither --plot nor --animate",)),
        (("--animate", "a.mp4"), ("suffix '.mp4'; expected .gif",)),
        (("--plot", "a.gif"), ("suffix '.gif'; expected one of .png, .pdf, .svg",)),
        (("--animate", "no/such/a.gif"), ("no folder 'no/such'",)),
        (("--animate", "a.gif", "--output", "a.gif"), ("another file",)),
        (("--animate", "a.gif", "--mode", "0"), ("a whole number from 1 to 7",)),
        (("--animate", "a.gif", "--mode", "8"), ("a whole number from 1 to 7",)),
        (("--animate", "a.gif", "--mode", "roll"), ("found 'roll'; expected one of 1 (heave",)),
        (("--vary", "c_3", "--from", "1", "--to", "2"), ("found 'c_3'", "did you mean")),
        (("--vary", "c_2", "--from", "5", "--to", "5"), ("below that of --to",)),
        (("--vary", "c_2", "--from", "5 m", "--to", "x"), ("(a length)", "found 'x'")),
        (("--vary", "c_2", "--from", "0", "--to", "1e5", "--log"), ("values above 0",)),
        (("--vary", "c_2", "--from", "-1e4", "--to", "1e5"), ("c_2 = -10000", "unstable")),
        ((*RANGE[:-1], "1"), ("--points: found '1'; expected a whole number from 2 to 5000",)),
    ],
)
def test_bad_options(run, tmp_path, monkeypatch, options, words):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*options)
    assert (code, out) == (2, "")
    assert err.startswith("railride: ")
    for word in words:
        assert word in err
    assert list(tmp_path.iterdir()) == []
