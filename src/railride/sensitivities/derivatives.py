r"""A vehicle's matrices and their derivatives along parameters, as numbers.

.. math:: \frac{dM}{dp}, \quad \frac{dC}{dp}, \quad \frac{dK}{dp}, \quad \frac{dK_w}{dp}, \quad
          \frac{dC_w}{dp}

come from the symbolic matrices, differentiated once; what follows from the parameters moves with
them (:mod:`railride.sensitivities.chain`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.linear import output_rows
from railride.numeric import Array, Matrices, MatrixDerivative, MatrixFunction
from railride.quantities import names
from railride.sensitivities.chain import Chain
from railride.vehicle import Output, VehicleModel

_NUDGE = 1e-6  # of a value, or of 1 where that is 0: to see whether it can be changed at all

MATRICES = ("M", "C", "K", "K_w", "C_w")


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of outputs (``VehicleModel.output_rows``) and their derivatives, (P, ...).

    by_differences : as of a :class:`Tangent`, of what only these rows hold.
    """

    rows: Mapping[str, Array]
    slopes: Mapping[str, Array]
    by_differences: tuple[str, ...] = ()


class Derivatives:
    """The derivatives of a model along parameters, prepared once for any values.

    Parameters
    ----------
    model : the vehicle.
    parameters : symbols or keys of parameter files, as ``VehicleModel.values`` takes them; default
        every independent one that can be changed and enters the matrices or the wheelsets' places.
        One that follows from others (``k_theta``) is held by being among them.

    ``left_out`` holds those that enter but cannot be changed, by name, and why.

    Raises
    ------
    InputError : a name that the model does not have; one that is there twice, or cannot change.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> derivatives = Derivatives(derive_vehicle("cati2024", segments=2), ["k_2", "f_bending"])
    >>> here = derivatives.at(k_2=700e3)
    >>> here.slopes["k_theta"].tolist()[0], here.dm["K"].shape, here.held
    (0.0, (2, 7, 7), 'bending frequency')
    """

    def __init__(self, model: VehicleModel, parameters: Sequence[str] | None = None) -> None:
        self.model = model
        self._matrices = MatrixDerivative({name: model.linear.matrices[name] for name in MATRICES})
        places = {"places": sp.Matrix([model.running_gear.wheelset_places])}
        self._places, self._moved = MatrixFunction(places), MatrixDerivative(places)
        self._symbols = {*self._matrices.symbols, *self._moved.symbols}
        self.left_out: dict[str, str] = {}
        self.parameters = self._entering() if parameters is None else self._named(parameters)
        self._chain = Chain(model, self.parameters)
        self._rows: dict[tuple[Output, ...], tuple[MatrixFunction, MatrixDerivative]] = {}

    def at(self, **changes: ArrayLike) -> Tangent:
        """Everything at the model's values with ``changes`` in their place; one vehicle at a time.

        Raises
        ------
        InputError : as ``VehicleModel.matrices``; arrays among ``changes``.
        """
        changes = {self.model.symbol_of(name): value for name, value in changes.items()}
        if any(np.ndim(value) for value in changes.values()):
            raise InputError("parameters: found arrays; expected one vehicle at a time")
        values = self.model.values(**changes)
        m = self.model.matrices_at(values)
        slopes, by_differences = self._chain.slopes(values, changes, self._symbols)
        return Tangent(
            self, changes, values, slopes, m, self._matrices(values, slopes),
            self._places(values)["places"][0], self._moved(values, slopes)["places"][:, 0],
            by_differences,
        )  # fmt: skip

    def of_rows(
        self, outputs: Sequence[Output], values: Mapping[str, Array],
        slopes: Mapping[str, Array], changes: Mapping[str, ArrayLike],
    ) -> Rows:  # fmt: skip
        """Rows of outputs and their derivatives at values in hand; see :meth:`Tangent.rows`."""
        chosen = tuple(outputs)
        if chosen not in self._rows:
            named = {f"{k}: {output.name}": output.expression for k, output in enumerate(chosen)}
            symbolic = output_rows(self.model.lagrangian, named)
            self._rows[chosen] = MatrixFunction(symbolic), MatrixDerivative(symbolic)
        rows, derivative = self._rows[chosen]
        left = [s for s in rows.symbols if s.name not in values]
        values = {**values, **self.model.body.dependent_values(values, left)}
        added, by_differences = self._chain.added(values, slopes, changes, derivative.symbols)
        return Rows(rows(values), derivative(values, {**slopes, **added}), by_differences)

    def _entering(self) -> tuple[str, ...]:
        """The independent parameters on which matrices or places depend."""
        body = self.model.body
        definitions = {**body.definitions, **self.model.carried.definitions}
        reached = set(self._symbols)
        for symbol in reversed(definitions):
            if symbol in reached:
                reached |= definitions[symbol].free_symbols
        own = {p.symbol for p in body.parameters}
        independent = {p.symbol for p in self.model.parameters}
        follows = bool(reached - independent - set(definitions))
        found = [
            p.symbol.name for p in self.model.parameters
            if p.symbol in reached or (follows and p.symbol in own)
        ]  # fmt: skip
        why = {name: _why_fixed(self.model, name) for name in found}
        self.left_out = {name: str(error) for name, error in why.items() if error is not None}
        return tuple(name for name in found if name not in self.left_out)

    def _named(self, parameters: Sequence[str]) -> tuple[str, ...]:
        found, faults = [], []
        for name in names(parameters, "parameters"):
            try:
                found.append(self.model.symbol_of(name))
            except InputError as error:
                faults.append(str(error))
        if not found and not faults:
            faults.append("parameters: found none; expected at least one")
        twice = [name for name in dict.fromkeys(found) if found.count(name) > 1]
        if twice:
            faults.append(f"parameters: found {', '.join(twice)} twice; expected each once")
        faults += [
            str(why) for name in dict.fromkeys(found) if (why := _why_fixed(self.model, name))
        ]
        if faults:
            raise InputError("\n".join(faults))
        return tuple(found)


