"""Comfort indices, against closed forms of sines and bursts, and the scales at their limits."""

import math

import numpy as np
import pytest

from railride.comfort import (
    band_rms,
    block_rms,
    crest_factor,
    indices,
    mtvv,
    n_mv,
    oversample,
    rms,
    running_rms,
    sperling_weighting,
    sperling_wz,
    vdv,
    wz_from_rms,
)
from railride.comfort.averages import line_powers
from railride.errors import InputError
from railride.scales import (
    EN_12299_CONTINUOUS,
    EN_12299_MEAN,
    ISO_2631_1_ANNEX_C,
    PAPER_TABLE_3,
    SCALES,
    SPERLING,
    UIC_513,
    ComfortClass,
    Scale,
    classes_of,
    levels,
    paper_level,
)
from railride.weightings import apply_weighting, weighting


def sine(frequency, rate, seconds, amplitude=1.0, phase=0.0):
    times = np.arange(round(seconds * rate)) / rate
    return amplitude * np.sin(2 * np.pi * frequency * times + phase)


def test_rms_of_a_sine():
    record = np.stack([sine(5, 1000, 4, 0.8), sine(7, 1000, 4, 2.0)])
    np.testing.assert_allclose(rms(record), [0.8 / math.sqrt(2), math.sqrt(2)], rtol=1e-12)


def test_band_rms_takes_what_lies_in_the_band():
    rate = 1000
    record = (
        9.81
        + sine(0.025, rate, 40, 3.0)
        + sine(0.05, rate, 40, 0.6)
        + sine(10, rate, 40, 0.8)
        + sine(80, rate, 40, 0.2)
        + sine(90, rate, 40, 5.0)
    )
    inside = math.sqrt((0.6**2 + 0.8**2 + 0.2**2) / 2)
    np.testing.assert_allclose(band_rms(record, rate), inside, rtol=1e-9)
    np.testing.assert_allclose(band_rms(record, rate, 5, 20), 0.8 / math.sqrt(2), rtol=1e-9)


@pytest.mark.parametrize("count", [1, 2, 999, 1000])
def test_band_rms_of_everything_is_the_rms(count):
    """Parseval, for odd and even lengths, 0 Hz and fs/2 included."""
    record = np.random.default_rng(2).standard_normal((2, count)) + 1
    np.testing.assert_allclose(band_rms(record, 100.0, 0.0, 1e9), rms(record), rtol=1e-12)


@pytest.mark.parametrize("count", [120_011, 131_071])
def test_a_long_spectrum_of_an_awkward_number_of_samples_holds_the_same(count):
    """Prime numbers of samples: the same mean squares, in all and in a band, and the same mean."""
    rate = 200.0
    record = 9.81 + sine(5, rate, count / rate, 0.4) + sine(30, rate, count / rate, 0.3)
    frequency, power = line_powers(record, rate)
    assert frequency.size == power.size > count // 2 + 1
    assert power.sum() == pytest.approx(np.mean(record**2), rel=1e-12)
    assert power[0] == pytest.approx(record.mean() ** 2, rel=1e-12)
    assert band_rms(record, rate, 3, 10) == pytest.approx(0.4 / math.sqrt(2), rel=1e-4)
    assert band_rms(record, rate) == pytest.approx(0.5 / math.sqrt(2), rel=1e-4)
    b = math.hypot(*(a * sperling_weighting(f) for a, f in ((0.4, 5.0), (0.3, 30.0))))
    expected = wz_from_rms(b / math.sqrt(2))
    assert sperling_wz(record, rate) == pytest.approx(float(expected), rel=1e-4)


@pytest.mark.parametrize("frequency", [0.9, 1.013, 9.6, 30.3])
def test_band_rms_leaks_less_than_a_thousandth(frequency):
    """Tones that do not fit the 24.83 s of a kilometre at 145 km/h."""
    for phase in np.linspace(0, 2 * np.pi, 7):
        record = sine(frequency, 1000, 24.83, phase=phase)
        assert band_rms(record, 1000) == pytest.approx(float(rms(record)), rel=1e-3)


def test_band_rms_counts_a_drift_as_it_says():
    drift = 0.5
    record = np.linspace(-drift / 2, drift / 2, 30_000)
    assert band_rms(record, 1000, 0.01) == pytest.approx(drift / math.sqrt(12), rel=2e-3)


