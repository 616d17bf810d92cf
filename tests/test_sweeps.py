"""Sweeps: every design once, whatever happens, and nothing of another study among them."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import mortal
import numpy as np
import pandas as pd
import pytest

from railride import (
    InputError,
    derive_vehicle,
    modes,
    plot_sweep,
    read_sweep,
    stochastic_ride,
    sweep,
)
from railride.sweeps import flight, lock, manifest, pool, read_sweep_study, store
from railride.sweeps.plan import Samples

ROOT = Path(__file__).resolve().parents[1]
HEAD = """
vehicle = "cati2024"
[body]
segments = 1
[ride]
speeds = ["145 km/h", "200 km/h"]
"""
GRID = (
    HEAD
    + """
[sweep]
kind = "grid"
chunk = 4
[parameters.secondary_stiffness]
from = "600 kN/m"
to = "900 kN/m"
points = 5
[parameters.c_2]
values = ["50 kN s/m", "60 kN s/m", "70 kN s/m", "80 kN s/m"]
"""
)  # 20 designs in 5 parts
CASES = ["a_wrms erri_low 145 km/h 0 m [m/s^2]", "a_wrms erri_low 200 km/h 0 m [m/s^2]"]


@pytest.fixture
def written(tmp_path):
    """A study's file of this text, beside which designs.csv may be."""

    def write(text=GRID, name="study.toml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "results"


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The grid's results, swept in this process without an incident."""
    place = tmp_path_factory.mktemp("alone")
    (place / "study.toml").write_text(GRID, encoding="utf-8")
    return sweep(place / "study.toml", place / "results", executor=pool.InProcess()).table()


def in_this_process(study, folder, **more):
    return sweep(study, folder, executor=pool.InProcess(), **more)


def assert_whole(folder, alone):
    """Nothing lost, nothing doubled, every number the same to the last bit."""
    pd.testing.assert_frame_equal(read_sweep(folder).table(), alone, check_exact=True)


# The designs


def test_a_grid_is_every_combination_the_last_parameter_fastest(alone):
    assert alone["design"].tolist() == list(range(1, 21))
    k = np.repeat([600e3, 675e3, 750e3, 825e3, 900e3], 4)
    np.testing.assert_allclose(alone["secondary_stiffness [N/m]"], k, rtol=1e-15)
    np.testing.assert_allclose(alone["c_2 [N s/m]"], np.tile([5e4, 6e4, 7e4, 8e4], 5), rtol=1e-15)


def test_values_are_those_of_a_ride_alone(alone):
    coach = derive_vehicle("cati2024", 1)
    for place in (0, 7, 19):
        row = alone.iloc[place]
        changes = {"k_2": row["secondary_stiffness [N/m]"], "c_2": row["c_2 [N s/m]"]}
        for case, speed in zip(CASES, (145 / 3.6, 200 / 3.6), strict=True):
            a_w = stochastic_ride(coach, speed, "erri_low", **changes).a_wrms[0]
            assert row[case] == pytest.approx(a_w, rel=1e-9)


def test_a_list_is_its_rows_in_si_units(written, folder, tmp_path):
    (tmp_path / "designs.csv").write_text(
        "No;secondary_stiffness [kN/m];bending_damping [%]\n1;600;1,5\n2;750,5;2\n"
    )
    text = HEAD.replace("segments = 1", "segments = 2")
    found = in_this_process(written(text + '[sweep]\nkind="list"\nfile="designs.csv"\n'), folder)
    table = found.table()
    assert found.parameters == ("secondary_stiffness [N/m]", "bending_damping")
    assert table["secondary_stiffness [N/m]"].tolist() == [600e3, 750.5e3]
    assert table["bending_damping"].tolist() == [0.015, 0.02]


SAMPLES = (
    HEAD
    + """
[sweep]
kind = "samples"
number = 10
method = "latin_hypercube"
chunk = 4
[parameters.m_c]
distribution = "uniform"
from = "34 t"
to = "44 t"
"""
)


def test_samples_do_not_depend_on_the_chunks(written, folder, tmp_path):
    table = in_this_process(written(SAMPLES), folder).table()
    mass = table["m_c [kg]"]
    assert sorted(((mass - 34e3) // 1000).astype(int)) == list(range(10))  # one in each slice
    whole = in_this_process(written(SAMPLES.replace("chunk = 4", "")), tmp_path / "whole")
    np.testing.assert_array_equal(whole.table()["m_c [kg]"], mass)
    assert isinstance(read_sweep_study(written(SAMPLES)).settings["sweep"].plan, Samples)


# The folder


@pytest.mark.parametrize("form", ["parquet", "csv"])
def test_the_parts_are_what_other_programs_read(written, folder, alone, form):
    text = GRID.replace("chunk = 4", f'chunk = 4\nformat = "{form}"')
    found = in_this_process(written(text), folder)
    names = [f"part-{k:06d}.{form}" for k in range(1, 6)]
    assert sorted(path.name for path in folder.glob("part-*")) == names
    assert (found.designs, found.done, found.new, found.form) == (20, 20, 20, form)
    pd.testing.assert_frame_equal(found.table(), alone, check_exact=True)
    if form == "parquet":  # the folder as a whole
        read = pd.read_parquet(folder).sort_values("design", ignore_index=True)
    else:
        texts = [(folder / name).read_text(encoding="utf-8").splitlines() for name in names]
        assert len({lines[0] for lines in texts}) == 1
        rows = [line.split(",") for lines in texts for line in lines[1:]]
        read = pd.DataFrame(rows, columns=texts[0][0].split(","))
        read = read.astype({name: alone[name].dtype for name in read})
    pd.testing.assert_frame_equal(read, alone, check_exact=True)


def test_without_pyarrow_parts_are_csv(written, folder, monkeypatch):
    monkeypatch.setattr(store, "usual_form", lambda: "csv")
    monkeypatch.setattr("railride.sweeps.run.usual_form", lambda: "csv")
    assert in_this_process(written(), folder).form == "csv"
    asked = GRID.replace("chunk = 4", 'format = "parquet"')
    with pytest.raises(InputError, match=r"railride\[formats\]"):
        in_this_process(written(asked), folder)
    new = folder.parent / "new" / "results"
    with pytest.raises(InputError, match=r"railride\[formats\]"):
        in_this_process(written(asked), new)
    assert not new.parent.exists()
    new.mkdir(parents=True)  # what was there stays
    with pytest.raises(InputError, match=r"railride\[formats\]"):
        in_this_process(written(asked), new)
    assert new.exists()


def test_a_sweep_goes_on_as_it_was_begun(written, folder, alone):
    in_this_process(written(), folder)
    for name in ("part-000002", "part-000005"):
        (folder / f"{name}.parquet").unlink()
    seen = []
    found = in_this_process(written(), folder, progress=lambda *counts: seen.append(counts))
    assert seen == [(12, 20), (16, 20), (20, 20)]
    assert found.new == 8
    assert_whole(folder, alone)


@pytest.mark.parametrize("form", ["parquet", "csv"])
def test_a_damaged_part_is_made_again(written, folder, form, alone):
    study = written(GRID.replace("chunk = 4", f'chunk = 4\nformat = "{form}"'))
    in_this_process(study, folder)
    damaged = folder / f"part-000003.{form}"
    content = damaged.read_bytes()
    (folder / f".part-000004.{form}.abc123").write_bytes(b"left by a process that was killed")
    for cut in (0, len(content) // 2, len(content) - 1):
        damaged.write_bytes(content[:cut])
        found = in_this_process(study, folder)
        assert found.new == 4
        assert any(damaged.name in remark for remark in found.remarks)
    assert_whole(folder, alone)
    assert not list(folder.glob(".part*"))


@pytest.mark.parametrize("form", ["parquet", "csv"])
def test_a_part_in_the_place_of_another_is_made_again(written, folder, form, alone):
    study = written(GRID.replace("chunk = 4", f'chunk = 4\nformat = "{form}"'))
    in_this_process(study, folder)
    first, second = (folder / f"part-00000{k}.{form}" for k in (1, 2))
    first.write_bytes(second.read_bytes())
    assert in_this_process(study, folder).new == 4
    assert_whole(folder, alone)


def test_a_part_with_damage_amid_it_is_named(written, folder):
    in_this_process(written(), folder)
    damaged = folder / "part-000003.parquet"
    content = damaged.read_bytes()
    damaged.write_bytes(content[:4] + bytes(len(content) // 4) + content[4 + len(content) // 4 :])
    with pytest.raises(InputError, match=r"part-000003\.parquet: found a damaged part.*delete it"):
        read_sweep(folder)
    damaged.unlink()
    assert in_this_process(written(), folder).new == 4


def test_parquet_cannot_be_read_without_its_library(written, folder, monkeypatch):
    in_this_process(written(), folder)
    monkeypatch.setattr(store, "usual_form", lambda: "csv")
    with pytest.raises(InputError, match=r"railride\[formats\]"):
        read_sweep(folder)


def test_a_changed_study_is_refused_and_told_by_its_keys(written, folder):
    in_this_process(written(), folder)
    changed = GRID.replace('to = "900 kN/m"', 'to = "950 kN/m"').replace('"200 km/h"', '"220 km/h"')
    with pytest.raises(InputError) as caught:
        in_this_process(written(changed), folder)
    message = str(caught.value)
    assert "parameters.secondary_stiffness.high: found 950000.0, there it was 900000.0" in message
    assert "ride.speeds: found" in message
    assert "columns: found" in message
    assert "--replace" in message
    assert message.count("there it was") == 3


@pytest.mark.parametrize(
    ("before", "after", "key"),
    [
        ("chunk = 4", "chunk = 5", "sweep.chunk"),
        ("segments = 1", "segments = 2", "body.segments"),
        ('"80 kN s/m"]', '"81 kN s/m"]', "parameters.c_2.listed"),
        ("[ride]", '[ride]\nfloor = "polygon"', "ride.floor"),
        ("[ride]", '[ride]\nweighting = "Wk_paper"', "ride.weighting"),
        ("[ride]", '[ride]\ntracks = ["erri_high"]', "ride.tracks[1]"),
        ("points = 5", 'points = 5\nspacing = "log"', "parameters.secondary_stiffness.spacing"),
        ("chunk = 4", 'chunk = 4\nformat = "csv"', "sweep.format"),
    ],
)
def test_every_key_is_noticed(written, folder, before, after, key):
    in_this_process(written(), folder)
    with pytest.raises(InputError) as caught:
        in_this_process(written(GRID.replace(before, after)), folder)
    assert f"  {key}: found" in str(caught.value)


def test_comments_and_names_are_no_change(written, folder):
    in_this_process(written(), folder)
    assert in_this_process(written('name = "other"\n# said\n' + GRID), folder).new == 0


def test_changed_files_beside_the_study_are_noticed(written, folder, tmp_path):
    from railride import load_vehicle, spectrum, synthesise, write_track, write_vehicle

    coach = load_vehicle("cati2024")
    write_vehicle(coach, tmp_path / "coach.toml")
    write_track(synthesise(spectrum("erri_low"), 300.0, 0.25, seed=1), tmp_path / "line.csv")
    (tmp_path / "designs.csv").write_text("k_2 [kN/m]\n600\n700\n")
    text = HEAD.replace("cati2024", "coach.toml") + 'tracks = ["line.csv"]\n'
    study = written(text + '[sweep]\nkind = "list"\nfile = "designs.csv"\n')
    in_this_process(study, folder)

    def refused():
        with pytest.raises(InputError) as caught:
            in_this_process(study, folder)
        return str(caught.value)

    heavier = replace(coach.bogies[1], mass=3100.0)
    write_vehicle(replace(coach, bogies=(coach.bogies[0], heavier)), tmp_path / "coach.toml")
    assert "vehicle.bogies[2].mass: found 3100.0, there it was 3000.0" in refused()
    write_vehicle(replace(coach, remarks=("said",)), tmp_path / "coach.toml")
    assert in_this_process(study, folder).new == 0
    write_track(synthesise(spectrum("erri_low"), 300.0, 0.25, seed=2), tmp_path / "line.csv")
    (tmp_path / "designs.csv").write_text("k_2 [kN/m]\n600\n701\n")
    assert "ride.tracks[1]: found" in refused()
    assert "sweep.file values: found" in refused()


def test_replace_throws_away_what_is_of_another_study_only(written, folder, tmp_path):
    in_this_process(written(), folder)
    other = written(GRID.replace("900", "950"))
    found = in_this_process(other, folder, replace=True)
    assert (found.new, found.done) == (20, 20)
    assert any("5 parts" in remark for remark in found.remarks)
    (folder / "part-000002.parquet").unlink()
    # The same command goes on, with --replace too.
    assert in_this_process(other, folder, replace=True).new == 4
    fewer = in_this_process(written(GRID.replace("points = 5", "points = 2")), folder, replace=True)
    assert (fewer.done, len(fewer.table())) == (8, 8)


@pytest.mark.parametrize("step", ["clear", "write"])
def test_replacing_may_be_interrupted_at_any_step(written, folder, tmp_path, monkeypatch, step):
    csv = GRID.replace("chunk = 4", 'chunk = 4\nformat = "csv"')
    in_this_process(written(csv), folder)
    other = written(csv.replace("900", "950"))

    def stop(*_):
        raise KeyboardInterrupt

    with monkeypatch.context() as context:
        context.setattr({"clear": store.Store, "write": manifest.Manifest}[step], step, stop)
        with pytest.raises(KeyboardInterrupt):
            in_this_process(other, folder, replace=True)
    in_this_process(other, folder, replace=True)
    assert_whole(folder, in_this_process(other, tmp_path / "fresh").table())


def test_folders_with_something_else_are_refused(written, folder):
    folder.mkdir()
    (folder / "other.parquet").write_bytes(b"PAR1")
    with pytest.raises(InputError, match=r"found other\.parquet.*empty folder"):
        in_this_process(written(), folder)
    (folder / "other.parquet").unlink()
    in_this_process(written(), folder)
    (folder / "picture.png").write_bytes(b"a picture does not harm")
    assert in_this_process(written(), folder).new == 0
    for name in ("other.parquet", "part-000006.parquet", "part-000001.csv"):
        (folder / name).write_bytes(b"PAR1")
        with pytest.raises(InputError, match=name):
            in_this_process(written(), folder)
        with pytest.raises(InputError, match=name):  # not even to be replaced
            in_this_process(written(GRID.replace("900", "950")), folder, replace=True)
        (folder / name).unlink()
    sound = json.loads((folder / "_study.json").read_text())
    for wrong in ({}, {**sound, "keys": 3}, {**sound, "columns": None}, {**sound, "chunk": 0}):
        (folder / "_study.json").write_text(json.dumps(wrong))
        with pytest.raises(InputError, match="cannot be read"):
            in_this_process(written(), folder)
        with pytest.raises(InputError, match="cannot be read"):
            read_sweep(folder)


def test_a_part_of_another_study_is_refused(written, folder, tmp_path):
    in_this_process(written(), folder)
    in_this_process(written(GRID.replace("900", "950")), tmp_path / "other")
    part = "part-000002.parquet"
    (folder / part).write_bytes((tmp_path / "other" / part).read_bytes())
    with pytest.raises(InputError, match="a part of another sweep"):
        in_this_process(written(), folder)


def test_one_writer_at_a_time(written, folder):
    folder.mkdir()
    with lock.locked(folder), pytest.raises(InputError, match="another sweep that writes into it"):
        in_this_process(written(), folder)
    assert in_this_process(written(), folder).new == 20


def test_a_sweep_that_would_overflow_the_disk_does_not_start(written, folder, monkeypatch):
    monkeypatch.setattr(store.shutil, "disk_usage", lambda _: SimpleNamespace(free=1000))
    with pytest.raises(InputError, match=r"1 kB free.*expected .* kB for 20 designs"):
        in_this_process(written(), folder)
    assert not list(folder.glob("part-*"))
    assert not (folder / manifest.NAME).exists()


@pytest.mark.parametrize("form", ["parquet", "csv"])
def test_the_estimate_is_no_less_than_what_is_written(written, folder, form, monkeypatch):
    text = SAMPLES.replace("chunk = 4", f'format = "{form}"').replace("= 10\n", "= 2000\n")
    told = []
    refuse = store.Store.refuse_overflow
    monkeypatch.setattr(store.Store, "refuse_overflow",
                        lambda *args, **more: told.append(refuse(*args, **more)))  # fmt: skip
    found = in_this_process(written(text), folder)
    assert found.done == 2000
    assert 0.6 * told[0] < found.bytes <= told[0]


class FullDisk:
    """Room for so many parts."""

    def __init__(self, room):
        self.left = room

    def __call__(self, path, content):
        if self.left == 0:
            raise InputError(f"{str(path)!r}: output file: found No space left on device")
        self.left -= 1
        Path(path).write_bytes(content)


def test_a_full_disk_keeps_what_is_finished(written, folder, monkeypatch, alone):
    with monkeypatch.context() as context:
        context.setattr(store, "write_bytes", FullDisk(2))
        with pytest.raises(InputError, match=r"No space left[^$]*2 of 5 parts are done and kept"):
            in_this_process(written(), folder)
    assert in_this_process(written(), folder).new == 12
    assert_whole(folder, alone)


@pytest.mark.skipif(sys.platform == "win32", reason="no such limit")
def test_a_write_that_fails_halfway_leaves_no_part(written, folder):
    """Files may grow to 8 kB only: the system itself stops the write."""
    code = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); "
        "resource.setrlimit(resource.RLIMIT_FSIZE, (8000, 8000)); "
        "from railride.cli import main; main(sys.argv[1:])"
    )
    study = written(GRID.replace("chunk = 4", "chunk = 400").replace("= 5", "= 500"))
    stopped = process("-c", code, "sweep", study, "--output", folder)
    assert stopped.returncode == 2
    assert "File too large" in stopped.stderr
    assert "0 of 5 parts" in stopped.stderr
    assert "Traceback" not in stopped.stderr
    assert not list(folder.glob("*part*"))
    assert in_this_process(study, folder).new == 2000


# Executors


def test_any_executor_will_do(written, folder, alone):
    with ThreadPoolExecutor(3) as threads:
        found = sweep(written(), folder, executor=threads, workers=3)
        assert threads.submit(int, "3").result() == 3  # it is its owner's to end
    assert found.new == 20
    assert_whole(folder, alone)


class Backwards(Executor):
    """Does the last first, and remembers how many waited at once."""

    def __init__(self):
        self.waiting, self.most, self.whole = [], 0, 0

    def submit(self, fn, /, *args):
        future = Future()
        self.waiting.append((future, fn, args))
        self.most = max(self.most, len(self.waiting))
        if len(self.waiting) == 2:
            future, fn, args = self.waiting.pop()
            future.set_result(fn(*args))
            for other, fn, args in self.waiting:
                other.set_result(fn(*args))
            self.waiting.clear()
        return future if not self.waiting else self.waiting[-1][0]


def test_order_and_number_in_flight_do_not_matter(written, folder, alone):
    backwards = Backwards()
    study = written(GRID.replace("chunk = 4", "chunk = 5"))
    sweep(study, folder, executor=backwards, workers=1)
    assert backwards.most == 2  # never more than two for each worker
    assert_whole(folder, alone)


def test_processes_of_this_machine(written, folder, alone):
    sweep(written(), folder, workers=2)
    assert_whole(folder, alone)


def test_workers_have_one_thread_and_leave_interrupts_alone(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with pool.LocalPool(1) as workers:
        threads = [workers.submit(os.getenv, f"{of}_NUM_THREADS") for of in ("OMP", "MKL")]
        heard = workers.submit(signal.getsignal, signal.SIGINT)
        assert [thread.result() for thread in threads] == ["1", "1"]
        assert heard.result() == signal.SIG_IGN
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ


def landed(deaths, chunks=6):
    def send(executor, chunk):
        return executor.submit(mortal.die, chunk, deaths)

    start = partial(pool.LocalPool, 2)
    flown = flight.Flight(start(), start, send, "chunk {}".format, 4)
    try:
        return sorted(flown.results(range(chunks)))
    finally:
        flown.executor.shutdown(wait=False)


def test_a_dead_worker_costs_nothing(tmp_path):
    for token in ("1-a", "4-a", "4-b"):
        (tmp_path / token).touch()
    assert landed(str(tmp_path)) == [(k, k**2) for k in range(6)]
    assert not list(tmp_path.iterdir())


def test_what_kills_its_workers_is_named(tmp_path):
    for token in "abcdefgh":
        (tmp_path / f"2-{token}").touch()
    with pytest.raises(InputError, match="chunk 2: found that worker after worker died on them"):
        landed(str(tmp_path))


def test_a_sweep_survives_a_killed_worker(written, folder, alone):
    import multiprocessing

    killed = []

    def kill(done, total):
        if not killed and done:
            killed.append(multiprocessing.active_children()[0])
            killed[0].kill()

    found = sweep(written(), folder, workers=2, progress=kill)
    assert killed[0].exitcode == -signal.SIGKILL
    assert found.new == 20
    assert_whole(folder, alone)


# Processes that are ended from outside


def environment():
    return {**os.environ, "PYTHONPATH": str(ROOT / "src"), "PYTHONUNBUFFERED": "1"}


def process(*arguments):
    """Python as a process of its own, to its end."""
    return subprocess.run(  # noqa: S603
        [sys.executable, *map(str, arguments)], env=environment(), capture_output=True,
        encoding="utf-8", timeout=120, check=False,
    )  # fmt: skip


HELD = """
import signal, sys, time
from pathlib import Path
signal.signal(signal.SIGINT, signal.default_int_handler)  # which a shell's background ignores
from railride.cli import main
from railride.sweeps.store import Store

write = Store.write
def then_wait(self, chunk, columns):
    write(self, chunk, columns)
    if len(list(self.folder.glob("part-*"))) == 2:
        print("two", flush=True)
        time.sleep(100)  # until it is ended
Store.write = then_wait
if __name__ == "__main__":
    main(sys.argv[1:])
"""


@pytest.fixture
def held(tmp_path):
    """A sweep of two workers as a process of its own, that waits once two parts are there."""
    running = []

    def start(*arguments):
        script = tmp_path / "held.py"
        script.write_text(HELD)
        command = [sys.executable, str(script), "sweep", *map(str, arguments)]
        found = subprocess.Popen(  # noqa: S603
            command, env=environment(), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            encoding="utf-8", start_new_session=True,
        )  # fmt: skip
        running.append(found)
        assert found.stdout.readline() == "two\n", found.communicate()[1]
        return found

    yield start
    for one in running:
        one.kill()
        one.communicate()


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_kill_9_loses_nothing_that_is_finished(held, written, folder, alone):
    study = written()
    running = held(study, "--output", folder, "--workers", "2")
    workers = children(running.pid)
    assert workers
    with pytest.raises(InputError, match=f"another sweep.*process {running.pid}"):
        in_this_process(study, folder)
    running.kill()
    assert running.wait() == -signal.SIGKILL
    for _ in range(600):  # its workers leave by themselves
        if not any(map(alive, workers)):
            break
        time.sleep(0.1)
    assert not any(map(alive, workers))
    assert in_this_process(study, folder).new == 12
    assert_whole(folder, alone)


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_says_that_the_same_command_goes_on(held, written, folder, alone):
    study = written()
    running = held(study, "--output", folder, "--workers", "2")
    os.killpg(running.pid, signal.SIGINT)  # as a terminal does: to the workers as well
    _, said = running.communicate(timeout=60)
    assert running.returncode == 130
    assert "interrupted: 2 of 5 parts are done and kept" in said
    assert "the same command goes on" in said
    assert said.count("\n") == 1, said
    assert in_this_process(study, folder).new == 12
    assert_whole(folder, alone)


def children(pid):
    """Processes that a process has started."""
    listed = subprocess.run(  # noqa: S603
        ["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False,  # noqa: S607
    ).stdout  # fmt: skip
    return [int(child) for child in listed.split()]


def alive(pid):
    """Whether a process is there and has not ended."""
    try:
        return "\nState:\tZ" not in Path(f"/proc/{pid}/status").read_text()
    except FileNotFoundError:
        return False


# Faults of the study


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        (HEAD, ["sweep.kind: found nothing"]),
        (HEAD + '[sweep]\nkind = "gird"\n', ["sweep.kind: found 'gird'", "did you mean grid?"]),
        (HEAD + '[sweep]\nkind = "grid"\n', ["parameters: found none"]),
        (GRID.replace("points = 5", ""), ["secondary_stiffness.points: found nothing"]),
        (GRID.replace("chunk = 4", "chunk = 0"), ["sweep.chunk: found 0"]),
        (GRID.replace("points = 5", "points = 100_000_000_000_000_000_000"),
         ["secondary_stiffness.points: found 100000000000000000000; expected a whole number"]),
        (GRID + '[parameters.c_1]\nfrom = "0 N s/m"\nto = "1 N s/m"\npoints = 3\nspacing = "log"\n',
         ["parameters.c_1.from: found '0 N s/m'; expected a value above 0 for equal ratios"]),
        (GRID.replace("chunk = 4", 'format = "xml"\nnumber = 3'),
         ["sweep.format: found 'xml'", "sweep.number: found a key"]),
        (GRID + '[parameters.m_c]\ndistribution = "uniform"\nfrom = "34 t"\nto = "40 t"\n',
         ["parameters.m_c: found a distribution; expected from, to and points"]),
        (SAMPLES.replace("number = 10", ""), ["sweep.number: found nothing"]),
        (SAMPLES.replace("number = 10", "number = 0"), ["sweep.number: found 0"]),
        (SAMPLES.replace("latin_hypercube", "sobel"), ["sweep.method", "did you mean sobol?"]),
        (SAMPLES.replace("number = 10", "number = 1_000_000_000"), ["GB"]),
        (SAMPLES + '[parameters.k_2]\nvalues = ["3 N/m"]\n', ["parameters.k_2: found a range"]),
        (HEAD + '[sweep]\nkind = "list"\n', ["sweep.file: found nothing"]),
        (HEAD + '[sweep]\nkind = "list"\nfile = "none.csv"\n', ["sweep.file:", "no such file"]),
        (GRID.replace('"grid"', '"list"\nfile = "x.csv"'), ["parameters.c_2: found a table"]),
    ],
)  # fmt: skip
def test_faulty_sweeps(written, text, parts):
    with pytest.raises(InputError) as caught:
        read_sweep_study(written(text))
    assert all(part in str(caught.value) for part in parts), str(caught.value)


@pytest.mark.parametrize(
    ("content", "parts"),
    [
        ("k_2 [kN/m];k2 [kN/m]\n1;2\n", ["column 'k2 [kN/m]'", "did you mean k_2"]),
        ("k_2 [kN/m],secondary_stiffness [kN/m]\n1,2\n", ["'k_2' again"]),
        ("k_2 [kg],c_2\n1,2\n", ["the unit 'kg'", "no unit"]),
        ("k_2 [kN/m]\n1\nx\n-3\n", ["row 3", "'x'", "row 4", "a positive number"]),
        ("design\n1\n2\n", ["no columns of parameters"]),
    ],
)
def test_faulty_lists(written, tmp_path, content, parts):
    (tmp_path / "designs.csv").write_text(content)
    with pytest.raises(InputError) as caught:
        read_sweep_study(written(HEAD + '[sweep]\nkind = "list"\nfile = "designs.csv"\n'))
    assert all(part in str(caught.value) for part in parts), str(caught.value)


# The picture


def lines_of(ax):
    (line,) = ax.get_lines()
    return line.get_xdata(), line.get_ydata()


def test_a_grid_is_drawn_as_a_map(written, folder, alone):
    found = in_this_process(written(), folder)
    ax = plot_sweep(found)
    assert ax.get_xlabel() == "secondary stiffness [kN/m]"
    assert ax.get_ylabel() == "c_2 [kN s/m]"
    assert CASES[0].removesuffix(" [m/s^2]") in ax.get_title("left")
    mesh = ax.collections[0]
    np.testing.assert_allclose(
        np.ravel(mesh.get_array()), alone.sort_values(["c_2 [N s/m]", "design"])[CASES[0]]
    )
    x = mesh.get_coordinates()[0, :, 0]
    np.testing.assert_allclose(x, [600, 675, 750, 825, 900])
    bar = ax.get_figure().axes[1]
    assert bar.get_ylabel() == "weighted r.m.s. acceleration [m/s²]"


def test_over_one_parameter_every_design_is_drawn(written, folder, alone):
    found = in_this_process(written(), folder)
    x, y = lines_of(plot_sweep(found, over="c_2 [N s/m]", value=CASES[1]))
    ordered = alone.sort_values("c_2 [N s/m]")
    np.testing.assert_allclose(x, ordered["c_2 [N s/m]"] / 1e3)
    assert sorted(y) == sorted(ordered[CASES[1]])
    samples = in_this_process(written(SAMPLES), folder.parent / "samples")
    ax = plot_sweep(samples)
    assert ax.get_xlabel() == "m_c [t]"
    x, _ = lines_of(ax)
    assert list(x) == sorted(x)


def test_samples_over_two_parameters_are_points(written, folder):
    text = SAMPLES + '[parameters.c_2]\ndistribution = "normal"\ndeviation = "5 %"\n'
    ax = plot_sweep(in_this_process(written(text), folder))
    assert len(ax.collections[0].get_offsets()) == 10


@pytest.mark.parametrize(
    ("options", "part"),
    [
        ({"value": "a_rms"}, "'a_rms' asked for"),
        ({"over": "c_1 [N s/m]"}, "expected one of secondary_stiffness"),
        ({"over": ("c_2 [N s/m]",) * 3}, "3 parameters"),
    ],
)
def test_what_cannot_be_drawn(written, folder, options, part):
    found = in_this_process(written(), folder)
    with pytest.raises(InputError, match=re.escape(part)):
        plot_sweep(found, **options)


# Designs without values


def test_designs_that_cannot_be_have_a_reason(written, folder):
    text = GRID + '[parameters.c_1]\nvalues = ["0 N s/m", "30 kN s/m"]\n'
    text = text.replace("points = 5", "points = 2").replace('"60 kN s/m", "70 kN s/m", ', "")
    text = text.replace('["50 kN s/m"', '["0 kN s/m"')  # nothing is damped at all with c_1 = 0
    found = in_this_process(written(text), folder)
    table = found.table()
    bare = (table["c_1 [N s/m]"] == 0) & (table["c_2 [N s/m]"] == 0)
    assert found.problems == bare.sum() == 2
    assert table.loc[bare, CASES].isna().all().all()
    assert table.loc[~bare, CASES].notna().all().all()
    assert (table["problem"] != "").tolist() == bare.tolist()
    first = int(table.loc[bare, "design"].iloc[0])
    assert any("2 designs lack values" in said and f"design {first}: " in said
               for said in found.remarks)  # fmt: skip
    assert set(found.best[CASES[0]]["design"]) <= set(table.loc[~bare, "design"])


def test_the_best_have_values(written, folder, run):
    text = GRID.replace('["50 kN s/m", "60 kN s/m", "70 kN s/m", "80 kN s/m"]',
                        '["70 kN s/m", "1e20 N s/m"]')  # fmt: skip
    text = text.replace("points = 5", "points = 2").replace("chunk = 4", 'format = "csv"')
    path = written(text)
    code, out, _ = run("sweep", path, "--output", folder)
    assert code == 0
    assert "\n1 CSV part of" in out
    assert "nan" not in out
    found = read_sweep(folder)
    assert found.problems == 2
    for case in CASES:
        assert found.best[case]["design"].tolist() in ([1, 3], [3, 1])


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"study": 3}, "3"),
        ({"study": None}, "None"),
        ({"folder": None}, "None"),
        ({"workers": "x"}, "workers: found 'x'; expected a whole number, at least 1"),
        ({"workers": 1.5}, "workers: found 1.5"),
        ({"workers": True}, "workers: found True"),
        ({"workers": 0}, "workers: found 0"),
        ({"scheduler": 3}, "--scheduler 3: found no answer"),
    ],
)
def test_what_is_no_sweep(written, folder, asked, said):
    given = {"study": written(), "folder": folder} | asked
    with pytest.raises(InputError, match=re.escape(said)):
        sweep(**given)
    assert not folder.exists()


