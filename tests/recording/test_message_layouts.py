"""Numbers read from many messages at once are those that rosbags reads from each."""

import contextlib
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from message_files import START, Sent, State, encoded, joint_state, typestore

from jointid.recording.messages.decoding import BinaryDecoder, JsonDecoder
from jointid.recording.messages.topic import DamageError, Topic

pytest.importorskip("rosbags")
KIND = "sensor_msgs/msg/JointState"
STORES = {"cdr": typestore(), "ros1": typestore(ros1=True)}
number = st.floats(width=64)


@st.composite
def states(draw: st.DrawFn) -> State:
    names = draw(
        st.lists(st.sampled_from(["a", "bb", "ccc", "ä", "joint_7"]), unique=True, max_size=4)
    )
    part: st.SearchStrategy[list[float]] = st.just([])
    part |= st.lists(number, min_size=len(names), max_size=len(names))
    return State(
        stamp=draw(st.integers(0, (1 << 31) * 10**9 - 1)),
        name=names,
        position=draw(part) if names else [],
        velocity=draw(part) if names else [],
        effort=draw(part) if names else [],
        frame=draw(st.sampled_from(["", "base", "world_frame"])),
    )


def topic_of(encoding: str, kind: str = KIND) -> Topic:
    text = ""
    if encoding in STORES:
        text, _ = STORES[encoding].generate_msgdef(kind, ros_version=1 if encoding == "ros1" else 2)
    return Topic(name="/js", kind=kind, encoding=encoding, definition=text)


def cells(blocks: Any) -> dict[tuple[int, str, str], float]:
    return {
        (int(message), joint, signal): float(values[k])
        for block in blocks
        for (joint, signal), values in zip(block.columns, block.values, strict=True)
        for k, message in enumerate(block.messages)
    }


@pytest.mark.parametrize("encoding", ["cdr", "ros1", "json"])
@given(logged=st.lists(states(), min_size=1, max_size=12), big=st.booleans())
@settings(deadline=None, max_examples=150)
def test_blocks_are_what_rosbags_reads(encoding: str, logged: list[State], big: bool) -> None:
    store: Any = STORES.get(encoding)
    raws = [encoded(store, joint_state("/js", state), encoding) for state in logged]
    if encoding == "cdr" and big:
        raws = [
            bytes(
                store.serialize_cdr(store.deserialize_cdr(raw, KIND), KIND, little_endian=k % 2 > 0)
            )
            for k, raw in enumerate(raws)
        ]
    make = JsonDecoder if encoding == "json" else BinaryDecoder
    blocks, stamps = make(topic_of(encoding)).decode(raws, 5)
    assert stamps is not None
    expected = {}
    for k, (state, raw) in enumerate(zip(logged, raws, strict=True)):
        if encoding == "json":
            message: Any = state
            assert stamps[k] == state.stamp
        else:
            read = store.deserialize_ros1 if encoding == "ros1" else store.deserialize_cdr
            message = read(raw, KIND)
            assert stamps[k] == message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        for signal in ("position", "velocity", "effort"):
            for joint, value in zip(message.name, getattr(message, signal), strict=False):
                expected[5 + k, joint, signal] = float(value)
    found = cells(blocks)
    assert found.keys() == expected.keys()
    for key, value in expected.items():
        assert np.array_equal(found[key], value, equal_nan=True), key


@given(data=st.data())
@settings(deadline=None, max_examples=200)
def test_damaged_messages_are_read_or_refused(data: st.DataObject) -> None:
    """Never more than a `DamageError`."""
    encoding = data.draw(st.sampled_from(["cdr", "ros1", "json"]))
    state = State(stamp=START, name=["a", "bb"], position=[1.0, 2.0], effort=[3.0, 4.0])
    raw = bytearray(encoded(STORES.get(encoding), joint_state("/js", state), encoding))
    for _ in range(data.draw(st.integers(1, 3))):
        raw[data.draw(st.integers(0, len(raw) - 1))] = data.draw(st.integers(0, 255))
    cut = bytes(raw[: data.draw(st.integers(0, len(raw)))])
    make = JsonDecoder if encoding == "json" else BinaryDecoder
    for message in (bytes(raw), cut):
        with contextlib.suppress(DamageError):
            make(topic_of(encoding)).decode([message], 0)


def test_more_layouts_than_are_kept() -> None:
    """Each message with joints in another order."""
    generator = np.random.default_rng(3)
    names = list("abcdefgh")
    logged = []
    for k in range(300):
        order = generator.permutation(names).tolist()
        logged.append(
            State(stamp=START + k, name=order, position=[float(ord(name) + k) for name in order])
        )
    raws = [encoded(STORES["cdr"], joint_state("/js", state), "cdr") for state in logged]
    blocks, _ = BinaryDecoder(topic_of("cdr")).decode(raws, 0)
    found = cells(blocks)
    assert len(found) == 300 * 8
    assert all(value == ord(joint) + message for (message, joint, _), value in found.items())


@pytest.mark.parametrize(
    ("kind", "make", "columns"),
    [
        (
            "geometry_msgs/msg/WrenchStamped",
            lambda t: t["geometry_msgs/msg/WrenchStamped"](
                t["std_msgs/msg/Header"](t["builtin_interfaces/msg/Time"](5, 6), "tool"),
                t["geometry_msgs/msg/Wrench"](
                    t["geometry_msgs/msg/Vector3"](1.0, 2.0, 3.0),
                    t["geometry_msgs/msg/Vector3"](4.0, 5.0, 6.0),
                ),
            ),
            {"wrench.force.y": 2.0, "wrench.torque.z": 6.0},
        ),
        (
            "std_msgs/msg/Float64MultiArray",
            lambda t: t["std_msgs/msg/Float64MultiArray"](
                t["std_msgs/msg/MultiArrayLayout"](
                    [t["std_msgs/msg/MultiArrayDimension"]("rows", 2, 2)], 0
                ),
                np.array([7.0, 8.0]),
            ),
            {"data.0": 7.0, "data.1": 8.0, "layout.dim.0.size": 2.0},
        ),
        ("std_msgs/msg/Empty", lambda t: t["std_msgs/msg/Empty"](), {}),
    ],
)
def test_plain_messages(kind: str, make: Any, columns: dict[str, float]) -> None:
    store = STORES["cdr"]
    raw = encoded(store, Sent(topic="/x", kind=kind, log_time=1, value=make(store.types)), "cdr")
    blocks, stamps = BinaryDecoder(topic_of("cdr", kind)).decode([raw, raw], 0)
    found = cells(blocks)
    for name, value in columns.items():
        assert found[1, "", name] == value
    assert (stamps is not None) == (kind == "geometry_msgs/msg/WrenchStamped")


def test_a_joint_that_stands_twice_is_refused() -> None:
    state = State(stamp=START, name=["a", "a"], position=[1.0, 2.0])
    raw = encoded(STORES["cdr"], joint_state("/js", state), "cdr")
    with pytest.raises(DamageError, match="message 0: it has the joint 'a' twice"):
        BinaryDecoder(topic_of("cdr")).decode([raw], 0)


def test_more_values_than_joints_are_refused() -> None:
    state = State(stamp=START, name=["a"], position=[1.0, 2.0])
    raw = encoded(STORES["cdr"], joint_state("/js", state), "cdr")
    with pytest.raises(DamageError, match="it has 1 joints, but 2 values of position"):
        BinaryDecoder(topic_of("cdr")).decode([raw], 0)
