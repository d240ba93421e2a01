"""Tables that the core reads are those that numpy's parser reads: the same bits, or the same message."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import jointid as jid
from jointid import _core
from jointid.recording.readers import csv_reader
from jointid.recording.readers.csv_reader import CsvTable

numbers = st.one_of(
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.floats(-1e3, 1e3).map(lambda value: f"{value:.6f}"),
    st.floats(-1e3, 1e3).map(lambda value: f"{value:+.17e}"),
    st.integers(-(10**25), 10**25).map(str),
    st.from_regex(
        r"[+-]?(\d{1,30}\.?\d{0,30}|\.\d{1,30})([eE][+-]?\d{1,3})?", fullmatch=True
    ).filter(str.isascii),
)
odd = st.sampled_from(
    [
        *("nan", "NaN", "-nan", "inf", "-inf", "Infinity", "0x10", "0x1p-3", "1_000", "1__0", "_1"),
        *("", " ", "-", "+", ".", "e5", "1e", "1e+", "--1", "+-1", "-+1", "++1", "1.5.2", "1 2"),
        *("1e400", "-1e400", "1e-400", "4.9e-324", "1e-310", "2.2250738585072011e-308"),
        *(
            '"1.5"',
            '"1',
            "#",
            "# 1",
            "//",
            "%",
            "true",
            "1,5",
            "1;5",
            "12:30",
            "١",
            "1\u00a0",
            "1d5",
        ),
    ]
)
blanks = st.sampled_from(["", "", "", " ", "  ", "\t", "\x0b", "\u00a0"])
separators = st.sampled_from([",", ";", "\t"])
ends = st.sampled_from(
    ["\n", "\n", "\r\n", "\r", "\n\n", "\n \n", "\r\r\n", "\n# note\n", "\x0c\n"]
)


@st.composite
def tables(draw: st.DrawFn) -> bytes:
    """A text file of up to 12 rows, most of them plain."""
    separator = draw(separators)
    columns = draw(st.integers(2, 4))
    oddities = draw(st.integers(0, 2))
    rows = draw(st.integers(1, 12))
    cells = [[draw(numbers) for _ in range(columns)] for _ in range(rows)]
    for _ in range(oddities):
        row = cells[draw(st.integers(0, rows - 1))]
        place = draw(st.integers(0, len(row) - 1))
        match draw(st.integers(0, 4)):
            case 0:
                row.append(draw(numbers))
            case 1:
                row.pop()
            case 2:
                row[place] = draw(blanks) + row[place] + draw(blanks)
            case _:
                row[place] = draw(odd)
        if not row:
            row.append("1")
    end = draw(st.sampled_from(["\n", "\r\n"]))
    lines = [
        separator.join(row)
        for row in [[*("time", "position", "velocity", "torque")][:columns], *cells]
    ]
    text = end.join(lines)
    if draw(st.booleans()):
        text += end
    if draw(st.integers(0, 3)) == 0:  # another end of one line
        text = text.replace(end, draw(ends), draw(st.integers(1, 3)))
    return (
        draw(st.sampled_from([b"", b"", b"", b"\xef\xbb\xbf", b"# said\n", b"\n"])) + text.encode()
    )


def outcome(path: Path) -> Any:
    """The bits of all columns, or the message; with the place of a cell."""
    try:
        table = CsvTable(path)
        columns = [table.numbers([k])[0] for k in range(len(table.headers))]
        return (
            table.headers,
            table.header_place,
            [column.tobytes() for column in columns],
            [table.place(0, row) for row in range(len(columns[0]))],
            [table.text(k) for k in range(len(columns))],
            table.first_cell(0),
        )
    except jid.InputError as error:
        return str(error)


@settings(
    max_examples=120,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(tables())
def test_the_core_reads_what_numpy_reads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, content: bytes
) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(content)
    with_core = outcome(path)
    with monkeypatch.context() as context:
        context.setattr(_core, "number_table", lambda *_: None)
        assert outcome(path) == with_core


def test_plain_tables_do_not_reach_numpy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    values = rng.normal(size=(500, 3)) * 10.0 ** rng.integers(-300, 300, (500, 3))
    path = tmp_path / "run.csv"
    rows = [",".join(map(repr, row)) for row in values.tolist()]
    path.write_text("\n".join(["a,b,c", *rows]))
    monkeypatch.setattr(np, "loadtxt", None)
    table = CsvTable(path)
    assert np.array_equal(np.column_stack(table.numbers([0, 1, 2])), values)
    assert np.array_equal(table.numbers([2])[0], values[:, 2])


def test_long_plain_tables_do_not_reach_numpy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    values = np.random.default_rng(0).normal(size=(40_000, 2))
    path = tmp_path / "run.csv"
    path.write_text("a;b\r\n" + "".join(f"{a!r};{b!r}\r\n" for a, b in values.tolist()))
    assert path.stat().st_size > csv_reader._LONG
    monkeypatch.setattr(np, "loadtxt", None)
    assert np.array_equal(np.column_stack(CsvTable(path).numbers([0, 1])), values)


@pytest.mark.parametrize("length", [csv_reader._SHORT, csv_reader._LONG])
def test_a_table_below_long_comments_is_found(tmp_path: Path, length: int) -> None:
    """Where the first characters do not hold the lines that decide, more are looked at."""
    path = tmp_path / "run.csv"
    comments = f"# {'x' * 97}\n" * ((length - 50) // 100)
    path.write_text(f"{comments}\n\ntime,position\r\n0,1\r\n1,2\r\n")
    table = CsvTable(path)
    assert table.headers == ("time", "position")
    assert [column.tolist() for column in table.numbers([0, 1])] == [[0.0, 1.0], [1.0, 2.0]]


def test_the_rows_of_empty_lines_ask_for_no_memory() -> None:
    assert _core.number_table("\n" * 1_000_000, 0, ",", 1_000_000) is None
