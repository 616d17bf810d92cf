"""Many designs at once: each is what it is alone, and none stops the others."""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from vehicles import paper_coach, random_model, random_vehicle

from railride import designs as package
from railride.designs import evaluate_designs
from railride.errors import InputError
from railride.firstorder import first_order
from railride.frequency import track_response
from railride.modal import modes
from railride.parameters import load_vehicle
from railride.spectra import spectrum
from railride.stochastic import output_statistics, squares, stochastic_ride
from railride.vehicle import derive_vehicle

KMH = 1 / 3.6
SPEEDS = (145 * KMH, 200 * KMH)


def drawn(seed, count, **centres):
    """Values of parameters, each within a factor of 1.5 of its centre."""
    rng = np.random.default_rng(seed)
    return {name: value * rng.uniform(2 / 3, 3 / 2, count) for name, value in centres.items()}


SUSPENSION = {"k_1": 5e6, "c_1": 30e3, "k_2": 750e3, "c_2": 70e3}


# Each design as if it were alone


@pytest.mark.parametrize(
    "model", [paper_coach(1), paper_coach(4, bending_damping=0.01),
              derive_vehicle("cati2024", body="beam", modes=3, bending_damping=0.01)],
    ids=["rigid", "segments", "beam"],
)  # fmt: skip
def test_comfort_values_are_those_of_the_ride(model):
    designs = drawn(1, 3, **SUSPENSION)
    given = evaluate_designs(model, designs, ["erri_low", "sncf_good"], SPEEDS, [0.0, 6.0],
                             results=["a_wrms", "a_rms", "wz"])  # fmt: skip
    assert given.a_wrms.shape == (3, 2, 2, 2)
    for d in range(3):
        own = {name: values[d] for name, values in designs.items()}
        for t, track in enumerate(given.tracks):
            for v, speed in enumerate(SPEEDS):
                alone = stochastic_ride(model, speed, track, [0.0, 6.0], **own)
                for name in ("a_wrms", "a_rms", "wz"):
                    np.testing.assert_allclose(getattr(given, name)[d, t, v],
                                               getattr(alone, name), rtol=1e-9)  # fmt: skip
    assert (given.error < 1e-8).all()
    assert list(given.problems) == [""] * 3
    (said,) = (remark for remark in given.remarks if "sncf_good holds" in remark)
    assert "at 145 km/h" in said
    assert "at 200 km/h" in said


def test_wheelsets_that_move_are_reached_where_they_are():
    """Bogies and axles apart by other distances: as the vehicle built anew with them."""
    vehicle = load_vehicle("cati2024")
    model = derive_vehicle(vehicle, segments=1)
    designs = {"l_b": [8.0, 9.0], "l_w": [1.1, 1.4]}
    found = evaluate_designs(model, designs, "erri_low", SPEEDS, 3.0)
    for d, (half, axle) in enumerate(zip(*designs.values(), strict=True)):
        bogies = tuple(replace(bogie, position=np.sign(bogie.position) * half,
                               wheelsets=(axle, -axle)) for bogie in vehicle.bogies)  # fmt: skip
        built = derive_vehicle(replace(vehicle, bogies=bogies), segments=1)
        for v, speed in enumerate(SPEEDS):
            for made, changes in ((built, {}), (model, {"l_b": half, "l_w": axle})):
                alone = stochastic_ride(made, speed, "erri_low", 3.0, **changes).a_wrms
                np.testing.assert_allclose(found.a_wrms[d, 0, v], alone, rtol=1e-9)


def test_a_floor_that_is_read_by_what_changes():
    """The points of longer and shorter bodies are elsewhere on their segments."""
    model = paper_coach(4, bending_damping=0.01)
    found = evaluate_designs(model, {"L": [22.0, 27.0]}, "erri_low", SPEEDS[0], 5.0)
    for d, length in enumerate((22.0, 27.0)):
        alone = stochastic_ride(model, SPEEDS[0], "erri_low", 5.0, L=length).a_wrms
        np.testing.assert_allclose(found.a_wrms[d, 0, 0], alone, rtol=1e-9)


