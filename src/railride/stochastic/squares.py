"""Mean squares of outputs: in closed form where that can be trusted, by quadrature elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.modal import refuse_unstable
from railride.numeric import Array, Matrices
from railride.spectra import Spectrum, check_speed
from railride.stochastic.fractions import EigenForms
from railride.stochastic.gains import PLAIN, Gain
from railride.stochastic.process import BAND_HZ, covered_band, process
from railride.stochastic.residues import residue_squares

TRUSTED = 1e-8  # relative error of a residue sum above which it is integrated after all


def mean_squares(
    m: Matrices,
    rows: Mapping[str, Array],
    places: ArrayLike,
    speeds: Sequence[float],
    spectrum: Spectrum,
    gains: Sequence[Gain] = (PLAIN,),
    band: tuple[float, float] = BAND_HZ,
) -> tuple[Array, Array]:
    """Mean squares of outputs and their estimated relative errors.

    Parameters
    ----------
    m, rows : of one vehicle, or of many with one leading axis (``VehicleModel.matrices`` and
        ``VehicleModel.output_rows``; the rows without it where they are the same for all).
    places : of the wheelsets, m forward, (wheelsets,), or (vehicles, wheelsets) where they differ
        (``VehicleModel.wheelset_places``). speeds : m/s, each > 0.
    gains : weightings. band : from and to, Hz.

    Returns
    -------
    squares, errors : (vehicles, speeds, gains, outputs). Of many vehicles, one that would be
        refused alone has NaN, and an infinite error.

    Raises
    ------
    InputError : no speeds, a speed ≤ 0, a spectrum with nothing in the band; of one vehicle, one
        that is unstable, or in whose output an undamped mode takes part.
    """
    squares, errors, refused = squares_of_many(m, rows, places, speeds, spectrum, gains, band)
    if refused and m.M.ndim == 2:
        raise InputError(refused[0])
    return squares, errors


def squares_of_many(
    m: Matrices,
    rows: Mapping[str, Array],
    places: ArrayLike,
    speeds: Sequence[float],
    spectrum: Spectrum,
    gains: Sequence[Gain] = (PLAIN,),
    band: tuple[float, float] = BAND_HZ,
    forms: EigenForms | None = None,
) -> tuple[Array, Array, dict[int, str]]:
    """Mean squares, their errors, and why vehicles, by their numbers, have none.

    Arguments, results and errors as for :func:`mean_squares`, but that no vehicle is refused.
    forms : of the vehicles, where they are known.
    """
    places = np.asarray(places, dtype=float)
    if not len(speeds):
        raise InputError("speeds: found none; expected at least one, in m/s")
    for speed in speeds:
        check_speed(speed)
        covered_band(spectrum, speed, band)
    found = residue_squares(m, rows, places, speeds, spectrum, gains, band, forms)
    if found is None:
        outputs = rows["d"].shape[-2]
        shape = (len(m.M) if m.M.ndim > 2 else 1, len(speeds), len(gains), outputs)
        found = np.full(shape, np.nan), np.full(shape, np.inf)
    squares, errors = found
    doubtful = ~(errors <= TRUSTED)
    unstable = _unstable(forms) if forms else {}
    refused = dict(unstable)
    for d, k in np.argwhere(doubtful.any(axis=(2, 3))).tolist():
        if d in unstable:
            squares[d, k], errors[d, k] = np.nan, np.inf
            continue
        vehicle = _one(m, rows, d)
        own = (places[d] if places.ndim > 1 else places).tolist()
        try:
            by_rule = process(*vehicle, own, speeds[k], spectrum, gains, band=band).integrals()
        except InputError as error:
            squares[d, k], errors[d, k] = np.nan, np.inf
            refused.setdefault(d, str(error))
            continue
        replace = doubtful[d, k]
        squares[d, k][replace] = by_rule.mean_square[replace]
        errors[d, k][replace] = by_rule.error[replace]
    return squares, errors, refused


def _unstable(forms: EigenForms) -> dict[int, str]:
    """Why the unstable ones of many vehicles are refused, by their numbers."""
    found: dict[int, str] = {}
    for d in np.flatnonzero((forms.poles.real > 0).any(axis=-1)).tolist():
        try:
            refuse_unstable(forms.poles[d])
        except InputError as error:
            found[d] = str(error)
    return found


def _one(
    m: Matrices, rows: Mapping[str, Array], number: int
) -> tuple[Matrices, Mapping[str, Array]]:
    """Matrices and rows of one vehicle of several, or of the only one."""
    if m.M.ndim == 2:
        return m, rows
    own = {name: A[number] for name, A in m.by_name.items()}
    return Matrices(**own, lift=m.lift), {
        name: row[number] if row.ndim > 2 else row for name, row in rows.items()
    }
