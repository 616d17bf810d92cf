"""A document as an article that LaTeX compiles."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from railride.markup.blocks import Block, Code, Equation, Figure, Heading, Paragraph, Table
from railride.markup.mathematics import width

MOST_ACROSS = 70  # characters of a row on one line

PREAMBLE = r"""\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage[utf8]{inputenc}
\usepackage[a4paper, margin=25mm]{geometry}
\usepackage{amsmath}
\usepackage{graphicx}
\usepackage{listings}
\usepackage{longtable}
\lstset{basicstyle=\footnotesize\ttfamily, breaklines, columns=fullflexible}
\setlength{\emergencystretch}{8em}
\setcounter{MaxMatrixCols}{99}
% A wide formula is made as small as the line is wide.
\newcommand{\fitted}[1]{\resizebox{\ifdim\width>0.9\linewidth 0.9\linewidth\else\width\fi}{!}%
  {$\displaystyle #1$}}
"""


def latex(blocks: Iterable[Block]) -> str:
    """An article that LaTeX compiles."""
    title, *rest = blocks
    if not isinstance(title, Heading) or title.level != 1:
        raise ValueError("a document begins with its title")
    head = f"{PREAMBLE}\\title{{{_latex_text(title.text)}}}\n\\author{{}}\n\\date{{}}\n"
    body = "\n\n".join(_latex(block) for block in rest)
    return f"{head}\\begin{{document}}\n\\maketitle\n\n{body}\n\n\\end{{document}}\n"


def _latex(block: Block) -> str:
    match block:
        case Heading(text, level):
            return "\\" + "sub" * (level - 2) + f"section*{{{_latex_text(text)}}}"
        case Paragraph(text):
            return _latex_text(text)
        case Equation(mathematics, number):
            mark = rf" \tag{{{number}}}" if number else ""
            return f"\\[\n\\fitted{{{mathematics}}}{mark}\n\\]"
        case Figure(file, caption):
            picture = rf"\includegraphics[width=\linewidth]{{\detokenize{{{file}}}}}"
            return f"\\begin{{center}}\n{picture}\n\n{_latex_text(caption)}\n\\end{{center}}"
        case Code(text, _):
            return f"\\begin{{lstlisting}}\n{text}\n\\end{{lstlisting}}"
        case Table(columns, rows, figures):
            return _latex_table(columns, rows, figures)


def _latex_table(
    columns: Sequence[str], rows: Sequence[Sequence[str]], figures: Sequence[str]
) -> str:
    """A table that may go over pages; the widest column of text is broken into lines."""
    marks = ["r" if column in figures else "l" for column in columns]
    across = [max(map(_across, column)) for column in zip(columns, *rows, strict=True)]
    widest = across.index(max(across))
    if marks[widest] == "l" and sum(across) > MOST_ACROSS:
        marks[widest] = r"p{0.4\linewidth}"
    lines = [" & ".join(_latex_text(cell) for cell in line) + r" \\" for line in (columns, *rows)]
    inner = "\n".join([lines[0] + r" \hline \endhead", *lines[1:]])
    return f"\\begin{{longtable}}{{{''.join(marks)}}}\n{inner}\n\\end{{longtable}}"


def _across(cell: str) -> int:
    """About how many characters wide a cell is."""
    return len(re.sub(r"\$([^$]+)\$", lambda m: "x" * width(m.group(1)), cell))


def _latex_text(text: str) -> str:
    """Running text: mathematics as it is, code in a typewriter face, the rest escaped."""
    parts = re.split(r"(\$[^$]+\$|`[^`]+`|\*\*[^*]+\*\*)", text)
    return "".join(_latex_span(part) for part in parts)


def _latex_span(part: str) -> str:
    if part.startswith("$"):
        return part
    if part.startswith("`"):
        return rf"\texttt{{{_escaped(part[1:-1]).replace('--', '-{}-')}}}"
    if part.startswith("**"):
        return rf"\textbf{{{_escaped(part[2:-2])}}}"
    return _escaped(part)


def _escaped(text: str) -> str:
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return re.sub(r"[\\~^&%#_{}$]", lambda m: special.get(m.group(), "\\" + m.group()), text)
