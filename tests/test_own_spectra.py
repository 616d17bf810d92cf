"""A user's own spectrum from a table or a file, and which spectrum fits a track best."""

from __future__ import annotations

import h5py
import numpy as np
import pytest
from numpy.testing import assert_allclose

from railride.errors import InputError
from railride.spectra import (
    D1,
    D2,
    band_rms,
    fit_spectra,
    read_spectrum,
    spectrum,
    spectrum_from_table,
    spectrum_names,
)
from railride.stochastic import measured_spectrum, spectrum_fits
from railride.track import Track, synthesise

ABSCISSAE = {"rad/m": lambda Om: Om, "1/m": lambda Om: Om / (2 * np.pi),
             "cycle/m": lambda Om: Om / (2 * np.pi), "m": lambda Om: 2 * np.pi / Om,
             "km": lambda Om: 2e-3 * np.pi / Om}  # fmt: skip
DENSITIES = {"m^2/(rad/m)": 1.0, "cm^2/(rad/m)": 1e4, "m^2/(1/m)": 2 * np.pi,
             "mm^2/(1/m)": 2e6 * np.pi, "mm^2/(cycle/m)": 2e6 * np.pi,
             "mm^2 m/rad": 1e6}  # fmt: skip


def sampled(name, count=400):
    """Wavenumbers (rad/m) and densities of a shipped spectrum over its band, or 1 to 200 m."""
    shipped = spectrum(name)
    low, high = shipped.band or (1.0, 200.0)
    Omega = 2 * np.pi / np.geomspace(low, high, count)
    breaks = np.array(shipped.breakpoints)
    Omega = np.unique(np.concatenate([Omega, breaks * (1 - 1e-12), breaks]))
    return Omega, shipped.density(Omega)


@pytest.mark.parametrize("name", spectrum_names())
def test_a_shipped_spectrum_sampled_into_a_table_gives_its_figures(name):
    """Linear between logarithms: wrong by (Δ ln Omega)²/8 of the curvature, 1e-5 here."""
    own = spectrum_from_table(*sampled(name), sidedness="one-sided")
    for band in (D1, D2):
        assert band_rms(own, *band) == pytest.approx(band_rms(spectrum(name), *band), rel=2e-5)
    assert own.remarks == ()
    assert own.band == pytest.approx(spectrum(name).band or (1.0, 200.0), rel=1e-12)


def test_the_published_figures_come_back_from_a_table():
    own = spectrum_from_table(*sampled("erri_high"))
    assert 1000 * band_rms(own, *D1) == pytest.approx(1.611, abs=5e-4)
    assert 1000 * band_rms(own, *D2) == pytest.approx(2.702, abs=5e-4)


@pytest.mark.parametrize("density_unit", DENSITIES)
@pytest.mark.parametrize("abscissa_unit", ABSCISSAE)
def test_units_of_both_columns_are_converted_each_by_itself(abscissa_unit, density_unit):
    Omega, S = sampled("erri_low", 50)
    own = spectrum_from_table(
        ABSCISSAE[abscissa_unit](Omega), DENSITIES[density_unit] * S,
        abscissa_unit=abscissa_unit, density_unit=density_unit, sidedness="one-sided",
    )  # fmt: skip
    # 1e-10: each point is where it was but for rounding, where S falls as 1/Omega⁴.
    assert_allclose(own.density(Omega[1:-1]), S[1:-1], rtol=1e-10)


def test_a_power_law_is_exact_between_points_and_beyond():
    Omega = np.array([0.05, 0.31, 2.0])
    own = spectrum_from_table(Omega, 1e-6 * Omega**-3.5, sidedness="one-sided")
    between = np.geomspace(0.05, 2.0, 33)[1:-1]
    assert_allclose(own.density(between), 1e-6 * between**-3.5, rtol=1e-12)
    low, high = 0.05**-2.5, 2.0**-2.5
    assert band_rms(own, 1.0, 1000.0) ** 2 == pytest.approx(1e-6 * (low - high) / 2.5, rel=1e-12)
    outside = np.array([0.01, 0.0499, 2.001, 60.0])
    assert np.all(own.density(outside) == 0.0)
    assert_allclose(own.extrapolated().density(outside), 1e-6 * outside**-3.5, rtol=1e-12)
    assert own.extrapolated().density(0.0) > 1e250


