"""The spectra that ship, by name."""

from __future__ import annotations

import difflib

from railride.errors import InputError
from railride.spectra.china import CHINA
from railride.spectra.density import Spectrum
from railride.spectra.erri import ERRI
from railride.spectra.fra import FRA
from railride.spectra.sncf import SNCF

_SHIPPED = {shipped.name: shipped for shipped in (*ERRI, *FRA, *SNCF, *CHINA)}


def spectrum_names() -> tuple[str, ...]:
    """Names of the shipped spectra.

    >>> spectrum_names()[:2]
    ('erri_low', 'erri_high')
    """
    return tuple(_SHIPPED)


def spectrum(name: str | Spectrum) -> Spectrum:
    """Look a shipped spectrum up by its ``name``; what is a spectrum already stays as it is.

    Raises InputError for a name that there is not, listing those there are, the nearest first.

    >>> spectrum("erri_low").source
    'ERRI/ORE B176, low level'
    """
    if isinstance(name, Spectrum):
        return name
    if name in _SHIPPED:
        return _SHIPPED[name]
    near = difflib.get_close_matches(name.lower(), _SHIPPED, n=3, cutoff=0.5)
    names = [*near, *(other for other in _SHIPPED if other not in near)]
    raise InputError(
        f"track spectrum: found {name!r}; expected one of {', '.join(names)}"
        + (f" (did you mean {near[0]!r}?)" if near else "")
    )
