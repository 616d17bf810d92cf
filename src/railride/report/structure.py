r"""The linear equations of motion: their matrices whole where they fit, else in named blocks.

The coordinates fall into groups: the car body's q_c, then equipment and bogies. What links the car
body to the rest are deflections s with gradients h = ∂s/∂q_c, and so

.. math:: K_c = K_f + \sum_s k_s h_s h_s^T , \qquad K_{c b} = -k_2 h_b e^T ,

with K_f the free body's own.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from railride.jets import Jets
from railride.lagrange import Coordinate
from railride.markup import Block, Equation, Heading, Paragraph, aligned, continued, math
from railride.report.document import Subject, listed
from railride.report.matrices import common, fits, shown, side_by_side, told

SQUARE = ("M", "C", "K")
PLACE = sp.Symbol("xh")  # where an h will stand, behind parameters and lengths


def linear(subject: Subject) -> list[Block]:
    """The linear equations of motion and their matrices."""
    model = subject.linear
    inputs = bool(model.inputs)
    right = r"K_w w + C_w \dot w + B_f f" if inputs else "0"
    also = rf", $w = ({listed(model.inputs)})$, $f = ({listed(model.forces)})$" * inputs
    blocks: list[Block] = [
        Heading("Linear equations of motion"),
        Paragraph("About the equilibrium"),
        Equation(rf"M \ddot q + C \dot q + K q = {right}"),
    ]
    matrices = {name: A for name, A in model.matrices.items() if A.cols}
    if subject.alone or all(fits(A) for A in matrices.values()):
        blocks.append(Paragraph(f"with $q = ({listed(model.coordinates)})${also} and"))
        show = told if subject.alone else shown
        blocks += side_by_side([block for name, A in matrices.items() for block in show(name, A)])
    else:
        blocks += Parts(subject).blocks(also)
    return [*blocks, Paragraph(_lift(inputs))]


def _lift(inputs: bool) -> str:
    if not inputs:
        return (
            "There are no inputs and no forces: $K_w$, $C_w$ and $B_f$ have no columns. "
            "$K$ and $C$ are singular, for lift and pitch of the straight body bend no joint."
        )
    return ("A uniform lift of track and vehicle strains no spring and no damper: the matrices "
            "meet $K u_0 = K_w 1$ and $C u_0 = C_w 1$, $u_0$ the coordinates of such a lift, or "
            "there would be no document.")  # fmt: skip


@dataclass(frozen=True)
class Group:
    """Coordinates, or inputs, that belong together: their index in names, and places."""

    index: str
    places: tuple[int, ...]


class Parts:
    """The matrices of a vehicle in blocks."""

    def __init__(self, subject: Subject) -> None:
        self.subject, self.linear = subject, subject.linear
        self.system, self.model = subject.system, subject.model

    @cached_property
    def groups(self) -> list[Group]:
        """The car body, equipment, each bogie, dampers on elastic mounts."""
        names = [q.name for q in self.system.coordinates]
        own = len(self.model.body.energies.coordinates)
        hung = len(self.model.carried.equipment)
        found = [Group("c", tuple(range(own)))]
        if hung:
            found.append(Group("e", tuple(range(own, own + hung))))
        found += [
            Group(str(b), (names.index(f"z_b{b}"), names.index(f"theta_b{b}")))
            for b in self.model.running_gear.bogies
        ]
        strokes = [names.index(q.name) for q in self.model.running_gear.strokes]
        return found + ([Group("d", tuple(strokes))] if strokes else [])

    @cached_property
    def wheelsets(self) -> list[Group]:
        """The inputs of each bogie."""
        gear = self.model.running_gear
        return [Group(str(b), tuple(j - 1 for j, _ in gear.levers(b))) for b in gear.bogies]

    @cached_property
    def gradients(self) -> dict[Coordinate, sp.Matrix]:
        """∂u/∂q as a column, of each deflection that links the car body to something else."""
        jets = Jets(self.system.operating_point, self.system.kinematics)
        own = set(self.model.body.energies.coordinates)
        names = [u for u in self.system.kinematics if u not in self.model.body.energies.kinematics]
        found = {u: jets.gradient(u) for u in names}
        return {
            u: sp.Matrix([sp.expand(g.get(q, 0)) for q in self.system.coordinates])
            for u, g in found.items() if own & set(g)
        }  # fmt: skip

    def coefficients(self, letter: str) -> dict[Coordinate, sp.Expr]:
        """Stiffness or damping of those deflections."""
        if letter == "M":
            return {}
        energy = self.system.potential if letter == "K" else self.system.dissipation
        found = {u: energy.diff(u if letter == "K" else u.dot, 2) for u in self.gradients}
        return {u: k for u, k in found.items() if k != 0}

    def blocks(self, also: str) -> list[Block]:
        """All matrices."""
        body, *others = self.groups
        n = len(body.places)
        named = [rf"{_h(u)} & = {math(g[:n, :].T)}^T" for u, g in self.gradients.items()]
        listed_groups = ", ".join(f"q_{group.index}" for group in others)
        meant = "; ".join(
            f"$q_{group.index} = ({listed([self.linear.coordinates[i] for i in group.places])})$"
            for group in self.groups
        )
        blocks: list[Block] = [
            Paragraph(f"with the coordinates in groups, $q = (q_c, {listed_groups})$: "
                      f"{meant}{also}. The deflections between the car body and the rest grow with "
                      "its coordinates by"),
            Equation(aligned(named)),
            *self._products(n),
            Paragraph("In blocks,"),
        ]  # fmt: skip
        for letter in SQUARE:
            blocks += side_by_side(self._square(letter))
        blocks += side_by_side([*self._inputs("K_w"), *self._inputs("C_w")])
        return blocks + self._forces()

    def _forces(self) -> list[Block]:
        """B_f, which pushes the car body along h_b and the bogie down."""
        B_f = self.linear.B_f
        e = sp.Matrix([-1, 0])
        rows = [["0"] * B_f.cols for _ in self.groups]
        expected = sp.zeros(*B_f.shape)
        for k, u in enumerate(r for _, r in self.system.virtual_work):
            for i, group in enumerate(self.groups):
                block = self.gradients[u].extract(list(group.places), [0])
                own = group.index == u.name.partition("_")[2]
                if group.index == "c" or (own and block == e):
                    rows[i][k] = _h(u) if group.index == "c" else "- e"
                    for place, entry in zip(group.places, block, strict=True):
                        expected[place, k] = entry
        if any(sp.simplify(entry) != 0 for entry in B_f - expected):
            return shown("B_f", B_f)
        inner = r" \\ ".join(" & ".join(row) for row in rows)
        return [Equation(rf"B_f = \begin{{bmatrix}}{inner}\end{{bmatrix}}, \qquad "
                         rf"e = {math(-e)}")]  # fmt: skip

    def _products(self, n: int) -> list[Block]:
        """What the suspensions add to the car body's own matrices, where it is not 0."""
        if self.model.body.segments is None:  # of modes all entries are full
            return []
        parts: dict[tuple[int, ...], list[Coordinate]] = {}
        for u in self.gradients:
            h = self.gradients[u]
            parts.setdefault(tuple(i for i in range(n) if h[i] != 0), []).append(u)
        equations = []
        for places, together in parts.items():
            columns = [self.gradients[u].extract(list(places), [0]) for u in together]
            total = sum((h * h.T for h in columns), sp.zeros(len(places), len(places)))
            left = " + ".join(f"{_h(u)} {_h(u)}^T" for u in together)
            at = listed([self.linear.coordinates[i] for i in places])
            factor, rest = common(sp.S.One, total.applyfunc(sp.factor))
            head = rf"\left({left}\right)_{{{at}}} ="
            head += f" {math(factor)}" if factor != 1 else ""
            equations.append(Equation(f"{head} {math(rest)}"))
        few = (
            "whose products are, in the rows and columns of the coordinates named and 0 elsewhere,"
        )
        return [Paragraph(few), *side_by_side(equations)]

    def _square(self, letter: str) -> list[Block]:
        """M, C or K: its blocks under their names, then each block."""
        A = self.linear.matrices[letter]
        named: dict[str, tuple[Group, Group, sp.MatrixBase]] = {}
        rows = []
        for i, a in enumerate(self.groups):
            row = []
            for j, b in enumerate(self.groups):
                block = A.extract(list(a.places), list(b.places))
                if not block.todok():
                    row.append("0")
                elif i <= j:
                    row.append(self._named(letter, a, b))
                    named.setdefault(row[-1], (a, b, block))
                else:
                    row.append(f"{self._named(letter, b, a)}^T")
            rows.append(" & ".join(row))
        table = r" \\ ".join(rows)
        blocks: list[Block] = [Equation(rf"{letter} = \begin{{bmatrix}}{table}\end{{bmatrix}}")]
        for name, (a, b, block) in named.items():
            blocks += self._block(letter, name, a, b, block)
        return blocks

    def _named(self, letter: str, a: Group, b: Group) -> str:
        """A block's name; bogies that are alike share theirs."""
        if a is not b:
            return f"{letter}_{{{a.index}{b.index}}}"
        if not a.index.isdigit():
            return f"{letter}_{a.index}"
        A = self.linear.matrices[letter]
        bogies = [list(group.places) for group in self.groups if group.index.isdigit()]
        kinds = {sp.ImmutableMatrix(A.extract(places, places)) for places in bogies}
        return f"{letter}_b" if len(kinds) == 1 else f"{letter}_{{b{a.index}}}"

    def _block(
        self, letter: str, name: str, a: Group, b: Group, block: sp.MatrixBase
    ) -> list[Block]:
        """One block, the car body's by what links it to the rest."""
        links = self.coefficients(letter)
        if a.index != "c" or not links:
            return told(name, block) if a.index == "c" else shown(name, block)
        n = block.rows
        if b.index != "c":
            return self._link(name, block, b, links)
        columns = {u: self.gradients[u][:n, :] for u in links}
        suspended = sum((k * columns[u] * columns[u].T for u, k in links.items()), sp.zeros(n, n))
        own = (block - suspended).applyfunc(lambda e: sp.factor(sp.expand(e)))
        return self._with_links(letter, name, sp.ImmutableSparseMatrix(own), links)

    def _with_links(self, letter: str, name: str, own: sp.MatrixBase,
                    links: Mapping[Coordinate, sp.Expr]) -> list[Block]:  # fmt: skip
        """K_c = K_f + Σ k h hᵀ, and K_f."""
        by: dict[sp.Expr, list[str]] = {}
        for u, k in links.items():
            by.setdefault(k, []).append(f"{_h(u)} {_h(u)}^T")
        terms = [f"{letter}_f"] if own.todok() else []
        for k, products in by.items():
            factor = rf"\left({math(k)}\right)" if k.is_Add else math(k)
            inner = " + ".join(products)
            several = len(products) > 1
            terms.append(rf"{factor} \left({inner}\right)" if several else f"{factor} {inner}")
        blocks: list[Block] = [Equation(aligned(continued(name, terms)))]
        return blocks + (told(f"{letter}_f", own) if own.todok() else [])

    def _link(self, name: str, block: sp.MatrixBase, group: Group,
              links: Mapping[Coordinate, sp.Expr]) -> list[Block]:  # fmt: skip
        """A block beside the car body's, each column a multiple of the h."""
        n, columns = block.rows, []
        expected = sp.zeros(*block.shape)
        for c, j in enumerate(group.places):
            factors = {u: k * self.gradients[u][j] for u, k in links.items()
                       if self.gradients[u][j] != 0}  # fmt: skip
            for u, k in factors.items():
                expected[:, c] += k * self.gradients[u][:n, :]
            terms = [math(k * PLACE).replace(PLACE.name, _h(u)) for u, k in factors.items()]
            columns.append(" + ".join(terms) or "0")
        if any(sp.simplify(e) != 0 for e in block - expected):
            return shown(name, block)
        inner = " & ".join(columns)
        return [Equation(rf"{name} = \begin{{bmatrix}}{inner}\end{{bmatrix}}")]

    def _inputs(self, name: str) -> list[Block]:
        """K_w or C_w: rows in the groups of coordinates, columns in those of wheelsets."""
        A, letter = self.linear.matrices[name], name[0]
        if not A.todok():
            return [Equation(f"{name} = 0")]
        found: dict[sp.ImmutableMatrix, str] = {}
        table = []
        for a in self.groups:
            row = []
            for b in self.wheelsets:
                block = sp.ImmutableMatrix(A.extract(list(a.places), list(b.places)))
                if block.is_zero_matrix:
                    row.append("0")
                    continue
                fresh = f"{letter}_{{{a.index if not a.index.isdigit() else 'b'}w}}"
                if found and block not in found:
                    fresh = f"{letter}_{{{a.index},w{b.index}}}"
                row.append(found.setdefault(block, fresh))
            table.append(" & ".join(row))
        inner = r" \\ ".join(table)
        blocks: list[Block] = [Equation(rf"{name} = \begin{{bmatrix}}{inner}\end{{bmatrix}}")]
        return [*blocks, *(b for block, each in found.items() for b in shown(each, block))]


def _h(u: Coordinate) -> str:
    """The gradient's symbol: h_1 of s_1, h_{e1} of s_e1."""
    index = u.name.partition("_")[2]
    return f"h_{index}" if len(index) == 1 else f"h_{{{index}}}"
