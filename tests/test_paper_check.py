"""The paper check is what the program finds now, and its figures are those known of old."""

import io
import re
from html import unescape
from math import pi, tan
from pathlib import Path

import check_comfort
import check_conclusions
import check_figures
import check_halves
import check_integration
import check_results
import check_values
import check_vehicle
import numpy as np
import paper
import paper_check
import pytest
from check_values import base, values
from claims import FAILS, FOLLOWS, MARKS, OPEN, linked
from markdown_it import MarkdownIt
from PIL import Image
from scipy import signal

import railride as rr
from railride.plots import canvas

FOLDER = Path(__file__).parent.parent / "derivations"
PINNED = (FOLDER / "paper_check.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"(?<![\w#.])[+−]?\d+(?:\.\d+)?")
LAST_DIGIT = 5e-5  # of a value with four decimals


ROWS = re.findall(r"^\| \[(\d+)\]\(#\d+-(.+?)\) \|.*\| . (.+?) \| [^|]+ \|$", PINNED, re.MULTILINE)
VERDICTS = {anchor: verdict for _, anchor, verdict in ROWS}


def pieces(text):
    """A document's words without its numbers, and its numbers as they are written."""
    return NUMBER.sub("#", text).split(), NUMBER.findall(text)


def differences(a, b):
    """Numbers that are not the same to one of their last decimal; whole ones but % exactly."""
    (words, numbers), (others, found) = pieces(a), pieces(b)
    assert words == others
    pairs = zip(numbers, found, strict=True)
    return [(x, y) for x, y in pairs if x != y and not near(x, y)]


def near(x, y):
    decimals = [len(text.partition(".")[2]) for text in (x, y)]
    one = 10.0 ** -decimals[0]
    a, b = (float(text.replace("−", "-")) for text in (x, y))
    return decimals[0] == decimals[1] > 0 and abs(a - b) < 1.01 * one


def test_pinned_document_is_made_again_by_value():
    claims = paper_check.all_claims()
    assert differences(PINNED, paper_check.document(claims)) == []
    assert len(VERDICTS) == sum(map(len, claims.values()))
    assert set(VERDICTS.values()) == set(MARKS)


def test_a_changed_figure_is_noticed():
    assert differences(PINNED, PINNED.replace("0.2475", "0.2477")) != []
    assert differences(PINNED, PINNED.replace("54 claims", "53 claims")) != []
    with pytest.raises(AssertionError):
        differences(PINNED, PINNED.replace("does not follow", "follows", 1))


@pytest.mark.parametrize("name", check_figures.FIGURES)
def test_pictures_are_drawn_again(name):
    """Point by point, but for what fonts and edges may differ by."""
    figure = check_figures.FIGURES[name]()
    fresh = io.BytesIO()
    figure.savefig(fresh, format="png", dpi=canvas.DPI)
    now, then = (
        np.asarray(Image.open(source).convert("L"), dtype=float)
        for source in (fresh, FOLDER / "figures" / f"{name}.png")
    )
    assert now.shape == then.shape
    assert np.abs(now - then).mean() < 1.0


def test_every_link_leads_somewhere():
    headings = re.findall(r"^#+ (.+)$", PINNED, flags=re.MULTILINE)
    anchors = {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}
    assert set(re.findall(r"\]\(#(.+?)\)", PINNED)) <= anchors
    pictures = re.findall(r"\]\((figures/.+?)\)", PINNED)
    assert sorted(pictures) == sorted(f"figures/{name}.png" for name in check_figures.FIGURES)
    assert all((FOLDER / path).exists() for path in pictures)


def test_mathematics_and_tables_survive_markdown():
    """A reader that knows no mathematics takes nothing of it for its own; rows are whole."""
    html = MarkdownIt("commonmark").enable("table").render(PINNED)
    shown = unescape(re.sub(r"<[^>]+>", "", html))
    inline = re.findall(r"(?<!\$)\$([^$\n]+)\$", PINNED)
    assert len(inline) > 40
    assert [m for m in inline if m not in shown] == []
    assert html.count("<table>") == len(re.findall(r"^\| -", PINNED, flags=re.MULTILINE))
    for table in re.findall(r"(?:^\|.+\n)+", PINNED, flags=re.MULTILINE):
        assert len({line.count("|") for line in table.splitlines()}) == 1


def test_a_link_to_no_claim_is_refused():
    with pytest.raises(KeyError, match="no such claim"):
        linked("[[no such claim]]", [])


# What is known of the paper, each with the digits it is known to.


def test_primary_damping():
    f, zeta = check_vehicle.bogie_heave()
    assert f == pytest.approx(9.4, abs=0.05)
    assert zeta == pytest.approx(0.37, abs=0.005)
    assert (
        check_integration.euler_cromer_growth(30e3)
        < 1
        < check_integration.euler_cromer_growth(30e6)
    )
    assert VERDICTS["primary-damping"] == FAILS


def test_joint_stiffness():
    (held, _), (free, needed) = check_halves.joint_readings().values()
    assert held == pytest.approx(4.79, abs=0.005)
    assert free == pytest.approx(9.586, abs=5e-4)
    assert needed == pytest.approx(17_000 * 12**2 * (2 * pi * 9.6) ** 2 / 24, rel=1e-12)
    assert VERDICTS["joint-stiffness-from-the-bending-frequency"] == FAILS
    for equation in ("nonlinear-equation-of-motion", "linear-equation-of-motion"):
        assert VERDICTS[equation] == FOLLOWS


def test_symmetry_leaves_two_coordinates():
    found = check_halves.squares(check_halves.linearise(check_halves.symmetric_body()))
    m, L, k = check_halves.m_h, check_halves.L_h, check_halves.k_theta
    assert found == [0, 24 * k / (m * L**2)]


def test_weight_hardly_changes_the_frequency():
    """To the first order in the sag θ₀² = (m g L/4k)²: 1 + θ₀² above, 1 + 3 θ₀² below."""
    sag = 17_000 * 9.81 * 12 / (4 * 3.7e8)
    assert check_halves.gravity_share() == pytest.approx(-2 * sag**2, rel=1e-3)


def test_segment_inertia():
    assert float(paper.coach_of_inertia().bending_frequencies()[0]) == pytest.approx(
        8.87, abs=0.005
    )
    assert 34_000 * 24**2 / 12 == 1.632e6


def test_degrees_of_freedom():
    counted = [len(paper.coach(flexible).lagrangian.coordinates) for flexible in (False, True)]
    assert counted == [6, 7]
    assert VERDICTS["six-and-eight-degrees-of-freedom"] == FAILS


def test_band_limits():
    for flexible, low, high in ((True, 0.0003, 0.0005), (False, 0.0065, 0.0085)):
        without = values(paper.coach(flexible), weight="Wk_paper")
        grown = [a / b - 1 for a, b in zip(without, base(flexible), strict=True)]
        assert low < min(grown) <= max(grown) < high


def test_table_4():
    (first, _, _), (second, to_dymola, _) = check_results.from_rounded()
    assert first == pytest.approx(17.801, abs=5e-4)
    assert second == pytest.approx(8.922, abs=5e-4)
    assert to_dymola == pytest.approx(8.191, abs=5e-4)


def test_output_step():
    W = abs(complex(rr.weighting("Wk").response(9.6)))
    assert check_integration.sampled_gain("bilinear", 9.6) / W - 1 == pytest.approx(
        -0.042, abs=5e-4
    )
    hold = check_integration.sampled_gain("first-order hold", 9.6) / W - 1
    assert hold == pytest.approx(-0.13, abs=0.005)
    share, grown = check_integration.folded(True)
    assert 0 < max(share + grown) < 1e-5


def test_sampled_filters_against_theory():
    """A bilinear filter is the analogue one at tan(πfT)/(πT); a first-order hold is scipy's."""
    T, f = paper.OUTPUT_STEP, 7.3
    warped = abs(complex(rr.weighting("Wk").response(tan(pi * f * T) / (pi * T))))
    assert check_integration.sampled_gain("bilinear", f) == pytest.approx(warped, rel=1e-9)
    tf, unit = rr.weighting("Wk").transfer_function(), 20 * pi
    num, den = (c[0][0] * unit ** np.arange(len(c[0][0]))[::-1] for c in (tf.num, tf.den))
    system = signal.cont2discrete(signal.tf2ss(num, den), T * unit, method="foh")
    b, a = signal.ss2tf(*system[:4])
    z = np.exp(2j * pi * f * T)
    scipys = abs(np.polyval(b[0], z) / np.polyval(a, z))
    found = check_integration.sampled_gain("first-order hold", f)
    assert found == pytest.approx(scipys, rel=1e-6)


def test_euler_cromer_against_its_own_steps():
    """The recursion's frequency response, at one frequency, is what stepping in time settles to."""
    model, f, h = paper.coach(), 5.0, 1e-3
    A, s = model.matrices(), 2j * pi * f
    w = np.ones(4)
    force = (A.K_w + s * A.C_w) @ w
    expected = np.linalg.solve(
        check_integration.euler_cromer_stiffness(A, np.array([f]), h)[0], force
    )
    q = expected.astype(complex)
    v = (1 - np.exp(-s * h)) / h * q
    for k in range(400):
        a = np.linalg.solve(A.M, force * np.exp(s * h * k) - A.C @ v - A.K @ q)
        v = v + h * a
        q = q + h * v
    assert np.abs(q - expected * np.exp(s * h * 400)).max() < 1e-9 * np.abs(expected).max()


def test_table_3():
    assert VERDICTS["levels-of-ride-comfort"] == FAILS
    classes = [rr.scales.paper_level(row) for row in (0.225, 0.191)]
    assert classes == ["comfortable", "very comfortable"]
    assert check_comfort.worst_rounding()["Wk"] < 0.003


def test_structural_damping():
    assert check_halves.own_damping() == pytest.approx(0.01, abs=5e-4)
    damped = values(paper.coach(), zeta_bending=0.015)
    assert damped == pytest.approx((0.1535, 0.2192), abs=LAST_DIGIT)


def test_base_values_and_comfort_over_speed():
    assert base(True) == pytest.approx((0.2475, 0.3275), abs=LAST_DIGIT)
    assert base(False) == pytest.approx((0.0494, 0.0756), abs=LAST_DIGIT)
    told = [pair[1] for pair in check_results.slowest_and_roughest().values()]
    assert told[:3] == pytest.approx([0.507, 0.2475, 0.0965], abs=5e-4)


def test_readings_of_the_suspension():
    axle, side = list(paper.READINGS.values())[2:]
    assert values(paper.coach(), **axle) == pytest.approx((0.2086, 0.2670), abs=LAST_DIGIT)
    assert values(paper.coach(), **side) == pytest.approx((0.2904, 0.3949), abs=LAST_DIGIT)
    heave = next(iter(check_vehicle.heaves().values()))
    assert heave == pytest.approx(1.0191, abs=LAST_DIGIT)


def test_rigid_values_are_not_printed():
    assert {case.a_wrms for case in paper.CASES if not case.flexible} == {None}
    assert len(paper.CASES) == 8
    assert VERDICTS["a-rigid-car-body-underestimates"] == OPEN
    assert VERDICTS["all-cases-are-comfortable"] == FAILS


def test_scatter_of_one_kilometre():
    exact = check_results.relative_errors()[True]
    assert [round(100 * x) for x in exact] == [14, 14]
    assert min(exact) > 0.13
    a_w, _ = check_values.runs(True)
    pooled = np.sqrt(np.mean(a_w**2, axis=0))
    error = np.array(exact) / np.sqrt(len(a_w))
    assert (np.abs(pooled / base(True) - 1) < 3 * error).all()


@pytest.mark.parametrize(("segments", "off"), [(2, 39), (3, -17), (4, 14), (8, 3.6)])
def test_floor_of_a_polygon(segments, off):
    ratio = values(paper.coach(segments=segments))[0] / values(check_values.beam())[0]
    assert 100 * (ratio - 1) == pytest.approx(off, abs=0.05 if segments == 8 else 0.5)


def test_correlation_against_a_long_run():
    """Track and floor of 20 km, as sampled; below 0.05 Hz neither counts."""
    run = rr.ride(paper.coach(), "erri_low", [145 / 3.6], floor="polygon", length=20_000.0)
    record = run.cases[0].record
    w, a = record.elevation[record.rated], record.acceleration[record.rated]
    lines = np.fft.rfft(w - w.mean())
    lines[np.fft.rfftfreq(w.size, 1e-3) < 0.05] = 0
    w = np.fft.irfft(lines, w.size)
    cross = signal.correlate(a, w, method="fft")[w.size - 3000 : w.size + 3000] / w.size
    sampled = np.abs(cross).max() / (w.std() * a.std())
    assert check_conclusions.largest_correlation(True)[0] == pytest.approx(sampled, abs=0.03)


def test_units_are_read():
    assert check_vehicle.read_units() == {s: p.value for s, p in paper.TABLE_1.items()}
