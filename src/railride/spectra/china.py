"""Track spectrum of Chinese high-speed lines on ballastless track."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from railride.spectra.density import Spectrum

_EDGES = (0.0187, 0.0474, 0.1533)  # 1/m
_A = np.array([1.0544e-5, 3.5588e-3, 1.9784e-2, 3.9488e-4])
_K = np.array([3.3891, 1.9271, 1.3643, 3.4516])


def _density(n: NDArray[np.inexact]) -> NDArray[np.inexact]:
    """S(n) = A/n^k, mm²/(1/m), with A and k piecewise, wavelengths of 2 to 200 m."""
    piece = np.searchsorted(_EDGES, np.real(n), side="right")
    return np.asarray(_A[piece] / n ** _K[piece])


CHINA = (
    Spectrum(
        name="china_ballastless",
        source="Chinese high-speed ballastless track spectrum",
        unit="mm^2/(1/m)",
        sidedness="one-sided",
        formula=_density,
        band=(2.0, 200.0),
        breakpoints=tuple(2.0 * pi * edge for edge in _EDGES),
    ),
)
