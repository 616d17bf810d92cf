"""A NumPy archive: every matrix, names and units along its axes, the parameters.

The arrays are those of ``railride.exports.arrays``, and ``vehicle``, ``parameters``,
``parameter_values`` and ``parameter_units``. Nothing is pickled: ``numpy.load`` reads it as it is.
"""

from __future__ import annotations

import io

import numpy as np

from railride.exports import arrays
from railride.exports.content import Content


def written(content: Content) -> bytes:
    """The archive's bytes."""
    parameters = content.parameters
    held = {
        **arrays.matrices(content),
        **{name: np.array(texts, dtype=str) for name, texts in arrays.names(content).items()},
        "vehicle": np.array(content.name),
        "parameters": np.array([p.name for p in parameters], dtype=str),
        "parameter_values": np.array([p.value for p in parameters]),
        "parameter_units": np.array([p.unit for p in parameters], dtype=str),
    }
    stream = io.BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **held)
    return stream.getvalue()
