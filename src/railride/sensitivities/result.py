"""The sensitivities of a ride: what matters, by exact gradients, and how far these reach."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from railride.bodies import Parameter
from railride.designs import evaluate_designs
from railride.errors import Faults, InputError
from railride.numeric import Array
from railride.quantities import check_number, several
from railride.sensitivities.derivatives import Derivatives, Tangent
from railride.sensitivities.roots import Roots, roots_with_gradient
from railride.sensitivities.squares import mean_squares_with_gradient
from railride.sensitivities.statics import static_deflections_with_gradient
from railride.spectra import Spectrum
from railride.stochastic.gains import weighted
from railride.stochastic.measured import track_spectrum
from railride.track import Track
from railride.vehicle import VehicleModel
from railride.weightings import Weighting, weighting

if TYPE_CHECKING:
    import pandas as pd

CHANGE = 0.1  # of each parameter's value
STATED = 1e-6  # error of a relative sensitivity above which it is remarked on
FELT = 1e-9  # relative change of a_wrms below which a parameter is not felt: rounding
AT_NODE = 1e-9  # of the body's length: a place so near a hinge is at it


@dataclass(frozen=True, eq=False)
class Sensitivities:
    """How a ride's weighted r.m.s., the modes and the static deflections move with P parameters.

    parameters : symbol, meaning, unit and value of each. speeds, positions : S, m/s, and X, m.
    a_wrms : m/s², (S, X). gradient : d a_wrms/dp, (S, X, P).
    change : by how much of its value each parameter is changed; changed : a_wrms with that less of
    it and with that more, found anew, (S, X, P, 2), NaN where such a vehicle cannot be.
    roots : modes and their gradients. deflections : static, by name, m. deflection_slopes : of
    these, (outputs, P). held : what of the body's bending stays as it is (``Tangent.held``).
    remarks : what to know.
    """

    vehicle: str
    body: str
    track: str
    floor: str
    weighting: str
    parameters: tuple[Parameter, ...]
    speeds: tuple[float, ...]
    positions: tuple[float, ...]
    a_wrms: Array
    gradient: Array
    change: float
    changed: Array
    roots: Roots
    deflections: Mapping[str, float]
    deflection_slopes: Array
    held: str
    remarks: tuple[str, ...] = ()

    @property
    def values(self) -> Array:
        """The parameters' values, (P,)."""
        return np.array([p.value for p in self.parameters])

    @property
    def relative(self) -> Array:
        """d ln a_wrms/d ln p, (S, X, P)."""
        return np.asarray(self.gradient * self.values / self.a_wrms[..., np.newaxis] + 0.0)

    @property
    def linear_effects(self) -> Array:
        """Relative change of a_wrms by its gradient, with less and more of p: (S, X, P, 2)."""
        return self.relative[..., np.newaxis] * (self.change * np.array([-1.0, 1.0]))

    @property
    def effects(self) -> Array:
        """Relative change of a_wrms, found anew, with less and more of p: (S, X, P, 2)."""
        return np.asarray(self.changed / self.a_wrms[..., np.newaxis, np.newaxis] - 1)

    def ranked(self, case: int | None = None) -> list[int]:
        """The places of the parameters whose change is felt, the most important first.

        case : of which speed and point of the floor, speeds outer; default the largest of all.
        """
        size = np.abs(np.where(np.isfinite(self.effects), self.effects, self.linear_effects))
        of_cases = size.max(axis=-1).reshape(-1, len(self.parameters))
        largest = of_cases.max(axis=0) if case is None else of_cases[case]
        order = np.argsort(-largest, kind="stable")
        return [int(k) for k in order if largest[k] > FELT]

    def table(self) -> pd.DataFrame:
        """One row per speed, position and parameter.

        Columns "speed [km/h]", "position [m]", "a_wrms [m/s^2]", "parameter", "symbol", "unit",
        "value", "gradient" (m/s² per unit of the parameter), "relative" (d ln a_wrms/d ln p), and
        the effects of less and of more of it, "linear -", "linear +", "effect -", "effect +".
        """
        import pandas as pd

        linear, effects = self.linear_effects, self.effects
        rows = [
            {
                "speed [km/h]": 3.6 * speed,
                "position [m]": position,
                "a_wrms [m/s^2]": self.a_wrms[i, j],
                **_described(p),
                "gradient": self.gradient[i, j, k],
                "relative": self.relative[i, j, k],
                **dict(zip(("linear -", "linear +"), linear[i, j, k], strict=True)),
                **dict(zip(("effect -", "effect +"), effects[i, j, k], strict=True)),
            }
            for i, speed in enumerate(self.speeds)
            for j, position in enumerate(self.positions)
            for k, p in enumerate(self.parameters)
        ]
        return pd.DataFrame(rows)

    def mode_table(self) -> pd.DataFrame:
        """One row per mode and parameter.

        Columns "mode", "frequency [Hz]", "damping ratio", "parameter", "symbol", "unit", "value",
        "frequency gradient" (Hz per unit), "frequency relative" (d ln f/d ln p), and the same of
        the damping ratio.
        """
        import pandas as pd

        modes = self.roots
        return pd.DataFrame([
            {
                "mode": name,
                "frequency [Hz]": modes.frequencies[i],
                "damping ratio": modes.damping_ratios[i],
                **_described(p),
                "frequency gradient": df[k],
                "frequency relative": df[k] * p.value / modes.frequencies[i],
                "damping gradient": dzeta[k],
                "damping relative": dzeta[k] * p.value / modes.damping_ratios[i]
                if modes.damping_ratios[i] else np.nan,
            }
            for i, (name, df, dzeta) in enumerate(
                zip(modes.names, modes.frequency_slopes, modes.damping_slopes, strict=True))
            for k, p in enumerate(self.parameters)
        ])  # fmt: skip


