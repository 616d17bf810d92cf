"""Design studies: the cases, and what is timed inside processes of their own.

The paper's coach, N = 4, at the paper's two speeds over ERRI low, read at the floor's middle.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from coach import LENGTH, RATE, RUN_IN, SPEEDS, coach
from entry import at_least, at_most, entry
from measure import Case, answer, median, timed, worker

SUSPENSION = ("k_1", "c_1", "k_2", "c_2")
DESIGNS, MEASURED_DESIGNS, LOOPED = 5000, 100, 3
"""At once; of those over a measured track; and one by one, by the peer."""
TWELVE = (*SUSPENSION, "m_c", "m_b", "I_b", "L", "f_bending", "zeta_bending", "l_b", "l_w")
OPTIMISED = {"k_2": (300e3, 1500e3), "c_2": (20e3, 200e3), "c_1": (10e3, 100e3)}


def designs(step: Callable[[], None]) -> dict[str, Any]:
    """Designs of the suspension at two speeds, N = 4, at once and in a plain loop."""
    found = worker(__file__, "designs")
    step()
    own = median(found["own"]) / found["designs"]
    peer = median(found["peer"])
    return entry(
        "designs",
        own,
        peer,
        rounds=len(found["own"]),
        railride="evaluate_designs of 5000 suspensions, from parameters to the table of a_wrms at "
        "145 and 200 km/h, wall time of one design",
        peer="for each design and speed: build, control.forced_response of vehicle and weighting "
        "in series, 1 km at 1 kHz and 250 m of run-in, r.m.s.; wall time of one design",
        designs_a_second=1 / own,
        with_travel_and_modes_a_second=found["designs"] / median(found["all"]),
        measured_track_a_second=found["measured_designs"] / median(found["measured"]),
        peer_scatter=found["peer_ratio"],
        targets=[
            at_least("designs a second, at two speeds", 1 / own, 5000),
            at_least("times faster", peer / own, 800),
        ],
    )


def gradient(step: Callable[[], None]) -> dict[str, Any]:
    """a_wrms at two speeds with its gradient over 12 parameters, and alone, by quadrature."""
    found = worker(__file__, "gradient")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "gradient",
        own,
        peer,
        rounds=len(found["own"]),
        railride="Derivatives.at and mean_squares_with_gradient, 12 parameters, two speeds, wall "
        "time",
        peer="matrices and process().integrals(), the value alone by the same quadrature, wall "
        "time",
        parameters=found["parameters"],
        targets=[
            at_most("times the value's time", own / peer, 3),
            at_most("largest difference of the values, relative", found["difference"], 1e-12),
        ],
    )


def optimise(step: Callable[[], None]) -> dict[str, Any]:
    """The best (k_2, c_2, c_1) of the paper's coach at two speeds, N = 4."""
    found = worker(__file__, "optimise")
    step()
    own, peer = median(found["own"]), median(found["peer"])
    return entry(
        "optimise",
        own,
        peer,
        rounds=len(found["own"]),
        railride="railride.optimise, model in hand, derivatives prepared anew, wall time",
        peer="scipy.optimize.minimize by Powell's method on evaluate_designs, without gradients, "
        "wall time",
        a_wrms=found["a_wrms"],
        peer_a_wrms=found["peer_a_wrms"],
        targets=[
            at_most("time, s", own, 2),
            at_most("a_wrms over the peer's", found["a_wrms"] / found["peer_a_wrms"], 1.0001),
        ],
    )


def time_designs(rounds: int = 5) -> dict[str, Any]:
    """Designs at once, and a plain loop: build, forced_response, weighting, r.m.s.

    The loop's ride is 1 km at 1 kHz after its run-in over one sample of the same spectrum.
    """
    import numpy as np

    from railride.designs import evaluate_designs
    from railride.spectra import spectrum
    from railride.track import synthesise

    model, track = coach(), spectrum("erri_low")
    many, few = random_designs(model, DESIGNS), random_designs(model, MEASURED_DESIGNS)
    loop = plain_loop(model, synthesise(track, RUN_IN + LENGTH + 50.0, 0.05, 1).with_taper(50.0))
    measured = synthesise(track, 2000.0, 0.25, 3)
    own_times, all_times, measured_times, peer_times, own, peer = [], [], [], [], None, []
    for _ in range(rounds):
        seconds, own = timed(lambda: evaluate_designs(model, many, track, SPEEDS).table())
        own_times.append(seconds)
        seconds, _ = timed(lambda: evaluate_designs(
            model, many, track, SPEEDS, results=("a_wrms", "travel", "modes")).table())  # fmt: skip
        all_times.append(seconds)
        seconds, _ = timed(lambda: evaluate_designs(model, few, measured, SPEEDS).table())
        measured_times.append(seconds)
        for k in range(LOOPED):
            chosen = {name: values[k] for name, values in many.items()}
            seconds, found = timed(lambda c=chosen: [loop(c, speed) for speed in SPEEDS])
            peer_times.append(seconds)
            peer.append(found)
    exact = own[[c for c in own if c.startswith("a_wrms")]].to_numpy()[:LOOPED]
    return {
        "own": own_times,
        "all": all_times,
        "measured": measured_times,
        "peer": peer_times,
        "designs": DESIGNS,
        "measured_designs": MEASURED_DESIGNS,
        "peer_ratio": float(np.abs(np.array(peer[:LOOPED]) / exact - 1).max()),
    }


