r"""The free-free uniform Euler-Bernoulli beam: natural modes in closed form.

With u = x/L from the middle, -½ ≤ u ≤ ½, and β_i from :math:`\cos\beta_i \cosh\beta_i = 1`,

.. math:: \varphi_i = \frac{\cos\beta_i u}{\cos\frac{\beta_i}{2}}
          + \frac{\cosh\beta_i u}{\cosh\frac{\beta_i}{2}} \;(i \text{ odd}), \qquad
          \varphi_i = \frac{\sin\beta_i u}{\sin\frac{\beta_i}{2}}
          + \frac{\sinh\beta_i u}{\sinh\frac{\beta_i}{2}} \;(i \text{ even}),

.. math:: \int_{-1/2}^{1/2}\varphi_i^2\,du = 1, \quad \varphi_i(\tfrac12) = 2, \qquad
          f_i = \frac{\beta_i^2}{2\pi}\sqrt{\frac{EI}{\mu L^4}} .

Nothing overflows: a quotient of hyperbolic functions is a sum of falling exponentials.

Source: R.D. Blevins, Formulas for Natural Frequency and Mode Shape, 1979, Table 8-1 (free-free).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from railride.numeric import Array


def roots(count: int) -> Array:
    """β_1 … β_count, to the last bit or two.

    The symmetric modes (i odd) have tan ½β = -tanh ½β and the others tan ½β = tanh ½β, so that
    ½β = ⌈i/2⌉π ∓ arctan tanh ½β: a fixed point that gains two digits a step, and more of higher i.

    >>> roots(3).round(6).tolist()
    [4.730041, 7.853205, 10.995608]
    """
    i = np.arange(1, count + 1)
    beta = (i + 0.5) * np.pi
    for _ in range(12):
        beta = 2 * (np.ceil(i / 2) * np.pi + (-1.0) ** i * np.arctan(np.tanh(beta / 2)))
    return np.asarray(beta)


def shapes(count: int, u: ArrayLike) -> Array:
    """φ_1 … φ_count at u = x/L, of any shape (...): (count, ...).

    >>> shapes(2, [-0.5, 0.0, 0.5]).round(4).tolist()
    [[2.0, -1.2156, 2.0], [-2.0, 0.0, 2.0]]
    """
    return _sums(count, np.asarray(u, dtype=float), slope=False)


def slopes(count: int, u: ArrayLike) -> Array:
    """dφ_i/du at u = x/L, of any shape (...): (count, ...)."""
    return _sums(count, np.asarray(u, dtype=float), slope=True)


def _sums(count: int, u: Array, *, slope: bool) -> Array:
    """The trigonometric and the hyperbolic part, or their slopes."""
    i = np.arange(1, count + 1).reshape(-1, *[1] * u.ndim)
    beta = roots(count).reshape(i.shape)
    odd = i % 2 == 1
    wave = np.where(odd, np.cos(beta * u), np.sin(beta * u))
    if slope:
        wave = np.where(odd, -np.sin(beta * u), np.cos(beta * u)) * beta
    edge = np.where(odd, np.cos(beta / 2), np.sin(beta / 2))
    # cosh βu / cosh ½β and sinh βu / sinh ½β: the falling parts from the front and from the rear.
    front, rear = np.exp(beta * (u - 0.5)), np.exp(-beta * (u + 0.5))
    own = np.where(odd, 1.0, -1.0)
    arch = (front + own * rear) / (1 + own * np.exp(-beta))
    if slope:
        arch = beta * (front - own * rear) / (1 + own * np.exp(-beta))
    return np.asarray(wave / edge + arch)
