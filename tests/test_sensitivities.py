"""Exact derivatives, against Richardson's differences of values found in another way."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from vehicles import paper_coach, random_model

from railride.firstorder import first_order
from railride.modal import modes
from railride.parameters import Equipment, Load, load_vehicle
from railride.sensitivities import (
    Derivatives,
    mean_squares_with_gradient,
    roots_with_gradient,
    static_deflections_with_gradient,
)
from railride.spectra import spectrum
from railride.stochastic.gains import weighted
from railride.stochastic.ride import floor_in_hand
from railride.stochastic.squares import mean_squares
from railride.vehicle import derive_vehicle
from railride.weightings import weighting

KMH = 1 / 3.6
LOW = spectrum("erri_low")
W_K = weighted(weighting("Wk"))


def richardson(f, x, step):
    """df/dx, of sixth order, from central differences with steps h, h/2 and h/4 (Richardson)."""
    table = [(f(x + h) - f(x - h)) / (2 * h) for h in (step, step / 2, step / 4)]
    for order in (4, 16):
        table = [(order * b - a) / (order - 1) for a, b in itertools.pairwise(table)]
    return table[0]


def along(f, derivatives, name, **changes):
    """df/dp of a function of the changed values, by differences of relative step 2e-3."""
    here = float(derivatives.model.values(**changes)[name])
    return richardson(lambda x: f(**{**changes, name: x}), here, 2e-3 * abs(here) or 1e-3)


def closed_form(model, speed, gain, in_hand_at, **changes):
    """Mean squares of outputs by residues: no quadrature over the band, and no adjoint."""
    m, rows = in_hand_at(changes)
    places = wheelset_places(model, model.values(**changes))
    squares, errors = mean_squares(m, rows, places, [speed], LOW, (gain,))
    assert errors.max() < 1e-9
    return squares[0, 0, 0]


def wheelset_places(model, values):
    """Bogies' positions and wheelsets' on them, put together by hand."""
    found = []
    for b, bogie in enumerate(model.vehicle.bogies, start=1):
        for j, place in enumerate(bogie.wheelsets, start=1):
            at = _place(values, bogie.position, "l_b", f"x_b{b}")
            own = f"_b{b}" if f"l_w_b{b}" in values or f"x_w{j}_b{b}" in values else ""
            mirrored = next((k for k in (f"l_w{own}", f"l_w1{own}") if k in values), "")
            found.append(at + _place(values, place, mirrored, f"x_w{j}{own}"))
    return found


def _place(values, here, mirrored, single):
    if here == 0:
        return 0.0
    if single in values:
        return float(values[single])
    return np.copysign(float(values[mirrored]), here)


def heavy_coach():
    """Payload all along and in a point, equipment on mounts, dampers on elastic mounts, damped."""
    coach = load_vehicle("cati2024")
    bogies = tuple(replace(b, secondary_damper_stiffness=5e6, primary_damper_stiffness=k)
                   for b, k in zip(coach.bogies, (8e6, 9e6), strict=True))  # fmt: skip
    return replace(
        coach,
        body=replace(coach.body, bending_damping=0.012),
        bogies=bogies,
        payload=(Load(6e3), Load(800.0, front=3.0, rear=3.0)),
        equipment=(Equipment(mass=2500.0, position=1.5, frequency=7.0, damping_ratio=0.08),),
    )


@cache
def model_of(kind):
    heavy = heavy_coach()
    plain = replace(heavy, bogies=load_vehicle("cati2024").bogies)
    return {
        "rigid": lambda: paper_coach(1),
        "N = 2": lambda: paper_coach(2, bending_damping=0.01),
        "N = 4": lambda: paper_coach(4, bending_damping=0.01),
        "joint stiffness": lambda: derive_vehicle("cati2024", 3, joint_stiffness=4e8,
                                                  bending_damping=0.01),
        "beam": lambda: derive_vehicle("cati2024", body="beam", modes=3, bending_damping=0.01),
        "unsymmetrical": lambda: random_model(0, 4),
        "Maxwell": lambda: derive_vehicle(heavy, 2),
        "loaded": lambda: derive_vehicle(plain, 4),
        "loaded beam": lambda: derive_vehicle(plain, body="beam", modes=2),
    }[kind]()  # fmt: skip


@pytest.mark.parametrize(
    "kind",
    [
        "rigid",
        "N = 2",
        "N = 4",
        "joint stiffness",
        "beam",
        "unsymmetrical",
        "Maxwell",
        "loaded",
        "loaded beam",
    ],
)
@pytest.mark.parametrize("kmh", [145, 200])
def test_gradient_of_the_weighted_mean_square(kind, kmh):
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    at = [0.0, 5.0]
    J, dJ = mean_squares_with_gradient(here, here.floor(at), kmh * KMH, LOW, (W_K,))

    def value(**changes):
        return closed_form(model, kmh * KMH, W_K, lambda c: floor_in_hand(model, at, "smooth", c),
                           **changes)  # fmt: skip

    np.testing.assert_allclose(J[0, 0], value(), rtol=1e-9)
    for k, name in enumerate(derivatives.parameters):
        scale = J[0, 0] / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(dJ[0, 0, :, k] / scale, along(value, derivatives, name) / scale,
                                   rtol=1e-7, atol=2e-8, err_msg=name)  # fmt: skip


def eigenvalues_near(model, roots, **changes):
    """The eigenvalue of changed values nearest to each."""
    A = first_order(model.matrices(**changes)).A
    found = np.linalg.eigvals(A)
    return found[np.abs(found - np.asarray(roots)[:, np.newaxis]).argmin(axis=1)]


@pytest.mark.parametrize("kind", ["rigid", "N = 4", "joint stiffness", "beam", "unsymmetrical",
                                  "Maxwell", "loaded"])  # fmt: skip
def test_gradient_of_the_eigenvalues(kind):
    """Repeated ones too: a symmetric coach's parameters move both of its bogies alike."""
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    found = roots_with_gradient(here)
    assert found.names == tuple(", ".join(filter(None, (m.label, m.phase))) for m in modes(model))
    roots = found.eigenvalues
    for k, name in enumerate(derivatives.parameters):
        scale = np.abs(roots) / (abs(float(here.values[name])) or 1.0)
        expected = along(lambda **c: eigenvalues_near(model, roots, **c), derivatives, name)
        np.testing.assert_allclose(found.slopes[:, k] / scale, expected / scale, rtol=1e-7,
                                   atol=3e-9, err_msg=name)  # fmt: skip
        f = along(lambda **c: np.abs(eigenvalues_near(model, roots, **c)) / (2 * np.pi),
                  derivatives, name)  # fmt: skip
        np.testing.assert_allclose(found.frequency_slopes[:, k] / scale, f / scale, rtol=1e-7,
                                   atol=3e-9)  # fmt: skip
        zeta = along(lambda **c: _damping(eigenvalues_near(model, roots, **c)), derivatives, name)
        scale = 1 / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(found.damping_slopes[:, k] / scale, zeta / scale, rtol=1e-7,
                                   atol=3e-9)  # fmt: skip


