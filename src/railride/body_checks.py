"""What must hold between the values of a car body, noted fault by fault."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from itertools import pairwise
from typing import Any

from railride.body_segments import SegmentRow
from railride.errors import Faults
from railride.toml_tables import shown

INERTIA_METHODS = ("auto", "rods", "graded", "segments")
"""How the segments meet the car body's pitch inertia."""

AGREE = 1e-3  # of mass, pitch inertia and length: more apart, two statements contradict each other

STIFFNESSES = ("bending_frequency", "bending_frequencies", "joint_stiffness", "bending_stiffness")
_RIGID = {"mass": "kg", "mass_centre": "m", "pitch_inertia": "kg m^2", "length": "m"}


def rigid_values(values: Mapping[str, Any]) -> dict[str, float]:
    """Mass, mass centre, pitch inertia and length of a profile or of segments, if there are any."""
    made = values.get("profile")
    made = SegmentRow(values["segments"]) if made is None and values.get("segments") else made
    return {} if made is None else {name: getattr(made, name) for name in _RIGID}


def joint_count(values: Mapping[str, Any]) -> int | None:
    """The number of joints, by segments, cuts or a list of joints."""
    if values.get("segments"):
        return len(values["segments"]) - 1
    lists = (values.get(name) for name in ("cuts", "joint_stiffness", "joint_damping"))
    return next((len(value) for value in lists if isinstance(value, tuple)), None)


def check_body(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note what is wrong between the values of a car body, those that are known."""
    length, mass_centre = values.get("length"), values.get("mass_centre")
    if length is not None and mass_centre is not None and abs(mass_centre) >= length / 2:
        faults.add(
            f"{prefix}mass_centre",
            f"{mass_centre:g} m",
            f"a place within the body, less than {length / 2:g} m from its middle",
        )
    _check_stiffness(values, prefix, faults)
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

    _check_made_of(values, prefix, faults)
    _checkjoint_count(values, prefix, faults)


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


def _check_stiffness(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note two statements of the stiffness; frequencies may scale a list of joint stiffnesses."""
    given = [name for name in STIFFNESSES if values.get(name) is not None]
    scaled = isinstance(values.get("joint_stiffness"), tuple) and "bending_stiffness" not in given
    if len(given) > (2 if scaled and given[0].startswith("bending_frequenc") else 1):
        faults.add(
            f"{prefix}{given[-1]}",
            f"{' and '.join(given)} together",
            f"one of {', '.join(STIFFNESSES)}",
            "they all set the stiffness of the joints: keep one",
        )
    frequencies = values.get("bending_frequencies")
    if frequencies is not None and not frequencies:
        faults.add(f"{prefix}bending_frequencies", "none", "one or several")
    for i, (low, high) in enumerate(pairwise(frequencies or ()), 2):
        if high <= low:
            faults.add(f"{prefix}bending_frequencies[{i}]", f"{high:g} Hz after {low:g} Hz",
                       "ascending frequencies, from the first")  # fmt: skip


def _check_made_of(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note what contradicts a profile or segments."""
    profile, segments = values.get("profile"), values.get("segments")
    if profile is not None and segments:
        faults.add(f"{prefix}profile", "a profile and segments together", "one of them")
    made = "the profile" if profile is not None else "the segments together"
    for key, own in rigid_values(values).items():
        value, unit = values.get(key), _RIGID[key]
        scale = values.get("length", own) if key == "mass_centre" else own
        limit = 1e-9 if key == "length" else AGREE
        if value is not None and abs(value - own) > limit * scale:
            faults.add(f"{prefix}{key}", f"{value:.6g} {unit}",
                       f"{own:.6g} {unit}, that of {made}",
                       "leave it out, or mend one of the two")  # fmt: skip
    if profile is not None and values.get("bending_stiffness") is not None:
        faults.add(f"{prefix}bending_stiffness", "bending_stiffness and a profile together",
                   "one of them", "they both give EI: keep one")  # fmt: skip
    if (profile is not None or segments) and values.get("inertia", "auto") != "auto":
        faults.add(f"{prefix}inertia", f"{shown(values['inertia'])} with a mass distribution",
                   '"auto"', "profile or segments say where the mass is")  # fmt: skip


def _checkjoint_count(values: Mapping[str, Any], prefix: str, faults: Faults) -> None:
    """Note cuts that are none, and lists that do not have one value for each joint."""
    cuts, length = values.get("cuts"), values.get("length")
    if cuts is not None:
        if values.get("profile") is None:
            faults.add(f"{prefix}cuts", "cuts of a body without a profile", "a profile to be cut",
                       "segments of their own lengths go into tables [[segments]]")  # fmt: skip
        elif length is None:
            length = values["profile"].length
        ends = [length / 2, *cuts, -length / 2] if length is not None else list(cuts)
        if not cuts or any(behind >= ahead for ahead, behind in pairwise(ends)):
            faults.add(f"{prefix}cuts", ", ".join(f"{x:g} m" for x in cuts) or "none",
                       "places on the body, from the front, one behind the other")  # fmt: skip
    joints = joint_count(values)
    for name in ("joint_stiffness", "joint_damping"):
        value = values.get(name)
        if isinstance(value, tuple) and len(value) != joints:
            faults.add(f"{prefix}{name}", f"{len(value)} values",
                       f"{joints}, one for each joint")  # fmt: skip
