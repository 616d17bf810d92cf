"""Mean squares in closed form: Lyapunov's equation, closed forms, and the quadrature."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import scipy.integrate
import scipy.linalg
import scipy.optimize
import scipy.signal
from vehicles import paper_coach, random_model, random_vehicle

from railride.comfort import sperling_weighting
from railride.errors import InputError
from railride.firstorder import first_order, first_orders
from railride.frequency import track_response, triangular
from railride.numeric import Matrices
from railride.parameters import Load, load_vehicle
from railride.spectra import Spectrum, spectrum, spectrum_names, temporal
from railride.stochastic import process, squares, weighted_rms
from railride.stochastic import weighted_rms_of_many as rms_of_many
from railride.stochastic.contour import RAY, contour
from railride.stochastic.extremes import low_pass, moment
from railride.stochastic.fractions import eigen_forms, partial_fractions
from railride.stochastic.gains import PLAIN, Gain, rational, sperling, weighted
from railride.stochastic.process import BAND_HZ
from railride.stochastic.residues import residue_squares
from railride.stochastic.ride import floor_in_hand
from railride.stochastic.squares import mean_squares
from railride.vehicle import derive_vehicle
from railride.weightings import weighting, weighting_names

KMH = 1 / 3.6
LOW, WK = spectrum("erri_low"), weighting("Wk")
GAINS = (PLAIN, weighted(WK), sperling())


def both_ways(model, V, of, at, gains=GAINS, band=BAND_HZ, **changes):
    """Mean squares and stated errors: by residues, by quadrature."""
    m, rows = floor_in_hand(model, at, "smooth", changes)
    places = model.vehicle.wheelset_positions
    found, error = residue_squares(m, rows, places, [V], of, gains, band)
    by_rule = process(m, rows, places, V, of, gains, band=band).integrals()
    return found[0, 0], error[0, 0], by_rule.mean_square, by_rule.error


# Closed forms


def one_mass(f_0, zeta):
    """A mass on a spring and a damper over one wheelset, 1 kg."""
    k, c = (2 * np.pi * f_0) ** 2, 4 * np.pi * f_0 * zeta
    one = np.ones((1, 1))
    m = Matrices(M=one, C=c * one, K=k * one, K_w=k * one, C_w=c * one, B_f=0 * one,
                 lift=np.ones(1))  # fmt: skip
    rows = dict.fromkeys(("a", "v", "d", "w", "dw", "ddw", "f"), 0 * one)
    return m, rows | {"v": one}


WHITE = Spectrum("white velocity", "here", "m^2/(rad/m)", "one-sided",
                 lambda O: 1 / O**2, poles=(0j,))  # noqa: E741  # fmt: skip


@pytest.mark.parametrize("zeta", [0.9, 0.3, 0.01, 1e-4, 2e-6])
def test_white_noise_through_one_mode(zeta):
    """∫₀^∞ |(1 + 2iζr)/(1 - r² + 2iζr)|² df = π f_0 (1 + 4ζ²)/(4ζ), r = f/f_0 (Newland, 7.3).

    Below the band the integrand is 1, above it (2ζ/r)².
    """
    V, f_0, (low, high) = 1.0, 3.0, (1e-6, 1e9)
    m, rows = one_mass(f_0, zeta)
    found, error = residue_squares(m, rows, [0.0], [V], WHITE, (PLAIN,), (low, high))
    exact = np.pi * f_0 * (1 + 4 * zeta**2) / (4 * zeta) - low - (2 * zeta * f_0) ** 2 / high
    exact *= 2 * np.pi * V  # the density of ẇ, m²/s² per Hz
    assert found[0, 0, 0, 0] == pytest.approx(exact, rel=max(1e-14, 1e-15 / zeta))
    assert error[0, 0, 0, 0] < max(1e-13, 1e-14 / zeta)


@pytest.mark.parametrize("band", [(0.05, 80.0), (2.9, 80.0), (0.05, 3.1), (0.5, 2.9), (3.5, 5.0)])
def test_one_mode_within_a_band(band):
    """The band cuts the resonance at 3 Hz, its edges near the pole: scipy's quadrature."""
    V, f_0, zeta = 1.0, 3.0, 0.02
    m, rows = one_mass(f_0, zeta)
    found, error = mean_squares(m, rows, [0.0], [V], WHITE, (PLAIN,), band)

    def density(f):
        r = f / f_0
        return 2 * np.pi * V * abs((1 + 2j * zeta * r) / (1 - r**2 + 2j * zeta * r)) ** 2

    exact = scipy.integrate.quad(density, *band, epsrel=1e-13, epsabs=0.0, limit=200, points=[3.0]
                                 if band[0] < 3 < band[1] else None)[0]  # fmt: skip
    assert found[0, 0, 0, 0] == pytest.approx(exact, rel=1e-11)
    assert error[0, 0, 0, 0] < 1e-8


