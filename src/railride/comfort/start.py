"""How much of a weighted r.m.s. is decided by what came before the record, which nobody knows.

A filter's first output rests on the time before the first sample. It is predicted
(:mod:`railride.weightings.prediction`), which is right for tones and a guess for slow random
motion. How much that matters is seen by another guess: that the record stood at its own mean.
"""

from __future__ import annotations

import math

import numpy as np

from railride.weightings import FloatArray, Weighting, apply_weighting

REACH = 60.0
"""s: by then every weighting has forgotten its start, that of motion sickness too."""

DECISIVE = 0.01
"""Of the r.m.s.: a difference that is told."""


def held_rms(
    record: FloatArray, weighted: FloatArray, rate: float, weight: Weighting, rated: slice
) -> float:
    """The weighted r.m.s. of ``record[rated]``, had the record stood at its mean before it began.

    ``record`` (n,), m/s², at ``rate`` Hz; ``weighted``: the same, ``weight`` applied with a
    predicted start. Only the first minute is weighted again.
    """
    early = record[: math.ceil(REACH * rate)]
    held = weighted.copy()
    held[: early.size] = apply_weighting(weight, early, rate, before=float(np.mean(record)))
    return math.sqrt(float(np.mean(held[rated] ** 2)))


def start_remark(predicted: float, held: float) -> str | None:
    """What to know of the r.m.s. with a ``predicted`` start (m/s²) if that with a ``held`` differs.

    >>> start_remark(0.2, 0.201) is None
    True
    """
    if abs(held - predicted) <= DECISIVE * predicted:
        return None
    return (
        "the weighted values rest on what came before the record began, which is not known: a_wrms "
        f"is {predicted:.3g} m/s² with that predicted from the record, as given here, and "
        f"{held:.3g} m/s² had it stood at its mean; a longer record decides it"
    )
