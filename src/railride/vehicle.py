r"""The vehicle: a car body on bogies, as one Lagrangian, with its linear model in symbols and numbers.

Each bogie adds its heave z_b and pitch θ_b, and springs and dampers that act vertically:

.. math:: T = \tfrac12 m_b \dot z_b^2 + \tfrac12 I_b \dot\theta_b^2, \quad
          V = \tfrac12 k_2 s^2 + \sum_j \tfrac12 k_1 p_j^2, \quad
          D = \tfrac12 c_2 \dot s^2 + \sum_j \tfrac12 c_1 \dot p_j^2

.. math:: s = z_{body}(x_b) - z_b, \qquad p_j = z_b + l_j \sin\theta_b - w_j

with the extension s of the secondary suspension and p_j of the primary suspension of wheelset j.
Heights count from static equilibrium: preloads carry the weight. An actuator force f, positive when
it pushes body and bogie apart, does the virtual work f δs.

Source: Y. Çati, M. Düzgün, F.E. Kracht, Appl. Sci. 2024, 14, 3848, Figure 2 and Table 1.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike
from sympy import sin

from railride.bodies import BodyModel, Parameter, RigidBody, SegmentedBody
from railride.bodies.segments import c_theta, f_bending, k_theta, zeta_bending
from railride.errors import InputError
from railride.lagrange import Coordinate, Force, Input, Lagrangian, rate
from railride.linear import LinearModel, linear_output, linearise
from railride.numeric import Array, MatrixFunction, evaluate, symmetric_eigenvalues
from railride.parameters import Vehicle

BOGIE_SYMBOLS = {
    "mass": ("m_b", "bogie mass", "kg"),
    "pitch_inertia": ("I_b", "bogie pitch inertia", "kg m^2"),
    "primary_stiffness": ("k_1", "primary stiffness per axle", "N/m"),
    "primary_damping": ("c_1", "primary damping per axle", "N s/m"),
    "secondary_stiffness": ("k_2", "secondary stiffness per bogie", "N/m"),
    "secondary_damping": ("c_2", "secondary damping per bogie", "N s/m"),
}


@dataclass(frozen=True)
class Output:
    """One named result of the model: its expression in signals, its unit and how it is written."""

    name: str
    expression: sp.Expr
    unit: str
    latex: str


@dataclass(frozen=True)
class Matrices:
    """M, C, K (..., n, n), K_w, C_w (..., n, wheelsets) and B_f (..., n, bogies) as numbers, SI.

    Raises
    ------
    InputError : M, C or K not symmetric, M not positive definite, or a uniform lift that strains:
        K u₀ = K_w 1 and C u₀ = C_w 1 must hold, u₀ the coordinates of a uniform lift.
    """

    M: Array
    C: Array
    K: Array
    K_w: Array
    C_w: Array
    B_f: Array
    lift: Array

    def __post_init__(self) -> None:
        for name in ("M", "C", "K", "K_w", "C_w", "B_f"):
            if not np.isfinite(getattr(self, name)).all():
                raise InputError(f"{name}: found a value that is no finite number; expected "
                                 "finite parameters, lengths other than zero")  # fmt: skip
        for name in ("M", "C", "K"):
            A = getattr(self, name)
            if np.abs(A - np.swapaxes(A, -1, -2)).max() > 1e-9 * np.abs(A).max():
                raise InputError(f"{name}: found a matrix that is not symmetric; expected "
                                 "springs and dampers between pairs of points")  # fmt: skip
        try:
            np.linalg.cholesky(self.M)
        except np.linalg.LinAlgError:
            raise InputError("M: found a mass matrix that is not positive definite; expected "
                             "positive masses and inertias") from None  # fmt: skip
        for name, A, A_w in (("K", self.K, self.K_w), ("C", self.C, self.C_w)):
            strain = np.abs(A @ self.lift - A_w.sum(axis=-1)).max()
            if strain > 1e-9 * max(np.abs(A).max(), 1e-300):
                raise InputError(f"{name}: found that a uniform lift of vehicle and track leaves "
                                 f"a force of {strain:.3g}; expected none")  # fmt: skip


@dataclass(frozen=True)
class VehicleModel:
    """A vehicle derived: energies, linear matrices in symbols, and numbers for any parameters.

    Parameters
    ----------
    vehicle : the parameters, SI.
    body : the car body's model.
    remarks : what the user should know of how the model was made.
    """

    vehicle: Vehicle
    body: BodyModel
    remarks: tuple[str, ...] = ()

    @cached_property
    def lagrangian(self) -> Lagrangian:
        """The vehicle's coordinates, energies, inputs and actuator forces."""
        body = self.body.energies
        T, V, D = [body.kinetic], [body.potential], [body.dissipation]
        kinematics = dict(body.kinematics)
        for b, bogie in enumerate(self.vehicle.bogies, start=1):
            m, I, k1, c1, k2, c2 = (self._symbol(name, b) for name in BOGIE_SYMBOLS)
            z, theta, s = bogie_heave(b), bogie_pitch(b), secondary_deflection(b)
            kinematics[s] = self.body.height(self._place(b), bogie.position) - z
            T += [m * z.dot**2 / 2, I * theta.dot**2 / 2]
            V.append(k2 * s**2 / 2)
            D.append(c2 * s.dot**2 / 2)
            for j, lever in self._levers(b):
                p = primary_deflection(j)
                kinematics[p] = z + lever * sin(theta) - wheelset_elevation(j)
                V.append(k1 * p**2 / 2)
                D.append(c1 * p.dot**2 / 2)
        bogies = range(1, len(self.vehicle.bogies) + 1)
        return Lagrangian(
            [*body.coordinates, *(q(b) for b in bogies for q in (bogie_heave, bogie_pitch))],
            sp.Add(*T),
            sp.Add(*V),
            sp.Add(*D),
            inputs=[wheelset_elevation(j + 1) for j in range(len(self.vehicle.wheelset_positions))],
            forces=[actuator(b) for b in bogies],
            virtual_work=[(actuator(b), secondary_deflection(b)) for b in bogies],
            kinematics=kinematics,
        )

    @cached_property
    def linear(self) -> LinearModel:
        """M, C, K, K_w, C_w, B_f in symbols."""
        return linearise(self.lagrangian)

    @cached_property
    def parameters(self) -> tuple[Parameter, ...]:
        """Every independent parameter with its value: the body's, then the bogies'."""
        found = {p.symbol: p for p in self.body.parameters}
        for b, bogie in enumerate(self.vehicle.bogies, start=1):
            for name, (_, meaning, unit) in BOGIE_SYMBOLS.items():
                symbol = self._symbol(name, b)
                found[symbol] = Parameter(symbol, meaning, unit, getattr(bogie, name))
            places = [(self._place(b), "bogie position, from the body's middle", bogie.position)]
            places += [
                (self._lever(b, x), "wheelset position, from the bogie's centre", x)
                for x in bogie.wheelsets
            ]
            for place, meaning, value in places:
                for symbol in place.free_symbols:
                    found[symbol] = Parameter(symbol, meaning, "m", value * int(place / symbol))
        return tuple(found.values())

    def values(self, **changes: ArrayLike) -> dict[str, Array]:
        """Every parameter's value by name, with those in ``changes`` put in their place.

        Dependent parameters follow: a body that was calibrated to its bending frequency keeps
        it, whatever else changes, unless ``k_theta`` itself is among the changes.

        Raises
        ------
        InputError : a name that the model does not have; a value that is not finite.
        """
        values: dict[str, Array] = {
            p.symbol.name: np.asarray(p.value, dtype=float) for p in self.parameters
        }
        dependent = [s.name for s in self.body.definitions] + ["k_theta", "c_theta"]
        for name, value in changes.items():
            if name not in values and (name not in dependent or self.body.segments == 1):
                known = ", ".join(sorted({*values, *(dependent if self.body.segments > 1 else ())}))
                raise InputError(f"parameters: found {name!r}; expected one of {known}")
            values[name] = np.asarray(value, dtype=float)
            if not np.isfinite(values[name]).all():
                raise InputError(f"parameters: found {value} for {name}; expected finite numbers")
        for symbol, definition in self.body.definitions.items():
            if symbol.name not in changes:
                values |= evaluate({symbol.name: definition}, values)
        if self.body.segments > 1:
            self._calibrate_joints(values)
        return values

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

    def unit_bending(self, values: Mapping[str, ArrayLike]) -> Array:
        """ω²/k_θ of the free-free bending modes, ascending: shape (..., N - 1)."""
        A = self._free_body({**values, k_theta.name: 1.0})
        return symmetric_eigenvalues(A["M"], A["K"])[..., 2:]

    def free_body_stiffness(self, **changes: ArrayLike) -> Array:
        """K of the car body alone, free in space: shape (..., n, n) in the body's coordinates."""
        return self._free_body(self.values(**changes))["K"]

    def bending_frequencies(self, **changes: ArrayLike) -> Array:
        """Free-free bending frequencies of the car body in Hz, ascending; none if it is rigid."""
        if self.body.segments == 1:
            return np.zeros(0)
        values = self.values(**changes)
        stiffness = values[k_theta.name][..., np.newaxis]
        return np.asarray(np.sqrt(self.unit_bending(values) * stiffness) / (2 * np.pi))

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
        values = self.values(**changes)
        self._refuse_moved_joints(values)
        return Matrices(**self._numeric(values), lift=self.lift)

    @cached_property
    def lift(self) -> Array:
        """u₀: the coordinates of a uniform lift of the whole vehicle by 1 m."""
        body = self.body.lift
        heaves = {bogie_heave(b + 1) for b in range(len(self.vehicle.bogies))}
        return np.array([
            float(body.get(q, q in heaves)) for q in self.lagrangian.coordinates
        ])  # fmt: skip

    def floor(self, at: float = 0.0, reading: str = "smooth", derivative: int = 2) -> Output:
        """Displacement (derivative 0), velocity (1) or acceleration (2) of the floor at a point.

        Parameters
        ----------
        at : m forward of the car body's middle.
        reading : "smooth" or "polygon"; they agree on a rigid body.

        Raises
        ------
        InputError : a point off the body, or another reading or derivative.
        """
        kinds = {0: ("displacement", "m"), 1: ("velocity", "m/s"), 2: ("acceleration", "m/s^2")}
        if derivative not in kinds:
            raise InputError(f"derivative: found {derivative}; expected 0, 1 or 2")
        kind, unit = kinds[derivative]
        name = f"floor_{kind}" if at == 0 else f"floor_{kind}_at_{at:g}m"
        height = Coordinate("z_floor")
        symbol = (height, height.dot, height.ddot)[derivative]
        expression = self.body.floor(at, reading)
        for _ in range(derivative):
            expression = rate(expression)
        return Output(name, expression, unit, sp.latex(symbol))

    @cached_property
    def outputs(self) -> dict[str, Output]:
        """Outputs by name: each bogie's acceleration, every suspension deflection, body ends."""
        found = []
        for b in range(1, len(self.vehicle.bogies) + 1):
            z, s = bogie_heave(b), secondary_deflection(b)
            found.append(Output(f"bogie_{b}_acceleration", z.ddot, "m/s^2", sp.latex(z.ddot)))
            found.append(Output(f"secondary_{b}_deflection", s, "m", sp.latex(s)))
            for j, _ in self._levers(b):
                p = primary_deflection(j)
                found.append(Output(f"primary_{j}_deflection", p, "m", sp.latex(p)))
        return {output.name: output for output in found}

    def output_rows(self, outputs: Sequence[Output], **changes: ArrayLike) -> dict[str, Array]:
        """Rows of y = Y_a q̈ + Y_v q̇ + Y_d q + Y_w w + Y_dw ẇ + Y_f f, one per output.

        Returns
        -------
        dict : "a", "v", "d" (..., outputs, n), "w", "dw" (..., outputs, wheelsets), "f"
            (..., outputs, bogies).

        Raises
        ------
        InputError : an output that feels the second rate of an input.
        """
        system = self.lagrangian
        gradients = [linear_output(system, output.expression) for output in outputs]
        for output, gradient in zip(outputs, gradients, strict=True):
            if any(w.ddot in gradient for w in system.inputs):
                raise InputError(f"output {output.name}: found that it feels the second rate of the "
                                 "track elevation; expected elevations and rates")  # fmt: skip
        q, w = system.coordinates, system.inputs
        columns = {"a": [s.ddot for s in q], "v": [s.dot for s in q], "d": q, "w": w}
        columns |= {"dw": [s.dot for s in w], "f": system.forces}
        rows = {
            name: sp.SparseMatrix([[g.get(s, 0) for s in of] for g in gradients])
            for name, of in columns.items()
        }
        return MatrixFunction(rows)(self.values(**changes))

    def _refuse_moved_joints(self, values: Mapping[str, Array]) -> None:
        """The heights that the bogies follow were taken on given segments: hold to them."""
        if not isinstance(self.body, SegmentedBody):
            return
        for b, bogie in enumerate(self.vehicle.bogies, start=1):
            place = evaluate({"x": self._place(b)}, values)["x"]
            length = values["L"]
            ahead = (0.5 - place / length) * self.body.segments
            here = self.body.segment_at(bogie.position)
            if (ahead < here - 1 - 1e-9).any() or (ahead > here + 1e-9).any():
                raise InputError(
                    f"bogie {b}: found it on another segment than segment {here}, on which the model "
                    "was derived; expected positions that stay there (derive the changed vehicle)"
                )

    def _symbol(self, name: str, b: int) -> sp.Symbol:
        """A bogie's parameter: one symbol for all bogies where they agree, else one for each."""
        symbol = BOGIE_SYMBOLS[name][0]
        agree = len({getattr(bogie, name) for bogie in self.vehicle.bogies}) == 1
        own = symbol + str(b) if symbol.endswith("_b") else f"{symbol}_b{b}"
        positive = {"positive": True} if "damping" not in name else {"nonnegative": True}
        return sp.Symbol(symbol if agree else own, **positive)

    def _place(self, b: int) -> sp.Expr:
        """Bogie b's position: ±l_b for a mirrored pair, else a symbol of its own."""
        return _mirrored([bogie.position for bogie in self.vehicle.bogies], "l_b", "x_b")[b - 1]

    def _lever(self, b: int, x: float) -> sp.Expr:
        """A wheelset's place on bogie b: ±l_w for a mirrored pair, else a symbol of its own."""
        layouts = {bogie.wheelsets for bogie in self.vehicle.bogies}
        own = "" if len(layouts) == 1 else f"_b{b}"
        wheelsets = self.vehicle.bogies[b - 1].wheelsets
        return _mirrored(wheelsets, f"l_w{own}", f"x_w{own}_")[wheelsets.index(x)]

    def _levers(self, b: int) -> list[tuple[int, sp.Expr]]:
        """The wheelsets of bogie b: number on the vehicle, and place on the bogie."""
        before = sum(len(bogie.wheelsets) for bogie in self.vehicle.bogies[: b - 1])
        wheelsets = self.vehicle.bogies[b - 1].wheelsets
        return [(before + j, self._lever(b, x)) for j, x in enumerate(wheelsets, start=1)]


