"""A document as Markdown that a code host renders."""

from __future__ import annotations

from collections.abc import Iterable
from urllib.parse import quote

from railride.markup.blocks import Block, Code, Equation, Figure, Heading, Paragraph, Table


def markdown(blocks: Iterable[Block]) -> str:
    """GitHub's Markdown, with mathematics between dollars."""
    return "\n\n".join(_markdown(block) for block in blocks) + "\n"


def _markdown(block: Block) -> str:
    match block:
        case Heading(text, level):
            return f"{'#' * level} {text}"
        case Paragraph(text):
            return text
        case Equation(latex, number):
            mark = rf" \qquad \text{{({number})}}" if number else ""
            return f"$$\n{latex}{mark}\n$$"
        case Figure(file, caption):
            return f"![{caption}]({quote(file)})"
        case Code(text, language):
            return f"```{language}\n{text}\n```"
        case Table(columns, rows, figures):
            marks = ["---:" if column in figures else "---" for column in columns]
            lines = [columns, marks, *rows]
            return "\n".join(f"| {' | '.join(line)} |" for line in lines)
