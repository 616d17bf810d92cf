r"""The free-free uniform Timoshenko beam: natural modes with shear and rotary inertia.

With the deflection w, the shear strain γ and the turn of the cross-section ψ = w' - γ,

.. math:: T = \tfrac12\int(\mu\dot w^2 + \rho I\,\dot\psi^2)\,dx, \qquad
          V = \tfrac12\int(EI\,\psi'^2 + \kappa GA\,\gamma^2)\,dx .

On u = 2x/L in [-1, 1], with h = L/2, r² = ρI/(μh²), s² = EI/(κGAh²), the strains are sums of
Legendre polynomials scaled to one, h²ψ' = Σ c_k P_k and hγ = s Σ g_k P_k, so that

.. math:: V = \tfrac12\frac{EI}{h^3}(|c|^2 + |g|^2), \qquad
          T = \tfrac12\mu h\,(\dot c, \dot g)\,M(r, s)\,(\dot c, \dot g)^T, \qquad
          \omega^2 = \frac{EI}{\mu h^4}\,\frac1{\nu},

ν the eigenvalues of the symmetric M, in which w and ψ are the strains' integrals, less the rigid
motions. The largest ν are the lowest modes: they are found to the last digits, nothing is stiff or
singular as s → 0 and r → 0, where the beam is Euler-Bernoulli's, and they converge faster than any
power of the polynomials' degree.

Source: S.P. Timoshenko, Phil. Mag. 41 (1921) 744-746; T.C. Huang, J. Appl. Mech. 28 (1961) 579-584.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike

from railride.numeric import Array

STEPS = 60  # of Newton's method: it doubles its digits from the first on, or goes on for ever


@dataclass(frozen=True, eq=False)
class ShearBeam:
    """Modes of beams of any ratios r² and s², each an array of shape S.

    eigenvalues : ω² μh⁴/EI, S + (n,), ascending. bending : the part of each mode's strain energy
    that is bending, S + (n,). coefficients : of φ in Legendre polynomials of u, S + (n, terms),
    scaled by ∫(φ² + r² h² ψ²) du = 2, φ > 0 at the front.
    """

    eigenvalues: Array
    bending: Array
    coefficients: Array

    def shapes(self, u: ArrayLike) -> Array:
        """φ_i at u = 2x/L, which broadcasts with S: (n, ...)."""
        return self._at(self.coefficients, u)

    def slopes(self, u: ArrayLike) -> Array:
        """dφ_i/du at u = 2x/L: (n, ...)."""
        rows = self.coefficients.shape[-1]
        derive = np.stack([np.append(legendre.legder(e), np.zeros(rows))[:rows]
                           for e in np.eye(rows)])  # fmt: skip
        return self._at(self.coefficients @ derive, u)

    @staticmethod
    def _at(coefficients: Array, u: ArrayLike) -> Array:
        points, terms = np.asarray(u, dtype=float), coefficients.shape[-1]
        basis = legendre.legvander(points, terms - 1).reshape(*points.shape, terms)
        return np.asarray(np.moveaxis((coefficients * basis[..., np.newaxis, :]).sum(-1), -1, 0))


def shear_beam(r_squared: ArrayLike, s_squared: ArrayLike, count: int) -> ShearBeam:
    """The first ``count`` modes.

    >>> (shear_beam(0.0, 0.0, 3).eigenvalues ** 0.25 * 2).round(6).tolist()  # βL, slender
    [4.730041, 7.853205, 10.995608]
    """
    r2, s = np.broadcast_arrays(np.asarray(r_squared, float), np.sqrt(np.asarray(s_squared, float)))
    r2, s = r2[..., np.newaxis, np.newaxis], s[..., np.newaxis]
    w, psi = _strained(count)
    half, squares = len(w) // 2, 2 / (2 * np.arange(w.shape[1]) + 1)

    def products(w: Array, psi: Array) -> Array:
        """∫(w w + r² hψ hψ) du of motions with one another."""
        return np.asarray((w * squares) @ w.swapaxes(-1, -2)
                          + r2 * (psi * squares) @ psi.swapaxes(-1, -2))  # fmt: skip

    # Less the rigid motions in it: a lift, w = P_0, and the turn with w = P_1 and hψ = P_0.
    turn = (w[:, 1:2] + 3 * r2 * psi[:, :1]) / (1 + 3 * r2)
    lift, first, second = w[:, :1], *np.eye(2, w.shape[1])[:, np.newaxis]
    w, psi = w - lift * first - turn * second, psi - turn * first
    scale = np.concatenate([np.ones((*s.shape[:-1], half)), s * np.ones(half)], axis=-1)
    M = products(w, psi) * scale[..., np.newaxis] * scale[..., np.newaxis, :]
    nu, vectors = np.linalg.eigh(M)
    nu, vectors = nu[..., : -count - 1 : -1], vectors[..., : -count - 1 : -1]
    strains = scale[..., np.newaxis] * vectors * np.sqrt(2 / nu)[..., np.newaxis, :]
    w, psi = (strains.swapaxes(-1, -2) @ of for of in (w, psi))
    # What rounding in M has left of products of different modes, 1e-11, goes with one step more.
    w = 1.5 * w - products(w, psi) @ w / 4
    front = np.sign(w.sum(axis=-1, keepdims=True))
    return ShearBeam(1 / nu, (vectors[..., :half, :] ** 2).sum(axis=-2), w * front)


@cache
def _strained(count: int) -> tuple[Array, Array]:
    """w and hψ under each strain, (strains, degree + 1) coefficients of Legendre polynomials.

    The strains are P_0 … of bending, then of shear, two for each mode and some to converge.
    """
    size = 2 * count + 21
    k = np.arange(size + 2)
    integral = np.diag(1 / (2 * k + 1))[:, :-1]  # of P_k: (P_{k+1} - P_{k-1})/(2k + 1)
    integral = np.pad(integral, ((0, 0), (1, 0)))
    integral[k[1:], k[:-1]] = -1 / (2 * k[1:] + 1)
    strains = np.sqrt(k + 0.5)[:size, np.newaxis] * np.eye(size, size + 2)
    once = strains @ integral
    return np.vstack([once @ integral, once]), np.vstack([once, np.zeros_like(once)])


def stiffness_for(
    frequency: Array, mass_per_length: Array, length: Array, shear_stiffness: Array,
    rotary_inertia: Array,
) -> Array:  # fmt: skip
    """EI for which the first natural frequency is as given, Hz; infinite where none is enough.

    Newton's method in log EI, in which log ω² is concave and its slope the bending part of the
    strain energy (Rayleigh's quotient): from the slender beam's EI, which is too small, it rises
    to the answer.
    """
    half = length / 2
    wanted = (2 * np.pi * frequency) ** 2 * mass_per_length * half**4
    stiffness = wanted / shear_beam(0.0, 0.0, 1).eigenvalues[0]
    r2 = rotary_inertia / (mass_per_length * half**2)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        for _ in range(STEPS):
            beam = shear_beam(r2, stiffness / (shear_stiffness * half**2), 1)
            low = wanted / (stiffness * beam.eigenvalues[..., 0])
            stiffness = stiffness * low ** (1 / beam.bending[..., 0])
            if np.all(np.abs(low - 1) < 1e-13):
                return np.asarray(stiffness)
    return np.asarray(np.where(np.abs(low - 1) < 1e-9, stiffness, np.inf))
