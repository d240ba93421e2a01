"""Unpacked sizes of the columns of a Parquet file, from its footer and its page headers.

pyarrow reserves memory for the number of rows that a row group states. It unpacks a page even if the footer
contradicts it, so that a file of 1 MB may fill the memory. Reading a damaged column's metadata crashes the process.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

_DEEPEST = 16  # levels of nested structures; a footer has 6
# Types of Thrift's compact protocol; the first two (true and false) are values themselves.
_TRUE, _FALSE, _BYTE, _I16, _I32, _I64, _DOUBLE, _BINARY, _LIST, _SET, _MAP, _STRUCT, _UUID = range(
    1, 14
)
_BITS = {_I16: 16, _I32: 32, _I64: 64}
_BYTES = {_TRUE: 1, _FALSE: 1, _BYTE: 1, _DOUBLE: 8, _UUID: 16}
_Struct = dict[tuple[int, int], Any]  # key: number and type of a field


class Sizes:
    """The footer of a Parquet file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Raises
    ------
    ValueError
        The footer is damaged, or its row groups do not add up to the stated number of rows.
    """

    def __init__(self, content: bytes) -> None:
        self._content = content
        start = len(content) - 8 - int.from_bytes(content[-8:-4], "little")
        footer = _Reader(content, start, len(content) - 8).struct(0)
        self.rows: int = footer.get((3, _I64), -1)
        self._groups = [_structure(each) for each in footer.get((4, _LIST), [])]
        rows = [group.get((3, _I64), -1) for group in self._groups]
        if min(rows, default=0) < 0 or sum(rows) != self.rows:
            raise ValueError(f"its row groups hold {sum(rows)} rows, but the file has {self.rows}")

    def of(self, column: int) -> int:
        """Return the bytes of the unpacked pages of a column, named by its number in the file.

        Raises
        ------
        ValueError, LookupError
            The footer or the header of a page is damaged.
        """
        return sum(self._of_groups(column))

    def encodings(self, column: int) -> set[int]:
        """Return the numbers of the encodings of a column's values."""
        return {
            each
            for group in self._groups
            for each in _structure(group[1, _LIST][column])[3, _STRUCT].get((2, _LIST), [])
            if isinstance(each, int)  # a damaged footer may hold anything
        }

    def _of_groups(self, column: int) -> Iterator[int]:
        packed = 0
        for group in self._groups:
            about = _structure(group[1, _LIST][column])[3, _STRUCT]
            packed += about[7, _I64]
            if packed > len(self._content):  # several groups refer to the same pages
                raise ValueError("its footer is damaged")
            if about[5, _I64] == 0:  # no values: the column needs no pages
                continue
            start = about[9, _I64]
            if 0 < (dictionary := about.get((11, _I64), 0)) < start:
                start = dictionary
            yield pages_size(self._content, start, start + about[7, _I64])


def pages_size(content: bytes, start: int, end: int) -> int:
    """Return the unpacked bytes of all pages from start to end.

    Raises
    ------
    ValueError
        A header is damaged.
    """
    total = 0
    while start < end:
        reader = _Reader(content, start, end)
        header = reader.struct(0)
        unpacked, packed = header.get((2, _I32), -1), header.get((3, _I32), -1)
        if min(unpacked, packed) < 0:
            raise ValueError(f"the page at byte {start} has no size")
        total += unpacked
        start = reader.place + packed
    return total


def _structure(value: Any) -> _Struct:
    if not isinstance(value, dict):
        raise ValueError("its footer is damaged")
    return value


class _Reader:
    """Reader of structures in Thrift's compact protocol, within a range of bytes."""

    def __init__(self, content: bytes, start: int, end: int) -> None:
        self._content, self._start, self._end = content, start, min(end, len(content))
        self.place = start
        if start < 0:
            raise self._damaged()

    def struct(self, depth: int) -> _Struct:
        """Return the fields of a structure; of repeated fields the last, like Thrift."""
        if depth > _DEEPEST:
            raise self._damaged()
        found: _Struct = {}
        number = 0
        while (first := self._byte()) != 0:
            kind = first & 15
            number = number + (first >> 4) if first >> 4 else self._number(16)
            has_value = kind not in (_TRUE, _FALSE)
            found[number, kind] = self._value(kind, depth + 1) if has_value else None
        return found

    def _value(self, kind: int, depth: int) -> Any:
        if kind == _STRUCT:
            return self.struct(depth)
        if kind in _BITS:
            return self._number(_BITS[kind])
        if kind == _BINARY:
            return self._take(self._varint())
        if kind in _BYTES:
            return self._take(_BYTES[kind])
        if depth > _DEEPEST or kind not in (_LIST, _SET, _MAP):
            raise self._damaged()
        if kind == _MAP:
            count = self._varint()
            both = self._byte() if count else 0
            kinds: tuple[int, ...] = (both >> 4, both & 15)
        else:
            first = self._byte()
            count = first >> 4 if first >> 4 < 15 else self._varint()
            kinds = (first & 15,)
        # The loop ends: each element takes at least one byte.
        return [self._value(each, depth + 1) for _ in range(count) for each in kinds]

    def _number(self, bits: int) -> int:
        """Return a signed number of this number of bits; further bits are cut off, like in Thrift."""
        value = self._varint() & ((1 << bits) - 1)
        return (value >> 1) ^ -(value & 1)

    def _varint(self) -> int:
        value = 0
        for shift in range(0, 70, 7):
            byte = self._byte()
            value |= (byte & 127) << shift
            if byte < 128:
                return value
        raise self._damaged()

    def _byte(self) -> int:
        return self._take(1)[0]

    def _take(self, count: int) -> bytes:
        self.place += count
        if self.place > self._end:
            raise self._damaged()
        return self._content[self.place - count : self.place]

    def _damaged(self) -> ValueError:
        return ValueError(f"the part that begins at byte {self._start} is damaged")
