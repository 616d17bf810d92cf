"""Bad input, one by one: exit code 2, one message that helps, and nothing written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from railride.cli import main

ROOT = Path(__file__).resolve().parents[1]
COACH = (ROOT / "data" / "vehicles" / "cati2024.toml").read_text(encoding="utf-8")
LINE = "distance_m,level_m\n" + "".join(f"{i / 4},{1e-3 * (i % 7)}\n" for i in range(801))


@pytest.fixture
def refused(capsys, tmp_path, monkeypatch):
    """Run a command that must be refused, and give its message."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        before = sorted(tmp_path.rglob("*"))
        kept = {path: path.read_bytes() for path in before if path.is_file()}
        with pytest.raises(SystemExit) as stopped:
            main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert stopped.value.code == 2, err
        assert out == ""
        assert "Traceback" not in err
        assert err.strip()
        assert err.count("railride: ") == 1
        assert sorted(tmp_path.rglob("*")) == before
        assert all(path.read_bytes() == content for path, content in kept.items())
        return err

    return call


def helps(message: str, *parts: str) -> None:
    """The message says where, what was found, what was expected."""
    for part in (*parts, "found", "expected"):
        assert part in message


# options


@pytest.mark.parametrize("text", ["0", "-1", "1.5", "2.0", "abc", "nan", "inf", "", " ", "1_0", "٤",
                                  "1e3", "9" * 5000])  # fmt: skip
def test_segments_that_are_no_whole_number(refused, text):
    helps(refused("derive", "--segments", text), "--segments", repr(text), "whole number from 1")


@pytest.mark.parametrize("text", ["0", "-145", "nan", "inf", "-inf", "1e999", "", "fast", "100 kg",
                                  "1,5", "0 m/s"])  # fmt: skip
def test_speeds_that_are_none(refused, text):
    message = refused("ride", "--speed", "100", "--speed", text, "--output", "out.json")
    helps(message, "--speed", "km/h")


@pytest.mark.parametrize(("option", "text", "mend"), [
    ("--speed", "100,200", "--speed 100 --speed 200"),
    ("--at", "8,75", "a decimal point"),
])  # fmt: skip
def test_several_values_in_one_option(refused, option, text, mend):
    helps(refused("ride", option, text), repr(text), mend)


@pytest.mark.parametrize(
    ("command", "option", "text", "expected"),
    [
        ("ride", "--length", "0", "above 0"),
        ("ride", "--length", "nan", "a length"),
        ("ride", "--length", "1000 kg", "a mass"),
        ("ride", "--at", "front", "a length"),
        ("ride", "--at", "inf", "a length"),
        ("ride", "--at", "13", "between -12 and 12 m"),
        ("ride", "--seed", "-1", "whole number from 0"),
        ("ride", "--seed", "1.5", "whole number from 0"),
        ("ride", "--seed", "4294967296", "to 4294967295"),
        ("ride", "--floor", "carpet", "smooth, polygon"),
        ("ride", "--weighting", "Wq", "Wk"),
        ("ride", "--track", "eri_low", "did you mean 'erri_low'"),
        ("modes", "--vehicle", "cati2042", "did you mean cati2024"),
        ("modes", "--format", "xml", "table, json, csv"),
        ("modes", "--body", "plate", "one of rigid, segments, beam"),
        ("modes", "--bending-frequency", "0", "above 0"),
        ("modes", "--bending-frequency", "-9", "above 0"),
        ("modes", "--bending-frequency", "9 kg", "a mass"),
        ("modes", "--joint-stiffness", "nan", "torsional stiffness"),
        ("modes", "--joint-stiffness", "3e8 N/m", "a stiffness"),
        ("modes", "--bending-damping", "1", "below 1"),
        ("modes", "--bending-damping", "-0.1", "at least 0"),
        ("modes", "--bending-damping", "inf", "plain number"),
        ("derive", "--system", "quarter", "half-body"),
        ("track", "--spectrum", "erri", "erri_low"),
        ("track", "--step", "0", "above 0"),
        ("track", "--step", "500", "steps"),
        ("track", "--length", "1e15", "steps"),
        ("track", "--seed", "x", "whole number"),
        ("track", "--plot", "drawing.xyz", ".png"),
    ],
)
def test_options_out_of_range(refused, command, option, text, expected):
    helps(refused(command, option, text), expected)


