"""Track spectra: how much longitudinal level a track has at each wavenumber.

Symbols: Omega = 2π/wavelength, angular wavenumber (rad/m); n = 1/wavelength, wavenumber (1/m);
S(Omega), one-sided power spectral density of the level (m²/(rad/m)), so that

    mean square of the level = ∫₀^∞ S(Omega) dOmega.

density (what a spectrum is, in any unit and sidedness) → erri, fra, sncf, china (those that ship,
one family each) → bands (r.m.s. in a wavelength band, density over frequency) → tabulated, file (a
user's own) → names (by name) → fit (which one fits best).

Sources: as read from published compilations of the ERRI/ORE B176, FRA, SNCF and Chinese spectra;
each :class:`Spectrum` names its own.
"""

from railride.spectra.bands import band_rms, coverage_remark, covered_hz, temporal
from railride.spectra.density import (
    D1,
    D2,
    D3,
    FloatArray,
    Spectrum,
    check_band,
    check_speed,
    unit_doubts,
)
from railride.spectra.file import holds_spectrum, read_spectrum, spectrum_of
from railride.spectra.fit import Fit, fit_spectra
from railride.spectra.names import is_file, spectrum, spectrum_names
from railride.spectra.tabulated import spectrum_from_table

__all__ = [
    "D1",
    "D2",
    "D3",
    "Fit",
    "FloatArray",
    "Spectrum",
    "band_rms",
    "check_band",
    "check_speed",
    "coverage_remark",
    "covered_hz",
    "fit_spectra",
    "holds_spectrum",
    "is_file",
    "read_spectrum",
    "spectrum",
    "spectrum_from_table",
    "spectrum_names",
    "spectrum_of",
    "temporal",
    "unit_doubts",
]
