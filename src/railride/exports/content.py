r"""What an export holds, whatever its form: the equations, what is in them, and their numbers.

.. math:: M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f

.. math:: y = Y_a \ddot q + Y_v \dot q + Y_d q + Y_w w + Y_{dw} \dot w + Y_f f

Symbols, meanings and units come once from here, so that every form says the same.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp

from railride.errors import Faults, InputError
from railride.frequency import FLOOR
from railride.linear import LinearModel, output_rows
from railride.numeric import Array, Matrices
from railride.quantities import names, several
from railride.report.kinematics import meaning_and_unit
from railride.statespace import System, chosen_outputs, system_arrays
from railride.vehicle import Output, VehicleModel

ROWS = {"Y_a": "a", "Y_v": "v", "Y_d": "d", "Y_w": "w", "Y_dw": "dw", "Y_f": "f"}
"""The outputs' matrices by the names of :meth:`railride.vehicle.VehicleModel.output_rows`."""


@dataclass(frozen=True)
class Quantity:
    """A named scalar: its SI unit ("" for a plain number) and what it means."""

    name: str
    unit: str
    meaning: str


@dataclass(frozen=True)
class ParameterValue(Quantity):
    """A parameter: its value, and what defines it by the parameters before it, if anything does.

    follows : whether the value follows from others by an algorithm that an export does not hold;
    changing those then leaves it.
    """

    value: float
    definition: sp.Expr | None = None
    follows: bool = False


@dataclass(frozen=True)
class Content:
    """A vehicle's linear model with its outputs, in symbols and numbers, ready to be written.

    model : the vehicle. outputs : in the order of the rows of Y, each proper (it must not feel ẅ).

    >>> from railride.vehicle import derive_vehicle
    >>> content = content_of(derive_vehicle("cati2024", segments=2))
    >>> [p.name for p in content.parameters if p.follows], content.matrices["M"].shape
    (['c_theta', 'k_theta'], (7, 7))
    """

    model: VehicleModel
    outputs: tuple[Output, ...]

    @property
    def name(self) -> str:
        """The vehicle's name."""
        return self.model.vehicle.name

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the user should know of the values and of how the model was made."""
        return (*self.model.vehicle.remarks, *self.model.remarks)

    @property
    def linear(self) -> LinearModel:
        """M, C, K, K_w, C_w, B_f in symbols."""
        return self.model.linear

    @cached_property
    def rows(self) -> dict[str, sp.ImmutableSparseMatrix]:
        """Y_a, Y_v, Y_d, Y_w, Y_dw, Y_f in symbols."""
        named = {output.name: output.expression for output in self.outputs}
        rows = output_rows(self.model.lagrangian, named)
        return {name: rows[own] for name, own in ROWS.items()}

    @property
    def matrices(self) -> dict[str, sp.ImmutableSparseMatrix]:
        """All twelve matrices in symbols, the outputs' last."""
        return {**self.linear.matrices, **self.rows}

    @cached_property
    def coordinates(self) -> tuple[Quantity, ...]:
        """q, in the order of the rows of M."""
        segments = self.model.body.segments
        return tuple(
            Quantity(q.name, unit, meaning)
            for q in self.linear.coordinates
            for meaning, unit in [meaning_and_unit(q, segments)]
        )

    @cached_property
    def elevations(self) -> tuple[Quantity, ...]:
        """w, from the front."""
        return tuple(
            Quantity(w.name, "m", f"track elevation under wheelset {j}")
            for j, w in enumerate(self.linear.inputs, start=1)
        )

    @cached_property
    def rates(self) -> tuple[Quantity, ...]:
        """ẇ, from the front."""
        return tuple(
            Quantity(f"d{w.name}", "m/s", f"its rate under wheelset {j}")
            for j, w in enumerate(self.linear.inputs, start=1)
        )

    @cached_property
    def forces(self) -> tuple[Quantity, ...]:
        """f, from the front."""
        return tuple(
            Quantity(f.name, "N", f"actuator over bogie {b}, positive when it pushes apart")
            for b, f in enumerate(self.linear.forces, start=1)
        )

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """u = (w, ẇ, f)."""
        return (*self.elevations, *self.rates, *self.forces)

    @cached_property
    def parameters(self) -> tuple[ParameterValue, ...]:
        """What the matrices and definitions need, each after those that define it."""
        known, body = self.model.meanings, self.model.body
        defined = {
            s: definition
            for s, definition in {**body.definitions, **self.model.carried.definitions}.items()
            if s.name not in self.model.overrides
        }
        wanted: set[sp.Symbol] = set().union(*(A.free_symbols for A in self.matrices.values()))
        wanted |= set().union(*(_all_symbols(s, defined) for s in wanted))
        values = self.model.values_with(wanted)
        own = [p.symbol for p in self.model.parameters]
        rest = sorted(wanted - set(own) - set(defined), key=lambda s: (len(s.name), s.name))
        return tuple(
            ParameterValue(
                s.name, unit, meaning, float(values[s.name]), definition=defined.get(s),
                follows=s in rest and s.name not in self.model.overrides,
            )
            for s in (*own, *rest, *defined)
            if s in wanted
            for meaning, unit in [known.get(s.name, body.meaning(s))]
        )  # fmt: skip

    @cached_property
    def numbers(self) -> dict[str, Array]:
        """All twelve matrices as numbers."""
        rows = self.model.output_rows(self.outputs)
        return {**self.dynamics.by_name, **{name: rows[own] for name, own in ROWS.items()}}

    @cached_property
    def dynamics(self) -> Matrices:
        """M, C, K, K_w, C_w, B_f as numbers, with what holds between them."""
        return self.model.matrices()

    @cached_property
    def system(self) -> System:
        """x' = A x + B u, y = C x + D u with u = (w, ẇ, f), and the names of x, u and y."""
        return system_arrays(self.model, self.outputs)


