"""Every notebook runs from scratch, and is committed as it ran."""

import os
import re
import sys
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

import railride

FOLDER = Path(__file__).parent.parent / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
USUAL = {"railride", "numpy", "scipy", "pandas", "sympy", "matplotlib", "control", "IPython"}
SECONDS_PER_CELL = 300  # a notebook that hangs must end; it is no measure of speed


def read(path: Path) -> nbformat.NotebookNode:
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    return notebook


def code_cells(notebook):
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def in_text(notebook) -> list[str]:
    """What the cells print as running text: every number that a reader is told."""
    return [
        output["data"]["text/markdown"]
        for cell in code_cells(notebook)
        for output in cell.outputs
        if "text/markdown" in output.get("data", {})
    ]


@pytest.fixture
def run(tmp_path, monkeypatch):
    """Executes a notebook in an empty folder, against the railride under test."""
    source = str(Path(railride.__file__).parents[1])
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([source, os.environ.get("PYTHONPATH", "")]))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    folder = tmp_path / "work"
    folder.mkdir()

    def execute(notebook):
        for cell in code_cells(notebook):
            cell.outputs, cell.execution_count = [], None
        client = NotebookClient(notebook, timeout=SECONDS_PER_CELL, kernel_name="python3",
                                resources={"metadata": {"path": str(folder)}})  # fmt: skip
        return client.execute()

    return execute


def test_all_six_are_here():
    assert [path.stem[:2] for path in NOTEBOOKS] == ["01", "02", "03", "04", "05", "06"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_only_railride_and_the_usual_libraries_are_imported(path):
    """What a reader has: no helper of ours beside the package."""
    source = "\n".join(cell.source for cell in code_cells(read(path)))
    found = re.findall(r"^\s*(?:import|from)\s+(\w+)", source, re.MULTILINE)
    assert "railride" in found
    assert set(found) - sys.stdlib_module_names <= USUAL


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs_and_says_what_it_said(path, run):
    """No cell fails, and every number in the running text is the committed one."""
    committed = in_text(read(path))
    assert in_text(run(read(path))) == committed


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_is_committed_as_it_ran(path):
    cells = code_cells(read(path))
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell.outputs]
    assert {output.output_type for output in outputs} <= {"execute_result", "display_data"}
    kinds = {kind for output in outputs for kind in output.data}
    assert {"text/latex", "text/markdown", "image/png"} <= kinds


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_holds_nothing_of_the_machine(path):
    text = path.read_text(encoding="utf-8")
    assert not re.search(r'"(?:/home/|/tmp/|/root/|/Users/|[A-Z]:\\\\)', text)
    notebook = read(path)
    assert notebook.metadata.kernelspec.name == "python3"
    assert not any(cell.metadata for cell in notebook.cells)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_prose_tells_no_result(path):
    """A decimal number in the prose would not follow the code: results come from cells."""
    for cell in read(path).cells:
        if cell.cell_type == "markdown":
            prose = re.sub(r"\[[^]]*\]\([^)]*\)", "", cell.source)  # without links
            assert not re.findall(r"\d\.\d", prose)


def test_the_paper_and_the_free_body_in_the_derivation():
    text = "\n".join(in_text(read(FOLDER / "01_the_papers_derivation.ipynb")))
    assert "**4.79 Hz**; printed are 9.6 Hz" in text
    assert "**9.586 Hz**" in text
    assert "is 4 times that of Eq (4)" in text


def test_checked_values_from_two_halves_to_the_beam():
    """Order and errors of free-free chains, exact values: each of independent programs."""
    text = "\n".join(in_text(read(FOLDER / "02_from_two_halves_to_the_beam.ipynb")))
    assert "order 4.1, 4.2, 4.2 for rods and 2.0, 2.0, 2.1 for masses in the middles" in text
    assert "first bending frequency to 0.3% and the second to 3.9%" in text
    assert "- 2 segments: polygon 0.2475 m/s² (+38.9%)" in text
    assert "- 3 segments: polygon 0.1485 m/s² (-16.6%)" in text
    assert "(as the paper), 200 km/h: from 0.3275 to 0.2192 m/s²" in text


def test_checked_values_of_ride_and_comfort():
    """Exact values of independent programs; quiet speeds by hand, 9.59 Hz · 17.5 m/(k + 1/2)."""
    text = "\n".join(in_text(read(FOLDER / "03_ride_and_comfort.ipynb")))
    assert "- rigid: exact 0.0494 m/s²" in text
    assert "the rigid one's by 0.78% and 0.66%" in text
    for k, at in ((4, "134"), (3, "173"), (2, "242")):
        assert f"quiet, k = {k}: expected at {at} km/h" in text
    assert "wheelbase has its own zero at 173 km/h" in text


def test_checked_values_of_the_frequency_response():
    """Zeros by hand, (k + 1/2) 55.56/17.5 and /2.5 Hz; exact values of independent programs."""
    text = "\n".join(in_text(read(FOLDER / "04_frequency_response.ipynb")))
    assert "at 1.587, 4.762, 7.937 Hz …, of the 2.5 m wheelbase at 11.11 Hz" in text
    assert "- rigid body: 0.0756 m/s²" in text
    assert "- 4 segments: 0.2408 m/s²" in text
    assert "- skyhook, ideal: 0.169 m/s²" in text


def test_what_was_put_in_is_found_with_an_own_vehicle_and_track():
    """The spectrum that the track was made from, the dip in it, and the ride in the record."""
    text = "\n".join(in_text(read(FOLDER / "06_your_own_vehicle_and_track.ipynb")))
    assert "closest to `erri_high`, with 0.6 dB of misfit and 1.00 times its level" in text
    (worst,) = re.findall(r"- middle: at kilometre (\S+)", text)
    assert 0 < float(worst) - 19.7 < (160 / 3.6 + 13) / 1000  # a second, and half the car
    found, true = re.findall(r"The record gives (\S+) m/s², the ride had (\S+) m/s²", text)[0]
    assert found == true


def test_checked_values_of_the_design_study():
    """The spring by hand, (34 + 4) t g/2/280 mm = 665.5 kN/m, on the grid the next of 20 kN/m."""
    text = "\n".join(in_text(read(FOLDER / "05_a_suspension_design_study.ipynb")))
    assert "2,706 designs of 2,706 in 3 parts, 0 of them without values" in text
    assert "The best of them has 680 kN/m and 38 kN s/m" in text
    assert "The secondary spring ends at 665 kN/m" in text


def test_a_failing_cell_fails_the_run(run):
    notebook = nbformat.v4.new_notebook(
        cells=[nbformat.v4.new_code_cell("1 / 0")],
        metadata={"kernelspec": {"name": "python3", "display_name": "Python 3"}},
    )
    with pytest.raises(CellExecutionError, match="ZeroDivisionError"):
        run(notebook)
