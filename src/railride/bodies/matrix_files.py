"""Mass and stiffness matrices of a car body from files: NumPy's .npz, or Matrix Market's .mtx.

An .npz file holds ``M`` and ``K`` (n, n), and for each coordinate its place ``x`` and ``vertical``:
1 of a height of the body's centre line (-1 where it counts downwards), 0 of anything else. With two
.mtx files comes a table of the coordinates in the order of the matrices, with the columns ``x [m]``
and ``vertical``. Matrices are in any units that belong together, with the second among them: t, mm
and N for example.

Source: R. F. Boisvert, R. Pozo, K. A. Remington, The Matrix Market Exchange Formats, NISTIR 5935,
1996.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railride.bodies.matrices import BodyMatrices
from railride.errors import Faults
from railride.record_tables import read_column, unit_factor
from railride.tables import read_table

NAMES = ("M", "K", "x", "vertical")


def read_npz(path: str | Path, *, mass_unit: str = "kg", length_unit: str = "m") -> BodyMatrices:
    """M, K, x and vertical from an .npz file.

    Parameters
    ----------
    path : of the file.
    mass_unit, length_unit : of M (K is in mass_unit/s²) and of x.

    Raises
    ------
    InputError : a file that cannot be read or lacks one of the four; what :class:`BodyMatrices`
        refuses.
    """
    faults = Faults(str(path))
    factors = _factors(mass_unit, length_unit, faults)
    found: dict[str, Any] = {}
    try:
        with np.load(path, allow_pickle=False) as arrays:
            found = {name: arrays[name] for name in NAMES if name in arrays}
            held = ", ".join(arrays) or "none"
    except FileNotFoundError:
        faults.add("file", "no such file", "an .npz file", "check the path")
    except Exception as error:  # noqa: BLE001 - NumPy raises whatever a damaged archive leads to
        faults.add("file", f"none that can be read: {error}", "an .npz file with arrays of numbers")
    faults.raise_if_any()
    missing = ", ".join(name for name in NAMES if name not in found)
    if missing:
        faults.add("arrays", f"no {missing} among {held}", "M, K, x and vertical")
    faults.raise_if_any()
    return _scaled(str(path), found, factors)


def read_matrix_market(
    mass: str | Path, stiffness: str | Path, coordinates: str | Path, *, mass_unit: str = "kg"
) -> BodyMatrices:
    """M and K from a pair of .mtx files, x and vertical from a table of the coordinates.

    Parameters
    ----------
    mass, stiffness : paths of M and K.
    coordinates : path of the table; row i is coordinate i.
    mass_unit : of M; K is in mass_unit/s².

    Raises
    ------
    InputError : files that cannot be read, or without one of the columns; what
        :class:`BodyMatrices` refuses.
    """
    source = f"{mass}, {stiffness}"
    faults = Faults(source)
    factors = _factors(mass_unit, "m", faults)
    faults.raise_if_any()
    found = {name: _read_matrix(path) for name, path in (("M", mass), ("K", stiffness))}
    table = read_table(coordinates)
    rows = Faults(table.source)
    for name, unit in (("x", "m"), ("vertical", "")):
        found[name] = np.array(read_column(table, table.column(name), unit, "", rows))
    rows.raise_if_any()
    return _scaled(source, found, factors)


def _read_matrix(path: str | Path) -> Any:
    """A matrix of real numbers from a Matrix Market file."""
    from scipy.io import mmread

    faults = Faults(str(path))
    try:
        A = mmread(path)
    except (OSError, ValueError, OverflowError) as error:
        missing = isinstance(error, OSError) and not Path(path).is_file()
        found = "no such file" if missing else f"none that can be read: {error}"
        faults.add("file", found, "a matrix in the Matrix Market format, .mtx")
        faults.raise_if_any()
    if np.iscomplexobj(A):
        faults.add("file", "a complex matrix", "a matrix of real numbers")
        faults.raise_if_any()
    return A


def _factors(mass_unit: str, length_unit: str, faults: Faults) -> tuple[float, float]:
    """Factors of the two units to SI."""
    return (unit_factor(mass_unit, "kg", "mass_unit", faults),
            unit_factor(length_unit, "m", "length_unit", faults))  # fmt: skip


def _scaled(source: str, found: dict[str, Any], factors: tuple[float, float]) -> BodyMatrices:
    """The matrices in SI units; the factors are those of mass and length."""
    faults = Faults(source)
    for name, value in found.items():
        if value.dtype.kind not in "biuf":
            faults.add(name, f"values of type {value.dtype}", "numbers")
    faults.raise_if_any()
    mass, length = factors
    M, K, x, vertical = (found[name] for name in NAMES)
    return BodyMatrices(source, M * mass, K * mass, x * length, vertical)
