"""Matrices of many designs at once, though some of them cannot be."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.numeric import Array, Matrices
from railride.stochastic.fractions import EigenForms, eigen_forms
from railride.vehicle import VehicleModel


@dataclass(frozen=True, eq=False)
class Batch:
    """Designs that can be: which of all, (B,), their parameters by name, matrices, eigenvectors."""

    numbers: NDArray[np.int_]
    values: Mapping[str, Array]
    m: Matrices
    forms: EigenForms


def sound_batches(
    model: VehicleModel, designs: Mapping[str, Array], numbers: NDArray[np.int_]
) -> tuple[list[Batch], dict[int, str]]:
    """Batches of the designs that can be; why each of the others, by its number, cannot.

    What the model refuses is halved until the designs that it refuses stand alone.
    """
    values = {name: of[numbers] for name, of in designs.items()}
    try:
        m = _each(model.matrices(**values), numbers.size)
        return [Batch(numbers, values, m, eigen_forms(m))], {}
    except InputError as error:
        if numbers.size == 1:
            return [], {int(numbers[0]): str(error)}
    batches: list[Batch] = []
    problems: dict[int, str] = {}
    for half in np.array_split(numbers, 2):
        some, refused = sound_batches(model, designs, half)
        batches += some
        problems |= refused
    return batches, problems


def _each(m: Matrices, count: int) -> Matrices:
    """Matrices of each design, also where they are the same for all."""
    if m.M.ndim > 2:
        return m
    each = {name: np.broadcast_to(A, (count, *A.shape)) for name, A in m.by_name.items()}
    return Matrices(**each, lift=m.lift)
