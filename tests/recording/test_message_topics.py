"""Which topic of a log of messages is the recording, and which others add columns."""

from pathlib import Path
from typing import Any

import pytest
from message_files import (
    START,
    Sent,
    State,
    distractors,
    in_order,
    joint_state,
    mcap,
    motion,
    ros2_bag,
)
from recording_files import assert_one_sentence, refusal

from jointid.base.errors import InputError
from jointid.recording.readers.loading import load
from jointid.recording.readers.loading import table_of as _table

pytest.importorskip("mcap")
pytest.importorskip("rosbags")


def sent(states: list[State], topic: str = "/joint_states") -> list[Sent]:
    return [joint_state(topic, state) for state in states]


def test_several_topics_with_joints_are_listed_with_the_line_to_paste(tmp_path: Path) -> None:
    both = [*sent(motion(joints=["a"])), *sent(motion(joints=["b"]), "/left/joint_states")]
    path = mcap(tmp_path / "run.mcap", in_order([*both, *distractors()]))
    with pytest.raises(InputError) as caught:
        load(path)
    assert_one_sentence(str(caught.value), path)
    assert "2 topics hold joints: /joint_states (sensor_msgs/msg/JointState), /left/" in str(
        caught.value
    )
    assert "load with topic='/left/joint_states'" in str(caught.value)
    for topic in ("/left/joint_states", "left/joint_states"):
        assert load(path, topic=topic).metadata["topic"] == "/left/joint_states"
    assert "no such topic; did you mean '/joint_states'" in refusal(path, topic="/joint_state")


def test_no_topic_with_joints(tmp_path: Path) -> None:
    path = mcap(tmp_path / "run.mcap", distractors())
    message = refusal(path)
    assert_one_sentence(message, path)
    assert "no topic holds joints" in message
    assert "/temperature (std_msgs/msg/Float64)" in message


def test_topics_without_messages_do_not_count(tmp_path: Path) -> None:
    from mcap.writer import Writer

    path = tmp_path / "run.mcap"
    assert "no topics are found" in refusal(mcap(path, []))
    writer = Writer(str(path))
    writer.start()
    schema = writer.register_schema("sensor_msgs/msg/JointState", "jsonschema", b"{}")
    writer.register_channel("/silent/joint_states", "json", schema)
    channel = writer.register_channel("/joint_states", "json", schema)
    for k in range(20):
        writer.add_message(channel, k, b'{"name": ["a"], "position": [%d]}' % k, k)
    writer.finish()  # type: ignore[no-untyped-call]
    assert load(path).metadata["topic"] == "/joint_states"
    assert "/silent/joint_states: it has no messages" in refusal(path, topic="/silent/joint_states")


def test_a_topic_with_the_same_stamps_adds_columns(tmp_path: Path) -> None:
    """A torque sensor that the same driver publishes; one with other stamps is not interpolated."""
    states = motion(30, ["a"])

    def wrench(stamp: int, value: float) -> Any:
        def made(store: Any) -> Any:
            t = store.types
            header = t["std_msgs/msg/Header"](
                t["builtin_interfaces/msg/Time"](*divmod(stamp, 10**9)), "tool"
            )
            none = t["geometry_msgs/msg/Vector3"](0.0, 0.0, 0.0)
            torque = t["geometry_msgs/msg/Vector3"](0.0, 0.0, value)
            return t["geometry_msgs/msg/WrenchStamped"](
                header, t["geometry_msgs/msg/Wrench"](none, torque)
            )

        return made

    kind = "geometry_msgs/msg/WrenchStamped"
    messages = sent(states)
    for k, state in enumerate(states):
        for topic, late in (("/ft", 0), ("/slow", 1)):
            value = wrench(state.stamp + late, 0.5 * k)
            messages.append(Sent(topic=topic, kind=kind, log_time=state.stamp, value=value))
    for path in (
        mcap(tmp_path / "run.mcap", in_order(messages)),
        ros2_bag(tmp_path / "run", in_order(messages)),
    ):
        headers = _table(path).headers
        assert headers[2:5] == ("position [rad]", "velocity [rad/s]", "effort [Nm]")
        assert "/ft.wrench.torque.z" in headers
        assert not any(header.startswith("/slow") for header in headers)
        loaded = load(path, columns={"sensor": "/ft.wrench.torque.z"}, units={"sensor": "Nm"})
        assert loaded.sensor is not None
        assert loaded.sensor.tolist() == [0.5 * k for k in range(30)]


def test_a_plain_topic_that_was_named(tmp_path: Path) -> None:
    path = mcap(tmp_path / "run.mcap", in_order([*sent(motion()), *distractors()]))
    assert _table(path, topic="/temperature").headers == ("time [s]", "log_time [s]", "data")
    loaded = load(path, topic="temperature", columns={"position": "data"})
    assert loaded.position.tolist() == [20.0 + k for k in range(50)]
    assert loaded.metadata["stamps"] == "log time"


def test_messages_that_are_not_read_are_named(tmp_path: Path) -> None:
    path = mcap(
        tmp_path / "run.mcap",
        [Sent(topic="/js", kind="foxglove.JointStates", log_time=START, value={})],
        encoding="json",
    )
    raw = path.read_bytes().replace(b"\x04\x00\x00\x00json", b"\x04\x00\x00\x00xdr2")
    path.write_bytes(raw)
    error = refusal(path)
    assert "are not read" in error or "damaged" in error


def test_other_formats_have_no_topic(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("t,q\n")
    assert "topic is '/a': .csv files have no topic" in refusal(path, topic="/a")
