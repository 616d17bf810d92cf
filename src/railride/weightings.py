"""Frequency weightings of human vibration: as transfer functions, and on sampled records.

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

_FADE = 64
"""Samples over which a record is led to rest before its start and after its end."""

_RING_DOWN = 20.0
"""Time constants of the slowest pole that are padded with zeros: e^−20 = 2e-9 is left."""


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
    near = difflib.get_close_matches(name.capitalize(), weighting_names(), n=1)
    mend = f"did you mean {near[0]}?" if near else ""
    raise InputError(
        str(Fault("weighting", repr(name), "one of " + ", ".join(weighting_names()), mend))
    )


def checked_record(record: ArrayLike, rate: float) -> FloatArray:
    """The record as floats (..., n), n ≥ 1, if it and its rate (Hz) can be used.

    Raises :class:`InputError` for a rate that is not positive and finite, for an empty record, and
    for values that are not finite numbers (with the place of the first).
    """
    faults = Faults("acceleration record")
    if not (math.isfinite(rate) and rate > 0):
        faults.add("sampling rate", f"{rate} Hz", "a positive, finite rate in Hz")
    try:
        values = np.asarray(record, dtype=np.float64)
    except (TypeError, ValueError) as error:
        faults.add("samples", str(error), "real numbers in m/s², time last")
        values = np.zeros(1)
    if values.ndim == 0 or values.size == 0:
        faults.add("samples", f"shape {values.shape}", "at least one sample, time last")
    elif not np.isfinite(values).all():
        place = np.argwhere(~np.isfinite(values))[0]
        count = int(np.count_nonzero(~np.isfinite(values)))
        faults.add(
            f"sample {', '.join(str(i) for i in place)} (counted from 0)",
            f"{values[tuple(place)]}, {count} such in all",
            "finite numbers",
            "cut the record there or fill the gap",
        )
    faults.raise_if_any()
    return values


def apply_weighting(
    weight: str | Weighting, record: ArrayLike, rate: float, *, before: float | None = None
) -> FloatArray:
    """a_w(t) = ∫ h(τ) a(t − τ) dτ at the samples, h the impulse response of the analogue filter.

    The zero-padded spectrum of the record is multiplied by H(j2πf). That is the analogue filter on
    the band-limited signal through the samples, up to fs/2: a bilinear filter or a first-order
    hold is 10 to 30 % low near 50 Hz at 200 to 250 Hz sampling.

    ``weight``: a weighting or its name. ``record`` (..., n), m/s², time last, ``rate`` in Hz; the
    result has the record's shape.

    The ends: before its first sample the record is taken to have stood for ever at the level
    ``before`` (m/s²; default each row's own mean, 0 = from rest), so an offset such as gravity
    leaves no step; what follows is the filter's own start, down to 1e-5 after 3/f1 s (7.5 s for
    W_k), to be left out of a rating where the record has a run-in. The filter being causal,
    nothing after the last sample matters; the record is led smoothly to rest there, which keeps
    its end from ringing: a tone of 0.4·fs is within 1 % up to ten samples from the end and a
    third wrong in the last one, a tone below 0.1·fs within 1 % up to the last.

    Raises :class:`InputError` for values that are not finite and a rate that is not positive.
    """
    from scipy import fft

    chosen = weighting(weight)
    values = checked_record(record, rate)
    if before is not None and not math.isfinite(before):
        raise InputError(
            str(Fault("level before the record", str(before), "a finite number in m/s²"))
        )
    count = values.shape[-1]
    slowest = float(np.min(-chosen.poles().real)) if chosen.poles().size else math.inf
    padding = math.ceil(_RING_DOWN / slowest * rate) + 1
    length = fft.next_fast_len(count + 2 * _FADE + padding, real=True)
    response = chosen.response(fft.rfftfreq(length, 1 / rate))
    at_rest = float(chosen.response(0.0).real)

    result = np.empty_like(values)
    rows, results = values.reshape(-1, count), result.reshape(-1, count)
    for row, target in zip(rows, results, strict=True):
        level = float(np.mean(row)) if before is None else before
        swing = row - level
        # The start fades in from the level and stays at it where the record starts there; the end
        # is carried on by its point reflection, whatever that is.
        extended = np.concatenate((swing[0] * _fade()[::-1], swing, reflected_end(swing)))
        spectrum = fft.rfft(extended, length)
        spectrum *= response
        target[:] = fft.irfft(spectrum, length)[_FADE : _FADE + count] + at_rest * level
    return result


def _fade() -> FloatArray:
    """Raised cosine from just under 1 to just above 0, shape (_FADE,)."""
    return 0.5 + 0.5 * np.cos(np.pi * np.arange(1, _FADE + 1) / (_FADE + 1))


def reflected_end(row: FloatArray) -> FloatArray:
    """Continuation of ``row`` (n,) past its end: 2·last − mirror image, led to zero; shape (≤ 64,).

    Value and slope go on without a break, so that a Fourier series does not ring at the end.
    """
    reach = min(_FADE, row.size - 1)
    mirror = row[-2 : -2 - reach : -1] if reach else row[:0]
    held = np.full(_FADE, 2 * row[-1] - mirror[-1] if reach else row[-1])
    held[:reach] = 2 * row[-1] - mirror
    return held * _fade()


def band_remark(weighting: Weighting, rate: float) -> str | None:
    """What a sampling rate (Hz) cannot hold of the weighting's range, or None where it holds it.

    The weighting follows the analogue filter up to 0.4·fs; W_k and its like reach to 80 Hz and
    want fs ≥ 200 Hz.
    """
    _, high = weighting.range
    if 0.4 * rate >= high * (1 - 1e-12):
        return None
    return (
        f"sampled at {rate:.5g} Hz, the record holds nothing above {rate / 2:.4g} Hz and is "
        f"trusted to {0.4 * rate:.4g} Hz; {weighting.name} reaches to {high:.3g} Hz "
        f"(sample at {2.5 * high:.4g} Hz or more): what lies above is missing from the weighted "
        "value"
    )
