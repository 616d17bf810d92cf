r"""Structural damping of a car body's bending modes: what is given, as ratios of every mode.

.. math:: \zeta_i = \zeta\,\frac{f_i}{f_1}, \qquad
          \zeta_i = \frac{\alpha}{2\omega_i} + \frac{\beta\,\omega_i}{2}
          \;\text{(Rayleigh)}, \qquad \zeta_i \text{ one by one}

The ratio ζ of the first bending mode means damping proportional to stiffness. Rayleigh's α damps
the bending alone, as structural damping does: the rigid motions of the body strain nothing.

Source: physics of the bending damper, D.E. Newland, Mechanical Vibration Analysis and Computation,
1989, Chapter 6; Lord Rayleigh, The Theory of Sound, Vol. 1, 1894, Section 102.
"""

from __future__ import annotations

import numpy as np
import sympy as sp
from sympy import pi

from railride.bodies.base import Parameter
from railride.numeric import Array
from railride.parameters import CarBody

zeta_bending = sp.Symbol("zeta_bending", nonnegative=True)
alpha, beta = sp.symbols("alpha_R beta_R", nonnegative=True)
MEANING = "structural damping ratio of the first bending mode"


def mode_frequency(i: int) -> sp.Symbol:
    """Natural frequency of the free body's mode i, Hz."""
    return sp.Symbol(f"f_c{i}", positive=True)


def mode_damping(i: int) -> sp.Symbol:
    """Damping ratio of the free body's mode i."""
    return sp.Symbol(f"zeta_c{i}", nonnegative=True)


def is_rayleigh(body: CarBody) -> bool:
    """Whether Rayleigh's α or β is given."""
    return bool(body.rayleigh_mass or body.rayleigh_stiffness)


def damping_parameters(body: CarBody, count: int) -> tuple[Parameter, ...]:
    """The independent parameters of the damping of ``count`` modes."""
    if body.mode_damping is not None:
        return tuple(Parameter(mode_damping(i), f"damping ratio of mode {i}", "", float(ratio))
                     for i, ratio in enumerate(_ratios(body, count), start=1))  # fmt: skip
    if is_rayleigh(body):
        return (
            Parameter(alpha, "Rayleigh damping by mass", "1/s", body.rayleigh_mass),
            Parameter(beta, "Rayleigh damping by stiffness", "s", body.rayleigh_stiffness),
        )
    return (Parameter(zeta_bending, MEANING, "", body.bending_damping),)


def damping_definitions(body: CarBody, count: int) -> dict[sp.Symbol, sp.Expr]:
    """ζ_i by the parameters and the modes' frequencies; nothing where they are given one by one."""
    if body.mode_damping is not None:
        return {}
    found = {}
    for i in range(1, count + 1):
        f, first = mode_frequency(i), mode_frequency(1)
        rayleigh = alpha / (4 * pi * f) + pi * beta * f
        found[mode_damping(i)] = rayleigh if is_rayleigh(body) else zeta_bending * f / first
    return found


def damping_ratios(body: CarBody, frequencies: Array) -> Array:
    """ζ_i of natural frequencies in Hz, ascending, (n,).

    >>> coach = CarBody(34e3, 1.632e6, 24.0, bending_damping=0.015)
    >>> damping_ratios(coach, np.array([9.6, 19.2])).tolist()
    [0.015, 0.03]
    """
    f = np.asarray(frequencies, dtype=float)
    if body.mode_damping is not None:
        return _ratios(body, f.size)
    if is_rayleigh(body):
        return np.asarray(
            body.rayleigh_mass / (4 * np.pi * f) + np.pi * body.rayleigh_stiffness * f
        )
    return np.asarray(body.bending_damping * f / f[0])


def damping_remarks(body: CarBody, count: int) -> tuple[str, ...]:
    """That a list of ratios is shorter than there are modes."""
    given = len(body.mode_damping or ())
    if not 0 < given < count:
        return ()
    rest = f"mode {count} has" if given == count - 1 else f"modes {given + 1} to {count} have"
    modes = f"{given} bending mode{'s' * (given > 1)}"
    return (f"damping ratios are given for {modes}: {rest} the last of them",)


def _ratios(body: CarBody, count: int) -> Array:
    """Those given, the last of them again for all further modes."""
    given = np.asarray(body.mode_damping, dtype=float)
    return np.asarray(given[np.minimum(np.arange(count), given.size - 1)])
