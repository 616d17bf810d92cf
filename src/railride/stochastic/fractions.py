r"""Vehicles in partial fractions, many at once.

.. math:: y = s^p \sum_i g_i(s)\, w_i, \qquad
          g_i(s) = \sum_k \frac{r_{ik}}{s - p_k} + \sum_j d_{ij} s^j, \qquad
          r_{ik} = (C_x v_k)\, (V^{-1} B (K_w + p_k C_w))_{ki}

for outputs y of the state x and of what acts at once: p_k are the eigenvalues of x' = A x + B F, V
its eigenvectors v_k and F = (K_w + s C_w) w. With q = q_x x, outputs that are d^p/dt^p of one
thing, Y q + W w, have

.. math:: C_x = Y q_x, \qquad d_0 = C_x B C_w + W,

and others, with y = C_x x + E F + (W_0 + s W_1 + s² W_2) w and p = 0,

.. math:: d_0 = C_x B C_w + E K_w + W_0, \quad d_1 = E C_w + W_1, \quad d_2 = W_2 .

The entries of the matrices are rounded. Where they differ by many powers of ten, as with a spring
that is next to rigid, what the small ones say is lost in the large ones, which moves p_k by up to

.. math:: \varepsilon\, |u_k| \big(|K| + |p_k| |C| + |p_k|^2 |M|\big) |q_x v_k|, \qquad
          u_k = (V^{-1} B)_{k\cdot}

with the absolute values of the entries, and as computed by at least ε max|p|.

Eigenvalues that coincide do no harm as long as their eigenvectors do not: how far the fractions are
from the equations of motion is measured.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Section 7.16, with what the
elevations do at once (a primary deflection's own, a wheel load's wheelset) kept beside the modes;
F. Tisseur, Linear Algebra Appl. 309 (2000) 339-361 (eigenvalues of rounded matrices).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from railride.firstorder import FirstOrder, first_orders
from railride.numeric import Array, Matrices

Complex = NDArray[np.complex128]

_EPSILON = float(np.finfo(float).eps)
_PAIRS = (("d", "w"), ("v", "dw"), ("a", "ddw"))  # rows that feel the p-th rates of q and w


@dataclass(frozen=True, eq=False)
class EigenForms:
    """D vehicles in their eigenvectors, for all of their outputs.

    m : their matrices. x : their first-order form. poles : p_k (D, s). vectors : V (D, s, s).
    into : V⁻¹ B (K_w + p C_w), (D, s, wheelsets). moved : how far rounding may have moved each of
    the poles, rad/s, (D, s).
    """

    m: Matrices
    x: FirstOrder
    poles: Complex
    vectors: Complex
    into: Complex
    moved: Array


def eigen_forms(m: Matrices) -> EigenForms:
    """Of one or many vehicles; where one has too few eigenvectors, its fractions are none."""
    x = first_orders(m)
    poles, V = (part.astype(complex) for part in np.linalg.eig(_many(x.A)))
    B = _many(x.B)
    try:
        u = np.linalg.solve(V, B.astype(complex))
    except np.linalg.LinAlgError:  # two eigenvectors are one to the last bit
        u = np.linalg.pinv(V) @ B
    with np.errstate(all="ignore"):  # what comes of it is not finite, and not trusted
        into = u @ _many(m.K_w) + poles[..., np.newaxis] * (u @ _many(m.C_w))
        moved = _EPSILON * np.maximum(np.abs(poles).max(axis=-1, keepdims=True),
                                      _felt(m, np.abs(poles), u, x.q_x @ V))  # fmt: skip
    return EigenForms(m, x, poles, V, into, moved)


def _felt(m: Matrices, size: Array, u: Complex, q: Complex) -> Array:
    """|u_k| (|K| + |p_k| |C| + |p_k|² |M|) |q_k|, (D, s), of q (D, n, s) and |p| (D, s)."""
    q, size = np.abs(q), size[:, np.newaxis]
    force = np.abs(_many(m.K)) @ q
    force += size * (np.abs(_many(m.C)) @ q + size * (np.abs(_many(m.M)) @ q))
    return np.asarray((np.abs(u) * np.swapaxes(force, -1, -2)).sum(axis=-1))


@dataclass(frozen=True, eq=False)
class PartialFractions:
    """g of D vehicles.

    power : p. poles, moved : (D, s). residues : (D, s, outputs · wheelsets). direct : d (D, terms,
    outputs · wheelsets), none where all vanish. M, C, K (D, n, n), K_w, C_w (D, n, wheelsets) :
    what they are of; and Y (D, terms, n, outputs), W (D, terms, outputs, wheelsets), polynomials in
    s, by which g = Y q + W w.
    """

    power: int
    poles: Complex
    moved: Array
    residues: Complex
    direct: Array
    M: Array
    C: Array
    K: Array
    K_w: Array
    C_w: Array
    Y: Array
    W: Array

    def __getitem__(self, some: slice) -> PartialFractions:
        """Some of the vehicles."""
        return replace(self, **{f.name: getattr(self, f.name)[some] for f in fields(self)[1:]})

    def response(self, s: Complex) -> Complex:
        """g at s, (N,), or at each vehicle's own s, (D, N): shape (D, N, outputs, wheelsets)."""
        found = np.reciprocal(s[..., np.newaxis] - self.poles[:, np.newaxis]) @ self.residues
        if self.direct.shape[1]:
            found += s[..., np.newaxis] ** np.arange(self.direct.shape[1]) @ self.direct
        return self.apart(found)

    def apart(self, flat: Complex) -> Complex:
        """Outputs and wheelsets as axes of their own: (D, N, outputs, wheelsets)."""
        return flat.reshape(*flat.shape[:2], *self.W.shape[-2:])

    def mismatch(self, s: Complex) -> Array:
        """How far g is from the equations of motion at s (D, N), relative: (D, N, outputs).

        They are solved as they stand, (K + s C + s² M) q = (K_w + s C_w) w.
        """
        each = s[..., np.newaxis, np.newaxis]
        M, C, K, K_w, C_w = (A[:, np.newaxis] for A in (self.M, self.C, self.K, self.K_w, self.C_w))
        column = np.linalg.solve(K + each * (C + each * M), _polynomial(self.Y, each))
        row = np.swapaxes(column, -1, -2)  # M, C, K are symmetric
        exact = row @ (K_w + each * C_w) + _polynomial(self.W, each)
        off = np.abs(self.response(s) - exact).max(axis=-1)
        return np.asarray(off / np.abs(exact).max(axis=-1))


