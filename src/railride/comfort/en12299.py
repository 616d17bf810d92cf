"""Mean and continuous comfort of EN 12299, from r.m.s. values over 5 s at the floor.

Source: EN 12299, as commonly quoted (the standard was not read); earlier UIC 513.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort.averages import block_rms_of
from railride.comfort.indices import ComfortIndices, pieces_of
from railride.comfort.record import AxisName
from railride.scales import (
    EN_12299_CONTINUOUS,
    EN_12299_MEAN,
    EN_12299_VERTICAL,
    UIC_513,
    UIC_513_VERTICAL,
    classes_of,
    rate,
)
from railride.weightings import FloatArray, apply_weighting, checked_record

WEIGHTINGS: dict[AxisName, str] = {"x": "Wd", "y": "Wd", "z": "Wb_en12299"}
"""Direction → weighting."""

ENOUGH = 60
"""Blocks: five minutes; the values of fewer are indicative."""


def n_mv(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """N_MV = 6 √(a_x,P95² + a_y,P95² + a_z,P95²), from r.m.s. values over 5 s at the floor.

    ``x``, ``y``, ``z`` (..., blocks) in m/s², as :func:`railride.comfort.block_rms` gives them:
    x and y weighted W_d, z weighted W_b of EN 12299 (``Wb_en12299``); 95th percentiles by linear
    interpolation. Fewer than 60 blocks are indicative only. Source: EN 12299, mean comfort.
    """
    squares = [percentile_95(a) ** 2 for a in (x, y, z)]
    return np.asarray(6 * np.sqrt(sum(squares)))


def percentile_95(blocks: ArrayLike) -> FloatArray:
    """a_P95 of r.m.s. values ``blocks`` (..., blocks), by linear interpolation.

    >>> float(percentile_95([1.0, 2.0, 3.0]))
    2.9
    """
    return np.asarray(np.percentile(checked_record(blocks, 1.0), 95, axis=-1))


def mean_comfort_levels(value: float) -> dict[str, list[str]]:
    """Scale → classes of N_MV: EN 12299's own and UIC 513's."""
    return rate(value, EN_12299_MEAN, UIC_513)


@dataclass(frozen=True, eq=False)
class ContinuousComfort:
    """C_Cx(t), C_Cy(t) or C_Cz(t): r.m.s. values of consecutive 5 s of one axis at the floor.

    ``direction``: "x", "y" or "z". ``blocks`` (n,), n ≥ 1: the values, m/s², weighted W_d (x, y) or
    W_b of EN 12299 (z).
    """

    direction: AxisName
    blocks: FloatArray

    @property
    def weighting(self) -> str:
        """The weighting's name."""
        return WEIGHTINGS[self.direction]

    @property
    def p95(self) -> float:
        """a_P95, m/s²."""
        return float(percentile_95(self.blocks))

    @property
    def vertical_part(self) -> float | None:
        """6 a_z,P95, all that the vertical axis adds to N_MV and so never above it; z alone."""
        return 6 * self.p95 if self.direction == "z" else None

    @property
    def classes(self) -> tuple[str, ...]:
        """Class of every block; none in x, which the scale is not made for."""
        if self.direction == "x":
            return ()
        return tuple(classes_of(EN_12299_CONTINUOUS, float(a))[0] for a in self.blocks)

    @property
    def shares(self) -> dict[str, float]:
        """Class → its share of the blocks, better first, zeros too."""
        found = self.classes
        labels = [entry.label for entry in EN_12299_CONTINUOUS.classes] if found else []
        return {label: found.count(label) / len(found) for label in labels}

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → classes: all that any block is in, and those of the vertical part."""
        shares, vertical = self.shares, self.vertical_part
        held = {EN_12299_CONTINUOUS.name: [label for label, share in shares.items() if share]}
        part = {} if vertical is None else rate(vertical, EN_12299_VERTICAL, UIC_513_VERTICAL)
        return {**(held if shares else {}), **part}


def few_blocks(found: Iterable[ContinuousComfort | None]) -> list[str]:
    """What to know where mean comfort rests on few blocks: one remark on all that was ``found``."""
    few = sorted({one.blocks.size for one in found if one and one.blocks.size < ENOUGH})
    if not few:
        return []
    count = str(few[0]) if len(few) == 1 else f"{few[0]} to {few[-1]}"
    blocks = f"{count} block{'' if few == [1] else 's'} of 5 s, fewer than {ENOUGH}"
    return [f"EN 12299: {blocks}: mean comfort, or its vertical part, is indicative"]


def continuous_comfort(
    weighted: Sequence[FloatArray], rate: float, direction: AxisName
) -> ContinuousComfort | None:
    """The 5 s values of pieces that are weighted as EN 12299 asks; None where not one fits.

    ``weighted``: one or several stretches (n,), m/s², at ``rate`` Hz, each cut into blocks from its
    own start; what is left at its end is not counted. ``direction``: "x", "y" or "z".
    """
    blocks = np.concatenate(block_rms_of(weighted, rate))
    return ContinuousComfort(direction, blocks) if blocks.size else None


def continuous_comfort_of(
    found: ComfortIndices,
    record: ArrayLike | Sequence[FloatArray],
    rate: float,
    direction: AxisName,
    *,
    section: slice = slice(None),
    before: float | None = None,
) -> ContinuousComfort | None:
    """The 5 s values of an axis that is rated: weighted again only if ``found`` is otherwise.

    ``record``, ``rate``, ``section`` and ``before`` as :func:`railride.comfort.indices` had them.
    """
    own, weighted = WEIGHTINGS[direction], found.weighted
    if found.weighting != own:
        pieces = pieces_of(record, rate)
        weighted = tuple(apply_weighting(own, piece, rate, before=before) for piece in pieces)
    return continuous_comfort([piece[section] for piece in weighted], rate, direction)
