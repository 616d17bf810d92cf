"""Section 3 of the paper, Eqs (5) and (6), Tables 2 and 3, claim by claim."""

from __future__ import annotations

from math import inf

import numpy as np
import sympy as sp
from check_values import RUNS, Pair, base, comfort_table, percent, runs, shown, values
from check_vehicle import PLACES, along
from claims import FAILS, FOLLOWS, OPEN, Claim, claim, columns, figure
from paper import OUTPUT_STEP, TABLE_2, TABLE_4, coach

from railride import weighting
from railride.markup import Equation, Table, math
from railride.scales import (
    EN_12299_CONTINUOUS,
    ISO_2631_1_ANNEX_C,
    PAPER_TABLE_3,
    Scale,
    classes_of,
)

BANDS = ((0.05, 0.5), (0.5, 4.0), (4.0, 10.0), (10.0, 25.0), (25.0, 80.0))
BASIC = 9.0  # crest factor up to which ISO 2631-1 lets the r.m.s. stand alone


def claims() -> list[Claim]:
    """The claims in their order."""
    return [frequency_range(), middle_of_the_floor(), root_mean_square(), weighting_filter(),
            gain(), parameters(), levels()]  # fmt: skip


def shares(flexible: bool) -> dict[tuple[float, float], Pair]:
    """Band in Hz → share of the weighted mean square."""
    whole = base(flexible)
    found = {}
    for band in BANDS:
        part = values(coach(flexible), band=band)
        found[band] = ((part[0] / whole[0]) ** 2, (part[1] / whole[1]) ** 2)
    return found


def frequency_range() -> Claim:
    """0.5-80 Hz, and what the paper keeps of it."""
    rigid, flexible = shares(False), shares(True)
    rows = [
        (f"{low:g}–{high:g}", *(f"{100 * x:.4f} %" for x in (*rigid[low, high],
                                                           *flexible[low, high])))
        for low, high in BANDS
    ]  # fmt: skip
    heads = ("rigid, 145", "rigid, 200", "flexible, 145", "flexible, 200")
    return claim(
        "The frequency range of 0.5 to 80 Hz",
        "Section 3",
        "According to ISO 2631, a frequency range of 0.5–80 Hz must be considered",
        "0.5–80 Hz must be considered",
        FOLLOWS,
        "less than 0.1 % of the mean square lies outside 0.5–25 Hz, rigid 0.7 %",
        f"That is the standard's range. What is stored every {OUTPUT_STEP:g} s, as in Section 4, "
        f"reaches to {1 / (2 * OUTPUT_STEP):g} Hz: the paper does not consider what it says must "
        "be. Here it would have found next to nothing; shares of the weighted mean square by "
        "frequency (Hz):",
        Table(**columns("band", *heads), rows=rows),
    )


def middle_of_the_floor() -> Claim:
    """One point is not the car."""
    found = along()
    rows = [
        (f"{x:g} m", *(f"{values_at[k]:.4f}" for values_at in found.values()))
        for k, x in enumerate(PLACES)
    ]
    worst = found["beam"]
    return claim(
        "The middle of the car body",
        "Section 3",
        "ISO 2631 states that measurement data gathered from the floor in the middle of the car "
        "body can be used for ride comfort evaluation in rail vehicles",
        "the middle of the floor tells the comfort of the car",
        OPEN,
        f"beam at 145 km/h: middle {worst[0]:.4f}, over a bogie {worst[4]:.4f}, "
        f"end {worst[-1]:.4f}",
        "ISO 2631-1 is known for measuring where vibration enters the person, and EN 12299 for "
        "the middle and both ends of the floor; the standards were not read here, so that what is "
        "permitted is left open. What one point misses can be computed. Along the car at 145 km/h, "
        "m/s², by the distance from the middle:",
        Table(**columns("place", *found), rows=rows),
        "The rigid body rides best in its middle, and so does a flexible one some metres off it. "
        "Neither the best nor the worst seat is where the paper measures.",
    )


