r"""Distributions of a parameter, by the figures that a designer knows.

normal, lognormal
    mean μ and standard deviation σ of the parameter itself, before it is cut to ``low`` … ``high``.
    A lognormal X has ln X normal with

    .. math:: \sigma_{\ln}^2 = \ln(1 + \sigma^2/\mu^2), \qquad
              \mu_{\ln} = \ln\mu - \tfrac12 \sigma_{\ln}^2 .

uniform, triangular, beta
    between ``low`` and ``high``; the triangular has its peak at ``mode``, the beta has the density
    x^(α-1) (1-x)^(β-1) in x = (value - low)/(high - low).

A cut distribution is the one on condition that the value lies between the limits: μ and σ are then
not those of what is drawn. Cut at its mean, a normal one is one-sided.

Source: N.L. Johnson, S. Kotz, N. Balakrishnan, Continuous Univariate Distributions, vols 1 (1994),
Chapters 13 (truncation) and 14 (Eqs 14.8), and 2 (1995), Chapter 25.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from statistics import NormalDist
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import Fault, Faults
from railride.numeric import Array
from railride.toml_tables import expected_sign, finite_number, shown

KINDS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "normal": (("mean", "deviation"), ("low", "high")),
    "lognormal": (("mean", "deviation"), ("low", "high")),
    "uniform": (("low", "high"), ()),
    "triangular": (("low", "mode", "high"), ()),
    "beta": (("low", "high", "alpha", "beta"), ()),
}
"""Kind → the figures that it needs, and those that it may have."""

BELLS = ("normal", "lognormal")  # which have no limits of their own

LEAST_LEFT = 1e-6  # of the probability, by a cut: what is left of less is no longer the kind named


class Quantiles(Protocol):
    """What samples are drawn from: a :class:`Distribution`, or any frozen one of scipy.stats."""

    def ppf(self, q: Any, /) -> Any:
        """The quantiles of the probabilities q."""

    def support(self) -> Sequence[Any]:
        """The least and the largest value."""


@dataclass(frozen=True)
class Distribution:
    """One of :data:`KINDS` with its figures, in SI units.

    Parameters
    ----------
    kind : "normal", "lognormal", "uniform", "triangular" or "beta".
    mean, deviation : mean and standard deviation, before any cut.
    low, high : the limits. mode : where a triangle has its peak. alpha, beta : shapes, > 0.

    Raises
    ------
    InputError : figures that the kind does not take, that are missing or cannot be, all together.

    Examples
    --------
    >>> spring = Distribution("normal", mean=750e3, deviation=37.5e3, low=0.0)
    >>> spring.ppf([0.5, 0.95]).round(-2).tolist()
    [750000.0, 811700.0]
    >>> aged = Distribution("lognormal", mean=60e3, deviation=6e3, high=70e3)
    >>> tuple(aged.support())
    (0.0, 70000.0)
    """

    kind: str
    mean: float | None = None
    deviation: float | None = None
    low: float | None = None
    high: float | None = None
    mode: float | None = None
    alpha: float | None = None
    beta: float | None = None

    def __post_init__(self) -> None:
        faults = Faults("distribution")
        faults.found += faults_of(self.kind, self._given)
        faults.raise_if_any()
        for name, value in self._given.items():
            object.__setattr__(self, name, float(value))

    @property
    def _given(self) -> dict[str, Any]:
        """The figures that it was made of."""
        named = (item.name for item in fields(self)[1:])
        return {name: getattr(self, name) for name in named if getattr(self, name) is not None}

    @property
    def _logarithmic(self) -> bool:
        """Whether the frozen distribution is that of the value's logarithm."""
        return self.kind == "lognormal"

    @cached_property
    def _frozen(self) -> Any:
        """The distribution of the value, or of its logarithm, as scipy has it."""
        from scipy import stats

        g = self._given
        if self.kind in BELLS:
            mean, deviation, low, high = _bell(self.kind, g)
            a, b = (low - mean) / deviation, (high - mean) / deviation
            if math.isinf(a) and math.isinf(b):
                return stats.norm(mean, deviation)
            return stats.truncnorm(a, b, mean, deviation)
        low, width = g["low"], g["high"] - g["low"]
        if self.kind == "uniform":
            return stats.uniform(low, width)
        if self.kind == "triangular":
            return stats.triang((g["mode"] - low) / width, low, width)
        return stats.beta(g["alpha"], g["beta"], low, width)

    def ppf(self, q: ArrayLike) -> Array:
        """Quantiles: the values below which the probability is q, any shape."""
        found = np.asarray(self._frozen.ppf(q), dtype=float)
        # The exponential of a limit's logarithm may miss the limit by the last bit.
        return np.clip(np.exp(found), *self.support()) if self._logarithmic else found

    def cdf(self, x: ArrayLike) -> Array:
        """Probability of a value of at most x, any shape."""
        x = np.asarray(x, dtype=float)
        if self._logarithmic:
            with np.errstate(divide="ignore"):
                x = np.log(np.maximum(x, 0))
        return np.asarray(self._frozen.cdf(x))

    def support(self) -> tuple[float, float]:
        """The least and the largest value; infinite where there is none."""
        low, high = (float(x) for x in self._frozen.support())
        if self._logarithmic:
            return max(0.0, self.low or 0.0), math.inf if self.high is None else self.high
        return low, high

    def __str__(self) -> str:
        """The kind and its figures: ``normal, mean 750000, deviation 37500``."""
        return ", ".join([self.kind, *(f"{name} {v:g}" for name, v in self._given.items())])


