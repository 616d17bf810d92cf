"""A whole record rated: axes, all together, EN 12299 and over time, in closed form."""

import math

import numpy as np
import pytest

from railride.comfort import (
    POSTURES,
    AccelerationRecord,
    Axis,
    continuous_comfort,
    few_blocks,
    indices,
    n_mv,
    rate_record,
    running_rms,
    vector_sum,
    vibration_total,
)
from railride.comfort.total import find_posture
from railride.errors import InputError
from railride.scales import SCALES
from railride.weightings import apply_weighting, weighting

RATE = 400.0
AMPLITUDE = {"x": 0.6, "y": 0.4, "z": 0.65}
TONE = 4.0


def tone(seconds, amplitude):
    times = np.arange(round(seconds * RATE)) / RATE
    return amplitude * np.sin(2 * np.pi * TONE * times + 0.3)


def measured(directions="xyz", seconds=(20.0,), starts=(0.0,), loud=1.0):
    axes = tuple(
        Axis(f"a{d}", d, tuple(tone(s, loud * AMPLITUDE[d]) for s in seconds)) for d in directions
    )
    return AccelerationRecord("tones", RATE, starts, axes, ("made for a test",))


def level(name, direction):
    """Weighted r.m.s. of the tone of a direction."""
    return abs(weighting(name).response(TONE)) * AMPLITUDE[direction] / math.sqrt(2)


def test_every_axis_is_rated_by_its_own_weighting_and_direction():
    found = rate_record(measured())
    for one, name, direction in zip(found.axes, ("Wd", "Wd", "Wk"), "xyz", strict=True):
        assert one.axis.column == f"a{direction}"
        assert one.indices.weighting == name
        assert one.indices.a_wrms == pytest.approx(level(name, direction), rel=1e-3)
    assert found.axes[0].indices.wz is None
    for one, sperling in zip(found.axes[1:], ("lateral", "vertical"), strict=True):
        expected = indices(one.axis.pieces[0], RATE, "Wk", direction=sperling).wz
        assert one.indices.wz == expected
    assert found.duration == 20


def test_the_vector_sum_of_a_standing_person():
    found = rate_record(measured())
    expected = math.hypot(level("Wd", "x"), level("Wd", "y"), level("Wk", "z"))
    assert found.total.value == pytest.approx(expected, rel=1e-3)
    assert found.total.posture.name == "standing"
    assert found.total.factors == {"x": 1.0, "y": 1.0, "z": 1.0}
    assert found.total.levels == {"ISO 2631-1 Annex C": ["a little uncomfortable",
                                                        "fairly uncomfortable"]}  # fmt: skip
    assert "8.2.2.2" in found.total.posture.source


@pytest.mark.parametrize(
    ("posture", "weightings", "factors"),
    [
        # ISO 2631-1:1997, 8.2.2
        ("standing", "Wd Wd Wk", (1, 1, 1)),
        ("seat", "Wd Wd Wk", (1, 1, 1)),
        ("backrest", "Wc Wd Wd", (0.8, 0.5, 0.4)),
        ("feet", "Wk Wk Wk", (0.25, 0.25, 0.4)),
        ("recumbent", "Wd Wd Wk", (1, 1, 1)),
    ],
)
def test_postures_choose_weightings_and_factors(posture, weightings, factors):
    found = rate_record(measured(), posture=posture)
    names = weightings.split()
    assert [one.indices.weighting for one in found.axes] == names
    parts = [k * level(name, d) for k, name, d in zip(factors, names, "xyz", strict=True)]
    assert found.total.value == pytest.approx(math.hypot(*parts), rel=1e-3)
    assert found.total.remarks == ()
    assert find_posture(posture) in POSTURES


def test_a_vector_sum_of_what_is_there_says_what_it_lacks():
    found = rate_record(measured("yz"))
    assert found.total.value == pytest.approx(math.hypot(level("Wd", "y"), level("Wk", "z")), 1e-3)
    assert any("without x" in remark for remark in found.remarks)
    assert rate_record(measured("z")).total is None
    other = rate_record(measured(), weightings=["Wd", "Wd", "Wb"])
    assert any("z is weighted Wb, not Wk: not the vector sum" in r for r in other.remarks)
    assert other.axes[2].indices.a_wrms == pytest.approx(level("Wb", "z"), rel=1e-3)
    assert vector_sum({"x": 1.0, "z": 2.0}, {"x": 0.25, "y": 9.0, "z": 0.4}) == pytest.approx(
        math.hypot(0.25, 0.8)
    )
    assert vibration_total({"z": ("Wk", 1.0)}) is None


def test_mean_comfort_of_three_axes_and_the_vertical_part():
    """Steady tones: every block of 5 s, and so the 95th percentile, is the r.m.s."""
    found = rate_record(measured())
    parts = {"x": level("Wd", "x"), "y": level("Wd", "y"), "z": level("Wb_en12299", "z")}
    assert found.n_mv == pytest.approx(6 * math.hypot(*parts.values()), rel=1e-3)
    assert set(found.levels) == {"ISO 2631-1 Annex C", "EN 12299 mean comfort", "UIC 513"}
    z = found.axes[2]
    assert z.continuous.vertical_part == pytest.approx(6 * parts["z"], rel=1e-3)
    assert found.axes[1].continuous.vertical_part is None
    assert any("4 blocks of 5 s, fewer than 60" in r and "indicative" in r for r in found.remarks)


