r"""What moves in a mode: names after the free motions, and shapes of modes that coincide.

The free body's heave, pitch and bending shapes and the bogies' heave and pitch, b_k, are orthogonal
in M and complete. An oscillating mode φ is named after the motion that holds most of its kinetic
energy, of which the shares

.. math:: |b_k^T M \varphi|^2 / (b_k^T M b_k \cdot \varphi^* M \varphi)

add up to one; no motion names two modes. A real eigenvalue hardly moves masses, its energy is in
the springs: where a locked bogie creeps, the body rides along and would name the mode. It is named
after the geometric mean of the share and of the motion's participation,

.. math:: p_{kj} = w_j^T P_k v_j , \qquad \sum_k p_{kj} = 1 , \quad \sum_j p_{kj} = 2 ,

the part of the eigenvector v_j that lies in height and rate of motion k, seen by the left
eigenvector w_j: how much of the motion, let go, decays so. A motion that names no oscillating mode
names a real one at least. Strokes of dampers on elastic mounts are one state each, and as many real
eigenvalues, those that they participate in most, are their relaxation.

Source: R.J. Allemang, Sound and Vibration 37 (2003), No. 8, 14-21: modal assurance, here with M as
weight. I.J. Pérez-Arriaga, G.C. Verghese, F.C. Schweppe, IEEE Trans. PAS 101 (1982), 3117-3125:
participation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.firstorder import FirstOrder
from railride.numeric import Array, Matrices
from railride.running_gear import secondary_stroke
from railride.vehicle import VehicleModel

ComplexArray = NDArray[np.complex128]

DAMPER = "damper"  # name of a real eigenvalue: a damper relaxing on its elastic mount
BOGIE = ("bogie heave", "bogie pitch")
SAME = 1e-7  # of |λ|: eigenvalues so close to one another are one eigenvalue, repeated
PARALLEL = 1e-6  # sine between eigenvectors: below it an eigenvalue lacks one (critical damping)
TOGETHER = 0.5  # of the largest amplitude: a bogie that moves less takes no part


@dataclass(frozen=True)
class Name:
    """What a mode is called: its label, the label's share (0 to 1), and the bogies' phase."""

    label: str
    share: float
    phase: str


@dataclass(frozen=True)
class Motions:
    """The free motions: a label for each, and their shapes as columns of ``basis`` (n, motions).

    strokes : of the secondary and of the primary dampers, from the front, numbered as the
        coordinates without mass are.
    """

    labels: tuple[str, ...]
    basis: Array
    bogies: int
    strokes: tuple[tuple[int, ...], ...]

    def amplitudes(self, M: Array, shapes: ComplexArray) -> ComplexArray:
        """a_k = b_kᵀ M φ / (b_kᵀ M b_k)^½ of shapes (n, modes): array (motions, modes)."""
        own = np.einsum("ik,ij,jk->k", self.basis, M, self.basis)
        return np.asarray((self.basis.T @ M @ shapes) / np.sqrt(own)[:, np.newaxis])

    def by_label(self, shares: Array) -> tuple[list[str], Array]:
        """The labels, each once, and the sum of their motions' shares: array (labels, modes)."""
        labels = list(dict.fromkeys(self.labels))
        of = np.array([labels.index(label) for label in self.labels])
        return labels, np.array([shares[of == k].sum(axis=0) for k in range(len(labels))])


def free_motions(model: VehicleModel, A: Matrices) -> tuple[list[str], Array]:
    """Labels, and shapes as columns, of the free body's, the equipment's, the bogies' motions."""
    n, bogies = A.M.shape[-1], len(model.vehicle.bogies)
    inertial = int(A.inertial.sum())
    hung = [f"equipment {e}" for e in model.carried.equipment]
    own = inertial - 2 * bogies - len(hung)
    labels = ["heave", "pitch", *(f"bending {k}" for k in range(1, own - 1)), *hung]
    basis = np.eye(n)[:, :inertial]
    basis[:own, :own] = _free_body_shapes(model, A.M[:own, :own])
    return labels + [*BOGIE] * bogies, basis


def motions(model: VehicleModel, A: Matrices) -> Motions:
    """The free motions of a vehicle, at its matrices A."""
    labels, basis = free_motions(model, A)
    names = [q.name for q in model.running_gear.strokes]
    secondary = {secondary_stroke(b).name for b in model.running_gear.bogies}
    strokes = (tuple(k for k, name in enumerate(names) if name in secondary),
               tuple(k for k, name in enumerate(names) if name not in secondary))  # fmt: skip
    return Motions(tuple(labels), basis, len(model.vehicle.bogies), strokes)


