"""Second half of the reproduction: what could make the two programs differ, and what did not.

Chapters are blocks of :mod:`railride.markup`; every number in them is computed.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from check_integration import sampled_gain
from paper import SPEEDS_KMH, TABLE_1
from reproduction_cases import BEAM_MODES, printed_gap
from reproduction_errors import RATES, SEEDS, converged_step, exact_response
from reproduction_gap import (
    COINCIDENCE,
    CONVERGED,
    DAMPING,
    FLOORS,
    SEGMENTS,
    Difference,
    alone,
    beam_limit,
    damping_study,
    nearest,
    segment_study,
    with_the_halves,
)
from reproduction_results import STANDS_FOR, percent, picture, table

from railride import weighting
from railride.markup import Block, Heading, Paragraph
from railride.numeric import Array


def the_body() -> list[Block]:
    """Segments, floors and structural damping."""
    study, limit, damped = segment_study(), beam_limit(), damping_study()
    rows = [
        [str(n), *(text for floor in FLOORS for k in (0, 1) for text in
                   (f"{study[floor][n][k]:.4f}", percent(study[floor][n][k] / limit[k] - 1, 2)))]
        for n in SEGMENTS
    ]  # fmt: skip
    rows.append(["beam", *(x for _ in FLOORS for k in (0, 1) for x in (f"{limit[k]:.4f}", ""))])
    heads = ["N", *(f"{floor}, {speed:g} km/h{tail}" for floor in FLOORS for speed in SPEEDS_KMH
                    for tail in ("", " to beam"))]  # fmt: skip
    percents = [
        [f"{100 * zeta:g} %", *(f"{damped[body][i, k]:.4f}" for body in damped for k in (0, 1)),
         *(percent(damped["halves"][i, k] / damped["beam"][i, k] - 1) for k in (0, 1))]
        for i, zeta in enumerate(DAMPING)
    ]  # fmt: skip
    return [
        Heading("The gap: number of segments, floor, structural damping"),
        Paragraph(
            "Exact values on ERRI low, m/s². At the hinge (even N) the polygon over-reads, at the "
            "middle of a segment (odd N) it under-reads; the smooth floor is within 1 % of the "
            "beam from N = 4 on. The printed gap lies between two and four segments at 145 km/h "
            "and between four and six at 200 km/h, and no N gives both: what a polygon over-reads "
            "hardly depends on speed, and the printed gap halves from 145 to 200 km/h. The beam "
            f"of this table is the limit, of {CONVERGED} bending modes; the one that stands for "
            f"VAMPIRE has {BEAM_MODES} and is off it by {max(abs(damped['beam'][0] - limit)):.4f} "
            "m/s² at most."
        ),
        table(heads, rows),
        picture("segments", "from two halves to the beam"),
        Paragraph(
            "Structural damping, the same in both, leaves the ratio of halves to beam where it is; "
            "two per cent of it takes "
            f"{100 * (1 - damped['halves'][-1, 1] / damped['halves'][0, 1]):.0f} to "
            f"{100 * (1 - damped['halves'][-1, 0] / damped['halves'][0, 0]):.0f} % off the values. "
            'It is the largest unknown of the paper, which calls it "negligible":'
        ),
        table(["ζ", *(f"{STANDS_FOR[body]}, {speed:g} km/h" for body in damped
                      for speed in SPEEDS_KMH), *(f"halves to beam, {v:g} km/h"
                                                for v in SPEEDS_KMH)],
              percents),
        picture("damping", "structural damping takes more than any other difference"),
    ]  # fmt: skip


def the_gap(
    numerics: Sequence[Difference], grid: dict[tuple[float, float], Array], scatter: Array
) -> list[Block]:
    """Every difference alone and on top of the halves."""
    differences = [*alone(), *numerics]
    halves = differences[0]
    on_top = {d.name.split("; ", 1)[1]: d for d in with_the_halves()}
    on_top |= {d.name: halves.and_also(d) for d in numerics}
    rows = [
        [str(n), d.name, d.kind, *map(percent, d.gap),
         *(map(percent, on_top[d.name].gap) if d.name in on_top else ("", "")),
         _verdict(d, on_top.get(d.name))]
        for n, d in enumerate(differences, start=1)
    ]  # fmt: skip
    rows.append(["", "**as printed**", "", *map(percent, printed_gap()), "", "", ""])
    (zeta_D, zeta_V), gap = nearest(grid)
    spread = scatter.std(axis=0, ddof=1)
    return [
        Heading("The gap: one difference at a time"),
        Paragraph(
            "DYMOLA over VAMPIRE, if the named difference alone told them apart, and if it came on "
            f'top of the two halves. "near": within {100 * COINCIDENCE:g} percentage points of the '
            "printed gap at both speeds, which is what a gap between bodies that are damped "
            "differently scatters by from one kilometre to the next."
        ),
        table(["", "difference", "kind", "145 km/h", "200 km/h", "with halves, 145",
               "with halves, 200", "near"], rows, left=3),
        picture("gap", "which differences make which gap"),
        Paragraph(
            "Structural damping alone, two halves with one value and the beam with another between "
            f"0 and 2 %, comes nearest with {100 * zeta_D:g} % in the halves and {100 * zeta_V:g} "
            f"% in the beam: {percent(gap[0])} and {percent(gap[1])}, on the mean. From one "
            f"kilometre to the next this gap scatters by {100 * spread[0]:.1f} and "
            f"{100 * spread[1]:.1f} percentage points (a standard deviation; the grey cloud), and "
            "so the printed gap is not beyond it."
        ),
    ]  # fmt: skip


def _verdict(one: Difference, together: Difference | None) -> str:
    """Which of both is near the printed gap."""
    if one.is_near:
        return "alone"
    return "with halves" if together is not None and together.is_near else ""


def integration(
    errors: dict[tuple[str, float], dict[str, Array]],
    euler: Array,
    sweeps: dict[float, dict[str, dict[str, list[float]]]],
    tolerances: Sequence[tuple[float, float, float, int]],
) -> list[Block]:
    """Integrators side by side."""
    pairs = list(errors)
    all_errors = np.concatenate([e for of in errors.values() for e in of.values()])
    stepped = np.concatenate([errors["halves", v]["Euler-Cromer, 1 ms"] for v in SPEEDS_KMH])
    rows = [
        [name, *(_mean_and_range(errors[pair][name]) for pair in pairs)]
        for name in errors[pairs[0]]
    ]  # fmt: skip
    steps = [
        [f"{1000 / rate:g} ms", *(
            f"{100 * abs(sweeps[v][what][name][k]):.3g} %" for v in SPEEDS_KMH
            for name in sweeps[v]["a_wrms"] for what in ("deviation", "a_wrms"))]
        for k, rate in enumerate(RATES)
    ]  # fmt: skip
    converged = {
        (name, v): converged_step(values)
        for v in SPEEDS_KMH for name, values in sweeps[v]["a_wrms"].items()
    }  # fmt: skip
    said = "; ".join(f"{name} at {1000 * step:g} ms, {v:g} km/h" if step else
                     f"{name} at none of these, {v:g} km/h"
                     for (name, v), step in converged.items())  # fmt: skip
    return [
        Heading("Integrators side by side"),
        Paragraph(
            "Same vehicle, same kilometre, same run-in. Error of a_wrms against the exact response "
            f"(first-order hold at 1/16 ms): mean over {len(SEEDS)} kilometres and range, or one "
            "kilometre. The rigid body hardly feels any of it. For the halves VAMPIRE's "
            "Euler-Cromer at 1 ms is right to a few tenths of a per cent (exact for its recursion, "
            f"on the mean of all kilometres: {' and '.join(percent(e, 2) for e in euler)})."
        ),
        Paragraph(
            "DASSL's tolerance of 1e-4 is fine where it is relative to what moves, and is not "
            "where it is absolute too: coordinates move by millimetres, and bending by a tenth of "
            "one, which is as much as such a solver may err by in each step. Modelica's "
            'specification (3.3, Section 4.8.7) suggests "absTol = abs(nominal) * relTol / 100", '
            "1e-6 where nobody says a nominal value; which of the two the paper's DYMOLA took is "
            "not printed. With 1e-4 the value of one kilometre is wrong by "
            f"{percent(all_errors.min())} to {percent(all_errors.max())}."
        ),
        table(["integrator", *(f"{body}, {v:g} km/h" for body, v in pairs)], rows),
        Paragraph(
            "DASSL solves F(t, y, y′) = 0 by backward differentiation of order 1 to 5 in "
            "fixed-leading-coefficient form; VODE has that form, scipy's `BDF` changes its step "
            "seldom and has the smaller error constants of the NDF. All test the local error in "
            "the same norm, and none of them is DASSL itself. Above order 2 these formulas are not "
            "A-stable: at some steps they feed a weakly damped mode instead of damping it, and "
            "only the error test stops that. Hence the spread, and errors of either sign."
        ),
        Paragraph(
            "Errors by step, two halves, kilometre of seed 1: sample by sample (r.m.s. of the "
            "difference over r.m.s.) and of a_wrms. The first falls with the second power of the "
            "step for the hold and with the first for Euler-Cromer, whose error is mostly one of "
            "phase and hardly shows in a_wrms."
        ),
        table(["step", *(f"{name}, {v:g} km/h, {what}" for v in SPEEDS_KMH
                         for name in ("hold", "Euler-Cromer") for what in ("samples", "a_wrms"))],
              steps),
        picture("integrators", "errors over the step, 145 km/h"),
        Paragraph(
            f"On this kilometre a_wrms is within 0.1 % from these steps downwards: {said}. "
            "Euler-Cromer has luck with it: over the eight of the first table it is off by "
            f"{percent(stepped.min())} to {percent(stepped.max())} at 1 ms."
        ),
        Paragraph("BDF with atol = rtol/100, two halves, 145 km/h, seed 1:"),
        table(["rtol", "error of a_wrms", "calls of x′", "time per call"],
              [[f"{rtol:.0e}", percent(error, 3), str(calls), f"{1000 * step:.2f} ms"]
               for rtol, error, step, calls in tolerances]),
    ]  # fmt: skip


def _mean_and_range(errors: Array) -> str:
    if errors.size == 0:
        return ""
    if errors.size == 1:
        return percent(errors[0], 2)
    return f"{percent(errors.mean(), 2)} ({percent(errors.min(), 2)} … {percent(errors.max(), 2)})"


def _below_wk(method: str) -> str:
    """How far a filter at 50 Hz is below W_k at the bending frequency."""
    bending = TABLE_1["f_bending"].value
    gain = float(sampled_gain(method, bending) / abs(weighting("Wk").response(bending)))
    return f"{100 * (1 - gain):.2g} %"


def storing(found: dict[tuple[str, float], dict[str, float]]) -> list[Block]:
    """What storing at 0.02 s does."""
    rows = [
        [f"{STANDS_FOR[body]}, {v:g} km/h", f"{exact_response(body, v).a_wrms:.4f}",
         *(percent(e, 2) for e in errors.values())]
        for (body, v), errors in found.items()
    ]  # fmt: skip
    return [
        Heading("Storing at 0.02 s and weighting there"),
        Paragraph(
            "The exact response, kept every 0.02 s as the paper did, and then weighted at 50 Hz: "
            "above 25 Hz there is next to nothing, and the samples hold the value (railride's "
            "weighting, last column; what is left are the ends of the section). But at 9.6 Hz a "
            f"filter at 50 Hz is {_below_wk('bilinear')} below $W_k$ if it is bilinear and "
            f"{_below_wk('first-order hold')} if it is a first-order hold. Done to "
            "both programs, this moves all values and leaves the gap; done to VAMPIRE's alone by a "
            "hold, it would make a gap of "
            f"{percent(1 / (1 + found['beam', SPEEDS_KMH[0]]['hold']) - 1)} and "
            f"{percent(1 / (1 + found['beam', SPEEDS_KMH[1]]['hold']) - 1)}. The paper says that "
            "the values were weighted in VAMPIRE, not at which step."
        ),
        table(["run, seed 1", "a_wrms", "bilinear", "first-order hold", "railride"], rows),
    ]  # fmt: skip


def closing() -> list[Block]:
    """What explains the gap, and what cannot be decided."""
    return [
        Heading("What explains the gap, and what cannot be decided"),
        Paragraph(
            "**Explained.** That DYMOLA reads more than VAMPIRE: two halves read at their hinge "
            "stand above a beam, at both speeds, over every kilometre, with any damping that both "
            "have. The paper's own guess (its body in two parts) has the right sign and is more "
            "than twice too large."
        ),
        Paragraph(
            "**Possible.** Of single differences none meets both gaps; what comes closest has the "
            "wrong trend (four segments' worth of polygon, weighting at 50 Hz in one program) or "
            "is a guess at what VAMPIRE holds (a quarter per cent of structural damping). On top "
            "of the two halves, a primary suspension that is per axle box in DYMOLA and per axle "
            "in VAMPIRE comes near both; half a per cent of damping in DYMOLA's joint and none in "
            "VAMPIRE's beam does so within what one kilometre leaves open. A DASSL whose absolute "
            "tolerance is 1e-4 may add several per cent to DYMOLA on one kilometre, on average at "
            "145 km/h and not at 200, as the printed gap has it, but not all of it. That such "
            "different causes do about equally well is the result: agreement with two numbers "
            "proves none of them."
        ),
        Paragraph(
            "**Excluded** as the cause: Euler-Cromer at 1 ms; the band limits that Eq (6) lacks; "
            "9.586 against 9.6 Hz; the printed primary damping, or Table 1's $I_c$, in DYMOLA "
            "alone; the luck of the kilometre, since both programs ran over the same one. And the "
            "flexible body cannot be all of it, for the rigid bodies of Figures 8 and 10 differ "
            "where they should not."
        ),
        Paragraph(
            "**Not to be decided** from the paper. Two numbers stand against a dozen unknowns. "
            "What would decide: a_wrms of the rigid bodies in both programs; the track; the "
            "structural damping of VAMPIRE's beam; the natural frequencies of both models on their "
            "suspension; DASSL's absolute tolerance; the step at which the weighting ran. A "
            "third dimension adds nothing in the middle of a linear vehicle that is the same left "
            "and right ([the paper check](paper_check.md)); what VAMPIRE's wheels on rails and its "
            "other degrees of freedom add is outside of a model in the vertical plane."
        ),
    ]