def content_of(
    model: VehicleModel,
    outputs: Output | str | Sequence[Output | str] | None = None,
    at: float | Sequence[float] = 0.0,
    floor: str = "smooth",
) -> Content:
    """The content of an export.

    Parameters
    ----------
    outputs : one or several, or their names, "floor_acceleration" for that at all points ``at``;
        default: these, and every output of the vehicle that does not feel the elevation's second
        rate.
    at : points of the floor, m forward of the body's middle. floor : "smooth", "polygon" or
        "spline".

    Raises
    ------
    InputError : an output that does not exist, that has the name of something else in the export,
        or that feels the second rate of the elevation, as a wheel load does; a point or a kind of
        the floor, and nothing of the floor among the outputs.
    """
    points = several(at, "at", "m")
    if outputs is None:
        own = list(model.outputs.values())
        second = model.output_rows(own)["ddw"]
        outputs = [FLOOR, *(o for o, row in zip(own, second, strict=True) if not np.any(row))]
    asked = [outputs] if isinstance(outputs, Output) else names(outputs, "outputs")
    if FLOOR not in asked and (points != [0.0] or floor != "smooth"):
        found = f"the floor on its {floor} line" if points == [0.0] else f"points of it, {points} m"
        raise InputError(f"floor: found {found}, but no {FLOOR!r} among the outputs; expected it "
                         "there (or neither)")  # fmt: skip
    floors = [model.floor(x, floor) for x in points]
    wanted = [o for output in asked for o in (floors if output == FLOOR else [output])]
    content = Content(model, tuple(chosen_outputs(model, wanted)))
    _check_names(content)
    _ = content.system  # refuses what cannot be exported
    return content


def _check_names(content: Content) -> None:
    """Refuse outputs with names that an export has for something else; only theirs are free."""
    known = {p.name: "a parameter" for p in content.parameters}
    known |= {u.name: "an input" for u in content.inputs}
    for q in content.coordinates:
        known |= {q.name: "a coordinate", f"d{q.name}": f"the rate of {q.name}"}
        known |= {f"dd{q.name}": f"the acceleration of {q.name}"}
    faults = Faults("export")
    for output in content.outputs:
        if output.name in known:
            faults.add(f"output {output.name!r}", f"the name of {known[output.name]}",
                       "a name of its own", "rename it")  # fmt: skip
    faults.raise_if_any()


def _all_symbols(symbol: sp.Symbol, defined: dict[sp.Symbol, sp.Expr]) -> set[sp.Symbol]:
    """The symbol, and those that its definition needs, and theirs."""
    if symbol not in defined:
        return {symbol}
    return {symbol}.union(*(_all_symbols(s, defined) for s in defined[symbol].free_symbols))
