r"""Mean squares of outputs and their gradients by the adjoint.

.. math:: y = Y q + Y_w w, \quad D q = (K_w + s C_w) w, \quad D = K + s C + s^2 M, \quad
          J = \int |W|^2 |y|^2 S_w\, df

with Y and Y_w polynomials in s = iω. One more solution of the same system, the adjoint λ of each
output, gives the derivative along any number of parameters:

.. math:: D^T \lambda = Y^T, \qquad
          dJ = 2\,\mathrm{Re} \int |W|^2 S_w\, \bar y\, dy\, df,

.. math:: dy = \lambda^T \big(dK_w + s\,dC_w\big) w - \lambda^T \big(dK + s\,dC + s^2 dM\big) q
          + dY q + dY_w w + \big(\lambda^T (K_w + s C_w) + Y_w\big) dw,

.. math:: w_j = e^{-s\tau_j}, \qquad dw_j = -s\, w_j\, d\tau_j .

What stands between λ and q does not change with frequency: the integrals of λ qᵀ, λ wᵀ, q and w
times powers of s are gathered once, and contracted with the derivatives of the matrices. No
eigenvector plays a part, so repeated eigenvalues do no harm. The integrals are those of the value,
panel by panel; the ends of the band and the weighting do not move.

Source: J.S. Arora, E.J. Haug, AIAA J. 17 (1979) 970-974 (the adjoint method); H.M. Adelman, R.T.
Haftka, AIAA J. 24 (1986) 823-832.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.numeric import Array
from railride.quantities import several
from railride.sensitivities.derivatives import Rows, Tangent
from railride.spectra import Spectrum
from railride.stochastic.gains import PLAIN, Gain
from railride.stochastic.process import BAND_HZ, LINE, Process, process, refuse_lines
from railride.stochastic.quadrature import gauss_points

Complex = NDArray[np.complex128]

ROWS = ("d", "v", "a", "w", "dw", "ddw")
_NEAR, _FELT = 1e-7, 1e-6  # of an undamped mode's frequency, and of the mean square
_TOGETHER = 1000  # frequencies at a time: what the processor keeps close by


def mean_squares_with_gradient(
    at: Tangent,
    outputs: Rows,
    speeds: float | Sequence[float],
    spectrum: Spectrum,
    gains: Sequence[Gain] = (PLAIN,),
    band: tuple[float, float] = BAND_HZ,
    refined: int = 1,
) -> tuple[Array, Array]:
    """Mean squares of outputs, and their gradients along the parameters of a tangent.

    Parameters
    ----------
    at : the vehicle and its derivatives, ``Derivatives.at``.
    outputs : their rows, ``Tangent.floor`` or ``Tangent.rows``.
    speeds : m/s, each > 0. spectrum : of the track. gains : weightings. band : from and to, Hz.
    refined : into how many each panel of the value's integral is cut.

    Returns
    -------
    values, gradients : (speeds, gains, outputs) and (speeds, gains, outputs, P).

    Raises
    ------
    InputError : as :func:`railride.stochastic.process`; an undamped mode that is felt, or would be
        as soon as a parameter moves.

    Examples
    --------
    >>> from railride import derive_vehicle, spectrum
    >>> from railride.sensitivities import Derivatives
    >>> derivatives = Derivatives(derive_vehicle("cati2024", segments=2), ["k_2", "c_2"])
    >>> here = derivatives.at()
    >>> J, dJ = mean_squares_with_gradient(here, here.floor([0.0], "polygon"), 200 / 3.6,
    ...                                    spectrum("erri_low"))
    >>> J.shape, dJ.shape
    ((1, 1, 1), (1, 1, 1, 2))
    """
    speeds = several(speeds, "speeds", "m/s")
    if not speeds:
        raise InputError("speeds: found none; expected at least one, in m/s")
    found: list[tuple[Array, Array]] = []
    form = None
    for speed in speeds:
        p = process(at.m, outputs.rows, at.places.tolist(), speed, spectrum, gains, band=band,
                    form=form)  # fmt: skip
        form = p.form
        gathered = _gathered(p, outputs, refined)
        _refuse_singular(p, at, outputs, gathered.squares)
        found.append((gathered.squares, _contracted(gathered, at, outputs, speed)))
    values, gradients = zip(*found, strict=True)
    return np.stack(values), np.stack(gradients)


@dataclass(frozen=True, eq=False)
class _Gathered:
    """Integrals over the band, per gain and output (gains, outputs, ...).

    squares : ∫ |W|² S_w |y|² df. beside : Re ∫ c rᵀ df, c = 2 |W|² S_w ȳ, of the motions r = (q,
    sq, s²q, w, sw, s²w, s³w). between : Re ∫ c λ rᵀ df, (..., n, r), without the last of them.
    """

    squares: Array
    beside: Array
    between: Array

    def __add__(self, other: _Gathered) -> _Gathered:
        return _Gathered(self.squares + other.squares, self.beside + other.beside,
                         self.between + other.between)  # fmt: skip


def _gathered(p: Process, outputs: Rows, refined: int) -> _Gathered:
    """All integrals of one process, frequencies by turns.

    Raises
    ------
    InputError : an undamped mode that takes part in an output.
    """
    f, df = gauss_points(_cut(p.edges, refined))
    parts = []
    undamped = p.undamped()
    in_line: Array | float = 0.0
    for start in range(0, f.size, _TOGETHER):
        some = slice(start, start + _TOGETHER)
        part, S = _integrals(p, outputs, f[some], df[some])
        parts.append(part)
        if undamped.size:
            near = np.abs(f[some] - undamped[:, np.newaxis]) < LINE * f[some]
            in_line += S @ near.T
    total = sum(parts[1:], start=parts[0])
    refuse_lines(undamped, np.asarray(in_line), total.squares)
    return total


def _integrals(p: Process, outputs: Rows, f: Array, df: Array) -> tuple[_Gathered, Array]:
    """The integrals over some points f with weights df; and S = |W|² S_w |y|² df, (..., F)."""
    s, form = np.asarray(2j * np.pi * f, dtype=complex), p.form
    w = np.exp(-p.delays[:, np.newaxis] * s)
    motions = _motions(form.left @ form.states(s, p.into @ np.concatenate([w, s * w])), w, s)
    Y = np.concatenate([outputs.rows[name] for name in ROWS], axis=1)
    y = Y @ motions[: Y.shape[1]]
    lam = _adjoint(p, len(y), s)
    power = np.stack([gain.power(f) for gain in p.gains]) * (p.elevation_density(f) * df)
    S = power[:, np.newaxis] * (y.real**2 + y.imag**2)
    c_conj = 2 * power[:, np.newaxis] * y
    real = motions.view(float).T  # Re Σ a b = a* · b, real and imaginary parts abreast
    with_lam = (c_conj[:, :, np.newaxis] * lam.conj()).view(float) @ real[:, : -len(w)]
    return _Gathered(S.sum(axis=-1), c_conj.view(float) @ real, with_lam), S


def _motions(q: Complex, w: Complex, s: Complex) -> Complex:
    """q, sq, s²q, w, sw, s²w and s³w, one below the other."""
    n, wheelsets = len(q), len(w)
    found = np.empty((3 * n + 4 * wheelsets, s.size), dtype=complex)
    found[:n], found[3 * n : 3 * n + wheelsets] = q, w
    for start, rows, powers in ((0, n, 3), (3 * n, wheelsets, 4)):
        for end in range(start + rows, start + powers * rows, rows):
            np.multiply(s, found[end - rows : end], out=found[end : end + rows])
    return found


def _adjoint(p: Process, outputs: int, s: Complex) -> Complex:
    """λ of every output: (outputs, n, F)."""
    parts = [rows[..., np.newaxis] * s**power for power, rows in p.rows]
    right = sum(parts[1:], start=parts[0])
    right = np.ascontiguousarray(np.moveaxis(right, 0, 1)).reshape(-1, outputs * s.size)
    lam = p.form.right.T @ p.form.adjoint(np.tile(s, outputs), right)
    return np.moveaxis(lam.reshape(-1, outputs, s.size), 0, 1)


def _refuse_singular(p: Process, at: Tangent, outputs: Rows, squares: Array) -> None:
    """Refuse undamped modes that take part in an output as soon as a parameter moves.

    The gradient's integrand is then infinite at their frequency, as 1/(f - f_0).
    """
    size = np.array([abs(float(at.values[name])) or 1.0 for name in at.parameters])
    for f in p.undamped().tolist():
        near, far = (
            size * np.abs(_contracted(_integrals(p, outputs, np.array([x]), np.ones(1))[0], at,
                                      outputs, p.speed))
            for x in (f * (1 + _NEAR), f * (1 + 100 * _NEAR))
        )  # fmt: skip
        grows = (near > 10 * far) & (near * _NEAR * f > _FELT * squares[..., np.newaxis])
        if p.edges[0] < f < p.edges[-1] and grows.any():
            k = int(np.argmax(grows.any(axis=(0, 1))))
            raise InputError(
                f"vehicle: found a mode without damping ({f:.4g} Hz) that takes part in the motion "
                f"asked for as soon as {at.parameters[k]} changes: there is no gradient; expected "
                "a damping ratio above 0 (give the dampers, or the body, a damping above 0)"
            )


def _contracted(g: _Gathered, at: Tangent, outputs: Rows, speed: float) -> Array:
    """dJ/dp from the gathered integrals: (gains, outputs, P)."""
    n, wheelsets = at.m.K_w.shape
    dm, dY = at.dm, np.concatenate([outputs.slopes[name] for name in ROWS], axis=2)
    forces = np.concatenate([-dm["K"], -dm["C"], -dm["M"], dm["K_w"], dm["C_w"]], axis=2)
    dJ = np.tensordot(g.between[..., : forces.shape[2]], forces, ((2, 3), (1, 2)))
    dJ += np.einsum("gom,pom->gop", g.beside[..., : dY.shape[2]], dY)
    if at.dplaces.any():
        # By dw_j = -s w_j dτ_j: what multiplied w, sw and s²w meets sw, s²w and s³w.
        sw, s2w, s3w = (slice(k, k + wheelsets) for k in 3 * n + wheelsets * np.arange(1, 4))
        felt = (g.between[..., sw] * at.m.K_w + g.between[..., s2w] * at.m.C_w).sum(axis=2)
        for moved, name in zip((sw, s2w, s3w), ROWS[3:], strict=True):
            felt += g.beside[..., moved] * outputs.rows[name]
        dJ -= felt @ (at.dplaces[:, :1] - at.dplaces).T / speed
    return np.asarray(dJ)


def _cut(edges: Array, pieces: int) -> Array:
    """Edges of panels, each cut into as many pieces."""
    if pieces == 1:
        return edges
    inner = edges[:-1, np.newaxis] + np.diff(edges)[:, np.newaxis] * np.arange(pieces) / pieces
    return np.append(inner.ravel(), edges[-1])
