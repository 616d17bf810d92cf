"""``railride optimise``: studies in files, the changed vehicle's file, what is refused."""

import csv
import io
import json
from pathlib import Path

import pytest

from railride import load_vehicle
from railride.files import data_path
from railride.optimisation import KINDS

STUDY = """
vehicle = "cati2024"
[body]
segments = 2
[ride]
speeds = ["200 km/h"]
positions = ["0 m", "3 m"]
floor = "polygon"
[optimise]
{optimise}
[limits]
{limits}
[parameters.secondary_damping]
from = "20 kN s/m"
to = "150 kN s/m"
{parameters}
"""
HEAVE = 'damping_ratio = { heave = "15 %" }'


@pytest.fixture
def study(tmp_path):
    """Writes a study file."""

    def write(optimise="", limits=HEAVE, parameters=""):
        path = tmp_path / "study.toml"
        path.write_text(STUDY.format(optimise=optimise, limits=limits, parameters=parameters))
        return path

    return write


def document(run, *arguments):
    code, out, err = run("optimise", *arguments, "--format", "json")
    assert code == 0, err
    return json.loads(out, parse_constant=pytest.fail)


def test_the_changed_vehicle_rides_as_the_optimum_says(run, study, tmp_path):
    best = tmp_path / "best.toml"
    found = document(run, study(), "--vehicle-file", best)
    assert list(found)[:3] == ["parameters", "a_wrms", "limits"]
    value = found["parameters"]["secondary_damping"]
    assert load_vehicle(best).bogies[1].secondary_damping == value
    code, out, _ = run("ride", "--vehicle", best, "--segments", "2", "--floor", "polygon",
                       "--speed", "200", "--at", "0", "--at", "3", "--spectral",
                       "--format", "json")  # fmt: skip
    assert code == 0
    ridden = [case["a_wrms_exact"] for case in json.loads(out)["cases"]]
    assert [case["a_wrms"] for case in found["cases"]] == pytest.approx(ridden, rel=1e-9)
    assert found["a_wrms"] == pytest.approx((sum(a**2 for a in ridden) / 2) ** 0.5, rel=1e-9)
    (limit,) = found["limits"]
    assert (limit["name"], limit["mode"], limit["binds"]) == ("damping_ratio", "heave", True)
    assert limit["value"] == pytest.approx(0.15, rel=1e-6)
    assert found["converged"]
    assert found["front"] is None


def test_the_command_that_rides_it_is_told(run, study, tmp_path):
    best = tmp_path / "best.toml"
    code, out, err = run("optimise", study(), "--vehicle-file", best)
    assert code == 0
    for word in ("secondary_damping", "what changed", "heave", "yes", "An optimum", "residual"):
        assert word in out
    told = err.split("ride it: railride ")[1].split("\n")[0]
    code, out, _ = run(*told.split())
    assert code == 0
    assert "polygon floor" in out


def test_csv_has_a_row_for_each_parameter(run, study):
    code, out, _ = run("optimise", study(), "--format", "csv")
    (row,) = csv.DictReader(io.StringIO(out))
    assert code == 0
    assert (row["parameter"], row["unit"], float(row["from"])) == (
        "secondary_damping", "N s/m", 70e3,
    )  # fmt: skip


def test_the_shipped_front_is_drawn_and_printed(run, tmp_path):
    drawn = tmp_path / "front.png"
    found = document(run, "pareto", "--plot", drawn)
    assert drawn.read_bytes().startswith(b"\x89PNG")
    designs = found["front"]["designs"]
    assert found["front"]["unit"] == "m"
    assert [d["travel"] for d in designs] == sorted(d["travel"] for d in designs)
    assert designs[-1]["a_wrms"] == pytest.approx(found["a_wrms"], rel=1e-9)


def test_the_shipped_study_keeps_its_limits(run):
    found = document(run, "optimise")
    assert found["converged"]
    assert {"secondary_stiffness", "secondary_damping", "primary_damping"} == set(
        found["parameters"]
    )
    for limit in found["limits"]:
        sign = 1 if limit["at_least"] else -1
        assert sign * (limit["value"] / limit["bound"] - 1) > -1e-6
    assert found["a_wrms"] < found["a_wrms_before"]