def root_mean_square() -> Claim:
    """Eq (5) and whether it may stand alone."""
    crest = max(float(runs(flexible)[1].max()) for flexible in (False, True))
    return claim(
        "Root mean square",
        "Eq (5), Section 3",
        "This evaluation method uses the frequency-weighted r.m.s accelerations",
        "Eq (5) measures the comfort",
        FOLLOWS,
        "none",
        "Eq (5) is the standard's root mean square, and its units agree: m/s² on both sides. It "
        f"may stand alone while the crest factor is below {BASIC:g} (ISO 2631-1), which the paper "
        f"does not check. In {RUNS} runs of 1 km at each speed on ERRI low, rigid and flexible, "
        f"the largest crest factor is {crest:.1f}: it may.",
    )


def in_symbols() -> tuple[sp.Expr, sp.Expr, sp.Symbol]:
    """Eq (6) as printed, ISO's two factors without band limits, and s."""
    s = sp.Symbol("s")
    f3, f4, f5, f6, Q4, Q5, Q6 = sp.symbols("f_3 f_4 f_5 f_6 Q_4 Q_5 Q_6", positive=True)
    w3, w4, w5, w6 = (2 * sp.pi * f for f in (f3, f4, f5, f6))
    step = (s**2 + w5 / Q5 * s + w5**2) / (s**2 + w6 / Q6 * s + w6**2)
    printed = (s + w3) / (s**2 + w4 / Q4 * s + w4**2) * step * 2 * sp.pi * f4**2 / f3
    iso = (1 + s / w3) / (1 + s / (Q4 * w4) + s**2 / w4**2) * step
    return printed, iso, s


def weighting_filter() -> Claim:
    """Finding: Eq (6) lacks the band limits."""
    without = values(coach(False), weight="Wk_paper"), values(coach(), weight="Wk_paper")
    grown = [
        [a / b - 1 for a, b in zip(pair, base(flexible), strict=True)]
        for flexible, pair in enumerate(without)
    ]
    full, printed = weighting("Wk"), weighting("Wk_paper")
    places = (0.1, 0.4, 0.5, 1.0, 9.6, 25.0, 80.0, 100.0)
    rows = [
        (f"{f:g}", *(f"{abs(complex(w.response(f))):.3f}" for w in (printed, full))) for f in places
    ]
    return claim(
        "The weighting filter",
        "Eq (6), Section 3",
        "The weighting filter, according to ISO 2631, for vertical comfort evaluation is as "
        "follows",
        "Eq (6) is the weighting of ISO 2631",
        FAILS,
        f"rigid {shown(without[0])} ({percent(grown[0][0], 2)} / {percent(grown[0][1], 2)}), "
        f"flexible {percent(grown[1][0], 2)} / {percent(grown[1][1], 2)}",
        "The full $W_k$ has two more factors, second-order Butterworth high-pass at 0.4 Hz and "
        r"low-pass at 100 Hz. $\lvert W \rvert$:",
        Table(**columns("frequency [Hz]", "Eq (6)", "ISO 2631-1, full"), rows=rows),
        figure("paper_check_weighting", "The weighting with and without band limits, and sampled "
               "at 50 Hz"),
        "It matters little here, and most on the rigid body, which moves at 1 Hz:",
        comfort_table({"full (railride's default)": (base(False), base(True)), "Eq (6)": without}),
        "railride has both and says which it used; the full one is its default. Whether the "
        "“scheme embedded in the VAMPIRE software” has the band limits cannot be decided.",
    )  # fmt: skip


def gain() -> Claim:
    """The last factor of Eq (6)."""
    printed, iso, s = in_symbols()
    same = sp.simplify(printed / iso) == 1
    still = sp.simplify(printed.subs(s, 0))
    number = (TABLE_2["f5"] / TABLE_2["f6"]) ** 2
    return claim(
        "The gain of the filter",
        "Eq (6), last factor",
        "… · 2πf₄²/f₃",
        "the gain 2πf₄²/f₃ is right",
        FOLLOWS if same else FAILS,
        "none",
        r"The first fraction of Eq (6) has the unit s, the second none, and the gain 1/s: together "
        r"none, as it must be. Its value is $\omega_4^2/\omega_3$, which makes the product equal, "
        "for every $s$, to ISO's factors of unit gain,",
        Equation(
            r"\frac{1 + s/\omega_3}{1 + s/(Q_4 \omega_4) + s^2/\omega_4^2} \cdot "
            r"\frac{s^2 + \omega_5 s/Q_5 + \omega_5^2}{s^2 + \omega_6 s/Q_6 + \omega_6^2}"
        ),
        rf"(compared by symbols). At $s = 0$ it is ${math(still)}$ = {number:.4f}: without the "
        "high-pass, a standing acceleration is felt by half.",
    )


