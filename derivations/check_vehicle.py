"""Sections 2, 2.1 and 2.2 of the paper and its Table 1, claim by claim."""

from __future__ import annotations

from math import pi

import numpy as np
import sympy as sp
from check_integration import euler_cromer_growth
from check_values import (
    Pair,
    base,
    beam,
    both,
    change,
    comfort_table,
    percent,
    shown,
    values,
)
from claims import FAILS, FOLLOWS, OPEN, Claim, claim, columns, figure
from paper import (
    DYMOLA_DOF,
    READINGS,
    SPEEDS_KMH,
    TABLE_1,
    TRACK,
    VAMPIRE_DOF,
    coach,
    coach_of_inertia,
)

from railride import KMH, modes, stochastic_ride, third_octaves, weighting
from railride.lagrange import Coordinate
from railride.markup import Equation, Table, math
from railride.modal import undamped_frequencies
from railride.units import parse_quantity

TRACK_STIFFNESS = (40e6, 100e6, 200e6)  # N/m under one wheelset, both rails: soft, usual, stiff
PLACES = (0.0, 2.0, 4.0, 6.0, 8.75, 10.0, 12.0)  # m off the middle
NEAR_HZ = (9.4, 9.5, 9.6, 9.7, 9.8)


def claims() -> list[Claim]:
    """The claims in their order."""
    return [time_history(), track_stiffness(), degrees_of_freedom(), units(),
            primary_damping(), per_axle(), body_inertia(), bending_frequency(), sensor(),
            horizontal(), validated()]  # fmt: skip


def by_third_octaves() -> Pair:
    """a_w = √(Σ (W_i a_i)²) over the third octaves of 0.5 to 80 Hz, flexible vehicle."""
    found = []
    for v in SPEEDS_KMH:
        table = third_octaves(coach(), v * KMH, TRACK, floor="polygon")
        table = table[table["band [Hz]"].between(0.5, 80)]
        W = np.abs(weighting("Wk").response(table["midband [Hz]"].to_numpy()))
        found.append(float(np.sqrt(np.sum((W * table["a_rms [m/s^2]"].to_numpy()) ** 2))))
    return found[0], found[1]


def time_history() -> Claim:
    """The frequency domain gives the same value."""
    pair = by_third_octaves()
    return claim(
        "A time history is required",
        "Section 2",
        "the ride comfort analysis in ISO 2631-1 standard requires the time history of "
        "accelerations from the middle of the car body’s floor",
        "ISO 2631-1 requires a time history",
        FAILS,
        f"from third octaves instead: {change(pair)}",
        r"The weighted r.m.s. of a stationary ride is an integral over its spectrum, "
        r"$a_w^2 = \int \lvert W_k \rvert^2 S_a \thinspace df$, and, as is commonly done, a sum "
        r"over third octaves, $a_w^2 = \sum_i (W_i a_i)^2$:",
        Table(
            **columns("flexible vehicle", "145 km/h", "200 km/h"),
            rows=[
                ("integral over 0.05–80 Hz", *(f"{x:.4f}" for x in base(True))),
                ("third octaves, 0.5–80 Hz", *(f"{x:.4f}" for x in pair)),
            ],
        ),
        "A time history is needed for peaks and running values alone, neither of which the paper "
        "gives. (The wording of ISO 2631-1 was not read for this document.)",
    )


