"""Quantities: what is read, to which SI value, and what is refused with which message.

Expected values are conversions by hand from the SI brochure's definitions.
"""

import ast
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import railride
from railride.errors import InputError
from railride.units import (
    STANDARD_GRAVITY,
    QuantityError,
    parse_number_or_quantity,
    parse_quantity,
    same_dimension,
    to_si,
    to_unit,
)

finite = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("34000 kg", "kg", 34_000.0),
        ("34 t", "kg", 34_000.0),
        ("250 g", "kg", 0.25),
        ("5000 kN/m", "N/m", 5e6),
        ("5 MN/m", "kN/m", 5e6),
        ("5kN/m", "N/m", 5e3),
        ("5 kN / m", "N/m", 5e3),
        ("3.7e5 kN*m/rad", "N m/rad", 3.7e8),
        ("3.7e5 kN·m", "N m/rad", 3.7e8),
        ("3.7e5 kN m/rad", "N*m/rad", 3.7e8),
        ("1.7e6 kg m^2", "kg m^2", 1.7e6),
        ("1.7e6 kg⋅m²", "kg*m**2", 1.7e6),
        ("1.7e6 kg m2", "kg m²", 1.7e6),
        ("30 kN·s/m", "N s/m", 30e3),
        ("30 kN/(m/s)", "N s/m", 30e3),
        ("30 N s m⁻¹", "N s/m", 30.0),
        ("4 GN m^2", "N m^2", 4e9),
        ("9.6 Hz", "Hz", 9.6),
        ("9.6 1/s", "Hz", 9.6),
        ("9.6 s^-1", "Hz", 9.6),
        ("1.2 kHz", "Hz", 1200.0),
        ("36 km/h", "m/s", 10.0),
        ("-1.25 m", "m", -1.25),
        ("−1.25 m", "m", -1.25),
        ("+.5 mm", "m", 0.5e-3),
        ("5. cm", "m", 0.05),
        ("7 µm", "m", 7e-6),
        ("7 μm", "m", 7e-6),
        ("180 deg", "rad", math.pi),
        ("180°", "rad", math.pi),
        ("2 mrad", "rad", 2e-3),
        ("2 min", "s", 120.0),
        ("1 h", "s", 3600.0),
        ("2 ms", "s", 2e-3),
        ("1 g_n", "m/s^2", 9.80665),
        ("1.5 %", "", 0.015),
        ("0.015", "", 0.015),
        (" 12\u00a0kPa ", "Pa", 12e3),
    ],
)
def test_reads_a_number_and_a_unit_as_si(text, unit, expected):
    assert parse_quantity(text, unit) == pytest.approx(expected, rel=1e-15)


def test_the_standard_acceleration_of_free_fall_is_written_once():
    """9.80665 m/s², 3rd General Conference on Weights and Measures (1901); as the unit g_n."""
    assert parse_quantity("1 g_n", "m/s^2") == STANDARD_GRAVITY == 9.80665
    near = (9.80665, 9.807, 9.81)
    written = [path.name for path in sorted(Path(railride.__file__).parent.rglob("*.py"))
               for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
               if isinstance(node, ast.Constant) and node.value in near]  # fmt: skip
    assert written == ["units.py"]


@pytest.mark.parametrize(
    ("text", "unit", "found", "expected"),
    [
        ("34000 N/m", "kg", "a stiffness", "a mass"),
        ("5 kg", "N/m", "a mass", "a stiffness"),
        ("30 kN/m", "N s/m", "a stiffness", "a damping"),
        ("5 kN/m", "N m/rad", "a stiffness", "a torsional stiffness"),
        ("5 N m/rad", "N m^2", "a torsional stiffness", "a bending stiffness"),
        # A radian may be left away but not added: 60 rad/s are not 60 Hz, nor the other way round.
        ("60 rad/s", "Hz", "an angular speed", "a frequency"),
        ("9.6 Hz", "rad/s", "a frequency", "an angular speed"),
        ("5 kg", "", "a mass", "a plain number"),
        ("3 deg", "", "an angle", "a plain number"),
        ("5 m^7", "m", "another kind", "a length"),
        ("34000", "kg", "without a unit", "a mass"),
        ("1.5 %", "kg", "a plain number", "a mass"),
        ("", "kg", "an empty text", "a mass"),
        ("  ", "kg", "an empty text", "a mass"),
        ("kg", "kg", "'kg'", "a mass"),
        ("heavy", "kg", "'heavy'", "a mass"),
        ("nan kg", "kg", "'nan kg'", "a mass"),
        ("inf kg", "kg", "'inf kg'", "a mass"),
        ("-inf", "", "'-inf'", "a plain number"),
        ("1e999 kg", "kg", "not finite", "a mass"),
        ("1e308 t", "kg", "not finite", "a mass"),
        ("5 furlong", "m", "'furlong' is no unit that is known", "a length"),
        ("8.75 nan", "m", "'nan' is no unit that is known", "a length"),
        ("5 m/", "m", "is no unit", "a length"),
        ("5 (m", "m", "is no unit", "a length"),
        ("5 m)*(s", "m", "is no unit", "a length"),
        ("5 m^0.5", "m", "is no unit", "a length"),
        ("0x10 kg", "kg", "is no unit", "a mass"),
        (34000.0, "kg", "not a text", "a mass"),
        (None, "kg", "not a text", "a mass"),
        (True, "", "not a text", "a plain number"),
    ],
)
def test_refuses_what_is_no_such_quantity(text, unit, found, expected):
    with pytest.raises(QuantityError) as caught:
        parse_quantity(text, unit)
    assert found in caught.value.found
    assert caught.value.expected.startswith(expected)
    assert str(caught.value).startswith(f"found {caught.value.found}; expected ")


