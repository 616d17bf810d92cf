"""The export as C source: compiled without a warning, compared with the model's own numbers."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from export_cases import COACH, changed, close, content, every_body, independent

from railride.exports import source
from railride.exports.as_c import NAMES
from railride.exports.content import content_of
from railride.exports.write import export_content
from railride.vehicle import derive_vehicle

COMPILER = shutil.which("cc")
FLAGS = "-std=c99 -Wall -Wextra -Werror -pedantic -shared -fPIC"
pytestmark = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")


class Compiled:
    """The library of one vehicle, its parameters as they stand in it."""

    def __init__(self, own, folder: Path):
        file = folder / "model.c"
        file.write_text(export_content(own, "c"), encoding="utf-8")
        command = [COMPILER, *FLAGS.split(), file.name, "-o", "model.so", "-lm"]
        subprocess.run(command, cwd=folder, check=True)  # noqa: S603
        self.own, self.name = own, NAMES.written(own.name)
        self.library = ctypes.CDLL(str(folder / "model.so"))
        self.names = self.texts("parameter", len(own.parameters))
        self.parameters = self._data("defaults", ctypes.c_double * len(self.names))

    def _data(self, name, kind):
        return kind.in_dll(self.library, f"{self.name}_{name}")

    def texts(self, axis, count):
        return [t.decode() for t in self._data(f"{axis}_names", ctypes.c_char_p * count)]

    def values(self, **changes):
        """The default parameters with others in their place, what those define following."""
        own = (ctypes.c_double * len(self.names))(*self.parameters)
        for name, value in changes.items():
            own[self.names.index(name)] = value
        getattr(self.library, f"{self.name}_follow")(own)
        return own

    def matrices(self, values):
        found = {}
        for function, of in (("matrices", self.own.linear.matrices), ("outputs", self.own.rows)):
            filled = {name: np.full(A.shape, np.nan) for name, A in of.items()}
            pointers = [A.ctypes.data_as(ctypes.c_void_p) for A in filled.values()]
            getattr(self.library, f"{self.name}_{function}")(values, *pointers)
            found |= filled
        return found


@every_body
def test_matrices_at_the_vehicle_and_at_changed_parameters(kind, tmp_path):
    own = content(kind)
    compiled = Compiled(own, tmp_path)
    for values, expected in (
        (compiled.parameters, own),
        (compiled.values(**independent(changed(kind))), changed(kind)),
    ):
        found = compiled.matrices(values)
        for name, A in expected.numbers.items():
            assert close(found[name], A), name
    assert not close(found["K"], own.numbers["K"])
    assert dict(zip(compiled.names, compiled.parameters, strict=True)) == {
        p.name: p.value for p in own.parameters
    }
    for axis, quantities in source.axes(own).items():
        assert compiled.texts(axis[:-1], len(quantities)) == [q.name for q in quantities]


def test_what_is_defined_may_be_set_after_the_rest(tmp_path):
    compiled = Compiled(content("beam"), tmp_path)
    values = compiled.values(f_e1=7.0)
    values[compiled.names.index("zeta_c2")] = 0.02
    expected = content("beam").model.matrices(f_e1=7.0, zeta_c2=0.02)
    assert close(compiled.matrices(values)["C"], expected.C)


def test_two_vehicles_in_one_source(tmp_path):
    texts = [export_content(content_of(derive_vehicle(replace(COACH, name=name), segments=n)), "c")
             for name, n in (("one", 1), ("two", 2))]  # fmt: skip
    file = tmp_path / "both.c"
    file.write_text("".join(texts), encoding="utf-8")
    command = [COMPILER, *FLAGS.split(), file.name, "-o", "both.so", "-lm"]
    subprocess.run(command, cwd=tmp_path, check=True)  # noqa: S603
    found = ctypes.CDLL(str(tmp_path / "both.so"))
    assert found.one_matrices != found.two_matrices


def test_no_name_of_a_vehicle_ends_the_text(tmp_path):
    own = content_of(derive_vehicle(replace(COACH, name="*/ int", source="/*/ \\"), 1))
    assert Compiled(own, tmp_path).name == "x__u2a__u2f__u20_int"
