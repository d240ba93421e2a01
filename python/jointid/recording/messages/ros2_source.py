"""ROS 2 bags: a .db3 file (SQLite), and a folder of .db3 or .mcap files."""

import re
import shutil
import sqlite3
import weakref
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from jointid.base.error_text import reason_of
from jointid.base.unpacking import Room
from jointid.recording.messages.definitions import normal_kind
from jointid.recording.messages.mcap_source import McapSource
from jointid.recording.messages.packed import of_zstandard
from jointid.recording.messages.sqlite_file import SqliteFile
from jointid.recording.messages.sqlite_tables import check_tables
from jointid.recording.messages.topic import DamageError, Message, Source, Topic

_ENDING = re.compile(r"\.(db3|mcap)(\.zstd)?$", re.IGNORECASE)
_MOST_TOPICS = 10_000
_ZSTANDARD = b"\x28\xb5\x2f\xfd"  # first bytes of a compressed message; CDR begins with 0


class SqliteSource:
    """One .db3 file of a ROS 2 bag.

    Parameters
    ----------
    path : Path

    Raises
    ------
    DamageError
        The file is not such a file, or is damaged.
    """

    def __init__(self, path: Path) -> None:
        self._file = SqliteFile(path)
        self._room = Room(path, self._file.size)
        self.incomplete = self._file.incomplete
        self._numbers: dict[tuple[str, str, str], list[int]] = {}
        try:
            self.topics = self._topics()
        except (sqlite3.Error, UnicodeDecodeError, TypeError, AttributeError) as error:
            raise DamageError(
                f"it is not a ROS 2 bag in SQLite, or is damaged ({self._file.reason(error)})"
            ) from None

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the messages of a topic, in the order of their log times."""
        numbers = self._numbers[topic.name, topic.kind, topic.encoding]
        self._room.again()
        try:
            with closing(self._file.connected()) as connection:
                for time, message in _in_order(connection, numbers):
                    if not isinstance(time, int) or not isinstance(message, bytes):
                        raise DamageError("it is damaged (a row holds no message)")
                    if message.startswith(_ZSTANDARD):
                        message = _decompressed(message, self._room)
                    else:
                        self._room.take(len(message))
                    yield time, message
        except sqlite3.Error as error:
            raise DamageError(f"it is damaged ({self._file.reason(error)})") from None

    def _topics(self) -> tuple[Topic, ...]:
        connection = self._file.connected()
        try:
            check_tables(connection, self._file.size)
            rows = connection.execute("SELECT id, name, type, serialization_format FROM topics")
            described = self._few(rows)
            counts = dict(
                connection.execute(
                    "SELECT topic_id, COUNT(*) FROM messages "
                    "WHERE typeof(topic_id) IN ('integer', 'real') GROUP BY topic_id"
                )
            )
            definitions = self._definitions(connection)
        finally:
            connection.close()
        found: dict[tuple[str, str, str], Topic] = {}
        for number, name, kind, encoding in described:
            kind = normal_kind(kind)
            form, text = definitions.get(kind, ("", ""))
            key = (name, kind, encoding)
            before = found[key].count or 0 if key in found else 0
            self._numbers.setdefault(key, []).append(number)
            found[key] = Topic(
                name=name,
                kind=kind,
                encoding=encoding,
                definition=text,
                definition_format=form,
                count=before + counts.get(number, 0),
            )
        return tuple(found.values())

    def _definitions(self, connection: sqlite3.Connection) -> dict[str, tuple[str, str]]:
        try:
            rows = self._few(
                connection.execute(
                    "SELECT topic_type, encoding, encoded_message_definition "
                    "FROM message_definitions"
                )
            )
        except sqlite3.OperationalError as error:  # bags before ROS 2 Iron hold no definitions
            self._file.reason(error)
            return {}
        return {normal_kind(kind): (form, text) for kind, form, text in rows}

    def _few(self, rows: sqlite3.Cursor) -> list[tuple[Any, ...]]:
        """Return the rows of a table that describes topics, up to a limit; many rows may share one long text."""
        found = []
        for row in rows:
            self._room.take(sum(len(value) for value in row if isinstance(value, str | bytes)))
            found.append(row)
            if len(found) > _MOST_TOPICS:
                raise DamageError(f"it has more than {_MOST_TOPICS} topics")
        return found


class FolderSource:
    """A ROS 2 bag: a folder of .db3 or .mcap files, one after the other.

    Parameters
    ----------
    path : Path

    Raises
    ------
    DamageError
        A file in the folder is damaged.
    """

    def __init__(self, path: Path) -> None:
        self._folder: Path | None = None  # for files that were compressed as a whole
        files = sorted(
            (self._unpacked(each) for each in path.iterdir() if _ENDING.search(each.name)),
            key=lambda each: (len(each.name), each.name),  # bag_2 before bag_10
        )
        self._sources: list[Source] = [
            McapSource(each) if each.suffix.lower() == ".mcap" else SqliteSource(each)
            for each in files
        ]
        found: dict[tuple[str, str, str], Topic] = {}
        for source in self._sources:
            for topic in source.topics:
                key = topic.name, topic.kind, topic.encoding
                before = found.get(key)
                count: int | None = topic.count
                if before is not None:
                    known = count is not None and before.count is not None
                    count = (count or 0) + (before.count or 0) if known else None
                found[key] = Topic(
                    name=topic.name,
                    kind=topic.kind,
                    encoding=topic.encoding,
                    definition=topic.definition or (before.definition if before else ""),
                    definition_format=topic.definition_format,
                    count=count,
                )
        self.topics = tuple(found.values())

    def _unpacked(self, path: Path) -> Path:
        if path.suffix.lower() != ".zstd":
            return path
        import zstandard

        if self._folder is None:
            self._folder = Path(mkdtemp())
            weakref.finalize(self, shutil.rmtree, self._folder, ignore_errors=True)
        file = self._folder / path.stem
        try:
            with path.open("rb") as packed, file.open("wb") as unpacked:
                room = Room(path)
                for part in zstandard.ZstdDecompressor().read_to_iter(packed):
                    room.take(len(part))
                    unpacked.write(part)
        except zstandard.ZstdError as error:
            raise DamageError(f"{path.name} is damaged ({reason_of(error)})") from None
        return file

    @property
    def incomplete(self) -> str:
        """Reason why a file of the bag ends early."""
        return next((source.incomplete for source in self._sources if source.incomplete), "")

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the messages of a topic, file by file."""
        wanted = topic.name, topic.kind, topic.encoding
        for source in self._sources:
            for each in source.topics:
                if (each.name, each.kind, each.encoding) == wanted:
                    yield from source.messages(each)


