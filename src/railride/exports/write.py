"""A model written in another tool's form."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from railride.errors import InputError
from railride.exports.content import Content, content_of
from railride.exports.setup import ride_setup
from railride.exports.targets import TARGETS
from railride.files import write_bytes
from railride.spectra import Spectrum
from railride.track import Track
from railride.vehicle import Output, VehicleModel


def export_content(content: Content, target: str, **details: Any) -> str | bytes:
    """The whole file of an export; ``details`` are the target's own.

    Raises
    ------
    InputError : a target that does not exist; what the target cannot hold.
    """
    if target not in TARGETS:
        raise InputError(f"target: found {target!r}; expected one of {', '.join(TARGETS)}")
    return TARGETS[target].written(content, **details)


def export_model(
    model: VehicleModel,
    target: str,
    file: str | Path,
    *,
    outputs: Output | str | Sequence[Output | str] | None = None,
    at: Sequence[float] = (0.0,),
    floor: str = "smooth",
    track: str | Path | Spectrum | Track | None = None,
    speed: float = 145 / 3.6,
    length: float = 1000.0,
    seed: int = 1,
) -> None:
    """Write the linear model in another tool's form, the whole file or nothing.

    Parameters
    ----------
    target : one of ``railride.exports.targets.TARGETS``.
    file : to be written or replaced.
    outputs : one or several, or their names; default: the floor's acceleration at the points
        ``at``, and every output of the vehicle that does not feel the elevation's second rate.
    at : points of the floor, m forward of the body's middle.
    floor : "smooth", "polygon" or "spline".
    track : of "modelica" alone: the ride over this track as well, a spectrum by name or a measured
        track by its file, or either as it is; see ``railride.exports.setup``.
    speed, length, seed : of that ride, in m/s and m; of a synthetic track.

    Raises
    ------
    InputError : a target that does not exist, or whose library is not installed; a track for one
        that holds none; an output that does not exist or that feels the second rate of the
        elevation; a file that cannot be written.

    Examples
    --------
    >>> import tempfile, numpy
    >>> from railride.vehicle import derive_vehicle
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "coach.npz")
    ...     export_model(derive_vehicle("cati2024", segments=2), "npz", file)
    ...     numpy.load(file)["M"].shape
    (7, 7)
    """
    found, _ = exported(
        model, target, outputs, at, floor, track=track, speed=speed, length=length, seed=seed
    )
    write_bytes(file, found.encode() if isinstance(found, str) else found)


def exported(
    model: VehicleModel,
    target: str,
    outputs: Output | str | Sequence[Output | str] | None,
    at: Sequence[float],
    floor: str,
    *,
    track: str | Path | Spectrum | Track | None,
    speed: float,
    length: float,
    seed: int,
) -> tuple[str | bytes, tuple[str, ...]]:
    """What :func:`export_model` writes, and remarks on the ride in it; arguments as there."""
    content = content_of(model, outputs, at, floor)
    if track is None:
        return export_content(content, target), ()
    if target != "modelica":
        raise InputError(f"track: found one for {target!r}; expected none (only 'modelica' "
                         "holds a ride)")  # fmt: skip
    setup = ride_setup(content, track, speed, length=length, seed=seed)
    return export_content(content, target, setup=setup), setup.remarks
