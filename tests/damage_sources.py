"""Whole files to be damaged, small so that each command takes milliseconds, and the commands."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from outside_bodies import BETA_L
from test_damaged_tracks import LAYOUTS

DATA = Path(__file__).resolve().parents[1] / "data"

RICH = """\
name = "all that a file may hold"
source = "made up"
remarks = ["rich: nothing of it is measured"]
schema = 1

[body]
mass = "31 t"
pitch_inertia = "1.75e6 kg m^2"
length = "23.5 m"
mass_centre = "0.2 m"
bending_frequency = "8.8 Hz"
bending_damping = "1.5 %"
inertia = "graded"
note = "of sheet metal"

[bogie]
primary_stiffness = "4200 kN/m"
primary_damping = "25 kN s/m"
primary_damper_stiffness = "8 MN/m"
secondary_stiffness = "600 kN/m"
secondary_damping = "60 kN s/m"
wheelset_mass = "1500 kg"

[bogie.notes]
wheelset_mass = "worn"

[[bogies]]
position = "8.5 m"
mass = "2900 kg"
pitch_inertia = "1900 kg m^2"
wheelsets = ["1.25 m", "-1.25 m"]
secondary_damper_stiffness = "5 MN/m"

[[bogies]]
position = "-8 m"
mass = "3600 kg"
pitch_inertia = "2600 kg m^2"
wheelsets = ["1.6 m", "0 m", "-1.6 m"]

[[payload]]
mass = "3 t"
front = "6 m"
rear = "-6 m"

[[payload]]
mass = "400 kg"

[[equipment]]
mass = "900 kg"
position = "2 m"
frequency = "7.9 Hz"
damping_ratio = 0.1

[[equipment]]
mass = "500 kg"
position = "-5 m"
stiffness = "2 MN/m"
damping = "3 kN s/m"
"""

GEAR = """
[bogie]
mass = "3000 kg"
pitch_inertia = "2000 kg m^2"
wheelsets = ["1.25 m", "-1.25 m"]
primary_stiffness = "5000 kN/m"
primary_damping = "30 kN s/m"
secondary_stiffness = "750 kN/m"
secondary_damping = "70 kN s/m"
wheelset_mass = "1500 kg"

[[bogies]]
position = "8.75 m"

[[bogies]]
position = "-8.75 m"
"""

SEGMENTS = (
    """\
[body]
joint_stiffness = ["5e8 N m/rad", "4e8 N m/rad"]
joint_damping = "90 kN m s/rad"

[[segments]]
length = "5 m"
mass = "8000 kg"
mass_centre = "0.3 m"

[[segments]]
length = "8 m"
mass = "11000 kg"

[[segments]]
length = "11 m"
mass = "15000 kg"
pitch_inertia = "130000 kg m^2"
"""
    + GEAR
)

PROFILE = (
    """\
[body]
bending_damping = 0.01
cuts = ["4 m", "-3 m"]

[body.profile]
file = "profile.csv"

[[body.profile.point_masses]]
mass = "900 kg"
position = "-3 m"
pitch_inertia = "200 kg m^2"
"""
    + GEAR
)

PROFILE_COLUMNS = """\
x [m],bending_stiffness [GN m^2],mass_per_length [kg/m]
-12,3.0,1500
-7,2.0,1300
-7,1.0,1200
2.5,2.4,1380
12,3.0,1600
"""

OUTSIDE = (
    """\
[body]
mass = "33600 kg"
pitch_inertia = "1612800 kg m^2"
length = "24 m"

[body.modes]
file = "modes.csv"
"""
    + GEAR
)

BODY = """\
name = "a small one"
vehicle = "coach.toml"

[body]
segments = 1

[ride]
speeds = ["145 km/h", "200 km/h"]
tracks = ["erri_low"]
positions = ["0 m", "8 m"]
results = ["a_wrms", "wz", "travel", "modes", "static"]
"""

RANGES = """
[parameters.secondary_stiffness]
from = "700 kN/m"
to = "800 kN/m"

