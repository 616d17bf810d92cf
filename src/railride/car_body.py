"""The car body in SI units: a record that checks itself.

x is in m forward of the body's middle. Values are those of the whole vehicle in the vertical plane:

    m_c, I_c, L     mass, pitch inertia and length
    k_θ, c_θ        spring and damper in each joint between two segments
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from railride.body_profile import BodyProfile
from railride.errors import Faults
from railride.quantities import LIST, checked_numbers, si
from railride.toml_tables import shown

INERTIA_METHODS = ("auto", "rods", "graded", "segments")
"""How the segments meet the car body's pitch inertia."""

AGREE = 1e-3  # of mass, pitch inertia and length: more apart, the profile and they contradict

_STIFFNESSES = ("bending_frequency", "joint_stiffness", "bending_stiffness")


@dataclass(frozen=True)
class CarBody:
    """Car body of mass m_c, pitch inertia I_c about its mass centre, and length L.

    mass: m_c, kg. pitch_inertia: I_c, kg m². length: L, m.
    mass_centre: m forward of the body's middle.
    bending_frequency: Hz, free-free first bending, to which the joints are calibrated; or
    joint_stiffness: k_θ, N m/rad; or bending_stiffness: EI, N m², k_θ = EI/(segment length).
    One of the three at most; a body without any is rigid.
    shear_stiffness: κGA, N, and rotary_inertia: ρI per length, kg m, of a beam (Timoshenko's).
    joint_damping: c_θ, N m s/rad; or bending_damping: damping ratio ζ of the first bending mode,
    in [0, 1), ζ_i = ζ f_i/f_1; or rayleigh_mass: α, 1/s, and rayleigh_stiffness: β, s, of bending,
    ζ_i = α/(2ω_i) + β ω_i/2; or mode_damping: ζ_i of the bending modes, each in [0, 1), the last
    for all further ones. One of the four at most.
    inertia: "rods" (each segment has m ℓ²/12), "graded" (mass per length a + b x²), "segments"
    (each segment's own inertia makes up I_c), "auto" (rods where m_c L²/12 is within 5 % of I_c,
    otherwise graded).
    profile: what the body has along its length: its mass, mass centre and pitch inertia are the
    body's, and those given must agree with them to 0.1 % (:meth:`of`). Its EI gives the joints
    their stiffness; a bending_frequency scales it, a joint_stiffness takes its place.

    Raises InputError, with all faults at once, for values that no car body can have.

    >>> CarBody(mass=34_000, pitch_inertia=1.7e6, length=24, bending_frequency=9.6).length
    24.0
    """

    mass: float = field(metadata=si("kg", "> 0"))
    pitch_inertia: float = field(metadata=si("kg m^2", "> 0"))
    length: float = field(metadata=si("m", "> 0"))
    mass_centre: float = field(default=0.0, metadata=si("m"))
    bending_frequency: float | None = field(default=None, metadata=si("Hz", "> 0"))
    joint_stiffness: float | None = field(default=None, metadata=si("N m/rad", "> 0"))
    bending_stiffness: float | None = field(default=None, metadata=si("N m^2", "> 0"))
    shear_stiffness: float | None = field(default=None, metadata=si("N", "> 0"))
    rotary_inertia: float = field(default=0.0, metadata=si("kg m", ">= 0"))
    joint_damping: float | None = field(default=None, metadata=si("N m s/rad", ">= 0"))
    bending_damping: float = field(default=0.0, metadata=si("", ">= 0"))
    rayleigh_mass: float = field(default=0.0, metadata=si("1/s", ">= 0"))
    rayleigh_stiffness: float = field(default=0.0, metadata=si("s", ">= 0"))
    mode_damping: tuple[float, ...] | None = field(default=None, metadata=si("", ">= 0", LIST))
    inertia: str = "auto"
    profile: BodyProfile | None = None

    def __post_init__(self) -> None:
        faults = Faults("car body")
        values = checked_numbers(self, faults) | {"inertia": self.inertia}
        if isinstance(self.profile, BodyProfile):
            values["profile"] = self.profile
        elif self.profile is not None:
            faults.add("profile", shown(self.profile), "a BodyProfile")
        check_body(values, "", faults)
        faults.raise_if_any()
        if self.profile is not None:
            for name, value in rigid_values(self.profile).items():
                object.__setattr__(self, name, value)

    @property
    def bends(self) -> bool:
        """Whether anything is known of the body's bending."""
        return self.profile is not None or any(getattr(self, name) for name in _STIFFNESSES)

    @classmethod
    def of(cls, profile: BodyProfile, **others: Any) -> CarBody:
        """The car body that a profile describes: its mass, mass centre, pitch inertia and length.

        profile: data along the body. others: further fields, such as bending_damping.

        >>> uniform = BodyProfile((-12, 12), (3e9, 3e9), (1400, 1400))
        >>> CarBody.of(uniform, bending_damping=0.015).pitch_inertia
        1612800.0
        """
        return cls(**rigid_values(profile) | others, profile=profile)