def lyapunov_square(model, V, at, weight=None):
    """Mean square of the (weighted) acceleration over all frequencies on ERRI B176 low.

    Every wheelset i drives a system x_i' = A_i x_i + b n(t - τ_i) of shaping filter (w, ẇ), vehicle
    and weighting by the same white noise n. Its part of the covariance with that of j, τ_i ≥ τ_j,
    is X_ij e^{A_jᵀ (τ_i - τ_j)}, with A_i X + X A_jᵀ + b bᵀ = 0.
    """
    Av, Or, Oc = 4.032e-7, 0.0206, 0.8246
    m, (row,) = model.matrices(), model.output_rows([model.floor(at, derivative=0)])["d"]
    n = len(m.M)
    sections = [scipy.signal.tf2ss(*pair) for pair in (weight.factors() if weight else ())]
    of_vehicle = np.hstack([-np.linalg.solve(m.M, m.K), -np.linalg.solve(m.M, m.C)])
    systems = []
    for i in range(m.K_w.shape[1]):
        drive = np.linalg.solve(m.M, np.stack([m.K_w[:, i], m.C_w[:, i]], axis=1))
        A = np.block([
            [np.array([[0.0, 1.0], [-Or * Oc * V**2, -(Or + Oc) * V]]), np.zeros((2, 2 * n))],
            [np.zeros((n, 2 + n)), np.eye(n)],
            [drive, of_vehicle],
        ])  # fmt: skip
        C = row @ A[2 + n :]
        for a, b, c, d in sections:
            A = np.block([[A, np.zeros((len(A), len(a)))], [b @ C[np.newaxis], a]])
            C = np.concatenate([d[0, 0] * C, c[0]])
        systems.append((A, C))
    b = np.zeros((len(A), 1))
    b[1] = np.sqrt(np.pi * V**3 * Av * Oc**2)
    places = model.vehicle.wheelset_positions
    total = 0.0
    for i, (A_i, C_i) in enumerate(systems):
        for j, (A_j, C_j) in enumerate(systems[: i + 1]):
            X = scipy.linalg.solve_sylvester(A_i, A_j.T, -b @ b.T)
            lagged = X @ scipy.linalg.expm(A_j.T * (places[j] - places[i]) / V)
            total += (1 if i == j else 2) * (C_i @ lagged @ C_j)
    return total


@pytest.mark.parametrize("V", [15.0, 40.0, 90.0])
@pytest.mark.parametrize("weight", [None, WK], ids=["plain", "weighted"])
@pytest.mark.parametrize(("model", "at"), [(paper_coach(2), 0.0), (random_model(0, 4), 3.0)],
                         ids=["paper", "random"])  # fmt: skip
def test_all_frequencies_equal_lyapunovs_equation(model, at, weight, V):
    m, rows = floor_in_hand(model, [at], "smooth", {})
    gains = (weighted(weight) if weight else PLAIN,)
    places = model.vehicle.wheelset_positions
    found, error = residue_squares(m, rows, places, [V], LOW, gains, (1e-6, 1e6))
    exact = lyapunov_square(model, V, at, weight)
    assert found[0, 0, 0, 0] == pytest.approx(exact, rel=1e-9)
    assert error[0, 0, 0, 0] < 1e-9


# The quadrature


@cache
def maxwell_coach(primary, secondary, segments=4):
    """The paper's coach with elastic mounts on its dampers, N/m per axle and per bogie."""
    vehicle = load_vehicle("cati2024")
    bogies = tuple(
        replace(b, primary_damper_stiffness=primary, secondary_damper_stiffness=secondary)
        for b in vehicle.bogies
    )
    return derive_vehicle(replace(vehicle, bogies=bogies), segments)


@cache
def loaded(seed, segments):
    """An unsymmetric vehicle with an unsymmetric payload."""
    load = Load(mass=6e3, front=5.0, rear=-2.0)
    return derive_vehicle(replace(random_vehicle(seed), payload=(load,)), segments)


