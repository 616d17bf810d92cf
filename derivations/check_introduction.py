"""The paper's abstract and Section 1, claim by claim."""

from __future__ import annotations

from check_values import beam, comfort_table, percent, shown, values
from claims import FAILS, FOLLOWS, OPEN, Claim, claim, columns
from paper import SPEEDS_KMH, TABLE_1, TABLE_4, coach

from railride import Weighting, derive_vehicle, load_vehicle, shipped_vehicles, weighting
from railride.markup import Table

BENDING_HZ = (8.0, 9.0, 9.6, 10.0, 11.0, 12.0)
SEGMENTS = (2, 3, 4, 8)
READ_HZ = (2.0, 3.15, 4.0, 6.3, 8.0, 9.6, 10.0, 12.5, 16.0, 20.0)


def claims() -> list[Claim]:
    """The claims of the abstract and of Section 1 in their order."""
    return [minor_differences(), first_time(), close_to_10_hz(), most_sensitive(),
            partial_differential(), less_accurate()]  # fmt: skip


def over_reading() -> tuple[float, float]:
    """How much more two halves on a polygon floor read than the beam, at 145 and 200 km/h."""
    two, converged = values(coach()), values(beam())
    return two[0] / converged[0] - 1, two[1] / converged[1] - 1


def minor_differences() -> Claim:
    """The abstract's measure of accuracy."""
    beside = [f"{row.dymola:.3f} / {row.vampire:.3f}" for row in TABLE_4]
    printed = [percent(row.dymola / row.vampire - 1) for row in TABLE_4]
    ours = [percent(x) for x in over_reading()]
    speeds = [f"{v:g} km/h" for v in SPEEDS_KMH]
    return claim(
        "Accuracy from minor differences",
        "Abstract",
        "The accuracy of the model is evidenced by the fact that the car body vibration level at "
        "high speeds shows minor differences compared to the results of the VAMPIRE",
        "small differences to VAMPIRE show accuracy",
        FAILS,
        f"two halves with the sensor at the hinge read {ours[0]} / {ours[1]} against a beam",
        "Printed are two numbers for each program. The programs use different bodies, two halves "
        "and a beam, and on one and the same vehicle and track these bodies alone differ by more "
        "than what is called minor:",
        Table(
            **columns("DYMOLA or two halves over VAMPIRE or beam", *speeds),
            rows=[
                ("printed, m/s²", *beside),
                ("printed, ratio", *printed),
                ("computed, two halves (polygon) over beam", *ours),
            ],
        ),
        "Where the bodies alone make a difference of that size, a printed difference of half of it "
        "means that something else differs as well and pulls the other way. Agreement of one "
        "number does not tell accuracy from errors that cancel; which they are cannot be decided "
        "from the paper (structural damping in VAMPIRE would do: [[Structural damping]]).",
    )


def first_time() -> Claim:
    """Priority."""
    return claim(
        "Applied for the first time",
        "Abstract",
        "The approach involving the assembly of rigid bodies is applied for the first time for "
        "high-speed trains",
        "rigid-body assembly is new for high-speed trains",
        OPEN,
        "none",
        "A claim about all other papers: nothing in this one decides it. The two speeds, 145 and "
        "200 km/h, are at most the lower end of what is called high speed.",
    )


def close_to_10_hz() -> Claim:
    """How stiff other car bodies are, and what it would do."""
    sources = {name: load_vehicle(name).body for name in shipped_vehicles()}
    known = [name for name, body in sources.items() if body.bends]
    pairs = {f: values(coach(), f_bending=f) for f in BENDING_HZ}
    low = min(pairs.values(), key=lambda p: p[0])[0]
    high = max(pairs.values(), key=lambda p: p[0])[0]
    return claim(
        "Bending frequencies close to 10 Hz",
        "Section 1",
        "Most rail vehicles have a body-bending frequency close to 10 Hz",
        "most bodies bend close to 10 Hz",
        OPEN,
        f"flexible at 145 km/h: {low:.4f} to {high:.4f} for 8 to 12 Hz",
        f"A statement on all vehicles; the paper gives one. Of the {len(sources)} parameter sets "
        f"from the literature that railride carries, {len(known)} ({', '.join(known)}) gives a "
        "bending frequency at all. What “close to” leaves open matters a great deal: the same "
        "vehicle, its body tuned to other frequencies (the rigid one does not feel it):",
        comfort_table({f"bending at {f:g} Hz": (None, pair) for f, pair in pairs.items()}),
        "The value does not even change in one direction: whether a bending frequency is felt "
        "depends on what the wheelsets let through at that speed.",
    )


