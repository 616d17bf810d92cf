"""The export as Python source: run without railride, compared with the model's own numbers."""

from __future__ import annotations

import ast
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from vehicles import random_vehicle

from railride.exports.content import content_of
from railride.exports.write import export_content
from railride.parameters import Equipment, Load, load_vehicle
from railride.statespace import system_arrays
from railride.vehicle import Output, derive_vehicle

COACH = load_vehicle("cati2024")
MOUNTED = replace(COACH, bogies=tuple(
    replace(b, primary_damper_stiffness=2e6, secondary_damper_stiffness=12e6)
    for b in COACH.bogies
))  # fmt: skip
HUNG = Equipment(1500.0, 1.7, frequency=8.8, damping_ratio=0.12)
CARRIED = replace(COACH, payload=(Load(3000.0), Load(1000.0, 5.0, 2.0)), equipment=(HUNG,))
BODIES = {
    "rigid": (COACH, {"segments": 1}),
    "segments": (random_vehicle(3), {"segments": 3}),
    "mounts": (MOUNTED, {"segments": 2}),
    "beam": (CARRIED, {"body": "beam", "modes": 2, "bending_damping": 0.01}),
    "fe": (COACH, {"body": "fe", "modes": 2}),
}
every_body = pytest.mark.parametrize("kind", BODIES)


@cache
def exported(kind):
    """A model, its content, and the names of the module that is written of it."""
    vehicle, body = BODIES[kind]
    content = content_of(derive_vehicle(vehicle, **body), at=[0.0, 2.5])
    model = content.model
    more = [model.floor(1.0, derivative=1)]
    more += [Output(f"d{d.name}", d.dot, "m/s", "") for d in model.running_gear.strokes]
    content = replace(content, outputs=(*content.outputs, *more))
    names: dict = {}
    exec(text_of(content), names)  # noqa: S102
    return content, names


def text_of(content):
    text = export_content(content, "python")
    nodes = [n for n in ast.walk(ast.parse(text)) if isinstance(n, (ast.Import, ast.ImportFrom))]
    assert {alias.name for node in nodes for alias in node.names} <= {"math", "numpy"}
    return text


def changed(content):
    """The same with every parameter changed that may change, by a few per cent each."""
    own = {p.symbol.name: p.value for p in content.model.parameters}
    fixed = "L", "e_c", "I_c", "r_c"  # with them the distribution of the mass may become impossible
    changes = {name: value * (1 + 0.01 * np.sin(k + 1)) for k, (name, value)
               in enumerate(own.items()) if name not in fixed}  # fmt: skip
    return replace(content, model=content.model.changed(**changes))


def close(found, expected):
    scale = np.abs(expected).max(initial=0.0)
    return (
        found.shape == expected.shape and np.abs(found - expected).max(initial=0) <= 1e-12 * scale
    )


@every_body
def test_matrices_at_the_vehicle_and_at_changed_parameters(kind):
    """With what follows by an algorithm as railride has it."""
    content, names = exported(kind)
    for own in (content, changed(content)):
        values = {p.name: p.value for p in own.parameters if p.name in names["PARAMETERS"]}
        found = names["matrices"](**values)
        assert list(found) == list(own.matrices)
        for name, expected in own.numbers.items():
            assert close(found[name], expected), name
    assert not close(found["K"], content.numbers["K"])


@every_body
def test_the_vehicle_is_the_default(kind):
    content, names = exported(kind)
    for name, found in names["matrices"]().items():
        assert close(found, content.numbers[name]), name


@every_body
def test_state_space(kind):
    content, names = exported(kind)
    own = changed(content)
    values = {p.name: p.value for p in own.parameters if p.name in names["PARAMETERS"]}
    expected = system_arrays(own.model, own.outputs)
    assert list(names["STATES"]) == list(expected.states)
    assert list(names["INPUTS"]) == list(expected.inputs)
    assert list(names["OUTPUTS"]) == list(expected.outputs)
    for name, found in zip("ABCD", names["state_space"](**values), strict=True):
        A = getattr(expected, name)
        rows = np.abs(A).max(axis=1, keepdims=True)
        assert found.shape == A.shape
        assert np.all(np.abs(found - A) <= 1e-10 * rows), name


def test_what_others_define_follows_them_unless_it_is_given():
    content, names = exported("beam")
    model = content.model
    assert list(names["DEFINED"]) == ["f_c1", "f_c2", "zeta_c1", "zeta_c2", "k_e1", "c_e1"]
    for changes in ({"f_e1": 7.0, "f_bending": 9.0}, {"k_e1": 5e6, "zeta_c2": 0.02}):
        found, expected = names["matrices"](**changes), model.matrices(**changes).by_name
        for name, A in expected.items():
            assert close(found[name], A), (name, changes)


def test_an_unknown_parameter_is_refused():
    _, names = exported("rigid")
    with pytest.raises(TypeError, match="unknown parameters: k_3"):
        names["matrices"](k_3=1.0)
    with pytest.raises(TypeError, match="unknown parameters: k_3"):
        names["state_space"](k_3=1.0)


def test_meanings_and_units_are_told():
    text = export_content(exported("beam")[0], "python")
    assert '    "k_2": 750000.0,  # N/m, secondary stiffness per bogie\n' in text
    assert "# shape of mode 1, floor at 2.5 m\n" in text


def test_no_name_of_a_vehicle_ends_the_text():
    vehicle = replace(COACH, name='"""\\N coach')
    content = content_of(derive_vehicle(vehicle, segments=1))
    names: dict = {}
    exec(export_content(content, "python"), names)  # noqa: S102
    assert names["__doc__"].startswith("____N coach: a rigid car body")
