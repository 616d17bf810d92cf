"""The exact time response of a linear model to an input that is linear between samples.

    x' = A x + B u,    y = C x + D u,    u linear from sample to sample (first-order hold)

There is no error of integration: what remains is the rounding, and whether a straight line
between two samples is a fair picture of the input. ``scipy.signal.lsim`` and
``control.forced_response`` solve the same recursion one sample at a time. Here one matrix product
advances all blocks of `p` samples together, and the states between the blocks follow from the
same recursion over groups of blocks. Nothing is diagonalised, so that defective models (a body
without springs, two equal bogies) are as exact as any other.

Symbols: x_k, u_k, y_k at sample k; E the transition matrix of one step; z_k = x_k - F1 u_k, the
state without the part that the same sample's input already holds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railride.errors import Faults, InputError

Array = NDArray[np.float64]

GROUP = 8
"""Blocks taken together by the recursion between blocks: few loops, little extra work."""
SHORTEST_BLOCK, LONGEST_BLOCK = 8, 64
"""Below, the one large product is too thin to be quick; above, its matrix is mostly setting up."""
CHUNK = 1 << 14
"""Samples worked on at a time: a bound on memory, and small enough for the processor's cache."""


@dataclass(frozen=True, eq=False)
class Response:
    """What came out: ``outputs[i, k]`` is output i at ``time[k]``.

    time: (samples,) in s, from 0. outputs: (outputs, samples), never squeezed. final_state:
    (states,), the state at the last sample, with which a further run can go on.
    """

    time: Array
    outputs: Array
    final_state: Array

    def __post_init__(self) -> None:
        if self.outputs.ndim != 2 or self.outputs.shape[1:] != self.time.shape:
            msg = (
                f"response: found outputs of shape {self.outputs.shape} for times of shape "
                f"{self.time.shape}; expected (outputs, samples) and (samples,)"
            )
            raise InputError(msg)


