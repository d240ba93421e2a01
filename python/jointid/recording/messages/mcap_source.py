"""MCAP files: topics from the summary, or without one from the whole file; messages chunk by chunk."""

import struct
import zlib
from collections.abc import Collection, Iterator
from io import BufferedReader, BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from jointid.base.error_text import reason_of
from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.recording.messages.definitions import normal_kind
from jointid.recording.messages.packed import of_lz4, of_zstandard
from jointid.recording.messages.topic import DamageError, Message, Topic

_SCHEMA, _CHANNEL, _MESSAGE = 3, 4, 5  # kinds of record
_UNPACKING = {"zstd": of_zstandard, "lz4": of_lz4}
_RECORD = struct.Struct("<BQ")
_HEADER = struct.Struct("<HIQQ")  # channel, sequence, log time, publish time
_LARGE = 1 << 16  # bytes that may be requested at once


class _Stream(BufferedReader):
    """A file that never reads more than its size, because a damaged length would reserve too much memory."""

    def __init__(self, path: Path, size: int) -> None:
        super().__init__(path.open("rb", buffering=0))
        self._size = size

    def read(self, size: int | None = -1) -> bytes:
        if size is not None and size > _LARGE:
            size = min(size, max(self._size - self.tell(), 0))
        return super().read(size)


