"""Comfort indices of an acceleration record.

Records are arrays (..., n), m/s², time last, at ``rate`` Hz; sample i stands for the time from
(i − ½)/rate to (i + ½)/rate, so that a record lasts T = n/rate. Each index is taken over the whole
of what it is given: to rate a section, weight the whole record first and give the section.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import Fault, InputError
from railride.weightings import (
    FloatArray,
    Weighting,
    apply_weighting,
    band_remark,
    checked_record,
    reflected_end,
    weighting,
)

Direction = Literal["vertical", "lateral"]
Averaging = Literal["linear", "exponential"]

COMFORT_BAND = (0.05, 80.0)
"""Band of the unweighted r.m.s., Hz."""

SHORTEST = 1.0
"""s: the window of MTVV; a shorter section has none."""

FEW_PERIODS = 5.0
"""s: below it a section is too short for what is rated down to 0.5 Hz."""

PEAK_RATE = 2000.0
"""Least rate (Hz) at which peaks are read: an 80 Hz peak is then at most 0.8 % low."""


def rms(record: ArrayLike) -> FloatArray:
    """a = √((1/T) ∫ a² dt): root mean square over the last axis, shape (...).

    Source: ISO 2631-1:1997, Eq (1).

    >>> float(rms([3.0, -3.0, 3.0, -3.0]))
    3.0
    """
    values = checked_record(record, 1.0)
    return np.asarray(np.sqrt(np.mean(values**2, axis=-1)))


def band_rms(
    record: ArrayLike, rate: float, low: float = COMFORT_BAND[0], high: float = COMFORT_BAND[1]
) -> FloatArray:
    """Root mean square of the content with low ≤ f ≤ high (Hz), shape (...).

    By Parseval's theorem from the record's own Fourier lines k/T, no window: exact for lines that
    fit the record, and the plain r.m.s. less the mean where the band holds everything. A line that
    does not fit leaks as 1/(f − f_0)², which between 0.05 and 80 Hz moves a ride's value by less
    than 0.1 %. A drift is a sawtooth to a Fourier series and does count (D/√12 for a drift of D
    over the record): take it out first.

    Raises :class:`InputError` unless 0 ≤ low < high.
    """
    if not 0 <= low < high:
        raise InputError(str(Fault("band", f"{low} to {high} Hz", "0 ≤ low < high")))
    frequency, power = _line_powers(record, rate)
    inside = (frequency >= low) & (frequency <= high)
    return np.asarray(np.sqrt(np.sum(power[..., inside], axis=-1)))


def running_rms(
    record: ArrayLike, rate: float, tau: float = 1.0, kind: Averaging = "linear"
) -> FloatArray:
    """Running r.m.s. a_w(t_0) of a weighted record, with integration time τ = ``tau`` (s)::

        linear       √((1/τ) ∫ a_w² dt), from t_0 − τ to t_0
        exponential  √((1/τ) ∫ a_w² e^((t − t_0)/τ) dt), from −∞ to t_0

    Before the record there is nothing: a window that reaches back beyond the first sample has less
    in it. The result has the record's shape. τ need not be a whole number of samples.

    Source: ISO 2631-1:1997, Eqs (2) and (3).
    """
    values = checked_record(record, rate)
    if not (math.isfinite(tau) and tau > 0):
        raise InputError(str(Fault("integration time", f"{tau} s", "a positive time in s")))
    square = values**2
    if kind == "exponential":
        from scipy.signal import lfilter

        decay = math.exp(-1 / (rate * tau))
        return np.asarray(np.sqrt(lfilter([1 - decay], [1, -decay], square, axis=-1)))
    if kind != "linear":
        raise InputError(str(Fault("running r.m.s.", repr(kind), "'linear' or 'exponential'")))
    # The integral up to the end of each sample, read a window's length earlier by interpolation.
    window, count = tau * rate, values.shape[-1]
    ends = np.arange(count + 1.0)
    result = np.empty_like(values)
    for row, target in zip(square.reshape(-1, count), result.reshape(-1, count), strict=True):
        integral = np.concatenate(([0.0], np.cumsum(row)))
        earlier = np.interp(ends[1:] - window, ends, integral, left=0.0)
        # Interpolation may round to just above the value that it ends at.
        target[:] = np.sqrt(np.maximum(integral[1:] - earlier, 0.0) / window)
    return result


def mtvv(
    record: ArrayLike, rate: float, tau: float = 1.0, kind: Averaging = "linear"
) -> FloatArray:
    """MTVV = max a_w(t_0): the largest running r.m.s. of a weighted record, shape (...).

    Nothing before the record counts: for the linear form these are the windows that lie wholly
    within it (if it lasts at least τ). Source: ISO 2631-1:1997, Eq (4); τ = 1 s.
    """
    return np.asarray(np.max(running_rms(record, rate, tau, kind), axis=-1))


def vdv(record: ArrayLike, rate: float) -> FloatArray:
    """VDV = (∫ a_w⁴ dt)^¼ of a weighted record, m/s^1.75, shape (...).

    On the signal between the samples too (:func:`oversample`): on the bare samples a tone of a
    quarter of the rate is 10 % low to 7 % high. Source: ISO 2631-1:1997, Eq (5).
    """
    values = checked_record(record, rate)
    fine = oversample(values, rate)
    return np.asarray((np.mean((fine**2) ** 2, axis=-1) * (values.shape[-1] / rate)) ** 0.25)


def crest_factor(record: ArrayLike, rate: float) -> FloatArray:
    """Largest |a_w| over the r.m.s. of a weighted record, shape (...); NaN where it is all zero.

    The peak is that of the band-limited signal through the samples (:func:`oversample`).
    Source: ISO 2631-1:1997, 6.2.1.
    """
    values = checked_record(record, rate)
    peak = np.max(np.abs(oversample(values, rate)), axis=-1)
    level = rms(values)
    return np.asarray(np.divide(peak, level, out=np.full_like(peak, np.nan), where=level > 0))


def oversample(record: ArrayLike, rate: float, least_rate: float = PEAK_RATE) -> FloatArray:
    """The band-limited signal through the samples, at m·rate ≥ least_rate.

    From the first sample to the last, shape (..., m(n − 1) + 1): every m-th value is the record's.
    m is the smallest whole number that will do (m = 1 gives the record itself). Beyond its ends the
    record is carried on by point reflection, led to zero. Within ten samples of an end a tone of
    0.4·fs may come out 10 % too high, one below 0.3·fs at most 2 %.
    """
    values = checked_record(record, rate)
    times = math.ceil(least_rate / rate * (1 - 1e-12))
    if times <= 1:
        return values
    from scipy import fft

    count = values.shape[-1]
    finer = (count - 1) * times + 1
    fine = np.empty((*values.shape[:-1], finer))
    rows, targets = values.reshape(-1, count), fine.reshape(-1, finer)
    for row, target in zip(rows, targets, strict=True):
        before, after = reflected_end(row[::-1])[::-1], reflected_end(row)
        extended = np.concatenate((before, row, after))
        length = 2 * fft.next_fast_len((extended.size + 1) // 2, real=True)
        spectrum = fft.rfft(extended, length)
        spectrum[-1] /= 2  # the line at fs/2 is shared between +fs/2 and −fs/2
        dense = fft.irfft(spectrum, length * times) * times
        target[:] = dense[before.size * times :][:finer]
    return fine


def _line_powers(record: ArrayLike, rate: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies k/T (Hz) and the mean square in each line (..., lines), by Parseval."""
    from scipy import fft

    values = checked_record(record, rate)
    count = values.shape[-1]
    power = np.abs(fft.rfft(values, axis=-1) / count) ** 2
    power[..., 1 : (count + 1) // 2] *= 2  # a line and its mirror image; 0 and fs/2 have none
    return np.asarray(fft.rfftfreq(count, 1 / rate)), power


def sperling_weighting(frequency: ArrayLike, direction: Direction = "vertical") -> FloatArray:
    """Sperling's comfort weighting at ``frequency`` (Hz), of the same shape::

        B(f) = 0.588 √( (1.911 f² + (0.25 f²)²) / ((1 − 0.277 f²)² + (1.563 f − 0.0368 f³)²) )

    lateral × 1.25. Never W_k. Source: Sperling and Betzhold 1956; Garg and Dukkipati, Dynamics of
    Railway Vehicle Systems, 1984 (which rounds the lateral 0.735 to 0.737).

    >>> round(float(sperling_weighting(5.0)), 3)
    0.813
    """
    if direction not in ("vertical", "lateral"):
        raise InputError(str(Fault("direction", repr(direction), "'vertical' or 'lateral'")))
    f = np.asarray(frequency, dtype=np.float64)
    above = 1.911 * f**2 + (0.25 * f**2) ** 2
    below = (1 - 0.277 * f**2) ** 2 + (1.563 * f - 0.0368 * f**3) ** 2
    factor = 0.588 * (1.25 if direction == "lateral" else 1.0)
    return np.asarray(factor * np.sqrt(above / below))


def wz_from_rms(weighted_rms: ArrayLike) -> FloatArray:
    """W_z = 4.42 a_B^0.3, a_B the r.m.s. (m/s²) after :func:`sperling_weighting`.

    The form for a whole spectrum. The sum of tenth powers over single lines, ΣW_zi^10, depends on
    the length of the record and is for single harmonics. Source: as there.
    """
    return np.asarray(4.42 * np.asarray(weighted_rms, dtype=np.float64) ** 0.3)


def sperling_wz(record: ArrayLike, rate: float, direction: Direction = "vertical") -> FloatArray:
    """Sperling's W_z of an unweighted record, shape (...): a_B² = Σ B(f_k)² · (mean square at f_k).

    Over the record's own Fourier lines, as :func:`band_rms`; B(0) = 0, so the mean does not count.
    """
    frequency, power = _line_powers(record, rate)
    gain = sperling_weighting(frequency, direction) ** 2
    return wz_from_rms(np.sqrt(np.sum(gain * power, axis=-1)))


def block_rms(record: ArrayLike, rate: float, duration: float = 5.0) -> FloatArray:
    """R.m.s. of consecutive whole blocks of ``duration`` s of a weighted record: (..., blocks).

    What is left at the end is not counted. Raises :class:`InputError` where not one block fits.
    Source: EN 12299 (5 s).
    """
    values = checked_record(record, rate)
    length = values.shape[-1] / rate
    blocks = math.floor(length / duration * (1 + 1e-12)) if duration > 0 else 0
    if blocks < 1 or duration * rate < 1:
        raise InputError(
            str(Fault("record", f"{length:.4g} s", f"at least one block of {duration:g} s"))
        )
    edges = np.rint(np.arange(blocks + 1) * duration * rate).astype(np.int64)
    pieces = [rms(values[..., a:b]) for a, b in itertools.pairwise(edges)]
    return np.stack(pieces, axis=-1)


def n_mv(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> FloatArray:
    """N_MV = 6 √(a_x,P95² + a_y,P95² + a_z,P95²), from r.m.s. values over 5 s at the floor.

    ``x``, ``y``, ``z`` (..., blocks) in m/s², as :func:`block_rms` gives them:
    x and y weighted W_d, z weighted W_b of EN 12299 (``Wb_en12299``); 95th percentiles by linear
    interpolation. Fewer than 60 blocks are indicative only. Source: EN 12299, mean comfort.
    """
    parts = [np.percentile(checked_record(a, 1.0), 95, axis=-1) for a in (x, y, z)]
    return np.asarray(6 * np.sqrt(parts[0] ** 2 + parts[1] ** 2 + parts[2] ** 2))


@dataclass(frozen=True)
class ComfortIndices:
    """What :func:`indices` finds in one record: m/s², but ``vdv`` in m/s^1.75.

    ``a_rms`` unweighted, 0.05–80 Hz; ``mtvv`` linear, ``mtvv_exp`` exponential, 1 s;
    ``crest_factor`` None where nothing vibrates; ``wz`` None where no direction was given.
    """

    weighting: str
    duration: float
    a_rms: float
    a_wrms: float
    mtvv: float | None
    mtvv_exp: float | None
    vdv: float
    crest_factor: float | None
    wz: float | None
    remarks: tuple[str, ...] = ()


def indices(
    record: ArrayLike,
    rate: float,
    weight: str | Weighting,
    *,
    section: slice = slice(None),
    direction: Direction | None = "vertical",
    before: float | None = None,
) -> ComfortIndices:
    """All indices of one unweighted record (n,), m/s², at ``rate`` Hz.

    The weighting runs over the whole record, run-in included, from the level ``before``
    (:func:`railride.weightings.apply_weighting`); every index is then taken over the ``section`` of
    it that is rated (samples, step 1), MTVV's windows too: the run-in settles the filter and
    is in no other way part of the result. ``direction`` chooses Sperling's weighting, None (as for
    the longitudinal axis, where there is none) leaves W_z out. ``weight``: a weighting or its name.
    A section shorter than 1 s has no MTVV and no W_z, and its a_rms is not limited to a band.

    Raises :class:`InputError` for a record that cannot be used or an empty section.
    """
    values = checked_record(record, rate)
    if values.ndim != 1:
        raise InputError(str(Fault("record", f"shape {values.shape}", "one record, shape (n,)")))
    rated = values[section]
    if rated.size == 0 or section.step not in (None, 1):
        raise InputError(
            str(Fault("section", str(section), f"at least one of {values.size} samples, step 1"))
        )
    chosen = weighting(weight)
    weighted = apply_weighting(chosen, values, rate, before=before)[section]
    duration = float(rated.size / rate)
    a_w, peak_ratio = float(rms(weighted)), float(crest_factor(weighted, rate))
    dose, short = float(vdv(weighted, rate)), duration < SHORTEST
    largest = None if short else float(mtvv(weighted, rate))
    remarks = (
        band_remark(chosen, rate),
        _short_remark(duration),
        *_shock_remarks(a_w, peak_ratio, largest, dose, duration),
    )
    return ComfortIndices(
        weighting=chosen.name,
        duration=duration,
        a_rms=float(rms(rated) if short else band_rms(rated, rate)),
        a_wrms=a_w,
        mtvv=largest,
        mtvv_exp=None if short else float(mtvv(weighted, rate, kind="exponential")),
        vdv=dose,
        crest_factor=None if math.isnan(peak_ratio) else peak_ratio,
        wz=None if short or direction is None else float(sperling_wz(rated, rate, direction)),
        remarks=tuple(remark for remark in remarks if remark),
    )


def _short_remark(duration: float) -> str | None:
    """What a short section cannot give."""
    if duration >= FEW_PERIODS:
        return None
    text = f"the rated section lasts {duration:.3g} s, a few periods of what it rates at most"
    return (
        text if duration >= SHORTEST else f"{text}: no MTVV, no W_z, and a_rms of all frequencies"
    )


def _shock_remarks(
    a_w: float, peak_ratio: float, largest: float | None, dose: float, duration: float
) -> list[str]:
    """ISO 2631-1:1997, 6.2.1 and 6.3.3: where the r.m.s. alone may rate a ride too well."""
    if a_w == 0:
        return []
    dose_ratio = dose / (a_w * duration**0.25)
    found = (
        ("crest factor", peak_ratio, 9.0),
        ("MTVV/a_w", 0.0 if largest is None else largest / a_w, 1.5),
        ("VDV/(a_w T^¼)", dose_ratio, 1.75),
    )
    return [
        f"{name} = {value:.2f} is above {limit:g}: by ISO 2631-1 the r.m.s. may underestimate "
        "the discomfort; see MTVV and VDV too"
        for name, value, limit in found
        if value > limit
    ]
