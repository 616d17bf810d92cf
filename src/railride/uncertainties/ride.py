"""How the comfort of a ride scatters with parameters that are not known exactly."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from railride.designs import evaluate_designs
from railride.designs.given import Tracks
from railride.distributions import Distribution, Quantiles, note_impossible
from railride.errors import Faults
from railride.numeric import Array
from railride.scales import (
    EN_12299_CONTINUOUS,
    ISO_2631_1_ANNEX_C,
    PAPER_TABLE_3,
    SPERLING,
    VERTICAL,
    Scale,
    scale_remarks,
)
from railride.uncertainties.estimates import Summary
from railride.uncertainties.propagation import PERCENTILES, SAMPLES, propagate
from railride.uncertainties.result import Uncertain, Uncertainty
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd


def uncertainty(
    model: VehicleModel,
    distributions: Mapping[str, Quantiles],
    tracks: Tracks | Sequence[Tracks],
    speeds: float | Sequence[float],
    at: float | Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    results: Sequence[str] = ("a_wrms",),
    samples: int = SAMPLES,
    method: str = "sobol",
    seed: int = 0,
    percentiles: Sequence[float] = PERCENTILES,
    indices: bool = True,
    progress: Callable[[float], None] | None = None,
) -> Uncertainty:
    """Percentiles of comfort values over uncertain parameters, and Sobol's indices of each.

    Of every result, track, speed and position: mean, standard deviation, percentiles, how probable
    the comfort classes are, and which parameter the scatter comes from. The parameters are
    independent of each other; what follows from one, such as the joint stiffness of a body that
    keeps its bending frequency, follows in every design.

    Parameters
    ----------
    distributions : parameter, as ``VehicleModel.values`` takes it → its distribution, SI:
        :class:`railride.Distribution` or a frozen one of scipy.stats.
    tracks, speeds, at, floor, weight, results, progress : what is ridden and asked for, as for
        :func:`railride.evaluate_designs`.
    samples : designs of which the percentiles are; with indices, P + 1 times as many besides.
    method : "sobol", "latin_hypercube" or "random". seed : of the sample and of all resampling.
    percentiles : per cent. indices : whether to find Sobol's indices.

    Raises
    ------
    InputError : distributions that reach values which the vehicle cannot have, names that it does
        not have; what ``evaluate_designs`` refuses; designs none of which has values.

    Examples
    --------
    >>> from railride import Distribution, derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> scatter = {"secondary_damping": Distribution("normal", mean=70e3, deviation=3.5e3),
    ...            "bending_damping": Distribution("uniform", low=0.0, high=0.02)}
    >>> found = uncertainty(coach, scatter, "erri_low", 200 / 3.6, samples=256)
    >>> first = found.indices[0].first
    >>> first[1].value > 0.9 > first[0].value  # the structural damping is what matters
    True
    """
    faults = Faults("uncertainty")
    note_impossible(model, distributions, faults)
    faults.raise_if_any()
    weight = weight if isinstance(weight, Weighting) else weighting(weight)
    said: list[str] = [*model.remarks]

    def evaluate(designs: Array) -> tuple[pd.DataFrame, Sequence[str]]:
        columns = dict(zip(distributions, designs.T, strict=True))
        found = evaluate_designs(model, columns, tracks, speeds, at, floor=floor, weight=weight,
                                 results=tuple(results), progress=progress)  # fmt: skip
        said.extend(found.remarks)
        table = found.table().drop(columns=["error", "problem"])
        return table.iloc[:, len(found.parameters) :], list(found.problems)

    found = propagate(
        evaluate, _described(model, distributions), list(distributions.values()), samples=samples,
        method=method, seed=seed, percentiles=percentiles, with_indices=indices,
        scales=lambda quantity: scales_of(quantity, weight.name), title=model.vehicle.name,
    )  # fmt: skip
    said += scale_remarks((), [label for one in found.summaries for label in _occurring(one)])
    return replace(found, remarks=(*dict.fromkeys(said), *found.remarks))


def _occurring(one: Summary) -> list[str]:
    """The paper's classes that occur."""
    shares = one.classes.get(PAPER_TABLE_3.name, {})
    return [label for label, share in shares.items() if share.value > 0]


def _described(
    model: VehicleModel, distributions: Mapping[str, Quantiles]
) -> tuple[Uncertain, ...]:
    """The parameters in words, with their nominal values."""
    nominal, meanings = model.values(), model.meanings
    found = []
    for name, distribution in distributions.items():
        symbol = model.symbol_of(name)
        meaning, unit = meanings.get(symbol, ("", ""))
        value = float(nominal[symbol])
        found.append(Uncertain(name, symbol, unit, meaning, in_words(distribution), value))
    return tuple(found)


def in_words(distribution: Quantiles) -> str:
    """What a distribution is, for tables."""
    frozen: Any = distribution
    if isinstance(distribution, Distribution) or not hasattr(frozen, "dist"):
        return str(distribution)
    figures = [f"{x:g}" for x in frozen.args]
    figures += [f"{name} {x:g}" for name, x in frozen.kwds.items()]
    return f"{frozen.dist.name} {', '.join(figures)}".rstrip()


def scales_of(quantity: str, weight: str) -> tuple[Scale, ...]:
    """The scales that rate a quantity of a ride weighted so."""
    kind = quantity.partition(" ")[0]
    if kind == "wz":
        return (SPERLING,)
    if kind == "a_wrms" and weight in VERTICAL:
        return PAPER_TABLE_3, ISO_2631_1_ANNEX_C
    if kind == "a_wrms" and weight == "Wb_en12299":
        return (EN_12299_CONTINUOUS,)
    return ()
