"""Exports in numbers, read back by the libraries whose formats they are."""

from __future__ import annotations

import io
import shutil
import subprocess

import export_cases
import numpy as np
import pytest
from scipy.io import loadmat
from vehicles import paper_coach, random_model

from railride.exports import source
from railride.exports.as_matlab import NAMES
from railride.exports.content import content_of
from railride.exports.write import export_content, export_model

AXES = {"M": ("coordinates", "coordinates"), "C": ("coordinates", "coordinates"),
        "K": ("coordinates", "coordinates"), "K_w": ("coordinates", "elevations"),
        "C_w": ("coordinates", "elevations"), "B_f": ("coordinates", "forces"),
        "Y_a": ("outputs", "coordinates"), "Y_v": ("outputs", "coordinates"),
        "Y_d": ("outputs", "coordinates"), "Y_w": ("outputs", "elevations"),
        "Y_dw": ("outputs", "elevations"), "Y_f": ("outputs", "forces"),
        "A": ("states", "states"), "B": ("states", "inputs"),
        "C_ss": ("outputs", "states"), "D_ss": ("outputs", "inputs")}  # fmt: skip


def npz(content):
    return dict(np.load(io.BytesIO(export_content(content, "npz"))))


def matlab(content):
    return loadmat(io.BytesIO(export_content(content, "matlab")), simplify_cells=True)


@pytest.fixture(params=["coach", "unlike"])
def content(request):
    model = paper_coach(2) if request.param == "coach" else random_model(3, 3)
    return content_of(model, at=[0.0, 2.5])


@pytest.mark.parametrize("read", [npz, matlab])
def test_every_matrix_comes_back_with_names_along_its_axes(content, read):
    found, model = read(content), content.model
    for name, axes in AXES.items():
        assert found[name].shape == tuple(len(found[axis]) for axis in axes), name
    for name, A in model.matrices().by_name.items():
        assert np.array_equal(found[name], A), name
    assert list(found["coordinates"]) == [q.name for q in model.linear.coordinates]
    assert list(found["outputs"])[:2] == ["floor_acceleration", "floor_acceleration_2_5m_ahead"]
    assert len(found["input_units"]) == len(found["inputs"])
    assert list(found["state_units"][-2:]) == ["m/s", "rad/s"]
    assert list(found["rates"]) == [f"d{name}" for name in found["elevations"]]
    for one in ("coordinate", "elevation", "rate", "force", "input", "output"):
        assert len(found[f"{one}_meanings"]) == len(found[f"{one}s"]) == len(found[f"{one}_units"])
    assert found["force_meanings"][1] == "actuator over bogie 2, positive when it pushes apart"
    assert list(found["origin"]) == source.origin(content)


def test_an_archive_holds_these_and_no_more(content):
    texts = [f"{one}{kind}" for one in ("coordinate", "elevation", "rate", "force", "input",
             "output", "parameter") for kind in ("s", "_units", "_meanings")]  # fmt: skip
    rest = ["states", "state_units", "parameter_values", "parameter_kinds", "origin", "vehicle"]
    assert npz(content).keys() == {*AXES, *texts, *rest}


@pytest.mark.parametrize("read", [npz, matlab])
def test_equations_and_state_space_say_the_same(content, read):
    """y by M q̈ = … at any q, q̇, w, ẇ, f, against C_ss x + D_ss u."""
    A, rng = read(content), np.random.default_rng(1)
    n, wheelsets, bogies = (len(A[k]) for k in ("coordinates", "elevations", "forces"))
    q, dq = rng.standard_normal((2, n))
    w, dw = rng.standard_normal((2, wheelsets))
    f = rng.standard_normal(bogies)
    force = A["K_w"] @ w + A["C_w"] @ dw + A["B_f"] @ f
    ddq = np.linalg.solve(A["M"], force - A["C"] @ dq - A["K"] @ q)
    y = A["Y_a"] @ ddq + A["Y_v"] @ dq + A["Y_d"] @ q
    y += A["Y_w"] @ w + A["Y_dw"] @ dw + A["Y_f"] @ f
    x, u = np.concatenate([q, dq]), np.concatenate([w, dw, f])
    assert np.allclose(A["C_ss"] @ x + A["D_ss"] @ u, y, rtol=1e-10, atol=1e-10 * np.abs(y).max())
    slopes = np.concatenate([dq, ddq])
    scale = np.abs(slopes).max()
    assert np.allclose(A["A"] @ x + A["B"] @ u, slopes, rtol=1e-10, atol=1e-10 * scale)


def test_parameters_by_name(content):
    own = {p.name: p.value for p in content.parameters}
    read = npz(content)
    assert dict(zip(read["parameters"], read["parameter_values"], strict=True)) == own
    read = matlab(content)
    assert {NAMES.original(name): value for name, value in read["parameters"].items()} == own
    assert list(read["parameter_names"]) == list(own)
    assert read["parameter_units"]["k_2" if "k_2" in own else "k_2_b1"] == "N/m"
    assert read["parameter_meanings"]["L"] == "car-body length"


@pytest.mark.parametrize(("kind", "calculated", "defined"), [
    ("mounts", {"k_theta", "c_theta"}, set()),
    ("beam", {"phi_1_p1"}, {"k_e1"}),
])  # fmt: skip
def test_parameters_tell_what_they_follow(kind, calculated, defined):
    own = export_cases.content(kind)
    read = npz(own)
    kinds = dict(zip(read["parameters"], read["parameter_kinds"], strict=True))
    assert {kinds[name] for name in calculated} == {"calculated"}
    assert {kinds[name] for name in defined} <= {"defined"}
    assert kinds["k_1"] == "independent"
    assert kinds == {NAMES.original(k): v for k, v in matlab(own)["parameter_kinds"].items()}


def test_a_changed_parameter_is_exported_as_changed(tmp_path):
    model = paper_coach(2).changed(k_2=6e5)
    export_model(model, "npz", tmp_path / "soft.npz")
    found = np.load(tmp_path / "soft.npz")
    assert np.array_equal(found["K"], paper_coach(2).matrices(k_2=6e5).K)


def test_octave_reads_it(tmp_path):
    octave = shutil.which("octave-cli")
    if octave is None:
        pytest.skip("GNU Octave is not installed")
    content = content_of(paper_coach(2))
    (tmp_path / "coach.mat").write_bytes(export_content(content, "matlab"))
    script = ("load coach.mat; printf('%.17g ', eig(A)(1)); printf('%s %s %.17g', outputs{1}, "
              "states{end}, parameters.k_2);")  # fmt: skip
    command = [octave, "--norc", "--eval", script]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)  # noqa: S603
    assert done.stdout.split()[-3:] == ["floor_acceleration", "dtheta_b2", "750000"]