def test_scatter_at_the_ends_does_not_decide_what_is_beyond():
    rng = np.random.default_rng(1)
    Omega = np.geomspace(0.1, 2.0, 400)
    own = spectrum_from_table(Omega, 1e-6 * Omega**-3 * rng.exponential(size=400))
    beyond = own.extrapolated().density(8.0) / own.density(2.0)
    assert np.log(beyond) / np.log(4.0) == pytest.approx(-3.0, abs=1.0)


def test_two_sided_is_doubled_and_what_is_not_stated_remarked():
    Omega, S = sampled("erri_low", 20)
    one, two, none = (
        spectrum_from_table(Omega, S, sidedness=said) for said in ("one-sided", "two-sided", None)
    )
    assert_allclose(two.density(Omega), 2 * one.density(Omega), rtol=1e-15)
    assert_allclose(none.density(Omega), one.density(Omega), rtol=0)
    assert (one.remarks, two.remarks) == ((), ())
    assert "taken to be one-sided" in none.remarks[0]
    assert any("one-sided" in said for said in synthesise(none, 500.0, 0.25, 1).remarks)
    with pytest.raises(InputError, match="sidedness"):
        spectrum_from_table(Omega, S, sidedness="both")


def test_slips_of_the_unit_are_remarked():
    Omega, S = sampled("erri_low", 50)
    assert "slope" in spectrum_from_table(Omega, 1e6 * S, sidedness="one-sided").remarks[0]
    assert "only" in spectrum_from_table(Omega, 1e-6 * S, sidedness="one-sided").remarks[0]


@pytest.mark.parametrize(
    ("abscissa", "density", "units", "message"),
    [
        ([1.0, 2.0, 3.0], [1.0, 0.0, 1.0], {}, "point 2, density: found 0; expected a finite"),
        ([1.0, np.nan, 3.0], [1.0, 1.0, -1.0], {}, "point 2, abscissa(.|\n)*point 3, density"),
        ([1.0, 3.0, 2.0], [1.0, 1.0, 1.0], {}, "point 3, abscissa: found 2 after 3; expected a"),
        ([3.0, 3.0, 2.0], [1.0, 1.0, 1.0], {}, "point 2, abscissa: found 3 after 3"),
        ([1.0, 2e300], [1.0, 1.0], {}, "point 2, abscissa: found 2e.300 rad/m; expected 1e-09 to"),
        ([1.0, 2.0], [1e290, 1e-99], {}, "point 1, density: found 1e.290 m.*\n.*point 2, density"),
        ([1.0], [1.0], {}, "at least 2"),
        ([1.0, 2.0], [1.0], {}, "shapes"),
        ([[1.0, 2.0]], [[1.0, 2.0]], {}, "shapes"),
        ([1.0, 2.0], [1.0, 1.0], {"abscissa_unit": "Hz"}, "'Hz'; expected one of rad/m"),
        ([1.0, 2.0], [1.0, 1.0], {"density_unit": "m^2/Hz"}, "'m.2/Hz'; expected one of"),
        ([1.0, 2.0], [1.0, 1.0], {"density_unit": "m^3"}, "a factor 2π"),
    ],
)
def test_tables_that_are_none_are_refused(abscissa, density, units, message):
    with pytest.raises(InputError, match=message):
        spectrum_from_table(abscissa, density, **units)


