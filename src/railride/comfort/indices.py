"""All comfort indices of one axis, recorded whole or in pieces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import cast

import numpy as np
from numpy.typing import ArrayLike

from railride.comfort.advice import shock_remarks
from railride.comfort.averages import line_powers, pooled_rms, rms, rms_of_lines
from railride.comfort.dose import dose, pooled_vdv
from railride.comfort.peaks import oversampling, peak
from railride.comfort.running import mtvv
from railride.comfort.sperling import Direction, sperling_rms, wz_from_rms
from railride.comfort.start import held_rms, start_remark
from railride.errors import Fault, InputError
from railride.scales import levels, paper_level
from railride.weightings import (
    FloatArray,
    Weighting,
    apply_weighting,
    band_remark,
    checked_record,
    weighting,
)

SHORTEST = 1.0
"""s: the window of MTVV; a shorter section has none."""

FEW_PERIODS = 5.0
"""s: below it a section is too short for what is rated down to 0.5 Hz."""


@dataclass(frozen=True)
class ComfortIndices:
    """What :func:`indices` finds in one record: m/s², but ``vdv`` in m/s^1.75.

    ``duration``: of what is rated, s. ``a_rms`` unweighted, 0.05–80 Hz; ``mtvv`` linear,
    ``mtvv_exp`` exponential, 1 s; ``crest_factor`` None where nothing vibrates; ``wz`` None where
    no direction was given. ``weighted``: the weighted record, piece by piece, run-in included.
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
    weighted: tuple[FloatArray, ...] = field(default=(), repr=False, compare=False)

    @property
    def level(self) -> str:
        """The class of the paper's Table 3."""
        return paper_level(self.a_wrms)

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → the classes that fit."""
        return levels(self.a_wrms, self.wz)


def indices(
    record: ArrayLike | Sequence[FloatArray],
    rate: float,
    weight: str | Weighting,
    *,
    section: slice = slice(None),
    direction: Direction | None = "vertical",
    before: float | None = None,
) -> ComfortIndices:
    """All indices of one unweighted record (n,), m/s², at ``rate`` Hz; or of a list of its pieces.

    The weighting runs over the whole record, run-in included, from the level ``before``
    (:func:`railride.weightings.apply_weighting`); every index is then taken over the ``section`` of
    it that is rated (samples, step 1), MTVV's windows too: the run-in settles the filter and
    is in no other way part of the result. ``direction`` chooses Sperling's weighting, None (as for
    the longitudinal axis, where there is none) leaves W_z out. ``weight``: a weighting or its name.
    A section shorter than 1 s has no MTVV and no W_z, and its a_rms is not limited to a band.

    ``record`` with gaps: a list or tuple of contiguous pieces, in time order. Each is weighted by
    itself, and all are rated together: mean squares by their durations, VDV by fourth powers, MTVV
    as the largest in any piece, the crest factor from the largest peak and the common r.m.s. Pieces
    shorter than 5 s, which say little of what is rated down to 0.5 Hz, are left out, with a
    remark, where there is a longer one (or else those shorter than 1 s).

    Raises :class:`InputError` for a record that cannot be used, an empty section, or a section of a
    record in pieces.
    """
    pieces = pieces_of(record, rate)
    rated = _rated(section, pieces)
    chosen, seconds = weighting(weight), np.array([piece.size / rate for piece in pieces])
    least = next(t for t in (FEW_PERIODS, SHORTEST, 0.0) if seconds.max() >= t)
    parts, weighted, held = [], [], list[float]()
    for piece, lasting in zip(pieces, seconds, strict=True):
        fine = apply_weighting(
            chosen, piece, rate, before=before, oversampling=(times := oversampling(rate))
        )
        # Copied, so that the finer one can go.
        weighted.append(fine[::times].copy() if times > 1 else fine)
        if lasting >= least:
            found = fine[rated.start * times : (min(rated.stop, piece.size) - 1) * times + 1]
            parts.append(_part(piece[rated], weighted[-1][rated], found, rate, direction))
            if before is None:
                held.append(held_rms(piece, weighted[-1], rate, chosen, rated))
    said = (band_remark(chosen, rate), _left_out(seconds, least), _on_start(parts, held))
    return _pooled(parts, chosen.name, tuple(weighted), said)


def pieces_of(record: ArrayLike | Sequence[FloatArray], rate: float) -> list[FloatArray]:
    """The pieces of a record, each (n,); a record in one piece is the only one.

    Raises :class:`InputError` for samples that cannot be used and a ``rate`` (Hz) that cannot.
    """
    whole = not isinstance(record, list | tuple) or all(np.ndim(value) == 0 for value in record)
    several = [record] if whole else list(cast("Sequence[ArrayLike]", record))
    pieces = [checked_record(piece, rate) for piece in several]
    for piece in pieces:
        if piece.ndim != 1:
            raise InputError(str(Fault("record", f"shape {piece.shape}", "one record, shape (n,)")))
    return pieces


def _rated(section: slice, pieces: list[FloatArray]) -> slice:
    """The section with a start and a stop."""
    size = max(piece.size for piece in pieces)
    start, stop, step = section.indices(size)
    if stop <= start or step != 1:
        raise InputError(
            str(Fault("section", str(section), f"at least one of {size} samples, step 1"))
        )
    if len(pieces) > 1 and section != slice(None):
        raise InputError(str(Fault("section", f"one of {len(pieces)} pieces", "one of one piece")))
    return slice(start, stop)


@dataclass(frozen=True)
class _Part:
    """What one piece adds; ``a_b`` is Sperling's weighted r.m.s."""

    seconds: float
    a_rms: float
    a_wrms: float
    peak: float
    vdv: float
    mtvv: float | None
    mtvv_exp: float | None
    a_b: float | None