def simulate(
    A: ArrayLike,
    B: ArrayLike,
    C: ArrayLike,
    D: ArrayLike,
    u: ArrayLike,
    dt: float,
    x0: ArrayLike | None = None,
    *,
    progress: Callable[[float], None] | None = None,
) -> Response:
    """x' = A x + B u, y = C x + D u with u linear between samples: y at the samples, exactly.

    A: (states, states). B: (states, inputs). C: (outputs, states). D: (outputs, inputs).
    u: (inputs, samples). dt: step in s. x0: (states,), the state at the first sample, zero if not
    given. progress: called with the fraction done, from time to time and with 1.0 at the end.
    The states themselves are the outputs of C = identity, D = zeros.

    Raises InputError where shapes do not fit, for numbers that are not finite, and when the
    response grows beyond numbers. Whether a model is stable is for the caller to check: a finite
    response of an unstable model is returned.

    Source: C. F. Van Loan, Computing integrals involving the matrix exponential, IEEE Trans.
    Autom. Control 23 (1978) 395-404, for the step; the result is that of ``scipy.signal.lsim``.

    A free mass of 1 kg under a force that rises as t moves as t**3/6:

    >>> force = [[0.0, 1.0, 2.0, 3.0]]
    >>> simulate([[0, 1], [0, 0]], [[0], [1]], [[6, 0]], [[0]], force, dt=1.0).outputs.round(9)
    array([[ 0.,  1.,  8., 27.]])
    """
    A, B, C, D, u, x0 = _checked(A, B, C, D, u, dt, x0)
    states, (inputs, samples) = A.shape[0], u.shape
    outputs = np.empty((C.shape[0], samples))
    # An overflow is told once, below, as what it means.
    with np.errstate(over="ignore", invalid="ignore"):
        E, F0, F1 = first_order_hold(A, B, dt)
        step = _Step(E, E @ F1 + F0, C, D + C @ F1)
        p = _block_length(len(outputs), inputs, states, samples)
        blocks = _block_matrices(step, p)
        z = x0 - F1 @ u[:, 0]
        chunk = p * max(1, CHUNK // p)
        for start in range(0, samples, chunk):
            part = slice(start, min(start + chunk, samples))
            starts = _advance(blocks, u[:, part], z, outputs[:, part])
            z = starts[-1]
            if progress is not None:
                progress(part.stop / samples)
        final = _last_state(step, starts[-2], u[:, (samples - 1) // p * p :]) + F1 @ u[:, -1]
    if not (np.isfinite(outputs).all() and np.isfinite(final).all()):
        raise InputError(_UNSTABLE)
    time: Array = dt * np.arange(samples, dtype=float)
    return Response(time, outputs, final)


_UNSTABLE = (
    "time simulation: the response grew beyond numbers: the model is unstable (look for an "
    "eigenvalue of A with a positive real part: a negative stiffness or damping)"
)


def first_order_hold(A: Array, B: Array, dt: float) -> tuple[Array, Array, Array]:
    """x_{k+1} = E x_k + F0 u_k + F1 u_{k+1}: one step under an input linear over the step.

    E = exp(A dt), F0 = int_0^1 exp(A dt (1-s)) B dt (1-s) ds, F1 the same with s for (1-s): the
    blocks of one exponential, which exists whether or not A can be inverted or diagonalised:

        exp [[A dt, B dt, 0], [0, 0, 1], [0, 0, 0]] = [[E, F0 + F1, F1], [0, 1, 1], [0, 0, 1]]

    A: (states, states). B: (states, inputs). dt: s. Source: Van Loan (1978), as in `simulate`.

    >>> E, F0, F1 = first_order_hold(np.zeros((1, 1)), np.ones((1, 1)), 1.0)
    >>> E.round(12), F0.round(12), F1.round(12)
    (array([[1.]]), array([[0.5]]), array([[0.5]]))
    """
    from scipy.linalg import expm, matrix_balance

    states, inputs = B.shape
    if states == 0:
        return A, B, B
    # Metres beside radians, and newtons beside metres, would make the exponential scale by the
    # largest unit and lose the small ones. Powers of two rescale without any rounding.
    with np.errstate(invalid="ignore"):  # scipy turns the scales into indices, unasked
        _, (scale, _) = matrix_balance(A, permute=False, separate=True)
    Bdt = B * dt / scale[:, None]
    size = np.abs(Bdt).max(axis=0, initial=0.0)
    unit = np.exp2(np.ceil(np.log2(np.where(size > 0, size, 1.0))))
    augmented = np.zeros((states + 2 * inputs,) * 2)
    augmented[:states, :states] = A * dt * (scale / scale[:, None])
    augmented[:states, states : states + inputs] = Bdt / unit
    augmented[states : states + inputs, states + inputs :] = np.eye(inputs)
    exponential = expm(augmented)[:states]
    E = exponential[:, :states] * (scale[:, None] / scale)
    both = exponential[:, states : states + inputs] * scale[:, None] * unit
    F1 = exponential[:, states + inputs :] * scale[:, None] * unit
    return E, both - F1, F1


@dataclass(frozen=True, eq=False)
class _Step:
    """z_{k+1} = E z_k + G u_k, y_k = C z_k + H u_k."""

    E: Array
    G: Array
    C: Array
    H: Array


@dataclass(frozen=True, eq=False)
class _Blocks:
    """The same for p samples at once, transposed, for blocks stacked as rows.

    [y | z of the next block] = inputs @ forced + z @ [free | transition]. forced:
    (inputs p, outputs p + states), free: (states, outputs p), transition: (states, states).
    """

    p: int
    forced: Array
    free: Array
    transition: Array


def _block_matrices(step: _Step, p: int) -> _Blocks:
    """Markov parameters H, C G, C E G, C E^2 G … in a Toeplitz matrix, and powers of E."""
    E, G, C, H = step.E, step.G, step.C, step.H
    (outputs, inputs), states = H.shape, E.shape[0]
    reach = np.empty((p, states, inputs))  # E^j G
    seen = np.empty((p, outputs, states))  # C E^j
    reach[0], seen[0] = G, C
    for j in range(1, p):
        reach[j] = E @ reach[j - 1]
        seen[j] = seen[j - 1] @ E
    markov = np.concatenate([H[None], (seen[: p - 1] @ G), np.zeros((1, outputs, inputs))])
    lag = np.arange(p)[None, :] - np.arange(p)[:, None]  # of the output behind the input
    toeplitz = markov[np.where(lag >= 0, lag, p)].transpose(3, 0, 2, 1)  # (input, p, output, p)
    forced = np.concatenate(
        [
            toeplitz.reshape(inputs * p, outputs * p),
            reach[::-1].transpose(2, 0, 1).reshape(inputs * p, states),
        ],
        axis=1,
    )
    free = seen.transpose(2, 1, 0).reshape(states, outputs * p)
    return _Blocks(p, forced, free, np.linalg.matrix_power(E, p).T.copy())


def _block_length(outputs: int, inputs: int, states: int, samples: int) -> int:
    """The p with the least work per sample, p inputs outputs + 8 states^2/p, within reason.

    The recursion between blocks multiplies by 2 states^2 per block, and takes about four times as
    long for it as the one large product does.
    """
    p = states * np.sqrt(8.0 / max(1, inputs * outputs))
    return int(min(max(p, SHORTEST_BLOCK), LONGEST_BLOCK, samples))


def _advance(blocks: _Blocks, u: Array, z: Array, y: Array) -> Array:
    """Write the outputs of one chunk into y: (outputs, samples); the states between its blocks."""
    p, (inputs, samples) = blocks.p, u.shape
    outputs, count = y.shape[0], -(-samples // p)
    rows = np.zeros((count, inputs, p))
    whole = samples // p
    rows[:whole] = u[:, : whole * p].reshape(inputs, whole, p).transpose(1, 0, 2)
    if whole < count:
        rows[whole, :, : samples - whole * p] = u[:, whole * p :]
    forced = rows.reshape(count, inputs * p) @ blocks.forced
    starts = _recur(blocks.transition, forced[:, outputs * p :], z)
    result = forced[:, : outputs * p] + starts[:-1] @ blocks.free
    result = result.reshape(count, outputs, p).transpose(1, 0, 2)
    y[:] = result.reshape(outputs, count * p)[:, :samples]
    return starts


def _recur(transition: Array, forcing: Array, first: Array) -> Array:
    """z_{j+1} = z_j @ transition + forcing_j from z_0 = first: all of them, (count + 1, states).

    Within groups from rest, all groups at once; the groups' own first states by the same
    recursion, one level up; and what each group's first state adds.
    """
    count, states = forcing.shape
    if count <= 4 * GROUP:
        z = np.empty((count + 1, states))
        z[0] = first
        for j in range(count):
            z[j + 1] = z[j] @ transition + forcing[j]
        return z
    groups = -(-count // GROUP)
    padded = np.zeros((groups * GROUP, states))
    padded[:count] = forcing
    steps = padded.reshape(groups, GROUP, states)
    local = np.zeros((groups, GROUP + 1, states))  # from rest
    powers = np.empty((GROUP + 1, states, states))
    powers[0] = np.eye(states)
    for j in range(GROUP):
        local[:, j + 1] = local[:, j] @ transition + steps[:, j]
        powers[j + 1] = powers[j] @ transition
    starts = _recur(powers[GROUP], local[:, GROUP], first)
    carried = starts[:-1] @ powers[:GROUP].transpose(1, 0, 2).reshape(states, GROUP * states)
    inside = local[:, :GROUP] + carried.reshape(groups, GROUP, states)
    z = np.empty((groups * GROUP + 1, states))
    z[:-1] = inside.reshape(groups * GROUP, states)
    z[-1] = starts[-1]
    return z[: count + 1]


def _last_state(step: _Step, z: Array, u: Array) -> Array:
    """The state z at the last sample of u, from z at its first."""
    for k in range(u.shape[1] - 1):
        z = step.E @ z + step.G @ u[:, k]
    return z


def _checked(
    A: ArrayLike, B: ArrayLike, C: ArrayLike, D: ArrayLike, u: ArrayLike, dt: float, x0: Any
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """The arguments of `simulate` as arrays of float, or all that is wrong with them."""
    faults = Faults("time simulation")
    a, b, c, d, inputs = (np.asarray(value, dtype=float) for value in (A, B, C, D, u))
    for name, value in {"A": a, "B": b, "C": c, "D": d, "u": inputs}.items():
        if value.ndim != 2:
            faults.add(name, f"shape {value.shape}", "two axes", "one row for a single signal")
    faults.raise_if_any()
    x = np.zeros(a.shape[0]) if x0 is None else np.asarray(x0, dtype=float)
    (states, m), outputs = b.shape, c.shape[0]
    expected = {
        "A": (a, (states, states)),
        "C": (c, (outputs, states)),
        "D": (d, (outputs, m)),
        "u": (inputs, (m, inputs.shape[1])),
        "x0": (x, (states,)),
    }
    for name, (value, shape) in expected.items():
        if value.shape != shape:
            faults.add(name, f"shape {value.shape}", f"{shape} to go with B of {b.shape}")
    if inputs.shape[1] == 0:
        faults.add("u", "no samples", "at least one sample")
    if not (np.isfinite(dt) and dt > 0):
        faults.add("dt", f"{dt} s", "a positive, finite step")
    for name, value in {"A": a, "B": b, "C": c, "D": d, "u": inputs, "x0": x}.items():
        if not np.isfinite(value).all():
            where = tuple(int(i) for i in np.argwhere(~np.isfinite(value))[0])
            faults.add(f"{name}[{', '.join(map(str, where))}]", value[where], "a finite number")
    faults.raise_if_any()
    return a, b, c, d, inputs, x