[parameters.secondary_damping]
from = "60 kN s/m"
to = "80 kN s/m"
"""

STUDIES = {
    "grid": BODY + RANGES.replace('to = "800 kN/m"', 'to = "800 kN/m"\npoints = 2').replace(
        'to = "80 kN s/m"', 'to = "80 kN s/m"\npoints = 3\nspacing = "log"')
        + '\n[sweep]\nkind = "grid"\nformat = "csv"\nchunk = 1000\n',
    "list": BODY + '\n[sweep]\nkind = "list"\nfile = "list.csv"\nformat = "csv"\n',
    "samples": BODY + """
[sweep]
kind = "samples"
number = 4
method = "sobol"
seed = 1
format = "csv"

[parameters.m_c]
distribution = "uniform"
from = "34 t"
to = "42 t"

[parameters.secondary_stiffness]
distribution = "normal"
deviation = "5 %"

[parameters.secondary_damping]
distribution = "lognormal"
deviation = "10 %"
""",
    "optimise": BODY.replace('results = ["a_wrms", "wz", "travel", "modes", "static"]\n', "")
    + RANGES + """
[optimise]
objective = "mean"
search = "gradient"
starts = 1
seed = 1
weights = [1, 1, 2.5, 1]

[limits]
secondary_travel = "40 mm"
distance = "500 m"
damping_ratio = { heave = "5 %", pitch = 0.05 }
secondary_static = { from = "100 mm", to = "400 mm" }
wheel_load_variation = 0.9
""",
    "pareto": BODY.replace('results = ["a_wrms", "wz", "travel", "modes", "static"]\n', "")
    + RANGES + """
[optimise]
objective = "worst"

[optimise.pareto]
against = "secondary_travel"
points = 2
""",
    "uncertainty": BODY.replace(', "travel", "modes", "static"', "").replace(', "8 m"', "") + """
[uncertainty]
number = 8
method = "sobol"
seed = 1
percentiles = [5, 50, 95]
indices = false

[parameters.secondary_stiffness]
distribution = "normal"
deviation = "5 %"
from = "85 %"
to = "115 %"

[parameters.m_c]
distribution = "triangular"
from = "34 t"
mode = "36 t"
to = "42 t"

