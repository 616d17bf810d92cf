"""The track of a ride: synthetic with a run-in or measured, and what it does not hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from railride.quantities import in_kmh
from railride.spectra import Spectrum, coverage_remark
from railride.stochastic import BAND_HZ
from railride.timerun import LONGEST_RUN_IN
from railride.track import Track, recommended_step, resolved_band_hz, synthesise

TRACK_BEFORE = 1750.0  # m of synthetic track before the rated section: one track for all speeds


def ridden_track(
    source: Spectrum | Track, speeds: Sequence[float], length: float, seed: int
) -> Track:
    """The measured track, or a synthetic one with enough of it before the rated section.

    It is one track for all speeds and bodies: its length does not depend on their run-ins.
    """
    if isinstance(source, Track):
        return source
    longest = LONGEST_RUN_IN * max(speeds) + 50.0
    before = max(TRACK_BEFORE, 250.0 * np.ceil(longest / 250.0))
    track = synthesise(source, length + before, recommended_step(min(speeds)), seed)
    return replace(track, distance0=-before)


def coverage(source: Spectrum | Track, speed: float) -> list[str]:
    """A remark where the track does not hold all frequencies of a ride."""
    if isinstance(source, Spectrum):
        remark = coverage_remark(source.name, source.active_band, speed)
        return [remark] if remark else []
    low, high = resolved_band_hz(source, speed)
    if low > high:
        limits = f"its length holds {low:.3g} Hz and above, its steps or its band {high:.3g} Hz"
        return [
            f"{in_kmh(speed)}: {source.name} can be trusted at no frequency: {limits} and below"
        ]
    text = f"{in_kmh(speed)}: {source.name} can be trusted from {low:.2g} to {high:.3g} Hz"
    narrow = f"{text} only: what the vehicle would feel outside is missing from the values"
    return [narrow if high < BAND_HZ[1] else text]


def rated_section(source: Spectrum | Track, length: float) -> list[str]:
    """A remark that names the rated part of a measured track."""
    if isinstance(source, Spectrum) or source.length <= length:
        return []
    rated = f"{source.end - length:g} to {source.end:g} m"
    return [f"rated are the last {length:g} m of {source.name}, {rated} of {source.length:g} m"]
