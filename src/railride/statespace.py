r"""The linear vehicle as a state space, x' = A x + B u, y = C x + D u.

With elevations and rates as inputs, x = (q, q̇) and u = (w, ẇ, f). With elevations alone, the damper
forces C_w ẇ are absorbed by the state, x = (q, q̇ - M⁻¹ C_w w) and u = (w, f):

.. math:: \dot x_1 = x_2 + M^{-1} C_w w, \qquad
          \dot x_2 = M^{-1} (K_w w + B_f f - K x_1 - C (x_2 + M^{-1} C_w w))

which is exact, but holds only outputs that do not feel ẇ directly. Start it at x_2 = -M⁻¹ C_w w(0):
from zero state, w(0) ≠ 0 would be an impulse.

Source: the linear equations of motion (see ``railride.linear``), solved for q̈.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.firstorder import first_order
from railride.numeric import Array
from railride.quantities import names
from railride.vehicle import Output, VehicleModel

if TYPE_CHECKING:
    import control

INPUTS = ("rates", "elevation")


@dataclass(frozen=True)
class System:
    """A, B, C, D as arrays, with the names of states, inputs and outputs in their order."""

    A: Array
    B: Array
    C: Array
    D: Array
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]


def system_arrays(
    model: VehicleModel,
    outputs: Output | str | Sequence[Output | str] | None = None,
    inputs: str = "rates",
    **changes: ArrayLike,
) -> System:
    """The state space as plain arrays; arguments as for :func:`state_space`."""
    if inputs not in INPUTS:
        raise InputError(f"inputs: found {inputs!r}; expected one of {', '.join(INPUTS)}")
    chosen = chosen_outputs(model, outputs)
    m, Y = model.matrices(**changes), model.output_rows(chosen, **changes)
    _refuse_second_rates(Y["ddw"], chosen)
    x = first_order(m)
    q = [model.linear.coordinates[k].name for k in x.order]
    dq = [q.name for q, own in zip(model.linear.coordinates, x.inertial, strict=True) if own]
    force = np.hstack([m.K_w, m.C_w, m.B_f])  # columns u = (w, ẇ, f)
    A, B = x.A, x.B @ force
    C = Y["d"] @ x.q_x + Y["v"] @ x.v_x + Y["a"] @ x.a_x
    D = np.hstack([Y["w"], Y["dw"], Y["f"]]) + (Y["v"] @ x.v_f + Y["a"] @ x.a_f) @ force
    w, f = [s.name for s in model.linear.inputs], [s.name for s in model.linear.forces]
    rates = [f"d{name}" for name in w]
    states = [*q, *(f"d{name}" for name in dq)]
    if inputs == "elevation":
        k = len(w)
        _refuse_direct_rates(D[:, k : 2 * k], D, [o.name for o in chosen])
        G = B[:, k : 2 * k]  # x = state + G w takes ẇ out: state' = A x + B_w w
        keep = [*range(k), *range(2 * k, B.shape[1])]
        B, D = B[:, keep], D[:, keep]
        B[:, :k] += A @ G
        D[:, :k] += C @ G
        rates = []
        states = [*q, *(f"d{name}_less_track" for name in dq)]
    return System(A, B, C, D, tuple(states), (*w, *rates, *f), tuple(o.name for o in chosen))


def state_space(
    model: VehicleModel,
    outputs: Output | str | Sequence[Output | str] | None = None,
    inputs: str = "rates",
    **changes: ArrayLike,
) -> control.StateSpace:
    """The vehicle as a ``control.StateSpace`` with named states, inputs and outputs.

    Parameters
    ----------
    outputs : one or several, or their names (``model.outputs``, ``model.floor(...)``); default: the
        floor's acceleration over the middle.
    inputs : "rates": u = (w, ẇ, f), named w_1 …, dw_1 …, f_1 …, in m, m/s and N; "elevation":
        u = (w, f), for outputs that do not feel ẇ directly.
    changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : an output that does not exist, or that feels ẇ directly while ``inputs`` is
        "elevation"; arrays of parameters.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> plant = state_space(derive_vehicle(load_vehicle("cati2024"), segments=2))
    >>> plant.nstates, plant.input_labels[:2], plant.output_labels
    (14, ['w_1', 'w_2'], ['floor_acceleration'])
    """
    import control

    s = system_arrays(model, outputs, inputs, **changes)
    return control.ss(s.A, s.B, s.C, s.D, states=list(s.states), inputs=list(s.inputs),
                      outputs=list(s.outputs), name=model.vehicle.name)  # fmt: skip


def chosen_outputs(
    model: VehicleModel, outputs: Output | str | Sequence[Output | str] | None = None
) -> list[Output]:
    """One output or several, by name or as they are; the floor's acceleration at x = 0 if None.

    Raises
    ------
    InputError : a name that is not among the model's outputs, which the message lists.
    """
    known = {"floor_acceleration": None, **model.outputs}
    chosen = []
    if outputs is None:
        outputs = "floor_acceleration"
    for output in [outputs] if isinstance(outputs, Output) else names(outputs, "outputs"):
        if not isinstance(output, Output) and output not in known:
            raise InputError(f"output: found {output!r}; expected one of {', '.join(known)}, or a "
                             "point of the floor from model.floor(at=…)")  # fmt: skip
        if isinstance(output, Output):
            chosen.append(output)
        else:
            chosen.append(known[output] or model.floor())
    named = [output.name for output in chosen]
    twice = sorted({name for name in named if named.count(name) > 1})
    if twice:
        raise InputError(f"outputs: found {', '.join(twice)} twice; expected each once")
    return chosen


def _refuse_second_rates(rows: Array, outputs: Sequence[Output]) -> None:
    """Refuse outputs that feel the second rate of the elevation, as a wheel load does."""
    named = [o.name for o, row in zip(outputs, rows, strict=True) if row.any()]
    if named:
        raise InputError(
            f"outputs: found {', '.join(named)}, which feel the second rate of the track elevation "
            "through the wheelsets' mass; expected outputs that elevations and rates determine "
            "(take them in the frequency domain, where the low-pass that they need is stated)"
        )


def _refuse_direct_rates(direct: Array, D: Array, outputs: Sequence[str]) -> None:
    """Refuse outputs whose acceleration feels the rate of the elevation through a damper."""
    felt = np.abs(direct).max(axis=1) > 1e-9 * np.abs(D).max(initial=0.0)
    if felt.any():
        named = ", ".join(name for name, is_felt in zip(outputs, felt, strict=True) if is_felt)
        raise InputError(
            f"outputs: found {named} with elevations alone as inputs; expected outputs that do not "
            "feel the track's rate directly: the primary dampers push the bogies with c_1 dw/dt, "
            'which no state can hold (use inputs="rates")'
        )