def test_columns_that_are_none(written, folder):
    found = in_this_process(written(), folder)
    with pytest.raises(InputError, match="columns: found 'nope'; expected some of 'design', "):
        found.table(["nope"])
    with pytest.raises(InputError, match="columns: found 3"):
        found.table(3)
    assert list(found.table([CASES[0]])) == [CASES[0]]
    with pytest.raises(InputError, match="folder: found 3"):
        read_sweep(3)


def test_every_result_has_its_columns_whichever_design_comes_first(written, folder, tmp_path):
    asked = '[ride]\nresults = ["a_wrms", "a_rms", "wz", "travel", "modes", "static"]'
    text = GRID.replace("[ride]", asked)
    good = in_this_process(written(text), folder)
    bare = text.replace('["50 kN s/m"', '["0 kN s/m"') + '[parameters.c_1]\nvalues = ["0 N s/m"]\n'
    bad = in_this_process(written(bare), tmp_path / "bad")
    assert bad.problems
    assert bad.columns == good.columns
    table = good.table()
    assert table.iloc[:, 3:-1].notna().all().all()
    coach = derive_vehicle("cati2024", 1)
    row = table.iloc[5]
    changed = coach.changed(k_2=row["secondary_stiffness [N/m]"], c_2=row["c_2 [N s/m]"])
    found = sorted(row[name] for name in table if name.endswith("natural frequency [Hz]"))
    assert found == pytest.approx(sorted(m.frequency_hz for m in modes(changed)), rel=1e-9)


