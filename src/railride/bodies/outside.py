r"""A car body from outside: natural modes as a finite-element department hands them over.

The modes are scaled to the car body's mass, by :math:`\sqrt{m_c/m_i}`. Between the points they
follow cubic splines; beyond the outermost ones straight lines, as the end of a free body carries
neither moment nor force.

Masses M_k in the points show whether the motions belong together. What the heights leave of the
kinetic energy to others (turns of the cross-sections, motions sideways) is never negative:

.. math:: \delta_{ij} - \sum_k M_k \frac{\varphi_i(x_k)\,\varphi_j(x_k)}{\sqrt{m_i m_j}}
          \quad\text{has no negative eigenvalue,}

the uniform lift and the pitch among the φ. They leave nothing, so that no mode may share in them.

Source: D. J. Ewins, Modal Testing, Research Studies Press 2000, Sections 2.3 and 5.3. The bounds
below are the project's own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from railride.bodies.body_modes import HEAVE, PITCH, BodyModes
from railride.bodies.point_modes import PointModes
from railride.car_body import CarBody
from railride.errors import Faults
from railride.numeric import Array

AGREE = 0.01  # of mass, inertia and length: so near the vehicle's own
COMMON = 0.1  # of two motions' own products: more than lumping the mass leaves in common
NOTED = 0.01  # of these, or of a shape's largest value: more is said
EVEN = 0.3  # of two motions' own products: more than an uneven distribution of the mass explains
HEIGHTS = (1.0, 10.0)  # least of the highest mode and most of the lowest: a free beam's are 2
ALONE = (0.1, 30.0)  # of any one mode: one that is lower is doubted, one that is higher refused
FIRST = (2.0, 60.0)  # Hz, between which the first bending of a car body lies


def outside_modes(
    points: PointModes,
    body: CarBody,
    *,
    attachments: Sequence[float] = (),
    count: int | None = None,
) -> BodyModes:
    """Natural modes from outside as those of a vehicle's car body.

    Parameters
    ----------
    points : the modes in points along the body.
    body : whose mass, mass centre, pitch inertia and length they must fit within 1 %.
    attachments : places on the body, m, that the points must cover.
    count : how many flexible modes are kept, from the lowest; None: all.

    Raises
    ------
    InputError : with all faults at once: points off the body, or that do not cover the
        attachments; rigid motions or point masses of another body; motions that are not
        orthogonal; a modal mass of another scale; a mode known in too few points.
    """
    faults, remarks = Faults(points.source), list(points.remarks)
    _check_places(points, body, attachments, faults)
    _check_rigid(points, body, faults)
    faults.raise_if_any()
    hertz = points.frequencies[points.flexible]
    scale = np.sqrt(body.mass / points.modal_masses[points.flexible])
    shapes = scale[:, np.newaxis] * points.shapes[points.flexible]
    _check_scale(points, shapes, faults, remarks)
    faults.raise_if_any()  # no products of heights that are none
    _check_products(points, body, shapes, faults, remarks)
    _check_spacing(points, shapes, faults, remarks)
    faults.raise_if_any()
    if body.length / 2 - min(-points.x[0], points.x[-1]) > 2 * np.diff(points.x).max():
        remarks.append(f"beyond x = {points.x[0]:g} and {points.x[-1]:g} m the modes are not "
                       "known and go on as straight lines")  # fmt: skip
    if not FIRST[0] <= hertz[0] <= FIRST[1]:
        remarks.append(f"the first bending of the car body is at {hertz[0]:.3g} Hz: is a unit "
                       "wrong?")  # fmt: skip
    zeta = None if points.damping is None else points.damping[points.flexible]
    along, slopes = _interpolated(points.x, shapes)
    modes = BodyModes(
        body.mass, body.mass_centre, body.pitch_inertia, body.length, hertz, zeta, along, "modes",
        slopes=slopes, knots=tuple(points.x[1:-1].tolist()), remarks=tuple(remarks),
    )  # fmt: skip
    return modes if count is None else modes.first(count)


def _interpolated(x: Array, shapes: Array) -> tuple[Callable[[ArrayLike], Array], ...]:
    """Shapes (n, p) at x (p,) as functions, and their slopes: splines with straight ends."""
    from scipy.interpolate import CubicSpline

    spline = CubicSpline(x, shapes, axis=1)
    slope = spline.derivative()

    def along(at: ArrayLike) -> Array:
        at = np.asarray(at, dtype=float)
        inside = np.clip(at, x[0], x[-1])
        return np.asarray(spline(inside) + slope(inside) * (at - inside))

    return along, lambda at: np.asarray(slope(np.clip(at, x[0], x[-1])))


def _check_places(
    points: PointModes, body: CarBody, attachments: Sequence[float], faults: Faults
) -> None:
    """Note points off the body, and attachments beyond the points."""
    x, half = points.x, body.length / 2
    off = np.flatnonzero(np.abs(x) > half * (1 + AGREE))
    if off.size:
        worst = off[np.argmax(np.abs(x[off]))]
        mend = "x counts from the middle of the car body"
        if np.abs(x).max() > 100 * half:
            mend = "are they in millimetres?"
        elif x[0] >= -AGREE * half or x[-1] <= AGREE * half:
            mend = f"x counts from the middle, not from an end: shift it by {half:g} m"
        faults.add("points", f"{off.size} off the body, such as x = {x[worst]:g} m",
                   f"all between {-half:g} and {half:g} m", mend)  # fmt: skip
        return
    for at in attachments:
        if not x[0] - AGREE * half <= at <= x[-1] + AGREE * half:
            faults.add("points", f"none beyond x = {x[0]:g} and {x[-1]:g} m",
                       f"points on both sides of {at:g} m, where something is attached to the car "
                       "body")  # fmt: skip


def _check_rigid(points: PointModes, body: CarBody, faults: Faults) -> None:
    """Note rigid motions or point masses that are those of another body."""
    found = points.rigid_body()
    if found is not None:
        names = ("mass", "mass_centre", "pitch_inertia")
        _compare("rigid motions", dict(zip(names, found, strict=True)), body, faults)
    if points.point_masses is not None:
        mass = float(points.point_masses.sum())
        moment = float(points.point_masses @ points.x)
        _compare("point masses", {"mass": mass, "mass_centre": moment / mass}, body, faults)


def _compare(what: str, found: dict[str, float], body: CarBody, faults: Faults) -> None:
    """Note what differs by more than 1 % from the vehicle's car body."""
    units = {"mass": "kg", "mass_centre": "m", "pitch_inertia": "kg m^2"}
    for name, value in found.items():
        own = getattr(body, name)
        scale = body.length if name == "mass_centre" else own
        if abs(value - own) > AGREE * scale:
            wrong = own and not 0.05 < abs(value / own) < 20
            faults.add(what, f"a {name.replace('_', ' ')} of {value:.6g} {units[name]}",
                       f"{own:.6g} {units[name]} within {AGREE:.0%}, the vehicle's",
                       "is a unit wrong?" if wrong else "")  # fmt: skip