def _why_fixed(model: VehicleModel, name: str) -> InputError | None:
    """Why a parameter can be moved to neither side, if it is so."""
    value, why = float(model.values()[name]), None
    for sign in (1, -1):
        try:
            model.matrices(**{name: value + sign * _NUDGE * (abs(value) or 1.0)})
        except InputError as error:
            why = error
        else:
            return None
    return why


@dataclass(frozen=True, eq=False)
class Tangent:
    """A vehicle at one set of values, and how it moves with P parameters.

    values : of every symbol. slopes : ds/dp of every symbol, (P,). m : the matrices. dm : name of a
    matrix → derivatives (P, ...). places, dplaces : of the wheelsets, m forward, (W,) and (P, W).
    by_differences : symbols whose derivatives are differences of eighth order, not formulas.
    """

    derivatives: Derivatives
    changes: Mapping[str, ArrayLike]
    values: Mapping[str, Array]
    slopes: Mapping[str, Array]
    m: Matrices
    dm: Mapping[str, Array]
    places: Array
    dplaces: Array
    by_differences: tuple[str, ...]

    @property
    def parameters(self) -> tuple[str, ...]:
        """The P parameters' symbols."""
        return self.derivatives.parameters

    @property
    def held(self) -> str:
        """What of the body's bending stays as it is while other parameters move.

        "bending frequency" where it calibrates the body, "joint stiffness", "bending stiffness",
        "bending frequencies" of several or of a body's modes; nothing of a rigid body.
        """
        body = self.derivatives.model.body
        given = {*self.derivatives.model.overrides, *self.changes, *self.parameters}
        own = {p.symbol.name for p in body.parameters}
        if any(name.startswith("k_theta") for name in (given & set(self.values)) | own):
            return "joint stiffness"
        if "f_bending" in own:
            return "bending frequency"
        if "EI" in own:
            return "bending stiffness"
        return "bending frequencies" if own & {"f_bending_1", "f_c1"} else ""

    def rows(self, outputs: Sequence[Output]) -> Rows:
        """Rows of outputs and their derivatives."""
        return self.derivatives.of_rows(outputs, self.values, self.slopes, self.changes)

    def floor(self, at: Sequence[float], floor: str = "smooth") -> Rows:
        """Rows of the floor's acceleration at points, m forward of the body's middle.

        floor : how it is read, see ``VehicleModel.floor``. The height is Y_d q, so that the
        acceleration is Y_d q̈.
        """
        model = self.derivatives.model
        found = self.rows([model.floor(float(x), floor, derivative=0) for x in at])
        rows, slopes = (
            {**of, "a": of["d"], "d": np.zeros_like(of["d"])} for of in (found.rows, found.slopes)
        )
        return Rows(rows, slopes, found.by_differences)
