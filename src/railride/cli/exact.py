"""What ``railride ride`` adds from the spectrum: travel, third octaves and the modes' shares."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from railride.cli import output
from railride.cli.options import kmh

if TYPE_CHECKING:
    import pandas as pd

    from railride.spectra import Spectrum
    from railride.vehicle import VehicleModel

LARGER = {"m": ("mm", 1e3), "N": ("kN", 1e-3)}  # units of a table
LEAST_SHARE = 5e-4  # of a table: smaller shares are printed in JSON alone


@dataclass(frozen=True)
class Asked:
    """What the values are asked for: of one vehicle over one track, at speeds (m/s) and points."""

    model: VehicleModel
    spectrum: Spectrum
    speeds: Sequence[float]
    at: Sequence[float]
    floor: str
    weight: str
    distance: float


@dataclass(frozen=True)
class Detail:
    """One more result: its key and rows in JSON, its table as text, and what to know of it."""

    key: str
    rows: list[dict[str, Any]]
    table: str
    remarks: Sequence[str] = ()


def travel(asked: Asked) -> Detail:
    """R.m.s. and expected peak of every deflection and wheel load at every speed."""
    from railride.stochastic import extremes, missing_loads

    rows: list[dict[str, Any]] = [
        {
            "speed_kmh": kmh(speed),
            "output": one.name,
            "unit": one.unit,
            "rms": one.rms,
            "expected_peak": one.peak,
            "zero_upcrossing_hz": one.crossings,
            "low_pass_hz": one.low_pass,
            "error": one.error,
            "distance_m": asked.distance,
        }
        for speed in asked.speeds
        for one in extremes(asked.model, speed, asked.spectrum, distance=asked.distance)
    ]
    shown = []
    for row in rows:
        unit, times = LARGER.get(row["unit"], (row["unit"], 1.0))
        peak = row["expected_peak"]
        shown.append((row["speed_kmh"], row["output"], unit, times * row["rms"],
                      None if peak is None else times * peak, row["zero_upcrossing_hz"],
                      row["low_pass_hz"]))  # fmt: skip
    columns = [("speed\n[km/h]", ".6g"), ("output", ""), ("unit", ""), ("r.m.s.", ".3f"),
               ("expected peak\nto one side", ".3f"), ("zero up-\ncrossings [1/s]", ".2f"),
               ("low-pass\n[Hz]", ".4g")]  # fmt: skip
    loads = " and wheel load" if any(row["unit"] == "N" for row in rows) else ""
    title = f"Suspension travel{loads} over {asked.distance:g} m, exact"
    table = output.table_text(title, columns, shown) + integrated(row["error"] for row in rows)
    return Detail("outputs", rows, table, missing_loads(asked.model))


def integrated(errors: Iterable[float]) -> str:
    """A line on the errors of exact values; nothing where there are none."""
    listed = list(errors)
    line = "\n  exact: integrated over the spectrum of the track, relative error at most {:.0e}\n"
    return line.format(max(listed)) if listed else ""


def bands(asked: Asked) -> Detail:
    """Third-octave values at every speed and point: a column each in the table."""
    from railride.stochastic import third_octaves

    def found(speed: float) -> pd.DataFrame:
        return third_octaves(asked.model, speed, asked.spectrum, asked.at, floor=asked.floor,
                             weight=asked.weight)  # fmt: skip

    names = {"band_hz": "band [Hz]", "midband_hz": "midband [Hz]", "a_rms": "a_rms [m/s^2]",
             "a_wrms": "a_wrms [m/s^2]"}  # fmt: skip
    rows = _rows(asked, found, names)
    listed = list(dict.fromkeys(row["band_hz"] for row in rows))
    values = {(row["band_hz"], row["speed_kmh"], row["position_m"]): row["a_wrms"] for row in rows}
    cases = list(dict.fromkeys((row["speed_kmh"], row["position_m"]) for row in rows))
    columns = [("band\n[Hz]", ".6g"), *((f"{v:.6g} km/h,\n{x:.6g} m", ".5f") for v, x in cases)]
    title = f"Third octaves of the floor's acceleration, {asked.weight} weighted r.m.s. [m/s²]"
    table = output.table_text(title, columns, [(f, *(values[f, *case] for case in cases))
                                               for f in listed])  # fmt: skip
    return Detail("third_octaves", rows, table)


def shares(asked: Asked) -> Detail:
    """The share of every mode in the weighted mean square at every speed and point."""
    from railride.stochastic import mode_shares

    def found(speed: float) -> pd.DataFrame:
        return mode_shares(asked.model, speed, asked.spectrum, asked.at, floor=asked.floor,
                           weight=asked.weight)  # fmt: skip

    names = {"mode": "mode", "frequency_hz": "frequency [Hz]", "damping_ratio": "damping ratio",
             "share": "share"}  # fmt: skip
    rows = _rows(asked, found, names)
    columns = [("speed\n[km/h]", ".6g"), ("at\n[m]", ".6g"), ("mode", ""),
               ("frequency\n[Hz]", ".4f"), ("damping\nratio", ".4f"), ("share", ".1%")]  # fmt: skip
    shown = [tuple(row.values()) for row in rows if abs(row["share"]) >= LEAST_SHARE]
    title = "Shares of the modes in the weighted mean square, those of 0.05 % and more"
    return Detail("mode_shares", rows, output.table_text(title, columns, shown))


def _rows(
    asked: Asked, found: Callable[[float], pd.DataFrame], names: dict[str, str]
) -> list[dict[str, Any]]:
    """Rows of a table per speed, the columns (values of ``names``) under their keys."""
    return [
        {"speed_kmh": kmh(speed), "position_m": row["position [m]"],
         **{key: _defined(row[column]) for key, column in names.items()}}
        for speed in asked.speeds
        for row in found(speed).to_dict("records")
    ]  # fmt: skip


def _defined(value: Any) -> Any:
    """None for what pandas keeps as NaN."""
    return None if value != value else value  # noqa: PLR0124