def test_with_z_alone_there_is_the_vertical_part_and_no_n_mv():
    found = rate_record(measured("z"))
    assert found.n_mv is None
    assert found.levels == {}
    (z,) = found.axes
    value = 6 * level("Wb_en12299", "z")
    assert z.continuous.vertical_part == pytest.approx(value, rel=1e-3)
    assert 2 < value < 2.5
    assert z.levels["EN 12299 mean comfort, vertical part"] == ["comfortable"]
    assert z.levels["UIC 513, vertical part"] == ["moderate comfort"]
    assert "EN 12299 mean comfort" not in z.levels
    assert "N_MV" not in found.table()
    assert "6 a_z,P95" in found.table()


def test_en_12299_has_its_own_weighting_whatever_the_axis_has():
    (own,) = rate_record(measured("z"), weightings=["Wb_en12299"]).axes
    (other,) = rate_record(measured("z"), weightings=["Wk"]).axes
    np.testing.assert_allclose(own.continuous.blocks, other.continuous.blocks, rtol=1e-12)


def test_five_minutes_are_enough_blocks():
    rng = np.random.default_rng(3)
    axes = tuple(Axis(d, d, (0.2 * rng.standard_normal(300 * 200),)) for d in "xyz")
    found = rate_record(AccelerationRecord("long", 200.0, (0.0,), axes))
    assert not any("indicative" in remark for remark in found.remarks)
    expected = []
    for one, name in zip(axes, ("Wd", "Wd", "Wb_en12299"), strict=True):
        weighted = apply_weighting(name, one.pieces[0], 200.0).reshape(60, 1000)
        expected.append(np.sort(np.sqrt(np.mean(weighted**2, axis=1))))
    # the 95th percentile of 60 lies 0.05 of the way from the 57th to the 58th
    squares = [(v[56] + 0.05 * (v[57] - v[56])) ** 2 for v in expected]
    assert found.n_mv == pytest.approx(6 * math.sqrt(sum(squares)), rel=1e-9)
    assert float(n_mv(*expected)) == pytest.approx(found.n_mv, rel=1e-9)


def test_continuous_comfort_classes_and_shares():
    """Blocks of 0.1, 0.25, 0.25, 0.35 and 0.5 m/s²; the limits are EN 12299's 0.2, 0.3, 0.4."""
    levels = np.array([0.1, 0.25, 0.25, 0.35, 0.5])
    weighted = np.repeat(levels, round(5 * RATE))
    z = continuous_comfort([weighted], RATE, "z")
    np.testing.assert_allclose(z.blocks, levels)
    assert z.classes == ("very comfortable", "comfortable", "comfortable", "medium",
                         "less comfortable")  # fmt: skip
    assert list(z.shares.values()) == pytest.approx([0.2, 0.4, 0.2, 0.2])
    assert z.levels["EN 12299 continuous comfort"] == list(z.shares)
    assert z.p95 == pytest.approx(0.35 + 0.8 * 0.15)
    backwards = continuous_comfort([weighted[::-1]], RATE, "z")
    assert (backwards.p95, backwards.shares) == (z.p95, z.shares)
    x = continuous_comfort([weighted], RATE, "x")
    assert (x.classes, x.shares, x.levels) == ((), {}, {})
    assert continuous_comfort([weighted[:1999]], RATE, "z") is None


def test_blocks_lie_inside_pieces():
    pieces = [np.full(round(s * RATE), a) for s, a in ((12.0, 0.1), (3.0, 9.0), (5.0, 0.3))]
    np.testing.assert_allclose(continuous_comfort(pieces, RATE, "y").blocks, [0.1, 0.1, 0.3])


def test_few_blocks_are_told_once():
    short, longer, enough = (
        continuous_comfort([np.ones(round(s * RATE))], RATE, "z") for s in (5, 20, 300)
    )
    assert few_blocks([None, enough]) == []
    assert few_blocks([short])[0].startswith("EN 12299: 1 block of 5 s")
    assert few_blocks([longer, short, None])[0].startswith("EN 12299: 1 to 4 blocks of 5 s")


