"""The README: its Python runs as it stands, and its commands exist."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import matplotlib as mpl
import pytest
from matplotlib import pyplot as plt

import railride

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", README, flags=re.MULTILINE | re.DOTALL)


def test_python_examples_run_one_after_another(tmp_path, monkeypatch):
    """In one session, as a reader would type them."""
    mpl.use("Agg")
    monkeypatch.chdir(tmp_path)
    session: dict[str, object] = {}
    assert len(blocks("python")) >= 3
    for k, source in enumerate(blocks("python"), start=1):
        exec(compile(source, f"README.md, Python block {k}", "exec"), session)  # noqa: S102
    plt.close("all")
    assert list(tmp_path.iterdir()) == []


def test_the_names_in_the_table_are_public():
    table = README.split("| name | what it is |\n|---|---|\n")[1].split("\n\n")[0]
    first = " ".join(row.split("|")[1] for row in table.splitlines())
    names = re.findall("`(.+?)`", first)
    assert len(names) >= 80
    assert [name for name in names if name not in railride.__all__] == []


def test_the_ride_that_is_shown_is_what_is_printed(run):
    code, out, _ = run("ride")
    (shown,) = (block for block in blocks("text") if block.startswith("cati2024"))
    error = re.compile(r"relative error at most \S+")  # rounding, which differs between machines
    assert code == 0
    assert error.sub("", shown) == error.sub("", out)


COMMANDS = [line for block in blocks("sh") for line in block.splitlines()
            if line.startswith(("railride ", "python -m railride.derive"))]  # fmt: skip


def test_commands_are_shown():
    shown = {shlex.split(line)[1] for line in COMMANDS if line.startswith("railride")}
    assert shown >= {"bode", "map", "modes", "ride", "track"}


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_run(line, run, tmp_path, monkeypatch):
    """Each as it is printed, in an empty folder; only what takes long is made shorter."""
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{k / 200},{(k % 17 - 8) / 20}\n" for k in range(4000))
    (tmp_path / "floor.csv").write_text("time_s,z\n" + rows, encoding="utf-8")
    words = shlex.split(line, comments=True)
    words = words[1:] if words[0] == "railride" else ["derive", *words[3:]]
    code, out, err = run(*words, *SHORTER.get(words[0], ()))
    assert code == 0, err
    assert out or Path(words[words.index("--output") + 1]).stat().st_size > 0


SHORTER = {"map": ("--segments", "1")}
