"""Car bodies as a finite-element department hands them over, assembled here by hand."""

from __future__ import annotations

import numpy as np

L, EI, MU, ELEMENTS = 24.0, 3e9, 1400.0, 48
MASS, INERTIA = MU * L, MU * L**3 / 12
BETA_L = np.array([4.730040744862704, 7.853204624095838, 10.995607838001671,
                   14.137165491257464, 17.27875965739948])  # fmt: skip
CLOSED = BETA_L**2 / L**2 * np.sqrt(EI / MU) / (2 * np.pi)
# What the elements make of it: their leading error is (βh)⁴/720 of ω².
ELEMENTS_HZ = CLOSED * (1 + (BETA_L / ELEMENTS) ** 4 / 1440)


def beam_matrices(EI=EI, mu=MU, n=ELEMENTS):
    """M and K of the free uniform beam: w and w' at each node, by the textbook's 4 × 4 matrices.

    Source: W. Weaver, S. P. Timoshenko, D. H. Young, Vibration Problems in Engineering, 1990,
    Section 6.4.
    """
    h = L / n
    k = np.array([[12, 6 * h, -12, 6 * h], [6 * h, 4 * h**2, -6 * h, 2 * h**2],
                  [-12, -6 * h, 12, -6 * h], [6 * h, 2 * h**2, -6 * h, 4 * h**2]])  # fmt: skip
    m = np.array([[156, 22 * h, 54, -13 * h], [22 * h, 4 * h**2, 13 * h, -3 * h**2],
                  [54, 13 * h, 156, -22 * h], [-13 * h, -3 * h**2, -22 * h, 4 * h**2]])  # fmt: skip
    M, K = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2 * n + 2))
    for e in range(n):
        own = slice(2 * e, 2 * e + 4)
        M[own, own] += mu * h / 420 * m
        K[own, own] += EI / h**3 * k
    return M, K


def beam():
    """M, K, x and vertical of the beam."""
    nodes = np.linspace(-L / 2, L / 2, ELEMENTS + 1)
    return *beam_matrices(), np.repeat(nodes, 2), np.tile([1.0, 0.0], ELEMENTS + 1)


def hull():
    """A beam that also bends sideways and twists: heights at its left and right side.

    Each node has the pitch, sideways motion and yaw of the centre line and the heights of the two
    sides, whose mean is the centre line's and whose difference is the roll. That of the left
    counts downwards. A mass centre 0.5 m off the axis couples roll and sideways motion.
    """
    n, a = ELEMENTS + 1, 1.4
    M_z, K_z = beam_matrices()
    M_y, K_y = beam_matrices(EI=2 * EI)
    h, J, GI = L / ELEMENTS, 2500.0, 8e8
    rod = np.zeros((n, n))
    mean = np.zeros((n, n))
    for e in range(ELEMENTS):
        own = slice(e, e + 2)
        rod[own, own] += GI / h * np.array([[1, -1], [-1, 1]])
        mean[own, own] += h / 6 * np.array([[2, 1], [1, 2]])
    z, y, roll = 2 * n, 2 * n, n
    M, K = np.zeros((z + y + roll,) * 2), np.zeros((z + y + roll,) * 2)
    M[:z, :z], K[:z, :z] = M_z, K_z
    M[z : z + y, z : z + y], K[z : z + y, z : z + y] = M_y, K_y
    M[z + y :, z + y :], K[z + y :, z + y :] = J * mean, rod
    M[z : z + y : 2, z + y :] = M[z + y :, z : z + y : 2] = 0.5 * MU * mean
    # From the heights of the two sides, the left one downwards, to height and roll.
    to = np.eye(z + y + roll)
    heights, rolls = np.arange(0, z, 2), np.arange(z + y, z + y + roll)
    to[heights, heights], to[heights, rolls] = -0.5, 0.5
    to[rolls, heights], to[rolls, rolls] = -1 / (2 * a), -1 / (2 * a)
    x = np.concatenate([*[np.repeat(np.linspace(-L / 2, L / 2, n), 2)] * 2,
                        np.linspace(-L / 2, L / 2, n)])  # fmt: skip
    vertical = np.zeros(len(x))
    vertical[heights], vertical[rolls] = -1, 1
    return to.T @ M @ to, to.T @ K @ to, x, vertical
