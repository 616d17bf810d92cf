"""A user's own spectrum from a file: densities over wavenumbers or wavelengths."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from railride.errors import Faults, RowFaults
from railride.spectra.density import Spectrum
from railride.spectra.tabulated import ABSCISSAE, DENSITIES, Points, tabulated
from railride.tables import Column, NumberTable, read_table

_ABSCISSAE = frozenset((
    "wavenumber", "wave number", "angular wavenumber", "spatial frequency", "omega", "ω", "n",
    "wavelength", "wave length", "lambda", "λ", "wellenlänge", "wellenzahl", "wegkreisfrequenz",
))  # fmt: skip
_DENSITIES = frozenset((
    "density", "psd", "spectral density", "power spectral density", "spectrum", "s", "s omega",
    "s ω", "s n", "spektrale leistungsdichte", "leistungsdichte",
))  # fmt: skip
_SIDES = {"one": "one-sided", "single": "one-sided", "two": "two-sided", "double": "two-sided"}


def read_spectrum(path: str | Path, *, sidedness: str | None = None) -> Spectrum:
    """Read a spectrum from a file of any kind that :mod:`railride.tables` reads.

    ``path``: the file, with a column of wavenumbers (``wavenumber [rad/m]``, ``wavenumber [1/m]``)
    or wavelengths (``wavelength [m]``) and one of densities (``density [m^2/(rad/m)]``,
    ``psd [mm^2/(1/m)]``), as in :func:`railride.spectra.spectrum_from_table`. ``sidedness``:
    "one-sided" or "two-sided"; by default what the heading of the density says (``two-sided psd``),
    else taken to be one-sided, with a remark.

    Raises InputError naming row and column: columns missing, several or without a unit; points that
    are no spectrum.
    """
    return spectrum_of(read_table(path), sidedness)


def holds_spectrum(table: NumberTable) -> bool:
    """Whether a table's columns are those of a spectrum."""
    return bool(_found(table, _ABSCISSAE)) and bool(_found(table, _DENSITIES))


def spectrum_of(table: NumberTable, sidedness: str | None = None) -> Spectrum:
    """The spectrum that a table holds; see :func:`read_spectrum`."""
    faults = Faults(table.source)
    roles = (
        (_found(table, _ABSCISSAE), "wavenumber or wavelength", "wavenumber [rad/m]", ABSCISSAE),
        (_found(table, _DENSITIES), "density", "density [m^2/(rad/m)]", DENSITIES),
    )
    for found, role, example, units in roles:
        headings = ", ".join(repr(c.heading) for c in (found or table.columns)[:8])
        if len(found) != 1:
            faults.add("columns", f"{len(found) or 'no'} columns of a {role} among {headings}",
                       f"one, such as {example}", "rename the headings")  # fmt: skip
        elif not found[0].unit:
            faults.add(f"column {found[0].heading!r}", "no unit", f"one of {', '.join(units)}",
                       f"in square brackets, as in {example}")  # fmt: skip
    faults.raise_if_any()
    (abscissa,), (density,) = roles[0][0], roles[1][0]
    _check_cells(table, (abscissa, density), faults)
    x, S = (np.asarray(column.numbers, dtype=np.float64) for column in (abscissa, density))
    whole = np.flatnonzero(np.isfinite(x) & np.isfinite(S))  # the others are faults already
    points = Points(x[whole], S[whole], abscissa.unit, density.unit)
    columns = {"abscissa": abscissa, "density": density}
    return tabulated(
        points, sidedness or _stated(density), Path(table.source).name, table.source, faults,
        lambda j, role: table.where(int(whole[j]), columns[role]), table.remarks,
    )  # fmt: skip


def _found(table: NumberTable, names: frozenset[str]) -> tuple[Column, ...]:
    """Columns whose heading, without unit and sidedness, is one of ``names``."""
    return tuple(c for c in table.columns if " ".join(_words(c.name)) in names)


def _words(name: str) -> list[str]:
    """Words of a heading without those that state the sidedness."""
    plain = re.sub(r"(?:one|single|two|double)[\s_-]*sided", " ", name.lower())
    return re.findall(r"[^\W_]+", plain)


def _stated(column: Column) -> str | None:
    """The sidedness that a heading states."""
    match = re.search(r"(one|single|two|double)[\s_-]*sided", column.heading.lower())
    return _SIDES[match[1]] if match else None


def _check_cells(table: NumberTable, columns: tuple[Column, ...], faults: Faults) -> None:
    """Note cells that are no numbers."""
    bad = RowFaults(faults)
    for column in columns:
        for i in column.bad.tolist():
            bad.add(table.row(i), column.heading, column.shown(i), "a finite number",
                    "leave points without a density out")  # fmt: skip
    bad.close()
