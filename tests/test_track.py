"""Synthetic tracks against their spectrum, splines against closed forms, figures against both."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import make_interp_spline
from scipy.signal import periodogram

from railride.errors import InputError
from railride.spectra import D1, D2, band_rms, spectrum, spectrum_names
from railride.track import Track, recommended_step, resolved_band_hz, synthesise

# synthesise(spectrum("erri_low"), 100.0, 0.25, 1).level[::80], m. Made again by:
# python -c "from railride.spectra import spectrum as s; from railride.track import synthesise as t;
# print(t(s('erri_low'), 100.0, 0.25, 1).level[::80].tolist())"
GOLDEN = [
    0.0058449385605384395,
    0.0024795690014396063,
    -0.0017363597617862864,
    -0.005547285934732266,
    0.0009300271940596486,
    0.005602816436022599,
]

# Of every spectrum, synthesise(name, 100.0, 0.25, 1).level[[7, 200, 393]]; the FRA's differ by a
# factor alone, √(Av/Av of class 6).
GOLDEN_OF = {
    "erri_low": [0.007603699042316668, -0.0028986124827124586, 0.003043843627870927],
    "erri_high": [0.012444473722528344, -0.004743968254419185, 0.004981658510116969],
    "fra_1": [0.06779987264113119, -0.026962745977838386, 0.027958375244229772],
    "fra_2": [0.062173572913942016, -0.02472527141586773, 0.025638279455232185],
    "fra_3": [0.0508716000678233, -0.020230687414046766, 0.020977727959738825],
    "fra_4": [0.04517937689090657, -0.017966996324526023, 0.018630447568866913],
    "fra_5": [0.02820347491586442, -0.011215996435183007, 0.011630159529394118],
    "fra_6": [0.011345155581855875, -0.004511756971163708, 0.004678358595754475],
    "sncf_good": [0.0034171209022329494, 0.0018213021373636696, 0.00015527087662738822],
    "sncf_poor": [0.006408080654483849, 0.0034154632880515476, 0.0002911773768585517],
    "china_ballastless": [0.0021892694040299434, -0.0009552911434972665, 0.0010718709260463524],
}


def sine(wavelength=8.0, step=1.0, length=400.0, amplitude=0.003):
    x = np.arange(round(length / step) + 1) * step
    return Track(0.0, step, amplitude * np.sin(2 * np.pi * x / wavelength + 0.3))


def periodograms(name, length, step, seeds):
    """Plain periodograms over Omega, one row per seed, by scipy."""
    levels = np.array([synthesise(spectrum(name), length, step, seed).level for seed in seeds])
    return periodogram(levels, fs=2 * np.pi / step, detrend=False)


@pytest.mark.parametrize(("name", "length"), [("erri_low", 400.0), ("sncf_poor", 399.5)])
def test_periodogram_averaged_over_seeds_is_the_spectrum(name, length):
    """200 seeds × 10 lines: a band average scatters by 2.2 %. Odd and even numbers of samples."""
    wavenumber, density = periodograms(name, length, 0.5, range(200))
    expected = spectrum(name).density(wavenumber)
    expected[0] = 0.0  # the mean of a track is zero
    ratio = density.mean(axis=0)[expected > 0] / expected[expected > 0]
    ratio = ratio[: ratio.size // 10 * 10].reshape(-1, 10).mean(axis=1)
    assert ratio.size >= 9
    # Four standard deviations for each ten lines, and far below 5 % over the band as a whole.
    assert np.all(np.abs(ratio - 1) < 4 * 0.0224)
    assert abs(ratio.mean() - 1) < 0.01
    assert np.all(density[:, expected == 0] < 1e-25)


@pytest.mark.parametrize("name", spectrum_names())
def test_every_shipped_spectrum_comes_back_from_its_tracks(name):
    """1000 seeds × 10 lines scatter by 1 %: within 5 % over the whole band that they resolve."""
    wavenumber, density = periodograms(name, 200.0, 0.5, range(1000))
    expected = spectrum(name).density(wavenumber[1:])
    inside = np.flatnonzero(expected)[: np.count_nonzero(expected) // 10 * 10]
    ratio = density.mean(axis=0)[1:][inside] / expected[inside]
    assert inside.size >= 90
    assert np.all(np.abs(ratio.reshape(-1, 10).mean(axis=1) - 1) < 0.05)


def test_fourier_coefficients_are_gaussian():
    """A periodogram line is exponential: variance = mean². Fixed amplitudes would give zero."""
    wavenumber, density = periodograms("erri_low", 400.0, 0.5, range(200))
    lines = density[:, 1:401] / spectrum("erri_low").density(wavenumber[1:401])
    assert np.var(lines) == pytest.approx(1.0, abs=0.05)
    assert np.mean(lines > np.log(2)) == pytest.approx(0.5, abs=0.01)  # the median


def test_phases_are_uniform_and_lines_independent():
    levels = np.array(
        [synthesise(spectrum("erri_low"), 50.0, 0.5, seed).level for seed in range(400)]
    )
    lines = np.fft.rfft(levels)[:, 1:51]
    lines /= np.sqrt(np.mean(np.abs(lines) ** 2, axis=0))
    correlation = np.abs(lines.conj().T @ lines) / 400
    assert np.max(correlation - np.eye(50) * correlation) < 5 / np.sqrt(400)
    assert np.max(np.abs(np.mean(lines**2, axis=0))) < 5 / np.sqrt(400)


def test_mean_square_is_the_sum_over_the_lines():
    n, step = 801, 0.5
    Omega = 2 * np.pi / (n * step) * np.arange(1, n // 2 + 1)
    expected = np.sum(spectrum("erri_low").density(Omega)) * Omega[0]
    squares = [
        np.mean(synthesise(spectrum("erri_low"), 400.0, step, s).level ** 2) for s in range(2000)
    ]
    # One track's scatter is about 60 %: most of it is one line, the longest wavelength.
    assert np.mean(squares) == pytest.approx(expected, rel=4 * np.std(squares) / expected / 44.7)


def test_the_same_seed_gives_the_golden_track_to_1e_12():
    track = synthesise(spectrum("erri_low"), 100.0, 0.25, 1)
    assert_allclose(track.level[::80], GOLDEN, rtol=0, atol=1e-12)
    assert np.random.RandomState(1).standard_normal() == 1.6243453636632417  # as numpy has it
    assert np.array_equal(track.level, synthesise(spectrum("erri_low"), 100.0, 0.25, 1).level)


@pytest.mark.parametrize("name", spectrum_names())
def test_every_spectrum_gives_the_same_track_everywhere(name):
    level = synthesise(name, 100.0, 0.25, 1).level
    assert_allclose(level[[7, 200, 393]], GOLDEN_OF[name], rtol=0, atol=1e-12)


def test_it_is_the_written_sum_of_waves():
    """The samples by the formula's sum, term by term, for both parities of n."""
    for length in (10.0, 10.5):
        track = synthesise(spectrum("fra_3"), length, 0.5, 7)
        n = track.level.size
        dOmega = 2 * np.pi / (n * 0.5)
        Omega = dOmega * np.arange(1, n // 2 + 1)
        a, b = np.random.RandomState(7).standard_normal((n // 2, 2)).T
        size = np.sqrt(spectrum("fra_3").density(Omega) * dOmega)
        phase = np.outer(track.distance, Omega)
        total = np.cos(phase) @ (size * a) - np.sin(phase) @ (size * b)
        assert_allclose(track.level, total, rtol=0, atol=1e-14)


def test_other_seeds_lengths_and_spectra_give_other_tracks():
    erri = spectrum("erri_low")
    base = synthesise(erri, 100.0, 0.5, 1).level
    for other in (
        synthesise(erri, 100.0, 0.5, 2),
        synthesise(spectrum("fra_5"), 100.0, 0.5, 1),
        synthesise(erri, 101.0, 0.5, 1),
    ):
        assert not np.allclose(other.level[:200], base[:200], atol=1e-5)


def test_it_does_not_repeat_within_its_length():
    """No lag up to half the length brings the short waves back to themselves."""
    level = np.diff(synthesise(spectrum("erri_low"), 1000.0, 0.25, 3).level, 2)
    n = level.size
    spread = np.abs(np.fft.rfft(level, 2 * n)) ** 2
    correlation = np.fft.irfft(spread)[: n // 2] / np.arange(n, n - n // 2, -1)
    assert np.max(np.abs(correlation[200:])) < 0.15 * correlation[0]


@pytest.mark.parametrize(
    ("length", "step", "points"), [(1000.0, 0.05, 20001), (1000.0, 0.3, 3335), (0.9, 0.3, 4)]
)
def test_it_covers_its_length(length, step, points):
    track = synthesise(spectrum("erri_low"), length, step, 1)
    assert track.level.size == points
    assert track.distance0 == 0.0
    assert length - 1e-9 <= track.length < length + step


def test_a_spectrum_with_a_band_gives_a_track_with_it():
    china = spectrum("china_ballastless")
    assert synthesise(china, 500.0, 0.5, 1).band == (2.0, 200.0)
    assert synthesise(china.extrapolated(), 500.0, 0.5, 1).band is None
    assert "extrapolated" in synthesise(china.extrapolated(), 500.0, 0.5, 1).source
    with pytest.raises(InputError, match="no wavelength"):
        synthesise(spectrum("sncf_good"), 1000.0, 30.0, 1)


@pytest.mark.parametrize("seed", [-1, 2**32, 1.0, "1", None, True, np.nan])
def test_seeds_that_are_none_are_refused(seed):
    with pytest.raises(InputError, match=r"seed: found .* whole number"):
        synthesise(spectrum("erri_low"), 100.0, 0.5, seed)


def test_the_extreme_seeds_and_numpy_whole_numbers_are_accepted():
    for seed in (0, 2**32 - 1, np.int64(5)):
        synthesise(spectrum("erri_low"), 100.0, 0.5, seed)


@pytest.mark.parametrize(
    ("length", "step"),
    [(0.0, 0.5), (-1.0, 0.5), (np.nan, 0.5), (np.inf, 0.5), (100.0, 0.0), (100.0, -0.5),
     (100.0, np.nan), (1.0, 0.5), (1e9, 0.05)],
)  # fmt: skip
def test_lengths_and_steps_that_are_none_are_refused(length, step):
    with pytest.raises(InputError, match=r"length|step"):
        synthesise(spectrum("erri_low"), length, step, 1)


def test_elevation_is_the_spline_and_its_slope_is_exact():
    """A quintic polynomial is its own quintic spline, so level and slope are known exactly."""
    x = np.linspace(20.0, 30.0, 41)
    p = np.polynomial.Polynomial([1e-3, 2e-3, -1e-4, 3e-5, -2e-6, 1e-7], domain=[20, 30])
    track = Track(20.0, 0.25, p(x))
    where = np.random.default_rng(1).uniform(20, 30, (3, 50))
    w, slope = track.elevation(where)
    assert w.shape == slope.shape == (3, 50)
    assert_allclose(w, p(where), rtol=0, atol=1e-13)
    assert_allclose(slope, p.deriv()(where), rtol=0, atol=1e-12)


def test_elevation_passes_through_the_samples():
    track = synthesise(spectrum("erri_low"), 100.0, 0.25, 1)
    assert_allclose(track.elevation(track.distance)[0], track.level, rtol=0, atol=1e-15)
    spline = make_interp_spline(track.distance, track.level, k=5)
    x = np.linspace(0, 100, 999)
    assert_allclose(track.elevation(x)[0], spline(x), rtol=0, atol=1e-12)
    assert_allclose(track.elevation(x)[1], spline(x, nu=1), rtol=0, atol=1e-11)


def test_slope_is_the_derivative_of_the_level():
    track = synthesise(spectrum("erri_high"), 100.0, 0.25, 2)
    x, h = np.linspace(1, 99, 777), 1e-4
    rise = (track.elevation(x + h)[0] - track.elevation(x - h)[0]) / (2 * h)
    assert_allclose(track.elevation(x)[1], rise, rtol=0, atol=1e-8)


def test_level_and_slope_converge_on_a_sine_at_sixth_and_fifth_order():
    x = np.linspace(150, 250, 4001)
    phase, k = 2 * np.pi * x / 8.0 + 0.3, 2 * np.pi / 8.0
    errors = []
    for step in (0.5, 0.25):
        w, slope = sine(step=step).elevation(x)
        errors.append(
            (np.ptp(w - 0.003 * np.sin(phase)), np.ptp(slope - 0.003 * k * np.cos(phase)))
        )
    orders = np.log2(np.array(errors[0]) / errors[1])
    assert_allclose(orders, [6, 5], atol=0.2)


@pytest.mark.parametrize(("samples", "level", "slope"), [(8, 2e-5, 7e-5), (4, 2e-3, 5e-3)])
def test_the_spline_is_as_good_as_the_module_says(samples, level, slope):
    x = np.linspace(150, 250, 4001)
    phase, k = 2 * np.pi * x / 8.0 + 0.3, 2 * np.pi / 8.0
    w, rise = sine(step=8.0 / samples).elevation(x)
    assert np.std(w - 0.003 * np.sin(phase)) < level * 0.003 / np.sqrt(2)
    assert np.std(rise - 0.003 * k * np.cos(phase)) < slope * 0.003 * k / np.sqrt(2)


@pytest.mark.parametrize("distance", [-0.01, 100.01, np.nan, np.inf, -np.inf, [1.0, 101.0]])
def test_distances_off_the_track_are_refused(distance):
    track = synthesise(spectrum("erri_low"), 100.0, 0.5, 1)
    with pytest.raises(InputError, match="expected one on the track, 0 to 100 m"):
        track.elevation(distance)


def test_rounding_at_the_ends_is_forgiven():
    track = synthesise(spectrum("erri_low"), 100.0, 0.1, 1)
    w, _ = track.elevation([-1e-12, 100.0 + 1e-11])
    assert_allclose(w, track.level[[0, -1]], rtol=0, atol=1e-12)


def test_taper_starts_level_and_joins_without_a_kink():
    track = synthesise(spectrum("erri_high"), 300.0, 0.05, 4)
    tapered = track.with_taper()
    assert tapered.distance0 == pytest.approx(-50.0, abs=1e-12)
    assert tapered.end == pytest.approx(track.end)
    assert np.array_equal(tapered.level[1000:], track.level)
    assert "50 m taper" in tapered.remarks[-1]
    at_samples = tapered.elevation(tapered.distance)[0]
    assert_allclose(at_samples, tapered.level, rtol=0, atol=1e-15)
    # Ahead of it: level at the first sample, for any distance.
    w, slope = tapered.elevation([-1e6, -50.0])
    assert_allclose(w, track.level[0], rtol=0, atol=0)
    assert_allclose(slope, 0.0, rtol=0, atol=0)
    # Nowhere, the two ends of the taper included, does the slope jump: by less in 1 mm than the
    # track's own largest curvature allows.
    x = np.arange(-51.0, 2.0, 0.001)
    jumps = np.abs(np.diff(tapered.elevation(x)[1]))
    own = np.abs(np.diff(track.elevation(np.arange(0.0, 300.0, 0.001))[1]))
    assert np.max(jumps) < 1.5 * np.max(own)
    assert np.max(jumps[x[1:] < -49.9]) < 1e-7
    # Nor does anything come of the mirror that the track is not: it stays within twice its range.
    assert np.ptp(tapered.level[:1000]) <= np.ptp(track.level[:1001]) * 1.0001


def test_taper_does_not_care_where_the_level_is_zero():
    track = synthesise(spectrum("erri_low"), 300.0, 0.25, 4)
    raised = Track(0.0, 0.25, track.level + 1.0).with_taper(20.0)
    assert_allclose(raised.level, track.with_taper(20.0).level + 1.0, rtol=0, atol=1e-15)


@pytest.mark.parametrize("length", [0.0, -1.0, np.nan, np.inf, 301.0])
def test_tapers_that_are_none_are_refused(length):
    with pytest.raises(InputError, match="taper"):
        synthesise(spectrum("erri_low"), 300.0, 0.25, 4).with_taper(length)


def test_band_rms_of_many_tracks_is_the_spectrum_s():
    """300 tracks of 1 km: D2 scatters by about 10 %/√300, D1 by less."""
    squares = []
    for seed in range(300):
        track = synthesise(spectrum("erri_low"), 1000.0, 1.0, seed)
        squares.append((track.band_rms(*D1) ** 2, track.band_rms(*D2) ** 2))
    measured = np.sqrt(np.mean(squares, axis=0))
    expected = [band_rms(spectrum("erri_low"), *D1), band_rms(spectrum("erri_low"), *D2)]
    assert_allclose(measured, expected, rtol=0.02)


def test_band_rms_finds_waves_in_their_own_band():
    x = np.arange(0.0, 2000.0, 0.25)
    waves = 0.001 * np.sin(2 * np.pi * x / 10) + 0.002 * np.sin(2 * np.pi * x / 50 + 1)
    track = Track(500.0, 0.25, waves + 0.5 + 1e-5 * x)  # a slope and an offset are no irregularity
    assert track.band_rms(*D1) == pytest.approx(0.001 / np.sqrt(2), rel=2e-3)
    assert track.band_rms(*D2) == pytest.approx(0.002 / np.sqrt(2), rel=3e-3)


def test_bands_add_up_to_the_whole():
    track = synthesise(spectrum("erri_low"), 300.0, 0.5, 4)
    rest = Track(
        0.0,
        0.5,
        track.level - np.polyval(np.polyfit(track.distance, track.level, 1), track.distance),
    )
    bands = [track.band_rms(1.0, 20.0), track.band_rms(20.0, 60.0), track.band_rms(60.0, 300.0)]
    # Waves longer than the record (up to twice it, in a cosine series) are in no band.
    assert np.sum(np.square(bands)) <= rest.rms() ** 2
    waves = sine(wavelength=30.0, step=0.5, length=300.0)
    bands = [waves.band_rms(1.0, 20.0), waves.band_rms(20.0, 60.0), waves.band_rms(60.0, 300.0)]
    assert np.sqrt(np.sum(np.square(bands))) == pytest.approx(waves.rms(), rel=0.02)


def test_bands_that_the_record_cannot_hold_are_refused():
    track = synthesise(spectrum("erri_low"), 50.0, 2.0, 4)
    assert not track.covers(*D1)  # too coarse
    assert not track.covers(*D2)  # too short
    assert track.covers(4.0, 50.0)
    with pytest.raises(InputError, match=r"steps of at most 1\.5 m"):
        track.band_rms(*D1)
    with pytest.raises(InputError, match="at least 70 m"):
        track.band_rms(*D2)
    assert not Track(0.0, 0.5, np.zeros(1000), band=D1).covers(*D2)


def test_rms_is_about_the_mean():
    assert sine(length=1600.0).rms() == pytest.approx(0.003 / np.sqrt(2), rel=1e-3)
    assert Track(0.0, 1.0, np.full(9, 7.0)).rms() == 0.0


def test_psd_is_the_spectrum():
    """Of a long track: one-sided over Omega, its integral the mean square of what it resolves."""
    track = synthesise(spectrum("erri_low"), 100_000.0, 1.0, 1)
    wavenumber, density = track.psd(1000.0)
    assert wavenumber[-1] == pytest.approx(np.pi, rel=2e-3)
    inside = (wavenumber > 2 * np.pi / 100) & (wavenumber < 2 * np.pi / 3)
    ratio = density[inside] / spectrum("erri_low").density(wavenumber[inside])
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.03)
    assert np.all(np.abs(ratio - 1) < 0.5)
    with pytest.raises(InputError, match="segment"):
        track.psd(2.0)
    with pytest.raises(InputError, match="segment"):
        track.psd(1e6)
    assert track.psd()[0].size == 6251


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"level": [0.0, 0.0, 0.0]}, "at least 4"),
        ({"level": np.zeros((2, 4))}, "at least 4"),
        ({"level": [0.0, np.nan, 0.0, 0.0]}, "nan at sample 1"),
        ({"level": [0.0, 0.0, 0.0, np.inf]}, "inf at sample 3"),
        ({"step": 0.0}, "step"),
        ({"step": np.nan}, "step"),
        ({"distance0": np.inf}, "first distance"),
        ({"band": (25.0, 3.0)}, "band"),
    ],
)
def test_a_wrong_track_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        Track(**({"distance0": 0.0, "step": 1.0, "level": np.zeros(9)} | change))


