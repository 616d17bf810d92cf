"""What a vehicle asks of a car body, whatever it is made of."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from numbers import Real

import numpy as np
import sympy as sp

from railride.errors import InputError
from railride.lagrange import Coordinate, Lagrangian
from railride.linear import linearise
from railride.numeric import Array, MatrixDerivative, MatrixFunction, symmetric_eigenvalues
from railride.parameters import CarBody, Load
from railride.toml_tables import finite_number

FLOORS = ("smooth", "polygon", "spline")


@dataclass(frozen=True)
class Parameter:
    """A quantity on which a model depends: its symbol, meaning, SI unit and value."""

    symbol: sp.Symbol
    meaning: str
    unit: str
    value: float


@dataclass(frozen=True)
class Place:
    """A point of the body, ``at`` m forward of its middle.

    name : for messages. index : for symbols that belong to it. x : its place as an expression, a
    number, or a symbol or its negative.
    """

    name: str
    index: str
    x: sp.Expr
    at: float

    def value(self, values: Mapping[str, Array]) -> Array:
        """x at the values of the parameters."""
        factor, symbol = self.x.as_coeff_Mul()
        return np.asarray(float(factor) * (values[symbol.name] if symbol.is_Symbol else 1.0))

    def slope(self, slopes: Mapping[str, Array]) -> Array:
        """Its derivatives (P,) by those of the parameters; 0 where it is a number."""
        factor, symbol = self.x.as_coeff_Mul()
        moves = symbol.is_Symbol
        return np.asarray(float(factor) * slopes[symbol.name] if moves else 0.0)


@dataclass(frozen=True)
class BodyModel(ABC):
    """A free car body as energies in its own coordinates; x in m forward of its middle."""

    body: CarBody

    @property
    @abstractmethod
    def kind(self) -> str:
        """The body's name on the command line."""

    @property
    @abstractmethod
    def title(self) -> str:
        """What the body is, in a few words: "4 segments"."""

    @property
    @abstractmethod
    def phrase(self) -> str:
        """What the body is, as a phrase: "a car body of 4 rigid segments"."""

    @property
    def options(self) -> str:
        """The options that choose it on the command line."""
        return f"--segments {self.segments}"

    @property
    def segments(self) -> int | None:
        """The number N of rigid segments; None of a body that is not made of them."""
        return None

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the user should know of how the body was made."""
        return ()

    @property
    def mode_count(self) -> int | None:
        """The number of bending modes of a body that is made of them, else None."""
        return None

    @property
    @abstractmethod
    def energies(self) -> Lagrangian:
        """The body alone, free in space: its coordinates, T, V, D and kinematics."""

    @property
    def positions(self) -> Mapping[str, tuple[sp.Expr, sp.Expr]]:
        """Places (x, z) of its rigid parts by their index, in its coordinates and kinematics."""
        return {}

    @property
    @abstractmethod
    def parameters(self) -> tuple[Parameter, ...]:
        """The independent parameters."""

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """Dependent parameters by the independent ones, each using only those before it."""
        return {}

    @property
    def followers(self) -> Mapping[sp.Symbol, tuple[str, str]]:
        """Dependent parameters without a definition, and their meaning and unit.

        They may be given in place of what they follow from, else :meth:`dependent_values` knows.
        """
        return {}

    def meaning(self, symbol: sp.Symbol) -> tuple[str, str]:
        """Meaning and unit of a dependent parameter; empty where it only stands between others."""
        return self.followers.get(symbol, ("", ""))

    def dependent_values(
        self, values: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """Values of those of the ``wanted`` symbols that follow from the values, by name."""
        del values, wanted
        return {}

    def dependent_slopes(
        self, values: Mapping[str, Array], slopes: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """Derivatives, (P,), of those of the ``wanted`` symbols for which there is a formula.

        values : of all parameters, numbers. slopes : derivatives of the others, (P,).
        """
        del values, slopes, wanted
        return {}

    @property
    @abstractmethod
    def lift(self) -> Mapping[Coordinate, int]:
        """The coordinates of a uniform lift by 1 m."""

    @property
    @abstractmethod
    def pitch(self) -> Mapping[Coordinate, sp.Expr]:
        """The coordinates of a small turn by 1 rad about the body's middle, per rad."""

    @property
    @abstractmethod
    def nodes(self) -> Array:
        """Points that a drawing of the floor joins by straight lines: x, m, from the front."""

    @abstractmethod
    def load_energy(self, mass: sp.Symbol, load: Load) -> sp.Expr:
        """Kinetic energy of a load: ``mass`` spread evenly from its rear to its front."""

    @abstractmethod
    def height(self, place: Place) -> sp.Expr:
        """Height of a point of the body's structure."""

    @abstractmethod
    def floor(self, at: float, reading: str) -> sp.Expr:
        """Height of the floor at ``at`` (m), read as ``reading``, one of :data:`FLOORS`."""

    def check_values(self, values: Mapping[str, Array]) -> None:
        """Raise :class:`InputError` where parameters, changed ones too, need an impossible mass."""
        del values

    def check_moved(self, place: Place, values: Mapping[str, Array]) -> None:
        """Raise :class:`InputError` unless a place keeps to where its height was taken."""
        x, length = place.value(values), np.asarray(values.get("L", self.body.length))
        if not np.all(np.abs(x) <= length / 2 * (1 + 1e-12)):
            raise InputError(
                f"{place.name}: found a position of up to {np.max(np.abs(x)):g} m from the middle "
                f"of a body of {np.min(length):g} m; expected one on the body"
            )

    def check_point(self, at: float) -> None:
        """Raise :class:`InputError` unless the point is on the body."""
        half, number = self.body.length / 2, finite_number(at)
        if number is None or abs(number) > half * (1 + 1e-12):
            named = f"{at:g} m" if isinstance(at, Real) else repr(at)
            raise InputError(f"position {named}: found a point off the body; expected one between "
                             f"{-half:g} and {half:g} m from its middle")  # fmt: skip

    def check_reading(self, reading: str) -> None:
        """Raise :class:`InputError` unless it is a way to read the floor."""
        if reading not in FLOORS:
            raise InputError(f"floor: found {reading!r}; expected one of {', '.join(FLOORS)}")

    @cached_property
    def _free(self) -> MatrixFunction:
        return MatrixFunction(self._free_linear)

    @cached_property
    def _free_linear(self) -> dict[str, sp.ImmutableSparseMatrix]:
        linear = linearise(self.energies)
        return {"M": linear.M, "K": linear.K}

    @cached_property
    def _free_derivative(self) -> MatrixDerivative:
        return MatrixDerivative(self._free_linear)

    def free_matrices(self, values: Mapping[str, Array]) -> dict[str, Array]:
        """M and K of the empty body alone, free in space: (..., n, n) in its own coordinates."""
        return self._free(values)

    def bending_frequencies(self, values: Mapping[str, Array]) -> Array:
        """Natural frequencies of the free body other than zero, Hz, ascending: (..., n - 2)."""
        A = self.free_matrices(values)
        squares = symmetric_eigenvalues(A["M"], A["K"])[..., 2:]
        return np.asarray(np.sqrt(np.maximum(squares, 0)) / (2 * np.pi))

    def bending_slope(self, values: Mapping[str, Array], slopes: Mapping[str, Array]) -> Array:
        r"""Relative derivative of the first bending's ω², (P,), by the derivatives of all else.

        .. math:: \frac{d\ln\omega^2}{dp} = \frac{1}{\omega^2} \varphi^T \left(\frac{dK}{dp}
                  - \omega^2 \frac{dM}{dp}\right) \varphi, \qquad \varphi^T M \varphi = 1

        Source: R.L. Fox, M.P. Kapoor, AIAA J. 6 (1968) 2426-2429, Eq 7.
        """
        A, dA = self.free_matrices(values), self._free_derivative(values, slopes)
        inverse = np.linalg.inv(np.linalg.cholesky(A["M"]))
        squares, vectors = np.linalg.eigh(inverse @ A["K"] @ inverse.T)
        shape = inverse.T @ vectors[:, 2]
        return np.asarray(shape @ (dA["K"] / squares[2] - dA["M"]) @ shape)
