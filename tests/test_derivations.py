"""The pinned derivations are what the program derives now, compared by value.

Each document is made again by the command that it carries. Its mathematics is read back from what
is printed, in LaTeX and in the part for programs, and compared as numbers; words are compared as
words.
"""

from __future__ import annotations

import json
import re
import shlex
import shutil
import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from read_latex import equations, formulas, name, value

from railride import derive_vehicle
from railride.halfbody import half_body, k_theta, m_h
from railride.lagrange import Lagrangian
from railride.linear import linearise

ROOT = Path(__file__).parent.parent
FOLDER = ROOT / "derivations"
HALVES = {"half_body.md": False, "half_body_free.md": True}
BODIES = {"body_2.md": 2, "body_4.md": 4}
VEHICLES = {"vehicle_1.md": 1, "vehicle_2.md": 2, "vehicle_4.md": 4}
COACHES = {**BODIES, **VEHICLES}
PINNED = [*HALVES, *COACHES]

L_h, theta = sp.Symbol("L_h", positive=True), sp.Symbol("theta", real=True)
rates = [sp.Symbol(f"theta{dots}", real=True) for dots in ("_dot", "_dot_dot")]


@cache
def pinned(document: str) -> str:
    return (FOLDER / document).read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def again(tmp_path_factory):
    """Make a document again by the command in it: the folder where it is."""
    from railride.cli import main

    made: dict[str, Path] = {}

    def make(document):
        if document not in made:
            folder = tmp_path_factory.mktemp("derivations")
            with pytest.MonkeyPatch.context() as patch:
                patch.chdir(folder)
                with pytest.raises(SystemExit) as stopped:
                    main(shlex.split(command(document))[1:])
            assert not stopped.value.code
            made[document] = folder
        return made[document]

    return make


def command(document: str) -> str:
    (found,) = re.findall(r"^Made by `(railride derive [^`]+)`", pinned(document), re.MULTILINE)
    return found


def for_readers(text: str) -> str:
    return text.partition("\n## For a program")[0]


def for_programs(text: str) -> dict:
    (block,) = re.findall(r"```json\n(.*?)\n```", text, flags=re.DOTALL)
    return json.loads(block)


# Fresh


def test_every_document_is_here_and_shown_with_its_picture():
    assert {path.name for path in FOLDER.glob("*.md")} >= set(PINNED)
    for document in PINNED:
        (picture,) = re.findall(r"^!\[[^]]+\]\(([^)]+)\)$", pinned(document), re.MULTILINE)
        assert picture == document.replace(".md", "_coordinates.svg")
        assert (FOLDER / picture).is_file()


def test_make_runs_the_commands_that_the_documents_carry():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    variables = dict(re.findall(r"^(DERIVE|COACH) := (.*)$", makefile, flags=re.MULTILINE))
    coach = variables["COACH"].replace("$(DERIVE)", variables["DERIVE"])
    lines = re.findall(r"^\t(\$\((?:DERIVE|COACH)\) .*)$", makefile, flags=re.MULTILINE)
    made = {}
    for line in lines:
        words = line.replace("$(COACH)", coach).replace("$(DERIVE)", variables["DERIVE"]).split()
        document = Path(words[-1]).name
        made[document] = sorted([*words[words.index("derive") : -1], document])
    assert made == {d: sorted(command(d).split()[1:]) for d in PINNED}


@pytest.mark.parametrize("document", PINNED)
def test_words_are_those_of_a_document_made_now(document, again):
    now = (again(document) / document).read_text(encoding="utf-8")
    old, new = (
        re.sub(r"^\$\$\n.*?\n\$\$$", "$$", for_readers(text), flags=re.DOTALL | re.MULTILINE)
        for text in (pinned(document), now)
    )
    old_words, new_words = (re.split(r"\$[^$\n]+\$|\s+", text) for text in (old, new))
    assert len(old_words) == len(new_words)
    for a, b in zip(old_words, new_words, strict=True):
        assert a == b or same_number(a, b), (a, b)


def same_number(a: str, b: str) -> bool:
    """Whether two figures differ by rounding alone: one unit of the last digit."""
    digits = re.fullmatch(r"-?\d+\.?(\d*)", a)
    if not digits or not re.fullmatch(r"-?\d+\.?\d*", b):
        return False
    return abs(float(a) - float(b)) <= 1.001 * 10.0 ** -len(digits.group(1))


