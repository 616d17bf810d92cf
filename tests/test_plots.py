"""Plots: what is drawn is what was computed, and nothing else is touched."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from functools import cache

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image, ImageSequence

from railride import plots
from railride.errors import InputError
from railride.loci import mode_locus
from railride.modal import Mode, modes
from railride.parameters import Equipment, load_vehicle
from railride.plots import (
    plot_acceleration,
    plot_modes,
    plot_ride,
    plot_track,
    plot_track_overview,
    plot_track_spectrum,
    save,
    save_ride_plots,
)
from railride.plots.canvas import outline
from railride.plots.modes import mode_shape
from railride.plots.rides import track_of, zoom_around_peak
from railride.rides import Case, Record, RideResult
from railride.spectra import fit_spectra, spectrum, spectrum_names
from railride.stochastic import measured_spectrum
from railride.track import Track, synthesise
from railride.vehicle import derive_vehicle


@cache
def coach(segments):
    return derive_vehicle(load_vehicle("cati2024"), segments=segments)


def case(speed=40.0, position=0.0, seconds=5.0, **changes):
    """A record at 100 Hz with 2 s of run-in, whose weighted value is largest at 3.00 s."""
    time = np.arange(-200, round(100 * seconds) + 1) / 100
    weighted = 0.1 * np.sin(20 * time)
    weighted[np.flatnonzero(np.abs(time - 3) < 1e-9)] = -0.9
    level, rated = 0.001 * np.cos(time), slice(200, time.size)
    record = Record(time, 40.0 * time, level, 2 * weighted, weighted, rated)
    values = {"a_wrms_exact": 0.2345, "standard_error": 0.0123, "record": record}
    return Case(speed, position, "segments", 4, 0.3456, 0.2222, **{**values, **changes})


def result(*cases, body="4 segments"):
    return RideResult("cati2024", "erri_low", "smooth", "Wk", cases, body=body)


def texts(ax):
    legend = ax.get_legend()
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def line(ax, label):
    return next(drawn for drawn in ax.lines if label in drawn.get_label())


def test_track_is_drawn_in_millimetres_over_metres():
    track = Track(120.0, 0.5, 0.001 * np.arange(6.0) ** 2, name="line 7")
    ax = plot_track(track)
    (level,) = ax.lines
    assert_array_equal(level.get_xdata(), [120.0, 120.5, 121.0, 121.5, 122.0, 122.5])
    assert_allclose(level.get_ydata(), [0, 1, 4, 9, 16, 25], rtol=1e-12)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("distance [m]", "longitudinal level [mm]")
    assert ax.get_title(loc="left") == "line 7: r.m.s. 8.9 mm"  # √(979/6 − (55/6)²)
    assert ax.get_xlim() == (120.0, 122.5)


def test_track_spectrum_draws_estimate_spectrum_and_bands():
    track, source = synthesise(spectrum("erri_low"), 500.0, 0.25, 3), spectrum("erri_low")
    ax = plot_track_spectrum(track, source)
    wavenumber, density = track.psd()
    assert_array_equal(line(ax, "Welch").get_xdata(), wavenumber[1:])
    assert_array_equal(line(ax, "Welch").get_ydata(), density[1:])
    named = line(ax, "spectrum erri_low")
    assert_allclose(named.get_ydata(), source.density(named.get_xdata()))
    assert_allclose(named.get_xdata()[[0, -1]], wavenumber[[1, -1]])
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert "[rad/m]" in ax.get_xlabel()
    assert "[m²/(rad/m)]" in ax.get_ylabel()
    assert texts(ax)[2:] == ["D1, 3–25 m", "D2, 25–70 m"]
    edges = [patch.get_extents().transformed(ax.transData.inverted()) for patch in ax.patches]
    assert_allclose(
        [[edge.x0, edge.x1] for edge in edges],
        [[2 * np.pi / 25, 2 * np.pi / 3], [2 * np.pi / 70, 2 * np.pi / 25]],
    )


def test_fits_are_drawn_by_families_and_the_best_is_marked():
    track = synthesise("fra_5", 2000.0, 0.25, 3)
    fits = fit_spectra(measured_spectrum(track))
    ax = plot_track_spectrum(track, fits=fits)
    best = line(ax, f"fra_5 fits best, to {fits[0].misfit_db:.1f} dB")
    assert_allclose(best.get_ydata(), spectrum("fra_5").density(best.get_xdata()))
    assert len(ax.lines) == 2 + len(spectrum_names())
    assert texts(ax)[2:6] == [
        "ERRI high, low", "FRA class 1 to 6, downwards", "SNCF poor, good", "Chinese ballastless"
    ]  # fmt: skip
    beside = plot_track_spectrum(track, spectrum("fra_4"), fits=fits)
    assert line(beside, "spectrum fra_4").get_linewidth() > line(beside, "FRA").get_linewidth()
    figure = plot_track_overview(track, fits=fits)
    figure.draw_without_rendering()
    ax = figure.axes[1]
    legend = ax.get_legend().get_window_extent()
    assert not legend.overlaps(ax.get_window_extent())


def test_wavelengths_stand_above_the_wavenumbers():
    ax = plot_track_spectrum(synthesise(spectrum("erri_low"), 500.0, 0.25, 3))
    (top,) = ax.child_axes
    ax.figure.draw_without_rendering()
    assert top.get_xlabel() == "wavelength [m]"
    assert_allclose(sorted(top.get_xlim()), sorted(2 * np.pi / np.array(ax.get_xlim())))


def test_a_level_track_has_no_density_to_show():
    ax = plot_track_spectrum(replace(synthesise("erri_low", 500.0, 0.25, 3), level=np.zeros(2001)))
    assert line(ax, "Welch").get_xdata().size == 0
    ax.figure.draw_without_rendering()  # without a warning


def test_spectrum_is_drawn_inside_its_own_band_alone():
    track = synthesise(spectrum("sncf_good"), 500.0, 0.25, 3)
    ax = plot_track_spectrum(track, spectrum("sncf_good"))
    inside = line(ax, "spectrum").get_xdata()
    assert_allclose(2 * np.pi / inside[[0, -1]], [40.0, 2.0])
    # What leaks out of the band does not set the scale.
    assert ax.get_ylim()[0] > 0.02 * line(ax, "spectrum").get_ydata().min()


@pytest.mark.parametrize("level", [np.zeros(1000), np.array([0.0, 0.001, 0.002, 0.0])])
def test_level_and_very_short_tracks_can_be_drawn(level, tmp_path):
    save(plot_track_overview(Track(0.0, 0.5, level), spectrum("erri_low")), tmp_path / "a.png")
    assert (tmp_path / "a.png").stat().st_size > 0


def test_long_records_are_drawn_by_their_outline(tmp_path):
    level = np.random.default_rng(1).standard_normal(1_000_000)
    x, y = outline(np.arange(level.size, dtype=float), level)
    assert x.size == y.size <= 50_000
    assert (y.min(), y.max()) == (level.min(), level.max())
    assert np.all(np.diff(x) >= 0)
    save(plot_track(Track(0.0, 0.25, level)).figure, tmp_path / "long.png")


def test_acceleration_is_the_rated_part_of_the_record():
    shown = case()
    ax = plot_acceleration(shown)
    floor, weighted = ax.lines
    record = shown.record
    for drawn, values in ((floor, record.acceleration), (weighted, record.weighted)):
        assert_array_equal(drawn.get_xdata(), record.time[200:])
        assert_array_equal(drawn.get_ydata(), values[200:])
    assert texts(ax) == ["floor, r.m.s. 0.346 m/s²", "weighted, r.m.s. 0.222 m/s²"]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("time [s]", "acceleration [m/s²]")
    assert ax.get_title(loc="left") == (
        "144 km/h, x = 0 m: a_wrms 0.222 m/s² (exact 0.234, one run ± 0.012)"
    )
    assert weighted.get_linewidth() < floor.get_linewidth()
    assert weighted.get_zorder() >= floor.get_zorder()


def test_measured_track_has_no_exact_value_in_the_title():
    ax = plot_acceleration(case(a_wrms_exact=None, standard_error=None))
    assert ax.get_title(loc="left") == "144 km/h, x = 0 m: a_wrms 0.222 m/s²"


def test_zoom_draws_its_second_alone():
    ax = plot_acceleration(case(), zoom=(1.0, 2.0))
    assert_allclose(ax.lines[0].get_xdata(), 1 + np.arange(101) / 100)
    assert ax.get_xlim() == (1.0, 2.0)


@pytest.mark.parametrize("zoom", [(2.0, 1.0), (6.0, 7.0), (1.0, 1.005), (np.nan, 2.0), (0, np.inf)])
def test_zoom_that_shows_nothing_is_refused(zoom):
    with pytest.raises(InputError, match=r"zoom: found .*expected two times"):
        plot_acceleration(case(), zoom=zoom)


def test_zoom_lies_about_the_largest_weighted_value_and_inside_the_record():
    assert_allclose(zoom_around_peak(case()), (2.5, 3.5))
    assert_allclose(zoom_around_peak(case(seconds=3.2)), (2.2, 3.2))
    assert_allclose(zoom_around_peak(case(seconds=0.6)), (0.0, 0.6))


def test_ride_has_a_row_for_each_case_and_a_second_beside_it():
    figure = plot_ride(result(case(), case(speed=50.0, position=-4.0)))
    first, second, third, fourth = figure.axes
    assert third.get_title(loc="left").startswith("180 km/h, x = -4 m: a_wrms")
    for left, right in ((first, second), (third, fourth)):
        assert_allclose(left.get_xlim(), (0.0, 5.0))
        assert_allclose(right.get_xlim(), (2.5, 3.5))
        assert left.get_ylim() == right.get_ylim()
        assert left.get_ylim()[1] > 1.8
        assert [a.get_color() for a in left.lines] == [a.get_color() for a in right.lines]
        assert len(texts(left)) == 2
    assert figure.get_suptitle() == "cati2024 (4 segments) over erri_low, smooth floor, Wk weighted"


def test_ride_without_a_record_cannot_be_drawn(tmp_path):
    alone = case(record=None)
    for draw in (plot_acceleration, lambda c: plot_ride(result(c))):
        with pytest.raises(InputError, match="expected a time run"):
            draw(alone)
    with pytest.raises(InputError, match="expected a time run"):
        save_ride_plots(result(alone), tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_given_axes_are_drawn_into_and_returned():
    figure = Figure()
    axes = figure.subplots(3)
    track = synthesise(spectrum("erri_low"), 200.0, 0.25, 3)
    assert plot_track(track, ax=axes[0]) is axes[0]
    assert plot_track_spectrum(track, ax=axes[1]) is axes[1]
    assert plot_acceleration(case(), ax=axes[2]) is axes[2]
    assert len(figure.axes) == 3


def test_track_under_the_leading_wheelset_counts_from_the_rated_section():
    track = track_of(result(case()))
    assert_allclose(track.distance, 40.0 * np.arange(501) / 100, atol=1e-9)
    assert_allclose(track.level, 0.001 * np.cos(np.arange(501) / 100))
    assert track.name == "erri_low"


def test_ride_pictures_have_stable_names_and_the_right_size(tmp_path):
    folder = tmp_path / "some" / "plots"
    shown = result(case(), case(speed=145 / 3.6, position=-0.0), case(speed=52.1, position=-3.25))
    paths = save_ride_plots(shown, folder)
    assert [path.relative_to(folder).as_posix() for path in paths] == [
        "track.png",
        "acceleration_144kmh_0m.png",
        "acceleration_145kmh_0m.png",
        "acceleration_187.56kmh_-3.25m.png",
        "ride.png",
    ]
    assert sorted(folder.iterdir()) == sorted(paths)
    sizes = [imread(path).shape[:2] for path in paths]
    assert sizes[0] == (420, 1050)  # 7 in × 2.8 in at 150 dots per inch
    assert sizes[1] == (465, 1650)
    assert sizes[-1] == (round(150 * (3 * 2.7 + 0.4)), 1650)


def test_folder_that_cannot_be_made_is_said(tmp_path):
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match=r"found that the folder cannot be made \("):
        save_ride_plots(result(case()), tmp_path / "file" / "plots")


def test_file_that_cannot_be_written_is_said(tmp_path):
    figure = plot_track(Track(0.0, 1.0, np.zeros(4))).figure
    with pytest.raises(InputError, match="expected a file that can be written"):
        save(figure, tmp_path / "nowhere" / "a.png")


@pytest.mark.parametrize("name", ["a.bmp", "a", ".png", "a.png.txt"])
def test_other_suffixes_are_refused_with_the_list(tmp_path, name):
    figure = plot_track(Track(0.0, 1.0, np.zeros(4))).figure
    with pytest.raises(InputError, match=r"found .*suffix.*expected one of \.png, \.pdf, \.svg"):
        save(figure, tmp_path / name)
    assert list(tmp_path.iterdir()) == []


DRAW = """
import sys, numpy as np
import railride.plots
assert not any(name.startswith("matplotlib") for name in sys.modules), "loaded too early"
from railride.plots import plot_track_overview, save
from railride.spectra import fit_spectra, spectrum, spectrum_names
from railride.stochastic import measured_spectrum
from railride.track import synthesise
source = spectrum("erri_low")
for kind in ("png", "pdf", "SVG"):
    save(plot_track_overview(synthesise(source, 300.0, 0.5, 1), source), sys.argv[1] + "." + kind)
