r"""Frequency response of the vehicle to the track, every wheelset with its exact delay.

.. math:: (K - \omega^2 M + i\omega C)\, q = (K_w + i\omega C_w)\, e(\omega)\, w, \qquad
          e_j = e^{-i\omega l_j/V}

w is the elevation under the leading wheelset, l_j the distance of wheelset j behind it. With the
complex Schur form A = Q T Q* of x' = A x the system is triangular at every frequency, and is
solved row by row for all frequencies together; no eigenvectors, so repeated and nearly repeated
poles do no harm.

Source: the equations of motion; A.J. Laub, IEEE Trans. Autom. Control 26 (1981) 407-408, with the
Schur in place of the Hessenberg form.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.firstorder import first_order
from railride.numeric import Array, Matrices
from railride.spectra import check_speed
from railride.vehicle import Output, VehicleModel

Complex = NDArray[np.complex128]


def track_response(
    model: VehicleModel,
    outputs: Sequence[Output],
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
    check_speed(speed)
    omega = 2 * np.pi * np.asarray(frequency, dtype=float)
    m, Y = model.matrices(**changes), model.output_rows(outputs, **changes)
    delays = wheelset_delays(model, speed)
    e = np.exp(-1j * delays[:, np.newaxis] * omega)
    s = 1j * omega
    force = m.K_w @ e + s * (m.C_w @ e)
    q = solve_at(m, omega, force)
    motion = Y["d"] @ q + s * (Y["v"] @ q) + s**2 * (Y["a"] @ q)
    return np.asarray(motion + Y["w"] @ e + s * (Y["dw"] @ e))


def solve_at(m: Matrices, omega: Array, force: Complex) -> Complex:
    """q of (K - ω² M + iω C) q = force at every ω: shapes (n, F) from (F,) and (n, F)."""
    from scipy.linalg import schur

    x = first_order(m)
    n, states = x.q_x.shape
    own = np.flatnonzero(x.inertial)
    scale = np.ones(states)  # displacements times a typical ω are of the size of their rates
    scale[:n] = np.sqrt(np.abs(x.a_x[own] @ x.q_x.T).max())
    T, Q = schur(scale[:, np.newaxis] * x.A / scale, output="complex")
    y = Q.conj().T @ (scale[:, np.newaxis] * (x.B @ force))
    s = 1j * omega
    for i in range(states - 1, -1, -1):
        y[i] += T[i, i + 1 :] @ y[i + 1 :]
        y[i] /= s - T[i, i]
    return np.asarray((x.q_x / scale) @ (Q @ y))


def wheelset_delays(model: VehicleModel, speed: float) -> Array:
    """l_j/V of every wheelset, s, from the leading one."""
    places = np.array(model.vehicle.wheelset_positions)
    return np.asarray((places[0] - places) / speed)
