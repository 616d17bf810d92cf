"""Modes: frequencies and damping of published vehicles, and the right names."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from vehicles import paper_coach, random_model

from railride.errors import InputError
from railride.modal import eigen, modes, undamped_frequencies
from railride.parameters import load_vehicle
from railride.vehicle import derive_vehicle


def labels(found):
    return [mode.label for mode in found]


def test_manchester_vehicle_damped():
    """|λ|/2π and ζ of Iwnicki's benchmark vehicle (VSD 30, 1998, 295-313) with 6 DOF."""
    found = modes(derive_vehicle(load_vehicle("manchester")))
    assert [(f"{m.frequency_hz:.4f}", f"{m.damping_ratio:.3f}") for m in found] == [
        ("1.0788", "0.134"), ("1.3089", "0.162"), ("7.3597", "0.242"), ("7.3752", "0.238"),
        ("11.6174", "0.122"), ("11.6174", "0.122"),
    ]  # fmt: skip
    assert labels(found) == ["heave", "pitch", *["bogie heave"] * 2, *["bogie pitch"] * 2]


@pytest.mark.parametrize("segments", [1, 2, 4, 8])
def test_modes_of_the_papers_coach_have_their_names(segments):
    found = modes(paper_coach(segments))
    assert labels(found)[:2] == ["heave", "pitch"]
    bending = [m for m in found if m.label.startswith("bending")]
    assert [m.label for m in bending] == [f"bending {k}" for k in range(1, segments)]
    if segments > 1:
        assert bending[0].damping_ratio == pytest.approx(0.01, abs=2e-3)  # the suspension's
        free = paper_coach(segments).bending_frequencies()
        np.testing.assert_allclose([m.frequency_hz for m in bending], free, rtol=0.02)
    bogie = [m for m in found if m.label == "bogie heave"]
    assert len(bogie) == len([m for m in found if m.label == "bogie pitch"]) == 2
    assert all(0.3 < m.damping_ratio < 0.45 for m in bogie)
    # Two equal bogies move in any mixture with and against each other.
    assert all(m.share > 0.9 for m in found if not m.label.startswith("bogie"))


@pytest.mark.parametrize("segments", [1, 2, 5])
def test_modes_satisfy_their_own_equation(segments):
    """(λ² M + λ C + K) φ = 0."""
    model = random_model(3, segments)
    A = model.matrices()
    found = modes(model)
    assert sum(2 if m.eigenvalue.imag > 0 else 1 for m in found) == 2 * len(A.M)
    for m in found:
        left = (m.eigenvalue**2 * A.M + m.eigenvalue * A.C + A.K) @ m.shape
        assert np.abs(left).max() < 1e-8 * np.abs(A.K).max()
        assert np.abs(m.shape).max() == pytest.approx(1)
        assert m.frequency_hz == pytest.approx(abs(m.eigenvalue) / (2 * np.pi))
        assert m.damping_ratio == pytest.approx(-m.eigenvalue.real / abs(m.eigenvalue))


def test_without_dampers_the_frequencies_are_the_undamped_ones():
    model = paper_coach(4)
    found = [m.frequency_hz for m in modes(model, c_1=0.0, c_2=0.0)]
    np.testing.assert_allclose(found, undamped_frequencies(model.matrices()), rtol=1e-8)
    A = model.matrices()
    peer = np.sqrt(scipy.linalg.eigh(A.K, A.M, eigvals_only=True)) / (2 * np.pi)
    np.testing.assert_allclose(undamped_frequencies(A), peer, rtol=1e-9)


def test_undamped_frequencies_of_arrays():
    found = undamped_frequencies(paper_coach(2).matrices(k_2=[5e5, 7.5e5]))
    assert found.shape == (2, 7)
    np.testing.assert_allclose(found[1], undamped_frequencies(paper_coach(2).matrices()))


@pytest.mark.parametrize("seed", range(4))
def test_modes_of_an_unsymmetric_vehicle_have_their_names(seed):
    found = modes(random_model(seed, 4))
    bogies = len(random_model(seed, 4).vehicle.bogies)
    expected = ["heave", "pitch", "bending 1", "bending 2", "bending 3"]
    expected += ["bogie heave", "bogie pitch"] * bogies
    oscillating = [m.label for m in found if m.eigenvalue.imag > 0]
    real = [m.label for m in found if m.eigenvalue.imag == 0]
    assert sorted(2 * oscillating + real) == sorted(2 * expected)
    assert oscillating[0] in {"heave", "pitch"}


