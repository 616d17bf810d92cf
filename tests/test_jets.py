"""Forward differentiation against sympy's own ``diff`` and substitution."""

from __future__ import annotations

import itertools

import pytest
import sympy as sp
from vehicles import identical

from railride.errors import InputError
from railride.jets import Jets
from railride.lagrange import Coordinate, Input, rate

a, b = sp.symbols("a b", positive=True)
x, y, u, s = (Coordinate(name) for name in "x y u s".split())
w = Input("w")
ALL = [x, y, w, x.dot, y.dot, w.dot]
POINT = {x: sp.Rational(1, 3), y: b, w: sp.S.Zero}

EXPRESSIONS = [
    a * x.dot**2 * sp.cos(x - y) / 2 + b * x.dot * y.dot * sp.sin(x),
    sp.sqrt(1 + x**2 + a * y**2) * sp.exp(-b * w),
    sp.atan2(y, 1 + x) * (w.dot - x.dot) ** 3 + x * w.dot,
    a**x * sp.log(2 + y) / (1 + x * y) + sp.Pow(2 + x, y),
    (x.dot + w.dot) ** 2 * (y + w) + sp.asin(x / 2) * sp.cosh(y.dot),
    sp.Integer(7) * a,
    sp.Max(a, b) * x * x.dot,
]


@pytest.mark.parametrize("expression", EXPRESSIONS)
def test_value_gradient_and_hessian_equal_those_of_sympy(expression):
    jets = Jets(POINT, {})
    at = POINT | {r.dot: sp.S.Zero for r in (x, y, w)}
    assert identical(jets.value(expression), expression.subs(at))
    gradient, hessian = jets.gradient(expression), jets.hessian(expression)
    for r in ALL:
        assert identical(gradient.get(r, sp.S.Zero), expression.diff(r).subs(at))
    for r, t in itertools.product(ALL, ALL):
        assert identical(hessian.get((r, t), sp.S.Zero), expression.diff(r, t).subs(at))


def test_named_functions_and_their_rates_equal_them_written_out():
    first = sp.sin(x) * (y - w)
    second = u**2 + sp.exp(x)
    short = a * s.dot**2 + b * s * u.dot + x * s.ddot + sp.cos(s) * x.dot + u * y.dot * w.dot
    second_long = second.xreplace({u: first})
    table = {u: first, s: second_long}
    table |= {r.dot: rate(definition) for r, definition in [(u, first), (s, second_long)]}
    table |= {s.ddot: rate(rate(second_long))}
    long = short.xreplace(table)
    every = [*ALL, x.ddot, y.ddot, w.ddot]
    at = POINT | {r.dot: sp.S.Zero for r in (x, y, w)} | {r.ddot: sp.S.Zero for r in (x, y, w)}
    jets = Jets(POINT, {u: first, s: second})
    assert identical(jets.value(short), long.subs(at))
    gradient, hessian = jets.gradient(short), jets.hessian(short)
    for r in every:
        assert identical(gradient.get(r, sp.S.Zero), long.diff(r).subs(at))
    for r, t in itertools.product(every, every):
        assert identical(hessian.get((r, t), sp.S.Zero), long.diff(r, t).subs(at)), (r, t)


@pytest.mark.parametrize(
    "expression",
    [abs(x), sp.sign(x) * y, sp.Heaviside(x), sp.Max(x, 0), sp.Min(x, y), sp.floor(x),
     sp.Piecewise((x, x > 0), (0, True)), a * abs(x - y) ** 3],
    ids=str,
)  # fmt: skip
def test_functions_that_are_not_smooth_are_refused(expression):
    with pytest.raises(InputError, match="smooth"):
        Jets({}, {}).hessian(expression)


@pytest.mark.parametrize("expression", [sp.sqrt(x), 1 / x, sp.log(x), x**a / x**b, sp.asin(1 + x)])
def test_points_without_finite_derivatives_are_refused(expression):
    with pytest.raises(InputError, match=r"smooth|finite"):
        Jets({}, {}).hessian(expression)
