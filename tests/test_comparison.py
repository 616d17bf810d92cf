"""Car bodies side by side: what the comparison says is what each body gives by itself."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import numpy as np
import pytest

import railride as rr
from railride import plots
from railride.comparison import compare_bodies
from railride.errors import InputError
from railride.parameters import load_vehicle

V = 200 / 3.6
ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def found():
    return compare_bodies("cati2024", speeds=[145 / 3.6, V], segments=[1, 2, 4, 8], beams=[3, 10])


def body(found, title):
    return next(one for one in found.bodies if one.title == title)


def test_every_value_is_that_of_the_body_by_itself(found):
    model = rr.derive_vehicle("cati2024", 4)
    one = body(found, "4 segments")
    alone = rr.stochastic_ride(model, V, rr.spectrum("erri_low"), found.positions)
    np.testing.assert_allclose(one.a_wrms[1], alone.a_wrms, rtol=1e-9)
    np.testing.assert_allclose(one.free_hz, model.bending_frequencies()[:3], rtol=1e-12)
    labelled = {mode.label: mode.frequency_hz for mode in rr.modes(model)}
    assert one.vehicle_hz[1] == labelled["bending 2"]
    assert one.dof == 9  # N + 5


def test_positions_are_the_middle_the_bogies_and_the_ends(found):
    assert found.positions == (0.0, 8.75, -8.75, 12.0, -12.0)
    assert [one.title for one in found.bodies] == [
        "rigid", "2 segments", "4 segments", "8 segments", "beam, 3 modes", "beam, 10 modes",
    ]  # fmt: skip
    assert found.reference.modes == 30


def test_smooth_floor_converges_to_the_beam_at_the_middle(found):
    # physics of the smooth floor: N = 4 within 1 %, N = 8 within 0.2 % of the beam limit.
    assert np.abs(body(found, "4 segments").error[:, 0]).max() < 0.01
    assert np.abs(body(found, "8 segments").error[:, 0]).max() < 0.002
    assert np.abs(body(found, "beam, 10 modes").error).max() < 2e-4
    assert found.reference.error.max() == 0.0
    assert (body(found, "rigid").error < -0.2).all()


def test_the_polygon_over_reads_at_the_hinge():
    # Known of the polygon at the middle, against the beam limit: N = 2 +39 %, 3 -17 %, 4 +14 %.
    polygon = compare_bodies("cati2024", speeds=[145 / 3.6, V], at=[0.0], segments=[2, 3, 4],
                             beams=[], floor="polygon")  # fmt: skip
    errors = [one.error.mean() for one in polygon.bodies]
    np.testing.assert_allclose(errors, [0.39, -0.17, 0.14], atol=0.02)


def test_frequencies_of_segments_against_the_beam(found):
    # Free-free chain of equal rods against Euler-Bernoulli, calibrated to the same first frequency:
    # -3.92 % and -19.4 % less the first mode's -0.317 %.
    ratio = body(found, "4 segments").free_hz / found.reference.free_hz
    expected = np.array([1.0, (1 - 0.0392) / (1 - 0.00317), (1 - 0.194) / (1 - 0.00317)])
    np.testing.assert_allclose(ratio, expected, atol=1e-3)


def test_table_has_a_row_for_every_body_speed_and_position(found):
    table = found.table()
    assert len(table) == 6 * 2 * 5
    assert table["speed [km/h]"].tolist()[:6] == [145.0] * 5 + [200.0]
    assert table["bending 2 [Hz]"].isna().sum() == 20  # rigid, and two segments
    assert (table["derive [s]"] > 0).all()
    assert (table["simulate [s]"] > 0).all()
    assert "bending 1" in found._repr_html_()


def test_what_is_given_reaches_every_body():
    given = compare_bodies("cati2024", speeds=[V], at=[0.0], segments=[4], beams=[2],
                           bending_frequency=8.0, bending_damping=0.02)  # fmt: skip
    for one in given.bodies:
        assert one.free_hz[0] == pytest.approx(8.0, rel=1e-9)
    free = compare_bodies("cati2024", speeds=[V], at=[0.0], segments=[4], beams=[2],
                          bending_frequency=8.0)  # fmt: skip
    assert given.bodies[0].a_wrms[0, 0] < free.bodies[0].a_wrms[0, 0]


def test_pictures_draw_errors_over_degrees_of_freedom(found, tmp_path):
    ax = plots.plot_convergence(found)
    lines = {line.get_label(): line for line in ax.get_lines()}
    assert list(lines["segments"].get_xdata()) == [7, 9, 13]
    expected = [np.abs(body(found, f"{n} segments").error[:, 0]).max() for n in (2, 4, 8)]
    np.testing.assert_allclose(lines["segments"].get_ydata(), expected)
    assert ax.get_xlabel() == "degrees of freedom of the vehicle"
    bending = plots.plot_bending_convergence(found)
    (line,) = bending.get_lines()
    assert list(line.get_xdata()) == [9, 13]  # three frequencies; beams have them exactly
    plots.save(plots.plot_comparison(found), tmp_path / "bodies.png")
    titles = [ax.get_title(loc="left") for ax in plots.plot_comparison(found).axes]
    assert titles[:3] == ["at the middle", "8.75 m ahead of the middle", "12 m ahead of the middle"]


def test_a_body_with_a_profile_is_measured_against_finite_elements(tmp_path):
    pytest.importorskip("skfem")
    text = (ROOT / "data" / "vehicles" / "cati2024.toml").read_text(encoding="utf-8")
    head, rest = text.split("[body]", 1)
    bogie = rest[rest.index("[bogie]") :]
    profile = """[body.profile]
