"""The elements of a MATLAB level 5 file: real and complex arrays, and structs that hold them.

Written from the published format ("MAT-File Format", MathWorks). scipy.io.loadmat reads more, but
some damaged files crash it together with the interpreter. Here every length is checked.
"""

import itertools
import math
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from jointid.base.unpacking import Room
from jointid.base.values import dataclass

Array = npt.NDArray[Any]

_MATRIX, _COMPRESSED = 14, 15
_STORED = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8"}
_STORED |= {12: "i8", 13: "u8"}
_STRUCT, _OPAQUE = 2, 17
_NUMERIC = range(6, 16)  # double, single, int8 ... uint64; logical has one of these and a flag
_COMPLEX = 0x0800

_MOST_FIELDS, _MOST_ELEMENTS = 10_000, 100_000  # limits of a struct


class DamageError(ValueError):
    """The bytes contradict the format."""


@dataclass(frozen=True, kw_only=True)
class Variable:
    """A variable of a file, or a field of a struct.

    Attributes
    ----------
    name : str
    array : ndarray, shape (rows, columns), or None
        Numbers of the variable. None: not a two-dimensional array of numbers.
    fields : tuple of tuples of Variable
        The fields of each element of a struct, column by column. Default: not a struct.
    """

    name: str
    array: Array | None = None
    fields: tuple[tuple["Variable", ...], ...] = ()


def variables_of(content: bytes, order: str, room: Room) -> Iterator[Variable]:
    """Yield the named variables of a file.

    Parameters
    ----------
    content : bytes
        Bytes after the header of 128 bytes.
    order : str
        Byte order, ``"<"`` or ``">"``.
    room : Room
        Memory limit for compressed elements.

    Raises
    ------
    DamageError
        The bytes contradict the format.
    """
    for kind, element in _elements(memoryview(content), order):
        matrix = element
        if kind == _COMPRESSED:
            ((kind, matrix),) = _inflated(element, order, room)
        if kind != _MATRIX:
            raise DamageError(f"an element has the kind {kind}; a variable is expected there")
        variable = _variable(matrix, order, nested=False)
        if variable.name:  # variables without a name hold MATLAB's internal objects
            yield variable


def _elements(content: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    """Yield kind and bytes of each element."""
    place = 0
    while place < len(content):
        head = content[place : place + 8]
        if len(head) < 8:
            raise DamageError("the file ends inside the header of an element")
        kind, size = (int(word) for word in np.frombuffer(head, order + "u4"))
        if kind >> 16:  # kind and size share a word, up to four bytes follow it
            kind, size, first, step = kind & 0xFFFF, kind >> 16, place + 4, 8
            if size > 4:
                raise DamageError("a small-format element has more than 4 bytes")
        else:
            first = place + 8
            step = 8 + (size if kind == _COMPRESSED else -8 * (-size // 8))
        if first + size > len(content):
            raise DamageError("an element is longer than the rest of the file")
        yield kind, content[first : first + size]
        place += step


def _inflated(element: memoryview, order: str, room: Room) -> list[tuple[int, memoryview]]:
    unpacker = zlib.decompressobj()
    try:
        content = unpacker.decompress(element, room.left + 1)
        room.take(len(content))
    except zlib.error:
        raise DamageError("a compressed variable is damaged") from None
    if not unpacker.eof:
        raise DamageError("a compressed variable ends in the middle")
    inside = list(itertools.islice(_elements(memoryview(content), order), 2))
    if len(inside) != 1:
        raise DamageError("a compressed element does not hold exactly one variable")
    return inside


def _variable(matrix: memoryview, order: str, *, nested: bool) -> Variable:
    parts = _elements(matrix, order)
    if not len(matrix):  # an empty field
        return Variable(name="")
    flags = _numbers(_next(parts), order)
    if len(flags) < 1 or flags.dtype.kind != "u":
        raise DamageError("a variable has no class")
    kind = int(flags[0]) & 0xFF
    if kind == _OPAQUE:  # no dimensions: the name follows directly
        return Variable(name=_text(_next(parts)))
    shape = [int(length) for length in _numbers(_next(parts), order)]
    if any(length < 0 for length in shape):
        raise DamageError("a dimension is negative")
    name = _text(_next(parts))
    if kind == _STRUCT and not nested:
        fields = _struct(parts, math.prod(shape), order)
        return Variable(name=name, fields=tuple(fields))
    if kind not in _NUMERIC or len(shape) != 2:
        return Variable(name=name)
    array = _numbers(_next(parts), order)
    if int(flags[0]) & _COMPLEX:
        imaginary = _numbers(_next(parts), order)
        if len(imaginary) != len(array):
            raise DamageError(
                f"the variable {name[:40]!r} has real and imaginary parts of different length"
            )
        array = array + 1j * imaginary.astype(np.float64)
    if len(array) != math.prod(shape):
        raise DamageError(
            f"the variable {name[:40]!r} has {len(array)} values for the shape {shape}"
        )
    return Variable(name=name, array=array.reshape(shape, order="F"))


def _struct(
    parts: Iterator[tuple[int, memoryview]], count: int, order: str
) -> Iterator[tuple[Variable, ...]]:
    width = _numbers(_next(parts), order)
    if len(width) != 1 or not 0 < int(width[0]) <= 1024:
        raise DamageError("a struct does not state the length of its field names")
    listed, step = bytes(_next(parts)[1]), int(width[0])
    fields = -(-len(listed) // step)
    if fields > _MOST_FIELDS or count * fields > _MOST_ELEMENTS:
        return  # a list of events, not signals
    names = [
        listed[first : first + step].split(b"\0")[0].decode("ascii", "replace")
        for first in range(0, len(listed), step)
    ]
    for _ in range(count if names else 0):  # fields run out before a false count does
        values = [_matrix(_next(parts), order) for _ in names]
        yield tuple(
            Variable(name=name, array=value.array)
            for name, value in zip(names, values, strict=True)
        )


def _matrix(element: tuple[int, memoryview], order: str) -> Variable:
    if element[0] != _MATRIX:
        raise DamageError("a field of a struct is not an array")
    return _variable(element[1], order, nested=True)


def _numbers(element: tuple[int, memoryview], order: str) -> Array:
    kind, content = element
    if kind not in _STORED:
        raise DamageError(f"an element has the kind {kind}; numbers are expected there")
    dtype = np.dtype(order + _STORED[kind])
    if len(content) % dtype.itemsize:
        raise DamageError("a number is truncated")
    return np.frombuffer(content, dtype)


def _text(element: tuple[int, memoryview]) -> str:
    return bytes(element[1]).rstrip(b"\0").decode("ascii", "replace")


def _next(parts: Iterator[tuple[int, memoryview]]) -> tuple[int, memoryview]:
    element = next(parts, None)
    if element is None:
        raise DamageError("a variable is truncated")
    return element
