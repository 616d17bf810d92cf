r"""The spectrum of a track, for the exact stochastic ride over it; of a measured one by Welch.

Between the lines of Welch's estimate Ω² S(Ω), the spectrum of the slope, is linear: where a track's
spectrum is steepest it falls as 1/Ω², and what is linear between lines keeps the mean of what
scatters (a straight line between logarithms would not).

Its scatter is that of the track's length: with the window h(x) and segments that overlap by half,
the sum u of h² over them weights the track, and a line of length

.. math:: L_{eff} = \left(\textstyle\int u\,dx\right)^2 / \int u^2\,dx

weighted evenly would scatter as much.

Source: P.D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70-73.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.numeric import Array
from railride.spectra import Spectrum, check_speed, coverage_remark, fit_spectra
from railride.track import RESOLVED_SAMPLES, Track
from railride.trackfile import load_track

if TYPE_CHECKING:
    import pandas as pd

SHORTEST, LONGEST = 200.0, 1000.0  # m, of a segment, where the track's length lets one choose
_FIRST_LINE = 2  # below it the window and the straight line taken out decide
FEW = 8  # segments below which an estimate is indicative


@dataclass(frozen=True)
class MeasuredSpectrum(Spectrum):
    """A spectrum from a measured track: of ``segments`` segments of ``segment`` m each.

    effective_length : m; its values scatter as those of one run over so much track.
    """

    segments: int = 1
    segment: float = 0.0
    effective_length: float = 0.0

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Shortest and longest wavelength that it holds, m."""
        return self.band or (0.0, np.inf)

    @property
    def remark(self) -> str:
        """What it was estimated from."""
        few = ": a few segments only, indicative" if self.segments < FEW else ""
        shortest, longest = self.wavelengths
        return (
            f"{self.name}: exact values estimated from a Welch spectrum of {self.segments} "
            f"segments of {self.segment:.6g} m, wavelengths of {shortest:.3g} to {longest:.4g} m; "
            f"they scatter as one run over {self.effective_length:.4g} m of such a track{few}"
        )


def track_spectrum(
    track: str | Path | Spectrum | Track, speeds: Sequence[float] = ()
) -> tuple[Spectrum, list[str]]:
    """The spectrum that exact values come from, and what to know of it and of the track.

    Parameters
    ----------
    track : a spectrum or its name, a track or its file; a measured track's spectrum is estimated
        from the whole of it.
    speeds : m/s; of the lowest and the highest it is said what frequencies a spectrum with a band
        holds.

    Raises
    ------
    InputError : a name that is no spectrum's; a file that cannot be used; a measured track from
        which no spectrum can be estimated; a speed ≤ 0.

    Examples
    --------
    >>> track_spectrum("sncf_good", [40.0])[1]
    ['sncf_good holds wavelengths of 2 to 40 m only: at 144 km/h 1 to 20 Hz; nothing outside']
    """
    for speed in speeds:
        check_speed(speed)
    source = load_track(track)
    found = measured_spectrum(source) if isinstance(source, Track) else source
    remarks = list(source.remarks)
    if isinstance(found, MeasuredSpectrum):
        remarks.append(found.remark)
    covered = coverage_remark(found.name, found.active_band, *speeds)
    return found, [*remarks, *([covered] if covered else [])]


