"""Records with gaps: one piece is one record, several are pooled in closed form."""

import math

import numpy as np
import pytest

from railride.comfort import (
    band_rms,
    block_rms,
    indices,
    mtvv,
    pooled_rms,
    pooled_vdv,
    rms,
    sperling_wz,
    vdv,
)
from railride.errors import InputError
from railride.weightings import apply_weighting, weighting

RATE = 500
VALUES = ("duration", "a_rms", "a_wrms", "mtvv", "mtvv_exp", "vdv", "crest_factor", "wz")


def tone(seconds, amplitude, frequency=8.0, phase=0.3):
    times = np.arange(round(seconds * RATE)) / RATE
    return amplitude * np.sin(2 * np.pi * frequency * times + phase)


def values(found):
    return {name: getattr(found, name) for name in VALUES}


def test_one_piece_is_one_record():
    record = 9.81 + np.random.default_rng(2).standard_normal(40 * RATE)
    whole, piece = indices(record, RATE, "Wk"), indices([record], RATE, "Wk")
    assert values(piece) == values(whole)
    assert piece.remarks == whole.remarks
    np.testing.assert_array_equal(piece.weighted[0], whole.weighted[0])


def test_pieces_of_a_tone_are_pooled_in_closed_form():
    """10 s of amplitude 1, 30 s of 2: mean squares by duration, fourth powers, the largest."""
    found = indices([tone(10, 1.0), tone(30, 2.0)], RATE, "Wk")
    gain = abs(weighting("Wk").response(8.0))
    level = math.sqrt((10 * 1**2 + 30 * 2**2) / 40 / 2)
    assert found.duration == 40
    assert found.a_rms == pytest.approx(level, rel=1e-6)
    assert found.a_wrms == pytest.approx(gain * level, rel=1e-3)
    assert found.mtvv == pytest.approx(gain * 2 / math.sqrt(2), rel=1e-3)
    assert found.vdv == pytest.approx(gain * (3 / 8 * (10 * 1**4 + 30 * 2**4)) ** 0.25, rel=1e-3)
    assert found.crest_factor == pytest.approx(2 / level, rel=2e-3)
    alone = sperling_wz(tone(10, 1.0), RATE)  # W_z goes with the 0.3rd power of the level
    assert found.wz == pytest.approx(float(alone) * (level * math.sqrt(2)) ** 0.3, rel=1e-4)
    assert found.remarks == ()


def test_each_piece_is_rated_from_its_own_mean():
    """A sensor that comes back from a gap with another offset: no step, no shock."""
    plain = indices([tone(10, 1.0), tone(30, 1.0)], RATE, "Wk")
    moved = indices([tone(10, 1.0) + 9.81, tone(30, 1.0) - 3.0], RATE, "Wk")
    for name in VALUES:
        assert getattr(moved, name) == pytest.approx(getattr(plain, name), rel=1e-9), name


def test_no_window_reaches_over_a_gap():
    """Two bursts of half a second, one ends and one begins a piece: never one of a second."""
    quiet, burst = np.zeros(9 * RATE + RATE // 2), tone(0.5, 1.0)
    before, after = np.concatenate((quiet, burst)), np.concatenate((burst, quiet))
    apart = indices((before, after), RATE, "Wk")
    joined = indices(np.concatenate((before, after)), RATE, "Wk")
    gain = abs(weighting("Wk").response(8.0))
    assert apart.mtvv == pytest.approx(gain / 2, rel=0.1)
    assert joined.mtvv == pytest.approx(gain / math.sqrt(2), rel=0.1)


def test_the_order_of_pieces_does_not_matter():
    rng = np.random.default_rng(4)
    pieces = [rng.standard_normal(round(s * RATE)) * s for s in (7.0, 12.0, 5.5, 20.0)]
    one, other = indices(pieces, RATE, "Wd"), indices(pieces[::-1], RATE, "Wd")
    for name in VALUES:
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-12), name


