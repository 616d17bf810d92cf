r"""A controller closed round the vehicle.

.. math:: \dot x = A x + B_w w + B_{dw} \dot w + B_f f, \quad y = C x + D_w w + \dots, \quad
          f = \mathcal K(s)\, y

Source: K.J. Åström, R.M. Murray, Feedback Systems, 2nd ed., Princeton 2021, Section 12.1 (what has
to be stable); the loop is closed by python-control on the names of the signals.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from railride.active.signals import suspension_signals
from railride.errors import Faults, InputError
from railride.firstorder import first_order
from railride.frequency import Triangular
from railride.modal import UNSTABLE, free_motions
from railride.statespace import chosen_outputs, state_space
from railride.vehicle import Output, VehicleModel

if TYPE_CHECKING:
    import control

Complex = NDArray[np.complexfloating[Any, Any]]


@dataclass(frozen=True, eq=False)
class Loop:
    """A vehicle with a controller between its outputs and its actuators, known to be stable.

    Parameters
    ----------
    name : of the design, for messages and tables.
    controller : from the outputs ``measured``, by their names, to the actuators f_1, f_2 …; None
        for actuators that rest.
    measured : what the controller is given.
    changes : parameter values in place of the vehicle's.
    remarks : what the user should know of the design.

    Raises
    ------
    InputError : signals that the vehicle does not have; a controller in discrete time, or that
        feels its own force at once; a loop in which a motion grows.
    """

    name: str
    model: VehicleModel
    controller: control.StateSpace | None = None
    measured: tuple[Output, ...] = ()
    changes: Mapping[str, Any] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self._check_signals()
        growing = self.poles.real > UNSTABLE * np.abs(self.poles).max()
        if growing.any():
            raise InputError(self._instability(int(np.argmax(self.poles.real))))

    @cached_property
    def system(self) -> control.StateSpace:
        """The loop from w and ẇ to the floor's acceleration, suspension travel and forces."""
        bogies = self.model.running_gear.bogies
        return self.closed([self.model.floor(), *(f"secondary_{b}_deflection" for b in bogies)])

    @cached_property
    def poles(self) -> Complex:
        """Eigenvalues of the loop, rad/s, shape (states,)."""
        return np.linalg.eigvals(self.system.A).astype(complex)

    @property
    def decay(self) -> float:
        """The slowest decay of all motions, min(-Re λ), 1/s: the distance to instability."""
        return float(np.min(-self.poles.real))

    @property
    def least_damping_ratio(self) -> float:
        """The smallest -Re λ/|λ| of all motions."""
        return float(np.min(-self.poles.real / np.abs(self.poles)))

    @cached_property
    def modulus_margin(self) -> float:
        r"""The least singular value of I - K(iω) P(iω) over ω, P from the actuators to K's inputs.

        The distance of the loop's gain from instability, 1 without control: what the actuators give
        may change by any factor from 1/(1 + m) to 1/(1 - m), all alike, before the loop is
        unstable. Below 0.5 a design leans on a model that is better than most. Taken at 2,000
        frequencies from 0.01 to 1000 Hz and at many more beside each pole.

        Source: S. Skogestad, I. Postlethwaite, Multivariable Feedback Control, 2nd ed., Wiley 2005,
        Eq 2.47.
        """
        if self.controller is None:
            return 1.0
        plant = state_space(self.model, self.measured, **self.changes)
        n = len(self.model.linear.forces)
        beside = self.poles.imag + np.linspace(-5, 5, 41)[:, np.newaxis] * np.abs(self.poles.real)
        omega = np.concatenate([2 * np.pi * np.geomspace(0.01, 1000, 2000), np.abs(beside.ravel())])
        s = 1j * omega[omega > 0]
        y = [self.controller.input_labels.index(output.name) for output in self.measured]
        f = [self.controller.output_labels.index(x.name) for x in self.model.linear.forces]
        loop_gain = np.empty((s.size, n, n), dtype=complex)
        for k, force in enumerate(np.eye(n)):
            u = np.concatenate([np.zeros(plant.ninputs - n), force])
            heard = np.empty((len(y), s.size), dtype=complex)
            heard[y] = respond(plant, s, np.repeat(u[:, np.newaxis], s.size, axis=1))
            loop_gain[:, :, k] = respond(self.controller, s, heard)[f].T
        return float(np.linalg.svd(np.eye(n) - loop_gain, compute_uv=False).min())

    def on(self, model: VehicleModel) -> Loop:
        """The same controller on another model of the vehicle, such as one of more segments.

        A controller knows the model it was designed on; what that model leaves out, or has at the
        wrong frequency, can be driven unstable (spillover). This is how one finds out.

        Raises
        ------
        InputError : a loop that is unstable on that model; other bogies.
        """
        if len(model.vehicle.bogies) != len(self.model.vehicle.bogies):
            raise InputError(
                f"loop {self.name}: found a vehicle of {len(model.vehicle.bogies)} bogies; "
                f"expected {len(self.model.vehicle.bogies)}, as the controller has"
            )
        signals = self._known(model)
        measured = tuple(signals.get(output.name, output) for output in self.measured)
        return replace(self, model=model, measured=measured)

    def closed(
        self, outputs: Output | str | Sequence[Output | str] | None = None
    ) -> control.StateSpace:
        """The loop from w_1 …, dw_1 … to the outputs asked for and, after them, the forces f_b.

        The passive vehicle has no forces.

        Parameters
        ----------
        outputs : as for :func:`railride.statespace.state_space`, or names of
            :func:`railride.active.suspension_signals`.

        Raises
        ------
        InputError : an output that does not exist or needs the second rate of the track.
        """
        import control

        known = suspension_signals(self.model)
        if isinstance(outputs, Output | str):
            outputs = [outputs]
        asked = None if outputs is None else [
            known.get(o, o) if isinstance(o, str) else o for o in outputs
        ]  # fmt: skip
        wanted = {output.name: output for output in chosen_outputs(self.model, asked)}
        every = wanted | {output.name: output for output in self.measured}
        plant = state_space(self.model, list(every.values()), **self.changes)
        track = plant.input_labels[: 2 * len(self.model.linear.inputs)]
        if self.controller is None:
            n = len(track)
            return control.ss(plant.A, plant.B[:, :n], plant.C, plant.D[:, :n], inputs=track,
                              states=plant.state_labels, outputs=plant.output_labels,
                              name="loop")  # fmt: skip
        plant = plant.copy(name="vehicle", use_prefix_suffix=False)
        controller = self.controller.copy(name="controller", use_prefix_suffix=False)
        forces = plant.input_labels[len(track) :]
        try:
            return control.interconnect([plant, controller], inputs=track, check_unused=False,
                                        outputs=[*wanted, *forces], name="loop")  # fmt: skip
        except RuntimeError:
            raise InputError(
                f"loop {self.name}: found a controller that feels its own force at once; expected "
                "a lag between an acceleration and the force (give it an actuator's bandwidth)"
            ) from None

    @staticmethod
    def _known(model: VehicleModel) -> dict[str, Output]:
        """Outputs of a model by name."""
        return {**model.outputs, **suspension_signals(model)}

    def _check_signals(self) -> None:
        if self.controller is None:
            return
        faults = Faults(f"loop {self.name}")
        forces = [force.name for force in self.model.linear.forces]
        for what, found, expected in (
            ("inputs", self.controller.input_labels, [output.name for output in self.measured]),
            ("outputs", self.controller.output_labels, forces),
        ):
            if sorted(found) != sorted(expected):
                faults.add(f"controller's {what}", ", ".join(found), ", ".join(expected) or "none",
                           "name them as the vehicle's signals")  # fmt: skip
        known = self._known(self.model)
        for output in self.measured:
            if output.expression != known.get(output.name, output).expression:
                faults.add(output.name, "this signal of another model",
                           "that of the loop's own", "use loop.on(model)")  # fmt: skip
        if self.controller.dt not in (None, 0):
            faults.add("controller", f"a sampled one, dt = {self.controller.dt}",
                       "one in continuous time", "control.d2c")  # fmt: skip
        faults.raise_if_any()

    def _instability(self, worst: int) -> str:
        """What grows, how fast, and what helps."""
        roots, vectors = np.linalg.eig(self.system.A)
        root = roots[np.argmax(roots.real)] if self.controller is None else self.poles[worst]
        vector = vectors[:, np.argmin(np.abs(roots - root))]
        matrices = self.model.matrices(**self.changes)
        x = first_order(matrices)
        q = x.q_x @ vector[: x.q_x.shape[1]]
        labels, motions = free_motions(self.model, matrices)
        own = np.einsum("ik,ij,jk->k", motions, matrices.M, motions)
        mode = labels[int(np.argmax(np.abs(motions.T @ matrices.M @ q) ** 2 / own))]
        return (
            f"loop {self.name}: found that it is unstable: {mode} at {abs(root) / (2 * np.pi):.3g} "
            f"Hz grows with {root.real:.3g} 1/s; expected every motion to decay (a lower gain, the "
            "gain's sign, an actuator of more bandwidth or lower order, or structural damping of "
            "the body)"
        )


def respond(system: control.StateSpace, s: Complex, u: Complex) -> Complex:
    """y = (C (s - A)⁻¹ B + D) u at every s: (outputs, F) from (F,) and (inputs, F).

    ``u`` belongs to the first inputs of ``system``; the others rest.
    """
    form, k = triangular_form(system), len(u)
    y = np.asarray(form.right[:, :k] @ u, dtype=complex)
    states = form.states(np.asarray(s, dtype=complex), y)
    return np.asarray(form.left @ states + system.D[:, :k] @ u)


def triangular_form(system: control.StateSpace) -> Triangular:
    """C (s - A)⁻¹ B = left (s - T)⁻¹ right with T upper triangular, of the balanced system."""
    from scipy.linalg import matrix_balance, schur

    if system.nstates == 0:
        return Triangular(*(np.asarray(part, dtype=complex) for part in
                            (system.A, system.C, system.B)))  # fmt: skip
    A, (scale, _) = matrix_balance(system.A, permute=False, separate=True)
    T, Q = schur(A, output="complex")
    right = Q.conj().T @ (system.B / scale[:, np.newaxis])
    return Triangular(T, (system.C * scale) @ Q, right)
