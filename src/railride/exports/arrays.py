"""What the exports in numbers hold, by name: matrices, state space, names, units, parameters.

Arrays of names and units stand beside every axis: ``coordinates`` beside the rows of M, C, K, K_w,
C_w, B_f and the columns of M, C, K, Y_a, Y_v, Y_d; ``elevations`` and ``forces`` beside the columns
of K_w, C_w, Y_w, Y_dw and of B_f, Y_f; ``states``, ``inputs`` and ``outputs`` beside those of A, B,
C_ss, D_ss, which are the state space x' = A x + B u, y = C_ss x + D_ss u, u = (w, ẇ, f).
"""

from __future__ import annotations

from collections.abc import Iterable

from railride.exports.content import Content, Quantity
from railride.numeric import Array


def matrices(content: Content) -> dict[str, Array]:
    """M, C, K, K_w, C_w, B_f, Y_a, Y_v, Y_d, Y_w, Y_dw, Y_f, A, B, C_ss and D_ss."""
    s = content.system
    return {**content.numbers, "A": s.A, "B": s.B, "C_ss": s.C, "D_ss": s.D}


def names(content: Content) -> dict[str, list[str]]:
    """Names and units along every axis."""
    s = content.system
    units = {q.name: q.unit for q in content.coordinates}
    return {
        "coordinates": _names(content.coordinates),
        "coordinate_units": [q.unit for q in content.coordinates],
        "elevations": _names(content.elevations),
        "forces": _names(content.forces),
        "states": list(s.states),
        "state_units": [units.get(x) or f"{units[x.removeprefix('d')]}/s" for x in s.states],
        "inputs": _names(content.inputs),
        "input_units": [u.unit for u in content.inputs],
        "outputs": [output.name for output in content.outputs],
        "output_units": [output.unit for output in content.outputs],
    }


def _names(quantities: Iterable[Quantity]) -> list[str]:
    return [quantity.name for quantity in quantities]
