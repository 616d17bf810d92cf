"""Track and spectrum files damaged at random: a clear error, or what stands in the file, said so.

Every variant has one thing wrong with it: a character, a cell, a line. What is read is compared
with what a reader who knows the layout makes of the same text, cell by cell; where that reader can
make nothing of it, the answer must be an error, or the undamaged numbers.
"""

from __future__ import annotations

import random

import numpy as np
import pytest

from railride.errors import InputError
from railride.spectra import read_spectrum
from railride.trackfile import read_track

VARIANTS = 200  # of each layout
X = [0.25 * j for j in range(40)]
W = [round(3.0 * np.sin(0.7 * j) + 1.5 * np.cos(0.31 * j), 3) for j in range(40)]
OMEGA = [round(0.05 * 1.1**j, 5) for j in range(40)]
S = [round(2.0 / x**3, 4) for x in OMEGA]

CAR = '"Count","Location [km+m]","Vasen Korkeuspoikkeama D1 [mm]","Oikea Korkeuspoikkeama D1 [mm]"'

LAYOUTS = {
    "commas": (",", ["distance_m,level_mm"], [f"{x},{w}" for x, w in zip(X, W, strict=True)]),
    "decimal commas": (
        ";",
        ["Distance [m];Level [mm]"],
        [f"{x};{w}".replace(".", ",") for x, w in zip(X, W, strict=True)],
    ),
    "tabs": (
        "\t",
        ["# by hand", "distance [m]\tspeed\tlevel [mm]"],
        [f"{x}\t80\t{w}" for x, w in zip(X, W, strict=True)],
    ),
    "geometry car": (
        ",",
        ['"Date","22/11/2022"', CAR],
        [f"{7 + j},130+{100 + x:07.2f},{w - 0.5:.3f},{w + 0.5:.3f}"
         for j, (x, w) in enumerate(zip(X, W, strict=True))],
    ),
    "spectrum": (
        ",",
        ["wavenumber [rad/m],density [mm^2/(rad/m)]"],
        [f"{x},{s}" for x, s in zip(OMEGA, S, strict=True)],
    ),
}  # fmt: skip


def damage(rng, separator, lines):
    """The lines as one text with one thing changed."""
    lines, at = list(lines), rng.randrange(len(lines))
    text = "\n".join(lines) + "\n"
    place = rng.randrange(len(text))
    marks = [j for j, c in enumerate(text) if c in ",;\t."]
    digits = [j for j, c in enumerate(text) if c.isdigit()]

    def put(j, new, old=1):
        return text[:j] + new + text[j + old :]

    def cell(new):
        cells = lines[at].split(separator)
        j = rng.randrange(len(cells))
        cells[j] = new + (cells[j] if new.isdigit() else "")
        lines[at] = separator.join(cells)

    def line(new):
        lines[at:at] = [new]

    kinds = {
        "a line less": lambda: lines.pop(at),
        "a line twice": lambda: line(lines[at]),
        "two lines changed about": lambda: line(lines.pop()),
        "a blank cell": lambda: cell(""),
        "no number": lambda: cell(rng.choice("abc inv 1.2.3 -- 1e 0x1F NaN 1_0".split())),
        "not finite": lambda: cell(rng.choice("inf -inf 1e999 nan".split())),
        "a digit more": lambda: cell(rng.choice("123456789")),
        "another line": lambda: line(rng.choice(["", "# c", "total 12", ";;;", "1,2,3,4,5"])),
        "a quote": lambda: lines.__setitem__(at, lines[at] + '"'),
        "a minus": lambda: lines.__setitem__(at, "-" + lines[at]),
        "cut off": lambda: text[:place],
        "a character less": lambda: put(place, ""),
        "a character more": lambda: put(place, rng.choice('0123456789.,;-e "\n\t+x'), 0),
        "another character": lambda: put(place, chr(rng.randrange(1, 256))),
        "another digit": lambda: put(rng.choice(digits), rng.choice("0123456789")),
        "another mark": lambda: put(rng.choice(marks), rng.choice(",;\t. ")),
    }
    kind = rng.choice(list(kinds))
    changed = kinds[kind]()
    whole = changed if kind in list(kinds)[10:] else "\n".join(lines) + "\n"
    return kind, whole


def plainly(layout, text):
    """First column and second, as they stand below the header; None where they cannot be told."""
    separator, heads, _ = LAYOUTS[layout]
    lines = [line for line in text.split("\n") if line.strip() and not line.startswith("#")]
    heads = [head for head in heads if not head.startswith("#")]
    if lines[: len(heads)] != heads:
        return None
    pairs = []
    for line in lines[len(heads) :]:
        cells = line.split(separator)
        try:
            if len(cells) != len(heads[-1].split(separator)):
                return None
            if layout == "geometry car":
                km, m = cells[1].split("+")
                pair = (1000 * float(km) + float(m), (float(cells[2]) + float(cells[3])) / 2)
            elif layout == "decimal commas":
                pair = tuple(float("x" if "." in c else c.replace(",", ".")) for c in cells)
            else:
                pair = float(cells[0]), float(cells[-1])
        except ValueError:
            return None
        pairs.append(pair)
    return np.array(pairs).T


def read(layout, path):
    """First column and second as railride reads them, the second in mm or mm²; and the remarks."""
    if layout != "spectrum":
        track = read_track(path)
        return track.distance, 1000.0 * track.level, track.remarks
    own = read_spectrum(path)
    low, high = own.limits
    points = np.array([low, *own.breakpoints, high])
    return points, 1e6 * own.density(points), own.remarks


def agrees(found, expected):
    return (
        len(found[0]) == len(expected[0])
        and np.allclose(found[0], expected[0], rtol=1e-9, atol=0.13)
        and np.allclose(found[1], expected[1], rtol=1e-9, atol=1e-9)
    )


@pytest.mark.parametrize("layout", LAYOUTS)
def test_damaged_files_are_refused_or_read_as_they_stand(layout, tmp_path):
    separator, heads, rows = LAYOUTS[layout]
    path, rng = tmp_path / "line4.csv", random.Random(20241)  # noqa: S311
    whole = plainly(layout, "\n".join([*heads, *rows]))
    refused = read_as_written = 0
    for _ in range(VARIANTS):
        kind, text = damage(rng, separator, [*heads, *rows])
        path.write_text(text, encoding="utf-8")
        try:
            found = read(layout, path)
        except InputError as error:
            for line in str(error).split("\n"):
                assert "line4.csv: " in line, (kind, text)
                assert "found " in line, (kind, text)
                assert "; expected " in line, (kind, text)
            refused += 1
            continue
        remarks, expected = " ".join(found[2]), plainly(layout, text)
        told = "resampled" in remarks or "one rail alone" in remarks or "goes back" in remarks
        if expected is None:  # a heading or another line is damaged, and the numbers are whole
            expected = whole
        assert told or agrees(found, expected), (kind, text, remarks)
        read_as_written += 1
    assert min(refused, read_as_written) > VARIANTS / 10
