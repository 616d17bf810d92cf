"""Mean squares of outputs: in closed form where that can be trusted, by quadrature elsewhere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import reduce

import numpy as np
from numpy.typing import ArrayLike

from railride.errors import InputError
from railride.modal import refuse_unstable
from railride.numeric import Array, Matrices
from railride.spectra import Spectrum, check_speed
from railride.stochastic.fractions import EigenForms
from railride.stochastic.gains import PLAIN, Gain
from railride.stochastic.process import BAND_HZ, Process, covered_band, process, relative
from railride.stochastic.residues import residue_squares

TRUSTED = 1e-8  # relative error of a residue sum above which it is integrated after all
_DAMPED = 1e-6  # damping ratio from which a resonance is one to look at
WORTHLESS = 2e-2  # relative error of a mean square above which it is none: of its root, 1 %


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
        that is unstable, in whose output an undamped mode takes part, or of which rounding decides
        an output.
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
            with np.errstate(all="ignore"):  # what comes of it is not finite, and given up
                p = process(*vehicle, own, speeds[k], spectrum, gains, band=band)
                by_rule, off = p.integrals(), _mismatch(p, *vehicle)
        except InputError as error:
            squares[d, k], errors[d, k] = np.nan, np.inf
            refused.setdefault(d, str(error))
            continue
        replace = doubtful[d, k]
        squares[d, k][replace] = by_rule.mean_square[replace]
        errors[d, k][replace] = (by_rule.error + off)[replace]
    _refuse_worthless(squares, errors, rows, refused)
    return squares, errors, refused


def _mismatch(p: Process, m: Matrices, rows: Mapping[str, Array]) -> Array:
    """How far squares of outputs are from the equations of motion as they stand, relative.

    At the resonances of the damped modes in the band; (gains, outputs).
    """
    roots = p.eigenvalues[-p.eigenvalues.real > _DAMPED * np.abs(p.eigenvalues)]
    f = np.unique(np.abs(roots) / (2 * np.pi))
    f = f[(f > p.edges[0]) & (f < p.edges[-1])]
    if not f.size:
        return np.zeros((len(p.gains), rows["d"].shape[-2]))
    s = 2j * np.pi * f
    w = np.exp(-p.delays[:, np.newaxis] * s)
    D = m.K + s[:, np.newaxis, np.newaxis] * (m.C + s[:, np.newaxis, np.newaxis] * m.M)
    force = m.K_w @ w + m.C_w @ (s * w)
    try:
        q = np.linalg.solve(D, force.T[..., np.newaxis])[..., 0].T
    except np.linalg.LinAlgError:  # to the last bit: nothing to compare with
        return np.full((len(p.gains), rows["d"].shape[-2]), np.inf)
    exact = (rows["d"] @ q + rows["w"] @ w + s * (rows["v"] @ q + rows["dw"] @ w)
             + s**2 * (rows["a"] @ q + rows["ddw"] @ w))  # fmt: skip
    felt = np.sqrt([gain.power(f) * p.elevation_density(f) for gain in p.gains])[:, np.newaxis]
    off = (felt * np.abs(p.response(f) - exact)).max(axis=-1)
    return 2 * relative(off, (felt * np.abs(exact)).max(axis=-1))


def _refuse_worthless(
    squares: Array, errors: Array, rows: Mapping[str, Array], refused: dict[int, str]
) -> None:
    """Give up values that rounding decides: of large errors, not finite, or 0 of what moves."""
    moves = reduce(np.logical_or, [(row != 0).any(axis=-1) for row in rows.values()])
    moves = moves.reshape(-1, 1, 1, moves.shape[-1])
    lost = ~((errors <= WORTHLESS) & (squares < np.inf) & ((squares > 0) | ~moves))
    for d in np.flatnonzero(lost.any(axis=(1, 2, 3))).tolist():
        error = np.where(np.isfinite(errors[d]), errors[d], 0.0)[lost[d]].max() / 2
        found = f"an error of {error:.0e} of the value" if error else "a value of no meaning"
        refused.setdefault(
            d, f"vehicle: found that rounding decides the motion asked for ({found}); expected "
            "springs, dampers and masses that differ by fewer powers of ten (check their units)"
        )  # fmt: skip
    squares[lost], errors[lost] = np.nan, np.inf


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
