"""The numeric datasets of an HDF5 file, each split into vectors."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from typing import Any

from jointid.base.errors import InputError
from jointid.base.unpacking import Room
from jointid.base.values import dataclass
from jointid.recording.hierarchies import hdf5_chunks
from jointid.recording.table import MOST_COLUMNS

_LONGEST = 1_000_000  # bytes of an attribute
_LARGE_FILE, _LARGE = (
    20_000_000,
    200_000_000,
)  # bytes of texts that any file may hold, however small it is
_LONGEST_PATH = 1000  # characters
_WIDEST = 256  # columns of a matrix: a wider one is not a table of signals
_MATLAB_NUMBERS = (
    *("double", "single", "logical"),
    *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
)


@dataclass(frozen=True, kw_only=True)
class Vector:
    """A column of an HDF5 file.

    Attributes
    ----------
    path : str
        Path of the dataset, without the first slash.
    field : tuple of str
        Names of a table's field and of the fields inside it. Empty: the dataset has no fields.
    part : int, optional
        0-based column of a matrix. Default: the dataset is not a matrix.
    by_rows : bool
        Whether the matrix has one row per signal instead of one column.
    unit : str
        Unit from the dataset's attributes; empty if there is none.
    name : str
        A name from the file that replaces the dataset's name. Default: none.
    """

    path: str
    field: tuple[str, ...] = ()
    part: int | None = None
    by_rows: bool = False
    unit: str = ""
    name: str = ""

    @property
    def last(self) -> str:
        """Name of the dataset or field, without the groups."""
        return self.name or (".".join(self.field) if self.field else self.path.rpartition("/")[2])

    @property
    def group(self) -> str:
        """Path of the group that holds the dataset; empty for the file itself."""
        return self.path.rpartition("/")[0]


def vectors_of(file: Any, room: Room) -> tuple[list[Vector], list[str]]:
    """Return the vectors of an open file, and the objects that are not read.

    Parameters
    ----------
    file : h5py.File
    room : Room
        Counts the memory, also of the names.

    Raises
    ------
    InputError
        An object's path or an attribute is far too long. Columns beyond the largest number are ignored.
    Exception
        Any error that h5py raises for damaged bytes.
    """
    import h5py

    found: list[Vector] = []
    left_out: list[str] = []

    def visit(path: str, thing: Any) -> None:
        if path.startswith("#"):  # MATLAB's internal contents of cells and objects
            return
        if len(path) > _LONGEST_PATH:  # each object in a group with a long name repeats that name
            raise InputError(
                f"the path of an object has {len(path)} characters; at most {_LONGEST_PATH} are read",
                place=str(file.filename),
            )
        kind = _attribute(thing, "MATLAB_class")
        if isinstance(thing, h5py.Dataset):
            if kind and kind not in _MATLAB_NUMBERS:
                if kind not in ("char", "cell", "string"):
                    left_out.append(f"{path} ({kind})")
            elif thing.external or thing.is_virtual:
                left_out.append(f"{path} ({'external' if thing.external else 'virtual'})")
            else:
                found.extend(islice(_vectors(path, thing), MOST_COLUMNS + 1 - len(found)))
        elif "MATLAB_sparse" in thing.attrs or (kind and kind != "struct"):
            left_out.append(f"{path} ({kind or 'object'})")

    file.visititems(visit)
    return _named_blocks(file, found, room), left_out


def _vectors(path: str, dataset: Any) -> Iterator[Vector]:
    if _flag(dataset, "MATLAB_empty") or dataset.size is None or dataset.size < 2:
        return
    unit = _unit(dataset)
    if dataset.dtype.names is not None:
        if len(dataset.shape) == 1 and "MATLAB_class" not in dataset.attrs:
            yield from _fields(path, dataset.dtype, ())
    elif dataset.dtype.kind in "biuf":
        shape = [length for length in dataset.shape if length != 1]
        if len(shape) == 1:
            yield Vector(path=path, unit=unit)
        elif len(dataset.shape) == 2 and min(shape) <= _WIDEST:
            by_rows = shape[0] < shape[1]
            for part in range(min(shape)):
                yield Vector(path=path, part=part, by_rows=by_rows, unit=unit)


def _fields(path: str, dtype: Any, above: tuple[str, ...]) -> Iterator[Vector]:
    for name in dtype.names:
        inner = dtype[name]
        field = (*above, name)
        if inner.names is not None:
            yield from _fields(path, inner, field)
        elif inner.subdtype is None:
            if inner.kind in "biuf":
                yield Vector(path=path, field=field)
        elif inner.base.kind in "biuf" and len(inner.shape) == 1 and inner.shape[0] <= _WIDEST:
            for part in range(inner.shape[0]):
                yield Vector(path=path, field=field, part=part)


def values_of(file: Any, vector: Vector) -> Any:
    """Return the numbers of a vector.

    Raises
    ------
    Exception
        Any error that h5py raises for damaged bytes.
    """
    dataset = file[vector.path]
    if vector.field:
        values = dataset.fields(vector.field[0])[:]
        for name in vector.field[1:]:
            values = values[name]
        return values if vector.part is None else values[:, vector.part]
    if vector.part is None:
        return dataset[()].reshape(-1)
    return dataset[vector.part, :] if vector.by_rows else dataset[:, vector.part]


def _named_blocks(file: Any, vectors: list[Vector], room: Room) -> list[Vector]:
    """Name the columns of a pandas frame's blocks by the dataset that holds their names."""
    named = []
    labels: dict[str, Any] = {}
    for vector in vectors:
        name = ""
        last = vector.path.rpartition("/")[2]
        if last.startswith("block") and last.endswith("_values"):
            path = f"{vector.path.removesuffix('_values')}_items"
            if path not in labels:
                labels[path] = _labels(file.get(path), room)
            if (vector.part or 0) < len(labels[path]):
                name = _text(labels[path][vector.part or 0])
        if last == "axis1" and f"{vector.group}/axis0".lstrip("/") in file:
            name = "index"
        named.append(vector if not name else replace(vector, name=name))
    return named


