"""``railride sensitivity``: its keys, its tables and what it refuses."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

from railride.parameters import load_vehicle
from railride.sensitivities import Derivatives, sensitivity
from railride.vehicle import derive_vehicle

ASKED = ("--segments", "2", "--bending-damping", "0.01", "--parameter", "secondary_stiffness",
         "--parameter", "m_c", "--change", "5 %")  # fmt: skip


def here():
    model = derive_vehicle(load_vehicle("cati2024"), 2, bending_damping=0.01)
    return sensitivity(model, [145 / 3.6, 200 / 3.6], "erri_low", [0.0, 4.0],
                       parameters=["k_2", "m_c"], change=0.05)  # fmt: skip


def test_json_holds_what_the_call_returns(run):
    code, out, err = run("sensitivity", *ASKED, "--at", "0", "--at", "4", "--format", "json")
    assert code == 0
    found, expected = json.loads(out), here()
    assert (found["track"], found["held"], found["change"]) == ("erri_low", "bending frequency",
                                                                0.05)  # fmt: skip
    assert [(p["symbol"], p["value"], p["unit"]) for p in found["parameters"]] == [
        ("k_2", 750e3, "N/m"), ("m_c", 34e3, "kg")]  # fmt: skip
    places = [(case["speed_kmh"], case["position_m"]) for case in found["cases"]]
    assert places == [(145.0, 0.0), (145.0, 4.0), (200.0, 0.0), (200.0, 4.0)]
    for case, a, gradient, linear, effect in zip(
        found["cases"], expected.a_wrms.ravel(), expected.gradient.reshape(4, 2),
        expected.linear_effects.reshape(4, 2, 2), expected.effects.reshape(4, 2, 2), strict=True,
    ):  # fmt: skip
        assert case["a_wrms"] == pytest.approx(a, rel=1e-12)
        for k, p in enumerate(case["parameters"]):
            assert p["gradient"] == pytest.approx(gradient[k], rel=1e-9)
            assert p["linear"] == pytest.approx(linear[k].tolist(), rel=1e-9)
            assert p["effect"] == pytest.approx(effect[k].tolist(), rel=1e-9)
    labels = [mode["label"] for mode in found["modes"]]
    assert labels[0] == "heave"
    assert "bogie pitch, in phase" in labels
    deflections = {one["output"]: one for one in found["deflections"]}
    assert deflections["secondary_1_deflection"]["static"] == pytest.approx(-0.22229, abs=1e-5)
    (k_2, m_c) = deflections["secondary_1_deflection"]["parameters"]
    assert (k_2["relative"], m_c["relative"]) == pytest.approx((-1.0, 1.0), rel=1e-9)
    assert "remark: cati2024" in err


def test_csv_has_a_row_per_case_and_parameter(run):
    code, out, _ = run("sensitivity", *ASKED, "--format", "csv")
    assert code == 0
    rows = list(csv.DictReader(io.StringIO(out)))
    assert [(row["speed_kmh"], row["symbol"]) for row in rows] == [
        ("145.0", "k_2"), ("145.0", "m_c"), ("200.0", "k_2"), ("200.0", "m_c")]  # fmt: skip
    assert float(rows[0]["gradient"]) == pytest.approx(here().gradient[0, 0, 0], rel=1e-9)


def test_tables_begin_with_what_matters_most(run, tmp_path):
    picture = tmp_path / "tornado.png"
    code, out, err = run("sensitivity", "--segments", "2", "--speed", "200", "--plot", picture)
    assert code == 0
    lines = out.splitlines()
    first = next(k for k, line in enumerate(lines) if "───" in line) + 1
    assert lines[first].split("  ")[1].startswith("wheelset position, from the bogie")
    assert "Natural frequencies: d ln f/d ln p" in lines
    assert "Static deflections: d ln s/d ln p" in lines
    assert "held while others change: the bending frequency" in lines[-1]
    assert "zeta_bending is 0, and 10 % of it nothing" in err
    assert picture.stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "message"),
    [(["--change", "120 %"], "--change: found '120 %'; expected a share above 0 and below 1"),
     (["--change", "0"], "--change"),
     (["--parameter", "k_3", "--parameter", "bogey"], "found 'k_3'"),
     (["--parameter", "k_3", "--parameter", "bogey"], "found 'bogey'"),
     (["--parameter", "k_2", "--parameter", "secondary_stiffness"], "found k_2 twice"),
     (["--speed", "-3"], "--speed"), (["--at", "20"], "position 20 m"),
     (["--plot", "tornado.txt"], "'.txt'"), (["--floor", "wavy"], "--floor")],
)  # fmt: skip
def test_bad_input(run, arguments, message):
    code, out, err = run("sensitivity", *arguments)
    assert (code, out) == (2, "")
    assert message in err
    assert "Traceback" not in err


def test_undefined_values_are_null_or_dashes(run):
    """At critical damping a mode has no derivative; a changed vehicle that cannot be, no value."""
    model = derive_vehicle(load_vehicle("cati2024"), 1)
    c_1 = float(np.sqrt(2 * 1.25**2 * 5e6 * 2e3) / 1.25**2)
    assert np.isnan(sensitivity(model.changed(c_1=c_1), 50.0, "erri_low").roots.slopes).any()
    assert "l_b" in Derivatives(model).parameters
    code, out, _ = run("sensitivity", "--segments", "1", "--change", "50 %", "--speed", "200",
                       "--format", "json")  # fmt: skip
    assert code == 0
    (case,) = json.loads(out)["cases"]
    l_b = next(p for p in case["parameters"] if p["symbol"] == "l_b")
    assert l_b["effect"][0] is not None  # 4.4 m
    assert l_b["effect"][1] is None  # 13.1 m: off the body
