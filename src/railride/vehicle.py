r"""The vehicle: a car body on bogies, derived, linear in symbols and in numbers.

.. math:: M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f

The coordinates q are the car body's, then each bogie's heave and pitch; w are the elevations under
the wheelsets and f the actuator forces, all numbered from the front.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.bodies import BodyModel, Parameter, Place
from railride.bodies.choice import body_model
from railride.carried import Carried, equipment_heave, mount_deflection
from railride.errors import InputError
from railride.lagrange import Coordinate, Lagrangian, rate
from railride.linear import LinearModel, linearise, output_rows
from railride.numeric import Array, Matrices, MatrixFunction, refuse_untrustworthy
from railride.parameter_values import ParameterValues
from railride.parameters import CarBody, Vehicle, load_vehicle
from railride.plausibility import doubts
from railride.running_gear import (
    RunningGear,
    bogie_heave,
    bogie_pitch,
    primary_deflection,
    secondary_deflection,
)

_DERIVED_ONCE = (
    "lagrangian", "linear", "_numeric", "_rows", "_floors", "_values", "_places_of_wheelsets",
)  # fmt: skip


@dataclass(frozen=True)
class Output:
    """One named result of the model: its expression in signals, its unit and how it is written."""

    name: str
    expression: sp.Expr
    unit: str
    latex: str


@dataclass(frozen=True)
class VehicleModel:
    """A vehicle derived: energies, linear matrices in symbols, and numbers for any parameters.

    Parameters
    ----------
    vehicle : the parameters, SI.
    body : the car body's model.
    remarks : what the user should know of how the model was made.
    overrides : parameter values in place of the vehicle's, see :meth:`changed`.
    """

    vehicle: Vehicle
    body: BodyModel
    remarks: tuple[str, ...] = ()
    overrides: Mapping[str, float] = field(default_factory=dict)

    def changed(self, **changes: float) -> VehicleModel:
        """The same model with other parameter values, ready for a ride; nothing is derived again.

        Raises
        ------
        InputError : a name that the model does not have; a value that cannot be.

        Examples
        --------
        >>> from railride.parameters import load_vehicle
        >>> soft = derive_vehicle(load_vehicle("cati2024"), segments=2).changed(k_2=6e5)
        >>> float(soft.values()["k_2"])
        600000.0
        """
        self.values(**changes)
        named = {self._values.symbol_of(name): float(value) for name, value in changes.items()}
        model = replace(self, overrides={**self.overrides, **named})
        for name in _DERIVED_ONCE:
            model.__dict__[name] = getattr(self, name)
        return model

    @cached_property
    def running_gear(self) -> RunningGear:
        """The bogies, their symbols and energies."""
        return RunningGear(self.vehicle)

    @cached_property
    def carried(self) -> Carried:
        """Payload and equipment."""
        return Carried(self.vehicle)

    @cached_property
    def lagrangian(self) -> Lagrangian:
        """The vehicle's coordinates, energies, inputs and actuator forces."""
        return self.running_gear.under(self.body, self.carried.on(self.body))

    @cached_property
    def linear(self) -> LinearModel:
        """M, C, K, K_w, C_w, B_f in symbols."""
        return linearise(self.lagrangian)

    @cached_property
    def _values(self) -> ParameterValues:
        return ParameterValues(self.body, self.carried, self.running_gear, self.lagrangian)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Every independent parameter with its value: the body's, then the bogies'."""
        return self._values.independent

    @property
    def _places(self) -> dict[Coordinate, Place]:
        """Where on the body what has a heave of its own is attached: bogies and equipment."""
        gear, carried = self.running_gear, self.carried
        found = {bogie_heave(b): gear.place(b) for b in gear.bogies}
        return found | {equipment_heave(e): carried.place(e) for e in carried.equipment}

    def symbol_of(self, name: str) -> str:
        """The symbol behind the name of a parameter: itself, or its key in parameter files.

        Raises
        ------
        InputError : a name that the model does not have, with those it has and the near ones.
        """
        return self._values.symbol_of(name)

    @property
    def meanings(self) -> dict[str, tuple[str, str]]:
        """What parameters mean, and their units, by symbol; empty between others."""
        known = self._values
        dependent = (*known.definitions, *self.body.followers, *known.dependent)
        found = {s.name: max(self.body.meaning(s), self.carried.meaning(s)) for s in dependent}
        return found | {p.symbol.name: (p.meaning, p.unit) for p in known.independent}

    def values(self, **changes: ArrayLike) -> dict[str, Array]:
        """Every parameter's value by symbol, with those in ``changes`` put in their place.

        What all bogies share goes by its key in parameter files too: ``secondary_stiffness`` is
        ``k_2``. Dependent parameters follow: a body that was calibrated to its bending frequency
        keeps it, whatever else changes, unless ``k_theta`` itself is among the changes.

        Raises
        ------
        InputError : a name that the model does not have; a value that cannot be.
        """
        named = {self._values.symbol_of(name): value for name, value in changes.items()}
        return self._values.at({**self.overrides, **named})

    def values_with(self, symbols: Iterable[sp.Symbol], **changes: ArrayLike) -> dict[str, Array]:
        """:meth:`values`, and those of symbols that an output alone needs.

        Shapes of the body's modes at a point of the floor are such.
        """
        values = self.values(**changes)
        left = [symbol for symbol in symbols if symbol.name not in values]
        return values | self.body.dependent_values(values, left)

    def free_body_stiffness(self, **changes: ArrayLike) -> Array:
        """K of the empty car body alone, free in space: shape (..., n, n) in its coordinates."""
        return self.body.free_matrices(self.values(**changes))["K"]

    def bending_frequencies(self, **changes: ArrayLike) -> Array:
        """Free-free bending frequencies of the empty body in Hz, ascending; none if it is rigid."""
        return self.body.bending_frequencies(self.values(**changes))

    @cached_property
    def _numeric(self) -> MatrixFunction:
        return MatrixFunction(self.linear.matrices)

    def matrices(self, **changes: ArrayLike) -> Matrices:
        """The linear matrices as numbers; arrays among ``changes`` give arrays of matrices.

        Examples
        --------
        >>> from railride.parameters import load_vehicle
        >>> model = derive_vehicle(load_vehicle("cati2024"), segments=2)
        >>> model.matrices(k_2=[6e5, 7e5, 8e5]).K.shape
        (3, 7, 7)
        """
        return self.matrices_at(self.values(**changes))

    def matrices_at(self, values: Mapping[str, Array]) -> Matrices:
        """The linear matrices at values in hand, those of :meth:`values`."""
        for place in self._places.values():
            self.body.check_moved(place, values)
        matrices = Matrices(**self._numeric(values), lift=self.lift)
        refuse_untrustworthy(matrices, [q.name for q in self.lagrangian.coordinates])
        return matrices

    @cached_property
    def lift(self) -> Array:
        """u₀: the coordinates of a uniform lift of the whole vehicle by 1 m."""
        body = self.body.lift
        return np.array([
            float(body.get(q, q in self._places)) for q in self.lagrangian.coordinates
        ])  # fmt: skip

    def wheelset_places(self, **changes: ArrayLike) -> Array:
        """Where the wheelsets are, m forward of the body's middle: shape (..., wheelsets).

        >>> from railride.parameters import load_vehicle
        >>> model = derive_vehicle(load_vehicle("cati2024"), segments=2)
        >>> model.wheelset_places(l_b=9.0).tolist()
        [10.25, 7.75, -7.75, -10.25]
        """
        return self._places_of_wheelsets(self.values(**changes))["x"][..., 0, :]

    @cached_property
    def _places_of_wheelsets(self) -> MatrixFunction:
        return MatrixFunction({"x": sp.Matrix([self.running_gear.wheelset_places])})

    def pitch(self, **changes: ArrayLike) -> Array:
        """The coordinates of a small turn of the whole vehicle about the body's middle, per rad.

        Shape (..., n). Track, bogies and body turned by one angle: w_j is the wheelset's place.
        """
        turn = dict.fromkeys(map(bogie_pitch, self.running_gear.bogies), sp.S.One)
        turn |= {heave: place.x for heave, place in self._places.items()}
        turn |= self.body.pitch
        column = sp.Matrix([turn.get(q, sp.S.Zero) for q in self.lagrangian.coordinates])
        return MatrixFunction({"turn": column})(self.values(**changes))["turn"][..., 0]

    def floor(self, at: float = 0.0, reading: str = "smooth", derivative: int = 2) -> Output:
        """Displacement (derivative 0), velocity (1) or acceleration (2) of the floor at a point.

        Parameters
        ----------
        at : m forward of the car body's middle.
        reading : "smooth", "polygon" or "spline" (see :mod:`railride.bodies.floors`); they agree
            on bodies that are not made of segments.

        Raises
        ------
        InputError : a point off the body, or another reading or derivative.
        """
        kinds = {0: ("displacement", "m"), 1: ("velocity", "m/s"), 2: ("acceleration", "m/s^2")}
        if derivative not in kinds:
            raise InputError(f"derivative: found {derivative}; expected 0, 1 or 2")
        self.body.check_point(at)
        self.body.check_reading(reading)
        key = float(at), reading, derivative
        if key not in self._floors:
            self._floors[key] = self._floor(*key, *kinds[derivative])
        return self._floors[key]

    @cached_property
    def _floors(self) -> dict[tuple[float, str, int], Output]:
        return {}

    def _floor(self, at: float, reading: str, derivative: int, kind: str, unit: str) -> Output:
        name = f"floor_{kind}" + _where(at) + ("_polygon" if reading == "polygon" else "")
        height = Coordinate("z_floor")
        symbol = (height, height.dot, height.ddot)[derivative]
        expression = self.body.floor(at, reading)
        for _ in range(derivative):
            expression = rate(expression)
        return Output(name, expression, unit, sp.latex(symbol))

    @cached_property
    def outputs(self) -> dict[str, Output]:
        """Outputs by name: accelerations of bogies and equipment, deflections, wheel loads.

        The dynamic wheel load counts from the static one, and is there where the wheelset's mass is
        known. It feels the second rate of the elevation: only the frequency domain holds it.
        """
        found = []
        for b in self.running_gear.bogies:
            z, s = bogie_heave(b), secondary_deflection(b)
            found.append(Output(f"bogie_{b}_acceleration", z.ddot, "m/s^2", sp.latex(z.ddot)))
            found.append(Output(f"secondary_{b}_deflection", s, "m", sp.latex(s)))
            for j, _ in self.running_gear.levers(b):
                p = primary_deflection(j)
                found.append(Output(f"primary_{j}_deflection", p, "m", sp.latex(p)))
                if self.vehicle.bogies[b - 1].wheelset_mass is not None:
                    load = self.running_gear.wheel_load(b, j)
                    found.append(Output(f"wheel_load_{j}", load, "N", f"Q_{{{j}}}"))
        for e in self.carried.equipment:
            z, s = equipment_heave(e), mount_deflection(e)
            found.append(Output(f"equipment_{e}_acceleration", z.ddot, "m/s^2", sp.latex(z.ddot)))
            found.append(Output(f"equipment_{e}_deflection", s, "m", sp.latex(s)))
        return {output.name: output for output in found}

    def output_rows(self, outputs: Sequence[Output], **changes: ArrayLike) -> dict[str, Array]:
        """Rows of y = Y_a q̈ + Y_v q̇ + Y_d q + Y_w w + Y_dw ẇ + Y_ddw ẅ + Y_f f, one per output.

        Returns
        -------
        dict : "a", "v", "d" (..., outputs, n), "w", "dw", "ddw" (..., outputs, wheelsets), "f"
            (..., outputs, bogies).
        """
        chosen = tuple(outputs)
        if chosen not in self._rows:
            named = {f"{k}: {output.name}": output.expression for k, output in enumerate(chosen)}
            self._rows[chosen] = MatrixFunction(output_rows(self.lagrangian, named))
        rows = self._rows[chosen]
        return rows(self.values_with(rows.symbols, **changes))

    @cached_property
    def _rows(self) -> dict[tuple[Output, ...], MatrixFunction]:
        return {}


def _where(at: float) -> str:
    """A point of the floor in an output's name, where no dot may stand: ``_2_5m_behind``."""
    if at == 0:
        return ""
    return f"_{abs(at):.12g}m_{'ahead' if at > 0 else 'behind'}".replace(".", "_")


