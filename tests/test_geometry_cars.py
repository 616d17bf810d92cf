"""Files of track geometry cars: places as kilometre and metre, two rails, bands, dropouts."""

from __future__ import annotations

import h5py
import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose
from scipy.io import savemat

from railride.errors import InputError
from railride.spectra import D1, D2, Spectrum, spectrum
from railride.track import Track, synthesise
from railride.trackfile import load_track, read_track
from railride.trackfile.headings import meaning

X = np.arange(60) * 0.25
W = np.round(2.0 * np.sin(0.7 * X) + np.cos(0.31 * X), 3)  # mm


def car(places=None, left=None, right=None, headings=None, more=()):
    """An export as such cars write it: a line of metadata, then a count, the place and levels.

    Row j of the numbers is line j + 3. ``more``: further columns, as (heading, values).
    """
    places = [f"130+{100 + x:07.2f}" for x in X] if places is None else places
    left = W - 0.5 if left is None else left
    right = W + 0.5 if right is None else right
    headings = headings or ("Vasen Korkeuspoikkeama D1 [mm]", "Oikea Korkeuspoikkeama D1 [mm]")
    named = ["SSCount", "Location [km+m]", *(f"TG Master.{h}" for h in headings)]
    columns = [range(7, 7 + len(places)), places, left, right]
    for heading, values in more:
        named.append(heading)
        columns.append(values)
    lines = [",".join(f'"{h}"' for h in named)]
    lines += [",".join(str(cell) for cell in row) for row in zip(*columns, strict=True)]
    return "\n".join(['"Running Date","22/11/2022 7:44:40 AM"', *lines]) + "\n"


@pytest.fixture
def read(tmp_path):
    """Read a file of the given text."""

    def reader(text, **reading):
        (tmp_path / "car.csv").write_text(text, encoding="utf-8")
        return read_track(tmp_path / "car.csv", **reading)

    return reader


@pytest.fixture
def fault(read):
    """Read a file that is wrong and give the message."""

    def reader(text, **reading):
        with pytest.raises(InputError) as caught:
            read(text, **reading)
        assert "found" in str(caught.value)
        assert "expected" in str(caught.value)
        return str(caught.value)

    return reader


def test_the_mean_of_two_rails_is_read_from_kilometre_and_metre(read):
    track = read(car())
    assert track.distance0 == 130_100.0
    assert track.step == 0.25
    assert track.band == D1
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    assert track.remarks == ()


@pytest.mark.parametrize(
    "form", ["km 130+{:.2f}", "130 + {:.2f}", "130+{:.2f} m", "KM130+{:.3f}", "130+{:09.4f}"]
)
def test_kilometre_and_metre_are_written_in_many_ways(read, form):
    track = read(car([form.format(100 + x) for x in X]).replace("Location [km+m]", "Location"))
    assert track.distance0 == 130_100.0
    assert track.step == 0.25


def test_decimal_commas_in_kilometre_and_metre(read):
    lines = car().split("\n")[1:]
    text = "\n".join(line.replace(",", ";").replace(".", ",") for line in lines)
    assert_allclose(read(text.replace("TG Master,", "")).level, W / 1000, rtol=0, atol=1e-15)


def test_a_counter_set_right_is_remarked_and_bridged(read):
    """As in a real file: 100.00, 100.25, 100.00, 100.25, while the car samples on evenly."""
    places = np.concatenate([100 + X[:2], 100 + X[:-2]])
    track = read(car([f"130+{x:07.2f}" for x in places]))
    assert track.step == 0.25
    assert track.length == pytest.approx(0.25 * 59)
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    (remark,) = track.remarks
    assert "row 5, column 'Location [km+m]': the location goes back from 130+0100.25" in remark
    assert "to 130+0100.00" in remark


@pytest.mark.parametrize("last", [994.75, 1002.75])
def test_kilometres_that_are_not_1000_m_long(read, last):
    """The metre begins anew at a stone 995 m or 1003 m after the one before."""
    places = [f"130+{last - x:07.2f}" for x in X[19::-1]] + [f"131+{x:07.2f}" for x in X[:40]]
    track = read(car(places))
    assert (track.distance0, track.step) == (130_000.0 + last - 4.75, 0.25)
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    (remark,) = track.remarks
    assert f"the first before row 23 (130+{last:07.2f} to 131+0000.00)" in remark
    assert read(car([f"130+{999.75 - x:07.2f}" for x in X[19::-1]] + places[20:])).remarks == ()


def test_what_is_no_counter_set_right_is_a_fault(fault):
    places = [f"130+{100 + x:07.2f}" for x in X]
    far = [f"130+{200 + x:07.2f}" if j < 30 else places[j] for j, x in enumerate(X)]
    gap = [*places[:30], *[f"130+{130 + x:07.2f}" for x in X[:30]]]
    assert "a fall" in fault(car(far))
    message = fault(car(gap))
    assert "row 33, column 'Location [km+m]': found 130130 after 130107.25, a gap" in message
    assert "--step" in message
    twice = [*places[:30], *places[29:-1]]
    assert "the same distance again" in fault(car(twice))


