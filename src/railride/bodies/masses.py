r"""How mass is distributed over the segments of a car body.

Each segment has mass and first and second moment about the middle of its length, u forward of it,

.. math:: m_i = \int \mu\,du, \qquad S_i = \int \mu u\,du, \qquad J_i = \int \mu u^2\,du .
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp
from sympy import Rational

from railride.bodies.base import Parameter
from railride.bodies.cuts import Cuts, EqualCuts, L, OwnCuts
from railride.bodies.rigid import I_c, e_c, m_c
from railride.errors import InputError
from railride.numeric import Array
from railride.parameters import BodyProfile, CarBody, Segment

J_s = sp.Symbol("J_s", positive=True)
mu_0, mu_1, mu_2 = sp.symbols("mu_0 mu_1 mu_2", real=True)

ROD_TOLERANCE = 0.05  # of I_c: within it equal segments are rods

Moments = tuple[sp.Expr, sp.Expr, sp.Expr]


@dataclass(frozen=True)
class Masses(ABC):
    """The masses of the segments of a body."""

    body: CarBody
    cuts: Cuts

    kind = "own"

    @abstractmethod
    def moments(self, i: int) -> Moments:
        """m, S, J of segment i about its middle."""

    @property
    @abstractmethod
    def parameters(self) -> tuple[Parameter, ...]:
        """The independent parameters, the lengths of the segments among them."""

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """Dependent parameters."""
        return {}

    @property
    def remarks(self) -> tuple[str, ...]:
        """What became of the pitch inertia."""
        return ()

    def check(self, values: Mapping[str, Array]) -> None:
        """Raise :class:`InputError` where a mass or inertia is impossible."""
        del values


@dataclass(frozen=True)
class Rods(Masses):
    """Equal slender rods: m = m_c/N, J = m ℓ²/12."""

    kind = "rods"

    def __post_init__(self) -> None:
        _refuse_offset(self.body)

    def moments(self, i: int) -> Moments:
        """m_c/N, 0, m ℓ²/12."""
        m = m_c / self.cuts.number
        return m, sp.S.Zero, m * self.cuts.ell(i) ** 2 / 12

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """m_c and L."""
        return (_mass(self.body), *self.cuts.parameters)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What became of the pitch inertia, where equal rods do not have the one given."""
        uniform, given = self.body.mass * self.body.length**2 / 12, self.body.pitch_inertia
        if abs(uniform - given) <= 1e-3 * given:
            return ()
        remark = (
            f"the car body's pitch inertia of {given:.4g} kg m^2 is not used: {self.cuts.number} "
            f'equal rods have {uniform:.4g} kg m^2 (inertia = "graded" holds it)'
        )
        return (remark,)


@dataclass(frozen=True)
class OwnInertia(Masses):
    """Equal masses, each segment's own pitch inertia J_s such that the whole body has I_c."""

    kind = "segments"

    def __post_init__(self) -> None:
        _refuse_offset(self.body)

    def moments(self, i: int) -> Moments:
        """m_c/N, 0, J_s."""
        del i
        return m_c / self.cuts.number, sp.S.Zero, J_s

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """m_c, L and I_c."""
        return (_mass(self.body), *self.cuts.parameters, _inertia(self.body))

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """J_s = I_c/N - m_c L² (N² - 1)/(12 N³)."""
        N = self.cuts.number
        return {J_s: I_c / N - m_c * L**2 * Rational(N**2 - 1, 12 * N**3)}

    def check(self, values: Mapping[str, Array]) -> None:
        """Refuse a J_s that is not positive."""
        if not np.all(values["J_s"] > 0):
            raise InputError(
                f'body.inertia: found "segments", which needs {np.min(values["J_s"]):.4g} kg m^2 '
                f"in each of {self.cuts.number} segments; expected a positive pitch inertia (use "
                '"graded", or fewer segments)'
            )


@dataclass(frozen=True)
class Graded(Masses):
    """Mass per length μ(x) = μ_0 + μ_1 x + μ_2 x², with m_c, the mass centre and I_c."""

    kind = "graded"

    def moments(self, i: int) -> Moments:
        """∫ μ uⁿ du of the parabola."""
        ell, middle, slope = self.cuts.ell(i), self.cuts.middle(i), self._slope
        return (
            ell * (mu_0 + slope * middle + mu_2 * (middle**2 + ell**2 / 12)),
            ell**3 / 12 * (slope + 2 * mu_2 * middle),
            ell**3 / 12 * (mu_0 + slope * middle + mu_2 * (middle**2 + 3 * ell**2 / 20)),
        )

    @property
    def _slope(self) -> sp.Expr:
        """μ_1: zero where the mass centre is at the middle."""
        return mu_1 if self.body.mass_centre else sp.S.Zero

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """m_c, L, I_c, and e_c where the mass centre is off the middle."""
        own = (_mass(self.body), *self.cuts.parameters, _inertia(self.body))
        e = Parameter(e_c, "mass centre forward of the middle", "m", self.body.mass_centre)
        return (*own, e) if self.body.mass_centre else own

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """μ_2, μ_1 and μ_0 by m_c, e_c, I_c and L."""
        e = e_c if self.body.mass_centre else sp.S.Zero
        found = {mu_2: 180 * (I_c + m_c * e**2 - m_c * L**2 / 12) / L**5}
        if e:
            found[mu_1] = 12 * m_c * e / L**3
        return found | {mu_0: m_c / L - mu_2 * L**2 / 12}

    def check(self, values: Mapping[str, Array]) -> None:
        """Refuse a negative μ(x): it is lowest at an end, or at its minimum between them."""
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


