"""The running r.m.s. of a weighted record, and its largest value."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import Fault, InputError
from railride.weightings import FloatArray, checked_record

Averaging = Literal["linear", "exponential"]


def running_rms(
    record: ArrayLike, rate: float, tau: float = 1.0, kind: Averaging = "linear"
) -> FloatArray:
    """Running r.m.s. a_w(t_0) of a weighted record, with integration time τ = ``tau`` (s)::

        linear       √((1/τ) ∫ a_w² dt), from t_0 − τ to t_0
        exponential  √((1/τ) ∫ a_w² e^((t − t_0)/τ) dt), from −∞ to t_0

    Before the record there is nothing: a window that reaches back beyond the first sample has less
    in it. The result has the record's shape. τ need not be a whole number of samples.

    Source: ISO 2631-1:1997, Eqs (2) and (3).
    """
    found = _running_mean_square(record, rate, tau, kind)
    return np.asarray(np.sqrt(found, out=found))


def mtvv(
    record: ArrayLike, rate: float, tau: float = 1.0, kind: Averaging = "linear"
) -> FloatArray:
    """MTVV = max a_w(t_0): the largest running r.m.s. of a weighted record, shape (...).

    Nothing before the record counts: for the linear form these are the windows that lie wholly
    within it (if it lasts at least τ). Source: ISO 2631-1:1997, Eq (4); τ = 1 s.
    """
    return np.asarray(np.sqrt(np.max(_running_mean_square(record, rate, tau, kind), axis=-1)))


def _running_mean_square(record: ArrayLike, rate: float, tau: float, kind: str) -> FloatArray:
    """The square of the running r.m.s., of the record's shape."""
    values = checked_record(record, rate)
    if not (math.isfinite(tau) and tau > 0):
        raise InputError(str(Fault("integration time", f"{tau} s", "a positive time in s")))
    if kind == "exponential":
        from scipy.signal import lfilter

        decay = math.exp(-1 / (rate * tau))
        return np.asarray(lfilter([1 - decay], [1, -decay], values**2, axis=-1))
    if kind != "linear":
        raise InputError(str(Fault("running r.m.s.", repr(kind), "'linear' or 'exponential'")))
    return _mean_over_window(values**2, tau * rate)


def _mean_over_window(square: FloatArray, window: float) -> FloatArray:
    """(1/w) ∫ over the ``window`` w, in samples, that ends with each sample.

    Of the sample that the window begins in, it holds the share that lies inside.
    """
    whole = math.floor(window * (1 + 1e-12))
    share = max(window - whole, 0.0)
    integral = np.cumsum(square, axis=-1)
    result = integral.copy()
    left = max(square.shape[-1] - whole, 0)
    result[..., whole:] -= integral[..., :left]
    if share:
        result[..., whole:] += share * square[..., :left]
    # A difference of two sums may round to just below zero.
    return np.asarray(np.maximum(result, 0.0, out=result) / window)
