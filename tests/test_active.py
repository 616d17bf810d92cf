"""Control of the secondary suspension: against a quarter car in closed form, peers and limits."""

from __future__ import annotations

from dataclasses import replace

import control
import numpy as np
import pandas as pd
import pytest
import scipy.linalg
import scipy.signal
from vehicles import paper_coach, random_model

from railride import load_vehicle
from railride.active import (
    Loop,
    actuator_dynamics,
    closed_response,
    loop_spectra,
    lqg,
    rate_loop,
    rate_loops,
    semi_active_ride,
    skyhook,
    suspension_signals,
)
from railride.active.loop import respond
from railride.active.lqg import ERRI_POLES, _design, _noise_intensity, _weighting_system
from railride.active.semiactive import _at_rest, _march, _passive, _Switched, _switched
from railride.errors import InputError
from railride.frequency import track_response
from railride.plots.active import plot_loop_spectra, plot_loops
from railride.rides import ride
from railride.running_gear import primary_deflection
from railride.spectra import spectrum, temporal
from railride.statespace import state_space
from railride.stochastic import measured_spectrum, stochastic_ride
from railride.track import synthesise
from railride.vehicle import Output, derive_vehicle
from railride.weightings import weighting

V = 200 / 3.6
LOW = spectrum("erri_low")


# The heave of a symmetric rigid coach is a quarter car on each bogie: half the body on the
# secondary suspension, the bogie on its two axles.


def quarter_car(s, gain, actuator=1.0, high_pass=1.0):
    """Body height over track elevation, and the loop's closed-form matrix, at s: by hand."""
    vehicle = load_vehicle("cati2024")
    m, b = vehicle.body.mass / 2, vehicle.bogies[0]
    z2 = b.secondary_stiffness + b.secondary_damping * s
    z1 = 2 * (b.primary_stiffness + b.primary_damping * s)
    sky = gain * actuator * high_pass * s
    # m s² z = -z2 (z - z_b) - sky z;  m_b s² z_b = z2 (z - z_b) + sky z - z1 (z_b - w)
    determinant = (m * s**2 + z2 + sky) * (b.mass * s**2 + z2 + z1) - z2 * (z2 + sky)
    return z1 * z2 / determinant


def in_phase(loop, s):
    """Height of the floor's middle over elevations of all wheelsets alike, at s = iω."""
    G = loop.closed([loop.model.floor(0.0, derivative=0)])(s)[0]
    k = len(loop.model.linear.inputs)
    return G[:k].sum() + s * G[k : 2 * k].sum()


@pytest.mark.parametrize("f", [0.1, 0.97, 3.0, 9.5, 40.0])
@pytest.mark.parametrize("gain", [40e3, 200e3])
def test_ideal_skyhook_is_the_closed_form_quarter_car(gain, f):
    s = 2j * np.pi * f
    found = in_phase(skyhook(paper_coach(1), gain), s)
    assert found == pytest.approx(quarter_car(s, gain), rel=1e-9)


@pytest.mark.parametrize("f", [0.1, 1.0, 4.0, 30.0])
@pytest.mark.parametrize("order", [1, 2])
def test_a_real_actuator_and_its_high_pass_are_the_closed_form_quarter_cars(order, f):
    s, w_a, w_h = 2j * np.pi * f, 2 * np.pi * 6.0, 2 * np.pi * 0.2
    actuator = w_a / (s + w_a) if order == 1 else w_a**2 / (s**2 + np.sqrt(2) * w_a * s + w_a**2)
    loop = skyhook(paper_coach(1), 80e3, bandwidth=6.0, order=order, high_pass=0.2)
    expected = quarter_car(s, 80e3, actuator, s / (s + w_h))
    assert in_phase(loop, s) == pytest.approx(expected, rel=1e-9)


def test_skyhook_damps_heave_as_the_quarter_car_says():
    """The loop's poles hold the roots of the quarter car's determinant; heave is damped more."""
    vehicle, gain = load_vehicle("cati2024"), 100e3
    m, b = vehicle.body.mass / 2, vehicle.bogies[0]
    s = np.poly1d([1.0, 0.0])
    z2 = b.secondary_stiffness + b.secondary_damping * s
    z1 = 2 * (b.primary_stiffness + b.primary_damping * s)
    damping = []
    for c in (0.0, gain):
        roots = ((m * s**2 + z2 + c * s) * (b.mass * s**2 + z2 + z1) - z2 * (z2 + c * s)).roots
        poles = skyhook(paper_coach(1), c).poles
        for root in roots:
            assert np.abs(poles - root).min() < 1e-8 * abs(root)
        heave = roots[np.argmin(np.abs(roots))]
        damping.append(-heave.real / abs(heave))
    # c_sky adds c/(2 √(k m)) nearly: the primary suspension and its damping take little away.
    added = gain / (2 * np.sqrt(b.secondary_stiffness * m))
    assert damping[1] - damping[0] == pytest.approx(added, rel=0.15)


