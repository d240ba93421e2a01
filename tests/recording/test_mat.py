"""MATLAB files: the ones MATLAB and SciPy write, damaged ones, and EMPS as its authors publish it."""

import re
import struct
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import ROWS, N, assert_one_sentence, column, mat, refusal, written

import jointid as jid
from jointid.recording.readers.loading import load
from jointid.recording.recording import Recording

TIME = np.array(column(0))
ANGLE = np.array(column(1))
SPEED = np.array(column(2))


@pytest.mark.parametrize(
    "options",
    [
        {"oned_as": "row"},
        {"oned_as": "column"},
        {"do_compression": True},
    ],
)
def test_vectors_of_a_mat_file(options: dict[str, Any], tmp_path: Path) -> None:
    variables = {"t": TIME, "pos_deg": ANGLE, "velocity_rad_s": SPEED, "kp": 3.0, "tau": 2.0}
    loaded = load(mat(tmp_path / "run.mat", variables, **options))
    assert loaded.signals == ("time", "position", "velocity")  # a lone number is no signal
    np.testing.assert_allclose(loaded.position, np.deg2rad(ANGLE))
    assert loaded.velocity.tobytes() == SPEED.tobytes()
    read = {"assumed_units": ["time"], "scale": {"position": np.pi / 180.0}}
    assert (loaded.name, dict(loaded.metadata)) == ("run", read)


def test_integers_and_logicals(tmp_path: Path) -> None:
    whole = np.arange(N, dtype=np.int16)
    loaded = load(mat(tmp_path / "a.mat", {"t_ms": whole, "q_rad": whole > 4, "sensor": whole}))
    assert loaded.time.tolist() == [k / 1000 for k in range(N)]
    assert loaded.position.tolist() == [0.0] * 5 + [1.0] * 5


def test_structs_one_level_deep(tmp_path: Path) -> None:
    log = {"time_s": TIME, "q_rad": ANGLE, "deeper": {"tau_Nm": SPEED}, "note": "x"}
    path = mat(tmp_path / "a.mat", {"log": log, "other": {"vel_rad_s": SPEED}})
    assert load(path).signals == ("time", "position", "velocity")
    named = load(path, columns={"velocity": "other.vel_rad_s", "position": "log.q_rad"})
    assert named == load(path)


def test_structs_that_share_names(tmp_path: Path) -> None:
    one, two = ({"t": TIME, "q": sign * ANGLE} for sign in (1, -1))
    path = mat(tmp_path / "a.mat", {"one": one, "two": two})
    error_text = refusal(path)
    assert_one_sentence(error_text, path)
    assert "2 joints (one, two)" in error_text
    loaded = load(path, columns={"time": "two.t", "position": "two.q"})
    assert loaded.position.tolist() == (-ANGLE).tolist()


def test_an_array_of_structs(tmp_path: Path) -> None:
    runs = np.array([(TIME, ANGLE), (TIME, SPEED)], dtype=[("t", object), ("q", object)])
    loaded = load(
        mat(tmp_path / "a.mat", {"runs": runs}),
        columns={"time": "runs(2).t", "position": "runs(2).q"},
    )
    assert loaded.position.tolist() == SPEED.tolist()


@pytest.mark.parametrize("turned", [False, True])
def test_columns_of_a_matrix(turned: bool, tmp_path: Path) -> None:
    matrix = np.array(ROWS)
    path = mat(tmp_path / "a.mat", {"q": matrix.T if turned else matrix})
    pattern = "q({},:)" if turned else "q(:,{})"
    assert "no column is recognised as time" in refusal(path)
    loaded = load(path, columns={"time": pattern.format(1), "position": pattern.format(2)})
    assert loaded.position.tolist() == column(1)
    assert load(path, columns={"time": 0, "position": 1}) == loaded


