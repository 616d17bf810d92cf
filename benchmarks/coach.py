"""The work that the cases share: the paper's coach at its speeds, on tracks and in noise.

Times are taken inside processes of their own, which import numpy and railride in these functions.
"""

from __future__ import annotations

from typing import Any

SPEED = 145 / 3.6
"""m/s, the paper's slower run."""
FASTER = 200 / 3.6
SPEEDS = (SPEED, FASTER)
RATE = 1000.0
"""Samples per second."""
LENGTH = 1000.0
"""m of track."""
RUN_IN = 250.0
"""m before it: 5/(ζω) of heave, ζ = 0.28 at 1 Hz, twice."""
SEGMENTS = 4


def coach() -> Any:
    """The paper's coach with its segments, derived."""
    from railride.vehicle import derive_vehicle

    model = derive_vehicle("cati2024", segments=SEGMENTS)
    model.matrices()
    return model


def vehicle_state_space() -> tuple[Any, Any, Any, Any, Any]:
    """A, B, C, D of the paper's coach, and how long after the first each wheelset arrives.

    Inputs w and w' of the four wheelsets, output the floor's acceleration over the middle.
    """
    import numpy as np

    from railride.parameters import load_vehicle
    from railride.statespace import system_arrays
    from railride.vehicle import derive_vehicle

    vehicle = load_vehicle("cati2024")
    s = system_arrays(derive_vehicle(vehicle, segments=SEGMENTS))
    places = np.array(vehicle.wheelset_positions)
    track = slice(0, 2 * len(places))  # the actuators' forces follow, and stay zero
    return s.A, s.B[:, track], s.C, s.D[:, track], (places.max() - places) / SPEED


def elevations_and_rates(t: Any, delays: Any, waves: int = 300) -> Any:
    """A track of cosines, 2 to 80 m long and 1/1000 of that high, under every wheelset: w, w'."""
    import numpy as np

    rng = np.random.default_rng(2024)
    length = np.geomspace(2.0, 80.0, waves)
    omega = 2 * np.pi * SPEED / length
    height, phase = length / 1000 / np.sqrt(waves), rng.uniform(0, 2 * np.pi, waves)
    w, rate = np.zeros((2, len(delays), len(t)))
    for i, delay in enumerate(delays):
        for amplitude, turn, start in zip(height, omega, phase, strict=True):
            angle = turn * (t - delay) + start
            w[i] += amplitude * np.cos(angle)
            rate[i] -= amplitude * turn * np.sin(angle)
    return np.vstack([w, rate])


def noise(count: int, seed: int) -> Any:
    """Random acceleration, about 1 m/s², most of it below 16 Hz."""
    import numpy as np
    from scipy import signal

    white = np.random.default_rng(seed).standard_normal(count)
    return signal.lfilter([0.3], [1.0, -0.9], white)