def test_no_gain_is_the_passive_vehicle():
    model = paper_coach(4)
    table = rate_loops([skyhook(model, 0.0)], V, LOW, at=(0.0, 8.0))
    passive, loop = table.loc["passive"], table.loc["skyhook"]
    np.testing.assert_allclose(loop, passive, rtol=1e-9)
    assert loop["force r.m.s. bogie 1 [N]"] == 0


@pytest.mark.parametrize("reading", ["smooth", "polygon"])
def test_the_passive_vehicle_has_its_exact_stochastic_ride(reading):
    model, at = paper_coach(4), (0.0, -8.0)
    exact = stochastic_ride(model, V, LOW, at, floor=reading)
    found = rate_loop(Loop("passive", model), V, LOW, at, floor=reading)
    np.testing.assert_allclose(found.a_wrms, exact.a_wrms, rtol=1e-9)
    np.testing.assert_array_equal(found.force, 0)
    assert found.modulus_margin == 1


def test_passive_response_with_delays_is_the_vehicles():
    model, f = random_model(1, 3), np.geomspace(0.05, 80, 300)
    outputs = [model.floor(2.0), model.outputs["secondary_2_deflection"]]
    found = closed_response(Loop("passive", model).closed(outputs), model, 37.0, f)
    expected = track_response(model, outputs, 37.0, f)
    worst = np.abs(found - expected).max(axis=1) / np.abs(expected).max(axis=1)
    assert worst.max() < 1e-9


def test_loop_on_names_is_python_controls_feedback():
    """interconnect by names against feedback, with the controller's matrices put in place."""
    model = random_model(3, 3)
    loop = skyhook(model, 60e3, bandwidth=8.0, order=1)
    outputs = [model.floor(1.0), *loop.measured]
    plant, k, n = state_space(model, outputs), 2 * len(model.linear.inputs), len(loop.measured)
    hear = np.hstack([np.zeros((n, 1)), np.eye(n)])
    act = np.vstack([np.zeros((k, n)), np.eye(n)])
    K = loop.controller
    wide = control.ss(K.A, K.B @ hear, act @ K.C, act @ K.D @ hear)
    s = 2j * np.pi * 4.2
    expected = control.feedback(plant, wide, sign=1)(s)[:, :k]
    found = loop.closed(outputs)(s)
    np.testing.assert_allclose(found[: n + 1], expected, rtol=1e-9)
    np.testing.assert_allclose(found[n + 1 :], K(s) @ expected[1:], rtol=1e-9)


def test_white_noise_mean_square_is_the_lyapunov_equations():
    """∫|H|² df of travel and force under one white ẇ is C X Cᵀ with A X + X Aᵀ = -B Bᵀ."""
    loop = skyhook(paper_coach(2, bending_damping=0.02), 90e3, bandwidth=12.0)
    system = loop.closed(["secondary_1_deflection"])
    B, C = system.B[:, 4:5], system.C
    X = scipy.linalg.solve_continuous_lyapunov(system.A, -B @ B.T)
    f = np.concatenate([np.linspace(1e-4, 60, 400_001), np.geomspace(60, 1e4, 20_001)[1:]])
    u = np.zeros((5, f.size), dtype=complex)
    u[4] = 1.0
    H = respond(system, 2j * np.pi * f, u)
    integral = 2 * np.trapezoid(np.abs(H) ** 2, f, axis=1)
    np.testing.assert_allclose(integral, np.diagonal(C @ X @ C.T), rtol=1e-3)


def test_signals_that_feel_the_tracks_rate_directly_are_rated_too():
    """Forces from the primary suspensions' rates, against a plain sum over the response."""
    model = paper_coach(1)
    measured = tuple(
        Output(f"rate_{j}", primary_deflection(j).dot, "m/s", r"\dot p") for j in (1, 3)
    )
    law = control.ss([], [], [], -3e3 * np.eye(2), inputs=["rate_1", "rate_3"],
                     outputs=["f_1", "f_2"])  # fmt: skip
    loop = Loop("0.5 of it", model, law, measured)
    f = np.linspace(0.05, 80.0, 160_001)
    H = closed_response(loop.closed(["secondary_1_deflection"]), model, V, f)[1:]
    expected = np.sqrt(np.trapezoid(np.abs(H) ** 2 * temporal(LOW, V)(f), f))
    np.testing.assert_allclose(rate_loop(loop, V, LOW).force, expected, rtol=1e-6)


