r"""What runs inside an FMU: a copy of this file, with numpy and PythonFMU alone.

In a communication step from t to t + h the elevations go on from what was set at t at the rates
that were set, w(t + τ) = w + ẇ τ, and the forces stay. The states follow exactly,

.. math:: \begin{bmatrix} x(t+h) \\ w + \dot w h \\ \dot w \\ f \end{bmatrix} = \exp \left( h
          \begin{bmatrix} A & B_w & B_{\dot w} & B_f \\ 0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 0 \\
          0 & 0 & 0 & 0 \end{bmatrix} \right) \begin{bmatrix} x \\ w \\ \dot w \\ f \end{bmatrix} .

Where the elevations that are set next are others than these foresaw, the dampers have felt the
difference: x moves on by B_ẇ Δw, the integral of B_ẇ ẇ over it. Smooth elevations so leave an error
of second order in h, however their rates went within the step.

Source: C.F. Van Loan, Computing integrals involving the matrix exponential, IEEE Transactions on
Automatic Control 23 (1978) 395-404.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import ceil, log2
from typing import Any, ClassVar
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from numpy.typing import NDArray
from pythonfmu import DefaultExperiment, Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

Array = NDArray[np.float64]


class Quantity(Real):
    """A real variable with a unit."""

    def __init__(self, name: str, unit: str, **given: Any) -> None:
        super().__init__(name, **given)
        self.unit = unit

    def to_xml(self) -> Element:
        """The variable, and its unit."""
        found: Element = super().to_xml()
        if self.unit:
            found[0].set("unit", self.unit)
        return found


class VehicleSlave(Fmi2Slave):
    """A vehicle by its exported Python source, at rest at equilibrium when it starts.

    model : that module. said : name of a variable → unit, meaning. units : unit → its exponents of
    kg, m, s and rad.
    """

    model: ClassVar[Any]
    said: ClassVar[dict[str, tuple[str, str]]]
    units: ClassVar[dict[str, dict[str, int]]]
    default_experiment = DefaultExperiment(start_time=0.0, stop_time=10.0, step_size=0.001)

    def __init__(self, **given: Any) -> None:
        super().__init__(**given)
        self.parameters = dict(self.model.PARAMETERS)
        self.u = np.zeros(len(self.model.INPUTS))  # as set
        self.x = np.zeros(len(self.model.STATES))
        self.foreseen: Array | None = None  # the elevations to which x belongs, after a step
        self.ahead = 0.0  # s since the inputs were set
        self._plant: tuple[Array, ...] | None = None
        self._steps: dict[float, Array] = {}
        self._register()

    def _register(self) -> None:
        """All variables, by the names that they have in railride."""
        kind, tunable = Fmi2Causality, Fmi2Variability.tunable
        for name in self.model.PARAMETERS:
            get, put = partial(self.parameters.get, name), partial(self._set_parameter, name)
            self._add(name, kind.parameter, get, put, variability=tunable)
        for k, name in enumerate(self.model.INPUTS):
            self._add(name, kind.input, partial(self.u.item, k), partial(self._set_input, k))
        for k, name in enumerate(self.model.OUTPUTS):
            self._add(name, kind.output, partial(self._output, k))
        for k, name in enumerate(self.model.STATES):
            self._add(name, kind.local, partial(self._state, k))

    def _add(self, name: str, causality: Fmi2Causality, get: Callable[[], Any],
             put: Callable[[float], None] | None = None, **more: Any) -> None:  # fmt: skip
        unit, meaning = self.said[name]
        self.register_variable(Quantity(name, unit, causality=causality, getter=get, setter=put,
                                        description=meaning or None, **more))  # fmt: skip

    @property
    def plant(self) -> tuple[Array, ...]:
        """A, B, C and D at the parameters."""
        if self._plant is None:
            self._plant = self._formed()
        return self._plant

    def _formed(self) -> tuple[Array, ...]:
        """A, B, C and D; ValueError, which the tool's log shows, where there are none."""
        try:
            with np.errstate(all="ignore"):
                found: tuple[Array, ...] = self.model.state_space(**self.parameters)
            if all(np.isfinite(A).all() for A in found):
                return found
            reason = "values that are not finite"
        except (ArithmeticError, ValueError) as error:
            reason = str(error)
        own = self.model.PARAMETERS
        changed = (f"{k} = {v!r}" for k, v in self.parameters.items() if v != own.get(k))
        raise ValueError(f"parameters: found {', '.join(changed)}, of which no equations can be "
                         f"formed ({reason}); expected finite numbers, and masses, inertias and "
                         "lengths above 0") from None  # fmt: skip

    @property
    def rates(self) -> slice:
        """The places of ẇ in u, those of w before them."""
        return slice(len(self.model.ELEVATIONS), 2 * len(self.model.ELEVATIONS))

    @property
    def now(self) -> tuple[Array, Array]:
        """The states and the inputs, gone on since they were set."""
        w, dw = self.u[: self.rates.start], self.u[self.rates]
        u = self.u + 0.0
        u[: self.rates.start] = w + self.ahead * dw
        if self.foreseen is None:
            return self.x, u
        felt = self.plant[1][:, self.rates] @ (u[: self.rates.start] - self.foreseen)
        return self.x + felt, u

    def do_step(self, current_time: float, step_size: float) -> bool:
        """Go on by a step (s) from the inputs as they were set last."""
        del current_time
        self.ahead = 0.0
        x, u = self.now
        h = float(f"{step_size:.10g}")  # steps that differ by rounding alone are one
        if h not in self._steps:
            self._steps = {h: self._step(h)}
        self.x = self._steps[h] @ np.concatenate([x, u])
        self.ahead = step_size
        self.foreseen = u[: self.rates.start] + step_size * u[self.rates]
        return True

    def _step(self, h: float) -> Array:
        """The rows for x of the exponential, (s, s + inputs)."""
        A, B, *_ = self.plant
        s = len(A)
        generator = np.zeros((s + B.shape[1],) * 2)
        generator[:s] = np.hstack([A, B])
        k = self.rates.start
        generator[s : s + k, s + k : s + 2 * k] = np.eye(k)
        return exponential(h * generator)[:s]

    def _output(self, k: int) -> float:
        _, _, C, D = self.plant
        x, u = self.now
        return float(C[k] @ x + D[k] @ u)

    def _state(self, k: int) -> float:
        return float(self.now[0][k])

    def _set_input(self, k: int, value: float) -> None:
        self.u[k] = value
        self.ahead = 0.0

    def _set_parameter(self, name: str, value: float) -> None:
        self.parameters[name] = value
        self._plant, self._steps = None, {}

    def _get_fmu_state(self) -> dict[str, Any]:
        foreseen = None if self.foreseen is None else self.foreseen.tolist()
        return {"parameters": dict(self.parameters), "u": self.u.tolist(), "x": self.x.tolist(),
                "foreseen": foreseen, "ahead": self.ahead}  # fmt: skip

    def _set_fmu_state(self, state: dict[str, Any]) -> None:
        for name, value in state["parameters"].items():
            self._set_parameter(name, value)
        self.u[:], self.x, self.ahead = state["u"], np.array(state["x"]), state["ahead"]
        self.foreseen = None if state["foreseen"] is None else np.array(state["foreseen"])

    def to_xml(self, model_options: dict[str, str] | None = None) -> Element:
        """The model description, with the units' definitions and what is known at the start."""
        root: Element = super().to_xml(model_options or {})
        definitions = Element("UnitDefinitions")
        for unit, exponents in self.units.items():
            one = SubElement(definitions, "Unit", name=unit)
            SubElement(one, "BaseUnit", {base: str(power) for base, power in exponents.items()})
        root.insert(1, definitions)  # after CoSimulation
        structure = root[-1]
        SubElement(structure, "InitialUnknowns").extend(structure[0])  # the outputs
        return root


def keep(names: dict[str, Any], kept: list[dict[str, Any]] = []) -> None:  # noqa: B006
    """Hold a reference to the names of a module for ever."""
    kept.append(names)


def exponential(A: Array) -> Array:
    """exp(A) by its series, halved until that converges fast and squared again.

    Source: C. Moler, C. Van Loan, SIAM Review 45 (2003) 3-49, Method 3.
    """
    halvings = max(0, ceil(log2(max(float(np.linalg.norm(A, 1)), 1e-300))) + 1)
    part = A / 2.0**halvings
    term = total = np.eye(len(A))
    for k in range(1, 18):  # (1/2)^18/18! is below the rounding
        term = term @ part / k
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return np.asarray(total)