def numbers_for(text: str, seed: int = 1) -> dict[str, float]:
    """A small value for every symbol in a document's part for programs, and for all the others."""
    names = set(re.findall(r"[A-Za-z]\w*", json.dumps(for_programs(text))))
    names |= {n + dots for n in list(names) for dots in ("_dot", "_dot_dot")}
    names |= {"q", "w", "f", "g", "u_0", "m_c", "m_h", "L", "lambda", "omega"}
    rng = np.random.default_rng(seed)
    return {n: float(rng.uniform(0.3, 0.7)) for n in sorted(names)} | {"L": 24.0}


def readable(text: str) -> dict[str, list]:
    """The values of all that can be read in a document: left side → right sides, in order."""
    values, found = numbers_for(text), {}
    for formula in formulas(for_readers(text)):
        if "aligned" not in formula and " = " not in formula:
            continue
        for left, right in equations(formula):
            for part in right.split(" = "):
                try:
                    read = value(part, values | resultants_in(text, values))
                except ValueError:
                    continue
                found.setdefault(left, []).append(read)
    return found


def resultants_in(text: str, values: dict) -> dict:
    names = re.findall(r"R_\{((?:[^{}]|\{[^{}]*\})*)\}", text)
    return {f"R_{name(n)}": 0.1 * k for k, n in enumerate(sorted(set(names)), 1) if n != "q_i"}


@pytest.mark.parametrize("document", PINNED)
def test_formulas_are_those_of_a_document_made_now(document, again):
    now = (again(document) / document).read_text(encoding="utf-8")
    old, new = readable(pinned(document)), readable(now)
    assert list(old) == list(new)
    assert len(old) > 8
    for left, parts in old.items():
        for a, b in zip(parts, new[left], strict=True):
            np.testing.assert_allclose(a, b, rtol=1e-12, err_msg=left)
    shown = [f for f in formulas(for_readers(now)) if r"\partial" in f]
    assert shown == [f for f in formulas(for_readers(pinned(document))) if r"\partial" in f]


@pytest.mark.parametrize("document", PINNED)
def test_pictures_show_the_same_symbols(document, again):
    picture = document.replace(".md", "_coordinates.svg")
    old, new = (
        re.findall(r"<!-- \$(.*?)\$ -->", (folder / picture).read_text(encoding="utf-8"))
        for folder in (FOLDER, again(document))
    )
    assert old == new
    assert len(old) > 6


# True: what is printed is what the engine has


@cache
def coach(segments: int):
    return derive_vehicle("cati2024", segments)


def system_of(document: str) -> Lagrangian:
    if document in HALVES:
        return half_body(HALVES[document])
    model = coach(COACHES[document])
    return model.body.energies if document in BODIES else model.lagrangian


def at(expression, values: dict) -> float:
    u = sp.sympify(expression)
    return float(u.xreplace({s: sp.Float(values[s.name]) for s in u.free_symbols}))


@pytest.mark.parametrize("document", COACHES)
def test_printed_energies_and_kinematics(document):
    text, system = pinned(document), system_of(document)
    values, shown = numbers_for(text), readable(text)
    energies = {"T": system.kinetic, "V": system.potential, "D": system.dissipation}
    for left, u in energies.items():
        (read,) = shown[left]
        assert read == pytest.approx(at(u, values), rel=1e-12), left
    by_name = {name(left): parts[0] for left, parts in shown.items()
               if re.fullmatch(r"\\?\w+_(\w|\{\w+\})", left)}  # fmt: skip
    for u, definition in system.kinematics.items():
        assert by_name[u.name] == pytest.approx(at(definition, values), rel=1e-12)


@pytest.mark.parametrize("document", COACHES)
def test_printed_equations_of_motion_are_lagranges(document):
    """Each printed sum, its resultants put in, against the equations with everything put in."""
    text, system = pinned(document), system_of(document)
    values = numbers_for(text)
    table = {s: sp.Float(v) for s, v in written(system, values).items()}
    values |= {s.name: float(v) for s, v in table.items()}
    nonlinear = for_readers(text).split("## Nonlinear")[1].split("## Equilibrium")[0]
    shown = [pair for f in formulas(nonlinear) for pair in equations(f)]
    for left, right in shown:
        if left.startswith("R_") and "\\partial" not in right:
            values[f"R_{name(left[3:-1])}"] = value(right, values)
    sums = [value(right, values) for left, right in shown if left == "0" and "sum" not in right]
    expected = [at(e, values) for e in system.equations()]
    np.testing.assert_allclose(sums, expected, rtol=1e-9, atol=1e-9)


def written(system: Lagrangian, values: dict) -> dict:
    """The named quantities, their rates and second rates, from those of coordinates and inputs."""
    from railride.lagrange import rate

    found = {}
    for u, definition in system.kinematics.items():
        for s, e in ((u, definition), (u.dot, rate(definition)), (u.ddot, rate(rate(definition)))):
            full = e.xreplace(found)
            found[s] = full.xreplace({x: sp.Float(values[x.name]) for x in full.free_symbols})
    return found


