"""Where the r.m.s. alone may rate a ride too well."""

from __future__ import annotations

CREST_FACTOR, MTVV_RATIO, VDV_RATIO = 9.0, 1.5, 1.75
"""Limits of the crest factor, MTVV/a_w and VDV/(a_w T^¼)."""


def shock_remarks(
    a_w: float, crest_factor: float | None, mtvv: float | None, vdv: float, duration: float
) -> list[str]:
    """ISO's advice, one remark for each limit that is exceeded.

    ``a_w``: weighted r.m.s., m/s². ``mtvv`` m/s², ``vdv`` m/s^1.75, over ``duration`` T, s.

    Source: ISO 2631-1:1997, 6.2.1 (crest factor 9) and 6.3.3 (1.5 and 1.75).
    """
    if a_w == 0:
        return []
    found = (
        ("crest factor", crest_factor, CREST_FACTOR),
        ("MTVV/a_w", None if mtvv is None else mtvv / a_w, MTVV_RATIO),
        ("VDV/(a_w T^¼)", vdv / (a_w * duration**0.25), VDV_RATIO),
    )
    return [
        f"{name} = {value:.2f} is above {limit:g}: by ISO 2631-1 the r.m.s. may underestimate "
        "the discomfort; see MTVV and VDV too"
        for name, value, limit in found
        if value is not None and value > limit
    ]
