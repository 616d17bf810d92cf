r"""Skyhook damping: the sky's damping force on the body, by actuators the bogies hold up.

.. math:: f_b = -c_{sky}\, G_a(s)\, G_h(s)\, \dot z_{body}(x_b), \qquad
          G_a = \frac{\omega_a}{s + \omega_a} \ \text{or}\
                \frac{\omega_a^2}{s^2 + \sqrt 2\, \omega_a s + \omega_a^2}, \qquad
          G_h = \frac{s}{s + \omega_h}

The force on the body is that of a damper between it and the sky; its reaction is not the sky's to
take, but the bogie's, which it shakes. So an actuator falls short of the damper that it is named
after: with 100 kN s/m over each bogie, the paper's coach at 200 km/h has 0.169 m/s² at the middle,
and on dampers to the sky it would have 0.140.

G_a is the actuator's bandwidth and G_h the high-pass without which a velocity integrated from an
accelerometer would drift. The ideal one has neither.

Source: D. Karnopp, M.J. Crosby, R.A. Harwood, Vibration control using semi-active force generators,
ASME J. Eng. Ind. 96 (1974) 619-626.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.active.loop import Loop
from railride.active.signals import suspension_signals
from railride.errors import Faults, InputError
from railride.quantities import check_number
from railride.vehicle import VehicleModel

if TYPE_CHECKING:
    import control


def skyhook(
    model: VehicleModel,
    gain: float,
    *,
    bandwidth: float | None = None,
    order: int = 2,
    high_pass: float | None = None,
    name: str = "skyhook",
    **changes: ArrayLike,
) -> Loop:
    """The vehicle with skyhook damping by the actuator over each bogie, which takes its reaction.

    Parameters
    ----------
    gain : c_sky, N s/m per bogie, of the force on the body and on the bogie against it.
    bandwidth : of the actuator, Hz, where it is 3 dB down; None: ideal.
    order : of the actuator, 1 or 2 (Butterworth).
    high_pass : corner of the velocity signal's high-pass, Hz; None: ideal.
    name : of the design, for tables and messages.
    changes : parameter values in place of the vehicle's, such as less ``c_2``.

    Raises
    ------
    InputError : a value out of its range; a loop that is unstable, as an actuator's lag may make
        one in the bending modes.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=1)
    >>> skyhook(coach, 100e3, bandwidth=10.0).system.output_labels[-2:]
    ['f_1', 'f_2']
    """
    import control

    faults = Faults(name)
    check_number(faults, "gain", gain, unit="N s/m")
    for what, corner in (("bandwidth", bandwidth), ("high_pass", high_pass)):
        if corner is not None:
            check_number(faults, what, corner, "> 0", "Hz")
    if order not in (1, 2):
        faults.add("order", order, "1 or 2")
    faults.raise_if_any()
    bogies = model.running_gear.bogies
    measured = tuple(suspension_signals(model)[f"body_{b}_velocity"] for b in bogies)
    law = control.ss([], [], [], -float(gain))
    if high_pass is not None:
        omega = 2 * np.pi * high_pass
        law = control.ss([[-omega]], [[-omega]], [[1.0]], [[1.0]]) * law
    if bandwidth is not None:
        law = actuator_dynamics(bandwidth, order) * law
    every = control.append(*[law] * len(bogies))
    controller = control.ss(every.A, every.B, every.C, every.D,
                            inputs=[output.name for output in measured],
                            outputs=[force.name for force in model.linear.forces])  # fmt: skip
    return Loop(name, model, controller, measured, changes)


def actuator_dynamics(bandwidth: float, order: int = 2) -> control.StateSpace:
    """G_a(s) from the force asked for to the force given, 3 dB down at its bandwidth.

    Parameters
    ----------
    bandwidth : Hz, > 0. order : 1 or 2 (Butterworth).

    Raises
    ------
    InputError : a bandwidth that is not above 0, another order.

    Examples
    --------
    >>> round(float(abs(actuator_dynamics(10.0)(20j * np.pi))), 6)
    0.707107
    """
    import control

    faults = Faults("actuator")
    check_number(faults, "bandwidth", bandwidth, "> 0", "Hz")
    faults.raise_if_any()
    corner = 2 * np.pi * bandwidth
    if order == 1:
        return control.ss([[-corner]], [[corner]], [[1.0]], [[0.0]])
    if order == 2:
        # States of the same size: the force and its rate over the corner.
        A = corner * np.array([[0.0, 1.0], [-1.0, -np.sqrt(2)]])
        return control.ss(A, [[0.0], [corner]], [[1.0, 0.0]], [[0.0]])
    raise InputError(f"actuator: order: found {order}; expected 1 or 2")
