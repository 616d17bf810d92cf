"""HDF5 files, MATLAB's from v7.3 on among them, by h5py."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from railride.tables.arrays import Named, table_of_arrays
from railride.tables.table import NumberTable


def read_hdf5(path: Path) -> NumberTable:
    """Read the datasets of an HDF5 file, those in groups named ``group/dataset``.

    path: an existing file. An attribute ``unit`` or ``units`` of a dataset is its unit; one such as
    ``fs`` of a dataset, a group or the file can give the rate.
    """
    import h5py

    found: list[Named] = []

    def visit(name: str, node: Any) -> None:
        if name.startswith("#"):  # MATLAB's own bookkeeping
            return
        beside = ((key, np.asarray(value)) for key, value in node.attrs.items())
        found.extend(Named(key, value) for key, value in beside if value.size == 1)
        if isinstance(node, h5py.Dataset) and _is_data(node):
            found.append(Named(name, np.asarray(node[()]), _unit(node)))

    with h5py.File(path, "r") as file:
        visit("", file)
        file.visititems(visit)
    return table_of_arrays(path, found)


def _is_data(node: Any) -> bool:
    """Whether a dataset holds data, not MATLAB's texts, empty arrays and references."""
    kind = node.attrs.get("MATLAB_class", b"")
    return (
        node.shape is not None
        and "MATLAB_empty" not in node.attrs
        and kind not in (b"char", b"cell", b"string", b"table")
    )


def _unit(node: Any) -> str:
    for key in ("unit", "units", "Unit", "Units"):
        value = node.attrs.get(key, "")
        text = value.decode("utf-8", "replace") if isinstance(value, bytes) else value
        if isinstance(text, str) and text:
            return text
    return ""
