"""From symbols to numbers: sympy expressions become vectorised numpy functions of the parameters, once.

A changed parameter never derives again, and an array of parameters gives an array of matrices.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError

Array = NDArray[np.float64]
Values = Mapping[str, ArrayLike]


class MatrixFunction:
    """Named symbolic matrices as one function of the parameters' values.

    Parameters
    ----------
    matrices : name → matrix, of any shapes. Entries that are equal are evaluated once.

    Calling it with name → value (scalars, or arrays that broadcast to a common shape S) gives
    name → array of shape (S..., rows, columns).

    >>> k, l = sp.symbols("k l")
    >>> f = MatrixFunction({"K": sp.Matrix([[k, -k], [-k, k + k * l]])})
    >>> f({"k": [1.0, 2.0], "l": 3.0})["K"].tolist()
    [[[1.0, -1.0], [-1.0, 4.0]], [[2.0, -2.0], [-2.0, 8.0]]]
    """

    def __init__(self, matrices: Mapping[str, sp.MatrixBase]) -> None:
        self._shapes = {name: A.shape for name, A in matrices.items()}
        entries = {name: A.todok() for name, A in matrices.items()}
        unique = list(dict.fromkeys(e for dok in entries.values() for e in dok.values()))
        number = {entry: k for k, entry in enumerate(unique)}
        self._places = {
            name: (
                np.array([[i, j] for i, j in dok], dtype=int).reshape(-1, 2),
                np.array([number[e] for e in dok.values()], dtype=int),
            )
            for name, dok in entries.items()
        }
        symbols: set[sp.Symbol] = set().union(*(e.free_symbols for e in unique))
        self.symbols: tuple[sp.Symbol, ...] = tuple(sorted(symbols, key=lambda s: s.name))
        self._evaluate = sp.lambdify(self.symbols, unique, modules="numpy")

    def __call__(self, values: Values) -> dict[str, Array]:
        """The matrices at the values.

        Raises
        ------
        InputError : a parameter that has no value.
        """
        missing = [s.name for s in self.symbols if s.name not in values]
        if missing:
            raise InputError(f"parameters: found no value of {', '.join(missing)}; expected one "
                             "for every symbol of the model")  # fmt: skip
        arrays = [np.asarray(values[s.name], dtype=float) for s in self.symbols]
        shape = np.broadcast_shapes(*(a.shape for a in arrays))
        entries = [np.broadcast_to(e, shape) for e in self._evaluate(*arrays)]
        stacked = np.stack(entries, axis=-1) if entries else np.zeros((*shape, 0))
        result = {}
        for name, (places, numbers) in self._places.items():
            A = np.zeros((*shape, *self._shapes[name]))
            A[..., places[:, 0], places[:, 1]] = stacked[..., numbers]
            result[name] = A
        return result


def evaluate(expressions: Mapping[str, sp.Expr], values: Values) -> dict[str, Array]:
    """Scalar expressions at the values: name → array."""
    found = MatrixFunction({name: sp.Matrix([[e]]) for name, e in expressions.items()})(values)
    return {name: A[..., 0, 0] for name, A in found.items()}


def symmetric_eigenvalues(M: Array, K: Array) -> Array:
    r"""Eigenvalues λ of K φ = λ M φ, ascending: shape (..., n) from (..., n, n).

    With M = L Lᵀ (Cholesky) they are those of L⁻¹ K L⁻ᵀ.
    """
    inverse = np.linalg.inv(np.linalg.cholesky(M))
    A = inverse @ K @ np.swapaxes(inverse, -1, -2)
    return np.asarray(np.linalg.eigvalsh((A + np.swapaxes(A, -1, -2)) / 2))


def names(symbols: Sequence[sp.Symbol]) -> list[str]:
    """The names of symbols."""
    return [s.name for s in symbols]
