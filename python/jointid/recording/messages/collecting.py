"""All messages of a topic as numbers, in bounded memory."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.messages.decoding import BinaryDecoder, Block, JsonDecoder
from jointid.recording.messages.joints import Column
from jointid.recording.messages.topic import DamageError, Message, Source, Topic
from jointid.recording.table import MOST_COLUMNS

_MESSAGES, _BYTES = 4096, 4 << 20  # limits of a batch
READ = ("cdr", "ros1", "json")
"""Encodings that are read."""


@dataclass(frozen=True, eq=False)
class Collected:
    """The messages of a topic.

    Attributes
    ----------
    blocks : tuple of Block
    stamps : ndarray of int, shape (messages,), optional
        Stamps in the messages [ns]; None if there are none, or only zeros.
    log_times : ndarray of int, shape (messages,)
        Log time of each message [ns].
    not_compared : int
        Number of topics with equally many messages that were not compared because there are too many topics.
    """

    blocks: tuple[Block, ...]
    stamps: npt.NDArray[np.int64] | None
    log_times: npt.NDArray[np.int64]
    not_compared: int = 0


def collect(source: Source, topic: Topic) -> Collected:
    """Read the messages of a topic.

    Parameters
    ----------
    source : Source
    topic : Topic
        One of the source's topics, in a supported encoding.

    Raises
    ------
    DamageError
        The file or a message is damaged, or the type is not defined.
    """
    if topic.encoding not in READ:
        raise DamageError(
            f"messages in the encoding {topic.encoding!r} are not read; known encodings are {', '.join(READ)}"
        )
    decoder = JsonDecoder(topic) if topic.encoding == "json" else BinaryDecoder(topic)
    blocks: list[Block] = []
    columns: set[Column] = set()
    stamps: list[npt.NDArray[np.int64]] = []
    log_times: list[npt.NDArray[np.int64]] = []
    read, stamped = 0, True
    for batch in _batches(source.messages(topic)):
        found, own = decoder.decode([message for _, message in batch], read)
        blocks += found
        for block in found:
            columns.update(block.columns)
        if len(columns) > MOST_COLUMNS:
            raise DamageError(f"its messages hold more than {MOST_COLUMNS} fields of numbers")
        log_times.append(_times(batch))
        if own is None:
            stamped = False
        else:
            stamps.append(own)
        read += len(batch)
    own = np.concatenate(stamps) if stamped and stamps else None
    if own is not None and not own.any():
        own = None
    times = np.concatenate(log_times) if log_times else np.empty(0, dtype=np.int64)
    return Collected(tuple(blocks), own, times)


def _times(batch: list[Message]) -> npt.NDArray[np.int64]:
    try:
        return np.fromiter((time for time, _ in batch), dtype=np.int64, count=len(batch))
    except OverflowError:
        raise DamageError("a log time is not valid") from None


def _batches(messages: Iterator[Message]) -> Iterator[list[Message]]:
    batch: list[Message] = []
    size = 0
    for message in messages:
        batch.append(message)
        size += len(message[1])
        if len(batch) == _MESSAGES or size > _BYTES:
            yield batch
            batch, size = [], 0
    if batch:
        yield batch
