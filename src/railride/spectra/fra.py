"""Track spectra of the Federal Railroad Administration (USA) for its track classes 1 to 6."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from railride.spectra.density import Spectrum

_K, _OC = 0.25, 0.8245  # 1, rad/m


def _density(Av: float, Omega: NDArray[np.inexact]) -> NDArray[np.inexact]:
    """S(Omega) = k Av Oc²/(Omega² (Omega² + Oc²)), Av in cm² rad/m, k = 0.25."""
    return np.asarray(_K * Av * _OC**2 / (Omega**2 * (Omega**2 + _OC**2)))


def _fra(track_class: int, Av: float) -> Spectrum:
    return Spectrum(
        name=f"fra_{track_class}",
        source=f"FRA (Federal Railroad Administration), track class {track_class}",
        unit="cm^2/(rad/m)",
        sidedness="one-sided",
        formula=partial(_density, Av),
        poles=(0j, 1j * _OC, -1j * _OC),
    )


_AV = (1.2107, 1.0181, 0.6816, 0.5376, 0.2095, 0.0339)  # cm² rad/m, classes 1 to 6
FRA = tuple(_fra(number, Av) for number, Av in enumerate(_AV, start=1))
