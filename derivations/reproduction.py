"""The paper's eight cases again, on track that is public, and what makes its two programs differ.

Writes reproduction.md and figures/reproduction_*.png beside it, in about five minutes:

    python derivations/reproduction.py

What belongs to it: paper (printed values), reproduction_cases (what stands for each program),
_seeds (a thousand kilometres, made by itself), _fit (one roughness factor), _gap (differences of
the models), _integrators and _errors (differences of numerics), _results and _causes (the
chapters), _pictures.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from check_integration import integrated_by_euler_cromer
from paper import CASES, SPEEDS_KMH
from reproduction_cases import bodies, exact, road, simulated
from reproduction_causes import closing, integration, storing, the_body, the_gap
from reproduction_errors import (
    integrator_errors,
    step_sweep,
    storing_errors,
    tolerance_sweep,
)
from reproduction_fit import fits
from reproduction_gap import (
    Difference,
    alone,
    beam_limit,
    damping_grid,
    damping_study,
    segment_study,
)
from reproduction_pictures import (
    damping_figure,
    figure_7,
    figure_of,
    gap_figure,
    integrators_figure,
    seeds_figure,
    segments_figure,
)
from reproduction_results import (
    eight_cases,
    one_factor,
    one_kilometre,
    opening,
    table_4,
)
from reproduction_seeds import sample

from railride.files import write_bytes
from railride.markup import Block, markdown
from railride.numeric import Array
from railride.plots import canvas
from railride.track import Track

FOLDER = Path(__file__).parent
SLOWER = SPEEDS_KMH[0]


@cache
def euler_cromer_error() -> Array:
    """Relative error of a_wrms of the halves by Euler-Cromer at 1 ms, exact for its recursion."""
    return np.array(integrated_by_euler_cromer(flexible=True)) / exact(bodies()["halves"]) - 1


@cache
def numerics() -> tuple[Difference, ...]:
    """Differences that come from integration and weighting, as gaps."""
    errors, kept = integrator_errors(), storing_errors()

    def of_dymola(name: str) -> Array:
        return np.array([errors["halves", v][name].mean() for v in SPEEDS_KMH])

    def of_vampire(name: str) -> Array:
        return np.array([1 / (1 + kept["beam", v][name]) - 1 for v in SPEEDS_KMH])

    found = {
        "BDF with rtol = atol = 1e-4 in DYMOLA": of_dymola("BDF, rtol = atol = 1e-4"),
        "VODE's BDF with rtol = atol = 1e-4 in DYMOLA": of_dymola("VODE's BDF, rtol = atol = 1e-4"),
        "Euler-Cromer at 1 ms in VAMPIRE": 1 / (1 + euler_cromer_error()) - 1,
        "weighting at 50 Hz in VAMPIRE alone, bilinear": of_vampire("bilinear"),
        "weighting at 50 Hz in VAMPIRE alone, first-order hold": of_vampire("hold"),
    }
    return tuple(Difference(name, "numerics", gap) for name, gap in found.items())


def scatter() -> Array:
    """Gap of damped halves against the beam, kilometre by kilometre: (kilometres, 2)."""
    return np.stack(
        [sample("damped halves", v).values / sample("beam", v).values - 1 for v in SPEEDS_KMH], -1
    )


def document() -> list[Block]:
    """All chapters."""
    runs, found = [simulated(case) for case in CASES], fits()
    return [
        *opening(),
        *eight_cases(runs, found),
        *one_kilometre(),
        *one_factor(found),
        *table_4(),
        *the_body(),
        *the_gap(numerics(), damping_grid(), scatter()),
        *integration(
            integrator_errors(),
            euler_cromer_error(),
            {v: step_sweep("halves", v) for v in SPEEDS_KMH},
            tolerance_sweep("halves", SLOWER),
        ),
        *storing(storing_errors()),
        *closing(),
    ]


def draw(folder: Path) -> None:
    """All figures, into a folder that is made if need be."""
    folder.mkdir(parents=True, exist_ok=True)
    track = road()
    rated = Track(0.0, track.step, track.level[track.distance >= -track.step / 2], name=track.name)
    runs = {case: simulated(case) for case in CASES}
    halves_and_beam = ("halves", "beam")
    figures = {
        "figure_7": figure_7(rated),
        **{f"figure_{n}": figure_of([run for case, run in runs.items() if case.figure == n])
           for n in (8, 9, 10, 11)},
        "seeds": seeds_figure({(b, v): sample(b, v).values for b in halves_and_beam
                               for v in SPEEDS_KMH},
                              {b: exact(bodies()[b]) for b in halves_and_beam}),
        "segments": segments_figure(segment_study(), beam_limit()),
        "damping": damping_figure(damping_study()),
        "gap": gap_figure([*alone(), *numerics()], damping_grid(), scatter()),
        "integrators": integrators_figure(step_sweep("halves", SLOWER)),
    }  # fmt: skip
    for name, figure in figures.items():
        canvas.save(figure, folder / f"reproduction_{name}.png")


if __name__ == "__main__":
    write_bytes(FOLDER / "reproduction.md", markdown(document()).encode())
    draw(FOLDER / "figures")