def test_a_force_that_is_felt_at_once_is_refused():
    model = paper_coach(1)
    measured = tuple(suspension_signals(model)[f"body_{b}_acceleration"] for b in (1, 2))
    law = control.ss([], [], [], -1e3 * np.eye(2), inputs=[o.name for o in measured],
                     outputs=["f_1", "f_2"])  # fmt: skip
    with pytest.raises(InputError, match="feels its own force at once"):
        Loop("mine", model, law, measured)


def test_wider_actuators_tend_to_the_ideal_one():
    model = paper_coach(4, bending_damping=0.01)
    ideal = rate_loop(skyhook(model, 100e3), V, LOW).a_wrms[0]
    errors = []
    for bandwidth in (200.0, 400.0, 800.0):
        real = rate_loop(skyhook(model, 100e3, bandwidth=bandwidth), V, LOW).a_wrms[0]
        errors.append(abs(real / ideal - 1))
    assert errors[0] < 0.02
    ratios = np.array(errors[:-1]) / errors[1:]
    assert (ratios > 1.8).all()  # first order in 1/bandwidth


def test_actuator_is_3_db_down_at_its_bandwidth():
    for order in (1, 2):
        G = actuator_dynamics(7.0, order)
        assert abs(G(14j * np.pi)) == pytest.approx(1 / np.sqrt(2), rel=1e-12)
        assert G(0) == pytest.approx(1)
        assert len(G.poles()) == order


def test_figures_of_the_papers_coach():
    """Four segments at 200 km/h: 0.2408 m/s² passive, and what a slow actuator takes back."""
    model = paper_coach(4)
    designs = {"ideal": skyhook(model, 100e3)}
    designs |= {f"{f:g} Hz": skyhook(model, 100e3, bandwidth=f, high_pass=0.1) for f in (20.0, 5.0)}
    a_w = rate_loops(designs, V, LOW)["a_wrms at 0 m [m/s^2]"]
    assert a_w["passive"] == pytest.approx(0.2408, abs=1e-4)
    assert a_w["ideal"] < 0.75 * a_w["passive"]
    assert a_w["20 Hz"] == pytest.approx(a_w["ideal"], rel=0.05)
    assert a_w["5 Hz"] > a_w["passive"]  # its lag feeds the first bending mode


def test_the_bogies_take_the_actuators_reaction():
    """A damper between body and sky, by a direct solution, is better than what an actuator can."""
    model, f = paper_coach(4), np.linspace(0.05, 80.0, 40_001)
    m, s = model.matrices(), 2j * np.pi * f
    body = [model.floor(b.position, "polygon", 0) for b in model.vehicle.bogies]
    over = model.output_rows(body)["d"]
    floor = model.output_rows([model.floor(0.0, derivative=0)])["d"][0]
    x = np.array(model.vehicle.wheelset_positions)
    w = np.exp(-np.outer(s, (x[0] - x) / V))[..., np.newaxis]
    gain = np.abs(weighting("Wk").response(f)) ** 2 * temporal(LOW, V)(f)
    s = s[:, np.newaxis, np.newaxis]

    def a_wrms(C):
        q = np.linalg.solve(m.K + s * C + s**2 * m.M, (m.K_w + s * m.C_w) @ w)
        H = s[:, 0, 0] ** 2 * (floor @ q)[:, 0]
        return np.sqrt(np.trapezoid(np.abs(H) ** 2 * gain, f))

    sky = 100e3 * over.T @ over
    assert a_wrms(m.C + sky) == pytest.approx(0.140, abs=5e-4)
    found = rate_loop(skyhook(model, 100e3), V, LOW).a_wrms[0]
    assert found == pytest.approx(0.169, abs=5e-4)
    assert found == pytest.approx(a_wrms(m.C + 100e3 * m.B_f @ over), rel=1e-3)


