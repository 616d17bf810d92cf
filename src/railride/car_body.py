"""The car body in SI units: a record that checks itself.

x is in m forward of the body's middle. Values are those of the whole vehicle in the vertical plane:

    m_c, I_c, L     mass, pitch inertia and length
    k_θ, c_θ        spring and damper in each joint between two segments
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from railride.body_checks import STIFFNESSES, check_body, joint_count, rigid_values
from railride.body_profile import BodyProfile
from railride.body_segments import Segment
from railride.body_sources import Elements, ModeFiles
from railride.errors import Faults
from railride.quantities import EITHER, LIST, checked_numbers, is_list, si
from railride.toml_tables import shown


@dataclass(frozen=True)
class CarBody:
    """Car body of mass m_c, pitch inertia I_c about its mass centre, and length L.

    mass: m_c, kg. pitch_inertia: I_c, kg m². length: L, m.
    mass_centre: m forward of the body's middle.
    bending_frequency: Hz, free-free first bending, to which the joints are calibrated; or
    bending_frequencies: the first few of them; or
    joint_stiffness: k_θ, N m/rad, of all joints, or a list from the front; or
    bending_stiffness: EI, N m², k_θ = EI/(segment length).
    One of these at most; a body without any is rigid. Frequencies scale a list of stiffnesses.
    shear_stiffness: κGA, N, and rotary_inertia: ρI per length, kg m, of a beam (Timoshenko's).
    joint_damping: c_θ, N m s/rad, of all joints, or a list; or bending_damping: damping ratio ζ of
    the first bending mode, in [0, 1), ζ_i = ζ f_i/f_1; or rayleigh_mass: α, 1/s, and
    rayleigh_stiffness: β, s, of bending, ζ_i = α/(2ω_i) + β ω_i/2; or mode_damping: ζ_i of the
    bending modes, each in [0, 1), the last for all further ones. One of the four at most.
    inertia: "rods" (each segment has m ℓ²/12), "graded" (mass per length a + b x²), "segments"
    (each segment's own inertia makes up I_c), "auto" (rods where m_c L²/12 is within 5 % of I_c,
    otherwise graded).
    profile: what the body has along its length, see :meth:`of`. Its EI gives the joints their
    stiffness; frequencies scale it, a joint_stiffness takes its place.
    cuts: m forward of the middle, from the front, where a body with a profile is cut into segments;
    without them the segments are of equal length.
    segments: from the front, see :meth:`of`.
    elements: how finite elements cut the body; default 128 of them.
    mode_files: natural modes or matrices from outside, in place of the body's own finite elements.

    Raises InputError, with all faults at once, for values that no car body can have.

    >>> CarBody(mass=34_000, pitch_inertia=1.7e6, length=24, bending_frequency=9.6).length
    24.0
    """

    mass: float = field(metadata=si("kg", "> 0"))
    pitch_inertia: float = field(metadata=si("kg m^2", "> 0"))
    length: float = field(metadata=si("m", "> 0"))
    mass_centre: float = field(default=0.0, metadata=si("m"))
    bending_frequency: float | None = field(default=None, metadata=si("Hz", "> 0"))
    joint_stiffness: float | tuple[float, ...] | None = field(
        default=None, metadata=si("N m/rad", "> 0", EITHER)
    )
    bending_stiffness: float | None = field(default=None, metadata=si("N m^2", "> 0"))
    shear_stiffness: float | None = field(default=None, metadata=si("N", "> 0"))
    rotary_inertia: float = field(default=0.0, metadata=si("kg m", ">= 0"))
    joint_damping: float | tuple[float, ...] | None = field(
        default=None, metadata=si("N m s/rad", ">= 0", EITHER)
    )
    bending_damping: float = field(default=0.0, metadata=si("", ">= 0"))
    rayleigh_mass: float = field(default=0.0, metadata=si("1/s", ">= 0"))
    rayleigh_stiffness: float = field(default=0.0, metadata=si("s", ">= 0"))
    mode_damping: tuple[float, ...] | None = field(default=None, metadata=si("", ">= 0", LIST))
    inertia: str = "auto"
    bending_frequencies: tuple[float, ...] | None = field(
        default=None, metadata=si("Hz", "> 0", LIST)
    )
    profile: BodyProfile | None = None
    cuts: tuple[float, ...] | None = field(default=None, metadata=si("m", many=LIST))
    segments: tuple[Segment, ...] = ()
    elements: Elements | None = None
    mode_files: ModeFiles | None = None

    def __post_init__(self) -> None:
        faults = Faults("car body")
        values = checked_numbers(self, faults) | {"inertia": self.inertia}
        if isinstance(self.profile, BodyProfile):
            values["profile"] = self.profile
        elif self.profile is not None:
            faults.add("profile", shown(self.profile), "a BodyProfile")
        for name, kind in (("elements", Elements), ("mode_files", ModeFiles)):
            value = getattr(self, name)
            if value is not None and not isinstance(value, kind):
                faults.add(name, shown(value), f"{kind.__name__}")
        if is_list(self.segments) and all(isinstance(s, Segment) for s in self.segments):
            values["segments"] = self.segments
            object.__setattr__(self, "segments", tuple(self.segments))
        else:
            faults.add("segments", shown(self.segments), "a sequence of Segment")
        check_body(values, "", faults)
        faults.raise_if_any()
        for name, value in rigid_values(values).items():
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, made: BodyProfile | Sequence[Segment], **others: Any) -> CarBody:
        """The car body that a profile or a row of segments makes up.

        Mass, mass centre, pitch inertia and length are theirs; those given must agree to 0.1 %.

        made: data along the body, or segments from the front. others: further fields.

        >>> uniform = BodyProfile((-12, 12), (3e9, 3e9), (1400, 1400))
        >>> CarBody.of(uniform, bending_damping=0.015).pitch_inertia
        1612800.0
        """
        own: dict[str, Any] = {"profile" if isinstance(made, BodyProfile) else "segments": made}
        return cls(**rigid_values(own) | own | others)

    @property
    def bends(self) -> bool:
        """Whether anything says how stiff the body is in bending."""
        given = any(getattr(self, name) is not None for name in STIFFNESSES)
        return given or self.profile is not None

    @property
    def joints(self) -> int | None:
        """The number of joints, where it is given."""
        return joint_count(vars(self))
