r"""Modes of the linear vehicle: natural frequencies, damping ratios, labelled shapes.

.. math:: (\lambda^2 M + \lambda C + K)\,\varphi = 0, \qquad f = \frac{|\lambda|}{2\pi}, \qquad
          \zeta = -\frac{\mathrm{Re}\,\lambda}{|\lambda|}

A mode is named after the free motion that holds most of its kinetic energy. The free body's heave,
pitch and bending shapes and the bogies' heave and pitch, b_k, are orthogonal in M and complete, so
that the shares |b_kᵀ M φ|² / (b_kᵀ M b_k · φ* M φ) add up to one.

Source: D.E. Newland, Mechanical Vibration Analysis and Computation, 1989, Chapters 6 and 8; the
shares are R.J. Allemang's modal assurance criterion with the mass matrix as weight.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError
from railride.firstorder import first_order
from railride.numeric import Array, Matrices, symmetric_eigenvalues
from railride.vehicle import VehicleModel

DAMPER = "damper"  # label of a real eigenvalue: a damper relaxing on its elastic mount
UNSTABLE = 1e-9  # of |λ|: a positive real part that is more than rounding


@dataclass(frozen=True)
class Mode:
    """One natural mode: an oscillating pair, or one real eigenvalue (damping ratio 1).

    frequency_hz: |λ|/2π. damping_ratio: -Re λ/|λ|. eigenvalue: λ with Im λ ≥ 0, rad/s.
    shape: φ in the model's coordinates, complex, largest entry 1. label: what moves most.
    share: the part of the mode's kinetic energy in motions of this name, 0 to 1.
    """

    frequency_hz: float
    damping_ratio: float
    label: str
    share: float
    eigenvalue: complex
    shape: NDArray[np.complex128]


def modes(model: VehicleModel, **changes: ArrayLike) -> tuple[Mode, ...]:
    """All modes of a vehicle, by frequency.

    Raises
    ------
    InputError : arrays among ``changes`` (one vehicle at a time); an unstable vehicle.

    Examples
    --------
    >>> from railride import load_vehicle, derive_vehicle
    >>> [mode.label for mode in modes(derive_vehicle(load_vehicle("cati2024"), segments=2))][:3]
    ['heave', 'pitch', 'bogie heave']
    """
    A = model.matrices(**changes)
    eigenvalues, vectors = eigen(A)
    refuse_unstable(eigenvalues)
    kept = eigenvalues.imag >= 0
    eigenvalues, shapes = eigenvalues[kept], first_order(A).q_x @ vectors[:, kept]
    order = np.argsort(np.abs(eigenvalues), kind="stable")
    eigenvalues, shapes = eigenvalues[order], shapes[:, order]
    labels, basis = free_motions(model, A)
    shares = _energy_shares(A.M, basis, shapes)
    named = _assign(shares, oscillating=eigenvalues.imag > 0)
    names = [DAMPER if k is None else labels[k] for k in named]
    return tuple(
        Mode(
            frequency_hz=float(abs(root) / (2 * np.pi)),
            damping_ratio=float(-root.real / abs(root)) if root else 0.0,
            label=names[k],
            share=float(sum(shares[i, k] for i, x in enumerate(labels) if x == names[k])),
            eigenvalue=complex(root),
            shape=shapes[:, k] / shapes[np.argmax(np.abs(shapes[:, k])), k],
        )
        for k, root in enumerate(eigenvalues)
    )


def undamped_frequencies(A: Matrices) -> Array:
    """Natural frequencies from K and M alone, Hz, ascending: shape (..., n)."""
    return np.asarray(np.sqrt(np.maximum(symmetric_eigenvalues(*A.condensed), 0)) / (2 * np.pi))


def eigen(A: Matrices) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Eigenvalues (s,) and eigenvectors (s, s) of x' = A x (see :mod:`railride.firstorder`).

    Raises
    ------
    InputError : several vehicles at once; a mass matrix too ill-conditioned to be trusted.
    """
    roots, vectors = np.linalg.eig(first_order(A).A)
    return roots.astype(complex), vectors.astype(complex)


def refuse_unstable(eigenvalues: NDArray[np.complex128]) -> None:
    """Raise :class:`InputError` if a mode grows with time."""
    growing = eigenvalues[eigenvalues.real > UNSTABLE * np.abs(eigenvalues).max()]
    if growing.size:
        root = growing[np.argmax(growing.real)]
        raise InputError(
            f"vehicle: found an unstable mode at {abs(root) / (2 * np.pi):.3g} Hz, growing with "
            f"{root.real:.3g} 1/s; expected every motion to decay (check the signs of stiffness "
            "and damping)"
        )


def free_motions(model: VehicleModel, A: Matrices) -> tuple[list[str], Array]:
    """Labels, and shapes as columns, of the free body's and the bogies' motions."""
    n, bogies = A.M.shape[-1], len(model.vehicle.bogies)
    inertial = int(A.inertial.sum())
    own = inertial - 2 * bogies
    labels = ["heave", "pitch", *(f"bending {k}" for k in range(1, own - 1))]
    basis = np.eye(n)[:, :inertial]
    basis[:own, :own] = _free_body_shapes(model, A.M[:own, :own])
    return labels + ["bogie heave", "bogie pitch"] * bogies, basis


def _free_body_shapes(model: VehicleModel, M: Array) -> Array:
    """Heave, pitch about the mass centre, and the bending shapes, as columns."""
    heave = model.lift[: len(M)]
    # Pitch: of a rigid body its second coordinate, else the nodes in line, from the front.
    x = np.array([0.0, 1.0]) if model.body.segments == 1 else np.linspace(0.5, -0.5, len(M))
    pitch = x - heave * (heave @ M @ x) / (heave @ M @ heave)
    K = model.free_body_stiffness()
    inverse = np.linalg.inv(np.linalg.cholesky(M))
    _, vectors = np.linalg.eigh(inverse @ K @ inverse.T)
    return np.column_stack([heave, pitch, inverse.T @ vectors[:, 2:]])


def _energy_shares(M: Array, basis: Array, shapes: NDArray[np.complex128]) -> Array:
    """Share of motion k in mode j: array (motions, modes); each column adds up to 1."""
    projection = np.abs(basis.T @ M @ shapes) ** 2
    own = np.einsum("ik,ij,jk->k", basis, M, basis)
    shares = projection / own[:, np.newaxis]
    return np.asarray(shares / shares.sum(axis=0))


def _assign(shares: Array, oscillating: NDArray[np.bool_]) -> list[int | None]:
    """The motion after which each mode is named: largest shares first, none given away twice.

    Each motion has two eigenvalues to give: an oscillating mode takes both, a real one takes one.
    What is left over is the relaxation of a damper on its mount.
    """
    left = np.full(shares.shape[0], 2)
    need = np.where(oscillating, 2, 1)
    named: list[int | None] = [None] * shares.shape[1]
    oscillating_first = np.where(oscillating, -shares, 1 - shares)
    for flat in np.argsort(oscillating_first, axis=None, kind="stable"):
        motion, mode = divmod(int(flat), shares.shape[1])
        if named[mode] is None and left[motion] >= need[mode]:
            named[mode] = motion
            left[motion] -= need[mode]
    return named
