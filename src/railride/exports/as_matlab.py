"""A MATLAB file (version 5), as MATLAB, GNU Octave and ``scipy.io.loadmat`` read it.

The arrays are those of ``railride.exports.arrays``, with names and units as columns of cells;
``vehicle`` is the vehicle's name. The structures ``parameters`` and ``parameter_units`` have a
field for each parameter, its name written as ``railride.exports.names`` says, and the cell array
``parameter_names`` has the names as they are, in the order of the fields.
"""

from __future__ import annotations

import io

import numpy as np

from railride.exports import arrays
from railride.exports.content import Content
from railride.exports.names import Names

NAMES = Names(
    frozenset("break case catch classdef continue else elseif end for function global if otherwise "
              "parfor persistent return spmd switch try while".split()),
    longest=63,
)  # fmt: skip
"""MATLAB's keywords, and the length of its names (``iskeyword``, ``namelengthmax``)."""


def written(content: Content) -> bytes:
    """The file's bytes."""
    from scipy.io import savemat

    parameters = content.parameters
    held = {
        **arrays.matrices(content),
        **{name: _cells(texts) for name, texts in arrays.names(content).items()},
        "vehicle": content.name,
        "parameter_names": _cells([p.name for p in parameters]),
        "parameters": {NAMES.written(p.name): p.value for p in parameters},
        "parameter_units": {NAMES.written(p.name): p.unit for p in parameters},
    }
    stream = io.BytesIO()
    savemat(stream, held, do_compression=True, long_field_names=True, oned_as="column")
    return stream.getvalue()


def _cells(texts: list[str]) -> np.ndarray:
    """A column of cells."""
    column = np.empty((len(texts), 1), dtype=object)
    column[:, 0] = texts
    return column
