"""A vehicle in SI units: a car body on bogies, with what it carries; records that check themselves.

Symbols, from the front, x in m forward of the middle of the car body:

    m_b, I_b        mass and pitch inertia of a bogie
    k_1, c_1        primary suspension, per axle
    k_2, c_2        secondary suspension, per bogie

All are values of the whole vehicle in the vertical plane: left and right side are summed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from railride.car_body import CarBody
from railride.errors import Faults
from railride.quantities import LIST, checked_numbers, si
from railride.toml_tables import shown


@dataclass(frozen=True)
class Bogie:
    """Bogie of mass m_b and pitch inertia I_b at ``position``, m forward of the body's middle.

    mass: m_b, kg. pitch_inertia: I_b, kg m².
    wheelsets: m forward of the bogie's centre, from the front.
    primary_stiffness: k_1, N/m, and primary_damping: c_1, N s/m, both per axle.
    secondary_stiffness: k_2, N/m, and secondary_damping: c_2, N s/m, both per bogie.
    wheelset_mass: kg, of one wheelset; it matters for contact forces only.
    primary_damper_stiffness, secondary_damper_stiffness: N/m, of the elastic mounts in series with
    the dampers, per axle and per bogie; without one the damper's mount is rigid.

    Raises InputError, with all faults at once, for values that no bogie can have.
    """

    position: float = field(metadata=si("m"))
    mass: float = field(metadata=si("kg", "> 0"))
    pitch_inertia: float = field(metadata=si("kg m^2", "> 0"))
    wheelsets: tuple[float, ...] = field(metadata=si("m", many=LIST))
    primary_stiffness: float = field(metadata=si("N/m", "> 0"))
    primary_damping: float = field(metadata=si("N s/m", ">= 0"))
    secondary_stiffness: float = field(metadata=si("N/m", "> 0"))
    secondary_damping: float = field(metadata=si("N s/m", ">= 0"))
    wheelset_mass: float | None = field(default=None, metadata=si("kg", "> 0"))
    primary_damper_stiffness: float | None = field(default=None, metadata=si("N/m", "> 0"))
    secondary_damper_stiffness: float | None = field(default=None, metadata=si("N/m", "> 0"))

    def __post_init__(self) -> None:
        faults = Faults("bogie")
        check_wheelsets(checked_numbers(self, faults), "", faults)
        check_mounts(vars(self), "", faults)
        faults.raise_if_any()


@dataclass(frozen=True)
class Load:
    """Payload: a mass on the car body, spread evenly from ``rear`` to ``front``.

    mass: kg. front, rear: m forward of the body's middle; neither: over the whole body; equal: in
    one point. The bending frequency is that of the body without it.

    Raises InputError, with all faults at once, for values that no load can have.
    """

    mass: float = field(metadata=si("kg", "> 0"))
    front: float | None = field(default=None, metadata=si("m"))
    rear: float | None = field(default=None, metadata=si("m"))

    def __post_init__(self) -> None:
        faults = Faults("payload")
        check_load(checked_numbers(self, faults), "", faults)
        faults.raise_if_any()


@dataclass(frozen=True)
class Equipment:
    """Equipment under the floor, hung on elastic mounts at ``position``.

    mass: kg; it is not part of the car body's. position: m forward of the body's middle.
    stiffness: N/m, of its mounts together; or frequency: Hz, its natural frequency on them while
    the body stands still. damping: N s/m, of the mounts together; or damping_ratio, on them.

    Raises InputError, with all faults at once, for values that no equipment can have.

    >>> Equipment(1500.0, 0.0, frequency=8.8, damping_ratio=0.12).mass
    1500.0
    """

    mass: float = field(metadata=si("kg", "> 0"))
    position: float = field(metadata=si("m"))
    stiffness: float | None = field(default=None, metadata=si("N/m", "> 0"))
    frequency: float | None = field(default=None, metadata=si("Hz", "> 0"))
    damping: float | None = field(default=None, metadata=si("N s/m", ">= 0"))
    damping_ratio: float = field(default=0.0, metadata=si("", ">= 0"))

    def __post_init__(self) -> None:
        faults = Faults("equipment")
        check_equipment(checked_numbers(self, faults), "", faults)
        faults.raise_if_any()


@dataclass(frozen=True)
class Vehicle:
    """A car body on its bogies, from the front.

    name: one line. source: where the values come from. remarks: what a user of them must know.
    payload: what is added to the empty car body. equipment: what hangs under its floor.

    Raises InputError, with all faults at once, where the parts do not fit together: fewer than
    two bogies (the body would tip), a bogie outside the body, bogies or wheelsets out of order.
    """

    name: str
    body: CarBody
    bogies: tuple[Bogie, ...]
    source: str = ""
    remarks: tuple[str, ...] = ()
    payload: tuple[Load, ...] = ()
    equipment: tuple[Equipment, ...] = ()

    def __post_init__(self) -> None:
        faults = Faults(f"vehicle {shown(self.name)}")
        for name in ("bogies", "remarks", "payload", "equipment"):
            value = getattr(self, name)
            if isinstance(value, Sequence) and not isinstance(value, str):
                object.__setattr__(self, name, tuple(value))
            else:
                faults.add(name, shown(value), "a sequence")
        faults.raise_if_any()
        check_texts(self.name, self.source, self.remarks, faults)
        if not isinstance(self.body, CarBody):
            faults.add("body", shown(self.body), "a CarBody")
        for name, kind in (("bogies", Bogie), ("payload", Load), ("equipment", Equipment)):
            for i, part in enumerate(getattr(self, name), 1):
                if not isinstance(part, kind):
                    faults.add(f"{name}[{i}]", shown(part), f"of type {kind.__name__}")
        faults.raise_if_any()
        check_arrangement(vars(self.body), [vars(bogie) for bogie in self.bogies], faults)
        check_payload(vars(self.body), [vars(load) for load in self.payload], faults)
        check_hung(vars(self.body), [vars(one) for one in self.equipment], faults)
        faults.raise_if_any()

    @property
    def wheelset_positions(self) -> tuple[float, ...]:
        """x of every wheelset, m forward of the body's middle, from the front.

        >>> from railride.parameters import load_vehicle
        >>> load_vehicle("cati2024").wheelset_positions
        (10.0, 7.5, -7.5, -10.0)
        """
        return tuple(bogie.position + x for bogie in self.bogies for x in bogie.wheelsets)


def check_wheelsets(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note what is wrong between the wheelsets of one bogie, if they are known."""
    wheelsets = values.get("wheelsets")
    if wheelsets is None:
        return
    if not wheelsets:
        faults.add(f"{prefix}wheelsets", "none", "at least one wheelset per bogie")
    if any(ahead <= behind for ahead, behind in pairwise(wheelsets)):
        faults.add(
            f"{prefix}wheelsets",
            ", ".join(f"{x:g} m" for x in wheelsets),
            "wheelsets from the front, each at its own place",
            "positions are counted forward from the bogie's centre",
        )


