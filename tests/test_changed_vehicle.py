"""Changed parameters written back into a vehicle: derived again it has the changed matrices."""

from dataclasses import replace

import numpy as np
import pytest
from vehicles import paper_coach, random_vehicle

from railride import InputError, derive_vehicle, load_vehicle, vehicle_with, write_vehicle
from railride.parameters import BodyProfile, CarBody, Equipment, Load, Segment

UNIFORM = BodyProfile((-12.0, 12.0), (3.1e9, 3.1e9), (1400.0, 1400.0))


def coach(**body):
    """The paper's coach with other fields of its car body."""
    vehicle = load_vehicle("cati2024")
    return replace(vehicle, body=replace(vehicle.body, **body))


def bare(**body):
    """The same with nothing said of its bending but what is given."""
    return coach(**{"bending_frequency": None} | body)


def carrying():
    """A vehicle with payload, equipment, wheelset masses and elastic mounts of its dampers."""
    vehicle = load_vehicle("cati2024")
    bogies = tuple(
        replace(bogie, wheelset_mass=1500.0, primary_damper_stiffness=4e6,
                secondary_damper_stiffness=6e6 + 1e6 * b)
        for b, bogie in enumerate(vehicle.bogies)
    )  # fmt: skip
    equipment = (Equipment(1500.0, 1.0, frequency=8.8, damping_ratio=0.12),
                 Equipment(900.0, -4.0, stiffness=2e6, damping=3e3))  # fmt: skip
    loads = (Load(4000.0), Load(1000.0, front=5.0, rear=-1.0))
    return replace(vehicle, bogies=bogies, payload=loads, equipment=equipment)


def in_pieces():
    """A car body of its own segments, one of them not a rod, one with its mass off the middle."""
    rows = (Segment(8.0, 11e3), Segment(9.0, 13e3, 9e4, 0.2), Segment(7.0, 10e3))
    vehicle = load_vehicle("cati2024")
    body = CarBody.of(rows, joint_stiffness=(4e8, 5e8), joint_damping=(1e5, 2e5))
    return replace(vehicle, body=body)


MODELS = {
    "rods": lambda: paper_coach(4),
    "rigid": lambda: paper_coach(1),
    "graded": lambda: derive_vehicle(random_vehicle(3), 4),
    "unequal bogies": lambda: derive_vehicle(random_vehicle(5), 1),
    "own inertia": lambda: derive_vehicle(coach(inertia="segments"), 2),
    "joint stiffness": lambda: derive_vehicle("cati2024", 4, joint_stiffness=3.7e8),
    "EI": lambda: derive_vehicle(bare(bending_stiffness=3.1e9, rayleigh_stiffness=1e-4), 4),
    "several frequencies": lambda: derive_vehicle(
        bare(bending_frequencies=(9.6, 26.0), bending_damping=0.01), 4
    ),
    "carrying": lambda: derive_vehicle(carrying(), 2),
    "pieces": lambda: derive_vehicle(in_pieces()),
    "beam": lambda: derive_vehicle("cati2024", body="beam", modes=2, bending_damping=0.01),
    "beam of EI": lambda: derive_vehicle(
        bare(bending_stiffness=3.1e9, rayleigh_mass=0.3, rayleigh_stiffness=1e-4),
        body="beam", modes=2,
    ),
    "beam that shears": lambda: derive_vehicle(
        bare(bending_stiffness=3.1e9, shear_stiffness=6e8, rotary_inertia=900.0,
             mode_damping=(0.01, 0.02, 0.03)), body="beam", modes=2,
    ),
    "beam that carries": lambda: derive_vehicle(carrying(), body="beam", modes=2),
    "finite elements": lambda: derive_vehicle("cati2024", body="fe", modes=2),
}  # fmt: skip

REFUSED = {  # which no parameter file holds
    "pieces": {"ell_1", "ell_2", "ell_3"},
    "finite elements": {"r_c", "f_c1", "f_c2"},
}


def again(model, vehicle):
    """The vehicle with the same kind of body."""
    if model.body.mode_count is not None:
        return derive_vehicle(vehicle, body=model.body.kind, modes=model.body.mode_count)
    return derive_vehicle(vehicle, model.body.segments)


def assert_same(model, changes):
    vehicle = vehicle_with(model, **changes)
    expected, found = model.matrices(**changes), again(model, vehicle).matrices()
    for name in ("M", "C", "K", "K_w", "C_w", "B_f"):
        A = getattr(expected, name)
        scale = max(np.abs(A).max(), 1e-300)
        np.testing.assert_allclose(getattr(found, name), A, atol=1e-9 * scale, rtol=0, err_msg=name)
    return vehicle


