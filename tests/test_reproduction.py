"""The reproduction of the paper's results: its numbers are the library's, and its parts are right.

The whole is made by ``python derivations/reproduction.py``; here are the parts that take seconds.
"""

import doctest
import re
import sys
from itertools import zip_longest
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parent.parent / "derivations"
sys.path.insert(0, str(FOLDER))

import paper  # noqa: E402
import reproduction_cases as cases  # noqa: E402
import reproduction_causes as causes  # noqa: E402
import reproduction_errors as errors  # noqa: E402
import reproduction_fit as fit  # noqa: E402
import reproduction_gap as gap  # noqa: E402
import reproduction_integrators as integrators  # noqa: E402
import reproduction_results as results  # noqa: E402
import reproduction_seeds as seeds  # noqa: E402
from reproduction_cases import bodies, exact, passage, road  # noqa: E402
from reproduction_gap import Difference, nearest  # noqa: E402

from railride import KMH, derive_vehicle, ride, stochastic_ride, synthesise  # noqa: E402
from railride.markup import markdown  # noqa: E402

DOCUMENT = (FOLDER / "reproduction.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"[+-]?\d+(?:\.(\d+))?(?:e-?\d+)?")


def numbers(text):
    """Every number of a text, and one unit of its last place."""
    found = [(float(m.group()), 10.0 ** -len(m.group(1) or "")) for m in NUMBER.finditer(text)]
    return np.array(found).reshape(-1, 2)


def rows(heading):
    """The rows of the first table whose first row holds a heading: lists of cells."""
    table = next(t for t in re.findall(r"(?:^\|.*\n)+", DOCUMENT, re.MULTILINE)
                 if heading in t.splitlines()[0])  # fmt: skip
    return [[cell.strip() for cell in line.strip("|").split("|")]
            for line in table.splitlines()[2:]]  # fmt: skip


def eight_cases():
    """The chapter, with DYMOLA's kilometre as it is pinned: adaptive integration takes too long."""
    pinned = {(row[0], row[1]): float(row[5]) for row in rows("km of seed 1") if row[2] == "DYMOLA"}

    def run(case):
        if case.program == "VAMPIRE":
            return cases.simulated(case)
        kind = "flexible" if case.flexible else "rigid"
        return cases.Simulated(case, np.array([]), np.array([]),
                               pinned[f"{case.speed_kmh:g}", kind])  # fmt: skip

    return results.eight_cases([run(case) for case in paper.CASES], fit.fits())


CHAPTERS = {
    "opening": results.opening,
    "eight cases": eight_cases,
    "one kilometre": results.one_kilometre,
    "one factor": lambda: results.one_factor(fit.fits()),
    "table 4": results.table_4,
    "the body": causes.the_body,
    "storing": lambda: causes.storing(errors.storing_errors()),
    "closing": causes.closing,
}


def differences(now, then):
    """Words that differ, and numbers that do by more than one of their last place."""
    words, others = (NUMBER.sub("#", text).split() for text in (now, then))
    found = [pair for pair in zip_longest(words, others) if pair[0] != pair[1]]
    if not found:
        a, b = numbers(now), numbers(then)
        found = [(x, y) for x, y in zip(a, b, strict=True) if abs(x[0] - y[0]) > 1.001 * x[1]]
    return found


@pytest.mark.parametrize("chapter", CHAPTERS)
def test_pinned_chapters_are_what_is_computed_now(chapter):
    now = markdown(CHAPTERS[chapter]()).strip()
    heading = now.splitlines()[0]
    start = DOCUMENT.index(heading)
    follows = "\n## The eight cases" if chapter == "opening" else "\n## "
    then = DOCUMENT[start:].removeprefix(heading).partition(follows)[0]
    assert differences(now, heading + then) == []


def test_a_changed_word_or_figure_is_noticed():
    text = markdown(results.table_4())
    assert differences(text, text.replace("0.2475", "0.2477"))
    assert differences(text, text.replace("more than", "less than", 1))
    assert differences(text, text + "more")


def test_differences_of_the_models_are_those_of_the_table():
    found = {row[1]: (row[3:5], row[5:7]) for row in rows("| difference | kind |")}
    gaps = {d.name: d.gap for d in gap.alone()}
    together = {d.name.split("; ", 1)[1]: d.gap for d in gap.with_the_halves()}
    assert len(gaps) == 13
    for name, value in gaps.items():
        shown, on_top = (" ".join(cells) for cells in found[name])
        assert not differences(" ".join(map(results.percent, value)), shown), name
        if name in together:
            assert not differences(" ".join(map(results.percent, together[name])), on_top), name


def test_exact_values_of_the_document():
    """N = 2 on ERRI low and the rigid body, as two independent programs computed them."""
    found = {(row[0], row[1], row[2]): float(row[6]) for row in rows("km of seed 1")}
    assert len(found) == 8
    for program in ("DYMOLA", "VAMPIRE"):
        assert found["145", "rigid", program] == pytest.approx(0.0494, abs=6e-5)
        assert found["200", "rigid", program] == pytest.approx(0.0756, abs=6e-5)
    assert found["145", "flexible", "DYMOLA"] == pytest.approx(0.2475, abs=6e-5)
    assert found["200", "flexible", "DYMOLA"] == pytest.approx(0.3275, abs=6e-5)


def test_segments_approach_the_beam_as_they_are_known_to():
    """+39, -17, +14 and +3.6 % on the polygon, N = 4 within 1 % on the smooth floor."""
    found = {row[0]: row for row in rows("polygon, 145 km/h to beam")}
    polygon = {n: float(found[n][2].removesuffix(" %")) for n in ("2", "3", "4", "8")}
    assert polygon == pytest.approx({"2": 39, "3": -17, "4": 14, "8": 3.6}, abs=0.5)
    assert abs(float(found["4"][6].removesuffix(" %"))) < 1
    limit = exact(derive_vehicle("cati2024", body="beam", modes=5))
    assert [float(found["beam"][k]) for k in (1, 3)] == pytest.approx(limit, abs=6e-5)


def test_damping_table_agrees_with_vehicles_that_are_derived_with_it():
    found = {row[0]: row for row in rows("two halves, 145 km/h")}
    damped = exact(derive_vehicle("cati2024", 2, bending_damping=0.015))
    assert damped == pytest.approx([0.1535, 0.2192], abs=6e-5)  # by another program
    assert [float(x) for x in found["1.5 %"][1:3]] == pytest.approx(damped, abs=6e-5)


@pytest.mark.parametrize("seed", [1, 200, 1000])
def test_seeds_run_again_give_the_pinned_values(seed):
    pinned = seeds.pinned().set_index("seed").loc[seed]
    for heading, value in seeds.one_seed(seed).items():
        if heading != "seed":
            assert value == pytest.approx(pinned[heading], rel=1e-9)


@pytest.mark.parametrize("speed", [145.0, 200.0])
@pytest.mark.parametrize("body", ["rigid", "halves", "damped halves", "beam"])
def test_kilometres_average_to_the_exact_value_and_scatter_as_predicted(body, speed):
    runs, k = seeds.sample(body, speed), int(speed == 200.0)
    found = stochastic_ride(bodies()[body], speed * KMH, "erri_low", floor="polygon")
    squares = runs.values**2
    off = squares.mean() - exact(bodies()[body])[k] ** 2
    assert abs(off) < 3 * squares.std(ddof=1) / np.sqrt(squares.size)
    predicted = found.standard_error(1000 / (speed * KMH))[0] / found.a_wrms[0]
    assert runs.scatter == pytest.approx(predicted, rel=0.1)


def test_interval_is_students_of_the_mean_squares():
    from scipy.stats import ttest_1samp

    runs = seeds.Sample(np.array([0.2, 0.25, 0.22, 0.31]))
    low, high = ttest_1samp(runs.values**2, 0.0).confidence_interval(0.95)
    assert runs.interval == pytest.approx((np.sqrt(low), np.sqrt(high)), rel=1e-12)
    assert runs.mean == pytest.approx(np.sqrt(np.mean(runs.values**2)), rel=1e-12)


def test_a_track_scaled_by_the_factor_gives_the_printed_value():
    """Of one kilometre: a_wrms follows the level's factor, as the fit has it."""
    found = next(f for f in fit.fits() if (f.program, f.body) == ("DYMOLA", "halves"))
    assert found.factor == pytest.approx(0.225 / 0.247484, rel=1e-5)
    assert found.predicted == pytest.approx(0.327514 * 0.225 / 0.247484, rel=1e-5)
    track = road()
    scaled = type(track)(track.distance0, track.step, found.factor * track.level)
    level = [ride(bodies()["halves"], t, 145 * KMH, length=500.0, floor="polygon").cases[0].a_wrms
             for t in (track, scaled)]  # fmt: skip
    assert level[1] / level[0] == pytest.approx(found.factor, rel=1e-9)


@pytest.fixture(scope="module")
def short():
    """Fifty metres of rough track at 200 km/h under the rigid body."""
    track = synthesise("erri_low", 900.0, 0.05, 3)
    return integrators.Passage(bodies()["rigid"], 200 * KMH, track, 50.0)


@pytest.fixture(scope="module")
def reference(short):
    """The exact response at 1/16 ms."""
    return integrators.first_order_hold(short, 16_000.0)


@pytest.mark.parametrize(("integrator", "order"), [(integrators.first_order_hold, 2),
                                                   (integrators.euler_cromer, 1)])  # fmt: skip
def test_orders_of_the_integrators(short, reference, integrator, order):
    exact_samples = integrators.stored(reference, 16_000.0)
    coarse, fine = (
        integrators.deviation(integrators.stored(integrator(short, rate), rate), exact_samples,
                              short.before) for rate in (1000.0, 2000.0)
    )  # fmt: skip
    assert np.log2(coarse / fine) == pytest.approx(order, abs=0.15)


def test_adaptive_integrators_come_to_the_exact_response(short, reference):
    exact_samples = integrators.stored(reference, 16_000.0)
    for record in (integrators.bdf(short, 1e-3, 1e-6)[0], integrators.vode(short, 1e-3, 1e-6)):
        found = integrators.deviation(integrators.stored(record), exact_samples, short.before)
        assert found < 2e-3


def test_euler_cromer_steps_as_it_is_written(short):
    """One step by hand: the rates first, then the coordinates with the new rates."""
    s, h, x = short.system, 0.001, short.start.copy()
    time, n = short.times(1 / h)[:4], len(short.start) // 2
    by_hand = []
    for t in time:
        u = short.inputs(t)[:, 0]
        by_hand.append(float((s.C @ x + s.D @ u)[0]))
        x[n:] += h * (s.A @ x + s.B @ u)[n:]
        x[:n] += h * x[n:]
    found = integrators.euler_cromer(short, 1 / h)[:4]
    assert found == pytest.approx(by_hand, rel=1e-9, abs=1e-15)


def test_euler_cromer_beyond_its_stability_says_so():
    """h < 2/ω: ten bending modes of the beam are too fast for 1 ms."""
    beam = derive_vehicle("cati2024", body="beam", modes=10)
    way = integrators.Passage(beam, 200 * KMH, road(), 100.0)
    assert np.isinf(integrators.rated(integrators.euler_cromer(way), way.before))


def test_passage_is_the_ride_of_the_library():
    """The same kilometre by railride.ride, whose run-in is another."""
    way = passage("halves", 200.0)
    here = integrators.rated(integrators.first_order_hold(way), way.before)
    there = ride(bodies()["halves"], "erri_low", 200 * KMH, floor="polygon").cases[0].a_wrms
    assert here == pytest.approx(there, rel=1e-3)


def test_weighting_at_50_hz_of_a_tone_at_9_6_hz():
    """A bilinear filter is 4.2 % low there and a hold 13 %; railride's is right."""
    time = np.arange(0.0, 60.0, 0.02)
    found = integrators.weighted_at_50_hz(np.sqrt(2) * np.sin(2 * np.pi * 9.6 * time), 10.0)
    true = abs(integrators.WK.response(9.6))
    assert found["bilinear"] / true - 1 == pytest.approx(-0.042, abs=1e-3)
    assert found["hold"] / true - 1 == pytest.approx(-0.13, abs=5e-3)
    assert found["railride"] == pytest.approx(true, rel=1e-3)


def test_differences_multiply_and_the_nearest_is_found():
    first = Difference("a", "body", np.array([0.2, 0.1]))
    both = first.and_also(Difference("b", "damping", np.array([0.1, -0.1])))
    assert both.gap == pytest.approx([0.32, -0.01])
    gaps = {(0.0, 0.0): np.array([0.3, 0.3]), (0.0, 0.01): np.array([0.18, 0.10])}
    assert nearest(gaps)[0] == (0.0, 0.01)


def test_step_of_convergence_needs_all_finer_ones():
    assert errors.converged_step([1e-4, 2e-3, 1e-4], (500.0, 1000.0, 2000.0)) == 1 / 2000
    assert errors.converged_step([1e-4, 2e-3], (500.0, 1000.0)) is None


@pytest.mark.parametrize("module", [errors, cases, results, seeds])
def test_examples_in_the_docstrings(module):
    found = doctest.testmod(module)
    assert found.attempted
    assert not found.failed


def test_every_picture_is_there_and_every_chapter():
    pictures = re.findall(r"!\[.+\]\((.+)\)", DOCUMENT)
    assert len(pictures) == 10
    assert all((FOLDER / picture).is_file() for picture in pictures)
    assert results.COMMAND in DOCUMENT
    assert markdown(causes.closing()).strip() in DOCUMENT
