"""The paper checked line by line: writes paper_check.md and its figures beside this script.

Run it as ``python derivations/paper_check.py`` (or ``make derivations``). Every verdict, figure and
equation is worked out as the document is made.
"""

from __future__ import annotations

from pathlib import Path

import check_comfort
import check_conclusions
import check_figures
import check_halves
import check_introduction
import check_results
import check_vehicle
from check_values import base, comfort_table
from claims import Claim, linked, section, summary
from paper import TITLE

from railride.markup import Block, Heading, Paragraph, markdown

FOLDER = Path(__file__).parent
SECTIONS = {
    "Abstract and Section 1": check_introduction,
    "Section 2: the models, and Table 1": check_vehicle,
    "Section 2.3: Eqs (1) to (4)": check_halves,
    "Section 3: Eqs (5) and (6), Tables 2 and 3": check_comfort,
    "Section 4: results, Figures 7 to 11 and Table 4": check_results,
    "Section 5: conclusions": check_conclusions,
}


def opening() -> list[Block]:
    """What the document is, and what its values are compared with."""
    return [
        Heading("The paper checked line by line", 1),
        Paragraph("Made by `python derivations/paper_check.py`."),
        Paragraph(
            f"The paper: {TITLE} (doi 10.3390/app14093848, CC BY 4.0). Each claim is quoted, and "
            "what follows is worked out as this document is made: by deriving it again with "
            "symbols, or as numbers. “Follows” and “does not follow” are said of the claim as it "
            "is quoted; “cannot be decided” where the paper does not print what it would take, "
            "whatever can be computed about it. Symbols are the paper's, with three made fit for "
            "formulas: $m_h$ for its $m_{c,h}$, $l_b$ for bs and $l_w$ for ws."
        ),
        Paragraph(
            "What a claim does to the result is told in weighted r.m.s. accelerations "
            "$a_w$ (the paper's a_wrms): on the track spectrum ERRI B176 low, since the paper's "
            "own track is not public, as the exact integral over 0.05–80 Hz, with the full $W_k$, "
            "in the middle of the floor, read on the polygon as in the paper, without structural "
            "damping, at 145 and 200 km/h. All others are compared with these:"
        ),
        comfort_table({"the paper's vehicle as railride reads it": (base(False), base(True))}),
        Paragraph(
            "The paper prints, on its own track, for the flexible vehicle 0.225 / 0.293 (DYMOLA) "
            "and 0.191 / 0.269 (VAMPIRE). Its cases run again over many tracks stand in "
            "[the reproduction](reproduction.md)."
        ),
    ]


def all_claims() -> dict[str, list[Claim]]:
    """Section → its claims, in the paper's order."""
    return {title: module.claims() for title, module in SECTIONS.items()}


def document(claims: dict[str, list[Claim]]) -> str:
    """The whole document as Markdown."""
    blocks = [*opening(), *summary([c for found in claims.values() for c in found])]
    first = 1
    for title, found in claims.items():
        blocks += section(title, first, found)
        first += len(found)
    return linked(markdown(blocks), [c for found in claims.values() for c in found])


def main() -> None:
    """Write the document and its figures."""
    text = document(all_claims())
    (FOLDER / "paper_check.md").write_text(text, encoding="utf-8", newline="\n")
    check_figures.save_all(FOLDER / "figures")


if __name__ == "__main__":
    main()
