"""A smooth random track that begins level, for programs that integrate in time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass(frozen=True)
class Waves:
    """Waves of 2.5 to 60 m, faded in over the first second of the leading wheelset.

    speed : m/s. behind : m, of each wheelset behind the leading one. scale : of the elevations; at
    1 their r.m.s. is 6 mm.
    """

    speed: float
    behind: tuple[float, ...]
    scale: float = 1.0

    @classmethod
    def under(cls, model, speed, scale=1.0):
        """The track as it passes under the wheelsets of a model."""
        places = model.wheelset_places()
        return cls(speed, tuple((places.max() - places).tolist()), scale)

    @cached_property
    def waves(self):
        """Heights (m), frequencies (rad/s) and phases."""
        length = np.geomspace(2.5, 60.0, 40)
        height = self.scale * 0.4e-3 * length / np.sqrt(length.size)
        phase = np.random.default_rng(3).uniform(0, 2 * np.pi, length.size)
        return height, 2 * np.pi * self.speed / length, phase

    def __call__(self, j, t):
        """Elevation (m) and its rate (m/s) under wheelset j, from 0, at times t (s)."""
        height, turn, phase = self.waves
        own = np.asarray(t, dtype=float) - self.behind[j] / self.speed
        angle = np.multiply.outer(own, turn) + phase
        level, rate = np.sin(angle) @ height, np.cos(angle) @ (height * turn)
        p = np.clip(own, 0.0, 1.0)
        faded, fading = p**3 * (10 - 15 * p + 6 * p**2), 30 * p**2 * (1 - p) ** 2
        return faded * level, faded * rate + fading * level

    def under_all(self, t):
        """Elevations, then rates, of all wheelsets: (2 · wheelsets, samples)."""
        w, dw = zip(*(self(j, t) for j in range(len(self.behind))), strict=True)
        return np.array([*w, *dw])
