"""Vehicles: the shipped ones, what a record and a parameter file refuse, and writing one.

The shipped values are compared with the figures of their sources, copied here in SI.
"""

import os
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railride.errors import InputError
from railride.files import data_path, write_text
from railride.parameters import (
    Bogie,
    CarBody,
    Vehicle,
    load_vehicle,
    shipped_vehicles,
    to_toml,
    write_vehicle,
)

# name: m_c, I_c, L, bogie spacing, m_b, I_b, wheelbase, wheelset mass, k_1, c_1, k_2, c_2, bending
SOURCES = {
    "cati2024": (
        *(34000, 1.7e6, 24, 17.5, 3000, 2000, 2.5, None),
        *(5e6, 30e3, 750e3, 70e3, 9.6),
    ),
    "manchester": (
        *(32000, 1.97e6, 25, 19, 2615, 1476, 2.56, 1813),
        *(2.4e6, 8e3, 860e3, 40e3, None),
    ),
    "ice3": (
        *(47800, 1957888, 24.775, 17.375, 3500, 1715, 2.5, 1800),
        *(2.4e6, 20e3, 700e3, 40e3, None),
    ),
    "shinkansen_s300": (
        *(41750, 2.08e6, 25, 17.5, 3040, 3930, 2.5, 1780),
        *(1180e3, 39.2e3, 530e3, 90.2e3, None),
    ),
}

COACH = data_path("vehicles", "cati2024.toml").read_text(encoding="utf-8")

BODY = CarBody(mass=34e3, pitch_inertia=1.7e6, length=24.0)
BOGIE = Bogie(
    position=8.75,
    mass=3e3,
    pitch_inertia=2e3,
    wheelsets=(1.25, -1.25),
    primary_stiffness=5e6,
    primary_damping=30e3,
    secondary_stiffness=750e3,
    secondary_damping=70e3,
)


def refusal(tmp_path, text):
    """What loading a file with this text says."""
    path = tmp_path / "coach.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        load_vehicle(path)
    message = str(caught.value)
    assert all(line.startswith(f"{path}: ") for line in message.splitlines())
    return message.replace(f"{path}: ", "")


# The shipped vehicles


@pytest.mark.parametrize("name", SOURCES)
def test_shipped_vehicle_has_its_source_s_values(name):
    vehicle = load_vehicle(name)
    body, front, rear = vehicle.body, *vehicle.bogies
    values = (
        *(body.mass, body.pitch_inertia, body.length, front.position - rear.position),
        *(front.mass, front.pitch_inertia, front.wheelsets[0] - front.wheelsets[1]),
        *(front.wheelset_mass, front.primary_stiffness, front.primary_damping),
        *(front.secondary_stiffness, front.secondary_damping, body.bending_frequency),
    )
    for value, expected in zip(values, SOURCES[name], strict=True):
        assert value == (expected and pytest.approx(expected, rel=1e-14))
    assert rear == replace(front, position=-front.position)
    assert vehicle.name == name
    assert vehicle.source
    assert body.joint_stiffness is None
    assert body.mass_centre == body.bending_damping == 0.0


def test_all_shipped_vehicles_are_tested():
    assert shipped_vehicles() == tuple(sorted(SOURCES))


def test_the_coach_s_wrong_print_is_remarked_on():
    damping, joints = load_vehicle("cati2024").remarks
    assert "30,000 kN s/m" in damping
    assert "3.7e5 kN m/rad" in joints


def test_wheelsets_stand_where_the_bogies_put_them():
    # Table 1 of the paper: semi-spacings 8.75 m and 1.25 m.
    assert load_vehicle("cati2024").wheelset_positions == (10.0, 7.5, -7.5, -10.0)


# What the records refuse


@pytest.mark.parametrize("value", [0, -1.0, float("nan"), float("inf"), "34 t", None, True])
@pytest.mark.parametrize("key", ["mass", "pitch_inertia", "length"])
def test_a_body_refuses_impossible_numbers(key, value):
    with pytest.raises(InputError, match=f"car body: {key}: found .*; expected a positive number"):
        replace(BODY, **{key: value})