def faults_of(kind: object, figures: dict[str, Any]) -> Iterator[Fault]:
    """What is wrong with the figures of a kind, each by the name of its field.

    >>> print(*faults_of("uniform", {"low": 2.0, "high": 1.0}))
    high: found 1; expected more than low, 2
    """
    if kind not in KINDS:
        yield Fault("distribution", shown(kind), f"one of {', '.join(KINDS)}")
        return
    needed, possible = KINDS[str(kind)]
    for name in figures:
        if name not in (*needed, *possible):
            yield Fault(name, "a figure that is not needed",
                        f"of a {kind} distribution {', '.join((*needed, *possible))}")  # fmt: skip
    good: dict[str, float] = {}
    for name in (*needed, *possible):
        if name not in figures:
            if name in needed:
                yield Fault(name, "none", f"one: a {kind} distribution needs it")
            continue
        value = finite_number(figures[name])
        positive = name in {"deviation", "alpha", "beta"} or (kind, name) == ("lognormal", "mean")
        if expected := expected_sign(value, "> 0" if positive else ""):
            yield Fault(name, shown(figures[name]), expected)
        elif value is not None:
            good[name] = value
    order = list(_order(str(kind), good))
    yield from order
    if not order and kind in BELLS and {"mean", "deviation"} <= good.keys():
        yield from _little_left(str(kind), good)


def _bell(kind: str, good: dict[str, float]) -> tuple[float, float, float, float]:
    """Mean, deviation and limits of the normal distribution that it is, or its logarithm."""
    mean, deviation = good["mean"], good["deviation"]
    low, high = good.get("low", -math.inf), good.get("high", math.inf)
    if kind == "normal":
        return mean, deviation, low, high
    square = math.log1p((deviation / mean) ** 2)
    low = math.log(low) if low > 0 else -math.inf
    return math.log(mean) - square / 2, math.sqrt(square), low, math.log(high)


def _little_left(kind: str, good: dict[str, float]) -> Iterator[Fault]:
    """A cut of which next to nothing is left."""
    mean, deviation, low, high = _bell(kind, good)
    whole = NormalDist(mean, deviation)
    # Far above the mean both would round to 1: the mirror image has them below.
    ends = (low, high) if low < mean else (2 * mean - high, 2 * mean - low)
    left = whole.cdf(ends[1]) - whole.cdf(ends[0])
    if left < LEAST_LEFT:
        cut = [name for name in ("low", "high") if name in good]
        found = " and ".join(f"{name} {good[name]:g}" for name in cut)
        yield Fault(cut[0], f"{found}, which leave {left:.1g} of the {kind} distribution",
                    "limits around its mean, of which more is left",
                    "or a uniform, triangular or beta distribution")  # fmt: skip


def _order(kind: str, good: dict[str, float]) -> Iterator[Fault]:
    """Limits the wrong way round, and a peak outside of them."""
    low, high = good.get("low", -math.inf), good.get("high", math.inf)
    if low >= high:
        yield Fault("high", f"{high:g}", f"more than low, {low:g}")
    elif not low <= good.get("mode", low if math.isfinite(low) else 0.0) <= high:
        yield Fault("mode", f"{good['mode']:g}", f"a value from low, {low:g}, to high, {high:g}")
    if kind == "lognormal" and high <= 0:
        yield Fault("high", f"{high:g}", "more than 0, where a lognormal distribution begins")
