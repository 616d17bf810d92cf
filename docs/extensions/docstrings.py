"""Docstrings of this project, as Sphinx reads them.

Their sections are those of numpydoc, but what an argument is follows its name at once, and short
ones share a line::

Parameters
---------
    speeds : m/s, each > 0. at : points of the floor, m forward of the body's middle.

Records list their fields in the same way without a heading, ``mass: m_c, kg. length: L, m.`` Both
become lists. References to public names by the module they stand in are led to the page
that documents them.
"""

from __future__ import annotations

import inspect
import re
from typing import Any

import railride

NAME = r"\w+(?:\.\w+)*"
NAMES = rf"{NAME}(?:, {NAME})*"
ITEM = re.compile(rf"(?:(?<=[.;] )|^)(`*)({NAMES})\1 ?: ", re.MULTILINE)
LITERAL_OR_BAR = re.compile(r"(``.*?``|`[^`]*`)|\|", re.DOTALL)
ARRAY = re.compile(r"~?numpy\.ndarray\[tuple\[~?typing\.Any, \.\.\.\], ~?numpy\.dtype\[[~\w.]+\]\]")
UNDERLINED = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)


def arguments(found: Any) -> set[str]:
    """Names of what a function takes or a record is made of."""
    if not (inspect.isclass(found) or inspect.isroutine(found)):
        return set()
    try:
        return set(inspect.signature(found).parameters)
    except (TypeError, ValueError):
        return set()


def items(text: str, known: set[str] | None) -> list[tuple[str, str]]:
    """Names and what is said of each, of a text that begins with one; none of other texts."""
    starts = [m for m in ITEM.finditer(text) if known is None or known >= set(m[2].split(", "))]
    if not starts or starts[0].start() > 0:
        return []
    ends = [m.start() for m in starts[1:]] + [len(text)]
    return [(m[2], text[m.end() : end]) for m, end in zip(starts, ends, strict=True)]


def listed(heading: str, found: list[tuple[str, str]]) -> str:
    """A list under its heading, as a field."""
    lines = [f":{heading}:"]
    for names, said in found:
        first, *further = (line.strip() for line in said.strip().splitlines())
        named = ", ".join(f"**{name}**" for name in names.split(", "))
        lines.append(f"    - {named} – {first}")
        lines += [f"      {line}" for line in further]
    return "\n".join(lines)


def section(heading: str, body: str, known: set[str]) -> str:
    """One underlined section: of items, each from the left margin, or of anything else."""
    if heading == "Examples":
        return f".. rubric:: {heading}\n\n{body}"
    entries, *rest = body.split("\n\n")
    found = []
    for entry in re.split(r"\n(?=\S)", entries):
        if not items(entry, None):
            raise ValueError(f"{heading}: found {entry!r}; expected 'name : what it is'")
        first, *further = items(entry, None)
        joined = [one for one in further if known >= set(one[0].split(", "))]
        if len(joined) < len(further):  # What looks like a name within a sentence is none.
            found += items(entry, known | set(first[0].split(", ")))
        else:
            found += [first, *further]
    return "\n\n".join([listed(heading, found), *rest])


def barred(paragraph: str) -> str:
    """A paragraph whose |x| is mathematics, not a substitution."""
    if paragraph.startswith(("..", ">>>", " ")):
        return paragraph
    return LITERAL_OR_BAR.sub(lambda found: found[1] or r"\|", paragraph)


def readable(text: str, known: set[str]) -> str:
    """The docstring in reStructuredText."""
    lead, *sections = UNDERLINED.split("\n\n".join(map(barred, text.split("\n\n"))))
    paragraphs = []
    for paragraph in lead.split("\n\n"):
        found = items(paragraph, known)
        paragraphs.append(listed("Parameters", found) if found else paragraph)
    headed = zip(sections[::2], sections[1::2], strict=True)
    return "\n\n".join(
        [*paragraphs, *(section(heading, body.strip("\n"), known) for heading, body in headed)]
    )


def rewrite(_app: Any, _what: str, _name: str, found: Any, _options: Any, lines: list[str]) -> None:
    """Put a docstring's lines into the form that Sphinx reads."""
    lines[:] = readable("\n".join(lines), arguments(found)).splitlines()


def with_arrays(
    _app: Any,
    _what: str,
    _name: str,
    _found: Any,
    _options: Any,
    taken: str | None,
    made: str | None,
) -> tuple[str | None, str | None]:
    """Arrays in a signature by the name they are written by."""
    return taken and ARRAY.sub("NDArray", taken), made and ARRAY.sub("NDArray", made)


def lead_to_page(app: Any, env: Any, node: Any, content: Any) -> Any:
    """Resolve ``railride.rides.ride`` as ``railride.ride``, where that is public."""
    if node.get("refdomain") != "py":
        return None
    parts = node["reftarget"].split(".")
    for first in range(len(parts)):
        if parts[first] in railride.__all__:
            node["reftarget"] = ".".join(["railride", *parts[first:]])
            domain = env.get_domain("py")
            return domain.resolve_xref(
                env, node["refdoc"], app.builder, node["reftype"], node["reftarget"], node, content
            )
    return None


def setup(app: Any) -> dict[str, bool]:
    """Called by Sphinx."""
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", rewrite)
    app.connect("autodoc-process-signature", with_arrays)
    app.connect("missing-reference", lead_to_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
