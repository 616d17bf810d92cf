"""Values of many designs: arrays with named axes, and tables with one row per design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from railride.errors import InputError
from railride.numeric import Array
from railride.units import headed

if TYPE_CHECKING:
    import pandas as pd
    import xarray

RIDE = ("track", "speed")
FLOOR = (*RIDE, "position")
KINDS = (  # of values: their name, what columns say of them, their unit and axes
    ("a_wrms", "a_wrms", "m/s^2", FLOOR),
    ("a_rms", "a_rms", "m/s^2", FLOOR),
    ("wz", "wz", "", FLOOR),
    ("travel_rms", "rms", "m", (*RIDE, "suspension")),
    ("travel_peak", "expected peak", "m", (*RIDE, "suspension")),
    ("load_rms", "rms", "N", (*RIDE, "wheel_load")),
    ("load_peak", "expected peak", "N", (*RIDE, "wheel_load")),
    ("natural_frequency", "natural frequency", "Hz", ("mode",)),
    ("damping_ratio", "damping ratio", "", ("mode",)),
    ("least_damping_ratio", "least damping ratio", "", ()),
    ("static_deflection", "static", "m", ("suspension",)),
)


@dataclass(frozen=True, eq=False)
class Quantity:
    """One kind of value of every design: ``values`` (D, …), one axis more for each of ``axes``.

    name : of the array. said : in columns, after what it is of. unit : SI, "" of a pure number.
    """

    name: str
    said: str
    unit: str
    axes: tuple[str, ...]
    values: Array

    def column(self, labels: Mapping[str, str]) -> str:
        """The column of one case, by its labels on the axes."""
        first = [labels[axis] for axis in self.axes if axis not in FLOOR]
        words = [*first, self.said, *(labels[axis] for axis in self.axes if axis in FLOOR)]
        return headed(" ".join(filter(None, words)), self.unit)


@dataclass(frozen=True, eq=False)
class DesignValues:
    """What D designs come to over every case.

    parameters : name as given → (D,), SI. units : of each of them, "" of a pure number.
    tracks, speeds (m/s), positions (m forward of the body's middle) : the cases.
    a_wrms, a_rms : m/s², wz : (D, tracks, speeds, positions); travel_rms, travel_peak : m, (D,
    tracks, speeds, suspensions); load_rms, load_peak : N, (D, tracks, speeds, wheel_loads);
    natural_frequency : Hz, and damping_ratio, (D, modes); least_damping_ratio : (D,);
    static_deflection : m, positive in extension, (D, suspensions). None where not asked for, NaN
    where there is no value. error : (D,), the largest estimated relative error of a design's own.
    problems : (D,), why a design lacks values, "" where it has them all. remarks : what to know.
    """

    parameters: Mapping[str, Array]
    units: Mapping[str, str]
    tracks: tuple[str, ...]
    speeds: tuple[float, ...]
    positions: tuple[float, ...]
    suspensions: tuple[str, ...]
    wheel_loads: tuple[str, ...]
    modes: tuple[str, ...]
    error: Array
    problems: NDArray[np.object_]
    a_wrms: Array | None = None
    a_rms: Array | None = None
    wz: Array | None = None
    travel_rms: Array | None = None
    travel_peak: Array | None = None
    load_rms: Array | None = None
    load_peak: Array | None = None
    natural_frequency: Array | None = None
    damping_ratio: Array | None = None
    least_damping_ratio: Array | None = None
    static_deflection: Array | None = None
    remarks: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.problems)

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        """What there is, in the order of the table's columns."""
        return tuple(
            Quantity(name, said, unit, axes, values)
            for name, said, unit, axes in KINDS
            if (values := getattr(self, name)) is not None
        )

    @property
    def labels(self) -> dict[str, list[str]]:
        """How the places on each axis are called in columns."""
        return {
            "track": list(self.tracks),
            "speed": [f"{3.6 * speed:.9g} km/h" for speed in self.speeds],
            "position": [f"{x:.9g} m" for x in self.positions],
            "suspension": list(self.suspensions),
            "wheel_load": list(self.wheel_loads),
            "mode": list(self.modes),
        }

    def table(self) -> pd.DataFrame:
        """One row per design: its parameters, a column for every value, "error" and "problem".

        Columns name case and unit, "a_wrms erri_low 145 km/h 0 m [m/s^2]", and depend on the cases
        alone. ``table.attrs["remarks"]`` : the remarks.
        """
        import pandas as pd

        given = {headed(name, self.units[name]): of for name, of in self.parameters.items()}
        columns = given | dict(self._columns())
        table = pd.DataFrame({**columns, "error": self.error, "problem": self.problems})
        table.attrs["remarks"] = list(self.remarks)
        return table

    def dataset(self) -> xarray.Dataset:
        """Arrays with named axes, of the names above; ``units`` among the attributes of each.

        Parameters are coordinates along "design", pure numbers in units of "1".

        Raises
        ------
        InputError : xarray is not installed.
        """
        try:
            import xarray
        except ImportError:
            raise InputError(
                "dataset: found xarray missing; expected it to be installed (pip"
                " install 'railride[xarray]', or take the table)"
            ) from None
        found: dict[str, Any] = {
            quantity.name: (("design", *quantity.axes), quantity.values, _units(quantity.unit))
            for quantity in self.quantities
        }
        found["error"] = ("design", self.error, _units(""))
        found["problem"] = ("design", self.problems)
        used = {axis for quantity in self.quantities for axis in quantity.axes}
        places: dict[str, Any] = {axis: of for axis, of in self.labels.items() if axis in used}
        if "speed" in used:
            places["speed"] = ("speed", list(self.speeds), _units("m/s"))
        if "position" in used:
            places["position"] = ("position", list(self.positions), _units("m"))
        for name, of in self.parameters.items():
            places[name] = ("design", of, _units(self.units[name]))
        places["design"] = np.arange(len(self))
        return xarray.Dataset(found, places, {"remarks": list(self.remarks)})

    def _columns(self) -> Iterator[tuple[str, Array]]:
        labels = self.labels
        for quantity in self.quantities:
            cases = product(*(labels[axis] for axis in quantity.axes))
            each = quantity.values.reshape(len(self), -1).T
            for case, values in zip(cases, each, strict=True):
                yield quantity.column(dict(zip(quantity.axes, case, strict=True))), values


def _units(unit: str) -> dict[str, str]:
    return {"units": unit or "1"}