@pytest.mark.parametrize(
    "arguments",
    [
        ["modes", "--body", "rigid", "--segments", "4"],
        ["modes", "--bending-frequency", "9", "--joint-stiffness", "3e8"],
        ["modes", "--bending-frequency", "9", "--joint-stiffness", "3e8", "--body", "rigid"],
        ["ride", "--spectral", "--plots", "plots"],
        ["track", "line.csv", "--seed", "3"],
        ["track", "line.csv", "--spectrum", "erri_low"],
        ["track", "line.csv", "--extrapolate"],
        ["track", "--output", "same.csv", "--write", "./same.csv"],
        ["derive", "--nonlinear", "--format", "csv"],
        ["derive", "--system", "half-body"],
        ["derive", "--system", "half-body", "--format", "latex", "--segments", "4"],
    ],
    ids=" ".join,
)
def test_options_that_conflict(refused, arguments):
    helps(refused(*arguments), arguments[1] if arguments[1].startswith("-") else arguments[2])


def test_a_result_is_not_written_over_what_is_read(refused, tmp_path):
    (tmp_path / "line.csv").write_text(LINE)
    helps(refused("track", "line.csv", "--output", "line.csv"), "--output", "the file of the track")
    (tmp_path / "coach.toml").write_text(COACH)
    helps(refused("modes", "--vehicle", "coach.toml", "--output", "coach.toml"), "--vehicle")


def test_all_that_is_wrong_with_the_options_is_said_at_once(refused):
    message = refused("ride", "--speed", "x", "--seed", "y", "--segments", "z", "--format", "q",
                      "--output", "none/out")  # fmt: skip
    for option in ("--speed", "--seed", "--segments", "--format", "--output"):
        assert option in message


@pytest.mark.parametrize("asked", [["--segments", "4"], ["--body", "segments"]], ids=" ".join)
def test_segments_of_unknown_bending(refused, asked):
    message = refused("modes", "--vehicle", "manchester", *asked)
    helps(message, "manchester", " ".join(asked), "--bending-frequency", "--joint-stiffness")


def test_usage_errors_are_one_message(capsys):
    for arguments in (
        ["modes", "--foo"],
        ["sweep"],
        ["modes", "--segments"],
        ["track", "a", "b"],
        [],
    ):
        with pytest.raises(SystemExit) as stopped:
            main(arguments)
        out, err = capsys.readouterr()
        assert stopped.value.code == 2
        assert "Traceback" not in out + err
        assert err.count("Error") <= 1


# vehicles


