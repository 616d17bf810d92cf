"""What every export holds: its outputs, where the values are from, lines that fit."""

from __future__ import annotations

import io
import zipfile
from dataclasses import replace

import numpy as np
import pytest
from export_cases import COACH, content, every_body
from vehicles import paper_coach, random_vehicle

from railride import InputError, Output, derive_vehicle, export_model
from railride.exports import source
from railride.exports.content import content_of
from railride.exports.targets import TARGETS
from railride.exports.write import export_content


def test_outputs_that_are_asked_for():
    model = paper_coach(2)
    own = model.outputs["secondary_1_deflection"]
    asked = content_of(
        model, ["floor_acceleration", own, "primary_4_deflection"], [3, -2], "spline"
    )
    assert asked.outputs == (
        model.floor(3.0, "spline"),
        model.floor(-2.0, "spline"),
        own,
        model.outputs["primary_4_deflection"],
    )
    assert content_of(model, at=2.5).outputs[0] == model.floor(2.5)
    assert content_of(model, own).outputs == (own,)


@pytest.mark.parametrize(("given", "said"), [
    ({"outputs": "primary_1_deflection", "at": 3}, r"points of it, \[3.0\] m"),
    ({"outputs": "primary_1_deflection", "floor": "spline"}, "the floor on its spline line"),
    ({"at": "front"}, "at: found 'front'"),
    ({"outputs": []}, "outputs: found none"),
    ({"outputs": "floor_acceleration", "at": []}, "outputs: found none"),
    ({"speed": 40.0}, "speed: found 40.0, but no track"),
    ({"length": 10.0}, "length: found 10.0, but no track"),
    ({"seed": 3}, "seed: found 3, but no track"),
    ({"track": "erri_low"}, "track: found one for 'npz'"),
    ({"target": "excel", "track": "erri_low"}, "target: found 'excel'"),
])  # fmt: skip
def test_what_does_not_go_together(given, said, tmp_path):
    with pytest.raises(InputError, match=said):
        export_model(paper_coach(2), file=tmp_path / "x", **{"target": "npz"} | given)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("outputs", ["primary_1_deflection", ["bogie_1_acceleration"]])
def test_a_ride_needs_a_floor(outputs, tmp_path):
    model = paper_coach(2)
    if outputs == ["bogie_1_acceleration"]:
        outputs = [name for name in model.outputs if name.endswith("acceleration")]
    with pytest.raises(InputError, match="expected 'floor_acceleration' among them"):
        export_model(model, "modelica", tmp_path / "x.mo", outputs=outputs, track="erri_low")


@pytest.mark.parametrize(("given", "said"), [
    ({"length": -5.0}, "track: length: found -5.0 m; expected a positive number"),
    ({"length": "long"}, "track: length: found 'long'"),
    ({"speed": -3.0}, "speed: found -3.0 m/s"),
    ({"seed": -1}, "seed: found -1"),
    ({"length": 60e3}, "track: found a table of [0-9,]+ rows; expected 1,000,000 at most"),
])  # fmt: skip
def test_a_ride_must_be_one(given, said, tmp_path):
    with pytest.raises(InputError, match=said):
        export_model(paper_coach(1), "modelica", tmp_path / "x.mo", **{"track": "erri_low"} | given)


def test_an_output_must_have_a_name_of_its_own():
    taken = [Output(name, paper_coach(2).floor().expression, "m/s^2", "")
             for name in ("m_c", "dw_1", "f_2", "z_0", "dz_0", "ddz_0")]  # fmt: skip
    with pytest.raises(InputError, match="'m_c': found the name of a parameter") as refused:
        content_of(paper_coach(2), taken)
    assert len(str(refused.value).splitlines()) == len(taken)


WICKED = 'Works */ /*/ \x01 no. 7\n """ "quoted" \\ and ' + "so on " * 40


@pytest.mark.parametrize("target", TARGETS)
def test_every_form_tells_where_the_values_are_from(target):
    vehicle = replace(COACH, source=WICKED, remarks=("the mass is a guess",))
    own = content_of(derive_vehicle(vehicle, 2))
    found = export_content(own, target)
    if target in ("fmu", "npz", "matlab"):
        said = _read(target, found)
    else:
        said = " ".join(line.lstrip(" */#%") for line in found.splitlines())
    for text in ("Works", "no. 7", "so on so on", "the mass is a guess"):
        assert text in said
    if target == "python":
        compile(found, "coach.py", "exec")


def _read(target, found):
    if target == "npz":
        return " ".join(np.load(io.BytesIO(found))["origin"])
    if target == "matlab":
        from scipy.io import loadmat

        return " ".join(loadmat(io.BytesIO(found), simplify_cells=True)["origin"])
    with zipfile.ZipFile(io.BytesIO(found)) as fmu:
        return fmu.read("modelDescription.xml").decode().partition("<CoSimulation")[0]


@every_body
@pytest.mark.parametrize("target", ["modelica", "python", "c"])
def test_every_line_fits(kind, target):
    assert max(map(len, export_content(content(kind), target).splitlines())) <= source.WIDTH


@pytest.mark.parametrize("target", ["modelica", "python", "c"])
def test_lines_fit_off_the_middle(target):
    """Entries by many powers of a place, and what a spline makes of it."""
    beam = content_of(derive_vehicle("cati2024", body="beam", modes=3), at=[-6.5, 3.0])
    spline = content_of(derive_vehicle(random_vehicle(5), 5), at=[-6.5, 3.0], floor="spline")
    for own in (beam, spline):
        assert max(map(len, export_content(own, target).splitlines())) <= source.WIDTH
