"""A NumPy archive: every matrix, what stands along its axes, the parameters.

The arrays are those of ``railride.exports.arrays``, and ``vehicle``, its name. Nothing is pickled:
``numpy.load`` reads it as it is.
"""

from __future__ import annotations

import io

import numpy as np

from railride.exports import arrays
from railride.exports.content import Content


def written(content: Content) -> bytes:
    """The archive's bytes."""
    held = {
        **arrays.matrices(content),
        **{name: np.array(texts, dtype=str) for name, texts in arrays.texts(content).items()},
        "vehicle": np.array(content.name),
        "parameter_values": np.array([p.value for p in content.parameters]),
    }
    stream = io.BytesIO()
    np.savez_compressed(stream, **held)  # type: ignore[arg-type]  # no array is allow_pickle
    return stream.getvalue()
