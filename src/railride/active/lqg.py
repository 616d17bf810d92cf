r"""LQG control of the secondary suspension: a Kalman filter on accelerometers and optimal feedback.

The controller minimises, on a track of white noise shaped as ERRI B176 shapes it,

.. math:: E\left[\frac1m \sum_i \frac{a_{w,i}^2}{\bar a^2} + \frac1n \sum_b \frac{s_b^2}{\bar s^2}
          + \frac1n \sum_b \frac{f_b^2}{\bar f^2}\right], \qquad
          \ddot w_j = -(\omega_r + \omega_c) \dot w_j - \omega_r \omega_c w_j + \xi_j,

with the weighted acceleration a_w of the floor at m points, the travel s_b and the forces f_b asked
of the n actuators, each over a size that is still acceptable (Bryson's rule), and ω = VΩ of the
spectrum's two poles. The design takes the wheelsets' noises ξ_j as independent: their delays are no
part of a finite state; the rating has them exact. LQG has no margins of its own (J.C. Doyle, IEEE
Trans. Autom. Control 23 (1978) 756-757): see :attr:`Loop.modulus_margin`, and rate the controller
on a body of more segments with :meth:`Loop.on` before trusting it.

Source: B.D.O. Anderson, J.B. Moore, Optimal Control: Linear Quadratic Methods, Prentice Hall 1990,
Chapters 3, 7, 8; A.E. Bryson, Y.-C. Ho, Applied Optimal Control, 1975, Section 5.2 (sizes).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from railride.active.loop import Loop
from railride.active.signals import suspension_signals
from railride.active.skyhook import actuator_dynamics
from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.quantities import check_number, several
from railride.spectra import Spectrum, temporal
from railride.statespace import state_space
from railride.stochastic.measured import track_spectrum
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import control

ERRI_POLES = (0.0206, 0.8246)  # rad/m, of the shaping filter
MATCH_HZ = 1.0  # where the shaped noise has the spectrum's own density


def lqg(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track,
    *,
    acceleration: float = 0.1,
    travel: float = 0.01,
    force: float = 5e3,
    at: float | Sequence[float] = (0.0,),
    sensor_noise: float = 0.03,
    bandwidth: float | None = None,
    order: int = 2,
    weight: str | Weighting = "Wk",
    name: str = "LQG",
    **changes: ArrayLike,
) -> Loop:
    """The vehicle under LQG control from accelerometers on the body over each bogie.

    Parameters
    ----------
    speed : V in m/s, > 0, that the design is made for.
    track : a spectrum or its name, a track or its file.
    acceleration, travel, force : acceptable sizes in m/s² (weighted, at each point), m and N, all
        > 0; a larger force makes a stronger controller.
    at : points of the smooth floor whose comfort counts, m forward of the body's middle.
    sensor_noise : of each accelerometer, m/s²/√Hz, > 0. The default is far above a good sensor's:
        it stands for what the model does not know, and keeps the filter from trusting its bending
        modes.
    bandwidth, order : of the actuators, Hz and 1 or 2 (Butterworth), part of the design and of the
        loop; None: ideal. weight : a weighting or its name.
    name : of the design, for tables and messages.
    changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : a value out of its range; a design that no solution is found for.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> from railride.active import rate_loop
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> rating = rate_loop(lqg(coach, 200 / 3.6, "erri_low", force=2e3), 200 / 3.6, "erri_low")
    >>> bool(rating.a_wrms[0] < 0.1)
    True
    """
    import control

    _check(name, acceleration=acceleration, travel=travel, force=force, sensor_noise=sensor_noise)
    spectrum, said = track_spectrum(track, [speed])
    at = several(at, f"{name}: at", "m")
    if not at:
        raise InputError(f"{name}: at: found no point; expected at least one")
    bogies = model.running_gear.bogies
    design = _design(model, speed, at, weighting(weight), bandwidth, order, changes)
    n, force = len(bogies), force * np.sqrt(len(bogies))
    sizes = np.repeat([acceleration * np.sqrt(len(at)), travel * np.sqrt(n)], [len(at), n])
    K = _regulator(design, sizes, force, name)
    L = _observer(design, _noise_intensity(spectrum, speed), sensor_noise**2 / 2, name)
    A, B, C, D = design.A, design.B_u, design.C_y, design.D_y
    law = control.ss(A - B @ K - L @ (C - D @ K), L, -K, np.zeros((n, n)))
    growing = law.poles().real.max() > 0
    if bandwidth is not None:
        law = control.append(*[actuator_dynamics(bandwidth, order)] * n) * law
    measured = tuple(suspension_signals(model)[f"body_{b}_acceleration"] for b in bogies)
    controller = control.ss(law.A, law.B, law.C, law.D,
                            inputs=[output.name for output in measured],
                            outputs=[f.name for f in model.linear.forces])  # fmt: skip
    remark = f"{name}: the controller is unstable by itself: a sensor that fails lets it run away"
    remarks = (*said, *([remark] if growing else []))
    return Loop(name, model, controller, measured, changes, remarks)


@dataclass(frozen=True, eq=False)
class _Design:
    """x' = A x + B_xi ξ + B_u u, z = C_z x + D_z u (costly), y = C_y x + D_y u (measured)."""

    A: Array
    B_xi: Array
    B_u: Array
    C_z: Array
    D_z: Array
    C_y: Array
    D_y: Array


def _check(source: str, **values: float) -> None:
    faults = Faults(source)
    for name, value in values.items():
        check_number(faults, name, value, "> 0")
    faults.raise_if_any()


