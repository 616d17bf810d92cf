"""A claim of the paper with its verdict, and the document that goes through all of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from railride.markup import Block, Heading, Paragraph, Table

FOLLOWS, FAILS, OPEN = "follows", "does not follow", "cannot be decided"
MARKS = {FOLLOWS: "✓", FAILS: "✗", OPEN: "?"}


@dataclass(frozen=True)
class Claim:
    """One claim: ``quote`` stands in the paper at ``where``; ``blocks`` show what follows.

    said : the claim in a few words. verdict : one of FOLLOWS, FAILS, OPEN. effect : what it does to
    the comfort values.
    """

    title: str
    where: str
    quote: str
    said: str
    verdict: str
    effect: str
    blocks: tuple[Block, ...]


def claim(
    title: str, where: str, quote: str, said: str, verdict: str, effect: str, *blocks: Block | str
) -> Claim:
    """A claim whose blocks may be plain text."""
    shown = tuple(Paragraph(b) if isinstance(b, str) else b for b in blocks)
    return Claim(title, where, quote, said, verdict, effect, shown)


def figure(name: str, caption: str) -> Paragraph:
    """A picture beside the document."""
    return Paragraph(f"![{caption}](figures/{name}.png)")


def columns(first: str, *others: str) -> dict[str, Sequence[str]]:
    """Headings of a table whose columns but the first hold figures."""
    return {"columns": (first, *others), "figures": others}


def summary(claims: Sequence[Claim]) -> list[Block]:
    """The table of all claims, each with its verdict and a link to where it is shown."""
    count = {verdict: sum(c.verdict == verdict for c in claims) for verdict in MARKS}
    told = ", ".join(f"{number} {MARKS[v]} {v}" for v, number in count.items())
    rows = [
        (f"[{k}](#{anchor(k, c)})", c.where, c.said, f"{MARKS[c.verdict]} {c.verdict}", c.effect)
        for k, c in enumerate(claims, start=1)
    ]
    headings = ("no.", "where", "claim", "verdict", "effect on $a_w$ [m/s²]")
    return [
        Heading("Summary"),
        Paragraph(f"{len(claims)} claims: {told}. Pairs of values are those at 145 and 200 km/h."),
        Table(headings, rows),
    ]


def section(title: str, first: int, claims: Sequence[Claim]) -> list[Block]:
    """One section of the document; its claims are numbered from ``first``."""
    blocks: list[Block] = [Heading(title)]
    for k, c in enumerate(claims, start=first):
        blocks += [
            Heading(f"{k}. {c.title}", 3),
            Paragraph(f"> “{c.quote}” ({c.where})"),
            *c.blocks,
            Paragraph(f"**Verdict: {c.verdict}.** Effect on the comfort values: {c.effect}."),
        ]
    return blocks


def linked(text: str, claims: Sequence[Claim]) -> str:
    """The text with every ``[[title]]`` a link to the claim of that title.

    Raises
    ------
    KeyError : a title that no claim has.
    """
    where = {c.title: f"[claim {k}](#{anchor(k, c)})" for k, c in enumerate(claims, start=1)}
    return re.sub(r"\[\[(.+?)\]\]", lambda m: where[m.group(1)], text)


def anchor(number: int, c: Claim) -> str:
    """Where a code host puts the heading of a claim."""
    return re.sub(r"[^\w\- ]", "", f"{number}. {c.title}".lower()).replace(" ", "-")
