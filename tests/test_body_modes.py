"""The record of a body's natural modes: what it holds, and what it refuses."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from railride.bodies import BodyModes
from railride.errors import InputError

MASS, LENGTH = 30e3, 20.0


def legendre(x):
    """Legendre's polynomials of degree 2 and 3, scaled to a mean square of 1 along the body."""
    u = np.asarray(x, dtype=float) / (LENGTH / 2)
    return np.array([np.polynomial.legendre.Legendre.basis(k)(u) * np.sqrt(2 * k + 1)
                     for k in (2, 3)])  # fmt: skip


def products():
    """∫ of the motions' products over a uniform body, by Gauss's rule (exact for these)."""
    points, weights = np.polynomial.legendre.leggauss(8)
    x = points * LENGTH / 2
    motions = np.vstack([np.ones_like(x), x, legendre(x)])
    return MASS / 2 * (motions * weights) @ motions.T


def made(**changes):
    given = {"mass": MASS, "mass_centre": 0.0, "pitch_inertia": MASS * LENGTH**2 / 12,
             "length": LENGTH, "frequencies": [9.0, 25.0], "damping": [0.01, 0.02],
             "shapes": legendre, "kind": "modes", "products": products()}  # fmt: skip
    return BodyModes(**given | changes)


def test_orthogonal_modes_are_taken():
    modes = made()
    assert modes.count == 2
    assert modes.frequencies.dtype == float
    first = modes.first(1)
    assert (first.count, first.shapes(np.zeros((3, 2))).shape) == (1, (1, 3, 2))
    assert first.products.shape == (3, 3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"mass": -1.0}, r"mass: found -1 kg; expected .*above 0"),
        ({"pitch_inertia": np.nan}, "pitch_inertia: found nan"),
        ({"mass_centre": 11.0}, "mass_centre: found 11 m"),
        ({"frequencies": []}, "at least one"),
        ({"frequencies": [0.0, 9.0]}, r"mode 1: found a natural frequency of 0 Hz.*rigid"),
        ({"frequencies": [9.0, 8.0]}, "mode 2: found 8 Hz after 9 Hz"),
        ({"damping": [0.01]}, "1 ratios of 2 modes"),
        ({"damping": [0.01, -0.1]}, "mode 2: found a damping ratio of -0.1;"),
        ({"shapes": lambda x: legendre(x)[:1]}, r"shapes: found values of shape \(1, 2, 3\)"),
        ({"slopes": lambda x: legendre(x) * np.array([1, np.nan])[:, None, None]},
         "mode 2: found no finite number among its slopes"),
        ({"products": np.eye(3)}, r"products: found shape \(3, 3\)"),
    ],
)  # fmt: skip
def test_what_no_body_can_have_is_refused(changes, words):
    with pytest.raises(InputError, match=words):
        made(**changes)


@pytest.mark.parametrize(
    ("place", "words"),
    [
        ((0, 2), "a uniform lift and mode 1"),
        ((1, 3), "pitch about the mass centre and mode 2"),
        ((2, 3), "mode 1 and mode 2"),
        ((3, 3), "mode 2: found a product with itself"),
    ],
)
def test_modes_that_are_not_orthogonal_are_named(place, words):
    P = products()
    P[place] += 1e-5 * MASS * (LENGTH if 1 in place else 1)
    with pytest.raises(InputError, match=words):
        made(products=P)


def test_all_faults_come_together():
    with pytest.raises(InputError) as said:
        made(mass=0.0, frequencies=[9.0, 8.0], damping=[-2.0, 0.0])
    assert len(str(said.value).splitlines()) == 3


def test_more_modes_than_there_are_is_refused():
    for n in (0, 3):
        with pytest.raises(InputError, match="1 to 2"):
            made().first(n)


def test_the_record_is_frozen_and_itself():
    modes = made()
    assert modes == modes  # noqa: PLR0124 - arrays compare by element: identity is meant
    assert replace(modes) != modes