assert "matplotlib.pyplot" not in sys.modules, "pyplot"
"""


def test_files_are_the_same_on_every_run_and_pyplot_is_never_loaded(tmp_path):
    running = [
        subprocess.Popen(  # noqa: S603
            [sys.executable, "-W", "error", "-c", DRAW, str(tmp_path / name)],
            env={**os.environ, "PYTHONHASHSEED": seed},
        )
        for name, seed in (("a", "1"), ("b", "2"))
    ]
    assert [process.wait() for process in running] == [0, 0]
    for kind, start in (("png", b"\x89PNG"), ("pdf", b"%PDF"), ("SVG", b"<?xml")):
        one, other = ((tmp_path / f"{name}.{kind}").read_bytes() for name in "ab")
        assert one == other, kind
        assert one.startswith(start)


def test_settings_stay_as_they_are(tmp_path):
    before = dict(mpl.rcParams)
    save_ride_plots(result(case()), tmp_path)
    save(plot_modes(coach(2)), tmp_path / "modes.svg")
    assert dict(mpl.rcParams) == before


def test_mode_shapes_of_a_rigid_body_are_its_heave_and_pitch():
    """Undamped and alone, heave lifts all of the body alike and pitch turns it about the middle."""
    model = coach(1)
    heave = Mode(1.0, 0.0, "heave", 1.0, 1j, np.array([0.5j, 0, 0, 0, 0, 0]))
    pitch = Mode(1.0, 0.0, "pitch", 1.0, 1j, np.array([0, 0.5j, 0, 0, 0, 0]))
    assert_allclose(mode_shape(model, heave).floor, [1, 1])
    assert_allclose(mode_shape(model, pitch).floor, [1, -1])  # nose up
    assert_allclose(mode_shape(model, pitch).nodes, [12, -12])


def test_bogies_in_a_mode_shape_are_scaled_by_their_wheelsets_places():
    rear = np.zeros(9, dtype=complex)
    rear[7:] = 0.1, -0.2  # z_b2, theta_b2 after z_0..z_4, z_b1, theta_b1
    shape = mode_shape(coach(4), Mode(1.0, 0.0, "", 1.0, 1j, rear))
    assert_allclose(shape.floor, 0, atol=1e-15)
    largest = 0.1 + 0.2 * 1.25  # at the rear wheelset, 1.25 m behind the centre
    assert_allclose(shape.heave, [0, 0.1 / largest])
    assert_allclose(shape.pitch, [0, -0.2 / largest])


def test_bending_mode_is_that_of_a_free_beam():
    """Ratio of middle to end of the first free-free mode of a uniform beam: −0.6078."""
    model = coach(16)
    bending = next(mode for mode in modes(model) if mode.label == "bending 1")
    floor = mode_shape(model, bending).floor
    assert_allclose(floor[8] / floor[0], -0.6078, atol=0.02)
    assert_allclose(floor, floor[::-1], atol=1e-6)


def test_modes_are_drawn_with_label_frequency_and_damping():
    model = coach(4)
    found = modes(model)
    figure = plot_modes(model, found, count=5)
    assert len(figure.axes) == 5
    for ax, mode in zip(figure.axes, found, strict=False):
        name = mode.label + (f", {mode.phase}" if mode.phase else "")
        assert ax.get_title(loc="left") == (
            f"{name}: {mode.frequency_hz:.3f} Hz, ζ = {mode.damping_ratio:.2g}"
        )
        body = line(ax, "car body")
        assert_allclose(body.get_xdata(), [12, 6, 0, -6, -12])
        assert np.ptp(body.get_ydata() - mode_shape(model, mode).floor) < 1e-12
    assert [ax.get_xlabel() != "" for ax in figure.axes] == [False, False, False, True, True]
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [
        "at rest", "car body, nodes of its segments", "bogies", "rail",
    ]  # fmt: skip


def drawn_titles(figure):
    return [ax.get_title(loc="left").partition(":")[0] for ax in figure.axes]


def on_mounts(segments):
    bogies = tuple(replace(bogie, primary_damper_stiffness=2e6, secondary_damper_stiffness=12e6)
                   for bogie in load_vehicle("cati2024").bogies)  # fmt: skip
    return derive_vehicle(replace(load_vehicle("cati2024"), bogies=bogies), segments)


@pytest.mark.parametrize("model", [coach(4), coach(8), on_mounts(4)], ids=["4", "8", "mounts"])
def test_every_mode_that_oscillates_is_drawn(model):
    expected = [m.label + (f", {m.phase}" if m.phase else "") for m in modes(model)
                if m.eigenvalue.imag > 0]  # fmt: skip
    figure = plot_modes(model)
    assert drawn_titles(figure) == expected
    note = figure.get_supxlabel()
    assert note == ("not drawn: real eigenvalues (6 × damper)" if model.vehicle.bogies[0]
                    .primary_damper_stiffness else "")  # fmt: skip


def test_what_a_picture_of_modes_leaves_out_is_named():
    figure = plot_modes(coach(8), count=11)
    assert len(figure.axes) == 11
    assert figure.get_supxlabel() == "not drawn: bending 6 (157.1 Hz), bending 7 (181.8 Hz)"
    note = plot_modes(coach(16), count=3).get_supxlabel().replace("\n", " ")
    assert note.startswith("not drawn: bogie heave, in phase (9.461 Hz), bending 1 (9.592 Hz), ")
    assert note.endswith("10 more up to 750.2 Hz")
    creeping = [mode for mode in modes(on_mounts(2)) if mode.eigenvalue.imag == 0]
    assert drawn_titles(plot_modes(on_mounts(2), creeping)) == ["damper"] * 6
    locked = derive_vehicle(load_vehicle("cati2024"), 1).changed(c_1=1e9, c_2=1e9)
    assert len(plot_modes(locked).axes) > 0


def test_modes_of_another_model_and_no_modes_are_refused():
    with pytest.raises(InputError, match="shapes of another size"):
        plot_modes(coach(4), modes(coach(2)))
    with pytest.raises(InputError, match="found none"):
        plot_modes(coach(4), [])
    for count in (0, 2.5, "all", True):
        with pytest.raises(InputError, match=f"count: found {count!r}"):
            plot_modes(coach(4), count=count)


def test_mode_shapes_are_drawn_where_dampers_stand_on_elastic_mounts():
    """The dampers' strokes come after the bogies: what is drawn is the bogies."""
    bogies = tuple(replace(bogie, primary_damper_stiffness=1e10, secondary_damper_stiffness=3e10)
                   for bogie in load_vehicle("cati2024").bogies)  # fmt: skip
    model = derive_vehicle(replace(load_vehicle("cati2024"), bogies=bogies), 2)
    rigid = [mode_shape(coach(2), mode) for mode in modes(coach(2))]
    named = [mode for mode in modes(model) if mode.label != "damper"]
    for shape, mode in zip(rigid, named, strict=True):
        drawn = mode_shape(model, mode)
        for part in ("floor", "heave", "pitch"):
            assert_allclose(getattr(drawn, part), getattr(shape, part), atol=0.02)


