r"""The springs and dampers in the joints of a segmented body: what they follow from.

The stiffness of joint j between two segments, k_j, is given; or follows from EI(x) along the body

.. math:: \frac{1}{k_j} = \int \frac{w_j(x)}{EI(x)}\,dx

with the weights w_j by which cubics through the hinges interpolate: the joints' energy is then that
of the beam, ∫ M²/EI dx, for the square of a bending moment M that is known at the hinges, zero at
the free ends, where its slope is zero as well. EI/ℓ where EI and ℓ are the same all along; the free
body's natural frequencies converge with the fourth order in ℓ whatever EI(x) is. (Springs in series
from one segment's middle to the next would take w_j = 1 there, with the second order.) Or it is
calibrated, so that the free body has given bending frequencies: see
:mod:`~railride.bodies.calibration`.

Structural damping of ratio ζ in the first bending mode is c_j = 2 ζ k_j/ω_1 in every joint: a joint
moment k_j γ + c_j γ̇ damps that mode by c_j ω_1/(2 k_j). Rayleigh's β is c_j = β k_j.

Source of the weights: Lagrange's interpolation, in P.J. Davis, Interpolation and Approximation,
Dover 1975, Chapter 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import sympy as sp
from numpy.typing import ArrayLike

from railride.bodies.base import BodyModel, Parameter
from railride.bodies.calibration import calibrated
from railride.bodies.cuts import Cuts, EqualCuts, L
from railride.bodies.structural_damping import MEANING, beta, is_rayleigh, zeta_bending
from railride.errors import InputError
from railride.numeric import Array
from railride.parameters import BodyProfile, CarBody

k_theta, EI, f_bending = sp.symbols("k_theta EI f_bending", positive=True)

STIFFNESS, DAMPING = ("joint stiffness", "N m/rad"), ("joint damping", "N m s/rad")


@dataclass(frozen=True)
class Joints:
    """The joints of a body cut at given places.

    Raises
    ------
    InputError : a body that nothing says the stiffness of; more bending frequencies than joints; an
        EI(x) that these joints cannot follow.
    """

    body: CarBody
    cuts: Cuts

    def __post_init__(self) -> None:
        if not self.body.bends:
            raise InputError(
                f"segments: found {self.cuts.number} segments of a body whose bending is not "
                "known; expected a bending frequency or a joint stiffness (give one of them, or "
                "take one segment: the rigid body)"
            )
        if len(self.targets) > self.count:
            raise InputError(
                f"body.bending_frequencies: found {len(self.targets)} for {self.cuts.number} "
                f"segments; expected {self.count} at most, as many as there are joints (take more "
                "segments)"
            )
        if self.body.mode_damping is not None or self.body.rayleigh_mass:
            key = "rayleigh_mass" if self.body.rayleigh_mass else "mode_damping"
            raise InputError(
                f"body.{key}: found it with segments, whose joints damp in proportion to their "
                "stiffness; expected bending_damping, joint_damping or rayleigh_stiffness (or a "
                "body of modes, such as the beam)"
            )
        _ = self.start

    @property
    def count(self) -> int:
        """N - 1."""
        return self.cuts.number - 1

    @property
    def targets(self) -> dict[sp.Symbol, float]:
        """The bending frequencies to be met, Hz, by their symbols."""
        one, several = self.body.bending_frequency, self.body.bending_frequencies or ()
        if one is not None:
            return {f_bending: one}
        return {sp.Symbol(f"f_bending_{i}", positive=True): f for i, f in enumerate(several, 1)}

    @property
    def stiffness(self) -> tuple[sp.Symbol, ...]:
        """k of each joint, from the front: one symbol where all are alike."""
        given = self.body.joint_stiffness
        even = isinstance(self.cuts, EqualCuts) and self.body.bending_frequencies is None
        alike = even if given is None else isinstance(given, float)
        return self._symbols("k_theta", alike, positive=True)

    @property
    def damping(self) -> tuple[sp.Symbol, ...]:
        """c of each joint, from the front: one symbol where all are alike."""
        given = self.body.joint_damping
        alike = len(set(self.stiffness)) == 1 if given is None else isinstance(given, float)
        return self._symbols("c_theta", alike or self.count == 1, nonnegative=True)

    def _symbols(self, name: str, alike: bool, **sign: bool) -> tuple[sp.Symbol, ...]:
        own = (name if alike else f"{name}_{j}" for j in range(1, self.count + 1))
        return tuple(sp.Symbol(symbol, **sign) for symbol in own)

    @cached_property
    def start(self) -> Array:
        """Stiffness of each joint as given or by EI(x), else in proportion: (N - 1,)."""
        given, profile = self.body.joint_stiffness, self.body.profile
        if given is not None:
            return np.broadcast_to(given, self.count)
        if profile is None and isinstance(self.cuts, EqualCuts):
            return np.ones(self.count)
        half = self.body.length / 2
        uniform = BodyProfile((-half, half), (1.0, 1.0), (1.0, 1.0))
        found = compliances(profile or uniform, self.cuts.nodes)
        if not (found > 0).all():
            j = int(np.argmin(found)) + 1
            raise InputError(
                f"body.profile.bending_stiffness: found it so low near the joint at "
                f"{self.cuts.nodes[j]:g} m that the joint's compliance would be {found[j - 1]:.3g} "
                "rad/(N m); expected a positive one (more segments, or a cut at the soft place)"
            )
        return 1 / found

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What the stiffnesses, then what the dampings follow from."""
        body = self.body
        if self.targets:
            several = len(self.targets) > 1 or body.bending_frequencies is not None
            found = [
                Parameter(symbol, f"free-free bending frequency {i}" if several
                          else "free-free first bending frequency", "Hz", f)
                for i, (symbol, f) in enumerate(self.targets.items(), 1)
            ]  # fmt: skip
        elif body.bending_stiffness is not None:
            found = [Parameter(EI, "bending stiffness", "N m^2", body.bending_stiffness)]
        else:
            found = _each(self.stiffness, STIFFNESS, self.start)
        if body.joint_damping is not None:
            return (*found, *_each(self.damping, DAMPING, body.joint_damping))
        if is_rayleigh(body):
            meaning = "Rayleigh damping by stiffness"
            return (*found, Parameter(beta, meaning, "s", body.rayleigh_stiffness))
        return (*found, Parameter(zeta_bending, MEANING, "", body.bending_damping))

    @property
    def remarks(self) -> tuple[str, ...]:
        """That joints bend only."""
        profile = self.body.profile
        shear = (self.body.shear_stiffness, profile.shear_stiffness if profile else None)
        if shear == (None, None):
            return ()
        return ("segments do not shear: the car body's shear stiffness is not used",)

    @property
    def definitions(self) -> Mapping[sp.Symbol, sp.Expr]:
        """k_θ = EI/ℓ where EI is given; in joints between unlike segments its weighted length."""
        if self.body.bending_stiffness is None:
            return {}
        if isinstance(self.cuts, EqualCuts):
            return {k_theta: EI * self.cuts.number / L}
        return {k: EI * sp.Float(each) for k, each in zip(self.stiffness, self.start, strict=True)}

    @property
    def followers(self) -> Mapping[sp.Symbol, tuple[str, str]]:
        """k and c, unless they are given."""
        found = _said(self.stiffness, STIFFNESS) | _said(self.damping, DAMPING)
        known = {p.symbol for p in self.parameters} | set(self.definitions)
        return {symbol: said for symbol, said in found.items() if symbol not in known}

    def follow(
        self, values: Mapping[str, Array], wanted: Iterable[sp.Symbol], free: BodyModel
    ) -> dict[str, Array]:
        """Values of those of the wanted k and c that follow from others.

        Parameters
        ----------
        values : of the other parameters. free : the body, free in space.

        Raises
        ------
        InputError : bending frequencies that these joints cannot give it.
        """
        wanted, found = set(wanted), dict(values)
        k, c = wanted & set(self.stiffness), wanted & set(self.damping)
        if k:
            met = zip(self.stiffness, self._calibrated(values, free), strict=True)
            found |= {symbol.name: value for symbol, value in met if symbol in k}
        if c:
            if k == set(self.stiffness):  # all are calibrated, to this:
                first = values[next(iter(self.targets)).name]
            else:
                first = free.bending_frequencies(found)[..., 0]
            zeta = values.get(zeta_bending.name)
            time = values[beta.name] if zeta is None else zeta / (np.pi * first)
            for symbol, stiffness in zip(self.damping, self.stiffness, strict=True):
                if symbol in c:
                    found[symbol.name] = time * found[stiffness.name]
        return {s.name: found[s.name] for s in (*self.stiffness, *self.damping) if s in k | c}

    def follow_slopes(
        self,
        values: Mapping[str, Array],
        slopes: Mapping[str, Array],
        wanted: Iterable[sp.Symbol],
        free: BodyModel,
    ) -> dict[str, Array]:
        r"""Derivatives of those of the wanted k and c that one frequency or none calibrates, (P,).

        .. math:: \frac{dk}{k} = 2 \frac{df}{f} - \frac{d\omega_1^2}{\omega_1^2}\Big|_k, \qquad
                  c = t k, \quad t = \beta \text{ or } \frac{\zeta}{\pi f_1}

        values : of all parameters, numbers. slopes : of the others. free : the body, free in space.
        """
        wanted = set(wanted)
        k, c = wanted & set(self.stiffness), wanted & set(self.damping)
        found = dict(slopes)
        if k and (k != set(self.stiffness) or len(self.targets) != 1):
            return {}
        if k:
            (f,) = (symbol.name for symbol in self.targets)
            fixed = dict.fromkeys((symbol.name for symbol in k), np.zeros_like(slopes[f]))
            relative = 2 * slopes[f] / values[f] - free.bending_slope(values, {**slopes, **fixed})
            found |= {symbol.name: values[symbol.name] * relative for symbol in k}
        if c:
            time, slope = self._time_slope(values, found, free)
            for damping, stiffness in zip(self.damping, self.stiffness, strict=True):
                k_j = stiffness.name
                found[damping.name] = time * found[k_j] + values[k_j] * slope
        return {symbol.name: found[symbol.name] for symbol in k | c}

    def _time_slope(
        self, values: Mapping[str, Array], slopes: Mapping[str, Array], free: BodyModel
    ) -> tuple[Array, Array]:
        """c/k of the joints, and its derivative (P,)."""
        if zeta_bending.name not in values:
            return values[beta.name], slopes[beta.name]
        zeta, first = values[zeta_bending.name], free.bending_frequencies(values)[..., 0]
        relative = free.bending_slope(values, slopes) / 2  # of the frequency
        slope = (slopes[zeta_bending.name] - zeta * relative) / (np.pi * first)
        return zeta / (np.pi * first), slope

    def _calibrated(self, values: Mapping[str, Array], free: BodyModel) -> Sequence[Array]:
        """Stiffness of each joint, scaled to the one frequency or calibrated to several."""
        begun = {k.name: np.asarray(k_0) for k, k_0 in zip(self.stiffness, self.start, strict=True)}
        targets = [values[symbol.name] for symbol in self.targets]
        first = free.bending_frequencies({**values, **begun})[..., 0]
        scaled = self.start * ((targets[0] / first) ** 2)[..., np.newaxis]
        if len(targets) > 1:
            M, G = free.free_matrices({**values, **begun})["M"], bends(self.cuts.moved(values))
            scaled = calibrated(M, G, scaled, np.stack(np.broadcast_arrays(*targets), axis=-1))
        return [scaled[..., j] for j in range(self.count)]


