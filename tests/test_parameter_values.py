"""Names and values of a model's parameters, and doubts about a vehicle's."""

from dataclasses import replace

import numpy as np
import pytest

from railride import InputError, derive_vehicle, load_vehicle, modes
from railride.plausibility import doubts


def coach(segments=2):
    return derive_vehicle("cati2024", segments)


@pytest.mark.parametrize(
    ("key", "symbol"),
    [
        ("secondary_stiffness", "k_2"),
        ("primary_damping", "c_1"),
        ("bending_frequency", "f_bending"),
        ("joint_stiffness", "k_theta"),
    ],
)
def test_keys_of_parameter_files_name_their_symbols(key, symbol):
    model, value = coach(), float(coach().values()[symbol]) * 1.1
    by_key, by_symbol = model.matrices(**{key: value}), model.matrices(**{symbol: value})
    np.testing.assert_array_equal(by_key.K, by_symbol.K)
    np.testing.assert_array_equal(by_key.C, by_symbol.C)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"k2": 1.0}, ["'k2'", "did you mean k_2", "secondary stiffness per bogie"]),
        ({"mass": 1.0}, ["'mass'", "m_c (car-body mass)"]),
        ({"secondary_stifness": 1.0}, ["did you mean secondary_stiffness"]),
        ({"k_2": "600 kN/m"}, ["'600 kN/m'", "numbers in SI units"]),
        ({"k_2": [1e5, 2e5], "c_2": [1e4, 2e4, 3e4]}, ["k_2 (2,)", "c_2 (3,)"]),
        ({"k_theta": -1e8}, ["k_theta", "above 0"]),
    ],
)
def test_what_is_no_value_of_a_parameter_is_told(changes, words):
    with pytest.raises(InputError) as raised:
        coach().matrices(**changes)
    for word in words:
        assert word in str(raised.value)


@pytest.mark.parametrize(
    "changes",
    [{"k_1": 10.0**n} for n in (18, 22, 25, 30)] + [{"m_b": 10.0**n} for n in (-10, -12, -14)],
)
def test_what_rounding_would_decide_is_refused(changes):
    with pytest.raises(InputError, match=r"differ by|no spring|condition"):
        modes(coach(4).changed(**changes))


@pytest.mark.parametrize(
    ("part", "changes", "word"),
    [
        ("bogie", {"secondary_damping": 70.0}, "damping ratio"),
        ("bogie", {"secondary_stiffness": 750.0}, "natural frequency"),
        ("bogie", {"primary_damping": 30e6}, "damping ratio"),
        ("bogie", {"wheelsets": (1.25e-3, -1.25e-3)}, "0.0025 m apart"),
        ("body", {"mass": 34.0}, "natural frequency"),
        ("body", {"pitch_inertia": 1.7e9}, "pitch inertia"),
    ],
)
def test_slips_of_the_unit_are_doubted(part, changes, word):
    vehicle = load_vehicle("cati2024")
    if part == "body":
        vehicle = replace(vehicle, body=replace(vehicle.body, **changes))
    else:
        bogies = tuple(replace(bogie, **changes) for bogie in vehicle.bogies)
        vehicle = replace(vehicle, bogies=bogies)
    assert any(word in doubt for doubt in doubts(vehicle))
    assert set(doubts(vehicle)) <= set(derive_vehicle(vehicle, 1).remarks)


@pytest.mark.parametrize("name", ["cati2024", "manchester", "ice3", "shinkansen_s300"])
def test_nothing_is_doubted_of_the_shipped_vehicles(name):
    assert doubts(load_vehicle(name)) == ()


def test_an_inertia_that_is_not_used_is_told():
    assert any("is not used" in remark for remark in coach(4).remarks)
    assert not any("is not used" in remark for remark in coach(1).remarks)
    vehicle = load_vehicle("cati2024")
    graded = replace(vehicle, body=replace(vehicle.body, inertia="graded"))
    assert not any("is not used" in remark for remark in derive_vehicle(graded, 4).remarks)
