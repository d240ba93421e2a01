"""Text files as the world writes them: separators, decimal commas, encodings, foreign units."""

import gzip
import re
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_files import (
    GOOD,
    ROWS,
    assert_one_sentence,
    column,
    headed,
    lines,
    refusal,
    with_line,
    written,
)

from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording


def rewritten(text: list[str], separator: str, decimal: str = ".") -> list[str]:
    """The same table with other signs."""
    swap = {",": separator, ".": decimal}
    return ["".join(swap.get(sign, sign) for sign in line) for line in text]


@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize("decimal", [".", ","])
def test_separators_and_decimal_commas(separator: str, decimal: str, tmp_path: Path) -> None:
    plain = load(written(tmp_path / "run.csv", GOOD))
    path = written(tmp_path / "a" / "run.csv", rewritten(GOOD, separator, decimal))
    assert load(path) == plain
    assert (
        load(written(tmp_path / "b" / "run.csv", "\r\n".join(path.read_text().split("\n"))))
        == plain
    )
    zipped = written(tmp_path / "run.csv.gz", rewritten(GOOD, separator, decimal))
    assert load(zipped) == plain


@pytest.mark.parametrize(
    "first",
    [
        "sep=;",
        '"sep=;"',
        "# Zeit; Winkel",
        "",
        "\ufeff# a, comment",
    ],
)
def test_lines_before_a_foreign_header(first: str, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", [first, *rewritten(GOOD, ";", ",")])
    assert load(path).velocity.tolist() == column(2)


def test_a_byte_order_mark_and_the_separator_named(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", ["\ufeffsep=\t", *rewritten(GOOD, "\t", ",")])
    assert load(path).velocity.tolist() == column(2)


def test_quoted_headers_with_the_separator_inside(tmp_path: Path) -> None:
    header = '"time, s";"position, deg";"velocity, rad/s";"a;b"'
    path = written(tmp_path / "a.csv", [header, *rewritten(GOOD[1:], ";", ",")])
    loaded = load(path, columns={"sensor": "a;b"})
    np.testing.assert_allclose(loaded.position, np.deg2rad(column(1)))
    assert loaded.sensor is not None
    assert loaded.sensor.tolist() == column(3)


def test_numbers_without_a_header(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", rewritten(GOOD[1:], ";", ","))
    loaded = load(path, columns={"time": 0, "position": 1})
    assert loaded.position.tolist() == column(1)


def test_quoted_numbers_and_text_beside_decimal_commas(tmp_path: Path) -> None:
    rows = [f'"{k},5";{k};"1.2.2024, 10:00";{"ab"[k % 2]}' for k in range(20)]
    path = written(tmp_path / "a.csv", ["t_s;q_rad;date;run", *rows])
    assert load(path).time.tolist() == [k + 0.5 for k in range(20)]
    assert load(path, where={"run": "a"}).position.tolist() == list(range(0, 20, 2))


def test_decimal_commas_with_exponents(tmp_path: Path) -> None:
    rows = [f"{k};-1,5e-{k};,5;2" for k in range(9)]
    loaded = load(written(tmp_path / "a.csv", ["t_s;q;v;tau", *rows]), columns={"velocity": 2})
    assert loaded.position.tolist() == [float(f"-1.5e-{k}") for k in range(9)]
    assert loaded.velocity.tolist() == [0.5] * 9


@pytest.mark.parametrize("encoding", ["latin-1", "cp1252", "utf-8", "utf-8-sig"])
def test_degree_signs_in_old_encodings(encoding: str, tmp_path: Path) -> None:
    text = "\r\n".join(headed("t [s],q [°],vel [°/s],temperature [°C]"))
    loaded = load(written(tmp_path / "a.csv", text.encode(encoding)))
    np.testing.assert_allclose(loaded.position, np.deg2rad(column(1)))
    np.testing.assert_allclose(loaded.velocity, np.deg2rad(column(2)))
    assert loaded.temperature is not None
    assert loaded.temperature.tolist() == column(3)


FOREIGN = [
    ("Speed (U/min)", "velocity", 2 * np.pi / 60),
    ("speed [1/min]", "velocity", 2 * np.pi / 60),
    ("velocity [rad·s⁻¹]", "velocity", 1.0),
    ("velocity_turns", "velocity", None),
    ("torque [kgf·cm]", "torque", 0.0980665),
    ("torque_kgf_cm", "torque", 0.0980665),
    ("torque (oz-in)", "torque", 0.00706155181422604),
    ("torque_Ncm", "torque", 0.01),
    ("torque_N-m", "torque", 1.0),
    ("torque (ft-lb)", "torque", 1.3558179483314004),
    ("torque, mNm", "torque", 1e-3),
]


@pytest.mark.parametrize(("header", "signal", "factor"), FOREIGN)
def test_foreign_units(header: str, signal: str, factor: float | None, tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", lines(f't_s,q_rad,"{header}"'.replace(", mNm", "; mNm")))
    if ", " in header:
        path = written(tmp_path / "a.csv", rewritten(lines("t_s,q_rad,X"), ";"))
        path.write_text(path.read_text().replace("X", header))
    if factor is None:
        loaded = load(path)
        assert loaded.velocity_derived
        (left_out,) = loaded.metadata["left_out"]
        assert left_out["reason"] == "velocity is in rev (angle)"
        message = "is in rev (angle); angular velocity is expected"
        assert message in refusal(path, columns={"velocity": header})
        return
    np.testing.assert_allclose(getattr(load(path), signal), np.array(column(2)) * factor, 1e-14)


SEMI = rewritten(GOOD, ";", ",")
Bad = tuple[str, Any, Mapping[str, Any], str]
BAD: list[Bad] = [
    (
        *("a.csv", [*SEMI[:4], "0,03;0.5;1;2", *SEMI[5:]], {}),
        r"line 2, column 'time_s': the numbers contain commas and points .*\('0,0' here and '0.5' elsewhere\)",
    ),
    (
        *("a.csv", [SEMI[0], *(f"1.{k}00,5;{k};1;2" for k in range(9))], {}),
        r"line 2, column 'time_s': the numbers contain commas and points \('1\.000,5'\)",
    ),
    (
        *("a.csv", ["t;q;tau", *(f"{k};{k};1,{k}00" for k in range(9))], {}),
        r"line 2, column 'tau': '1,000' may mean 1\.000 or 1000; write decimal points",
    ),
    ("a.csv", ["t;q", *(f"{k},5;1,2,3" for k in range(9))], {}, "'q': '1,2,3' is not a number;"),
    ("a.csv", [*SEMI[:4], "0,03;x;1;2", *SEMI[5:]], {}, "line 5, column 'position_rad': 'x' is"),
    ("a.csv", [*SEMI[:4], "0,03;;1;2", *SEMI[5:]], {}, "line 5, column .*: the cell is empty"),
    ("a.csv", [*SEMI[:4], "0,03;1;2", *SEMI[5:]], {}, "line 5: 3 cells, but 4 headers"),
    ("a.csv", [*SEMI[:4], '0,03;"1;1;2', *SEMI[5:]], {}, "line 5: quotation marks do not match"),
    ("a.csv", ["t;q", "0,1;2,5", "0,2;2,5"], {}, "time: 2 samples; a recording needs at least"),
    ("a.csv", ["t_s;q_rad", "x"], {}, "line 2: 1 cells, but 2 headers"),
    (
        *("a.csv", ["a;b,c", *(f"x;y,z{k}" for k in range(9))], {}),
        "line 1: the cells may be separated by commas or semicolons; put texts",
    ),
    (
        *("a.csv", [line.replace(",", "|") for line in GOOD], {}),
        "line 1: 'time_s.position_rad.*' has no separator; at least the columns time and position",
    ),
    ("a.csv", ["sep=;"], {}, "the file has no header and no rows"),
    ("a.csv", with_line(5, '0.03,"1,5",1,2'), {}, "'1,5' is not a number; decimal commas are read"),
    (
        "a.csv",
        with_line(5, "12:00:03,1,1,2"),
        {},
        "'12:00:03' is not .* clock times among numbers cannot be read",
    ),
    ("a.csv", with_line(5, "0.03,1\x1a,1,2"), {}, "line 5: the byte 0x1a is not text"),
    ("a.csv", headed("t,q,v,ü")[0].encode("cp437"), {}, "line 1: the byte 0x81 is not UTF-8"),
    ("a.csv", "\n".join(GOOD).encode("utf-16-le"), {}, "line 1: a zero byte is not text"),
    (
        *("a.csv", headed("t_s,q_counts,v,x"), {}),
        r"'q_counts': .* is a raw reading; angle .* load with scale=\{'position': \.\.\.\} \(with the factor from",
    ),
    (
        *("a.csv", headed("t_s,q_rad,tau [%],x"), {}),
        "column 'tau .%.': torque .* has the unknown unit '%'; torque is expected, in Nm, mNm, kNm",
    ),
    (
        "a.csv",
        headed("t_s,q_rad,tau_V,x"),
        {},
        r"is in V .voltage.; torque .* load with scale=\{'torque': \.\.\.\} .* or load with columns=\{'torque': None\}",
    ),
    (
        "a.csv",
        headed("t_s,q_rad,v [m/s^2],x"),
        {"columns": {"velocity": 2}},
        "unknown unit 'm/s^2'",
    ),
]


@pytest.mark.parametrize(("name", "content", "arguments", "message"), BAD)
def test_bad_text_gives_one_sentence(
    name: str, content: Any, arguments: Mapping[str, Any], message: str, tmp_path: Path
) -> None:
    path = written(tmp_path / name, content)
    error_text = refusal(path, **arguments)
    assert_one_sentence(error_text, path)
    assert re.search(message.replace("^", r"\^"), error_text), error_text


finite = st.floats(-1e15, 1e15).map(repr)


@given(
    values=st.lists(st.tuples(finite, finite), min_size=8, max_size=12),
    separator=st.sampled_from([";", "\t"]),
)
@settings(deadline=None)
def test_decimal_commas_keep_every_bit(
    values: list[tuple[str, str]], separator: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    rows = [f"{k}.5,{a},{b}" for k, (a, b) in enumerate(values)]
    folder = tmp_path_factory.getbasetemp()
    header = "t_s,velocity_rad_s,position_rad"
    plain = load(written(folder / "same.csv", [header, *rows]))
    foreign = rewritten([header, *rows], separator, ",")
    again = load(written(folder / "same.csv", foreign))
    assert again == plain
    assert isinstance(again, Recording)


@pytest.mark.parametrize("count", [100_000, pytest.param(1_000_000, marks=pytest.mark.slow)])
def test_a_million_rows_load_in_seconds(count: int, tmp_path: Path) -> None:
    """Rows are numbers in bulk, never one by one: 60 µs of the processor each are far above what it takes, 1 to 4."""
    row = "{:.3f},0.12345,-1.5,2.25\n"
    text = GOOD[0] + "\n" + "".join(map(row.format, np.arange(count) * 1e-3))
    for name, content in (("a", text), ("b", text.replace(",", ";").replace(".", ","))):
        path = tmp_path / f"{name}.csv"
        path.write_text(content)
        begin = time.process_time()
        assert len(load(path)) == count
        assert time.process_time() - begin < 60e-6 * count


def test_gzip_of_a_foreign_dialect(tmp_path: Path) -> None:
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress("\n".join(SEMI).encode("latin-1")))
    assert load(path).time.tolist() == [row[0] for row in ROWS]
