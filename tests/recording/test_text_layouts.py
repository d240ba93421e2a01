"""Text logs of other programs: blanks between cells, comments, rows of units, what stands above the header."""

import contextlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from recording_files import GOOD, ROWS, column, refusal, written

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load

PLAIN = [" ".join(map(repr, row)) for row in ROWS]


@pytest.mark.parametrize(
    "lines",
    [
        ["time_s position_rad velocity_rad_s torque_Nm", *PLAIN],
        [
            "  time_s   position_rad  velocity_rad_s torque_Nm",
            *(f"   {r.replace(' ', '    ')} " for r in PLAIN),
        ],
        ["time [s] position [rad] velocity [rad / s] torque [Nm]", *PLAIN],
        ["# time_s position_rad velocity_rad_s torque_Nm", *PLAIN],
        ["% log of a controller", "%", "% time_s position_rad velocity_rad_s torque_Nm", *PLAIN],
        ["// made today", "t q qd tau", "s rad rad/s Nm", *PLAIN],
        ["t q qd tau", "[s] [rad] [rad/s] [Nm]", *PLAIN],
        ["Robot 7", "", "Program: friction test; run 3", "", "t_s q_rad qd_rad_s tau_Nm", *PLAIN],
        [GOOD[0], *GOOD[1:4], "# mark", "", "% mark", *GOOD[4:]],
        [
            "Version;3",
            "Date;1.2.2024",
            "t;q;qd;tau",
            "s;rad;rad/s;Nm",
            *(r.replace(" ", ";") for r in PLAIN),
        ],
        [
            "time;position;velocity;torque",
            "s;rad;rad/s;Nm",
            *(r.replace(" ", ";").replace(".", ",") for r in PLAIN),
        ],
        [
            "Axis 1,Axis 1,Axis 1,Axis 1",
            "time,position,velocity,torque",
            "s,rad,rad/s,Nm",
            *(r.replace(" ", ",") for r in PLAIN),
        ],
    ],
)
@pytest.mark.parametrize("ending", [".csv", ".txt", ".log", ".dat"])
def test_a_text_log_loads_as_it_is(lines: list[str], ending: str, tmp_path: Path) -> None:
    loaded = load(written(tmp_path / f"a{ending}", lines))
    assert loaded.time.tolist() == column(0)
    assert loaded.position.tolist() == column(1)
    assert loaded.velocity.tolist() == column(2)
    assert loaded.torque is not None
    assert loaded.torque.tolist() == column(3)
    assert dict(loaded.metadata) == {}


def test_rows_with_text_and_no_header(tmp_path: Path) -> None:
    rows = [f"{row[0]} joint_a OK {row[1]} {row[3]}" for row in ROWS]
    path = written(tmp_path / "a.log", rows)
    assert "(numbers, no header)" in refusal(path)
    loaded = load(path, columns={"time": 0, "position": 3, "torque": 4})
    assert loaded.position.tolist() == column(1)


@pytest.mark.parametrize("ending", [".csv", ".csv.gz"])
def test_a_long_wide_file_with_text(ending: str, tmp_path: Path) -> None:
    count, others = 3000, 70
    header = ",".join(["t_s", "q_rad", "state", *(f"noise_{k}" for k in range(others)), "tau_Nm"])
    middle = ",".join(f"{k}.123456" for k in range(others))
    rows = [f"{k / 1000},{k * 0.5},OK,{middle},{-k}" for k in range(count)]
    path = written(tmp_path / f"a{ending}", [header, *rows, ""])
    loaded = load(path)
    assert loaded.torque is not None
    assert loaded.torque.tolist() == [-k for k in range(count)]
    rows[2000] = rows[2000].rpartition(",")[0]
    assert "line 2002: 73 cells, but 74 headers" in refusal(
        written(tmp_path / f"b{ending}", [header, *rows, ""])
    )


SCOPE_KEYS = {
    "SymbolComment": "",
    "Data-Type": "REAL64",
    "VariableSize": "8",
    "Port": "501",
    "ScaleFactor": "1",
}


