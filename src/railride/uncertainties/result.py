"""What an uncertainty study found, as values that know themselves and as tables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from railride.errors import Fault, InputError
from railride.numeric import Array
from railride.uncertainties.estimates import Estimate, Summary
from railride.uncertainties.indices import Indices
from railride.units import headed

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Uncertain:
    """A parameter that is not known exactly.

    distribution : in words. nominal : the vehicle's own value, SI.
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    distribution: str
    nominal: float


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """How quantities of a ride scatter with the parameters of the vehicle.

    title : what was studied. parameters : P of them. designs : (N, P), SI. values : (N, Q), NaN
    where a design has none. summaries : of the Q quantities. indices : likewise; None where they
    were not asked for or nothing scatters. evaluated : designs in all, those for the indices
    included. failed : reason → how many of them have no values. method, seed : of the sample.
    """

    title: str
    parameters: tuple[Uncertain, ...]
    designs: Array
    values: Array
    summaries: tuple[Summary, ...]
    indices: tuple[Indices | None, ...]
    method: str
    seed: int
    evaluated: int
    failed: Mapping[str, int]
    remarks: tuple[str, ...] = ()

    def place(self, quantity: str | int) -> int:
        """Number of a quantity by its name, or by its number itself.

        Raises
        ------
        InputError : a quantity that is not there, with those that are.
        """
        names = [one.name for one in self.summaries]
        if isinstance(quantity, int) and 0 <= quantity < len(names):
            return quantity
        if quantity not in names:
            raise InputError(str(Fault("quantity", repr(quantity), f"one of {', '.join(names)}")))
        return names.index(str(quantity))

    def samples(self) -> pd.DataFrame:
        """Every design and its values, a row each; the headings carry the units."""
        import pandas as pd

        heads = [headed(one.name, one.unit) for one in self.parameters]
        heads += [headed(one.name, one.unit) for one in self.summaries]
        return pd.DataFrame(np.column_stack([self.designs, self.values]), columns=heads)

    def table(self) -> pd.DataFrame:
        """A row per quantity: unit, nominal value, mean, standard deviation and percentiles.

        Each estimate comes with the ends of its interval: ``p95``, ``p95_low``, ``p95_high``.
        """
        import pandas as pd

        rows = {}
        for one in self.summaries:
            row: dict[str, object] = {
                "unit": one.unit,
                "designs": one.count,
                "nominal": one.nominal,
            }
            row |= spread("mean", one.mean) | spread("standard_deviation", one.deviation)
            for p, estimate in one.percentiles.items():
                row |= spread(f"p{p:g}", estimate)
            rows[one.name] = row
        return pd.DataFrame.from_dict(rows, orient="index").rename_axis("quantity")

    def indices_table(self) -> pd.DataFrame:
        """A row per quantity and parameter: first and total order, and their intervals."""
        import pandas as pd

        rows = [
            {"quantity": of.name, "parameter": parameter.name, **spread("first", first),
             **spread("total", total)}
            for of, one in zip(self.summaries, self.indices, strict=True) if one is not None
            for parameter, first, total in zip(self.parameters, one.first, one.total, strict=True)
        ]  # fmt: skip
        names = [f"{order}{end}" for order in ("first", "total") for end in ("", "_low", "_high")]
        return pd.DataFrame(rows, columns=["quantity", "parameter", *names])


def spread(name: str, estimate: Estimate) -> dict[str, float]:
    """An estimate as three cells.

    >>> spread("mean", Estimate(2.0, 1.0, 3.0))
    {'mean': 2.0, 'mean_low': 1.0, 'mean_high': 3.0}
    """
    return {name: estimate.value, f"{name}_low": estimate.low, f"{name}_high": estimate.high}
