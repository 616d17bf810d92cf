"""From symbols to numbers: matrices become vectorised functions of the parameters, once.

A changed parameter never derives again, and an array of parameters gives an array of matrices.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError

Array = NDArray[np.float64]
Values = Mapping[str, ArrayLike]

HELD = 1e-12  # of a matrix scaled to ones on its diagonal: below it no spring holds the motion
SPREAD = 1e13  # of ω²: above it rounding decides the lowest frequencies

FUNCTIONS = {name: getattr(np, name) for name in ("sqrt", "exp", "log", "sin", "cos", "tan")}


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
        self._evaluate = sp.lambdify(self.symbols, unique, modules=_namespace(unique))

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
        with np.errstate(over="ignore"):  # refused as soon as something is done with it
            found = self._evaluate(*arrays)
        if not shape:
            stacked = np.array(found, dtype=float)
        elif found:
            stacked = np.stack([np.broadcast_to(e, shape) for e in found], axis=-1)
        else:
            stacked = np.zeros((*shape, 0))
        result = {}
        for name, (places, numbers) in self._places.items():
            A = np.zeros((*shape, *self._shapes[name]))
            A[..., places[:, 0], places[:, 1]] = stacked[..., numbers]
            result[name] = A
        return result


class MatrixDerivative:
    r"""Named symbolic matrices differentiated along parameters, every symbol moving with them.

    .. math:: \frac{dA}{dp} = \sum_s \frac{\partial A}{\partial s} \frac{ds}{dp}

    Parameters
    ----------
    matrices : name → matrix, of any shapes.

    Calling it with name → value and name → ds/dp, (P,), gives name → array (P, rows, columns).

    >>> k, l = sp.symbols("k l")
    >>> derivative = MatrixDerivative({"K": sp.Matrix([[k, k * l]])})
    >>> derivative({"k": 2.0, "l": 3.0}, {"k": [1.0, 0.0], "l": [0.0, 1.0]})["K"].tolist()
    [[[1.0, 3.0]], [[0.0, 2.0]]]
    """

    def __init__(self, matrices: Mapping[str, sp.MatrixBase]) -> None:
        self._shapes = {name: A.shape for name, A in matrices.items()}
        entries = {name: A.todok() for name, A in matrices.items()}
        unique = {e for dok in entries.values() for e in dok.values()}
        symbols: set[sp.Symbol] = set().union(*(e.free_symbols for e in unique))
        self.symbols: tuple[sp.Symbol, ...] = tuple(sorted(symbols, key=lambda s: s.name))
        number = {symbol: k for k, symbol in enumerate(self.symbols)}
        slopes = {e: {number[s]: e.diff(s) for s in e.free_symbols} for e in unique}
        stacked = {}  # ∂A/∂s of every symbol s, one below the other
        for name, dok in entries.items():
            rows, columns = self._shapes[name]
            stacked[name] = sp.ImmutableSparseMatrix(len(number) * rows, columns, {
                (k * rows + i, j): slope
                for (i, j), e in dok.items() for k, slope in slopes[e].items()
            })  # fmt: skip
        self._partial = MatrixFunction(stacked)

    def __call__(self, values: Values, slopes: Values) -> dict[str, Array]:
        """The matrices' derivatives at the values; raises as :class:`MatrixFunction`."""
        partial = self._partial(values)
        if not self.symbols:
            count = np.size(next(iter(slopes.values()), ()))
            return {name: np.zeros((count, *shape)) for name, shape in self._shapes.items()}
        J = np.stack([np.asarray(slopes[s.name], dtype=float) for s in self.symbols], axis=-1)
        return {
            name: (J @ A.reshape(len(self.symbols), -1)).reshape(len(J), *self._shapes[name])
            for name, A in partial.items()
        }