@pytest.mark.parametrize("kind", MODELS)
def test_every_independent_parameter_is_written_back(kind):
    model = MODELS[kind]()
    for p in model.parameters:
        name, value = p.symbol.name, p.value * 1.003 if p.value else 0.01
        if name in REFUSED.get(kind, ()):
            with pytest.raises(InputError):
                vehicle_with(model, **{name: value})
        else:
            vehicle = assert_same(model, {name: value})
            assert vehicle != model.vehicle, name


@pytest.mark.parametrize("kind", ["rods", "graded", "several frequencies", "carrying", "pieces"])
def test_all_together_and_after_earlier_changes(kind):
    model = MODELS[kind]()
    movable = [p for p in model.parameters if p.symbol.name not in REFUSED.get(kind, ())]
    values = {p.symbol.name: p.value * 1.002 for p in movable if p.value}
    first = dict(list(values.items())[::2])
    assert vehicle_with(model.changed(**first), **values) == assert_same(model, values)
    assert vehicle_with(model.changed(**first)) == assert_same(model, first)


@pytest.mark.parametrize(
    ("kind", "changes", "fields"),
    [
        ("rods", {"k_theta": 3e8, "c_theta": 1e5},
         {"joint_stiffness": 3e8, "joint_damping": 1e5, "bending_frequency": None}),
        ("EI", {"k_theta": 3e8}, {"joint_stiffness": 3e8, "bending_stiffness": None}),
        ("several frequencies", {"k_theta_2": 5e8}, {"bending_frequencies": None}),
        ("beam", {"zeta_c2": 0.05}, {"mode_damping": (0.01, 0.05), "bending_damping": 0.0}),
        ("rods", {"m_c": 20e3}, {"inertia": "rods", "mass": 20e3}),
        ("carrying", {"k_e1": 5e6, "c_e1": 4e3}, {}),
    ],
)  # fmt: skip
def test_what_follows_from_others_can_be_given_for_itself(kind, changes, fields):
    vehicle = assert_same(MODELS[kind](), changes)
    for name, value in fields.items():
        assert getattr(vehicle.body, name) == value


def test_an_unchanged_model_gives_its_own_vehicle():
    for kind in ("rods", "pieces", "beam that shears"):
        model = MODELS[kind]()
        assert vehicle_with(model) == model.vehicle
        assert vehicle_with(model, k_2=model.vehicle.bogies[0].secondary_stiffness) == model.vehicle


def test_a_parameter_file_of_it_reads_back(tmp_path):
    vehicle = vehicle_with(paper_coach(2), k_2=612_345.678, c_1=23_456.789, f_bending=8.7)
    write_vehicle(vehicle, tmp_path / "soft.toml")
    assert load_vehicle(tmp_path / "soft.toml") == vehicle


@pytest.mark.parametrize(
    ("model", "changes", "words"),
    [
        (lambda: paper_coach(2), {"k_2": [1e5, 2e5]}, ["k_2", "one number"]),
        (lambda: paper_coach(2), {"k2": 1e5}, ["did you mean k_2"]),
        (lambda: paper_coach(2), {"c_2": -1.0}, ["secondary_damping", "-1.0"]),
        (lambda: paper_coach(4), {"l_b": 3.0}, ["bogie 1", "another segment"]),
        (MODELS["finite elements"], {"f_c1": 9.0, "f_c2": 20.0}, ["f_c1", "f_c2", "finite"]),
        (lambda: derive_vehicle(bare(profile=UNIFORM, **dict.fromkeys(("mass",), 33600.0),
                                     pitch_inertia=UNIFORM.pitch_inertia), 2),
         {"m_1": 17e3}, ["m_1 (mass of segment 1)", "profile"]),
        (lambda: derive_vehicle(in_pieces(), 1), {"m_c": 36e3}, ["m_c", "segments"]),
        (lambda: derive_vehicle(coach(inertia="graded"), 2), {"mu_2": 0.1}, ["mu_2", "follows"]),
        (MODELS["beam"], {"f_c2": 20.0}, ["f_c2", "follows from others"]),
    ],
)  # fmt: skip
def test_what_no_parameter_file_holds_is_refused(model, changes, words):
    with pytest.raises(InputError) as raised:
        vehicle_with(model(), **changes)
    for word in words:
        assert word in str(raised.value)