def frames_of(path):
    """All pictures of a GIF as arrays, and what its header says."""
    with Image.open(path) as gif:
        info = (gif.size, gif.info["loop"], gif.info["duration"])
        return [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(gif)], info


def moved(frame, other):
    """The mean difference of two pictures, below the line with the time."""
    return np.abs(frame[40:].astype(float) - other[40:]).mean()


def test_animation_is_one_period_that_goes_round(tmp_path):
    model = coach(2)
    bending = next(mode for mode in modes(model) if mode.label == "bending 1")
    path = tmp_path / "bending.gif"
    plots.animate_mode(model, bending, path)
    pictures, (size, loop, duration) = frames_of(path)
    assert (len(pictures), size, loop, duration) == (24, (720, 340), 0, 60)
    # Half a period later all is upside down, and the last picture leads to the first.
    assert moved(pictures[0], pictures[12]) > 3 * moved(pictures[0], pictures[1])
    assert moved(pictures[23], pictures[0]) < 2 * moved(pictures[11], pictures[12])
    first = path.read_bytes()
    plots.animate_mode(model, bending, path)
    assert path.read_bytes() == first


def test_animation_shows_differences_of_phase():
    """A quarter period on, a part that lags by 90° is where the leading one was."""
    model = coach(1)
    shape = np.array([1.0, 0, -1j, 0, -1j, 0])  # the bogies a quarter behind the body
    mode = Mode(1.0, 0.0, "heave", 1.0, 2j * np.pi, shape)
    start, quarter = (mode_shape(model, mode, np.exp(2j * np.pi * t)) for t in (0, 0.25))
    assert_allclose([start.floor[0], start.heave[0]], [1, 0], atol=1e-12)
    assert_allclose([quarter.floor[0], quarter.heave[0]], [0, 1], atol=1e-12)


