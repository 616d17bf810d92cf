"""Scales of ride comfort: which classes a value falls into, each scale with its source."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from railride.errors import Fault, Faults, InputError


@dataclass(frozen=True)
class ComfortClass:
    """One class of a scale: low ≤ value < high; ``closed`` classes hold their upper limit too."""

    label: str
    low: float
    high: float
    closed: bool = False

    def holds(self, value: float) -> bool:
        """Whether ``value`` is in this class."""
        return self.low <= value < self.high or (self.closed and value == self.high)


@dataclass(frozen=True)
class Scale:
    """Classes of one quantity, from better to worse; they may overlap.

    Raises :class:`InputError` where a class is empty or a value ≥ 0 would fall into none.
    """

    name: str
    quantity: str
    source: str
    classes: tuple[ComfortClass, ...]

    def __post_init__(self) -> None:
        faults = Faults(f"scale {self.name}")
        reach = 0.0
        for entry in self.classes:
            if not 0 <= entry.low < entry.high:
                faults.add(entry.label, f"{entry.low} to {entry.high}", "0 ≤ low < high")
            if entry.low > reach:
                faults.add(entry.label, f"starts at {entry.low}", f"no gap after {reach}")
            reach = max(reach, entry.high)
        if not math.isinf(reach):
            faults.add("last class", f"ends at {reach}", "no upper limit")
        faults.raise_if_any()


def _steps(*labels: str, limits: tuple[float, ...]) -> tuple[ComfortClass, ...]:
    """Classes side by side, from 0 through the limits to infinity."""
    edges = (0.0, *limits, math.inf)
    return tuple(
        ComfortClass(label, low, high)
        for label, (low, high) in zip(labels, itertools.pairwise(edges), strict=True)
    )


PAPER_TABLE_3 = Scale(
    "Cati 2024 Table 3",
    "a_wrms, W_k, m/s²",
    "Çati, Düzgün, Kracht, Appl. Sci. 2024, 14, 3848, Table 3. Its words; the last two run "
    "backwards ('fairly' below 'little' comfortable), and it calls the limits ISO 2631's, whose "
    "Annex C has others",
    _steps(
        "very comfortable",
        "comfortable",
        "medium",
        "little comfortable",
        "fairly comfortable",
        limits=(0.2, 0.3, 0.4, 0.6),
    ),
)

ISO_2631_1_ANNEX_C = Scale(
    "ISO 2631-1 Annex C",
    "a_wrms, m/s²",
    "ISO 2631-1:1997, C.2.3: approximate reactions in public transport, for the vibration total "
    "value (one axis alone rates that axis); the ranges overlap and every class that fits is named",
    (
        ComfortClass("not uncomfortable", 0.0, 0.315),
        ComfortClass("a little uncomfortable", 0.315, 0.63, closed=True),
        ComfortClass("fairly uncomfortable", 0.5, 1.0, closed=True),
        ComfortClass("uncomfortable", 0.8, 1.6, closed=True),
        ComfortClass("very uncomfortable", 1.25, 2.5, closed=True),
        ComfortClass("extremely uncomfortable", math.nextafter(2.0, 3.0), math.inf),
    ),
)

SPERLING = Scale(
    "Sperling Wz",
    "W_z, ride comfort",
    "Sperling and Betzhold 1956, as tabled in Urban Rail Transit 2015, "
    "doi:10.1007/s40864-015-0007-8, Table 4; each value is taken as the lower limit of its class, "
    "and what is below the first is called not noticeable here",
    _steps(
        "not noticeable",
        "just noticeable",
        "clearly noticeable",
        "more pronounced but not unpleasant",
        "strong, irregular, but still tolerable",
        "very irregular",
        "extremely irregular, unpleasant",
        "extremely unpleasant, prolonged exposure harmful",
        limits=(1.0, 2.0, 2.5, 3.0, 3.25, 3.5, 4.0),
    ),
)

EN_12299_CONTINUOUS = Scale(
    "EN 12299 continuous comfort",
    "r.m.s. over 5 s, W_b of EN 12299, m/s²",
    "EN 12299, continuous comfort C_Cy, C_Cz, as commonly quoted (the standard was not read). For "
    "such 5 s values only, never for a W_k value of a whole run",
    _steps("very comfortable", "comfortable", "medium", "less comfortable", limits=(0.2, 0.3, 0.4)),
)

EN_12299_MEAN = Scale(
    "EN 12299 mean comfort",
    "N_MV",
    "EN 12299, mean comfort N_MV, as commonly quoted (the standard was not read)",
    _steps(
        "very comfortable",
        "comfortable",
        "medium",
        "uncomfortable",
        "very uncomfortable",
        limits=(1.5, 2.5, 3.5, 4.5),
    ),
)

UIC_513 = Scale(
    "UIC 513",
    "N_MV",
    "UIC 513, as commonly quoted (the leaflet was not read)",
    _steps(
        "very good comfort",
        "good comfort",
        "moderate comfort",
        "poor comfort",
        "very poor comfort",
        limits=(1.0, 2.0, 4.0, 5.0),
    ),
)


def vertical_part(scale: Scale) -> Scale:
    """The scale of N_MV for 6 a_z,P95 alone, which N_MV is never below, under its own name."""
    source = f"the classes of {scale.name} for the vertical axis alone: at best these"
    return replace(scale, name=f"{scale.name}, vertical part", quantity="6 a_z,P95", source=source)


EN_12299_VERTICAL = vertical_part(EN_12299_MEAN)
UIC_513_VERTICAL = vertical_part(UIC_513)

SCALES = (
    PAPER_TABLE_3,
    ISO_2631_1_ANNEX_C,
    SPERLING,
    EN_12299_CONTINUOUS,
    EN_12299_MEAN,
    EN_12299_VERTICAL,
    UIC_513,
    UIC_513_VERTICAL,
)
"""All scales."""

VERTICAL = ("Wk", "Wk_paper")
"""Weightings that the paper's Table 3 is made for."""


