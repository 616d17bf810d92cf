r"""The running gear: bogies on their suspensions, under any car body.

Each bogie adds its heave z_b and pitch θ_b, and springs and dampers that act vertically:

.. math:: T = \tfrac12 m_b \dot z_b^2 + \tfrac12 I_b \dot\theta_b^2, \quad
          V = \tfrac12 k_2 s^2 + \sum_j \tfrac12 k_1 p_j^2, \quad
          D = \tfrac12 c_2 \dot s^2 + \sum_j \tfrac12 c_1 \dot p_j^2

.. math:: s = z_{body}(x_b) - z_b, \qquad p_j = z_b + l_j \sin\theta_b - w_j

A damper on an elastic mount k_d (Maxwell's element) has a stroke d of its own, a coordinate without
mass, and adds ½ k_d (s - d)² to V and ½ c_2 ḋ² to D in place of ½ c_2 ṡ².

with the extension s of the secondary suspension and p_j of the primary suspension of wheelset j.
Heights count from static equilibrium: preloads carry the weight. An actuator force f, positive when
it pushes body and bogie apart, does the virtual work f δs.

Source: Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848, Figure 2 and Table 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp
from sympy import sin

from railride.bodies import BodyModel, Parameter, Place
from railride.lagrange import Coordinate, Force, Input, Lagrangian
from railride.parameters import Vehicle

SYMBOLS = {
    "mass": ("m_b", "bogie mass", "kg"),
    "pitch_inertia": ("I_b", "bogie pitch inertia", "kg m^2"),
    "primary_stiffness": ("k_1", "primary stiffness per axle", "N/m"),
    "primary_damping": ("c_1", "primary damping per axle", "N s/m"),
    "secondary_stiffness": ("k_2", "secondary stiffness per bogie", "N/m"),
    "secondary_damping": ("c_2", "secondary damping per bogie", "N s/m"),
}

OPTIONAL = {
    "wheelset_mass": ("m_w", "wheelset mass", "kg"),
    "primary_damper_stiffness": ("k_d1", "primary damper's mount, per axle", "N/m"),
    "secondary_damper_stiffness": ("k_d2", "secondary damper's mount, per bogie", "N/m"),
}


def bogie_heave(b: int) -> Coordinate:
    """Height of bogie b's mass centre."""
    return Coordinate(f"z_b{b}")


def bogie_pitch(b: int) -> Coordinate:
    """Pitch of bogie b."""
    return Coordinate(f"theta_b{b}")


def secondary_deflection(b: int) -> Coordinate:
    """Extension of the secondary suspension over bogie b."""
    return Coordinate(f"s_{b}")


def primary_deflection(j: int) -> Coordinate:
    """Extension of the primary suspension over wheelset j."""
    return Coordinate(f"p_{j}")


def secondary_stroke(b: int) -> Coordinate:
    """Stroke of the secondary damper over bogie b, where its mount is elastic."""
    return Coordinate(f"d_s{b}")


def primary_stroke(j: int) -> Coordinate:
    """Stroke of the primary damper over wheelset j, where its mount is elastic."""
    return Coordinate(f"d_p{j}")


def wheelset_elevation(j: int) -> Input:
    """Track elevation under wheelset j."""
    return Input(f"w_{j}")


def actuator(b: int) -> Force:
    """Force of the actuator beside the secondary suspension over bogie b."""
    return Force(f"f_{b}")


