"""Track spectra of the SNCF for good and for poor track."""

from __future__ import annotations

from functools import partial
from math import pi

import numpy as np
from numpy.typing import NDArray

from railride.spectra.density import Spectrum

_N0 = 0.0489  # 1/m


def _density(A: float, n: NDArray[np.inexact]) -> NDArray[np.inexact]:
    """S(n) = 308e-6 A/(1 + n/0.0489)³, m²/(1/m), wavelengths of 2 to 40 m."""
    return np.asarray(308e-6 * A / (1.0 + n / _N0) ** 3)


def _sncf(state: str, A: float) -> Spectrum:
    return Spectrum(
        name=f"sncf_{state}",
        source=f"SNCF, {state} track",
        unit="m^2/(1/m)",
        sidedness="one-sided",
        formula=partial(_density, A),
        band=(2.0, 40.0),
        poles=(complex(-2.0 * pi * _N0),),
    )


SNCF = (_sncf("good", 0.509), _sncf("poor", 1.790))
