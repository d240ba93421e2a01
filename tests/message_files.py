"""Logs of messages for the tests, made by the libraries that robots use."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

JOINT_STATE = "sensor_msgs/msg/JointState"
START = 1_732_262_400_123_456_789  # ns


@dataclass(frozen=True, kw_only=True)
class State:
    """A JointState before it is written."""

    stamp: int
    name: Sequence[str]
    position: Sequence[float]
    velocity: Sequence[float] = ()
    effort: Sequence[float] = ()
    frame: str = "base"


@dataclass(frozen=True, kw_only=True)
class Sent:
    """A message on a topic."""

    topic: str
    kind: str
    log_time: int
    value: Any


def joint_state(topic: str, state: State, late: int = 7_000) -> Sent:
    return Sent(topic=topic, kind=JOINT_STATE, log_time=state.stamp + late, value=state)


def motion(
    count: int = 50, joints: Sequence[str] = ("shoulder", "elbow"), *, effort: bool = True
) -> list[State]:
    """States of a motion, 10 ms apart."""
    number = np.arange(len(joints))
    return [
        State(
            stamp=START + 10_000_000 * k,
            name=list(joints),
            position=(np.sin(0.1 * k + number)).tolist(),
            velocity=(10.0 * np.cos(0.1 * k + number)).tolist(),
            effort=(0.5 * k + number).tolist() if effort else [],
        )
        for k in range(count)
    ]


def distractors(count: int = 50) -> list[Sent]:
    """What else a robot logs: text, a temperature and a picture."""
    found = []
    for k in range(count):
        time = START + 10_000_000 * k + 3_000
        found.append(
            Sent(topic="/rosout", kind="std_msgs/msg/String", log_time=time, value=f"n{k}")
        )
        found.append(
            Sent(topic="/temperature", kind="std_msgs/msg/Float64", log_time=time, value=20.0 + k)
        )
    return found


def typestore(ros1: bool = False) -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.LATEST)


def message_of(store: Any, kind: str, value: Any) -> Any:
    """The message object of a type store."""
    types = store.types
    if isinstance(value, State):
        stamp = types["builtin_interfaces/msg/Time"](*divmod(value.stamp, 1_000_000_000))
        header = types["std_msgs/msg/Header"]
        ros1 = "seq" in header.__dataclass_fields__
        return types[JOINT_STATE](
            header(0, stamp, value.frame) if ros1 else header(stamp, value.frame),
            list(value.name),
            *(
                np.array(part, dtype=float)
                for part in (value.position, value.velocity, value.effort)
            ),
        )
    if isinstance(value, str | float):
        return types[kind](value)
    return value(store) if callable(value) else value


def in_order(messages: Sequence[Sent]) -> list[Sent]:
    return sorted(messages, key=lambda sent: sent.log_time)


def mcap(
    path: Path,
    messages: Sequence[Sent],
    *,
    encoding: str = "cdr",
    store: Any = None,
    **options: Any,
) -> Path:
    """Write an MCAP file; encoding is cdr, ros1 or json."""
    from mcap.writer import Writer

    store = store or typestore(ros1=encoding == "ros1")
    writer = Writer(str(path), **options)
    writer.start(profile="" if encoding == "json" else encoding.replace("cdr", "ros2"))
    channels: dict[tuple[str, str], int] = {}
    for number, sent in enumerate(messages):
        key = sent.topic, sent.kind
        if key not in channels:
            channels[key] = writer.register_channel(
                sent.topic, encoding, _schema(writer, store, sent.kind, encoding)
            )
        writer.add_message(
            channels[key], sent.log_time, encoded(store, sent, encoding), sent.log_time, number
        )
    writer.finish()  # type: ignore[no-untyped-call]
    return path


def _schema(writer: Any, store: Any, kind: str, encoding: str) -> int:
    if encoding == "json":
        return int(writer.register_schema(kind, "jsonschema", b'{"type": "object"}'))
    if encoding == "protobuf":
        return int(writer.register_schema(kind, "protobuf", b""))
    text, _ = store.generate_msgdef(kind, ros_version=1 if encoding == "ros1" else 2)
    ros1 = encoding == "ros1"
    name = kind.replace("/msg/", "/") if ros1 else kind
    return int(writer.register_schema(name, "ros1msg" if ros1 else "ros2msg", text.encode()))


def encoded(store: Any, sent: Sent, encoding: str) -> bytes:
    if encoding == "json":
        value = sent.value
        if isinstance(value, State):
            sec, nsec = divmod(value.stamp, 1_000_000_000)
            value = {
                "header": {"stamp": {"sec": sec, "nsec": nsec}, "frame_id": value.frame},
                "name": list(value.name),
                "position": list(value.position),
                "velocity": list(value.velocity),
                "effort": list(value.effort),
            }
        elif not isinstance(value, dict):
            value = {"data": value}
        return json.dumps(value).encode()
    message = message_of(store, sent.kind, sent.value)
    write: Callable[..., Any] = store.serialize_ros1 if encoding == "ros1" else store.serialize_cdr
    return bytes(write(message, sent.kind))


def ros2_bag(
    folder: Path, messages: Sequence[Sent], *, storage: str = "SQLITE3", mode: str = "NONE"
) -> Path:
    """Write a ROS 2 bag, a folder."""
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

    store = typestore()
    writer = Writer(folder, version=9, storage_plugin=StoragePlugin[storage])
    writer.set_compression(CompressionMode[mode], CompressionFormat.ZSTD)
    with writer:
        topics: dict[str, Any] = {}
        for sent in messages:
            if sent.topic not in topics:
                topics[sent.topic] = writer.add_connection(sent.topic, sent.kind, typestore=store)
            writer.write(topics[sent.topic], sent.log_time, encoded(store, sent, "cdr"))
    return folder


def ros1_bag(
    path: Path, messages: Sequence[Sent], *, compression: str = "", chunk: int = 1 << 20
) -> Path:
    """Write a ROS 1 bag."""
    from rosbags.rosbag1 import Writer

    store = typestore(ros1=True)
    writer = Writer(path)
    writer.chunk_threshold = chunk
    if compression:
        writer.set_compression(Writer.CompressionFormat[compression])
    with writer:
        topics: dict[str, Any] = {}
        for sent in messages:
            if sent.topic not in topics:
                topics[sent.topic] = writer.add_connection(sent.topic, sent.kind, typestore=store)
            writer.write(topics[sent.topic], sent.log_time, encoded(store, sent, "ros1"))
    return path


FORMS: dict[str, Callable[[Path, Sequence[Sent]], Path]] = {
    "mcap": lambda folder, sent: mcap(folder / "run.mcap", sent),
    "mcap in ROS 1": lambda folder, sent: mcap(folder / "run.mcap", sent, encoding="ros1"),
    "mcap in JSON": lambda folder, sent: mcap(folder / "run.mcap", sent, encoding="json"),
    "mcap without chunks": lambda folder, sent: mcap(folder / "run.mcap", sent, use_chunking=False),
    "mcap without index": lambda folder, sent: mcap(
        folder / "run.mcap", sent, use_statistics=False, repeat_channels=False, repeat_schemas=False
    ),
    "ROS 2 in SQLite": lambda folder, sent: ros2_bag(folder / "run", sent),
    "ROS 2 in SQLite, compressed messages": lambda folder, sent: ros2_bag(
        folder / "run", sent, mode="MESSAGE"
    ),
    "ROS 2 in SQLite, compressed files": lambda folder, sent: ros2_bag(
        folder / "run", sent, mode="FILE"
    ),
    "ROS 2 in MCAP": lambda folder, sent: ros2_bag(folder / "run", sent, storage="MCAP"),
    "one .db3": lambda folder, sent: next(ros2_bag(folder / "run", sent).glob("*.db3")).rename(
        folder / "run.db3"
    ),
    "ROS 1": lambda folder, sent: ros1_bag(folder / "run.bag", sent),
    "ROS 1, bz2": lambda folder, sent: ros1_bag(folder / "run.bag", sent, compression="BZ2"),
    "ROS 1, lz4": lambda folder, sent: ros1_bag(folder / "run.bag", sent, compression="LZ4"),
}
"""Each form of log, by its name."""
