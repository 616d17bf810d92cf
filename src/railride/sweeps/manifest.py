"""What a folder of results is of: written when a sweep starts, compared when it goes on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from railride import __version__
from railride.errors import InputError
from railride.files import write_text
from railride.parameters import Vehicle
from railride.spectra import Spectrum, spectrum_names
from railride.stochastic import track_spectrum
from railride.studies import Study
from railride.sweeps.plan import Plan

NAME = "_study.json"  # what readers of Parquet folders pass over begins with an underscore
_COMMENTS = ("name", "source", "remarks")  # of a vehicle: they change nothing
_WAVENUMBERS = np.geomspace(0.01, 100.0, 64)  # rad/m, at which a spectrum is told from others
_SHOWN = 10  # keys in a message
_KINDS = {"study": str, "keys": dict, "parameters": list, "columns": list, "designs": int,
          "chunk": int, "form": str}  # fmt: skip


@dataclass(frozen=True)
class Manifest:
    """What the results are of.

    study : its name. keys : all that they depend on, by the keys of its file.
    parameters, columns : headings of the parameters, and of the results with what is wrong.
    designs : how many in all. chunk : designs in a part. form : "parquet" or "csv".
    """

    study: str
    keys: Mapping[str, Any]
    parameters: Sequence[str]
    columns: Sequence[str]
    designs: int
    chunk: int
    form: str

    @property
    def fingerprint(self) -> str:
        """Tells results apart, in 16 hexadecimal digits."""
        content = json.dumps(self._all, sort_keys=True)
        return hashlib.sha256(content.encode()).hexdigest()[:16]

    @property
    def _all(self) -> dict[str, Any]:
        """All that must be the same for parts to belong together."""
        return {**self.keys, "columns": [*self.parameters, *self.columns],
                "sweep.chunk": self.chunk, "sweep.format": self.form}  # fmt: skip

    def write(self, folder: Path) -> None:
        """Write it into the folder, whole or not at all."""
        text = json.dumps({"railride": __version__, "fingerprint": self.fingerprint, **vars(self)},
                          indent=1, ensure_ascii=False)  # fmt: skip
        write_text(folder / NAME, text + "\n")

    def differences(self, before: Manifest) -> list[str]:
        """``key: found …; there …`` for all that is not as it was ``before``."""
        now, then = self._all, before._all
        keys = [key for key in dict.fromkeys([*then, *now])
                if now.get(key, ...) != then.get(key, ...)]  # fmt: skip
        return [_difference(key, then, now) for key in keys]


def read_manifest(folder: Path) -> Manifest | None:
    """The manifest of a folder; None where there is none.

    Raises
    ------
    InputError : one that is damaged, or of another version.
    """
    path = folder / NAME
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        named = {name: content[name] for name in Manifest.__dataclass_fields__}
        wrong = [name for name, kind in _KINDS.items() if not isinstance(named[name], kind)]
        if wrong or named["chunk"] < 1:
            raise ValueError(f"its {(wrong or ['chunk'])[0]!r}")
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path}: found a file that cannot be read ({error}); expected the description of a "
            "sweep (is it damaged? Give another folder)"
        ) from None
    return Manifest(**named)


def keys_of(study: Study, plan: Plan) -> dict[str, Any]:
    """All that the results of a study depend on, by the keys of its file, as JSON keeps it."""
    ride = study.ride
    keys: dict[str, Any] = {"program": f"railride {__version__}"}
    keys |= _flat("vehicle", _vehicle(study.vehicle))
    keys |= {f"body.{name}": value for name, value in vars(study.body).items()}
    keys |= {"ride.speeds": ride.speeds, "ride.positions": ride.positions,
             "ride.floor": ride.floor, "ride.weighting": ride.weight,
             "ride.results": ride.results}  # fmt: skip
    for place, (track, file) in enumerate(zip(ride.tracks, ride.files, strict=True), start=1):
        keys[f"ride.tracks[{place}]"] = _content(file) if file else _spectrum(track)
        if isinstance(track, Spectrum) and track.extrapolate:
            keys["ride.extrapolate"] = True
    found: dict[str, Any] = json.loads(json.dumps({**keys, **plan.keys()}))
    return found


def _vehicle(vehicle: Vehicle) -> dict[str, Any]:
    """The vehicle's values, files from outside by their content."""
    values = {key: value for key, value in asdict(vehicle).items() if key not in _COMMENTS}
    if vehicle.body.mode_files is not None:
        values["body"]["mode_files"] |= {
            key: _content(Path(path)) for key, path in vehicle.body.mode_files.paths.items()
        }
    return values


def _flat(where: str, value: Any) -> dict[str, Any]:
    """Values of nested records and lists of them by their full keys: ``bogies[1].mass``."""
    if isinstance(value, Mapping):
        parts = [(f"{where}.{key}", part) for key, part in value.items()]
    elif isinstance(value, list | tuple) and any(isinstance(part, Mapping) for part in value):
        parts = [(f"{where}[{place}]", part) for place, part in enumerate(value, start=1)]
    else:
        return {} if value is None else {where: value}
    return {key: found for name, part in parts for key, found in _flat(name, part).items()}


def _content(path: Path) -> str:
    """A file by its content."""
    with path.open("rb") as stream:
        return "content " + hashlib.file_digest(stream, "sha256").hexdigest()[:16]


def _spectrum(track: Any) -> str:
    """A spectrum by what it is, to seven digits as any machine has it; by its name if it ships."""
    found, _ = track_spectrum(track)
    density = [f"{value:.6e}" for value in found.density(_WAVENUMBERS)]
    digest = hashlib.sha256(" ".join(density).encode()).hexdigest()[:16]
    return f"{found.name} {digest}" if found.name in spectrum_names() else f"content {digest}"


def _difference(key: str, then: Mapping[str, Any], now: Mapping[str, Any]) -> str:
    found, before = (_short(values[key]) if key in values else "nothing" for values in (now, then))
    return f"{key}: found {found}, there it was {before}"


def _short(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 80 else f"{text[:70]}…"


def refuse_another(folder: Path, differences: Sequence[str]) -> None:
    """Refuse results of another study, or of the same one before it was changed."""
    if not differences:
        return
    more = len(differences) - _SHOWN
    listed = [*differences[:_SHOWN], *([f"and {more} more"] if more > 0 else [])]
    raise InputError(
        f"{str(folder)!r}: found results of another study, or of this one before it was changed:\n"
        + "\n".join(f"  {line}" for line in listed)
        + "\nexpected those of this one (--replace throws them away; or give another folder)"
    )
