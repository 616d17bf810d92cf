"""What the README shows of ``results.json``: a table, between two comments, and a picture.

``python benchmarks/report.py`` writes both; ``run.py`` does so after every measurement.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from measure import ROOT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RESULTS = ROOT / "benchmarks" / "results.json"
README = ROOT / "README.md"
PICTURE = ROOT / "docs" / "images" / "benchmarks.png"
START, END = "<!-- measured: made by benchmarks/report.py -->", "<!-- end of measured -->"

Entry = Mapping[str, Any]


def _faster(e: Entry) -> str:
    return f"{_three(e['peer_s'] / e['railride_s'])} times faster"


def _equal(e: Entry) -> str:
    return f"{_faster(e)}, equal to {e['difference']:.0e}"


def _errors(e: Entry) -> str:
    return f"{_faster(e)}; its error {e['error']:.0e}, railride's {e['own_error']:.0e}"


def _found(e: Entry, quantity: str) -> float:
    """What a target found, by the beginning of its name."""
    return float(next(t["value"] for t in e["targets"] if t["quantity"].startswith(quantity)))


ROWS: dict[str, tuple[str, str, Callable[[Entry], str]]] = {
    **{
        f"derive-linearise-{n}": (
            f"derive and linearise a coach of {n} segment{'s' * (n > 1)}",
            "sympy's `LagrangesMethod`",
            lambda e: f"{_faster(e)}, the same matrices",
        )
        for n in (1, 2, 4, 8)
    },
    "ride-control": ("ride 1 km at 1 kHz, 4 segments", "`control.forced_response`", _equal),
    "ride-scipy": ("the same", "`scipy.signal.lsim`", _equal),
    "ride-rumoca": (
        "the same",
        "the exported Modelica model in rumoca, compiled before",
        _errors,
    ),
    "ride-exudyn": (
        "the same",
        "Exudyn, nonlinear, steps of 0.25 ms",
        _errors,
    ),
    "a_wrms": (
        "exact a_wrms, matrices in hand",
        "one 1 km ride by `control.forced_response`",
        lambda e: f"{_faster(e)}, and no sample; "
        f"{_thousands(_found(e, 'vehicles a second'))} vehicles a second at two speeds, many at "
        "once",
    ),
    "frequency": (
        "response at 100,000 frequencies, 8 segments",
        "`control.frequency_response`",
        lambda e: f"{_faster(e)}, within {_found(e, 'largest difference'):.0e} of a direct solve",
    ),
    "frequency-scipy": (
        "the same",
        "`scipy.signal.freqresp`, one input at a time",
        lambda e: f"{_faster(e)}; the peer {e['peer_difference']:.0e} from it",
    ),
    "comfort": (
        "an hour of three axes at 1 kHz, all indices",
        "`control.forced_response` for the weighting alone",
        lambda e: f"{_faster(e)}; {_found(e, 'peak memory') / 1000:.2g} GB",
    ),
    "synthesise": ("1,000 km of track in steps of 0.25 m", ("one `numpy.fft.irfft` of as many "
                   "numbers"), _faster),
    "derive-process": (
        "`python -m railride.derive --segments 4`, CPU",
        "`import sympy` alone",
        lambda e: f"{e['ratio']:.2g} times a bare sympy",
    ),
    "designs": (
        "one of many designs, at two speeds, 4 segments",
        "a loop of building, `control.forced_response` and weighting",
        lambda e: f"{_faster(e)}; {_thousands(e['designs_a_second'])} designs a second on one "
        f"core, {_thousands(e['with_travel_and_modes_a_second'])} with suspension travel and "
        f"modes; {_thousands(e['measured_track_a_second'])} over a measured track",
    ),
    "gradient": (
        "a_wrms at two speeds with its gradient over 12 parameters",
        "the value alone by the same quadrature",
        lambda e: f"{e['ratio']:.2g} times the value's time",
    ),
    "optimise": (
        "the best (k_2, c_2, c_1) at two speeds",
        "Powell's method on the same values",
        lambda e: f"{_faster(e)}, the same optimum",
    ),
    "sweep": (
        "sweep of 40,000 designs in two processes",
        "in one",
        lambda e: f"{_found(e, 'gain of two'):.2g} of what two busy loops gain",
    ),
    "million": (
        "sweep of 10⁶ designs, all processes, to Parquet",
        "",
        lambda e: f"{_found(e, 'peak memory of a process') / 1000:.2g} GB each",
    ),
}  # fmt: skip
"""Name of a case → the work, the peer and what to say of the two, in the README's order."""

GROWTH = {"derive": "derive, CPU", "ride": "ride of 1 km", "a_wrms": "exact a_wrms",
          "frequency": "10,000 frequencies"}  # fmt: skip


def table(entries: Mapping[str, Entry]) -> str:
    """The README's table and what stands around it."""
    rows = [
        f"| {work} | {_seconds(e['railride_s'])} | "
        + (f"{_seconds(e['peer_s'])}, {peer}" if peer else "")
        + f" | {say(e)} |"
        for name, (work, peer, say) in ROWS.items()
        if (e := entries.get(name)) is not None
    ]
    return "\n".join([
        _where(entries), "", "| work | railride | peer | |", "|---|---|---|---|", *rows, "",
        _growth(entries),
    ])  # fmt: skip