def test_places_that_are_none_are_named(fault):
    places = [f"130+{100 + x:07.2f}" for x in X]
    places[4], places[9] = "130-0101.00", ""
    message = fault(car(places))
    assert "row 7, column 'Location [km+m]': found '130-0101.00'; expected kilometre" in message
    assert "row 12, column 'Location [km+m]': found a blank cell" in message


def test_a_step_takes_the_place_of_the_distances(read, fault):
    places = [f"130+{100 + x:.0f}" for x in X]  # whole metres: four rows each
    assert "the same distance again" in fault(car(places))
    track = read(car(places), step=0.25)
    assert (track.distance0, track.step) == (130_100.0, 0.25)
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    assert "only the first counts" in track.remarks[0]
    told = read(car(), step=0.5)
    assert told.step == 0.5
    assert "by which the rows are 0.25 m apart" in told.remarks[0]


def test_without_a_distance_the_step_must_be_given(read, fault):
    text = "level_mm\n" + "\n".join(map(str, W)) + "\n"
    assert "no distance column" in fault(text)
    track = read(text, step=0.25)
    assert (track.distance0, track.step) == (0.0, 0.25)
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)


@pytest.mark.parametrize("step", [0.0, -0.25, np.nan, np.inf])
def test_steps_and_fillings_that_are_none(fault, step):
    assert "step" in fault(car(), step=step)
    if step != 0.0:
        assert "fill" in fault(car(), fill=step)


# columns


@pytest.mark.parametrize(
    ("heading", "rail", "band"),
    [
        ("level", "", ""),
        ("Longitudinal level", "", ""),
        ("TG Master.Vasen Korkeuspoikkeama D1", "left", "D1"),
        ("TG Master.Oikea Korkeuspoikkema D0", "right", "D0"),
        ("leftRailLevel", "left", ""),
        ("Longitudinal_level_D2_right", "right", "D2"),
        ("Längshöhe links", "left", ""),
        ("Nivellement longitudinal droite", "right", ""),
    ],
)
def test_headings_of_levels(heading, rail, band):
    found = meaning(heading)
    assert (found.kind, found.rail, found.band) == ("level", rail, band)


@pytest.mark.parametrize(
    ("heading", "kind"),
    [
        ("cross level", ""),
        ("sound level", ""),
        ("TG Master.Kallistus", ""),
        ("level left right", ""),
        ("TG Master.Vasen Nuolikorkeuspoikkeama D1", "chord"),
        ("Vertical versine 10 m left", "chord"),
        ("level, mid-chord offset", "chord"),
        ("Pfeilhöhe links", "chord"),
        ("TG Master.Vasen Korkeuspoikkeama D1 Keskihajonta", "statistic"),
        ("level standard deviation", "statistic"),
        ("Sijainti", "distance"),
        ("distance", "distance"),
        ("braking distance", ""),
    ],
)
def test_headings_of_other_things(heading, kind):
    assert meaning(heading).kind == kind


def bands():
    """Left and right level in D1 and D2, a chord offset, a standard deviation."""
    return car(
        more=[
            ("TG Master.Vasen Korkeuspoikkeama D2 [mm]", 3 * W),
            ("TG Master.Oikea Korkeuspoikkeama D2 [mm]", 5 * W),
            ("TG Master.Vasen Nuolikorkeuspoikkeama D1 [mm]", 7 * W),
            ("TG Master.Vasen Korkeuspoikkeama D1 Keskihajonta [mm]", 0 * W + 1.3),
        ]
    )


def test_of_several_bands_d1_is_read_and_the_others_named(read):
    track = read(bands())
    assert track.band == D1
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    assert "D1 was read; D2 are there too (--level-column" in track.remarks[0]


def test_columns_are_picked_by_name_or_a_part_of_it(read):
    for level in (
        "Korkeuspoikkeama D2",
        ["Vasen Korkeuspoikkeama D2", "TG Master.Oikea Korkeuspoikkeama D2 [mm]"],
        ["TG Master.Oikea Korkeuspoikkeama D2", "vasen korkeuspoikkeama d2"],
    ):
        track = read(bands(), level=level)
        assert track.band == D2
        assert_allclose(track.level, 4 * W / 1000, rtol=0, atol=1e-15)
        assert track.remarks == ()
    one = read(bands(), level="TG Master.Vasen Korkeuspoikkeama D1 [mm]", distance="location")
    assert_allclose(one.level, (W - 0.5) / 1000, rtol=0, atol=1e-15)


