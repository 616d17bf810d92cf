"""Dampers on elastic mounts, payload, wheel loads: what the running gear and the load add."""

from dataclasses import replace

import numpy as np
import pytest

from railride import KMH, InputError, derive_vehicle, load_vehicle, modes, ride, spectrum
from railride import stochastic_ride as stochastic
from railride.parameters import Load, to_toml
from railride.vehicle import VehicleModel

ERRI = spectrum("erri_low")


def mounted(primary, secondary, name="cati2024"):
    """A vehicle whose dampers have elastic mounts of these stiffnesses, N/m."""
    vehicle = load_vehicle(name)
    bogies = tuple(
        replace(b, primary_damper_stiffness=primary, secondary_damper_stiffness=secondary)
        for b in vehicle.bogies
    )
    return replace(vehicle, bogies=bogies)


def exact(model: VehicleModel, floor="polygon") -> float:
    return float(stochastic(model, 145 * KMH, ERRI, floor=floor).a_wrms[0])


def test_elastic_mounts_lift_the_comfort_value():
    """2 MN/m per axle and 12 MN/m per bogie: 0.2475 becomes about 0.42 m/s² with two segments."""
    assert exact(derive_vehicle(mounted(2e6, 12e6), 2)) == pytest.approx(0.42, abs=0.005)


def test_a_stiff_mount_is_none():
    rigid = exact(derive_vehicle(load_vehicle("cati2024"), 2))
    assert exact(derive_vehicle(mounted(1e11, 1e11), 2)) == pytest.approx(rigid, rel=1e-4)


def test_a_soft_mount_leaves_no_damper():
    """Far below ωc the loss of Maxwell's element is k_d²/(ωc): heave's damping goes with k_d²."""
    heave = [
        next(mode for mode in modes(derive_vehicle(mounted(k, k), 1)) if mode.label == "heave")
        for k in (1e4, 1e3)
    ]
    assert heave[0].damping_ratio / heave[1].damping_ratio == pytest.approx(100, rel=0.2)
    assert heave[1].damping_ratio < 1e-3


def test_response_equals_the_complex_stiffness_of_maxwells_element():
    """Springs and dampers k + iωc k_d/(k_d + iωc) put into the vehicle without mounts."""
    model = derive_vehicle(mounted(2e6, 12e6), 3)
    plain = derive_vehicle(load_vehicle("cati2024"), 3)
    m, p = model.matrices(), plain.matrices()
    omega = 2 * np.pi * 7.3
    n = p.M.shape[0]
    q = np.linalg.solve(m.K - omega**2 * m.M + 1j * omega * m.C, m.K_w + 1j * omega * m.C_w)[:n]
    element = {c: 1j * omega * c * k / (k + 1j * omega * c) for c, k in ((30e3, 2e6), (70e3, 12e6))}
    off = {"c_1": 0.0, "c_2": 0.0}
    one, other = plain.matrices(c_2=0.0), plain.matrices(c_1=0.0)
    C = element[30e3] / 30e3 * one.C + element[70e3] / 70e3 * other.C
    C_w = element[30e3] / 30e3 * one.C_w + element[70e3] / 70e3 * other.C_w
    assert np.abs(plain.matrices(**off).C).max() == 0
    peer = np.linalg.solve(p.K - omega**2 * p.M + C, p.K_w + C_w)
    np.testing.assert_allclose(q, peer, rtol=1e-9, atol=1e-12)


def test_modes_of_mounted_dampers_are_named():
    labels = [mode.label for mode in modes(derive_vehicle(mounted(2e6, 12e6), 2))]
    assert labels.count("bogie pitch") == 2
    assert labels.count("bogie heave") == 2
    assert labels.count("damper") == 6
    assert sorted(label for label in labels if "b" not in label) == ["damper"] * 6 + [
        "heave",
        "pitch",
    ]


def test_a_time_run_with_mounts_tends_to_the_exact_value():
    model = derive_vehicle(mounted(2e6, 12e6), 2)
    cases = [ride(model, speeds=[200 * KMH], seed=seed).cases[0] for seed in range(12)]
    mean_square = np.mean([case.a_wrms**2 for case in cases])
    error = 2 * cases[0].a_wrms_exact * cases[0].standard_error / np.sqrt(12)
    assert abs(mean_square - cases[0].a_wrms_exact ** 2) < 3 * error