def test_wavenumber_zero_is_left_out_with_a_remark():
    Omega, S = sampled("erri_low", 20)
    own = spectrum_from_table(np.r_[0.0, Omega], np.r_[0.5, S], sidedness="one-sided")
    assert_allclose(own.density(Omega), S, rtol=1e-12)
    assert "point 1, abscissa: wavenumber 0" in own.remarks[0]
    with pytest.raises(InputError, match="point 3, density"):
        spectrum_from_table(np.r_[0.0, Omega], np.r_[0.5, S[0], 0.0, S[2:]])


# files


def text(head, rows):
    return head + "\n" + "".join(f"{a!r},{b!r}\n" for a, b in rows)


def rows():
    Omega, S = sampled("erri_low", 30)
    return zip(Omega.tolist(), S.tolist(), strict=True)


@pytest.mark.parametrize(
    ("head", "two"),
    [
        ("wavenumber [rad/m],density [m^2/(rad/m)]", None),
        ("Omega [rad/m],one-sided PSD [m^2/(rad/m)]", 1.0),
        ("Ω [rad/m],S(Ω) two-sided [m²/(rad/m)]", 2.0),
        ("angular wavenumber [rad/m],double_sided_spectral_density [m^3/rad]", 2.0),
    ],
)
def test_a_spectrum_is_read_from_a_file(tmp_path, head, two):
    (tmp_path / "own.csv").write_text(text(head, rows()), encoding="utf-8")
    own = spectrum(tmp_path / "own.csv")
    Omega, S = sampled("erri_low", 30)
    assert_allclose(own.density(Omega), (two or 1.0) * S, rtol=1e-12)
    assert own.name == "own.csv"
    assert any("not stated" in said for said in own.remarks) == (two is None)
    assert_allclose(
        read_spectrum(tmp_path / "own.csv", sidedness="two-sided").density(Omega), 2 * S
    )


def test_a_spectrum_by_the_name_of_its_file_is_one_everywhere(tmp_path):
    (tmp_path / "own.csv").write_text(text("wavenumber [rad/m],density [m^2/(rad/m)]", rows()))
    track = synthesise(tmp_path / "own.csv", 2000.0, 0.25, 1)
    assert track.name == "own.csv"
    assert track.band == pytest.approx((1.0, 200.0))
    # The same normal numbers, and the spectrum but for what 30 points do not hold of it.
    shipped = synthesise("erri_low", 2000.0, 0.25, 1)
    assert track.band_rms(*D1) == pytest.approx(shipped.band_rms(*D1), rel=2e-3)


def test_binary_files_hold_spectra_too(tmp_path):
    Omega, S = sampled("sncf_poor", 30)
    with h5py.File(tmp_path / "own.h5", "w") as file:
        file["wavelength [m]"], file["density [mm^2/(1/m)]"] = 2 * np.pi / Omega, 2e6 * np.pi * S
    assert_allclose(spectrum(str(tmp_path / "own.h5")).density(Omega), S, rtol=1e-12)


@pytest.mark.parametrize(
    ("head", "message"),
    [
        ("wavenumber,density [m^2/(rad/m)]", "column 'wavenumber': found no unit"),
        ("wavenumber [rad/m],density", "column 'density': found no unit.*in square brackets"),
        ("wavenumber [rad/m],level_mm", "no columns of a density among 'wavenumber .rad/m.'"),
        ("wavenumber [rad/m],wavelength [m]", "2 columns of a wavenumber or wavelength"),
        ("wavenumber [rad/m],density [m^3]", "a factor 2π"),
    ],
)
def test_files_that_hold_no_spectrum(tmp_path, head, message):
    (tmp_path / "own.csv").write_text(text(head, rows()))
    with pytest.raises(InputError, match=message):
        read_spectrum(tmp_path / "own.csv")


