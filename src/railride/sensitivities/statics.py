r"""How far the suspensions are pressed together by the weight, and the gradient of that.

.. math:: K q = -g\, M u_0, \qquad
          K\,dq = -g\, dM\, u_0 - dK\, q, \qquad y = Y q, \quad dy = dY\, q + Y\, dq

as :mod:`railride.designs.statics`.
"""

from __future__ import annotations

import numpy as np

from railride.designs.rides import suspensions
from railride.numeric import Array
from railride.sensitivities.derivatives import Tangent
from railride.units import STANDARD_GRAVITY


def static_deflections_with_gradient(at: Tangent) -> tuple[dict[str, float], Array]:
    """Static deflections of the secondary and primary suspensions, m, positive in extension.

    Parameters
    ----------
    at : the vehicle and its derivatives, ``Derivatives.at``.

    Returns
    -------
    deflections, gradient : by the outputs' names; (outputs, P).

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> from railride.sensitivities import Derivatives
    >>> here = Derivatives(derive_vehicle("cati2024", 1), ["k_2"]).at()
    >>> found, slopes = static_deflections_with_gradient(here)
    >>> round(found["secondary_1_deflection"], 4), slopes[0].round(9).tolist()  # -m_c g/(2 k_2)
    (-0.2223, [2.96e-07])
    """
    outputs = suspensions(at.derivatives.model)
    found, m = at.rows(outputs), at.m
    Y, dY = found.rows["d"], found.slopes["d"]
    weight = -STANDARD_GRAVITY * np.column_stack([m.M @ m.lift, *(at.dm["M"] @ m.lift)])
    q = np.linalg.solve(m.K, weight[:, 0])
    dq = np.linalg.solve(m.K, weight[:, 1:] - (at.dm["K"] @ q).T)
    deflections = (Y @ q).tolist()
    names = [output.name for output in outputs]
    return dict(zip(names, deflections, strict=True)), (dY @ q).T + Y @ dq
