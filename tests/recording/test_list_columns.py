"""Cells that are lists of numbers: one column for each element, of a joint and of robots, in every format."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recording_files import refusal, written

import jointid as jid
from jointid.recording.readers.loading import load

N = 60
TIME = np.round(0.01 * np.arange(N), 6)
Q = np.round(np.column_stack([np.sin(TIME), np.cos(3.0 * TIME)]), 6)
TAU = np.round(np.column_stack([np.cos(TIME), np.sin(2.0 * TIME)]), 6)


def text(
    beginning: str = "[", between: str = ", ", end: str = "]", separator: str = ",", joints: int = 2
) -> list[str]:
    lines = [separator.join(["mode", "time_s", "positions [rad]", "torques [Nm]"])]
    for k in range(N):
        cells = []
        for values in (Q, TAU):
            cell = f"{beginning}{between.join(map(repr, values[k, :joints].tolist()))}{end}"
            cells.append(f'"{cell}"' if separator in cell else cell)
        lines.append(separator.join(["RUN", repr(float(TIME[k])), *cells]))
    return lines


def check(robot: jid.RobotRecording) -> None:
    assert robot.names == ("0", "1")
    for k in range(2):
        joint = robot.joint(k)
        assert joint.time.tolist() == TIME.tolist()
        assert joint.position.tolist() == Q[:, k].tolist()
        assert joint.torque is not None
        assert joint.torque.tolist() == TAU[:, k].tolist()


@pytest.mark.parametrize(
    "form",
    [
        {},
        {"separator": ";"},
        {"separator": "\t", "beginning": "(", "end": ")"},
        {"between": " "},
        {"beginning": "array('d', [", "end": "])"},
        {"beginning": "[np.float64(", "between": "), np.float64(", "end": ")]"},
    ],
)
def test_a_cell_of_a_text_may_be_a_list(form: dict[str, Any], tmp_path: Path) -> None:
    check(jid.load_robot(written(tmp_path / "a.csv", text(**form))))


def test_a_list_of_one_is_a_joint(tmp_path: Path) -> None:
    recording = load(written(tmp_path / "a.csv", text(joints=1)))
    assert recording.position.tolist() == Q[:, 0].tolist()
    assert "assumed_units" not in recording.metadata


@pytest.mark.parametrize("fixed", [True, False])
def test_a_parquet_column_may_hold_lists(fixed: bool, tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    kind = pa.list_(pa.float64(), 2) if fixed else pa.list_(pa.float64())
    table = pa.table(
        {
            "timestamp": TIME,
            "observation.state": pa.array(Q.tolist(), kind),
            "effort": pa.array(TAU.tolist(), kind),
            "task": ["lift"] * N,
        }
    )
    parquet.write_table(table, tmp_path / "a.parquet")
    robot = jid.load_robot(
        tmp_path / "a.parquet", columns={"position": "observation.state_{joint}"}
    )
    check(robot)


def test_a_matrix_of_a_npz_file_is_a_column_a_joint(tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", time_s=TIME, q_rad=Q, tau_Nm=TAU, gains=np.eye(2))
    check(jid.load_robot(tmp_path / "a.npz"))
    np.savez(tmp_path / "b.npz", time_s=TIME[:, None], q_rad=Q[:, :1], tau_Nm=TAU[:, :1])
    assert load(tmp_path / "b.npz").position.tolist() == Q[:, 0].tolist()


def test_a_list_of_another_length_is_named(tmp_path: Path) -> None:
    lines = text()
    lines[8] = 'RUN,0.07,"[1.0, 2.0, 3.0]","[1.0, 2.0]"'
    said = refusal(written(tmp_path / "a.csv", lines), joint=0)
    assert "line 9, column 'positions [rad]': '[1.0, 2.0, 3.0]' is not a list of 2 numbers" in said


def test_lists_that_differ_in_length_in_parquet_are_refused(tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    lists = Q.tolist()
    lists[7] = [1.0]
    parquet.write_table(pa.table({"t": TIME, "q": lists}), tmp_path / "a.parquet")
    assert "every row needs a list of 2 numbers" in refusal(tmp_path / "a.parquet", joint=0)


def test_a_text_in_brackets_is_no_list(tmp_path: Path) -> None:
    lines = ["t,q,tau,state", *(f"{t},{q},1.0,[RUN]" for t, q in zip(TIME, Q[:, 0], strict=True))]
    assert load(written(tmp_path / "a.csv", lines)).position.tolist() == Q[:, 0].tolist()


@pytest.mark.parametrize(
    "header",
    [
        "t,- a_1_position,- a_2_position,- a_1_effort,- a_2_effort",
        "t,q_0,q_1,tau_est_0,tau_est_1",
        "t,joint1_pos,joint2_pos,joint1_estimated_torque,joint2_estimated_torque",
    ],
)
def test_a_dash_and_an_estimate_are_understood_in_a_header(header: str, tmp_path: Path) -> None:
    table = np.column_stack([TIME, Q, TAU])
    lines = [header, *(",".join(map(repr, row)) for row in table.tolist())]
    robot = jid.load_robot(written(tmp_path / "a.csv", lines))
    assert robot.torque is not None
    assert robot.torque.tolist() == TAU.tolist()
    assert robot.position.tolist() == Q.tolist()


def test_longer_lists_than_any_file_has_columns_stay_lists(tmp_path: Path) -> None:
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    wide = pa.array([[0.0] * 10_001] * 8, pa.list_(pa.float64(), 10_001))
    parquet.write_table(pa.table({"t": TIME[:8], "q": wide}), tmp_path / "a.parquet")
    assert "the column holds fixed_size_list" in refusal(tmp_path / "a.parquet")
