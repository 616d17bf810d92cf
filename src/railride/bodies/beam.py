r"""The car body as a free-free uniform beam: Euler-Bernoulli's, or Timoshenko's.

The beam has the mass m_c/L and the bending stiffness EI on every metre, and I_c = m_c L²/12. With a
shear stiffness κGA or a rotary inertia ρI per length it is Timoshenko's, I_c = m_c L²/12 + ρI L. A
bending frequency instead of EI sets EI so that the first natural frequency of the free body is
that, whatever else changes.

Source: :mod:`~railride.bodies.slender_beam` and :mod:`~railride.bodies.shear_beam`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Self

import numpy as np
import sympy as sp
from sympy import pi, sqrt

from railride.bodies import slender_beam
from railride.bodies.base import Parameter
from railride.bodies.body_modes import BodyModes
from railride.bodies.cuts import L
from railride.bodies.joints import EI, f_bending
from railride.bodies.modal import ModalBody, along
from railride.bodies.rigid import m_c
from railride.bodies.structural_damping import mode_frequency
from railride.bodies.uniform_beam import UniformBeam
from railride.errors import Faults
from railride.numeric import Array
from railride.parameters import CarBody

shear, rotary = sp.symbols("kappa_GA rho_I", positive=True)  # κGA and ρI
MODES = 10  # unless the user says otherwise


class BeamBody(ModalBody):
    """A uniform free-free beam; :meth:`of` makes it."""

    @classmethod
    def of(cls, body: CarBody, count: int = MODES) -> Self:
        """A beam of the first ``count`` bending modes.

        Raises
        ------
        InputError : see :func:`beam_modes`.
        """
        return cls(body, beam_modes(body, count))

    @property
    def shears(self) -> bool:
        """Whether it is Timoshenko's beam."""
        return self.body.shear_stiffness is not None or bool(self.body.rotary_inertia)

    @property
    def inertia(self) -> sp.Expr:
        """m_c L²/12, and ρI L where there is rotary inertia."""
        return m_c * L**2 / 12 + (rotary * L if self.body.rotary_inertia else 0)

    @property
    def length(self) -> sp.Expr:
        """L: the modes follow it."""
        return L

    @property
    def own_parameters(self) -> tuple[Parameter, ...]:
        """m_c, L, and what bending, shear and rotary inertia are."""
        body = self.body
        given = (
            (m_c, "car-body mass", "kg", body.mass),
            (L, "car-body length", "m", body.length),
            (f_bending, "free-free first bending frequency", "Hz", body.bending_frequency),
            (EI, "bending stiffness", "N m^2", body.bending_stiffness),
            (shear, "shear stiffness", "N", body.shear_stiffness),
            (rotary, "rotary inertia per length", "kg m", body.rotary_inertia or None),
        )
        return tuple(Parameter(symbol, meaning, unit, value)
                     for symbol, meaning, unit, value in given if value is not None)  # fmt: skip

    @property
    def definitions(self) -> dict[sp.Symbol, sp.Expr]:
        """The damping ratios, and the slender beam's frequencies f_i = (β_i/β_1)² f_1."""
        defined: dict[sp.Symbol, sp.Expr] = {}
        if not self.shears:
            beta = slender_beam.roots(self.modes.count)
            first = sp.Float(beta[0] ** 2) / (2 * pi) * sqrt(EI / (m_c * L**3))
            given = self.body.bending_frequency is not None
            defined[mode_frequency(1)] = f_bending if given else first
            for i, ratio in zip(self.numbers[1:], (beta[1:] / beta[0]) ** 2, strict=True):
                defined[mode_frequency(i)] = sp.Float(ratio) * mode_frequency(1)
        return defined | super().definitions

    def check_values(self, values: Mapping[str, Array]) -> None:
        """Refuse a bending frequency that the shear stiffness does not allow."""
        if self.shears:
            _ = self._beam(values).stiffness

    def dependent_values(
        self, values: Mapping[str, Array], wanted: Iterable[sp.Symbol]
    ) -> dict[str, Array]:
        """As of every modal body, and the frequencies of Timoshenko's beam."""
        wanted = list(wanted)
        found = super().dependent_values(values, wanted)
        if mode_frequency(1) in wanted:
            hertz = self._beam(values).frequencies
            found |= {mode_frequency(i).name: hertz[..., i - 1] for i in self.numbers}
        return found

    def shapes_at(self, x: Array, values: Mapping[str, Array]) -> Array:
        """φ_i(x) of the beam as the values have it."""
        return self._beam(values).shapes(x)

    def shape_slopes_at(
        self, x: Array, dx: Array, values: Mapping[str, Array], slopes: Mapping[str, Array]
    ) -> Array | None:
        """Of the slender beam, whose shapes are functions of x/L; Timoshenko's have no formula."""
        if self.shears:
            return None
        stretched = np.multiply.outer(slopes[L.name], x / values[L.name])
        return along(self._beam(values).slopes(x), dx - stretched)

    def _beam(self, values: Mapping[str, Array]) -> UniformBeam:
        others = (values.get(symbol.name) for symbol in (f_bending, EI, shear, rotary))
        return UniformBeam(self.modes.count, values[m_c.name], values[L.name], *others)