def rigid_values(profile: BodyProfile) -> dict[str, float]:
    """Mass, mass centre, pitch inertia and length of a profile, by the names of a car body."""
    names = ("mass", "mass_centre", "pitch_inertia", "length")
    return {name: getattr(profile, name) for name in names}


def check_body(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note what is wrong between the values of a car body, those that are known."""
    length, mass_centre = values.get("length"), values.get("mass_centre")
    if length is not None and mass_centre is not None and abs(mass_centre) >= length / 2:
        faults.add(
            f"{prefix}mass_centre",
            f"{mass_centre:g} m",
            f"a place within the body, less than {length / 2:g} m from its middle",
        )
    given = [name for name in _STIFFNESSES if values.get(name) is not None]
    if len(given) > 1:
        faults.add(
            f"{prefix}{given[-1]}",
            f"{' and '.join(given)} together",
            f"one of {', '.join(_STIFFNESSES)}",
            "they all set the stiffness of the joints: keep one",
        )
    damping = values.get("bending_damping")
    if damping is not None and damping >= 1.0:
        faults.add(
            f"{prefix}bending_damping",
            f"{damping:g}",
            "a damping ratio of at least 0 and less than 1",
            'a car body has some "1.5 %"',
        )
    _check_damping(values, prefix, faults)
    inertia = values.get("inertia")
    if inertia is not None and inertia not in INERTIA_METHODS:
        near = difflib.get_close_matches(str(inertia), INERTIA_METHODS, n=1)
        mend = f"did you mean {near[0]}?" if near else ""
        faults.add(f"{prefix}inertia", shown(inertia), f"one of {', '.join(INERTIA_METHODS)}", mend)

    if values.get("profile") is not None:
        _check_against(values["profile"], values, prefix, faults)


def _check_damping(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note structural damping that is given twice, and ratios that are none."""
    kinds = {"joint_damping": values.get("joint_damping") is not None,
             "bending_damping": bool(values.get("bending_damping")),
             "rayleigh_mass or rayleigh_stiffness":
             bool(values.get("rayleigh_mass") or values.get("rayleigh_stiffness")),
             "mode_damping": values.get("mode_damping") is not None}  # fmt: skip
    given = [name for name, is_given in kinds.items() if is_given]
    if len(given) > 1:
        faults.add(f"{prefix}{given[0].split()[0]}", f"{' and '.join(given)} together",
                   "one of them", "they all set the damping of bending: keep one")  # fmt: skip
    ratios = values.get("mode_damping")
    if ratios is not None and not ratios:
        faults.add(f"{prefix}mode_damping", "an empty list", "a damping ratio for each mode")
    for i, ratio in enumerate(ratios or (), start=1):
        if ratio >= 1:
            faults.add(f"{prefix}mode_damping[{i}]", f"{ratio:g}", "a damping ratio of at least 0 "
                       "and less than 1")  # fmt: skip


def _check_against(
    profile: BodyProfile, values: Mapping[str, Any], prefix: str, faults: Faults
) -> None:
    """Note what contradicts the profile."""
    units = {"mass": "kg", "mass_centre": "m", "pitch_inertia": "kg m^2", "length": "m"}
    for name, own in rigid_values(profile).items():
        value = values.get(name)
        scale = profile.length if name == "mass_centre" else own
        limit = 1e-9 if name == "length" else AGREE
        if value is not None and abs(value - own) > limit * scale:
            faults.add(f"{prefix}{name}", f"{value:.6g} {units[name]}",
                       f"{own:.6g} {units[name]}, the profile's",
                       "leave it out, or mend the profile")  # fmt: skip
    if values.get("bending_stiffness") is not None:
        faults.add(f"{prefix}bending_stiffness", "bending_stiffness and a profile together",
                   "one of them", "they both give EI: keep one")  # fmt: skip
    if values.get("inertia", "auto") != "auto":
        faults.add(f"{prefix}inertia", f"{shown(values['inertia'])} with a profile", '"auto"',
                   "the profile says where the mass is")  # fmt: skip
