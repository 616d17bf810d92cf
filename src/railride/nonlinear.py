r"""The nonlinear equations of motion, integrated step by step: what linearisation leaves out.

Lagrange's equations are linear in the second rates of the coordinates that carry mass and in the
rates of those that carry none, together u:

.. math:: A(q, \dot q)\, u = b(q, \dot q, w, \dot w, f) , \qquad
          x = (q_I, q_m, \dot q_I), \quad \dot x = (\dot q_I, \dot q_m, \ddot q_I)

with the states as in ``railride.firstorder``. A and b come from the energies with symbols, become
functions once, and are integrated by the explicit Runge-Kutta method of order 8 with its error
controlled (Dormand and Prince's DOP853). Its twelve stages look at every period of 80 Hz: at rest
the steps would otherwise grow and grow, and pass over a bump that nothing had announced.

Source: E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
Springer 1993, II.5; of the equations ``railride.lagrange``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.errors import Faults, InputError
from railride.lagrange import Signal
from railride.numeric import Array
from railride.quantities import check_number, several
from railride.response import Response
from railride.statespace import chosen_outputs
from railride.toml_tables import shown
from railride.track import HIGHEST_HZ
from railride.vehicle import Output, VehicleModel

Under = Callable[[float], tuple[ArrayLike, ArrayLike]]


def simulate_nonlinear(
    model: VehicleModel,
    track: Under,
    times: ArrayLike,
    outputs: Output | str | Sequence[Output | str] | None = None,
    *,
    x0: ArrayLike | None = None,
    rtol: float = 1e-9,
    atol: float = 1e-12,
) -> Response:
    r"""Run the nonlinear vehicle over a track: outputs at the times, not linearised.

    Parameters
    ----------
    track : gives elevations w (m) and rates ẇ (m/s) under the wheelsets, each (wheelsets,), at a
        time in s. Make it smooth: every kink costs steps.
    times : (n,), s, ascending; the run begins at the first. The actuators rest.
    outputs : one or several, or their names; default: the floor's acceleration over the middle.
    x0 : (states,), the state at the first time, coordinates and rates as the linear state space
        orders them; at rest if not given.
    rtol, atol : tolerances of one step, relative and absolute (in the states' units).

    Returns
    -------
    Response : outputs (outputs, n) at the times, which count from the first.

    Raises
    ------
    InputError : times that do not ascend; a track of other shapes; a state of another length;
        tolerances that are not above zero; an output that does not exist or that feels the
        elevation's second rate; a run that leaves what the model can be (a body turned upright).

    Examples
    --------
    >>> from railride.vehicle import derive_vehicle
    >>> step = 10e-3 * np.ones(4), np.zeros(4)  # a coach set down 10 mm too low
    >>> model = derive_vehicle("cati2024", segments=1)
    >>> found = simulate_nonlinear(model, lambda t: step, np.linspace(0.0, 5.0, 6))
    >>> bool(abs(found.final_state[0] - 10e-3) < 1e-3)
    True
    """
    from scipy.integrate import solve_ivp

    t = np.array(several(times, "times", "s"))
    if t.size < 2 or not (np.isfinite(t).all() and (np.diff(t) > 0).all()):
        raise InputError("times: found none that ascend; expected two at least, in s, each after "
                         "the one before it")  # fmt: skip
    equations = NonlinearEquations(model, chosen_outputs(model, outputs))
    start = np.zeros(equations.states) if x0 is None else np.array(several(x0, "x0"))
    if start.shape != (equations.states,) or not np.isfinite(start).all():
        raise InputError(f"x0: found {start.size} numbers, {np.isfinite(start).sum()} of them "
                         f"finite; expected {equations.states} finite ones")  # fmt: skip
    _check(track, t[0], len(model.lagrangian.inputs), rtol, atol)

    def slope(time: float, x: Array) -> Array:
        return equations.slope(x, *track(time))

    with np.errstate(all="ignore"):  # told below
        try:
            run = solve_ivp(slope, (t[0], t[-1]), start, "DOP853", t, rtol=rtol, atol=atol,
                            max_step=1 / HIGHEST_HZ)  # fmt: skip
        except np.linalg.LinAlgError:
            run = None
        if run is None or not run.success or not np.isfinite(run.y).all():
            raise InputError("nonlinear run: found that it cannot be followed to its end; expected "
                             "motions that the vehicle can make (a smaller track?)")  # fmt: skip
        found = [equations.read(x, *track(time)) for time, x in zip(t, run.y.T, strict=True)]
    return Response(t - t[0], np.array(found).T, run.y[:, -1])


def _check(track: Under, start: float, wheelsets: int, rtol: float, atol: float) -> None:
    """The track's shapes, looked at once where the run begins, and the tolerances."""
    faults = Faults("nonlinear run")
    for name, tolerance in {"rtol": rtol, "atol": atol}.items():
        check_number(faults, name, tolerance, "> 0")
    if not callable(track):
        faults.add("track", shown(track), "a function of the time in s, which gives (w, dw)")
    else:
        found: object = track(start)
        shapes = [np.shape(u) for u in found] if isinstance(found, Iterable) else [()]
        if shapes != [(wheelsets,)] * 2:
            faults.add("track", f"arrays of shapes {', '.join(map(str, shapes))}",
                       f"w and dw, ({wheelsets},) each",
                       "one number for every wheelset, from the front")  # fmt: skip
    faults.raise_if_any()


class NonlinearEquations:
    """A vehicle's equations A u = b and outputs as functions of its state.

    model : the vehicle, its parameters put in as numbers. outputs : to be read.
    """

    def __init__(self, model: VehicleModel, outputs: Sequence[Output]) -> None:
        named = {f"{k}: {output.name}": output.expression for k, output in enumerate(outputs)}
        self.system = replace(model.lagrangian, outputs=named).written_out
        own = model.matrices().inertial
        q = self.system.coordinates
        self.inertial = [s for s, mass in zip(q, own, strict=True) if mass]
        self.massless = [s for s, mass in zip(q, own, strict=True) if not mass]
        self.states = len(q) + len(self.inertial)
        self._values = self._numbers(model)

    def _numbers(self, model: VehicleModel) -> dict[str, float]:
        symbols = set().union(*(u.free_symbols for u in self.system.outputs.values()))
        values = model.values_with(s for s in symbols if not isinstance(s, Signal))
        return {name: float(value) for name, value in values.items()}

    @cached_property
    def _arguments(self) -> list[sp.Symbol]:
        """What the functions take: the state, then w and ẇ."""
        w = self.system.inputs
        rates = [s.dot for s in self.inertial]
        return [*self.inertial, *self.massless, *rates, *w, *(s.dot for s in w)]

    @cached_property
    def _unknown(self) -> list[sp.Symbol]:
        return [s.dot for s in self.massless] + [s.ddot for s in self.inertial]

    def _function(self, expressions: Any, *more: sp.Symbol) -> Callable[..., Any]:
        """A function of the state, the track and ``more``, the parameters put in."""
        rest = dict.fromkeys(self.system.forces, 0)
        table = {s: self._values[s.name] for e in expressions for s in e.free_symbols
                 if not isinstance(s, Signal)}  # fmt: skip
        put_in = [e.xreplace({**rest, **table}) for e in expressions]
        function: Callable[..., Any] = sp.lambdify([*self._arguments, *more], put_in, "numpy",
                                                   cse=True)  # fmt: skip
        return function

    @cached_property
    def _balance(self) -> Callable[..., Any]:
        """The entries of A, row by row, then b."""
        equations = self.system.equations()
        still = dict.fromkeys(self._unknown, 0)
        A = equations.jacobian(self._unknown)
        return self._function([*A, *(-e.xreplace(still) for e in equations)])

    @cached_property
    def _outputs(self) -> Callable[..., Any]:
        return self._function(list(self.system.outputs.values()), *self._unknown)

    def _solved(self, x: Array, w: ArrayLike, dw: ArrayLike) -> Array:
        """The rates without mass, then the accelerations."""
        n = len(self._unknown)
        entries = np.array(self._balance(*x, *np.asarray(w), *np.asarray(dw)), dtype=float)
        return np.asarray(np.linalg.solve(entries[: n * n].reshape(n, n), entries[n * n :]))

    def slope(self, x: Array, w: ArrayLike, dw: ArrayLike) -> Array:
        """ẋ at a state, the elevations w (m) and rates ẇ (m/s) under the wheelsets."""
        return np.concatenate([x[-len(self.inertial) :], self._solved(x, w, dw)])

    def read(self, x: Array, w: ArrayLike, dw: ArrayLike) -> Array:
        """The outputs there."""
        u = self._solved(x, w, dw)
        return np.array(self._outputs(*x, *np.asarray(w), *np.asarray(dw), *u), dtype=float)
