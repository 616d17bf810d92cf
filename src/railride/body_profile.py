r"""What a car body has along its length: bending stiffness EI(x), mass per length μ(x), …

x is in m forward of the body's middle. Values stand at knots from the rear end to the front end and
are linear between them; a knot that stands twice is a jump. So the integrals over any piece of the
body are exact:

.. math:: m = \int\mu\,dx, \quad S = \int\mu x\,dx, \quad J = \int(\mu x^2 + \rho I)\,dx

the mass and its first and second moment, with the rotary inertia per length ρI.

Source: W. Beitz, K.-H. Grote (eds.), Dubbel, chapters Mechanik and Festigkeitslehre.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import Faults
from railride.quantities import LIST, checked_numbers, is_list, quantity_fields, si
from railride.toml_tables import shown

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PointMass:
    """A mass on one point of the body.

    mass: kg. position: m forward of the middle. pitch_inertia: its own, kg m².

    Raises InputError for values that no mass can have.
    """

    mass: float = field(metadata=si("kg", "> 0"))
    position: float = field(metadata=si("m"))
    pitch_inertia: float = field(default=0.0, metadata=si("kg m^2", ">= 0"))

    def __post_init__(self) -> None:
        faults = Faults("point mass")
        checked_numbers(self, faults)
        faults.raise_if_any()


@dataclass(frozen=True)
class BodyProfile:
    """A car body by its data along x, m forward of the middle, linear between knots.

    x: the knots, m, ascending from -L/2 to L/2; a knot that stands twice is a jump.
    bending_stiffness: EI at the knots, N m². mass_per_length: μ at the knots, kg/m.
    shear_stiffness: G A_s at the knots, N; None is a body that does not shear.
    rotary_inertia: ρI at the knots, kg m; None is a slender body.
    point_masses: what sits on the body in single points.

    Raises InputError, with all faults at once, for lists of other lengths, values that no body can
    have, knots out of order or not about the middle, point masses off the body, no mass at all.

    Heavy ends, and two doors at which the body is softer:

    >>> coach = BodyProfile(
    ...     x=(-12, -8, -8, -7, -7, 7, 7, 8, 8, 12),
    ...     bending_stiffness=(3e9, 3e9, 1e9, 1e9, 3e9, 3e9, 1e9, 1e9, 3e9, 3e9),
    ...     mass_per_length=(1800, 1300, 1300, 1300, 1300, 1300, 1300, 1300, 1300, 1800))
    >>> coach.length, coach.mass, coach.mass_centre
    (24.0, 33200.0, 0.0)
    """

    x: tuple[float, ...] = field(metadata=si("m", many=LIST))
    bending_stiffness: tuple[float, ...] = field(metadata=si("N m^2", "> 0", LIST))
    mass_per_length: tuple[float, ...] = field(metadata=si("kg/m", ">= 0", LIST))
    shear_stiffness: tuple[float, ...] | None = field(default=None, metadata=si("N", "> 0", LIST))
    rotary_inertia: tuple[float, ...] | None = field(
        default=None, metadata=si("kg m", ">= 0", LIST)
    )
    point_masses: tuple[PointMass, ...] = ()

    def __post_init__(self) -> None:
        faults = Faults("body profile")
        values = checked_numbers(self, faults)
        points = self.point_masses
        if is_list(points) and all(isinstance(point, PointMass) for point in points):
            object.__setattr__(self, "point_masses", tuple(points))
            values["point_masses"] = [vars(point) for point in points]
        else:
            faults.add("point_masses", shown(points), "a sequence of PointMass")
        check_profile(values, "", faults)
        faults.raise_if_any()

    @property
    def length(self) -> float:
        """L, m."""
        return self.x[-1] - self.x[0]

    @property
    def mass(self) -> float:
        """m_c, kg."""
        return self._rigid[0]

    @property
    def mass_centre(self) -> float:
        """e_c, m forward of the middle; what is not more than rounding is zero."""
        found = self._rigid[1] / self.mass
        return found if abs(found) > 1e-14 * self.length else 0.0

    @property
    def pitch_inertia(self) -> float:
        """I_c, kg m², about the mass centre."""
        m, S, J = self._rigid
        return J - S**2 / m

    @cached_property
    def _rigid(self) -> tuple[float, float, float]:
        return self.moments(self.x[0], self.x[-1])

    def at(self, name: str, x: ArrayLike) -> Array:
        """Values of the column ``name`` at points x (m), of any shape; at a jump those ahead."""
        x = np.asarray(x, dtype=float)
        knots, values = np.array(self.x), np.array(getattr(self, name))
        i = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, len(knots) - 2)
        share = (x - knots[i]) / (knots[i + 1] - knots[i])
        return np.asarray(values[i] + share * (values[i + 1] - values[i]))

    def pieces(self, name: str, rear: float, front: float) -> tuple[Array, Array, Array, Array]:
        """The linear pieces of the column ``name`` between two points, from the rear.

        Returns
        -------
        tuple : where each piece begins and ends (m), and the values there.
        """
        knots, values = np.array(self.x), np.array(getattr(self, name))
        a, b = np.maximum(knots[:-1], rear), np.minimum(knots[1:], front)
        kept = b > a
        a, b = a[kept], b[kept]
        x, v = knots[:-1][kept], values[:-1][kept]
        slope = (values[1:][kept] - v) / (knots[1:][kept] - x)
        return a, b, v + slope * (a - x), v + slope * (b - x)

    def moments(self, rear: float, front: float, about: float = 0.0) -> tuple[float, float, float]:
        """Mass (kg) and first and second moment (kg m, kg m²) of the piece between two points.

        Parameters
        ----------
        rear, front : ends of the piece, m. A point mass at the rear end is on it, one at the front
            end is on what lies ahead, save at the front end of the body.
        about : the point about which the moments are taken, m.
        """
        a, b, v_a, v_b = self.pieces("mass_per_length", rear, front)
        h, u = b - a, (a + b) / 2 - about
        m, tilt = h * (v_a + v_b) / 2, h**2 * (v_b - v_a) / 12
        S, J = m * u + tilt, m * u**2 + 2 * u * tilt + m * h**2 / 12
        found = np.array([m.sum(), S.sum(), J.sum()])
        if self.rotary_inertia is not None:
            a, b, v_a, v_b = self.pieces("rotary_inertia", rear, front)
            found[2] += ((b - a) * (v_a + v_b) / 2).sum()
        at_end = front > self.x[-1] - 1e-9 * self.length
        for p in self.point_masses:
            if rear <= p.position and (at_end or p.position < front):
                arm = p.position - about
                found += p.mass, p.mass * arm, p.mass * arm**2 + p.pitch_inertia
        return float(found[0]), float(found[1]), float(found[2])


def check_profile(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note what is wrong between the values of a profile, those that are known."""
    x = values.get("x")
    if x is None:
        return
    for item in quantity_fields(BodyProfile):
        column = values.get(item.name)
        if column is not None and len(column) != len(x):
            faults.add(f"{prefix}{item.name}", f"{len(column)} values",
                       f"{len(x)}, one for each knot in x")  # fmt: skip
    _check_knots(x, prefix, faults)
    for i, point in enumerate(values.get("point_masses", ()), 1):
        place = point.get("position")
        if x and place is not None and not x[0] <= place <= x[-1]:
            faults.add(f"{prefix}point_masses[{i}].position", f"{place:g} m",
                       f"a place on the body, from {x[0]:g} to {x[-1]:g} m")  # fmt: skip
    if not any(values.get("mass_per_length", (1.0,))):
        faults.add(f"{prefix}mass_per_length", "zero all along", "a body that has a mass")


