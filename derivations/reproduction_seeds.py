"""A thousand kilometres of track instead of one: a_wrms of each, and what the sample says.

Each seed is one kilometre of the same spectrum, run over by the rigid body, the paper's two halves
and the beam, exactly (straight line of 1 ms between samples). Mean squares are averaged:

    m = (1/n) sum of a_wrms^2,    m ± t s/sqrt(n),    s^2 = sample variance of a_wrms^2,

t of Student's distribution with n - 1 degrees of freedom, and square roots are taken at the end.

Make the table again, some minutes:  python derivations/reproduction_seeds.py
"""

from __future__ import annotations

from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from paper import SECTION, SPEEDS_KMH, TRACK
from reproduction_cases import bodies

from railride import KMH, ride
from railride.numeric import Array

CSV = Path(__file__).parent / "reproduction_seeds.csv"
SEEDS = range(1, 1001)
PROCESSES = 2
CONFIDENCE = 0.95


def column(body: str, speed_kmh: float) -> str:
    """The heading of a column of the table.

    >>> column("halves", 145.0)
    'halves at 145 km/h [m/s^2]'
    """
    return f"{body} at {speed_kmh:g} km/h [m/s^2]"


def one_seed(seed: int) -> dict[str, float]:
    """A row of the table: a_wrms, m/s², of every body at every speed over one kilometre."""
    found: dict[str, float] = {"seed": seed}
    for name, model in bodies().items():
        result = ride(model, TRACK, [v * KMH for v in SPEEDS_KMH], length=SECTION, seed=seed,
                      floor="polygon")  # fmt: skip
        found |= {column(name, round(3.6 * c.speed, 9)): c.a_wrms for c in result.cases}
    return found


def table(seeds: Iterable[int]) -> pd.DataFrame:
    """One row per seed, run in two processes."""
    with ProcessPoolExecutor(PROCESSES) as pool:
        return pd.DataFrame(pool.map(one_seed, seeds)).astype({"seed": int})


def pinned() -> pd.DataFrame:
    """The table as it was made, one row per seed."""
    return pd.read_csv(CSV, comment="#")


@dataclass(frozen=True)
class Sample:
    """Values (n,) of equally long runs, m/s², and what they say of the process."""

    values: Array

    @property
    def mean(self) -> float:
        """Root of the mean of the mean squares, m/s²."""
        return float(np.sqrt(np.mean(self.values**2)))

    @property
    def interval(self) -> tuple[float, float]:
        """The confidence interval of :attr:`mean`, m/s²."""
        from scipy.stats import t

        squares = self.values**2
        reach = t.ppf((1 + CONFIDENCE) / 2, squares.size - 1) * squares.std(ddof=1)
        low, high = np.mean(squares) + np.array([-1, 1]) * reach / np.sqrt(squares.size)
        return float(np.sqrt(max(low, 0.0))), float(np.sqrt(high))

    @property
    def scatter(self) -> float:
        """Standard deviation of one run relative to the mean."""
        return float(self.values.std(ddof=1) / self.values.mean())

    def share_below(self, value: float) -> float:
        """Fraction of the runs that are below a value, m/s²."""
        return float(np.mean(self.values < value))


def sample(body: str, speed_kmh: float) -> Sample:
    """The pinned runs of one body at one speed."""
    return Sample(pinned()[column(body, speed_kmh)].to_numpy())


def middle_95(values: ArrayLike) -> tuple[float, float]:
    """From the 2.5 % to the 97.5 % quantile: where one kilometre lies 19 times of 20."""
    low, high = np.quantile(np.asarray(values), [0.025, 0.975])
    return float(low), float(high)


if __name__ == "__main__":
    made = table(SEEDS)
    head = (
        f"# a_wrms (W_k) at the middle of the floor, polygon, {SECTION:g} m of {TRACK} per seed\n"
        "# made by: python derivations/reproduction_seeds.py\n"
    )
    CSV.write_text(head + made.to_csv(index=False, float_format="%.13g"), encoding="utf-8")
    print(made.describe().to_string())
