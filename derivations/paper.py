"""What the paper prints, each value with the place where it stands, and how railride reads it.

Y. Çati, M. Düzgün, F.E. Kracht, Development of a New Vertical Dynamic Model of a Rail Vehicle for
the Analysis of Ride Comfort, Appl. Sci. 2024, 14, 3848 (doi 10.3390/app14093848, CC BY 4.0).

Values are SI; ``text`` is what stands in the paper. Its comfort levels, Table 3, are
``railride.scales.PAPER_TABLE_3``; its weighting, Eq (6), is ``railride.weighting("Wk_paper")``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

from railride import KMH, CarBody, VehicleModel, derive_vehicle, load_vehicle

TITLE = "Çati, Düzgün, Kracht, Appl. Sci. 2024, 14, 3848"


@dataclass(frozen=True)
class Printed:
    """One printed value: ``value`` in the SI ``unit``, ``text`` as it stands in Table 1."""

    value: float
    unit: str
    text: str
    meaning: str


TABLE_1 = {
    "m_c": Printed(34_000.0, "kg", "34,000 kg", "car body mass"),
    "I_c": Printed(1.7e6, "kg m^2", "1.7 × 10⁶ kg·m²", "car body moment of inertia"),
    "m_b": Printed(3000.0, "kg", "3000 kg", "bogie mass"),
    "I_b": Printed(2000.0, "kg m^2", "2000 kg·m²", "bogie moment of inertia"),
    "k_theta": Printed(3.7e8, "N m/rad", "3.7 × 10⁵ kN·m/rad", "stiffness of the torsional spring"),
    "k_1": Printed(5e6, "N/m", "5000 kN/m", "stiffness of the primary suspension"),
    "c_1": Printed(3e7, "N s/m", "30,000 kN·s/m", "damping of the primary suspension"),
    "k_2": Printed(750e3, "N/m", "750 kN/m", "stiffness of the secondary suspension"),
    "c_2": Printed(70e3, "N s/m", "70 kN·s/m", "damping of the secondary suspension"),
    "f_bending": Printed(9.6, "Hz", "9.6 Hz", "bending frequency of the car body"),
    "bs": Printed(8.75, "m", "8.75 m", "bogie semi space"),
    "ws": Printed(1.25, "m", "1.25 m", "wheel semi space"),
    "L": Printed(24.0, "m", "24 m", "car body length"),
}

TABLE_2 = {"f3": 12.5, "f4": 12.5, "f5": 2.37, "f6": 3.35, "Q4": 0.63, "Q5": 0.91, "Q6": 0.91}

SPEEDS_KMH = (145.0, 200.0)  # Section 4
SECTION = 1000.0  # m of straight track, Section 4
OUTPUT_STEP = 0.02  # s, Section 4
VAMPIRE_STEP = 0.001  # s, Euler-Cromer, Section 4
DASSL_TOLERANCE = 1e-4  # Section 4
DYMOLA_DOF = {False: 6, True: 8}  # rigid, flexible: Section 2
VAMPIRE_DOF = 47  # Section 2.2


@dataclass(frozen=True)
class Row:
    """One row of Table 4: a_wrms of the flexible vehicle, m/s², and the difference in percent."""

    speed_kmh: float
    dymola: float
    vampire: float
    difference: float


TABLE_4 = (Row(145.0, 0.225, 0.191, 17.801), Row(200.0, 0.293, 0.269, 8.191))


@dataclass(frozen=True)
class Case:
    """One of the eight simulated cases, Section 4; ``a_wrms`` is None where none is printed."""

    speed_kmh: float
    flexible: bool
    program: str
    figure: int
    a_wrms: float | None = None

    @property
    def speed(self) -> float:
        """V in m/s."""
        return self.speed_kmh * KMH

    @property
    def body(self) -> str:
        """Of the car body: "rigid" or "flexible"."""
        return "flexible" if self.flexible else "rigid"


CASES = tuple(
    Case(row.speed_kmh, flexible, program, figure, value if flexible else None)
    for row, figures in zip(TABLE_4, ((8, 9), (10, 11)), strict=True)
    for flexible, figure in zip((False, True), figures, strict=True)
    for program, value in (("DYMOLA", row.dymola), ("VAMPIRE", row.vampire))
)

TRACK = "erri_low"  # the paper's own track is not public
SEEDS = tuple(range(1, 201))  # of it: one kilometre is one sample


@cache
def coach(flexible: bool = True, segments: int = 2) -> VehicleModel:
    """The paper's vehicle as railride reads it: rigid, or of segments that bend at 9.6 Hz.

    Primary damping 30 kN s/m, primary suspension per axle, secondary per bogie, body free in
    space, rods for segments, no structural damping (``data/vehicles/cati2024.toml``).
    """
    return derive_vehicle(load_vehicle("cati2024"), segments if flexible else 1)


@cache
def coach_of_inertia() -> VehicleModel:
    """Two segments with Table 1's I_c (each its own inertia) and Table 1's k_θ."""
    vehicle = load_vehicle("cati2024")
    body = CarBody(vehicle.body.mass, vehicle.body.pitch_inertia, vehicle.body.length,
                   joint_stiffness=TABLE_1["k_theta"].value, inertia="segments")  # fmt: skip
    return derive_vehicle(replace(vehicle, body=body), 2)


READINGS: dict[str, dict[str, float]] = {
    "as railride reads it": {},
    "primary damping as printed": {"c_1": TABLE_1["c_1"].value},
    "primary suspension per axle box: k₁, c₁ doubled": {"k_1": 10e6, "c_1": 60e3},
    "secondary suspension per side: k₂, c₂ doubled": {"k_2": 1.5e6, "c_2": 140e3},
}
"""Other values for what the paper leaves open, for ``coach().changed(**…)``."""
