r"""Lagrange's equations of the second kind, from energies to equations of motion.

For coordinates q, prescribed inputs w(t) and forces f(t)

.. math:: \frac{d}{dt}\frac{\partial T}{\partial\dot q_i} - \frac{\partial T}{\partial q_i}
          + \frac{\partial V}{\partial q_i} + \frac{\partial D}{\partial\dot q_i} = Q_i ,
          \qquad Q_i = \sum_k F_k \cdot \frac{\partial r_k}{\partial q_i}

with the kinetic energy T(q, q̇, w, ẇ), the potential energy V(q, w), Rayleigh's dissipation function
D(q, q̇, w, ẇ) and further forces F_k that do the virtual work F_k · δr_k. Nothing here knows of a
vehicle. Any number of dimensions is a matter of which coordinates there are.

Source: H. Goldstein, Classical Mechanics, 2nd ed., Sections 1-4 and 1-5 (Eqs 1-53, 1-57 and 1-70).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

import sympy as sp

from railride.errors import Faults

DOT = "_dot"


class Signal(sp.Symbol):
    r"""A scalar that varies with time; its rates are symbols of their own.

    >>> z = Signal("z_b1")
    >>> z.dot, z.ddot, sp.latex(z.ddot)
    (z_b1_dot, z_b1_dot_dot, '\\ddot{z}_{b1}')
    """

    def __new__(cls, name: str) -> Self:  # noqa: D102 - the class says it
        made: Self = super().__new__(cls, name, real=True)
        return made

    @classmethod
    def class_key(cls) -> Any:
        """Sort among the symbols, so that k z is printed as k z and not as z k."""
        return sp.Symbol.class_key()

    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]:
        return (self.name,), {}

    @property
    def dot(self) -> Self:
        """The rate, d/dt of this signal."""
        return type(self)(self.name + DOT)

    @property
    def ddot(self) -> Self:
        """The second rate, d²/dt² of this signal."""
        return self.dot.dot

    @property
    def order(self) -> int:
        """How many times the signal is differentiated: 0 for q, 1 for q.dot."""
        return str(self.name).count(DOT)

    @property
    def base(self) -> Self:
        """The signal of which this is a rate: itself for order 0."""
        return type(self)(self.name.replace(DOT, ""))

    def _latex(self, printer: Any) -> str:
        if not self.order:
            return str(printer.doprint(sp.Symbol(self.name)))
        head, _, index = str(self.base.name).partition("_")
        dotted = rf"\{'d' * self.order}ot{{{printer.doprint(sp.Symbol(head))}}}"
        return f"{dotted}_{{{index.replace('_', ' ')}}}" if index else dotted


class Coordinate(Signal):
    """A generalised coordinate q(t), or a named function of coordinates (see ``kinematics``)."""


class Input(Signal):
    """A prescribed motion w(t), such as the track elevation under a wheelset."""


class Force(Signal):
    """A prescribed force f(t), such as an actuator's."""


def signals(expression: sp.Expr) -> list[Signal]:
    """The signals in an expression, in a fixed order (by name)."""
    found = (s for s in expression.free_symbols if isinstance(s, Signal))
    return sorted(found, key=lambda s: s.name)


def rate(expression: sp.Expr) -> sp.Expr:
    r"""The time derivative, :math:`\dot u = \sum_s \frac{\partial u}{\partial s}\dot s`.

    Parameters
    ----------
    expression : an expression or a matrix (a position vector) in signals and parameters.

    >>> theta = Coordinate("theta")
    >>> rate(sp.sin(theta))
    theta_dot*cos(theta)
    """
    if isinstance(expression, sp.MatrixBase):
        return expression.applyfunc(rate)
    expression = sp.sympify(expression)
    return sp.Add(*(expression.diff(s) * s.dot for s in signals(expression)))


