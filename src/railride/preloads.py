r"""Weight and the preloads that carry it: why neither leaves a term in the equations of motion.

Displacements count from static equilibrium. There the weight has the generalised forces of the
inertia in a uniform lift, and every elastic element of deflection e holds a preload N:

.. math:: V_0 = g\, u_0^T M q - \sum_e N_e\, e(q, w), \qquad
          \frac{\partial V_0}{\partial q}\Big|_0 = 0 .

It adds ∂²V₀/∂q∂q, ∂²V₀/∂q∂w to K and K_w: nothing, where the deflections have no second derivative
at the operating point, as of suspensions that act vertically.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Section 6.10.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp

from railride.jets import Jets
from railride.lagrange import Coordinate, Lagrangian, Signal
from railride.linear import linearise
from railride.numeric import Array, MatrixFunction
from railride.units import STANDARD_GRAVITY

g = sp.Symbol("g", positive=True)


@dataclass(frozen=True)
class Preloads:
    """The static forces of a system whose elements are springs, T and V quadratic.

    system : its energies. lift : the coordinates of a uniform lift by 1 m, those that are not 0.
    """

    system: Lagrangian
    lift: Mapping[Coordinate, float]

    @cached_property
    def elements(self) -> dict[sp.Symbol, sp.Expr]:
        """The preload of each spring, positive in compression, and the deflection it works on."""
        found: dict[sp.Symbol, sp.Expr] = {}
        for term in sp.Add.make_args(self.system.potential):
            for factor in sp.Mul.make_args(term):
                base, exponent = factor.as_base_exp()
                if exponent == 2 and any(isinstance(s, Signal) for s in base.free_symbols):
                    found[sp.Symbol(_name(base), real=True)] = base
        return found

    @cached_property
    def weight(self) -> sp.Matrix:
        """g M u₀: what the weight does along each coordinate, with the sign of ∂V₀/∂q."""
        u_0 = sp.Matrix([sp.nsimplify(self.lift.get(q, 0)) for q in self.system.coordinates])
        return g * linearise(self.system).M * u_0

    @cached_property
    def potential(self) -> sp.Expr:
        """V₀, of the weight and of the preloads."""
        pairs = zip(self.weight, self.system.coordinates, strict=True)
        weight = sp.Add(*(sp.factor(Q) * q for Q, q in pairs))
        return weight - sp.Add(*(N * e for N, e in self.elements.items()))

    @cached_property
    def _jets(self) -> Jets:
        return Jets(self.system.operating_point, self.system.kinematics)

    @cached_property
    def forces(self) -> dict[Coordinate, sp.Expr]:
        """∂V₀/∂q at the operating point, which the preloads make vanish."""
        found = self._jets.gradient(self.potential)
        return {q: sp.expand(found.get(q, sp.S.Zero)) for q in self.system.coordinates}

    @property
    def curvature(self) -> dict[tuple[Signal, Signal], sp.Expr]:
        """The second derivatives of V₀ at the operating point that do not vanish."""
        found = self._jets.hessian(self.potential)
        return {pair: h for pair, h in found.items() if sp.simplify(h) != 0}

    @cached_property
    def solution(self) -> dict[sp.Symbol, sp.Expr]:
        """The preloads by the parameters; empty where statics alone does not tell them."""
        unknown = list(self.elements)
        A, b = sp.linear_eq_to_matrix(list(self.forces.values()), unknown)
        if A.rows != A.cols or A.rank() < A.rows:
            return {}
        found = A.LUsolve(b)
        return dict(zip(unknown, (sp.factor(value) for value in found), strict=True))

    def values(self, parameters: Mapping[str, Array]) -> dict[str, float]:
        """The preloads as numbers, N or N m, by name.

        Where statics alone does not tell them (a bogie on three axles), the least in squares.

        parameters : values by symbol, as of :meth:`~railride.vehicle.VehicleModel.values`.
        """
        A, b = sp.linear_eq_to_matrix(list(self.forces.values()), list(self.elements))
        numbers = MatrixFunction({"A": A, "b": b})({**parameters, "g": np.array(STANDARD_GRAVITY)})
        found = np.linalg.lstsq(numbers["A"], numbers["b"][:, 0])[0]
        return {N.name: float(value) for N, value in zip(self.elements, found, strict=True)}


def _name(deflection: sp.Expr) -> str:
    """The preload's name: N_s1 of s_1, N_theta_1 of θ_1 - θ_2, N_ds1 of s_1 - d_s1."""
    names = sorted(s.name for s in deflection.free_symbols)
    first = names[0]
    return f"N_{first}" if first.startswith(("theta", "eta")) else f"N_{first.replace('_', '')}"
