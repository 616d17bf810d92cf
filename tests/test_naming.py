"""Names of modes: what moves, where modes couple, creep, or coincide."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import linear_sum_assignment
from vehicles import mirrored, paper_coach, random_model, random_vehicle

from railride.firstorder import first_order
from railride.modal import eigen, modes, solve
from railride.naming import assign, motions, participation
from railride.parameters import load_vehicle
from railride.vehicle import derive_vehicle

MOUNTS = {"primary_damper_stiffness": 2e6, "secondary_damper_stiffness": 12e6}


@cache
def mounted(segments=2):
    """The paper's coach with its dampers on elastic mounts."""
    coach = load_vehicle("cati2024")
    bogies = tuple(replace(bogie, **MOUNTS) for bogie in coach.bogies)
    return derive_vehicle(replace(coach, bogies=bogies), segments)


@cache
def three_bogies(segments=2):
    """A coach on three equal bogies, not symmetric, each of two wheelsets about its centre."""
    coach = load_vehicle("cati2024")
    bogies = tuple(replace(coach.bogies[0], position=x) for x in (9.0, 2.0, -8.0))
    return derive_vehicle(replace(coach, bogies=bogies), segments)


def real(found):
    return [mode for mode in found if mode.eigenvalue.imag == 0]


def pairs(found):
    return [mode for mode in found if mode.eigenvalue.imag > 0]


# Coupled modes


def test_bending_tuned_to_the_bogies_heave_shares_its_energy_with_it():
    """Two equal oscillators, lightly coupled: each mode has half of each (Newland, Chapter 6)."""
    found = modes(paper_coach(2), f_bending=9.505, c_1=300.0, c_2=1000.0)
    (bending,) = [m for m in found if m.label == "bending 1"]
    (together,) = [m for m in found if m.label == "bogie heave" and m.phase == "in phase"]
    (against,) = [m for m in found if m.label == "bogie heave" and m.phase == "anti-phase"]
    assert_allclose([bending.share, together.share], 0.5, atol=0.03)
    assert against.share > 0.99
    assert bending.frequency_hz / together.frequency_hz == pytest.approx(1.024, abs=0.01)


def test_the_larger_share_of_bending_has_the_name_all_through_the_crossing():
    for f_1 in np.linspace(7.0, 12.0, 51):
        found = solve(paper_coach(2), f_bending=f_1, c_1=300.0, c_2=1000.0)
        A, free = found.A, found.free
        kinetic = np.abs(free.amplitudes(A.M, np.array([m.shape for m in found.modes]).T)) ** 2
        share = (kinetic / kinetic.sum(axis=0))[free.labels.index("bending 1")]
        assert found.modes[int(np.argmax(share))].label == "bending 1"
        assert sorted(m.label for m in found.modes) == sorted(free.labels)


@pytest.mark.parametrize("seed", range(5))
def test_assignment_is_as_good_as_the_best(seed):
    """Against scipy's, labels repeated as often as they may be given."""
    rng = np.random.default_rng(seed)
    places = np.array([1, 1, 2, 1, 2])
    shares = rng.random((5, 7)) ** 4
    shares /= shares.sum(axis=0)
    given = assign(shares, places)
    assert (np.bincount(given, minlength=5) <= places).all()
    repeated = np.repeat(shares, places, axis=0)
    best = repeated[linear_sum_assignment(-repeated)].sum()
    assert shares[given, np.arange(7)].sum() > 0.93 * best


def test_exchanges_mend_what_the_largest_share_first_gets_wrong():
    shares = np.array([[0.9, 0.8], [0.8, 0.1]])
    assert assign(shares, np.array([1, 1])) == [1, 0]


# Participation


