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
    _check_target(target)
    return TARGETS[target].written(content, **details)


def export_model(
    model: VehicleModel,
    target: str,
    file: str | Path,
    *,
    outputs: Output | str | Sequence[Output | str] | None = None,
    at: float | Sequence[float] = 0.0,
    floor: str = "smooth",
    track: str | Path | Spectrum | Track | None = None,
    speed: float | None = None,
    length: float | None = None,
    seed: int | None = None,
) -> tuple[str, ...]:
    """Write the linear model in another tool's form, the whole file or nothing.

    Returns what the user should know of the values, the model and the ride; it stands in the file
    as well.

    Parameters
    ----------
    target : one of ``railride.exports.targets.TARGETS``.
    file : to be written or replaced.
    outputs : one or several, or their names, "floor_acceleration" for that at all points ``at``;
        default: these, and every output of the vehicle that does not feel the elevation's second
        rate.
    at : points of the floor, m forward of the body's middle.
    floor : "smooth", "polygon" or "spline".
    track : of "modelica" alone: the ride over this track as well, a spectrum by name or a measured
        track by its file, or either as it is; see ``railride.exports.setup``.
    speed, length : of that ride, m/s and m; default 145 km/h and 1000 m. seed : of a synthetic
        track; default 1.

    Raises
    ------
    InputError : a target that does not exist, or whose library is not installed; a track for one
        that holds none, or what is said of a ride without a track; outputs that do not go with what
        else is asked, see ``railride.exports.content``; a file that cannot be written.

    Examples
    --------
    >>> import tempfile, numpy
    >>> from railride.vehicle import derive_vehicle
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "coach.npz")
    ...     remarks = export_model(derive_vehicle("cati2024", segments=2), "npz", file)
    ...     numpy.load(file)["M"].shape
    (7, 7)
    """
    found, remarks = exported(
        model, target, outputs, at, floor, track, speed=speed, length=length, seed=seed
    )
    write_bytes(file, found.encode() if isinstance(found, str) else found)
    return remarks


def exported(
    model: VehicleModel,
    target: str,
    outputs: Output | str | Sequence[Output | str] | None,
    at: float | Sequence[float],
    floor: str,
    track: str | Path | Spectrum | Track | None,
    **ride: Any,
) -> tuple[str | bytes, tuple[str, ...]]:
    """What :func:`export_model` writes and returns; arguments as there."""
    _check_target(target)
    content = content_of(model, outputs, at, floor)
    given = {name: value for name, value in ride.items() if value is not None}
    if track is None:
        for name, value in given.items():
            raise InputError(f"{name}: found {value!r}, but no track; expected the track of a ride "
                             "(or neither)")  # fmt: skip
        return export_content(content, target), content.remarks
    if target != "modelica":
        raise InputError(f"track: found one for {target!r}; expected none (only 'modelica' "
                         "holds a ride)")  # fmt: skip
    setup = ride_setup(content, track, **given)
    return export_content(content, target, setup=setup), (*content.remarks, *setup.remarks)


def _check_target(target: str) -> None:
    if target not in TARGETS:
        raise InputError(f"target: found {target!r}; expected one of {', '.join(TARGETS)}")