def _check_scale(points: PointModes, shapes: Array, faults: Faults, remarks: list[str]) -> None:
    """Note shapes whose modal masses cannot belong to them: scaled, a free beam's reach 2."""
    largest = np.abs(shapes).max(axis=1)
    low, high = HEIGHTS
    if largest.max() < low or largest.min() > high:
        faults.add("modal masses", f"heights up to {largest.max():.3g} of modes scaled to the car "
                   "body's mass", "about 2, as of a free beam",
                   "modal masses in another unit, or of shapes in another scale?")  # fmt: skip
        return
    for i, height in zip(points.flexible, largest, strict=True):
        if height > ALONE[1]:
            faults.add(f"mode {i + 1}", f"heights up to {height:.3g}, scaled to the car body's "
                       "mass", f"about 2, as of a free beam, and no more than {ALONE[1]:g}",
                       "its modal mass in the unit and scale of its shape; a mode of a small part "
                       "left out")  # fmt: skip
        elif not ALONE[0] <= height <= high:
            remarks.append(f"mode {i + 1} reaches {height:.3g}, scaled to the car body's mass: is "
                           "its modal mass that of its shape?")  # fmt: skip


def _check_products(
    points: PointModes, body: CarBody, shapes: Array, faults: Faults, remarks: list[str]
) -> None:
    """Note motions that are not orthogonal by the point masses, or hardly can be without them."""
    names = [HEAVE, PITCH, *(f"mode {i + 1}" for i in points.flexible)]
    if points.point_masses is None:
        remarks += _common_if_even(points, body, shapes, names)
        return
    arm = np.sqrt(body.pitch_inertia / body.mass)
    motions = np.vstack([np.ones_like(points.x), (points.x - body.mass_centre) / arm, shapes])
    P = (motions * points.point_masses / body.mass) @ motions.T
    left = np.sqrt(np.maximum(1 - np.diag(P), 0.0))
    excess = np.abs(P) - np.outer(left, left)
    np.fill_diagonal(excess, np.diag(P) - 1)
    for i, j in zip(*np.nonzero(np.triu(excess > NOTED)), strict=True):
        where, found = f"{names[i]} and {names[j]}", f"{abs(P[i, j]):.2g} of their own products"
        if i == j:
            where, found = names[i], f"heights with {P[i, i]:.3g} times its modal mass"
        if excess[i, j] > COMMON:
            faults.add(where, found + " in common" * bool(i != j),
                       "motions orthogonal in the point masses, each with its modal mass",
                       "modes of the free body, shapes and modal masses in one scale")  # fmt: skip
        else:
            remarks.append(f"{where} have {found} in common in the point masses" if i != j else
                           f"{where} has {found} in the points")  # fmt: skip


