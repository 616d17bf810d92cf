"""What ``railride bode`` prints: frequency responses as rows and as a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from railride.cli import output
from railride.cli.options import kmh

if TYPE_CHECKING:
    from railride.bodes import BodeResponse

Found = Sequence[tuple[int | None, "BodeResponse"]]
"""Responses, each with the number of segments of its body."""

LISTED = 40  # frequencies: more are summed up in the table by their peaks and dips
PROMINENT = 1.5  # how far a peak stands out from what surrounds it, as a ratio
PER = {"t": "track elevation under the leading wheelset", "w": "elevation under wheelset {}",
       "f": "force of actuator {}"}  # fmt: skip


def rows(found: Found, named: Sequence[str]) -> list[dict[str, Any]]:
    """A row for each response and frequency; ``named`` : what else is asked for, and said."""
    listed = []
    for segments, r in found:
        known = {"segments": segments, "source": r.source, "output": r.signal, "unit": r.unit}
        values = zip(r.frequency.tolist(), r.magnitude.tolist(), r.phase_deg.tolist(), strict=True)
        listed += [
            {
                "speed_kmh": None if r.speed is None else kmh(r.speed),
                "position_m": r.position,
                "frequency_hz": f,
                "magnitude": magnitude,
                "phase_deg": phase,
                **{key: value for key, value in known.items() if key in named},
            }
            for f, magnitude, phase in values
        ]
    return listed


def table(found: Found) -> str:
    """Every frequency if they are few, else the peaks and dips; the geometric zeros below."""
    responses = [r for _, r in found]
    f = responses[0].frequency
    listed = f.size <= LISTED
    facts = {name: [_facts(r)[name] for r in responses] for name in _facts(responses[0])}
    several = [name for name, values in facts.items() if len(set(values)) > 1]
    columns = [*((name, "") for name in several), ("speed\n[km/h]", ".6g"), ("at\n[m]", ".6g"),
               ("frequency\n[Hz]", ".6g"), (_magnitude(responses), ".5g"),
               ("phase\n[°]", ".1f")]  # fmt: skip
    lines: list[tuple[Any, ...]] = []
    for k, r in enumerate(responses):
        own = [facts[name][k] for name in several]
        kinds = dict.fromkeys(range(f.size), "") if listed else _extremes(r.magnitude)
        speed = None if r.speed is None else kmh(r.speed)
        lines += [(*own, speed, r.position, f[i], r.magnitude[i], r.phase_deg[i], kind)
                  for i, kind in sorted(kinds.items())]  # fmt: skip
    if listed:
        lines = [line[:-1] for line in lines]
    else:
        columns.append(("", ""))
    return output.table_text(_title(responses, facts, listed), columns, lines) + _zeros(responses)


def _facts(r: BodeResponse) -> dict[str, str]:
    """What a response is of."""
    return {
        "body": r.body,
        "output": r.signal.replace("_", " "),
        "per": PER[r.source[0]].format(r.source[2:]),
    }


def _magnitude(responses: Sequence[BodeResponse]) -> str:
    """The heading of |H|, with its unit where all have one."""
    units = {r.unit.replace("^2", "²") for r in responses}
    return "|H|\n" + (f"[{units.pop()}]" if len(units) == 1 else "[SI]")


def _title(responses: Sequence[BodeResponse], facts: dict[str, list[str]], listed: bool) -> str:
    """What all responses have in common."""
    first, f = responses[0], responses[0].frequency
    body, signal, per = (values[0] if len(set(values)) == 1 else "" for values in facts.values())
    title = first.vehicle + (f" ({body})" if body else "")
    if any(r.position is not None for r in responses):
        title += f", {first.floor} floor"
    title += f": {signal or 'responses'}" + (f" per {per}" if per else "")
    if not listed:
        title += f"\nPeaks and dips among {f.size} frequencies, {f[0]:.6g} to {f[-1]:.6g} Hz"
    return title


def _extremes(magnitude: Any) -> dict[int, str]:
    """Places of the maxima and minima that stand out in the logarithm, and the ends."""
    import numpy as np
    from scipy.signal import find_peaks

    level = np.log(np.maximum(magnitude, np.finfo(float).tiny))
    found = {0: "", magnitude.size - 1: ""}
    for sign, kind in ((1, "peak"), (-1, "dip")):
        places, _ = find_peaks(sign * level, prominence=np.log(PROMINENT))
        found |= dict.fromkeys(places.tolist(), kind)
    return found


def _zeros(responses: Sequence[BodeResponse]) -> str:
    """The geometric zeros, in words, each once; nothing if there are none."""
    lines = []
    for r in responses:
        for zeros in r.zeros:
            some = ", ".join(f"{f:.4g}" for f in zeros.frequency[:8])
            more = ", …" if zeros.frequency.size > 8 else ""
            where = r.signal.replace("_", " ") if r.position is None else f"{r.position:g} m"
            lines.append(f"  {kmh(r.speed or 0.0):g} km/h, {where}, {zeros.cause} "
                         f"{zeros.distance:g} m: {some}{more} Hz")  # fmt: skip
    listed = "\n".join(dict.fromkeys(lines))
    return f"\nZeros at (k + ½)·V/distance:\n{listed}\n" if lines else ""
