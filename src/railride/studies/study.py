"""A study: one vehicle, the rides it is judged by, and the parameters that are varied."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from railride.parameters import Vehicle
from railride.studies.body import BodyOptions
from railride.studies.cases import RideCases
from railride.studies.parameters import StudyParameter
from railride.vehicle import VehicleModel


@dataclass(frozen=True)
class Study:
    """What a study file says.

    name : the study's. path : its file. vehicle, body : what rides, and how its body is made.
    ride : what is ridden. parameters : those that are varied, in the file's order.
    settings : of each section that was asked for, what its reader made of it.

    A study goes to other processes without its model, which they derive themselves.
    """

    name: str
    path: Path
    vehicle: Vehicle
    body: BodyOptions
    ride: RideCases
    parameters: tuple[StudyParameter, ...]
    settings: Mapping[str, Any] = field(default_factory=dict)

    def model(self) -> VehicleModel:
        """The vehicle's model, derived when it is first asked for."""
        if "_model" not in self.__dict__:
            self.__dict__["_model"] = self.body.model(self.vehicle)
        found: VehicleModel = self.__dict__["_model"]
        return found

    def __getstate__(self) -> dict[str, Any]:
        return {key: value for key, value in self.__dict__.items() if key != "_model"}
