r"""How far the weight presses the suspensions together, of many designs.

.. math:: K q = -g\, M u_0, \qquad y = Y q

u₀ is a uniform lift: M u₀ is what of the mass each coordinate carries. The track is level; what
rests on the dampers alone has crept away.

Source: the equations of motion at rest, :mod:`railride.linear`.
"""

from __future__ import annotations

import numpy as np

from railride.numeric import Array, Matrices
from railride.units import STANDARD_GRAVITY


def static_deflections(m: Matrices, rows: Array) -> Array:
    """Static deflections, m, positive in extension: (..., outputs).

    m : of one or many vehicles. rows : Y, (..., outputs, n), of deflections
    (``VehicleModel.output_rows``, "d").
    """
    q = np.linalg.solve(m.K, -STANDARD_GRAVITY * (m.M @ m.lift)[..., np.newaxis])
    return np.asarray((rows @ q)[..., 0])