def test_comfort_over_time():
    found = rate_record(measured("xz", (12.0, 7.0, 2.0), (3.0, 20.0, 40.0)))
    table = found.blocks()
    assert list(table) == [
        "start [s]", "ax Wd [m/s^2]", "az Wk [m/s^2]", "az Wb_en12299 [m/s^2]",
        "az EN 12299 comfort",
    ]  # fmt: skip
    assert table["start [s]"].tolist() == [3.0, 8.0, 20.0]
    np.testing.assert_allclose(table["az Wk [m/s^2]"], level("Wk", "z"), rtol=2e-3)
    expected = level("Wb_en12299", "z")
    np.testing.assert_allclose(table["az Wb_en12299 [m/s^2]"], expected, rtol=2e-3)
    assert table["az EN 12299 comfort"].tolist() == ["medium"] * 3
    seconds = found.blocks(2.0)
    assert list(seconds) == ["start [s]", "ax Wd [m/s^2]", "az Wk [m/s^2]"]
    assert seconds["start [s]"].tolist() == [3, 5, 7, 9, 11, 13, 20, 22, 24, 40]
    assert len(found.blocks(100.0)) == 0
    for duration in (0.0, -1.0, math.nan, 1e-6):
        with pytest.raises(InputError, match="block"):
            found.blocks(duration)


def test_the_table_holds_every_index_with_its_unit():
    found = rate_record(measured())
    table = found.table()
    assert table["column"].tolist() == ["ax", "ay", "az", "together"]
    z, together = table.iloc[2], table.iloc[3]
    for name, value in [
        ("a_rms [m/s^2]", found.axes[2].indices.a_rms),
        ("a_wrms [m/s^2]", found.axes[2].indices.a_wrms),
        ("MTVV [m/s^2]", found.axes[2].indices.mtvv),
        ("MTVV exponential [m/s^2]", found.axes[2].indices.mtvv_exp),
        ("VDV [m/s^1.75]", found.axes[2].indices.vdv),
        ("crest factor", found.axes[2].indices.crest_factor),
        ("Wz", found.axes[2].indices.wz),
        ("a_P95 [m/s^2]", found.axes[2].continuous.p95),
        ("6 a_z,P95", found.axes[2].continuous.vertical_part),
    ]:
        assert z[name] == value, name
    assert together["a_wrms [m/s^2]"] == found.total.value
    assert together["N_MV"] == found.n_mv
    assert together["weighting"] == "standing: k = 1, 1, 1"
    assert "UIC 513: " in together["comfort"]
    assert "<table" in found._repr_html_()


def test_every_scale_is_in_the_levels_of_a_result():
    found = rate_record(measured())
    named = set(found.levels).union(*(one.levels for one in found.axes))
    assert named == {scale.name for scale in SCALES}


def test_remarks_are_those_of_the_record_and_said_once_for_axes_that_share_them():
    found = rate_record(measured("xyz", (20.0, 2.0), (0.0, 30.0)))
    assert found.remarks[0] == "made for a test"
    (left,) = [remark for remark in found.remarks if "too short to be rated" in remark]
    assert left.startswith("ax, ay, az: 1 of 2 pieces")
    (table_3,) = [remark for remark in found.remarks if "Table 3" in remark]
    assert "Wd values" in table_3
    loud = rate_record(measured("z", loud=2.0)).remarks
    assert any("its last labels run backwards" in remark for remark in loud)


def test_axes_without_a_direction_or_with_the_same():
    record = tone(20.0, 1.0)
    unknown = AccelerationRecord("old", RATE, (0.0,), (Axis("a", None, (record,)),))
    (found,) = rate_record(unknown).axes
    assert (found.indices.weighting, found.indices.wz, found.continuous) == ("Wk", None, None)
    assert any("no direction is known" in remark for remark in rate_record(unknown).remarks)
    twice = AccelerationRecord(
        "two", RATE, (0.0,),
        (Axis("front", "z", (record,)), Axis("rear", "z", (record,)), Axis("y", "y", (record,))),
    )  # fmt: skip
    found = rate_record(twice)
    assert found.total is None
    assert any("z is recorded more than once" in remark for remark in found.remarks)
    assert found.axes[0].continuous.vertical_part == found.axes[1].continuous.vertical_part


def test_a_record_of_less_than_a_block():
    found = rate_record(measured("xyz", (3.0,)))
    assert found.n_mv is None
    assert all(one.continuous is None for one in found.axes)
    assert found.total is not None
    assert len(found.blocks()) == 0
    assert any("a few periods" in remark for remark in found.remarks)


def test_the_running_value_is_at_hand_for_a_picture():
    (z,) = rate_record(measured("z", (6.0, 7.0), (0.0, 10.0))).axes
    assert z.running is z.running
    for running, weighted in zip(z.running, z.indices.weighted, strict=True):
        np.testing.assert_array_equal(running, running_rms(weighted, RATE))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"weightings": ["Wk"]}, "weightings: found 1; expected one for each of the 3 axes"),
        ({"weightings": ["Wk", "Wk", "Wx"]}, "'Wx'"),
        ({"posture": "kneeling"}, "'kneeling'.*standing, seat, backrest, feet, recumbent"),
    ],
)
def test_what_cannot_be_asked_for(given, message):
    with pytest.raises(InputError, match=message):
        rate_record(measured(), **given)


def test_a_band_that_cannot_hold_the_weighting_is_told():
    axes = (Axis("z", "z", (np.sin(np.arange(3000.0)),)),)
    found = rate_record(AccelerationRecord("slow", 100.0, (0.0,), axes))
    assert any("nothing above 50 Hz" in remark for remark in found.remarks)