def test_modulus_margin_is_the_distance_to_instability():
    """Of the gain that a slow actuator bears, by bisection, and of one loop in closed form."""
    model = paper_coach(1)
    loop = skyhook(model, 2e5, bandwidth=2.0)
    low, high = 1.0, 100.0
    for _ in range(40):
        middle = np.sqrt(low * high)
        try:
            skyhook(model, 2e5 * middle, bandwidth=2.0)
            low = middle
        except InputError:
            high = middle
    assert low < 99
    assert 0 < loop.modulus_margin <= 1 - 1 / low + 1e-9
    near = skyhook(model, 2e5 * low * 0.999, bandwidth=2.0)
    assert near.modulus_margin < 2e-3


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (
            {"gain": -400e3},
            r"(heave|pitch) at \d.* Hz grows with .*1/s; expected every motion to decay",
        ),
        ({"gain": 3e6, "bandwidth": 3.0}, r"loop skyhook: .*unstable: .* Hz grows"),
        ({"gain": np.nan}, "gain: found nan N s/m; expected a finite number"),
        ({"gain": "a"}, "gain: found 'a'; expected a finite number .in N s/m"),
        ({"gain": None}, "gain: found None"),
        ({"gain": 1e5, "bandwidth": "10"}, "bandwidth: found '10'; expected a positive number"),
        ({"gain": 1e5, "bandwidth": 0.0}, "bandwidth: found 0.0 Hz"),
        ({"gain": 1e5, "high_pass": -1.0}, "high_pass: found -1.0 Hz"),
        ({"gain": 1e5, "order": 3}, "order: found 3; expected 1 or 2"),
    ],
)
def test_what_cannot_be_is_refused(given, words):
    with pytest.raises(InputError, match=words):
        skyhook(paper_coach(1), **given)


@pytest.mark.parametrize(("bandwidth", "mode"), [(6.0, r"bending 1 at 9\.7"),
                                                (8.0, r"bending 2 at 25\.5")])  # fmt: skip
def test_a_growing_bending_mode_is_named(bandwidth, mode):
    """In place of passive dampers, a second-order actuator's lag feeds the body's bending."""
    with pytest.raises(InputError, match=rf"{mode}\d* Hz grows"):
        skyhook(paper_coach(4), 100e3, bandwidth=bandwidth, c_2=5e3)


def test_all_faults_are_told_together():
    with pytest.raises(InputError) as error:
        skyhook(paper_coach(1), np.inf, bandwidth=-1.0, order=7)
    assert len(str(error.value).splitlines()) == 3


def test_controllers_of_other_signals_are_refused():
    model = paper_coach(1)
    law = control.ss([], [], [], np.zeros((2, 2)), inputs=["a", "b"], outputs=["f_1", "f_3"])
    with pytest.raises(InputError, match=r"controller's inputs: found a, b.*\n.*outputs: found"):
        Loop("mine", model, law)
    finer = skyhook(paper_coach(2), 1.0)
    with pytest.raises(InputError, match=r"body_1_velocity: found this signal of another model"):
        Loop("mine", paper_coach(4), finer.controller, finer.measured)
    law = control.ss(np.eye(2) / 2, np.eye(2), np.eye(2), np.eye(2), 0.01,
                     inputs=["body_1_velocity", "body_2_velocity"],
                     outputs=["f_1", "f_2"])  # fmt: skip
    with pytest.raises(InputError, match="continuous time"):
        Loop("mine", model, law, skyhook(model, 1.0).measured)
    for door in (["door"], "door"):
        with pytest.raises(InputError, match="output: found 'door'"):
            skyhook(model, 1e4).closed(door)
    with pytest.raises(InputError, match="different vehicles"):
        rate_loops([skyhook(model, 1e4, name="a"), skyhook(paper_coach(2), 1e4, name="b")], V, LOW)
    with pytest.raises(InputError, match="found none"):
        rate_loops([], V, LOW)
    with pytest.raises(InputError, match="speed"):
        rate_loops([skyhook(model, 1e4)], 0.0, LOW)
    with pytest.raises(InputError, match="off the body"):
        rate_loops([skyhook(model, 1e4)], V, LOW, at=(99.0,))


def test_any_kind_of_track_will_do_for_loops():
    model, road = paper_coach(1), synthesise(LOW, 2000.0, 0.25, seed=3)
    loops = [skyhook(model, 1e5), lqg(model, V, "erri_low", force=2e3)]
    by_name, by_spectrum = (rate_loops(loops, V, track, at=0.0) for track in ("erri_low", LOW))
    pd.testing.assert_frame_equal(by_name, by_spectrum)
    assert by_name.attrs["remarks"] == []
    alone = rate_loops(loops[0], V, "erri_low")
    pd.testing.assert_frame_equal(alone, by_name.iloc[:2])
    measured = rate_loops(loops, V, road)
    assert any("Welch" in remark for remark in measured.attrs["remarks"])
    pd.testing.assert_frame_equal(measured, rate_loops(loops, V, measured_spectrum(road)))
    f = [1.0, 2.0]
    pd.testing.assert_frame_equal(loop_spectra(loops, V, "erri_low", f),
                                  loop_spectra(loops, V, LOW, f))  # fmt: skip
    assert any("Welch" in said for said in lqg(model, V, road, force=2e3).remarks)


