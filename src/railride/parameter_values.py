"""The parameters of a model as numbers: changed, checked, and the dependent ones worked out."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.bodies import BodyModel, Parameter
from railride.carried import Carried
from railride.errors import InputError
from railride.lagrange import Lagrangian, Signal
from railride.numeric import Array, MatrixFunction
from railride.running_gear import OPTIONAL, SYMBOLS, RunningGear
from railride.toml_tables import shown

KEYS = {  # of parameter files that name one symbol without doubt
    "bending_frequency": "f_bending",
    "bending_damping": "zeta_bending",
    "bending_stiffness": "EI",
    "shear_stiffness": "kappa_GA",
    "rotary_inertia": "rho_I",
    "rayleigh_mass": "alpha_R",
    "rayleigh_stiffness": "beta_R",
    "joint_stiffness": "k_theta",
    "joint_damping": "c_theta",
}
AMBIGUOUS = ("mass", "pitch_inertia")  # of the body or of a bogie


class ParameterValues:
    """Values of every parameter of a car body, what it carries and its running gear, by symbol.

    Parameters
    ----------
    body, carried, running_gear : what has the parameters. system : their energies.
    """

    def __init__(
        self, body: BodyModel, carried: Carried, running_gear: RunningGear, system: Lagrangian
    ) -> None:
        self.body, self.running_gear = body, running_gear
        self.independent: tuple[Parameter, ...] = (
            *body.parameters,
            *running_gear.parameters,
            *carried.parameters,
        )
        self.definitions = {**body.definitions, **carried.definitions}
        known = {p.symbol for p in self.independent} | set(self.definitions)
        left = _parameters_of(system) - known
        self.dependent = sorted(left, key=lambda s: (len(s.name), s.name))

    def at(self, changes: Mapping[str, ArrayLike]) -> dict[str, Array]:
        """Values with those in ``changes`` (by symbol, see :meth:`symbol_of`) in their place.

        Raises
        ------
        InputError : a value that is not finite, or not positive where it must be; shapes that do
            not broadcast; a mass distribution that cannot be.
        """
        values = {p.symbol.name: np.asarray(p.value, dtype=float) for p in self.independent}
        symbols = {p.symbol.name: p.symbol for p in self.independent}
        symbols |= {s.name: s for s in (*self.definitions, *self.body.followers)}
        for name, value in changes.items():
            values[name] = _as_numbers(name, value)
            _refuse_impossible(name, values[name], symbols.get(name))
        _refuse_unlike_shapes(values)
        self._define(values)
        self.body.check_values(values)
        left = [symbol for symbol in self.dependent if symbol.name not in changes]
        values |= self.body.dependent_values(values, left)
        self._define(values)  # those that follow from dependent ones
        return values

    def _define(self, values: dict[str, Array]) -> None:
        """Put in the defined parameters of which all is known."""
        for name, definition in self._definitions.items():
            if name not in values and all(s.name in values for s in definition.symbols):
                values[name] = definition(values)[name][..., 0, 0]

    def symbol_of(self, name: str) -> str:
        """The symbol behind a name: itself, or a key of parameter files that all bogies share.

        Raises
        ------
        InputError : a name that the model does not have, with those it has and the near ones.
        """
        symbols = {p.symbol.name: p.meaning for p in self.independent}
        symbols |= {s.name: "follows from others" for s in self.definitions}
        symbols |= {s.name: meaning for s, (meaning, _) in self.body.followers.items()}
        keys = dict(KEYS)
        for key in {**SYMBOLS, **OPTIONAL}:
            if key not in AMBIGUOUS:
                keys[key] = self.running_gear.symbol(key, 1).name
        keys = {key: symbol for key, symbol in keys.items() if symbol in symbols}
        if name in symbols or name in keys:
            return str(keys.get(name, name))
        near = difflib.get_close_matches(str(name), [*symbols, *keys], n=3)
        listed = ", ".join(f"{s} ({meaning})" for s, meaning in sorted(symbols.items()))
        hint = f" (did you mean {' or '.join(near)}?)" if near else ""
        raise InputError(f"parameters: found {shown(name)}; expected one of {listed}{hint}")

    @cached_property
    def _definitions(self) -> dict[str, MatrixFunction]:
        return {
            symbol.name: MatrixFunction({symbol.name: sp.Matrix([[definition]])})
            for symbol, definition in self.definitions.items()
        }


def _parameters_of(system: Lagrangian) -> set[sp.Symbol]:
    """The symbols of a system that are no signals."""
    work = [part for pair in system.virtual_work for part in pair]
    energies = [system.kinetic, system.potential, system.dissipation]
    found = [sp.sympify(u).free_symbols for u in (*energies, *work, *system.kinematics.values())]
    return {s for s in set[sp.Symbol]().union(*found) if not isinstance(s, Signal)}


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