@pytest.mark.parametrize("document", COACHES)
def test_printed_matrices_are_the_models(document):
    """Blocks put together as printed, with the model's numbers, against its matrices."""
    text, model = pinned(document), coach(COACHES[document])
    section = for_readers(text).split("## Linear")[1].split("## Parameters")[0]
    values = {n: float(v) for n, v in model.values().items()} | {"c_theta": 1e5}
    left_over = [p for f in formulas(section) for p in equations(f)]
    while left_over:  # what is defined later may stand earlier
        later = []
        for left, right in left_over:
            try:
                read = value(right, values)
            except ValueError:
                later.append((left, right))
                continue
            if re.fullmatch(r"\w(_\w|_\{\w+\})?", left):
                values[name(left)] = read
        if len(later) == len(left_over):
            break
        left_over = later
    assert all(" + C " in left or "q" in left for left, _ in left_over), left_over
    if document in BODIES:
        linear = linearise(model.body.energies)
        expected = {n: at_all(linear.matrices[n], values) for n in "MCK"}
    else:
        numbers = model.matrices(c_theta=1e5) if COACHES[document] > 1 else model.matrices()
        expected = {n: getattr(numbers, n) for n in ("M", "C", "K", "K_w", "C_w", "B_f")}
    for letter, A in expected.items():
        if letter in ("K_w", "C_w"):  # a row of blocks that are 0 does not say how high it is
            above = np.zeros((len(A) - len(values[letter]), A.shape[1]))
            values[letter] = np.vstack([above, values[letter]])
        np.testing.assert_allclose(values[letter], A, rtol=1e-9, atol=1e-6, err_msg=letter)


def at_all(A, values: dict) -> np.ndarray:
    return np.array([[at(e, values) for e in row] for row in A.tolist()])


def test_products_of_gradients_are_printed_as_they_are():
    for document in ("vehicle_2.md", "vehicle_4.md"):
        model = coach(COACHES[document])
        values = {n: float(v) for n, v in model.values().items()}
        shown = [p for f in formulas(pinned(document)) for p in equations(f) if "h_" in p[0]]
        values |= {name(left): value(right, values) for left, right in shown if " " not in left}
        products = [p for p in shown if " " in p[0]]
        assert len(products) == 2
        for left, right in products:
            gradient, named = re.match(r"\\left\((h_\d) .*_\{(.*)\}", left).groups()
            h = values[gradient]
            places = [int(q.rpartition("_")[2]) for q in named.split(", ")]
            np.testing.assert_allclose(value(right, values), h[places] @ h[places].T, rtol=1e-12)
            assert np.count_nonzero(h) == len(places)


@pytest.mark.parametrize("document", COACHES)
def test_mathematics_for_programs_is_the_engines(document):
    text, model = pinned(document), coach(COACHES[document])
    system, found, values = system_of(document), for_programs(text), numbers_for(text)
    for letter, u in (("T", system.kinetic), ("V", system.potential), ("D", system.dissipation)):
        assert at(read(found[letter]), values) == pytest.approx(at(u, values), rel=1e-12)
    linear = linearise(system) if document in BODIES else model.linear
    for letter, A in linear.matrices.items():
        assert set(found[letter]) == {f"{i},{j}" for i, j in A.todok()}
        for place, entry in found[letter].items():
            i, j = map(int, place.split(","))
            assert at(read(entry), values) == pytest.approx(at(A[i, j], values), rel=1e-9)


def read(text: str):
    """An expression in sympy's words, every name in it a symbol."""
    names = set(re.findall(r"[A-Za-z]\w*", text)) - {"sin", "cos", "tan", "asin", "sqrt"}
    return sp.sympify(text, locals={n: sp.Symbol(n) for n in names})


# True: against figures that railride did not make


def test_undamped_frequencies_of_the_vehicle():
    """The figures of a nonlinear multibody program, rod segments, calibrated to 9.6 Hz."""
    expected = {
        "vehicle_1.md": "1.0191 1.2608 9.5313 9.5335 14.0674 14.0674",
        "vehicle_2.md": "1.0155 1.2868 9.4601 9.5338 9.7069 14.0674 14.0674",
        "vehicle_4.md": "1.0158 1.2868 9.4639 9.5338 9.6998 14.0674 14.0674 25.5051 41.9263",
    }
    for document, figures in expected.items():
        (line,) = re.findall(r"Undamped, from .*: (.*) Hz\.", pinned(document))
        assert line.split(", ") == figures.split()


