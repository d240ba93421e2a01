"""ROS 2 bags of a recorder that was killed, and tables that hold more than their file."""

import shutil
import signal
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from message_files import joint_state, motion, ros2_bag
from recording_files import refused

import jointid as jid
from jointid.recording.messages.sqlite_file import SqliteFile
from jointid.recording.messages.sqlite_tables import check_tables

pytest.importorskip("rosbags")
_COUNT = 40


@pytest.fixture
def bag(tmp_path: Path) -> Path:
    sent = [joint_state("/joint_states", each) for each in motion(_COUNT, ["a"])]
    (path,) = ros2_bag(tmp_path / "bag", sent).glob("*.db3")
    return path


def _copied(path: Path, folder: Path, *endings: str) -> Path:
    folder.mkdir()
    for ending in ("", *endings):
        shutil.copyfile(f"{path}{ending}", folder / f"{path.name}{ending}")
    return folder / path.name


def _killed(path: Path, folder: Path, last: int) -> Path:
    """Copy a bag whose last messages are still in SQLite's write-ahead log."""
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        rows = connection.execute(
            "SELECT * FROM messages ORDER BY timestamp DESC LIMIT ?", (last,)
        ).fetchall()
        connection.executemany("DELETE FROM messages WHERE id = ?", [row[:1] for row in rows])
        connection.execute("PRAGMA journal_mode = WAL")
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        connection.execute("PRAGMA wal_autocheckpoint = 0")
        for row in reversed(rows):
            connection.execute("INSERT INTO messages VALUES (?, ?, ?, ?)", row)
        return _copied(path, folder, "-wal")


def _unfinished(path: Path, folder: Path) -> Path:
    """Copy a bag with the journal of a write that is not finished."""
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA cache_size = 1")
        connection.execute("BEGIN")
        connection.execute(
            "INSERT INTO messages SELECT id + 100, topic_id, timestamp, data FROM messages"
        )
        connection.execute("UPDATE messages SET timestamp = timestamp + 1")
        return _copied(path, folder, "-journal")


def _contents(folder: Path) -> dict[str, bytes]:
    return {each.name: each.read_bytes() for each in folder.iterdir()}


def _said(path: Path) -> object:
    return jid.load(path).metadata.get("incomplete")


def test_messages_in_a_log_are_said_with_the_way_to_them(bag: Path, tmp_path: Path) -> None:
    path = _killed(bag, tmp_path / "killed", 15)
    before = _contents(path.parent)
    recording = jid.load(path)
    assert len(recording) == _COUNT - 15
    said = recording.metadata["incomplete"]
    assert said == (
        f"its last messages may be in {path.name}-wal, which is not read. "
        "To merge the two files, copy both and open the copied bag with SQLite"
    )
    assert _contents(path.parent) == before
    copy = _copied(path, tmp_path / "whole", "-wal")
    with closing(sqlite3.connect(copy)) as connection:  # as docs/logs.md says
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert len(jid.load(copy)) == _COUNT
    assert _said(copy) is None


def test_a_log_with_all_messages_is_named_in_the_error(bag: Path, tmp_path: Path) -> None:
    path = _killed(bag, tmp_path / "killed", _COUNT)
    assert f"its last messages may be in {path.name}-wal" in refused(path)
    path.write_bytes(path.read_bytes()[:1000])
    said = refused(path)
    assert "is not a ROS 2 bag in SQLite, or is damaged" in said
    assert f"its last messages may be in {path.name}-wal" in said


def test_a_log_beside_the_file_that_a_link_names(bag: Path, tmp_path: Path) -> None:
    path = _killed(bag, tmp_path / "killed", 15)
    link = tmp_path / "link.db3"
    link.symlink_to(path)
    assert f"{path.name}-wal" in str(_said(link))


def test_an_unfinished_write_is_said(bag: Path, tmp_path: Path) -> None:
    path = _unfinished(bag, tmp_path / "unfinished")
    before = _contents(path.parent)
    assert _said(path) == (
        f"its last write was not finished; jointid does not restore the earlier content from {path.name}-journal"
    )
    assert _contents(path.parent) == before


@pytest.mark.parametrize(
    ("ending", "content"), [("wal", b""), ("journal", b""), ("journal", bytes(512))]
)
def test_what_is_kept_empty_is_no_fault(ending: str, content: bytes, bag: Path) -> None:
    bag.with_name(f"{bag.name}-{ending}").write_bytes(content)
    assert _said(bag) is None


def test_a_folder_beside_a_bag_is_no_fault(bag: Path) -> None:
    bag.with_name(f"{bag.name}-journal").mkdir()
    assert _said(bag) is None


