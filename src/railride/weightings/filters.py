"""Frequency weightings of human vibration, as transfer functions.

Every weighting of ISO 8041-1 is one product of up to four factors in s = jω, ω_i = 2π f_i::

    H(s) = gain · s² / (s² + ω1 s/Q1 + ω1²)                           high-pass, band limit
                · 1 / (1 + s/(Q2 ω2) + s²/ω2²)                        low-pass, band limit
                · (1 + s/ω3) / (1 + s/(Q4 ω4) + s²/ω4²)               acceleration to velocity
                · (s² + ω5 s/Q5 + ω5²) / (s² + ω6 s/Q6 + ω6²)         upward step

with Q1 = Q2 = 1/√2 (Butterworth). The parameters are in ``data/weightings.csv``.
"""

from __future__ import annotations

import csv
import difflib
import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import Fault, Faults, InputError
from railride.files import data_path

if TYPE_CHECKING:
    import control

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Factor = tuple[tuple[float, ...], tuple[float, ...]]

BUTTERWORTH = 1 / math.sqrt(2)
"""Q1 and Q2, the band limits' quality factor."""


@dataclass(frozen=True)
class Weighting:
    """One frequency weighting: the factors of the module's equation; infinity = factor absent.

    Frequencies ``f1`` … ``f6`` in Hz; quality factors ``Q4``, ``Q5``, ``Q6`` and ``gain`` without
    unit. ``f3`` alone may be infinite (no numerator). An absent factor's quality factor is
    infinite too. Raises :class:`InputError` where a value is not positive, where f5 and f6 are not
    both there or both absent, or where f3 is given without f4.

    Source: ISO 2631-1:1997 Annex A; ISO 8041-1.

    >>> wk = weighting("Wk")
    >>> bool(abs(abs(wk.response(8.0)) - 1.036) < 0.003)
    True
    """

    name: str
    f1: float
    f2: float
    f3: float
    f4: float
    Q4: float
    f5: float
    Q5: float
    f6: float
    Q6: float
    gain: float
    standard: str

    def __post_init__(self) -> None:
        faults = Faults(f"weighting {self.name}")
        for field in fields(self):
            value = getattr(self, field.name)
            if field.name not in ("name", "standard") and not value > 0:
                faults.add(field.name, value, "a positive number", "'inf' where it is absent")
        if not math.isfinite(self.gain):
            faults.add("gain", self.gain, "a finite number")
        if math.isfinite(self.f3) and not math.isfinite(self.f4):
            faults.add("f4", self.f4, "a frequency, because f3 is given")
        if math.isfinite(self.f5) != math.isfinite(self.f6):
            faults.add("f5, f6", (self.f5, self.f6), "both given or both absent")
        for f, q in (("f4", "Q4"), ("f5", "Q5"), ("f6", "Q6")):
            if math.isfinite(getattr(self, f)) != math.isfinite(getattr(self, q)):
                faults.add(q, getattr(self, q), f"a quality factor where {f} is given, else 'inf'")
        faults.raise_if_any()

    @property
    def range(self) -> tuple[float, float]:
        """Frequencies (Hz) that the weighting is meant for: 1.25·f1 to 0.8·f2.

        0.5 to 80 Hz for every weighting but W_f (0.1 to 0.5 Hz) and W_m (1 to 80 Hz); 0.5 and
        80 Hz also stand in where there is no band limit.
        """
        low = 1.25 * self.f1 if math.isfinite(self.f1) else 0.5
        high = 0.8 * self.f2 if math.isfinite(self.f2) else 80.0
        return low, high

    def factors(self) -> tuple[Factor, ...]:
        """Numerator and denominator of each factor in s (rad/s), highest power first.

        The gain is the first factor.
        """
        w1, w2, w3, w4, w5, w6 = (
            2 * math.pi * f for f in (self.f1, self.f2, self.f3, self.f4, self.f5, self.f6)
        )
        found: list[Factor] = [((self.gain,), (1.0,))]
        if math.isfinite(w1):
            found.append(((1.0, 0.0, 0.0), (1.0, w1 / BUTTERWORTH, w1**2)))
        if math.isfinite(w2):
            found.append(((1.0,), (w2**-2, 1 / (BUTTERWORTH * w2), 1.0)))
        if math.isfinite(w4):
            numerator = (1 / w3, 1.0) if math.isfinite(w3) else (1.0,)
            found.append((numerator, (w4**-2, 1 / (self.Q4 * w4), 1.0)))
        if math.isfinite(w6):
            found.append(((1.0, w5 / self.Q5, w5**2), (1.0, w6 / self.Q6, w6**2)))
        return tuple(found)

    def response(self, frequency: ArrayLike) -> ComplexArray:
        """H(j2πf), factor by factor: no high-order polynomial that could lose digits.

        ``frequency`` in Hz, any shape, any sign, zero included; complex, of the same shape.
        """
        s = 2j * np.pi * np.asarray(frequency, dtype=np.float64)
        value = np.ones_like(s)
        for numerator, denominator in self.factors():
            value = value * (np.polyval(numerator, s) / np.polyval(denominator, s))
        return cast("ComplexArray", value)

    def poles(self) -> ComplexArray:
        """Poles of H(s), rad/s, shape (number of poles,)."""
        return np.concatenate(
            [np.asarray(np.roots(den), dtype=np.complex128) for _, den in self.factors()]
        )

    def transfer_function(self) -> control.TransferFunction:
        """H(s) for python-control: input ``a``, output ``a_w`` (both m/s²).

        >>> weighting("Wk").transfer_function().poles().size
        8
        """
        import control

        numerator: FloatArray = np.ones(1)
        denominator: FloatArray = np.ones(1)
        for num, den in self.factors():
            numerator = np.convolve(numerator, num)
            denominator = np.convolve(denominator, den)
        return control.TransferFunction(
            numerator, denominator, name=self.name, inputs="a", outputs="a_w"
        )


