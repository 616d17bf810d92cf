"""Tornado plots show what they are given."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from vehicles import paper_coach

from railride.errors import InputError
from railride.plots import plot_tornado, plot_tornadoes
from railride.sensitivities import sensitivity


@cache
def found():
    return sensitivity(paper_coach(2, bending_damping=0.01), [40.0, 55.0], "erri_low", [0.0, 4.0])


def test_bars_and_diamonds_are_the_effects_the_largest_on_top():
    ax = plot_tornado(found(), 2)
    order = found().ranked(2)[::-1]
    less, more = ax.containers
    for side, bars in enumerate((less, more)):
        widths = [bar.get_width() for bar in bars]
        np.testing.assert_allclose(widths, 100 * found().effects[1, 0, order, side], rtol=1e-12)
    (diamonds,) = [line for line in ax.lines if line.get_marker() == "D"]
    np.testing.assert_allclose(diamonds.get_xdata(),
                               100 * found().linear_effects[1, 0, order].T.ravel())  # fmt: skip
    names = [label.get_text().replace("\n", " ") for label in ax.get_yticklabels()]
    assert names[-1].startswith(found().parameters[order[-1]].meaning.split(",")[0])
    assert "I_b" not in " ".join(names)  # not felt at all
    assert ax.get_xlabel() == "change of a_wrms [%]"
    assert ax.get_title(loc="left").startswith("198 km/h, x = 0 m: a_wrms")
    assert [text.get_text() for text in ax.get_legend().texts] == [
        "by its gradient", "10 % less of it", "10 % more of it"]  # fmt: skip
    assert ax.get_legend().get_title().get_text() == "held: bending frequency"


def test_the_most_important_alone():
    ax = plot_tornado(found(), most=3)
    assert len(ax.containers[0]) == 3


def test_every_case_has_axes_of_one_scale():
    figure = plot_tornadoes(found())
    drawn = [ax for ax in figure.axes if ax.axison]
    assert len(drawn) == 4
    assert len({ax.get_xlim() for ax in drawn}) == 1
    assert figure.get_suptitle().endswith("held: bending frequency")


@pytest.mark.parametrize("case", [-1, 4])
def test_a_case_that_there_is_not(case):
    with pytest.raises(InputError, match="case: found"):
        plot_tornado(found(), case)
