"""What a batch of designs comes to over a track: comfort, suspension travel, wheel loads.

Deflections and loads as :mod:`railride.stochastic.extremes` has them: r.m.s., and the peak to be
expected over a kilometre; loads after the low-pass at 20 Hz.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from railride.comfort import wz_from_rms
from railride.designs.batches import Batch
from railride.designs.given import Cases
from railride.numeric import Array
from railride.spectra import Spectrum
from railride.stochastic.extremes import (
    DISTANCE,
    LOW_PASS_HZ,
    expected_peak,
    low_pass,
    moment,
)
from railride.stochastic.gains import PLAIN, Gain, sperling, weighted
from railride.stochastic.process import relative
from railride.stochastic.ride import floor_rows
from railride.stochastic.squares import squares_of_many
from railride.vehicle import Output, VehicleModel


@dataclass(frozen=True, eq=False)
class Ridden:
    """Values by name, (B, speeds, outputs), the relative errors of all, (B, …), and why some of the
    batch, by their places in it, have none.
    """

    values: Mapping[str, Array]
    errors: Array
    refused: Mapping[int, str]


def suspensions(model: VehicleModel) -> list[Output]:
    """The deflections of every secondary and primary suspension."""
    return [output for name, output in model.outputs.items()
            if name.startswith(("secondary_", "primary_")) and "deflection" in name]  # fmt: skip


def wheel_loads(model: VehicleModel) -> list[Output]:
    """The dynamic loads of the wheelsets whose mass is known."""
    return [output for name, output in model.outputs.items() if name.startswith("wheel_load")]


@dataclass(frozen=True, eq=False)
class Rides:
    """The batch over one of the tracks, ``spectrum``; places : of its wheelsets, m forward."""

    model: VehicleModel
    cases: Cases
    batch: Batch
    places: Array
    spectrum: Spectrum

    def every(self) -> list[Ridden]:
        """All that is asked for."""
        found, results = [], self.cases.results
        if {"a_rms", "a_wrms", "wz"} & set(results):
            found.append(self.comfort())
        if "travel" in results:
            found.append(self.extremes("travel", suspensions(self.model), PLAIN))
        if "wheel_loads" in results and (loads := wheel_loads(self.model)):
            found.append(self.extremes("load", loads, low_pass(LOW_PASS_HZ)))
        return found

    def comfort(self) -> Ridden:
        """The floor's acceleration."""
        gains = {"a_rms": PLAIN, "a_wrms": weighted(self.cases.weight), "wz": sperling()}
        wanted = {name: gain for name, gain in gains.items() if name in self.cases.results}
        rows = floor_rows(self.model, self.cases.positions, self.cases.floor, self.batch.values)
        squares, errors, refused = self._squares(rows, list(wanted.values()))
        values = dict(zip(wanted, np.moveaxis(np.sqrt(squares), 2, 0), strict=True))
        if "wz" in values:
            values["wz"] = wz_from_rms(values["wz"])
        return Ridden(values, errors / 2, refused)

    def extremes(self, name: str, outputs: Sequence[Output], gain: Gain) -> Ridden:
        """R.m.s. and expected peaks of outputs, as ``name_rms`` and ``name_peak``."""
        rows = self.model.output_rows(outputs, **self.batch.values)
        gains = [moment(gain, order) for order in (0, 2)]
        squares, errors, refused = self._squares(rows, gains)
        sigma = np.sqrt(squares[:, :, 0])
        crossings = np.sqrt(relative(squares[:, :, 1], squares[:, :, 0]))
        times = DISTANCE / np.array(self.cases.speeds)[:, np.newaxis]
        peaks = expected_peak(sigma, crossings, times)
        return Ridden({f"{name}_rms": sigma, f"{name}_peak": peaks}, errors / 2, refused)

    def _squares(
        self, rows: Mapping[str, Array], gains: Sequence[Gain]
    ) -> tuple[Array, Array, dict[int, str]]:
        return squares_of_many(
            self.batch.m, rows, self.places, self.cases.speeds, self.spectrum, gains,
            forms=self.batch.forms,
        )  # fmt: skip
