"""Memory and time to load a log of JointState messages.

    python benchmarks/message_logs.py --messages 1000000 --joints 1

writes an MCAP file (zstd, chunks of 1 MiB) of JointState messages with position, velocity and effort, loads it and
prints the time, and the peak of the memory that Python and numpy allocate, as multiples of the arrays that
the result holds.
"""

import argparse
import struct
import tempfile
import time
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import jointid as jid

_KIND = "sensor_msgs/msg/JointState"
_START = 1_732_262_400_123_456_789


def written(path: Path, messages: int, joints: int) -> Path:
    """Write the file: the same message repeatedly, with other numbers."""
    from mcap.writer import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.LATEST)
    types: Any = store.types
    text, _ = store.generate_msgdef(_KIND, ros_version=2)
    writer = Writer(str(path))
    writer.start(profile="ros2")
    schema = writer.register_schema(_KIND, "ros2msg", text.encode())
    channel = writer.register_channel("/joint_states", "cdr", schema)
    marks = np.arange(3.0 * joints) + 0.123
    header = types["std_msgs/msg/Header"](types["builtin_interfaces/msg/Time"](0, 0), "base")
    names = [f"joint_{k}" for k in range(1, joints + 1)]
    message = types[_KIND](header, names, *np.split(marks, 3))
    raw = bytearray(store.serialize_cdr(message, _KIND))
    places = [raw.index(struct.pack("<d", mark)) for mark in marks[::joints]]
    size = 8 * joints
    phase = np.arange(3 * joints)
    for k in range(messages):
        stamp = _START + 1_000_000 * k
        struct.pack_into("<iI", raw, 4, *divmod(stamp, 1_000_000_000))
        numbers = np.sin(0.001 * k + phase).tobytes()
        for part, place in enumerate(places):
            raw[place : place + size] = numbers[part * size : (part + 1) * size]
        writer.add_message(channel, stamp + 5_000, bytes(raw), stamp)
    writer.finish()  # type: ignore[no-untyped-call]
    return path


def main() -> None:
    """Write the logs, load them, and print memory and time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--messages", type=int, default=1_000_000)
    parser.add_argument("--joints", type=int, default=1)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        path = written(Path(folder, "run.mcap"), arguments.messages, arguments.joints)
        few = written(Path(folder, "few.mcap"), 20, arguments.joints)
        jid.load(few, joint=1 if arguments.joints > 1 else None)  # imports are not counted
        ways: dict[str, Callable[[], object]] = {
            "one joint": lambda: jid.load(path, joint=1 if arguments.joints > 1 else None)
        }
        if arguments.joints > 1:
            ways["all joints"] = lambda: jid.load_robot(path)
        for name, load in ways.items():
            start = time.perf_counter()
            load()
            taken = time.perf_counter() - start
            tracemalloc.start()
            load()
            _, peak = tracemalloc.get_traced_memory()
            tracemalloc.stop()
            topic = 8 * arguments.messages * (1 + 3 * arguments.joints)
            print(
                f"{name}: {taken:.1f} s, peak {peak / 1e6:.0f} MB, "
                f"{peak / topic:.2f} times the arrays of the topic ({topic / 1e6:.0f} MB)"
            )


if __name__ == "__main__":
    main()
