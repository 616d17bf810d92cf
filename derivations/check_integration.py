"""What Section 4 of the paper says of integrating and of storing results, claim by claim."""

from __future__ import annotations

from functools import cache
from math import cos, pi

import numpy as np
from check_values import (
    Array,
    Pair,
    base,
    change,
    comfort_table,
    floor_process,
    mean_square,
    percent,
    shown,
)
from claims import FAILS, FOLLOWS, OPEN, Claim, claim, columns, figure
from paper import DASSL_TOLERANCE, OUTPUT_STEP, SPEEDS_KMH, TABLE_1, VAMPIRE_STEP, coach

from railride import KMH, weighting
from railride.markup import Table
from railride.numeric import Matrices
from railride.response import first_order_hold


def claims() -> list[Claim]:
    """The claims in their order."""
    return [tolerance(), euler_cromer_step(), output_step(), peaks()]


def euler_cromer_growth(c_1: float, step: float = VAMPIRE_STEP) -> float:
    """Largest |z| of one Euler-Cromer step of the flexible vehicle: above 1 it grows."""
    A = coach().matrices(c_1=c_1)
    n = len(A.M)
    rate = np.linalg.solve(A.M, np.hstack([-A.K, -A.C])) * step  # v+ = v + rate (q, v)
    v = rate + np.eye(n, 2 * n, n)
    q = np.eye(n, 2 * n) + step * v  # q+ = q + h v+
    return float(np.abs(np.linalg.eigvals(np.vstack([q, v]))).max())


def tolerance() -> Claim:
    """DASSL's tolerance."""
    return claim(
        "Tolerance of the integration",
        "Section 4",
        "The tolerance of the integration in DYMOLA is 0.0001, which was proven to be optimal",
        "a tolerance of 1e-4 is optimal",
        OPEN,
        "none or several per cent: see [the reproduction](reproduction.md)",
        f"What was compared, and by which measure {DASSL_TOLERANCE:g} was best, is not said. An "
        "optimum needs a cost and an error, and neither is printed. Nor is it printed whether the "
        "tolerance is the absolute one too. Two adaptive BDF codes in [the reproduction]"
        "(reproduction.md#integrators-side-by-side) leave next to no error in the comfort value "
        "where the absolute tolerance is a hundredth of the relative one, and up to several per "
        "cent where both are the same number.",
    )


def euler_cromer_stiffness(A: Matrices, frequency: Array, step: float) -> Array:
    """The dynamic stiffness that the Euler-Cromer method gives a vehicle: (F, n, n).

    v⁺ = v + h q̈(q, v), q⁺ = q + h v⁺ is M (z - 2 + 1/z)/h² q + C (1 - 1/z)/h q + K q = force,
    with z = exp(iωh). frequency : in Hz, (F,). step : h, s.
    """
    z = np.exp(2j * pi * frequency * step)[:, None, None]
    return (z - 2 + 1 / z) / step**2 * A.M + (1 - 1 / z) / step * A.C + A.K


def integrated_by_euler_cromer(flexible: bool, step: float = VAMPIRE_STEP) -> Pair:
    """a_wrms of the vehicle as the Euler-Cromer method integrates it: exact for its recursion."""
    model, W = coach(flexible), weighting("Wk")
    A = model.matrices()
    row = model.output_rows([model.floor(0.0, "polygon", derivative=0)])["d"][0]
    places, found = np.array(model.vehicle.wheelset_positions), []
    for v in SPEEDS_KMH:
        one, delays = floor_process(model, v * KMH), (places[0] - places) / (v * KMH)
        total = 0.0
        for _, f, df, _ in one.pieces():
            s, z = 2j * pi * f, np.exp(2j * pi * f * step)
            D = euler_cromer_stiffness(A, f, step)
            w = np.exp(-np.outer(s, delays))
            force = w @ A.K_w.T + s[:, None] * (w @ A.C_w.T)
            height = np.linalg.solve(D, force[..., None])[..., 0] @ row
            a = (z - 2 + 1 / z) / step**2 * height
            total += float(np.sum(np.abs(a * W.response(f)) ** 2 * one.elevation_density(f) * df))
        found.append(total**0.5)
    return found[0], found[1]


def euler_cromer_step() -> Claim:
    """The step of 1 ms is fine enough."""
    pairs = (integrated_by_euler_cromer(False), integrated_by_euler_cromer(True))
    off = [percent(a / b - 1, 2) for a, b in zip(pairs[1], base(True), strict=True)]
    omega = 2 * pi * TABLE_1["f_bending"].value * VAMPIRE_STEP
    shift = 2 * np.arcsin(omega / 2) / omega - 1
    return claim(
        "The Euler–Cromer method at 1 ms",
        "Section 4",
        "The integration algorithm used in VAMPIRE is the Euler–Cromer method, with a time step of "
        "0.001",
        "Euler–Cromer at 1 ms is accurate enough",
        FOLLOWS,
        f"flexible {shown(pairs[1])} ({off[0]} / {off[1]})",
        r"The method moves an undamped frequency by the factor "
        r"$2 \arcsin(\omega h/2)/(\omega h)$, here by "
        f"{percent(shift, 3)} at 9.6 Hz. What it makes of the whole vehicle, by its own frequency "
        "response:",
        comfort_table({"exact": (base(False), base(True)), "Euler–Cromer, 1 ms": pairs}),
        f"That holds for the damping as read (growth {euler_cromer_growth(30e3):.4f} per step). "
        "With the primary damping as printed the method is unstable ([[Primary damping]]). "
        "Accuracy of the integration does not explain the difference between the programs.",
    )


