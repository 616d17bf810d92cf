"""The README's table of measurements is what was measured."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture
def report(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    import report

    yield report
    for name in ("report", "measure"):
        sys.modules.pop(name, None)


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