def test_faults_of_a_file_are_named_by_row_and_column(tmp_path):
    lines = text("wavenumber [rad/m],density [m^2/(rad/m)]", rows()).split("\n")
    lines[4] = "0.05,abc"
    lines[6] = "x,1e-5"
    lines[7], lines[8] = "0.5,-1e-5", "0.6,0"
    (tmp_path / "own.csv").write_text("\n".join(lines))
    with pytest.raises(InputError) as caught:
        read_spectrum(tmp_path / "own.csv")
    assert "row 5, column 'density [m^2/(rad/m)]': found 'abc'" in str(caught.value)
    assert "row 7, column 'wavenumber [rad/m]': found 'x'" in str(caught.value)
    assert "row 8, column 'density [m^2/(rad/m)]': found -1e-05" in str(caught.value)
    assert "row 9, column 'density [m^2/(rad/m)]': found 0" in str(caught.value)
    assert len(str(caught.value).split("\n")) == 4
    lines = text("wavenumber [rad/m],density [m^2/(rad/m)]", rows()).split("\n")
    lines[4], lines[6] = "0.05,1e-3", lines[3]
    (tmp_path / "own.csv").write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"row 7, column 'wavenumber \[rad/m\]': found .* after"):
        read_spectrum(tmp_path / "own.csv")
    with pytest.raises(InputError, match="no such file"):
        spectrum("none.csv")


# fits


@pytest.mark.parametrize("name", spectrum_names())
@pytest.mark.parametrize("seed", [1, 2])
def test_the_spectrum_that_a_track_was_made_of_fits_it_best(name, seed):
    """20 km: 20 segments or so, so that a third octave scatters by about 10 %, 0.4 dB."""
    fits = fit_spectra(measured_spectrum(synthesise(name, 20_000.0, 0.25, seed)))
    assert fits[0].spectrum.name == name
    assert fits[0].misfit_db < 0.8
    assert fits[0].level_ratio == pytest.approx(1.0, abs=0.04)
    assert [fit.misfit_db for fit in fits] == sorted(fit.misfit_db for fit in fits)


def test_misfit_and_level_ratio_are_what_they_are_defined_to_be():
    """Twice the level is 6.02 dB everywhere; half the dB are over and half under."""
    Omega, S = sampled("erri_low", 2000)
    twice = spectrum_from_table(Omega, 4 * S)
    (fit,) = fit_spectra(twice, ["erri_low"])
    assert fit.level_ratio == pytest.approx(2.0, rel=1e-6)
    assert fit.misfit_db == pytest.approx(20 * np.log10(2.0), rel=1e-6)
    assert fit.wavelengths == pytest.approx((10**0.05, 10**2.25))
    assert fit.bands == 22
    middle = 2 * np.pi / 10**1.15  # eleven third octaves on either side
    tilted = spectrum_from_table(Omega, np.where(Omega > middle, 4 * S, S / 4))
    (fit,) = fit_spectra(tilted, ["erri_low"])
    assert fit.level_ratio == pytest.approx(1.0, abs=0.01)
    assert fit.misfit_db == pytest.approx(20 * np.log10(2.0), rel=0.01)


def test_only_what_both_hold_is_compared():
    fits = {fit.spectrum.name: fit for fit in fit_spectra(spectrum("sncf_good"))}
    assert fits["china_ballastless"].wavelengths == pytest.approx((10**0.35, 10**1.55))
    narrow = spectrum_from_table([0.05, 0.1], [1e-4, 1e-5])  # 63 to 126 m
    assert "sncf_good" not in {fit.spectrum.name for fit in fit_spectra(narrow)}
    assert fit_spectra(spectrum("erri_low"), ["erri_low"])[0].misfit_db == 0.0


def test_the_table_of_fits():
    track = synthesise("fra_5", 3000.0, 0.25, 1)
    table = spectrum_fits(track)
    assert table["spectrum"][0] == "fra_5"
    assert len(table) == len(spectrum_names())
    assert table["misfit [dB]"].is_monotonic_increasing
    assert len(spectrum_fits(track, ["erri_low"])) == 1
    with pytest.raises(InputError):
        spectrum_fits(Track(0.0, 1.0, np.zeros(9)))
