"""Section 5 of the paper, its conclusions and recommendations, claim by claim."""

from __future__ import annotations

from functools import cache

import numpy as np
import sympy as sp
from check_results import MAP_KMH, over_speed
from check_values import Pair, base, beam, percent, shown, values
from claims import FAILS, FOLLOWS, OPEN, Claim, claim, columns
from paper import SPEEDS_KMH, TRACK, coach

from railride import KMH, spectrum, track_response
from railride.lagrange import Coordinate, Input, Lagrangian
from railride.linear import LinearModel, linearise
from railride.markup import Equation, Table, math

MORE = (2, 4, 8, 16)
OVER_BOGIE = 8.75  # m


def claims() -> list[Claim]:
    """The claims in their order."""
    return [accuracy_ensured(), underestimates(), correlation(), three_dimensional(), two_parts(),
            open_source(), frequency_response(), robustness()]  # fmt: skip


@cache
def masking_damping() -> tuple[float, Pair]:
    """Structural damping with which two halves read the undamped beam's value at 145 km/h."""
    from scipy.optimize import brentq

    target = values(beam())[0]
    ratio = brentq(lambda z: values(coach(), zeta_bending=z)[0] - target, 0.0, 0.02, xtol=1e-9)
    return float(ratio), values(coach(), zeta_bending=ratio)


def accuracy_ensured() -> Claim:
    """Errors that cancel."""
    ratio, masked = masking_damping()
    best = values(beam())
    off = [percent(a / b - 1) for a, b in zip(masked, best, strict=True)]
    return claim(
        "Accuracy ensured by agreement",
        "Section 5",
        "Accuracy is ensured by the fact that the a_wrms values and general vibration trends in "
        "the DYMOLA model are in good agreement with the VAMPIRE model",
        "agreement of a_wrms ensures accuracy",
        FAILS,
        f"two halves with {100 * ratio:.2f} % damping: {shown(masked)} ({off[0]} / {off[1]} of "
        "an undamped beam)",
        "Two errors can agree. Two halves, read at the hinge, with a structural damping that "
        "nobody gave them, against the beam without any:",
        Table(
            **columns("flexible vehicle", "145 km/h", "200 km/h"),
            rows=[
                ("beam, undamped", *(f"{x:.4f}" for x in best)),
                ("two halves, undamped", *(f"{x:.4f}" for x in base(True))),
                (f"two halves, {100 * ratio:.2f} % damping", *(f"{x:.4f}" for x in masked)),
            ],
        ),
        "The last row would pass every test of the paper, with a wrong floor and a wrong damping. "
        "VAMPIRE, moreover, is another model and not a measurement.",
    )


def least_ratio() -> tuple[float, float]:
    """Smallest flexible over rigid value from 60 to 300 km/h, and the speed in km/h."""
    found = over_speed()
    ratio = found["two halves"] / found["rigid"]
    k = int(ratio.argmin())
    return float(ratio[k]), MAP_KMH[k]


def underestimates() -> Claim:
    """Finding: the conclusion rests on values that are not printed."""
    least, speed = least_ratio()
    places = {"middle": 0.0, "6 m off it": 6.0, "over a bogie": OVER_BOGIE, "end": 12.0}
    rows = []
    for name, x in places.items():
        rigid, flexible = values(coach(False), at=x), values(beam(), at=x)
        ratio = [f"{b / a:.2f}" for a, b in zip(rigid, flexible, strict=True)]
        rows.append((name, shown(rigid), shown(flexible), " / ".join(ratio)))
    times = [b / a for a, b in zip(base(False), base(True), strict=True)]
    return claim(
        "A rigid car body underestimates",
        "Section 5",
        "modeling a rigid car body for the ride comfort analysis yields underestimated results, "
        "which is consistent with previous studies",
        "a rigid body underestimates",
        OPEN,
        f"rigid {shown(base(False))}, flexible {times[0]:.1f} / {times[1]:.1f} times as much",
        "The rigid a_wrms on which this rests is never printed. Computed on ERRI low it follows, "
        "in the middle of the floor by a factor of five, and for the two halves by "
        f"{least:.2f} at least from 60 to 300 km/h (at {speed:g} km/h). Elsewhere it is less:",
        Table(**columns("place", "rigid", "beam", "ratio"), rows=rows),
    )


