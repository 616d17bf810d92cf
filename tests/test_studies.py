"""Study files: what they say, and that every fault in one is told at once."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from railride import InputError, derive_vehicle, read_study, spectrum, synthesise, write_track
from railride.distributions import Distribution
from railride.files import data_path
from railride.studies import Draft, Listed, Range, shipped_studies
from railride.sweeps import read_sweep_study

HEAD = """
vehicle = "cati2024"
[body]
segments = 2
[ride]
speeds = ["145 km/h"]
"""


@pytest.fixture
def study(tmp_path):
    """Read a study of this text."""

    def read(text, **readers):
        path = tmp_path / "study.toml"
        path.write_text(text, encoding="utf-8")
        return read_study(path, readers)

    return read


def faults(study, text, **readers):
    with pytest.raises(InputError) as caught:
        study(text, **readers)
    return str(caught.value).splitlines()


@pytest.mark.parametrize("name", shipped_studies())
def test_shipped_studies_are_read(name):
    found = read_study(name)
    assert found.path.stem == name
    assert found.ride.speeds


def test_what_stands_in_the_file(study):
    found = study("""
name = "two halves"
vehicle = "manchester"
schema = 1
source = "nobody"
[body]
segments = 2
bending_frequency = "8 Hz"
bending_damping = "1.5 %"
[ride]
speeds = ["36 km/h", "20 m/s"]
tracks = ["sncf_good", "erri_low"]
positions = ["0 m", "-250 cm"]
floor = "polygon"
weighting = "Wk_paper"
extrapolate = true
results = ["a_wrms", "wz"]
[parameters.k_2]
values = ["400 kN/m", "0.5 MN/m"]
[parameters.bending_damping]
from = "0.5 %"
to = 0.02
points = 4
spacing = "log"
""")
    assert (found.name, found.vehicle.name) == ("two halves", "manchester")
    ride = found.ride
    assert ride.speeds == pytest.approx((10.0, 20.0), rel=1e-15)
    assert ride.positions == pytest.approx((0.0, -2.5), rel=1e-15)
    assert (ride.floor, ride.weight, ride.results) == ("polygon", "Wk_paper", ("a_wrms", "wz"))
    assert [track.name for track in ride.tracks] == ["sncf_good", "erri_low"]
    assert ride.tracks[0].active_band is None  # continued beyond its band
    assert spectrum("sncf_good").active_band is not None
    stiffness, damping = found.parameters
    assert (stiffness.symbol, stiffness.heading) == ("k_2", "k_2 [N/m]")
    assert stiffness.spec == Listed((4e5, 5e5))
    assert (damping.symbol, damping.heading) == ("zeta_bending", "bending_damping")
    assert damping.spec.values() == pytest.approx(0.005 * 4.0 ** (np.arange(4) / 3), rel=1e-14)
    assert damping.nominal == 0.015
    own = derive_vehicle("manchester", 2, bending_frequency=8.0, bending_damping=0.015)
    np.testing.assert_array_equal(found.model().matrices().C, own.matrices().C)


def test_defaults(study):
    ride = study(HEAD).ride
    assert (ride.positions, ride.floor, ride.weight) == ((0.0,), "smooth", "Wk")
    assert (ride.results, ride.tracks[0].name) == (("a_wrms",), "erri_low")


def test_distributions_are_read(study):
    text = HEAD + '[parameters.k_2]\ndistribution = "normal"\ndeviation = "5 %"\n'
    (found,) = study(text).parameters
    assert found.spec == Distribution("normal", mean=750e3, deviation=37.5e3)


def test_a_range_has_both_ends_and_equal_steps():
    assert Range(1.0, 4.0, 4).values().tolist() == [1.0, 2.0, 3.0, 4.0]


def test_files_are_named_from_the_study(tmp_path, monkeypatch):
    folder = tmp_path / "here"
    folder.mkdir()
    from railride import load_vehicle, write_vehicle

    write_vehicle(replace(load_vehicle("cati2024"), name="own"), folder / "own.toml")
    write_track(synthesise(spectrum("erri_low"), 300.0, 0.25, seed=1), folder / "own.csv")
    text = HEAD.replace("cati2024", "own.toml") + 'tracks = ["own.csv", "erri_high"]\n'
    (folder / "study.toml").write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    found = read_study("here/study.toml")
    assert found.vehicle.name == "own"
    assert [path and path.name for path in found.ride.files] == ["own.csv", None]
    assert found.name == "study"


def test_a_study_goes_to_another_process_without_its_model(study):
    found = study(HEAD)
    assert found.model() is found.model()
    state = found.__getstate__()
    assert "_model" not in state
    vehicle, body = pickle.loads(pickle.dumps((found.vehicle, found.body)))  # noqa: S301
    np.testing.assert_array_equal(body.model(vehicle).matrices().K, found.model().matrices().K)


def test_sections_are_read_by_who_needs_them(study):
    def read(table, draft):
        assert isinstance(draft, Draft)
        asked = table.whole("number"), draft.names.parameter("c_2").unit, len(draft.parameters)
        table.finish()
        return asked

    text = HEAD + '[sweep]\nnumber = 3\n[optimise]\nanything = "goes"\n'
    assert study(text, sweep=read).settings == {"sweep": (3, "N s/m", 0)}
    assert study(HEAD, sweep=read).settings == {"sweep": (None, "N s/m", 0)}


def test_all_faults_of_a_file_come_together(study):
    found = faults(
        study,
        """
