"""A file becomes an acceleration record."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from railride.comfort.record import AccelerationRecord, Axis
from railride.errors import Faults, RowFaults
from railride.records.choice import Choice, choose
from railride.records.clock import Clock, FloatArray, read_clock
from railride.records.doubts import level_remarks, sensor_remarks
from railride.records.grid import EvenPieces, at_even_rate
from railride.records.pieces import Rows, gap_remarks, scatter, split, usual_step
from railride.records.scaling import factors
from railride.tables import Column, NumberTable, is_missing, read_table

FEWEST_ROWS = 8
LARGEST = 1e12  # m/s²: converter counts without a unit are below it
SHORTEST = 1.0  # s, of a piece between gaps: shorter ones have no running r.m.s.


def read_record(
    path: str | Path,
    columns: Sequence[str] | str | None = None,
    *,
    time_column: str | None = None,
    rate: float | None = None,
    unit: str | None = None,
    detrend: bool = False,
) -> AccelerationRecord:
    r"""Read a measured acceleration record from a file of any of the usual formats.

    path: CSV in any dialect, Parquet, WAV, MATLAB or HDF5 (:func:`railride.tables.read_table`).
    columns: headings or names of the accelerations, in the order wanted; None: those whose headings
        tell a direction (x, az, acc_y, Vertical, …), or the only column of numbers beside the time,
        then taken as z.
    time_column: heading or name of the times; None: the one that is called so, if any. Seconds, ms,
        µs or ns by its heading or size, since the start or since 1970, or dates and times of day.
    rate: samples per second (Hz) where there are no times; not together with ``time_column``.
    unit: of the accelerations: m/s^2, g, mg, or "20 m/s^2" for what the number 1 stands for. None:
        as the headings say, or m/s^2.
    detrend: whether the mean of each axis over the record is removed, and gravity with it.

    Gaps are cells that are blank or say NaN, NA, null, inv and the like, and times that jump by
    more than 1.5 steps. They end a piece and are never bridged; pieces shorter than 1 s between
    gaps are left out. Times up to 2 % of a step, or the last digit, off an even grid are rounding;
    others are resampled. Remarks tell gaps, uneven sampling, saturated and dead channels, gravity,
    and every reading that is not stated in the file.

    Raises InputError naming row and column: what :func:`railride.tables.read_table` refuses; no
    such column, or none that tells; text among the numbers; times that fall or stand still; neither
    times nor a rate, or both; a unit that is none; fewer than 8 rows, or no second without a gap.

    >>> import tempfile
    >>> path = Path(tempfile.mkdtemp()) / "ride.csv"
    >>> rows = [f"{k / 100},{0.01 * (k % 7)}" for k in range(300)]
    >>> _ = path.write_text("time,z [g]\n" + "\n".join(rows))
    >>> record = read_record(path)
    >>> record.rate, record.duration, record.axes[0].direction
    (100.0, 3.0, 'z')
    """
    faults = Faults(str(path))
    _check_rate(rate, time_column, faults)
    table = read_table(path)
    names = [columns] if isinstance(columns, str) else list(columns or ())
    choice = choose(table, names, time_column, rate)
    remarks = [*table.remarks, *choice.remarks]
    scale = factors(choice.columns, unit, faults, remarks)
    clock = _clock(table, choice, rate, scale, faults, remarks)
    if table.n < FEWEST_ROWS:
        faults.add("file", f"{table.n} rows of numbers", f"at least {FEWEST_ROWS}")
    faults.raise_if_any()
    rows, step = _pieces(table, choice, clock, faults, remarks)
    even = _even(choice, scale, clock, rows)
    for column, factor in zip(choice.columns, scale, strict=True):
        remarks += sensor_remarks(table, column, factor, clock.seconds, 1.0 / step)
    axes = _axes(choice, even)
    remarks += [*even.remarks, *level_remarks(axes, scale, even.rate, detrend)]
    return AccelerationRecord(
        name=Path(path).name,
        rate=even.rate,
        starts=even.starts,
        axes=tuple(_without_mean(axis) for axis in axes) if detrend else axes,
        remarks=tuple(dict.fromkeys(remarks)),
    )


def _check_rate(rate: float | None, time_column: str | None, faults: Faults) -> None:
    """Refuse a rate that is none, and one beside a time column."""
    if rate is not None and not (math.isfinite(rate) and rate > 0.0):
        faults.add("rate", f"{rate:g} Hz", "a rate above 0")
    if rate is not None and time_column is not None:
        found = f"both a rate, {rate:g} Hz, and a time column, {time_column!r}"
        faults.add("rate", found, "one of the two", "leave one away")
    faults.raise_if_any()


def _clock(
    table: NumberTable, choice: Choice, rate: float | None, scale: list[float], faults: Faults,
    remarks: list[str],
) -> Clock:  # fmt: skip
    """Times of the rows, by their column or by the rate; texts among the numbers are noted."""
    bad = RowFaults(faults)
    clock = None
    stated = rate if rate is not None else table.rate
    if choice.clock is not None:
        clock = read_clock(table, choice.clock, bad)
        clock = replace(clock, digit=scatter(clock.seconds, clock.digit))
    elif stated is not None:
        clock = Clock(np.arange(table.n) / stated, 0.0, ())
    else:
        faults.add(
            "time",
            "neither a time column nor a rate",
            "a column headed time (s, ms, ns or dates)",
            "name the time column by --time-column (time_column=), or give --rate HZ (rate=)",
        )
    for column, factor in zip(choice.columns, scale, strict=True):
        _note_texts(table, column, bad)
        _note_huge(table, column, factor, bad)
    bad.close()
    if rate is not None and table.rate is not None and abs(rate / table.rate - 1.0) > 1e-6:
        remarks.append(f"the rate is {rate:g} Hz as told; the file itself states {table.rate:g} Hz")
    remarks += clock.remarks if clock else ()
    return clock or Clock(np.arange(table.n, dtype=np.float64), 0.0, ())


def _note_texts(table: NumberTable, column: Column, bad: RowFaults) -> None:
    """Note cells that are neither a finite number nor say that there is none."""
    for i in column.bad.tolist():
        if not is_missing(column.cells[i]):
            mend = "decimal commas: throughout, and ; between" if "," in column.cells[i] else ""
            expected = "a finite number, or a blank where there is none"
            bad.add(table.row(i), column.heading, column.shown(i), expected, mend)


def _note_huge(table: NumberTable, column: Column, factor: float, bad: RowFaults) -> None:
    """Note numbers that are no acceleration in any unit, and whose squares would run over."""
    for i in np.flatnonzero(np.abs(column.numbers) > LARGEST / abs(factor))[: bad.shown].tolist():
        expected = f"an acceleration, below {LARGEST:g} m/s²"
        bad.add(table.row(i), column.heading, column.shown(i), expected, "cut the record there")


def _pieces(
    table: NumberTable, choice: Choice, clock: Clock, faults: Faults, remarks: list[str]
) -> tuple[Rows, float]:
    """Rows of each piece that is long enough, and the usual step (s); gaps are remarked."""
    bad = np.isnan(clock.seconds)
    for column in choice.columns:
        bad[column.bad] = True
    step = usual_step(clock.seconds, clock.digit)
    found = split(~bad, clock.seconds, step, clock.digit)
    if found.first.size == 0 or step <= 0.0:
        faults.add("file", "no two rows with all their numbers", "a record", "name other columns")
        faults.raise_if_any()
    remarks += gap_remarks(table, found, bad, clock.seconds, step)
    lengths = found.lengths
    whole = lengths.size == 1
    kept = lengths >= (FEWEST_ROWS if whole else max(FEWEST_ROWS, SHORTEST / step - 1e-6))
    if not np.any(kept):
        faults.add(
            "file",
            f"{lengths.size} pieces between gaps, of {int(lengths.max())} rows at most",
            f"one of {SHORTEST:g} s without a gap",
            "fill the gaps, or name other columns",
        )
        faults.raise_if_any()
    if not np.all(kept):
        short = lengths[~kept]
        remarks.append(f"{short.size} pieces between gaps, {np.sum(short) * step:.4g} s together, "
                       f"are shorter than {SHORTEST:g} s and left out")  # fmt: skip
    return Rows(found.first[kept], found.stop[kept]), step


def _even(choice: Choice, scale: list[float], clock: Clock, rows: Rows) -> EvenPieces:
    """Accelerations (m/s²) of each piece, all axes, at an even rate."""
    values: list[FloatArray] = []
    for piece in rows.slices():
        parts = [c.numbers[piece] * f for c, f in zip(choice.columns, scale, strict=True)]
        values.append(np.asarray(parts, dtype=np.float64))
    return at_even_rate([clock.seconds[piece] for piece in rows.slices()], values, clock.digit)


def _axes(choice: Choice, even: EvenPieces) -> tuple[Axis, ...]:
    return tuple(
        Axis(column.heading, direction, tuple(piece[j] for piece in even.values))
        for j, (column, direction) in enumerate(zip(choice.columns, choice.directions, strict=True))
    )


def _without_mean(axis: Axis) -> Axis:
    """An axis without its mean over all pieces."""
    mean = np.mean(np.concatenate(axis.pieces))
    return Axis(axis.column, axis.direction, tuple(piece - mean for piece in axis.pieces))