x = ["-12 m", "0 m", "12 m"]
bending_stiffness = ["2e9 N m^2", "3e9 N m^2", "2e9 N m^2"]
mass_per_length = ["1500 kg/m", "1300 kg/m", "1500 kg/m"]

"""
    file = tmp_path / "uneven.toml"
    file.write_text(head + profile + bogie, encoding="utf-8")
    uneven = compare_bodies(
        str(file), speeds=[V], at=[0.0], segments=[4, 8], beams=[3], elements=[10]
    )
    assert uneven.reference.body == "fe"
    assert [one.title for one in uneven.bodies] == ["4 segments", "8 segments", "fe, 10 modes"]
    four, eight, fe = (abs(one.error[0, 0]) for one in uneven.bodies)
    assert fe < 1e-3
    assert eight < four / 8  # fourth order would be a sixteenth
    assert any("left out: beam of 3 modes" in remark for remark in uneven.remarks)


def of_paper(tmp_path, body):
    """The paper's coach with other lines for its body."""
    text = (ROOT / "data" / "vehicles" / "cati2024.toml").read_text(encoding="utf-8")
    head, rest = text.split("[body]", 1)
    file = tmp_path / "coach.toml"
    file.write_text(head + body + "\n" + rest[rest.index("[bogie]") :], encoding="utf-8")
    return str(file)


WHOLE = """[body]
mass = "34 t"
pitch_inertia = "1.7e6 kg m^2"
length = "24 m"
"""


def test_segments_meet_several_frequencies_and_beams_the_first(tmp_path):
    file = of_paper(tmp_path, WHOLE + 'bending_frequencies = ["9.6 Hz", "26.46 Hz"]')
    found = compare_bodies(file, speeds=[V], at=[0.0], segments=[4], beams=[3])
    four, beam = found.bodies
    assert any("of 9.6, 26.46 Hz are not used" in remark for remark in found.remarks)
    assert four.free_hz[:2] == pytest.approx([9.6, 26.46], rel=1e-9)
    assert beam.free_hz[0] == pytest.approx(9.6, rel=1e-9)


def test_what_cannot_be_made_is_left_out_with_its_reason(tmp_path):
    file = of_paper(tmp_path, WHOLE + 'bending_frequency = "9.6 Hz"\nmode_damping = [0.01, 0.02]')
    found = compare_bodies(file, speeds=[V], at=[0.0], segments=[1, 4], beams=[3])
    assert [one.title for one in found.bodies] == ["rigid", "beam, 3 modes"]
    assert any(remark.startswith("left out: 4 segments: ") and "mode_damping" in remark
               for remark in found.remarks)  # fmt: skip