@pytest.mark.parametrize(
    ("old", "new", "parts"),
    [
        ('mass = "34000 kg"', "", ["body.mass", "missing"]),
        ('mass = "34000 kg"', 'masss = "34000 kg"', ["masss", "mass"]),
        ('length = "24 m"', 'length = "24 m"\ncolour = "red"', ["body.colour"]),
        ('mass = "34000 kg"', 'mass = "34000 N/m"', ["body.mass", "34000 N/m", "a mass"]),
        ('mass = "34000 kg"', 'mass = "34000"', ["body.mass", "without a unit"]),
        ('mass = "34000 kg"', "mass = 34000", ["body.mass", "34000"]),
        ('mass = "34000 kg"', 'mass = "-34000 kg"', ["body.mass", "-34000"]),
        ('mass = "34000 kg"', 'mass = "0 kg"', ["body.mass", "0 kg"]),
        ('mass = "34000 kg"', 'mass = "nan kg"', ["body.mass", "nan"]),
        ('mass = "34000 kg"', "mass = nan", ["body.mass", "nan"]),
        ('mass = "34000 kg"', 'mass = "inf kg"', ["body.mass", "inf"]),
        ('mass = "34000 kg"', 'mass = "1e999 kg"', ["body.mass", "1e999"]),
        ('length = "24 m"', 'length = "0 m"', ["body.length"]),
        ('length = "24 m"', 'length = "-24 m"', ["body.length"]),
        ('primary_stiffness = "5000 kN/m"', 'primary_stiffness = "5000 kN s/m"',
         ["bogie.primary_stiffness", "a damping", "a stiffness"]),
        ('primary_stiffness = "5000 kN/m"', 'primary_stiffness = "0 kN/m"',
         ["bogie.primary_stiffness"]),
        ('secondary_damping = "70 kN s/m"', 'secondary_damping = "-70 kN s/m"',
         ["bogie.secondary_damping"]),
        ('[[bogies]]\nposition = "8.75 m"', '[[bogies]]\nposition = "18.75 m"',
         ["bogies[1].position", "18.75"]),
        ('wheelsets = ["1.25 m", "-1.25 m"]', "wheelsets = []", ["bogie.wheelsets"]),
        ('wheelsets = ["1.25 m", "-1.25 m"]', 'wheelsets = ["0 m"]', ["theta_b1", "two wheelsets"]),
        ('name = "cati2024"', "name = cati", ["line 4", "TOML"]),
        ('[[bogies]]\nposition = "8.75 m"', "", []),
    ],
)  # fmt: skip
def test_vehicles_that_are_none(refused, tmp_path, old, new, parts):
    assert old in COACH
    content = COACH.replace(old, new, 1)
    if not parts:  # no bogies at all
        content = COACH[: COACH.index("[[bogies]]")]
        parts = ["bogies"]
    (tmp_path / "coach.toml").write_text(content, encoding="utf-8")
    helps(
        refused("ride", "--vehicle", "coach.toml", "--output", "out.txt", "--plots", "plots"),
        *parts,
    )


def test_all_faults_of_a_vehicle_are_said_at_once(refused, tmp_path):
    bad = COACH.replace('mass = "34000 kg"', 'mass = "-1 kg"').replace('"24 m"', '"24 s"')
    (tmp_path / "coach.toml").write_text(bad.replace("position", "positoin", 1), encoding="utf-8")
    message = refused("modes", "--vehicle", "coach.toml")
    helps(message, "body.mass", "body.length", "positoin")
    assert all("coach.toml" in line for line in message.strip().splitlines())


def test_vehicle_files_that_cannot_be_read(refused, tmp_path):
    (tmp_path / "empty.toml").write_text("")
    (tmp_path / "latin.toml").write_bytes(COACH.encode("latin-1"))
    (tmp_path / "folder.toml").mkdir()
    for name, found in (
        ("empty.toml", "empty"),
        ("latin.toml", "encoding"),
        ("folder.toml", "folder"),
        ("none.toml", "neither"),
        ("a\0b", "neither"),
        ("", "neither"),
    ):
        helps(refused("modes", "--vehicle", name), name.replace("\0", "\\x00"), found)


# tracks


def rows(*changed: tuple[int, str]) -> str:
    """The line with some of its rows, counted as an editor does, put otherwise."""
    lines = LINE.splitlines()
    for row, text in changed:
        lines[row - 1] = text
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    ("content", "parts"),
    [
        (rows((12, "2.5,high")), ["row 12", "level_m", "'high'"]),
        (rows((12, "2.5,")), ["row 12", "level_m", "blank"]),
        (rows((12, "2.5,nan")), ["row 12", "'nan'"]),
        (rows((12, "2.5,-inf")), ["row 12", "'-inf'"]),
        (rows((12, "9.5,0.001")), ["row 1"]),  # unsorted
        (rows((12, "2.25,0.001")), ["row 12"]),  # doubled
        ("\n".join(rows().splitlines()[:20] + rows().splitlines()[40:]), ["row 21"]),  # a gap
        ("\n".join(rows().splitlines()[:5]), ["4 rows", "at least 8"]),
        ("distance_m,level_m\n", ["no row of numbers"]),
        ("", ["empty"]),
        ("\n\n", ["empty"]),
        (rows((1, "distance,level")), ["row 1", "unit"]),
        (rows((1, "distance_m,hight_m")), ["row 1", "level"]),
        ("\n".join(rows().splitlines()[1:]), ["row 1", "no header"]),
        (rows((1, "distance_m,level_kg")), ["row 1"]),
    ],
)
def test_tracks_that_are_none(refused, tmp_path, content, parts):
    (tmp_path / "line.csv").write_text(content)
    for command in (["track", "line.csv"], ["ride", "--track", "line.csv", "--length", "50"]):
        helps(refused(*command, "--output", "out.json"), "line.csv", *parts)


