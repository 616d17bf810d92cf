r"""The semi-active on/off skyhook: secondary dampers that switch, in time simulation.

.. math:: c_b = \begin{cases} c_{max} & \dot z_{body}(x_b)\, \dot s_b > 0 \\
                              c_{min} & \text{otherwise} \end{cases}

A damper can only take energy out: it is hard where its force would be the sky's and soft where it
would push the body on. The valves are set at every sample and hold to the next, so that the vehicle
is one of 2ⁿ linear ones over each step, n bogies, and each step is exact under an input that is
linear between samples. With an elastic mount, s is the damper's own stroke.

Source: D. Karnopp, M.J. Crosby, R.A. Harwood, ASME J. Eng. Ind. 96 (1974) 619-626.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from railride.active.signals import suspension_signals
from railride.comfort import ComfortIndices, indices
from railride.errors import Faults
from railride.firstorder import first_order
from railride.frequency import wheelset_delays
from railride.modal import eigen, refuse_unstable
from railride.numeric import Array
from railride.quantities import check_number, several
from railride.response import first_order_hold, simulate
from railride.ridden import ridden_track
from railride.rides import RATE
from railride.spectra import Spectrum, check_speed
from railride.statespace import system_arrays
from railride.timerun import run_in_time, with_run_in
from railride.track import Track
from railride.trackfile import load_track
from railride.vehicle import Output, VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

CHUNK = 1 << 14  # samples whose forcing is held at a time, in every setting of the valves
DESIGNS = ("passive", "semi-active")


@dataclass(frozen=True, eq=False)
class SemiActiveRide:
    """The passive vehicle and the semi-active one over the same track; both first axes in order.

    speed : m/s. positions : m. time : (n,), s, zero where the rated section begins. acceleration :
    (2, positions, n), m/s². travel : (2, bogies, n), m, of the secondary suspension. force :
    (2, bogies, n), N, of its dampers, positive when it pulls. damping : (2, bogies, n), N s/m.
    rated : the samples that are rated. found : the comfort indices, by design and position.
    """

    speed: float
    positions: tuple[float, ...]
    time: Array
    acceleration: Array
    travel: Array
    force: Array
    damping: Array
    rated: slice
    found: tuple[tuple[ComfortIndices, ...], ...]
    remarks: tuple[str, ...] = ()

    def table(self) -> pd.DataFrame:
        """Both designs as rows, the units in the column names."""
        import pandas as pd

        rows = []
        for k, design in enumerate(DESIGNS):
            row: dict[str, float | None] = {}
            for x, found in zip(self.positions, self.found[k], strict=True):
                row[f"a_wrms at {x:g} m [m/s^2]"] = found.a_wrms
                row[f"MTVV at {x:g} m [m/s^2]"] = found.mtvv
            for quantity, values in (("travel", self.travel), ("damper force", self.force)):
                unit = "m" if quantity == "travel" else "N"
                squares = np.mean(values[k][:, self.rated] ** 2, axis=-1)
                for b, square in enumerate(squares, start=1):
                    row[f"{quantity} r.m.s. bogie {b} [{unit}]"] = float(np.sqrt(square))
            rows.append({"design": design} | row)
        return pd.DataFrame(rows).set_index("design")


def semi_active_ride(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track = "erri_low",
    *,
    c_max: float,
    c_min: float,
    at: float | Sequence[float] = (0.0,),
    length: float = 1000.0,
    seed: int = 1,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    rate: float = RATE,
) -> SemiActiveRide:
    """Run the vehicle over a track with its own secondary dampers and with switching ones.

    Parameters
    ----------
    speed : V in m/s, > 0. track : the name of a spectrum, a track file, a spectrum or a track.
    c_max, c_min : damping of each bogie's secondary damper, hard and soft, N s/m,
        0 ≤ c_min ≤ c_max; where the damper has an elastic mount, c_min > 0.
    at : points of the floor, m forward of the body's middle. length : m, the rated section.
    seed : of a synthetic track. floor : "smooth" or "polygon". weight : a weighting or its name.
    rate : samples a second, at each of which the valves are set.

    Raises
    ------
    InputError : a value out of its range; a track that is shorter than ``length``; an unstable
        vehicle.
    """
    _check_arguments(model, c_max, c_min, length=length, rate=rate)
    check_speed(speed)
    source, weighted_by = load_track(track), weighting(weight)
    at = several(at, "at", "m")
    points = [model.floor(x, floor) for x in at]
    settling, said = run_in_time(model, system_arrays(model, points), speed, weighted_by)
    road, before = with_run_in(
        model, speed, ridden_track(source, [speed], length, seed), length, speed * settling
    )
    time, u, rated = _inputs(model, speed, road, length, before, rate)
    designs = [
        _passive(model, points, u, 1 / rate),
        _switched(_Switched.of(model, points, c_min, c_max, 1 / rate), u, _at_rest(model, u)),
    ]
    acceleration, travel, force, damping = (np.stack(of) for of in zip(*designs, strict=True))
    found = tuple(
        tuple(indices(a, rate, weighted_by, section=rated, before=0.0) for a in design)
        for design in acceleration
    )
    remarks = [said] if said else []
    remarks += [
        f"{name}, {x:g} m: {remark}" for name, row in zip(DESIGNS, found, strict=True)
        for x, one in zip(at, row, strict=True) for remark in one.remarks
    ]  # fmt: skip
    return SemiActiveRide(speed, tuple(at), time, acceleration, travel, force, damping, rated,
                          found, tuple(remarks))  # fmt: skip


def _check_arguments(model: VehicleModel, c_max: float, c_min: float, **positive: float) -> None:
    faults = Faults("semi-active")
    mounted = any(b.secondary_damper_stiffness is not None for b in model.vehicle.bogies)
    for name, value in (("c_max", c_max), ("c_min", c_min)):
        check_number(faults, name, value, ">= 0", "N s/m")
        if mounted and value == 0:
            faults.add(name, "0 N s/m on an elastic mount", "a damping above 0")
    for name, value in positive.items():
        check_number(faults, name, value, "> 0")
    if not faults.found and c_min > c_max:
        faults.add("c_min", f"{c_min:g} N s/m", f"at most c_max, {c_max:g} N s/m")
    faults.raise_if_any()


def _inputs(
    model: VehicleModel, speed: float, road: Track, length: float, before: float, rate: float
) -> tuple[Array, Array, slice]:
    """Times, elevations and rates (w, ẇ) under every wheelset, and the rated samples."""
    start = road.end - length
    first, last = -int(np.floor(before / speed * rate)), int(np.floor(length / speed * rate))
    time = np.arange(first, last + 1) / rate
    delays = wheelset_delays(model, speed)
    w, slope = road.elevation(start + speed * (time - delays[:, np.newaxis]))
    return time, np.vstack([w, speed * slope]), slice(-first, time.size)


@dataclass(frozen=True, eq=False)
class _Switched:
    """The vehicle in each setting of its valves, bit b of a setting's number: damper b is hard.

    E (settings, s, s), F0, F1 (settings, s, inputs): one step. C (settings, outputs, s), D: floor
    accelerations, travels and damper rates. body, stroke (bogies, s): the rates that decide.
    damping (settings, bogies).
    """

    E: Array
    F0: Array
    F1: Array
    C: Array
    D: Array
    body: Array
    stroke: Array
    damping: Array

    @classmethod
    def of(
        cls, model: VehicleModel, points: Sequence[Output], soft: float, hard: float, dt: float
    ) -> _Switched:
        """All settings of the valves of a model, each bogie's damper ``soft`` or ``hard``."""
        m, n = model.matrices(), len(model.vehicle.bogies)
        signals = suspension_signals(model)
        velocities = [signals[f"body_{b}_velocity"] for b in model.running_gear.bogies]
        Y = model.output_rows([*_outputs(model, points), *velocities])
        own = _own_damping(model)
        stroke = Y["v"][-2 * n : -n]
        bits = (np.arange(2**n)[:, np.newaxis] >> np.arange(n)) & 1
        damping = np.where(bits, hard, soft)
        forms, steps = [], []
        for c in damping:
            changed = replace(m, C=m.C + stroke.T * (c - own) @ stroke)
            refuse_unstable(eigen(changed)[0])
            x, force = first_order(changed), np.hstack([m.K_w, m.C_w])
            steps.append(first_order_hold(x.A, x.B @ force, dt))
            C = Y["d"] @ x.q_x + Y["v"] @ x.v_x + Y["a"] @ x.a_x
            D = np.hstack([Y["w"], Y["dw"]]) + (Y["v"] @ x.v_f + Y["a"] @ x.a_f) @ force
            forms.append((C[:-n], D[:-n], C[-n:], C[-2 * n : -n]))
        E, F0, F1 = (np.stack(part) for part in zip(*steps, strict=True))
        C, D, body, strokes = (np.stack(part) for part in zip(*forms, strict=True))
        return cls(E, F0, F1, C, D, body[0], strokes[0], damping)