@pytest.mark.parametrize("value", [-1.0, float("nan"), float("inf"), "5 kN/m", False])
@pytest.mark.parametrize(
    "key",
    [
        *("mass", "pitch_inertia", "primary_stiffness", "primary_damping"),
        *("secondary_stiffness", "secondary_damping", "wheelset_mass"),
    ],
)
def test_a_bogie_refuses_impossible_numbers(key, value):
    with pytest.raises(InputError, match=f"bogie: {key}: found"):
        replace(BOGIE, **{key: value})


@pytest.mark.parametrize("value", [np.array(5.73e8), np.float64(5.73e8), np.int64(573_000_000)])
def test_numbers_of_numpy_are_numbers(value):
    """``VehicleModel.values`` gives arrays without an axis."""
    body = replace(load_vehicle("cati2024").body, bending_frequency=None, joint_stiffness=value)
    assert type(body.joint_stiffness) is float
    assert body.joint_stiffness == float(value)


def test_dampings_may_be_zero_and_stiffnesses_not():
    assert replace(BOGIE, primary_damping=0, secondary_damping=0).primary_damping == 0.0
    for key in ("primary_stiffness", "secondary_stiffness"):
        with pytest.raises(InputError, match=key):
            replace(BOGIE, **{key: 0.0})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"mass_centre": 12.0}, "mass_centre: found 12 m; expected a place within the body"),
        ({"mass_centre": float("nan")}, "mass_centre: found nan; expected a finite number"),
        ({"bending_frequency": 9.6, "joint_stiffness": 3.7e8}, "together; expected one of"),
        ({"bending_frequency": 9.6, "bending_stiffness": 4e9}, "together; expected one of"),
        ({"joint_stiffness": 3.7e8, "bending_stiffness": 4e9}, "together; expected one of"),
        ({"joint_damping": 1e5, "bending_damping": 0.01}, "joint_damping and bending_damping"),
        ({"bending_frequency": 0.0}, "bending_frequency: found 0.0; expected a positive number Hz"),
        ({"joint_damping": -1.0}, "joint_damping: found -1.0; expected a number of at least 0"),
        ({"bending_damping": 1.0}, "bending_damping: found 1; expected a damping ratio"),
        ({"bending_damping": -0.1}, "bending_damping: found -0.1"),
        ({"inertia": "grade"}, "inertia: found 'grade'.*did you mean graded?"),
        ({"inertia": 3}, "inertia: found 3; expected one of auto, rods, graded, segments"),
    ],
)
def test_a_body_refuses_what_contradicts_itself(changes, message):
    with pytest.raises(InputError, match=message):
        replace(BODY, **changes)


@pytest.mark.parametrize(
    ("wheelsets", "expected"),
    [
        ((), "at least one wheelset"),
        ((-1.25, 1.25), "from the front"),
        ((1.25, 1.25), "each at its own place"),
        ((1.25, float("nan")), "a finite number"),
        (("1.25 m", "-1.25 m"), "a finite number"),
        ("1.25", "a sequence of numbers"),
        (1.25, "a sequence of numbers"),
    ],
)
def test_a_bogie_refuses_wheelsets_that_are_none(wheelsets, expected):
    with pytest.raises(InputError, match=rf"wheelsets(\[2\])?: found .*; expected .*{expected}"):
        replace(BOGIE, wheelsets=wheelsets)


def test_a_bogie_may_have_any_number_of_wheelsets():
    assert replace(BOGIE, wheelsets=[0]).wheelsets == (0.0,)
    assert replace(BOGIE, wheelsets=(1.7, 0.0, -1.7)).wheelsets == (1.7, 0.0, -1.7)


@pytest.mark.parametrize(
    ("positions", "message"),
    [
        ([], "bogies: found none; expected at least two bogies"),
        ([0.0], "bogies: found one; expected at least two bogies"),
        ([-8.75, 8.75], r"bogies\[2\].position: found 8.75 m, which is not behind bogies\[1\]"),
        ([8.75, 8.75], r"bogies\[2\].position: found 8.75 m, which is not behind"),
        ([12.5, -8.75], r"bogies\[1\].position: found 12.5 m; expected a place under the body"),
        ([8.75, -12.01], r"bogies\[2\].position: found -12.01 m"),
        ([8.75, 6.25], r"bogies\[2\].wheelsets: found the first wheelset at 7.5 m; expected one"),
    ],
)
def test_a_vehicle_refuses_bogies_that_do_not_fit(positions, message):
    bogies = tuple(replace(BOGIE, position=x) for x in positions)
    with pytest.raises(InputError, match=message):
        Vehicle("coach", BODY, bogies)


