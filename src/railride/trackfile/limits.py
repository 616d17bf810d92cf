"""The band of wavelengths that a level itself shows: beyond it, its Fourier series is zero.

A track made from a spectrum of limited band (:func:`railride.track.synthesise`) is a Fourier series
over its n samples with lines in the band alone: the others are rounding, 1e-16 of the largest,
where those of any record are not. So a written track need not state its band, and one that was cut,
rounded or resampled since shows none.
"""

from __future__ import annotations

import numpy as np

from railride.spectra import FloatArray

_NOTHING = 1e-13  # of the largest line: rounding
_SOMETHING = 1e-11  # any line that was meant to be there
_FEWEST = 16  # lines in a row; a few tones are no band


def shown_band(level: FloatArray, step: float) -> tuple[float, float] | None:
    """Shortest and longest wavelength (m) of ``level`` (n,), m, ``step`` m apart, if limited.

    From line to line, n h/k: the first empty ones beside the lines that are there, so that the band
    is never too narrow.

    >>> from railride.track import synthesise
    >>> made = synthesise("sncf_poor", 1000.0, 0.25, 1)
    >>> made.band, [round(limit, 2) for limit in shown_band(made.level, made.step)]
    ((2.0, 40.0), [2.0, 40.01])
    """
    from scipy import fft

    n = level.size
    lines = np.abs(fft.rfft(level - np.mean(level)))[1:]
    lines /= np.max(lines) or 1.0
    there = lines > _NOTHING
    first, last = int(np.argmax(there)), lines.size - 1 - int(np.argmax(there[::-1]))
    held = lines[first : last + 1]
    if held.size < _FEWEST or held.size == lines.size or np.min(held) < _SOMETHING:
        return None
    shortest = n * step / (last + 2) if last + 1 < lines.size else 2.0 * step
    return shortest, n * step / max(first, 1)
