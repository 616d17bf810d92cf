"""Options that several commands share, and their values with units."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from railride.cli import output
from railride.errors import Faults

FORMATS = ("table", "json", "csv")
FLOORS = ("smooth", "polygon", "spline")
LARGEST_SEED = 2**32 - 1
REPEATED = ("--speed", "--at")  # options that may be given several times

TRACK, BODY, RESULT = "The track", "The vehicle and its body", "The result"

FloorOption = Annotated[
    str, typer.Option("--floor", metavar="|".join(FLOORS), rich_help_panel=BODY,
                      help="Where the floor is: on the smooth line through the segments; on their "
                      "polygon, as in the paper; or on a spline, nearer to the beam off the "
                      "middle.")]  # fmt: skip
FormatOption = Annotated[
    str, typer.Option("--format", metavar="|".join(FORMATS), rich_help_panel=RESULT,
                      help="How the result is written.")]  # fmt: skip
OutputOption = Annotated[
    str | None, typer.Option("--output", metavar="FILE", rich_help_panel=RESULT,
                             help="Write the result to this file instead.")]  # fmt: skip


ExtrapolateOption = Annotated[
    bool, typer.Option("--extrapolate", rich_help_panel=TRACK,
                       help="Continue a spectrum beyond the band it was stated for.")]  # fmt: skip
TrackOption = Annotated[
    str, typer.Option("--track", metavar="NAME|FILE", rich_help_panel=TRACK,
                      help="A track spectrum by name, or the file of one or of a measured track.")
]  # fmt: skip


class Arguments:
    """Turns texts of options into values; all that is wrong is raised together, once.

    >>> given = Arguments()
    >>> given.number("--speed", "145 km/h", "km/h") * 3.6
    145.0
    """

    def __init__(self) -> None:
        self.faults = Faults("command line")

    def number(self, option: str, text: str | None, unit: str) -> Any:
        """SI value of a number in ``unit`` or with a unit of its own; None stays None."""
        from railride.units import QuantityError, parse_number_or_quantity

        if text is None:
            return None
        try:
            return parse_number_or_quantity(text, unit)
        except QuantityError as error:
            first, comma, other = text.partition(",")
            mend = (f"a decimal point; or, for several values, {option} {first} {option} {other}"
                    if comma and option in REPEATED else error.mend)  # fmt: skip
            self.faults.add(option, error.found, error.expected, mend)
            return None

    def positive(self, option: str, text: str | None, unit: str) -> Any:
        """SI value of a number that must be above zero; None stays None."""
        value = self.number(option, text, unit)
        if value is not None and value <= 0:
            self.faults.add(option, repr(text), f"a number above 0, in {unit} or with its unit")
            return None
        return value

    def whole(self, option: str, text: str | None, least: int, most: int) -> Any:
        """A whole number from ``least`` to ``most``; None stays None."""
        if text is None:
            return None
        if re.fullmatch(r"[+-]?[0-9]{1,18}", text) and least <= int(text) <= most:
            return int(text)
        self.faults.add(option, repr(text), f"a whole number from {least} to {most}",
                        f"such as {option} {max(least, 4)}")  # fmt: skip
        return None

    def range_of(
        self, texts: Mapping[str, str | None], defaults: Mapping[str, str], unit: str, most: int
    ) -> tuple[Any, Any, Any]:
        """From, to (SI) and how many, of the options --from, --to and --points."""
        filled = {
            o: str(default if texts[o] is None else texts[o]) for o, default in defaults.items()
        }
        low, high = (self.positive(option, filled[option], unit) for option in ("--from", "--to"))
        if None not in (low, high) and low >= high:
            first, last = (f"{float(t):g} {unit}" if re.fullmatch(r"[-+.e0-9]+", t) else repr(t)
                           for t in (filled["--from"], filled["--to"]))  # fmt: skip
            self.faults.add("--from", f"{first}, and {last} for --to", "a value below that of --to")
        return low, high, self.whole("--points", filled["--points"], 2, most)

    def choice(self, option: str, text: str, choices: Sequence[str]) -> str:
        """One of ``choices``."""
        if text not in choices:
            self.faults.add(option, repr(text), f"one of {', '.join(choices)}")
        return text

    def conflict(self, option: str, other: str, mend: str = "leave one of the two out") -> None:
        """Note two options that cannot go together."""
        self.faults.add(option, f"{other} with it", "one of the two", mend)

    def writes(self, written: dict[str, str | None], read: dict[str, str | None]) -> None:
        """Note files, by their options, that cannot be written, or only over one another.

        written : by the command; read : by it, which nothing is written over.
        """
        for option, name in written.items():
            output.check_output(self.faults, option, name)
            output.check_picture(self.faults, option, name)
        taken: dict[Path, str] = {}
        for option, name in [*read.items(), *written.items()]:
            if name is None or "\0" in name or not Path(name).name:
                continue
            place = Path(name).absolute()
            if option in written and place in taken:
                self.faults.add(option, f"{name!r}, the file of {taken[place]}", "another file",
                                "choose another name")  # fmt: skip
            taken.setdefault(place, option)

    def check(self) -> None:
        """Raise what was wrong, if anything."""
        self.faults.raise_if_any()


def kmh(speed: float) -> float:
    """Kilometres per hour as they were typed: the conversion's last bit is rounded away.

    >>> kmh(145 / 3.6), kmh(0.1 / 3.6), kmh(40.0)
    (145.0, 0.1, 144.0)
    """
    return float(f"{3.6 * speed:.15g}")
