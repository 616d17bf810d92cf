"""The pinned derivations are what the program derives now, compared by value."""

import json
import re
from pathlib import Path

import pytest
import sympy as sp

from railride.halfbody import half_body, k_theta, m_h
from railride.halfbody_report import half_body_document
from railride.lagrange import Lagrangian
from railride.linear import linearise
from railride.markup import markdown

FOLDER = Path(__file__).parent.parent / "derivations"
PINNED = {"half_body.md": False, "half_body_free.md": True}

L_h, theta = sp.Symbol("L_h", positive=True), sp.Symbol("theta", real=True)
rates = [sp.Symbol(f"theta{dots}", real=True) for dots in ("_dot", "_dot_dot")]


def mathematics(text: str) -> dict:
    """The block for a program, its expressions read by sympy, each a polynomial in known names."""
    (block,) = re.findall(r"```json\n(.*?)\n```", text, flags=re.DOTALL)
    names = {s.name: s for s in (m_h, L_h, k_theta, theta, *rates)}

    def read(value):
        if isinstance(value, str):
            return sp.sympify(value, locals=names)
        if isinstance(value, list):
            return [read(v) for v in value]
        return {key: read(v) for key, v in value.items()}

    return {key: read(value) for key, value in json.loads(block).items()}


def with_plain_names(expression):
    """The engine's signals as the symbols that a text has for them."""
    return expression.xreplace({
        s: sp.Symbol(s.name, real=True) for s in expression.free_symbols if s.is_real
        and not s.is_positive
    })  # fmt: skip


def same(a, b) -> bool:
    return sp.simplify(sp.sympify(a) - sp.sympify(b)) == 0


def test_each_document_is_pinned():
    assert {path.name for path in FOLDER.glob("*.md")} >= set(PINNED)


@pytest.mark.parametrize(("name", "free"), PINNED.items())
def test_pinned_mathematics_is_what_the_engine_derives(name, free):
    found = mathematics((FOLDER / name).read_text(encoding="utf-8"))
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


@pytest.mark.parametrize(("name", "free"), PINNED.items())
def test_pinned_document_reads_as_one_made_now(name, free):
    """The part for readers, word by word; sympy may spell the part for programs differently."""
    pinned = (FOLDER / name).read_text(encoding="utf-8")
    now = half_body_document(free, "markdown")
    assert pinned.split("```json")[0].split() == now.split("```json")[0].split()


def test_paper_equations_by_hand():
    """Eqs (2), (3) and (4) as they are printed."""
    found = mathematics((FOLDER / "half_body.md").read_text(encoding="utf-8"))
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
    found = mathematics((FOLDER / "half_body_free.md").read_text(encoding="utf-8"))
    assert same(found["omega_squared"], 24 * k_theta / (m_h * L_h**2))
    assert same(found["M"]["0,0"], 2 * m_h * L_h**2 / 12)


def test_frequencies_against_the_print():
    """4.79 and 9.586 Hz by hand; between them a factor 4 in stiffness."""
    text = (FOLDER / "half_body.md").read_text(encoding="utf-8")
    assert "| ends held, the paper's Eq (4) | " in text
    held, free = re.findall(r"\| (\d\.\d{3}) \| \d+\.\d % \|", text)
    by_hand = (3.7e8 / (17_000 * 12**2)) ** 0.5 / (2 * sp.pi)
    assert float(held) == pytest.approx(float(6**0.5 * by_hand), abs=5e-4)
    assert float(free) == pytest.approx(float(24**0.5 * by_hand), abs=5e-4)
    assert "a factor of 4 in stiffness, 2 in frequency" in text


def test_a_changed_equation_is_noticed():
    """The comparison by value can fail: 2 for 2/3 in the printed inertia."""
    text = (FOLDER / "half_body.md").read_text(encoding="utf-8")
    changed = text.replace('"2*L_h**2*m_h/3"', '"2*L_h**2*m_h"')
    assert changed != text
    assert not same(mathematics(changed)["M"]["0,0"], linearise(half_body()).M[0, 0])


def test_documents_name_their_command():
    for name, system in (("half_body.md", "half-body"), ("half_body_free.md", "half-body-free")):
        text = (FOLDER / name).read_text(encoding="utf-8")
        assert f"Made by `railride derive --system {system} --format markdown`" in text


def test_the_renderer_ends_with_one_newline():
    assert markdown([]).endswith("\n")
    assert half_body_document(False, "markdown").endswith("```\n")
