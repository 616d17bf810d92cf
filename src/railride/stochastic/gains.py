r"""Weightings and spectra as rational functions of f².

.. math:: |W(f)|^2 = c\, \frac{\prod_i (f^2 - a_i)}{\prod_i (f^2 - b_i)}

What is real and even along f is a function of x = f², and with s = 2πif of x = -s²/4π²: so it goes
on into the plane of s, where residues are taken.

Source: D.E. Newland, Random Vibrations, Spectral and Wavelet Analysis, 3rd ed., Chapter 7.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import pi
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railride.numeric import Array
from railride.spectra import Spectrum
from railride.weightings import Weighting

Complex = NDArray[np.complex128]

RATIONAL = 1e-12  # how far a spectrum may be from a constant over its poles
_PROBES = np.geomspace(1e-3, 1e2, 41)  # rad/m, where the two are compared


@dataclass(frozen=True)
class Gain:
    """|W(f)|² = factor · Π (f² - a)/Π (f² - b), zeros a and poles b in the plane of x = f², Hz²."""

    factor: float = 1.0
    square_zeros: tuple[complex, ...] = ()
    square_poles: tuple[complex, ...] = ()

    def at(self, x: NDArray[Any]) -> NDArray[Any]:
        """The function at x = f², real or complex, of any shape."""
        top = np.prod(np.subtract.outer(x, np.asarray(self.square_zeros)), axis=-1)
        bottom = np.prod(np.subtract.outer(x, np.asarray(self.square_poles)), axis=-1)
        return np.asarray(self.factor * top / bottom)

    def power(self, f: Array) -> Array:
        """|W(f)|² at frequencies in Hz, of any shape."""
        return np.asarray(self.at(f * f).real)

    @property
    def poles(self) -> Complex:
        """In the upper half of the plane of f, (P,)."""
        f = np.sqrt(np.asarray(self.square_poles, dtype=complex))
        return np.asarray(np.where(f.imag < 0, -f, f))

    def __mul__(self, other: Gain) -> Gain:
        """The product, what vanishes at f = 0 cancelled with what is infinite there."""
        zeros = [*self.square_zeros, *other.square_zeros]
        poles = [*self.square_poles, *other.square_poles]
        while 0 in zeros and 0 in poles:
            zeros.remove(0)
            poles.remove(0)
        return Gain(self.factor * other.factor, tuple(zeros), tuple(poles))


PLAIN = Gain()


@lru_cache(maxsize=32)
def weighted(weight: Weighting) -> Gain:
    """|W(f)|² of a frequency weighting.

    Of each polynomial in its factors, |a s² + b s + c|² = a² z² + (2ac - b²) z + c², z = -4π² x.
    """
    gain = PLAIN
    for pair in weight.factors():
        top, bottom = (_square(*[0.0] * (3 - len(p)), *p) for p in pair)
        gain *= Gain(top[0] / bottom[0], top[1], bottom[1])
    return gain


def _square(a: float, b: float, c: float) -> tuple[float, tuple[complex, ...]]:
    """|a s² + b s + c|² along f: the coefficient of the highest power of x, and the roots."""
    of_x = np.array([16 * pi**4 * a**2, 4 * pi**2 * (b**2 - 2 * a * c), c**2])
    of_x = of_x[np.flatnonzero(of_x)[0] :]
    return float(of_x[0]), tuple(np.roots(of_x).tolist())


@lru_cache(maxsize=1)
def sperling() -> Gain:
    """B(f)² of :func:`railride.comfort.sperling_weighting`, vertical."""
    even, odd = np.array([-0.277, 1.0]), np.array([-0.0368, 1.563])
    below = np.polyadd(np.polymul(even, even), np.polymul([1.0, 0.0], np.polymul(odd, odd)))
    top = (0.588 * 0.25) ** 2
    return Gain(float(top / below[0]), (0.0, -1.911 / 0.25**2), tuple(np.roots(below).tolist()))


def rational(spectrum: Spectrum, speed: float) -> Gain | None:
    """S_w of a track at a speed, m²/Hz; None of a spectrum that is no constant over its poles."""
    if not spectrum.poles or spectrum.breakpoints:
        return None
    found = _over_its_poles(spectrum)
    if found is None:
        return None
    constant, squares = found
    scale = (speed / (2 * pi)) ** 2
    factor = constant * 2 * pi / speed * scale ** len(squares)
    return Gain(factor, (), tuple(scale * b for b in squares))


@lru_cache(maxsize=32)
def _over_its_poles(spectrum: Spectrum) -> tuple[float, tuple[complex, ...]] | None:
    """c and b of S(Ω) = c/Π (Ω² - b), if it is so."""
    poles = spectrum.poles
    if {-p for p in poles} != set(poles):
        return None
    squares = tuple(p * p for p in poles if p.imag > 0 or (p.imag == 0 and p.real >= 0))
    below = np.prod([_PROBES**2 - b for b in squares], axis=0).real
    constant = spectrum.extrapolated().density(_PROBES) * below
    if np.ptp(constant) > RATIONAL * constant[0]:
        return None
    return float(constant[0]), squares
