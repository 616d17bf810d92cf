r"""Where a car body is cut into segments: lengths and places, in symbols and in numbers.

Node 0 is the front end, node N the rear end, the hinges between; segment i lies between the nodes
i - 1 and i. x counts forward from the middle of the body's length:

.. math:: L = \sum_i \ell_i, \qquad x_i = \tfrac12 L - \sum_{k \le i} \ell_k .
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp
from sympy import Rational

from railride.bodies.base import Parameter
from railride.errors import InputError
from railride.numeric import Array

L = sp.Symbol("L", positive=True)
AT_NODE = 1e-9  # of a segment: a point so near a hinge is at it


@dataclass(frozen=True)
class Cuts(ABC):
    """N segments in a row. length : of the body, m. number : N."""

    length: float
    number: int

    @abstractmethod
    def ell(self, i: int) -> sp.Expr:
        """Length of segment i."""

    @abstractmethod
    def node(self, i: int) -> sp.Expr:
        """x of node i."""

    @abstractmethod
    def middle(self, i: int) -> sp.Expr:
        """x of the middle of segment i."""

    @abstractmethod
    def along(self, i: int, x: sp.Expr) -> sp.Expr:
        """How far x is along segment i: 0 at its front node, 1 at its rear node."""

    @property
    @abstractmethod
    def parameters(self) -> tuple[Parameter, ...]:
        """The lengths on which all depends."""

    @property
    @abstractmethod
    def nodes(self) -> Array:
        """x of the nodes, m, (N + 1,), from the front."""

    @abstractmethod
    def moved(self, values: Mapping[str, Array]) -> Array:
        """x of the nodes at the values of the parameters: (..., N + 1).

        Raises
        ------
        InputError : lengths that must not change.
        """

    def segment_at(self, at: float) -> int:
        """The number of the segment on which a point of the body lies; at a hinge that ahead."""
        near = AT_NODE * self.length / self.number
        return min(max(int(np.count_nonzero(self.nodes - near > at)), 1), self.number)


@dataclass(frozen=True)
class EqualCuts(Cuts):
    """Segments of one length, ℓ = L/N."""

    def ell(self, i: int) -> sp.Expr:
        """ℓ = L/N."""
        del i
        return L / self.number

    def node(self, i: int) -> sp.Expr:
        """(N - 2 i)/(2 N) L."""
        return Rational(self.number - 2 * i, 2 * self.number) * L

    def middle(self, i: int) -> sp.Expr:
        """(N + 1 - 2 i)/2 ℓ."""
        return Rational(self.number + 1 - 2 * i, 2) * self.ell(i)

    def along(self, i: int, x: sp.Expr) -> sp.Expr:
        """N/2 - (i - 1) - N x/L."""
        return Rational(self.number, 2) - (i - 1) - self.number * x / L

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """L."""
        return (Parameter(L, "car-body length", "m", self.length),)

    @cached_property
    def nodes(self) -> Array:
        """Evenly from L/2 to -L/2."""
        return np.linspace(0.5, -0.5, self.number + 1) * self.length

    def moved(self, values: Mapping[str, Array]) -> Array:
        """They keep to their shares of L."""
        return np.asarray(values["L"])[..., np.newaxis] * self.nodes / self.length


@dataclass(frozen=True)
class OwnCuts(Cuts):
    """Segments of their own lengths, m, from the front, with symbols ell_1 … ell_N."""

    lengths: tuple[float, ...]

    @classmethod
    def of(cls, lengths: Sequence[float]) -> OwnCuts:
        """Segments of these lengths."""
        return cls(float(sum(lengths)), len(lengths), tuple(lengths))

    def ell(self, i: int) -> sp.Expr:
        """ell_i."""
        return sp.Symbol(f"ell_{i}", positive=True)

    def node(self, i: int) -> sp.Expr:
        """Half the length behind it less half the length ahead of it."""
        segments = range(1, self.number + 1)
        return sp.Add(*(self.ell(k) / 2 if k > i else -self.ell(k) / 2 for k in segments))

    def middle(self, i: int) -> sp.Expr:
        """Half the length behind it less half the length ahead of it."""
        others = (k for k in range(1, self.number + 1) if k != i)
        return sp.Add(*(self.ell(k) / 2 if k > i else -self.ell(k) / 2 for k in others))

    def along(self, i: int, x: sp.Expr) -> sp.Expr:
        """(x_{i-1} - x)/ℓ_i."""
        return (self.node(i - 1) - x) / self.ell(i)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Each segment's length."""
        return tuple(
            Parameter(self.ell(i), f"length of segment {i}", "m", length)
            for i, length in enumerate(self.lengths, start=1)
        )

    @cached_property
    def nodes(self) -> Array:
        """Behind one another."""
        return self.length / 2 - np.concatenate([[0.0], np.cumsum(self.lengths)])

    def moved(self, values: Mapping[str, Array]) -> Array:
        """They stay: what lies on which segment, and with which mass, was taken for good."""
        for p in self.parameters:
            found = np.ravel(values[p.symbol.name])
            changed = found[found != p.value]
            if changed.size:
                raise InputError(
                    f"{p.symbol.name}: found {changed[0]:g} m; expected {p.value:g} m, on which "
                    "the masses and joints of the model were made (derive the changed vehicle)"
                )
        return self.nodes