@pytest.mark.parametrize("model", [paper_coach(2), mounted(), random_model(2, 3)])
def test_participation_of_an_undamped_mode_is_its_kinetic_energy(model):
    changes = {} if model is mounted() else {"c_1": 0.0, "c_2": 0.0}
    if model is random_model(2, 3):
        bogies = range(1, len(model.vehicle.bogies) + 1)
        changes = {f"{c}_b{b}": 0.0 for c in ("c_1", "c_2") for b in bogies} | {"zeta_bending": 0.0}
    found = solve(model, **changes)
    parts = participation(found.free, found.x, found.vectors)
    assert_allclose(parts.sum(axis=0), 1)
    if not changes:
        return
    shapes = found.x.q_x @ found.vectors
    kinetic = np.abs(found.free.amplitudes(found.A.M, shapes)) ** 2
    assert_allclose(parts[:-1], kinetic / kinetic.sum(axis=0), atol=1e-6)


def test_participation_is_the_derivative_of_the_eigenvalue_by_the_state_matrix():
    """p_kk = ∂λ/∂A_kk: Pérez-Arriaga et al. 1982, equation (9); here of bogie heaves' rates."""
    found = solve(paper_coach(1), c_1=90e3)
    A, place = found.x.A, 6 + 2  # the rate of z_b1, the third of six coordinates
    parts = participation(found.free, found.x, found.vectors)
    W = np.linalg.inv(found.vectors)
    step = 1e-4
    changed = A.copy()
    changed[place, place] += step
    for k in (0, 4, 6):
        moved = np.linalg.eigvals(changed)
        derivative = (moved[np.argmin(np.abs(moved - found.roots[k]))] - found.roots[k]) / step
        assert_allclose(W[k, place] * found.vectors[place, k], derivative, atol=1e-4)
    assert parts.shape == (7, 12)


# Creeping motions


def test_overdamped_bogies_have_a_fast_and_a_slow_eigenvalue_of_one_name():
    """c_1 = 1e7: bogies creep at -k_1/c_1 and shoot at -2 c_1/m_b; body and bogie ride along."""
    found = modes(paper_coach(2), c_1=1e7)
    slow = [m for m in real(found) if m.frequency_hz < 1]
    fast = [m for m in real(found) if m.frequency_hz > 1]
    for some in (slow, fast):
        assert sorted(m.label for m in some) == ["bogie heave"] * 2 + ["bogie pitch"] * 2
        assert sorted(m.phase for m in some) == ["anti-phase"] * 2 + ["in phase"] * 2
        assert all(m.share > 0.9 for m in some)
    assert_allclose([m.eigenvalue.real for m in slow], -5e6 / 1e7, rtol=1e-3)
    heaving = [m.eigenvalue.real for m in fast if m.label == "bogie heave"]
    assert_allclose(heaving, -2e7 / 3000, rtol=0.01)
    assert [m.label for m in pairs(found)] == ["heave", "pitch", "bending 1"]


def test_a_locked_secondary_damper_leaves_the_body_creeping():
    """c_2 = 1e6: the body creeps at -k_2/c_2; it and the bogies heave as one on the primary."""
    found = modes(paper_coach(2), c_2=1e6)
    slow = [m for m in real(found) if m.frequency_hz < 1]
    assert [m.label for m in slow] == ["pitch", "heave"]
    assert_allclose([m.eigenvalue.real for m in slow], -0.75, rtol=0.02)
    assert [m.label for m in real(found) if m.frequency_hz > 1] == ["bogie heave"] * 2
    heave = pairs(found)[0]
    assert heave.label == "heave"
    assert heave.frequency_hz == pytest.approx(np.sqrt(20e6 / 40e3) / (2 * np.pi), rel=0.08)


@pytest.mark.parametrize("c_2", [1.7102e5, 1.712e5, 1.72e5, 1.75e5, 1.8e5])
def test_what_just_became_real_keeps_its_name(c_2):
    """Beside critical damping, at 171.0 kN s/m, participation alone would see the bogies."""
    creeping = real(modes(paper_coach(2), c_2=c_2))
    assert [m.label for m in creeping] == ["pitch", "pitch"]
    assert all(m.share > 0.8 for m in creeping)