@cache
def sampled_weighting(method: str) -> tuple[Array, Array]:
    """Numerator and denominator in z of W_k at 50 Hz, by "bilinear" or "first-order hold"."""
    from scipy import signal

    unit = 2 * pi * 10.0  # rad/s: coefficients of one size
    tf = weighting("Wk").transfer_function()
    num, den = (
        np.asarray(c) * unit ** np.arange(len(c))[::-1] for c in (tf.num[0][0], tf.den[0][0])
    )
    step = OUTPUT_STEP * unit
    if method == "bilinear":
        b, a = signal.bilinear(num, den, 1 / step)
        return b, a
    A, B, C, D = signal.tf2ss(num, den)
    E, F0, F1 = first_order_hold(A, B, step)
    b, a = signal.ss2tf(E, E @ F1 + F0, C, D + C @ F1)
    return b[0], a


def sampled_gain(method: str, frequency: Array | float) -> Array:
    """|W| of the filter on samples of 0.02 s at frequencies in Hz."""
    b, a = sampled_weighting(method)
    z = np.exp(2j * pi * np.asarray(frequency) * OUTPUT_STEP)
    return np.abs(np.polyval(b, z) / np.polyval(a, z))


def weighted_at_50_hz(method: str, flexible: bool) -> Pair:
    """a_wrms of what is stored every 0.02 s and weighted there."""
    first, second = (
        mean_square(floor_process(coach(flexible), v * KMH),
                    lambda f: sampled_gain(method, f) ** 2) ** 0.5
        for v in SPEEDS_KMH
    )  # fmt: skip
    return first, second


def folded(flexible: bool) -> tuple[Pair, Pair]:
    """Of storing alone, every 0.02 s: share of the mean square above 25 Hz; relative change of a_w.

    What lies above half the rate is seen, and weighted, at its mirror image below.
    """
    W, rate = weighting("Wk"), 1 / OUTPUT_STEP

    def power(f: Array) -> Array:
        return np.abs(W.response(f)) ** 2

    above, seen = [], []
    for v in SPEEDS_KMH:
        one = floor_process(coach(flexible), v * KMH)
        exact = mean_square(one, power)
        high = mean_square(one, lambda f: np.where(f > rate / 2, power(f), 0.0))
        stored = mean_square(one, lambda f: power(np.abs(f - rate * np.round(f / rate))))
        above.append(high / exact)
        seen.append((stored / exact) ** 0.5 - 1)
    return (above[0], above[1]), (seen[0], seen[1])


def output_step() -> Claim:
    """Finding: the output step."""
    W = abs(complex(weighting("Wk").response(9.6)))
    methods = ("bilinear", "first-order hold")
    rows = [
        (
            f"{f:g}",
            *(
                percent(float(sampled_gain(m, f)) / abs(complex(weighting("Wk").response(f))) - 1)
                for m in methods
            ),
        )
        for f in (1.0, 4.0, 9.6, 15.0, 20.0)
    ]
    pairs = {m: (weighted_at_50_hz(m, False), weighted_at_50_hz(m, True)) for m in methods}
    share, grown = ([100 * x for x in pair] for pair in folded(True))
    off = {m: float(sampled_gain(m, 9.6)) / W - 1 for m in methods}
    return claim(
        "The output step of 0.02 s",
        "Section 4",
        "The output time step was chosen as 0.02, to enhance computational efficiency and "
        "facilitate a reasonable comparison between the results",
        "0.02 s is a reasonable output step",
        FAILS,
        f"weighted at 50 Hz: bilinear {change(pairs['bilinear'][1])}, first-order hold "
        f"{change(pairs['first-order hold'][1])}",
        f"Stored at 50 Hz, nothing above {1 / (2 * OUTPUT_STEP):g} Hz is kept: it folds back. "
        f"In the flexible vehicle {share[0]:.4f} % / {share[1]:.4f} % of the weighted mean square "
        f"lies there, and $a_w$ grows by {grown[0]:.4f} % / {grown[1]:.4f} %: next to "
        "nothing. The harm is done by a filter that runs on such "
        r"samples. Error of its $\lvert W_k \rvert$:",
        Table(**columns("frequency [Hz]", *methods), rows=rows),
        f"At the bending frequency a bilinear filter is {-100 * off['bilinear']:.1f} % low, a "
        f"first-order hold {-100 * off['first-order hold']:.0f} %. The comfort values that would "
        "come of it:",
        comfort_table({"exact": (base(False), base(True)), **pairs}),
        "Which way VAMPIRE weighted, and at which step, is not printed (“based on the time history "
        "of accelerations”).",
    )  # fmt: skip


def peaks() -> Claim:
    """Sampling of Figures 8 to 11."""
    f = TABLE_1["f_bending"].value
    lost = 1 - cos(pi * f * OUTPUT_STEP)
    return claim(
        "Peaks in the zoomed figures",
        "Section 5, on Figures 8 to 11",
        "Peak amplitudes and zoom views indicate that the rigid and flexible models in DYMOLA "
        "generally show good agreement with the VAMPIRE results",
        "peaks in the plots show agreement",
        FAILS,
        "none on r.m.s. values; plotted peaks lose up to "
        f"{100 * lost:.0f} % of their height",
        f"At {OUTPUT_STEP:g} s a second of zoom has {round(1 / OUTPUT_STEP)} points, and a "
        f"vibration of {f:g} Hz {1 / (f * OUTPUT_STEP):.1f} in each of its periods. A peak between "
        rf"two points is cut by up to $1 - \cos(\pi f \Delta t)$ = {100 * lost:.1f} %, and two "
        "programs whose motion differs by a small phase are cut differently.",
        figure("paper_check_sampling", "One second of floor acceleration, exact and as stored "
               "every 0.02 s"),
        "No measure of agreement of the histories, such as a correlation, is printed.",
    )  # fmt: skip