def _free_body_shapes(model: VehicleModel, M: Array) -> Array:
    """Heave, pitch about the mass centre, and the bending shapes, as columns."""
    heave = model.lift[: len(M)]
    turn = model.pitch()[: len(M)]
    pitch = turn - heave * (heave @ M @ turn) / (heave @ M @ heave)
    K = model.free_body_stiffness()
    inverse = np.linalg.inv(np.linalg.cholesky(M))
    _, vectors = np.linalg.eigh(inverse @ K @ inverse.T)
    return np.column_stack([heave, pitch, inverse.T @ vectors[:, 2:]])


def settled(
    free: Motions, A: Matrices, x: FirstOrder, roots: ComplexArray, vectors: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues and eigenvectors, those of a repeated one as the least coupling would have them.

    Where two equal bogies, say, do not feel one another, every mixture of their motions is a mode.
    The least coupling of neighbours leaves those in which they move with and against each other:
    the mixtures that diagonalise a form in which neighbouring bogies are coupled and motions of
    different names are told apart. The repeated eigenvalues are put to their mean, and where
    bogies move in phase comes first. What has one eigenvector only is left as it is.
    """
    G = _coupling(free, A, x)
    E = energy(A, x)
    # Rounding may split a repeated real eigenvalue into a pair.
    roots = np.where(np.abs(roots.imag) <= SAME * np.abs(roots), roots.real, roots)
    values, result = roots.copy(), vectors.copy()
    done = np.zeros(roots.size, dtype=bool)
    for k, root in enumerate(roots):
        if done[k] or root.imag < 0:
            continue
        equal = np.flatnonzero((np.abs(roots - root) <= SAME * abs(root)) & ~done)
        done[equal] = True
        if equal.size == 1:
            continue
        V = vectors[:, equal] / np.sqrt(_form(E, vectors[:, equal]))
        size, mix = np.linalg.eigh(V.conj().T @ E @ V)
        if size[0] < PARALLEL**2:
            continue
        V = V @ (mix / np.sqrt(size))
        _, mix = np.linalg.eigh(V.conj().T @ G @ V)
        values[equal], result[:, equal] = roots[equal].mean(), V @ mix
        if root.imag:
            for place in equal:  # the conjugates are repeated as well
                mirrored = np.where(done, np.inf, np.abs(roots - roots[place].conj()))
                other = int(np.argmin(mirrored))
                values[other], result[:, other] = values[place].conj(), result[:, place].conj()
                done[other] = True
    return values, result


def energy(A: Matrices, x: FirstOrder) -> Array:
    """E, half the sum of K for the heights and M for the rates: x* E x is a state's energy, J."""
    n = len(A.M)
    E = np.zeros((x.A.shape[0],) * 2)
    E[:n, :n] = A.K[np.ix_(x.order, x.order)] / 2
    E[n:, n:] = A.M[np.ix_(x.inertial, x.inertial)] / 2
    return E


def _form(E: Array, X: ComplexArray) -> Array:
    return np.asarray(np.einsum("ij,ik,kj->j", X.conj(), E, X).real)


def _coupling(free: Motions, A: Matrices, x: FirstOrder) -> Array:
    """A form in x that tells all motions apart and couples neighbours, the mirror image's too."""
    own = np.einsum("ik,ij,jk->k", free.basis, A.K, free.basis)
    count = len(free.labels)
    levels = {label: 4.0 * k for k, label in enumerate(dict.fromkeys(free.labels))}
    G = np.diag([levels[label] for label in free.labels])
    for kind in range(2):
        at = count - 2 * free.bogies + kind + 2 * np.arange(free.bogies)
        G[at[1:], at[:-1]] = G[at[:-1], at[1:]] = -1.0
    rows = np.linalg.inv(free.basis[x.inertial]) * np.sqrt(own)[:, np.newaxis]
    form = np.zeros_like(x.A)
    form[:count, :count] = rows.T @ G @ rows
    held: Array = np.sqrt(np.diagonal(A.K)[~x.inertial])
    for level, strokes in enumerate(free.strokes, start=1):
        place = np.array(strokes, dtype=int)
        at, size = count + place, held[place]
        form[at, at] = -4.0 * level * size**2
        form[at[1:], at[:-1]] = form[at[:-1], at[1:]] = -size[1:] * size[:-1]
    return form


def participation(free: Motions, x: FirstOrder, vectors: ComplexArray) -> Array:
    """|p_kj| of every motion, then of all strokes together: array (motions + 1, eigenvalues).

    vectors : (s, s), all eigenvectors of x' = A x as columns. Each column adds up to 1.
    """
    count, n = len(free.labels), x.q_x.shape[0]
    V = vectors / np.linalg.norm(vectors, axis=0)
    try:
        W = np.linalg.inv(V)
    except np.linalg.LinAlgError:  # critical damping to the last bit: two eigenvectors are one
        W = np.linalg.pinv(V)
    B = free.basis[x.inertial]
    to = np.linalg.inv(B)
    heights = (to @ V[:count]) * (W[:, :count] @ B).T
    rates = (to @ V[n:]) * (W[:, n:] @ B).T
    strokes = (V[count:n] * W[:, count:n].T).sum(axis=0, keepdims=True)
    size = np.abs(np.vstack([heights + rates, strokes]))
    return np.asarray(size / size.sum(axis=0))


def names(
    free: Motions, M: Array, shapes: ComplexArray, oscillating: NDArray[np.bool_], parts: Array,
    strokes: int,
) -> list[Name]:  # fmt: skip
    """The name of each mode: shapes (n, modes) and parts (motions + 1, modes) of their own."""
    amplitudes = free.amplitudes(M, shapes)
    kinetic = np.abs(amplitudes) ** 2
    labels, shares = free.by_label(kinetic / kinetic.sum(axis=0))
    _, part = free.by_label(parts[:-1])
    creeping = np.sqrt(shares * part)
    creeping = creeping / creeping.sum(axis=0)
    left = np.array([free.labels.count(label) for label in labels])
    pairs, real = np.flatnonzero(oscillating), np.flatnonzero(~oscillating)
    found: dict[int, tuple[str, float]] = {}
    for j, k in zip(pairs, assign(shares[:, pairs], left), strict=True):
        found[int(j)] = labels[k], float(shares[k, j])
        left[k] -= 1
    order = real[np.argsort(-parts[-1, real], kind="stable")]
    for j in order[:strokes]:
        found[int(j)] = DAMPER, float(parts[-1, j])
    creeps = np.sort(order[strokes:])
    unnamed = np.repeat(np.arange(left.size), left)[: creeps.size]
    given = np.argmax(creeping[:, creeps], axis=0)
    given[assign(creeping[unnamed][:, creeps].T, np.ones_like(creeps))] = unnamed
    for j, k in zip(creeps, given, strict=True):
        found[int(j)] = labels[k], float(creeping[k, j])
    return [Name(*found[j], _phase(free, found[j][0], amplitudes[:, j]))
            for j in range(shapes.shape[1])]  # fmt: skip


def assign(shares: Array, places: NDArray[np.int_]) -> list[int]:
    """Which label each mode gets: the largest sum of shares, none given oftener than ``places``.

    shares : (labels, modes). The largest shares first, then exchanges as long as they gain.

    >>> assign(np.array([[0.9, 0.8], [0.1, 0.2]]), np.array([1, 1]))
    [0, 1]
    """
    left, given = places.copy(), np.full(shares.shape[1], -1)
    for flat in np.argsort(-shares, axis=None, kind="stable"):
        label, mode = divmod(int(flat), shares.shape[1])
        if given[mode] < 0 and left[label] > 0:
            given[mode] = label
            left[label] -= 1
    every = np.arange(given.size)
    while given.size > 1:
        own = shares[given, every]
        gain = shares[given[np.newaxis, :], every[:, np.newaxis]]  # mode i under the label of j
        gain = gain + gain.T - own - own[:, np.newaxis]
        i, j = divmod(int(np.argmax(gain)), given.size)
        if gain[i, j] <= 1e-9:
            break
        given[[i, j]] = given[[j, i]]
    return [int(label) for label in given]


def _phase(free: Motions, label: str, amplitudes: ComplexArray) -> str:
    """Whether all bogies move with their neighbours, or each against them; else nothing."""
    if label not in BOGIE or free.bogies < 2:
        return ""
    own = amplitudes[[k for k, name in enumerate(free.labels) if name == label]]
    if np.abs(own).min() < TOGETHER * np.abs(own).max():
        return ""
    turned = np.cos(np.angle(own[1:] / own[:-1]))
    if (turned > TOGETHER).all():
        return "in phase"
    return "anti-phase" if (turned < -TOGETHER).all() else ""
