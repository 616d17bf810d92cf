r"""The equations of motion in first order, x' = A x + B F, under a generalised force F.

Coordinates that carry mass are states with their rates. Coordinates that carry none (the point
between a damper and its elastic mount) are states alone: their rows of M are zero, and

.. math:: \dot q_m = C_{mm}^{-1} (F_m - C_{mI} \dot q_I - K_{mI} q_I - K_{mm} q_m),

.. math:: \ddot q_I = M_{II}^{-1} (F_I - C_{II} \dot q_I - C_{Im} \dot q_m
          - K_{II} q_I - K_{Im} q_m), \qquad x = (q_I, q_m, \dot q_I) .

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Section 7.9, with the rows
without mass solved for their rates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.numeric import Array, Matrices


@dataclass(frozen=True)
class FirstOrder:
    """x' = A x + B F with q = q_x x, q̇ = v_x x + v_f F and q̈ = a_x x + a_f F.

    A : (s, s). B : (s, n), as v_f and a_f. q_x, v_x, a_x : (n, s); rows of a_x and a_f without
    mass are zero. inertial : (n,), which coordinates carry mass. order : of the coordinates in x.
    """

    A: Array
    B: Array
    q_x: Array
    v_x: Array
    v_f: Array
    a_x: Array
    a_f: Array
    inertial: NDArray[np.bool_]
    order: NDArray[np.int_]

    def state(self, q: Array, dq: Array) -> Array:
        """The state at coordinates q and rates q̇ (n,)."""
        return np.concatenate([q[self.order], dq[self.inertial]])


def first_order(m: Matrices) -> FirstOrder:
    """The first-order form of one vehicle's matrices.

    Raises
    ------
    InputError : several vehicles at once; a mass matrix too ill-conditioned to be trusted; a
        coordinate that has neither mass nor damper.
    """
    if m.M.ndim != 2:
        raise InputError("parameters: found arrays; expected one vehicle at a time")
    return first_orders(m)


@np.errstate(over="ignore", invalid="ignore")  # refused where it comes to that
def first_orders(m: Matrices) -> FirstOrder:
    """The first-order form of one or many vehicles' matrices, (...,) before every shape.

    q_x and, where every coordinate carries mass, v_x and v_f are the same for all. Raises as
    :func:`first_order`, of many vehicles where one of them is so.
    """
    n, inertial, many = m.M.shape[-1], m.inertial, m.M.shape[:-2]
    i, r = np.flatnonzero(inertial), np.flatnonzero(~inertial)
    order = np.concatenate([i, r])
    s, k = n + len(i), len(i)
    q_x = np.zeros((n, s))
    q_x[order, np.arange(n)] = 1.0
    v_x, v_f = np.zeros((*many, n, s)), np.zeros((*many, n, n))
    v_x[..., i, n + np.arange(k)] = 1.0
    if r.size:
        inverse = _inverse_of_dampers(m.C[..., r[:, np.newaxis], r])
        v_x[..., r, :] = -inverse @ (m.C[..., r, :][..., i] @ v_x[..., i, :] + m.K[..., r, :] @ q_x)
        v_f[..., r[:, np.newaxis], r] = inverse
    inverse = _inverse_of_masses(m.M[..., i[:, np.newaxis], i])
    a_x, a_f = np.zeros((*many, n, s)), np.zeros((*many, n, n))
    a_x[..., i, :] = -inverse @ (m.C[..., i, :] @ v_x + m.K[..., i, :] @ q_x)
    a_f[..., i, :] = inverse @ (np.eye(n)[i] - m.C[..., i, :] @ v_f)
    A = np.concatenate([v_x[..., order, :], a_x[..., i, :]], axis=-2)
    B = np.concatenate([v_f[..., order, :], a_f[..., i, :]], axis=-2)
    if not np.isfinite(A).all():
        raise InputError(
            "parameters: found springs, dampers or masses too large or too small to calculate "
            "with; expected those of a vehicle (check their units)"
        )
    return FirstOrder(A, B, q_x, v_x, v_f, a_x, a_f, inertial, order)


def _inverse_of_masses(M: Array) -> Array:
    scale = 1 / np.sqrt(np.diagonal(M, axis1=-2, axis2=-1))
    scale = scale[..., :, np.newaxis] * scale[..., np.newaxis, :]
    scaled = scale * M
    try:
        inverse = np.linalg.inv(scaled)
    except np.linalg.LinAlgError:
        inverse = np.full_like(M, np.inf)
    condition = (np.abs(scaled).sum(axis=-1).max(axis=-1)
                 * np.abs(inverse).sum(axis=-1).max(axis=-1)).max()  # fmt: skip
    if not condition <= 1e12:
        raise InputError(
            f"M: found a mass matrix of condition {condition:.1e}; expected below 1e12 (masses and "
            "inertias of very different size: check their units)"
        )
    return np.asarray(scale * inverse, dtype=float)


def _inverse_of_dampers(C: Array) -> Array:
    if not (np.diagonal(C, axis1=-2, axis2=-1) > 0).all():
        raise InputError(
            "C: found a damper of 0 on an elastic mount; expected a damping above 0 (leave the "
            "mount's stiffness out where there is no damper)"
        )
    return np.asarray(np.linalg.inv(C), dtype=float)
