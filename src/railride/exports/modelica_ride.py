"""The ride in a Modelica package: the track as a table, every wheelset at its own place, weighting.

``Track`` holds level, slope and curvature of the track at its samples; between two of them the
quintic that has all three at both is railride's own track, and its slope times the speed the rate.
``Weighting`` is the frequency weighting by its factors. ``Ride`` puts the coach on the track, where
it starts as a vehicle that follows the track; its ``a_wrms`` runs from the start of the rated
section, so that the value at the end of the run is the weighted r.m.s.

Source: of the quintic, E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations
I, 2nd ed., Springer 1993, II.6 (Hermite interpolation); of the factors ``railride.weightings``.
"""

from __future__ import annotations

import itertools
import math

import sympy as sp

from railride.exports import as_modelica as modelica
from railride.exports.content import Content
from railride.exports.setup import Setup

NAMES, number = modelica.NAMES, modelica.number
FLOOR = "floor_acceleration"


def ride(content: Content, setup: Setup) -> list[str]:
    """Track, weighting and ride."""
    count = len(content.elevations)
    return [*_HERMITE.splitlines(), *_track(setup, count), *_SECOND_ORDER.splitlines(),
            *_weighting(setup), *_ride(content, setup)]  # fmt: skip


_HERMITE = """
function quintic "Level and slope of a track at a place"
  input Real x(unit = "m") "place";
  input Real x_0(unit = "m") "place of the first row";
  input Real step(unit = "m") "from row to row";
  input Real pieces[:, 3] "level (m), slope and curvature (1/m) at every row";
  output Real w(unit = "m") "level; outside the table that of the nearest row";
  output Real slope;
protected
  Integer i "row before the place";
  Real u "place in steps";
  Real r "part of a step behind row i";
  Real w_0, w_1, d_0, d_1, c_0, c_1 "per step";
  Real a_3, a_4, a_5;
algorithm
  u := min(max((x - x_0)/step, 0), size(pieces, 1) - 1);
  i := min(integer(floor(u)), size(pieces, 1) - 2) + 1;
  r := u - (i - 1);
  w_0 := pieces[i, 1];
  w_1 := pieces[i + 1, 1];
  d_0 := step*pieces[i, 2];
  d_1 := step*pieces[i + 1, 2];
  c_0 := step*step*pieces[i, 3];
  c_1 := step*step*pieces[i + 1, 3];
  a_3 := 10*(w_1 - w_0) - 6*d_0 - 4*d_1 - (3*c_0 - c_1)/2;
  a_4 := -15*(w_1 - w_0) + 8*d_0 + 7*d_1 + (3*c_0 - 2*c_1)/2;
  a_5 := 6*(w_1 - w_0) - 3*(d_0 + d_1) - (c_0 - c_1)/2;
  w := w_0 + r*(d_0 + r*(c_0/2 + r*(a_3 + r*(a_4 + r*a_5))));
  slope := (d_0 + r*(c_0 + r*(3*a_3 + r*(4*a_4 + r*5*a_5))))/step;
end quintic;
"""

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


def _track(setup: Setup, wheelsets: int) -> list[str]:
    rows = ["{" + ", ".join(number(value) for value in row) + "}" for row in setup.pieces]
    each = range(1, wheelsets + 1)
    return [
        "",
        f"block Track {modelica.quoted(setup.track)}",
        '  parameter Real V(unit = "m/s") "speed";',
        (f'  parameter Real start(unit = "m") = {number(setup.start)} "place of the leading '
        'wheelset at time 0";'),
        *(f'  parameter Real behind_{j}(unit = "m") "of wheelset {j}, behind the leading one";'
          for j in each),
        f'  parameter Real x_0(unit = "m") = {number(setup.distance0)} "place of the first row";',
        f'  parameter Real step(unit = "m") = {number(setup.step)} "from row to row";',
        f"  parameter Real pieces[{len(rows)}, 3] = {{",
        *(f"    {row}," for row in rows[:-1]),
        f'    {rows[-1]}}} "level (m), slope and curvature (1/m) at every row";',
        *(f'  RealOutput w_{j}(unit = "m");' for j in each),
        *(f'  RealOutput dw_{j}(unit = "m/s");' for j in each),
        "protected",
        *(f"  Real slope_{j};" for j in each),
        "equation",
        *(line for j in each for line in (
            f"  (w_{j}, slope_{j}) = quintic(start - behind_{j} + V*time, x_0, step, pieces);",
            f"  dw_{j} = V*slope_{j};")),
        "end Track;",
    ]  # fmt: skip


def _weighting(setup: Setup) -> list[str]:
    weight = setup.weighting
    factors = [
        (f"SecondOrder factor_{k}(b = {_three(b)}, a = {_three(a)});", f"factor_{k}")
        for k, (b, a) in enumerate(weight.factors()[1:], start=1)
    ]
    names = [name for _, name in factors]
    chain = itertools.pairwise(names)
    return [
        "",
        f"block Weighting {modelica.quoted(f'{weight.name}, {weight.standard}')}",
        '  RealInput a(unit = "m/s2");',
        '  RealOutput a_w(unit = "m/s2");',
        *(f"  {declared}" for declared, _ in factors),
        "equation",
        f"  {names[0]}.u = {number(weight.gain)}*a;",
        *(f"  connect({one}.y, {other}.u);" for one, other in chain),
        f"  a_w = {names[-1]}.y;",
        "end Weighting;",
    ]


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
        f"model Ride {modelica.quoted(said)}",
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
    return [f"  Track track(V = V, {', '.join(behind)});"]


def _standing(content: Content, setup: Setup) -> list[str]:
    """The coach, its states as those of one that follows the track at time 0."""
    starts = []
    inertial = content.dynamics.inertial
    for q, own, z, dz in zip(content.coordinates, inertial, setup.q, setup.dq, strict=True):
        starts.append(f"{NAMES.written(q.name)}(start = {number(z)})")
        if own:
            starts.append(f"{NAMES.written(f'd{q.name}')}(start = {number(dz)})")
    return ["  Coach coach(", *(f"    {start}," for start in starts[:-1]), f"    {starts[-1]});"]