def test_what_is_changed_may_touch_no_matrix():
    vehicle = load_vehicle("cati2024")
    bogies = tuple(replace(bogie, wheelset_mass=1200.0) for bogie in vehicle.bogies)
    model = derive_vehicle(replace(vehicle, bogies=bogies), segments=2)
    found = evaluate_designs(model, {"m_w": [1000.0, 1500.0]}, "erri_low", SPEEDS)
    alone = stochastic_ride(model, SPEEDS[1], "erri_low").a_wrms
    np.testing.assert_allclose(found.a_wrms[:, 0, 1], [alone, alone], rtol=1e-11)
    nothing = evaluate_designs(model, {}, "erri_low", SPEEDS)
    np.testing.assert_allclose(nothing.a_wrms[:, 0, 1], [alone], rtol=1e-11)


def test_batches_join_without_a_seam(monkeypatch):
    model, designs = random_model(1, 2), drawn(2, 11, k_2_b1=5e5)
    whole = evaluate_designs(model, designs, "erri_low", SPEEDS)
    monkeypatch.setattr(package.evaluate, "TOGETHER", 4)
    done = []
    parts = evaluate_designs(model, designs, "erri_low", SPEEDS, progress=done.append)
    np.testing.assert_allclose(parts.a_wrms, whole.a_wrms, rtol=1e-13)
    np.testing.assert_allclose(done, [4 / 11, 8 / 11, 1.0])


# Travel, wheel loads, modes, statics


def weighed(vehicle, **mounts):
    """With wheelsets of a known mass, and the dampers' mounts if they are given."""
    bogies = tuple(replace(bogie, wheelset_mass=1250.0, **mounts) for bogie in vehicle.bogies)
    return replace(vehicle, bogies=bogies)


COACH = weighed(load_vehicle("cati2024"))
KINDS = {
    "rigid": (derive_vehicle(COACH, segments=1), SUSPENSION),
    "segments": (derive_vehicle(COACH, segments=4, bending_damping=0.01), SUSPENSION),
    "beam": (derive_vehicle(COACH, body="beam", modes=3, bending_damping=0.01), SUSPENSION),
    "fe": (derive_vehicle(COACH, body="fe", modes=3, bending_damping=0.01), SUSPENSION),
    "mounts": (derive_vehicle(weighed(COACH, primary_damper_stiffness=4e6,
                                      secondary_damper_stiffness=12e6), segments=2),
               {**SUSPENSION, "k_d1": 4e6, "k_d2": 12e6}),
    "unsymmetric": (derive_vehicle(weighed(random_vehicle(3)), segments=4),
                    {"k_2_b1": 5e5, "c_1_b2": 2e4, "f_bending": 9.0}),
}  # fmt: skip


@pytest.mark.parametrize("name", KINDS)
def test_travel_and_wheel_loads_are_those_of_the_outputs(name):
    model, centres = KINDS[name]
    designs = drawn(3, 2, **centres)
    found = evaluate_designs(model, designs, ["erri_low", "sncf_good"], SPEEDS,
                             results=["travel", "wheel_loads"])  # fmt: skip
    assert found.a_wrms is None
    asked = [*found.suspensions, *found.wheel_loads]
    assert len(found.wheel_loads) == len(model.vehicle.wheelset_positions)
    rms = np.concatenate([found.travel_rms, found.load_rms], axis=-1)
    peak = np.concatenate([found.travel_peak, found.load_peak], axis=-1)
    for d in range(2):
        own = {key: values[d] for key, values in designs.items()}
        for t, track in enumerate(found.tracks):
            for v, speed in enumerate(SPEEDS):
                alone = output_statistics(model, speed, track, asked, **own)
                np.testing.assert_allclose(rms[d, t, v], alone["rms"], rtol=1e-8)
                np.testing.assert_allclose(peak[d, t, v], alone["expected peak"], rtol=1e-8)