def test_running_rms_of_a_burst():
    """Ten periods of 20 Hz, half a second: it fills half of the 1 s window."""
    rate, amplitude = 1000, 0.7
    record = np.zeros(5 * rate)
    record[2000:2500] = sine(20, rate, 0.5, amplitude)
    found = running_rms(record, rate)
    assert found.shape == record.shape
    np.testing.assert_array_equal(found[:2000], 0)
    np.testing.assert_allclose(found[2500:2999], amplitude / 2, rtol=1e-3)
    np.testing.assert_allclose(found[3600:], 0, atol=1e-7)
    assert mtvv(record, rate) == pytest.approx(amplitude / 2, rel=1e-3)
    # exponential: after the burst a²/2 · (1 − e^−0.5), then e^−(t/τ) of it
    peak = amplitude / math.sqrt(2) * math.sqrt(1 - math.exp(-0.5))
    assert mtvv(record, rate, kind="exponential") == pytest.approx(peak, rel=0.01)
    later = running_rms(record, rate, kind="exponential")[[2999, 3999]]
    assert later[1] / later[0] == pytest.approx(math.exp(-0.5), rel=1e-9)


@pytest.mark.parametrize("kind", ["linear", "exponential"])
def test_running_rms_of_a_constant(kind):
    """a·√min(1, t/τ) and a·√(1 − e^(−t/τ)), with a window of 51.16 samples."""
    rate, tau = 51.16, 1.0
    t = np.arange(1, 301) / rate
    expected = np.minimum(t / tau, 1) if kind == "linear" else 1 - np.exp(-t / tau)
    found = running_rms(np.full((2, 300), -3.0), rate, tau, kind)
    np.testing.assert_allclose(found, np.tile(3 * np.sqrt(expected), (2, 1)), rtol=1e-9)


def test_mtvv_of_a_steady_sine_is_its_rms():
    assert mtvv(sine(8, 500, 10), 500) == pytest.approx(1 / math.sqrt(2), rel=1e-9)
    assert mtvv(sine(8, 500, 10), 500, tau=0.25) == pytest.approx(1 / math.sqrt(2), rel=1e-9)


def test_running_rms_after_a_great_shock_stays_a_number():
    """The running sum loses digits to the shock: still a number, and nothing where nothing is."""
    record = np.zeros(3000)
    record[10] = 1e9
    found = running_rms(record, 51.16)
    assert found[10] == pytest.approx(1e9 / math.sqrt(51.16))
    np.testing.assert_array_equal(found[200:], 0)


def test_vdv_of_a_sine():
    """(3/8 A⁴ T)^¼."""
    record = sine(6, 1000, 20, 1.3)
    assert vdv(record, 1000) == pytest.approx(1.3 * (3 / 8 * 20) ** 0.25, rel=1e-4)


@pytest.mark.parametrize("phase", [0.0, math.pi / 8, math.pi / 4])
def test_vdv_between_the_samples(phase):
    """A quarter of the rate: on the bare samples (¼ to ½ A⁴ T)^¼, whatever the phase here."""
    record = sine(25, 100, 60, 1.0, phase)
    assert vdv(record, 100) == pytest.approx((3 / 8 * 60) ** 0.25, rel=1e-3)


def test_vdv_of_a_burst_does_not_depend_on_the_quiet():
    record = np.zeros((2, 10_000))
    record[0, 1000:2000] = sine(10, 1000, 1.0, 2.0)
    record[1, 6000:7000] = record[0, 1000:2000]
    np.testing.assert_allclose(vdv(record, 1000), 2 * (3 / 8) ** 0.25, rtol=1e-3)
    np.testing.assert_allclose(vdv(record[:, :8000], 1000), vdv(record, 1000), rtol=1e-3)


@pytest.mark.parametrize(("frequency", "rate"), [(5, 1000), (25, 100), (15, 51.16), (3, 10_000)])
def test_crest_factor_of_a_sine(frequency, rate):
    """√2, though the samples may miss every peak (25 Hz at 100 Hz, 45° off)."""
    record = sine(frequency, rate, 40, 1.7, math.pi / 4)
    assert crest_factor(record, rate) == pytest.approx(math.sqrt(2), rel=0.02)


def test_crest_factor_of_a_burst():
    """One of four seconds: √2 · √4."""
    record = np.zeros(4000)
    record[1000:2000] = sine(10, 1000, 1.0)
    assert crest_factor(record, 1000) == pytest.approx(2 * math.sqrt(2), rel=2e-3)


