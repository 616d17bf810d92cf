"""What is wrong with how a command ended that read a damaged file.

It ends with 0 and a result, or with 2 and one message that says what was found and what was
expected; never with a traceback, a NaN for a number or half a file. Damage that leaves the meaning
as it was leaves the numbers as they were.
"""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from damage_cases import Case, Outcome, run_here
from damage_sources import Source
from scipy.io import loadmat

# Keys of JSON that are numbers in every result; others may be null where nothing tells them.
NUMBERS = set("""M C K K_w C_w undamped_hz frequency_hz damping_ratio magnitude phase_deg a_rms
a_wrms length_m step_m rms_mm""".split())  # fmt: skip
WILD = re.compile(r"(?<![\w.])[-+]?(?:nan|inf|infinity)(?![\w.])", re.IGNORECASE)


def faults(case: Case, found: Outcome) -> list[str]:
    """What is wrong with an outcome; nothing if all is as it must be."""
    wrong = []
    if found.code not in (0, 2):
        wrong.append(f"exit code {found.code}")
    if "Traceback" in found.out + found.err:
        wrong.append("a traceback")
    if case.same and found.code != 0:
        wrong.append("refused, although nothing has changed")
    unasked = [file for file in found.left
               if file not in case.files and not re.match(r"out\.|\w+_results/", file)]  # fmt: skip
    if unasked:
        wrong.append(f"files that nobody asked for: {', '.join(unasked)}")
    changed = [file for file, content in case.files.items()
               if file != case.output and found.left.get(file) != content]  # fmt: skip
    if changed:
        wrong.append(f"changed what it read: {', '.join(changed)}")
    if found.code == 2:
        wrong += _faults_of_message(case, found)
    elif found.code == 0:
        wrong += _faults_of_result(case, found)
    return wrong


def _faults_of_message(case: Case, found: Outcome) -> list[str]:
    wrong = ["a result on standard output"] if found.out else []
    wrong += [f"no {word!r} in the message" for word in ("found", "expected")
              if word not in found.err]  # fmt: skip
    if not found.err.startswith("railride: ") or len(found.err.strip()) < 30:
        wrong.append("no message")
    if len(found.err) > 20_000:
        wrong.append(f"a message of {len(found.err)} characters")
    kept = {case.output: case.files[case.output]} if case.output in case.files else {}
    written = {file: found.left[file] for file in found.left if file not in case.files}
    if kept and found.left.get(str(case.output)) != kept[case.output]:
        wrong.append("overwrote the file of the result")
    if written:
        wrong.append(f"wrote {', '.join(written)}")
    return wrong


def _faults_of_result(case: Case, found: Outcome) -> list[str]:
    text = found.out
    if case.output:
        if found.out:
            return ["a result on standard output beside that in the file"]
        text = found.left.get(case.output, b"").decode("utf-8", "replace")
    if case.command[0] == "export":
        return _faults_of_export(case, found.left)
    if not text.strip():
        return ["no result"]
    if "json" not in case.command:
        wild = WILD.search(text)
        return [f"{wild[0]} in the result"] if wild and not WILD.search(_own_words(case)) else []
    try:
        document = json.loads(text, parse_constant=_refuse)
    except ValueError as error:
        return [f"JSON: {error}"]
    wrong = [f"null for {key}" for key in sorted(set(_undefined(document)))]
    if case.same and not wrong:
        wrong = unlike(document, undamaged(case.source, case.command, case.output))[:3]
    return wrong


def _faults_of_export(case: Case, left: dict[str, bytes]) -> list[str]:
    """Of the one file that was made: whole, and finite numbers in it."""
    ((name, content),) = ((file, left[file]) for file in left if file not in case.files)
    kind = name.rpartition(".")[2]
    if kind == "fmu":
        return [] if zipfile.ZipFile(io.BytesIO(content)).testzip() is None else ["a broken FMU"]
    if kind in ("npz", "mat"):
        arrays = (np.load if kind == "npz" else loadmat)(io.BytesIO(content))
        floats = [key for key in arrays if np.asarray(arrays[key]).dtype.kind == "f"]
        return [f"no finite {key}" for key in floats if not np.isfinite(arrays[key]).all()]
    wild = WILD.search(content.decode("utf-8"))
    return [f"{wild[0]} in the export"] if wild and not WILD.search(_own_words(case)) else []


def _own_words(case: Case) -> str:
    """Texts of the files, which a table may repeat: a name may be nan."""
    found = [re.findall(r"(?:name|source) *= *(.*)", content.decode("utf-8", "replace"))
             for content in case.files.values()]  # fmt: skip
    return "\n".join(text for texts in found for text in texts)


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} for a number")


def _undefined(value: Any, key: str = "") -> Iterator[str]:
    """Keys of numbers that are null."""
    if isinstance(value, dict):
        for name, each in value.items():
            yield from _undefined(each, name)
    elif isinstance(value, list):
        for each in value:
            yield from _undefined(each, key)
    elif value is None and key in NUMBERS:
        yield key


@cache
def undamaged(source: Source, command: tuple[str, ...], output: str | None) -> Any:
    """The result of the command with the files as they were."""
    files = {name: text.encode() for name, text in source.files.items()}
    found = run_here(command, files)
    return json.loads(found.left[output] if output else found.out)


def unlike(found: Any, expected: Any, where: str = "") -> list[str]:
    """Where two documents differ, but for remarks and rounding."""
    if isinstance(expected, dict) and isinstance(found, dict):
        if found.keys() != expected.keys():
            return [f"{where}: other keys"]
        return [one for key in expected if key not in ("remarks", "bytes", "symbolic")
                for one in unlike(found[key], expected[key], f"{where}.{key}")]  # fmt: skip
    if isinstance(expected, list) and isinstance(found, list):
        if len(found) != len(expected):
            return [f"{where}: {len(found)} in place of {len(expected)}"]
        numbers = [abs(x) for x in expected if isinstance(x, float)]
        if len(numbers) == len(expected) and numbers:  # zeros among them by rounding
            apart = [abs(a - b) for a, b in zip(found, expected, strict=True)]
            return [f"{where}: {found}; {expected}"] if max(apart) > 1e-8 * max(numbers) else []
        return [one for k, pair in enumerate(zip(found, expected, strict=True))
                for one in unlike(*pair, f"{where}[{k}]")]  # fmt: skip
    if isinstance(expected, float) and isinstance(found, float):
        return [] if math.isclose(found, expected, rel_tol=1e-7, abs_tol=1e-12) else [
            f"{where}: {found} in place of {expected}"]  # fmt: skip
    return [] if found == expected else [f"{where}: {found!r} in place of {expected!r}"]
