r"""The paper's integrators on one vehicle and one track: x' = A x + B u(t), a = C x + D u(t).

u holds the elevations under the wheelsets and their rates, read from the track at any time. Four
ways over the same passage, all started at rest on the track and run in:

- first-order hold: exact for an input that is a straight line over each step (railride's way);
- Euler-Cromer at a fixed step h, as VAMPIRE was run: the rates first, then the coordinates with
  the new rates,  v_{n+1} = v_n + h a(q_n, v_n, t_n),  q_{n+1} = q_n + h v_{n+1};
- backward differentiation formulas of order 1 to 5 under error control, as DYMOLA's DASSL:
  scipy's ``BDF`` and VODE.

DASSL solves F(t, y, y') = 0 by BDF of order 1 to 5 in fixed-leading-coefficient form and keeps the
weighted r.m.s. of the estimated local error below one, with weights rtol |y| + atol (L.R. Petzold,
1982; K.E. Brenan, S.L. Campbell, L.R. Petzold, 1996, Chapter 5). VODE has the same form (P.N.
Brown, G.D. Byrne, A.C. Hindmarsh, 1989); scipy's ``BDF`` changes its step seldom and by rescaled
differences, with the smaller error constants of the NDF (L.F. Shampine, M.W. Reichelt, 1997). The
error test is the same. All three interpolate between their own steps.

Source of Euler-Cromer: A. Cromer, Am. J. Phys. 49 (1981) 455-459.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from paper import OUTPUT_STEP

from railride import Track, VehicleModel, indices, simulate, weighting
from railride.firstorder import first_order
from railride.frequency import wheelset_delays
from railride.numeric import Array
from railride.statespace import System, system_arrays
from railride.timerun import run_in_time

RATE = 1000.0  # Hz, of what is rated: VAMPIRE's step, and finer than anything that is felt
WK = weighting("Wk")


@dataclass(frozen=True, eq=False)
class Passage:
    """A vehicle on its way over the last ``length`` metres of a track, at ``speed`` m/s.

    floor : how the middle of the floor is read.
    """

    model: VehicleModel
    speed: float
    track: Track
    length: float = 1000.0
    floor: str = "polygon"

    @cached_property
    def system(self) -> System:
        """The state space with elevations and rates as inputs, the floor's acceleration out."""
        found = system_arrays(self.model, [self.model.floor(0.0, self.floor)])
        inputs = 2 * self.delays.size  # the actuators rest
        return System(found.A, found.B[:, :inputs], found.C, found.D[:, :inputs],
                      found.states, found.inputs[:inputs], found.outputs)  # fmt: skip

    @cached_property
    def delays(self) -> Array:
        """How long after the first wheelset each runs over a point, s."""
        return wheelset_delays(self.model, self.speed)

    @cached_property
    def before(self) -> float:
        """Run-in, whole seconds."""
        return float(np.ceil(run_in_time(self.model, self.system, self.speed, WK)[0]))

    @cached_property
    def duration(self) -> float:
        """The rated section, s, in whole stored steps of 0.02 s."""
        return OUTPUT_STEP * float(np.floor(self.length / self.speed / OUTPUT_STEP))

    def times(self, rate: float) -> Array:
        """Sample times, s, from the run-in's start to the end; 0 where the rating begins."""
        return np.arange(-round(self.before * rate), round(self.duration * rate) + 1) / rate

    def inputs(self, time: Array | float) -> Array:
        """U (inputs, n) at any times: elevations w, m, and their rates, m/s."""
        x = self.track.end - self.length + self.speed * (np.atleast_1d(time) - self.delays[:, None])
        # A solver that interpolates steps a little beyond the end.
        w, slope = self.track.elevation(np.minimum(x, self.track.end))
        return np.vstack([w, self.speed * slope])

    @cached_property
    def start(self) -> Array:
        """The state at rest on the track at the first time."""
        m, (u,) = self.model.matrices(), self.inputs(-self.before).T
        half = self.delays.size
        return first_order(m).state(
            *np.linalg.solve(m.K, m.K_w @ np.stack([u[:half], u[half:]], -1)).T
        )

    def acceleration(self, states: Array, time: Array) -> Array:
        """The floor's acceleration (n,), m/s², at states (s, n)."""
        return (self.system.C @ states + self.system.D @ self.inputs(time))[0]


def first_order_hold(passage: Passage, rate: float = RATE) -> Array:
    """The exact response to straight lines between samples: accelerations (n,), m/s²."""
    s, u = passage.system, passage.inputs(passage.times(rate))
    return simulate(s.A, s.B, s.C, s.D, u, 1 / rate, x0=passage.start).outputs[0]


