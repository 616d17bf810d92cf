r"""The car body of finite elements: its own beam elements, or modes and matrices from outside.

Its own elements follow the body's profile, or are those of a uniform beam of mass m_c. A bending
frequency scales EI(x), so that the first natural frequency of the free body is that: without shear
by the square of the frequencies' ratio, with it (GA_s stays as it is) by the root of

.. math:: f_1(s\,EI, GA_s) = f .
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from railride.bodies.beam import MODES, inertia_remarks, refuse_other_bodies
from railride.bodies.body_modes import BodyModes
from railride.bodies.element_modes import element_modes
from railride.bodies.matrix_files import read_matrix_market, read_npz
from railride.bodies.modal import ModalBody
from railride.bodies.modes_file import read_modes
from railride.bodies.outside import outside_modes
from railride.body_profile import BodyProfile
from railride.body_sources import Elements, ModeFiles
from railride.car_body import CarBody
from railride.errors import InputError

STEPS = 8  # of a factor 4 in EI, within which a frequency's is looked for


def fe_body(
    body: CarBody, count: int | None = None, attachments: Sequence[float] = ()
) -> ModalBody:
    """The car body of finite elements.

    Parameters
    ----------
    body : with files from outside, or a profile, or uniform with a bending frequency or EI.
    count : how many modes; default 10, or as many as a table holds.
    attachments : places (m) on the body that modes from outside must be known at.

    Raises
    ------
    InputError : a body of which nothing of the kind is known; files that cannot be used; a
        frequency that the shear stiffness does not allow.

    Examples
    --------
    >>> coach = CarBody(34e3, 1.632e6, 24.0, bending_frequency=9.6)
    >>> fe_body(coach, 3).modes.frequencies.round(2).tolist()
    [9.6, 26.46, 51.88]
    """
    if body.mode_files is not None:
        return ModalBody(body, _from_files(body, body.mode_files, count, attachments))
    profile, remarks = _profile(body)
    chosen = body.elements or Elements()
    modes = element_modes(profile, MODES if count is None else count, elements=chosen.number,
                          interfaces=chosen.interfaces)  # fmt: skip
    return ModalBody(body, replace(modes, remarks=(*modes.remarks, *remarks)))


def _from_files(
    body: CarBody, files: ModeFiles, count: int | None, attachments: Sequence[float]
) -> BodyModes:
    """Modes from outside, and what becomes of the body's own bending."""
    paths, mass_unit = files.paths, files.mass_unit or "kg"
    if files.file is not None:
        points = read_modes(files.file)
    elif files.matrices is not None:
        matrices = read_npz(files.matrices, mass_unit=mass_unit,
                            length_unit=files.length_unit or "m")  # fmt: skip
        points = matrices.point_modes(MODES if count is None else count)
    else:
        matrices = read_matrix_market(*paths.values(), mass_unit=mass_unit)
        points = matrices.point_modes(MODES if count is None else count)
    modes = outside_modes(points, body, attachments=attachments, count=count)
    own = body.bending_frequency
    if own is None or abs(own / modes.frequencies[0] - 1) < 1e-3:
        return modes
    said = (f"the bending frequency of {own:g} Hz is not used: that of the modes from outside is "
            f"{modes.frequencies[0]:.4g} Hz")  # fmt: skip
    return replace(modes, remarks=(*modes.remarks, said))


def _profile(body: CarBody) -> tuple[BodyProfile, tuple[str, ...]]:
    """What the elements are made of, and what a user must know of it."""
    refuse_other_bodies(body, "fe")
    frequency = body.bending_frequency
    if body.profile is None:
        profile = _uniform(body)
        remarks = inertia_remarks(body, profile.pitch_inertia)
    else:
        profile, remarks = body.profile, ()
        if body.bending_frequencies is not None:
            frequency = body.bending_frequencies[0]
        if frequency is not None:
            remarks = (f"the bending frequency of {frequency:g} Hz scales the profile's EI",)
    return profile if frequency is None else _calibrated(profile, frequency), remarks


def _uniform(body: CarBody) -> BodyProfile:
    """The body as a uniform beam, of any EI where it is to be calibrated."""
    stiffness, mass = body.bending_stiffness or body.mass * body.length**3, body.mass / body.length
    shear, rotary = body.shear_stiffness, body.rotary_inertia
    return BodyProfile(
        (-body.length / 2, body.length / 2), (stiffness, stiffness), (mass, mass),
        (shear, shear) if shear else None, (rotary, rotary) if rotary else None,
    )  # fmt: skip


def _calibrated(profile: BodyProfile, frequency: float) -> BodyProfile:
    """The profile with its EI scaled to a first natural frequency, Hz."""
    from scipy.optimize import brentq

    def scaled(factor: float) -> BodyProfile:
        stiffness = tuple(factor * value for value in profile.bending_stiffness)
        return replace(profile, bending_stiffness=stiffness)

    def first(factor: float) -> float:
        return float(element_modes(scaled(factor), 1).frequencies[0])

    low = high = (frequency / first(1.0)) ** 2
    if profile.shear_stiffness is None:
        return scaled(low)
    for _ in range(STEPS):  # as far as shear makes the root differ from that
        low = low if first(low) < frequency else low / 4
        high = high if first(high) > frequency else high * 4
    if first(low) < frequency < first(high):
        root = brentq(lambda u: first(np.exp(u)) - frequency, np.log(low), np.log(high), xtol=1e-13)
        return scaled(float(np.exp(root)))
    raise InputError(
        f"body fe: found a bending frequency of {frequency:g} Hz where the shear stiffness allows "
        f"at most {first(high):.4g} Hz; expected less (a larger shear stiffness?)"
    )