def test_changes_hold_in_the_loop_alone():
    model = paper_coach(1)
    table = rate_loops([skyhook(model, 100e3, c_2=20e3)], V, LOW)
    softer = stochastic_ride(model, V, LOW, c_2=20e3).a_wrms[0]
    resting = rate_loop(skyhook(model, 0.0, c_2=20e3), V, LOW).a_wrms[0]
    assert resting == pytest.approx(softer, rel=1e-9)
    exact = stochastic_ride(model, V, LOW).a_wrms[0]
    assert table.loc["passive", "a_wrms at 0 m [m/s^2]"] == pytest.approx(exact, rel=1e-9)


def test_signals_are_of_the_structure_over_the_bogie():
    model = paper_coach(4)
    signals, x_b = suspension_signals(model), model.vehicle.bogies[0].position
    s = 3.0 + 20j
    names = ["body_1_velocity", "body_1_acceleration", "secondary_1_rate", "secondary_1_deflection",
             "bogie_1_velocity", "damper_1_rate"]  # fmt: skip
    asked = [*(signals[name] for name in names), model.floor(x_b, "polygon", 1)]
    body, acceleration, rate, deflection, bogie, damper, floor = state_space(model, asked)(s)
    np.testing.assert_allclose(body, floor, rtol=1e-12)
    np.testing.assert_allclose(
        acceleration, s * body, rtol=1e-8, atol=1e-9 * abs(acceleration).max()
    )
    np.testing.assert_allclose(rate, body - bogie, atol=1e-12 * abs(body).max())
    np.testing.assert_allclose(rate, s * deflection, atol=1e-10 * abs(rate).max())
    np.testing.assert_array_equal(damper, rate)


def test_spectra_add_up_to_the_comfort_values():
    model = paper_coach(2, bending_damping=0.02)
    designs = {"sky": skyhook(model, 1e5), "slow": skyhook(model, 1e5, bandwidth=8.0)}
    spectra = loop_spectra(designs, V, LOW, np.linspace(0.05, 80, 80_000), at=3.0)
    assert spectra.columns.tolist() == ["passive", "sky", "slow"]
    exact = rate_loops(designs, V, LOW, at=(3.0,))["a_wrms at 3 m [m/s^2]"]
    found = np.sqrt(np.trapezoid(spectra.to_numpy(), spectra.index, axis=0))
    np.testing.assert_allclose(found, exact, rtol=1e-5)


def test_designs_of_one_name_are_refused():
    model = paper_coach(1)
    with pytest.raises(InputError, match="names skyhook, skyhook; expected each once"):
        rate_loops([skyhook(model, 1e4), skyhook(model, 2e4)], V, LOW)
    with pytest.raises(InputError, match="none 'passive'"):
        rate_loops({"passive": skyhook(model, 1e4)}, V, LOW)


def test_pictures_show_every_design():
    model = paper_coach(2)
    designs = {"ideal": skyhook(model, 1e5), "real": skyhook(model, 1e5, bandwidth=10.0)}
    f = np.geomspace(0.5, 30, 200)
    spectra, table = loop_spectra(designs, V, LOW, f), rate_loops(designs, V, LOW)
    ax = plot_loop_spectra(spectra)
    for line, name in zip(ax.get_lines(), ("passive", "ideal", "real"), strict=True):
        assert line.get_label() == name
        np.testing.assert_allclose(line.get_ydata() ** 2, spectra[name], rtol=1e-12)
    assert (ax.get_xlabel(), ax.get_xscale(), ax.get_yscale()) == ("frequency [Hz]", "log", "log")
    assert "m/s²/√Hz" in ax.get_ylabel()
    points = plot_loops(table)
    assert len(points.get_lines()) == 3
    travel = table.loc["real", ["travel r.m.s. bogie 1 [m]", "travel r.m.s. bogie 2 [m]"]].max()
    np.testing.assert_allclose(points.get_lines()[2].get_xdata(), 1e3 * travel)
    assert points.get_ylabel() == "a_wrms at 0 m [m/s²]"
    many = pd.concat(
        [table.iloc[:1], *[table.iloc[1:2].rename({"ideal": str(k)}) for k in range(15)]]
    )
    looks = {(line.get_color(), line.get_marker()) for line in plot_loops(many).get_lines()}
    assert len(looks) == 16
    spectra = pd.DataFrame({str(k): spectra["ideal"] for k in range(16)}, index=spectra.index)
    looks = {(line.get_color(), line.get_linestyle()) for line in plot_loop_spectra(spectra).lines}
    assert len(looks) == 16
    with pytest.raises(InputError, match="table: found the columns none"):
        plot_loops(pd.DataFrame())
    with pytest.raises(InputError, match="spectra: found none"):
        plot_loop_spectra(pd.DataFrame())


