"""Distributions in the tables of a study file, in units or relative to the nominal value.

======================== =========================================================================
key                      value
======================== =========================================================================
``distribution``         ``"normal"``, ``"lognormal"``, ``"uniform"``, ``"triangular"``, ``"beta"``
``mean``                 normal, lognormal; default the nominal value
``deviation``            normal, lognormal: standard deviation; per cent are of the mean
``from``, ``to``         limits: of uniform, triangular, beta; optional cuts of the others
``mode``                 triangular: where its peak is; default the nominal value
``alpha``, ``beta``      beta: its shapes, plain numbers above 0
======================== =========================================================================

Values are ``"number unit"``. Per cent are of the nominal value, that of the vehicle; but of a
parameter that is a plain number itself, such as a damping ratio, they are its value: "2 %" is 0.02.
"""

from __future__ import annotations

from railride.distributions.kinds import KINDS, Distribution, faults_of
from railride.toml_tables import Table, shown

_KEYS = {"low": "from", "high": "to"}  # figures whose key is another word
_SHAPES = ("alpha", "beta")


def read_distribution(table: Table, unit: str, nominal: float | None) -> Distribution | None:
    """The distribution that a table of a parameter asks for; None if it names none, or wrongly.

    table : holds the keys above; all faults go into its ``faults``.
    unit : the parameter's. nominal : the parameter's value in the vehicle, SI; None: not known.

    Examples
    --------
    >>> from railride.errors import Faults
    >>> asked = {"distribution": "normal", "deviation": "5 %", "from": "0 N/m"}
    >>> print(read_distribution(Table(asked, "parameters.k_2", Faults("study")), "N/m", 750e3))
    normal, mean 750000, deviation 37500, low 0
    """
    kind = table.text("distribution")
    if kind is None:
        return None
    if kind not in KINDS:
        table.faults.add(
            table.key("distribution"), shown(kind), f"one of {', '.join(map(repr, KINDS))}"
        )
        return None
    before = len(table.faults.found)
    needed, possible = KINDS[kind]
    figures: dict[str, float] = {}
    for name in (*needed, *possible):
        base = figures.get("mean") if name == "deviation" else nominal
        value = _figure(table, name, unit, base)
        if name in {"mean", "mode"} and name not in table:
            value = nominal
        if value is not None:
            figures[name] = value
    if len(table.faults.found) > before:
        return None
    wrong = list(faults_of(kind, figures))
    for fault in wrong:
        table.faults.add(table.key(_KEYS.get(fault.where, fault.where)), fault.found,
                         fault.expected, fault.mend)  # fmt: skip
    return None if wrong else Distribution(kind, **figures)


def _figure(table: Table, name: str, unit: str, base: float | None) -> float | None:
    """SI value of one figure."""
    key = _KEYS.get(name, name)
    value = table.content.get(key)
    relative = isinstance(value, str) and value.rstrip().endswith("%")
    if name in _SHAPES:
        return table.quantity(key, "", "> 0")
    if not (relative and unit):
        return table.quantity(key, unit)
    share = table.quantity(key, "")
    if share is None:
        return None
    if base is None or base == 0:
        of = "mean" if name == "deviation" else "nominal value"
        why = f"its {of} is {'not known' if base is None else 0}"
        table.faults.add(table.key(key), shown(value), f'"number {unit}"', why)
        return None
    # A deviation is a length: of a negative mean, too.
    return share * (abs(base) if name == "deviation" else base)