[parameters.primary_damping]
distribution = "beta"
from = "20 kN s/m"
to = "40 kN s/m"
alpha = 2
beta = 3.5
""",
}  # fmt: skip

LIST = """\
design,secondary_stiffness [kN/m],secondary_damping [kN s/m]
1,750,70
2,600,55
3,500,45.5
"""


@dataclass(frozen=True, eq=False)
class Source:
    """Files that belong together, which of them are damaged and as what, and what reads them.

    As "toml", as "columns" separated by plain commas, or as "lines" of columns in another layout.
    """

    kind: str
    files: dict[str, str]
    damaged: dict[str, str]
    commands: tuple[str, ...]


def modes_table():
    """Heave and pitch apart, the first two bending modes of a uniform beam of 24 m in a table."""
    x = np.linspace(-12, 12, 13)
    b = BETA_L[:2, np.newaxis]
    s = b * (x + 12) / 24
    ratio = (np.cosh(b) - np.cos(b)) / (np.sinh(b) - np.sin(b))
    shapes = np.cosh(s) + np.cos(s) - ratio * (np.sinh(s) + np.sin(s))
    rows = [f"{place:g},{one:.6f},{two:.6f}" for place, (one, two) in zip(x, shapes.T, strict=True)]
    heads = ["x [m],mode 1,mode 2", "frequency [Hz],9.1,25.1", "modal_mass [t],33.6,33.6",
             "damping_ratio,0.01,0.02"]  # fmt: skip
    return "\n".join([*heads, *rows]) + "\n"


RIDE = "ride {} --speed 145 --at 3 --spectral"
EXACT = " --travel --bands --shares"
SIMPLE = (
    "modes {}",
    "derive {}",
    "bode {} --points 5",
    RIDE,
    "export {} --to npz --output out.npz",
    "export {} --to modelica --output out.mo",
)


def _commands(body, *more):
    """Every command of a vehicle with the options that make its body."""
    vehicle = "--vehicle coach.toml " + body
    return tuple(command.format(vehicle.strip()) for command in (*SIMPLE, *more))


@cache
def sources():
    """Everything that is damaged: parameter files, study files, track files."""
    coach = (DATA / "vehicles" / "cati2024.toml").read_text(encoding="utf-8")
    sized = coach.replace("[bogie.notes]", 'wheelset_mass = "1500 kg"\n\n[bogie.notes]')
    line = "ride {} --track line.csv --length 5 --speed 145"
    more = (RIDE + EXACT, line, "sensitivity {} --speed 145", "map {} --points 3",
            "modes {} --vary k_2 --from 1e5 --to 1e6 --points 3", "modes {} --plot out.svg",
            "export {} --to matlab --output out.mat", "export {} --to python --output out.py",
            "export {} --to c --output out.c", "export {} --to fmu --output out.fmu",
            "export {} --to latex --output out.tex",
            "export {} --to modelica --track line.csv --length 5 --output out.mo")  # fmt: skip
    columns = track_files()
    toml, whole = {"coach.toml": "toml"}, columns["commas"]
    found = [
        Source("vehicle", {"coach.toml": coach, "line.csv": whole}, toml,
               (*_commands("--segments 1", *more), *_commands("--segments 2", *more),
                *_commands("--body beam --modes 2"), *_commands("--body fe --modes 2"))),
        Source("vehicle", {"coach.toml": RICH, "line.csv": whole}, toml,
               (*_commands("--segments 3", *more), *_commands("", RIDE + EXACT))),
        Source("vehicle", {"coach.toml": SEGMENTS}, toml, _commands("", RIDE + EXACT)),
        Source("vehicle", {"coach.toml": PROFILE, "profile.csv": PROFILE_COLUMNS},
               {**toml, "profile.csv": "columns"},
               (*_commands("", RIDE + EXACT), *_commands("--body fe --modes 2"))),
        Source("vehicle", {"coach.toml": OUTSIDE, "modes.csv": modes_table()},
               {**toml, "modes.csv": "columns"}, _commands("")),
    ]  # fmt: skip
    for name, text in STUDIES.items():
        files = {"coach.toml": sized, "study.toml": text}
        damaged = {"study.toml": "toml", "coach.toml": "toml"}
        if name == "list":
            files["list.csv"], damaged["list.csv"] = LIST, "columns"
        command = {"uncertainty": "uncertainty", "optimise": "optimise --vehicle-file out.toml",
                   "pareto": "optimise"}.get(name, "sweep --workers 1")  # fmt: skip
        found.append(Source("study", files, damaged, (f"{command} study.toml",)))
    for name, text in columns.items():
        file = {"line.csv": text}
        commands = ("track line.csv", "track line.csv --write out.csv",
                    "track line.csv --plot out.svg", "ride --segments 1 --track line.csv"
                    " --speed 145" + (" --spectral" if name == "spectrum" else " --length 5"),
                    "map --segments 1 --track line.csv --points 2")  # fmt: skip
        if name not in ("spectrum", "long"):
            commands = commands[:-1]
        if name == "spectrum":
            commands = commands[3:]
        as_what = "columns" if name in ("commas", "spectrum", "long") else "lines"
        found.append(Source("track", file, {"line.csv": as_what}, commands))
    return tuple(found)


def track_files():
    """Tracks as the tests of tracks lay them out, and one that is long enough for a spectrum."""
    found = {name: "\n".join([*heads, *rows]) + "\n" for name, (_, heads, rows) in LAYOUTS.items()}
    rows = (f"{j / 4},{1e-3 * ((7 * j) % 11 - 5)}\n" for j in range(401))
    return found | {"long": "distance_m,level_m\n" + "".join(rows)}