def sensitivity(
    model: VehicleModel,
    speeds: float | Sequence[float],
    track: str | Path | Spectrum | Track,
    at: float | Sequence[float] = (0.0,),
    *,
    parameters: Sequence[str] | None = None,
    floor: str = "smooth",
    weight: str | Weighting = "Wk",
    change: float = CHANGE,
    **changes: ArrayLike,
) -> Sensitivities:
    """Exact sensitivities of a stationary ride, of the modes and of the static deflections.

    Parameters
    ----------
    speeds : m/s, each > 0. track : a spectrum or its name, a track or its file.
    at : points of the floor, m forward of the body's middle. floor : "smooth" or "polygon".
    parameters : symbols or keys of parameter files; default every independent one that can be
        changed and enters. A body that was calibrated to its bending frequency keeps it while
        others change, unless the joints' stiffness is among them (``Sensitivities.held`` says).
    weight : a weighting or its name.
    change : of each parameter's value, above 0 and below 1, for which the ride is found anew.
    changes : parameter values in place of the vehicle's.

    Raises
    ------
    InputError : as ``stochastic_ride``; a parameter that does not exist, is named twice or cannot
        be changed; a change out of range.

    Examples
    --------
    >>> from railride import derive_vehicle
    >>> coach = derive_vehicle("cati2024", segments=2)
    >>> found = sensitivity(coach, 200 / 3.6, "erri_low", parameters=["k_2", "c_2", "f_bending"])
    >>> found.table().set_index("symbol")["relative"].round(2).to_dict(), found.held
    ({'k_2': 0.03, 'c_2': 0.29, 'f_bending': -5.6}, 'bending frequency')
    """
    faults = Faults("sensitivity")
    check_number(faults, "change", change, "> 0")
    faults.raise_if_any()
    if change >= 1:
        raise InputError(f"change: found {change:g}; expected a part of the value, below 1")
    speeds, at = several(speeds, "speeds", "m/s"), several(at, "at", "m")
    spectrum, said = track_spectrum(track, speeds)
    derivatives = Derivatives(model, parameters)
    here = derivatives.at(**changes)
    ride = _Ride(speeds, spectrum, at, floor, weighting(weight))
    rms, gradient, uncertain = _gradient(here, ride)
    changed, problems = _changed(here, ride, change)
    known = {p.symbol.name: p for p in model.parameters}
    left_out = [f"{name} is left out: {why}" for name, why in derivatives.left_out.items()]
    deflections, slopes = static_deflections_with_gradient(here)
    return Sensitivities(
        vehicle=model.vehicle.name,
        body=model.body.title,
        track=spectrum.name,
        floor=floor,
        weighting=ride.weight.name,
        parameters=tuple(_parameter(here, name, known) for name in here.parameters),
        speeds=tuple(speeds),
        positions=tuple(at),
        a_wrms=rms,
        gradient=gradient,
        change=change,
        changed=changed,
        roots=roots_with_gradient(here),
        deflections=deflections,
        deflection_slopes=slopes,
        held=here.held,
        remarks=(*said, *left_out, *_at_hinges(model), *uncertain, *problems),
    )


