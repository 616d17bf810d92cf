r"""A free-free uniform beam by its mass, length and stiffness: frequencies and shapes as numbers.

.. math:: f_i = \frac{1}{2\pi}\sqrt{\frac{EI}{m L^3}\,\Lambda_i}, \qquad
          \int\varphi_i^2\,dm\;(+ \int\psi_i^2\,dJ) = m

with Λ_i = β_i⁴ of Euler-Bernoulli's beam (:mod:`~railride.bodies.slender_beam`); with a shear
stiffness κGA or a rotary inertia ρI per length, the beam is Timoshenko's
(:mod:`~railride.bodies.shear_beam`). A first natural frequency in place of EI sets EI.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from railride.bodies import slender_beam
from railride.bodies.shear_beam import ShearBeam, shear_beam, stiffness_for
from railride.errors import InputError
from railride.numeric import Array

Number = float | Array


@dataclass(frozen=True, eq=False)
class UniformBeam:
    """The first ``count`` modes of beams whose data are numbers or arrays that broadcast, SI.

    mass, length : m, L. frequency : the first natural frequency, Hz; or bending_stiffness : EI.
    shear_stiffness : κGA, N, or None. rotary_inertia : ρI, kg m, or None.

    Raises
    ------
    InputError : where they are asked for, of modes with a frequency that no EI gives beside such a
        shear stiffness.

    >>> UniformBeam(3, 34e3, 24.0, frequency=9.6).frequencies.round(2).tolist()
    [9.6, 26.46, 51.88]
    """

    count: int
    mass: Number
    length: Number
    frequency: Number | None = None
    bending_stiffness: Number | None = None
    shear_stiffness: Number | None = None
    rotary_inertia: Number | None = None

    @property
    def shears(self) -> bool:
        """Whether it is Timoshenko's beam."""
        return self.shear_stiffness is not None or self.rotary_inertia is not None

    @cached_property
    def stiffness(self) -> Array:
        """EI, given or calibrated."""
        if self.bending_stiffness is not None:
            return np.asarray(self.bending_stiffness, dtype=float)
        mass, length = np.asarray(self.mass), np.asarray(self.length)
        wanted = np.asarray(self.frequency, dtype=float)
        if not self.shears:
            omega = 2 * np.pi * wanted
            return np.asarray(omega**2 * mass * length**3 / slender_beam.roots(1)[0] ** 4)
        shear, rotary = self._others
        found = stiffness_for(wanted, mass / length, length, shear, rotary)
        if not np.isfinite(found).all():
            raise InputError(
                f"car body: found a first bending frequency of {np.max(wanted):g} Hz with a shear "
                f"stiffness of {np.min(shear):.4g} N; expected a frequency that some bending "
                "stiffness gives (a larger shear stiffness, or a lower frequency)"
            )
        return found

    @property
    def frequencies(self) -> Array:
        """f_i, Hz, ascending: (..., count)."""
        mass, length = np.asarray(self.mass), np.asarray(self.length)
        unit = np.sqrt(self.stiffness / (mass * length**3)) / (2 * np.pi)
        if not self.shears:
            return np.asarray(unit[..., np.newaxis] * slender_beam.roots(self.count) ** 2)
        return np.asarray(4 * unit[..., np.newaxis] * np.sqrt(self._shear_beam.eigenvalues))

    def shapes(self, x: ArrayLike) -> Array:
        """φ_i at x, m forward of the middle, which broadcasts with the data: (count, ...)."""
        u = np.asarray(x) / np.asarray(self.length)
        if not self.shears:
            return slender_beam.shapes(self.count, u)
        return self._shear_beam.shapes(2 * u)

    def slopes(self, x: ArrayLike) -> Array:
        """dφ_i/dx at x, 1/m: (count, ...)."""
        length = np.asarray(self.length)
        u = np.asarray(x) / length
        if not self.shears:
            return np.asarray(slender_beam.slopes(self.count, u) / length)
        return np.asarray(self._shear_beam.slopes(2 * u) * 2 / length)

    @property
    def _others(self) -> tuple[Array, Array]:
        shear = np.inf if self.shear_stiffness is None else self.shear_stiffness
        rotary = 0.0 if self.rotary_inertia is None else self.rotary_inertia
        return np.asarray(shear), np.asarray(rotary)

    @cached_property
    def _shear_beam(self) -> ShearBeam:
        mass, half = np.asarray(self.mass), np.asarray(self.length) / 2
        shear, rotary = self._others
        r_squared = rotary / (mass / (2 * half) * half**2)
        return shear_beam(r_squared, self.stiffness / (shear * half**2), self.count)
