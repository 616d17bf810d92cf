r"""Doubts about a vehicle's parameters: values that can be, but hardly are.

The bounds are wide: they are meant to catch a wrong unit, and say nothing of what is good. With
the whole car body on all secondary springs, and a bogie between its springs,

.. math:: \omega_c^2 = \frac{\sum k_2}{m_c}, \quad
          \zeta_c = \frac{\sum c_2}{2\sqrt{\sum k_2\, m_c}}, \qquad
          \omega_b^2 = \frac{k_2 + n k_1}{m_b}, \quad
          \zeta_b = \frac{c_2 + n c_1}{2\sqrt{(k_2 + n k_1)\, m_b}} .

Source: the bounds are the project's own, two to five times wider than the coaches in A.H. Wickens,
Fundamentals of Rail Vehicle Dynamics, 2003, Chapter 4, and in the shipped parameter files.
"""

from __future__ import annotations

from math import pi, sqrt

from railride.parameters import Vehicle

HEAVE_HZ = (0.4, 4.0)
BOGIE_HZ = (2.5, 40.0)
DAMPING = (0.01, 1.5)
ROD = (0.4, 2.0)  # of a uniform body's pitch inertia
WHEELBASE = 0.5  # m, between neighbouring wheelsets


def doubts(vehicle: Vehicle) -> tuple[str, ...]:
    """What an engineer would ask back about, one sentence each.

    >>> from railride.parameters import load_vehicle
    >>> doubts(load_vehicle("cati2024"))
    ()
    """
    body, bogies = vehicle.body, vehicle.bogies
    found = []
    mass = body.mass + sum(load.mass for load in vehicle.payload)
    mass += sum(one.mass for one in vehicle.equipment)
    k, c = (sum(getattr(b, f"secondary_{of}") for b in bogies) for of in ("stiffness", "damping"))
    found += _oscillator("the car body on its secondary suspension", mass, k, c, HEAVE_HZ)
    for number, b in enumerate(bogies, start=1):
        n = len(b.wheelsets)
        k = b.secondary_stiffness + n * b.primary_stiffness
        c = b.secondary_damping + n * b.primary_damping
        found += _oscillator(f"bogie {number} between its springs", b.mass, k, c, BOGIE_HZ)
        gaps = [ahead - behind for ahead, behind in zip(b.wheelsets, b.wheelsets[1:], strict=False)]
        if gaps and min(gaps) < WHEELBASE:
            found.append(f"the wheelsets of bogie {number} are {min(gaps):g} m apart")
    ratio = body.pitch_inertia / (body.mass * body.length**2 / 12)
    if not ROD[0] <= ratio <= ROD[1]:
        found.append(f"the car body's pitch inertia is {ratio:.2g} times a uniform body's")
    return tuple(f"{vehicle.name}: {doubt}: is a unit wrong?" for doubt in dict.fromkeys(found))


def _oscillator(
    what: str, mass: float, stiffness: float, damping: float, band: tuple[float, float]
) -> list[str]:
    frequency = sqrt(stiffness / mass) / (2 * pi)
    ratio = damping / (2 * sqrt(stiffness * mass))
    found = []
    if not band[0] <= frequency <= band[1]:
        found.append(f"{what} has a natural frequency of {frequency:.3g} Hz")
    if not DAMPING[0] <= ratio <= DAMPING[1]:
        found.append(f"{what} has a damping ratio of {ratio:.3g}")
    return found
