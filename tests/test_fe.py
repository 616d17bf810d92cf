"""Vehicles on a car body of finite elements: their own, or from outside by parameter files."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest
from outside_bodies import ELEMENTS_HZ, INERTIA, MASS, beam
from scipy.io import mmwrite
from scipy.sparse import coo_array
from typer.testing import CliRunner

from railride.bodies.element_modes import element_modes
from railride.bodies.fe import fe_body
from railride.body_sources import Elements, ModeFiles
from railride.cli import app
from railride.errors import InputError
from railride.files import data_path
from railride.parameters import BodyProfile, CarBody, load_vehicle, write_vehicle
from railride.rides import ride
from railride.vehicle import derive_vehicle

COACH = load_vehicle("cati2024")
PROFILE = BodyProfile((-12, -3, -3, 12), (3e9, 2e9, 1e9, 3e9), (1500, 1300, 1200, 1600))
SHEARING = replace(PROFILE, shear_stiffness=(4e8,) * 4, rotary_inertia=(2000.0,) * 4)


def test_the_papers_coach_of_elements_rides_as_the_beam():
    fe, exact = (derive_vehicle(COACH, body=kind) for kind in ("fe", "beam"))
    np.testing.assert_allclose(fe.bending_frequencies()[:5], exact.bending_frequencies()[:5],
                               rtol=1e-6)  # fmt: skip
    here, there = (ride(model, at=(0.0, 4.0, -8.75, 12.0), spectral=True) for model in (fe, exact))
    for a, b in zip(here.cases, there.cases, strict=True):
        assert a.a_wrms_exact == pytest.approx(b.a_wrms_exact, rel=1e-5)


@pytest.mark.parametrize("bending", [{"bending_frequency": 9.6}, {"bending_stiffness": 3e9}])
def test_a_shearing_coach_of_elements_is_timoshenkos_beam(bending):
    body = CarBody(34e3, 1.65e6, 24.0, shear_stiffness=4e8, rotary_inertia=2800.0, **bending)
    vehicle = replace(COACH, body=body)
    fe, exact = (derive_vehicle(vehicle, body=kind, modes=6) for kind in ("fe", "beam"))
    np.testing.assert_allclose(fe.bending_frequencies(), exact.bending_frequencies(), rtol=1e-6)
    x = np.linspace(-12, 12, 25)
    here, there = (model.body.modes.shapes(x) for model in (fe, exact))
    sign = np.sign(here[:, -1] * there[:, -1])[:, np.newaxis]
    np.testing.assert_allclose(here * sign, there, atol=1e-4)


@pytest.mark.parametrize("profile", [PROFILE, SHEARING], ids=["slender", "shearing"])
def test_a_bending_frequency_scales_the_profile(profile):
    own = element_modes(profile, 3).frequencies
    found = fe_body(CarBody.of(profile, bending_frequency=11.0), 3).modes
    assert found.frequencies[0] == pytest.approx(11.0, rel=1e-9)
    assert found.remarks == ("the bending frequency of 11 Hz scales the profile's EI",)
    if profile is PROFILE:
        np.testing.assert_allclose(found.frequencies, own * 11.0 / own[0], rtol=1e-9)
    several = fe_body(CarBody.of(profile, bending_frequencies=(11.0, 30.0)), 3).modes
    assert several.frequencies[0] == pytest.approx(11.0, rel=1e-9)


def test_a_frequency_that_shear_does_not_allow_is_refused():
    with pytest.raises(InputError, match=r"100 Hz where the shear stiffness allows at most \d"):
        fe_body(CarBody.of(SHEARING, bending_frequency=100.0), 3)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (CarBody(MASS, INERTIA, 24.0), "body fe: body: found nothing of its bending"),
        (CarBody(MASS, INERTIA, 24.0, joint_stiffness=3e8), "found a joint_stiffness of 3e"),
        (CarBody(MASS, INERTIA, 24.0, mass_centre=0.3, bending_frequency=9.0),
         r"body.mass_centre: found 0\.3 m.*fe with a profile"),
        (CarBody.of(PROFILE, joint_damping=1e5), "body.joint_damping"),
        (CarBody.of(PROFILE, shear_stiffness=4e8), "found 4e.08 beside a profile"),
        (CarBody.of(PROFILE, elements=Elements(7)), "elements: found 7; expected .* from 20"),
        (CarBody.of(PROFILE, elements=Elements(None, (1.0, 15.0))), "15 m, a point off the body"),
    ],
)  # fmt: skip
def test_bodies_that_elements_cannot_be_made_of_are_refused(body, words):
    with pytest.raises(InputError, match=words):
        fe_body(body)


def test_damping_is_the_bodys():
    rayleigh = CarBody.of(PROFILE, rayleigh_mass=0.5, rayleigh_stiffness=2e-4)
    model = derive_vehicle(replace(COACH, body=rayleigh), body="fe", modes=3)
    f = model.bending_frequencies()
    values = model.values()
    for i in range(3):
        assert values[f"zeta_c{i + 1}"] == pytest.approx(
            0.5 / (4 * np.pi * f[i]) + np.pi * 2e-4 * f[i], rel=1e-12
        )


def test_an_interface_reduction_keeps_the_ride():
    reduced = CarBody.of(PROFILE, elements=Elements(None, (-8.75, 0.0, 8.75)), bending_damping=0.01)
    full = replace(reduced, elements=None)
    here, there = (ride(derive_vehicle(replace(COACH, body=body), body="fe", modes=n),
                        at=(0.0, 4.0), spectral=True)
                   for body, n in ((reduced, 8), (full, 30)))  # fmt: skip
    for a, b in zip(here.cases, there.cases, strict=True):
        assert a.a_wrms_exact == pytest.approx(b.a_wrms_exact, rel=1e-3)


# Parameter files

TEXT = data_path("vehicles", "cati2024.toml").read_text(encoding="utf-8")
BOGIES = TEXT[TEXT.index("[bogie]") :]
BODY = f'[body]\nmass = "{MASS} kg"\npitch_inertia = "{INERTIA} kg m^2"\nlength = "24 m"\n'


def vehicle_file(tmp_path, more, body=BODY):
    path = tmp_path / "coach.toml"
    path.write_text(f'name = "coach"\nsource = ""\n{body}{more}\n{BOGIES}', encoding="utf-8")
    return path


def modes_table(tmp_path, reach=12.0):
    x = np.linspace(-reach, reach, 49)
    uniform = BodyProfile((-12, 12), (3e9, 3e9), (1400, 1400))
    modes = element_modes(uniform, 5)
    lines = [
        "x [m]" + "".join(f",mode {i}" for i in range(1, 6)),
        "frequency [Hz]," + ",".join(map(repr, modes.frequencies.tolist())),
        "modal_mass [kg]" + f",{MASS!r}" * 5,
    ]
    for at, row in zip(x, modes.shapes(x).T, strict=True):
        lines.append(",".join(map(repr, [float(at), *row.tolist()])))
    (tmp_path / "modes.csv").write_text("\n".join(lines), encoding="utf-8")


def test_modes_from_a_table_beside_the_parameter_file(tmp_path):
    modes_table(tmp_path)
    vehicle = load_vehicle(vehicle_file(tmp_path, '[body.modes]\nfile = "modes.csv"'))
    model = derive_vehicle(vehicle)
    assert (model.body.kind, model.body.options) == ("modes", "--body fe --modes 5")
    own = replace(vehicle.body, mode_files=None, bending_stiffness=3e9)
    exact = derive_vehicle(replace(vehicle, body=own), body="beam", modes=5)
    np.testing.assert_allclose(model.bending_frequencies(), exact.bending_frequencies(), rtol=1e-6)
    here, there = (ride(m, at=(0.0, 4.0, 12.0), spectral=True) for m in (model, exact))
    for a, b in zip(here.cases, there.cases, strict=True):
        assert a.a_wrms_exact == pytest.approx(b.a_wrms_exact, rel=1e-4)
    assert derive_vehicle(vehicle, body="fe", modes=2).body.mode_count == 2
    with pytest.raises(InputError, match="modes: found 6; expected 1 to 5"):
        derive_vehicle(vehicle, body="fe", modes=6)


def test_matrices_beside_the_parameter_file(tmp_path):
    M, K, x, vertical = beam()
    np.savez(tmp_path / "coach.npz", M=M / 1000, K=K / 1000, x=x * 1000, vertical=vertical)
    for name, A in (("M", M / 1000), ("K", K / 1000)):
        mmwrite(tmp_path / f"{name}.mtx", coo_array(A), symmetry="symmetric", precision=17)
    rows = [f"{a!r},{int(b)}" for a, b in zip(x.tolist(), vertical, strict=True)]
    (tmp_path / "dofs.csv").write_text("\n".join(["x [m],vertical", *rows]), encoding="utf-8")
    for keys in (
        'matrices = "coach.npz"\nlength_unit = "mm"',
        'mass_matrix = "M.mtx"\nstiffness_matrix = "K.mtx"\ncoordinates = "dofs.csv"',
    ):
        path = vehicle_file(tmp_path, f'[body.modes]\n{keys}\nmass_unit = "t"')
        model = derive_vehicle(load_vehicle(path))
        assert model.body.mode_count == 10
        np.testing.assert_allclose(model.bending_frequencies()[:4], ELEMENTS_HZ[:4], rtol=1e-7)


def test_segments_beside_modes_from_outside(tmp_path):
    """A file may hold both; without a number of segments the modes count."""
    modes_table(tmp_path)
    body = BODY + 'bending_frequency = "9.6 Hz"\n'
    vehicle = load_vehicle(vehicle_file(tmp_path, '[body.modes]\nfile = "modes.csv"', body))
    assert derive_vehicle(vehicle, 4).body.kind == "segments"
    model = derive_vehicle(vehicle)
    (remark,) = (r for r in model.remarks if "is not used" in r)
    assert "the bending frequency of 9.6 Hz is not used: that of the modes from outside" in remark


def test_elements_in_a_parameter_file(tmp_path):
    keys = '[body.elements]\nnumber = 40\ninterfaces = ["-8.75 m", "0 m", "8.75 m"]'
    body = BODY + 'bending_stiffness = "3 GN m^2"\n'
    vehicle = load_vehicle(vehicle_file(tmp_path, keys, body))
    assert vehicle.body.elements == Elements(40, (-8.75, 0.0, 8.75))
    model = derive_vehicle(vehicle, body="fe", modes=6)
    assert "Craig–Bampton: the first" in model.remarks[-1]


def test_what_is_written_reads_back(tmp_path):
    modes_table(tmp_path)
    keys = '[body.elements]\nnumber = 40\ninterfaces = ["-8.75 m", "8.75 m"]\n'
    vehicle = load_vehicle(vehicle_file(tmp_path, keys + '[body.modes]\nfile = "modes.csv"'))
    other = tmp_path / "other"
    other.mkdir()
    write_vehicle(vehicle, other / "coach.toml")
    again = load_vehicle(other / "coach.toml")
    assert again == vehicle
    assert derive_vehicle(again).body.mode_count == 5


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ("[body.modes]", "body.modes.file: found no file; expected file, or matrices, or mass_m"),
        ('[body.modes]\nfile = "a"\nmatrices = "b"', "found file and matrices; expected"),
        ('[body.modes]\nmass_matrix = "a"', "found mass_matrix; expected"),
        ('[body.modes]\nfile = "a"\nmass_unit = "t"', "body.modes.mass_unit: found 't' without"),
        ('[body.modes]\nfile = 3', "body.modes.file: found 3; expected a text"),
        ('[body.modes]\nfiel = "a"', "did you mean file"),
        ('[body.elements]\nnumber = 4.5', "body.elements.number: found 4.5; expected a whole"),
        ('[body.elements]\ninterfaces = [1, 2]', r"body.elements.interfaces\[1\]: found '1' with"),
    ],
)  # fmt: skip
def test_keys_that_cannot_be_are_refused(tmp_path, keys, words):
    with pytest.raises(InputError, match=words):
        load_vehicle(vehicle_file(tmp_path, keys))


def test_a_file_that_is_missing_is_named_when_it_is_needed(tmp_path):
    vehicle = load_vehicle(vehicle_file(tmp_path, '[body.modes]\nfile = "modes.csv"'))
    with pytest.raises(InputError, match=r"coach: .*modes\.csv: file: found no such file"):
        derive_vehicle(vehicle)


def test_points_that_do_not_reach_a_bogie_are_refused(tmp_path):
    modes_table(tmp_path, 8.0)
    vehicle = load_vehicle(vehicle_file(tmp_path, '[body.modes]\nfile = "modes.csv"'))
    with pytest.raises(InputError, match=r"none beyond x = -8 and 8 m; expected .* of 8\.75 m"):
        derive_vehicle(vehicle)


def test_records_of_other_kinds_are_refused():
    with pytest.raises(InputError, match="elements: found 40; expected Elements"):
        CarBody(MASS, INERTIA, 24.0, elements=40)
    with pytest.raises(InputError, match=r"mode_files: found 'a\.csv'; expected ModeFiles"):
        CarBody(MASS, INERTIA, 24.0, mode_files="a.csv")
    with pytest.raises(InputError, match="found no file"):
        ModeFiles()


# The command line


def run(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def test_the_command_line_takes_finite_elements():
    found = json.loads(run("modes", "--body", "fe", "--modes", 3, "--format", "json").stdout)
    labels = [mode["label"] for mode in found["modes"]]
    assert [f"bending {i}" in labels for i in (1, 2, 3, 4)] == [True, True, True, False]
    assert run("modes", "--body", "fe", "--segments", 4).exit_code == 2


def test_the_command_line_takes_a_body_from_outside(tmp_path):
    modes_table(tmp_path)
    path = vehicle_file(tmp_path, '[body.modes]\nfile = "modes.csv"')
    found = [json.loads(run("ride", "--vehicle", path, "--spectral", *more, "--format",
                            "json").stdout) for more in ((), ("--body", "fe"))]  # fmt: skip
    assert found[0]["cases"] == found[1]["cases"]
    assert found[0]["cases"][0]["body"] == "modes"
    refused = run("modes", "--vehicle", path, "--body", "beam")
    assert refused.exit_code == 2
    assert "bending is not known" in refused.stderr
