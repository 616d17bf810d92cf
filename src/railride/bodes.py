r"""Bode studies: responses to the track over speeds and positions, and their zeros.

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
    FLOOR,
    POINTS,
    TRACK,
    Complex,
    check_ascending,
    responses,
    wheelset_delays,
)
from railride.modal import Mode, modes
from railride.numeric import Array
from railride.quantities import names, several
from railride.spectra import check_speed
from railride.vehicle import Output, VehicleModel

if TYPE_CHECKING:
    import pandas as pd

ON_FLOOR = ("floor_displacement", "floor_velocity", FLOOR)  # by the order of the derivative
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
    """H from a source to an output, at one speed.

    body : the car body in a few words. source : "track" (the elevation under the leading wheelset),
    "w_1" … or "f_1" …. signal : what was asked for, "floor_acceleration" or another output's name.
    speed : m/s, None where the source is not the track. position : m forward of the body's middle,
    None off the floor. output : what responds, with its unit. frequency : Hz, (F,). H : complex,
    (F,), in ``unit``. modes : of the vehicle. zeros : the geometric filtering, up to the highest
    frequency.
    """

    vehicle: str
    body: str
    floor: str
    source: str
    signal: str
    speed: float | None
    position: float | None
    output: Output
    frequency: Array
    H: Complex
    modes: tuple[Mode, ...]
    zeros: tuple[GeometricZeros, ...]

    @property
    def unit(self) -> str:
        """Of H: the output's unit per metre, or per newton of an actuator."""
        unit = self.output.unit
        return f"{f'({unit})' if '/' in unit else unit}/{'N' if self.source[0] == 'f' else 'm'}"

    @property
    def magnitude(self) -> Array:
        """|H|, (F,)."""
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
            f"magnitude [{self.unit}]": self.magnitude,
            "phase [deg]": self.phase_deg,
        })  # fmt: skip


def bode(
    model: VehicleModel,
    speeds: float | Sequence[float] | None = None,
    frequency: ArrayLike | None = None,
    *,
    at: float | Sequence[float] = (0.0,),
    floor: str = "smooth",
    outputs: str | Sequence[str] = FLOOR,
    source: str | Sequence[str] = TRACK,
    **changes: ArrayLike,
) -> tuple[BodeResponse, ...]:
    """Responses of a vehicle: sources outer, then speeds, outputs, and points of the floor inner.

    Parameters
    ----------
    speeds : m/s, one or several, each > 0; needed for the track, without effect on other sources.
    frequency : Hz, ascending, > 0; default 2,000 from 0.2 to 40 Hz.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    outputs : names of ``model.outputs``, and "floor_acceleration", "floor_velocity" and
        "floor_displacement", which are taken at every point of ``at``.
    source : "track", the elevation under the leading wheelset, all wheelsets with exact delays;
        "w_1" …, the elevation under one wheelset; "f_1" …, an actuator; or several of them.
    changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : a speed of 0, frequencies that are none or not ascending, a point off the body, an
        output or a source that does not exist, an unstable vehicle.

    Examples
    --------
    >>> from railride import derive_vehicle, load_vehicle
    >>> coach = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> (found,) = bode(coach, [200 / 3.6], [1.0, 2.0, 5.0])
    >>> [(z.cause, z.distance, z.frequency.round(3).tolist()) for z in found.zeros]
    [('bogie spacing', 17.5, [1.587, 4.762])]
    >>> bode(coach, source="f_1", outputs="secondary_2_deflection")[0].unit
    'm/N'
    """
    signals, sources = names(outputs, "outputs"), names(source, "source")
    points = several(at, "at", "m")
    f = check_ascending(np.geomspace(*BAND_HZ, POINTS) if frequency is None else frequency)
    asked = _asked(model, signals, points, floor)
    every = [output for _, _, output in asked]
    moving = [(one, speed) for one in sources for speed in _speeds(one, speeds)]
    found_modes = modes(model, **changes)
    found = []
    for one, speed in moving:
        H = responses(model, every, [one], f, speed=speed, **changes)[:, 0]
        for (signal, x, output), response in zip(asked, H, strict=True):
            zeros = () if speed is None else geometric_zeros(model, output, speed, float(f[-1]),
                                                             **changes)  # fmt: skip
            found.append(
                BodeResponse(
                    vehicle=model.vehicle.name, body=model.body.title, floor=floor, source=one,
                    signal=signal, speed=speed, position=x, output=output, frequency=f,
                    H=response, modes=found_modes, zeros=zeros,
                )
            )  # fmt: skip
    return tuple(found)


def _speeds(source: str, speeds: float | Sequence[float] | None) -> Sequence[float | None]:
    """The speeds at which a source is felt: only the track moves on."""
    if source != TRACK or speeds is None:
        return [None]  # of the track, that is refused where its delays are taken
    listed = several(speeds, "speeds", "m/s")
    if not listed:
        raise InputError("speeds: found none; expected at least one")
    for speed in listed:
        check_speed(speed)
    return listed


def _asked(
    model: VehicleModel, signals: Sequence[str], points: Sequence[float], floor: str
) -> list[tuple[str, float | None, Output]]:
    """Name, point of the floor and output of all that is asked for; other names are refused."""
    known = model.outputs
    asked: list[tuple[str, float | None, Output]] = []
    for signal in signals:
        if signal in ON_FLOOR:
            if not points:
                raise InputError("at: found none; expected at least one")
            order = ON_FLOOR.index(signal)
            asked += [(signal, x, model.floor(x, floor, order)) for x in points]
        elif signal in known:
            asked.append((signal, None, known[signal]))
        else:
            raise InputError(f"output: found {signal!r}; expected one of "
                             f"{', '.join([*reversed(ON_FLOOR), *known])}")  # fmt: skip
    return asked


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
    delays = wheelset_delays(model, speed, **changes)
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