def partial_fractions(of: EigenForms, rows: Mapping[str, Array]) -> PartialFractions:
    """Of one or many vehicles.

    rows : ``VehicleModel.output_rows``; with a leading axis, or without one where they are the same
    for all.
    """
    x, m = of.x, of.m
    felt = [p for p, pair in enumerate(_PAIRS) if any(rows[name].any() for name in pair)]
    if len(felt) == 1:
        q, w = _PAIRS[felt[0]]
        Y, W = [rows[q]], [rows[w]]
        C_x, direct = rows[q] @ x.q_x, [rows[w]]
    else:
        Y, W = ([rows[pair[k]] for pair in _PAIRS] for k in (0, 1))
        C_x = rows["d"] @ x.q_x + rows["v"] @ x.v_x + rows["a"] @ x.a_x
        E = rows["v"] @ x.v_f + rows["a"] @ x.a_f
        direct = [E @ m.K_w + W[0], E @ m.C_w + W[1], W[2]]
    direct[0] = direct[0] + C_x @ (x.B @ m.C_w)
    while direct and not direct[-1].any():
        direct.pop()
    D, wheelsets = len(of.poles), m.K_w.shape[-1]
    out = np.swapaxes(_many(C_x) @ of.vectors, -1, -2)
    residues = out[..., np.newaxis] * of.into[..., np.newaxis, :]
    outputs = out.shape[-1] * wheelsets
    return PartialFractions(
        power=felt[0] if len(felt) == 1 else 0,
        poles=of.poles,
        moved=of.moved,
        residues=residues.reshape(*of.poles.shape, -1),
        direct=_terms(direct, D).reshape(D, -1, outputs) if direct else np.zeros((D, 0, outputs)),
        M=_many(m.M),
        C=_many(m.C),
        K=_many(m.K),
        K_w=_many(m.K_w),
        C_w=_many(m.C_w),
        Y=np.swapaxes(_terms(Y, D), -1, -2),
        W=_terms(W, D),
    )


def _polynomial(coefficients: Array, s: Complex) -> Complex:
    """Σ_j c_j s^j: shape (D, N, a, b) of coefficients (D, terms, a, b) at s (D, N, 1, 1)."""
    value = coefficients[:, np.newaxis, -1].astype(complex)
    for j in reversed(range(coefficients.shape[1] - 1)):
        value = value * s + coefficients[:, np.newaxis, j]
    return np.asarray(value)


def _terms(matrices: list[Array], count: int) -> Array:
    """Matrices as terms of each vehicle's own: (count, terms, a, b)."""
    found = [np.broadcast_to(_many(A), (count, *A.shape[-2:])) for A in matrices]
    return found[0][:, np.newaxis] if len(found) == 1 else np.stack(found, axis=1)


def _many(A: Array) -> Array:
    """Matrices with one axis before their own."""
    return A.reshape(-1, *A.shape[-2:])