def time_gradient(rounds: int = 60) -> dict[str, Any]:
    """a_wrms by quadrature, and with its gradient over twelve parameters; both from values on."""
    import numpy as np

    from railride.sensitivities import Derivatives, mean_squares_with_gradient
    from railride.spectra import spectrum
    from railride.stochastic import process
    from railride.stochastic.gains import weighted
    from railride.stochastic.ride import floor_rows
    from railride.weightings import weighting

    model, track = coach(), spectrum("erri_low")
    gains, places = (weighted(weighting("Wk")),), model.vehicle.wheelset_positions
    derivatives = Derivatives(model, TWELVE)

    def value() -> Any:
        m, rows = model.matrices(), floor_rows(model, [0.0], "smooth", {})
        return [process(m, rows, places, V, track, gains).integrals().mean_square for V in SPEEDS]

    def with_gradient() -> Any:
        at = derivatives.at()
        return mean_squares_with_gradient(at, at.floor([0.0]), SPEEDS, track, gains)

    own_times, peer_times = [], []
    for _ in range(rounds):
        seconds, (J, dJ) = timed(with_gradient)
        own_times.append(seconds)
        seconds, alone = timed(value)
        peer_times.append(seconds)
    return {
        "own": own_times,
        "peer": peer_times,
        "parameters": dJ.shape[-1],
        "difference": float(np.abs(J.ravel() / np.ravel(alone) - 1).max()),
    }


def time_optimise(rounds: int = 5) -> dict[str, Any]:
    """The best (k_2, c_2, c_1) of the paper's coach: by exact gradients, and by a search without.

    Every round begins with a model that was just derived.
    """
    from scipy.optimize import minimize

    import railride as rr
    from railride.designs import evaluate_designs

    times, found = [], None
    for _ in range(rounds):
        model = coach()
        seconds, found = timed(lambda m=model: rr.optimise(m, OPTIMISED, SPEEDS))
        times.append(seconds)
    model = coach()
    start = {name: float(model.values()[name]) for name in OPTIMISED}

    def objective(scaled: Any) -> float:
        given = {name: [x * start[name]] for name, x in zip(start, scaled, strict=True)}
        return float((evaluate_designs(model, given, "erri_low", SPEEDS).a_wrms ** 2).mean())

    bounds = [(low / start[name], high / start[name]) for name, (low, high) in OPTIMISED.items()]
    peer, by = timed(lambda: minimize(objective, [1.0] * 3, bounds=bounds, method="Powell"))
    return {
        "own": times,
        "peer": [peer],
        "a_wrms": float(found.a_wrms),
        "peer_a_wrms": float(by.fun**0.5),
    }


def random_designs(model: Any, count: int) -> dict[str, Any]:
    """Suspensions of half to twice the vehicle's."""
    import numpy as np

    rng, values = np.random.default_rng(1), model.values()
    return {name: values[name] * rng.uniform(0.5, 2.0, count) for name in SUSPENSION}


def plain_loop(model: Any, line: Any) -> Any:
    """a_wrms of a design at a speed, by what a user of python-control would write."""
    import control
    import numpy as np

    from railride.statespace import state_space
    from railride.weightings import weighting

    places = np.array(model.vehicle.wheelset_positions)
    weight = control.ss(weighting("Wk").transfer_function())

    def a_wrms(design: dict[str, float], speed: float) -> float:
        felt = control.series(state_space(model.changed(**design)), weight)
        rated = round(LENGTH / speed * RATE)
        t = np.arange(round((RUN_IN + LENGTH) / speed * RATE) + 1) / RATE
        behind = places[0] - places[:, np.newaxis]
        w, slope = line.elevation(line.distance0 + speed * t - behind)
        forces = np.zeros((felt.ninputs - 2 * len(places), t.size))
        u = np.vstack([w - w[:, :1], speed * slope, forces])
        a_w = control.forced_response(felt, t, u, squeeze=False).outputs[0, -rated:]
        return float(np.sqrt(np.mean(a_w**2)))

    return a_wrms


CASES: dict[str, Case] = {
    "designs": (designs, 1),
    "gradient": (gradient, 1),
    "optimise": (optimise, 1),
}
WORKERS = {
    "designs": time_designs,
    "gradient": time_gradient,
    "optimise": time_optimise,
}

if __name__ == "__main__":
    answer(WORKERS)