@cache
def largest_correlation(flexible: bool) -> Pair:
    """Largest |ρ| of track level and floor acceleration over all delays, at both speeds."""
    step = 5e-4
    f = np.arange(0.05, 80.0, step)
    count = 1 << 19
    found = []
    for v in SPEEDS_KMH:
        model = coach(flexible)
        H = track_response(model, model.floor(0.0, "polygon"), v * KMH, f)[0]
        per_hertz = 2 * np.pi / (v * KMH)
        S = per_hertz * spectrum(TRACK).density(per_hertz * f)
        lines = np.zeros(count // 2 + 1, dtype=complex)
        lines[round(f[0] / step) : round(f[0] / step) + f.size] = np.conj(H) * S
        cross = np.fft.irfft(lines, count) * count / 2
        found.append(float(np.abs(cross).max() / np.sqrt(S.sum() * (np.abs(H) ** 2 * S).sum())))
    return found[0], found[1]


def correlation() -> Claim:
    """Track and vibration."""
    rows = [
        (name, *(f"{x:.2f}" for x in largest_correlation(flexible)))
        for name, flexible in (("rigid", False), ("two halves", True))
    ]
    return claim(
        "Correlation of track and vibration",
        "Section 5",
        "there is a strong correlation between the track irregularity and vibration trends in both "
        "models, indicating the accuracy of the models",
        "track and vibration correlate, which shows accuracy",
        FAILS,
        "none",
        "No correlation is printed. Computed, between the level under the leading wheelset and the "
        "floor's acceleration, the largest over all delays:",
        Table(**columns("vehicle", "145 km/h", "200 km/h"), rows=rows),
        "It is weak, because the level consists of long waves and the acceleration of short ones. "
        "Nor could it tell an accurate model from another: in a linear model with one track every "
        "output follows from it, whatever the parameters; coherence is one at every frequency.",
    )


@cache
def rolling_body() -> LinearModel:
    """A body on springs and dampers at ±b, each over its own rail: heave z and roll φ."""
    m, J, k, c, b = sp.symbols("m J k c b", positive=True)
    z, phi = Coordinate("z"), Coordinate("phi")
    rails = [Input("w_l"), Input("w_r")]
    stretch = [z + b * sp.sin(phi) - rails[0], z - b * sp.sin(phi) - rails[1]]
    rates = [z.dot + b * phi.dot - rails[0].dot, z.dot - b * phi.dot - rails[1].dot]
    return linearise(
        Lagrangian(
            [z, phi],
            m * z.dot**2 / 2 + J * phi.dot**2 / 2,
            sp.Add(*(k * s**2 / 2 for s in stretch)),
            sp.Add(*(c * s**2 / 2 for s in rates)),
            inputs=rails,
        )
    )


def three_dimensional() -> Claim:
    """Symmetric vehicles: heave and roll do not feel each other."""
    found = rolling_body()
    return claim(
        "Three-dimensional against two-dimensional",
        "Section 5",
        "there are differences … that may result from variances in modeling approach. "
        "Specifically, the VAMPIRE model is three-dimensional, while Dymola is two-dimensional",
        "the third dimension may explain the difference",
        FAILS,
        "none for a symmetric linear vehicle",
        r"In a vehicle that is the same left and right, heave $z$ and roll $\phi$ do not feel each "
        "other. A body on springs and dampers at ±b over two rails:",
        Equation(
            rf"K = {math(found.K.applyfunc(sp.factor))}, \qquad "
            rf"K_w = {math(found.K_w.applyfunc(sp.factor))}"
        ),
        "No entry couples the two, and only the mean of the rails drives heave. In the middle of "
        "the floor, between left and right, roll is not felt. So a linear plane model on the mean "
        "of both rails gives what the spatial one gives there. What is left are non-linear "
        "suspensions, or rails averaged otherwise, of which the paper prints nothing (it says that "
        "linear components are used); the bodies, halves and beam, do explain a difference.",
    )


def two_parts() -> Claim:
    """More parts."""
    best = values(beam())
    rows = []
    for n in MORE:
        pair = values(coach(segments=n))
        rows.append((str(n), *(f"{x:.4f}" for x in pair),
                     *(percent(a / b - 1) for a, b in zip(pair, best, strict=True))))  # fmt: skip
    heads = ("145 km/h", "200 km/h", "off the beam, 145", "off the beam, 200")
    first = [percent(a / b - 1) for a, b in zip(base(True), best, strict=True)]
    return claim(
        "Two parts oversimplify, more are more realistic",
        "Section 5, recommendations",
        "the car body in DYMOLA is divided into two parts, which may lead to a somewhat "
        "oversimplification … The car body can be divided into more parts",
        "two parts are few, more are better",
        FOLLOWS,
        f"two parts {first[0]} / {first[1]} off the beam, at the hinge",
        "Read at the hinge in the middle, by the number of segments:",
        Table(**columns("segments", *heads), rows=rows),
        f"against {shown(best)} of the beam. Reading the floor as a smooth line does more than "
        "further segments: [[Less accurate than finite elements and beams]].",
    )


def open_source() -> Claim:
    """DYMOLA against MODELICA."""
    return claim(
        "Open-source software",
        "Section 5, against the Abstract and Section 2.1",
        "Using DYMOLA or MODELICA, which is open-source (white box) software",
        "DYMOLA or MODELICA is open-source",
        FAILS,
        "none",
        "Of MODELICA, a language, yes. DYMOLA is by the paper's own abstract “a commercial "
        "object-oriented modeling (OOM) software”. That combining libraries “is not possible in "
        "VAMPIRE” (Section 2.1) cannot be decided from the paper.",
    )


@cache
def resonance(damping: float) -> tuple[float, float]:
    """Largest |H| from the track to the floor above 5 Hz at 200 km/h, and its frequency, Hz."""
    f = np.arange(5.0, 20.0, 0.001)
    floor = coach().floor(0.0, "polygon")
    H = np.abs(track_response(coach(), floor, SPEEDS_KMH[1] * KMH, f, zeta_bending=damping)[0])
    return float(H.max()), float(f[H.argmax()])


def frequency_response() -> Claim:
    """The recommendation on frequency responses."""
    ratios = (0.0, 0.005, 0.01, 0.015, 0.02)
    rows = [
        (f"{100 * z:g} %", f"{resonance(z)[1]:.2f}", f"{resonance(z)[0]:.0f}",
         f"{values(coach(), zeta_bending=z)[1]:.4f}")
        for z in ratios
    ]  # fmt: skip
    heads = ("at [Hz]", "largest magnitude [1/s²]", "a_wrms at 200 km/h [m/s²]")
    return claim(
        "Frequency response",
        "Section 5, recommendations",
        "The frequency response analysis of the model can provide valuable information about the "
        "body flexibility … the damping ratio can be adjusted with the help of frequency response "
        "analysis",
        "a frequency response tells bending and damping",
        FOLLOWS,
        "it tells what no claim above could: which damping a program used",
        "From the elevation under the leading wheelset to the acceleration in the middle of the "
        "floor, flexible vehicle at 200 km/h:",
        Table(**columns("structural damping", *heads), rows=rows),
        "Frequency and height of the resonance would have told the two programs' bending "
        "frequencies and dampings apart; two r.m.s. values do not.",
    )


def robustness() -> Claim:
    """One vehicle, one track, two speeds."""
    return claim(
        "Robustness for several cases",
        "Section 5, recommendations",
        "the robustness of the model for several cases were demonstrated with the experimentally "
        "validated VAMPIRE model",
        "robustness was demonstrated",
        OPEN,
        "none",
        "Compared were one vehicle, one kilometre of one track and two speeds, with two printed "
        "values each. No parameter was varied. How far the value goes when one is, is shown above: "
        "by the bending frequency, by structural damping, by the reading of the suspension.",
    )
