"""What a case gives: one object of results.json."""

from __future__ import annotations

from typing import Any


def entry(
    name: str, own_s: float, peer_s: float, /, *, targets: list[dict[str, Any]], **more: Any
) -> dict[str, Any]:
    """One object of results.json."""
    return {
        "name": name,
        "railride_s": own_s,
        "peer_s": peer_s,
        "ratio": own_s / peer_s,
        "met": all(target["met"] for target in targets),
        "targets": targets,
        **more,
    }


def at_least(quantity: str, value: float, bound: float) -> dict[str, Any]:
    """A target that is met from `bound` upwards."""
    return {"quantity": quantity, "value": value, "at_least": bound, "met": value >= bound}


def at_most(quantity: str, value: float, bound: float) -> dict[str, Any]:
    """A target that is met up to `bound`."""
    return {"quantity": quantity, "value": value, "at_most": bound, "met": value <= bound}