def _design(
    model: VehicleModel, speed: float, at: Sequence[float], weight: Weighting,
    bandwidth: float | None, order: int, changes: Mapping[str, Any],
) -> _Design:  # fmt: skip
    """Vehicle, shaped track, weightings and actuators in one, joined by their signals' names."""
    import control
    from scipy.linalg import matrix_balance

    bogies, signals = model.running_gear.bogies, suspension_signals(model)
    points = [model.floor(x) for x in at]
    travels = [signals[f"secondary_{b}_deflection"] for b in bogies]
    measured = [signals[f"body_{b}_acceleration"] for b in bogies]
    vehicle = state_space(model, [*points, *travels, *measured], **changes)
    parts = [vehicle.copy(name="vehicle", use_prefix_suffix=False)]
    w = [symbol.name for symbol in model.linear.inputs]
    forces = [symbol.name for symbol in model.linear.forces]
    slow, fast = speed * np.array(ERRI_POLES)
    for name in w:
        shape = np.array([[0.0, 1.0], [-slow * fast, -slow - fast]])
        parts.append(control.ss(shape, [[0.0], [1.0]], np.eye(2), np.zeros((2, 1)),
                                inputs=[f"xi_{name}"], outputs=[name, f"d{name}"],
                                name=f"track_{name}"))  # fmt: skip
    rated = [f"{point.name}_weighted" for point in points]
    for point, label in zip(points, rated, strict=True):
        parts.append(_weighting_system(weight, point.name, label))
    commands = forces
    if bandwidth is not None:
        commands = [f"{name}_command" for name in forces]
        for command, name in zip(commands, forces, strict=True):
            parts.append(control.ss(actuator_dynamics(bandwidth, order), inputs=[command],
                                    outputs=[name], name=f"actuator_{name}"))  # fmt: skip
    noises = [f"xi_{name}" for name in w]
    costly, sensed = [*rated, *(o.name for o in travels)], [o.name for o in measured]
    plant = control.interconnect(parts, inputs=[*noises, *commands], check_unused=False,
                                 outputs=[*costly, *sensed])  # fmt: skip
    A, (scale, _) = matrix_balance(plant.A, permute=False, separate=True)  # powers of two
    B, C, n, m = plant.B / scale[:, np.newaxis], plant.C * scale, len(noises), len(costly)
    return _Design(A, B[:, :n], B[:, n:], C[:m], plant.D[:m, n:], C[m:], plant.D[m:, n:])


def _weighting_system(weight: Weighting, source: str, label: str) -> control.StateSpace:
    """The weighting factor by factor in series: no polynomial of high order."""
    import control

    chain = control.ss([], [], [], 1.0)
    for numerator, denominator in weight.factors():
        chain = _companion(np.asarray(numerator), np.asarray(denominator)) * chain
    return control.ss(chain.A, chain.B, chain.C, chain.D, inputs=[source], outputs=[label],
                      name=f"weighting_{label}")  # fmt: skip


def _companion(numerator: Array, denominator: Array) -> control.StateSpace:
    """One factor of a weighting in controllable form."""
    import control

    n = len(denominator) - 1
    a = denominator[1:] / denominator[0]
    b = np.concatenate([np.zeros(n + 1 - len(numerator)), numerator]) / denominator[0]
    if n == 0:
        return control.ss([], [], [], float(b[0]))
    A, B = np.eye(n, k=1), np.zeros((n, 1))
    A[-1], B[-1] = -a[::-1], 1.0
    return control.ss(A, B, (b[1:] - b[0] * a)[np.newaxis, ::-1], b[0])


def _noise_intensity(spectrum: Spectrum, speed: float) -> float:
    """q of E[ξ(t) ξ(t')] = q δ(t - t'), so that w has the spectrum's density at 1 Hz.

    The filter's one-sided density is 2 q/((ω² + ω_r²)(ω² + ω_c²)): of an ERRI spectrum at all f.
    """
    omega = 2 * np.pi * MATCH_HZ
    density = float(temporal(spectrum.extrapolated(), speed)(MATCH_HZ))
    slow, fast = speed * np.array(ERRI_POLES)
    return float(density * (omega**2 + slow**2) * (omega**2 + fast**2) / 2)


def _regulator(design: _Design, sizes: Array, force: float, name: str) -> Array:
    """K of u = -K x, by the algebraic Riccati equation with the forces in units of their size."""
    import control

    C, D = design.C_z / sizes[:, np.newaxis], design.D_z * force / sizes[:, np.newaxis]
    R = D.T @ D + np.eye(D.shape[1])
    try:
        K, _, _ = control.lqr(design.A, design.B_u * force, C.T @ C, R, C.T @ D, method="scipy")
    except (np.linalg.LinAlgError, control.ControlDimension, ValueError) as error:
        raise InputError(_UNSOLVED.format(name=name, what="feedback", error=error)) from None
    return np.asarray(force * K)


def _observer(design: _Design, intensity: float, noise: float, name: str) -> Array:
    """L of the Kalman filter, with the measurements in units of their noise."""
    import control

    unit = np.sqrt(noise)
    G, C = design.B_xi * np.sqrt(intensity), design.C_y / unit
    try:
        L, _, _ = control.lqe(design.A, G, C, np.eye(G.shape[1]), np.eye(len(C)), method="scipy")
    except (np.linalg.LinAlgError, ValueError) as error:
        raise InputError(_UNSOLVED.format(name=name, what="filter", error=error)) from None
    return np.asarray(L / unit)


_UNSOLVED = (
    "{name}: found no solution of the Riccati equation of the {what} ({error}); expected sizes and "
    "noise that differ less (a motion that hardly decays, and that no actuator or sensor reaches, "
    "does it too: give the body structural damping)"
)
