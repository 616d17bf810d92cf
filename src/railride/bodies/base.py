"""What a vehicle asks of a car body, whatever it is made of."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from railride.errors import InputError
from railride.lagrange import Coordinate, Lagrangian
from railride.parameters import CarBody, Load

FLOORS = ("smooth", "polygon")


@dataclass(frozen=True)
class Parameter:
    """A quantity on which a model depends: its symbol, meaning, SI unit and value."""

    symbol: sp.Symbol
    meaning: str
    unit: str
    value: float


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
    def segments(self) -> int:
        """The number N of rigid segments."""

    @property
    @abstractmethod
    def energies(self) -> Lagrangian:
        """The body alone, free in space: its coordinates, T, V, D and kinematics."""

    @property
    @abstractmethod
    def parameters(self) -> tuple[Parameter, ...]:
        """The independent parameters."""

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """Dependent parameters by the independent ones, each using only those before it."""
        return {}

    @property
    @abstractmethod
    def lift(self) -> Mapping[Coordinate, int]:
        """The coordinates of a uniform lift by 1 m."""

    @abstractmethod
    def load_energy(self, mass: sp.Symbol, load: Load) -> sp.Expr:
        """Kinetic energy of a load: ``mass`` spread evenly from its rear to its front."""

    @abstractmethod
    def height(self, x: sp.Expr, at: float) -> sp.Expr:
        """Height of a point of the body's structure; x in m, an expression of value ``at``."""

    @abstractmethod
    def floor(self, at: float, reading: str) -> sp.Expr:
        """Height of the floor at ``at`` (m), read as ``reading``, one of :data:`FLOORS`."""

    def check_values(self, values: Mapping[str, NDArray[np.float64]]) -> None:
        """Raise :class:`InputError` where parameters, changed ones too, need an impossible mass."""
        del values

    def check_point(self, at: float) -> None:
        """Raise :class:`InputError` unless the point is on the body."""
        half = self.body.length / 2
        if not abs(at) <= half * (1 + 1e-12):
            raise InputError(f"position {at:g} m: found a point off the body; expected one between "
                             f"{-half:g} and {half:g} m from its middle")  # fmt: skip

    def check_reading(self, reading: str) -> None:
        """Raise :class:`InputError` unless it is a way to read the floor."""
        if reading not in FLOORS:
            raise InputError(f"floor: found {reading!r}; expected one of {', '.join(FLOORS)}")
