"""An FMU of FMI 2.0 for co-simulation, by PythonFMU: the exported Python source, made to step.

Where it runs there must be Python with numpy, but not railride. The model's identifier is the
vehicle's name as ``railride.exports.names`` writes it; variables are called as in railride:
parameters (tunable), the inputs w_1 …, dw_1 … and f_1 …, the outputs, and the states.
``railride.exports.fmu_slave`` is what runs inside, and says how it steps.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
from itertools import chain
from pathlib import Path
from pprint import pformat

from railride import __version__
from railride.errors import InputError
from railride.exports import arrays, as_python, source
from railride.exports.content import Content
from railride.units import base_units

_ABLE = {"canGetAndSetFMUstate": True, "canSerializeFMUstate": True}
_SLAVE = Path(__file__).with_name("fmu_slave.py")

_SCRIPT = '''"""{title}"""

import {module}_model as model
from {module}_slave import VehicleSlave, keep

# At every instantiation PythonFMU 0.7 gives back a reference to these that it did not take.
keep(globals())


class {name}(VehicleSlave):
    """{title}"""

    description = {description!r}
    version = "{version}"
    model = model
    said = {said}
    units = {units}
'''


def written(content: Content) -> bytes:
    """The FMU's bytes.

    Raises
    ------
    InputError : PythonFMU is not installed.
    """
    try:
        from pythonfmu import FmuBuilder
    except ImportError:
        raise InputError("target fmu: found no library pythonfmu; expected it to be installed "
                         "(pip install 'railride[fmu]')") from None  # fmt: skip
    model = as_python.written(content)
    name = as_python.NAMES.written(content.name)
    # In a process with several FMUs each finds its own modules.
    module = f"{name}_{hashlib.sha256(model.encode()).hexdigest()[:12]}"
    said = _said(content)
    units = {unit: base_units(unit) for unit, _ in said.values() if unit}
    title = source.title(content)
    script = _SCRIPT.format(title=title, description=" ".join([title, *source.origin(content)]),
                            name=name, module=module, version=__version__, units=units,
                            said=pformat(said, width=96, sort_dicts=False))  # fmt: skip
    texts = {f"{module}.py": script, f"{module}_model.py": model,
             f"{module}_slave.py": _SLAVE.read_text(encoding="utf-8")}  # fmt: skip
    path = list(sys.path)
    with tempfile.TemporaryDirectory() as folder:
        files, fmu = [Path(folder, file) for file in texts], Path(folder, f"{name}.fmu")
        for file in files:
            file.write_text(texts[file.name], encoding="utf-8")
        try:
            FmuBuilder.build_FMU(files[0], fmu, files[1:], **_ABLE)
            return fmu.read_bytes()
        finally:  # it imports the script to ask what is in it
            sys.path[:] = path
            for loaded in [key for key in sys.modules if key.startswith(module)]:
                del sys.modules[loaded]


def _said(content: Content) -> dict[str, tuple[str, str]]:
    """Unit and meaning of every variable."""
    names = arrays.names(content)
    states = zip(names["states"], names["state_units"], strict=True)
    quantities = (*content.parameters, *chain(*source.axes(content).values()))
    meant = {q.name: q.meaning for q in quantities}
    meant |= {p.name: f"{p.meaning}; calculated by railride, stays when others change"
              for p in content.parameters if p.follows}  # fmt: skip
    return {
        **{name: (unit, meant.get(name, "")) for name, unit in states},
        **{q.name: (q.unit, meant[q.name]) for q in quantities},
    }
