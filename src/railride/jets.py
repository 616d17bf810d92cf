r"""First and second derivatives of an expression at one point, by forward differentiation.

A derivative that is wanted at the operating point only need never be written out: value, gradient
and Hessian of a sum, a product and a function follow from those of the parts,

.. math:: \nabla f(u) = f_a \nabla u_a , \qquad
          \nabla\nabla f(u) = f_a \nabla\nabla u_a + f_{ab} \nabla u_a \nabla u_b^T ,

and a part whose factor vanishes at the point (as in T = ½ m ẋ², ẋ = 0) is not looked at. Each
subexpression is treated once. The result is exact, and symbolic in the parameters.

Source: A. Griewank, A. Walther, Evaluating Derivatives, 2nd ed., SIAM 2008, Sections 3.1 and 10.2.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from itertools import combinations_with_replacement
from typing import TypeVar

import sympy as sp

from railride.errors import InputError
from railride.lagrange import Signal

Gradient = dict[Signal, sp.Expr]
Hessian = dict[tuple[Signal, Signal], sp.Expr]  # both orders of a pair are there

K = TypeVar("K")

NOT_SMOOTH = (sp.Abs, sp.sign, sp.Heaviside, sp.Max, sp.Min, sp.Piecewise, sp.floor, sp.ceiling)


class Jets:
    """Values, gradients and Hessians of expressions at a point where everything rests.

    Parameters
    ----------
    point : value of each signal; every rate is zero.
    kinematics : named functions of signals, put in by the chain rule, each using only those
        before it. At rest their rates need no further differentiation: with H = ∂²u/∂q∂q,
        ∂u̇/∂q̇ = ∂ü/∂q̈ = ∂u/∂q, ∂²u̇/∂q∂q̇ = ∂²ü/∂q∂q̈ = H and ∂²ü/∂q̇∂q̇ = 2H.

    Raises
    ------
    InputError : a function that is not smooth at the point.
    """

    def __init__(self, point: Mapping[Signal, sp.Expr],
                 kinematics: Mapping[Signal, sp.Expr]) -> None:  # fmt: skip
        self._point = point
        self._definition = kinematics
        self._values: dict[sp.Expr, sp.Expr] = {}
        self._gradients: dict[sp.Expr, Gradient] = {}
        self._hessians: dict[sp.Expr, Hessian] = {}
        for name in kinematics:  # in their order, so that no chain of names is followed deep
            self.gradient(name)

    def value(self, u: sp.Expr) -> sp.Expr:
        """u at the point."""
        if u not in self._values:
            self._values[u] = self._value(u)
        return self._values[u]

    def gradient(self, u: sp.Expr) -> Gradient:
        """∂u/∂s at the point for each signal s, where it is not zero."""
        if u not in self._gradients:
            self._gradients[u] = self._gradient(u)
        return self._gradients[u]

    def hessian(self, u: sp.Expr) -> Hessian:
        """∂²u/∂s∂t at the point for each ordered pair of signals, where it is not zero."""
        if u not in self._hessians:
            self._hessians[u] = self._hessian(u)
        return self._hessians[u]

    def _value(self, u: sp.Expr) -> sp.Expr:
        if isinstance(u, Signal):
            named = self._definition.get(u)
            return self._point.get(u, sp.S.Zero) if named is None else self.value(named)
        if not u.args:
            return u
        at_point = u.func(*(self.value(a) for a in u.args))
        if at_point.has(sp.zoo, sp.nan, sp.oo):
            raise InputError(f"{u}: found no finite value at the operating point; expected a "
                             "smooth function there (choose other coordinates)")  # fmt: skip
        return at_point

    def _gradient(self, u: sp.Expr) -> Gradient:
        if isinstance(u, Signal):
            named = self._definition.get(u.base)
            if named is None:
                return {u: sp.S.One}
            return {_rate(s, u.order): g for s, g in self.gradient(named).items()}
        if isinstance(u, sp.Add):
            return _sum(self.gradient(a).items() for a in u.args)
        partials = self._partials(u, order=1)
        return _sum(
            ((s, partials[a,] * g) for s, g in self.gradient(argument).items())
            for a, argument in enumerate(u.args)
            if (a,) in partials
        )

    def _hessian(self, u: sp.Expr) -> Hessian:
        if isinstance(u, Signal):
            named = self._definition.get(u.base)
            return {} if named is None else _rate_hessian(self.hessian(named), u.order)
        if isinstance(u, sp.Add):
            return _sum(self.hessian(a).items() for a in u.args)
        terms = []
        for (a,), f_a in self._partials(u, order=1).items():
            terms.append([(pair, f_a * h) for pair, h in self.hessian(u.args[a]).items()])
        for (a, b), f_ab in self._partials(u, order=2).items():
            at_a, at_b = self.gradient(u.args[a]), self.gradient(u.args[b])
            terms.append([((s, t), f_ab * g * h) for s, g in at_a.items() for t, h in at_b.items()])
        return _sum(terms)

    def _partials(self, u: sp.Expr, order: int) -> dict[tuple[int, ...], sp.Expr]:
        """Non-zero partial derivatives of ``u.func`` by its arguments, at the point."""
        varying = [a for a, argument in enumerate(u.args) if _varies(argument)]
        if isinstance(u, NOT_SMOOTH) and varying:
            raise InputError(f"{u}: found a function that is not smooth; expected one that can be "
                             "linearised (replace it by its tangent)")  # fmt: skip
        table = {}
        for index in combinations_with_replacement(varying, order):
            at_point = self._partial(u, varying, index)
            if at_point.has(sp.zoo, sp.nan, sp.oo):
                raise InputError(
                    f"{u}: found no finite derivative at the operating point; expected a smooth "
                    "function (choose other coordinates)"
                )
            if at_point != 0:
                table[index] = table[index[::-1]] = at_point
        return table

    def _partial(self, u: sp.Expr, varying: list[int], index: tuple[int, ...]) -> sp.Expr:
        values = [self.value(argument) for argument in u.args]
        if isinstance(u, sp.Mul):
            others = (v for a, v in enumerate(values) if a not in index)
            return sp.Mul(*others) if len(set(index)) == len(index) else sp.S.Zero
        fixed = tuple(None if a in varying else v for a, v in enumerate(values))
        return _derivative(u.func, fixed, index)(*(values[a] for a in varying))


def _rate(s: Signal, order: int) -> Signal:
    return (s, s.dot, s.ddot)[order] if order else s


def _rate_hessian(H: Hessian, order: int) -> Hessian:
    """The Hessian of u, u̇ or ü at rest from that of u."""
    if order == 0:
        return H
    mixed = {(s, _rate(t, order)): h for (s, t), h in H.items()}
    mixed |= {(t, s): h for (s, t), h in mixed.items()}
    return mixed if order == 1 else mixed | {(s.dot, t.dot): 2 * h for (s, t), h in H.items()}


def _varies(u: sp.Expr) -> bool:
    return any(isinstance(s, Signal) for s in u.free_symbols)


@cache
def _derivative(function: type[sp.Expr], fixed: tuple[sp.Expr | None, ...],
                index: tuple[int, ...]) -> sp.Lambda:  # fmt: skip
    """∂f/∂x_a (or ∂²f/∂x_a∂x_b) of a sympy function, as a function of the arguments not fixed."""
    x = [sp.Dummy(real=True) if value is None else value for value in fixed]
    free = tuple(s for s, value in zip(x, fixed, strict=True) if value is None)
    return sp.Lambda(free, sp.diff(function(*x), *(x[a] for a in index)))


def _sum(parts: Iterable[Iterable[tuple[K, sp.Expr]]]) -> dict[K, sp.Expr]:
    """Sum of sparse vectors, entries that vanish left out."""
    total = defaultdict(list)
    for part in parts:
        for key, value in part:
            total[key].append(value)
    added = {key: sp.Add(*values) for key, values in total.items()}
    return {key: value for key, value in added.items() if value != 0}
