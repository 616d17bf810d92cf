"""Vehicles to test with, and their matrices assembled by hand with numpy alone."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import sympy as sp

from railride.parameters import Bogie, CarBody, Vehicle, load_vehicle
from railride.vehicle import derive_vehicle


@cache
def paper_coach(segments=2, **given):
    """The paper's coach (Table 1), derived once for all tests."""
    return derive_vehicle(load_vehicle("cati2024"), segments, **given)


def random_vehicle(seed, *, graded=True):
    """An unsymmetric coach: 2 or 3 bogies of 1 to 3 wheelsets, no two alike, dampers in the joints.

    With ``graded`` the mass centre is off the middle and the inertia is not a rod's. Bogies on one
    wheelset are free to turn about it; the last bogie has always more than one.
    """
    rng = np.random.default_rng(seed)
    length = rng.uniform(18, 28)
    mass = rng.uniform(20e3, 60e3)
    rod = mass * length**2 / 12
    body = CarBody(
        mass=mass,
        pitch_inertia=rod * (rng.uniform(0.85, 1.25) if graded else 1.0),
        length=length,
        mass_centre=rng.uniform(-0.6, 0.6) if graded else 0.0,
        bending_frequency=rng.uniform(6, 13),
        bending_damping=rng.uniform(0.005, 0.03),
        inertia="graded" if graded else "rods",
    )
    places = {2: (0.36, -0.33), 3: (0.4, 0.03, -0.37)}[int(rng.integers(2, 4))]
    layouts = [(1.3, -1.2), (1.8, 0.1, -1.7), (0.9, -1.25)]
    return Vehicle(
        name=f"random {seed}",
        body=body,
        bogies=tuple(
            Bogie(
                position=length * x + rng.uniform(-0.3, 0.3),
                mass=rng.uniform(2e3, 6e3),
                pitch_inertia=rng.uniform(1.5e3, 4e3),
                wheelsets=layouts[int(rng.integers(0, 3))],
                primary_stiffness=rng.uniform(1e6, 6e6),
                primary_damping=rng.uniform(5e3, 60e3),
                secondary_stiffness=rng.uniform(3e5, 1e6),
                secondary_damping=rng.uniform(1e4, 9e4),
            )
            for x in places
        ),
    )


@cache
def random_model(seed, segments):
    """A random vehicle, derived once for all tests."""
    return derive_vehicle(random_vehicle(seed), segments)


def mirrored(vehicle):
    """The same vehicle seen from the other side: what was in front is at the rear."""
    body, profile = vehicle.body, vehicle.body.profile

    def back(values):
        return values[::-1] if isinstance(values, tuple) else values

    def turned(values):
        return None if values is None else tuple(-x for x in reversed(values))

    if profile is not None:
        columns = ("bending_stiffness", "mass_per_length", "shear_stiffness", "rotary_inertia")
        profile = replace(profile, x=turned(profile.x), point_masses=tuple(
            replace(p, position=-p.position) for p in profile.point_masses),
            **{name: back(getattr(profile, name)) for name in columns})  # fmt: skip
    elements = body.elements and replace(body.elements, interfaces=turned(body.elements.interfaces))
    body = replace(
        body,
        mass_centre=-body.mass_centre,
        joint_stiffness=back(body.joint_stiffness),
        joint_damping=back(body.joint_damping),
        profile=profile,
        cuts=turned(body.cuts),
        elements=elements,
        segments=tuple(replace(s, mass_centre=-s.mass_centre) for s in reversed(body.segments)),
    )
    return replace(
        vehicle,
        body=body,
        bogies=[replace(b, position=-b.position, wheelsets=turned(b.wheelsets))
                for b in reversed(vehicle.bogies)],
        payload=[load if load.front is None else replace(load, front=-load.rear, rear=-load.front)
                 for load in vehicle.payload],
        equipment=[replace(one, position=-one.position) for one in vehicle.equipment],
    )  # fmt: skip


