"""Small logs of messages of which much would be made: each is refused at a limit, in one sentence and in little time.

Each is far larger than its limit and still small enough to be read where the limit is missing.
"""

import bz2
import sqlite3
import struct
import tracemalloc
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from recording_files import refused

import jointid as jid
from jointid.base import unpacking
from jointid.recording.file_remarks import remarks
from jointid.recording.messages import companions, ros2_source, rows
from jointid.recording.messages.collecting import Collected
from jointid.recording.messages.decoding import Block
from jointid.recording.messages.mcap_source import McapSource
from jointid.recording.messages.rows import rows_of


def _field(name: bytes, value: bytes) -> bytes:
    return struct.pack("<I", len(name) + 1 + len(value)) + name + b"=" + value


def _record(header: bytes, body: bytes) -> bytes:
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(body)) + body


def _connection(number: int, definition: bytes) -> bytes:
    about = _field(b"type", b"x/JointState") + _field(b"message_definition", definition)
    start = _field(b"op", b"\7") + _field(b"conn", struct.pack("<I", number))
    return _record(start + _field(b"topic", b"/j"), about + _field(b"topic", b"/j"))


def _bag(path: Path, definition: bytes, message: bytes, connections: int = 1) -> Path:
    body = b"".join(_connection(number, definition) for number in range(connections))
    start = _field(b"op", b"\2") + _field(b"conn", bytes(4))
    for second in range(3):
        body += _record(start + _field(b"time", struct.pack("<II", second, 0)), message)
    chunk = _field(b"op", b"\5") + _field(b"compression", b"bz2")
    path.write_bytes(b"#ROSBAG V2.0\n" + _record(chunk, bz2.compress(body)))
    return path


def _nested(count: int, depth: int, innermost: bytes) -> bytes:
    text = b"E0[%d] a" % count
    for level in range(depth):
        text += b"\n%s\nMSG: x/E%d\nE%d[%d] a" % (b"=" * 80, level, level + 1, count)
    return text + b"\n%s\nMSG: x/E%d\n%s" % (b"=" * 80, depth, innermost)


@pytest.mark.parametrize(
    ("definition", "message", "expected"),
    [
        (_nested(40, 3, b""), bytes(100), "it states more elements than it has bytes"),
        (_nested(100, 1, b"uint8 b"), bytes(10_000), "it holds more than 8192 numbers"),
        (
            b"string[] name\nfloat64[] position\n",
            struct.pack("<I", 9000) + bytes(4 * 9000 + 4),
            "it holds more than 8192 texts",
        ),
        (b"uint8 a\n" * 25_001, b"\1", "is longer than 200000 characters"),
    ],
)
def test_what_a_message_may_hold(
    definition: bytes, message: bytes, expected: str, tmp_path: Path
) -> None:
    pytest.importorskip("rosbags")
    assert expected in refused(_bag(tmp_path / "a.bag", definition, message))