def test_infeasible_limits_end_with_2_and_write_nothing(run, study, tmp_path):
    files = [tmp_path / name for name in ("best.toml", "best.png", "best.json")]
    code, out, err = run("optimise", study(limits='secondary_travel = "2 mm"'), "--vehicle-file",
                         files[0], "--plot", files[1], "--output", files[2])  # fmt: skip
    assert code == 2
    assert out == ""
    for word in ("secondary_travel", "at the best compromise", "at most 2 mm", "widen"):
        assert word in err
    assert not any(path.exists() for path in files)


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"optimise": 'objectiv = "mean"\nstarts = "two"'},
         ["optimise.objectiv", "did you mean objective", "optimise.starts", "a whole number"]),
        ({"optimise": 'objective = "least"'}, ["one of mean, worst"]),
        ({"optimise": "starts = 0"}, ["starts", "from 1"]),
        ({"optimise": "weights = [1, 2, 3]"}, ["weights", "2 numbers"]),
        ({"optimise": 'pareto = { against = "comfort", points = 1 }'},
         ["optimise.pareto.against", "optimise.pareto.points"]),
        ({"limits": 'secondary_travel = "12"\nprimary_travl = "3 mm"'},
         ["limits.secondary_travel", "limits.primary_travl", "did you mean primary_travel"]),
        ({"limits": 'damping_ratio = { hev = "10 %" }'}, ["no such mode", "did you mean heave"]),
        ({"limits": 'secondary_static = "100 mm"'}, ["limits.secondary_static", "table"]),
        ({"limits": 'secondary_static = { from = "3 m", to = "1 m" }'}, ["nor reversed"]),
        ({"limits": "secondary_static = {}"}, ["neither from nor to"]),
        ({"limits": 'secondary_travel = { from = "3 mm" }'}, ["limits.secondary_travel"]),
        ({"limits": 'wheel_load_variation = "10 %"'}, ["bogie.wheelset_mass"]),
        ({"parameters": "[parameters.secondary_stifness]"}, ["did you mean secondary_stiffness"]),
        ({"parameters": '[parameters.k_1]\nvalues = ["5 MN/m"]'}, ["parameters.k_1", "a range"]),
    ],
)  # fmt: skip
def test_faults_of_a_study_are_told(run, study, parts, words):
    code, out, err = run("optimise", study(**parts))
    assert code == 2
    assert out == ""
    assert "study.toml" in err
    for word in words:
        assert word in err


def test_a_vehicle_that_no_file_holds_is_refused_before_any_work(run, tmp_path):
    path = tmp_path / "study.toml"
    text = STUDY.format(optimise="", limits="", parameters="").replace(
        "segments = 2", 'kind = "fe"\nmodes = 2'
    )
    text = text.replace("secondary_damping", "f_c1").replace("20 kN s/m", "8 Hz").replace(
        "150 kN s/m", "12 Hz").replace('floor = "polygon"', "")  # fmt: skip
    path.write_text(text)
    code, _, err = run("optimise", path, "--vehicle-file", tmp_path / "best.toml")
    assert code == 2
    assert "f_c1" in err
    assert "finite elements" in err


def test_files_of_its_own_are_not_written_over(run, study):
    path = study()
    code, _, err = run("optimise", path, "--vehicle-file", path)
    assert code == 2
    assert "another file" in err
    code, _, err = run("optimise", path, "--plot", "best.doc")
    assert code == 2
    assert "PNG" in err.upper()


def test_shipped_studies_are_there():
    for name in ("optimise", "pareto"):
        assert f"railride optimise {name}" in data_path("studies", f"{name}.toml").read_text()


def test_every_key_is_documented(run, study):
    text = (Path(__file__).parents[1] / "docs" / "study-files.md").read_text(encoding="utf-8")
    own = text.partition("## `[optimise]`")[2]
    for key in (*KINDS, "distance", "weights", "starts", "seed", "against", "points",
                *document(run, study())):  # fmt: skip
        assert f"`{key}`" in own, key
