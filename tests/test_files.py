"""Files are written whole or not at all, through links and into streams."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from railride import files
from railride.errors import InputError
from railride.files import write_bytes, write_text


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_text_is_utf8_with_line_feeds(tmp_path):
    write_text(tmp_path / "a.txt", "θ\n")
    assert (tmp_path / "a.txt").read_bytes() == b"\xce\xb8\n"


def test_file_behind_a_link_is_replaced_and_the_link_stays(tmp_path):
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder/real").write_bytes(b"old")
    (tmp_path / "middle").symlink_to("folder/real")
    (tmp_path / "link").symlink_to(tmp_path / "middle")
    write_bytes(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "middle").is_symlink()
    assert (tmp_path / "folder/real").read_bytes() == b"new"


def test_link_to_a_file_that_is_not_there_yet_makes_it(tmp_path):
    (tmp_path / "link").symlink_to("new")
    write_bytes(tmp_path / "link", b"x")
    assert (tmp_path / "new").read_bytes() == b"x"


def test_links_in_a_circle_are_refused(tmp_path):
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    with pytest.raises(InputError, match="links"):
        write_bytes(tmp_path / "a", b"x")


def test_pipe_is_written_to_and_stays(tmp_path):
    pipe, read = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()))
    reader.start()
    write_bytes(pipe, b"through")
    reader.join()
    assert read == [b"through"]
    assert pipe.is_fifo()


@pytest.mark.parametrize("redirected", [True, False])
def test_standard_output_is_written_to(tmp_path, redirected):
    code = "from railride.files import write_bytes; write_bytes('/dev/stdout', b'out')"
    with (tmp_path / "out").open("wb") as out:
        done = subprocess.run(  # noqa: S603
            [sys.executable, "-c", code],
            check=True,
            stdout=out if redirected else subprocess.PIPE,
        )
    assert ((tmp_path / "out").read_bytes() if redirected else done.stdout) == b"out"
    assert names(tmp_path) == ["out"]


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, MemoryError])
def test_interrupted_write_leaves_the_old_file_and_nothing_else(
    tmp_path, monkeypatch, interruption
):
    def stop(target):
        raise interruption

    (tmp_path / "a").write_bytes(b"old")
    monkeypatch.setattr(files, "_usual_permissions", stop)
    with pytest.raises(interruption):
        write_bytes(tmp_path / "a", b"new")
    assert names(tmp_path) == ["a"]
    assert (tmp_path / "a").read_bytes() == b"old"


def test_permissions_are_those_of_any_new_file_or_of_the_old_one(tmp_path):
    before = os.umask(0o027)
    try:
        write_bytes(tmp_path / "new", b"x")
    finally:
        os.umask(before)
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o640
    (tmp_path / "new").chmod(0o604)
    write_bytes(tmp_path / "new", b"y")
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o604


@pytest.mark.parametrize("name", [".", "nowhere/a.txt", "a\0b", "x" * 300])
def test_what_cannot_be_written_is_said(tmp_path, name):
    with pytest.raises(InputError, match="expected a file that can be written"):
        write_text(tmp_path / name, "x")
    assert names(tmp_path) == []


def test_full_disk_is_said():
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    with pytest.raises(InputError, match="No space left"):
        write_bytes("/dev/full", b"x")
