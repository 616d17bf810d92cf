"""The frequency weightings, against ISO's table, python-control, scipy and steady states."""

import csv
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from railride.errors import InputError
from railride.weightings import (
    apply_weighting,
    band_remark,
    weighting,
    weighting_names,
)

TABLE_3 = Path(__file__).parent / "data" / "iso2631_1_table3.csv"


def table_3():
    """ISO 2631-1:1997, Table 3: nominal frequencies (Hz), W_k and W_d (times 1000)."""
    with TABLE_3.open(encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    rows = list(csv.reader(lines))[1:]
    return np.array(rows, dtype=float).T


def relative_rms(found, expected):
    return np.sqrt(np.mean((found - expected) ** 2) / np.mean(expected**2))


@pytest.mark.parametrize(("name", "row", "tolerance"), [("Wk", 1, 0.003), ("Wd", 2, 0.007)])
def test_magnitude_is_that_of_the_standards_table(name, row, tolerance):
    table = table_3()
    assert table.shape == (3, 37)
    magnitude = 1000 * np.abs(weighting(name).response(table[0]))
    np.testing.assert_allclose(magnitude, table[row], rtol=tolerance)


@pytest.mark.parametrize(("name", "corner"), [("Wd", 2.0), ("Wc", 8.0), ("We", 1.0)])
def test_corner_of_the_acceleration_to_velocity_step(name, corner):
    """At f3 = f4 the factor is (1 + j)/(j/Q4): √2 · 0.63, times the Butterworth limits."""
    limits = 1 / math.sqrt((1 + (0.4 / corner) ** 4) * (1 + (corner / 100) ** 4))
    found = abs(weighting(name).response(corner))
    assert found == pytest.approx(math.sqrt(2) * 0.63 * limits, rel=1e-9)


def test_wm_is_a_first_order_low_pass_between_its_limits():
    """ISO 2631-2: 1/√(1 + (f/5.684)²) with Butterworth limits 10^−0.1 and 100 Hz."""
    f = np.geomspace(0.2, 200, 40)
    limits = np.sqrt((1 + (10**-0.1 / f) ** 4) * (1 + (f / 100) ** 4))
    expected = 1 / np.sqrt(1 + (f * 0.028 * 2 * np.pi) ** 2) / limits
    np.testing.assert_allclose(abs(weighting("Wm").response(f)), expected, rtol=1e-6)


@pytest.mark.parametrize(("name", "frequency", "factor"), [("Wj", 31.5, 0.99), ("Wf", 0.16, 1.0)])
def test_wj_and_wf_are_about_one_where_the_body_feels_most(name, frequency, factor):
    """Rough (5 %): a row mixed up, or a factor left out, would be further off."""
    assert abs(weighting(name).response(frequency)) == pytest.approx(factor, rel=0.05)


def test_wb_of_en_12299_in_its_own_form():
    """K = 0.4 with the upward step written at unit gain for low frequencies."""
    s = 2j * np.pi * np.geomspace(0.05, 200, 50)
    w1, w2, w3, w5, w6 = (2 * np.pi * f for f in (0.4, 100, 16, 2.5, 4))
    band = s**2 / (s**2 + math.sqrt(2) * w1 * s + w1**2) * w2**2
    band = band / (s**2 + math.sqrt(2) * w2 * s + w2**2)
    transition = (s + w3) * w3 / (s**2 + w3 / 0.63 * s + w3**2)
    step = (s**2 + w5 / 0.8 * s + w5**2) / (s**2 + w6 / 0.8 * s + w6**2) * (w6 / w5) ** 2
    expected = 0.4 * band * transition * step
    found = weighting("Wb_en12299").response(s.imag / (2 * np.pi))
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_the_two_wb_are_not_the_same():
    frequency = np.array([1.0, 4.0, 10.0, 20.0])
    bs, en = (abs(weighting(n).response(frequency)) for n in ("Wb", "Wb_en12299"))
    assert np.max(np.abs(bs / en - 1)) > 0.03


def test_wk_paper_is_equation_6():
    """Eq (6) of Çati et al. 2024 typed as printed, with the figures of its Table 2."""
    f3, f4, f5, f6, q4, q5, q6 = 12.50, 12.50, 2.37, 3.35, 0.63, 0.91, 0.91
    frequency = np.geomspace(0.01, 500, 200)
    s = 2j * np.pi * frequency
    eq6 = (
        (s + 2 * np.pi * f3)
        / (s**2 + 2 * np.pi * f4 / q4 * s + (2 * np.pi * f4) ** 2)
        * (s**2 + 2 * np.pi * f5 / q5 * s + (2 * np.pi * f5) ** 2)
        / (s**2 + 2 * np.pi * f6 / q6 * s + (2 * np.pi * f6) ** 2)
        * 2 * np.pi * f4**2 / f3
    )  # fmt: skip
    np.testing.assert_allclose(weighting("Wk_paper").response(frequency), eq6, rtol=1e-12)
    # inside ISO's band limits the two forms are the same but for the limits' own edges
    both = [abs(weighting(name).response(np.array([4.0, 10.0]))) for name in ("Wk", "Wk_paper")]
    np.testing.assert_allclose(both[0], both[1], rtol=1e-3)


@pytest.mark.parametrize("name", weighting_names())
def test_transfer_function_is_the_same_filter(name):
    """python-control's own frequency response and poles."""
    chosen = weighting(name)
    frequency = np.geomspace(0.01, 1000, 300)
    system = chosen.transfer_function()
    expected = system(2j * np.pi * frequency)
    np.testing.assert_allclose(chosen.response(frequency), expected, rtol=1e-8)
    found = np.sort_complex(chosen.poles())
    np.testing.assert_allclose(found, np.sort_complex(system.poles()), rtol=1e-6)
    assert np.all(found.real < 0)
    assert system.input_labels == ["a"]
    assert system.output_labels == ["a_w"]


def test_response_at_zero_and_at_negative_frequencies():
    wk = weighting("Wk")
    assert wk.response(0.0) == 0
    assert weighting("Wk_paper").response(0.0) == pytest.approx((2.37 / 3.35) ** 2, rel=1e-12)
    frequency = np.array([[0.3, 7.0], [90.0, 1e6]])
    np.testing.assert_array_equal(wk.response(-frequency), np.conj(wk.response(frequency)))


RATES = [100, 200, 250, 1000, 10_000]


def settled(name, rate):
    """Samples that a filter may take to forget its start: 60 s for W_f, 5 s for the others."""
    return (60 if name == "Wf" else 5) * rate


@pytest.mark.parametrize("name", weighting_names())
@pytest.mark.parametrize("rate", RATES)
def test_tones_follow_the_analogue_filter_sample_by_sample(rate, name):
    """Steady state of a sine at third octaves, away from the ends, 1 % of its r.m.s."""
    chosen = weighting(name)
    octaves = table_3()[0]
    tones = octaves[(octaves >= 0.4) & (octaves <= min(80, 0.4 * rate * (1 + 1e-12)))]
    if name == "Wf":
        tones = tones[:: 4 if rate < 10_000 else 8]  # its records are long
    times = np.arange(settled(name, rate) + 3 * rate) / rate
    for tone in tones:
        phase = 2 * np.pi * tone * times + 0.7
        expected = np.imag(chosen.response(tone) * np.exp(1j * phase))
        found = apply_weighting(chosen, np.sin(phase), rate)
        inner = slice(settled(name, rate), -rate // 5)
        assert relative_rms(found[inner], expected[inner]) < 0.01, f"{tone} Hz"


def random_tones(times, highest, seed=4):
    """Forty tones from 0.4 Hz to ``highest`` at random phases: frequencies, phases, their sum."""
    rng = np.random.default_rng(seed)
    frequency, phase = np.geomspace(0.4, highest, 40), rng.uniform(0, 2 * np.pi, 40)
    total = np.zeros(times.size)
    for f, start in zip(frequency, phase, strict=True):
        total += np.sin(2 * np.pi * f * times + start)
    return frequency, phase, total


@pytest.mark.parametrize("name", weighting_names())
@pytest.mark.parametrize("rate", RATES)
def test_many_tones_at_once_follow_the_analogue_filter(rate, name):
    """The steady state of forty tones with random phases."""
    chosen = weighting(name)
    times = np.arange(settled(name, rate) + 5 * rate) / rate
    frequency, phase, record = random_tones(times, min(80.0, 0.4 * rate))
    inner = slice(settled(name, rate), -rate // 5)
    found, expected = apply_weighting(chosen, record, rate)[inner], 0.0
    for f, start, gain in zip(frequency, phase, chosen.response(frequency), strict=True):
        expected += np.imag(gain * np.exp(1j * (2 * np.pi * f * times[inner] + start)))
    assert relative_rms(found, expected) < 0.001


@pytest.mark.parametrize("tone", [0.5, 1.0, 5.0, 20.0])
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("phase", [0.2, 1.7])
def test_a_steady_tone_has_no_start_up_transient(rate, tone, phase):
    """The steady state from the first sample to the last, whatever the offset."""
    times = np.arange(20 * rate) / rate
    turning = 2 * np.pi * tone * times + phase
    expected = np.imag(weighting("Wk").response(tone) * np.exp(1j * turning))
    found = apply_weighting("Wk", 9.81 + np.sin(turning), rate)
    assert np.max(np.abs(found - expected)) < 0.01 * np.max(np.abs(expected))


def multisine(times, highest):
    """Forty tones from rest: faded in over the first second."""
    return random_tones(times, highest)[2] * np.sin(np.pi / 2 * np.clip(times, 0, 1)) ** 2


@pytest.mark.parametrize("name", ["Wk", "Wd", "Wb_en12299"])
@pytest.mark.parametrize("rate", [100, 200, 250, 1000])
def test_random_signal_against_scipy_at_a_finer_rate(rate, name):
    """scipy.signal.lsim of the analogue filter on the signal at 20 kHz or more, from rest."""
    from scipy import signal

    finer = max(20_000 // rate, 1)
    times = np.arange(6 * rate * finer) / (rate * finer)
    record = multisine(times, min(80.0, 0.4 * rate))
    system = weighting(name).transfer_function()
    _, peer, _ = signal.lsim((system.num[0][0], system.den[0][0]), record, times)
    found = apply_weighting(name, record[::finer], rate, before=0.0)
    inner = slice(None, -rate // 5)  # from rest both start alike: the start counts too
    assert relative_rms(found[inner], peer[::finer][inner]) < 0.002


def test_impulse_response_from_rest_against_scipy():
    """A smooth pulse on a quiet record: scipy.signal.lsim, and no pre-ringing."""
    from scipy import signal

    rate = 2000
    times = np.arange(6 * rate) / rate
    pulse = np.exp(-(((times - 1) / 0.02) ** 2))
    system = weighting("Wd").transfer_function()
    _, peer, _ = signal.lsim((system.num[0][0], system.den[0][0]), pulse, times)
    found = apply_weighting(weighting("Wd"), pulse, rate, before=0.0)
    np.testing.assert_allclose(found, peer, atol=1e-4)
    assert np.max(np.abs(found[: int(0.8 * rate)])) < 1e-9


def test_an_offset_leaves_no_transient():
    rate = 500
    record = np.sin(2 * np.pi * 5 * np.arange(10 * rate) / rate)
    plain = apply_weighting(weighting("Wk"), record, rate)
    lifted = apply_weighting(weighting("Wk"), record + 9.81, rate)
    np.testing.assert_allclose(lifted, plain, atol=1e-10)
    # from rest instead, the step rings through the high-pass: gravity's 9.81 · about ½
    stepped = apply_weighting(weighting("Wk"), record + 9.81, rate, before=0.0)
    assert np.max(np.abs(stepped - plain)) > 4
    # Eq (6) has no high-pass: the offset stays, times its gain at 0 Hz
    paper = weighting("Wk_paper")
    change = apply_weighting(paper, record + 9.81, rate) - apply_weighting(paper, record, rate)
    np.testing.assert_allclose(change, 9.81 * (2.37 / 3.35) ** 2, rtol=1e-9)


def test_before_is_the_level_that_the_record_stood_at():
    """Starting from a level is starting later in a longer record that stood there."""
    rate = 400
    rng = np.random.default_rng(8)
    later = 1.5 + np.cumsum(rng.standard_normal(4 * rate)) / 40
    longer = np.concatenate((np.full(20 * rate, 1.5), later))
    whole = apply_weighting(weighting("Wk"), longer, rate, before=1.5)[20 * rate :]
    part = apply_weighting(weighting("Wk"), later, rate, before=1.5)
    assert relative_rms(part[rate // 10 :], whole[rate // 10 :]) < 0.01


def test_last_samples_do_not_ring():
    """0.1·fs is right up to the last sample, wherever in its period the record stops."""
    rate, tone = 100, 10.0
    for extra in range(10):
        phase = 2 * np.pi * tone * np.arange(10 * rate + extra) / rate
        gain = weighting("Wk").response(tone)
        expected = np.imag(gain * np.exp(1j * phase))
        found = apply_weighting(weighting("Wk"), np.sin(phase), rate)
        assert np.max(np.abs(found - expected)[-10:]) < 0.01 * abs(gain)


@pytest.mark.parametrize("rate", [100, 250, 1000])
def test_oversampling_reads_between_the_samples(rate):
    """The steady state at seven points a sample; every seventh is the plain one."""
    tone, times = 0.37 * min(rate, 200), 7
    grid = np.arange(10 * rate * times - times + 1) / (rate * times)
    turning = 2 * np.pi * tone * grid + 0.4
    expected = np.imag(weighting("Wk").response(tone) * np.exp(1j * turning))
    record = np.sin(turning[::times])
    found = apply_weighting("Wk", record, rate, oversampling=times)
    assert found.shape == grid.shape
    assert relative_rms(found[times * rate :], expected[times * rate :]) < 0.002
    np.testing.assert_allclose(found[::times], apply_weighting("Wk", record, rate), atol=1e-12)


def test_slow_filter_does_not_wrap_round():
    """W_f rings for tens of seconds: a jolt at the end must not come back at the start."""
    rate = 100
    record = np.zeros(5 * rate)
    record[-1] = 100.0
    found = apply_weighting(weighting("Wf"), record, rate, before=0.0)
    # the jolt lasts one sample (1 m/s) and answers after the record with some tenths of 1 m/s²
    assert np.max(np.abs(found[: 3 * rate])) < 1e-6


def test_rows_are_independent_and_shape_is_kept():
    record = np.random.default_rng(1).standard_normal((2, 3, 700))
    found = apply_weighting(weighting("Wd"), record, 200.0)
    assert found.shape == record.shape
    one = apply_weighting(weighting("Wd"), record[1, 2], 200.0)
    np.testing.assert_array_equal(found[1, 2], one)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_shortest_records(count):
    found = apply_weighting(weighting("Wk"), np.arange(count) + 1.0, 100.0)
    assert found.shape == (count,)
    assert np.isfinite(found).all()


def test_band_remark():
    wk = weighting("Wk")
    assert band_remark(wk, 200.0) is None
    assert band_remark(wk, 1000.0) is None
    remark = band_remark(wk, 51.16)
    assert remark is not None
    assert "25.58 Hz" in remark
    assert "Wk reaches to 80 Hz" in remark
    assert band_remark(wk, 199.0) is not None
    assert band_remark(weighting("Wk_paper"), 199.0) is not None
    assert band_remark(weighting("Wf"), 10.0) is None  # motion sickness: to 0.5 Hz only
    assert band_remark(weighting("Wf"), 1.0) is not None


def test_unknown_weighting_names_those_that_exist():
    with pytest.raises(InputError, match=r"'Wx'.*Wk.*Wb_en12299.*Wk_paper"):
        weighting("Wx")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"f1": 0.0}, "f1.*positive"),
        ({"Q4": math.nan}, "Q4"),
        ({"gain": math.inf}, "gain"),
        ({"f4": math.inf, "Q4": math.inf}, "f4.*f3 is given"),
        ({"f6": math.inf, "Q6": math.inf}, "f5, f6"),
        ({"Q5": math.inf}, "Q5.*f5 is given"),
    ],
)
def test_weighting_checks_itself(change, message):
    with pytest.raises(InputError, match=message):
        replace(weighting("Wk"), **change)


@pytest.mark.parametrize(
    ("record", "rate", "message"),
    [
        ([0.0, math.nan, math.inf], 100.0, "sample 1 .*nan, 2 such in all"),
        ([[0.0, 0.0], [0.0, math.inf]], 100.0, "sample 1, 1 .*inf"),
        ([], 100.0, "at least one sample"),
        (3.0, 100.0, "at least one sample"),
        (["fast"], 100.0, "real numbers"),
        ([1.0], 0.0, "sampling rate.*0.0 Hz"),
        ([1.0], math.nan, "sampling rate"),
    ],
)
def test_records_that_cannot_be_used(record, rate, message):
    with pytest.raises(InputError, match=message):
        apply_weighting(weighting("Wk"), record, rate)


def test_both_faults_of_a_record_are_reported_together():
    with pytest.raises(InputError) as caught:
        apply_weighting(weighting("Wk"), [math.nan], -1.0)
    assert "sampling rate" in str(caught.value)
    assert "sample 0" in str(caught.value)


def test_level_before_the_record_must_be_a_number():
    with pytest.raises(InputError, match="level before"):
        apply_weighting(weighting("Wk"), [1.0], 100.0, before=math.inf)
