"""Exact derivatives of what a ride comes to, along the parameters of a vehicle.

chain (how every symbol moves with the parameters) → derivatives (of the matrices) → squares (mean
squares and their gradients by the adjoint).
"""

from railride.sensitivities.derivatives import Derivatives, Rows, Tangent
from railride.sensitivities.squares import mean_squares_with_gradient

__all__ = ["Derivatives", "Rows", "Tangent", "mean_squares_with_gradient"]