@pytest.mark.parametrize("name", ["segments", "mounts", "unsymmetric"])
def test_travel_and_wheel_loads_by_many_frequencies(name):
    """The trapezoidal rule on the equations of motion as they stand."""
    model, centres = KINDS[name]
    designs, V, k = drawn(4, 2, **centres), 200 * KMH, 1
    found = evaluate_designs(model, designs, "erri_low", V, results=["travel", "wheel_loads"])
    own = {key: values[k] for key, values in designs.items()}
    f = np.concatenate([np.linspace(0.05, 30.0, 150_001), np.linspace(30.0, 80.0, 20_001)[1:]])
    S = 2 * np.pi / V * spectrum("erri_low").density(2 * np.pi * f / V)
    names = [*found.suspensions, *found.wheel_loads]
    H = track_response(model, [model.outputs[each] for each in names], V, f, **own)
    low_pass = 1 / (1 + (f / 20) ** 8)
    loads = np.array([each.startswith("wheel_load") for each in names])[:, np.newaxis]
    S_y = np.abs(H) ** 2 * S * np.where(loads, low_pass, 1.0)
    rms = np.sqrt(np.trapezoid(S_y, f))
    crossings = np.sqrt(np.trapezoid(f**2 * S_y, f)) / rms
    root = np.sqrt(2 * np.log(crossings * 1000 / V))
    both = np.concatenate([found.travel_rms, found.load_rms], axis=-1)[k, 0, 0]
    np.testing.assert_allclose(both, rms, rtol=1e-6)
    peaks = np.concatenate([found.travel_peak, found.load_peak], axis=-1)[k, 0, 0]
    np.testing.assert_allclose(peaks, rms * (root + 0.5772156649 / root), rtol=1e-6)


def test_few_crossings_have_no_expected_peak():
    found = evaluate_designs(paper_coach(1), {"k_2": [7e5]}, "erri_low", 400.0, results="travel")
    assert np.isfinite(found.travel_rms).all()
    assert np.isnan(found.travel_peak[0, 0, 0, 0])
    assert any("fewer than 10 up-crossings" in remark for remark in found.remarks)


def test_wheelsets_without_mass_have_no_loads():
    found = evaluate_designs(paper_coach(1), {"k_2": [7e5]}, "erri_low", 40.0,
                             results="wheel_loads")  # fmt: skip
    assert found.load_rms.shape == (1, 1, 1, 0)
    assert any("no wheel loads" in remark for remark in found.remarks)
    assert list(found.table()) == ["k_2 [N/m]", "error", "problem"]


@pytest.mark.parametrize("name", KINDS)
def test_modes_are_the_models_own(name):
    model, centres = KINDS[name]
    designs = drawn(5, 4, **centres)
    found = evaluate_designs(model, designs, "erri_low", 40.0, results="modes")
    for d in range(4):
        own = modes(model, **{key: values[d] for key, values in designs.items()})
        assert len(own) == len(found.modes)
        order = np.argsort(found.natural_frequency[d])
        np.testing.assert_allclose(found.natural_frequency[d][order],
                                   [mode.frequency_hz for mode in own], rtol=1e-8)  # fmt: skip
        np.testing.assert_allclose(np.sort(found.damping_ratio[d]),
                                   np.sort([mode.damping_ratio for mode in own]),
                                   rtol=1e-7, atol=1e-10)  # fmt: skip
        assert found.least_damping_ratio[d] == found.damping_ratio[d].min()
        for label in ("heave", "pitch"):
            (mode,) = (mode for mode in own if mode.label == label)
            k = found.modes.index(label)
            assert found.natural_frequency[d, k] == pytest.approx(mode.frequency_hz, rel=1e-8)


def test_modes_keep_their_names_where_frequencies_change_places():
    """The bogies' heave, from below the bending mode to far above it."""
    model = derive_vehicle("cati2024", segments=4)
    k_1 = np.geomspace(1e6, 4e7, 12)
    found = evaluate_designs(model, {"k_1": k_1}, "erri_low", 40.0, results="modes")
    assert len(set(found.modes)) == len(found.modes) == 9
    bogies = [name for name in found.modes if name.startswith("bogie heave")]
    f = found.table()[[f"{name} natural frequency [Hz]" for name in (*bogies, "bending 1")]]
    both_bogies = np.sqrt((2 * k_1 + 750e3) / 3000) / (2 * np.pi)  # each alone on its springs
    for name in bogies:
        np.testing.assert_allclose(f[f"{name} natural frequency [Hz]"], both_bogies, rtol=0.06)
    np.testing.assert_allclose(f["bending 1 natural frequency [Hz]"], 9.6, rtol=0.06)


