r"""Exact values of many designs at once.

Matrices come from the vectorised functions of the model, mean squares from residues
(:mod:`railride.stochastic.residues`), and where those are not to be trusted, or the spectrum is no
rational function, from quadrature (:mod:`railride.stochastic.process`), design by design. What a
design comes to does not depend on those beside it, and one that cannot be has no values and a
reason.

Source: as :mod:`railride.stochastic.ride`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from railride.designs.batches import Batch, sound_batches
from railride.designs.given import Cases, Tracks, given_cases, given_designs
from railride.designs.rides import Ridden, Rides, suspensions, wheel_loads
from railride.designs.shapes import KnownModes
from railride.designs.statics import static_deflections
from railride.designs.values import DesignValues
from railride.numeric import Array
from railride.stochastic.extremes import missing_loads
from railride.stochastic.process import BAND_HZ, covered_band
from railride.stochastic.ride import STATED
from railride.vehicle import VehicleModel
from railride.weightings import Weighting

if TYPE_CHECKING:
    import pandas as pd

TOGETHER = 2000  # designs at a time: what the memory need not notice


def evaluate_designs(
    model: VehicleModel,
    designs: Mapping[str, ArrayLike] | pd.DataFrame,
    tracks: Tracks | Sequence[Tracks],
    speeds: ArrayLike,
    at: ArrayLike = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    results: str | Sequence[str] = ("a_wrms",),
    progress: Callable[[float], Any] | None = None,
) -> DesignValues:
    """Exact comfort values of every design over every track at every speed and point of the floor.

    Parameters
    ----------
    designs : parameters, by symbol or by their keys in parameter files (``VehicleModel.values``),
        and their values in SI units: one for each design, or one for all. What is not among them
        keeps the model's value.
    tracks : a spectrum or its name, a track or its file, or several of them.
    speeds : V in m/s, each > 0. at : points of the floor, m forward of the body's middle.
    floor : how it is read, "smooth" or "polygon". weight : a weighting or its name.
    results : some of "a_wrms", "a_rms", "wz"; "travel", r.m.s. and expected peak over a kilometre
        of every secondary and primary deflection; "wheel_loads", the same of the dynamic loads of
        wheelsets whose mass is known, below 20 Hz; "modes", natural frequencies and damping ratios,
        named as the model's own modes that they are alike; "static", deflections by the weight.
    progress : called with the fraction done.

    Returns
    -------
    values : arrays over designs and cases. A design that cannot be, is unstable, or in which an
        undamped mode is felt, has NaN, and its reason among ``problems``.

    Raises
    ------
    InputError : a name that the model does not have; lists of different lengths, or none; a case
        that cannot be: a speed ≤ 0, a point off the body, a track that cannot be read, a spectrum
        with nothing in the band at a speed.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> values = evaluate_designs(coach, {"secondary_stiffness": [6e5, 7.5e5, 9e5]}, "erri_low",
    ...                           [145 / 3.6, 200 / 3.6], floor="polygon")
    >>> values.a_wrms.shape, values.a_wrms[1, 0, :, 0].round(3).tolist()
    ((3, 1, 2, 1), [0.247, 0.328])
    >>> list(values.table())[:2]
    ['secondary_stiffness [N/m]', 'a_wrms erri_low 145 km/h 0 m [m/s^2]']
    """
    cases = given_cases(model, tracks, speeds, at, floor, weight, results)
    given = given_designs(model, designs)
    for spectrum in cases.tracks:
        for speed in cases.speeds:
            covered_band(spectrum, speed, BAND_HZ)
    count = len(next(iter(given.values()))) if given else 1
    found = _Found(model, cases, count)
    for start in range(0, count, TOGETHER):
        numbers = np.arange(start, min(start + TOGETHER, count))
        batches, refused = sound_batches(model, given, numbers)
        for number, problem in refused.items():
            found.problems[number] = problem
        for batch in batches:
            found.take(batch)
        if progress is not None:
            progress((numbers[-1] + 1) / count)
    units = {name: model.meanings[model.symbol_of(name)][1] for name in given}
    return DesignValues(
        parameters=given,
        units=units,
        tracks=tuple(spectrum.name for spectrum in cases.tracks),
        speeds=cases.speeds,
        positions=cases.positions,
        suspensions=tuple(output.name for output in suspensions(model)),
        wheel_loads=tuple(output.name for output in wheel_loads(model)),
        modes=found.known.names if found.known else (),
        error=found.error,
        problems=found.problems,
        remarks=(*cases.remarks, *found.remarks),
        **found.values,
    )


class _Found:
    """Values of ``count`` designs as they are found: arrays of NaN that batches fill."""

    def __init__(self, model: VehicleModel, cases: Cases, count: int) -> None:
        self.model, self.cases = model, cases
        self.problems = np.full(count, "", dtype=object)
        self.error = np.full(count, np.nan)
        self.values: dict[str, Array] = {}
        self.known = KnownModes(model) if "modes" in cases.results else None
        rides = (count, len(cases.tracks), len(cases.speeds))
        for result in cases.results:
            for name, shape in self._shapes(result, rides).items():
                self.values[name] = np.full(shape, np.nan)

    def _shapes(self, result: str, rides: tuple[int, ...]) -> dict[str, tuple[int, ...]]:
        """The arrays of one of the results."""
        if result == "modes" and self.known:
            modes = (rides[0], len(self.known.names))
            return {"natural_frequency": modes, "damping_ratio": modes,
                    "least_damping_ratio": rides[:1]}  # fmt: skip
        if result == "static":
            return {"static_deflection": (rides[0], len(suspensions(self.model)))}
        if result == "travel":
            every = (*rides, len(suspensions(self.model)))
            return {"travel_rms": every, "travel_peak": every}
        if result == "wheel_loads":
            every = (*rides, len(wheel_loads(self.model)))
            return {"load_rms": every, "load_peak": every}
        return {result: (*rides, len(self.cases.positions))}

    def take(self, batch: Batch) -> None:
        """Evaluate a batch."""
        self.error[batch.numbers] = 0.0
        places = self.model.wheelset_places(**batch.values)
        for track, spectrum in enumerate(self.cases.tracks):
            for ridden in Rides(self.model, self.cases, batch, places, spectrum).every():
                for name, values in ridden.values.items():
                    self.values[name][batch.numbers, track] = values
                self._note(batch, ridden)
        if self.known:
            found, refused = self.known.values(batch.forms)
            for name, values in found.items():
                self.values[name][batch.numbers] = values
            self._refuse(batch, refused)
        if "static" in self.cases.results:
            rows = self.model.output_rows(suspensions(self.model), **batch.values)["d"]
            self.values["static_deflection"][batch.numbers] = static_deflections(batch.m, rows)

    def _note(self, batch: Batch, ridden: Ridden) -> None:
        """The largest errors so far, and the first reason why there is no value."""
        errors = np.where(np.isfinite(ridden.errors), ridden.errors, 0.0)
        largest = errors.reshape(len(errors), -1).max(axis=1)
        self.error[batch.numbers] = np.maximum(self.error[batch.numbers], largest)
        self._refuse(batch, ridden.refused)

    def _refuse(self, batch: Batch, refused: Mapping[int, str]) -> None:
        """The first reason why a design lacks values, by its place in the batch."""
        for k, problem in refused.items():
            number = batch.numbers[k]
            self.problems[number] = self.problems[number] or problem

    @property
    def remarks(self) -> list[str]:
        """How many designs lack values, and how many values are uncertain."""
        said, count = [], len(self.problems)
        failed = np.flatnonzero(self.problems != "")
        if failed.size:
            said.append(f"{failed.size} of {count} designs lack values; the first of them, design "
                        f"{failed[0] + 1}: {self.problems[failed[0]]}")  # fmt: skip
        if "wheel_loads" in self.cases.results:
            said += missing_loads(self.model)
        said += [f"{name.partition('_')[0]}: no peak is expected where there are fewer than 10 "
                 "up-crossings in a kilometre" for name in ("travel_peak", "load_peak")
                 if self._without_peak(name)]  # fmt: skip
        doubtful = int((self.error > STATED).sum())
        if doubtful:
            said.append(f"{doubtful} of {count} designs: values are uncertain by up to "
                        f"{np.nanmax(self.error):.0e} of themselves (a mode with next to no "
                        "damping?)")  # fmt: skip
        return said

    def _without_peak(self, name: str) -> bool:
        """Whether there are r.m.s. values without peaks."""
        if name not in self.values:
            return False
        rms = self.values[name.replace("peak", "rms")]
        return bool((np.isnan(self.values[name]) & np.isfinite(rms)).any())
