"""Track spectra of the Federal Railroad Administration (USA) for its track classes 1 to 6."""

from __future__ import annotations

from railride.spectra.density import Spectrum


def _fra(track_class: int, Av: float) -> Spectrum:
    """S(Omega) = k Av Oc²/(Omega² (Omega² + Oc²)), Av in cm² rad/m, k = 0.25."""
    k, Oc = 0.25, 0.8245
    return Spectrum(
        name=f"fra_{track_class}",
        source=f"FRA (Federal Railroad Administration), track class {track_class}",
        unit="cm^2/(rad/m)",
        sidedness="one-sided",
        formula=lambda O: k * Av * Oc**2 / (O**2 * (O**2 + Oc**2)),  # noqa: E741
        poles=(0j, 1j * Oc, -1j * Oc),
    )


_AV = (1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339)  # cm² rad/m, classes 1 to 6
FRA = tuple(_fra(number, Av) for number, Av in enumerate(_AV, start=1))
