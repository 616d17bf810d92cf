"""Tables: every dialect and format that is promised, every fault by row, every bit of a number."""

from __future__ import annotations

import re
import sys

import h5py
import numpy as np
import pandas as pd
import pytest
from scipy.io import savemat, wavfile

from railride.errors import InputError
from railride.tables import is_missing, read_table, split_heading
from railride.tables import text as text_module

BODY = "0,0.1,-5\n1,0.2,3\n2,0.3,4\n"
GOOD = "t,x,z\n" + BODY


def decimal_comma(sep, header="t,x,z\n"):
    return header.replace(",", sep) + BODY.replace(",", sep).replace(".", ",")


@pytest.fixture
def read(tmp_path):
    """Read a file of the given content."""

    def reader(content, name="ride.csv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_table(path)

    return reader


@pytest.fixture
def fault(read):
    """Read a file that is wrong and give the message, which names the file in each line."""

    def reader(content, name="ride.csv"):
        with pytest.raises(InputError) as caught:
            read(content, name)
        message = str(caught.value)
        assert all(f"{name}: " in line for line in message.split("\n"))
        return message

    return reader


DIALECTS = {
    "plain": (GOOD, 2),
    "no line end": (GOOD.rstrip("\n"), 2),
    "CRLF": (GOOD.replace("\n", "\r\n"), 2),
    "CR": (GOOD.replace("\n", "\r"), 2),
    "DOS end of file": (GOOD + "\x1a", 2),
    "byte order mark": ("\ufeff" + GOOD, 2),
    "UTF-16 LE": (b"\xff\xfe" + GOOD.encode("utf-16-le"), 2),
    "UTF-16 BE": (b"\xfe\xff" + GOOD.encode("utf-16-be"), 2),
    "semicolon": (GOOD.replace(",", ";"), 2),
    "decimal comma": (decimal_comma(";"), 2),
    "tab, decimal comma": (decimal_comma("\t"), 2),
    "quoted decimal comma": (
        't,x,z\n0,"0,1",-5\n1,"0,2",3\n2,"0,3",4\n',
        2,
    ),
    "blanks, decimal comma": (decimal_comma("  "), 2),
    "fixed width": ("   t    x   z\n   0  0.1  -5\n   1  0.2   3\n   2  0.3   4\n", 2),
    "padded": ("t , x , z \n" + BODY.replace(",", " , "), 2),
    "numpy's": ("# t x z\n" + BODY.replace(",", " "), 2),
    "comments": ("# made by hand\n% so\n// and so\n\n" + GOOD + "# end\n", 6),
    "metadata": ('"Running Date","22/11/2022"\nRows,12\nSpeed,km/h,x,80\n' + GOOD, 5),
    "metadata of the same width": ('"Date","22/11/2022","b"\n' + GOOD, 3),
    "quotes": ('"t","x",z\n' + BODY.replace("0.2", '"0.2"').replace("-5", '"-5" '), 2),
    "trailing separators": ("t,x,z,\n" + BODY.replace("\n", ",\n") + ",,,\n", 2),
    "below the header only": (GOOD[:6] + BODY.replace("\n", ",,\n") + ",,\n\n", 2),
    "empty rows at the end": (GOOD + ",,\n , , \n\n", 2),
    "LabVIEW": ("LabVIEW\t\n***End***\t\nt\tx\tz\tComment\n" + BODY.replace(",", "\t"), 4),
    "signs and exponents": ("t,x,z\n+0,.1,-5.\n1e0,2E-1,+3\n20.0e-1,0.3,4\n", 2),
}


@pytest.mark.parametrize("name", DIALECTS)
def test_dialects(read, name):
    content, first = DIALECTS[name]
    table = read(content)
    assert [c.heading for c in table.columns] == ["t", "x", "z"]
    assert [c.numbers.tolist() for c in table.columns] == [[0, 1, 2], [0.1, 0.2, 0.3], [-5, 3, 4]]
    assert (table.n, table.row(0), table.rate, table.remarks) == (3, first, None, ())
    assert table.where(0, table.columns[2]) == f"row {first}, column 'z'"


TEXTS = {  # the cells of three rows before the only number of each
    "date and time": ["2024-01-31", "12:00:00.010"],
    "name of a line": ["A1", "12+900.25"],
    "name with a blank": ["Oxford north", "12:00:00"],
    "name with a number": ["Line 5", "12+900.25"],
    "time of twelve hours": ["01/31/2024 12:00:00.010 PM"],
    "date and time in one": ["2024-01-31 12:00:00.010"],
    "time with its zone": ["2024-01-31T12:00:00.010+01:00"],
    "three names": ["A", "B", "C"],
}


@pytest.mark.parametrize("separator", [",", ";", "\t"])
@pytest.mark.parametrize("name", TEXTS)
def test_more_cells_of_text_than_numbers(read, name, separator):
    texts = TEXTS[name]
    rows = [[*(f"h{j}" for j in range(len(texts))), "z"]] + [[*texts, z] for z in ("0.5", "-1")]
    table = read("".join(separator.join(row) + "\n" for row in rows))
    assert [c.heading for c in table.columns] == rows[0]
    assert table.column("z").numbers.tolist() == [0.5, -1.0]
    assert [list(c.cells) for c in table.columns[:-1]] == [[text] * 2 for text in texts]


@pytest.mark.parametrize("text", ["A1", "12+900.25", "2024-01-31", "31.01.2024 12:00:00,010"])
def test_decimal_commas_beside_a_text(read, text):
    table = read(f"a;y;z\n{text};0,5;2,5\n{text};-1,5;3,5\n")
    assert table.column("y").numbers.tolist() == [0.5, -1.5]
    assert list(table.column("a").cells) == [text] * 2


def test_a_line_of_units_below_the_header(read):
    table = read(
        "Time;ACC x;ACC z;n\ns;m/s2;[g];-\n" + BODY.replace(",", ";").replace("\n", ";0\n")
    )
    assert [(c.name, c.unit) for c in table.columns] == [
        ("Time", "s"),
        ("ACC x", "m/s2"),
        ("ACC z", "g"),
        ("n", "-"),
    ]
    assert table.row(0) == 3


def test_without_header_columns_are_numbered_with_a_remark(read):
    table = read(BODY)
    assert [c.heading for c in table.columns] == ["1", "2", "3"]
    assert "no header" in table.remarks[0]
    assert table.row(0) == 1


def test_one_column(read):
    assert read("z\n0.1\n0.2\n").columns[0].numbers.tolist() == [0.1, 0.2]
    assert read("z\n0,1\n0,02\n").columns[0].numbers.tolist() == [0.1, 0.02]
    blank = read("z\n0.1\n\n0.2\n\n").columns[0]
    assert blank.bad.tolist() == [1]
    assert blank.cells == ["0.1", "", "0.2"]


def test_rows_are_lines_of_the_file(read):
    table = read("# a\n\nt,x,z\n0,1,2\n# b\n\n1,1,2\n2,,2\n")
    assert table.rows.tolist() == [4, 7, 8]
    assert table.where(2, table.column("x")) == "row 8, column 'x'"


def test_cells_that_are_no_numbers_are_kept_as_they_stand(read):
    cells = ["1.5", "", "NaN", "inv", "-inf", "1e999", "1_000", "0x10", "1d5", "True", "1,5", "٣"]
    table = read("t;x\n" + "".join(f'{j};"{cell}"\n' for j, cell in enumerate(cells)))
    column = table.column("x")
    assert column.numbers[0] == 1.5
    assert column.bad.tolist() == list(range(1, len(cells)))
    assert list(column.cells) == cells
    assert [is_missing(cell) for cell in cells[:5]] == [False, True, True, True, False]
    assert column.shown(3) == "'inv'"
    assert column.shown(1) == "a blank cell"
    assert len(column.shown(0)) < 50


def test_a_rarer_decimal_mark_is_no_number(read):
    column = read("t;z\n1;0,1\n2;0,2\n3;0.3\n4;1.234,5\n").column("z")
    assert column.bad.tolist() == [2, 3]
    assert column.numbers[:2].tolist() == [0.1, 0.2]


def test_time_stamps_in_nanoseconds_keep_every_digit(read):
    stamps = [1706120587153000700 + 19546600 * k for k in range(5)]
    column = read("time,z\n" + "".join(f"{t},1\n" for t in stamps)).column("time")
    assert column.numbers.dtype == np.int64
    assert column.numbers.tolist() == stamps


def any_floats(n, seed):
    bits = np.random.default_rng(seed).integers(0, 2**64, n, dtype=np.uint64)
    values = bits.view(np.float64)
    return values[np.isfinite(values)]


@pytest.mark.parametrize("comma", [False, True])
def test_numbers_read_back_to_the_last_bit(read, monkeypatch, comma):
    monkeypatch.setattr(text_module, "_BLOCK", 700)
    values = any_floats(5000, 1)
    text = "x;y\n" + "".join(
        f"{v!r};{w:.17e}\n" for v, w in zip(values.tolist(), values, strict=True)
    )
    table = read(text.replace(".", ",") if comma else text)
    for column in table.columns:
        assert np.array_equal(column.numbers.view(np.uint64), values.view(np.uint64))


def test_numbers_beside_a_text_read_back_to_the_last_bit(read, monkeypatch):
    """The careful way, cell by cell, reads as the quick one."""
    monkeypatch.setattr(text_module, "_BLOCK", 700)
    values = any_floats(2000, 2)
    column = read("x,y\nabc,1\n" + "".join(f"{v!r},1\n" for v in values.tolist())).column("x")
    assert column.bad.tolist() == [0]
    assert np.array_equal(column.numbers[1:].view(np.uint64), values.view(np.uint64))


def test_older_pandas_is_told_to_read_to_the_last_bit():
    assert text_module.exactly("2.2.3") == {"float_precision": "round_trip"}
    assert text_module.exactly("3.0.1") == {"float_precision": "round_trip"}
    assert text_module.exactly("3.1.1") == {}


def test_blocks_join_without_a_seam(read, monkeypatch):
    whole = "t,z,s\n" + "".join(f"{j},{j / 7!r},{'a' if j % 40 == 7 else j}\n" for j in range(100))
    expected = read(whole)
    for block in (1, 3, 50, 99, 100):
        monkeypatch.setattr(text_module, "_BLOCK", block)
        table = read(whole)
        for got, want in zip(table.columns, expected.columns, strict=True):
            assert np.array_equal(got.numbers, want.numbers, equal_nan=True)
            assert got.numbers.dtype == want.numbers.dtype
            assert list(got.cells) == list(want.cells)


WRONG = [
    ("", "file: found an empty file"),
    (" \n\r\n", "an empty file"),
    ("\ufeff", "an empty file"),
    ("# nothing\n", "comments and blank lines only"),
    ("a,b\nc,d\n", "row 1 and below: found no row of numbers"),
    (GOOD + "3,0.2\n", "row 5: found 2 cells; expected 3 as in the header"),
    (GOOD + "3\n", "row 5: found 1 cells"),
    (GOOD + "0,5,0,2\n", "row 5: found 4 cells; .*decimal commas"),
    (GOOD + "0,5,0,2,0,7,1,2,3,4,5\n", "row 5: found 11 cells; .*decimal commas"),
    (BODY + "3,0.2\n", "row 4: found 2 cells; expected 3 as elsewhere"),
    ("t,x,z\n0,1\n" + BODY, "row 2: found 2 cells"),
    ("t,x,z\n0,0,0,1,0,5\n1,0,0,2,0,3\n", "row 1: found 3 cells in the header; .*decimal commas"),
    ("t;x\n0;1;2\n1;3;4\n", "row 1: found 2 cells in the header; expected 3, as many as in row 2"),
    ("0,10\n0,02\n0,30\n", "row 1: found whole numbers that look like .* decimal commas"),
    (GOOD + '3,"0.5,5\n4,0.5,6\n', "row 5: found a quote that is not closed"),
    (GOOD + '3,"0.5"x,5\n', "row 5: found a quote that is not closed"),
    ('"t,x,z\n' + BODY, "row 1: found a quote that is not closed"),
    (GOOD.encode() + b"3,0.5,\0\0", "row 5, byte .* a zero byte"),
    (GOOD.encode() + b"3,0.5\x07,5\n", "row 5, byte .* control character 0x07"),
    (GOOD.encode("utf-16-le"), "UTF-16 without a byte order mark"),
    (b"\xff\xfe" + GOOD.encode("utf-16-le")[:-1], "a mark of UTF-16 but"),
    ("t,x,é\n".encode() + BODY.encode() + b"3,\xff,5\n", "row 5, byte .* 0xff, which is not UTF-8"),
    (b"t,x,\x8d\n" + BODY.encode(), "row 1, byte 4 .* 0x8d, which is not UTF-8"),
    (b"PK\x03\x04rest", "an Excel workbook"),
    (b"MDF     4.10", "MDF"),
]


@pytest.mark.parametrize(("content", "message"), WRONG, ids=range(len(WRONG)))
def test_a_fault_is_named_by_row(fault, content, message):
    found = fault(content)
    assert re.search(message, found), found


def test_many_faults_are_cut_at_ten_and_counted(fault, monkeypatch):
    monkeypatch.setattr(text_module, "_BLOCK", 30)
    message = fault("t,x,z\n" + BODY * 40 + "1,2\n" * 35)
    assert len(message.split("\n")) == 11
    assert "row 122: " in message
    assert "other rows: found 25 more such faults" in message


def test_windows_1252_is_read_with_a_remark(read):
    table = read("t,x,Höhe [µm]\n".encode("cp1252") + BODY.encode())
    assert table.columns[2].heading == "Höhe [µm]"
    assert table.columns[2].unit == "µm"
    assert "Windows-1252 ('t,x,Höhe' in row 1)" in table.remarks[0]


def test_what_is_not_a_file_is_a_fault(tmp_path):
    with pytest.raises(InputError, match="a folder"):
        read_table(tmp_path)
    with pytest.raises(InputError, match=r"no such file.*check the path"):
        read_table(tmp_path / "missing.csv")
    with pytest.raises(InputError):
        read_table(str(tmp_path / "a\0b.csv"))


def test_a_very_long_name_of_a_file_is_cut(tmp_path):
    with pytest.raises(InputError, match="File name too long") as caught:
        read_table(tmp_path / ("9" * 20_000 + "modes.csv"))
    assert "9modes.csv: " in str(caught.value)
    assert len(str(caught.value)) < 1000


def test_a_very_long_heading_is_cut(read):
    table = read("x," + "_" * 20_000 + "y\n" + "1,2\n" * 5)
    assert table.columns[1].heading == "_" * 200 + "…"


def test_columns_are_found_by_heading_and_by_name(read):
    table = read("Time (s),acc_z [g],Speed,speed\n1,2,3,4\n1,2,3,4\n")
    assert table.column("acc_z [g]") is table.column("Acc Z") is table.columns[1]
    assert table.column("speed") is table.columns[3]
    assert table.find("time", "speed") == (table.columns[0], *table.columns[2:])
    with pytest.raises(
        InputError, match=r"no such column; expected one of 'Time .*'acc_z \[g\]'\?"
    ):
        table.column("acc z1")
    with pytest.raises(InputError, match="2 columns of that name"):
        table.column("SPEED")


@pytest.mark.parametrize(
    ("heading", "name", "unit"),
    [
        ("level_mm", "level", "mm"),
        ("level [mm]", "level", "mm"),
        ("level (mm)", "level", "mm"),
        ("z [m/s²]", "z", "m/s²"),
        ("acc_z (g)", "acc_z", "g"),
        ("a_z in m/s^2", "a_z", "m/s^2"),
        ("z / m/s²", "z", "m/s^2"),
        ("TG Master.Vasen Korkeuspoikkeama D1 [mm]", "TG Master.Vasen Korkeuspoikkeama D1", "mm"),
        ("Location [km+m]", "Location", "km+m"),
        ("Level (left) [mm]", "Level (left)", "mm"),
        ("z", "z", ""),
        ("m", "m", ""),
        ("seconds_elapsed", "seconds_elapsed", ""),
        ("time [ns]", "time", "ns"),
    ],
)
def test_headings(heading, name, unit):
    assert split_heading(heading) == (name, unit)


N = 40
T = np.arange(N) / 100
Z = np.sin(7 * T)


def test_parquet(tmp_path):
    whole = pd.array([2**60 + 1, None] * (N // 2), dtype="Int64")
    frame = {
        "time": pd.date_range("2024-01-01", periods=N, freq="10ms"),
        "z [g]": Z,
        "f": Z.astype(np.float32),
        "k": whole,
        "s": ["1.5", "abc"] * (N // 2),
        "l": [[1.0, 2.0]] * N,
    }
    pd.DataFrame(frame).to_parquet(tmp_path / "a.parquet")
    table = read_table(tmp_path / "a.parquet")
    time, z, f, k, s = table.columns
    assert time.unit == "ns"
    assert time.numbers[1] - time.numbers[0] == 10_000_000
    assert np.array_equal(z.numbers, Z)
    assert z.unit == "g"
    assert np.array_equal(f.numbers, Z.astype(np.float32))
    assert list(k.cells[:2]) == [str(2**60 + 1), ""]
    assert s.numbers[0] == 1.5
    assert s.shown(1) == "'abc'"
    assert "'l' holds lists" in table.remarks[0]
    assert table.where(0, z) == "row 1, column 'z [g]'"


@pytest.mark.parametrize("kind", [np.uint8, np.int16, np.int32, np.float32])
def test_wav(tmp_path, kind):
    full = 1.0 if kind is np.float32 else 2.0 ** (8 * kind(0).itemsize - 1)
    shift = 128 if kind is np.uint8 else 0
    whole = np.round(Z * 0.9 * full) if full > 1 else (Z * 0.9).astype(np.float32)
    wavfile.write(
        tmp_path / "a.wav", 1000, np.stack([whole + shift, shift - whole], 1).astype(kind)
    )
    table = read_table(tmp_path / "a.wav")
    assert table.rate == 1000.0
    assert [c.heading for c in table.columns] == ["1", "2"]
    assert np.array_equal(table.columns[0].numbers, whole / full)
    assert np.array_equal(table.columns[1].numbers, -whole / full)
    assert bool(table.remarks) == (full > 1)


def test_matlab(tmp_path):
    times = np.array([f"2024-01-01T00:00:{s:05.2f}" for s in T], dtype=object)
    content = {
        "t": T,
        "note": "hello",
        "rec": {"acc": np.stack([Z, -Z], 1), "dt": 0.01},
        "clock": times,
        "short": Z[:5],
    }
    savemat(tmp_path / "a.mat", content)
    table = read_table(tmp_path / "a.mat")
    assert [c.heading for c in table.columns] == ["t", "rec/acc/1", "rec/acc/2", "clock"]
    assert np.array_equal(table.columns[2].numbers, -Z)
    assert list(table.columns[3].cells) == list(times)
    assert table.rate == pytest.approx(100.0, rel=1e-15)
    assert "'short' differ in length" in table.remarks[0]


def test_the_end_of_a_path_names_a_column_where_no_other_ends_so(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for name in ("a/time", "b/time", "a/acc_z [g]", "b/Speed", "speed"):
            file[name] = Z
    table = read_table(tmp_path / "a.h5")
    assert [c.heading for c in table.find("acc z")] == ["a/acc_z [g]"]
    assert table.column("ACC_Z").heading == "a/acc_z [g]"
    assert table.column("b/time").heading == "b/time"
    assert [c.heading for c in table.find("speed")] == ["speed"]  # the whole name counts first
    assert table.find("time") == ()
    with pytest.raises(InputError, match=r"2 columns of that name.*in full: 'a/time' or 'b/time'"):
        table.column("time")


def test_a_stroke_in_a_text_s_heading_makes_no_path(read):
    assert read("t,x/z\n1,2\n2,3\n").find("z") == ()


def test_hdf5(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        group = file.create_group("acc")
        group.attrs["sampling_rate"] = 100.0
        group.create_dataset("z", data=Z).attrs["unit"] = "g"
        file["time"] = np.array([b"2024-01-01"] * N, dtype=h5py.string_dtype())
        file["both"] = np.stack([Z, -Z])
    table = read_table(tmp_path / "a.h5")
    assert [(c.heading, c.unit) for c in table.columns] == [
        ("acc/z", "g"),
        ("both/1", ""),
        ("both/2", ""),
        ("time", ""),
    ]
    assert np.array_equal(table.columns[2].numbers, -Z)
    assert table.columns[3].cells[0] == "2024-01-01"
    assert table.rate == 100.0


def test_matlab_from_version_7_3(tmp_path):
    """As MATLAB writes it: a text block before the HDF5, columns across, letters as numbers."""
    with h5py.File(tmp_path / "a.mat", "w", userblock_size=512) as file:
        file["z"] = Z[None, :]
        file["fs"] = [[100.0]]
        letters = file.create_dataset("note", data=np.full((N, 1), 65, np.uint16))
        letters.attrs["MATLAB_class"] = np.bytes_("char")
    with (tmp_path / "a.mat").open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\0\2IM")
    table = read_table(tmp_path / "a.mat")
    assert [c.heading for c in table.columns] == ["z"]
    assert table.rate == 100.0
    assert np.array_equal(table.columns[0].numbers, Z)


def test_two_rates_in_a_file_are_none(tmp_path):
    savemat(tmp_path / "a.mat", {"z": Z, "fs": 100.0, "rec": {"rate": 200.0}})
    table = read_table(tmp_path / "a.mat")
    assert table.rate is None
    assert "several rates, fs 100 Hz and rec/rate 200 Hz" in table.remarks[0]


def test_a_file_without_arrays_is_a_fault(tmp_path):
    savemat(tmp_path / "a.mat", {"note": "hello", "fs": 100.0})
    with pytest.raises(InputError, match="no array of numbers among 2 variables"):
        read_table(tmp_path / "a.mat")


@pytest.mark.parametrize("name", ["a.parquet", "a.wav", "a.mat", "a.h5"])
def test_binary_files_that_are_cut_off_are_a_fault(tmp_path, name):
    path = tmp_path / name
    if name == "a.parquet":
        pd.DataFrame({"z": Z}).to_parquet(path)
    elif name == "a.wav":
        wavfile.write(path, 100, Z)
    elif name == "a.mat":
        savemat(path, {"z": Z})
    else:
        with h5py.File(path, "w") as file:
            file["z"] = Z
    data = path.read_bytes()
    for size in (len(data) - 1, len(data) // 2, 60, 12):
        path.write_bytes(data[:size])
        with pytest.raises(InputError, match=re.escape(name)):
            read_table(path)


@pytest.mark.parametrize(
    ("name", "content", "library"),
    [("a.parquet", b"PAR1", "pyarrow"), ("a.h5", b"\x89HDF\r\n\x1a\n", "h5py")],
)
def test_a_missing_library_names_the_extra(fault, monkeypatch, name, content, library):
    monkeypatch.setitem(sys.modules, library, None)
    monkeypatch.setitem(sys.modules, f"{library}.parquet", None)
    message = fault(content, name)
    assert f"needs {library}" in message
    assert "railride[formats]" in message


def test_text_under_a_binary_name_is_a_fault(fault):
    assert "expected a WAV file" in fault(GOOD, "a.wav")
    assert "cannot be read" in fault(GOOD, "a.mat")