def derive_vehicle(
    vehicle: Vehicle,
    segments: int | None = None,
    *,
    bending_frequency: float | None = None,
    joint_stiffness: float | None = None,
    bending_damping: float | None = None,
) -> VehicleModel:
    """The model of a vehicle whose car body is cut into ``segments`` rigid segments.

    Parameters
    ----------
    segments : N ≥ 1; 1 is the rigid body. Default: 4, or 1 where no bending stiffness is known.
    bending_frequency, joint_stiffness : Hz or N m/rad, instead of what the vehicle says.
    bending_damping : structural damping ratio of the first bending mode, instead of the vehicle's.

    Raises
    ------
    InputError : N that is not a whole number ≥ 1; both of the two stiffnesses; values out of range.
    """
    if bending_frequency is not None and joint_stiffness is not None:
        raise InputError("body: found both a bending frequency and a joint stiffness; expected one "
                         "of them (the other follows)")  # fmt: skip
    body = vehicle.body
    if bending_frequency is not None or joint_stiffness is not None:
        body = replace(body, bending_frequency=bending_frequency, joint_stiffness=joint_stiffness,
                       bending_stiffness=None)  # fmt: skip
    if bending_damping is not None:
        body = replace(body, bending_damping=bending_damping, joint_damping=None)
    known = (body.bending_frequency, body.joint_stiffness, body.bending_stiffness)
    if segments is None:
        segments = 4 if any(value is not None for value in known) else 1
    if isinstance(segments, bool) or int(segments) != segments or segments < 1:
        raise InputError(f"segments: found {segments}; expected a whole number of at least 1")
    vehicle, segments = replace(vehicle, body=body), int(segments)
    if segments > 1:
        return VehicleModel(vehicle, SegmentedBody(body, segments))
    given = {"bending frequency": bending_frequency, "joint stiffness": joint_stiffness,
             "bending damping": bending_damping}  # fmt: skip
    idle = [name for name, value in given.items() if value is not None]
    remark = f"the {' and the '.join(idle)} given change nothing: the body is rigid"
    return VehicleModel(vehicle, RigidBody(body), (remark,) if idle else ())