VEHICLES = {
    "paper, rigid": (paper_coach(1), {}),
    "paper, N = 2": (paper_coach(2), {}),
    "paper, N = 4": (paper_coach(4), {"c_theta": 1e4}),
    "paper, N = 8": (paper_coach(8), {"c_theta": 1e4}),  # modes beyond the band's end
    "manchester": (derive_vehicle("manchester"), {}),
    "ice3": (derive_vehicle("ice3"), {}),
    "shinkansen": (derive_vehicle("shinkansen_s300"), {}),
    "random 0, rigid": (random_model(0, 1), {}),
    "random 1, N = 2": (random_model(1, 2), {}),
    "random 2, N = 4": (random_model(2, 4), {}),
    "random 3, N = 8": (random_model(3, 8), {}),
    "payload": (loaded(4, 4), {}),
    "mounts": (maxwell_coach(2e6, 12e6), {"c_theta": 1e4}),
    "mounts of secondary dampers": (maxwell_coach(None, 12e6, 2), {}),
}


@pytest.mark.parametrize("V", [10 * KMH, 145 * KMH, 400 * KMH])
@pytest.mark.parametrize("of", ["erri_low", "fra_4"])
@pytest.mark.parametrize("name", VEHICLES)
def test_residues_equal_the_quadrature(name, of, V):
    model, changes = VEHICLES[name]
    found, error, exact, rounding = both_ways(model, V, spectrum(of), [-6.0, 0.0, 2.5], **changes)
    np.testing.assert_allclose(found, exact, rtol=1e-10)
    assert (np.abs(found / exact - 1) < error + rounding).all()
    assert (error < 1e-8).all()


@pytest.mark.parametrize("V", [20.0, 60.0, 250 * KMH])
def test_next_to_no_damping(V):
    """Bending 2 off the middle, ζ = 2e-6: its pole is known to 1e-10 of its distance from the axis.

    Both ways differ by what they say.
    """
    found, error, exact, rounding = both_ways(paper_coach(4), V, LOW, [6.0])
    assert (np.abs(found / exact - 1) < error + rounding).all()
    assert (error < 3e-9).all()
    np.testing.assert_allclose(found, exact, rtol=1e-9)


@pytest.mark.parametrize(
    "band", [(0.0, 80.0), (0.5, 80.0), (0.05, 20.0), (0.2, 200.0), (1.0, 10.0), (8.0, 9.9)]
)
@pytest.mark.parametrize("seed", range(3))
def test_other_bands(seed, band):
    model, V = random_model(seed, 4), 35.0
    m, rows = floor_in_hand(model, [-8.0, 1.0], "smooth", {})
    places = model.vehicle.wheelset_positions
    found, error = mean_squares(m, rows, places, [V], LOW, GAINS, band)
    exact = process(m, rows, places, V, LOW, GAINS, band=band).integrals().mean_square
    np.testing.assert_allclose(found[0, 0], exact, rtol=1e-9)
    assert (error < 1e-8).all()


@pytest.mark.parametrize("name", weighting_names())
def test_every_weighting(name):
    """W_m has a double pole, its numerator's zero beside it: it is integrated if need be."""
    model, V, gains = random_model(1, 2), 50.0, (weighted(weighting(name)),)
    m, rows = floor_in_hand(model, [4.0], "smooth", {})
    places = model.vehicle.wheelset_positions
    found, _ = mean_squares(m, rows, places, [V], LOW, gains)
    exact = process(m, rows, places, V, LOW, gains).integrals().mean_square
    np.testing.assert_allclose(found[0, 0], exact, rtol=1e-9)


# What is stated of the error


def nearly_critical(model):
    """c_2 at which two real eigenvalues of the coach meet: it has no eigenvectors there."""

    def gap(c_2):
        p = triangular(model.matrices(c_2=c_2)).T.diagonal()
        p = p[np.abs(p) < 60]
        return np.abs(np.subtract.outer(p, p) + 1e9 * np.eye(p.size)).min()

    return scipy.optimize.minimize_scalar(gap, bounds=(170.9e3, 171.1e3), method="bounded",
                                          options={"xatol": 1e-9}).x  # fmt: skip


