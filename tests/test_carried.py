"""Equipment on elastic mounts: closed forms of the tuned absorber, limits, files, names."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from vehicles import assemble

from railride.errors import InputError
from railride.modal import modes, undamped_frequencies
from railride.parameters import Equipment, Load, load_vehicle, to_toml
from railride.spectra import spectrum
from railride.stochastic import stochastic_ride
from railride.vehicle import derive_vehicle

HUNG = Equipment(1500.0, 1.7, frequency=8.8, damping_ratio=0.12)
BODIES = {"rigid": {"segments": 1}, "segments": {"segments": 4}, "beam": {"body": "beam"}}
every_body = pytest.mark.parametrize("kind", BODIES)


def coach(*equipment, **changes):
    return replace(load_vehicle("cati2024"), equipment=equipment, **changes)


def matrices(vehicle, kind, **changes):
    return derive_vehicle(vehicle, **BODIES[kind]).matrices(**changes)


# Closed forms


@cache
def one_mode(ratio):
    """A beam of one mode on springs that hardly hold it, with equipment at its middle."""
    bogies = tuple(replace(b, secondary_stiffness=1.0, secondary_damping=0.0)
                   for b in load_vehicle("cati2024").bogies)  # fmt: skip
    one = Equipment(600.0, 0.0, frequency=9.0, damping_ratio=ratio)
    return derive_vehicle(coach(one, bogies=bogies), body="beam", modes=1)


@pytest.mark.parametrize("ratio", [0.05, 0.15, 0.4])
def test_den_hartogs_absorber(ratio):
    """Tuned to f_1/(1 + μ), both fixed points of the receptance are √(1 + 2/μ) high.

    Den Hartog, Section 3.3: whatever its damping, the curve passes through P and Q, where with
    x = (ω/ω_1)² and g = f_e/f_1: x² - 2x (1 + g² + μ g²)/(2 + μ) + 2g²/(2 + μ) = 0. A bending mode
    alone answers a force at the middle as a mass of m_c/φ² would: μ = m_e φ²/m_c.
    """
    model = one_mode(ratio)
    phi = float(model.output_rows([model.floor(0.0, derivative=0)])["d"][0, 2])
    mu = 600.0 * phi**2 / 34e3
    g = 1 / (1 + mu)
    A = model.matrices(f_e1=9.6 * g)
    M, C, K = (a[2:4, 2:4] for a in (A.M, A.C, A.K))  # of the mode and the equipment alone
    x = np.roots([1.0, -2 * (1 + g**2 * (1 + mu)) / (2 + mu), 2 * g**2 / (2 + mu)])
    static = 1 / (34e3 * (2 * np.pi * 9.6) ** 2)
    for omega in 2 * np.pi * 9.6 * np.sqrt(x):
        moved = np.linalg.solve(K + 1j * omega * C - omega**2 * M, [1.0, 0.0])[0]
        assert abs(moved) / static == pytest.approx(np.sqrt(1 + 2 / mu), rel=1e-6)


def test_two_masses_on_a_spring():
    """A rigid body on hardly any springs and equipment at its middle: √(k (1/m_c + 1/m_e))."""
    vehicle = coach(Equipment(4000.0, 0.0, stiffness=5e6))
    found = undamped_frequencies(matrices(vehicle, "rigid", k_2=1.0))
    expected = np.sqrt(5e6 * (1 / 34e3 + 1 / 4000.0)) / (2 * np.pi)
    assert np.abs(found / expected - 1).min() < 1e-6


@every_body
def test_rigid_mounts_make_it_a_payload_in_one_point(kind):
    hung = coach(Equipment(2500.0, 3.3, stiffness=1e15))
    loaded = replace(coach(), payload=(Load(2500.0, 3.3, 3.3),))
    expected = undamped_frequencies(matrices(loaded, kind))
    found = undamped_frequencies(matrices(hung, kind))[: len(expected)]
    assert_allclose(found, expected, rtol=1e-5)


@every_body
def test_soft_mounts_leave_the_body_alone(kind):
    hung = coach(Equipment(2500.0, 3.3, frequency=0.01))
    expected = np.sort([0.01, *undamped_frequencies(matrices(coach(), kind))])
    assert_allclose(undamped_frequencies(matrices(hung, kind)), expected, rtol=1e-4)


@pytest.mark.parametrize("segments", [1, 4])
def test_matrices_equal_those_assembled_by_hand(segments):
    """Rows of the mounts' extension: the body's height there, less the equipment's."""
    plain = derive_vehicle(coach(), segments)
    model = derive_vehicle(coach(HUNG, Equipment(800.0, -6.5, stiffness=2e6, damping=3e3)),
                           segments)  # fmt: skip
    values = model.values()
    own, by_hand = len(plain.body.energies.coordinates), assemble(plain.vehicle, segments)
    n = len(model.lagrangian.coordinates)
    others = [i for i in range(n) if i not in (own, own + 1)]
    M, C, K = np.zeros((3, n, n))
    for matrix, name in ((M, "M"), (C, "C"), (K, "K")):
        matrix[np.ix_(others, others)] = getattr(plain.matrices(), name)
    for e, x in ((1, 1.7), (2, -6.5)):
        row = np.zeros(n)
        row[others] = by_hand.height(x)
        row[own + e - 1] = -1.0
        M[own + e - 1, own + e - 1] = values[f"m_e{e}"]
        K += values[f"k_e{e}"] * np.outer(row, row)
        C += values[f"c_e{e}"] * np.outer(row, row)
    for name, expected in (("M", M), ("C", C), ("K", K)):
        assert_allclose(getattr(model.matrices(), name), expected, rtol=1e-10, atol=1e-4)
    assert values["k_e1"] == pytest.approx(1500 * (2 * np.pi * 8.8) ** 2)
    assert values["c_e1"] == pytest.approx(2 * 0.12 * 1500 * 2 * np.pi * 8.8)


