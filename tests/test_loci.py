"""Root loci: the right eigenvalues at every value, and each curve followed on its way."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import scipy.linalg
from numpy.testing import assert_allclose, assert_array_equal
from test_naming import mounted
from vehicles import paper_coach, random_model

from railride import loci
from railride.errors import InputError
from railride.loci import mode_locus
from railride.modal import modes


@cache
def crossing():
    """Bending 1 swept through the bogies' heave, with the paper's dampers: the curves cross."""
    return mode_locus(paper_coach(2), f_bending=np.linspace(7, 12, 41))


@cache
def growing_dampers():
    return mode_locus(paper_coach(2), c_2=np.geomspace(1e3, 1e6, 50))


def curves(locus, at="real"):
    """Branch → its values over the parameter, one after another."""
    name = locus.attrs["parameter"]
    return {b: rows.set_index(name)[at] for b, rows in locus.groupby("branch")}


@pytest.mark.parametrize(
    ("model", "varied"),
    [
        (paper_coach(2), {"c_2": np.geomspace(1e3, 1e6, 15)}),
        (paper_coach(4), {"f_bending": np.linspace(7, 12, 7), "c_1": 300.0}),
        (mounted(), {"k_d1": np.geomspace(1e4, 1e9, 9)}),
        (random_model(1, 3), {"m_c": np.array([40e3, 50e3])}),
    ],
)
def test_every_value_has_its_own_eigenvalues_and_no_others(model, varied):
    """As sets, against scipy on the pencil of M, C and K; massless rows make infinite ones."""
    locus = mode_locus(model, **varied)
    name, fixed = next(iter(varied)), {k: v for k, v in varied.items() if np.ndim(v) == 0}
    for value, rows in locus.groupby(name):
        m = model.matrices(**{name: value}, **fixed)
        one, none = np.eye(len(m.M)), np.zeros_like(m.M)
        A = np.block([[none, one], [-m.K, -m.C]])
        expected = scipy.linalg.eigvals(A, np.block([[one, none], [none, m.M]]))
        expected = expected[np.isfinite(expected) & (np.abs(expected) < 1e9)]
        assert expected.size == m.M.shape[0] + m.inertial.sum()
        expected = expected[expected.imag > -1e-6 * np.abs(expected)]
        found = (rows["real"] + 1j * rows["imag"]).to_numpy()
        assert rows["frequency_hz"].is_monotonic_increasing
        far = np.abs(found[:, np.newaxis] - expected).min(axis=1)
        assert (far < 1e-6 * np.abs(found)).all()
        doubled = 2 * (found.imag > 0).sum() + (found.imag == 0).sum()
        assert doubled == m.M.shape[0] + m.inertial.sum()
        missed = np.abs(expected[:, np.newaxis] - found).min(axis=1)
        assert (missed < 1e-6 * np.abs(expected)).all()
    assert_array_equal(np.unique(locus[name]), varied[name])


def test_columns_and_what_they_mean():
    locus = growing_dampers()
    assert list(locus.columns) == ["c_2", "frequency_hz", "damping_ratio", "real", "imag", "label",
                                   "share", "branch"]  # fmt: skip
    root = locus["real"] + 1j * locus["imag"]
    assert_allclose(locus["frequency_hz"], np.abs(root) / (2 * np.pi))
    assert_allclose(locus["damping_ratio"], -locus["real"] / np.abs(root))
    assert locus.attrs == {"parameter": "c_2", "unit": "N s/m",
                           "meaning": "secondary damping per bogie"}  # fmt: skip
    first = locus[locus["c_2"] == locus["c_2"].min()]
    assert_array_equal(first["branch"], np.arange(1, 8))


def test_rows_of_one_value_are_its_modes():
    locus = growing_dampers()
    for value in np.unique(locus["c_2"])[[0, 30, 49]]:
        rows, found = locus[locus["c_2"] == value], modes(paper_coach(2), c_2=value)
        assert list(rows["label"]) == [m.label for m in found]
        assert list(rows["share"]) == [m.share for m in found]


def test_curves_that_cross_go_straight_on():
    """Bending 1 has hardly a damper, the bogies' heave ζ = 0.37: λ come near, and keep apart."""
    locus = crossing()
    assert (locus.groupby("branch").size() == 41).all()
    assert (locus.groupby("branch")["label"].nunique() == 1).all()
    frequency = curves(locus, "frequency_hz")
    bending = locus.loc[locus["label"] == "bending 1", "branch"].iloc[0]
    assert frequency[bending].iloc[0] == pytest.approx(7.07, abs=0.01)
    assert frequency[bending].iloc[-1] == pytest.approx(11.95, abs=0.01)
    others = locus.loc[locus["label"] == "bogie heave", "branch"].unique()
    assert len(others) == 2
    for b in others:  # they really cross
        assert frequency[b].iloc[0] > frequency[bending].iloc[0]
        assert frequency[b].iloc[-1] < frequency[bending].iloc[-1]


