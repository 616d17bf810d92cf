r"""The car body as N rigid segments joined by hinges with torsional springs and dampers.

The coordinates are the heights z_0 … z_N of the nodes: front end, hinges, rear end. Segment i lies
between the nodes i-1 and i, so that its pitch and the height of its middle are

.. math:: \sin\theta_i = \frac{z_{i-1} - z_i}{\ell_i}, \qquad z = \frac{z_{i-1} + z_i}{2} .

The body's middle is held in x, and x_i, the place of the segment's middle, shortens by cos θ.
Where it is cut, how its mass is distributed and what its joints follow from: see the modules
:mod:`~railride.bodies.cuts`, :mod:`~railride.bodies.masses` and :mod:`~railride.bodies.joints`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp
from sympy import asin, cos, sin

from railride.bodies import floors
from railride.bodies.base import BodyModel, Parameter, Place
from railride.bodies.cuts import Cuts
from railride.bodies.floors import theta, z
from railride.bodies.joints import Joints
from railride.bodies.masses import Masses, distribution
from railride.errors import InputError
from railride.lagrange import Coordinate, Lagrangian, rate
from railride.numeric import Array
from railride.parameters import Load


def x(i: int) -> Coordinate:
    """Place of the middle of segment i along the track."""
    return Coordinate(f"x_{i}")


def middle(i: int) -> tuple[sp.Expr, sp.Expr]:
    """Place (x, z) of the middle of segment i."""
    return x(i), (z(i - 1) + z(i)) / 2


@dataclass(frozen=True)
class SegmentedBody(BodyModel):
    """A body of ``number`` ≥ 2 segments.

    Raises
    ------
    InputError : a body without a bending frequency or stiffness; another number than its own
        segments, cuts or joints have; a mass and inertia that the chosen distribution cannot hold.
    """

    number: int

    kind = "segments"

    def __post_init__(self) -> None:
        self.check_values(self._own_values)
        if len(self.joints.targets) > 1:
            self.dependent_values(self._own_values, self.joints.followers)

    @cached_property
    def _own_values(self) -> dict[str, Array]:
        """The body's own parameters and definitions."""
        own = {p.symbol: p.value for p in self.parameters}
        for symbol, definition in self.definitions.items():
            own[symbol] = float(definition.subs(own))
        return {symbol.name: np.asarray(value) for symbol, value in own.items()}

    @cached_property
    def masses(self) -> Masses:
        """The segments' masses."""
        return distribution(self.body, self.number)

    @property
    def cuts(self) -> Cuts:
        """Where the segments begin and end."""
        return self.masses.cuts

    @cached_property
    def joints(self) -> Joints:
        """The springs and dampers between them."""
        return Joints(self.body, self.cuts)

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
    def inertia(self) -> str:
        """How mass and inertia are distributed: 'rods', 'graded', 'segments' or 'own'."""
        return self.masses.kind

    @cached_property
    def energies(self) -> Lagrangian:
        """The free chain of segments."""
        N, cuts = self.number, self.cuts
        segments, joints = range(1, N + 1), range(1, N)
        kinematics = {theta(i): asin((z(i - 1) - z(i)) / cuts.ell(i)) for i in segments}
        kinematics |= self._places()
        k, c = self.joints.stiffness, self.joints.damping
        T = sp.Add(*(_kinetic(i, *self.masses.moments(i)) for i in segments))
        V = sp.Add(*(k[j - 1] * (theta(j) - theta(j + 1)) ** 2 / 2 for j in joints))
        D = sp.Add(*(c[j - 1] * (theta(j).dot - theta(j + 1).dot) ** 2 / 2 for j in joints))
        return Lagrangian([z(i) for i in range(N + 1)], T, V, D, kinematics=kinematics)

    def _places(self) -> dict[Coordinate, sp.Expr]:
        """x_i outwards from the body's middle, which is a hinge or on a segment."""
        N, cuts = self.number, self.cuts
        half = {i: cuts.ell(i) / 2 * cos(theta(i)) for i in range(1, N + 1)}
        front = cuts.segment_at(0.0)  # the segment that has the middle, or ends there
        hinge = abs(cuts.nodes[front]) < 1e-9 * cuts.length
        places = {x(front): half[front] if hinge else cuts.middle(front) * cos(theta(front))}
        for i in range(front - 1, 0, -1):
            places[x(i)] = x(i + 1) + half[i + 1] + half[i]
        for i in range(front + 1, N + 1):
            inner = 0 if hinge and i == front + 1 else x(i - 1) - half[i - 1]
            places[x(i)] = inner - half[i]
        return places

    def load_energy(self, mass: sp.Symbol, load: Load) -> sp.Expr:
        """T of the pieces of an even load, or of a point load, on the segments that carry it."""
        cuts, nodes = self.cuts, self.cuts.nodes.tolist()
        if load.front is None or load.rear is None:
            length = sp.Add(*(cuts.ell(i) for i in range(1, self.number + 1)))
            shares = {i: mass * cuts.ell(i) / length for i in range(1, self.number + 1)}
            rods = (_kinetic(i, m, 0, m * cuts.ell(i) ** 2 / 12) for i, m in shares.items())
            return sp.Add(*rods)
        if load.front == load.rear:
            self.check_point(load.front)
            i = cuts.segment_at(load.front)
            u = load.front - cuts.middle(i)
            return _kinetic(i, mass, mass * u, mass * u**2)
        pieces = []
        for i in range(1, self.number + 1):
            front, rear = min(load.front, nodes[i - 1]), max(load.rear, nodes[i])
            if front <= rear:
                continue
            share = mass * (front - rear) / (load.front - load.rear)
            u = (front + rear) / 2 - cuts.middle(i)
            pieces.append(_kinetic(i, share, share * u, share * (u**2 + (front - rear) ** 2 / 12)))
        return sp.Add(*pieces)

    @property
    def positions(self) -> Mapping[str, tuple[sp.Expr, sp.Expr]]:
        """Those of the segments' middles."""
        return {str(i): middle(i) for i in range(1, self.number + 1)}

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What the masses and the joints are made from."""
        return (*self.masses.parameters, *self.joints.parameters)

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """Those of the masses and of the joints."""
        return {**self.masses.definitions, **self.joints.definitions}

    @property
    def lift(self) -> Mapping[Coordinate, int]:
        """A uniform lift raises every node alike."""
        return {z(i): 1 for i in range(self.number + 1)}

    @property
    def pitch(self) -> Mapping[Coordinate, sp.Expr]:
        """The places of the nodes."""
        return {z(i): self.cuts.node(i) for i in range(self.number + 1)}

    @property
    def nodes(self) -> Array:
        """Front end, hinges, rear end."""
        return self.cuts.nodes

    @property
    def followers(self) -> Mapping[sp.Symbol, tuple[str, str]]:
        """Stiffness and damping of the joints, unless they are given."""
        return self.joints.followers

    def dependent_values(
        self, values: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """Stiffness and damping of the joints, as :class:`~railride.bodies.joints.Joints` knows."""
        return self.joints.follow(values, wanted, self)

    def dependent_slopes(
        self, values: Mapping[str, Array], slopes: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """Those of the joints' stiffness and damping, unless several frequencies calibrate them."""
        return self.joints.follow_slopes(values, slopes, wanted, self)

    def height(self, place: Place) -> sp.Expr:
        """On the polygon: there the suspensions are attached."""
        self.check_point(place.at)
        return floors.polygon(self.cuts, self.cuts.segment_at(place.at), place.x)

    def floor(self, at: float, reading: str) -> sp.Expr:
        """The polygon, or a line through it: see :mod:`railride.bodies.floors`."""
        self.check_reading(reading)
        self.check_point(at)
        read = {"polygon": floors.polygon, "smooth": floors.smooth, "spline": floors.spline}
        return read[reading](self.cuts, self.cuts.segment_at(at), sp.Float(at))

    @property
    def remarks(self) -> tuple[str, ...]:
        """What became of the inertia and the stiffnesses that were given."""
        found = [*self.masses.remarks, *self.joints.remarks]
        given = "joint stiffnesses" if isinstance(self.body.joint_stiffness, tuple) else ""
        given = given or ("profile's bending stiffness" if self.body.profile is not None else "")
        if given and self.joints.targets:
            k = self.dependent_values(self._own_values, set(self.joints.stiffness))
            ratios = [float(k[s.name]) for s in self.joints.stiffness] / self.joints.start
            by = " to ".join(dict.fromkeys(f"{r:.4g}" for r in (ratios.min(), ratios.max())))
            found.append(f"the {given} taken {by} times, to meet the bending frequencies given")
        return tuple(found)

    def check_moved(self, place: Place, values: Mapping[str, Array]) -> None:
        """Refuse a place on another segment than the one whose height was taken."""
        nodes, here = self.cuts.moved(values), self.cuts.segment_at(place.at)
        at, near = place.value(values), 1e-9 * self.cuts.length / self.number
        if (at > nodes[..., here - 1] + near).any() or (at < nodes[..., here] - near).any():
            raise InputError(
                f"{place.name}: found it on another segment than segment {here}, on which the "
                "model was derived; expected positions that stay there (derive the changed "
                "vehicle)"
            )

    def check_values(self, values: Mapping[str, Array]) -> None:
        """Refuse lengths that may not change, and masses and inertias that cannot be."""
        self.cuts.moved(values)
        self.masses.check(values)


def _kinetic(i: int, m: sp.Expr, S: sp.Expr, J: sp.Expr) -> sp.Expr:
    r"""Kinetic energy of what segment i carries, by its moments about the segment's middle.

    .. math:: T_i = \tfrac12 m (\dot x^2 + \dot z^2)
              + S \dot\theta (\dot z \cos\theta - \dot x \sin\theta) + \tfrac12 J \dot\theta^2
    """
    (v_x, v_z), omega = map(rate, middle(i)), theta(i).dot
    T = m * (v_x**2 + v_z**2) / 2 + J * omega**2 / 2
    return T + S * omega * (v_z * cos(theta(i)) - v_x * sin(theta(i))) if S != 0 else T
