"""The rating of a measured record: every index of every axis, of all axes together, and over time.

>>> import numpy as np
>>> from railride.comfort.record import AccelerationRecord, Axis
>>> t = np.arange(0, 30, 0.005)
>>> y, z = (Axis(c, c, (a * np.sin(2 * np.pi * 2 * t),)) for c, a in (("y", 0.1), ("z", 0.4)))
>>> found = rate_record(AccelerationRecord("run", 200.0, (0.0,), (y, z)))
>>> found.table()["a_wrms [m/s^2]"].round(3).tolist()
[0.063, 0.15, 0.163]
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from railride.comfort.averages import BLOCK, block_rms_of
from railride.comfort.en12299 import (
    ContinuousComfort,
    continuous_comfort_of,
    few_blocks,
    mean_comfort_levels,
    n_mv,
)
from railride.comfort.indices import ComfortIndices, indices
from railride.comfort.record import AccelerationRecord, Axis, AxisName
from railride.comfort.running import running_rms
from railride.comfort.total import AXES, Posture, VibrationTotal, find_posture, vibration_total
from railride.errors import Fault, InputError
from railride.scales import scale_remarks
from railride.weightings import FloatArray, Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

SPERLING_DIRECTIONS: dict[AxisName | None, Literal["lateral", "vertical"]] = {
    "y": "lateral",
    "z": "vertical",
}


@dataclass(frozen=True, eq=False)
class AxisRating:
    """One axis, rated.

    ``axis``: what was recorded, ``rate`` in Hz. ``indices``: with the weighted record.
    ``continuous``: the 5 s values of EN 12299; None where not one block fits or the axis' direction
    is not known.
    """

    axis: Axis
    rate: float
    indices: ComfortIndices
    continuous: ContinuousComfort | None

    @property
    def level(self) -> str:
        """The class of the paper's Table 3."""
        return self.indices.level

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → the classes that fit."""
        return {**self.indices.levels, **(self.continuous.levels if self.continuous else {})}

    @cached_property
    def running(self) -> tuple[FloatArray, ...]:
        """The linear running r.m.s. over 1 s of every piece, m/s²."""
        return tuple(running_rms(piece, self.rate) for piece in self.indices.weighted)


@dataclass(frozen=True, eq=False)
class RecordRating:
    """A record, rated: its axes in their order, what they are together, and what to know of it.

    ``total``: the vector sum, None of fewer than two axes. ``n_mv``: EN 12299's mean comfort, None
    unless x, y and z are there; the vertical part alone is ``axes[i].continuous.vertical_part``.
    """

    record: AccelerationRecord
    axes: tuple[AxisRating, ...]
    total: VibrationTotal | None
    n_mv: float | None
    remarks: tuple[str, ...]

    @property
    def duration(self) -> float:
        """Of what is rated, s."""
        return self.axes[0].indices.duration

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → classes of all axes together."""
        total = self.total.levels if self.total else {}
        return {**total, **(mean_comfort_levels(self.n_mv) if self.n_mv is not None else {})}

    def table(self) -> pd.DataFrame:
        """One row per axis, and one of all together; the units in the column names."""
        import pandas as pd

        rows = [_row(axis) for axis in self.axes]
        if self.total or self.n_mv is not None:
            rows.append(self._together())
        return pd.DataFrame(rows).dropna(axis="columns", how="all")

    def _together(self) -> dict[str, Any]:
        """The last row of the table: the vector sum stands where its parts do."""
        row: dict[str, Any] = dict.fromkeys(_row(self.axes[0]))
        row |= {"column": "together", "axis": "".join(self.total.axes) if self.total else "xyz"}
        if self.total:
            factors = ", ".join(f"{k:g}" for k in self.total.factors.values())
            row |= {"weighting": f"{self.total.posture.name}: k = {factors}",
                    "a_wrms [m/s^2]": self.total.value}  # fmt: skip
        row |= {"N_MV": self.n_mv, "comfort": "; ".join(
            f"{scale}: {' or '.join(found)}" for scale, found in self.levels.items()
        )}  # fmt: skip
        return row

    def blocks(self, duration: float = BLOCK) -> pd.DataFrame:
        """Comfort over time: one row per block of ``duration`` s, each piece from its own start.

        Of every axis the weighted r.m.s.; of blocks of 5 s also EN 12299's value and class, where
        they are there. What is left at the end of a piece is in no block.

        Raises :class:`railride.errors.InputError` for a duration that is not positive or shorter
        than a sample.
        """
        import pandas as pd

        rate = self.record.rate
        if not (np.isfinite(duration) and duration * rate >= 1):
            raise InputError(str(Fault("block", f"{duration:g} s", "a sample or more, in s")))
        found = [block_rms_of(axis.indices.weighted, rate, duration) for axis in self.axes]
        numbers = [np.arange(piece.size) for piece in found[0]]
        starts = [s + duration * n for s, n in zip(self.record.starts, numbers, strict=True)]
        columns: dict[str, Any] = {"start [s]": np.concatenate(starts)}
        for axis, values in zip(self.axes, found, strict=True):
            name, en = axis.axis.column, axis.continuous if duration == BLOCK else None
            columns[f"{name} {axis.indices.weighting} [m/s^2]"] = np.concatenate(values)
            if en is not None:
                columns[f"{name} {en.weighting} [m/s^2]"] = en.blocks
                if en.classes:
                    columns[f"{name} EN 12299 comfort"] = np.array(en.classes)
        return pd.DataFrame(columns)

    def _repr_html_(self) -> str:
        return str(self.table().to_html(index=False, float_format="%.4g", na_rep=""))