def test_bending_frequencies_of_the_free_body():
    """Calibrated to 9.6 Hz; the beam's ratios are (β_i/β_1)² of 4.730041, 7.853205, 10.995608."""
    rows = re.findall(
        r"\| bending (\d) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|", pinned("body_4.md")
    )
    assert [row[0] for row in rows] == ["1", "2", "3"]
    for (_, hertz, ratio, beam), beta in zip(rows, (4.730041, 7.853205, 10.995608), strict=True):
        assert float(beam) == pytest.approx((beta / 4.730041) ** 2, abs=6e-5)
        assert float(hertz) / 9.6 == pytest.approx(float(ratio), abs=1e-4)
    (row,) = re.findall(r"\| bending 1 \| ([\d.]+) \|", pinned("body_2.md"))
    assert row == "9.6000"
    assert r"\omega^2 = \frac{192 k_\theta}{m_c L^2}" in pinned("body_2.md")


def test_segments_by_hand():
    """A quarter of the body: m = m_c/4, ℓ = L/4, m ℓ²/12."""
    assert (r"the mass $\frac{1}{4} m_c$, the length $\frac{1}{4} L$ and, about its middle, the "
            r"pitch inertia $\frac{1}{768} m_c L^2$") in pinned("body_4.md")  # fmt: skip


def test_preloads_by_hand():
    """Half the body on each bogie, a quarter of it and half a bogie on each axle; with the body
    cut at the middle, the joint carries the moment of one half about it.
    """
    g, m_c, m_b, L, l_b = 9.80665, 34e3, 3e3, 24.0, 8.75
    secondary, primary = m_c * g / 2, (m_c / 2 + m_b) * g / 2
    moment = secondary * (L / 4 - l_b)
    for document, joint in (("vehicle_1.md", False), ("vehicle_2.md", True)):
        text = pinned(document)
        assert re.search(rf"N_\{{s1\}}, N_\{{s2\}}\$ \|.*\| {secondary / 1e3:.2f} \| kN \|", text)
        assert re.search(rf"N_\{{p1\}}, .*\| {primary / 1e3:.2f} \| kN \|", text)
        found = re.search(rf"N_\{{\\theta, 1\}}\$ \|.*\| {moment / 1e3:.2f} \| kN m \|", text)
        assert bool(found) == joint


# The paper's two halves


def mathematics(text: str) -> dict:
    """The block for a program, its expressions read by sympy, each a polynomial in known names."""
    names = {s.name: s for s in (m_h, L_h, k_theta, theta, *rates)}

    def read_all(found):
        if isinstance(found, str):
            return sp.sympify(found, locals=names)
        if isinstance(found, list):
            return [read_all(v) for v in found]
        return {key: read_all(v) for key, v in found.items()}

    return {key: read_all(found) for key, found in for_programs(text).items()}


def with_plain_names(expression):
    """The engine's signals as the symbols that a text has for them."""
    return expression.xreplace({
        s: sp.Symbol(s.name, real=True) for s in expression.free_symbols if s.is_real
        and not s.is_positive
    })  # fmt: skip


def same(a, b) -> bool:
    return sp.simplify(sp.sympify(a) - sp.sympify(b)) == 0


@pytest.mark.parametrize(("document", "free"), HALVES.items())
def test_pinned_mathematics_is_what_the_engine_derives(document, free):
    found = mathematics(pinned(document))
    system: Lagrangian = half_body(free)
    assert same(found["T"], with_plain_names(system.kinetic))
    assert same(found["V"], with_plain_names(system.potential))
    assert found["D"] == 0
    assert same(found["equations"][0], with_plain_names(system.equations()[0]))
    for letter, A in linearise(system).matrices.items():
        assert set(found[letter]) == {f"{i},{j}" for i, j in A.todok()}
        for place, entry in found[letter].items():
            i, j = map(int, place.split(","))
            assert same(entry, A[i, j])


def test_paper_equations_by_hand():
    """Eqs (2), (3) and (4) as they are printed."""
    found = mathematics(pinned("half_body.md"))
    dot, ddot = rates
    inertia = m_h * L_h**2
    assert same(found["T"], inertia * dot**2 / 3 + inertia * dot**2 * sp.sin(theta) ** 2)
    assert same(found["V"], 2 * k_theta * theta**2)
    third = (2 * inertia / 3 + 2 * inertia * sp.sin(theta) ** 2) * ddot
    third += 2 * inertia * dot**2 * sp.sin(theta) * sp.cos(theta) + 4 * k_theta * theta
    assert same(found["equations"][0], third)
    assert same(found["omega_squared"], 6 * k_theta / inertia)