def _part(
    record: FloatArray,
    weighted: FloatArray,
    fine: FloatArray,
    rate: float,
    direction: Direction | None,
) -> _Part:
    """Every index of one piece from its ``record``, weighted, and weighted on a ``fine`` grid."""
    seconds = record.size / rate
    level, largest, vdv = float(rms(weighted)), float(peak(fine)), float(dose(fine, seconds))
    if seconds < SHORTEST:
        return _Part(seconds, float(rms(record)), level, largest, vdv, None, None, None)
    frequency, power = line_powers(record, rate)
    return _Part(
        seconds,
        float(rms_of_lines(frequency, power)),
        level,
        largest,
        vdv,
        float(mtvv(weighted, rate)),
        float(mtvv(weighted, rate, kind="exponential")),
        None if direction is None else float(sperling_rms(frequency, power, direction)),
    )


def _pooled(
    parts: list[_Part], name: str, weighted: tuple[FloatArray, ...], said: tuple[str | None, ...]
) -> ComfortIndices:
    """The indices of all parts together; each is short, or none is."""
    seconds = [part.seconds for part in parts]
    duration, a_w = sum(seconds), pooled_rms([part.a_wrms for part in parts], seconds)
    crest = max(part.peak for part in parts) / a_w if a_w > 0 else None
    vdv = pooled_vdv([part.vdv for part in parts])
    largest = max((part.mtvv for part in parts if part.mtvv is not None), default=None)
    a_b = [part.a_b for part in parts if part.a_b is not None]
    remarks = (*said, _short_remark(seconds), *shock_remarks(a_w, crest, largest, vdv, duration))
    return ComfortIndices(
        weighting=name,
        duration=duration,
        a_rms=pooled_rms([part.a_rms for part in parts], seconds),
        a_wrms=a_w,
        mtvv=largest,
        mtvv_exp=max((p.mtvv_exp for p in parts if p.mtvv_exp is not None), default=None),
        vdv=vdv,
        crest_factor=crest,
        wz=float(wz_from_rms(pooled_rms(a_b, seconds))) if a_b else None,
        remarks=tuple(remark for remark in remarks if remark),
        weighted=weighted,
    )


def _on_start(parts: list[_Part], held: list[float]) -> str | None:
    """Whether the unknown start decides; ``held`` is empty where what came before is known."""
    if not held:
        return None
    seconds = [part.seconds for part in parts]
    return start_remark(
        pooled_rms([part.a_wrms for part in parts], seconds), pooled_rms(held, seconds)
    )


def _short_remark(seconds: list[float]) -> str | None:
    """What a short section, or a record whose pieces are all short, cannot give."""
    longest = max(seconds)
    if longest >= FEW_PERIODS:
        return None
    rated = "the rated section" if len(seconds) == 1 else "the longest piece"
    text = f"{rated} lasts {longest:.3g} s, a few periods of what it rates at most"
    return text if longest >= SHORTEST else f"{text}: no MTVV, no W_z, and a_rms of all frequencies"


def _left_out(seconds: FloatArray, least: float) -> str | None:
    """Pieces that are too short to be rated among others."""
    short = seconds < least
    if not short.any():
        return None
    return (
        f"{np.count_nonzero(short)} of {short.size} pieces, {seconds[short].sum():.3g} s of "
        f"{seconds.sum():.4g} s, are shorter than {least:g} s, too short to be rated: they are in "
        "no index, their shocks included"
    )