@dataclass(frozen=True)
class RunningGear:
    """The bogies of a vehicle, numbered from the front as their wheelsets are.

    What all bogies have alike is one symbol, k_2; what differs has one each, k_2_b1 and k_2_b2.
    """

    vehicle: Vehicle

    @property
    def bogies(self) -> range:
        """The bogies' numbers."""
        return range(1, len(self.vehicle.bogies) + 1)

    def under(self, body: BodyModel, loaded: Lagrangian) -> Lagrangian:
        """The whole vehicle: the energies of a body with what it carries, and of the bogies."""
        T, V, D = [loaded.kinetic], [loaded.potential], [loaded.dissipation]
        kinematics = dict(loaded.kinematics)
        for b in self.bogies:
            m_b, I_b, k_1, c_1, k_2, c_2 = (self.symbol(name, b) for name in SYMBOLS)
            z, theta, s = bogie_heave(b), bogie_pitch(b), secondary_deflection(b)
            kinematics[s] = body.height(self.place(b)) - z
            T += [m_b * z.dot**2 / 2, I_b * theta.dot**2 / 2]
            V.append(k_2 * s**2 / 2)
            stroke = self._stroke("secondary_damper_stiffness", b, s, secondary_stroke(b), V)
            D.append(c_2 * stroke.dot**2 / 2)
            for j, lever in self.levers(b):
                p = primary_deflection(j)
                kinematics[p] = z + lever * sin(theta) - wheelset_elevation(j)
                V.append(k_1 * p**2 / 2)
                stroke = self._stroke("primary_damper_stiffness", b, p, primary_stroke(j), V)
                D.append(c_1 * stroke.dot**2 / 2)
        own = [q(b) for b in self.bogies for q in (bogie_heave, bogie_pitch)] + self.strokes
        wheelsets = range(1, len(self.vehicle.wheelset_positions) + 1)
        return Lagrangian(
            [*loaded.coordinates, *own],
            sp.Add(*T),
            sp.Add(*V),
            sp.Add(*D),
            inputs=[wheelset_elevation(j) for j in wheelsets],
            forces=[actuator(b) for b in self.bogies],
            virtual_work=[(actuator(b), secondary_deflection(b)) for b in self.bogies],
            kinematics=kinematics,
        )

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Each parameter of the bogies once, with its value."""
        found: dict[sp.Symbol, Parameter] = {}
        for b, bogie in zip(self.bogies, self.vehicle.bogies, strict=True):
            for name, (_, meaning, unit) in (SYMBOLS | OPTIONAL).items():
                if getattr(bogie, name) is not None:
                    symbol = self.symbol(name, b)
                    found[symbol] = Parameter(symbol, meaning, unit, getattr(bogie, name))
            places = [(self.place(b).x, "bogie position, from the body's middle", bogie.position)]
            places += [
                (lever, "wheelset position, from the bogie's centre", x)
                for (_, lever), x in zip(self.levers(b), bogie.wheelsets, strict=True)
            ]
            for place, meaning, value in places:
                for symbol in place.free_symbols:
                    sign = int(place / symbol)
                    found[symbol] = Parameter(symbol, meaning, "m", sign * value)
        return tuple(found.values())

    @property
    def strokes(self) -> list[Coordinate]:
        """The strokes of dampers on elastic mounts: of each bogie's secondary, then its primary."""
        found = []
        for b, bogie in zip(self.bogies, self.vehicle.bogies, strict=True):
            if bogie.secondary_damper_stiffness is not None:
                found.append(secondary_stroke(b))
            if bogie.primary_damper_stiffness is not None:
                found += [primary_stroke(j) for j, _ in self.levers(b)]
        return found

    def wheel_load(self, b: int, j: int) -> sp.Expr:
        """Dynamic load of wheelset j on bogie b, N: m_w ẅ - k_1 p - c_1 ḋ, d = p or stroke."""
        k_1, c_1 = self.symbol("primary_stiffness", b), self.symbol("primary_damping", b)
        p, m_w = primary_deflection(j), self.symbol("wheelset_mass", b)
        stroke = primary_stroke(j) if primary_stroke(j) in self.strokes else p
        return m_w * wheelset_elevation(j).ddot - k_1 * p - c_1 * stroke.dot

    def _stroke(self, mount: str, b: int, extension: Coordinate, stroke: Coordinate,
                V: list[sp.Expr]) -> Coordinate:  # fmt: skip
        """What the damper sees of an extension; its mount's energy is added to V."""
        if getattr(self.vehicle.bogies[b - 1], mount) is None:
            return extension
        V.append(self.symbol(mount, b) * (extension - stroke) ** 2 / 2)
        return stroke

    def symbol(self, name: str, b: int) -> sp.Symbol:
        """The symbol of a bogie's parameter, a key of :data:`SYMBOLS` or :data:`OPTIONAL`."""
        symbol = (SYMBOLS | OPTIONAL)[name][0]
        agree = len({getattr(bogie, name) for bogie in self.vehicle.bogies}) == 1
        own = f"{symbol}{b}" if symbol.endswith("_b") else f"{symbol}_b{b}"
        sign = {"nonnegative": True} if name.endswith("damping") else {"positive": True}
        return sp.Symbol(symbol if agree else own, **sign)

    def place(self, b: int) -> Place:
        """Bogie b's position: ±l_b for a mirrored pair, else a symbol of its own."""
        positions = [bogie.position for bogie in self.vehicle.bogies]
        return Place(
            f"bogie {b}", f"b{b}", _places(positions, "l_b", "x_b")[b - 1], positions[b - 1]
        )

    @property
    def wheelset_places(self) -> list[sp.Expr]:
        """x of every wheelset, from the front: its bogie's position and its place there."""
        return [self.place(b).x + lever for b in self.bogies for _, lever in self.levers(b)]

    def levers(self, b: int) -> list[tuple[int, sp.Expr]]:
        """The wheelsets of bogie b: number on the vehicle, and place on the bogie."""
        wheelsets = self.vehicle.bogies[b - 1].wheelsets
        own = "" if len({bogie.wheelsets for bogie in self.vehicle.bogies}) == 1 else f"_b{b}"
        before = sum(len(bogie.wheelsets) for bogie in self.vehicle.bogies[: b - 1])
        return list(enumerate(_places(wheelsets, "l_w", "x_w", own), start=before + 1))


def _places(places: Sequence[float], mirrored: str, single: str, own: str = "") -> list[sp.Expr]:
    """Places as symbols: 0, ± one symbol for a mirrored pair, or one symbol each."""
    pairs = sorted({abs(x) for x in places if x and -x in places}, reverse=True)
    found: list[sp.Expr] = []
    for number, x in enumerate(places, start=1):
        if not x:
            found.append(sp.S.Zero)
        elif abs(x) in pairs:
            pair = "" if len(pairs) == 1 else str(pairs.index(abs(x)) + 1)
            name = f"{mirrored}{pair}{own}"
            found.append(sp.Symbol(name, positive=True) * (1 if x > 0 else -1))
        else:
            found.append(sp.Symbol(f"{single}{number}{own}", real=True))
    return found