def worst_rounding() -> dict[str, float]:
    """Largest relative distance of Table 2's weighting, with band limits, from ISO's own table."""
    # ISO 2631-1:1997, Table 3, W_k × 1000 at nominal frequencies.
    table = {0.5: 418, 1: 482, 2: 531, 4: 967, 6.3: 1054, 8: 1036, 10: 988, 12.5: 902, 16: 768,
             20: 636, 31.5: 405, 40: 314, 63: 186, 80: 132}  # fmt: skip
    f, listed = np.array(list(table)), np.array(list(table.values())) / 1000
    return {
        name: float(np.abs(np.abs(weighting(name).response(f)) / listed - 1).max())
        for name in ("Wk", "Wk_paper")
    }


def parameters() -> Claim:
    """Table 2."""
    W = weighting("Wk")
    same = all(getattr(W, name) == value for name, value in TABLE_2.items())
    off = worst_rounding()
    return claim(
        "Parameters of the filter",
        "Table 2",
        "Parameters of the vertical frequency weighting filters: 12.50, 12.50, 2.37, 3.35, 0.63, "
        "0.91, 0.91",
        "Table 2 holds the parameters of W_k",
        FOLLOWS if same else FAILS,
        "none",
        f"All seven are ISO 8041-1's. Missing are those of the band limits, $f_1$ = {W.f1:g} Hz, "
        rf"$f_2$ = {W.f2:g} Hz and $Q_1 = Q_2 = 1/\sqrt 2$. Against the table of $W_k$ in ISO "
        f"2631-1 (0.5 to 80 Hz) the computed weighting is within {100 * off['Wk']:.1f} % with band "
        f"limits, and up to {100 * off['Wk_paper']:.0f} % off without.",
    )


def ranges(scale: Scale) -> list[tuple[str, str]]:
    """Labels and limits of a scale."""
    return [
        (c.label, f"{c.low:.3g} and above" if c.high == inf else f"{c.low:.3g}–{c.high:.3g}")
        for c in scale.classes
    ]


def levels() -> Claim:
    """Finding: Table 3 is not ISO 2631's."""
    scales = (PAPER_TABLE_3, EN_12299_CONTINUOUS, ISO_2631_1_ANNEX_C)
    printed = [(row.speed_kmh, name, value) for row in TABLE_4
               for name, value in (("DYMOLA", row.dymola), ("VAMPIRE", row.vampire))]  # fmt: skip
    rows = [
        (f"{name}, {speed:g} km/h", f"{value:.3f}", *classes_of(PAPER_TABLE_3, value),
         ", ".join(classes_of(ISO_2631_1_ANNEX_C, value)))
        for speed, name, value in printed
    ]  # fmt: skip
    lists = [ranges(scale) for scale in scales]
    length = max(map(len, lists))
    side = [
        tuple(cell for listed in lists for cell in (listed[k] if k < len(listed) else ("", "")))
        for k in range(length)
    ]
    return claim(
        "Levels of ride comfort",
        "Table 3",
        "The levels of the ride comfort according to ISO 2631 are given in Table 3",
        "Table 3 gives ISO 2631's levels",
        FAILS,
        "the value stays, its class changes: by Annex C the printed ones are all “not "
        "uncomfortable”",
        "ISO 2631-1, Annex C gives approximate reactions whose ranges overlap; 0.2, 0.3 and 0.4 "
        "are the thresholds of EN 12299's continuous comfort, for 5 s values of another weighting. "
        "Side by side, m/s²:",
        Table(
            (
                "Table 3",
                "m/s²",
                "EN 12299 continuous",
                "m/s², 5 s",
                "ISO 2631-1, Annex C",
                "m/s², W_k",
            ),
            side,
        ),
        "The last labels of Table 3 run backwards: “fairly comfortable” stands below “little "
        "comfortable”, as the worst class. And at 145 km/h its two programs fall into different "
        "classes:",
        Table(
            ("Table 4", "a_wrms", "Table 3", "ISO 2631-1, Annex C"), rows, figures=("a_wrms",)
        ),
        figure("paper_check_levels", "Table 3, EN 12299 and ISO 2631-1 beside the printed values"),
    )  # fmt: skip
