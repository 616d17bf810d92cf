"""Pictures of measured records: what is drawn is what was rated, and gaps stay open."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from railride import plots
from railride.comfort import AccelerationRecord, Axis, rate_record
from railride.comfort.third_octaves import band_edges, third_octave_rms
from railride.errors import InputError

RATE = 200.0


def rating(*, gap=False, offset=0.0):
    t = np.arange(4000) / RATE
    tone = np.sin(2 * np.pi * 4.0 * t) + offset
    pieces = (tone[:1500], tone[2000:]) if gap else (tone,)
    starts = (0.0, 10.0) if gap else (0.0,)
    axes = (Axis("floor", "z", pieces), Axis("y", "y", tuple(0.2 * p for p in pieces)))
    return rate_record(AccelerationRecord("run.csv", RATE, starts, axes))


def test_record_and_weighted_record_are_drawn_over_time():
    found = rating()
    ax = plots.plot_record(found)
    plain, weighted = ax.get_lines()
    assert_allclose(plain.get_xdata(), np.arange(4000) / RATE)
    assert_allclose(plain.get_ydata(), found.axes[0].axis.pieces[0])
    assert_allclose(weighted.get_ydata(), found.axes[0].indices.weighted[0])
    assert ax.get_xlabel() == "time [s]"
    assert ax.get_ylabel() == "acceleration [m/s²]"
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[0].startswith("floor, r.m.s. 0.707")
    assert labels[1].startswith("Wk weighted")


def test_gaps_stay_open_and_are_named_once():
    ax = plots.plot_record(rating(gap=True))
    lines = ax.get_lines()
    assert [line.get_xdata()[0] for line in lines] == [0.0, 10.0, 0.0, 10.0]
    assert lines[0].get_xdata()[-1] == pytest.approx(7.495)
    assert len(ax.get_legend().get_texts()) == 2
    assert ax.get_xlim() == pytest.approx((0.0, 20.0))


def test_gravity_in_the_record_leaves_both_lines_in_the_picture():
    low, high = plots.plot_record(rating(offset=9.81)).get_ylim()
    assert low < -1.0
    assert high > 10.81


def test_running_rms_with_blocks_and_the_whole():
    found = rating()
    ax = plots.plot_running_rms(found, "floor")
    assert_allclose(ax.get_lines()[0].get_ydata(), found.axes[0].running[0][199:])
    (blocks,) = ax.collections
    heights = [segment[0][1] for segment in blocks.get_segments()]
    assert_allclose(heights, found.blocks()["floor Wk [m/s^2]"])
    assert ax.get_lines()[1].get_ydata()[0] == found.axes[0].indices.a_wrms


@pytest.mark.parametrize(("rate", "first"), [(200.0, 199), (199.5, 199), (200.5, 200)])
def test_running_rms_is_drawn_from_where_its_window_is_full(rate, first):
    """A steady tone has the same r.m.s. in every whole second; a piece of less has none to show."""
    tone = np.sin(2 * np.pi * 4.0 * np.arange(3000) / rate)
    pieces, starts = (tone[:1200], tone[1200:1300], tone[1300:]), (0.0, 10.0, 20.0)
    record = AccelerationRecord("run", rate, starts, (Axis("floor", "z", pieces),))
    found = rate_record(record)
    ax = plots.plot_running_rms(found)
    *lines, whole = ax.get_lines()
    assert [line.get_xdata().size for line in lines] == [1200 - first, 0, 1700 - first]
    assert lines[2].get_xdata()[0] == pytest.approx(20.0 + first / rate)
    assert min(line.get_ydata().min() for line in lines[::2]) > 0.95 * whole.get_ydata()[0]
    assert max(line.get_ydata().max() for line in lines[::2]) == found.axes[0].indices.mtvv
    assert ax.get_ylim()[1] > whole.get_ydata()[0]


def test_the_spectrum_holds_the_third_octaves_and_ends_at_half_the_rate():
    found = rating()
    ax = plots.plot_record_spectrum(found, "y")
    stairs = [patch for patch in ax.patches if hasattr(patch, "get_data")]
    assert_allclose(stairs[0].get_data().values, third_octave_rms(found.axes[1].axis.pieces, RATE))
    assert_allclose(stairs[1].get_data().edges, band_edges())
    density = ax.get_lines()[0]
    assert density.get_xdata()[-1] <= RATE / 2
    f, level = density.get_xdata(), density.get_ydata()
    # The root of the density's integral is the r.m.s. (Hann window: the tone's line is spread).
    assert np.sqrt(np.sum(level**2) * (f[1] - f[0])) == pytest.approx(0.2 / np.sqrt(2), rel=0.01)


def test_a_row_for_every_axis():
    figure = plots.plot_record_rating(rating(gap=True))
    assert len(figure.get_axes()) == 6
    titles = [ax.get_title(loc="left") for ax in figure.get_axes()]
    assert "y: a_wrms 0.0724 m/s², ISO 2631-1 Annex C: not uncomfortable" in titles
    assert "run.csv: 17.5 s at 200 Hz" in figure.get_suptitle()


@pytest.mark.parametrize(
    ("amplitude", "words"),
    [
        (1.23, "fairly uncomfortable or uncomfortable"),
        (1.65, "uncomfortable"),
        (0.1, "not uncomfortable"),
    ],
)
def test_the_title_names_the_scale_and_every_class_that_fits(amplitude, words):
    tone = amplitude * np.sin(2 * np.pi * 8.0 * np.arange(4000) / RATE)
    found = rate_record(AccelerationRecord("run", RATE, (0.0,), (Axis("floor", "z", (tone,)),)))
    title = plots.plot_record_rating(found).get_axes()[0].get_title(loc="left")
    a_w = found.axes[0].indices.a_wrms
    assert title == f"floor (z): a_wrms {a_w:.3g} m/s², ISO 2631-1 Annex C: {words}"


def test_silence_can_be_drawn(tmp_path):
    silent = AccelerationRecord("nothing", RATE, (0.0,), (Axis("z", "z", (np.zeros(3000),)),))
    plots.save(plots.plot_record_rating(rate_record(silent)), tmp_path / "silent.png")
    assert (tmp_path / "silent.png").stat().st_size > 0


def test_a_column_that_was_not_rated():
    with pytest.raises(InputError, match=r"found 'x'; expected one of floor, y"):
        plots.plot_record(rating(), "x")