def euler_cromer(passage: Passage, rate: float = RATE) -> Array:
    """Euler-Cromer at steps of 1/rate: accelerations (n,), m/s²; inf where it is unstable.

    As one matrix, E = [[1 + h² A₂₁, h (1 + h A₂₂)], [h A₂₁, 1 + h A₂₂]].
    """
    s, time, h = passage.system, passage.times(rate), 1 / rate
    n = len(s.A) // 2
    half = np.hstack([h * s.A[n:, :n], np.eye(n) + h * s.A[n:, n:]])  # the new rates
    step = np.vstack([np.hstack([np.eye(n), np.zeros((n, n))]) + h * half, half])
    force = h * (s.B[n:] @ passage.inputs(time))
    forced = np.vstack([h * force, force]).T.copy()
    states, x = np.empty_like(forced), passage.start
    with np.errstate(over="ignore", invalid="ignore"):
        for k, g in enumerate(forced):
            states[k] = x
            x = step @ x + g
        found = passage.acceleration(states.T, time)
    return found if np.isfinite(found).all() else np.full_like(found, np.inf)


def bdf(
    passage: Passage, rtol: float = 1e-4, atol: float = 1e-4, rate: float = RATE
) -> tuple[Array, int]:
    """scipy's BDF: accelerations (n,), m/s², and how often it asked for x'.

    rtol, atol : of the states, in m, rad, m/s and rad/s.
    """
    from scipy.integrate import solve_ivp

    time = passage.times(rate)
    found = solve_ivp(_slope(passage), (time[0], time[-1]), passage.start, method="BDF",
                      t_eval=time, rtol=rtol, atol=atol, jac=passage.system.A)  # fmt: skip
    return passage.acceleration(found.y, time), int(found.nfev)


def vode(passage: Passage, rtol: float = 1e-4, atol: float = 1e-4, rate: float = RATE) -> Array:
    """VODE's BDF in fixed-leading-coefficient form: accelerations (n,), m/s².

    rtol, atol : as for :func:`bdf`. It makes its own Jacobian, as DASSL does by default.
    """
    from scipy.integrate import ode

    time = passage.times(rate)
    solver = ode(_slope(passage))
    solver.set_integrator("vode", method="bdf", rtol=rtol, atol=atol, nsteps=100_000)
    solver.set_initial_value(passage.start, time[0])
    states = [passage.start, *(solver.integrate(t) for t in time[1:])]
    return passage.acceleration(np.transpose(states), time)


def _slope(passage: Passage) -> Callable[[float, Array], Array]:
    """x' at a time and a state."""
    A, B = passage.system.A, passage.system.B
    return lambda t, x: A @ x + (B @ passage.inputs(t))[:, 0]


def rated(acceleration: Array, before: float, rate: float = RATE) -> float:
    """a_wrms, m/s², of a record (n,), weighted as the analogue filter would.

    before : s of run-in that do not count.
    """
    if not np.isfinite(acceleration).all():
        return float("inf")
    section = slice(round(before * rate), None)
    return indices(acceleration, rate, WK, section=section, before=0.0).a_wrms


def stored(acceleration: Array, rate: float = RATE) -> Array:
    """Every sample at 0.02 s, as the paper stored them."""
    return acceleration[:: round(rate * OUTPUT_STEP)]


def deviation(acceleration: Array, reference: Array, before: float) -> float:
    """R.m.s. of the difference over the r.m.s. itself, of records stored at 0.02 s.

    before : s of run-in that do not count.
    """
    section = slice(round(before / OUTPUT_STEP), None)
    error, exact = (acceleration - reference)[section], reference[section]
    return float(np.sqrt(np.mean(error**2) / np.mean(exact**2)))


def weighted_at_50_hz(acceleration: Array, before: float) -> dict[str, float]:
    """a_wrms, m/s², of a record (n,) stored at 0.02 s, by the ways to weight it there.

    before : s of run-in that do not count.
    bilinear : Tustin's filter. hold : exact for straight lines between the samples. railride : the
    analogue filter on the band-limited signal through the samples.
    """
    from scipy.signal import bilinear_zpk, sosfilt, zpk2sos, zpk2ss

    rate = 1 / OUTPUT_STEP
    poles = WK.poles()
    zeros = np.concatenate([np.roots(numerator) for numerator, _ in WK.factors()])
    probe = 2j * np.pi * 8.0
    gain = float((WK.response(8.0) * np.prod(probe - poles) / np.prod(probe - zeros)).real)
    filters = zpk2sos(*bilinear_zpk(zeros, poles, gain, rate))
    A, B, C, D = zpk2ss(zeros, poles, gain)
    ways = {
        "bilinear": sosfilt(filters, acceleration),
        "hold": simulate(A, B, C, D, acceleration[np.newaxis], OUTPUT_STEP).outputs[0],
    }
    section = slice(round(before * rate), None)
    found = {way: float(np.sqrt(np.mean(a_w[section] ** 2))) for way, a_w in ways.items()}
    return found | {"railride": rated(acceleration, before, rate)}
