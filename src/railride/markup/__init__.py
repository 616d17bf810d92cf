r"""A document as a list of blocks, written as Markdown that a code host renders, or as LaTeX.

Text in a block may hold ``$mathematics$`` and ```code```; the two renderers turn a list of blocks
into one file each, the same bytes on every machine. Mathematics is written so that no Markdown
reader takes part of it for its own: one line to an equation, no line that begins with a sign, no
``*``, no underscore after a bracket.
"""

from railride.markup.as_latex import latex
from railride.markup.as_markdown import markdown
from railride.markup.blocks import Block, Code, Equation, Figure, Heading, Paragraph, Table
from railride.markup.mathematics import (
    LINE,
    aligned,
    continued,
    grouped_lines,
    math,
    natural,
    number,
    sum_lines,
    summands,
    width,
)

__all__ = [
    "LINE",
    "Block",
    "Code",
    "Equation",
    "Figure",
    "Heading",
    "Paragraph",
    "Table",
    "aligned",
    "continued",
    "grouped_lines",
    "latex",
    "markdown",
    "math",
    "natural",
    "number",
    "sum_lines",
    "summands",
    "width",
]