def test_free_body_by_hand():
    """Only rotation in the linear motion: T = I_h θ̇², so that ω² = 24 k_θ/(m_h L_h²)."""
    found = mathematics(pinned("half_body_free.md"))
    assert same(found["omega_squared"], 24 * k_theta / (m_h * L_h**2))
    assert same(found["M"]["0,0"], 2 * m_h * L_h**2 / 12)


def test_weight_of_the_two_halves_by_hand():
    """Held at its ends, each half weighs m_h g at height ½ L_h sin θ: its moment is ½ m_h g L_h."""
    assert r"N_\theta = \frac{1}{2} g m_h L_h$" in pinned("half_body.md")
    assert "Gravity does no work here" in pinned("half_body_free.md")


def test_frequencies_against_the_print():
    """4.79 and 9.586 Hz by hand; between them a factor 4 in stiffness."""
    text = pinned("half_body.md")
    assert "| ends held, the paper's Eq (4) | " in text
    held, free = re.findall(r"\| (\d\.\d{3}) \| \d+\.\d % \|", text)
    by_hand = (3.7e8 / (17_000 * 12**2)) ** 0.5 / (2 * sp.pi)
    assert float(held) == pytest.approx(float(6**0.5 * by_hand), abs=5e-4)
    assert float(free) == pytest.approx(float(24**0.5 * by_hand), abs=5e-4)
    assert "a factor of 4 in stiffness, 2 in frequency" in text


# The comparison can fail


def test_a_changed_equation_is_noticed():
    """2 for 2/3 in the printed inertia; a sign, a factor and an entry in what readers see."""
    text = pinned("half_body.md")
    changed = text.replace('"2*L_h**2*m_h/3"', '"2*L_h**2*m_h"')
    assert changed != text
    assert not same(mathematics(changed)["M"]["0,0"], linearise(half_body()).M[0, 0])
    text = pinned("vehicle_4.md")
    for old, new, left in ((r"\frac{1}{2} k_2", r"\frac{1}{3} k_2", "V"),
                           ("+ l_w \\sin", "- l_w \\sin", "p_1"),
                           ("6 & -4", "6 & 4", "K_f")):  # fmt: skip
        changed = text.replace(old, new)
        assert changed != text
        a, b = readable(text)[left], readable(changed)[left]
        assert not np.allclose(a, b), left


def test_figures_differ_by_rounding_alone():
    assert same_number("9.5919", "9.5920")
    assert not same_number("9.5919", "9.5921")
    assert not same_number("heave", "pitch")


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no LaTeX on this machine")
@pytest.mark.parametrize("words", ["--system half-body", "--segments 2 --nonlinear"])
def test_articles_compile(words, tmp_path, run):
    article = tmp_path / "an article.tex"
    code, _, err = run("derive", *words.split(), "--format", "latex", "--output", article)
    assert code == 0, err
    done = subprocess.run(  # noqa: S603
        ["pdflatex",  # noqa: S607
          "-interaction=nonstopmode", "-halt-on-error", article.name],
        cwd=tmp_path, capture_output=True, text=True, check=False, errors="replace",
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]
    assert "Overfull \\hbox" not in done.stdout


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="no LaTeX on this machine")
def test_mathematics_of_all_documents_is_latex(tmp_path):
    """Every formula, displayed and inline, of every Markdown document here, in one article."""
    lines = [r"\documentclass{article}", r"\usepackage{amsmath}", r"\begin{document}"]
    for path in sorted(FOLDER.glob("*.md")):
        text = re.sub(r"^```.*?^```$", "", path.read_text(encoding="utf-8"),
                      flags=re.DOTALL | re.MULTILINE)  # fmt: skip
        displayed = re.findall(r"^\$\$\n(.*?)\n\$\$$", text, flags=re.DOTALL | re.MULTILINE)
        rest = re.sub(r"^\$\$\n.*?\n\$\$$", "", text, flags=re.DOTALL | re.MULTILINE)
        assert rest.count("$") % 2 == 0, path.name
        inline = re.findall(r"\$([^$\n]+)\$", rest)
        lines += [rf"\[{formula}\]" for formula in displayed]
        lines += [f"${formula}$\n" for formula in inline]
    assert len(lines) > 500
    article = tmp_path / "all.tex"
    article.write_text("\n".join([*lines, r"\end{document}"]), encoding="utf-8")
    done = subprocess.run(  # noqa: S603
        ["pdflatex", "-interaction=nonstopmode", "-halt-on-error", article.name],  # noqa: S607
        cwd=tmp_path, capture_output=True, text=True, check=False, errors="replace",
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-2000:]