def test_curves_that_veer_away_are_followed_and_change_their_names_once():
    """With hardly a damper the two repel one another: shapes change over, frequencies do not."""
    locus = mode_locus(paper_coach(2), f_bending=np.linspace(7, 12, 41), c_1=300.0, c_2=1000.0)
    frequency = curves(locus, "frequency_hz")
    named = {b: list(dict.fromkeys(rows["label"])) for b, rows in locus.groupby("branch")}
    lower = next(b for b, names in named.items() if names == ["bending 1", "bogie heave"])
    upper = next(b for b, names in named.items() if names == ["bogie heave", "bending 1"])
    assert (frequency[upper] - frequency[lower]).min() > 0.15
    assert frequency[lower].is_monotonic_increasing
    assert frequency[upper].is_monotonic_increasing
    assert all(len(names) == 1 for b, names in named.items() if b not in {lower, upper})


def test_coarse_steps_find_the_same_ends_as_fine_ones():
    """Steps are halved until nothing is in doubt."""
    for varied in ({"c_2": np.geomspace(1e3, 1.9e5, 40)},
                   {"f_bending": np.linspace(7, 12, 40), "c_1": 300.0, "c_2": 1000.0},
                   {"c_1": np.geomspace(1e3, 1e6, 40)}):  # fmt: skip
        name = next(iter(varied))
        fine = mode_locus(paper_coach(2), **varied)
        coarse = mode_locus(paper_coach(2), **{**varied, name: varied[name][[0, -1]]})
        end = varied[name][-1]
        both = [curve[curve[name] == end].set_index("branch") for curve in (fine, coarse)]
        for branch in range(1, 8):  # those that are there from the first value on
            if branch in both[0].index and branch in both[1].index:
                a, b = (curve.loc[branch] for curve in both)
                assert_allclose([a["real"], a["imag"]], [b["real"], b["imag"]], rtol=1e-6)


def test_a_pair_that_becomes_real_goes_on_as_two():
    """A bogie's pitch is critical at c_1² = 2 k_1 I_b/l²; its roots' product stays 2 k_1 l²/I_b."""
    locus = mode_locus(paper_coach(1), c_1=np.linspace(100e3, 130e3, 31))
    pitching = locus[locus["label"] == "bogie pitch"]
    critical = np.sqrt(2 * 5e6 * 2000) / 1.25
    before, after = pitching[pitching["c_1"] < critical], pitching[pitching["c_1"] > critical]
    assert (before.groupby("c_1").size() == 2).all()
    assert (after.groupby("c_1").size() == 4).all()
    assert (after["imag"] == 0).all()
    assert set(before["branch"]) < set(after["branch"])
    product = after.groupby("c_1")["real"].prod() ** 0.5
    assert_allclose(product, 2 * 5e6 * 1.25**2 / 2000, rtol=1e-9)
    for rows in (rows for _, rows in after.groupby("branch")):
        assert rows["real"].is_monotonic_increasing or rows["real"].is_monotonic_decreasing


