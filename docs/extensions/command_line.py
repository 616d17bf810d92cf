"""The page of commands, written from the command line itself as the site is built.

``docs/commands.md`` says what holds for all of them; a section for each command goes below.
"""

from __future__ import annotations

from typing import Any

from typer.main import get_command

from railride.cli import app

PAGE = "docs/commands"
program = get_command(app)


def cell(text: str) -> str:
    """A text within a table."""
    return text.replace("|", r"\|").replace("\n", " ")


def row(option: Any) -> str:
    """One option or argument: how it is written, what it does, its default where it has one."""
    written = ", ".join(sorted(option.opts, key=len, reverse=True))
    if option.param_type_name == "argument":
        written = option.metavar or option.name.upper()
    elif not option.is_flag:
        written += f" {option.metavar or option.type.name.upper()}"
    said = option.help or ""
    if option.default not in {None, False, ""} and "efault" not in said:
        said += f" Default `{option.default}`."
    return f"| `{cell(written)}` | {cell(said)} |"


def section(name: str, command: Any) -> str:
    """What a command is for, an example, and its options in the groups of its help."""
    groups: dict[str, list[str]] = {}
    for option in command.params:
        kind = "Arguments" if option.param_type_name == "argument" else "Options"
        groups.setdefault(option.rich_help_panel or kind, []).append(row(option))
    said, *examples = command.help.split("\n\n")
    lines = [f"## railride {name}", said.replace("\n", " ")]
    for example in examples:
        what, separate, how = example.partition(":  ")
        lines.append(f"{what}:\n\n```sh\n{how}\n```" if separate else example)
    for group, rows in groups.items():
        lines.append("\n".join([f"| {group} | |", "|---|---|", *rows]))
    return "\n\n".join(lines)


def sections() -> str:
    """Every command."""
    return "\n\n".join(section(name, program.commands[name]) for name in sorted(program.commands))


def append(_app: Any, page: str, source: list[str]) -> None:
    """Put the sections below what the page says."""
    if page == PAGE:
        source[0] += "\n" + sections()


def outdated(*_: Any) -> list[str]:
    """The page is written anew at every build: its source does not tell when commands change."""
    return [PAGE]


def setup(app: Any) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("source-read", append)
    app.connect("env-get-outdated", outdated)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
