"""Decoding of messages to blocks of numbers; messages with the same layout are decoded together."""

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from jointid.base.values import dataclass
from jointid.recording.messages.definitions import types_of
from jointid.recording.messages.joints import Column, Path, columns_of, stamp_of
from jointid.recording.messages.json_messages import flattened
from jointid.recording.messages.layout import (
    Bytes,
    Layout,
    fixed_places,
    layout_of,
    read_numbers,
)
from jointid.recording.messages.topic import DamageError, Topic
from jointid.recording.signals import FloatArray

_NANO = 1_000_000_000
_MOST_LAYOUTS = 64  # layouts that are tried on a message before it is decoded field by field
_Key = tuple[tuple[Path, ...], tuple[tuple[Path, str], ...]]  # places of the numbers, and names
Integers = npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Block:
    """The numbers of messages with the same columns.

    Attributes
    ----------
    columns : tuple of Column
    values : ndarray, shape (columns, messages)
    messages : ndarray of int, shape (messages,)
        Numbers of the messages in the topic.
    """

    columns: tuple[Column, ...]
    values: FloatArray
    messages: npt.NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class _Known:
    """A layout, prepared for many messages."""

    places: npt.NDArray[np.intp]
    bytes_there: Bytes
    columns: tuple[Column, ...]
    parts: tuple[tuple[int, str, int, list[int], list[int]], ...]  # offset ..., elements, rows
    stamp: tuple[tuple[int, str], tuple[int, str]] | None


class BinaryDecoder:
    """Decodes the messages of a topic in CDR or ROS 1 serialisation.

    Parameters
    ----------
    topic : Topic

    Raises
    ------
    DamageError
        The topic's type is not defined.
    """

    def __init__(self, topic: Topic) -> None:
        self._kind, self._encoding = topic.kind, topic.encoding
        self._types = types_of(topic)
        self._known: dict[int, list[_Known]] = {}

    def decode(self, batch: Sequence[bytes], first: int) -> tuple[list[Block], Integers | None]:
        """Return the blocks of some messages, and the stamps in the messages [ns] if there are any.

        Parameters
        ----------
        batch : sequence of bytes
        first : int
            Number of the batch's first message in the topic.

        Raises
        ------
        DamageError
            A message does not fit its type.
        """
        lengths = np.fromiter(map(len, batch), dtype=np.int64, count=len(batch))
        stamps = np.zeros(len(batch), dtype=np.int64)
        stamped = True
        blocks: list[Block] = []
        for length in np.unique(lengths).tolist():
            chosen = np.flatnonzero(lengths == length)
            joined = b"".join(batch[k] for k in chosen.tolist())
            raw = np.frombuffer(joined, dtype=np.uint8).reshape(len(chosen), length)
            for known, which in self._sorted(raw, chosen + first):
                rows = chosen[which]
                alike = raw if len(which) == len(raw) else raw[which]
                blocks.append(_block(known, alike, rows + first))
                if known.stamp is None:
                    stamped = False
                else:
                    seconds, rest = (
                        read_numbers(alike, offset, code, 0)[:, 0].astype(np.int64)
                        for offset, code in known.stamp
                    )
                    stamps[rows] = seconds * _NANO + rest
        return blocks, stamps if stamped else None

    def _sorted(
        self, raw: Bytes, numbers: npt.NDArray[np.int64]
    ) -> Iterator[tuple[_Known, npt.NDArray[np.intp]]]:
        """Yield layouts and the indices of the messages that have them."""
        left = np.arange(len(raw))
        layouts = self._known.setdefault(raw.shape[1], [])
        tried = 0
        while len(left):
            if tried < len(layouts):
                known = layouts[tried]
                tried += 1
            else:
                known = self._learnt(raw[left[0]].tobytes(), int(numbers[left[0]]))
                if len(layouts) < _MOST_LAYOUTS:
                    layouts.append(known)
                    tried += 1
                else:
                    yield known, left[:1]
                    left = left[1:]
                    continue
            rest = raw if len(left) == len(raw) else raw[left]
            same = (rest[:, known.places] == known.bytes_there).all(axis=1)
            if same.any():
                yield known, left[same]
                left = left[~same]

    def _learnt(self, message: bytes, number: int) -> _Known:
        try:
            return _known(
                layout_of(message, self._kind, self._types, self._encoding), message, self._kind
            )
        except DamageError as error:
            raise DamageError(f"message {number}: {error}") from None


