r"""Natural modes of a free car body from the mass and stiffness matrices of its finite elements.

The lowest modes of :math:`K\varphi = \omega^2 M\varphi`, with φᵀMφ = 1, are rigid motions where ω
is zero but for rounding. Their heights along the body are straight, :math:`(1\;\;x)\,C` with C of
two rows, and the mass that belongs to heave and pitch is

.. math:: G = (C C^T)^{-1} ,

that of the rigid motion of least kinetic energy with given heights: motions sideways drop out, and
so do flexible modes that leave the points at rest, torsion and bending sideways.

Source: M. Géradin, D. J. Rixen, Mechanical Vibrations, Wiley 2015, Section 2.9 (rigid-body modes).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from railride.bodies.point_modes import RIGID, STRAIGHT, PointModes
from railride.bodies.reduction import Matrix, lowest_modes, negative_eigenvalues
from railride.errors import Faults
from railride.numeric import Array

SYMMETRIC = 1e-6  # of the largest entry: what files of few digits leave
NEGATIVE = 1e-9  # of the diagonal: what rounding leaves
AT_REST = 0.01  # of the car body's mean motion: points that move less are at rest
SAME = 1e-6  # m: vertical coordinates nearer to one another along the body are averaged
SPARE = 8  # modes computed beyond those wanted: rigid motions, and some that are left out


@dataclass(frozen=True, eq=False)
class BodyMatrices:
    """M and K of a free car body, and which coordinates are heights of its centre line.

    Parameters
    ----------
    source : where they come from, for messages.
    M, K : (n, n), dense or sparse, kg and N/m for displacements in m; symmetric, positive
        semi-definite.
    x : (n,) places of the coordinates, m forward of the body's middle.
    vertical : (n,) 1 of a height, -1 of one that counts downwards, 0 of anything else.

    Raises
    ------
    InputError : with all faults at once: shapes that do not fit together; entries that are not
        finite; matrices that are not symmetric, not positive semi-definite, or that leave a
        coordinate without mass and stiffness.
    """

    source: str
    M: Matrix
    K: Matrix
    x: Array
    vertical: Array

    def __post_init__(self) -> None:
        from scipy.sparse import csc_array

        faults = Faults(self.source)
        for name in ("M", "K"):
            A = getattr(self, name)
            if len(A.shape) != 2 or A.shape[0] != A.shape[1]:
                faults.add(name, f"an array of shape {A.shape}", "a square matrix")
            else:
                object.__setattr__(self, name, csc_array(A, dtype=float))
        for name in ("x", "vertical"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=float))
        faults.raise_if_any()
        self._check_shapes(faults)
        faults.raise_if_any()
        self._check_symmetry(faults)
        faults.raise_if_any()
        self._check_definiteness(faults)
        faults.raise_if_any()

    @cached_property
    def _heights(self) -> tuple[Array, Any]:
        """Distinct places of the heights (p,), and the matrix (p, n) that averages them there."""
        from scipy.sparse import csr_array

        own = np.flatnonzero(self.vertical)
        own = own[np.argsort(self.x[own], kind="stable")]
        group = np.concatenate([[0], np.cumsum(np.diff(self.x[own]) > SAME)])
        share = self.vertical[own] / np.bincount(group)[group]
        places = np.bincount(group, self.x[own]) / np.bincount(group)
        return places, csr_array((share, (group, own)), (len(places), len(self.x)))

    def point_modes(self, count: int) -> PointModes:
        """Heave, pitch and the first ``count`` modes that bend the centre line, or all.

        Raises
        ------
        InputError : matrices that lack the rigid motions.
        """
        n, wanted = self.M.shape[0], count + SPARE
        while True:
            squares, modes = lowest_modes(self.M, self.K, min(wanted, n))
            hertz = np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi)
            x, average = self._heights
            heights = average @ modes
            rigid = hertz < RIGID
            mass, centre, inertia = self._rigid_body(x, heights[:, rigid], hertz)
            moves = ~rigid & (np.abs(heights).max(axis=0) > AT_REST / np.sqrt(mass))
            if moves.sum() >= count or wanted >= n:
                break
            wanted *= 2
        kept = np.flatnonzero(moves)[:count]
        left_out = int((~rigid & ~moves)[: kept[-1] + 1].sum()) if kept.size else 0
        remark = f"{left_out} modes that do not bend the body's centre line are left out"
        return PointModes(
            self.source, x, np.concatenate([[0.0, 0.0], hertz[kept]]),
            np.concatenate([[mass, inertia], np.ones(kept.size)]),
            np.vstack([np.ones_like(x), x - centre, heights[:, kept].T]),
            remarks=(remark,) if left_out else (),
        )  # fmt: skip

    def _rigid_body(self, x: Array, heights: Array, hertz: Array) -> tuple[float, float, float]:
        """Mass, mass centre and pitch inertia by the rigid motions' heights (p, r)."""
        faults = Faults(self.source)
        straight = np.column_stack([np.ones_like(x), x])
        C = np.linalg.lstsq(straight, heights, rcond=None)[0]
        size = np.linalg.svd(C * [[1.0], [np.ptp(x) / 2]], compute_uv=False)
        rank = int((size > 1e-3 * size[0]).sum()) if size.size else 0
        if rank < 2:
            lowest = ", ".join(f"{f:.3g}" for f in hertz[:3])
            faults.add("rigid motions", f"{rank} along the centre line, the lowest natural "
                       f"frequencies being {lowest} Hz", f"heave and pitch below {RIGID:g} Hz",
                       "free the body from supports and suspension, and write the matrices with "
                       "all digits")  # fmt: skip
            faults.raise_if_any()
        off = np.abs(heights - straight @ C).max() / np.abs(heights).max()
        if not off <= STRAIGHT:
            faults.add("rigid motions", f"heights that depart from a straight line by {off:.1%}",
                       "heights of one line along the body", "mark as vertical those on the centre "
                       "line, or pairs on either side of it at the same x")  # fmt: skip
            faults.raise_if_any()
        G = np.linalg.inv(C @ C.T)
        centre = G[0, 1] / G[0, 0]
        return float(G[0, 0]), float(centre), float(G[1, 1] - G[0, 0] * centre**2)

    def _check_shapes(self, faults: Faults) -> None:
        n = self.M.shape[0]
        if self.K.shape != self.M.shape:
            faults.add("K", f"shape {self.K.shape}", f"{self.M.shape}, that of M")
        for name in ("x", "vertical"):
            if getattr(self, name).shape != (n,):
                faults.add(name, f"shape {getattr(self, name).shape}",
                           f"({n},), one for each coordinate")  # fmt: skip
        for name in ("M", "K", "x", "vertical"):
            A = getattr(self, name)
            if not np.isfinite(A.data if name in {"M", "K"} else A).all():
                faults.add(name, "an entry that is no finite number", "finite numbers")
        odd = np.setdiff1d(self.vertical, (-1.0, 0.0, 1.0))
        if odd.size or not self.vertical.any():
            faults.add("vertical", f"{odd[0]:g}" if odd.size else "zeros only", "1 for heights of "
                       "the centre line, -1 downwards, 0 for anything else")  # fmt: skip

    def _check_symmetry(self, faults: Faults) -> None:
        for name in ("M", "K"):
            A = getattr(self, name)
            largest, off = np.abs(A).max(), np.abs(A - A.T).tocoo()
            if not largest > 0:
                faults.add(name, "zeros only", "a matrix of the car body")
            elif off.nnz and off.data.max() > SYMMETRIC * largest:
                worst = int(off.data.argmax())
                i, j = int(off.row[worst]), int(off.col[worst])
                faults.add(name, f"{A[i, j]:g} in row {i + 1}, column {j + 1}, but {A[j, i]:g} in "
                           f"row {j + 1}, column {i + 1}", "a symmetric matrix",
                           "is only one triangle written?")  # fmt: skip
        empty = np.flatnonzero((self.M.diagonal() == 0) & (self.K.diagonal() == 0))
        if empty.size:
            faults.add(f"row {empty[0] + 1}", f"neither mass nor stiffness ({empty.size} such)",
                       "coordinates that have one of them", "leave it out of M and K")  # fmt: skip

    def _check_definiteness(self, faults: Faults) -> None:
        from scipy.sparse import diags_array

        M, K = self.M, self.K
        weight = np.where(M.diagonal() == 0, M.diagonal().max(), np.abs(M.diagonal()))
        for name, A in (("M", M + diags_array(NEGATIVE * weight)),
                        ("K", K + (2 * np.pi * RIGID) ** 2 * M)):  # fmt: skip
            negative = negative_eigenvalues(A)
            if negative:
                faults.add(name, f"{negative} negative eigenvalue{'s' * (negative != 1)}, the "
                           f"least {_least_eigenvalue(A):.3g} where the diagonal is scaled to 1",
                           "a positive semi-definite matrix: no motion has a negative energy",
                           "a sign, or an entry that is missing?")  # fmt: skip
                return


def _least_eigenvalue(A: Matrix) -> float:
    """The most negative one of D^(-1/2) A D^(-1/2), D = |diag A|, which has no unit, to 0.1 %.

    Bisected by how many A + tD has, geometrically up to Gershgorin's bound.
    """
    from scipy.sparse import diags_array, eye_array

    size = np.abs(A.diagonal())
    scale = diags_array(1 / np.sqrt(np.where(size > 0, size, size.max() or 1.0)))
    scaled, one = scale @ A @ scale, eye_array(A.shape[0])
    low, high = np.finfo(float).eps, 1.01 * float(np.abs(scaled).sum(axis=0).max())
    while high > 1.001 * low:
        middle = np.sqrt(low * high)
        if negative_eigenvalues(scaled + middle * one):
            low = middle
        else:
            high = middle
    return -float(low)
