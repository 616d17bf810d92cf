"""How files are damaged: their bytes, lines, tables of columns; and changes that mean the same.

Each is a function of a random source and the file's content that gives the content back changed;
where there is nothing of the kind to change, as it was.
"""

from __future__ import annotations

import re

WORDS = ["", "NaN", "nan", "NA", "inf", "-inf", "Infinity", "abc", "inv", "1e999", "-1e308", "1,5",
         "1_000", "0x1F", "--1", "1e", "٣", "#REF!", "TRUE", "12:00", '"', "'", "1 2", "\x00", "\r",
         "9" * 400, "1e-400", "2024-01-01", "é", "\ufeff", "😀", "None", "-",
         "+", ".", "e5"]  # fmt: skip
NUMBERS = [*WORDS, "0", "-0", "-1", "1e300", "1e-300", "1e30", "1e-30", "1e16", "½", "１２", "∞",
           "1.2.3", "$1$", "0.1"]  # fmt: skip
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def put(rng, pattern, text, new):
    """One of the places that fit a pattern, at random, replaced by ``new`` of it."""
    found = list(re.finditer(pattern, text))
    if not found:
        return text
    one = rng.choice(found)
    return text[: one.start()] + new(one) + text[one.end() :]


# Bytes


def damage_bytes(rng, data):
    data = bytearray(data)
    for _ in range(rng.choice((1, 1, 1, 3, 20))):
        place = rng.randrange(len(data))
        kind = rng.randrange(4)
        if kind == 0:
            data[place] ^= 1 << rng.randrange(8)
        elif kind == 1:
            del data[place]
        elif kind == 2:
            data.insert(place, rng.randrange(256))
        else:
            data[place : place + 8] = bytes(rng.randrange(256) for _ in range(8))
    return bytes(data)


def _stretch(rng, data):
    first, last = sorted(rng.randrange(len(data) + 1) for _ in range(2))
    return first, min(last, first + rng.choice((1, 5, 60, len(data))))


def lose_stretch(rng, data):
    first, last = _stretch(rng, data)
    return data[:first] + data[last:]


def double_stretch(rng, data):
    first, last = _stretch(rng, data)
    return data[:last] + data[first:]


def exchange_stretches(rng, data):
    a, b, c = sorted(rng.randrange(len(data) + 1) for _ in range(3))
    return data[:a] + data[b:c] + data[a:b] + data[c:]


def insert_bytes(rng, data):
    new = rng.choice((b"\0", b"\0" * 50, b"\xff", b"\xed\xa0\x80", b"\r", b"\x1a", b"\x1b[2J",
                      b"\xef\xbb\xbf", b"x" * 20_000, b"9" * 20_000, b"\n" * 2000,
                      "٣".encode(), "\u2028".encode(), "é".encode("latin-1")))  # fmt: skip
    place = rng.randrange(len(data) + 1)
    return data[:place] + new + data[place:]


def change_encoding(rng, data):
    encoding = rng.choice(("utf-16", "utf-16-le", "utf-32", "latin-1", "cp1252", "utf-7", "cp500"))
    coded = data.decode("utf-8").encode(encoding, "replace")
    cut = rng.choice((0, rng.randrange(len(data) + 1)))
    return data[:cut] + coded[cut:]


BYTES = {
    "bytes": damage_bytes,
    "a stretch less": lose_stretch,
    "a stretch twice": double_stretch,
    "stretches changed about": exchange_stretches,
    "bytes put in": insert_bytes,
    "encoding": change_encoding,
    "cut off": lambda rng, data: data[: rng.randrange(len(data))],
    "nothing": lambda _, data: data[:0],
}


# Lines, of any text


def damage_line(rng, text):
    """A line lost, doubled, emptied, cut, or in another place."""
    lines = text.split("\n")
    row, other = rng.randrange(len(lines)), rng.randrange(len(lines))
    kind = rng.randrange(5)
    if kind == 0:
        del lines[row]
    elif kind == 1:
        lines.insert(other, lines[row])
    elif kind == 2:
        lines[row], lines[other] = lines[other], lines[row]
    elif kind == 3:
        lines[row] = lines[row][: rng.randrange(len(lines[row]) + 1)]
    else:
        lines[row] *= rng.choice((2, 500))
    return "\n".join(lines)


# The same in other lines

SAME_LINES = {
    "line ends": lambda _, text: text.replace("\n", "\r\n"),
    "byte order mark": lambda _, text: "\ufeff" + text,
    "blank lines": lambda _, text: text + "\n\n",
}


# Tables of columns


