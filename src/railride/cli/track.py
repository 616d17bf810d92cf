"""``railride track``: makes, reads, checks and describes tracks."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railride.cli import options, output
from railride.cli.grouped import grouped
from railride.cli.options import FORMATS, Arguments
from railride.cli.reading import Reading
from railride.errors import InputError

if TYPE_CHECKING:
    from railride.spectra import Fit, Spectrum
    from railride.track import Track

MAKE = "A synthetic track"


@output.exits_cleanly
@grouped(reading=Reading)
def track(
    reading: Reading,
    file: Annotated[
        str | None, typer.Argument(metavar="[FILE]", help="A measured track to read and describe.")
    ] = None,
    spectrum: Annotated[
        str | None,
        typer.Option(
            metavar="NAME|FILE",
            rich_help_panel=MAKE,
            help="Make a track from this spectrum, by name or from a file; default erri_low.",
        ),
    ] = None,
    length: Annotated[
        str | None, typer.Option(metavar="M", rich_help_panel=MAKE, help="Default 1000.")
    ] = None,
    step: Annotated[
        str | None,
        typer.Option(
            metavar="M",
            rich_help_panel=MAKE,
            help="Default 0.25. Of a file: from row to row, in place of its distances.",
        ),
    ] = None,
    seed: Annotated[
        str | None, typer.Option(metavar="INT", rich_help_panel=MAKE, help="Default 1.")
    ] = None,
    extrapolate: options.ExtrapolateOption = False,
    write: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            rich_help_panel=options.RESULT,
            help="Write the track itself as CSV: distance_m,level_m.",
        ),
    ] = None,
    plot: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            rich_help_panel=options.RESULT,
            help="Draw level and spectrum into this file (.png, .pdf, .svg).",
        ),
    ] = None,
    form: options.FormatOption = "table",
    to: options.OutputOption = None,
) -> None:
    """Make a track from a spectrum, or read one, and describe it.

    --format csv gives the track itself; the other formats describe it.

    Example:  railride track --spectrum erri_high --length 2000 --seed 7 --write track.csv
    """
    given = Arguments()
    given.choice("--format", form, FORMATS)
    making = {"--spectrum": spectrum, "--length": length, "--seed": seed,
              "--extrapolate": "" if extrapolate else None}  # fmt: skip
    if file is not None:
        for option in (option for option, value in making.items() if value is not None):
            given.conflict(option, f"the file {file!r}")
    elif reading.options():
        given.conflict(reading.options()[0], "no file", "name the file of a measured track")
    metres, how = given.positive("--length", length, "m"), reading.arguments(given, step)
    number = given.whole("--seed", seed, 0, options.LARGEST_SEED)
    written = {"--output": to, "--write": write, "--plot": plot}
    given.writes(written, {"the track": file, "--spectrum": spectrum})
    given.check()
    source, found = _read(file, how) if file is not None else _make(
        spectrum or "erri_low", extrapolate, metres or 1000.0, how.get("step", 0.25),
        1 if number is None else number,
    )  # fmt: skip
    from railride.trackfile import track_text

    described, remarks = _described(found)
    fits, said = _fits(found)
    remarks += said
    text = track_text(found) if form == "csv" else output.result(
        form, {**described, **_fitted(fits)}, (),
        lambda: _table(found, source, described) + _fit_table(fits), remarks,
    )  # fmt: skip
    if write is not None:
        output.write(track_text(found), write)
    if plot is not None:
        from railride import plots

        plots.save(plots.plot_track_overview(found, source, fits=fits), plot)
    output.deliver(text, to, remarks)


def _make(
    name: str, extrapolate: bool, length: float, step: float, seed: int
) -> tuple[Spectrum | None, Track]:
    from railride import spectra
    from railride.track import synthesise

    source = spectra.spectrum(name)
    source = source.extrapolated() if extrapolate else source
    return source, synthesise(source, length, step, seed)


def _read(file: str, how: dict[str, Any]) -> tuple[Spectrum | None, Track]:
    from railride.spectra import spectrum_names
    from railride.trackfile import read_track

    if file in spectrum_names() and not Path(file).exists():
        raise InputError(f"track file {file!r}: found no such file; expected one (to make a "
                         f"track from that spectrum, --spectrum {file})")  # fmt: skip
    return None, read_track(file, **how)


def _described(found: Track) -> tuple[dict[str, Any], list[str]]:
    """The keys of cli's JSON, and remarks on what the record cannot tell."""
    from railride.spectra import D1, D2

    remarks = list(found.remarks)
    rows: dict[str, Any] = {"length_m": found.length, "step_m": found.step,
                            "rms_mm": 1000 * found.rms()}  # fmt: skip
    for key, (low, high) in (("d1_rms_mm", D1), ("d2_rms_mm", D2)):
        covered = found.covers(low, high)
        rows[key] = 1000 * found.band_rms(low, high) if covered else None
        if not covered:
            holds = (
                f", of wavelengths {found.band[0]:g} to {found.band[1]:g} m" if found.band else ""
            )
            remarks.append(
                f"{found.name}{holds}, {found.length:.6g} m in steps of {found.step:.4g} m, does "
                f"not resolve wavelengths of {low:g} to {high:g} m: no value for them"
            )
    return rows, remarks


