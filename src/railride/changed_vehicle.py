"""A vehicle with changed parameters: from a model's symbols back to the records they came from.

A study changes symbols, k_2 or f_bending; a parameter file holds the fields of a car body, of
bogies, payload and equipment. What is written back gives the same matrices when it is derived again
with the same kind of body. What has no field, such as a natural frequency of finite elements, is
refused.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import sympy as sp

from railride.bodies.masses import OwnMasses, method
from railride.bodies.modal import ModalBody
from railride.bodies.segments import SegmentedBody
from railride.bodies.structural_damping import mode_damping
from railride.body_checks import rigid_values
from railride.errors import Faults, InputError
from railride.parameters import Bogie, CarBody, Equipment, Load, Segment, Vehicle
from railride.running_gear import OPTIONAL, SYMBOLS
from railride.vehicle import VehicleModel

BODY_FIELDS = {
    "m_c": "mass",
    "I_c": "pitch_inertia",
    "e_c": "mass_centre",
    "L": "length",
    "f_bending": "bending_frequency",
    "EI": "bending_stiffness",
    "kappa_GA": "shear_stiffness",
    "rho_I": "rotary_inertia",
    "zeta_bending": "bending_damping",
    "alpha_R": "rayleigh_mass",
    "beta_R": "rayleigh_stiffness",
}
RIGID_FIELDS = ("m_c", "I_c", "e_c", "L")
NO_STIFFNESS = dict.fromkeys(("bending_frequency", "bending_frequencies", "bending_stiffness"))
NO_DAMPING = {"joint_damping": None, "bending_damping": 0.0, "rayleigh_mass": 0.0,
              "rayleigh_stiffness": 0.0, "mode_damping": None}  # fmt: skip


def vehicle_with(model: VehicleModel, **changes: float) -> Vehicle:
    """The model's vehicle with changed parameters, ready for a parameter file.

    Deriving it with the same kind of body and as many segments or modes gives the matrices of
    ``model.matrices(**changes)``. A model that was changed before keeps its changes. A joint
    stiffness that is given takes the place of the bending frequency that it followed from.

    Parameters
    ----------
    model : whose vehicle it is.
    changes : values, SI, by symbol or by key of parameter files, as :meth:`VehicleModel.values`
        takes them.

    Raises
    ------
    InputError : a name that the model does not have; a value that cannot be; with all of them at
        once, parameters that no parameter file holds, such as a natural frequency of finite
        elements or the mass of a piece of a profile.

    Examples
    --------
    >>> from railride.vehicle import derive_vehicle
    >>> model = derive_vehicle("cati2024", segments=2)
    >>> soft = vehicle_with(model, secondary_stiffness=6e5)
    >>> [bogie.secondary_stiffness for bogie in soft.bogies]
    [600000.0, 600000.0]
    """
    _refuse_arrays(changes)
    changed = model.changed(**changes)
    changed.matrices()  # refuses what no vehicle can be
    own = {p.symbol.name: p.value for p in changed.parameters}
    new = {name: float(value) for name, value in changed.overrides.items()
           if float(value) != own.get(name)}  # fmt: skip
    writer = _Writer(changed, new)
    vehicle = replace(
        changed.vehicle,
        body=writer.body(),
        bogies=tuple(writer.bogie(b) for b in changed.running_gear.bogies),
        payload=writer.payload(),
        equipment=tuple(writer.equipment(e) for e in changed.carried.equipment),
    )
    writer.refuse_left()
    return vehicle


class _Writer:
    """Writes new values back, and remembers which of them have found a field.

    changed : the model with the new values. new : those that are not the vehicle's own, by symbol.
    """

    def __init__(self, changed: VehicleModel, new: Mapping[str, float]) -> None:
        self.model, self.new = changed, new
        self.values = {name: float(value) for name, value in changed.values().items()}
        self.left = dict(new)

    def refuse_left(self) -> None:
        """Refuse values that no field holds."""
        faults = Faults(f"vehicle {self.model.vehicle.name!r}")
        for name, value in self.left.items():
            meaning, unit = self.model.meanings.get(name, ("", ""))
            said = f" ({meaning})" if meaning else ""
            faults.add(f"{name}{said}", f"a change to {value:g} {unit}".rstrip(),
                       "a parameter that parameter files hold", self._instead(name))  # fmt: skip
        faults.raise_if_any()

    def _instead(self, name: str) -> str:
        """What to change in place of a parameter without a field."""
        body = self.model.vehicle.body
        if isinstance(self.model.body, ModalBody) and self.model.body.kind != "beam":
            return "it follows from the finite elements: change what they are made of"
        if name in RIGID_FIELDS or name.startswith(("m_", "J_", "e_", "ell_")):
            made = "profile" if body.profile is not None else "segments"
            return (
                f"it follows from the {made}: change that" if body.profile or body.segments else ""
            )
        return "it follows from others: change those"

    def _takes(self, symbols: Iterable[str]) -> bool:
        """Whether any of the symbols is new; they count as written."""
        found = [name for name in symbols if name in self.new]
        for name in found:
            self.left.pop(name, None)
        return bool(found)

    def _fields(self, symbols: Mapping[str, str]) -> dict[str, float]:
        """Field → value, of the fields (symbol → field) that are new."""
        return {field: self.values[name] for name, field in symbols.items() if self._takes([name])}

    def _place(self, x: sp.Expr, own: float) -> float:
        """A place that may be a symbol, its negative, or a number."""
        if not self._takes(symbol.name for symbol in x.free_symbols):
            return own
        factor, symbol = x.as_coeff_Mul()
        return float(factor) * self.values[symbol.name]

    def bogie(self, b: int) -> Bogie:
        """Bogie b."""
        gear, own = self.model.running_gear, self.model.vehicle.bogies[b - 1]
        symbols = {gear.symbol(name, b).name: name for name in (SYMBOLS | OPTIONAL)
                   if getattr(own, name) is not None}  # fmt: skip
        place = gear.place(b)
        wheelsets = tuple(
            self._place(lever, x)
            for (_, lever), x in zip(gear.levers(b), own.wheelsets, strict=True)
        )
        return replace(own, position=self._place(place.x, place.at), wheelsets=wheelsets,
                       **self._fields(symbols))  # fmt: skip

    def payload(self) -> tuple[Load, ...]:
        """The loads."""
        symbols, loads = self.model.carried.load_symbols, self.model.vehicle.payload
        return tuple(replace(load, **self._fields({symbol.name: "mass"}))
                     for symbol, load in zip(symbols, loads, strict=True))  # fmt: skip

    def equipment(self, e: int) -> Equipment:
        """Equipment e; a stiffness takes the place of a frequency, a damping that of a ratio."""
        own = self.model.vehicle.equipment[e - 1]
        found: dict[str, Any] = self._fields({
            f"m_e{e}": "mass", f"x_e{e}": "position", f"k_e{e}": "stiffness",
            f"f_e{e}": "frequency", f"c_e{e}": "damping", f"zeta_e{e}": "damping_ratio",
        })  # fmt: skip
        if "stiffness" in found:
            found["frequency"] = None
        if "damping" in found:
            found["damping_ratio"] = 0.0
        return replace(own, **found)

    def body(self) -> CarBody:
        """The car body."""
        body, model = self.model.vehicle.body, self.model.body
        found: dict[str, Any] = self._fields({
            name: field for name, field in BODY_FIELDS.items() if self._holds(name)
        })  # fmt: skip
        found |= self._frequencies(body)
        if isinstance(model, SegmentedBody):
            found |= self._segments(model) | self._joints(model)
        elif isinstance(model, ModalBody):
            found |= self._mode_damping(model)
        if not found:
            return body
        written = replace(body, **found)
        if isinstance(model, SegmentedBody):
            kind = model.masses.kind
            if kind != "own" and method(written) != kind:  # "auto" would choose another
                written = replace(written, inertia=kind)
        return written

    def _holds(self, name: str) -> bool:
        """Whether the field of a body's parameter alone makes the same body."""
        body, model = self.model.vehicle.body, self.model.body
        if name not in RIGID_FIELDS:
            return True
        if body.profile is not None or body.segments:
            return False
        if isinstance(model, ModalBody) and model.kind != "beam":
            # As a uniform beam that is calibrated, whose frequencies stay.
            shears = body.shear_stiffness is not None or body.rotary_inertia
            return model.kind == "fe" and body.bending_frequency is not None and not shears
        return True

    def _frequencies(self, body: CarBody) -> dict[str, Any]:
        given = body.bending_frequencies or ()
        names = [f"f_bending_{i}" for i in range(1, len(given) + 1)]
        if not self._takes(names):
            return {}
        return {"bending_frequencies": tuple(self.values[name] for name in names)}

    def _segments(self, model: SegmentedBody) -> dict[str, Any]:
        """The car body's own segments, and what they make up."""
        own, masses = model.body.segments, model.masses
        if not (own and isinstance(masses, OwnMasses)):
            return {}
        made = []
        for i, segment in enumerate(own, start=1):
            names = {f"m_{i}": "mass", f"J_{i}": "pitch_inertia", f"e_{i}": "mass_centre"}
            found = self._fields(names)
            if found:  # a rod's inertia would follow its mass, which that of the model does not
                found["pitch_inertia"] = self.values[f"J_{i}"]
            made.append(replace(segment, **found))
        if made == list(own):
            return {}
        row: tuple[Segment, ...] = tuple(made)
        return {"segments": row} | rigid_values({"segments": row})

    def _joints(self, model: SegmentedBody) -> dict[str, Any]:
        """Stiffness and damping of the joints where they are given for themselves."""
        joints, found = model.joints, dict[str, Any]()
        body = model.body
        if self._takes(k.name for k in joints.stiffness):
            found |= NO_STIFFNESS
            found["joint_stiffness"] = self._each(joints.stiffness, body.joint_stiffness)
        if self._takes(c.name for c in joints.damping):
            found |= NO_DAMPING
            found["joint_damping"] = self._each(joints.damping, body.joint_damping)
        return found

    def _each(
        self, symbols: tuple[sp.Symbol, ...], own: float | tuple[float, ...] | None
    ) -> float | tuple[float, ...]:
        """One value where one symbol stands for all joints, else one for each."""
        values = tuple(self.values[symbol.name] for symbol in symbols)
        return values if isinstance(own, tuple) or len(set(symbols)) > 1 else values[0]

    def _mode_damping(self, model: ModalBody) -> dict[str, Any]:
        """The damping ratios of the modes where they are given one by one."""
        names = [mode_damping(i).name for i in model.numbers]
        if model.modes.damping is not None or not self._takes(names):
            return {}
        given = model.body.mode_damping or ()
        own = tuple(self.values[name] for name in names)
        return NO_DAMPING | {"mode_damping": own + given[len(own) :]}


def _refuse_arrays(changes: Mapping[str, Any]) -> None:
    """Refuse more than one value of a parameter: one vehicle has one."""
    for name, value in changes.items():
        if np.ndim(value):
            raise InputError(f"parameters: found {value!r} for {name}; expected one number, in SI "
                             "units")  # fmt: skip
