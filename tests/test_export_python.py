"""The export as Python source: run without railride, compared with the model's own numbers."""

from __future__ import annotations

import ast
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from export_cases import COACH, changed, close, content, every_body, independent

from railride.exports.content import content_of
from railride.exports.write import export_content
from railride.statespace import system_arrays
from railride.vehicle import derive_vehicle


@cache
def exported(kind):
    """The names of the module that is written of a vehicle."""
    text = export_content(content(kind), "python")
    nodes = [n for n in ast.walk(ast.parse(text)) if isinstance(n, (ast.Import, ast.ImportFrom))]
    assert {alias.name for node in nodes for alias in node.names} <= {"math", "numpy"}
    names: dict = {}
    exec(text, names)  # noqa: S102
    return names


@every_body
def test_matrices_at_the_vehicle_and_at_changed_parameters(kind):
    """With what follows by an algorithm as railride has it."""
    matrices = exported(kind)["matrices"]
    for own in (content(kind), changed(kind)):
        found = matrices(**independent(own))
        assert list(found) == list(own.matrices)
        for name, expected in own.numbers.items():
            assert close(found[name], expected), name
    assert not close(found["K"], content(kind).numbers["K"])


@every_body
def test_the_vehicle_is_the_default(kind):
    names = exported(kind)
    assert names["PARAMETERS"] == independent(content(kind))
    for name, found in names["matrices"]().items():
        assert close(found, content(kind).numbers[name]), name


@every_body
def test_state_space(kind):
    names, own = exported(kind), changed(kind)
    expected = system_arrays(own.model, own.outputs)
    assert list(names["STATES"]) == list(expected.states)
    assert list(names["INPUTS"]) == list(expected.inputs)
    assert list(names["OUTPUTS"]) == list(expected.outputs)
    found = names["state_space"](**independent(own))
    for name, A in zip("ABCD", found, strict=True):
        rows = np.abs(getattr(expected, name)).max(axis=1, keepdims=True)
        assert A.shape == getattr(expected, name).shape
        assert np.all(np.abs(A - getattr(expected, name)) <= 1e-10 * rows), name


def test_what_others_define_follows_them_unless_it_is_given():
    names, model = exported("beam"), content("beam").model
    assert list(names["DEFINED"]) == ["f_c1", "f_c2", "zeta_c1", "zeta_c2", "k_e1", "c_e1"]
    for changes in ({"f_e1": 7.0, "f_bending": 9.0}, {"k_e1": 5e6, "zeta_c2": 0.02}):
        found, expected = names["matrices"](**changes), model.matrices(**changes).by_name
        for name, A in expected.items():
            assert close(found[name], A), (name, changes)


@pytest.mark.parametrize("function", ["matrices", "state_space"])
def test_an_unknown_parameter_is_refused(function):
    with pytest.raises(TypeError, match="unknown parameters: k_3"):
        exported("rigid")[function](k_3=1.0)


def test_meanings_and_units_are_told():
    text = export_content(content("beam"), "python")
    assert '    "k_2": 750000.0,  # N/m, secondary stiffness per bogie\n' in text
    assert "# shape of mode 1, floor at 2.5 m\n" in text


def test_no_name_of_a_vehicle_ends_the_text():
    own = content_of(derive_vehicle(replace(COACH, name='"""\\N coach'), segments=1))
    names: dict = {}
    exec(export_content(own, "python"), names)  # noqa: S102
    assert names["__doc__"].startswith("____N coach: a rigid car body")
