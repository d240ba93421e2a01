"""MCAP files and ROS bags: joints by name, exact stamps, one topic of several."""

import runpy
import tracemalloc
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from message_files import (
    FORMS,
    START,
    Sent,
    State,
    distractors,
    in_order,
    joint_state,
    mcap,
    motion,
)
from recording_files import assert_one_sentence, refusal

from jointid.base.errors import InputError
from jointid.recording.messages.decoding import BinaryDecoder
from jointid.recording.readers.loading import load
from jointid.recording.readers.loading import table_of as _table
from jointid.recording.readers.loading_robot import load_robot

pytest.importorskip("mcap")
pytest.importorskip("rosbags")


def sent(states: list[State], topic: str = "/joint_states") -> list[Sent]:
    return [joint_state(topic, state) for state in states]


@pytest.mark.parametrize("form", FORMS)
def test_every_form_of_log_holds_the_same_joint(form: str, tmp_path: Path) -> None:
    states = motion(joints=["elbow"])
    path = FORMS[form](tmp_path, in_order([*sent(states), *distractors()]))
    loaded = load(path)
    assert loaded.name == "run"
    assert loaded.signals == ("time", "position", "velocity", "torque")
    assert loaded.time.tolist() == [k * 10_000_000 / 1e9 for k in range(50)]
    assert loaded.position.tolist() == [state.position[0] for state in states]
    assert loaded.velocity.tolist() == [state.velocity[0] for state in states]
    assert loaded.torque is not None
    assert loaded.torque.tolist() == [state.effort[0] for state in states]
    assert dict(loaded.metadata) == {
        "topic": "/joint_states",
        "stamps": "header",
        "first_stamp_ns": START,
    }


def test_several_joints_have_headers_of_a_wide_table(tmp_path: Path) -> None:
    path = mcap(tmp_path / "arm.mcap", sent(motion()))
    table = _table(path)
    assert table.headers == (
        *("time [s]", "log_time [s]", "shoulder.position [rad]", "elbow.position [rad]"),
        *("shoulder.velocity [rad/s]", "elbow.velocity [rad/s]"),
        *("shoulder.effort [Nm]", "elbow.effort [Nm]"),
    )
    loaded = load(path, columns={"position": "elbow.position", "torque": "elbow.effort"})
    assert loaded.position.tolist() == [state.position[1] for state in motion()]


def test_a_prismatic_joint_has_metres(tmp_path: Path) -> None:
    path = mcap(tmp_path / "slide.mcap", sent(motion(joints=["slide"])))
    loaded = load(path, kind="prismatic")
    assert loaded.kind == "prismatic"
    assert loaded.position.tolist() == [state.position[0] for state in motion(joints=["slide"])]
    assert _table(path, kind="prismatic").headers[2:] == (
        *("position [m]", "velocity [m/s]", "effort [N]"),
    )


@pytest.mark.parametrize("encoding", ["cdr", "ros1", "json"])
def test_joints_change_places_and_stay_away(encoding: str, tmp_path: Path) -> None:
    """Two publishers on one topic: an arm whose order changes, and a gripper with its own stamps."""
    states = []
    for k in range(40):
        order = ["a", "bb"] if k % 3 else ["bb", "a"]
        values = {"a": 1.0 + k, "bb": -1.0 - k}
        states.append(
            State(
                stamp=START + 10_000_000 * k,
                name=order,
                position=[values[name] for name in order],
                effort=[10.0 * values[name] for name in order],
                frame="x" * (k % 4),
            )
        )
        if k % 2:
            states.append(
                State(stamp=START + 10_000_000 * k + 500, name=["gripper"], position=[0.1 * k])
            )
    path = mcap(tmp_path / "run.mcap", sent(states), encoding=encoding)
    assert load(path, joint="a").metadata["topic"] == "/joint_states"
    for joint, sign in (("a", 1.0), ("bb", -1.0)):
        loaded = load(path, columns={"position": f"{joint}.position", "torque": f"{joint}.effort"})
        assert loaded.position.tolist() == [sign * (1.0 + k) for k in range(40)]
        assert loaded.torque is not None
        assert loaded.torque.tolist() == [10.0 * sign * (1.0 + k) for k in range(40)]
    loaded = load(path, columns={"position": "gripper.position"})
    assert loaded.position.tolist() == [0.1 * k for k in range(40) if k % 2]
    assert loaded.time[0] == (10_000_000 + 500) / 1e9
    assert "gripper.effort [Nm]" not in _table(path).headers
    message = refusal(path, columns={"position": "a.position", "reference": "gripper.position"})
    assert_one_sentence(message, path)
    assert "message 0, column 'gripper.position [rad]': messages at this time do not" in message
    with pytest.raises(InputError, match="joints: gripper and a were logged at different times"):
        load_robot(path, ["a", "gripper"])
    robot = load_robot(path, ["bb", "a"])
    assert robot.position[:, 0].tolist() == [-1.0 - k for k in range(40)]
    assert "column 'gripper.position [rad]': messages at this time do not" in refusal(
        path, joint="a", extra={"g": "gripper.position"}
    )