# LQG


def test_lqg_improves_comfort_at_no_more_travel():
    model = paper_coach(4, bending_damping=0.01)
    loop = lqg(model, V, LOW, force=2e3, travel=2e-3)
    passive, active = (rate_loop(one, V, LOW) for one in (Loop("passive", model), loop))
    assert active.a_wrms[0] < 0.6 * passive.a_wrms[0]
    assert active.travel.max() < passive.travel.max()
    assert 0 < active.force.max() < 2e3
    assert active.modulus_margin > 0.5
    assert loop.remarks == ()


def test_lqg_trades_force_for_comfort():
    model = paper_coach(2)
    found = [rate_loop(lqg(model, V, LOW, force=f), V, LOW) for f in (100.0, 500.0, 2500.0)]
    assert (np.diff([r.a_wrms[0] for r in found]) < 0).all()
    assert (np.diff([r.force[0] for r in found]) > 0).all()
    resting = rate_loop(lqg(model, V, LOW, force=1e-2), V, LOW).a_wrms[0]
    assert resting == pytest.approx(stochastic_ride(model, V, LOW).a_wrms[0], rel=1e-3)


def test_lqg_is_optimal_for_the_cost_it_was_designed_for():
    """With its own independent noises, no nearby gain of the actuators has a lower cost."""
    model, sizes = paper_coach(2, bending_damping=0.02), (0.1, 5e-3, 1e3)
    loop = lqg(model, V, LOW, acceleration=sizes[0], travel=sizes[1], force=sizes[2])
    d = _design(model, V, (0.0,), weighting("Wk"), None, 2, {})
    q, r, n = _noise_intensity(LOW, V), 0.03**2 / 2, 2
    K = loop.controller

    def cost(gain):
        A = np.block([[d.A, gain * d.B_u @ K.C],
                      [K.B @ d.C_y, K.A + gain * K.B @ d.D_y @ K.C]])  # fmt: skip
        B = np.block([[d.B_xi * np.sqrt(q), np.zeros((len(d.A), n))],
                      [np.zeros((len(K.A), d.B_xi.shape[1])), K.B * np.sqrt(r)]])  # fmt: skip
        X = scipy.linalg.solve_continuous_lyapunov(A, -B @ B.T)
        z = np.hstack([d.C_z, gain * d.D_z @ K.C])
        z[0] /= sizes[0]
        z[1:] /= sizes[1] * np.sqrt(n)
        f = np.hstack([np.zeros((n, len(d.A))), gain * K.C]) / (sizes[2] * np.sqrt(n))
        return np.trace(z @ X @ z.T) + np.trace(f @ X @ f.T)

    here = cost(1.0)
    assert cost(0.9) > here
    assert cost(1.1) > here
    assert abs(cost(1.001) - cost(0.999)) < 1e-2 * (cost(1.1) - here)


def test_lqg_noise_has_the_spectrum_of_erri():
    """White noise through the shaping filter has the density of the spectrum, at any frequency."""
    f = np.geomspace(0.05, 80, 50)
    slow, fast = V * np.array(ERRI_POLES)
    s = 2j * np.pi * f
    density = 2 * _noise_intensity(LOW, V) / np.abs((s + slow) * (s + fast)) ** 2
    np.testing.assert_allclose(density, temporal(LOW, V)(f), rtol=1e-12)


@pytest.mark.parametrize("name", ["Wk", "Wb", "Wk_paper"])
def test_lqg_weighs_as_the_weighting_does(name):
    weight, f = weighting(name), np.geomspace(0.1, 100, 40)
    system = _weighting_system(weight, "a", "a_w")
    found = respond(system, 2j * np.pi * f, np.ones((1, f.size), dtype=complex))[0]
    np.testing.assert_allclose(found, weight.response(f), rtol=1e-9)


def test_lqg_with_actuators_in_the_design_bears_them_better():
    model = paper_coach(2, bending_damping=0.01)
    with_actuators = lqg(model, V, LOW, force=2e3, bandwidth=5.0)
    assert (
        rate_loop(with_actuators, V, LOW).a_wrms[0]
        < 0.7 * (stochastic_ride(model, V, LOW).a_wrms[0])
    )
    fast = lqg(model, V, LOW, force=2e3, bandwidth=2000.0)
    ideal = lqg(model, V, LOW, force=2e3)
    a_w = [rate_loop(loop, V, LOW).a_wrms[0] for loop in (fast, ideal)]
    assert a_w[0] == pytest.approx(a_w[1], rel=0.02)


