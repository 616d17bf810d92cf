r"""Bode studies: the floor's response to the track over speeds and positions, and its zeros.

Two places along the track that a vehicle feels alike and adds up, a distance d apart, cancel at

.. math:: f_k = \left(k + \tfrac{1}{2}\right) \frac{V}{d}, \qquad k = 0, 1, 2, \ldots

The wheelsets of a bogie are such a pair, and, over the middle of a symmetric vehicle, its bogies.
Elsewhere pitch and the unsymmetric bending shapes fill the zeros of the bogie spacing to dips.

since 1 + e^{-iωd/V} = 0 there. Each zero is checked on the model itself, so that none is claimed
for a vehicle that does not have it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.frequency import (
    BAND_HZ,
    POINTS,
    TRACK,
    Complex,
    check_ascending,
    responses,
    wheelset_delays,
)
from railride.modal import Mode, modes
from railride.numeric import Array
from railride.quantities import several
from railride.spectra import check_speed
from railride.vehicle import Output, VehicleModel

if TYPE_CHECKING:
    import pandas as pd

_CANCELS = 1e-6  # of the sum of what each wheelset does alone: rounding, and no dip, is below it
_MOST_ZEROS = 1000  # of one distance


@dataclass(frozen=True)
class GeometricZeros:
    """Where two places ``distance`` m apart cancel: ``frequency`` Hz, shape (zeros,), ascending."""

    cause: str
    distance: float
    frequency: Array


@dataclass(frozen=True, eq=False)
class BodeResponse:
    """H from the elevation under the leading wheelset to an output, at one speed.

    body : the car body in a few words. speed : m/s. position : m forward of the body's middle.
    output : what responds, with its unit. frequency : Hz, (F,). H : complex, (F,), the output's
    unit per m. modes : of the vehicle. zeros : the geometric filtering, up to the highest
    frequency.
    """

    vehicle: str
    body: str
    floor: str
    speed: float
    position: float
    output: Output
    frequency: Array
    H: Complex
    modes: tuple[Mode, ...]
    zeros: tuple[GeometricZeros, ...]

    @property
    def magnitude(self) -> Array:
        """|H|, (F,), the output's unit per m."""
        return np.abs(self.H)

    @property
    def phase_deg(self) -> Array:
        """The angle of H in (-180, 180] degrees, (F,); NaN where H is nothing."""
        angle = np.degrees(np.angle(self.H))
        return np.where(self.H == 0, np.nan, np.where(angle <= -180, 180.0, angle))

    def table(self) -> pd.DataFrame:
        """Frequency, magnitude and phase as columns, the units in their names."""
        import pandas as pd

        return pd.DataFrame({
            "frequency [Hz]": self.frequency,
            f"magnitude [({self.output.unit})/m]": self.magnitude,
            "phase [deg]": self.phase_deg,
        })  # fmt: skip


def bode(
    model: VehicleModel,
    speeds: float | Sequence[float],
    frequency: ArrayLike | None = None,
    *,
    at: float | Sequence[float] = (0.0,),
    floor: str = "smooth",
    derivative: int = 2,
    **changes: ArrayLike,
) -> tuple[BodeResponse, ...]:
    """Responses of points of the floor to the track, speeds outer and positions inner.

    Parameters
    ----------
    speeds : m/s, one or several, each > 0.
    frequency : Hz, ascending, > 0; default 2,000 from 0.2 to 40 Hz.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    derivative : of the floor's height: 2 is its acceleration, 0 its displacement.
    changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : a speed of 0, frequencies that are none or not ascending, a point off the body, an
        unstable vehicle.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> (found,) = bode(coach, [200 / 3.6], [1.0, 2.0, 5.0])
    >>> [(z.cause, z.distance, z.frequency.round(3).tolist()) for z in found.zeros]
    [('bogie spacing', 17.5, [1.587, 4.762])]
    """
    speeds, points = several(speeds, "speeds", "m/s"), several(at, "at", "m")
    if not speeds or not points:
        raise InputError(f"{'speeds' if not speeds else 'at'}: found none; expected at least one")
    for speed in speeds:
        check_speed(speed)
    f = check_ascending(np.geomspace(*BAND_HZ, POINTS) if frequency is None else frequency)
    outputs = [model.floor(x, floor, derivative) for x in points]
    found_modes = modes(model, **changes)
    H = [responses(model, outputs, [TRACK], f, speed=v, **changes)[:, 0] for v in speeds]
    return tuple(
        BodeResponse(
            model.vehicle.name, model.body.title, floor, v, x, output, f, H[i][k], found_modes,
            geometric_zeros(model, output, v, float(f[-1]), **changes),
        )
        for i, v in enumerate(speeds)
        for k, (x, output) in enumerate(zip(points, outputs, strict=True))
    )  # fmt: skip


def geometric_zeros(
    model: VehicleModel, output: Output, speed: float, highest: float, **changes: ArrayLike
) -> tuple[GeometricZeros, ...]:
    """The zeros (k + ½)·V/d of an output up to ``highest`` Hz, d the bogie spacing and wheelbases.

    Parameters
    ----------
    output : what responds. speed : V in m/s, > 0. highest : Hz.

    Returns
    -------
    tuple : one for each distance whose zeros the model has; a distance without is left out.
    """
    delays = wheelset_delays(model, speed)
    found = []
    for cause, distance in _distances(model):
        count = min(int(np.floor(highest * distance / speed + 0.5)), _MOST_ZEROS)
        if count < 1:
            continue
        f = (np.arange(count) + 0.5) * speed / distance
        wheelsets = [w.name for w in model.lagrangian.inputs]
        each = responses(model, [output], wheelsets, f, speed=None, **changes)
        felt = each[0] * np.exp(-2j * np.pi * np.outer(delays, f))
        if (np.abs(felt.sum(axis=0)) <= _CANCELS * np.abs(felt).sum(axis=0)).all():
            found.append(GeometricZeros(cause, distance, np.asarray(f, dtype=float)))
    return tuple(found)


def _distances(model: VehicleModel) -> list[tuple[str, float]]:
    """The distance of two bogies, and the wheelbases that differ."""
    bogies = model.vehicle.bogies
    found = []
    if len(bogies) == 2:
        found.append(("bogie spacing", abs(bogies[0].position - bogies[1].position)))
    bases = {round(max(b.wheelsets) - min(b.wheelsets), 9) for b in bogies}
    return found + [("wheelbase", base) for base in sorted(bases) if base > 0]