def test_a_vehicle_may_have_three_bogies_up_to_the_ends_of_its_body():
    bogies = [replace(BOGIE, position=x) for x in (12.0, 0.0, -12.0)]
    assert len(Vehicle("articulated", BODY, bogies).wheelset_positions) == 6


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"name": ""}, "name"),
        ({"name": "two\nlines"}, "name"),
        ({"name": 3}, "name"),
        ({"source": None}, "source"),
        ({"remarks": "one text"}, "remarks"),
        ({"remarks": (1,)}, r"remarks\[1\]"),
        ({"body": BOGIE}, "body"),
        ({"bogies": (BODY, BOGIE)}, r"bogies\[1\]"),
        ({"bogies": BOGIE}, "bogies"),
    ],
)
def test_a_vehicle_refuses_parts_that_are_none(changes, where):
    with pytest.raises(InputError, match=f": {where}: found"):
        replace(load_vehicle("cati2024"), **changes)


def test_all_faults_of_a_record_are_reported_together():
    with pytest.raises(InputError) as caught:
        CarBody(mass=-1.0, pitch_inertia=0.0, length=24.0, mass_centre=13.0, inertia="none")
    lines = str(caught.value).splitlines()
    assert [line.split(": ")[1] for line in lines] == [
        *("mass", "pitch_inertia", "mass_centre", "inertia")
    ]