def test_eigenvectors_that_nearly_coincide_are_noticed():
    model, V = paper_coach(4), 40.0
    meets = nearly_critical(model)
    doubted = []
    for away in (0.0, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2):
        changes = {"c_2": meets * (1 + away), "c_theta": 1e4}
        found, error, exact, rounding = both_ways(model, V, LOW, [0.0, 5.0], **changes)
        assert (np.abs(found / exact - 1) < error + rounding).all()
        doubted.append(float(error.max()))
        places, rows = model.vehicle.wheelset_positions, model.output_rows([model.floor()])
        a_w, stated = weighted_rms(model.matrices(**changes), rows, places, V, LOW, WK)
        np.testing.assert_allclose(a_w, np.sqrt(exact[1, :1]), rtol=1e-9)
        assert stated < 1e-8
    assert doubted[0] > squares.TRUSTED > doubted[-1]


def test_equal_bogies_have_repeated_poles_and_that_does_no_harm():
    p = triangular(paper_coach(2).matrices()).T.diagonal()
    assert np.sort(np.abs(np.subtract.outer(p, p) + np.eye(p.size)), axis=None)[0] < 1e-9
    found, error, exact, _ = both_ways(paper_coach(2), 40.0, LOW, [0.0, 5.0])
    np.testing.assert_allclose(found, exact, rtol=1e-12)
    assert (error < 1e-10).all()


def test_fractions_are_the_vehicle_and_say_where_they_are_not():
    model = random_model(0, 2)
    m, rows = floor_in_hand(model, [0.0, 3.0], "smooth", {})
    g = partial_fractions(eigen_forms(m), rows)
    s = np.array([[3.0 + 20j, 1e-3 + 100j, 5j, -2.0 + 300j]])
    q = np.linalg.solve(m.K + s[0, :, None, None] * (m.C + s[0, :, None, None] * m.M),
                        m.K_w + s[0, :, None, None] * m.C_w)  # fmt: skip
    np.testing.assert_allclose(g.response(s)[0], rows["a"] @ q, rtol=1e-9)
    assert (g.mismatch(s) < 1e-9).all()
    wrong = replace(g, residues=g.residues * np.where(np.arange(g.poles.shape[1]) == 2, 1.001, 1)[
        :, np.newaxis])  # fmt: skip
    assert wrong.mismatch(1j * np.abs(g.poles)).max() > 1e-4


# Where residues are not taken


@pytest.mark.parametrize("of", ["sncf_good", "china_ballastless"])
def test_spectra_that_are_not_rational_are_integrated(of):
    model, V = paper_coach(2), 40.0
    m, rows = floor_in_hand(model, [0.0, 5.0], "smooth", {})
    places = model.vehicle.wheelset_positions
    assert residue_squares(m, rows, places, [V], spectrum(of), GAINS, BAND_HZ) is None
    found, error = mean_squares(m, rows, places, [V], spectrum(of), GAINS)
    by_rule = process(m, rows, places, V, spectrum(of), GAINS).integrals()
    np.testing.assert_array_equal(found[0, 0], by_rule.mean_square)
    assert (error[0, 0] >= by_rule.error).all()  # that of the equations comes to it
    np.testing.assert_allclose(error[0, 0], by_rule.error, rtol=0, atol=1e-12)


# Outputs that feel the track at once


@cache
def weighed(name):
    """A vehicle of those above whose wheelsets' masses are known."""
    model, changes = VEHICLES[name]
    bogies = tuple(replace(b, wheelset_mass=1200.0) for b in model.vehicle.bogies)
    segments = model.body.segments or 1
    return derive_vehicle(replace(model.vehicle, bogies=bogies), segments), changes


DIRECT = ("primary_1_deflection", "wheel_load_1", "wheel_load_3")
LOADS = tuple(moment(low_pass(20.0), k) for k in (0, 2))


def simpson(model, output, V, gain, **changes):
    """Mean square of an output between 0.05 and 80 Hz, by its response at many frequencies."""
    f = np.geomspace(0.05, 80.0, 400_001)
    H = track_response(model, [output], V, f, **changes)[0]
    density = gain.power(f) * np.abs(H) ** 2 * temporal(LOW, V)(f)
    return scipy.integrate.simpson(density, x=f)


@pytest.mark.parametrize("name", ["paper, N = 4", "random 1, N = 2", "mounts"])
@pytest.mark.parametrize("output", DIRECT)
def test_outputs_that_feel_the_track_at_once(name, output):
    """Deflections by w, loads by w, ẇ and ẅ."""
    model, changes = weighed(name)
    V, gain = 40.0, LOADS[0] if "load" in output else PLAIN
    m, rows = model.matrices(**changes), model.output_rows([model.outputs[output]], **changes)
    places = model.vehicle.wheelset_positions
    found, error = residue_squares(m, rows, places, [V], LOW, (gain,), BAND_HZ)
    exact = simpson(model, model.outputs[output], V, gain, **changes)
    assert found[0, 0, 0, 0] == pytest.approx(exact, rel=1e-7)
    assert error[0, 0, 0, 0] < 1e-9


