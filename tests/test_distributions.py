"""Distributions of parameters and samples of them, against scipy's own and closed forms."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from scipy import integrate, stats
from scipy.stats import qmc

from railride.distributions import (
    METHODS,
    Distribution,
    note_impossible,
    read_distribution,
    refuse_sampling,
    sample,
)
from railride.errors import Faults, InputError
from railride.toml_tables import Table
from railride.vehicle import derive_vehicle

U = np.linspace(0.001, 0.999, 37)
EXAMPLES = [
    Distribution("normal", mean=750e3, deviation=37.5e3),
    Distribution("normal", mean=750e3, deviation=300e3, low=300e3, high=900e3),
    Distribution("lognormal", mean=70e3, deviation=10e3),
    Distribution("lognormal", mean=65e3, deviation=10e3, low=30e3, high=70e3),
    Distribution("uniform", low=0.0, high=0.02),
    Distribution("triangular", low=34e3, mode=36e3, high=42e3),
    Distribution("beta", low=34e3, high=42e3, alpha=2.0, beta=5.0),
]


def moment(distribution, power):
    """∫₀¹ F⁻¹(u)^power du, by quadrature."""
    return integrate.quad(lambda u: float(distribution.ppf(u)) ** power, 0, 1, limit=200)[0]


@pytest.mark.parametrize("distribution", EXAMPLES, ids=str)
def test_quantiles_and_probabilities_are_each_others_inverse(distribution):
    np.testing.assert_allclose(distribution.cdf(distribution.ppf(U)), U, rtol=1e-9)
    low, high = distribution.support()
    assert low <= distribution.ppf(0.0) <= distribution.ppf(U).min()
    assert high >= distribution.ppf(1.0) >= distribution.ppf(U).max()


@pytest.mark.parametrize("kind", ["normal", "lognormal"])
def test_mean_and_deviation_are_those_of_the_value(kind):
    one = Distribution(kind, mean=70.0, deviation=20.0)
    assert moment(one, 1) == pytest.approx(70.0, rel=1e-6)
    assert moment(one, 2) - 70.0**2 == pytest.approx(20.0**2, rel=1e-5)


def test_a_cut_is_the_distribution_on_condition_of_its_limits():
    for kind in ("normal", "lognormal"):
        whole = Distribution(kind, mean=70.0, deviation=20.0)
        cut = Distribution(kind, mean=70.0, deviation=20.0, low=50.0, high=80.0)
        a, b = whole.cdf([50.0, 80.0])
        np.testing.assert_allclose(cut.ppf(U), whole.ppf(a + U * (b - a)), rtol=1e-12)
        assert cut.support() == pytest.approx((50.0, 80.0), rel=1e-15)


def test_cut_at_its_mean_a_normal_is_half_of_one():
    loss = Distribution("normal", mean=70e3, deviation=7e3, high=70e3)
    np.testing.assert_allclose(70e3 - loss.ppf(1 - U), stats.halfnorm(scale=7e3).ppf(U), rtol=1e-9)


def test_figures_that_cannot_be_come_all_together():
    with pytest.raises(InputError) as error:
        Distribution("normal", deviation=-1.0, low=3.0, high=2.0, mode=2.0)
    said = str(error.value)
    for part in ("mode: found a figure that is not needed", "mean: found none",
                 "deviation: found -1.0; expected a positive number",
                 "high: found 2; expected more than low, 3"):  # fmt: skip
        assert part in said
    with pytest.raises(InputError, match="one of normal, lognormal, uniform"):
        Distribution("gaussian", mean=1.0)
    with pytest.raises(InputError, match="mode: found 9; expected a value from low, 0, to high, 1"):
        Distribution("triangular", low=0.0, mode=9.0, high=1.0)
    for low, high in ((1e3, 2e3), (-2e3, -1e3)):
        with pytest.raises(InputError, match="which leave 0 of the normal distribution"):
            Distribution("normal", mean=0.0, deviation=1.0, low=low, high=high)
    with pytest.raises(InputError, match="where a lognormal distribution begins"):
        Distribution("lognormal", mean=1.0, deviation=1.0, low=-2.0, high=-1.0)
    with pytest.raises(InputError, match="finite number"):
        Distribution("uniform", low=0.0, high=math.inf)


def read(content, unit="N/m", nominal=750e3):
    faults = Faults("study.toml")
    table = Table(content, "parameters.k_2", faults)
    found = read_distribution(table, unit, nominal)
    table.finish()
    return found, [str(fault) for fault in faults.found]


def test_per_cent_are_of_the_nominal_value_and_of_the_mean():
    found, faults = read({"distribution": "normal", "mean": "90 %", "deviation": "10 %",
                          "from": "400 kN/m", "to": "100 %"})  # fmt: skip
    assert not faults
    assert found == Distribution("normal", mean=675e3, deviation=67.5e3, low=400e3, high=750e3)
    found, _ = read({"distribution": "triangular", "from": "80 %", "to": "110 %"})
    assert (found.low, found.mode, found.high) == pytest.approx((600e3, 750e3, 825e3), rel=1e-15)
    found, _ = read({"distribution": "normal", "deviation": "10 %"}, "m", -8.75)
    assert found.deviation == pytest.approx(0.875, rel=1e-15)
    assert found.mean == -8.75


def test_per_cent_of_a_plain_number_are_its_value():
    found, faults = read({"distribution": "uniform", "from": 0, "to": "2 %"}, "", 0.01)
    assert not faults
    assert found == Distribution("uniform", low=0.0, high=0.02)


def test_a_table_without_a_distribution_is_another_kind_of_table():
    assert (
        read_distribution(Table({"values": []}, "parameters.k_2", Faults("")), "N/m", 1.0) is None
    )


def test_faults_of_a_table_come_together_by_its_keys():
    _, faults = read(
        {"distribution": "normal", "deviation": "5 kg", "from": "9 %", "peak": 1}, "N/m", 0.0
    )
    assert any(f.startswith("parameters.k_2.deviation: found '5 kg' (a mass)") for f in faults)
    assert any("k_2.from: found '9 %'" in f and "its nominal value is 0" in f for f in faults)
    assert any("k_2.peak: found a key that is not known" in f for f in faults)
    _, faults = read({"distribution": "uniform", "from": "900 kN/m", "to": "700 kN/m"})
    assert faults == ["parameters.k_2.to: found 700000; expected more than low, 900000"]
    _, faults = read({"distribution": "uniform", "from": "900 kN/m"})
    assert faults == [
        "parameters.k_2.to: found none; expected one: a uniform distribution needs it"
    ]
    _, faults = read({"distribution": "normal", "deviation": "5 %"}, nominal=None)
    assert "k_2.deviation: found '5 %'" in faults[0]
    _, faults = read({"distribution": "gauss"})
    assert "expected one of 'normal', 'lognormal'" in faults[0]


@pytest.mark.parametrize("method", METHODS)
def test_parts_are_the_whole_to_the_last_bit(method):
    whole = sample(EXAMPLES, 0, 1000, method, 7, 1000)
    assert whole.shape == (1000, len(EXAMPLES))
    edges = [0, 1, 2, 130, 131, 640, 1000, 1000]
    parts = [sample(EXAMPLES, a, b, method, 7, 1000) for a, b in itertools.pairwise(edges)]
    np.testing.assert_array_equal(np.concatenate(parts), whole)
    assert not np.array_equal(sample(EXAMPLES, 0, 1000, method, 8, 1000), whole)


UNIT = [Distribution("uniform", low=0.0, high=1.0)] * 3


def test_samples_are_those_of_the_libraries():
    np.testing.assert_array_equal(
        sample(UNIT, 0, 64, "sobol", 3), qmc.Sobol(3, bits=32, rng=3).random_base2(6)
    )
    np.testing.assert_array_equal(
        sample(UNIT, 0, 50, "random", 3), np.random.default_rng(3).random((50, 3))
    )
    np.testing.assert_array_equal(
        sample(UNIT, 0, 50, "latin_hypercube", 3, 50), qmc.LatinHypercube(3, rng=3).random(50)
    )


def test_points_fill_the_cube_evenly():
    for method, number in (("latin_hypercube", 100), ("sobol", 128)):
        u = sample(UNIT, 0, number, method, 5, number)
        slices = np.sort((number * u).astype(int), axis=0)
        np.testing.assert_array_equal(slices, np.arange(number)[:, np.newaxis] * np.ones(3, int))
    later = sample(UNIT, 3 * 2**20, 3 * 2**20 + 128, "sobol", 5)
    np.testing.assert_array_equal(np.sort((128 * later[:, 0]).astype(int)), np.arange(128))


def test_no_point_is_infinite():
    class Edge:
        def ppf(self, q):
            assert (q > 0).all()
            assert (q < 1).all()
            return q

        def support(self):
            return 0.0, 1.0

    for seed in range(20):
        sample([Edge()], 0, 4096, "sobol", seed)
    sample([Edge()], 2**28 - 5, 2**28, "sobol")  # near 2³² it takes seconds to get there


def test_distributions_of_scipy_can_be_sampled():
    found = sample([stats.gamma(3.0), stats.randint(1, 4)], 0, 64)
    np.testing.assert_allclose(found[:, 0].mean(), 3.0, rtol=0.05)
    assert set(found[:, 1]) == {1.0, 2.0, 3.0}


def test_samples_that_cannot_be_are_refused_all_together():
    with pytest.raises(InputError) as error:
        sample(UNIT, 5, 2, "lattice", -1)
    said = str(error.value)
    for part in ("start, stop: found 5, 2", "method: found 'lattice'", "seed: found -1"):
        assert part in said
    with pytest.raises(InputError, match="total: found none"):
        sample(UNIT, 0, 4, "latin_hypercube")
    with pytest.raises(InputError, match="≤ 3"):
        sample(UNIT, 0, 4, "random", 0, 3)
    faults = Faults("study")
    refuse_sampling(faults, 5, 10**8, "latin_hypercube", 0)
    assert "10" in str(faults.found[0])
    assert "4 GB, which is made as a whole" in str(faults.found[0])


def test_values_that_a_model_cannot_have_are_found_beforehand():
    coach = derive_vehicle("cati2024", segments=2)
    fine = {"secondary_stiffness": Distribution("normal", mean=750e3, deviation=37.5e3),
            "c_2": stats.lognorm(0.2, scale=60e3),
            "bending_damping": Distribution("uniform", low=0.0, high=0.02)}  # fmt: skip
    faults = Faults("study")
    note_impossible(coach, fine, faults)
    assert not faults.found
    wide = {"secondary_stiffness": Distribution("normal", mean=750e3, deviation=150e3),
            "c_2": stats.uniform(-10.0, 60e3),
            "bending_damping": Distribution("normal", mean=0.01, deviation=0.01),
            "secondary_stifness": EXAMPLES[0],
            "I_c": Distribution("uniform", low=1.5e6, high=9e6), "k_2": EXAMPLES[0],
            "c_1": 30e3}  # fmt: skip
    note_impossible(coach, wide, faults)
    said = [str(fault) for fault in faults.found]
    assert len(said) == 7
    assert "c_1: found 30000.0; expected a Distribution" in said[6]
    assert "secondary_stiffness: found normal, mean 750000" in said[0]
    assert "finite numbers above 0 (cut it: from = …)" in said[0]
    assert "c_2: found a distribution, which reaches -10" in said[1]
    assert "expected values of at least 0" in said[2]
    assert "did you mean secondary_stiffness" in said[3]
    assert "I_c" in said[4]
    assert "k_2: found secondary_stiffness again; expected each parameter once" in said[5]
