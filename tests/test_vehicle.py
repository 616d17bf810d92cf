"""The vehicle against matrices assembled by hand, published frequencies and general laws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from vehicles import assemble, mirrored, paper_coach, random_model, random_vehicle

from railride.errors import InputError
from railride.modal import undamped_frequencies
from railride.parameters import CarBody, load_vehicle
from railride.vehicle import Matrices, VehicleModel, derive_vehicle

SEEDS = range(4)
MATRICES = ("M", "C", "K", "K_w", "C_w", "B_f")


@pytest.mark.parametrize(
    ("segments", "printed"),
    [
        (1, "1.0191 1.2608 9.5313 9.5335 14.0674 14.0674"),
        (2, "1.0155 1.2868 9.4601 9.5338 9.7069 14.0674 14.0674"),
        (4, "1.0158 1.2868 9.4639 9.5338 9.6998 14.0674 14.0674 25.5051 41.9263"),
    ],
)
def test_natural_frequencies_of_the_papers_coach(segments, printed):
    """Undamped, k_θ for a free-free 9.6 Hz, rods; confirmed by a nonlinear multibody program."""
    found = undamped_frequencies(paper_coach(segments).matrices())
    assert [f"{f:.4f}" for f in found] == printed.split()


def test_natural_frequencies_of_the_manchester_vehicle():
    """6 DOF, computed for Iwnicki's benchmark vehicle: VSD 30 (1998) 295-313."""
    found = undamped_frequencies(derive_vehicle(load_vehicle("manchester")).matrices())
    assert [f"{f:.4f}" for f in found] == "1.0725 1.2973 7.4187 7.4255 11.6174 11.6174".split()


@pytest.mark.parametrize("segments", [1, 2, 4, 8])
def test_degrees_of_freedom(segments):
    found = len(paper_coach(segments).linear.coordinates)
    assert found == (6 if segments == 1 else segments + 5)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("segments", [1, 2, 3, 6])
