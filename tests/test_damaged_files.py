"""A sample of the cases of ``damaged_files.py``, and that their judge sees what is wrong."""

from __future__ import annotations

from dataclasses import replace

import damaged_files
import pytest
from damage_cases import KEPT, Outcome, case, run_here
from damage_faults import faults
from damage_sources import sources


@pytest.mark.parametrize("block", range(3))
def test_a_damaged_file_ends_in_a_result_or_in_one_message(block):
    for index in range(16 * block, 16 * block + 16):
        one = case(0, index)
        found = run_here(one.command, one.files)
        assert faults(one, found) == [], (index, one.line, one.damage, found.err[-1000:])


def test_cases_are_of_every_kind_and_depend_on_seed_and_index_alone():
    cases = [case(5, index) for index in range(60)]
    assert {one.source.kind for one in cases} == {"vehicle", "study", "track"}
    assert [(c.files, c.line) for c in cases] == [(case(5, c.index).files, c.line) for c in cases]
    assert any(one.same for one in cases)
    whole = [c.files[name] == text.encode() for c in cases for name, text in c.source.files.items()]
    assert 0.2 < whole.count(False) / len(cases) <= 1


SOUND = Outcome(0, '{"a_wrms": 0.25, "standard_error": null}\n', "", {}, 0.1)
REFUSED = Outcome(2, "", "railride: line.csv: row 3: found 'x'; expected a number\n", {}, 0.1)


def judged(found, *words, same=False, output=None, kept=False):
    """The faults of an outcome of one command, whose files are as they were."""
    source = next(source for source in sources() if source.kind == "track")
    files = {name: text.encode() for name, text in source.files.items()}
    files |= {output: KEPT.encode()} if kept else {}
    command = ("track", "line.csv", *words)
    one = replace(case(5, 0), source=source, command=command, files=files, same=same, output=output)
    return faults(one, replace(found, left=files | found.left))


def test_what_is_sound_has_no_faults():
    assert judged(SOUND, "--format", "json") == []
    assert judged(REFUSED, output="out.txt") == []
    assert judged(REFUSED, output="out.txt", kept=True) == []
    assert judged(replace(SOUND, out="a_wrms 0.25  Fernando's influence\n")) == []


@pytest.mark.parametrize(
    ("found", "given", "said"),
    [
        (replace(SOUND, code=1), {}, "exit code 1"),
        (replace(REFUSED, err=REFUSED.err + "Traceback (most recent call last)"), {}, "traceback"),
        (REFUSED, {"same": True}, "nothing has changed"),
        (replace(REFUSED, out="half a table"), {}, "standard output"),
        (replace(REFUSED, err="railride: line.csv: there is something wrong"), {}, "'found'"),
        (replace(REFUSED, err="Error: found a fault; expected none at all"), {}, "no message"),
        (replace(REFUSED, left={"out.txt": b"half"}), {"output": "out.txt"}, "wrote out.txt"),
        (replace(REFUSED, left={"out.txt": b"half"}), {"output": "out.txt", "kept": True},
         "overwrote"),
        (replace(SOUND, left={".out.txt.k3x": b"half"}), {}, "nobody asked for"),
        (replace(SOUND, left={"line.csv": b""}), {}, "changed what it read"),
        (replace(SOUND, out="  a_wrms  nan\n"), {}, "nan in the result"),
        (replace(SOUND, out="  a_wrms  -inf\n"), {}, "-inf in the result"),
        (replace(SOUND, out=""), {}, "no result"),
    ],
)  # fmt: skip
def test_the_judge_sees_what_is_wrong(found, given, said):
    assert any(said in fault for fault in judged(found, **given))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('{"a_wrms": NaN}', "NaN"),
        ('{"a_wrms": -Infinity}', "-Infinity"),
        ('{"cases": [{"a_wrms": null}]}', "null for a_wrms"),
        ('{"a_wrms": 0.25', "JSON"),
    ],
)
def test_the_judge_reads_json(text, said):
    assert any(said in fault for fault in judged(replace(SOUND, out=text), "--format", "json"))


def test_the_judge_compares_what_must_be_the_same():
    words = ("--format", "json")
    good = run_here(("track", "line.csv", *words),
                    {"line.csv": sources()[-1].files["line.csv"].encode()})  # fmt: skip
    source = next(source for source in sources() if source.kind == "track")
    true = run_here(("track", "line.csv", *words), {"line.csv": source.files["line.csv"].encode()})
    assert judged(true, *words, same=True) == []
    assert judged(good, *words, same=True) != []  # the numbers of another track


def test_what_fails_is_kept_with_the_way_to_try_it_again(monkeypatch, capsys, tmp_path):
    broken = Outcome(1, "", "Traceback: ...", {}, 0.1)
    monkeypatch.setattr(damaged_files, "run_here", lambda *_: broken)
    arguments = ["", "--seed", "7", "--from", "11", "--count", "2", "--keep", str(tmp_path)]
    monkeypatch.setattr("sys.argv", arguments)
    with pytest.raises(SystemExit) as stopped:
        damaged_files.main()
    assert stopped.value.code == 1
    assert "11: exit code 1; a traceback" in capsys.readouterr().out
    told = (tmp_path / "7-11" / "what.txt").read_text(encoding="utf-8")
    assert "python tests/damaged_files.py --seed 7 --from 11 --count 1" in told
    for name, content in case(7, 11).files.items():
        assert (tmp_path / "7-11" / name).read_bytes() == content
    assert sorted(folder.name for folder in tmp_path.iterdir()) == ["7-11", "7-12"]
