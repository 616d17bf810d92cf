"""The car body of beam elements as natural modes: the elements' own, or those of a reduced body."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from railride.bodies.body_modes import BodyModes
from railride.bodies.elements import NEAREST, SAME, BeamElements
from railride.bodies.reduction import NONE, craig_bampton, lowest_modes
from railride.body_profile import BodyProfile
from railride.errors import Faults, InputError
from railride.numeric import Array

ELEMENTS = 128  # at least, unless the user says otherwise
MOST = 2000  # elements; more add rounding, not digits
PER_MODE = 2  # elements for each mode at least: ω of the highest is then 0.4 % too high
ROUNDED = 1e-3  # of the first bending's ω²: the rigid motions' is zero but for rounding
AGREE = 1e-3  # of ω: so near a mode of the reduced body counts as one of the elements' own


def element_modes(
    profile: BodyProfile,
    count: int = 10,
    *,
    elements: int | None = None,
    interfaces: Sequence[float] = (),
) -> BodyModes:
    """Free-free modes of a car body of beam elements, its own or those of a reduced body.

    Parameters
    ----------
    profile : the body's data along x.
    count : how many modes.
    elements : at least so many, of equal length between knots and point masses; default 128, or 6
        for each mode.
    interfaces : at least two places (m forward of the middle) where forces act or the floor is
        read, for a Craig–Bampton reduction to their heights and ``count + 2 - len(interfaces)``
        modes with these held: static forces there bend the body exactly. None: the lowest
        ``count`` modes of the elements themselves.

    Raises
    ------
    InputError : numbers that do not fit together; what :class:`BeamElements` refuses; masses and
        stiffnesses so far apart that rounding decides the modes.

    Examples
    --------
    >>> uniform = BodyProfile((-12, 12), (3e9, 3e9), (1400, 1400))
    >>> element_modes(uniform, 2).frequencies.round(3).tolist()
    [9.049, 24.945]
    """
    _check_numbers(profile, count, elements, interfaces)
    places = tuple(sorted({float(x) for x in interfaces}))
    beam = BeamElements(profile, elements or min(max(ELEMENTS, 6 * count), MOST), places)
    own, motions = lowest_modes(beam.M, beam.K, count + 2)
    if not np.abs(own[:2]).max() < ROUNDED * own[2]:
        raise InputError(NONE)
    if places:
        motions = _reduced(beam, count)
    squares, found, products = beam.modes(motions[:, 2:])
    polynomials = beam.heights(found[:, 2:])
    slopes = polynomials.derivative()
    centre = profile.mass_centre
    return BodyModes(
        profile.mass, centre if abs(centre) > SAME * profile.length else 0.0,
        profile.pitch_inertia, profile.length,
        np.sqrt(squares) / (2 * np.pi), None,
        lambda x: np.moveaxis(polynomials(x), -1, 0), "fe",
        slopes=lambda x: np.moveaxis(slopes(x), -1, 0), products=products,
        knots=tuple(beam.nodes[1:-1].tolist()),
        remarks=_remarks(squares, own[2:]) if places else (),
    )  # fmt: skip


def _reduced(beam: BeamElements, count: int) -> Array:
    """Rigid motions and modes (n, count + 2) of the Craig–Bampton reduction to the interfaces."""
    places = beam.interfaces
    nodes = [int(np.abs(beam.nodes - x).argmin()) for x in places]
    T = craig_bampton(beam.M, beam.K, beam.basis.nodal_dofs[0][nodes], count + 2 - len(places))
    return T @ lowest_modes(T.T @ (beam.M @ T), T.T @ (beam.K @ T), count + 2)[1]


def _remarks(squares: Array, own: Array) -> tuple[str, ...]:
    """How far the natural frequencies of the reduced body are those of the elements."""
    near = np.sqrt(squares / own) - 1 < AGREE
    if near.all():
        return ()
    first = int(np.argmin(near))
    remark = (
        f"Craig–Bampton: the first {first} of {near.size} bending frequencies are those of the "
        f"elements within {AGREE:.1%}; the higher ones serve static bending under the interfaces"
    )
    return (remark,)


def _check_numbers(
    profile: BodyProfile, count: int, elements: int | None, interfaces: Sequence[float]
) -> None:
    """Refuse numbers of modes, elements and interfaces that do not fit together."""
    faults = Faults("body fe")
    if not _whole(count) or not 1 <= count <= MOST // PER_MODE:
        faults.add("modes", count, f"a whole number from 1 to {MOST // PER_MODE}")
        faults.raise_if_any()
    if elements is not None and not (_whole(elements) and PER_MODE * count <= elements <= MOST):
        faults.add("elements", elements, f"a whole number from {PER_MODE * count} to {MOST}",
                   f"{count} modes need {PER_MODE} elements each, better 6")  # fmt: skip
    half = profile.length / 2
    for x in interfaces:
        if not abs(x) <= half * (1 + SAME):
            faults.add("interfaces", f"{x:g} m, a point off the body",
                       f"places between {-half:g} and {half:g} m from its middle")  # fmt: skip
    apart = np.diff(sorted(interfaces))
    if len(interfaces) and (len(interfaces) < 2 or apart.min() <= NEAREST * profile.length):
        faults.add("interfaces", f"{len(interfaces)} at {', '.join(f'{x:g}' for x in interfaces)} "
                   "m", "at least two, each at its own place",
                   "one alone leaves the held body a rigid motion")  # fmt: skip
    if len(interfaces) > count + 2:
        faults.add(
            "interfaces",
            f"{len(interfaces)} with {count} modes",
            f"at most {count + 2}, each takes the place of a mode",
            "keep more modes",
        )
    faults.raise_if_any()


def _whole(number: object) -> bool:
    return isinstance(number, int | np.integer) and not isinstance(number, bool)