def track_stiffness() -> Claim:
    """A track spring in series with the primary suspension, without the wheelset's mass."""
    k_1, c_1 = TABLE_1["k_1"].value, 30e3
    rows = {"rigid track": (base(False), base(True))}
    for k_t in TRACK_STIFFNESS:
        part = k_t / (k_t + k_1)
        rows[f"{k_t / 1e6:g} MN/m under a wheelset"] = both(k_1=part * k_1, c_1=part**2 * c_1)
    soft = [a / b - 1 for a, b in zip(list(rows.values())[1][1], base(True), strict=True)]
    return claim(
        "Track and wheel stiffness",
        "Section 2 and, in other words, Section 4",
        "it was assumed that track and wheel stiffness had a negligible effect on the vertical "
        "ride comfort analysis",
        "track stiffness does not matter",
        OPEN,
        f"on the softest track: {percent(soft[0])} / {percent(soft[1])}, flexible",
        "The paper gives no stiffness of its track. An estimate, with stiffnesses that are "
        r"assumed: a spring $k_t$ in series with $k_1$ and $c_1$ leaves "
        r"$k_1 k_t / (k_t + k_1)$ and, to first order, $c_1 k_t^2 / (k_t + k_1)^2$ "
        "(the mass of the wheelset left out, which resonates with the track well above 20 Hz):",
        comfort_table(rows),
        "The estimate supports the assumption for usual tracks, and is no proof.",
    )


def degrees_of_freedom() -> Claim:
    """Six and eight."""
    counted = {flexible: len(coach(flexible).lagrangian.coordinates) for flexible in (False, True)}
    rows = [
        ("bodies, 3 each in the plane", "9", "12"),
        ("hinge between the halves", "0", "−2"),
        ("held along the track", "−3", "−3"),
        ("degrees of freedom", "6", "7"),
        ("coordinates of railride's model", *(str(counted[f]) for f in (False, True))),
        ("printed", *(str(DYMOLA_DOF[f]) for f in (False, True))),
    ]
    return claim(
        "Six and eight degrees of freedom",
        "Section 2",
        "The rigid DYMOLA model, in the first phase, had six rigid degrees of freedom. … a DYMOLA "
        "model with eight rigid degrees of freedom … was created",
        "the flexible vehicle has eight degrees of freedom",
        FAILS,
        "none: an eighth would not be felt vertically",
        "A hinge adds one body and takes two of its three freedoms away, so that the flexible "
        "vehicle has one degree of freedom more than the rigid one:",
        Table(**columns("count", "rigid", "flexible"), rows=rows),
        "The bodies are car body or halves, and two bogies, the wheelsets following the rail; held "
        "along the track are the car body and each bogie. Were the car body free along the track "
        "the count would be eight, but then seven for the rigid one, and the additional mode would "
        "have no restoring force (0 Hz) and, in the linear model, no part in vertical motion.",
    )


def read_units() -> dict[str, float]:
    """Symbol → printed value of Table 1 in SI, read with its printed unit.

    Raises
    ------
    QuantityError : a unit that is not of the quantity's dimension.
    """
    powers = {" × 10⁵": "e5", " × 10⁶": "e6", ",": ""}
    found = {}
    for symbol, printed in TABLE_1.items():
        text = printed.text
        for old, new in powers.items():
            text = text.replace(old, new)
        found[symbol] = parse_quantity(text, printed.unit)
    return found


def units() -> Claim:
    """Dimensions of Table 1."""
    read = read_units()
    right = sum(read[symbol] == printed.value for symbol, printed in TABLE_1.items())
    return claim(
        "Units of Table 1",
        "Table 1",
        "Geometrical and physical parameters of the rail vehicle.",
        "the units of Table 1 are those of its quantities",
        FOLLOWS if right == len(TABLE_1) else FAILS,
        "none",
        f"Read with the printed units, {right} of {len(TABLE_1)} values have the dimension of "
        "their quantity: a stiffness is a force per length, of the torsional spring a moment per "
        "angle, and so on. That a dimension is right does not make a value right: see "
        "[[Primary damping]].",
    )


def printed_damping() -> dict[str, tuple[float, float]]:
    """Of the bogie heave mode as read, and of the locked one: frequency (Hz), damping ratio."""
    k, m = 2 * TABLE_1["k_1"].value + TABLE_1["k_2"].value, TABLE_1["m_b"].value
    omega = (k / m) ** 0.5
    found = {}
    for name, c_1 in (("read as 30 kN·s/m", 30e3), ("printed, 30,000 kN·s/m", 30e6)):
        c = 2 * c_1 + TABLE_1["c_2"].value
        found[name] = (omega / (2 * pi), c / (2 * m * omega))
    return found


