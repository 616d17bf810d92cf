"""One roughness factor: the track made rougher or smoother until 145 km/h fits; 200 is predicted.

The vehicle is linear, and so a track whose levels are all multiplied by s (its spectrum by s²)
multiplies a_wrms by s. The factor is fitted at 145 km/h alone,

    s = a_printed(145) / a_exact(145),    predicted: s a_exact(200).

The paper's track is one kilometre, and not the mean of all: each kilometre of ERRI low is scaled to
the printed value at 145 km/h by itself, and the values that it then gives at 200 km/h say how far
from the prediction one kilometre may lie.
"""

from __future__ import annotations

from dataclasses import dataclass

from paper import SPEEDS_KMH
from reproduction_cases import PROGRAMS, bodies, exact, printed
from reproduction_seeds import middle_95, sample

BODIES = ("halves", "beam")


@dataclass(frozen=True)
class Fit:
    """A factor fitted to what one program prints at 145 km/h, and what follows at 200 km/h.

    factor : of the level. fitted, predicted, printed : a_wrms, m/s²; interval : of one kilometre,
    95 %. rigid : a_wrms of the rigid body at both speeds, m/s², over the same track.
    """

    program: str
    body: str
    factor: float
    fitted: float
    predicted: float
    interval: tuple[float, float]
    printed: float
    rigid: tuple[float, float]

    @property
    def error(self) -> float:
        """Predicted over printed at 200 km/h less one."""
        return self.predicted / self.printed - 1

    @property
    def holds(self) -> bool:
        """Whether the printed value at 200 km/h lies in the interval."""
        return self.interval[0] <= self.printed <= self.interval[1]


def fits() -> list[Fit]:
    """Both programs, each with both bodies."""
    return [_fit(program, body) for program in PROGRAMS for body in BODIES]


def _fit(program: str, body: str) -> Fit:
    at_145, at_200 = printed(program)
    slow, fast = exact(bodies()[body])
    rigid = exact(bodies()["rigid"])
    runs = [sample(body, speed).values for speed in SPEEDS_KMH]
    factor = at_145 / slow
    return Fit(program, body, factor, at_145, factor * fast, middle_95(at_145 * runs[1] / runs[0]),
               at_200, (factor * rigid[0], factor * rigid[1]))  # fmt: skip
