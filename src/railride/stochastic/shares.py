r"""Which mode the comfort value comes from.

Modal residues write the response of an output as a sum over modes, H = Σ_k H_k + H_d, H_d what the
track does to it directly (nothing, for the floor's acceleration on dampers without mass: H_d = 0).
The weighted mean square is

.. math:: \overline{a_w^2} = \sum_k \int |W|^2\, \mathrm{Re}(\overline{H_k} H)\, S_w\, df

so that each mode has its own square and half of what it shares with every other: the parts add up
to one. A part below zero belongs to a mode that cancels more of the others' motion than it adds.

A mode is a pair λ, λ* or a real λ; modes of one name (two bogies' heave, say) count together, and
so do modes of several names whose eigenvalues nearly coincide: what a single one of them holds is
then a matter of rounding, their sum is not.

Source: L. Meirovitch, Fundamentals of Vibrations, McGraw-Hill 2001, Sections 7.9 and 7.16 (modal
analysis in first order), with the square of the sum divided evenly between its terms.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.firstorder import FirstOrder, first_order
from railride.modal import Mode, modes
from railride.numeric import Array, Matrices
from railride.quantities import several
from railride.spectra import Spectrum
from railride.stochastic.gains import PLAIN, weighted
from railride.stochastic.measured import track_spectrum
from railride.stochastic.process import process
from railride.stochastic.ride import floor_in_hand
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

Complex = NDArray[np.complex128]

CLOSE = 1e-6  # of |λ|: eigenvalues nearer than this are one
DIRECT = "direct"


def mode_shares(
    model: VehicleModel,
    speed: float,
    track: str | Path | Spectrum | Track,
    at: float | Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    **changes: ArrayLike,
) -> pd.DataFrame:
    """Share of every mode in the weighted mean square of the floor's acceleration.

    Parameters
    ----------
    speed : V in m/s, > 0. track : a spectrum or its name, a track or its file.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    weight : a weighting or its name.
    changes : parameter values in place of the vehicle's.

    Returns
    -------
    table : "position [m]", "mode", "frequency [Hz]", "damping ratio" (of the first of its name),
        "share" of a_wrms², by position and frequency; the shares of a position add up to 1.
        ``table.attrs["remarks"]`` : what to know of the track.

    Raises
    ------
    InputError : as :func:`stochastic_ride`.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> table = mode_shares(coach, 200 / 3.6, "erri_low")
    >>> table["mode"][table["share"].idxmax()]
    'bending 1'
    """
    import pandas as pd

    spectrum, remarks = track_spectrum(track, [speed])
    at = several(at, "at", "m")
    m, rows = floor_in_hand(model, at, floor, changes)
    gain = weighted(weighting(weight))
    places = model.wheelset_places(**changes).tolist()
    whole = process(m, rows, places, speed, spectrum, (gain, PLAIN))
    whole.integrals()  # refuses modes that never settle
    x = first_order(m)
    roots, vectors = np.linalg.eig(x.A)
    named = modes(model, **changes)
    names = _names(roots.astype(complex), named)
    groups = list(dict.fromkeys(name for _, name in sorted(zip(np.abs(roots), names, strict=True))))
    member = np.array([[name == group for name in names] for group in groups], dtype=float)
    residues = _Residues(m, rows, x, roots, vectors)
    squares = np.zeros((len(at), len(groups) + 1))
    for _, f, df, _ in whole.pieces():
        w = np.asarray(np.exp(-whole.delays[:, np.newaxis] * (2j * np.pi * f)), dtype=complex)
        parts = residues.parts(np.asarray(2j * np.pi * f, dtype=complex), w, member)
        H = parts.sum(axis=1, keepdims=True)
        density = gain.power(f) * whole.elevation_density(f) * df
        squares += (parts.conj() * H).real @ density
    shares = squares / np.maximum(squares.sum(axis=1, keepdims=True), np.finfo(float).tiny)
    keep = [*range(len(groups)), *([len(groups)] if residues.direct else [])]
    first = {group: _first(group, named) for group in groups}
    table = pd.DataFrame(
        [
            {
                "position [m]": float(place),
                "mode": group,
                "frequency [Hz]": first[group].frequency_hz if group in first else None,
                "damping ratio": first[group].damping_ratio if group in first else None,
                "share": float(shares[k, j]),
            }
            for k, place in enumerate(at)
            for j, group in ((j, [*groups, DIRECT][j]) for j in keep)
        ]
    )
    table.attrs["remarks"] = remarks
    return table


class _Residues:
    """y = Σ_k C φ_k (ψ_kᵀ B F)/(s - λ_k) + D, with C, D of outputs in first order."""

    def __init__(
        self, m: Matrices, rows: Mapping[str, Array], x: FirstOrder, roots: Array, vectors: Array
    ) -> None:
        self.roots = roots
        C = rows["d"] @ x.q_x + rows["v"] @ x.v_x + rows["a"] @ x.a_x
        forces = np.hstack([m.K_w, m.C_w])
        self.out = C @ vectors
        self.into = np.linalg.solve(vectors, (x.B @ forces).astype(complex))
        felt = (rows["v"] @ x.v_f + rows["a"] @ x.a_f) @ forces
        self.through = felt + np.hstack([rows["w"], rows["dw"]])
        self.second = rows["ddw"]
        small = 1e-12 * np.abs(C @ x.B @ forces).max(initial=0.0)
        self.direct = bool((np.abs(self.through) > small).any() or self.second.any())

    def parts(self, s: Complex, w: Complex, member: Array) -> Complex:
        """H_k of every group and what is direct: shape (outputs, groups + 1, F)."""
        excitation = np.concatenate([w, s * w])
        modal = (self.into @ excitation) / (s - self.roots[:, np.newaxis])
        grouped = np.einsum("ok,gk,kf->ogf", self.out, member, modal, optimize=True)
        direct = self.through @ excitation + s**2 * (self.second @ w)
        return np.concatenate([grouped, direct[:, np.newaxis]], axis=1)


def _names(roots: Complex, named: Sequence[Mode]) -> list[str]:
    """The mode's name of every eigenvalue; names that share one are joined."""
    known = np.array([mode.eigenvalue for mode in named])
    upper = np.where(roots.imag < 0, roots.conj(), roots)
    near = np.abs(upper[:, np.newaxis] - known)
    joined = {mode.label: {mode.label} for mode in named}
    for i, one in enumerate(known):
        for j in np.flatnonzero(np.abs(known - one) < CLOSE * np.abs(one)).tolist():
            both = joined[named[i].label] | joined[named[j].label]
            for label in both:
                joined[label] = both
    labels = [named[k].label for k in near.argmin(axis=1).tolist()]
    return [" + ".join(sorted(joined[label])) for label in labels]


def _first(group: str, named: Sequence[Mode]) -> Mode:
    """The lowest mode of a group."""
    return next(mode for mode in named if mode.label in group.split(" + "))
