"""What all derivations share: their subject, how they are written, and their text for programs."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from railride import markup
from railride.lagrange import Coordinate, Lagrangian
from railride.linear import LinearModel, linearise
from railride.markup import Block, Code, Equation, Heading, Paragraph, aligned, math
from railride.numeric import Array
from railride.vehicle import VehicleModel

TOGETHER = 8  # equations in one block
RENDERERS = {"markdown": markup.markdown, "latex": markup.latex}

LAGRANGE = (
    r"\frac{d}{dt} \frac{\partial T}{\partial \dot q_i} - \frac{\partial T}{\partial q_i}"
    r" + \frac{\partial V}{\partial q_i} + \frac{\partial D}{\partial \dot q_i} = Q_i"
)


@dataclass(frozen=True)
class Subject:
    """What a derivation is of: a vehicle, or its car body alone and free.

    alone : of the car body. form : "markdown" or "latex". nonlinear : with those equations.
    figure : file name of the picture of the coordinates, beside the document; "" for none.
    document : file name of the document, for the command that makes it; "" for none.
    """

    model: VehicleModel
    alone: bool
    form: str
    nonlinear: bool = False
    figure: str = ""
    document: str = ""

    @property
    def system(self) -> Lagrangian:
        """The energies."""
        return self.model.body.energies if self.alone else self.model.lagrangian

    @cached_property
    def linear(self) -> LinearModel:
        """M, C, K, K_w, C_w, B_f, their entries factored."""
        linear = linearise(self.system) if self.alone else self.model.linear
        return linear.map(sp.factor)

    @cached_property
    def lift(self) -> Mapping[Coordinate, float]:
        """The coordinates of a uniform lift by 1 m, those that are not 0."""
        if self.alone:
            return self.model.body.lift
        pairs = zip(self.system.coordinates, self.model.lift.tolist(), strict=True)
        return {q: u for q, u in pairs if u}

    @cached_property
    def values(self) -> dict[str, Array]:
        """Its parameters as numbers, the car body's first."""
        body, every = self.model.body, self.model.values()
        own = [p.symbol.name for p in body.parameters]
        own += [s.name for s in (*body.definitions, *body.followers)]
        rest = [] if self.alone else [name for name in every if name not in own]
        return {name: every[name] for name in (*own, *rest) if name in every}


@contextmanager
def repeatable() -> Iterator[None]:
    """Let sympy factor with the same random numbers each time: unlucky ones can take minutes.

    Its generator goes on as it was.
    """
    from sympy.core.random import rng

    state = rng.getstate()
    rng.seed(0)
    try:
        yield
    finally:
        rng.setstate(state)


def render(blocks: Iterable[Block], form: str) -> str:
    """A document as text; ``form`` is "markdown" or "latex"."""
    return RENDERERS[form](blocks)


def listed(symbols: Sequence[sp.Symbol]) -> str:
    """Symbols in a row."""
    return ", ".join(math(s) for s in symbols)


def definitions(named: Mapping[Any, sp.Expr]) -> list[Block]:
    """``u = expression`` under each other, a few to a block."""
    ordered = sorted(named, key=lambda u: markup.natural(u.name))
    return stacked([[f"{math(u)} & = {math(named[u])}"] for u in ordered])


def stacked(equations: Sequence[Sequence[str]]) -> list[Block]:
    """Equations under each other, each one line or several, a few to a block."""
    each = -(-len(equations) // -(-len(equations) // TOGETHER))  # as many in each block
    chunks = (equations[k : k + each] for k in range(0, len(equations), each))
    return [Equation(aligned([line for lines in chunk for line in lines])) for chunk in chunks]


def for_sympy(system: Lagrangian, linear: LinearModel, **more: Any) -> list[Block]:
    """The same mathematics as JSON of sympy's own strings; of a matrix what is not zero."""
    document: dict[str, Any] = {
        "coordinates": [q.name for q in system.coordinates],
        "inputs": [w.name for w in system.inputs],
        "forces": [f.name for f in system.forces],
        "kinematics": {u.name: str(r) for u, r in system.kinematics.items()},
        "T": str(system.kinetic),
        "V": str(system.potential),
        "D": str(system.dissipation),
    }
    document |= entries(linear.matrices)
    text = json.dumps(document | more, indent=1, ensure_ascii=False)
    return [
        Heading("For a program"),
        Paragraph("The same as expressions that sympy reads; `_dot` is a rate, a matrix is its "
                  "entries by row and column, counted from 0."),
        Code(text, "json"),
    ]  # fmt: skip


def entries(matrices: Mapping[str, sp.MatrixBase]) -> dict[str, dict[str, str]]:
    """Of each matrix what is not zero, "row,column" → sympy's string.

    >>> entries({"K": sp.Matrix([[0, sp.Symbol("k")]])})
    {'K': {'0,1': 'k'}}
    """
    return {
        name: {f"{i},{j}": str(e) for (i, j), e in sorted(A.todok().items())}
        for name, A in matrices.items()
    }
