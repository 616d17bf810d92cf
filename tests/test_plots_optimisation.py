"""Pictures of an optimum and of the front."""

import numpy as np
import pytest
from vehicles import paper_coach

from railride import optimise, pareto_front
from railride.plots import (
    plot_optimum,
    plot_optimum_comfort,
    plot_optimum_limits,
    plot_optimum_parameters,
    plot_pareto,
)

RANGES = {"k_2": (4e5, 12e5), "c_2": (2e4, 2e5)}


@pytest.fixture(scope="module")
def found():
    limits = {"damping_ratio": {"heave": 0.15}, "secondary_static": (None, 0.3)}
    return optimise(paper_coach(1), RANGES, [40.0, 55.0], limits=limits)


def widths(ax):
    return [[bar.get_width() for bar in bars] for bars in ax.containers]


def test_comfort_shows_both_of_every_case(found):
    ax = plot_optimum_comfort(found)
    before, after = widths(ax)
    assert before == [case.before for case in found.cases_changed]
    assert after == [case.after for case in found.cases_changed]
    assert ax.get_xlabel() == "a_wrms [m/s²]"


def test_limits_show_what_is_used_of_them(found):
    ax = plot_optimum_limits(found)
    _, after = widths(ax)
    heave, static = found.limits
    assert after == pytest.approx([100 * 0.15 / heave.value, 100 * static.value / 0.3])
    weights = [label.get_fontweight() for label in ax.get_yticklabels()]
    assert weights == ["bold" if state.binds else "normal" for state in found.limits]
    assert [label.get_text() for label in ax.get_yticklabels()] == [
        "damping ratio of heave ≥ 15 %", "secondary static ≤ 300 mm",
    ]  # fmt: skip


def test_parameters_stand_within_their_ranges(found):
    ax = plot_optimum_parameters(found)
    marks = [line.get_xdata()[0] for line in ax.lines if line.get_marker() == "D"]
    assert marks == [change.place for change in found.changes]


def test_the_front_is_drawn_in_mm_beside_the_vehicle():
    front = pareto_front(paper_coach(1), RANGES, 55.0, points=3)
    ax = plot_pareto(front)
    x, y = ax.lines[0].get_data()
    np.testing.assert_allclose(x, 1e3 * front.travel)
    np.testing.assert_allclose(y, front.a_wrms)
    assert ax.lines[1].get_xdata() == pytest.approx([1e3 * front.own[0]])
    assert ax.get_xlabel() == "secondary travel [mm]"


def test_all_of_it_is_one_figure(found):
    assert len(plot_optimum(found).axes) == 3