@dataclass(frozen=True)
class Matrices:
    """M, C, K (..., n, n), K_w, C_w (..., n, wheelsets) and B_f (..., n, bogies) as numbers, SI.

    A coordinate without mass, the point between a damper and its mount, has zero rows in M.

    Raises
    ------
    InputError : M, C or K not symmetric, M not positive definite, or a uniform lift that strains:
        K u₀ = K_w 1 and C u₀ = C_w 1 must hold, u₀ the coordinates of a uniform lift.
    """

    M: Array
    C: Array
    K: Array
    K_w: Array
    C_w: Array
    B_f: Array
    lift: Array

    @property
    def by_name(self) -> dict[str, Array]:
        """The six matrices by name."""
        return {name: getattr(self, name) for name in ("M", "C", "K", "K_w", "C_w", "B_f")}

    @property
    def inertial(self) -> NDArray[np.bool_]:
        """Which coordinates carry mass, (n,): the others have zero rows in M."""
        return np.asarray((self.M != 0).any(axis=-1).reshape(-1, self.M.shape[-1]).any(axis=0))

    @property
    def condensed(self) -> tuple[Array, Array]:
        """M and K of the coordinates that carry mass, the others following without dampers.

        K_II - K_Im K_mm⁻¹ K_mI: what is left of the springs where nothing dampens.
        """
        own = self.inertial
        if own.all():
            return self.M, self.K
        M, K_II = self.M[..., own, :][..., own], self.K[..., own, :][..., own]
        K_Im, K_mm = self.K[..., own, :][..., ~own], self.K[..., ~own, :][..., ~own]
        return M, K_II - K_Im @ np.linalg.solve(K_mm, np.swapaxes(K_Im, -1, -2))

    def __post_init__(self) -> None:
        for name, A in self.by_name.items():
            if not np.isfinite(A).all():
                raise InputError(f"{name}: found a value that is no finite number; expected "
                                 "finite parameters, lengths other than zero")  # fmt: skip
        for name in ("M", "C", "K"):
            A = getattr(self, name)
            if np.abs(A - np.swapaxes(A, -1, -2)).max() > 1e-9 * np.abs(A).max():
                raise InputError(f"{name}: found a matrix that is not symmetric; expected "
                                 "springs and dampers between pairs of points")  # fmt: skip
        try:
            np.linalg.cholesky(self.condensed[0])
        except np.linalg.LinAlgError:
            raise InputError("M: found a mass matrix that is not positive definite; expected "
                             "positive masses and inertias") from None  # fmt: skip
        for name, A, A_w in (("K", self.K, self.K_w), ("C", self.C, self.C_w)):
            strain = np.abs(A @ self.lift - A_w.sum(axis=-1)).max()
            if strain > 1e-9 * max(np.abs(A).max(), 1e-300):
                raise InputError(f"{name}: found that a uniform lift of vehicle and track leaves "
                                 f"a force of {strain:.3g}; expected none")  # fmt: skip


def _namespace(expressions: Sequence[sp.Expr]) -> str | list[dict[str, Any]]:
    """What lambdify calls: numpy by hand, since all of it takes 0.1 s to load."""
    used = {f.func.__name__ for e in expressions for f in e.atoms(sp.Function)}
    return [FUNCTIONS] if used <= set(FUNCTIONS) else "numpy"


def symmetric_eigenvalues(M: Array, K: Array) -> Array:
    r"""Eigenvalues λ of K φ = λ M φ, ascending: shape (..., n) from (..., n, n).

    With M = L Lᵀ (Cholesky) they are those of L⁻¹ K L⁻ᵀ.
    """
    inverse = np.linalg.inv(np.linalg.cholesky(M))
    A = inverse @ K @ np.swapaxes(inverse, -1, -2)
    return np.asarray(np.linalg.eigvalsh((A + np.swapaxes(A, -1, -2)) / 2))


def refuse_untrustworthy(matrices: Matrices, coordinates: Sequence[str]) -> None:
    """Refuse a vehicle that a motion leaves without a spring, or that rounding would decide."""
    q, n = coordinates, matrices.K.shape[-1]
    K = matrices.K.reshape(-1, n, n)
    scale = np.sqrt(np.maximum(np.diagonal(K, axis1=-2, axis2=-1), np.finfo(float).tiny))
    scaled = K / (scale[:, :, np.newaxis] * scale[:, np.newaxis, :])
    held = np.linalg.eigvalsh(scaled)[:, 0]
    if held.min() < HELD:
        _, shapes = np.linalg.eigh(scaled[int(np.argmin(held))])
        loose = q[int(np.argmax(np.abs(shapes[:, 0])))]
        raise InputError(
            f"K: found a motion that no spring holds, mostly along {loose}; expected a vehicle "
            "that stands by itself (a bogie needs two wheelsets, or it can turn about one)"
        )
    M, stiffness = matrices.condensed
    own = np.flatnonzero(matrices.inertial)
    squares = symmetric_eigenvalues(M, stiffness).reshape(-1, own.size)
    # Rounding may even turn the lowest negative: that is as far apart as can be.
    lowest = np.maximum(squares[:, 0], 1e-30 * squares[:, -1])
    spread = squares[:, -1] / lowest
    if not (spread <= SPREAD).all():
        worst = int(np.argmax(spread))
        of = (-1, own.size, own.size)
        ratio = np.diagonal(stiffness.reshape(of)[worst]) / np.diagonal(M.reshape(of)[worst])
        raise InputError(
            f"M: found natural frequencies that differ by {np.sqrt(spread[worst]):.1e}, the "
            f"highest mostly along {q[own[int(np.argmax(ratio))]]}; expected less than "
            f"{np.sqrt(SPREAD):.0e}, or rounding decides the lowest (a mass, inertia or "
            "stiffness in the wrong unit?)"
        )