def classes_of(scale: Scale, value: float) -> tuple[str, ...]:
    """Every class of the scale that holds ``value``, better first.

    Raises :class:`InputError` for a value that is negative or not finite.

    >>> classes_of(ISO_2631_1_ANNEX_C, 0.9)
    ('fairly uncomfortable', 'uncomfortable')
    """
    if not (math.isfinite(value) and value >= 0):
        raise InputError(str(Fault(scale.name, f"{scale.quantity} = {value}", "a number ≥ 0")))
    return tuple(entry.label for entry in scale.classes if entry.holds(value))


def paper_level(a_wrms: float) -> str:
    """The paper's level (Table 3) of a W_k-weighted r.m.s. in m/s².

    >>> paper_level(0.225)
    'comfortable'
    """
    return classes_of(PAPER_TABLE_3, a_wrms)[0]


def levels(a_wrms: float, wz: float | None = None) -> dict[str, list[str]]:
    """Scale → classes, for a weighted r.m.s. (m/s²) and, where there is one, Sperling's W_z."""
    rated = rate(a_wrms, PAPER_TABLE_3, ISO_2631_1_ANNEX_C)
    return rated if wz is None else {**rated, **rate(wz, SPERLING)}


def rate(value: float, *scales: Scale) -> dict[str, list[str]]:
    """Scale → every class that holds the one ``value``, on each of the ``scales``.

    >>> rate(1.4, UIC_513, EN_12299_MEAN)
    {'UIC 513': ['good comfort'], 'EN 12299 mean comfort': ['very comfortable']}
    """
    return {scale.name: list(classes_of(scale, value)) for scale in scales}


def scale_remarks(weightings: Iterable[str], classes: Iterable[str]) -> list[str]:
    """What to know of the paper's ``classes`` of r.m.s. values weighted by ``weightings``."""
    remarks = []
    others = [name for name in dict.fromkeys(weightings) if name not in VERTICAL]
    if others:
        remarks.append(
            f"the paper's Table 3 is made for W_k on vertical motion; {', '.join(others)} values "
            "are rated on it for comparison alone"
        )
    if PAPER_TABLE_3.classes[-1].label in classes:
        remarks.append(
            "the paper's Table 3 calls its worst class, 0.6 m/s² and above, fairly comfortable: "
            "its last labels run backwards; see the other scales"
        )
    return remarks
