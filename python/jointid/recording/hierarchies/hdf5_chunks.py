"""What the packed chunks of an HDF5 dataset hold: the library unpacks all of it, also more than the dataset has."""

from __future__ import annotations

import math
import zlib
from itertools import product
from typing import Any

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
        It takes more than there is room for.
    ValueError, zlib.error
        A chunk is damaged: it holds more than a chunk does, or cannot be unpacked.
    """
    if dataset.chunks is None:
        room.take(max(dataset.nbytes, 8 * dataset.size))  # as numbers are converted
        return
    size = math.prod(dataset.chunks) * dataset.dtype.itemsize  # may be more than the dataset
    room.take(max(dataset.nbytes, 8 * dataset.size, size))
    settings = dataset.id.get_create_plist()
    filters = [settings.get_filter(number)[0] for number in range(settings.get_nfilters())]
    for each in filters:
        if each in _UNREAD:
            raise ValueError(f"its chunks are packed by {_UNREAD[each]}, which is not read")
    if _DEFLATE not in filters:
        return
    if filters.count(_DEFLATE) > 1 or set(filters) - {_SHUFFLE, _DEFLATE, _CHECKSUM}:
        raise ValueError("its chunks are packed more than once")
    if dataset.id.get_storage_size() <= _SMALL:
        return
    skipped = 1 << filters.index(_DEFLATE)
    for place in product(*map(range, [0] * len(dataset.shape), dataset.shape, dataset.chunks)):
        chunk = dataset.id.get_chunk_info_by_coord(place)
        if chunk.size > _SMALL and not chunk.filter_mask & skipped:
            packed = dataset.id.read_direct_chunk(place)[1]
            if len(zlib.decompressobj().decompress(packed, size + 1)) > size:
                raise ValueError(f"a chunk holds more than {size} bytes")
