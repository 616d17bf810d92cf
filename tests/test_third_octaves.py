"""Third octaves of a record against the standard's figures and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from railride.comfort.third_octaves import (
    NUMBERS,
    band_edges,
    nominal_frequencies,
    third_octave_rms,
)

# IEC 61260-1:2014, Annex E, Table E.1: exact base-ten midband frequencies, Hz, to five figures.
MIDBAND = {25: 25.119, 31.5: 31.623, 40: 39.811, 50: 50.119, 63: 63.096, 80: 79.433}


def test_nominal_and_midband_frequencies():
    nominal, edges = nominal_frequencies(), band_edges()
    for name, middle in MIDBAND.items():
        k = nominal.index(name)
        assert round(float(np.sqrt(edges[k] * edges[k + 1])), 3) == middle
    assert len(nominal) == len(NUMBERS) == 30


@pytest.mark.parametrize("rate", [200.0, 1000.0])
@pytest.mark.parametrize("band", [0.5, 1.0, 8.0, 63.0])
def test_a_tone_lies_in_its_band_alone(rate, band):
    k = nominal_frequencies().index(band)
    middle = 10 ** (NUMBERS[k] / 10)
    duration = round(50 * middle) / middle  # whole periods
    t = np.arange(round(duration * rate)) / rate
    levels = third_octave_rms([3.0 * np.sin(2 * np.pi * middle * t)], rate)
    assert levels[k] == pytest.approx(3.0 / np.sqrt(2), rel=2e-2 if band < 1 else 2e-3)
    others = np.delete(levels, k)
    assert np.nanmax(others) < 0.12 * levels[k]  # what leaks: the tone does not fit the record


def test_bands_add_up_to_the_mean_square_of_noise():
    noise = np.random.default_rng(3).standard_normal(200 * 120)
    levels = third_octave_rms([noise], 200.0)
    low, high = band_edges()[[0, -1]]
    inside = np.abs(np.fft.rfftfreq(noise.size, 1 / 200.0) - (low + high) / 2) < (high - low) / 2
    power = 2 * np.abs(np.fft.rfft(noise) / noise.size) ** 2
    assert np.nansum(levels**2) == pytest.approx(power[inside].sum(), rel=1e-3)
    # White: band by band the share of its width, to the scatter of its lines.
    k = nominal_frequencies().index(50.0)
    width = np.diff(band_edges())[k]
    assert levels[k] ** 2 == pytest.approx(width / 100, rel=4 / np.sqrt(width * 120))


def test_stretches_count_by_their_lengths():
    rng = np.random.default_rng(4)
    one, other = rng.standard_normal(6000), 2 * rng.standard_normal(2000)
    both = third_octave_rms([one, other], 200.0)
    apart = [third_octave_rms([one], 200.0), third_octave_rms([other], 200.0)]
    known = ~np.isnan(apart[1])
    expected = (6000 * apart[0] ** 2 + 2000 * apart[1] ** 2) / 8000
    np.testing.assert_allclose(both[known] ** 2, expected[known], rtol=1e-12)


def test_what_a_record_cannot_tell_is_not_a_number():
    levels = dict(zip(nominal_frequencies(), third_octave_rms([np.ones(512)], 51.2), strict=True))
    assert np.isnan(levels[25.0])  # its upper edge is above fs/2
    assert np.isnan(levels[0.1])  # ten seconds do not resolve it
    assert levels[20.0] == levels[1.0] == 0.0  # the mean is taken out