def test_real_eigenvalues_that_meet_become_a_pair_again():
    """c_2 so large that it locks: heave and bogies go on as one on the primary suspension."""
    locus = growing_dampers()
    heave = locus[(locus["label"] == "heave") & (locus["imag"] > 0)]
    low, high = heave[heave["c_2"] < 1e5], heave[heave["c_2"] > 5e5]
    assert set(low["branch"]).isdisjoint(high["branch"])
    last = locus[locus["c_2"] == locus["c_2"].max()]
    assert 2 * (last["imag"] > 0).sum() + (last["imag"] == 0).sum() == 14


def test_curves_are_continuous():
    """No step of a branch is longer than the steps beside it would have it: no jumps."""
    for locus in (crossing(), mode_locus(mounted(), k_d1=np.geomspace(1e5, 1e7, 60))):
        for branch, rows in locus.groupby("branch"):
            root = (rows["real"] + 1j * rows["imag"]).to_numpy()
            step = np.abs(np.diff(root)) / np.abs(root[1:])
            assert step.max() < 0.12, branch


def test_labels_hold_along_the_curves_of_growing_dampers():
    """Each motion of its own name until it mixes with others for good."""
    for varied in ({"c_1": np.geomspace(1e3, 1e7, 60)}, {"c_2": np.geomspace(1e2, 1.6e5, 40)}):
        locus = mode_locus(paper_coach(2), **varied)
        assert (locus.groupby("branch")["label"].nunique() == 1).all()


def test_keys_of_parameter_files_are_understood():
    locus = mode_locus(paper_coach(2), secondary_damping=[5e4, 6e4])
    assert locus.columns[0] == "c_2"
    assert locus.attrs["unit"] == "N s/m"
    assert mode_locus(paper_coach(2), k_theta=[3e8, 4e8]).attrs["unit"] == "N m/rad"


def test_settled_steps_are_not_halved(monkeypatch):
    solved = []
    monkeypatch.setattr(loci, "_point", lambda *a, once=loci._point: solved.append(a) or once(*a))
    mode_locus(paper_coach(2), k_2=np.linspace(6e5, 9e5, 10))
    assert len(solved) == 10


def test_doubt_that_never_ends_does_not_cost_without_end(monkeypatch):
    solved = []
    monkeypatch.setattr(loci, "_point", lambda *a, once=loci._point: solved.append(a) or once(*a))
    monkeypatch.setattr(loci, "ALIKE", 2.0)
    mode_locus(paper_coach(1), k_2=[6e5, 7e5, 8e5])
    assert len(solved) == 3 + 2 * loci.MOST_BETWEEN


@pytest.mark.parametrize(
    ("varied", "message"),
    [
        ({}, "no parameter with several values"),
        ({"c_2": 7e4}, "no parameter with several values"),
        ({"c_2": [1e4, 2e4], "k_2": [1e5, 2e5]}, "found c_2, k_2; expected one list"),
        ({"c_2": [[1e4, 2e4]]}, "expected one list"),
        ({"c_2": [1e4]}, "at least two finite values, ascending"),
        ({"c_2": [2e4, 1e4]}, "ascending"),
        ({"c_2": [1e4, 1e4]}, "each once"),
        ({"c_2": [1e4, np.nan]}, "finite"),
        ({"c_2": ["a", "b"]}, "numbers in SI units"),
        ({"c_3": [1e4, 2e4]}, r"found 'c_3'; expected one of .*c_1 \(primary damping per axle\)"),
        ({"k_2": [-1.0, 1e5]}, "k_2 = -1: .*above 0"),
        ({"c_2": [-5e3, 1e5]}, "c_2 = -5000: .*unstable"),
    ],
)
def test_bad_input(varied, message):
    with pytest.raises(InputError, match=message):
        mode_locus(paper_coach(2), **varied)