def test_picks_that_cannot_be(fault):
    assert "versine" in fault(bands(), level="Nuolikorkeuspoikkeama")
    assert "a standard deviation" in fault(bands(), level="Keskihajonta")
    assert "several level columns" in fault(bands(), level="Vasen Korkeuspoikkeama")
    different = ["Vasen Korkeuspoikkeama D1", "Oikea Korkeuspoikkeama D2"]
    assert "the bands D1 and D2" in fault(bands(), level=different)
    assert "no such column" in fault(bands(), level="Hoogte")
    assert "no such column" in fault(bands(), distance="Weg")
    assert "found 3 columns" in fault(bands(), level=["a", "b", "c"])
    assert "the unit 'Km/h'" in fault(car(more=[("Speed [Km/h]", 0 * W + 80)]), level="Speed")


def test_chords_alone_are_told_apart(fault):
    headings = ("Vasen Nuolikorkeus D1 [mm]", "Oikea Nuolikorkeus D1 [mm]")
    message = fault(car(headings=headings))
    assert "no level column" in message
    assert "'TG Master.Vasen Nuolikorkeus D1 [mm]' is a chord offset" in message


def test_one_rail_alone_is_remarked(read):
    headings = ("Vasen Korkeuspoikkeama D1 [mm]", "Kierous [mm]")
    track = read(car(headings=headings))
    assert_allclose(track.level, (W - 0.5) / 1000, rtol=0, atol=1e-15)
    assert "one rail alone" in track.remarks[0]


def test_a_band_that_is_not_known_is_remarked(read):
    headings = ("Vasen Korkeuspoikkema D0 [mm]", "Oikea Korkeuspoikkema D0 [mm]")
    track = read(car(headings=headings))
    assert track.band is None
    assert "which wavelengths the band D0 holds is not known" in track.remarks[0]


def test_units_may_be_given(read, fault):
    headings = ("Vasen Korkeuspoikkeama", "Oikea Korkeuspoikkeama")
    assert "no unit" in fault(car(headings=headings))
    track = read(car(headings=headings), level_unit="mm")
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    assert "'inch'" in fault(car(headings=headings), level_unit="inch")
    numbers = "\n".join(f"{x},{w}" for x, w in zip(X, W, strict=True))
    track = read(numbers, distance="1", level="2", distance_unit="m", level_unit="mm")
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    assert "there is no header" in track.remarks[0]


# dropouts, spikes


def dropped(first, end, cell=""):
    left = [str(w) for w in W - 0.5]
    left[first:end] = [cell] * (end - first)
    return car(left=left)


@pytest.mark.parametrize("cell", ["", "inv", "NaN"])
def test_a_dropout_is_refused_with_place_and_length(fault, cell):
    message = fault(dropped(20, 26, cell))
    column = "column 'TG Master.Vasen Korkeuspoikkeama D1 [mm]'"
    assert f"row 23, {column}: found " in message
    assert "no number as far as row 28, 1.5 m" in message
    assert "--fill 1.5" in message
    assert len(message.split("\n")) == 1


def test_a_short_dropout_is_bridged_where_that_is_asked(read, fault):
    track = read(dropped(20, 26, "inv"), fill=1.5)
    good = np.r_[0:20, 26:60]
    assert_allclose(track.level[good], W[good] / 1000, rtol=0, atol=1e-15)
    assert_allclose(track.level, W / 1000, rtol=0, atol=2e-4)  # the cubic stays near a smooth level
    (remark,) = track.remarks
    assert "rows 23 to 28" in remark
    assert "1.5 m without a level, bridged" in remark
    assert "found 'inv'" in fault(dropped(20, 26, "inv"), fill=1.25)
    # What has nothing on one of its sides cannot be bridged.
    assert "row 3, " in fault(dropped(0, 3), fill=5.0)
    assert "row 60, " in fault(dropped(57, 60), fill=5.0)


def test_zeros_are_remarked_and_kept_or_bridged(read):
    track = read(dropped(20, 28, "0.000"))
    assert "rows 23 to 30" in track.remarks[0]
    assert "2 m exactly zero, a dropout? kept" in track.remarks[0]
    assert_allclose(track.level[22], (W[22] + 0.5) / 2000, rtol=0, atol=1e-15)
    track = read(dropped(20, 28, "0.000"), fill=2.0)
    assert "bridged" in track.remarks[0]
    assert_allclose(track.level, W / 1000, rtol=0, atol=4e-4)


def test_rounding_is_no_dropout(read):
    """A level rounded to 1 mm repeats every value, zero among them."""
    w = np.round(1.5 * np.sin(0.15 * np.arange(60)))
    assert np.max(np.diff(np.flatnonzero(np.diff(w)))) > 4
    assert read(car(left=w, right=w)).remarks == ()


