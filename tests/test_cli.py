"""The command line against what is promised of it: keys, streams, exit codes, whole files."""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

import railride.cli
from railride import derive_vehicle, spectrum, stochastic_ride
from railride.cli import output, progress

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
HEAVY = ("sympy", "numpy", "scipy", "pandas", "matplotlib", "control", "pint")


@pytest.fixture
def result(run):
    """Run a command that must succeed: its JSON document."""

    def call(*arguments):
        code, out, err = run(*arguments, "--format", "json")
        assert code == 0, err
        document = json.loads(out, parse_constant=pytest.fail)
        for remark in document["remarks"]:
            assert f"remark: {remark}\n" in err
        return document

    return call


def process(*arguments, cwd, **more):
    """Run Python as a process of its own, railride at hand."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "PYTHONIOENCODING": "utf-8"}
    return subprocess.run(  # noqa: S603
        [sys.executable, *map(str, arguments)],
        cwd=cwd, env=environment, capture_output=True, encoding="utf-8", timeout=120, check=False,
        **more,
    )  # fmt: skip


def commands():
    return [command.callback for command in railride.cli.app.registered_commands]


# derive


@pytest.mark.parametrize(
    "options",
    [
        ["--segments", "1"],
        ["--segments", "3"],
        ["--vehicle", "manchester", "--segments", "2", "--bending-frequency", "8"],
    ],
    ids=" ".join,
)
def test_parameters_put_into_the_symbols_give_the_numbers(result, options):
    derived = result("derive", *options)
    values = {sp.Symbol(name): value for name, value in derived["parameters"].items()}
    names = {symbol.name: symbol for symbol in values}
    for matrix in ("M", "C", "K", "K_w", "C_w"):
        texts = derived["symbolic"][matrix]
        found = [[float(sp.sympify(e, locals=names).subs(values)) for e in row] for row in texts]
        scale = np.abs(derived[matrix]).max()
        np.testing.assert_allclose(found, derived[matrix], rtol=1e-12, atol=1e-12 * scale)


def test_derive_gives_the_keys_that_others_build_on(result):
    derived = result("derive", "--segments", "2")
    assert derived["segments"] == 2
    assert derived["coordinates"] == ["z_0", "z_1", "z_2", "z_b1", "theta_b1", "z_b2", "theta_b2"]
    assert derived["joint_stiffness"] == derived["parameters"]["k_theta"]
    # physics: k_theta of two rods at 9.6 Hz is m L² ω²/96, which is 3.711e8 N m/rad
    expected = 34000 * 24**2 * (2 * np.pi * 9.6) ** 2 / 96 / 2
    assert derived["joint_stiffness"] == pytest.approx(expected, rel=1e-9)
    assert np.shape(derived["K_w"]) == (7, 4)
    assert derived["parameters"]["k_1"] == 5e6
    # the paper's bogies bounce at sqrt((k_2 + 2 k_1)/m_b); the pitch is sqrt(2 k_1 l_w²/I_b)
    pitch = np.sqrt(2 * 5e6 * 1.25**2 / 2000) / (2 * np.pi)
    assert sum(abs(f - pitch) < 1e-9 for f in derived["undamped_hz"]) == 2
    assert "nonlinear" not in derived


def test_a_rigid_body_has_no_joint_stiffness(result):
    derived = result("derive", "--body", "rigid")
    assert derived["segments"] == 1
    assert derived["joint_stiffness"] is None
    assert "k_theta" not in derived["parameters"]


def test_derive_and_modes_say_the_same(result):
    derived, found = result("derive", "--segments", "2"), result("modes", "--segments", "2")
    assert derived["modes"] == found["modes"]
    assert derived["undamped_hz"] == found["undamped_hz"]


def test_nonlinear_equations_are_added(run, result):
    assert len(result("derive", "--segments", "2", "--nonlinear")["nonlinear"]) == 7
    assert "asin" in run("derive", "--segments", "2", "--nonlinear")[1]


def test_derive_as_csv_lists_every_entry(run):
    rows = list(csv.DictReader(io.StringIO(run("derive", "--segments", "1", "--format", "csv")[1])))
    entry = {(r["matrix"], r["row"], r["column"]): r for r in rows}
    assert float(entry["K", "z_c", "z_c"]["value"]) == 2 * 750e3
    assert entry["M", "z_c", "z_c"]["symbolic"] == "m_c"
    assert {r["matrix"] for r in rows} == {"M", "C", "K", "K_w", "C_w", "B_f"}


def test_derive_as_table_reads_on_a_page(run):
    out = run("derive", "--segments", "4")[1]
    assert max(map(len, out.splitlines())) <= 120
    for part in ("Parameters", "Energies", "Linear equations of motion", "Modes", "k_θ", "N m/rad"):
        assert part in out
    assert "\x1b" not in out


@pytest.mark.parametrize("form", ["markdown", "latex"])
@pytest.mark.parametrize("options", [["--segments", "2"], ["--system", "half-body"]])
def test_derive_writes_documents(run, form, options):
    code, out, _ = run("derive", *options, "--format", form)
    assert code == 0
    assert "theta" in out


# the body


def test_a_given_stiffness_may_have_a_unit(result):
    by_number = result("derive", "--segments", "2", "--joint-stiffness", "3.7e8")
    by_unit = result("derive", "--segments", "2", "--joint-stiffness", "3.7e5 kN*m/rad")
    assert by_number["joint_stiffness"] == 3.7e8
    assert by_unit["joint_stiffness"] == pytest.approx(3.7e8, rel=1e-15)


def test_bending_damping_in_per_cent(result):
    found = [
        result("modes", "--bending-damping", text)["modes"] for text in ("1.5 %", "0.015", "0")
    ]
    assert found[0] == found[1]
    assert found[1] != found[2]


@pytest.mark.parametrize("option", ["--bending-frequency=9", "--joint-stiffness=3e8",
                                    "--bending-damping=0.01"])  # fmt: skip
def test_what_changes_nothing_for_a_rigid_body_is_remarked(result, option):
    plain, given = result("modes", "--body", "rigid"), result("modes", "--body", "rigid", option)
    assert plain["modes"] == given["modes"]
    (more,) = [text for text in given["remarks"] if text not in plain["remarks"]]
    assert option.split("=")[0].strip("-").replace("-", " ") in more


def test_a_vehicle_of_unknown_bending_is_one_segment_unless_told(result):
    assert result("derive", "--vehicle", "manchester")["segments"] == 1
    told = result(
        "derive", "--vehicle", "manchester", "--segments", "3", "--bending-frequency", "8"
    )
    assert told["segments"] == 3
    default = result("derive", "--vehicle", "manchester", "--bending-frequency", "8")
    assert default["segments"] == 4


def test_modes_are_sorted_and_complete(run, result):
    found = result("modes", "--segments", "4")
    frequencies = [mode["frequency_hz"] for mode in found["modes"]]
    assert frequencies == sorted(frequencies)
    assert found["undamped_hz"] == sorted(found["undamped_hz"])
    assert len(found["undamped_hz"]) == 9
    assert {"heave", "pitch", "bending 1"} <= {mode["label"] for mode in found["modes"]}
    rows = list(csv.DictReader(io.StringIO(run("modes", "--format", "csv")[1])))
    assert [float(row["frequency_hz"]) for row in rows] == frequencies
    assert max(map(len, run("modes")[1].splitlines())) <= 120


# ride


def test_cases_keep_the_order_given(result):
    document = result("ride", "--spectral", "--speed", "200", "--speed", "145", "--speed", "40 m/s",
                      "--at", "-4", "--at", "0", "--segments", "1")  # fmt: skip
    cases = [(case["speed_kmh"], case["position_m"]) for case in document["cases"]]
    assert cases == [(200, -4), (200, 0), (145, -4), (145, 0), (144, -4), (144, 0)]
    assert document["track"] == "erri_low"


@pytest.mark.parametrize("typed", ["145", "0.1", "123.456", "99.9", "350", "81.7"])
def test_a_speed_comes_back_as_it_was_typed(result, typed):
    (case,) = result("ride", "--spectral", "--speed", typed, "--segments", "1")["cases"]
    assert case["speed_kmh"] == float(typed)


def test_a_ride_has_every_key(result):
    (case,) = result("ride", "--speed", "200", "--segments", "2")["cases"]
    keys = "speed_kmh position_m body segments a_rms a_wrms a_wrms_exact mtvv vdv crest_factor wz"
    assert {*keys.split(), "level", "levels"} <= set(case)
    assert case["body"] == "segments"
    assert case["mtvv"] >= case["a_wrms"] > 0
    assert case["mtvv"] > case["mtvv_exp"] > 0
    assert case["en12299_blocks"] == 3  # 18 s
    assert sum(case["en12299_continuous"].values()) == pytest.approx(1)
    assert case["en12299_vertical_part"] > 0
    assert abs(case["a_wrms"] - case["a_wrms_exact"]) < 4 * case["standard_error"]
    assert all(isinstance(classes, list) for classes in case["levels"].values())
    (exact,) = result("ride", "--speed", "200", "--segments", "2", "--spectral")["cases"]
    assert exact["a_wrms"] == exact["a_wrms_exact"] == case["a_wrms_exact"]
    keys = "mtvv mtvv_exp vdv crest_factor en12299_vertical_part"
    assert [exact[key] for key in keys.split()] == [None] * 5


def test_the_default_ride_is_the_papers(result):
    cases = result("ride", "--segments", "1", "--spectral")["cases"]
    assert [case["speed_kmh"] for case in cases] == [145, 200]
    assert [case["position_m"] for case in cases] == [0, 0]
    assert cases[0]["body"] == "rigid"


def test_a_ride_as_csv_leaves_cells_empty(run):
    out = run("ride", "--spectral", "--segments", "1", "--format", "csv")[1]
    row = next(csv.DictReader(io.StringIO(out)))
    assert row["vdv"] == ""
    assert float(row["a_wrms"]) > 0


def test_a_ride_as_table_has_units(run):
    out = run("ride", "--spectral", "--segments", "1")[1]
    assert "[km/h]" in out  # markup would swallow it
    assert "[m/s²]" in out
    assert max(map(len, out.splitlines())) <= 120
    assert "Sperling" in out


def test_options_without_effect_are_remarked(result):
    remarks = result("ride", "--spectral", "--segments", "1", "--seed", "3", "--extrapolate")[
        "remarks"
    ]
    assert any(text.startswith("--seed changes nothing") for text in remarks)
    assert any(text.startswith("--extrapolate changes nothing") for text in remarks)


def test_a_measured_track_has_the_exact_value_of_its_own_spectrum(result, tmp_path):
    file = tmp_path / "line.csv"
    result("track", "--length", "1000", "--step", "0.25", "--write", file)
    given = ("ride", "--track", file, "--length", "300", "--speed", "145", "--segments", "1")
    ridden, exact = result(*given), result(*given, "--spectral")
    (case,) = exact["cases"]
    assert case["a_wrms"] == case["a_wrms_exact"] == ridden["cases"][0]["a_wrms_exact"]
    assert 0 < case["standard_error"] < case["a_wrms"]
    assert case["vdv"] is None
    for document in (ridden, exact):
        assert any("Welch" in text for text in document["remarks"])


def test_travel_adds_suspension_travel_and_wheel_loads(result, run):
    given = ("ride", "--spectral", "--vehicle", "ice3", "--speed", "200", "--travel")
    outputs = result(*given, "--length", "500")["outputs"]
    loads = [one for one in outputs if one["unit"] == "N"]
    assert len(loads) == 4
    assert all(one["low_pass_hz"] == 20 for one in loads)
    travel = [one for one in outputs if one["output"] == "secondary_1_deflection"]
    assert [one["distance_m"] for one in travel] == [500]
    assert travel[0]["low_pass_hz"] is None
    assert 2.5 < travel[0]["expected_peak"] / travel[0]["rms"] < 4
    assert all(0 < one["error"] < 1e-6 for one in outputs)
    assert "outputs" not in result(*given[:-1])
    table = run(*given)[1]
    assert "\nSuspension travel and wheel load over 1000 m, exact\n" in table
    assert "wheel_load_1" in table
    assert "kN" in table
    assert max(map(len, table.splitlines())) <= 120


def test_missing_wheel_loads_are_remarked_on(result, run):
    given = ("ride", "--spectral", "--speed", "200", "--travel", "--segments", "1")
    (remark,) = (said for said in result(*given)["remarks"] if "wheel loads" in said)
    assert "bogie.wheelset_mass" in remark
    assert "\nSuspension travel over 1000 m, exact\n" in run(*given)[1]
    there = result("ride", "--spectral", "--speed", "200", "--travel", "--vehicle", "ice3")
    assert not any("wheel loads" in said for said in there["remarks"])


@pytest.mark.parametrize("spectral", [True, False])
def test_the_error_of_the_exact_value_is_stated(result, run, spectral):
    given = [
        "ride",
        "--speed",
        "200",
        "--segments",
        "4",
        "--length",
        "200",
        "--at",
        "0",
        "--at",
        "9",
    ]
    given += ["--spectral"] if spectral else []
    coach = derive_vehicle("cati2024", 4)
    exact = stochastic_ride(coach, 200 / 3.6, spectrum("erri_low"), [0.0, 9.0])
    stated = [case["a_wrms_error"] for case in result(*given)["cases"]]
    assert stated == pytest.approx(exact.a_wrms_error.tolist(), rel=1e-9)
    assert max(stated) < 1e-6
    assert f"relative error at most {max(stated):.0e}\n" in run(*given)[1]
    header, *rows = run(*given, "--format", "csv")[1].splitlines()
    assert float(rows[1].split(",")[header.split(",").index("a_wrms_error")]) == stated[1]


def test_rides_are_drawn_into_a_new_folder(result, tmp_path):
    result(
        "ride", "--segments", "1", "--speed", "200", "--length", "200", "--plots", tmp_path / "a/b"
    )
    drawn = list((tmp_path / "a" / "b").iterdir())
    assert drawn
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in drawn)


# track


def test_a_track_is_described(result):
    made = result("track", "--spectrum", "erri_high", "--length", "2000", "--seed", "7")
    assert (made["length_m"], made["step_m"]) == (2000, 0.25)
    keys = {"length_m", "step_m", "rms_mm", "d1_rms_mm", "d2_rms_mm", "remarks"}
    assert set(made) == keys | {"best_spectrum", "spectra"}
    assert made["d1_rms_mm"] < made["d2_rms_mm"] < made["rms_mm"]
    again = result("track", "--spectrum", "erri_high", "--length", "2000", "--seed", "7")
    assert again == made


def test_a_written_track_reads_back(run, result, tmp_path):
    file = tmp_path / "made.csv"
    made = result("track", "--length", "500", "--write", file)
    assert file.read_text().splitlines()[0] == "distance_m,level_m"
    read = result("track", file)
    for key in ("length_m", "step_m", "rms_mm", "d1_rms_mm", "d2_rms_mm"):
        assert read[key] == pytest.approx(made[key], rel=1e-9)
    assert run("track", "--length", "500", "--format", "csv")[1] == file.read_text()


def test_what_a_short_track_cannot_tell_is_null(result):
    short = result("track", "--length", "60")
    assert short["d2_rms_mm"] is None
    assert short["d1_rms_mm"] > 0
    assert any("25 to 70 m" in remark for remark in short["remarks"])


def test_a_track_is_drawn(result, tmp_path):
    result("track", "--length", "300", "--plot", tmp_path / "track.svg")
    assert "<svg" in (tmp_path / "track.svg").read_text()


# streams, files, ends


def test_output_is_written_whole_and_nothing_to_standard_output(run, tmp_path):
    file = tmp_path / "modes.json"
    file.write_text("old")
    code, out, err = run("modes", "--segments", "2", "--format", "json", "--output", file)
    assert (code, out) == (0, "")
    assert "remark: cati2024" in err
    assert json.loads(file.read_text())["modes"]
    assert list(tmp_path.iterdir()) == [file]


def test_a_link_leads_to_the_file_that_is_written(run, tmp_path):
    (tmp_path / "link").symlink_to(tmp_path / "file")
    run("modes", "--segments", "1", "--output", tmp_path / "link")
    assert (tmp_path / "link").is_symlink()
    assert "Modes" in (tmp_path / "file").read_text()


def test_a_fault_of_ours_ends_with_1_and_says_where(run, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("of ours")

    monkeypatch.setattr("railride.modal.modes", broken)
    code, out, err = run("modes", "--segments", "1")
    assert (code, out) == (1, "")
    assert "Traceback" in err
    assert "ZeroDivisionError: of ours" in err
    assert "fault of the program" in err


@pytest.mark.parametrize(("raised", "code"), [(KeyboardInterrupt, 130), (MemoryError, 2)])
def test_ends_without_a_traceback(run, monkeypatch, raised, code):
    def stopped(*_):
        raise raised

    monkeypatch.setattr("railride.modal.modes", stopped)
    found, out, err = run("modes", "--segments", "1")
    assert (found, out) == (code, "")
    assert err.startswith("railride: ")
    assert err.count("\n") == 1


def test_a_key_stops_a_process_cleanly(tmp_path):
    code = (
        "import os, signal, threading\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in the background
        "from railride.cli import main\n"
        "import railride.vehicle, railride.modal\n"
        "threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()\n"
        "main(['derive', '--segments', '1000'])\n"
    )
    done = process("-c", code, cwd=tmp_path)
    assert done.returncode == 128 + signal.SIGINT
    assert done.stderr == "railride: interrupted\n"


def test_a_reader_that_has_gone_is_no_fault(tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "railride", "modes", "--segments", "1"],
        cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
        stdout=writing, stderr=subprocess.PIPE, text=True, timeout=120, check=False,
    )  # fmt: skip
    os.close(writing)
    assert (done.returncode, done.stderr) == (0, "")


def test_a_stream_can_be_the_output(tmp_path):
    done = process("-m", "railride", "modes", "--output", "/dev/stdout", cwd=tmp_path)
    assert done.returncode == 0
    assert done.stdout.startswith("Modes\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a full device")
def test_a_full_disk_is_said(tmp_path):
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "railride", "modes"],
            cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(ROOT / "src")},
            stdout=full, stderr=subprocess.PIPE, text=True, timeout=120, check=False,
        )  # fmt: skip
    assert done.returncode == 2
    assert "standard output: found No space left" in done.stderr
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr


def test_derive_as_a_module_from_anywhere(tmp_path):
    whole = process("-m", "railride", "derive", "--segments", "2", cwd=tmp_path)
    module = process("-W", "error", "-m", "railride.derive", "--segments", "2", cwd=tmp_path)
    assert module.returncode == 0
    assert module.stdout == whole.stdout
    assert module.stderr == whole.stderr
    assert "Warning" not in module.stderr
    assert all(line.startswith("remark: ") for line in module.stderr.splitlines())


def test_help_loads_nothing_heavy(tmp_path):
    code = (
        "import sys\n"
        "from railride.cli import main\n"
        "try:\n    main(sys.argv[1:])\n"
        "finally:\n    print(*[m for m in sys.modules if '.' not in m], file=sys.stderr)\n"
    )
    for arguments in (["--help"], ["ride", "--help"]):
        done = process("-c", code, *arguments, cwd=tmp_path)
        assert done.returncode == 0
        assert not set(done.stderr.split()) & set(HEAVY)


def test_deriving_loads_no_more_than_it_needs(tmp_path):
    code = (
        "import sys\n"
        "from railride.cli import main\n"
        "try:\n    main(['derive', '--segments', '2'])\n"
        "finally:\n    print(*sys.modules, file=sys.stderr)\n"
    )
    loaded = set(process("-c", code, cwd=tmp_path).stderr.split())
    assert "sympy" in loaded
    assert not loaded & {"scipy.linalg", "scipy.signal", "control", "matplotlib", "pandas",
                         "rich.table"}  # fmt: skip


def test_help_shows_an_example_that_runs(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{k / 200},{np.sin(k):.6f}\n" for k in range(4000))
    (tmp_path / "floor.csv").write_text("time_s,z\n" + rows, encoding="utf-8")
    texts = [command.__doc__ for command in commands()] + [railride.cli.app.info.help]
    assert len(texts) == 1 + len(commands())
    for text in texts:
        (example,) = re.findall(r"Example:  railride (.+)", text)
        name = example.split()[0]
        shown = run(name, "--help")[1] if text in texts[:-1] else run("--help")[1]
        assert "Example:" in shown
        assert all(word in shown for word in example.split())
        if f"railride {example}" in README:
            continue  # run there
        words = shlex.split(example)
        code, out, err = run(*words)
        assert code == 0, err
        assert out or Path(words[words.index("--output") + 1]).stat().st_size > 0


def test_the_commands_are_those_there_are(run):
    code, out, _ = run("--help")
    assert code == 0
    for name in ("bode", "comfort", "compare", "derive", "export", "map", "modes", "ride", "track"):
        assert re.search(rf"\b{name}\b", out)
    assert run("--version")[1] == f"railride {railride.__version__}\n"


def test_progress_shows_on_a_terminal_after_a_while_only(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    for patience, terminal, shown in ((0.0, Terminal(), True), (60.0, Terminal(), False),
                                      (0.0, io.StringIO(), False)):  # fmt: skip
        monkeypatch.setattr(sys, "stderr", terminal)
        monkeypatch.setattr(progress, "PATIENCE", patience)
        monkeypatch.setenv("TERM", "xterm")
        with progress.working("riding") as advance:
            for _ in range(200):
                if not shown or "riding" in terminal.getvalue():
                    break
                advance(0.5)
                time.sleep(0.02)
        assert ("riding" in terminal.getvalue()) is shown


def test_counts_show_with_their_rate_and_the_time_left(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("COLUMNS", "160")
    with progress.counting("sweeping", "designs") as advance:
        advance(1000, 100_000)  # done before: no part of the rate
        for done in range(2000, 4000, 10):
            advance(done, 100_000)
            if "designs/s" in terminal.getvalue():
                break
            time.sleep(0.02)
    shown = terminal.getvalue()
    assert re.search(r"[0-9],[0-9]{3} of 100,000 designs", shown)
    assert re.search(r"[0-9] designs/s", shown)
    assert re.search(r"0:[0-9]{2}:[0-9]{2}", shown)


def test_undefined_numbers_are_null_in_json():
    text = output.json_text({"a": np.array([1.0, np.nan]), "b": float("inf"), "c": np.int64(3)})
    assert json.loads(text) == {"a": [1.0, None], "b": None, "c": 3}


@pytest.mark.parametrize("command", ["sweep", "optimise", "uncertainty"])
def test_no_picture_is_drawn_over_the_study_that_is_read(run, tmp_path, command):
    study = tmp_path / "study.png"
    study.write_text("[sweep]\n", encoding="utf-8")
    code, out, err = run(command, str(study), "--plot", str(study))
    assert (code, out) == (2, "")
    assert "the file of STUDY" in err
    assert study.read_text(encoding="utf-8") == "[sweep]\n"
