"""What the packed chunks of an HDF5 dataset hold: the library unpacks all of it, also more than the dataset has."""

from __future__ import annotations

import math
import zlib
from itertools import product
from typing import Any

from jointid.base.errors import InputError
from jointid.base.unpacking import Room

_SMALL = 60_000  # bytes of a chunk, of which zlib makes 62 MB at most
_DEFLATE, _SHUFFLE, _CHECKSUM = 1, 2, 3  # HDF5's numbers of filters
# What these make depends on numbers in the file that the library does not check.
_UNREAD = {4: "szip", 5: "N-bit", 6: "scale-offset"}


def take(dataset: Any, room: Room) -> None:
    """Count what a dataset takes when it is read.

    Parameters
    ----------
    dataset : h5py.Dataset
    room : Room

    Raises
    ------
    InputError
        It takes more than there is room for, or its chunks are packed by filters that are not read.
    ValueError, zlib.error
        A chunk is damaged: it holds more than a chunk does, or cannot be unpacked.
    """
    room.take(max(dataset.nbytes, 8 * dataset.size))  # as numbers are converted
    if dataset.chunks is None:
        return
    size = math.prod(dataset.chunks) * dataset.dtype.itemsize  # may be more than the dataset
    if size > room.left:  # one after the other, so that they are not counted together
        room.take(size)
    settings = dataset.id.get_create_plist()
    filters = [settings.get_filter(number)[0] for number in range(settings.get_nfilters())]
    refused = [_UNREAD[each] for each in filters if each in _UNREAD]
    if _DEFLATE in filters and (
        filters.count(_DEFLATE) > 1 or set(filters) - {_SHUFFLE, _DEFLATE, _CHECKSUM}
    ):
        refused.append("several filters")
    if refused:
        raise InputError(
            f"{dataset.name} is packed by {refused[0]}, which is not read",
            place=str(dataset.file.filename),
            remedy="save it with gzip or lzf",
        )
    if _DEFLATE not in filters or dataset.id.get_storage_size() <= _SMALL:
        return
    skipped = 1 << filters.index(_DEFLATE)
    for place in _large_chunks(dataset):
        chunk = dataset.id.get_chunk_info_by_coord(place)
        if chunk.size > _SMALL and not chunk.filter_mask & skipped:
            packed = dataset.id.read_direct_chunk(place)[1]
            if len(zlib.decompressobj().decompress(packed, size + 1)) > size:
                raise ValueError(f"a chunk holds more than {size} bytes")


def _large_chunks(dataset: Any) -> list[tuple[int, ...]]:
    """Return where chunks that are large when packed begin, or where any chunk does."""
    found: list[Any] = []

    def look(chunk: Any) -> None:
        if chunk.size > _SMALL:
            found.append(chunk)

    # By its place, a chunk is looked for among all of them, which takes long where they are many.
    if hasattr(dataset.id, "chunk_iter"):
        dataset.id.chunk_iter(look)
        places = [tuple(chunk.chunk_offset) for chunk in found]
        sizes = [dataset.id.get_chunk_info_by_coord(place).size for place in places]
        if sizes == [chunk.size for chunk in found]:  # some versions tell other places
            return places
    return list(product(*map(range, [0] * dataset.ndim, dataset.shape, dataset.chunks)))