def test_animation_decays_on_request_and_where_nothing_oscillates(tmp_path, monkeypatch):
    """At t = T the amplitude is e^{-2πζ/√(1-ζ²)}; a real eigenvalue ends near e^-3."""
    model = coach(1)
    turns = []

    def noted(model, mode, turned):
        turns.append(turned)
        return mode_shape(model, mode, turned)

    monkeypatch.setattr("railride.plots.animation.mode_shape", noted)
    heave = modes(model)[0]
    plots.animate_mode(model, heave, tmp_path / "a.gif", frames=4)
    assert_allclose(turns, [1, 1j, -1, -1j], atol=1e-12)
    turns.clear()
    plots.animate_mode(model, heave, tmp_path / "a.gif", frames=4, decay=True)
    zeta = heave.damping_ratio
    assert_allclose(np.abs(turns[2]), np.exp(-np.pi * zeta / np.sqrt(1 - zeta**2)))
    turns.clear()
    creeping = next(m for m in modes(model, c_2=1e6) if m.eigenvalue.imag == 0)
    plots.animate_mode(model, creeping, tmp_path / "a.gif", frames=6)
    assert_allclose(turns, np.exp(-np.arange(6) / 2))
    assert len(frames_of(tmp_path / "a.gif")[0]) == 6


