r"""From large mass and stiffness matrices to a few motions: natural modes, and Craig–Bampton.

The lowest natural modes of a free structure solve

.. math:: K \varphi = \omega^2 M \varphi .

They are found from the largest ν of :math:`M\varphi = \nu (K + \sigma M)\varphi`,
:math:`\nu = 1/(\omega^2 + \sigma)`, since K does not hold the rigid motions and M may be singular,
but K + σM is positive definite. With σ near the first ω² of a flexible mode these have most digits.

Craig and Bampton span the motion by what the interfaces b do to the interior i, and by the modes of
the interior while the interfaces are held,

.. math:: \begin{pmatrix} u_b \\ u_i \end{pmatrix} = \begin{pmatrix} 1 & 0 \\
          -K_{ii}^{-1} K_{ib} & \Phi_i \end{pmatrix} \begin{pmatrix} u_b \\ \eta_i \end{pmatrix},
          \qquad K_{ii} \Phi_i = M_{ii} \Phi_i \Omega_i^2 ,

so that a static force on an interface bends the body exactly.

Modes of large matrices are counted, by the signs of the pivots of K - ω²M, so that none is missed.

Sources: R. R. Craig, M. C. C. Bampton, Coupling of substructures for dynamic analyses, AIAA Journal
6 (1968) 1313–1319; B. N. Parlett, The Symmetric Eigenvalue Problem, SIAM 1998, Sections 3.3, 15.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.numeric import Array

SIGMA = (2 * np.pi * 5.0) ** 2  # 1/s²: between a car body's rigid motions and its bending
DENSE = 100  # coordinates up to which dense matrices are as quick as sparse ones

NONE = (
    "car body: found masses and stiffnesses along it from which no natural modes can be computed; "
    "expected those of a car body (check their units)"
)

Matrix = Any  # a square matrix, dense or of scipy.sparse


def lowest_modes(M: Matrix, K: Matrix, count: int) -> tuple[Array, Array]:
    """The lowest ω² (count,), 1/s², ascending, and their modes (n, count), φᵀMφ = 1.

    Rigid motions are among them, their ω² zero but for rounding, some 1e-16 of the highest ω².

    Parameters
    ----------
    M, K : (n, n), symmetric, positive semi-definite; no motion has neither mass nor stiffness.
    count : at most n.

    Raises
    ------
    InputError : masses and stiffnesses so far apart that no modes can be computed.

    Examples
    --------
    >>> squares, modes = lowest_modes(np.diag([2.0, 1.0]), 800 * np.array([[1, -1], [-1, 1]]), 2)
    >>> abs(squares.round(6)).tolist()
    [0.0, 1200.0]
    """
    large = M.shape[0] > max(DENSE, 4 * count)
    try:
        squares, modes = (_by_lanczos if large else _at_once)(M, K, count)
        order = np.argsort(squares)
        squares, modes = squares[order], modes[:, order]
        missed = large and _misses_some(M, K, squares)
    except (RuntimeError, np.linalg.LinAlgError):  # of SuperLU and ARPACK; of LAPACK
        raise InputError(NONE) from None
    if missed:
        squares, modes = lowest_modes(M, K, 2 * count + DENSE)
    return squares[:count], modes[:, :count]


def negative_eigenvalues(A: Matrix) -> int:
    """How many a symmetric matrix has: as many as negative pivots (Sylvester's law of inertia)."""
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu

    factors = splu(csc_array(A), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0,
                   options={"SymmetricMode": True})  # fmt: skip
    return int((factors.U.diagonal() < 0).sum())


def _misses_some(M: Matrix, K: Matrix, squares: Array) -> bool:
    """Whether there are more ω² below the highest than were found: Lanczos may miss equal ones."""
    below = squares[-1] - 1e-6 * (squares[-1] + SIGMA)
    return negative_eigenvalues(K - below * M) != np.count_nonzero(squares < below)


def _at_once(M: Matrix, K: Matrix, count: int) -> tuple[Array, Array]:
    from scipy import linalg

    M, K, n = _dense(M), _dense(K), M.shape[0]
    nu, modes = linalg.eigh(M, K + SIGMA * M, subset_by_index=(n - count, n - 1))
    return 1 / nu - SIGMA, modes / np.sqrt(nu)


def _by_lanczos(M: Matrix, K: Matrix, count: int) -> tuple[Array, Array]:
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import eigsh

    start = np.random.default_rng(0).standard_normal(M.shape[0])  # the same on every run
    found: tuple[Array, Array] = eigsh(csc_array(K), count, csc_array(M), sigma=-SIGMA, v0=start)
    return found


def craig_bampton(M: Matrix, K: Matrix, interfaces: NDArray[np.intp], fixed: int) -> Array:
    """T (n, interfaces + fixed) of Craig and Bampton, u = T (u_b, η_i).

    Parameters
    ----------
    M, K : (n, n), as in :func:`lowest_modes`.
    interfaces : which coordinates are the interfaces; held, they leave no rigid motion.
    fixed : how many modes with the interfaces held are kept.
    """
    from scipy.sparse import csc_array
    from scipy.sparse.linalg import splu

    M, K = csc_array(M), csc_array(K)
    interior = np.setdiff1d(np.arange(M.shape[0]), interfaces)
    K_ii, K_ib = K[interior][:, interior], K[interior][:, interfaces]
    T = np.zeros((M.shape[0], len(interfaces) + fixed))
    T[interfaces, : len(interfaces)] = np.eye(len(interfaces))
    T[interior, : len(interfaces)] = -splu(csc_array(K_ii)).solve(K_ib.toarray())
    if fixed:
        T[interior, len(interfaces) :] = lowest_modes(M[interior][:, interior], K_ii, fixed)[1]
    return T


def _dense(A: Matrix) -> Array:
    """The matrix as an array."""
    return np.asarray(A.toarray() if hasattr(A, "toarray") else A, dtype=float)
