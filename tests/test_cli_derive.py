"""Derivations as documents on the command line: the picture beside them, and what is refused."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.parametrize(("form", "suffix", "start"), [("markdown", ".md", b"<?xml"),
                                                       ("latex", ".tex", b"%PDF")])  # fmt: skip
@pytest.mark.parametrize("options", [["--segments", "2"], ["--segments", "2", "--system", "body"],
                                     ["--system", "half-body-free"]])  # fmt: skip
def test_a_document_has_its_picture_beside_it(run, tmp_path, form, suffix, start, options):
    document = tmp_path / f"my coach{suffix}"
    code, out, err = run("derive", *options, "--format", form, "--output", document)
    assert (code, out) == (0, ""), err
    (picture,) = (path for path in tmp_path.iterdir() if path != document)
    assert picture.stem == "my coach_coordinates"
    assert picture.read_bytes().startswith(start)
    text = document.read_text(encoding="utf-8")
    name = picture.name.replace(" ", "%20") if form == "markdown" else picture.name
    assert text.count(name) == 1
    shown = f"--output 'my coach{suffix}'"
    assert shown.replace("--", "-{}-" if form == "latex" else "--") in text


def test_without_a_file_there_is_no_picture(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for options in (["--segments", "2"], ["--system", "half-body"]):
        code, out, _ = run("derive", *options, "--format", "markdown")
        assert code == 0
        assert "![" not in out
        assert "--output" not in out
    assert list(tmp_path.iterdir()) == []


def test_a_pipe_has_no_place_for_a_picture(tmp_path):
    words = ["derive", "--segments", "1", "--format", "markdown", "--output", "/dev/stdout"]
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-m", "railride", *words], cwd=tmp_path, capture_output=True, check=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
    )  # fmt: skip
    assert b"# cati2024" in done.stdout
    assert b"![" not in done.stdout
    assert list(tmp_path.iterdir()) == []


def test_no_plots_are_loaded_unless_a_picture_is_drawn():
    code = ("import sys; from railride.cli import app; "
            "app(['derive', '--segments', '1', '--format', 'markdown'], standalone_mode=False); "
            "sys.exit('matplotlib' in sys.modules)")  # fmt: skip
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-c", code], capture_output=True, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("system", ["body", "half-body", "half-body-free"])
@pytest.mark.parametrize("form", ["table", "json", "csv"])
def test_what_is_a_document_only_says_so(run, system, form):
    code, out, err = run("derive", "--system", system, "--format", form)
    assert (code, out) == (2, "")
    assert f"--system {system}" in err
    assert "markdown or latex" in err


def test_the_body_alone_is_chosen_as_the_vehicles_body_is(run):
    code, out, _ = run("derive", "--system", "body", "--segments", "3", "--format", "markdown")
    assert code == 0
    assert out.startswith("# cati2024: a car body of 3 rigid segments, alone and free\n")
    assert "z_b1" not in out
    assert run("derive", "--system", "body", "--body", "beam", "--modes", "2", "--format",
               "markdown")[0] == 0  # fmt: skip
    assert run("derive", "--system", "half-body", "--segments", "3", "--format", "latex")[0] == 2


def test_the_picture_takes_nobodys_place(run, tmp_path):
    """A folder in its place, or the vehicle's own file, is told before anything is written."""
    (tmp_path / "a_coordinates.svg").mkdir()
    code, _, err = run("derive", "--format", "markdown", "--output", tmp_path / "a.md")
    assert code == 2
    assert "its picture" in err
    vehicle = tmp_path / "b_coordinates.svg"
    shipped = ROOT / "data" / "vehicles" / "cati2024.toml"
    vehicle.write_text(shipped.read_text(encoding="utf-8"), encoding="utf-8")
    code, _, err = run("derive", "--vehicle", vehicle, "--format", "markdown", "--output",
                       tmp_path / "b.md")  # fmt: skip
    assert code == 2
    assert "another file" in err
    assert not (tmp_path / "a.md").exists()
    assert not (tmp_path / "b.md").exists()
