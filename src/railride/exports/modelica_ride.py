"""The ride in a Modelica package: the coach on a track, and the weighting of what its floor feels.

``Track`` is that of ``railride.exports.modelica_track``, ``Weighting`` the frequency weighting by
its factors. ``Ride`` puts the coach on the track, where it starts as a vehicle that follows the
track; its ``a_wrms`` runs from the start of the rated section, so that the value at the end of the
run is the weighted r.m.s.

Source: of the factors ``railride.weightings``.
"""

from __future__ import annotations

import itertools
import math

import sympy as sp

from railride.exports import modelica
from railride.exports.content import Content
from railride.exports.modelica_track import track
from railride.exports.setup import Setup
from railride.frequency import FLOOR

NAMES, number = modelica.NAMES, modelica.number


def ride(content: Content, setup: Setup) -> list[str]:
    """Track, weighting and ride."""
    count = len(content.elevations)
    return [*track(setup, count), *_SECOND_ORDER.splitlines(),
            *_weighting(setup), *_ride(content, setup)]  # fmt: skip


_SECOND_ORDER = """
block SecondOrder "(b[1] s^2 + b[2] s + b[3])/(a[1] s^2 + a[2] s + a[3])"
  parameter Real b[3];
  parameter Real a[3];
  RealInput u;
  RealOutput y;
  Real x(start = 0, fixed = true);
  Real dx(start = 0, fixed = true);
  Real ddx;
equation
  der(x) = dx;
  der(dx) = ddx;
  a[1]*ddx + a[2]*dx + a[3]*x = u;
  y = b[1]*ddx + b[2]*dx + b[3]*x;
end SecondOrder;
"""


def _weighting(setup: Setup) -> list[str]:
    weight = setup.weighting
    factors = {f"factor_{k}": f for k, f in enumerate(weight.factors()[1:], start=1)}
    names = list(factors)
    chain = itertools.pairwise(names)
    return [
        "",
        *modelica.titled("block", "Weighting", f"{weight.name}, {weight.standard}"),
        '  RealInput a(unit = "m/s2");',
        '  RealOutput a_w(unit = "m/s2");',
        *(line for name, (b, a) in factors.items() for line in (
            f"  SecondOrder {name}(", f"    b = {_three(b)},", f"    a = {_three(a)});")),
        "equation",
        f"  {names[0]}.u = {number(weight.gain)}*a;",
        *(f"  connect({one}.y, {other}.u);" for one, other in chain),
        f"  a_w = {names[-1]}.y;",
        "end Weighting;",
    ]  # fmt: skip


def _three(coefficients: tuple[float, ...]) -> str:
    padded = (*[0.0] * (3 - len(coefficients)), *coefficients)
    return "{" + ", ".join(number(c) for c in padded) + "}"


def _ride(content: Content, setup: Setup) -> list[str]:
    floors = [NAMES.written(o.name) for o in content.outputs if o.name.startswith(FLOOR)]
    weighted = [(y, f"weighting{y.removeprefix(FLOOR)}", f"a_w{y.removeprefix(FLOOR)}",
                 f"a_wrms{y.removeprefix(FLOOR)}") for y in floors]  # fmt: skip
    said = f"{content.name} over {setup.track} at {3.6 * setup.speed:.10g} km/h"
    stop = math.floor(1000 * setup.duration) / 1000
    return [
        "",
        *modelica.titled("model", "Ride", said),
        f'  parameter Real V(unit = "m/s") = {number(setup.speed)} "speed";',
        f'  parameter Real run_in(unit = "m") = {number(setup.run_in)} "before the rated section";',
        *_placed(content, setup),
        *_standing(content, setup),
        *(line for y, block, a_w, rms in weighted for line in (
            f"  Weighting {block};",
            f'  RealOutput {y}(unit = "m/s2");',
            f'  RealOutput {a_w}(unit = "m/s2") "weighted";',
            f'  RealOutput {rms}(unit = "m/s2") "its r.m.s. since the rated section began";',
            f'  Real sum_{a_w}(start = 0, fixed = true, unit = "m2/s3") "of a_w^2 over time";')),
        "equation",
        *(f"  connect(track.{NAMES.written(w.name)}, coach.{NAMES.written(w.name)});"
          for w in (*content.elevations, *content.rates)),
        *(f"  coach.{NAMES.written(f.name)} = 0;" for f in content.forces),
        *(line for y, block, a_w, rms in weighted for line in (
            f"  connect(coach.{y}, {block}.a);",
            f"  {y} = coach.{y};",
            f"  {a_w} = {block}.a_w;",
            f"  der(sum_{a_w}) = if time < run_in/V then 0 else {a_w}^2;",
            f"  {rms} = sqrt(max(sum_{a_w}, 0)/max(time - run_in/V, 1e-9));")),
        (f"  annotation(experiment(StartTime = 0, StopTime = {stop}, Tolerance = 1e-8, "
        "Interval = 0.001));"),
        "end Ride;",
    ]  # fmt: skip


def _placed(content: Content, setup: Setup) -> list[str]:
    """The track, its wheelsets behind one another by the coach's own lengths."""
    places = content.model.running_gear.wheelset_places
    known = {p.name for p in content.parameters}
    behind = []
    for j, (x, metres) in enumerate(zip(places, setup.behind, strict=True), start=1):
        apart = sp.expand(places[0] - x)
        own = {s: sp.Symbol(f"coach.{NAMES.written(s.name)}") for s in apart.free_symbols}
        held = all(s.name in known for s in own)
        text = modelica.printed(apart.xreplace(own)) if held else number(metres)
        behind.append(f"behind_{j} = {text}")
    return ["  Track track(", *(f"    {value}," for value in ("V = V", *behind[:-1])),
            f"    {behind[-1]});"]  # fmt: skip


def _standing(content: Content, setup: Setup) -> list[str]:
    """The coach, its states as those of one that follows the track at time 0."""
    starts = []
    inertial = content.dynamics.inertial
    for q, own, z, dz in zip(content.coordinates, inertial, setup.q, setup.dq, strict=True):
        starts.append(f"{NAMES.written(q.name)}(start = {number(z)})")
        if own:
            starts.append(f"{NAMES.written(f'd{q.name}')}(start = {number(dz / setup.speed)}*V)")
    return ["  Coach coach(", *(f"    {start}," for start in starts[:-1]), f"    {starts[-1]});"]
