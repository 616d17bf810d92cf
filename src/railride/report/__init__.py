r"""Derivations as documents: a vehicle's, that of its car body alone, and what they are made of.

Each reads like a textbook's, from the coordinates over T, V and D to the nonlinear equations, the
equilibrium, the linear equations

.. math:: M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f ,

and on to natural frequencies. Every equation and every figure is derived as the document is made;
at its end the same mathematics stands as text that sympy reads back.
"""

from railride.report.document import (
    LAGRANGE,
    Subject,
    entries,
    for_sympy,
    render,
    repeatable,
    stacked,
)
from railride.report.vehicle import command, vehicle_blocks, vehicle_document

__all__ = [
    "LAGRANGE",
    "Subject",
    "command",
    "entries",
    "for_sympy",
    "render",
    "repeatable",
    "stacked",
    "vehicle_blocks",
    "vehicle_document",
]
