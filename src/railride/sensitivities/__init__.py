"""Exact derivatives of what a ride comes to, along the parameters of a vehicle.

chain (how every symbol moves with the parameters) → derivatives (of the matrices) → squares (mean
squares and their gradients by the adjoint), roots (natural frequencies, damping ratios), statics
(static deflections) → result (all of it, beside changed designs found anew, as tables).
"""

from railride.sensitivities.derivatives import Derivatives, Rows, Tangent
from railride.sensitivities.result import FELT, Sensitivities, sensitivity
from railride.sensitivities.roots import Roots, roots_with_gradient
from railride.sensitivities.squares import mean_squares_with_gradient
from railride.sensitivities.statics import static_deflections_with_gradient

__all__ = [
    "FELT",
    "Derivatives",
    "Roots",
    "Rows",
    "Sensitivities",
    "Tangent",
    "mean_squares_with_gradient",
    "roots_with_gradient",
    "sensitivity",
    "static_deflections_with_gradient",
]