def derive_vehicle(
    vehicle: Vehicle | str | Path,
    segments: int | None = None,
    *,
    body: str | None = None,
    modes: int | None = None,
    bending_frequency: float | None = None,
    joint_stiffness: float | None = None,
    bending_damping: float | None = None,
) -> VehicleModel:
    """The model of a vehicle, its car body rigid, of segments, a beam, or of finite elements.

    Parameters
    ----------
    vehicle : the parameters; or the name of a shipped vehicle or a file, to be loaded.
    segments : N ≥ 1; 1 is the rigid body. Default: 4, or 1 where no bending stiffness is known.
    body : "rigid", "segments", "beam" (Euler-Bernoulli's; Timoshenko's where the vehicle has a
        shear stiffness or rotary inertia) or "fe" (finite elements, the vehicle's own or from
        outside). Default: as the segments say, or fe where the vehicle names modes from outside.
    modes : how many bending modes a beam or finite elements have, default 10.
    bending_frequency, joint_stiffness : Hz or N m/rad, instead of what the vehicle says.
    bending_damping : structural damping ratio of the first bending mode, instead of the vehicle's.

    Raises
    ------
    InputError : a number of segments or modes that is none, or does not belong to the body; both of
        the two stiffnesses; values out of range.

    Examples
    --------
    >>> beam = derive_vehicle("cati2024", body="beam", modes=3)
    >>> beam.bending_frequencies().round(2).tolist()
    [9.6, 26.46, 51.88]
    """
    if bending_frequency is not None and joint_stiffness is not None:
        raise InputError(
            "body: found both a bending frequency and a joint stiffness; expected one of them (the "
            "other follows)"
        )
    vehicle = vehicle if isinstance(vehicle, Vehicle) else load_vehicle(vehicle)
    given = {
        "bending frequency": bending_frequency,
        "joint stiffness": joint_stiffness,
        "bending damping": bending_damping,
    }
    several = vehicle.body.bending_frequencies
    vehicle = replace(vehicle, body=_bent(vehicle.body, *given.values()))
    try:
        attachments = [bogie.position for bogie in vehicle.bogies]
        attachments += [each.position for each in vehicle.equipment]
        model = body_model(vehicle.body, body, segments, modes, attachments)
    except InputError as error:
        raise InputError(f"{vehicle.name}: {error}") from None
    remarks = [*doubts(vehicle), *(f"{vehicle.name}: {remark}" for remark in model.remarks)]
    idle = [name for name, value in given.items() if value is not None]
    if several and vehicle.body.bending_frequencies is None and model.kind != "rigid":
        listed = ", ".join(f"{f:g}" for f in several)
        remarks.append(f"{vehicle.name}: the bending frequencies of {listed} Hz are not used: one "
                       "is given in their place")  # fmt: skip
    if idle and model.kind == "rigid":
        remarks.append(f"the body is rigid: {' and '.join(idle)} given with it without effect")
    return VehicleModel(vehicle, model, tuple(remarks))


def _bent(
    body: CarBody, frequency: float | None, stiffness: float | None, damping: float | None
) -> CarBody:
    """The car body with what is given in place of its own bending."""
    if frequency is not None or stiffness is not None:
        body = replace(body, bending_frequency=frequency, joint_stiffness=stiffness,
                       bending_frequencies=None, bending_stiffness=None)  # fmt: skip
    if damping is not None:
        body = replace(body, bending_damping=damping, joint_damping=None, rayleigh_mass=0.0,
                       rayleigh_stiffness=0.0, mode_damping=None)  # fmt: skip
    return body