@pytest.mark.parametrize("V", [10 * KMH, 145 * KMH, 400 * KMH])
@pytest.mark.parametrize("name", VEHICLES)
def test_deflections_and_wheel_loads_equal_the_quadrature(name, V):
    model, changes = weighed(name)
    deflections = [output for key, output in model.outputs.items() if "deflection" in key]
    loads = [output for key, output in model.outputs.items() if "wheel_load" in key]
    m, places = model.matrices(**changes), model.vehicle.wheelset_positions
    forms = eigen_forms(m)
    moments = (PLAIN, moment(PLAIN, 2))
    for outputs, gains in ((deflections, moments), (loads, LOADS)):
        rows = model.output_rows(outputs, **changes)
        by_rule = process(m, rows, places, V, LOW, gains).integrals()
        # f² times a primary deflection, which is -w in the end, falls as 1/f² with this track.
        found, error = residue_squares(m, rows, places, [V], LOW, gains, BAND_HZ, forms)
        np.testing.assert_allclose(found[0, 0], by_rule.mean_square, rtol=1e-9)
        off = np.abs(found[0, 0] / by_rule.mean_square - 1)
        assert (off < error[0, 0] + by_rule.error).all()
        assert (error < 1e-8).all()


@pytest.mark.parametrize("name", ["paper, N = 4", "mounts"])
def test_outputs_of_unlike_rates_together(name):
    """Accelerations of bogies, which dampers push with ẇ, beside deflections and loads."""
    model, changes = weighed(name)
    chosen = ("bogie_1_acceleration", "primary_1_deflection", "wheel_load_3")
    m, places = model.matrices(**changes), model.vehicle.wheelset_positions
    rows = model.output_rows([model.outputs[key] for key in chosen], **changes)
    found, error = residue_squares(m, rows, places, [40.0], LOW, LOADS[:1], BAND_HZ)
    exact = process(m, rows, places, 40.0, LOW, LOADS[:1]).integrals().mean_square
    np.testing.assert_allclose(found[0, 0], exact, rtol=1e-9)
    assert (error < 1e-8).all()


def test_loads_without_a_low_pass_do_not_fall_and_are_integrated():
    model, _ = weighed("paper, N = 4")
    m, rows = model.matrices(), model.output_rows([model.outputs["wheel_load_2"]])
    places = model.vehicle.wheelset_positions
    assert residue_squares(m, rows, places, [40.0], LOW, (PLAIN,), BAND_HZ) is None
    found, _ = mean_squares(m, rows, places, [40.0], LOW, (PLAIN,))
    exact = simpson(model, model.outputs["wheel_load_2"], 40.0, PLAIN)
    assert found[0, 0, 0, 0] == pytest.approx(exact, rel=1e-7)


def test_a_damper_that_follows_the_track_at_once():
    """A mass on a spring, and on a damper with a spring above it: the point between has no mass."""
    m = Matrices(
        M=np.diag([1.0, 0.0]),
        C=np.diag([2.0, 9.0]),
        K=np.array([[900.0, -500.0], [-500.0, 500.0]]),
        K_w=np.array([[400.0], [0.0]]),
        C_w=np.array([[2.0], [9.0]]),
        B_f=np.zeros((2, 1)),
        lift=np.ones(2),
    )
    rows = dict.fromkeys(("a", "v", "d", "w", "dw", "ddw"), np.zeros((1, 1)))
    for coordinate in (0, 1):
        rows["d"] = np.eye(2)[[coordinate]]
        found, error = residue_squares(m, rows, [0.0], [40.0], LOW, (PLAIN,), BAND_HZ)
        exact = process(m, rows, [0.0], 40.0, LOW).integrals().mean_square
        np.testing.assert_allclose(found[0, 0], exact, rtol=1e-12)
        assert error[0, 0, 0, 0] < 1e-11


# Where residues are not taken