def _damping(roots):
    return -roots.real / np.abs(roots)


def test_two_equal_bogies_pitch_as_one_alone_does():
    """I_b θ̈ + 2 l_w² c_1 θ̇ + 2 l_w² k_1 θ = 0, twice: 14.07 Hz."""
    derivatives = Derivatives(paper_coach(1))
    found = roots_with_gradient(derivatives.at())
    pitch = [k for k, name in enumerate(found.names) if name.startswith("bogie pitch")]
    np.testing.assert_allclose(found.frequencies[pitch], 14.0674, atol=5e-5)
    f, zeta = found.frequencies[pitch[0]], 1.25**2 * 30e3 / np.sqrt(2e3 * 2 * 1.25**2 * 5e6)
    np.testing.assert_allclose(found.damping_ratios[pitch], zeta, rtol=1e-12)
    by_hand = {  # d ln f/d ln p, d ln ζ/d ln p
        "k_1": (0.5, -0.5), "c_1": (0.0, 1.0), "I_b": (-0.5, -0.5), "l_w": (1.0, 1.0),
        "m_b": (0.0, 0.0), "k_2": (0.0, 0.0), "l_b": (0.0, 0.0),
    }  # fmt: skip
    values = derivatives.at().values
    for name, (of_f, of_zeta) in by_hand.items():
        k = derivatives.parameters.index(name)
        p = float(values[name])
        np.testing.assert_allclose(found.frequency_slopes[pitch, k] * p / f, of_f, atol=1e-9)
        np.testing.assert_allclose(found.damping_slopes[pitch, k] * p / zeta, of_zeta, atol=1e-9)


