"""Which spectrum fits best: third-octave r.m.s. values of two spectra side by side.

Over the bands of wavelengths 10^((k ± ½)/10) m that both hold whole, with the r.m.s. u_k of the one
and v_k of the other (:func:`railride.spectra.band_rms`),

    d_k = 20 log₁₀(u_k/v_k),   misfit = √(mean d_k²) dB,   level ratio = 10^(mean d_k/20).

Means over third octaves do not heed how single lines of an estimate scatter, and count every
wavelength alike on the logarithmic scale on which spectra are drawn.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, inf, log10

import numpy as np

from railride.spectra.bands import band_rms
from railride.spectra.density import D1, D3, Spectrum
from railride.spectra.names import spectrum as named_spectrum
from railride.spectra.names import spectrum_names

_WIDEST = (D1[0], D3[1])  # m, where neither spectrum has a band
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Fit:
    """How a ``spectrum`` fits another one.

    ``misfit_db``: r.m.s. difference of the third-octave levels, dB. ``level_ratio``: the other's
    r.m.s. level over this one's, the geometric mean over third octaves. ``wavelengths``: shortest
    and longest compared, m. ``bands``: the number of third octaves between them.
    """

    spectrum: Spectrum
    misfit_db: float
    level_ratio: float
    wavelengths: tuple[float, float]
    bands: int


def fit_spectra(
    found: Spectrum, candidates: Sequence[str | Spectrum] | None = None
) -> tuple[Fit, ...]:
    """How well other spectra fit the one ``found``, the best first.

    ``candidates``: spectra or their names, by default all that ship. Those that share no whole
    third octave with it are left out.

    >>> best = fit_spectra(named_spectrum("fra_6"), ["erri_low", "erri_high", "fra_5"])[0]
    >>> best.spectrum.name, round(best.misfit_db, 1), best.bands
    ('erri_high', 1.0, 16)
    """
    others = [named_spectrum(one) for one in candidates or spectrum_names()]
    fits = [fit for fit in (_fit(found, other) for other in others) if fit is not None]
    return tuple(sorted(fits, key=lambda fit: fit.misfit_db))


def _fit(found: Spectrum, other: Spectrum) -> Fit | None:
    """Compare two spectra over the third octaves that both hold; None if there are none."""
    bands = [one.active_band or (0.0, inf) for one in (found, other)]
    shortest, longest = max(low for low, _ in bands), min(high for _, high in bands)
    shortest, longest = shortest or _WIDEST[0], longest if longest < inf else _WIDEST[1]
    if shortest >= longest:
        return None
    first = ceil(10.0 * log10(shortest) + 0.5 - _ROUNDING)
    last = floor(10.0 * log10(longest) - 0.5 + _ROUNDING)
    if first > last:
        return None
    edges = 10.0 ** ((np.arange(first, last + 2) - 0.5) / 10.0)
    difference = np.array([
        20.0 * log10(band_rms(found, low, high) / band_rms(other, low, high))
        for low, high in zip(edges.tolist(), edges[1:].tolist(), strict=False)
    ])  # fmt: skip
    return Fit(
        other,
        float(np.sqrt(np.mean(difference**2))),
        float(10.0 ** (np.mean(difference) / 20.0)),
        (float(edges[0]), float(edges[-1])),
        difference.size,
    )