def test_what_does_not_fall_towards_infinity_is_integrated():
    """f² times the bogie's acceleration on this track: its density does not fall."""
    model, V, gain = paper_coach(2), 40.0, Gain(1.0, (0.0,))
    m, places = model.matrices(), model.vehicle.wheelset_positions
    rows = model.output_rows([model.outputs["bogie_1_acceleration"]])
    assert residue_squares(m, rows, places, [V], LOW, (gain,), BAND_HZ) is None
    found, _ = mean_squares(m, rows, places, [V], LOW, (gain,))
    exact = process(m, rows, places, V, LOW, (gain,)).integrals().mean_square
    np.testing.assert_array_equal(found[0, 0], exact)


@pytest.mark.parametrize("V", [2.0, 40.0, 110.0])
@pytest.mark.parametrize("name", ["paper, N = 4", "random 1, N = 2", "mounts"])
def test_an_elevation_that_grows_without_end(name, V):
    """FRA's ∫ 1/Ω² dΩ from 0 is infinite: the path leads about rest, where deflections vanish."""
    model, changes = weighed(name)
    outputs = [model.floor(derivative=0), *model.outputs.values()]
    m, places, of = model.matrices(**changes), model.vehicle.wheelset_positions, spectrum("fra_4")
    for output in outputs:
        gain = LOADS[0] if output.name.startswith("wheel_load") else PLAIN
        rows = model.output_rows([output], **changes)
        found, error = residue_squares(m, rows, places, [V], of, (gain,), BAND_HZ)
        by_rule = process(m, rows, places, V, of, (gain,)).integrals()
        np.testing.assert_allclose(found[0, 0], by_rule.mean_square, rtol=1e-9)
        assert error < 1e-8
        assert np.abs(found[0, 0] / by_rule.mean_square - 1) < error[0, 0] + by_rule.error


def test_an_elevation_that_grows_without_end_has_no_square_from_rest_on():
    """From 0 Hz on the floor's motion there is infinite."""
    model = paper_coach(1)
    rows, places = model.output_rows([model.floor(derivative=0)]), model.vehicle.wheelset_positions
    of, band = spectrum("fra_4"), (0.0, 80.0)
    _, doubted = residue_squares(model.matrices(), rows, places, [40.0], of, (PLAIN,), band)
    assert not (doubted < 1e-8).any()


@pytest.mark.parametrize("low", [2.9, 2.99, 3.01, 3.1])
def test_the_path_about_rest_leaves_out_poles_within(low):
    """White velocity's elevation over a mode at 3 Hz, from below and above it on: scipy's."""
    V, f_0, zeta = 1.0, 3.0, 0.02
    m, rows = one_mass(f_0, zeta)
    rows = rows | {"d": rows["v"], "v": rows["d"]}
    found, error = residue_squares(m, rows, [0.0], [V], WHITE, (PLAIN,), (low, 80.0))

    def density(f):
        r = f / f_0
        H = (1 + 2j * zeta * r) / (1 - r**2 + 2j * zeta * r)
        return 2 * np.pi * V * abs(H) ** 2 / (2 * np.pi * f) ** 2

    exact = scipy.integrate.quad(density, low, 80.0, epsrel=1e-13, epsabs=0.0, limit=200)[0]
    assert found[0, 0, 0, 0] == pytest.approx(exact, rel=1e-8)
    assert abs(found[0, 0, 0, 0] / exact - 1) < error[0, 0, 0, 0] < 3e-7


def test_a_pole_on_the_path_is_integrated():
    """That about rest meets the pole's |λ| = 2π · 3 rad/s: it is on neither side."""
    V, f_0, zeta, band = 1.0, 3.0, 0.02, (3.0, 80.0)
    m, rows = one_mass(f_0, zeta)
    rows = rows | {"d": rows["v"], "v": rows["d"]}
    _, error = residue_squares(m, rows, [0.0], [V], WHITE, (PLAIN,), band)
    assert np.isinf(error).all()
    found, _ = mean_squares(m, rows, [0.0], [V], WHITE, (PLAIN,), band)
    exact = process(m, rows, [0.0], V, WHITE, band=band).integrals().mean_square
    np.testing.assert_array_equal(found[0, 0], exact)


def test_wheelsets_in_another_order_are_integrated():
    model, V = random_model(0, 2), 40.0
    m, rows = floor_in_hand(model, [3.0], "smooth", {})
    places = np.array(model.vehicle.wheelset_positions)
    turned = replace(m, K_w=m.K_w[:, ::-1], C_w=m.C_w[:, ::-1])
    assert residue_squares(turned, rows, places[::-1], [V], LOW, GAINS, BAND_HZ) is None
    found, _ = mean_squares(turned, rows, places[::-1], [V], LOW, GAINS)
    exact, _ = mean_squares(m, rows, places, [V], LOW, GAINS)
    np.testing.assert_allclose(found, exact, rtol=1e-11)


