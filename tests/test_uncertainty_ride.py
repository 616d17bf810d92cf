"""Scatter of rides: percentiles against the exact transform, studies, the command."""

from __future__ import annotations

import json
import re

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from railride import InputError, derive_vehicle, read_study, stochastic_ride
from railride.cli import main
from railride.distributions import METHODS, Distribution
from railride.files import data_path
from railride.uncertainties import read_uncertainty, study_uncertainty, uncertainty

COACH = derive_vehicle("cati2024", segments=2)
SPEED = 200 / 3.6


def test_percentiles_of_a_monotone_ride_are_the_transformed_quantiles():
    """More structural damping, less vibration: P(a < a(ζ)) = 1 - F(ζ)."""
    damping = Distribution("triangular", low=0.002, mode=0.01, high=0.02)
    N = 512
    found = uncertainty(COACH, {"bending_damping": damping}, "erri_low", SPEED, samples=N,
                        percentiles=(5, 50, 95), indices=False)  # fmt: skip

    def exact(p):
        zeta = float(damping.ppf(1 - p))
        return stochastic_ride(COACH, SPEED, "erri_low", zeta_bending=zeta).a_wrms[0]

    for p, at in found.summaries[0].percentiles.items():
        # One design in each of N slices of the probability: no order statistic is further off.
        assert exact(p / 100 - 1.5 / N) <= at.value <= exact(p / 100 + 1.5 / N)
        assert at.low <= exact(p / 100) <= at.high
    assert found.summaries[0].unit == "m/s^2"
    assert found.indices == (None,)


def test_ways_of_sampling_agree_within_their_intervals():
    scatter = {"secondary_damping": Distribution("lognormal", mean=60e3, deviation=6e3, high=70e3),
               "bending_damping": Distribution("uniform", low=0.0, high=0.02)}  # fmt: skip
    found = [uncertainty(COACH, scatter, "erri_low", SPEED, samples=512, method=method, seed=3)
             for method in METHODS]  # fmt: skip
    for one in found[1:]:
        for p, at in one.summaries[0].percentiles.items():
            other = found[0].summaries[0].percentiles[p]
            assert max(at.low, other.low) <= min(at.high, other.high)
        for a, b in zip(one.indices[0].total, found[0].indices[0].total, strict=True):
            assert max(a.low, b.low) <= min(a.high, b.high)
    again = uncertainty(COACH, scatter, "erri_low", SPEED, samples=512, seed=3)
    assert again.summaries == found[0].summaries
    assert again.indices == found[0].indices


def test_values_are_those_of_the_designs():
    scatter = {
        "k_2": stats.norm(750e3, 37.5e3),
        "m_c": Distribution("uniform", low=34e3, high=42e3),
    }
    found = uncertainty(COACH, scatter, ["erri_low", "sncf_good"], [40.0, SPEED], (0.0, -8.75),
                        samples=16, indices=False, floor="polygon")  # fmt: skip
    assert found.values.shape == (16, 8)
    table = found.samples()
    ride = stochastic_ride(COACH, SPEED, "sncf_good", (0.0, -8.75), floor="polygon",
                           k_2=table["k_2 [N/m]"][7], m_c=table["m_c [kg]"][7])  # fmt: skip
    at = [k for k, one in enumerate(found.summaries) if "sncf_good" in one.name][-2:]
    np.testing.assert_allclose(found.values[7, at], ride.a_wrms, rtol=1e-9)
    assert found.parameters[0].distribution == "norm 750000, 37500"
    nominal = stochastic_ride(COACH, SPEED, "sncf_good", (0.0, -8.75), floor="polygon").a_wrms
    np.testing.assert_allclose([found.summaries[k].nominal for k in at], nominal, rtol=1e-9)
    assert (
        found.table().loc[found.summaries[0].name, "p50_low"]
        <= found.summaries[0].percentiles[50.0].value
    )


def test_what_a_vehicle_cannot_have_is_refused_beforehand():
    with pytest.raises(InputError, match=r"reaches.*finite numbers above 0") as error:
        uncertainty(
            COACH, {"k_2": stats.norm(750e3, 200e3), "c_3": stats.norm()}, "erri_low", SPEED
        )
    assert "c_3: found a name that is not known" in str(error.value)


def test_designs_that_only_several_parameters_make_impossible_are_counted():
    """Mass and pitch inertia that no graded body has: each value alone is one that it can have."""
    coach = derive_vehicle("manchester", 4, bending_frequency=8.0)
    scatter = {"m_c": Distribution("uniform", low=24e3, high=32e3),
               "I_c": Distribution("uniform", low=1.97e6, high=2.75e6)}  # fmt: skip
    found = uncertainty(coach, scatter, "erri_low", SPEED, samples=256)
    lost = np.isnan(found.values[:, 0])
    ratio = found.designs[:, 1] / found.designs[:, 0]
    assert ratio[lost].min() > ratio[~lost].max()
    assert found.summaries[0].count == 256 - lost.sum() < 256
    (reason,) = found.failed
    assert "a graded mass per length falls to" in reason
    assert found.failed[reason] > lost.sum()
    assert any(f"{lost.sum()} of 256 designs" in said and reason[:40] in said
               for said in found.remarks)  # fmt: skip