def test_a_track_keeps_its_own_samples():
    level = np.zeros(9)
    track = Track(0.0, 1.0, level)
    level[0] = 1.0
    assert track.level[0] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        track.level[0] = 1.0
    assert Track(0.0, 1.0, np.arange(4.0)).elevation(2.5)[0] == pytest.approx(2.5)


@pytest.mark.parametrize("kmh", [5.0, 60.0, 100.0, 115.2, 145.0, 200.0, 350.0])
def test_recommended_step_has_eight_samples_at_80_hz(kmh):
    step, speed = recommended_step(kmh / 3.6), kmh / 3.6
    assert step <= speed / 80 / 8 * (1 + 1e-12)
    assert step == 0.05 or 2 * step > speed / 80 / 8
    assert np.log2(0.05 / step) == int(np.log2(0.05 / step))


def test_resolved_band_is_limited_by_the_step_the_length_and_the_band():
    track = Track(0.0, 0.25, np.zeros(4001))
    assert resolved_band_hz(track, 40.0) == pytest.approx((0.04, 40.0))
    narrow = Track(0.0, 0.25, np.zeros(4001), band=D1)
    assert resolved_band_hz(narrow, 145 / 3.6) == pytest.approx((1.611, 13.43), rel=1e-3)
    for speed in (0.0, np.nan):
        with pytest.raises(InputError, match="speed"):
            resolved_band_hz(track, speed)
        with pytest.raises(InputError, match="speed"):
            recommended_step(speed)