@dataclass(frozen=True)
class Lagrangian:
    r"""A mechanical system by its energies.

    Parameters
    ----------
    coordinates : the generalised coordinates q, in the order of the rows of every matrix.
    kinetic, potential, dissipation : T, V and D as expressions.
    inputs : prescribed motions w, in the order of the columns of K_w and C_w.
    forces : prescribed forces f, in the order of the columns of B_f.
    virtual_work : pairs (F, r), a force and the displacement it does its virtual work on, both
        scalars or both vectors: δW = F · δr. F may be non-conservative: any function of q, q̇, w,
        ẇ and f.
    kinematics : named functions of the coordinates, such as the angle of a segment or the
        deflection of a spring, in an order in which each uses only those before it. T, V and D
        may use the names and their rates, and so stay as short as on paper.
    equilibrium : the operating point, coordinate → value, zero where it says nothing.
    outputs : named results, expressions in any of the signals, their rates and second rates.

    Raises
    ------
    InputError : a symbol that is listed twice or that no list declares.

    Examples
    --------
    >>> m, k, c, g = sp.symbols("m k c g", positive=True)
    >>> z, w = Coordinate("z"), Input("w")
    >>> mass = Lagrangian([z], m * z.dot**2 / 2, k * (z - w) ** 2 / 2, c * (z.dot - w.dot) ** 2 / 2,
    ...                   inputs=[w])
    >>> mass.equations()[0].expand()
    -c*w_dot + c*z_dot - k*w + k*z + m*z_dot_dot
    """

    coordinates: Sequence[Coordinate]
    kinetic: sp.Expr
    potential: sp.Expr = sp.S.Zero
    dissipation: sp.Expr = sp.S.Zero
    inputs: Sequence[Input] = ()
    forces: Sequence[Force] = ()
    virtual_work: Sequence[tuple[Any, Any]] = ()
    kinematics: Mapping[Coordinate, sp.Expr] = field(default_factory=dict)
    equilibrium: Mapping[Coordinate, sp.Expr] = field(default_factory=dict)
    outputs: Mapping[str, sp.Expr] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in ("coordinates", "inputs", "forces"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        for name in ("kinetic", "potential", "dissipation"):
            object.__setattr__(self, name, sp.sympify(getattr(self, name)))
        object.__setattr__(self, "virtual_work", tuple(_scalar_work(self.virtual_work)))
        self._check()

    def _check(self) -> None:
        faults = Faults("Lagrangian")
        declared: list[Signal] = [*self.coordinates, *self.inputs, *self.forces, *self.kinematics]
        names = [s.name for s in declared]
        for twice in sorted({name for name in names if names.count(name) > 1}):
            faults.add(twice, "a name listed twice", "a name of its own for each")
        for s in self.equilibrium:
            if s not in self.coordinates:
                faults.add(f"equilibrium of {s}", "no coordinate", "values of coordinates")
        known = set(declared)
        # part → expression and the highest rate that may be in it
        parts = {"kinetic": (self.kinetic, 1), "potential": (self.potential, 0)}
        parts["dissipation"] = (self.dissipation, 1)
        for k, (force, displacement) in enumerate(self.virtual_work, start=1):
            parts[f"force {k}"], parts[f"displacement {k}"] = (force, 1), (displacement, 0)
        parts |= {f"kinematics of {name}": (u, 0) for name, u in self.kinematics.items()}
        parts |= {f"output {name}": (u, 2) for name, u in self.outputs.items()}
        for part, (given, highest) in parts.items():
            expression = sp.sympify(given)
            for s in signals(expression):
                if s.base not in known:
                    faults.add(
                        part,
                        f"the undeclared signal {s.base}",
                        "only declared ones",
                        f"list it among the {type(s).__name__.lower()}s",
                    )
            if any(s.order > highest for s in signals(expression)):
                rates = ("signals", "signals and their rates", "no third rates")[highest]
                faults.add(part, f"too high a rate in {expression}", f"a function of {rates}")
            if "t" in (s.name for s in expression.free_symbols):
                faults.add(
                    part,
                    "the time t",
                    "time only through inputs and forces",
                    "make the term an Input or a Force",
                )
        faults.raise_if_any()

    @cached_property
    def written_out(self) -> Lagrangian:
        """The same system with every named kinematic function put in."""
        wanted = set[sp.Symbol]().union(
            *(sp.sympify(u).free_symbols for u in self.outputs.values())
        )
        table = _written_out(self.kinematics, wanted)
        work = tuple((F.xreplace(table), r.xreplace(table)) for F, r in self.virtual_work)
        T, V, D = (u.xreplace(table) for u in (self.kinetic, self.potential, self.dissipation))
        return Lagrangian(
            self.coordinates, T, V, D, self.inputs, self.forces, work, equilibrium=self.equilibrium,
            outputs={name: sp.sympify(u).xreplace(table) for name, u in self.outputs.items()},
        )  # fmt: skip

    def _repr_latex_(self) -> str:
        lines = [rf"{sp.latex(name)} &= {sp.latex(u)}" for name, u in self.kinematics.items()]
        energies = {"T": self.kinetic, "V": self.potential, "D": self.dissipation}
        lines += [rf"{name} &= {sp.latex(u)}" for name, u in energies.items() if u != 0]
        work = (rf"\left({sp.latex(F)}\right) \delta {sp.latex(r)}" for F, r in self.virtual_work)
        lines += [rf"\delta W &= {' + '.join(work)}"] if self.virtual_work else []
        q = ", ".join(sp.latex(s) for s in self.coordinates)
        lines.insert(0, rf"q &= \left({q}\right)")
        return "".join(
            [r"$\displaystyle \begin{aligned} ", r" \\ ".join(lines), r" \end{aligned}$"]
        )

    def equations(self) -> sp.Matrix:
        """The nonlinear equations of motion as a column: left-hand side less Q, each zero."""
        system = self.written_out
        T, V, D = system.kinetic, system.potential, system.dissipation
        return sp.Matrix([
            rate(T.diff(q.dot)) - T.diff(q) + V.diff(q) + D.diff(q.dot)
            - sp.Add(*(F * r.diff(q) for F, r in system.virtual_work))
            for q in system.coordinates
        ])  # fmt: skip

    @cached_property
    def operating_point(self) -> dict[Signal, sp.Expr]:
        """Values of q, w and f where the system rests; every rate is zero there."""
        point: dict[Signal, sp.Expr] = dict.fromkeys((*self.inputs, *self.forces), sp.S.Zero)
        return point | {q: sp.sympify(self.equilibrium.get(q, 0)) for q in self.coordinates}


def _scalar_work(pairs: Sequence[tuple[Any, Any]]) -> list[tuple[sp.Expr, sp.Expr]]:
    """Pairs of vectors as pairs of their components; F · δr is a sum over components."""
    scalar = []
    for force, displacement in pairs:
        if isinstance(force, sp.MatrixBase):
            scalar += list(zip(force, displacement, strict=True))
        else:
            scalar.append((sp.sympify(force), sp.sympify(displacement)))
    return scalar


def _written_out(
    kinematics: Mapping[Coordinate, sp.Expr], wanted: AbstractSet[sp.Symbol]
) -> dict[sp.Symbol, sp.Expr]:
    """Each kinematic name and its rates → an expression in coordinates and inputs alone.

    Second rates, long as they are, only where they are ``wanted``.
    """
    table: dict[sp.Symbol, sp.Expr] = {}
    for name, definition in kinematics.items():
        table[name] = sp.sympify(definition).xreplace(table)
        table[name.dot] = rate(table[name])
        if name.ddot in wanted:
            table[name.ddot] = rate(table[name.dot])
    return table
