"""A MATLAB file (version 5), as MATLAB, GNU Octave and ``scipy.io.loadmat`` read it.

The arrays are those of ``railride.exports.arrays``, texts as columns of cells; ``vehicle`` is the
vehicle's name. Of the parameters there are structures, ``parameters`` of the values,
``parameter_units``, ``parameter_meanings`` and ``parameter_kinds``, with a field for each, its name
written as ``railride.exports.names`` says; the cells of ``parameter_names`` have the names as they
are, in the order of the fields.
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

    texts = arrays.texts(content)
    names = texts.pop("parameters")
    fields = [NAMES.written(name) for name in names]
    values = [p.value for p in content.parameters]
    held = {
        **arrays.matrices(content),
        "vehicle": content.name,
        "parameter_names": _cells(names),
        "parameters": dict(zip(fields, values, strict=True)),
    }
    for name, own in texts.items():
        of_each = name.startswith("parameter_")
        held[name] = dict(zip(fields, own, strict=True)) if of_each else _cells(own)
    stream = io.BytesIO()
    savemat(stream, held, do_compression=True, long_field_names=True, oned_as="column")
    return stream.getvalue()


def _cells(texts: list[str]) -> np.ndarray:
    """A column of cells."""
    column = np.empty((len(texts), 1), dtype=object)
    column[:, 0] = texts
    return column