def test_equal_stamps_of_different_joints_are_one_row(tmp_path: Path) -> None:
    states = [
        State(stamp=START + 1_000_000 * k, name=[joint], position=[value + k])
        for k in range(20)
        for joint, value in (("a", 0.0), ("b", 100.0))
    ]
    path = mcap(tmp_path / "run.mcap", sent(states))
    loaded = load(path, columns={"position": "a.position", "reference": "b.position"})
    assert loaded.position.tolist() == [float(k) for k in range(20)]
    assert loaded.reference is not None
    assert loaded.reference.tolist() == [100.0 + k for k in range(20)]
    assert "repeated_messages" not in loaded.metadata


def test_repeated_messages_are_left_out_and_said(tmp_path: Path) -> None:
    states = motion(20, ["a"])
    path = mcap(tmp_path / "run.mcap", sent([*states[:5], states[4], *states[5:], states[-1]]))
    loaded = load(path)
    assert len(loaded) == 20
    assert loaded.metadata["repeated_messages"] == 2


def test_one_stamp_with_two_positions_is_refused(tmp_path: Path) -> None:
    states = motion(20, ["a"])
    other = replace(states[4], position=[9.0])
    path = mcap(tmp_path / "run.mcap", sent([*states[:5], other, *states[5:]]))
    message = refusal(path)
    assert_one_sentence(message, path)
    assert "topic /joint_states, message 5, column 'time [s]'" in message
    assert "time stamps must strictly increase" in message


def test_messages_out_of_order_are_sorted_and_said(tmp_path: Path) -> None:
    states = motion(20, ["a"])
    states[3], states[4] = states[4], states[3]
    loaded = load(mcap(tmp_path / "run.mcap", sent(states)))
    assert loaded.position.tolist() == [state.position[0] for state in motion(20, ["a"])]
    assert loaded.metadata["reordered_messages"] == 1


def test_a_second_run_in_the_file_is_not_mixed_into_the_first(tmp_path: Path) -> None:
    states = [*motion(200, ["a"]), *motion(200, ["a"])]
    path = mcap(tmp_path / "run.mcap", sent(states))
    assert "message 200, column 'time [s]'" in refusal(path)


def test_stamps_that_nobody_filled_are_log_times(tmp_path: Path) -> None:
    states = [
        joint_state(
            "/js", State(stamp=0, name=["a"], position=[float(k)]), late=START + 2_000_000 * k
        )
        for k in range(30)
    ]
    loaded = load(mcap(tmp_path / "run.mcap", states))
    assert loaded.time.tolist() == [k * 2_000_000 / 1e9 for k in range(30)]
    assert loaded.metadata["stamps"] == "log time"


def test_log_times_can_be_chosen(tmp_path: Path) -> None:
    states = [joint_state("/js", state, late=10 * k) for k, state in enumerate(motion(30, ["a"]))]
    path = mcap(tmp_path / "run.mcap", states)
    loaded = load(path, columns={"time": "log_time [s]"})
    assert loaded.time.tolist() == [k * 10_000_010 / 1e9 for k in range(30)]


def test_effort_of_nan_or_nothing_is_no_torque(tmp_path: Path) -> None:
    states = [
        State(stamp=START + 1000 * k, name=["a"], position=[float(k)], effort=[float("nan")])
        for k in range(20)
    ]
    assert load(mcap(tmp_path / "a.mcap", sent(states))).signals == ("time", "position", "velocity")
    states = motion(20, ["a"], effort=False)
    assert load(mcap(tmp_path / "b.mcap", sent(states))).torque is None


def test_some_nan_is_named(tmp_path: Path) -> None:
    states = motion(20, ["a"])
    states[7] = State(
        stamp=states[7].stamp, name=["a"], position=[0.0], velocity=[0.0], effort=[float("nan")]
    )
    path = mcap(tmp_path / "run.mcap", sent(states))
    assert "topic /joint_states, message 7, column 'effort [Nm]': torque is nan" in refusal(path)