def _where(entries: Mapping[str, Entry]) -> str:
    """The machine and the versions; of the cases that were measured last, should they differ."""
    machines = [e["machine"] for e in entries.values()]
    where = max(machines, key=lambda m: len(m["versions"]))
    of = where["versions"]
    named = {"sympy": "sympy", "numpy": "numpy", "scipy": "scipy", "control": "python-control",
             "rumoca": "rumoca", "exudyn": "Exudyn"}  # fmt: skip
    versions = ", ".join(f"{name} {of[key]}" for key, name in named.items() if key in of)
    return (f"On {where['processors']} cores of {_article(where['processor'])}, Python "
            f"{of['python']}, {versions}:")  # fmt: skip


def _growth(entries: Mapping[str, Entry]) -> str:
    parts, memory = [], []
    for name in ("growth-derive", "growth-numbers"):
        if (e := entries.get(name)) is None:
            continue
        parts += [f"{GROWTH[work]} as N^{x:.2g}" for work, x in e["exponents"].items()]
        memory += [f"{peak['128']:.0f} MB" for peak in e["peak_memory_mb"].values()]
    if not parts:
        return ""
    return (f"From 16 to 128 segments the work grows: {', '.join(parts)}; peak memory at 128 "
            f"segments, of a process that does one of these: {', '.join(memory)}.")  # fmt: skip


def _article(name: str) -> str:
    return f"{'an' if name[:1] in 'AEIOU' else 'a'} {name}"


def _three(value: float) -> str:
    """Two digits, or three of what is larger.

    >>> _three(1.234), _three(56.78), _three(5412.0)
    ('1.2', '57', '5,410')
    """
    return _thousands(float(f"{value:.3g}")) if value >= 100 else f"{value:.2g}"


def _thousands(value: float) -> str:
    return f"{float(f'{value:.3g}'):,.0f}"


def _seconds(value: float) -> str:
    """>>> _seconds(0.00012), _seconds(0.0314), _seconds(2.4), _seconds(70.9)
    ('0.12 ms', '31 ms', '2.4 s', '71 s')
    """
    return f"{1000 * value:.2g} ms" if value < 0.1 else f"{value:.2g} s"


def written_into(text: str, made: str) -> str:
    """The README with the table in its place."""
    head, _, rest = text.partition(START)
    _, _, tail = rest.partition(END)
    return f"{head}{START}\n{made}\n{END}{tail}"


def draw(entries: Mapping[str, Entry], file: Path) -> None:
    """How many times faster than each peer, and how the work grows."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.5, 4.8), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1.25, 1])
    _bars(left, entries)
    _curves(right, entries)
    figure.savefig(file, dpi=110, metadata={"Software": None})


def _bars(ax: Axes, entries: Mapping[str, Entry]) -> None:
    of = {
        **{f"derive-linearise-{n}": f"derive, N = {n}: sympy" for n in (1, 2, 4, 8)},
        "ride-scipy": "ride: scipy.signal.lsim",
        "ride-control": "ride: python-control",
        "ride-rumoca": "ride: Modelica (rumoca)",
        "ride-exudyn": "ride: Exudyn",
        "frequency": "100,000 frequencies: python-control",
        "frequency-scipy": "100,000 frequencies: scipy",
        "comfort": "comfort of an hour: python-control",
        "a_wrms": "exact a_wrms: python-control's ride",
        "designs": "designs: a loop of its rides",
    }
    shown = [(label, entries[name]) for name, label in of.items() if name in entries]
    times = [e["peer_s"] / e["railride_s"] for _, e in shown]
    places = range(len(shown))
    ax.barh(places, times, color="#2f6db3", height=0.62)
    for place, value in zip(places, times, strict=True):
        ax.annotate(_three(value), (value, place), xytext=(4, 0), textcoords="offset points",
                    va="center", fontsize=8)  # fmt: skip
    ax.set_yticks(places, [label for label, _ in shown], fontsize=8.5)
    ax.invert_yaxis()
    ax.set_xscale("log")
    ax.set_xlim(1, 4 * max(times))
    ax.set_xlabel("times faster than the peer")
    ax.grid(axis="x", alpha=0.3)
    ax.spines[["top", "right"]].set_visible(False)


def _curves(ax: Axes, entries: Mapping[str, Entry]) -> None:
    marks = iter("osD^")
    for name in ("growth-derive", "growth-numbers"):
        for work, seconds in entries.get(name, {}).get("seconds", {}).items():
            n = [int(number) for number in seconds]
            x = entries[name]["exponents"][work]
            label = f"{GROWTH[work]}: $N^{{{x:.2f}}}$ from 16"
            ax.loglog(n, list(seconds.values()), marker=next(marks), markersize=4, label=label)
    ax.set_xlabel("number of segments N")
    ax.set_ylabel("time [s]")
    ladder = (4, 8, 16, 32, 64, 128)
    ax.set_xticks(ladder, [str(n) for n in ladder])
    ax.minorticks_off()
    ax.grid(alpha=0.3)
    ax.set_ylim(ax.get_ylim()[0] / 6, None)
    ax.legend(fontsize=8.5, loc="lower right")
    ax.spines[["top", "right"]].set_visible(False)


def read(path: Path = RESULTS) -> dict[str, Entry]:
    """The measured cases by name."""
    return {entry["name"]: entry for entry in json.loads(path.read_text(encoding="utf-8"))}


def main() -> int:
    """Write the table into the README, and the picture."""
    entries = read()
    README.write_text(written_into(README.read_text(encoding="utf-8"), table(entries)), "utf-8")
    draw(entries, PICTURE)
    return 0


if __name__ == "__main__":
    sys.exit(main())