def test_modes_without_damping_count_where_they_are_felt_only():
    """Without c_1 nothing damps the bogies' pitch; the body's springs do not feel it."""
    model = paper_coach(2)
    rows, places = model.output_rows([model.floor()]), model.vehicle.wheelset_positions
    m = model.matrices(c_1=0.0)
    _, doubted = residue_squares(m, rows, places, [40.0], LOW, (PLAIN,), BAND_HZ)
    assert np.isinf(doubted).all()
    a_w, _ = weighted_rms(m, rows, places, 40.0, LOW, WK)
    nearly, _ = weighted_rms(model.matrices(c_1=1e-3), rows, places, 40.0, LOW, WK)
    np.testing.assert_allclose(a_w, nearly, rtol=1e-6)
    with pytest.raises(InputError, match="without damping"):
        weighted_rms(model.matrices(c_1=0.0, c_2=0.0), rows, places, 40.0, LOW, WK)
    with pytest.raises(InputError, match="unstable"):
        weighted_rms(model.matrices(c_2=-5e3), rows, places, 40.0, LOW, WK)


@pytest.mark.parametrize("speed", [0.0, -1.0, np.nan, np.inf])
def test_speeds_that_are_none_are_refused(speed):
    model = paper_coach(1)
    rows, places = model.output_rows([model.floor()]), model.vehicle.wheelset_positions
    for speeds in ([], [40.0, speed]):
        with pytest.raises(InputError, match="speed"):
            rms_of_many(model.matrices(), rows, places, speeds, LOW, WK)


# Many vehicles at once


@cache
def designs(count=150):
    rng = np.random.default_rng(5)
    given = {"k_1": 5e6, "k_2": 750e3, "c_2": 70e3, "k_theta": 3.7e8}
    return {name: value * rng.uniform(0.5, 2, count) for name, value in given.items()}


def test_many_at_once_are_each_alone():
    model, speeds = paper_coach(4), [145 * KMH, 200 * KMH]
    places, changes = model.vehicle.wheelset_positions, designs()
    outputs = [model.floor(), model.floor(4.0)]
    m, rows = model.matrices(**changes), model.output_rows(outputs, **changes)
    found, error = rms_of_many(m, rows, places, speeds, LOW, WK)
    assert found.shape == error.shape == (150, 2, 2)
    assert (error < 1e-8).all()
    for k in (0, 1, 63, 64, 149):
        one = {name: value[k] for name, value in changes.items()}
        for j, V in enumerate(speeds):
            alone, _ = weighted_rms(model.matrices(**one), model.output_rows(outputs, **one),
                                    places, V, LOW, WK)  # fmt: skip
            np.testing.assert_allclose(found[k, j, 0], alone[0], rtol=1e-11)
            np.testing.assert_allclose(found[k, j, 1], alone[1], rtol=1e-9)  # bending 2


@pytest.mark.parametrize("model", [paper_coach(4), maxwell_coach(2e6, 12e6)], ids=["", "mounts"])
def test_first_orders_are_each_vehicles_own(model):
    changes = {"k_2": [6e5, 9e5], "c_1": [20e3, 40e3]}
    many = first_orders(model.matrices(**changes))
    for k in range(2):
        one = first_order(model.matrices(k_2=changes["k_2"][k], c_1=changes["c_1"][k]))
        for name in ("A", "B", "v_x", "v_f", "a_x", "a_f"):
            np.testing.assert_array_equal(getattr(many, name)[k], getattr(one, name))
        np.testing.assert_array_equal(many.q_x, one.q_x)
    with pytest.raises(InputError, match="one vehicle at a time"):
        first_order(model.matrices(**changes))


def test_rows_may_be_the_same_for_all():
    model, changes = paper_coach(2), {"k_2": [6e5, 9e5]}
    m, places = model.matrices(**changes), model.vehicle.wheelset_positions
    shared, own = (rms_of_many(m, model.output_rows([model.floor()], **of), places, [40.0], LOW, WK)
                   for of in ({}, changes))  # fmt: skip
    np.testing.assert_array_equal(shared[0], own[0])


