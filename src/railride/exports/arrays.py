"""What the exports in numbers hold, by name: matrices, state space, names, units, parameters.

Arrays of names, units and meanings stand beside every axis: ``coordinates``, ``coordinate_units``
and ``coordinate_meanings`` beside the rows of M, C, K, K_w, C_w, B_f and the columns of M, C, K,
Y_a, Y_v, Y_d; ``elevations``, ``rates`` and ``forces`` beside the columns of K_w, Y_w, of C_w, Y_dw
and of B_f, Y_f; ``states``, ``inputs`` and ``outputs`` beside those of A, B, C_ss, D_ss, which are
the state space x' = A x + B u, y = C_ss x + D_ss u, u = (w, ẇ, f).

``parameters`` go with ``parameter_values``, ``parameter_units``, ``parameter_meanings`` and
``parameter_kinds``: "independent", "defined" by a formula of others, or "calculated" by railride,
which an export cannot. ``origin`` tells where the values are from, and remarks on them.
"""

from __future__ import annotations

from collections.abc import Iterable

from railride.exports import source
from railride.exports.content import Content, ParameterValue, Quantity
from railride.numeric import Array


def matrices(content: Content) -> dict[str, Array]:
    """M, C, K, K_w, C_w, B_f, Y_a, Y_v, Y_d, Y_w, Y_dw, Y_f, A, B, C_ss and D_ss."""
    s = content.system
    return {**content.numbers, "A": s.A, "B": s.B, "C_ss": s.C, "D_ss": s.D}


def texts(content: Content) -> dict[str, list[str]]:
    """Names, units and meanings along every axis and of the parameters, and the origin."""
    return {
        **names(content),
        **_named("parameter", content.parameters),
        "parameter_kinds": [_kind(p) for p in content.parameters],
        "origin": source.origin(content),
    }


def names(content: Content) -> dict[str, list[str]]:
    """Names, units and meanings along every axis."""
    axes = {**source.axes(content), "inputs": content.inputs}
    named = [_named(axis[:-1], quantities) for axis, quantities in axes.items()]
    s, units = content.system, {q.name: q.unit for q in content.coordinates}
    return {
        **{key: held for one in named for key, held in one.items()},
        "states": list(s.states),
        "state_units": [units.get(x) or f"{units[x.removeprefix('d')]}/s" for x in s.states],
    }


def _named(one: str, quantities: Iterable[Quantity]) -> dict[str, list[str]]:
    listed = list(quantities)
    return {
        f"{one}s": [q.name for q in listed],
        f"{one}_units": [q.unit for q in listed],
        f"{one}_meanings": [q.meaning for q in listed],
    }


def _kind(parameter: ParameterValue) -> str:
    if parameter.definition is not None:
        return "defined"
    return "calculated" if parameter.follows else "independent"