def test_joints_without_names_are_numbered(tmp_path: Path) -> None:
    states = [State(stamp=START + 1000 * k, name=[], position=[float(k), 1.0]) for k in range(20)]
    assert _table(mcap(tmp_path / "run.mcap", sent(states))).headers[2:] == (
        *("joint_1.position [rad]", "joint_2.position [rad]"),
    )


# --- Other messages with joints ---


def test_a_controllers_state(tmp_path: Path) -> None:
    from message_files import typestore
    from rosbags.typesys import get_types_from_msg

    store = typestore()
    store.register(
        get_types_from_msg(
            "std_msgs/Header header\nstring[] joint_names\n"
            "trajectory_msgs/JointTrajectoryPoint reference\n"
            "trajectory_msgs/JointTrajectoryPoint feedback\n"
            "trajectory_msgs/JointTrajectoryPoint error\n",
            "control_msgs/msg/JointTrajectoryControllerState",
        )
    )

    def value(k: int) -> Any:
        def made(types: Any) -> Any:
            t = store.types
            time = t["builtin_interfaces/msg/Time"](*divmod(START + 1_000_000 * k, 10**9))
            spent = t["builtin_interfaces/msg/Duration"](0, 0)
            point = t["trajectory_msgs/msg/JointTrajectoryPoint"]
            nothing = np.array([])
            return t["control_msgs/msg/JointTrajectoryControllerState"](
                t["std_msgs/msg/Header"](time, ""),
                ["a", "b"],
                point(np.array([k, 2.0 * k]), np.array([1.0, 2.0]), nothing, nothing, spent),
                point(np.array([k - 0.5, 2.0 * k]), np.array([1.0, 2.0]), nothing, nothing, spent),
                point(np.array([0.5, 0.0]), nothing, nothing, nothing, spent),
            )

        return made

    kind = "control_msgs/msg/JointTrajectoryControllerState"
    path = mcap(
        tmp_path / "run.mcap",
        [Sent(topic="/c/state", kind=kind, log_time=START + k, value=value(k)) for k in range(20)],
        store=store,
    )
    loaded = load(path, columns={"position": "a.position", "reference": "a.reference"})
    assert loaded.position.tolist() == [k - 0.5 for k in range(20)]
    assert loaded.reference is not None
    assert loaded.reference.tolist() == [float(k) for k in range(20)]


def test_dynamic_joint_states_in_json(tmp_path: Path) -> None:
    states = [
        Sent(
            topic="/dynamic_joint_states",
            kind="control_msgs/msg/DynamicJointState",
            log_time=START,
            value={
                "header": {"stamp": {"sec": 5, "nanosec": 1000 * k}},
                "joint_names": ["a"],
                "interface_values": [
                    {"interface_names": ["position", "motor_temperature"], "values": [k, 30.5]}
                ],
            },
        )
        for k in range(20)
    ]
    path = mcap(tmp_path / "run.mcap", states, encoding="json")
    assert _table(path).headers[2:] == ("position [rad]", "motor_temperature")
    assert load(path).position.tolist() == [float(k) for k in range(20)]


# --- Long logs ---


@pytest.mark.parametrize(
    ("joints", "most"), [pytest.param(1, 3.0, marks=pytest.mark.slow), (7, 2.5)]
)
def test_a_long_log_takes_few_times_the_memory_of_its_arrays(
    joints: int, most: float, repo: Path, tmp_path: Path
) -> None:
    benchmark = runpy.run_path(str(repo / "benchmarks" / "message_logs.py"))
    messages = 200_000 // joints
    path = benchmark["written"](tmp_path / "run.mcap", messages, joints)
    few = benchmark["written"](tmp_path / "few.mcap", 20, joints)
    joint = 1 if joints > 1 else None
    load(few, joint=joint)  # imports are not counted
    tracemalloc.start()
    try:
        loaded = load(path, joint=joint)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert len(loaded) == messages
    assert peak < most * 8 * messages * (1 + 3 * joints)


def test_loading_can_be_interrupted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C between two batches of messages ends it at once, as itself."""
    path = mcap(tmp_path / "run.mcap", sent(motion(50, ["a"])))
    read = []

    def interrupted(self: BinaryDecoder, batch: Any, first: int) -> Any:
        read.append(first)
        raise KeyboardInterrupt

    monkeypatch.setattr(BinaryDecoder, "decode", interrupted)
    with pytest.raises(KeyboardInterrupt):
        load(path)
    assert read == [0]
