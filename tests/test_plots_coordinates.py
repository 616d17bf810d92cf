"""Pictures of the coordinates: every symbol of the equations is there, nothing lies outside."""

from dataclasses import replace

import pytest
from vehicles import paper_coach, random_vehicle

from railride import (
    derive_vehicle,
    load_vehicle,
    plot_body_coordinates,
    plot_coordinates,
    plot_half_body,
)
from railride.markup import math
from railride.parameters import Equipment
from railride.plots.canvas import new_figure, save


def symbols(ax):
    """What the labels say, without dollars and with one kind of braces."""
    return (
        " , ".join(t.get_text() for t in ax.texts if t.get_text()).replace("{", "").replace("}", "")
    )


def written(s):
    return math(s).replace("{", "").replace("}", "")


def hung_coach():
    hung = (Equipment(2000.0, 2.0, frequency=8.0, damping_ratio=0.1),)
    return derive_vehicle(replace(load_vehicle("cati2024"), equipment=hung), 4)


MODELS = {
    "rigid": lambda: paper_coach(1),
    "halves": lambda: paper_coach(2),
    "four": lambda: paper_coach(4),
    "equipment": hung_coach,
    "three axles": lambda: derive_vehicle(random_vehicle(1), 3),
}


@pytest.mark.parametrize("kind", MODELS)
def test_every_coordinate_input_and_force_is_drawn(kind):
    model = MODELS[kind]()
    system, shown = model.lagrangian, symbols(plot_coordinates(model))
    pitches = [u for u in system.kinematics if u.name.startswith("theta")]
    for s in (*system.coordinates, *system.inputs, *system.forces, *pitches):
        assert f"${written(s)}$" in shown, s


def test_the_body_alone_has_no_bogies():
    shown = symbols(plot_body_coordinates(paper_coach(4)))
    assert all(f"$z_{i}$" in shown for i in range(5))
    assert r"$k_\theta,\, c_\theta$" in shown
    assert "z_b" not in shown
    assert "w_1" not in shown


def test_of_many_segments_the_first_the_middle_and_the_last_are_named():
    shown = symbols(plot_coordinates(paper_coach(20)))
    for i in (0, 10, 20):
        assert f"$z_{i}$" in shown
    assert "$z_5$" not in shown
    modal = derive_vehicle("cati2024", body="beam", modes=2)
    assert r"\eta_1" in symbols(plot_coordinates(modal))


@pytest.mark.parametrize("free", [False, True])
def test_the_papers_two_halves(free, tmp_path):
    ax = plot_half_body(free)
    shown = symbols(ax)
    for s in (r"\vec r_F", r"\vec r_R", r"k_\theta", r"\theta", "m_h, L_h", "O", "x", "z"):
        assert f"${s}$" in shown
    save(ax, tmp_path / "a.svg")
    save(plot_half_body(free), tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize("kind", MODELS)
def test_nothing_lies_outside_of_the_axes(kind):
    for draw in (plot_coordinates, plot_body_coordinates):
        ax = draw(MODELS[kind]())
        left, right = ax.get_xlim()
        low, high = ax.get_ylim()
        for text in ax.texts:
            x, z = text.get_position()
            assert left < x < right, text
            assert low < z < high, text


def test_axes_may_be_given():
    ax = new_figure(6, 3).add_subplot()
    assert plot_coordinates(paper_coach(1), ax=ax) is ax
    assert plot_body_coordinates(paper_coach(1), ax=ax) is ax
    assert plot_half_body(True, ax=ax) is ax
