r"""How every symbol of a model moves with the parameters: the chain rule through all that follows.

.. math:: \frac{ds}{dp} = \sum_r \frac{\partial s}{\partial r} \frac{dr}{dp}

Independent parameters move alone; definitions by their own derivatives; what follows from others
(the joint stiffness from the bending frequency, the shape of a mode where a bogie stands) by the
body's formulas, and where the body has none by differences of eighth order.

Source of the differences: B. Fornberg, Math. Comp. 51 (1988) 699-706, Tables 1 and 3.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.numeric import Array, MatrixFunction
from railride.vehicle import VehicleModel

STEP = 2e-3  # of a parameter's value, or of 1 where that is 0
CENTRAL = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
FORWARD = (-761 / 280, 8.0, -14.0, 56 / 3, -35 / 2, 56 / 5, -14 / 3, 8 / 7, -1 / 8)
RULES = (  # offsets in steps → weights; the one-sided ones where the body ends
    {sign * k: sign * w for k, w in CENTRAL.items() for sign in (-1, 1)},
    dict(enumerate(FORWARD)),
    {-k: -w for k, w in enumerate(FORWARD)},
)


class Chain:
    """The derivatives of a model's symbols along parameters.

    Parameters
    ----------
    model : the vehicle. parameters : symbols' names. Those that follow from others are held by
        being among them: the others move as if they were given.
    """

    def __init__(self, model: VehicleModel, parameters: Sequence[str]) -> None:
        self.model, self.parameters = model, tuple(parameters)
        self._definitions = {**model.body.definitions, **model.carried.definitions}
        self._by = {
            symbol.name: sorted(definition.free_symbols, key=lambda s: s.name)
            for symbol, definition in self._definitions.items()
        }
        self._gradients = MatrixFunction({
            symbol.name: sp.Matrix([[definition.diff(s) for s in self._by[symbol.name]]])
            for symbol, definition in self._definitions.items()
        })  # fmt: skip

    def slopes(
        self, values: Mapping[str, Array], changes: Mapping[str, ArrayLike],
        symbols: Iterable[sp.Symbol],
    ) -> tuple[dict[str, Array], tuple[str, ...]]:  # fmt: skip
        """ds/dp of the symbols and all they follow from, (P,); names of those by differences.

        values : of all symbols, numbers. changes : what was given in place of the model's.
        """
        count = len(self.parameters)
        given = {p.symbol.name for p in self.model.parameters} | {*self.model.overrides, *changes}
        found = dict.fromkeys(given, np.zeros(count))
        found |= dict(zip(self.parameters, np.eye(count), strict=True))
        gradients = self._gradients(values)
        self._define(found, gradients)
        defined = {symbol.name for symbol in self._definitions}
        added, by_differences = self.added(
            values, found, changes, [s for s in symbols if s.name not in defined]
        )
        found |= added
        self._define(found, gradients)
        return found, by_differences

    def added(
        self, values: Mapping[str, Array], found: Mapping[str, Array],
        changes: Mapping[str, ArrayLike], symbols: Iterable[sp.Symbol],
    ) -> tuple[dict[str, Array], tuple[str, ...]]:  # fmt: skip
        """ds/dp of symbols that the body alone knows and that are not among those ``found``."""
        left = [s for s in symbols if s.name not in found]
        if not left:
            return {}, ()
        known = self.model.body.dependent_slopes(values, found, left)
        left = [s for s in left if s.name not in known]
        return {**known, **self._differences(values, changes, left)}, tuple(s.name for s in left)

    def _define(self, found: dict[str, Array], gradients: Mapping[str, Array]) -> None:
        """Put in the definitions of which all is known."""
        for name, by in self._by.items():
            if name not in found and all(s.name in found for s in by):
                slopes = [found[s.name] for s in by]
                found[name] = gradients[name][0] @ slopes if by else np.zeros(len(self.parameters))

    def _differences(
        self, values: Mapping[str, Array], changes: Mapping[str, ArrayLike],
        wanted: Sequence[sp.Symbol],
    ) -> dict[str, Array]:  # fmt: skip
        """Derivatives of what the body alone knows, all parameters in one vectorised call."""
        if not wanted:
            return {}
        try:
            return self._stencil(values, changes, wanted, self.parameters, RULES[0])
        except InputError:  # a place at the body's end: each parameter to the side that there is
            each = [self._beside(values, changes, wanted, name) for name in self.parameters]
            return {s.name: np.concatenate([one[s.name] for one in each]) for s in wanted}

    def _beside(
        self, values: Mapping[str, Array], changes: Mapping[str, ArrayLike],
        wanted: Sequence[sp.Symbol], name: str,
    ) -> dict[str, Array]:  # fmt: skip
        """Derivatives along one parameter, by the first rule that the body allows."""
        for rule in RULES[:-1]:
            try:
                return self._stencil(values, changes, wanted, [name], rule)
            except InputError:
                continue
        return self._stencil(values, changes, wanted, [name], RULES[-1])

    def _stencil(
        self, values: Mapping[str, Array], changes: Mapping[str, ArrayLike],
        wanted: Sequence[sp.Symbol], parameters: Sequence[str], rule: Mapping[int, float],
    ) -> dict[str, Array]:  # fmt: skip
        offsets, weights = np.array(list(rule), dtype=float), np.array(list(rule.values()))
        here = np.array([float(values[name]) for name in parameters])
        steps = STEP * np.where(here == 0, 1.0, np.abs(here))
        moved = {
            name: here[k] + steps[k] * offsets * (np.arange(len(parameters)) == k)[:, np.newaxis]
            for k, name in enumerate(parameters)
        }
        there = self.model.values(**{**changes, **moved})
        there |= self.model.body.dependent_values(there, [s for s in wanted if s.name not in there])
        shape = (len(parameters), len(rule))
        return {s.name: np.broadcast_to(there[s.name], shape) @ weights / steps for s in wanted}
