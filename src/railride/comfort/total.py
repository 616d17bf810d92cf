"""The vector sum over axes, by what the person's posture makes of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from railride.comfort.record import AxisName
from railride.errors import Fault, InputError
from railride.scales import ISO_2631_1_ANNEX_C, rate

AXES: tuple[AxisName, ...] = ("x", "y", "z")


@dataclass(frozen=True)
class Posture:
    """Where vibration enters a person: the weighting and the factor k of x, y and z.

    ``name``: what it is called here, ``source``: where it is from.
    """

    name: str
    weightings: tuple[str, str, str]
    factors: tuple[float, float, float]
    source: str


POSTURES = (
    Posture("standing", ("Wd", "Wd", "Wk"), (1.0, 1.0, 1.0),
            "ISO 2631-1:1997, 8.2.2.2: standing, at the floor"),
    Posture("seat", ("Wd", "Wd", "Wk"), (1.0, 1.0, 1.0),
            "ISO 2631-1:1997, 8.2.2.1: seated, on the seat's surface, for comfort (for health, "
            "7.2.3, k is 1.4, 1.4 and 1)"),
    Posture("backrest", ("Wc", "Wd", "Wd"), (0.8, 0.5, 0.4),
            "ISO 2631-1:1997, 8.2.2.1: seated, at the backrest"),
    Posture("feet", ("Wk", "Wk", "Wk"), (0.25, 0.25, 0.4),
            "ISO 2631-1:1997, 8.2.2.1: seated, at the feet"),
    Posture("recumbent", ("Wd", "Wd", "Wk"), (1.0, 1.0, 1.0),
            "ISO 2631-1:1997, 8.2.2.3: recumbent, under the pelvis, W_k on what is vertical"),
)  # fmt: skip
"""For comfort, translations only."""


def find_posture(name: str | Posture) -> Posture:
    """The posture of that name; what is one already stays as it is.

    Raises :class:`railride.errors.InputError`, naming those that exist, where there is none.

    >>> find_posture("feet").factors
    (0.25, 0.25, 0.4)
    """
    if isinstance(name, Posture):
        return name
    for one in POSTURES:
        if one.name == name:
            return one
    known = ", ".join(one.name for one in POSTURES)
    raise InputError(str(Fault("posture", repr(name), f"one of {known}")))


def vector_sum(values: Mapping[AxisName, float], factors: Mapping[AxisName, float]) -> float:
    """a_v = √(k_x² a_wx² + k_y² a_wy² + k_z² a_wz²) of the axes that are there, m/s².

    ``values``: direction → weighted r.m.s., m/s². ``factors``: direction → k.

    Source: ISO 2631-1:1997, Eq (10).

    >>> vector_sum({"x": 3.0, "z": 4.0}, {"x": 1.0, "y": 1.0, "z": 1.0})
    5.0
    """
    return math.hypot(*(factors[axis] * value for axis, value in values.items()))


@dataclass(frozen=True)
class VibrationTotal:
    """The vibration total value a_v of some axes at one point, and what it rests on.

    ``value``: m/s². ``posture``: with its factors. ``axes``: the directions that are in it.
    """

    value: float
    posture: Posture
    axes: tuple[AxisName, ...]
    remarks: tuple[str, ...] = field(default=())

    @property
    def factors(self) -> dict[AxisName, float]:
        """Direction → k, of the axes in it."""
        return {a: k for a, k in zip(AXES, self.posture.factors, strict=True) if a in self.axes}

    @property
    def levels(self) -> dict[str, list[str]]:
        """Scale → classes."""
        return rate(self.value, ISO_2631_1_ANNEX_C)


def vibration_total(
    weighted: Mapping[AxisName, tuple[str, float]], posture: str | Posture = "standing"
) -> VibrationTotal | None:
    """The vector sum for a posture; None of fewer than two axes.

    ``weighted``: direction → its weighting's name and the weighted r.m.s., m/s².
    ``posture``: one, or its name.

    A remark says which axes are missing and which are weighted otherwise than the posture asks.

    >>> vibration_total({"y": ("Wk", 3.0), "z": ("Wk", 4.0)}, "feet").remarks
    ('vector sum (feet): without x, so the whole is not below it',)
    """
    chosen = find_posture(posture)
    if len(weighted) < 2:
        return None
    axes = tuple(axis for axis in AXES if axis in weighted)
    factors = dict(zip(AXES, chosen.factors, strict=True))
    asked = dict(zip(AXES, chosen.weightings, strict=True))
    missing = [axis for axis in AXES if axis not in weighted]
    other = [f"{axis} is weighted {weighted[axis][0]}, not {asked[axis]}" for axis in axes
             if weighted[axis][0] != asked[axis]]  # fmt: skip
    said = [f"without {', '.join(missing)}, so the whole is not below it"] if missing else []
    if other:
        said.append(f"{', '.join(other)}: not the vector sum of ISO 2631-1")
    value = vector_sum({axis: weighted[axis][1] for axis in axes}, factors)
    remarks = tuple(f"vector sum ({chosen.name}): {text}" for text in said)
    return VibrationTotal(value, chosen, axes, remarks)
