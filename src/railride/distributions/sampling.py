r"""Samples of designs that are addressed by number, so that any part can be made alone.

A design is a point u of the unit cube, each coordinate of which a distribution turns into a value
by its quantile function, x = F⁻¹(u).

sobol
    The sequence of I.M. Sobol', scrambled by J. Matoušek's linear scramble and a digital shift:
    every run of 2^m points from a multiple of 2^m fills the cube evenly. Point n is found from n
    alone.
latin_hypercube
    Each of ``total`` slices of every parameter holds one design. Made as a whole, whichever part is
    asked for: 8 bytes for each design and parameter.
random
    Independent points, the generator advanced to the first that is asked for.

Sources: S. Joe, F.Y. Kuo, SIAM J. Sci. Comput. 30 (2008) 2635 (direction numbers); J. Matoušek,
J. Complexity 14 (1998) 527; M.D. McKay et al., Technometrics 21 (1979) 239; M.E. O'Neill, PCG,
2014 (its jump ahead).
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
from typing import Any

import numpy as np

from railride.distributions.kinds import Quantiles
from railride.errors import Faults
from railride.numeric import Array

METHODS = ("sobol", "latin_hypercube", "random")
MOST_SEED = 2**32 - 1
MOST_BYTES = 2 * 10**9  # of a Latin hypercube

BITS = 32  # of a coordinate of Sobol's sequence; scipy jumps ahead with up to 32
MOST = 2**BITS  # designs
_LEAST = 2.0**-33  # a coordinate 0 stands for the slice above it: its middle, where F⁻¹ is finite


def sample(
    distributions: Iterable[Quantiles],
    start: int,
    stop: int,
    method: str = "sobol",
    seed: int = 0,
    total: int | None = None,
) -> Array:
    """The designs number ``start`` to ``stop`` - 1, shape (stop - start, P), SI.

    Whatever parts are asked for, together they are the same designs to the last bit.

    Parameters
    ----------
    distributions : P of them. start, stop : whole numbers, 0 ≤ start ≤ stop.
    method : "sobol", "latin_hypercube" or "random". seed : whole, 0 or more.
    total : how many designs there are in all; a Latin hypercube depends on it.

    Raises
    ------
    InputError : another method; numbers that are none; parts beyond the total; a Latin hypercube
        without a total, or of more than 2 GB.

    Examples
    --------
    >>> from railride.distributions import Distribution
    >>> mass = Distribution("uniform", low=34e3, high=42e3)
    >>> whole = sample([mass], 0, 8, seed=1)
    >>> bool((sample([mass], 5, 8, seed=1) == whole[5:]).all())
    True
    >>> sorted(((whole[:, 0] - 34e3) // 1000).astype(int).tolist())  # one in each ton
    [0, 1, 2, 3, 4, 5, 6, 7]
    """
    held = tuple(distributions)
    faults = Faults("sample")
    refuse_sampling(faults, len(held), stop if total is None else total, method, seed)
    if not (_whole(start) and _whole(stop) and 0 <= start <= stop <= (total or stop)):
        most = "" if total is None else f" ≤ {total}"
        faults.add("start, stop", f"{start!r}, {stop!r}", f"whole numbers, 0 ≤ start ≤ stop{most}")
    if total is None and method == "latin_hypercube":
        faults.add("total", "none", "how many designs there are in all", "a Latin hypercube "
                   "depends on it")  # fmt: skip
    faults.raise_if_any()
    count = stop - start
    if not held or not count:
        return np.empty((count, len(held)))
    if method == "sobol":
        u = _sobol(len(held), start, count, seed)
    elif method == "random":
        u = _random(len(held), start, count, seed)
    else:
        u = _latin_hypercube(len(held), int(total or 0), seed)[start:stop]
    u = np.maximum(u, _LEAST)
    return np.column_stack([np.asarray(d.ppf(u[:, k]), float) for k, d in enumerate(held)])


def refuse_sampling(faults: Faults, parameters: int, number: Any, method: Any, seed: Any) -> None:
    """Note what is wrong with how samples are to be drawn, under the keys of a study file.

    faults : gathers what is wrong. parameters : how many are sampled. number : how many designs.
    method, seed : as for :func:`sample`.
    """
    if method not in METHODS:
        faults.add("method", repr(method), f"one of {', '.join(METHODS)}")
    if not _whole(seed) or not 0 <= seed <= MOST_SEED:
        faults.add("seed", repr(seed), f"a whole number from 0 to {MOST_SEED}")
    if not _whole(number) or not 0 <= number <= MOST:
        faults.add("number", repr(number), f"a whole number from 0 to {MOST}")
    elif method == "latin_hypercube" and 8 * number * parameters > MOST_BYTES:
        size = 8 * number * parameters / 1e9
        faults.add("method", f"a Latin hypercube of {number} designs of {parameters} parameters, "
                   f"{size:.3g} GB, which is made as a whole", f"at most {MOST_BYTES / 1e9:g} GB",
                   "sobol is made in parts")  # fmt: skip


def _whole(value: Any) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)


def _sobol(parameters: int, start: int, count: int, seed: int) -> Array:
    from scipy.stats import qmc

    engine = qmc.Sobol(parameters, scramble=True, bits=BITS, rng=seed)
    if start:
        engine.fast_forward(start)
        return np.asarray(engine.random(count))
    # The first point by itself: that a part is no power of two long is no news.
    first = engine.random(1)
    return np.concatenate([first, engine.random(count - 1)]) if count > 1 else first


@lru_cache(maxsize=1)
def _latin_hypercube(parameters: int, total: int, seed: int) -> Array:
    """The whole hypercube, kept for the next part of it."""
    from scipy.stats import qmc

    found = np.asarray(qmc.LatinHypercube(parameters, rng=seed).random(total))
    found.flags.writeable = False
    return found


def _random(parameters: int, start: int, count: int, seed: int) -> Array:
    # One step of the generator is one number.
    bits = np.random.PCG64(seed).advance(start * parameters)
    return np.random.Generator(bits).random((count, parameters))
