"""The parameters of a model as numbers: changed, checked, and the dependent ones worked out."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.bodies import BodyModel, Parameter
from railride.bodies.segments import c_theta, f_bending, k_theta, zeta_bending
from railride.errors import InputError
from railride.linear import linearise
from railride.numeric import Array, MatrixFunction, symmetric_eigenvalues
from railride.running_gear import OPTIONAL, SYMBOLS, RunningGear

KEYS = {  # of parameter files that name one symbol without doubt
    "bending_frequency": f_bending,
    "bending_damping": zeta_bending,
    "joint_stiffness": k_theta,
    "joint_damping": c_theta,
}
AMBIGUOUS = ("mass", "pitch_inertia")  # of the body or of a bogie


class ParameterValues:
    """Values of every parameter of a car body on its running gear, by symbol.

    Parameters
    ----------
    body, running_gear : what has the parameters.
    """

    def __init__(self, body: BodyModel, running_gear: RunningGear) -> None:
        self.body, self.running_gear = body, running_gear
        self.independent: tuple[Parameter, ...] = (*body.parameters, *running_gear.parameters)

    def at(self, changes: Mapping[str, ArrayLike]) -> dict[str, Array]:
        """Values with those in ``changes`` (by symbol, see :meth:`symbol_of`) in their place.

        Raises
        ------
        InputError : a value that is not finite, or not positive where it must be; shapes that do
            not broadcast; a mass distribution that cannot be.
        """
        values = {p.symbol.name: np.asarray(p.value, dtype=float) for p in self.independent}
        symbols = {p.symbol.name: p.symbol for p in self.independent}
        symbols |= {s.name: s for s in (*self.body.definitions, k_theta)}
        for name, value in changes.items():
            values[name] = _as_numbers(name, value)
            _refuse_impossible(name, values[name], symbols.get(name))
        _refuse_unlike_shapes(values)
        for name, definition in self._definitions.items():
            if name not in changes:
                values[name] = definition(values)[name][..., 0, 0]
        self.body.check_values(values)
        if self.body.segments > 1:
            self._calibrate_joints(values)
        return values

    def symbol_of(self, name: str) -> str:
        """The symbol behind a name: itself, or a key of parameter files that all bogies share.

        Raises
        ------
        InputError : a name that the model does not have, with those it has and the near ones.
        """
        symbols = {p.symbol.name: p.meaning for p in self.independent}
        if self.body.segments > 1:
            symbols |= {s.name: "follows from others" for s in self.body.definitions}
            symbols |= {k_theta.name: "joint stiffness", c_theta.name: "joint damping"}
        keys = {key: symbol.name for key, symbol in KEYS.items()}
        for key in {**SYMBOLS, **OPTIONAL}:
            if key not in AMBIGUOUS:
                keys[key] = self.running_gear.symbol(key, 1).name
        keys = {key: symbol for key, symbol in keys.items() if symbol in symbols}
        if name in symbols or name in keys:
            return str(keys.get(name, name))
        near = difflib.get_close_matches(name, [*symbols, *keys], n=3)
        listed = ", ".join(f"{s} ({meaning})" for s, meaning in sorted(symbols.items()))
        hint = f" (did you mean {' or '.join(near)}?)" if near else ""
        raise InputError(f"parameters: found {name!r}; expected one of {listed}{hint}")

    @cached_property
    def _definitions(self) -> dict[str, MatrixFunction]:
        return {
            symbol.name: MatrixFunction({symbol.name: sp.Matrix([[definition]])})
            for symbol, definition in self.body.definitions.items()
        }

    def _calibrate_joints(self, values: dict[str, Array]) -> None:
        """Put k_θ = (2π f_1)²/λ_1 and c_θ = 2 ζ k_θ/ω_1 in, λ_1 = ω_1²/k_θ of the free body.

        Source for c_θ: a joint moment k_θ γ + c_θ γ̇ damps the first mode by c_θ ω_1/(2 k_θ).
        """
        if k_theta.name in values and c_theta.name in values:
            return
        unit = self.unit_bending(values)[..., 0]
        if k_theta.name not in values:
            values[k_theta.name] = (2 * np.pi * values[f_bending.name]) ** 2 / unit
        if c_theta.name not in values:
            stiffness, omega = values[k_theta.name], np.sqrt(values[k_theta.name] * unit)
            values[c_theta.name] = 2 * values[zeta_bending.name] * stiffness / omega

    @cached_property
    def _free_body(self) -> MatrixFunction:
        linear = linearise(self.body.energies)
        return MatrixFunction({"M": linear.M, "K": linear.K})

    def free_body_stiffness(self, values: Mapping[str, ArrayLike]) -> Array:
        """K of the empty car body alone, free in space: shape (..., n, n) in its coordinates."""
        return self._free_body(values)["K"]

    def unit_bending(self, values: Mapping[str, ArrayLike]) -> Array:
        """ω²/k_θ of the empty body's free-free bending modes, ascending: shape (..., N - 1)."""
        A = self._free_body({**values, k_theta.name: 1.0})
        return symmetric_eigenvalues(A["M"], A["K"])[..., 2:]


def _as_numbers(name: str, value: ArrayLike) -> Array:
    try:
        return np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(
            f"parameters: found {value!r} for {name}; expected numbers in SI units (texts with "
            "units belong into parameter files)"
        ) from None


def _refuse_unlike_shapes(values: Mapping[str, Array]) -> None:
    try:
        np.broadcast_shapes(*(value.shape for value in values.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {value.shape}" for name, value in values.items() if value.ndim)
        raise InputError(
            f"parameters: found arrays of different shapes, {shapes}; expected shapes that "
            "broadcast (one length, or an axis of its own for each)"
        ) from None


def _refuse_impossible(name: str, value: Array, symbol: sp.Symbol | None) -> None:
    """Refuse a value that is not finite, or not positive where its symbol is."""
    positive = symbol is not None and symbol.is_positive
    fits = np.isfinite(value) & (value > 0) if positive else np.isfinite(value)
    if not np.all(fits):
        found = np.atleast_1d(value)[~np.atleast_1d(fits)][0]
        expected = "finite numbers above 0" if positive else "finite numbers"
        raise InputError(f"parameters: found {found} for {name}; expected {expected}")
