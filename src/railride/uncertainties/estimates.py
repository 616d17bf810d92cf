r"""What a sample tells of a quantity: mean, deviation, percentiles, probabilities of classes.

Each with its interval at 95 %:

- mean and standard deviation by the bootstrap (percentile method, 999 resamples);
- the p-quantile between two order statistics X_(l), X_(u), with Y binomial of n trials and p,

  .. math:: P(X_{(l)} \le x_p \le X_{(u)}) \ge P(l \le Y < u),

  whatever the distribution is;
- the probability of a class by Wilson's interval.

All three are those of independent designs. Sobol's sequence and Latin hypercubes scatter less, so
that for them the intervals are on the safe side.

Sources: B. Efron, R.J. Tibshirani, An Introduction to the Bootstrap, 1993, Chapter 13;
W.J. Conover, Practical Nonparametric Statistics, 3rd ed. 1999, Section 3.2; E.B. Wilson, J. Am.
Stat. Assoc. 22 (1927) 209; A.B. Owen, SIAM J. Numer. Anal. 34 (1997) 1884, and M. Stein,
Technometrics 29 (1987) 143, for the two that scatter less.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from railride.numeric import Array
from railride.scales import Scale

LEVEL = 0.95  # of all intervals
RESAMPLES = 999
_AT_ONCE = 2 * 10**6  # resampled values in memory


@dataclass(frozen=True)
class Estimate:
    """A value and the interval that holds the true one at 95 %; NaN where it has no such end."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Summary:
    """What is known of one quantity.

    count : designs that have a value. nominal : value of the nominal design; NaN: it has none.
    percentiles : per cent → estimate. classes : scale → class → its probability.
    """

    name: str
    unit: str
    count: int
    nominal: float
    mean: Estimate
    deviation: Estimate
    percentiles: Mapping[float, Estimate]
    classes: Mapping[str, Mapping[str, Estimate]]


def summary(
    name: str,
    unit: str,
    x: Array,
    percentiles: Sequence[float],
    scales: Sequence[Scale] = (),
    nominal: float = np.nan,
    seed: int = 0,
) -> Summary:
    """Summary of the values x (n,) of one quantity, n ≥ 2, all finite.

    percentiles : per cent, each between 0 and 100. scales : rate the values. seed : of the
    bootstrap.

    Examples
    --------
    >>> found = summary("a", "m/s^2", np.linspace(0, 1, 1001), [50, 95])
    >>> round(found.percentiles[95.0].value, 9), round(found.mean.value, 9)
    (0.95, 0.5)
    """
    mean, deviation = _moments(x, seed)
    return Summary(
        name=name,
        unit=unit,
        count=x.size,
        nominal=nominal,
        mean=mean,
        deviation=deviation,
        percentiles={float(p): percentile(x, p) for p in percentiles},
        classes={scale.name: probabilities(scale, x) for scale in scales},
    )


def _moments(x: Array, seed: int) -> tuple[Estimate, Estimate]:
    """Mean and standard deviation."""
    from scipy import stats

    def moments(x: Array, axis: int = -1) -> Array:
        return np.stack([x.mean(axis=axis), x.std(axis=axis, ddof=1)])

    found = stats.bootstrap((x,), moments, n_resamples=RESAMPLES, method="percentile",
                            batch=max(1, _AT_ONCE // x.size), confidence_level=LEVEL,
                            rng=seed)  # fmt: skip
    low, high = found.confidence_interval
    mean, deviation = (Estimate(*map(float, each)) for each in zip(moments(x), low, high,
                                                                  strict=True))  # fmt: skip
    return mean, deviation


def percentile(x: Array, p: float) -> Estimate:
    """The p-th percentile (linear between order statistics) of x (n,), between two of them."""
    from scipy import stats

    value = float(np.percentile(x, p))
    between = stats.quantile_test(x, q=value, p=p / 100).confidence_interval(LEVEL)
    return Estimate(value, float(between.low), float(between.high))


def probabilities(scale: Scale, x: Array) -> dict[str, Estimate]:
    """How probable each class of a scale is, by the share of the values x (n,) in it."""
    from scipy import stats

    found = {}
    for one in scale.classes:
        held = int(np.count_nonzero([one.holds(value) for value in x.tolist()]))
        test = stats.binomtest(held, x.size)
        between = test.proportion_ci(LEVEL, method="wilson")
        found[one.label] = Estimate(held / x.size, float(between.low), float(between.high))
    return found
