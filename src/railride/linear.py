r"""The linear equations of motion about the operating point.

.. math:: M \ddot q + C \dot q + K q = K_w w + C_w \dot w + B_f f

Two ways lead there. :func:`linearise` takes the matrices from the energies directly,

.. math:: M = T_{\dot q\dot q},\quad
          C = T_{\dot q q} - T_{q\dot q} + D_{\dot q\dot q} - Q_{\dot q},\quad
          K = V_{qq} - T_{qq} + D_{\dot q q} - Q_q,

.. math:: K_w = -V_{qw} + T_{qw} - D_{\dot q w} + Q_w,\quad
          C_w = -T_{\dot q w} + T_{q\dot w} - D_{\dot q\dot w} + Q_{\dot w},\quad
          B_f = Q_f

(indices are second derivatives at the operating point), and never writes the nonlinear equations.
:func:`linearise_equations` differentiates those, and exists to check the first.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Sections 6.10 and 7.1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache, cached_property

import sympy as sp

from railride.errors import InputError
from railride.jets import Jets
from railride.lagrange import Coordinate, Force, Input, Lagrangian, Signal

MATRICES = ("M", "C", "K", "K_w", "C_w", "B_f")


@dataclass(frozen=True)
class LinearModel:
    """M q̈ + C q̇ + K q = K_w w + C_w ẇ + B_f f, symbolic in the parameters.

    Rows, and columns of M, C and K, are in the order of ``coordinates``; columns of K_w and C_w in
    that of ``inputs``; those of B_f in that of ``forces``.
    """

    coordinates: Sequence[Coordinate]
    inputs: Sequence[Input]
    forces: Sequence[Force]
    M: sp.ImmutableSparseMatrix
    C: sp.ImmutableSparseMatrix
    K: sp.ImmutableSparseMatrix
    K_w: sp.ImmutableSparseMatrix
    C_w: sp.ImmutableSparseMatrix
    B_f: sp.ImmutableSparseMatrix

    @property
    def matrices(self) -> dict[str, sp.ImmutableSparseMatrix]:
        """The six matrices by name."""
        return {name: getattr(self, name) for name in MATRICES}

    @cached_property
    def parameters(self) -> tuple[sp.Symbol, ...]:
        """The symbols in the matrices, by name."""
        found: set[sp.Symbol] = set().union(*(A.free_symbols for A in self.matrices.values()))
        return tuple(sorted(found, key=lambda s: s.name))

    def map(self, f: Callable[[sp.Expr], sp.Expr]) -> LinearModel:
        """The same model with ``f``, say :func:`sympy.factor`, applied to every entry."""
        done: dict[sp.Expr, sp.Expr] = {}

        def once(entry: sp.Expr) -> sp.Expr:
            if entry not in done:
                done[entry] = f(entry)
            return done[entry]

        kept = {x.name: getattr(self, x.name) for x in fields(self)}
        return LinearModel(**kept | {n: A.applyfunc(once) for n, A in self.matrices.items()})

    def _repr_latex_(self) -> str:
        def column(symbols: Sequence[sp.Symbol]) -> str:
            return str(sp.latex(sp.Matrix(symbols)))

        q, w = self.coordinates, self.inputs
        left = [(self.M, [s.ddot for s in q]), (self.C, [s.dot for s in q]), (self.K, q)]
        right = [(self.K_w, w), (self.C_w, [s.dot for s in w]), (self.B_f, self.forces)]
        sides = [
            " + ".join(sp.latex(A.as_explicit()) + column(v) for A, v in side if A.nnz())
            for side in (left, right)
        ]
        return rf"$\displaystyle {sides[0]} = {sides[1] or '0'}$"


def linearise(system: Lagrangian) -> LinearModel:
    """The linear model, from the energies directly (see the module's equations).

    Raises
    ------
    InputError : the operating point is not an equilibrium (each coordinate with the force left
        over); a term that is not smooth there; inputs that act by their second rate.
    """
    jets = Jets(system.operating_point, system.kinematics)
    _refuse_no_equilibrium(system, jets)
    T, V, D = (jets.hessian(u) for u in (system.kinetic, system.potential, system.dissipation))
    Q = _force_derivatives(system, jets)
    q, w, f = system.coordinates, system.inputs, system.forces
    dq, dw = [s.dot for s in q], [s.dot for s in w]
    _refuse_second_rates([s for s in w if any(T.get((a, s.dot), 0) != 0 for a in dq)])

    def block(columns: Sequence[Signal], entry: Callable[[int, int], sp.Expr]) -> sp.Matrix:
        entries = {(i, j): entry(i, j) for i in range(len(q)) for j in range(len(columns))}
        entries = {ij: _tidy(value) for ij, value in entries.items() if value != 0}
        return sp.ImmutableSparseMatrix(len(q), len(columns), entries)

    def of(H: Mapping[tuple[Signal, Signal], sp.Expr], a: Signal, b: Signal) -> sp.Expr:
        return H.get((a, b), sp.S.Zero)

    return LinearModel(
        q, w, f,
        M=block(dq, lambda i, j: of(T, dq[i], dq[j])),
        C=block(dq, lambda i, j: of(T, dq[i], q[j]) - of(T, q[i], dq[j])
                + of(D, dq[i], dq[j]) - of(Q, q[i], dq[j])),
        K=block(q, lambda i, j: of(V, q[i], q[j]) - of(T, q[i], q[j])
                + of(D, dq[i], q[j]) - of(Q, q[i], q[j])),
        K_w=block(w, lambda i, j: -of(V, q[i], w[j]) + of(T, q[i], w[j])
                  - of(D, dq[i], w[j]) + of(Q, q[i], w[j])),
        C_w=block(dw, lambda i, j: -of(T, dq[i], w[j]) + of(T, q[i], dw[j])
                  - of(D, dq[i], dw[j]) + of(Q, q[i], dw[j])),
        B_f=block(f, lambda i, j: of(Q, q[i], f[j])),
    )  # fmt: skip


def linearise_equations(system: Lagrangian) -> LinearModel:
    """The linear model, by differentiating the nonlinear equations of motion (slow; a check).

    Raises
    ------
    InputError : the operating point is not an equilibrium.
    """
    system = system.written_out
    equations = system.equations()
    q, w, f = system.coordinates, system.inputs, system.forces
    point = dict(system.operating_point)
    point |= {s.dot: sp.S.Zero for s in (*q, *w)} | {s.ddot: sp.S.Zero for s in (*q, *w)}
    _refuse_residual({q[i]: r.xreplace(point) for i, r in enumerate(equations)})
    _refuse_second_rates([s for s in w if any(r.has(s.ddot) for r in equations)])

    def block(columns: Sequence[Signal]) -> sp.Matrix:
        jacobian = equations.jacobian(columns) if columns else sp.zeros(len(q), 0)
        return sp.ImmutableSparseMatrix(jacobian.applyfunc(lambda e: e.xreplace(point)))

    return LinearModel(
        q, w, f,
        M=block([s.ddot for s in q]), C=block([s.dot for s in q]), K=block(q),
        K_w=-block(w), C_w=-block([s.dot for s in w]), B_f=-block(f),
    )  # fmt: skip


def output_rows(
    system: Lagrangian, outputs: Mapping[str, sp.Expr] | None = None
) -> dict[str, sp.ImmutableSparseMatrix]:
    r"""Outputs, y = Y_a q̈ + Y_v q̇ + Y_d q + Y_w w + Y_dw ẇ + Y_ddw ẅ + Y_f f, linearised.

    They count from their values at the operating point, as the coordinates do.

    Parameters
    ----------
    outputs : name → expression; default: the system's own.

    Returns
    -------
    dict : "a", "v", "d" (outputs, coordinates), "w", "dw", "ddw" (outputs, inputs), "f" (outputs,
        forces).

    Raises
    ------
    InputError : a signal that the system does not have; an output that is not smooth.
    """
    system = system if outputs is None else replace(system, outputs=outputs)
    jets = Jets(system.operating_point, system.kinematics)
    gradients = {name: jets.gradient(sp.sympify(u)) for name, u in system.outputs.items()}
    q, w = system.coordinates, system.inputs
    columns = {"a": [s.ddot for s in q], "v": [s.dot for s in q], "d": q}
    columns |= {"w": w, "dw": [s.dot for s in w], "ddw": [s.ddot for s in w], "f": system.forces}
    return {
        rows: sp.ImmutableSparseMatrix(
            [[g.get(s, sp.S.Zero) for s in of] for g in gradients.values()]
        )
        for rows, of in columns.items()
    }


@cache
def _tidy(entry: sp.Expr) -> sp.Expr:
    """Numbers taken out of the factors of each term: k (2 - 4 l)(4 - 8 l)/8 as k (1 - 2 l)²."""
    terms = []
    for term in sp.Add.make_args(entry):
        parts = [f.primitive() if f.is_Add else (f, sp.S.One) for f in sp.Mul.make_args(term)]
        terms.append(sp.Mul(*(factor for part in parts for factor in part)))
    return sp.Add(*terms)


def _force_derivatives(system: Lagrangian, jets: Jets) -> dict[tuple[Signal, Signal], sp.Expr]:
    """∂Q_i/∂s at the operating point, by (q_i, s): Q_i = F ∂r/∂q_i summed over the forces."""
    total: dict[tuple[Signal, Signal], sp.Expr] = {}
    own = set(system.coordinates)
    for F, r in system.virtual_work:
        F_0, dF, dr = jets.value(F), jets.gradient(F), jets.gradient(r)
        terms = [((q, s), dr[q] * g) for q in dr if q in own for s, g in dF.items()]
        if F_0 != 0:
            terms += [((q, s), F_0 * h) for (q, s), h in jets.hessian(r).items() if q in own]
        for key, value in terms:
            total[key] = total.get(key, sp.S.Zero) + value
    return total


def _refuse_no_equilibrium(system: Lagrangian, jets: Jets) -> None:
    dV, dT = jets.gradient(system.potential), jets.gradient(system.kinetic)
    dD = jets.gradient(system.dissipation)
    left: dict[Signal, sp.Expr] = {
        q: dV.get(q, sp.S.Zero) - dT.get(q, sp.S.Zero) + dD.get(q.dot, sp.S.Zero)
        for q in system.coordinates
    }
    for F, r in system.virtual_work:
        for q, dr in jets.gradient(r).items():
            if q in left:
                left[q] -= jets.value(F) * dr
    _refuse_residual(left)


def _refuse_residual(left: Mapping[Signal, sp.Expr]) -> None:
    unbalanced = {q: r for q, r in left.items() if r != 0 and sp.simplify(r) != 0}
    if unbalanced:
        forces = "; ".join(f"along {q}: {r}" for q, r in unbalanced.items())
        raise InputError(
            f"operating point: found no equilibrium, with a force left over ({forces}); expected "
            "every generalised force to balance there (give the preloads that carry the weight, "
            "or the coordinates at which the system rests)"
        )


def _refuse_second_rates(acting: Sequence[Input]) -> None:
    if acting:
        raise InputError(
            f"inputs: found {', '.join(s.name for s in acting)} moving a mass together with a "
            "coordinate, so that the second rate enters; expected inputs that act through springs "
            "and dampers (count the coordinate from the ground instead of from the moving support)"
        )
