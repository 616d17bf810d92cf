r"""The modes of many designs, each called after the mode of the model that it is alike.

Of all ways to pair the eigenvalues λ_i of the model, states x_i, with those of a design, the one
with the least sum of

.. math:: \frac{|\lambda_i - \lambda_j|}{|\lambda_i| + |\lambda_j|} + 1
          - \frac{|x_i^* E x_j|^2}{x_i^* E x_i\; x_j^* E x_j}, \qquad
          E = \tfrac12 \begin{pmatrix} K & \\ & M \end{pmatrix},

the second part one less the modal assurance of the states x = (q, q̇), with the model's energy as
weight: mostly the shapes decide. Where a pair of the model's is two real eigenvalues in a design,
one of those goes by its name.

Source: R.J. Allemang, Sound and Vibration 37 (2003), No. 8, 14-21 (modal assurance); H.W. Kuhn,
Naval Research Logistics Quarterly 2 (1955), 83-97 (assignment).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.modal import Mode, refuse_rounded, solve
from railride.naming import energy
from railride.numeric import Array
from railride.stochastic.fractions import Complex, EigenForms
from railride.vehicle import VehicleModel


def mode_names(modes: Sequence[Mode]) -> tuple[str, ...]:
    """Label and phase of each mode; what is left alike is numbered: "bogie pitch (2)"."""
    names = [", ".join(filter(None, (mode.label, mode.phase))) for mode in modes]
    often, found, seen = Counter(names), [], Counter[str]()
    for name in names:
        seen[name] += 1
        found.append(f"{name} ({seen[name]})" if often[name] > 1 else name)
    return tuple(found)


class KnownModes:
    """The modes of a model, to know those of designs by; raises as ``railride.modes``."""

    def __init__(self, model: VehicleModel) -> None:
        own = solve(model)
        self.names = mode_names(own.modes)
        self._kept, self._roots = own.kept, own.roots
        E = energy(own.A, own.x)
        size = np.sqrt(np.einsum("ik,ij,jk->k", own.vectors.conj(), E, own.vectors).real)
        self._seen_by, self._energy = (own.vectors / size).conj().T @ E, E

    def values(self, forms: EigenForms) -> tuple[dict[str, Array], dict[int, str]]:
        """``natural_frequency``, Hz, and ``damping_ratio``, (D, modes); ``least_damping_ratio``.

        NaN for designs of which rounding decides a mode, and why, by their places.
        """
        roots, refused = forms.poles.copy(), {}
        for d, own in enumerate(roots):
            try:
                refuse_rounded(own)
            except InputError as error:
                refused[d], own[:] = str(error), np.nan
        mine = self._mine(forms.poles, forms.vectors)[:, self._kept]
        named = np.take_along_axis(roots, mine, axis=1)
        return {
            "natural_frequency": np.abs(named) / (2 * np.pi),
            "damping_ratio": -named.real / np.abs(named),
            "least_damping_ratio": (-roots.real / np.abs(roots)).min(axis=1),
        }, refused

    def _mine(self, roots: Complex, vectors: Complex) -> NDArray[np.int_]:
        """Which of a design's eigenvalues goes with each of the model's, (D, s)."""
        from scipy.optimize import linear_sum_assignment

        sizes = np.einsum("dik,dik->dk", vectors.conj(), self._energy @ vectors).real
        assurance = np.abs(self._seen_by @ vectors) ** 2 / sizes[:, np.newaxis]
        theirs, known = roots[:, np.newaxis], self._roots[:, np.newaxis]
        away = np.abs(theirs - known) / (np.abs(theirs) + np.abs(known))
        cost = away + 1 - assurance
        nearest = cost.argmin(axis=2)
        ordered = np.sort(nearest, axis=1)
        for d in np.flatnonzero((np.diff(ordered, axis=1) == 0).any(axis=1)).tolist():
            nearest[d] = linear_sum_assignment(cost[d])[1]
        return np.asarray(nearest)