STUDY = """
vehicle = "cati2024"
[body]
segments = 1
[ride]
speeds = ["145 km/h"]
[parameters.secondary_stiffness]
distribution = "normal"
deviation = "5 %"
[parameters.secondary_damping]
distribution = "uniform"
from = "80 %"
to = "100 %"
[uncertainty]
number = 64
seed = 4
percentiles = [10, 90]
"""


@pytest.fixture
def file(tmp_path):
    def write(text=STUDY):
        path = tmp_path / "study.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_a_study_file_says_it_all(file):
    study = read_study(file(), {"uncertainty": read_uncertainty})
    found = study_uncertainty(study)
    scatter = {"k_2": Distribution("normal", mean=750e3, deviation=37.5e3),
               "c_2": Distribution("uniform", low=56e3, high=70e3)}  # fmt: skip
    same = uncertainty(derive_vehicle("cati2024", 1), scatter, "erri_low", 145 / 3.6, samples=64,
                       seed=4, percentiles=(10, 90))  # fmt: skip
    assert found.summaries == same.summaries
    assert found.indices == same.indices
    assert found.title == "study"


def test_the_shipped_study_is_read():
    study = read_study("uncertainty", {"uncertainty": read_uncertainty})
    assert len(study.parameters) == 6
    frequency = study.model().bending_frequencies()[0]
    assert frequency == pytest.approx(9.6, abs=1e-3)


def test_faults_of_a_study_come_together(file):
    text = STUDY.replace("number = 64", 'number = 2\nmethod = "halton"\nsamples = 3')
    text = text.replace("[10, 90]", '[10, 100, "5 %"]').replace('"80 %"', '"180 %"')
    text += "[parameters.m_c]\nfrom = '34 t'\nto = '40 t'\n"
    with pytest.raises(InputError) as error:
        read_study(file(text), {"uncertainty": read_uncertainty})
    said = str(error.value)
    for part in ("uncertainty.number: found 2", "uncertainty.method: found 'halton'",
                 "uncertainty.samples: found a key that is not known",
                 "uncertainty.percentiles: found 100", "plain numbers, percentiles = [5, 50, 95]",
                 "parameters.m_c: found no distribution",
                 "secondary_damping.to: found"):  # fmt: skip
        assert part in said, part
    with pytest.raises(InputError, match="parameters: found none"):
        read_study(file(STUDY.partition("[parameters")[0]), {"uncertainty": read_uncertainty})
    with pytest.raises(InputError, match="read with read_uncertainty"):
        study_uncertainty(read_study(file()))


def run(capsys, *arguments):
    with pytest.raises(SystemExit) as stop:
        main(["uncertainty", *map(str, arguments)])
    out = capsys.readouterr()
    return stop.value.code, out.out, out.err


def test_the_command_prints_table_json_and_csv(file, capsys, tmp_path):
    path, designs, picture = file(), tmp_path / "designs.csv", tmp_path / "scatter.svg"
    code, out, err = run(capsys, path, "--format", "json", "--designs", designs, "--plot", picture)
    assert code == 0
    document = json.loads(out)
    (one,) = document["quantities"]
    study = study_uncertainty(read_study(path, {"uncertainty": read_uncertainty}))
    assert one["percentiles"][1]["percent"] == 90
    assert one["percentiles"][1]["value"] == study.summaries[0].percentiles[90.0].value
    assert one["indices"][0]["total"]["low"] == study.indices[0].total[0].low
    assert {entry["scale"] for entry in one["classes"]} == {
        "Cati 2024 Table 3",
        "ISO 2631-1 Annex C",
    }
    assert document["parameters"][0]["symbol"] == "k_2"
    assert document["remarks"]
    assert (document["evaluated"], document["failed"]) == (64 * 4 + 1, [])
    pd.testing.assert_frame_equal(pd.read_csv(designs), study.samples())
    assert picture.read_bytes().startswith(b"<?xml")
    assert "drawn: " in err
    code, out, _ = run(capsys, path, "--format", "csv")
    assert code == 0
    assert "total_order secondary_damping_high" in out.splitlines()[0]
    assert len(out.splitlines()) == 2
    code, out, _ = run(capsys, path)
    assert code == 0
    assert "10 % of designs are below" in out
    assert "Share of the variance" in out


def test_a_nominal_design_that_cannot_be_has_a_dash(file, capsys, tmp_path):
    coach = data_path("vehicles", "cati2024.toml").read_text(encoding="utf-8")
    heavy = coach.replace("34000 kg", "6.8e34 kg")
    (tmp_path / "heavy.toml").write_text(heavy, encoding="utf-8")
    text = STUDY.replace("cati2024", "heavy.toml") + "indices = false\n"
    text += "[parameters.m_c]\ndistribution = 'uniform'\nfrom = '34 t'\nto = '42 t'\n"
    code, out, err = run(capsys, file(text))
    assert code == 0, err
    assert re.search(r"nominal design +-\n", out)
    assert "nan" not in out


def test_what_the_command_cannot_use_ends_with_2(file, capsys):
    for arguments, part in (
        (("nowhere.toml",), "nowhere.toml"),
        ((file(), "--plot", "x.bmp"), "--plot 'x.bmp': found the suffix '.bmp'"),
        ((file(), "--format", "xml"), "--format"),
        (
            (file(STUDY.replace('deviation = "5 %"', 'deviation = "5 kg"')),),
            "deviation: found '5 kg'",
        ),
    ):
        code, out, err = run(capsys, *arguments)
        assert (code, out) == (2, "")
        assert part in err
        assert "Traceback" not in err
