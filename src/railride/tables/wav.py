"""WAV files, by scipy."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from railride.errors import InputError
from railride.tables.table import Column, NumberTable


def read_wav(path: Path) -> NumberTable:
    """Read the channels of a WAV file, whole-number samples as shares of full scale (±1).

    path: an existing file. The columns are named "1", "2", … by channel; the rate is the file's.

    Raises InputError where the file ends before its header says.
    """
    from scipy.io import wavfile

    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", wavfile.WavFileWarning)
        rate, samples = wavfile.read(path)
    cut = [str(w.message) for w in caught if "EOF" in str(w.message)]
    if cut:
        raise InputError(
            f"{path}: file: found a WAV file that is cut off ({cut[0]}); expected a whole one "
            "(export it again)"
        )
    remarks = []
    if samples.dtype.kind in "iu":
        bits = 8 * samples.dtype.itemsize
        middle = 0.0 if samples.dtype.kind == "i" else 2.0 ** (bits - 1)
        samples = (samples.astype(np.float64) - middle) / 2.0 ** (bits - 1)
        remarks.append("the samples are shares of full scale, ±1: a WAV file states no unit")
    channels = samples.reshape(len(samples), -1).T
    columns = tuple(Column.of(str(k), channel) for k, channel in enumerate(channels, start=1))
    return NumberTable(str(path), columns, rate=float(rate), remarks=tuple(remarks))
