"""The documentation site: nothing public, no command and no key is missing, links lead somewhere.

``make docs`` builds it, without warnings; here is what can be told without.
"""

from __future__ import annotations

import doctest
import inspect
import json
import re
import sys
from collections import defaultdict
from dataclasses import fields
from itertools import pairwise
from pathlib import Path

import pytest
from markdown_it import MarkdownIt

import railride
from railride.cli import COMMANDS
from railride.optimisation.study import read_task
from railride.parameters import (
    Bogie,
    CarBody,
    Elements,
    Equipment,
    Load,
    ModeFiles,
    PointMass,
    Segment,
    Vehicle,
    load_vehicle,
    shipped_vehicles,
)
from railride.studies.read import SECTIONS
from railride.sweeps.settings import read_sweep_study
from railride.toml_tables import Table
from railride.uncertainties.study import read_uncertainty

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
sys.path.insert(0, str(DOCS / "extensions"))

import command_line  # noqa: E402
import docstrings  # noqa: E402

PAGES = sorted([*DOCS.rglob("*.md"), *ROOT.glob("derivations/*.md"), *ROOT.glob("*.md")])
NOTEBOOKS = sorted(ROOT.glob("notebooks/*.ipynb"))
TOPICS = sorted(p for p in DOCS.glob("theory/*.md") if p.stem not in {"index", "conventions"})


def text_of(path):
    """The Markdown of a page or of a notebook."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".ipynb":
        cells = json.loads(text)["cells"]
        return "\n\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    return text


def tokens(text):
    """All tokens of a Markdown text, those within lines too."""
    for token in MarkdownIt("gfm-like", {"linkify": False}).parse(text):
        yield token
        yield from token.children or ()


def test_every_public_name_stands_on_one_page_of_the_api():
    pages = "\n".join(path.read_text(encoding="utf-8") for path in DOCS.glob("api/*.md"))
    named = re.findall(r"^\.\. auto(?:function|class|exception|data):: (\w+)$", pages, re.MULTILINE)
    assert sorted(named) == sorted(railride.__all__)


def documented():
    """Public functions and records."""
    for name in railride.__all__:
        found = getattr(railride, name)
        if inspect.isfunction(found) or inspect.isclass(found):
            yield pytest.param(found, id=name)


@pytest.mark.parametrize("found", list(documented()))
def test_what_a_docstring_says_of_arguments_becomes_a_list(found):
    text, known = inspect.getdoc(found), docstrings.arguments(found)
    made = docstrings.readable(text, known)
    assert "\n---" not in made
    listed = {name for line in re.findall(r"^    - (\*\*.*?\*\*) – ", made, re.MULTILINE)
              for name in re.findall(r"\*\*(.*?)\*\*", line)}  # fmt: skip
    said = {name for name in known if re.search(rf"(?m)^{name} ?: |^``{name}``: ", text)}
    assert said <= listed


def test_sentences_are_no_arguments():
    made = docstrings.readable("Of two, one.\n\na : m, 2 : 1 at most. b : s.", {"a", "b"})
    assert made.splitlines()[-2:] == ["    - **a** – m, 2 : 1 at most.", "    - **b** – s."]
    assert docstrings.readable("|H| over ``|f|``.", set()) == r"\|H\| over ``|f|``."


@pytest.mark.parametrize("name", list(COMMANDS))
def test_every_option_stands_on_the_page_of_commands(name):
    sections = dict(re.findall(r"^## railride (\w+)\n(.*?)(?=^## |\Z)", command_line.sections(),
                               re.MULTILINE | re.DOTALL))  # fmt: skip
    rows = re.findall(r"^\| `(.*?)` \|", sections[name], re.MULTILINE)
    written = {option for row in rows for option in re.findall(r"--[a-z-]+", row)}
    for argument in inspect.signature(COMMANDS[name], eval_str=True).parameters.values():
        option = argument.annotation.__metadata__[0]
        if type(option).__name__ == "ArgumentInfo":
            assert (option.metavar or argument.name.upper()) in rows
        else:  # the first of its names is kept as a default until typer sees it
            names = {name for name in (option.default, *(option.param_decls or ()))
                     if isinstance(name, str) and name.startswith("--")}  # fmt: skip
            assert (names or {"--" + argument.name.replace("_", "-")}) <= written


COMMENTARY = {"note", "notes", "source"}  # in any table: said once, in a sentence


def keys_on(page):
    """What stands as code in a page's headings and in the first column of its tables."""
    blocks = [token for token in tokens(page.read_text(encoding="utf-8")) if token.block]
    cells = [cell for row, _, cell in zip(blocks, blocks[1:], blocks[2:], strict=False)
             if row.type == "tr_open"]  # fmt: skip
    cells += [text for heading, text in pairwise(blocks) if heading.type == "heading_open"]
    words = (t.content for cell in cells for t in cell.children if t.type == "code_inline")
    return {word for content in words for word in re.split(r"[\s\[\].]+", content)}