@dataclass
class Assembled:
    """M q̈ + C q̇ + K q = K_w w + C_w ẇ + B_f f, and the row of the body's height at any point."""

    M: np.ndarray
    C: np.ndarray
    K: np.ndarray
    K_w: np.ndarray
    C_w: np.ndarray
    B_f: np.ndarray
    height: object


def assemble(vehicle, segments, k_theta=0.0, c_theta=0.0):
    """The linear matrices straight from the geometry: outer products of rows, no energies.

    N ≥ 2: M = ∫ μ(x) h(x) h(x)ᵀ dx over the polygon, the density being the polynomial of the lowest
    degree that has the body's mass, first and (if graded) second moment.
    """
    body, n_b = vehicle.body, len(vehicle.bogies)
    own = 2 if segments == 1 else segments + 1
    n = own + 2 * n_b
    M, C, K = np.zeros((3, n, n))
    if segments == 1:

        def height(x):
            row = np.zeros(n)
            row[:2] = 1.0, x - body.mass_centre
            return row

        M[0, 0], M[1, 1] = body.mass, body.pitch_inertia
    else:
        nodes = np.linspace(body.length / 2, -body.length / 2, own)

        def height(x):
            row = np.zeros(n)
            for k in range(own):
                hat = np.zeros(own)
                hat[k] = 1.0
                row[k] = np.interp(x, nodes[::-1], hat[::-1])
            return row

        mu = density(body)
        points, weights = np.polynomial.legendre.leggauss(6)
        for front, rear in itertools.pairwise(nodes):
            for p, weight in zip(points, weights, strict=True):
                x = (front + rear) / 2 + p * (front - rear) / 2
                h = height(x)
                M += mu(x) * weight * (front - rear) / 2 * np.outer(h, h)
        ell = body.length / segments
        for k in range(1, own - 1):
            bend = np.zeros(n)
            bend[k - 1 : k + 2] = np.array([1.0, -2.0, 1.0]) / ell
            K += k_theta * np.outer(bend, bend)
            C += c_theta * np.outer(bend, bend)
    wheelsets = sum(len(b.wheelsets) for b in vehicle.bogies)
    K_w, C_w = np.zeros((2, n, wheelsets))
    B_f = np.zeros((n, n_b))
    j = 0
    for b, bogie in enumerate(vehicle.bogies):
        heave, pitch = own + 2 * b, own + 2 * b + 1
        M[heave, heave], M[pitch, pitch] = bogie.mass, bogie.pitch_inertia
        s = height(bogie.position)
        s[heave] -= 1.0
        K += bogie.secondary_stiffness * np.outer(s, s)
        C += bogie.secondary_damping * np.outer(s, s)
        B_f[:, b] = s
        for x in bogie.wheelsets:
            p = np.zeros(n)
            p[heave], p[pitch] = 1.0, x
            K += bogie.primary_stiffness * np.outer(p, p)
            C += bogie.primary_damping * np.outer(p, p)
            K_w[:, j] = bogie.primary_stiffness * p
            C_w[:, j] = bogie.primary_damping * p
            j += 1
    return Assembled(M, C, K, K_w, C_w, B_f, height)


def density(body):
    """μ(x), kg/m: uniform for rods, else the parabola with the body's three moments."""
    if body.inertia == "rods":
        return np.polynomial.Polynomial([body.mass / body.length])
    h = body.length / 2
    moments = np.array([[(h ** (i + j + 1) - (-h) ** (i + j + 1)) / (i + j + 1) for j in range(3)]
                        for i in range(3)])  # fmt: skip
    wanted = [body.mass, body.mass * body.mass_centre,
              body.pitch_inertia + body.mass * body.mass_centre**2]  # fmt: skip
    return np.polynomial.Polynomial(np.linalg.solve(moments, wanted))


def identical(a, b):
    """Whether two expressions or matrices are the same, proved by sympy."""
    difference = a - b
    entries = difference if isinstance(difference, sp.MatrixBase) else [difference]
    return all(sp.expand(e) == 0 or sp.simplify(e) == 0 for e in entries)