@pytest.mark.parametrize("name", ["c_1", "c_2"])
def test_every_motion_has_a_mode_and_no_two_pairs_one_name(name):
    labels = ["heave", "pitch", "bending 1", *["bogie heave", "bogie pitch"] * 2]
    for value in [*np.geomspace(1e2, 1e7, 40), 1.95e5, 2.2e5, 2.3e5]:
        found = modes(paper_coach(2), **{name: value})
        every = [m.label for m in found]
        assert set(every) == set(labels)
        assert all(every.count(label) >= labels.count(label) for label in labels)
        oscillating = [m.label for m in pairs(found)]
        assert all(oscillating.count(label) <= labels.count(label) for label in oscillating)


# Dampers on elastic mounts


@pytest.mark.parametrize("changes", [{}, {"c_1": 300e3, "c_2": 300e3}, {"c_1": 1e3, "c_2": 2e6},
                                     {"k_d1": 1e4}, {"k_d1": 1e9, "k_d2": 1e9}])  # fmt: skip
def test_as_many_relaxations_as_dampers_on_mounts(changes):
    found = modes(mounted(), **changes)
    dampers = [m for m in found if m.label == "damper"]
    assert len(dampers) == 6  # two secondary, four primary
    assert all(m.eigenvalue.imag == 0 for m in dampers)
    others = [m.label for m in found if m.label != "damper"]
    named = ["heave", "pitch", "bending 1", *["bogie heave", "bogie pitch"] * 2]
    assert sorted(others) == sorted(named)


def test_relaxations_of_stiff_mounts_are_those_of_the_damper_alone():
    """λ → -k_d/c, four and two; what is left has the names and values of rigid mounts."""
    found = modes(mounted(), k_d1=1e10, k_d2=3e10)
    dampers = [m.eigenvalue.real for m in found if m.label == "damper"]
    assert_allclose(sorted(dampers), [-3e10 / 70e3] * 2 + [-1e10 / 30e3] * 4, rtol=1e-2)
    rest = [m for m in found if m.label != "damper"]
    rigid = modes(paper_coach(2))
    assert [m.label for m in rest] == [m.label for m in rigid]
    assert_allclose([m.eigenvalue for m in rest], [m.eigenvalue for m in rigid], rtol=1e-2)


def test_a_motion_may_creep_beside_its_dampers():
    """A bogie's heave on stiff mounts, overdamped: two of the three real roots are its own."""
    found = modes(mounted(), k_d1=1e10, c_1=1e6)
    creeping = [m for m in real(found) if m.label != "damper"]
    assert sorted(m.label for m in creeping) == ["bogie heave"] * 4 + ["bogie pitch"] * 4
    assert len([m for m in found if m.label == "damper"]) == 6


# Repeated eigenvalues


@pytest.mark.parametrize("model", [paper_coach(1), paper_coach(2), paper_coach(5), mounted()])
def test_equal_bogies_pitch_in_phase_and_in_anti_phase(model):
    """Repeated eigenvalues: the shapes are those of a symmetric vehicle, in a fixed order."""
    found = [m for m in modes(model) if m.label == "bogie pitch"]
    assert [m.phase for m in found] == ["in phase", "anti-phase"]
    assert found[0].eigenvalue == found[1].eigenvalue
    names = [q.name for q in model.lagrangian.coordinates]
    front, rear = names.index("theta_b1"), names.index("theta_b2")
    for mode, turn in zip(found, (1, -1), strict=True):
        assert_allclose(mode.shape[[front, rear]], [1, turn], atol=1e-9)
        others = [k for k, q in enumerate(names) if k not in (front, rear) and q[0] != "d"]
        assert_allclose(mode.shape[others], 0, atol=1e-8)
        assert mode.share == pytest.approx(1)


