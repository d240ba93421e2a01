"""Size checks of an HDF5 dataset's packed chunks: the library unpacks a chunk even if it exceeds the dataset."""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import product
from typing import Any, NamedTuple

from jointid.base.errors import InputError
from jointid.base.unpacking import Room

_DEFLATE, _SHUFFLE, _CHECKSUM, _LZF = 1, 2, 3, 32000  # HDF5's numbers of filters
_SUM = 4  # bytes of a checksum
_REFERENCE = 16  # bytes of a reference to a text of any length
# The output size of these filters depends on numbers in the file that the library does not check.
_UNREAD = {4: "szip", 5: "N-bit", 6: "scale-offset"}
_TIMES = (
    4  # times the room: limit for all chunks of a dataset, as parts beyond its edges are not read
)


class _Chunk(NamedTuple):
    size: int
    filter_mask: int


def take(dataset: Any, room: Room) -> None:
    """Count the memory that reading a dataset needs.

    Parameters
    ----------
    dataset : h5py.Dataset
    room : Room

    Raises
    ------
    InputError
        The dataset needs more memory than is allowed, or its chunks use filters that are not read.
    ValueError, zlib.error
        A chunk is damaged: its size is wrong, or it cannot be unpacked. For a chunk that is too short, the
        library would read memory behind it.
    """
    before = room.left
    room.take(max(dataset.nbytes, 8 * dataset.size))  # the conversion to float64 included
    if dataset.chunks is None:
        return
    element, known = _stored(dataset.id.get_type())
    size = math.prod(dataset.chunks) * element  # may be more than the dataset
    if size > max(room.left, dataset.nbytes):  # each chunk counts alone
        room.take(size)
    if size * dataset.id.get_num_chunks() > _TIMES * before:
        room.take(size * dataset.id.get_num_chunks())
    settings = dataset.id.get_create_plist()
    described = [settings.get_filter(number) for number in range(settings.get_nfilters())]
    filters = [code for code, *_ in described]
    refused = [_UNREAD[each] for each in filters if each in _UNREAD]
    if _DEFLATE in filters and (
        filters.count(_DEFLATE) > 1 or set(filters) - {_SHUFFLE, _DEFLATE, _CHECKSUM}
    ):
        refused.append("several filters")
    if refused:
        raise InputError(
            f"{dataset.name} is packed by {refused[0]}, which jointid cannot read",
            place=str(dataset.file.filename),
            remedy="save the dataset with gzip or lzf",
        )
    for code, _, values, _ in described:
        if code == _LZF and (len(values) < 3 or values[2] < size):  # exactly the expected size
            raise ValueError(f"the output of an LZF filter is smaller than a chunk of {size} bytes")
    most = dataset.file.id.get_filesize()
    for chunk, place in _chunks(dataset):
        if chunk.size > most:  # the library would reserve this much memory
            raise ValueError(
                f"a chunk states {chunk.size} bytes, but the whole file has only {most}"
            )
        held = _held(dataset, chunk, place, filters, size)
        if known and held is not None and held != size:
            least = "more than" if held > size else f"{held} of"
            raise ValueError(f"a chunk holds {least} the expected {size} bytes")


def _held(
    dataset: Any, chunk: Any, place: tuple[int, ...], filters: Sequence[int], size: int
) -> int | None:
    """Return the bytes in a chunk, at most one more than expected; None if its filters are unknown here."""
    used = [code for k, code in enumerate(filters) if not chunk.filter_mask >> k & 1]
    if set(used) - {_DEFLATE, _SHUFFLE, _CHECKSUM}:
        return None
    # The last chunks of a dimension may be stored unfiltered, which h5py does not report.
    edges = zip(place, dataset.chunks, dataset.shape, strict=True)
    plain = chunk.size == size and any(start + length > end for start, length, end in edges)
    if _DEFLATE not in used:
        return size if plain else int(chunk.size) - _SUM * used.count(_CHECKSUM)
    packed = dataset.id.read_direct_chunk(place)[1]
    before, behind = used[: used.index(_DEFLATE)], used[used.index(_DEFLATE) :]
    sums = _SUM * before.count(_CHECKSUM)
    packed = packed[: len(packed) - _SUM * behind.count(_CHECKSUM)]
    try:
        return len(zlib.decompressobj().decompress(packed, size + sums + 1)) - sums
    except zlib.error:
        if plain:
            return size
        raise


def _stored(kind: Any) -> tuple[int, bool]:
    """Return the bytes of an element in the file, and whether this number is certain."""
    import h5py

    size = int(kind.get_size())
    if isinstance(kind, h5py.h5t.TypeCompoundID):
        parts = [kind.get_member_type(k) for k in range(kind.get_nmembers())]
        stored = [_stored(part) for part in parts]
        more = sum(
            each - int(part.get_size()) for (each, _), part in zip(stored, parts, strict=True)
        )
        return size + more, all(known for _, known in stored)
    if isinstance(kind, h5py.h5t.TypeArrayID):
        part = kind.get_super()
        each, known = _stored(part)
        return size // int(part.get_size()) * each, known
    if isinstance(kind, h5py.h5t.TypeStringID) and kind.is_variable_str():
        return _REFERENCE, True
    return size, not isinstance(kind, h5py.h5t.TypeReferenceID | h5py.h5t.TypeVlenID)


def _chunks(dataset: Any) -> Iterator[tuple[Any, tuple[int, ...]]]:
    """Yield size, filters and first index of each stored chunk."""
    if hasattr(dataset.id, "chunk_iter"):
        found: list[Any] = []
        dataset.id.chunk_iter(found.append)
        if all(_begins_at(dataset, chunk.chunk_offset) for chunk in found):
            yield from ((chunk, tuple(chunk.chunk_offset)) for chunk in found)
            return
    # Some versions return wrong places. Only reading a chunk shows that its place is right.
    for place in product(*map(range, [0] * dataset.ndim, dataset.shape, dataset.chunks)):
        with suppress(
            OSError, RuntimeError, ValueError
        ):  # it is not stored, or cannot be read later
            mask, packed = dataset.id.read_direct_chunk(place)
            yield _Chunk(len(packed), mask), place


def _begins_at(dataset: Any, place: Sequence[int]) -> bool:
    known = zip(place, dataset.chunks, dataset.shape, strict=True)
    return all(start % length == 0 and start < end for start, length, end in known)