def sensitive_band(level: float, w: Weighting | None = None) -> tuple[float, float]:
    """The band in Hz over which |W_k| is at least ``level``, to 0.01 Hz."""
    import numpy as np

    f = np.arange(0.5, 80.0, 0.01)
    inside = f[np.abs((w or weighting("Wk")).response(f)) >= level]
    return float(inside[0]), float(inside[-1])


def most_sensitive() -> Claim:
    """4-10 Hz against W_k."""
    W = weighting("Wk")
    low, high = sensitive_band(0.95)
    rows = [(f"{f:g}", f"{abs(complex(W.response(f))):.3f}") for f in READ_HZ]
    inside = values(coach(), band=(4.0, 10.0))
    share = [100 * (a / b) ** 2 for a, b in zip(inside, values(coach()), strict=True)]
    return claim(
        "Most sensitive from 4 to 10 Hz",
        "Sections 1 and 3",
        "the human body is very sensitive to the frequency range of 4 to 10 Hz",
        "people are most sensitive to 4–10 Hz",
        FOLLOWS,
        f"{share[0]:.0f} % / {share[1]:.0f} % of the flexible mean square lies in 4–10 Hz",
        r"The weighting $W_k$ itself, computed from Table 2 with its band limits:",
        Table(("frequency [Hz]", r"$\lvert W_k \rvert$"), rows, figures=(r"$\lvert W_k \rvert$",)),
        rf"It stays above 0.95 from {low:.2f} to {high:.2f} Hz, so that the claim follows and "
        "could reach a little higher: 12.5 Hz still counts 0.90. The bending mode at 9.6 Hz counts "
        f"{abs(complex(W.response(9.6))):.3f}.",
    )


def partial_differential() -> Claim:
    """A beam by its modes is a few ordinary differential equations."""
    bodies = {"2 segments": coach(), "beam, 1 mode": beam(1), "beam, 3 modes": beam(3),
              "4 segments": coach(segments=4)}  # fmt: skip
    best = values(beam())
    rows = []
    for name, model in bodies.items():
        pair = values(model, floor="smooth")
        dof = len(model.lagrangian.coordinates)
        off = [percent(a / b - 1) for a, b in zip(pair, best, strict=True)]
        rows.append((name, str(dof), str(2 * dof), shown(pair), " / ".join(off)))
    heads = ("degrees of freedom", "first-order equations", "a_wrms [m/s²]", "off the beam")
    one = values(beam(1))
    return claim(
        "Partial against ordinary differential equations",
        "Section 1",
        "this method uses partial differential equations and the solution is more time-consuming "
        "than ordinary differential equations",
        "a beam costs more time than rigid bodies",
        FAILS,
        f"a beam of one mode: {shown(one)}, within "
        f"{100 * max(abs(a / b - 1) for a, b in zip(one, best, strict=True)):.1f} % of ten modes",
        "A free-free beam enters a vehicle model by its modes, each of which is one ordinary "
        "differential equation. With one mode it is of the same size as two halves, and far "
        "nearer to the converged beam, here on the smooth floor that is kindest to the segments:",
        Table(**columns("body", *heads), rows=rows),
        "Matrices of the same size cost a solver the same; times measured for these bodies "
        "stand in railride's README (`railride compare`).",
    )


def less_accurate() -> Claim:
    """Segments against finite elements and the beam."""
    two, best = coach(), values(beam())
    fe = values(derive_vehicle("cati2024", body="fe"))
    readings = {f"{n} segments, polygon floor": values(coach(segments=n)) for n in SEGMENTS}
    readings |= {
        f"{n} segments, smooth floor": values(coach(segments=n), floor="smooth") for n in SEGMENTS
    }
    readings |= {"finite elements, 10 modes": fe, "free-free beam, 10 modes": best}
    off = [percent(a / b - 1, 0) for a, b in zip(values(two), best, strict=True)]
    rows = [
        (name, f"{pair[0]:.4f}", f"{pair[1]:.4f}",
         " / ".join(percent(a / b - 1) for a, b in zip(pair, best, strict=True)))
        for name, pair in readings.items()
    ]  # fmt: skip
    return claim(
        "Less accurate than finite elements and beams",
        "Section 1",
        "The assembling of rigid bodies is not as accurate a method as the finite element and beam "
        "methods in calculating the body dynamic displacements",
        "rigid bodies are less accurate than beam or finite elements",
        FOLLOWS,
        f"two halves {shown(values(two))} against {shown(best)}: {off[0]} / {off[1]}",
        f"All bodies tuned to the same {TABLE_1['f_bending'].text}, middle of the floor:",
        Table(
            **columns("body", "145 km/h", "200 km/h", "off the beam"),
            rows=rows,
        ),
        "“Within a moderate accuracy range” holds from four segments on, if the floor is read as "
        "a smooth line through the segments; read at the hinge of two halves, as in the paper, it "
        "does not.",
    )