def test_names_follow_the_modes_through_a_crossing():
    """The bending frequency swept through the bogies' heave at 9.53 Hz, with hardly a damper.

    On either side the modes keep their names; beside the crossing they are mixed, and the names
    change over once, each being given once.
    """
    swept = np.linspace(7.0, 13.0, 61)
    sides = []
    for f_1 in swept:
        found = modes(paper_coach(2), f_bending=f_1, c_1=300.0)
        names = labels(found)
        assert sorted(names) == sorted(["heave", "pitch", "bending 1",
                                        *["bogie heave", "bogie pitch"] * 2])  # fmt: skip
        bending = found[names.index("bending 1")]
        assert bending.share > 0.45
        assert bending.frequency_hz == pytest.approx(f_1, rel=0.08)
        others = [m.frequency_hz for m in found if m.label == "bogie heave"]
        sides.append(bending.frequency_hz > max(others))
    assert not sides[0]
    assert sides[-1]
    assert np.count_nonzero(np.diff(sides)) == 1


def test_names_hold_while_dampers_grow():
    """c_2 swept from nothing up to where heave no longer oscillates: no name jumps."""
    for c_2 in np.geomspace(1e2, 5e5, 30):
        found = modes(paper_coach(4), c_2=c_2)
        left = [m.label for m in found]
        assert left.count("bending 1") in {1, 2}
        assert "heave" in left
        assert "pitch" in left
        (bending,) = [m for m in found if m.label == "bending 3"]
        assert bending.frequency_hz == pytest.approx(41.9, rel=0.05)


def test_overdamped_motions_are_listed_singly():
    found = modes(paper_coach(1), c_1=400e3, c_2=400e3)
    real = [m for m in found if m.eigenvalue.imag == 0]
    pairs = [m for m in found if m.eigenvalue.imag > 0]
    assert real
    assert len(real) + 2 * len(pairs) == 12
    assert all(m.damping_ratio == pytest.approx(1.0) for m in real)
    assert all(m.damping_ratio < 1 for m in pairs)
    frequencies = [m.frequency_hz for m in found]
    assert frequencies == sorted(frequencies)


@pytest.mark.parametrize("changes", [{"c_2": -70e3}, {"k_2": -750e3}, {"c_1": -3e3}])
def test_an_unstable_vehicle_is_refused(changes):
    with pytest.raises(InputError, match=r"unstable|above 0"):
        modes(paper_coach(2), **changes)


def test_the_message_names_the_growing_mode():
    with pytest.raises(InputError, match=r"unstable mode at 1\.\d+ Hz"):
        modes(paper_coach(2), c_2=-5e3)


def test_an_ill_conditioned_mass_matrix_is_refused():
    """Two coordinates that carry the same mass, all but 1e-13 of it."""
    m = paper_coach(2).matrices()
    M = m.M.copy()
    M[:2, :2] = M[0, 0] * (np.ones((2, 2)) + 1e-13 * np.eye(2))
    M[:2, 2] = M[2, :2] = 0.0
    with pytest.raises(InputError, match=r"condition .*units"):
        eigen(replace(m, M=M))


def test_a_mass_next_to_nothing_is_told_as_that():
    """3 t written as 3e-9: it is the mass that is wrong, and no spring is missing."""
    with pytest.raises(InputError) as raised:
        modes(paper_coach(2), m_b=3e-9, I_b=2e-9)
    assert "no spring" not in str(raised.value)
    assert "mass" in str(raised.value)


@pytest.mark.parametrize("segments", [1, 2, 4])
def test_modes_that_rounding_decides_are_refused(segments):
    """A damper of 8e16 N s/m: k/c and c/m are 26 powers of ten apart, a double holds 16."""
    with pytest.raises(InputError, match=r"so far apart that rounding decides .*units"):
        modes(paper_coach(segments), c_2=8e16)
    slowest = min(modes(paper_coach(segments), c_2=8e7), key=lambda mode: mode.frequency_hz)
    assert slowest.frequency_hz == pytest.approx(750e3 / 8e7 / (2 * np.pi), rel=1e-4)


def test_several_vehicles_at_once_are_refused():
    with pytest.raises(InputError, match="one vehicle at a time"):
        modes(paper_coach(2), k_2=[5e5, 6e5])