vehicle = "cati2024"
sped = 3
[body]
segments = 0
[ride]
speeds = ["145 km/h", "145 km/h"]
tracks = ["erri_lo"]
results = ["awrms"]
weighting = "Wq"
floor = "flat"
positions = []
extrapolate = "yes"
[parameters.secondary_stifness]
from = "400 kN/m"
[parameters.k_2]
from = "400 kN/m"
to = "300 kN/m"
points = 1
[parameters.secondary_stiffness]
values = ["3 kN/m"]
[parameters.f_bending]
from = "-3 Hz"
to = "3 kN"
[parameters.c_2]
from = "3 kN s/m"
to = "3 kN s/m"
spacing = "equal"
[parameters.m_b]
values = ["3 t", "3000 kg"]
from = "3 t"
[sweep]
nunber = 3
""",
        sweep=lambda table, _: (table.whole("number"), table.finish()),
    )
    for where, *parts in (
        ("sped", "not known"),
        ("body.segments", "found 0", "from 1 to 1000"),
        ("ride.speeds[2]", "again"),
        ("ride.tracks[1]", "erri_lo", "did you mean 'erri_low'?"),
        ("ride.results[1]", "awrms", "did you mean a_wrms?"),
        ("ride.weighting", "Wq"),
        ("ride.floor", "flat", "smooth"),
        ("ride.positions", "an empty list"),
        ("ride.extrapolate", "true or false"),
        ("parameters.secondary_stifness", "did you mean secondary_stiffness"),
        ("parameters.k_2.from", "backwards", "swap"),
        ("parameters.k_2.points", "found 1"),
        ("parameters.secondary_stiffness", "'k_2' again"),
        ("parameters.f_bending.from", "a positive number"),
        ("parameters.f_bending.to", "a force"),
        ("parameters.c_2.from", "an empty range"),
        ("parameters.c_2.spacing", "linear, log"),
        ("parameters.m_b", "a range and values"),
        ("parameters.m_b.values[2]", "stands there before"),
        ("sweep.nunber", "did you mean number?"),
    ):
        lines = [line for line in found if f"study.toml: {where}: " in line]
        assert lines, where
        assert all(any(part in line for line in lines) for part in parts), (where, lines)


@pytest.mark.parametrize("end", ["0 kN s/m", "1e-400 kN s/m"])
def test_equal_ratios_to_nothing_are_refused_and_the_grid_counted(tmp_path, end):
    path = tmp_path / "study.toml"
    text = data_path("studies", "sweep_grid.toml").read_text(encoding="utf-8")
    text = text.replace('to = "150 kN s/m"', f'spacing = "log"\nto = "{end}"')
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"secondary_damping.from: found a range that runs backw"):
        read_sweep_study(path)


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", ["an empty file"]),
        ('vehicle = "cati2025"\n', ["did you mean cati2024", "ride.speeds: found nothing"]),
        ('[ride]\nspeeds = ["40 m/s"]\n', ["vehicle: found nothing"]),
        (HEAD + '[parameters.k_2]\nfrom = "3 N/m"\n', ['to = "number N/m"']),
        (HEAD + '[parameters.k_2]\nvalues = []\n', ["values: found an empty list"]),
        (HEAD + '[parameters.c_1]\nfrom="0 N s/m"\nto="1 N s/m"\nspacing="log"', ["above 0"]),
        (HEAD + '[parameters.k_2]\nfrom="3 N/m"\nto="4 N/m"\npoints=100000000000000000000',
         ["parameters.k_2.points: found 100000000000000000000"]),
        (HEAD + "[parameters]\nk_2 = 3\n", ["3; expected a table [parameters.k_2]"]),
        (HEAD.replace("segments = 2", 'kind = "gas"'), ["body: kind: found 'gas'"]),
        (HEAD.replace("cati2024", "manchester"), ["bending"]),
        (HEAD + '[parameters.k_2]\ndistribution = "normal"\ndeviation = "30 %"\nto = "3 MN/m"',
         ["parameters.k_2: found normal", "cut it: from"]),
        (HEAD + '[parameters.k_2]\ndistribution = "normal"\ndeviation = "5 %"\nvalues = []',
         ["parameters.k_2: found a distribution and values"]),
        (HEAD + '[parameters.k_2]\ndistribution = "uniform"\nfrom = "3 N/m"\npoints = 3\n',
         ["parameters.k_2.to", "parameters.k_2.points"]),
        ("schema = 2\n" + HEAD, ["schema: found 2"]),
        (HEAD + 'positions = ["0 m", "99 m"]\n',
         ["study.toml: ride.positions[2]: ", "found a point off the body"]),
    ],
)  # fmt: skip
def test_faulty_studies(study, text, parts):
    found = "\n".join(faults(study, text))
    assert all(part in found for part in parts), found


def test_unknown_studies_are_told_with_the_near_names():
    with pytest.raises(InputError, match="did you mean sweep_grid"):
        read_study("sweep_grd")