@dataclass(frozen=True)
class OwnMasses(Masses):
    """Each segment's own mass m_i, pitch inertia J_i and mass centre e_i forward of its middle."""

    segments: tuple[Segment, ...]

    def moments(self, i: int) -> Moments:
        """m_i, m_i e_i, J_i + m_i e_i²."""
        m, J = sp.symbols(f"m_{i} J_{i}", positive=True)
        e = sp.Symbol(f"e_{i}", real=True) if self.segments[i - 1].mass_centre else sp.S.Zero
        return m, m * e, J + m * e**2

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """ℓ_i, m_i and J_i of each segment, and e_i where its mass centre is off its middle."""
        found = []
        for i, (s, length) in enumerate(
            zip(self.segments, self.cuts.parameters, strict=True), start=1
        ):
            m, J = sp.symbols(f"m_{i} J_{i}", positive=True)
            found += [length, Parameter(m, f"mass of segment {i}", "kg", s.mass),
                      Parameter(J, f"pitch inertia of segment {i}", "kg m^2",
                                s.inertia)]  # fmt: skip
            if s.mass_centre:
                found.append(Parameter(sp.Symbol(f"e_{i}", real=True),
                                       f"mass centre of segment {i} forward of its middle", "m",
                                       s.mass_centre))  # fmt: skip
        return tuple(found)


def distribution(body: CarBody, number: int) -> Masses:
    """Cuts and masses of a body of ``number`` segments, as it says itself.

    Raises
    ------
    InputError : another number than the body's own; a piece of a profile without mass or inertia;
        equal masses of a body whose mass centre is off its middle.
    """
    own = number if body.joints is None else body.joints + 1
    if own != number:
        by = "tables [[segments]]" if body.segments else "cuts" if body.cuts else "lists of joints"
        raise InputError(f"segments: found {number}; expected {own}, as the car body's {by} have")
    if body.segments:
        cuts = OwnCuts.of([s.length for s in body.segments])
        return OwnMasses(body, cuts, body.segments)
    if body.profile is not None:
        return _cut(body, body.profile, number)
    equal = EqualCuts(body.length, number)
    if method(body) == "graded":
        return Graded(body, equal)
    return Rods(body, equal) if method(body) == "rods" else OwnInertia(body, equal)


def method(body: CarBody) -> str:
    """``body.inertia``; of "auto", rods where a uniform body's is within 5 %, else graded."""
    if body.inertia != "auto":
        return body.inertia
    uniform = body.mass * body.length**2 / 12
    is_rod = abs(uniform - body.pitch_inertia) <= ROD_TOLERANCE * body.pitch_inertia
    return "rods" if is_rod and not body.mass_centre else "graded"


def _cut(body: CarBody, profile: BodyProfile, number: int) -> OwnMasses:
    """The pieces of a profile, with their exact moments."""
    half = body.length / 2
    equal = np.linspace(half, -half, number + 1).tolist()
    nodes = equal if body.cuts is None else [half, *body.cuts, -half]
    pieces = [_piece(profile, nodes, i) for i in range(1, number + 1)]
    return OwnMasses(body, OwnCuts.of([s.length for s in pieces]), tuple(pieces))


def _piece(profile: BodyProfile, nodes: Sequence[float], i: int) -> Segment:
    front, rear = nodes[i - 1], nodes[i]
    m, S, J = profile.moments(rear, front, (front + rear) / 2)
    own = J - S**2 / m if m > 0 else 0.0
    if not own > 0:
        raise InputError(
            f"body.profile: found {m:g} kg with a pitch inertia of {own:g} kg m^2 on segment {i}, "
            f"from {front:g} to {rear:g} m; expected some of both (fewer segments, or other cuts)"
        )
    # What is not more than rounding is at the middle.
    offset = S / m if abs(S) > 1e-12 * m * (front - rear) else 0.0
    return Segment(front - rear, m, own, offset)


def _refuse_offset(body: CarBody) -> None:
    if body.mass_centre:
        raise InputError(
            f'body.inertia: found "{body.inertia}", equal masses, with the mass centre at '
            f'{body.mass_centre:g} m; expected it at the middle (use "graded")'
        )


def _mass(body: CarBody) -> Parameter:
    return Parameter(m_c, "car-body mass", "kg", body.mass)


def _inertia(body: CarBody) -> Parameter:
    return Parameter(I_c, "car-body pitch inertia", "kg m^2", body.pitch_inertia)


def _values(array: Array) -> str:
    """A value, or the range of several."""
    low, high = float(np.min(array)), float(np.max(array))
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"
