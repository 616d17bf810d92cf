"""What is not known of the time before a record is told where it decides the result."""

from __future__ import annotations

import re

import numpy as np
import pytest
from scipy import signal

from railride.comfort import indices
from railride.weightings import apply_weighting

RATE, LONG, SHORT = 100, 300, 20  # Hz, s, s


def slow_motion(seed):
    """Random accelerations below some 0.1 Hz, as of curves and cant, shape (n,)."""
    noise = np.random.default_rng(seed).standard_normal(LONG * RATE)
    b, a = signal.butter(2, 0.1, fs=RATE)
    return 0.3 * signal.lfilter(b, a, noise)


def told(record, **options):
    found = indices(record, RATE, "Wd", direction=None, **options).remarks
    return [remark for remark in found if "before the record began" in remark]


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def test_a_short_record_whose_start_decides_says_so_with_both_values():
    whole = slow_motion(3)
    weighted, errors, silent = apply_weighting("Wd", whole, RATE), [], []
    for first in range(30 * RATE, (LONG - SHORT) * RATE, 20 * RATE):
        cut = slice(first, first + SHORT * RATE)
        own = rms(apply_weighting("Wd", whole[cut], RATE))
        error = abs(own / rms(weighted[cut]) - 1)
        errors.append(error)
        remarks = told(whole[cut])
        if not remarks:
            silent.append(error)
            continue
        (text,) = remarks
        held = rms(apply_weighting("Wd", whole[cut], RATE, before=float(whole[cut].mean())))
        values = [float(v) for v in re.findall(r"([\d.]+) m/s²", text)]
        assert values == pytest.approx([own, held], rel=0.005)  # three digits
        assert abs(held / own - 1) > 0.01
    assert max(errors) > 0.15  # the start does decide
    assert max(silent) < 0.01


def test_a_long_record_and_a_known_start_say_nothing():
    whole = slow_motion(3)
    assert told(whole) == []
    assert told(whole[: SHORT * RATE], before=0.0) == []
    assert told(np.zeros(2000)) == []


def test_what_lies_in_a_run_in_does_not_count():
    whole = slow_motion(3)
    cut = next(
        whole[k:][: 80 * RATE] for k in range(0, 200 * RATE, RATE) if told(whole[k:][: 20 * RATE])
    )
    assert told(cut, section=slice(60 * RATE, None)) == []


def test_pieces_are_told_of_together():
    whole = slow_motion(3)
    pieces = [whole[k * RATE :][: 10 * RATE] for k in (0, 50, 100, 150)]
    held = [apply_weighting("Wd", p, RATE, before=float(p.mean())) for p in pieces]
    (text,) = told(pieces)
    values = [float(v) for v in re.findall(r"([\d.]+) m/s²", text)]
    assert values[1] == pytest.approx(rms(np.concatenate(held)), rel=0.005)