def test_track_files_that_cannot_be_read(refused, tmp_path):
    (tmp_path / "damaged.csv").write_bytes(("# Gleishöhe\n" + LINE).encode() + b"\xff")
    (tmp_path / "zeros.csv").write_text(LINE.replace("0.5,", "0.5\0,"))
    (tmp_path / "folder.csv").mkdir()
    for name, found in (("damaged.csv", "UTF-8"), ("zeros.csv", "a zero byte"),
                        ("folder.csv", "folder"), ("none.csv", "no such file")):  # fmt: skip
        for command in (["track", name], ["ride", "--track", name]):
            helps(refused(*command), name, found)


def test_a_spectrum_where_a_file_was_asked_for(refused):
    helps(refused("track", "erri_low"), "--spectrum erri_low")


def test_a_track_that_is_shorter_than_the_rated_length(refused, tmp_path):
    (tmp_path / "line.csv").write_text(LINE)
    message = refused("ride", "--track", "line.csv", "--length", "201", "--plots", "plots")
    helps(message, "line.csv", "200 m", "201 m", "--length")


def test_a_measured_track_too_short_for_a_spectrum(refused, tmp_path):
    rows = [f"{x},{0.001 * (x % 3)}" for x in range(10)]
    (tmp_path / "line.csv").write_text("distance_m,level_m\n" + "\n".join(rows) + "\n")
    helps(
        refused("ride", "--track", "line.csv", "--length", "5", "--spectral"),
        "line.csv",
        "spectrum",
        "samples",
    )


# outputs


@pytest.mark.parametrize("option", ["--output", "--write", "--plot"])
def test_outputs_that_cannot_be_written(refused, tmp_path, option):
    (tmp_path / "file").write_text("kept")
    (tmp_path / "folder.png").mkdir()
    for name, found in (("", "no name"), ("folder.png", "a folder"), ("none/a.png", "no folder"),
                        ("file/a.png", "no folder"), ("a\0b.png", "null"),
                        ("x" * 300 + "/a.png", "too long")):  # fmt: skip
        helps(refused("track", option, name), option, found)


def test_folders_that_cannot_be_made(refused, tmp_path):
    (tmp_path / "file").write_text("kept")
    for name in ("file", "file/plots", "", "a\0b"):
        helps(refused("ride", "--plots", name), "--plots")


def test_folders_without_permission(refused, monkeypatch):
    monkeypatch.setattr(os, "access", lambda *_, **__: False)
    helps(refused("modes", "--output", "out.txt"), "--output", "cannot be written")
    helps(refused("ride", "--plots", "plots"), "--plots", "nothing can be written")


def test_a_file_that_fails_at_the_last_moment(refused, monkeypatch):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    helps(refused("modes", "--output", "out.txt"), "out.txt", "No space left")


# as processes


@pytest.mark.parametrize(
    "arguments",
    [
        ["derive", "--segments", "0"],
        ["ride", "--speed", "0"],
        ["ride", "--track", "none.csv"],
        ["ride", "--plots", "/proc/none/plots"],
        ["modes", "--output", "/proc/none"],
    ],
    ids=" ".join,
)
def test_processes_end_with_2_and_one_message(tmp_path, arguments):
    done = subprocess.run(  # noqa: S603
        [sys.executable, "-W", "error", "-m", "railride", *arguments],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 2, done.stderr
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert done.stderr.count("railride: ") + done.stderr.count("Error") == 1
    assert not list(tmp_path.iterdir())
