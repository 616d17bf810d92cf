"""A ride as an export holds it: a track, where the vehicle stands on it, how it starts."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railride.errors import Faults, InputError
from railride.exports.content import Content
from railride.frequency import FLOOR, wheelset_delays
from railride.numeric import Array
from railride.quantities import check_number
from railride.ridden import coverage, rated_section, ridden_track
from railride.spectra import Spectrum
from railride.spectra.density import check_speed
from railride.timerun import following, run_in_time, with_run_in
from railride.track import Track
from railride.trackfile import load_track
from railride.weightings import Weighting, weighting

MOST_ROWS = 1_000_000  # of a track's table: 100 MB of text


@dataclass(frozen=True, eq=False)
class Setup:
    """A run over a track at a speed, from the start of its run-in.

    speed : V, m/s. track : its name. start : m, where the leading wheelset is at time 0.
    distance0, step : m, of the first row and from row to row of ``pieces`` (n, 3), level (m), slope
    (m/m) and curvature (1/m) of the track. run_in, length : m, before the rated section and of it.
    behind (wheelsets,) : m, of each wheelset behind the leading one. q, dq : coordinates and rates
    at time 0, of a vehicle that follows the track without inertia. weighting : of the floor's
    acceleration.
    """

    speed: float
    track: str
    start: float
    distance0: float
    step: float
    pieces: Array
    run_in: float
    length: float
    behind: Array
    q: Array
    dq: Array
    weighting: Weighting
    remarks: tuple[str, ...] = ()

    @property
    def duration(self) -> float:
        """The run's time in s, run-in and rated section."""
        return (self.run_in + self.length) / self.speed


def ride_setup(
    content: Content,
    track: str | Path | Spectrum | Track,
    speed: float = 145 / 3.6,
    *,
    length: float = 1000.0,
    seed: int = 1,
    weight: str | Weighting = "Wk",
) -> Setup:
    """The run of :func:`railride.ride` as an export holds it.

    Parameters
    ----------
    track : a spectrum by name or a measured track by its file, or either as it is.
    speed : V in m/s. length : of the rated section, m. seed : of a synthetic track.
    weight : the frequency weighting.

    Raises
    ------
    InputError : a track that does not exist, is shorter than ``length``, or has more rows than
        ``MOST_ROWS``; a speed or length that is none; an unstable vehicle; no acceleration of the
        floor among the outputs, which the ride weights.
    """
    if not any(output.name.startswith(FLOOR) for output in content.outputs):
        listed = ", ".join(output.name for output in content.outputs)
        raise InputError(f"track: found a ride with the outputs {listed}; expected {FLOOR!r} among "
                         "them, which it weights")  # fmt: skip
    check_speed(speed)
    faults = Faults("track")
    check_number(faults, "length", length, "> 0", "m")
    faults.raise_if_any()
    model, weight = content.model, weighting(weight)
    source = load_track(track)
    line = ridden_track(source, [speed], length, seed)
    settling, remark = run_in_time(model, content.system, speed, weight)
    line, run_in = with_run_in(model, speed, line, length, speed * settling)
    start = line.end - length - run_in
    behind = speed * wheelset_delays(model, speed)
    w, slope = line.elevation(start - behind)
    q, dq = following(content.dynamics, w, speed * slope)
    first = max(0, int(np.floor((start - behind.max() - line.distance0) / line.step)))
    pieces = line.pieces()[first:]
    if len(pieces) > MOST_ROWS:
        raise InputError(f"track: found a table of {len(pieces):,} rows; expected {MOST_ROWS:,} at "
                         "most, which another tool can hold (a shorter length)")  # fmt: skip
    said = [*rated_section(source, length), *line.remarks, *coverage(source, speed), remark]
    return Setup(
        speed, line.name, start, line.distance0 + first * line.step, line.step,
        pieces, run_in, length, behind, q, dq, weight,
        remarks=tuple(filter(None, said)),
    )  # fmt: skip