def test_segments_of_their_own_are_measured_against_themselves(tmp_path):
    each = '[[segments]]\nlength = "6 m"\nmass = "8.5 t"\n'
    file = of_paper(tmp_path, '[body]\njoint_stiffness = "6e8 N m/rad"\n' + 4 * each)
    found = compare_bodies(file, speeds=[V], at=[0.0], segments=[1, 4, 8], beams=[3])
    assert found.reference.title == "4 segments"
    assert [one.title for one in found.bodies] == ["rigid", "4 segments"]
    assert found.bodies[1].error == 0.0
    left = [remark for remark in found.remarks if remark.startswith("left out")]
    assert len(left) == 2


def test_what_a_spectrum_does_not_hold_is_told():
    found = compare_bodies("cati2024", "sncf_good", [V], at=[0.0], segments=[4], beams=[])
    assert any("wavelengths of 2 to 40 m only" in remark for remark in found.remarks)


def test_progress_ends_at_one():
    seen = []
    compare_bodies(
        "cati2024", speeds=[V], at=[0.0], segments=[1, 2], beams=[], progress=seen.append
    )
    assert seen == sorted(seen)
    assert seen[-1] == 1.0
    compare_bodies("cati2024", speeds=[V], at=[0.0], segments=[1], beams=[1000],
                   progress=seen.append)  # fmt: skip
    assert seen[-2:] == [0.5, 1.0]  # the beam is left out, and done all the same


def test_nothing_to_compare_and_a_body_without_bending():
    with pytest.raises(InputError, match="no bodies"):
        compare_bodies("cati2024", segments=[], beams=[])
    stiff = load_vehicle("manchester")
    with pytest.raises(InputError, match="give --bending-frequency"):
        compare_bodies(stiff, segments=[2])
    given = compare_bodies(
        stiff, speeds=[V], at=[0.0], segments=[4], beams=[], bending_frequency=9.0
    )
    assert given.bodies[0].free_hz[0] == pytest.approx(9.0, rel=1e-9)


def test_command_as_promised(run, tmp_path):
    options = ("--segments", "1", "--segments", "4", "--speed", "200", "--at", "0")
    code, out, err = run("compare", *options, "--format", "json")
    assert code == 0, err
    document = json.loads(out, parse_constant=pytest.fail)
    rigid, four = document["bodies"]
    assert {"body", "segments", "modes", "dof", "bending_hz", "a_wrms", "error"} <= set(rigid)
    assert (rigid["body"], rigid["segments"], rigid["dof"], rigid["bending_hz"]) == (
        "rigid",
        1,
        6,
        [],
    )
    assert four["error"] == pytest.approx(four["a_wrms"] / document["reference"]["a_wrms"] - 1)
    assert four["cases"][0]["speed_kmh"] == 200.0
    said = [remark for remark in document["remarks"] if "is not used" in remark]
    assert len(said) == 2  # of the beam, and of the segments once
    code, out, _ = run("compare", *options, "--format", "csv")
    rows = list(csv.DictReader(io.StringIO(out)))
    assert code == 0
    assert [row["segments"] for row in rows] == ["1", "4"]
    assert rows[0]["bending_1_hz"] == ""
    picture = tmp_path / "bodies.svg"
    code, out, err = run("compare", *options, "--plot", picture)
    assert code == 0, err
    assert "first what they are measured against" in out
    assert "error against beam, 30 modes" in out
    assert picture.stat().st_size > 0


@pytest.mark.parametrize(("options", "words"), [
    (("--segments", "0"), ("--segments", "whole number from 1")),
    (("--modes", "x"), ("--modes", "whole number from 1")),
    (("--vehicle", "manchester", "--segments", "2"), ("bending",)),
    (("--at", "13", "--segments", "1"), ("13",)),
    (("--plot", "bodies.txt"), ("bodies.txt", ".png")),
    (("--speed", "0"), ("--speed",)),
])  # fmt: skip
def test_bad_options(run, options, words):
    code, out, err = run("compare", *options)
    assert (code, out) == (2, "")
    assert "Traceback" not in err
    for word in (*words, "found", "expected"):
        assert word in err