def test_each_eigenvalue_has_one_name_however_far_a_design_is():
    """All that a design has is among the names but for the second of two reals of one pair."""
    model, rng = paper_coach(2), np.random.default_rng(6)
    designs = {name: value * 8 ** rng.uniform(-1, 1, 60) for name, value in SUSPENSION.items()}
    found = evaluate_designs(model, designs, "erri_low", 40.0, results="modes")
    for d in range(60):
        own = {name: values[d] for name, values in designs.items()}
        roots = np.linalg.eigvals(first_order(model.matrices(**own)).A)
        left = (np.abs(roots[roots.imag >= 0]) / (2 * np.pi)).tolist()
        lone = len(left) - len(found.modes)  # more than names: each of a pair that creeps
        for f in found.natural_frequency[d]:
            nearest = min(left, key=lambda known, f=f: abs(known - f))
            assert nearest == pytest.approx(f, rel=1e-5)
            left.remove(nearest)
        assert len(left) == lone >= 0


def test_a_pair_that_creeps_keeps_its_name():
    """Dampers so strong that the bogies' heave is two real eigenvalues: one goes by its name."""
    found = evaluate_designs(paper_coach(1), {"c_1": [3e4, 2e5]}, "erri_low", 40.0, results="modes")
    zeta = found.damping_ratio[:, [name.startswith("bogie heave") for name in found.modes]]
    assert (zeta[0] < 0.5).all()
    np.testing.assert_allclose(zeta[1], 1.0, rtol=1e-12)


def test_modes_of_unstable_designs_are_told():
    found = evaluate_designs(paper_coach(1), {"c_2": [7e4, -7e4]}, "erri_low", 40.0,
                             results=["modes", "a_wrms"])  # fmt: skip
    assert found.least_damping_ratio[0] > 0 > found.least_damping_ratio[1]
    assert np.isnan(found.a_wrms[1]).all()


def test_modes_that_rounding_decides_are_told():
    found = evaluate_designs(paper_coach(1), {"c_2": [7e4, 8e16]}, "erri_low", 40.0,
                             results="modes")  # fmt: skip
    for values in (found.natural_frequency, found.damping_ratio, found.least_damping_ratio):
        assert np.isfinite(values[0]).all()
        assert np.isnan(values[1]).all()
    assert found.problems[0] == ""
    assert "rounding decides" in found.problems[1]


def test_static_deflections_carry_the_weight():
    """-m g/k of what stands above: half of the body on a bogie, a quarter of all on a wheelset."""
    k_1, k_2, g = np.array([4e6, 6e6]), np.array([6e5, 9e5]), 9.80665
    found = evaluate_designs(paper_coach(4), {"k_1": k_1, "k_2": k_2}, "erri_low", 40.0,
                             results="static")  # fmt: skip
    deflection = dict(zip(found.suspensions, found.static_deflection.T, strict=True))
    np.testing.assert_allclose(deflection["secondary_2_deflection"], -17e3 * g / k_2, rtol=1e-9)
    np.testing.assert_allclose(deflection["primary_3_deflection"], -10e3 * g / k_1, rtol=1e-9)


# Designs that cannot be


def test_one_that_cannot_be_does_not_stop_the_others():
    model = paper_coach(2)
    designs = {"k_2": [7e5, -1.0, np.nan, 7e5, 7e5, 7e5], "c_2": [7e4, 7e4, 7e4, -5e3, 0.0, 7e4],
               "c_1": [3e4, 3e4, 3e4, 3e4, 0.0, 0.0]}  # fmt: skip
    found = evaluate_designs(model, designs, "erri_low", SPEEDS)
    assert np.isfinite(found.a_wrms[[0, 5]]).all()
    assert np.isnan(found.a_wrms[1:5]).all()
    said = ["", "-1.0 for k_2", "nan for k_2", "", "", ""]
    assert all(part in problem for part, problem in zip(said, found.problems, strict=True))
    assert "unstable" in found.problems[3]
    assert "without damping" in found.problems[4]
    assert found.problems[0] == found.problems[5] == ""
    (remark,) = found.remarks
    assert "4 of 6 designs lack values" in remark
    assert "design 2" in remark


