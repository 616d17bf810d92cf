"""From a path to a table: what kind of file it is, by its content, and who reads it."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from railride.errors import Faults, InputError
from railride.tables.table import NumberTable

# Kind → the module that reads it, the library that needs, and how such a file is called.
_READERS = {
    "parquet": ("parquet", "pyarrow.parquet", "a Parquet file"),
    "wav": ("wav", "scipy.io.wavfile", "a WAV file"),
    "mat": ("matlab", "scipy.io", "a MATLAB file"),
    "hdf5": ("hdf5", "h5py", "an HDF5 file"),
}
_SUFFIXES = {
    ".parquet": "parquet",
    ".pq": "parquet",
    ".wav": "wav",
    ".mat": "mat",
    ".h5": "hdf5",
    ".hdf5": "hdf5",
    ".hdf": "hdf5",
}
# First bytes → kind, or what the file is where nobody here reads it.
_CONTENTS = {
    b"PAR1": "parquet",
    b"RIFF": "wav",
    b"RIFX": "wav",
    b"\x89HDF\r\n\x1a\n": "hdf5",
    b"MATLAB 7.3": "hdf5",
    b"MATLAB 5.0": "mat",
}
_OTHERS = {
    b"PK\x03\x04": "a ZIP archive or an Excel workbook",
    b"\xd0\xcf\x11\xe0": "an old Excel workbook",
    b"\x1f\x8b": "a file compressed by gzip",
    b"MDF ": "a measurement file in MDF",
    b"TDSm": "a measurement file in TDMS",
    b"%PDF": "a PDF",
}


def read_table(path: str | Path) -> NumberTable:
    """Read a file of numbers into columns, whatever its format.

    path: text (.csv, .txt, .tsv, .dat, .asc or any other suffix), Parquet, WAV, MATLAB's .mat or
        HDF5; told apart by content.

    Raises InputError naming row and column: no such file, a folder, not readable, empty, damaged,
    another format; a text whose rows are too short or too long or that has no numbers; a library
    that is not installed, with the extra that brings it. A cell that is no number is no fault here:
    NaN stands for it and :attr:`Column.bad` names it.
    """
    source, faults = Path(path), Faults(str(path))
    start = _first_bytes(source, faults)
    kind = next((kind for sign, kind in _CONTENTS.items() if start.startswith(sign)), "")
    other = next((name for sign, name in _OTHERS.items() if start.startswith(sign)), "")
    suffix_kind = _SUFFIXES.get(source.suffix.lower(), "")
    if other:
        faults.add("byte 0", other, "a table of numbers", "export the record as CSV")
    elif not kind and suffix_kind == "mat":
        kind = "mat"  # those before version 5 begin with no sign
    elif not kind and suffix_kind:
        expected = f"{_READERS[suffix_kind][2]}, as its name says"
        faults.add("byte 0", "other content", expected, "is it damaged, or text under that name?")
    faults.raise_if_any()
    return _read_binary(kind, source) if kind else _reader("text")(source)


def _first_bytes(path: Path, faults: Faults) -> bytes:
    """Read the beginning of the file; a clear fault where that is not possible."""
    start = b""
    try:
        with path.open("rb") as stream:
            start = stream.read(16)
    except IsADirectoryError:
        faults.add("file", "a folder", "a file of numbers", "name the file in it")
    except FileNotFoundError:
        faults.add("file", "no such file", "a file of numbers", "check the path")
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        faults.add("file", f"it cannot be read: {reason}", "a readable file")
    faults.raise_if_any()
    return start


def _read_binary(kind: str, path: Path) -> NumberTable:
    """Let the reader of that kind read; what its library complains of is a fault of the file."""
    module, library, name = _READERS[kind]
    try:
        import_module(library)
    except ImportError:
        raise InputError(
            f"{path}: file: found {name}, which needs {library.split('.')[0]}; expected it to be "
            "installed (pip install 'railride[formats]')"
        ) from None
    try:
        return _reader(module)(path)
    except InputError:
        raise
    except Exception as error:  # noqa: BLE001 - these libraries raise whatever they like
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(
            f"{path}: file: found {name} that cannot be read: {reason}; expected a whole one "
            "(is it damaged or cut off? Export it again, or as CSV)"
        ) from None


def _reader(name: str) -> Callable[[Path], NumberTable]:
    """The function of that module, which is loaded when such a file comes."""
    read: Callable[[Path], NumberTable] = getattr(
        import_module(f"railride.tables.{name}"), f"read_{name}"
    )
    return read
