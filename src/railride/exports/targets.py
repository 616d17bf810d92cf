"""The forms that a model can be exported in, each written by a module of its own."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module


@dataclass(frozen=True)
class Target:
    """One form: what it is, in a line, and whether it is text.

    Its module ``railride.exports.as_NAME`` has ``written(content, ...)``, the whole file as text or
    bytes.
    """

    name: str
    what: str
    text: bool = True

    @property
    def written(self) -> Callable[..., str | bytes]:
        """The function that writes it, loaded when it is first used."""
        found: Callable[..., str | bytes] = import_module(
            f"railride.exports.as_{self.name}"
        ).written
        return found


TARGETS = {
    target.name: target
    for target in (
        Target("modelica", "Modelica package of the equations, with --track of the ride"),
        Target("matlab", "MATLAB file of the matrices, the state space and the names", text=False),
        Target("python", "Python module of the matrices as functions of the parameters"),
        Target("c", "C source of the same"),
        Target("fmu", "FMU of FMI 2.0 for co-simulation", text=False),
        Target("latex", "article of the derivation with the outputs' equations and all names"),
        Target("npz", "NumPy archive of what matlab holds", text=False),
    )
}