class McapSource:
    """An MCAP file.

    Parameters
    ----------
    path : Path

    Raises
    ------
    DamageError
        The file is not an MCAP file, or is damaged.
    """

    def __init__(self, path: Path) -> None:
        import mcap.stream_reader  # noqa: F401  # a missing package is reported before the file is opened

        self._path = path
        self._size = path.stat().st_size
        self._room = Room(path, self._size)
        self.incomplete = ""
        self._channels: dict[int, Any] = {}
        self._schemas: dict[int, Any] = {}
        self._counts: dict[int, int] | None = None
        self._chunks: list[Any] = []
        with _Stream(path, self._size) as stream:
            self._open(stream)
        self.topics = self._topics()

    def messages(self, topic: Topic) -> Iterator[Message]:
        """Yield the messages of a topic."""
        wanted = {
            number
            for number, channel in self._channels.items()
            if self._name(channel) == _key(topic)
        }
        self._room.again()
        with _Stream(self._path, self._size) as stream:
            if self._chunks:
                yield from self._from_chunks(stream, wanted)
            else:
                for number, time, data in self._all(stream):
                    if number in wanted:
                        yield time, data

    def _open(self, stream: BinaryIO) -> None:
        from mcap.reader import SeekingReader

        summary = None
        # The library documents no error for damaged bytes. Without a summary the file is read in order.
        try:
            reader = SeekingReader(stream, record_size_limit=self._size)
        except Exception:
            raise DamageError("it is not an MCAP file") from None
        try:
            summary = reader.get_summary()
        except Exception:
            summary = None
        if summary is not None and summary.channels:
            self._channels, self._schemas = summary.channels, summary.schemas
            self._chunks = sorted(summary.chunk_indexes, key=lambda chunk: chunk.chunk_start_offset)
            if summary.statistics is not None:
                self._counts = dict(summary.statistics.channel_message_counts)
            return
        self._counts = {}
        stream.seek(0)
        for number, _, _ in self._all(stream):
            self._counts[number] = self._counts.get(number, 0) + 1

    def _topics(self) -> tuple[Topic, ...]:
        found: dict[tuple[str, str, str], Topic] = {}
        texts: dict[int, str] = {}  # decoded once: thousands of channels may have one schema
        for number, channel in self._channels.items():
            schema = self._schemas.get(channel.schema_id)
            if schema and channel.schema_id not in texts:
                texts[channel.schema_id] = schema.data.decode("utf-8", "replace")
            key = self._name(channel)
            count = None if self._counts is None else self._counts.get(number, 0)
            if key in found:
                before = found[key].count
                count = None if count is None or before is None else count + before
            found[key] = Topic(
                name=key[0],
                kind=key[1],
                encoding=key[2],
                definition=texts.get(channel.schema_id, ""),
                definition_format=schema.encoding if schema else "",
                count=count,
            )
        return tuple(found.values())

    def _name(self, channel: Any) -> tuple[str, str, str]:
        schema = self._schemas.get(channel.schema_id)
        return channel.topic, normal_kind(schema.name) if schema else "", channel.message_encoding

    def _from_chunks(self, stream: BinaryIO, wanted: Collection[int]) -> Iterator[Message]:
        from mcap.data_stream import ReadDataStream
        from mcap.records import Chunk

        for index in self._chunks:
            if index.message_index_offsets and wanted.isdisjoint(index.message_index_offsets):  # type: ignore[attr-defined]
                continue
            try:
                stream.seek(index.chunk_start_offset + _RECORD.size)
                content = _content(Chunk.read(ReadDataStream(stream)), self._room)
            except InputError:
                raise
            except Exception as error:
                raise _damage(error) from None
            for number, time, data in self._parts(content):
                if number in wanted:
                    yield time, data

    def _all(self, stream: BinaryIO) -> Iterator[tuple[int, int, bytes]]:
        """Yield channel, log time and bytes of all messages, in order, up to the file's end."""
        from mcap.records import Channel, Chunk, Footer, Schema
        from mcap.records import Message as Record
        from mcap.stream_reader import StreamReader

        records = StreamReader(stream, emit_chunks=True, record_size_limit=self._size).records
        while True:
            content = b""
            try:
                record = next(records, None)
                if isinstance(record, Chunk):
                    content = _content(record, self._room)
            except InputError:
                raise
            except Exception as error:
                if stream.tell() < self._size:
                    raise _damage(error) from None
                record = None
            if isinstance(record, Footer):
                return
            if record is None:
                self.incomplete = "the end of the file is missing: perhaps the recorder was killed"
                return
            if isinstance(record, Chunk):
                yield from self._parts(content)
            elif isinstance(record, Schema):
                self._schemas[record.id] = record
            elif isinstance(record, Channel):
                self._channels[record.id] = record
            elif isinstance(record, Record):
                yield record.channel_id, record.log_time, record.data

    def _parts(self, content: bytes) -> Iterator[tuple[int, int, bytes]]:
        """Yield channel, log time and bytes of the messages of a chunk."""
        place, end = 0, len(content)
        while place < end:
            try:
                kind, length = _RECORD.unpack_from(content, place)
                place += _RECORD.size
                if place + length > end:
                    raise DamageError("a record is longer than its chunk")
                if kind == _MESSAGE:
                    number, _, time, _ = _HEADER.unpack_from(content, place)
                    yield number, time, content[place + _HEADER.size : place + length]
                elif kind in (_SCHEMA, _CHANNEL):
                    self._learn(kind, content[place : place + length])
            except struct.error:
                raise DamageError("a record of a chunk ends early") from None
            place += length

    def _learn(self, kind: int, record: bytes) -> None:
        from mcap.data_stream import ReadDataStream
        from mcap.records import Channel, Schema

        try:
            if kind == _SCHEMA:
                schema = Schema.read(ReadDataStream(BytesIO(record)))
                self._schemas[schema.id] = schema
            else:
                channel = Channel.read(ReadDataStream(BytesIO(record)))
                self._channels[channel.id] = channel
        except Exception as error:
            raise _damage(error) from None


def _key(topic: Topic) -> tuple[str, str, str]:
    return topic.name, topic.kind, topic.encoding


def _content(chunk: Any, room: Room) -> bytes:
    unpack = _UNPACKING.get(chunk.compression)
    if unpack is None and chunk.compression:
        raise DamageError(f"the compression {chunk.compression!r} is not read")
    if unpack is None:
        room.take(len(chunk.data))  # several entries of the summary may name one chunk
    content = chunk.data if unpack is None else unpack(chunk.data, room)
    if chunk.uncompressed_crc and zlib.crc32(content) != chunk.uncompressed_crc:
        raise DamageError("crc validation failed in Chunk")
    return bytes(content)


def _damage(error: Exception) -> DamageError:
    return DamageError(f"it is damaged ({reason_of(error)})")