def bends(nodes: Array) -> Array:
    """Rows that give each joint's turn, θ_ahead - θ_behind, by the nodes' heights.

    nodes : x, (..., N + 1), from the front. Returns (..., N - 1, N + 1).
    """
    ahead, behind = -1 / np.diff(nodes)[..., :-1], -1 / np.diff(nodes)[..., 1:]
    G = np.zeros((*ahead.shape, nodes.shape[-1]))
    j = np.arange(ahead.shape[-1])
    G[..., j, j], G[..., j, j + 1], G[..., j, j + 2] = ahead, -ahead - behind, behind
    return G


def compliances(profile: BodyProfile, nodes: Array) -> Array:
    """1/k of the joints, rad/(N m): (N - 1,) by the weights of the module's formula.

    nodes : x, m, (N + 1,), from the front. The integrals are Gaussian, exact to rounding where EI
    changes by less than a factor of ten between two knots.
    """
    N, x = len(nodes) - 1, nodes[::-1]
    # Beyond the ends the body is mirrored: M², of zero value and slope there, is even about them.
    mirrored = np.concatenate([[2 * x[0] - x[1]], x, [2 * x[-1] - x[-2]]])
    total = np.zeros(N + 1)
    points, weights = np.polynomial.legendre.leggauss(32)
    for i in range(N):
        stencil = mirrored[i : i + 4]
        a, b, *_ = profile.pieces("bending_stiffness", x[i], x[i + 1])
        h = (b - a)[:, np.newaxis] / 2
        u = (a[:, np.newaxis] + h + h * points).ravel()
        f = (h * weights).ravel() / profile.at("bending_stiffness", u)
        for q, node in enumerate((i - 1, i, i + 1, i + 2)):
            others = np.delete(stencil, q)
            lagrange = np.prod((u - others[:, np.newaxis]) / (stencil[q] - others)[:, np.newaxis],
                               axis=0)  # fmt: skip
            total[N - abs(N - abs(node))] += f @ lagrange
    return total[1:-1][::-1]


def _said(symbols: Sequence[sp.Symbol], said: tuple[str, str]) -> dict[sp.Symbol, tuple[str, str]]:
    """Meaning and unit of the joints' symbols, each once; numbered where they are not alike."""
    if len(set(symbols)) == 1:
        return {symbols[0]: said}
    return {symbol: (f"{said[0]} {j}", said[1]) for j, symbol in enumerate(symbols, start=1)}


def _each(
    symbols: Sequence[sp.Symbol], said: tuple[str, str], values: ArrayLike
) -> list[Parameter]:
    """A parameter for each symbol, once."""
    value = dict(zip(symbols, np.broadcast_to(values, len(symbols)).tolist(), strict=True))
    return [Parameter(s, *meaning, value[s]) for s, meaning in _said(symbols, said).items()]