def test_a_controller_on_a_better_model_shows_spillover():
    """Two segments miss all bending modes but one: a keen design drives another one unstable."""
    rough, fine = (paper_coach(n) for n in (2, 6))
    keen = lqg(rough, V, LOW, sensor_noise=1e-3)
    with pytest.raises(InputError, match=r"loop LQG: found that it is unstable: bending [2-5]"):
        keen.on(fine)
    modest = lqg(rough, V, LOW, force=1e3, sensor_noise=0.3).on(fine)
    assert rate_loop(modest, V, LOW).a_wrms[0] < stochastic_ride(fine, V, LOW).a_wrms[0]
    with pytest.raises(InputError, match="bogies; expected 2"):
        keen.on(three_bogies())


def three_bogies():
    for seed in range(10):
        model = random_model(seed, 2)
        if len(model.vehicle.bogies) == 3:
            return model
    return pytest.fail("no such vehicle")


@pytest.mark.parametrize("name", ["acceleration", "travel", "force", "sensor_noise"])
def test_lqg_refuses_sizes_that_are_none(name):
    for value in (0.0, np.inf, "much"):
        words = f"{name}: found {value!r}; expected a positive number"
        with pytest.raises(InputError, match=words):
            lqg(paper_coach(1), V, LOW, **{name: value})


def test_lqg_needs_a_point_and_a_speed():
    with pytest.raises(InputError, match="at: found no point"):
        lqg(paper_coach(1), V, LOW, at=())
    with pytest.raises(InputError, match="speed"):
        lqg(paper_coach(1), 0.0, LOW)


# Semi-active dampers


def test_dampers_that_do_not_switch_are_the_passive_ones():
    model = paper_coach(4)
    c_2 = model.vehicle.bogies[0].secondary_damping
    found = semi_active_ride(model, V, c_max=c_2, c_min=c_2, length=300.0, at=(0.0, 5.0))
    for quantity in (found.acceleration, found.travel, found.force):
        passive, same = quantity
        assert np.abs(same - passive).max() < 1e-9 * np.abs(passive).max()


def test_the_passive_run_is_that_of_a_ride():
    model = paper_coach(2)
    found = semi_active_ride(model, V, c_max=1e5, c_min=1e4, length=300.0, seed=4)
    case = ride(model, "erri_low", [V], length=300.0, seed=4).cases[0]
    assert found.found[0][0].a_wrms == pytest.approx(case.a_wrms, rel=1e-9)
    np.testing.assert_allclose(found.time, case.record.time, atol=1e-12)


def rough_ride(model, seconds=2.0, dt=1e-3):
    """Elevations and rates of some sines under the wheelsets, and the time between samples."""
    t = dt * np.arange(round(seconds / dt))
    delays = 0.1 * np.arange(len(model.linear.inputs))[:, np.newaxis]
    sines = [(2e-3, 2 * np.pi * 1.1), (3e-4, 2 * np.pi * 9.0)]
    w = sum(a * np.sin(omega * (t - delays)) for a, omega in sines)
    dw = sum(a * omega * np.cos(omega * (t - delays)) for a, omega in sines)
    return np.vstack([w, dw]), dt


@pytest.mark.parametrize("mount", [None, 12e6])
def test_hard_or_soft_dampers_are_those_of_that_vehicle(mount):
    """c_min = c_max = c is the vehicle with c_2 = c, derived afresh, with an elastic mount too."""
    given = load_vehicle("cati2024")

    def coach(c):
        bogies = (
            replace(b, secondary_damping=c, secondary_damper_stiffness=mount) for b in given.bogies
        )
        return derive_vehicle(replace(given, bogies=tuple(bogies)), 2)

    model, softer = coach(70e3), coach(25e3)
    u, dt = rough_ride(model)
    switched = _Switched.of(model, [model.floor()], 25e3, 25e3, dt)
    found = _switched(switched, u, _at_rest(model, u))
    expected = _passive(softer, [softer.floor()], u, dt)
    for one, other in zip(found, expected, strict=True):
        assert np.abs(one - other).max() < 1e-9 * np.abs(other).max()


