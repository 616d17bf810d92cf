"""Random vehicles for hypothesis, of every kind that there is, and what can be done to one."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace

import numpy as np
from hypothesis import strategies as st
from hypothesis.strategies import booleans, floats, integers, none, one_of, sampled_from, tuples

from railride.parameters import (
    BodyProfile,
    Bogie,
    CarBody,
    Elements,
    Equipment,
    Load,
    PointMass,
    Segment,
    Vehicle,
)

# Bodies

BENDING = st.one_of(
    st.builds(dict, bending_frequency=floats(6, 13)),
    st.builds(dict, bending_stiffness=floats(1e9, 5e9)),
)
RATIO = st.one_of(st.just({}), st.builds(dict, bending_damping=floats(0.002, 0.05)))


@st.composite
def rigid_bodies(draw):
    length, mass = draw(floats(15, 28)), draw(floats(15e3, 60e3))
    inertia = mass * length**2 / 12 * draw(floats(0.6, 1.6))
    return CarBody(mass, inertia, length, mass_centre=draw(floats(-0.8, 0.8))), {"segments": 1}


@st.composite
def segmented_bodies(draw):
    """Segments of equal length, their mass even or graded, stiffness and damping in every form."""
    length, mass, N = draw(floats(15, 28)), draw(floats(15e3, 60e3)), draw(integers(2, 8))
    rod = mass * length**2 / 12
    inertia = draw(sampled_from(("rods", "graded", "segments")))
    graded = inertia == "graded"
    k = floats(1e8, 6e8)
    bending = draw(one_of(
        BENDING,
        st.builds(dict, joint_stiffness=one_of(k, st.lists(k, min_size=N - 1, max_size=N - 1))),
        st.builds(lambda f, r: {"bending_frequencies": (f, r * f)}, floats(6, 10), floats(2.5, 2.8))
        if N > 3 else BENDING,
    ))  # fmt: skip
    damping = draw(one_of(
        RATIO,
        st.builds(dict, joint_damping=floats(0, 3e5)),
        st.builds(dict, rayleigh_stiffness=floats(1e-5, 1e-3)),
    ))  # fmt: skip
    body = CarBody(
        mass,
        rod * draw(floats(0.9, 1.2) if graded else floats(1.0, 1.03)),
        length,
        mass_centre=draw(floats(-0.3, 0.3)) if graded else 0.0,
        inertia=inertia,
        **bending,
        **damping,
    )
    return body, {"segments": N}


@st.composite
def own_segments(draw):
    """Rigid segments of their own lengths and masses, no two joints alike."""
    N, whole = draw(integers(2, 5)), draw(floats(15, 28))
    share = tuples(floats(3, 9), floats(1000, 2500), floats(-0.1, 0.1),
                   one_of(none(), floats(0.06, 0.12)))  # fmt: skip
    shares = draw(st.lists(share, min_size=N, max_size=N))
    unit = whole / sum(length for length, *_ in shares)
    rows = [
        Segment(length * unit, density * length * unit, mass_centre=shift * length * unit,
                pitch_inertia=inertia and inertia * density * (length * unit) ** 3)
        for length, density, shift, inertia in shares
    ]  # fmt: skip
    k, c = (draw(st.lists(floats(*ends), min_size=N - 1, max_size=N - 1))
            for ends in ((1e8, 6e8), (0, 2e5)))  # fmt: skip
    return CarBody.of(rows, joint_stiffness=k, joint_damping=c), {}


@st.composite
def profiles(draw):
    """Data along the body with jumps and point masses."""
    half, inner = draw(floats(8, 14)), draw(st.lists(floats(-0.9, 0.9), max_size=3, unique=True))
    knots = [-1.0, *sorted(round(x, 3) for x in inner), 1.0]
    knots = sorted({*knots}) if len({*knots}) < len(knots) else knots
    if len(knots) > 2 and draw(booleans()):
        knots.insert(1, knots[1])  # a jump
    n = len(knots)
    column = lambda low, high: draw(st.lists(floats(low, high), min_size=n, max_size=n))  # noqa: E731
    shear = column(2e8, 9e8) if draw(booleans()) else None
    mass = tuples(floats(100, 1500), integers(-9, 9), floats(0, 300))
    points = tuple(  # on no hinge, where which of two segments it turns with is a convention
        PointMass(mass, (place / 10 + 0.037) * half, inertia)
        for mass, place, inertia in draw(st.lists(mass, max_size=2))
    )
    return BodyProfile([half * x for x in knots], column(1e9, 4e9), column(800, 2000), shear,
                       column(500, 3000) if shear else None, points)  # fmt: skip


@st.composite
def profiled_bodies(draw):
    """A profile cut into segments, evenly or where it says, or into finite elements."""
    profile, damping = draw(profiles()), draw(RATIO)
    half = profile.length / 2
    how = draw(sampled_from(("even", "cuts", "fe", "reduced")))
    if how == "even":
        frequency = draw(one_of(none(), floats(6, 13)))
        N = draw(integers(1, 6))
        return CarBody.of(profile, bending_frequency=frequency, **damping), {"segments": N}
    if how == "cuts":
        # Beside a much longer segment, or where EI changes much, a joint may have no compliance.
        shares = draw(
            sampled_from(((0.05,), (0.4, -0.3), (0.5, 0.05, -0.55), (0.6, 0.2, -0.15, -0.6)))
        )
        return CarBody.of(profile, cuts=[half * x for x in shares], **damping), {}
    elements = Elements(24, (-0.7 * half, 0.0, 0.7 * half) if how == "reduced" else ())
    return CarBody.of(profile, elements=elements, **damping), {"body": "fe", "modes": 3}


@st.composite
def beams(draw):
    """Uniform beams, with shear or without, and of finite elements; damping in every form."""
    length, mass = draw(floats(15, 28)), draw(floats(15e3, 60e3))
    shear = draw(one_of(st.just({}), st.builds(dict, shear_stiffness=floats(3e8, 1e9),
                                               rotary_inertia=floats(500, 3000))))  # fmt: skip
    modes = draw(integers(1, 5))
    damping = draw(one_of(
        RATIO,
        st.builds(dict, rayleigh_mass=floats(0, 0.5), rayleigh_stiffness=floats(0, 5e-4)),
        st.builds(dict, mode_damping=st.lists(floats(0, 0.05), min_size=1, max_size=modes)),
    ))  # fmt: skip
    bending = draw(BENDING)
    if shear:  # which may not allow any frequency
        bending = {"bending_stiffness": draw(floats(1e9, 5e9))}
    body = CarBody(mass, mass * length**2 / 12, length, **bending, **shear, **damping)
    kind = draw(sampled_from(("beam", "fe")))
    return body, {"body": kind, "modes": modes}


# The running gear and what a body carries

ONE_WHEELSET = st.builds(lambda x: (x,), one_of(floats(0.6, 1.5), floats(-1.5, -0.6)))
LAYOUTS = st.one_of(
    st.builds(lambda a, b: (a, -b), floats(0.8, 1.6), floats(0.8, 1.6)),
    st.builds(lambda a: (a, -a), floats(0.8, 1.6)),
    st.builds(lambda a, m, b: (a, m, -b), floats(1.2, 1.6), floats(-0.3, 0.3), floats(1.2, 1.6)),
)


@st.composite
def bogies(draw, position, damped=True, layouts=LAYOUTS):
    primary, secondary = (draw(floats(5e3, 6e4)), draw(floats(1e4, 9e4))) if damped else (0.0, 0.0)
    mounts = {name: draw(one_of(none(), floats(*ends))) if damped else None
              for name, ends in {"primary_damper_stiffness": (2e6, 2e7),
                                 "secondary_damper_stiffness": (1e6, 9e6)}.items()}  # fmt: skip
    return Bogie(
        position=position,
        mass=draw(floats(2e3, 6e3)),
        pitch_inertia=draw(floats(1.5e3, 4e3)),
        wheelsets=draw(layouts),
        primary_stiffness=draw(floats(1e6, 6e6)),
        primary_damping=primary,
        secondary_stiffness=draw(floats(3e5, 1e6)),
        secondary_damping=secondary,
        wheelset_mass=draw(one_of(none(), floats(800, 2000))),
        **mounts,
    )


@st.composite
def loads(draw, half):
    ends = draw(one_of(none(), tuples(floats(-0.95, 0.95), floats(-0.95, 0.95))))
    front, rear = (None, None) if ends is None else (half * max(ends), half * min(ends))
    return Load(draw(floats(200, 8000)), front, rear)


@st.composite
def hung(draw, half, damped=True):
    held = draw(one_of(st.builds(dict, frequency=floats(3, 15)),
                       st.builds(dict, stiffness=floats(5e5, 5e6))))  # fmt: skip
    damping = draw(one_of(st.builds(dict, damping=floats(5e2, 8e3)),
                          st.builds(dict, damping_ratio=floats(0.02, 0.3))))  # fmt: skip
    return Equipment(draw(floats(300, 2500)), half * draw(floats(-0.9, 0.9)), **held,
                     **(damping if damped else {}))  # fmt: skip


PLACES = {2: (0.72, -0.7), 3: (0.8, 0.04, -0.76), 4: (0.85, 0.3, -0.28, -0.8)}


@st.composite
def vehicles(draw, damped=True):
    """A vehicle, and the options of ``derive_vehicle`` that make its body."""
    body, options = draw(st.one_of(rigid_bodies(), segmented_bodies(), own_segments(),
                                   profiled_bodies(), beams()))  # fmt: skip
    if not damped:
        body = replace(body, bending_damping=0.0, joint_damping=None, rayleigh_mass=0.0,
                       rayleigh_stiffness=0.0, mode_damping=None)  # fmt: skip
    half = body.length / 2
    places = PLACES[draw(sampled_from((2, 2, 2, 3, 4)))]
    gear = [draw(bogies(half * x + draw(floats(-0.2, 0.2)), damped)) for x in places]
    if draw(booleans()):  # all alike
        gear = [replace(gear[0], position=b.position) for b in gear]
    if len(gear) > 2 and draw(booleans()):  # free to turn about it, and held by the others
        gear[1] = draw(bogies(gear[1].position, damped, ONE_WHEELSET))
    vehicle = Vehicle(
        "random",
        body,
        gear,
        payload=draw(st.lists(loads(half), max_size=2)),
        equipment=draw(st.lists(hung(half, damped), max_size=2)),
    )
    return vehicle, options


# Units

# Exponents of mass, length and time in the units of the parameters.
DIMENSIONS = {
    "kg": (1, 0, 0), "m": (0, 1, 0), "Hz": (0, 0, -1), "s": (0, 0, 1), "1/s": (0, 0, -1),
    "kg/m": (1, -1, 0), "kg m": (1, 1, 0), "kg m^2": (1, 2, 0), "N": (1, 1, -2),
    "N/m": (1, 0, -2), "N s/m": (1, 0, -1), "N m^2": (1, 3, -2), "N m/rad": (1, 2, -2),
    "N m s/rad": (1, 2, -1), "": (0, 0, 0),
}  # fmt: skip


def in_units(record, units):
    """A record with all its quantities in other units of mass, length and time."""
    changes = {}
    for item in fields(record):
        value = getattr(record, item.name)
        if "unit" in item.metadata and value is not None:
            factor = float(
                np.prod(
                    [u**-d for u, d in zip(units, DIMENSIONS[item.metadata["unit"]], strict=True)]
                )
            )
            many = isinstance(value, tuple)
            changes[item.name] = tuple(factor * x for x in value) if many else factor * value
        elif is_dataclass(value):
            changes[item.name] = in_units(value, units)
        elif isinstance(value, tuple) and value and is_dataclass(value[0]):
            changes[item.name] = tuple(in_units(one, units) for one in value)
    return replace(record, **changes)