def test_short_pieces_are_left_out_and_told():
    long, short = tone(20, 1.0), np.concatenate((tone(2, 30.0), np.zeros(RATE)))
    found = indices([short, long, short[: RATE // 2]], RATE, "Wk")
    alone = indices(long, RATE, "Wk")
    assert values(found) == values(alone)
    assert len(found.weighted) == 3
    (remark,) = found.remarks
    assert "2 of 3 pieces, 3.5 s of 23.5 s" in remark
    assert "shorter than 5 s" in remark
    exactly = indices([long, tone(5, 1.0)], RATE, "Wk")
    assert exactly.duration == 25


def test_where_all_are_short_those_of_a_second_are_rated():
    found = indices([tone(2, 1.0), tone(3, 1.0), tone(0.5, 50.0)], RATE, "Wk")
    assert found.duration == 5
    assert found.mtvv == pytest.approx(abs(weighting("Wk").response(8.0)) / math.sqrt(2), rel=0.01)
    assert any("1 of 3 pieces, 0.5 s" in r and "shorter than 1 s" in r for r in found.remarks)
    assert any("the longest piece lasts 3 s" in remark for remark in found.remarks)
    shortest = indices([tone(0.5, 1.0), tone(0.25, 1.0)], RATE, "Wk")
    assert shortest.duration == 0.75
    assert (shortest.mtvv, shortest.mtvv_exp, shortest.wz) == (None, None, None)
    assert any("no MTVV" in remark for remark in shortest.remarks)


def test_pooled_values_do_not_depend_on_the_length_of_blocks():
    record = np.random.default_rng(9).standard_normal(60 * RATE)
    whole, dose = float(rms(record)), float(vdv(record, 4 * RATE))
    for seconds in (0.5, 1.0, 2.0, 5.0, 12.0, 20.0):
        blocks = block_rms(record, RATE, seconds)
        assert pooled_rms(blocks, np.full(blocks.size, seconds)) == pytest.approx(whole, rel=1e-12)
        parts = record.reshape(blocks.size, -1)  # at 2 kHz: nothing between the samples
        assert pooled_vdv(vdv(parts, 4 * RATE)) == pytest.approx(dose, rel=1e-12)


def test_the_unweighted_value_is_that_of_each_pieces_band():
    pieces = [tone(10, 1.0) + 5.0, tone(20, 0.5, 120.0)]  # the second lies above 80 Hz
    found = indices(pieces, RATE, "Wk")
    expected = pooled_rms([float(band_rms(piece, RATE)) for piece in pieces], [10, 20])
    assert found.a_rms == pytest.approx(expected, rel=1e-12)
    assert expected == pytest.approx(math.sqrt(0.5 / 3), rel=1e-3)


def test_the_weighted_pieces_come_with_the_result():
    pieces = [tone(6, 1.0), tone(9, 2.0)]
    found = indices(pieces, RATE, "Wb", before=0.0)
    for piece, weighted in zip(pieces, found.weighted, strict=True):
        expected = apply_weighting("Wb", piece, RATE, before=0.0)
        np.testing.assert_allclose(weighted, expected, atol=1e-12)
    assert found.mtvv == pytest.approx(max(float(mtvv(w, RATE)) for w in found.weighted))


@pytest.mark.parametrize(
    ("pieces", "section", "message"),
    [
        ([np.zeros(9), np.zeros((2, 9))], slice(None), "one record"),
        ([np.zeros(9), np.zeros(0)], slice(None), "at least one sample"),
        ([np.zeros(9), [0.0, math.nan]], slice(None), "sample 1"),
        ([np.zeros(9), np.zeros(9)], slice(2, 5), "section.*one of 2 pieces"),
        ([], slice(None), "at least one sample"),
    ],
)
def test_pieces_that_cannot_be_used(pieces, section, message):
    with pytest.raises(InputError, match=message):
        indices(pieces, RATE, "Wk", section=section)
