"""What the heading of a column says: distance or level, which rail, filtered to which band.

Only whole headings that are known count, so that "cross level" is no level. A name may come after
that of its group, "TG Master.Vasen Korkeuspoikkeama D1" or "run/level". A chord offset (versine) is
no level: a chord of length 2a takes the level w to w(x) − (w(x − a) + w(x + a))/2, which passes a
wave by 1 − cos(Omega a): none of some wavelengths and twice of others.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from railride.spectra import D1, D2, D3

BANDS = {"D1": D1, "D2": D2, "D3": D3}
"""Bands of EN 13848-1 by their names, m."""

_DISTANCES = frozenset((
    "distance", "chainage", "position", "location", "station", "stationing", "mileage", "pk",
    "kilometre", "kilometer", "km", "track distance", "distance along track", "sijainti",
    "ratakilometri", "kilometri", "weg", "strecke", "kilometrierung",
))  # fmt: skip
_LEVELS = frozenset((
    "level", "longitudinal level", "vertical level", "profile", "vertical profile",
    "longitudinal profile", "top", "vertical irregularity", "track irregularity",
    "korkeuspoikkeama", "korkeuspoikkema", "längshöhe", "laengshoehe", "längshöhenlage",
    "nivellement", "nivellement longitudinal",
))  # fmt: skip
_RAILS = {
    **dict.fromkeys("left l vasen links linke linkes gauche".split(), "left"),
    **dict.fromkeys("right r oikea rechts rechte rechtes droite".split(), "right"),
}
_CHORD = re.compile(r"nuolikorkeu|versin|chord|mco$|pfeilh|fl[eè]che|corde$|sehne")
_STATISTIC = re.compile(r"\b(?:keskihajonta|standard deviation|standardabweichung|std|stdev|sd)\b")


@dataclass(frozen=True)
class Meaning:
    """What a heading says.

    kind: "distance", "level", "chord" (an offset), "statistic" (a standard deviation) or "", which
        is not known. rail: "left", "right" or "". band: "D1" and so on, or "".
    """

    kind: str
    rail: str = ""
    band: str = ""


def meaning(name: str) -> Meaning:
    """What a heading's ``name``, without the unit, says.

    >>> meaning("TG Master.Vasen Korkeuspoikkeama D1")
    Meaning(kind='level', rail='left', band='D1')
    >>> meaning("run 1/level").kind, meaning("mean left/right level").kind
    ('level', '')
    >>> meaning("leftRailLevel"), meaning("cross level").kind, meaning("Versine 10 m").kind
    (Meaning(kind='level', rail='left', band=''), '', 'chord')
    """
    spaced = re.sub(r"(?<=[a-zäö])(?=[A-Z])", " ", name).lower()
    words = _words(spaced)
    if any(_CHORD.search(word) for word in words):
        return Meaning("chord")
    if _STATISTIC.search(" ".join(words)):
        return Meaning("statistic")
    for text in (spaced, re.split(r"[./]", spaced)[-1]):
        words = _words(text)
        if " ".join(words) in _DISTANCES:
            return Meaning("distance")
        rails = [_RAILS[word] for word in words if word in _RAILS]
        bands = [word.upper() for word in words if re.fullmatch(r"d\d", word)]
        aside = ("rail", "rails", *_RAILS)
        rest = [word for word in words if word not in aside and word.upper() not in bands]
        if " ".join(rest) in _LEVELS and len(rails) <= 1 and len(bands) <= 1:
            return Meaning("level", "".join(rails), "".join(bands))
        if len(set(rails)) > 1:  # "left/right level" is of both
            break
    return Meaning("")


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W_]+", text)
