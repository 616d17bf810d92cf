r"""What a car body of natural modes is made from, wherever the modes come from.

The free body's mass centre heaves and pitches, and its n natural modes φ_i(x) add to the heights

.. math:: z(x) = z_c + (x - e_c)\sin\theta_c + \sum_{i=1}^n \varphi_i(x)\,\eta_i .

The modes are scaled by :math:`\int \varphi_i^2\,dm = m_c` and orthogonal to one another and to the
rigid motions,

.. math:: \int \varphi_i\varphi_j\,dm = 0 \;(i \ne j), \qquad
          \int \varphi_i\,dm = \int (x - e_c)\,\varphi_i\,dm = 0 ,

so that the products of 1, x - e_c, φ_1 … φ_n are diag(m_c, I_c, m_c, …, m_c). Where rotary inertia
counts, it is in the products: :math:`\int \varphi_i\varphi_j\,dm + \int \psi_i\psi_j\,dJ` with the
turn ψ of the cross-section.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Sections 8.5 and 8.9.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import Faults, InputError
from railride.numeric import Array

ORTHOGONAL = 1e-6  # of the two motions' own products: what is larger is not rounding
HEAVE, PITCH = "a uniform lift", "pitch about the mass centre"


@dataclass(frozen=True, eq=False)
class BodyModes:
    """The natural modes of a free car body, with what is rigid of it; x in m forward of its middle.

    Parameters
    ----------
    mass : m_c, kg. mass_centre : e_c, m. length : L, m.
    pitch_inertia : I_c, kg m², about the mass centre.
    frequencies : (n,) natural frequencies of the free body, Hz, ascending.
    damping : (n,) damping ratios, at least 0; None where the car body says what they are.
    shapes : x, m, of any shape (...) → φ_i(x), (n, ...).
    kind : what made them: "beam", "fe" or "modes" (from outside).
    slopes : as ``shapes``, dφ_i/dx in 1/m, where known.
    products : (n + 2, n + 2), kg and kg m, of the motions 1, x - e_c, φ_1 … φ_n with one another
        (see the module), as far as the maker of the modes knows the mass distribution.
    knots : places within the body at which the shapes are not smooth, such as nodes of elements.
    remarks : what a user must know of them.

    Raises
    ------
    InputError : with all faults at once: values that no body can have; frequencies out of order;
        shapes that are not finite on the body or not n; products other than
        diag(m_c, I_c, m_c, …, m_c).

    Examples
    --------
    >>> import numpy as np
    >>> bow = lambda x: np.sqrt(5) / 2 * (3 * (np.asarray(x) / 12) ** 2 - 1)[np.newaxis]
    >>> modes = BodyModes(34e3, 0.0, 1.632e6, 24.0, [9.6], [0.01], bow, "modes")
    >>> modes.count, modes.shapes(12.0).round(3)
    (1, array([2.236]))
    """

    mass: float
    mass_centre: float
    pitch_inertia: float
    length: float
    frequencies: Array
    damping: Array | None
    shapes: Callable[[ArrayLike], Array]
    kind: str
    slopes: Callable[[ArrayLike], Array] | None = None
    products: Array | None = None
    knots: tuple[float, ...] = ()
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("frequencies", "damping"):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=float))
        faults = Faults("modes of the car body")
        self._check_rigid(faults)
        self._check_modes(faults)
        faults.raise_if_any()
        self._check_shapes(faults)
        self._check_products(faults)
        faults.raise_if_any()

    @property
    def count(self) -> int:
        """How many modes there are, n."""
        return len(self.frequencies)

    def first(self, n: int) -> BodyModes:
        """The first n of the modes.

        Raises
        ------
        InputError : more than there are, or none.
        """
        if not 1 <= n <= self.count:
            raise InputError(f"modes: found {n}; expected 1 to {self.count}, as many as the car "
                             "body was given")  # fmt: skip
        shapes, slopes, products = self.shapes, self.slopes, self.products
        return replace(
            self,
            frequencies=self.frequencies[:n],
            damping=None if self.damping is None else self.damping[:n],
            shapes=lambda x: shapes(x)[:n],
            slopes=None if slopes is None else lambda x: slopes(x)[:n],
            products=None if products is None else products[: n + 2, : n + 2],
        )

    def _check_rigid(self, faults: Faults) -> None:
        for name, unit in (("mass", "kg"), ("pitch_inertia", "kg m²"), ("length", "m")):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                faults.add(name, f"{value:g} {unit}", "a finite value above 0")
        if not abs(self.mass_centre) < self.length / 2:
            faults.add("mass_centre", f"{self.mass_centre:g} m", "a place within the body")

    def _check_modes(self, faults: Faults) -> None:
        f, zeta = self.frequencies, self.damping
        if f.ndim != 1 or not f.size:
            faults.add("frequencies", f"shape {f.shape}", "one natural frequency for each mode, "
                       "and at least one")  # fmt: skip
            return
        for i in np.flatnonzero(~(np.isfinite(f) & (f > 0))):
            faults.add(f"mode {i + 1}", f"a natural frequency of {f[i]:g} Hz", "one above 0",
                       "the rigid motions are not among the modes")  # fmt: skip
        for i in np.flatnonzero(np.diff(f) < 0):
            faults.add(f"mode {i + 2}", f"{f[i + 1]:g} Hz after {f[i]:g} Hz", "ascending natural "
                       "frequencies")  # fmt: skip
        if zeta is None:
            return
        if zeta.shape != f.shape:
            faults.add("damping", f"{zeta.size} ratios of {f.size} modes", "one for each mode")
            return
        for i in np.flatnonzero(~(np.isfinite(zeta) & (zeta >= 0))):
            faults.add(f"mode {i + 1}", f"a damping ratio of {zeta[i]:g}", "one of at least 0")

    def _check_shapes(self, faults: Faults) -> None:
        for name, function in (("shapes", self.shapes), ("slopes", self.slopes)):
            if function is None:
                continue
            x = np.linspace(-self.length / 2, self.length / 2, 6).reshape(2, 3)
            found = np.asarray(function(x))
            if found.shape != (self.count, 2, 3):
                faults.add(name, f"values of shape {found.shape} at points of shape (2, 3)",
                           f"{(self.count, 2, 3)}, the modes first")  # fmt: skip
            elif not np.isfinite(found).all():
                i = int(np.argmin(np.isfinite(found).all(axis=(1, 2))))
                faults.add(f"mode {i + 1}", f"no finite number among its {name}",
                           "finite ones all along the body")  # fmt: skip

    def _check_products(self, faults: Faults) -> None:
        if self.products is None:
            return
        own = np.array([self.mass, self.pitch_inertia, *[self.mass] * self.count])
        P = np.asarray(self.products, dtype=float)
        if P.shape != (own.size, own.size):
            faults.add("products", f"shape {P.shape}", f"{(own.size, own.size)}")
            return
        off = P / np.sqrt(own * own[:, np.newaxis]) - np.eye(own.size)
        names = [HEAVE, PITCH, *(f"mode {i}" for i in range(1, self.count + 1))]
        for i, j in zip(*np.nonzero(~(np.abs(np.triu(off)) <= ORTHOGONAL)), strict=True):
            if i == j:
                faults.add(names[i], f"a product with itself of {P[i, i]:.9g}", f"{own[i]:.9g}",
                           "scale a mode so that its modal mass is the car body's")  # fmt: skip
            else:
                faults.add(f"{names[i]} and {names[j]}", f"{off[i, j]:.3g} of their own products "
                           "in common", "orthogonal motions in the body's mass")  # fmt: skip
