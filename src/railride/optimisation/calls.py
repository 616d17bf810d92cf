"""The calls: parameters of a vehicle chosen for comfort, within limits or against travel."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from railride.designs.given import Tracks, given_cases
from railride.errors import Faults, InputError
from railride.optimisation.optimum import Optimum
from railride.optimisation.pareto import ParetoFront
from railride.optimisation.solve import Progress
from railride.optimisation.task import Front, task_of
from railride.optimisation.variables import Ranges
from railride.stochastic.extremes import DISTANCE
from railride.vehicle import VehicleModel
from railride.weightings import Weighting


def optimise(
    model: VehicleModel,
    parameters: Ranges,
    speeds: float | Sequence[float],
    track: Tracks | Sequence[Tracks] = "erri_low",
    at: float | Sequence[float] = (0.0,),
    *,
    limits: Mapping[str, Any] | None = None,
    objective: str = "mean",
    weights: Sequence[float] | None = None,
    search: str = "gradient",
    starts: int = 1,
    seed: int = 0,
    distance: float = DISTANCE,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    progress: Progress | None = None,
) -> Optimum:
    r"""Choose parameters of a vehicle so that a_wrms is least, within limits.

    .. math:: \sqrt{\sum_k w_k a_k^2 \Big/ \sum_k w_k} \quad\text{or}\quad \max_k a_k

    over all cases k, the exact stochastic values of every track, speed and position.

    Parameters
    ----------
    model : the vehicle as it is, from which the search starts.
    parameters : symbol or key of parameter files → lower and upper bound, SI.
    speeds : m/s, each > 0. track : spectra or tracks, their names or files, one or several.
    at : points of the floor, m forward of the body's middle.
    limits : kind → bound, SI. "secondary_travel", "primary_travel": expected peak over the
        distance, m; "secondary_travel_rms", "primary_travel_rms": m; "wheel_load_variation":
        r.m.s. of the dynamic load (low-passed at 20 Hz) over the static one; these at most.
        "damping_ratio": at least, a number for all modes or label → number. "secondary_static",
        "primary_static": static deflection, from and to, m, None for neither.
    objective : "mean" (root of the mean of squares) or "worst" (case).
    weights : of the squares in the mean, one for each case, tracks outermost, positions innermost.
    search : "gradient"; or "global", differential evolution, then the gradient method.
    starts : of the gradient method: the vehicle as it is, then points of Sobol's sequence by the
        seed. distance : m, over which peaks are expected.
    floor : how it is read. weight : a weighting or its name. progress : called with the fraction
        done.

    Raises
    ------
    InputError : parameters, ranges or limits that cannot be; limits that no design within the
        ranges was found to keep: which, and by how much; a design without a stationary ride.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> found = optimise(coach, {"secondary_damping": (20e3, 150e3)}, 200 / 3.6,
    ...                  limits={"damping_ratio": {"heave": 0.15}})
    >>> found.converged, [state.limit.name for state in found.limits if state.binds]
    (True, ['damping_ratio of heave'])
    """
    task = task_of(model, parameters, given_cases(model, track, speeds, at, floor, weight),
                   limits=limits or {}, objective=objective, weights=weights, search=search,
                   starts=starts, seed=seed, distance=distance)  # fmt: skip
    return task.run(progress)


def pareto_front(
    model: VehicleModel,
    parameters: Ranges,
    speeds: float | Sequence[float],
    track: Tracks | Sequence[Tracks] = "erri_low",
    at: float | Sequence[float] = (0.0,),
    *,
    against: str = "secondary_travel",
    points: int = 11,
    progress: Progress | None = None,
    **options: Any,
) -> ParetoFront:
    """How much comfort more suspension travel buys: the best designs for every amount of it.

    Parameters
    ----------
    model, parameters, speeds, track, at : as for :func:`optimise`.
    against : "secondary_travel", "primary_travel", these with "_rms", or "wheel_load_variation":
        what is traded for comfort, the largest over suspensions and cases.
    points : how many are tried, 2 to 200. progress : called with the fraction done.
    options : limits, objective, weights, search, starts, seed, distance, floor, weight of
        :func:`optimise`.

    Raises
    ------
    InputError : as :func:`optimise`.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=1)
    >>> ranges = {"secondary_damping": (40e3, 150e3), "secondary_stiffness": (4e5, 12e5)}
    >>> found = pareto_front(coach, ranges, 200 / 3.6, points=4)
    >>> found.travel[0] < found.travel[-1], found.a_wrms[0] > found.a_wrms[-1]
    (np.True_, np.True_)
    """
    read = {name: options.pop(name) for name in ("floor", "weight") if name in options}
    cases = given_cases(model, track, speeds, at, **read)
    asked = Front(against, points)
    faults = Faults("pareto")
    asked.note_faults(model, faults)
    faults.raise_if_any()
    task = task_of(model, parameters, cases, **options)
    found = replace(task, front=asked).run(progress)
    if found.front is None:
        raise InputError("pareto: found no front")
    return replace(found.front, remarks=found.remarks)