def _outputs(model: VehicleModel, points: Sequence[Output]) -> list[Output]:
    """Floor accelerations, travels and damper rates."""
    signals, bogies = suspension_signals(model), model.running_gear.bogies
    travels = [signals[f"secondary_{b}_deflection"] for b in bogies]
    return [*points, *travels, *(signals[f"damper_{b}_rate"] for b in bogies)]


def _own_damping(model: VehicleModel) -> Array:
    """c_2 of every bogie, N s/m."""
    values = model.values()
    symbols = [model.running_gear.symbol("secondary_damping", b) for b in model.running_gear.bogies]
    return np.array([float(values[symbol.name]) for symbol in symbols])


def _at_rest(model: VehicleModel, u: Array) -> Array:
    """The state that follows the track as it is under the wheelsets at the first sample."""
    m, n = model.matrices(), len(model.linear.inputs)
    q, dq = np.linalg.solve(m.K, m.K_w @ np.stack([u[:n, 0], u[n:, 0]], axis=-1)).T
    return first_order(m).state(q, dq)


Motion = tuple[Array, Array, Array, Array]
"""Accelerations, travels, damper forces and dampings, each over all samples."""


def _passive(model: VehicleModel, points: Sequence[Output], u: Array, dt: float) -> Motion:
    """The vehicle with its own dampers."""
    s, n = system_arrays(model, _outputs(model, points)), len(u)
    y = simulate(s.A, s.B[:, :n], s.C, s.D[:, :n], u, dt, x0=_at_rest(model, u)).outputs
    own = _own_damping(model)
    return _split(y, np.tile(own[:, np.newaxis], u.shape[1]))


