"""The front of comfort against travel: against brute force and its own ends."""

import numpy as np
import pytest
from vehicles import paper_coach

from railride import (
    InputError,
    derive_vehicle,
    optimise,
    output_statistics,
    pareto_front,
    spectrum,
    weighting,
)
from railride.stochastic.ride import floor_in_hand, weighted_rms_of_many

SPEED = 200 / 3.6
RANGES = {"k_2": (4e5, 12e5), "c_2": (2e4, 2e5)}


def felt(model, k_2, c_2):
    """a_wrms and travel of many designs by the ride itself."""
    m, rows = floor_in_hand(model, [0.0], "smooth", {"k_2": k_2, "c_2": c_2})
    a, _ = weighted_rms_of_many(m, rows, model.vehicle.wheelset_positions, [SPEED],
                                spectrum("erri_low"), weighting("Wk"))  # fmt: skip
    names = ["secondary_1_deflection", "secondary_2_deflection"]
    travel = [
        output_statistics(model, SPEED, "erri_low", names, k_2=k, c_2=c)["expected peak"].max()
        for k, c in zip(k_2, c_2, strict=True)
    ]
    return a[:, 0, 0], np.array(travel)


def test_no_design_of_a_grid_beats_the_front_and_each_of_its_points_is_what_it_says():
    model = paper_coach(2)
    found = pareto_front(model, RANGES, SPEED, points=7)
    a, travel = felt(model, *found.parameters.T)
    np.testing.assert_allclose(found.a_wrms, a, rtol=1e-9)
    np.testing.assert_allclose(found.travel, travel, rtol=1e-9)
    assert (np.diff(found.travel) > 0).all()
    assert (np.diff(found.a_wrms) < 0).all()
    assert (found.residuals < 1e-4).all()
    k, c = (each.ravel() for each in np.meshgrid(np.geomspace(4e5, 12e5, 7),
                                                 np.geomspace(2e4, 2e5, 15)))  # fmt: skip
    a, travel = felt(model, k, c)
    for one, other in zip(a, travel, strict=True):
        better = (found.travel * (1 - 1e-6) > other) & (found.a_wrms * (1 - 1e-6) > one)
        assert not better.any()


def test_its_ends_are_the_most_comfortable_design_and_that_of_the_least_travel():
    model = paper_coach(2)
    found = pareto_front(model, RANGES, SPEED, points=5)
    best = optimise(model, RANGES, SPEED)
    assert found.a_wrms[-1] == pytest.approx(best.a_wrms, rel=1e-9)
    low, high = found.travel[0], found.travel[-1]
    tighter = low - 2e-3 * (high - low)
    with pytest.raises(InputError, match="best compromise"):
        optimise(model, RANGES, SPEED, limits={"secondary_travel": tighter}, starts=3)
    assert found.own == pytest.approx(
        (felt(model, [750e3], [70e3])[1][0], felt(model, [750e3], [70e3])[0][0]), rel=1e-9
    )
    table = found.table()
    assert list(table)[:4] == ["secondary_travel [m]", "a_wrms [m/s^2]", "k_2 [N/m]",
                               "c_2 [N s/m]"]  # fmt: skip


def test_limits_hold_all_along_the_front():
    model = derive_vehicle("manchester", 1)
    limits = {"damping_ratio": {"heave": 0.2}, "secondary_travel": 0.02}
    found = pareto_front(model, {"k_2": (5e5, 2e6), "c_2": (1e4, 2e5)}, SPEED, points=4,
                         against="wheel_load_variation", limits=limits, objective="worst",
                         at=[0.0, 8.0], floor="polygon")  # fmt: skip
    assert len(found.travel) >= 2
    for k_2, c_2 in found.parameters:
        zeta = c_2 / np.sqrt(2 * k_2 * model.vehicle.body.mass) / 1  # of heave on a stiff primary
        assert zeta > 0.19


def test_where_there_is_nothing_to_choose_one_design_is_left():
    """What is softer is better in both: travel of the primary suspension falls with k_1's rise."""
    model = derive_vehicle("ice3", 1)
    found = pareto_front(model, {"c_2": (1e4, 3e4)}, SPEED, points=4)
    a, travel = felt(model, np.full(50, 7e5), np.linspace(1e4, 3e4, 50))
    assert a.argmin() == travel.argmin()
    assert len(found.travel) == 1
    assert any("nothing to choose" in said for said in found.remarks)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"against": "secondary_static"}, ["against", "one of secondary_travel"]),
        ({"points": 1}, ["points", "from 2"]),
        ({"against": "wheel_load_variation"}, ["bogie.wheelset_mass"]),
        ({"limits": {"secondary_travel": 1e-3}}, ["best compromise", "widen"]),
    ],
)
def test_bad_input_is_told(options, words):
    with pytest.raises(InputError) as raised:
        pareto_front(paper_coach(1), RANGES, SPEED, **options)
    for word in words:
        assert word in str(raised.value)