# Parameters and names


def test_its_frequency_stays_whatever_its_mass_is():
    model = derive_vehicle(coach(HUNG), 4)
    values = model.values(m_e1=np.array([500.0, 3000.0]))
    assert_allclose(np.sqrt(values["k_e1"] / values["m_e1"]) / (2 * np.pi), 8.8)
    assert_allclose(values["c_e1"] / (2 * np.sqrt(values["k_e1"] * values["m_e1"])), 0.12)


@every_body
def test_moved_equipment_equals_a_vehicle_derived_with_it(kind):
    here = derive_vehicle(coach(HUNG), **BODIES[kind]).matrices(x_e1=2.9)
    there = matrices(coach(replace(HUNG, position=2.9)), kind)
    for name in ("M", "C", "K"):
        expected = getattr(there, name)
        assert_allclose(getattr(here, name), expected, atol=1e-11 * np.abs(expected).max())


def test_equipment_moved_off_its_segment_or_the_body_is_refused():
    with pytest.raises(InputError, match=r"equipment 1: found it on another segment"):
        derive_vehicle(coach(HUNG), 4).matrices(x_e1=-1.0)
    with pytest.raises(InputError, match=r"equipment 1: found a position of up to 13 m"):
        derive_vehicle(coach(HUNG), body="beam").matrices(x_e1=13.0)


@every_body
def test_its_modes_and_outputs_have_its_name(kind):
    model = derive_vehicle(coach(HUNG, replace(HUNG, position=-7.0, frequency=15.0)),
                           **BODIES[kind])  # fmt: skip
    labels = [mode.label for mode in modes(model)]
    assert labels.count("equipment 1") == labels.count("equipment 2") == 1
    assert {"equipment_2_acceleration", "equipment_1_deflection"} <= set(model.outputs)
    rows = model.output_rows([model.outputs["equipment_1_deflection"]])["d"]
    names = [q.name for q in model.lagrangian.coordinates]
    height = model.output_rows([model.floor(1.7, "polygon", 0)])["d"]
    assert rows[0, names.index("z_e1")] == -1.0
    body = [k for k, name in enumerate(names) if name != "z_e1"]
    assert_allclose(rows[0, body], height[0, body], atol=1e-12)