def _row(axis: AxisRating) -> dict[str, Any]:
    found, en = axis.indices, axis.continuous
    return {
        "column": axis.axis.column,
        "axis": axis.axis.direction,
        "weighting": found.weighting,
        "a_rms [m/s^2]": found.a_rms,
        "a_wrms [m/s^2]": found.a_wrms,
        "MTVV [m/s^2]": found.mtvv,
        "MTVV exponential [m/s^2]": found.mtvv_exp,
        "VDV [m/s^1.75]": found.vdv,
        "crest factor": found.crest_factor,
        "Wz": found.wz,
        "EN 12299 weighting": en.weighting if en else None,
        "a_P95 [m/s^2]": en.p95 if en else None,
        "6 a_z,P95": en.vertical_part if en else None,
        "N_MV": None,
        "comfort": axis.level,
    }


def rate_record(
    record: AccelerationRecord,
    *,
    weightings: Sequence[str | Weighting | None] = (),
    posture: str | Posture = "standing",
) -> RecordRating:
    """Rate every axis of a measured record, all together, and over time.

    Parameters
    ----------
    record : accelerations, m/s², in one or several pieces (:func:`railride.comfort.indices` says
        how these are pooled).
    weightings : one per axis, in the order of the axes, by name; None, or none at all, for that of
        the posture (W_k where an axis has no direction).
    posture : "standing", "seat", "backrest", "feet" or "recumbent": the vector sum's factors.

    Raises
    ------
    InputError : an unknown weighting or posture, or more or fewer weightings than axes.

    Examples
    --------
    >>> import numpy as np
    >>> tone = np.sin(2 * np.pi * 8.0 * np.arange(20_000) / 1000)
    >>> run = AccelerationRecord("run", 1000.0, (0.0,), (Axis("floor", "z", (tone,)),))
    >>> round(rate_record(run).axes[0].indices.a_wrms, 2)
    0.73
    """
    chosen = find_posture(posture)
    if weightings and len(weightings) != len(record.axes):
        raise InputError(str(Fault("weightings", str(len(weightings)), f"one for each of the "
                                   f"{len(record.axes)} axes")))  # fmt: skip
    asked: dict[AxisName | None, str] = {None: "Wk", **dict(zip(AXES, chosen.weightings,
                                                                strict=True))}  # fmt: skip
    given = [weighting(own or asked[axis.direction])
             for own, axis in zip(weightings or [None] * len(record.axes), record.axes,
                                  strict=True)]  # fmt: skip
    axes = tuple(_rate_axis(axis, record.rate, weight)
                 for axis, weight in zip(record.axes, given, strict=True))  # fmt: skip
    by_direction = _by_direction(axes)
    total = vibration_total({a: (one.indices.weighting, one.indices.a_wrms)
                             for a, one in by_direction.items()}, chosen)  # fmt: skip
    return RecordRating(record, axes, total, _mean_comfort(by_direction),
                        tuple(_remarks(record, axes, total)))  # fmt: skip


def _rate_axis(axis: Axis, rate: float, weight: Weighting) -> AxisRating:
    """Weight an axis once for its indices, and again where EN 12299 asks for another weighting."""
    found = indices(axis.pieces, rate, weight, direction=SPERLING_DIRECTIONS.get(axis.direction))
    if axis.direction is None:
        return AxisRating(axis, rate, found, None)
    over_time = continuous_comfort_of(found, axis.pieces, rate, axis.direction)
    return AxisRating(axis, rate, found, over_time)


def _by_direction(axes: Iterable[AxisRating]) -> dict[AxisName, AxisRating]:
    """Direction → its axis, of the directions that were recorded once."""
    count = Counter(one.axis.direction for one in axes)
    return {one.axis.direction: one for one in axes
            if one.axis.direction is not None and count[one.axis.direction] == 1}  # fmt: skip


def _mean_comfort(by_direction: dict[AxisName, AxisRating]) -> float | None:
    """N_MV, if x, y and z are there and are long enough."""
    found = [by_direction[axis].continuous for axis in AXES if axis in by_direction]
    blocks = [one.blocks for one in found if one is not None]
    return float(n_mv(*blocks)) if len(blocks) == len(AXES) else None


def _remarks(
    record: AccelerationRecord, axes: Sequence[AxisRating], total: VibrationTotal | None
) -> list[str]:
    """The record's own remarks, and those of its axes, which several may share."""
    said: dict[str, list[str]] = {}
    for one in axes:
        for text in one.indices.remarks:
            said.setdefault(text, []).append(one.axis.column)
    remarks = [*record.remarks, *(f"{', '.join(c)}: {text}" for text, c in said.items())]
    unknown = [one.axis.column for one in axes if one.axis.direction is None]
    if unknown:
        remarks.append(f"{', '.join(unknown)}: no direction is known, so no W_z, no EN 12299 value "
                       "and no part in the vector sum")  # fmt: skip
    twice = [a for a, n in Counter(one.axis.direction for one in axes).items() if a and n > 1]
    if twice:
        remarks.append(f"{', '.join(twice)} is recorded more than once: left out of the vector sum "
                       "and of N_MV")  # fmt: skip
    remarks += total.remarks if total else ()
    remarks += few_blocks([one.continuous for one in axes])
    return remarks + scale_remarks([one.indices.weighting for one in axes],
                                   [one.level for one in axes])  # fmt: skip
