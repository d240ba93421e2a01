"""Files that cannot be used: each raises an error of one sentence with file, place and remedy."""

import gzip
import io
import json
import re
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from recording_files import (
    GOOD,
    assert_one_sentence,
    headed,
    lines,
    marked,
    npz,
    refusal,
    with_line,
    written,
)

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording

# File name, content, arguments, and a pattern of the message after the file name.
Bad = tuple[str, Any, Mapping[str, Any], str]
BAD: list[Bad] = [
    ("a.csv", with_line(5, "0.03,abc,1,2"), {}, "line 5, column 'position_rad': 'abc' is not"),
    ("a.csv", with_line(5, "0.03,,1,2"), {}, "line 5, column 'position_rad': the cell is empty"),
    ("a.csv", with_line(5, "0.03,1_0,1,2"), {}, "line 5, column 'position_rad': '1_0' is not"),
    ("a.csv", with_line(4, "0.02,nan,1,2"), {}, "line 4, column 'position_rad': position is nan"),
    ("a.csv", with_line(4, "0.02,1,1e999,2"), {}, "line 4, column 'velocity_rad_s': .* is inf"),
    (
        "a.csv",
        with_line(6, "0.03,1,1,2"),
        {},
        "line 6, column 'time_s': time is 0.03: the sample before is at 0.03, ",
    ),
    ("a.csv", with_line(3, "0.01,1,1"), {}, "line 3: 3 cells, but 4 headers"),
    (
        "a.csv",
        with_line(3, "0,01,0,5,1,2"),
        {},
        "line 3: 6 cells, .*write decimal points, not commas",
    ),
    ("a.csv", with_line(3, '0.01,"1,1,2'), {}, "line 3: quotation marks do not match"),
    ("a.csv", with_line(3, '0.01,"1,2",1,2'), {}, "line 3, column 'position_rad': '1,2' is not"),
    ("a.csv", with_line(3, "stop"), {}, "line 3: 1 cells, but 4 headers"),
    ("a.csv", "", {}, "the file is empty"),
    ("a.csv", " \n\n", {}, "the file is empty"),
    ("a.csv", "# note\n", {}, "the file has no header and no rows"),
    ("a.csv", GOOD[:1], {}, "line 1: the file has a header, but no rows"),
    ("a.csv", GOOD[:6], {}, "time: 5 samples; a recording needs at least 8"),
    ("a.csv", GOOD[1:], {}, r"line 1 \(numbers, no header\): no column is recognised as time"),
    ("a.csv", "\n".join(GOOD).encode("utf-16"), {}, "line 1: the byte 0xff is not UTF-8 text"),
    ("a.csv", headed("t,q,v,ü")[0].encode("cp437"), {}, "line 1: the byte 0x81 is not UTF-8"),
    ("a.csv", with_line(4, "0.02,\0,1,2"), {}, "line 4: a zero byte is not text"),
    (
        "a.csv",
        gzip.compress(b"t,q", mtime=0),
        {},
        r"compressed by gzip; its name must end in \.csv\.gz",
    ),
    (
        "a.csv",
        headed("t,axis_angle,v,x"),
        {},
        "line 1: no column is .* position; candidates are 'ax",
    ),
    (
        "a.csv",
        headed("time_s,torque_Nm,x_Nm,y_A"),
        {},
        "line 1: the file has no position column; headers are 'time_s', 'torque_Nm', 'x_Nm', 'y_A'$",
    ),
    (
        "a.csv",
        headed("time_s,y,torque_Nm,x_A"),
        {},
        r"candidates are 'y'; load with columns=\{'position': 'y'\}$",
    ),
    (
        "a.csv",
        headed("time_s,torque_Nm,x,y"),
        {"columns": {"position": "time_s"}},
        "no column is left for time: 'time_s' is chosen as position$",
    ),
    (
        "a.csv",
        headed("t,x,y,z"),
        {},
        r"columns are 't', 'x', 'y', 'z'; .* columns=\{'position': \.\.\.\}",
    ),
    (
        "a.csv",
        headed("t,q_rad,q_deg,x"),
        {},
        r"line 1: 'q_rad' \(column 1\) and 'q_deg' \(column 2\)",
    ),
    (
        "a.csv",
        headed("t,q,angle,x"),
        {},
        r"'q' \(column 1\) and 'angle' \(column 2\) are both recog",
    ),
    (
        "a.csv",
        headed("t,q_rad,q_mm,x"),
        {},
        "'q_rad' and 'q_mm' are both recognised as position; one has a unit of rev",
    ),
    (
        "a.csv",
        headed("t,q_Nm,v,x"),
        {},
        r"column 'q_Nm': position .* is in Nm \(torque\); angle is",
    ),
    (
        "a.csv",
        headed("t,q_m,tau_Nm,x"),
        {},
        r"column 'tau_Nm': torque of a prismatic joint is in Nm \(torque\)",
    ),
    (
        "a.csv",
        headed("t,q [furlong],v,x"),
        {},
        "has the unknown unit 'furlong'; .* rad, mrad, deg",
    ),
    ("a.csv", GOOD, {"kind": "prismatic"}, "'position_rad': .* is in rad .angle.; length is exp"),
    (
        "a.csv",
        GOOD,
        {"units": {"position": "ell"}},
        "position is 'ell': unknown unit; choose one of rad, mrad",
    ),
    ("a.csv", GOOD, {"units": {"position": "Nm"}}, r"is in Nm \(torque\); angle is expected"),
    (
        "a.csv",
        GOOD,
        {"units": {"sensor": "raw"}},
        "units.sensor: no column is recognised as sensor",
    ),
    ("a.csv", GOOD, {"columns": {"position": "positon_rad"}}, "no such header; did you mean 'posi"),
    ("a.csv", GOOD, {"columns": {"position": 4}}, "position is 4: the columns are 0 to 3"),
    ("a.csv", GOOD, {"columns": {"position": -1}}, "position is -1: the columns are 0 to 3"),
    ("a.csv", GOOD, {"columns": {"position": None}}, "no column is recognised as position"),
    (
        "a.csv",
        GOOD,
        {"columns": {"sensor": 1, "current": 1}},
        "columns.current is 1: this column is also chosen as sensor; each",
    ),
    (
        "a.csv",
        headed("t,q,x,x"),
        {"columns": {"sensor": "x"}},
        "columns.sensor is 'x': columns 2 and 3 have this header; give",
    ),
    (
        "a.csv",
        GOOD,
        {"where": {"torque_Nm": 7}},
        "where.torque_Nm is 7: no row has this value; the column holds -1.25",
    ),
    (
        "a.csv",
        GOOD,
        {"where": {"torque_Nm": "x"}},
        "where.torque_Nm is 'x': no row has this value; the column",
    ),
    ("a.csv", GOOD, {"where": {"run": 1}}, "line 1: where is 'run': no such header; headers are"),
    ("a.csv", GOOD, {"where": {"time_s": [1]}}, r"where\.time_s is \[1\]: a number or text"),
    (
        "a.csv",
        GOOD,
        {"where": {"time_s": 0, "velocity_rad_s": 0.5}},
        r"where is \{'time_s': 0, .*\}: no row has all",
    ),
    ("a.csv", marked("{"), {}, "line 1: the description of the recording is damaged JSON"),
    ("a.csv", marked("[]"), {}, "line 1: the description of the recording is not a JSON object"),
    (
        "a.csv",
        marked('{"schema": 2}'),
        {},
        "line 1: schema is 2: this version of jointid reads schema 1",
    ),
    (
        "a.csv",
        marked('{"schema": 1, "kind": "x"}'),
        {},
        "line 1: kind is 'x': revolute or prismatic is",
    ),
    ("a.csv", marked('{"schema": 1, "name": 3}'), {}, "line 1: name: this is 3: text is expected"),
    (
        *("a.csv", marked('{"schema": 1, "kind": "revolute"}'), {"kind": "prismatic"}),
        "kind is 'prismatic': the recording was saved as revolute; leave it out",
    ),
    ("a.csv", None, {}, "there is no such file"),
    ("a.xyz", GOOD, {}, r"a file name that ends in \.csv, .* or \.wpilog is expected"),
    ("a.gz", GOOD, {}, r"a file name that ends in \.csv, "),
    ("a.npz", GOOD, {}, r"not a \.npz archive"),
    ("a.npz", {}, {}, "the archive is empty; arrays time and position are expected"),
    (
        "a.npz",
        {"position": np.ones(9)},
        {},
        "the file has no time column; headers are 'position'; load with sample_period=",
    ),
    (
        *("a.npz", {"time": np.arange(9), "position": np.array([None] * 9)}, {}),
        r"member 'position': it holds Python objects \(a pickle\); jointid never reads pickles",
    ),
    (
        *("a.npz", {"time": np.arange(9), "position": np.ones((9, 2, 2))}, {}),
        r"member 'position': the shape is \(9, 2, 2\)",
    ),
    (
        *("a.npz", {"time": np.arange(9), "position": np.array(["x"] * 9)}, {}),
        "member 'position': an array of numbers is expected",
    ),
    (
        *("a.npz", {"time": np.arange(9) / 1000, "position": np.ones(8)}, {}),
        "position: 8 samples, but time has 9",
    ),
    (
        *("a.npz", {"time": np.arange(9) / 1000, "position": np.full(9, np.inf)}, {}),
        "member 'position', index 0: position is inf",
    ),
    (
        "a.npz",
        {"jointid_recording": np.array("{}")},
        {},
        "member 'jointid_recording': schema is None",
    ),
]