def test_matrices_equal_those_assembled_by_hand(seed, segments):
    vehicle = random_vehicle(seed, graded=seed % 2 == 0)
    model = derive_vehicle(vehicle, segments)
    values = model.values()
    joint = {n: float(values.get(n, 0.0)) for n in ("k_theta", "c_theta")}
    by_hand = assemble(vehicle, segments, **joint)
    found = model.matrices()
    for name in MATRICES:
        expected = getattr(by_hand, name)
        np.testing.assert_allclose(getattr(found, name), expected, rtol=1e-9,
                                   atol=1e-9 * np.abs(expected).max(), err_msg=name)  # fmt: skip
    outputs = [model.floor(x, "polygon", derivative=0) for x in (-7.3, 0.0, 5.1)]
    rows = model.output_rows(outputs)["d"]
    expected = [by_hand.height(x) for x in (-7.3, 0.0, 5.1)]
    np.testing.assert_allclose(rows, expected, atol=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("segments", [1, 4])
class TestRandomVehicles:
    """Laws that every vehicle obeys."""

    def matrices(self, seed, segments):
        return random_model(seed, segments).matrices()

    def test_matrices_are_symmetric_and_mass_is_positive_definite(self, seed, segments):
        m = self.matrices(seed, segments)
        for A in (m.M, m.C, m.K):
            np.testing.assert_allclose(A, A.T, atol=1e-12 * np.abs(A).max())
        assert np.linalg.eigvalsh(m.M).min() > 0
        for A in (m.C, m.K):
            assert np.linalg.eigvalsh(A).min() > -1e-10 * np.abs(A).max()

    def test_energy_decays(self, seed, segments):
        m = self.matrices(seed, segments)
        n = len(m.M)
        A = np.block([[np.zeros((n, n)), np.eye(n)],
                      [-np.linalg.solve(m.M, m.K), -np.linalg.solve(m.M, m.C)]])  # fmt: skip
        assert np.linalg.eigvals(A).real.max() < 0

    def test_a_uniform_lift_strains_nothing(self, seed, segments):
        m = self.matrices(seed, segments)
        for A, A_w in ((m.K, m.K_w), (m.C, m.C_w)):
            left = A @ m.lift - A_w.sum(axis=1)
            assert np.abs(left).max() < 1e-10 * np.abs(A).max()

    def test_a_straight_slope_strains_nothing(self, seed, segments):
        """Track, bogies and body turned by one small angle about the middle: K q = K_w w."""
        model = random_model(seed, segments)
        vehicle, m = model.vehicle, model.matrices()
        body = vehicle.body
        own = ([body.mass_centre, 1.0] if segments == 1
               else np.linspace(0.5, -0.5, segments + 1) * body.length)  # fmt: skip
        q = np.array([*own, *(v for b in vehicle.bogies for v in (b.position, 1.0))])
        w = np.array(vehicle.wheelset_positions)
        for A, A_w in ((m.K, m.K_w), (m.C, m.C_w)):
            left = A @ q - A_w @ w
            assert np.abs(left).max() < 1e-10 * np.abs(A).max() * np.abs(q).max()

    def test_actuators_push_body_and_bogie_apart_without_a_net_force(self, seed, segments):
        m = self.matrices(seed, segments)
        np.testing.assert_allclose(m.lift @ m.B_f, 0, atol=1e-12)

    def test_the_mirrored_vehicle_has_the_same_frequencies(self, seed, segments):
        other = derive_vehicle(mirrored(random_vehicle(seed)), segments).matrices()
        for with_damping in (False, True):
            ours, theirs = (
                scipy.linalg.eigvals(
                    np.block([[np.zeros_like(a.M), np.eye(len(a.M))],
                              [-np.linalg.solve(a.M, a.K),
                               -with_damping * np.linalg.solve(a.M, a.C)]])
                )
                for a in (self.matrices(seed, segments), other)
            )  # fmt: skip
            np.testing.assert_allclose(np.sort(np.abs(ours)), np.sort(np.abs(theirs)), rtol=1e-6)

    def test_receptances_are_reciprocal(self, seed, segments):
        """A force at a moves b as much as the same force at b moves a."""
        model = random_model(seed, segments)
        m = model.matrices()
        points = [model.floor(x, "polygon", derivative=0) for x in (-8.0, 1.0, 6.5)]
        rows = model.output_rows(points)["d"]
        for omega in (3.0, 20.0, 61.0):
            H = rows @ np.linalg.solve(m.K + 1j * omega * m.C - omega**2 * m.M, rows.T)
            np.testing.assert_allclose(H, H.T, rtol=1e-8)


def test_a_heavy_body_leaves_the_bogies_alone():
    """m_c → ∞: a bogie rides between track and ground, √((2 k_1 + k_2)/m_b); it pitches on k_1."""
    m = paper_coach(1).matrices(m_c=1e14, I_c=1e16)
    found = undamped_frequencies(m)
    heave = np.sqrt((2 * 5e6 + 750e3) / 3000) / (2 * np.pi)
    pitch = np.sqrt(2 * 5e6 * 1.25**2 / 2000) / (2 * np.pi)
    np.testing.assert_allclose(found[2:], [heave, heave, pitch, pitch], rtol=1e-6)


def test_a_stiff_primary_suspension_puts_the_body_on_its_secondary_springs():
    found = undamped_frequencies(paper_coach(1).matrices(k_1=1e13))[:2]
    heave = np.sqrt(2 * 750e3 / 34e3) / (2 * np.pi)
    pitch = np.sqrt(2 * 750e3 * 8.75**2 / 1.7e6) / (2 * np.pi)
    np.testing.assert_allclose(found, [heave, pitch], rtol=1e-6)


def test_stiff_joints_make_the_body_rigid():
    """Rods of equal mass, m_c L²/12: the rigid body with that inertia."""
    body = {"I_c": 34e3 * 24**2 / 12}
    rigid = undamped_frequencies(paper_coach(1).matrices(**body))
    stiff = undamped_frequencies(paper_coach(3).matrices(k_theta=1e13))[:6]
    np.testing.assert_allclose(stiff, rigid, rtol=1e-5)


# Numbers


@pytest.mark.parametrize("segments", [1, 2, 4])
def test_arrays_of_parameters_equal_one_by_one(segments):
    model = paper_coach(segments)
    k_2, m_b = np.array([[5e5], [9e5]]), np.array([2e3, 3e3, 4e3])
    many = model.matrices(k_2=k_2, m_b=m_b)
    assert many.M.shape[:-2] == (2, 3)
    for i, j in np.ndindex(2, 3):
        one = model.matrices(k_2=k_2[i, 0], m_b=m_b[j])
        for name in MATRICES:
            np.testing.assert_array_equal(getattr(many, name)[i, j], getattr(one, name))


def test_arrays_of_what_the_joints_are_calibrated_from():
    model = paper_coach(4, bending_damping=0.01)
    changes = {"m_c": np.array([30e3, 40e3]), "f_bending": np.array([8.0, 11.0])}
    many = model.matrices(**changes)
    for i in range(2):
        one = model.matrices(**{name: value[i] for name, value in changes.items()})
        for name in ("M", "C", "K"):
            np.testing.assert_allclose(getattr(many, name)[i], getattr(one, name), rtol=1e-12)


@pytest.mark.parametrize("changes", [{"m_c": 50e3}, {"L": 22.0}, {"k_1": 1e6},
                                     {"m_c": np.array([20e3, 60e3])}])  # fmt: skip
def test_a_calibrated_body_keeps_its_bending_frequency(changes):
    found = paper_coach(4).bending_frequencies(**changes)[..., 0]
    np.testing.assert_allclose(found, 9.6, rtol=1e-10)


def test_changes_equal_a_vehicle_derived_with_them():
    """A changed parameter never derives again, and gives what deriving again would."""
    vehicle = load_vehicle("cati2024")
    changed = replace(
        vehicle,
        body=replace(vehicle.body, mass=40e3, length=23.0, bending_frequency=8.0,
                     bending_damping=0.02),
        bogies=tuple(replace(b, secondary_stiffness=6e5, position=np.sign(b.position) * 8.5)
                     for b in vehicle.bogies),
    )  # fmt: skip
    changed = replace(changed, body=replace(changed.body, inertia="rods"))
    here = paper_coach(4).matrices(m_c=40e3, L=23.0, f_bending=8.0, zeta_bending=0.02, k_2=6e5,
                                   l_b=8.5)  # fmt: skip
    there = derive_vehicle(changed, 4).matrices()
    for name in MATRICES:
        np.testing.assert_allclose(getattr(here, name), getattr(there, name), rtol=1e-10)


def test_joint_stiffness_as_given():
    by_call = paper_coach(2, joint_stiffness=3.7e8)
    assert float(by_call.values()["k_theta"]) == 3.7e8
    assert float(paper_coach(2).values(k_theta=3.7e8)["k_theta"]) == 3.7e8
    assert float(by_call.bending_frequencies(m_c=17e3)[0]) == pytest.approx(
        np.sqrt(2) * float(by_call.bending_frequencies()[0])
    )


def test_joints_from_a_bending_stiffness_follow_it():
    body = CarBody(34e3, 1.632e6, 24.0, bending_stiffness=9e8)
    model = derive_vehicle(replace(load_vehicle("cati2024"), body=body), 6)
    assert float(model.values()["k_theta"]) == pytest.approx(9e8 / 4.0)
    assert float(model.values(EI=1e9, L=12.0 * 1.8)["k_theta"]) == pytest.approx(1e9 / 3.6)


@pytest.mark.parametrize("segments", [2, 4, 7])
@pytest.mark.parametrize("zeta", [0.01, 0.015])
def test_structural_damping_of_the_free_body(segments, zeta):
    """c_θ = 2 ζ k_θ/ω_1 on every joint gives ζ_i = ζ f_i/f_1."""
    model = paper_coach(segments, bending_damping=zeta)
    m = model.matrices(k_1=100.0, c_1=0, k_2=100.0, c_2=0)
    own = segments + 1
    M, C, K = (A[:own, :own] for A in (m.M, m.C, m.K))
    A = np.block([[np.zeros_like(M), np.eye(own)],
                  [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])  # fmt: skip
    roots = np.linalg.eigvals(A)
    roots = np.sort_complex(roots[(np.abs(roots) > 5) & (roots.imag > 0)])
    f = np.abs(roots) / (2 * np.pi)
    order = np.argsort(f)
    f, found = f[order], (-roots.real / np.abs(roots))[order]
    assert len(f) == segments - 1
    np.testing.assert_allclose(f, model.bending_frequencies(), rtol=1e-5)
    np.testing.assert_allclose(found, zeta * f / 9.6, rtol=1e-5)


def test_a_very_long_name_is_told_by_its_beginning():
    with pytest.raises(InputError) as caught:
        paper_coach(2).matrices(**{"k" * 20_000: 7e5})
    assert len(str(caught.value)) < 2000


def test_unknown_parameters_are_refused_with_those_there_are():
    with pytest.raises(InputError, match=r"'k2'; expected one of .*k_2"):
        paper_coach(2).matrices(k2=7e5)
    with pytest.raises(InputError, match="k_theta"):
        paper_coach(1).matrices(k_theta=1e8)
    with pytest.raises(InputError, match="I_c"):
        paper_coach(2).matrices(I_c=1e6)  # the rods have their own: it would change nothing


@pytest.mark.parametrize("value", [np.nan, np.inf, [7e5, np.nan]])
def test_values_that_are_no_numbers_are_refused(value):
    with pytest.raises(InputError, match=r"k_2.*finite"):
        paper_coach(2).matrices(k_2=value)


@pytest.mark.parametrize(
    ("segments", "changes"),
    [
        (1, {"m_c": -1.0}), (1, {"I_c": 0.0}), (1, {"m_b": 0.0}), (1, {"I_b": -5.0}),
        (2, {"m_c": -1.0}),
        (2, {"L": 0.0}),
        (2, {"m_b": 0.0}), (2, {"I_b": -5.0}),
    ],
)  # fmt: skip
def test_masses_and_lengths_that_cannot_be_are_refused(segments, changes):
    with pytest.raises(InputError), np.errstate(all="ignore"):
        paper_coach(segments).matrices(**changes)


@pytest.mark.parametrize(("inertia", "value"), [("graded", 3.2e6), ("graded", 0.4e6),
                                                ("segments", 1.2e6)])  # fmt: skip
def test_an_inertia_that_needs_a_negative_mass_is_refused_when_changed_too(inertia, value):
    vehicle = load_vehicle("cati2024")
    vehicle = replace(vehicle, body=replace(vehicle.body, inertia=inertia))
    with pytest.raises(InputError):
        derive_vehicle(replace(vehicle, body=replace(vehicle.body, pitch_inertia=value)), 2)
    with pytest.raises(InputError):
        derive_vehicle(vehicle, 2).matrices(I_c=value)


def test_a_bogie_moved_onto_another_segment_is_refused():
    model = paper_coach(4)  # segments of 6 m: 12 … 6, 6 … 0
    model.matrices(l_b=np.linspace(6.1, 11.9, 5))
    for changes in ({"l_b": 5.0}, {"L": 40.0}, {"l_b": [8.0, 5.9]}):
        with pytest.raises(InputError, match=r"bogie 1.*segment"):
            model.matrices(**changes)


def test_a_bogie_moved_off_the_body_is_refused():
    with pytest.raises(InputError, match="bogie"):
        paper_coach(4).matrices(l_b=12.5)


@pytest.mark.parametrize("segments", [0, -1, 2.5, True, "4"])
def test_a_number_of_segments_that_is_none_is_refused(segments):
    with pytest.raises(InputError, match=r"segments.*whole number"):
        derive_vehicle(load_vehicle("cati2024"), segments)


@pytest.mark.parametrize("segments", ["four", np.inf, np.nan])
def test_segments_that_are_no_number_are_refused(segments):
    with pytest.raises(InputError, match="segments"):
        derive_vehicle(load_vehicle("cati2024"), segments)


def test_default_is_four_segments():
    assert derive_vehicle(load_vehicle("cati2024")).body.segments == 4


def test_two_stiffnesses_are_refused_and_idle_ones_told():
    with pytest.raises(InputError, match="both a bending frequency and a joint stiffness"):
        paper_coach(2, bending_frequency=9.0, joint_stiffness=1e8)
    (remark,) = paper_coach(1, bending_frequency=9.0, bending_damping=0.01).remarks
    assert "bending frequency" in remark
    assert "bending damping" in remark
    assert not any("effect" in r for r in paper_coach(4, bending_frequency=9.0).remarks)


@pytest.mark.parametrize("given", [{"bending_frequency": -9.0}, {"bending_frequency": np.nan},
                                   {"joint_stiffness": 0.0}, {"bending_damping": -0.1},
                                   {"bending_damping": 1.5}])  # fmt: skip
def test_bending_that_cannot_be_is_refused(given):
    with pytest.raises(InputError):
        paper_coach(4, **given)


@pytest.mark.parametrize("broken", ["M", "C", "K", "lift", "definite", "finite"])
def test_matrices_check_themselves(broken):
    m = paper_coach(2).matrices()
    parts = {name: getattr(m, name).copy() for name in (*MATRICES, "lift")}
    if broken in "MCK":
        parts[broken][0, 1] += 0.01 * np.abs(parts[broken]).max()
    elif broken == "lift":
        parts["K_w"][3, 0] *= 1.01
    elif broken == "definite":
        parts["M"][3, 3] = -1.0
    else:
        parts["C_w"][0, 0] = np.nan
    words = {"lift": "uniform lift", "definite": "positive definite", "finite": "finite number"}
    with pytest.raises(InputError, match=words.get(broken, rf"{broken}: .*symmetric")):
        Matrices(**parts)


def test_outputs_of_suspensions_and_bogies():
    model = random_model(1, 4)
    bogies, wheelsets = len(model.vehicle.bogies), len(model.vehicle.wheelset_positions)
    names = [f"bogie_{b}_acceleration" for b in range(1, bogies + 1)]
    names += [f"secondary_{b}_deflection" for b in range(1, bogies + 1)]
    names += [f"primary_{j}_deflection" for j in range(1, wheelsets + 1)]
    assert set(model.outputs) == set(names)
    rows = model.output_rows(list(model.outputs.values()))
    by_hand, place = assemble(model.vehicle, 4), dict.fromkeys(names)
    for k, name in enumerate(model.outputs):
        place[name] = k
    for b in range(1, bogies + 1):
        np.testing.assert_allclose(rows["d"][place[f"secondary_{b}_deflection"]],
                                   by_hand.B_f[:, b - 1], atol=1e-12)  # fmt: skip
        assert rows["a"][place[f"bogie_{b}_acceleration"]][5 + 2 * (b - 1)] == 1
    for j, (x, bogie) in enumerate(
        (x, b) for b, one in enumerate(model.vehicle.bogies) for x in one.wheelsets
    ):
        k = place[f"primary_{j + 1}_deflection"]
        expected = np.zeros(len(model.linear.coordinates))
        expected[5 + 2 * bogie : 7 + 2 * bogie] = 1.0, x
        np.testing.assert_allclose(rows["d"][k], expected, atol=1e-12)
        np.testing.assert_array_equal(rows["w"][k], -np.eye(wheelsets)[j])


def test_bogies_that_differ_have_parameters_of_their_own():
    model = random_model(2, 2)
    names = {p.symbol.name for p in model.parameters}
    assert {"k_2_b1", "k_2_b2", "m_b1", "m_b2"} <= names
    assert "k_2" not in names
    stiffer = model.matrices(k_2_b1=2 * model.vehicle.bogies[0].secondary_stiffness)
    assert not np.array_equal(stiffer.K, model.matrices().K)
    assert isinstance(model, VehicleModel)


def test_every_parameter_matters_and_has_its_value():
    """Each independent parameter changes some matrix; its value is the vehicle's."""
    model = paper_coach(2, bending_damping=0.01)
    here = model.matrices()
    for p in model.parameters:
        there = model.matrices(**{p.symbol.name: 1.001 * p.value})
        assert any(not np.array_equal(getattr(here, n), getattr(there, n)) for n in MATRICES), p
    values = {p.symbol.name: (p.value, p.unit) for p in model.parameters}
    assert values["k_2"] == (750e3, "N/m")
    assert values["l_w"] == (1.25, "m")
    assert values["f_bending"] == (9.6, "Hz")
