"""The README's table of measurements is what was measured, and the guard tells what has grown."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def benchmarks(monkeypatch):
    """The folder's files can be imported, and are forgotten afterwards."""
    before = set(sys.modules)
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    yield
    for name in {path.stem for path in (ROOT / "benchmarks").glob("*.py")} - before:
        sys.modules.pop(name, None)


@pytest.fixture
def report(benchmarks):
    import report

    return report


@pytest.fixture
def guard(benchmarks):
    import guard

    return guard


def test_the_readme_shows_what_was_measured(report):
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert report.written_into(text, report.table(report.read())) == text
    assert text.count(report.START) == text.count(report.END) == 1


def test_every_row_has_been_measured(report):
    entries = report.read()
    assert [name for name in report.ROWS if name not in entries] == []
    assert {"growth-derive", "growth-numbers"} <= set(entries)


def test_a_changed_measurement_changes_the_table(report):
    entries = report.read()
    slower = {**entries["ride-control"], "railride_s": 1.5}
    assert "1.5 s" in report.table({**entries, "ride-control": slower})


def test_the_picture_can_be_drawn(report, tmp_path):
    report.draw(report.read(), tmp_path / "benchmarks.png")
    assert (tmp_path / "benchmarks.png").read_bytes().startswith(b"\x89PNG")


def growth(guard, now, kept):
    return {name: times for name, *_, times in guard.compared(now, kept)}


def test_the_guard_keeps_every_work(guard):
    kept = json.loads(guard.KEPT.read_text(encoding="utf-8"))
    now = {name: 2 * value for name, value in kept["instructions"].items()}
    assert set(guard.PEER_OF) | set(guard.PEER_OF.values()) == set(now)
    assert set(growth(guard, now, kept | {"versions": guard._libraries()}).values()) == {2.0}


def test_the_guard_compares_with_peers_where_libraries_differ(guard):
    kept = json.loads(guard.KEPT.read_text(encoding="utf-8")) | {"versions": {}}
    now = {name: 2 * value for name, value in kept["instructions"].items()}
    found = growth(guard, now | {"ride": now["ride"] * 3}, kept)
    assert found.pop("ride / ride, scipy") == pytest.approx(3.0)
    assert list(found.values()) == pytest.approx([1.0] * len(found))
