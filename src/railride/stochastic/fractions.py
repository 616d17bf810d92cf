r"""Vehicles in partial fractions, many at once.

.. math:: y = s^p \sum_i g_i(s)\, w_i, \qquad g_i(s) = \sum_k \frac{r_{ik}}{s - p_k}, \qquad
          r_{ik} = (Y q_x v_k)\, (V^{-1} B (K_w + p_k C_w))_{ki}

for outputs y = Y d^p q/dt^p that do not feel the elevations w_i at once; p_k are the eigenvalues of
x' = A x + B F and V its eigenvectors v_k. Eigenvalues that coincide do no harm as long as their
eigenvectors do not: how far the fractions are from the equations of motion is measured.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Section 7.16.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from railride.firstorder import first_orders
from railride.numeric import Array, Matrices

Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class PartialFractions:
    """g of D vehicles.

    power : p. poles : (D, s). residues : (D, s, outputs · wheelsets). M, C, K (D, n, n), K_w, C_w
    (D, n, wheelsets), Y (D, n, outputs) : what they are of.
    """

    power: int
    poles: Complex
    residues: Complex
    M: Array
    C: Array
    K: Array
    K_w: Array
    C_w: Array
    Y: Array

    def __getitem__(self, some: slice) -> PartialFractions:
        """Some of the vehicles."""
        return replace(self, **{f.name: getattr(self, f.name)[some] for f in fields(self)[1:]})

    def response(self, s: Complex) -> Complex:
        """g at s, (N,), or at each vehicle's own s, (D, N): shape (D, N, outputs, wheelsets)."""
        return self.apart((1 / (s[..., np.newaxis] - self.poles[:, np.newaxis])) @ self.residues)

    def apart(self, flat: Complex) -> Complex:
        """Outputs and wheelsets as axes of their own: (D, N, outputs, wheelsets)."""
        return flat.reshape(*flat.shape[:2], self.Y.shape[-1], self.K_w.shape[-1])

    def mismatch(self, s: Complex) -> Array:
        """How far g is from the equations of motion at s (D, N), relative: (D, N, outputs).

        They are solved as they stand, (K + s C + s² M) q = (K_w + s C_w) w.
        """
        each = s[..., np.newaxis, np.newaxis]
        M, C, K, K_w, C_w, Y = (
            A[:, np.newaxis] for A in (self.M, self.C, self.K, self.K_w, self.C_w, self.Y)
        )
        row = np.swapaxes(np.linalg.solve(K + each * (C + each * M), Y.astype(complex)), -1, -2)
        direct = row @ (K_w + each * C_w)  # M, C, K are symmetric
        off = np.abs(self.response(s) - direct).max(axis=-1)
        return np.asarray(off / np.abs(direct).max(axis=-1))


def partial_fractions(m: Matrices, rows: Mapping[str, Array]) -> PartialFractions | None:
    """Of one or many vehicles; None where outputs are not of the form above.

    m, rows : ``VehicleModel.matrices`` and ``VehicleModel.output_rows``; with a leading axis, or
    the rows without one where they are the same for all.
    """
    felt = [p for p, name in enumerate("dva") if rows[name].any()]
    if len(felt) != 1 or any(rows[name].any() for name in ("w", "dw", "ddw")):
        return None
    x, row, wheelsets = first_orders(m), rows["dva"[felt[0]]], m.K_w.shape[-1]
    C_x, B_w = row @ x.q_x, x.B @ np.concatenate([m.K_w, m.C_w], axis=-1)
    if (C_x @ B_w[..., wheelsets:]).any():
        return None  # a coordinate without mass follows the elevations at once
    poles, V = (part.astype(complex) for part in np.linalg.eig(_many(x.A)))
    into = np.linalg.solve(V, _many(B_w).astype(complex))
    into = into[..., :wheelsets] + poles[..., np.newaxis] * into[..., wheelsets:]
    out = np.swapaxes(_many(C_x) @ V, -1, -2)
    residues = out[..., np.newaxis] * into[..., np.newaxis, :]
    Y = np.swapaxes(_many(row), -1, -2)
    return PartialFractions(
        power=felt[0],
        poles=poles,
        residues=residues.reshape(*poles.shape, -1),
        M=_many(m.M),
        C=_many(m.C),
        K=_many(m.K),
        K_w=_many(m.K_w),
        C_w=_many(m.C_w),
        Y=np.broadcast_to(Y, (len(poles), *Y.shape[1:])),
    )


def _many(A: Array) -> Array:
    """Matrices with one axis before their own."""
    return A.reshape(-1, *A.shape[-2:])
