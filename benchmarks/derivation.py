"""Deriving and linearising: the cases, and what is timed in processes of their own."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from entry import at_least, at_most, entry
from measure import Case, answer, interleaved, median, run, timed, worker

SEGMENTS = (1, 2, 4, 8)
ROUNDS, PROCESS_ROUNDS = 2, 15
DERIVE = ("-m", "railride.derive", "--segments")


def derive_linearise(segments: int, step: Callable[[], None]) -> dict[str, Any]:
    """Energies to linear matrices, each run in a fresh process, imports not counted.

    The peer takes about a minute for eight segments, so it is run twice only.
    """
    sides = [partial(worker, __file__, f"{who}-{segments}") for who in ("railride", "sympy")]
    own_runs, peer_runs = interleaved(sides, ROUNDS, step)
    own = median([r["seconds"] for r in own_runs])
    peer = median([r["seconds"] for r in peer_runs])
    difference = max(r["difference"] for r in peer_runs)
    targets = [at_most("largest difference / largest value, M C K K_w", difference, 1e-9)]
    if segments == SEGMENTS[-1]:
        targets.insert(0, at_least("times faster", peer / own, 100))
    return entry(
        f"derive-linearise-{segments}",
        own,
        peer,
        rounds=ROUNDS,
        railride=f"derive_vehicle(cati2024, segments={segments}).linear from scratch, wall time",
        peer="sympy LagrangesMethod, form_lagranges_equations, linearize; same energies, written "
        "out, without the rates of the inputs, which it refuses; wall time",
        peak_memory_mb=max(r["peak"] for r in own_runs) / 1e6,
        peer_peak_memory_mb=max(r["peak"] for r in peer_runs) / 1e6,
        targets=targets,
    )


def derive_process(step: Callable[[], None]) -> dict[str, Any]:
    """CPU of the whole process ``python -m railride.derive --segments 4`` against a bare sympy."""
    sides = (lambda: run(*DERIVE, "4").cpu, lambda: run("-c", "import sympy").cpu)
    # Once unmeasured: the byte code is written, the files are in memory.
    interleaved(sides, 1, lambda: None)
    own, peer = (median(times) for times in interleaved(sides, PROCESS_ROUNDS, step))
    return entry(
        "derive-process",
        own,
        peer,
        rounds=PROCESS_ROUNDS,
        railride="python -m railride.derive --segments 4, CPU of the whole process",
        peer='python -c "import sympy", CPU of the whole process',
        targets=[at_most("ratio", own / peer, 3)],
    )


def derive_railride(segments: int) -> dict[str, Any]:
    """From the parameters of the vehicle to its linear matrices in symbols."""
    from railride.parameters import load_vehicle
    from railride.vehicle import derive_vehicle

    vehicle = load_vehicle("cati2024")
    seconds, _ = timed(lambda: derive_vehicle(vehicle, segments=segments).linear)
    return {"seconds": seconds}


def derive_sympy(segments: int) -> dict[str, Any]:
    """sympy's LagrangesMethod with linearize on the same energies; the matrices compared after.

    It refuses rates of inputs, so the dissipation function is that of a track at rest (w' = 0),
    and C_w is not among the matrices it gives.
    """
    from sympy.physics.mechanics import LagrangesMethod, Point, ReferenceFrame, dynamicsymbols

    from railride.parameters import load_vehicle
    from railride.vehicle import derive_vehicle

    model = derive_vehicle(load_vehicle("cati2024"), segments=segments)
    system = model.lagrangian.written_out
    function = {s: dynamicsymbols(s.name) for s in (*system.coordinates, *system.inputs)}
    table: dict[Any, Any] = dict(function)
    for s, of_time in function.items():
        table[s.dot] = of_time.diff() if s in system.coordinates else 0
    q = [function[s] for s in system.coordinates]
    # The energies are prepared outside the time: the peer starts from them, written for it.
    kinetic, potential = system.kinetic.xreplace(table), system.potential.xreplace(table)
    frame = ReferenceFrame("N")
    loads = []
    for s in system.coordinates:
        point = Point(f"P_{s.name}")
        point.set_vel(frame, table[s.dot] * frame.x)
        loads.append((point, -system.dissipation.diff(s.dot).xreplace(table) * frame.x))

    def work() -> Any:
        method = LagrangesMethod(kinetic - potential, q, forcelist=loads, frame=frame)
        method.form_lagranges_equations()
        rest = {x: 0 for s in q for x in (s, s.diff(), s.diff().diff())}
        return method.linearize(q_ind=q, qd_ind=[x.diff() for x in q], op_point=rest)

    seconds, linear = timed(work)
    return {"seconds": seconds, "difference": _largest_difference(model, linear)}


def _largest_difference(model: Any, linear: Any) -> float:
    """Between M, C, K, K_w of the two, as numbers, as a fraction of each matrix's largest."""
    import numpy as np
    import sympy as sp

    values = {name: float(value) for name, value in model.values().items()}
    mass, state, inputs, order = linear

    def number(matrix: Any) -> Any:
        by_name = {s: values[s.name] for s in matrix.free_symbols if s.name in values}
        at_rest = dict.fromkeys(matrix.atoms(sp.core.function.AppliedUndef), 0)
        return np.array(matrix.xreplace(by_name).xreplace(at_rest).tolist(), dtype=float)

    m, n = model.matrices(), len(model.lagrangian.coordinates)
    names = [s.func.__name__ for s in order]
    columns = [names.index(s.name) for s in model.lagrangian.inputs]
    A = number(state)[n:]
    pairs = [
        (number(mass)[n:, n:], m.M),
        (-A[:, :n], m.K),
        (-A[:, n:], m.C),
        (number(inputs)[n:][:, columns], m.K_w),
    ]
    return max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)


CASES: dict[str, Case] = {
    **{f"derive-linearise-{n}": (partial(derive_linearise, n), ROUNDS) for n in SEGMENTS},
    "derive-process": (derive_process, PROCESS_ROUNDS),
}
WORKERS = {
    f"{who}-{n}": partial(derive, n)
    for n in SEGMENTS
    for who, derive in (("railride", derive_railride), ("sympy", derive_sympy))
}

if __name__ == "__main__":
    answer(WORKERS)