def test_a_bag_of_many_connections(tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    path = _bag(tmp_path / "a.bag", b"uint8 a\n", b"\1", 10_001)
    assert "it has more than 10000 connections" in refused(path)


def _state(name: bytes) -> bytes:
    """A sensor_msgs/JointState with one position, in CDR; the name has five letters."""
    text = struct.pack("<I", len(name) + 1) + name + b"\0"
    head = struct.pack("<iII", 1, 0, 1) + b"\0" + bytes(3)
    names = struct.pack("<I", 1) + text
    body = head + names
    body += bytes(-len(body) % 4) + struct.pack("<I", 1)
    body += bytes(-len(body) % 8) + struct.pack("<d", 0.5) + bytes(8)
    return b"\0\1\0\0" + body


_TABLES = {
    "topics": "CREATE TABLE topics(id, name, type, serialization_format)",
    "messages": "CREATE TABLE messages(topic_id, timestamp, data)",
}


def _db3(path: Path, rows: list[bytes], **other: str) -> Path:
    connection = sqlite3.connect(path)
    for command in (_TABLES | other).values():
        connection.execute(command)
    if "topics" not in other:
        kind = "sensor_msgs/msg/JointState"
        connection.execute("INSERT INTO topics VALUES (1, '/j', ?, 'cdr')", (kind,))
    for row in enumerate(rows):
        connection.execute("INSERT INTO messages VALUES (1, ?, ?)", row)
    connection.commit()
    connection.close()
    return path


def _has_fts4() -> bool:
    with closing(sqlite3.connect(":memory:")) as connection:
        options = connection.execute("PRAGMA compile_options").fetchall()
    return ("ENABLE_FTS4",) in options or ("ENABLE_FTS3",) in options


def test_another_name_in_each_message(tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    path = _db3(tmp_path / "a.db3", [_state(b"n%04d" % k) for k in range(100)])
    assert "fields of numbers" not in refused(path)
    path = _db3(tmp_path / "b.db3", [_state(b"n%05d" % k) for k in range(12_000)])
    assert "its messages hold more than 10000 fields of numbers" in refused(path)


@pytest.mark.parametrize("name", ["topics", "messages", "message_definitions"])
@pytest.mark.parametrize("how", ["view", "trigger", "computed", "virtual"])
def test_tables_that_make_their_rows(name: str, how: str, tmp_path: Path) -> None:
    """A view without an end, a computed column of any size, a table of an extension."""
    pytest.importorskip("rosbags")
    command = {
        "view": f"CREATE VIEW {name} AS SELECT 1 AS id, zeroblob(9) AS data",
        "trigger": f"CREATE VIEW {name} AS SELECT 1 AS id, zeroblob(9) AS data",
        "computed": f"CREATE TABLE {name}(id, data GENERATED ALWAYS AS (zeroblob(9)) VIRTUAL)",
        "virtual": f"CREATE VIRTUAL TABLE {name} USING fts4(id, data)",
    }[how]
    more = {}
    if how == "trigger":  # has the name of the view that it belongs to
        command = command.replace(name, name.title())
        does = f"CREATE TRIGGER {name} INSTEAD OF INSERT ON {name} BEGIN SELECT 1; END"
        more = {"trigger": does}
    if how == "virtual" and not _has_fts4():
        pytest.skip("SQLite has no FTS4 here")
    path = _db3(tmp_path / "a.db3", [], **{name: command}, **more)
    assert f"it is not a ROS 2 bag: {name} is not a plain table" in refused(path)


def test_plain_messages_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Rows may share the pages of one message."""
    pytest.importorskip("rosbags")
    monkeypatch.setattr(unpacking, "LEAST", 100)
    monkeypatch.setattr(unpacking, "TIMES", 0)
    path = _db3(tmp_path / "a.db3", [_state(b"elbow")] * 3)
    assert "unpacked file is larger than" in refused(path)


def test_pages_that_name_each_other(tmp_path: Path) -> None:
    """Rows of a B-tree whose inner pages all have one child, a few of which have no end that anybody waits for."""
    pytest.importorskip("rosbags")
    for table, expected in (("messages", "interrupted"), ("topics", "more than 10000 topics")):
        path = _db3(tmp_path / f"{table}.db3", [_state(b"elbow")] * 20)
        connection = sqlite3.connect(path)
        (root,) = connection.execute(
            "SELECT rootpage FROM sqlite_master WHERE name = ?", (table,)
        ).fetchone()
        (size,) = connection.execute("PRAGMA page_size").fetchone()
        connection.close()
        content = bytearray(path.read_bytes())
        place = slice((root - 1) * size, root * size)
        pages, child = [bytes(content[place])], len(content) // size + 1
        for _ in range(3):
            pages.append(_page_of_one_child(child, size))
            child += 1
        content[place] = _page_of_one_child(child, size)
        content += b"".join(pages)
        struct.pack_into(">I", content, 28, len(content) // size)
        path.write_bytes(content)
        assert expected in refused(path)


def _page_of_one_child(child: int, size: int) -> bytes:
    count = 500
    page = bytearray(size)
    struct.pack_into(">BxxHHxI", page, 0, 5, count, size - 5 * count, child)
    for k in range(count):
        place = size - 5 * (k + 1)
        struct.pack_into(">IB", page, place, child, 5)
        struct.pack_into(">H", page, 12 + 2 * k, place)
    return bytes(page)


@pytest.mark.parametrize("name", ["topics", "messages", "message_definitions"])
def test_long_defaults(name: str, tmp_path: Path) -> None:
    """A column that is added later stands in each row before, of which a file holds five bytes."""
    pytest.importorskip("rosbags")
    definitions = "CREATE TABLE message_definitions(topic_type, encoding)"
    path = _db3(tmp_path / "a.db3", [_state(b"elbow")] * 20, message_definitions=definitions)
    connection = sqlite3.connect(path)
    connection.execute(f"ALTER TABLE {name} ADD COLUMN note DEFAULT 'short'")
    connection.execute(f"ALTER TABLE {name} ADD COLUMN other DEFAULT 1")
    connection.commit()
    assert "not a plain table" not in refused(path)
    connection.execute(f"ALTER TABLE {name} ADD COLUMN text DEFAULT '{'x' * 1001}'")
    connection.commit()
    connection.close()
    assert f"a column of {name} has a default of more than 1000 characters" in refused(path)


@pytest.mark.parametrize("indexed", [True, False])
def test_rows_are_sorted_by_their_numbers(
    indexed: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What SQLite sorts goes to the disk, where no limit of ours counts it."""
    pytest.importorskip("rosbags")
    path = _db3(tmp_path / "a.db3", [b"\0\1\0\0" + bytes([k]) for k in range(20)])
    connection = sqlite3.connect(path)
    connection.execute("UPDATE messages SET timestamp = (timestamp * 7) % 20")
    connection.execute("INSERT INTO messages VALUES ('1', 5, 'of another topic')")
    connection.execute("INSERT INTO messages VALUES (2, 5, 'of another topic')")
    if indexed:
        connection.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    connection.commit()
    connection.close()
    asked: list[str] = []
    source = ros2_source.SqliteSource(path)
    connected = source._file.connected
    assert source.topics[0].count == 20

    def traced() -> sqlite3.Connection:
        connection = connected()
        connection.set_trace_callback(asked.append)
        return connection

    monkeypatch.setattr(source._file, "connected", traced)
    source._topics()
    found = list(source.messages(source.topics[0]))
    assert found == [(k, b"\0\1\0\0" + bytes([3 * k % 20])) for k in range(20)]
    sorting = [each for each in asked if "ORDER BY" in each and "EXPLAIN" not in each]
    assert [", data FROM" in each for each in sorting] == [indexed]
    grouping = [each for each in asked if "GROUP BY" in each]
    assert len(grouping) == 1
    assert all("typeof(topic_id) IN ('integer', 'real')" in each for each in sorting + grouping)


@pytest.mark.parametrize(
    ("time", "data"), [("'noon'", "x'00'"), ("NULL", "x'00'"), ("3", "'text'"), ("3", "NULL")]
)
def test_a_row_that_is_no_message(time: str, data: str, tmp_path: Path) -> None:
    pytest.importorskip("rosbags")
    path = _db3(tmp_path / "a.db3", [_state(b"elbow")] * 20)
    connection = sqlite3.connect(path)
    connection.execute(f"INSERT INTO messages VALUES (1, {time}, {data})")
    connection.commit()
    connection.close()
    assert "it is damaged (a row holds no message)" in refused(path)


def _mcap_record(kind: int, body: bytes) -> bytes:
    return struct.pack("<BQ", kind, len(body)) + body


def _text(text: str) -> bytes:
    return struct.pack("<I", len(text)) + text.encode()


def _schema(number: int, kind: str, definition: str) -> bytes:
    texts = _text(kind) + _text("ros2msg") + _text(definition)
    return _mcap_record(3, struct.pack("<H", number) + texts)


def _channel(number: int, schema: int, topic: str) -> bytes:
    return _mcap_record(
        4, struct.pack("<HH", number, schema) + _text(topic) + _text("cdr") + bytes(4)
    )


def _message(channel: int, time: int, data: bytes) -> bytes:
    return _mcap_record(5, struct.pack("<HIQQ", channel, 0, time, time) + data)


def _mcap(path: Path, body: bytes, summary: bytes = b"") -> Path:
    pytest.importorskip("mcap")
    magic = b"\x89MCAP0\r\n"
    start = magic + _mcap_record(1, bytes(8)) + body + _mcap_record(15, bytes(4))
    footer = _mcap_record(2, struct.pack("<QQI", len(start) if summary else 0, 0, 0))
    path.write_bytes(start + summary + footer + magic)
    return path


_STATE = "sensor_msgs/msg/JointState"


def test_channels_with_one_schema_share_its_text(tmp_path: Path) -> None:
    body = _schema(1, _STATE, "float64 a  # " + "x" * 1000)
    body += b"".join(_channel(number, 1, f"/{number}") for number in range(1, 20))
    topics = McapSource(_mcap(tmp_path / "a.mcap", body)).topics
    assert len(topics) == 19
    assert len({id(topic.definition) for topic in topics}) == 1


def test_entries_that_name_one_chunk_are_counted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(unpacking, "LEAST", 100_000)
    monkeypatch.setattr(unpacking, "TIMES", 0)
    messages = b"".join(_message(1, time, _state(b"elbow")) for time in range(100))
    about = struct.pack("<QQQI", 0, 0, len(messages), 0) + _text("")
    chunk = _mcap_record(6, about + struct.pack("<Q", len(messages)) + messages)
    place = 8 + 9 + 8
    entry = struct.pack("<QQQQ", 0, 0, place, len(chunk)) + bytes(12) + _text("")
    entry = _mcap_record(8, entry + struct.pack("<QQ", len(messages), len(messages)))
    described = _schema(1, _STATE, "") + _channel(1, 1, "/j")
    once = _mcap(tmp_path / "a.mcap", chunk, described + entry)
    assert "larger than" not in refused(once)  # all have one stamp
    assert "unpacked file is larger than" in refused(
        _mcap(tmp_path / "b.mcap", chunk, described + entry * 30)
    )


def test_so_many_topics_are_compared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(companions, "_MOST_TOPICS", 3)
    body = _schema(1, _STATE, "") + _schema(2, "a/msg/B", "std_msgs/Header header\nfloat64 c")
    body += _channel(1, 1, "/j")
    body += b"".join(_channel(number, 2, f"/{number}") for number in range(2, 8))
    for time in range(1, 21):
        state = _state(b"elbow")
        body += _message(1, time, state[:4] + struct.pack("<i", time) + state[8:])
        other = b"\0\1\0\0" + struct.pack("<iII4xd", time, 0, 1, 0.5)
        body += b"".join(_message(number, time, other) for number in range(2, 8))
    path = _mcap(tmp_path / "a.mcap", body)
    recording = jid.load(path, extra={"c": "/4.c"})
    assert recording.metadata["topics_not_compared"] == 3
    assert "3 topics are not compared with the chosen topic" in " ".join(
        remarks(recording.metadata)
    )
    with pytest.raises(jid.InputError, match=r"'/5\.c'"):
        jid.load(path, extra={"c": "/5.c"})
    monkeypatch.setattr(companions, "_MOST_TOPICS", 6)
    assert "topics_not_compared" not in jid.load(path, extra={"c": "/5.c"}).metadata


def _of_one_stamp(count: int, joints: int) -> Collected:
    blocks = tuple(
        Block(
            columns=((f"joint {k % joints}", "position"),),
            messages=np.array([k]),
            values=np.full((1, 1), k % joints + 0.5),
        )
        for k in range(count)
    )
    return Collected(blocks, np.arange(count) // 10 + 1, np.arange(count))


@pytest.mark.parametrize("joints", [3, 7, 10])
def test_messages_of_one_stamp_are_compared_in_parts(
    joints: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    collected = _of_one_stamp(200, joints)
    whole, stamps, _ = rows_of(collected)
    assert whole.row is not None
    assert len(stamps) == 20
    assert whole.repeated == 20 * (10 - joints)
    monkeypatch.setattr(rows, "_CELLS", 25 * joints)
    assert np.array_equal(rows_of(collected)[0].of(np.arange(200)), whole.row)
    monkeypatch.setattr(rows, "_CELLS", 9 * joints)  # not one stamp's messages
    assert len(rows_of(collected)[1]) == 200


def test_messages_of_one_stamp_need_no_table_of_all_joints(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(rows, "_CELLS", 100_000)
    collected = _of_one_stamp(2000, 2000)
    tracemalloc.start()
    found, stamps, _ = rows_of(collected)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(stamps) == 200
    assert found.repeated == 0
    assert peak < 5_000_000  # 36 MB are a table of numbers, and where there are any
