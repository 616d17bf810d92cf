r"""What a design comes to: comfort and all that may be limited, each with its exact gradient.

The expected peak of an output over T (see :mod:`railride.stochastic.extremes`) with its
derivatives, by the spectral moments m_0 and m_2:

.. math:: E = \sigma \left(l + \frac{\gamma}{l}\right), \quad l = \sqrt{2 \ln \nu T}, \qquad
          dE = \left(l + \frac{\gamma}{l}\right) d\sigma
             + \frac{\sigma}{l} \left(1 - \frac{\gamma}{l^2}\right) \frac{d\nu}{\nu}

.. math:: \sigma = \sqrt{m_0}, \quad d\sigma = \frac{dm_0}{2\sigma}, \qquad
          \frac{d\nu}{\nu} = \frac12 \left(\frac{dm_2}{m_2} - \frac{dm_0}{m_0}\right)

A wheelset's static load is that of its weight and of the primary spring above it, Q_0 = m_w g - k_1
p_0, p_0 the spring's static extension (negative).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from railride.designs.given import Cases
from railride.errors import InputError
from railride.numeric import Array
from railride.optimisation.cases import run_name, runs
from railride.sensitivities import (
    Derivatives,
    Tangent,
    mean_squares_with_gradient,
    roots_with_gradient,
    static_deflections_with_gradient,
)
from railride.stochastic.extremes import (
    DISTANCE,
    EULER,
    FEW_CROSSINGS,
    LOW_PASS_HZ,
    expected_peak,
    low_pass,
    moment,
)
from railride.stochastic.gains import PLAIN, Gain, weighted
from railride.stochastic.squares import mean_squares
from railride.units import STANDARD_GRAVITY
from railride.vehicle import Output, VehicleModel

COMFORT = "a_wrms"


@dataclass(frozen=True, eq=False)
class Values:
    """Values of one kind, SI: (m,); their gradients by the parameters, (m, P); what each is of."""

    value: Array
    gradient: Array
    of: tuple[str, ...]

    def of_mode(self, label: str) -> Values:
        """Those of the modes of a label; all of them for ""."""
        at = [k for k, name in enumerate(self.of) if label in ("", name)]
        return Values(self.value[at], self.gradient[at], tuple(self.of[k] for k in at))

    def along(self, slopes: Array) -> Values:
        """With gradients by other variables, each the only one of its parameter: dp/du (P,)."""
        return Values(self.value, self.gradient * slopes, self.of)


@dataclass(frozen=True, eq=False)
class Measures:
    """Makes the values of designs.

    derivatives : of the model by the chosen parameters. kinds : of the limits wanted, beside
    comfort. distance : m, over which peaks are expected.
    """

    model: VehicleModel
    derivatives: Derivatives
    cases: Cases
    kinds: frozenset[str] = field(default=frozenset())
    distance: float = DISTANCE

    def at(self, values: dict[str, float]) -> dict[str, Values]:
        """Values of comfort and of every kind wanted, for parameters by symbol.

        Raises
        ------
        InputError : a design that cannot be or that has no stationary ride.
        """
        at = self.derivatives.at(**values)
        found = {COMFORT: self._comfort(at)}
        for level in ("secondary", "primary"):
            if self.kinds & {f"{level}_travel", f"{level}_travel_rms"}:
                found |= self._travel(at, level)
        if "damping_ratio" in self.kinds:
            found["damping_ratio"] = self._damping(at)
        if self.kinds & {"secondary_static", "primary_static", "wheel_load_variation"}:
            found |= self._static(at)
        if "wheel_load_variation" in self.kinds:
            static = self._static_loads(at, found["primary_static"])
            found["wheel_load_variation"] = self._wheel_loads(at, static)
        return found

    def exact(self, values: dict[str, float]) -> tuple[Array, Array]:
        """a_wrms of every case, in closed form where there is one, and its relative error: (m,)."""
        at, gain = self.derivatives.at(**values), weighted(self.cases.weight)
        rows = at.floor(self.cases.positions, self.cases.floor).rows
        found = [mean_squares(at.m, rows, at.places.tolist(), self.cases.speeds, track, (gain,))
                 for track in self.cases.tracks]  # fmt: skip
        squares, errors = (np.concatenate([of[0, :, 0].ravel() for of in part])
                           for part in zip(*found, strict=True))  # fmt: skip
        return np.sqrt(squares), errors / 2

    def _comfort(self, at: Tangent) -> Values:
        """a_wrms of every case."""
        cases, rows = self.cases, at.floor(self.cases.positions, self.cases.floor)
        gain = weighted(cases.weight)
        found = []
        for track in cases.tracks:
            squares, slopes = mean_squares_with_gradient(at, rows, cases.speeds, track, (gain,))
            found.append((squares[:, 0].ravel(), slopes[:, 0].reshape(-1, slopes.shape[-1])))
        J, dJ = (np.concatenate(part) for part in zip(*found, strict=True))
        a = np.sqrt(J)
        named = tuple(f"{run_name(track, speed)}, {x:g} m"
                      for track, speed in runs(cases) for x in cases.positions)  # fmt: skip
        return Values(a, dJ / (2 * a[:, np.newaxis]), named)

    def _travel(self, at: Tangent, level: str) -> dict[str, Values]:
        """R.m.s. and expected peak of every deflection of a suspension, over every run."""
        outputs = self._outputs(f"{level}_")
        moments = self._moments(at, outputs, (moment(PLAIN, 0), moment(PLAIN, 2)))
        rms = [_root(m[0], dm[0]) for _, m, dm in moments]
        peaks = [
            expected_peak_gradient(*m, *dm, duration=self.distance / speed)
            for (_, speed), m, dm in moments
        ]
        named = self._named(outputs)
        return {
            f"{level}_travel_rms": _joined(rms, named),
            f"{level}_travel": _joined(peaks, named),
        }

    def _wheel_loads(self, at: Tangent, static: Values) -> Values:
        """R.m.s. of the dynamic wheel load over the static one, of every wheelset and run."""
        outputs = self._outputs("wheel_load_")
        found = []
        for _, (m,), (dm,) in self._moments(at, outputs, (low_pass(LOW_PASS_HZ),)):
            rms, slope = _root(m, dm)
            ratio = rms / static.value
            change = slope - ratio[:, np.newaxis] * static.gradient
            found.append((ratio, change / static.value[:, np.newaxis]))
        return _joined(found, self._named(outputs))

    def _moments(
        self, at: Tangent, outputs: Sequence[Output], gains: Sequence[Gain]
    ) -> list[tuple[tuple[str, float], Array, Array]]:
        """Of every run: which, mean squares (gains, outputs) and their gradients."""
        rows, found = at.rows(outputs), []
        for track in self.cases.tracks:
            squares, slopes = mean_squares_with_gradient(at, rows, self.cases.speeds, track, gains)
            found += [((track.name, speed), m, dm) for speed, m, dm in
                      zip(self.cases.speeds, squares, slopes, strict=True)]  # fmt: skip
        return found

    @staticmethod
    def _damping(at: Tangent) -> Values:
        """The least damping ratio of the modes of every label."""
        roots = roots_with_gradient(at)
        labels = [mode.label for mode in roots.modes]
        each = list(dict.fromkeys(labels))
        zeta = roots.damping_ratios
        least = [min((k for k, of in enumerate(labels) if of == label), key=zeta.__getitem__)
                 for label in each]  # fmt: skip
        # At critical damping, 1 as it is, there is no slope.
        return Values(zeta[least], np.nan_to_num(roots.damping_slopes[least]), tuple(each))

    def _static(self, at: Tangent) -> dict[str, Values]:
        """Static deflections of both suspensions, positive in compression, and wheel loads."""
        deflections, slopes = static_deflections_with_gradient(at)
        found = {}
        for level in ("secondary", "primary"):
            chosen = [k for k, name in enumerate(deflections) if name.startswith(level)]
            value = -np.array(list(deflections.values()))[chosen]
            named = [_spoken(name) for name in deflections if name.startswith(level)]
            found[f"{level}_static"] = Values(value, -slopes[chosen], tuple(named))
        return found

    def _static_loads(self, at: Tangent, compressed: Values) -> Values:
        """Q_0 of every wheelset: m_w g + k_1 times the compression; of none without masses."""
        gear, value, slope = self.model.running_gear, [], []
        for b in gear.bogies:
            if self.model.vehicle.bogies[b - 1].wheelset_mass is None:
                continue
            k_1, m_w = (
                gear.symbol(name, b).name for name in ("primary_stiffness", "wheelset_mass")
            )
            for j, _ in gear.levers(b):
                p, dp = compressed.value[j - 1], compressed.gradient[j - 1]
                k, m = float(at.values[k_1]), float(at.values[m_w])
                value.append(m * STANDARD_GRAVITY + k * p)
                slope.append(k * dp + p * self._unit(k_1) + STANDARD_GRAVITY * self._unit(m_w))
        return Values(np.array(value), np.array(slope), ())

    def _unit(self, symbol: str) -> Array:
        """The derivative of an independent parameter by all of them, (P,)."""
        return np.array([float(name == symbol) for name in self.derivatives.parameters])

    def _outputs(self, start: str) -> list[Output]:
        """Deflections of a suspension, or wheel loads, from the front."""
        return [output for name, output in self.model.outputs.items() if name.startswith(start)]

    def _named(self, outputs: Iterable[Output]) -> tuple[str, ...]:
        """Every output over every run."""
        spoken = [_spoken(output.name) for output in outputs]
        return tuple(f"{name}, {run_name(track, speed)}"
                     for track, speed in runs(self.cases) for name in spoken)  # fmt: skip


def expected_peak_gradient(
    m_0: Array, m_2: Array, dm_0: Array, dm_2: Array, *, duration: float
) -> tuple[Array, Array]:
    """E of outputs (m,) from their moments, and its gradient (m, P) from those of the moments.

    Raises
    ------
    InputError : fewer than ten zero up-crossings in the duration, s.
    """
    sigma, dsigma = _root(m_0, dm_0)
    crossings = np.sqrt(m_2 / m_0)
    if (crossings * duration < FEW_CROSSINGS).any():
        raise InputError(
            f"limits.distance: found one that lasts {duration:.3g} s, in which an output crosses "
            f"zero {float((crossings * duration).min()):.2g} times; expected {FEW_CROSSINGS:g} at "
            "least, for a peak to be expected (a longer distance, or a limit of the r.m.s.)"
        )
    l = np.sqrt(2 * np.log(crossings * duration))[:, np.newaxis]  # noqa: E741 - as in the formula
    relative = (dm_2 / m_2[:, np.newaxis] - dm_0 / m_0[:, np.newaxis]) / 2
    dE = (l + EULER / l) * dsigma
    dE = dE + sigma[:, np.newaxis] / l * (1 - EULER / l**2) * relative
    return expected_peak(sigma, crossings, duration), dE


def _root(square: Array, slope: Array) -> tuple[Array, Array]:
    """√y of (m,) and its gradient from that of y, (m, P)."""
    root = np.sqrt(square)
    return root, slope / (2 * root[:, np.newaxis])


def _joined(parts: Sequence[tuple[Array, Array]], named: tuple[str, ...]) -> Values:
    value, gradient = (np.concatenate(part) for part in zip(*parts, strict=True))
    return Values(value, gradient, named)


def _spoken(name: str) -> str:
    """An output's name in words: "secondary suspension 1"."""
    level, number = name.removesuffix("_deflection").rsplit("_", 1)
    words = {"secondary": "secondary suspension", "primary": "primary suspension"}
    return f"{words.get(level, 'wheelset')} {number}"