def bogie_heave(b: int) -> Coordinate:
    """Height of bogie b's mass centre."""
    return Coordinate(f"z_b{b}")


def bogie_pitch(b: int) -> Coordinate:
    """Pitch of bogie b."""
    return Coordinate(f"theta_b{b}")


def secondary_deflection(b: int) -> Coordinate:
    """Extension of the secondary suspension over bogie b."""
    return Coordinate(f"s_{b}")


def primary_deflection(j: int) -> Coordinate:
    """Extension of the primary suspension over wheelset j."""
    return Coordinate(f"p_{j}")


def wheelset_elevation(j: int) -> Input:
    """Track elevation under wheelset j."""
    return Input(f"w_{j}")


def actuator(b: int) -> Force:
    """Force of the actuator beside the secondary suspension over bogie b."""
    return Force(f"f_{b}")


def _mirrored(places: Sequence[float], mirrored: str, single: str) -> list[sp.Expr]:
    """Places as symbols: 0, ± one symbol for a mirrored pair, or one symbol each."""
    pairs = sorted({abs(x) for x in places if x and -x in places}, reverse=True)
    found: list[sp.Expr] = []
    for number, x in enumerate(places, start=1):
        if not x:
            found.append(sp.S.Zero)
        elif abs(x) in pairs:
            name = mirrored if len(pairs) == 1 else f"{mirrored}{pairs.index(abs(x)) + 1}"
            found.append(int(np.sign(x)) * sp.Symbol(name, positive=True))
        else:
            found.append(sp.Symbol(f"{single}{number}", real=True))
    return found