def test_crest_factor_of_nothing_is_undefined():
    found = crest_factor(np.stack([np.zeros(50), sine(5, 50, 1)]), 50)
    assert math.isnan(found[0])
    assert found[1] > 1


@pytest.mark.parametrize("rate", [51.16, 100.0, 700.0])
def test_oversampling_follows_the_tones_and_keeps_the_samples(rate):
    times = math.ceil(2000 / rate)
    seconds, tone = 10, 0.35 * rate
    record = sine(tone, rate, seconds) + 0.5
    fine = oversample(record, rate)
    assert fine.size == (record.size - 1) * times + 1
    np.testing.assert_allclose(fine[::times], record, atol=1e-9)
    expected = np.sin(2 * np.pi * tone * np.arange(fine.size) / (rate * times)) + 0.5
    inner = slice(fine.size // 10, -fine.size // 10)
    np.testing.assert_allclose(fine[inner], expected[inner], atol=2e-3)


def test_oversampling_leaves_fast_records_alone():
    record = sine(5, 2000, 1)
    np.testing.assert_array_equal(oversample(record, 2000), record)


def test_oversampling_does_not_ring_at_the_ends():
    """A record that stops at its largest value: no peak is invented beyond it."""
    record = np.cos(np.linspace(0, 10 * 2 * np.pi, 501))
    assert np.max(np.abs(oversample(record, 50.0))) < 1.01


def test_sperling_weighting_by_hand():
    """f = 5 Hz: 1.911·25 = 47.775; (0.25·25)² = 39.0625; (1 − 6.925)² = 35.105625;
    (7.815 − 4.6)² = 10.336225; 0.588·√(86.8375/45.44185).
    """
    assert sperling_weighting(5.0) == pytest.approx(0.588 * math.sqrt(86.8375 / 45.44185), rel=1e-9)
    ratio = sperling_weighting([1.0, 7.0], "lateral") / sperling_weighting([1.0, 7.0])
    np.testing.assert_allclose(ratio, 1.25)
    assert sperling_weighting(0.0) == 0
    # the figure most felt lies between 4 and 7 Hz
    frequency = np.linspace(0.1, 40, 4000)
    assert 4 < frequency[np.argmax(sperling_weighting(frequency))] < 7


@pytest.mark.parametrize("direction", ["vertical", "lateral"])
def test_wz_of_a_single_frequency(direction):
    """4.42 · (B(f) A/√2)^0.3, whatever the mean."""
    record = 9.81 + sine(5, 200, 12, 0.4)
    b = 0.588 * math.sqrt(86.8375 / 45.44185) * (1.25 if direction == "lateral" else 1)
    expected = 4.42 * (b * 0.4 / math.sqrt(2)) ** 0.3
    assert sperling_wz(record, 200, direction) == pytest.approx(expected, rel=1e-9)


def test_wz_does_not_depend_on_the_length_and_adds_by_energy():
    two = sine(5, 200, 12, 0.4) + sine(1, 200, 12, 0.6)
    longer = np.tile(two, 10)
    assert sperling_wz(longer, 200) == pytest.approx(float(sperling_wz(two, 200)), rel=1e-9)
    parts = [sperling_weighting(5.0) * 0.4, sperling_weighting(1.0) * 0.6]
    expected = wz_from_rms(math.hypot(*parts) / math.sqrt(2))
    assert sperling_wz(two, 200) == pytest.approx(float(expected), rel=1e-9)


def test_wz_from_rms():
    np.testing.assert_allclose(wz_from_rms([0.0, 1.0, 2.0]), [0, 4.42, 4.42 * 2**0.3])


def test_block_rms_and_n_mv():
    rate = 400
    record = np.concatenate([sine(4, rate, 5, a) for a in (1.0, 2.0, 3.0)] + [np.ones(100)])
    blocks = block_rms(record, rate)
    np.testing.assert_allclose(blocks, np.array([1, 2, 3]) / math.sqrt(2), rtol=1e-9)
    # 95th percentile of 0 … 100 is 95, by hand; of 1, 2, 3 it is 2.9
    x, y, z = np.arange(101) * 0.001, np.zeros(101), np.arange(101) * 0.002
    assert n_mv(x, y, z) == pytest.approx(6 * math.hypot(0.095, 0.19), rel=1e-9)
    assert n_mv([1, 2, 3], [0, 0, 0], [0, 0, 0]) == pytest.approx(6 * 2.9, rel=1e-9)
    with pytest.raises(InputError, match=r"4\.5 s.*5 s"):
        block_rms(np.zeros(1800), rate)


def test_scales_hold_every_value_and_name_their_source():
    for scale in SCALES:
        assert scale.source
        for value in np.linspace(0, 10, 2001):
            assert classes_of(scale, float(value)), f"{scale.name} at {value}"


def test_paper_levels():
    """Table 3, its words and its limits (the lower one belongs to the class)."""
    for value, label in [
        (0.0, "very comfortable"),
        (0.1999, "very comfortable"),
        (0.2, "comfortable"),
        (0.3, "medium"),
        (0.4, "little comfortable"),
        (0.6, "fairly comfortable"),
        (9.0, "fairly comfortable"),
    ]:
        assert paper_level(value) == label
    # finding 8: at 145 km/h the paper's own two programs fall into different classes
    assert paper_level(0.225) != paper_level(0.191)


@pytest.mark.parametrize(
    ("value", "classes"),
    [
        (0.3149, ("not uncomfortable",)),
        (0.315, ("a little uncomfortable",)),
        (0.5, ("a little uncomfortable", "fairly uncomfortable")),
        (0.63, ("a little uncomfortable", "fairly uncomfortable")),
        (0.64, ("fairly uncomfortable",)),
        (0.9, ("fairly uncomfortable", "uncomfortable")),
        (1.25, ("uncomfortable", "very uncomfortable")),
        (2.0, ("very uncomfortable",)),
        (2.2, ("very uncomfortable", "extremely uncomfortable")),
        (2.51, ("extremely uncomfortable",)),
    ],
)
def test_iso_annex_c_ranges_overlap(value, classes):
    assert classes_of(ISO_2631_1_ANNEX_C, value) == classes


@pytest.mark.parametrize(
    ("scale", "value", "label"),
    [
        (SPERLING, 0.9, "not noticeable"),
        (SPERLING, 1.0, "just noticeable"),
        (SPERLING, 2.49, "clearly noticeable"),
        (SPERLING, 2.5, "more pronounced but not unpleasant"),
        (SPERLING, 3.0, "strong, irregular, but still tolerable"),
        (SPERLING, 3.3, "very irregular"),
        (SPERLING, 3.6, "extremely irregular, unpleasant"),
        (SPERLING, 4.5, "extremely unpleasant, prolonged exposure harmful"),
        (EN_12299_CONTINUOUS, 0.3, "medium"),
        (EN_12299_MEAN, 4.4, "uncomfortable"),
        (UIC_513, 1.5, "good comfort"),
    ],
)
def test_other_scales(scale, value, label):
    assert classes_of(scale, value) == (label,)


@pytest.mark.parametrize(
    ("scale", "limits"),
    [
        (EN_12299_CONTINUOUS, (0.2, 0.3, 0.4)),
        (EN_12299_MEAN, (1.5, 2.5, 3.5, 4.5)),
        (UIC_513, (1.0, 2.0, 4.0, 5.0)),
    ],
)
def test_each_limit_is_the_next_classes_own(scale, limits):
    labels = [entry.label for entry in scale.classes]
    for limit, below, above in zip(limits, labels[:-1], labels[1:], strict=True):
        assert classes_of(scale, limit - 1e-9) == (below,)
        assert classes_of(scale, limit) == (above,)


def test_levels():
    assert levels(0.55, 2.3) == {
        "Cati 2024 Table 3": ["little comfortable"],
        "ISO 2631-1 Annex C": ["a little uncomfortable", "fairly uncomfortable"],
        "Sperling Wz": ["clearly noticeable"],
    }
    assert SPERLING.name not in levels(0.55)


@pytest.mark.parametrize("value", [-0.1, math.nan, math.inf])
def test_values_that_cannot_be_rated(value):
    with pytest.raises(InputError, match=r"Table 3.*a number ≥ 0"):
        classes_of(PAPER_TABLE_3, value)


def test_scale_checks_itself():
    gap = (ComfortClass("good", 0.0, 1.0), ComfortClass("bad", 2.0, math.inf))
    with pytest.raises(InputError, match=r"bad.*no gap after 1\.0"):
        Scale("mine", "a", "nowhere", gap)
    with pytest.raises(InputError, match=r"last class.*no upper limit"):
        Scale("mine", "a", "nowhere", gap[:1])


def test_indices_of_a_sine():
    """Every index in closed form; 10 s of run-in are weighted but not rated."""
    rate, tone, amplitude, gain = 500, 5.0, 0.6, abs(weighting("Wk").response(5.0))
    record = 9.81 + sine(tone, rate, 30, amplitude)
    found = indices(record, rate, weighting("Wk"), section=slice(10 * rate, None))
    level = amplitude / math.sqrt(2)
    assert found.weighting == "Wk"
    assert found.duration == 20
    assert found.a_rms == pytest.approx(level, rel=1e-6)
    assert found.a_wrms == pytest.approx(gain * level, rel=1e-4)
    assert found.mtvv == pytest.approx(gain * level, rel=1e-4)
    assert found.mtvv_exp == pytest.approx(gain * level, rel=0.03)
    assert found.vdv == pytest.approx(gain * amplitude * (3 / 8 * 20) ** 0.25, rel=1e-3)
    assert found.crest_factor == pytest.approx(math.sqrt(2), rel=5e-3)
    b = 0.588 * math.sqrt(86.8375 / 45.44185)
    assert found.wz == pytest.approx(4.42 * (b * level) ** 0.3, rel=1e-6)
    assert found.remarks == ()


@pytest.mark.parametrize("rate", [100, 200, 250, 1000, 10_000])
@pytest.mark.parametrize(("name", "tone"), [("Wk", 8.0), ("Wd", 2.0), ("Wb", 31.5), ("Wk", 40.0)])
def test_indices_of_a_sine_from_its_first_sample(rate, name, tone):
    """Without a run-in: no start-up transient decides MTVV, VDV or the crest factor."""
    gain, amplitude, seconds = abs(weighting(name).response(tone)), 0.7, 20
    found = indices(9.81 + sine(tone, rate, seconds, amplitude, 1.1), rate, name)
    level = gain * amplitude / math.sqrt(2)
    assert found.a_rms == pytest.approx(amplitude / math.sqrt(2), rel=1e-3)
    assert found.a_wrms == pytest.approx(level, rel=1e-3)
    assert found.mtvv == pytest.approx(level, rel=5e-3)
    # a_w² is the mean and a ripple at twice the tone, which a first-order low-pass lets through
    ripple = 1 / math.hypot(1, 4 * math.pi * tone)
    # (at 100 Hz the square of 40 Hz is read as 20 Hz, which ripples by 0.3 % more)
    assert found.mtvv_exp == pytest.approx(level * math.sqrt(1 + ripple), rel=4e-3)
    assert found.vdv == pytest.approx(gain * amplitude * (3 / 8 * seconds) ** 0.25, rel=1e-3)
    assert found.crest_factor == pytest.approx(math.sqrt(2), rel=0.01)


@pytest.mark.parametrize("rate", [100, 200, 250, 1000, 10_000])
@pytest.mark.parametrize("middle", [12.0, 23.7])
def test_indices_of_a_burst(rate, middle):
    """A tone of 16 Hz under a Hann window of D = 6 s, in T = 36 s, so slow that W_k is its gain.

    ∫ cos⁴(πt/D) dt = 3D/8, ∫ cos⁸(πt/D) dt = 35D/128, each over the window.
    """
    from scipy import integrate

    length, total, tone, amplitude = 6.0, 36.0, 16.0, 1.3
    times = np.arange(round(total * rate)) / rate - middle
    window = np.where(abs(times) < length / 2, np.cos(np.pi * times / length) ** 2, 0.0)
    record = amplitude * window * np.sin(2 * np.pi * tone * times + 0.4)
    found = indices(record, rate, "Wk")
    level = abs(weighting("Wk").response(tone)) * amplitude
    a_w = level * math.sqrt(3 / 8 * length / total / 2)
    assert found.a_wrms == pytest.approx(a_w, rel=2e-3)
    assert found.vdv == pytest.approx(level * (3 / 8 * 35 / 128 * length) ** 0.25, rel=2e-3)
    assert found.crest_factor == pytest.approx(level / a_w, rel=0.01)
    square = integrate.quad(lambda t: np.cos(np.pi * t / length) ** 4, -0.5, 0.5)[0]
    assert found.mtvv == pytest.approx(level * math.sqrt(square / 2), rel=3e-3)
    reach = [
        integrate.quad(lambda t, now=now: np.cos(np.pi * t / length) ** 4 * math.exp(t - now),
                       -length / 2, now)[0]
        for now in np.arange(-1.0, 3.0, 0.02)
    ]  # fmt: skip
    assert found.mtvv_exp == pytest.approx(level * math.sqrt(max(reach) / 2), rel=0.01)


def test_indices_rate_the_section_and_nothing_else():
    """A shock just before the section settles with the filter but is in no index."""
    rate = 500
    record = sine(5, rate, 30, 0.5)
    shocked = record.copy()
    shocked[: 2 * rate] *= 50
    section = slice(20 * rate, None)
    one = indices(record, rate, weighting("Wk"), section=section)
    other = indices(shocked, rate, weighting("Wk"), section=section)
    for name in ("a_rms", "a_wrms", "mtvv", "mtvv_exp", "vdv", "crest_factor", "wz"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-5), name


def test_indices_are_the_single_functions():
    rate, wd = 250, weighting("Wd")
    record = np.random.default_rng(3).standard_normal(5000)
    found = indices(record, rate, wd, direction="lateral")
    weighted = apply_weighting(wd, record, rate)
    assert found.a_wrms == float(rms(weighted))
    assert found.mtvv_exp == float(mtvv(weighted, rate, kind="exponential"))
    assert found.wz == float(sperling_wz(record, rate, "lateral"))
    assert all(type(v) is float for v in (found.duration, found.a_rms, found.vdv, found.wz))


def test_indices_of_silence():
    found = indices(np.zeros(1200), 200, weighting("Wk"), direction=None)
    assert found.crest_factor is None
    assert found.wz is None
    assert found.a_wrms == found.mtvv == found.vdv == 0
    assert found.remarks == ()


@pytest.mark.parametrize(
    ("share", "remarked"),
    [
        (0.5, set()),  # MTVV/a_w = √2
        (0.2, {"MTVV/a_w"}),  # √5; VDV ratio (3/8 · 0.2)^¼ / √0.1 = 1.65
        (0.1, {"MTVV/a_w", "VDV/(a_w T^¼)"}),  # √10; 1.97; crest factor √20 = 4.5
        (0.02, {"MTVV/a_w", "VDV/(a_w T^¼)", "crest factor"}),  # crest factor √(2/0.02) = 10
    ],
)
def test_iso_limits_of_shocks(share, remarked):
    """A burst of 10 Hz in ``share`` of the record: its ratios pass ISO's 9, 1.5, 1.75 by turns."""
    rate, seconds = 1000, 100
    record = sine(10, rate, seconds)
    record[round(share * record.size) :] = 0
    record = np.roll(record, rate)
    remarks = indices(record, rate, weighting("Wk")).remarks
    assert {remark.split(" = ")[0] for remark in remarks} == remarked


def test_remarks_on_shocks_band_and_length():
    shock = np.zeros(60 * 150)
    shock[4000:4010] = 5.0
    remarks = " | ".join(indices(shock, 150, weighting("Wk")).remarks)
    for part in ("above 75 Hz", "crest factor", "MTVV/a_w", "VDV/(a_w T^¼)", "ISO 2631-1"):
        assert part in remarks
    assert any("3 s, a few periods" in r for r in indices(sine(8, 1000, 3), 1000, "Wk").remarks)
    short = indices(sine(8, 1000, 0.5), 1000, weighting("Wk"))
    assert any("0.5 s" in remark and "no MTVV" in remark for remark in short.remarks)
    assert (short.mtvv, short.mtvv_exp, short.wz) == (None, None, None)
    assert short.a_rms == pytest.approx(2**-0.5, rel=1e-3)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: band_rms([1.0, 2.0], 10, 5, 5), "band.*low < high"),
        (lambda: band_rms([1.0, 2.0], 10, -1, 5), "band.*low < high"),
        (lambda: running_rms([1.0], 10, 0.0), "integration time"),
        (lambda: running_rms([1.0], 10, kind="slow"), "'slow'.*'linear' or 'exponential'"),
        (lambda: sperling_weighting(1.0, "up"), "'up'.*'vertical' or 'lateral'"),
        (lambda: rms([math.nan]), "sample 0"),
        (lambda: vdv([1.0], -5.0), "sampling rate"),
        (lambda: block_rms([1.0], 10.0, 0.0), "block"),
        (lambda: indices(np.zeros((2, 9)), 10, weighting("Wk")), "one record"),
        (lambda: indices(np.zeros(9), 10, weighting("Wk"), section=slice(9, None)), "section"),
        (lambda: indices(np.zeros(9), 10, weighting("Wk"), section=slice(0, 9, 2)), "step 1"),
    ],
)
def test_what_cannot_be_used_is_refused(call, message):
    with pytest.raises(InputError, match=message):
        call()
