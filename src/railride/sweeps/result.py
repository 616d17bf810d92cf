"""What a sweep comes to: where its results are, how many, and the best of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from railride.errors import InputError
from railride.quantities import names
from railride.stochastic.ride import STATED
from railride.sweeps.manifest import Manifest, read_manifest
from railride.sweeps.store import NUMBER, parts_in, read_part
from railride.sweeps.worker import ERROR, PROBLEM

if TYPE_CHECKING:
    import pandas as pd

BEST = 5  # designs shown of each case
RATED = "a_wrms "  # how the headings of what is to be small begin


@dataclass(frozen=True)
class SweepResult:
    """Results of a sweep in a folder.

    folder : of the parts. study : the study's name. designs : how many there are in all, of which
    ``done`` have their results there, ``new`` of them from this call. parameters, columns :
    headings of the tables, next to "design", the number. form : "parquet" or "csv".
    problems : how many designs have no values; the column "problem" says why.
    best : heading of a weighted r.m.s. → the five designs that have the least, with it.
    remarks : what to know of the results.
    """

    folder: Path
    study: str
    designs: int
    done: int
    new: int
    parameters: tuple[str, ...]
    columns: tuple[str, ...]
    form: str
    problems: int
    best: dict[str, pd.DataFrame]
    remarks: tuple[str, ...] = ()

    @property
    def count(self) -> int:
        """How many parts there are."""
        return len(parts_in(self.folder))

    @property
    def bytes(self) -> int:
        """How much they take on the disk."""
        return sum(path.stat().st_size for path in parts_in(self.folder))

    def parts(self, columns: Sequence[str] | None = None) -> Iterator[pd.DataFrame]:
        """The parts one by one, so that not all have to fit into memory.

        columns : some of the headings; default all.

        Raises
        ------
        InputError : a heading that there is none of; a part that cannot be read.
        """
        if columns is not None:
            columns = self._known(columns)
        for path in parts_in(self.folder):
            yield read_part(path, columns)

    def _known(self, columns: Sequence[str]) -> list[str]:
        """The headings, each of which there is."""
        known, asked = [NUMBER, *self.parameters, *self.columns], names(columns, "columns")
        unknown = [name for name in asked if name not in known]
        if unknown:
            raise InputError(f"columns: found {', '.join(map(repr, unknown))}; expected some of "
                             f"{', '.join(map(repr, known))}")  # fmt: skip
        return asked

    def table(self, columns: Sequence[str] | None = None) -> pd.DataFrame:
        """All designs as one table, a row for each in the order of their numbers.

        columns : some of the headings; default all.

        Raises
        ------
        InputError : as :meth:`parts`.
        """
        import pandas as pd

        found = list(self.parts(columns))
        return pd.concat(found, ignore_index=True) if found else pd.DataFrame()


def sweep_result(
    folder: Path, of: Manifest, new: int = 0, remarks: Sequence[str] = ()
) -> SweepResult:
    """The result of the sweep in a folder, part by part."""
    rated = [heading for heading in of.columns if heading.startswith(RATED)]
    best: dict[str, pd.DataFrame] = {}
    doubts = _Doubts()
    done = 0
    for path in parts_in(folder):
        part = read_part(path, [NUMBER, *of.parameters, *rated, ERROR, PROBLEM])
        done += len(part)
        doubts.take(part)
        for heading in rated:
            best[heading] = _least(best.get(heading), part, heading, of.parameters)
    return SweepResult(
        folder=folder,
        study=of.study,
        designs=of.designs,
        done=done,
        new=new,
        parameters=tuple(of.parameters),
        columns=tuple(of.columns),
        form=of.form,
        problems=doubts.problems,
        best=best,
        remarks=(*dict.fromkeys(remarks), *doubts.remarks),
    )


@dataclass
class _Doubts:
    """Designs that lack values, and values that are uncertain."""

    problems: int = 0
    first: str = ""
    uncertain: int = 0
    largest: float = 0.0

    def take(self, part: pd.DataFrame) -> None:
        """Count those of a part."""
        lacking = part[part[PROBLEM] != ""]
        if len(lacking) and not self.first:
            self.first = f"design {lacking[NUMBER].iloc[0]}: {lacking[PROBLEM].iloc[0]}"
        self.problems += len(lacking)
        self.uncertain += int((part[ERROR] > STATED).sum())
        self.largest = max(self.largest, float(part[ERROR].max(skipna=True)))

    @property
    def remarks(self) -> list[str]:
        """What to know of them."""
        said = []
        if self.problems:
            said.append(f"{self.problems:,} designs lack values, the column {PROBLEM!r} says why; "
                        f"the first of them, {self.first}")  # fmt: skip
        if self.uncertain:
            said.append(f"values of {self.uncertain:,} designs are uncertain by up to "
                        f"{self.largest:.0e} of themselves, see the column {ERROR!r} (a mode with "
                        "next to no damping?)")  # fmt: skip
        return said


def _least(
    so_far: pd.DataFrame | None, part: pd.DataFrame, heading: str, parameters: Sequence[str]
) -> pd.DataFrame:
    """The best of those so far and of a part."""
    import pandas as pd

    found = part.loc[part[heading].notna(), [NUMBER, *parameters, heading]]
    found = found.nsmallest(BEST, heading)
    both = found if so_far is None else pd.concat([so_far, found])
    return both.nsmallest(BEST, heading).reset_index(drop=True)


def read_sweep(folder: str | Path) -> SweepResult:
    """The results of a sweep, finished or not, from its folder.

    Parameters
    ----------
    folder : in which :func:`sweep`, or ``railride sweep``, has written.

    Raises
    ------
    InputError : a folder in which no sweep has written.
    """
    try:
        place = Path(folder)
    except TypeError:
        raise InputError(f"folder: found {folder!r}; expected the path of one") from None
    found = read_manifest(place)
    if found is None:
        raise InputError(f"{str(folder)!r}: found no sweep; expected a folder in which one has "
                         "written (check the path)")  # fmt: skip
    return sweep_result(place, found)