@pytest.mark.parametrize(
    ("name", "more", "message"),
    [
        ("a.png", {}, r"suffix '\.png'; expected \.gif"),
        ("a", {}, "no suffix"),
        ("a.gif", {"frames": 1}, "frames: found 1; expected a whole number from 2 to 500"),
        ("a.gif", {"frames": 501}, "frames: found 501"),
        ("a.gif", {"frames": 2.5}, r"frames: found 2\.5"),
        ("no/a.gif", {"frames": 2}, "a.gif"),
    ],
)
def test_animations_that_cannot_be(name, more, message, tmp_path):
    with pytest.raises(InputError, match=message):
        plots.animate_mode(coach(2), modes(coach(2))[0], tmp_path / name, **more)
    with pytest.raises(InputError, match="shapes of another size"):
        plots.animate_mode(coach(4), modes(coach(2))[0], tmp_path / "a.gif")
    assert list(tmp_path.iterdir()) == []


@cache
def locus():
    return mode_locus(coach(2), c_2=np.linspace(10e3, 250e3, 25))


def drawn_points(ax):
    """Every point of a picture's lines, without marks and rays."""
    lines = [drawn for drawn in ax.lines if drawn.get_linestyle() != "None"
             and drawn.get_color() != "#CCCCCC"]  # fmt: skip
    return {tuple(np.round(point, 9)) for drawn in lines for point in drawn.get_xydata()}


