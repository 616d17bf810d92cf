"""A track as CSV that reads back to the last bit."""

from __future__ import annotations

from pathlib import Path

from railride.files import write_text
from railride.track import Track


def track_text(track: Track) -> str:
    """``track`` as CSV with the columns ``distance_m,level_m``, one row per sample.

    Every number is written so that it reads back to the last bit.
    """
    pairs = zip(track.distance.tolist(), track.level.tolist(), strict=True)
    rows = "".join(f"{distance!r},{level!r}\n" for distance, level in pairs)
    return "distance_m,level_m\n" + rows


def write_track(track: Track, path: str | Path) -> None:
    """Write :func:`track_text` of ``track`` to ``path``. The file is whole or not there.

    Raises InputError where ``path`` cannot be written.
    """
    write_text(path, track_text(track))