def _fits(found: Track) -> tuple[tuple[Fit, ...], list[str]]:
    """How the standard spectra fit the track's own, and what to say of that."""
    from railride.spectra import fit_spectra
    from railride.stochastic import measured_spectrum
    from railride.stochastic.measured import FEW

    if found.rms() == 0.0:
        return (), [f"{found.name} is level: no spectrum fits it"]
    try:
        own = measured_spectrum(found)
    except InputError as fault:
        return (), [f"no spectrum to compare: {fault}"]
    rests_on = f"{own.segments} segments of {own.segment:.6g} m only: indicative"
    few = f"{found.name}: the spectra were fitted to {rests_on}"
    return fit_spectra(own), [few] if own.segments < FEW else []


def _fitted(fits: Sequence[Fit]) -> dict[str, Any]:
    """The fits under their keys in JSON."""
    rows = [
        {"spectrum": fit.spectrum.name, "misfit_db": fit.misfit_db, "level_ratio": fit.level_ratio,
         "wavelengths_m": fit.wavelengths, "third_octaves": fit.bands}
        for fit in fits
    ]  # fmt: skip
    return {"best_spectrum": rows[0]["spectrum"] if rows else None, "spectra": rows}


def _fit_table(fits: Sequence[Fit]) -> str:
    """The fits as a table, or nothing."""
    if not fits:
        return ""
    columns = [("spectrum", ""), ("misfit\n[dB]", ".2f"), ("level\nratio", ".3f"),
               ("wavelengths\n[m]", ">")]  # fmt: skip
    rows = [
        (
            fit.spectrum.name,
            fit.misfit_db,
            fit.level_ratio,
            "{:.3g}-{:.3g}".format(*fit.wavelengths),
        )
        for fit in fits
    ]
    title = "Standard spectra beside the track's own in third octaves, the best fit first"
    return "\n" + output.table_text(title, columns, rows)


def _table(found: Track, source: Spectrum | None, rows: dict[str, Any]) -> str:
    """The values, and beside those of a synthetic track what its spectrum has on average."""
    from railride.spectra import D1, D2, band_rms

    expected: dict[str, float] = {}
    if source is not None:
        bands = {"d1_rms_mm": D1, "d2_rms_mm": D2}
        expected = {key: 1000 * band_rms(source, *band) for key, band in bands.items()}
    names = {
        "length_m": "length [m]", "step_m": "step [m]", "rms_mm": "r.m.s. [mm]",
        "d1_rms_mm": "r.m.s. in D1, 3-25 m [mm]", "d2_rms_mm": "r.m.s. in D2, 25-70 m [mm]",
    }  # fmt: skip
    columns = [("", ""), ("value", ".6g"), ("of the spectrum", ".6g")]
    table = [
        (names[key], value, expected.get(key) if value is not None else None)
        for key, value in rows.items()
    ]
    width = 3 if source is not None else 2
    return output.table_text(f"Track {found.name}", columns[:width], [row[:width] for row in table])