def test_a_spike_is_remarked_and_kept(read):
    left, right = W - 0.5, W + 0.5
    left[30] += 8.0
    right[30] += 8.0
    track = read(car(left=left, right=right))
    assert_allclose(track.level[30], (W[30] + 8.0) / 1000, rtol=0, atol=1e-15)
    assert "row 33, column" in track.remarks[0]
    assert "far off its neighbours by 7.97 mm" in track.remarks[0]
    step = np.where(np.arange(60) < 30, W, W + 8.0)  # a jump is none
    assert not any("spike" in said for said in read(car(left=step, right=step)).remarks)


@pytest.mark.parametrize("name", ["erri_low", "sncf_poor", "china_ballastless"])
def test_a_track_of_a_spectrum_has_neither_spikes_nor_dropouts(read, name):
    level = np.round(1000 * synthesise(name, 2000.0, 0.25, 3).level, 2)
    rows = "\n".join(f"{0.25 * j},{w}" for j, w in enumerate(level))
    assert read("distance_m,level_mm\n" + rows + "\n").remarks == ()


# direction


def test_reversed_is_the_same_track_the_other_way(read):
    track = read(car())
    back = read(car(), reverse=True)
    assert_allclose(back.level, W[::-1] / 1000, rtol=0, atol=1e-15)
    assert back.distance0 == -track.end
    assert back.end == -track.distance0
    assert_allclose(back.elevation(-track.distance)[0], track.level, rtol=0, atol=1e-12)
    again = back.reversed()
    assert np.array_equal(again.level, track.level)
    assert again.distance0 == track.distance0
    assert "from its end at 130114.75 m to its start at 130100 m" in back.remarks[-1]
    with pytest.raises(InputError, match="taper"):
        track.with_taper(5.0).reversed()


def test_falling_distances_are_run_as_recorded(read, fault):
    falling = car([f"130+{200 - x:07.2f}" for x in X])
    track = read(falling)
    assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)
    assert track.distance0 == -130_200.0
    assert "fall" in track.remarks[0]
    back = read(falling, reverse=True)
    assert back.distance0 == 130_185.25
    assert_allclose(back.level, W[::-1] / 1000, rtol=0, atol=1e-15)
    rows = [f"{100 - x},{w}" for x, w in zip(X, W, strict=True)]
    rows[10], rows[11] = rows[11], rows[10]
    assert "a rise" in fault("distance_m,level_mm\n" + "\n".join(rows) + "\n")


# other files


def test_binary_files_hold_tracks_too(tmp_path):
    table = pd.DataFrame({"distance_m": X, "level_mm": W})
    table.to_parquet(tmp_path / "a.parquet")
    savemat(tmp_path / "a.mat", {"distance_m": X, "level_mm": W})
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["distance_m"], file["level_mm"] = X, W
    savemat(tmp_path / "struct.mat", {"track": {"distance_m": X, "level_mm": W}})
    with h5py.File(tmp_path / "group.h5", "w") as file:
        file["run/distance_m"], file["run/level_mm"] = X, W
    for name in ("a.parquet", "a.mat", "a.h5", "struct.mat", "group.h5"):
        track = read_track(tmp_path / name)
        assert track.step == 0.25
        assert track.name == name
        assert_allclose(track.level, W / 1000, rtol=0, atol=1e-15)


@pytest.mark.parametrize(("heading", "metres"), [("km", 1000.0), ("kilometre", 1000.0)])
def test_a_heading_that_is_a_unit_has_that_unit(read, heading, metres):
    rows = "\n".join(f"{(100 + x) / metres:.5f},{w}" for x, w in zip(X, W, strict=True))
    found = read(f"{heading},level_mm\n{rows}\n")
    assert found.step == pytest.approx(0.25)
    assert found.distance0 == pytest.approx(100.0)


def test_load_track_tells_spectra_from_tracks_by_their_columns(tmp_path):
    (tmp_path / "track.csv").write_text(car())
    (tmp_path / "own.csv").write_text("wavelength_m,psd [m^2/(rad/m)]\n100,1e-3\n2,1e-9\n")
    assert isinstance(load_track(tmp_path / "track.csv"), Track)
    found = load_track(tmp_path / "own.csv")
    assert isinstance(found, Spectrum)
    assert found.name == "own.csv"
    assert load_track("erri_low") is spectrum("erri_low")
    reading = {"level": "Vasen Korkeuspoikkeama D1"}
    assert_allclose(load_track(tmp_path / "track.csv", **reading).level[0], (W[0] - 0.5) / 1000)
    for other in ("erri_low", tmp_path / "own.csv", Track(0.0, 1.0, np.zeros(9))):
        with pytest.raises(InputError, match="level for it"):
            load_track(other, **reading)
    with pytest.raises(InputError, match="a spectrum, densities"):
        read_track(tmp_path / "own.csv")