@pytest.fixture
def interrupted(bag: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Send SIGINT while SQLite works: what a callback raises, it hides."""
    ends = SqliteFile._ends

    def at_once(self: SqliteFile, steps: Iterator[int]) -> bool:
        signal.raise_signal(signal.SIGINT)
        return ends(self, steps)

    monkeypatch.setattr("jointid.recording.messages.sqlite_file._STEPS_AT_ONCE", 10)
    monkeypatch.setattr(SqliteFile, "_ends", at_once)
    return bag


def test_ctrl_c_while_sqlite_works(interrupted: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        jid.load(interrupted)


def _behind(path: Path, value: bytes | str, count: int, column: str = '"a""b"') -> Path:
    """Write a bag whose rows begin with another column."""
    with closing(sqlite3.connect(path)) as connection:
        connection.execute(
            "CREATE TABLE topics (id INTEGER PRIMARY KEY, name, type, serialization_format)"
        )
        connection.execute(
            "INSERT INTO topics VALUES (1, '/a', 'sensor_msgs/msg/JointState', 'cdr')"
        )
        connection.execute(f"CREATE TABLE messages ({column}, topic_id, timestamp, data)")
        connection.executemany(
            "INSERT INTO messages VALUES (?, 1, ?, x'0001')",
            ((f"{k}{value}" if isinstance(value, str) else value, k) for k in range(count)),
        )
        connection.commit()
    return path


def _many_rows_of_few_pages(path: Path) -> None:
    """Let a table's first page name a copy of itself at each place."""
    with closing(sqlite3.connect(path)) as connection:
        ((root,), (page,)) = (
            connection.execute(each).fetchone()
            for each in (
                "SELECT rootpage FROM sqlite_master WHERE name = 'messages'",
                "PRAGMA page_size",
            )
        )
    content = bytearray(path.read_bytes())
    start = (root - 1) * page
    first = content[start : start + page]
    assert first[0] == 5  # an inner page
    copy = (len(content) // page + 1).to_bytes(4, "big")
    for k in range(int.from_bytes(first[3:5], "big")):
        cell = start + int.from_bytes(first[12 + 2 * k : 14 + 2 * k], "big")
        content[cell : cell + 4] = copy
    content[28:32] = copy  # the number of pages
    path.write_bytes(content + first)


@pytest.mark.parametrize("value", [bytes(3000), "a" * 3000, "\0" * 3000])
def test_columns_that_hold_more_than_the_file(value: bytes | str, tmp_path: Path) -> None:
    path = _behind(tmp_path / "a.db3", value, 200)
    _many_rows_of_few_pages(path)
    said = refused(path)
    assert 'column "a""b" of messages, before \'timestamp\', holds more bytes than the file' in said


def test_a_column_of_little_before_the_topic(tmp_path: Path) -> None:
    for number, value in enumerate((b"few", 7, "\0a text")):
        path = _behind(tmp_path / f"{number}.db3", value, 20)  # type: ignore[arg-type]
        assert "holds more" not in refused(path)


@pytest.mark.parametrize("key", ["id INTEGER PRIMARY KEY DESC", "id INT PRIMARY KEY", "id TEXT"])
def test_a_key_that_is_no_row_number_may_hold_anything(key: str, tmp_path: Path) -> None:
    path = _behind(tmp_path / "a.db3", "a" * 3000, 200, key)
    _many_rows_of_few_pages(path)
    assert 'column "id" of messages, before' in refused(path)


def test_a_row_number_is_not_looked_through(bag: Path) -> None:
    asked: list[str] = []
    with closing(SqliteFile(bag).connected()) as connection:
        connection.set_trace_callback(asked.append)
        check_tables(connection, bag.stat().st_size)
    assert not [each for each in asked if "typeof" in each]


def _with_views(path: Path, name: str, text: str, count: int) -> Path:
    """Add views to a bag."""
    with closing(sqlite3.connect(path, isolation_level=None)) as connection:
        connection.execute("PRAGMA writable_schema = ON")
        connection.executemany(
            "INSERT INTO sqlite_master VALUES ('view', ?, ?, 0, ?)",
            [
                (f"{name}{k}", f"{name}{k}", f"CREATE VIEW {name}{k} AS {text}")
                for k in range(count)
            ],
        )
    return path


def test_a_schema_of_many_statements_or_long_ones(bag: Path) -> None:
    """SQLite makes 50 times as much of a statement, before a table is asked for."""
    copy = _copied(bag, bag.parent / "long")
    many = _with_views(bag, "v", "SELECT 1", 20)
    jid.load(many)
    _with_views(many, "w", "SELECT 1", 300)
    assert "interrupted" in refused(many)
    long = _with_views(copy, "v", f"SELECT {'1,' * 15_000}1", 1)
    assert "malformed database schema" in refused(long)