@pytest.mark.parametrize(("name", "content", "arguments", "message"), BAD)
def test_bad_file_gives_one_sentence(
    name: str, content: Any, arguments: Mapping[str, Any], message: str, tmp_path: Path
) -> None:
    path = tmp_path / name
    if isinstance(content, dict):
        npz(path, **content)
    elif content is not None:
        written(path, content)
    error_text = refusal(path, **arguments)
    assert_one_sentence(error_text, path)
    assert re.search(message, error_text), error_text


def test_what_is_wrong_with_the_arguments(tmp_path: Path) -> None:
    path = written(tmp_path / "a.csv", GOOD)
    assert "columns: 'torqe' is not a signal; did you mean 'torque'" in refusal(
        path, columns={"torqe": 1}
    )
    assert "units: 'pos' is not a signal" in refusal(path, units={"pos": "deg"})
    said = refusal(path, columns={"motor_position": "position_rad"})
    assert "did you mean 'position' or load with side={'position': 'motor'}" in said
    assert "columns.position is 1.5: a header or" in refusal(path, columns={"position": 1.5})
    assert "kind is 'x'" in refusal(path, kind="x")
    assert "torque_hold is 'x'" in refusal(path, torque_hold="x")


def test_folder(tmp_path: Path) -> None:
    for name in ("a.csv", "a.npz"):
        (tmp_path / name).mkdir()
        error_text = refusal(tmp_path / name)
        assert_one_sentence(error_text, tmp_path / name)
        assert "this is a folder" in error_text


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda raw: raw[:-20], "the compressed file is truncated"),
        (lambda raw: raw[:12], "the compressed file is truncated"),
        (lambda raw: raw[:-8] + b"12345678", "the compressed file is damaged (CRC"),
        (lambda raw: raw[:20] + bytes(20) + raw[40:], "the compressed file is damaged ("),
        (lambda _: b"time,position", "the file is not compressed by gzip"),
        (lambda _: b"", "the file is not compressed by gzip"),
    ],
)
def test_damaged_gzip(spoil: Callable[[bytes], bytes], message: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv.gz"
    path.write_bytes(spoil(gzip.compress("\n".join(GOOD).encode(), mtime=0)))
    error_text = refusal(path)
    assert_one_sentence(error_text, path)
    assert message in error_text


def test_npz_member_that_is_no_array(tmp_path: Path) -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("time", b"0,1,2")
        archive.writestr("position.npy", b"\x93NUMPY\x01\x00\x05\x00{'a'}")
    path = written(tmp_path / "a.npz", stream.getvalue())
    assert "member 'time': it is not an array" in refusal(path)
    assert "member 'position': it cannot be read (" in refusal(
        path, columns={"time": "position", "position": "time"}
    )


@given(data=st.data())
@settings(deadline=None, max_examples=60)
def test_damaged_npz_is_refused_or_read(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.getbasetemp() / "damaged.npz"
    Recording(time=np.arange(9.0), position=np.arange(9.0)).save(path)
    raw = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(raw[: data.draw(st.integers(0, len(raw)))])
    error_text = ""
    try:
        load(path)
    except InputError as error:
        error_text = str(error)
    assert "\n" not in error_text


cell = st.one_of(
    st.floats().map(repr),
    st.integers().map(str),
    st.sampled_from(["", " ", '"', '"1"', '"1,2"', "nan", "1e999", "0x1p3", "١", "1 2", "#", "\0"]),
    st.text(max_size=4),
)
fuzzed_header = st.sampled_from(
    ["t_s,q_rad", "time,position,torque", '"t","q"', "# t,q", "", 't,q [m],"', "t,q;v"]
)
fuzzed = st.one_of(
    st.text(),
    st.text(alphabet='0123456789.,-e\n\r"# tq;_'),
    st.builds(
        lambda header, rows, end: end.join([header, *(",".join(row) for row in rows)]),
        fuzzed_header,
        st.lists(st.lists(cell, min_size=1, max_size=4), max_size=12),
        st.sampled_from(["\n", "\r\n", "\r"]),
    ),
    st.builds(
        lambda header, rows: "\n".join(
            [header, *(f"{k},{a},{b}" for k, (a, b) in enumerate(rows))]
        ),
        st.sampled_from(["t,q,v", "t_ms,q_deg,tau", "# t,q,x"]),
        st.lists(st.tuples(st.floats().map(repr), cell), min_size=7, max_size=10),
    ),
    st.builds(
        lambda attributes: "\n".join(marked(json.dumps(attributes))),
        st.dictionaries(
            st.sampled_from(["schema", "name", "kind", "torque_hold", "metadata", "truth"]),
            st.none() | st.just(1) | st.text() | st.lists(st.integers(), max_size=2),
        ),
    ),
)


@given(text=fuzzed)
@example(text="# jointid recording " + "[" * 100_000)
@example(text="\r\n".join(lines("t,q")))
@settings(deadline=None, max_examples=400)
def test_any_text_loads_or_is_refused(text: str, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "fuzzed.csv"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    error_text = str(path)
    try:
        loaded = load(path)
    except InputError as error:
        error_text = str(error)
    else:
        assert len(loaded) >= 8
        assert all(np.isfinite(getattr(loaded, name)).all() for name in loaded.signals)
    assert error_text.startswith(str(path))
    assert "\n" not in error_text
