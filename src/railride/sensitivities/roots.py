r"""Natural frequencies and damping ratios, and their gradients.

.. math:: \big(\lambda^2 M + \lambda C + K\big) \varphi = 0, \qquad
          d\lambda = -\frac{\varphi^T (\lambda^2 dM + \lambda\, dC + dK)\, \varphi}
                           {\varphi^T (2\lambda M + C)\, \varphi}

M, C and K are symmetric, so that φ is its own left eigenvector. Of an eigenvalue that is there m
times with as many eigenvectors Φ (two equal bogies that do not feel each other), the derivatives
are the eigenvalues of

.. math:: -\big(\Phi^T (2\lambda M + C) \Phi\big)^{-1}\, \Phi^T (\lambda^2 dM + \lambda\, dC + dK)\,
          \Phi ,

alike where the parameter belongs to both bogies. With them

.. math:: f = \frac{|\lambda|}{2\pi}, \quad \zeta = -\frac{\mathrm{Re}\,\lambda}{|\lambda|}, \quad
          d|\lambda| = \frac{\mathrm{Re}(\bar\lambda\, d\lambda)}{|\lambda|}, \quad
          d\zeta = -\frac{\mathrm{Re}\,d\lambda + \zeta\, d|\lambda|}{|\lambda|} .

Where two eigenvalues have one eigenvector between them (critical damping) they move with the root
of a parameter: there is no derivative.

Source: S. Adhikari, M.I. Friswell, Int. J. Numer. Meth. Engng 51 (2001) 1049-1060 (damped systems);
R.L. Dailey, AIAA J. 27 (1989) 486-491 (repeated eigenvalues).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.modal import Mode, solution
from railride.numeric import Array
from railride.sensitivities.derivatives import Tangent

Complex = NDArray[np.complex128]

LOST = 1e-6  # of its parts: a φᵀ(2λM + C)φ so small is that of an eigenvalue without a derivative


@dataclass(frozen=True, eq=False)
class Roots:
    """The modes of a vehicle, by frequency, and how they move with P parameters.

    modes : of ``railride.modes``. slopes : dλ/dp, (modes, P), NaN at critical damping.
    """

    modes: tuple[Mode, ...]
    slopes: Complex

    @property
    def names(self) -> tuple[str, ...]:
        """Label of every mode, and the bogies' phase."""
        return tuple(", ".join(filter(None, (m.label, m.phase))) for m in self.modes)

    @property
    def eigenvalues(self) -> Complex:
        """λ, Im λ ≥ 0, rad/s: (modes,)."""
        return np.array([mode.eigenvalue for mode in self.modes])

    @property
    def frequencies(self) -> Array:
        """|λ|/2π, Hz: (modes,)."""
        return np.array([mode.frequency_hz for mode in self.modes])

    @property
    def damping_ratios(self) -> Array:
        """-Re λ/|λ|: (modes,)."""
        return np.array([mode.damping_ratio for mode in self.modes])

    @property
    def frequency_slopes(self) -> Array:
        """df/dp, Hz per unit of p: (modes, P)."""
        root = self.eigenvalues[:, np.newaxis]
        return np.asarray((root.conj() * self.slopes).real / np.abs(root) / (2 * np.pi))

    @property
    def damping_slopes(self) -> Array:
        """dζ/dp: (modes, P)."""
        size, zeta = np.abs(self.eigenvalues), self.damping_ratios
        along = 2 * np.pi * self.frequency_slopes
        return -(self.slopes.real + zeta[:, np.newaxis] * along) / size[:, np.newaxis]


def roots_with_gradient(at: Tangent) -> Roots:
    """The modes of a vehicle and the derivatives of their eigenvalues.

    Parameters
    ----------
    at : the vehicle and its derivatives, ``Derivatives.at``.

    Raises
    ------
    InputError : an unstable vehicle.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> from railride.sensitivities import Derivatives
    >>> found = roots_with_gradient(Derivatives(derive_vehicle("cati2024", 1), ["k_2"]).at())
    >>> found.names[0], (found.frequency_slopes[0] * 750e3 / found.frequencies[0]).round(3).tolist()
    ('heave', [0.461])
    """
    found = solution(at.derivatives.model, at.m)
    kept, roots = found.kept, found.roots[found.kept]
    shapes = found.x.q_x @ found.vectors[:, kept]
    slopes = np.zeros((kept.size, len(at.parameters)), dtype=complex)
    for root in dict.fromkeys(roots.tolist()):
        equal = np.flatnonzero(roots == root)
        slopes[equal] = _slopes(at, root, shapes[:, equal])
    return Roots(found.modes, slopes)


def _slopes(at: Tangent, root: complex, shapes: Complex) -> Complex:
    """dλ/dp of one eigenvalue with its m shapes (n, m): (m, P), ascending by d|λ|."""
    m, dm = at.m, at.dm
    mass = shapes.T @ (2 * root * m.M + m.C) @ shapes
    size = np.abs(shapes).T @ (2 * abs(root) * np.abs(m.M) + np.abs(m.C)) @ np.abs(shapes)
    if np.linalg.svd(mass, compute_uv=False).min() < LOST * np.diagonal(size).min():
        return np.full((shapes.shape[1], len(at.parameters)), np.nan, dtype=complex)
    force = shapes.T @ (root**2 * dm["M"] + root * dm["C"] + dm["K"]) @ shapes  # (P, m, m)
    moved = -np.linalg.solve(mass, force)
    if shapes.shape[1] == 1:
        return np.asarray(moved[:, :, 0].T)
    slopes = np.linalg.eigvals(moved)
    order = np.argsort((np.conj(root) * slopes).real, axis=1, kind="stable")
    return np.asarray(np.take_along_axis(slopes, order, axis=1).T)
