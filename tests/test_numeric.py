"""Matrices of numbers from matrices of symbols."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import sympy as sp

from railride.errors import InputError
from railride.numeric import MatrixFunction, symmetric_eigenvalues

k, c = sp.symbols("k c")
A = sp.Matrix([[k, -k, 0], [-k, k + sp.sqrt(c), 3]])


def test_one_value_equals_substitution():
    found = MatrixFunction({"A": A})({"k": 2.0, "c": 9.0})["A"]
    np.testing.assert_array_equal(found, np.array(A.subs({k: 2, c: 9}).tolist(), dtype=float))


def test_arrays_broadcast_and_equal_one_by_one():
    f = MatrixFunction({"A": A, "B": sp.Matrix([[c]])})
    stiffness, damping = np.array([[1.0], [2.0]]), np.array([1.0, 4.0, 9.0])
    found = f({"k": stiffness, "c": damping})
    assert found["A"].shape == (2, 3, 2, 3)
    assert found["B"].shape == (2, 3, 1, 1)
    for i, j in np.ndindex(2, 3):
        one = f({"k": stiffness[i, 0], "c": damping[j]})
        np.testing.assert_array_equal(found["A"][i, j], one["A"])
        np.testing.assert_array_equal(found["B"][i, j], one["B"])


def test_constant_and_empty_matrices_take_the_common_shape():
    found = MatrixFunction({"A": A, "I": sp.eye(2), "none": sp.zeros(2, 0), "O": sp.zeros(1, 2)})(
        {"k": [1.0, 2.0, 3.0], "c": 1.0}
    )
    assert found["I"].shape == (3, 2, 2)
    np.testing.assert_array_equal(found["I"][1], np.eye(2))
    assert found["none"].shape == (3, 2, 0)
    np.testing.assert_array_equal(found["O"], np.zeros((3, 1, 2)))


def test_surplus_values_do_no_harm_and_missing_ones_are_named():
    f = MatrixFunction({"A": A})
    f({"k": 1, "c": 1, "other": np.ones(7)})
    with pytest.raises(InputError, match="no value of c"):
        f({"k": 1.0})


def test_symmetric_eigenvalues_equal_those_of_scipy():
    rng = np.random.default_rng(1)
    half = rng.normal(size=(4, 6, 6))
    K = half @ np.swapaxes(half, -1, -2)
    M = np.eye(6) + np.swapaxes(half, -1, -2) @ half
    found = symmetric_eigenvalues(M, K)
    assert found.shape == (4, 6)
    for row, m, s in zip(found, M, K, strict=True):
        np.testing.assert_allclose(row, scipy.linalg.eigh(s, m, eigvals_only=True), rtol=1e-10)
