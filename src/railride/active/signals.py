"""What the sensors of an active suspension tell, and what its damper does."""

from __future__ import annotations

import sympy as sp

from railride.lagrange import rate
from railride.running_gear import bogie_heave, secondary_deflection, secondary_stroke
from railride.vehicle import Output, VehicleModel


def suspension_signals(model: VehicleModel) -> dict[str, Output]:
    """Outputs by name at each bogie b: ż and z̈ of the body over it and of its own, s, ṡ, ḋ.

    ``body_{b}_velocity``, ``body_{b}_acceleration`` are of the body's structure where the
    suspension is attached; ``bogie_{b}_velocity``, ``bogie_{b}_acceleration`` of the bogie's mass
    centre; ``secondary_{b}_deflection``, ``secondary_{b}_rate`` of the suspension's extension s;
    and ``damper_{b}_rate`` of the secondary damper's own stroke, s unless its mount is elastic.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> [*suspension_signals(derive_vehicle(load_vehicle("cati2024"), segments=2))][:2]
    ['body_1_velocity', 'body_1_acceleration']
    """
    gear, found = model.running_gear, {}
    for b, bogie in zip(gear.bogies, model.vehicle.bogies, strict=True):
        height = model.body.height(gear.place(b))
        velocity, z, s = rate(height), bogie_heave(b), secondary_deflection(b)
        stroke = s if bogie.secondary_damper_stiffness is None else secondary_stroke(b)
        for name, expression, unit, latex in (
            (f"body_{b}_velocity", velocity, "m/s", rf"\dot{{z}}_{{body,{b}}}"),
            (f"body_{b}_acceleration", rate(velocity), "m/s^2", rf"\ddot{{z}}_{{body,{b}}}"),
            (f"bogie_{b}_velocity", z.dot, "m/s", sp.latex(z.dot)),
            (f"bogie_{b}_acceleration", z.ddot, "m/s^2", sp.latex(z.ddot)),
            (f"secondary_{b}_deflection", s, "m", sp.latex(s)),
            (f"secondary_{b}_rate", s.dot, "m/s", sp.latex(s.dot)),
            (f"damper_{b}_rate", stroke.dot, "m/s", sp.latex(stroke.dot)),
        ):
            found[name] = Output(name, expression, unit, latex)
    return found
