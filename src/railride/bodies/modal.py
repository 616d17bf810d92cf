r"""The car body as a rigid body with natural modes of bending.

.. math:: T = \tfrac12 m_c(\dot x_c^2 + \dot z_c^2) + \tfrac12 I_c\dot\theta_c^2
          + \sum_i \tfrac12 m_c\dot\eta_i^2, \quad
          V = \sum_i \tfrac12 m_c\omega_i^2\eta_i^2, \quad
          D = \sum_i m_c\zeta_i\omega_i\dot\eta_i^2

.. math:: z(x) = z_c + (x - e_c)\sin\theta_c + \sum_i \varphi_i(x)\,\eta_i , \qquad
          \omega_i = 2\pi f_i

with the shapes φ_i of :class:`~railride.bodies.body_modes.BodyModes`. Their values where something
is attached are symbols, ``phi_1_b1`` over bogie 1, of which the body knows the numbers.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Section 8.9.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement

import numpy as np
import sympy as sp
from sympy import cos, pi, sin

from railride.bodies.base import BodyModel, Parameter, Place
from railride.bodies.body_modes import BodyModes
from railride.bodies.rigid import e_c, m_c, theta_c, x_c, z_c
from railride.bodies.shapes import Shape, quadrature
from railride.bodies.structural_damping import (
    damping_definitions,
    damping_parameters,
    damping_remarks,
    mode_damping,
    mode_frequency,
)
from railride.errors import InputError
from railride.lagrange import Coordinate, Lagrangian
from railride.numeric import Array
from railride.parameters import Load

r_c = sp.Symbol("r_c", positive=True)
TITLES = {"beam": "beam", "fe": "finite elements", "modes": "given modes"}
OPTIONS = {"modes": "fe"}  # what --body calls a kind of another name
OUTLINE = 81  # points in a drawing


def eta(i: int) -> Coordinate:
    """How far mode i is out, in metres where its shape is 1."""
    return Coordinate(f"eta_{i}")


@dataclass(frozen=True)
class ModalBody(BodyModel):
    """A body of the natural modes that it is given.

    Raises
    ------
    InputError : modes of a body of another length or mass than the vehicle's.
    """

    modes: BodyModes

    def __post_init__(self) -> None:
        for name, unit in (("length", "m"), ("mass", "kg")):
            own, given = getattr(self.modes, name), getattr(self.body, name)
            if abs(own - given) > 1e-9 * given:
                raise InputError(f"modes of the car body: {name}: found {own:g} {unit}; expected "
                                 f"{given:g} {unit}, the vehicle's")  # fmt: skip

    @property
    def kind(self) -> str:
        """What the modes are made of."""
        return self.modes.kind

    @property
    def title(self) -> str:
        """Kind and number of modes."""
        return f"{TITLES.get(self.kind, self.kind)}, {_count(self.modes.count)}"

    @property
    def phrase(self) -> str:
        """Kind and number of modes, in full."""
        made = {"beam": "a car body as a beam", "fe": "a car body of finite elements"}
        return f"{made.get(self.kind, 'a car body')} with {_count(self.modes.count)}"

    @property
    def options(self) -> str:
        """Kind and number of modes."""
        return f"--body {OPTIONS.get(self.kind, self.kind)} --modes {self.modes.count}"

    @property
    def mode_count(self) -> int:
        """How many bending modes there are."""
        return self.modes.count

    @property
    def numbers(self) -> range:
        """The numbers of the modes."""
        return range(1, self.modes.count + 1)

    @property
    def offset(self) -> sp.Expr:
        """The mass centre's place forward of the middle: zero, or the symbol e_c."""
        return e_c if self.modes.mass_centre else sp.S.Zero

    @property
    def inertia(self) -> sp.Expr:
        """The pitch inertia I_c about the mass centre: m_c r_c²."""
        return m_c * r_c**2

    @cached_property
    def energies(self) -> Lagrangian:
        """Heave and pitch of the mass centre, and the modes."""
        kinematics = {x_c: e_c * cos(theta_c)} if self.offset else {}
        v_x = x_c.dot if self.offset else 0
        T = [m_c * (v_x**2 + z_c.dot**2) / 2, self.inertia * theta_c.dot**2 / 2]
        V, D = [], []
        for i in self.numbers:
            omega, rate_i = 2 * pi * mode_frequency(i), eta(i).dot
            T.append(m_c * rate_i**2 / 2)
            V.append(m_c * omega**2 * eta(i) ** 2 / 2)
            D.append(m_c * mode_damping(i) * omega * rate_i**2)
        coordinates = [z_c, theta_c, *map(eta, self.numbers)]
        T, V, D = (sp.Add(*u) for u in (T, V, D))
        return Lagrangian(coordinates, T, V, D, kinematics=kinematics)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The body's own and those of its damping."""
        ratios = self.modes.damping
        if ratios is None:
            return self.own_parameters + damping_parameters(self.body, self.modes.count)
        own = (Parameter(mode_damping(i), f"damping ratio of mode {i}", "", float(ratio))
               for i, ratio in zip(self.numbers, ratios, strict=True))  # fmt: skip
        return (*self.own_parameters, *own)

    @property
    def definitions(self) -> dict[sp.Symbol, sp.Expr]:
        """The damping ratios that follow from others."""
        if self.modes.damping is None:
            return damping_definitions(self.body, self.modes.count)
        return {}

    def meaning(self, symbol: sp.Symbol) -> tuple[str, str]:
        """Of frequencies, damping ratios, and shapes where something is attached."""
        if isinstance(symbol, Shape):
            return symbol.meaning, "m" if symbol.power else ""
        for i in self.numbers:
            if symbol == mode_frequency(i):
                return f"free-free frequency of mode {i}", "Hz"
            if symbol == mode_damping(i):
                return f"damping ratio of mode {i}", ""
        return super().meaning(symbol)

    @property
    def remarks(self) -> tuple[str, ...]:
        """Of the modes and of their damping."""
        said = damping_remarks(self.body, self.modes.count)
        return self.modes.remarks + (said if self.modes.damping is None else ())

    @property
    def own_parameters(self) -> tuple[Parameter, ...]:
        """m_c, r_c, e_c if it is not zero, and each mode's natural frequency."""
        modes = self.modes
        gyration = float(np.sqrt(modes.pitch_inertia / modes.mass))
        found = [
            Parameter(m_c, "car-body mass", "kg", modes.mass),
            Parameter(r_c, "radius of gyration of the car body's mass", "m", gyration),
        ]
        if self.offset:
            found.append(Parameter(e_c, "mass centre forward of the middle", "m",
                                   modes.mass_centre))  # fmt: skip
        for i, f in zip(self.numbers, modes.frequencies, strict=True):
            found.append(
                Parameter(mode_frequency(i), f"free-free frequency of mode {i}", "Hz", float(f))
            )
        return tuple(found)

    def check_values(self, values: Mapping[str, Array]) -> None:
        """Refuse another place or spread of the mass: the modes belong to it."""
        for p in self.parameters:
            if p.symbol in (r_c, e_c) and not np.all(values[p.symbol.name] == p.value):
                raise InputError(f"parameters: found another {p.meaning} than the {p.value:g} m to "
                                 "which the modes belong; expected that (give modes of the other "
                                 "body)")  # fmt: skip

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
        """Close points along the floor."""
        return np.linspace(0.5, -0.5, OUTLINE) * self.body.length

    def height(self, place: Place) -> sp.Expr:
        """z(x) = z_c + (x - e_c) sin θ_c + Σ φ_i(x) η_i."""
        self.check_point(place.at)
        bent = (Shape([i], (place, place)) * eta(i) for i in self.numbers)
        return z_c + (place.x - self.offset) * sin(theta_c) + sp.Add(*bent)

    def floor(self, at: float, reading: str) -> sp.Expr:
        """The floor is the body itself, which is smooth: both readings are one."""
        self.check_reading(reading)
        side = "" if at == 0 else "m_ahead" if at > 0 else "m_behind"
        name = f"{abs(at):.12g}{side}".replace(".", "_")
        return self.height(Place(f"floor at {at:g} m", f"at_{name}", sp.Float(at), at))

    def load_energy(self, mass: sp.Symbol, load: Load) -> sp.Expr:
        r"""T of a load: half its mass times the mean of v² over its span.

        .. math:: \dot x = -x\dot\theta_c\sin\theta_c, \qquad
                  \dot z = \dot z_c + (x - e_c)\dot\theta_c\cos\theta_c + \sum\varphi_i\dot\eta_i
        """
        rear, front = self._ends(mass, load)
        span, e, x = (rear, front), self.offset, (front.x + rear.x) / 2
        x_squared = (front.x**2 + front.x * rear.x + rear.x**2) / 3
        turn, heave = theta_c.dot * cos(theta_c), z_c.dot
        squares = [
            x_squared * theta_c.dot**2 * sin(theta_c) ** 2,
            heave**2 + 2 * heave * turn * (x - e) + turn**2 * (x_squared - 2 * e * x + e**2),
        ]
        for i in self.numbers:
            along = heave - e * turn
            squares.append(2 * eta(i).dot * (along * Shape([i], span) + turn * Shape([i], span, 1)))
        for i, j in combinations_with_replacement(self.numbers, 2):
            both = (1 if i == j else 2) * eta(i).dot * eta(j).dot
            squares.append(both * Shape([i, j], span))
        return mass * sp.Add(*squares) / 2

    def _ends(self, mass: sp.Symbol, load: Load) -> tuple[Place, Place]:
        """Rear and front of a load as places, named after its mass."""
        half = self.body.length / 2
        index = mass.name.removeprefix("m_")
        if load.front is None or load.rear is None:
            return (Place("payload", index, -self.length / 2, -half),
                    Place("payload", index, self.length / 2, half))  # fmt: skip
        ends = (Place("payload", index, sp.Float(x), x) for x in (load.rear, load.front))
        return next(ends), next(ends)

    @property
    def length(self) -> sp.Expr:
        """The body's length, a number: its modes belong to it."""
        return sp.Float(self.body.length)

    def shapes_at(self, x: Array, values: Mapping[str, Array]) -> Array:
        """φ_i at x, m, an array that broadcasts with the values': (n, ...)."""
        del values
        return np.asarray(self.modes.shapes(x))

    def dependent_values(
        self, values: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """The values of the shapes where something is attached, and their means over loads."""
        known: dict[tuple[Place, Place], tuple[Array, Array, Array]] = {}
        found = {}
        for symbol in wanted:
            if not isinstance(symbol, Shape):
                continue
            if symbol.span not in known:
                known[symbol.span] = self._sampled(symbol.span, values)
            x, weights, phi = known[symbol.span]
            product = np.prod([phi[i - 1] for i in symbol.modes], axis=0) * x**symbol.power
            found[symbol.name] = np.asarray((product * weights).sum(axis=-1))
        return found

    def shape_slopes_at(
        self, x: Array, dx: Array, values: Mapping[str, Array], slopes: Mapping[str, Array]
    ) -> Array | None:
        """dφ_i/dp at points x (q,) that move by dx (..., q): (n, ..., q); None where unknown."""
        del values, slopes
        return None if self.modes.slopes is None else along(self.modes.slopes(x), dx)

    def dependent_slopes(
        self, values: Mapping[str, Array], slopes: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """Those of the shapes where something is attached, where the shapes' slopes are known."""
        found = {}
        still = np.zeros_like(next(iter(slopes.values())))
        known: dict[tuple[Place, Place], tuple[Array, ...]] = {}
        for symbol in wanted:
            if not isinstance(symbol, Shape):
                continue
            if symbol.span not in known:
                x, weights, phi = self._sampled(symbol.span, values)
                dx = _moves(symbol.span, x, values, slopes)
                dphi = self.shape_slopes_at(x, dx, values, slopes)
                if dphi is None:
                    return {}
                known[symbol.span] = x, dx, weights, phi, dphi
            x, dx, weights, phi, dphi = known[symbol.span]
            factors = [(x, dx)] * symbol.power + [(phi[i - 1], dphi[i - 1]) for i in symbol.modes]
            total = np.zeros_like(x)
            for k, (_, change) in enumerate(factors):
                others = [factor for j, (factor, _) in enumerate(factors) if j != k]
                total = total + change * np.prod(others, axis=0)
            found[symbol.name] = still + total @ weights
        return found

    def _sampled(
        self, span: tuple[Place, Place], values: Mapping[str, Array]
    ) -> tuple[Array, Array, Array]:
        """Points x (..., q) of a span, their weights (q,), and the shapes there, (n, ..., q)."""
        for place in span:
            self.check_moved(place, values)
        rear, front = (place.value(values)[..., np.newaxis] for place in span)
        knots = [(k - span[0].at) / (span[1].at - span[0].at) for k in self.modes.knots
                 if span[0].at < k < span[1].at]  # fmt: skip
        u, weights = quadrature(self.modes.count, tuple(sorted(knots)))
        if span[0] == span[1]:
            u, weights = np.zeros(1), np.ones(1)
        x = rear + (front - rear) * u
        spread = {name: value[..., np.newaxis] for name, value in values.items()}
        return x, weights, self.shapes_at(x, spread)


def _count(n: int) -> str:
    return f"{n} bending mode{'s' * (n != 1)}"


def along(slopes: Array, dx: Array) -> Array:
    """φ_i' dx of slopes (n, q) and moves (..., q): (n, ..., q)."""
    return slopes.reshape(len(slopes), *[1] * (dx.ndim - 1), -1) * dx


def _moves(
    span: tuple[Place, Place], x: Array, values: Mapping[str, Array], slopes: Mapping[str, Array]
) -> Array:
    """How points x (q,) of a span move with its ends: (P, q), or (q,) where nothing moves."""
    (rear, front), (start, end) = span, (place.value(values) for place in span)
    u = (x - start) / (end - start) if rear != front else np.zeros(1)
    found = np.multiply.outer(rear.slope(slopes), 1 - u)
    return np.asarray(found + np.multiply.outer(front.slope(slopes), u))
