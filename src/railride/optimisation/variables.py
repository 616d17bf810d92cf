r"""The parameters that are chosen, as variables of one size: each runs from 0 to 1.

.. math:: p = p_0 \left(\frac{p_1}{p_0}\right)^u \;(p_0 > 0), \qquad
          p = p_0 + u\,(p_1 - p_0) \;\text{otherwise}

from the lower bound p_0 to the upper bound p_1. Stiffnesses and dampings count by their ratios: a
method that follows gradients needs variables in which equal steps mean as much.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import exp, log

import numpy as np

from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.toml_tables import finite_number
from railride.vehicle import VehicleModel

Ranges = Mapping[str, Sequence[float]]


@dataclass(frozen=True)
class Variable:
    """One chosen parameter.

    name : as it was asked for. symbol : the model's. meaning, unit : in words, SI. own : the
    vehicle's value. lower, upper : bounds, SI.
    """

    name: str
    symbol: str
    meaning: str
    unit: str
    own: float
    lower: float
    upper: float

    @property
    def logarithmic(self) -> bool:
        """Whether equal ratios are equal steps."""
        return self.lower > 0

    def value(self, u: float) -> float:
        """The parameter at u in [0, 1]; at 0 and 1 the bounds to the last bit."""
        if u in (0.0, 1.0):
            return self.upper if u else self.lower
        if self.logarithmic:
            return self.lower * exp(u * log(self.upper / self.lower))
        return self.lower + u * (self.upper - self.lower)

    def slope(self, u: float) -> float:
        """dp/du."""
        if self.logarithmic:
            return self.value(u) * log(self.upper / self.lower)
        return self.upper - self.lower

    def place(self, value: float) -> float:
        """u of a value, that of the nearer bound where it is outside.

        >>> k = Variable("k", "k", "", "", 2.0, 1.0, 4.0)
        >>> k.place(2.0), k.place(9.0), k.value(0.5)
        (0.5, 1.0, 2.0)
        """
        inside = min(max(value, self.lower), self.upper)
        if self.logarithmic:
            return log(inside / self.lower) / log(self.upper / self.lower)
        return (inside - self.lower) / (self.upper - self.lower)


def chosen_variables(model: VehicleModel, ranges: Ranges) -> tuple[Variable, ...]:
    """Variables of the parameters that are named, from and to.

    ranges : name or symbol → lower and upper bound, SI.

    Raises
    ------
    InputError : with all faults at once: no parameter; a name that the model does not have, or one
        that stands twice; bounds that are no numbers, empty or reversed, or that the parameter
        cannot have.
    """
    faults, found = Faults("parameters"), dict[str, Variable]()
    if not isinstance(ranges, Mapping):
        faults.add("optimisation", repr(ranges), "a dictionary, name → lower and upper bound")
        faults.raise_if_any()
    if not ranges:
        faults.add("optimisation", "none", "at least one parameter, with its range")
    positive = {p.symbol.name: p.symbol.is_positive for p in model.parameters}
    for name, bounds in ranges.items():
        try:
            symbol = model.symbol_of(name)
        except InputError as error:
            faults.include(name, error)
            continue
        ends = [finite_number(end) for end in bounds] if np.ndim(bounds) == 1 else []
        if symbol in found:
            faults.add(name, f"{found[symbol].name} again", "each parameter once")
        elif len(ends) != 2 or None in ends:
            faults.add(name, repr(bounds), "two finite numbers, the lower and the upper bound")
        else:
            low, high = (float(end) for end in ends if end is not None)
            if positive.get(symbol) and low <= 0:
                faults.add(name, f"a lower bound of {low:g}", "one above 0")
            if low >= high:
                faults.add(name, f"{'an empty' if low == high else 'a reversed'} range from {low:g}"
                           f" to {high:g}", "a lower bound below the upper one")  # fmt: skip
            meaning, unit = model.meanings[symbol]
            own = float(model.values()[symbol])
            found[symbol] = Variable(name, symbol, meaning, unit, own, low, high)
    faults.raise_if_any()
    return tuple(found.values())


def values_at(variables: Sequence[Variable], u: Array) -> dict[str, float]:
    """The parameters by symbol at u, (P,)."""
    return {v.symbol: v.value(x) for v, x in zip(variables, u.tolist(), strict=True)}
