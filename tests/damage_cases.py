"""Cases of damaged files: which file, how it is damaged, the command that reads it, how it ends."""

from __future__ import annotations

import contextlib
import io
import os
import random
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from damage import BYTES, COLUMNS, SAME_COLUMNS, SAME_LINES
from damage_sources import Source, sources
from damage_toml import SAME_TOML, TOML

ROOT = Path(__file__).resolve().parents[1]
LIMIT = 60  # s for one command
KEPT = "kept\n"  # what stood in the file of the result before
HOW = {"toml": TOML, "columns": COLUMNS, "lines": COLUMNS}
SAME = {"toml": SAME_TOML, "columns": SAME_COLUMNS, "lines": SAME_LINES}


@dataclass(frozen=True)
class Case:
    """A command and its files, one of them damaged; ``same``: in a way that changes no number."""

    index: int
    source: Source
    damage: str
    command: tuple[str, ...]
    files: dict[str, bytes]
    same: bool
    output: str | None

    @property
    def line(self) -> str:
        return "railride " + shlex.join(self.command)


@dataclass(frozen=True)
class Outcome:
    """How a command ended, what it said, and the files that it left."""

    code: int
    out: str
    err: str
    left: dict[str, bytes]
    seconds: float


def case(seed: int, index: int) -> Case:
    """The case of a seed and an index, the same on every machine."""
    rng = random.Random(f"{seed}/{index}")  # noqa: S311
    kinds = sorted({source.kind for source in sources()})
    kind = kinds[index % len(kinds)]
    source = rng.choice([source for source in sources() if source.kind == kind])
    command = shlex.split(rng.choice(source.commands))
    same = rng.random() < 0.15
    name = rng.choice(sorted(source.damaged))
    content, damage = _damaged(rng, source, name, same)
    form = "json" if same else rng.choice(("json", "json", "table", "csv"))
    if command[0] != "export":
        command += ["--format", form]
    # What a sweep writes is a folder.
    output = "out.txt" if rng.random() < 0.3 and command[0] not in ("export", "sweep") else None
    command += ["--output", output] if output else []
    files = {other: text.encode() for other, text in source.files.items()} | {name: content}
    if output and rng.random() < 0.5:
        files[output] = KEPT.encode()
    return Case(index, source, damage, tuple(command), files, same, output)


def _damaged(rng: random.Random, source: Source, name: str, same: bool) -> tuple[bytes, str]:
    """The file's content changed, and by what; mostly once."""
    content, done = source.files[name].encode(), []
    kinds = (SAME if same else HOW)[source.damaged[name]]
    if not same and rng.random() < 0.3:  # mostly still a file, of something that hardly can be
        kinds = {how: kinds[how] for how in ("a size", "a column's size") if how in kinds}
    for _ in range(1 if same else rng.choice((1, 1, 1, 1, 2, 5))):
        of_bytes = len(kinds) > 1 and not same and rng.random() < 0.2
        how = rng.choice(sorted(BYTES if of_bytes else kinds))
        with contextlib.suppress(ValueError, IndexError):  # too little left to be damaged so
            new = BYTES[how](rng, content) if of_bytes else kinds[how](rng, content.decode())
            content = new if isinstance(new, bytes) else new.encode("utf-8", "surrogatepass")
            done.append(how)
    return content, f"{name}: {' + '.join(done)}"


# Running a command


def run_here(command: tuple[str, ...], files: dict[str, bytes]) -> Outcome:
    """The command in this process, its warnings errors."""
    from railride.cli import main

    def call(folder: Path) -> tuple[int, str, str]:
        out, err, code = io.StringIO(), io.StringIO(), 0
        with (contextlib.chdir(folder), contextlib.redirect_stdout(out),
              contextlib.redirect_stderr(err), warnings.catch_warnings(), _alarm()):  # fmt: skip
            warnings.simplefilter("error")
            try:
                main(list(command))
            except SystemExit as stopped:
                code = stopped.code if isinstance(stopped.code, int) else int(bool(stopped.code))
        return code, out.getvalue(), err.getvalue()

    return _run(call, files)


def run_process(command: tuple[str, ...], files: dict[str, bytes]) -> Outcome:
    """The command as a process of its own, its warnings errors."""

    def call(folder: Path) -> tuple[int, str, str]:
        path = os.pathsep.join(filter(None, (str(ROOT / "src"), os.environ.get("PYTHONPATH"))))
        try:
            done = subprocess.run(  # noqa: S603
                [sys.executable, "-W", "error", "-m", "railride", *command],
                cwd=folder, env={**os.environ, "PYTHONPATH": path}, capture_output=True,
                encoding="utf-8", timeout=LIMIT, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return 124, "", f"not finished within {LIMIT} s"
        return done.returncode, done.stdout, done.stderr

    return _run(call, files)


def _run(call: Callable[[Path], tuple[int, str, str]], files: dict[str, bytes]) -> Outcome:
    with tempfile.TemporaryDirectory(prefix="railride") as name:
        folder = Path(name)
        for file, content in files.items():
            (folder / file).write_bytes(content)
        began = time.perf_counter()
        code, out, err = call(folder)
        took = time.perf_counter() - began
        left = {str(path.relative_to(folder)): path.read_bytes()
                for path in sorted(folder.rglob("*")) if path.is_file()}  # fmt: skip
    return Outcome(code, out, err, left, took)


@contextlib.contextmanager
def _alarm() -> Iterator[None]:
    """Ends what takes longer than LIMIT, where the system has alarms."""
    if not hasattr(signal, "setitimer"):
        yield
        return

    def ring(*_: object) -> None:
        raise TimeoutError(f"not finished within {LIMIT} s")

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, LIMIT)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