def _check_knots(x: Sequence[float], prefix: str, faults: Faults) -> None:
    """Knots ascend, each at most twice, from one end of the body to the other."""
    if len(x) < 2:
        faults.add(f"{prefix}x", f"{len(x)} knots", "at least the two ends of the body")
        return
    for i, (a, b) in enumerate(pairwise(x), 2):
        if b < a:
            faults.add(f"{prefix}x[{i}]", f"{b:g} m after {a:g} m",
                       "ascending knots, from the rear end to the front end")  # fmt: skip
    for i in range(len(x)):
        if x[i : i + 3].count(x[i]) == 3:
            faults.add(f"{prefix}x[{i + 3}]", f"{x[i]:g} m a third time",
                       "a knot at most twice: before and after a jump")  # fmt: skip
    for end, (i, j) in {"rear": (0, 1), "front": (-1, -2)}.items():
        if x[i] == x[j]:
            faults.add(f"{prefix}x", f"a jump at the {end} end, {x[i]:g} m",
                       "the ends once each", "leave one of the two out")  # fmt: skip
    if abs(x[0] + x[-1]) > 1e-9 * max(abs(x[0]), abs(x[-1])):
        faults.add(f"{prefix}x", f"knots from {x[0]:g} to {x[-1]:g} m",
                   "knots from -L/2 to L/2", "x counts forward from the body's middle")  # fmt: skip