# What a file refuses


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('mass = "34000 kg"', "", 'body.mass: found nothing; expected mass = "number kg"'),
        ('mass = "34000 kg"', "mass = 34000", "without a unit; expected a mass"),
        ('mass = "34000 kg"', 'mass = "34000"', 'write the unit, as in "34000 kg"'),
        ('mass = "34000 kg"', 'mass = "34000 N/m"', "body.mass: found '34000 N/m' (a stiffness)"),
        ('mass = "34000 kg"', 'mass = "0 kg"', "body.mass: found '0 kg'; expected a positive"),
        ('mass = "34000 kg"', 'mass = "-34 t"', "body.mass: found '-34 t'; expected a positive"),
        ('mass = "34000 kg"', 'mass = "nan kg"', "body.mass: found 'nan kg'; expected a mass"),
        ('mass = "34000 kg"', "mass = nan", "body.mass: found 'nan'; expected a mass"),
        ('mass = "34000 kg"', "mass = inf", "body.mass: found 'inf'; expected a mass"),
        ('mass = "34000 kg"', 'mass = "inf kg"', "body.mass: found 'inf kg'; expected a mass"),
        ('mass = "34000 kg"', "mass = true", "body.mass: found True, not a text; expected a mass"),
        ('mass = "34000 kg"', 'mass = ["34 t"]', "body.mass: found ['34 t'], not a text"),
        ('mass = "34000 kg"', 'mas = "34000 kg"', "body.mas: found a key that is not known"),
        ('mass = "34000 kg"', 'mas = "34000 kg"', "did you mean mass"),
        ("[body]", "[boddy]", "boddy: found a key that is not known"),
        ("[body]", "[boddy]", "body.mass: found nothing"),
        ("[bogie] ", "[bogey] ", "bogie.mass: found nothing"),
        ("schema = 1", "schema = 2", "schema: found 2; expected 1"),
        ("schema = 1", 'schema = "1"', "schema: found '1'; expected a whole number"),
        ("schema = 1", "wheels = 8", "wheels: found a key that is not known"),
        ('name = "cati2024"', "name = 3", "name: found 3; expected a text"),
        ('name = "cati2024"', 'name = ""', "name: found ''; expected one line of text"),
        ("remarks = [", "remarks = [1,", "remarks: found [1, "),
        ('"1.25 m", "-1.25 m"', '"-1.25 m", "1.25 m"', "bogie.wheelsets: found -1.25 m, 1.25 m"),
        ('["1.25 m", "-1.25 m"]', "[]", "bogie.wheelsets: found none; expected at least one"),
        ('["1.25 m", "-1.25 m"]', '"1.25 m"', "bogie.wheelsets: found '1.25 m'; expected a list"),
        ('"1.25 m", "-1.25 m"', '"1.25 m", -1.25', "bogie.wheelsets[2]: found '-1.25' without"),
        (
            '"5000 kN/m"',
            '"5000 kN s/m"',
            "bogie.primary_stiffness: found '5000 kN s/m' (a damping)",
        ),
        ('"30 kN s/m"', '"-30 kN s/m"', "expected a number of at least 0"),
        ('"8.75 m"', '"13 m"', "bogies[1].position: found 13 m; expected a place under the body"),
        ('"8.75 m"', '"-9 m"', "bogies[2].position: found -8.75 m, which is not behind"),
        ('position = "8.75 m"', "", "bogies[1].position: found nothing"),
        (
            'position = "8.75 m"',
            'position = "8.75 m"\nmass = "0 kg"',
            "bogies[1].mass: found '0 kg'",
        ),
        ("[[bogies]]\nposition", "[bogies]\nposition", "TOML syntax error"),
        ('pitch_inertia = "not', 'pitch_inertai = "not', "body.notes.pitch_inertai: found a key"),
        ('pitch_inertia = "not a slender', 'pitch_inertia = 3 # "', "body.notes.pitch_inertia"),
        ("[body]\n", '[body]\njoint_stiffness = "3.7e5 kN m/rad"\n', "joint_stiffness together"),
        ("[body]\n", '[body]\nbending_damping = "1.5 kg"\n', "expected a plain number"),
        ("[body]\n", "[body]\nbending_damping = true\n", "body.bending_damping: found True"),
        ("[body]\n", "[body]\nbending_damping = inf\n", "body.bending_damping: found 'inf'"),
        ("[body]\n", "[body]\nbending_damping = 1.2\n", "body.bending_damping: found 1.2"),
        ("[body]\n", '[body]\ninertia = "rod"\n', "did you mean rods?"),
        ("[body]\n", "[body]\ninertia = 1\n", "body.inertia: found 1; expected a text"),
        ('mass = "34000 kg"', 'mass = "34000 kg', "TOML syntax error"),
        ('mass = "34000 kg"', "mass = 34000 kg", "(at line 13, column"),
        ('mass = "34000 kg"', 'mass = "1 kg"\nmass = "2 kg"', "TOML syntax error"),
        ('mass = "34000 kg"', f"mass = {'9' * 6000}", "nests too deep or is too long"),
        ('mass = "34000 kg"', f"mass = {'[' * 100_000}", "nests too deep or is too long"),
    ],
)
def test_a_file_is_refused_with_the_key_that_is_wrong(tmp_path, old, new, message):
    assert COACH.count(old) >= 1
    assert message in refusal(tmp_path, COACH.replace(old, new, 1))


def test_all_faults_of_a_file_are_reported_together(tmp_path):
    text = COACH.replace('mass = "34000 kg"', 'mas = "34 t"').replace('"24 m"', '"-24 m"')
    text = text.replace('"70 kN s/m"', '"70 kN/m"').replace('"-8.75 m"', '"nan m"')
    where = [line.split(": ")[0] for line in refusal(tmp_path, text).splitlines()]
    assert sorted(where) == sorted(
        ["body.mas", "body.mass", "body.length", "bogie.secondary_damping", "bogies[2].position"]
    )


def test_a_fault_in_what_bogies_share_is_reported_once(tmp_path):
    message = refusal(tmp_path, COACH.replace('mass = "3000 kg"', ""))
    assert message.splitlines() == [
        'bogie.mass: found nothing; expected mass = "number kg" (the key is missing)'
    ]


def test_no_body_and_no_bogies_at_all(tmp_path):
    message = refusal(tmp_path, 'name = "coach"')
    assert "[body]: found no such table" in message
    assert "bogies: found none" in message


def test_no_bogies(tmp_path):
    message = refusal(tmp_path, COACH[: COACH.index("[[bogies]]")])
    assert "bogies: found none; expected at least two bogies" in message


def test_enormous_values_are_refused(tmp_path):
    """Whose products are no numbers any more."""
    message = refusal(tmp_path, COACH.replace('"24 m"', '"1e300 m"').replace("3000 kg", "1e-99 kg"))
    for where in ("body.length: found '1e300 m'", "bogie.mass: found '1e-99 kg'"):
        assert f"{where}; expected a number of a size from 1e-40 to 1e+40" in message


