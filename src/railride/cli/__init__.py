"""The command line: ``railride COMMAND …``. Each command loads what it needs when it runs."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence

import typer

from railride.cli.bode import bode
from railride.cli.comfort import comfort
from railride.cli.compare import compare
from railride.cli.derive import derive
from railride.cli.export import export
from railride.cli.map import comfort_map
from railride.cli.modes import modes
from railride.cli.optimise import optimise
from railride.cli.ride import ride
from railride.cli.sensitivity import sensitivity
from railride.cli.sweep import sweep
from railride.cli.track import track
from railride.cli.uncertainty import uncertainty

app = typer.Typer(
    name="railride",
    help="Vertical dynamics and ride comfort of railway vehicles, from the Lagrangian to a comfort "
    "value.\n\nExample:  railride ride --speed 145 --speed 200 --plots plots",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
COMMANDS: dict[str, Callable[..., None]] = {
    "bode": bode,
    "comfort": comfort,
    "compare": compare,
    "derive": derive,
    "export": export,
    "map": comfort_map,
    "modes": modes,
    "optimise": optimise,
    "ride": ride,
    "sensitivity": sensitivity,
    "sweep": sweep,
    "track": track,
    "uncertainty": uncertainty,
}
for name, command in COMMANDS.items():
    app.command(name)(command)


def _version(wanted: bool) -> None:
    if wanted:
        from railride import __version__

        typer.echo(f"railride {__version__}")
        raise typer.Exit


@app.callback()
def _common(
    version: bool = typer.Option(
        False, "--version", callback=_version, is_eager=True, help="Print the version and stop."
    ),
) -> None:
    del version


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit: 0 for success, 2 for bad input, 1 for a fault of ours."""
    for stream in (sys.stdout, sys.stderr):  # Greek letters on any terminal
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(encoding="utf-8", errors="backslashreplace")
    app(args=None if arguments is None else list(arguments), prog_name="railride")