def _labels(items: Any, room: Room) -> Any:
    """Return the names of a block's columns; none if they are not texts, or far too many."""
    if items is None or items.dtype.kind != "S" or items.ndim != 1 or len(items) > _WIDEST:
        return ()
    hdf5_chunks.take(items, room)
    return items[:]


def _unit(dataset: Any) -> str:
    return next(
        (
            text
            for name in ("unit", "units", "Unit", "Units")
            if (text := _attribute(dataset, name))
        ),
        "",
    )


def _flag(thing: Any, name: str) -> bool:
    few = name in thing.attrs and thing.attrs.get_id(name).get_storage_size() <= 8
    return bool(thing.attrs.get(name)) if few else False


def _attribute(thing: Any, name: str) -> str:
    """Return an attribute's text, or the first of its texts; empty if it is neither.

    Raises
    ------
    InputError
        It holds far more texts. A file may store one long text once and refer to it many times.
    """
    if name not in thing.attrs:
        return ""
    about = thing.attrs.get_id(name)
    if about.shape is None:
        return ""
    count, size = math.prod(about.shape), thing.file.id.get_filesize()
    shared = about.dtype.hasobject and size < _LARGE_FILE and count * size > _LARGE
    if count > _WIDEST or about.get_storage_size() > _LONGEST or shared:
        raise InputError(
            f"the attribute {name!r} of {thing.name} holds {count} texts; one text is expected, or one for each column",
            place=str(thing.file.filename),
        )
    return _text(thing.attrs.get(name))


def _text(value: Any) -> str:
    """Return the text of an attribute; empty for any other value."""
    value = getattr(value, "flat", [value])
    first = next(iter(value), None) if not isinstance(value, str | bytes) else value
    if isinstance(first, bytes):
        return first.decode("utf-8", "replace").strip("\0 ")
    return str(first).strip() if isinstance(first, str) else ""
