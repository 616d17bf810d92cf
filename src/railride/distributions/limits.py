"""Values that a model cannot have, found in a distribution before a sample is drawn."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from railride.distributions.kinds import Quantiles
from railride.errors import Faults, InputError
from railride.vehicle import VehicleModel

NEVER = 1e-12  # a probability: once in ten thousand studies of 10⁸ designs


def note_impossible(
    model: VehicleModel,
    distributions: Mapping[str, Quantiles],
    faults: Faults,
    where: str = "parameters.{}",
) -> None:
    """Note each parameter whose distribution reaches values that the model cannot have.

    A value counts as reached if it, or one further out, has a probability above 1e-12. One
    parameter at a time, the others at their nominal values: what only several together make
    impossible shows in the single designs.

    distributions : parameter, as ``VehicleModel.values`` takes it → its distribution, SI. Names
    that the model does not have, and two that mean the same, are noted too. faults : gathers them.
    where : how the place of a parameter is called in messages.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> from railride.distributions import Distribution
    >>> faults = Faults("study")
    >>> wide = {"k_2": Distribution("normal", mean=750e3, deviation=250e3)}
    >>> note_impossible(derive_vehicle("cati2024", segments=1), wide, faults)
    >>> print(faults.found[0].found)
    normal, mean 750000, deviation 250000, which reaches -1.00862e+06
    """
    taken: dict[str, str] = {}
    for name, distribution in distributions.items():
        place = where.format(name)
        try:
            symbol = model.symbol_of(name)
        except InputError as error:
            faults.add(place, "a name that is not known", str(error).partition("expected ")[2])
            continue
        if taken.setdefault(symbol, name) != name:
            faults.add(place, f"{taken[symbol]} again", "each parameter once")
            continue
        if not (hasattr(distribution, "ppf") and hasattr(distribution, "support")):
            faults.add(place, repr(distribution), "a Distribution, or a frozen one of scipy.stats",
                       "a value that is known goes into the model")  # fmt: skip
            continue
        low, high = (float(x) for x in distribution.ppf(np.array([NEVER, 1 - NEVER])))
        least, most = (float(x) for x in distribution.support())
        kind = str(distribution) if hasattr(distribution, "kind") else "a distribution"
        for reached, limit, key in ((low, least, "from"), (high, most, "to")):
            if why := _refused(model, symbol, reached):
                mend = f"cut it: {key} = …" if np.isinf(limit) else f"change {key}"
                faults.add(place, f"{kind}, which reaches {reached:.6g}", why, mend)


def _refused(model: VehicleModel, symbol: str, value: float) -> str:
    """What the model expects instead of the value; empty where it can have it."""
    try:
        model.values(**{symbol: value})
    except InputError as error:
        return str(error).partition("expected ")[2] or str(error)
    signs = {p.symbol.name: p.symbol for p in model.parameters}
    negative = value < 0 and symbol in signs and signs[symbol].is_nonnegative
    return "values of at least 0" if negative else ""
