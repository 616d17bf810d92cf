"""What an optimum must keep to: limits of travel, damping, static deflection and wheel load."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from railride.errors import Faults
from railride.stochastic import missing_loads
from railride.toml_tables import finite_number
from railride.vehicle import VehicleModel

AT_MOST, AT_LEAST, BETWEEN = "at most", "at least", "between"


@dataclass(frozen=True)
class Kind:
    """A kind of limit: its unit, what it limits, and to which side."""

    unit: str
    meaning: str
    side: str = AT_MOST


KINDS = {
    "secondary_travel": Kind("m", "expected peak of the secondary suspension's travel"),
    "primary_travel": Kind("m", "expected peak of the primary suspension's travel"),
    "secondary_travel_rms": Kind("m", "r.m.s. of the secondary suspension's travel"),
    "primary_travel_rms": Kind("m", "r.m.s. of the primary suspension's travel"),
    "wheel_load_variation": Kind("", "r.m.s. of the dynamic wheel load over the static one"),
    "damping_ratio": Kind("", "least damping ratio", AT_LEAST),
    "secondary_static": Kind("m", "static deflection of the secondary suspension", BETWEEN),
    "primary_static": Kind("m", "static deflection of the primary suspension", BETWEEN),
}
TRAVELS = ("secondary_travel", "primary_travel", "secondary_travel_rms", "primary_travel_rms")


@dataclass(frozen=True)
class Limit:
    """One limit: a value of a kind is ``at_least`` or at most ``bound``, SI.

    kind : one of :data:`KINDS`. mode : the label of the modes whose damping ratio is meant, "" for
    all.
    """

    kind: str
    bound: float
    at_least: bool = False
    mode: str = ""

    @property
    def unit(self) -> str:
        """SI."""
        return KINDS[self.kind].unit

    @property
    def side(self) -> str:
        """Which side of the bound is kept to."""
        return AT_LEAST if self.at_least else AT_MOST

    @property
    def name(self) -> str:
        """Its key, and the mode."""
        return f"{self.kind} of {self.mode}" if self.mode else self.kind

    @property
    def meaning(self) -> str:
        """In words."""
        if self.kind != "damping_ratio":
            return KINDS[self.kind].meaning
        return f"damping ratio of {self.mode}" if self.mode else "least damping ratio of all modes"


def limits_of(
    model: VehicleModel, given: Mapping[str, Any], labels: tuple[str, ...]
) -> tuple[Limit, ...]:
    """Limits as a call gives them: kind → bound, SI.

    Parameters
    ----------
    given : a number; of static deflections two, from and to, or None for one of them; of damping
        ratios a number for all modes, or label → number.
    labels : of the model's modes.

    Raises
    ------
    InputError : with all faults at once: a kind that there is none of; bounds that are no numbers,
        not positive or reversed; a mode that the vehicle does not have; wheel loads of a vehicle
        whose wheelsets' mass is not known.
    """
    faults, found = Faults("limits"), list[Limit]()
    if not isinstance(given, Mapping):
        faults.add("optimisation", repr(given), "a dictionary, kind → bound")
        faults.raise_if_any()
    for name, bound in given.items():
        if name not in KINDS:
            near = difflib.get_close_matches(name, KINDS, n=2)
            faults.add(name, "a limit that is not known", f"one of {', '.join(KINDS)}",
                       f"did you mean {' or '.join(near)}?" if near else "")  # fmt: skip
            continue
        if KINDS[name].side == BETWEEN:
            ends = tuple(bound) if isinstance(bound, tuple | list) else (bound,)
            if len(ends) != 2:
                faults.add(name, repr(bound), "two bounds, from and to, in m", "None for no bound")
                continue
            sides = [(end, at_least) for end, at_least in zip(ends, (True, False), strict=True)
                     if end is not None]  # fmt: skip
        else:
            sides = [(bound, KINDS[name].side == AT_LEAST)]
        for end, at_least in sides:
            modes = end if isinstance(end, Mapping) else {"": end}
            found += [Limit(name, value, at_least, mode) for mode, value in modes.items()]
    check_limits(model, found, labels, faults)
    faults.raise_if_any()
    return tuple(found)


def check_limits(
    model: VehicleModel, limits: list[Limit], labels: tuple[str, ...], faults: Faults,
    prefix: str = "",
) -> None:  # fmt: skip
    """Note limits that cannot be, or that this vehicle has nothing of; names with a prefix."""
    for limit in limits:
        where = prefix + limit.name
        number = finite_number(limit.bound)
        if number is None or number <= 0:
            faults.add(where, repr(limit.bound), f"a number above 0 {limit.unit}".rstrip())
        elif limit.kind == "damping_ratio" and number >= 1:
            faults.add(where, f"{number:g}", "a ratio below 1")
        if limit.mode and limit.mode not in labels:
            near = difflib.get_close_matches(limit.mode, labels, n=2)
            faults.add(where, "no such mode", f"one of {', '.join(labels)}",
                       f"did you mean {' or '.join(near)}?" if near else "")  # fmt: skip
        if limit.kind == "wheel_load_variation" and missing_loads(model):
            faults.add(where, "wheelsets whose mass is not known", "wheel loads",
                       "give bogie.wheelset_mass in the vehicle's file")  # fmt: skip
    for name, kind in KINDS.items():
        ends = {limit.at_least: limit.bound for limit in limits if limit.kind == name}
        if kind.side == BETWEEN and len(ends) == 2 and ends[True] >= ends[False]:
            faults.add(prefix + name, f"from {ends[True]:g} to {ends[False]:g} m",
                       "a range that is neither empty nor reversed")  # fmt: skip
