r"""Which parameter the scatter of a quantity comes from: Sobol's indices.

.. math:: S_i = \frac{V[E(y \mid x_i)]}{V[y]}, \qquad
          S_{T,i} = 1 - \frac{V[E(y \mid x_{\sim i})]}{V[y]} :

the share of the variance that goes if x_i is known (first order), and the share that stays as long
as x_i is not known (total: with all that it does together with others). They are estimated from two
samples A and B of n designs and, for each parameter, A with its column from B. The intervals are of
the bootstrap over the n rows, at 95 %.

Source: A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, Table 2 (b) and (f); the estimates
are scipy.stats.sobol_indices'.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railride.numeric import Array
from railride.uncertainties.estimates import LEVEL, RESAMPLES, Estimate

ROUNDING = 1e-9  # of the value: what scatters less does so by rounding


@dataclass(frozen=True)
class Indices:
    """Of one quantity, per parameter in their order. rows : how many rows they come from."""

    first: tuple[Estimate, ...]
    total: tuple[Estimate, ...]
    rows: int


def crossed(A: Array, B: Array) -> Array:
    """A with one column from B, for each of the P columns, one after the other: (P n, P).

    A, B : designs, (n, P).
    """
    found = np.repeat(A[np.newaxis], A.shape[1], axis=0)
    for k in range(A.shape[1]):
        found[k, :, k] = B[:, k]
    return found.reshape(-1, A.shape[1])


def indices(a: Array, b: Array, ab: Array, seed: int) -> Indices | None:
    """Indices of one quantity from its values; None where it does not scatter at all.

    Rows without a value in any sample are left out, and of the rest the largest power of two is
    used, as the estimator asks for.

    a, b : of the designs A and B, (n,). ab : of the crossed designs, (P, n). seed : of the
    bootstrap.
    """
    from scipy import stats

    good = np.flatnonzero(np.isfinite(a) & np.isfinite(b) & np.isfinite(ab).all(axis=0))
    rows = good[: 2 ** (good.size.bit_length() - 1)] if good.size >= 2 else good[:0]
    spread = np.ptp(np.concatenate([a[rows], b[rows]])) if rows.size else 0.0
    if not spread > ROUNDING * np.abs(a[rows]).max(initial=0.0):
        return None

    def both(chosen: NDArray[Any]) -> Array:
        at = chosen.astype(int)
        sampled = {
            "f_A": a[np.newaxis, at],
            "f_B": b[np.newaxis, at],
            "f_AB": ab[:, np.newaxis, at],
        }
        if len(ab) == 1:  # scipy makes no array of one: its twin beside it changes nothing
            sampled["f_AB"] = np.repeat(sampled["f_AB"], 2, axis=0)
        found = stats.sobol_indices(func=sampled, n=at.size)
        both_orders = np.array([found.first_order, found.total_order])
        return np.ravel(both_orders[:, : len(ab)])

    drawn = stats.bootstrap((rows,), both, vectorized=False, n_resamples=RESAMPLES, batch=1,
                            method="percentile", confidence_level=LEVEL, rng=seed)  # fmt: skip
    low, high = drawn.confidence_interval
    found = tuple(Estimate(*map(float, each)) for each in zip(both(rows), low, high, strict=True))
    half = len(found) // 2
    return Indices(found[:half], found[half:], rows.size)
