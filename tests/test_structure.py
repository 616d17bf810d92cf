"""The shape of the package: one way along the pipeline, light to import, documented."""

from __future__ import annotations

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import railride
import railride.plots

SOURCE = Path(railride.__file__).parent

# From the parts that know nothing of the rest to those that use everything.
ORDER = """
errors files units tables toml_tables quantities
body_profile body_segments body_sources body_checks car_body vehicle_data
record_tables body_tables parameters
lagrange resultants jets linear halfbody numeric
plausibility bodies carried running_gear parameter_values vehicle preloads
firstorder naming modal loci statespace spectra frequency bodes
track trackfile response nonlinear weightings scales comfort records stochastic
timerun ridden rides active
comparison
designs
distributions
changed_vehicle
sensitivities
studies
sweeps
optimisation
uncertainties
markup text report halfbody_report exports plots cli derive __main__
""".split()


def modules():
    """Name along the pipeline → its files: a folder is one stage."""
    found = {}
    for path in sorted(SOURCE.rglob("*.py")):
        parts = path.relative_to(SOURCE).with_suffix("").parts
        if parts != ("__init__",):
            found.setdefault(parts[0], []).append(path)
    return found


def imported(path):
    """Modules of the package that a file imports, wherever in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "railride":
            stages = node.module.split(".")[1:2] or [alias.name for alias in node.names]
            names.update(stages)
        elif isinstance(node, ast.ImportFrom) and node.level:
            names.add(f"relative import in {path.name}")
        elif isinstance(node, ast.Import):
            names.update(a.name.split(".")[1] for a in node.names if a.name.startswith("railride."))
    return names


def test_every_module_has_its_place():
    assert sorted(modules()) == sorted(ORDER)


@pytest.mark.parametrize("stage", ORDER)
def test_imports_point_one_way_along_the_pipeline(stage):
    allowed = set(ORDER[: ORDER.index(stage) + 1]) | {"__version__", "KMH"}
    for path in modules()[stage]:
        assert imported(path) <= allowed, path.name


HEAVY = {"sympy", "numpy", "scipy", "control", "pandas", "pint", "matplotlib", "typer", "rich"}


SCIPY = {f"scipy.{part}" for part in ("fft", "integrate", "linalg", "interpolate", "signal")}


def loaded_after(code):
    """Heavy libraries that a fresh interpreter has loaded after running ``code``."""
    tell = f"import sys; print(*sorted({HEAVY | SCIPY!r} & set(sys.modules)))"
    command = [sys.executable, "-c", f"{code}\n{tell}"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)  # noqa: S603
    return set(done.stdout.splitlines()[-1].split())


def test_importing_railride_loads_nothing():
    assert loaded_after("import railride; railride.__version__; dir(railride)") == set()


def test_deriving_loads_neither_scipy_nor_plots():
    code = (
        "import railride as rr; m = rr.derive_vehicle(rr.load_vehicle('cati2024'), 2); m.linear; "
        "m.matrices()"
    )
    loaded = loaded_after(code)
    assert loaded & (SCIPY | {"control", "pandas", "matplotlib", "typer"}) == set()
    assert "sympy" in loaded


@pytest.mark.parametrize("name", railride.__all__)
def test_public_names_resolve_and_are_documented(name):
    found = getattr(railride, name)
    if name not in {"__version__", "KMH"}:
        assert inspect.getdoc(found)
        own = inspect.getdoc(found).splitlines()[0]
        assert own.strip()
    assert name in dir(railride)


def test_no_public_name_is_a_module():
    """Once loaded, the module would be found under the name in its place."""
    assert set(railride.__all__) & set(modules()) == set()


def test_every_picture_is_at_hand():
    drawing = {name for name in railride.plots.__all__ if name.startswith(("plot_", "animate_"))}
    assert drawing <= set(railride.__all__)


def test_unknown_names_are_attribute_errors():
    with pytest.raises(AttributeError, match="bogey"):
        _ = railride.bogey


SELF_EVIDENT = {"model", "vehicle", "system", "result", "track", "weighting", "ax"}


def public_functions():
    for name in railride.__all__:
        found = getattr(railride, name)
        if inspect.isfunction(found):
            yield pytest.param(found, id=name)


@pytest.mark.parametrize("function", list(public_functions()))
def test_every_argument_of_a_public_function_is_documented(function):
    text = inspect.getdoc(function)
    for argument in inspect.signature(function).parameters.values():
        if argument.kind is not argument.VAR_KEYWORD:
            name = argument.name
            # Those whose type says it all.
            assert name in text or name in SELF_EVIDENT, name


def test_no_module_prints_or_asserts_on_what_the_user_gave():
    for paths in modules().values():
        for path in paths:
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                assert not isinstance(node, ast.Assert), path.name
                is_print = isinstance(node, ast.Call) and getattr(node.func, "id", "") == "print"
                assert not is_print, path.name
