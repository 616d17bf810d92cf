r"""Joint stiffnesses that give a free chain of segments several bending frequencies.

From k⁰ they change as little as can be: the smallest Σ p_j², k_j = k_j⁰ exp p_j, for which
ω_i² = (2π f_i)². With the joints' turns γ_ij in mode i, scaled by φ_iᵀ M φ_i = 1,

.. math:: \frac{\partial \ln \omega_i^2}{\partial p_j} = \frac{k_j \gamma_{ij}^2}{\omega_i^2}
          = A_{ij}, \qquad p \leftarrow A^+ (\ln (2\pi f)^2 - \ln\omega^2 + A p)

with the pseudo-inverse A⁺, whose result is the shortest p that meets the frequencies to the first
order. They are approached in as many stages as it takes. A symmetric body stays symmetric, though
unlike ends may sometimes change it less.

Source: R.L. Fox, M.P. Kapoor, AIAA Journal 6 (1968), 2426-2429 (sensitivities); J. Nocedal, S.J.
Wright, Numerical Optimization, 2nd ed., Chapter 18.
"""

from __future__ import annotations

import numpy as np

from railride.errors import InputError
from railride.numeric import Array

STEPS = 30  # in one stage
LEAST = 1 / 64  # of the way to the frequencies in one stage
MET, ROUNDING = 1e-12, 1e-14  # of ω²; and of the largest ω²
STRIDE = 1.0  # of any p in one step
RANK = 1e-8  # of A's largest singular value: what is below it the joints do not reach


def calibrated(M: Array, G: Array, start: Array, targets: Array) -> Array:
    """Stiffnesses k, (..., J), whose first bending frequencies are the targets.

    Parameters
    ----------
    M : (..., n, n) mass matrix of the free chain. G : (..., J, n) rows of the joints' turns.
    start : (..., J) k⁰. targets : (..., m) in Hz, ascending.

    Raises
    ------
    InputError : frequencies that no stiffnesses near k⁰ give, with those that were reached.
    """
    lead = np.broadcast_shapes(M.shape[:-2], G.shape[:-2], start.shape[:-1], targets.shape[:-1])
    M, G = (np.broadcast_to(A, lead + A.shape[-2:]) for A in (M, G))
    start, targets = (np.broadcast_to(v, lead + v.shape[-1:]) for v in (start, targets))
    found = np.empty_like(start)
    for case in np.ndindex(lead):
        found[case] = _one(M[case], G[case], start[case], targets[case])
    return found


def _one(M: Array, G: Array, start: Array, targets: Array) -> Array:
    turns = G @ np.linalg.inv(np.linalg.cholesky(M)).T
    mirrored = _is_mirrored(M) and _is_mirrored(G) and _is_mirrored(start)
    p, (begun, _, _) = np.zeros_like(start), _modes(turns, start, len(targets))
    begun, wanted = np.log(begun), np.log((2 * np.pi * targets) ** 2)
    done, stage = 0.0, 1.0
    while done < 1:
        found = _settled(turns, start, p, begun + (done + stage) * (wanted - begun), mirrored)
        if found is not None:
            p, done = found, done + stage
            stage = min(2 * stage, 1 - done)
        elif stage > LEAST:
            stage /= 2
        else:
            reached = np.sqrt(_modes(turns, start * np.exp(p), len(targets))[0]) / (2 * np.pi)
            raise InputError(
                f"body.bending_frequencies: found {_listed(targets)}, which {len(start)} joints "
                f"cannot have; expected frequencies nearer to {_listed(reached)}, as far as they "
                "reach (fewer of them, or more segments)"
            )
    return np.asarray(start * np.exp(p))


def _settled(turns: Array, start: Array, p: Array, wanted: Array, mirrored: bool) -> Array | None:
    """The shortest p that has these ln ω²; None where the steps do not lead to one."""
    for _ in range(STEPS):
        squares, A, largest = _modes(turns, start * np.exp(p), len(wanted))
        away = wanted - np.log(squares)
        step = np.linalg.pinv(A, rcond=RANK) @ (away + A @ p) - p
        step = (step + step[::-1]) / 2 if mirrored else step
        limit = max(MET, ROUNDING * largest / squares[0])
        if np.abs(away).max() < limit and np.abs(step).max() < np.sqrt(limit):
            return p
        p = p + step * min(1.0, STRIDE / max(np.abs(step).max(), STRIDE))
    return None


def _modes(turns: Array, k: Array, count: int) -> tuple[Array, Array, float]:
    """ω² of the first bending modes, (count,), A, (count, J), and the largest ω².

    turns : (J, n), G by coordinates in which M is the unit matrix.
    """
    squares, shapes = np.linalg.eigh(turns.T @ (k[:, np.newaxis] * turns))
    first, gamma = squares[2 : 2 + count], (turns @ shapes)[:, 2 : 2 + count]
    return first, k * gamma.T**2 / first[:, np.newaxis], float(squares[-1])


def _is_mirrored(array: Array) -> bool:
    """Whether front and rear are alike."""
    return bool(np.abs(array - np.flip(array)).max() <= 1e-9 * np.abs(array).max())


def _listed(frequencies: Array) -> str:
    return ", ".join(f"{f:.4g} Hz" for f in frequencies)