def test_root_locus_draws_every_eigenvalue_in_hertz():
    ax = plots.plot_root_locus(locus())
    expected = np.round(locus()[["real", "imag"]].to_numpy() / (2 * np.pi), 9)
    assert drawn_points(ax) == {tuple(point) for point in expected}
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("Re λ/2π [Hz]", "Im λ/2π [Hz]")
    assert texts(ax)[-2:] == ["c_2 = 10 kN s/m", "c_2 = 250 kN s/m"]
    assert set(texts(ax)[:-2]) == set(locus()["label"])
    start, end = (drawn for drawn in ax.lines if drawn.get_linestyle() == "None")
    assert (start.get_marker(), end.get_marker()) == ("x", "o")
    first = locus()[locus()["c_2"] == 10e3]
    assert_allclose(start.get_xdata(), first["real"] / (2 * np.pi))
    left, right = ax.get_xlim()
    assert right == 0
    assert left < locus().loc[locus()["imag"] > 0, "real"].min() / (2 * np.pi)


def test_marks_on_the_axes_are_whole_and_none_lies_outside():
    ax = plots.plot_root_locus(mode_locus(coach(2), c_2=np.linspace(0.0, 900e3, 30)))
    left, _ = ax.get_xlim()
    marks = [drawn for drawn in ax.lines if drawn.get_linestyle() == "None"]
    assert [mark.get_marker() for mark in marks] == ["x", "o"]
    for mark in marks:
        assert not mark.get_clip_on()
        assert (mark.get_xdata() >= left).all()
    ends = mode_locus(coach(2), c_2=np.array([0.0, 900e3]))
    beyond = ends["real"] / (2 * np.pi) < left
    assert beyond.any()  # real eigenvalues far to the left have no mark
    assert sum(len(mark.get_xdata()) for mark in marks) == (~beyond).sum()