def test_it_goes_with_dampers_on_elastic_mounts():
    bogies = tuple(replace(b, secondary_damper_stiffness=8e6) for b in coach().bogies)
    model = derive_vehicle(coach(HUNG, bogies=bogies), 2)
    names = [q.name for q in model.lagrangian.coordinates]
    assert names[3:] == ["z_e1", "z_b1", "theta_b1", "z_b2", "theta_b2", "d_s1", "d_s2"]
    assert "equipment 1" in [mode.label for mode in modes(model)]


# Its use


def test_a_tuned_absorber_lowers_the_bending_at_the_middle():
    """Two tonnes at the middle, tuned as Den Hartog says: less than half of the bending is left."""
    phi = 1.2156
    mu = 2000 * phi**2 / 34e3
    one = Equipment(2000.0, 0.0, frequency=9.6 / (1 + mu),
                    damping_ratio=np.sqrt(3 * mu / (8 * (1 + mu))))  # fmt: skip
    plain, tuned = (
        stochastic_ride(derive_vehicle(vehicle, body="beam"), 145 / 3.6, spectrum("erri_low"))
        for vehicle in (coach(), coach(one))
    )
    assert tuned.a_wrms[0] < 0.6 * plain.a_wrms[0]


# Records and files


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "stiffness: found nothing; expected the stiffness of the mounts, or the frequency"),
        ({"stiffness": 1e6, "frequency": 8.0}, "stiffness: found frequency with it"),
        ({"frequency": 8.0, "damping": 1e3, "damping_ratio": 0.1}, "damping_ratio: found damping"),
        ({"frequency": -8.0}, "frequency: found -8.0; expected a positive number Hz"),
        ({"frequency": 8.0, "mass": 0.0}, "mass: found 0.0"),
        ({"frequency": 8.0, "damping": -1.0}, "damping: found -1.0"),
    ],
)
def test_equipment_that_cannot_be_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        Equipment(**{"mass": 1000.0, "position": 0.0} | given)


def test_equipment_off_the_body_is_refused():
    with pytest.raises(InputError, match=r"equipment\[1\].position: found 12.5 m; .* at most 12 m"):
        coach(replace(HUNG, position=12.5))
    with pytest.raises(InputError, match=r"equipment\[1\]: found 'compressor'; expected of type"):
        coach("compressor")


FILE = """

[[equipment]]
mass = "1.5 t"
position = "1.7 m"
frequency = "8.8 Hz"
damping_ratio = "12 %"

[[equipment]]
mass = "800 kg"
position = "-6.5 m"
stiffness = "2 MN/m"
damping = "3 kN s/m"
"""


def test_equipment_from_a_file_and_back(tmp_path):
    path = tmp_path / "coach.toml"
    path.write_text(to_toml(coach()) + FILE, encoding="utf-8")
    found = load_vehicle(path)
    assert found.equipment == (HUNG, Equipment(800.0, -6.5, stiffness=2e6, damping=3e3))
    path.write_text(to_toml(found), encoding="utf-8")
    assert load_vehicle(path) == found


def test_all_faults_of_a_file_come_together(tmp_path):
    path = tmp_path / "coach.toml"
    bad = FILE.replace('frequency = "8.8 Hz"', 'frequenzy = "8.8 Hz"').replace("-6.5 m", "-65 m")
    path.write_text(to_toml(coach()) + bad, encoding="utf-8")
    with pytest.raises(InputError) as said:
        load_vehicle(path)
    assert "equipment[1].frequenzy: found a key that is not known" in str(said.value)
    assert "equipment[1].stiffness: found nothing" in str(said.value)
    assert "equipment[2].position: found -65 m" in str(said.value)


def test_its_derivation_is_written_in_every_form(run, tmp_path):
    path = tmp_path / "coach.toml"
    path.write_text(to_toml(coach(HUNG)), encoding="utf-8")
    for form in ("table", "markdown", "json"):
        code, out, _ = run("derive", "--vehicle", path, "--segments", "2", "--format", form)
        assert code == 0
        assert "mass of equipment 1" in out or form == "json"
    code, out, _ = run("modes", "--vehicle", path, "--body", "beam")
    assert code == 0
    assert "equipment 1" in out