def _common_if_even(
    points: PointModes, body: CarBody, shapes: Array, names: Sequence[str]
) -> list[str]:
    """What to say of motions that have more in common than an uneven mass explains."""
    x = body.length * ((np.arange(400) + 0.5) / 400 - 0.5)  # the middles of equal parts
    motions = np.vstack([np.ones_like(x), x, _interpolated(points.x, shapes)[0](x)])
    motions /= np.linalg.norm(motions, axis=1, keepdims=True)
    P = np.abs(motions @ motions.T)
    return [
        f"{names[i]} and {names[j]} would have {P[i, j]:.2g} of their own products in common if "
        "the mass were spread evenly: are they natural motions of the free body? Whether they are "
        "orthogonal cannot be checked without point masses"
        for i, j in zip(*np.nonzero(np.triu(P > EVEN, 1)), strict=True)
    ]


def _check_spacing(points: PointModes, shapes: Array, faults: Faults, remarks: list[str]) -> None:
    """Note modes that have too few points, and what others err by between them.

    A spline through every other point errs 16 times as much as one through all, of fourth order.
    """
    crossings = (np.diff(np.sign(shapes), axis=1) != 0).sum(axis=1)
    along, _ = _interpolated(points.x[::2], shapes[:, ::2])
    inner = slice(1, len(points.x) - 1, 2)
    error = np.abs(along(points.x[inner]) - shapes[:, inner]).max(axis=1) / 16
    share = error / np.abs(shapes).max(axis=1)
    for i, c, s in zip(points.flexible, crossings, share, strict=True):
        if len(points.x) < 2 * c:
            faults.add(f"mode {i + 1}", f"{c} changes of sign over {len(points.x)} points",
                       f"at least {2 * c} points", "give more points, or fewer modes")  # fmt: skip
        elif s > NOTED:
            remarks.append(f"mode {i + 1} errs by about {s:.0%} of its height between the points")
