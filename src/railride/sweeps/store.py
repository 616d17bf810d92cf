"""A folder of parts: each a whole file of designs in a row, that readers of Parquet take as one.

``part-000007.parquet`` holds the designs of the chunk number 7 (from 1). A part is written beside
its place and renamed, so that it is there as a whole or not at all; which parts are there says what
is done. Names that begin with a dot or an underscore are no results.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railride.errors import InputError
from railride.files import write_bytes
from railride.sweeps import lock, manifest
from railride.sweeps.manifest import Manifest
from railride.sweeps.worker import PROBLEM, Columns
from railride.tables.text import exactly

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow.parquet as pq

NUMBER = "design"  # heading of the designs' numbers, from 1
_PART = re.compile(r"part-(\d{6,})\.(parquet|csv)")
_BESIDE = re.compile(r"\.(part-\d+\.(parquet|csv)|_study\.json)\..+")  # not finished: killed
_MARK = b"railride.sweep"
_CELL = {"parquet": 8.3, "csv": 20.0}  # bytes of a number, at most: 64 bits do not shrink much
_PER_PART = {"parquet": 250.0, "csv": 40.0}  # bytes of a part for each column


def usual_form() -> str:
    """Parquet where its library is installed, else CSV."""
    from importlib.util import find_spec

    return "parquet" if find_spec("pyarrow") else "csv"


def check_form(form: str) -> None:
    """Refuse Parquet where its library is missing.

    Raises
    ------
    InputError : with the extra that brings it.
    """
    if form == "parquet" and usual_form() != "parquet":
        raise InputError("results: found no pyarrow, which Parquet needs; expected it to be "
                         "installed (pip install 'railride[formats]'), or format = \"csv\" in "
                         "[sweep]")  # fmt: skip


@dataclass(frozen=True)
class Store:
    """The parts of a sweep in a folder."""

    folder: Path
    of: Manifest

    @property
    def chunks(self) -> int:
        """How many parts there are when all is done."""
        return -(-self.of.designs // self.of.chunk)

    def span(self, chunk: int) -> tuple[int, int]:
        """First design of a chunk, and the one after its last; all from 0."""
        return chunk * self.of.chunk, min((chunk + 1) * self.of.chunk, self.of.designs)

    def path(self, chunk: int) -> Path:
        """Where the part of a chunk is."""
        return self.folder / f"part-{chunk + 1:06d}.{self.of.form}"

    def write(self, chunk: int, columns: Columns) -> None:
        """Write the results of a chunk, whole or not at all.

        Raises
        ------
        InputError : it cannot be written; a full disk.
        """
        start, stop = self.span(chunk)
        numbered = {NUMBER: np.arange(start + 1, stop + 1), **columns}
        encode = _parquet if self.of.form == "parquet" else _csv
        write_bytes(self.path(chunk), encode(numbered, self.of.fingerprint))

    def done(self) -> tuple[set[int], list[str]]:
        """Chunks whose parts are whole; and what was wrong with others, which are thrown away.

        Raises
        ------
        InputError : files that are no parts of this sweep.
        """
        refuse_foreign(self.folder, self)
        for path in self.folder.iterdir():
            if _BESIDE.fullmatch(path.name):
                path.unlink(missing_ok=True)
        found, damaged = set(), []
        for chunk in range(self.chunks):
            if self.path(chunk).exists():
                if self._is_whole(chunk):
                    found.add(chunk)
                else:
                    damaged.append(self.path(chunk).name)
                    self.path(chunk).unlink()
        return found, [f"{name} was damaged and is made again" for name in damaged]

    def _is_whole(self, chunk: int) -> bool:
        check = _is_whole_parquet if self.of.form == "parquet" else _is_whole_csv
        start, stop = self.span(chunk)
        return check(self.path(chunk), start + 1, stop, self.of)

    def clear(self) -> None:
        """Throw all parts away: before the manifest changes, so that none is taken for its own."""
        for path in parts_in(self.folder):
            path.unlink()

    def refuse_overflow(self, left: int, freed: int = 0) -> int:
        """Bytes that ``left`` chunks will take, at most.

        freed : bytes that will be freed before.

        Raises
        ------
        InputError : they do not fit on the disk.
        """
        cells, parts = 1 + len(self.of.parameters) + len(self.of.columns), _PER_PART[self.of.form]
        designs = min(left * self.of.chunk, self.of.designs)
        needed = round(designs * cells * _CELL[self.of.form] + left * cells * parts)
        free = shutil.disk_usage(self.folder).free + freed
        if needed > free:
            raise InputError(
                f"{str(self.folder)!r}: found {size(free)} free on its disk; expected "
                f"{size(needed)} for {designs:,} designs of {cells} columns (make room, give "
                "another folder, or ask for fewer designs or results)"
            )
        return needed


def size(number: float) -> str:
    """Bytes for people.

    >>> size(1234), size(5.6e9)
    ('1.23 kB', '5.6 GB')
    """
    for unit, scale in (("TB", 1e12), ("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if number >= scale:
            return f"{number / scale:.3g} {unit}"
    return f"{number:.0f} bytes"


def parts_in(folder: Path) -> list[Path]:
    """The parts in a folder, in the order of their numbers."""
    found = [path for path in folder.iterdir() if _PART.fullmatch(path.name)]
    return sorted(found, key=lambda path: (len(path.name), path.name))


def refuse_foreign(folder: Path, store: Store | None = None) -> None:
    """Refuse files that would be read as results, or anything at all where no sweep has been.

    store : of the sweep that the folder is of; None: a folder that none has written into.
    """
    own = set() if store is None else {store.path(chunk).name for chunk in _numbers(folder, store)}
    foreign = [
        path.name
        for path in sorted(folder.iterdir())
        if path.name not in own
        and path.name not in (lock.NAME, manifest.NAME)
        and (store is None or path.suffix in (".parquet", ".csv"))
        and not _BESIDE.fullmatch(path.name)
    ]
    if foreign:
        listed = ", ".join(foreign[:3]) + (f" and {len(foreign) - 3} more" * (len(foreign) > 3))
        raise InputError(
            f"{str(folder)!r}: found {listed}, not of this sweep; expected "
            + ("an empty folder, a new one, or that of a sweep" if store is None else "its parts")
            + " (give another folder, or move them away)"
        )


def _numbers(folder: Path, store: Store) -> Iterator[int]:
    """Chunks of the parts in a folder that a sweep may have written."""
    for path in parts_in(folder):
        match = _PART.fullmatch(path.name)
        if match and match[2] == store.of.form and 1 <= int(match[1]) <= store.chunks:
            yield int(match[1]) - 1


def read_part(path: Path, columns: Sequence[str] | None = None) -> pd.DataFrame:
    """One part as a table; all columns, or some.

    Raises
    ------
    InputError : a part that is damaged; Parquet without its library.
    """
    import pandas as pd

    if path.suffix == ".parquet":
        check_form("parquet")
        try:
            return pd.read_parquet(path, columns=None if columns is None else list(columns))
        except OSError as error:
            why = " ".join(str(error).split())
            raise InputError(f"{path}: found a damaged part ({why}); expected a whole one (delete "
                             "it, and sweep again: only it is made anew)") from None  # fmt: skip
    table = pd.read_csv(path, encoding="utf-8", dtype={PROBLEM: str}, **exactly(pd.__version__))
    table[PROBLEM] = table[PROBLEM].fillna("")
    return table if columns is None else table[list(columns)]


def _parquet(columns: Columns, mark: str) -> bytes:
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pa.table({name: _plain(values) for name, values in columns.items()})
    table = table.replace_schema_metadata({_MARK: mark.encode()})
    content = BytesIO()
    pq.write_table(table, content, compression="zstd")
    return content.getvalue()


def _csv(columns: Columns, mark: str) -> bytes:
    import pandas as pd

    del mark  # CSV has no place for it
    table = pd.DataFrame({name: _plain(values) for name, values in columns.items()})
    return bytes(table.to_csv(index=False, lineterminator="\n"), "utf-8")


def _plain(values: Any) -> Any:
    """Numbers as they are; texts as a list of them, each on one line."""
    if np.asarray(values).dtype.kind in "if":
        return values
    return [" ".join(str(value).split()) for value in values]


def _is_whole_parquet(path: Path, first: int, last: int, of: Manifest) -> bool:
    import pyarrow as pa
    import pyarrow.parquet as pq

    try:
        found = pq.read_metadata(path)
    except (pa.ArrowException, OSError):
        return False
    mark = (found.metadata or {}).get(_MARK, b"").decode(errors="replace")
    if mark != of.fingerprint:
        raise InputError(
            f"{path}: found a part of {'another sweep' if mark else 'no sweep'}; expected one of "
            "this sweep (move it away)"
        )
    return bool(found.num_rows == last - first + 1) and _numbers_of(found) == (first, last)


def _numbers_of(found: pq.FileMetaData) -> tuple[int, int]:
    """The least and the largest number of a design in a part, by its statistics."""
    groups = [found.row_group(k).column(0).statistics for k in range(found.num_row_groups)]
    return min(group.min for group in groups), max(group.max for group in groups)


def _is_whole_csv(path: Path, first: int, last: int, of: Manifest) -> bool:
    content = path.read_bytes()
    header = _csv(dict.fromkeys((NUMBER, *of.parameters, *of.columns), np.empty(0)), "")
    start = f"{first},".encode()
    end = content[content[:-1].rfind(b"\n") + 1 :]
    whole = content.endswith(b"\n") and end.startswith(f"{last},".encode())
    return whole and content.startswith(header + start) and content.count(b"\n") == last - first + 2
