"""Track spectra of ERRI/ORE B 176 for track of a low and of a high level of irregularities."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from railride.spectra.density import Spectrum

_OR, _OC = 0.0206, 0.8246  # rad/m


def _density(Av: float, Omega: NDArray[np.inexact]) -> NDArray[np.inexact]:
    """S(Omega) = Av Oc²/((Omega² + Or²)(Omega² + Oc²)), Av in m² rad/m."""
    return np.asarray(Av * _OC**2 / ((Omega**2 + _OR**2) * (Omega**2 + _OC**2)))


def _erri(level: str, Av: float) -> Spectrum:
    return Spectrum(
        name=f"erri_{level}",
        source=f"ERRI/ORE B176, {level} level",
        unit="m^2/(rad/m)",
        sidedness="one-sided",
        formula=partial(_density, Av),
        poles=(1j * _OR, -1j * _OR, 1j * _OC, -1j * _OC),
    )


ERRI = (_erri("low", 4.032e-7), _erri("high", 1.080e-6))
