"""The track in a Modelica package: its table, and a block that reads it under every wheelset.

The table holds level, slope and curvature at the track's samples; between two of them the quintic
that has all three at both is railride's own track, and its slope times the speed the rate.

A function ``page_k`` holds 100 steps of the table, and ``level`` finds the page: a tool that copies
a table whenever it is read, as rumoca does, then copies one page, and a ride's time grows with the
track's length instead of its square.

Source: E. Hairer, S.P. Norsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
Springer 1993, II.6 (Hermite interpolation).
"""

from __future__ import annotations

from railride.exports.modelica import number, titled
from railride.exports.setup import Setup
from railride.numeric import Array

PAGE = 100  # steps of the table in one function


def track(setup: Setup, wheelsets: int) -> list[str]:
    """The functions ``quintic``, ``page_k`` and ``level``, and the block ``Track``."""
    rows = setup.pieces
    firsts = range(0, len(rows) - 1, PAGE)
    pages = (_page(k, first, rows[first : first + PAGE + 1]) for k, first in enumerate(firsts))
    return [
        *_QUINTIC.splitlines(),
        *(line for page in pages for line in page),
        *_level(setup, len(firsts)),
        *_block(setup, wheelsets),
    ]


_QUINTIC = """
function quintic "Level and slope between two rows: level (m), slope and curvature (1/m)"
  input Real r "part of a step behind the first";
  input Real step(unit = "m") "from row to row";
  input Real first[3];
  input Real second[3];
  output Real w(unit = "m");
  output Real slope;
protected
  Real w_0, w_1, d_0, d_1, c_0, c_1 "per step";
  Real a_3, a_4, a_5;
algorithm
  w_0 := first[1];
  w_1 := second[1];
  d_0 := step*first[2];
  d_1 := step*second[2];
  c_0 := step*step*first[3];
  c_1 := step*step*second[3];
  a_3 := 10*(w_1 - w_0) - 6*d_0 - 4*d_1 - (3*c_0 - c_1)/2;
  a_4 := -15*(w_1 - w_0) + 8*d_0 + 7*d_1 + (3*c_0 - 2*c_1)/2;
  a_5 := 6*(w_1 - w_0) - 3*(d_0 + d_1) - (c_0 - c_1)/2;
  w := w_0 + r*(d_0 + r*(c_0/2 + r*(a_3 + r*(a_4 + r*a_5))));
  slope := (d_0 + r*(c_0 + r*(3*a_3 + r*(4*a_4 + r*5*a_5))))/step;
end quintic;
"""


def _page(k: int, first: int, rows: Array) -> list[str]:
    """Some rows of the table, the first of which is row ``first`` of the whole (from 0)."""
    written = ["{" + ", ".join(number(value) for value in row) + "}" for row in rows]
    return [
        "",
        f'function page_{k} "Rows {first} to {first + len(rows) - 1} of the track"',
        '  input Integer i "row of the page, from 0";',
        '  input Real r "part of a step behind it";',
        '  input Real step(unit = "m") "from row to row";',
        '  output Real w(unit = "m");',
        "  output Real slope;",
        "protected",
        f"  constant Real z[{len(rows)}, 3] = {{",
        *(f"    {row}," for row in written[:-1]),
        f"    {written[-1]}}};",
        "algorithm",
        "  (w, slope) := quintic(r, step, z[i + 1, :], z[i + 2, :]);",
        f"end page_{k};",
    ]


def _level(setup: Setup, pages: int) -> list[str]:
    """The function that finds a place's page, and in it the place."""
    last = len(setup.pieces) - 1
    rows = ["i", *(f"i - {k * PAGE}" for k in range(1, pages))]
    cases = [f"(w, slope) := page_{k}({row}, u - i, step);" for k, row in enumerate(rows)]
    chosen = [line for k, case in enumerate(cases[:-1]) for line in (
        f"  {'elseif' if k else 'if'} i < {(k + 1) * PAGE} then", f"    {case}")]  # fmt: skip
    chosen += ["  else", f"    {cases[-1]}", "  end if;"] if chosen else [f"  {cases[-1]}"]
    return [
        "",
        'function level "Level and slope of the track at a place"',
        '  input Real x(unit = "m") "place";',
        '  output Real w(unit = "m") "level; outside the table that of the nearest row";',
        "  output Real slope;",
        "protected",
        f'  constant Real x_0(unit = "m") = {number(setup.distance0)} "place of row 0";',
        f'  constant Real step(unit = "m") = {number(setup.step)} "from row to row";',
        '  Real u "place in steps";',
        '  Integer i "row before the place";',
        "algorithm",
        f"  u := min(max((x - x_0)/step, 0), {last});",
        f"  i := min(integer(floor(u)), {last - 1});",
        *chosen,
        "end level;",
    ]


def _block(setup: Setup, wheelsets: int) -> list[str]:
    each = range(1, wheelsets + 1)
    return [
        "",
        *titled("block", "Track", setup.track),
        '  parameter Real V(unit = "m/s") "speed";',
        (f'  parameter Real start(unit = "m") = {number(setup.start)} "place of the leading '
        'wheelset at time 0";'),
        *(f'  parameter Real behind_{j}(unit = "m") "of wheelset {j}, behind the leading one";'
          for j in each),
        *(f'  RealOutput w_{j}(unit = "m");' for j in each),
        *(f'  RealOutput dw_{j}(unit = "m/s");' for j in each),
        "protected",
        *(f"  Real slope_{j};" for j in each),
        "equation",
        *(line for j in each for line in (
            f"  (w_{j}, slope_{j}) = level(start - behind_{j} + V*time);",
            f"  dw_{j} = V*slope_{j};")),
        "end Track;",
    ]  # fmt: skip
