r"""The car body of beam elements: free-free modes of EI(x), μ(x) and point masses.

Without shear (Euler–Bernoulli; with rotary inertia, Rayleigh) the height w is a cubic in each
element, of continuous slope, by Hermite's shape functions:

.. math:: T = \tfrac12 \int (\mu \dot w^2 + \rho I \dot w'^2)\,dx, \qquad
          V = \tfrac12 \int EI\, w''^2\,dx .

Where the profile has a shear stiffness GA_s (Timoshenko), the cross-section turns by ψ besides,

.. math:: T = \tfrac12 \int (\mu \dot w^2 + \rho I \dot\psi^2)\,dx, \qquad
          V = \tfrac12 \int \left(EI\,\psi'^2 + GA_s (w' - \psi)^2\right) dx ,

with w cubic and ψ quadratic in each element: as w' is of ψ's degree, the two can be equal, and a
beam that hardly shears does not lock but becomes Hermite's. In both forms ω² converges with the
fourth power of the element's length. Point masses lie on nodes.

Modes come from M and K, with or without a reduction; their energies are then summed once more as
squares of strains, which keeps the digits that K loses to cancellation in short elements.

Sources: T. J. R. Hughes, The Finite Element Method, Dover 2000, Sections 1.16 and 5.4; J. N. Reddy,
On locking-free shear deformable beam finite elements, Computer Methods in Applied Mechanics and
Engineering 149 (1997) 113–132; scikit-fem: T. Gustafsson, G. D. McBain, Journal of Open Source
Software 5 (2020) 2369.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from railride.bodies.reduction import Matrix
from railride.body_profile import BodyProfile
from railride.errors import Faults, InputError
from railride.numeric import Array

NEAREST = 1e-4  # of the length: nodes nearer than that would cost the modes their digits
SAME = 1e-9  # of the length: nodes nearer than that are one
ORDER = 7  # of the Gauss rule: exact for products of two cubics and a linear density

Measures = list[tuple[str, Any]]  # a column of the profile, and what its energy is the square of


@dataclass(frozen=True, eq=False)
class BeamElements:
    """The free beam of a profile, cut into elements no longer than L/elements.

    Parameters
    ----------
    profile : the body. elements : how many at least.
    interfaces : places (m) that are to be nodes, where no other node is next to them.

    Raises
    ------
    InputError : knots or point masses that are neither in one place nor NEAREST L apart; scikit-fem
        that is not installed.
    """

    profile: BodyProfile
    elements: int
    interfaces: tuple[float, ...] = ()

    @property
    def shears(self) -> bool:
        """Whether the cross-section's turn is a field of its own."""
        return self.profile.shear_stiffness is not None

    @cached_property
    def nodes(self) -> Array:
        """x of the nodes, m: knots, point masses, interfaces, and even steps between them."""
        length = self.profile.length
        places = sorted({*self.profile.x, *(p.position for p in self.profile.point_masses)})
        fixed = [places[0]]
        faults = Faults("elements of the car body")
        for x in places[1:]:
            if x - fixed[-1] > NEAREST * length:
                fixed.append(x)
            elif x - fixed[-1] > SAME * length:
                faults.add("knots and point masses", f"{fixed[-1]:.9g} m and {x:.9g} m",
                           f"places at least {NEAREST * length:.2g} m apart, or one place",
                           "a jump is a knot that stands twice")  # fmt: skip
        faults.raise_if_any()
        for x in self.interfaces:
            if np.abs(x - np.array(fixed)).min() > NEAREST * length:
                fixed.append(x)
        fixed.sort()
        parts = np.ceil(np.diff(fixed) * self.elements / length * (1 - SAME)).astype(int)
        steps = [np.linspace(a, b, n, endpoint=False)
                 for a, b, n in zip(fixed, fixed[1:], parts, strict=False)]  # fmt: skip
        return np.concatenate([*steps, [fixed[-1]]])

    @cached_property
    def basis(self) -> Any:
        """The shape functions, of scikit-fem, at the points of a Gauss rule in each element."""
        try:
            import skfem
        except ImportError:
            raise InputError("body fe: found no scikit-fem; expected it to be installed (pip "
                             "install 'railride[fe]')") from None  # fmt: skip
        hermite, cubic = skfem.ElementLineHermite(), skfem.ElementLinePp(3)
        element = cubic * skfem.ElementLineP2() if self.shears else hermite
        return skfem.Basis(skfem.MeshLine(self.nodes), element, intorder=ORDER)

    def inertia(self, w: Any, psi: Any = None) -> Measures:
        """What T is made of, for the fields of a motion."""
        turn = w.grad[0] if psi is None else psi
        turning = [] if self.profile.rotary_inertia is None else [("rotary_inertia", turn)]
        return [("mass_per_length", w), *turning]

    def strain(self, w: Any, psi: Any = None) -> Measures:
        """What V is made of, for the fields of a motion."""
        if psi is None:
            return [("bending_stiffness", w.hess[0][0])]
        return [("bending_stiffness", psi.grad[0]), ("shear_stiffness", w.grad[0] - psi)]

    @cached_property
    def M(self) -> Matrix:
        """The mass matrix, point masses included."""
        from scipy.sparse import diags_array

        points = np.zeros(self.basis.N)
        points[self.basis.nodal_dofs] = self._points
        return self._assembled(self.inertia) + diags_array(points)

    @cached_property
    def K(self) -> Matrix:
        """The stiffness matrix of the free beam."""
        return self._assembled(self.strain)

    def _assembled(self, measures: Callable[..., Measures]) -> Matrix:
        """∫ Σ p e(u) e(v) dx for all pairs of shape functions."""
        from skfem import BilinearForm

        fields = 2 if self.shears else 1

        def integrand(*given: Any) -> Any:
            x = given[-1].x[0]
            pairs = zip(measures(*given[:fields]), measures(*given[fields:-1]), strict=True)
            return sum(self.profile.at(name, x) * u * v for (name, u), (_, v) in pairs)

        return BilinearForm(integrand).assemble(self.basis)

    @cached_property
    def _points(self) -> Array:
        """Mass (kg) and pitch inertia (kg m²) of the point masses on each node, (2, nodes)."""
        found = np.zeros((2, len(self.nodes)))
        for point in self.profile.point_masses:
            node = np.abs(self.nodes - point.position).argmin()
            found[:, node] += point.mass, point.pitch_inertia
        return found

    @cached_property
    def rigid(self) -> Array:
        """The uniform lift and the pitch about the mass centre by one, (n, 2)."""
        heights, turns = self.basis.nodal_dofs
        R = np.zeros((self.basis.N, 2))
        R[heights, 0], R[heights, 1] = 1.0, self.nodes - self.profile.mass_centre
        R[turns, 1] = 1.0
        R[self.basis.interior_dofs[2:], 1] = 1.0  # ψ at the middle of the elements, where it is
        return R

    def kinetic_roots(self, motions: Array) -> Array:
        """Rows (…, k) whose squares sum to 2T of each of k rates (n, k)."""
        points = np.sqrt(self._points)[..., np.newaxis] * motions[self.basis.nodal_dofs]
        return np.vstack([self._roots(motions, self.inertia), points.reshape(-1, motions.shape[1])])

    def strain_roots(self, motions: Array) -> Array:
        """Rows (…, k) whose squares sum to 2V of each of k motions (n, k)."""
        return self._roots(motions, self.strain)

    def _roots(self, motions: Array, measures: Callable[..., Measures]) -> Array:
        x, dx = self.basis.global_coordinates()[0], self.basis.dx
        columns = []
        for motion in motions.T:
            fields = self.basis.interpolate(motion)
            found = measures(*fields) if self.shears else measures(fields)
            columns.append([np.sqrt(self.profile.at(name, x) * dx) * e for name, e in found])
        return np.array(columns).reshape(motions.shape[1], -1).T

    def modes(self, motions: Array) -> tuple[Array, Array, Array]:
        """Modes within what flexible motions (n, k) span, clear of the rigid ones (Rayleigh–Ritz).

        Returns
        -------
        tuple : ω² (k,), ascending; the rigid motions and modes (n, 2 + k) with φᵀMφ = m_c; the
            products (2 + k, 2 + k) of these with one another.
        """
        from scipy import linalg

        both = self.kinetic_roots(np.hstack([self.rigid, motions]))
        rigid, own = both[:, :2], both[:, 2:]
        motions = motions - self.rigid @ np.linalg.solve(rigid.T @ rigid, rigid.T @ own)
        m, k = self.kinetic_roots(motions), self.strain_roots(motions)
        squares, shares = linalg.eigh(k.T @ k, m.T @ m)
        found = np.hstack([self.rigid, motions @ shares * np.sqrt(self.profile.mass)])
        products = self.kinetic_roots(found)
        return squares, found, products.T @ products

    def heights(self, motions: Array) -> Any:
        """w(x) of each of k motions (n, k), a scipy PPoly of k polynomials: cubic in each element.

        The cubic through its values at the four Gauss points is the cubic of the element itself.
        """
        from scipy.interpolate import PPoly

        fields = (self.basis.interpolate(motion) for motion in motions.T)
        values = np.array([np.asarray(w[0] if self.shears else w) for w in fields])
        powers = np.arange(3, -1, -1)
        inverse = np.linalg.inv(self.basis.X[0][:, np.newaxis] ** powers)
        scale = np.diff(self.nodes)[:, np.newaxis] ** powers
        return PPoly(np.einsum("pq,keq,ep->pek", inverse, values, 1 / scale), self.nodes)
