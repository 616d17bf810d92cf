"""A spectrum by its name: one of those that ship, or a file."""

from __future__ import annotations

import difflib
from pathlib import Path

from railride.errors import InputError
from railride.spectra.china import CHINA
from railride.spectra.density import Spectrum
from railride.spectra.erri import ERRI
from railride.spectra.file import read_spectrum
from railride.spectra.fra import FRA
from railride.spectra.sncf import SNCF

_SHIPPED = {shipped.name: shipped for shipped in (*ERRI, *FRA, *SNCF, *CHINA)}


def spectrum_names() -> tuple[str, ...]:
    """Names of the shipped spectra.

    >>> spectrum_names()[:2]
    ('erri_low', 'erri_high')
    """
    return tuple(_SHIPPED)


def is_file(name: str | Path) -> bool:
    """Whether what may be the name of a spectrum is a file's."""
    if not str(name):
        return False
    path = Path(name)
    try:
        there = path.exists()
    except (OSError, ValueError):  # too long, a zero byte
        there = True
    return isinstance(name, Path) or there or bool(path.suffix) or len(path.parts) > 1


def spectrum(name: str | Path | Spectrum) -> Spectrum:
    """Look a shipped spectrum up by its ``name``, or read one from a file of that name.

    What is a spectrum already stays as it is; files as in :func:`railride.spectra.read_spectrum`.

    Raises InputError for a name that there is not, listing those there are, the nearest first, and
    for a file that holds no spectrum.

    >>> spectrum("erri_low").source
    'ERRI/ORE B176, low level'
    """
    if isinstance(name, Spectrum):
        return name
    if isinstance(name, str) and name in _SHIPPED:
        return _SHIPPED[name]
    if is_file(name):
        return read_spectrum(name)
    shown = str(name)
    near = difflib.get_close_matches(shown.lower(), _SHIPPED, n=3, cutoff=0.5)
    names = [*near, *(other for other in _SHIPPED if other not in near)]
    raise InputError(
        f"track spectrum: found {shown!r}; expected one of {', '.join(names)}, or a file"
        + (f" (did you mean {near[0]!r}?)" if near else "")
    )
