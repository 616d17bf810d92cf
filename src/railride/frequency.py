r"""Frequency response to the track, every wheelset with its exact delay, and to actuators.

.. math:: (K - \omega^2 M + i\omega C)\, q = (K_w + i\omega C_w)\, w + B_f f

w holds the elevations under the wheelsets. Of a track, w_j = e^{-iωl_j/V} times the elevation under
the leading wheelset, l_j the distance of wheelset j behind it; of a single wheelset, the others
rest. With the complex Schur form A = Q T Q* of x' = A x the system is triangular at every
frequency, and is solved row by row for many frequencies together; no eigenvectors, so repeated and
nearly repeated poles do no harm, and no polynomials.

Rounding moves the poles by ε max|λ|, so that beside a pole the solution loses ε max|λ|/|iω - λ|.
Where that tells, one step of iterative refinement on the equation above gives it back; on a pole
there is nothing to give, and the frequency is refused.

Source: the equations of motion; A.J. Laub, IEEE Trans. Autom. Control 26 (1981) 407-408, with the
Schur in place of the Hessenberg form; N.J. Higham, Accuracy and Stability of Numerical Algorithms,
2nd ed., SIAM 2002, Chapter 12 (refinement).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError
from railride.firstorder import first_order
from railride.modal import refuse_unstable
from railride.numeric import Array, Matrices
from railride.quantities import names
from railride.spectra import check_speed
from railride.statespace import chosen_outputs
from railride.vehicle import Output, VehicleModel

if TYPE_CHECKING:
    import control

Complex = NDArray[np.complex128]

TRACK, FLOOR = "track", "floor_acceleration"
BAND_HZ, POINTS = (0.2, 40.0), 2000  # where a ride is looked at
_TOGETHER = 1000  # frequencies at a time: what the processor keeps close by
_TELLS, _DECIDES = 1e-12, 1e-6  # relative errors of a response that are refined, and refused


@dataclass(frozen=True)
class Triangular:
    """q = left (iω - T)⁻¹ right F of one vehicle, T upper triangular with the poles as diagonal.

    T : (s, s). left : (n, s). right : (s, n). All complex.
    """

    T: Complex
    left: Complex
    right: Complex

    def solve(self, omega: Array, force: Complex) -> Complex:
        """q of (K - ω² M + iω C) q = F at every ω: shapes (n, F) from (F,) and (n, F)."""
        return np.asarray(self.left @ self.states(1j * omega, self.right @ force))

    def states(self, s: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
        """(s - T)⁻¹ y at every s, written over y: shapes (F,) and (states, F)."""
        for i in range(len(y) - 1, -1, -1):
            y[i] += self.T[i, i + 1 :] @ y[i + 1 :]
            y[i] /= s - self.T[i, i]
        return y

    def adjoint(self, s: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
        """x of xᵀ (s - T) = yᵀ at every s, written over y: shapes (F,) and (states, F)."""
        for i in range(len(y)):
            y[i] += self.T[:i, i] @ y[:i]
            y[i] /= s - self.T[i, i]
        return y


def triangular(m: Matrices) -> Triangular:
    """The triangular form of one vehicle's matrices.

    Raises
    ------
    InputError : several vehicles at once; an unstable vehicle, which has no frequency response.
    """
    from scipy.linalg import schur

    x = first_order(m)
    n, states = x.q_x.shape
    own = np.flatnonzero(x.inertial)
    scale = np.ones(states)  # displacements times a typical ω are of the size of their rates
    scale[:n] = np.sqrt(np.abs(x.a_x[own] @ x.q_x.T).max())
    T, Q = schur(scale[:, np.newaxis] * x.A / scale, output="complex")
    refuse_unstable(np.diagonal(T))
    return Triangular(T, (x.q_x / scale) @ Q, Q.conj().T @ (scale[:, np.newaxis] * x.B))


def track_response(
    model: VehicleModel,
    outputs: Output | str | Sequence[Output | str],
    speed: float,
    frequency: ArrayLike,
    **changes: ArrayLike,
) -> Complex:
    """Response of outputs to the elevation under the leading wheelset.

    Parameters
    ----------
    outputs : the outputs y, see ``VehicleModel.outputs`` and ``VehicleModel.floor``.
    speed : V in m/s, > 0. frequency : in Hz, shape (F,), > 0.

    Returns
    -------
    array : shape (outputs, F), in the output's unit per metre.
    """
    return responses(model, outputs, [TRACK], frequency, speed=speed, **changes)[:, 0]


def responses(
    model: VehicleModel,
    outputs: Output | str | Sequence[Output | str] | None,
    sources: Sequence[str],
    frequency: ArrayLike,
    *,
    speed: float | None = None,
    **changes: ArrayLike,
) -> Complex:
    """Response of every output to every source, shape (outputs, sources, F).

    Arguments as for :func:`frequency_response`; the frequencies in any order.
    """
    omega = 2 * np.pi * check_frequency(frequency)
    if outputs is None or isinstance(outputs, Output | str):
        outputs = [FLOOR if outputs is None else outputs]
    # One by one: a name may come twice here, where nothing is called by its name.
    chosen = [chosen_outputs(model, y)[0] for y in outputs]
    excite = [_excitation(model, source, speed, changes) for source in sources]
    m, Y = model.matrices(**changes), model.output_rows(chosen, **changes)
    form = triangular(m)
    lost = _lost(form, omega)
    _refuse_poles(omega[lost > _DECIDES])
    out = [(k, Y[rows] @ form.left) for k, rows in enumerate("dva") if Y[rows].any()]
    found = np.zeros((len(chosen), len(sources), omega.size), dtype=complex)
    for start in range(0, omega.size, _TOGETHER):
        some = slice(start, start + _TOGETHER)
        s = np.asarray(1j * omega[some], dtype=complex)
        for k, (delays, gain, force) in enumerate(excite):
            w = gain[:, np.newaxis] * np.exp(-np.outer(delays, s))
            f = np.repeat(force[:, np.newaxis], s.size, axis=1)
            y = _states(form, m, s, m.K_w @ w + s * (m.C_w @ w) + m.B_f @ f, lost[some])
            direct = Y["w"] @ w + s * (Y["dw"] @ w) + s**2 * (Y["ddw"] @ w) + Y["f"] @ f
            found[:, k, some] = direct + sum(s**power * (rows @ y) for power, rows in out)
    return found


def _lost(form: Triangular, omega: Array) -> Array:
    """ε max|λ|/|iω - λ| of the nearest pole that is so lightly damped that it may tell: (F,)."""
    poles = np.diagonal(form.T)
    moved = np.finfo(float).eps * np.abs(poles).max()
    light = poles[(poles.imag > 0) & (np.abs(poles.real) < moved / _TELLS)]
    away = np.full(omega.size, np.inf)
    for pole in light:
        away = np.minimum(away, np.abs(1j * omega - pole))
    return np.asarray(moved / np.maximum(away, moved))


def _states(form: Triangular, m: Matrices, s: Complex, F: NDArray[Any], lost: Array) -> Complex:
    """The states under forces F (n, F), refined where ``lost`` tells: (states, F)."""
    y = form.states(s, form.right @ F)
    near = np.flatnonzero(lost > _TELLS)
    if near.size:
        s, q = s[near], form.left @ y[:, near]
        rest = F[:, near] - (m.K @ q + s * (m.C @ q) + s**2 * (m.M @ q))
        y[:, near] += form.states(s, form.right @ rest)
    return y


def _refuse_poles(omega: Array) -> None:
    """Raise InputError for frequencies at which an undamped mode answers without limit."""
    if omega.size:
        found = ", ".join(f"{x / (2 * np.pi):.6g}" for x in omega[:5])
        raise InputError(
            f"frequency: found {found} Hz, where a mode without damping lies: it answers without "
            "limit; expected other frequencies, or a damping above 0 (of the suspension, or of the "
            "body in bending)"
        )


def frequency_response(
    model: VehicleModel,
    outputs: Output | str | Sequence[Output | str] | None = None,
    frequency: ArrayLike | None = None,
    *,
    speed: float | None = None,
    source: str | Sequence[str] = TRACK,
    **changes: ArrayLike,
) -> control.FrequencyResponseData:
    """Frequency response as ``control.FrequencyResponseData``, its signals named.

    Parameters
    ----------
    outputs : one or several, or their names (``model.outputs``, ``model.floor(...)``); default: the
        floor's acceleration over the middle.
    frequency : in Hz, ascending, > 0; default 2,000 from 0.2 to 40 Hz. (python-control counts in
        rad/s: ``response.omega``.)
    speed : V in m/s, > 0; needed for the track, without effect on other sources.
    source : "track", the elevation under the leading wheelset, all wheelsets with exact delays;
        "w_1" …, the elevation under one wheelset; "f_1" …, an actuator; or several of them.
    changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : frequencies that are none, not ascending or doubled; one on the line of a mode
        without damping; a track without a speed; an output or a source that does not exist, or is
        named twice; an unstable vehicle.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> response = frequency_response(coach, frequency=[1.0, 2.0, 9.6], speed=200 / 3.6)
    >>> response.input_labels, response.output_labels, response.frdata.shape
    (['track'], ['floor_acceleration'], (1, 1, 3))
    """
    import control

    f = check_ascending(np.geomspace(*BAND_HZ, POINTS) if frequency is None else frequency)
    sources = names(source, "source")
    chosen = chosen_outputs(model, outputs)
    if len(set(sources)) < len(sources):
        raise InputError(f"source: found {', '.join(map(str, sources))}; expected none twice")
    found = responses(model, chosen, sources, f, speed=speed, **changes)
    return control.FrequencyResponseData(
        found, 2 * np.pi * f, inputs=sources, outputs=[output.name for output in chosen],
        name=_plain(model.vehicle.name),
    )  # fmt: skip


def wheelset_delays(model: VehicleModel, speed: float, **changes: ArrayLike) -> Array:
    """l_j/V of every wheelset, s, from the leading one."""
    places = model.wheelset_places(**changes)
    return np.asarray((places[0] - places) / speed)


def _excitation(
    model: VehicleModel, source: str, speed: float | None, changes: Mapping[str, ArrayLike]
) -> tuple[Array, Array, Array]:
    """Delay, s, and gain of every wheelset's elevation, and the forces: what a source of 1 does."""
    wheelsets = [w.name for w in model.lagrangian.inputs]
    forces = [f.name for f in model.lagrangian.forces]
    rest, idle = np.zeros(len(wheelsets)), np.zeros(len(forces))
    if source == TRACK:
        if speed is None:
            raise InputError("speed: found none; expected a speed above zero, in m/s: the track "
                             "reaches the wheelsets one after another")  # fmt: skip
        check_speed(speed)
        return wheelset_delays(model, speed, **changes), rest + 1.0, idle
    if source not in (*wheelsets, *forces):
        raise InputError(f"source: found {source!r}; expected one of "
                         f"{', '.join([TRACK, *wheelsets, *forces])}")  # fmt: skip
    return (
        rest,
        np.array([float(source == w) for w in wheelsets]),
        np.array([float(source == f) for f in forces]),
    )


def check_frequency(frequency: ArrayLike) -> Array:
    """Frequencies as an array (F,); InputError unless all are finite and above zero."""
    try:
        f = np.asarray(frequency, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"frequency: found {frequency!r}; expected numbers, in Hz") from None
    wrong = f[~(np.isfinite(f) & (f > 0))] if f.ndim == 1 else f
    if f.ndim != 1 or f.size == 0 or wrong.size:
        found = f"{wrong[0]:g} Hz" if f.ndim == 1 and wrong.size else f"an array of shape {f.shape}"
        raise InputError(f"frequency: found {found}; expected a list of finite frequencies above "
                         "zero, in Hz")  # fmt: skip
    return f


def check_ascending(frequency: ArrayLike) -> Array:
    """Frequencies as an array (F,); InputError unless above zero, ascending and each there once."""
    f = check_frequency(frequency)
    if (np.diff(f) <= 0).any():
        k = int(np.argmax(np.diff(f) <= 0))
        raise InputError(f"frequency: found {f[k + 1]:g} Hz after {f[k]:g} Hz; expected them in "
                         "ascending order, each once")  # fmt: skip
    return f


def _plain(name: str) -> str:
    """A name that python-control takes: no dot in it."""
    return name.replace(".", "_")
