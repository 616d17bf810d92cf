"""Data along the car body: exact integrals, what is refused, and its tables in parameter files.

The integrals are compared with scipy's adaptive quadrature of the values themselves.
"""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from railride.errors import InputError
from railride.files import data_path
from railride.parameters import BodyProfile, CarBody, PointMass, load_vehicle, write_vehicle

X = (-12.0, -8.0, -8.0, -6.5, 3.0, 3.0, 12.0)
PROFILE = BodyProfile(
    x=X,
    bending_stiffness=(2e9, 3e9, 1e9, 1.00001e9, 4e9, 2.5e9, 2e9),
    mass_per_length=(1800, 1200, 1300, 0, 1500, 1100, 1900),
    rotary_inertia=(900, 800, 0, 500, 700, 700, 100),
    point_masses=(PointMass(2500, -4.0, 800.0), PointMass(1200, 12.0), PointMass(900, 3.0)),
)
COACH = data_path("vehicles", "cati2024.toml").read_text(encoding="utf-8")
OWN = COACH[COACH.index('mass = "34000 kg"') : COACH.index("bending_frequency =")]
TABLE = """
[body.profile]
x = ["-12 m", "0 m", "12 m"]
bending_stiffness = ["3 GN m^2", "3.2e9 N m^2", "3e9 N m^2"]
mass_per_length = ["1.5 t/m", "1300 kg/m", "1500 kg/m"]
[[body.profile.point_masses]]
mass = "400 kg"
position = "6 m"
"""


def integral(function, rear, front):
    """∫ function dx, from knot to knot."""
    ends = np.unique(np.clip([rear, *X, front], rear, front))
    return sum(quad(function, a, b)[0] for a, b in itertools.pairwise(ends))


@pytest.mark.parametrize(("rear", "front"), [(-12, 12), (-12, -8), (-9.1, 3), (-7, -6.6), (2, 12)])
@pytest.mark.parametrize("about", [0.0, -3.3])
def test_moments_are_those_of_the_density(rear, front, about):
    found = PROFILE.moments(rear, front, about)
    on = [
        p for p in PROFILE.point_masses if rear <= p.position < front or p.position == front == 12
    ]
    for n, value in enumerate(found):
        own = integral(
            lambda x, n=n: PROFILE.at("mass_per_length", x) * (x - about) ** n, rear, front
        )
        own += sum(p.mass * (p.position - about) ** n for p in on)
        if n == 2:
            own += integral(lambda x: PROFILE.at("rotary_inertia", x), rear, front)
            own += sum(p.pitch_inertia for p in on)
        assert value == pytest.approx(own, rel=1e-12, abs=1e-9)


def test_rigid_values_are_the_moments_about_the_mass_centre():
    m, S, J = PROFILE.moments(-12, 12, PROFILE.mass_centre)
    assert abs(S) < 1e-9 * m
    assert (PROFILE.mass, PROFILE.pitch_inertia) == pytest.approx((m, J), rel=1e-13)
    assert PROFILE.length == 24.0


def test_values_at_a_jump_are_those_ahead_of_it():
    EI = PROFILE.at("bending_stiffness", [[-12, -8.0], [3.0, 12.0], [-10.0, 7.5]])
    assert EI.tolist() == [[2e9, 1e9], [2.5e9, 2e9], [2.5e9, 2.25e9]]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"bending_stiffness": (2e9, 0, *[3e9] * 5)}, r"bending_stiffness\[2\]: found 0; expected"),
        ({"mass_per_length": (-1.0, *[3e3] * 6)}, r"mass_per_length\[1\]: found -1.0; exp"),
        ({"shear_stiffness": (1e8,)}, "shear_stiffness: found 1 values; expected 7, one for each"),
        ({"x": (-12, -8, -9, -6.5, 3, 3, 12)}, r"x\[3\]: found -9 m after -8 m; expected asc"),
        ({"x": (-12, -8, -8, -8, 3, 3, 12)}, r"x\[4\]: found -8 m a third time"),
        ({"x": (-12, -12, -8, -6, 3, 3, 12)}, "x: found a jump at the rear end, -12 m"),
        ({"x": (-12, -8, -8, -6, 3, 12, 12)}, "x: found a jump at the front end, 12 m"),
        ({"x": (-12, -8, -8, -6, 3, 3, 13)}, "x: found knots from -12 to 13 m; expected"),
        ({"x": "0"}, "x: found '0'; expected a sequence of numbers"),
        ({"mass_per_length": (0.0,) * 7}, "mass_per_length: found zero all along"),
        ({"point_masses": (PointMass(1.0, 12.5),)}, r"point_masses\[1\].position: found 12.5 m"),
        ({"point_masses": (3.0,)}, "point_masses: found .*; expected a sequence of PointMass"),
    ],
)  # fmt: skip
def test_a_profile_refuses_what_no_body_has(changes, message):
    with pytest.raises(InputError, match=f"body profile: {message}"):
        replace(PROFILE, **changes)


def test_a_point_mass_refuses_impossible_numbers():
    with pytest.raises(
        InputError, match="point mass: mass: found 0; expected a positive number kg"
    ):
        PointMass(0, 1.0)