def _cells(rng, text, new):
    """The cells of one line put otherwise, by a list of them and the separator."""
    lines = text.rstrip("\n").split("\n")
    row = rng.randrange(len(lines))
    separator = next((s for s in ";\t," if s in lines[row]), ",")
    lines[row] = separator.join(new(lines[row].split(separator)))
    return "\n".join(lines) + "\n"


def damage_cell(rng, text):
    def new(cells):
        cells[rng.randrange(len(cells))] = rng.choice(NUMBERS)
        return cells

    return _cells(rng, text, new)


def damage_cells(rng, text):
    """A line with a cell less, more, or its cells in another order."""

    def new(cells):
        place = rng.randrange(len(cells))
        return rng.choice((cells[:place] + cells[place + 1 :], [*cells, cells[place]], cells[::-1]))

    return _cells(rng, text, new)


def scale_column(rng, text):
    """All numbers of one column in another size."""
    lines, column = text.rstrip("\n").split("\n"), rng.randrange(3)
    factor = rng.choice(("0", "-1", "1e3", "1e-3", "1e9", "1e300", "1e-300", "nan"))

    def new(line):
        cells = line.split(",")
        if column < len(cells) and NUMBER.fullmatch(cells[column]):
            cells[column] = f"{float(cells[column]) * float(factor):.9g}"
        return ",".join(cells)

    return "\n".join(new(line) for line in lines) + "\n"


def lose_or_double_column(rng, text):
    lines = [line.split(",") for line in text.rstrip("\n").split("\n")]
    column, double = rng.randrange(3), rng.random() < 0.5
    for cells in lines:
        if column < len(cells):
            cells[column : column + 1] = cells[column : column + 1] * 2 * double
    return "\n".join(map(",".join, lines)) + "\n"


def damage_heading(rng, text):
    head, _, body = text.partition("\n")
    return rng.choice((
        lambda: body,
        lambda: head + "\n" + text,
        lambda: head.upper() + "\n" + body,
        lambda: re.sub(r"mm|m\b", rng.choice(("kg", "cm", "km", "parsec", "")), head) + "\n" + body,
        lambda: re.sub(r"\w+", lambda one: rng.choice((one[0], "level", "x")), head) + "\n" + body,
        lambda: head.replace(",", " ") + "\n" + body,
        lambda: "# " + text,
        lambda: "a,b\n" * rng.randrange(1, 5) + text,
        lambda: body + head + "\n",
    ))()  # fmt: skip


def damage_marks(rng, text):
    """Separators or decimal marks changed, of all lines or from somewhere on."""
    cut = rng.choice((0, rng.randrange(len(text))))
    one, other = rng.choice(((",", ";"), (",", "\t"), (",", " "), (".", ","), (",", "."), (",", ""),
                             (".", ""), ("\n", ""), ("\n", ",\n"), ("\n", "\r"), ("-", "−"),
                             ("\n", "\n\n"), (",", ",,"), (",", ', "')))  # fmt: skip
    return text[:cut] + text[cut:].replace(one, other)


def damage_rows(rng, text):
    """Rows in another order, all twice, or most of them gone."""
    head, *rows = text.rstrip("\n").split("\n")
    few = rng.randrange(len(rows))
    gap, same = [*rows[:few], *rows[few + 3 :]], [rows[0]] * len(rows)
    rows = rng.choice((rows[::-1], rows * 2, rows[:few], rows[few:], rows[:2], gap, same,
                       rng.sample(rows, few)))  # fmt: skip
    return "\n".join([head, *rows]) + "\n"


COLUMNS = {
    "a line": damage_line,
    "a cell": damage_cell,
    "cells": damage_cells,
    "a column's size": scale_column,
    "a column": lose_or_double_column,
    "the heading": damage_heading,
    "marks": damage_marks,
    "rows": damage_rows,
}


# The same in columns, separated by commas


def notation(_, text):
    head, _, body = text.partition("\n")
    return head + "\n" + NUMBER.sub(lambda one: f"{float(one[0]):.17e}", body)


SAME_COLUMNS = SAME_LINES | {
    "encoding": lambda _, text: text.encode("utf-16"),
    "tabs": lambda _, text: text.replace(",", "\t"),
    "decimal commas": lambda _, text: text.replace(",", ";").replace(".", ","),
    "quotes": lambda _, text: re.sub(r"[^,\n]+", r'"\g<0>"', text),
    "blanks": lambda _, text: text.replace(",", " ,  "),
    "a comment": lambda _, text: "# as it is\n" + text,
    "notation": notation,
}