def scope(
    groups: list[tuple[float, list[tuple[str, str, list[float]]]]],
    separator: str,
    decimal: str,
    *,
    fill: bool,
) -> str:
    """An export of TwinCAT Scope: groups of channels with a period in ms, each channel with its unit."""

    def keyed(key: str, entry: Any) -> str:
        cells = []
        for period, channels in groups:
            cells += [key, *(entry(period, *channel) for channel in channels)]
        return separator.join(cells)

    lines = [f"Name{separator}Project", f"File{separator}C:\\run.svdx"]
    lines += [f"Starttime of export{separator}133964386997165000{separator}Monday", "", ""]
    lines += [keyed("Name", lambda _period, name, _unit, _values: name)]
    lines += [keyed(key, lambda *_, text=text: text) for key, text in SCOPE_KEYS.items()]
    lines += [keyed("SampleTime[ms]", lambda period, *_: f"{period:g}")]
    lines += [keyed("SymbolName", lambda _period, name, _unit, _values: f"Axes.Axis 1.{name}")]
    lines += [keyed("Unit", lambda _period, _name, unit, _values: unit), ""]
    for k in range(max(len(channels[0][2]) for _, channels in groups)):
        cells = []
        for period, channels in groups:
            count = len(channels[0][2])
            row = int(k * groups[0][0] // period) if fill else k
            row = min(row, count - 1) if fill else row
            cells += [f"{row * period:g}" if row < count else ""]
            cells += [repr(values[row]) if row < count else "" for _, _, values in channels]
        lines.append(separator.join(cells).replace(".", decimal))
    return "\r\n".join([*lines, "EOF", ""])


TIME = np.arange(400) * 0.001
ANGLE, TORQUE = 30.0 * np.sin(6.0 * TIME), np.cos(6.0 * TIME)


@pytest.mark.parametrize(("separator", "decimal"), [("\t", ","), (";", ","), (",", ".")])
@pytest.mark.parametrize("fill", [False, True])
@pytest.mark.parametrize("ending", [".csv", ".txt"])
def test_twincat_scope(
    separator: str, decimal: str, fill: bool, ending: str, tmp_path: Path
) -> None:
    groups = [
        (1.0, [("ActPos", "°", ANGLE.tolist()), ("ActPos (1)", "°", ANGLE.tolist())]),
        (4.0, [("ActTorque", "Nm", TORQUE[::4].tolist()), ("State", "", [1.0] * 100)]),
    ]
    path = written(tmp_path / f"a{ending}", scope(groups, separator, decimal, fill=fill))
    loaded = load(path)
    np.testing.assert_allclose(loaded.time, TIME[: len(loaded)], atol=1e-12)
    np.testing.assert_array_equal(loaded.position, np.deg2rad(ANGLE[: len(loaded)]))
    assert loaded.torque is not None
    np.testing.assert_allclose(loaded.torque, TORQUE[: len(loaded)], atol=1e-4)
    assert len(loaded) == 397  # as far as both reach
    assert loaded.metadata["interpolated"] == {"ActTorque [Nm]": "4 ms"}
    assert loaded.metadata["cut_samples"] == 3
    assert load(path, columns={"torque": "Axes.Axis 1.ActTorque"}) == loaded


@pytest.mark.parametrize("count", [4, 2])
def test_a_slow_temperature_cuts_no_sample(count: int, tmp_path: Path) -> None:
    groups = [
        (1.0, [("ActPos", "°", ANGLE.tolist()), ("ActTorque", "Nm", TORQUE.tolist())]),
        (100.0, [("MotorTemp", "°C", [40.0 + k for k in range(count)])]),
    ]
    loaded = load(written(tmp_path / "a.csv", scope(groups, "\t", ",", fill=False)))
    np.testing.assert_array_equal(loaded.position, np.deg2rad(ANGLE))
    if count == 4:  # until 0.3 s of 0.399
        assert loaded.temperature is not None
        assert loaded.temperature[-1] == 43.0
    else:
        assert loaded.temperature is None
        (left_out,) = loaded.metadata["left_out"]
        assert (
            left_out["reason"]
            == "its samples reach from 0 to 0.1 s, but the samples of the other channels reach from 0 to 0.399 s"
        )


def test_twincat_scope_with_names_beside_time(tmp_path: Path) -> None:
    block = "Name\tScope\nFile\tx.svdx\nStarttime of export\t134000000000000000\n\n"
    names = "Time\tActPos\tTime\tActVelo\tTime\tActTorque\n"
    rows = [f"{k},0\t{k % 5},5\t{k},0\t{k % 3},5\t{k},0\t{k % 4},5" for k in range(20)]
    loaded = load(written(tmp_path / "a.csv", block + names + "\n".join(rows)))
    np.testing.assert_allclose(loaded.time, np.arange(20) * 1e-3, atol=1e-15)
    assert loaded.position.tolist() == [k % 5 + 0.5 for k in range(20)]
    assert loaded.velocity.tolist() == [k % 3 + 0.5 for k in range(20)]
    assert loaded.torque is not None
    assert loaded.torque.tolist() == [k % 4 + 0.5 for k in range(20)]


def test_twincat_scope_without_rows(tmp_path: Path) -> None:
    text = scope([(1.0, [("ActPos", "°", [1.0])])], "\t", ",", fill=False)
    assert "header, but no rows" in refusal(written(tmp_path / "a.csv", text.replace("0\t1,0", "")))


cell = st.one_of(
    st.floats().map(repr),
    st.sampled_from(
        [
            "",
            "OK",
            "2024-01-01T00:00:00Z",
            "1729990799999000123",
            "0,5",
            '"',
            "#",
            "%",
            "[s]",
            "s",
            "deg",
        ]
    ),
    st.text(max_size=6),
)
line = st.tuples(st.lists(cell, max_size=6), st.sampled_from([",", ";", "\t", " ", "  "])).map(
    lambda each: each[1].join(each[0])
)


@given(
    content=st.one_of(
        st.binary(max_size=300),
        st.lists(line, max_size=14).map(
            lambda lines: "\n".join(lines).encode("utf-8", "surrogatepass")
        ),
        st.lists(line, max_size=9).map(
            lambda lines: "\n".join(
                ["Name\ta\tName\tb", "Data-Type\tx\tData-Type\ty", *lines]
            ).encode("utf-8", "surrogatepass")
        ),
        st.lists(line, max_size=12).map(
            lambda lines: "\n".join(["time;position;torque", *lines]).encode(
                "utf-8", "surrogatepass"
            )
        ),
    ),
    ending=st.sampled_from([".csv", ".txt"]),
)
@example(content=b"Name\tx\nData-Type\ty\n0\t1\n", ending=".csv")
@example(content=b";;;\n,;;;", ending=".csv")  # a comma of a number among empty columns
@settings(deadline=None, max_examples=300)
def test_nothing_but_refusals_leaves_the_readers(
    content: bytes, ending: str, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / f"any{ending}"
    path.write_bytes(content)
    for arguments in ({}, {"columns": {"time": 0, "position": 1}}):
        with contextlib.suppress(InputError, OSError):
            load(path, **arguments)  # type: ignore[arg-type]
