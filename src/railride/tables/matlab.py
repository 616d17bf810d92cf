"""MATLAB's .mat files before v7.3, by scipy; those from v7.3 on are HDF5."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from railride.tables.arrays import Named, table_of_arrays
from railride.tables.table import NumberTable


def read_matlab(path: Path) -> NumberTable:
    """Read the arrays of a MATLAB file, those in a struct named ``struct/field``.

    path: an existing file.
    """
    from scipy.io import loadmat

    variables = loadmat(path)
    named = ((name, value) for name, value in variables.items() if not name.startswith("__"))
    return table_of_arrays(path, [a for name, value in named for a in _arrays(name, value)])


def _arrays(name: str, value: Any) -> Iterator[Named]:
    """Arrays in a variable: itself, or the fields of a struct and the content of a cell, if one."""
    if not isinstance(value, np.ndarray):
        return
    if value.dtype.names and value.size == 1:
        for field in value.dtype.names:
            yield from _arrays(f"{name}/{field}", value.ravel()[0][field])
    elif value.dtype.kind == "O" and value.size == 1:
        yield from _arrays(name, value.ravel()[0])
    elif value.dtype.kind == "O":  # a cell array: a column if each cell holds one text or number
        items = [item.ravel() for item in value.ravel() if isinstance(item, np.ndarray)]
        if len(items) == value.size and all(item.size == 1 for item in items):
            yield Named(name, np.array([item[0] for item in items], dtype=object))
    elif not value.dtype.names:
        yield Named(name, value)