def bogie_heave() -> tuple[float, float]:
    """Frequency (Hz, |λ|/2π) and damping ratio of the rigid vehicle's first bogie heave mode."""
    mode = next(mode for mode in modes(coach(False)) if mode.label == "bogie heave")
    return mode.frequency_hz, mode.damping_ratio


def primary_damping() -> Claim:
    """Finding: the printed value locks the primary suspension."""
    f, zeta = bogie_heave()
    by_hand = printed_damping()
    locked = both(c_1=TABLE_1["c_1"].value)
    slow = TABLE_1["k_1"].value / TABLE_1["c_1"].value / (2 * pi)
    rows = [
        (name, f"{hz:.2f}", f"{ratio:.3g}", f"{euler_cromer_growth(c):.3f}")
        for (name, (hz, ratio)), c in zip(by_hand.items(), (30e3, 30e6), strict=True)
    ]
    return claim(
        "Primary damping",
        "Table 1",
        "c₁—damping of the primary suspension 30,000 kN·s/m",
        "the primary damping is 30,000 kN·s/m",
        FAILS,
        f"as printed: rigid {shown(locked[0])}, flexible {change(locked[1])}",
        r"A bogie alone between track and car body, $\omega = \sqrt{(2 k_1 + k_2)/m_b}$ and "
        r"$\zeta = (2 c_1 + c_2)/(2 m_b \omega)$, and the largest growth of any motion of the "
        "flexible vehicle in one step of 1 ms of the Euler–Cromer method, which Section 4 says "
        "VAMPIRE used:",
        Table(
            **columns("primary damping", "heave [Hz]", r"$\zeta$", r"$\lvert z \rvert$ per step"),
            rows=rows,
        ),
        f"With the printed value the suspension is locked above {slow:.3f} Hz "
        r"($k_1/(2\pi c_1)$), bogie and wheelsets are one, and an explicit step of 1 ms multiplies "
        "an error by more than forty: that value cannot have run. A factor of a thousand too much, "
        f"N for kN, gives 30 kN·s/m and ζ = {zeta:.2f} at {f:.1f} Hz in the whole (rigid) vehicle, "
        "an ordinary primary damper: railride's reading, here as everywhere.",
        comfort_table({"read, 30 kN·s/m": (base(False), base(True)), "printed": locked}),
    )


def heaves() -> dict[str, float]:
    """Reading → undamped heave frequency of the rigid vehicle, Hz."""
    readings = dict(list(READINGS.items())[2:])
    readings = {"per axle, per bogie (railride's)": {}} | readings
    return {
        name: float(undamped_frequencies(coach(False).matrices(**changes))[0])
        for name, changes in readings.items()
    }


def per_axle() -> Claim:
    """Finding: what one spring belongs to is not printed."""
    hz = heaves()
    doubled = [both(**changes) for changes in list(READINGS.values())[2:]]
    rows = dict(zip(hz, [(base(False), base(True)), *doubled], strict=True))
    return claim(
        "What a spring belongs to",
        "Table 1",
        "k₁—stiffness of the primary suspension 5000 kN/m … k₂—stiffness of the secondary "
        "suspension 750 kN/m",
        "suspension values per axle, per bogie, or per side",
        OPEN,
        f"k₁, c₁ doubled {shown(doubled[0][1])}; k₂, c₂ doubled {shown(doubled[1][1])}, flexible",
        "The table does not say whether a value is that of one spring, of an axle or bogie, or of "
        "one side. The heave frequency that follows is the only help:",
        Table(
            **columns("reading", "heave [Hz]"),
            rows=[(name, f"{f:.4f}") for name, f in hz.items()],
        ),
        "About 1 Hz is what a passenger coach has, so railride reads $k_1$, $c_1$ per axle and "
        "$k_2$, $c_2$ per bogie. The heave tells the secondary suspension but hardly the primary.",
        comfort_table(rows),
    )