def test_travel_alone_has_its_reasons_too():
    designs = {"c_1": [3e4, 0.0], "c_2": [7e4, 0.0]}
    found = evaluate_designs(paper_coach(1), designs, "erri_low", SPEEDS, results="travel")
    assert np.isnan(found.travel_rms[1]).all()
    assert found.problems[0] == ""
    assert "without damping" in found.problems[1]


def test_unstable_designs_are_not_integrated(monkeypatch):
    def never(*_, **__):
        raise AssertionError

    monkeypatch.setattr(squares, "process", never)
    found = evaluate_designs(paper_coach(1), {"c_2": [7e4, -5e3]}, "erri_low", SPEEDS)
    assert "unstable" in found.problems[1]


@pytest.mark.parametrize("segments", [1, 2, 4])
def test_what_rounding_takes_is_stated_or_nothing_is_given(segments):
    """Suspensions that are next to rigid, against the limit 1/k_2 → 0 from those that are not."""
    model = paper_coach(segments)

    def a_w(**designs):
        found = evaluate_designs(model, designs, "erri_low", 145 * KMH, floor="polygon")
        return found.a_wrms.ravel(), found.error, found.problems

    (soft, stiff), _, _ = a_w(k_2=[1e11, 1e12])
    rigid = (10 * stiff - soft) / 9
    found, error, problems = a_w(
        k_2=[1e14, 1e15, 1e16, 1e17, 1e18, 1e16, 7.5e5, 7.5e5, 7.5e5],
        c_2=[7e4, 7e4, 7e4, 7e4, 7e4, 1e14, 1e14, 1e16, 1e18],
    )
    off, lost = np.abs(found / rigid - 1), np.isnan(found)
    assert (off[~lost] <= error[~lost] + 1e-8).all()  # 1e-8: what the limit is known to
    assert (error[~lost] <= 1e-2).all()
    assert not lost[[0, 1, 2, 6]].any()
    assert [bool(problem) for problem in problems] == lost.tolist()


@pytest.mark.parametrize(
    ("design", "said"),
    [
        ({"c_2": 1e20}, "rounding decides"),
        ({"k_2": 1e12, "c_2": 1e200}, "rounding decides"),
        ({"c_2": 1e308}, "no finite number"),
        ({"c_2": 1e305, "m_b": 1e-4}, "too large or too small"),
    ],
)
def test_what_is_worthless_is_not_given(design, said):
    for segments in (1, 2):
        for results in ("a_wrms", "travel"):
            found = evaluate_designs(paper_coach(segments), design, "erri_low", 40.0,
                                     results=results)  # fmt: skip
            value = found.a_wrms if results == "a_wrms" else found.travel_rms[..., :2]
            assert np.isnan(value).all()
            assert said in found.problems[0]
            assert "1 of 1 designs lack values" in found.remarks[0]


def test_all_that_cannot_be():
    found = evaluate_designs(paper_coach(1), {"k_2": [-1.0, -2.0]}, "erri_low", SPEEDS)
    assert np.isnan(found.a_wrms).all()
    assert found.table()["problem"].str.contains("above 0").all()


# Tables


def test_a_table_has_a_row_for_each_design():
    designs = pd.DataFrame({"secondary_stiffness": [6e5, 9e5], "zeta_bending": [0.01, 0.02]})
    found = evaluate_designs(paper_coach(2), designs, ["erri_low", "fra_4"], SPEEDS, [0.0, -2.5],
                             results=["wz", "a_wrms"])  # fmt: skip
    table = found.table()
    assert list(table)[:3] == ["secondary_stiffness [N/m]", "zeta_bending",
                               "a_wrms erri_low 145 km/h 0 m [m/s^2]"]  # fmt: skip
    assert list(table)[-2:] == ["error", "problem"]
    assert "wz fra_4 200 km/h -2.5 m" in table
    assert len(table) == len(found) == 2
    assert table.shape[1] == 2 + 2 * 8 + 2
    column = table["a_wrms fra_4 145 km/h -2.5 m [m/s^2]"]
    np.testing.assert_array_equal(column, found.a_wrms[:, 1, 0, 1])


