r"""Root loci: the modes of a vehicle over one of its parameters, each followed on its way.

.. math:: (\lambda(p)^2 M(p) + \lambda(p) C(p) + K(p))\,\varphi(p) = 0

From one value of p to the next, every eigenvalue goes to the one that is near and moves alike: the
assignment with the least sum of

.. math:: \frac{|\lambda_i - \lambda_j|}{|\lambda_i| + |\lambda_j|} + 1
          - \frac{|x_i^* E x_j|^2}{x_i^* E x_i\; x_j^* E x_j} ,

the second part one less the modal assurance of the states x = (q, q̇), with energy as weight: it
tells curves apart where they cross, and a pair's upper from its lower half. A step in which one
moves far or changes its shape is halved until none does. Where a pair becomes real, its two
eigenvalues go on as two branches.

Source: R.J. Allemang, Sound and Vibration 37 (2003), No. 8, 14-21 (modal assurance); H.W. Kuhn,
Naval Research Logistics Quarterly 2 (1955), 83-97 (assignment).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import InputError
from railride.modal import Solution, solve
from railride.naming import energy
from railride.vehicle import VehicleModel

if TYPE_CHECKING:
    import pandas as pd

ALIKE = 0.9  # modal assurance between steps: below it a step is halved
NEAR = 0.1  # of |λ_i| + |λ_j|: farther, and a step is halved
HALVINGS = 12  # of one step: where a pair becomes real, its shapes change without limit
MOST_BETWEEN = 200  # values in one step, should nothing ever be without doubt


@dataclass(frozen=True, eq=False)
class _Point:
    """All eigenvalues at one value: states (s, s), in columns of energy 1."""

    value: float
    solution: Solution
    states: NDArray[np.complex128]


def mode_locus(model: VehicleModel, **parameter: ArrayLike) -> pd.DataFrame:
    """Eigenvalues over one parameter: a row for each value and mode, the modes of a value by |λ|.

    Parameters
    ----------
    parameter : ``name=values``, a symbol of :meth:`VehicleModel.values` (or its key in parameter
        files) and at least two values, SI, ascending; others may be changed to single numbers.

    Returns
    -------
    pandas.DataFrame : columns NAME (the parameter, SI), ``frequency_hz`` (|λ|/2π),
        ``damping_ratio``, ``real`` and ``imag`` (of λ, rad/s, imag ≥ 0), ``label`` (what moves most
        at this value), ``share``, ``branch`` (from 1; rows of one branch are one curve). Its
        ``attrs`` hold ``parameter``, ``unit`` and ``meaning``.

    Raises
    ------
    InputError : not one parameter with several values; values that are not finite and ascending; a
        name that the model does not have, with the list of those that it has; an unstable vehicle.

    Examples
    --------
    >>> from railride import load_vehicle, derive_vehicle
    >>> model = derive_vehicle(load_vehicle("cati2024"), segments=2)
    >>> locus = mode_locus(model, c_2=[50e3, 70e3, 90e3])
    >>> [round(zeta, 3) for zeta in locus[locus.label == "heave"].damping_ratio]
    [0.198, 0.278, 0.36]
    """
    import pandas as pd

    name, values, fixed = _varied(parameter)
    name = described(model, name)[0]
    model.values(**fixed)  # a wrong name is told before anything is solved
    points = [_point(model, name, value, fixed) for value in values.tolist()]
    branches = _follow(model, name, fixed, points)
    numbers: dict[int, int] = {}
    rows: list[dict[str, Any]] = []
    for point, branch in zip(points, branches, strict=True):
        for place, mode in zip(point.solution.kept, point.solution.modes, strict=True):
            number = numbers.setdefault(int(branch[place]), len(numbers) + 1)
            rows.append({
                name: point.value, "frequency_hz": mode.frequency_hz,
                "damping_ratio": mode.damping_ratio, "real": mode.eigenvalue.real,
                "imag": mode.eigenvalue.imag, "label": mode.label, "share": mode.share,
                "branch": number,
            })  # fmt: skip
    table = pd.DataFrame(rows)
    _, unit, meaning = described(model, name)
    table.attrs = {"parameter": name, "unit": unit, "meaning": meaning}
    return table


def described(model: VehicleModel, name: str) -> tuple[str, str, str]:
    """Symbol, unit and meaning of a parameter; unit and meaning empty where it follows from others.

    name : the symbol, or its key in parameter files.

    Raises
    ------
    InputError : a name that the model does not have, with the list of those that it has.
    """
    symbol = model.symbol_of(name)
    meaning, unit = model.meanings.get(symbol, ("", ""))
    return symbol, unit, meaning


def _varied(parameter: dict[str, Any]) -> tuple[str, NDArray[np.float64], dict[str, Any]]:
    """The name and values of the parameter that varies, and the others, which do not."""
    several = [name for name, value in parameter.items() if np.ndim(value) > 0]
    if len(several) != 1 or np.ndim(parameter[several[0]]) != 1:
        found = ", ".join(several) or "no parameter with several values"
        raise InputError(f"locus: found {found}; expected one list of values, of one parameter")
    name = several[0]
    fixed = {other: value for other, value in parameter.items() if other != name}
    try:
        values = np.asarray(parameter[name], dtype=float)
    except (TypeError, ValueError):
        found = f"{name}: found {parameter[name]!r}"
        raise InputError(f"{found}; expected numbers in SI units") from None
    if values.size < 2 or not np.isfinite(values).all() or not (np.diff(values) > 0).all():
        raise InputError(
            f"{name}: found {np.array2string(values, threshold=6, edgeitems=2)}; expected at least "
            "two finite values, ascending, each once"
        )
    return name, values, fixed


def _point(model: VehicleModel, name: str, value: float, fixed: dict[str, Any]) -> _Point:
    try:
        solution = solve(model, **{name: value}, **fixed)
    except InputError as error:
        raise InputError(f"{name} = {value:g}: {error}") from None
    L = np.linalg.cholesky(energy(solution.A, solution.x))
    states = L.T @ solution.vectors
    return _Point(value, solution, states / np.linalg.norm(states, axis=0))


def _follow(
    model: VehicleModel, name: str, fixed: dict[str, Any], points: list[_Point]
) -> list[NDArray[np.int_]]:
    """The branch of every eigenvalue at every point."""
    left = 0  # values that may still be put into the present step

    def between(first: _Point, last: _Point, halvings: int) -> NDArray[np.int_]:
        """Where each eigenvalue of the first point goes to at the last."""
        nonlocal left
        to, certain = _matched(first, last)
        if certain or halvings == 0 or left == 0:
            return to
        left -= 1
        middle = _point(model, name, (first.value + last.value) / 2, fixed)
        return between(middle, last, halvings - 1)[between(first, middle, halvings - 1)]

    branches = [np.arange(points[0].solution.roots.size)]
    for first, last in pairwise(points):
        left = MOST_BETWEEN
        branch = np.empty_like(branches[-1])
        branch[between(first, last, HALVINGS)] = branches[-1]
        branches.append(branch)
    return branches


def _matched(first: _Point, last: _Point) -> tuple[NDArray[np.int_], bool]:
    """Where each eigenvalue goes to, and whether there is no doubt."""
    from scipy.optimize import linear_sum_assignment

    a, b = first.solution.roots[:, np.newaxis], last.solution.roots
    distance = np.abs(a - b) / np.maximum(np.abs(a) + np.abs(b), np.finfo(float).tiny)
    alike = np.abs(first.states.conj().T @ last.states) ** 2
    # Two halves of a pair go to two real eigenvalues at the same cost: in their order.
    places = np.arange(b.size)
    tie = 1e-9 * np.abs(places[:, np.newaxis] - places)
    _, to = linear_sum_assignment(distance + 1 - alike + tie)
    certain = (alike[places, to] >= ALIKE).all() and (distance[places, to] <= NEAR).all()
    return np.asarray(to), bool(certain)
