"""What the pages of a Parquet column hold when they are unpacked, as their own headers say.

pyarrow unpacks a page whatever the footer says of the column, so that a file of 1 MB may fill the memory.
"""

from __future__ import annotations

_DEEPEST = 16  # structures within each other; a page's header has 3
# Types of Thrift's compact protocol.
_TRUE, _FALSE, _BYTE, _I32, _I64, _DOUBLE, _BINARY, _LIST, _SET, _MAP, _STRUCT, _UUID = (
    *(1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 12, 13),
)
_I16 = 4
_UNPACKED, _PACKED = 2, 3  # fields of a page's header: bytes


def unpacked_size(content: bytes, start: int, end: int) -> int:
    """Return the bytes of all pages from start to end when they are unpacked.

    Parameters
    ----------
    content : bytes
        The whole file.
    start, end : int
        Of a column's pages.

    Raises
    ------
    ValueError
        A header is damaged.
    """
    if start < 0:
        raise ValueError(f"pages at byte {start}")
    total = 0
    while start < end:
        header = _Header(content, start, end)
        header.skip_struct(0)
        if min(header.unpacked, header.packed) < 0:
            raise ValueError(f"the page at byte {start} has no size")
        total += header.unpacked
        start = header.place + header.packed
    return total


class _Header:
    """The header of a page: a structure of Thrift's compact protocol, of which two numbers are read."""

    def __init__(self, content: bytes, start: int, end: int) -> None:
        self._content, self._start, self._end = content, start, end
        self.place = start
        self.unpacked = self.packed = -1

    def skip_struct(self, depth: int) -> None:
        """Go behind a structure; of the outermost one, keep the sizes."""
        if depth > _DEEPEST:
            raise self._damaged()
        field = 0
        while (first := self._byte()) != 0:
            kind = first & 15
            field = field + (first >> 4) if first >> 4 else self._number(16)
            if depth == 0 and kind == _I32 and field in (_UNPACKED, _PACKED):
                size = self._number(32)
                if field == _UNPACKED:
                    self.unpacked = size
                else:
                    self.packed = size
            elif kind not in (_TRUE, _FALSE):  # these are in the type
                self._skip(kind, depth + 1)

    def _skip(self, kind: int, depth: int) -> None:
        if kind in (_TRUE, _FALSE, _BYTE):
            self._forward(1)
        elif kind in (_I16, _I32, _I64):
            self._varint()
        elif kind == _DOUBLE:
            self._forward(8)
        elif kind == _UUID:
            self._forward(16)
        elif kind == _BINARY:
            self._forward(self._varint())
        elif kind in (_LIST, _SET):
            first = self._byte()
            self._skip_all(first >> 4 if first >> 4 < 15 else self._varint(), (first & 15,), depth)
        elif kind == _MAP:
            count = self._varint()
            both = self._byte() if count else 0
            self._skip_all(count, (both >> 4, both & 15), depth)
        elif kind == _STRUCT:
            self.skip_struct(depth)
        else:
            raise self._damaged()

    def _skip_all(self, count: int, kinds: tuple[int, ...], depth: int) -> None:
        if depth > _DEEPEST:
            raise self._damaged()
        for _ in range(count):  # each takes a byte at least, and the file ends
            for kind in kinds:
                self._skip(kind, depth + 1)

    def _number(self, bits: int) -> int:
        """A signed number of so many bits; what is more of it is cut off, as Thrift does."""
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
        self._forward(1)
        return self._content[self.place - 1]

    def _forward(self, count: int) -> None:
        self.place += count
        if self.place > min(self._end, len(self._content)):
            raise self._damaged()

    def _damaged(self) -> ValueError:
        return ValueError(f"the header of the page at byte {self._start} is damaged")
