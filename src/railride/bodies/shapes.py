"""Mode shapes where something is attached: symbols that know where, and points to integrate at."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any, Self

import numpy as np
import sympy as sp

from railride.bodies.base import Place
from railride.numeric import Array


class Shape(sp.Symbol):
    r"""The mean over a span, or the value in one point, of x^p φ_i or of φ_i φ_j: a parameter.

    modes : i, or i and j. span : its ends. power : p.
    """

    modes: tuple[int, ...]
    span: tuple[Place, Place]
    power: int
    place: str

    def __new__(  # noqa: D102 - the class says it
        cls, modes: Sequence[int], span: tuple[Place, Place], power: int = 0
    ) -> Self:
        head = "phi_x" if power else "phi"
        name = "_".join([head, *map(str, modes), span[0].index])
        made: Self = sp.Symbol.__xnew__(cls, name, real=True)
        made.modes, made.span, made.power = tuple(modes), span, power
        made.place = str(span)
        return made

    @property
    def meaning(self) -> str:
        """In words."""
        what = (
            f"shape of mode {self.modes[0]}"
            if len(self.modes) == 1
            else (f"product of the shapes of modes {self.modes[0]} and {self.modes[1]}")
        )
        point = self.span[0] == self.span[1]
        return f"{'' if point else 'mean of '}{'x times ' * self.power}{what}, {self.span[0].name}"

    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        return (self.modes, self.span, self.power), {}

    def _hashable_content(self) -> tuple[Any, ...]:
        return (*super()._hashable_content(), self.place)

    @classmethod
    def class_key(cls) -> Any:
        """Sort among the symbols."""
        return sp.Symbol.class_key()


@cache
def quadrature(modes: int, knots: tuple[float, ...]) -> tuple[Array, Array]:
    """Gauss points in (0, 1) and weights that sum to one, between knots of their own.

    The product of two shapes of n half-waves has 2n of them, each of which takes π/2 points.
    """
    points, weights = np.polynomial.legendre.leggauss(20 if knots else 2 * modes + 20)
    ends = np.array([0.0, *knots, 1.0])
    widths = np.diff(ends)[:, np.newaxis]
    return ((ends[:-1, np.newaxis] + widths * (points + 1) / 2).ravel(),
            (widths * weights / 2).ravel())  # fmt: skip