def test_repeated_shapes_do_not_depend_on_what_the_solver_happens_to_give(monkeypatch):
    """Any mixture of the two eigenvectors gives the same modes."""
    model = paper_coach(2)
    expected = modes(model)
    roots, vectors = eigen(model.matrices())
    twice = np.flatnonzero(np.abs(roots - expected[-1].eigenvalue) < 1e-6)
    assert twice.size == 2
    mixed = vectors.copy()
    mixed[:, twice] = vectors[:, twice] @ np.array([[0.6 + 0.3j, 1.0], [-0.5j, 0.2 + 0.7j]])
    monkeypatch.setattr("railride.modal.eigen", lambda _: (roots, mixed))
    for mode, same in zip(modes(model), expected, strict=True):
        assert (mode.label, mode.phase) == (same.label, same.phase)
        assert_allclose(mode.shape, same.shape, atol=1e-7)
        assert mode.share == pytest.approx(same.share, abs=1e-6)


def test_modes_of_repeated_eigenvalues_are_modes():
    for model in (paper_coach(2), three_bogies(), mounted()):
        A = model.matrices()
        for m in modes(model):
            left = (m.eigenvalue**2 * A.M + m.eigenvalue * A.C + A.K) @ m.shape
            assert np.abs(left).max() < 1e-8 * np.abs(A.K).max()


def test_three_equal_bogies_move_as_a_chain_of_three_would():
    """The least coupling of neighbours: (1, √2, 1), (1, 0, -1) and (1, -√2, 1)."""
    model = three_bogies()
    found = [m for m in modes(model) if m.label == "bogie pitch"]
    names = [q.name for q in model.lagrangian.coordinates]
    theta = [names.index(f"theta_b{b}") for b in (1, 2, 3)]
    root = np.sqrt(0.5)
    expected = ([root, 1, root], [1, 0, -1], [-root, 1, -root])
    for mode, shape in zip(found, expected, strict=True):
        assert_allclose(mode.shape[theta], shape, atol=1e-7)
    assert [m.phase for m in found] == ["in phase", "", "anti-phase"]


def test_rounding_makes_no_pairs_of_repeated_real_eigenvalues():
    """Overdamped equal bogies: exactly two and two, whatever the last bits say."""
    for c_1 in np.geomspace(2e5, 1e8, 25):
        found = modes(paper_coach(2), c_1=c_1)
        pitching = [m for m in found if m.label == "bogie pitch"]
        assert len(pitching) == 4
        assert all(m.eigenvalue.imag == 0 and m.share > 0.99 for m in pitching)


@pytest.mark.parametrize("off", [0.0, 1e-15, -1e-12, 1e-9, -1e-5])
def test_bogies_at_critical_damping_keep_their_names(off):
    """(2 c_1 l²)² = 4 I_b 2 k_1 l²: the two eigenvectors of each bogie's pitch become one."""
    critical = np.sqrt(2 * 5e6 * 2000) / 1.25
    found = modes(paper_coach(1), c_1=critical * (1 + off))
    pitching = [m for m in found if m.label == "bogie pitch"]
    assert len(pitching) in {2, 4}
    assert all(m.share > 0.99 for m in pitching)
    assert_allclose([m.frequency_hz for m in pitching], 14.0674, rtol=0.01)


# The same vehicle from the other side


@pytest.mark.parametrize("seed", range(3))
def test_a_vehicle_and_its_mirror_image_have_the_same_names(seed):
    here = modes(random_model(seed, 3))
    there = modes(derive_vehicle(mirrored(random_vehicle(seed)), 3))
    assert [(m.label, m.phase) for m in here] == [(m.label, m.phase) for m in there]
    assert_allclose([m.share for m in here], [m.share for m in there], atol=1e-6)


def test_free_motions_are_orthogonal_and_complete():
    for model in (paper_coach(1), random_model(1, 4), mounted()):
        A = model.matrices()
        free = motions(model, A)
        inner = free.basis.T @ A.M @ free.basis
        assert_allclose(inner, np.diag(np.diagonal(inner)), atol=1e-9 * inner.max())
        assert len(free.labels) == first_order(A).inertial.sum()