def rays(ax):
    return [drawn for drawn in ax.lines if drawn.get_color() == "#CCCCCC"]


def test_rays_are_of_constant_damping():
    ax = plots.plot_root_locus(locus())
    named = {text.get_text(): text.xy for text in ax.texts}
    assert len(named) == len(rays(ax)) >= 4
    for name, (x, y) in named.items():
        assert_allclose(-x / np.hypot(x, y), float(name.removeprefix("ζ = ")))


def test_damping_is_drawn_over_the_parameter():
    ax = plots.plot_damping(locus())
    expected = np.column_stack([locus()["c_2"] / 1e3, locus()["damping_ratio"]])
    assert drawn_points(ax) == {tuple(point) for point in np.round(expected, 9)}
    assert ax.get_xlabel() == "secondary damping per bogie, c_2 [kN s/m]"
    assert ax.get_ylabel() == "damping ratio"
    assert texts(ax) == list(dict.fromkeys(texts(ax)))
    assert set(texts(ax)) == set(locus()["label"])
    assert (ax.get_xscale(), ax.get_xlim()) == ("linear", (10, 250))
    spread = plots.plot_damping(mode_locus(coach(2), c_2=np.geomspace(1e3, 1e6, 5)))
    assert spread.get_xscale() == "log"


def test_loci_of_both_kinds_become_one_picture(tmp_path):
    figure = plots.plot_loci(locus())
    assert len(figure.axes) == 2
    assert not any(ax.get_legend() for ax in figure.axes)
    save(figure, tmp_path / "locus.png")
    assert imread(tmp_path / "locus.png").shape[:2] == (840, 1800)
    with pytest.raises(InputError, match="found no branch, damping_ratio"):
        plots.plot_root_locus(locus().drop(columns=["branch", "damping_ratio"]))
    with pytest.raises(InputError, match="no rows"):
        plots.plot_damping(locus().iloc[:0])


def test_loci_where_nothing_oscillates_or_moves_can_be_drawn():
    creeping = locus()[locus()["imag"] == 0]
    plots.plot_root_locus(creeping).figure.draw_without_rendering()
    still = mode_locus(coach(2), f_bending=[9.0, 10.0], c_1=0.0, c_2=0.0)
    plots.plot_root_locus(still).figure.draw_without_rendering()
    plots.plot_damping(still).figure.draw_without_rendering()


def test_a_ride_is_headed_with_its_body():
    figure = plot_ride(result(case(), body="rigid body"))
    assert "(rigid body)" in figure.get_suptitle()


def test_equipment_is_drawn_under_the_floor_where_it_goes():
    one = Equipment(2000.0, 3.0, frequency=8.8)
    model = derive_vehicle(replace(load_vehicle("cati2024"), equipment=(one,)), body="beam")
    mode = next(m for m in modes(model) if m.label == "equipment 1")
    shape = mode_shape(model, mode)
    row = [q.name for q in model.lagrangian.coordinates].index("z_e1")
    turned = mode.shape[row] / shape.equipment[0]  # the same turn for all that moves
    floor = model.output_rows([model.floor(12.0, derivative=0)])["d"][0] @ mode.shape
    assert_allclose((floor / turned).real, shape.floor[0], atol=1e-9)
    figure = plots.plot_modes(model, [mode])
    marks = [line for line in figure.axes[0].lines if line.get_label() == "equipment"]
    assert_allclose(marks[0].get_xdata(), 3.0)
