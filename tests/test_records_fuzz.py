"""Damaged files of records: refused with a clear error or read right, never anything else."""

from __future__ import annotations

import random
import re

import h5py
import numpy as np
import pandas as pd
import pytest
from damage import WORDS, damage_bytes
from scipy.io import savemat, wavfile

from railride.errors import InputError
from railride.records import read_record

RATE = 100.0
T = np.arange(600) / RATE


def f(t, axis=0):
    """A ride's acceleration, m/s², smooth at the rate of the tests."""
    return 0.3 * np.sin(2 * np.pi * (1.1 + axis) * t + axis) + 0.2 * np.cos(2 * np.pi * 5.3 * t)


def fuzz_text(n=260):
    t = np.arange(n) / RATE
    rows = zip(t, f(t), f(t, 1), f(t, 2), strict=True)
    return "time [s],z [m/s²],y [m/s²],x [m/s²]\n" + "".join(
        f"{a:.3f},{b:.6f},{c:.6f},{d:.6f}\n" for a, b, c, d in rows
    )


def damage_cell(rng, lines):
    row, cell = rng.randrange(1, len(lines)), rng.randrange(4)
    cells = lines[row].split(",")
    cells[cell] = rng.choice(WORDS)
    lines[row] = ",".join(cells)


def damage_row(rng, lines):
    row = rng.randrange(1, len(lines))
    kind = rng.randrange(7)
    if kind == 0:
        del lines[row]
    elif kind == 1:
        lines.insert(row, lines[row])
    elif kind == 2:
        lines[row] = ""
    elif kind == 3:
        lines[row] = lines[row][: rng.randrange(len(lines[row]) + 1)]
    elif kind == 4:
        lines[row] = lines[row].replace(",", ";")
    elif kind == 5:
        lines[row] = lines[row].replace(".", ",")
    elif row + 1 < len(lines):
        lines[row], lines[row + 1] = lines[row + 1], lines[row]


def damage_layout(rng, text):
    """The whole file in another form, which must read as the same record or be refused."""
    header, _, body = text.partition("\n")
    return rng.choice((
        lambda: text.replace(",", ";"),
        lambda: text.replace(",", "\t").replace(".", ","),
        lambda: text.replace(",", "; ").replace(".", ","),
        lambda: text.replace(".", ","),
        lambda: text.encode("utf-16"),
        lambda: text.encode("utf-16-le"),
        lambda: text.encode("cp1252"),
        lambda: text.encode("utf-8-sig"),
        lambda: text.encode("utf-7"),
        lambda: text.replace("\n", "\r\n"),
        lambda: text.replace("\n", "\r"),
        lambda: text.replace("\n", "\n\n"),
        lambda: text.replace("\n", ""),
        lambda: text.replace("\n", ",\n"),
        lambda: "\n".join([header, *reversed(body.strip().split("\n"))]),
        lambda: text + text,
        lambda: body,
        lambda: "# " + text,
        lambda: "a,b\n" * rng.randrange(1, 5) + text,
        lambda: text + "mean,0.1,0.2,0.3\n",
        lambda: '"' + text.replace(",", '","').replace("\n", '"\n"') + '"\n',
        lambda: text.replace(header, header.replace("]", "")),
        lambda: text.replace(header, header.replace(",", " ")),
        lambda: body.replace("\n", f"\n{header}\n", 1),
    ))()  # fmt: skip


def damaged(seed):
    """Content of a damaged file, and whether all of it was touched."""
    rng = random.Random(seed)  # noqa: S311
    text = fuzz_text()
    if seed % 4 == 0:
        layout = damage_layout(rng, text)
        return (layout if isinstance(layout, bytes) else layout.encode()), True
    if seed % 4 == 1:
        return damage_bytes(rng, text.encode()), False
    lines = text.rstrip("\n").split("\n")
    for _ in range(rng.choice((1, 1, 2, 30))):
        (damage_cell if seed % 4 == 2 else damage_row)(rng, lines)
    content = "\n".join(lines) + "\n"
    if rng.random() < 0.2:
        content = content[: rng.randrange(len(content))]
    return content.encode("utf-8", "surrogatepass"), False