# The command


def test_the_command_tells_where_and_how_many_and_the_best(run, written, folder, alone):
    arguments = ("sweep", written(), "--output", folder)
    code, out, _ = run(*arguments, "--format", "json", "--plot", folder.parent / "sweep.png")
    assert code == 0
    told = json.loads(out)
    documented = (ROOT / "docs" / "study-files.md").read_text(encoding="utf-8")
    assert all(f"`{key}`" in documented for key in told)
    assert told["designs"] == told["done"] == told["new"] == 20
    assert told["problems"] == 0
    assert told["parts"] == 5
    assert told["bytes"] == sum(p.stat().st_size for p in folder.glob("part-*"))
    assert told["columns"] == [*CASES, "error", "problem"]
    for case, best in zip(CASES, told["best"], strict=True):
        assert best["case"] == case
        expected = alone.sort_values(case).head(5)
        assert [row["design"] for row in best["designs"]] == expected["design"].tolist()
        assert [row[case] for row in best["designs"]] == expected[case].tolist()
    assert (folder.parent / "sweep.png").read_bytes().startswith(b"\x89PNG")
    code, out, _ = run(*arguments, "--format", "csv")
    assert len(out.splitlines()) == 11
    code, out, _ = run(*arguments)
    assert "20 of 20 designs done, 0 now" in out
    assert "5 Parquet parts" in out


@pytest.mark.parametrize(
    ("arguments", "part"),
    [
        (["--workers", "0"], "a whole number from 1"),
        (["--workers", "2", "--scheduler", "tcp://x:1"], "--scheduler with it"),
        (["--plot", "x.txt"], ".png"),
    ],
)
def test_faulty_commands(run, written, folder, arguments, part):
    code, out, err = run("sweep", written(), "--output", folder, *arguments)
    assert (code, out) == (2, "")
    assert part in err


def test_a_command_without_a_study_that_is_there(run, tmp_path):
    code, _, err = run("sweep", tmp_path / "none.toml", "--output", tmp_path / "x")
    assert code == 2
    assert "neither a shipped study nor a file" in err


def test_no_folder_of_a_sweep(tmp_path):
    with pytest.raises(InputError, match="found no sweep"):
        read_sweep(tmp_path)
