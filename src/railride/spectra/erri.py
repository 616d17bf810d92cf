"""Track spectra of ERRI/ORE B 176 for track of a low and of a high level of irregularities."""

from __future__ import annotations

from railride.spectra.density import Spectrum


def _erri(level: str, Av: float) -> Spectrum:
    """S(Omega) = Av Oc²/((Omega² + Or²)(Omega² + Oc²)), Av in m² rad/m."""
    Or, Oc = 0.0206, 0.8246
    return Spectrum(
        name=f"erri_{level}",
        source=f"ERRI/ORE B176, {level} level",
        unit="m^2/(rad/m)",
        sidedness="one-sided",
        formula=lambda O: Av * Oc**2 / ((O**2 + Or**2) * (O**2 + Oc**2)),  # noqa: E741
        poles=(1j * Or, -1j * Or, 1j * Oc, -1j * Oc),
    )


ERRI = (_erri("low", 4.032e-7), _erri("high", 1.080e-6))
