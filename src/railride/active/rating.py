r"""What a loop gives: comfort, suspension travel and forces over a track of a spectrum, exactly.

.. math:: H(\omega) = \sum_j (G_{w_j} + i\omega\, G_{\dot w_j})\, e^{-i\omega l_j/V}, \qquad
          \overline{y^2} = \int |W|^2 |H|^2 S_w\, df

with the loop's transfer functions G from the elevation w_j under wheelset j and from its rate, l_j
its distance behind the leading one. The integral is that of :mod:`railride.stochastic`.

Source: as there; the wheelsets' delays as in :mod:`railride.frequency`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.active.loop import Complex, Loop, respond, triangular_form
from railride.errors import InputError
from railride.frequency import check_ascending, check_frequency, wheelset_delays
from railride.numeric import Array
from railride.quantities import several
from railride.spectra import Spectrum, check_speed, temporal
from railride.stochastic.gains import PLAIN, Gain, weighted
from railride.stochastic.measured import track_spectrum
from railride.stochastic.process import Process, panel_edges
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import control
    import pandas as pd

PASSIVE = "passive"


def closed_response(
    system: control.StateSpace, model: VehicleModel, speed: float, frequency: ArrayLike
) -> Complex:
    """Response of a loop's outputs to the elevation under the leading wheelset.

    Parameters
    ----------
    system : with the inputs w_1 …, dw_1 … first, as :meth:`Loop.closed` gives it.
    speed : V in m/s, > 0. frequency : in Hz, shape (F,), > 0.

    Returns
    -------
    array : shape (outputs, F), in the output's unit per metre.

    Raises
    ------
    InputError : a speed ≤ 0, a system that does not begin with the track's inputs.
    """
    check_speed(speed)
    names = [w.name for w in model.linear.inputs]
    track = [*names, *(f"d{name}" for name in names)]
    k = len(names)
    if system.input_labels[: 2 * k] != track:
        raise InputError(f"system: found the inputs {', '.join(system.input_labels)}; expected "
                         f"{', '.join(track)} first")  # fmt: skip
    s = 2j * np.pi * check_frequency(frequency)
    e = np.exp(-wheelset_delays(model, speed)[:, np.newaxis] * s)
    return respond(system, s, np.concatenate([e, s * e]))


@dataclass(frozen=True)
class LoopRating:
    """What a stationary ride comes to, over 0.05-80 Hz.

    a_wrms : m/s², weighted r.m.s. of the floor's acceleration, (positions,). travel : m, r.m.s. of
    the secondary suspension's extension, (bogies,). force : N, r.m.s. of the actuators, (bogies,).
    decay : 1/s, of the motion that is slowest to settle, and least_damping_ratio of all of them.
    modulus_margin : see :attr:`Loop.modulus_margin`. remarks : what to know of track and design.
    """

    a_wrms: Array
    travel: Array
    force: Array
    decay: float
    least_damping_ratio: float
    modulus_margin: float
    remarks: tuple[str, ...] = ()


def rate_loop(
    loop: Loop,
    speed: float,
    track: str | Path | Spectrum | Track,
    at: float | Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
) -> LoopRating:
    """Exact comfort, travel and forces of one loop at a speed over a track.

    Parameters
    ----------
    loop : the design, stable as it is. speed : V in m/s, > 0.
    track : a spectrum or its name, a track or its file.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    weight : a weighting or its name.

    Raises
    ------
    InputError : speed ≤ 0, a point off the body, a spectrum with nothing in 0.05-80 Hz.
    """
    spectrum, remarks = track_spectrum(track, [speed])
    model, at = loop.model, several(at, "at", "m")
    points, bogies = [model.floor(x, floor) for x in at], model.running_gear.bogies
    system = loop.closed([*points, *(f"secondary_{b}_deflection" for b in bogies)])
    gains = (PLAIN, weighted(weighting(weight)))
    found = _process(system, model, speed, spectrum, gains).integrals()
    plain, comfort = np.sqrt(found.mean_square)
    n, m = len(points), len(points) + len(bogies)
    force = plain[m:] if len(plain) > m else np.zeros(len(bogies))
    return LoopRating(comfort[:n], plain[n:m], force, loop.decay, loop.least_damping_ratio,
                      loop.modulus_margin, (*remarks, *loop.remarks))  # fmt: skip


def _process(
    system: control.StateSpace,
    model: VehicleModel,
    speed: float,
    spectrum: Spectrum,
    gains: tuple[Gain, ...],
) -> Process:
    """The outputs of a loop as stationary processes over 0.05-80 Hz."""
    check_speed(speed)
    form, k = triangular_form(system), len(model.linear.inputs)
    delays = wheelset_delays(model, speed)
    return Process(
        form,
        rows=((0, form.left),),
        direct=((0, system.D[:, :k]), (1, system.D[:, k : 2 * k])),
        into=form.right[:, : 2 * k],
        delays=delays,
        speed=speed,
        spectrum=spectrum,
        edges=panel_edges(form, delays, speed, spectrum, gains),
        gains=gains,
    )


def rate_loops(
    loops: Loop | Mapping[str, Loop] | Sequence[Loop],
    speed: float,
    track: str | Path | Spectrum | Track,
    at: float | Sequence[float] = (0.0,),
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
) -> pd.DataFrame:
    """Designs beside the passive vehicle, one row each, the units in the column names.

    Parameters
    ----------
    loops : a design, designs by name, or with names of their own, all of one vehicle.
    speed : V in m/s, > 0. track : a spectrum or its name, a track or its file.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    weight : a weighting or its name.

    Returns
    -------
    table : the ratings; ``table.attrs["remarks"]``: what to know of the track and the designs.

    Raises
    ------
    InputError : no loop, or loops of different vehicles; else as :func:`rate_loop`.

    Examples
    --------
    >>> from railride import derive_vehicle, skyhook
    >>> coach = derive_vehicle("cati2024", segments=1)
    >>> table = rate_loops([skyhook(coach, 100e3)], 200 / 3.6, "erri_low")
    >>> table.index.tolist(), table["a_wrms at 0 m [m/s^2]"].round(3).tolist()
    (['passive', 'skyhook'], [0.076, 0.069])
    """
    import pandas as pd

    named, at = _beside_passive(loops), several(at, "at", "m")
    spectrum, _ = track_spectrum(track)
    rows, remarks = [], list[str]()
    for loop in named.values():
        found = rate_loop(loop, speed, spectrum, at, floor=floor, weight=weight)
        remarks += found.remarks
        comfort = zip(at, found.a_wrms, strict=True)
        row = {f"a_wrms at {x:g} m [m/s^2]": float(a_w) for x, a_w in comfort}
        for b, travel in enumerate(found.travel, start=1):
            row[f"travel r.m.s. bogie {b} [m]"] = float(travel)
        for b, force in enumerate(found.force, start=1):
            row[f"force r.m.s. bogie {b} [N]"] = float(force)
        rows.append(row | {"slowest decay [1/s]": found.decay,
                           "least damping ratio": found.least_damping_ratio,
                           "modulus margin": found.modulus_margin})  # fmt: skip
    table = pd.DataFrame(rows, index=pd.Index(named, name="design"))
    table.attrs["remarks"] = list(dict.fromkeys(remarks))
    return table


def loop_spectra(
    loops: Loop | Mapping[str, Loop] | Sequence[Loop],
    speed: float,
    track: str | Path | Spectrum | Track,
    frequency: ArrayLike | None = None,
    at: float = 0.0,
    *,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
) -> pd.DataFrame:
    """Where designs help: spectra |W H|² S_w of the floor's weighted acceleration, (m/s²)²/Hz.

    Parameters
    ----------
    loops : as for :func:`rate_loops`; the passive vehicle stands first.
    speed : V in m/s, > 0. track : a spectrum or its name, a track or its file.
    frequency : in Hz, ascending, (F,); default 2,000 from 0.2 to 40 Hz.
    at : point of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    weight : a weighting or its name.

    Returns
    -------
    frame : one column per design, the index "frequency [Hz]"; ``frame.attrs["remarks"]``: what to
        know of the track.

    Raises
    ------
    InputError : as :func:`rate_loops`; frequencies that are none.
    """
    import pandas as pd

    f = check_ascending(np.geomspace(0.2, 40.0, 2000) if frequency is None else frequency)
    spectrum, remarks = track_spectrum(track, [speed])
    gain = np.abs(weighting(weight).response(f)) ** 2 * temporal(spectrum, speed)(f)
    columns = {}
    for name, loop in _beside_passive(loops).items():
        system = loop.closed([loop.model.floor(at, floor)])
        H = closed_response(system, loop.model, speed, f)[0]
        columns[name] = np.abs(H) ** 2 * gain
    table = pd.DataFrame(columns, index=pd.Index(f, name="frequency [Hz]"))
    table.attrs["remarks"] = remarks
    return table


def _beside_passive(loops: Loop | Mapping[str, Loop] | Sequence[Loop]) -> dict[str, Loop]:
    """The passive vehicle and the designs by name.

    Raises
    ------
    InputError : no loop, loops of different vehicles, two of one name.
    """
    if isinstance(loops, Loop):
        loops = [loops]
    pairs = [*(loops.items() if isinstance(loops, Mapping) else ((x.name, x) for x in loops))]
    if not pairs:
        raise InputError("loops: found none; expected at least one")
    model = pairs[0][1].model
    if any(loop.model is not model for _, loop in pairs):
        raise InputError("loops: found designs for different vehicles; expected one vehicle, which "
                         "the passive row then shows (rate each vehicle by itself)")  # fmt: skip
    named = {PASSIVE: Loop(PASSIVE, model), **dict(pairs)}
    if len(named) <= len(pairs):
        names = ", ".join(name for name, _ in pairs)
        raise InputError(f"loops: found the names {names}; expected each once, and none "
                         f"{PASSIVE!r}, which is the vehicle's own (give name=…)")  # fmt: skip
    return named