@dataclass(frozen=True)
class _Ride:
    """What the weighted r.m.s. is of: speeds, m/s, a track, points of the floor, a weighting."""

    speeds: Sequence[float]
    spectrum: Spectrum
    at: Sequence[float]
    floor: str
    weight: Weighting


def _gradient(here: Tangent, ride: _Ride) -> tuple[Array, Array, list[str]]:
    """a_wrms (S, X), its gradient (S, X, P), and where that is uncertain.

    By how much the integrals change as every panel is halved.
    """
    rows = here.floor(ride.at, ride.floor)
    gains = (weighted(ride.weight),)
    found = []
    for refined in (1, 2):
        J, dJ = mean_squares_with_gradient(here, rows, ride.speeds, ride.spectrum, gains,
                                           refined=refined)  # fmt: skip
        rms = np.sqrt(J[:, 0])
        found.append(np.divide(dJ[:, 0], 2 * rms[..., np.newaxis], where=rms[..., np.newaxis] > 0,
                               out=np.zeros_like(dJ[:, 0])))  # fmt: skip
    size = np.array([abs(float(here.values[name])) or 1.0 for name in here.parameters])
    off = (
        np.abs(found[1] - found[0]) * size / np.maximum(rms, np.finfo(float).tiny)[..., np.newaxis]
    )
    said = _by_differences([*here.by_differences, *rows.by_differences])
    for k in np.flatnonzero((off > STATED).any(axis=(0, 1))).tolist():
        said.append(f"the sensitivity to {here.parameters[k]} is uncertain by "
                    f"{off[..., k].max():.0e} (a mode with next to no damping?)")  # fmt: skip
    return rms, found[1], said


def _by_differences(symbols: Sequence[str]) -> list[str]:
    if not symbols:
        return []
    some = ", ".join(symbols[:3]) + (" …" if len(symbols) > 3 else "")
    said = (
        f"how {some} follow{'s' * (len(symbols) == 1)} from the parameters is found by "
        "differences of eighth order, not by a formula"
    )
    return [said]


def _at_hinges(model: VehicleModel) -> list[str]:
    """A remark on what stands at a hinge, where the body's height has a kink."""
    body, gear, carried = model.body, model.running_gear, model.carried
    if (body.segments or 1) < 2:
        return []
    places = [gear.place(b) for b in gear.bogies] + [carried.place(e) for e in carried.equipment]
    nodes = body.nodes[1:-1]
    near = AT_NODE * (body.nodes[0] - body.nodes[-1])
    return [
        f"{place.name} stands at a hinge of the body: sensitivities to its position are those of "
        "a move forward"
        for place in places if np.abs(nodes - place.at).min() <= near
    ]  # fmt: skip


def _changed(here: Tangent, ride: _Ride, change: float) -> tuple[Array, list[str]]:
    """a_wrms with less and with more of each parameter, (S, X, P, 2), and remarks."""
    base = {name: float(np.asarray(value)) for name, value in here.changes.items()}
    base |= {name: float(here.values[name]) for name in here.parameters}
    moved = [(name, sign) for name in here.parameters for sign in (-1, 1)]
    designs = {
        name: [value * (1 + sign * change * (one == name)) for one, sign in moved]
        for name, value in base.items()
    }
    found = evaluate_designs(here.derivatives.model, designs, ride.spectrum, ride.speeds, ride.at,
                             floor=ride.floor, weight=ride.weight)  # fmt: skip
    said = [f"{name} {100 * sign * change:+g} %: no value: {why}"
            for (name, sign), why in zip(moved, found.problems, strict=True) if why]  # fmt: skip
    said += [f"{name} is 0, and {100 * change:g} % of it nothing: its gradient alone tells"
             for name in here.parameters if base[name] == 0]  # fmt: skip
    shape = (len(here.parameters), 2, len(ride.speeds), len(ride.at))
    return np.moveaxis(np.asarray(found.a_wrms, dtype=float).reshape(shape), (0, 1), (2, 3)), said


def _parameter(here: Tangent, name: str, known: Mapping[str, Parameter]) -> Parameter:
    """A parameter with its value here; one that follows from others, named, too."""
    model = here.derivatives.model
    value = float(here.values[name])
    if name in known:
        p = known[name]
        return Parameter(p.symbol, p.meaning, p.unit, value)
    meaning, unit = model.meanings[name]
    symbol = next(s for s in (*model.body.followers, *model.linear.parameters) if s.name == name)
    return Parameter(symbol, meaning, unit, value)


def _described(p: Parameter) -> dict[str, object]:
    return {"parameter": p.meaning, "symbol": p.symbol.name, "unit": p.unit, "value": p.value}
