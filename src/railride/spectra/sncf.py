"""Track spectra of the SNCF for good and for poor track."""

from __future__ import annotations

from math import pi

from railride.spectra.density import Spectrum


def _sncf(state: str, A: float) -> Spectrum:
    """S(n) = 308e-6 A/(1 + n/0.0489)³, m²/(1/m), wavelengths of 2 to 40 m."""
    n0 = 0.0489
    return Spectrum(
        name=f"sncf_{state}",
        source=f"SNCF, {state} track",
        unit="m^2/(1/m)",
        sidedness="one-sided",
        formula=lambda n: 308e-6 * A / (1.0 + n / n0) ** 3,
        band=(2.0, 40.0),
        poles=(complex(-2.0 * pi * n0),),
    )


SNCF = (_sncf("good", 0.509), _sncf("poor", 1.790))
