"""A sweep: every design of a study evaluated, the results written as they come."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import replace
from functools import partial
from pathlib import Path
from uuid import uuid4

from railride.errors import InputError
from railride.quantities import check_whole
from railride.stochastic import track_spectrum
from railride.studies import Study
from railride.sweeps import lock, manifest
from railride.sweeps.cluster import cluster
from railride.sweeps.lock import locked
from railride.sweeps.manifest import Manifest, keys_of, read_manifest, refuse_another
from railride.sweeps.pool import InProcess, LocalPool
from railride.sweeps.result import SweepResult, sweep_result
from railride.sweeps.settings import SweepSettings, read_sweep_study
from railride.sweeps.store import Store, check_form, parts_in, refuse_foreign, usual_form
from railride.sweeps.task import Progress, Task
from railride.sweeps.worker import Recipe, headings

Means = tuple[Executor, Callable[[], Executor] | None, int, Callable[[], None] | None]
"""An executor, what starts another in its place, how many chunks may be in flight, a check."""

PER_WORKER = 2  # chunks in flight: one at work, one waiting


def sweep(
    study: Study | str | Path,
    folder: str | Path,
    *,
    executor: Executor | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    replace: bool = False,
    progress: Progress | None = None,
) -> SweepResult:
    """Evaluate every design of a study; the results go into a folder, a part at a time.

    What is finished stays, whatever ends it: called again, it goes on where it stopped. Scripts
    that call it need ``if __name__ == "__main__":``, since the processes import them again; in a
    notebook there is nothing to mind.

    Parameters
    ----------
    study : with the section ``[sweep]``; or its name or file (see ``docs/study-files.md``).
    folder : of the results; made if it is not there. Parquet files, or CSV where pyarrow is missing
        or the study asks for it; :func:`read_sweep` reads them.
    executor : where designs are evaluated, any of ``concurrent.futures``; default processes of
        this machine, or this one where there is a single part.
    workers : how many processes, default one for each core; of an executor, how many tasks it works
        on at a time.
    scheduler : address of a Dask scheduler, in place of them (extra ``railride[distributed]``).
    replace : throw away what the folder holds of another study, or of this one before it was
        changed, instead of refusing it.
    progress : called with how many designs are done, and of how many.

    Returns
    -------
    result : where the results are, how many designs are done, the best of them, and what to know.

    Raises
    ------
    InputError : a study file with faults; a folder with something else in it, or in which another
        sweep writes; a changed study, unless ``replace``; a disk that is, or would become, full; a
        scheduler that does not answer; designs that kill their workers.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     found = sweep("sweep_grid", folder)
    >>> found.designs, found.done
    (567, 567)
    """
    if not isinstance(study, Study):
        study = read_sweep_study(study)
    settings = study.settings.get("sweep")
    if not isinstance(settings, SweepSettings):
        raise InputError(f"{study.path}: found no designs; expected a study with [sweep] read "
                         "(railride.sweeps.read_sweep_study)")  # fmt: skip
    if (executor is not None) + (scheduler is not None) > 1:
        raise InputError("sweep: found an executor and a scheduler; expected one of them")
    if workers is not None:
        check_whole(workers, "workers", least=1)
    with _made(folder) as place, locked(place):
        recipe, said = _prepared(study)
        asked = _manifest(study, settings, recipe)
        store, thrown = _opened(place, asked, settings.form, replace)
        done, damaged = store.done()
        task = Task(store, settings.plan, recipe, done, progress)
        store.refuse_overflow(len(task.left))
        with _executors(executor, workers, scheduler, len(task.left)) as means:
            task.run(*means)
        return sweep_result(place, store.of, task.new, [*said, *thrown, *damaged])


@contextlib.contextmanager
def _made(folder: str | Path) -> Iterator[Path]:
    """The folder, made if it is not there; not left behind where nothing comes of it."""
    made: list[Path] = []
    try:
        place = Path(folder)
        made += [path for path in (place, *place.parents) if not path.exists()]
        place.mkdir(parents=True, exist_ok=True)
    except (OSError, TypeError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{str(folder)!r}: found {reason}; expected a folder that can be made or "
                         "is there (choose another)") from None  # fmt: skip
    try:
        yield place
    except BaseException:
        if made and not parts_in(place):
            with contextlib.suppress(OSError):
                for name in (lock.NAME, manifest.NAME):
                    (place / name).unlink(missing_ok=True)
                for path in made:
                    path.rmdir()
        raise


def _prepared(study: Study) -> tuple[Recipe, list[str]]:
    """What workers need, the tracks as spectra; and what to know of the results."""
    model, ride = study.model(), study.ride
    spectra = [track_spectrum(track, ride.speeds) for track in ride.tracks]
    said = [*model.vehicle.remarks, *model.remarks, *(r for _, remarks in spectra for r in remarks)]
    ride = replace(ride, tracks=tuple(spectrum for spectrum, _ in spectra))
    return Recipe(uuid4().hex, study.vehicle, study.body, ride), said


def _manifest(study: Study, settings: SweepSettings, recipe: Recipe) -> Manifest:
    """What the results will be of; the first design says which columns there are."""
    plan = settings.plan
    return Manifest(
        study=study.name,
        keys=keys_of(study, plan),
        parameters=[p.heading for p in plan.parameters],
        columns=headings(recipe, study.model(), plan.designs(0, 1)),
        designs=plan.total,
        chunk=settings.chunk,
        form=settings.form or usual_form(),
    )


def _opened(
    folder: Path, asked: Manifest, form: str | None, change: bool
) -> tuple[Store, list[str]]:
    """The store of the sweep, begun or gone on with; and what to know of it.

    form : "parquet" or "csv" where it was asked for. change : throw away what is of another study.
    """
    before = read_manifest(folder)
    if before is not None and form is None:  # go on as it was begun
        asked = replace(asked, form=before.form)
    store = Store(folder, asked)
    check_form(asked.form)
    differences = [] if before is None else asked.differences(before)
    if before is None:
        refuse_foreign(folder)
    elif differences and not change:
        refuse_another(folder, differences)
    elif not differences:
        return store, []
    else:
        refuse_foreign(folder, Store(folder, before))
    earlier = parts_in(folder)
    store.refuse_overflow(store.chunks, freed=sum(path.stat().st_size for path in earlier))
    store.clear()  # before the manifest changes, so that no part is taken for one of this sweep
    asked.write(folder)
    thrown = f"{len(earlier)} parts of {before.study!r} were thrown away" if before else ""
    return store, [thrown] if earlier else []


@contextlib.contextmanager
def _executors(
    executor: Executor | None, workers: int | None, scheduler: str | None, left: int
) -> Iterator[Means]:
    """By which means ``left`` chunks are evaluated."""
    count = workers or os.cpu_count() or 1
    if executor is not None:
        yield executor, None, PER_WORKER * count, None
    elif scheduler is not None and left:
        with cluster(scheduler) as (found, tasks, check):
            yield found, None, PER_WORKER * tasks, check
    elif left <= 1:
        yield InProcess(), None, 1, None
    else:
        start = partial(LocalPool, min(count, left))
        yield start(), start, PER_WORKER * min(count, left), None