def test_a_very_long_key_is_told_by_its_beginning(tmp_path):
    message = refusal(tmp_path, COACH.replace("pitch_inertia", "9" * 20_000, 1))
    assert f"body.{'9' * 60}…: found a key that is not known" in message
    assert len(message) < 3000


@pytest.mark.parametrize("table", ["body = 3", "bogie = []", 'bogies = "two"', "bogies = [1, 2]"])
def test_a_table_that_is_none(tmp_path, table):
    assert f"{table.split()[0]}" in refusal(tmp_path, f'name = "x"\n{table}\n')


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "an empty file"),
        (b" \n\n", "an empty file"),
        (COACH.encode("utf-16"), "another encoding"),
        (COACH.encode("iso-8859-9"), "another encoding (byte 0xc7 in line 5)"),
        (b"# " + b"x" * 1_000_001, "more than 1,000,000 bytes"),
        (b"\x00\x01\x02", "a TOML syntax error"),
    ],
)
def test_a_file_that_holds_no_toml(tmp_path, content, message):
    path = tmp_path / "coach.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=re.escape(f"{path}: file: found {message}")):
        load_vehicle(path)


def test_a_byte_order_mark_is_no_fault(tmp_path):
    path = tmp_path / "coach.toml"
    path.write_bytes(b"\xef\xbb\xbf" + COACH.encode())
    assert load_vehicle(str(path)) == load_vehicle("cati2024")


def test_a_folder_instead_of_a_file(tmp_path):
    with pytest.raises(InputError, match="found a folder; expected a TOML file"):
        load_vehicle(tmp_path)


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may read anything")
def test_a_file_that_may_not_be_read(tmp_path):
    path = tmp_path / "coach.toml"
    path.write_text(COACH, encoding="utf-8")
    path.chmod(0)
    with pytest.raises(InputError, match="Permission denied; expected a file that can be read"):
        load_vehicle(path)


@pytest.mark.parametrize("name", ["cati", "cati204.toml", "no/such/cati2024.toml", "cati 2024"])
def test_a_vehicle_that_is_none_names_the_near_one(name):
    with pytest.raises(InputError) as caught:
        load_vehicle(name)
    assert "one of cati2024, ice3, manchester, shinkansen_s300" in str(caught.value)


@pytest.mark.parametrize("name", ["", "x" * 10_000, "nul\0", "no such", "zzz/"])
def test_a_name_that_no_file_can_have(name):
    with pytest.raises(InputError, match="neither a shipped vehicle nor a file") as caught:
        load_vehicle(name)
    assert len(str(caught.value)) < 500


def test_a_name_close_to_a_shipped_one_is_proposed():
    with pytest.raises(InputError, match=r"did you mean manchester\?"):
        load_vehicle("manchster")


# What a file may hold


def test_a_bogie_overrides_what_it_shares(tmp_path):
    path = tmp_path / "coach.toml"
    path.write_text(COACH + 'secondary_damping = "35 kN s/m"\n', encoding="utf-8")
    front, rear = load_vehicle(path).bogies
    assert (front.secondary_damping, rear.secondary_damping) == (70e3, 35e3)


def test_a_file_need_not_name_itself_nor_share_anything(tmp_path):
    bogie = COACH[COACH.index("[bogie]") : COACH.index("[bogie.notes]")]
    text = "[body]\n" + COACH[COACH.index("mass =") : COACH.index("[body.notes]")]
    for position in ("8.75 m", "-8.75 m"):
        text += bogie.replace("[bogie] ", "[[bogies]] ") + f'position = "{position}"\n'
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    assert load_vehicle(path) == replace(
        load_vehicle("cati2024"), name="mine", source="", remarks=()
    )


@pytest.mark.parametrize(("value", "expected"), [("0.015", 0.015), ('"1.5 %"', 0.015), ("0", 0.0)])
def test_a_damping_ratio_is_a_number_or_per_cent(tmp_path, value, expected):
    path = tmp_path / "coach.toml"
    path.write_text(
        COACH.replace("[body]\n", f"[body]\nbending_damping = {value}\n"), encoding="utf-8"
    )
    assert load_vehicle(path).body.bending_damping == pytest.approx(expected, rel=1e-15)