def untouched_rows(content):
    """Places of the rows that stand in the damaged file as in the good one."""
    good = fuzz_text().encode().split(b"\n")[1:-1]
    left = set(re.split(rb"[\r\n]+", content))
    return np.array([line in left for line in good])


def check_right(record, content, whole):
    """Each sample is the good file's at its time; what is missing among them is told.

    A sample counts where its own row is untouched. Near a time that is wrong but rises, resampling,
    which is told, reaches further.
    """
    n = 260
    same = np.ones(n, dtype=bool) if whole else untouched_rows(content)
    resampled = bool(told(record, "uneven"))
    if resampled:
        same = np.convolve(~same, np.ones(81), mode="same") == 0
    found = 0
    for axis in record.axes:
        of = {"z": 0, "y": 1, "x": 2}[axis.direction]
        first = first_row(record, of)
        found = 0
        for start, piece in zip(record.starts, axis.pieces, strict=True):
            found += piece.size
            t = first / RATE + start + np.arange(piece.size) / record.rate
            k = np.clip(np.round(t * RATE).astype(int), 0, n - 1)
            exact = f(t, of) if resampled else np.round(f(k / RATE, of), 6)
            wrong = same[k] & (np.abs(piece - exact) > (2e-3 if resampled else 1e-12))
            assert not np.any(wrong), (axis.column, k[wrong][:5])
    present = np.flatnonzero(untouched_rows(content))
    cut = 0 if whole or not present.size else n - 1 - present[-1]
    lost = n - found - cut
    ends = 2 if resampled else 0  # the even grid lies within the times
    assert lost <= ends or told(record, "gap|at the start|at the end|left out|cut off"), lost
    assert len(record.axes) == 3 or told(record, "not used")


def first_row(record, of):
    """Row of the good file at which the record begins: the clock counts from the first row read."""
    piece, start = record.axes[0].pieces[0][:30], round(record.starts[0] * RATE)
    direction = {"z": 0, "y": 1, "x": 2}[record.axes[0].direction]
    good = f(np.arange(300) / RATE, direction)
    fits = [np.median(np.abs(piece - good[k : k + piece.size])) for k in range(250)]
    return int(np.argmin(fits)) - start


def told(record, text):
    return any(re.search(text, remark) for remark in record.remarks)


@pytest.fixture(scope="module")
def fuzz_folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@pytest.mark.parametrize("block", range(12))
def test_damaged_files_are_refused_or_read_right(fuzz_folder, block):
    """600 of them: an InputError that names the file, or every sample right and every loss told."""
    path = fuzz_folder / f"fuzz{block}.csv"
    read = 0
    for seed in range(50 * block, 50 * block + 50):
        content, whole = damaged(seed)
        path.write_bytes(content)
        record, message = attempt(path)
        if record is None:
            assert path.name in message, seed
            continue
        read += 1
        try:
            check_right(record, content, whole)
        except AssertionError as error:
            raise AssertionError(f"seed {seed}: {error}; remarks {record.remarks}") from error
    assert 5 < read < 45


def attempt(path):
    """The record, or None and the message of the one error there may be."""
    try:
        return read_record(path), ""
    except InputError as error:
        return None, str(error)


@pytest.mark.parametrize("name", ["a.parquet", "a.wav", "a.mat", "a.h5"])
def test_damaged_binary_files_never_end_in_anything_but_an_input_error(tmp_path, name):
    path = tmp_path / name
    if name == "a.parquet":
        pd.DataFrame({"time": T, "z": f(T)}).to_parquet(path)
    elif name == "a.wav":
        wavfile.write(path, 100, f(T))
    elif name == "a.mat":
        savemat(path, {"t": T, "z": f(T)})
    else:
        with h5py.File(path, "w") as file:
            file["t"], file["z"] = T, f(T)
    good = path.read_bytes()
    rng = random.Random(name)  # noqa: S311
    for k in range(40):
        cut = good[: rng.randrange(len(good))] if k % 4 == 0 else good
        path.write_bytes(damage_bytes(rng, cut) if cut else b"")
        record, message = attempt(path)
        assert record is not None or name in message