@pytest.mark.parametrize(
    ("text", "mend"),
    [
        ("5 KN/m", "did you mean kN?"),
        ("5 kn/m", "did you mean kN?"),
        ("5,000 kN/m", "without separators"),
        ("5 000 kN/m", "without separators"),
        ("5_000 kN/m", "without separators"),
        ("5000", '"5000 N/m"'),
    ],
)
def test_says_how_to_mend_it(text, mend):
    with pytest.raises(QuantityError) as caught:
        parse_quantity(text, "N/m")
    assert mend in caught.value.mend


@pytest.mark.parametrize(
    "text",
    [
        "1**9**9",
        "1 m**9**9**9",
        "1 (m**9)**9",
        "1 " + "m**9*" * 20 + "m",
        "1 __import__('os').getcwd()",
        "1 m.__class__",
        "1 lambda",
        "1 m;s",
        "1 " + "(" * 60,
        "1" * 10_000 + " kg",
        "1 " + "k" * 10_000,
        "1e" + "9" * 70,
        "\x00 kg",
        "1 \U0001f600",
    ],
)
def test_a_hostile_text_is_refused_with_a_short_message(text):
    with pytest.raises(QuantityError) as caught:
        parse_quantity(text, "kg")
    assert len(str(caught.value)) < 500


def test_a_long_text_is_not_even_looked_at():
    with pytest.raises(QuantityError, match="found 10003 characters"):
        parse_quantity("1" * 10_000 + " kg", "kg")


@given(st.text())
def test_any_text_is_a_finite_number_or_refused(text):
    for parse in (parse_quantity, parse_number_or_quantity):
        try:
            value = parse(text, "N/m")
        except InputError as error:
            value, message = 0.0, str(error)
        else:
            message = "expected a stiffness"
        assert math.isfinite(value)
        assert "expected a stiffness" in message


@given(finite, st.sampled_from(["kg", "N m s/rad", "kg m^2", "Hz", "m", "N/m", ""]))
def test_a_number_written_in_si_reads_back_exactly(number, unit):
    assert parse_quantity(f"{number!r} {unit}", unit) == number


@given(
    st.floats(-1e100, 1e100),
    st.sampled_from(["km/h", "mm", "t", "kN/m", "kN m/rad", "deg", "%", "kN s/m"]),
)
def test_there_and_back_again(number, unit):
    assert to_unit(to_si(number, unit), unit) == pytest.approx(number, rel=1e-15, abs=1e-300)


def test_a_plain_number_takes_the_unit_asked_for():
    assert parse_number_or_quantity("36", "km/h") == pytest.approx(10.0, rel=1e-15)
    assert parse_number_or_quantity("3.7e8", "N m/rad") == 3.7e8
    assert parse_number_or_quantity("3.7e5 kN*m/rad", "N m/rad") == 3.7e8
    assert parse_number_or_quantity("1.5 %", "") == pytest.approx(0.015, rel=1e-15)


@pytest.mark.parametrize("text", ["nan", "inf", "", "fast", "10 kg", "1e999"])
def test_a_plain_number_is_finite_too(text):
    with pytest.raises(QuantityError, match="expected a speed"):
        parse_number_or_quantity(text, "km/h")


def test_columns_are_converted_as_a_whole():
    level = np.array([1.0, -2.5])
    assert to_si(level, "mm") == pytest.approx(np.array([1e-3, -2.5e-3]), rel=1e-15)
    assert to_unit(np.array([5e6, 0.0]), "kN/m") == pytest.approx(np.array([5e3, 0.0]), rel=1e-15)


def test_dimensions_are_compared_without_values():
    assert same_dimension("mm", "m")
    assert same_dimension("kN m", "N m/rad")
    assert not same_dimension("N m/rad", "N m")
    assert not same_dimension("m/s", "m/s^2")
    with pytest.raises(QuantityError, match="no unit that is known"):
        same_dimension("furlong", "m")
