"""The parameters that a study varies: which ones, their units, and what they take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from railride.distributions import Distribution, note_impossible, read_distribution
from railride.errors import InputError
from railride.studies.ranges import Listed, Range, read_listed, read_range
from railride.toml_tables import Table
from railride.units import headed
from railride.vehicle import VehicleModel

Spec = Range | Listed | Distribution


@dataclass(frozen=True)
class StudyParameter:
    """One parameter of a study.

    name : as the study calls it, a symbol or a key of parameter files. symbol : the model's.
    unit, meaning : SI, and in words. nominal : the vehicle's own value.
    spec : what it takes; None where the study says nothing of it but its name.
    """

    name: str
    symbol: str
    unit: str
    meaning: str
    nominal: float
    spec: Spec | None = None

    @property
    def heading(self) -> str:
        """Heading of its column in a table: "secondary_stiffness [N/m]"."""
        return headed(self.name, self.unit)


class Names:
    """Looks parameters up in a model, each once.

    >>> from railride.vehicle import derive_vehicle
    >>> names = Names(derive_vehicle("cati2024", 2))
    >>> names.parameter("secondary_stiffness").symbol
    'k_2'
    """

    def __init__(self, model: VehicleModel) -> None:
        self._model = model
        self._meanings = model.meanings
        self._values = model.values()
        self._symbols = {p.symbol.name: p.symbol for p in model.parameters}
        self._taken: dict[str, str] = {}

    def parameter(self, name: str) -> StudyParameter:
        """The parameter of that name.

        Raises
        ------
        InputError : a name that the model does not have, with the near ones; a parameter that was
            asked for before, under whatever name.
        """
        symbol = self._model.symbol_of(name)
        if symbol in self._taken:
            raise InputError(f"parameters: found {name!r}, which is {self._taken[symbol]!r} again; "
                             "expected each parameter once")  # fmt: skip
        self._taken[symbol] = name
        meaning, unit = self._meanings[symbol]
        return StudyParameter(name, symbol, unit, meaning, float(self._values[symbol]))

    def note_impossible(self, parameter: StudyParameter, table: Table) -> None:
        """Note, under the parameter's table, values that the model cannot have."""
        if isinstance(parameter.spec, Distribution):
            note_impossible(self._model, {parameter.symbol: parameter.spec}, table.faults,
                            table.where)  # fmt: skip

    def sign(self, parameter: StudyParameter) -> str:
        """What its values must be: "> 0", ">= 0", or "" for any."""
        symbol = self._symbols.get(parameter.symbol)
        if symbol is None:
            return ""
        return "> 0" if symbol.is_positive else ">= 0" if symbol.is_nonnegative else ""


def read_parameters(tables: Mapping[str, Table], names: Names) -> tuple[StudyParameter, ...]:
    """Parameters of the tables ``[parameters.NAME]``, in their order; faults are noted in them."""
    found = []
    for name, table in tables.items():
        try:
            parameter = names.parameter(name)
        except InputError as error:
            table.faults.include(table.where, error)
            continue
        parameter = replace(parameter, spec=_read_spec(table, parameter, names.sign(parameter)))
        table.finish()
        names.note_impossible(parameter, table)
        found.append(parameter)
    return tuple(found)


def _read_spec(table: Table, parameter: StudyParameter, sign: str) -> Spec | None:
    """What stands there; two kinds of it at once are a fault."""
    unit = parameter.unit
    if "distribution" in table:
        if "values" in table:
            table.faults.add(table.where, "a distribution and values", "one of them")
        return read_distribution(table, unit, parameter.nominal)
    kinds = {"values": "values", "from": "a range", "to": "a range"}
    given = sorted({kind for key, kind in kinds.items() if key in table})
    if len(given) > 1:
        table.faults.add(table.where, " and ".join(given), "one of them", "leave the other out")
    if "values" in table:
        return read_listed(table, unit, sign)
    return read_range(table, unit, sign) if given else None
