r"""Where the floor of a body of rigid segments is: on the polygon or on a smooth line.

The floor is smooth and the segments stand for it: what is right of one is its momentum, and so its
mean height. Where the curvature is κ, a smooth line of the same mean over a segment of length ℓ is,
ξ from -½ to ½ along it,

.. math:: z_{polygon} + \kappa\ell^2 (\xi^2/2 - 1/24) ,

and passes κ ℓ²/12 above a hinge. That is the hinge's lift e_j, with κ = (θ_ahead - θ_behind)/d,
d half the length of both segments, and the mean of ℓ² over them: of lengths a and b,

.. math:: e_j = \frac{\theta_a - \theta_b}{6}\,\frac{a^3 + b^3}{(a + b)^2} , \qquad
          e_j = \frac{\theta_a - \theta_b}{12}\,\ell \quad\text{for}\quad a = b = \ell .

``smooth`` keeps the mean over every segment and joins the lifts, e linear between the hinges and
zero at the free ends:

.. math:: z_{smooth} = z_{polygon} + e(\xi)\,(6\xi^2 - \tfrac12) .

``spline`` is the smoothest line through the lifted nodes, :math:`\int (z''')^2 dx` the least, with
neither bending moment nor shear force at the free ends: the quintic spline of z'' = z''' = 0 there.
Its error falls with ℓ⁴ everywhere, that of ``smooth`` with ℓ³ off hinges and middles.

Source of the spline: C. de Boor, A Practical Guide to Splines, 2001, Chapters V and XIV.
"""

from __future__ import annotations

from math import factorial

import numpy as np
import sympy as sp
from sympy import Rational

from railride.bodies.cuts import Cuts
from railride.lagrange import Coordinate


def z(i: int) -> Coordinate:
    """Height of node i."""
    return Coordinate(f"z_{i}")


def theta(i: int) -> Coordinate:
    """Pitch of segment i."""
    return Coordinate(f"theta_{i}")


def polygon(cuts: Cuts, i: int, at: sp.Expr) -> sp.Expr:
    """z = (1 - ξ) z_{i-1} + ξ z_i on segment i, ξ from its front node."""
    xi = cuts.along(i, at)
    return (1 - xi) * z(i - 1) + xi * z(i)


def smooth(cuts: Cuts, i: int, at: sp.Expr) -> sp.Expr:
    """The polygon, and the lifts so that its mean over the segment is kept."""
    xi = Rational(1, 2) - cuts.along(i, at)  # forward of the segment's middle
    half = Rational(1, 2)
    lifted = (half + xi) * lift(cuts, i - 1) + (half - xi) * lift(cuts, i)
    return polygon(cuts, i, at) + lifted * (6 * xi**2 - half)


def spline(cuts: Cuts, i: int, at: sp.Expr) -> sp.Expr:
    """The quintic spline through the lifted nodes, as a polynomial on segment i."""
    from scipy.interpolate import make_interp_spline

    N = cuts.number
    x = cuts.nodes[::-1] / cuts.length
    free = [(2, np.zeros(N + 1)), (3, np.zeros(N + 1))]
    each = make_interp_spline(x, np.eye(N + 1), k=5, bc_type=(free, free))
    rear, front = x[N - i], x[N - i + 1]
    powers = [each(rear, p) / factorial(p) for p in range(6)]  # of the distance from the rear node
    u = (1 - cuts.along(i, at)) * float(front - rear)
    shapes = (sp.Add(*(float(c) * u**p for p, c in enumerate(column))) for column in
              np.transpose(powers))  # fmt: skip
    return sp.Add(*(S * (z(N - k) + lift(cuts, N - k)) for k, S in enumerate(shapes)))


def lift(cuts: Cuts, j: int) -> sp.Expr:
    """e_j: how far the smooth floor passes above node j; zero at the free ends."""
    if not 0 < j < cuts.number:
        return sp.S.Zero
    a, b, turn = cuts.ell(j), cuts.ell(j + 1), theta(j) - theta(j + 1)
    if a == b:
        return turn * a / 12
    return turn * (a**3 + b**3) / (6 * (a + b) ** 2)