@pytest.fixture
def asked(monkeypatch):
    """The keys that readers ask for, by the folder of their files."""
    found = defaultdict(set)
    take = Table._take

    def noting(self, name):
        found[Path(self.faults.source).parent.name].add(name)
        return take(self, name)

    monkeypatch.setattr(Table, "_take", noting)
    return found


RECORDS = (
    Bogie, CarBody, Elements, Equipment, Load, ModeFiles, PointMass, Segment, Vehicle,
    railride.BodyProfile,
)  # fmt: skip


def test_every_key_of_parameter_files_stands_on_their_page(asked):
    for name in shipped_vehicles():
        load_vehicle(name)
    keys = asked["vehicles"] | {field.name for record in RECORDS for field in fields(record)}
    keys -= {"mode_files"}  # [body.modes] in a file
    assert keys - COMMENTARY - keys_on(DOCS / "parameter-files.md") == set()


def test_every_key_of_study_files_stands_on_their_page(asked):
    readers = {"sweep": read_sweep_study, "optimise": read_task, "pareto": read_task}
    for name in railride.shipped_studies():
        reader = readers.get(name.split("_")[0])
        if reader:
            reader(name)
        else:
            railride.read_study(name, {"uncertainty": read_uncertainty})
    assert set(SECTIONS) <= asked["studies"]
    labels = {"heave", "pitch"}  # of modes, in limits on their damping ratios
    assert asked["studies"] - labels - COMMENTARY - keys_on(DOCS / "study-files.md") == set()


def slugs(path):
    """What links to the headings of a page end in, as code hosts make it."""
    found = list(tokens(text_of(path)))
    headings = [b.content for a, b in pairwise(found) if a.type == "heading_open"]
    return {re.sub(r"[^\w\- ]", "", h.lower()).replace(" ", "-") for h in headings}


@pytest.mark.parametrize("path", [*PAGES, *NOTEBOOKS], ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(path):
    links = [t.attrs.get("href") or t.attrs.get("src") for t in tokens(text_of(path))
             if t.type in {"link_open", "image"}]  # fmt: skip
    for link in links:
        if not re.match(r"https?:|mailto:|data:|attachment:", link):
            file, _, heading = link.partition("#")
            target = (path.parent / file).resolve() if file else path
            assert target.exists(), link
            assert not heading or heading in slugs(target), link


@pytest.mark.parametrize("path", TOPICS, ids=lambda p: p.stem)
def test_theory_has_sources_and_leads_to_python_and_to_a_notebook_or_derivation(path):
    text = path.read_text(encoding="utf-8")
    assert "{cite}" in text
    assert re.search(r"\.\./\.\./(notebooks|derivations)/", text)
    for name in re.findall(r"{py:\w+}`[\w. ]+<railride\.(\w+)(?:\.\w+)?>`", text):
        assert name in railride.__all__
    assert "<railride." in text


def test_references_are_those_that_are_cited():
    pages = "\n".join(path.read_text(encoding="utf-8") for path in DOCS.rglob("*.md"))
    cited = {key for keys in re.findall(r"{cite}`([^`]+)`", pages) for key in keys.split(",")}
    known = re.findall(r"^@\w+{(\w+),", (DOCS / "references.bib").read_text("utf-8"), re.MULTILINE)
    assert sorted(known) == sorted(cited)


EXAMPLES = [path for path in sorted(DOCS.rglob("*.md")) if ">>> " in path.read_text("utf-8")]


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_examples_of_the_pages_run(path):
    blocks = [t.content for t in tokens(text_of(path)) if t.type == "fence" and t.info == "python"]
    examples = doctest.DocTestParser().get_doctest("\n".join(blocks), {}, path.stem, str(path), 0)
    assert examples.examples
    assert doctest.DocTestRunner().run(examples).failed == 0