@lru_cache(maxsize=1)
def _table() -> Mapping[str, Weighting]:
    """All weightings by name: the rows of ``data/weightings.csv``, and the paper's."""
    with data_path("weightings.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table: dict[str, Weighting] = {}
    for row in rows:
        name, standard = row.pop("weighting"), row.pop("standard")
        numbers = {key: float(text or "inf") for key, text in row.items()}
        table[name] = Weighting(name=name, standard=standard, **numbers)
    # Eq (6) ends with 2πf4²/f3, which makes it ω4²/ω3 · (s + ω3)/(s² + …): W_k's own factors at
    # unit gain, without the band limits.
    table["Wk_paper"] = replace(
        table["Wk"],
        name="Wk_paper",
        f1=math.inf,
        f2=math.inf,
        standard="Çati et al. 2024, Eq (6): ISO W_k without its band limits",
    )
    return MappingProxyType(table)


def weighting_names() -> tuple[str, ...]:
    """Names of all weightings, in the table's order.

    >>> weighting_names()
    ('Wk', 'Wd', 'Wc', 'We', 'Wj', 'Wf', 'Wm', 'Wb', 'Wb_en12299', 'Wk_paper')
    """
    return tuple(_table())


def weighting(name: str | Weighting) -> Weighting:
    """The weighting of that name; ``Wb`` is BS 6841's, ``Wb_en12299`` is EN 12299's.

    What is a weighting already stays as it is.

    Raises :class:`InputError`, naming those that exist, where there is none.
    """
    if isinstance(name, Weighting):
        return name
    if name in _table():
        return _table()[name]
    near = difflib.get_close_matches(str(name).capitalize(), weighting_names(), n=1)
    mend = f"did you mean {near[0]}?" if near else ""
    raise InputError(
        str(Fault("weighting", repr(name), "one of " + ", ".join(weighting_names()), mend))
    )
