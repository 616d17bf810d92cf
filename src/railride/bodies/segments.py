r"""The car body as N equal rigid segments joined by hinges with torsional springs and dampers.

The coordinates are the heights z_0 … z_N of the nodes: front end, hinges, rear end. Segment i lies
between the nodes i-1 and i, so that its pitch and the height of its middle are

.. math:: \sin\theta_i = \frac{z_{i-1} - z_i}{\ell}, \qquad z = \frac{z_{i-1} + z_i}{2},
          \qquad \ell = \frac{L}{N} .

The body's middle is held in x, and x_i, the place of the segment's middle, shortens by cos θ.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import floor

import numpy as np
import sympy as sp
from sympy import Rational, asin, cos, sin

from railride.bodies.base import BodyModel, Parameter, Place
from railride.bodies.rigid import I_c, e_c, m_c
from railride.bodies.structural_damping import MEANING, zeta_bending
from railride.errors import InputError
from railride.lagrange import Coordinate, Lagrangian
from railride.numeric import Array
from railride.parameters import Load

L, k_theta, EI = sp.symbols("L k_theta EI", positive=True)
f_bending, J_s = sp.symbols("f_bending J_s", positive=True)
c_theta = sp.Symbol("c_theta", nonnegative=True)
mu_0, mu_1, mu_2 = sp.symbols("mu_0 mu_1 mu_2", real=True)

ROD_TOLERANCE = 0.05  # of I_c: within it the segments are equal rods


def z(i: int) -> Coordinate:
    """Height of node i."""
    return Coordinate(f"z_{i}")


def theta(i: int) -> Coordinate:
    """Pitch of segment i."""
    return Coordinate(f"theta_{i}")


def x(i: int) -> Coordinate:
    """Place of the middle of segment i along the track."""
    return Coordinate(f"x_{i}")


@dataclass(frozen=True)
class SegmentedBody(BodyModel):
    """A body of ``number`` ≥ 2 segments.

    Raises
    ------
    InputError : a body without a bending frequency or stiffness; a mass and inertia that the
        chosen distribution cannot hold (``body.inertia``, see :meth:`inertia`).
    """

    number: int

    kind = "segments"

    def __post_init__(self) -> None:
        if self.body.profile is not None:
            raise InputError("body.profile: found it with equal segments; expected none")
        if not self.stiffness_given:
            raise InputError(
                f"segments: found {self.number} segments of a body whose bending is not known; "
                "expected a bending frequency or a joint stiffness (give one of them, or take "
                "one segment: the rigid body)"
            )
        if self.inertia != "graded" and self.body.mass_centre:
            raise InputError(
                f'body.inertia: found "{self.inertia}", equal masses, with the mass centre at '
                f'{self.body.mass_centre:g} m; expected it at the middle (use "graded")'
            )
        if self.inertia != "rods":
            own = {p.symbol: p.value for p in self.parameters}
            for symbol, definition in self.definitions.items():
                own[symbol] = float(definition.subs(own))
            self.check_values({symbol.name: np.asarray(value) for symbol, value in own.items()})

    @property
    def segments(self) -> int:
        """N."""
        return self.number

    @property
    def title(self) -> str:
        """How many segments."""
        return f"{self.number} segments"

    @property
    def phrase(self) -> str:
        """How many segments, in full."""
        return f"a car body of {self.number} rigid segments"

    @property
    def stiffness_given(self) -> str:
        """What the joint stiffness comes from: 'frequency', 'joint', 'EI' or nothing."""
        body = self.body
        given = {"frequency": body.bending_frequency, "joint": body.joint_stiffness}
        given["EI"] = body.bending_stiffness
        return next((name for name, value in given.items() if value is not None), "")

    @property
    def inertia(self) -> str:
        """How mass and inertia are distributed: 'rods', 'graded' or 'segments'.

        ``rods``: equal slender rods; chosen where the pitch inertia of a uniform body is within
        5 % of I_c. ``graded``: mass per length μ(x) = μ_0 + μ_1 x + μ_2 x², so that m_c, the
        mass centre and I_c all hold. ``segments``: equal masses, each segment's own pitch inertia
        J_s such that the whole has I_c.
        """
        body = self.body
        if body.inertia != "auto":
            return body.inertia
        uniform = body.mass * body.length**2 / 12
        is_rod = abs(uniform - body.pitch_inertia) <= ROD_TOLERANCE * body.pitch_inertia
        return "rods" if is_rod and not body.mass_centre else "graded"

    @cached_property
    def energies(self) -> Lagrangian:
        """The free chain of segments."""
        N, ell = self.number, L / self.number
        segments, joints = range(1, N + 1), range(1, N)
        kinematics = {theta(i): asin((z(i - 1) - z(i)) / ell) for i in segments}
        kinematics |= self._places(ell)
        T = sp.Add(*(_kinetic(i, *self._moments(i, ell)) for i in segments))
        V = sp.Add(*(k_theta * (theta(i) - theta(i + 1)) ** 2 / 2 for i in joints))
        D = sp.Add(*(c_theta * (theta(i).dot - theta(i + 1).dot) ** 2 / 2 for i in joints))
        return Lagrangian([z(i) for i in range(N + 1)], T, V, D, kinematics=kinematics)

    def _places(self, ell: sp.Expr) -> dict[Coordinate, sp.Expr]:
        """x_i outwards from the body's middle, which is a hinge or the middle of a segment."""
        N = self.number
        front, rear = N // 2, (N + 1) // 2 + 1  # the segments next to the middle
        places: dict[Coordinate, sp.Expr] = {x(rear - 1): sp.S.Zero} if N % 2 else {}
        for i in range(front, 0, -1):
            inner = x(i + 1) + ell / 2 * cos(theta(i + 1)) if i < front or N % 2 else 0
            places[x(i)] = inner + ell / 2 * cos(theta(i))
        for i in range(rear, N + 1):
            inner = x(i - 1) - ell / 2 * cos(theta(i - 1)) if i > rear or N % 2 else 0
            places[x(i)] = inner - ell / 2 * cos(theta(i))
        return places

    def load_energy(self, mass: sp.Symbol, load: Load) -> sp.Expr:
        """T of the pieces of an even load, or of a point load, on the segments that carry it."""
        N, ell = self.number, L / self.number
        if load.front is None or load.rear is None:
            share = mass / N
            return sp.Add(*(_kinetic(i, share, 0, share * ell**2 / 12) for i in range(1, N + 1)))
        if load.front == load.rear:
            i = self.segment_at(load.front)
            u = load.front - Rational(N + 1 - 2 * i, 2) * ell
            return _kinetic(i, mass, mass * u, mass * u**2)
        pieces, step = [], self.body.length / N
        for i in range(self.segment_at(load.front), self.segment_at(load.rear) + 1):
            ends = self.body.length / 2 - (i - 1) * step, self.body.length / 2 - i * step
            front, rear = min(load.front, ends[0]), max(load.rear, ends[1])
            if front <= rear:
                continue
            share = mass * (front - rear) / (load.front - load.rear)
            u = (front + rear) / 2 - Rational(N + 1 - 2 * i, 2) * ell
            pieces.append(_kinetic(i, share, share * u, share * (u**2 + (front - rear) ** 2 / 12)))
        return sp.Add(*pieces)

    def _moments(self, i: int, ell: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """Mass, first and second moment ∫ μ uⁿ du of segment i about its middle."""
        m = m_c / self.number
        if self.inertia == "rods":
            return m, sp.S.Zero, m * ell**2 / 12
        if self.inertia == "segments":
            return m, sp.S.Zero, J_s
        middle = Rational(self.number + 1 - 2 * i, 2) * ell
        mu_1 = self._slope
        return (
            ell * (mu_0 + mu_1 * middle + mu_2 * (middle**2 + ell**2 / 12)),
            ell**3 / 12 * (mu_1 + 2 * mu_2 * middle),
            ell**3 / 12 * (mu_0 + mu_1 * middle + mu_2 * (middle**2 + 3 * ell**2 / 20)),
        )

    @property
    def _slope(self) -> sp.Expr:
        """μ_1: zero where the mass centre is at the middle."""
        return mu_1 if self.body.mass_centre else sp.S.Zero

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """m_c, L, what the inertia and the joints are made from."""
        body = self.body
        found = [
            Parameter(m_c, "car-body mass", "kg", body.mass),
            Parameter(L, "car-body length", "m", body.length),
        ]
        if self.inertia != "rods":
            found.append(Parameter(I_c, "car-body pitch inertia", "kg m^2", body.pitch_inertia))
        if self.inertia == "graded" and self.body.mass_centre:
            found.append(Parameter(e_c, "mass centre forward of the middle", "m", body.mass_centre))
        if body.bending_frequency is not None:
            found.append(Parameter(f_bending, "free-free first bending frequency", "Hz",
                                   body.bending_frequency))  # fmt: skip
        if body.joint_stiffness is not None:
            found.append(Parameter(k_theta, "joint stiffness", "N m/rad", body.joint_stiffness))
        if body.bending_stiffness is not None:
            found.append(Parameter(EI, "bending stiffness", "N m^2", body.bending_stiffness))
        if body.joint_damping is not None:
            found.append(Parameter(c_theta, "joint damping", "N m s/rad", body.joint_damping))
        else:
            found.append(Parameter(zeta_bending, MEANING, "", body.bending_damping))
        return tuple(found)

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """μ_0, μ_1, μ_2 or J_s; k_θ = EI/ℓ. Calibrated joints are the vehicle's to evaluate."""
        defined: dict[sp.Symbol, sp.Expr] = {}
        if self.inertia == "graded":
            e = e_c if self.body.mass_centre else sp.S.Zero
            defined[mu_2] = 180 * (I_c + m_c * e**2 - m_c * L**2 / 12) / L**5
            if e:
                defined[mu_1] = 12 * m_c * e / L**3
            defined[mu_0] = m_c / L - mu_2 * L**2 / 12
        if self.inertia == "segments":
            N = self.number
            defined[J_s] = I_c / N - m_c * L**2 * Rational(N**2 - 1, 12 * N**3)
        if self.stiffness_given == "EI":
            defined[k_theta] = EI * self.number / L
        return defined

    @property
    def lift(self) -> Mapping[Coordinate, int]:
        """A uniform lift raises every node alike."""
        return {z(i): 1 for i in range(self.number + 1)}

    @property
    def pitch(self) -> Mapping[Coordinate, sp.Expr]:
        """The places of the nodes."""
        N = self.number
        return {z(i): Rational(N - 2 * i, 2 * N) * L for i in range(N + 1)}

    @property
    def nodes(self) -> Array:
        """Front end, hinges, rear end."""
        return np.linspace(0.5, -0.5, self.number + 1) * self.body.length

    @property
    def followers(self) -> Mapping[sp.Symbol, tuple[str, str]]:
        """k_θ and c_θ, unless they are given."""
        found = {k_theta: ("joint stiffness", "N m/rad"), c_theta: ("joint damping", "N m s/rad")}
        known = {p.symbol for p in self.parameters}
        return {symbol: said for symbol, said in found.items() if symbol not in known}

    def dependent_values(
        self, values: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """k_θ = (2π f_1)²/λ_1 and c_θ = 2 ζ k_θ/ω_1, λ_1 = ω_1²/k_θ of the free body.

        Source for c_θ: a joint moment k_θ γ + c_θ γ̇ damps the first mode by c_θ ω_1/(2 k_θ).
        """
        left, found = set(wanted) & {k_theta, c_theta}, dict(values)
        if left:
            unit = self.bending_frequencies({**values, k_theta.name: np.array(1.0)})[..., 0]
        if k_theta in left:
            found[k_theta.name] = (values[f_bending.name] / unit) ** 2
        if c_theta in left:
            stiffness = found[k_theta.name]
            omega = 2 * np.pi * unit * np.sqrt(stiffness)
            found[c_theta.name] = 2 * values[zeta_bending.name] * stiffness / omega
        return {s.name: found[s.name] for s in (k_theta, c_theta) if s in left}

    def segment_at(self, at: float) -> int:
        """The number of the segment on which the point lies; at a hinge the one ahead of it."""
        self.check_point(at)
        behind_front = (0.5 - at / self.body.length) * self.number
        nearest = round(behind_front)
        if abs(behind_front - nearest) < 1e-9:
            return max(nearest, 1)
        return min(max(floor(behind_front) + 1, 1), self.number)

    def height(self, place: Place) -> sp.Expr:
        """z = (1 - ξ) z_{i-1} + ξ z_i along the segment, ξ from its front node."""
        return self._polygon(place.x, self.segment_at(place.at))

    def _polygon(self, at: sp.Expr, i: int) -> sp.Expr:
        xi = Rational(self.number, 2) - (i - 1) - self.number * at / L
        return (1 - xi) * z(i - 1) + xi * z(i)

    def floor(self, at: float, reading: str) -> sp.Expr:
        r"""The polygon itself, or the smooth floor that has the polygon's mean over each segment.

        .. math:: z_{floor} = z_{polygon} + \kappa \ell^2 (\xi^2/2 - 1/24), \quad
                  -\tfrac12 \le \xi \le \tfrac12

        with κ ℓ = θ_ahead - θ_behind at a hinge, linear between hinges, zero at the free ends.
        """
        self.check_reading(reading)
        i, N = self.segment_at(at), self.number
        polygon = self._polygon(sp.Float(at), i)
        if reading == "polygon":
            return polygon
        ell = L / N
        xi = at / ell - Rational(N + 1 - 2 * i, 2)  # forward of the segment's middle
        bend = [theta(j) - theta(j + 1) if 1 <= j < N else sp.S.Zero for j in (i - 1, i)]
        half = Rational(1, 2)
        kappa_ell = (half + xi) * bend[0] + (half - xi) * bend[1]
        return polygon + kappa_ell * ell * (xi**2 / 2 - Rational(1, 24))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What became of the pitch inertia, where equal rods do not have the one given."""
        uniform, given = self.body.mass * self.body.length**2 / 12, self.body.pitch_inertia
        if self.inertia != "rods" or abs(uniform - given) <= 1e-3 * given:
            return ()
        remark = (
            f"the car body's pitch inertia of {given:.4g} kg m^2 is not used: {self.number} "
            f'equal rods have {uniform:.4g} kg m^2 (inertia = "graded" holds it)'
        )
        return (remark,)

    def check_moved(self, place: Place, values: Mapping[str, Array]) -> None:
        """Refuse a place on another segment than the one whose height was taken."""
        ahead = np.asarray((0.5 - place.value(values) / values["L"]) * self.number)
        here = self.segment_at(place.at)
        if (ahead < here - 1 - 1e-9).any() or (ahead > here + 1e-9).any():
            raise InputError(
                f"{place.name}: found it on another segment than segment {here}, on which the "
                "model was derived; expected positions that stay there (derive the changed "
                "vehicle)"
            )

    def check_values(self, values: Mapping[str, Array]) -> None:
        """Refuse a mass per length or an inertia of the segments that is not positive."""
        if self.inertia == "graded":
            self._refuse_negative_mass(values)
        if self.inertia == "segments" and not np.all(values["J_s"] > 0):
            raise InputError(
                f'body.inertia: found "segments", which needs {np.min(values["J_s"]):.4g} kg m^2 '
                f"in each of {self.number} segments; expected a positive pitch inertia (use "
                '"graded", or fewer segments)'
            )

    def _refuse_negative_mass(self, values: Mapping[str, Array]) -> None:
        """μ(x) is lowest at an end, or where it has its minimum between them."""
        a, b, half = values["mu_0"], values["mu_2"], values["L"] / 2
        d = values.get("mu_1", np.zeros_like(a))
        with np.errstate(divide="ignore", invalid="ignore"):
            minimum = np.where(b > 0, np.clip(-d / (2 * b), -half, half), half)
        lowest = np.min([a + d * s + b * s**2 for s in (-half, half, minimum)])
        if lowest < 0:
            uniform = float(np.max(values["m_c"] * values["L"] ** 2 / 12))
            others = 'set body.inertia to "rods" or "segments"'
            mend = "move the mass centre to the middle" if self.body.mass_centre else others
            raise InputError(
                f"body.pitch_inertia: found {_values(values['I_c'])} kg m^2 with a mass of "
                f"{_values(values['m_c'])} kg, mass centre at {self.body.mass_centre:g} m, for "
                f"which a graded mass per length falls to {lowest:.4g} kg/m; expected values "
                f"nearer to a uniform body's {uniform:.4g} kg m^2 (is one of them wrong? else "
                f"{mend}, or take one segment: the rigid body)"
            )


def _kinetic(i: int, m: sp.Expr, S: sp.Expr, J: sp.Expr) -> sp.Expr:
    r"""Kinetic energy of what segment i carries, by its moments about the segment's middle.

    .. math:: T_i = \tfrac12 m (\dot x^2 + \dot z^2)
              + S \dot\theta (\dot z \cos\theta - \dot x \sin\theta) + \tfrac12 J \dot\theta^2
    """
    v_x, v_z, omega = x(i).dot, (z(i - 1).dot + z(i).dot) / 2, theta(i).dot
    T = m * (v_x**2 + v_z**2) / 2 + J * omega**2 / 2
    return T + S * omega * (v_z * cos(theta(i)) - v_x * sin(theta(i))) if S != 0 else T


def _values(array: Array) -> str:
    """A value, or the range of several."""
    low, high = float(np.min(array)), float(np.max(array))
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"