# Writing

positive = st.floats(1e-6, 1e12)
text = st.text(st.characters(exclude_categories=["Cs"]), max_size=20)


@st.composite
def vehicles(draw):
    length = draw(st.floats(5.0, 40.0))
    stiffness = draw(
        st.sampled_from(["bending_frequency", "joint_stiffness", "bending_stiffness", "mass"])
    )
    damping = draw(st.sampled_from(["joint_damping", "bending_damping"]))
    body = CarBody(
        **{"mass": draw(positive), stiffness: draw(positive)},
        pitch_inertia=draw(positive),
        length=length,
        mass_centre=draw(st.floats(-0.4, 0.4)) * length,
        **{damping: draw(st.floats(0.0, 0.9))},
        inertia=draw(st.sampled_from(["auto", "rods", "graded", "segments"])),
    )
    common = {
        **{key: draw(positive) for key in ("mass", "pitch_inertia", "primary_stiffness")},
        "secondary_stiffness": draw(positive),
        "primary_damping": draw(st.floats(0.0, 1e9)),
        "secondary_damping": draw(st.floats(0.0, 1e9)),
    }
    bogies = tuple(
        Bogie(
            position=x * length,
            wheelsets=draw(st.sampled_from([(0.0,), (0.1, -0.1), (0.2, 0.1, -0.15)])),
            **(common | {"mass": draw(positive)} if draw(st.booleans()) else common),
            wheelset_mass=draw(st.none() | positive),
        )
        for x in draw(st.sampled_from([(0.4, -0.4), (0.5, 0.1, -0.3)]))
    )
    name = draw(text.filter(lambda t: t.strip() and t.isprintable()))
    return Vehicle(name, body, bogies, draw(text), tuple(draw(st.lists(text, max_size=3))))


@given(vehicles())
def test_what_is_written_reads_back_equal(tmp_path_factory, vehicle):
    path = tmp_path_factory.mktemp("written") / "vehicle.toml"
    write_vehicle(vehicle, path)
    assert load_vehicle(path) == vehicle


def test_a_text_with_control_characters_reads_back_equal(tmp_path):
    # TOML forbids them raw, U+007F included, which JSON does not.
    vehicle = replace(load_vehicle("ice3"), source='tab\t, line\n, quote ", \\ and \x7f \x00 ζ')
    write_vehicle(vehicle, tmp_path / "copy.toml")
    assert load_vehicle(tmp_path / "copy.toml") == vehicle


@pytest.mark.parametrize("name", SOURCES)
def test_a_shipped_vehicle_reads_back_equal(tmp_path, name):
    write_vehicle(load_vehicle(name), tmp_path / "copy.toml")
    assert load_vehicle(tmp_path / "copy.toml") == load_vehicle(name)
    assert "[[bogies]]\nposition" in to_toml(load_vehicle(name))


def test_writing_replaces_a_file_as_a_whole(tmp_path):
    path = tmp_path / "vehicle.toml"
    path.write_text("old", encoding="utf-8")
    path.chmod(0o640)
    write_text(path, "new, ζ\n")
    assert path.read_bytes() == "new, ζ\n".encode()
    assert path.stat().st_mode & 0o777 == 0o640
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("place", ["", "none/vehicle.toml", "file/vehicle.toml", "nul\0"])
def test_a_place_where_nothing_can_be_written_stays_as_it_was(tmp_path, place):
    (tmp_path / "file").write_text("kept", encoding="utf-8")
    with pytest.raises(InputError, match=r"output file: found .*; expected a file that can be"):
        write_vehicle(load_vehicle("ice3"), tmp_path / place)
    assert list(tmp_path.iterdir()) == [tmp_path / "file"]


def test_a_text_that_cannot_be_encoded_leaves_nothing_behind(tmp_path):
    with pytest.raises(InputError):
        write_text(tmp_path / "vehicle.toml", "x" * 10_000 + "\ud800")
    assert not list(tmp_path.iterdir())


def test_data_that_are_not_there_are_the_installation_s_fault():
    with pytest.raises(FileNotFoundError, match=r"data/none\.txt is missing"):
        data_path("none.txt")