def test_a_data_set_names_its_axes_and_units():
    xarray = pytest.importorskip("xarray")
    designs = {"secondary_stiffness": [6e5, 9e5], "zeta_bending": 0.01}
    found = evaluate_designs(paper_coach(2), designs, ["erri_low", "fra_4"], SPEEDS, [0.0, -2.5],
                             results=["a_wrms", "travel", "modes", "static"])  # fmt: skip
    data = found.dataset()
    assert isinstance(data, xarray.Dataset)
    assert data.a_wrms.dims == ("design", "track", "speed", "position")
    assert data.a_wrms.attrs["units"] == "m/s^2"
    one = data.a_wrms.sel(track="fra_4", speed=SPEEDS[1], position=-2.5)
    np.testing.assert_array_equal(one, found.a_wrms[:, 1, 1, 1])
    assert data.speed.attrs["units"] == "m/s"
    assert data.secondary_stiffness.dims == ("design",)
    assert data.secondary_stiffness.attrs["units"] == "N/m"
    assert data.damping_ratio.sel(mode="heave").attrs["units"] == "1"
    travel = data.travel_peak.sel(suspension="primary_2_deflection", track="erri_low")
    np.testing.assert_array_equal(travel, found.travel_peak[:, 0, :, 2])
    assert data.least_damping_ratio.dims == ("design",)
    assert list(data.problem) == ["", ""]
    bare = evaluate_designs(paper_coach(2), {}, "erri_low", 40.0, results="static").dataset()
    assert set(bare.sizes) == {"design", "suspension"}


def test_a_data_set_without_xarray(monkeypatch):
    monkeypatch.setitem(sys.modules, "xarray", None)
    found = evaluate_designs(paper_coach(1), {}, "erri_low", 40.0, results="static")
    with pytest.raises(InputError, match=r"railride\[xarray\]"):
        found.dataset()


# What the caller gave


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"designs": {"k_3": [1.0]}}, "did you mean"),
        ({"designs": {"k_2": [1.0], "secondary_stiffness": [1.0]}}, "both k_2"),
        ({"designs": {"k_2": [1.0, 2.0], "c_2": [1.0, 2.0, 3.0]}}, "2 of k_2, 3 of c_2"),
        ({"designs": {"k_2": []}}, "found none"),
        ({"designs": {"k_2": ["soft"]}}, "numbers in SI units"),
        ({"designs": {"k_2": [[1.0]]}}, "shape"),
        ({"tracks": []}, "tracks: found none"),
        ({"tracks": ["erri_low", "erri_low"]}, "erri_low twice"),
        ({"tracks": "erri_lo"}, "erri_low"),
        ({"speeds": [40.0, 40.0]}, "twice"),
        ({"speeds": [0.0]}, "speed"),
        ({"speeds": []}, "speeds: found none"),
        ({"speeds": None}, "speeds: found None"),
        ({"designs": [1.0]}, "designs: found list"),
        ({"designs": None}, "designs: found NoneType"),
        ({"tracks": 3}, "tracks: found 3"),
        ({"tracks": [3]}, "3"),
        ({"at": None}, "at: found None"),
        ({"floor": 3}, "polygon"),
        ({"weight": 3}, "Wk"),
        ({"results": 3}, "results: found 3"),
        ({"tracks": "sncf_good", "speeds": [1e5]}, "nothing of it"),
        ({"at": [13.0]}, "off the body"),
        ({"floor": "flat"}, "polygon"),
        ({"weight": "Wx"}, "Wk"),
        ({"results": ["a_wrms", "noise"]}, "'noise'"),
        ({"results": []}, "results: found none"),
    ],
)
def test_what_is_no_question(given, said):
    asked = {"designs": {"k_2": [7e5]}, "tracks": "erri_low", "speeds": SPEEDS} | given
    with pytest.raises(InputError, match=said):
        evaluate_designs(paper_coach(1), **asked)