def test_one_that_would_be_refused_does_not_stop_the_others():
    """Unstable, without damping that is felt, without damping that is not felt, sound."""
    model = paper_coach(2)
    rows, places = model.output_rows([model.floor()]), model.vehicle.wheelset_positions
    m = model.matrices(c_2=[-5e3, 0.0, 70e3, 70e3], c_1=[30e3, 0.0, 0.0, 30e3])
    a_w, error = rms_of_many(m, rows, places, [40.0], LOW, WK)
    assert np.isnan(a_w[:2]).all()
    assert np.isinf(error[:2]).all()
    for k, c_1 in ((2, 0.0), (3, 30e3)):
        alone, _ = weighted_rms(model.matrices(c_1=c_1), rows, places, 40.0, LOW, WK)
        np.testing.assert_allclose(a_w[k, 0], alone, rtol=1e-11)
    assert (error[2:] < 1e-9).all()


def test_many_on_a_spectrum_that_is_not_rational():
    model, of = paper_coach(1), spectrum("sncf_good")
    rows, places = model.output_rows([model.floor()]), model.vehicle.wheelset_positions
    a_w, _ = rms_of_many(model.matrices(k_2=[6e5, 9e5]), rows, places, [30.0, 40.0], of, WK)
    for k, k_2 in enumerate((6e5, 9e5)):
        alone, _ = weighted_rms(model.matrices(k_2=k_2), rows, places, 40.0, of, WK)
        np.testing.assert_allclose(a_w[k, 1], alone, rtol=1e-12)


@pytest.mark.parametrize(("segments", "printed"), [(2, ("0.2475", "0.3275")),
                                                   (1, ("0.0494", "0.0756"))])  # fmt: skip
def test_the_papers_coach_at_145_and_200_kmh(segments, printed):
    """ERRI B176 low, at the middle, polygon, W_k: values that two programs agree on."""
    model = paper_coach(segments)
    rows, places = (
        model.output_rows([model.floor(0.0, "polygon")]),
        model.vehicle.wheelset_positions,
    )
    a_w, error = rms_of_many(model.matrices(), rows, places, [145 * KMH, 200 * KMH], LOW, WK)
    assert tuple(f"{a:.4f}" for a in a_w[0, :, 0]) == printed
    assert (error < 1e-11).all()


# Rational functions, contours


@pytest.mark.parametrize("name", weighting_names())
def test_gains_are_the_weightings(name):
    f = np.geomspace(0.01, 500.0, 301)
    power = weighted(weighting(name)).power(f)
    np.testing.assert_allclose(power, np.abs(weighting(name).response(f)) ** 2, rtol=1e-12)


def test_sperlings_gain_is_his_weighting():
    f = np.geomspace(0.01, 500.0, 301)
    np.testing.assert_allclose(sperling().power(f), sperling_weighting(f) ** 2, rtol=1e-12)


def test_rational_spectra_are_found():
    f = np.geomspace(0.01, 500.0, 301)
    for name in spectrum_names():
        gain = rational(spectrum(name), 40.0)
        assert (gain is None) == (name.startswith(("sncf", "china")))
        if gain is not None:
            exact = temporal(spectrum(name), 40.0)(f)
            np.testing.assert_allclose(gain.power(f), exact, rtol=1e-12)
    unpaired = replace(LOW, poles=LOW.poles[:3])
    assert rational(unpaired, 40.0) is None
    bent = replace(LOW, formula=lambda O: LOW.formula(O) * (1 + 1e-9 * np.sqrt(O)))  # noqa: E741
    assert rational(bent, 40.0) is None


def test_what_vanishes_at_rest_cancels_what_is_infinite_there():
    assert Gain(2.0, (0.0, 1.0), (4.0,)) * Gain(3.0, (), (0j, 9.0)) == Gain(6.0, (1.0,), (4.0, 9.0))


def test_panels_of_a_contour_shrink_towards_the_vehicles_poles():
    densities, lag, band = (Gain(1.0, (), (-4.0, -9.0)),), 0.3, (0.05, 80.0)
    near = 2j * np.pi * np.array([80.01, 0.04 + 1e-4j, 20.0])
    usual = contour(densities, lag, band, near[2:])
    assert usual is contour(densities, lag, band, near[2:])
    assert usual.resolves(near[2:])
    for pole in near[:2]:
        assert not usual.resolves(np.array([pole]))
        assert contour(densities, lag, band, np.array([pole])).resolves(np.array([pole]))
    beyond = 2j * np.pi * 80.0 + RAY * 1.0 + 0.1j
    assert usual.holds(np.array([beyond - 0.2j]))[0]
    assert not usual.holds(np.array([beyond]))[0]
