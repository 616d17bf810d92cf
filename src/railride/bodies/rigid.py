"""The rigid car body: heave of its mass centre and pitch."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property

import numpy as np
import sympy as sp
from sympy import cos, sin

from railride.bodies.base import BodyModel, Parameter, Place
from railride.lagrange import Coordinate, Lagrangian, rate
from railride.numeric import Array
from railride.parameters import Load

m_c, I_c, e_c = sp.Symbol("m_c", positive=True), sp.Symbol("I_c", positive=True), sp.Symbol("e_c")
z_c, theta_c, x_c = Coordinate("z_c"), Coordinate("theta_c"), Coordinate("x_c")


class RigidBody(BodyModel):
    r"""One rigid body in heave and pitch.

    .. math:: T = \tfrac12 m_c (\dot x_c^2 + \dot z_c^2) + \tfrac12 I_c \dot\theta_c^2

    Its middle is held in x; a mass centre e_c forward of the middle moves there by e_c cos θ_c.
    """

    kind = "rigid"
    title = "rigid body"
    phrase = "a rigid car body"
    segments = 1

    @property
    def offset(self) -> sp.Expr:
        """The mass centre's place forward of the middle: zero, or the symbol e_c."""
        return e_c if self.body.mass_centre else sp.S.Zero

    @cached_property
    def energies(self) -> Lagrangian:
        """Heave and pitch of a free rigid body."""
        kinematics = {x_c: e_c * cos(theta_c)} if self.offset else {}
        v_x = x_c.dot if self.offset else 0
        T = m_c * (v_x**2 + z_c.dot**2) / 2 + I_c * theta_c.dot**2 / 2
        return Lagrangian([z_c, theta_c], T, kinematics=kinematics)

    @property
    def positions(self) -> Mapping[str, tuple[sp.Expr, sp.Expr]]:
        """That of the mass centre."""
        return {"c": (x_c if self.offset else sp.S.Zero, z_c)}

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """m_c, I_c, and e_c where the mass centre is off the middle."""
        own = (
            Parameter(m_c, "car-body mass", "kg", self.body.mass),
            Parameter(I_c, "car-body pitch inertia", "kg m^2", self.body.pitch_inertia),
        )
        e = Parameter(e_c, "mass centre forward of the middle", "m", self.body.mass_centre)
        return (*own, e) if self.offset else own

    @property
    def lift(self) -> Mapping[Coordinate, int]:
        """A uniform lift is heave alone."""
        return {z_c: 1}

    @property
    def pitch(self) -> Mapping[Coordinate, sp.Expr]:
        """A turn about the middle lifts a mass centre ahead of it."""
        return {z_c: self.offset, theta_c: sp.S.One}

    @property
    def nodes(self) -> Array:
        """The two ends."""
        return np.array([0.5, -0.5]) * self.body.length

    def load_energy(self, mass: sp.Symbol, load: Load) -> sp.Expr:
        """T of a rod: its middle x_p forward of the body's, moving with (-x_p θ̇ sin θ, ż)."""
        half = self.body.length / 2
        front = half if load.front is None else load.front
        rear = -half if load.rear is None else load.rear
        x_p, length = sp.Float((front + rear) / 2), sp.Float(front - rear)
        v_x, v_z = (rate(u) for u in (x_p * cos(theta_c), self._along(x_p)))
        return mass * (v_x**2 + v_z**2) / 2 + mass * length**2 / 12 * theta_c.dot**2 / 2

    def height(self, place: Place) -> sp.Expr:
        """z(x) = z_c + (x - e_c) sin θ_c."""
        self.check_point(place.at)
        return self._along(place.x)

    def _along(self, x: sp.Expr) -> sp.Expr:
        return z_c + (x - self.offset) * sin(theta_c)

    def floor(self, at: float, reading: str) -> sp.Expr:
        """The floor of a rigid body is the body, however it is read."""
        self.check_reading(reading)
        self.check_point(at)
        return self._along(sp.Float(at))
