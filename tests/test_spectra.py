"""Spectra against published check figures, independent integrals and their own identities."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from railride.errors import InputError
from railride.spectra import (
    D1,
    D2,
    band_rms,
    coverage_remark,
    covered_hz,
    spectrum,
    spectrum_names,
    temporal,
)

# R.m.s. in mm over D1 (3-25 m) and D2 (25-70 m), as published with the spectra's definitions and
# printed there to three digits: half a unit of the last one is the tolerance.
RMS_MM = [
    ("erri_low", D1, 0.984, 5e-4),
    ("erri_low", D2, 1.651, 5e-4),
    ("erri_high", D1, 1.611, 5e-4),
    ("erri_high", D2, 2.702, 5e-4),
    ("fra_1", D1, 8.54, 5e-3),
    ("fra_1", D2, 14.5, 5e-2),
    ("fra_4", D1, 5.69, 5e-3),
    ("fra_4", D2, 9.65, 5e-3),
    ("fra_6", D1, 1.43, 5e-3),
    ("fra_6", D2, 2.42, 5e-3),
    ("china_ballastless", D1, 0.286, 5e-4),
    ("china_ballastless", D2, 0.362, 5e-4),
    ("sncf_good", D1, 1.05, 5e-3),
    ("sncf_poor", D1, 1.96, 5e-3),
]


@pytest.mark.parametrize(("name", "band", "rms_mm", "tolerance"), RMS_MM)
def test_band_rms_is_the_published_one(name, band, rms_mm, tolerance):
    assert 1000 * band_rms(spectrum(name), *band) == pytest.approx(rms_mm, abs=1.01 * tolerance)


@pytest.mark.parametrize(
    ("n", "density"), [(0.00318, 8.2268e-3), (0.02, 4.0897e-4), (0.1, 1.0863e-5), (0.2, 1.2931e-6)]
)
def test_erri_high_meets_an_independent_table_over_cycles(n, density):
    """A published table of the high level, m²/(1/m) over n in 1/m; good to 0.1 %."""
    assert 2 * np.pi * spectrum("erri_high").density(2 * np.pi * n) == pytest.approx(
        density, rel=1e-3
    )


@pytest.mark.parametrize("name", ["erri_low", "erri_high"])
def test_whole_mean_square_is_the_closed_form(name):
    """∫₀^∞ Av Oc²/((O²+Or²)(O²+Oc²)) dO = π Av Oc/(2 Or (Or + Oc))."""
    Av = {"erri_low": 4.032e-7, "erri_high": 1.080e-6}[name]
    Or, Oc = 0.0206, 0.8246
    closed = np.pi * Av * Oc / (2 * Or * (Or + Oc))
    # What lies outside wavelengths of 1e-4 m to 1e7 m is below 1e-5 of it.
    assert band_rms(spectrum(name), 1e-4, 1e7) ** 2 == pytest.approx(closed, rel=1e-4)


def test_fra_band_is_the_closed_form():
    """∫ k Av Oc²/(O²(O²+Oc²)) dO = k Av [−1/O − atan(O/Oc)/Oc], Av in cm² rad/m."""
    k, Av, Oc = 0.25, 0.5376e-4, 0.8245

    def primitive(O):  # noqa: E741
        return k * Av * (-1 / O - np.arctan(O / Oc) / Oc)

    square = primitive(2 * np.pi / 3) - primitive(2 * np.pi / 25)
    assert band_rms(spectrum("fra_4"), *D1) ** 2 == pytest.approx(square, rel=1e-9)


@pytest.mark.parametrize("name", ["sncf_good", "china_ballastless"])
def test_zero_outside_its_band_unless_extrapolated(name):
    shipped = spectrum(name)
    short, long = shipped.band
    edges = 2 * np.pi / np.array([short, long])
    outside = edges * [1.001, 0.999]
    assert np.all(shipped.density(edges) > 0.0)
    assert np.all(shipped.density(outside) == 0.0)
    further = shipped.extrapolated()
    # The formula goes on smoothly and is untouched inside.
    assert further.density(outside) == pytest.approx(shipped.density(edges), rel=5e-3)
    inside = 2 * np.pi / np.linspace(short, long, 50)
    assert np.array_equal(further.density(inside), shipped.density(inside))
    assert shipped.active_band == (short, long)
    assert further.active_band is None
    assert band_rms(shipped, long * 1.01, long * 2) == 0.0
    assert band_rms(further, long * 1.01, long * 2) > 0.0


def test_covers_says_whether_a_band_lies_inside():
    assert spectrum("erri_low").covers(*D2)
    assert not spectrum("sncf_good").covers(*D2)
    assert spectrum("sncf_good").extrapolated().covers(*D2)
    assert spectrum("sncf_good").covers(2.0, 40.0)


def test_china_pieces_join_within_half_a_percent():
    china = spectrum("china_ballastless")
    breaks = np.array(china.breakpoints)
    below, above = china.density(breaks * (1 - 1e-12)), china.density(breaks * (1 + 1e-12))
    assert breaks / (2 * np.pi) == pytest.approx([0.0187, 0.0474, 0.1533])
    assert below == pytest.approx(above, rel=5e-3)


@pytest.mark.parametrize("name", spectrum_names())
def test_temporal_spectrum_holds_the_same_mean_square(name):
    """∫ S(f) df over V/λ equals ∫ S(Omega) dOmega over the wavelengths."""
    shipped, speed = spectrum(name), 40.0
    f = np.geomspace(speed / 25.0, speed / 3.0, 20001)
    square = np.trapezoid(temporal(shipped, speed)(f), f)
    assert square == pytest.approx(band_rms(shipped, *D1) ** 2, rel=1e-3)


def test_two_sided_doubles():
    one = spectrum("erri_low")
    two = replace(one, sidedness="two-sided")
    assert two.density(1.0) == pytest.approx(2 * one.density(1.0), rel=1e-15)


def test_fra_is_infinite_at_zero_without_a_warning():
    assert spectrum("fra_1").density(0.0) == np.inf


def test_poles_lie_where_the_reciprocal_vanishes():
    for name in spectrum_names():
        shipped = spectrum(name)
        argument = 1.0 if "rad" in shipped.unit else 1 / (2 * np.pi)
        for pole in shipped.poles:
            beside = np.array([pole + 1e-7])
            assert abs(1 / shipped.formula(beside * argument)[0]) < 1e-5 * abs(
                1 / shipped.formula(np.array([1.0 * argument]))[0]
            )


def test_unknown_name_lists_the_nearest_first():
    with pytest.raises(InputError, match=r"'eri_high'; expected one of erri_high, .*erri_low"):
        spectrum("eri_high")
    with pytest.raises(InputError, match="china_ballastless"):
        spectrum("")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"unit": "m^2/Hz"}, "unit"),
        ({"sidedness": "both"}, "sidedness"),
        ({"band": (40.0, 2.0)}, "band"),
        ({"band": (0.0, np.inf)}, "band"),
        ({"poles": (0.5j,)}, "not a pole"),
        ({"formula": lambda x: 1.0 - x}, "negative"),
        ({"formula": lambda x: x * np.nan}, "not finite"),
    ],
)
def test_a_wrong_definition_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        replace(spectrum("erri_low"), **change)


@pytest.mark.parametrize("wavenumber", [-1.0, np.nan, np.inf, [1.0, -1e-9]])
def test_wavenumbers_that_are_none_are_refused(wavenumber):
    with pytest.raises(InputError, match="wavenumber"):
        spectrum("erri_low").density(wavenumber)


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan, np.inf])
def test_speeds_that_are_none_are_refused(speed):
    with pytest.raises(InputError, match="speed"):
        temporal(spectrum("erri_low"), speed)
    with pytest.raises(InputError, match="speed"):
        covered_hz(D1, speed)


@pytest.mark.parametrize("band", [(25.0, 3.0), (0.0, 3.0), (3.0, 3.0), (np.nan, 3.0)])
def test_bands_that_are_none_are_refused(band):
    with pytest.raises(InputError, match="wavelength band"):
        band_rms(spectrum("erri_low"), *band)


def test_d1_at_145_km_h_covers_1_6_to_13_4_hz():
    assert covered_hz(D1, 145 / 3.6) == pytest.approx((1.611, 13.43), rel=1e-3)
    assert "145 km/h 1.61 to 13.4 Hz" in coverage_remark("line 4", D1, 145 / 3.6)
    assert coverage_remark("erri_low", None, 40.0) is None
    assert coverage_remark("line 4", D1) is None


def test_coverage_over_a_range_of_speeds_is_said_once():
    """D1 is 3 to 25 m: at 90 km/h, 25 m/s, 1 to 8.33 Hz; at 270 km/h three times as high."""
    said = coverage_remark("line 4", D1, 50.0, 25.0, 75.0)
    assert said.endswith(": at 90 km/h 1 to 8.33 Hz, rising to 3 to 25 Hz at 270 km/h; "
                         "nothing outside")  # fmt: skip
    assert coverage_remark("line 4", D1, 25.0, 25.0) == coverage_remark("line 4", D1, 25.0)


@pytest.mark.parametrize("name", spectrum_names())
def test_a_spectrum_goes_to_another_process(name):
    sent = pickle.loads(pickle.dumps(spectrum(name).extrapolated()))  # noqa: S301
    Omega = 2 * np.pi / np.geomspace(0.5, 200.0, 30)
    np.testing.assert_array_equal(sent.density(Omega), spectrum(name).extrapolated().density(Omega))