def body_inertia() -> Claim:
    """Finding: Table 1's I_c is no rod's."""
    m, L, I_c = (TABLE_1[name].value for name in ("m_c", "L", "I_c"))
    own = coach_of_inertia()
    as_rods = coach().changed(k_theta=TABLE_1["k_theta"].value)
    rods, own_hz = (float(b.bending_frequencies()[0]) for b in (as_rods, own))
    pair = values(own)
    return claim(
        "Pitch inertia of the car body",
        "Table 1 against Section 2.3",
        "I_c—car body moment of inertia 1.7 × 10⁶ kg·m² … two rigid masses (long and slender beam) "
        "with their moments of inertia",
        "Table 1's inertia is that of slender rods",
        FAILS,
        f"halves with Table 1's inertia and spring: {change(pair)}",
        rf"Slender rods together have $m_c L^2/12$ = {m * L**2 / 12 / 1e6:.3f} × 10⁶ kg·m², "
        rf"{percent(m * L**2 / 12 / I_c - 1)} off the printed {I_c / 1e6:g} × 10⁶ kg·m². "
        "Halves whose own inertia makes up for the printed one bend at another frequency on the "
        "same spring:",
        Table(
            **columns("two halves, Table 1's joint stiffness, free", "first bending [Hz]"),
            rows=[
                ("slender rods, as in Eq (2)", f"{rods:.3f}"),
                ("own inertia, so that the body has Table 1's", f"{own_hz:.2f}"),
            ],
        ),
        "Only the rods agree with the printed 9.6 Hz, so railride takes rods. The rigid vehicle "
        "uses the printed inertia as it is.",
        comfort_table(
            {
                "rods tuned to 9.6 Hz": (base(False), base(True)),
                "Table 1's inertia and joint stiffness": (base(False), pair),
            }
        ),
    )


def bending_frequency() -> Claim:
    """Free or on the suspension, and what lies beside it."""
    A = coach().matrices()
    undamped = [f for f in undamped_frequencies(A) if 9 < f < 10]
    rows = [
        (mode.label, f"{mode.frequency_hz:.3f}", f"{mode.damping_ratio:.3f}")
        for mode in modes(coach()) if 9 < mode.frequency_hz < 10
    ]  # fmt: skip
    near = {f"body tuned to {f:g} Hz": (None, values(coach(), f_bending=f)) for f in NEAR_HZ}
    ends = [list(near.values())[k][1] for k in (0, -1)]
    return claim(
        "9.6 Hz, free or on the suspension",
        "Table 1 and Section 2.2",
        "The frequency of the first bending mode of the car body was 9.6 Hz, which was embedded in "
        "the VAMPIRE model",
        "the body's first bending mode is at 9.6 Hz",
        OPEN,
        f"tuned to 9.4 Hz {shown(ends[0])}, to 9.8 Hz {shown(ends[1])}, flexible",
        "Free in space, or in the vehicle? It is not said. railride takes the free body. In the "
        "vehicle the mode then has company, which the paper does not mention: the bogies' heave "
        "on these springs lies at the same frequency.",
        Table(
            ("mode in the flexible vehicle", "frequency [Hz]", "damping ratio"),
            rows,
            figures=("frequency [Hz]", "damping ratio"),
        ),
        f"Without damping the three would be {', '.join(f'{f:.4f}' for f in undamped)} Hz, each a "
        "mixture of bending and bogie heave. Which of them “the bending mode” is would be a matter "
        "of words; two tenths of a hertz are not, in the comfort value:",
        comfort_table(near),
    )