def test_the_body_of_a_profile_has_its_mass_and_inertia():
    body = CarBody.of(PROFILE)
    assert (body.mass, body.mass_centre, body.pitch_inertia, body.length) == (
        PROFILE.mass, PROFILE.mass_centre, PROFILE.pitch_inertia, 24.0)  # fmt: skip
    assert replace(body, mass=body.mass * 1.0009).mass == PROFILE.mass


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        (
            {"mass": 34e3},
            r"mass: found 34000 kg; expected 32200 kg, that of the profile",
        ),
        ({"mass_centre": 0.0}, "mass_centre: found 0 m; expected 1.38043 m, that of the profile"),
        ({"length": 24.001}, "length: found 24.001 m; expected 24 m, that of the profile"),
        ({"bending_stiffness": 3e9}, "bending_stiffness: found bending_stiffness and a profile"),
        ({"inertia": "rods"}, "inertia: found 'rods' with a mass dis.*; expected \"auto\""),
    ],
)
def test_a_body_refuses_what_contradicts_its_profile(changes, message):
    with pytest.raises(InputError, match=f"car body: {message}"):
        replace(CarBody.of(PROFILE), **changes)


def test_a_profile_in_a_parameter_file_stands_in_for_the_body_s_own(tmp_path):
    path = tmp_path / "coach.toml"
    path.write_text(COACH.replace(OWN, "") + TABLE, encoding="utf-8")
    body = load_vehicle(path).body
    assert body.profile == BodyProfile(
        (-12, 0, 12), (3e9, 3.2e9, 3e9), (1500, 1300, 1500), point_masses=(PointMass(400, 6.0),)
    )
    assert (body.mass, body.mass_centre) == (34000, pytest.approx(2400 / 34000, rel=1e-14))


def test_a_profile_is_written_so_that_it_reads_back_equal(tmp_path):
    path = tmp_path / "coach.toml"
    vehicle = replace(load_vehicle("cati2024"), body=CarBody.of(PROFILE, bending_damping=0.01))
    write_vehicle(vehicle, path)
    assert load_vehicle(path) == vehicle


def test_faults_of_a_profile_in_a_file_are_named_by_key(tmp_path):
    path = tmp_path / "coach.toml"
    wrong = TABLE.replace('"0 m"', '"13 m"').replace('"3 GN m^2"', '"-3 GN m^2"')
    wrong = wrong.replace('position = "6 m"', "").replace("mass_per_length", "mass_by_length")
    path.write_text(COACH + wrong, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_vehicle(path)
    for expected in (
        "body.profile.x[3]: found 12 m after 13 m",
        "body.profile.bending_stiffness[1]: found '-3 GN m^2'; expected a positive number",
        "body.profile.point_masses[1].position: found nothing",
        "body.profile.mass_by_length: found a key that is not known",
        "body.profile.mass_per_length: found nothing",
    ):
        assert f"{path}: {expected}" in str(caught.value)


def test_a_file_that_contradicts_its_profile_says_both_values(tmp_path):
    path = tmp_path / "coach.toml"
    path.write_text(COACH.replace('"34000 kg"', '"36 t"') + TABLE, encoding="utf-8")
    with pytest.raises(InputError, match=r"body.mass: found 36000 kg; expected 34000 kg, that"):
        load_vehicle(path)


CSV = """x [m];bending_stiffness [GN m^2];mass_per_length [t/m]
-12;3;1,5
0;3,2;1,3
12;3;1,5
"""
BY_FILE = """
[body.profile]
file = "tables/coach.csv"
[[body.profile.point_masses]]
mass = "400 kg"
position = "6 m"
"""


def coach_by_file(tmp_path, text):
    """A parameter file whose profile is in a file of its own."""
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "coach.csv").write_text(text, encoding="utf-8")
    (tmp_path / "coach.toml").write_text(COACH.replace(OWN, "") + BY_FILE, encoding="utf-8")
    return tmp_path / "coach.toml"


def test_a_profile_may_stand_in_a_file_of_its_own(tmp_path):
    found = load_vehicle(coach_by_file(tmp_path, CSV)).body.profile
    assert found == BodyProfile(
        (-12, 0, 12), (3e9, 3.2e9, 3e9), (1500, 1300, 1500), point_masses=(PointMass(400, 6.0),)
    )


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("x [m]", "x", "column 'x': found no unit; expected one such as [m]"),
        ("[GN m^2]", "[GN/m]", "found the unit 'GN/m'; expected one such as [N m^2]"),
        ("[t/m]", "[tt/m]", "column 'mass_per_length [tt/m]': found 'tt' is no unit that is known"),
        ("mass_per_length", "mass", "header: found no column mass_per_length; expected one headed"),
        ("mass_per_length", "mass", "column 'mass [t/m]': found a name that is not known"),
        (
            "0;3,2",
            "0;-3,2",
            "row 3, column 'bending_stiffness [GN m^2]': found '-3,2'; expected a p",
        ),
        (
            "0;3,2",
            "0;none",
            "row 3, column 'bending_stiffness [GN m^2]': found 'none'; expected a p",
        ),
        ("0;3,2", "13;3,2", "body.profile.x[3]: found 12 m after 13 m; expected ascending"),
    ],
)
def test_faults_of_a_file_of_columns_are_named_by_row_and_column(tmp_path, old, new, message):
    path = coach_by_file(tmp_path, CSV.replace(old, new))
    with pytest.raises(InputError) as caught:
        load_vehicle(path)
    assert message in str(caught.value)


def test_a_profile_s_file_that_is_missing_or_doubled_is_named(tmp_path):
    path = coach_by_file(tmp_path, CSV)
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("coach.csv", "cooch.csv"), encoding="utf-8")
    with pytest.raises(InputError, match=r"cooch.csv: file: found no such file"):
        load_vehicle(path)
    path.write_text(text.replace('coach.csv"', 'coach.csv"\nx = ["0 m"]'), encoding="utf-8")
    with pytest.raises(
        InputError, match=r"body.profile.file: found a file and x with it; expected"
    ):
        load_vehicle(path)