def check_mounts(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note an elastic mount where there is no damper."""
    for suspension in ("primary", "secondary"):
        mount = values.get(f"{suspension}_damper_stiffness")
        if mount is not None and values.get(f"{suspension}_damping") == 0:
            faults.add(
                f"{prefix}{suspension}_damper_stiffness",
                f"{mount:g} N/m in series with no damping",
                f"a {suspension}_damping above 0",
                "leave the mount out where there is no damper",
            )


def check_load(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note ends of a load that do not belong together."""
    front, rear = values.get("front"), values.get("rear")
    if (front is None) != (rear is None):
        faults.add(f"{prefix}{'front' if front is None else 'rear'}", "nothing",
                   "both ends of the load, or neither for the whole body")  # fmt: skip
    elif front is not None and rear is not None and rear > front:
        faults.add(f"{prefix}rear", f"{rear:g} m, ahead of the front at {front:g} m",
                   "a place behind the front, or at it")  # fmt: skip


def check_payload(
    body: Mapping[str, Any], loads: Sequence[Mapping[str, Any]], faults: Faults
) -> None:
    """Note loads that lie outside the car body."""
    length = body.get("length")
    for i, load in enumerate(loads, 1):
        for end in ("front", "rear"):
            place = load.get(end)
            if length is not None and place is not None and abs(place) > length / 2:
                faults.add(f"payload[{i}].{end}", f"{place:g} m",
                           f"a place on the body, at most {length / 2:g} m from its "
                           "middle")  # fmt: skip


def check_equipment(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note mounts of which the stiffness or the damping is not known, or known twice."""
    stiffness, frequency = values.get("stiffness"), values.get("frequency")
    if (stiffness is None) == (frequency is None):
        faults.add(f"{prefix}stiffness", "nothing" if stiffness is None else "frequency with it",
                   "the stiffness of the mounts, or the frequency on them")  # fmt: skip
    if values.get("damping") is not None and values.get("damping_ratio"):
        faults.add(f"{prefix}damping_ratio", "damping with it", "one of the two")


def check_hung(
    body: Mapping[str, Any], equipment: Sequence[Mapping[str, Any]], faults: Faults
) -> None:
    """Note equipment that does not hang under the car body."""
    length = body.get("length")
    for i, one in enumerate(equipment, 1):
        place = one.get("position")
        if length is not None and place is not None and abs(place) > length / 2:
            faults.add(f"equipment[{i}].position", f"{place:g} m", "a place under the body, at "
                       f"most {length / 2:g} m from its middle")  # fmt: skip


def check_texts(name: object, source: object, remarks: Sequence[object], faults: Faults) -> None:
    """Note texts that are none, and a name that is not one line."""
    for where, text in (
        ("source", source),
        *((f"remarks[{i}]", r) for i, r in enumerate(remarks, 1)),
    ):
        if not isinstance(text, str):
            faults.add(where, shown(text), "a text")
    if not isinstance(name, str) or not name.strip() or not name.isprintable():
        faults.add("name", shown(name), "one line of text")


def check_arrangement(
    body: Mapping[str, Any], bogies: Sequence[Mapping[str, Any]], faults: Faults
) -> None:
    """Note what is wrong between the car body and its bogies, as far as they are known."""
    if len(bogies) < 2:
        faults.add(
            "bogies",
            ("none", "one")[len(bogies)],
            "at least two bogies",
            "a car body on fewer has a pitching motion that nothing holds",
        )
    length = body.get("length")
    for i, bogie in enumerate(bogies, 1):
        position = bogie.get("position")
        if length is not None and position is not None and abs(position) > length / 2:
            faults.add(
                f"bogies[{i}].position",
                f"{position:g} m",
                f"a place under the body, at most {length / 2:g} m from its middle",
                "positions are counted forward from the body's middle",
            )
    for i, (ahead, behind) in enumerate(pairwise(bogies), 2):
        front, rear = ahead.get("position"), behind.get("position")
        if front is None or rear is None:
            continue
        if front <= rear:
            faults.add(
                f"bogies[{i}].position",
                f"{rear:g} m, which is not behind bogies[{i - 1}] at {front:g} m",
                "bogies from the front, each at its own place",
            )
        elif ahead.get("wheelsets") and behind.get("wheelsets"):
            last, first = front + min(ahead["wheelsets"]), rear + max(behind["wheelsets"])
            if last <= first:
                faults.add(
                    f"bogies[{i}].wheelsets",
                    f"the first wheelset at {first:g} m",
                    f"one behind the last of bogies[{i - 1}], which is at {last:g} m",
                    "bogies must not overlap: check positions and wheelsets",
                )