def test_rows_of_a_mat_file_by_value(tmp_path: Path) -> None:
    path = mat(tmp_path / "a.mat", {"t": TIME, "q": ANGLE, "run": np.arange(N) // 9})
    assert len(load(path, where={"run": 0})) == 9
    assert len(load(path, where={"run": "0"})) == 9


def level_5(order: str, *variables: bytes) -> bytes:
    """A file by hand: scipy writes one order of bytes and no objects."""
    mark = b"IM" if order == "<" else b"MI"
    return b"MATLAB 5.0".ljust(124) + struct.pack(order + "H", 0x0100) + mark + b"".join(variables)


def element(order: str, kind: int, content: bytes, *, short: bool = False) -> bytes:
    if short:
        return struct.pack(order + "I", len(content) << 16 | kind) + content.ljust(4, b"\0")
    padded = content + bytes(-len(content) % 8)
    return struct.pack(order + "II", kind, len(content)) + padded


def variable(order: str, name: str, kind: int, stored: int, values: bytes, count: int) -> bytes:
    return element(
        order,
        14,
        element(order, 6, struct.pack(order + "II", kind, 0))
        + element(order, 5, struct.pack(order + "ii", 1, count))
        + element(order, 1, name.encode(), short=True)
        + element(order, stored, values),
    )


@pytest.mark.parametrize("order", ["<", ">"])
def test_either_order_of_bytes_and_objects_left_out(order: str, tmp_path: Path) -> None:
    opaque = element(
        order,
        14,
        element(order, 6, struct.pack(order + "II", 17, 0))
        + element(order, 1, b"tabl", short=True)
        + element(order, 1, b"MCOS", short=True),
    )
    # MATLAB stores doubles that are whole numbers in fewer bytes.
    times = variable(order, "t_s", 6, 3, struct.pack(f"{order}10h", *range(-5, 5)), 10)
    angles = variable(order, "q", 7, 7, struct.pack(f"{order}10f", *[0.5] * 10), 10)
    loaded = load(written(tmp_path / "a.mat", level_5(order, opaque, times, angles)))
    assert loaded.time.tolist() == list(range(-5, 5))
    assert loaded.position.tolist() == [0.5] * 10
    assert "only 'tabl'; save" in refusal(written(tmp_path / "a.mat", level_5(order, opaque)))
    wrong = variable(order, "q", 6, 9, struct.pack(f"{order}3d", 1, 2, 3), 10)
    error_text = refusal(written(tmp_path / "a.mat", level_5(order, times, wrong)))
    assert (
        "damaged or truncated (the variable 'q' has 3 values for the shape [1, 10])" in error_text
    )


def test_a_file_nested_without_end_is_left_alone(tmp_path: Path) -> None:
    """Cells in cells, 100,000 deep: a reader that follows them ends the interpreter."""
    head = element("<", 6, struct.pack("<II", 1, 0)) + element("<", 5, struct.pack("<ii", 1, 1))
    size, parts = 0, []
    for name in [b""] * 100_000 + [b"x"]:
        inner = head + element("<", 1, name, short=bool(name))
        size += len(inner)
        parts.append(struct.pack("<II", 14, size) + inner)
        size += 8
    path = written(tmp_path / "a.mat", level_5("<", *reversed(parts)))
    assert "no vectors of numbers are found, only 'x'" in refusal(path)


HDF5 = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + b"\x89HDF\r\n\x1a\n" + bytes(99)
HEAD = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"
GOOD_MAT = {"t": TIME, "q": ANGLE}
BAD_MAT: list[tuple[Any, Mapping[str, Any], str]] = [
    (HDF5, {}, "the file is damaged"),
    (HDF5[512:], {}, "the file is damaged"),
    (HDF5[:512], {}, "the file is not an HDF5 file, or is truncated"),
    (
        b"",
        {},
        r"the file is not a \.mat file of version 5 to 7, or is truncated; in MATLAB save it",
    ),
    (b"MATLAB 5.0 MAT-file", {}, r"the file is not a \.mat file of version 5 to 7"),
    (bytes(300), {}, r"the file is not a \.mat file of version 5 to 7"),
    (b"t,q\n" * 99, {}, r"the file is not a \.mat file of version 5 to 7"),
    (
        HEAD + b"\x0f\0\0\0\x09\0\0\0notzipped",
        {},
        r"damaged or truncated \(a compressed variable is",
    ),
    (
        HEAD + b"\x09\0\0\0\0\0\0\0",
        {},
        r"\(an element has the kind 9; a variable is expected there",
    ),
    (HEAD + b"\x0e\0\0\0\x09\0\0\0", {}, r"\(an element is longer than the rest of the file\)"),
    (HEAD + b"\x0e\0\0", {}, r"\(the file ends inside the header of an element\)"),
    (HEAD, {}, "no vectors of numbers are found, only nothing; save time"),
    ({}, {}, "no vectors of numbers are found, only nothing; save time"),
    ({"name": "x", "kp": 1.0}, {}, "no vectors of numbers are found, only 'name', 'kp'; save time"),
    ({"log": {"data": {"t": TIME}}}, {}, "no vectors of numbers .* nested structs"),
    ({"c": np.array([TIME, "x"], dtype=object)}, {}, "no vectors of numbers are found, only 'c'"),
    ({"t": TIME, "x": ANGLE}, {}, "no column is recognised as position; candidates are 'x'"),
    ({"t": TIME, "q": ANGLE * 1j}, {}, "variable 'q': an array of numbers is expected"),
    ({"t": TIME, "q": ANGLE[1:]}, {}, "position: 9 samples, but time has 10"),
    ({"t": TIME, "q": ANGLE / [1] * np.nan}, {}, "variable 'q', index 0: position is nan"),
    ({"t": TIME[::-1], "q": ANGLE}, {}, "variable 't', index 1: time is .* strictly increase"),
    (
        {"t": TIME, "q": ANGLE, "pos": ANGLE},
        {},
        r"'q' .column 1. and 'pos' .column 2. are both recog",
    ),
    (GOOD_MAT, {"columns": {"position": "qm"}}, "is 'qm': no such header; did you mean 'q'"),
    (GOOD_MAT, {"scale": {"torque": 2.0}}, "scale.torque: no column is recognised as torque"),
    (GOOD_MAT, {"scale": {"torqe": 2.0}}, "'torqe' is not a signal; did you mean 'torque'"),
    (
        GOOD_MAT,
        {"scale": {"position": 0}},
        r"scale\.position is 0: the factor from file units to SI is expected, a finite number other than",
    ),
    (GOOD_MAT, {"scale": {"position": True}}, r"scale\.position is True: the factor from"),
    (GOOD_MAT, {"scale": {"position": "deg"}}, r"scale\.position is 'deg': the factor from"),
    (GOOD_MAT, {"scale": {"position": np.inf}}, r"scale\.position is inf: the factor from"),
    (
        GOOD_MAT,
        {"scale": {"time": -1.0}},
        "index 1: time is -0.01: the sample before is at -0.0, .* increase",
    ),
    (
        *(GOOD_MAT, {"scale": {"position": 2.0}, "units": {"position": "deg"}}),
        "scale.position is 2.0: position also has the unit 'deg'; give only its scale or only its unit",
    ),
    (GOOD_MAT, {"where": {"q": [1]}}, r"where\.q is \[1\]: a number or text"),
]


@pytest.mark.parametrize(("content", "arguments", "message"), BAD_MAT)
def test_bad_mat_gives_one_sentence(
    content: Any, arguments: Mapping[str, Any], message: str, tmp_path: Path
) -> None:
    path = tmp_path / "a.mat"
    if isinstance(content, bytes):
        written(path, content)
    else:
        mat(path, content)
    error_text = refusal(path, **arguments)
    if not error_text.startswith("scale: "):
        assert_one_sentence(error_text, path)
    assert re.search(message, error_text), error_text


# --- EMPS, as its authors publish it ---

EMPS = {"time": "t", "position": "qm", "reference": "qg", "torque": "vir"}
FORCE = {"torque": 35.150652}  # newtons a volt


def test_emps_from_its_mat_file(emps: Path) -> None:
    text = load(emps / "emps_train.csv.gz")
    made = load(emps / "DATA_EMPS.mat", columns=EMPS, scale=FORCE, kind="prismatic")
    assert made.signals == text.signals
    # The text has its time stamps rounded to 1 µs and its forces to 10 digits.
    np.testing.assert_allclose(made.time, text.time, atol=5e-7)
    np.testing.assert_allclose(made.position, text.position, atol=1e-15)
    assert made.torque is not None
    assert text.torque is not None
    np.testing.assert_allclose(made.torque, text.torque, rtol=1e-8)
    assert made.metadata["scale"] == FORCE


def test_emps_gives_the_same_estimate_from_both_files(emps: Path) -> None:
    text = load(emps / "emps_train.csv.gz")
    made = load(emps / "DATA_EMPS.mat", columns=EMPS, scale=FORCE, kind="prismatic")
    stamped = Recording(
        time=text.time, position=made.position, torque=made.torque, kind="prismatic"
    )
    expected, same_clock, own_clock = (
        jid.identify(recording, search="separable").parameters
        for recording in (text, stamped, made)
    )
    for name, parameter in expected.items():
        assert same_clock[name].value == pytest.approx(parameter.value, rel=1e-6)
        # Stamps rounded to 1 µs cost up to 4e-6 themselves.
        assert own_clock[name].value == pytest.approx(parameter.value, rel=1e-5)