class JsonDecoder:
    """Decodes the messages of a topic in JSON.

    Parameters
    ----------
    topic : Topic
    """

    def __init__(self, topic: Topic) -> None:
        self._kind = topic.kind
        self._known: dict[_Key, tuple[dict[Column, int], tuple[int, int] | None]] = {}

    def decode(self, batch: Sequence[bytes], first: int) -> tuple[list[Block], Integers | None]:
        """Same as `BinaryDecoder.decode`."""
        stamps = np.zeros(len(batch), dtype=np.int64)
        stamped = True
        groups: dict[_Key, tuple[list[int], list[tuple[float, ...]]]] = {}
        for k, message in enumerate(batch):
            try:
                paths, numbers, names = flattened(message)
                key = paths, tuple(names.items())
                if key not in self._known:
                    self._known[key] = columns_of(self._kind, paths, names), stamp_of(paths)
            except DamageError as error:
                raise DamageError(f"message {first + k}: {error}") from None
            _, stamp = self._known[key]
            stamped = stamped and stamp is not None
            if stamp is not None:
                stamps[k] = _nanoseconds(numbers[stamp[0]], numbers[stamp[1]], first + k)
            rows, values = groups.setdefault(key, ([], []))
            rows.append(k)
            values.append(numbers)
        blocks = []
        for key, (rows, values) in groups.items():
            columns, _ = self._known[key]
            table = np.array(values, dtype=np.float64)
            blocks.append(
                Block(
                    tuple(columns),
                    np.ascontiguousarray(table[:, list(columns.values())].T),
                    np.array(rows, dtype=np.int64) + first,
                )
            )
        return blocks, stamps if stamped else None


def _nanoseconds(seconds: float, rest: float, number: int) -> int:
    try:
        stamp = int(seconds) * _NANO + int(rest)
    except (ValueError, OverflowError):
        stamp = 1 << 63
    if not -(1 << 63) <= stamp < 1 << 63:
        raise DamageError(f"message {number}: its time stamp is not valid")
    return stamp


def _known(layout: Layout, message: bytes, kind: str) -> _Known:
    paths: list[Path] = []
    owners: list[tuple[int, int]] = []  # part, and element in the part
    for part, (path, _, _, count) in enumerate(layout.numbers):
        paths += [(*path, k) for k in range(count)] if count else [path]
        owners += [(part, k) for k in range(max(count, 1))]
    columns = columns_of(kind, paths, layout.names)
    elements: dict[int, tuple[list[int], list[int]]] = {}
    for row, index in enumerate(columns.values()):
        part, element = owners[index]
        taken, rows = elements.setdefault(part, ([], []))
        taken.append(element)
        rows.append(row)
    places = fixed_places(layout)
    stamp = stamp_of(paths)
    return _Known(
        places=places,
        bytes_there=np.frombuffer(message, dtype=np.uint8)[places],
        columns=tuple(columns),
        parts=tuple(
            (*layout.numbers[part][1:], taken, rows) for part, (taken, rows) in elements.items()
        ),
        stamp=stamp and tuple(layout.numbers[owners[index][0]][1:3] for index in stamp),  # type: ignore[arg-type]
    )


def _block(known: _Known, raw: Bytes, numbers: npt.NDArray[np.int64]) -> Block:
    values = np.empty((len(known.columns), len(raw)))
    for offset, code, count, elements, rows in known.parts:
        values[rows] = read_numbers(raw, offset, code, count).T[elements]
    return Block(known.columns, values, numbers)