def _switched(model: _Switched, u: Array, x: Array) -> Motion:
    """The vehicle with switching dampers, from the state x (s,) over all samples of u."""
    states, settings = _march(model, u, x)
    y = np.empty((model.C.shape[1], u.shape[1]))
    for k, (C, D) in enumerate(zip(model.C, model.D, strict=True)):
        here = settings == k
        y[:, here] = C @ states[:, here] + D @ u[:, here]
    return _split(y, model.damping[settings].T)


def _split(y: Array, damping: Array) -> Motion:
    """What the rows of the outputs are; a damper's force is its damping times its rate."""
    n = len(damping)
    return y[: -2 * n], y[-2 * n : -n], damping * y[-n:], damping


def _march(model: _Switched, u: Array, x: Array) -> tuple[Array, NDArray[np.int_]]:
    """States (s, n), and the setting of the valves that each sample chooses and holds."""
    samples, bogies = u.shape[1], len(model.body)
    states, settings = np.empty((samples, len(x))), np.empty(samples, dtype=int)
    decide, steps = np.vstack([model.body, model.stroke]), list(model.E)
    for start in range(0, samples, CHUNK):
        part = u[:, start : start + CHUNK + 1]
        forcing = (model.F0 @ part[:, :-1] + model.F1 @ part[:, 1:]).transpose(2, 0, 1).copy()
        for k in range(start, min(start + CHUNK, samples)):
            rates = decide.dot(x).tolist()
            setting = 0
            for b in range(bogies):
                if rates[b] * rates[bogies + b] > 0:
                    setting |= 1 << b
            states[k], settings[k] = x, setting
            if k + 1 < samples:
                x = steps[setting].dot(x)
                x += forcing[k - start, setting]
    return states.T, settings