def test_switching_dampers_only_take_energy():
    found = semi_active_ride(paper_coach(2), V, c_max=140e3, c_min=10e3, length=300.0)
    force, damping = found.force[1], found.damping[1]
    assert set(np.unique(damping)) == {10e3, 140e3}
    np.testing.assert_array_equal(found.damping[0], 70e3)
    stroke_rate = np.gradient(found.travel[1], found.time, axis=-1)
    power = np.mean(force * stroke_rate, axis=-1)
    assert (power > 0).all()
    assert np.abs(stroke_rate - force / damping).max() < 0.05 * np.abs(stroke_rate).max()


def test_switching_follows_the_rule_and_each_step_is_exact():
    """Against the plant's actuators pulling with (c - c_2) times the rate, step by step."""
    model = paper_coach(1)
    u, dt = rough_ride(model, seconds=0.6)
    switched = _Switched.of(model, [model.floor()], 10e3, 140e3, dt)
    states, settings = _march(switched, u, _at_rest(model, u))
    signals, k = suspension_signals(model), len(u)
    names = [f"{what}_{b}_{kind}" for what, kind in (("body", "velocity"), ("secondary", "rate"))
             for b in (1, 2)]  # fmt: skip
    plant = state_space(model, [signals[name] for name in names])
    rates = plant.C @ states
    hard = rates[:2] * rates[2:] > 0
    np.testing.assert_array_equal(settings, hard[0] + 2 * hard[1])
    assert set(settings.tolist()) == {0, 1, 2, 3}
    n = len(states)
    for i in range(0, len(settings) - 1, 7):
        c = np.where(hard[:, i], 140e3, 10e3) - 70e3
        A = plant.A - plant.B[:, k:] @ np.diag(c) @ plant.C[2:]
        here = (A, plant.B[:, :k], np.eye(n), np.zeros((n, k)))
        peer = scipy.signal.lsim(here, u[:, i : i + 2].T, [0.0, dt], X0=states[:, i])[1]
        assert np.abs(peer[1] - states[:, i + 1]).max() < 1e-9 * np.abs(states).max()


def test_semi_active_is_softer_than_hard_dampers_and_calmer_than_soft_ones():
    model = paper_coach(1)
    switched = semi_active_ride(model, V, c_max=150e3, c_min=15e3)
    hard = semi_active_ride(model, V, c_max=150e3, c_min=150e3)
    soft = semi_active_ride(model, V, c_max=15e3, c_min=15e3)
    a_w = [found.found[1][0].a_wrms for found in (switched, hard)]
    assert a_w[0] < a_w[1]
    travel = [
        found.table()["travel r.m.s. bogie 1 [m]"]["semi-active"] for found in (switched, soft)
    ]
    assert travel[0] < travel[1]


def test_semi_active_table_and_remarks():
    found = semi_active_ride(paper_coach(1), V, c_max=1e5, c_min=1e4, at=(0.0, 8.0), length=200.0)
    table = found.table()
    assert table.index.tolist() == ["passive", "semi-active"]
    assert table.columns.tolist() == [
        "a_wrms at 0 m [m/s^2]", "MTVV at 0 m [m/s^2]", "a_wrms at 8 m [m/s^2]",
        "MTVV at 8 m [m/s^2]", "travel r.m.s. bogie 1 [m]", "travel r.m.s. bogie 2 [m]",
        "damper force r.m.s. bogie 1 [N]", "damper force r.m.s. bogie 2 [N]",
    ]  # fmt: skip
    assert isinstance(found.remarks, tuple)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"c_max": 1e4, "c_min": 2e4}, "c_min: found 20000 N s/m; expected at most c_max"),
        ({"c_max": np.nan, "c_min": 0.0}, "c_max: found nan"),
        ({"c_max": "hard", "c_min": 0.0}, "c_max: found 'hard'"),
        ({"c_max": 1e5, "c_min": -1.0}, "c_min: found -1.0"),
        ({"c_max": 1e5, "c_min": 1e4, "length": -5.0}, "length"),
        ({"c_max": 1e5, "c_min": 1e4, "at": (50.0,)}, "off the body"),
    ],
)
def test_semi_active_refuses_what_cannot_be(given, words):
    with pytest.raises(InputError, match=words):
        semi_active_ride(paper_coach(1), V, **given)


def test_soft_dampers_on_mounts_are_not_zero():
    given = load_vehicle("cati2024")
    bogies = tuple(replace(b, secondary_damper_stiffness=12e6) for b in given.bogies)
    model = derive_vehicle(replace(given, bogies=bogies), 1)
    with pytest.raises(InputError, match="c_min: found 0 N s/m on an elastic mount"):
        semi_active_ride(model, V, c_max=1e5, c_min=0.0)