@pytest.mark.parametrize("segments", [1, 2, 3, 4, 7])
@pytest.mark.parametrize(
    "loads",
    [(Load(8e3),), (Load(8e3, 10.0, -3.0),), (Load(500.0, 5.0, 5.0), Load(900.0, -2.0, -9.0))],
)
def test_payload_adds_its_mass_and_moments(segments, loads):
    vehicle = load_vehicle("cati2024")
    loaded, tare = (
        derive_vehicle(replace(vehicle, payload=p), segments) for p in (loads, ())
    )  # fmt: skip
    n = 2 if segments == 1 else segments + 1
    added = loaded.matrices().M[:n, :n] - tare.matrices().M[:n, :n]
    lift = loaded.lift[:n]
    pitch = np.array([0.0, 1.0]) if segments == 1 else np.linspace(12, -12, n)
    ends = [(12.0, -12.0) if load.front is None else (load.front, load.rear) for load in loads]
    mass = sum(load.mass for load in loads)
    first = sum(load.mass * (a + b) / 2 for load, (a, b) in zip(loads, ends, strict=True))
    second = sum(
        load.mass * (a**2 + a * b + b**2) / 3 for load, (a, b) in zip(loads, ends, strict=True)
    )
    found = [lift @ added @ lift, lift @ added @ pitch, pitch @ added @ pitch]
    np.testing.assert_allclose(found, [mass, first, second], rtol=1e-10, atol=1e-6)


def test_payload_lowers_the_modes_but_not_the_free_bodys_bending():
    vehicle = replace(load_vehicle("cati2024"), payload=(Load(8000.0),))
    model = derive_vehicle(vehicle, 4)
    assert model.bending_frequencies()[0] == pytest.approx(9.6, rel=1e-9)
    bending = next(mode for mode in modes(model) if mode.label == "bending 1")
    assert bending.frequency_hz == pytest.approx(9.6 * np.sqrt(34 / 42), rel=0.01)


def test_mounts_and_payload_read_back_from_their_file(tmp_path):
    vehicle = replace(mounted(2e6, 12e6, "ice3"), payload=(Load(8000.0), Load(500.0, 5.0, 4.0)))
    path = tmp_path / "loaded.toml"
    path.write_text(to_toml(vehicle), encoding="utf-8")
    assert load_vehicle(path) == vehicle


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ('[[payload]]\nfront = "2 m"\n', ["payload[1].mass", "missing"]),
        ('[[payload]]\nmass = "500 kg"\nfront = "2 m"\n', ["payload[1].rear", "both ends"]),
        ('[[payload]]\nmass = "5 kg"\nfront = "2 m"\nrear = "3 m"\n', ["payload[1].rear", "ahead"]),
        ('[[payload]]\nmass = "5 kg"\nfront = "20 m"\nrear = "3 m"\n', ["payload[1].front"]),
        ('[[payload]]\nmass = "-5 kg"\n', ["payload[1].mass", "-5"]),
        ('[[payload]]\nmas = "5 kg"\n', ["payload[1].mas", "mass"]),
    ],
)  # fmt: skip
def test_bad_payload_is_told(tmp_path, written, words):
    path = tmp_path / "coach.toml"
    path.write_text(to_toml(load_vehicle("cati2024")) + written, encoding="utf-8")
    with pytest.raises(InputError) as raised:
        load_vehicle(path)
    for word in words:
        assert word in str(raised.value)


def test_a_mount_without_a_damper_is_refused():
    bogie = replace(load_vehicle("cati2024").bogies[0], primary_damping=0.0)
    with pytest.raises(InputError, match=r"primary_damper_stiffness.*no damping"):
        replace(bogie, primary_damper_stiffness=2e6)
    with pytest.raises(InputError, match="damper of 0 on an elastic mount"):
        modes(derive_vehicle(mounted(2e6, 12e6), 2), c_1=0.0)


def test_wheel_load_is_the_force_that_moves_everything_on_it():
    """Wheel loads of both wheelsets carry the mass of wheelsets, bogie and body under slow lift."""
    model = derive_vehicle(load_vehicle("manchester"))
    m = model.matrices()
    Y = model.output_rows([model.outputs[f"wheel_load_{j}"] for j in range(1, 5)])
    s, ones = 2j * np.pi * 0.01, np.ones(4)
    q = np.linalg.solve(m.K + s**2 * m.M + s * m.C, (m.K_w + s * m.C_w) @ ones)
    load = Y["d"] @ q + s * (Y["v"] @ q) + (Y["w"] + s * Y["dw"] + s**2 * Y["ddw"]) @ ones
    mass = 32000 + 2 * 2615 + 4 * 1813
    assert load.sum() / s**2 == pytest.approx(mass, rel=1e-3)


def test_wheel_loads_are_for_the_frequency_domain():
    from railride import state_space

    with pytest.raises(InputError, match="second rate"):
        state_space(derive_vehicle(load_vehicle("manchester")), ["wheel_load_1"])
    with pytest.raises(InputError, match="wheel_load_1"):
        state_space(derive_vehicle(load_vehicle("cati2024")), ["wheel_load_1"])
