r"""Modes of the linear vehicle: natural frequencies, damping ratios, labelled shapes.

.. math:: (\lambda^2 M + \lambda C + K)\,\varphi = 0, \qquad f = \frac{|\lambda|}{2\pi}, \qquad
          \zeta = -\frac{\mathrm{Re}\,\lambda}{|\lambda|}

A mode is named after what moves, see :mod:`railride.naming`.

Source: D.E. Newland, Mechanical Vibration Analysis and Computation, 1989, Chapters 6 and 8.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError
from railride.firstorder import FirstOrder, first_order
from railride.naming import DAMPER, Motions, free_motions, motions, names, participation, settled
from railride.numeric import Array, Matrices, symmetric_eigenvalues
from railride.vehicle import VehicleModel

__all__ = ["DAMPER", "UNSTABLE", "Mode", "Solution", "eigen", "free_motions", "modes",
           "refuse_rounded", "refuse_unstable", "solution", "solve",
           "undamped_frequencies"]  # fmt: skip

UNSTABLE = 1e-9  # of |λ|: a positive real part that is more than rounding
ROUNDED = 2e-10  # of the largest |λ|: below it rounding, 2e-16 of that, takes a mode's sixth digit
FOREMOST = 1 - 1e-6  # of the largest entry: what is as large is equal to it


@dataclass(frozen=True)
class Mode:
    """One natural mode: an oscillating pair, or one real eigenvalue (damping ratio 1).

    frequency_hz: |λ|/2π. damping_ratio: -Re λ/|λ|. eigenvalue: λ with Im λ ≥ 0, rad/s.
    shape: φ in the model's coordinates, complex, largest entry 1. label: what moves most.
    share: the part of the mode's kinetic energy in motions of this name, 0 to 1; of a real
    eigenvalue, which has hardly any, weighed with their participation (:mod:`railride.naming`).
    phase: "in phase" or "anti-phase" where neighbouring bogies move with or against each other in a
    mode of theirs, else "".
    """

    frequency_hz: float
    damping_ratio: float
    label: str
    share: float
    eigenvalue: complex
    shape: NDArray[np.complex128]
    phase: str = ""


def modes(model: VehicleModel, **changes: ArrayLike) -> tuple[Mode, ...]:
    """All modes of a vehicle, by frequency.

    Where eigenvalues are repeated, as of bogies that do not feel each other, the shapes are those
    in which the bogies move in phase and in anti-phase.

    Raises
    ------
    InputError : arrays among ``changes`` (one vehicle at a time); an unstable vehicle; modes that
        rounding decides.

    Examples
    --------
    >>> from railride import load_vehicle, derive_vehicle
    >>> [mode.label for mode in modes(derive_vehicle(load_vehicle("cati2024"), segments=2))][:3]
    ['heave', 'pitch', 'bogie heave']
    """
    return solve(model, **changes).modes


@dataclass(frozen=True, eq=False)
class Solution:
    """The eigenvalues of a stable vehicle and its modes.

    roots : (s,), all, by |λ|. vectors : (s, s) as columns.
    kept : which of them the modes are, in their order.
    """

    A: Matrices
    x: FirstOrder
    free: Motions
    roots: NDArray[np.complex128]
    vectors: NDArray[np.complex128]

    @property
    def kept(self) -> NDArray[np.int_]:
        """The places of the modes among the roots: Im λ ≥ 0."""
        return np.flatnonzero(self.roots.imag >= 0)

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Every mode, named."""
        roots, shapes = self.roots[self.kept], self.x.q_x @ self.vectors[:, self.kept]
        parts = participation(self.free, self.x, self.vectors)[:, self.kept]
        strokes = int((~self.x.inertial).sum())
        named = names(self.free, self.A.M, shapes, roots.imag > 0, parts, strokes)
        return tuple(
            Mode(
                frequency_hz=float(abs(root) / (2 * np.pi)),
                damping_ratio=float(-root.real / abs(root)),
                label=name.label,
                share=name.share,
                eigenvalue=complex(root),
                shape=_largest_one(shape),
                phase=name.phase,
            )
            for root, shape, name in zip(roots, shapes.T, named, strict=True)
        )


def solve(model: VehicleModel, **changes: ArrayLike) -> Solution:
    """The eigenvalue problem of one vehicle, solved; raises as :func:`modes` does."""
    return solution(model, model.matrices(**changes))


def solution(model: VehicleModel, A: Matrices) -> Solution:
    """The eigenvalue problem of a model's matrices in hand, solved; raises as :func:`modes`."""
    x, free = first_order(A), motions(model, A)
    roots, vectors = eigen(A)
    refuse_unstable(roots)
    refuse_rounded(roots)
    roots, vectors = settled(free, A, x, roots, vectors)
    order = np.argsort(np.abs(roots), kind="stable")
    return Solution(A, x, free, roots[order], vectors[:, order])


def _largest_one(shape: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The shape with its largest entry 1: the foremost of several that are equal."""
    size = np.abs(shape)
    return np.asarray(shape / shape[int(np.argmax(size >= FOREMOST * size.max()))])


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


def refuse_rounded(eigenvalues: NDArray[np.complex128]) -> None:
    """Raise :class:`InputError` if rounding decides a mode, beside the largest of them."""
    low, high = np.abs(eigenvalues).min() / (2 * np.pi), np.abs(eigenvalues).max() / (2 * np.pi)
    if low < ROUNDED * high:
        raise InputError(
            f"vehicle: found modes at {low:.3g} and {high:.3g} Hz, so far apart that rounding "
            "decides the lower; expected springs, dampers and masses that differ by fewer powers "
            "of ten (check their units)"
        )


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
