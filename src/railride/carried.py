r"""What a car body carries: payload, and equipment under the floor on elastic mounts.

A payload moves with the body and adds to T alone. Equipment e of mass m_e hangs at x_e on mounts
that act vertically, with a height z_e of its own:

.. math:: T = \tfrac12 m_e \dot z_e^2, \quad V = \tfrac12 k_e s_e^2, \quad
          D = \tfrac12 c_e \dot s_e^2, \qquad s_e = z_{body}(x_e) - z_e,

.. math:: k_e = m_e\,(2\pi f_e)^2, \qquad c_e = 2\zeta_e\sqrt{k_e m_e}

where its frequency and damping ratio are given: those of the equipment on a body that stands still.
Tuned a little below a bending mode it takes the energy out of that: a tuned absorber.

Source: J.P. Den Hartog, Mechanical Vibrations, 4th ed. 1956, Section 3.3; for rail vehicles,
G. Diana et al., Vehicle System Dynamics 38 (2002) 165-183.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp
from sympy import pi, sqrt

from railride.bodies import BodyModel, Parameter, Place
from railride.lagrange import Coordinate, Lagrangian
from railride.parameters import Vehicle


def equipment_heave(e: int) -> Coordinate:
    """Height of equipment e."""
    return Coordinate(f"z_e{e}")


def mount_deflection(e: int) -> Coordinate:
    """Extension of the mounts of equipment e."""
    return Coordinate(f"s_e{e}")


@dataclass(frozen=True)
class Carried:
    """The payload and the equipment of a vehicle, each numbered as they are listed."""

    vehicle: Vehicle

    @property
    def equipment(self) -> range:
        """The numbers of the equipment."""
        return range(1, len(self.vehicle.equipment) + 1)

    @property
    def coordinates(self) -> list[Coordinate]:
        """The heights of the equipment."""
        return [equipment_heave(e) for e in self.equipment]

    def on(self, body: BodyModel) -> Lagrangian:
        """A free body with all that it carries: its coordinates, then those of the equipment."""
        free = body.energies
        T, V, D = [free.kinetic], [free.potential], [free.dissipation]
        kinematics = dict(free.kinematics)
        loads = zip(self.load_symbols, self.vehicle.payload, strict=True)
        T += [body.load_energy(mass, load) for mass, load in loads]
        for e in self.equipment:
            m_e, k_e, c_e = self._symbols(e)
            z, s = equipment_heave(e), mount_deflection(e)
            kinematics[s] = body.height(self.place(e)) - z
            T.append(m_e * z.dot**2 / 2)
            V.append(k_e * s**2 / 2)
            D.append(c_e * s.dot**2 / 2)
        coordinates = [*free.coordinates, *self.coordinates]
        return Lagrangian(coordinates, sp.Add(*T), sp.Add(*V), sp.Add(*D), kinematics=kinematics)

    def place(self, e: int) -> Place:
        """Where equipment e hangs."""
        x = sp.Symbol(f"x_e{e}", real=True)
        return Place(f"equipment {e}", f"e{e}", x, self.vehicle.equipment[e - 1].position)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Masses of the loads; of each equipment its mass, its place, and what its mounts are."""
        found = [
            Parameter(mass, "payload", "kg", load.mass)
            for mass, load in zip(self.load_symbols, self.vehicle.payload, strict=True)
        ]
        for e, one in zip(self.equipment, self.vehicle.equipment, strict=True):
            m_e, k_e, c_e = self._symbols(e)
            f_e, zeta_e = _tuning(e)
            of, x_e = f"of equipment {e}", self.place(e).x
            given: tuple[tuple[sp.Symbol, str, str, float | None], ...] = (
                (m_e, f"mass {of}", "kg", one.mass),
                (x_e, f"position {of}, from the body's middle", "m", one.position),
                (k_e, *self.meaning(k_e), one.stiffness),
                (f_e, f"natural frequency {of} on its mounts", "Hz", one.frequency),
                (c_e, *self.meaning(c_e), one.damping),
                (zeta_e, f"damping ratio {of} on its mounts", "",
                 one.damping_ratio if one.damping is None else None),
            )  # fmt: skip
            found += [
                Parameter(symbol, meaning, unit, value)
                for symbol, meaning, unit, value in given
                if value is not None
            ]
        return tuple(found)

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """k_e and c_e, unless they are given."""
        defined: dict[sp.Symbol, sp.Expr] = {}
        for e, one in zip(self.equipment, self.vehicle.equipment, strict=True):
            m_e, k_e, c_e = self._symbols(e)
            f_e, zeta_e = _tuning(e)
            if one.frequency is not None:
                defined[k_e] = m_e * (2 * pi * f_e) ** 2
            if one.damping is None:
                defined[c_e] = 2 * zeta_e * sqrt(k_e * m_e)
        return defined

    def meaning(self, symbol: sp.Symbol) -> tuple[str, str]:
        """Meaning and unit of what is defined here."""
        for e in self.equipment:
            _, k_e, c_e = self._symbols(e)
            if symbol in (k_e, c_e):
                kind, unit = ("stiffness", "N/m") if symbol == k_e else ("damping", "N s/m")
                return f"{kind} of the mounts of equipment {e}", unit
        return "", ""

    @property
    def load_symbols(self) -> list[sp.Symbol]:
        """The masses of the loads: m_p, or m_p1, m_p2 …"""
        loads = len(self.vehicle.payload)
        names = ["m_p"] if loads == 1 else [f"m_p{k}" for k in range(1, loads + 1)]
        return [sp.Symbol(name, positive=True) for name in names]

    @staticmethod
    def _symbols(e: int) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
        """m_e, k_e and c_e."""
        m_e, k_e = sp.symbols(f"m_e{e} k_e{e}", positive=True)
        return m_e, k_e, sp.Symbol(f"c_e{e}", nonnegative=True)


def _tuning(e: int) -> tuple[sp.Symbol, sp.Symbol]:
    """f_e and ζ_e."""
    return sp.Symbol(f"f_e{e}", positive=True), sp.Symbol(f"zeta_e{e}", nonnegative=True)