def _in_order(connection: sqlite3.Connection, numbers: list[int]) -> Iterator[tuple[Any, Any]]:
    """Yield time and data of the rows of these topics."""
    where = (
        "FROM messages WHERE typeof(topic_id) IN ('integer', 'real') "
        f"AND topic_id IN ({','.join('?' * len(numbers))}) ORDER BY"
    )
    direct = f"SELECT timestamp, data {where} timestamp"
    if not any(
        "TEMP B-TREE" in detail
        for *_, detail in connection.execute(f"EXPLAIN QUERY PLAN {direct}", numbers)
    ):
        yield from connection.execute(direct, numbers)
        return
    # Without an index, SQLite sorts on disk, where rows that share one message take its size each: sort numbers only.
    time = "CASE typeof(timestamp) WHEN 'integer' THEN timestamp END"
    for at, number in connection.execute(f"SELECT {time}, _rowid_ {where} {time}", numbers):
        row = connection.execute("SELECT data FROM messages WHERE _rowid_ = ?", (number,))
        yield at, *(row.fetchone() or (None,))


def _decompressed(message: bytes, room: Room) -> bytes:
    import zstandard

    try:
        return of_zstandard(message, room)
    except zstandard.ZstdError as error:
        raise DamageError(f"a message is damaged ({reason_of(error)})") from None
