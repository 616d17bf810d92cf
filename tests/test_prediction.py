"""A record continued beyond its ends: tones go on, noise dies away, nothing grows."""

import numpy as np
import pytest
from scipy import signal

from railride.weightings.prediction import KNOWN, continued, predicted


def test_a_few_tones_go_on_as_they_were():
    turning = np.arange(1200)
    record = (
        np.sin(0.11 * turning + 0.3) + 0.4 * np.cos(1.3 * turning) + 0.2 * np.sin(2.2 * turning)
    )
    np.testing.assert_allclose(predicted(record[:1000], 200), record[1000:], atol=1e-3)


def test_noise_of_a_known_recursion_is_predicted_by_it():
    """x_n = 1.6 x_(n−1) − 0.8 x_(n−2) + e_n: the best prediction is the recursion without e."""
    noise = np.random.default_rng(5).standard_normal(20_000)
    record = signal.lfilter([1.0], [1.0, -1.6, 0.8], noise)
    expected = [record[-2], record[-1]]
    for _ in range(40):
        expected.append(1.6 * expected[-1] - 0.8 * expected[-2])
    scale = np.std(record)
    # 64 coefficients, each uncertain by 1/√20000, where two would do
    np.testing.assert_allclose(predicted(record, 40), expected[2:], atol=0.25 * scale)
    assert np.max(np.abs(expected[2:22])) > 0.5 * scale  # or there was nothing to predict


def test_the_continuation_is_led_to_zero():
    record = np.sin(0.1 * np.arange(3000))
    onward = continued(record, 100.0, 1000)
    np.testing.assert_allclose(onward[:100], np.sin(0.1 * np.arange(3000, 3100)), atol=1e-3)
    np.testing.assert_allclose(onward[:500], np.sin(0.1 * np.arange(3000, 3500)), atol=0.03)
    assert abs(onward[-1]) < 1e-4
    assert np.max(np.abs(onward[750:])) <= 0.55


@pytest.mark.parametrize("rate", [2500.0, 10_000.0, 48_000.0])
def test_fast_records_are_predicted_by_means(rate):
    """2 Hz with noise of a tenth of it: 64 samples alone would know nothing of a period."""
    times = np.arange(round(12 * rate)) / rate
    tone = np.sin(2 * np.pi * 2 * times + 0.4)
    noise = 0.1 * np.random.default_rng(6).standard_normal(times.size)
    known = round(11 * rate)
    onward = continued((tone + noise)[:known], rate, 2 * (times.size - known))
    quarter = round(rate / 4)
    error = onward[:quarter] - tone[known : known + quarter]
    assert np.sqrt(np.mean(error**2)) < 0.15


@pytest.mark.parametrize("count", [1, 2, 3, 4, 10])
def test_shortest_records_go_on_at_their_mean_or_near(count):
    onward = continued(np.linspace(-1.0, 1.0, count) if count > 1 else np.ones(1), 100.0, 50)
    assert onward.shape == (50,)
    assert np.all(np.abs(onward) <= 2)
    if count < 3:
        np.testing.assert_array_equal(onward, 0)


def test_what_repeats_itself_exactly_does_not_grow():
    """Five samples a period, rounded: of more than five coefficients the rest would be noise."""
    record = np.round(np.sin(2 * np.pi * np.arange(2000) / 5 + 0.3), 4)
    onward = continued(record, 100.0, 1000)
    np.testing.assert_allclose(onward[:500], record[:500], atol=1e-3)


def test_nothing_and_a_constant():
    np.testing.assert_array_equal(continued(np.zeros(500), 100.0, 20), 0)
    assert np.max(np.abs(continued(np.full(500, 3.0), 100.0, 20))) <= 6.0


def test_only_what_lies_near_the_end_is_known():
    """A standing train before a ride: what is more than 10 s away says nothing of the end."""
    rate = 100.0
    ride = np.sin(0.4 * np.arange(round(KNOWN * rate)))
    standing = np.random.default_rng(7).standard_normal(4000)
    np.testing.assert_array_equal(
        continued(np.concatenate((standing, ride)), rate, 64), continued(ride, rate, 64)
    )