def test_a_repeated_eigenvalue_splits_as_one_bogie_alone_is_changed():
    """Of two bogies made equal, one pitches faster with its own stiffness, the other stays."""
    coach = load_vehicle("cati2024")
    first, second = coach.bogies
    unequal = replace(coach, bogies=(replace(first, primary_stiffness=5.1e6), second))
    model = derive_vehicle(unequal, 1)
    found = roots_with_gradient(Derivatives(model, ["k_1_b1"]).at(k_1_b1=5e6))
    pitch = [k for k, name in enumerate(found.names) if name.startswith("bogie pitch")]
    relative = found.frequency_slopes[pitch, 0] * 5e6 / found.frequencies[pitch]
    np.testing.assert_allclose(relative, [0.0, 0.5], atol=1e-9)


def test_static_deflections_of_a_rigid_coach_by_hand():
    """s = -m_c g/2k_2 and p = -(m_c/2 + m_b) g/2k_1."""
    derivatives = Derivatives(paper_coach(1), ["m_c", "m_b", "k_1", "k_2", "c_2", "l_b"])
    found, slopes = static_deflections_with_gradient(derivatives.at())
    s, p = -34e3 * 9.80665 / 1.5e6, -20e3 * 9.80665 / 1e7
    assert list(found)[:3] == ["secondary_1_deflection", "primary_1_deflection",
                               "primary_2_deflection"]  # fmt: skip
    np.testing.assert_allclose(list(found.values()), [s, p, p] * 2, rtol=1e-12)
    of_s = [s / 34e3, 0.0, 0.0, -s / 750e3, 0.0, 0.0]
    of_p = [p / 40e3, p / 20e3, -p / 5e6, 0.0, 0.0, 0.0]
    np.testing.assert_allclose(slopes, [of_s, of_p, of_p] * 2, rtol=1e-10, atol=1e-15)


@pytest.mark.parametrize("kind", ["N = 4", "unsymmetrical", "Maxwell", "loaded beam"])
def test_static_deflections_carry_the_weight_and_have_its_gradient(kind):
    model = model_of(kind)
    derivatives = Derivatives(model)
    here = derivatives.at()
    found, slopes = static_deflections_with_gradient(here)
    gear, names = model.running_gear, list(found)
    springs = {f"secondary_{b}_deflection": gear.symbol("secondary_stiffness", b).name
               for b in gear.bogies}  # fmt: skip
    carried = sum(-float(here.values[k]) * found[name] for name, k in springs.items())
    on_wheels = sum(-float(here.values[gear.symbol("primary_stiffness", b).name])
                    * found[f"primary_{j}_deflection"]
                    for b in gear.bogies for j, _ in gear.levers(b))  # fmt: skip
    bogies = sum(bogie.mass for bogie in model.vehicle.bogies)
    assert on_wheels - carried == pytest.approx(9.80665 * bogies, rel=1e-9)
    load = sum(one.mass for one in (*model.vehicle.payload, *model.vehicle.equipment))
    assert carried == pytest.approx(9.80665 * (model.vehicle.body.mass + load), rel=1e-9)

    def at_rest(**changes):
        m = model.matrices(**changes)
        rows = model.output_rows([model.outputs[name] for name in names], **changes)
        return rows["d"] @ np.linalg.solve(m.K, -9.80665 * m.M @ m.lift)

    for k, name in enumerate(derivatives.parameters):
        scale = np.max(np.abs(list(found.values()))) / (abs(float(here.values[name])) or 1.0)
        np.testing.assert_allclose(slopes[:, k] / scale, along(at_rest, derivatives, name) / scale,
                                   rtol=1e-7, atol=1e-9, err_msg=name)  # fmt: skip
