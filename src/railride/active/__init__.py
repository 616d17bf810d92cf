r"""Active and semi-active secondary suspensions: loops closed round the vehicle, and rated.

The plant is the vehicle's state space with one actuator per bogie; a controller is any
``control.StateSpace`` from named outputs of the plant to the actuators' forces. A loop is closed on
these names, checked for stability, and rated beside the passive vehicle by the exact stochastic
comfort value, the suspension travel and the actuators' forces.
"""

from railride.active.loop import Loop
from railride.active.lqg import lqg
from railride.active.rating import (
    LoopRating,
    closed_response,
    loop_spectra,
    rate_loop,
    rate_loops,
)
from railride.active.semiactive import SemiActiveRide, semi_active_ride
from railride.active.signals import suspension_signals
from railride.active.skyhook import actuator_dynamics, skyhook

__all__ = [
    "Loop",
    "LoopRating",
    "SemiActiveRide",
    "actuator_dynamics",
    "closed_response",
    "loop_spectra",
    "lqg",
    "rate_loop",
    "rate_loops",
    "semi_active_ride",
    "skyhook",
    "suspension_signals",
]
