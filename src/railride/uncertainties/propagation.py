"""From distributions of parameters to what they make of a function of them: the study itself."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from railride.distributions import Quantiles, refuse_sampling, sample
from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.quantities import several
from railride.scales import Scale
from railride.toml_tables import finite_number
from railride.uncertainties.estimates import Summary, summary
from railride.uncertainties.indices import Indices, crossed, indices
from railride.uncertainties.result import Uncertain, Uncertainty

if TYPE_CHECKING:
    import pandas as pd

PERCENTILES = (5.0, 50.0, 95.0, 99.0)
SAMPLES = 4096
FEWEST = 8  # designs: with fewer there is nothing to be said of a scatter
SHOWN = 5  # reasons why designs have no values

Evaluate = Callable[[Array], "tuple[pd.DataFrame, Sequence[str]]"]
"""Designs (D, P) → a table of D rows, columns headed "name [unit]", NaN where there is no value;
and for each row why there is none, or "" (nothing at all where nothing can fail)."""


def propagate(
    evaluate: Evaluate,
    parameters: Sequence[Uncertain],
    distributions: Sequence[Quantiles],
    *,
    samples: int = SAMPLES,
    method: str = "sobol",
    seed: int = 0,
    percentiles: Sequence[float] = PERCENTILES,
    with_indices: bool = True,
    scales: Callable[[str], Sequence[Scale]] = lambda _: (),
    title: str = "",
) -> Uncertainty:
    """What a function of uncertain parameters comes to: percentiles, and where the scatter is from.

    The sample has ``samples`` designs; for Sobol's indices ``samples`` · (P + 1) others are
    evaluated besides, and the nominal one.

    Parameters
    ----------
    evaluate : gives values of designs. parameters : P of them, in the order of the designs'
    columns. distributions : of each. samples, method, seed : the sample, see
    :func:`railride.distributions.sample`. percentiles : per cent. with_indices : whether to find
    the indices. scales : by which the values of a column are rated, by its name. title : of it all.

    Raises
    ------
    InputError : numbers and methods that are none, all together; no design that has values.

    Examples
    --------
    >>> import pandas as pd
    >>> from railride.distributions import Distribution
    >>> x = [Uncertain(name, name, "m", "", "", 0.0) for name in ("x_1", "x_2")]
    >>> found = propagate(lambda designs: (pd.DataFrame({"y [m]": designs @ [1, 3]}), []), x,
    ...                   [Distribution("normal", mean=0.0, deviation=1.0)] * 2, samples=1024)
    >>> [round(one.value, 1) for one in found.indices[0].total]
    [0.1, 0.9]
    """
    percentiles = several(percentiles, "percentiles", "per cent")
    _refuse(len(parameters), samples, method, seed, percentiles)
    P, N = len(parameters), int(samples)
    points = sample([*distributions] * (1 + with_indices), 0, N, method, seed, N)
    A, B = points[:, :P], points[:, P:]
    nominal = np.array([[one.nominal for one in parameters]])
    designs = np.concatenate([nominal, A, B, crossed(A, B)] if with_indices else [nominal, A])
    table, problems = evaluate(designs)
    y = table.to_numpy(dtype=float)
    heads = [head.removesuffix("]").partition(" [")[::2] for head in table.columns]
    summaries, found = [], []
    for k, (name, unit) in enumerate(heads):
        own = y[1 : N + 1, k]
        good = own[np.isfinite(own)]
        if good.size < 2:
            raise InputError(_nothing(name, good.size, N, problems))
        summaries.append(summary(name, unit, good, percentiles, scales(name), y[0, k], seed))
        rest = y[N + 1 :, k]
        found.append(indices(own, rest[:N], rest[N:].reshape(P, N), seed) if with_indices else None)
    return Uncertainty(
        title=title,
        parameters=tuple(parameters),
        designs=A,
        values=y[1 : N + 1],
        summaries=tuple(summaries),
        indices=tuple(found),
        method=method,
        seed=seed,
        evaluated=len(designs),
        failed=dict(reasons(problems[1:])),
        remarks=tuple(
            _remarks(summaries, found if with_indices else None, problems[1 : N + 1], method, N)
        ),
    )


def _refuse(
    parameters: int, samples: object, method: object, seed: object, percentiles: Sequence[object]
) -> None:
    """Raise all that is wrong with how the study is to be done."""
    faults = Faults("uncertainty")
    refuse_sampling(faults, 2 * parameters, samples, method, seed)
    note_numbers(faults, "", samples, percentiles)
    if not parameters:
        faults.add("parameters", "none", "a distribution of at least one")
    faults.raise_if_any()


def note_numbers(
    faults: Faults, where: str, samples: object, percentiles: Sequence[object]
) -> None:
    """Note too few samples, and percentiles that are none; ``where`` comes before each key."""
    if isinstance(samples, int) and 0 <= samples < FEWEST:
        faults.add(f"{where}number", str(samples), f"at least {FEWEST} designs", "1024 are few")
    for p in percentiles:
        value = finite_number(p)
        if value is None or not 0 < value < 100:
            faults.add(f"{where}percentiles", repr(p), "numbers between 0 and 100")
    if not percentiles or len(set(percentiles)) < len(percentiles):
        faults.add(f"{where}percentiles", repr(list(percentiles)), "at least one, each once")


def reasons(problems: Sequence[str]) -> list[tuple[str, int]]:
    """Why designs have no values and how many, the most frequent first.

    What differs in its numbers alone is one reason, told by the first of its kind.

    >>> reasons(["", "found -1 for k", "found -2 for k", "unstable"])
    [('found -1 for k', 2), ('unstable', 1)]
    """
    kinds = [(re.sub(r"(?<!\w)[-+]?\d[\d.]*(e[-+]?\d+)?", "#", problem), problem)
             for problem in problems if problem]  # fmt: skip
    first = dict(reversed(kinds))
    return [(first[kind], n) for kind, n in Counter(kind for kind, _ in kinds).most_common()]


def _nothing(name: str, count: int, samples: int, problems: Sequence[str]) -> str:
    """Why there is nothing to be said of a quantity."""
    why = "; ".join(f"{n} of all: {reason}" for reason, n in reasons(problems)[:SHOWN])
    return (f"uncertainty: found {count} of {samples} designs with a value of {name}; expected at "
            f"least 2 ({why or 'they are not finite'})")  # fmt: skip


def _remarks(
    summaries: Sequence[Summary],
    found: Sequence[Indices | None] | None,
    problems: Sequence[str],
    method: str,
    samples: int,
) -> Iterator[str]:
    """What is to be known of the sample."""
    if failed := reasons(problems):
        count = sum(number for _, number in failed)
        listed = [f"{number}: {reason}" for reason, number in failed[:SHOWN]]
        if len(failed) > SHOWN:
            listed.append("and others")
        yield (f"{count} of {samples} designs ({100 * count / samples:.3g} %) have no values and "
               f"are in no percentile: {'; '.join(listed)}")  # fmt: skip
    if method == "sobol" and samples & (samples - 1):
        below = 2 ** (samples.bit_length() - 1)
        yield (f"{samples} points of Sobol's sequence are not spread evenly: {below} or "
               f"{2 * below} are")  # fmt: skip
    open_ended = sorted({p for one in summaries for p, estimate in one.percentiles.items()
                         if not np.isfinite([estimate.low, estimate.high]).all()})  # fmt: skip
    if open_ended:
        listed = [f"{p:g} %" for p in open_ended]
        yield (f"{samples} designs are too few for an interval of the percentiles "
               f"{', '.join(listed)}")  # fmt: skip
    for one, own in zip(summaries, found or (), strict=found is not None):
        if own is None:
            yield (f"{one.name} has no indices: it does not change with the parameters, or too few "
                   "designs have values")  # fmt: skip
    rows = {own.rows for own in found or () if own is not None and own.rows < samples}
    if rows:
        yield (f"the indices are of {min(rows)} of {samples} designs: a power of two, of those "
               "that have values with every parameter in turn")  # fmt: skip
