"""Pictures of tracks: level over distance, and its spectrum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.plots import canvas
from railride.spectra import D1, D2, Fit, FloatArray, Spectrum
from railride.track import Track
from railride.units import to_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_LEAST = 1e-10  # of the largest density: what lies lower is the estimate's own leakage
# First word of a name → what the legend calls the family, and its colour (as in canvas).
_FAMILIES = {
    "erri": ("ERRI high, low", "#0072B2"),
    "fra": ("FRA class 1 to 6, downwards", "#009E73"),
    "sncf": ("SNCF poor, good", "#CC79A7"),
    "china": ("Chinese ballastless", "#E69F00"),
}
_MARGIN = 0.1  # of the least density of the spectrum, which shows what it is made of


def plot_track(track: Track, *, ax: Axes | None = None) -> Axes:
    """Draw the level w in mm over the distance x in m.

    Source: as Figure 7 of Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848.
    """
    ax = canvas.axes_or_new(ax, 7.0, 2.8)
    level = to_unit(track.level, "mm")
    ax.plot(*canvas.outline(track.distance, level), color=canvas.TRACK, linewidth=0.8)
    ax.set_title(f"{track.name}: r.m.s. {to_unit(track.rms(), 'mm'):.3g} mm", **canvas.TITLE)
    ax.set_xlabel("distance [m]")
    ax.set_ylabel("longitudinal level [mm]")
    ax.set_xlim(track.distance0, track.end)
    ax.ticklabel_format(useOffset=False)
    canvas.tidy(ax)
    return ax


def plot_track_spectrum(
    track: Track,
    spectrum: Spectrum | None = None,
    *,
    fits: Sequence[Fit] = (),
    ax: Axes | None = None,
) -> Axes:
    """Draw the track's density S(Omega), m²/(rad/m), over Omega, rad/m, with D1 and D2 shaded.

    track : its density is Welch's estimate, :meth:`railride.track.Track.psd`.
    spectrum : drawn beside it inside its own band, where the track is to be compared with it.
    fits : of other spectra (:func:`railride.spectra.fit_spectra`), drawn thin beside it; the best
        is marked where no ``spectrum`` is.
    """
    ax = canvas.axes_or_new(ax, 7.0, 4.2)
    wavenumber, density = (part[1:] for part in track.psd())  # Omega = 0 has no place on a log
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlim(wavenumber[0], wavenumber[-1])
    there = density > 0.0  # nowhere on a level track
    ax.plot(wavenumber[there], density[there], color=canvas.TRACK, linewidth=0.9,
            label=f"{track.name}, Welch's estimate")  # fmt: skip
    marked, label = _marked(spectrum, fits)
    compared = np.zeros(0)
    if marked is not None:
        inside, compared = _inside(marked, wavenumber[0], wavenumber[-1])
        ax.plot(inside, compared, color=canvas.SPECTRUM, linewidth=1.6, label=label)
    highest = max(density.max(), compared.max(initial=0.0))
    if highest > 0.0:  # a level track has no density to show
        least = compared.min() if compared.size else _LEAST * highest
        lowest = max(_MARGIN * least, density[density > 0.0].min(initial=least))
        ax.set_ylim(lowest / 3.0, 3.0 * highest)
    _draw_families(ax, [fit.spectrum for fit in fits], (wavenumber[0], wavenumber[-1]))
    for name, band, shade in (("D1", D1, 0.30), ("D2", D2, 0.15)):
        ax.axvspan(2 * np.pi / band[1], 2 * np.pi / band[0], color=canvas.REST, alpha=shade,
                   linewidth=0, zorder=0, label=f"{name}, {band[0]:g}–{band[1]:g} m")  # fmt: skip
    ax.set_xlabel("wavenumber Ω [rad/m]")
    ax.set_ylabel("density of the level S(Ω) [m²/(rad/m)]")
    if fits:  # many lines leave no room inside
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.17), ncols=2, frameon=False)
    else:
        ax.legend(loc="upper right")  # where falling spectra leave room
    canvas.tidy(ax)
    _wavelengths_on_top(ax)
    return ax


def plot_track_overview(
    track: Track, spectrum: Spectrum | None = None, *, fits: Sequence[Fit] = ()
) -> Figure:
    """Draw the level above, the spectrum below.

    spectrum, fits : as in :func:`plot_track_spectrum`.
    """
    figure = canvas.new_figure(7.5, 7.6 if fits else 6.8)
    above, below = figure.subplots(2, 1, height_ratios=(2, 4 if fits else 3))
    plot_track(track, ax=above)
    plot_track_spectrum(track, spectrum, fits=fits, ax=below)
    return figure


def _marked(spectrum: Spectrum | None, fits: Sequence[Fit]) -> tuple[Spectrum | None, str]:
    """The spectrum to be marked, and what to call it."""
    if spectrum is not None:
        return spectrum, f"spectrum {spectrum.name}"
    if not fits:
        return None, ""
    best = fits[0]
    return best.spectrum, f"{best.spectrum.name} fits best, to {best.misfit_db:.1f} dB"


def _draw_families(ax: Axes, spectra: Sequence[Spectrum], limits: tuple[float, float]) -> None:
    """Spectra as thin lines, one colour and one entry in the legend for each family."""
    for family, (label, colour) in _FAMILIES.items():
        drawn = [_inside(s, *limits) for s in spectra if s.name.partition("_")[0] == family]
        for number, (wavenumber, density) in enumerate(drawn):
            ax.plot(wavenumber, density, color=colour, linewidth=0.7, zorder=1.5,
                    label="" if number else label)  # fmt: skip


def _inside(spectrum: Spectrum, lowest: float, highest: float) -> tuple[FloatArray, FloatArray]:
    """The density where it is not zero, between two wavenumbers (rad/m)."""
    low, high = spectrum.limits
    first, last = max(lowest, low), min(highest, high)
    if first >= last:
        return np.zeros(0), np.zeros(0)
    wavenumber = np.geomspace(first, last, 400)
    wavenumber[[0, -1]] = first, last
    return wavenumber, spectrum.density(wavenumber)


def _wavelengths_on_top(ax: Axes) -> None:
    """A second axis above: 2π/Omega, m."""

    def other(value: ArrayLike) -> FloatArray:
        # Both ways the same; matplotlib tries it at zero too.
        return np.asarray(2 * np.pi / np.maximum(np.asarray(value, dtype=float), 1e-300))

    top = ax.secondary_xaxis("top", functions=(other, other))
    top.set_xlabel("wavelength [m]")
    top.xaxis.set_major_formatter("{x:g}")
