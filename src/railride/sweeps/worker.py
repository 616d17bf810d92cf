"""What a worker does: derives the model once, and evaluates designs."""

from __future__ import annotations

from dataclasses import dataclass
from threading import Lock
from typing import TYPE_CHECKING, Any

from railride import __version__
from railride.errors import InputError

if TYPE_CHECKING:
    from railride.numeric import Array
    from railride.parameters import Vehicle
    from railride.studies import BodyOptions, RideCases
    from railride.vehicle import VehicleModel

Columns = dict[str, Any]
"""Heading → values (designs,) of a part: numbers, and texts of what is wrong with a design."""

PROBLEM, ERROR = "problem", "error"  # headings

_models: dict[str, VehicleModel] = {}  # of the study at hand
_lock = Lock()


@dataclass(frozen=True)
class Recipe:
    """All that a worker needs to evaluate designs of a study.

    key : tells studies apart. vehicle, body, ride : as in a Study, the tracks as spectra.
    version : the program's.
    """

    key: str
    vehicle: Vehicle
    body: BodyOptions
    ride: RideCases
    version: str = __version__


def version() -> str:
    """The program's version where it is called."""
    return __version__


def evaluate(recipe: Recipe, designs: dict[str, Array]) -> Columns:
    """The results of designs, a column for each, and what is wrong with designs that have none.

    Raises
    ------
    InputError : a study that cannot be evaluated at all; another version of the program.
    """
    if recipe.version != __version__:
        raise InputError(f"worker: found railride {__version__}; expected {recipe.version}, as "
                         "where the sweep was started (install the same everywhere)")  # fmt: skip
    model = _models.get(recipe.key)
    if model is None:
        with _lock:  # symbols are no work for two threads
            return _values(_derived(recipe), recipe.ride, designs)
    return _values(model, recipe.ride, designs)


def _derived(recipe: Recipe) -> VehicleModel:
    """The model, derived unless another thread was first."""
    model = _models.get(recipe.key) or recipe.body.model(recipe.vehicle)
    _models.clear()
    _models[recipe.key] = model
    return model


def headings(recipe: Recipe, model: VehicleModel, designs: dict[str, Array]) -> list[str]:
    """Headings of the results, from a few designs; the model is kept for more of them."""
    with _lock:
        _models.clear()
        _models[recipe.key] = model
    return list(_values(model, recipe.ride, designs))


def _values(model: VehicleModel, ride: RideCases, designs: dict[str, Array]) -> Columns:
    """Results as columns; those of the parameters, which whoever asks has, are left out."""
    from railride.designs import evaluate_designs

    table = evaluate_designs(
        model, designs, ride.tracks, ride.speeds, ride.positions, floor=ride.floor,
        weight=ride.weight, results=ride.results,
    ).table()  # fmt: skip
    return {name: table[name].to_numpy() for name in list(table)[len(designs) :]}
