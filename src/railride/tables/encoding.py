"""Bytes of a text file as UTF-8 with line feeds: byte order marks, UTF-16, Windows-1252."""

from __future__ import annotations

import codecs
import re
from pathlib import Path

from railride.errors import Faults

_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF32_BE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_CONTROLS = re.compile(rb"[\x00-\x08\x0e-\x1f\x7f]")
_MULTIBYTE = re.compile(rb"[\xc2-\xdf][\x80-\xbf]|[\xe1-\xef][\x80-\xbf]{2}")


def read_utf8(path: Path) -> tuple[bytes, list[str]]:
    """Content of a text file as UTF-8 without byte order mark, lines ended by line feeds; remarks.

    path: an existing file. Without a mark it is UTF-8, or else Windows-1252 (Latin-1 among it), the
        latter with a remark, unless something speaks against it: letters in UTF-8 elsewhere in the
        file (then it is damaged), bytes that mean nothing in Windows-1252, control characters.
        Numbers are ASCII in each of them, so that no choice changes one.

    Raises InputError naming row and byte: no text, damaged, empty.
    """
    faults = Faults(str(path))
    data, remarks = b"", list[str]()
    try:
        data = path.read_bytes()
        mark, name = next(((m, n) for m, n in _MARKS if data.startswith(m)), (b"", ""))
        if name == "utf-8":
            data = data[len(mark) :]
        elif name:
            data = data.decode(name).encode("utf-8")
    except UnicodeError as error:
        faults.add("file", f"a mark of {name.upper()} but {error}", "text", "save it as UTF-8")
    except OSError as error:
        faults.add("file", f"it cannot be read: {error.strerror}", "a readable file")
    faults.raise_if_any()
    data = data.rstrip(b"\x1a")  # the end of file of DOS
    _refuse_controls(data, faults)
    try:
        if not data.isascii():
            data.decode("utf-8")
    except UnicodeDecodeError as error:
        data = _from_windows(data, error.start, faults, remarks)
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if not data.strip():
        faults.add("file", "an empty file", "a table of numbers")
    faults.raise_if_any()
    return data, remarks


def _refuse_controls(data: bytes, faults: Faults) -> None:
    """Refuse what no text has: a zero byte, or another control character."""
    match = _CONTROLS.search(data)
    if match is None:
        return
    byte, at = data[match.start()], match.start()
    if byte == 0 and at <= 3 and data[:64].count(0) > 16:
        found, mend = "text in UTF-16 without a byte order mark", "save it as UTF-8"
    else:
        name = "a zero byte" if byte == 0 else f"the control character 0x{byte:02x}"
        found, mend = f"{name}: this is not text", "is the file damaged there? Export it again"
    faults.add(f"row {_row(data, at)}, byte {at} of the file", found, "text", mend)
    faults.raise_if_any()


def _from_windows(data: bytes, at: int, faults: Faults, remarks: list[str]) -> bytes:
    """``data``, which is not UTF-8 from byte ``at`` on, as Windows-1252 where that is safe."""
    row = _row(data, at)
    text = ""
    try:
        text = data.decode("cp1252")
    except UnicodeDecodeError as error:
        at, row = error.start, _row(data, error.start)
    if text and not _MULTIBYTE.search(data):
        line = re.split(r"\r\n|\r|\n", text)[row - 1]
        word = next((w for w in re.findall(r"\S+", line) if not w.isascii()), "")
        remarks.append(
            f"the text is not UTF-8 and was read as Windows-1252 ({word!r} in row {row})"
        )
        return text.encode("utf-8")
    faults.add(
        f"row {row}, byte {at} of the file",
        f"0x{data[at]:02x}, which is not UTF-8",
        "text in UTF-8",
        "is the file damaged there? Export it again, as CSV UTF-8",
    )
    return b""


def _row(data: bytes, at: int) -> int:
    return len(re.findall(rb"\r\n|\r|\n", data[:at])) + 1
