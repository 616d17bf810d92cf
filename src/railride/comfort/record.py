"""A measured acceleration record: one or several axes, in one or several contiguous pieces."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from railride.errors import Faults
from railride.weightings import FloatArray

AxisName = Literal["x", "y", "z"]


@dataclass(frozen=True, eq=False)
class Axis:
    """What one sensor axis recorded.

    ``column``: its name in the file. ``direction``: "x" forward, "y" to the side, "z" up, or None
    where it is not known. ``pieces``: contiguous stretches in time order, each (n,), m/s².
    """

    column: str
    direction: AxisName | None
    pieces: tuple[FloatArray, ...]

    def __post_init__(self) -> None:
        pieces = tuple(np.asarray(piece, dtype=np.float64).view() for piece in self.pieces)
        for piece in pieces:
            piece.flags.writeable = False
        object.__setattr__(self, "pieces", pieces)


@dataclass(frozen=True, eq=False)
class AccelerationRecord:
    """Axes recorded together at ``rate`` Hz, whole or with gaps between their pieces.

    ``name``: what to call the record. ``starts``: time of the first sample of every piece, s.
    ``axes``: all with pieces of the same lengths. ``remarks``: what its user must know of it.

    Raises :class:`railride.errors.InputError`, all faults together, for a rate that is not positive
    and finite; no axis, no piece, or a piece that is empty or not in a row; axes whose pieces
    differ in length; columns of the same name; values that are not finite; starts that are not as
    many as the pieces, or of which one lies before the end of the piece before it.

    >>> z = Axis("z", "z", (np.zeros(100), np.zeros(50)))
    >>> AccelerationRecord("run", 100.0, (0.0, 2.0), (z,)).duration
    1.5
    """

    name: str
    rate: float
    starts: tuple[float, ...]
    axes: tuple[Axis, ...]
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("starts", "axes", "remarks"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        faults = Faults(f"record {self.name}")
        if not (math.isfinite(self.rate) and self.rate > 0):
            faults.add("sampling rate", f"{self.rate} Hz", "a positive, finite rate in Hz")
        if not self.axes:
            faults.add("axes", "none", "at least one")
        columns = [axis.column for axis in self.axes]
        for column in sorted({c for c in columns if columns.count(c) > 1}):
            faults.add("columns", f"{column!r} {columns.count(column)} times", "each name once")
        for axis in self.axes:
            _check_axis(faults, axis)
        faults.raise_if_any()
        lengths = self.lengths
        for axis in self.axes[1:]:
            if (found := tuple(piece.size for piece in axis.pieces)) != lengths:
                faults.add(f"column {axis.column}", f"pieces of {found} samples", f"{lengths}, as "
                           f"column {self.axes[0].column} has them")  # fmt: skip
        self._check_starts(faults)
        faults.raise_if_any()

    def _check_starts(self, faults: Faults) -> None:
        """One finite start a piece, none before the end of the piece before (half a sample off)."""
        if len(self.starts) != len(self.lengths) or not all(map(math.isfinite, self.starts)):
            faults.add("starts", self.starts, f"{len(self.lengths)} finite times in s, one a piece")
            return
        for number, (one, following) in enumerate(pairwise(self.starts), start=1):
            end = one + (self.lengths[number - 1] - 0.5) / self.rate
            if following < end:
                faults.add(f"piece {number} (counted from 0)", f"a start at {following:.6g} s",
                           f"one after the piece before it, which ends at {end:.6g} s")  # fmt: skip

    @property
    def lengths(self) -> tuple[int, ...]:
        """Samples of every piece."""
        return tuple(piece.size for piece in self.axes[0].pieces)

    @property
    def duration(self) -> float:
        """Recorded time, gaps not counted, s."""
        return sum(self.lengths) / self.rate


def _check_axis(faults: Faults, axis: Axis) -> None:
    """Pieces that are rows of finite numbers."""
    where = f"column {axis.column}"
    if axis.direction not in (None, "x", "y", "z"):
        faults.add(where, f"direction {axis.direction!r}", "'x', 'y', 'z' or None")
    if not axis.pieces:
        faults.add(where, "no piece", "at least one")
    for number, piece in enumerate(axis.pieces):
        at = f"{where}, piece {number} (counted from 0)"
        if piece.ndim != 1 or piece.size == 0:
            faults.add(at, f"shape {piece.shape}", "at least one sample, in a row")
        elif not (finite := np.isfinite(piece)).all():
            first = int(np.argmin(finite))
            faults.add(at, f"{piece[first]} at sample {first}", "finite numbers, in m/s²",
                       "end the piece before it and begin another after it")  # fmt: skip
