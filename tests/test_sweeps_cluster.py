"""Sweeps on a real Dask cluster: a scheduler and two workers, processes on the loopback."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from concurrent.futures import Future
from pathlib import Path
from types import SimpleNamespace

import pandas as pd
import pytest

from railride import InputError, sweep
from railride.sweeps import cluster, flight, pool

Client = pytest.importorskip("distributed").Client
KilledWorker = pytest.importorskip("distributed").KilledWorker
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")

ROOT = Path(__file__).resolve().parents[1]
STUDY = """
vehicle = "cati2024"
[body]
segments = 1
[ride]
speeds = ["145 km/h"]
[sweep]
kind = "grid"
chunk = 2
[parameters.k_2]
from = "600 kN/m"
to = "900 kN/m"
points = 24
"""


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    return path


@pytest.fixture
def dask(tmp_path):
    """Start the scheduler, or a worker of it, as a process; all are ended after the test."""
    running = []
    file = tmp_path / "scheduler.json"
    usual = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "OMP_NUM_THREADS": "1"}

    def start(what, *options, **more):
        command = [sys.executable, "-m", f"distributed.cli.dask_{what}", "--scheduler-file",
                   str(file), "--no-dashboard", *options]  # fmt: skip
        log = (tmp_path / f"{what}{len(running)}.log").open("w")
        with log:
            running.append(
                subprocess.Popen(command, env=usual | more, stdout=log, stderr=log, cwd=tmp_path)  # noqa: S603
            )
        return running[-1]

    def scheduler(**more):
        start("scheduler", "--host", "127.0.0.1", "--port", "0", **more)
        while not file.exists() or not file.read_text().strip().endswith("}"):
            assert running[0].poll() is None, (tmp_path / "scheduler0.log").read_text()
            time.sleep(0.05)
        return json.loads(file.read_text())["address"]

    def worker(**more):
        return start("worker", "--no-nanny", "--nthreads", "1", "--host", "127.0.0.1",
                     "--local-directory", str(tmp_path), **more)  # fmt: skip

    start.scheduler, start.worker, start.running = scheduler, worker, running
    yield start
    for one in reversed(running):
        one.kill()
        one.wait()


def test_a_cluster_that_loses_a_worker_gives_what_one_process_gives(dask, study, tmp_path):
    address = dask.scheduler()
    lost, _ = dask.worker(), dask.worker()
    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(2)
    seen = []

    def hit(done, total):
        seen.append(done)
        if len(seen) == 2:  # the first part is there: it goes no further with what it has
            lost.send_signal(signal.SIGSTOP)
        if done == total // 2:
            lost.kill()

    found = sweep(study, tmp_path / "cluster", scheduler=address, progress=hit)
    assert lost.wait() == -signal.SIGKILL
    assert seen == list(range(0, 25, 2))
    alone = sweep(study, tmp_path / "alone", executor=pool.InProcess())
    pd.testing.assert_frame_equal(found.table(), alone.table(), check_exact=True)


def test_the_command_runs_on_a_cluster(dask, study, tmp_path, run):
    address = dask.scheduler()
    dask.worker()
    code, out, err = run("sweep", study, "--output", tmp_path / "out", "--scheduler", address,
                         "--format", "json")  # fmt: skip
    assert code == 0, err
    assert json.loads(out)["new"] == 24


def test_what_kills_workers_of_a_cluster_is_named():
    killed = Future()
    killed.set_exception(KilledWorker("evaluate-1", None, 3))
    flown = flight.Flight(pool.InProcess(), None, lambda *_: killed, str, 1)
    with pytest.raises(InputError, match="7: found that worker after worker died"):
        list(flown.results([7]))


@pytest.fixture
def without(tmp_path):
    """The environment of a process that has no railride, though one is installed behind."""
    source = tmp_path / "source"
    source.mkdir()
    missing = "raise ModuleNotFoundError(\"No module named 'railride'\")"
    (source / "railride.py").write_text(missing, encoding="utf-8")  # found before any other
    return {"PYTHONPATH": os.pathsep.join([str(source), str(ROOT / "src")])}


def test_a_cluster_with_another_version_of_the_program(dask, study, tmp_path, monkeypatch):
    address = dask.scheduler()
    monkeypatch.setattr(cluster, "__version__", "9.9")
    dask.worker()
    with pytest.raises(InputError, match=r"found railride 0\.1\.0 on tcp"):
        sweep(study, tmp_path / "out", scheduler=address)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("where", ["scheduler", "worker", "one of two workers"])
def test_a_cluster_without_the_program(dask, study, tmp_path, where, without):
    address = dask.scheduler(**without if where == "scheduler" else {})
    dask.worker(**without if where != "scheduler" else {})
    if where == "one of two workers":
        dask.worker()
        with Client(address, set_as_default=False) as client:
            client.wait_for_workers(2)
    with pytest.raises(InputError, match="cannot run railride") as caught:
        sweep(study, tmp_path / "out", scheduler=address)
    assert where == "scheduler" or "No module named 'railride" in str(caught.value)
    assert not (tmp_path / "out").exists()


def test_a_sweep_does_not_wait_for_ever_for_workers(dask, study, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "ALONE", 0.5)
    monkeypatch.setattr(flight, "LOOK", 0.1)
    address = dask.scheduler()
    lost = dask.worker()

    def end(done, total):
        if done == total // 2:
            lost.kill()

    with pytest.raises(InputError) as caught:
        sweep(study, tmp_path / "out", scheduler=address, progress=end)
    said, kept = str(caught.value).splitlines()
    assert "found no worker for 0.5 s" in said
    assert "parts are done and kept" in kept
    dask.worker()
    assert sweep(study, tmp_path / "out", scheduler=address).done == 24


def test_a_worker_that_comes_back_is_waited_for(monkeypatch):
    """None at 0 and 50 s, one at 100 s, none at 150 and 200 s: never 60 s without. Then, yes."""
    numbers = iter([{}, {}, {"tcp": 1}, {}, {}, {}])
    times = iter([0.0, 50.0, 150.0, 200.0, 210.0])
    client = SimpleNamespace(nthreads=lambda: next(numbers))
    monkeypatch.setattr(cluster, "time", SimpleNamespace(monotonic=lambda: next(times)))
    watch = cluster._Watch(client, "--scheduler")
    for _ in range(5):
        watch.check()
    with pytest.raises(InputError, match="found no worker for 60 s"):
        watch.check()


def test_a_scheduler_that_ends_keeps_what_is_done(dask, study, tmp_path):
    address = dask.scheduler()
    dask.worker()

    def end(done, total):
        if done == total // 2:
            dask.running[0].kill()

    with pytest.raises(InputError) as caught:
        sweep(study, tmp_path / "out", scheduler=address, progress=end)
    assert "parts are done and kept" in str(caught.value)


def test_a_scheduler_that_is_not_there_is_one_message(study, tmp_path, run, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    with socket.socket() as deaf:
        deaf.bind(("127.0.0.1", 0))
        port = deaf.getsockname()[1]
        for _ in range(2):  # nobody there; then somebody who does not answer
            arguments = ("sweep", study, "--output", tmp_path / "out", "--scheduler",
                         f"tcp://127.0.0.1:{port}")  # fmt: skip
            code, out, err = run(*arguments)
            assert (code, out) == (2, "")
            assert f"--scheduler 'tcp://127.0.0.1:{port}': found no answer" in err
            assert "Traceback" not in err
            deaf.listen()


@pytest.mark.parametrize("address", ["", "nonsense", "tcp://127.0.0.1:x", "ftp://127.0.0.1:3"])
def test_addresses_that_are_none(study, tmp_path, address, monkeypatch):
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    with pytest.raises(InputError, match="--scheduler"):
        sweep(study, tmp_path / "out", scheduler=address)


def test_a_scheduler_without_workers_is_one_message(dask, study, tmp_path, monkeypatch):
    address = dask.scheduler()
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    with pytest.raises(InputError, match="a scheduler without workers"):
        sweep(study, tmp_path / "out", scheduler=address)


def test_dask_is_named_where_it_is_missing(study, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"railride\[distributed\]"):
        sweep(study, tmp_path / "out", scheduler="tcp://127.0.0.1:8786")
