"""The designs of a sweep by number, so that any part of them can be made alone.

Designs are numbered from 1 in what people read and from 0 in here. Of a grid the last parameter
runs fastest, as in loops inside each other.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from math import prod
from pathlib import Path
from typing import Protocol

import numpy as np

from railride.distributions import Distribution, sample
from railride.numeric import Array
from railride.studies import Listed, Range, StudyParameter

MOST = 10**12  # designs


class Plan(Protocol):
    """Designs of a sweep: ``total`` of them, each with a value of every parameter."""

    @property
    def parameters(self) -> tuple[StudyParameter, ...]:
        """The parameters, in the order of the columns."""

    @property
    def total(self) -> int:
        """How many designs there are."""

    def designs(self, start: int, stop: int) -> dict[str, Array]:
        """Symbol → values of the designs number ``start`` to ``stop`` - 1, SI."""

    def keys(self) -> dict[str, object]:
        """What it depends on, by the keys of the study's file."""


@dataclass(frozen=True)
class Grid:
    """Every combination of what the parameters take, each a range of points or listed values."""

    parameters: tuple[StudyParameter, ...]

    @property
    def _axes(self) -> list[Array]:
        return [p.spec.values() for p in self.parameters if isinstance(p.spec, Range | Listed)]

    @property
    def total(self) -> int:
        """How many designs there are."""
        return prod(axis.size for axis in self._axes)

    def designs(self, start: int, stop: int) -> dict[str, Array]:
        """Symbol → values of the designs number ``start`` to ``stop`` - 1, SI."""
        axes = self._axes
        places = np.unravel_index(np.arange(start, stop), [axis.size for axis in axes])
        return {p.symbol: axis[place]
                for p, axis, place in zip(self.parameters, axes, places, strict=True)}  # fmt: skip

    def keys(self) -> dict[str, object]:
        """What it depends on."""
        return {"sweep.kind": "grid", **_parameter_keys(self.parameters)}


@dataclass(frozen=True)
class DesignList:
    """Designs one by one, from a file: ``values`` (designs, parameters), SI."""

    parameters: tuple[StudyParameter, ...]
    values: Array
    file: Path

    @property
    def total(self) -> int:
        """How many designs there are."""
        return len(self.values)

    def designs(self, start: int, stop: int) -> dict[str, Array]:
        """Symbol → values of the designs number ``start`` to ``stop`` - 1, SI."""
        rows = self.values[start:stop]
        return {p.symbol: rows[:, k] for k, p in enumerate(self.parameters)}

    def keys(self) -> dict[str, object]:
        """What it depends on: the values in the file, not how they are written."""
        content = hashlib.sha256(np.ascontiguousarray(self.values).tobytes()).hexdigest()
        columns = [p.name for p in self.parameters]
        return {"sweep.kind": "list", "sweep.file columns": columns,
                "sweep.file rows": self.total, "sweep.file values": content}  # fmt: skip


@dataclass(frozen=True)
class Samples:
    """Designs drawn from the parameters' distributions, see :mod:`railride.distributions`."""

    parameters: tuple[StudyParameter, ...]
    number: int
    method: str
    seed: int

    @property
    def total(self) -> int:
        """How many designs there are."""
        return self.number

    def designs(self, start: int, stop: int) -> dict[str, Array]:
        """Symbol → values of the designs number ``start`` to ``stop`` - 1, SI."""
        drawn = sample(self._distributions(), start, stop, self.method, self.seed, self.number)
        return {p.symbol: drawn[:, k] for k, p in enumerate(self.parameters)}

    def _distributions(self) -> Iterator[Distribution]:
        return (p.spec for p in self.parameters if isinstance(p.spec, Distribution))

    def keys(self) -> dict[str, object]:
        """What it depends on."""
        return {"sweep.kind": "samples", "sweep.number": self.number, "sweep.method": self.method,
                "sweep.seed": self.seed, **_parameter_keys(self.parameters)}  # fmt: skip


def _parameter_keys(parameters: tuple[StudyParameter, ...]) -> dict[str, object]:
    """Their order, and what each takes."""
    keys: dict[str, object] = {"parameters": [p.name for p in parameters]}
    for p in parameters:
        keys |= {f"parameters.{p.name}.{key}": value
                 for key, value in vars(p.spec).items() if not key.startswith("_")}  # fmt: skip
    return keys
