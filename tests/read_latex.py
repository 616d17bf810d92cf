"""Reads the mathematics of the documents back: LaTeX as numbers, so that it is checked by value.

It knows what railride writes and nothing more; anything else is a ValueError.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

TOKEN = re.compile(
    r"\s*(\\left|\\right|\\begin\{bmatrix\}|\\end\{bmatrix\}|\\mathrm|\\[A-Za-z]+|\\\\|\\,|"
    r"\d+\.?\d*|[A-Za-z]|[{}()\[\]^_+\-&=,:])"
)
GREEK = ("theta", "zeta", "mu", "ell", "eta", "phi", "kappa", "rho", "alpha", "beta", "omega")
FUNCTIONS = {"\\sin": np.sin, "\\cos": np.cos, "\\tan": np.tan, "\\arcsin": np.arcsin}
STOPS = ("+", "-", "=", "&", "\\\\", "}", "\\right", ")", "\\end{bmatrix}", "\\quad", ",", None)


def formulas(text: str) -> list[str]:
    """The displayed formulas of a Markdown document, numbers of equations left out."""
    found = re.findall(r"^\$\$\n(.*?)\n\$\$$", text, flags=re.DOTALL | re.MULTILINE)
    return [re.sub(r" \\qquad \\text\{\(.*\)\}$", "", formula) for formula in found]


def equations(formula: str) -> list[tuple[str, str]]:
    """(left, right) of each equation in a formula, broken lines joined again."""
    inner = re.sub(r"^\\begin\{aligned\}|\\end\{aligned\}$", "", formula.strip())
    inner = re.sub(r"\\\\\s*& \\quad \{\}", "", inner)
    # Rows of matrices stay: their row ends are inside of brackets.
    rows, depth, start = [], 0, 0
    for match in re.finditer(r"\\begin\{bmatrix\}|\\end\{bmatrix\}|\\\\", inner):
        depth += {"\\b": 1, "\\e": -1}.get(match.group()[:2], 0)
        if match.group() == "\\\\" and depth == 0:
            rows.append(inner[start : match.start()])
            start = match.end()
    rows.append(inner[start:])
    rows = [part for row in rows for part in row.split(r", \qquad ")]
    pairs = [re.split(r"&? ?= ", row, maxsplit=1) for row in rows]
    return [(left.strip(), right.strip()) for left, right in pairs]


def name(latex: str) -> str:
    r"""The program's name of a symbol: ``theta_b1_dot`` of ``\dot\theta_{b1}``."""
    found = re.fullmatch(r"(\\d+ot)? ?\\?(?:vec )?([A-Za-z]+)(?:_(.*))?", latex.strip())
    if not found:
        raise ValueError(f"no symbol: {latex}")
    dots, head, index = found.groups()
    index = re.sub(r"\\mathrm|[{}\\ ]", "", (index or "").replace(", ", "_"))
    return head + (f"_{index}" if index else "") + "_dot" * (len(dots or "") - 3 if dots else 0)


@dataclass
class Reader:
    """One expression at the values of its symbols, numbers or matrices, by their names."""

    latex: str
    values: dict

    def __post_init__(self):
        self.tokens = TOKEN.findall(self.latex)
        if "".join(self.tokens) != re.sub(r"\s", "", self.latex):
            raise ValueError(f"not railride's: {self.latex}")
        self.at = 0

    @property
    def next(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else None

    def take(self, wanted=None):
        found = self.next
        if found is None or (wanted is not None and found != wanted):
            raise ValueError(f"{wanted} expected, not {found}: {self.latex}")
        self.at += 1
        return found

    def value(self):
        total = self.sum()
        if self.next is not None:
            raise ValueError(f"{self.next} left over: {self.latex}")
        return total

    def sum(self):
        sign = -1 if self.next == "-" and self.take() else 1
        total = sign * self.product()
        while self.next in ("+", "-"):
            sign = 1 if self.take() == "+" else -1
            total = total + sign * self.product()
        return total

    def product(self):
        result = self.power()
        while self.next not in STOPS:
            if self.next in ("\\times", "\\cdot"):
                self.take()
            factor = self.power()
            both = np.ndim(result) == np.ndim(factor) == 2
            result = result @ factor if both else result * factor
        return result

    def power(self):
        base = self.factor()
        if self.next != "^":
            return base
        self.take()
        if self.next == "T":
            self.take()
            return np.transpose(base)
        return base ** self.group()

    def group(self):
        """What stands in braces, or one token."""
        if self.next != "{":
            return float(self.take())
        self.take()
        inner = self.sum()
        self.take("}")
        return inner

    def factor(self):
        head = self.next
        if head == "\\frac":
            self.take()
            above = self.group()
            return above / self.group()
        if head == "\\left":
            self.take(), self.take("(")
            inner = self.sum()
            self.take("\\right"), self.take(")")
            return inner
        if head in FUNCTIONS:
            self.take()
            exponent = 1
            if self.next == "^":
                self.take()
                exponent = self.group()
            argument = self.group() if self.next == "{" else self.factor()
            return FUNCTIONS[head](argument) ** exponent
        if head == "\\begin{bmatrix}":
            return self.matrix()
        if head is not None and head[0].isdigit():
            return float(self.take())
        if head == "{":
            return self.group()
        return self.symbol()

    def matrix(self):
        self.take()
        rows = [[self.sum()]]
        while self.next != "\\end{bmatrix}":
            if self.take() == "&":
                rows[-1].append(self.sum())
            else:
                rows.append([self.sum()])
        self.take()
        return assembled(rows)

    def symbol(self):
        start = self.at
        if self.next in ("\\dot", "\\ddot", "\\vec"):
            self.take()
        self.take()
        if self.next == "_":
            self.take()
            depth = 0
            while True:
                depth += {"{": 1, "}": -1}.get(self.take(), 0)
                if depth == 0:
                    break
        text = "".join(self.tokens[start : self.at]).replace("dot", "dot ", 1)
        found = name(re.sub(r",", ", ", text))
        if found not in self.values:
            raise ValueError(f"{found} is not known")
        return self.values[found]


def assembled(rows):
    """A matrix of numbers, or of blocks, where 0 stands for one of any shape."""
    if all(np.ndim(e) == 0 for row in rows for e in row):
        return np.array(rows, dtype=float)
    heights = [max((e.shape[0] for e in row if np.ndim(e) == 2), default=1) for row in rows]
    widths = [max((e.shape[1] for e in column if np.ndim(e) == 2), default=1)
              for column in zip(*rows, strict=True)]  # fmt: skip
    filled = [
        [e if np.ndim(e) == 2 else np.full((high, wide), float(e))
         for e, wide in zip(row, widths, strict=True)]
        for row, high in zip(rows, heights, strict=True)
    ]  # fmt: skip
    return np.block(filled)


def value(latex: str, values: dict):
    """The value of an expression in LaTeX."""
    return Reader(latex, values).value()
