"""A rigid segment of a car body, and the body that a row of them makes up."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from railride.errors import Faults
from railride.quantities import checked_numbers, si


@dataclass(frozen=True)
class Segment:
    """A rigid piece of the body.

    length: m. mass: kg. mass_centre: m forward of its middle.
    pitch_inertia: about its mass centre, kg m²; None is that of a slender rod, m ℓ²/12.

    Raises InputError, with all faults at once, for values that no segment can have.
    """

    length: float = field(metadata=si("m", "> 0"))
    mass: float = field(metadata=si("kg", "> 0"))
    pitch_inertia: float | None = field(default=None, metadata=si("kg m^2", "> 0"))
    mass_centre: float = field(default=0.0, metadata=si("m"))

    def __post_init__(self) -> None:
        faults = Faults("segment")
        check_segment(checked_numbers(self, faults), "", faults)
        faults.raise_if_any()

    @property
    def inertia(self) -> float:
        """J, kg m², about its mass centre."""
        rod = self.mass * self.length**2 / 12
        return rod if self.pitch_inertia is None else self.pitch_inertia


def check_segment(values: dict[str, float], prefix: str, faults: Faults) -> None:
    """Note a mass centre outside the segment."""
    length, place = values.get("length"), values.get("mass_centre", 0.0)
    if length is not None and abs(place) > length / 2:
        faults.add(f"{prefix}mass_centre", f"{place:g} m", "a place on the segment, at most "
                   f"{length / 2:g} m from its middle")  # fmt: skip


@dataclass(frozen=True)
class SegmentRow:
    """Segments in a row, from the front, about the middle of their length.

    >>> row = SegmentRow((Segment(10, 15e3), Segment(14, 19e3)))
    >>> row.length, row.mass, round(row.mass_centre, 3)
    (24.0, 34000.0, 0.294)
    """

    segments: Sequence[Segment]

    @property
    def length(self) -> float:
        """L, m."""
        return sum(s.length for s in self.segments)

    @property
    def middles(self) -> tuple[float, ...]:
        """Places of the segments' middles, m forward of the body's."""
        behind, places = self.length / 2, []
        for s in self.segments:
            places.append(behind - s.length / 2)
            behind -= s.length
        return tuple(places)

    @property
    def mass(self) -> float:
        """m_c, kg."""
        return sum(s.mass for s in self.segments)

    @property
    def mass_centre(self) -> float:
        """e_c, m forward of the middle; what is not more than rounding is zero."""
        first = sum(s.mass * x for s, x in zip(self.segments, self._centres, strict=True))
        found = first / self.mass
        return found if abs(found) > 1e-14 * self.length else 0.0

    @property
    def pitch_inertia(self) -> float:
        """I_c, kg m², about the mass centre."""
        arms = [x - self.mass_centre for x in self._centres]
        return sum(s.inertia + s.mass * arm**2 for s, arm in zip(self.segments, arms, strict=True))

    @property
    def _centres(self) -> list[float]:
        return [x + s.mass_centre for s, x in zip(self.segments, self.middles, strict=True)]