def beam_modes(body: CarBody, count: int = MODES) -> BodyModes:
    """The first ``count`` natural modes of a car body as a uniform free-free beam.

    Parameters
    ----------
    body : with a bending frequency or EI; one with a shear stiffness or a rotary inertia is
        Timoshenko's beam.

    Raises
    ------
    InputError : a body whose bending is not known, or that is not uniform; a frequency that its
        shear stiffness does not allow.

    Examples
    --------
    >>> coach = CarBody(34e3, 1.632e6, 24.0, bending_frequency=9.6)
    >>> beam_modes(coach, 3).frequencies.round(2).tolist()
    [9.6, 26.46, 51.88]
    """
    refuse_other_bodies(body)
    beam = UniformBeam(count, body.mass, body.length, body.bending_frequency,
                       body.bending_stiffness, body.shear_stiffness,
                       body.rotary_inertia or None)  # fmt: skip
    inertia = body.mass * body.length**2 / 12 + body.rotary_inertia * body.length
    return BodyModes(body.mass, 0.0, inertia, body.length, beam.frequencies, None, beam.shapes,
                     "beam", beam.slopes, remarks=inertia_remarks(body, inertia))  # fmt: skip


def inertia_remarks(body: CarBody, own: float) -> tuple[str, ...]:
    """That a uniform beam of pitch inertia ``own`` (kg m²) has not the one that was given."""
    given = body.pitch_inertia
    if abs(own - given) <= 1e-3 * given:
        return ()
    remark = (
        f"the car body's pitch inertia of {given:.4g} kg m^2 is not used: a uniform beam has "
        f"{own:.4g} kg m^2"
    )
    return (remark,)


def refuse_other_bodies(body: CarBody, kind: str = "beam") -> None:
    """Refuse what a beam cannot be made of; one of finite elements ("fe") may have a profile."""
    faults = Faults(f"body {kind}")
    shaped = kind == "fe" and body.profile is not None
    if not shaped and body.bending_frequency is None and body.bending_stiffness is None:
        others = {name: getattr(body, name) for name in ("joint_stiffness", "bending_frequencies")}
        found = [f"a {name} of {_listed(value)}" for name, value in others.items() if value]
        faults.add("body", " and ".join(found) or "nothing of its bending", "a bending frequency "
                   "or a bending stiffness EI", "joint stiffnesses and several frequencies belong "
                   "to segments")  # fmt: skip
    if body.joint_damping is not None:
        faults.add("body.joint_damping", f"{_listed(body.joint_damping)} N m s/rad", "a damping "
                   "ratio of the first bending mode", "a joint's damping belongs to "
                   "segments")  # fmt: skip
    if body.segments:
        other = "a uniform beam or a profile" if kind == "fe" else "a uniform beam"
        faults.add("segments", "rigid segments", other, "take segments")
    if body.profile is not None and not shaped:
        faults.add("body.profile", "data along the body", "none: the beam is uniform",
                   "take segments or fe")  # fmt: skip
    if body.mass_centre and not shaped:
        faults.add("body.mass_centre", f"{body.mass_centre:g} m", "it at the middle of a uniform "
                   "beam", "take segments, or fe with a profile")  # fmt: skip
    for name in ("shear_stiffness", "rotary_inertia"):
        if shaped and getattr(body, name):
            faults.add(f"body.{name}", f"{getattr(body, name):g} beside a profile", f"{name} in "
                       "the profile, along the body")  # fmt: skip
    faults.raise_if_any()


def _listed(values: float | tuple[float, ...]) -> str:
    return ", ".join(f"{value:g}" for value in np.ravel(values))
