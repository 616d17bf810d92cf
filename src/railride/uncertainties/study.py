"""The table ``[uncertainty]`` of a study file, and the study that it asks for.

=============== ===================================================================================
key             value
=============== ===================================================================================
``number``      designs of which the percentiles are; default 4096
``method``      ``"sobol"`` (default), ``"latin_hypercube"`` or ``"random"``
``seed``        of the sample; default 0
``percentiles`` per cent, default ``[5, 50, 95, 99]``
``indices``     whether to find Sobol's indices, for which number · (parameters + 1) designs are
                evaluated besides; default ``true``
=============== ===================================================================================
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from railride.distributions import METHODS, Distribution, refuse_sampling
from railride.errors import Faults, InputError
from railride.studies import Draft, Study
from railride.toml_tables import Table
from railride.uncertainties.propagation import PERCENTILES, SAMPLES, note_numbers
from railride.uncertainties.result import Uncertainty
from railride.uncertainties.ride import uncertainty


@dataclass(frozen=True)
class UncertaintySettings:
    """What ``[uncertainty]`` says; arguments of :func:`railride.uncertainties.uncertainty`."""

    samples: int = SAMPLES
    method: str = "sobol"
    seed: int = 0
    percentiles: tuple[float, ...] = PERCENTILES
    indices: bool = True


def read_uncertainty(table: Table, draft: Draft) -> UncertaintySettings:
    """The table's settings; for :func:`railride.read_study`, which raises the faults noted in it.

    Every parameter of the study must have a distribution, and there must be one.
    """
    usual = UncertaintySettings()
    number, seed = table.whole("number"), table.whole("seed")
    method, indices = table.choice("method", METHODS), table.flag("indices")
    given = table.quantities("percentiles", "")
    if given is not None and any(isinstance(p, str) for p in table.content["percentiles"]):
        table.fault("percentiles", "texts", "plain numbers, percentiles = [5, 50, 95]")
    table.finish()
    found = UncertaintySettings(
        samples=usual.samples if number is None else number,
        method=method or usual.method,
        seed=usual.seed if seed is None else seed,
        percentiles=usual.percentiles if given is None else given,
        indices=usual.indices if indices is None else indices,
    )
    wrong = Faults("")
    refuse_sampling(wrong, 2 * len(draft.parameters), found.samples, found.method, found.seed)
    note_numbers(wrong, "", found.samples, found.percentiles)
    table.faults.found += [replace(f, where=table.key(f.where)) for f in wrong.found]
    for one in draft.parameters:
        if not isinstance(one.spec, Distribution):
            table.faults.add(f"parameters.{one.name}", "no distribution", "one",
                             'such as distribution = "normal", deviation = "5 %"')  # fmt: skip
    if draft.names is not None and not draft.parameters:
        table.faults.add("parameters", "none", "a table [parameters.NAME] with a distribution")
    return found


def study_uncertainty(
    study: Study, *, progress: Callable[[float], None] | None = None
) -> Uncertainty:
    """The uncertainty study that a file asks for.

    study : as ``read_study(path, {"uncertainty": read_uncertainty})`` gives it.
    progress : called with the fraction that is done.

    Raises
    ------
    InputError : a study read without ``read_uncertainty``; what :func:`uncertainty` raises.

    Examples
    --------
    >>> from railride import read_study
    >>> study = read_study("uncertainty", {"uncertainty": read_uncertainty})
    >>> study.settings["uncertainty"].percentiles
    (5.0, 50.0, 95.0, 99.0)
    """
    settings = study.settings.get("uncertainty")
    if not isinstance(settings, UncertaintySettings):
        raise InputError("study: found no settings of an uncertainty study; expected one that was "
                         "read with read_uncertainty")  # fmt: skip
    ride = study.ride
    found = uncertainty(
        study.model(), {one.name: one.spec for one in study.parameters
                        if isinstance(one.spec, Distribution)},
        ride.tracks, ride.speeds, ride.positions, floor=ride.floor, weight=ride.weight,
        results=ride.results, progress=progress, **vars(settings),
    )  # fmt: skip
    return replace(found, title=study.name)