def measured_spectrum(track: Track, segment: float | None = None) -> MeasuredSpectrum:
    """The one-sided spectrum of a measured track's level, by Welch's method.

    Parameters
    ----------
    segment : m; default an eighth of the track, 200 to 1000 m, but at most half of the track.

    Returns
    -------
    spectrum : from the third line, half a segment long, to four samples; within the track's band.

    Raises
    ------
    InputError : a track or segment too short to hold any such line.

    Examples
    --------
    >>> from railride import spectrum, synthesise
    >>> found = measured_spectrum(synthesise(spectrum("erri_low"), 2000.0, 0.25, seed=1))
    >>> found.segments, found.band
    (14, (1.0, 125.125))
    """
    if segment is None:
        segment = min(track.length / 2, max(SHORTEST, min(LONGEST, track.length / 8)))
    wavenumber, density = track.psd(segment)
    samples = round(2 * pi / (track.step * wavenumber[1]))
    shortest, longest = track.band or (0.0, np.inf)
    shortest = max(shortest, RESOLVED_SAMPLES * track.step)
    longest = min(longest, samples * track.step / _FIRST_LINE)
    if shortest >= longest:
        raise InputError(
            f"track {track.name}: found {track.length:g} m in steps of {track.step:g} m, from "
            "which no spectrum can be estimated; expected at least "
            f"{4 * _FIRST_LINE * RESOLVED_SAMPLES} samples and a band within the track's length"
        )
    inside = (wavenumber > 2 * pi / longest) & (wavenumber < 2 * pi / shortest)
    lines, slope = wavenumber[1:], (wavenumber**2 * density)[1:]
    slope = np.maximum(slope, 1e-40 + 1e-30 * slope.max())  # a level track: as good as none
    hop = samples - samples // 2
    segments = 1 + (track.level.size - samples) // hop
    return MeasuredSpectrum(
        name=track.name,
        source=track.source or "measured",
        unit="m^2/(rad/m)",
        sidedness="one-sided",
        formula=partial(_density, lines, slope),
        band=(float(shortest), float(longest)),
        breakpoints=tuple(wavenumber[inside].tolist()),
        segments=segments,
        segment=samples * track.step,
        effective_length=track.step * _even_samples(samples, hop, segments),
    )


def _density(lines: Array, slope: Array, Omega: NDArray[np.inexact]) -> NDArray[np.inexact]:
    """S over Omega, Ω² S linear between the lines."""
    return np.asarray(np.interp(np.real(Omega), lines, slope) / Omega**2)


def _even_samples(samples: int, hop: int, segments: int) -> float:
    """(Σ u)²/Σ u² of the Hann windows' squares, summed over the segments."""
    square = np.sin(pi * np.arange(samples) / samples) ** 4
    u: Array = np.zeros(samples + hop * (segments - 1))
    for start in range(0, hop * segments, hop):
        u[start : start + samples] += square
    return float(u.sum() ** 2 / (u**2).sum())


def spectrum_fits(
    track: Track | Spectrum, candidates: Sequence[str | Spectrum] | None = None
) -> pd.DataFrame:
    """How well the standard spectra fit a track's own, by third octaves: the best first.

    Parameters
    ----------
    track : measured or made, its spectrum by :func:`measured_spectrum`; or a spectrum itself.
    candidates : spectra or their names; default all that ship.

    Returns
    -------
    table : "spectrum"; "misfit [dB]", the r.m.s. difference of the third-octave levels; "level
        ratio", of the track's r.m.s. level to the spectrum's; "from [m]", "to [m]", the wavelengths
        compared, which both hold; "third octaves", how many those are. See
        :mod:`railride.spectra.fit`.

    Raises
    ------
    InputError : as :func:`measured_spectrum`.

    Examples
    --------
    >>> from railride import synthesise
    >>> table = spectrum_fits(synthesise("sncf_good", 5000.0, 0.25, seed=1))
    >>> table["spectrum"][0], round(float(table["misfit [dB]"][0]), 1)
    ('sncf_good', 0.4)
    """
    import pandas as pd

    found = track if isinstance(track, Spectrum) else measured_spectrum(track)
    rows = [
        (fit.spectrum.name, fit.misfit_db, fit.level_ratio, *fit.wavelengths, fit.bands)
        for fit in fit_spectra(found, candidates)
    ]
    columns = ["spectrum", "misfit [dB]", "level ratio", "from [m]", "to [m]", "third octaves"]
    return pd.DataFrame(rows, columns=columns)
