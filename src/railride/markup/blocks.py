"""The blocks that a document is made of; their text may hold ``$mathematics$`` and ```code```."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Heading:
    """A heading; level 1 is the title."""

    text: str
    level: int = 2


@dataclass(frozen=True)
class Paragraph:
    """Running text."""

    text: str


@dataclass(frozen=True)
class Equation:
    """Displayed mathematics in LaTeX, with a number in brackets if it has one."""

    latex: str
    number: str = ""


@dataclass(frozen=True)
class Table:
    """Columns by their headings, and rows of text; figures stand to the right."""

    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    figures: Sequence[str] = ()


@dataclass(frozen=True)
class Code:
    """Text to be read by a program."""

    text: str
    language: str = ""


@dataclass(frozen=True)
class Figure:
    """A picture in a file beside the document, and what it shows."""

    file: str
    caption: str


Block = Heading | Paragraph | Equation | Table | Code | Figure