def along() -> dict[str, list[float]]:
    """Body → a_wrms at 145 km/h at PLACES."""
    bodies = {
        "rigid": (coach(False), "polygon"),
        "two halves, polygon": (coach(), "polygon"),
        "beam": (beam(), "smooth"),
    }
    return {
        name: stochastic_ride(
            model, SPEEDS_KMH[0] * KMH, TRACK, PLACES, floor=floor
        ).a_wrms.tolist()
        for name, (model, floor) in bodies.items()
    }


def sensor() -> Claim:
    """The sensor at the hinge."""
    two, smooth, best = values(coach()), values(coach(), floor="smooth"), values(beam())
    off = [
        (name, *(f"{x:.4f}" for x in pair), *(percent(a / b - 1) for a, b in zip(pair, best,
                                                                                strict=True)))
        for name, pair in (("at the hinge (the paper's)", two), ("smooth floor", smooth),
                           ("beam", best))
    ]  # fmt: skip
    return claim(
        "The sensor in the centre of the car body",
        "Section 2.1",
        "A virtual absolute acceleration sensor was placed in the center of the car body",
        "the sensor in the centre measures the floor",
        FAILS,
        f"at the hinge {shown(two)}, converged {shown(best)}",
        "The centre of two halves is their hinge, the point of a kink. A smooth floor of the same "
        r"mean height over each half passes $\kappa \ell^2/12$ nearer to the straight line there "
        r"($\kappa$ the curvature, $\ell$ the length of a half), so the hinge moves more than the "
        "floor that it stands for:",
        Table(
            **columns(
                "flexible vehicle, middle",
                "145 km/h",
                "200 km/h",
                "off the beam, 145",
                "off the beam, 200",
            ),
            rows=off,
        ),
        figure(
            "paper_check_floor",
            "The hinge of two halves and the floor it stands for, and "
            "the weighted acceleration along the car",
        ),
        "VAMPIRE's beam has no kink. This alone would put DYMOLA above VAMPIRE by more than twice "
        "what Table 4 prints.",
    )


def horizontal() -> Claim:
    """Prismatic joints on both sides."""
    L_h = sp.Symbol("L_h", positive=True)
    theta = Coordinate("theta")
    distance = 2 * L_h * sp.cos(theta)
    expanded = sp.series(distance, theta, 0, 3).removeO()
    return claim(
        "Prismatic joints on both sides",
        "Section 2.1",
        "Prismatic joints on both sides of the car body were used to limit movement in the "
        "horizontal direction",
        "both ends of the body are limited horizontally",
        OPEN,
        "none in the linear model; locked would be the rigid values",
        "The distance of the ends along the track, the halves turned by ±θ:",
        Equation(rf"d = {math(distance)} = {math(expanded)} + \dots"),
        "Held apart at both ends, it cannot shorten: such a body cannot bend at all in a nonlinear "
        "program. Eq (1) is the opposite, its rear end slides along the track while both ends are "
        "held in height; a vehicle on springs has neither. What stood in the model cannot be told "
        "from the paper. railride holds the middle of the body along the track, once.",
    )


def validated() -> Claim:
    """VAMPIRE's 47 degrees of freedom and reference 18."""
    return claim(
        "The VAMPIRE model",
        "Section 2.2",
        "The three-dimensional model of the vehicle, with 47 DoF in VAMPIRE",
        "a validated model of 47 degrees of freedom",
        OPEN,
        "none that can be computed",
        f"Seven rigid bodies (car body, two bogies, four wheelsets) have 7 · 6 = {7 * 6} degrees "
        f"of freedom; the other {VAMPIRE_DOF - 42} may be modes of the body or not. Its damping, "
        "suspension and beam are not printed, and its vehicle and track are of a library that is "
        "not public. That VAMPIRE is validated rests on reference 18, which is also given for the "
        "body of rigid parts (Section 1) and for negligible structural damping (Section 2.3): one "
        "reference for three unlike statements. That the track's gauge is "
        "1435 mm is the standard gauge, and follows.",
    )
