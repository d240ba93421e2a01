"""Files long enough to be read as a stream: the same numbers and the same words as any other."""

import gzip
from pathlib import Path

import numpy as np
import pytest

import jointid as jid
from jointid import _core
from jointid.recording.readers import csv_reader

HEADER = "time_s,position_rad,velocity_rad_s,torque_Nm"


@pytest.fixture(scope="module")
def rows() -> list[str]:
    rng = np.random.default_rng(5)
    values = rng.normal(size=(20_000, 3)) * 10.0 ** rng.integers(-12, 12, (20_000, 3))
    written = [
        [f"{k * 1e-3!r}", repr(float(a)), f"{b:.17g}", f"{c:+.16e}"]
        for k, (a, b, c) in enumerate(values)
    ]
    return [",".join(cells) for cells in written]


def file_of(folder: Path, rows: list[str], ending: str = "\n", name: str = "long.csv") -> Path:
    path = folder / name
    content = ending.join([HEADER, *rows, ""]).encode()
    assert len(content) > csv_reader._LONG
    path.write_bytes(gzip.compress(content, 1) if name.endswith(".gz") else content)
    return path


@pytest.mark.parametrize(
    ("ending", "name"),
    [("\n", "a.csv"), ("\r\n", "b.csv"), ("\r", "c.csv"), ("\n", "d.csv.gz"), ("\n\n", "e.csv")],
)
def test_every_number_is_the_nearest_double(
    tmp_path: Path, rows: list[str], ending: str, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    table = csv_reader.CsvTable(file_of(tmp_path, rows, ending, name))
    assert table._table is not None
    expected = np.array([[float(cell) for cell in row.split(",")] for row in rows])
    found = np.column_stack(table.numbers([0, 1, 2, 3]))
    assert (found == expected).all()
    monkeypatch.setattr(_core, "number_table", lambda *_: None)
    stream = csv_reader.CsvTable(tmp_path / name)
    assert stream._table is not None
    assert (np.column_stack(stream.numbers([0, 1, 2, 3])) == expected).all()
    monkeypatch.setattr(csv_reader, "_LONG", 1 << 40)
    slowly = csv_reader.CsvTable(tmp_path / name)
    assert slowly._table is None
    assert (np.column_stack(slowly.numbers([3, 0])) == expected[:, [3, 0]]).all()
    assert slowly.place(1, 19_999) == table.place(1, 19_999)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("17.0,1.0,2.0", "line 17002: 3 cells, but 4 headers"),
        ("17.0,1.0,2.0,3.0,4.0", "line 17002: 5 cells"),
        ("17.0,1.0,x,3.0", "line 17002, column 'velocity_rad_s': 'x' is not a number"),
        ("17.0,1.0,,3.0", "line 17002, column 'velocity_rad_s': the cell is empty"),
        ('17.0,1.0,"2,5",3.0', "line 17002, column 'velocity_rad_s'"),
        ("17.0,1.0,nan,3.0", "line 17002, column 'velocity_rad_s'"),
        ("1.0,1.0,2.0,3.0", "line 17002"),
    ],
)
def test_a_bad_row_is_named(tmp_path: Path, rows: list[str], row: str, message: str) -> None:
    path = file_of(tmp_path, [*rows[:17_000], row, *rows[17_001:]])
    with pytest.raises(jid.InputError, match="long.csv, " + message):
        jid.load(path)


def test_a_column_of_words_beside_the_numbers(tmp_path: Path, rows: list[str]) -> None:
    worded = [f"{row},idle" for row in rows]
    path = tmp_path / "worded.csv"
    path.write_text("\n".join([HEADER + ",state", *worded]), encoding="utf-8")
    assert len(jid.load(path)) == len(rows)


def test_semicolons_and_decimal_commas(tmp_path: Path, rows: list[str]) -> None:
    path = tmp_path / "german.csv"
    german = [row.replace(",", ";").replace(".", ",") for row in rows]
    path.write_text("\n".join([HEADER.replace(",", ";"), *german]), encoding="utf-8")
    expected = np.array([float(row.split(",")[1]) for row in rows])
    assert (jid.load(path).position == expected).all()
